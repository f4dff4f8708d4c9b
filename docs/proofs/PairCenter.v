(* rt-geom, enclosing/certify.rs, `pair`: how well the center of the minimal sphere of two spheres is known, before
  and
   after it is rounded. *)
From Proofs Require Import Rounding ErrorFree Norm Spacing Reach Step Frame Pair.
From Flocq Require Import Mult_error Sterbenz.
Open Scope R_scope.

Lemma product_le : forall a b A B, Rabs a <= A -> Rabs b <= B -> Rabs (a * b) <= A * B.
Proof. intros a b A B HA HB. rewrite Rabs_mult. apply mul2; split; auto using Rabs_pos. Qed.
Lemma abs_near : forall x y e Y, Rabs (x - y) <= e -> Rabs y <= Y -> Rabs x <= Y + e.
Proof. intros x y e Y H HY. pose proof (near_le _ _ _ H). lra. Qed.
(* Below 1 doubles are u apart. *)
Lemma RN_one : forall x, Rabs x < 1 -> Rabs (RN x - x) <= / 2 * u.
Proof.
  intros x H. destruct (Req_dec x 0) as [Z|N].
  - rewrite Z, RN_0, Rminus_0_r, Rabs_R0. pose proof u_pos. lra.
  - pose proof (error_le_half_ulp radix2 fexp even x) as E. change (round radix2 fexp (Znearest even) x) with (RN
    x) in E.
    apply Rle_trans with (1 := E). apply Rmult_le_compat_l; [lra|]. rewrite ulp_neq_0 by assumption. apply bp_le.
    assert (M : (mag radix2 x <= 0)%Z) by (apply mag_le_bpow; [assumption | simpl; lra]).
    unfold cexp, fexp, FLT_exp. lia.
Qed.

(* ---- The share of the way: share + low ---- *)
Section Share.
(* the distance exactly, and as computed (Reach.v): its double and the rest; the radii *)
Variables L q rest r s : R.
Hypotheses (Fq : F q) (Frest : F rest) (Fr : F r) (Fs : F s) (L0 : bp (-200) <= L) (L1 : L <= bp 200)
  (HL : Rabs (q + rest - L) <= 34 * (u * u) * L) (Hrest : Rabs rest <= 4 * u * L) (Hq : Rabs (q - L) <= 4 * u * L).
Let k := (L + s - r) / (2 * L).
(* Neither center is inside of the other sphere. *)
Hypothesis (Hk : bp (-22) <= k <= 1 - bp (-22)).
Let inverse := RN (/ q). Let p := RN (s - r). Let p_low := two_sum_error s (- r). Let h := RN (p * / 2).
Let share := RN (/ 2 + RN (h * inverse)).
Let half := RN (q * / 2 + h). Let half_low := two_sum_error (q * / 2) h.
Let part := RN (share * q).
Variable part_low : R.
Hypotheses (Fpart : F part_low) (Hpart : Rabs (part + part_low - share * q) <= bp (-1071)).
Let left := RN (RN (RN (half - part) + RN (half_low - part_low)) + RN (RN (p_low * / 2) + RN (rest * RN (/ 2 -
  share)))).
Let low := RN (left * inverse).

(* all lengths as shares of the distance *)
Let J := / L.
Let d := (s - r) * J. Let th := Rabs d.
Let eps := bp (-800).
Lemma L_pos : 0 < L /\ 0 < J /\ L * J = 1 /\ J <= bp 200.
Proof.
  pose proof (bp_pos (-200)). assert (0 < L) by lra. split; [assumption|]. split; [now apply Rinv_0_lt_compat|].
  split; [unfold J; field; lra|]. unfold J. change 200%Z with (Z.opp (-200)). rewrite bpow_opp. apply
    Rinv_le_contravar; lra.
Qed.
Lemma eps_small : 0 < eps /\ eps <= u * u * / 1000000 /\ (forall e, (e <= -1071)%Z -> bp e * J <= eps /\ bp e <= eps).
Proof.
  destruct L_pos as (LP & JP & LJ & JT). split; [apply bp_pos|]. split.
  - apply Rle_trans with (bp (-20 + (-53 + -53))); [apply bp_le; lia|]. rewrite !bp_add. fold u. pose proof u_pos.
    assert (0 < u * u) by now apply Rmult_lt_0_compat. assert (bp (-20) <= / 1000000) by (simpl; lra).
    rewrite (Rmult_comm (bp (-20))). apply Rmult_le_compat_l; lra.
  - intros e E. split; [|apply bp_le; lia]. apply Rle_trans with (bp e * bp 200); [apply Rmult_le_compat_l; [apply
    Rlt_le,
      bp_pos | assumption]|]. rewrite <- bp_add. apply bp_le. lia.
Qed.
Lemma RNJ : forall x X, Rabs (x * J) <= X -> Rabs (RN x * J - x * J) <= u * X + eps.
Proof.
  intros x X H. destruct L_pos as (LP & JP & LJ & JT). destruct eps_small as (E0 & _ & E).
  destruct (E (-1075)%Z ltac:(lia)) as [E1 _]. replace (RN x * J - x * J) with ((RN x - x) * J) by ring.
  rewrite Rabs_mult, (Rabs_pos_eq J) by lra. pose proof (RN_err x) as R.
  apply Rle_trans with ((u * Rabs x + bp (-1075)) * J); [apply Rmult_le_compat_r; lra|].
  rewrite Rabs_mult, (Rabs_pos_eq J) in H by lra. pose proof u_pos.
  assert (u * (Rabs x * J) <= u * X) by (apply Rmult_le_compat_l; lra). lra.
Qed.
Lemma RN1 : forall x X, Rabs x <= X -> Rabs (RN x - x) <= u * X + eps.
Proof.
  intros x X H. destruct eps_small as (E0 & _ & E). destruct (E (-1075)%Z ltac:(lia)) as [_ E1]. pose proof (RN_err
    x).
  pose proof u_pos. assert (u * Rabs x <= u * X) by (apply Rmult_le_compat_l; lra). lra.
Qed.
Lemma k_d : k = / 2 + d * / 2 /\ 0 <= th <= 1.
Proof.
  destruct L_pos as (LP & JP & LJ & JT). assert (E : k = / 2 + d * / 2) by (unfold k, d, J; field; lra).
  split; [assumption|]. split; [apply Rabs_pos|]. unfold th. apply Rabs_le.
  pose proof (bp_pos (-22)). lra.
Qed.
Lemma distance : Rabs (q * J - 1) <= 4 * u /\ Rabs (rest * J) <= 4 * u /\ Rabs (q * J + rest * J - 1) <= 34 * (u *
  u) /\
  Rabs (inverse * L - 1) <= (501 / 100) * u.
Proof.
  destruct L_pos as (LP & JP & LJ & JT). destruct eps_small as (E0 & E1 & E). pose proof u_pos as U.
  assert (Q : Rabs (q * J - 1) <= 4 * u).
  { replace (q * J - 1) with ((q - L) * J) by (rewrite <- LJ; ring). rewrite Rabs_mult, (Rabs_pos_eq J) by lra.
    apply Rle_trans with (4 * u * L * J); [apply Rmult_le_compat_r; lra|]. rewrite Rmult_assoc, LJ. lra. }
  split; [assumption|]. split; [|split].
  - rewrite Rabs_mult, (Rabs_pos_eq J) by lra. apply Rle_trans with (4 * u * L * J); [apply Rmult_le_compat_r; lra|].
    rewrite Rmult_assoc, LJ. lra.
  - replace (q * J + rest * J - 1) with ((q + rest - L) * J) by (rewrite <- LJ; ring). rewrite Rabs_mult,
    (Rabs_pos_eq J) by
      lra. apply Rle_trans with (34 * (u * u) * L * J); [apply Rmult_le_compat_r; lra|]. rewrite Rmult_assoc, LJ. lra.
  - apply Rabs_le_inv in Q. assert (q0 : 0 < q).
    { apply Rmult_lt_reg_r with J; [assumption|]. rewrite Rmult_0_l, u_val in *. lra. }
    set (g := L * / q). assert (G : g * (q * J) = 1) by (unfold g, J; field; lra).
    assert (g0 : 0 < g) by (unfold g; apply Rmult_lt_0_compat; [assumption | now apply Rinv_0_lt_compat]).
    assert (G2 : Rabs (g - 1) <= (4 + / 1000) * u).
    { set (qj := q * J) in *. clearbody qj. clear - G Q g0. rewrite u_val in *. apply Rabs_le. split; nra. }
    replace (inverse * L - 1) with ((inverse - / q) * L + (g - 1)) by (unfold g; ring).
    eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_mult, (Rabs_pos_eq L) by lra.
    pose proof (RN_err (/ q)) as R. fold inverse in R. rewrite (Rabs_pos_eq (/ q)) in R by (apply Rlt_le; now apply
      Rinv_0_lt_compat).
    assert (T : bp (-1075) * L <= eps).
    { apply Rle_trans with (bp (-1075) * bp 200); [apply Rmult_le_compat_l; [apply Rlt_le, bp_pos | assumption]|].
      rewrite <- bp_add. apply bp_le. lia. }
    assert (R2 : Rabs (inverse - / q) * L <= u * g + eps).
    { apply Rle_trans with ((u * / q + bp (-1075)) * L); [apply Rmult_le_compat_r; lra|]. unfold g. lra. }
    apply Rabs_le_inv in G2 as G3. assert (u * g <= u * (1 + (4 + / 1000) * u)) by (apply Rmult_le_compat_l; lra).
    clear - R2 G2 E1 H U. rewrite u_val in *. lra.
Qed.
(* The difference of the radii. *)
Lemma difference : p * J + p_low * J = d /\ Rabs (p_low * J) <= u * th /\ Rabs (h * J - p * J * / 2) <= eps.
Proof.
  destruct L_pos as (LP & JP & LJ & JT). destruct eps_small as (E0 & E1 & E). destruct (E (-1075)%Z ltac:(lia)) as
    [E2 _].
  pose proof (two_sum s (- r) Fs (F_opp _ Fr)) as T. fold p_low in T. change (s + - r) with (s - r) in T. fold p in T.
  destruct (two_sum_error_le s (- r) Fs (F_opp _ Fr)) as [B _]. fold p_low in B. change (s + - r) with (s - r) in B.
  split; [unfold d; rewrite <- T; ring|]. split.
  - unfold th, d. rewrite !Rabs_mult, (Rabs_pos_eq J) by lra. rewrite <- Rmult_assoc. apply Rmult_le_compat_r; lra.
  - replace (h * J - p * J * / 2) with ((h - p * bp (-1)) * J) by (simpl; lra). rewrite Rabs_mult, (Rabs_pos_eq J)
    by lra.
    apply Rle_trans with (2 := E2). apply Rmult_le_compat_r; [lra|]. unfold h. replace (/ 2) with (bp (-1)) by
      (simpl; lra).
    apply Frame.scaled, RN_F.
Qed.
Let kappa := k - share.
Lemma share_near : Rabs kappa <= (51 / 100) * u + (352 / 100) * u * th /\ Rabs (/ 2 - share) <= th * / 2 + 5 * u /\
  bp (-23) <= share <= 1.
Proof.
  destruct k_d as [KD TH]. destruct distance as (_ & _ & _ & DI). destruct difference as (PD & PL & HP).
  destruct eps_small as (E0 & E1 & _). pose proof u_pos as U. destruct L_pos as (LP & JP & LJ & _).
  assert (B22 : bp (-22) = 2 * bp (-23)) by (change (-22)%Z with (1 + -23)%Z; rewrite bp_add, bp_1; ring).
  assert (B23 : bp (-23) = / 8388608) by (simpl; lra). rewrite B22, B23 in *.
  assert (T0 : Rabs d <= th) by (unfold th; lra). set (e := / 2 + d * / 2) in *.
  (* the difference over the distance *)
  assert (X1 : Rabs (h * J - d * / 2) <= u * th * / 2 + eps).
  { replace (h * J - d * / 2) with ((h * J - p * J * / 2) + - (p_low * J * / 2)) by (rewrite <- PD; field).
    eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp, (Rabs_mult (p_low * J)), (Rabs_pos_eq (/ 2)) by lra.
      lra. }
  assert (X2 : Rabs (h * J) <= th * / 2 + (u * th * / 2 + eps)).
  { apply (abs_near _ _ _ _ X1). rewrite Rabs_mult, (Rabs_pos_eq (/ 2)) by lra. lra. }
  assert (X3 : Rabs (h * inverse - h * J) <= (th * / 2 + (u * th * / 2 + eps)) * ((501 / 100) * u)).
  { replace (h * inverse - h * J) with (h * J * (inverse * L - 1)) by (replace (h * J * (inverse * L - 1)) with (h
    * inverse
      * (L * J) - h * J) by ring; rewrite LJ; ring). now apply product_le. }
  assert (X4 : Rabs (h * inverse - d * / 2) <= (301 / 100) * u * th + 2 * eps).
  { replace (h * inverse - d * / 2) with ((h * inverse - h * J) + (h * J - d * / 2)) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. clear - X1 X3 TH E0 E1. clearbody th eps. rewrite u_val in *. lra. }
  assert (X5 : Rabs (h * inverse) <= th * / 2 + ((301 / 100) * u * th + 2 * eps)).
  { apply (abs_near _ _ _ _ X4). rewrite Rabs_mult, (Rabs_pos_eq (/ 2)) by lra. lra. }
  pose proof (RN1 _ _ X5) as R1. set (x := RN (h * inverse)) in *.
  assert (X6 : Rabs (x - d * / 2) <= (3515 / 1000) * u * th + 4 * eps).
  { replace (x - d * / 2) with ((x - h * inverse) + (h * inverse - d * / 2)) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. clear - X4 R1 TH E0 E1. clearbody th eps. rewrite u_val in *. lra. }
  assert (Y : Rabs (/ 2 + x) < 1).
  { replace (/ 2 + x) with (e + (x - d * / 2)) by (unfold e; ring). apply Rabs_le_inv in X6. rewrite KD in Hk.
    apply Rabs_lt.
    clear - X6 Hk TH E0 E1. clearbody th eps e. rewrite u_val in *. lra. }
  pose proof (RN_one _ Y) as R2. change (RN (/ 2 + x)) with share in R2.
  assert (K : Rabs kappa <= (51 / 100) * u + (352 / 100) * u * th).
  { unfold kappa. rewrite KD. replace (e - share) with (- (share - (/ 2 + x)) + - (x - d * / 2)) by (unfold e; ring).
    eapply Rle_trans; [apply Rabs_triang|]. rewrite !Rabs_Ropp. clear - R2 X6 E0 E1 TH. clearbody th eps.
    rewrite u_val in *. lra. }
  split; [assumption|]. split.
  - replace (/ 2 - share) with (kappa + - (d * / 2)) by (unfold kappa; rewrite KD; unfold e; ring).
    eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp, (Rabs_mult d), (Rabs_pos_eq (/ 2)) by lra.
    clear - K T0 TH U. clearbody th. rewrite u_val in *. lra.
  - apply Rabs_le_inv in K. unfold kappa in K. rewrite KD in K, Hk. clear - K Hk TH. clearbody th e share.
    rewrite u_val in *. lra.
Qed.
(* What is left of it. *)
Theorem share_low_near : Rabs (low - kappa) <= (53 / 10) * (u * u) + 56 * (u * u) * th.
Proof.
  destruct k_d as [KD TH]. destruct distance as (DQ & DR & DD & DI). destruct difference as (PD & PL & HP).
  destruct share_near as (KN & SH & [S0 S1]). destruct eps_small as (E0 & E1 & E). pose proof u_pos as U.
  destruct L_pos as (LP & JP & LJ & _).
  assert (B23 : bp (-23) = / 8388608) by (simpl; lra). rewrite B23 in S0.
  destruct (E (-1071)%Z ltac:(lia)) as [T1 _]. destruct (E (-1075)%Z ltac:(lia)) as [T2 _].
  assert (Q0 : q * J - 1 <= 4 * u /\ - (4 * u) <= q * J - 1) by (apply Rabs_le_inv in DQ; lra).
  (* half the distance is a double *)
  assert (Fh : F h) by apply RN_F.
  assert (Fq2 : F (q * / 2)).
  { replace (/ 2) with (bp (-1)) by (simpl; lra). apply mult_bpow_exact_FLT; [assumption|].
    assert (bp (-201) <= Rabs q).
    { assert (bp (-200) = 2 * bp (-201)) by (change (-200)%Z with (1 + -201)%Z; rewrite bp_add, bp_1; ring).
      pose proof (bp_pos (-201)). apply Rabs_le_inv in Hq. rewrite Rabs_pos_eq; rewrite u_val in *; lra. }
    assert (G : (-201 < mag radix2 q)%Z) by now apply mag_gt_bpow. lia. }
  pose proof (two_sum (q * / 2) h Fq2 Fh) as TS. fold half half_low in TS.
  destruct (two_sum_error_le (q * / 2) h Fq2 Fh) as [HLo _]. fold half_low in HLo.
  (* as shares of the distance *)
  assert (HJ : Rabs (h * J) <= th * / 2 + th * u + eps).
  { apply (abs_near (h * J) (p * J * / 2) eps); [assumption|]. replace (p * J * / 2) with (d * / 2 + - (p_low * J *
    / 2)) by
      (rewrite <- PD; field). eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp, !(Rabs_mult _ (/ 2)),
      (Rabs_pos_eq (/ 2)) by lra. fold th. clear - PL TH U. clearbody th. rewrite u_val in *. lra. }
  assert (HN : half * J + half_low * J = q * J * / 2 + h * J) by (rewrite <- Rmult_plus_distr_r, TS; ring).
  assert (M1 : Rabs (q * J * / 2 + h * J) <= / 2 + th * / 2 + 4 * u).
  { eapply Rle_trans; [apply Rabs_triang|]. rewrite (Rabs_pos_eq (q * J * / 2)) by (rewrite u_val in *; lra).
    clear - HJ Q0 TH E0 E1. clearbody th eps. rewrite u_val in *. lra. }
  assert (HL1 : Rabs (half_low * J) <= u * (/ 2 + th * / 2 + 4 * u)).
  { rewrite Rabs_mult, (Rabs_pos_eq J) by lra. apply Rle_trans with (u * Rabs (q * / 2 + h) * J); [apply
    Rmult_le_compat_r;
      lra|]. rewrite Rmult_assoc. apply Rmult_le_compat_l; [lra|]. rewrite <- (Rabs_pos_eq J) at 1 by lra.
    rewrite <- Rabs_mult. replace ((q * / 2 + h) * J) with (q * J * / 2 + h * J) by ring. exact M1. }
  set (P := share * (q * J)) in *. assert (PS : share * q * J = P) by (unfold P; ring).
  assert (Pk : Rabs (P - (/ 2 + d * / 2)) <= 9 * u).
  { replace (P - (/ 2 + d * / 2)) with (- kappa + share * (q * J - 1)) by (unfold P, kappa; rewrite KD; ring).
    eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp.
    assert (Rabs (share * (q * J - 1)) <= 1 * (4 * u)) by (apply product_le; [apply Rabs_le; lra | exact DQ]).
    clear - H KN TH U. clearbody th. rewrite u_val in *. lra. }
  assert (dd : Rabs d <= th) by (unfold th; lra).
  assert (P1 : Rabs P <= / 2 + th * / 2 + 9 * u).
  { apply (abs_near _ _ _ _ Pk). eapply Rle_trans; [apply Rabs_triang|]. rewrite (Rabs_mult d), !(Rabs_pos_eq (/
    2)) by lra.
    lra. }
  assert (PR : Rabs (part * J - P) <= u * (/ 2 + th * / 2 + 9 * u) + eps).
  { rewrite <- PS. apply RNJ. rewrite PS. exact P1. }
  assert (PE : Rabs (part * J + part_low * J - P) <= eps).
  { rewrite <- PS. replace (part * J + part_low * J - share * q * J) with ((part + part_low - share * q) * J) by ring.
    rewrite Rabs_mult, (Rabs_pos_eq J) by lra. apply Rle_trans with (2 := T1). apply Rmult_le_compat_r; lra. }
  assert (PL1 : Rabs (part_low * J) <= u * (/ 2 + th * / 2 + 9 * u) + 2 * eps).
  { replace (part_low * J) with ((part * J + part_low * J - P) + - (part * J - P)) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. lra. }
  (* the first difference is exact *)
  assert (NE : Rabs (half * J - part * J) <= 20 * u).
  { replace (half * J - part * J) with ((q * J * / 2 + h * J - P) + - (half_low * J) + - (part * J - P)) by
    (rewrite <- HN;
      ring). eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
    rewrite !Rabs_Ropp. assert (Rabs (q * J * / 2 + h * J - P) <= 15 * u).
    { replace (q * J * / 2 + h * J - P) with ((q * J - 1) * / 2 + (h * J - p * J * / 2) + - (p_low * J * / 2) + -
      (P - (/ 2 +
        d * / 2))) by (rewrite <- PD; field). eapply Rle_trans; [apply Rabs_triang|].
      eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
      eapply Rle_trans; [apply Rplus_le_compat_r, Rplus_le_compat_r, Rabs_triang|].
      rewrite !Rabs_Ropp, !(Rabs_mult _ (/ 2)), (Rabs_pos_eq (/ 2)) by lra.
      clear - DQ HP PL Pk TH E0 E1. clearbody th eps. rewrite u_val in *. lra. }
    clear - H HL1 PR TH E0 E1. clearbody th eps. rewrite u_val in *. lra. }
  assert (PJ : / 9000000 <= part * J).
  { assert (P0 : / 8400000 <= P).
    { unfold P. apply Rle_trans with (/ 8388608 * (1 - 4 * u)); [rewrite u_val; lra|]. apply Rmult_le_compat; try lra.
      rewrite u_val; lra. }
    apply Rabs_le_inv in PR. clear - P0 PR TH E0 E1. clearbody th eps P. rewrite u_val in *. lra. }
  assert (EX : RN (half - part) = half - part).
  { apply RN_id. apply (sterbenz radix2 fexp); [apply RN_F | apply RN_F|]. apply Rabs_le_inv in NE. unfold Rdiv.
    assert (A1 : part * / 2 * J <= half * J) by (clear - NE PJ; rewrite u_val in *; lra).
    assert (A2 : half * J <= 2 * part * J) by (clear - NE PJ; rewrite u_val in *; lra).
    split; apply Rmult_le_reg_r with J; assumption. }
  unfold low, left. rewrite EX. set (a := half - part) in *.
  assert (BB : Rabs ((half_low - part_low) * J) <= u * (1 + th + 14 * u)).
  { replace ((half_low - part_low) * J) with (half_low * J + - (part_low * J)) by ring. eapply Rle_trans; [apply
      Rabs_triang|]. rewrite Rabs_Ropp. clear - HL1 PL1 TH E0 E1. clearbody th eps. rewrite u_val in *. lra. }
  pose proof (RNJ _ _ BB) as R1. set (b := RN (half_low - part_low)) in *.
  (* a + b: the share that is left, and what the double of the distance is off *)
  set (z := / 2 - share) in *.
  assert (ZQ : Rabs (z * (q * J - 1)) <= (th * / 2 + 5 * u) * (4 * u)) by now apply product_le.
  assert (AB : Rabs (a * J + (half_low - part_low) * J - (kappa - p_low * J * / 2 + z * (q * J - 1))) <= 2 * eps).
  { replace (a * J + (half_low - part_low) * J - (kappa - p_low * J * / 2 + z * (q * J - 1))) with
      (- (part * J + part_low * J - P) + (h * J - p * J * / 2)).
    - eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. lra.
    - unfold a, kappa, z. rewrite KD. replace d with (p * J + p_low * J) by exact PD. unfold P.
      replace ((half - part) * J + (half_low - part_low) * J) with (half * J + half_low * J - part * J - part_low *
        J) by
        ring. rewrite HN. field. }
  assert (PL2 : Rabs (p_low * J * / 2) <= u * th * / 2) by (rewrite Rabs_mult, (Rabs_pos_eq (/ 2)) by lra; lra).
  set (w := kappa - p_low * J * / 2 + z * (q * J - 1)) in *.
  assert (W : Rabs w <= (52 / 100) * u + (603 / 100) * u * th).
  { unfold w, Rminus. eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r,
    Rabs_triang|].
    rewrite Rabs_Ropp. clear - KN PL2 ZQ TH U. clearbody th. unfold Rminus in ZQ. rewrite u_val in *. lra. }
  assert (C1 : Rabs ((a + b) * J - w) <= u * (1 + th + 14 * u) + 4 * eps).
  { replace ((a + b) * J - w) with ((a * J + (half_low - part_low) * J - w) + (b * J - (half_low - part_low) * J))
    by ring.
    eapply Rle_trans; [apply Rabs_triang|].
    assert (u * (u * (1 + th + 14 * u)) <= u * (1 + th + 14 * u)) by (clear - TH; clearbody th; rewrite u_val;
      lra). lra. }
  assert (C1' : Rabs ((a + b) * J - w) <= u * (u * (1 + th + 14 * u)) + 4 * eps).
  { replace ((a + b) * J - w) with ((a * J + (half_low - part_low) * J - w) + (b * J - (half_low - part_low) * J))
    by ring.
    eapply Rle_trans; [apply Rabs_triang|]. lra. }
  assert (C2 : Rabs ((a + b) * J) <= (53 / 100) * u + (604 / 100) * u * th).
  { apply (abs_near _ _ _ _ C1') in W. clear - W TH E0 E1. clearbody th eps. rewrite u_val in *. lra. }
  pose proof (RNJ _ _ C2) as R2. set (ab := RN (a + b)) in *.
  (* the small terms *)
  assert (PH : Rabs (RN (p_low * / 2) * J - p_low * J * / 2) <= eps).
  { assert (HB : / 2 = bp (-1)) by (simpl; lra). rewrite HB.
    replace (RN (p_low * bp (-1)) * J - p_low * J * bp (-1)) with ((RN (p_low * bp (-1)) - p_low * bp (-1)) * J) by
      ring.
    rewrite Rabs_mult, (Rabs_pos_eq J) by lra. apply Rle_trans with (2 := T2). apply Rmult_le_compat_r; [lra|].
    apply Frame.scaled, RN_F. }
  set (g1 := RN (p_low * / 2)) in *. pose proof (RN1 _ _ SH) as R3. set (g2 := RN z) in *.
  assert (G2 : Rabs g2 <= th * / 2 + 7 * u).
  { apply (abs_near _ _ _ _ R3) in SH. clear - SH TH E0 E1. clearbody th eps. rewrite u_val in *. lra. }
  assert (G3 : Rabs (rest * g2 * J) <= 4 * u * (th * / 2 + 7 * u)).
  { replace (rest * g2 * J) with (rest * J * g2) by ring. now apply product_le. }
  pose proof (RNJ _ _ G3) as R4. set (g3 := RN (rest * g2)) in *.
  assert (G4 : Rabs ((g1 + g3) * J) <= (251 / 100) * u * th + 30 * (u * u)).
  { replace ((g1 + g3) * J) with ((g1 * J - p_low * J * / 2) + p_low * J * / 2 + (g3 * J - rest * g2 * J) + rest *
    g2 * J) by
      ring. eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
    eapply Rle_trans; [apply Rplus_le_compat_r, Rplus_le_compat_r, Rabs_triang|].
    clear - PH PL2 R4 G3 TH E0 E1. clearbody th eps. rewrite u_val in *. lra. }
  pose proof (RNJ _ _ G4) as R5. set (g4 := RN (g1 + g3)) in *.
  assert (ZD : Rabs (z * (q * J + rest * J - 1)) <= (th * / 2 + 5 * u) * (34 * (u * u))) by now apply product_le.
  assert (ZR : Rabs (rest * J * (g2 - z)) <= 4 * u * (u * (th * / 2 + 5 * u) + eps)) by now apply product_le.
  (* all together *)
  assert (S : Rabs ((ab + g4) * J - kappa) <= (16 / 10) * (u * u) + (307 / 10) * (u * u) * th).
  { replace ((ab + g4) * J - kappa) with ((ab * J - (a + b) * J) + ((a + b) * J - w) + (g4 * J - (g1 + g3) * J) +
    (g1 * J -
      p_low * J * / 2) + (g3 * J - rest * g2 * J) + rest * J * (g2 - z) + z * (q * J + rest * J - 1)) by (unfold w;
        ring).
    eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
    do 4 (eapply Rle_trans; [repeat apply Rplus_le_compat_r; apply Rabs_triang|]).
    clear - R2 C1' R5 PH R4 ZR ZD TH E0 E1. clearbody th eps. rewrite u_val in *. lra. }
  assert (S2 : Rabs ((ab + g4) * J) <= (52 / 100) * u + (353 / 100) * u * th).
  { apply (abs_near _ _ _ _ S) in KN. clear - KN TH. clearbody th. rewrite u_val in *. lra. }
  pose proof (RNJ _ _ S2) as R6. set (l := RN (ab + g4)) in *.
  assert (S3 : Rabs (l * J - kappa) <= (213 / 100) * (u * u) + (343 / 10) * (u * u) * th).
  { replace (l * J - kappa) with ((l * J - (ab + g4) * J) + ((ab + g4) * J - kappa)) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. clear - S R6 TH E0 E1. clearbody th eps. rewrite u_val in *. lra. }
  assert (S4 : Rabs (l * J) <= (52 / 100) * u + (353 / 100) * u * th).
  { apply (abs_near _ _ _ _ S3) in KN. clear - KN TH. clearbody th. rewrite u_val in *. lra. }
  assert (S5 : Rabs (l * inverse - l * J) <= ((52 / 100) * u + (353 / 100) * u * th) * ((501 / 100) * u)).
  { replace (l * inverse - l * J) with (l * J * (inverse * L - 1)) by (replace (l * J * (inverse * L - 1)) with (l
    * inverse
      * (L * J) - l * J) by ring; rewrite LJ; ring). now apply product_le. }
  assert (S6 : Rabs (l * inverse) <= (53 / 100) * u + (354 / 100) * u * th).
  { apply (abs_near _ _ _ _ S5) in S4. clear - S4 TH. clearbody th. rewrite u_val in *. lra. }
  pose proof (RN1 _ _ S6) as R7.
  replace (RN (l * inverse) - kappa) with ((RN (l * inverse) - l * inverse) + (l * inverse - l * J) + (l * J -
    kappa)) by
    ring. eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
  clear - R7 S5 S3 TH E0 E1. clearbody th eps. rewrite u_val in *. lra.
Qed.
End Share.

(* ---- The center along one axis ---- *)
Section Axis.
(* the first center and the second; the share as above; the product has its error in `more` *)
Variables from to k th share share_low more : R.
Hypotheses (Ffrom : F from) (Fto : F to) (Hth : 0 <= th <= 1) (Hshare : Rabs (/ 2 - share) <= th * / 2 + 5 * u)
  (Hkappa : Rabs (k - share) <= (51 / 100) * u + (352 / 100) * u * th)
  (Hlow : Rabs (share_low - (k - share)) <= (53 / 10) * (u * u) + 56 * (u * u) * th).
Let v := to - from.
Let p := RN (to - from). Let l := two_sum_error to (- from).
Let way := RN (p * share).
Hypothesis Hmore : Rabs (way + more - p * share) <= bp (-1071).
Let way_low := RN (more + RN (RN (p * share_low) + RN (l * share))).
Let c := RN (from + way). Let c_low := RN (two_sum_error from way + way_low).
Let center := RN (c + c_low).
Let e := RN (RN (center - c) - c_low).
(* What the center is off the exact one, but for e. *)
Let g := center - (from + k * v) - e.
Let V := Rabs v.
Lemma center_near : Rabs g <= (u * u) * ((126 / 10) * V + (814 / 10) * (th * V)) + (41 / 10) * (u * u) * Rabs
  center + 200 * bp (-1071).
Proof.
  pose proof u_pos as U. pose proof (bp_pos (-1075)) as T0. pose proof (Rabs_pos v) as V0. fold V in V0.
  assert (T1 : bp (-1075) <= bp (-1071)) by (apply bp_le; lia). set (t := bp (-1071)) in *.
  assert (TV0 : 0 <= th * V) by (apply Rmult_le_pos; lra).
  assert (TV1 : th * V <= V) by (rewrite <- (Rmult_1_l V) at 2; apply Rmult_le_compat_r; lra).
  assert (Rn : forall x X, Rabs x <= X -> Rabs (RN x - x) <= u * X + t) by (intros x X H; pose proof (rounding _ _
    H); lra).
  (* the way *)
  pose proof (two_sum to (- from) Fto (F_opp _ Ffrom)) as S1. fold l in S1. change (to + - from) with v in S1.
  change (to + - from) with (to - from) in S1. fold p in S1.
  destruct (two_sum_error_le to (- from) Fto (F_opp _ Ffrom)) as [L1 _]. fold l in L1. change (to + - from) with v
    in L1.
  fold V in L1.
  assert (PV : p + l = v) by (unfold v; exact S1).
  assert (P1 : Rabs p <= (1 + u) * V) by (replace p with (v + - l) by lra; eapply Rle_trans; [apply Rabs_triang|];
    rewrite Rabs_Ropp; fold V; lra).
  assert (SL : Rabs share_low <= (52 / 100) * u + (353 / 100) * u * th).
  { apply (abs_near _ _ _ _ Hlow) in Hkappa. clear - Hkappa Hth. rewrite u_val in *. lra. }
  assert (SH : Rabs share <= / 2 + th * / 2 + 5 * u).
  { replace share with (/ 2 + - (/ 2 - share)) by ring. eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp,
      (Rabs_pos_eq (/ 2)) by lra. lra. }
  pose proof (product_le _ _ _ _ P1 SL) as X1. pose proof (product_le _ _ _ _ L1 SH) as X2.
  pose proof (product_le _ _ _ _ P1 SH) as X3.
  pose proof (product_le _ _ _ _ P1 Hlow) as X4. pose proof (product_le _ _ _ _ L1 Hkappa) as X5.
  set (kappa := k - share) in *. set (delta := share_low - kappa) in *.
  assert (Y1 : Rabs (p * share_low) <= u * ((521 / 1000) * V + (354 / 100) * (th * V))).
  { apply Rle_trans with (1 := X1). clear - V0 TV0. rewrite u_val. lra. }
  assert (Y2 : Rabs (l * share) <= u * ((501 / 1000) * V + (501 / 1000) * (th * V))).
  { apply Rle_trans with (1 := X2). clear - V0 TV0. rewrite u_val. lra. }
  pose proof (Rn _ _ Y1) as R1. pose proof (Rn _ _ Y2) as R2. set (t1 := RN (p * share_low)) in *. set (t2 := RN (l
    * share)) in *.
  assert (Y3 : Rabs (t1 + t2) <= u * ((1023 / 1000) * V + (405 / 100) * (th * V)) + 3 * t).
  { replace (t1 + t2) with ((t1 - p * share_low) + p * share_low + (t2 - l * share) + l * share) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
    eapply Rle_trans; [apply Rplus_le_compat_r, Rplus_le_compat_r, Rabs_triang|].
    clear - Y1 Y2 R1 R2 V0 TV0 T0 T1. rewrite u_val in *. lra. }
  pose proof (Rn _ _ Y3) as R3. set (t3 := RN (t1 + t2)) in *.
  (* what the product leaves *)
  pose proof (Rn _ _ X3) as RW. fold way in RW.
  assert (YM : Rabs more <= u * ((501 / 1000) * V + (501 / 1000) * (th * V)) + 3 * t).
  { replace more with ((way + more - p * share) + - (way - p * share)) by ring. eapply Rle_trans; [apply
    Rabs_triang|].
    rewrite Rabs_Ropp. clear - Hmore RW V0 TV0 T0 T1. rewrite u_val in *. lra. }
  assert (Y4 : Rabs (more + t3) <= u * ((153 / 100) * V + (456 / 100) * (th * V)) + 10 * t).
  { replace (more + t3) with (more + (t3 - (t1 + t2)) + (t1 + t2)) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
    clear - YM R3 Y3 V0 TV0 T0 T1. rewrite u_val in *. lra. }
  pose proof (Rn _ _ Y4) as R4. fold way_low in R4.
  assert (Y5 : Rabs way_low <= u * ((1531 / 1000) * V + (457 / 100) * (th * V)) + 12 * t).
  { apply (abs_near _ _ _ _ R4) in Y4. clear - Y4 V0 TV0 T0 T1. rewrite u_val in *. lra. }
  (* the center *)
  pose proof (two_sum from way Ffrom (RN_F _)) as S2. fold c in S2.
  destruct (two_sum_error_le from way Ffrom (RN_F _)) as [_ L2]. fold c in L2. set (cl := two_sum_error from way)
    in *.
  assert (Y6 : Rabs (cl + way_low) <= u * Rabs c + (u * ((1531 / 1000) * V + (457 / 100) * (th * V)) + 12 * t)).
  { eapply Rle_trans; [apply Rabs_triang|]. lra. }
  pose proof (Rn _ _ Y6) as R5. fold c_low in R5. pose proof (Rabs_pos c) as C0.
  assert (Y7 : Rabs c_low <= (1 + 2 * u) * (u * Rabs c) + u * ((1532 / 1000) * V + (458 / 100) * (th * V)) + 14 * t).
  { apply (abs_near _ _ _ _ R5) in Y6. clear - Y6 C0 V0 TV0 T0 T1. rewrite u_val in *. lra. }
  pose proof (RN_back (c + c_low)) as R6. fold center in R6. pose proof (Rabs_pos center) as Z0. set (C := Rabs
    center) in *.
  assert (Y8 : Rabs (center - c) <= (1 + 2 * u) * (u * Rabs c) + u * ((1532 / 1000) * V + (458 / 100) * (th * V)) +
    15 * t + u * C).
  { replace (center - c) with (c_low + (center - (c + c_low))) by ring. eapply Rle_trans; [apply Rabs_triang|]. lra. }
  assert (CC : Rabs c <= (1 + 3 * u) * C + u * (2 * V + 5 * (th * V)) + 20 * t).
  { assert (Q : Rabs c <= C + Rabs (center - c)) by (replace c with (center + - (center - c)) at 1 by ring;
      eapply Rle_trans; [apply Rabs_triang|]; rewrite Rabs_Ropp; fold C; lra).
    clear - Q Y8 C0 Z0 V0 TV0 T0 T1. rewrite u_val in *. lra. }
  assert (Y9 : Rabs (center - c) <= (2 + 1 / 1000) * (u * C) + u * ((1533 / 1000) * V + (459 / 100) * (th * V)) +
    16 * t).
  { clear - CC Y8 C0 Z0 V0 TV0 T0 T1. rewrite u_val in *. lra. }
  pose proof (Rn _ _ Y9) as R7. set (b := RN (center - c)) in *.
  assert (Y10 : Rabs (b - c_low) <= (1 + 1 / 1000) * (u * C) + u * (u * (2 * V + 5 * (th * V))) + 3 * t).
  { replace (b - c_low) with ((b - (center - c)) + (center - (c + c_low))) by ring. eapply Rle_trans; [apply
    Rabs_triang|].
    clear - R6 R7 Z0 V0 TV0 T0 T1. rewrite u_val in *. lra. }
  pose proof (Rn _ _ Y10) as R8. fold e in R8.
  (* all together *)
  assert (E : g = p * delta - l * kappa + (way + more - p * share) + (t1 - p * share_low) + (t2 - l * share) + (t3
    - (t1 + t2)) +
    (way_low - (more + t3)) + (c_low - (cl + way_low)) - (b - (center - c)) - (e - (b - c_low))).
  { unfold g, delta, kappa. rewrite <- PV. replace cl with (from + way - c) by lra. ring. }
  rewrite E. unfold Rminus at 1 2 3.
  do 9 (eapply Rle_trans; [repeat apply Rplus_le_compat_r; apply Rabs_triang|]). rewrite !Rabs_Ropp.
  clearbody t1 t2 t3 b delta kappa cl. clear - X4 X5 Hmore R1 R2 R3 R4 R5 R7 R8 CC C0 Z0 V0 TV0 T0 T1.
  rewrite u_val in *. lra.
Qed.
End Axis.

(* ---- The three axes, and the bracket ---- *)
Section Center.
Variables a1 a2 a3 b1 b2 b3 L q rest r s part_low m1 m2 m3 : R.
Hypotheses (Fa1 : F a1) (Fa2 : F a2) (Fa3 : F a3) (Fb1 : F b1) (Fb2 : F b2) (Fb3 : F b3) (Fq : F q)
  (Fr : F r) (Fs : F s) (Hr : 0 <= r) (Hs : 0 <= s).
Let v1 := b1 - a1. Let v2 := b2 - a2. Let v3 := b3 - a3.
(* Reach.v *)
Hypotheses (HLv : L = norm v1 v2 v3) (L0 : bp (-200) <= L) (L1 : L <= bp 200)
  (HL : Rabs (q + rest - L) <= 34 * (u * u) * L) (Hrest : Rabs rest <= 4 * u * L) (Hq : Rabs (q - L) <= 4 * u * L).
Let k := (L + s - r) / (2 * L).
Let inverse := RN (/ q). Let p4 := RN (s - r). Let p4_low := two_sum_error s (- r). Let h := RN (p4 * / 2).
Let share := RN (/ 2 + RN (h * inverse)).
Let half := RN (q * / 2 + h). Let half_low := two_sum_error (q * / 2) h.
Let part := RN (share * q).
Hypothesis Hpart : Rabs (part + part_low - share * q) <= bp (-1071).
Let left := RN (RN (RN (half - part) + RN (half_low - part_low)) + RN (RN (p4_low * / 2) + RN (rest * RN (/ 2 -
  share)))).
Let share_low := RN (left * inverse).
Let nearest := RN (q * Rmin share (RN (1 - share))).
Let radius := RN (q + RN (r + s)) * / 2.
Hypothesis Hinside : NEARLY_INSIDE * radius <= nearest.
Lemma radius_q : q * / 2 * (1 - 2 * u) <= radius /\ 0 < q.
Proof.
  pose proof u_pos as U. pose proof (bp_pos (-200)). apply Rabs_le_inv in Hq. assert (q0 : 0 < q) by (rewrite u_val
    in *; lra).
  split; [|assumption]. unfold radius. pose proof (RN_sum r s Fr Fs) as E1. set (j := RN (r + s)) in *.
  assert (j0 : 0 <= j) by (unfold j; rewrite <- RN_0; apply RN_le; lra).
  pose proof (RN_sum q j Fq (RN_F _)) as E2. rewrite (Rabs_pos_eq (q + j)) in E2 by lra. apply Rabs_le_inv in E2.
  rewrite u_val in *. lra.
Qed.
(* Whoever passes is not inside of the other. *)
Lemma inside_k : bp (-22) <= k <= 1 - bp (-22).
Proof.
  pose proof u_pos as U. destruct radius_q as [RQ q0]. pose proof (bp_pos (-200)) as B2. assert (LP : 0 < L) by lra.
  assert (B20 : bp (-20) = / 1048576) by (simpl; lra). assert (B22 : bp (-22) = / 4194304) by (simpl; lra).
  assert (q1 : bp (-201) <= q).
  { assert (bp (-200) = 2 * bp (-201)) by (change (-200)%Z with (1 + -201)%Z; rewrite bp_add, bp_1; ring).
    pose proof (bp_pos (-201)). apply Rabs_le_inv in Hq. rewrite u_val in *; lra. }
  set (m := Rmin share (RN (1 - share))) in *.
  (* the lesser share *)
  assert (M : / 2100000 <= m).
  { unfold NEARLY_INSIDE in Hinside. rewrite B20 in Hinside. pose proof (RN_err (q * m)) as E. change (RN (q * m))
    with nearest
      in E. assert (N : / 2097160 * q <= nearest) by (rewrite u_val in *; lra).
    assert (T : bp (-1075) <= / 1000000000000 * q).
    { apply Rle_trans with (bp (-40 + -201)); [apply bp_le; lia|]. rewrite bp_add. assert (bp (-40) <= /
      1000000000000) by
        (simpl; lra). pose proof (bp_pos (-201)). pose proof (bp_pos (-40)). apply Rmult_le_compat; lra. }
    apply Rnot_lt_le. intro C. destruct (Rle_or_lt 0 m) as [Z|Z].
    - rewrite (Rabs_pos_eq (q * m)) in E by (apply Rmult_le_pos; lra). apply Rabs_le_inv in E.
      assert (q * m <= q * / 2100000) by (apply Rmult_le_compat_l; lra). rewrite u_val in *. lra.
    - assert (nearest <= 0) by (unfold nearest; rewrite <- RN_0; apply RN_le; fold m; nra). lra. }
  assert (S0 : / 2100000 <= share) by (eapply Rle_trans; [exact M | apply Rmin_l]).
  assert (S1 : share <= 1 - / 2100100).
  { assert (Q : / 2100000 <= RN (1 - share)) by (eapply Rle_trans; [exact M | apply Rmin_r]).
    pose proof (RN_sum 1 (- share) ltac:(change 1 with (bp 0); apply F_bp; lia) (F_opp _ (RN_F _))) as E.
    change (1 + - share) with (1 - share) in E. apply Rnot_lt_le. intro C. destruct (Rle_or_lt 0 (1 - share)) as
      [Z|Z].
    - rewrite (Rabs_pos_eq (1 - share)) in E by lra. apply Rabs_le_inv in E. rewrite u_val in *. lra.
    - assert (RN (1 - share) <= 0) by (rewrite <- RN_0; apply RN_le; lra). lra. }
  (* so the difference over the distance *)
  set (x := RN (h * inverse)) in *.
  assert (X : Rabs x <= / 2 - / 2100200).
  { pose proof (RN_sum (/ 2) x ltac:(replace (/ 2) with (bp (-1)) by (simpl; lra); apply F_bp; lia) (RN_F _)) as E.
    change (RN (/ 2 + x)) with share in E. assert (A : Rabs (/ 2 + x) <= 2).
    { pose proof (near_le (/ 2 + x) share (u * Rabs (/ 2 + x)) ltac:(rewrite Rabs_minus_sym; exact E)) as N.
      rewrite (Rabs_pos_eq share) in N by lra. pose proof (Rabs_pos (/ 2 + x)). rewrite u_val in *. lra. }
    assert (u * Rabs (/ 2 + x) <= u * 2) by (apply Rmult_le_compat_l; lra). apply Rabs_le_inv in E. apply Rabs_le.
    rewrite u_val in *. lra. }
  pose proof (RN_back (h * inverse)) as E1. fold x in E1.
  assert (T : bp (-1075) <= / 1000000000000) by (apply Rle_trans with (bp (-40)); [apply bp_le; lia | simpl; lra]).
  assert (Y : Rabs (h * inverse) <= / 2 - / 2100300).
  { pose proof (near_le (h * inverse) x (u * Rabs x + bp (-1075)) ltac:(rewrite Rabs_minus_sym; exact E1)).
    pose proof (Rabs_pos x). assert (T2 : bp (-1075) <= / 1000000000000000000) by (apply Rle_trans with (bp (-60));
      [apply bp_le; lia | simpl; lra]). rewrite u_val in *. lra. }
  (* inverse, h and the difference of the radii *)
  pose proof (RN_err (/ q)) as E2. fold inverse in E2. assert (iq : 0 < / q) by now apply Rinv_0_lt_compat.
  rewrite (Rabs_pos_eq (/ q)) in E2 by lra.
  assert (T3 : bp (-1075) <= u * / q).
  { assert (q <= bp 202).
    { assert (bp 202 = 4 * bp 200) by (change 202%Z with (2 + 200)%Z; rewrite bp_add; simpl (bp 2); lra).
      pose proof (bp_pos 200). apply Rabs_le_inv in Hq. rewrite u_val in *. lra. }
    apply Rle_trans with (u * bp (-202)); [unfold u; rewrite <- bp_add; apply bp_le; lia|]. apply
      Rmult_le_compat_l; [lra|].
    change (-202)%Z with (Z.opp 202). rewrite bpow_opp. apply Rinv_le_contravar; assumption. }
  assert (I : (1 - 2 * u) * / q <= inverse) by (apply Rabs_le_inv in E2; lra).
  assert (I2 : Rabs h * ((1 - 2 * u) * / q) <= / 2 - / 2100300).
  { apply Rle_trans with (2 := Y). rewrite Rabs_mult. apply Rmult_le_compat_l; [apply Rabs_pos|].
    eapply Rle_trans; [exact I | apply Rle_abs]. }
  assert (H3 : Rabs h * (1 - 2 * u) <= (/ 2 - / 2100300) * q).
  { apply Rmult_le_reg_r with (/ q); [assumption|]. replace ((/ 2 - / 2100300) * q * / q) with (/ 2 - / 2100300) by
    (field;
      lra). replace (Rabs h * (1 - 2 * u) * / q) with (Rabs h * ((1 - 2 * u) * / q)) by ring. exact I2. }
  pose proof (RN_diff s r Fs Fr) as E3. fold p4 in E3.
  pose proof (Frame.scaled p4 (-1) (RN_F _)) as E4. replace (bp (-1)) with (/ 2) in E4 by (simpl; lra). fold h in E4.
  assert (T4 : bp (-1075) <= / 1000000000000 * L).
  { apply Rle_trans with (bp (-40 + -200)); [apply bp_le; lia|]. rewrite bp_add. assert (bp (-40) <= /
    1000000000000) by
      (simpl; lra). pose proof (bp_pos (-40)). apply Rmult_le_compat; lra. }
  assert (D : Rabs (s - r) <= (1 - / 1050200) * L).
  { pose proof (near_le (s - r) p4 (u * Rabs (s - r)) ltac:(rewrite Rabs_minus_sym; exact E3)) as N1.
    pose proof (near_le (p4 * / 2) h (bp (-1075)) ltac:(rewrite Rabs_minus_sym; exact E4)) as N2.
    rewrite Rabs_mult, (Rabs_pos_eq (/ 2)) in N2 by lra. pose proof (Rabs_pos (s - r)). pose proof (Rabs_pos h).
    apply Rabs_le_inv in Hq. clear - N1 N2 H3 H H0 T4 Hq LP. rewrite u_val in *. lra. }
  apply Rabs_le_inv in D. rewrite B22. unfold k. split.
  - apply Rmult_le_reg_r with (2 * L); [lra|]. replace ((L + s - r) / (2 * L) * (2 * L)) with (L + s - r) by
    (field; lra). lra.
  - apply Rmult_le_reg_r with (2 * L); [lra|]. replace ((L + s - r) / (2 * L) * (2 * L)) with (L + s - r) by
    (field; lra). lra.
Qed.

Let n := Rmin (k * L) ((1 - k) * L).
Lemma L_0 : 0 < L. Proof. pose proof (bp_pos (-200)). lra. Qed.
Let th := Rabs ((s - r) * / L).
Lemma th_1 : 0 <= th <= 1 /\ th * L = Rabs (s - r).
Proof.
  pose proof L_0 as LP. pose proof inside_k as K. pose proof (bp_pos (-22)).
  assert (E : (s - r) * / L = 2 * k - 1) by (unfold k; field; lra). split.
  - split; [apply Rabs_pos|]. unfold th. rewrite E. apply Rabs_le. lra.
  - unfold th. rewrite <- (Rabs_pos_eq L) at 2 by lra. rewrite <- Rabs_mult. f_equal. field. lra.
Qed.
Lemma share_k : Rabs (k - share) <= (51 / 100) * u + (352 / 100) * u * th /\ Rabs (/ 2 - share) <= th * / 2 + 5 * u /\
  bp (-23) <= share <= 1.
Proof. exact (share_near L q rest r s Fr Fs L0 L1 HL Hrest Hq inside_k). Qed.
Lemma nearest_near : Rabs (nearest - n) <= / 1000 * n.
Proof.
  pose proof L_0 as LP. pose proof inside_k as K. destruct share_k as (KS & _ & [S0 S1]). destruct th_1 as [TH _].
  pose proof u_pos as U. assert (B22 : bp (-22) = / 4194304) by (simpl; lra). rewrite B22 in K. pose proof (bp_pos
    (-23)) as B23.
  set (mk := Rmin k (1 - k)). set (m := Rmin share (RN (1 - share))) in *.
  assert (NE : n = mk * L).
  { unfold n, mk, Rmin. repeat destruct Rle_dec; try reflexivity; exfalso.
    - apply Rmult_le_reg_r in r0; lra.
    - apply n0. apply Rmult_le_compat_r; lra. }
  assert (MK : / 4194304 <= mk <= 1) by (unfold mk, Rmin; destruct Rle_dec; lra).
  assert (A1 : Rabs (share - k) <= 5 * u) by (rewrite Rabs_minus_sym; clear - KS TH U; clearbody th; rewrite u_val
    in *; lra).
  assert (A2 : Rabs (RN (1 - share) - (1 - k)) <= 7 * u).
  { pose proof (RN_sum 1 (- share) ltac:(change 1 with (bp 0); apply F_bp; lia) (F_opp _ (RN_F _))) as E.
    change (1 + - share) with (1 - share) in E. rewrite (Rabs_pos_eq (1 - share)) in E by lra.
    apply Rabs_le_inv in E. apply Rabs_le_inv in A1. assert (u * (1 - share) <= u * 1) by (apply Rmult_le_compat_l;
      lra).
    apply Rabs_le. lra. }
  assert (M : Rabs (m - mk) <= 7 * u).
  { apply Rabs_le_inv in A1. apply Rabs_le_inv in A2. unfold m, mk, Rmin. repeat destruct Rle_dec; apply Rabs_le;
    lra. }
  assert (m0 : 0 <= m <= 2) by (apply Rabs_le_inv in M; rewrite u_val in *; lra).
  assert (P : Rabs (q * m - mk * L) <= 15 * (u * L)).
  { replace (q * m - mk * L) with ((q - L) * m + L * (m - mk)) by ring. eapply Rle_trans; [apply Rabs_triang|].
    assert (Rabs ((q - L) * m) <= 4 * u * L * 2) by (apply product_le; [assumption | rewrite Rabs_pos_eq; lra]).
    assert (Rabs (L * (m - mk)) <= L * (7 * u)) by (apply product_le; [rewrite Rabs_pos_eq; lra | assumption]). lra. }
  assert (Q : u * L <= / 1000000000 * (mk * L)).
  { rewrite <- Rmult_assoc. apply Rmult_le_compat_r; [lra|]. rewrite u_val. lra. }
  pose proof (RN_err (q * m)) as E. change (RN (q * m)) with nearest in E.
  assert (T : bp (-1075) <= u * L).
  { apply Rle_trans with (u * bp (-200)); [unfold u; rewrite <- bp_add; apply bp_le; lia | apply Rmult_le_compat_l;
    lra]. }
  rewrite NE. set (x := mk * L) in *. assert (x0 : 0 <= x) by (apply Rmult_le_pos; lra).
  assert (PA : Rabs (q * m) <= x + 15 * (u * L)) by (pose proof (near_le _ _ _ P) as N; rewrite (Rabs_pos_eq x) in
    N; lra).
  replace (nearest - x) with ((nearest - q * m) + (q * m - x)) by ring. eapply Rle_trans; [apply Rabs_triang|].
  assert (u * Rabs (q * m) <= / 1000000 * Rabs (q * m)) by (apply Rmult_le_compat_r; [apply Rabs_pos | rewrite
    u_val; lra]).
  lra.
Qed.

(* the center *)
Let p1 := RN (b1 - a1). Let p2 := RN (b2 - a2). Let p3 := RN (b3 - a3).
Let l1 := two_sum_error b1 (- a1). Let l2 := two_sum_error b2 (- a2). Let l3 := two_sum_error b3 (- a3).
Let w1 := RN (p1 * share). Let w2 := RN (p2 * share). Let w3 := RN (p3 * share).
Hypotheses (Hm1 : Rabs (w1 + m1 - p1 * share) <= bp (-1071)) (Hm2 : Rabs (w2 + m2 - p2 * share) <= bp (-1071))
  (Hm3 : Rabs (w3 + m3 - p3 * share) <= bp (-1071)).
Let c1 := RN (a1 + w1). Let c2 := RN (a2 + w2). Let c3 := RN (a3 + w3).
Let d1 := RN (two_sum_error a1 w1 + RN (m1 + RN (RN (p1 * share_low) + RN (l1 * share)))).
Let d2 := RN (two_sum_error a2 w2 + RN (m2 + RN (RN (p2 * share_low) + RN (l2 * share)))).
Let d3 := RN (two_sum_error a3 w3 + RN (m3 + RN (RN (p3 * share_low) + RN (l3 * share)))).
Let z1 := RN (c1 + d1). Let z2 := RN (c2 + d2). Let z3 := RN (c3 + d3).
Let e1 := RN (RN (z1 - c1) - d1). Let e2 := RN (RN (z2 - c2) - d2). Let e3 := RN (RN (z3 - c3) - d3).
Let g1 := z1 - (a1 + k * v1) - e1. Let g2 := z2 - (a2 + k * v2) - e2. Let g3 := z3 - (a3 + k * v3) - e3.
Let size := RN (RN (Rabs z1 + Rabs z2) + Rabs z3).
Let t := 200 * bp (-1071).
Let A := (u * u) * ((126 / 10) + (814 / 10) * th).
Let B := (41 / 10) * (u * u).
Lemma axes : Rabs g1 <= A * Rabs v1 + (B * Rabs z1 + t) /\ Rabs g2 <= A * Rabs v2 + (B * Rabs z2 + t) /\
  Rabs g3 <= A * Rabs v3 + (B * Rabs z3 + t).
Proof.
  destruct share_k as (KS & HS & _). destruct th_1 as [TH _].
  pose proof (share_low_near L q rest r s Fq Fr Fs L0 L1 HL Hrest Hq inside_k part_low Hpart) as SL.
  repeat split.
  - pose proof (center_near a1 b1 k th share share_low m1 Fa1 Fb1 TH HS KS SL Hm1) as C.
    replace (A * Rabs v1 + (B * Rabs z1 + t)) with (u * u * (126 / 10 * Rabs v1 + 814 / 10 * (th * Rabs v1)) + 41 /
      10 * (u *
      u) * Rabs z1 + 200 * bp (-1071)) by (unfold A, B, t; ring). exact C.
  - pose proof (center_near a2 b2 k th share share_low m2 Fa2 Fb2 TH HS KS SL Hm2) as C.
    replace (A * Rabs v2 + (B * Rabs z2 + t)) with (u * u * (126 / 10 * Rabs v2 + 814 / 10 * (th * Rabs v2)) + 41 /
      10 * (u *
      u) * Rabs z2 + 200 * bp (-1071)) by (unfold A, B, t; ring). exact C.
  - pose proof (center_near a3 b3 k th share share_low m3 Fa3 Fb3 TH HS KS SL Hm3) as C.
    replace (A * Rabs v3 + (B * Rabs z3 + t)) with (u * u * (126 / 10 * Rabs v3 + 814 / 10 * (th * Rabs v3)) + 41 /
      10 * (u *
      u) * Rabs z3 + 200 * bp (-1071)) by (unfold A, B, t; ring). exact C.
Qed.
Lemma sizes : Rabs z1 + Rabs z2 + Rabs z3 <= (1 + 4 * u) * size /\ 0 <= size.
Proof.
  pose proof u_pos as U. assert (Fz : forall x, F (Rabs (RN x))) by (intro x; apply generic_format_abs, RN_F).
  pose proof (Rabs_pos z1). pose proof (Rabs_pos z2). pose proof (Rabs_pos z3).
  pose proof (RN_sum _ _ (Fz (c1 + d1)) (Fz (c2 + d2))) as E1. fold z1 z2 in E1. set (j := RN (Rabs z1 + Rabs z2))
    in *.
  rewrite (Rabs_pos_eq (Rabs z1 + Rabs z2)) in E1 by lra. assert (j0 : 0 <= j) by (unfold j; rewrite <- RN_0; apply
    RN_le;
    lra). pose proof (RN_sum j _ (RN_F _) (Fz (c3 + d3))) as E2. fold z3 in E2. fold size in E2.
  rewrite (Rabs_pos_eq (j + Rabs z3)) in E2 by lra. assert (s0 : 0 <= size) by (unfold size; rewrite <- RN_0; apply
    RN_le;
    fold j; lra). split; [|assumption]. apply Rabs_le_inv in E1. apply Rabs_le_inv in E2. rewrite u_val in *. lra.
Qed.
Lemma small : 0 <= A /\ 0 <= B /\ 0 <= t /\ A * L <= 95 * (u * (u * L)) /\ 3 * t <= / 1000 * (u * (u * L)) /\
  A * L <= 36 * (u * (u * L)) + 59 * (u * (u * Rabs (s - r))) - / 10 * (u * (u * L)).
Proof.
  destruct th_1 as [TH TL]. pose proof u_pos as U. pose proof L_0 as LP. assert (UU : 0 < u * u) by now apply
    Rmult_lt_0_compat.
  assert (UL : 0 < u * (u * L)) by (apply Rmult_lt_0_compat; [lra | now apply Rmult_lt_0_compat]).
  assert (Q : A * L = (126 / 10) * (u * (u * L)) + (814 / 10) * (u * (u * (th * L)))) by (unfold A; ring).
  assert (TU : u * (u * (th * L)) <= u * (u * L)).
  { apply Rmult_le_compat_l; [lra|]. apply Rmult_le_compat_l; [lra|]. rewrite <- (Rmult_1_l L) at 2. apply
    Rmult_le_compat_r;
      lra. }
  split; [unfold A; apply Rmult_le_pos; lra|]. split; [unfold B; lra|]. split; [unfold t; pose proof (bp_pos
    (-1071)); lra|].
  split; [lra|]. split; [|rewrite <- TL; lra].
  apply Rle_trans with (bp (-20 + (-53 + (-53 + -200)))).
  - unfold t. assert (200 * bp (-1071) <= bp (8 + -1071)) by (rewrite bp_add; pose proof (bp_pos (-1071)); simpl
    (bp 8); lra).
    assert (4 * bp (8 + -1071) = bp (2 + (8 + -1071))) by (rewrite (bp_add 2); simpl (bp 2); lra).
    assert (bp (2 + (8 + -1071)) <= bp (-20 + (-53 + (-53 + -200)))) by (apply bp_le; lia).
    pose proof (bp_pos (8 + -1071)). lra.
  - rewrite !bp_add. fold u. assert (u * (u * bp (-200)) <= u * (u * L)) by (apply Rmult_le_compat_l; [lra|]; apply
      Rmult_le_compat_l; lra). assert (bp (-20) <= / 1000) by (simpl; lra). pose proof (bp_pos (-20)).
    pose proof (bp_pos (-200)). apply Rmult_le_compat; try lra. apply Rmult_le_pos; [lra | apply Rmult_le_pos; lra].
Qed.
(* How far along the way the center is off, and how far in all: what Pair.v takes for granted. *)
Theorem center_along : Rabs (v1 * g1 + v2 * g2 + v3 * g3) / L <=
  36 * (u * (u * L)) + 59 * (u * (u * Rabs (s - r))) + 15 * (u * (u * size)).
Proof.
  destruct axes as (G1 & G2 & G3). destruct sizes as [SZ S0]. destruct small as (A0 & B0 & t0 & _ & T3 & AL).
  pose proof L_0 as LP. pose proof u_pos as U.
  destruct (part_le v1 v2 v3) as (V1 & V2 & V3). rewrite <- HLv in V1, V2, V3.
  pose proof (Rabs_pos v1) as P1. pose proof (Rabs_pos v2) as P2. pose proof (Rabs_pos v3) as P3.
  pose proof (norm_sq v1 v2 v3) as VV. rewrite <- HLv in VV.
  assert (One : forall v g z, Rabs v <= L -> Rabs g <= A * Rabs v + (B * Rabs z + t) ->
    Rabs (v * g) <= A * (v * v) + L * (B * Rabs z + t)).
  { intros v g z H1 H2. rewrite Rabs_mult. pose proof (Rabs_pos v). pose proof (Rabs_pos z).
    assert (0 <= B * Rabs z + t) by (pose proof (Rmult_le_pos _ _ B0 H0); lra).
    apply Rle_trans with (Rabs v * (A * Rabs v + (B * Rabs z + t))); [apply Rmult_le_compat_l; lra|].
    rewrite Rmult_plus_distr_l. rewrite <- (abs_sq v).
    assert (Rabs v * (B * Rabs z + t) <= L * (B * Rabs z + t)) by (apply Rmult_le_compat_r; lra). lra. }
  pose proof (One _ _ _ V1 G1) as O1. pose proof (One _ _ _ V2 G2) as O2. pose proof (One _ _ _ V3 G3) as O3.
  assert (D : Rabs (v1 * g1 + v2 * g2 + v3 * g3) <= (A * L + (B * (Rabs z1 + Rabs z2 + Rabs z3) + 3 * t)) * L).
  { eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
    replace ((A * L + (B * (Rabs z1 + Rabs z2 + Rabs z3) + 3 * t)) * L) with (A * (L * L) + L * (B * (Rabs z1 +
      Rabs z2 + Rabs
      z3) + 3 * t)) by ring. rewrite VV. lra. }
  assert (BS : B * (Rabs z1 + Rabs z2 + Rabs z3) <= 5 * (u * (u * size))).
  { apply Rle_trans with (B * ((1 + 4 * u) * size)); [apply Rmult_le_compat_l; lra|]. unfold B.
    assert (0 <= u * (u * size)) by (apply Rmult_le_pos; [lra | apply Rmult_le_pos; lra]).
    replace (41 / 10 * (u * u) * ((1 + 4 * u) * size)) with (41 / 10 * (1 + 4 * u) * (u * (u * size))) by ring.
    apply Rmult_le_compat_r; [assumption | rewrite u_val; lra]. }
  assert (0 <= u * (u * size)) by (apply Rmult_le_pos; [lra | apply Rmult_le_pos; lra]).
  assert (UL : 0 < u * (u * L)) by (apply Rmult_lt_0_compat; [lra | now apply Rmult_lt_0_compat]).
  apply Rmult_le_reg_r with L; [assumption|]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra.
  apply Rle_trans with (1 := D). apply Rmult_le_compat_r; [lra|]. lra.
Qed.
Theorem center_length : norm g1 g2 g3 <= 1000 * (u * (u * ((L + r + s) / 2))) + 5 * (u * (u * size)).
Proof.
  destruct axes as (G1 & G2 & G3). destruct sizes as [SZ S0]. destruct small as (A0 & B0 & t0 & AL & T3 & _).
  pose proof L_0 as LP. pose proof u_pos as U.
  pose proof (norm_monotone _ _ _ _ _ _ G1 G2 G3) as M.
  pose proof (norm_triangle (A * Rabs v1) (A * Rabs v2) (A * Rabs v3) (B * Rabs z1 + t) (B * Rabs z2 + t) (B * Rabs
    z3 + t))
    as T. rewrite norm_scaled, norm_abs, <- HLv, (Rabs_pos_eq A) in T by assumption.
  pose proof (norm_le_sum (B * Rabs z1 + t) (B * Rabs z2 + t) (B * Rabs z3 + t)) as S.
  assert (P : forall z, 0 <= B * Rabs z + t) by (intro z; pose proof (Rmult_le_pos _ _ B0 (Rabs_pos z)); lra).
  rewrite !(Rabs_pos_eq (_ + t)) in S by apply P.
  assert (BS : B * (Rabs z1 + Rabs z2 + Rabs z3) <= 5 * (u * (u * size))).
  { apply Rle_trans with (B * ((1 + 4 * u) * size)); [apply Rmult_le_compat_l; lra|]. unfold B.
    assert (0 <= u * (u * size)) by (apply Rmult_le_pos; [lra | apply Rmult_le_pos; lra]).
    replace (41 / 10 * (u * u) * ((1 + 4 * u) * size)) with (41 / 10 * (1 + 4 * u) * (u * (u * size))) by ring.
    apply Rmult_le_compat_r; [assumption | rewrite u_val; lra]. }
  assert (LM : u * (u * L) <= 2 * (u * (u * ((L + r + s) / 2)))).
  { replace (2 * (u * (u * ((L + r + s) / 2)))) with (u * (u * (L + r + s))) by field. apply Rmult_le_compat_l;
    [lra|].
    apply Rmult_le_compat_l; lra. }
  assert (UL : 0 < u * (u * L)) by (apply Rmult_lt_0_compat; [lra | now apply Rmult_lt_0_compat]). lra.
Qed.

(* The bracket that `pair` gives, from the doubles of the spheres and of their distance on. *)
Variable dot : R.
Hypotheses (B1 : Rabs e1 <= bp 300) (B2 : Rabs e2 <= bp 300) (B3 : Rabs e3 <= bp 300) (B4 : Rabs p1 <= bp 300)
  (B5 : Rabs p2 <= bp 300) (B6 : Rabs p3 <= bp 300)
  (Hdot : plain (tdot (X e1 300) (X e2 300) (X e3 300) (X p1 300) (X p2 300) (X p3 300)) dot).
Let radii := RN (r + s). Let twice_low := two_sum_error q radii.
Let low := RN (RN (twice_low + RN (two_sum_error r s + rest)) * / 2).
Let along := RN (Rabs dot * inverse).
Let away := RN (RN (Rabs e1 + Rabs e2) + Rabs e3).
Let bent := RN (RN (away * away) / nearest).
Let error := RN (RN (RN (radius * REACH_ERROR) + bent) + RN (AWAY_ERROR * RN (away + RN (u * size)))).
Hypothesis Hpair : error <= radius * PAIR_ERROR.
Theorem pair_bracketed : let reach := Rmax (norm (z1 - a1) (z2 - a2) (z3 - a3) + r) (norm (z1 - b1) (z2 - b2) (z3 -
  b3) + s) in
  let l := RN (low + along) in
  reach <= summed_up radius (RN (l + error)) /\ forall R, F R -> reach <= R -> summed_up radius (RN (l - error)) <= R.
Proof.
  assert (I : Rabs (inverse * L - 1) <= 6 * u).
  { destruct (distance L q rest L0 L1 HL Hrest Hq) as (_ & _ & _ & DI). pose proof u_pos. unfold inverse. lra. }
  destruct sizes as [_ S0].
  assert (P : forall b a, F b -> F a -> Rabs (RN (b - a) - (b - a)) <= u * Rabs (b - a)) by (intros; now apply
    RN_diff).
  pose proof (AWAY_ERROR_holds L q rest r s Fq Fr Fs Hr Hs L0 HL Hrest Hq v1 v2 v3 e1 e2 e3 g1 g2 g3 HLv p1 p2 p3
    dot inverse
    nearest size (P _ _ Fb1 Fa1) (P _ _ Fb2 Fa2) (P _ _ Fb3 Fa3) B1 B2 B3 B4 B5 B6 (RN_F _) (RN_F _) (RN_F _) Hdot I
    nearest_near Hinside S0 center_along center_length Hpair) as T.
  cbv zeta in T. fold k in T.
  replace (k * v1 + (e1 + g1)) with (z1 - a1) in T by (unfold g1; ring).
  replace (k * v2 + (e2 + g2)) with (z2 - a2) in T by (unfold g2; ring).
  replace (k * v3 + (e3 + g3)) with (z3 - a3) in T by (unfold g3; ring).
  replace (z1 - a1 - v1) with (z1 - b1) in T by (unfold v1; ring).
  replace (z2 - a2 - v2) with (z2 - b2) in T by (unfold v2; ring).
  replace (z3 - a3 - v3) with (z3 - b3) in T by (unfold v3; ring).
  exact T.
Qed.
End Center.
