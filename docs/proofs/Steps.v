(* What chains of roundings share: products of bounds, a step of Newton's for a quotient and for a square root. *)
From Proofs Require Import Rounding.
From Flocq Require Import Plus_error Sterbenz.
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
  replace (len x y z * len a b c * (len x y z * len a b c)) with ((len x y z * len x y z) * (len a b c * len a b c))
    by ring.
  rewrite !len_sq. apply cauchy_schwarz.
Qed.
Lemma norm1_pos : forall x y z, 0 <= norm1 x y z.
Proof. intros. unfold norm1. pose proof (Rabs_pos x). pose proof (Rabs_pos y). pose proof (Rabs_pos z). lra. Qed.
Lemma len_le_norm1 : forall x y z, len x y z <= norm1 x y z.
Proof.
  intros. apply below_root; [apply norm1_pos|]. rewrite len_sq. unfold norm1. pose proof (Rabs_pos x). pose proof
    (Rabs_pos y).
  pose proof (Rabs_pos z). rewrite <- (abs_sq x), <- (abs_sq y), <- (abs_sq z).
  pose proof (Rmult_le_pos _ _ H H0). pose proof (Rmult_le_pos _ _ H H1). pose proof (Rmult_le_pos _ _ H0 H1). lra.
Qed.
Lemma norm1_le_len : forall x y z, norm1 x y z <= 17321 / 10000 * len x y z.
Proof.
  intros. pose proof (len_pos x y z). apply below_root; [lra|].
  replace (17321 / 10000 * len x y z * (17321 / 10000 * len x y z)) with (17321 / 10000 * (17321 / 10000) * (len x y z
    * len x y z)) by ring.
  rewrite len_sq. unfold norm1. pose proof (sq_pos (Rabs x - Rabs y)). pose proof (sq_pos (Rabs y - Rabs z)).
  pose proof (sq_pos (Rabs z - Rabs x)). rewrite <- (abs_sq x), <- (abs_sq y), <- (abs_sq z).
  pose proof (sq_pos (Rabs x)). pose proof (sq_pos (Rabs y)). pose proof (sq_pos (Rabs z)). lra.
Qed.
Lemma len_mono : forall x y z a b c, Rabs x <= Rabs a -> Rabs y <= Rabs b -> Rabs z <= Rabs c -> len x y z <= len a b c.
Proof.
  intros. unfold len. apply sqrt_le_1_alt. rewrite <- (abs_sq x), <- (abs_sq y), <- (abs_sq z), <- (abs_sq a), <-
    (abs_sq b), <- (abs_sq c).
  pose proof (Rabs_pos x). pose proof (Rabs_pos y). pose proof (Rabs_pos z).
  pose proof (mul2 (Rabs x) (Rabs x) _ _ (conj H2 H) (conj H2 H)). pose proof (mul2 (Rabs y) (Rabs y) _ _ (conj H3 H0)
    (conj H3 H0)).
  pose proof (mul2 (Rabs z) (Rabs z) _ _ (conj H4 H1) (conj H4 H1)). lra.
Qed.
Lemma len_scale : forall k x y z, 0 <= k -> len (k * x) (k * y) (k * z) = k * len x y z.
Proof.
  intros. unfold len. replace (k * x * (k * x) + k * y * (k * y) + k * z * (k * z)) with (k * k * (x * x + y * y + z *
    z)) by ring.
  rewrite sqrt_mult_alt by apply sq_pos. now rewrite sqrt_square.
Qed.
(* Errors that are relative by component are so for the length. *)
Lemma len_part : forall k x y z a b c, 0 <= k -> Rabs x <= k * Rabs a -> Rabs y <= k * Rabs b -> Rabs z <= k * Rabs c ->
  len x y z <= k * len a b c.
Proof.
  intros. rewrite <- len_scale by assumption. apply len_mono; rewrite Rabs_mult, (Rabs_pos_eq k) by assumption;
    assumption.
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

(* z - RN(x y) is a double where x y is near z: what `remainder` of ErrorFree.v asks for. *)
Lemma near_exact : forall z x y, F z -> bp (-900) <= Rabs z -> Rabs (z - x * y) <= / 4 * Rabs z -> F (z - RN (x * y)).
Proof.
  intros z x y Fz Z H. unfold Rminus. apply (generic_format_plus_weak radix2 fexp); [assumption | apply F_opp, RN_F|].
  set (p := RN (x * y)). change (z + - p) with (z - p). rewrite Rabs_Ropp.
  pose proof (RN_err (x * y)) as E. fold p in E. assert (T : bp (-1075) <= / 1000000000000 * bp (-900)) by (apply
    bp_part12; lia).
  assert (XY : Rabs (x * y) <= 5 / 4 * Rabs z).
  { replace (x * y) with (z - (z - x * y)) by ring. eapply Rle_trans; [apply Rabs_minus_le; [apply Rle_refl | exact
    H]|]. lra. }
  assert (S : Rabs (z - p) <= / 3 * Rabs z).
  { replace (z - p) with ((z - x * y) - (p - x * y)) by ring. eapply Rle_trans; [apply Rabs_minus_le; [exact H | exact
    E]|]. pose proof (bp_pos (-900)). rewrite u_val in *. lra. }
  pose proof (Rabs_triang p (z - p)) as P. replace (p + (z - p)) with z in P by ring. pose proof (Rabs_pos z). apply
    Rmin_glb; lra.
Qed.
(* A quotient of N + N' by M + M' with one correction, in parts of N / M: i is the inverse times M, X and K are the
  quotient and
   its correction, R, T and S the rests, over N. *)
Lemma one_correction : forall i X R T S K n m p q r tau s k nu mu,
  Rabs (i - 1) <= p -> Rabs (X - i) <= q -> Rabs (R - (1 - X)) <= r -> Rabs (T - (n - X * m)) <= tau -> Rabs (S - (R +
    T)) <= s ->
  Rabs (K - S * i) <= k -> Rabs n <= nu -> Rabs m <= mu -> mu <= / 4 ->
  let P := p + q + nu + (1 + p + q) * mu in let e := p + (1 + p) * mu in
  Rabs (X + K - (1 + n) / (1 + m)) <= k + ((r + tau + s) * (1 + e) + P * e) * (1 + 2 * mu) /\ Rabs (1 + n - X * (1 +
    m)) <= P.
Proof.
  intros i X R T S K n m p q r tau s k nu mu Hi HX HR HT HS HK Hn Hm M4 P e. pose proof (Rabs_pos (i - 1)). pose proof
    (Rabs_pos (X - i)).
  pose proof (Rabs_pos m). pose proof (Rabs_pos n). assert (m1 : 3 / 4 <= 1 + m) by (apply Rabs_le_inv in Hm; lra).
  assert (XB : Rabs X <= 1 + p + q) by (replace X with (1 + (i - 1) + (X - i)) by ring; repeat apply Rabs_plus_le; try
    assumption; rewrite Rabs_R1; lra).
  assert (PB : Rabs (1 + n - X * (1 + m)) <= P).
  { replace (1 + n - X * (1 + m)) with (- ((i - 1) + (X - i)) + n - X * m) by ring. unfold P.
    apply Rabs_minus_le; [apply Rabs_plus_le; [rewrite Rabs_Ropp; now apply Rabs_plus_le | assumption] | now apply
      Rabs_mult_le]. }
  split; [|exact PB].
  assert (ER : Rabs (S - (1 + n - X * (1 + m))) <= r + tau + s).
  { replace (S - (1 + n - X * (1 + m))) with ((R - (1 - X)) + (T - (n - X * m)) + (S - (R + T))) by ring. repeat apply
    Rabs_plus_le; assumption. }
  assert (EI : Rabs (i * (1 + m) - 1) <= e).
  { replace (i * (1 + m) - 1) with ((i - 1) + i * m) by ring. unfold e. apply Rabs_plus_le; [assumption|]. apply
    Rabs_mult_le; [|assumption].
    replace i with (1 + (i - 1)) by ring. apply Rabs_plus_le; [rewrite Rabs_R1; lra | assumption]. }
  pose proof (quotient_step (1 + n) (1 + m) X S i K _ _ _ ltac:(lra) ER EI HK) as Q. eapply Rle_trans; [exact Q|].
    apply Rplus_le_compat_l.
  rewrite (Rabs_pos_eq (1 + m)) by lra. pose proof (Rabs_pos (S - (1 + n - X * (1 + m)))). pose proof (Rabs_pos (i *
    (1 + m) - 1)).
  assert (N : 0 <= (r + tau + s) * (1 + e) + P * e).
  { apply Rplus_le_le_0_compat; apply Rmult_le_pos; try lra. pose proof (Rabs_pos (1 + n - X * (1 + m))). lra. }
  apply Rle_trans with (((r + tau + s) * (1 + e) + P * e) / (1 + m)).
  - apply Rmult_le_compat_r; [apply Rlt_le, Rinv_0_lt_compat; lra|]. apply Rplus_le_compat_l. apply Rmult_le_compat_r;
    lra.
  - apply Rmult_le_compat_l; [assumption|]. apply Rmult_le_reg_r with (1 + m); [lra|]. rewrite Rinv_l by lra. apply
    Rabs_le_inv in Hm.
    assert ((1 + 2 * mu) * (1 - mu) <= (1 + 2 * mu) * (1 + m)) by (apply Rmult_le_compat_l; lra). assert (mu * mu <=
      mu * / 4) by (apply Rmult_le_compat_l; lra). lra.
Qed.
(* The same in doubles of ordinary size. *)
Lemma corrected : forall N N' M M' t nu mu tau, F N -> F M -> F t -> bp (-400) <= Rabs N <= bp 400 -> bp (-400) <=
  Rabs M <= bp 400 ->
  Rabs N' <= nu * Rabs N -> Rabs M' <= mu * Rabs M -> nu <= / 1000000 -> mu <= / 1000000 -> 0 <= tau <= / 1000000 ->
  let inv := RN (1 / M) in let x := RN (N * inv) in let rest := RN (RN (N - x * M) + t) in let k := RN (rest * inv) in
  Rabs (t - (N' - x * M')) <= tau * Rabs N ->
  let a := (1 + / 1000) * u in let P := 2 * a + nu + (1 + 2 * a) * mu in let e := a + (1 + a) * mu in let er := 201 /
    100 * u * u + tau + u * (P + tau + u) in
  Rabs (x + k - (N + N') / (M + M')) <= (a * (P + er) * (1 + a) + (er * (1 + e) + P * e) * (1 + 2 * mu)) * Rabs (N /
    M) /\
  Rabs k <= (1 + 3 * u) * (P + er) * Rabs (N / M) /\ (1 - 3 * u) * Rabs (N / M) <= Rabs x.
Proof.
  intros N N' M M' t nu mu tau FN FM Ft BN BM HN HM Nu Mu Tau inv x rest k HT a P e er. pose proof u_pos as up. pose
    proof (bp_pos (-400)) as P4.
  assert (N0 : N <> 0) by (intro Z; rewrite Z, Rabs_R0 in BN; lra). assert (M0 : M <> 0) by (intro Z; rewrite Z,
    Rabs_R0 in BM; lra).
  pose proof (Rabs_pos_lt N N0) as NP. pose proof (Rabs_pos_lt M M0) as MP. set (Q := Rabs (N / M)).
  assert (QE : Q = Rabs N / Rabs M) by (unfold Q, Rdiv; rewrite Rabs_mult, Rabs_inv; reflexivity).
  assert (QL : bp (-800) <= Q).
  { rewrite QE. apply Rmult_le_reg_r with (Rabs M); [assumption|]. replace (Rabs N / Rabs M * Rabs M) with (Rabs N) by
    (field; lra).
    apply Rle_trans with (bp (-800) * bp 400); [apply Rmult_le_compat_l; [apply Rlt_le, bp_pos | lra]|]. rewrite <-
      bp_add. exact (proj1 BN). }
  assert (Q0 : 0 < Q) by (pose proof (bp_pos (-800)); lra).
  assert (T8 : bp (-1075) <= / 10000 * (u * u) * bp (-800)).
  { apply Rle_trans with (bp (-20) * (u * u) * bp (-800)); [unfold u; rewrite <- !bp_add; apply bp_le; lia|]. apply
    Rmult_le_compat_r; [apply Rlt_le, bp_pos|].
    apply Rmult_le_compat_r; [apply sq_pos | simpl; lra]. }
  assert (T9 : bp (-1075) <= / 10000 * (u * u) * bp (-400)) by (eapply Rle_trans; [exact T8|]; apply
    Rmult_le_compat_l; [rewrite u_val; lra | apply bp_le; lia]).
  pose proof (bp_pos (-1075)) as T0.
  assert (TQ : bp (-1075) <= / 10000 * (u * u) * Q) by (eapply Rle_trans; [exact T8|]; apply Rmult_le_compat_l;
    [rewrite u_val|]; lra).
  assert (TN : bp (-1075) <= / 10000 * (u * u) * Rabs N) by (eapply Rle_trans; [exact T9|]; apply Rmult_le_compat_l;
    [rewrite u_val|]; lra).
  (* normalised *)
  assert (DN : forall y b, Rabs y <= b * Rabs N -> Rabs (y / N) <= b) by (intros; now apply Rabs_div_le).
  assert (A0 : 0 < a <= / 1000000) by (unfold a; rewrite u_val; lra).
  assert (I1 : Rabs (inv * M - 1) <= a).
  { replace (inv * M - 1) with ((inv - 1 / M) * M) by (field; assumption). rewrite Rabs_mult. pose proof (RN_err (1 /
    M)) as E. fold inv in E.
    assert (AM : Rabs (1 / M) * Rabs M = 1) by (rewrite <- Rabs_mult; replace (1 / M * M) with 1 by (field;
      assumption); apply Rabs_R1).
    apply Rle_trans with ((u * Rabs (1 / M) + bp (-1075)) * Rabs M); [apply Rmult_le_compat_r; lra|].
    assert (bp (-1075) * Rabs M <= / 1000 * u).
    { apply Rle_trans with (bp (-1075) * bp 400); [apply Rmult_le_compat_l; lra|]. apply Rle_trans with (bp (-10) *
      u); [unfold u; rewrite <- !bp_add; apply bp_le; lia|].
      apply Rmult_le_compat_r; [lra | simpl; lra]. }
    replace ((u * Rabs (1 / M) + bp (-1075)) * Rabs M) with (u * (Rabs (1 / M) * Rabs M) + bp (-1075) * Rabs M) by
      ring. rewrite AM. unfold a. lra. }
  pose proof I1 as I1'. apply Rabs_le_inv in I1'.
  assert (NI : Rabs (N * inv) = Rabs (inv * M) * Q) by (unfold Q; rewrite <- Rabs_mult; f_equal; field; assumption).
  assert (IB : Rabs (inv * M) <= 1 + a) by (apply Rabs_le; lra).
  assert (X1 : Rabs (x * M / N - inv * M) <= a).
  { replace (x * M / N - inv * M) with ((x - N * inv) * (M / N)) by (field; assumption). rewrite Rabs_mult. pose proof
    (RN_err (N * inv)) as E. fold x in E.
    assert (QI : Q * Rabs (M / N) = 1) by (unfold Q; rewrite <- Rabs_mult; replace (N / M * (M / N)) with 1 by (field;
      split; assumption); apply Rabs_R1).
    rewrite NI in E. assert (E' : Rabs (x - N * inv) <= a * Q).
    { eapply Rle_trans; [exact E|]. assert (u * (Rabs (inv * M) * Q) <= u * ((1 + a) * Q)) by (apply
      Rmult_le_compat_l; [lra|]; apply Rmult_le_compat_r; lra).
      unfold a in *. rewrite u_val in *. lra. }
    apply Rle_trans with (a * Q * Rabs (M / N)); [apply Rmult_le_compat_r; [apply Rabs_pos | exact E']|]. rewrite
      Rmult_assoc, QI. lra. }
  assert (XX : Rabs (1 - x * M / N) <= 2 * a).
  { replace (1 - x * M / N) with (- ((x * M / N - inv * M) + (inv * M - 1))) by ring. rewrite Rabs_Ropp. eapply
    Rle_trans; [apply Rabs_plus_le; eassumption|]. lra. }
  assert (XN : Rabs (N - x * M) <= 2 * a * Rabs N).
  { replace (N - x * M) with ((1 - x * M / N) * N) by (field; assumption). rewrite Rabs_mult. apply Rmult_le_compat_r;
    lra. }
  set (rem := RN (N - x * M)) in *.
  assert (R1 : Rabs (rem / N - (1 - x * M / N)) <= 201 / 100 * u * u).
  { replace (rem / N - (1 - x * M / N)) with ((rem - (N - x * M)) / N) by (field; assumption). apply DN. pose proof
    (RN_err (N - x * M)) as E. fold rem in E.
    eapply Rle_trans; [exact E|]. assert (u * Rabs (N - x * M) <= u * (2 * a * Rabs N)) by (apply Rmult_le_compat_l;
      lra). unfold a in *. rewrite u_val in *. lra. }
  assert (T1 : Rabs (t / N - (N' / N - x * M / N * (M' / M))) <= tau).
  { replace (t / N - (N' / N - x * M / N * (M' / M))) with ((t - (N' - x * M')) / N) by (field; split; assumption).
    now apply DN. }
  assert (n1 : Rabs (N' / N) <= nu) by now apply DN. assert (m1 : Rabs (M' / M) <= mu) by (apply Rabs_div_le;
    assumption).
  assert (nu0 : 0 <= nu) by (pose proof (Rabs_pos (N' / N)); lra). assert (mu0 : 0 <= mu) by (pose proof (Rabs_pos (M'
    / M)); lra).
  assert (RT : Rabs (rem / N + t / N) <= P + tau + u).
  { replace (rem / N + t / N) with ((rem / N - (1 - x * M / N)) + (1 - x * M / N) + ((t / N - (N' / N - x * M / N *
    (M' / M))) + (N' / N - x * M / N * (M' / M)))) by ring.
    assert (XM : Rabs (x * M / N * (M' / M)) <= (1 + 2 * a) * mu).
    { apply Rabs_mult_le; [|assumption]. replace (x * M / N) with (1 - (1 - x * M / N)) by ring. eapply Rle_trans;
      [apply Rabs_minus_le; [apply Rle_refl | exact XX]|]. rewrite Rabs_R1. lra. }
    eapply Rle_trans; [apply Rabs_plus_le; [apply Rabs_plus_le; [exact R1 | exact XX] | apply Rabs_plus_le; [exact T1
      | apply Rabs_minus_le; [exact n1 | exact XM]]]|].
    unfold P. rewrite u_val in *. lra. }
  assert (S1 : Rabs (rest / N - (rem / N + t / N)) <= u * (P + tau + u)).
  { replace (rest / N - (rem / N + t / N)) with ((rest - (rem + t)) / N) by (field; assumption). apply DN. pose proof
    (RN_sum rem t (RN_F _) Ft) as E. fold rest in E.
    eapply Rle_trans; [exact E|]. rewrite Rmult_assoc. apply Rmult_le_compat_l; [lra|]. replace (rem + t) with ((rem /
      N + t / N) * N) by (field; assumption).
    rewrite Rabs_mult. apply Rmult_le_compat_r; lra. }
  assert (P0 : 0 <= P) by (unfold P; assert (0 <= (1 + 2 * a) * mu) by (apply Rmult_le_pos; lra); lra).
  assert (er0 : 201 / 100 * u * u <= er) by (unfold er; assert (0 <= u * (P + tau + u)) by (apply Rmult_le_pos; lra);
    lra).
  assert (SB : Rabs (rest / N) <= P + er).
  { pose proof (proj2 (one_correction (inv * M) (x * M / N) (rem / N) (t / N) (rest / N) (rest / N * (inv * M)) (N' /
    N) (M' / M) a a (201 / 100 * u * u) tau
      (u * (P + tau + u)) 0 nu mu I1 X1 R1 T1 S1 ltac:(replace (rest / N * (inv * M) - rest / N * (inv * M)) with 0 by
        ring; rewrite Rabs_R0; lra) n1 m1 ltac:(lra))) as PB.
    cbv zeta in PB. replace (a + a) with (2 * a) in PB by ring.
    replace (rest / N) with ((rem / N - (1 - x * M / N)) + (t / N - (N' / N - x * M / N * (M' / M))) + (rest / N -
      (rem / N + t / N)) + (1 + N' / N - x * M / N * (1 + M' / M))) by ring.
    eapply Rle_trans; [apply Rabs_plus_le; [apply Rabs_plus_le; [apply Rabs_plus_le; eassumption | exact S1] | exact
      PB]|]. unfold er, P. lra. }
  assert (SI : Rabs (rest / N * (inv * M)) <= (P + er) * (1 + a)) by (apply Rabs_mult_le; assumption).
  assert (KE : Rabs (k * M / N - rest / N * (inv * M)) <= a * (P + er) * (1 + a)).
  { replace (k * M / N - rest / N * (inv * M)) with ((k - rest * inv) * (M / N)) by (field; assumption). rewrite
    Rabs_mult. pose proof (RN_err (rest * inv)) as E. fold k in E.
    assert (QI : Q * Rabs (M / N) = 1) by (unfold Q; rewrite <- Rabs_mult; replace (N / M * (M / N)) with 1 by (field;
      split; assumption); apply Rabs_R1).
    assert (RI : Rabs (rest * inv) <= (P + er) * (1 + a) * Q).
    { replace (rest * inv) with (rest / N * (inv * M) * (N / M)) by (field; split; assumption). rewrite Rabs_mult.
      apply Rmult_le_compat_r; [lra | exact SI]. }
    assert (PL : 2 * u <= P) by (unfold P, a; assert (0 <= (1 + 2 * ((1 + / 1000) * u)) * mu) by (apply Rmult_le_pos;
      lra); lra).
    assert (E' : Rabs (k - rest * inv) <= a * (P + er) * (1 + a) * Q).
    { eapply Rle_trans; [exact E|]. apply Rle_trans with (u * ((P + er) * (1 + a) * Q) + / 10000 * (u * u) * Q).
      - apply Rplus_le_compat; [apply Rmult_le_compat_l; lra | exact TQ].
      - replace (u * ((P + er) * (1 + a) * Q) + / 10000 * (u * u) * Q) with ((u * ((P + er) * (1 + a)) + / 10000 * (u
        * u)) * Q) by ring. apply Rmult_le_compat_r; [lra|].
        unfold a at 2. assert (2 * u * 1 <= (P + er) * (1 + a)) by (apply Rmult_le_compat; lra || (rewrite u_val in *;
          lra)).
        assert (u * (2 * u * 1) <= u * ((P + er) * (1 + a))) by (apply Rmult_le_compat_l; lra).
        replace ((1 + / 1000) * u * (P + er) * (1 + a)) with ((1 + / 1000) * (u * ((P + er) * (1 + a)))) by ring. pose
          proof (sq_pos u). lra. }
    apply Rle_trans with (a * (P + er) * (1 + a) * Q * Rabs (M / N)); [apply Rmult_le_compat_r; [apply Rabs_pos |
      exact E']|]. rewrite Rmult_assoc, QI. lra. }
  destruct (one_correction (inv * M) (x * M / N) (rem / N) (t / N) (rest / N) (k * M / N) (N' / N) (M' / M) a a (201 /
    100 * u * u) tau
      (u * (P + tau + u)) (a * (P + er) * (1 + a)) nu mu I1 X1 R1 T1 S1 KE n1 m1 ltac:(lra)) as [OC _]. cbv zeta in
        OC. replace (a + a) with (2 * a) in OC by ring. replace (1 + a + a) with (1 + 2 * a) in OC by ring.
  assert (MM : M + M' <> 0).
  { intro Z. assert (M' / M = -1) by (replace M' with (- M) by lra; field; assumption). rewrite H in m1. unfold Rabs
    in m1. destruct Rcase_abs in m1; lra. }
  split; [|split].
  - replace (x + k - (N + N') / (M + M')) with ((x * M / N + k * M / N - (1 + N' / N) / (1 + M' / M)) * (N / M)).
    + rewrite Rabs_mult. fold Q. apply Rmult_le_compat_r; [lra|]. exact OC.
    + field. repeat split; assumption.
  - replace k with (k * M / N * (N / M)) by (field; split; assumption). rewrite Rabs_mult. fold Q. apply
    Rmult_le_compat_r; [lra|].
    replace (k * M / N) with ((k * M / N - rest / N * (inv * M)) + rest / N * (inv * M)) by ring. eapply Rle_trans;
      [apply Rabs_plus_le; [exact KE | exact SI]|].
    replace (a * (P + er) * (1 + a) + (P + er) * (1 + a)) with ((1 + a) * (1 + a) * (P + er)) by ring. apply
      Rmult_le_compat_r; [rewrite u_val in *; lra|].
    unfold a. rewrite u_val. lra.
  - replace x with (x * M / N * (N / M)) by (field; split; assumption). rewrite Rabs_mult. fold Q. apply
    Rmult_le_compat_r; [lra|].
    pose proof (Rabs_triang_inv 1 (1 - x * M / N)) as I. rewrite Rabs_R1 in I. replace (1 - (1 - x * M / N)) with (x *
      M / N) in I by ring. unfold a in XX. rewrite u_val in *. lra.
Qed.
