(* rt-geom, bvh/cull.rs: a hit in a box or a ball, from the ray as it is given to the bit that is set. *)
From Proofs Require Import Rounding Single Norm Boxes Line Balls.
From Proofs Require Frame.
Open Scope R_scope.

(* The reciprocal of a component, from its double to the f32 that is cut. *)
Definition inverted d length i := d = 0 /\ Rabs i = MAX_INVERSE \/ d <> 0 /\ let r := RNs (RN (RN (/ d) * length)) in
  (Rabs r <= MAX_INVERSE -> i = r) /\ (MAX_INVERSE < Rabs r -> Rabs i = MAX_INVERSE /\ 0 < i * d).
(* A plane times the reciprocal, rounded or not. *)
Definition product y p i := Rabs (y - p * i) <= UNIT * Rabs (p * i) + bp (-150).

Lemma axis_kept : forall d L length i q tau P near far err y z, Rabs d <= L -> Rabs d <= bp 100 -> bp (-101) <= L ->
  Rabs (length - L) <= 4 * u * L -> inverted d length i -> Rabs tau <= REACH -> Rabs q <= 107 / 100 ->
  Rabs near <= 1 + / 1000 -> Rabs far <= 1 + / 1000 -> Rabs (P - (q + tau * (d / L))) <= err -> err <= / 16 ->
  product y near i -> product z far i -> near * i <= P * i <= far * i ->
  let s := RNs (BOX_SLACK * UNIT + up err) in entry y i q s <= tau <= exit z i q s.
Proof.
  intros d L length i q tau P near far err y z DL D1 L0 Hl Hi Ht Hq Hn Hf HP He Hy Hz HB s.
  assert (E0 : 0 <= err) by (eapply Rle_trans; [apply Rabs_pos | apply HP]).
  assert (LP : 0 < L) by (pose proof (bp_pos (-101)); lra).
  assert (W : Rabs (d / L - / i) <= (1 + / 100) * UNIT /\ 1 - 3 * UNIT <= Rabs i <= MAX_INVERSE).
  { destruct Hi as [[Z I]|[N [I1 I2]]].
    - split; [rewrite Z; unfold Rdiv; rewrite Rmult_0_l; now apply component_zero|]. rewrite I. unfold MAX_INVERSE.
    rewrite v_val.
      simpl. lra.
    - apply (MAX_INVERSE_holds d L length i); try assumption; [split; [now apply Rabs_pos_lt | assumption]|].
      apply Rle_trans with (bp (-100)); [apply bp_le; lia|]. change (-100)%Z with (Z.opp 100). rewrite bpow_opp.
      apply Rinv_le_contravar; [now apply Rabs_pos_lt | assumption]. }
  destruct W as [W1 W2]. apply (BOX_SLACK_holds (d / L) i q tau P near far err (up err) y z); try assumption.
  split; [apply up_above | apply up_small; lra].
Qed.

(* The hit at P, the exact image of origin + t' direction, lies in the box (near and far planes by the signs of the
   reciprocals) and in the unit ball, its rounded t in the range: the box is kept,
     in any order of the maxima and minima. *)
Theorem box_is_kept : forall o1 o2 o3 p1 p2 p3 d1 d2 d3 S dot x1 x2 x3 kappa t t' i1 i2 i3 n1 n2 n3 f1 f2 f3 y1 y2 y3
  z1 z2 z3
  start last,
  let l := norm d1 d2 d3 in let along := (p1 * (d1 / l) + p2 * (d2 / l) + p3 * (d3 / l)) in
  let inverse := RN (/ S) in let length := RN (sqrt S) in let g := RN (dot * inverse) in
  let base := RN (- dot * RN (length * inverse)) in let len := RN (length * kappa) in
  let error := RN (RN (1 + RN (RN (Rabs o1 + Rabs o2) + Rabs o3)) * LINE_ERROR) in
  let P1 := p1 + t' * (kappa * d1) in let P2 := p2 + t' * (kappa * d2) in let P3 := p3 + t' * (kappa * d3) in
  let q1 := RN (o1 - x1) in let q2 := RN (o2 - x2) in let q3 := RN (o3 - x3) in
  Rabs d1 <= bp 100 -> Rabs d2 <= bp 100 -> Rabs d3 <= bp 100 -> bp (-200) <= d1 * d1 + d2 * d2 + d3 * d3 ->
  Rabs (o1 - p1) <= (1 + / 1000) * u * Rabs o1 + IMAGE -> Rabs (o2 - p2) <= (1 + / 1000) * u * Rabs o2 + IMAGE ->
  Rabs (o3 - p3) <= (1 + / 1000) * u * Rabs o3 + IMAGE ->
  plain (tdot (X d1 100) (X d2 100) (X d3 100) (X d1 100) (X d2 100) (X d3 100)) S ->
  plain (tdot (X o1 45) (X o2 45) (X o3 45) (X d1 100) (X d2 100) (X d3 100)) dot ->
  Rabs (x1 - d1 * g) <= u * Rabs (d1 * g) + bp (-1075) -> Rabs (x2 - d2 * g) <= u * Rabs (d2 * g) + bp (-1075) ->
  Rabs (x3 - d3 * g) <= u * Rabs (d3 * g) + bp (-1075) ->
  0 < kappa -> bp (-1022) < len -> len < bp 1024 -> Rabs (t - t') <= u * Rabs t' + bp (-1075) -> start <= t <= last ->
  error < MAX_LINE_ERROR -> P1 * P1 + P2 * P2 + P3 * P3 <= 1 ->
  inverted d1 length i1 -> inverted d2 length i2 -> inverted d3 length i3 ->
  Rabs n1 <= 1 + / 1000 -> Rabs n2 <= 1 + / 1000 -> Rabs n3 <= 1 + / 1000 -> Rabs f1 <= 1 + / 1000 ->
  Rabs f2 <= 1 + / 1000 -> Rabs f3 <= 1 + / 1000 ->
  product y1 n1 i1 -> product y2 n2 i2 -> product y3 n3 i3 -> product z1 f1 i1 -> product z2 f2 i2 -> product z3 f3 i3
    ->
  n1 * i1 <= P1 * i1 <= f1 * i1 -> n2 * i2 <= P2 * i2 <= f2 * i2 -> n3 * i3 <= P3 * i3 <= f3 * i3 ->
  let s := RNs (BOX_SLACK * UNIT + up error) in
  Rmax (Rmax (entry y1 i1 q1 s) (entry y2 i2 q2 s)) (Rmax (entry y3 i3 q3 s)
    (down (Rmax (RN (RN (RN (start * len) - base) - error)) (- REACH)))) <=
  Rmin (Rmin (exit z1 i1 q1 s) (exit z2 i2 q2 s)) (Rmin (exit z3 i3 q3 s)
    (up (Rmin (RN (RN (RN (last * len) - base) + error)) REACH))).
Proof.
  intros o1 o2 o3 p1 p2 p3 d1 d2 d3 S dot x1 x2 x3 kappa t t' i1 i2 i3 n1 n2 n3 f1 f2 f3 y1 y2 y3 z1 z2 z3 start last
    l along
    inverse length g base len error P1 P2 P3 q1 q2 q3 D1 D2 D3 DL O1 O2 O3 HS Hdot X1 X2 X3 K0 N0 N1 Ht [HT1 HT2] HE
      HP I1 I2 I3
    A1 A2 A3 A4 A5 A6 Y1 Y2 Y3 Z1 Z2 Z3 H1 H2 H3 s.
  destruct (MAX_LINE_ERROR_holds o1 o2 o3 HE) as (R1 & R2 & R3).
  pose proof (l_pos d1 d2 d3 DL) as L0. pose proof (l_low d1 d2 d3 DL) as LL. fold l in L0, LL.
  pose proof (w_unit d1 d2 d3 DL) as WU. fold l in WU.
  assert (WW : d1 / l * (d1 / l) + d2 / l * (d2 / l) + d3 / l * (d3 / l) = 1) by (rewrite <- norm_sq, WU; ring).
  set (tau := t' * (l * kappa) + along).
  assert (C1 : P1 = p1 - along * (d1 / l) + tau * (d1 / l)) by (unfold P1, tau; field; lra).
  assert (C2 : P2 = p2 - along * (d2 / l) + tau * (d2 / l)) by (unfold P2, tau; field; lra).
  assert (C3 : P3 = p3 - along * (d3 / l) + tau * (d3 / l)) by (unfold P3, tau; field; lra).
  assert (Q0 : (p1 - along * (d1 / l)) * (d1 / l) + (p2 - along * (d2 / l)) * (d2 / l)
    + (p3 - along * (d3 / l)) * (d3 / l) = 0).
  { replace ((p1 - along * (d1 / l)) * (d1 / l) + (p2 - along * (d2 / l)) * (d2 / l)
    + (p3 - along * (d3 / l)) * (d3 / l)) with
      (along - along * (d1 / l * (d1 / l) + d2 / l * (d2 / l) + d3 / l * (d3 / l))) by (unfold along; ring).
      rewrite WW. ring. }
  destruct (REACH_holds _ _ _ _ _ _ tau P1 P2 P3 WW Q0 HP C1 C2 C3) as [TR QN].
  assert (TR' : Rabs tau <= REACH) by lra.
  destruct (LINE_ERROR_holds o1 o2 o3 p1 p2 p3 d1 d2 d3 S dot x1 x2 x3 kappa t t' D1 D2 D3 DL O1 O2 O3 HS Hdot X1 X2
    X3 K0 N0 N1
    Ht TR' HE) as (LE & LB & LA & _).
  assert (QN' : norm (p1 - along * (d1 / l)) (p2 - along * (d2 / l)) (p3 - along * (d3 / l)) <= 1) by (apply norm_le;
    lra).
  destruct (nearest_range o1 o2 o3 p1 p2 p3 d1 d2 d3 D1 D2 D3 DL R1 R2 R3 O1 O2 O3 S dot x1 x2 x3 HS Hdot X1 X2 X3 HE
    QN') as [NR _].
  pose proof (length_near o1 o2 o3 p1 p2 p3 d1 d2 d3 D1 D2 D3 DL O1 O2 O3 S dot x1 x2 x3 HS Hdot X1 X2 X3) as LN.
  fold l length in LN.
  assert (LN' : Rabs (length - l) <= 4 * u * l) by (eapply Rle_trans; [exact LN|];
    assert (0 < u * l) by (apply Rmult_lt_0_compat;
    [apply u_pos | assumption]); lra).
  change (norm (q1 - (p1 - along * (d1 / l))) (q2 - (p2 - along * (d2 / l))) (q3 - (p3 - along * (d3 / l))) <= error)
    in LE.
  fold q1 q2 q3 in NR. destruct (part_le q1 q2 q3) as (M1 & M2 & M3). destruct (part_le d1 d2 d3) as (G1 & G2 & G3).
  fold l in G1, G2, G3.
  destruct (part_le (q1 - (p1 - along * (d1 / l))) (q2 - (p2 - along * (d2 / l))) (q3 - (p3 - along * (d3 / l)))) as
    (E1 & E2 & E3).
  assert (LL' : bp (-101) <= l) by (apply Rle_trans with (2 := LL); apply bp_le; lia).
  assert (HE' : error <= / 16) by (unfold MAX_LINE_ERROR in HE; fold error in HE; lra).
  assert (F1 : entry y1 i1 q1 s <= tau <= exit z1 i1 q1 s).
  { apply (axis_kept d1 l length i1 q1 tau P1 n1 f1 error y1 z1); try assumption; [lra|]. rewrite C1.
    replace (p1 - along * (d1 / l) + tau * (d1 / l) - (q1
      + tau * (d1 / l))) with (- (q1 - (p1 - along * (d1 / l)))) by ring.
    rewrite Rabs_Ropp. lra. }
  assert (F2 : entry y2 i2 q2 s <= tau <= exit z2 i2 q2 s).
  { apply (axis_kept d2 l length i2 q2 tau P2 n2 f2 error y2 z2); try assumption; [lra|]. rewrite C2.
    replace (p2 - along * (d2 / l) + tau * (d2 / l) - (q2
      + tau * (d2 / l))) with (- (q2 - (p2 - along * (d2 / l)))) by ring.
    rewrite Rabs_Ropp. lra. }
  assert (F3 : entry y3 i3 q3 s <= tau <= exit z3 i3 q3 s).
  { apply (axis_kept d3 l length i3 q3 tau P3 n3 f3 error y3 z3); try assumption; [lra|]. rewrite C3.
    replace (p3 - along * (d3 / l) + tau * (d3 / l) - (q3
      + tau * (d3 / l))) with (- (q3 - (p3 - along * (d3 / l)))) by ring.
    rewrite Rabs_Ropp. lra. }
  specialize (LB start HT1). specialize (LA last HT2). fold len base error in LB, LA.
  apply Rle_trans with tau.
  - apply Rmax_lub; apply Rmax_lub; try apply F1; try apply F2; try apply F3; exact LB.
  - apply Rmin_glb; apply Rmin_glb; try apply F1; try apply F2; try apply F3; exact LA.
Qed.

(* A ball (center c, radius r) that contains what is hit at P: it is kept. *)
Theorem ball_is_kept : forall o1 o2 o3 p1 p2 p3 d1 d2 d3 S dot x1 x2 x3 kappa t t' c1 c2 c3 r sign a1 a2 a3 v start
  last,
  let l := norm d1 d2 d3 in let along := (p1 * (d1 / l) + p2 * (d2 / l) + p3 * (d3 / l)) in
  let inverse := RN (/ S) in let length := RN (sqrt S) in let g := RN (dot * inverse) in
  let k := RN (length * inverse) in let base := RN (- dot * k) in let len := RN (length * kappa) in
  let error := RN (RN (1 + RN (RN (Rabs o1 + Rabs o2) + Rabs o3)) * LINE_ERROR) in
  let P1 := p1 + t' * (kappa * d1) in let P2 := p2 + t' * (kappa * d2) in let P3 := p3 + t' * (kappa * d3) in
  let q1 := RN (o1 - x1) in let q2 := RN (o2 - x2) in let q3 := RN (o3 - x3) in
  Rabs d1 <= bp 100 -> Rabs d2 <= bp 100 -> Rabs d3 <= bp 100 -> bp (-200) <= d1 * d1 + d2 * d2 + d3 * d3 ->
  Rabs (o1 - p1) <= (1 + / 1000) * u * Rabs o1 + IMAGE -> Rabs (o2 - p2) <= (1 + / 1000) * u * Rabs o2 + IMAGE ->
  Rabs (o3 - p3) <= (1 + / 1000) * u * Rabs o3 + IMAGE ->
  plain (tdot (X d1 100) (X d2 100) (X d3 100) (X d1 100) (X d2 100) (X d3 100)) S ->
  plain (tdot (X o1 45) (X o2 45) (X o3 45) (X d1 100) (X d2 100) (X d3 100)) dot ->
  Rabs (x1 - d1 * g) <= u * Rabs (d1 * g) + bp (-1075) -> Rabs (x2 - d2 * g) <= u * Rabs (d2 * g) + bp (-1075) ->
  Rabs (x3 - d3 * g) <= u * Rabs (d3 * g) + bp (-1075) ->
  0 < kappa -> bp (-1022) < len -> len < bp 1024 -> Rabs (t - t') <= u * Rabs t' + bp (-1075) -> start <= t <= last ->
  error < MAX_LINE_ERROR -> P1 * P1 + P2 * P2 + P3 * P3 <= 1 ->
  norm c1 c2 c3 <= 1 + / 1000 -> 0 <= r <= 1 + / 100 -> norm (c1 - P1) (c2 - P2) (c3 - P3) <= r ->
  sign = 1 \/ sign = - 1 -> 0 <= sign * d3 ->
  let x := RNs (RN (d1 * k)) in let y := RNs (RN (d2 * k)) in let z := RNs (RN (d3 * k)) in
  let a := RNs (- 1 / RNs (sign + z)) in let b := RNs (RNs (x * y) * a) in
  let across f1 f2 f3 := talong c1 c2 c3 f1 f2 f3 (RNs q1) (RNs q2) (RNs q3) in
  single (across (RNs (1 + RNs (RNs (sign * x * x) * a))) (sign * b) (- (sign * x))) a1 ->
  single (across b (RNs (sign + RNs (RNs (y * y) * a))) (- y)) a2 -> single (across x y z) a3 ->
  let first := down (Rmax (RN (RN (RN (start * len) - base) - error)) (- REACH)) in
  let end' := up (Rmin (RN (RN (RN (last * len) - base) + error)) REACH) in
  let beyond := RNs (a3 - Rmin (Rmax a3 first) end') in
  single (Add (Mul (X a1 3) (X a1 3)) (Add (Mul (X a2 3) (X a2 3)) (Mul (X beyond 3) (X beyond 3)))) v ->
  let reach := RNs (r + RNs (BALL_SLACK * UNIT + up error)) in v <= RNs (reach * reach).
Proof.
  intros o1 o2 o3 p1 p2 p3 d1 d2 d3 S dot x1 x2 x3 kappa t t' c1 c2 c3 r sign a1 a2 a3 v start last l along inverse
    length g k base
    len error P1 P2 P3 q1 q2 q3 D1 D2 D3 DL O1 O2 O3 HS Hdot X1 X2 X3 K0 N0 N1 Ht [HT1 HT2] HE HP HC Hr Hhit Hs Hz x y
      z a b across
    A1 A2 A3 first end' beyond Hv reach.
  destruct (MAX_LINE_ERROR_holds o1 o2 o3 HE) as (R1 & R2 & R3).
  pose proof (l_pos d1 d2 d3 DL) as L0. pose proof (l_low d1 d2 d3 DL) as LL. fold l in L0, LL.
  pose proof (w_unit d1 d2 d3 DL) as WU. fold l in WU.
  assert (WW : d1 / l * (d1 / l) + d2 / l * (d2 / l) + d3 / l * (d3 / l) = 1) by (rewrite <- norm_sq, WU; ring).
  set (tau := t' * (l * kappa) + along).
  assert (C1 : P1 = p1 - along * (d1 / l) + tau * (d1 / l)) by (unfold P1, tau; field; lra).
  assert (C2 : P2 = p2 - along * (d2 / l) + tau * (d2 / l)) by (unfold P2, tau; field; lra).
  assert (C3 : P3 = p3 - along * (d3 / l) + tau * (d3 / l)) by (unfold P3, tau; field; lra).
  assert (Q0 : (p1 - along * (d1 / l)) * (d1 / l) + (p2 - along * (d2 / l)) * (d2 / l)
    + (p3 - along * (d3 / l)) * (d3 / l) = 0).
  { replace ((p1 - along * (d1 / l)) * (d1 / l) + (p2 - along * (d2 / l)) * (d2 / l)
    + (p3 - along * (d3 / l)) * (d3 / l)) with
      (along - along * (d1 / l * (d1 / l) + d2 / l * (d2 / l) + d3 / l * (d3 / l))) by (unfold along; ring).
      rewrite WW. ring. }
  destruct (REACH_holds _ _ _ _ _ _ tau P1 P2 P3 WW Q0 HP C1 C2 C3) as [TR QN].
  assert (TR' : Rabs tau <= REACH) by lra.
  destruct (LINE_ERROR_holds o1 o2 o3 p1 p2 p3 d1 d2 d3 S dot x1 x2 x3 kappa t t' D1 D2 D3 DL O1 O2 O3 HS Hdot X1 X2
    X3 K0 N0 N1
    Ht TR' HE) as (LE & LB & LA & _).
  assert (QN' : norm (p1 - along * (d1 / l)) (p2 - along * (d2 / l)) (p3 - along * (d3 / l)) <= 1) by (apply norm_le;
    lra).
  destruct (nearest_range o1 o2 o3 p1 p2 p3 d1 d2 d3 D1 D2 D3 DL R1 R2 R3 O1 O2 O3 S dot x1 x2 x3 HS Hdot X1 X2 X3 HE
    QN') as [NR _].
  pose proof (length_near o1 o2 o3 p1 p2 p3 d1 d2 d3 D1 D2 D3 DL O1 O2 O3 S dot x1 x2 x3 HS Hdot X1 X2 X3) as LN.
  fold l length in LN.
  assert (LN' : Rabs (length - l) <= 4 * u * l) by (eapply Rle_trans; [exact LN|];
    assert (0 < u * l) by (apply Rmult_lt_0_compat;
    [apply u_pos | assumption]); lra).
  change (norm (q1 - (p1 - along * (d1 / l))) (q2 - (p2 - along * (d2 / l))) (q3 - (p3 - along * (d3 / l))) <= error)
    in LE.
  fold q1 q2 q3 in NR. destruct (part_le q1 q2 q3) as (M1 & M2 & M3). destruct (part_le d1 d2 d3) as (G1 & G2 & G3).
  fold l in G1, G2, G3.
  destruct (part_le (q1 - (p1 - along * (d1 / l))) (q2 - (p2 - along * (d2 / l))) (q3 - (p3 - along * (d3 / l)))) as
    (E1 & E2 & E3).
  specialize (LB start HT1). specialize (LA last HT2). fold len base error in LB, LA.
  pose proof (direction_near o1 o2 o3 p1 p2 p3 d1 d2 d3 D1 D2 D3 DL O1 O2 O3 S dot x1 x2 x3 HS Hdot X1 X2 X3) as DN.
  fold l length inverse k in DN. assert (E0 : 0 <= error) by (eapply Rle_trans; [apply norm_pos | exact LE]).
  apply (BALL_SLACK_holds (d1 / l) (d2 / l) (d3 / l) x y z sign c1 c2 c3 q1 q2 q3 tau first end' r error (up error) a1
    a2 a3 v);
    try assumption; try apply DN.
  - unfold Rdiv. rewrite <- Rmult_assoc. apply Rmult_le_pos; [assumption | apply Rlt_le; now apply Rinv_0_lt_compat].
  - lra.
  - split; [assumption | apply up_above].
  - apply up_small. unfold MAX_LINE_ERROR in HE. fold error in HE. lra.
  - replace (c1 - (q1 + tau * (d1 / l))) with ((c1 - P1) + - (q1 - (p1 - along * (d1 / l)))) by (rewrite C1; ring).
    replace (c2 - (q2 + tau * (d2 / l))) with ((c2 - P2) + - (q2 - (p2 - along * (d2 / l)))) by (rewrite C2; ring).
    replace (c3 - (q3 + tau * (d3 / l))) with ((c3 - P3) + - (q3 - (p3 - along * (d3 / l)))) by (rewrite C3; ring).
    eapply Rle_trans; [apply norm_triangle|]. rewrite norm_opp. lra.
  - split; [exact LB | exact LA].
Qed.

(* ---- Directions whose squares over- or underflow (`scaled`): divided by a power of two near the greatest part ---- *)
Definition power g := Z.max (-1021) (Z.min 1021 (mag radix2 g - 1)).
(* A component is divided exactly, or is off by half of the least double beside a greatest one of at least 1. *)
Theorem divided : forall e g, F e -> F g -> 0 < g -> Rabs e <= g -> g < bp 1024 ->
  let k := power g in let d := RN (e / bp k) in
  Rabs (d - e / bp k) <= bp (-1075) /\ ((k <= 0)%Z -> d = e / bp k) /\ ((1 <= k)%Z -> bp k <= g) /\
  Rabs d <= bp 3 /\ bp (-53) <= g / bp k.
Proof.
  intros e g Fe Fg g0 He Hg k d. assert (I : forall x, x / bp k = x * bp (- k)) by (intro; now rewrite bpow_opp).
  assert (K0 : 0 < bp (- k)) by apply bp_pos. unfold d. rewrite !I.
  assert (M1 : bp (mag radix2 g - 1) <= g).
  { pose proof (bpow_mag_le radix2 g ltac:(lra)) as M. now rewrite Rabs_pos_eq in M by lra. }
  assert (M2 : g < bp (mag radix2 g)).
  { pose proof (bpow_mag_gt radix2 g) as M. now rewrite Rabs_pos_eq in M by lra. }
  assert (M3 : (mag radix2 g <= 1024)%Z) by (apply mag_le_bpow; [lra | now rewrite Rabs_pos_eq by lra]).
  assert (T : g * bp (- k) <= bp 3).
  { apply Rle_trans with (bp (mag radix2 g) * bp (- k)); [apply Rmult_le_compat_r; lra|]. rewrite <- bp_add.
    apply bp_le. unfold k, power. lia. }
  split; [now apply Frame.scaled|]. split; [intro K; apply Frame.scaled_up; [assumption | lia]|].
  split; [intro K; apply Rle_trans with (2 := M1); apply bp_le; unfold k, power in *; lia|]. split.
  - assert (B : Rabs (e * bp (- k)) <= bp 3).
    { rewrite Rabs_mult, (Rabs_pos_eq (bp (- k))) by lra. apply Rle_trans with (2 := T). apply Rmult_le_compat_r; lra. }
    apply Rabs_le_inv in B. assert (F3 : F (bp 3)) by (apply F_bp; lia). apply Rabs_le. split.
    + rewrite <- (RN_id (bp 3) F3), <- RN_opp. now apply RN_le.
    + rewrite <- (RN_id (bp 3) F3). now apply RN_le.
  - destruct (Z_le_gt_dec (-1021) (mag radix2 g - 1)) as [L|L].
    + apply Rle_trans with (bp (mag radix2 g - 1) * bp (- k)); [|apply Rmult_le_compat_r; lra]. rewrite <- bp_add.
      apply bp_le. unfold k, power. lia.
    + assert (G : bp (-1074) <= g).
      { apply (generic_format_ge_bpow radix2 fexp); [|assumption | exact Fg]. intro x. unfold fexp, FLT_exp. lia. }
      apply Rle_trans with (bp (-1074) * bp (- k)); [|apply Rmult_le_compat_r; lra]. rewrite <- bp_add. apply bp_le.
      unfold k, power. lia.
Qed.

(* A line of any direction (e1, e2, e3), not zero, that hits at P: of the divided direction and of an origin close by,
   which has the premises of `box_is_kept` and `ball_is_kept`, it is a line that hits at P as well. *)
Theorem any_direction : forall e1 e2 e3 o1 o2 o3 p1 p2 p3 s t',
  let g := Rmax (Rabs e1) (Rmax (Rabs e2) (Rabs e3)) in let k := power g in let kappa := bp k * s in
  let d1 := RN (e1 / bp k) in let d2 := RN (e2 / bp k) in let d3 := RN (e3 / bp k) in
  let P1 := p1 + t' * (s * e1) in let P2 := p2 + t' * (s * e2) in let P3 := p3 + t' * (s * e3) in
  F e1 -> F e2 -> F e3 -> 0 < g -> g < bp 1024 ->
  Rabs o1 <= bp 45 -> Rabs o2 <= bp 45 -> Rabs o3 <= bp 45 ->
  Rabs (o1 - p1) <= (1 + / 1000) * u * Rabs o1 + bp (-52) -> Rabs (o2 - p2) <= (1 + / 1000) * u * Rabs o2 + bp (-52) ->
  Rabs (o3 - p3) <= (1 + / 1000) * u * Rabs o3 + bp (-52) -> P1 * P1 + P2 * P2 + P3 * P3 <= 1 ->
  (exists p1' p2' p3', p1' + t' * (kappa * d1) = P1 /\ p2' + t' * (kappa * d2) = P2 /\ p3' + t' * (kappa * d3) = P3 /\
    Rabs (o1 - p1') <= (1 + / 1000) * u * Rabs o1 + IMAGE /\ Rabs (o2 - p2') <= (1 + / 1000) * u * Rabs o2 + IMAGE /\
    Rabs (o3 - p3') <= (1 + / 1000) * u * Rabs o3 + IMAGE) /\
  Rabs d1 <= bp 100 /\ Rabs d2 <= bp 100 /\ Rabs d3 <= bp 100 /\ bp (-200) <= d1 * d1 + d2 * d2 + d3 * d3.
Proof.
  intros e1 e2 e3 o1 o2 o3 p1 p2 p3 s t' g k kappa d1 d2 d3 P1 P2 P3 F1 F2 F3 g0 gt O1 O2 O3 Q1 Q2 Q3 HP.
  assert (G1 : Rabs e1 <= g) by apply Rmax_l.
  assert (G2 : Rabs e2 <= g) by (eapply Rle_trans; [apply Rmax_l | apply Rmax_r]).
  assert (G3 : Rabs e3 <= g) by (eapply Rle_trans; [apply Rmax_r | apply Rmax_r]).
  assert (GG : g = Rabs e1 \/ g = Rabs e2 \/ g = Rabs e3).
  { unfold g, Rmax at 1 3 5. destruct (Rle_dec (Rabs e1) _); [right; unfold Rmax; destruct Rle_dec; auto | now left]. }
  assert (Fg : F g).
  { destruct GG as [E|[E|E]]; rewrite E; now apply generic_format_abs. }
  destruct (divided e1 g F1 Fg g0 G1 gt) as (E1 & X1 & KG & B1 & L).
  destruct (divided e2 g F2 Fg g0 G2 gt) as (E2 & X2 & _ & B2 & _).
  destruct (divided e3 g F3 Fg g0 G3 gt) as (E3 & X3 & _ & B3 & _).
  fold k in E1, E2, E3, X1, X2, X3, KG, B1, B2, B3, L. fold d1 in E1, X1, B1. fold d2 in E2, X2, B2.
  fold d3 in E3, X3, B3. pose proof (bp_pos k) as K0. pose proof u_pos as U0.
  assert (B52 : bp (-52) = 2 * u) by (unfold u; change (-52)%Z with (1 + -53)%Z; rewrite bp_add, bp_1; reflexivity).
  assert (B8 : forall x, Rabs x <= bp 3 -> Rabs x <= bp 100).
  { intros x H. eapply Rle_trans; [exact H | apply bp_le; lia]. }
  split; [|split; [now apply B8 | split; [now apply B8 | split; [now apply B8|]]]].
  - (* the parameter in units of the divided direction is at most 2^47 where anything is off *)
    assert (far : forall e p o P, Rabs e = g -> P = p + t' * (s * e) -> Rabs P <= 1 -> Rabs o <= bp 45 ->
      Rabs (o - p) <= (1 + / 1000) * u * Rabs o + bp (-52) -> (1 <= k)%Z -> Rabs (t' * kappa) <= bp 47).
    { intros e p o P Ee EP HP' Ho Hp K. apply Rle_trans with (Rabs (t' * s) * g).
      - unfold kappa. replace (t' * (bp k * s)) with (t' * s * bp k) by ring. rewrite Rabs_mult, (Rabs_pos_eq (bp k)) by
          lra. apply Rmult_le_compat_l; [apply Rabs_pos | now apply KG].
      - rewrite <- Ee, <- Rabs_mult. replace (t' * s * e) with (P - p) by (rewrite EP; ring).
        replace (P - p) with (P + (o - p) + - o) by ring. eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp.
        eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|]. rewrite B52, u_val in Hp.
        assert (Z : bp 47 = 140737488355328) by (simpl; lra). assert (Z2 : bp 45 = 35184372088832) by (simpl; lra).
        rewrite Z. rewrite Z2 in Ho. lra. }
    assert (inside : forall x y z, x * x + y * y + z * z <= 1 -> Rabs x <= 1).
    { intros x y z H. apply abs_below; [lra|]. pose proof (sq_pos y). pose proof (sq_pos z). lra. }
    assert (FAR : (1 <= k)%Z -> Rabs (t' * kappa) <= bp 47).
    { destruct GG as [E|[E|E]]; symmetry in E.
      - apply (far e1 p1 o1 P1); auto. now apply (inside P1 P2 P3).
      - apply (far e2 p2 o2 P2); auto. apply (inside P2 P1 P3). lra.
      - apply (far e3 p3 o3 P3); auto. apply (inside P3 P1 P2). lra. }
    assert (near : forall e d, Rabs (d - e / bp k) <= bp (-1075) -> ((k <= 0)%Z -> d = e / bp k) ->
      Rabs (t' * kappa * (e / bp k - d)) <= / 1000 * u).
    { intros e d E X. destruct (Z_le_gt_dec k 0) as [K|K].
      - rewrite (X K). replace (e / bp k - e / bp k) with 0 by ring. rewrite Rmult_0_r, Rabs_R0. lra.
      - rewrite Rabs_mult, (Rabs_minus_sym (e / bp k)). apply Rle_trans with (bp 47 * bp (-1075)).
        + apply Rmult_le_compat; auto using Rabs_pos. apply FAR. lia.
        + apply Rle_trans with (bp (-10) * u); [unfold u; rewrite <- !bp_add; apply bp_le; lia|].
          apply Rmult_le_compat_r; simpl; lra. }
    assert (move : forall e d o p, Rabs (d - e / bp k) <= bp (-1075) -> ((k <= 0)%Z -> d = e / bp k) ->
      Rabs (o - p) <= (1 + / 1000) * u * Rabs o + bp (-52) ->
      p + t' * kappa * (e / bp k - d) + t' * (kappa * d) = p + t' * (s * e) /\
      Rabs (o - (p + t' * kappa * (e / bp k - d))) <= (1 + / 1000) * u * Rabs o + IMAGE).
    { intros e d o p E X H. split; [unfold kappa; field; lra|].
      replace (o - (p + t' * kappa * (e / bp k - d))) with ((o - p) + - (t' * kappa * (e / bp k - d))) by ring.
      eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. pose proof (near e d E X). lra. }
    destruct (move e1 d1 o1 p1 E1 X1 Q1) as [Y1 Z1]. destruct (move e2 d2 o2 p2 E2 X2 Q2) as [Y2 Z2].
    destruct (move e3 d3 o3 p3 E3 X3 Q3) as [Y3 Z3].
    exists (p1 + t' * kappa * (e1 / bp k - d1)), (p2 + t' * kappa * (e2 / bp k - d2)),
      (p3 + t' * kappa * (e3 / bp k - d3)). repeat split; assumption.
  - (* the greatest component *)
    assert (low : forall e, Rabs e = g -> bp (-106) <= RN (e / bp k) * RN (e / bp k)).
    { intros e Ee. change (-106)%Z with (-53 + -53)%Z. rewrite <- bp_sq, <- (abs_sq (RN (e / bp k))).
      assert (A : bp (-53) <= Rabs (RN (e / bp k))); [|apply Rmult_le_compat; auto; apply Rlt_le, bp_pos].
      rewrite <- (RN_id (bp (-53))) by (apply F_bp; lia). unfold Rabs in Ee. destruct (Rcase_abs e) as [N|N].
      - rewrite <- Rabs_Ropp, <- RN_opp. apply Rle_trans with (RN (- (e / bp k))); [|apply Rle_abs]. apply RN_le.
        replace (- (e / bp k)) with (g / bp k) by (rewrite <- Ee; field; lra). exact L.
      - apply Rle_trans with (RN (e / bp k)); [|apply Rle_abs]. apply RN_le. rewrite Ee. exact L. }
    pose proof (sq_pos d1). pose proof (sq_pos d2). pose proof (sq_pos d3).
    apply Rle_trans with (bp (-106)); [apply bp_le; lia|].
    destruct GG as [E|[E|E]]; symmetry in E; pose proof (low _ E) as W;
      [fold d1 in W | fold d2 in W | fold d3 in W]; lra.
Qed.
