(* figures, import/polygon.rs: which way three points turn, `orientation`. *)
From Proofs Require Import Rounding.
Open Scope R_scope.

(* The error of left - right, relative to |left| + |right|. *)
Definition TURN_ERROR := 4 * u.

Theorem TURN_ERROR_holds : forall p0 p1 q0 q1 r0 r1 left right,
  Rabs (q0 - p0) <= bp 1025 -> Rabs (r1 - p1) <= bp 1025 -> Rabs (q1 - p1) <= bp 1025 -> Rabs (r0 - p0) <= bp 1025 ->
  plain (Mul (D q0 p0 1025) (D r1 p1 1025)) left -> plain (Mul (D q1 p1 1025) (D r0 p0 1025)) right ->
  F left -> F right ->
  let value := RN (left - right) in let error := RN (RN (TURN_ERROR * RN (Rabs left + Rabs right)) + bp (-1022)) in
  let exactly := (q0 - p0) * (r1 - p1) - (q1 - p1) * (r0 - p0) in
  (value > error -> 0 < exactly) /\ (value < - error -> exactly < 0).
Proof.
  intros p0 p1 q0 q1 r0 r1 left right B1 B2 B3 B4 Hl Hr Fl Fr value error exactly.
  error_of Hl P1. error_of Hr P2. rewrite <- Rabs_mult in P1, P2.
  set (L := (q0 - p0) * (r1 - p1)) in *. set (Q := (q1 - p1) * (r0 - p0)) in *.
  pose proof (RN_diff left right Fl Fr) as E1. fold value in E1.
  assert (Fa : forall x, F x -> F (Rabs x)) by (intros x Fx; now apply generic_format_abs).
  pose proof (RN_sum (Rabs left) (Rabs right) (Fa _ Fl) (Fa _ Fr)) as E2. set (s := RN (Rabs left + Rabs right)) in *.
  pose proof (RN_err (TURN_ERROR * s)) as E3. set (k := RN (TURN_ERROR * s)) in *.
  assert (E4 : Rabs (error - (k + bp (-1022))) <= u * Rabs (k + bp (-1022))) by (apply RN_sum;
    [apply RN_F | apply F_bp; lia]).
  small12 (-1022)%Z. set (T := bp (-1022)) in *. 
  pose proof (Rabs_pos left). pose proof (Rabs_pos right). pose proof (Rabs_pos L). pose proof (Rabs_pos Q).
  assert (A1 : Rabs L <= (1 + 4 * u) * Rabs left + / 100000000000 * T).
  { pose proof (Rabs_triang left (- (left - L))) as Y. replace (left + - (left - L)) with L in Y by ring.
  rewrite Rabs_Ropp in Y.
    rewrite u_val in *. lra. }
  assert (A2 : Rabs Q <= (1 + 4 * u) * Rabs right + / 100000000000 * T).
  { pose proof (Rabs_triang right (- (right - Q))) as Y. replace (right + - (right - Q)) with Q in Y by ring.
  rewrite Rabs_Ropp in Y.
    rewrite u_val in *. lra. }
  set (a := Rabs left) in *. set (b := Rabs right) in *. rewrite (Rabs_pos_eq (a + b)) in E2 by lra.
  apply Rabs_le_inv in E2. assert (S0 : 0 <= s) by (rewrite u_val in E2; lra).
  unfold TURN_ERROR in E3. rewrite (Rabs_pos_eq (4 * u * s)) in E3 by (rewrite u_val; lra). apply Rabs_le_inv in E3.
  assert (K0 : - T <= k) by (rewrite u_val in *; lra). rewrite (Rabs_pos_eq (k + T)) in E4 by lra.
  apply Rabs_le_inv in E4.
  assert (LOW : (4 - / 1000) * u * (a + b) + (1 - / 1000) * T <= error) by (rewrite u_val in *; lra).
  assert (D0 : Rabs (left - right - exactly) <= (3 + / 500) * u * (a + b) + / 1000 * T).
  { unfold exactly. replace (left - right - (L - Q)) with ((left - L) - (right - Q)) by ring. unfold Rminus at 1.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. rewrite u_val in *. lra. }
  apply Rabs_le_inv in D0. assert (0 <= a + b) by lra. set (ab := a + b) in *. clearbody ab.
  split; intro V.
  - assert (0 < left - right).
    { destruct (Rle_or_lt (left - right) 0) as [N|N]; [|exact N].
    assert (value <= 0) by (rewrite <- RN_0; now apply RN_le).
      rewrite u_val in *. lra. }
    rewrite (Rabs_pos_eq (left - right)) in E1 by lra. apply Rabs_le_inv in E1. rewrite u_val in *. lra.
  - assert (left - right < 0).
    { destruct (Rle_or_lt 0 (left - right)) as [N|N]; [|exact N].
    assert (0 <= value) by (rewrite <- RN_0; now apply RN_le).
      rewrite u_val in *. lra. }
    rewrite (Rabs_left (left - right)) in E1 by lra. apply Rabs_le_inv in E1. rewrite u_val in *. lra.
Qed.
