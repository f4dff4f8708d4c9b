(* rt-geom, triangle/exact.rs: the volumes in double-double, `double_double_signs`. *)
From Proofs Require Import Rounding DoubleDouble Twice.
Open Scope R_scope.

(* The error of a volume, relative to D M^2. *)
Definition VOLUME_ERROR := 32 * u * u.
(* Of their sum, so many times that. *)
Definition SUM_FACTOR := 4.
(* Swallows all errors of underflow. *)
Definition UNDERFLOW := bp (-500).

Section Volumes.
(* the vertices, the ray's origin and direction *)
Variables a1 a2 a3 b1 b2 b3 c1 c2 c3 o1 o2 o3 d1 d2 d3 reach : R.
Hypotheses (R1 : Rabs d1 <= reach) (R2 : Rabs d2 <= reach) (R3 : Rabs d3 <= reach) (Hd : bp (-100) <= reach <= bp 100).
Definition from x o := D x o 301.
Definition tmost x y z o := Max (Abs (from x o)) (Max (Abs (from y o)) (Abs (from z o))).
Definition tsize := Add (Add (tmost a1 b1 c1 o1) (tmost a2 b2 c2 o2)) (tmost a3 b3 c3 o3).
Let m1 := exact (tmost a1 b1 c1 o1). Let m2 := exact (tmost a2 b2 c2 o2). Let m3 := exact (tmost a3 b3 c3 o3).
Let M := m1 + m2 + m3.
(* (d x x) . y *)
Definition tvolume x1 x2 x3 y1 y2 y3 :=
  let d x := X x 100 in
  tdot (tminor (d d2) (from x3 o3) (d d3) (from x2 o2)) (tminor (d d3) (from x1 o1) (d d1) (from x3 o3))
    (tminor (d d1) (from x2 o2) (d d2) (from x1 o1)) (from y1 o1) (from y2 o2) (from y3 o3).
Definition tu := tvolume b1 b2 b3 c1 c2 c3.
(* the second one is computed with the opposite sign *)
Definition tv := tvolume a1 a2 a3 c1 c2 c3.
Definition tw := tvolume a1 a2 a3 b1 b2 b3.
Definition tsum := Add (Sub tu tv) tw.
(* the bound, from `scale`, 32 u^2 D rounded *)
Definition terror scale := Add (Mul (Mul (X scale 0) tsize) tsize) (X UNDERFLOW (-500)).
Hypothesis range : bounded tsize.
Ltac terms := unfold tsum, tu, tv, tw, tvolume, terror, tsize, tmost, from, tdot, tminor in *.

Definition vertex x1 x2 x3 := Rabs (x1 - o1) <= m1 /\ Rabs (x2 - o2) <= m2 /\ Rabs (x3 - o3) <= m3.
Lemma most_le : forall x y z, x <= Rmax x (Rmax y z) /\ y <= Rmax x (Rmax y z) /\ z <= Rmax x (Rmax y z).
Proof.
  intros. pose proof (Rmax_l x (Rmax y z)). pose proof (Rmax_r x (Rmax y z)). pose proof (Rmax_l y z).
  pose proof (Rmax_r y z). lra.
Qed.
Lemma vertices : vertex a1 a2 a3 /\ vertex b1 b2 b3 /\ vertex c1 c2 c3.
Proof.
  unfold vertex, m1, m2, m3, tmost, from. cbn [exact].
  pose proof (most_le (Rabs (a1 - o1)) (Rabs (b1 - o1)) (Rabs (c1 - o1))).
  pose proof (most_le (Rabs (a2 - o2)) (Rabs (b2 - o2)) (Rabs (c2 - o2))).
  pose proof (most_le (Rabs (a3 - o3)) (Rabs (b3 - o3)) (Rabs (c3 - o3))). tauto.
Qed.
Lemma positive : 0 <= m1 /\ 0 <= m2 /\ 0 <= m3.
Proof.
  destruct vertices as ((A & B & C) & _). pose proof (Rabs_pos (a1 - o1)). pose proof (Rabs_pos (a2 - o2)).
  pose proof (Rabs_pos (a3 - o3)). lra.
Qed.
Lemma tops : m1 <= bp 301 /\ m2 <= bp 301 /\ m3 <= bp 301.
Proof.
  destruct range as [[H1 H2] H3]. unfold m1, m2, m3, tmost, from in *. cbn [exact bounded] in *.
  repeat split; repeat apply Rmax_lub; tauto.
Qed.
Lemma volume_bounded : forall x1 x2 x3 y1 y2 y3, vertex x1 x2 x3 -> vertex y1 y2 y3 -> bounded (tvolume x1 x2 x3 y1 y2
  y3).
Proof.
  intros x1 x2 x3 y1 y2 y3 (A & B & C) (A' & B' & C'). destruct tops as (T1 & T2 & T3). terms. cbn [bounded].
  repeat split; lra.
Qed.
Lemma volume_size : forall x1 x2 x3 y1 y2 y3, vertex x1 x2 x3 -> vertex y1 y2 y3 ->
  size (tvolume x1 x2 x3 y1 y2 y3) <= 2 / 3 * (reach * (M * M)).
Proof.
  intros x1 x2 x3 y1 y2 y3 (A1 & A2 & A3) (B1 & B2 & B3). destruct positive as (P1 & P2 & P3). terms. cbn [size].
  pose proof (bp_pos (-100)).
  assert (D1' : 0 <= Rabs d1 <= reach) by (split; [apply Rabs_pos | assumption]).
  assert (D2' : 0 <= Rabs d2 <= reach) by (split; [apply Rabs_pos | assumption]).
  assert (D3' : 0 <= Rabs d3 <= reach) by (split; [apply Rabs_pos | assumption]).
  assert (X1 : 0 <= Rabs (x1 - o1) <= m1) by (split; [apply Rabs_pos | assumption]).
  assert (X2 : 0 <= Rabs (x2 - o2) <= m2) by (split; [apply Rabs_pos | assumption]).
  assert (X3 : 0 <= Rabs (x3 - o3) <= m3) by (split; [apply Rabs_pos | assumption]).
  assert (Y1 : 0 <= Rabs (y1 - o1) <= m1) by (split; [apply Rabs_pos | assumption]).
  assert (Y2 : 0 <= Rabs (y2 - o2) <= m2) by (split; [apply Rabs_pos | assumption]).
  assert (Y3 : 0 <= Rabs (y3 - o3) <= m3) by (split; [apply Rabs_pos | assumption]).
  pose proof (mul3 _ _ _ _ _ _ D2' X3 Y1). pose proof (mul3 _ _ _ _ _ _ D3' X2 Y1).
  pose proof (mul3 _ _ _ _ _ _ D3' X1 Y2).
  pose proof (mul3 _ _ _ _ _ _ D1' X3 Y2). pose proof (mul3 _ _ _ _ _ _ D1' X2 Y3).
  pose proof (mul3 _ _ _ _ _ _ D2' X1 Y3).
  assert (Q : m1 * m2 + m1 * m3 + m2 * m3 <= / 3 * (M * M)).
  { unfold M. pose proof (sq_pos (m1 - m2)). pose proof (sq_pos (m1 - m3)). pose proof (sq_pos (m2 - m3)). lra. }
  assert (reach * (m1 * m2 + m1 * m3 + m2 * m3) <= reach * (/ 3 * (M * M))) by (apply Rmult_le_compat_l; lra). lra.
Qed.

(* The bound as computed. *)
Lemma error_low : forall scale e, Rabs (scale - VOLUME_ERROR * reach) <= u * Rabs (VOLUME_ERROR * reach) + bp (-1075) ->
  plain (terror scale) e -> (32 - / 1000) * (u * u) * (reach * (M * M)) + (1 - / 1000) * UNDERFLOW <= e.
Proof.
  intros scale e Hs He. pose proof (bp_pos (-100)). destruct positive as (P1 & P2 & P3).
  assert (C : Rabs (VOLUME_ERROR * reach) = 32 * (u * u) * reach).
  { rewrite Rabs_pos_eq; [unfold VOLUME_ERROR; ring|]. apply Rmult_le_pos; [unfold VOLUME_ERROR; rewrite u_val;
    lra | lra]. }
  rewrite C in Hs. replace (VOLUME_ERROR * reach) with (32 * (u * u) * reach) in Hs by (unfold VOLUME_ERROR; ring).
  assert (T : bp (-1075) <= u * (32 * (u * u) * reach)).
  { apply Rle_trans with (u * (u * u * bp (-100))); [unfold u; rewrite <- !bp_add; apply bp_le; lia|].
    apply Rmult_le_compat_l; [apply Rlt_le, u_pos|]. replace (32 * (u * u) * reach) with (u * u * (32 * reach)) by ring.
    apply Rmult_le_compat_l; [rewrite u_val; lra | lra]. }
  apply Rabs_le_inv in Hs. assert (S0 : (1 - 2 * u) * (32 * (u * u) * reach) <= scale) by lra.
  assert (S1 : 0 < scale) by (rewrite u_val in *; lra).
  assert (ST : Rabs scale <= bp 0).
  { rewrite Rabs_pos_eq by lra. assert (u * u * reach <= bp (-6)).
    { apply Rle_trans with (u * u * bp 100); [apply Rmult_le_compat_l; [rewrite u_val; lra | lra]|].
      unfold u. rewrite <- !bp_add. apply bp_le. lia. }
    simpl (bp (-6)) in *. simpl (bp 0). rewrite u_val in *. lra. }
  assert (B : bounded (terror scale)).
  { unfold terror. cbn [bounded]. repeat match goal with |- _ /\ _ => split end; try assumption.
    unfold UNDERFLOW. rewrite Rabs_pos_eq; [lra | apply Rlt_le, bp_pos]. }
  pose proof (plain_error_at _ e 9 (low (terror scale)) He B eq_refl eq_refl ltac:(lia)) as Q.
  assert (LT : bp (low (terror scale)) <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; vm_compute; discriminate).
  assert (U0 : 0 < UNDERFLOW) by apply bp_pos.
  assert (V : exact (terror scale) = scale * (M * M) + UNDERFLOW /\ size (terror scale) = scale * (M * M) + UNDERFLOW).
  { unfold terror. cbn [exact size]. rewrite (Rabs_pos_eq UNDERFLOW), (Rabs_pos_eq scale) by lra.
  unfold tsize, M, m1, m2, m3. cbn [exact size tmost from].
    split; ring. }
  destruct V as [V1 V2]. rewrite V1, V2 in Q. 
  assert (K : (1 - 2 * u) * (32 * (u * u) * reach) * (M * M) <= scale * (M * M)) by (apply Rmult_le_compat_r;
    [apply sq_pos | assumption]).
  replace ((1 - 2 * u) * (32 * (u * u) * reach) * (M * M)) with ((1 - 2 * u) * (32 * (u * u) * (reach * (M * M)))) in
    K by ring.
  assert (G0 : 0 <= reach * (M * M)) by (apply Rmult_le_pos; [lra | apply sq_pos]).
  set (G := reach * (M * M)) in *. set (H' := scale * (M * M)) in *. clearbody G H'. apply Rabs_le_inv in Q.
  rewrite u_val in *. lra.
Qed.

Theorem volume_error : forall x1 x2 x3 y1 y2 y3 z scale e, vertex x1 x2 x3 -> vertex y1 y2 y3 ->
  twice (tvolume x1 x2 x3 y1 y2 y3) z ->
  Rabs (scale - VOLUME_ERROR * reach) <= u * Rabs (VOLUME_ERROR * reach) + bp (-1075) -> plain (terror scale) e ->
  Rabs (z - exact (tvolume x1 x2 x3 y1 y2 y3)) <= (1 - 2 * u) * e.
Proof.
  intros x1 x2 x3 y1 y2 y3 z scale e HX HY Hz Hs He. pose proof (error_low scale e Hs He) as L.
  pose proof (twice_error_at _ _ 36 (low2 (tvolume x1 x2 x3 y1 y2 y3)) Hz (volume_bounded _ _ _ _ _ _ HX HY) eq_refl
    eq_refl ltac:(lia)) as P.
  pose proof (volume_size _ _ _ _ _ _ HX HY) as S. pose proof (bp_pos (-100)).
  assert (LT : bp (low2 (tvolume x1 x2 x3 y1 y2 y3)) <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; vm_compute;
    discriminate).
  assert (U0 : 0 < UNDERFLOW) by apply bp_pos.
  assert (G0 : 0 <= reach * (M * M)) by (apply Rmult_le_pos; [lra | apply sq_pos]).
  eapply Rle_trans; [exact P|]. set (T := size _) in *. set (G := reach * (M * M)) in *. clearbody G T.
  rewrite u_val in *. lra.
Qed.

(* A volume is off by at most 32 u^2 D M^2 + 2^-500 as computed: the sign of its high part is certain beyond. *)
Theorem VOLUME_ERROR_holds : forall scale e,
  Rabs (scale - VOLUME_ERROR * reach) <= u * Rabs (VOLUME_ERROR * reach) + bp (-1075) -> plain (terror scale) e ->
  let certain t := forall h l, dd h l -> twice t (h + l) -> (h > e -> 0 < exact t) /\ (h < - e -> exact t < 0) in
  certain tu /\ certain tv /\ certain tw.
Proof.
  intros scale e Hs He certain. destruct vertices as (A & B & C).
  split; [|split]; intros h l D T; apply high_sign with (l := l); auto; eapply volume_error; eauto.
Qed.
(* Their sum by at most four times that. *)
Theorem SUM_FACTOR_holds : forall scale e h l,
  Rabs (scale - VOLUME_ERROR * reach) <= u * Rabs (VOLUME_ERROR * reach) + bp (-1075) -> plain (terror scale) e ->
  dd h l -> twice tsum (h + l) -> (h > SUM_FACTOR * e -> 0 < exact tsum) /\ (h < - (SUM_FACTOR * e) -> exact tsum < 0).
Proof.
  intros scale e h l Hs He Hd' Hz. apply high_sign with (l := l); auto. pose proof (error_low scale e Hs He) as L.
  destruct vertices as (A & B & C).
  assert (BS : bounded tsum).
  { exact (conj (conj (volume_bounded _ _ _ _ _ _ B C) (volume_bounded _ _ _ _ _ _ A C)) (volume_bounded _ _ _ _ _ _ A
    B)). }
  pose proof (twice_error_at tsum _ 48 (low2 tsum) Hz BS eq_refl eq_refl ltac:(lia)) as P.
  pose proof (volume_size _ _ _ _ _ _ B C) as S1. pose proof (volume_size _ _ _ _ _ _ A C) as S2.
  pose proof (volume_size _ _ _ _ _ _ A B) as S3. fold tu in S1. fold tv in S2. fold tw in S3.
  assert (S : size tsum <= 2 * (reach * (M * M))) by (unfold tsum; cbn [size]; lra). pose proof (bp_pos (-100)).
  assert (LT : bp (low2 tsum) <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; vm_compute; discriminate).
  assert (U0 : 0 < UNDERFLOW) by apply bp_pos.
  assert (G0 : 0 <= reach * (M * M)) by (apply Rmult_le_pos; [lra | apply sq_pos]).
  eapply Rle_trans; [exact P|]. unfold SUM_FACTOR. set (T := size tsum) in *. set (G := reach * (M * M)) in *.
  clearbody G T. rewrite u_val in *. lra.
Qed.
(* What underflows in them is below a part of 10^12 of UNDERFLOW. *)
Theorem UNDERFLOW_holds : forall x1 x2 x3 y1 y2 y3,
  bp (low2 (tvolume x1 x2 x3 y1 y2 y3)) <= / 1000000000000 * UNDERFLOW /\ bp (low2 tsum) <= / 1000000000000 * UNDERFLOW.
Proof. intros. split; apply bp_part12; vm_compute; discriminate. Qed.
End Volumes.
