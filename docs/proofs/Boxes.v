(* rt-geom, bvh/cull.rs: the test of boxes in f32, and the ends of the segment. *)
From Proofs Require Import Rounding Single.
Open Scope R_scope.
Notation v := UNIT.

(* The rounding errors of the box test, as a displacement of a plane, in units of v. *)
Definition BOX_SLACK := 8.
(* The reciprocals of a direction's components are no larger than this. *)
Definition MAX_INVERSE := bp 40.
(* Added to keys. *)
Definition KEY_SHIFT := 4.
(* The end of the segment: the reach of the unit ball, and what makes up for the rounding of a best hit. *)
Definition REACH := 1125 / 1000.
Definition ROUNDING := bp (-22).

Lemma tiny : bp (-150) <= / 1000000000000000000000000000000 * v. Proof. apply bp_part. lia. Qed.
Lemma F_reach : Fs REACH.
Proof. replace REACH with (IZR 9 * bp (-3)) by (unfold REACH; simpl; lra). apply Fs_scaled; lia. Qed.

(* ---- The reciprocal of a component ----
   w = d / L is a component of the unit vector; i the reciprocal as computed: 1/d and l rounded, their product, rounded
   to f32 and cut. Then the slab test is that of a component that is changed by 1.01 v. *)
Theorem MAX_INVERSE_holds : forall d L l i, 0 < Rabs d <= L -> bp (-101) <= L -> bp (-1000) <= / Rabs d ->
  Rabs (l - L) <= 4 * u * L -> let r := RNs (RN (RN (/ d) * l)) in
  (Rabs r <= MAX_INVERSE -> i = r) -> (MAX_INVERSE < Rabs r -> Rabs i = MAX_INVERSE /\ 0 < i * d) ->
  Rabs (d / L - / i) <= (1 + / 100) * v /\ 1 - 3 * v <= Rabs i <= MAX_INVERSE.
Proof.
  intros d L l i [D0 DL] L0 Dmax Hl r Hi Hc. pose proof v_pos as V. pose proof u_pos as U.
  assert (LP : 0 < L) by lra. assert (dn : d <> 0) by (intro Z; rewrite Z, Rabs_R0 in D0; lra).
  set (w := d / L). assert (wn : w <> 0) by (unfold w, Rdiv; apply Rmult_integral_contrapositive_currified;
    [assumption | apply Rinv_neq_0_compat; lra]).
  assert (W1 : Rabs w <= 1).
  { unfold w, Rdiv. rewrite Rabs_mult, (Rabs_pos_eq (/ L)) by (apply Rlt_le, Rinv_0_lt_compat; lra).
    apply Rmult_le_reg_r with L; [lra|]. rewrite Rmult_assoc, Rinv_l by lra. lra. }
  assert (W0 : 0 < Rabs w) by now apply Rabs_pos_lt.
  (* every step as a factor of 1/w *)
  assert (E1 : Rabs (RN (/ d) - / d) <= u * Rabs (/ d)).
  { apply RN_normal. rewrite Rabs_inv. apply Rle_trans with (2 := Dmax). apply bp_le. lia. }
  set (r1 := RN (/ d)) in *.
  assert (E2 : Rabs (r1 * l * w - 1) <= (5 + / 1000) * u).
  { assert (A : Rabs (r1 * d - 1) <= u).
    { replace (r1 * d - 1) with ((r1 - / d) * d) by (field; assumption). rewrite Rabs_mult.
      apply Rle_trans with (u * Rabs (/ d) * Rabs d); [apply Rmult_le_compat_r; [apply Rabs_pos | assumption]|].
      rewrite Rmult_assoc, <- Rabs_mult, Rinv_l, Rabs_R1 by assumption. lra. }
    assert (B : Rabs (l / L - 1) <= 4 * u).
    { replace (l / L - 1) with ((l - L) * / L) by (field; lra).
      rewrite Rabs_mult, (Rabs_pos_eq (/ L)) by (apply Rlt_le, Rinv_0_lt_compat; lra).
      apply Rmult_le_reg_r with L; [lra|]. rewrite Rmult_assoc, Rinv_l by lra. lra. }
    replace (r1 * l * w) with ((r1 * d) * (l / L)) by (unfold w; field; lra).
    set (x := r1 * d) in *. set (y := l / L) in *. replace (x * y - 1) with ((x - 1) * y + (y - 1)) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_mult.
    assert (Rabs y <= 1 + 4 * u) by (replace y with ((y - 1) + 1) by ring; eapply Rle_trans; [apply Rabs_triang|];
      rewrite Rabs_R1; lra).
    assert (Rabs (x - 1) * Rabs y <= u * (1 + 4 * u)) by (apply Rmult_le_compat; auto using Rabs_pos).
    rewrite u_val in *. lra. }
  set (m := r1 * l) in *.
  assert (M0 : 1 - 6 * u <= Rabs m).
  { apply Rle_trans with (Rabs (m * w)).
    - replace (m * w) with (1 - - (m * w - 1)) by ring. eapply Rle_trans; [|apply Rabs_triang_inv].
      rewrite Rabs_R1, Rabs_Ropp. lra.
    - rewrite Rabs_mult. pose proof (Rabs_pos m). nra. }
  assert (S0 : bp (-126) <= / 1000) by (apply Rle_trans with (bp (-10)); [apply bp_le; lia | simpl; lra]).
  assert (E3 : Rabs (RN m - m) <= u * Rabs m).
  { apply RN_normal. assert (bp (-1022) <= bp (-126)) by (apply bp_le; lia). rewrite u_val in *. lra. }
  set (m2 := RN m) in *.
  assert (M2 : Rabs m * (1 - u) <= Rabs m2).
  { replace m2 with (m - - (m2 - m)) by ring. eapply Rle_trans; [|apply Rabs_triang_inv]. rewrite Rabs_Ropp. lra. }
  assert (E4 : Rabs (r - m2) <= v * Rabs m2).
  { apply RNs_normal. rewrite u_val in *. nra. }
  assert (E5 : Rabs (r * w - 1) <= (1 + / 1000) * v).
  { replace (r * w - 1) with ((r - m2) * w + (m2 - m) * w + (m * w - 1)) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
    rewrite !Rabs_mult.
    assert (A : Rabs (m * w) <= 1 + 6 * u) by (replace (m * w) with ((m * w - 1) + 1) by ring;
      eapply Rle_trans; [apply Rabs_triang|]; rewrite Rabs_R1; lra).
    rewrite Rabs_mult in A.
    assert (B : Rabs (m2 - m) * Rabs w <= u * (1 + 6 * u)).
    { apply Rle_trans with (u * Rabs m * Rabs w); [apply Rmult_le_compat_r; lra|]. rewrite Rmult_assoc.
      apply Rmult_le_compat_l; lra. }
    assert (C : Rabs m2 * Rabs w <= 1 + 9 * u).
    { apply Rle_trans with (Rabs m * (1 + u) * Rabs w); [apply Rmult_le_compat_r; [lra|]|].
      - replace m2 with ((m2 - m) + m) by ring. eapply Rle_trans; [apply Rabs_triang|]. lra.
      - replace (Rabs m * (1 + u) * Rabs w) with ((1 + u) * (Rabs m * Rabs w)) by ring.
        apply Rle_trans with ((1 + u) * (1 + 6 * u)); [apply Rmult_le_compat_l; lra | rewrite u_val; lra]. }
    assert (D : Rabs (r - m2) * Rabs w <= v * (1 + 9 * u)).
    { apply Rle_trans with (v * Rabs m2 * Rabs w); [apply Rmult_le_compat_r; lra|]. rewrite Rmult_assoc.
      apply Rmult_le_compat_l; lra. }
    rewrite u_val, v_val in *. lra. }
  assert (R0 : 1 - (1 + / 1000) * v <= Rabs (r * w)).
  { replace (r * w) with (1 - - (r * w - 1)) by ring. eapply Rle_trans; [|apply Rabs_triang_inv].
    rewrite Rabs_R1, Rabs_Ropp. lra. }
  rewrite Rabs_mult in R0.
  assert (R1 : Rabs (r * w) <= 1 + (1 + / 1000) * v) by (replace (r * w) with ((r * w - 1) + 1) by ring;
      eapply Rle_trans; [apply Rabs_triang|]; rewrite Rabs_R1; lra).
  rewrite Rabs_mult in R1. assert (MV : MAX_INVERSE = 1099511627776) by (unfold MAX_INVERSE; simpl; lra).
  destruct (Rle_or_lt (Rabs r) MAX_INVERSE) as [Q|Q].
  - rewrite (Hi Q). pose proof (Rabs_pos r). assert (R2 : 1 - (1 + / 1000) * v <= Rabs r) by nra.
    assert (rn : r <> 0) by (intro Z; rewrite Z, Rabs_R0 in R2; rewrite v_val in R2; lra).
    split; [|split; [lra | assumption]].
    replace (w - / r) with ((r * w - 1) * / r) by (field; assumption). rewrite Rabs_mult, Rabs_inv.
    assert (I0 : 0 < Rabs r) by now apply Rabs_pos_lt.
    apply Rmult_le_reg_r with (Rabs r); [assumption|]. rewrite Rmult_assoc, Rinv_l by lra. rewrite v_val in *. lra.
  - destruct (Hc Q) as [I S]. rewrite I. split; [|rewrite v_val, MV; lra].
    assert (W2 : Rabs w * MAX_INVERSE <= 1 + (1 + / 1000) * v) by nra.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp, Rabs_inv, I, MV in *. rewrite v_val in *. lra.
Qed.
(* A component of zero: the reciprocal is infinite before it is cut. *)
Theorem component_zero : forall i, Rabs i = MAX_INVERSE -> Rabs (0 - / i) <= (1 + / 100) * v.
Proof.
  intros i I. unfold Rminus. rewrite Rplus_0_l, Rabs_Ropp, Rabs_inv, I. unfold MAX_INVERSE. rewrite v_val. simpl. lra.
Qed.

(* ---- One slab ----
   The line passes at q along w, a point of the box is P = q + tau w up to e, and the plane p is on the near side of it:
   p i <= P i. y is the product p i, rounded or not. *)
Definition entry y i q s := let qs := RNs q in RNs (y + - RNs (RNs (qs * i) + RNs (Rabs i * s))).
Definition exit y i q s := let qs := RNs q in RNs (y + RNs (RNs (Rabs i * s) - RNs (qs * i))).
Section Slab.
Variables w i q tau P p err up y : R.
Hypotheses (Hi : Rabs (w - / i) <= (1 + / 100) * v) (Hi1 : 1 - 3 * v <= Rabs i <= MAX_INVERSE)
  (Htau : Rabs tau <= REACH) (Hq : Rabs q <= 107 / 100) (Hp : Rabs p <= 1 + / 1000)
  (HP : Rabs (P - (q + tau * w)) <= err) (Hup : err <= up <= / 10)
  (Hy : Rabs (y - p * i) <= v * Rabs (p * i) + bp (-150)).
Let s := RNs (BOX_SLACK * v + up).
Lemma entry_below : p * i <= P * i -> entry y i q s <= tau.
Proof.
  intro Near. destruct Hi1 as [I1 I2]. pose proof v_pos as V. pose proof tiny as T. pose proof (bp_pos (-150)) as T0.
  assert (E0 : 0 <= err) by (eapply Rle_trans; [apply Rabs_pos | apply HP]).
  assert (in0 : i <> 0) by (intro Z; rewrite Z, Rabs_R0 in I1; rewrite v_val in I1; lra).
  set (a := Rabs i) in *. assert (A0 : 0 < a) by (rewrite v_val in I1; lra).
  (* times |i| *)
  assert (M : forall x k, Rabs x <= k -> Rabs (x * i) <= k * a) by (intros; rewrite Rabs_mult;
    apply Rmult_le_compat_r; [lra | assumption]).
  assert (TW : Rabs (tau * (w * i - 1)) <= 115 / 100 * v * a).
  { replace (tau * (w * i - 1)) with (tau * (w - / i) * i) by (field; assumption). apply M. rewrite Rabs_mult.
    apply Rle_trans with (REACH * ((1 + / 100) * v)); [apply Rmult_le_compat; auto using Rabs_pos|].
    unfold REACH. lra. }
  pose proof (M _ _ HP) as HPi.
  pose proof (UNIT_holds q) as Q. set (qs := RNs q) in *.
  assert (Qd : Rabs (qs - q) <= (107 / 100 + / 1000) * v) by (rewrite v_val in *; lra).
  assert (Qs : Rabs qs <= 1071 / 1000).
  { replace qs with ((qs - q) + q) by ring. eapply Rle_trans; [apply Rabs_triang|]. rewrite v_val in *. lra. }
  pose proof (M _ _ Qd) as Qdi. pose proof (M _ _ Qs) as Qsi. pose proof (M _ _ Hp) as Hpi.
  pose proof (UNIT_holds (BOX_SLACK * v + up)) as S. fold s in S. unfold BOX_SLACK in S.
  rewrite (Rabs_pos_eq (8 * v + up)) in S by lra.
  assert (S1 : 8 * v + up - (/ 10 + / 1000) * v <= s <= 8 * v + up + (/ 10 + / 1000) * v).
  { apply Rabs_le_inv in S. rewrite v_val in *. lra. }
  pose proof (UNIT_holds (a * s)) as SL. assert (s0 : 0 <= s) by lra.
  assert (AS : 0 <= a * s) by (apply Rmult_le_pos; lra). rewrite (Rabs_pos_eq (a * s)) in SL by assumption.
  pose proof (UNIT_holds (qs * i)) as CE.
  set (slack := RNs (a * s)) in *. set (center := RNs (qs * i)) in *.
  assert (SO : Rabs (RNs (center + slack) - (center + slack)) <= v * Rabs (center + slack)).
  { apply RNs_sum; apply RNs_F. }
  unfold entry. fold qs. fold a. fold slack. fold center. set (off := RNs (center + slack)) in *.
  (* all in units of a *)
  assert (C1 : Rabs (center - q * i) <= (215 / 100) * v * a).
  { replace (center - q * i) with ((center - qs * i) + (qs - q) * i) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite v_val in *. lra. }
  assert (C2 : Rabs center <= 1072 / 1000 * a).
  { replace center with ((center - qs * i) + qs * i) by ring. eapply Rle_trans; [apply Rabs_triang|].
    rewrite v_val in *. lra. }
  assert (AS1 : a * s <= / 9 * a) by (rewrite Rmult_comm; apply Rmult_le_compat_r; rewrite v_val in *; lra).
  assert (SL1 : a * s - / 8 * v * a <= slack <= / 8 * a).
  { apply Rabs_le_inv in SL. rewrite v_val in *. lra. }
  assert (SL0 : 0 <= slack) by (apply RNs_above; [apply Fs_0 | assumption]).
  assert (SO1 : Rabs (off - (center + slack)) <= 12 / 10 * v * a).
  { eapply Rle_trans; [exact SO|]. assert (Rabs (center + slack) <= 1072 / 1000 * a + / 8 * a).
    { eapply Rle_trans; [apply Rabs_triang|]. rewrite (Rabs_pos_eq slack) by assumption. lra. }
    replace (12 / 10 * v * a) with (v * (12 / 10 * a)) by ring. apply Rmult_le_compat_l; lra. }
  assert (Y1 : y <= p * i + (1 + / 500) * v * a).
  { apply Rabs_le_inv in Hy. rewrite v_val in *. lra. }
  apply RNs_lower with REACH; [apply F_reach | unfold REACH; lra | assumption|].
  assert (AE : err * a <= up * a) by (apply Rmult_le_compat_r; lra).
  assert (ASL : (8 * v + up) * a - (/ 10 + / 1000) * v * a <= a * s).
  { rewrite (Rmult_comm a s). apply Rle_trans with ((8 * v + up - (/ 10 + / 1000) * v) * a); [right; ring|].
    apply Rmult_le_compat_r; lra. }
  assert (PI : P * i = q * i + tau + tau * (w * i - 1) + (P - (q + tau * w)) * i) by ring.
  apply Rabs_le_inv in TW. apply Rabs_le_inv in HPi. apply Rabs_le_inv in SO1. apply Rabs_le_inv in C1.
  assert (va : v * (1 - 3 * v) <= v * a) by (apply Rmult_le_compat_l; lra).
  unfold REACH. rewrite v_val in *. lra.
Qed.
End Slab.

(* The computed entry is at most tau, the exit at least tau: so a box whose hit lies at tau in the segment is kept. *)
Theorem BOX_SLACK_holds : forall w i q tau P near far err up y z,
  Rabs (w - / i) <= (1 + / 100) * v -> 1 - 3 * v <= Rabs i <= MAX_INVERSE -> Rabs tau <= REACH -> Rabs q <= 107 / 100 ->
  Rabs near <= 1 + / 1000 -> Rabs far <= 1 + / 1000 -> Rabs (P - (q + tau * w)) <= err -> err <= up <= / 10 ->
  Rabs (y - near * i) <= v * Rabs (near * i) + bp (-150) -> Rabs (z - far * i) <= v * Rabs (far * i) + bp (-150) ->
  near * i <= P * i <= far * i ->
  let s := RNs (BOX_SLACK * v + up) in entry y i q s <= tau <= exit z i q s.
Proof.
  intros w i q tau P near far err up y z Hi Hi1 Ht Hq Hn Hf HP Hup Hy Hz [N X] s. split.
  - now apply (entry_below w i q tau P near err up y).
  - assert (E : entry (- z) (- i) q s <= - tau).
    { apply (entry_below (- w) (- i) q (- tau) P far err up (- z)); auto.
      - rewrite Rinv_opp. replace (- w - - / i) with (- (w - / i)) by ring. now rewrite Rabs_Ropp.
      - now rewrite Rabs_Ropp.
      - now rewrite Rabs_Ropp.
      - replace (- tau * - w) with (tau * w) by ring. assumption.
      - replace (- z - far * - i) with (- (z - far * i)) by ring. replace (far * - i) with (- (far * i)) by ring.
        now rewrite !Rabs_Ropp.
      - lra. }
    unfold entry in E. unfold exit. rewrite Rabs_Ropp in E. replace (RNs q * - i) with (- (RNs q * i)) in E by ring.
    rewrite RNs_opp in E. set (c := RNs (RNs q * i)) in *. set (l := RNs (Rabs i * s)) in *.
    replace (- c + l) with (l - c) in E by ring. replace (- z + - RNs (l - c)) with (- (z + RNs (l - c))) in E by ring.
    rewrite RNs_opp in E. lra.
Qed.
(* The product as a term or fused. *)
Theorem product_plain : forall p i, Rabs (RNs (p * i) - p * i) <= v * Rabs (p * i) + bp (-150).
Proof. intros. apply UNIT_holds. Qed.
Theorem product_fused : forall p i, Rabs (p * i - p * i) <= v * Rabs (p * i) + bp (-150).
Proof.
  intros. replace (p * i - p * i) with 0 by ring. rewrite Rabs_R0. pose proof v_pos. pose proof (bp_pos (-150)).
  pose proof (Rabs_pos (p * i)). nra.
Qed.

(* Keys are positive, and in the order of entries. *)
Theorem KEY_SHIFT_holds : forall enter, - 2 <= enter ->
  0 < RNs (enter + KEY_SHIFT) /\ forall last, enter <= last -> RNs (enter + KEY_SHIFT) <= RNs (last + KEY_SHIFT).
Proof.
  intros enter H. unfold KEY_SHIFT. split.
  - apply Rlt_le_trans with 2; [lra|]. apply RNs_above; [|lra]. replace 2 with (IZR 1 * bp 1) by (simpl; lra).
    apply Fs_scaled; lia.
  - intros. apply RNs_le. lra.
Qed.

(* Points of the unit ball on a line that is nearest to its center at q: the segment reaches beyond them. *)
Theorem REACH_holds : forall q1 q2 q3 w1 w2 w3 tau P1 P2 P3, w1 * w1 + w2 * w2 + w3 * w3 = 1 ->
  q1 * w1 + q2 * w2 + q3 * w3 = 0 -> P1 * P1 + P2 * P2 + P3 * P3 <= 1 ->
  P1 = q1 + tau * w1 -> P2 = q2 + tau * w2 -> P3 = q3 + tau * w3 ->
  Rabs tau <= REACH - / 8 /\ q1 * q1 + q2 * q2 + q3 * q3 <= 1.
Proof.
  intros q1 q2 q3 w1 w2 w3 tau P1 P2 P3 W Q P H1 H2 H3.
  assert (E : P1 * P1 + P2 * P2 + P3 * P3 = (q1 * q1 + q2 * q2 + q3 * q3) + 2 * tau * (q1 * w1 + q2 * w2 + q3 * w3)
    + tau * tau * (w1 * w1 + w2 * w2 + w3 * w3)) by (subst; ring).
  rewrite W, Q in E. pose proof (sq_pos q1). pose proof (sq_pos q2). pose proof (sq_pos q3). pose proof (sq_pos tau).
  split; [|lra]. apply Rle_trans with 1; [apply abs_below; lra | unfold REACH; lra].
Qed.

(* The last parameter of a best hit: what is at least tau + 3/4 ROUNDING is at least tau when rounded to f32. *)
Theorem ROUNDING_holds : forall x tau, Rabs tau <= REACH -> tau + 3 / 4 * ROUNDING <= x -> tau <= RNs x.
Proof.
  intros x tau T H. assert (R : ROUNDING = 4 * v) by (unfold ROUNDING; rewrite v_val; simpl; lra). rewrite R in H.
  assert (E : RNs (- x) <= - tau).
  { apply RNs_lower with REACH; [apply F_reach | unfold REACH; lra | now rewrite Rabs_Ropp|].
    pose proof tiny. pose proof v_pos. unfold REACH. lra. }
  rewrite RNs_opp in E. lra.
Qed.
