(* rt-math, exact/round.rs: the rounding test. *)
From Proofs Require Import Rounding.
Open Scope R_scope.

(* If |x - (h + l)| <= e - u (|l| + e) and both rounded ends are the same double, that is x rounded to nearest. *)
Theorem round_if_certain : forall x h l e, F h -> F l -> F e -> 0 <= e ->
  Rabs (x - (h + l)) <= e - u * (Rabs l + e) -> RN (h + RN (l - e)) = RN (h + RN (l + e)) -> RN (h + RN (l + e)) = RN x.
Proof.
  intros x h l e Fh Fl Fe E0 H Same.
  pose proof (RN_sum l e Fl Fe) as P1. pose proof (RN_diff l e Fl Fe) as P2.
  assert (Q1 : Rabs (RN (l + e) - (l + e)) <= u * (Rabs l + e)).
  { eapply Rle_trans; [exact P1|]. apply Rmult_le_compat_l; [apply Rlt_le, u_pos|].
    eapply Rle_trans; [apply Rabs_triang|]. rewrite (Rabs_pos_eq e) by assumption. lra. }
  assert (Q2 : Rabs (RN (l - e) - (l - e)) <= u * (Rabs l + e)).
  { eapply Rle_trans; [exact P2|]. apply Rmult_le_compat_l; [apply Rlt_le, u_pos|]. unfold Rminus.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp, (Rabs_pos_eq e) by assumption. lra. }
  apply Rabs_le_inv in H. apply Rabs_le_inv in Q1. apply Rabs_le_inv in Q2.
  apply Rle_antisym.
  - rewrite <- Same. apply RN_le. lra.
  - apply RN_le. lra.
Qed.
