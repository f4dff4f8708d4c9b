(* rt-math, exact/dyadic.rs and exact/fixed.rs: how many limbs the integers and fixed-point numbers of a kernel take. *)
From Proofs Require Import Rounding.
Open Scope Z_scope.

(* rt-math, exact/dot.rs *)
Definition DOT_LIMBS := 68%Z.
Definition DOT_NARROW_LIMBS := 16%Z.
Definition DOT_NARROW := (64 * 14)%Z.
(* rt-math, quadratic.rs *)
Definition QUADRATIC_LIMBS := 104%Z.
(* rt-math, pseudo_inverse/integers.rs and whole.rs *)
Definition INVERSE_LIMBS := 136%Z.
Definition INVERSE_NARROW_LIMBS := 16%Z.
Definition INVERSE_NARROW := (206 - 53)%Z.
Definition WHOLE_BITS := 11%Z.
(* rt-math, reflect.rs *)
Definition REFLECT_LIMBS := 104%Z.
Definition REFLECT_NARROW_LIMBS := 24%Z.
Definition REFLECT_NARROW := (64 * 20)%Z.
(* rt-geom, sphere/exact.rs *)
Definition SPHERE_LIMBS := 200%Z.
Definition SIDE_LIMBS := 68%Z.
(* rt-geom, triangle/exact.rs *)
Definition TRIANGLE_LIMBS := 104%Z.
Definition TRIANGLE_NARROW_LIMBS := 24%Z.
Definition TRIANGLE_NARROW := (64 * 20)%Z.
Definition NORMAL_LIMBS := 68%Z.
(* rt-geom, triangle/locate.rs *)
Definition LOCATE_LIMBS := 136%Z.
Definition LOCATE_NARROW_LIMBS := 24%Z.
Definition LOCATE_NARROW := (64 * 20)%Z.
(* rt-geom, enclosing/exact.rs *)
Definition REACH_LIMBS := 72%Z.
(* figures, import/polygon.rs *)
Definition AREA_LIMBS := 68%Z.
(* rt-geom, surface/exact.rs *)
Definition SURFACE_LIMBS := 200%Z.
Definition SURFACE_SIDE_LIMBS := 268%Z.
(* rt-geom, crossings.rs *)
Definition CROSSING_LIMBS := 268%Z.
(* rt-math, exact/fixed.rs: a number of N limbs has at most 64 N - 3 bits; operands of a quotient or a root, and the
   numbers that decide it *)
Definition WINDOW_SPARE := 3%Z.
Definition MOST_LIMBS := 12%Z.
Definition LONG_LIMBS := 32%Z.

(* A polynomial as it is computed; a leaf is a multiple of 2^low below 2^top. *)
Inductive form := Leaf (low top : Z) | Plus (a b : form) | Times (a b : form).
Fixpoint low f := match f with
  | Leaf l _ => l | Plus a b => Z.min (low a) (low b) | Times a b => low a + low b end.
Fixpoint top f := match f with
  | Leaf _ t => t | Plus a b => Z.max (top a) (top b) + 1 | Times a b => top a + top b end.
Definition bits f := top f - low f.
Inductive is : form -> R -> Prop :=
  | Is_leaf : forall l t m, (Rabs (IZR m * bp l) < bp t)%R -> is (Leaf l t) (IZR m * bp l)
  | Is_plus : forall a b x y, is a x -> is b y -> is (Plus a b) (x + y)
  | Is_minus : forall a b x y, is a x -> is b y -> is (Plus a b) (x - y)
  | Is_times : forall a b x y, is a x -> is b y -> is (Times a b) (x * y).

Lemma scaled : forall m a b, b <= a -> exists k, (IZR m * bp a = IZR k * bp b)%R.
Proof.
  intros m a b H. exists (m * 2 ^ (a - b)). rewrite mult_IZR. replace (IZR (2 ^ (a - b))) with (bp (a - b)).
  - rewrite Rmult_assoc, <- bp_add. do 2 f_equal. lia.
  - rewrite <- (IZR_Zpower radix2); [reflexivity | lia].
Qed.
(* Every value is a multiple of 2^low below 2^top. *)
Theorem size_of : forall f x, is f x -> (exists m, x = IZR m * bp (low f))%R /\ (Rabs x < bp (top f))%R.
Proof.
  induction 1; cbn [low top].
  - split; [exists m; reflexivity | assumption].
  - destruct IHis1 as [[m1 H1] B1]. destruct IHis2 as [[m2 H2] B2]. split.
    + destruct (scaled m1 (low a) (Z.min (low a) (low b)) ltac:(lia)) as [k1 K1].
      destruct (scaled m2 (low b) (Z.min (low a) (low b)) ltac:(lia)) as [k2 K2].
      exists (k1 + k2). rewrite plus_IZR. lra.
    + rewrite bp_add, bp_1. pose proof (bp_le (top a) (Z.max (top a) (top b)) ltac:(lia)).
      pose proof (bp_le (top b) (Z.max (top a) (top b)) ltac:(lia)). eapply Rle_lt_trans; [apply Rabs_triang|]. lra.
  - destruct IHis1 as [[m1 H1] B1]. destruct IHis2 as [[m2 H2] B2]. split.
    + destruct (scaled m1 (low a) (Z.min (low a) (low b)) ltac:(lia)) as [k1 K1].
      destruct (scaled m2 (low b) (Z.min (low a) (low b)) ltac:(lia)) as [k2 K2].
      exists (k1 - k2). rewrite minus_IZR. lra.
    + rewrite bp_add, bp_1. pose proof (bp_le (top a) (Z.max (top a) (top b)) ltac:(lia)).
      pose proof (bp_le (top b) (Z.max (top a) (top b)) ltac:(lia)). unfold Rminus.
      eapply Rle_lt_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. lra.
  - destruct IHis1 as [[m1 H1] B1]. destruct IHis2 as [[m2 H2] B2]. split.
    + exists (m1 * m2). rewrite mult_IZR, bp_add, H1, H2. ring.
    + rewrite bp_add, Rabs_mult. apply Rmult_le_0_lt_compat; auto using Rabs_pos.
Qed.

(* Limbs of 64 bits, at whole positions, with no zero ones at the ends. *)
Definition limbs b := (b + 62) / 64 + 1.
Definition product_limbs a b := (a + b + 125) / 64 + 1.
(* A number whose lowest bit is at l and whose highest below t has limbs l / 64 .. (t - 1) / 64. *)
Theorem limbs_of : forall l t b, l < t -> t - l <= b -> (t - 1) / 64 - l / 64 + 1 <= limbs b.
Proof. intros. unfold limbs. Z.div_mod_to_equations. lia. Qed.
(* A product is written at the sum of its factors' positions, before zero limbs are dropped. *)
Theorem product_limbs_of : forall l1 t1 l2 t2 b1 b2, l1 < t1 -> l2 < t2 -> t1 - l1 <= b1 -> t2 - l2 <= b2 ->
  (t1 + t2 - 1) / 64 - (l1 / 64 + l2 / 64) + 1 <= product_limbs b1 b2.
Proof. intros. unfold product_limbs. Z.div_mod_to_equations. lia. Qed.
(* What a form takes, all that it is made of included. *)
Fixpoint room f := match f with
  | Leaf _ _ => limbs (bits f)
  | Plus a b => Z.max (limbs (bits f)) (Z.max (room a) (room b))
  | Times a b => Z.max (product_limbs (bits a) (bits b)) (Z.max (room a) (room b)) end.
(* Comparing n / d with a midpoint: twice n, and a number of 54 bits times d. *)
Definition quotient n d := Z.max (Z.max (room (Plus n n)) (room d)) (product_limbs 54 (bits d)).
(* Comparing (p +- sqrt r) / q with a midpoint m: p^2 - r, 4 r, and the square of 2 m q - 2 p. `mq` is 2 m q. *)
Definition root p r mq := Z.max (room (Plus (Times p p) r))
  (Z.max (room (Plus (Plus r r) (Plus r r))) (room (Times (Plus mq (Plus p p)) (Plus mq (Plus p p))))).

(* Any double; twice a midpoint between two; and vectors of them *)
Definition double := Leaf (-1074) 1024.
Definition twice_midpoint := Leaf (-1074) 1025.
Definition difference := Plus double double.
Definition dot3 a b := Plus (Plus (Times a b) (Times a b)) (Times a b).
Definition cross2 a b := Plus (Times a b) (Times a b).
(* numbers that span p bits *)
Definition spanned p := Leaf 0 p.

Theorem DOT_LIMBS_holds : room (dot3 double double) <= DOT_LIMBS /\ room (dot3 difference double) <= DOT_LIMBS.
Proof. vm_compute. split; discriminate. Qed.
Lemma div_le : forall x n, x < 64 * n -> x / 64 + 1 <= n.
Proof. intros. Z.div_mod_to_equations. lia. Qed.
Ltac symbolic := cbv [quotient room bits low top dot3 cross2 spanned limbs product_limbs]; rewrite ?Z.max_id, ?Z.min_id;
  repeat apply Z.max_lub; try apply div_le; lia.
Theorem DOT_NARROW_LIMBS_holds : forall p q, 0 < p -> 0 < q -> p + 1 + q + 2 <= DOT_NARROW ->
  room (dot3 (Plus (spanned p) (spanned p)) (spanned q)) <= DOT_NARROW_LIMBS.
Proof. intros p q P Q H. unfold DOT_NARROW, DOT_NARROW_LIMBS in *. symbolic. Qed.
Theorem DOT_NARROW_holds : forall p q, 0 < p -> 0 < q -> p + 1 + q + 2 <= DOT_NARROW ->
  bits (dot3 (Plus (spanned p) (spanned p)) (spanned q)) <= DOT_NARROW.
Proof. intros p q P Q H. unfold DOT_NARROW in *. symbolic. Qed.

(* (-b +- sqrt D) / 2a: b^2 and 4ac; 2 m 2a is about twice |-b +- sqrt D|. *)
Definition radicand := Plus (Times double double) (Times (Leaf (-1073) 1025) (Leaf (-1073) 1025)).
Theorem QUADRATIC_LIMBS_holds : root double radicand (Leaf (-2147) 1028) <= QUADRATIC_LIMBS /\
  quotient double (Leaf (-1073) 1025) <= QUADRATIC_LIMBS.
Proof. vm_compute. split; discriminate. Qed.

(* Cofactors c, determinants, columns b of the adjugate, sums of squares and of rows. *)
Section Inverse.
Variable a : form.
Definition cofactor := cross2 a a.
Definition determinant := dot3 a cofactor.
Definition column := Plus (cross2 cofactor a) (cross2 cofactor a).
Definition sum_of_squares x := Plus (Plus (dot3 x x) (dot3 x x)) (dot3 x x).
Definition row x := Plus (Plus x x) x.
Definition inverse := Z.max (Z.max (quotient (row cofactor) determinant) (quotient (row column) (sum_of_squares
  cofactor)))
  (quotient (row a) (sum_of_squares a)).
End Inverse.
Theorem INVERSE_LIMBS_holds : inverse double <= INVERSE_LIMBS.
Proof. vm_compute. discriminate. Qed.
(* exponents that differ by at most INVERSE_NARROW, and 53 bits *)
Theorem INVERSE_NARROW_holds : inverse (spanned (INVERSE_NARROW + 53)) <= INVERSE_NARROW_LIMBS.
Proof. vm_compute. discriminate. Qed.
Theorem INVERSE_NARROW_LIMBS_holds : bits (sum_of_squares (cofactor (spanned (INVERSE_NARROW + 53)))) <= 64 *
  (INVERSE_NARROW_LIMBS - 2).
Proof. vm_compute. discriminate. Qed.
(* Whole numbers of 11 bits: all numerators and denominators are whole numbers of at most 53 bits, so exact doubles. *)
Theorem WHOLE_BITS_holds : let a := spanned WHOLE_BITS in
  top (sum_of_squares (cofactor a)) <= 53 /\ top (row (column a)) <= 53 /\ top (determinant a) <= 53 /\
  top (sum_of_squares a) <= 53 /\ low (sum_of_squares (cofactor a)) = 0.
Proof. vm_compute. repeat split; discriminate. Qed.

(* v_i (n.n) - 2 (v.n) n_i over n.n *)
Definition reflected v n := Plus (Times v (dot3 n n)) (Times (Plus (dot3 v n) (dot3 v n)) n).
Theorem REFLECT_LIMBS_holds : quotient (reflected double double) (dot3 double double) <= REFLECT_LIMBS.
Proof. vm_compute. discriminate. Qed.
Theorem REFLECT_NARROW_LIMBS_holds : forall p q, 0 < p -> 0 < q -> p + 2 * q + 4 <= REFLECT_NARROW ->
  quotient (reflected (spanned p) (spanned q)) (dot3 (spanned q) (spanned q)) <= REFLECT_NARROW_LIMBS.
Proof. intros p q P Q H. unfold REFLECT_NARROW, REFLECT_NARROW_LIMBS, reflected in *. symbolic. Qed.
Theorem REFLECT_NARROW_holds : forall p q, 0 < p -> 0 < q -> p + 2 * q + 4 <= REFLECT_NARROW ->
  bits (reflected (spanned p) (spanned q)) <= 64 * 20.
Proof. intros p q P Q H. unfold REFLECT_NARROW, reflected in *. symbolic. Qed.

(* a = d.d, b = w.d, Delta = a r^2 - |w x d|^2; roots (-b +- sqrt Delta) / a *)
Definition sphere_a := dot3 double double.
Definition sphere_b := dot3 difference double.
Definition sphere_delta := let x := cross2 difference double in Plus (Times sphere_a (Times double double)) (dot3 x x).
Theorem SPHERE_LIMBS_holds : root sphere_b sphere_delta (Times twice_midpoint sphere_a) <= SPHERE_LIMBS /\
  quotient sphere_b sphere_a <= SPHERE_LIMBS.
Proof. vm_compute. split; discriminate. Qed.
Theorem SIDE_LIMBS_holds : room (Plus (dot3 difference difference) (Times double double)) <= SIDE_LIMBS.
Proof. vm_compute. discriminate. Qed.

(* Volumes, heights and their sums, of differences e and a direction d. *)
Definition triangle_volume e d := dot3 e (cross2 e d).
Definition first_volume e d := Plus (Plus (triangle_volume e d) (triangle_volume e d)) (triangle_volume e d).
Theorem TRIANGLE_LIMBS_holds :
  quotient (first_volume difference double) (first_volume difference double) <= TRIANGLE_LIMBS /\
  quotient (triangle_volume difference difference) (first_volume difference double) <= TRIANGLE_LIMBS.
Proof. vm_compute. split; discriminate. Qed.
(* points that span p - 1 bits, differences p, and directions that span q *)
Theorem TRIANGLE_NARROW_LIMBS_holds : forall p q, 1 < p -> 0 < q -> 2 * p + Z.max p q + 5 <= TRIANGLE_NARROW ->
  quotient (first_volume (spanned p) (spanned q)) (first_volume (spanned p) (spanned q)) <= TRIANGLE_NARROW_LIMBS /\
  quotient (triangle_volume (spanned p) (spanned p)) (first_volume (spanned p) (spanned q)) <= TRIANGLE_NARROW_LIMBS.
Proof.
  intros p q P Q H. unfold TRIANGLE_NARROW, TRIANGLE_NARROW_LIMBS, first_volume, triangle_volume in *. split; symbolic.
Qed.
Theorem TRIANGLE_NARROW_holds : forall p q, 1 < p -> 0 < q -> 2 * p + Z.max p q + 5 <= TRIANGLE_NARROW ->
  bits (first_volume (spanned p) (spanned q)) <= 64 * 20 /\ bits (triangle_volume (spanned p) (spanned p)) <= 64 * 20.
Proof. intros p q P Q H. unfold TRIANGLE_NARROW, first_volume, triangle_volume in *. split; symbolic. Qed.
Theorem NORMAL_LIMBS_holds : room (cross2 difference difference) <= NORMAL_LIMBS.
Proof. vm_compute. discriminate. Qed.

(* Turns n . (e x q), and n . n *)
Definition turn e := let n := cross2 e e in dot3 n n.
Theorem LOCATE_LIMBS_holds : quotient (turn difference) (turn difference) <= LOCATE_LIMBS.
Proof. vm_compute. discriminate. Qed.
Theorem LOCATE_NARROW_LIMBS_holds : forall p, 1 < p -> 4 * p + 4 <= LOCATE_NARROW ->
  quotient (turn (spanned p)) (turn (spanned p)) <= LOCATE_NARROW_LIMBS.
Proof. intros p P H. unfold LOCATE_NARROW, LOCATE_NARROW_LIMBS, turn in *. symbolic. Qed.
Theorem LOCATE_NARROW_holds : forall p, 1 < p -> 4 * p + 4 <= LOCATE_NARROW -> bits (turn (spanned p)) <= LOCATE_NARROW.
Proof. intros p P H. unfold LOCATE_NARROW, turn in *. symbolic. Qed.

(* |c - c_i|^2 against (R - r_i)^2; the root r_i + |c - c_i|, about half of 2 m *)
Theorem REACH_LIMBS_holds : room (dot3 difference difference) <= REACH_LIMBS /\
  root double (dot3 difference difference) twice_midpoint <= REACH_LIMBS.
Proof. vm_compute. split; discriminate. Qed.
Theorem AREA_LIMBS_holds : room (cross2 difference difference) <= AREA_LIMBS.
Proof. vm_compute. discriminate. Qed.

(* w_i a - b d_i +- d_i sqrt Delta over a; 2 m a, m a double or midpoint, is a multiple of 2^-1074 2^-2148 *)
Definition middle := Plus (Times difference sphere_a) (Times sphere_b double).
Theorem SURFACE_LIMBS_holds :
  root middle (Times sphere_delta (Times double double)) (Times twice_midpoint sphere_a) <= SURFACE_LIMBS /\
  quotient (Plus (Times difference (triangle_volume difference double)) (Times (triangle_volume difference difference)
    double))
    (triangle_volume difference double) <= SURFACE_LIMBS.
Proof. vm_compute. split; discriminate. Qed.
Definition rational := Plus (Times sphere_a (Plus (dot3 difference difference) (Times double double)))
  (Times sphere_b (dot3 difference double)).
Theorem SURFACE_SIDE_LIMBS_holds : room (Times rational rational) <= SURFACE_SIDE_LIMBS /\
  room (Times (Times (dot3 difference double) (dot3 difference double)) sphere_delta) <= SURFACE_SIDE_LIMBS.
Proof. vm_compute. split; discriminate. Qed.

(* Coefficients of series in e: a product has at most four terms, and its sum begins with zero, here a fifth. *)
Definition sum4 x := Plus (Plus (Plus (Plus x x) x) x) x.
Definition series_a := sum4 (dot3 double double).
Definition series_b := dot3 difference double.
Definition globe_c := Plus (dot3 difference difference) (Times double double).
(* s^2 F(h/s) = a h^2 + 2 b h s + c s^2, and a h + b s *)
Definition outside h s := Plus (Plus (Times series_a (Times h h)) (Times (Plus h h) (sum4 (Times series_b s))))
  (Times globe_c (sum4 (Times s s))).
Definition beyond h s := Plus (Times series_a h) (sum4 (Times series_b s)).
Definition slope := dot3 (cross2 difference difference) double.
Definition height := dot3 (cross2 difference difference) difference.
(* Two triangles; a sphere and a triangle; two spheres by the plane where their equations agree, and (b1 - b2)^2 against
   b2^2 - a c2 *)
Theorem CROSSING_LIMBS_holds :
  room (Times height slope) <= CROSSING_LIMBS /\
  room (outside height slope) <= CROSSING_LIMBS /\ room (beyond height slope) <= CROSSING_LIMBS /\
  (let b := Plus series_b series_b in let h := Plus globe_c globe_c in let s := Plus b b in
    room (outside h s) <= CROSSING_LIMBS /\ room (beyond h s) <= CROSSING_LIMBS /\
    room (Plus (Plus (sum4 (Times b b)) (sum4 (Times series_b series_b))) (Times series_a globe_c)) <= CROSSING_LIMBS).
Proof. vm_compute. repeat split; discriminate. Qed.

(* rt-math, exact/fixed.rs: sums of six products of k >= 2 differences keep a bit for the sign in k N limbs. *)
Theorem WINDOW_SPARE_holds : forall n k, 1 <= n -> 2 <= k ->
  6 * (2 ^ (64 * n - WINDOW_SPARE + 1)) ^ k < 2 ^ (64 * (k * n) - 1).
Proof.
  intros n k N K. unfold WINDOW_SPARE. rewrite <- Z.pow_mul_r by lia.
  apply Z.lt_le_trans with (2 ^ 3 * 2 ^ ((64 * n - 3 + 1) * k)).
  - apply Z.mul_lt_mono_pos_r; [apply Z.pow_pos_nonneg; nia | lia].
  - rewrite <- Z.pow_add_r by nia. apply Z.pow_le_mono_r; nia.
Qed.
(* 2 m q of operands of MOST_LIMBS limbs takes three more, its square twice that, and two for the sums. *)
Theorem MOST_LIMBS_holds : 2 * (MOST_LIMBS + 3) + 2 <= LONG_LIMBS.
Proof. vm_compute. discriminate. Qed.
Theorem LONG_LIMBS_holds : let p := spanned (64 * MOST_LIMBS) in
  root p (Times p p) (Times (spanned 54) p) <= LONG_LIMBS /\ quotient p p <= LONG_LIMBS.
Proof. vm_compute. split; discriminate. Qed.
