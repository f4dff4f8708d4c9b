(* What chains of roundings share: products of bounds, a step of Newton's for a quotient and for a square root. *)
From Proofs Require Import Rounding.
Open Scope R_scope.

(* From bounds of magnitudes to a bound of a magnitude, by linear arithmetic; u as a number. *)
Ltac bounds := repeat match goal with H : Rabs _ <= _ |- _ => apply Rabs_le_inv in H end.
Ltac linear := bounds; try apply Rabs_le; rewrite ?u_val in *; lra.

Lemma Rabs_mult_le : forall x y X Y, Rabs x <= X -> Rabs y <= Y -> Rabs (x * y) <= X * Y.
Proof. intros. rewrite Rabs_mult. apply Rmult_le_compat; auto using Rabs_pos. Qed.
Lemma Rabs_div_le : forall x y b, y <> 0 -> Rabs x <= b * Rabs y -> Rabs (x / y) <= b.
Proof.
  intros x y b N H. unfold Rdiv. rewrite Rabs_mult, Rabs_inv. pose proof (Rabs_pos_lt y N).
  apply Rmult_le_reg_r with (Rabs y); [assumption|]. rewrite Rmult_assoc, Rinv_l by lra. lra.
Qed.
Lemma Rabs_plus_le : forall x y X Y, Rabs x <= X -> Rabs y <= Y -> Rabs (x + y) <= X + Y.
Proof. intros. eapply Rle_trans; [apply Rabs_triang|]. lra. Qed.
Lemma Rabs_minus_le : forall x y X Y, Rabs x <= X -> Rabs y <= Y -> Rabs (x - y) <= X + Y.
Proof. intros. unfold Rminus. apply Rabs_plus_le; [assumption | now rewrite Rabs_Ropp]. Qed.

(* A quotient n / d near x: x and k, which is a rest near n - x d times an inverse near 1 / d. *)
Lemma quotient_step : forall n d x rest inverse k er ei ek, d <> 0 ->
  Rabs (rest - (n - x * d)) <= er -> Rabs (inverse * d - 1) <= ei -> Rabs (k - rest * inverse) <= ek ->
  Rabs (x + k - n / d) <= ek + (er * (1 + ei) + Rabs (n - x * d) * ei) / Rabs d.
Proof.
  intros n d x rest inverse k er ei ek D0 H1 H2 H3. pose proof (Rabs_pos_lt d D0).
  replace (x + k - n / d) with ((k - rest * inverse) + (rest * (inverse * d) - (n - x * d)) / d) by (field; assumption).
  apply Rabs_plus_le; [assumption|]. apply Rabs_div_le; [assumption|].
  unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra. rewrite Rmult_1_r. set (r := n - x * d) in *.
  replace (rest * (inverse * d) - r) with ((rest - r) * (inverse * d) + r * (inverse * d - 1)) by ring.
  apply Rabs_plus_le; [|rewrite Rabs_mult; apply Rmult_le_compat_l; [apply Rabs_pos | assumption]].
  rewrite Rabs_mult. apply Rmult_le_compat; auto using Rabs_pos.
  replace (inverse * d) with (1 + (inverse * d - 1)) by ring. apply Rabs_plus_le; [rewrite Rabs_R1; lra | assumption].
Qed.
(* A square root near r > 0: what the step r + (v - r^2) / 2r leaves. *)
Lemma root_step : forall v r, 0 <= v -> 0 < r ->
  sqrt v - (r + (v - r * r) / (2 * r)) = - ((sqrt v - r) * (sqrt v - r) / (2 * r)).
Proof.
  intros v r V R. pose proof (sqrt_sqrt v V) as S. set (w := sqrt v) in *. rewrite <- S. field. lra.
Qed.
(* An interval that a function of its error lies in: where |x| and |y| differ by little, so do their roots. *)
Lemma root_near : forall x y, 0 < x -> 0 <= y -> Rabs (sqrt x - sqrt y) * sqrt x <= Rabs (x - y).
Proof.
  intros x y X Y. pose proof (sqrt_sqrt x ltac:(lra)) as SX. pose proof (sqrt_sqrt y Y) as SY.
  pose proof (sqrt_lt_R0 x X). pose proof (sqrt_pos y). set (a := sqrt x) in *. set (b := sqrt y) in *.
  rewrite <- SX, <- SY. replace (a * a - b * b) with ((a - b) * (a + b)) by ring. rewrite Rabs_mult.
  apply Rmult_le_compat_l; [apply Rabs_pos|]. rewrite Rabs_pos_eq; lra.
Qed.
