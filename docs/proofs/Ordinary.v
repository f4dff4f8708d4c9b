(* rt-geom, enclosing/tangent.rs: sets of ordinary size. *)
From Proofs Require Import Rounding.
Open Scope R_scope.

(* The largest reach of an ordinary set, and a number between its square and half of that. *)
Definition ORDINARY_START := 1 / 10000000000000000000000000000000000000000.
Definition ORDINARY_END := 100000000000000000000000000000000000000000000000000.
Definition SQUARES_START := 1 / 100000000000000000000000000000000000000000000000000000000000000000000000000000000.
Definition SQUARES_END := 5000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000.

(* What underflows is nothing beside the last bits of double-double, squared. *)
Theorem ORDINARY_START_holds : bp (-133) <= ORDINARY_START /\
  forall x, ORDINARY_START <= x -> bp (-1000) <= / 1000000000000 * (u * u * (x * x)).
Proof.
  assert (S : bp (-133) <= ORDINARY_START).
  { change (-133)%Z with (Z.opp 133). rewrite bpow_opp, <- (IZR_Zpower radix2 133) by discriminate.
  unfold ORDINARY_START, Rdiv.
    rewrite Rmult_1_l. apply Rinv_le_contravar; [lra|]. apply IZR_le. vm_compute. discriminate. }
  split; [exact S|]. intros x X. apply Rle_trans with (bp (-40 + (-53 + -53 + (-133 + -133)))); [apply bp_le; lia|].
  rewrite !bp_add. fold u. pose proof (bp_pos (-133)). pose proof u_pos.
  assert (XX : bp (-133) * bp (-133) <= x * x) by (apply mul2; split; lra).
  assert (U2 : 0 <= u * u) by (apply Rmult_le_pos; lra). assert (B : bp (-40) <= / 1000000000000) by (simpl; lra).
  pose proof (bp_pos (-40)). apply Rmult_le_compat; try lra.
  - apply Rmult_le_pos; [assumption|]. apply Rmult_le_pos; lra.
  - apply Rmult_le_compat_l; assumption.
Qed.
(* Fourth powers are far from overflow. *)
Theorem ORDINARY_END_holds : ORDINARY_END <= bp 167 /\ forall x, 0 <= x < ORDINARY_END -> x * x * (x * x) <= bp 668.
Proof.
  assert (E : ORDINARY_END <= bp 167).
  { rewrite <- (IZR_Zpower radix2 167) by discriminate. apply IZR_le. vm_compute. discriminate. }
  split; [exact E|]. intros x X. change 668%Z with ((167 + 167) + (167 + 167))%Z. rewrite !bp_add.
  apply mul2; split; try apply sq_pos; apply mul2; split; lra.
Qed.
(* A number between the square of the largest reach and half of that tells as much of the reach. *)
Theorem SQUARES_START_holds : forall x q, 0 <= x -> q <= x * x -> SQUARES_START <= q -> ORDINARY_START <= x.
Proof.
  intros x q X H S. apply below_root; [assumption|]. apply Rle_trans with (2 := H). apply Rle_trans with (2 := S).
  unfold ORDINARY_START, SQUARES_START. lra.
Qed.
Theorem SQUARES_END_holds : forall x q, 0 <= x -> / 2 * (x * x) <= q -> q < SQUARES_END -> x < ORDINARY_END.
Proof.
  intros x q X H S. apply Rnot_le_lt. intro C. assert (ORDINARY_END * ORDINARY_END <= x * x) by (apply mul2; split;
    unfold ORDINARY_END in *; lra). unfold ORDINARY_END, SQUARES_END in *. lra.
Qed.
