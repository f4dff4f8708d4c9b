(* rt-geom, enclosing/certify.rs: the next double, and rounding up. *)
From Proofs Require Import Rounding ErrorFree.
Open Scope R_scope.

(* A number times this, added to or taken from the number, gives the double after or before it. *)
Definition SPACING := u * (1 + 2 * u).

(* For numbers far from underflow: every number of an ordinary set that is rounded up is. *)
Section Next.
Variable a : R.
Hypotheses (Fa : F a) (Ha : bp (-900) <= a).
Let w := ulp radix2 fexp a.
Lemma a_pos : 0 < a. Proof. pose proof (bp_pos (-900)). lra. Qed.
Lemma spacing : exists k, (-901 <= k)%Z /\ w = bp (k - 52) /\ bp k <= a < bp (k + 1).
Proof.
  pose proof a_pos as A0. exists (mag radix2 a - 1)%Z.
  assert (M : bp (mag radix2 a - 1) <= a < bp (mag radix2 a)).
  { destruct (mag radix2 a) as [e He]. simpl. specialize (He ltac:(lra)). rewrite Rabs_pos_eq in He by lra. exact He. }
  assert (L : (-901 < mag radix2 a)%Z).
  { apply mag_gt_bpow. rewrite Rabs_pos_eq by lra. apply Rle_trans with (2 := Ha). apply bp_le. lia. }
  split; [lia|]. split.
  - unfold w. rewrite ulp_neq_0 by lra. f_equal. unfold cexp, fexp, FLT_exp. lia.
  - replace (mag radix2 a - 1 + 1)%Z with (mag radix2 a : Z) by ring. exact M.
Qed.
Let d := RN (a * SPACING).
Lemma step : / 2 * w < d < 3 / 2 * w.
Proof.
  destruct spacing as (k & K & W & L & H). pose proof u_pos as U. pose proof (bp_pos (k - 52)) as W0.
  rewrite <- W in W0.
  assert (S0 : 0 < SPACING) by (unfold SPACING; apply Rmult_lt_0_compat; lra).
  assert (HW : bp k = w * bp 52) by (rewrite W, <- bp_add; f_equal; ring).
  assert (B : bp 52 * u = / 2) by (unfold u; rewrite <- bp_add; simpl; lra).
  assert (Fs1 : F (/ 2 * w * (1 + 2 * u))).
  { replace (/ 2 * w * (1 + 2 * u)) with (IZR (2 ^ 52 + 1) * bp (k - 105)); [apply F_scaled; lia|].
    rewrite W. replace (k - 52)%Z with ((k - 105) + 53)%Z by ring. rewrite bp_add, u_val.
    change (bp 53) with 9007199254740992. change (2 ^ 52 + 1)%Z with 4503599627370497%Z. field. }
  assert (Fs2 : F (w * (1 + 2 * u))).
  { replace (w * (1 + 2 * u)) with (IZR (2 ^ 52 + 1) * bp (k - 104)); [apply F_scaled; lia|].
    rewrite W. replace (k - 52)%Z with ((k - 104) + 52)%Z by ring. rewrite bp_add, u_val.
    change (bp 52) with 4503599627370496. change (2 ^ 52 + 1)%Z with 4503599627370497%Z. field. }
  assert (E1 : bp k * SPACING = / 2 * w * (1 + 2 * u)).
  { rewrite HW. unfold SPACING. replace (w * bp 52 * (u * (1 + 2 * u))) with (bp 52 * u * w * (1 + 2 * u)) by ring.
    now rewrite B. }
  assert (E2 : bp (k + 1) * SPACING = w * (1 + 2 * u)).
  { rewrite bp_add, bp_1. replace (bp k * 2 * SPACING) with (2 * (bp k * SPACING)) by ring. rewrite E1. field. }
  split.
  - apply Rlt_le_trans with (/ 2 * w * (1 + 2 * u)); [nra|]. rewrite <- (RN_id _ Fs1). apply RN_le. rewrite <- E1.
    apply Rmult_le_compat_r; lra.
  - apply Rle_lt_trans with (w * (1 + 2 * u)); [|rewrite u_val; lra]. rewrite <- (RN_id _ Fs2). apply RN_le.
    rewrite <- E2. apply Rmult_le_compat_r; lra.
Qed.
Lemma w_pos : 0 < w. Proof. destruct spacing as (k & _ & W & _). rewrite W. apply bp_pos. Qed.
Lemma next : RN (a + d) = succ radix2 fexp a.
Proof.
  pose proof a_pos as A0. pose proof w_pos as W0. destruct step as [D1 D2].
  assert (S : succ radix2 fexp a = a + w) by (apply succ_eq_pos; lra).
  assert (FS : F (succ radix2 fexp a)) by (apply generic_format_succ; [typeclasses eauto | exact Fa]).
  apply Rle_antisym.
  - apply (round_N_le_midp radix2 fexp even); [exact FS|].
    assert (S2 : succ radix2 fexp (succ radix2 fexp a) = succ radix2 fexp a + ulp radix2 fexp (succ radix2 fexp a))
      by (apply succ_eq_pos; rewrite S; lra).
    rewrite S2. assert (w <= ulp radix2 fexp (succ radix2 fexp a)).
    { unfold w. apply ulp_le_pos; [typeclasses eauto | typeclasses eauto | lra | rewrite S; lra]. }
    rewrite S in *. lra.
  - apply (round_N_ge_midp radix2 fexp even); [exact FS|].
    rewrite pred_succ by (try typeclasses eauto; exact Fa). rewrite S. lra.
Qed.
Lemma before : RN (a - d) <= pred radix2 fexp a.
Proof.
  pose proof a_pos as A0. pose proof w_pos as W0. destruct step as [D1 D2].
  assert (FP : F (pred radix2 fexp a)) by (apply generic_format_pred; [typeclasses eauto | exact Fa]).
  apply (round_N_le_midp radix2 fexp even); [exact FP|].
  rewrite succ_pred by (try typeclasses eauto; exact Fa).
  assert (a - w <= pred radix2 fexp a).
  { pose proof (pred_plus_ulp radix2 fexp). assert (pred radix2 fexp a + ulp radix2 fexp (pred radix2 fexp a) = a).
    { apply pred_plus_ulp; [typeclasses eauto | lra | exact Fa]. }
    assert (ulp radix2 fexp (pred radix2 fexp a) <= w).
    { unfold w. apply ulp_le_pos; [typeclasses eauto | typeclasses eauto | apply pred_ge_0; [typeclasses eauto | lra |
      exact Fa] | apply pred_le_id]. }
    lra. }
  lra.
Qed.
End Next.
Theorem SPACING_holds : forall a, F a -> bp (-900) <= a ->
  RN (a + RN (a * SPACING)) = succ radix2 fexp a /\ RN (a - RN (a * SPACING)) <= pred radix2 fexp a.
Proof. intros a Fa Ha. split; [now apply next | now apply before]. Qed.

(* `round_up`: the smallest double that is not below high + low. *)
Definition rounded_up high low := let sum := RN (high + low) in let rest := fast_two_sum_error high low in
  if Rlt_dec 0 rest then RN (sum + RN (sum * SPACING)) else sum.
Theorem round_up : forall high low, F high -> F low -> Rabs low <= Rabs high -> bp (-900) <= RN (high + low) ->
  F (rounded_up high low) /\ high + low <= rounded_up high low /\
  forall R, F R -> high + low <= R -> rounded_up high low <= R.
Proof.
  intros high low Fh Fl L B. pose proof (fast_two_sum high low Fh Fl L) as E. unfold rounded_up.
  set (sum := RN (high + low)) in *. assert (Fs : F sum) by apply RN_F. destruct Rlt_dec as [P|P].
  - split; [apply RN_F|]. rewrite (next sum Fs B). split.
    + apply succ_round_ge_id; typeclasses eauto.
    + intros R FR H. apply succ_le_lt; [typeclasses eauto | exact Fs | exact FR | lra].
  - split; [exact Fs|]. split; [lra|]. intros R FR H. rewrite <- (RN_id R FR). apply RN_le. exact H.
Qed.
