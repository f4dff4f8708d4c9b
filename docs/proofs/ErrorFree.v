(* rt-math, exact/error_free.rs: sums and products with their errors; theorems of Flocq (S. Boldo) for this format. *)
From Proofs Require Import Rounding.
From Flocq Require Import Pff2Flocq Plus_error Mult_error Sterbenz Relative.
Open Scope R_scope.

Lemma even_sym : forall x : Z, even x = negb (even (- (x + 1))).
Proof.
  intro x. unfold even. rewrite Z.even_opp, Z.even_add. simpl. destruct (Z.even x); reflexivity.
Qed.

(* two_sum(a, b) *)
Definition two_sum_error a b :=
  let value := RN (a + b) in let b_part := RN (value - a) in let a_part := RN (value - b_part) in
  RN (RN (a - a_part) + RN (b - b_part)).
Theorem two_sum : forall a b, F a -> F b -> RN (a + b) + two_sum_error a b = a + b.
Proof. intros a b Fa Fb. exact (TwoSum_correct (-1074) 53 even ltac:(lia) ltac:(lia) even_sym a b Fa Fb). Qed.
Lemma two_sum_error_F : forall a b, F (two_sum_error a b). Proof. intros. apply RN_F. Qed.
Lemma two_sum_error_le : forall a b, F a -> F b ->
  Rabs (two_sum_error a b) <= u * Rabs (a + b) /\ Rabs (two_sum_error a b) <= u * Rabs (RN (a + b)).
Proof.
  intros a b Fa Fb. pose proof (two_sum a b Fa Fb) as T. split.
  - pose proof (RN_sum a b Fa Fb) as P. replace (RN (a + b) - (a + b)) with (- two_sum_error a b) in P by lra.
    now rewrite Rabs_Ropp in P.
  - destruct (FLT_plus_error_N_round_ex radix2 (-1074) 53 even a b Fa Fb) as (e & He & Hr).
    change (round radix2 (FLT_exp (-1074) 53) (Znearest even) (a + b)) with (RN (a + b)) in Hr.
    replace (two_sum_error a b) with (RN (a + b) * e) by lra. rewrite Rabs_mult, Rmult_comm.
    apply Rmult_le_compat_r; [apply Rabs_pos|]. eapply Rle_trans; [apply He|]. unfold u_ro, u. simpl. lra.
Qed.

(* fast_two_sum(a, b) *)
Definition fast_two_sum_error a b := RN (b - RN (RN (a + b) - a)).
Lemma fast_two_sum : forall a b, F a -> F b -> Rabs b <= Rabs a -> RN (a + b) + fast_two_sum_error a b = a + b.
Proof.
  intros a b Fa Fb H. unfold fast_two_sum_error.
  replace (b - RN (RN (a + b) - a)) with (b + RN (a - RN (a + b))).
  - exact (Fast2Sum_correct (-1074) 53 even ltac:(lia) ltac:(lia) even_sym a b Fa Fb H).
  - replace (RN (a + b) - a) with (- (a - RN (a + b))) by ring. rewrite RN_opp. ring.
Qed.
Lemma fast_two_sum_zero : forall b, F b -> RN (0 + b) + fast_two_sum_error 0 b = 0 + b.
Proof.
  intros b Fb. unfold fast_two_sum_error. rewrite Rplus_0_l, Rminus_0_r, (RN_id b Fb), (RN_id b Fb).
  replace (b - b) with 0 by ring. rewrite RN_0. ring.
Qed.

(* Multiples of 2^e of at most 53 bits are doubles. *)
Lemma multiple_F : forall m e, (-1074 <= e)%Z -> Rabs (IZR m * bp e) <= bp (53 + e) -> F (IZR m * bp e).
Proof.
  intros m e He H. destruct (Z.eq_dec (Z.abs m) (2 ^ 53)) as [E|N].
  - assert (IZR m * bp e = bp (53 + e) \/ IZR m * bp e = - bp (53 + e)) as [G|G].
    { assert (m = 2 ^ 53 \/ m = - 2 ^ 53)%Z as [M|M] by lia; subst m; rewrite bp_add; [left | right].
      - replace (bp 53) with (IZR (2 ^ 53)) by (simpl; lra). reflexivity.
      - replace (bp 53) with (IZR (2 ^ 53)) by (simpl; lra). rewrite opp_IZR. ring. }
    + rewrite G. apply F_bp. lia.
    + rewrite G. apply F_opp, F_bp. lia.
  - apply F_scaled; [|assumption].
    rewrite bp_add, Rabs_mult, (Rabs_pos_eq (bp e)) in H by apply Rlt_le, bp_pos.
    apply Rmult_le_reg_r in H; [|apply bp_pos]. rewrite <- abs_IZR in H.
    replace (bp 53) with (IZR (2 ^ 53)) in H by (simpl; lra). apply le_IZR in H. lia.
Qed.
(* More generally: a is a multiple of the last bit of b. *)
Lemma fast_two_sum_multiple : forall a b k, F a -> F b -> b <> 0 -> a = IZR k * bp (cexp radix2 fexp b) ->
  RN (a + b) + fast_two_sum_error a b = a + b.
Proof.
  intros a b k Fa Fb B0 K. destruct (Rle_or_lt (Rabs b) (Rabs a)) as [L|L]; [now apply fast_two_sum|].
  set (e := cexp radix2 fexp b) in *.
  assert (Ee : (-1074 <= e)%Z) by (unfold e, cexp, fexp, FLT_exp; lia).
  assert (Be : Rabs b < bp (53 + e)).
  { apply Rlt_le_trans with (bp (mag radix2 b)); [apply bpow_mag_gt | apply bp_le]. unfold e, cexp, fexp, FLT_exp.
  lia. }
  unfold F, generic_format in Fb. fold e in Fb. set (m := Ztrunc (scaled_mantissa radix2 fexp b)) in Fb.
  assert (Kb : b = IZR m * bp e) by exact Fb.
  assert (Sum : a + b = IZR (k + m) * bp e) by (rewrite plus_IZR; lra).
  (* the error is a multiple of 2^e of at most 2^e *)
  assert (D : exists n, RN (a + b) - (a + b) = IZR n * bp e /\ (Z.abs n <= 1)%Z).
  { destruct (Rle_or_lt (Rabs (a + b)) (bp (53 + e))) as [S|S].
    - exists 0%Z. rewrite RN_id; [split; [simpl; ring | simpl; lia]|]. rewrite Sum.
    apply multiple_F; [assumption | now rewrite <- Sum].
    - assert (M : mag radix2 (a + b) = (54 + e)%Z :> Z).
      { apply mag_unique. split.
        - replace (54 + e - 1)%Z with (53 + e)%Z by ring. lra.
        - eapply Rle_lt_trans; [apply Rabs_triang|]. replace (54 + e)%Z with (1 + (53 + e))%Z by ring. rewrite bp_add.
          rewrite bp_1. lra. }
      assert (C : cexp radix2 fexp (a + b) = (e + 1)%Z) by (unfold cexp; rewrite M; unfold fexp, FLT_exp; lia).
      assert (Fv : RN (a + b) = IZR (ZnearestE (scaled_mantissa radix2 fexp (a + b))) * bp (e + 1)).
      { unfold RN, round, F2R. simpl. now rewrite C. }
      set (v := ZnearestE (scaled_mantissa radix2 fexp (a + b))) in Fv.
      exists (2 * v - (k + m))%Z. rewrite Fv, Sum, bp_add, minus_IZR, mult_IZR. rewrite bp_1. split; [ring|].
      assert (H : Rabs (RN (a + b) - (a + b)) <= bp e).
      { pose proof (error_le_half_ulp radix2 fexp even (a + b)) as P.
        change (round radix2 fexp (Znearest even) (a + b)) with (RN (a + b)) in P.
        rewrite ulp_neq_0 in P by (intro Z; rewrite Z, Rabs_R0 in S; pose proof (bp_pos (53 + e)); lra).
        rewrite C, bp_add in P. rewrite bp_1 in P. lra. }
      rewrite Fv, Sum, bp_add in H. rewrite bp_1 in H.
      replace (IZR v * (bp e * 2) - IZR (k + m) * bp e) with (IZR (2 * v - (k + m)) * bp e) in H
        by (rewrite minus_IZR, mult_IZR; ring).
      rewrite Rabs_mult, (Rabs_pos_eq (bp e)) in H by apply Rlt_le, bp_pos.
      assert (Rabs (IZR (2 * v - (k + m))) <= 1) by (apply Rmult_le_reg_r with (bp e); [apply bp_pos | lra]).
      rewrite <- abs_IZR in H0. apply le_IZR in H0. exact H0. }
  destruct D as (n & Dn & Hn).
  assert (V : RN (a + b) - a = IZR (m + n) * bp e) by (rewrite plus_IZR; lra).
  assert (Fz : F (RN (a + b) - a)).
  { rewrite V. apply multiple_F; [assumption|]. rewrite Rabs_mult, (Rabs_pos_eq (bp e)), bp_add by apply Rlt_le, bp_pos.
    apply Rmult_le_compat_r; [apply Rlt_le, bp_pos|]. rewrite Kb, Rabs_mult, (Rabs_pos_eq (bp e)), bp_add in Be by
      apply Rlt_le, bp_pos.
    apply Rmult_lt_reg_r in Be; [|apply bp_pos]. rewrite <- abs_IZR in *.
    replace (bp 53) with (IZR (2 ^ 53)) in * by (simpl; lra).
    apply lt_IZR in Be. apply IZR_le. lia. }
  unfold fast_two_sum_error. rewrite (RN_id _ Fz). rewrite (RN_id (b - (RN (a + b) - a))); [ring|].
  replace (b - (RN (a + b) - a)) with (IZR (- n) * bp e) by (rewrite opp_IZR; lra).
  apply multiple_F; [assumption|]. rewrite Rabs_mult, (Rabs_pos_eq (bp e)), bp_add by apply Rlt_le, bp_pos.
  apply Rmult_le_compat_r; [apply Rlt_le, bp_pos|]. rewrite <- abs_IZR.
  replace (bp 53) with (IZR (2 ^ 53)) by (simpl; lra).
  apply IZR_le. lia.
Qed.

(* two_prod(a, b): the error by one fused operation, or by Dekker's algorithm with Veltkamp's splitting. *)
Definition fused_error a b := RN (a * b - RN (a * b)).
Definition high a := let s := RN (a * (bp 27 + 1)) in RN (s - RN (s - a)).
Definition split_error a b :=
  let a_high := high a in let a_low := RN (a - a_high) in let b_high := high b in let b_low := RN (b - b_high) in
  RN (RN (RN (RN (RN (a_high * b_high) - RN (a * b)) + RN (a_high * b_low)) + RN (a_low * b_high)) + RN (a_low *
    b_low)).

(* From here on a product has its error as a double. *)
Definition LEAST_PRODUCT := bp (-968).

Lemma fused : forall a b, F a -> F b -> a * b = 0 \/ bp (-969) <= Rabs (a * b) -> RN (a * b) + fused_error a b = a * b.
Proof.
  intros a b Fa Fb H. unfold fused_error. rewrite (RN_id (a * b - RN (a * b))); [ring|].
  replace (a * b - RN (a * b)) with (- (RN (a * b) - a * b)) by ring. apply F_opp.
  apply (mult_error_FLT radix2 (-1074) 53 (Znearest even)); auto. intro N. destruct H; [contradiction | assumption].
Qed.
Lemma fused_any : forall a b, F a -> F b -> Rabs (RN (a * b) + fused_error a b - a * b) <= 4 * bp (-1074).
Proof.
  intros a b Fa Fb. pose proof (bp_pos (-1074)). destruct (Rle_or_lt (bp (-969)) (Rabs (a * b))) as [L|L].
  - rewrite fused by auto. replace (a * b - a * b) with 0 by ring. rewrite Rabs_R0. lra.
  - unfold fused_error. set (d := a * b - RN (a * b)). 
    replace (RN (a * b) + RN d - a * b) with (RN d - d) by (unfold d; ring).
    eapply Rle_trans; [apply RN_err|]. assert (Rabs d <= u * bp (-969) + bp (-1075)).
    { unfold d. rewrite Rabs_minus_sym. eapply Rle_trans; [apply RN_err|]. apply Rplus_le_compat_r.
      apply Rmult_le_compat_l; [apply Rlt_le, u_pos | lra]. }
    assert (u * (u * bp (-969)) <= bp (-1074)) by (unfold u; rewrite <- !bp_add; apply bp_le; lia).
    assert (bp (-1075) <= bp (-1074)) by (apply bp_le; lia). pose proof (bp_pos (-1075)).
    assert (u * Rabs d <= u * (u * bp (-969) + bp (-1075))) by (apply Rmult_le_compat_l;
      [apply Rlt_le, u_pos | assumption]).
    assert (u * bp (-1075) <= 1 * bp (-1075)) by (apply Rmult_le_compat_r; [lra | rewrite u_val; lra]). lra.
Qed.
Lemma split : forall a b, F a -> F b ->
  (a * b = 0 \/ bp (-969) <= Rabs (a * b) -> RN (a * b) + split_error a b = a * b) /\
  Rabs (RN (a * b) + split_error a b - a * b) <= 4 * bp (-1074).
Proof.
  intros a b Fa Fb. pose proof (Dekker radix2 (-1074) 53 even ltac:(lia) ltac:(lia) a b Fa Fb ltac:(left;
    reflexivity)) as [D1 D2].
  assert (H : forall x, RN (RN (x - RN (x * (bp 27 + 1))) + RN (x * (bp 27 + 1))) = high x).
  { intro x. unfold high. f_equal. replace (x - RN (x * (bp 27 + 1))) with (- (RN (x * (bp 27 + 1)) - x)) by ring.
    rewrite RN_opp. ring. }
  change (round radix2 (FLT_exp (-1074) 53) (Znearest even)) with RN in *.
  change (53 - Z.div2 53)%Z with 27%Z in *. rewrite !H in D1, D2.
  assert (E : RN (RN (RN (RN (- RN (a * b) + RN (high a * high b)) + RN (high a * RN (b - high b))) + RN (RN (a - high
    a) * high b))
    + RN (RN (a - high a) * RN (b - high b))) = split_error a b).
  { unfold split_error. do 7 f_equal. ring. }
  rewrite E in D1, D2. split.
  - intro Z. symmetry. now apply D1.
  - rewrite Rabs_minus_sym. eapply Rle_trans; [exact D2|]. pose proof (bp_pos (-1074)). lra.
Qed.
(* The error is exact, with the same bits either way, where the product is zero or at least LEAST_PRODUCT. *)
Theorem LEAST_PRODUCT_holds : forall a b, F a -> F b -> a * b = 0 \/ LEAST_PRODUCT <= Rabs (a * b) ->
  RN (a * b) + fused_error a b = a * b /\ split_error a b = fused_error a b.
Proof.
  intros a b Fa Fb H. assert (H' : a * b = 0 \/ bp (-969) <= Rabs (a * b)).
  { destruct H as [H|H]; [now left | right]. eapply Rle_trans; [|exact H]. apply bp_le. lia. }
  pose proof (fused a b Fa Fb H'). destruct (split a b Fa Fb) as [S _]. specialize (S H'). split; lra.
Qed.
(* Below, it is wrong by less than 2^-1071, either way. *)
Theorem below_least_product : forall a b, F a -> F b ->
  Rabs (RN (a * b) + fused_error a b - a * b) < bp (-1071) /\ Rabs (RN (a * b) + split_error a b - a * b) < bp (-1071).
Proof.
  intros a b Fa Fb. destruct (split a b Fa Fb) as [_ S]. pose proof (fused_any a b Fa Fb) as P.
  assert (bp (-1071) = 8 * bp (-1074)) by (change (-1071)%Z with (3 + -1074)%Z; rewrite bp_add; simpl (bp 3); lra).
  pose proof (bp_pos (-1074)). lra.
Qed.

(* remainder(z, x, y): z - x y rounded once, if z - RN(x y) is exact. *)
Theorem remainder : forall z x y, F x -> F y -> F (z - RN (x * y)) -> x * y = 0 \/ LEAST_PRODUCT <= Rabs (x * y) ->
  RN (RN (z - RN (x * y)) - split_error x y) = RN (z - x * y).
Proof.
  intros z x y Fx Fy Fz H. destruct (LEAST_PRODUCT_holds x y Fx Fy H) as [E S]. rewrite (RN_id _ Fz), S. f_equal. lra.
Qed.
