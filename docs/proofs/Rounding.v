(* The model of rounding, derived from Flocq's format of doubles (FLT: 53 bits, exponents from -1074 on, round to
   nearest even), and what all kernels share. Nothing is assumed. The format has no largest number: that nothing
   overflows is shown by the bounds of magnitudes, or overflow fails the comparison in question (docs/numerics.md). *)
Require Export Reals ZArith Lia Lra Psatz.
From Flocq Require Export Core.
From Flocq Require Import Relative Plus_error Mult_error Sterbenz.
Open Scope R_scope.

Notation bp := (bpow radix2).
Definition fexp := FLT_exp (-1074) 53.
(* The doubles, without a largest one. *)
Definition F := generic_format radix2 fexp.
(* Round to nearest, ties to even. *)
Definition RN := round radix2 fexp ZnearestE.
(* u = 2^-53, in code `rt_math::exact::U`. *)
Definition u := bp (-53).

#[export] Instance fexp_valid : Valid_exp fexp.
Proof. unfold fexp. apply FLT_exp_valid. reflexivity. Qed.
#[export] Instance fexp_monotone : Monotone_exp fexp.
Proof. unfold fexp. apply FLT_exp_monotone. Qed.
#[export] Instance prec53 : Prec_gt_0 53.
Proof. reflexivity. Qed.

Lemma u_val : u = / 9007199254740992. Proof. unfold u. simpl. reflexivity. Qed.
Lemma u_pos : 0 < u. Proof. apply bpow_gt_0. Qed.
Lemma u_small : u <= / 1024. Proof. rewrite u_val. lra. Qed.
Lemma bp_pos : forall e, 0 < bp e. Proof. intro. apply bpow_gt_0. Qed.
Lemma bp_le : forall a b, (a <= b)%Z -> bp a <= bp b. Proof. intros. now apply bpow_le. Qed.
Lemma bp_lt : forall a b, (a < b)%Z -> bp a < bp b. Proof. intros. now apply bpow_lt. Qed.
Lemma bp_add : forall a b, bp (a + b) = bp a * bp b. Proof. intros. apply bpow_plus. Qed.

Lemma bp_1 : bp 1 = 2. Proof. simpl. lra. Qed.

Lemma RN_F : forall x, F (RN x). Proof. intro. apply generic_format_round; auto with typeclass_instances. Qed.
Lemma F_opp : forall x, F x -> F (- x). Proof. intros. now apply generic_format_opp. Qed.
Lemma RN_id : forall x, F x -> RN x = x. Proof. intros. apply round_generic; auto with typeclass_instances. Qed.
Lemma RN_le : forall x y, x <= y -> RN x <= RN y. Proof. intros. apply round_le; auto with typeclass_instances. Qed.
Lemma RN_opp : forall x, RN (- x) = - RN x. Proof. intros. unfold RN. now rewrite round_NE_opp. Qed.
Lemma RN_0 : RN 0 = 0. Proof. apply round_0; auto with typeclass_instances. Qed.
Lemma F_0 : F 0. Proof. apply generic_format_0. Qed.
Lemma F_bp : forall e, (-1074 <= e)%Z -> F (bp e).
Proof. intros. apply generic_format_bpow. unfold fexp, FLT_exp. lia. Qed.
(* Whole numbers of at most 53 bits times powers of two are doubles. *)
Lemma F_scaled : forall m e, (Z.abs m < 2 ^ 53)%Z -> (-1074 <= e)%Z -> F (IZR m * bp e).
Proof.
  intros m e Hm He. replace (IZR m * bp e) with (F2R (Float radix2 m e)) by reflexivity.
  apply generic_format_FLT. exists (Float radix2 m e); simpl; auto.
Qed.

Definition even := fun n => negb (Z.even n).

(* Products, quotients, roots: the error of one rounding, underflow included. *)
Lemma RN_err : forall x, Rabs (RN x - x) <= u * Rabs x + bp (-1075).
Proof.
  intro x. destruct (error_N_FLT radix2 (-1074) 53 prec53 even x) as (e & t & He & Ht & _ & Hr).
  change (RN x) with (round radix2 (FLT_exp (-1074) 53) (Znearest even) x). rewrite Hr.
  replace (x * (1 + e) + t - x) with (x * e + t) by ring.
  eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_mult. pose proof (Rabs_pos x).
  apply Rplus_le_compat.
  - rewrite Rmult_comm. apply Rmult_le_compat_r; [assumption|]. eapply Rle_trans; [apply He|]. unfold u. simpl. lra.
  - eapply Rle_trans; [apply Ht|]. replace (-1075)%Z with (-1 + -1074)%Z by reflexivity. rewrite bp_add.
  simpl (bp (-1)).
    lra.
Qed.
(* Sums and differences of doubles: no exception for small ones. *)
Lemma RN_sum : forall x y, F x -> F y -> Rabs (RN (x + y) - (x + y)) <= u * Rabs (x + y).
Proof.
  intros x y Hx Hy. destruct (FLT_plus_error_N_ex radix2 (-1074) 53 even x y Hx Hy) as (e & He & Hr).
  change (RN (x + y)) with (round radix2 (FLT_exp (-1074) 53) (Znearest even) (x + y)). rewrite Hr.
  replace ((x + y) * (1 + e) - (x + y)) with ((x + y) * e) by ring.
  rewrite Rabs_mult, Rmult_comm. apply Rmult_le_compat_r; [apply Rabs_pos|].
  eapply Rle_trans; [apply He|]. unfold u_ro. simpl (bp _). rewrite u_val.
  match goal with |- ?a / ?b <= _ => apply Rmult_le_reg_r with b; [lra|]; unfold Rdiv; rewrite Rmult_assoc, Rinv_l; lra
  end.
Qed.
Lemma RN_diff : forall x y, F x -> F y -> Rabs (RN (x - y) - (x - y)) <= u * Rabs (x - y).
Proof. intros. unfold Rminus. apply (RN_sum x (- y)); auto. now apply F_opp. Qed.
(* A result of at least 2^-1022 has a relative error alone. *)
Lemma RN_normal : forall x, bp (-1022) <= Rabs x -> Rabs (RN x - x) <= u * Rabs x.
Proof.
  intros x H. eapply Rle_trans. apply (relative_error_N_FLT radix2 (-1074) 53 prec53 even x). exact H.
  apply Rmult_le_compat_r; [apply Rabs_pos|]. unfold u. simpl. lra.
Qed.

(* ---- Polynomials as they are computed ----

   A term lists the operations of a kernel: `X` a double that is given, `D` a difference of two given ones, then sums,
   differences, products, magnitudes and the larger of two. `computed` relates a term to every value that it may have:
   each operation is within its error, a relative `(1 + v)^w - 1` and an absolute `2^pe` for underflow. Plain doubles
   are one instance (`v = u`), a fused multiply-add another (a product without error), double-double a third (`v =
     u^2`).
   `exact` is the value of the term in real numbers, `size` the sum of the magnitudes of its monomials. *)
Inductive term :=
  | X (x : R) (q : Z)        (* given, at most 2^q *)
  | D (x y : R) (q : Z)      (* x - y of given ones, at most 2^q *)
  | XX (x y : R) (q : Z)     (* x y of given ones in double-double, exact but for underflow, at most 2^q *)
  | Add (a b : term) | Sub (a b : term) | Mul (a b : term) | Abs (a : term) | Max (a b : term).

Fixpoint exact t := match t with
  | X x _ => x | D x y _ => x - y | XX x y _ => x * y
  | Add a b => exact a + exact b | Sub a b => exact a - exact b | Mul a b => exact a * exact b
  | Abs a => Rabs (exact a) | Max a b => Rmax (exact a) (exact b) end.
Fixpoint size t := match t with
  | X x _ => Rabs x | D x y _ => Rabs (x - y) | XX x y _ => Rabs (x * y)
  | Add a b => size a + size b | Sub a b => size a + size b | Mul a b => size a * size b
  | Abs a => size a | Max a b => Rmax (size a) (size b) end.
Fixpoint bounded t := match t with
  | X x q => Rabs x <= bp q | D x y q => Rabs (x - y) <= bp q | XX x y q => Rabs (x * y) <= bp q
  | Add a b => bounded a /\ bounded b | Sub a b => bounded a /\ bounded b | Mul a b => bounded a /\ bounded b
  | Abs a => bounded a | Max a b => bounded a /\ bounded b end.
(* size <= 2^top *)
Fixpoint top t := match t with
  | X _ q => q | D _ _ q => q | XX _ _ q => q
  | Add a b => Z.max (top a) (top b) + 1 | Sub a b => Z.max (top a) (top b) + 1 | Mul a b => top a + top b
  | Abs a => top a | Max a b => Z.max (top a) (top b) end%Z.

Section Terms.
Variables (v : R) (wd wa wm : nat) (pa pm : Z).
(* how many units v of relative error, and the exponent of the absolute one *)
Fixpoint roundings t : nat := match t with
  | X _ _ => 0 | D _ _ _ => wd | XX _ _ _ => 0
  | Add a b => Nat.max (roundings a) (roundings b) + wa | Sub a b => Nat.max (roundings a) (roundings b) + wa
  | Mul a b => roundings a + roundings b + wm
  | Abs a => roundings a | Max a b => Nat.max (roundings a) (roundings b) end.
Fixpoint under t : Z := match t with
  | X _ _ => -100000 | D _ _ _ => -100000 | XX _ _ _ => pm
  | Add a b => Z.max (Z.max (under a) (under b)) pa + 3 | Sub a b => Z.max (Z.max (under a) (under b)) pa + 3
  | Mul a b => Z.max (Z.max (under a + top b) (under a + under b)) (Z.max (top a + under b) pm) + 4
  | Abs a => under a | Max a b => Z.max (under a) (under b) end%Z.

Definition g n := (1 + v) ^ n - 1.
Inductive computed : term -> R -> Prop :=
  | CX : forall x q, computed (X x q) x
  | CD : forall x y q z, Rabs (z - (x - y)) <= g wd * Rabs (x - y) -> computed (D x y q) z
  | CP : forall x y q z, Rabs (z - x * y) <= bp pm -> computed (XX x y q) z
  | CAdd : forall a b x y z, computed a x -> computed b y ->
      Rabs (z - (x + y)) <= g wa * Rabs (x + y) + bp pa -> computed (Add a b) z
  | CSub : forall a b x y z, computed a x -> computed b y ->
      Rabs (z - (x - y)) <= g wa * Rabs (x - y) + bp pa -> computed (Sub a b) z
  | CMul : forall a b x y z, computed a x -> computed b y ->
      Rabs (z - x * y) <= g wm * Rabs (x * y) + bp pm -> computed (Mul a b) z
  | CAbs : forall a x, computed a x -> computed (Abs a) (Rabs x)
  | CMax : forall a b x y, computed a x -> computed b y -> computed (Max a b) (Rmax x y).

Hypothesis v0 : 0 <= v.
Hypothesis v1 : v <= / 1024.

Lemma g_pos : forall n, 0 <= g n.
Proof. intro n. unfold g. assert (1 <= (1 + v) ^ n) by (apply pow_R1_Rle; lra). lra. Qed.
Lemma g_mono : forall a b, (a <= b)%nat -> g a <= g b.
Proof. intros. unfold g. assert ((1 + v) ^ a <= (1 + v) ^ b) by (apply Rle_pow; [lra | assumption]). lra. Qed.
Lemma g_add : forall a b, g (a + b) = g a + g b + g a * g b.
Proof. intros. unfold g. rewrite pow_add. ring. Qed.
Lemma g_le_1 : forall n, (n <= 100)%nat -> g n <= 1.
Proof.
  intros n H. apply Rle_trans with (g 100); [now apply g_mono|]. unfold g.
  apply Rle_trans with ((1 + / 1024) ^ 100 - 1).
  - apply Rplus_le_compat_r. apply pow_incr. lra.
  - lra.
Qed.
Lemma g_le : forall n, INR n * v <= 1 -> g n <= INR n * v + (INR n * v) * (INR n * v).
Proof.
  induction n; intro H.
  - unfold g. simpl. lra.
  - rewrite S_INR in *. pose proof (pos_INR n). unfold g in *. simpl pow.
    assert (H1 : INR n * v <= 1) by nra. specialize (IHn H1). assert (0 <= INR n * v) by nra.
    set (k := INR n * v) in *. assert ((INR n + 1) * v = k + v) by (unfold k; ring). rewrite H3 in *.
    assert ((1 + v) ^ n <= 1 + k + k * k) by lra.
    assert (0 <= (1 + v) ^ n) by (apply pow_le; lra).
    apply Rle_trans with ((1 + v) * (1 + k + k * k) - 1); [nra|].
    assert (k * k <= k) by nra. assert (k * k * v <= k * v) by nra. nra.
Qed.

Lemma top_ok : forall t, bounded t -> Rabs (exact t) <= size t /\ size t <= bp (top t).
Proof.
  assert (S : forall a b, bp a + bp b <= bp (Z.max a b + 1)).
  { intros. rewrite bp_add. simpl (bp 1). pose proof (bp_le a (Z.max a b) (Z.le_max_l _ _)).
    pose proof (bp_le b (Z.max a b) (Z.le_max_r _ _)). lra. }
  induction t; simpl; intro H; try (destruct H as [H1 H2]; specialize (IHt1 H1); specialize (IHt2 H2)).
  - split; [apply Rle_refl | assumption].
  - split; [apply Rle_refl | assumption].
  - split; [apply Rle_refl | assumption].
  - split; [eapply Rle_trans; [apply Rabs_triang|]; lra | pose proof (S (top t1) (top t2)); lra].
  - split; [unfold Rminus; eapply Rle_trans; [apply Rabs_triang|]; rewrite Rabs_Ropp; lra
           | pose proof (S (top t1) (top t2)); lra].
  - pose proof (Rabs_pos (exact t1)). pose proof (Rabs_pos (exact t2)). rewrite Rabs_mult, bp_add.
    split; apply Rmult_le_compat; lra.
  - rewrite Rabs_Rabsolu. auto.
  - split.
    + assert (Rabs (Rmax (exact t1) (exact t2)) <= Rmax (Rabs (exact t1)) (Rabs (exact t2))).
      { unfold Rmax at 1. destruct Rle_dec; [apply Rmax_r | apply Rmax_l]. }
      eapply Rle_trans; [eassumption|].
      apply Rmax_lub; [eapply Rle_trans; [|apply Rmax_l] | eapply Rle_trans; [|apply Rmax_r]]; lra.
    + pose proof (bp_le (top t1) (Z.max (top t1) (top t2)) ltac:(lia)).
      pose proof (bp_le (top t2) (Z.max (top t1) (top t2)) ltac:(lia)). apply Rmax_lub; lra.
Qed.

Lemma le_under : forall a b, (a <= b)%Z -> forall k x, bp b = k -> x <= bp a -> x <= k.
Proof. intros. subst. eapply Rle_trans; [eassumption|]. now apply bp_le. Qed.

(* The error of a computed term. *)
Theorem term_error : forall t z, computed t z -> bounded t -> (roundings t <= 100)%nat ->
  Rabs (z - exact t) <= g (roundings t) * size t + bp (under t).
Proof.
  induction 1; cbn [bounded roundings exact size under]; intros B N.
  - replace (x - x) with 0 by ring. rewrite Rabs_R0. pose proof (g_pos 0). pose proof (Rabs_pos x).
    pose proof (bp_pos (-100000)). nra.
  - pose proof (bp_pos (-100000)). lra.
  - pose proof (g_pos 0). pose proof (Rabs_pos (x * y)). nra.
  - destruct B as [B1 B2]. specialize (IHcomputed1 B1 ltac:(lia)). specialize (IHcomputed2 B2 ltac:(lia)).
    destruct (top_ok _ B1) as [S1 _]. destruct (top_ok _ B2) as [S2 _].
    set (n := Nat.max (roundings a) (roundings b)) in *. set (w := Z.max (Z.max (under a) (under b)) pa).
    pose proof (g_mono (roundings a) n ltac:(lia)). pose proof (g_mono (roundings b) n ltac:(lia)).
    pose proof (bp_le (under a) w ltac:(lia)). pose proof (bp_le (under b) w ltac:(lia)).
    pose proof (bp_le pa w ltac:(lia)). rewrite bp_add. simpl (bp 3).
    assert (P1 : 0 <= size a) by (pose proof (Rabs_pos (exact a)); lra).
    assert (P2 : 0 <= size b) by (pose proof (Rabs_pos (exact b)); lra).
    assert (E : Rabs (x + y - (exact a + exact b)) <= g n * (size a + size b) + 2 * bp w).
    { replace (x + y - (exact a + exact b)) with ((x - exact a) + (y - exact b)) by ring.
      eapply Rle_trans; [apply Rabs_triang|]. nra. }
    assert (V : Rabs (x + y) <= (1 + g n) * (size a + size b) + 2 * bp w).
    { replace (x + y) with ((x + y - (exact a + exact b)) + (exact a + exact b)) by ring.
      eapply Rle_trans; [apply Rabs_triang|]. pose proof (Rabs_triang (exact a) (exact b)). lra. }
    rewrite g_add. pose proof (g_le_1 wa ltac:(lia)). pose proof (g_pos wa). pose proof (g_pos n).
    assert (V2 : g wa * Rabs (x + y) <= g wa * (1 + g n) * (size a + size b) + 2 * bp w).
    { pose proof (bp_pos w). apply Rle_trans with (g wa * ((1 + g n) * (size a + size b) + 2 * bp w)); [|nra].
      now apply Rmult_le_compat_l. }
    replace (z - (exact a + exact b)) with ((z - (x + y)) + (x + y - (exact a + exact b))) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. pose proof (bp_pos w). nra.
  - destruct B as [B1 B2]. specialize (IHcomputed1 B1 ltac:(lia)). specialize (IHcomputed2 B2 ltac:(lia)).
    destruct (top_ok _ B1) as [S1 _]. destruct (top_ok _ B2) as [S2 _].
    set (n := Nat.max (roundings a) (roundings b)) in *. set (w := Z.max (Z.max (under a) (under b)) pa).
    pose proof (g_mono (roundings a) n ltac:(lia)). pose proof (g_mono (roundings b) n ltac:(lia)).
    pose proof (bp_le (under a) w ltac:(lia)). pose proof (bp_le (under b) w ltac:(lia)).
    pose proof (bp_le pa w ltac:(lia)). rewrite bp_add. simpl (bp 3).
    assert (P1 : 0 <= size a) by (pose proof (Rabs_pos (exact a)); lra).
    assert (P2 : 0 <= size b) by (pose proof (Rabs_pos (exact b)); lra).
    assert (E : Rabs (x - y - (exact a - exact b)) <= g n * (size a + size b) + 2 * bp w).
    { replace (x - y - (exact a - exact b)) with ((x - exact a) - (y - exact b)) by ring.
      eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. nra. }
    assert (V : Rabs (x - y) <= (1 + g n) * (size a + size b) + 2 * bp w).
    { replace (x - y) with ((x - y - (exact a - exact b)) + (exact a - exact b)) by ring.
      eapply Rle_trans; [apply Rabs_triang|]. pose proof (Rabs_triang (exact a) (- exact b)) as T.
      rewrite Rabs_Ropp in T. unfold Rminus in *. lra. }
    rewrite g_add. pose proof (g_le_1 wa ltac:(lia)). pose proof (g_pos wa). pose proof (g_pos n).
    assert (V2 : g wa * Rabs (x - y) <= g wa * (1 + g n) * (size a + size b) + 2 * bp w).
    { pose proof (bp_pos w). apply Rle_trans with (g wa * ((1 + g n) * (size a + size b) + 2 * bp w)); [|nra].
      now apply Rmult_le_compat_l. }
    replace (z - (exact a - exact b)) with ((z - (x - y)) + (x - y - (exact a - exact b))) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. pose proof (bp_pos w). nra.
  - destruct B as [B1 B2]. specialize (IHcomputed1 B1 ltac:(lia)). specialize (IHcomputed2 B2 ltac:(lia)).
    destruct (top_ok _ B1) as [S1 T1]. destruct (top_ok _ B2) as [S2 T2].
    set (k1 := g (roundings a)) in *. set (k2 := g (roundings b)) in *.
    assert (K2 : 0 <= k2 <= 1) by (split; [apply g_pos | apply g_le_1; lia]).
    assert (K1 : 0 <= k1 <= 1) by (split; [apply g_pos | apply g_le_1; lia]).
    rewrite (g_add (roundings a + roundings b)), (g_add (roundings a)). fold k1 k2.
    set (n := k1 + k2 + k1 * k2).
    assert (N1 : 0 <= n <= 1).
    { split; [unfold n; nra|]. unfold n, k1, k2. rewrite <- g_add. apply g_le_1. lia. }
    assert (W : 0 <= g wm <= 1) by (split; [apply g_pos | apply g_le_1; lia]).
    set (w := Z.max (Z.max (under a + top b) (under a + under b)) (Z.max (top a + under b) pm)).
    pose proof (bp_le (under a + top b) w ltac:(lia)) as U1. pose proof (bp_le (under a + under b) w ltac:(lia)) as U2.
    pose proof (bp_le (top a + under b) w ltac:(lia)) as U3. pose proof (bp_le pm w ltac:(lia)) as U4.
    rewrite bp_add in U1, U2, U3. rewrite bp_add. simpl (bp 4). pose proof (bp_pos w).
    assert (P1 : 0 <= size a) by (pose proof (Rabs_pos (exact a)); lra).
    assert (P2 : 0 <= size b) by (pose proof (Rabs_pos (exact b)); lra).
    set (m1 := size a) in *. set (m2 := size b) in *. set (a1 := bp (under a)) in *. set (a2 := bp (under b)) in *.
    assert (A1 : 0 < a1) by apply bp_pos. assert (A2 : 0 < a2) by apply bp_pos.
    assert (Y : Rabs y <= (1 + k2) * m2 + a2).
    { replace y with ((y - exact b) + exact b) by ring. eapply Rle_trans; [apply Rabs_triang|]. lra. }
    assert (Q1 : a1 * m2 <= bp w) by (apply Rle_trans with (a1 * bp (top b)); [apply Rmult_le_compat_l; lra | lra]).
    assert (Q2 : m1 * a2 <= bp w) by (apply Rle_trans with (bp (top a) * a2); [apply Rmult_le_compat_r; lra | lra]).
    assert (E : Rabs (x * y - exact a * exact b) <= n * (m1 * m2) + 5 * bp w).
    { replace (x * y - exact a * exact b) with ((x - exact a) * y + exact a * (y - exact b)) by ring.
      eapply Rle_trans; [apply Rabs_triang|]. rewrite !Rabs_mult.
      assert (E1 : Rabs (x - exact a) * Rabs y <= (k1 * m1 + a1) * ((1 + k2) * m2 + a2))
        by (apply Rmult_le_compat; try apply Rabs_pos; assumption).
      assert (E2 : Rabs (exact a) * Rabs (y - exact b) <= m1 * (k2 * m2 + a2))
        by (apply Rmult_le_compat; try apply Rabs_pos; assumption).
      assert (k2 * (a1 * m2) <= bp w) by (apply Rle_trans with (1 * (a1 * m2)); [apply Rmult_le_compat_r; nra | lra]).
      assert (k1 * (m1 * a2) <= bp w) by (apply Rle_trans with (1 * (m1 * a2)); [apply Rmult_le_compat_r; nra | lra]).
      unfold n. 
      replace ((k1 * m1 + a1) * ((1 + k2) * m2 + a2)) with
        ((k1 + k1 * k2) * (m1 * m2) + a1 * m2 + k2 * (a1 * m2) + k1 * (m1 * a2) + a1 * a2) in E1 by ring.
      replace (m1 * (k2 * m2 + a2)) with (k2 * (m1 * m2) + m1 * a2) in E2 by ring. lra. }
    assert (M : 0 <= m1 * m2) by nra.
    assert (V : Rabs (x * y) <= (1 + n) * (m1 * m2) + 5 * bp w).
    { replace (x * y) with ((x * y - exact a * exact b) + exact a * exact b) by ring.
      eapply Rle_trans; [apply Rabs_triang|]. rewrite (Rabs_mult (exact a)).
      assert (Rabs (exact a) * Rabs (exact b) <= m1 * m2) by (apply Rmult_le_compat; try apply Rabs_pos; assumption).
      lra. }
    assert (V2 : g wm * Rabs (x * y) <= g wm * (1 + n) * (m1 * m2) + 5 * bp w).
    { apply Rle_trans with (g wm * ((1 + n) * (m1 * m2) + 5 * bp w)); [now apply Rmult_le_compat_l | nra]. }
    replace (z - exact a * exact b) with ((z - x * y) + (x * y - exact a * exact b)) by ring.
    eapply Rle_trans; [apply Rabs_triang|].
    replace ((n + g wm + n * g wm) * (m1 * m2)) with (n * (m1 * m2) + g wm * (1 + n) * (m1 * m2)) by ring. lra.
  - specialize (IHcomputed B N). eapply Rle_trans; [apply Rabs_triang_inv2 | assumption].
  - destruct B as [B1 B2]. specialize (IHcomputed1 B1 ltac:(lia)). specialize (IHcomputed2 B2 ltac:(lia)).
    destruct (top_ok _ B1) as [S1 _]. destruct (top_ok _ B2) as [S2 _].
    set (n := Nat.max (roundings a) (roundings b)) in *.
    pose proof (g_mono (roundings a) n ltac:(lia)). pose proof (g_mono (roundings b) n ltac:(lia)).
    pose proof (bp_le (under a) (Z.max (under a) (under b)) ltac:(lia)).
    pose proof (bp_le (under b) (Z.max (under a) (under b)) ltac:(lia)).
    pose proof (g_pos n). set (m := Rmax (size a) (size b)).
    assert (size a <= m) by apply Rmax_l. assert (size b <= m) by apply Rmax_r.
    assert (P1 : 0 <= size a) by (pose proof (Rabs_pos (exact a)); lra).
    assert (P2 : 0 <= size b) by (pose proof (Rabs_pos (exact b)); lra).
    assert (E1 : Rabs (x - exact a) <= g n * m + bp (Z.max (under a) (under b))) by nra.
    assert (E2 : Rabs (y - exact b) <= g n * m + bp (Z.max (under a) (under b))) by nra.
    apply Rabs_le_inv in E1. apply Rabs_le_inv in E2. apply Rabs_le.
    unfold Rmax; destruct (Rle_dec x y), (Rle_dec (exact a) (exact b)); lra.
Qed.
End Terms.

(* Plain doubles, products fused or not: one rounding an operation;
  those of sums are counted with an underflow that they
   do not have, since a fused product may have one. *)
Notation plain := (computed u 1 1 1 (-1075) (-1075)).
Notation count := (roundings 1 1 1).
Notation low := (under (-1075) (-1075)).
Lemma g1 : g u 1 = u. Proof. unfold g. ring. Qed.
Lemma plain_D : forall x y q, F x -> F y -> plain (D x y q) (RN (x - y)).
Proof. intros. apply CD. rewrite g1. now apply RN_diff. Qed.
Lemma plain_Add : forall a b x y, plain a x -> plain b y -> plain (Add a b) (RN (x + y)).
Proof. intros. eapply CAdd; eauto. rewrite g1. apply RN_err. Qed.
Lemma plain_Sub : forall a b x y, plain a x -> plain b y -> plain (Sub a b) (RN (x - y)).
Proof. intros. eapply CSub; eauto. rewrite g1. apply RN_err. Qed.
Lemma plain_Mul : forall a b x y, plain a x -> plain b y -> plain (Mul a b) (RN (x * y)).
Proof. intros. eapply CMul; eauto. rewrite g1. apply RN_err. Qed.
Lemma plain_fused : forall a b x y, plain a x -> plain b y -> plain (Mul a b) (x * y).
Proof.
  intros. eapply CMul; eauto. replace (x * y - x * y) with 0 by ring. rewrite Rabs_R0, g1.
  pose proof u_pos. pose proof (Rabs_pos (x * y)). pose proof (bp_pos (-1075)). nra.
Qed.
Ltac plain_terms := repeat first [ apply plain_Add | apply plain_Sub | apply plain_Mul | apply plain_fused
  | apply plain_D; assumption | apply CX | apply CAbs | apply CMax ].

(* n roundings are at most n + 1/1000 units of u. *)
Lemma g_u : forall n, (n <= 100)%nat -> g u n <= (INR n + / 1000) * u.
Proof.
  intros n H. apply le_INR in H. replace (INR 100) with 100 in H by (simpl; lra). pose proof (pos_INR n).
  pose proof u_pos. assert (u <= / 900000000000) by (rewrite u_val; lra).
  eapply Rle_trans; [apply g_le; nra|]. assert (INR n * INR n * u <= / 1000) by nra. nra.
Qed.
(* The error of a term in plain doubles, in one line. *)
Lemma plain_error : forall t z, plain t z -> bounded t -> (count t <= 100)%nat ->
  Rabs (z - exact t) <= (INR (count t) + / 1000) * u * size t + bp (low t).
Proof.
  intros t z H B N. eapply Rle_trans.
  - apply (term_error u 1 1 1 (-1075) (-1075)); auto. pose proof u_pos; lra. apply u_small.
  - pose proof (g_u (count t) N). destruct (top_ok t B). pose proof (Rabs_pos (exact t)).
    apply Rplus_le_compat_r. apply Rmult_le_compat_r; lra.
Qed.

(* ---- Lemmas of geometry ---- *)
Lemma sq_pos : forall x, 0 <= x * x. Proof. intro. apply Rle_0_sqr. Qed.
Lemma abs_sq : forall x, Rabs x * Rabs x = x * x.
Proof. intro. rewrite <- Rabs_mult. apply Rabs_pos_eq, sq_pos. Qed.
Lemma lagrange : forall a1 a2 a3 b1 b2 b3 : R,
  (a2*b3-a3*b2)*(a2*b3-a3*b2) + (a3*b1-a1*b3)*(a3*b1-a1*b3) + (a1*b2-a2*b1)*(a1*b2-a2*b1)
  = (a1*a1+a2*a2+a3*a3)*(b1*b1+b2*b2+b3*b3) - (a1*b1+a2*b2+a3*b3)*(a1*b1+a2*b2+a3*b3).
Proof. intros. ring. Qed.
Lemma cauchy_schwarz : forall a1 a2 a3 b1 b2 b3 : R,
  (a1*b1+a2*b2+a3*b3)*(a1*b1+a2*b2+a3*b3) <= (a1*a1+a2*a2+a3*a3)*(b1*b1+b2*b2+b3*b3).
Proof.
  intros. pose proof (lagrange a1 a2 a3 b1 b2 b3). pose proof (sq_pos (a2*b3-a3*b2)).
  pose proof (sq_pos (a3*b1-a1*b3)). pose proof (sq_pos (a1*b2-a2*b1)). lra.
Qed.
(* The squares of the permanents of a cross product. *)
Lemma permanents : forall a1 a2 a3 b1 b2 b3 : R,
  (a2*b3+a3*b2)*(a2*b3+a3*b2) + (a3*b1+a1*b3)*(a3*b1+a1*b3) + (a1*b2+a2*b1)*(a1*b2+a2*b1)
  <= 2*((a1*a1+a2*a2+a3*a3)*(b1*b1+b2*b2+b3*b3)).
Proof.
  intros. pose proof (sq_pos (a2*b3-a3*b2)). pose proof (sq_pos (a3*b1-a1*b3)). pose proof (sq_pos (a1*b2-a2*b1)).
  pose proof (sq_pos (a1*b1)). pose proof (sq_pos (a2*b2)). pose proof (sq_pos (a3*b3)). lra.
Qed.
(* A sign is certain where the value exceeds the bound of its error. *)
Lemma certain_sign : forall x v e, Rabs (v - x) <= e -> (v > e -> 0 < x) /\ (v < - e -> x < 0).
Proof. intros x v e H. apply Rabs_le_inv in H. split; lra. Qed.

(* The same with the numbers of roundings and the exponent evaluated. *)
Lemma plain_error_at : forall t z k p, plain t z -> bounded t -> Z.of_nat (count t) = k -> low t = p -> (k <= 100)%Z ->
  Rabs (z - exact t) <= (IZR k + / 1000) * u * size t + bp p.
Proof.
  intros. subst k p. rewrite <- INR_IZR_INZ. apply plain_error; auto. lia.
Qed.
Ltac error_of H name :=
  match type of H with computed _ _ _ _ _ _ ?t _ =>
    let k := eval vm_compute in (Z.of_nat (count t)) in let p := eval vm_compute in (low t) in
    assert (bounded t) as name; [ cbn [bounded]; repeat split; assumption |
      let e := fresh in
      pose proof (plain_error_at _ _ k p H name eq_refl eq_refl ltac:(lia)) as e; clear name; rename e into name;
      cbn [exact size] in name; rewrite ?Rabs_mult in name ]
  end.

(* A number is computed in some order: by a term with the monomials of another and as many roundings. *)
Definition in_some_order n least t z := exists t', plain t' z /\ bounded t' /\ exact t' = exact t /\ size t' = size t /\
  Z.of_nat (count t') = n /\ (low t' <= least)%Z.
Lemma order_error : forall n least t z, in_some_order n least t z -> (n <= 100)%Z ->
  Rabs (z - exact t) <= (IZR n + / 1000) * u * size t + bp least.
Proof.
  intros n least t z (t' & H & B & Ex & Sz & N & L) Hn.
  pose proof (plain_error_at t' z n (low t') H B N eq_refl Hn) as P. rewrite Ex, Sz in P.
  pose proof (bp_le _ _ L). lra.
Qed.
Ltac error_in H name := pose proof (order_error _ _ _ _ H ltac:(lia)) as name; cbn [exact size] in name;
  rewrite ?Rabs_mult in name.
(* The number of the other sign. *)
Lemma plain_negated : forall a b z, plain (Sub a b) z -> plain (Sub b a) (- z).
Proof.
  intros a b z H. inversion H. subst. eapply CSub; eauto.
  replace (- z - (y - x)) with (- (z - (x - y))) by ring. now rewrite Rabs_Ropp, (Rabs_minus_sym y x).
Qed.

(* What underflows beside what it is compared with. *)
Lemma bp_part : forall k s, (k <= s - 100)%Z -> bp k <= / 1000000000000000000000000000000 * bp s.
Proof.
  intros k s H. apply Rle_trans with (bp (-100 + s)); [apply bp_le; lia|]. rewrite bp_add.
  apply Rmult_le_compat_r; [apply Rlt_le, bp_pos|]. simpl. lra.
Qed.
(* Replaces every 2^k on the right of a bound by a part of 10^30 of 2^s. *)
Ltac small s := pose proof (bp_pos s); repeat match goal with H : _ <= _ + bp ?k |- _ =>
  pose proof (bp_part k s ltac:(lia)); generalize dependent (bp k); intros end.
Ltac abs_pos := repeat match goal with |- context [Rabs ?x] =>
  lazymatch goal with H : 0 <= Rabs x |- _ => fail | _ => pose proof (Rabs_pos x) end end.
(* A square root on the left. *)
Lemma below_root : forall x y, 0 <= y -> x * x <= y * y -> x <= y.
Proof. intros. apply Rnot_lt_le. intro. nra. Qed.
Lemma abs_below : forall x y, 0 <= y -> x * x <= y * y -> Rabs x <= y.
Proof. intros. apply below_root; [assumption|]. now rewrite abs_sq. Qed.
Lemma bp_sq : forall k, bp k * bp k = bp (k + k). Proof. intro. now rewrite bp_add. Qed.
(* The same for numbers that are closer: a part of 10^12. *)
Lemma bp_part12 : forall k s, (k <= s - 40)%Z -> bp k <= / 1000000000000 * bp s.
Proof.
  intros k s H. apply Rle_trans with (bp (-40 + s)); [apply bp_le; lia|]. rewrite bp_add.
  apply Rmult_le_compat_r; [apply Rlt_le, bp_pos|]. simpl. lra.
Qed.
Ltac small12 s := pose proof (bp_pos s); repeat match goal with H : _ <= _ + bp ?k |- _ =>
  pose proof (bp_part12 k s ltac:(lia)); generalize dependent (bp k); intros end.
(* A constant is at most a power of two: k u, or a power itself. *)
Ltac constant := rewrite ?u_val, Rabs_pos_eq; simpl; lra.

(* ---- Vectors ---- *)
Definition tdot a1 a2 a3 b1 b2 b3 := Add (Add (Mul a1 b1) (Mul a2 b2)) (Mul a3 b3).
(* the same from the other end: fused, and in lanes *)
Definition tlane x1 x2 x3 y1 y2 y3 := Add (Mul x1 y1) (Add (Mul x2 y2) (Mul x3 y3)).
(* one component of a cross product: a b - c d *)
Definition tminor a b c d := Sub (Mul a b) (Mul c d).
Lemma Rabs3 : forall x y m, Rabs x <= m -> Rabs y <= m -> Rmax (Rabs x) (Rabs y) <= m.
Proof. intros. now apply Rmax_lub. Qed.
(* A product of three, each below its bound. *)
Lemma mul3 : forall x y z X Y Z, 0 <= x <= X -> 0 <= y <= Y -> 0 <= z <= Z -> x * y * z <= X * Y * Z.
Proof. intros. apply Rmult_le_compat; try lra; [apply Rmult_le_pos; lra | apply Rmult_le_compat; lra]. Qed.
Lemma mul2 : forall x y X Y, 0 <= x <= X -> 0 <= y <= Y -> x * y <= X * Y.
Proof. intros. apply Rmult_le_compat; lra. Qed.

(* The error of one rounding, by the rounded value. *)
Lemma RN_back : forall x, Rabs (RN x - x) <= u * Rabs (RN x) + bp (-1075).
Proof.
  intro x. pose proof (error_le_half_ulp_round radix2 fexp even x) as H.
  change (round radix2 fexp (Znearest even) x) with (RN x) in H. eapply Rle_trans; [exact H|].
  assert (U : ulp radix2 fexp (RN x) <= 2 * (u * Rabs (RN x)) + bp (-1074)).
  { destruct (Req_dec (RN x) 0) as [Z|N].
    - rewrite Z, Rabs_R0. unfold fexp. rewrite ulp_FLT_0. lra. reflexivity.
    - rewrite ulp_neq_0 by assumption. unfold cexp, fexp, FLT_exp.
      destruct (Z.max_spec (mag radix2 (RN x) - 53) (-1074)) as [[_ E]|[_ E]]; rewrite E.
      + pose proof u_pos. pose proof (Rabs_pos (RN x)). nra.
      + pose proof (bpow_mag_le radix2 (RN x) N) as M. pose proof (bp_pos (-1074)).
        assert (bp (mag radix2 (RN x) - 53) <= 2 * (u * Rabs (RN x))).
        { replace (mag radix2 (RN x) - 53)%Z with (1 + (-53 + (mag radix2 (RN x) - 1)))%Z by ring.
          rewrite bp_add, bp_add, bp_1. fold u. pose proof u_pos. nra. }
        lra. }
  assert (bp (-1074) = 2 * bp (-1075)) by (change (-1074)%Z with (1 + -1075)%Z; rewrite bp_add, bp_1; ring). lra.
Qed.
