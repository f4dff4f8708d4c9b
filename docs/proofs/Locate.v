(* rt-geom, triangle/locate.rs: a point and a triangle in plain doubles. *)
From Proofs Require Import Rounding DoubleDouble Twice.
Open Scope R_scope.

(* Up to here in magnitude the differences of points may be. *)
Definition FARTHEST := bp 200.
(* Swallows all errors of underflow. *)
Definition UNDERFLOW := bp (-500).
(* The error of a turn, relative to l^3 k: `filtered_signs`. *)
Definition TURN_ERROR := 136 * u.
(* The same in double-double: `double_double_turns`. *)
Definition TURN_ERROR_2 := 640 * u * u.
(* The error of a volume, relative to l^2 k: `coplanar`. *)
Definition VOLUME_ERROR := 64 * u.

(* A difference that is below FARTHEST as computed is below 2^201. *)
Theorem FARTHEST_holds : forall x y, F x -> F y -> Rabs (RN (x - y)) < FARTHEST -> bounded (D x y 201).
Proof.
  intros x y Fx Fy H. cbn [bounded]. pose proof (RN_diff x y Fx Fy) as P. unfold FARTHEST in H.
  assert (F2 : bp 201 = 2 * bp 200) by (change 201%Z with (1 + 200)%Z; rewrite bp_add, bp_1; ring).
  pose proof (Rabs_triang (RN (x - y)) (- (RN (x - y) - (x - y)))) as T.
  replace (RN (x - y) + - (RN (x - y) - (x - y))) with (x - y) in T by ring. rewrite Rabs_Ropp in T.
  pose proof (bp_pos 200). rewrite u_val in P. lra.
Qed.

Section Locate.
Variables a1 a2 a3 b1 b2 b3 c1 c2 c3 p1 p2 p3 : R.
Definition difference x y := D x y 201.
Definition tmax x y z := Max (Abs x) (Max (Abs y) (Abs z)).
Definition tmost x1 x2 x3 y1 y2 y3 z1 z2 z3 := Max (tmax x1 x2 x3) (Max (tmax y1 y2 y3) (tmax z1 z2 z3)).
(* `sizes`: the largest component among the edges, and among the differences between the point and the vertices *)
Definition tedge := tmost (difference b1 a1) (difference b2 a2) (difference b3 a3) (difference c1 b1) (difference c2 b2)
  (difference c3 b3) (difference a1 c1) (difference a2 c2) (difference a3 c3).
Definition tfar := tmost (difference p1 a1) (difference p2 a2) (difference p3 a3) (difference p1 b1) (difference p2 b2)
  (difference p3 b3) (difference p1 c1) (difference p2 c2) (difference p3 c3).
Let l := exact tedge.
Let k := exact tfar.
(* n = (b - a) x (c - a) *)
Definition tn x2 x3 y2 y3 z2 z3 := tminor (difference y2 x2) (difference z3 x3) (difference y3 x3) (difference z2 x2).
Definition tn1 := tn a2 a3 b2 b3 c2 c3. Definition tn2 := tn a3 a1 b3 b1 c3 c1. Definition tn3 := tn a1 a2 b1 b2 c1 c2.
(* the turn from `f` to `t` around the point: n . ((t - f) x (p - f)) *)
Definition tturn f1 f2 f3 t1 t2 t3 := tdot tn1 tn2 tn3 (tn f2 f3 t2 t3 p2 p3) (tn f3 f1 t3 t1 p3 p1) (tn f1 f2 t1 t2
  p1 p2).
Definition tvolume := tdot tn1 tn2 tn3 (difference p1 a1) (difference p2 a2) (difference p3 a3).
Definition terror :=
  Add (Mul (Mul (X TURN_ERROR (-45)) (Mul (Mul tedge tedge) tedge)) tfar) (X UNDERFLOW (-500)).
Definition terror_2 :=
  Add (Mul (Mul (X TURN_ERROR_2 (-96)) (Mul (Mul tedge tedge) tedge)) tfar) (X UNDERFLOW (-500)).
Definition tvolume_error := Add (Mul (Mul (X VOLUME_ERROR (-46)) (Mul tedge tedge)) tfar) (X UNDERFLOW (-500)).
Ltac terms := unfold terror, tvolume_error, tvolume, tturn, tn1, tn2, tn3, tn, tedge, tfar, tmost, tmax, difference,
  tdot, tminor in *.

(* All differences are in the range: FARTHEST, and one rounding. *)
Hypothesis range : bounded tedge /\ bounded tfar.

Lemma max_le : forall x y z w, Rmax (Rabs x) (Rmax (Rabs y) (Rabs z)) <= w -> Rabs x <= w /\ Rabs y <= w /\ Rabs z <= w.
Proof.
  intros. pose proof (Rmax_l (Rabs x) (Rmax (Rabs y) (Rabs z))). pose proof (Rmax_r (Rabs x) (Rmax (Rabs y) (Rabs z))).
  pose proof (Rmax_l (Rabs y) (Rabs z)). pose proof (Rmax_r (Rabs y) (Rabs z)). lra.
Qed.
Lemma most_le : forall x y z, x <= Rmax x (Rmax y z) /\ y <= Rmax x (Rmax y z) /\ z <= Rmax x (Rmax y z).
Proof.
  intros. pose proof (Rmax_l x (Rmax y z)). pose proof (Rmax_r x (Rmax y z)). pose proof (Rmax_l y z).
  pose proof (Rmax_r y z). lra.
Qed.
Definition edge_like f1 f2 f3 t1 t2 t3 := Rabs (t1 - f1) <= l /\ Rabs (t2 - f2) <= l /\ Rabs (t3 - f3) <= l.
Definition far_like f1 f2 f3 := Rabs (p1 - f1) <= k /\ Rabs (p2 - f2) <= k /\ Rabs (p3 - f3) <= k.
Lemma edges : edge_like a1 a2 a3 b1 b2 b3 /\ edge_like b1 b2 b3 c1 c2 c3 /\ edge_like c1 c2 c3 a1 a2 a3 /\
  edge_like a1 a2 a3 c1 c2 c3.
Proof.
  assert (A : edge_like a1 a2 a3 b1 b2 b3 /\ edge_like b1 b2 b3 c1 c2 c3 /\ edge_like c1 c2 c3 a1 a2 a3).
  { unfold edge_like, l. terms. cbn [exact].
    match goal with |- context [Rmax ?x (Rmax ?y ?z)] => destruct (most_le x y z) as (H1 & H2 & H3) end.
    repeat split; apply max_le in H1; apply max_le in H2; apply max_le in H3; lra. }
  destruct A as (A & B & C). repeat split; try apply A; try apply B; try apply C; rewrite Rabs_minus_sym; apply C.
Qed.
Lemma fars : far_like a1 a2 a3 /\ far_like b1 b2 b3 /\ far_like c1 c2 c3.
Proof.
  unfold far_like, k. terms. cbn [exact].
  match goal with |- context [Rmax ?x (Rmax ?y ?z)] => destruct (most_le x y z) as (H1 & H2 & H3) end.
  repeat split; apply max_le in H1; apply max_le in H2; apply max_le in H3; lra.
Qed.
Lemma positive : 0 <= l /\ 0 <= k.
Proof.
  destruct edges as ((A & _) & _). destruct fars as ((B & _) & _). pose proof (Rabs_pos (b1 - a1)).
  pose proof (Rabs_pos (p1 - a1)). lra.
Qed.
Lemma l_size : size tedge = l. Proof. unfold l. terms. reflexivity. Qed.
Lemma k_size : size tfar = k. Proof. unfold k. terms. reflexivity. Qed.
Lemma range_each : l <= bp 201 /\ k <= bp 201.
Proof.
  destruct range as [A B]. pose proof (top_ok tedge A) as [_ P]. pose proof (top_ok tfar B) as [_ Q].
  rewrite l_size in P. rewrite k_size in Q. exact (conj P Q).
Qed.

Lemma bounded_turn : forall f1 f2 f3 t1 t2 t3, edge_like f1 f2 f3 t1 t2 t3 -> far_like f1 f2 f3 -> bounded (tturn f1
  f2 f3 t1 t2 t3).
Proof.
  intros f1 f2 f3 t1 t2 t3 (A & B & C) (A' & B' & C'). destruct range_each.
  destruct edges as ((E1 & E2 & E3) & _ & _ & F1 & F2 & F3).
  terms. cbn [bounded]. repeat split; lra.
Qed.
Lemma minor_size : forall x y z w m n, 0 <= m -> 0 <= n -> Rabs x <= m -> Rabs y <= n -> Rabs z <= m -> Rabs w <= n ->
  0 <= Rabs x * Rabs y + Rabs z * Rabs w <= 2 * (m * n).
Proof.
  intros. pose proof (Rabs_pos x). pose proof (Rabs_pos y). pose proof (Rabs_pos z). pose proof (Rabs_pos w).
  pose proof (mul2 (Rabs x) (Rabs y) m n ltac:(lra) ltac:(lra)).
  pose proof (mul2 (Rabs z) (Rabs w) m n ltac:(lra) ltac:(lra)).
  assert (0 <= Rabs x * Rabs y) by (apply Rmult_le_pos; assumption).
  assert (0 <= Rabs z * Rabs w) by (apply Rmult_le_pos; assumption).
  lra.
Qed.

Lemma turn_size : forall f1 f2 f3 t1 t2 t3, edge_like f1 f2 f3 t1 t2 t3 -> far_like f1 f2 f3 ->
  size (tturn f1 f2 f3 t1 t2 t3) <= 12 * (l * l * l * k).
Proof.
  intros f1 f2 f3 t1 t2 t3 HE HF.
  destruct edges as ((E1 & E2 & E3) & _ & _ & F1 & F2 & F3). destruct HE as (G1 & G2 & G3).
  destruct HF as (K1 & K2 & K3).
  destruct positive as [L0 K0]. terms. cbn [size].
  pose proof (minor_size _ _ _ _ _ _ L0 L0 E2 F3 E3 F2) as N1.
  pose proof (minor_size _ _ _ _ _ _ L0 L0 E3 F1 E1 F3) as N2.
  pose proof (minor_size _ _ _ _ _ _ L0 L0 E1 F2 E2 F1) as N3.
  pose proof (minor_size _ _ _ _ _ _ L0 K0 G2 K3 G3 K2) as M1.
  pose proof (minor_size _ _ _ _ _ _ L0 K0 G3 K1 G1 K3) as M2.
  pose proof (minor_size _ _ _ _ _ _ L0 K0 G1 K2 G2 K1) as M3.
  pose proof (mul2 _ _ _ _ N1 M1). pose proof (mul2 _ _ _ _ N2 M2). pose proof (mul2 _ _ _ _ N3 M3). lra.
Qed.

(* A turn is off by at most 136 u l^3 k + 2^-500 as computed. *)
Theorem turn_error : forall f1 f2 f3 t1 t2 t3 turn e, edge_like f1 f2 f3 t1 t2 t3 -> far_like f1 f2 f3 ->
  plain (tturn f1 f2 f3 t1 t2 t3) turn -> plain terror e -> Rabs (turn - exact (tturn f1 f2 f3 t1 t2 t3)) <= e.
Proof.
  intros f1 f2 f3 t1 t2 t3 turn e HE HF Ht He. pose proof (bounded_turn _ _ _ _ _ _ HE HF) as B.
  pose proof (turn_size _ _ _ _ _ _ HE HF) as Z. destruct positive as [L0 K0]. destruct range as [RE RF].
  pose proof (plain_error_at _ _ 11 (low (tturn f1 f2 f3 t1 t2 t3)) Ht B eq_refl eq_refl ltac:(lia)) as P.
  assert (BE : bounded terror).
  { unfold terror. cbn [bounded]. repeat match goal with |- _ /\ _ => split end; try assumption.
    - unfold TURN_ERROR. constant.
    - unfold UNDERFLOW. rewrite Rabs_pos_eq; [lra | apply Rlt_le, bp_pos]. }
  pose proof (plain_error_at terror e 9 (low terror) He BE eq_refl eq_refl ltac:(lia)) as Q.
  assert (LT : bp (low terror) <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; vm_compute; discriminate).
  assert (LT2 : bp (low (tturn f1 f2 f3 t1 t2 t3)) <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; vm_compute;
    discriminate).
  assert (U0 : 0 < UNDERFLOW) by apply bp_pos.
  assert (V : exact terror = 136 * u * (l * l * l * k) + UNDERFLOW /\ size terror = 136 * u * (l * l * l * k) +
    UNDERFLOW).
  { unfold terror. cbn [exact size]. rewrite l_size, k_size. fold l k. rewrite (Rabs_pos_eq UNDERFLOW) by lra.
    rewrite (Rabs_pos_eq TURN_ERROR) by (unfold TURN_ERROR; rewrite u_val; lra). unfold TURN_ERROR. split; ring. }
  destruct V as [V1 V2]. rewrite V1, V2 in Q.
  eapply Rle_trans; [exact P|]. set (T := size (tturn f1 f2 f3 t1 t2 t3)) in *. set (G := l * l * l * k) in *.
  assert (0 <= G) by (unfold G; repeat apply Rmult_le_pos; assumption). clearbody T G.
  apply Rabs_le_inv in Q. rewrite u_val in *. lra.
Qed.

(* In double-double it is off by at most 640 u^2 l^3 k + 2^-500 as computed, less what the test of its high part
  takes. *)
Theorem turn_error_2 : forall f1 f2 f3 t1 t2 t3 turn e, edge_like f1 f2 f3 t1 t2 t3 -> far_like f1 f2 f3 ->
  twice (tturn f1 f2 f3 t1 t2 t3) turn -> plain terror_2 e ->
  Rabs (turn - exact (tturn f1 f2 f3 t1 t2 t3)) <= (1 - 2 * u) * e.
Proof.
  intros f1 f2 f3 t1 t2 t3 turn e HE HF Ht He. pose proof (bounded_turn _ _ _ _ _ _ HE HF) as B.
  pose proof (turn_size _ _ _ _ _ _ HE HF) as Z. destruct positive as [L0 K0]. destruct range as [RE RF].
  pose proof (twice_error_at _ _ 51 (low2 (tturn f1 f2 f3 t1 t2 t3)) Ht B eq_refl eq_refl ltac:(lia)) as P.
  assert (BE : bounded terror_2).
  { unfold terror_2. cbn [bounded]. repeat match goal with |- _ /\ _ => split end; try assumption.
    - unfold TURN_ERROR_2. constant.
    - unfold UNDERFLOW. rewrite Rabs_pos_eq; [lra | apply Rlt_le, bp_pos]. }
  pose proof (plain_error_at terror_2 e 9 (low terror_2) He BE eq_refl eq_refl ltac:(lia)) as Q.
  assert (LT : bp (low terror_2) <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; vm_compute; discriminate).
  assert (LT2 : bp (low2 (tturn f1 f2 f3 t1 t2 t3)) <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; vm_compute;
    discriminate).
  assert (U0 : 0 < UNDERFLOW) by apply bp_pos.
  assert (V : exact terror_2 = 640 * (u * u) * (l * l * l * k) + UNDERFLOW /\ size terror_2 = 640 * (u * u) * (l * l *
    l * k) + UNDERFLOW).
  { unfold terror_2. cbn [exact size]. rewrite l_size, k_size. fold l k. rewrite (Rabs_pos_eq UNDERFLOW) by lra.
    rewrite (Rabs_pos_eq TURN_ERROR_2) by (unfold TURN_ERROR_2; rewrite u_val; lra). unfold TURN_ERROR_2. split; ring. }
  destruct V as [V1 V2]. rewrite V1, V2 in Q.
  eapply Rle_trans; [exact P|]. set (T := size (tturn f1 f2 f3 t1 t2 t3)) in *. set (G := l * l * l * k) in *.
  assert (0 <= G) by (unfold G; repeat apply Rmult_le_pos; assumption). clearbody T G.
  apply Rabs_le_inv in Q. rewrite u_val in *. lra.
Qed.
Theorem TURN_ERROR_2_holds : forall e, plain terror_2 e ->
  let certain f1 f2 f3 t1 t2 t3 := forall h l, dd h l -> twice (tturn f1 f2 f3 t1 t2 t3) (h + l) ->
    (h > e -> 0 < exact (tturn f1 f2 f3 t1 t2 t3)) /\ (h < - e -> exact (tturn f1 f2 f3 t1 t2 t3) < 0) in
  certain b1 b2 b3 c1 c2 c3 /\ certain c1 c2 c3 a1 a2 a3 /\ certain a1 a2 a3 b1 b2 b3.
Proof.
  intros e He certain. destruct edges as (E1 & E2 & E3 & _). destruct fars as (F1 & F2 & F3).
  split; [|split]; intros h low_part D T; apply high_sign with (l := low_part); auto; apply turn_error_2; assumption.
Qed.

(* What underflows in a turn, a volume and their bounds is below a part of 10^12 of UNDERFLOW. *)
Theorem UNDERFLOW_holds : forall f1 f2 f3 t1 t2 t3,
  bp (low (tturn f1 f2 f3 t1 t2 t3)) <= / 1000000000000 * UNDERFLOW /\ bp (low terror) <= / 1000000000000 * UNDERFLOW /\
  bp (low tvolume) <= / 1000000000000 * UNDERFLOW /\ bp (low tvolume_error) <= / 1000000000000 * UNDERFLOW.
Proof. intros. repeat split; apply bp_part12; vm_compute; discriminate. Qed.
(* So the sign of each turn around an edge is certain where it exceeds that. *)
Theorem TURN_ERROR_holds : forall e, plain terror e ->
  let certain f1 f2 f3 t1 t2 t3 := forall turn, plain (tturn f1 f2 f3 t1 t2 t3) turn ->
    (turn > e -> 0 < exact (tturn f1 f2 f3 t1 t2 t3)) /\ (turn < - e -> exact (tturn f1 f2 f3 t1 t2 t3) < 0) in
  certain b1 b2 b3 c1 c2 c3 /\ certain c1 c2 c3 a1 a2 a3 /\ certain a1 a2 a3 b1 b2 b3.
Proof.
  intros e He certain. destruct edges as (E1 & E2 & E3 & _). destruct fars as (F1 & F2 & F3).
  repeat split; apply certain_sign with (e := e); apply turn_error; assumption.
Qed.

(* The volume n . (p - a) is off by at most 64 u l^2 k + 2^-500 as computed. *)
Theorem VOLUME_ERROR_holds : forall v e, plain tvolume v -> plain tvolume_error e ->
  Rabs (v - exact tvolume) <= e /\ (e < Rabs v -> exact tvolume <> 0).
Proof.
  intros v e Hv He. destruct edges as ((E1 & E2 & E3) & _ & _ & F1 & F2 & F3). destruct fars as ((K1 & K2 & K3) & _).
  destruct positive as [L0 K0]. destruct range as [RE RF]. destruct range_each.
  assert (B : bounded tvolume) by (terms; cbn [bounded]; repeat split; lra).
  assert (Z : size tvolume <= 6 * (l * l * k)).
  { terms. cbn [size].
    pose proof (minor_size _ _ _ _ _ _ L0 L0 E2 F3 E3 F2) as N1.
    pose proof (minor_size _ _ _ _ _ _ L0 L0 E3 F1 E1 F3) as N2.
    pose proof (minor_size _ _ _ _ _ _ L0 L0 E1 F2 E2 F1) as N3.
    assert (M1 : 0 <= Rabs (p1 - a1) <= k) by (split; [apply Rabs_pos | assumption]).
    assert (M2 : 0 <= Rabs (p2 - a2) <= k) by (split; [apply Rabs_pos | assumption]).
    assert (M3 : 0 <= Rabs (p3 - a3) <= k) by (split; [apply Rabs_pos | assumption]).
    pose proof (mul2 _ _ _ _ N1 M1). pose proof (mul2 _ _ _ _ N2 M2). pose proof (mul2 _ _ _ _ N3 M3). lra. }
  pose proof (plain_error_at _ _ 8 (low tvolume) Hv B eq_refl eq_refl ltac:(lia)) as P.
  assert (BE : bounded tvolume_error).
  { unfold tvolume_error. cbn [bounded]. repeat match goal with |- _ /\ _ => split end; try assumption.
    - unfold VOLUME_ERROR. constant.
    - unfold UNDERFLOW. rewrite Rabs_pos_eq; [lra | apply Rlt_le, bp_pos]. }
  pose proof (plain_error_at tvolume_error e 7 (low tvolume_error) He BE eq_refl eq_refl ltac:(lia)) as Q.
  assert (LT : bp (low tvolume_error) <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; vm_compute; discriminate).
  assert (LT2 : bp (low tvolume) <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; vm_compute; discriminate).
  assert (U0 : 0 < UNDERFLOW) by apply bp_pos.
  assert (V : exact tvolume_error = 64 * u * (l * l * k) + UNDERFLOW /\ size tvolume_error = 64 * u * (l * l * k) +
    UNDERFLOW).
  { unfold tvolume_error. cbn [exact size]. rewrite l_size, k_size. fold l k. rewrite (Rabs_pos_eq UNDERFLOW) by lra.
    rewrite (Rabs_pos_eq VOLUME_ERROR) by (unfold VOLUME_ERROR; rewrite u_val; lra). unfold VOLUME_ERROR. split; ring. }
  destruct V as [V1 V2]. rewrite V1, V2 in Q. assert (G : Rabs (v - exact tvolume) <= e).
  { eapply Rle_trans; [exact P|]. set (T := size tvolume) in *. set (G := l * l * k) in *.
    assert (0 <= G) by (unfold G; repeat apply Rmult_le_pos; assumption). clearbody T G.
    apply Rabs_le_inv in Q. rewrite u_val in *. lra. }
  split; [exact G|]. intros Hn N0. rewrite N0, Rminus_0_r in G. lra.
Qed.
End Locate.
