(* rt-geom, surface/finish.rs: the step at a triangle, the vector to the hit, and the side of a point. *)
From Proofs Require Import Rounding ErrorFree DoubleDouble Twice Steps.
Open Scope R_scope.

(* The error of N.q, relative to the square of the edges and q; the slope N.d is certain beyond so many of its errors.
  *)
Definition HEIGHT_ERROR := 100 * u * u.
Definition SLOPE_ERROR := 42 / 10 * u.
Definition CERTAIN_SLOPE := 1024.
Definition STEP_FACTOR := 101 / 100.
Definition STEP_ROUNDING := 3 * u.
(* The error of a vector to the hit, relative to itself and the steps. *)
Definition VECTOR_ERROR := 19 * u * u.
(* The error of the height over a tangent plane, relative to the sizes of both vectors. *)
Definition SIDE_ERROR := 31 / 10 * u.
(* Swallows what underflows. *)
Definition UNDERFLOW := bp (-900).

Lemma norm1_product : forall a b c x y z, Rabs a * Rabs x + Rabs b * Rabs y + Rabs c * Rabs z <= norm1 a b c * norm1 x
  y z.
Proof.
  intros. unfold norm1. pose proof (Rabs_pos a). pose proof (Rabs_pos b). pose proof (Rabs_pos c). pose proof
    (Rabs_pos x).
  pose proof (Rabs_pos y). pose proof (Rabs_pos z).
  repeat match goal with H1 : 0 <= Rabs ?v, H2 : 0 <= Rabs ?w |- _ => lazymatch goal with
    | H : 0 <= Rabs v * Rabs w |- _ => fail | _ => pose proof (Rmult_le_pos _ _ H1 H2) end end. lra.
Qed.

(* ---- The side of a point ---- *)
Section Side.
(* the vectors from the center and from the point to the hit, exact and as they are known, within lengths *)
Variables N1 N2 N3 W1 W2 W3 n1 n2 n3 w1 w2 w3 nu om height n w e : R.
Hypotheses (Hn : len (n1 - N1) (n2 - N2) (n3 - N3) <= nu) (Hw : len (w1 - W1) (w2 - W2) (w3 - W3) <= om)
  (Bn1 : Rabs n1 <= bp 410) (Bn2 : Rabs n2 <= bp 410) (Bn3 : Rabs n3 <= bp 410)
  (Bw1 : Rabs w1 <= bp 410) (Bw2 : Rabs w2 <= bp 410) (Bw3 : Rabs w3 <= bp 410).
Definition tside x1 x2 x3 y1 y2 y3 := tdot (X x1 410) (X x2 410) (X x3 410) (X y1 410) (X y2 410) (X y3 410).
Hypotheses (Hh : plain (tside n1 n2 n3 w1 w2 w3) (- height)) (Sn : (1 - 4 * u) * norm1 n1 n2 n3 <= n) (Sw : (1 - 4 *
  u) * norm1 w1 w2 w3 <= w)
  (He : (1 - 16 * u) * (101 / 100 * (nu * w + n * om + nu * om + SIDE_ERROR * (n * w)) + UNDERFLOW) <= e).

(* - w.n is the height of the point over the plane that touches the sphere at the hit. *)
Theorem SIDE_ERROR_holds : let H := - (N1 * W1 + N2 * W2 + N3 * W3) in
  Rabs (height - H) <= e /\ (height > e -> 0 < H) /\ (height < - e -> H < 0).
Proof.
  intro H. assert (G : Rabs (height - H) <= e); [|split; [exact G | now apply certain_sign with (v := height)]].
  assert (B : bounded (tside n1 n2 n3 w1 w2 w3)) by (unfold tside, tdot; cbn [bounded]; repeat split; assumption).
  pose proof (plain_error_at _ _ 3 (low (tside n1 n2 n3 w1 w2 w3)) Hh B eq_refl eq_refl ltac:(lia)) as Q.
  assert (LT : bp (low (tside n1 n2 n3 w1 w2 w3)) <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; vm_compute;
    discriminate).
  set (t0 := bp (low _)) in *. clearbody t0. unfold tside, tdot in Q. cbn [exact size] in Q.
  pose proof (norm1_product n1 n2 n3 w1 w2 w3) as S. set (x := Rabs n1 * Rabs w1 + Rabs n2 * Rabs w2 + Rabs n3 * Rabs
    w3) in *.
  pose proof (dot_off n1 n2 n3 w1 w2 w3 N1 N2 N3 W1 W2 W3) as O.
  pose proof (len_le_norm1 n1 n2 n3) as L1. pose proof (len_le_norm1 w1 w2 w3) as L2.
  pose proof (len_pos n1 n2 n3). pose proof (len_pos w1 w2 w3).
  pose proof (len_pos (n1 - N1) (n2 - N2) (n3 - N3)) as P1. pose proof (len_pos (w1 - W1) (w2 - W2) (w3 - W3)) as P2.
  set (a := norm1 n1 n2 n3) in *. set (b := norm1 w1 w2 w3) in *. assert (nu0 : 0 <= nu) by lra. assert (om0 : 0 <=
    om) by lra.
  assert (O1 : len (n1 - N1) (n2 - N2) (n3 - N3) * len w1 w2 w3 <= nu * b) by (apply Rmult_le_compat; lra).
  assert (O2 : len n1 n2 n3 * len (w1 - W1) (w2 - W2) (w3 - W3) <= a * om) by (apply Rmult_le_compat; lra).
  assert (O3 : len (n1 - N1) (n2 - N2) (n3 - N3) * len (w1 - W1) (w2 - W2) (w3 - W3) <= nu * om) by (apply
    Rmult_le_compat; lra).
  assert (a0 : 0 <= a) by lra. assert (b0 : 0 <= b) by lra.
  assert (C1 : nu * ((1 - 4 * u) * b) <= nu * w) by (apply Rmult_le_compat_l; assumption).
  assert (C2 : (1 - 4 * u) * a * om <= n * om) by (apply Rmult_le_compat_r; assumption).
  assert (C3 : (1 - 4 * u) * a * ((1 - 4 * u) * b) <= n * w).
  { apply Rmult_le_compat; try assumption; apply Rmult_le_pos; try assumption; rewrite u_val; lra. }
  replace (height - H) with (- (- height - (n1 * w1 + n2 * w2 + n3 * w3)) - ((n1 * w1 + n2 * w2 + n3 * w3) - (N1 * W1
    + N2 * W2 + N3 * W3)))
    by (unfold H; ring).
  eapply Rle_trans; [apply Rabs_minus_le; [rewrite Rabs_Ropp; exact Q | exact O]|]. eapply Rle_trans; [|exact He].
  assert (U0 : 0 < UNDERFLOW) by apply bp_pos. assert (0 <= a * b) by (apply Rmult_le_pos; assumption).
  assert (0 <= nu * b) by (apply Rmult_le_pos; assumption). assert (0 <= a * om) by (apply Rmult_le_pos; assumption).
  assert (0 <= nu * om) by (apply Rmult_le_pos; assumption). unfold SIDE_ERROR.
  replace (nu * ((1 - 4 * u) * b)) with ((1 - 4 * u) * (nu * b)) in C1 by ring.
  replace ((1 - 4 * u) * a * om) with ((1 - 4 * u) * (a * om)) in C2 by ring.
  replace ((1 - 4 * u) * a * ((1 - 4 * u) * b)) with ((1 - 4 * u) * (1 - 4 * u) * (a * b)) in C3 by ring.
  set (x1 := a * b) in *. set (x2 := nu * b) in *. set (x3 := a * om) in *. set (x4 := nu * om) in *. set (x5 := nu *
    w) in *. set (x6 := n * om) in *.
  set (x7 := n * w) in *. clear - S O1 O2 O3 C1 C2 C3 LT U0 H2 H3 H4 H5. rewrite u_val in *. lra.
Qed.
End Side.

(* ---- The vector to the hit ---- *)
Section Vector.
(* a component: the exact difference v, then three sums in double-double, with t, s1 and s2 times d *)
Lemma vector_component : forall v t s1 s2 d r1 r2 r3 h l err eps, let T := bp (-1060) in
  Rabs (r1 - (v + t * d)) <= 6 * (u * u) * Rabs (v + t * d) + T -> Rabs (r2 - (r1 + s1 * d)) <= 6 * (u * u) * Rabs (r1
    + s1 * d) + T ->
  Rabs (r3 - (r2 + s2 * d)) <= 6 * (u * u) * Rabs (r2 + s2 * d) + T -> dd h l -> r3 = h + l -> Rabs eps <= err ->
  Rabs (h - (v + (t + s1 + s2 + eps) * d)) <= u * Rabs h + (18 + / 10) * (u * u) * (Rabs h + (Rabs s1 + Rabs s2) *
    Rabs d) + err * Rabs d + 4 * T.
Proof.
  intros v t s1 s2 d r1 r2 r3 h l err eps T H1 H2 H3 Hd E He. assert (T0 : 0 < T) by apply bp_pos. pose proof (dd_low
    _ _ Hd) as LL.
  set (y1 := v + t * d) in *. set (y2 := y1 + s1 * d). set (y3 := y2 + s2 * d). pose proof (Rabs_pos d). pose proof
    (Rabs_pos h).
  set (a1 := Rabs s1 * Rabs d). set (a2 := Rabs s2 * Rabs d). assert (A1 : 0 <= a1) by (apply Rmult_le_pos; apply
    Rabs_pos).
  assert (A2 : 0 <= a2) by (apply Rmult_le_pos; apply Rabs_pos). pose proof (Rabs_pos y1). pose proof (Rabs_pos y2).
    pose proof (Rabs_pos y3).
  assert (Y2 : Rabs y2 <= Rabs y3 + a2).
  { replace y2 with (y3 - s2 * d) by (unfold y3; ring). eapply Rle_trans; [apply Rabs_minus_le; [apply Rle_refl |
    rewrite Rabs_mult; apply Rle_refl]|]. unfold a2. lra. }
  assert (Y1 : Rabs y1 <= Rabs y2 + a1).
  { replace y1 with (y2 - s1 * d) by (unfold y2; ring). eapply Rle_trans; [apply Rabs_minus_le; [apply Rle_refl |
    rewrite Rabs_mult; apply Rle_refl]|]. unfold a1. lra. }
  assert (G2 : Rabs (r1 + s1 * d) <= Rabs y2 + Rabs (r1 - y1)).
  { replace (r1 + s1 * d) with (y2 + (r1 - y1)) by (unfold y2; ring). apply Rabs_triang. }
  assert (E2 : Rabs (r2 - y2) <= 6 * (u * u) * (Rabs y2 + Rabs (r1 - y1)) + T + Rabs (r1 - y1)).
  { replace (r2 - y2) with ((r2 - (r1 + s1 * d)) + (r1 - y1)) by (unfold y2; ring). eapply Rle_trans; [apply
    Rabs_triang|].
    assert (6 * (u * u) * Rabs (r1 + s1 * d) <= 6 * (u * u) * (Rabs y2 + Rabs (r1 - y1))) by (apply Rmult_le_compat_l;
      [rewrite u_val; lra | exact G2]). lra. }
  assert (G3 : Rabs (r2 + s2 * d) <= Rabs y3 + Rabs (r2 - y2)).
  { replace (r2 + s2 * d) with (y3 + (r2 - y2)) by (unfold y3; ring). apply Rabs_triang. }
  assert (E3 : Rabs (r3 - y3) <= 6 * (u * u) * (Rabs y3 + Rabs (r2 - y2)) + T + Rabs (r2 - y2)).
  { replace (r3 - y3) with ((r3 - (r2 + s2 * d)) + (r2 - y2)) by (unfold y3; ring). eapply Rle_trans; [apply
    Rabs_triang|].
    assert (6 * (u * u) * Rabs (r2 + s2 * d) <= 6 * (u * u) * (Rabs y3 + Rabs (r2 - y2))) by (apply Rmult_le_compat_l;
      [rewrite u_val; lra | exact G3]). lra. }
  assert (V : Rabs y3 <= Rabs h + Rabs l + Rabs (r3 - y3)).
  { pose proof (Rabs_minus_le (h + l) (r3 - y3) _ _ (Rabs_triang h l) (Rle_refl _)) as X. replace (h + l - (r3 - y3))
    with y3 in X by (rewrite E; ring). exact X. }
  replace (h - (v + (t + s1 + s2 + eps) * d)) with ((r3 - y3) - l - eps * d) by (rewrite E; unfold y3, y2, y1; ring).
  assert (EP : Rabs (eps * d) <= err * Rabs d) by (rewrite Rabs_mult; apply Rmult_le_compat_r; assumption).
  eapply Rle_trans; [apply Rabs_minus_le; [apply Rabs_minus_le; [apply Rle_refl | exact LL] | exact EP]|].
  replace ((Rabs s1 + Rabs s2) * Rabs d) with (a1 + a2) by (unfold a1, a2; ring).
  set (e1 := Rabs (r1 - y1)) in *. set (e2 := Rabs (r2 - y2)) in *. set (e3 := Rabs (r3 - y3)) in *. set (z1 := Rabs
    y1) in *. set (z2 := Rabs y2) in *.
  set (z3 := Rabs y3) in *. set (hh := Rabs h) in *. set (ll := Rabs l) in *. set (ep := err * Rabs d) in *.
  clear - H1 E2 E3 V Y1 Y2 LL A1 A2 H0 T0 H4 H5 H6. rewrite u_val in *. lra.
Qed.
(* The bound of the vector, a length at most the sum over its components, through at most 16 roundings. *)
Theorem VECTOR_ERROR_holds : forall h1 h2 h3 V1 V2 V3 s1 s2 d1 d2 d3 err size way e, let T := bp (-1060) in
  let part h d := u * Rabs h + (18 + / 10) * (u * u) * (Rabs h + (Rabs s1 + Rabs s2) * Rabs d) + err * Rabs d + 4 * T in
  Rabs (h1 - V1) <= part h1 d1 -> Rabs (h2 - V2) <= part h2 d2 -> Rabs (h3 - V3) <= part h3 d3 -> 0 <= err ->
  (1 - 4 * u) * norm1 h1 h2 h3 <= size -> (1 - 8 * u) * ((Rabs s1 + Rabs s2) * norm1 d1 d2 d3) <= way ->
  (1 - 16 * u) * (101 / 100 * u * size + VECTOR_ERROR * (size + way) + 101 / 100 * (err * norm1 d1 d2 d3) + UNDERFLOW)
    <= e ->
  len (h1 - V1) (h2 - V2) (h3 - V3) <= e.
Proof.
  intros h1 h2 h3 V1 V2 V3 s1 s2 d1 d2 d3 err size way e T part H1 H2 H3 E0 Hs Hw He.
  eapply Rle_trans; [apply len_le_norm1|]. unfold norm1 in *. unfold part in *. clear part.
  assert (T1 : T <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; lia). assert (U0 : 0 < UNDERFLOW) by apply bp_pos.
  pose proof (Rabs_pos h1). pose proof (Rabs_pos h2). pose proof (Rabs_pos h3). set (ss := Rabs s1 + Rabs s2) in *.
  assert (S0 : 0 <= ss) by (unfold ss; pose proof (Rabs_pos s1); pose proof (Rabs_pos s2); lra).
  assert (0 <= ss * Rabs d1) by (apply Rmult_le_pos; [assumption | apply Rabs_pos]). assert (0 <= ss * Rabs d2) by
    (apply Rmult_le_pos; [assumption | apply Rabs_pos]).
  assert (0 <= ss * Rabs d3) by (apply Rmult_le_pos; [assumption | apply Rabs_pos]). assert (0 <= err * Rabs d1) by
    (apply Rmult_le_pos; [assumption | apply Rabs_pos]).
  assert (0 <= err * Rabs d2) by (apply Rmult_le_pos; [assumption | apply Rabs_pos]). assert (0 <= err * Rabs d3) by
    (apply Rmult_le_pos; [assumption | apply Rabs_pos]).
  replace (ss * (Rabs d1 + Rabs d2 + Rabs d3)) with (ss * Rabs d1 + ss * Rabs d2 + ss * Rabs d3) in Hw by ring.
  replace (err * (Rabs d1 + Rabs d2 + Rabs d3)) with (err * Rabs d1 + err * Rabs d2 + err * Rabs d3) in He by ring.
  unfold VECTOR_ERROR in He. set (x1 := ss * Rabs d1) in *. set (x2 := ss * Rabs d2) in *. set (x3 := ss * Rabs d3) in
    *.
  set (y1 := err * Rabs d1) in *. set (y2 := err * Rabs d2) in *. set (y3 := err * Rabs d3) in *. rewrite u_val in *.
    lra.
Qed.
End Vector.

(* ---- The step at a triangle ---- *)
Section Triangle.
(* vertices a, b, c, the origin and the direction; the edges' product N, exact and as computed nh + nl; q = a - o - t
  d *)
Variables a1 a2 a3 b1 b2 b3 c1 c2 c3 Q1 Q2 Q3 q1 q2 q3 d1 d2 d3 E : R.
Let T := bp (-1060).
Definition tn x2 x3 y2 y3 z2 z3 := tminor (D y2 x2 301) (D z3 x3 301) (D y3 x3 301) (D z2 x2 301).
Let t1 := tn a2 a3 b2 b3 c2 c3. Let t2 := tn a3 a1 b3 b1 c3 c1. Let t3 := tn a1 a2 b1 b2 c1 c2.
Let N1 := exact t1. Let N2 := exact t2. Let N3 := exact t3.
Variables h1 h2 h3 l1 l2 l3 : R.
Let n1 := h1 + l1. Let n2 := h2 + l2. Let n3 := h3 + l3.
Hypotheses (B1 : bounded t1) (B2 : bounded t2) (B3 : bounded t3) (S1 : size t1 <= E * E) (S2 : size t2 <= E * E) (S3 :
  size t3 <= E * E)
  (LE : bp (-151) <= E <= bp 302)
  (Dd1 : dd h1 l1) (Dd2 : dd h2 l2) (Dd3 : dd h3 l3) (Hn1 : twice t1 n1) (Hn2 : twice t2 n2) (Hn3 : twice t3 n3)
  (Hq1 : Rabs (q1 - Q1) <= 6 * (u * u) * Rabs Q1 + T) (Hq2 : Rabs (q2 - Q2) <= 6 * (u * u) * Rabs Q2 + T)
  (Hq3 : Rabs (q3 - Q3) <= 6 * (u * u) * Rabs Q3 + T) (Bq1 : Rabs q1 <= bp 403) (Bq2 : Rabs q2 <= bp 403) (Bq3 : Rabs
    q3 <= bp 403)
  (Bd1 : Rabs d1 <= bp 100) (Bd2 : Rabs d2 <= bp 100) (Bd3 : Rabs d3 <= bp 100).

Lemma normal_component : forall t n, twice t n -> bounded t -> size t <= E * E -> Z.of_nat (count2 t) = 15%Z -> (low2
  t <= -760)%Z ->
  (top t <= 605)%Z -> Rabs (n - exact t) <= (15 + / 500) * (u * u) * (E * E) /\ Rabs (exact t) <= E * E /\ Rabs n <=
    bp 606.
Proof.
  intros t n H B S C Lo To. pose proof (twice_error_at t n 15 (low2 t) H B C eq_refl ltac:(lia)) as P. destruct
    (top_ok t B) as [X Y].
  pose proof (bp_le _ _ Lo) as L1. pose proof (bp_le _ _ To) as L2. pose proof (bp_pos (-151)) as P0.
  assert (EE : bp (-302) <= E * E) by (change (-302)%Z with (-151 + -151)%Z; rewrite bp_add; apply Rmult_le_compat;
    lra).
  assert (L3 : bp (-760) <= / 1000 * (u * u) * bp (-302)).
  { apply Rle_trans with (bp (-10) * (u * u) * bp (-302)); [unfold u; rewrite <- !bp_add; apply bp_le; lia|].
    apply Rmult_le_compat_r; [apply Rlt_le, bp_pos|]. apply Rmult_le_compat_r; [apply sq_pos | simpl; lra]. }
  assert (K : Rabs (n - exact t) <= (15 + / 500) * (u * u) * (E * E)) by (pose proof (bp_pos (-302)); rewrite u_val in
    *; lra).
  split; [exact K|]. split; [lra|].
  assert (P2 : Rabs (n - exact t) <= bp 605) by (pose proof (bp_pos 605); assert (bp (-760) <= / 1000000000000 * bp
    605) by (apply bp_part12; lia);
    pose proof (Rabs_pos (exact t)); rewrite u_val in *; lra).
  replace n with ((n - exact t) + exact t) by ring. eapply Rle_trans; [apply Rabs_triang|].
  assert (bp 606 = 2 * bp 605) by (change 606%Z with (1 + 605)%Z; rewrite bp_add, bp_1; ring). lra.
Qed.
Lemma normals : (Rabs (n1 - N1) <= (15 + / 500) * (u * u) * (E * E) /\ Rabs N1 <= E * E /\ Rabs n1 <= bp 606) /\
  (Rabs (n2 - N2) <= (15 + / 500) * (u * u) * (E * E) /\ Rabs N2 <= E * E /\ Rabs n2 <= bp 606) /\
  (Rabs (n3 - N3) <= (15 + / 500) * (u * u) * (E * E) /\ Rabs N3 <= E * E /\ Rabs n3 <= bp 606).
Proof.
  repeat split; eapply normal_component; eauto; vm_compute; try reflexivity; discriminate.
Qed.
(* the height in double-double *)
Definition theight x1 x2 x3 y1 y2 y3 := tdot (X x1 606) (X x2 606) (X x3 606) (X y1 403) (X y2 403) (X y3 403).
Variables height hh hl qs : R.
Hypotheses (Hh : twice (theight n1 n2 n3 q1 q2 q3) height) (Dh : dd hh hl) (Eh : height = hh + hl)
  (Hqs : (1 - 8 * u) * norm1 q1 q2 q3 <= qs).
Let H := N1 * Q1 + N2 * Q2 + N3 * Q3.
Lemma height_error : Rabs (height - H) <= (42 + / 10) * (u * u) * (E * E) * norm1 q1 q2 q3 + 2 * T * norm1 N1 N2 N3 +
  / 1000 * UNDERFLOW.
Proof.
  pose proof normals as ((M1 & K1 & G1) & (M2 & K2 & G2) & (M3 & K3 & G3)).
  assert (B : bounded (theight n1 n2 n3 q1 q2 q3)) by (unfold theight, tdot; cbn [bounded]; repeat split; assumption).
  pose proof (twice_error_at _ _ 21 (low2 (theight n1 n2 n3 q1 q2 q3)) Hh B eq_refl eq_refl ltac:(lia)) as P.
  assert (LT : bp (low2 (theight n1 n2 n3 q1 q2 q3)) <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; vm_compute;
    discriminate).
  set (t0 := bp (low2 _)) in *. clearbody t0. unfold theight, tdot in P. cbn [exact size] in P.
  assert (T0 : 0 < T) by apply bp_pos. assert (U0 : 0 < UNDERFLOW) by apply bp_pos. assert (EE : 0 <= E * E) by apply
    sq_pos.
  assert (C : forall n N q Q, Rabs (n - N) <= (15 + / 500) * (u * u) * (E * E) -> Rabs N <= E * E -> Rabs (q - Q) <= 6
    * (u * u) * Rabs Q + T ->
    Rabs (n * q - N * Q) <= (21 + / 50) * (u * u) * (E * E * Rabs q) + (1 + / 1000) * (T * Rabs N) /\
    Rabs n * Rabs q <= (1 + / 1000000) * (E * E * Rabs q)).
  { intros n N q Q Hn HN Hq. pose proof (Rabs_pos q). pose proof (Rabs_pos N). pose proof (Rabs_pos Q).
    pose proof (Rabs_triang_inv Q q) as I. rewrite (Rabs_minus_sym Q) in I.
    assert (Hq' : Rabs (q - Q) <= (6 + / 1000) * (u * u) * Rabs q + (1 + / 1000) * T) by (rewrite u_val in *; lra).
      split.
    - replace (n * q - N * Q) with ((n - N) * q + N * (q - Q)) by ring.
      eapply Rle_trans; [apply Rabs_plus_le; [apply Rabs_mult_le; [exact Hn | apply Rle_refl] | rewrite Rabs_mult;
        apply Rmult_le_compat_l; [apply Rabs_pos | exact Hq']]|].
      assert (Rabs N * Rabs q <= E * E * Rabs q) by (apply Rmult_le_compat_r; assumption).
      replace (Rabs N * ((6 + / 1000) * (u * u) * Rabs q + (1 + / 1000) * T)) with ((6 + / 1000) * (u * u) * (Rabs N *
        Rabs q) + (1 + / 1000) * (T * Rabs N)) by ring.
      set (x := Rabs N * Rabs q) in *. replace ((15 + / 500) * (u * u) * (E * E) * Rabs q) with ((15 + / 500) * (u *
        u) * (E * E * Rabs q)) by ring.
      set (y := E * E * Rabs q) in *. assert (0 <= y) by (apply Rmult_le_pos; assumption). rewrite u_val in *. lra.
    - pose proof (Rabs_triang_inv n N). assert (Rabs n <= (1 + / 1000000) * (E * E)) by (rewrite u_val in *; lra).
      assert (Rabs n * Rabs q <= (1 + / 1000000) * (E * E) * Rabs q) by (apply Rmult_le_compat_r; assumption). lra. }
  destruct (C n1 N1 q1 Q1 M1 K1 Hq1) as [C1 D1]. destruct (C n2 N2 q2 Q2 M2 K2 Hq2) as [C2 D2]. destruct (C n3 N3 q3
    Q3 M3 K3 Hq3) as [C3 D3]. clear C.
  replace (height - H) with ((height - (n1 * q1 + n2 * q2 + n3 * q3)) + ((n1 * q1 - N1 * Q1) + (n2 * q2 - N2 * Q2) +
    (n3 * q3 - N3 * Q3))) by (unfold H; ring).
  eapply Rle_trans; [apply Rabs_plus_le; [exact P | apply Rabs_plus_le; [apply Rabs_plus_le; [exact C1 | exact C2] |
    exact C3]]|]. unfold norm1.
  replace ((42 + / 10) * (u * u) * (E * E) * (Rabs q1 + Rabs q2 + Rabs q3)) with
    ((42 + / 10) * (u * u) * (E * E * Rabs q1 + E * E * Rabs q2 + E * E * Rabs q3)) by ring.
  replace (2 * T * (Rabs N1 + Rabs N2 + Rabs N3)) with (2 * (T * Rabs N1 + T * Rabs N2 + T * Rabs N3)) by ring.
  assert (0 <= T * Rabs N1) by (apply Rmult_le_pos; [lra | apply Rabs_pos]). assert (0 <= T * Rabs N2) by (apply
    Rmult_le_pos; [lra | apply Rabs_pos]).
  assert (0 <= T * Rabs N3) by (apply Rmult_le_pos; [lra | apply Rabs_pos]).
  assert (0 <= E * E * Rabs q1) by (apply Rmult_le_pos; [assumption | apply Rabs_pos]). assert (0 <= E * E * Rabs q2)
    by (apply Rmult_le_pos; [assumption | apply Rabs_pos]).
  assert (0 <= E * E * Rabs q3) by (apply Rmult_le_pos; [assumption | apply Rabs_pos]).
  set (x1 := E * E * Rabs q1) in *. set (x2 := E * E * Rabs q2) in *. set (x3 := E * E * Rabs q3) in *. set (y1 := T *
    Rabs N1) in *.
  set (y2 := T * Rabs N2) in *. set (y3 := T * Rabs N3) in *. set (z1 := Rabs n1 * Rabs q1) in *. set (z2 := Rabs n2 *
    Rabs q2) in *. set (z3 := Rabs n3 * Rabs q3) in *.
  clear - LT U0 D1 D2 D3 H0 H1 H2 H3 H4 H5. rewrite u_val in *. lra.
Qed.
(* the slope in doubles *)
Definition tslope x1 x2 x3 y1 y2 y3 := tdot (X x1 607) (X x2 607) (X x3 607) (X y1 100) (X y2 100) (X y3 100).
Variables slope ns ds : R.
Hypotheses (Hs : plain (tslope h1 h2 h3 d1 d2 d3) slope) (Hns : (1 - 4 * u) * norm1 h1 h2 h3 <= ns) (Hds : (1 - 4 * u)
  * norm1 d1 d2 d3 <= ds)
  (Ld : bp (-100) <= norm1 d1 d2 d3).
Let G := N1 * d1 + N2 * d2 + N3 * d3.
Variables he se : R.
Hypotheses (Hhe : (1 - 8 * u) * (HEIGHT_ERROR * (E * E * qs) + UNDERFLOW) <= he)
  (Hse : (1 - 16 * u) * ((SLOPE_ERROR * ns + HEIGHT_ERROR * (E * E)) * ds + UNDERFLOW) <= se).
Theorem SLOPE_ERROR_holds : Rabs (slope - G) <= se.
Proof.
  pose proof normals as ((M1 & K1 & G1) & (M2 & K2 & G2) & (M3 & K3 & G3)).
  assert (HB : forall h l, dd h l -> Rabs (h + l) <= bp 606 -> Rabs h <= bp 607 /\ Rabs (h - (h + l)) <= u * Rabs h).
  { intros h l Hd Hb. destruct (dd_value _ _ Hd) as [V _]. pose proof (dd_low _ _ Hd). pose proof (Rabs_pos h).
    assert (bp 607 = 2 * bp 606) by (change 607%Z with (1 + 606)%Z; rewrite bp_add, bp_1; ring). split; [rewrite u_val
      in *; lra|].
    replace (h - (h + l)) with (- l) by ring. now rewrite Rabs_Ropp. }
  destruct (HB _ _ Dd1 G1) as [X1 Y1]. destruct (HB _ _ Dd2 G2) as [X2 Y2]. destruct (HB _ _ Dd3 G3) as [X3 Y3].
  assert (B : bounded (tslope h1 h2 h3 d1 d2 d3)) by (unfold tslope, tdot; cbn [bounded]; repeat split; assumption).
  pose proof (plain_error_at _ _ 3 (low (tslope h1 h2 h3 d1 d2 d3)) Hs B eq_refl eq_refl ltac:(lia)) as P.
  assert (LT : bp (low (tslope h1 h2 h3 d1 d2 d3)) <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; vm_compute;
    discriminate).
  set (t0 := bp (low _)) in *. clearbody t0. unfold tslope, tdot in P. cbn [exact size] in P.
  assert (U0 : 0 < UNDERFLOW) by apply bp_pos. assert (EE : 0 <= E * E) by apply sq_pos. pose proof u_pos.
  assert (C : forall h n N d, Rabs (h - n) <= u * Rabs h -> Rabs (n - N) <= (15 + / 500) * (u * u) * (E * E) ->
    Rabs (h * d - N * d) <= u * (Rabs h * Rabs d) + (15 + / 500) * (u * u) * (E * E * Rabs d)).
  { intros h n N d Hh' Hn. replace (h * d - N * d) with ((h - n) * d + (n - N) * d) by ring.
    eapply Rle_trans; [apply Rabs_plus_le; rewrite Rabs_mult; apply Rmult_le_compat_r; try apply Rabs_pos;
      eassumption|]. lra. }
  pose proof (C h1 n1 N1 d1 Y1 M1) as C1. pose proof (C h2 n2 N2 d2 Y2 M2) as C2. pose proof (C h3 n3 N3 d3 Y3 M3) as
    C3.
  replace (slope - G) with ((slope - (h1 * d1 + h2 * d2 + h3 * d3)) + ((h1 * d1 - N1 * d1) + (h2 * d2 - N2 * d2) + (h3
    * d3 - N3 * d3))) by (unfold G; ring).
  eapply Rle_trans; [apply Rabs_plus_le; [exact P | apply Rabs_plus_le; [apply Rabs_plus_le; [exact C1 | exact C2] |
    exact C3]]|]. eapply Rle_trans; [|exact Hse].
  pose proof (norm1_product h1 h2 h3 d1 d2 d3) as S. pose proof (norm1_pos h1 h2 h3). pose proof (norm1_pos d1 d2 d3).
  assert (Z1 : (1 - 4 * u) * norm1 h1 h2 h3 * ((1 - 4 * u) * norm1 d1 d2 d3) <= ns * ds).
  { apply Rmult_le_compat; try assumption; apply Rmult_le_pos; try assumption; rewrite u_val; lra. }
  assert (Z2 : E * E * ((1 - 4 * u) * norm1 d1 d2 d3) <= E * E * ds) by (apply Rmult_le_compat_l; assumption).
  assert (Z3 : E * E * norm1 d1 d2 d3 = E * E * Rabs d1 + E * E * Rabs d2 + E * E * Rabs d3) by (unfold norm1; ring).
  assert (0 <= norm1 h1 h2 h3 * norm1 d1 d2 d3) by (apply Rmult_le_pos; assumption). assert (0 <= E * E * norm1 d1 d2
    d3) by (apply Rmult_le_pos; assumption).
  replace ((1 - 4 * u) * norm1 h1 h2 h3 * ((1 - 4 * u) * norm1 d1 d2 d3)) with ((1 - 4 * u) * (1 - 4 * u) * (norm1 h1
    h2 h3 * norm1 d1 d2 d3)) in Z1 by ring.
  replace (E * E * ((1 - 4 * u) * norm1 d1 d2 d3)) with ((1 - 4 * u) * (E * E * norm1 d1 d2 d3)) in Z2 by ring.
  replace ((SLOPE_ERROR * ns + HEIGHT_ERROR * (E * E)) * ds) with (SLOPE_ERROR * (ns * ds) + HEIGHT_ERROR * (E * E *
    ds)) by ring. unfold SLOPE_ERROR, HEIGHT_ERROR.
  set (x := norm1 h1 h2 h3 * norm1 d1 d2 d3) in *. set (y := E * E * norm1 d1 d2 d3) in *. set (z := ns * ds) in *.
    set (w := E * E * ds) in *.
  set (v1 := E * E * Rabs d1) in *. set (v2 := E * E * Rabs d2) in *. set (v3 := E * E * Rabs d3) in *.
  set (w1 := Rabs h1 * Rabs d1) in *. set (w2 := Rabs h2 * Rabs d2) in *. set (w3 := Rabs h3 * Rabs d3) in *.
  clear - S Z1 Z2 Z3 LT U0 H0 H3 H4. rewrite u_val in *. lra.
Qed.
(* the step itself *)
Hypothesis Hcertain : CERTAIN_SLOPE * se < Rabs slope.
Let step := RN (hh / slope).
Theorem STEP_FACTOR_holds : forall e, (1 - 16 * u) * (STEP_FACTOR * ((he + Rabs step * se) / Rabs slope) +
  STEP_ROUNDING * Rabs step + UNDERFLOW) <= e ->
  G <> 0 /\ Rabs (step - H / G) <= e.
Proof.
  intros e He. pose proof height_error as HE. pose proof SLOPE_ERROR_holds as SE. pose proof u_pos. assert (U0 : 0 <
    UNDERFLOW) by apply bp_pos.
  assert (T0 : 0 < T) by apply bp_pos. assert (EE : 0 <= E * E) by apply sq_pos. pose proof (norm1_pos h1 h2 h3). pose
    proof (norm1_pos d1 d2 d3).
  pose proof (norm1_pos q1 q2 q3). unfold CERTAIN_SLOPE in Hcertain. set (sl := Rabs slope) in *.
  assert (0 <= ns) by (rewrite u_val in *; lra). assert (0 <= ds) by (rewrite u_val in *; lra). assert (NS1 : 0 <= ns
    * ds) by (apply Rmult_le_pos; assumption).
  assert (NS2 : 0 <= E * E * ds) by (apply Rmult_le_pos; assumption).
  assert (SB : 4 * u * (ns * ds) + 99 * (u * u) * (E * E * ds) + / 2 * UNDERFLOW <= se).
  { replace ((SLOPE_ERROR * ns + HEIGHT_ERROR * (E * E)) * ds) with (SLOPE_ERROR * (ns * ds) + HEIGHT_ERROR * (E * E *
    ds)) in Hse by ring.
    unfold SLOPE_ERROR, HEIGHT_ERROR in Hse. set (x := ns * ds) in *. set (y := E * E * ds) in *. clear - Hse NS1 NS2
      U0. rewrite u_val in *. lra. }
  assert (se0 : 0 < se) by (assert (0 <= 99 * (u * u) * (E * E * ds)) by (apply Rmult_le_pos; [rewrite u_val; lra |
    assumption]);
    assert (0 <= 4 * u * (ns * ds)) by (apply Rmult_le_pos; [rewrite u_val; lra | assumption]); lra).
  assert (sl0 : 0 < sl) by lra. assert (S0 : slope <> 0) by (intro Z; unfold sl in sl0; rewrite Z, Rabs_R0 in sl0; lra).
  assert (GL : 1023 / 1024 * sl <= Rabs G).
  { pose proof (Rabs_triang_inv slope (slope - G)) as K. replace (slope - (slope - G)) with G in K by ring. fold sl in
    K. lra. }
  assert (G0 : G <> 0) by (intro Z; rewrite Z, Rabs_R0 in GL; lra). split; [exact G0|].
  (* the underflow of q, over the slope *)
  pose proof normals as ((M1 & K1 & _) & (M2 & K2 & _) & (M3 & K3 & _)).
  assert (NN : norm1 N1 N2 N3 <= (1 + 8 * u) * ns + 46 * (u * u) * (E * E)).
  { assert (Cn : forall h l N, dd h l -> Rabs (h + l - N) <= (15 + / 500) * (u * u) * (E * E) -> Rabs N <= (1 + u) *
    Rabs h + (15 + / 500) * (u * u) * (E * E)).
    { intros h l N Hd HN. destruct (dd_value _ _ Hd) as [_ V]. replace N with ((h + l) - (h + l - N)) by ring. apply
      Rabs_minus_le; assumption. }
    pose proof (Cn _ _ _ Dd1 M1). pose proof (Cn _ _ _ Dd2 M2). pose proof (Cn _ _ _ Dd3 M3). unfold norm1 in *.
      rewrite u_val in *. lra. }
  assert (TN : 2 * T * norm1 N1 N2 N3 <= / 1000 * (UNDERFLOW * sl)).
  { assert (D1 : bp (-101) <= ds) by (assert (bp (-100) = 2 * bp (-101)) by (change (-100)%Z with (1 + -101)%Z;
    rewrite bp_add, bp_1; ring); pose proof (bp_pos (-101)); rewrite u_val in *; lra).
    assert (X1 : bp (-101) * (4 * u * ns + 99 * (u * u) * (E * E)) <= se).
    { apply Rle_trans with (ds * (4 * u * ns + 99 * (u * u) * (E * E))).
      - apply Rmult_le_compat_r; [|assumption]. apply Rplus_le_le_0_compat; apply Rmult_le_pos; rewrite ?u_val; lra.
      - lra. }
    assert (X2 : u * (E * E) * u >= 0) by (apply Rle_ge; apply Rmult_le_pos; [apply Rmult_le_pos|]; lra).
    assert (X3 : norm1 N1 N2 N3 * u <= 4 * u * ns + 99 * (u * u) * (E * E)).
    { replace (norm1 N1 N2 N3 * u) with (u * norm1 N1 N2 N3) by ring. apply Rle_trans with (u * ((1 + 8 * u) * ns + 46
      * (u * u) * (E * E))); [apply Rmult_le_compat_l; lra|].
      rewrite u_val in *. lra. }
    assert (X4 : 1024 * (bp (-101) * (norm1 N1 N2 N3 * u)) <= sl).
    { apply Rle_trans with (1024 * (bp (-101) * (4 * u * ns + 99 * (u * u) * (E * E)))); [|lra].
      apply Rmult_le_compat_l; [lra|]. apply Rmult_le_compat_l; [apply Rlt_le, bp_pos | assumption]. }
    assert (X5 : 2 * T <= / 1000 * UNDERFLOW * (1024 * (bp (-101) * u))).
    { apply Rle_trans with (bp (-10) * UNDERFLOW * (bp 10 * (bp (-101) * u))).
      - unfold T, UNDERFLOW, u. rewrite <- bp_1, <- !bp_add. apply bp_le. lia.
      - replace (bp 10) with 1024 by (simpl; lra). apply Rmult_le_compat_r; [apply Rmult_le_pos; [lra | apply
        Rmult_le_pos; [apply Rlt_le, bp_pos | lra]]|].
        apply Rmult_le_compat_r; [lra | simpl; lra]. }
    pose proof (norm1_pos N1 N2 N3) as NP.
    apply Rle_trans with (/ 1000 * UNDERFLOW * (1024 * (bp (-101) * u)) * norm1 N1 N2 N3); [apply Rmult_le_compat_r;
      assumption|].
    replace (/ 1000 * UNDERFLOW * (1024 * (bp (-101) * u)) * norm1 N1 N2 N3) with (/ 1000 * UNDERFLOW * (1024 * (bp
      (-101) * (norm1 N1 N2 N3 * u)))) by ring.
    replace (/ 1000 * (UNDERFLOW * sl)) with (/ 1000 * UNDERFLOW * sl) by ring. apply Rmult_le_compat_l; lra. }
  (* the quotient *)
  assert (HB : (42 + / 10) * (u * u) * (E * E) * norm1 q1 q2 q3 + / 1000 * UNDERFLOW <= he).
  { assert (HA : E * E * ((1 - 8 * u) * norm1 q1 q2 q3) <= E * E * qs) by (apply Rmult_le_compat_l; assumption).
    unfold HEIGHT_ERROR in Hhe.
    assert (HC : 0 <= E * E * norm1 q1 q2 q3) by (apply Rmult_le_pos; assumption).
    replace (E * E * ((1 - 8 * u) * norm1 q1 q2 q3)) with ((1 - 8 * u) * (E * E * norm1 q1 q2 q3)) in HA by ring.
    set (x := E * E * qs) in *. set (y := E * E * norm1 q1 q2 q3) in *.
    replace ((42 + / 10) * (u * u) * (E * E) * norm1 q1 q2 q3) with ((42 + / 10) * (u * u) * y) by (unfold y; ring).
    clear - Hhe HA HC U0. rewrite u_val in *. lra. }
  assert (he0 : 0 <= he).
  { pose proof (bp_pos (-151)). assert (0 <= (42 + / 10) * (u * u) * (E * E) * norm1 q1 q2 q3) by (repeat apply
    Rmult_le_pos; rewrite ?u_val; lra). lra. }
  pose proof (RN_back (hh / slope)) as R. fold step in R. set (st := Rabs step) in *. assert (st0 : 0 <= st) by apply
    Rabs_pos.
  assert (T75 : bp (-1075) <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; lia).
  assert (R2 : Rabs (step * slope - hh) <= (u * st + bp (-1075)) * sl).
  { replace (step * slope - hh) with ((step - hh / slope) * slope) by (field; assumption). rewrite Rabs_mult. apply
    Rmult_le_compat_r; [lra | exact R]. }
  assert (HH : Rabs hh <= st * sl + (u * st + bp (-1075)) * sl).
  { replace hh with (step * slope - (step * slope - hh)) by ring. apply Rabs_minus_le; [rewrite Rabs_mult; apply
    Rle_refl | exact R2]. }
  pose proof (dd_low _ _ Dh) as LL.
  assert (EX : Rabs (step - H / G) * Rabs G <= st * se + he + (2 + / 1000) * (u * (st * sl)) + / 500 * (UNDERFLOW *
    sl)).
  { rewrite <- Rabs_mult. replace ((step - H / G) * G) with (- (step * (slope - G)) + (step * slope - hh) - hl +
    (height - H)) by (rewrite Eh; field; assumption).
    eapply Rle_trans; [apply Rabs_plus_le; [apply Rabs_minus_le; [apply Rabs_plus_le; [rewrite Rabs_Ropp; apply
      Rabs_mult_le; [apply Rle_refl | exact SE] | exact R2] | exact LL] | exact HE]|].
    fold st. assert (J1 : 0 <= st * sl) by (apply Rmult_le_pos; lra). assert (J2 : 0 < UNDERFLOW * sl) by (apply
      Rmult_lt_0_compat; assumption).
    assert (J3 : bp (-1075) * sl <= / 1000000000000 * UNDERFLOW * sl) by (apply Rmult_le_compat_r; lra).
    replace ((u * st + bp (-1075)) * sl) with (u * (st * sl) + bp (-1075) * sl) in * by ring.
    assert (J4 : u * Rabs hh <= u * (st * sl + (u * (st * sl) + bp (-1075) * sl))) by (apply Rmult_le_compat_l; lra).
    set (x := st * sl) in *. set (y := UNDERFLOW * sl) in *. set (t9 := bp (-1075) * sl) in *. set (tn := 2 * T *
      norm1 N1 N2 N3) in *.
    replace (/ 1000000000000 * UNDERFLOW * sl) with (/ 1000000000000 * y) in J3 by (unfold y; ring).
    set (z := (42 + / 10) * (u * u) * (E * E) * norm1 q1 q2 q3) in *. clear - HB TN J1 J2 J3 J4 U0. rewrite u_val in
      *. lra. }
  apply Rmult_le_reg_r with (1023 / 1024 * sl); [lra|].
  apply Rle_trans with (Rabs (step - H / G) * Rabs G); [apply Rmult_le_compat_l; [apply Rabs_pos | assumption]|].
  eapply Rle_trans; [exact EX|]. apply Rle_trans with ((1 - 16 * u) * (STEP_FACTOR * ((he + st * se) / sl) +
    STEP_ROUNDING * st + UNDERFLOW) * (1023 / 1024 * sl)).
  - replace ((1 - 16 * u) * (STEP_FACTOR * ((he + st * se) / sl) + STEP_ROUNDING * st + UNDERFLOW) * (1023 / 1024 *
    sl)) with
      ((1 - 16 * u) * (1023 / 1024) * (STEP_FACTOR * (he + st * se) + STEP_ROUNDING * (st * sl) + UNDERFLOW * sl)) by
        (field; lra).
    unfold STEP_FACTOR, STEP_ROUNDING. assert (J1 : 0 <= st * sl) by (apply Rmult_le_pos; lra). assert (J2 : 0 <
      UNDERFLOW * sl) by (apply Rmult_lt_0_compat; assumption).
    assert (J3 : 0 <= st * se) by (apply Rmult_le_pos; lra). set (x := st * sl) in *. set (y := UNDERFLOW * sl) in *.
      set (z := st * se) in *.
    clear - he0 J1 J2 J3. rewrite u_val in *. lra.
  - apply Rmult_le_compat_r; [lra | exact He].
Qed.
Theorem HEIGHT_ERROR_holds : Rabs (height - H) <= he + 2 * T * norm1 N1 N2 N3.
Proof.
  pose proof height_error as HE. assert (EE : 0 <= E * E) by apply sq_pos. pose proof (norm1_pos q1 q2 q3). assert (U0
    : 0 < UNDERFLOW) by apply bp_pos.
  assert (E * E * ((1 - 8 * u) * norm1 q1 q2 q3) <= E * E * qs) by (apply Rmult_le_compat_l; assumption). unfold
    HEIGHT_ERROR in Hhe.
  assert (0 <= E * E * norm1 q1 q2 q3) by (apply Rmult_le_pos; assumption).
  replace (E * E * ((1 - 8 * u) * norm1 q1 q2 q3)) with ((1 - 8 * u) * (E * E * norm1 q1 q2 q3)) in H1 by ring.
  set (x := E * E * qs) in *. set (y := E * E * norm1 q1 q2 q3) in *.
  replace ((42 + / 10) * (u * u) * (E * E) * norm1 q1 q2 q3) with ((42 + / 10) * (u * u) * y) in HE by (unfold y; ring).
  set (tn := 2 * T * norm1 N1 N2 N3) in *. clear - HE Hhe H1 H2 U0. rewrite u_val in *. lra.
Qed.
Theorem CERTAIN_SLOPE_holds : G <> 0 /\ 1023 / 1024 * Rabs slope <= Rabs G.
Proof.
  pose proof SLOPE_ERROR_holds as SE. pose proof (Rabs_pos (slope - G)). unfold CERTAIN_SLOPE in Hcertain.
  assert (GL : 1023 / 1024 * Rabs slope <= Rabs G).
  { pose proof (Rabs_triang_inv slope (slope - G)) as K. replace (slope - (slope - G)) with G in K by ring. lra. }
  split; [|exact GL]. intro Z. rewrite Z, Rabs_R0 in GL. lra.
Qed.
Theorem STEP_ROUNDING_holds : forall e, (1 - 16 * u) * (STEP_FACTOR * ((he + Rabs step * se) / Rabs slope) +
  STEP_ROUNDING * Rabs step + UNDERFLOW) <= e ->
  Rabs (step - H / G) <= e.
Proof. intros e He. now apply STEP_FACTOR_holds. Qed.
End Triangle.
(* What underflows in a dot product of vectors to the hit is below a part of 10^12 of UNDERFLOW. *)
Theorem UNDERFLOW_holds : forall x1 x2 x3 y1 y2 y3, bp (low (tside x1 x2 x3 y1 y2 y3)) <= / 1000000000000 * UNDERFLOW.
Proof. intros. apply bp_part12. vm_compute. discriminate. Qed.
