(* rt-math, exact/dot.rs: the sign of a dot product in doubles. *)
From Proofs Require Import Rounding.
Open Scope R_scope.

(* Bound of the error of a dot product: this part of the sum of the magnitudes of its terms. *)
Definition ERROR := bp (-51).
(* The same where one factor is a rounded difference. *)
Definition DIFFERENCE_ERROR := bp (-50).
(* ... and an absolute one for terms that underflow. *)
Definition ERROR_FLOOR := bp (-1022).

(* The sum of three terms, and the bound of its error: `sum_with_error` in the code. *)
Definition sum3 a b c := Add (Add a b) c.
Definition sum_with_error a b c e q := Add (Mul (Add (Add (Abs a) (Abs b)) (Abs c)) (X e q)) (X ERROR_FLOOR (-1022)).

Lemma floor_abs : Rabs ERROR_FLOOR <= bp (-1022).
Proof. unfold ERROR_FLOOR. rewrite Rabs_pos_eq; [lra | apply Rlt_le, bp_pos]. Qed.
Lemma below : forall k, (k <= -1062)%Z -> bp k <= / 1000000000000 * ERROR_FLOOR.
Proof.
  intros k H. apply Rle_trans with (bp (-1062)); [now apply bp_le|]. unfold ERROR_FLOOR.
  replace (-1062)%Z with (-40 + -1022)%Z by reflexivity. rewrite bp_add.
  apply Rmult_le_compat_r; [apply Rlt_le, bp_pos|].
  simpl. lra.
Qed.

Section Dot.
Variables a1 a2 a3 b1 b2 b3 n1 n2 n3 : R.
Hypotheses (A1 : Rabs a1 <= bp 1024) (A2 : Rabs a2 <= bp 1024) (A3 : Rabs a3 <= bp 1024)
           (B1 : Rabs b1 <= bp 1024) (B2 : Rabs b2 <= bp 1024) (B3 : Rabs b3 <= bp 1024)
           (N1 : Rabs n1 <= bp 1024) (N2 : Rabs n2 <= bp 1024) (N3 : Rabs n3 <= bp 1024).
Let T x y := Mul (X x 1024) (X y 1024).
Let S x y z := Mul (D x y 1025) (X z 1024).

(* The rounded a . b is off by at most the bound as it is computed, for any doubles. *)
Theorem ERROR_holds : forall v e,
  plain (sum3 (T a1 b1) (T a2 b2) (T a3 b3)) v ->
  plain (sum_with_error (T a1 b1) (T a2 b2) (T a3 b3) ERROR (-51)) e ->
  Rabs (v - (a1 * b1 + a2 * b2 + a3 * b3)) <= e.
Proof.
  unfold sum3, sum_with_error, T. intros v e Hv He. error_of Hv V. pose proof floor_abs.
  assert (Rabs ERROR <= bp (-51)) by (unfold ERROR; rewrite Rabs_pos_eq; [lra | apply Rlt_le, bp_pos]).
  error_of He W. pose proof (Rabs_pos a1). 
  set (A := Rabs a1 * Rabs b1 + Rabs a2 * Rabs b2 + Rabs a3 * Rabs b3) in *.
  assert (0 <= A) by (unfold A; pose proof (Rabs_pos a2); pose proof (Rabs_pos a3); pose proof (Rabs_pos b1);
    pose proof (Rabs_pos b2); pose proof (Rabs_pos b3); nra).
  assert (E : ERROR = 4 * u) by (rewrite u_val; unfold ERROR; simpl; lra).
  rewrite (Rabs_pos_eq ERROR) in W by (rewrite E; pose proof u_pos; lra).
  assert (0 < ERROR_FLOOR) by apply bp_pos. rewrite (Rabs_pos_eq ERROR_FLOOR) in W by lra. rewrite E in W.
  repeat match goal with H : _ <= _ + bp ?k |- _ => pose proof (below k ltac:(lia)); generalize dependent (bp k);
    intros end.
  apply Rabs_le_inv in W. rewrite u_val in *.
  lra.
Qed.
(* The same of the rounded <a - b|n>. *)
Theorem DIFFERENCE_ERROR_holds : forall v e,
  Rabs (a1 - b1) <= bp 1025 -> Rabs (a2 - b2) <= bp 1025 -> Rabs (a3 - b3) <= bp 1025 ->
  plain (sum3 (S a1 b1 n1) (S a2 b2 n2) (S a3 b3 n3)) v ->
  plain (sum_with_error (S a1 b1 n1) (S a2 b2 n2) (S a3 b3 n3) DIFFERENCE_ERROR (-50)) e ->
  Rabs (v - ((a1 - b1) * n1 + (a2 - b2) * n2 + (a3 - b3) * n3)) <= e.
Proof.
  unfold sum3, sum_with_error, S. intros v e D1 D2 D3 Hv He. error_of Hv V. pose proof floor_abs.
  assert (Rabs DIFFERENCE_ERROR <= bp (-50))
    by (unfold DIFFERENCE_ERROR; rewrite Rabs_pos_eq; [lra | apply Rlt_le, bp_pos]).
  error_of He W. pose proof (Rabs_pos n1).
  set (A := Rabs (a1 - b1) * Rabs n1 + Rabs (a2 - b2) * Rabs n2 + Rabs (a3 - b3) * Rabs n3) in *.
  assert (0 <= A) by (unfold A; pose proof (Rabs_pos n2); pose proof (Rabs_pos n3); pose proof (Rabs_pos (a1 - b1));
    pose proof (Rabs_pos (a2 - b2)); pose proof (Rabs_pos (a3 - b3)); nra).
  assert (E : DIFFERENCE_ERROR = 8 * u) by (rewrite u_val; unfold DIFFERENCE_ERROR; simpl; lra).
  rewrite (Rabs_pos_eq DIFFERENCE_ERROR) in W by (rewrite E; pose proof u_pos; lra).
  assert (0 < ERROR_FLOOR) by apply bp_pos. rewrite (Rabs_pos_eq ERROR_FLOOR) in W by lra. rewrite E in W.
  repeat match goal with H : _ <= _ + bp ?k |- _ => pose proof (below k ltac:(lia)); generalize dependent (bp k);
    intros end.
  apply Rabs_le_inv in W. rewrite u_val in *. lra.
Qed.

(* The floor, as both theorems use it: all that underflows is below a part of 10^12 of it. *)
Theorem ERROR_FLOOR_holds : forall v e,
  plain (sum3 (T a1 b1) (T a2 b2) (T a3 b3)) v ->
  plain (sum_with_error (T a1 b1) (T a2 b2) (T a3 b3) ERROR (-51)) e ->
  (v > e -> 0 < a1 * b1 + a2 * b2 + a3 * b3) /\ (v < - e -> a1 * b1 + a2 * b2 + a3 * b3 < 0).
Proof. intros v e Hv He. apply certain_sign. now apply ERROR_holds. Qed.
End Dot.

(* In words of the code: every operation rounds to nearest. *)
Theorem dot_sign : forall a1 a2 a3 b1 b2 b3,
  Rabs a1 <= bp 1024 -> Rabs a2 <= bp 1024 -> Rabs a3 <= bp 1024 ->
  Rabs b1 <= bp 1024 -> Rabs b2 <= bp 1024 -> Rabs b3 <= bp 1024 ->
  let v := RN (RN (RN (a1 * b1) + RN (a2 * b2)) + RN (a3 * b3)) in
  let s := RN (RN (Rabs (RN (a1 * b1)) + Rabs (RN (a2 * b2))) + Rabs (RN (a3 * b3))) in
  let e := RN (RN (s * ERROR) + ERROR_FLOOR) in
  (v > e -> 0 < a1 * b1 + a2 * b2 + a3 * b3) /\ (v < - e -> a1 * b1 + a2 * b2 + a3 * b3 < 0).
Proof.
  intros. apply ERROR_FLOOR_holds; auto; unfold sum3, sum_with_error, v, s, e; plain_terms.
Qed.
