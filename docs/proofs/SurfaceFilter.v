(* rt-geom, surface/filter.rs: points and normals in plain doubles. *)
From Proofs Require Import Rounding.
From Flocq Require Import Relative Plus_error.
Open Scope R_scope.

(* The error of the rounded point, relative to the way and to the point. *)
Definition WAY_ERROR := 202 / 100 * u.
Definition POINT_ERROR := 102 / 100 * u.
(* The error of the product of two edges, relative to the square of their bound. *)
Definition PRODUCT_ERROR := 61 / 10 * u.
(* Swallows what underflow does to a component. *)
Definition UNDERFLOW := bp (-1000).

Definition norm x y z := Rabs x + Rabs y + Rabs z.

Section Point.
(* origin, direction, the exact parameter; the computed point o + t d of the rounded one *)
Variables o1 o2 o3 d1 d2 d3 exactly : R.
Hypotheses (F1 : F o1) (F2 : F o2) (F3 : F o3).
Let t := RN exactly.
Definition at_t o d := RN (o + RN (t * d)).
Let p1 := at_t o1 d1. Let p2 := at_t o2 d2. Let p3 := at_t o3 d3.
Let q1 := o1 + exactly * d1. Let q2 := o2 + exactly * d2. Let q3 := o3 + exactly * d3.

Lemma component : forall o d, F o ->
  Rabs (at_t o d - (o + exactly * d)) <= u * Rabs (at_t o d) + 2 * u * ((Rabs t + bp (-1022)) * Rabs d) + 2 * bp
    (-1075).
Proof.
  intros o d Fo. unfold at_t. pose proof (RN_back (o + RN (t * d))) as E1. pose proof (RN_err (t * d)) as E2.
  pose proof (RN_back exactly) as E3. fold t in E3. set (m := RN (t * d)) in *. set (p := RN (o + m)) in *.
  rewrite Rabs_mult in E2.
  assert (E4 : Rabs (t * d - exactly * d) <= (u * Rabs t + bp (-1075)) * Rabs d).
  { replace (t * d - exactly * d) with ((t - exactly) * d) by ring. rewrite Rabs_mult.
  apply Rmult_le_compat_r; [apply Rabs_pos | assumption]. }
  assert (H : bp (-1075) = u * bp (-1022)) by (unfold u; rewrite <- bp_add; reflexivity).
  replace (p - (o + exactly * d)) with ((p - (o + m)) + (m - t * d) + (t * d - exactly * d)) by ring.
  eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
  rewrite H in E4 at 1. replace ((u * Rabs t + u * bp (-1022)) * Rabs d) with (u * ((Rabs t + bp (-1022)) * Rabs d))
    in E4 by ring.
  assert (u * (Rabs t * Rabs d) <= u * ((Rabs t + bp (-1022)) * Rabs d)).
  { apply Rmult_le_compat_l; [apply Rlt_le, u_pos|]. apply Rmult_le_compat_r; [apply Rabs_pos|].
  pose proof (bp_pos (-1022)). lra. }
  lra.
Qed.

(* The sum of the errors of the components, so the length as well, is within the bound: of the way (|t| + 2^-1022) |d|
  and
   of the point, through at most 16 roundings. *)
Theorem WAY_ERROR_holds : forall e,
  (1 - 16 * u) * (WAY_ERROR * ((Rabs t + bp (-1022)) * norm d1 d2 d3) + POINT_ERROR * norm p1 p2 p3 + UNDERFLOW) <= e ->
  norm (p1 - q1) (p2 - q2) (p3 - q3) <= (1 - 32 * u) * e.
Proof.
  intros e He. pose proof (component o1 d1 F1) as C1. pose proof (component o2 d2 F2) as C2.
  pose proof (component o3 d3 F3) as C3.
  fold p1 q1 in C1. fold p2 q2 in C2. fold p3 q3 in C3. apply Rle_trans with ((1 - 32 * u) * ((1 - 16 * u) *
    (WAY_ERROR * ((Rabs t + bp (-1022)) * norm d1 d2 d3)
    + POINT_ERROR * norm p1 p2 p3 + UNDERFLOW))); [|apply Rmult_le_compat_l; [rewrite u_val; lra | exact He]].
  unfold norm, WAY_ERROR, POINT_ERROR, UNDERFLOW.
  assert (T : bp (-1075) <= / 1000000000000 * bp (-1000)) by (apply bp_part12; lia). pose proof (bp_pos (-1000)).
  pose proof (Rabs_pos p1). pose proof (Rabs_pos p2). pose proof (Rabs_pos p3). pose proof (bp_pos (-1022)).
  pose proof (Rabs_pos t).
  assert (W : forall d, 0 <= (Rabs t + bp (-1022)) * Rabs d) by (intro; apply Rmult_le_pos; [lra | apply Rabs_pos]).
  pose proof (W d1). pose proof (W d2). pose proof (W d3).
  replace ((Rabs t + bp (-1022)) * (Rabs d1 + Rabs d2 + Rabs d3)) with
    ((Rabs t + bp (-1022)) * Rabs d1 + (Rabs t + bp (-1022)) * Rabs d2 + (Rabs t + bp (-1022)) * Rabs d3) by ring.
  set (A := (Rabs t + bp (-1022)) * Rabs d1) in *. set (B := (Rabs t + bp (-1022)) * Rabs d2) in *.
  set (C := (Rabs t + bp (-1022)) * Rabs d3) in *. clearbody A B C. rewrite u_val in *. lra.
Qed.
(* A sphere's normal: the point less the center c, rounded once more. *)
Theorem POINT_ERROR_holds : forall c1 c2 c3 e f, F c1 -> F c2 -> F c3 ->
  norm (p1 - q1) (p2 - q2) (p3 - q3) <= (1 - 32 * u) * e ->
  (1 - 16 * u) * (e + POINT_ERROR * norm (RN (p1 - c1)) (RN (p2 - c2)) (RN (p3 - c3))) <= f -> UNDERFLOW / 2 <= e ->
  norm (RN (p1 - c1) - (q1 - c1)) (RN (p2 - c2) - (q2 - c2)) (RN (p3 - c3) - (q3 - c3)) <= f.
Proof.
  intros c1 c2 c3 e f G1 G2 G3 He Hf Hu. unfold norm in *.
  assert (S : forall p q c, F p -> F c -> Rabs (RN (p - c) - (q - c)) <= Rabs (p - q) + u * Rabs (RN (p - c))).
  { intros p q c Fp Fc.
    assert (E : Rabs (RN (p - c) - (p - c)) <= u * Rabs (RN (p - c))).
    { pose proof (FLT_plus_error_N_round_ex radix2 (-1074) 53 even p (- c) Fp (F_opp c Fc)) as (x & Hx & Hr).
      change (round radix2 (FLT_exp (-1074) 53) (Znearest even) (p + - c)) with (RN (p - c)) in Hr.
      replace (RN (p - c) - (p - c)) with (- (RN (p - c) * x)) by lra. rewrite Rabs_Ropp, Rabs_mult, Rmult_comm.
      apply Rmult_le_compat_r; [apply Rabs_pos|]. eapply Rle_trans; [apply Hx|]. unfold u_ro, u. simpl. lra.
      } replace (RN (p - c) - (q - c)) with ((RN (p - c) - (p - c)) + (p - q)) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. lra. }
  pose proof (S p1 q1 c1 (RN_F _) G1). pose proof (S p2 q2 c2 (RN_F _) G2). pose proof (S p3 q3 c3 (RN_F _) G3).
  assert (T : bp (-1075) <= / 1000000000000 * bp (-1000)) by (apply bp_part12; lia). pose proof (bp_pos (-1000)).
  pose proof (Rabs_pos (RN (p1 - c1))). pose proof (Rabs_pos (RN (p2 - c2))). pose proof (Rabs_pos (RN (p3 - c3))).
  unfold POINT_ERROR in Hf. unfold UNDERFLOW in Hu. assert (0 < e) by lra. rewrite u_val in *. lra.
Qed.
End Point.

Section Product.
(* the edges e and f, at most 2^301, and the bounds M_i of their components *)
Variables a1 a2 a3 b1 b2 b3 c1 c2 c3 : R.
Let e1 := b1 - a1. Let e2 := b2 - a2. Let e3 := b3 - a3. Let f1 := c1 - a1. Let f2 := c2 - a2. Let f3 := c3 - a3.
Let M1 := Rmax (Rabs e1) (Rabs f1). Let M2 := Rmax (Rabs e2) (Rabs f2). Let M3 := Rmax (Rabs e3) (Rabs f3).
Let E := M1 + M2 + M3.
Hypotheses (He1 : Rabs e1 <= bp 301) (He2 : Rabs e2 <= bp 301) (He3 : Rabs e3 <= bp 301)
  (Hf1 : Rabs f1 <= bp 301) (Hf2 : Rabs f2 <= bp 301) (Hf3 : Rabs f3 <= bp 301).
Definition tn x2 x3 y2 y3 z2 z3 := tminor (D y2 x2 301) (D z3 x3 301) (D y3 x3 301) (D z2 x2 301).
Let t1 := tn a2 a3 b2 b3 c2 c3. Let t2 := tn a3 a1 b3 b1 c3 c1. Let t3 := tn a1 a2 b1 b2 c1 c2.

(* The product as computed is off by at most 6.1 u E^2 and UNDERFLOW, E within a few roundings. *)
Theorem PRODUCT_ERROR_holds : forall n1 n2 n3 bound, plain t1 n1 -> plain t2 n2 -> plain t3 n3 -> bp (-151) <= E ->
  (1 - 16 * u) * (PRODUCT_ERROR * (E * E) + UNDERFLOW) <= bound ->
  norm (n1 - exact t1) (n2 - exact t2) (n3 - exact t3) <= bound.
Proof.
  intros n1 n2 n3 bound H1 H2 H3 L Hb.
  assert (B1 : bounded t1) by (unfold t1, tn, tminor; cbn [bounded]; repeat split; assumption).
  assert (B2 : bounded t2) by (unfold t2, tn, tminor; cbn [bounded]; repeat split; assumption).
  assert (B3 : bounded t3) by (unfold t3, tn, tminor; cbn [bounded]; repeat split; assumption).
  pose proof (plain_error_at t1 n1 4 (low t1) H1 B1 eq_refl eq_refl ltac:(lia)) as P1.
  pose proof (plain_error_at t2 n2 4 (low t2) H2 B2 eq_refl eq_refl ltac:(lia)) as P2.
  pose proof (plain_error_at t3 n3 4 (low t3) H3 B3 eq_refl eq_refl ltac:(lia)) as P3.
  assert (T1 : bp (low t1) <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; vm_compute; discriminate).
  assert (T2 : bp (low t2) <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; vm_compute; discriminate).
  assert (T3 : bp (low t3) <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; vm_compute; discriminate).
  assert (S : size t1 + size t2 + size t3 <= E * E).
  { unfold t1, t2, t3, tn, tminor. cbn [size]. fold e1 e2 e3 f1 f2 f3.
    assert (X1 : 0 <= Rabs e1 <= M1) by (split; [apply Rabs_pos | apply Rmax_l]).
    assert (X2 : 0 <= Rabs e2 <= M2) by (split; [apply Rabs_pos | apply Rmax_l]).
    assert (X3 : 0 <= Rabs e3 <= M3) by (split; [apply Rabs_pos | apply Rmax_l]).
    assert (Y1 : 0 <= Rabs f1 <= M1) by (split; [apply Rabs_pos | apply Rmax_r]).
    assert (Y2 : 0 <= Rabs f2 <= M2) by (split; [apply Rabs_pos | apply Rmax_r]).
    assert (Y3 : 0 <= Rabs f3 <= M3) by (split; [apply Rabs_pos | apply Rmax_r]).
    pose proof (mul2 _ _ _ _ X2 Y3). pose proof (mul2 _ _ _ _ X3 Y2). pose proof (mul2 _ _ _ _ X3 Y1).
    pose proof (mul2 _ _ _ _ X1 Y3).
    pose proof (mul2 _ _ _ _ X1 Y2). pose proof (mul2 _ _ _ _ X2 Y1). unfold E.
    pose proof (sq_pos M1). pose proof (sq_pos M2). pose proof (sq_pos M3). lra. }
  assert (U0 : 0 < UNDERFLOW) by apply bp_pos. unfold norm. unfold PRODUCT_ERROR in Hb.
  assert (E2 : 0 <= E * E) by apply sq_pos. set (G := E * E) in *. clearbody G.
  set (s1 := size t1) in *. set (s2 := size t2) in *. set (s3 := size t3) in *. clearbody s1 s2 s3.
  rewrite u_val in *. lra.
Qed.
(* What underflows in a component is below a part of 10^12 of UNDERFLOW. *)
Theorem UNDERFLOW_holds : bp (low t1) <= / 1000000000000 * UNDERFLOW /\ bp (-1075) <= / 1000000000000 * UNDERFLOW.
Proof. split; apply bp_part12; vm_compute; discriminate. Qed.
End Product.
