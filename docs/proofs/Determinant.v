(* rt-math, pseudo_inverse/regular.rs: the determinant with a running bound, and that it is not zero. *)
From Proofs Require Import Rounding ErrorFree.
From Flocq Require Import Relative.
Open Scope R_scope.

(* What the roundings of the bound itself are covered by. *)
Definition BOUND_FACTOR := 9 / 8.
(* Where the determinant is proved not to be zero. *)
Definition TAU_LIMIT := bp (-19).
Definition ETA_LIMIT := 1 / 8.

(* A product of the range: zero, or normal. *)
Definition in_range x := x = 0 \/ bp (-1022) <= Rabs x.
Lemma RN_product : forall x, in_range x -> Rabs (x - RN x) <= u * Rabs (RN x).
Proof.
  intros x [Z|N].
  - rewrite Z, RN_0. replace (0 - 0) with 0 by ring. rewrite Rabs_R0. lra.
  - rewrite Rabs_minus_sym. pose proof (relative_error_N_FLT_round radix2 (-1074) 53 prec53 even x) as P.
    change (round radix2 (FLT_exp (-1074) 53) (Znearest even) x) with (RN x) in P.
    eapply Rle_trans; [apply P; exact N|]. apply Rmult_le_compat_r; [apply Rabs_pos|]. unfold u. simpl. lra.
Qed.
Lemma RN_plus : forall x y, F x -> F y -> Rabs (x + y - RN (x + y)) <= u * Rabs (RN (x + y)).
Proof.
  intros x y Fx Fy. destruct (two_sum_error_le x y Fx Fy) as [_ E]. pose proof (two_sum x y Fx Fy) as T.
  replace (x + y - RN (x + y)) with (two_sum_error x y) by lra. exact E.
Qed.

Section Determinant.
(* the first row, its cofactors, and these as h + l within u (|t| + |l|) *)
Variables a0 a1 a2 c0 c1 c2 h0 h1 h2 l0 l1 l2 t0 t1 t2 : R.
Hypotheses (C0 : Rabs (c0 - (h0 + l0)) <= u * (Rabs t0 + Rabs l0)) (C1 : Rabs (c1 - (h1 + l1)) <= u * (Rabs t1 + Rabs
  l1))
  (C2 : Rabs (c2 - (h2 + l2)) <= u * (Rabs t2 + Rabs l2)).
Let D := a0 * c0 + a1 * c1 + a2 * c2.
(* a_i h_i = p_i + w_i, and s + e1 + e2 = p_0 + p_1 + p_2, exactly *)
Variables p0 p1 p2 w0 w1 w2 s e1 e2 : R.
Hypotheses (P0 : a0 * h0 = p0 + w0) (P1 : a1 * h1 = p1 + w1) (P2 : a2 * h2 = p2 + w2) (PS : s + e1 + e2 = p0 + p1 + p2)
  (Fw0 : F w0) (Fw1 : F w1) (Fw2 : F w2) (Fe1 : F e1) (Fe2 : F e2)
  (R0 : in_range (a0 * l0)) (R1 : in_range (a1 * l1)) (R2 : in_range (a2 * l2)).
Let v0 := RN (a0 * l0). Let v1 := RN (a1 * l1). Let v2 := RN (a2 * l2).
Let x0 := RN (w0 + v0). Let x1 := RN (w1 + v1). Let x2 := RN (w2 + v2).
Let y0 := RN (x0 + x1). Let y1 := RN (y0 + x2). Let y2 := RN (e1 + e2).
Let low := RN (y1 + y2).
Let size := Rabs a0 * (Rabs t0 + Rabs l0) + Rabs a1 * (Rabs t1 + Rabs l1) + Rabs a2 * (Rabs t2 + Rabs l2)
  + (Rabs v0 + Rabs v1 + Rabs v2) + (Rabs x0 + Rabs x1 + Rabs x2) + (Rabs y0 + Rabs y1 + Rabs y2) + Rabs low.

Lemma running : Rabs (D - (s + low)) <= u * size.
Proof.
  assert (M : forall a c h l t, Rabs (c - (h + l)) <= u * (Rabs t + Rabs l) ->
    Rabs (a * (c - (h + l))) <= u * (Rabs a * (Rabs t + Rabs l))).
  { intros a c h l t H. rewrite Rabs_mult. replace (u * (Rabs a * (Rabs t + Rabs l))) with (Rabs a * (u * (Rabs t +
    Rabs l))) by ring.
    apply Rmult_le_compat_l; [apply Rabs_pos | assumption]. }
  pose proof (M a0 _ _ _ _ C0) as A0. pose proof (M a1 _ _ _ _ C1) as A1. pose proof (M a2 _ _ _ _ C2) as A2.
  pose proof (RN_product _ R0) as V0. fold v0 in V0. pose proof (RN_product _ R1) as V1. fold v1 in V1.
  pose proof (RN_product _ R2) as V2. fold v2 in V2.
  pose proof (RN_plus w0 v0 Fw0 (RN_F _)) as X0'. fold x0 in X0'. pose proof (RN_plus w1 v1 Fw1 (RN_F _)) as X1'.
  fold x1 in X1'.
  pose proof (RN_plus w2 v2 Fw2 (RN_F _)) as X2'. fold x2 in X2'.
  pose proof (RN_plus x0 x1 (RN_F _) (RN_F _)) as Y0'. fold y0 in Y0'.
  pose proof (RN_plus y0 x2 (RN_F _) (RN_F _)) as Y1'. fold y1 in Y1'.
  pose proof (RN_plus e1 e2 Fe1 Fe2) as Y2'. fold y2 in Y2'. pose proof (RN_plus y1 y2 (RN_F _) (RN_F _)) as L'.
  fold low in L'.
  replace (D - (s + low)) with (a0 * (c0 - (h0 + l0)) + a1 * (c1 - (h1 + l1)) + a2 * (c2 - (h2 + l2))
    + (a0 * l0 - v0) + (a1 * l1 - v1) + (a2 * l2 - v2) + (w0 + v0 - x0) + (w1 + v1 - x1) + (w2 + v2 - x2)
    + (x0 + x1 - y0) + (y0 + x2 - y1) + (e1 + e2 - y2) + (y1 + y2 - low)) by (unfold D; lra).
  apply Rabs_le_inv in A0. apply Rabs_le_inv in A1. apply Rabs_le_inv in A2. apply Rabs_le_inv in V0.
  apply Rabs_le_inv in V1.
  apply Rabs_le_inv in V2. apply Rabs_le_inv in X0'. apply Rabs_le_inv in X1'. apply Rabs_le_inv in X2'.
  apply Rabs_le_inv in Y0'.
  apply Rabs_le_inv in Y1'. apply Rabs_le_inv in Y2'. apply Rabs_le_inv in L'.
  unfold size. clear - A0 A1 A2 V0 V1 V2 X0' X1' X2' Y0' Y1' Y2' L'. apply Rabs_le. lra.
Qed.

(* The bound, a sum of terms that are not negative, through at most 32 roundings. *)
Theorem BOUND_FACTOR_holds : forall bound, (1 - 32 * u) * (BOUND_FACTOR * u * size) <= bound -> Rabs (D - (s + low))
  <= bound.
Proof.
  intros bound H. pose proof running as Q. assert (0 <= size) by (unfold size; pose proof u_pos; abs_pos;
    repeat apply Rplus_le_le_0_compat; try (apply Rmult_le_pos; [apply Rabs_pos | lra]); lra).
  eapply Rle_trans; [exact Q|]. eapply Rle_trans; [|exact H]. unfold BOUND_FACTOR.
  replace ((1 - 32 * u) * (9 / 8 * u * size)) with ((1 - 32 * u) * (9 / 8) * (u * size)) by ring.
  pose proof u_pos. assert (0 <= u * size) by (apply Rmult_le_pos; lra).
  apply Rle_trans with (1 * (u * size)); [lra|]. apply Rmult_le_compat_r; [assumption | rewrite u_val; lra].
Qed.
End Determinant.

(* If tau and eta_0 are below their limits, the determinant is not zero. *)
Theorem TAU_LIMIT_holds : forall D s low bound, s <> 0 -> Rabs s <= bp 400 ->
  Rabs (D - (s + low)) <= bound ->
  let r := RN (1 / s) in
  forall rho, rho = 1 - r * s ->
  Rabs (RN (rho - RN (low * r))) < TAU_LIMIT -> RN (bound * Rabs r) < ETA_LIMIT -> D <> 0.
Proof.
  intros D s low bound S0 ST HD r rho Hrho HT HE D0. subst D.
  pose proof (RN_err (1 / s)) as Er. fold r in Er.
  assert (PS : 0 < Rabs s) by now apply Rabs_pos_lt.
  assert (Rho : Rabs rho <= 2 * u).
  { subst rho. replace (1 - r * s) with (- ((r - 1 / s) * s)) by (field; assumption). rewrite Rabs_Ropp, Rabs_mult.
    apply Rle_trans with ((u * Rabs (1 / s) + bp (-1075)) * Rabs s); [apply Rmult_le_compat_r; lra|].
    assert (Rabs (1 / s) * Rabs s = 1) by (rewrite <- Rabs_mult; replace (1 / s * s) with 1 by (field; assumption);
      apply Rabs_R1).
    assert (bp (-1075) * Rabs s <= u).
    { apply Rle_trans with (bp (-1075) * bp 400); [apply Rmult_le_compat_l; [apply Rlt_le, bp_pos | assumption]|].
      unfold u. rewrite <- bp_add. apply bp_le. lia. }
    replace ((u * Rabs (1 / s) + bp (-1075)) * Rabs s) with (u * (Rabs (1 / s) * Rabs s) + bp (-1075) * Rabs s) by
      ring. rewrite H. lra. }
  pose proof (RN_back (rho - RN (low * r))) as E1. pose proof (RN_back (low * r)) as E2.
  pose proof (RN_back (bound * Rabs r)) as E3.
  set (tau := RN (rho - RN (low * r))) in *. set (lr := RN (low * r)) in *. set (eta := RN (bound * Rabs r)) in *.
  assert (T : bp (-1075) <= u) by (unfold u; apply bp_le; lia).
  assert (B0 : 0 <= bound) by (pose proof (Rabs_pos (0 - (s + low))); lra).
  assert (E0 : 0 <= eta).
  { unfold eta. rewrite <- RN_0. apply RN_le. apply Rmult_le_pos; [assumption | apply Rabs_pos]. }
  rewrite (Rabs_pos_eq eta) in E3 by assumption. apply Rabs_le_inv in E3.
  assert (G : Rabs ((s + low) * r) <= bound * Rabs r).
  { rewrite Rabs_mult. apply Rmult_le_compat_r; [apply Rabs_pos|]. replace (s + low) with (- (0 - (s + low))) by ring.
    now rewrite Rabs_Ropp. }
  replace ((s + low) * r) with (1 - rho + low * r) in G by (subst rho; ring).
  assert (TV : TAU_LIMIT = / 524288) by (unfold TAU_LIMIT; simpl; lra). unfold ETA_LIMIT in HE. rewrite TV in HT.
  assert (HT' : Rabs tau <= / 524288) by lra. clear HT.
  assert (X1 : Rabs (tau - (rho - lr)) <= 2 * u) by (rewrite u_val in *; lra).
  apply Rabs_le_inv in X1. apply Rabs_le_inv in HT'. apply Rabs_le_inv in Rho.
  assert (LR : Rabs lr <= / 500000) by (apply Rabs_le; rewrite u_val in *; lra).
  assert (X2 : Rabs (lr - low * r) <= 2 * u) by (rewrite u_val in *; lra).
  apply Rabs_le_inv in X2. apply Rabs_le_inv in G. rewrite u_val in *. lra.
Qed.
Theorem ETA_LIMIT_holds : forall D s low bound, s <> 0 -> Rabs s <= bp 400 -> Rabs (D - (s + low)) <= bound ->
  let r := RN (1 / s) in
  Rabs (RN (1 - r * s - RN (low * r))) < TAU_LIMIT -> RN (bound * Rabs r) < ETA_LIMIT -> D <> 0.
Proof. intros. now apply (TAU_LIMIT_holds D s low bound H H0 H1 (1 - RN (1 / s) * s) eq_refl). Qed.
