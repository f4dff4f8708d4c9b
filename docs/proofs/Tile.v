(* rt-geom, bvh/tile.rs: rays of one origin that are culled together, against boxes and balls, the whole tile and one by
   one. *)
From Proofs Require Import Rounding Single Norm Boxes Line Balls.
Open Scope R_scope.
Notation v := UNIT.

(* The rounding errors of all tests, as a distance, for each unit of the largest parameter, in units of v. *)
Definition SLACK := 32.
(* The largest parameter that a tile may have. *)
Definition REACH := 64.
(* What makes up for the rounding of an end to f32, in units of v of itself. *)
Definition END_ROUNDING := 4.
(* How far a plane is moved, for each unit that a direction is outside, in units of the largest parameter. *)
Definition OUTSIDE := 2.
(* What a ball may be in front, in slacks. *)
Definition IN_FRONT := 3.
(* The least square of a normal that is a plane's. *)
Definition LEAST_NORMAL := bp (-100).

(* ---- The tests, as they are computed ---- *)
(* A reciprocal, cut; the sign is that of the tile's directions along the axis. *)
Definition cut w := RNs (/ Rmax w (/ MAX_INVERSE)).
(* Where a plane is met: its product with the reciprocal, less that of the origin, moved by the slack. *)
Definition crossed y i o s := RNs (y + - RNs (RNs (o + s) * i)).
(* The same for one ray: the plane moved first. *)
Definition crossed_alone p i o s := RNs (i * RNs (RNs (p + s) - o)).
(* How far a center is beyond a plane. *)
Definition tbeyond c1 c2 c3 n1 n2 n3 offset := let x x := X x 1 in
  Add (Mul (x c1) (x n1)) (Add (Mul (x c2) (x n2)) (Sub (Mul (x c3) (x n3)) (X offset 9))).
Definition tfused x1 x2 x3 y1 y2 y3 := Add (Mul x1 y1) (Add (Mul x2 y2) (Mul x3 y3)).
(* A plane times a reciprocal, rounded or not. *)
Definition product y p i := Rabs (y - p * i) <= v * Rabs (p * i) + bp (-150).
(* Along an axis: the sign of all directions, the least and the greatest without it, and one of them;
   two planes, and what
   lies between, in the order in which they are met. *)
Definition slopes g a b x := (g = 1 \/ g = - 1) /\ 0 <= a <= g * x /\ g * x <= b <= 1 + / 1000.
Definition between g near P away := Rabs near <= 1 + / 1000 /\ Rabs away <= 1 + / 1000 /\ g * near <= g * P <= g * away.

(* ---- One slab ---- *)
(* A component of a direction in f32, and its reciprocal as computed, cut. *)
Lemma cut_near : forall w, w <= 1 + / 1000 ->
  let b := Rmax w (/ MAX_INVERSE) in Rabs (b * cut w - 1) <= (1 + / 1000) * v /\ 99 / 100 <= cut w.
Proof.
  intros w W b. pose proof v_pos as V. assert (MV : MAX_INVERSE = 1099511627776) by (unfold MAX_INVERSE; simpl; lra).
  assert (B : / MAX_INVERSE <= b <= 1 + / 1000) by (unfold b; split; [apply Rmax_r|]; apply Rmax_lub; [assumption|];
    rewrite MV; lra). rewrite MV in B. assert (B0 : 0 < b) by lra. assert (I0 : 0 < / b) by now apply Rinv_0_lt_compat.
  assert (I1 : / (1 + / 1000) <= / b) by (apply Rinv_le_contravar; lra).
  assert (E : Rabs (cut w - / b) <= v * / b).
  { rewrite <- (Rabs_pos_eq (/ b)) at 2 by lra. apply RNs_normal. fold b. rewrite Rabs_pos_eq by lra.
    apply Rle_trans with (2 := I1). apply Rle_trans with (bp (-10)); [apply bp_le; lia | simpl; lra]. }
  split.
  - replace (b * cut w - 1) with (b * (cut w - / b)) by (field; lra). rewrite Rabs_mult, (Rabs_pos_eq b) by lra.
    apply Rle_trans with (b * (v * / b)); [apply Rmult_le_compat_l; lra|].
    replace (b * (v * / b)) with v by (field; lra). lra.
  - apply Rabs_le_inv in E. rewrite v_val in *. lra.
Qed.
Section Slab.
(* sizes, as a tile has them below *)
Variables D far slack : R.
Hypotheses (D1 : 1 <= D) (D64 : D <= REACH + / 1000) (Ff : Fs far) (F1 : D <= far <= (1 + 6 * v) * D)
  (S1 : (SLACK - / 100) * v * D <= slack <= (SLACK + / 100) * v * D).
(* the near plane, the reciprocal i of a component b, the origin, a parameter *)
Variables p i b o tau e : R.
Hypotheses (I0 : 99 / 100 <= i) (I1 : Rabs (b * i - 1) <= (1 + / 1000) * v) (Hp : Rabs p <= 1 + / 1000)
  (Ho : Rabs o <= D) (Htau : Rabs tau <= far) (He : e <= (2 + / 50) * v * D) (H : p <= o + tau * b + e).
(* times the reciprocal *)
Lemma scaled_plane : (p - o) * i <= tau + (3 + / 20) * v * D * i.
Proof.
  pose proof v_pos as V. assert (A : (p - o) * i <= (tau * b + e) * i) by (apply Rmult_le_compat_r; lra).
  assert (B : Rabs (tau * (b * i - 1)) <= far * ((1 + / 1000) * v)) by (rewrite Rabs_mult; apply Rmult_le_compat;
    auto using Rabs_pos). apply Rabs_le_inv in B.
  assert (C : e * i <= (2 + / 50) * v * D * i) by (apply Rmult_le_compat_r; lra).
  replace ((tau * b + e) * i) with (tau + tau * (b * i - 1) + e * i) in A by ring.
  assert (E : v * D * (99 / 100) <= v * D * i) by (apply Rmult_le_compat_l; [apply Rmult_le_pos; lra | assumption]).
  assert (G : far * v <= (1 + 6 * v) * D * v) by (apply Rmult_le_compat_r; lra).
  replace ((1 + 6 * v) * D * v) with ((1 + 6 * v) * (v * D)) in G by ring. assert (0 < v * D) by (apply
    Rmult_lt_0_compat; lra). rewrite v_val in *. lra.
Qed.
Lemma rounded_below : forall x, x <= tau - 105 / 100 * v * D * i -> RNs x <= tau.
Proof.
  intros x X. apply RNs_lower with far; try assumption; [lra|]. pose proof Boxes.tiny as T. pose proof v_pos as V.
  assert (0 < v * D) by (apply Rmult_lt_0_compat; lra).
  assert (v * D * (99 / 100) <= v * D * i) by (apply Rmult_le_compat_l; lra).
  assert (v * far <= v * ((1 + 6 * v) * D)) by (apply Rmult_le_compat_l; lra).
  assert (v <= v * D) by nra. rewrite v_val in *. lra.
Qed.
Lemma crossed_below : forall y, Rabs (y - p * i) <= v * Rabs (p * i) + bp (-150) -> crossed y i o slack <= tau.
Proof.
  intros y Hy. pose proof v_pos as V. pose proof Boxes.tiny as T. pose proof (bp_pos (-150)) as T0.
  pose proof scaled_plane as SP. unfold SLACK, REACH in *. assert (VD : 0 < v * D) by (apply Rmult_lt_0_compat; lra).
  pose proof (UNIT_holds (o + slack)) as E1. set (a := RNs (o + slack)) in *. pose proof (UNIT_holds (a * i)) as E2.
  set (c := RNs (a * i)) in *. assert (V1 : v <= v * D) by nra. assert (V2 : v * D <= 64002 / 1000 * v) by nra.
  assert (O1 : Rabs (o + slack) <= (1 + / 1000) * D).
  { eapply Rle_trans; [apply Rabs_triang|]. rewrite (Rabs_pos_eq slack) by lra. rewrite v_val in *. lra. }
  assert (A1 : Rabs (a - (o + slack)) <= (1 + / 500) * v * D) by (eapply Rle_trans; [exact E1|];
    assert (v * Rabs (o + slack) <= v * ((1 + / 1000) * D)) by (apply Rmult_le_compat_l; lra); lra).
  assert (A2 : Rabs a <= (1 + / 500) * D).
  { replace a with ((a - (o + slack)) + (o + slack)) by ring. eapply Rle_trans; [apply Rabs_triang|].
    rewrite v_val in *. lra. }
  assert (M : forall z k, Rabs z <= k -> Rabs (z * i) <= k * i) by (intros; rewrite Rabs_mult, (Rabs_pos_eq i) by lra;
    apply Rmult_le_compat_r; lra).
  pose proof (M _ _ A1) as A1i. pose proof (M _ _ A2) as A2i. pose proof (M _ _ Hp) as Hpi.
  assert (VI : v * D * (99 / 100) <= v * D * i) by (apply Rmult_le_compat_l; lra).
  assert (VI2 : v * i <= v * D * i) by (apply Rmult_le_compat_r; lra).
  assert (C1 : Rabs (c - a * i) <= (1 + / 200) * v * D * i).
  { eapply Rle_trans; [exact E2|]. assert (v * Rabs (a * i) <= v * ((1 + / 500) * D * i)) by (apply
      Rmult_le_compat_l; lra). lra. }
  assert (Y1 : Rabs (y - p * i) <= (1 + / 500) * v * i).
  { eapply Rle_trans; [exact Hy|]. assert (v * Rabs (p * i) <= v * ((1 + / 1000) * i)) by (apply
      Rmult_le_compat_l; lra). assert (v * (99 / 100) <= v * i) by (apply Rmult_le_compat_l; lra). lra. }
  assert (SI : (32 - / 100) * v * D * i <= slack * i) by (apply Rmult_le_compat_r; lra).
  apply Rabs_le_inv in Y1. apply Rabs_le_inv in C1. apply Rabs_le_inv in A1i.
  unfold crossed. fold a. fold c. apply rounded_below.
  replace ((a - (o + slack)) * i) with (a * i - o * i - slack * i) in A1i by ring.
  replace ((p - o) * i) with (p * i - o * i) in SP by ring. lra.
Qed.
Lemma alone_below : crossed_alone p i o (- slack) <= tau.
Proof.
  pose proof v_pos as V. pose proof Boxes.tiny as T. pose proof (bp_pos (-150)) as T0.
  pose proof scaled_plane as SP. unfold SLACK, REACH in *. assert (VD : 0 < v * D) by (apply Rmult_lt_0_compat; lra).
  pose proof (UNIT_holds (p + - slack)) as E1. set (a := RNs (p + - slack)) in *. pose proof (UNIT_holds (a - o)) as E2.
  set (c := RNs (a - o)) in *. assert (V1 : v <= v * D) by nra. assert (V2 : v * D <= 64002 / 1000 * v) by nra.
  assert (O1 : Rabs (p + - slack) <= 1 + / 500).
  { eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp, (Rabs_pos_eq slack) by lra. rewrite v_val in *. lra. }
  assert (A1 : Rabs (a - (p + - slack)) <= (1 + / 200) * v) by (eapply Rle_trans; [exact E1|];
    assert (v * Rabs (p + - slack) <= v * (1 + / 500)) by (apply Rmult_le_compat_l; lra); lra).
  assert (A2 : Rabs (a - o) <= 2 * D + / 100).
  { replace (a - o) with ((a - (p + - slack)) + (p + - slack) - o) by ring. unfold Rminus at 1.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp.
    assert (Rabs (a - (p + - slack) + (p + - slack)) <= 1 + / 100) by (eapply Rle_trans; [apply Rabs_triang|];
      rewrite v_val in *; lra). lra. }
  assert (C1 : Rabs (c - (p + - slack - o)) <= (1 + / 200) * v + v * (2 * D + / 50)).
  { replace (c - (p + - slack - o)) with ((c - (a - o)) + (a - (p + - slack))) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. assert (v * Rabs (a - o) <= v * (2 * D + / 100)) by (apply
      Rmult_le_compat_l; lra). lra. }
  apply Rabs_le_inv in C1. assert (C2 : c <= p - o - slack + (31 / 10) * v * D) by lra.
  assert (C3 : i * c <= i * (p - o - slack + (31 / 10) * v * D)) by (apply Rmult_le_compat_l; lra).
  assert (SI : (32 - / 100) * v * D * i <= slack * i) by (apply Rmult_le_compat_r; lra).
  assert (VI : 0 <= v * D * i) by (apply Rmult_le_pos; lra).
  unfold crossed_alone. fold a. fold c. apply rounded_below. lra.
Qed.
End Slab.
Lemma crossed_opp : forall y i o s, crossed (- y) i (- o) (- s) = - crossed y i o s.
Proof.
  intros. unfold crossed. replace (- o + - s) with (- (o + s)) by ring. rewrite RNs_opp, Ropp_mult_distr_l_reverse,
    RNs_opp. rewrite <- Ropp_plus_distr, RNs_opp. reflexivity.
Qed.
Lemma crossed_turned : forall y i o s, crossed y (- i) (- o) (- s) = crossed y i o s.
Proof.
  intros. unfold crossed. replace (- o + - s) with (- (o + s)) by ring. rewrite RNs_opp. do 3 f_equal. f_equal. ring.
Qed.
Lemma alone_opp : forall p i o s, crossed_alone (- p) i (- o) (- s) = - crossed_alone p i o s.
Proof.
  intros. unfold crossed_alone. replace (- p + - s) with (- (p + s)) by ring. rewrite RNs_opp.
  replace (- RNs (p + s) - - o) with (- (RNs (p + s) - o)) by ring. rewrite RNs_opp, Ropp_mult_distr_r_reverse, RNs_opp.
  reflexivity.
Qed.
Lemma alone_turned : forall p i o s, crossed_alone (- p) (- i) (- o) (- s) = crossed_alone p i o s.
Proof.
  intros. unfold crossed_alone. replace (- p + - s) with (- (p + s)) by ring. rewrite RNs_opp.
  replace (- RNs (p + s) - - o) with (- (RNs (p + s) - o)) by ring. rewrite RNs_opp. f_equal. ring.
Qed.
(* ---- Vectors ---- *)
Lemma dot_bound : forall a1 a2 a3 b1 b2 b3,
  Rabs a1 * Rabs b1 + Rabs a2 * Rabs b2 + Rabs a3 * Rabs b3 <= norm a1 a2 a3 * norm b1 b2 b3.
Proof. intros. eapply Rle_trans; [apply Rle_abs|]. eapply Rle_trans; [apply dot_le|]. rewrite !norm_abs. lra. Qed.
(* A normal as it is normalised, of a side of which the computed square is not too small. *)
Theorem LEAST_NORMAL_holds : forall f1 f2 f3 q, Rabs f1 <= bp 64 -> Rabs f2 <= bp 64 -> Rabs f3 <= bp 64 ->
  single (tdot (X f1 64) (X f2 64) (X f3 64) (X f1 64) (X f2 64) (X f3 64)) q -> LEAST_NORMAL <= q ->
  let i := RNs (/ RNs (sqrt q)) in norm (RNs (f1 * i)) (RNs (f2 * i)) (RNs (f3 * i)) <= 1 + 5 * v.
Proof.
  intros f1 f2 f3 q H1 H2 H3 Hq L i. pose proof v_pos as V.
  assert (Q : (1 - (301 / 100) * v) * (norm f1 f2 f3 * norm f1 f2 f3) <= q /\ q <= bp 132).
  { unfold tdot in Hq. error32_of Hq E. rewrite !abs_sq in E. rewrite norm_sq.
    pose proof (norm_arg f1 f2 f3) as N. assert (T : bp (-140) <= / 1000 * v * LEAST_NORMAL).
    { unfold LEAST_NORMAL, UNIT. apply Rle_trans with (bp (-10 + (-24 + -100))); [apply bp_le; lia|].
      rewrite (bp_add (-10)), (bp_add (-24)). rewrite <- Rmult_assoc. apply Rmult_le_compat_r; [apply Rlt_le, bp_pos|].
      apply Rmult_le_compat_r; [apply Rlt_le, bp_pos|]. simpl. lra. }
    match type of E with _ <= _ + bp ?p => assert (bp p <= bp (-140)) by (apply bp_le; lia) end.
    assert (S : forall f, Rabs f <= bp 64 -> f * f <= bp 128).
    { intros f Hf. rewrite <- abs_sq. change 128%Z with (64 + 64)%Z. rewrite <- bp_sq. apply mul2; split;
        auto using Rabs_pos. }
    pose proof (S _ H1). pose proof (S _ H2). pose proof (S _ H3).
    assert (B : bp 132 = 16 * bp 128) by (change 132%Z with (4 + 128)%Z; rewrite bp_add; simpl (bp 4); lra).
    assert (bp (-140) <= bp 128) by (apply bp_le; lia).
    assert (NB : f1 * f1 + f2 * f2 + f3 * f3 <= 3 * bp 128) by lra. set (n := f1 * f1 + f2 * f2 + f3 * f3) in *.
    apply Rabs_le_inv in E. rewrite v_val in *. split; lra. }
  destruct Q as [Q QT]. set (n := norm f1 f2 f3) in *. pose proof (norm_pos f1 f2 f3) as N0. fold n in N0.
  assert (Q0 : 0 < q) by (apply Rlt_le_trans with (2 := L); apply bp_pos). set (s := sqrt q) in *.
  assert (ss : s * s = q) by (apply sqrt_sqrt; lra). assert (s0 : 0 < s) by now apply sqrt_lt_R0.
  assert (SL : (1 - (151 / 100) * v) * n <= s).
  { apply below_root; [lra|]. rewrite ss. eapply Rle_trans; [|exact Q].
    replace ((1 - 151 / 100 * v) * n * ((1 - 151 / 100 * v) * n)) with
      ((1 - 151 / 100 * v) * (1 - 151 / 100 * v) * (n * n)) by ring.
    apply Rmult_le_compat_r; [apply sq_pos | rewrite v_val; lra]. }
  assert (Slow : bp (-50) <= s) by (apply below_root; [lra|]; rewrite ss, bp_sq; exact L).
  assert (Stop : s <= bp 66) by (apply below_root; [apply Rlt_le, bp_pos|]; rewrite ss, bp_sq; exact QT).
  assert (R1 : Rabs (RNs s - s) <= v * s).
  { rewrite <- (Rabs_pos_eq s) at 3 by lra. apply RNs_normal. rewrite Rabs_pos_eq by lra.
    apply Rle_trans with (2 := Slow). apply bp_le. lia. }
  set (m := RNs s) in *. apply Rabs_le_inv in R1. assert (m0 : 0 < m) by (rewrite v_val in R1; lra).
  assert (I0 : 0 < / m) by now apply Rinv_0_lt_compat.
  assert (R2 : Rabs (i - / m) <= v * / m).
  { rewrite <- (Rabs_pos_eq (/ m)) at 2 by lra. apply RNs_normal. rewrite Rabs_pos_eq by lra.
    apply Rle_trans with (/ bp 67).
    - rewrite <- (bpow_opp radix2 67). apply bp_le. lia.
    - apply Rinv_le_contravar; [assumption|]. assert (bp 67 = 2 * bp 66) by (change 67%Z with (1 + 66)%Z;
        rewrite bp_add, bp_1; ring). rewrite v_val in R1. lra. }
  apply Rabs_le_inv in R2.
  assert (C : n * i <= 1 + (354 / 100) * v).
  { assert (A : (1 - (252 / 100) * v) * n <= m).
    { apply Rle_trans with ((1 - v) * ((1 - (151 / 100) * v) * n)).
      - rewrite <- Rmult_assoc. apply Rmult_le_compat_r; [assumption | rewrite v_val; lra].
      - apply Rle_trans with ((1 - v) * s); [apply Rmult_le_compat_l; [rewrite v_val; lra | exact SL] | lra]. }
    assert (B : (1 - (252 / 100) * v) * (n * / m) <= 1).
    { replace ((1 - (252 / 100) * v) * (n * / m)) with ((1 - (252 / 100) * v) * n * / m) by ring.
      apply Rle_trans with (m * / m); [apply Rmult_le_compat_r; lra | rewrite Rinv_r; lra]. }
    assert (G : n * i <= n * ((1 + v) * / m)) by (apply Rmult_le_compat_l; lra).
    replace (n * ((1 + v) * / m)) with ((1 + v) * (n * / m)) in G by ring.
    assert (0 <= n * / m) by (apply Rmult_le_pos; lra). rewrite v_val in *. lra. }
  assert (i0 : 0 < i) by (rewrite v_val in R2; lra).
  pose proof (UNIT_holds (f1 * i)) as E1. pose proof (UNIT_holds (f2 * i)) as E2.
  pose proof (UNIT_holds (f3 * i)) as E3.
  assert (K : norm (f1 * i) (f2 * i) (f3 * i) = n * i).
  { rewrite !(Rmult_comm _ i), norm_scaled, Rabs_pos_eq by lra. fold n. ring. }
  eapply Rle_trans; [apply (norm_difference _ _ _ (f1 * i) (f2 * i) (f3 * i))|]. rewrite K.
  assert (D : norm (RNs (f1 * i) - f1 * i) (RNs (f2 * i) - f2 * i) (RNs (f3 * i) - f3 * i) <= v * (n * i) + 2 * bp
    (-150)).
  { eapply Rle_trans; [eapply norm_monotone; eassumption|]. eapply Rle_trans; [apply norm_triangle|].
    rewrite norm_scaled, norm_abs, K, Rabs_pos_eq by lra. pose proof (bp_pos (-150)).
    assert (norm (bp (-150)) (bp (-150)) (bp (-150)) <= 17321 / 10000 * bp (-150)) by (apply norm_equal; try lra;
      rewrite Rabs_pos_eq; lra). lra. }
  pose proof Boxes.tiny as T. assert (0 <= n * i) by (apply Rmult_le_pos; lra). rewrite v_val in *. lra.
Qed.
(* The errors of a cross product, each component a product less another. *)
Lemma permanent_norm : forall x1 x2 x3 y1 y2 y3,
  norm (Rabs x3 * Rabs y2 + Rabs x2 * Rabs y3) (Rabs x1 * Rabs y3 + Rabs x3 * Rabs y1) (Rabs x2 * Rabs y1 + Rabs x1 *
    Rabs y2) <= 14143 / 10000 * (norm x1 x2 x3 * norm y1 y2 y3).
Proof.
  intros. pose proof (norm_pos x1 x2 x3) as X0. pose proof (norm_pos y1 y2 y3) as Y0.
  apply norm_le; [apply Rmult_le_pos; [lra | now apply Rmult_le_pos]|].
  pose proof (permanents (Rabs x1) (Rabs x2) (Rabs x3) (Rabs y1) (Rabs y2) (Rabs y3)) as P.
  pose proof (norm_sq x1 x2 x3) as NX. pose proof (norm_sq y1 y2 y3) as NY. rewrite !abs_sq, <- NX, <- NY in P.
  set (n := norm x1 x2 x3) in *. set (m := norm y1 y2 y3) in *.
  assert (0 <= n * n * (m * m)) by (apply Rmult_le_pos; apply sq_pos).
  replace (14143 / 10000 * (n * m) * (14143 / 10000 * (n * m))) with (14143 * 14143 / 100000000 * (n * n * (m * m)))
    by field. lra.
Qed.
Definition tcross_1 x2 x3 y2 y3 := tminor (X x3 1) (X y2 7) (X x2 1) (X y3 7).
Lemma minor_near : forall x2 x3 y2 y3 a, Rabs x2 <= bp 1 -> Rabs x3 <= bp 1 -> Rabs y2 <= bp 7 -> Rabs y3 <= bp 7 ->
  single (tcross_1 x2 x3 y2 y3) a ->
  Rabs (a - (x3 * y2 - x2 * y3)) <= (2 + / 1000) * v * (Rabs x3 * Rabs y2 + Rabs x2 * Rabs y3) + bp (-130).
Proof.
  intros x2 x3 y2 y3 a B1 B2 B3 B4 Ha. unfold tcross_1, tminor in Ha. error32_of Ha P.
  match type of P with _ <= _ + bp ?k => assert (U : bp k <= bp (-130)) by (apply bp_le; lia) end. lra.
Qed.
Lemma cross_near : forall x1 x2 x3 y1 y2 y3 a b c m, norm x1 x2 x3 <= 1 + 2 * v -> norm y1 y2 y3 <= m -> 1 <= m <= 66 ->
  single (tcross_1 x2 x3 y2 y3) a -> single (tcross_1 x3 x1 y3 y1) b -> single (tcross_1 x1 x2 y1 y2) c ->
  norm (a - (x3 * y2 - x2 * y3)) (b - (x1 * y3 - x3 * y1)) (c - (x2 * y1 - x1 * y2)) <= (284 / 100) * v * m.
Proof.
  intros x1 x2 x3 y1 y2 y3 a b c m NX NY [M1 M2] Ha Hb Hc. pose proof v_pos as V. destruct Balls.tiny as (_ & U2 & U3).
  destruct (part_le x1 x2 x3) as (X1 & X2 & X3). destruct (part_le y1 y2 y3) as (Y1 & Y2 & Y3).
  assert (b1 : bp 1 = 2) by (simpl; lra). assert (b7 : bp 7 = 128) by (simpl; lra).
  assert (B : Rabs x1 <= bp 1 /\ Rabs x2 <= bp 1 /\ Rabs x3 <= bp 1 /\ Rabs y1 <= bp 7 /\ Rabs y2 <= bp 7 /\
    Rabs y3 <= bp 7) by (rewrite b1, b7; rewrite v_val in *; repeat split; lra).
  destruct B as (B1 & B2 & B3 & B4 & B5 & B6).
  pose proof (minor_near _ _ _ _ _ B2 B3 B5 B6 Ha) as Q1. pose proof (minor_near _ _ _ _ _ B3 B1 B6 B4 Hb) as Q2.
  pose proof (minor_near _ _ _ _ _ B1 B2 B4 B5 Hc) as Q3.
  eapply Rle_trans; [eapply norm_monotone; eassumption|]. eapply Rle_trans; [apply norm_triangle|].
  rewrite norm_scaled, Rabs_pos_eq by lra.
  assert (norm (bp (-130)) (bp (-130)) (bp (-130)) <= 17321 / 10000 * bp (-130)) by (apply norm_equal; try lra;
    rewrite Rabs_pos_eq; lra). pose proof (permanent_norm x1 x2 x3 y1 y2 y3) as K.
  set (k := norm (Rabs x3 * Rabs y2 + Rabs x2 * Rabs y3) _ _) in *.
  assert (K2 : norm x1 x2 x3 * norm y1 y2 y3 <= (1 + 2 * v) * m) by (apply mul2; split; auto using norm_pos).
  assert (v * k <= v * (14143 / 10000 * ((1 + 2 * v) * m))) by (apply Rmult_le_compat_l; lra).
  replace (v * (14143 / 10000 * ((1 + 2 * v) * m))) with (14143 / 10000 * (1 + 2 * v) * (v * m)) in * by ring.
  assert (v * 1 <= v * m) by (apply Rmult_le_compat_l; lra). rewrite v_val in *. lra.
Qed.
(* |x w|^2 + (<x|w> - t)^2 = |x - t w|^2 for a unit vector w. *)
Lemma from_line : forall x1 x2 x3 w1 w2 w3 t, norm w1 w2 w3 = 1 ->
  norm (norm (w3 * x2 - w2 * x3) (w1 * x3 - w3 * x1) (w2 * x1 - w1 * x2)) (w1 * x1 + w2 * x2 + w3 * x3 - t) 0 =
  norm (x1 - t * w1) (x2 - t * w2) (x3 - t * w3).
Proof.
  intros x1 x2 x3 w1 w2 w3 t W. unfold norm at 1 3. f_equal. rewrite norm_sq. pose proof (norm_sq w1 w2 w3) as N.
  rewrite W in N. pose proof (lagrange w1 w2 w3 x1 x2 x3) as L. rewrite <- N in L.
  replace ((x1 - t * w1) * (x1 - t * w1) + (x2 - t * w2) * (x2 - t * w2) + (x3 - t * w3) * (x3 - t * w3)) with
    (x1 * x1 + x2 * x2 + x3 * x3 - 2 * t * (w1 * x1 + w2 * x2 + w3 * x3) + t * t * (w1 * w1 + w2 * w2 + w3 * w3)) by
      ring.
  rewrite <- N. lra.
Qed.
Lemma cross_norm : forall x1 x2 x3 y1 y2 y3,
  norm (x3 * y2 - x2 * y3) (x1 * y3 - x3 * y1) (x2 * y1 - x1 * y2) <= norm x1 x2 x3 * norm y1 y2 y3.
Proof.
  intros. pose proof (norm_pos x1 x2 x3) as X0. pose proof (norm_pos y1 y2 y3) as Y0.
  apply norm_le; [now apply Rmult_le_pos|].
  replace (norm x1 x2 x3 * norm y1 y2 y3 * (norm x1 x2 x3 * norm y1 y2 y3)) with
    (norm x1 x2 x3 * norm x1 x2 x3 * (norm y1 y2 y3 * norm y1 y2 y3)) by ring. rewrite !norm_sq.
  pose proof (lagrange x1 x2 x3 y1 y2 y3). pose proof (sq_pos (x1 * y1 + x2 * y2 + x3 * y3)). lra.
Qed.
(* Squares of four and their sum, against the square of a reach that is longer by 3 v. *)
Definition tsquares a b c d := let t x := Mul (X x 2) (X x 2) in Add (t a) (Add (t b) (Add (t c) (t d))).
Lemma squares_below : forall a b c d q n reach, norm (norm a b c) d 0 <= n -> n <= 1 + / 20 -> n + 3 * v <= reach ->
  single (tsquares a b c d) q -> q <= RNs (reach * reach).
Proof.
  intros a b c d q n reach N N2 HR Hq. pose proof v_pos as V. destruct Balls.tiny as (U1 & U2 & U3).
  assert (NN : a * a + b * b + c * c + d * d <= n * n).
  { assert (E : norm (norm a b c) d 0 * norm (norm a b c) d 0 = a * a + b * b + c * c + d * d) by (rewrite !norm_sq;
      ring). rewrite <- E. apply mul2; split; auto using norm_pos. }
  assert (n0 : 0 <= n) by (eapply Rle_trans; [apply norm_pos | exact N]).
  assert (b2 : bp 2 = 4) by (simpl; lra).
  pose proof (sq_pos a) as A0. pose proof (sq_pos b) as B0. pose proof (sq_pos c) as C0. pose proof (sq_pos d) as D0.
  assert (B : Rabs a <= bp 2 /\ Rabs b <= bp 2 /\ Rabs c <= bp 2 /\ Rabs d <= bp 2).
  { assert (S : forall x, x * x <= n * n -> Rabs x <= bp 2) by (intros x H; apply Rle_trans with n;
      [now apply abs_below | rewrite b2; lra]). repeat split; apply S; lra. }
  destruct B as (B1 & B2 & B3 & B4).
  assert (Q : q <= (1 + (4 + / 100) * v) * (n * n) + bp (-130)).
  { clear - Hq B1 B2 B3 B4 NN V A0 B0 C0 D0. unfold tsquares in Hq. error32_of Hq P. rewrite !abs_sq in P.
    match type of P with _ <= _ + bp ?k => assert (T : bp k <= bp (-130)) by (apply bp_le; lia) end.
    apply Rabs_le_inv in P. set (s := a * a + (b * b + (c * c + d * d))) in *.
    assert (s <= n * n) by (unfold s; lra). assert (v * s <= v * (n * n)) by (apply Rmult_le_compat_l; lra).
    assert (0 <= v * (n * n)) by (apply Rmult_le_pos; [lra | apply sq_pos]). lra. }
  pose proof (UNIT_holds (reach * reach)) as E. rewrite (Rabs_pos_eq (reach * reach)) in E by apply sq_pos.
  apply Rabs_le_inv in E.
  assert (R : (n + 3 * v) * (n + 3 * v) <= reach * reach) by (apply mul2; split; lra).
  replace ((n + 3 * v) * (n + 3 * v)) with (n * n + 6 * (v * n) + 9 * (v * v)) in R by ring.
  assert (MM : v * (n * n) <= (1 + / 20) * (v * n)) by (replace ((1 + / 20) * (v * n)) with (v * ((1 + / 20) * n)) by
    ring;
    apply Rmult_le_compat_l; [lra|]; apply Rmult_le_compat_r; lra).
  assert (T : bp (-130) <= / 1000 * (v * v)) by (unfold UNIT; rewrite bp_sq; apply Rle_trans with (bp (-10 + -48));
    [apply bp_le; lia | rewrite bp_add; pose proof (bp_pos (-48)); simpl (bp (-10)); simpl (-24 + -24)%Z; lra]).
  assert (K : (1 - v) * (n * n + 6 * (v * n) + 9 * (v * v)) <= (1 - v) * (reach * reach)) by (apply
    Rmult_le_compat_l; [rewrite v_val; lra | assumption]).
  set (vn := v * n) in *. set (vv := v * v) in *. set (nn := n * n) in *.
  assert (V1 : v * vn <= / 1000000 * vn) by (apply Rmult_le_compat_r; [apply Rmult_le_pos; lra | rewrite v_val; lra]).
  assert (V2 : 0 < vv) by now apply Rmult_lt_0_compat.
  assert (V3 : v * vv <= / 1000000 * vv) by (apply Rmult_le_compat_r; [lra | rewrite v_val; lra]).
  assert (V4 : 0 <= vn) by (apply Rmult_le_pos; lra).
  replace ((1 - v) * (nn + 6 * vn + 9 * vv)) with (nn + 6 * vn + 9 * vv - v * nn - 6 * (v * vn) - 9 * (v * vv))
    in K by ring. lra.
Qed.
(* The distance of a center from what is left of a ray: an origin s, a direction x in f32 and w exactly, a hit P. *)
Section Distance.
Variables D slack r tau last s1 s2 s3 w1 w2 w3 x1 x2 x3 c1 c2 c3 P1 P2 P3 : R.
Hypotheses (D1 : 1 <= D) (D64 : D <= 65) (SL : (SLACK - / 100) * v * D <= slack <= (SLACK + / 100) * v * D)
  (Hw : norm w1 w2 w3 = 1) (Hx : norm (x1 - w1) (x2 - w2) (x3 - w3) <= (1 + / 500) * v)
  (Hx1 : norm x1 x2 x3 <= 1 + 2 * v) (Hcs : norm (c1 - s1) (c2 - s2) (c3 - s3) <= D + / 500)
  (HP : norm (P1 - (s1 + tau * w1)) (P2 - (s2 + tau * w2)) (P3 - (s3 + tau * w3)) <= (1 + / 500) * v * D)
  (Hr : 0 <= r <= 1 + / 100) (Hin : norm (c1 - P1) (c2 - P2) (c3 - P3) <= r) (Htau : 0 <= tau <= last).
Let y1 := RNs (c1 - s1). Let y2 := RNs (c2 - s2). Let y3 := RNs (c3 - s3).
Lemma distance_below : forall a b c t q, single (tcross_1 x2 x3 y2 y3) a -> single (tcross_1 x3 x1 y3 y1) b ->
  single (tcross_1 x1 x2 y1 y2) c -> single (tfused (X x1 1) (X x2 1) (X x3 1) (X y1 7) (X y2 7) (X y3 7)) t ->
  single (tsquares a b c (RNs (t - Rmin (Rmax t 0) last))) q -> let reach := RNs (r + slack) in q <= RNs (reach *
    reach).
Proof.
  intros a b c t q Ha Hb Hc Ht Hq reach. pose proof v_pos as V. destruct Balls.tiny as (_ & U2 & U3).
  pose proof Boxes.tiny as T. pose proof (bp_pos (-150)) as B0. assert (VD : 0 < v * D) by (apply Rmult_lt_0_compat;
    lra).
  assert (V1 : v <= v * D) by nra. assert (V2 : v * D <= 65 * v) by nra.
  assert (EY : norm (y1 - (c1 - s1)) (y2 - (c2 - s2)) (y3 - (c3 - s3)) <= (1 + / 200) * v * D).
  { pose proof (UNIT_holds (c1 - s1)) as E1. pose proof (UNIT_holds (c2 - s2)) as E2.
    pose proof (UNIT_holds (c3 - s3)) as E3. eapply Rle_trans; [eapply norm_monotone; eassumption|].
    eapply Rle_trans; [apply norm_triangle|]. rewrite norm_scaled, norm_abs, Rabs_pos_eq by lra.
    assert (norm (bp (-150)) (bp (-150)) (bp (-150)) <= 17321 / 10000 * bp (-150)) by (apply norm_equal; try lra;
      rewrite Rabs_pos_eq; lra).
    assert (v * norm (c1 - s1) (c2 - s2) (c3 - s3) <= v * (D + / 500)) by (apply Rmult_le_compat_l; lra). lra. }
  set (m := D + / 100). assert (NY : norm y1 y2 y3 <= m).
  { pose proof (norm_difference y1 y2 y3 (c1 - s1) (c2 - s2) (c3 - s3)). unfold m. rewrite v_val in *. lra. }
  clearbody y1 y2 y3. assert (M0 : 1 <= m <= 66) by (unfold m; lra).
  assert (VM : 0 < v * m) by (apply Rmult_lt_0_compat; lra).
  (* across *)
  assert (EA : norm (a - (w3 * y2 - w2 * y3)) (b - (w1 * y3 - w3 * y1)) (c - (w2 * y1 - w1 * y2)) <=
    (385 / 100) * v * m).
  { pose proof (cross_near x1 x2 x3 y1 y2 y3 a b c m Hx1 NY M0 Ha Hb Hc) as E.
    pose proof (cross_norm (x1 - w1) (x2 - w2) (x3 - w3) y1 y2 y3) as G.
    assert (G2 : norm (x1 - w1) (x2 - w2) (x3 - w3) * norm y1 y2 y3 <= (1 + / 500) * v * m) by (apply mul2; split;
      auto using norm_pos).
    eapply Rle_trans; [apply (norm_difference _ _ _ (a - (x3 * y2 - x2 * y3)) (b - (x1 * y3 - x3 * y1))
      (c - (x2 * y1 - x1 * y2)))|].
    replace (a - (w3 * y2 - w2 * y3) - (a - (x3 * y2 - x2 * y3))) with ((x3 - w3) * y2 - (x2 - w2) * y3) by ring.
    replace (b - (w1 * y3 - w3 * y1) - (b - (x1 * y3 - x3 * y1))) with ((x1 - w1) * y3 - (x3 - w3) * y1) by ring.
    replace (c - (w2 * y1 - w1 * y2) - (c - (x2 * y1 - x1 * y2))) with ((x2 - w2) * y1 - (x1 - w1) * y2) by ring. lra. }
  (* along *)
  set (g := w1 * y1 + w2 * y2 + w3 * y3).
  assert (ET : Rabs (t - g) <= (402 / 100) * v * m).
  { destruct (part_le x1 x2 x3) as (X1 & X2 & X3). destruct (part_le y1 y2 y3) as (Y1 & Y2 & Y3).
    assert (b1 : bp 1 = 2) by (simpl; lra). assert (b7 : bp 7 = 128) by (simpl; lra).
    assert (B : Rabs x1 <= bp 1 /\ Rabs x2 <= bp 1 /\ Rabs x3 <= bp 1 /\ Rabs y1 <= bp 7 /\ Rabs y2 <= bp 7 /\
      Rabs y3 <= bp 7) by (rewrite b1, b7; rewrite v_val in *; repeat split; lra).
    destruct B as (B1 & B2 & B3 & B4 & B5 & B6).
    assert (Z : Rabs x1 * Rabs y1 + Rabs x2 * Rabs y2 + Rabs x3 * Rabs y3 <= (1 + 2 * v) * m).
    { eapply Rle_trans; [apply dot_bound|]. apply mul2; split; auto using norm_pos. }
    assert (E : Rabs (t - (x1 * y1 + (x2 * y2 + x3 * y3))) <= (3 + / 200) * v * m).
    { clear - Ht B1 B2 B3 B4 B5 B6 Z V VM M0 U2 U3. unfold tfused in Ht. error32_of Ht P.
      match type of P with _ <= _ + bp ?k => assert (U : bp k <= bp (-130)) by (apply bp_le; lia) end.
      assert (v * (Rabs x1 * Rabs y1 + Rabs x2 * Rabs y2 + Rabs x3 * Rabs y3) <= v * ((1 + 2 * v) * m)) by (apply
        Rmult_le_compat_l; lra). replace (v * ((1 + 2 * v) * m)) with ((1 + 2 * v) * (v * m)) in * by ring.
      assert (v * 1 <= v * m) by (apply Rmult_le_compat_l; lra). rewrite v_val in *. lra. }
    pose proof (dot_le (x1 - w1) (x2 - w2) (x3 - w3) y1 y2 y3) as G.
    assert (G2 : norm (x1 - w1) (x2 - w2) (x3 - w3) * norm y1 y2 y3 <= (1 + / 500) * v * m) by (apply mul2; split;
      auto using norm_pos).
    replace (t - g) with ((t - (x1 * y1 + (x2 * y2 + x3 * y3))) + ((x1 - w1) * y1 + (x2 - w2) * y2 + (x3 - w3) * y3)) by
      (unfold g; ring). eapply Rle_trans; [apply Rabs_triang|]. lra. }
  set (beyond := RNs (t - Rmin (Rmax t 0) last)) in *.
  assert (EB : Rabs beyond <= Rabs (g - tau) + (402 / 100) * v * m + (v * Rabs (g - tau) + / 100 * v)).
  { pose proof (clamp_near t 0 last tau Htau) as C. pose proof (UNIT_holds (t - Rmin (Rmax t 0) last)) as E.
    fold beyond in E. set (d := t - Rmin (Rmax t 0) last) in *.
    assert (TT : Rabs (t - tau) <= Rabs (g - tau) + (402 / 100) * v * m).
    { replace (t - tau) with ((t - g) + (g - tau)) by ring. eapply Rle_trans; [apply Rabs_triang|]. lra. }
    replace beyond with ((beyond - d) + d) by ring. eapply Rle_trans; [apply Rabs_triang|].
    assert (v * Rabs d <= v * (Rabs (g - tau) + (402 / 100) * v * m)) by (apply Rmult_le_compat_l; lra).
    assert (v * (v * m) <= / 10000 * v) by (rewrite <- Rmult_assoc, (Rmult_comm (/ 10000)), Rmult_assoc;
      apply Rmult_le_compat_l; rewrite v_val in *; lra). lra. }
  (* together *)
  set (M := norm (y1 - tau * w1) (y2 - tau * w2) (y3 - tau * w3)).
  assert (MB : M <= r + (201 / 100) * v * D).
  { unfold M. replace (y1 - tau * w1) with ((c1 - P1) + (P1 - (s1 + tau * w1)) + (y1 - (c1 - s1))) by ring.
    replace (y2 - tau * w2) with ((c2 - P2) + (P2 - (s2 + tau * w2)) + (y2 - (c2 - s2))) by ring.
    replace (y3 - tau * w3) with ((c3 - P3) + (P3 - (s3 + tau * w3)) + (y3 - (c3 - s3))) by ring.
    eapply Rle_trans; [apply norm_triangle|]. eapply Rle_trans; [apply Rplus_le_compat_r, norm_triangle|]. lra. }
  pose proof (from_line y1 y2 y3 w1 w2 w3 tau Hw) as FL. fold g in FL. fold M in FL.
  set (C := norm (w3 * y2 - w2 * y3) (w1 * y3 - w3 * y1) (w2 * y1 - w1 * y2)) in *.
  destruct (part_le C (g - tau) 0) as (_ & GM & _). rewrite FL in GM.
  assert (NA : norm a b c <= C + (385 / 100) * v * m).
  { eapply Rle_trans; [apply (norm_difference _ _ _ (w3 * y2 - w2 * y3) (w1 * y3 - w3 * y1) (w2 * y1 - w1 * y2))|].
    fold C. lra. }
  assert (C0 : 0 <= C) by apply norm_pos.
  assert (NN : norm (norm a b c) beyond 0 <= M + (557 / 100) * v * m + (v * M + / 100 * v)).
  { eapply Rle_trans; [apply (norm_monotone _ _ _ (C + (385 / 100) * v * m) (Rabs (g - tau) + ((402 / 100) * v * m +
      (v * Rabs (g - tau) + / 100 * v))) (0 + 0)); [rewrite Rabs_pos_eq by apply norm_pos; exact NA | lra |
      rewrite Rabs_R0; lra]|].
    eapply Rle_trans; [apply norm_triangle|].
    replace (norm C (Rabs (g - tau)) 0) with M by (rewrite <- FL; unfold norm; now rewrite abs_sq).
    rewrite Rplus_assoc. apply Rplus_le_compat_l.
    replace (norm (385 / 100 * v * m) (402 / 100 * v * m + (v * Rabs (g - tau) + / 100 * v)) 0) with
      (norm (385 / 100 * v * m + 0) (402 / 100 * v * m + (v * Rabs (g - tau) + / 100 * v)) (0 + 0)) by (f_equal; ring).
    eapply Rle_trans; [apply norm_triangle|]. pose proof (Rabs_pos (g - tau)).
    assert (0 <= v * Rabs (g - tau) <= v * M) by (split; [apply Rmult_le_pos | apply Rmult_le_compat_l]; lra).
    apply Rplus_le_compat.
    - apply norm_le; [lra|]. set (z := v * m) in *. replace (385 / 100 * v * m) with (385 / 100 * z) by (unfold z;
      ring).
      replace (402 / 100 * v * m) with (402 / 100 * z) by (unfold z; ring).
      replace (557 / 100 * v * m) with (557 / 100 * z) by (unfold z; ring). pose proof (sq_pos z). lra.
    - eapply Rle_trans; [apply norm_le_sum|]. rewrite Rabs_R0, Rabs_pos_eq by lra. lra. }
  assert (M2 : v * M <= v * (1 + / 50)) by (apply Rmult_le_compat_l; rewrite v_val in *; lra).
  apply (squares_below a b c beyond q _ reach NN); [unfold m in *; rewrite v_val in *; lra| |exact Hq].
  pose proof (UNIT_holds (r + slack)) as E. fold reach in E. unfold SLACK in *.
  rewrite (Rabs_pos_eq (r + slack)) in E by
    (rewrite v_val in *; lra). apply Rabs_le_inv in E. unfold m in *.
  assert (v * r <= v * (1 + / 100)) by (apply Rmult_le_compat_l; lra).
  assert (v * slack <= / 1000 * v) by (rewrite (Rmult_comm v); apply Rmult_le_compat_r; rewrite v_val in *; lra). lra.
Qed.
End Distance.
(* A vector as it is normalised: zero, or of a computed square that is not too small. *)
Definition recip q := RNs (/ RNs (sqrt q)).
Definition normalised n1 n2 n3 := (n1 = 0 /\ n2 = 0 /\ n3 = 0) \/ exists f1 f2 f3 q, Rabs f1 <= bp 64 /\ Rabs f2 <= bp
  64
  /\ Rabs f3 <= bp 64 /\ single (tdot (X f1 64) (X f2 64) (X f3 64) (X f1 64) (X f2 64) (X f3 64)) q /\ LEAST_NORMAL <=
    q
  /\ n1 = RNs (f1 * recip q) /\ n2 = RNs (f2 * recip q) /\ n3 = RNs (f3 * recip q).
Lemma normalised_short : forall n1 n2 n3, normalised n1 n2 n3 -> norm n1 n2 n3 <= 1 + 5 * v.
Proof.
  intros n1 n2 n3 [(E1 & E2 & E3)|(f1 & f2 & f3 & q & H1 & H2 & H3 & Hq & L & E1 & E2 & E3)]; rewrite E1, E2, E3.
  - eapply Rle_trans; [apply norm_le_sum|]. rewrite Rabs_R0. pose proof v_pos. lra.
  - exact (LEAST_NORMAL_holds f1 f2 f3 q H1 H2 H3 Hq L).
Qed.
(* A plane around the rays: its normal, and what the largest computed product of it with one of their directions moves
   it
   by; how far a center is beyond it. *)
Definition side far slack s1 s2 s3 x1 x2 x3 c1 c2 c3 b := exists n1 n2 n3 m a h, normalised n1 n2 n3 /\
  single (tdot (X n1 1) (X n2 1) (X n3 1) (X s1 7) (X s2 7) (X s3 7)) m /\
  single (tfused (X x1 1) (X x2 1) (X x3 1) (X n1 1) (X n2 1) (X n3 1)) a /\ a <= h /\ 0 <= h <= 1 + / 100 /\
  single (tbeyond c1 c2 c3 n1 n2 n3 (RNs (m + RNs (slack + RNs (RNs (OUTSIDE * far) * h))))) b.
(* The middle of the least and the greatest direction. *)
Definition middle g a b := RNs (g * a + g * b).
Lemma middle_long : forall g a b x, slopes g a b x -> Fs x ->
  Rabs x <= Rabs (middle g a b) <= 3 /\ forall i, 0 <= i -> 0 <= RNs (middle g a b * i) * x.
Proof.
  intros g a b x (G & A & B) Fx. assert (M : middle g a b = g * RNs (a + b)).
  { unfold middle. destruct G as [E|E]; rewrite E.
    - rewrite !Rmult_1_l. reflexivity.
    - replace (- 1 * a + - 1 * b) with (- (a + b)) by ring. rewrite RNs_opp. ring. }
  assert (F3 : Fs 3) by (replace 3 with (IZR 3 * bp 0) by (simpl; lra); apply Fs_scaled; lia).
  assert (K : g * x <= RNs (a + b) <= 3).
  { split; [apply RNs_above; [|lra] | apply RNs_below; [assumption | lra]].
    destruct G as [E|E]; rewrite E; [now rewrite Rmult_1_l | replace (- 1 * x) with (- x) by ring; now apply Fs_opp]. }
  rewrite M. set (k := RNs (a + b)) in *. assert (S : forall z, Rabs (g * z) = Rabs z).
  { intro z. rewrite Rabs_mult. destruct G as [E|E]; rewrite E; [rewrite Rabs_R1; ring | rewrite (Rabs_left (- 1));
    lra]. }
  rewrite S, <- (S x), !Rabs_pos_eq by lra. split; [assumption|]. intros i I.
  assert (GG : g * g = 1) by (destruct G as [E|E]; rewrite E; ring).
  assert (R : RNs (g * k * i) = g * RNs (k * i)).
  { destruct G as [E|E]; rewrite E; [now rewrite !Rmult_1_l|]. replace (- 1 * k * i) with (- (k * i)) by ring.
    rewrite RNs_opp. ring. }
  rewrite R. replace (g * RNs (k * i) * x) with (RNs (k * i) * (g * x)) by ring. apply Rmult_le_pos; [|lra].
  apply RNs_above; [apply Fs_0 | apply Rmult_le_pos; lra].
Qed.
(* ---- A tile's origin ---- *)
Section Tile.
(* the origin's image as computed and exactly *)
Variables o1 o2 o3 p1 p2 p3 : R.
Let reach := RN (1 + RN (RN (Rabs o1 + Rabs o2) + Rabs o3)).
Let error := RN (reach * LINE_ERROR).
Let far := up reach.
Let slack := RNs (RNs (SLACK * v * far) + up error).
Let D := Rabs o1 + Rabs o2 + Rabs o3 + 1.
Hypotheses (Hp1 : Rabs (o1 - p1) <= (1 + / 1000) * u * Rabs o1 + bp (-52))
  (Hp2 : Rabs (o2 - p2) <= (1 + / 1000) * u * Rabs o2 + bp (-52))
  (Hp3 : Rabs (o3 - p3) <= (1 + / 1000) * u * Rabs o3 + bp (-52)) (Hreach : reach <= REACH).

Lemma D_1 : 1 <= D. Proof. unfold D. pose proof (Rabs_pos o1). pose proof (Rabs_pos o2). pose proof (Rabs_pos o3). lra.
Qed.
Lemma reach_near : (1 - 4 * u) * D <= reach <= (1 + 4 * u) * D.
Proof.
  pose proof (Rabs_pos o1) as A1. pose proof (Rabs_pos o2) as A2. pose proof (Rabs_pos o3) as A3.
  pose proof (RN_err (Rabs o1 + Rabs o2)) as E1. rewrite (Rabs_pos_eq (_ + _)) in E1 by lra.
  set (s := RN (Rabs o1 + Rabs o2)) in *. assert (s0 : 0 <= s) by (unfold s; rewrite <- RN_0; apply RN_le; lra).
  pose proof (RN_err (s + Rabs o3)) as E2. rewrite (Rabs_pos_eq (_ + _)) in E2 by lra.
  set (t := RN (s + Rabs o3)) in *. assert (t0 : 0 <= t) by (unfold t; rewrite <- RN_0; apply RN_le; lra).
  pose proof (RN_err (1 + t)) as E3. rewrite (Rabs_pos_eq (_ + _)) in E3 by lra.
  change (RN (1 + t)) with reach in E3. assert (T : bp (-1075) <= / 1000000 * u) by (apply Rle_trans with
    (bp (-20 + -53)); [apply bp_le; lia|]; rewrite bp_add; fold u; simpl (bp (-20)); pose proof u_pos; lra).
  apply Rabs_le_inv in E1. apply Rabs_le_inv in E2. apply Rabs_le_inv in E3. unfold D. rewrite u_val in *. lra.
Qed.
(* All is of the size of D, and that is not large. *)
Lemma D_64 : D <= 64 + / 1000. Proof. pose proof reach_near. unfold REACH in *. rewrite u_val in *. lra. Qed.
Lemma far_near : (1 + / 4 * v) * D <= far <= (1 + 6 * v) * D.
Proof.
  pose proof reach_near as R. pose proof D_1 as D1. assert (R1 : 1 <= reach).
  { unfold reach. rewrite <- (RN_id 1) at 1 by (apply (F_bp 0); lia). apply RN_le.
    assert (0 <= RN (RN (Rabs o1 + Rabs o2) + Rabs o3)); [|lra]. rewrite <- RN_0. apply RN_le.
    assert (0 <= RN (Rabs o1 + Rabs o2)) by (rewrite <- RN_0; apply RN_le; pose proof (Rabs_pos o1);
      pose proof (Rabs_pos o2); lra). pose proof (Rabs_pos o3). lra. }
  pose proof (up_beyond reach R1) as E. fold far in E. rewrite u_val, v_val in *. lra.
Qed.
Lemma far_F : Fs far. Proof. apply RNs_F. Qed.
Lemma error_near : (128 - / 10) * u * D <= error <= 129 * u * D.
Proof.
  pose proof reach_near as R. pose proof D_1 as D1.
  assert (LV : LINE_ERROR = 128 * u) by (unfold LINE_ERROR, u; change (-46)%Z with (7 + -53)%Z; rewrite bp_add;
    reflexivity).
  pose proof (RN_err (reach * LINE_ERROR)) as E. fold error in E. rewrite LV in E. pose proof u_pos as U.
  assert (R0 : 0 <= reach) by (rewrite u_val in *; lra).
  rewrite (Rabs_pos_eq (reach * _)) in E by (apply Rmult_le_pos; lra). apply Rabs_le_inv in E.
  assert (T : bp (-1075) <= / 1000000 * u) by (apply Rle_trans with
    (bp (-20 + -53)); [apply bp_le; lia|]; rewrite bp_add; fold u; simpl (bp (-20)); lra).
  rewrite u_val in *. lra.
Qed.
Lemma slack_near : (SLACK - / 100) * v * D <= slack <= (SLACK + / 100) * v * D.
Proof.
  pose proof far_near as FA. pose proof error_near as E. pose proof D_1 as D1. pose proof D_64 as D64.
  pose proof (UNIT_holds (SLACK * v * far)) as E1. unfold SLACK in *. pose proof v_pos as V.
  assert (F0 : 0 <= far) by (rewrite v_val in *; lra).
  rewrite (Rabs_pos_eq (32 * v * far)) in E1 by (apply Rmult_le_pos; lra). apply Rabs_le_inv in E1.
  pose proof Boxes.tiny as T. assert (U0 : 0 <= up error <= / 1000 * v).
  { split; [apply Rle_trans with (2 := up_above _); rewrite u_val in *; lra|]. unfold up.
    pose proof (UNIT_holds error) as F1. set (n := RNs error) in *. assert (e0 : 0 <= error) by (rewrite u_val in *;
      lra). rewrite (Rabs_pos_eq error) in F1 by assumption. apply Rabs_le_inv in F1.
    assert (n0 : 0 <= n) by (unfold n; apply RNs_above; [apply Fs_0 | assumption]).
    rewrite (Rabs_pos_eq n) by assumption.
    assert (B : bp (-23) = 2 * v) by (rewrite v_val; simpl; lra). rewrite B.
    assert (T3 : bp (-126) <= / 1000000 * v) by (apply Rle_trans with (bp (-40 + -24)); [apply bp_le; lia|];
      rewrite bp_add; fold UNIT; simpl (bp (-40)); lra). pose proof (bp_pos (-126)) as T0.
    pose proof (UNIT_holds (n * (2 * v))) as F2. set (m := RNs (n * (2 * v))) in *.
    assert (N0 : 0 <= n * (2 * v)) by (apply Rmult_le_pos; lra). rewrite (Rabs_pos_eq (n * _)) in F2 by assumption.
    apply Rabs_le_inv in F2. assert (m0 : 0 <= m) by (unfold m; apply RNs_above; [apply Fs_0 | assumption]).
    pose proof (UNIT_holds (m + bp (-126))) as F3. set (k := RNs (m + bp (-126))) in *.
    rewrite (Rabs_pos_eq (m + _)) in F3 by lra. apply Rabs_le_inv in F3.
    assert (k0 : 0 <= k) by (unfold k; apply RNs_above; [apply Fs_0 | lra]). pose proof (UNIT_holds (n + k)) as F4.
    rewrite (Rabs_pos_eq (n + k)) in F4 by lra. apply Rabs_le_inv in F4. rewrite u_val, v_val in *. lra. }
  set (m := RNs (32 * v * far)) in *.
  assert (m0 : 0 <= m) by (unfold m; apply RNs_above; [apply Fs_0 | apply Rmult_le_pos; lra]).
  pose proof (UNIT_holds (m + up error)) as E2. fold slack in E2. rewrite (Rabs_pos_eq (m + _)) in E2 by lra.
  apply Rabs_le_inv in E2. rewrite v_val in *. lra.
Qed.
Let s1 := RNs o1. Let s2 := RNs o2. Let s3 := RNs o3.
Lemma o_norm : norm o1 o2 o3 <= D - 1. Proof. unfold D. pose proof (norm_le_sum o1 o2 o3). lra. Qed.
Lemma image_near : norm (p1 - o1) (p2 - o2) (p3 - o3) <= 5 * u * D.
Proof.
  rewrite Rabs_minus_sym in Hp1, Hp2, Hp3. assert (B : bp (-52) = 2 * u) by (unfold u; change (-52)%Z with (1 + -53)%Z;
    rewrite bp_add, bp_1; reflexivity). rewrite B in *. pose proof u_pos as U. pose proof D_1 as D1.
  eapply Rle_trans; [eapply norm_monotone; eassumption|]. eapply Rle_trans; [apply norm_triangle|].
  rewrite norm_scaled, norm_abs, Rabs_pos_eq by lra.
  assert (norm (2 * u) (2 * u) (2 * u) <= 17321 / 10000 * (2 * u)) by (apply norm_equal; try lra; rewrite Rabs_pos_eq;
    lra).
  pose proof o_norm as O. assert (u * norm o1 o2 o3 <= u * (D - 1)) by (apply Rmult_le_compat_l; lra).
  assert (u <= u * D) by nra. lra.
Qed.
Lemma origin_near : norm (o1 - s1) (o2 - s2) (o3 - s3) <= v * (D - 1) + / 1000 * v /\ norm s1 s2 s3 <= D - 1 + 65 * v.
Proof.
  pose proof (UNIT_holds o1) as E1. pose proof (UNIT_holds o2) as E2. pose proof (UNIT_holds o3) as E3. fold s1 in E1.
  fold s2 in E2. fold s3 in E3. pose proof Boxes.tiny as T. pose proof (bp_pos (-150)) as T0. pose proof v_pos as V.
  pose proof o_norm as O. pose proof D_64 as D64.
  assert (N : norm (s1 - o1) (s2 - o2) (s3 - o3) <= v * (D - 1) + / 1000 * v).
  { eapply Rle_trans; [eapply norm_monotone; eassumption|]. eapply Rle_trans; [apply norm_triangle|].
    rewrite norm_scaled, norm_abs, Rabs_pos_eq by lra.
    assert (norm (bp (-150)) (bp (-150)) (bp (-150)) <= 17321 / 10000 * bp (-150)) by (apply norm_equal; try lra;
      rewrite Rabs_pos_eq; lra).
    assert (v * norm o1 o2 o3 <= v * (D - 1)) by (apply Rmult_le_compat_l; lra). lra. }
  split.
  - replace (o1 - s1) with (- (s1 - o1)) by ring. replace (o2 - s2) with (- (s2 - o2)) by ring.
    replace (o3 - s3) with (- (s3 - o3)) by ring. now rewrite norm_opp.
  - pose proof (norm_difference s1 s2 s3 o1 o2 o3). assert (v * (D - 1) <= v * (63 + / 1000)) by (apply
      Rmult_le_compat_l; lra). lra.
Qed.

Lemma sizes : D <= far <= (1 + 6 * v) * D /\ D <= REACH + / 1000.
Proof.
  pose proof far_near as F. pose proof D_1 as D1. pose proof D_64 as D64. unfold REACH. rewrite v_val in *. lra.
Qed.
(* What the largest parameter is for: every number of the tests is of the order of it, in the range of f32. *)
Theorem REACH_holds : 1 <= far <= REACH + / 2 /\ 0 < slack <= / 7000 /\ norm s1 s2 s3 <= REACH.
Proof.
  destruct sizes as [F D64]. pose proof D_1 as D1. pose proof slack_near as SL. destruct origin_near as [_ O].
  unfold SLACK, REACH in *. rewrite v_val in *. repeat split; lra.
Qed.

(* ---- A ray of the tile, and what it hits ---- *)
Section Ray.
(* its direction, the power of two that units of t are multiplied with, a hit's parameter rounded and exactly *)
Variables d1 d2 d3 S kappa t t' : R.
Let l := norm d1 d2 d3.
Let length := RN (sqrt S). Let k := RN (length * RN (/ S)). Let len := RN (length * kappa).
Let w1 := d1 / l. Let w2 := d2 / l. Let w3 := d3 / l.
(* the direction in f32 *)
Let x1 := RNs (RN (d1 * k)). Let x2 := RNs (RN (d2 * k)). Let x3 := RNs (RN (d3 * k)).
Hypotheses (Hd1 : Rabs d1 <= bp 100) (Hd2 : Rabs d2 <= bp 100) (Hd3 : Rabs d3 <= bp 100)
  (Hlong : bp (-200) <= d1 * d1 + d2 * d2 + d3 * d3).
Hypothesis HS : plain (tdot (X d1 100) (X d2 100) (X d3 100) (X d1 100) (X d2 100) (X d3 100)) S.
Hypotheses (K0 : 0 < kappa) (Hnormal : bp (-1022) < len) (Hfinite : len < bp 1024)
  (Ht : Rabs (t - t') <= u * Rabs t' + bp (-1075)) (Ht0 : 0 <= t).
Let P1 := p1 + t' * (kappa * d1). Let P2 := p2 + t' * (kappa * d2). Let P3 := p3 + t' * (kappa * d3).
Hypothesis HP : P1 * P1 + P2 * P2 + P3 * P3 <= 1.
Let long := l * kappa.
(* the parameter in cull coordinates; it may be below zero by what rounding is *)
Let tau := Rmax (t' * long) 0.

Lemma line_facts : (forall d, Rabs (RNs (RN (d * k)) - d / l) <= (1 + / 1000) * v * Rabs (d / l) + bp (-130)) /\
  Rabs (len - long) <= (37 / 10) * u * long /\ 0 < long <= (1 + / 100) * bp 1024.
Proof.
  assert (Z : Rabs (0 - 0) <= (1 + / 1000) * u * Rabs 0 + IMAGE) by (rewrite Rminus_0_r, Rabs_R0, Rmult_0_r,
    Rplus_0_l; pose proof u_pos; lra).
  assert (Q : exists dot, plain (tdot (X 0 45) (X 0 45) (X 0 45) (X d1 100) (X d2 100) (X d3 100)) dot)
    by (eexists; unfold tdot; plain_terms).
  destruct Q as [dot Q]. set (g := RN (dot * RN (/ S))).
  pose proof (RN_err (d1 * g)) as G1. pose proof (RN_err (d2 * g)) as G2. pose proof (RN_err (d3 * g)) as G3.
  split.
  - exact (direction_near 0 0 0 0 0 0 d1 d2 d3 Hd1 Hd2 Hd3 Hlong Z Z Z S dot _ _ _ HS Q G1 G2 G3).
  - exact (len_near 0 0 0 0 0 0 d1 d2 d3 Hd1 Hd2 Hd3 Hlong Z Z Z S dot _ _ _ HS Q G1 G2 G3 kappa K0 Hnormal
      Hfinite).
Qed.
Lemma w_norm : norm w1 w2 w3 = 1. Proof. exact (w_unit d1 d2 d3 Hlong). Qed.
Lemma on_line : P1 = p1 + t' * long * w1 /\ P2 = p2 + t' * long * w2 /\ P3 = p3 + t' * long * w3.
Proof.
  pose proof (l_pos d1 d2 d3 Hlong) as L0. fold l in L0. unfold P1, P2, P3, long, w1, w2, w3.
  repeat split; field; lra.
Qed.
(* Not below zero but by rounding, and not beyond the largest. *)
Lemma tau_range : Rabs (tau - t' * long) <= 16 * u /\ 0 <= tau <= (1 + 6 * u) * D.
Proof.
  destruct line_facts as (_ & _ & L0 & L1). destruct on_line as (H1 & H2 & H3). pose proof D_1 as D1.
  pose proof u_pos as U.
  assert (A : t' * long <= (1 + 6 * u) * D).
  { apply Rle_trans with (Rabs (t' * long)); [apply Rle_abs|]. pose proof w_norm as W.
    assert (E : Rabs (t' * long) = norm (P1 - p1) (P2 - p2) (P3 - p3)).
    { rewrite H1, H2, H3. replace (p1 + t' * long * w1 - p1) with (t' * long * w1) by ring.
      replace (p2 + t' * long * w2 - p2) with (t' * long * w2) by ring.
      replace (p3 + t' * long * w3 - p3) with (t' * long * w3) by ring. rewrite norm_scaled, W. ring. }
    rewrite E. assert (PN : norm P1 P2 P3 <= 1) by (apply norm_le; lra).
    pose proof (norm_triangle P1 P2 P3 (- p1) (- p2) (- p3)) as T. rewrite norm_opp in T. unfold Rminus in *.
    pose proof (norm_difference p1 p2 p3 o1 o2 o3) as T2. pose proof image_near as I. pose proof o_norm as O.
    assert (0 <= u * D) by (apply Rmult_le_pos; lra). lra. }
  assert (B : - (16 * u) <= t' * long).
  { destruct (Rle_or_lt 0 t') as [N|N]; [assert (0 <= t' * long) by (apply Rmult_le_pos; lra); lra|].
    assert (T : - t' <= 2 * bp (-1075)).
    { apply Rabs_le_inv in Ht. rewrite (Rabs_left t') in Ht by assumption. pose proof (bp_pos (-1075)).
      rewrite u_val in *. lra. }
    assert (- t' * long <= 2 * bp (-1075) * ((1 + / 100) * bp 1024)) by (apply mul2; lra).
    assert (X : 2 * bp (-1075) * ((1 + / 100) * bp 1024) = 2 * (1 + / 100) * bp (-1075 + 1024)) by (rewrite bp_add;
      ring). change (-1075 + 1024)%Z with (2 + -53)%Z in X. rewrite bp_add in X. fold u in X. simpl (bp 2) in X. lra. }
  unfold tau. unfold Rmax. destruct Rle_dec as [N|N].
  - split; [|rewrite u_val in *; lra]. apply Rabs_le. lra.
  - split; [|lra]. apply Rabs_le. lra.
Qed.
Lemma tau_far : tau <= far.
Proof. pose proof tau_range as [_ T]. pose proof far_near as F. pose proof D_1. rewrite u_val, v_val in *. lra. Qed.
(* The hit from the origin and along the direction in f32: both errors together, and that of the origin alone. *)
Lemma hit_near : norm (P1 - (s1 + tau * w1)) (P2 - (s2 + tau * w2)) (P3 - (s3 + tau * w3)) <= (1 + / 500) * v * D /\
  norm (x1 - w1) (x2 - w2) (x3 - w3) <= (1 + / 500) * v /\
  norm (P1 - (s1 + tau * x1)) (P2 - (s2 + tau * x2)) (P3 - (s3 + tau * x3)) <= (2 + / 200) * v * D.
Proof.
  destruct line_facts as (X & _). pose proof (X d1) as X1. pose proof (X d2) as X2. pose proof (X d3) as X3.
  fold w1 in X1. fold w2 in X2. fold w3 in X3. fold x1 in X1. fold x2 in X2. fold x3 in X3. clear X.
  destruct on_line as (H1 & H2 & H3). destruct tau_range as [T1 [T0 T2]]. pose proof image_near as I.
  destruct origin_near as [O _]. pose proof w_norm as W. pose proof D_1 as D1. pose proof v_pos as V.
  assert (A : norm (P1 - (s1 + tau * w1)) (P2 - (s2 + tau * w2)) (P3 - (s3 + tau * w3)) <= (1 + / 500) * v * D).
  { replace (P1 - (s1 + tau * w1)) with ((p1 - o1) + (o1 - s1) + (t' * long - tau) * w1) by (rewrite H1; ring).
    replace (P2 - (s2 + tau * w2)) with ((p2 - o2) + (o2 - s2) + (t' * long - tau) * w2) by (rewrite H2; ring).
    replace (P3 - (s3 + tau * w3)) with ((p3 - o3) + (o3 - s3) + (t' * long - tau) * w3) by (rewrite H3; ring).
    eapply Rle_trans; [apply norm_triangle|]. eapply Rle_trans; [apply Rplus_le_compat_r, norm_triangle|].
    rewrite norm_scaled, W, Rabs_minus_sym. rewrite u_val, v_val in *. lra. }
  assert (B : norm (x1 - w1) (x2 - w2) (x3 - w3) <= (1 + / 500) * v).
  { eapply Rle_trans; [eapply norm_monotone; eassumption|]. eapply Rle_trans; [apply norm_triangle|].
    rewrite norm_scaled, norm_abs, W, Rabs_pos_eq by lra. destruct Balls.tiny as (_ & U2 & U3).
    assert (norm (bp (-130)) (bp (-130)) (bp (-130)) <= 17321 / 10000 * bp (-130)) by (apply norm_equal; try lra;
      rewrite Rabs_pos_eq; lra). lra. }
  split; [assumption|]. split; [assumption|].
  replace (P1 - (s1 + tau * x1)) with (P1 - (s1 + tau * w1) + - tau * (x1 - w1)) by ring.
  replace (P2 - (s2 + tau * x2)) with (P2 - (s2 + tau * w2) + - tau * (x2 - w2)) by ring.
  replace (P3 - (s3 + tau * x3)) with (P3 - (s3 + tau * w3) + - tau * (x3 - w3)) by ring.
  eapply Rle_trans; [apply norm_triangle|]. rewrite norm_scaled, Rabs_Ropp, (Rabs_pos_eq tau) by assumption.
  assert (tau * norm (x1 - w1) (x2 - w2) (x3 - w3) <= (1 + 6 * u) * D * ((1 + / 500) * v)) by (apply mul2; split;
    auto using norm_pos). assert (VD : 0 < v * D) by (apply Rmult_lt_0_compat; lra).
  replace ((1 + 6 * u) * D * ((1 + / 500) * v)) with ((1 + 6 * u) * (1 + / 500) * (v * D)) in * by ring.
  rewrite u_val in *. lra.
Qed.
(* A hit that is not beyond the best hit is not beyond the end. *)
Theorem END_ROUNDING_holds : forall high x y, t <= high -> x = high * len \/ x = RN (high * len) ->
  let e := RNs (RN (x + error)) in product y (END_ROUNDING * v) e ->
  tau <= Rmin (RNs (y + e)) far.
Proof.
  intros high x y Hh Hx e Hy. apply Rmin_glb; [|exact tau_far]. destruct line_facts as (_ & L & L0 & L1).
  destruct tau_range as [T1 [T0 T2]]. pose proof error_near as E. pose proof D_1 as D1. pose proof D_64 as D64.
  pose proof u_pos as U. pose proof v_pos as V. unfold product, REACH, END_ROUNDING in *.
  assert (LP : 0 < len) by (pose proof (bp_pos (-1022)); lra).
  (* in doubles *)
  set (h := t * len). assert (H0 : 0 <= h) by (apply Rmult_le_pos; lra).
  assert (Hhigh : h <= high * len) by (apply Rmult_le_compat_r; lra).
  pose proof (RN_err (high * len)) as R. rewrite (Rabs_pos_eq (high * len)) in R by lra. apply Rabs_le_inv in R.
  assert (T5 : bp (-1075) <= / 1000000 * u) by (apply Rle_trans with
    (bp (-20 + -53)); [apply bp_le; lia|]; rewrite bp_add; fold u; simpl (bp (-20)); lra).
  assert (X : (1 - u) * h - / 1000000 * u <= x).
  { apply Rle_trans with ((1 - u) * (high * len) - bp (-1075)); [|pose proof (bp_pos (-1075)); destruct Hx as [Q|Q];
      rewrite Q; [|lra]; assert (0 <= u * (high * len)) by (apply Rmult_le_pos; lra); lra].
    assert ((1 - u) * h <= (1 - u) * (high * len)) by (apply Rmult_le_compat_l; [rewrite u_val; lra | lra]). lra. }
  assert (HL : t' * long <= (1 + 7 * u) * h + 5 * u).
  { destruct (Rle_or_lt t' 0) as [N|N]; [assert (t' * long <= 0) by nra; assert (0 <= (1 + 7 * u) * h) by (apply
      Rmult_le_pos; lra); lra|].
    rewrite (Rabs_pos_eq t') in Ht by lra. apply Rabs_le_inv in Ht. apply Rabs_le_inv in L.
    assert (A : (1 - u) * t' <= t + bp (-1075)) by lra.
    assert (B : (1 - 4 * u) * long <= len) by (assert (0 < u * long) by (apply Rmult_lt_0_compat; lra); lra).
    assert (C : ((1 - u) * t') * ((1 - 4 * u) * long) <= (t + bp (-1075)) * len).
    { apply mul2; split; try assumption; apply Rmult_le_pos; rewrite ?u_val; lra. }
    assert (G : bp (-1075) * len <= (41 / 10) * u).
    { apply Rle_trans with (bp (-1075) * bp 1024); [apply Rmult_le_compat_l; [apply Rlt_le, bp_pos | lra]|].
      rewrite <- bp_add. change (-1075 + 1024)%Z with (2 + -53)%Z. rewrite bp_add. fold u. simpl (bp 2). lra. }
    replace (((1 - u) * t') * ((1 - 4 * u) * long)) with ((1 - u) * (1 - 4 * u) * (t' * long)) in C by ring.
    replace ((t + bp (-1075)) * len) with (h + bp (-1075) * len) in C by (unfold h; ring).
    assert (0 <= t' * long) by (apply Rmult_le_pos; lra). set (m := t' * long) in *. rewrite u_val in *. lra. }
  assert (Z : tau + 30 * u * D <= RN (x + error)).
  { assert (U1 : u <= u * D) by nra. assert (M : tau <= (1 + 7 * u) * h + 5 * u) by (unfold tau; apply Rmax_lub;
      [assumption | assert (0 <= (1 + 7 * u) * h) by (apply Rmult_le_pos; lra); lra]).
    (* h may be far beyond, and then all is *)
    assert (W : exists z, 0 <= z <= 66 /\ z <= x + error /\ tau + 100 * u * D <= z + 12 * u * z).
    { destruct (Rle_or_lt (x + error) 66) as [Q|Q].
      - exists (x + error). repeat split; try lra. rewrite u_val in *. lra. rewrite u_val in *. lra.
      - exists 66. repeat split; try lra. rewrite u_val in *. lra. }
    destruct W as (z & [z0 z1] & Z1 & Z2). apply Rle_trans with (RN z); [|now apply RN_le].
    pose proof (RN_err z) as EZ. rewrite (Rabs_pos_eq z) in EZ by assumption. apply Rabs_le_inv in EZ.
    destruct (Rle_or_lt z (2 * D)) as [Q|Q]; rewrite u_val in *; lra. }
  (* in f32 *)
  set (g := RN (x + error)) in *. pose proof (RNs_le _ _ Z) as Y. fold e in Y. set (b := tau + 30 * u * D) in *.
  assert (b0 : / 1000 * bp (-40) <= b).
  { unfold b. assert (B : / 1000 * bp (-40) <= 30 * u) by (rewrite u_val; simpl; lra). assert (u <= u * D) by nra.
  lra. }
  pose proof (bp_pos (-40)) as B40.
  assert (T6 : bp (-150) <= / 1000000 * v * b).
  { apply Rle_trans with (/ 1000000 * v * (/ 1000 * bp (-40))); [|apply Rmult_le_compat_l; lra]. unfold UNIT.
    replace (/ 1000000 * bp (-24) * (/ 1000 * bp (-40))) with (/ 1000000000 * bp (-24 + -40)) by (rewrite bp_add;
      field).
    apply Rle_trans with (bp (-40 + (-24 + -40))); [apply bp_le; lia|]. rewrite (bp_add (-40)).
    apply Rmult_le_compat_r; [apply Rlt_le, bp_pos | simpl; lra]. }
  pose proof (UNIT_holds b) as E1. rewrite (Rabs_pos_eq b) in E1 by lra. apply Rabs_le_inv in E1.
  assert (VB : 0 < v * b) by (apply Rmult_lt_0_compat; lra).
  assert (e0 : (1 - (1 + / 100000) * v) * b <= e) by lra.
  assert (ep : 0 <= e) by (rewrite v_val in *; lra).
  rewrite (Rabs_pos_eq (4 * v * e)) in Hy by (apply Rmult_le_pos; lra). apply Rabs_le_inv in Hy.
  set (c := (1 + (2 + / 10) * v) * b). assert (C : c <= y + e) by (unfold c; rewrite v_val in *; lra).
  apply Rle_trans with (RNs c); [|now apply RNs_le]. pose proof (UNIT_holds c) as E2.
  assert (c0 : b <= c <= 2 * b) by (unfold c; rewrite v_val in *; lra).
  rewrite (Rabs_pos_eq c) in E2 by lra. apply Rabs_le_inv in E2.
  apply Rle_trans with b; [unfold b; assert (0 < u * D) by (apply Rmult_lt_0_compat; lra); lra|].
  unfold c in *. rewrite v_val in *. lra.
Qed.
(* ---- Boxes ----
   Along an axis all directions have the sign sigma; that of the ray lies between the least and the greatest,
   a and b without the sign. *)
Lemma part_of_hit : forall P o x e, Rabs (P - (o + tau * x)) <= e -> o + tau * x - e <= P <= o + tau * x + e.
Proof. intros P o x e H. apply Rabs_le_inv in H. lra. Qed.
(* What a component that is cut moves. *)
Lemma cut_moves : forall w, 0 <= w -> tau * w <= tau * Rmax w (/ MAX_INVERSE) <= tau * w + / 1000 * v * D.
Proof.
  intros w W. destruct tau_range as [_ [T0 T2]]. pose proof D_1 as D1.
  assert (MV : MAX_INVERSE = 1099511627776) by (unfold MAX_INVERSE; simpl; lra).
  assert (M : w <= Rmax w (/ MAX_INVERSE) <= w + / 1099511627776) by (split; [apply Rmax_l|]; apply Rmax_lub;
    rewrite ?MV; lra).
  assert (tau * w <= tau * Rmax w (/ MAX_INVERSE)) by (apply Rmult_le_compat_l; lra).
  assert (tau * Rmax w (/ MAX_INVERSE) <= tau * (w + / 1099511627776)) by (apply Rmult_le_compat_l; lra).
  rewrite u_val, v_val in *. lra.
Qed.
Section Axis.
Variables sigma o x P near away a b : R.
Hypotheses (Sign : sigma = 1 \/ sigma = - 1) (Ho : Rabs o <= D) (HPx : Rabs (P - (o + tau * x)) <= (2 + / 200) * v * D)
  (Hn : Rabs near <= 1 + / 1000) (Ha : Rabs away <= 1 + / 1000) (Inside : sigma * near <= sigma * P <= sigma * away).
Lemma axis_tile : forall y z, 0 <= a <= sigma * x -> sigma * x <= b <= 1 + / 1000 ->
  Rabs (y - near * (sigma * cut b)) <= v * Rabs (near * (sigma * cut b)) + bp (-150) ->
  Rabs (z - away * (sigma * cut a)) <= v * Rabs (away * (sigma * cut a)) + bp (-150) ->
  crossed y (sigma * cut b) o (sigma * slack) <= tau <= crossed z (sigma * cut a) o (- (sigma * slack)).
Proof.
  intros y z A B Hy Hz. destruct sizes as [F D64]. pose proof D_1 as D1. pose proof slack_near as SL.
  pose proof tau_far as TF. destruct tau_range as [_ [T0 _]]. pose proof (part_of_hit _ _ _ _ HPx) as H.
  destruct (cut_near b) as [B1 B2]; [lra|]. destruct (cut_near a) as [A1 A2]; [lra|].
  destruct (cut_moves b) as [MB _]; [lra|]. destruct (cut_moves a) as [_ MA]; [lra|].
  assert (TA : tau * a <= tau * (sigma * x) <= tau * b) by (split; apply Rmult_le_compat_l; lra).
  assert (AT : Rabs tau <= far) by (rewrite Rabs_pos_eq; lra).
  assert (AT2 : Rabs (- tau) <= far) by now rewrite Rabs_Ropp.
  destruct Sign as [E|E]; rewrite E in *; split.
  - rewrite !Rmult_1_l in *. apply (crossed_below D far slack D1 D64 far_F F SL near _ (Rmax b (/ MAX_INVERSE)) o tau
      ((2 + / 50) * v * D)); try assumption; lra.
  - rewrite !Rmult_1_l in *. rewrite <- (Ropp_involutive (crossed z _ _ _)), <- crossed_opp, Ropp_involutive.
    apply Ropp_le_cancel. rewrite Ropp_involutive.
    apply (crossed_below D far slack D1 D64 far_F F SL (- away) _ (Rmax a (/ MAX_INVERSE)) (- o) (- tau)
      ((2 + / 50) * v * D)); try assumption; rewrite ?Rabs_Ropp; try assumption; try lra.
    replace (- z - - away * cut a) with (- (z - away * cut a)) by ring. replace (- away * cut a) with
      (- (away * cut a)) by ring. now rewrite !Rabs_Ropp.
  - replace (- 1 * cut b) with (- cut b) in * by ring. replace (- 1 * slack) with (- slack) by ring.
    rewrite <- (Ropp_involutive o), crossed_turned.
    apply (crossed_below D far slack D1 D64 far_F F SL (- near) _ (Rmax b (/ MAX_INVERSE)) (- o) tau
      ((2 + / 50) * v * D)); try assumption; rewrite ?Rabs_Ropp; try assumption; try lra.
    replace (near * - cut b) with (- near * cut b) in Hy by ring. exact Hy.
  - replace (- 1 * cut a) with (- cut a) in * by ring. replace (- (- 1 * slack)) with (- - slack) by ring.
    rewrite <- (Ropp_involutive o), crossed_turned.
    replace (crossed z (cut a) (- o) (- slack)) with (- crossed (- z) (cut a) o slack) by
      (rewrite <- (Ropp_involutive z) at 2; now rewrite crossed_opp).
    apply Ropp_le_cancel. rewrite Ropp_involutive.
    apply (crossed_below D far slack D1 D64 far_F F SL away _ (Rmax a (/ MAX_INVERSE)) o (- tau)
      ((2 + / 50) * v * D)); try assumption; try lra.
    replace (away * - cut a) with (- (away * cut a)) in Hz by ring. rewrite Rabs_Ropp in Hz.
    replace (- z - away * cut a) with (- (z - - (away * cut a))) by ring. now rewrite Rabs_Ropp.
Qed.
Lemma axis_ray : 0 <= sigma * x <= 1 + / 1000 ->
  crossed_alone near (sigma * cut (sigma * x)) o (- (sigma * slack)) <= tau <=
  crossed_alone away (sigma * cut (sigma * x)) o (sigma * slack).
Proof.
  intros X. destruct sizes as [F D64]. pose proof D_1 as D1. pose proof slack_near as SL.
  pose proof tau_far as TF. destruct tau_range as [_ [T0 _]]. pose proof (part_of_hit _ _ _ _ HPx) as H.
  destruct (cut_near (sigma * x)) as [B1 B2]; [lra|]. destruct (cut_moves (sigma * x)) as [M1 M2]; [lra|].
  assert (AT : Rabs tau <= far) by (rewrite Rabs_pos_eq; lra).
  assert (AT2 : Rabs (- tau) <= far) by now rewrite Rabs_Ropp.
  assert (Turned : forall p q c r, - crossed_alone p q (- r) (- c) = crossed_alone (- p) q r c).
  { intros. rewrite <- (Ropp_involutive p) at 1. rewrite alone_opp. ring. }
  set (c := cut (sigma * x)) in *. set (m := Rmax (sigma * x) (/ MAX_INVERSE)) in *. clearbody c m.
  destruct Sign as [E|E]; rewrite E in *; split.
  - rewrite !Rmult_1_l in *. apply (alone_below D far slack D1 D64 far_F F SL near _ m o tau ((2 + / 50) * v * D));
      try assumption; lra.
  - rewrite !Rmult_1_l in *. rewrite <- (Ropp_involutive away), <- Turned. apply Ropp_le_cancel.
  rewrite Ropp_involutive.
    apply (alone_below D far slack D1 D64 far_F F SL (- away) _ m (- o) (- tau) ((2 + / 50) * v * D)); try assumption;
      rewrite ?Rabs_Ropp; try assumption; lra.
  - replace (- 1 * c) with (- c) by ring. replace (- (- 1 * slack)) with (- - slack) by ring.
    rewrite <- (Ropp_involutive near), <- (Ropp_involutive o), alone_turned.
    apply (alone_below D far slack D1 D64 far_F F SL (- near) _ m (- o) tau ((2 + / 50) * v * D)); try assumption;
      rewrite ?Rabs_Ropp; try assumption; lra.
  - replace (- 1 * c) with (- c) by ring. replace (- 1 * slack) with (- slack) by ring.
    rewrite <- (Ropp_involutive away), <- (Ropp_involutive o), alone_turned, <- Turned.
    apply Ropp_le_cancel. rewrite !Ropp_involutive.
    apply (alone_below D far slack D1 D64 far_F F SL away _ m o (- tau) ((2 + / 50) * v * D)); try assumption; lra.
Qed.
End Axis.
(* A direction of any ray of a tile, in f32, is a unit vector up to rounding. *)
Lemma direction_small : norm x1 x2 x3 <= 1 + 2 * v /\ 1 - 2 * v <= norm x1 x2 x3 /\ Rabs x1 <= 1 + / 1000 /\
  Rabs x2 <= 1 + / 1000 /\ Rabs x3 <= 1 + / 1000.
Proof.
  destruct line_facts as (X & _). pose proof (X d1) as X1. pose proof (X d2) as X2. pose proof (X d3) as X3.
  fold w1 in X1. fold w2 in X2. fold w3 in X3. fold x1 in X1. fold x2 in X2. fold x3 in X3. clear X.
  pose proof w_norm as W. pose proof v_pos as V.
  assert (B : norm (x1 - w1) (x2 - w2) (x3 - w3) <= 2 * v).
  { eapply Rle_trans; [eapply norm_monotone; eassumption|]. eapply Rle_trans; [apply norm_triangle|].
    rewrite norm_scaled, norm_abs, W, Rabs_pos_eq by lra. destruct Balls.tiny as (_ & U2 & U3).
    assert (norm (bp (-130)) (bp (-130)) (bp (-130)) <= 17321 / 10000 * bp (-130)) by (apply norm_equal; try lra;
      rewrite Rabs_pos_eq; lra). lra. }
  pose proof (norm_difference x1 x2 x3 w1 w2 w3) as A. pose proof (norm_difference w1 w2 w3 x1 x2 x3) as C.
  replace (norm (w1 - x1) (w2 - x2) (w3 - x3)) with (norm (x1 - w1) (x2 - w2) (x3 - w3)) in C by (rewrite <- norm_opp;
    f_equal; ring). destruct (part_le x1 x2 x3) as (L1 & L2 & L3). rewrite v_val in *. repeat split; lra.
Qed.

Lemma hit_axes : Rabs (P1 - (s1 + tau * x1)) <= (2 + / 200) * v * D /\ Rabs (P2 - (s2 + tau * x2)) <= (2 + / 200) * v *
  D
  /\ Rabs (P3 - (s3 + tau * x3)) <= (2 + / 200) * v * D /\ Rabs s1 <= D /\ Rabs s2 <= D /\ Rabs s3 <= D.
Proof.
  destruct hit_near as (_ & _ & H). destruct origin_near as [_ O]. destruct (part_le s1 s2 s3) as (L1 & L2 & L3).
  destruct (part_le (P1 - (s1 + tau * x1)) (P2 - (s2 + tau * x2)) (P3 - (s3 + tau * x3))) as (M1 & M2 & M3).
  rewrite v_val in *. repeat split; lra.
Qed.

(* A box with a hit of a ray that is not beyond its best hit, at P: the tile keeps it, in any order of the maxima and
   minima, and so does the ray. *)
Theorem tile_box_is_kept : forall high h y last g1 g2 g3 a1 a2 a3 b1 b2 b3 n1 n2 n3 f1 f2 f3 y1 y2 y3 z1 z2 z3,
  t <= high -> h = high * len \/ h = RN (high * len) ->
  let e := RNs (RN (h + error)) in product y (END_ROUNDING * v) e -> Rmin (RNs (y + e)) far <= last ->
  slopes g1 a1 b1 x1 -> slopes g2 a2 b2 x2 -> slopes g3 a3 b3 x3 ->
  between g1 n1 P1 f1 -> between g2 n2 P2 f2 -> between g3 n3 P3 f3 ->
  product y1 n1 (g1 * cut b1) -> product y2 n2 (g2 * cut b2) -> product y3 n3 (g3 * cut b3) ->
  product z1 f1 (g1 * cut a1) -> product z2 f2 (g2 * cut a2) -> product z3 f3 (g3 * cut a3) ->
  Rmax (Rmax (crossed y1 (g1 * cut b1) s1 (g1 * slack)) (crossed y2 (g2 * cut b2) s2 (g2 * slack)))
    (Rmax (crossed y3 (g3 * cut b3) s3 (g3 * slack)) 0) <=
  Rmin (Rmin (crossed z1 (g1 * cut a1) s1 (- (g1 * slack))) (crossed z2 (g2 * cut a2) s2 (- (g2 * slack))))
    (Rmin (crossed z3 (g3 * cut a3) s3 (- (g3 * slack))) last).
Proof.
  intros high h y last g1 g2 g3 a1 a2 a3 b1 b2 b3 n1 n2 n3 f1 f2 f3 y1 y2 y3 z1 z2 z3 Hh Hx e Hy Hlast
    (G1 & A1 & B1) (G2 & A2 & B2) (G3 & A3 & B3) (N1 & F1 & I1) (N2 & F2 & I2) (N3 & F3 & I3) Y1 Y2 Y3 Z1 Z2 Z3.
  pose proof (END_ROUNDING_holds high h y Hh Hx Hy) as T. cbv zeta in T. fold e in T.
  destruct hit_axes as (H1 & H2 & H3 & O1 & O2 & O3). destruct tau_range as [_ [T0 _]].
  destruct (axis_tile g1 s1 x1 P1 n1 f1 a1 b1 G1 O1 H1 N1 F1 I1 y1 z1 A1 B1 Y1 Z1) as [E1 L1].
  destruct (axis_tile g2 s2 x2 P2 n2 f2 a2 b2 G2 O2 H2 N2 F2 I2 y2 z2 A2 B2 Y2 Z2) as [E2 L2].
  destruct (axis_tile g3 s3 x3 P3 n3 f3 a3 b3 G3 O3 H3 N3 F3 I3 y3 z3 A3 B3 Y3 Z3) as [E3 L3].
  apply Rle_trans with tau; [apply Rmax_lub; apply Rmax_lub; assumption | apply Rmin_glb; apply Rmin_glb;
    try assumption;
    lra].
Qed.
Theorem ray_box_is_kept : forall high h y g1 g2 g3 n1 n2 n3 f1 f2 f3,
  t <= high -> h = high * len \/ h = RN (high * len) ->
  let e := RNs (RN (h + error)) in product y (END_ROUNDING * v) e ->
  slopes g1 0 (1 + / 1000) x1 -> slopes g2 0 (1 + / 1000) x2 -> slopes g3 0 (1 + / 1000) x3 ->
  between g1 n1 P1 f1 -> between g2 n2 P2 f2 -> between g3 n3 P3 f3 ->
  let i1 := g1 * cut (g1 * x1) in let i2 := g2 * cut (g2 * x2) in let i3 := g3 * cut (g3 * x3) in
  Rmax (Rmax (crossed_alone n1 i1 s1 (- (g1 * slack))) (crossed_alone n2 i2 s2 (- (g2 * slack))))
    (Rmax (crossed_alone n3 i3 s3 (- (g3 * slack))) 0) <=
  Rmin (Rmin (crossed_alone f1 i1 s1 (g1 * slack)) (crossed_alone f2 i2 s2 (g2 * slack)))
    (Rmin (crossed_alone f3 i3 s3 (g3 * slack)) (Rmin (RNs (y + e)) far)).
Proof.
  intros high h y g1 g2 g3 n1 n2 n3 f1 f2 f3 Hh Hx e Hy
    (G1 & A1 & B1) (G2 & A2 & B2) (G3 & A3 & B3) (N1 & F1 & I1) (N2 & F2 & I2) (N3 & F3 & I3) i1 i2 i3.
  pose proof (END_ROUNDING_holds high h y Hh Hx Hy) as T. cbv zeta in T. fold e in T.
  destruct hit_axes as (H1 & H2 & H3 & O1 & O2 & O3). destruct tau_range as [_ [T0 _]].
  assert (C1 : 0 <= g1 * x1 <= 1 + / 1000) by lra. assert (C2 : 0 <= g2 * x2 <= 1 + / 1000) by lra.
  assert (C3 : 0 <= g3 * x3 <= 1 + / 1000) by lra.
  destruct (axis_ray g1 s1 x1 P1 n1 f1 G1 O1 H1 N1 F1 I1 C1) as [E1 L1].
  destruct (axis_ray g2 s2 x2 P2 n2 f2 G2 O2 H2 N2 F2 I2 C2) as [E2 L2].
  destruct (axis_ray g3 s3 x3 P3 n3 f3 G3 O3 H3 N3 F3 I3 C3) as [E3 L3].
  apply Rle_trans with tau; [apply Rmax_lub; apply Rmax_lub | apply Rmin_glb; apply Rmin_glb]; assumption.
Qed.
(* ---- Balls ----
   A ball with center c and radius r, and a hit at P in it. *)
Section Ball.
Variables c1 c2 c3 r : R.
Hypotheses (Hc : norm c1 c2 c3 <= 1 + / 1000) (Hr : 0 <= r <= 1 + / 100)
  (Hin : norm (c1 - P1) (c2 - P2) (c3 - P3) <= r).
(* How far the center is along a normal, exactly and as computed. *)
Section Plane.
Variables n1 n2 n3 : R.
Hypothesis Hn : norm n1 n2 n3 <= 1 + 5 * v.
Lemma along_exactly :
  Rabs (n1 * (c1 - s1) + n2 * (c2 - s2) + n3 * (c3 - s3) - tau * (n1 * x1 + n2 * x2 + n3 * x3)) <=
    r + (51 / 10) * v + (2 + / 100) * v * D.
Proof.
  destruct hit_near as (_ & _ & C). pose proof v_pos as V. pose proof D_1 as D1.
  assert (VD : 0 < v * D) by (apply Rmult_lt_0_compat; lra).
  set (e1 := P1 - (s1 + tau * x1)) in *. set (e2 := P2 - (s2 + tau * x2)) in *. set (e3 := P3 - (s3 + tau * x3)) in *.
  replace (n1 * (c1 - s1) + n2 * (c2 - s2) + n3 * (c3 - s3) - tau * (n1 * x1 + n2 * x2 + n3 * x3)) with
    ((n1 * (c1 - P1) + n2 * (c2 - P2) + n3 * (c3 - P3)) + (n1 * e1 + n2 * e2 + n3 * e3)) by (unfold e1, e2, e3; ring).
  eapply Rle_trans; [apply Rabs_triang|]. pose proof (dot_le n1 n2 n3 (c1 - P1) (c2 - P2) (c3 - P3)) as A.
  pose proof (dot_le n1 n2 n3 e1 e2 e3) as B.
  assert (A2 : norm n1 n2 n3 * norm (c1 - P1) (c2 - P2) (c3 - P3) <= (1 + 5 * v) * r) by (apply mul2; split;
    auto using norm_pos). assert (B2 : norm n1 n2 n3 * norm e1 e2 e3 <= (1 + 5 * v) * ((2 + / 200) * v * D)) by (apply
    mul2; split; auto using norm_pos).
  replace ((1 + 5 * v) * ((2 + / 200) * v * D)) with ((1 + 5 * v) * (2 + / 200) * (v * D)) in B2 by ring.
  assert (v * r <= v * (1 + / 100)) by (apply Rmult_le_compat_l; lra). rewrite v_val in *. lra.
Qed.
Lemma part_1 : forall a, Rabs a <= 1 + / 1000 -> Rabs a <= bp 1. Proof. intros. simpl. lra. Qed.
(* <n|o> as computed *)
Lemma base_near : forall m, single (tdot (X n1 1) (X n2 1) (X n3 1) (X s1 7) (X s2 7) (X s3 7)) m ->
  Rabs (m - (n1 * s1 + n2 * s2 + n3 * s3)) <= (3 + / 100) * v * (D - 1) + / 100 * v /\ Rabs m <= D - 1 + / 100 /\
  Rabs (n1 * s1 + n2 * s2 + n3 * s3) <= D - 1 + / 100.
Proof.
  intros m Hm. destruct origin_near as [_ O]. pose proof D_1 as D1. pose proof D_64 as D64. unfold REACH in *.
  pose proof v_pos as V. destruct (part_le n1 n2 n3) as (N1 & N2 & N3). destruct (part_le s1 s2 s3) as (S1 & S2 & S3).
  assert (b1 : bp 1 = 2) by (simpl; lra). assert (b7 : bp 7 = 128) by (simpl; lra).
  assert (B : Rabs n1 <= bp 1 /\ Rabs n2 <= bp 1 /\ Rabs n3 <= bp 1 /\ Rabs s1 <= bp 7 /\ Rabs s2 <= bp 7 /\
    Rabs s3 <= bp 7) by (rewrite b1, b7, v_val in *; repeat split; lra). destruct B as (B1 & B2 & B3 & B4 & B5 & B6).
  assert (Z : Rabs n1 * Rabs s1 + Rabs n2 * Rabs s2 + Rabs n3 * Rabs s3 <= D - 1 + / 10000).
  { eapply Rle_trans; [apply dot_bound|]. apply Rle_trans with ((1 + 5 * v) * (D - 1 + 65 * v)).
    - apply mul2; split; auto using norm_pos.
    - rewrite v_val in *. lra. }
  assert (E : Rabs (m - (n1 * s1 + n2 * s2 + n3 * s3)) <= (3 + / 100) * v * (D - 1) + / 100 * v).
  { clear - Hm B1 B2 B3 B4 B5 B6 Z V D1. unfold tdot in Hm. error32_of Hm P.
    match type of P with _ <= _ + bp ?k => assert (T : bp k <= bp (-130)) by (apply bp_le; lia) end.
    destruct Balls.tiny as (_ & U2 & U3). eapply Rle_trans; [exact P|].
    assert ((3 + / 1000) * v * (Rabs n1 * Rabs s1 + Rabs n2 * Rabs s2 + Rabs n3 * Rabs s3) <= (3 + / 1000) * v * (D - 1
      + / 10000)) by (apply Rmult_le_compat_l; lra). assert (0 <= v * (D - 1)) by (apply Rmult_le_pos; lra). lra. }
  assert (G : Rabs (n1 * s1 + n2 * s2 + n3 * s3) <= D - 1 + / 1000).
  { eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
    rewrite !Rabs_mult. lra. }
  split; [assumption|]. split; [|lra]. replace m with ((m - (n1 * s1 + n2 * s2 + n3 * s3)) + (n1 * s1 + n2 * s2
    + n3 * s3)) by ring. eapply Rle_trans; [apply Rabs_triang|]. rewrite v_val in *. lra.
Qed.
(* <n|c> less an offset, as computed *)
Lemma beyond_near : forall offset b, Rabs offset <= bp 9 -> single (tbeyond c1 c2 c3 n1 n2 n3 offset) b ->
  Rabs (b - (c1 * n1 + (c2 * n2 + (c3 * n3 - offset)))) <= (4 + / 100) * v * (1 + Rabs offset).
Proof.
  intros offset b Ho Hb. pose proof v_pos as V. destruct (part_le n1 n2 n3) as (N1 & N2 & N3).
  destruct (part_le c1 c2 c3) as (C1 & C2 & C3). assert (b1 : bp 1 = 2) by (simpl; lra).
  assert (B : Rabs n1 <= bp 1 /\ Rabs n2 <= bp 1 /\ Rabs n3 <= bp 1 /\ Rabs c1 <= bp 1 /\ Rabs c2 <= bp 1 /\
    Rabs c3 <= bp 1) by (rewrite b1, v_val in *; repeat split; lra). destruct B as (B1 & B2 & B3 & B4 & B5 & B6).
  assert (Z : Rabs c1 * Rabs n1 + Rabs c2 * Rabs n2 + Rabs c3 * Rabs n3 <= 1 + / 500).
  { eapply Rle_trans; [apply dot_bound|]. apply Rle_trans with ((1 + / 1000) * (1 + 5 * v)).
    - apply mul2; split; auto using norm_pos.
    - rewrite v_val. lra. }
  clear - Hb B1 B2 B3 B4 B5 B6 Ho Z V. unfold tbeyond in Hb. error32_of Hb P.
  match type of P with _ <= _ + bp ?k => assert (T : bp k <= bp (-130)) by (apply bp_le; lia) end.
  destruct Balls.tiny as (_ & U2 & U3). eapply Rle_trans; [exact P|]. pose proof (Rabs_pos offset).
  assert (v * (Rabs c1 * Rabs n1 + Rabs c2 * Rabs n2 + Rabs c3 * Rabs n3) <= v * (1 + / 500)) by (apply
    Rmult_le_compat_l; lra). assert (0 <= v * Rabs offset) by (apply Rmult_le_pos; lra). lra.
Qed.
End Plane.
(* A side: a normal n, found in whatever way; h is the greatest computed product of it with a direction, or zero. *)
Theorem OUTSIDE_holds : forall n1 n2 n3 m a h b, norm n1 n2 n3 <= 1 + 5 * v ->
  single (tdot (X n1 1) (X n2 1) (X n3 1) (X s1 7) (X s2 7) (X s3 7)) m ->
  single (tfused (X x1 1) (X x2 1) (X x3 1) (X n1 1) (X n2 1) (X n3 1)) a -> a <= h -> 0 <= h <= 1 + / 100 ->
  let offset := RNs (m + RNs (slack + RNs (RNs (OUTSIDE * far) * h))) in
  single (tbeyond c1 c2 c3 n1 n2 n3 offset) b -> b <= r.
Proof.
  intros n1 n2 n3 m a h b Hn Hm Ha AH [h0 h1] offset Hb. pose proof v_pos as V. pose proof Boxes.tiny as T.
  destruct (base_near n1 n2 n3 Hn m Hm) as (M1 & M2 & M3). pose proof (along_exactly n1 n2 n3 Hn) as A.
  destruct sizes as [F D64]. pose proof D_1 as D1. pose proof slack_near as SL. destruct tau_range as [_ [T0 T2]].
  pose proof (bp_pos (-150)) as B0. unfold SLACK, REACH, OUTSIDE in *.
  assert (VD : 0 < v * D) by (apply Rmult_lt_0_compat; lra). assert (V1 : v <= v * D) by nra.
  assert (V2 : v * D <= 64002 / 1000 * v) by nra.
  (* the product with the ray's direction *)
  assert (NX : n1 * x1 + n2 * x2 + n3 * x3 <= h + (301 / 100) * v).
  { destruct direction_small as (X0 & _ & X1 & X2 & X3). destruct (part_le n1 n2 n3) as (N1 & N2 & N3).
    assert (b1 : bp 1 = 2) by (simpl; lra).
    assert (B : Rabs n1 <= bp 1 /\ Rabs n2 <= bp 1 /\ Rabs n3 <= bp 1 /\ Rabs x1 <= bp 1 /\ Rabs x2 <= bp 1 /\
      Rabs x3 <= bp 1) by (rewrite b1; rewrite v_val in *; repeat split; lra).
    destruct B as (B1 & B2 & B3 & B4 & B5 & B6).
    assert (Z : Rabs x1 * Rabs n1 + Rabs x2 * Rabs n2 + Rabs x3 * Rabs n3 <= 1 + / 1000).
    { eapply Rle_trans; [apply dot_bound|]. apply Rle_trans with ((1 + 2 * v) * (1 + 5 * v)).
      - apply mul2; split; auto using norm_pos.
      - rewrite v_val. lra. }
    clearbody x1 x2 x3. clear - Ha B1 B2 B3 B4 B5 B6 Z V AH. unfold tfused in Ha. error32_of Ha P.
    match type of P with _ <= _ + bp ?k => assert (U : bp k <= bp (-130)) by (apply bp_le; lia) end.
    destruct Balls.tiny as (_ & U2 & U3). apply Rabs_le_inv in P.
    assert (v * (Rabs x1 * Rabs n1 + Rabs x2 * Rabs n2 + Rabs x3 * Rabs n3) <= v * (1 + / 1000)) by (apply
      Rmult_le_compat_l; lra). lra. }
  assert (AX : n1 * (c1 - s1) + n2 * (c2 - s2) + n3 * (c3 - s3) <= r + far * h + (51 / 10) * v + (505 / 100) * v * D).
  { apply Rabs_le_inv in A. assert (tau * (n1 * x1 + n2 * x2 + n3 * x3) <= tau * (h + (301 / 100) * v)) by (apply
      Rmult_le_compat_l; lra). assert (tau * h <= far * h) by (apply Rmult_le_compat_r; [lra | exact tau_far]).
    assert (tau * v <= (1 + 6 * u) * D * v) by (apply Rmult_le_compat_r; lra).
    replace ((1 + 6 * u) * D * v) with ((1 + 6 * u) * (v * D)) in * by ring. rewrite u_val in *. lra. }
  (* the offset *)
  pose proof (UNIT_holds (2 * far)) as E1. set (f2 := RNs (2 * far)) in *. rewrite (Rabs_pos_eq (2 * far)) in E1 by lra.
  apply Rabs_le_inv in E1. assert (f0 : 0 <= f2) by (apply RNs_above; [apply Fs_0 | lra]).
  pose proof (UNIT_holds (f2 * h)) as E2. set (g := RNs (f2 * h)) in *.
  rewrite (Rabs_pos_eq (f2 * h)) in E2 by (apply Rmult_le_pos; lra). apply Rabs_le_inv in E2.
  assert (g0 : 0 <= g) by (apply RNs_above; [apply Fs_0 | apply Rmult_le_pos; lra]).
  set (H := far * h) in *. assert (H0 : 0 <= H) by (apply Rmult_le_pos; lra).
  assert (H1 : H <= 65 * (1 + / 100)) by (unfold H; apply mul2; rewrite v_val in *; lra).
  assert (FH : (1 - v) * (2 * H) - bp (-150) * 2 <= f2 * h <= (1 + v) * (2 * H) + bp (-150) * 2).
  { split.
    - apply Rle_trans with ((2 * far - v * (2 * far) - bp (-150)) * h); [|apply Rmult_le_compat_r; lra].
      replace ((2 * far - v * (2 * far) - bp (-150)) * h) with ((1 - v) * (2 * H) - bp (-150) * h) by (unfold H; ring).
      assert (bp (-150) * h <= bp (-150) * 2) by (apply Rmult_le_compat_l; lra). lra.
    - apply Rle_trans with ((2 * far + v * (2 * far) + bp (-150)) * h); [apply Rmult_le_compat_r; lra|].
      replace ((2 * far + v * (2 * far) + bp (-150)) * h) with ((1 + v) * (2 * H) + bp (-150) * h) by (unfold H; ring).
      assert (bp (-150) * h <= bp (-150) * 2) by (apply Rmult_le_compat_l; lra). lra. }
  assert (G : (1 - 3 * v) * (2 * H) - / 1000 * v <= g <= (1 + 3 * v) * (2 * H) + / 1000 * v) by (rewrite v_val in *;
    lra).
  pose proof (UNIT_holds (slack + g)) as E3. set (w := RNs (slack + g)) in *.
  rewrite (Rabs_pos_eq (slack + g)) in E3 by lra. apply Rabs_le_inv in E3.
  assert (W : slack + 2 * H - 10 * v * H - / 100 * v <= w <= slack + 2 * H + 10 * v * H + / 100 * v) by (rewrite v_val
    in *; lra).
  pose proof (UNIT_holds (m + w)) as E4. change (RNs (m + w)) with offset in E4.
  set (N := n1 * s1 + n2 * s2 + n3 * s3) in *.
  assert (MW : Rabs (m + w) <= D - 1 + / 50 + (201 / 100) * H).
  { eapply Rle_trans; [apply Rabs_triang|]. rewrite (Rabs_pos_eq w) by (rewrite v_val in *; lra). rewrite v_val in *.
    lra. }
  assert (E5 : v * Rabs (m + w) <= v * (D - 1 + / 50 + (201 / 100) * H)) by (apply Rmult_le_compat_l; lra).
  apply Rabs_le_inv in E4. apply Rabs_le_inv in M1.
  assert (O1 : N + slack + 2 * H - 14 * v * H - (402 / 100) * v * (D - 1) - / 10 * v <= offset) by lra.
  assert (O2 : Rabs offset <= D - 1 + / 20 + (202 / 100) * H).
  { replace offset with ((offset - (m + w)) + (m + w)) by ring. eapply Rle_trans; [apply Rabs_triang|].
    apply Rabs_le in E4. rewrite v_val in *. lra. }
  assert (O3 : Rabs offset <= bp 9) by (assert (bp 9 = 512) by (simpl; lra); lra).
  pose proof (beyond_near n1 n2 n3 Hn offset b O3 Hb) as BN. apply Rabs_le_inv in BN.
  assert (E6 : v * (1 + Rabs offset) <= v * (D + / 20 + (202 / 100) * H)) by (apply Rmult_le_compat_l; lra).
  replace (n1 * (c1 - s1) + n2 * (c2 - s2) + n3 * (c3 - s3)) with (c1 * n1 + (c2 * n2 + c3 * n3) - N) in AX by
    (unfold N; ring). rewrite v_val in *. lra.
Qed.
(* Behind and in front: the middle m of the directions, of their signs along the axes. *)
Theorem IN_FRONT_holds : forall m1 m2 m3 mo b last, norm m1 m2 m3 <= 1 + 5 * v ->
  0 <= m1 * x1 -> 0 <= m2 * x2 -> 0 <= m3 * x3 -> Fs r ->
  single (tdot (X m1 1) (X m2 1) (X m3 1) (X s1 7) (X s2 7) (X s3 7)) mo ->
  single (tbeyond c1 c2 c3 (- m1) (- m2) (- m3) (RNs (slack - mo))) b -> tau <= last <= far ->
  b <= r /\ RNs (- b - RNs (last + RNs (IN_FRONT * slack))) <= r.
Proof.
  intros m1 m2 m3 mo b last Hm G1 G2 G3 Fr Hmo Hb Hlast. pose proof v_pos as V. pose proof Boxes.tiny as T.
  destruct (base_near m1 m2 m3 Hm mo Hmo) as (M1 & M2 & M3). pose proof (along_exactly m1 m2 m3 Hm) as A.
  destruct sizes as [F D64]. pose proof D_1 as D1. pose proof slack_near as SL. destruct tau_range as [_ [T0 T2]].
  pose proof (bp_pos (-150)) as B0. unfold SLACK, REACH, IN_FRONT in *.
  assert (VD : 0 < v * D) by (apply Rmult_lt_0_compat; lra). assert (V1 : v <= v * D) by nra.
  assert (V2 : v * D <= 64002 / 1000 * v) by nra.
  assert (MX : 0 <= m1 * x1 + m2 * x2 + m3 * x3 <= 1 + 8 * v).
  { split; [lra|]. destruct direction_small as (X0 & _). eapply Rle_trans; [apply Rle_abs|].
    eapply Rle_trans; [apply dot_le|]. apply Rle_trans with ((1 + 5 * v) * (1 + 2 * v)); [apply mul2; split;
      auto using norm_pos | rewrite v_val; lra]. }
  set (p := m1 * x1 + m2 * x2 + m3 * x3) in *.
  assert (TP : 0 <= tau * p <= last + (8 + / 10) * v * D).
  { split; [apply Rmult_le_pos; lra|]. apply Rle_trans with (tau * (1 + 8 * v)); [apply Rmult_le_compat_l; lra|].
    assert (tau * v <= (1 + 6 * u) * D * v) by (apply Rmult_le_compat_r; lra).
    replace ((1 + 6 * u) * D * v) with ((1 + 6 * u) * (v * D)) in * by ring. rewrite u_val in *. lra. }
  assert (Hn : norm (- m1) (- m2) (- m3) <= 1 + 5 * v) by now rewrite norm_opp.
  pose proof (UNIT_holds (slack - mo)) as E4. set (offset := RNs (slack - mo)) in *.
  set (N := m1 * s1 + m2 * s2 + m3 * s3) in *.
  assert (MW : Rabs (slack - mo) <= D - 1 + / 50).
  { unfold Rminus at 1. eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp, (Rabs_pos_eq slack) by lra.
    rewrite v_val in *. lra. }
  assert (E5 : v * Rabs (slack - mo) <= v * (D - 1 + / 50)) by (apply Rmult_le_compat_l; lra).
  assert (O2 : Rabs offset <= D - 1 + / 20).
  { replace offset with ((offset - (slack - mo)) + (slack - mo)) by ring. eapply Rle_trans; [apply Rabs_triang|].
    rewrite v_val in *. lra. }
  assert (O3 : Rabs offset <= bp 9) by (assert (bp 9 = 512) by (simpl; lra); lra).
  pose proof (beyond_near _ _ _ Hn offset b O3 Hb) as BN. apply Rabs_le_inv in BN.
  apply Rabs_le_inv in E4. apply Rabs_le_inv in M1. apply Rabs_le_inv in A.
  assert (E6 : v * (1 + Rabs offset) <= v * (D + / 20)) by (apply Rmult_le_compat_l; lra).
  assert (C : c1 * - m1 + (c2 * - m2 + c3 * - m3) = - (m1 * (c1 - s1) + m2 * (c2 - s2) + m3 * (c3 - s3)) - N) by
    (unfold N; ring).
  assert (C2 : c1 * - m1 + (c2 * - m2 + (c3 * - m3 - offset)) = - (m1 * (c1 - s1) + m2 * (c2 - s2) + m3 * (c3 - s3)) - N
    - offset) by lra. rewrite C2 in BN. set (K := m1 * (c1 - s1) + m2 * (c2 - s2) + m3 * (c3 - s3)) in *.
  assert (BB : - K - slack - (81 / 10) * v * D <= b <= - K - slack + (81 / 10) * v * D) by (split; lra).
  split; [lra|]. pose proof (UNIT_holds (3 * slack)) as F1. set (f := RNs (3 * slack)) in *.
  rewrite (Rabs_pos_eq (3 * slack)) in F1 by lra. apply Rabs_le_inv in F1.
  assert (f0 : 0 <= f) by (apply RNs_above; [apply Fs_0 | lra]).
  pose proof (UNIT_holds (last + f)) as F2. set (g := RNs (last + f)) in *.
  rewrite (Rabs_pos_eq (last + f)) in F2 by lra.
  apply Rabs_le_inv in F2. assert (v * last <= v * ((1 + 6 * v) * D)) by (apply Rmult_le_compat_l; lra).
  replace (v * ((1 + 6 * v) * D)) with ((1 + 6 * v) * (v * D)) in * by ring.
  apply RNs_below; [exact Fr|]. rewrite v_val in *. lra.
Qed.

(* One ray: the distance of the center from what is left of it. *)
Theorem SLACK_holds : forall a b c a4 last q, let y1 := RNs (c1 - s1) in let y2 := RNs (c2 - s2) in
  let y3 := RNs (c3 - s3) in single (tcross_1 x2 x3 y2 y3) a -> single (tcross_1 x3 x1 y3 y1) b ->
  single (tcross_1 x1 x2 y1 y2) c -> single (tfused (X x1 1) (X x2 1) (X x3 1) (X y1 7) (X y2 7) (X y3 7)) a4 ->
  tau <= last -> single (tsquares a b c (RNs (a4 - Rmin (Rmax a4 0) last))) q ->
  let reach := RNs (r + slack) in q <= RNs (reach * reach).
Proof.
  intros a b c a4 last q y1 y2 y3 Ha Hb Hcc H4 Hlast Hq reach'. pose proof D_1 as D1. pose proof D_64 as D64.
  pose proof slack_near as SL. destruct tau_range as [_ [T0 _]]. destruct origin_near as [_ SN].
  destruct direction_small as (X0 & _). destruct hit_near as (HW & XW & _). unfold REACH in D64.
  assert (NC : norm (c1 - s1) (c2 - s2) (c3 - s3) <= D + / 500).
  { pose proof (norm_triangle c1 c2 c3 (- s1) (- s2) (- s3)) as N. rewrite norm_opp in N. unfold Rminus.
    rewrite v_val in *. lra. }
  assert (D65 : D <= 65) by lra. assert (Hlast' : 0 <= tau <= last) by lra.
  exact (distance_below D slack r tau last s1 s2 s3 w1 w2 w3 x1 x2 x3 c1 c2 c3 P1 P2 P3 D1 D65 SL w_norm XW X0 NC HW Hr
    Hin Hlast' a b c a4 q Ha Hb Hcc H4 Hq).
Qed.
(* A ball with a hit of a ray that is not beyond its best hit: the tile keeps it, and so does the ray. *)
Theorem tile_ball_is_kept : forall high h y last g1 g2 g3 a1 a2 a3 b1 b2 b3 q mo k1 k2 k3 k4 k5,
  t <= high -> h = high * len \/ h = RN (high * len) ->
  let e := RNs (RN (h + error)) in product y (END_ROUNDING * v) e -> Rmin (RNs (y + e)) far <= last <= far -> Fs r ->
  slopes g1 a1 b1 x1 -> slopes g2 a2 b2 x2 -> slopes g3 a3 b3 x3 ->
  let f1 := middle g1 a1 b1 in let f2 := middle g2 a2 b2 in let f3 := middle g3 a3 b3 in
  single (tdot (X f1 64) (X f2 64) (X f3 64) (X f1 64) (X f2 64) (X f3 64)) q ->
  let m1 := RNs (f1 * recip q) in let m2 := RNs (f2 * recip q) in let m3 := RNs (f3 * recip q) in
  single (tdot (X m1 1) (X m2 1) (X m3 1) (X s1 7) (X s2 7) (X s3 7)) mo ->
  single (tbeyond c1 c2 c3 (- m1) (- m2) (- m3) (RNs (slack - mo))) k5 ->
  side far slack s1 s2 s3 x1 x2 x3 c1 c2 c3 k1 -> side far slack s1 s2 s3 x1 x2 x3 c1 c2 c3 k2 ->
  side far slack s1 s2 s3 x1 x2 x3 c1 c2 c3 k3 -> side far slack s1 s2 s3 x1 x2 x3 c1 c2 c3 k4 ->
  Rmax (Rmax (Rmax k1 k2) (Rmax k3 k4)) (Rmax k5 (RNs (- k5 - RNs (last + RNs (IN_FRONT * slack))))) <= r.
Proof.
  intros high h y last g1 g2 g3 a1 a2 a3 b1 b2 b3 q mo k1 k2 k3 k4 k5 Hh Hx e Hy Hlast Fr L1 L2 L3 f1 f2 f3 Hq m1 m2 m3
    Hmo H5 K1 K2 K3 K4.
  pose proof (END_ROUNDING_holds high h y Hh Hx Hy) as T. cbv zeta in T. fold e in T.
  assert (Side : forall k, side far slack s1 s2 s3 x1 x2 x3 c1 c2 c3 k -> k <= r).
  { intros b (n1 & n2 & n3 & m & a & h' & Hn & Hm & Ha & A & B & C).
    exact (OUTSIDE_holds n1 n2 n3 m a h' b (normalised_short n1 n2 n3 Hn) Hm Ha A B C). }
  destruct (middle_long g1 a1 b1 x1 L1 (RNs_F _)) as [[Q1 R1] S1].
  destruct (middle_long g2 a2 b2 x2 L2 (RNs_F _)) as [[Q2 R2] S2].
  destruct (middle_long g3 a3 b3 x3 L3 (RNs_F _)) as [[Q3 R3] S3]. fold f1 in Q1, R1, S1. fold f2 in Q2, R2, S2.
  fold f3 in Q3, R3, S3.
  assert (BB : bp 64 = 18446744073709551616) by (simpl; lra).
  assert (B1 : Rabs f1 <= bp 64) by lra. assert (B2 : Rabs f2 <= bp 64) by lra. assert (B3 : Rabs f3 <= bp 64) by lra.
  assert (LN : LEAST_NORMAL <= q).
  { destruct direction_small as (_ & X0 & _).
    assert (N : norm x1 x2 x3 <= norm f1 f2 f3) by (rewrite <- (norm_abs f1); now apply norm_monotone).
    clearbody f1 f2 f3. clear - Hq B1 B2 B3 X0 N. pose proof (norm_sq f1 f2 f3) as NN.
    assert (F2 : 9 / 10 <= norm f1 f2 f3 * norm f1 f2 f3) by (apply Rle_trans with (95 / 100 * (95 / 100)); [lra|];
      apply mul2; rewrite v_val in *; lra). rewrite NN in F2.
    unfold tdot in Hq. error32_of Hq P. rewrite !abs_sq in P.
    match type of P with _ <= _ + bp ?k => assert (U : bp k <= bp (-10)) by (apply bp_le; lia) end.
    simpl (bp (-10)) in U. apply Rabs_le_inv in P. set (n := f1 * f1 + f2 * f2 + f3 * f3) in *.
    assert (bp (-100) <= bp (-10)) by (apply bp_le; lia). simpl (bp (-10)) in *. unfold LEAST_NORMAL.
    rewrite v_val in *. lra. }
  assert (I0 : 0 <= recip q).
  { unfold recip. apply RNs_above; [apply Fs_0|]. assert (0 <= RNs (sqrt q)) by (apply RNs_above; [apply Fs_0 | apply
    sqrt_pos]). destruct (Req_dec (RNs (sqrt q)) 0) as [Z|Z]; [rewrite Z, Rinv_0; lra | apply Rlt_le, Rinv_0_lt_compat;
    lra]. }
  assert (HM : norm m1 m2 m3 <= 1 + 5 * v) by exact (LEAST_NORMAL_holds f1 f2 f3 q B1 B2 B3 Hq LN).
  assert (TL : tau <= last <= far) by lra.
  destruct (IN_FRONT_holds m1 m2 m3 mo k5 last HM (S1 _ I0) (S2 _ I0) (S3 _ I0) Fr Hmo H5 TL) as [A B].
  repeat apply Rmax_lub; auto.
Qed.
Theorem ray_ball_is_kept : forall high h y a b c a4 q, t <= high -> h = high * len \/ h = RN (high * len) ->
  let e := RNs (RN (h + error)) in product y (END_ROUNDING * v) e -> let last := Rmin (RNs (y + e)) far in
  let y1 := RNs (c1 - s1) in let y2 := RNs (c2 - s2) in let y3 := RNs (c3 - s3) in
  single (tcross_1 x2 x3 y2 y3) a -> single (tcross_1 x3 x1 y3 y1) b -> single (tcross_1 x1 x2 y1 y2) c ->
  single (tfused (X x1 1) (X x2 1) (X x3 1) (X y1 7) (X y2 7) (X y3 7)) a4 ->
  single (tsquares a b c (RNs (a4 - Rmin (Rmax a4 0) last))) q ->
  let reach := RNs (r + slack) in q <= RNs (reach * reach).
Proof.
  intros high h y a b c a4 q Hh Hx e Hy last y1 y2 y3 Ha Hb Hcc H4 Hq reach'.
  pose proof (END_ROUNDING_holds high h y Hh Hx Hy) as T. cbv zeta in T. fold e in T. fold last in T.
  exact (SLACK_holds a b c a4 last q Ha Hb Hcc H4 T Hq).
Qed.
End Ball.
End Ray.
End Tile.
