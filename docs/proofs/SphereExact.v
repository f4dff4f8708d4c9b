(* rt-geom, sphere/exact.rs: the verdict in double-double, `double_double_roots` and `double_double_side`. *)
From Proofs Require Import Rounding DoubleDouble Twice Sphere.
Open Scope R_scope.

(* Up to here in magnitude the coordinates relative to the center, and the radius, may be. *)
Definition FARTHEST := bp 300.
(* Swallows all errors of underflow. *)
Definition UNDERFLOW := bp (-500).
(* The errors of delta and of the side, relative to what they are made of. *)
Definition DELTA_ERROR := 32 * u * u.
Definition SIDE_ERROR := 32 * u * u.

(* A coordinate that is below FARTHEST as computed is below 2^301. *)
Theorem FARTHEST_holds : forall x y, F x -> F y -> Rabs (RN (x - y)) <= FARTHEST -> bounded (D x y 301).
Proof.
  intros x y Fx Fy H. cbn [bounded]. pose proof (RN_diff x y Fx Fy) as Q. unfold FARTHEST in H.
  assert (F2 : bp 301 = 2 * bp 300) by (change 301%Z with (1 + 300)%Z; rewrite bp_add, bp_1; ring).
  pose proof (Rabs_triang (RN (x - y)) (- (RN (x - y) - (x - y)))) as T.
  replace (RN (x - y) + - (RN (x - y) - (x - y))) with (x - y) in T by ring. rewrite Rabs_Ropp in T.
  pose proof (bp_pos 300). rewrite u_val in Q. lra.
Qed.

Section SphereExact.
Variables o1 o2 o3 c1 c2 c3 r d1 d2 d3 : R.
Let W1 := o1 - c1. Let W2 := o2 - c2. Let W3 := o3 - c3.
Let A := d1 * d1 + d2 * d2 + d3 * d3.
Let WW := W1 * W1 + W2 * W2 + W3 * W3.
Let X1 := W2 * d3 - W3 * d2. Let X2 := W3 * d1 - W1 * d3. Let X3 := W1 * d2 - W2 * d1.
Let XX2 := X1 * X1 + X2 * X2 + X3 * X3.
Let Delta := A * (r * r) - XX2.
Hypotheses (HW1 : Rabs W1 <= bp 301) (HW2 : Rabs W2 <= bp 301) (HW3 : Rabs W3 <= bp 301) (Hr : Rabs r <= bp 301)
  (Hd1 : Rabs d1 <= bp 100) (Hd2 : Rabs d2 <= bp 100) (Hd3 : Rabs d3 <= bp 100).
Let w1 := D o1 c1 301. Let w2 := D o2 c2 301. Let w3 := D o3 c3 301.
Definition tww := tdot w1 w2 w3 w1 w2 w3.
Definition tr := XX r r 602.
Definition tside := Sub tww tr.
Definition ta := Add (Add (XX d1 d1 200) (XX d2 d2 200)) (XX d3 d3 200).
Definition treach a := Mul (X a 203) tr.
Definition tx a b c d := Sub (Mul a (X b 100)) (Mul c (X d 100)).
Definition tx1 := tx w2 d3 w3 d2. Definition tx2 := tx w3 d1 w1 d3. Definition tx3 := tx w1 d2 w2 d1.
Definition tsquare x1 x2 x3 := let x y := X y 410 in tdot (x x1) (x x2) (x x3) (x x1) (x x2) (x x3).
Ltac terms := unfold tside, treach, tsquare, tx1, tx2, tx3, tx, ta, tr, tww, tdot, w1, w2, w3 in *.

Lemma squares_bounded : forall x k, Rabs x <= bp k -> Rabs (x * x) <= bp (k + k).
Proof. intros. rewrite Rabs_mult, bp_add. apply Rmult_le_compat; auto using Rabs_pos. Qed.

(* |w|^2 - r^2 is off by at most 32 u^2 (|w|^2 + r^2) + 2^-500, where sums of the high parts stand for the exact
  squares:
   the sign of the high part is certain beyond. *)
Theorem SIDE_ERROR_holds : forall h l s e, dd h l -> twice tside (h + l) -> (1 - 4 * u) * (WW + r * r) <= s ->
  (1 - 8 * u) * (SIDE_ERROR * s + UNDERFLOW) <= e ->
  (h > e -> 0 < WW - r * r) /\ (h < - e -> WW - r * r < 0).
Proof.
  intros h l s e Hd Ht Hs He. apply high_sign with (l := l); auto.
  assert (B : bounded tside) by (terms; cbn [bounded]; repeat split; try assumption; now apply (squares_bounded r 301)).
  pose proof (twice_error_at tside _ 27 (low2 tside) Ht B eq_refl eq_refl ltac:(lia)) as Q.
  assert (S : size tside = WW + r * r).
  { terms. cbn [size]. fold W1 W2 W3. rewrite !abs_sq. rewrite (Rabs_pos_eq (r * r)) by apply sq_pos. reflexivity. }
  rewrite S in Q. assert (LT : bp (low2 tside) <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; vm_compute;
    discriminate).
  assert (U0 : 0 < UNDERFLOW) by apply bp_pos. unfold SIDE_ERROR in He.
  assert (0 <= WW + r * r) by (unfold WW; pose proof (sq_pos W1); pose proof (sq_pos W2); pose proof (sq_pos W3);
    pose proof (sq_pos r); lra).
  change (exact tside) with (WW - r * r) in Q. eapply Rle_trans; [exact Q|].
  set (G := WW + r * r) in *. clearbody G. rewrite u_val in *. lra.
Qed.

(* delta, of a d.d r^2 and an |x|^2 that are computed, is off by at most
   32 u^2 (d.d r^2 + |x|^2 + M (sum |x_i| + 32 u^2 M)) + 2^-500 with M = 2 D max |w_i|. *)
Variables (m a x1 x2 x3 xx ar delta : R).
Hypotheses (Hx1 : twice tx1 x1) (Hx2 : twice tx2 x2) (Hx3 : twice tx3 x3) (Hxx : twice (tsquare x1 x2 x3) xx)
  (Ha : twice ta a) (Hlong : bp (-200) <= A) (Har : twice (treach a) ar) (Hdelta : Rabs (delta - (ar - xx)) <= 6 * (u
    * u) * Rabs (ar - xx)).
Hypotheses (M0 : 0 <= m <= bp 402)
  (M1 : Rabs W2 * Rabs d3 + Rabs W3 * Rabs d2 <= m) (M2 : Rabs W3 * Rabs d1 + Rabs W1 * Rabs d3 <= m)
  (M3 : Rabs W1 * Rabs d2 + Rabs W2 * Rabs d1 <= m).

Lemma square_error : Rabs (a - A) <= (12 + / 500) * (u * u) * A /\ 0 < a /\ Rabs a <= bp 203.
Proof.
  assert (B : bounded ta) by (terms; cbn [bounded]; repeat split; now apply (squares_bounded _ 100)).
  pose proof (twice_error_at ta a 12 (low2 ta) Ha B eq_refl eq_refl ltac:(lia)) as Q. destruct (top_ok ta B) as [_ T].
  assert (S : size ta = A) by (terms; cbn [size]; rewrite !(Rabs_pos_eq (_ * _)) by apply sq_pos; reflexivity).
  rewrite S in *. change (exact ta) with A in Q.
  assert (L : bp (low2 ta) <= / 1000 * (u * u) * bp (-200)).
  { apply Rle_trans with (bp (-10) * (u * u) * bp (-200)).
    - unfold u. rewrite <- !bp_add. apply bp_le. vm_compute. discriminate.
    - apply Rmult_le_compat_r; [apply Rlt_le, bp_pos|]. apply Rmult_le_compat_r; [rewrite u_val; lra | simpl; lra]. }
  pose proof (bp_pos (-200)). assert (E : Rabs (a - A) <= (12 + / 500) * (u * u) * A) by (clearbody A;
    rewrite u_val in *; lra).
  split; [exact E|]. apply Rabs_le_inv in E. assert (A0 : 0 < a) by (clearbody A; rewrite u_val in *; lra).
  split; [exact A0|].
  rewrite Rabs_pos_eq by lra. change (top ta) with 202%Z in T.
  assert (F3 : bp 203 = 2 * bp 202) by (change 203%Z with (1 + 202)%Z; rewrite bp_add, bp_1; ring).
  clearbody A. rewrite u_val in *. lra.
Qed.

Lemma component : forall x X t, twice t x -> bounded t -> Z.of_nat (count2 t) = 15%Z -> (low2 t <= -960)%Z -> exact t
  = X ->
  size t <= m -> Rabs (x * x - X * X) <= (30 + / 100) * (u * u) * (m * Rabs x) + 226 * (u * u * (u * u)) * (m * m) +
    bp (-540) /\
    Rabs x <= bp 410.
Proof.
  intros x X t H B N L EX S. pose proof (twice_error_at t x 15 (low2 t) H B N eq_refl ltac:(lia)) as Q. rewrite EX in Q.
  pose proof (bp_le _ _ L) as T. pose proof (top_ok t B) as [V _]. rewrite EX in V. pose proof (Rabs_pos X).
  assert (Q2 : Rabs (x - X) <= (15 + / 1000) * (u * u) * m + bp (-960)).
  { assert ((15 + / 1000) * (u * u) * size t <= (15 + / 1000) * (u * u) * m) by (apply Rmult_le_compat_l;
    [rewrite u_val; lra | assumption]). lra. }
  assert (X410 : Rabs x <= bp 404).
  { replace x with ((x - X) + X) by ring. eapply Rle_trans; [apply Rabs_triang|].
    assert (bp (-960) <= bp 402) by (apply bp_le; lia).
    assert (bp 404 = 4 * bp 402) by (change 404%Z with (2 + 402)%Z; rewrite bp_add; simpl (bp 2); lra).
    assert ((15 + / 1000) * (u * u) * m <= 1 * m) by (apply Rmult_le_compat_r; [lra | rewrite u_val; lra]). lra. }
  split; [|eapply Rle_trans; [exact X410 | apply bp_le; lia]].
  replace (x * x - X * X) with (2 * (x * (x - X)) - (x - X) * (x - X)) by ring.
  unfold Rminus at 1. eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp, !Rabs_mult, (Rabs_pos_eq 2) by lra.
  set (k := (15 + / 1000) * (u * u)) in *. set (t0 := bp (-960)) in *.
  assert (K0 : 0 <= k <= 1) by (unfold k; rewrite u_val; lra). assert (T0 : 0 < t0) by apply bp_pos.
  assert (I1 : Rabs x * Rabs (x - X) <= Rabs x * (k * m + t0)) by (apply Rmult_le_compat_l;
    [apply Rabs_pos | assumption]).
  assert (I2 : Rabs (x - X) * Rabs (x - X) <= (k * m + t0) * (k * m + t0)) by (apply Rmult_le_compat;
    auto using Rabs_pos).
  assert (J1 : Rabs x * t0 <= bp (-556)).
  { apply Rle_trans with (bp 404 * t0); [apply Rmult_le_compat_r; lra|]. unfold t0. rewrite <- bp_add. apply bp_le.
  lia. }
  assert (J2 : m * t0 <= bp (-556)).
  { apply Rle_trans with (bp 404 * t0); [apply Rmult_le_compat_r; [lra|]|].
    - apply Rle_trans with (bp 402); [lra | apply bp_le; lia].
    - unfold t0. rewrite <- bp_add. apply bp_le. lia. }
  assert (J3 : t0 * t0 <= bp (-556)) by (unfold t0; rewrite <- bp_add; apply bp_le; lia).
  assert (J4 : k * (m * t0) <= bp (-556)).
  { apply Rle_trans with (1 * (m * t0)); [apply Rmult_le_compat_r; [apply Rmult_le_pos; lra | lra] | lra]. }
  assert (J5 : bp (-540) = 65536 * bp (-556)) by (change (-540)%Z with (16 + -556)%Z; rewrite bp_add; simpl (bp 16);
    lra).
  pose proof (bp_pos (-556)). pose proof (Rabs_pos x).
  replace (Rabs x * (k * m + t0)) with (k * (m * Rabs x) + Rabs x * t0) in I1 by ring.
  replace ((k * m + t0) * (k * m + t0)) with (k * k * (m * m) + 2 * (k * (m * t0)) + t0 * t0) in I2 by ring.
  assert (J6 : k * k * (m * m) <= 226 * (u * u * (u * u)) * (m * m)) by (apply Rmult_le_compat_r;
    [apply sq_pos | unfold k; rewrite u_val; lra]).
  assert (J7 : 2 * (k * (m * Rabs x)) <= (30 + / 100) * (u * u) * (m * Rabs x)).
  { replace (2 * (k * (m * Rabs x))) with ((2 * k) * (m * Rabs x)) by ring.
    apply Rmult_le_compat_r; [apply Rmult_le_pos; lra | unfold k; rewrite u_val; lra]. }
  lra.
Qed.

Theorem DELTA_ERROR_holds : forall e,
  (1 - 16 * u) * (DELTA_ERROR * (ar + xx + m * (Rabs x1 + Rabs x2 + Rabs x3 + 32 * u * u * m)) + UNDERFLOW) <= e ->
  Rabs (delta - Delta) <= (1 - 2 * u) * e.
Proof.
  intros e He.
  destruct (component x1 X1 tx1 Hx1) as [C1 B1]; [terms; cbn [bounded]; repeat split;
    assumption | reflexivity | vm_compute; discriminate | reflexivity | exact M1 |].
  destruct (component x2 X2 tx2 Hx2) as [C2 B2]; [terms; cbn [bounded]; repeat split;
    assumption | reflexivity | vm_compute; discriminate | reflexivity | exact M2 |].
  destruct (component x3 X3 tx3 Hx3) as [C3 B3]; [terms; cbn [bounded]; repeat split;
    assumption | reflexivity | vm_compute; discriminate | reflexivity | exact M3 |].
  assert (BX : bounded (tsquare x1 x2 x3)) by (terms; cbn [bounded]; repeat split; assumption).
  pose proof (twice_error_at _ xx 21 (low2 (tsquare x1 x2 x3)) Hxx BX eq_refl eq_refl ltac:(lia)) as Q1.
  destruct square_error as (PA & A0 & AT).
  assert (BR : bounded (treach a)) by (terms; cbn [bounded]; split; [assumption | now apply (squares_bounded r 301)]).
  pose proof (twice_error_at _ ar 9 (low2 (treach a)) Har BR eq_refl eq_refl ltac:(lia)) as Q2.
  set (G := x1 * x1 + x2 * x2 + x3 * x3).
  assert (S1 : size (tsquare x1 x2 x3) = G) by (terms; cbn [size]; rewrite !abs_sq; reflexivity).
  assert (S2 : size (treach a) = a * (r * r)).
  { terms. cbn [size]. rewrite (Rabs_pos_eq a), !(Rabs_pos_eq (_ * _)) by (apply sq_pos || lra). reflexivity. }
  rewrite S1 in Q1. rewrite S2 in Q2. change (exact (tsquare x1 x2 x3)) with G in Q1.
  change (exact (treach a)) with (a * (r * r)) in Q2.
  assert (L1 : bp (low2 (tsquare x1 x2 x3)) <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; vm_compute;
    discriminate).
  assert (L2 : bp (low2 (treach a)) <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; vm_compute; discriminate).
  assert (L3 : bp (-540) <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; lia).
  assert (U0 : 0 < UNDERFLOW) by apply bp_pos.
  assert (AR0 : 0 <= A * (r * r)).
  { apply Rmult_le_pos; [unfold A; pose proof (sq_pos d1); pose proof (sq_pos d2); pose proof (sq_pos d3);
    lra | apply sq_pos]. }
  assert (PR : Rabs (a * (r * r) - A * (r * r)) <= (12 + / 500) * (u * u) * (A * (r * r))).
  { replace (a * (r * r) - A * (r * r)) with ((a - A) * (r * r)) by ring.
  rewrite Rabs_mult, (Rabs_pos_eq (r * r)) by apply sq_pos.
    replace ((12 + / 500) * (u * u) * (A * (r * r))) with ((12 + / 500) * (u * u) * A * (r * r)) by ring.
    apply Rmult_le_compat_r; [apply sq_pos | assumption]. }
  assert (Q3 : Rabs (ar - A * (r * r)) <= (21 + / 100) * (u * u) * (A * (r * r)) + / 1000000000000 * UNDERFLOW).
  { replace (ar - A * (r * r)) with ((ar - a * (r * r)) + (a * (r * r) - A * (r * r))) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. pose proof PR as PR'. apply Rabs_le_inv in PR'.
    set (p := a * (r * r)) in *. set (P := A * (r * r)) in *. clearbody p P. rewrite u_val in *. lra. }
  clear Q2. rename Q3 into Q2.
  assert (G0 : 0 <= G) by (unfold G; pose proof (sq_pos x1); pose proof (sq_pos x2); pose proof (sq_pos x3); lra).
  set (N := m * Rabs x1 + m * Rabs x2 + m * Rabs x3).
  assert (N0 : 0 <= N) by (unfold N; pose proof (Rabs_pos x1); pose proof (Rabs_pos x2); pose proof (Rabs_pos x3); nra).
  assert (MM : 0 <= m * m) by apply sq_pos.
  replace (m * (Rabs x1 + Rabs x2 + Rabs x3 + 32 * u * u * m)) with (N + 32 * (u * u) * (m * m)) in He by (unfold N;
    ring).
  assert (GX : Rabs (G - XX2) <= (30 + / 100) * (u * u) * N + 678 * (u * u * (u * u)) * (m * m) + 3 * bp (-540)).
  { replace (G - XX2) with ((x1 * x1 - X1 * X1) + (x2 * x2 - X2 * X2) + (x3 * x3 - X3 * X3)) by (unfold G, XX2; ring).
    eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|]. unfold N.
    clear - C1 C2 C3. lra. }
  replace (delta - Delta) with ((delta - (ar - xx)) + (ar - A * (r * r)) - (xx - G) - (G - XX2)) by (unfold Delta;
    ring).
  set (P := A * (r * r)) in *. set (V := m * m) in *. clearbody P V G N.
  assert (AX : Rabs (ar - xx) <= (1 + / 1000000) * (P + G) + / 100000000000 * UNDERFLOW).
  { apply Rabs_le_inv in Q1. apply Rabs_le_inv in Q2. clear - Q1 Q2 L1 L2 AR0 G0 U0. apply Rabs_le.
  rewrite u_val in *. lra. }
  assert (D6 : Rabs (delta - (ar - xx)) <= 6 * (u * u) * ((1 + / 1000000) * (P + G) + / 100000000000 * UNDERFLOW)).
  { eapply Rle_trans; [exact Hdelta|]. apply Rmult_le_compat_l; [rewrite u_val; lra | assumption]. }
  pose proof Q1 as R1. pose proof Q2 as R2. apply Rabs_le_inv in R1. apply Rabs_le_inv in R2.
  eapply Rle_trans with (Rabs (delta - (ar - xx)) + Rabs (ar - P) + Rabs (xx - G) + Rabs (G - XX2)).
  - unfold Rminus at 1. eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. apply Rplus_le_compat_r.
    unfold Rminus at 1. eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. apply Rplus_le_compat_r.
    apply Rabs_triang.
  - unfold DELTA_ERROR in He. clear - He D6 Q1 Q2 GX R1 R2 L1 L2 L3 U0 AR0 G0 N0 MM. rewrite u_val in *. lra.
Qed.
(* The verdict: the line misses, or crosses. *)
Theorem UNDERFLOW_holds : forall e h l, dd h l -> delta = h + l ->
  (1 - 16 * u) * (DELTA_ERROR * (ar + xx + m * (Rabs x1 + Rabs x2 + Rabs x3 + 32 * u * u * m)) + UNDERFLOW) <= e ->
  (h > e -> 0 < Delta) /\ (h < - e -> Delta < 0).
Proof. intros e h l H E He. apply high_sign with (l := l); auto. rewrite <- E. now apply DELTA_ERROR_holds. Qed.
End SphereExact.
