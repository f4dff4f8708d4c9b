(* The model of rounding to f32, in which the tree culls (rt-geom, bvh): Flocq's format with 24 bits and exponents from
   -149 on, ties to even. As for doubles, the format has no largest number. *)
From Proofs Require Import Rounding.
From Flocq Require Import Relative Plus_error Mult_error.
Open Scope R_scope.

(* Half the spacing of f32 at 1, `U` of cull.rs: the unit of the constants there. *)
Definition UNIT := bp (-24).
Notation v := UNIT.
Definition fexp32 := FLT_exp (-149) 24.
Definition Fs := generic_format radix2 fexp32.
Definition RNs := round radix2 fexp32 ZnearestE.

#[export] Instance prec24 : Prec_gt_0 24.
Proof. reflexivity. Qed.
#[export] Instance fexp32_valid : Valid_exp fexp32.
Proof. unfold fexp32. apply FLT_exp_valid. reflexivity. Qed.
#[export] Instance fexp32_monotone : Monotone_exp fexp32.
Proof. unfold fexp32. apply FLT_exp_monotone. Qed.

Lemma v_val : v = / 16777216. Proof. unfold UNIT. simpl. reflexivity. Qed.
Lemma v_pos : 0 < v. Proof. apply bp_pos. Qed.
Lemma u_v : u <= / 500000000 * v. Proof. rewrite u_val, v_val. lra. Qed.
Lemma RNs_F : forall x, Fs (RNs x). Proof. intro. apply generic_format_round; auto with typeclass_instances. Qed.
Lemma Fs_opp : forall x, Fs x -> Fs (- x). Proof. intros. now apply generic_format_opp. Qed.
Lemma Fs_abs : forall x, Fs x -> Fs (Rabs x). Proof. intros. now apply generic_format_abs. Qed.
Lemma RNs_id : forall x, Fs x -> RNs x = x. Proof. intros. apply round_generic; auto with typeclass_instances. Qed.
Lemma RNs_le : forall x y, x <= y -> RNs x <= RNs y.
Proof. intros. apply round_le; auto with typeclass_instances. Qed.
Lemma RNs_opp : forall x, RNs (- x) = - RNs x. Proof. intros. unfold RNs. now rewrite round_NE_opp. Qed.
Lemma RNs_0 : RNs 0 = 0. Proof. apply round_0; auto with typeclass_instances. Qed.
Lemma Fs_0 : Fs 0. Proof. apply generic_format_0. Qed.
Lemma Fs_bp : forall e, (-149 <= e)%Z -> Fs (bp e).
Proof. intros. apply generic_format_bpow. unfold fexp32, FLT_exp. lia. Qed.
Lemma Fs_scaled : forall m e, (Z.abs m < 2 ^ 24)%Z -> (-149 <= e)%Z -> Fs (IZR m * bp e).
Proof.
  intros m e Hm He. replace (IZR m * bp e) with (F2R (Float radix2 m e)) by reflexivity.
  apply generic_format_FLT. exists (Float radix2 m e); simpl; auto.
Qed.
(* Every f32 is a double. *)
Lemma Fs_F : forall x, Fs x -> F x.
Proof.
  intros x H. apply generic_inclusion_mag with (2 := H). intros _. unfold fexp, fexp32, FLT_exp. lia.
Qed.

(* The error of one rounding, underflow included. *)
Theorem UNIT_holds : forall x, Rabs (RNs x - x) <= UNIT * Rabs x + bp (-150).
Proof.
  intro x. destruct (error_N_FLT radix2 (-149) 24 prec24 even x) as (e & t & He & Ht & _ & Hr).
  change (RNs x) with (round radix2 (FLT_exp (-149) 24) (Znearest even) x). rewrite Hr.
  replace (x * (1 + e) + t - x) with (x * e + t) by ring.
  eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_mult. pose proof (Rabs_pos x).
  apply Rplus_le_compat.
  - rewrite Rmult_comm. apply Rmult_le_compat_r; [assumption|]. eapply Rle_trans; [apply He|]. unfold UNIT. simpl. lra.
  - eapply Rle_trans; [apply Ht|]. replace (-150)%Z with (-1 + -149)%Z by reflexivity. rewrite bp_add.
    simpl (bp (-1)). lra.
Qed.
(* Sums and differences of f32 have no exception for small ones. *)
Lemma RNs_sum : forall x y, Fs x -> Fs y -> Rabs (RNs (x + y) - (x + y)) <= v * Rabs (x + y).
Proof.
  intros x y Hx Hy. destruct (FLT_plus_error_N_ex radix2 (-149) 24 even x y Hx Hy) as (e & He & Hr).
  change (RNs (x + y)) with (round radix2 (FLT_exp (-149) 24) (Znearest even) (x + y)). rewrite Hr.
  replace ((x + y) * (1 + e) - (x + y)) with ((x + y) * e) by ring.
  rewrite Rabs_mult, Rmult_comm. apply Rmult_le_compat_r; [apply Rabs_pos|].
  eapply Rle_trans; [apply He|]. unfold u_ro. simpl (bp _). rewrite v_val.
  match goal with |- ?a / ?b <= _ => apply Rmult_le_reg_r with b; [lra|]; unfold Rdiv; rewrite Rmult_assoc, Rinv_l; lra
  end.
Qed.
Lemma RNs_normal : forall x, bp (-126) <= Rabs x -> Rabs (RNs x - x) <= v * Rabs x.
Proof.
  intros x H. eapply Rle_trans. apply (relative_error_N_FLT radix2 (-149) 24 prec24 even x). exact H.
  apply Rmult_le_compat_r; [apply Rabs_pos|]. unfold UNIT. simpl. lra.
Qed.

(* Terms of Rounding.v in f32, products fused or not. *)
Notation single := (computed UNIT 1 1 1 (-150) (-150)).
Notation low32 := (under (-150) (-150)).
Lemma g32_1 : g v 1 = v. Proof. unfold g. ring. Qed.
Lemma single_Add : forall a b x y, single a x -> single b y -> single (Add a b) (RNs (x + y)).
Proof. intros. eapply CAdd; eauto. rewrite g32_1. apply UNIT_holds. Qed.
Lemma single_Sub : forall a b x y, single a x -> single b y -> single (Sub a b) (RNs (x - y)).
Proof. intros. eapply CSub; eauto. rewrite g32_1. apply UNIT_holds. Qed.
Lemma single_Mul : forall a b x y, single a x -> single b y -> single (Mul a b) (RNs (x * y)).
Proof. intros. eapply CMul; eauto. rewrite g32_1. apply UNIT_holds. Qed.
Lemma single_fused : forall a b x y, single a x -> single b y -> single (Mul a b) (x * y).
Proof.
  intros. eapply CMul; eauto. replace (x * y - x * y) with 0 by ring. rewrite Rabs_R0, g32_1.
  pose proof v_pos. pose proof (Rabs_pos (x * y)). pose proof (bp_pos (-150)). nra.
Qed.
(* n roundings are at most n + 1/1000 units of v, n up to 30. *)
Lemma g_v : forall n, (n <= 30)%nat -> g v n <= (INR n + / 1000) * v.
Proof.
  intros n H. apply le_INR in H. replace (INR 30) with 30 in H by (simpl; lra). pose proof (pos_INR n).
  pose proof v_pos. assert (v <= / 16000000) by (rewrite v_val; lra).
  eapply Rle_trans; [apply g_le; nra|]. assert (INR n * INR n * v <= / 1000) by nra. nra.
Qed.
Lemma single_error_at : forall t z k p, single t z -> bounded t -> Z.of_nat (count t) = k -> low32 t = p -> (k <= 30)%Z
  -> Rabs (z - exact t) <= (IZR k + / 1000) * v * size t + bp p.
Proof.
  intros t z k p H B K L M. subst k p. rewrite <- INR_IZR_INZ. assert (N : (count t <= 30)%nat) by lia.
  eapply Rle_trans.
  - apply (term_error v 1 1 1 (-150) (-150)); auto. pose proof v_pos; lra. rewrite v_val; lra. lia.
  - pose proof (g_v (count t) N). destruct (top_ok t B). pose proof (Rabs_pos (exact t)).
    apply Rplus_le_compat_r. apply Rmult_le_compat_r; lra.
Qed.
Ltac error32_of H name :=
  match type of H with computed _ _ _ _ _ _ ?t _ =>
    let k := eval vm_compute in (Z.of_nat (count t)) in let p := eval vm_compute in (low32 t) in
    assert (bounded t) as name; [ cbn [bounded]; repeat split; assumption |
      let e := fresh in
      pose proof (single_error_at _ _ k p H name eq_refl eq_refl ltac:(lia)) as e; clear name; rename e into name;
      cbn [exact size] in name; rewrite ?Rabs_mult in name ]
  end.
Lemma RNs_below : forall x y, Fs y -> x <= y -> RNs x <= y.
Proof. intros x y Fy H. rewrite <- (RNs_id y Fy). now apply RNs_le. Qed.
Lemma RNs_above : forall x y, Fs y -> y <= x -> y <= RNs x.
Proof. intros x y Fy H. rewrite <- (RNs_id y Fy). now apply RNs_le. Qed.
(* A value below t less the rounding of numbers of at most m is below t rounded, however negative it is. *)
Lemma RNs_lower : forall x t m, Fs m -> 1 <= m -> Rabs t <= m -> x <= t - (v * m + bp (-150)) -> RNs x <= t.
Proof.
  intros x t m Fm M1 T H. apply Rabs_le_inv in T. destruct (Rle_or_lt x (- m)) as [N|N].
  - apply Rle_trans with (- m); [apply RNs_below; [now apply Fs_opp | assumption] | lra].
  - pose proof (UNIT_holds x) as E. pose proof v_pos. pose proof (bp_pos (-150)).
    assert (Rabs x <= m) by (apply Rabs_le; nra). apply Rabs_le_inv in E. nra.
Qed.

(* ---- `up` of node.rs: the nearest f32 and one or two steps more ---- *)
Definition up x := let n := RNs x in RNs (n + RNs (RNs (Rabs n * bp (-23)) + bp (-126))).
Definition down x := - up (- x).
Lemma ulp_s : forall n, ulp radix2 fexp32 n <= Rabs n * bp (-23) + bp (-149).
Proof.
  intro n. destruct (Req_dec n 0) as [Z|N].
  - rewrite Z, Rabs_R0. unfold fexp32. rewrite ulp_FLT_0 by reflexivity. lra.
  - rewrite ulp_neq_0 by assumption. unfold cexp, fexp32, FLT_exp. pose proof (Rabs_pos n). pose proof (bp_pos (-23)).
    pose proof (bp_pos (-149)).
    destruct (Z.max_spec (mag radix2 n - 24) (-149)) as [[_ E]|[_ E]]; rewrite E; [nra|].
    pose proof (bpow_mag_le radix2 n N) as M. replace (mag radix2 n - 24)%Z with ((mag radix2 n - 1) + -23)%Z by ring.
    rewrite bp_add. nra.
Qed.
Lemma up_succ : forall x, succ radix2 fexp32 (RNs x) <= up x.
Proof.
  intro x. unfold up. set (n := RNs x). assert (Fn : Fs n) by apply RNs_F.
  apply RNs_above; [apply generic_format_succ; auto with typeclass_instances|].
  apply Rle_trans with (n + ulp radix2 fexp32 n); [apply succ_le_plus_ulp; auto with typeclass_instances|].
  apply Rplus_le_compat_l.
  assert (Fu : Fs (ulp radix2 fexp32 n)) by (apply generic_format_ulp; auto with typeclass_instances).
  apply RNs_above; [assumption|]. pose proof (ulp_s n) as U.
  assert (T : bp (-149) <= / 1000 * bp (-126)).
  { replace (-149)%Z with (-23 + -126)%Z by reflexivity. rewrite bp_add. pose proof (bp_pos (-126)). simpl (bp (-23)).
    lra. }
  destruct (Rle_or_lt (bp (-126)) (Rabs n * bp (-23))) as [L|L].
  - assert (E : RNs (Rabs n * bp (-23)) = Rabs n * bp (-23)).
    { apply RNs_id. apply mult_bpow_exact_FLT; [now apply Fs_abs|].
      assert (N0 : Rabs n <> 0) by (intro Z; rewrite Z in L; pose proof (bp_pos (-126)); lra).
      assert (M : (-103 < mag radix2 (Rabs n))%Z); [|lia]. apply mag_gt_bpow. rewrite Rabs_Rabsolu.
      apply Rmult_le_reg_r with (bp (-23)); [apply bp_pos|]. rewrite <- bp_add.
      apply Rle_trans with (bp (-126)); [apply bp_le; lia | assumption]. }
    rewrite E. pose proof (bp_pos (-126)). lra.
  - pose proof (UNIT_holds (Rabs n * bp (-23))) as E. apply Rabs_le_inv in E. pose proof (Rabs_pos n).
    pose proof (bp_pos (-23)). rewrite (Rabs_pos_eq (Rabs n * bp (-23))) in E by nra.
    assert (bp (-150) <= bp (-149)) by (apply bp_le; lia). rewrite v_val in E. lra.
Qed.
Theorem up_above : forall x, x <= up x.
Proof.
  intro x. apply Rle_trans with (2 := up_succ x). apply succ_round_ge_id; auto with typeclass_instances.
Qed.
(* Of numbers that are not small it is above by a quarter of a spacing at least, and by less than five roundings. *)
Lemma up_beyond : forall x, 1 <= x -> x + / 3 * v * x <= up x <= x + 5 * v * x.
Proof.
  intros x H. pose proof v_pos as V. set (n := RNs x).
  assert (n1 : 1 <= n) by (unfold n; apply RNs_above; [replace 1 with (bp 0) by reflexivity; apply Fs_bp; lia | lra]).
  pose proof (UNIT_holds x) as E. fold n in E. rewrite (Rabs_pos_eq x) in E by lra. apply Rabs_le_inv in E.
  assert (T : bp (-126) <= / 1000000 * v) by (apply Rle_trans with (bp (-40 + -24)); [apply bp_le; lia|];
    rewrite bp_add; fold UNIT; simpl (bp (-40)); lra).
  assert (T2 : bp (-150) <= bp (-126)) by (apply bp_le; lia). pose proof (bp_pos (-126)) as T0.
  split.
  - apply Rle_trans with (2 := up_succ x). fold n. rewrite succ_eq_pos by lra.
    pose proof (error_le_half_ulp_round radix2 fexp32 even x) as U.
    change (round radix2 fexp32 (Znearest even) x) with n in U. apply Rabs_le_inv in U.
    assert (L : v * n <= ulp radix2 fexp32 n).
    { rewrite ulp_neq_0 by lra. unfold cexp, fexp32, FLT_exp.
      apply Rle_trans with (bp (mag radix2 n - 24)); [|apply bp_le; lia].
      replace (mag radix2 n - 24)%Z with (-24 + mag radix2 n)%Z by ring. rewrite bp_add. fold UNIT.
      apply Rmult_le_compat_l; [lra|]. pose proof (bpow_mag_gt radix2 n) as M. rewrite Rabs_pos_eq in M by lra. lra. }
    rewrite v_val in *. lra.
  - unfold up. fold n. rewrite (Rabs_pos_eq n) by lra. assert (B : bp (-23) = 2 * v) by (rewrite v_val; simpl; lra).
    rewrite B. pose proof (UNIT_holds (n * (2 * v))) as E2. set (m := RNs (n * (2 * v))) in *.
    assert (N0 : 0 <= n * (2 * v)) by (apply Rmult_le_pos; lra).
    rewrite (Rabs_pos_eq (n * (2 * v))) in E2 by assumption. apply Rabs_le_inv in E2.
    assert (m0 : 0 <= m) by (unfold m; apply RNs_above; [apply Fs_0 | assumption]).
    pose proof (UNIT_holds (m + bp (-126))) as E3. set (k := RNs (m + bp (-126))) in *.
    rewrite (Rabs_pos_eq (m + bp (-126))) in E3 by lra. apply Rabs_le_inv in E3.
    assert (k0 : 0 <= k) by (unfold k; apply RNs_above; [apply Fs_0 | lra]). pose proof (UNIT_holds (n + k)) as E4.
    rewrite (Rabs_pos_eq (n + k)) in E4 by lra. apply Rabs_le_inv in E4. rewrite v_val in *. lra.
Qed.
Theorem down_below : forall x, down x <= x.
Proof. intro x. unfold down. pose proof (up_above (- x)). lra. Qed.
(* The errors of a line that are below 1/16 as doubles: what the tests of boxes and balls take for granted. *)
Theorem up_small : forall x, 0 <= x <= / 16 -> up x <= / 10.
Proof.
  intros x H. unfold up. pose proof (UNIT_holds x) as E1. set (n := RNs x) in *. rewrite (Rabs_pos_eq x) in E1 by lra.
  assert (T : bp (-126) <= / 1000000 * v) by (apply Rle_trans with (bp (-40 + -24)); [apply bp_le; lia|];
    rewrite bp_add;
    fold UNIT; pose proof v_pos; simpl (bp (-40)); lra).
  assert (T2 : bp (-150) <= bp (-126)) by (apply bp_le; lia). apply Rabs_le_inv in E1.
  assert (n0 : 0 <= n) by (unfold n; apply RNs_above; [apply Fs_0 | lra]). rewrite (Rabs_pos_eq n) by assumption.
  assert (B : bp (-23) = / 8388608) by (simpl; lra). rewrite B. pose proof (UNIT_holds (n * / 8388608)) as E2.
  set (m := RNs (n * / 8388608)) in *. rewrite (Rabs_pos_eq (n * / 8388608)) in E2 by lra. apply Rabs_le_inv in E2.
  assert (m0 : 0 <= m) by (unfold m; apply RNs_above; [apply Fs_0 | lra]). pose proof (bp_pos (-126)).
  pose proof (UNIT_holds (m + bp (-126))) as E3. set (k := RNs (m + bp (-126))) in *.
  rewrite (Rabs_pos_eq (m + bp (-126))) in E3 by lra. apply Rabs_le_inv in E3.
  assert (k0 : 0 <= k) by (unfold k; apply RNs_above; [apply Fs_0 | lra]). pose proof (UNIT_holds (n + k)) as E4.
  rewrite (Rabs_pos_eq (n + k)) in E4 by lra. apply Rabs_le_inv in E4. rewrite v_val in *. lra.
Qed.
