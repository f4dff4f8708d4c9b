(* rt-geom, ray.rs: the range of all filters. *)
From Proofs Require Import Rounding Steps.
Open Scope R_scope.

(* The largest component of a direction lies between its inverse and it. *)
Definition LONGEST := bp 100.
(* So the square of the direction is in 2^-200 .. 2^202, and neither it nor its products with the squares of lengths
  up to 2^600 overflow or vanish. *)
Theorem LONGEST_holds : forall d1 d2 d3, / LONGEST <= Rmax (Rabs d1) (Rmax (Rabs d2) (Rabs d3)) <= LONGEST ->
  let A := d1 * d1 + d2 * d2 + d3 * d3 in bp (-200) <= A <= bp 202 /\ forall q, bp (-250) <= q <= bp 600 -> bp (-450)
    <= A * q <= bp 802.
Proof.
  intros d1 d2 d3 [L G] A. assert (I : / LONGEST = bp (-100)) by (unfold LONGEST; symmetry; apply (bpow_opp radix2
    100)). rewrite I in L. unfold LONGEST in G.
  pose proof (sq_pos d1). pose proof (sq_pos d2). pose proof (sq_pos d3). pose proof (bp_pos (-100)). pose proof
    (bp_pos 100).
  assert (G1 : Rabs d1 <= bp 100) by (eapply Rle_trans; [apply Rmax_l | exact G]).
  assert (G2 : Rabs d2 <= bp 100) by (eapply Rle_trans; [apply Rmax_l|]; eapply Rle_trans; [apply Rmax_r | exact G]).
  assert (G3 : Rabs d3 <= bp 100) by (eapply Rle_trans; [apply Rmax_r|]; eapply Rle_trans; [apply Rmax_r | exact G]).
  assert (U : forall d, Rabs d <= bp 100 -> d * d <= bp 200).
  { intros d H4. rewrite <- abs_sq. change 200%Z with (100 + 100)%Z. rewrite bp_add. pose proof (Rabs_pos d). apply
    Rmult_le_compat; assumption. }
  assert (V : forall d, bp (-100) <= Rabs d -> bp (-200) <= d * d).
  { intros d H4. rewrite <- abs_sq. change (-200)%Z with (-100 + -100)%Z. rewrite bp_add. apply Rmult_le_compat; lra. }
  assert (B : bp (-200) <= A <= bp 202).
  { split.
    - unfold A. destruct (Rle_or_lt (bp (-100)) (Rabs d1)) as [C|C]; [pose proof (V d1 C); lra|].
      destruct (Rle_or_lt (bp (-100)) (Rabs d2)) as [C2|C2]; [pose proof (V d2 C2); lra|].
      destruct (Rle_or_lt (bp (-100)) (Rabs d3)) as [C3|C3]; [pose proof (V d3 C3); lra|].
      assert (Rmax (Rabs d1) (Rmax (Rabs d2) (Rabs d3)) < bp (-100)) by (repeat apply Rmax_lub_lt; assumption). lra.
    - pose proof (U d1 G1). pose proof (U d2 G2). pose proof (U d3 G3). pose proof (bp_pos 200).
      assert (bp 202 = 4 * bp 200) by (change 202%Z with (2 + 200)%Z; rewrite bp_add; simpl (bp 2); lra). unfold A.
        lra. }
  split; [exact B|]. intros q Q. pose proof (bp_pos (-200)). pose proof (bp_pos (-250)). split.
  - change (-450)%Z with (-200 + -250)%Z. rewrite bp_add. apply Rmult_le_compat; lra.
  - change 802%Z with (202 + 600)%Z. rewrite bp_add. apply Rmult_le_compat; lra.
Qed.
