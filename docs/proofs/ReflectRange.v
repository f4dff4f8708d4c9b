(* rt-math, reflect.rs: the range of the stage in double-double. *)
From Proofs Require Import Rounding Steps.
Open Scope R_scope.

(* The sizes of the dot products lie between its inverse and it. *)
Definition WINDOW := bp 500.
(* Swallows what underflows in a component. *)
Definition ERROR_FLOOR := bp (-800).

(* a the sum of the magnitudes of the terms of v.n, as computed by three roundings in a row; b that of n.n. What
  underflows in either, eleven errors of
   2^-1070 at most, is below a part of 10^12 of u^2 a; the components of n are below 2^251, and so k = 2 v.n / n.n
     below 2^1003. *)
Theorem WINDOW_holds : forall v1 v2 v3 n1 n2 n3 a b, let A := Rabs (v1 * n1) + Rabs (v2 * n2) + Rabs (v3 * n3) in let
  N := n1 * n1 + n2 * n2 + n3 * n3 in
  Rabs (a - A) <= 4 * u * A + bp (-1070) -> Rabs (b - N) <= 4 * u * N + bp (-1070) -> / WINDOW < a < WINDOW -> /
    WINDOW < b < WINDOW ->
  11 * bp (-1070) <= / 1000000000000 * (u * u * A) /\ 11 * bp (-1070) <= / 1000000000000 * (u * u * N) /\
  Rabs n1 <= bp 251 /\ Rabs n2 <= bp 251 /\ Rabs n3 <= bp 251 /\ Rabs (2 * (v1 * n1 + v2 * n2 + v3 * n3) / N) <= bp
    1003.
Proof.
  intros v1 v2 v3 n1 n2 n3 a b A N Ha Hb [A1 A2] [B1 B2]. pose proof u_pos as up.
  assert (W : / WINDOW = bp (-500)) by (unfold WINDOW; symmetry; apply (bpow_opp radix2 500)). rewrite W in *. unfold
    WINDOW in *.
  assert (A0 : 0 <= A) by (unfold A; pose proof (Rabs_pos (v1 * n1)); pose proof (Rabs_pos (v2 * n2)); pose proof
    (Rabs_pos (v3 * n3)); lra).
  assert (N0 : 0 <= N) by apply sum_sq_pos. apply Rabs_le_inv in Ha. apply Rabs_le_inv in Hb.
  assert (T : bp (-1070) <= / 1000000000000 * bp (-500)) by (apply bp_part12; lia). pose proof (bp_pos (-1070)). pose
    proof (bp_pos (-500)). pose proof (bp_pos 500).
  assert (T5 : bp (-1070) <= / 1000000000000 * bp 500) by (apply bp_part12; lia).
  assert (F1 : bp (-500) = 2 * bp (-501)) by (change (-500)%Z with (1 + -501)%Z; rewrite bp_add, bp_1; ring).
  assert (F2 : bp 501 = 2 * bp 500) by (change 501%Z with (1 + 500)%Z; rewrite bp_add, bp_1; ring).
  assert (AL : bp (-501) <= A <= bp 501) by (rewrite u_val in *; lra). assert (NL : bp (-501) <= N <= bp 501) by
    (rewrite u_val in *; lra).
  assert (X : forall Y, bp (-501) <= Y -> 11 * bp (-1070) <= / 1000000000000 * (u * u * Y)).
  { intros Y HY. apply Rle_trans with (/ 1000000000000 * (u * u * bp (-501))); [|apply Rmult_le_compat_l; [lra|];
    apply Rmult_le_compat_l; [apply sq_pos | exact HY]].
    apply Rle_trans with (bp 4 * bp (-1070)); [apply Rmult_le_compat_r; [lra | simpl; lra]|]. apply Rle_trans with (bp
      (-40) * (u * u * bp (-501))).
    - unfold u. rewrite <- !bp_add. apply bp_le. lia.
    - apply Rmult_le_compat_r; [apply Rmult_le_pos; [apply sq_pos | apply Rlt_le, bp_pos] | simpl; lra]. }
  split; [now apply X|]. split; [now apply X|].
  assert (S : forall n, n * n <= N -> Rabs n <= bp 251).
  { intros n Hn. apply abs_below; [apply Rlt_le, bp_pos|]. rewrite bp_sq. apply Rle_trans with (bp 501); [lra | apply
    bp_le; lia]. }
  pose proof (sq_pos n1). pose proof (sq_pos n2). pose proof (sq_pos n3). split; [apply S; unfold N; lra|]. split;
    [apply S; unfold N; lra|]. split; [apply S; unfold N; lra|].
  pose proof (bp_pos (-501)). apply Rabs_div_le; [lra|]. rewrite (Rabs_pos_eq N) by lra. rewrite Rabs_mult,
    (Rabs_pos_eq 2) by lra.
  assert (D : Rabs (v1 * n1 + v2 * n2 + v3 * n3) <= A) by (eapply Rle_trans; [apply Rabs_triang|]; apply
    Rplus_le_compat_r, Rabs_triang).
  apply Rle_trans with (bp 1003 * bp (-501)).
  - rewrite <- bp_add. change (1003 + -501)%Z with (1 + 501)%Z. rewrite bp_add, bp_1. lra.
  - apply Rmult_le_compat_l; [apply Rlt_le, bp_pos | lra].
Qed.
(* k and k_low may underflow, by 2^-1073 together, times a component of n; then the product k n, by 2^-1070. *)
Theorem ERROR_FLOOR_holds : forall n, Rabs n <= bp 251 -> bp (-1073) * Rabs n + bp (-1070) <= / 1000000 * ERROR_FLOOR.
Proof.
  intros n H. unfold ERROR_FLOOR. assert (bp (-1073) * Rabs n <= bp (-822)) by (apply Rle_trans with (bp (-1073) * bp
    251); [apply Rmult_le_compat_l; [apply Rlt_le, bp_pos | assumption] | rewrite <- bp_add; apply bp_le; lia]).
  assert (bp (-1070) <= bp (-822)) by (apply bp_le; lia).
  assert (E : bp (-821) = 2 * bp (-822)) by (change (-821)%Z with (1 + -822)%Z; rewrite bp_add, bp_1; ring).
  apply Rle_trans with (bp (-821)); [lra|]. apply Rle_trans with (bp (-20) * bp (-800)); [rewrite <- bp_add; apply
    bp_le; lia|].
  apply Rmult_le_compat_r; [apply Rlt_le, bp_pos | simpl; lra].
Qed.
