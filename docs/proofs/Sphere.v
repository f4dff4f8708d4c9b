(* rt-geom, sphere/filter.rs, sphere/finish.rs, sphere/lanes.rs and sphere/mod.rs: a line and a sphere in plain doubles,
   for one ray and for eight. *)
From Proofs Require Import Rounding Candidates.
Open Scope R_scope.

(* Where the filter's bounds are proved: w.w + r^2 is at least 2^-250 and at most 2^600. *)
Definition SMALLEST := bp (-250).
Definition LARGEST := bp 600.
(* The error of Delta in the filter, relative to d.d (w.w + r^2). *)
Definition ERROR := 17 * u.
(* The error of the side of a point, relative to w.w + r^2, and what underflows. *)
Definition SIDE_ERROR := 7 * u.
Definition UNDERFLOW := bp (-1000).
(* Where the sign of c is certain, relative to w.w + r^2. *)
Definition FIRST_AHEAD := 14 * u.

(* Three components, each off by k of its permanent m and by t: their squares. *)
Lemma squares : forall k t x1 x2 x3 X1 X2 X3 m1 m2 m3 N, 0 <= k <= 1 -> 0 <= t <= N ->
  Rabs (x1 - X1) <= k * m1 + t -> Rabs (x2 - X2) <= k * m2 + t -> Rabs (x3 - X3) <= k * m3 + t ->
  Rabs X1 <= m1 <= N -> Rabs X2 <= m2 <= N -> Rabs X3 <= m3 <= N ->
  Rabs (x1 * x1 + x2 * x2 + x3 * x3 - (X1 * X1 + X2 * X2 + X3 * X3)) <=
    2 * k * (m1 * Rabs X1 + m2 * Rabs X2 + m3 * Rabs X3) + k * k * (m1 * m1 + m2 * m2 + m3 * m3) + 15 * (t * N).
Proof.
  intros k t x1 x2 x3 X1 X2 X3 m1 m2 m3 N Hk Ht E1 E2 E3 M1 M2 M3.
  assert (S : forall x X m, Rabs (x - X) <= k * m + t -> Rabs X <= m <= N ->
    Rabs (x * x - X * X) <= 2 * k * (m * Rabs X) + k * k * (m * m) + 5 * (t * N)).
  { intros x X m E M. replace (x * x - X * X) with ((x - X) * (x - X) + 2 * (X * (x - X))) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite !Rabs_mult. pose proof (Rabs_pos X). pose proof (Rabs_pos (x - X)).
    rewrite (Rabs_pos_eq 2) by lra.
    assert (Rabs (x - X) * Rabs (x - X) <= (k * m + t) * (k * m + t)) by (apply Rmult_le_compat; lra).
    assert (Rabs X * Rabs (x - X) <= Rabs X * (k * m + t)) by (apply Rmult_le_compat_l; lra).
    assert (0 <= m) by lra. assert (T1 : t * m <= t * N) by (apply Rmult_le_compat_l; lra).
    assert (0 <= t * m) by (apply Rmult_le_pos; lra).
    assert (T2 : k * (t * m) <= t * N) by (apply Rle_trans with (1 * (t * m)); [apply Rmult_le_compat_r; lra | lra]).
    assert (T3 : t * t <= t * N) by (apply Rmult_le_compat_l; lra).
    assert (T4 : Rabs X * t <= t * N) by (rewrite Rmult_comm; apply Rmult_le_compat_l; lra).
    replace ((k * m + t) * (k * m + t)) with (k * k * (m * m) + 2 * (k * (t * m)) + t * t) in * by ring.
    replace (Rabs X * (k * m + t)) with (k * (m * Rabs X) + Rabs X * t) in * by ring. lra. }
  pose proof (S _ _ _ E1 M1). pose proof (S _ _ _ E2 M2). pose proof (S _ _ _ E3 M3).
  replace (x1 * x1 + x2 * x2 + x3 * x3 - (X1 * X1 + X2 * X2 + X3 * X3)) with
    ((x1 * x1 - X1 * X1) + (x2 * x2 - X2 * X2) + (x3 * x3 - X3 * X3)) by ring.
  eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|]. lra.
Qed.

Section Sphere.
(* origin, center, radius, direction *)
Variables o1 o2 o3 c1 c2 c3 r d1 d2 d3 : R.
Let W1 := o1 - c1. Let W2 := o2 - c2. Let W3 := o3 - c3.
Let A := d1 * d1 + d2 * d2 + d3 * d3.
Let WW := W1 * W1 + W2 * W2 + W3 * W3.
Let X1 := W2 * d3 - W3 * d2. Let X2 := W3 * d1 - W1 * d3. Let X3 := W1 * d2 - W2 * d1.
Let Delta := A * (r * r) - (X1 * X1 + X2 * X2 + X3 * X3).
Let B := W1 * d1 + W2 * d2 + W3 * d3.
Let C := WW - r * r.
Let Q := WW + r * r.

(* Lagrange: Delta is the discriminant of A t^2 + 2 B t + C. *)
Lemma discriminant : Delta = B * B - A * C.
Proof. unfold Delta, B, C, A, WW, X1, X2, X3. ring. Qed.

Section Terms.
Variable q : Z.
Definition tdot3 a1 a2 a3 b1 b2 b3 := Add (Add (Mul a1 b1) (Mul a2 b2)) (Mul a3 b3).
Definition w1 := D o1 c1 q. Definition w2 := D o2 c2 q. Definition w3 := D o3 c3 q.
Definition tw := tdot3 w1 w2 w3 w1 w2 w3.
Definition tr := Mul (X r q) (X r q).
Definition tsquares := Add tw tr.
Definition tc := Sub tw tr.
Definition ta := let x d := X d 100 in tdot3 (x d1) (x d2) (x d3) (x d1) (x d2) (x d3).
Definition tb := let x d := X d 100 in tdot3 w1 w2 w3 (x d1) (x d2) (x d3).
Definition tx a b c d := Sub (Mul a (X b 100)) (Mul c (X d 100)).
Definition terror_a a := Mul (X ERROR (-48)) (X a 203).
Definition terror ea s := Mul (X ea 160) (X s 605).
Definition tdelta a x1 x2 x3 := let x x := X x 450 in
  Sub (Mul (X a 203) tr) (tdot3 (x x1) (x x2) (x x3) (x x1) (x x2) (x x3)).
(* The same with sums from the other end: one ray where products are fused, and eight rays. Eight of one origin have
   d x w for w x d as well. *)
Definition tlane_w := tlane w1 w2 w3 w1 w2 w3.
Definition tlane_squares := Add tlane_w tr.
Definition tlane_c := Sub tlane_w tr.
Definition tlane_b := let x d := X d 100 in tlane w1 w2 w3 (x d1) (x d2) (x d3).
Definition tpencil_b := let x d := X d 100 in tlane (x d1) (x d2) (x d3) w1 w2 w3.
Definition tpencil_x a b c d := Sub (Mul (X a 100) b) (Mul (X c 100) d).
Definition tlane_delta a x1 x2 x3 := let x x := X x 450 in
  Sub (Mul (X a 203) tr) (tlane (x x1) (x x2) (x x3) (x x1) (x x2) (x x3)).
End Terms.
(* the bound of the side of a point *)
Definition tside s := Add (Mul (X SIDE_ERROR (-50)) s) (X UNDERFLOW (-1000)).
Ltac terms := unfold tdelta, terror, terror_a, tx, tb, ta, tc, tsquares, tr, tw, tdot3, w1, w2, w3 in *.
Ltac lane_terms := unfold tlane_delta, tpencil_x, tpencil_b, tlane_b, tlane_c, tlane_squares, tlane_w, tlane in *;
  terms.
Ltac order t := exists t; split; [assumption|]; lane_terms; split; [cbn [bounded]; repeat split; assumption|];
  split; [cbn [exact]; ring|]; split; [cbn [size]; rewrite ?Rabs_Ropp; ring|];
  split; [vm_compute; reflexivity | vm_compute; discriminate].

Lemma A_pos : 0 <= A. Proof. unfold A. pose proof (sq_pos d1). pose proof (sq_pos d2). pose proof (sq_pos d3). lra. Qed.
Lemma WW_pos : 0 <= WW. Proof. unfold WW. pose proof (sq_pos W1). pose proof (sq_pos W2). pose proof (sq_pos W3).
lra. Qed.

(* What underflows in the side of a point and its bound is below a part of 10^12 of UNDERFLOW. *)
Theorem UNDERFLOW_holds : bp (low (tc 1025)) <= / 1000000000000 * UNDERFLOW /\
  bp (low (tside (tsquares 1025))) <= / 1000000000000 * UNDERFLOW.
Proof. split; apply bp_part12; vm_compute; discriminate. Qed.

(* w.w + r^2 and w.w - r^2 in either order, of any doubles and in the filter's range. *)
Definition squares_of q := in_some_order 6 (-1062) (tsquares q).
Definition c_of q := in_some_order 6 (-1062) (tc q).
Theorem squares_in_order : forall q z, (q = 301 \/ q = 1025)%Z ->
  Rabs W1 <= bp q -> Rabs W2 <= bp q -> Rabs W3 <= bp q -> Rabs r <= bp q ->
  (plain (tsquares q) z \/ plain (tlane_squares q) z -> squares_of q z) /\
  (plain (tc q) z \/ plain (tlane_c q) z -> c_of q z).
Proof.
  intros q z Q0 H1 H2 H3 H4. unfold squares_of, c_of. destruct Q0; subst q; split; intros [H|H].
  - order (tsquares 301).
  - order (tlane_squares 301).
  - order (tc 301).
  - order (tlane_c 301).
  - order (tsquares 1025).
  - order (tlane_squares 1025).
  - order (tc 1025).
  - order (tlane_c 1025).
Qed.

(* The range: where the computed squares are below LARGEST, no component exceeds 2^301. *)
Theorem LARGEST_holds : forall s,
  Rabs W1 <= bp 1025 -> Rabs W2 <= bp 1025 -> Rabs W3 <= bp 1025 -> Rabs r <= bp 1025 ->
  squares_of 1025 s -> s < LARGEST ->
  Rabs W1 <= bp 301 /\ Rabs W2 <= bp 301 /\ Rabs W3 <= bp 301 /\ Rabs r <= bp 301.
Proof.
  intros s H1 H2 H3 H4 Hs L. unfold squares_of in Hs. terms. error_in Hs E. rewrite !abs_sq in E. fold W1 W2 W3 in E.
  small 0%Z. replace (bp 0) with 1 in * by reflexivity.
  assert (LARGEST = bp 300 * bp 300) by (rewrite bp_sq; reflexivity).
  assert (T : bp 301 = 2 * bp 300) by (replace 301%Z with (1 + 300)%Z by reflexivity; rewrite bp_add; simpl (bp 1);
    lra).
  assert (1 <= bp 300) by (replace 1 with (bp 0) by reflexivity; apply bp_le; lia).
  pose proof (sq_pos W1). pose proof (sq_pos W2). pose proof (sq_pos W3). pose proof (sq_pos r).
  apply Rabs_le_inv in E. rewrite u_val in E. set (p := bp 300) in *. clearbody p. rewrite T.
  repeat split; apply abs_below; nra.
Qed.

(* The side of a point: |p - c|^2 - r^2 is off by at most 7 u (w.w + r^2) + 2^-1000 as computed, for any doubles. *)
Theorem SIDE_ERROR_holds : forall c e,
  Rabs W1 <= bp 1025 -> Rabs W2 <= bp 1025 -> Rabs W3 <= bp 1025 -> Rabs r <= bp 1025 ->
  plain (tc 1025) c -> plain (tside (tsquares 1025)) e ->
  Rabs (c - C) <= e /\ (c > e -> 0 < C) /\ (c < - e -> C < 0).
Proof.
  intros c e H1 H2 H3 H4 Hc He. unfold tside in He. terms.
  assert (FS : Rabs SIDE_ERROR <= bp (-50)) by (unfold SIDE_ERROR; rewrite u_val, Rabs_pos_eq; simpl; lra).
  assert (FU : Rabs UNDERFLOW <= bp (-1000)) by (unfold UNDERFLOW; rewrite Rabs_pos_eq; [lra | apply Rlt_le, bp_pos]).
  error_of Hc P. error_of He P2. rewrite (Rabs_pos_eq SIDE_ERROR) in P2 by (unfold SIDE_ERROR; rewrite u_val; lra).
  rewrite (Rabs_pos_eq UNDERFLOW) in P2 by (apply Rlt_le, bp_pos). rewrite !abs_sq in *. fold W1 W2 W3 in P, P2.
  fold WW in P, P2. fold C in P. fold Q in P, P2.
  assert (0 <= Q) by (unfold Q; pose proof WW_pos; pose proof (sq_pos r); lra).
  assert (G : Rabs (c - C) <= e); [|split; [exact G | now apply certain_sign]].
  unfold SIDE_ERROR, UNDERFLOW in P2. clearbody C Q.
  small12 (-1000)%Z. apply Rabs_le_inv in P2. rewrite u_val in *. lra.
Qed.

Hypotheses (HW1 : Rabs W1 <= bp 301) (HW2 : Rabs W2 <= bp 301) (HW3 : Rabs W3 <= bp 301) (Hr : Rabs r <= bp 301)
  (Hd1 : Rabs d1 <= bp 100) (Hd2 : Rabs d2 <= bp 100) (Hd3 : Rabs d3 <= bp 100) (Hlong : bp (-200) <= A).

(* w.w + r^2 above SMALLEST as computed: what underflows is below 2^-100 of the bound. *)
Theorem SMALLEST_holds : forall s, squares_of 301 s -> SMALLEST < s -> bp (-251) <= Q.
Proof.
  intros s Hs L. unfold squares_of in Hs. terms. error_in Hs E. rewrite !abs_sq in E. fold W1 W2 W3 in E.
  fold WW in E. fold Q in E.
  assert (0 <= Q) by (unfold Q; pose proof WW_pos; pose proof (sq_pos r); lra).
  small (-250)%Z. assert (E1 : SMALLEST = 2 * bp (-251)).
  { unfold SMALLEST. replace (-250)%Z with (1 + -251)%Z by reflexivity. rewrite bp_add. simpl (bp 1). lra. }
  assert (E2 : bp (-250) = 2 * bp (-251)) by exact E1. rewrite E2 in *. pose proof (bp_pos (-251)).
  apply Rabs_le_inv in E. rewrite u_val in E. lra.
Qed.

Lemma squares_top : forall s, squares_of 301 s -> bp (-251) <= Q -> Rabs (s - Q) <= (7 * u) * Q /\ Rabs s <= bp 605.
Proof.
  intros s Hs LQ. unfold squares_of in Hs. terms. error_in Hs P. rewrite !abs_sq in P. fold W1 W2 W3 in P. fold WW in P.
  fold Q in P.
  small (-251)%Z. split; [rewrite u_val in *; lra|].
  assert (T : forall x, Rabs x <= bp 301 -> x * x <= bp 602).
  { intros x H1. rewrite <- abs_sq. change 602%Z with (301 + 301)%Z. rewrite <- bp_sq.
  apply Rmult_le_compat; auto using Rabs_pos. }
  pose proof (T _ HW1). pose proof (T _ HW2). pose proof (T _ HW3). pose proof (T _ Hr).
  assert (Q <= 4 * bp 602) by (unfold Q, WW; lra).
  assert (bp (-251) <= bp 602) by (apply bp_le; lia). pose proof (bp_pos (-251)).
  assert (F4 : bp 605 = 8 * bp 602) by (change 605%Z with (3 + 602)%Z; rewrite bp_add; simpl (bp 3); lra).
  apply Rabs_le_inv in P. apply Rabs_le. rewrite u_val in *. lra.
Qed.

(* d.d as computed: three roundings, whatever underflows. *)
Lemma square_error : forall a, plain ta a -> Rabs (a - A) <= (3 + / 500) * u * A.
Proof.
  intros a Ha. terms. error_of Ha E. rewrite !abs_sq in E. fold A in E. small (-200)%Z. rewrite u_val in *. lra.
Qed.
Lemma square_top : forall a, plain ta a -> 0 < a /\ Rabs a <= bp 203.
Proof.
  intros a Ha. pose proof (square_error a Ha) as E. apply Rabs_le_inv in E. pose proof (bp_pos (-200)).
  rewrite u_val in E. assert (0 < a) by lra. split; [assumption|]. rewrite Rabs_pos_eq by lra.
  assert (S : forall x, Rabs x <= bp 100 -> x * x <= bp 200).
  { intros x H1. rewrite <- abs_sq. change 200%Z with (100 + 100)%Z. rewrite <- bp_sq.
    apply Rmult_le_compat; auto using Rabs_pos. }
  pose proof (S _ Hd1). pose proof (S _ Hd2). pose proof (S _ Hd3). 
  replace 203%Z with (3 + 200)%Z by reflexivity. rewrite bp_add. simpl (bp 3). unfold A in *. lra.
Qed.

(* w x d as computed: eight rays of one origin have the components of d x w, which are its negatives. *)
Definition cross_of x1 x2 x3 := in_some_order 3 (-1068) (tx (w2 301) d3 (w3 301) d2) x1 /\
  in_some_order 3 (-1068) (tx (w3 301) d1 (w1 301) d3) x2 /\ in_some_order 3 (-1068) (tx (w1 301) d2 (w2 301) d1) x3.
Theorem crosses_in_order : forall x1 x2 x3,
  (plain (tx (w2 301) d3 (w3 301) d2) x1 /\ plain (tx (w3 301) d1 (w1 301) d3) x2 /\
    plain (tx (w1 301) d2 (w2 301) d1) x3 -> cross_of x1 x2 x3) /\
  (plain (tpencil_x d2 (w3 301) d3 (w2 301)) x1 /\ plain (tpencil_x d3 (w1 301) d1 (w3 301)) x2 /\
    plain (tpencil_x d1 (w2 301) d2 (w1 301)) x3 -> cross_of (- x1) (- x2) (- x3)).
Proof.
  intros x1 x2 x3. unfold cross_of. split; intros (H1 & H2 & H3).
  - repeat split; [order (tx (w2 301) d3 (w3 301) d2) | order (tx (w3 301) d1 (w1 301) d3) |
      order (tx (w1 301) d2 (w2 301) d1)].
  - unfold tpencil_x in *. apply plain_negated in H1. apply plain_negated in H2. apply plain_negated in H3.
    repeat split.
    + order (Sub (Mul (X d3 100) (w2 301)) (Mul (X d2 100) (w3 301))).
    + order (Sub (Mul (X d1 100) (w3 301)) (Mul (X d3 100) (w1 301))).
    + order (Sub (Mul (X d2 100) (w1 301)) (Mul (X d1 100) (w2 301))).
Qed.

Lemma cross_part : forall x1 x2 x3, cross_of x1 x2 x3 ->
  Rabs (x1 * x1 + x2 * x2 + x3 * x3 - (X1 * X1 + X2 * X2 + X3 * X3)) <= 85 / 10 * u * (A * WW) + bp (-600)
  /\ Rabs x1 <= bp 450 /\ Rabs x2 <= bp 450 /\ Rabs x3 <= bp 450.
Proof.
  intros x1 x2 x3 (H1 & H2 & H3). terms.
  error_in H1 P1. error_in H2 P2. error_in H3 P3. fold W1 W2 W3 in P1, P2, P3.
  fold X1 in P1. fold X2 in P2. fold X3 in P3.
  set (m1 := Rabs W2 * Rabs d3 + Rabs W3 * Rabs d2) in *. set (m2 := Rabs W3 * Rabs d1 + Rabs W1 * Rabs d3) in *.
  set (m3 := Rabs W1 * Rabs d2 + Rabs W2 * Rabs d1) in *.
  assert (M : forall a b c d, Rabs a <= bp 301 -> Rabs b <= bp 100 -> Rabs c <= bp 301 -> Rabs d <= bp 100 ->
    Rabs (a * b - c * d) <= Rabs a * Rabs b + Rabs c * Rabs d <= bp 402).
  { intros. split.
    - unfold Rminus. eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp, !Rabs_mult. lra.
    - replace 402%Z with (1 + (301 + 100))%Z by reflexivity. rewrite bp_add, bp_add. simpl (bp 1).
      assert (Rabs a * Rabs b <= bp 301 * bp 100) by (apply Rmult_le_compat; auto using Rabs_pos).
      assert (Rabs c * Rabs d <= bp 301 * bp 100) by (apply Rmult_le_compat; auto using Rabs_pos). lra. }
  assert (M1 : Rabs X1 <= m1 <= bp 402) by (apply M; assumption).
  assert (M2 : Rabs X2 <= m2 <= bp 402) by (apply M; assumption).
  assert (M3 : Rabs X3 <= m3 <= bp 402) by (apply M; assumption). clear M.
  assert (SM : m1 * m1 + m2 * m2 + m3 * m3 <= 2 * (A * WW)).
  { unfold m1, m2, m3, A, WW. pose proof (permanents (Rabs W1) (Rabs W2) (Rabs W3) (Rabs d1) (Rabs d2) (Rabs d3)) as P.
    rewrite !abs_sq in P. lra. }
  assert (SX : X1 * X1 + X2 * X2 + X3 * X3 <= A * WW).
  { unfold X1, X2, X3, A, WW. rewrite lagrange. pose proof (sq_pos (W1 * d1 + W2 * d2 + W3 * d3)). lra. }
  pose proof (Rmult_le_pos _ _ A_pos WW_pos) as AW.
  assert (CS : m1 * Rabs X1 + m2 * Rabs X2 + m3 * Rabs X3 <= 14143 / 10000 * (A * WW)).
  { apply below_root; [lra|].
    pose proof (cauchy_schwarz m1 m2 m3 (Rabs X1) (Rabs X2) (Rabs X3)) as P. rewrite !abs_sq in P.
    pose proof (sq_pos X1). pose proof (sq_pos X2). pose proof (sq_pos X3). pose proof (sq_pos m1).
    pose proof (sq_pos m2).
    pose proof (sq_pos m3). eapply Rle_trans; [exact P|].
    apply Rle_trans with ((2 * (A * WW)) * (A * WW)); [apply Rmult_le_compat; lra | nra]. }
  assert (K : 0 <= (3 + / 1000) * u <= 1) by (rewrite u_val; lra).
  assert (T : 0 <= bp (-1068) <= bp 402) by (split; [apply Rlt_le, bp_pos | apply bp_le; lia]).
  pose proof (squares _ _ _ _ _ _ _ _ _ _ _ (bp 402) K T P1 P2 P3 M1 M2 M3) as S.
  split.
  - eapply Rle_trans; [exact S|].
    assert (15 * (bp (-1068) * bp 402) <= bp (-600)).
    { rewrite <- bp_add. apply Rle_trans with (bp (4 + (-1068 + 402))); [|apply bp_le; lia]. rewrite (bp_add 4).
    simpl (bp 4).
      pose proof (bp_pos (-1068 + 402)). lra. }
    set (Y := m1 * Rabs X1 + m2 * Rabs X2 + m3 * Rabs X3) in *. set (N := m1 * m1 + m2 * m2 + m3 * m3) in *.
    set (G := A * WW) in *. clearbody Y N G. rewrite u_val in *. lra.
  - assert (V : forall x y m, Rabs (x - y) <= (3 + / 1000) * u * m + bp (-1068) -> Rabs y <= m <= bp 402 -> Rabs x <=
    bp 450).
    { intros x y m P [I J]. replace x with ((x - y) + y) by ring. eapply Rle_trans; [apply Rabs_triang|].
      apply Rle_trans with (bp (2 + 402)); [|apply bp_le; lia]. rewrite bp_add. simpl (bp 2). destruct T.
      assert ((3 + / 1000) * u * m <= 1 * m) by (apply Rmult_le_compat_r; [pose proof (Rabs_pos y); lra | lra]). lra. }
    repeat split; eapply V; eassumption.
Qed.

(* delta in either order. Its components may have the other sign. *)
Definition delta_of a x1 x2 x3 := in_some_order 4 (-861) (tdelta 301 a x1 x2 x3).
Theorem deltas_in_order : forall a x1 x2 x3 delta, plain ta a -> cross_of x1 x2 x3 ->
  plain (tdelta 301 a x1 x2 x3) delta \/ plain (tlane_delta 301 a x1 x2 x3) delta \/
  plain (tlane_delta 301 a (- x1) (- x2) (- x3)) delta -> delta_of a x1 x2 x3 delta.
Proof.
  intros a x1 x2 x3 delta Ha Hx Hd. destruct (square_top a Ha) as [_ AT].
  destruct (cross_part _ _ _ Hx) as (_ & T1 & T2 & T3). unfold delta_of.
  assert (N1 : Rabs (- x1) <= bp 450) by now rewrite Rabs_Ropp.
  assert (N2 : Rabs (- x2) <= bp 450) by now rewrite Rabs_Ropp.
  assert (N3 : Rabs (- x3) <= bp 450) by now rewrite Rabs_Ropp. destruct Hd as [H|[H|H]].
  - order (tdelta 301 a x1 x2 x3).
  - order (tlane_delta 301 a x1 x2 x3).
  - order (tlane_delta 301 a (- x1) (- x2) (- x3)).
Qed.

Theorem delta_error : forall a x1 x2 x3 delta,
  plain ta a -> cross_of x1 x2 x3 -> delta_of a x1 x2 x3 delta -> bp (-251) <= Q ->
  Rabs (delta - Delta) <= 126 / 10 * u * (A * WW) + 71 / 10 * u * (A * (r * r)).
Proof.
  intros a x1 x2 x3 delta Ha Hx Hd L. destruct (cross_part _ _ _ Hx) as (P & T1 & T2 & T3). clear Hx.
  pose proof (square_error a Ha) as PA. destruct (square_top a Ha) as [AP AT].
  unfold delta_of in Hd. terms. error_in Hd E. rewrite !abs_sq in E. rewrite (Rabs_pos_eq a) in E by lra.
  assert (SX : 0 <= X1 * X1 + X2 * X2 + X3 * X3 <= A * WW).
  { pose proof (sq_pos X1). pose proof (sq_pos X2). pose proof (sq_pos X3). split; [lra|].
    unfold X1, X2, X3, A, WW. rewrite lagrange. pose proof (sq_pos (W1 * d1 + W2 * d2 + W3 * d3)). lra. }
  pose proof (Rmult_le_pos _ _ A_pos WW_pos) as AW. pose proof (sq_pos r) as R0.
  pose proof (Rmult_le_pos _ _ A_pos R0) as AR.
  assert (LQ : bp (-451) <= A * Q).
  { replace (-451)%Z with (-200 + -251)%Z by reflexivity. rewrite bp_add.
  apply Rmult_le_compat; auto; apply Rlt_le, bp_pos. }
  assert (AQ : A * Q = A * WW + A * (r * r)) by (unfold Q; ring). rewrite AQ in LQ.
  assert (ER : Rabs (a * (r * r) - A * (r * r)) <= (3 + / 500) * u * (A * (r * r))).
  { replace (a * (r * r) - A * (r * r)) with ((a - A) * (r * r)) by ring.
  rewrite Rabs_mult, (Rabs_pos_eq (r * r)) by lra.
    replace ((3 + / 500) * u * (A * (r * r))) with ((3 + / 500) * u * A * (r * r)) by ring.
    now apply Rmult_le_compat_r. }
  replace (delta - Delta) with ((delta - (a * (r * r) - (x1 * x1 + x2 * x2 + x3 * x3)))
    + (a * (r * r) - A * (r * r)) - (x1 * x1 + x2 * x2 + x3 * x3 - (X1 * X1 + X2 * X2 + X3 * X3))) by (unfold Delta;
      ring).
  eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
  set (Y := x1 * x1 + x2 * x2 + x3 * x3) in *. set (Z := X1 * X1 + X2 * X2 + X3 * X3) in *. set (G := A * WW) in *.
  set (H := A * (r * r)) in *. set (ar := a * (r * r)) in *. clearbody Y Z G H ar.
  small (-451)%Z. pose proof P as P'. pose proof ER as ER'. apply Rabs_le_inv in P'. apply Rabs_le_inv in ER'.
  rewrite u_val in *. lra.
Qed.

Lemma AQ_low : bp (-251) <= Q -> bp (-451) <= A * Q.
Proof.
  intro LQ. replace (-451)%Z with (-200 + -251)%Z by reflexivity. rewrite bp_add.
  apply Rmult_le_compat; auto; apply Rlt_le, bp_pos.
Qed.
(* The bound as computed. *)
Lemma error_low : forall a s ea e,
  plain ta a -> squares_of 301 s -> plain (terror_a a) ea -> plain (terror ea s) e -> SMALLEST < s ->
  (17 - / 1000) * u * (A * Q) <= e.
Proof.
  intros a s ea e Ha Hs Hea He L. pose proof (SMALLEST_holds s Hs L) as LQ.
  destruct (square_top a Ha) as [AP AT]. pose proof (square_error a Ha) as PA.
  destruct (squares_top s Hs LQ) as [ST TT]. assert (0 < Q) by (pose proof (bp_pos (-251)); lra).
  assert (FE : Rabs ERROR <= bp (-48)) by (unfold ERROR; rewrite u_val, Rabs_pos_eq; simpl; lra).
  unfold terror_a in Hea. error_of Hea PE.
  rewrite (Rabs_pos_eq a), (Rabs_pos_eq ERROR) in PE by (unfold ERROR; rewrite ?u_val; lra). unfold ERROR in PE.
  apply Rabs_le_inv in PA. assert (LU : bp (-260) <= 17 * u * a).
  { apply Rle_trans with (u * bp (-200)); [unfold u; rewrite <- bp_add; apply bp_le; lia|]. rewrite u_val in *.
    pose proof (bp_pos (-200)). lra. }
  small (-260)%Z. assert (EA : (1 - 2 * u) * (17 * u * a) <= ea <= 2 * (17 * u * a)).
  { apply Rabs_le_inv in PE. rewrite u_val in *. lra. }
  assert (TE : Rabs ea <= bp 160).
  { apply Rabs_le_inv in AT. rewrite Rabs_pos_eq by (rewrite u_val in *; lra).
    assert (F : u * bp 203 = bp 150) by (unfold u; rewrite <- bp_add; reflexivity).
    assert (F2 : 1024 * bp 150 = bp 160) by (change 160%Z with (10 + 150)%Z; rewrite (bp_add 10); simpl (bp 10); lra).
    pose proof u_pos. assert (u * a <= u * bp 203) by (apply Rmult_le_compat_l; lra). lra. }
  unfold terror in He. error_of He P. assert (0 < ea) by (rewrite u_val in *; lra).
  apply Rabs_le_inv in ST. assert (0 < s) by (rewrite u_val in ST; lra).
  rewrite (Rabs_pos_eq s), (Rabs_pos_eq ea) in P by lra.
  pose proof (AQ_low LQ) as LQ'.
  pose proof A_pos as A0. assert (AS : 17 * u * (1 - 13 * u) * (A * Q) <= ea * s).
  { apply Rle_trans with ((17 * u * (1 - 6 * u) * A) * ((1 - 7 * u) * Q)).
    - replace (17 * u * (1 - 6 * u) * A * ((1 - 7 * u) * Q)) with (17 * u * (1 - 6 * u) * (1 - 7 * u) * (A * Q)) by
        ring.
      apply Rmult_le_compat_r; [|rewrite u_val; lra]. pose proof (bp_pos (-451)). lra.
    - apply Rmult_le_compat.
      + apply Rmult_le_pos; [rewrite u_val; lra | assumption].
      + apply Rmult_le_pos; [rewrite u_val; lra | lra].
      + clear - EA PA A0. clearbody A. rewrite u_val in *. lra.
      + clear - ST. clearbody Q. rewrite u_val in *. lra. }
  set (G := A * Q) in *. set (es := ea * s) in *. clearbody G es.
  assert (LX : bp (-504) <= u * bp (-451)) by (unfold u; rewrite <- bp_add; apply bp_le; lia).
  small (-504)%Z. apply Rabs_le_inv in P. rewrite u_val in *. lra.
Qed.

(* The sign of delta is that of Delta where it exceeds 17 u d.d (w.w + r^2) as computed. *)
Theorem ERROR_holds : forall a x1 x2 x3 delta s ea e,
  plain ta a -> cross_of x1 x2 x3 -> delta_of a x1 x2 x3 delta ->
  squares_of 301 s -> plain (terror_a a) ea -> plain (terror ea s) e -> SMALLEST < s ->
  Rabs (delta - Delta) <= e /\ (delta > e -> 0 < Delta) /\ (delta < - e -> Delta < 0).
Proof.
  intros a x1 x2 x3 delta s ea e Ha Hx Hd Hs Hea He L. pose proof (SMALLEST_holds s Hs L) as LQ.
  pose proof (delta_error _ _ _ _ _ Ha Hx Hd LQ) as E. pose proof (error_low a s ea e Ha Hs Hea He L) as P.
  assert (G : Rabs (delta - Delta) <= e); [|split; [exact G | now apply certain_sign]].
  assert (AQ : A * Q = A * WW + A * (r * r)) by (unfold Q; ring). rewrite AQ in P.
  pose proof (Rmult_le_pos _ _ A_pos WW_pos) as AW. pose proof (Rmult_le_pos _ _ A_pos (sq_pos r)) as AR.
  eapply Rle_trans; [exact E|]. eapply Rle_trans; [|exact P].
  set (G := A * WW) in *. set (H := A * (r * r)) in *. clearbody G H. rewrite u_val. lra.
Qed.

(* Signs instead of roots: where Delta > 0 is certain and |c| > 14 u (w.w + r^2) as computed, the signs of C and of B
   are those of c and b. *)
Definition b_of := in_some_order 4 (-1065) (tb 301).
Theorem bs_in_order : forall b, plain (tb 301) b \/ plain (tlane_b 301) b \/ plain (tpencil_b 301) b -> b_of b.
Proof.
  intros b H. unfold b_of. destruct H as [H|[H|H]]; [order (tb 301) | order (tlane_b 301) | order (tpencil_b 301)].
Qed.
Definition tfirst s := Mul (X FIRST_AHEAD (-49)) (X s 605).
Theorem FIRST_AHEAD_holds : forall b c e s,
  b_of b -> c_of 301 c -> plain (tfirst s) e -> squares_of 301 s -> SMALLEST < s ->
  0 < Delta -> e < Rabs c ->
  (c < 0 -> C < 0) /\ (0 < c -> 0 < C /\ (b < 0 -> B < 0) /\ (0 <= b -> 0 < B)).
Proof.
  intros b c e s Hb Hc He Hs L HD Lc. pose proof (SMALLEST_holds s Hs L) as LQ. rewrite discriminant in HD.
  destruct (squares_top s Hs LQ) as [ST TT]. clear Hs. unfold tfirst, b_of, c_of in *. terms.
  assert (FS : Rabs FIRST_AHEAD <= bp (-49)) by (unfold FIRST_AHEAD; constant).
  error_in Hb PB. error_in Hc PC. error_of He PE. fold W1 W2 W3 in PB, PC. fold B in PB.
  rewrite (Rabs_pos_eq FIRST_AHEAD) in PE by (unfold FIRST_AHEAD; rewrite u_val; lra).
  rewrite !abs_sq in PC. fold WW in PC. fold C in PC. fold Q in PC. unfold FIRST_AHEAD in PE.
  assert (S0 : 0 <= s) by (apply Rabs_le_inv in ST; pose proof (bp_pos (-251)); rewrite u_val in ST; lra).
  rewrite (Rabs_pos_eq s) in PE by assumption. apply Rabs_le_inv in ST.
  set (P := Rabs W1 * Rabs d1 + Rabs W2 * Rabs d2 + Rabs W3 * Rabs d3) in *.
  assert (PP : P * P <= A * WW).
  { unfold P, A, WW. pose proof (cauchy_schwarz (Rabs W1) (Rabs W2) (Rabs W3) (Rabs d1) (Rabs d2) (Rabs d3)) as CS.
    rewrite !abs_sq in CS. lra. }
  assert (P0 : 0 <= P) by (unfold P; repeat apply Rplus_le_le_0_compat; apply Rmult_le_pos; apply Rabs_pos).
  assert (AW : A * WW <= A * Q) by (apply Rmult_le_compat_l; [apply A_pos | unfold Q; pose proof (sq_pos r); lra]).
  pose proof (AQ_low LQ) as LQ'.
  pose proof A_pos. pose proof WW_pos. 
  assert (T : bp (-1065) * bp (-1065) <= u * u * (A * Q)).
  { rewrite bp_sq. apply Rle_trans with (u * u * bp (-451)); [unfold u; rewrite <- !bp_add; apply bp_le; lia|].
    apply Rmult_le_compat_l; [rewrite u_val; lra | assumption]. }
  assert (BB : (b - B) * (b - B) <= 40 * (u * u) * (A * Q)).
  { rewrite <- abs_sq. apply Rle_trans with (((4 + / 1000) * u * P + bp (-1065)) * ((4 + / 1000) * u * P + bp (-1065))).
    - apply Rmult_le_compat; auto using Rabs_pos.
    - set (x := (4 + / 1000) * u * P). pose proof (sq_pos (x - bp (-1065))).
      assert (x * x <= 17 * (u * u) * (A * Q)).
      { unfold x. replace ((4 + / 1000) * u * P * ((4 + / 1000) * u * P)) with ((4 + / 1000) * (4 + / 1000) * (u * u)
        * (P * P)) by ring.
        assert (PQ : P * P <= A * Q) by lra. pose proof (bp_pos (-451)). clearbody A P Q. rewrite u_val. lra. }
      clearbody x A Q. set (t := bp (-1065)) in *. clearbody t. pose proof (sq_pos t).
      replace ((x + t) * (x + t)) with (2 * (x * x) + 2 * (t * t) - (x - t) * (x - t)) by ring. lra. }
  clear PB T. clearbody P. small (-251)%Z. apply Rabs_le_inv in PC. apply Rabs_le_inv in PE.
  split; [intro; rewrite Rabs_left in Lc by assumption; clearbody C Q; rewrite u_val in *; lra|].
  intro C0. rewrite Rabs_pos_eq in Lc by lra.
  assert (CC : 7 * u * Q < C) by (clearbody C Q; rewrite u_val in *; lra).
  assert (CA : 7 * u * (A * Q) <= A * C).
  { replace (7 * u * (A * Q)) with (A * (7 * u * Q)) by ring. apply Rmult_le_compat_l; lra. }
  assert (QQ : 0 < A * Q) by (pose proof (bp_pos (-451)); lra).
  assert (S : (b - B) * (b - B) < B * B).
  { set (G := A * Q) in *. set (H9 := A * C) in *. clearbody G H9 B. rewrite u_val in *. lra. }
  assert (0 < u * Q) by (apply Rmult_lt_0_compat; [apply u_pos | pose proof (bp_pos (-251)); lra]).
  assert (0 < C) by lra. split; [assumption|]. clear - S. clearbody B. split; intro; nra.
Qed.

(* ---- Candidates: where Delta > 0 is certain, each root lies between its bounds, in each of these orders ---- *)
Lemma b_near : forall b, b_of b -> Rabs (b - B) <= (4 + / 1000) * u * (sqrt A * sqrt WW) + bp (-1065) /\
  Rabs B <= sqrt A * sqrt WW.
Proof.
  intros b Hb. unfold b_of in Hb. terms. error_in Hb P. fold W1 W2 W3 in P. fold B in P.
  pose proof A_pos as A0. pose proof WW_pos as W0.
  assert (SS : sqrt A * sqrt WW * (sqrt A * sqrt WW) = A * WW).
  { rewrite <- (sqrt_sqrt A A0) at 3. rewrite <- (sqrt_sqrt WW W0) at 3. ring. }
  assert (S0 : 0 <= sqrt A * sqrt WW) by (apply Rmult_le_pos; apply sqrt_pos). split.
  - eapply Rle_trans; [exact P|]. apply Rplus_le_compat_r. apply Rmult_le_compat_l; [pose proof u_pos; lra|].
    apply below_root; [exact S0|]. rewrite SS.
    pose proof (cauchy_schwarz (Rabs W1) (Rabs W2) (Rabs W3) (Rabs d1) (Rabs d2) (Rabs d3)) as CS.
    rewrite !abs_sq in CS. unfold A, WW. lra.
  - apply abs_below; [exact S0|]. rewrite SS. unfold B, A, WW.
    pose proof (cauchy_schwarz W1 W2 W3 d1 d2 d3). lra.
Qed.
(* delta is hardly above A r^2. *)
Lemma delta_top : forall a x1 x2 x3 delta, plain ta a -> cross_of x1 x2 x3 -> delta_of a x1 x2 x3 delta ->
  bp (-251) <= Q -> 16 * u * (A * Q) <= delta -> delta <= (1 + 8 * u) * (A * (r * r)).
Proof.
  intros a x1 x2 x3 delta Ha Hx Hd LQ Hsure. destruct (cross_part _ _ _ Hx) as (_ & T1 & T2 & T3). clear Hx.
  pose proof (square_error a Ha) as PA. destruct (square_top a Ha) as [AP AT]. pose proof (AQ_low LQ) as LA.
  unfold delta_of in Hd. terms. error_in Hd E. rewrite !abs_sq in E. rewrite (Rabs_pos_eq a) in E by lra.
  assert (LX : bp (-504) <= u * bp (-451)) by (unfold u; rewrite <- bp_add; apply bp_le; lia).
  small (-504)%Z. pose proof (sq_pos x1) as S1. pose proof (sq_pos x2) as S2. pose proof (sq_pos x3) as S3.
  pose proof (sq_pos r) as R0.
  assert (ER : a * (r * r) <= (1 + (3 + / 2) * u) * (A * (r * r))).
  { replace ((1 + (3 + / 2) * u) * (A * (r * r))) with ((1 + (3 + / 2) * u) * A * (r * r)) by ring.
    apply Rmult_le_compat_r; [exact R0|]. apply Rabs_le_inv in PA. pose proof A_pos as A0.
    clearbody A. rewrite u_val in *. lra. }
  apply Rabs_le_inv in E. pose proof (Rmult_le_pos _ _ A_pos R0) as AR.
  set (ar := a * (r * r)) in *. set (G := A * (r * r)) in *. set (K := A * Q) in *. clearbody ar G K.
  clear - E ER LA LX S1 S2 S3 Hsure AR H0 H. rewrite u_val in *. lra.
Qed.
(* Rounded once, a number in the ordinary range. *)
Lemma rounded_low : forall x, bp (-1022) <= x -> (1 - u) * x <= RN x <= (1 + u) * x.
Proof.
  intros x H. pose proof (bp_pos (-1022)). pose proof (RN_normal x) as E. rewrite Rabs_pos_eq in E by lra.
  specialize (E H). apply Rabs_le_inv in E. lra.
Qed.
Theorem roots_are_bounded : forall a x1 x2 x3 delta s ea e b sign,
  plain ta a -> cross_of x1 x2 x3 -> delta_of a x1 x2 x3 delta -> squares_of 301 s -> F b -> b_of b ->
  plain (terror_a a) ea -> plain (terror ea s) e -> SMALLEST < s -> e < delta -> sign = 1 \/ sign = - 1 ->
  let root := RN (sqrt delta) in let inverse_a := RN (/ a) in let inverse := RN (/ delta) in
  let t := RN (RN (- b + sign * root) * inverse_a) in
  let error := RN (RN (RN (RN (RN CANDIDATE * e) * inverse_a) * inverse) * root) in
  RN (t - error) <= (- B + sign * sqrt Delta) / A <= RN (t + error).
Proof.
  intros a x1 x2 x3 delta s ea e b sign Ha Hx Hd Hs Fb Hb Hea He L Hsure Hsign root inverse_a inverse t error.
  pose proof (SMALLEST_holds s Hs L) as LQ. pose proof (AQ_low LQ) as LA. pose proof u_pos as U0.
  pose proof (error_low a s ea e Ha Hs Hea He L) as EL. pose proof (delta_error _ _ _ _ _ Ha Hx Hd LQ) as DE.
  destruct (square_top a Ha) as [AP AT]. pose proof (square_error a Ha) as PA. destruct (b_near b Hb) as [BN BB].
  rewrite (Rabs_pos_eq a) in AT by lra.
  assert (K0 : 0 < A * Q) by (pose proof (bp_pos (-451)); lra).
  assert (DS : 16 * u * (A * Q) <= delta) by (clear - EL Hsure K0; rewrite u_val in *; lra).
  pose proof (delta_top _ _ _ _ _ Ha Hx Hd LQ DS) as DT. clear Ha Hx Hd Hs Hb Hea He.
  pose proof A_pos as A0. pose proof WW_pos as WW0. pose proof (bp_pos (-200)) as B200. pose proof (sq_pos r) as R0.
  assert (Ap : 0 < A) by lra. assert (Q0 : 0 < Q) by (pose proof (bp_pos (-251)); lra).
  assert (AQ : A * Q = A * WW + A * (r * r)) by (unfold Q; ring).
  assert (AW : 0 <= A * WW) by (apply Rmult_le_pos; assumption).
  assert (AR : 0 <= A * (r * r)) by (apply Rmult_le_pos; assumption).
  assert (uK : 0 < u * (A * Q)) by (apply Rmult_lt_0_compat; assumption).
  assert (D0 : 0 < delta) by lra. assert (r0 : 0 < Rabs r).
  { apply Rabs_pos_lt. intro Z. rewrite Z in DT. rewrite Rmult_0_l, Rmult_0_r, Rmult_0_r in DT. lra. }
  (* the sizes of everything *)
  set (y := sqrt delta). assert (YY : y * y = delta) by (apply sqrt_sqrt; lra).
  assert (y0 : 0 < y) by (apply sqrt_lt_R0; assumption).
  assert (Dlow : bp (-504) <= delta).
  { apply Rle_trans with (2 := DS). apply Rle_trans with (u * bp (-451)); [unfold u; rewrite <- bp_add; apply bp_le;
      lia|]. rewrite Rmult_assoc. assert (u * bp (-451) <= u * (A * Q)) by (apply Rmult_le_compat_l; lra). lra. }
  assert (Ylow : bp (-252) <= y).
  { apply below_root; [lra|]. rewrite YY, bp_sq. exact Dlow. }
  assert (Atop : A <= bp 202).
  { assert (S : forall x, Rabs x <= bp 100 -> x * x <= bp 200).
    { intros x H1. rewrite <- abs_sq. change 200%Z with (100 + 100)%Z. rewrite <- bp_sq.
      apply Rmult_le_compat; auto using Rabs_pos. }
    pose proof (S _ Hd1). pose proof (S _ Hd2). pose proof (S _ Hd3). pose proof (bp_pos 200).
    change 202%Z with (2 + 200)%Z. rewrite bp_add. simpl (bp 2). unfold A. lra. }
  (* the reciprocals *)
  assert (Ia : (1 - u) * / a <= inverse_a <= (1 + u) * / a).
  { apply rounded_low. apply Rle_trans with (bp (-203)); [apply bp_le; lia|]. change (-203)%Z with (Z.opp 203).
    rewrite bpow_opp.
    apply Rinv_le_contravar; assumption. }
  assert (ia0 : 0 < / a) by now apply Rinv_0_lt_compat.
  assert (IA : Rabs (inverse_a * A - 1) <= (4 + / 100) * u).
  { assert (V : Rabs (/ a * A - 1) <= (3 + / 300) * u).
    { replace (/ a * A - 1) with (/ a * (A - a)) by (field; lra). rewrite Rabs_mult, (Rabs_pos_eq (/ a)) by lra.
      rewrite Rabs_minus_sym in PA. apply Rmult_le_reg_l with a; [assumption|].
      rewrite <- Rmult_assoc, Rinv_r, Rmult_1_l by lra. eapply Rle_trans; [exact PA|].
      rewrite Rabs_minus_sym in PA. apply Rabs_le_inv in PA. clear - PA Ap. clearbody A. rewrite u_val in *. lra. }
    assert (I1 : (1 - u) * / a * A <= inverse_a * A) by (apply Rmult_le_compat_r; lra).
    assert (I2 : inverse_a * A <= (1 + u) * / a * A) by (apply Rmult_le_compat_r; lra).
    rewrite Rmult_assoc in I1, I2. apply Rabs_le_inv in V. apply Rabs_le. set (m := / a * A) in *. clearbody m.
    clear - V I1 I2. rewrite u_val in *. lra. }
  assert (AQtop : delta <= bp 806).
  { assert (S : forall x, Rabs x <= bp 301 -> x * x <= bp 602).
    { intros x H1. rewrite <- abs_sq. change 602%Z with (301 + 301)%Z. rewrite <- bp_sq.
      apply Rmult_le_compat; auto using Rabs_pos. }
    pose proof (S _ Hr) as RT. assert (A * (r * r) <= bp 202 * bp 602) by (apply Rmult_le_compat; lra).
    change 806%Z with (2 + (202 + 602))%Z. rewrite (bp_add 2), bp_add. simpl (bp 2). rewrite u_val in DT. lra. }
  assert (id0 : 0 < / delta) by now apply Rinv_0_lt_compat.
  assert (Id : (1 - u) * / delta <= inverse <= (1 + u) * / delta).
  { apply rounded_low. apply Rle_trans with (bp (-806)); [apply bp_le; lia|]. change (-806)%Z with (Z.opp 806).
    rewrite bpow_opp.
    apply Rinv_le_contravar; assumption. }
  assert (Ro : (1 - u) * y <= root <= (1 + u) * y).
  { apply rounded_low. apply Rle_trans with (2 := Ylow). apply bp_le; lia. }
  assert (Ca : (1 - u) * (16 / 10) <= RN CANDIDATE).
  { change (16 / 10) with CANDIDATE. apply rounded_low. unfold CANDIDATE.
    apply Rle_trans with (bp 0); [apply bp_le; lia | simpl; lra]. }
  (* the error as computed *)
  assert (Bu : 0 < 1 - u) by (rewrite u_val; lra).
  assert (e0 : 0 < e) by (clear - EL uK; lra).
  set (m1 := RN (RN CANDIDATE * e)) in *. set (m2 := RN (m1 * inverse_a)) in *. set (m3 := RN (m2 * inverse)) in *.
  assert (E1 : 15 / 10 * e <= RN CANDIDATE * e) by (apply Rmult_le_compat_r; [lra | rewrite u_val in Ca; lra]).
  assert (el : bp (-504) <= e).
  { apply Rle_trans with (u * bp (-451)); [unfold u; rewrite <- bp_add; apply bp_le; lia|].
    assert (u * bp (-451) <= u * (A * Q)) by (apply Rmult_le_compat_l; lra). clear - EL H uK. rewrite u_val in *. lra. }
  assert (M1 : (1 - u) * (RN CANDIDATE * e) <= m1).
  { apply rounded_low. apply Rle_trans with e; [apply Rle_trans with (2 := el); apply bp_le; lia | lra]. }
  assert (M1' : e <= m1) by (clear - M1 E1 e0 U0; rewrite u_val in *; lra).
  assert (il : bp (-204) <= inverse_a).
  { apply Rle_trans with (bp (-1) * bp (-203)); [rewrite <- bp_add; apply bp_le; lia|].
    change (-203)%Z with (Z.opp 203). rewrite (bpow_opp radix2 203).
    assert (/ bp 203 <= / a) by (apply Rinv_le_contravar; assumption). pose proof (bp_pos 203).
    assert (0 < / bp 203) by now apply Rinv_0_lt_compat. destruct Ia as [Ia _]. apply Rle_trans with (2 := Ia).
    apply Rmult_le_compat; try lra; [simpl; lra | rewrite u_val; simpl; lra]. }
  pose proof (bp_pos (-204)) as B204. pose proof (bp_pos (-504)) as B504.
  assert (M2 : (1 - u) * (m1 * inverse_a) <= m2).
  { apply rounded_low. apply Rle_trans with (bp (-504) * bp (-204)); [rewrite <- bp_add; apply bp_le; lia|].
    apply Rmult_le_compat; lra. }
  assert (ei : 0 < e * inverse_a) by (apply Rmult_lt_0_compat; lra).
  assert (M2' : / 2 * (e * inverse_a) <= m2).
  { apply Rle_trans with (2 := M2). apply Rmult_le_compat; try lra; [rewrite u_val; lra|].
    apply Rmult_le_compat_r; lra. }
  (* delta is at most a few units of A Q, so that what follows is no smaller than u times a reciprocal of A *)
  assert (ed : 8 * u <= e * inverse).
  { apply Rle_trans with (e * (/ 2 * / delta)).
    - apply Rmult_le_reg_r with delta; [assumption|]. replace (e * (/ 2 * / delta) * delta) with (/ 2 * e) by (field;
        lra). clear - EL DT AQ AW AR uK U0. rewrite AQ in *. set (G := A * WW) in *. set (H := A * (r * r)) in *.
      clearbody G H. rewrite u_val in *. lra.
    - apply Rmult_le_compat_l; [lra|]. destruct Id as [Id _]. apply Rle_trans with (2 := Id).
      apply Rmult_le_compat_r; [lra | rewrite u_val; lra]. }
  assert (iv0 : 0 < inverse) by (apply Rlt_le_trans with ((1 - u) * / delta); [now apply Rmult_lt_0_compat | apply Id]).
  assert (m2i : 4 * u * inverse_a <= m2 * inverse).
  { apply Rle_trans with (/ 2 * (e * inverse_a) * inverse); [|apply Rmult_le_compat_r; lra].
    replace (/ 2 * (e * inverse_a) * inverse) with (/ 2 * (e * inverse) * inverse_a) by ring.
    apply Rmult_le_compat_r; lra. }
  assert (u204 : bp (-257) <= u * inverse_a).
  { apply Rle_trans with (u * bp (-204)); [unfold u; rewrite <- bp_add; apply bp_le; lia|].
    apply Rmult_le_compat_l; lra. }
  pose proof (bp_pos (-257)) as B257.
  assert (M3 : (1 - u) * (m2 * inverse) <= m3).
  { apply rounded_low. apply Rle_trans with (bp (-257)); [apply bp_le; lia | lra]. }
  assert (M3' : bp (-257) <= m3) by (clear - M3 m2i u204 B257 U0; rewrite u_val in *; lra).
  pose proof (bp_pos (-252)) as B252.
  assert (rl : bp (-253) <= root).
  { apply Rle_trans with (bp (-1) * bp (-252)); [rewrite <- bp_add; apply bp_le; lia|]. destruct Ro as [Ro _].
    apply Rle_trans with (2 := Ro). apply Rmult_le_compat; try lra; [simpl; lra | rewrite u_val; simpl; lra]. }
  pose proof (bp_pos (-253)) as B253.
  assert (M4 : (1 - u) * (m3 * root) <= error).
  { apply rounded_low. apply Rle_trans with (bp (-257) * bp (-253)); [rewrite <- bp_add; apply bp_le; lia|].
    apply Rmult_le_compat; lra. }
  (* all together *)
  set (k := 1 - u) in *. set (E := CANDIDATE * e) in *.
  assert (Ep : 0 < E) by (unfold E, CANDIDATE; lra).
  assert (N1 : k * k * E <= m1).
  { apply Rle_trans with (2 := M1). rewrite Rmult_assoc. apply Rmult_le_compat_l; [lra|].
    change E with (16 / 10 * e). rewrite <- Rmult_assoc. apply Rmult_le_compat_r; lra. }
  assert (N2 : k * k * k * (E * inverse_a) <= m2).
  { apply Rle_trans with (2 := M2). replace (k * k * k * (E * inverse_a)) with (k * (k * k * E * inverse_a)) by ring.
    apply Rmult_le_compat_l; [lra|]. apply Rmult_le_compat_r; lra. }
  assert (N3 : k * k * k * k * (E * inverse_a * inverse) <= m3).
  { apply Rle_trans with (2 := M3).
    replace (k * k * k * k * (E * inverse_a * inverse)) with (k * (k * k * k * (E * inverse_a) * inverse)) by ring.
    apply Rmult_le_compat_l; [lra|]. apply Rmult_le_compat_r; lra. }
  assert (N4 : k * k * k * k * k * (E * inverse_a * inverse * root) <= error).
  { apply Rle_trans with (2 := M4).
    replace (k * k * k * k * k * (E * inverse_a * inverse * root)) with
      (k * (k * k * k * k * (E * inverse_a * inverse) * root)) by ring.
    apply Rmult_le_compat_l; [lra|]. apply Rmult_le_compat_r; lra. }
  assert (HE : (1 - 32 * u) * E <= error * (A * y)).
  { apply Rle_trans with (k * k * k * k * k * (E * inverse_a * inverse * root) * (A * y));
      [|apply Rmult_le_compat_r; [apply Rmult_le_pos; lra | exact N4]].
    replace (k * k * k * k * k * (E * inverse_a * inverse * root) * (A * y)) with
      (E * (k * k * k * k * k * ((inverse_a * A) * (inverse * (root * y))))) by ring.
    rewrite (Rmult_comm _ E). apply Rmult_le_compat_l; [lra|].
    assert (Z1 : 1 - 5 * u <= inverse_a * A) by (apply Rabs_le_inv in IA; lra).
    assert (Z2 : k * k <= inverse * (root * y)).
    { apply Rle_trans with (k * / delta * (k * y * y)).
      - right. replace (k * y * y) with (k * (y * y)) by ring. rewrite YY. field. lra.
      - apply Rmult_le_compat; try lra; try (apply Rlt_le, Rmult_lt_0_compat; lra).
        + apply Rmult_le_pos; [apply Rmult_le_pos|]; lra.
        + apply Rmult_le_compat_r; lra. }
    assert (kk : 0 < k * k) by now apply Rmult_lt_0_compat.
    apply Rle_trans with (k * k * k * k * k * ((1 - 5 * u) * (k * k))).
    - unfold k. rewrite u_val. lra.
    - apply Rmult_le_compat_l; [repeat apply Rmult_le_pos; lra|]. apply Rmult_le_compat; try lra. rewrite u_val. lra. }
  (* the premises of the theorem on candidates *)
  apply (CANDIDATE_holds (sqrt A) (sqrt WW) (Rabs r) A Q delta Delta e) with (b := b) (root := root)
    (n := RN (- b + sign * root)) (inverse := inverse_a); try apply RN_F.
  - now apply sqrt_lt_R0.
  - apply sqrt_pos.
  - assumption.
  - symmetry. now apply sqrt_sqrt.
  - rewrite sqrt_sqrt, abs_sq by assumption. reflexivity.
  - eapply Rle_trans; [exact DE|]. rewrite AQ. set (G := A * WW) in *. set (H := A * (r * r)) in *. clearbody G H.
    clear - AW AR. rewrite u_val. lra.
  - clear - EL uK. lra.
  - assumption.
  - fold y. apply below_root; [apply Rmult_le_pos; [rewrite u_val; lra | apply Rmult_le_pos; [apply sqrt_pos | lra]]|].
    rewrite YY. apply Rle_trans with (1 := DT).
    replace ((1 + 10 * u) * (sqrt A * Rabs r) * ((1 + 10 * u) * (sqrt A * Rabs r))) with
      ((1 + 10 * u) * (1 + 10 * u) * (sqrt A * sqrt A * (Rabs r * Rabs r))) by ring.
    rewrite sqrt_sqrt, abs_sq by assumption. apply Rmult_le_compat_r; [assumption | rewrite u_val; lra].
  - assumption.
  - fold y. eapply Rle_trans; [exact BN|].
    assert (T : bp (-1065) <= / 100 * (u * y)).
    { apply Rle_trans with (bp (-7) * (u * bp (-252))); [unfold u; rewrite <- !bp_add; apply bp_le; lia|].
      apply Rmult_le_compat; try lra; [apply Rlt_le, bp_pos | apply Rmult_le_pos; lra | simpl; lra|].
      apply Rmult_le_compat_l; lra. }
    assert (0 <= u * (sqrt A * sqrt WW)) by (apply Rmult_le_pos; [lra | apply Rmult_le_pos; apply sqrt_pos]). lra.
  - fold y. apply Rabs_le. unfold k in Ro. lra.
  - assumption.
  - apply RN_sum; [now apply F_opp | assert (Fr : F root) by apply RN_F; destruct Hsign as [S|S]; rewrite S;
      [now rewrite Rmult_1_l | replace (-1 * root) with (- root) by ring; now apply F_opp]].
  - rewrite Rabs_minus_sym in IA. rewrite Rabs_minus_sym. eapply Rle_trans; [exact IA|]. lra.
  - apply RN_err.
  - fold y. rewrite Rmult_assoc.
    assert (q0 : 0 <= sqrt Q) by apply sqrt_pos. assert (QQ : sqrt Q * sqrt Q = Q) by (apply sqrt_sqrt; lra).
    assert (ql : bp (-126) <= sqrt Q).
    { apply below_root; [exact q0|]. rewrite QQ, bp_sq. apply Rle_trans with (2 := LQ). apply bp_le; lia. }
    assert (yt : y <= bp 102 * sqrt Q).
    { apply below_root; [apply Rmult_le_pos; [apply Rlt_le, bp_pos | exact q0]|]. rewrite YY.
      replace (bp 102 * sqrt Q * (bp 102 * sqrt Q)) with (bp 102 * bp 102 * (sqrt Q * sqrt Q)) by ring.
      rewrite QQ, bp_sq. apply Rle_trans with (2 * (A * Q)).
      - clear - DT AQ AW AR. rewrite AQ. set (G := A * WW) in *. set (H := A * (r * r)) in *. clearbody G H.
        rewrite u_val in *. lra.
      - rewrite <- Rmult_assoc. apply Rmult_le_compat_r; [lra|]. change (102 + 102)%Z with (2 + 202)%Z.
        rewrite (bp_add 2). simpl (bp 2). pose proof (bp_pos 202). lra. }
    replace (/ 100 * (u * (A * Q))) with (A * (/ 100 * (u * Q))) by ring.
    replace (bp (-1075) * (A * y)) with (A * (bp (-1075) * y)) by ring. apply Rmult_le_compat_l; [lra|].
    apply Rle_trans with (bp (-1075) * (bp 102 * sqrt Q)); [apply Rmult_le_compat_l; [apply Rlt_le, bp_pos | exact
      yt]|].
    rewrite <- QQ at 2. replace (bp (-1075) * (bp 102 * sqrt Q)) with (bp (-1075) * bp 102 * sqrt Q) by ring.
    replace (/ 100 * (u * (sqrt Q * sqrt Q))) with (/ 100 * (u * sqrt Q) * sqrt Q) by ring.
    apply Rmult_le_compat_r; [exact q0|]. apply Rle_trans with (bp (-7) * (u * bp (-126))).
    + unfold u. rewrite <- !bp_add. apply bp_le. lia.
    + apply Rmult_le_compat; try lra; [apply Rlt_le, bp_pos | apply Rmult_le_pos; [lra | apply Rlt_le, bp_pos] |
        simpl; lra|]. apply Rmult_le_compat_l; lra.
  - exact HE.
Qed.
End Sphere.
