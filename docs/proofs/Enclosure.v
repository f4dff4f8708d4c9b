(* rt-math, exact/ball.rs: sums, products, quotients and roots of balls, for midpoints of any length. *)
From Proofs Require Import Rounding.
Open Scope R_scope.

(* The bits of a limb: a midpoint of N limbs has 64 N of them. *)
Definition LIMB_BITS := 64%Z.

(* x cut off after `bits` bits, toward zero: 2^(e - 1) <= |x| < 2^e. *)
Definition cut bits e x := IZR (Ztrunc (x * bp (bits - e))) * bp (e - bits).
Lemma cut_error : forall bits e x, Rabs (x - cut bits e x) < bp (e - bits).
Proof.
  intros bits e x. unfold cut. set (y := x * bp (bits - e)). assert (X : x = y * bp (e - bits)).
  { unfold y. rewrite Rmult_assoc, <- bp_add. replace (bits - e + (e - bits))%Z with 0%Z by ring. simpl. ring. }
  assert (Y : Rabs (y - IZR (Ztrunc y)) < 1).
  { unfold Ztrunc. destruct (Rlt_bool_spec y 0) as [N|N].
    - pose proof (Zceil_ub y) as U. pose proof (Zceil_lb y) as L. apply Rabs_lt. lra.
    - pose proof (Zfloor_lb y) as L. pose proof (Zfloor_ub y) as U. apply Rabs_lt. lra. }
  rewrite X at 1. rewrite <- Rmult_minus_distr_r, Rabs_mult, (Rabs_pos_eq (bp _)) by apply Rlt_le, bp_pos.
  rewrite <- (Rmult_1_l (bp (e - bits))) at 2. apply Rmult_lt_compat_r; [apply bp_pos | assumption].
Qed.
(* What is cut off is less than a unit of the last bit, and at most 2^(1 - 64 N) of the result. *)
Theorem LIMB_BITS_holds : forall N e x, (1 <= N)%Z -> bp (e - 1) <= Rabs x ->
  Rabs (x - cut (LIMB_BITS * N) e x) < bp (e - LIMB_BITS * N) /\ bp (e - LIMB_BITS * N) <= bp (1 - LIMB_BITS * N) *
    Rabs x.
Proof.
  intros N e x HN Hx. split; [apply cut_error|].
  replace (e - LIMB_BITS * N)%Z with (1 - LIMB_BITS * N + (e - 1))%Z by ring. rewrite bp_add.
  apply Rmult_le_compat_l; [apply Rlt_le, bp_pos | assumption].
Qed.
(* A sum of two midpoints whose exponents differ by more than all bits: the smaller one goes into the radius. *)
Theorem sum_far : forall x y e, Rabs y <= bp e -> Rabs (x + y - x) <= bp e.
Proof. intros. now replace (x + y - x) with y by ring. Qed.

(* Balls x, p and y, q; a and b any of their numbers; m the midpoint of the result, off by a unit; radii rounded up. *)
Section Operations.
Variables x p y q a b m unit r : R.
Hypotheses (Ha : Rabs (a - x) <= p) (Hb : Rabs (b - y) <= q).
Theorem sum_encloses : Rabs (x + y - m) <= unit -> p + q + unit <= r -> Rabs (a + b - m) <= r.
Proof.
  intros H R. replace (a + b - m) with ((a - x) + (b - y) + (x + y - m)) by ring.
  eapply Rle_trans; [apply Rabs_triang|].
  eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|]. lra.
Qed.
Theorem product_encloses : Rabs (x * y - m) <= unit -> Rabs x * q + p * (Rabs y + q)
  + unit <= r -> Rabs (a * b - m) <= r.
Proof.
  intros H R. pose proof (Rabs_pos (a - x)) as P. pose proof (Rabs_pos (b - y)) as Q.
  assert (B : Rabs b <= Rabs y + q) by (replace b with (y + (b - y)) by ring; eapply Rle_trans; [apply Rabs_triang|];
    lra).
  replace (a * b - m) with ((a - x) * b + x * (b - y) + (x * y - m)) by ring. eapply Rle_trans; [apply Rabs_triang|].
  eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|]. rewrite !Rabs_mult.
  assert (Rabs (a - x) * Rabs b <= p * (Rabs y + q)) by (apply mul2; split; auto using Rabs_pos).
  assert (Rabs x * Rabs (b - y) <= Rabs x * q) by (apply Rmult_le_compat_l; [apply Rabs_pos | assumption]). lra.
Qed.
(* `least` is below every magnitude of the divisor, `most` above that of the quotient of the midpoints. *)
Theorem quotient_encloses : forall least most, 0 < least -> least <= Rabs y - q -> Rabs (x / y) <= most ->
  Rabs (x / y - m) <= unit -> (p + q * most) / least + unit <= r -> Rabs (a / b - m) <= r.
Proof.
  intros least most L0 L M H R. pose proof (Rabs_pos (a - x)) as P. pose proof (Rabs_pos (b - y)) as Q.
  assert (B : least <= Rabs b).
  { apply Rle_trans with (1 := L). replace b with (y - - (b - y)) by ring. eapply Rle_trans; [|apply Rabs_triang_inv].
    rewrite Rabs_Ropp. lra. }
  assert (b0 : b <> 0) by (intro Z; rewrite Z, Rabs_R0 in B; lra).
  assert (y0 : y <> 0) by (intro Z; rewrite Z, Rabs_R0 in L; lra).
  assert (E : Rabs (a / b - x / y) <= (p + q * most) / least).
  { replace (a / b - x / y) with (((a - x) - (x / y) * (b - y)) * / b) by (field; split; assumption).
    rewrite Rabs_mult, Rabs_inv. unfold Rdiv. apply Rmult_le_compat.
    - apply Rabs_pos.
    - apply Rlt_le, Rinv_0_lt_compat. lra.
    - unfold Rminus. eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp, Rabs_mult.
      assert (Rabs (x * / y) * Rabs (b + - y) <= most * q) by (apply mul2; split; auto using Rabs_pos).
      unfold Rminus in *. lra.
    - now apply Rinv_le_contravar. }
  replace (a / b - m) with ((a / b - x / y) + (x / y - m)) by ring. eapply Rle_trans; [apply Rabs_triang|]. lra.
Qed.
End Operations.
(* A root: s is whatever Heron's steps gave, `error` bounds x - s^2, `least` is below s and below the root of x. *)
Theorem root_encloses : forall x p a s error least low r,
  0 < x -> Rabs (a - x) <= p -> 0 <= a -> 0 < s -> 0 < least <= s ->
  0 < low <= sqrt x -> Rabs (x - s * s) <= error -> error / least + p / low <= r -> Rabs (sqrt a - s) <= r.
Proof.
  intros x p a s error least low r X0 Ha A0 s0 [L0 L1] [W0 W1] E R. pose proof (sqrt_lt_R0 x X0) as Q0.
  set (q := sqrt x) in *.
  assert (qq : q * q = x) by (apply sqrt_sqrt; lra). pose proof (sqrt_pos a) as B0. set (b := sqrt a) in *.
  assert (bb : b * b = a) by (now apply sqrt_sqrt).
  assert (E1 : Rabs (q - s) <= error / least).
  { apply Rmult_le_reg_r with least; [assumption|]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra.
    apply Rle_trans with (2 := E). replace (x - s * s) with ((q - s) * (q + s)) by (rewrite <- qq; ring).
    rewrite Rabs_mult, (Rabs_pos_eq (q + s)) by lra. apply Rmult_le_compat_l; [apply Rabs_pos | lra]. }
  assert (E2 : Rabs (b - q) <= p / low).
  { apply Rmult_le_reg_r with low; [assumption|]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra.
    apply Rle_trans with (2 := Ha). replace (a - x) with ((b - q) * (b + q)) by (rewrite <- qq, <- bb; ring).
    rewrite Rabs_mult, (Rabs_pos_eq (b + q)) by lra. apply Rmult_le_compat_l; [apply Rabs_pos | lra]. }
  replace (b - s) with ((b - q) + (q - s)) by ring. eapply Rle_trans; [apply Rabs_triang|]. lra.
Qed.
