(* rt-geom, sphere_tree.rs: a line and the sphere of a node, in doubles. *)
From Proofs Require Import Rounding Norm.
Open Scope R_scope.

(* The rounding errors, relative to the radius and the distance from the origin, and what underflows. *)
Definition MARGIN := 64 * u.
Definition UNDERFLOW := bp (-100).
(* A unit along the ray is as long as this or its reciprocal. *)
Definition LONGEST := bp 960.

Notation U := UNDERFLOW.
Lemma U_pos : 0 < U. Proof. apply bp_pos. Qed.
Lemma under_U : forall k, (k <= -300)%Z -> bp k <= / 1000000000000 * (U * U) /\ bp k <= / 1000000000000 * U.
Proof.
  intros k H. assert (A : bp k <= / 1000000000000 * bp (-200)) by (apply bp_part12; lia). split.
  - unfold U. rewrite bp_sq. exact A.
  - apply Rle_trans with (1 := A). apply Rmult_le_compat_l; [lra | apply bp_le; lia].
Qed.
(* What underflows where a unit is ordinary: t, and a product with it. *)
Theorem UNDERFLOW_holds : forall k, (k <= -300)%Z -> bp k <= / 1000000000000 * UNDERFLOW.
Proof. intros k H. now apply under_U. Qed.
Theorem LONGEST_holds : forall unit, / LONGEST <= unit < LONGEST ->
  bp (-1022) <= unit /\ bp (-1075) * unit <= / 10000 * UNDERFLOW.
Proof.
  intros unit [L1 L2]. assert (B : bp (-960) = / LONGEST) by (unfold LONGEST; change (-960)%Z with (Z.opp 960); apply
    bpow_opp). split.
  - rewrite <- B in L1. apply Rle_trans with (2 := L1). apply bp_le. lia.
  - apply Rle_trans with (bp (-1075) * LONGEST); [apply Rmult_le_compat_l; [apply Rlt_le, bp_pos | lra]|].
    unfold LONGEST. rewrite <- bp_add. apply Rle_trans with (bp (-14 + -100)); [apply bp_le; lia|]. rewrite bp_add.
    fold UNDERFLOW. pose proof U_pos. unfold UNDERFLOW in *. simpl (bp (-14)). lra.
Qed.

Section Node.
(* exactly: from the center to the origin, the direction, the radius *)
Variables X1 X2 X3 e1 e2 e3 r : R.
Let W := norm X1 X2 X3.
Let s := - (X1 * e1 + X2 * e2 + X3 * e3).
Let P1 := X1 + s * e1. Let P2 := X2 + s * e2. Let P3 := X3 + s * e3.
Let p := norm P1 P2 P3.
Let m := W + r.
Hypotheses (He : norm e1 e2 e3 = 1) (Hr : 0 <= r) (Hmeet : p <= r).
(* as computed *)
Variables x1 x2 x3 d1 d2 d3 n far reach p1 p2 p3 aside : R.
Hypotheses (Hx1 : Rabs (x1 - X1) <= u * Rabs X1 + bp (-1072)) (Hx2 : Rabs (x2 - X2) <= u * Rabs X2 + bp (-1072))
  (Hx3 : Rabs (x3 - X3) <= u * Rabs X3 + bp (-1072))
  (Hd1 : Rabs (d1 - e1) <= 5 * u * Rabs e1 + bp (-1000)) (Hd2 : Rabs (d2 - e2) <= 5 * u * Rabs e2 + bp (-1000))
  (Hd3 : Rabs (d3 - e3) <= 5 * u * Rabs e3 + bp (-1000)).
Hypotheses (Bx1 : Rabs x1 <= bp 1025) (Bx2 : Rabs x2 <= bp 1025) (Bx3 : Rabs x3 <= bp 1025) (Bn : Rabs n <= bp 1025)
  (Bp1 : Rabs p1 <= bp 1025) (Bp2 : Rabs p2 <= bp 1025) (Bp3 : Rabs p3 <= bp 1025) (Br : Rabs r <= bp 1025)
  (Bfar : Rabs far <= bp 1025).
Let y x := X x 1025.
Let one d := X d 1.
Hypotheses (Hn : plain (Add (Mul (y x1) (one d1)) (Add (Mul (y x2) (one d2)) (Mul (y x3) (one d3)))) n)
  (Hfar : plain (Add (Add (Abs (y x1)) (Abs (y x2))) (Add (Abs (y x3)) (y r))) far)
  (Hreach : plain (Add (y r) (Add (Mul (X MARGIN (-47)) (y far)) (X U (-100)))) reach)
  (Hp1 : plain (Add (Mul (y (- n)) (one d1)) (y x1)) p1) (Hp2 : plain (Add (Mul (y (- n)) (one d2)) (y x2)) p2)
  (Hp3 : plain (Add (Mul (y (- n)) (one d3)) (y x3)) p3)
  (Haside : plain (Add (Mul (y p1) (y p1)) (Add (Mul (y p2) (y p2)) (Mul (y p3) (y p3)))) aside).

Lemma W_pos : 0 <= W. Proof. apply norm_pos. Qed.
Lemma t1072 : bp (-1072) <= / 1000 * bp (-1060) /\ 0 < bp (-1060).
Proof.
  split; [|apply bp_pos]. apply Rle_trans with (bp (-10 + -1060)); [apply bp_le; lia|]. rewrite bp_add.
  pose proof (bp_pos (-1060)). simpl (bp (-10)). lra.
Qed.
Lemma x_near : norm (x1 - X1) (x2 - X2) (x3 - X3) <= u * W + / 100 * bp (-1060).
Proof.
  pose proof u_pos. destruct t1072 as [T T0]. pose proof (bp_pos (-1072)).
  eapply Rle_trans; [eapply norm_monotone; eassumption|]. eapply Rle_trans; [apply norm_triangle|].
  rewrite norm_scaled, norm_abs, Rabs_pos_eq by lra. fold W.
  assert (norm (bp (-1072)) (bp (-1072)) (bp (-1072)) <= 17321 / 10000 * bp (-1072)) by (apply norm_equal; try lra;
    rewrite Rabs_pos_eq; lra). lra.
Qed.
Lemma x_le : norm x1 x2 x3 <= (1 + u) * W + / 100 * bp (-1060) /\ W <= (1 + 2 * u) * norm x1 x2 x3 + bp (-1060).
Proof.
  pose proof x_near as N. pose proof (norm_difference x1 x2 x3 X1 X2 X3) as A. fold W in A.
  pose proof (norm_difference X1 X2 X3 x1 x2 x3) as B. fold W in B.
  assert (S : norm (X1 - x1) (X2 - x2) (X3 - x3) = norm (x1 - X1) (x2 - X2) (x3 - X3)).
  { rewrite <- norm_opp. f_equal; ring. }
  rewrite S in B. destruct t1072 as [T T0]. pose proof (norm_pos x1 x2 x3). pose proof W_pos. rewrite u_val in *.
  split; lra.
Qed.
Lemma d_near : norm (d1 - e1) (d2 - e2) (d3 - e3) <= (5 + / 1000) * u.
Proof.
  pose proof u_pos. pose proof (bp_pos (-1000)). assert (T : bp (-1000) <= / 10000 * u) by (apply Rle_trans with
    (bp (-20 + -53)); [apply bp_le; lia|]; rewrite bp_add; fold u; simpl (bp (-20)); lra).
  eapply Rle_trans; [eapply norm_monotone; eassumption|]. eapply Rle_trans; [apply norm_triangle|].
  rewrite norm_scaled, norm_abs, Rabs_pos_eq, He by lra.
  assert (norm (bp (-1000)) (bp (-1000)) (bp (-1000)) <= 17321 / 10000 * bp (-1000)) by (apply norm_equal; try lra;
    rewrite Rabs_pos_eq; lra). lra.
Qed.
Lemma d_le : norm d1 d2 d3 <= 1 + (5 + / 1000) * u.
Proof. pose proof d_near. pose proof (norm_difference d1 d2 d3 e1 e2 e3). rewrite He in *. lra. Qed.
Lemma d_bound : Rabs d1 <= bp 1 /\ Rabs d2 <= bp 1 /\ Rabs d3 <= bp 1.
Proof.
  destruct (part_le d1 d2 d3) as (A & B & C). pose proof d_le. assert (bp 1 = 2) by (simpl; lra). rewrite u_val in *.
  repeat split; lra.
Qed.
(* The product of two lengths, one near 1. *)
Lemma times : forall a b A k, 0 <= a <= A -> 0 <= b <= 1 + (5 + / 1000) * u -> A * (1 + 6 * u) <= k -> a * b <= k.
Proof.
  intros a b A k [a0 aA] [b0 bB] H. apply Rle_trans with (A * (1 + (5 + / 1000) * u)); [apply mul2; split; assumption|].
  apply Rle_trans with (2 := H). apply Rmult_le_compat_l; [lra|]. pose proof u_pos. lra.
Qed.
Lemma s_near : Rabs (n + s) <= (92 / 10) * u * W + bp (-1060).
Proof.
  destruct d_bound as (B1 & B2 & B3). destruct x_le as [XL _]. destruct t1072 as [T T0]. pose proof W_pos as W0.
  pose proof u_pos as U0. pose proof d_le as DL. pose proof d_near as DN. pose proof x_near as XN.
  assert (E : Rabs (n - (x1 * d1 + (x2 * d2 + x3 * d3))) <= (3 + / 1000) * u * (Rabs x1 * Rabs d1 + (Rabs x2 * Rabs d2 +
    Rabs x3 * Rabs d3)) + / 10 * bp (-1060)).
  { pose proof Hn as H. clear - H Bx1 Bx2 Bx3 B1 B2 B3. unfold y, one in H. error_of H P. eapply Rle_trans; [exact P|].
    apply Rplus_le_compat_l. match goal with |- bp ?k <= _ => apply Rle_trans with (bp (-4 + -1060)); [apply bp_le;
      lia|] end.
    rewrite bp_add. pose proof (bp_pos (-1060)). simpl (bp (-4)). lra. }
  assert (Z : Rabs x1 * Rabs d1 + (Rabs x2 * Rabs d2 + Rabs x3 * Rabs d3) <= (1 + 8 * u) * W + / 50 * bp (-1060)).
  { rewrite <- Rplus_assoc. eapply Rle_trans; [apply Rle_abs|]. eapply Rle_trans; [apply dot_le|]. rewrite !norm_abs.
    eapply times; [split; [apply norm_pos | exact XL] | split; [apply norm_pos | exact DL] |]. rewrite u_val in *.
    lra. }
  assert (E1 : Rabs ((x1 - X1) * d1 + (x2 - X2) * d2 + (x3 - X3) * d3) <= (1 + / 1000) * u * W + / 50 * bp (-1060)).
  { eapply Rle_trans; [apply dot_le|]. eapply times; [split; [apply norm_pos | exact XN] | split;
    [apply norm_pos | exact DL] |].
    rewrite u_val in *. lra. }
  assert (E2 : Rabs (X1 * (d1 - e1) + X2 * (d2 - e2) + X3 * (d3 - e3)) <= (5 + / 1000) * u * W).
  { eapply Rle_trans; [apply dot_le|]. fold W. rewrite (Rmult_comm _ W). apply Rmult_le_compat_l; assumption. }
  replace (n + s) with ((n - (x1 * d1 + (x2 * d2 + x3 * d3))) + ((x1 - X1) * d1 + (x2 - X2) * d2 + (x3 - X3) * d3)
    + (X1 * (d1 - e1) + X2 * (d2 - e2) + X3 * (d3 - e3))) by (unfold s; ring).
  eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
  rewrite u_val in *. lra.
Qed.
Lemma s_le : Rabs s <= W.
Proof. unfold s. rewrite Rabs_Ropp. eapply Rle_trans; [apply dot_le|]. rewrite He. fold W. lra. Qed.
Lemma n_le : Rabs n <= (1 + 10 * u) * W + bp (-1060).
Proof.
  replace n with ((n + s) + - s) by ring. eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. pose proof s_near.
  pose proof s_le. pose proof W_pos. rewrite u_val in *. lra.
Qed.
Lemma p_near : norm (p1 - P1) (p2 - P2) (p3 - P3) <= (195 / 10) * u * W + bp (-1050).
Proof.
  destruct d_bound as (B1 & B2 & B3). destruct x_le as [XL _]. destruct t1072 as [T T0]. pose proof W_pos as W0.
  pose proof u_pos as U0. pose proof d_le as DL. pose proof d_near as DN. pose proof x_near as XN.
  pose proof s_near as SN. pose proof s_le as SL. pose proof n_le as NL.
  assert (T2 : bp (-1060) <= / 1000 * bp (-1050)) by (apply Rle_trans with (bp (-10 + -1050)); [apply bp_le; lia|];
    rewrite bp_add; pose proof (bp_pos (-1050)); simpl (bp (-10)); lra).
  assert (Bn' : Rabs (- n) <= bp 1025) by now rewrite Rabs_Ropp.
  assert (E : forall d x q, Rabs d <= bp 1 -> Rabs x <= bp 1025 -> plain (Add (Mul (y (- n)) (one d)) (y x)) q ->
    Rabs (q - (- n * d + x)) <= (2 + / 1000) * u * (Rabs n * Rabs d) + (2 + / 1000) * u * Rabs x + / 1000 * bp (-1050)).
  { clear - Bn' T2. intros d x q Bd Bx H. unfold y, one in H. error_of H P. rewrite Rabs_Ropp in P.
    eapply Rle_trans; [exact P|]. match goal with |- _ + bp ?k <= _ => assert (bp k <= bp (-1060)) by (apply bp_le;
      lia) end.
    lra. }
  pose proof (E _ _ _ B1 Bx1 Hp1) as E1. pose proof (E _ _ _ B2 Bx2 Hp2) as E2. pose proof (E _ _ _ B3 Bx3 Hp3) as E3.
  set (t := / 1000 * bp (-1050)) in *. assert (Te : t = / 1000 * bp (-1050)) by reflexivity.
  set (k := (2 + / 1000) * u) in *.
  assert (k0 : 0 <= k) by (unfold k; lra). assert (t0 : 0 <= t) by (unfold t; pose proof (bp_pos (-1050)); lra).
  assert (N1 : norm (p1 - (- n * d1 + x1)) (p2 - (- n * d2 + x2)) (p3 - (- n * d3 + x3)) <=
    k * (Rabs n * norm d1 d2 d3) + k * norm x1 x2 x3 + 2 * t).
  { eapply Rle_trans; [eapply norm_monotone; eassumption|]. eapply Rle_trans; [apply norm_triangle|].
    eapply Rle_trans; [apply Rplus_le_compat_r, norm_triangle|].
    rewrite !norm_scaled, !norm_abs, !(Rabs_pos_eq k) by lra.
    rewrite Rabs_Rabsolu. apply Rplus_le_compat_l. eapply Rle_trans; [apply (norm_equal _ _ _ t); try lra;
      rewrite Rabs_pos_eq; lra | lra]. }
  assert (Q1 : Rabs n * norm d1 d2 d3 <= (1 + 17 * u) * W + / 500 * bp (-1050)).
  { eapply times; [split; [apply Rabs_pos | exact NL] | split; [apply norm_pos | exact DL] |]. rewrite u_val in *.
  lra. }
  (* -n d + x less s e + X *)
  assert (N2 : norm (- n * d1 + x1 - P1) (- n * d2 + x2 - P2) (- n * d3 + x3 - P3) <= (153 / 10) * u * W
    + / 100 * bp (-1050)).
  { apply Rle_trans with (norm (- (n + s) * d1) (- (n + s) * d2) (- (n + s) * d3) + norm (s * (d1 - e1)) (s * (d2 - e2))
      (s * (d3 - e3)) + norm (x1 - X1) (x2 - X2) (x3 - X3)).
    - replace (- n * d1 + x1 - P1) with (- (n + s) * d1 + s * (d1 - e1) + (x1 - X1)) by (unfold P1; ring).
      replace (- n * d2 + x2 - P2) with (- (n + s) * d2 + s * (d2 - e2) + (x2 - X2)) by (unfold P2; ring).
      replace (- n * d3 + x3 - P3) with (- (n + s) * d3 + s * (d3 - e3) + (x3 - X3)) by (unfold P3; ring).
      eapply Rle_trans; [apply norm_triangle|]. apply Rplus_le_compat_r, norm_triangle.
    - rewrite !norm_scaled, Rabs_Ropp.
      assert (A1 : Rabs (n + s) * norm d1 d2 d3 <= (921 / 100) * u * W + 2 * bp (-1060)).
      { eapply times; [split; [apply Rabs_pos | exact SN] | split; [apply norm_pos | exact DL] |]. rewrite u_val in *.
      lra. }
      assert (A2 : Rabs s * norm (d1 - e1) (d2 - e2) (d3 - e3) <= W * ((5 + / 1000) * u)) by (apply mul2; split;
        auto using Rabs_pos, norm_pos).
      assert (0 <= u * W) by (apply Rmult_le_pos; lra). lra. }
  assert (KW : k * ((1 + 17 * u) * W + / 500 * bp (-1050)) <= (2 + / 500) * u * W + / 1000 * bp (-1050)) by (unfold k;
    pose proof (bp_pos (-1050)); rewrite u_val in *; lra).
  assert (K1 : k * (Rabs n * norm d1 d2 d3) <= k * ((1 + 17 * u) * W + / 500 * bp (-1050))) by (apply Rmult_le_compat_l;
    assumption).
  assert (K2 : k * norm x1 x2 x3 <= k * ((1 + 17 * u) * W + / 500 * bp (-1050))) by (apply Rmult_le_compat_l;
    [assumption|]; rewrite u_val in *; lra).
  eapply Rle_trans; [apply (norm_difference _ _ _ (- n * d1 + x1 - P1) (- n * d2 + x2 - P2) (- n * d3 + x3 - P3))|].
  replace (p1 - P1 - (- n * d1 + x1 - P1)) with (p1 - (- n * d1 + x1)) by ring.
  replace (p2 - P2 - (- n * d2 + x2 - P2)) with (p2 - (- n * d2 + x2)) by ring.
  replace (p3 - P3 - (- n * d3 + x3 - P3)) with (p3 - (- n * d3 + x3)) by ring.
  assert (0 <= u * W) by (apply Rmult_le_pos; lra).
  unfold t in *. pose proof (bp_pos (-1050)). lra.
Qed.
Lemma reach_low : r + (608 / 10) * u * m + 99 / 100 * U <= reach.
Proof.
  destruct t1072 as [T T0]. destruct (under_U (-1060) ltac:(lia)) as [_ TU]. pose proof W_pos as W0.
  pose proof u_pos as U0.
  pose proof U_pos as UP. assert (BM : Rabs MARGIN <= bp (-47)) by (unfold MARGIN; constant).
  assert (BU : Rabs U <= bp (-100)) by (rewrite Rabs_pos_eq; unfold UNDERFLOW in *; lra).
  assert (E : Rabs (reach - (r + (MARGIN * far + U))) <= (3 + / 1000) * u * (r + (MARGIN * Rabs far + U)) + bp (-1060)).
  { pose proof Hreach as H. clear - H Br Bfar BM BU Hr UP. unfold y in H. error_of H P.
    rewrite (Rabs_pos_eq r), (Rabs_pos_eq U), (Rabs_pos_eq MARGIN) in P by (unfold MARGIN; rewrite ?u_val; lra).
    eapply Rle_trans; [exact P|]. apply Rplus_le_compat_l. apply bp_le. lia. }
  assert (F : Rabs (far - (Rabs x1 + Rabs x2 + (Rabs x3 + r))) <= (2 + / 1000) * u * (Rabs x1 + Rabs x2 + (Rabs x3
    + r)) +
    bp (-1060)).
  { pose proof Hfar as H. clear - H Br Bx1 Bx2 Bx3 Hr. unfold y in H. error_of H P. rewrite (Rabs_pos_eq r) in P by lra.
    eapply Rle_trans; [exact P|]. apply Rplus_le_compat_l. apply bp_le. lia. }
  pose proof (norm_le_sum x1 x2 x3) as NS. destruct x_le as [_ WL]. pose proof (norm_pos x1 x2 x3) as N0.
  set (q := Rabs x1 + Rabs x2 + (Rabs x3 + r)) in *. apply Rabs_le_inv in F. apply Rabs_le_inv in E.
  assert (QW : (1 - 3 * u) * m <= q + 2 * bp (-1060)).
  { unfold m, q. rewrite u_val in *. lra. }
  assert (FL : (1 - 6 * u) * m - 4 * bp (-1060) <= far) by (assert (0 <= m) by (unfold m; lra); rewrite u_val in *;
    lra).
  assert (FA : Rabs far <= far + 8 * bp (-1060)).
  { assert (0 <= m) by (unfold m; lra). unfold Rabs. destruct Rcase_abs; [|lra].
    assert (0 <= (1 - 6 * u) * m) by (apply Rmult_le_pos; [rewrite u_val; lra | assumption]). lra. }
  unfold MARGIN in *. assert (rm : r <= m) by (unfold m; lra). assert (m0 : 0 <= m) by lra.
  rewrite u_val in *. lra.
Qed.

(* ---- The computed chord is long enough ---- *)
Let h := sqrt (r * r - p * p).
Let chord := RN (RN (reach * reach) - aside).
Let half := RN (sqrt chord).
Let K := 34 * (u * m) + / 4 * U.
Lemma h_sq : h * h = r * r - p * p /\ 0 <= h <= r.
Proof.
  pose proof (norm_pos P1 P2 P3) as p0. fold p in p0. assert (PP : p * p <= r * r) by (apply mul2; split; lra).
  assert (HH : h * h = r * r - p * p) by (apply sqrt_sqrt; lra). pose proof (sqrt_pos (r * r - p * p)) as h0.
  fold h in h0.
  split; [assumption|]. split; [assumption|]. apply below_root; [assumption|]. pose proof (sq_pos p). lra.
Qed.
Lemma half_low : 0 <= chord /\ h + K <= half.
Proof.
  pose proof W_pos as W0. pose proof u_pos as U0. pose proof U_pos as UP. destruct h_sq as (HH & h0 & hr).
  pose proof (norm_pos P1 P2 P3) as p0. fold p in p0. pose proof reach_low as RL. pose proof p_near as PN.
  pose proof (norm_difference p1 p2 p3 P1 P2 P3) as PD. fold p in PD.
  destruct (under_U (-1050) ltac:(lia)) as [TU1 TU2]. destruct (under_U (-1060) ltac:(lia)) as [TU3 TU4].
  destruct (under_U (-1075) ltac:(lia)) as [TU5 TU6].
  assert (m0 : 0 <= m) by (unfold m; lra). assert (Wm : u * W <= u * m) by (apply Rmult_le_compat_l; unfold m; lra).
  set (e := u * m) in *. assert (e0 : 0 <= e) by (apply Rmult_le_pos; lra).
  replace ((608 / 10) * u * m) with ((608 / 10) * e) in RL by (unfold e; ring).
  replace ((195 / 10) * u * W) with ((195 / 10) * (u * W)) in PN by ring.
  assert (PL : norm p1 p2 p3 <= p + (195 / 10) * e + / 1000 * U) by lra.
  pose proof (norm_sq p1 p2 p3) as NN. pose proof (norm_pos p1 p2 p3) as N0. set (l := norm p1 p2 p3) in *.
  assert (A : aside <= (1 + (3 + / 1000) * u) * (l * l) + / 1000000 * (U * U)).
  { pose proof Haside as H. clear - H Bp1 Bp2 Bp3 NN U0 TU3. unfold y in H. error_of H P. rewrite !abs_sq in P.
    replace (p1 * p1 + (p2 * p2 + p3 * p3)) with (l * l) in P by lra. apply Rabs_le_inv in P.
    match type of P with _ <= _ <= _ + bp ?k => assert (bp k <= bp (-1060)) by (apply bp_le; lia) end.
    pose proof (sq_pos U). lra. }
  pose proof (RN_err (reach * reach)) as E. set (rr := RN (reach * reach)) in *.
  rewrite (Rabs_pos_eq (reach * reach)) in E by apply sq_pos. apply Rabs_le_inv in E.
  set (q := (608 / 10) * e + 99 / 100 * U) in *. set (g := (195 / 10) * e + / 1000 * U) in *.
  assert (RR : (r + q) * (r + q) <= reach * reach) by (apply mul2; split; unfold q in *; lra).
  assert (LL : l * l <= (p + g) * (p + g)) by (apply mul2; split; unfold g in *; lra).
  (* monomials *)
  assert (re : 0 <= r * e) by now apply Rmult_le_pos. assert (rU : 0 <= r * U) by (apply Rmult_le_pos; lra).
  assert (ee : 0 <= e * e) by now apply Rmult_le_pos. assert (eU : 0 <= e * U) by (apply Rmult_le_pos; lra).
  assert (UU : 0 < U * U) by now apply Rmult_lt_0_compat.
  assert (ur : u * (r * r) <= r * e).
  { replace (u * (r * r)) with (r * (u * r)) by ring. apply Rmult_le_compat_l; [assumption|]. unfold e.
    apply Rmult_le_compat_l; unfold m; lra. }
  assert (pg : p * g <= r * g) by (apply Rmult_le_compat_r; unfold g; lra).
  assert (hK : h * K <= r * K) by (apply Rmult_le_compat_r; unfold K; fold e; lra).
  assert (hh : h * h <= r * r) by (apply mul2; split; lra). assert (pp : p * p <= r * r) by (apply mul2; split; lra).
  (* (h + K)^2 and a little more below the computed difference *)
  assert (MAIN : (1 + 4 * u) * ((h + K) * (h + K)) + / 100 * (U * U) <= rr - aside).
  { assert (G1 : (1 - u) * ((r + q) * (r + q)) - / 1000000 * (U * U) <= rr).
    { assert ((1 - u) * ((r + q) * (r + q)) <= (1 - u) * (reach * reach)) by (apply Rmult_le_compat_l;
        [rewrite u_val; lra | assumption]). lra. }
    assert (G2 : aside <= (1 + (3 + / 1000) * u) * ((p + g) * (p + g)) + / 1000000 * (U * U)).
    { assert ((1 + (3 + / 1000) * u) * (l * l) <= (1 + (3 + / 1000) * u) * ((p + g) * (p + g))) by (apply
        Rmult_le_compat_l; [rewrite u_val; lra | assumption]). lra. }
    assert (S1 : (r + q) * (r + q) = r * r + 2 * (608 / 10) * (r * e) + 2 * (99 / 100) * (r * U)
      + (608 / 10) * (608 / 10) *
      (e * e) + 2 * (608 / 10) * (99 / 100) * (e * U) + (99 / 100) * (99 / 100) * (U * U)) by (unfold q; field).
    assert (S2 : (p + g) * (p + g) <= p * p + 2 * (195 / 10) * (r * e) + 2 * / 1000 * (r * U)
      + (195 / 10) * (195 / 10) *
      (e * e) + 2 * (195 / 10) * / 1000 * (e * U) + / 1000000 * (U * U)).
    { replace ((p + g) * (p + g)) with (p * p + 2 * (p * g) + g * g) by ring. 
      assert (r * g = (195 / 10) * (r * e) + / 1000 * (r * U)) by (unfold g; ring).
      assert (g * g = (195 / 10) * (195 / 10) * (e * e) + 2 * (195 / 10) * / 1000 * (e * U) + / 1000000 * (U * U)) by
        (unfold g; field). lra. }
    assert (S3 : (h + K) * (h + K) <= h * h + 2 * 34 * (r * e) + / 2 * (r * U) + 34 * 34 * (e * e) + 17 * (e * U) +
      / 16 * (U * U)).
    { replace ((h + K) * (h + K)) with (h * h + 2 * (h * K) + K * K) by ring.
      assert (r * K = 34 * (r * e) + / 4 * (r * U)) by (unfold K; fold e; ring).
      assert (K * K = 34 * 34 * (e * e) + 17 * (e * U) + / 16 * (U * U)) by (unfold K; fold e; field). lra. }
    rewrite S1 in G1.
    assert (G3 : (1 + 4 * u) * ((h + K) * (h + K)) <= (1 + 4 * u) * (h * h + 2 * 34 * (r * e) + / 2 * (r * U)
      + 34 * 34 *
      (e * e) + 17 * (e * U) + / 16 * (U * U))) by (apply Rmult_le_compat_l; lra).
    assert (G4 : (1 + (3 + / 1000) * u) * ((p + g) * (p + g)) <= (1 + (3 + / 1000) * u) * (p * p
      + 2 * (195 / 10) * (r * e) +
      2 * / 1000 * (r * U) + (195 / 10) * (195 / 10) * (e * e) + 2 * (195 / 10) * / 1000 * (e * U)
        + / 1000000 * (U * U)))
      by (apply Rmult_le_compat_l; lra).
    rewrite HH in *. set (a1 := r * e) in *. set (a2 := r * U) in *. set (a3 := e * e) in *. set (a4 := e * U) in *.
    set (a5 := U * U) in *. set (a6 := r * r) in *. set (a7 := p * p) in *. clear - G1 G2 G3 G4 re rU ee eU UU ur hh pp.
    clearbody a1 a2 a3 a4 a5 a6 a7 rr. rewrite u_val in *. lra. }
  set (d := rr - aside) in *. pose proof (RN_err d) as E2. change (RN d) with chord in E2.
  assert (hK2 : 0 <= (h + K) * (h + K)) by apply sq_pos.
  rewrite (Rabs_pos_eq d) in E2 by (rewrite u_val in *; lra). apply Rabs_le_inv in E2.
  assert (C : (1 + (29 / 10) * u) * ((h + K) * (h + K)) <= chord) by (rewrite u_val in *; lra).
  assert (C0 : 0 <= chord) by (rewrite u_val in *; lra). split; [assumption|].
  assert (KU : / 4 * U <= h + K) by (unfold K; fold e; lra).
  assert (SQ : (1 + (14 / 10) * u) * (h + K) <= sqrt chord).
  { apply below_root; [apply sqrt_pos|]. rewrite sqrt_sqrt by assumption.
    replace ((1 + (14 / 10) * u) * (h + K) * ((1 + (14 / 10) * u) * (h + K))) with ((1 + (14 / 10) * u) * (1
      + (14 / 10) * u)
      * ((h + K) * (h + K))) by ring.
    eapply Rle_trans; [|exact C]. apply Rmult_le_compat_r; [assumption | rewrite u_val; lra]. }
  assert (HF : Rabs (half - sqrt chord) <= u * sqrt chord).
  { pose proof (sqrt_pos chord). rewrite <- (Rabs_pos_eq (sqrt chord)) at 2 by assumption. apply RN_normal.
    rewrite Rabs_pos_eq by assumption. apply Rle_trans with (/ 4 * U).
    - apply Rle_trans with (bp (-2 + -100)); [apply bp_le; lia|]. rewrite bp_add. unfold UNDERFLOW in *.
    simpl (bp (-2)). lra.
    - rewrite u_val in *. lra. }
  apply Rabs_le_inv in HF. rewrite u_val in *. lra.
Qed.

(* ---- Along the line ----
   A hit at the exact t', rounded t, where unit is the computed length of a unit of t and length the exact one,
     scaled. *)
Variables unit length t t' : R.
Hypotheses (Hunit : / LONGEST <= unit < LONGEST) (Hlength : Rabs (unit - length) <= 4 * u * unit)
  (Ht : Rabs (t - t') <= u * Rabs t' + bp (-1075)).
Let along := t' * length.
Hypotheses (Hhit : Rabs (along - s) <= h).
Lemma hit_near : Rabs (RN (t * unit) - along) <= (62 / 10) * (u * m) + / 1000 * U /\ Rabs along <= m.
Proof.
  destruct (LONGEST_holds unit Hunit) as [LU TU]. destruct h_sq as (_ & h0 & hr). pose proof s_le as SL.
  pose proof W_pos as W0.
  pose proof u_pos as U0. pose proof U_pos as UP. assert (unit0 : 0 < unit) by (pose proof (bp_pos (-1022)); lra).
  assert (AM : Rabs along <= m).
  { replace along with ((along - s) + s) by ring. eapply Rle_trans; [apply Rabs_triang|]. unfold m. lra. }
  split; [|assumption]. apply Rabs_le_inv in Hlength as HL.
  assert (length0 : unit <= (1 + 5 * u) * length) by (rewrite u_val in *; lra).
  assert (l0 : 0 < length) by (rewrite u_val in *; lra).
  assert (TL : Rabs t' * length = Rabs along) by (unfold along; rewrite Rabs_mult, (Rabs_pos_eq length); lra).
  assert (E1 : Rabs (t * unit - along) <= (51 / 10) * (u * m) + / 5000 * U).
  { replace (t * unit - along) with ((t - t') * unit + t' * (unit - length)) by (unfold along; ring).
    eapply Rle_trans; [apply Rabs_triang|]. rewrite !Rabs_mult, (Rabs_pos_eq unit) by lra.
    assert (Z1 : Rabs (t - t') * unit <= (u * Rabs t' + bp (-1075)) * unit) by (apply Rmult_le_compat_r; lra).
    assert (Z2 : Rabs t' * unit <= (1 + 5 * u) * m).
    { apply Rle_trans with (Rabs t' * ((1 + 5 * u) * length)); [apply Rmult_le_compat_l;
      [apply Rabs_pos | assumption]|].
      replace (Rabs t' * ((1 + 5 * u) * length)) with ((1 + 5 * u) * (Rabs t' * length)) by ring. rewrite TL.
      apply Rmult_le_compat_l; [lra | assumption]. }
    assert (Z3 : Rabs t' * Rabs (unit - length) <= 4 * u * (Rabs t' * unit)).
    { apply Rle_trans with (Rabs t' * (4 * u * unit)); [apply Rmult_le_compat_l;
      [apply Rabs_pos | assumption] | right; ring]. }
    assert (Z4 : u * (Rabs t' * unit) <= u * ((1 + 5 * u) * m)) by (apply Rmult_le_compat_l; lra).
    replace ((u * Rabs t' + bp (-1075)) * unit) with (u * (Rabs t' * unit) + bp (-1075) * unit) in Z1 by ring.
    assert (0 <= m) by (unfold m; lra). rewrite u_val in *. lra. }
  pose proof (RN_err (t * unit)) as E2. destruct (under_U (-1075) ltac:(lia)) as [_ T3].
  assert (E3 : Rabs (t * unit) <= m + ((51 / 10) * (u * m) + / 5000 * U)).
  { replace (t * unit) with ((t * unit - along) + along) by ring. eapply Rle_trans; [apply Rabs_triang|]. lra. }
  assert (m0 : 0 <= m) by (unfold m; lra).
  replace (RN (t * unit) - along) with ((RN (t * unit) - t * unit) + (t * unit - along)) by ring.
  eapply Rle_trans; [apply Rabs_triang|]. rewrite u_val in *. lra.
Qed.
(* The node is not passed over. *)
Lemma met : forall start last, start <= t <= last ->
  0 <= chord /\ RN (- n - half) <= RN (last * unit) /\ RN (RN (start * unit) - - n) <= half.
Proof.
  intros start last [H1 H2]. destruct half_low as [C0 HL]. destruct hit_near as [HN AM]. pose proof s_near as SN.
  destruct (LONGEST_holds unit Hunit) as [LU _]. assert (unit0 : 0 <= unit) by (pose proof (bp_pos (-1022)); lra).
  pose proof W_pos as W0. pose proof u_pos as U0. pose proof U_pos as UP. destruct h_sq as (_ & h0 & hr).
  destruct (under_U (-1060) ltac:(lia)) as [_ T1]. destruct (under_U (-1075) ltac:(lia)) as [_ T2].
  assert (Wm : u * W <= u * m) by (apply Rmult_le_compat_l; unfold m; lra). assert (m0 : 0 <= m) by (unfold m; lra).
  replace ((92 / 10) * u * W) with ((92 / 10) * (u * W)) in SN by ring.
  apply Rabs_le_inv in SN. apply Rabs_le_inv in HN. apply Rabs_le_inv in Hhit. unfold K in HL.
  set (e := u * m) in *. assert (e0 : 0 <= e) by (apply Rmult_le_pos; lra).
  assert (em : e <= / 1000000 * m) by (unfold e; rewrite u_val; lra).
  assert (L : RN (t * unit) <= RN (last * unit)) by (apply RN_le; apply Rmult_le_compat_r; assumption).
  assert (S : RN (start * unit) <= RN (t * unit)) by (apply RN_le; apply Rmult_le_compat_r; assumption).
  split; [assumption|]. split.
  - set (z := along - 24 * e - / 5 * U). assert (Z : - n - half <= z) by (unfold z; lra).
    apply Rle_trans with (RN z); [now apply RN_le|]. pose proof (RN_err z) as E.
    assert (Rabs z <= (1 + / 1000) * m + U).
    { unfold z, Rminus. eapply Rle_trans; [apply Rabs_triang|].
    eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
      rewrite !Rabs_Ropp, (Rabs_pos_eq (24 * e)), (Rabs_pos_eq (/ 5 * U)) by lra. lra. }
    assert (u * Rabs z <= u * ((1 + / 1000) * m + U)) by (apply Rmult_le_compat_l; lra).
    assert (UU : u * U <= / 1000000 * U) by (rewrite u_val; lra).
    replace (u * ((1 + / 1000) * m + U)) with ((1 + / 1000) * e + u * U) in * by (unfold e; ring).
    apply Rabs_le_inv in E. unfold z in *. lra.
  - set (z := h + 16 * e + / 100 * U). assert (Z : RN (start * unit) - - n <= z) by (unfold z; lra).
    apply Rle_trans with (RN z); [now apply RN_le|]. pose proof (RN_err z) as E.
    assert (z0 : 0 <= z) by (unfold z; lra). assert (zm : z <= (1 + / 1000) * m + U) by (unfold z, m in *; lra).
    rewrite (Rabs_pos_eq z) in E by assumption.
    assert (u * z <= u * ((1 + / 1000) * m + U)) by (apply Rmult_le_compat_l; lra).
    assert (UU : u * U <= / 1000000 * U) by (rewrite u_val; lra).
    replace (u * ((1 + / 1000) * m + U)) with ((1 + / 1000) * e + u * U) in * by (unfold e; ring).
    apply Rabs_le_inv in E. unfold z in *. lra.
Qed.
End Node.

(* A node whose sphere (radius r, from its center to the origin X) holds a hit at the exact t',
  rounded to t in the range,
   is visited: the chord is not negative, it begins no later than the last value along the ray and ends no sooner than
   the first. *)
Theorem MARGIN_holds : forall X1 X2 X3 e1 e2 e3 r x1 x2 x3 d1 d2 d3 n far reach p1 p2 p3 aside unit length t t' start
  last,
  let s := - (X1 * e1 + X2 * e2 + X3 * e3) in let p := norm (X1 + s * e1) (X2 + s * e2) (X3 + s * e3) in
  let y x := X x 1025 in let one d := X d 1 in
  norm e1 e2 e3 = 1 -> 0 <= r -> p <= r ->
  Rabs (x1 - X1) <= u * Rabs X1 + bp (-1072) -> Rabs (x2 - X2) <= u * Rabs X2 + bp (-1072) ->
  Rabs (x3 - X3) <= u * Rabs X3 + bp (-1072) -> Rabs (d1 - e1) <= 5 * u * Rabs e1 + bp (-1000) ->
  Rabs (d2 - e2) <= 5 * u * Rabs e2 + bp (-1000) -> Rabs (d3 - e3) <= 5 * u * Rabs e3 + bp (-1000) ->
  Rabs x1 <= bp 1025 -> Rabs x2 <= bp 1025 -> Rabs x3 <= bp 1025 -> Rabs n <= bp 1025 -> Rabs p1 <= bp 1025 ->
  Rabs p2 <= bp 1025 -> Rabs p3 <= bp 1025 -> Rabs r <= bp 1025 -> Rabs far <= bp 1025 ->
  plain (Add (Mul (y x1) (one d1)) (Add (Mul (y x2) (one d2)) (Mul (y x3) (one d3)))) n ->
  plain (Add (Add (Abs (y x1)) (Abs (y x2))) (Add (Abs (y x3)) (y r))) far ->
  plain (Add (y r) (Add (Mul (X MARGIN (-47)) (y far)) (X UNDERFLOW (-100)))) reach ->
  plain (Add (Mul (y (- n)) (one d1)) (y x1)) p1 -> plain (Add (Mul (y (- n)) (one d2)) (y x2)) p2 ->
  plain (Add (Mul (y (- n)) (one d3)) (y x3)) p3 ->
  plain (Add (Mul (y p1) (y p1)) (Add (Mul (y p2) (y p2)) (Mul (y p3) (y p3)))) aside ->
  / LONGEST <= unit < LONGEST -> Rabs (unit - length) <= 4 * u * unit -> Rabs (t - t') <= u * Rabs t' + bp (-1075) ->
  Rabs (t' * length - s) <= sqrt (r * r - p * p) -> start <= t <= last ->
  let chord := RN (RN (reach * reach) - aside) in let half := RN (sqrt chord) in
  0 <= chord /\ RN (- n - half) <= RN (last * unit) /\ RN (RN (start * unit) - - n) <= half.
Proof.
  intros. subst y one. cbv beta in *.
  apply (met X1 X2 X3 e1 e2 e3 r) with (x1 := x1) (x2 := x2) (x3 := x3) (d1 := d1) (d2 := d2) (d3 := d3) (far := far)
    (p1 := p1) (p2 := p2) (p3 := p3) (length := length) (t := t) (t' := t'); assumption.
Qed.
