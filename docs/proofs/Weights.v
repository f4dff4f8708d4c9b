(* rt-geom, triangle/locate.rs: a weight in double-double, `double_double_weights_kernel`. *)
From Proofs Require Import Rounding DoubleDouble Round.
Open Scope R_scope.

(* The error of a quotient of a turn by n.n, relative to the errors of both over n.n. *)
Definition WEIGHT_FACTOR := 12 / 10.
(* The error of the division and of the rounding test, relative to the quotient. *)
Definition DIVISION_ERROR := 32 * u * u.
(* Swallows what underflow does to a weight. *)
Definition UNDERFLOW_WEIGHT := bp (-1000).

Section Weight.
(* the exact turn and n.n; both as computed, with their bounds; the high part of n.n; the quotient h + l *)
Variables T Q t s high te se h l error : R.
Hypotheses (Ht : Rabs (t - T) <= te) (Hs : Rabs (s - Q) <= se) (Hhigh : (1 - u) * s <= high <= (1 + u) * s) (h0 : 0 <
  high)
  (Heighth : 8 * se <= high) (Hd : dd h l) (Hq : Rabs (h + l - t / s) <= QUOTIENT * (u * u) * Rabs (t / s) + bp
    (-1070)).
Hypothesis Herror : (1 - 16 * u) *
  (WEIGHT_FACTOR * (te + Rabs h * se) / high + DIVISION_ERROR * Rabs h + UNDERFLOW_WEIGHT) <= error.

(* The bound, as the rounding test wants it. *)
Theorem WEIGHT_FACTOR_holds : 0 < Q /\ Rabs (T / Q - (h + l)) <= error - u * (Rabs l + error).
Proof.
  pose proof u_pos. pose proof (dd_low _ _ Hd) as L. pose proof (Rabs_pos (t - T)). pose proof (Rabs_pos (s - Q)).
  assert (s0 : 0 < s) by (rewrite u_val in *; lra). pose proof Hs as Hs'. apply Rabs_le_inv in Hs'.
  assert (Q1 : (7 / 8 - u) * s <= Q) by (rewrite u_val in *; lra). assert (Q0 : 0 < Q) by (rewrite u_val in *; lra).
  split; [exact Q0|].
  set (q := t / s) in *. assert (tq : t = q * s) by (unfold q; field; lra). set (m := Rabs q) in *.
  assert (m0 : 0 <= m) by apply Rabs_pos.
  (* q against T / Q, times high *)
  assert (D : Rabs (T / Q - q) * high <= (1143 / 1000) * (te + m * se)).
  { assert (P : Rabs (T / Q - q) * Q <= te + m * se).
    { rewrite <- (Rabs_pos_eq Q) at 2 by lra. rewrite <- Rabs_mult.
      replace ((T / Q - q) * Q) with (- (t - T) + q * (s - Q)) by (rewrite tq; field; lra).
      eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp, Rabs_mult. fold m.
      assert (m * Rabs (s - Q) <= m * se) by (apply Rmult_le_compat_l; assumption). lra. }
    pose proof (Rabs_pos (T / Q - q)). set (R0 := Rabs (T / Q - q)) in *.
    assert (R0 * high <= R0 * ((11429 / 10000) * Q)) by (apply Rmult_le_compat_l; [assumption | rewrite u_val in *;
      lra]).
    assert (0 <= te + m * se) by (pose proof (Rmult_le_pos m se m0 ltac:(lra)); lra). lra. }
  (* |h| against m *)
  assert (B : Rabs (h + l) >= (1 - 15 * (u * u)) * m - bp (-1070)).
  { pose proof (Rabs_triang (h + l) (- (h + l - q))) as P. replace (h + l + - (h + l - q)) with q in P by ring.
  rewrite Rabs_Ropp in P.
    fold m in P. unfold QUOTIENT in Hq. rewrite u_val in *. lra. }
  destruct (dd_value _ _ Hd) as [_ V]. pose proof (Rabs_pos h).
  assert (M : m <= (1 + 3 * u) * Rabs h + 2 * bp (-1070)) by (pose proof (bp_pos (-1070)); rewrite u_val in *; lra).
  assert (U : bp (-1070) <= / 1000000000000 * UNDERFLOW_WEIGHT) by (apply bp_part12; lia).
  assert (U0 : 0 < UNDERFLOW_WEIGHT) by apply bp_pos.
  set (a := Rabs h) in *. set (z := UNDERFLOW_WEIGHT) in *. clearbody z.
  (* te + m se over high *)
  set (g := (te + a * se) / high). assert (gh : g * high = te + a * se) by (unfold g; field; lra).
  assert (g0 : 0 <= g) by (unfold g; apply Rmult_le_pos; [pose proof (Rmult_le_pos a se ltac:(lra) ltac:(lra));
    lra | apply Rlt_le, Rinv_0_lt_compat; assumption]).
  assert (D2 : Rabs (T / Q - q) <= (1144 / 1000) * g + / 100000000000 * z).
  { apply Rmult_le_reg_r with high; [assumption|]. rewrite Rmult_plus_distr_r, (Rmult_assoc _ g), gh.
    assert (m * se <= (1 + 3 * u) * (a * se) + / 500000000000 * (z * se)).
    { apply Rle_trans with (((1 + 3 * u) * a + / 500000000000 * z) * se); [apply Rmult_le_compat_r; lra | lra]. }
    assert (z * se <= z * high) by (apply Rmult_le_compat_l; lra).
    assert (0 <= a * se) by (apply Rmult_le_pos; lra). assert (0 <= z * high) by (apply Rmult_le_pos; lra).
    eapply Rle_trans; [exact D|]. rewrite u_val in *. lra. }
  replace (WEIGHT_FACTOR * (te + a * se) / high) with (12 / 10 * g) in Herror by (unfold WEIGHT_FACTOR, g; field; lra).
  unfold DIVISION_ERROR in Herror. unfold QUOTIENT in Hq.
  replace (T / Q - (h + l)) with ((T / Q - q) - (h + l - q)) by ring. unfold Rminus at 1.
  eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. rewrite u_val in *. lra.
Qed.
Theorem DIVISION_ERROR_holds : F error -> 0 <= error -> RN (h + RN (l - error)) = RN (h + RN (l + error)) ->
  RN (h + RN (l + error)) = RN (T / Q).
Proof.
  intros Fe E0 Same. destruct WEIGHT_FACTOR_holds as [_ W]. destruct Hd as (Fh & Fl & _).
  now apply (Round.round_if_certain (T / Q) h l error).
Qed.
(* What underflows in the quotient is below a part of 10^12 of UNDERFLOW_WEIGHT. *)
Theorem UNDERFLOW_WEIGHT_holds : bp (-1070) <= / 1000000000000 * UNDERFLOW_WEIGHT.
Proof. apply bp_part12. lia. Qed.
End Weight.
