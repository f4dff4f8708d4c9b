(* Lengths of vectors in real numbers. *)
From Proofs Require Import Rounding.
Open Scope R_scope.

Definition norm x y z := sqrt (x * x + y * y + z * z).
Lemma norm_arg : forall x y z, 0 <= x * x + y * y + z * z.
Proof. intros. pose proof (sq_pos x). pose proof (sq_pos y). pose proof (sq_pos z). lra. Qed.
Lemma norm_pos : forall x y z, 0 <= norm x y z. Proof. intros. apply sqrt_pos. Qed.
Lemma norm_sq : forall x y z, norm x y z * norm x y z = x * x + y * y + z * z.
Proof. intros. apply sqrt_sqrt, norm_arg. Qed.
Lemma norm_le : forall x y z k, 0 <= k -> x * x + y * y + z * z <= k * k -> norm x y z <= k.
Proof. intros. apply below_root; [assumption|]. now rewrite norm_sq. Qed.
Lemma le_norm : forall x y z k, k * k <= x * x + y * y + z * z -> k <= norm x y z.
Proof. intros. apply below_root; [apply norm_pos|]. now rewrite norm_sq. Qed.
(* Cauchy and Schwarz *)
Lemma dot_le : forall x y z a b c, Rabs (x * a + y * b + z * c) <= norm x y z * norm a b c.
Proof.
  intros. apply abs_below; [apply Rmult_le_pos; apply norm_pos|].
  replace (norm x y z * norm a b c * (norm x y z * norm a b c)) with
    (norm x y z * norm x y z * (norm a b c * norm a b c)) by ring.
  rewrite !norm_sq. apply cauchy_schwarz.
Qed.
Lemma norm_triangle : forall x y z a b c, norm (x + a) (y + b) (z + c) <= norm x y z + norm a b c.
Proof.
  intros. pose proof (norm_pos x y z). pose proof (norm_pos a b c). apply norm_le; [lra|].
  pose proof (dot_le x y z a b c) as D. apply Rabs_le_inv in D. pose proof (norm_sq x y z). pose proof (norm_sq a b c).
  nra.
Qed.
Lemma norm_scaled : forall k x y z, norm (k * x) (k * y) (k * z) = Rabs k * norm x y z.
Proof.
  intros. unfold norm. replace (k * x * (k * x) + k * y * (k * y) + k * z * (k * z)) with
    (k * k * (x * x + y * y + z * z)) by ring.
  rewrite sqrt_mult by (auto using sq_pos, norm_arg). f_equal. apply sqrt_Rsqr_abs.
Qed.
Lemma norm_opp : forall x y z, norm (- x) (- y) (- z) = norm x y z.
Proof. intros. unfold norm. f_equal. ring. Qed.
Lemma norm_monotone : forall x y z a b c, Rabs x <= a -> Rabs y <= b -> Rabs z <= c -> norm x y z <= norm a b c.
Proof.
  intros. apply norm_le; [apply norm_pos|]. rewrite norm_sq.
  assert (S : forall p q, Rabs p <= q -> p * p <= q * q) by (intros p q Hp; rewrite <- (abs_sq p);
    apply Rmult_le_compat; auto using Rabs_pos).
  pose proof (S _ _ H). pose proof (S _ _ H0). pose proof (S _ _ H1). lra.
Qed.
Lemma norm_abs : forall x y z, norm (Rabs x) (Rabs y) (Rabs z) = norm x y z.
Proof. intros. unfold norm. now rewrite !abs_sq. Qed.
Lemma part_le : forall x y z, Rabs x <= norm x y z /\ Rabs y <= norm x y z /\ Rabs z <= norm x y z.
Proof.
  intros. pose proof (sq_pos x). pose proof (sq_pos y). pose proof (sq_pos z).
  repeat split; apply abs_below; try apply norm_pos; rewrite norm_sq; lra.
Qed.
Lemma norm_le_sum : forall x y z, norm x y z <= Rabs x + Rabs y + Rabs z.
Proof.
  intros. pose proof (Rabs_pos x). pose proof (Rabs_pos y). pose proof (Rabs_pos z).
  apply norm_le; [lra|]. rewrite <- (abs_sq x), <- (abs_sq y), <- (abs_sq z). nra.
Qed.
(* Three equal bounds. *)
Lemma norm_equal : forall x y z k, 0 <= k -> Rabs x <= k -> Rabs y <= k -> Rabs z <= k ->
  norm x y z <= 17321 / 10000 * k.
Proof.
  intros. eapply Rle_trans; [apply (norm_monotone _ _ _ k k k); assumption|]. apply norm_le; [lra|]. nra.
Qed.
(* Each component off by k of itself. *)
Lemma norm_relative : forall k x y z a b c, Rabs x <= k * Rabs a -> Rabs y <= k * Rabs b -> Rabs z <= k * Rabs c ->
  0 <= k -> norm x y z <= k * norm a b c.
Proof.
  intros. eapply Rle_trans; [eapply norm_monotone; eassumption|]. rewrite norm_scaled, norm_abs, (Rabs_pos_eq k) by lra.
  lra.
Qed.
Lemma norm_difference : forall x y z a b c, norm x y z <= norm a b c + norm (x - a) (y - b) (z - c).
Proof.
  intros. replace (norm x y z) with (norm (a + (x - a)) (b + (y - b)) (c + (z - c))) by (f_equal; ring).
  apply norm_triangle.
Qed.
