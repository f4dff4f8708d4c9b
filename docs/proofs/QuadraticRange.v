(* rt-math, quadratic.rs: where double-double needs no scaling, and coefficients of very different size. *)
From Proofs Require Import Rounding ErrorFree DoubleDouble Steps.
From Flocq Require Import Mult_error.
From Coq Require Import Znumtheory Zpow_facts.
Open Scope R_scope.

(* The sizes of coefficients that are taken as they are. *)
Definition ORDINARY_LEAST := bp (-256).
Definition ORDINARY_END := bp 256.
(* The exponent of the middle coefficient of the balanced equation up to which it counts, and from which it rules. *)
Definition LOPSIDED := 200%Z.

Lemma multiple_of : forall x k, F x -> (-1022 <= k)%Z -> x = 0 \/ bp k <= Rabs x -> exists m, x = IZR m * bp (k - 52).
Proof.
  intros x k Fx K [Z|H].
  - exists 0%Z. rewrite Z. simpl. ring.
  - apply multiple; [assumption|]. assert (k < mag radix2 x)%Z.
    { apply (lt_bpow radix2). eapply Rle_lt_trans; [exact H|]. apply bpow_mag_gt. }
    unfold cexp, fexp, FLT_exp. lia.
Qed.
Lemma multiple_zero : forall m k, IZR m * bp k = 0 \/ bp k <= Rabs (IZR m * bp k).
Proof.
  intros m k. destruct (Req_dec (IZR m * bp k) 0) as [Z|N]; [now left | right; now apply multiple_least].
Qed.

(* Both products are exact, and the discriminant is zero or at least 2^-616: far above what a root of it needs. *)
Theorem ORDINARY_LEAST_holds : forall a b c, F a -> F b -> F c ->
  ORDINARY_LEAST <= Rabs a -> b = 0 \/ ORDINARY_LEAST <= Rabs b -> ORDINARY_LEAST <= Rabs c ->
  (b * b = 0 \/ LEAST_PRODUCT <= Rabs (b * b)) /\ LEAST_PRODUCT <= Rabs (4 * a * c) /\
  (b * b - 4 * a * c = 0 \/ bp (-616) <= Rabs (b * b - 4 * a * c)) /\
  forall h l, dd h l -> Rabs (h + l - (b * b - 4 * a * c)) <= SUM * (u * u) * Rabs (b * b - 4 * a * c) ->
    (h < 0 -> b * b - 4 * a * c < 0) /\ (h = 0 -> b * b - 4 * a * c = 0) /\
    (0 < h -> 0 < b * b - 4 * a * c /\ bp (-800) <= h).
Proof.
  intros a b c Fa Fb Fc A B C. unfold ORDINARY_LEAST in *.
  assert (P : bp (-512) <= Rabs (a * c)).
  { rewrite Rabs_mult. change (-512)%Z with (-256 + -256)%Z. rewrite bp_add. pose proof (bp_pos (-256)).
    apply Rmult_le_compat; lra. }
  assert (D : b * b - 4 * a * c = 0 \/ bp (-616) <= Rabs (b * b - 4 * a * c)).
  { destruct (multiple_of a (-256) Fa ltac:(lia) (or_intror A)) as [i I].
    destruct (multiple_of b (-256) Fb ltac:(lia) B) as [j J].
    destruct (multiple_of c (-256) Fc ltac:(lia) (or_intror C)) as [k K].
    change (-256 - 52)%Z with (-308)%Z in *.
    replace (b * b - 4 * a * c) with (IZR (j * j - 4 * i * k) * bp (-616)); [apply multiple_zero|].
    change (-616)%Z with (-308 + -308)%Z. rewrite bp_add, minus_IZR, !mult_IZR, I, J, K. ring. }
  split; [|split; [|split; [exact D|]]].
  - destruct B as [B|B]; [left; rewrite B; ring | right]. apply Rle_trans with (bp (-256 + -256)).
    + apply bp_le. lia.
    + rewrite bp_add, Rabs_mult. pose proof (bp_pos (-256)). apply Rmult_le_compat; lra.
  - rewrite Rmult_assoc, Rabs_mult, (Rabs_pos_eq 4) by lra. unfold LEAST_PRODUCT.
    assert (bp (-968) <= bp (-512)) by (apply bp_le; lia). pose proof (Rabs_pos (a * c)). lra.
  - intros h l N E. set (d := b * b - 4 * a * c) in *. clearbody d. pose proof (dd_low _ _ N) as L. unfold SUM in E.
    pose proof (bp_pos (-616)). assert (bp (-616) >= 1000 * bp (-800)).
    { change (-616)%Z with (184 + -800)%Z. rewrite bp_add. pose proof (bp_pos (-800)).
      assert (1000 <= bp 184) by (apply Rle_trans with (bp 10); [simpl; lra | apply bp_le; lia]). nra. }
    pose proof (Rabs_triang_inv (h + l) d) as T1. pose proof (Rabs_triang_inv d (h + l)) as T2.
    rewrite (Rabs_minus_sym d) in T2. pose proof (Rabs_triang_inv h (- l)) as T3.
    pose proof (Rabs_triang h l) as T4. replace (h - - l) with (h + l) in T3 by ring. rewrite Rabs_Ropp in T3.
    destruct D as [D|D].
    { rewrite D, Rabs_R0 in *. pose proof (Rabs_pos h). assert (Rabs h <= 0) by (rewrite u_val in *; lra).
      assert (h = 0) by (destruct (Req_dec h 0) as [Z|Z]; [exact Z | pose proof (Rabs_pos_lt h Z); lra]).
      repeat split; intros; lra. }
    pose proof (Rabs_pos h). apply Rabs_le_inv in E. apply Rabs_le_inv in L.
    repeat split; intros; unfold Rabs in *; destruct (Rcase_abs d), (Rcase_abs h); rewrite u_val in *; lra.
Qed.
(* Nothing overflows, and both quotients are normal. *)
Theorem ORDINARY_END_holds : forall a b c, ORDINARY_LEAST <= Rabs a < ORDINARY_END -> Rabs b < ORDINARY_END ->
  ORDINARY_LEAST <= Rabs c < ORDINARY_END -> bp (-616) <= b * b - 4 * a * c ->
  let z := Rabs b + sqrt (b * b - 4 * a * c) in
  b * b - 4 * a * c < bp 515 /\ bp (-308) <= z <= bp 259 /\
  bp (-565) <= z / (2 * Rabs a) <= bp 565 /\ bp (-565) <= 2 * Rabs c / z <= bp 565.
Proof.
  intros a b c [A1 A2] B [C1 C2] D z. unfold ORDINARY_LEAST, ORDINARY_END in *.
  pose proof (bp_pos 256) as P. pose proof (bp_pos (-256)). set (d := b * b - 4 * a * c) in *.
  assert (B2 : b * b <= bp 512).
  { change 512%Z with (256 + 256)%Z. rewrite bp_add, <- abs_sq. pose proof (Rabs_pos b). apply Rmult_le_compat; lra. }
  assert (AC : Rabs (4 * a * c) < 4 * bp 512).
  { rewrite Rmult_assoc, Rabs_mult, (Rabs_pos_eq 4), Rabs_mult by lra. change 512%Z with (256 + 256)%Z. rewrite bp_add.
    pose proof (Rabs_pos a). pose proof (Rabs_pos c). apply Rmult_lt_compat_l; [lra|].
    apply Rmult_le_0_lt_compat; lra. }
  pose proof (bp_pos 512). assert (F0 : bp 515 = 8 * bp 512)
    by (change 515%Z with (3 + 512)%Z; rewrite bp_add; simpl (bp 3); lra).
  assert (D2 : d < bp 515) by (unfold d; pose proof (Rle_abs (- (4 * a * c))) as Q; rewrite Rabs_Ropp in Q; lra).
  pose proof (bp_pos (-616)).
  assert (R1 : bp (-308) <= sqrt d).
  { apply below_root; [apply sqrt_pos|]. rewrite sqrt_sqrt by lra. now rewrite bp_sq. }
  assert (R2 : sqrt d <= bp 258).
  { apply below_root; [apply Rlt_le, bp_pos|]. rewrite sqrt_sqrt, bp_sq by lra.
    assert (bp 515 <= bp (258 + 258)) by (apply bp_le; lia). lra. }
  assert (F1 : bp 258 = 4 * bp 256) by (change 258%Z with (2 + 256)%Z; rewrite bp_add; simpl (bp 2); lra).
  assert (F2 : bp 259 = 8 * bp 256) by (change 259%Z with (3 + 256)%Z; rewrite bp_add; simpl (bp 3); lra).
  pose proof (Rabs_pos b). pose proof (bp_pos (-308)).
  assert (Z : bp (-308) <= z <= bp 259) by (unfold z; lra).
  assert (Q : forall x y i j k l, 0 < y -> bp i <= x <= bp j -> bp k <= y <= bp l -> (i - l >= -565)%Z ->
    (j - k <= 565)%Z -> bp (-565) <= x / y <= bp 565).
  { intros x y i j k l Y [X1 X2] [Y1 Y2] I J. pose proof (bp_pos (-565)). pose proof (bp_pos 565).
    split; apply Rmult_le_reg_r with y; try assumption; unfold Rdiv; rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra.
    - apply Rle_trans with (bp (-565) * bp l); [apply Rmult_le_compat_l; lra|]. rewrite <- bp_add.
      apply Rle_trans with (bp i); [apply bp_le; lia | lra].
    - apply Rle_trans with (bp 565 * bp k); [|apply Rmult_le_compat_l; lra]. rewrite <- bp_add.
      apply Rle_trans with (bp j); [lra | apply bp_le; lia]. }
  assert (G1 : bp 257 = 2 * bp 256) by (change 257%Z with (1 + 256)%Z; rewrite bp_add, bp_1; ring).
  assert (G2 : bp (-255) = 2 * bp (-256)) by (change (-255)%Z with (1 + -256)%Z; rewrite bp_add, bp_1; ring).
  split; [exact D2|]. split; [exact Z|]. split.
  - apply (Q z (2 * Rabs a) (-308)%Z 259%Z (-255)%Z 257%Z); try lra; try lia.
  - apply (Q (2 * Rabs c) z (-255)%Z 257%Z (-308)%Z 259%Z); try lra; try lia.
Qed.

(* ---- A quotient of two doubles is a double or far from every midpoint. ---- *)
Lemma odd_power : forall m k, (0 <= k)%Z -> rel_prime (2 * m + 1) (2 ^ k).
Proof.
  intros m k K. apply rel_prime_Zpower_r; [assumption|]. apply rel_prime_sym. apply prime_rel_prime; [apply prime_2|].
  intros [j J]. lia.
Qed.
(* m is a midpoint of 54 bits or more *)
Lemma far_from_midpoint : forall n d k f, F n -> F d -> n <> 0 -> d <> 0 -> (2 ^ 52 <= k < 2 ^ 53)%Z -> 0 < n / d ->
  let m := IZR (2 * k + 1) * bp f in bp (-110) * (n / d) < Rabs (n / d - m).
Proof.
  intros n d k f Fn Fd N0 D0 K Q0 m. destruct (Rlt_or_le (bp (-110) * (n / d)) (Rabs (n / d - m))) as [L|L]; [exact
    L|exfalso].
  assert (G : forall x, F x -> x <> 0 -> exists i e, x = IZR i * bp e /\ (0 < Z.abs i < 2 ^ 53)%Z).
  { intros x Fx X0. exists (Ztrunc (scaled_mantissa radix2 fexp x)), (cexp radix2 fexp x). split; [exact Fx|].
    set (i := Ztrunc (scaled_mantissa radix2 fexp x)).
    assert (E : x = IZR i * bp (cexp radix2 fexp x)) by exact Fx.
    split; [assert (i <> 0%Z) by (intro Z; rewrite Z in E; simpl in E; lra); lia|].
    apply lt_IZR. rewrite abs_IZR. replace (IZR (2 ^ 53)) with (bp 53) by (simpl; lra).
    apply Rmult_lt_reg_r with (bp (cexp radix2 fexp x)); [apply bp_pos|].
    rewrite <- (Rabs_pos_eq (bp (cexp radix2 fexp x))) at 1 by apply Rlt_le, bp_pos. rewrite <- Rabs_mult, <- E, <-
      bp_add.
    eapply Rlt_le_trans; [apply (bpow_mag_gt radix2)|]. apply bp_le. unfold cexp, fexp, FLT_exp. lia. }
  destruct (G n Fn N0) as (i & a & En & Hi). destruct (G d Fd D0) as (j & b & Ed & Hj). clear G.
  set (M := (2 * k + 1)%Z) in *. set (g := Z.min a (f + b)).
  assert (B : forall e, (g <= e)%Z -> IZR (2 ^ (e - g)) * bp g = bp e).
  { intros e E. change 2%Z with (radix_val radix2). rewrite IZR_Zpower by lia. rewrite <- bp_add. f_equal. ring. }
  set (z := (i * 2 ^ (a - g) - M * j * 2 ^ (f + b - g))%Z).
  assert (Ez : n - m * d = IZR z * bp g).
  { unfold z, m. rewrite minus_IZR, !mult_IZR, Rmult_minus_distr_r, !Rmult_assoc, !B by lia.
    rewrite En, Ed, bp_add. unfold M. ring. }
  assert (Z0 : z <> 0%Z).
  { intro Z. assert (H : (i * 2 ^ (a - g) = M * (j * 2 ^ (f + b - g)))%Z) by (unfold z in Z; lia).
    assert (Dv : (M | i)%Z).
    { apply Gauss with (2 ^ (a - g))%Z.
      - exists (j * 2 ^ (f + b - g))%Z. rewrite Z.mul_comm, H. ring.
      - apply odd_power. lia. }
    destruct Dv as [w W]. assert (w <> 0)%Z by (intro; subst w; lia). nia. }
  assert (LZ : bp g <= Rabs (n - m * d)).
  { rewrite Ez. apply multiple_least. rewrite <- Ez. rewrite Ez. apply Rmult_integral_contrapositive. split.
    - now apply not_0_IZR.
    - pose proof (bp_pos g). lra. }
  pose proof (Rabs_pos_lt d D0) as D1.
  assert (E1 : Rabs (n / d - m) * Rabs d = Rabs (n - m * d)).
  { rewrite <- Rabs_mult. f_equal. field. assumption. }
  assert (E2 : n / d * Rabs d = Rabs n).
  { rewrite <- (Rabs_pos_eq (n / d)) by lra. rewrite <- Rabs_mult. f_equal. field. assumption. }
  set (q := n / d) in *. assert (L2 : bp g <= bp (-110) * Rabs n).
  { eapply Rle_trans; [exact LZ|]. rewrite <- E1, <- E2, <- Rmult_assoc. apply Rmult_le_compat_r; lra. }
  assert (I1 : Rabs (IZR i) < bp 53).
  { rewrite <- abs_IZR. replace (bp 53) with (IZR (2 ^ 53)) by (simpl; lra). apply IZR_lt. lia. }
  assert (J1 : Rabs (IZR j) < bp 53).
  { rewrite <- abs_IZR. replace (bp 53) with (IZR (2 ^ 53)) by (simpl; lra). apply IZR_lt. lia. }
  destruct (Z.min_spec a (f + b)) as [[_ E]|[_ E]]; fold g in E.
  - rewrite En, Rabs_mult, (Rabs_pos_eq (bp a)) in L2 by apply Rlt_le, bp_pos. rewrite E in L2.
    assert (bp (-110) * bp 53 <= 1) by (rewrite <- bp_add; apply Rle_trans with (bp 0); [apply bp_le; lia | simpl;
      lra]).
    pose proof (bp_pos a). pose proof (bp_pos (-110)).
    assert (bp (-110) * Rabs (IZR i) < 1).
    { apply Rlt_le_trans with (bp (-110) * bp 53); [apply Rmult_lt_compat_l|]; lra. }
    assert (bp (-110) * Rabs (IZR i) * bp a < 1 * bp a) by (apply Rmult_lt_compat_r; lra). lra.
  - (* q is at most twice m, and m at most 2^54 2^f *)
    assert (QM : q <= 2 * m).
    { assert (bp (-110) <= / 2) by (apply Rle_trans with (bp (-1)); [apply bp_le; lia | simpl; lra]).
      assert (bp (-110) * q <= / 2 * q) by (apply Rmult_le_compat_r; lra). apply Rabs_le_inv in L. lra. }
    assert (MM : m <= bp (54 + f)).
    { unfold m, M. rewrite bp_add. apply Rmult_le_compat_r; [apply Rlt_le, bp_pos|].
      replace (bp 54) with (IZR (2 ^ 54)) by (simpl; lra). apply IZR_le. lia. }
    rewrite <- E2 in L2. rewrite E in L2. rewrite Ed, Rabs_mult, (Rabs_pos_eq (bp b)) in L2 by apply Rlt_le, bp_pos.
    assert (L3 : bp (-110) * (q * (Rabs (IZR j) * bp b)) < bp (-110) * (bp (55 + f) * (bp 53 * bp b))).
    { pose proof (bp_pos b). apply Rmult_lt_compat_l; [apply bp_pos|].
      assert (0 < Rabs (IZR j)) by (apply Rabs_pos_lt, not_0_IZR; lia).
      assert (q <= bp (55 + f)).
      { replace (55 + f)%Z with (1 + (54 + f))%Z by ring. rewrite bp_add, bp_1. lra. }
      apply Rle_lt_trans with (bp (55 + f) * (Rabs (IZR j) * bp b)).
      - apply Rmult_le_compat_r; [|assumption]. apply Rmult_le_pos; lra.
      - apply Rmult_lt_compat_l; [apply bp_pos|]. apply Rmult_lt_compat_r; assumption. }
    rewrite <- !bp_add in L3. assert (bp (-110 + (55 + f + (53 + b))) <= bp (f + b)) by (apply bp_le; lia). lra.
Qed.
(* A double of at least 2^-1022 and its successor have such a midpoint. *)
Lemma midpoint : forall r, F r -> bp (-1022) <= r ->
  exists k f, (2 ^ 52 <= k < 2 ^ 53)%Z /\ (r + succ radix2 fexp r) / 2 = IZR (2 * k + 1) * bp f.
Proof.
  intros r Fr H. pose proof (bp_pos (-1022)). set (e := cexp radix2 fexp r).
  set (k := Ztrunc (scaled_mantissa radix2 fexp r)). assert (E : r = IZR k * bp e) by exact Fr.
  assert (M : (-1022 < mag radix2 r)%Z).
  { apply (lt_bpow radix2). eapply Rle_lt_trans; [exact H|]. eapply Rle_lt_trans; [apply Rle_abs|]. apply bpow_mag_gt. }
  assert (Ee : e = (mag radix2 r - 53)%Z) by (unfold e, cexp, fexp, FLT_exp; lia).
  pose proof (bpow_mag_gt radix2 r) as U. rewrite Rabs_pos_eq in U by lra.
  pose proof (bpow_mag_le radix2 r ltac:(lra)) as L. rewrite Rabs_pos_eq in L by lra. exists k, (e - 1)%Z. split.
  - split.
    + apply le_IZR. apply Rmult_le_reg_r with (bp e); [apply bp_pos|]. rewrite <- E.
      replace (IZR (2 ^ 52)) with (bp 52) by (simpl; lra). rewrite <- bp_add, Ee.
      replace (52 + (mag radix2 r - 53))%Z with (mag radix2 r - 1)%Z by ring. exact L.
    + apply lt_IZR. apply Rmult_lt_reg_r with (bp e); [apply bp_pos|]. rewrite <- E.
      replace (IZR (2 ^ 53)) with (bp 53) by (simpl; lra). rewrite <- bp_add, Ee.
      replace (53 + (mag radix2 r - 53))%Z with (mag radix2 r : Z) by ring. exact U.
  - rewrite succ_eq_pos, ulp_neq_0 by lra. fold e. assert (H2 : bp e = 2 * bp (e - 1)).
    { rewrite <- bp_1, <- bp_add. f_equal. ring. }
    rewrite E, H2, plus_IZR, mult_IZR. field.
Qed.
(* So what is near such a quotient rounds as it does, above the least normal double. *)
Lemma rounds_alike_pos : forall n d x, F n -> F d -> d <> 0 -> 0 < n / d -> bp (-1022) < RN (n / d) ->
  Rabs (x - n / d) <= bp (-110) * (n / d) -> RN x = RN (n / d).
Proof.
  intros n d x Fn Fd D0 Q0 L H. assert (N0 : n <> 0) by (intro Z; rewrite Z in Q0; unfold Rdiv in Q0; lra).
  set (q := n / d) in *. set (r := RN q) in *. assert (Fr : F r) by apply RN_F.
  destruct (Rtotal_order (RN x) r) as [C|[C|C]]; [|exact C|]; exfalso.
  - (* x is below the midpoint under r, q is not *)
    set (p := pred radix2 fexp r). pose proof (bp_pos (-1022)).
    assert (Fp : F p) by (apply generic_format_pred; auto with typeclass_instances).
    assert (P : bp (-1022) <= p) by (apply pred_ge_gt; auto with typeclass_instances; apply F_bp; lia).
    assert (S : succ radix2 fexp p = r) by (apply succ_pred; auto with typeclass_instances).
    destruct (midpoint p Fp P) as (k & f & K & M). rewrite S in M.
    pose proof (far_from_midpoint n d k f Fn Fd N0 D0 K Q0) as G. cbv zeta in G. rewrite <- M in G. fold q in G.
    assert (x <= (p + r) / 2).
    { apply Rnot_lt_le. intro N. assert (r <= RN x); [|lra].
      apply (round_N_ge_midp radix2 fexp even); auto. fold p. lra. }
    assert ((p + r) / 2 <= q).
    { apply Rnot_lt_le. intro N. pose proof (pred_lt_id radix2 fexp r ltac:(lra)) as PL.
      fold p in PL. assert (HN : RN q <= p); [|fold r in HN; lra].
      apply (round_N_le_midp radix2 fexp even); auto. rewrite S. lra. }
    apply Rabs_le_inv in H. rewrite Rabs_pos_eq in G by lra. lra.
  - destruct (midpoint r Fr ltac:(lra)) as (k & f & K & M).
    pose proof (far_from_midpoint n d k f Fn Fd N0 D0 K Q0) as G. cbv zeta in G. rewrite <- M in G. fold q in G.
    set (s := succ radix2 fexp r) in *.
    assert (Fs : F s) by (apply generic_format_succ; auto with typeclass_instances).
    assert ((r + s) / 2 <= x).
    { apply Rnot_lt_le. intro N. assert (RN x <= r); [|lra]. apply (round_N_le_midp radix2 fexp even); auto. }
    assert (q <= (r + s) / 2).
    { apply Rnot_lt_le. intro N. assert (HN : s <= RN q).
      - apply (round_N_ge_midp radix2 fexp even); auto. unfold s. rewrite pred_succ by auto with typeclass_instances.
        fold s. lra.
      - pose proof (bp_pos (-1022)). pose proof (succ_gt_id radix2 fexp r ltac:(lra)) as SG. fold s in SG. fold r in
        HN. lra. }
    apply Rabs_le_inv in H. rewrite Rabs_minus_sym, Rabs_pos_eq in G by lra. lra.
Qed.
Lemma rounds_alike : forall n d x, F n -> F d -> d <> 0 -> bp (-1022) < Rabs (RN (n / d)) ->
  Rabs (x - n / d) <= bp (-110) * Rabs (n / d) -> RN x = RN (n / d).
Proof.
  intros n d x Fn Fd D0 L H. pose proof (bp_pos (-1022)). destruct (Rtotal_order (n / d) 0) as [C|[C|C]].
  - assert (E : - (n / d) = - n / d) by (field; assumption).
    assert (RN (n / d) <= 0) by (rewrite <- RN_0; apply RN_le; lra).
    rewrite Rabs_left1 in L by assumption. rewrite (Rabs_left (n / d)) in H by assumption.
    assert (G : RN (- x) = RN (- n / d)); [|rewrite <- E, !RN_opp in G; lra].
    apply rounds_alike_pos; auto using F_opp; rewrite <- E; rewrite ?RN_opp; try lra.
    replace (- x - - (n / d)) with (- (x - n / d)) by ring. now rewrite Rabs_Ropp.
  - rewrite C, RN_0, Rabs_R0 in L. lra.
  - assert (0 <= RN (n / d)) by (rewrite <- RN_0; apply RN_le; lra).
    rewrite Rabs_pos_eq in L by assumption. rewrite (Rabs_pos_eq (n / d)) in H by lra. now apply rounds_alike_pos.
Qed.

(* ---- Coefficients of very different size ---- *)
Lemma LOPSIDED_middle : forall a b c j, F a -> F b -> F c -> / 2 <= Rabs a < 2 -> b = 0 \/ 1 <= Rabs b < 2 ->
  1 <= Rabs c < 2 -> (Z.abs j <= LOPSIDED)%Z -> let B := b * bp j in
  F B /\ (B * B = 0 \/ LEAST_PRODUCT <= Rabs (B * B)) /\ LEAST_PRODUCT <= Rabs (4 * a * c) /\ Rabs B <= bp 201 /\
  (B * B - 4 * a * c = 0 \/ bp (-616) <= Rabs (B * B - 4 * a * c)).
Proof.
  intros a b c j Fa Fb Fc A B C J B'. unfold LOPSIDED in J.
  assert (H1 : bp (-1) = / 2) by (simpl; lra). assert (H2 : bp 0 = 1) by reflexivity.
  destruct (multiple_of a (-1) Fa ltac:(lia) ltac:(right; lra)) as [k K].
  destruct (multiple_of b 0 Fb ltac:(lia) ltac:(destruct B; [now left | right; lra])) as [l L].
  destruct (multiple_of c 0 Fc ltac:(lia) ltac:(right; lra)) as [m M].
  change (-1 - 52)%Z with (-53)%Z in K. change (0 - 52)%Z with (-52)%Z in *.
  assert (EB : B' = IZR (l * 2 ^ (j + 200)) * bp (-252)).
  { unfold B'. rewrite L, mult_IZR. change 2%Z with (radix_val radix2) at 1. rewrite IZR_Zpower by lia.
    rewrite !Rmult_assoc, <- !bp_add. do 2 f_equal. ring. }
  assert (BL : Rabs B' <= bp 201).
  { unfold B'. rewrite Rabs_mult, (Rabs_pos_eq (bp j)) by apply Rlt_le, bp_pos. change 201%Z with (1 + 200)%Z.
    rewrite bp_add, bp_1. apply Rmult_le_compat; [apply Rabs_pos | apply Rlt_le, bp_pos | | apply bp_le; lia].
    destruct B as [B|B]; [rewrite B, Rabs_R0|]; lra. }
  split; [|split; [|split; [|split; [exact BL|]]]].
  - unfold B'. destruct B as [B|B]; [rewrite B, Rmult_0_l; apply F_0|]. apply mult_bpow_exact_FLT; [exact Fb|].
    assert (0 < mag radix2 b)%Z; [|lia]. apply (lt_bpow radix2). eapply Rle_lt_trans; [|apply bpow_mag_gt].
    rewrite H2. lra.
  - destruct B as [B|B]; [left; unfold B'; rewrite B; ring | right]. unfold LEAST_PRODUCT.
    apply Rle_trans with (bp (-200 + -200)); [apply bp_le; lia|]. rewrite bp_add, Rabs_mult. pose proof (bp_pos (-200)).
    assert (bp (-200) <= Rabs B').
    { unfold B'. rewrite Rabs_mult, (Rabs_pos_eq (bp j)) by apply Rlt_le, bp_pos. rewrite <- (Rmult_1_l (bp (-200))).
      apply Rmult_le_compat; try lra. apply bp_le. lia. }
    apply Rmult_le_compat; lra.
  - rewrite Rmult_assoc, Rabs_mult, (Rabs_pos_eq 4), Rabs_mult by lra. unfold LEAST_PRODUCT.
    apply Rle_trans with (bp 0); [apply bp_le; lia | rewrite H2].
    assert (/ 2 * 1 <= Rabs a * Rabs c) by (apply Rmult_le_compat; lra). lra.
  - (* a multiple of 2^-504 *)
    assert (D : B' * B' - 4 * a * c = IZR (l * 2 ^ (j + 200) * (l * 2 ^ (j + 200)) - 4 * k * m * 2 ^ 399) * bp (-504)).
    { rewrite EB, K, M, minus_IZR, !mult_IZR. change (2 ^ 399)%Z with (radix2 ^ 399)%Z. rewrite (IZR_Zpower radix2
      399) by lia.
      replace (4 * (IZR k * bp (-53)) * (IZR m * bp (-52))) with (4 * IZR k * IZR m * (bp (-53) * bp (-52))) by ring.
      rewrite <- bp_add. change (-53 + -52)%Z with (399 + -504)%Z. rewrite bp_add.
      change (-504)%Z with (-252 + -252)%Z. rewrite bp_add. ring. }
    rewrite D. destruct (multiple_zero (l * 2 ^ (j + 200) * (l * 2 ^ (j + 200)) - 4 * k * m * 2 ^ 399) (-504)) as [Z|Z];
      [now left | right]. eapply Rle_trans; [|exact Z]. apply bp_le. lia.
Qed.
(* A middle coefficient below 2^-199: no root, or two that are +-sqrt (-c/a) within a part of 2^-199 of them. *)
Lemma LOPSIDED_small : forall a B c, / 2 <= Rabs a -> Rabs B < bp (1 - (LOPSIDED + 1)) -> 1 <= Rabs c ->
  (0 < a * c -> B * B - 4 * a * c < 0) /\
  (a * c < 0 -> let r := sqrt (- c / a) in forall s, s = 1 \/ s = -1 ->
     Rabs ((- B + s * sqrt (B * B - 4 * a * c)) / (2 * Rabs a) - s * r) <= bp (-199) * r).
Proof.
  intros a B c A HB C. change (1 - (LOPSIDED + 1))%Z with (-200)%Z in HB. pose proof (bp_pos (-200)).
  assert (F2 : bp (-199) = 2 * bp (-200)) by (change (-199)%Z with (1 + -200)%Z; rewrite bp_add, bp_1; ring).
  assert (B1 : bp (-200) <= / 1000000) by (apply Rle_trans with (bp (-20)); [apply bp_le; lia | simpl; lra]).
  assert (B2 : B * B <= bp (-200) * / 1000000).
  { rewrite <- abs_sq. apply Rmult_le_compat; try apply Rabs_pos; lra. }
  assert (AC : / 2 <= Rabs (a * c)).
  { rewrite Rabs_mult. assert (/ 2 * 1 <= Rabs a * Rabs c) by (apply Rmult_le_compat; lra). lra. }
  split.
  - intro P. rewrite Rabs_pos_eq in AC by lra. assert (bp (-200) * / 1000000 <= 1 * / 1000000) by (apply
    Rmult_le_compat_r; lra).
    lra.
  - intros N r s Hs. rewrite Rabs_left in AC by assumption.
    assert (A0 : a <> 0) by (intro Z; rewrite Z, Rmult_0_l in N; lra).
    assert (P : 0 < Rabs a) by (apply Rabs_pos_lt; assumption).
    set (m := -4 * (a * c)). assert (M0 : 2 <= m) by (unfold m; lra).
    replace (B * B - 4 * a * c) with (m + B * B) by (unfold m; ring).
    assert (R : r = sqrt m / (2 * Rabs a)).
    { unfold r. replace (- c / a) with (m / ((2 * Rabs a) * (2 * Rabs a))).
      - rewrite sqrt_div_alt by (apply Rmult_lt_0_compat; lra). rewrite sqrt_square by lra. reflexivity.
      - replace ((2 * Rabs a) * (2 * Rabs a)) with (4 * (Rabs a * Rabs a)) by ring. rewrite abs_sq. unfold m. field.
        assumption. }
    assert (S1 : 1 <= sqrt m) by (apply below_root; [apply sqrt_pos | rewrite sqrt_sqrt; lra]).
    pose proof (root_near m (m + B * B) ltac:(lra) ltac:(pose proof (sq_pos B); lra)) as Q.
    replace (m - (m + B * B)) with (- (B * B)) in Q by ring. rewrite Rabs_Ropp, (Rabs_pos_eq (B * B)) in Q by apply
      sq_pos.
    set (w := sqrt (m + B * B)) in *. set (v := sqrt m) in *.
    assert (Q2 : Rabs (v - w) <= bp (-200) * / 1000000).
    { pose proof (Rabs_pos (v - w)). assert (Rabs (v - w) * 1 <= Rabs (v - w) * v) by (apply Rmult_le_compat_l; lra).
      lra. }
    rewrite R. replace ((- B + s * w) / (2 * Rabs a) - s * (v / (2 * Rabs a))) with ((- B - s * (v - w)) / (2 * Rabs a))
      by (field; lra).
    apply Rabs_div_le; [lra|]. rewrite (Rabs_pos_eq (2 * Rabs a)) by lra.
    replace (bp (-199) * (v / (2 * Rabs a)) * (2 * Rabs a)) with (bp (-199) * v) by (field; lra).
    assert (H1 : Rabs (s * (v - w)) <= bp (-200) * / 1000000).
    { rewrite Rabs_mult. replace (Rabs s) with 1; [lra|]. destruct Hs as [Hs|Hs]; rewrite Hs; unfold Rabs; destruct
      Rcase_abs; lra. }
    assert (H2 : Rabs (- B - s * (v - w)) <= bp (-200) + bp (-200) * / 1000000).
    { apply Rabs_minus_le; [rewrite Rabs_Ropp; lra | exact H1]. }
    assert (bp (-199) * 1 <= bp (-199) * v) by (apply Rmult_le_compat_l; lra). lra.
Qed.
(* A middle coefficient from 2^201 on: two roots, each a quotient within a part of 2^-396, which round as these do. *)
Lemma LOPSIDED_large : forall a b c s, F a -> F b -> F c -> a <> 0 -> b <> 0 -> s * Rabs b = b ->
  Rabs (a * c) <= bp (2 - 2 * (LOPSIDED + 1)) * (b * b) ->
  let w := - (b + s * sqrt (b * b - 4 * a * c)) in
  0 < b * b - 4 * a * c /\ (bp (-1022) < Rabs (RN (- b / a)) -> RN (w / (2 * a)) = RN (- b / a)) /\
  (bp (-1022) < Rabs (RN (- c / b)) -> RN (2 * c / w) = RN (- c / b)).
Proof.
  intros a b c s Fa Fb Fc A0 B0 S H w. change (2 - 2 * (LOPSIDED + 1))%Z with (-400)%Z in H.
  assert (BB : 0 < b * b) by (destruct (Rlt_or_le 0 (b * b)); [assumption | pose proof (sq_pos b); nra]).
  set (e := a * c / (b * b)).
  assert (E : Rabs e <= bp (-400)).
  { unfold e. apply Rabs_div_le; [lra|]. now rewrite (Rabs_pos_eq (b * b)) by lra. }
  assert (E1 : bp (-400) <= / 1000000) by (apply Rle_trans with (bp (-20)); [apply bp_le; lia | simpl; lra]).
  pose proof (bp_pos (-400)). apply Rabs_le_inv in E.
  assert (D : b * b - 4 * a * c = b * b * (1 - 4 * e)) by (unfold e; field; assumption).
  set (v := sqrt (1 - 4 * e)).
  assert (V : Rabs (1 - v) <= 4 * bp (-400)).
  { pose proof (root_near 1 (1 - 4 * e) ltac:(lra) ltac:(lra)) as Q. rewrite sqrt_1 in Q. fold v in Q.
    rewrite Rmult_1_r in Q. eapply Rle_trans; [exact Q|]. apply Rabs_le. lra. }
  assert (W : w = - b * (1 + v)).
  { unfold w. rewrite D, sqrt_mult_alt by lra. fold v. replace (sqrt (b * b)) with (Rabs b) by (symmetry; apply
    sqrt_Rsqr_abs).
    rewrite <- Rmult_assoc, S. ring. }
  assert (T : 4 * bp (-400) <= bp (-110) * / 2).
  { assert (bp (-390) <= bp (-112)) by (apply bp_le; lia).
    assert (bp (-390) = 1024 * bp (-400)) by (change (-390)%Z with (10 + -400)%Z; rewrite bp_add; simpl (bp 10); lra).
    assert (bp (-110) = 4 * bp (-112)) by (change (-110)%Z with (2 + -112)%Z; rewrite bp_add; simpl (bp 2); lra). lra. }
  pose proof V as V'. apply Rabs_le_inv in V'. pose proof (bp_pos (-110)).
  split; [rewrite D; apply Rmult_lt_0_compat; lra|]. split; intro L.
  - apply rounds_alike; auto using F_opp. set (q := - b / a).
    replace (w / (2 * a) - q) with (- ((1 - v) / 2) * q) by (rewrite W; unfold q; field; assumption).
    rewrite Rabs_mult. apply Rmult_le_compat_r; [apply Rabs_pos|]. rewrite Rabs_Ropp. apply Rabs_le. lra.
  - apply rounds_alike; auto using F_opp. set (q := - c / b).
    replace (2 * c / w - q) with ((1 - v) / (1 + v) * q) by (rewrite W; unfold q; field; split; lra).
    rewrite Rabs_mult. apply Rmult_le_compat_r; [apply Rabs_pos|]. apply Rabs_div_le; [lra|].
    rewrite (Rabs_pos_eq (1 + v)) by lra. assert (bp (-110) * 1 <= bp (-110) * (1 + v)) by (apply Rmult_le_compat_l;
      lra). lra.
Qed.
(* The three cases together. *)
Theorem LOPSIDED_holds : forall a b c j, F a -> F b -> F c -> / 2 <= Rabs a < 2 -> b = 0 \/ 1 <= Rabs b < 2 ->
  1 <= Rabs c < 2 -> let B := b * bp j in let D := B * B - 4 * a * c in
  ((Z.abs j <= LOPSIDED)%Z -> F B /\ (D = 0 \/ bp (-616) <= Rabs D)) /\
  ((j < - LOPSIDED)%Z -> (0 < a * c -> D < 0) /\ (a * c < 0 -> forall s, s = 1 \/ s = -1 ->
     Rabs ((- B + s * sqrt D) / (2 * Rabs a) - s * sqrt (- c / a)) <= bp (-199) * sqrt (- c / a))) /\
  ((LOPSIDED < j)%Z -> b <> 0 -> 0 < D /\ Rabs (a * c) <= bp (2 - 2 * (LOPSIDED + 1)) * (B * B)).
Proof.
  intros a b c j Fa Fb Fc A B C B' D. assert (A0 : a <> 0) by (intro Z; rewrite Z, Rabs_R0 in A; lra). split; [|split].
  - intro J. destruct (LOPSIDED_middle a b c j Fa Fb Fc A B C J) as (H1 & _ & _ & _ & H2). split; assumption.
  - intro J. destruct (LOPSIDED_small a B' c ltac:(lra)) as [H1 H2]; [|lra|].
    + unfold B'. rewrite Rabs_mult, (Rabs_pos_eq (bp j)) by apply Rlt_le, bp_pos. unfold LOPSIDED in *.
      change (1 - (200 + 1))%Z with (1 + -201)%Z. rewrite bp_add, bp_1.
      assert (bp j <= bp (-201)) by (apply bp_le; lia). pose proof (bp_pos j).
      apply Rlt_le_trans with (2 * bp j); [|lra]. apply Rmult_lt_compat_r; [assumption|].
      destruct B as [B|B]; [rewrite B, Rabs_R0|]; lra.
    + split; assumption.
  - intros J B0. unfold LOPSIDED in *. destruct B as [B|B]; [contradiction|].
    assert (HB : bp 201 <= Rabs B').
    { unfold B'. rewrite Rabs_mult, (Rabs_pos_eq (bp j)) by apply Rlt_le, bp_pos. rewrite <- (Rmult_1_l (bp 201)).
      pose proof (bp_pos 201). apply Rmult_le_compat; try lra. apply bp_le. lia. }
    assert (BB : bp 402 <= B' * B').
    { rewrite <- abs_sq. change 402%Z with (201 + 201)%Z. rewrite bp_add. pose proof (bp_pos 201).
      apply Rmult_le_compat; lra. }
    assert (AC : Rabs (a * c) <= 4).
    { rewrite Rabs_mult. replace 4 with (2 * 2) by ring. pose proof (Rabs_pos a). pose proof (Rabs_pos c).
      apply Rmult_le_compat; lra. }
    assert (AC2 : Rabs (a * c) <= bp (2 - 2 * (200 + 1)) * (B' * B')).
    { eapply Rle_trans; [exact AC|]. apply Rle_trans with (bp (2 - 2 * (200 + 1)) * bp 402).
      - rewrite <- bp_add. simpl. lra.
      - apply Rmult_le_compat_l; [apply Rlt_le, bp_pos | assumption]. }
    split; [|exact AC2]. unfold D. apply Rabs_le_inv in AC.
    assert (16 < bp 402) by (apply Rlt_le_trans with (bp 5); [simpl; lra | apply bp_le; lia]). lra.
Qed.
