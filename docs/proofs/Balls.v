(* rt-geom, bvh/cull.rs: the test of balls in f32. *)
From Proofs Require Import Rounding Single Norm.
Open Scope R_scope.
Notation v := UNIT.

(* The rounding errors of the ball test, as a distance, in units of v. *)
Definition BALL_SLACK := 64.

(* ---- The frame of Duff et al., exactly: orthonormal, and its third vector is the direction ---- *)
Section Frame.
Variables x y z s a : R.
Hypotheses (W : x * x + y * y + z * z = 1) (S : s * s = 1) (H : a * (s + z) = - 1).
Lemma frame_sum : a * (x * x + y * y) = z - s.
Proof.
  replace (x * x + y * y) with ((s + z) * (s - z)) by (replace ((s + z) * (s - z)) with (s * s - z * z) by ring; lra).
  rewrite <- Rmult_assoc, H. ring.
Qed.
Lemma frame_zero : 2 * s * a + a * (a * (x * x + y * y)) + 1 = 0.
Proof. rewrite frame_sum. replace (2 * s * a + a * (z - s) + 1) with (a * (s + z) + 1) by ring. rewrite H. ring. Qed.
Definition row1 (p q r : R) := (1 + s * (x * x * a)) * p + s * (x * y * a) * q + - (s * x) * r.
Definition row2 (p q r : R) := x * y * a * p + (s + y * y * a) * q + - y * r.
Definition row3 (p q r : R) := x * p + y * q + z * r.
Lemma frame_length : forall p q r, norm (row1 p q r) (row2 p q r) (row3 p q r) = norm p q r.
Proof.
  intros. unfold norm. f_equal. pose proof frame_sum as L. pose proof frame_zero as K. unfold row1, row2, row3.
  assert (E : ((1 + s * (x * x * a)) * p + s * (x * y * a) * q + - (s * x) * r) * ((1 + s * (x * x * a)) * p + s *
    (x * y * a) * q + - (s * x) * r) + (x * y * a * p + (s + y * y * a) * q + - y * r) * (x * y * a * p + (s
      + y * y * a)
    * q + - y * r) + (x * p + y * q + z * r) * (x * p + y * q + z * r) = p * p + q * q + r * r
    + (2 * s * a + a * (a * (x * x + y * y)) + 1) * ((x * p + y * q) * (x * p + y * q))
    + 2 * (z - s - a * (x * x + y * y)) * (r * (x * p + y * q)) + (x * x + y * y + z * z - 1) * (r * r)
    + (s * s - 1) * (x * x * a * (x * x * a) * (p * p) + x * y * a * (x * y * a) * (q * q) + x * x * (r * r) + q * q
      + 2 * (x * x * a) * (x * y * a) * (p * q) - 2 * (x * x * a) * x * (p * r) - 2 * (x * y * a) * x * (q * r)))
    by ring.
  rewrite E, K, W, S, L. ring.
Qed.
Lemma frame_third : row1 x y z = 0 /\ row2 x y z = 0 /\ row3 x y z = 1.
Proof.
  pose proof frame_sum as L. unfold row1, row2, row3. split; [|split; [|exact W]].
  - replace ((1 + s * (x * x * a)) * x + s * (x * y * a) * y + - (s * x) * z) with
      (x * (1 + s * (a * (x * x + y * y)) - s * z)) by ring.
    rewrite L. replace (1 + s * (z - s) - s * z) with (1 - s * s) by ring. rewrite S. ring.
  - replace (x * y * a * x + (s + y * y * a) * y + - y * z) with (y * (a * (x * x + y * y) + s - z)) by ring.
    rewrite L. ring.
Qed.
End Frame.

(* ---- The same as computed ---- *)
Lemma tiny : bp (-150) <= / 1000000 * bp (-130) /\ bp (-130) <= / 1000000000000 * v /\ 0 < bp (-130).
Proof.
  split; [|split; [|apply bp_pos]].
  - apply Rle_trans with (bp (-20 + -130)); [apply bp_le; lia|]. rewrite bp_add. simpl (bp (-20)).
    pose proof (bp_pos (-130)). lra.
  - apply bp_part12. lia.
Qed.
Lemma product : forall x X a y Y b t, Rabs X <= 1 -> Rabs Y <= 1 -> 0 <= a <= 10 -> 0 <= b <= 10 ->
  bp (-130) <= t <= / 1000000 * v -> Rabs (x - X) <= a * v * Rabs X + t -> Rabs (y - Y) <= b * v * Rabs Y + t ->
  Rabs (RNs (x * y) - X * Y) <= (a + b + 1 + / 1000) * v * Rabs (X * Y) + 3 * t.
Proof.
  intros x X a y Y b t HX HY Ha Hb [T0 T1] Ex Ey. destruct tiny as (U1 & U2 & U3).
  pose proof (UNIT_holds (x * y)) as E. pose proof (Rabs_pos X) as X0. pose proof (Rabs_pos Y) as Y0.
  pose proof v_pos as V.
  assert (AY : Rabs y <= (1 + b * v) * Rabs Y + t).
  { replace y with ((y - Y) + Y) by ring. eapply Rle_trans; [apply Rabs_triang|]. lra. }
  rewrite (Rabs_mult x y) in E. rewrite (Rabs_mult X Y).
  assert (E1 : Rabs (x * y - X * Y) <= (a * v * Rabs X + t) * ((1 + b * v) * Rabs Y + t) + Rabs X * (b * v * Rabs Y
    + t)).
  { replace (x * y - X * Y) with ((x - X) * y + X * (y - Y)) by ring. eapply Rle_trans; [apply Rabs_triang|].
    rewrite !Rabs_mult. apply Rplus_le_compat; apply Rmult_le_compat; auto using Rabs_pos; lra. }
  assert (B0 : b * v <= / 1000000) by (rewrite v_val; lra). assert (A0 : a * v <= / 1000000) by (rewrite v_val; lra).
  assert (Aa : 0 <= a * v) by (apply Rmult_le_pos; lra). assert (Bb : 0 <= b * v) by (apply Rmult_le_pos; lra).
  set (A := a * v) in *. set (B := b * v) in *. set (P := Rabs X * Rabs Y) in *.
  assert (P0 : 0 <= P) by (apply Rmult_le_pos; assumption).
  assert (E2 : Rabs (x * y - X * Y) <= (A + B + A * B) * P + (2 + / 1000) * t).
  { eapply Rle_trans; [exact E1|]. replace ((A * Rabs X + t) * ((1 + B) * Rabs Y + t) + Rabs X * (B * Rabs Y + t)) with
      ((A + B + A * B) * P + t * (A * Rabs X + (1 + B) * Rabs Y + Rabs X + t)) by (unfold P; ring).
    apply Rplus_le_compat_l. rewrite Rmult_comm. apply Rmult_le_compat_r; [lra|].
    assert (A * Rabs X <= / 1000000 * 1) by (apply mul2; lra).
    assert ((1 + B) * Rabs Y <= (1 + / 1000000) * 1) by (apply mul2; lra).
    rewrite v_val in *. lra. }
  assert (P1 : A * B <= / 10000 * v).
  { unfold A, B. replace (a * v * (b * v)) with (a * b * v * v) by ring. apply Rmult_le_compat_r; [lra|].
    assert (a * b <= 10 * 10) by (apply mul2; lra). rewrite v_val in *. lra. }
  assert (P2 : A * B * P <= / 10000 * v * P) by (apply Rmult_le_compat_r; assumption).
  assert (XY : Rabs x * Rabs y <= (1 + / 10000) * P + 3 * t).
  { rewrite <- Rabs_mult. replace (x * y) with ((x * y - X * Y) + X * Y) by ring.
  eapply Rle_trans; [apply Rabs_triang|].
    rewrite (Rabs_mult X Y). fold P. assert ((A + B + A * B) * P <= / 10000 * P) by (apply Rmult_le_compat_r;
      [assumption|];
    assert (A * B <= / 1000000 * / 1000000) by (apply mul2; lra); lra). lra. }
  replace (RNs (x * y) - X * Y) with ((RNs (x * y) - x * y) + (x * y - X * Y)) by ring.
  eapply Rle_trans; [apply Rabs_triang|].
  assert (v * (Rabs x * Rabs y) <= v * ((1 + / 10000) * P + 3 * t)) by (apply Rmult_le_compat_l; lra).
  assert (V3 : v * (3 * t) <= / 1000 * t) by (rewrite v_val; lra).
  replace ((a + b + 1 + / 1000) * v * P) with (A * P + B * P + (1 + / 1000) * (v * P)) by (unfold A, B; ring).
  replace ((A + B + A * B) * P) with (A * P + B * P + A * B * P) in E2 by ring.
  replace (v * ((1 + / 10000) * P + 3 * t)) with ((1 + / 10000) * (v * P) + v * (3 * t)) in * by ring.
  assert (0 <= v * P) by (apply Rmult_le_pos; lra). lra.
Qed.
Section Computed.
(* the exact direction, that in f32, and the sign *)
Variables X Y Z x y z s : R.
Hypotheses (W : X * X + Y * Y + Z * Z = 1) (Hs : s = 1 \/ s = - 1) (Hz : 0 <= s * Z).
Let t := bp (-130).
Hypotheses (Hx : Rabs (x - X) <= (1 + / 1000) * v * Rabs X + t) (Hy : Rabs (y - Y) <= (1 + / 1000) * v * Rabs Y + t)
  (Hz2 : Rabs (z - Z) <= (1 + / 1000) * v * Rabs Z + t).
Let h := RNs (s + z).
Let a := RNs (- 1 / h).
Let b := RNs (RNs (x * y) * a).
Let a1 := RNs (1 + RNs (RNs (s * x * x) * a)).
Let b2 := RNs (s + RNs (RNs (y * y) * a)).
Let A := - / (s + Z).
Lemma XYZ_1 : Rabs X <= 1 /\ Rabs Y <= 1 /\ Rabs Z <= 1.
Proof. pose proof (sq_pos X). pose proof (sq_pos Y). pose proof (sq_pos Z). repeat split; apply abs_below; lra. Qed.
Lemma s_sq : s * s = 1. Proof. destruct Hs as [E|E]; rewrite E; ring. Qed.
Lemma s_abs : Rabs s = 1. Proof. destruct Hs as [E|E]; rewrite E; [apply Rabs_R1 | rewrite Rabs_left; lra]. Qed.
Lemma H_abs : Rabs (s + Z) = 1 + Rabs Z.
Proof.
  destruct Hs as [E|E]; rewrite E in *.
  - rewrite !Rabs_pos_eq by lra. lra.
  - rewrite (Rabs_left1 Z), Rabs_left1 by lra. lra.
Qed.
Lemma H_not0 : s + Z <> 0. Proof. intro E. pose proof H_abs as H. rewrite E, Rabs_R0 in H. pose proof (Rabs_pos Z).
lra. Qed.
Lemma A_H : A * (s + Z) = - 1. Proof. unfold A. field. exact H_not0. Qed.
Lemma A_abs : Rabs A * (1 + Rabs Z) = 1.
Proof. rewrite <- H_abs, <- Rabs_mult, A_H, Rabs_left; lra. Qed.
Lemma A_range : / 2 <= Rabs A <= 1.
Proof. pose proof A_abs as E. destruct XYZ_1 as (_ & _ & Z1). pose proof (Rabs_pos Z). pose proof (Rabs_pos A).
split; nra. Qed.
Lemma a_near : Rabs (a - A) <= (253 / 100) * v * Rabs A.
Proof.
  destruct tiny as (U1 & U2 & U3). fold t in U1, U2, U3. pose proof v_pos as V. destruct XYZ_1 as (_ & _ & Z1).
  pose proof (Rabs_pos Z) as Z0. pose proof H_abs as HH. pose proof (UNIT_holds (s + z)) as E. fold h in E.
  assert (VZ : 0 <= v * Rabs Z) by (apply Rmult_le_pos; lra).
  set (H := s + Z) in *. assert (zz : Rabs z <= (1 + 2 * v) * Rabs Z + t).
  { replace z with ((z - Z) + Z) by ring. eapply Rle_trans; [apply Rabs_triang|]. lra. }
  assert (SZ : Rabs (s + z) <= 1 + (1 + 2 * v) * Rabs Z + t) by (eapply Rle_trans; [apply Rabs_triang|];
    rewrite s_abs; lra).
  assert (EH : Rabs (h - H) <= (151 / 100) * v * Rabs H).
  { replace (h - H) with ((h - (s + z)) + (z - Z)) by (unfold H; ring). eapply Rle_trans; [apply Rabs_triang|].
    rewrite HH. assert (v * Rabs (s + z) <= v * (1 + (1 + 2 * v) * Rabs Z + t)) by (apply Rmult_le_compat_l; lra).
    rewrite v_val in *. lra. }
  assert (HL : (1 - 2 * v) * Rabs H <= Rabs h).
  { replace h with (H - - (h - H)) by ring. eapply Rle_trans; [|apply Rabs_triang_inv]. rewrite Rabs_Ropp. 
    assert (0 <= v * Rabs H) by (apply Rmult_le_pos; lra). lra. }
  assert (h0 : h <> 0) by (intro E0; rewrite E0, Rabs_R0 in HL; rewrite v_val in HL; lra).
  assert (Hn : H <> 0) by (apply H_not0).
  destruct A_range as [AL AU].
  assert (R : Rabs (- 1 / h - A) <= (152 / 100) * v * Rabs A).
  { replace (- 1 / h - A) with ((h - H) * A * - / h) by (unfold A; fold H; field; split; assumption).
    rewrite !Rabs_mult, Rabs_Ropp, Rabs_inv. assert (I : / Rabs h <= (1 + 3 * v) * / Rabs H).
    { assert (P : 0 < (1 - 2 * v) * Rabs H) by (apply Rmult_lt_0_compat; rewrite ?v_val; lra).
      apply Rle_trans with (/ ((1 - 2 * v) * Rabs H)); [now apply Rinv_le_contravar|]. rewrite Rinv_mult.
      apply Rmult_le_compat_r; [apply Rlt_le, Rinv_0_lt_compat; lra|]. rewrite v_val. lra. }
    assert (Rabs (h - H) * Rabs A * / Rabs h <= (151 / 100 * v * Rabs H) * Rabs A * ((1 + 3 * v) * / Rabs H)).
    { apply mul3; split; auto using Rabs_pos; try lra. apply Rlt_le, Rinv_0_lt_compat, Rabs_pos_lt. assumption. }
    replace ((151 / 100 * v * Rabs H) * Rabs A * ((1 + 3 * v) * / Rabs H)) with (151 / 100 * (1
      + 3 * v) * v * Rabs A) in *
      by (field; lra).
    assert (0 <= v * Rabs A) by (apply Rmult_le_pos; lra). rewrite v_val in *. lra. }
  pose proof (UNIT_holds (- 1 / h)) as Ea. fold a in Ea. set (i := - 1 / h) in *.
  assert (Ri : Rabs i <= (1 + 2 * v) * Rabs A).
  { replace i with ((i - A) + A) by ring. eapply Rle_trans; [apply Rabs_triang|].
    assert (0 <= v * Rabs A) by (apply Rmult_le_pos; lra). lra. }
  replace (a - A) with ((a - i) + (i - A)) by ring. eapply Rle_trans; [apply Rabs_triang|]. rewrite v_val in *. lra.
Qed.
Lemma triple : forall p P q Q c, Rabs P <= 1 -> Rabs Q <= 1 ->
  Rabs (p - P) <= (1 + / 1000) * v * Rabs P + t -> Rabs (q - Q) <= (1 + / 1000) * v * Rabs Q + t -> c = RNs (p * q) ->
  Rabs (RNs (c * a) - P * Q * A) <= (66 / 10) * v * Rabs (P * Q * A) + 9 * t.
Proof.
  intros p P q Q c HP HQ Ep Eq Hc. destruct tiny as (U1 & U2 & U3). fold t in U1, U2, U3.
  pose proof (product p P (1 + / 1000) q Q (1 + / 1000) t HP HQ ltac:(lra) ltac:(lra) ltac:(fold t; split;
    lra) Ep Eq) as E.
  rewrite <- Hc in E. assert (PQ : Rabs (P * Q) <= 1).
  { rewrite Rabs_mult, <- (Rmult_1_r 1). apply mul2; split; auto using Rabs_pos. }
  destruct A_range as [AL AU]. pose proof a_near as EA.
  assert (E' : Rabs (c - P * Q) <= (3 + / 100) * v * Rabs (P * Q) + 3 * t).
  { pose proof (Rabs_pos (P * Q)). pose proof v_pos. nra. }
  pose proof (product c (P * Q) (3 + / 100) a A (253 / 100) (3 * t) PQ AU ltac:(lra) ltac:(lra) ltac:(fold t; split;
    lra) E'
    ltac:(lra)) as E2.
  pose proof (Rabs_pos (P * Q * A)). pose proof v_pos. nra.
Qed.
(* the shares of the exact rows *)
Let al := X * X * Rabs A. Let ga := Y * Y * Rabs A. Let be := Rabs (X * Y) * Rabs A.
Lemma shares : 0 <= al /\ 0 <= ga /\ al + ga <= 1 /\ be * be = al * ga /\ 0 <= be.
Proof.
  pose proof A_range as [AL AU]. pose proof A_abs as E. pose proof (sq_pos X). pose proof (sq_pos Y).
  pose proof (Rabs_pos Z).
  unfold al, ga, be. split; [apply Rmult_le_pos; lra|]. split; [apply Rmult_le_pos; lra|]. split; [|split].
  - assert (N : X * X + Y * Y = (1 - Rabs Z) * (1 + Rabs Z)) by (replace ((1 - Rabs Z) * (1 + Rabs Z)) with
      (1 - Rabs Z * Rabs Z) by ring; rewrite abs_sq; lra).
    replace (X * X * Rabs A + Y * Y * Rabs A) with ((X * X + Y * Y) * Rabs A) by ring. rewrite N.
    replace ((1 - Rabs Z) * (1 + Rabs Z) * Rabs A) with ((1 - Rabs Z) * (Rabs A * (1 + Rabs Z))) by ring. rewrite E.
    lra.
  - replace (Rabs (X * Y) * Rabs A * (Rabs (X * Y) * Rabs A)) with (Rabs (X * Y) * Rabs (X * Y) * (Rabs A * Rabs A))
    by ring.
    rewrite abs_sq. ring.
  - apply Rmult_le_pos; auto using Rabs_pos.
Qed.
Lemma sA : s * A = - Rabs A.
Proof.
  unfold A. rewrite Rabs_Ropp, Rabs_inv. destruct Hs as [E|E]; rewrite E in *.
  - rewrite (Rabs_pos_eq (1 + Z)) by lra. ring.
  - rewrite (Rabs_left1 (-1 + Z)) by lra. rewrite Rinv_opp. ring.
Qed.
(* the rounded rows less the exact ones, entry by entry *)
Lemma entries : forall k, k = / 500 * v ->
  Rabs (a1 - (1 + s * (X * X * A))) <= v * (1 + (56 / 10) * al) + k /\
  Rabs (s * b - s * (X * Y * A)) <= (66 / 10) * v * be + k /\ Rabs (- (s * x) - - (s * X)) <= v * Rabs X + k /\
  Rabs (b - X * Y * A) <= (66 / 10) * v * be + k /\ Rabs (b2 - (s + Y * Y * A)) <= v * (1 + (56 / 10) * ga) + k /\
  Rabs (- y - - Y) <= v * Rabs Y + k /\ Rabs (x - X) <= v * Rabs X + k /\ Rabs (y - Y) <= v * Rabs Y + k /\
  Rabs (z - Z) <= v * Rabs Z + k.
Proof.
  intros k Hk. destruct tiny as (U1 & U2 & U3). fold t in U1, U2, U3. pose proof v_pos as V.
  destruct XYZ_1 as (X1 & Y1 & Z1).
  destruct shares as (S1 & S2 & S3 & S4 & S5). pose proof sA as SA.
  assert (B : Rabs (b - X * Y * A) <= (66 / 10) * v * be + k).
  { pose proof (triple x X y Y _ X1 Y1 Hx Hy eq_refl) as E. fold b in E. rewrite (Rabs_mult (X * Y)) in E.
  fold be in E. lra. }
  assert (XX : Rabs (x - X) <= v * Rabs X + k) by (rewrite v_val in *; lra).
  assert (YY : Rabs (y - Y) <= v * Rabs Y + k) by (rewrite v_val in *; lra).
  assert (ZZ : Rabs (z - Z) <= v * Rabs Z + k) by (rewrite v_val in *; lra).
  assert (SP : forall q, Rabs (s * q) = Rabs q) by (intro q; rewrite Rabs_mult, s_abs; ring).
  split; [|split; [|split; [|split; [|split; [|split; [|split; [|split]]]]]]]; try assumption.
  - assert (SX : Rabs (s * x - s * X) <= (1 + / 1000) * v * Rabs (s * X) + t).
    { replace (s * x - s * X) with (s * (x - X)) by ring. now rewrite !SP. }
    assert (SX1 : Rabs (s * X) <= 1) by (now rewrite SP).
    pose proof (triple (s * x) (s * X) x X _ SX1 X1 SX Hx eq_refl) as E. set (m := RNs (RNs (s * x * x) * a)) in *.
    assert (M : s * X * X * A = - al) by (unfold al; replace (s * X * X * A) with (X * X * (s * A)) by ring;
      rewrite SA; ring).
    rewrite M, Rabs_Ropp, (Rabs_pos_eq al) in E by assumption.
    replace (1 + s * (X * X * A)) with (1 + s * X * X * A) by ring. rewrite M.
    pose proof (UNIT_holds (1 + m)) as E2. fold a1 in E2.
    assert (M2 : Rabs (1 + m) <= 1 - al + / 1000000).
    { apply Rabs_le_inv in E. apply Rabs_le. rewrite v_val in *. lra. }
    replace (a1 - (1 + - al)) with ((a1 - (1 + m)) + (m - - al)) by ring. eapply Rle_trans; [apply Rabs_triang|].
    rewrite v_val in *. lra.
  - replace (s * b - s * (X * Y * A)) with (s * (b - X * Y * A)) by ring. now rewrite SP.
  - replace (- (s * x) - - (s * X)) with (- (s * (x - X))) by ring. now rewrite Rabs_Ropp, SP.
  - pose proof (triple y Y y Y _ Y1 Y1 Hy Hy eq_refl) as E. set (m := RNs (RNs (y * y) * a)) in *.
    assert (M : s * (Y * Y * A) = - ga) by (unfold ga; replace (s * (Y * Y * A)) with (Y * Y * (s * A)) by ring;
      rewrite SA;
      ring).
    assert (M' : Rabs (Y * Y * A) = ga) by (rewrite <- SP, M, Rabs_Ropp; now apply Rabs_pos_eq). rewrite M' in E.
    pose proof (UNIT_holds (s + m)) as E2. fold b2 in E2.
    assert (M2 : Rabs (s + m) <= 1 - ga + / 1000000).
    { rewrite <- SP. replace (s * (s + m)) with (s * s + s * m) by ring. rewrite s_sq.
      assert (Rabs (s * m - - ga) <= (66 / 10) * v * ga + 9 * t).
      { rewrite <- M. replace (s * m - s * (Y * Y * A)) with (s * (m - Y * Y * A)) by ring. now rewrite SP. }
      apply Rabs_le_inv in H. apply Rabs_le. rewrite v_val in *. lra. }
    replace (b2 - (s + Y * Y * A)) with ((b2 - (s + m)) + (m - Y * Y * A)) by ring.
    eapply Rle_trans; [apply Rabs_triang|].
    rewrite v_val in *. lra.
  - replace (- y - - Y) with (- (y - Y)) by ring. now rewrite Rabs_Ropp.
Qed.
Lemma sq_bound : forall p q, Rabs p <= q -> p * p <= q * q.
Proof. intros p q H. rewrite <- (abs_sq p). apply Rmult_le_compat; auto using Rabs_pos. Qed.
(* all errors of the frame: the root of their squares' sum *)
Let e1 p q r := (a1 - (1 + s * (X * X * A))) * p + (s * b - s * (X * Y * A)) * q + (- (s * x) - - (s * X)) * r.
Let e2 p q r := (b - X * Y * A) * p + (b2 - (s + Y * Y * A)) * q + (- y - - Y) * r.
Let e3 p q r := (x - X) * p + (y - Y) * q + (z - Z) * r.
Lemma frame_error : forall p q r, norm (e1 p q r) (e2 p q r) (e3 p q r) <= (77 / 10) * v * norm p q r.
Proof.
  intros p q r. destruct (entries _ eq_refl) as (H1 & H2 & H3 & H4 & H5 & H6 & H7 & H8 & H9). pose proof v_pos as V.
  destruct shares as (S1 & S2 & S3 & S4 & S5). pose proof (norm_pos p q r) as N0.
  apply norm_le; [apply Rmult_le_pos; [lra | assumption]|].
  pose proof (cauchy_schwarz (a1 - (1 + s * (X * X * A))) (s * b - s * (X * Y * A)) (- (s * x) - - (s * X)) p q r) as
    C1.
  pose proof (cauchy_schwarz (b - X * Y * A) (b2 - (s + Y * Y * A)) (- y - - Y) p q r) as C2.
  pose proof (cauchy_schwarz (x - X) (y - Y) (z - Z) p q r) as C3.
  apply sq_bound in H1, H2, H3, H4, H5, H6, H7, H8, H9. unfold e1, e2, e3.
  replace ((77 / 10) * v * norm p q r * ((77 / 10) * v * norm p q r)) with
    ((77 / 10) * v * ((77 / 10) * v) * (norm p q r * norm p q r)) by ring. rewrite norm_sq.
  pose proof (norm_arg p q r) as NA. set (n := p * p + q * q + r * r) in *.
  eapply Rle_trans; [apply Rplus_le_compat; [apply Rplus_le_compat; [exact C1 | exact C2] | exact C3]|].
  rewrite <- !Rmult_plus_distr_r. apply Rmult_le_compat_r; [assumption|].
  pose proof (abs_sq X) as QX. pose proof (abs_sq Y) as QY. pose proof (abs_sq Z) as QZ.
  destruct XYZ_1 as (X1 & Y1 & Z1). pose proof (Rabs_pos X). pose proof (Rabs_pos Y). pose proof (Rabs_pos Z).
  assert (B1 : be <= 1) by (apply below_root; [lra|]; rewrite S4; apply mul2; split; lra).
  assert (AG : 0 <= al * ga) by now apply Rmult_le_pos.
  (* in units of v^2 *)
  assert (V2 : 0 < v * v) by now apply Rmult_lt_0_compat.
  assert (Q : forall c, (v * c + / 500 * v) * (v * c + / 500 * v) = v * v * ((c + / 500) * (c + / 500))) by (intro;
    ring).
  replace ((66 / 10) * v * be) with (v * ((66 / 10) * be)) in * by ring. rewrite Q in *.
  set (K1 := (a1 - (1 + s * (X * X * A))) * (a1 - (1 + s * (X * X * A)))) in *.
  set (K2 := (s * b - s * (X * Y * A)) * (s * b - s * (X * Y * A))) in *.
  set (K3 := (- (s * x) - - (s * X)) * (- (s * x) - - (s * X))) in *.
  set (K4 := (b - X * Y * A) * (b - X * Y * A)) in *.
  set (K5 := (b2 - (s + Y * Y * A)) * (b2 - (s + Y * Y * A))) in *.
  set (K6 := (- y - - Y) * (- y - - Y)) in *. set (K7 := (x - X) * (x - X)) in *. set (K8 := (y - Y) * (y - Y)) in *.
  set (K9 := (z - Z) * (z - Z)) in *. clearbody K1 K2 K3 K4 K5 K6 K7 K8 K9.
  apply Rle_trans with (v * v * (((1 + (56 / 10) * al + / 500) * (1 + (56 / 10) * al + / 500) +
    2 * (((66 / 10) * be + / 500) * ((66 / 10) * be + / 500)) +
    (1 + (56 / 10) * ga + / 500) * (1 + (56 / 10) * ga + / 500)) + 2 * ((Rabs X + / 500) * (Rabs X + / 500)) +
    2 * ((Rabs Y + / 500) * (Rabs Y + / 500)) + (Rabs Z + / 500) * (Rabs Z + / 500))); [lra|].
  replace ((77 / 10) * v * ((77 / 10) * v)) with (v * v * (5929 / 100)) by field. apply Rmult_le_compat_l; [lra|].
  assert (T1 : al * al + ga * ga + 2 * (al * ga) <= 1).
  { replace (al * al + ga * ga + 2 * (al * ga)) with ((al + ga) * (al + ga)) by ring. rewrite <- (Rmult_1_r 1).
    apply mul2; split; lra. }
  assert (T2 : (Rabs X + / 500) * (Rabs X + / 500) <= X * X + / 200) by
    (replace ((Rabs X + / 500) * (Rabs X + / 500)) with (Rabs X * Rabs X + / 250 * Rabs X + / 250000) by field; lra).
  assert (T3 : (Rabs Y + / 500) * (Rabs Y + / 500) <= Y * Y + / 200) by
    (replace ((Rabs Y + / 500) * (Rabs Y + / 500)) with (Rabs Y * Rabs Y + / 250 * Rabs Y + / 250000) by field; lra).
  assert (T4 : (Rabs Z + / 500) * (Rabs Z + / 500) <= Z * Z + / 200) by
    (replace ((Rabs Z + / 500) * (Rabs Z + / 500)) with (Rabs Z * Rabs Z + / 250 * Rabs Z + / 250000) by field; lra).
  pose proof (sq_pos Z). pose proof (sq_pos al). pose proof (sq_pos ga).
  assert (T5 : ((66 / 10) * be + / 500) * ((66 / 10) * be + / 500) = 4356 / 100 * (al * ga) + 264 / 10000 * be
    + / 250000) by (rewrite <- S4; field). rewrite T5.
  assert (T6 : forall c, (1 + (56 / 10) * c + / 500) * (1 + (56 / 10) * c + / 500) = 1004004 / 1000000
    + (1002 / 1000) * (112 / 10) * c + 3136 / 100 * (c * c)) by (intro; field). rewrite !T6. lra.
Qed.
End Computed.

(* ---- The test ---- *)
(* <row|c> - <row|q>, in the order of the code *)
Definition talong c1 c2 c3 f1 f2 f3 q1 q2 q3 := let x x := X x 1 in
  Add (Mul (x c1) (x f1)) (Add (Mul (x c2) (x f2)) (Sub (Mul (x c3) (x f3)) (tdot (x f1) (x f2) (x f3) (x q1) (x q2)
    (x q3)))).
Lemma along_error : forall c1 c2 c3 f1 f2 f3 q1 q2 q3 p,
  norm c1 c2 c3 <= 1 + / 1000 -> norm f1 f2 f3 <= 1 + / 1000000 ->
  norm q1 q2 q3 <= 10725 / 10000 -> single (talong c1 c2 c3 f1 f2 f3 (RNs q1) (RNs q2) (RNs q3)) p ->
  Rabs (p - (f1 * (c1 - q1) + f2 * (c2 - q2) + f3 * (c3 - q3))) <= (136 / 10) * v.
Proof.
  intros c1 c2 c3 f1 f2 f3 q1 q2 q3 p Hc Hf Hq Hp. pose proof v_pos as V. destruct tiny as (U1 & U2 & U3).
  destruct (part_le c1 c2 c3) as (C1 & C2 & C3). destruct (part_le f1 f2 f3) as (F1 & F2 & F3).
  destruct (part_le q1 q2 q3) as (Q1 & Q2 & Q3). assert (b1 : bp 1 = 2) by (simpl; lra).
  pose proof (UNIT_holds q1) as E1. pose proof (UNIT_holds q2) as E2. pose proof (UNIT_holds q3) as E3.
  set (s1 := RNs q1) in *. set (s2 := RNs q2) in *. set (s3 := RNs q3) in *.
  assert (QE : norm (s1 - q1) (s2 - q2) (s3 - q3) <= (1075 / 1000) * v).
  { eapply Rle_trans; [eapply norm_monotone; eassumption|]. eapply Rle_trans; [apply norm_triangle|].
    rewrite norm_scaled, norm_abs, Rabs_pos_eq by lra.
    assert (norm (bp (-150)) (bp (-150)) (bp (-150)) <= 2 * bp (-150)).
    { pose proof (bp_pos (-150)). eapply Rle_trans; [apply (norm_equal _ _ _ (bp (-150))); try lra; rewrite Rabs_pos_eq;
      lra | lra]. }
    assert (v * norm q1 q2 q3 <= v * (10725 / 10000)) by (apply Rmult_le_compat_l; lra). rewrite v_val in *. lra. }
  assert (QS : norm s1 s2 s3 <= 1073 / 1000).
  { pose proof (norm_difference s1 s2 s3 q1 q2 q3). rewrite v_val in *. lra. }
  destruct (part_le s1 s2 s3) as (S1 & S2 & S3).
  assert (B : Rabs c1 <= bp 1 /\ Rabs c2 <= bp 1 /\ Rabs c3 <= bp 1 /\ Rabs f1 <= bp 1 /\ Rabs f2 <= bp 1 /\
    Rabs f3 <= bp 1 /\ Rabs s1 <= bp 1 /\ Rabs s2 <= bp 1 /\ Rabs s3 <= bp 1) by (rewrite b1; repeat split; lra).
  destruct B as (B1 & B2 & B3 & B4 & B5 & B6 & B7 & B8 & B9).
  assert (E : Rabs (p - (c1 * f1 + (c2 * f2 + (c3 * f3 - (f1 * s1 + f2 * s2 + f3 * s3))))) <= (1246 / 100) * v).
  { clear - Hp Hc Hf QS B1 B2 B3 B4 B5 B6 B7 B8 B9 V U1 U2 U3. unfold talong, tdot in Hp. error32_of Hp P.
    eapply Rle_trans; [exact P|]. pose proof (norm_pos c1 c2 c3). pose proof (norm_pos f1 f2 f3).
    pose proof (norm_pos s1 s2 s3).
    assert (N1 : Rabs c1 * Rabs f1 + Rabs c2 * Rabs f2 + Rabs c3 * Rabs f3 <= (1 + / 1000) * (1 + / 1000000)).
    { eapply Rle_trans; [apply Rle_abs|]. eapply Rle_trans; [apply dot_le|]. rewrite !norm_abs. apply mul2; lra. }
    assert (N2 : Rabs f1 * Rabs s1 + Rabs f2 * Rabs s2 + Rabs f3 * Rabs s3 <= (1 + / 1000000) * (1073 / 1000)).
    { eapply Rle_trans; [apply Rle_abs|]. eapply Rle_trans; [apply dot_le|]. rewrite !norm_abs. apply mul2; lra. }
    match goal with |- _ + bp ?k <= _ => assert (T : bp k <= bp (-130)) by (apply bp_le; lia) end.
    rewrite v_val in *. lra. }
  assert (D : Rabs (f1 * (s1 - q1) + f2 * (s2 - q2) + f3 * (s3 - q3)) <= (108 / 100) * v).
  { eapply Rle_trans; [apply dot_le|]. apply Rle_trans with ((1 + / 1000000) * (1075 / 1000 * v)).
    - apply mul2; split; auto using norm_pos.
    - lra. }
  replace (p - (f1 * (c1 - q1) + f2 * (c2 - q2) + f3 * (c3 - q3))) with ((p - (c1 * f1 + (c2 * f2
    + (c3 * f3 - (f1 * s1 +
    f2 * s2 + f3 * s3))))) - (f1 * (s1 - q1) + f2 * (s2 - q2) + f3 * (s3 - q3))) by ring.
  unfold Rminus at 1. eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. lra.
Qed.
(* The distance from a number to a range is no more than that to a number in the range. *)
Lemma clamp_near : forall p start last tau, start <= tau <= last ->
  Rabs (p - Rmin (Rmax p start) last) <= Rabs (p - tau).
Proof.
  intros p start last tau H. unfold Rmin, Rmax.
  destruct (Rle_dec p start); destruct Rle_dec; unfold Rabs; repeat destruct Rcase_abs; lra.
Qed.
(* The comparison: lengths that differ by 20 v. *)
Lemma comparison : forall p1 p2 p3 m r up q, norm p1 p2 p3 <= (1 + 2 * v) * m + bp (-140) -> 0 <= m <= 12 / 10 ->
  0 <= r <= 11 / 10 -> 0 <= up <= / 10 -> m + 18 * v <= r + up + BALL_SLACK * v ->
  single (Add (Mul (X p1 3) (X p1 3)) (Add (Mul (X p2 3) (X p2 3)) (Mul (X p3 3) (X p3 3)))) q ->
  let reach := RNs (r + RNs (BALL_SLACK * v + up)) in q <= RNs (reach * reach).
Proof.
  intros p1 p2 p3 m r up q HN Hm Hr Hup HM Hq reach. pose proof v_pos as V. destruct tiny as (U1 & U2 & U3).
  destruct (part_le p1 p2 p3) as (L1 & L2 & L3). assert (b3 : bp 3 = 8) by (simpl; lra).
  assert (T : bp (-140) <= / 1000 * bp (-130)) by (apply Rle_trans with (bp (-10 + -130)); [apply bp_le; lia|];
    rewrite bp_add; simpl (bp (-10)); lra).
  assert (N2 : norm p1 p2 p3 <= 2) by (rewrite v_val in *; lra).
  assert (B : Rabs p1 <= bp 3 /\ Rabs p2 <= bp 3 /\ Rabs p3 <= bp 3) by (rewrite b3; repeat split; lra).
  destruct B as (B1 & B2 & B3). pose proof (norm_sq p1 p2 p3) as NN. pose proof (norm_pos p1 p2 p3) as N0.
  set (n := norm p1 p2 p3) in *.
  assert (Q : q <= (1 + (3 + / 100) * v) * (n * n) + bp (-130)).
  { clear - Hq B1 B2 B3 NN V. error32_of Hq P. rewrite !abs_sq in P.
  replace (p1 * p1 + (p2 * p2 + p3 * p3)) with (n * n)
      in P by lra.
    match type of P with _ <= _ + bp ?k => assert (T : bp k <= bp (-130)) by (apply bp_le; lia) end.
    apply Rabs_le_inv in P. pose proof (sq_pos n). rewrite v_val in *. lra. }
  pose proof (UNIT_holds (BALL_SLACK * v + up)) as E1. set (slack := RNs (BALL_SLACK * v + up)) in *.
  unfold BALL_SLACK in *. rewrite (Rabs_pos_eq (64 * v + up)) in E1 by lra. apply Rabs_le_inv in E1.
  pose proof (UNIT_holds (r + slack)) as E2. fold reach in E2.
  assert (S0 : 0 <= slack) by (rewrite v_val in *; lra). rewrite (Rabs_pos_eq (r + slack)) in E2 by lra.
  apply Rabs_le_inv in E2. assert (R1 : m + 16 * v <= reach) by (rewrite v_val in *; lra).
  pose proof (UNIT_holds (reach * reach)) as E3. rewrite (Rabs_pos_eq (reach * reach)) in E3 by apply sq_pos.
  apply Rabs_le_inv in E3.
  assert (R2 : (m + 16 * v) * (m + 16 * v) <= reach * reach) by (apply mul2; split; lra).
  assert (N3 : n * n <= ((1 + 2 * v) * m + bp (-140)) * ((1 + 2 * v) * m + bp (-140))) by (apply mul2; split; lra).
  assert (tp : 0 < bp (-140)) by apply bp_pos. set (t := bp (-140)) in *. clearbody t.
  assert (t0 : 0 <= v * m) by (apply Rmult_le_pos; lra).
  assert (N4 : ((1 + 2 * v) * m + t) * ((1 + 2 * v) * m + t) <= (m + (25 / 10) * v) * (m + (25 / 10) * v)).
  { apply mul2; split; rewrite v_val in *; lra. }
  replace ((m + 16 * v) * (m + 16 * v)) with (m * m + 32 * (v * m) + 256 * (v * v)) in R2 by ring.
  replace ((m + (25 / 10) * v) * (m + (25 / 10) * v)) with (m * m + 5 * (v * m) + (625 / 100) * (v * v)) in N4 by field.
  assert (MM : m * m <= (12 / 10) * m) by (apply Rmult_le_compat_r; lra).
  assert (VM : v * (m * m) <= (12 / 10) * (v * m)) by (rewrite <- (Rmult_assoc (12 / 10)), (Rmult_comm (12 / 10) v),
    Rmult_assoc; apply Rmult_le_compat_l; lra).
  assert (T2 : bp (-130) <= / 1000 * (v * v)) by (unfold UNIT; rewrite bp_sq; apply Rle_trans with (bp (-10 + -48));
    [apply bp_le; lia | rewrite bp_add; pose proof (bp_pos (-48)); simpl (bp (-10)); simpl (-24 + -24)%Z; lra]).
  assert (V2 : 0 < v * v) by now apply Rmult_lt_0_compat.
  set (vm := v * m) in *. set (vv := v * v) in *. set (mm := m * m) in *.
  assert (Q2 : q <= (1 + (3 + / 100) * v) * (mm + 5 * vm + (625 / 100) * vv) + bp (-130)).
  { eapply Rle_trans; [exact Q|]. apply Rplus_le_compat_r. apply Rmult_le_compat_l; [lra|]. lra. }
  assert (VVM : v * vm <= / 1000000 * vm) by (apply Rmult_le_compat_r; [assumption | rewrite v_val; lra]).
  assert (VVV : v * vv <= / 1000000 * vv) by (apply Rmult_le_compat_r; [lra | rewrite v_val; lra]).
  assert (RR : (1 - v) * (mm + 32 * vm + 256 * vv) - bp (-150) <= RNs (reach * reach)).
  { assert ((1 - v) * (mm + 32 * vm + 256 * vv) <= (1 - v) * (reach * reach)) by (apply Rmult_le_compat_l;
      [rewrite v_val; lra | assumption]). lra. }
  replace ((1 - v) * (mm + 32 * vm + 256 * vv)) with (mm + 32 * vm + 256 * vv - v * mm - 32 * (v * vm) - 256 * (v * vv))
    in RR by ring.
  replace ((1 + (3 + / 100) * v) * (mm + 5 * vm + (625 / 100) * vv)) with (mm + 5 * vm + (625 / 100) * vv + (3
    + / 100) *
    (v * mm) + (3 + / 100) * 5 * (v * vm) + (3 + / 100) * (625 / 100) * (v * vv)) in Q2 by ring.
  lra.
Qed.

(* A ball (center c, radius r) that holds a point P with |P - X| <= R and R + |X - c| <= r,
  where the line passes P at tau
   between start and last, up to err: it is kept. *)
Theorem BALL_SLACK_holds : forall W1 W2 W3 x y z s c1 c2 c3 q1 q2 q3 tau start last r err up p1 p2 p3 q,
  W1 * W1 + W2 * W2 + W3 * W3 = 1 -> s = 1 \/ s = - 1 -> 0 <= s * W3 ->
  Rabs (x - W1) <= (1 + / 1000) * v * Rabs W1 + bp (-130) -> Rabs (y - W2) <= (1 + / 1000) * v * Rabs W2 + bp (-130) ->
  Rabs (z - W3) <= (1 + / 1000) * v * Rabs W3 + bp (-130) ->
  norm c1 c2 c3 <= 1 + / 1000 -> norm q1 q2 q3 <= 10725 / 10000 -> 0 <= r <= 1
    + / 100 -> 0 <= err <= up -> up <= / 10 ->
  norm (c1 - (q1 + tau * W1)) (c2 - (q2 + tau * W2)) (c3 - (q3 + tau * W3)) <= r + err -> start <= tau <= last ->
  let a := RNs (- 1 / RNs (s + z)) in let b := RNs (RNs (x * y) * a) in
  let a1 := RNs (1 + RNs (RNs (s * x * x) * a)) in let b2 := RNs (s + RNs (RNs (y * y) * a)) in
  let along f1 f2 f3 := talong c1 c2 c3 f1 f2 f3 (RNs q1) (RNs q2) (RNs q3) in
  single (along a1 (s * b) (- (s * x))) p1 -> single (along b b2 (- y)) p2 -> single (along x y z) p3 ->
  let beyond := RNs (p3 - Rmin (Rmax p3 start) last) in
  single (Add (Mul (X p1 3) (X p1 3)) (Add (Mul (X p2 3) (X p2 3)) (Mul (X beyond 3) (X beyond 3)))) q ->
  let reach := RNs (r + RNs (BALL_SLACK * v + up)) in q <= RNs (reach * reach).
Proof.
  intros W1 W2 W3 x y z s c1 c2 c3 q1 q2 q3 tau start last r err up p1 p2 p3 q HW Hs Hz Hx Hy Hz2 Hc Hq Hr Herr Hup Hhit
    Hseg a b a1 b2 along H1 H2 H3 beyond Hsq reach.
  pose proof v_pos as V. destruct tiny as (U1 & U2 & U3). set (A := - / (s + W3)).
  assert (SS : s * s = 1) by (now apply s_sq). assert (AH : A * (s + W3) = - 1) by (now apply A_H).
  pose proof (frame_error W1 W2 W3 x y z s HW Hs Hz Hx Hy Hz2) as FE. cbv zeta in FE. fold a in FE. fold b in FE.
  fold a1 in FE. fold b2 in FE. fold A in FE.
  pose proof (frame_length W1 W2 W3 s A HW SS AH) as FL. destruct (frame_third W1 W2 W3 s A HW SS AH) as (T1 & T2 & T3).
  set (u1 := 1 + s * (W1 * W1 * A)) in *. set (u2 := s * (W1 * W2 * A)) in *. set (u3 := - (s * W1)) in *.
  set (u4 := W1 * W2 * A) in *. set (u5 := s + W2 * W2 * A) in *. set (u6 := - W2) in *.
  (* rows are no longer than 1, and their errors 7.7 v *)
  assert (self : forall n k, 0 <= n -> 0 <= k -> n * n <= k * n -> n <= k).
  { intros n k N0 K0 S. destruct (Rle_or_lt n k) as [L|L]; [assumption|]. nra. }
  assert (R1 : norm u1 u2 u3 <= 1).
  { apply self; try apply norm_pos; [lra|]. rewrite norm_sq, Rmult_1_l, <- FL.
    destruct (part_le (row1 W1 W2 s A u1 u2 u3) (row2 W1 W2 s A u1 u2 u3) (row3 W1 W2 W3 u1 u2 u3)) as (L & _ & _).
    apply Rle_trans with (2 := L). apply Rle_trans with (2 := Rle_abs _). right. unfold row1, u1, u2, u3, u4. ring. }
  assert (R2 : norm u4 u5 u6 <= 1).
  { apply self; try apply norm_pos; [lra|]. rewrite norm_sq, Rmult_1_l, <- FL.
    destruct (part_le (row1 W1 W2 s A u4 u5 u6) (row2 W1 W2 s A u4 u5 u6) (row3 W1 W2 W3 u4 u5 u6)) as (_ & L & _).
    apply Rle_trans with (2 := L). apply Rle_trans with (2 := Rle_abs _). right. unfold row2, u4, u5, u6. ring. }
  assert (R3 : norm W1 W2 W3 <= 1) by (apply norm_le; lra).
  set (e11 := a1 - u1) in *. set (e12 := s * b - u2) in *. set (e13 := - (s * x) - u3) in *.
  set (e21 := b - u4) in *. set (e22 := b2 - u5) in *. set (e23 := - y - u6) in *.
  set (e31 := x - W1) in *. set (e32 := y - W2) in *. set (e33 := z - W3) in *.
  assert (K : 0 <= (77 / 10) * v) by lra.
  assert (E1 : norm e11 e12 e13 <= (77 / 10) * v).
  { apply self; try apply norm_pos; [assumption|]. rewrite norm_sq. eapply Rle_trans; [|apply FE].
    match goal with |- _ <= norm ?p ?q ?r => destruct (part_le p q r) as (L & _ & _) end.
    apply Rle_trans with (2 := L). apply Rle_trans with (2 := Rle_abs _). right. ring. }
  assert (E2 : norm e21 e22 e23 <= (77 / 10) * v).
  { apply self; try apply norm_pos; [assumption|]. rewrite norm_sq. eapply Rle_trans; [|apply FE].
    match goal with |- _ <= norm ?p ?q ?r => destruct (part_le p q r) as (_ & L & _) end.
    apply Rle_trans with (2 := L). apply Rle_trans with (2 := Rle_abs _). right. ring. }
  assert (E3 : norm e31 e32 e33 <= (77 / 10) * v).
  { apply self; try apply norm_pos; [assumption|]. rewrite norm_sq. eapply Rle_trans; [|apply FE].
    match goal with |- _ <= norm ?p ?q ?r => destruct (part_le p q r) as (_ & _ & L) end.
    apply Rle_trans with (2 := L). apply Rle_trans with (2 := Rle_abs _). right. ring. }
  assert (G : 1 + (77 / 10) * v <= 1 + / 1000000) by (rewrite v_val; lra).
  pose proof (norm_difference a1 (s * b) (- (s * x)) u1 u2 u3) as D1. fold e11 e12 e13 in D1.
  pose proof (norm_difference b b2 (- y) u4 u5 u6) as D2. fold e21 e22 e23 in D2.
  pose proof (norm_difference x y z W1 W2 W3) as D3. fold e31 e32 e33 in D3.
  pose proof (along_error c1 c2 c3 a1 (s * b) (- (s * x)) q1 q2 q3 p1 Hc ltac:(lra) Hq H1) as P1.
  pose proof (along_error c1 c2 c3 b b2 (- y) q1 q2 q3 p2 Hc ltac:(lra) Hq H2) as P2.
  pose proof (along_error c1 c2 c3 x y z q1 q2 q3 p3 Hc ltac:(lra) Hq H3) as P3.
  (* the center from the nearest point, and from the point at tau *)
  set (g1 := c1 - q1) in *. set (g2 := c2 - q2) in *. set (g3 := c3 - q3) in *.
  assert (NG : norm g1 g2 g3 <= 20737 / 10000).
  { pose proof (norm_triangle c1 c2 c3 (- q1) (- q2) (- q3)) as T. rewrite norm_opp in T. unfold g1, g2, g3, Rminus.
  lra. }
  pose proof (FE g1 g2 g3) as FEG. cbv beta in FEG.
  set (w1 := c1 - (q1 + tau * W1)) in *. set (w2 := c2 - (q2 + tau * W2)) in *. set (w3 := c3 - (q3 + tau * W3)) in *.
  pose proof (FL w1 w2 w3) as FLW.
  assert (M1 : row1 W1 W2 s A w1 w2 w3 = u1 * g1 + u2 * g2 + u3 * g3).
  { replace (u1 * g1 + u2 * g2 + u3 * g3) with (row1 W1 W2 s A g1 g2 g3 - tau * row1 W1 W2 s A W1 W2 W3).
    - unfold row1, w1, w2, w3, g1, g2, g3. ring.
    - rewrite T1. unfold row1, u1, u2, u3, u4. ring. }
  assert (M2 : row2 W1 W2 s A w1 w2 w3 = u4 * g1 + u5 * g2 + u6 * g3).
  { replace (u4 * g1 + u5 * g2 + u6 * g3) with (row2 W1 W2 s A g1 g2 g3 - tau * row2 W1 W2 s A W1 W2 W3).
    - unfold row2, w1, w2, w3, g1, g2, g3. ring.
    - rewrite T2. unfold row2, u4, u5, u6. ring. }
  assert (M3 : row3 W1 W2 W3 w1 w2 w3 = W1 * g1 + W2 * g2 + W3 * g3 - tau).
  { replace (W1 * g1 + W2 * g2 + W3 * g3 - tau) with (row3 W1 W2 W3 g1 g2 g3 - tau * row3 W1 W2 W3 W1 W2 W3).
    - unfold row3, w1, w2, w3, g1, g2, g3. ring.
    - rewrite T3. unfold row3. ring. }
  rewrite M1, M2, M3 in FLW.
  assert (N : norm p1 p2 (p3 - tau) <= r + err + (396 / 10) * v).
  { eapply Rle_trans; [apply (norm_difference _ _ _ (u1 * g1 + u2 * g2 + u3 * g3) (u4 * g1 + u5 * g2 + u6 * g3)
      (W1 * g1 + W2 * g2 + W3 * g3 - tau))|].
    rewrite FLW.
    assert (N2 : norm (p1 - (u1 * g1 + u2 * g2 + u3 * g3)) (p2 - (u4 * g1 + u5 * g2 + u6 * g3))
      (p3 - tau - (W1 * g1 + W2 * g2 + W3 * g3 - tau)) <= (396 / 10) * v); [|lra].
    eapply Rle_trans; [apply (norm_difference _ _ _ (e11 * g1 + e12 * g2 + e13 * g3) (e21 * g1 + e22 * g2 + e23 * g3)
      (e31 * g1 + e32 * g2 + e33 * g3))|].
    assert (N3 : norm (p1 - (u1 * g1 + u2 * g2 + u3 * g3) - (e11 * g1 + e12 * g2 + e13 * g3))
      (p2 - (u4 * g1 + u5 * g2 + u6 * g3) - (e21 * g1 + e22 * g2 + e23 * g3))
      (p3 - tau - (W1 * g1 + W2 * g2 + W3 * g3 - tau) - (e31 * g1 + e32 * g2 + e33 * g3)) <=
      17321 / 10000 * ((136 / 10) * v)).
    { apply norm_equal; [lra | | |].
      - replace (p1 - (u1 * g1 + u2 * g2 + u3 * g3) - (e11 * g1 + e12 * g2 + e13 * g3)) with
          (p1 - (a1 * g1 + s * b * g2 + - (s * x) * g3)) by (unfold e11, e12, e13; ring). exact P1.
      - replace (p2 - (u4 * g1 + u5 * g2 + u6 * g3) - (e21 * g1 + e22 * g2 + e23 * g3)) with
          (p2 - (b * g1 + b2 * g2 + - y * g3)) by (unfold e21, e22, e23; ring). exact P2.
      - replace (p3 - tau - (W1 * g1 + W2 * g2 + W3 * g3 - tau) - (e31 * g1 + e32 * g2 + e33 * g3)) with
          (p3 - (x * g1 + y * g2 + z * g3)) by (unfold e31, e32, e33; ring). exact P3. }
    assert ((77 / 10) * v * norm g1 g2 g3 <= (77 / 10) * v * (20737 / 10000)) by (apply Rmult_le_compat_l;
      assumption). lra. }
  set (m := r + err + (396 / 10) * v) in *.
  assert (NB : norm p1 p2 beyond <= (1 + 2 * v) * m + bp (-140)).
  { pose proof (UNIT_holds (p3 - Rmin (Rmax p3 start) last)) as E. fold beyond in E.
    pose proof (clamp_near p3 start last tau Hseg) as C. set (d := p3 - Rmin (Rmax p3 start) last) in *.
    assert (BD : Rabs beyond <= Rabs (p3 - tau) + (v * Rabs (p3 - tau) + bp (-150))).
    { replace beyond with ((beyond - d) + d) by ring. eapply Rle_trans; [apply Rabs_triang|].
      assert (v * Rabs d <= v * Rabs (p3 - tau)) by (apply Rmult_le_compat_l; lra). lra. }
    assert (L : norm p1 p2 beyond <= norm (Rabs p1 + 0) (Rabs p2 + 0) (Rabs (p3 - tau) + (v * Rabs (p3 - tau)
      + bp (-150)))).
    { apply norm_monotone; lra. }
    eapply Rle_trans; [exact L|]. eapply Rle_trans; [apply norm_triangle|]. rewrite norm_abs.
    assert (L2 : norm 0 0 (v * Rabs (p3 - tau) + bp (-150)) <= v * Rabs (p3 - tau) + bp (-150)).
    { eapply Rle_trans; [apply norm_le_sum|]. rewrite Rabs_R0, Rabs_pos_eq; [lra|]. pose proof (Rabs_pos (p3 - tau)).
      pose proof (bp_pos (-150)). assert (0 <= v * Rabs (p3 - tau)) by (apply Rmult_le_pos; lra). lra. }
    destruct (part_le p1 p2 (p3 - tau)) as (_ & _ & L3).
    assert (v * Rabs (p3 - tau) <= v * m) by (apply Rmult_le_compat_l; lra).
    assert (bp (-150) <= bp (-140)) by (apply bp_le; lia). assert (0 <= v * m) by (apply Rmult_le_pos; unfold m; lra).
    lra. }
  apply (comparison p1 p2 beyond m r up q NB); try lra; try assumption; unfold m, BALL_SLACK; rewrite ?v_val; try lra.
Qed.
