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

(* The length of a vector, and the sum of the magnitudes of its components. *)
Definition len x y z := sqrt (x * x + y * y + z * z).
Definition norm1 x y z := Rabs x + Rabs y + Rabs z.
Lemma sum_sq_pos : forall x y z, 0 <= x * x + y * y + z * z.
Proof. intros. pose proof (sq_pos x). pose proof (sq_pos y). pose proof (sq_pos z). lra. Qed.
Lemma len_pos : forall x y z, 0 <= len x y z. Proof. intros. apply sqrt_pos. Qed.
Lemma len_sq : forall x y z, len x y z * len x y z = x * x + y * y + z * z.
Proof. intros. apply sqrt_sqrt, sum_sq_pos. Qed.
Lemma len_dot : forall x y z a b c, Rabs (x * a + y * b + z * c) <= len x y z * len a b c.
Proof.
  intros. apply abs_below; [apply Rmult_le_pos; apply len_pos|].
  replace (len x y z * len a b c * (len x y z * len a b c)) with ((len x y z * len x y z) * (len a b c * len a b c)) by ring.
  rewrite !len_sq. apply cauchy_schwarz.
Qed.
Lemma norm1_pos : forall x y z, 0 <= norm1 x y z.
Proof. intros. unfold norm1. pose proof (Rabs_pos x). pose proof (Rabs_pos y). pose proof (Rabs_pos z). lra. Qed.
Lemma len_le_norm1 : forall x y z, len x y z <= norm1 x y z.
Proof.
  intros. apply below_root; [apply norm1_pos|]. rewrite len_sq. unfold norm1. pose proof (Rabs_pos x). pose proof (Rabs_pos y).
  pose proof (Rabs_pos z). rewrite <- (abs_sq x), <- (abs_sq y), <- (abs_sq z).
  pose proof (Rmult_le_pos _ _ H H0). pose proof (Rmult_le_pos _ _ H H1). pose proof (Rmult_le_pos _ _ H0 H1). lra.
Qed.
Lemma norm1_le_len : forall x y z, norm1 x y z <= 17321 / 10000 * len x y z.
Proof.
  intros. pose proof (len_pos x y z). apply below_root; [lra|].
  replace (17321 / 10000 * len x y z * (17321 / 10000 * len x y z)) with (17321 / 10000 * (17321 / 10000) * (len x y z * len x y z)) by ring.
  rewrite len_sq. unfold norm1. pose proof (sq_pos (Rabs x - Rabs y)). pose proof (sq_pos (Rabs y - Rabs z)).
  pose proof (sq_pos (Rabs z - Rabs x)). rewrite <- (abs_sq x), <- (abs_sq y), <- (abs_sq z).
  pose proof (sq_pos (Rabs x)). pose proof (sq_pos (Rabs y)). pose proof (sq_pos (Rabs z)). lra.
Qed.
Lemma len_mono : forall x y z a b c, Rabs x <= Rabs a -> Rabs y <= Rabs b -> Rabs z <= Rabs c -> len x y z <= len a b c.
Proof.
  intros. unfold len. apply sqrt_le_1_alt. rewrite <- (abs_sq x), <- (abs_sq y), <- (abs_sq z), <- (abs_sq a), <- (abs_sq b), <- (abs_sq c).
  pose proof (Rabs_pos x). pose proof (Rabs_pos y). pose proof (Rabs_pos z).
  pose proof (mul2 (Rabs x) (Rabs x) _ _ (conj H2 H) (conj H2 H)). pose proof (mul2 (Rabs y) (Rabs y) _ _ (conj H3 H0) (conj H3 H0)).
  pose proof (mul2 (Rabs z) (Rabs z) _ _ (conj H4 H1) (conj H4 H1)). lra.
Qed.
Lemma len_scale : forall k x y z, 0 <= k -> len (k * x) (k * y) (k * z) = k * len x y z.
Proof.
  intros. unfold len. replace (k * x * (k * x) + k * y * (k * y) + k * z * (k * z)) with (k * k * (x * x + y * y + z * z)) by ring.
  rewrite sqrt_mult_alt by apply sq_pos. now rewrite sqrt_square.
Qed.
(* Errors that are relative by component are so for the length. *)
Lemma len_part : forall k x y z a b c, 0 <= k -> Rabs x <= k * Rabs a -> Rabs y <= k * Rabs b -> Rabs z <= k * Rabs c ->
  len x y z <= k * len a b c.
Proof.
  intros. rewrite <- len_scale by assumption. apply len_mono; rewrite Rabs_mult, (Rabs_pos_eq k) by assumption; assumption.
Qed.
Lemma len_add : forall x y z a b c, len (x + a) (y + b) (z + c) <= len x y z + len a b c.
Proof.
  intros. pose proof (len_pos x y z). pose proof (len_pos a b c). apply below_root; [lra|]. rewrite len_sq.
  replace ((len x y z + len a b c) * (len x y z + len a b c)) with
    (len x y z * len x y z + len a b c * len a b c + 2 * (len x y z * len a b c)) by ring. rewrite !len_sq.
  pose proof (len_dot x y z a b c) as D. apply Rabs_le_inv in D. lra.
Qed.
Lemma len_opp : forall x y z, len (- x) (- y) (- z) = len x y z.
Proof. intros. unfold len. f_equal. ring. Qed.
Lemma len_component : forall x y z, Rabs x <= len x y z /\ Rabs y <= len x y z /\ Rabs z <= len x y z.
Proof.
  intros. pose proof (len_pos x y z). pose proof (sq_pos x). pose proof (sq_pos y). pose proof (sq_pos z).
  repeat split; (apply abs_below; [assumption|]); rewrite len_sq; lra.
Qed.
Lemma len_sub : forall x y z a b c, len x y z <= len a b c + len (x - a) (y - b) (z - c).
Proof.
  intros. replace (len x y z) with (len (a + (x - a)) (b + (y - b)) (c + (z - c))); [apply len_add | f_equal; ring].
Qed.
(* Dot products: of the magnitudes of the components, and of two vectors that are off. *)
Lemma abs_dot : forall x y z a b c, Rabs x * Rabs a + Rabs y * Rabs b + Rabs z * Rabs c <= len x y z * len a b c.
Proof.
  intros. pose proof (len_dot (Rabs x) (Rabs y) (Rabs z) (Rabs a) (Rabs b) (Rabs c)) as H.
  replace (len (Rabs x) (Rabs y) (Rabs z)) with (len x y z) in H by (unfold len; now rewrite !abs_sq).
  replace (len (Rabs a) (Rabs b) (Rabs c)) with (len a b c) in H by (unfold len; now rewrite !abs_sq).
  apply Rabs_le_inv in H. lra.
Qed.
Lemma dot_off : forall x y z a b c X Y Z A B C, Rabs (x * a + y * b + z * c - (X * A + Y * B + Z * C)) <=
  len (x - X) (y - Y) (z - Z) * len a b c + len x y z * len (a - A) (b - B) (c - C)
  + len (x - X) (y - Y) (z - Z) * len (a - A) (b - B) (c - C).
Proof.
  intros. replace (x * a + y * b + z * c - (X * A + Y * B + Z * C)) with
    (((x - X) * a + (y - Y) * b + (z - Z) * c) + (x * (a - A) + y * (b - B) + z * (c - C))
     - ((x - X) * (a - A) + (y - Y) * (b - B) + (z - Z) * (c - C))) by ring.
  apply Rabs_minus_le; [apply Rabs_plus_le|]; apply len_dot.
Qed.
(* What rounding is monotone for: the order of rounded numbers is that of the numbers. *)
Lemma RN_lt : forall x y, RN x < RN y -> x < y.
Proof. intros. apply Rnot_le_lt. intro N. apply RN_le in N. lra. Qed.
