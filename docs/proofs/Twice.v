(* Polynomials in double-double: the second filter of a kernel, with the bounds of DoubleDouble.v. *)
From Proofs Require Import Rounding ErrorFree DoubleDouble.
Open Scope R_scope.

(* One operation in double-double: a difference or product of doubles is exact (but for underflow), a sum costs 6 u^2,
   a product 9 u^2 and, where it underflows, 2^-1070. *)
Notation twice := (computed (u * u) 0 6 9 (-100000) (-1070)).
Notation count2 := (roundings 0 6 9).
Notation low2 := (under (-100000) (-1070)).
Lemma uu_small : 0 <= u * u <= / 1024. Proof. rewrite u_val. lra. Qed.
Lemma g_units : forall n, INR n * (u * u) <= g (u * u) n.
Proof.
  induction n; [unfold g; simpl; lra|]. rewrite S_INR. unfold g in *. simpl pow. pose proof uu_small.
  assert (1 <= (1 + u * u) ^ n) by (apply pow_R1_Rle; lra). nra.
Qed.
(* The operations of DoubleDouble.v are such. *)
Theorem twice_add : forall a b xh xl yh yl, dd xh xl -> dd yh yl -> twice a (xh + xl) -> twice b (yh + yl) ->
  let v := add_high xh xl yh yl in let w := add_low xh xl yh yl in
  twice (Add a b) (RN (v + w) + fast_two_sum_error v w).
Proof.
  intros. eapply CAdd; eauto. destruct (SUM_holds xh xl yh yl H H0) as [_ E]. fold v w in E.
  eapply Rle_trans; [exact E|]. pose proof (g_units 6) as G. replace (INR 6) with SUM in G by (unfold SUM; simpl; lra).
  pose proof (bp_pos (-100000)). pose proof (Rabs_pos (xh + xl + (yh + yl))). nra.
Qed.
Theorem twice_mul : forall a b xh xl yh yl e, dd xh xl -> dd yh yl -> F e ->
  Rabs (RN (xh * yh) + e - xh * yh) <= 4 * bp (-1074) -> twice a (xh + xl) -> twice b (yh + yl) ->
  let p := RN (xh * yh) in let w := product_low xh xl yh yl e in
  twice (Mul a b) (RN (p + w) + fast_two_sum_error p w).
Proof.
  intros. eapply CMul; eauto. destruct (product_any xh xl yh yl e H H0 H1 H2) as [_ E]. fold p w in E.
  eapply Rle_trans; [exact E|]. pose proof (g_units 9) as G. replace (INR 9) with PRODUCT in G by (unfold PRODUCT;
    simpl; lra).
  pose proof (Rabs_pos ((xh + xl) * (yh + yl))). nra.
Qed.
Theorem twice_product : forall x y q e, Rabs (RN (x * y) + e - x * y) <= 4 * bp (-1074) -> twice (XX x y q) (RN (x *
  y) + e).
Proof.
  intros. apply CP. eapply Rle_trans; [exact H|]. change (-1070)%Z with (4 + -1074)%Z. rewrite bp_add. simpl (bp 4).
  pose proof (bp_pos (-1074)). lra.
Qed.
Theorem twice_difference : forall x y q, F x -> F y -> twice (D x y q) (RN (x - y) + two_sum_error x (- y)).
Proof.
  intros. apply CD. replace (x - y) with (x + - y) by ring. rewrite two_sum by (auto using F_opp).
  replace (x + - y - (x + - y)) with 0 by ring. rewrite Rabs_R0. unfold g. simpl. pose proof (Rabs_pos (x + - y)). nra.
Qed.

(* The error of a term, with its numbers evaluated. *)
Lemma twice_error_at : forall t z k p, twice t z -> bounded t -> Z.of_nat (count2 t) = k -> low2 t = p -> (k <= 100)%Z
  ->
  Rabs (z - exact t) <= (IZR k + / 1000) * (u * u) * size t + bp p.
Proof.
  intros t z k p H B K L M. subst k p. eapply Rle_trans.
  - apply (term_error (u * u) 0 6 9 (-100000) (-1070)); auto; try apply uu_small. lia.
  - apply Rplus_le_compat_r. destruct (top_ok t B). pose proof (Rabs_pos (exact t)). apply Rmult_le_compat_r; [lra|].
    rewrite <- INR_IZR_INZ. assert (N : (count2 t <= 100)%nat) by lia. apply le_INR in N.
    replace (INR 100) with 100 in N by (simpl; lra). pose proof (pos_INR (count2 t)).
    eapply Rle_trans; [apply g_le; try apply uu_small; rewrite u_val; nra|].
    set (n := INR (count2 t)) in *. assert (n * (u * u) * (n * (u * u)) <= / 1000 * (u * u)) by (rewrite u_val; nra).
    lra.
Qed.
(* The high part of a value against a bound. *)
Lemma high_sign : forall h l x e, dd h l -> Rabs (h + l - x) <= (1 - 2 * u) * e -> (h > e -> 0 < x) /\ (h < - e -> x <
  0).
Proof.
  intros h l x e H B. pose proof (dd_low _ _ H) as L. apply Rabs_le_inv in B.
  split; intro G; [rewrite (Rabs_pos_eq h) in L | rewrite (Rabs_left h) in L]; try (apply Rabs_le_inv in L);
    rewrite u_val in *; try lra.
Qed.
