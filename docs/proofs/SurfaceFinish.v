(* rt-geom, surface/finish.rs: the exact root as t and a step, and what rests on it: which root is hit, the vector to
  the
   hit, the side of a point. `n` is what double-double knows of the vector from the center to the point of the ray. *)
From Proofs Require Import Rounding ErrorFree DoubleDouble Twice Steps.
Open Scope R_scope.

(* The error of f = n.n - r^2, relative to n.n + r^2. *)
Definition RESIDUAL_ERROR := 40 * u * u.
(* The error of g = n.d, relative to the sizes of both. *)
Definition SLOPE_ERROR := 42 / 10 * u.
(* The error of g^2 - a f, relative to a n.n + a |f|. *)
Definition DELTA_ERROR := 16 * u.
(* The discriminant is certain beyond so many of its errors; the error of its root, relative to that of itself over the
   root, and its rounding. *)
Definition CERTAIN := 16.
Definition ROOT_ERROR := 6 / 10.
Definition ROOT_ROUNDING := 11 / 10 * u.
(* The errors of both roots, relative to what they are made of, and their roundings. *)
Definition LARGE_FACTOR := 101 / 100.
Definition LARGE_ROUNDING := 6 * u.
Definition SMALL_FACTOR := 101 / 100.
Definition SMALL_ROUNDING := 3 * u.
(* Parts of the spacing, below which a root surely rounds to t, and beyond which it surely does not. *)
Definition HALF_BELOW := 49999 / 100000.
Definition HALF_ABOVE := 50001 / 100000.
(* Coordinates, radius and t are at most that. *)
Definition FARTHEST := bp 300.
(* Swallows what underflows. *)
Definition UNDERFLOW := bp (-900).

(* ---- Which root ---- *)
(* A double and its neighbours. *)
Lemma succ_gt : forall t, t < succ radix2 fexp t.
Proof.
  intro t. destruct (Req_dec t 0) as [Z|N]; [|now apply succ_gt_id].
  rewrite Z, succ_0. unfold fexp. rewrite ulp_FLT_0 by reflexivity. apply bp_pos.
Qed.
Lemma pred_lt : forall t, pred radix2 fexp t < t.
Proof. intro t. unfold pred. pose proof (succ_gt (- t)). lra. Qed.
Lemma beyond_above : forall t x, F t -> (succ radix2 fexp t - t) / 2 < x -> t < RN (t + x).
Proof.
  intros t x Ft H. pose proof (succ_gt t). apply Rlt_le_trans with (succ radix2 fexp t); [assumption|].
  apply (round_N_ge_midp radix2 fexp even); [apply generic_format_succ; auto with typeclass_instances|].
  rewrite pred_succ by auto with typeclass_instances. lra.
Qed.
Lemma beyond_below : forall t x, F t -> x < - ((t - pred radix2 fexp t) / 2) -> RN (t + x) < t.
Proof.
  intros t x Ft H. pose proof (pred_lt t). apply Rle_lt_trans with (pred radix2 fexp t); [|assumption].
  apply (round_N_le_midp radix2 fexp even); [apply generic_format_pred; auto with typeclass_instances|].
  rewrite succ_pred by auto with typeclass_instances. lra.
Qed.
Lemma within_both : forall t x, F t -> - ((t - pred radix2 fexp t) / 2) < x < (succ radix2 fexp t - t) / 2 -> RN (t +
  x) = t.
Proof.
  intros t x Ft H. apply Rle_antisym.
  - apply (round_N_le_midp radix2 fexp even); [assumption | lra].
  - apply (round_N_ge_midp radix2 fexp even); [assumption | lra].
Qed.
(* The spacing below is at least half of the one above. *)
Lemma spacings : forall t, F t -> succ radix2 fexp t - t <= 2 * (t - pred radix2 fexp t).
Proof.
  assert (P : forall s, F s -> 0 < s -> s - pred radix2 fexp s = ulp radix2 fexp (pred radix2 fexp s) /\ 0 <= pred
    radix2 fexp s).
  { intros s Fs S. assert (0 <= pred radix2 fexp s) by (apply pred_ge_0; auto with typeclass_instances). split;
    [|assumption].
    pose proof (succ_pred radix2 fexp s Fs) as E. rewrite succ_eq_pos in E by assumption. lra. }
  intros t Ft. destruct (Rtotal_order t 0) as [C|[C|C]].
  - destruct (P (- t) (F_opp t Ft) ltac:(lra)) as [E Q].
    assert (U : ulp radix2 fexp (pred radix2 fexp (- t)) <= ulp radix2 fexp (- t)).
    { apply ulp_le_pos; auto with typeclass_instances. apply Rlt_le, pred_lt. }
    assert (S1 : succ radix2 fexp t = - pred radix2 fexp (- t)) by (unfold pred; rewrite !Ropp_involutive; reflexivity).
    assert (S2 : t - pred radix2 fexp t = ulp radix2 fexp (- t)) by (unfold pred; rewrite succ_eq_pos by lra; ring).
    pose proof (ulp_ge_0 radix2 fexp (- t)). lra.
  - rewrite C, succ_0, pred_0. pose proof (ulp_ge_0 radix2 fexp 0). lra.
  - destruct (P t Ft C) as [E Q]. rewrite E. rewrite succ_eq_pos by lra.
    set (p := pred radix2 fexp t) in *. assert (Fp : F p) by (apply generic_format_pred; auto with typeclass_instances).
    assert (T : succ radix2 fexp p = t) by (apply succ_pred; auto with typeclass_instances).
    pose proof (ulp_ge_0 radix2 fexp p).
    destruct (Req_dec p 0) as [Z|N].
    { assert (t = ulp radix2 fexp 0) by (rewrite <- T, Z; apply succ_0). rewrite Z. unfold fexp in *. rewrite
      ulp_FLT_0 in *
        by reflexivity. rewrite H0, ulp_neq_0 by (pose proof (bp_pos (-1074)); lra). unfold cexp, FLT_exp.
      rewrite mag_bpow. change (Z.max (-1074 + 1 - 53) (-1074))%Z with (-1074)%Z. pose proof (bp_pos (-1074)). lra. }
    destruct (ulp_succ_pos radix2 fexp p Fp ltac:(lra)) as [U|U]; rewrite T in U.
    + rewrite U. lra.
    + assert (ulp radix2 fexp t <= 2 * ulp radix2 fexp p); [|lra]. rewrite !ulp_neq_0 by lra. unfold cexp. rewrite U,
      mag_bpow.
      set (m := mag_val radix2 p (mag radix2 p)).
      apply Rle_trans with (bp (1 + fexp m)); [apply bp_le; unfold fexp, FLT_exp; lia | rewrite bp_add, bp_1; lra].
Qed.

Section Root.
(* Around t: A x^2 + 2 G x + FF = 0, as computed a, g, f in double-double, whose high part has its sign, and the
   discriminant delta. *)
Variables t A G FF a g f delta fe : R.
Hypotheses (Ft : F t) (A0 : 0 < A) (D0 : 0 < delta).
Let Delta := G * G - A * FF.
Hypotheses (Ha : Rabs (a - A) <= (3 + / 100) * u * A) (Hdelta : Rabs (delta - Delta) <= delta / 16)
  (Hg : Rabs (g - G) <= / 1000 * sqrt delta) (Hf : Rabs (f - FF) <= fe) (Hfe : 16 * (a * fe) <= (1 + 16 * u) * delta).
Let near := (- G - sqrt Delta) / A.
Let far := (- G + sqrt Delta) / A.
(* t is the rounding of one of them *)
Hypothesis Ht : RN (t + near) = t \/ RN (t + far) = t.
(* the near root as computed; where it is positive, the code has g < 0 and f > 0 *)
Variables v e : R.
Hypotheses (Hv : Rabs (v - near) <= e) (Hs : 0 < v -> g < 0 /\ 0 < f).
Let spacing := if Rlt_dec 0 v then succ radix2 fexp t - t else t - pred radix2 fexp t.

Theorem HALF_BELOW_holds : RN (Rabs v + e) < RN (RN HALF_BELOW * spacing) -> RN (t + near) = t.
Proof.
  intro H. apply RN_lt in H. pose proof (succ_gt t) as S1. pose proof (pred_lt t) as S2.
  assert (HB : RN HALF_BELOW <= / 2).
  { replace (/ 2) with (bp (-1)) by (simpl; lra). rewrite <- (RN_id (bp (-1))) by (apply F_bp; lia). apply RN_le.
    unfold HALF_BELOW. simpl. lra. }
  destruct (Req_dec (RN (t + near)) t) as [Y|N]; [exact Y | exfalso]. destruct Ht as [Y|Far]; [contradiction|].
  pose proof (sqrt_pos Delta) as Q0.
  assert (NF : near <= far).
  { unfold near, far, Rdiv. apply Rmult_le_compat_r; [apply Rlt_le, Rinv_0_lt_compat; assumption | lra]. }
  assert (S0 : 0 < spacing) by (unfold spacing; destruct Rlt_dec; lra).
  assert (V : Rabs v + e < / 2 * spacing).
  { eapply Rlt_le_trans; [exact H|]. apply Rmult_le_compat_r; lra. }
  assert (NV : Rabs near < / 2 * spacing).
  { replace near with (v - (v - near)) by ring. eapply Rle_lt_trans; [apply Rabs_minus_le; [apply Rle_refl | exact Hv]
    | exact V]. }
  apply Rabs_def2 in NV. unfold spacing in *. clear spacing. destruct (Rlt_dec 0 v) as [P|P].
  - (* near is at least a quarter of the spacing below t *)
    assert (NQ : near <= - ((succ radix2 fexp t - t) / 4)).
    { apply Rnot_lt_le. intro L. apply N. apply within_both; [assumption|]. pose proof (spacings t Ft). split; lra. }
    assert (FQ : far <= (succ radix2 fexp t - t) / 2).
    { apply Rnot_lt_le. intro L. pose proof (beyond_above t far Ft L). lra. }
    destruct (Hs P) as [G0 f0]. set (S := succ radix2 fexp t - t) in *. assert (SP : 0 < S) by (unfold S; lra).
    set (q := sqrt delta) in *. assert (qq : q * q = delta) by (apply sqrt_sqrt; lra).
    assert (q0 : 0 < q) by (apply sqrt_lt_R0; assumption).
    apply Rabs_le_inv in Hdelta. assert (DP : 0 <= Delta) by lra.
    assert (R : 968 / 1000 * q <= sqrt Delta).
    { apply below_root; [assumption|]. rewrite sqrt_sqrt by assumption. nra. }
    assert (AF : 967 / 1000 * q <= A * far).
    { replace (A * far) with (- G + sqrt Delta) by (unfold far; field; lra). apply Rabs_le_inv in Hg. lra. }
    assert (FA : FF = A * (near * far)).
    { assert (E : sqrt Delta * sqrt Delta = Delta) by (apply sqrt_sqrt; assumption).
      replace (A * (near * far)) with ((G * G - sqrt Delta * sqrt Delta) / A) by (unfold near, far; field; lra).
      rewrite E. unfold Delta. field. lra. }
    (* so FF < 0 < f, by more than the error of f *)
    assert (FL : S / 4 * (967 / 1000 * q) <= fe).
    { apply Rle_trans with (- near * (A * far)).
      - apply Rmult_le_compat; lra.
      - apply Rabs_le_inv in Hf. rewrite FA in Hf. lra. }
    assert (a1 : 99 / 100 * A <= a) by (apply Rabs_le_inv in Ha; rewrite u_val in Ha; lra).
    assert (K : 99 / 100 * A * (S / 4 * (967 / 1000 * q)) <= a * fe).
    { apply Rmult_le_compat; try lra. apply Rmult_le_pos; lra. }
    assert (K2 : 38 / 10 * (A * S) * q <= (1 + / 1000) * q * q) by (rewrite <- qq in Hfe; rewrite u_val in Hfe; lra).
    apply Rmult_le_reg_r in K2; [|assumption].
    assert (K3 : A * far <= A * (S / 2)) by (apply Rmult_le_compat_l; lra).
    assert (0 < A * S) by (apply Rmult_lt_0_compat; assumption). lra.
  - (* then far lies above t as well *)
    destruct (Rle_or_lt near ((succ radix2 fexp t - t) / 2)) as [L|L].
    + destruct (Rle_lt_or_eq_dec _ _ L) as [L2|L2]; [apply N, within_both; [assumption | split; lra]|].
      assert (RN (t + near) <= RN (t + far)) by (apply RN_le; lra).
      assert (t <= RN (t + near)) by (rewrite <- (RN_id t Ft) at 1; apply RN_le; lra).
      apply N. lra.
    + pose proof (beyond_above t near Ft L). assert (RN (t + near) <= RN (t + far)) by (apply RN_le; lra). lra.
Qed.
Theorem HALF_ABOVE_holds : RN (RN HALF_ABOVE * spacing) < RN (Rabs v - e) -> RN (t + near) <> t.
Proof.
  intro H. apply RN_lt in H. pose proof (succ_gt t) as S1. pose proof (pred_lt t) as S2.
  assert (HB : / 2 <= RN HALF_ABOVE).
  { replace (/ 2) with (bp (-1)) by (simpl; lra). rewrite <- (RN_id (bp (-1))) by (apply F_bp; lia). apply RN_le.
    unfold HALF_ABOVE. simpl. lra. }
  assert (S0 : 0 < spacing) by (unfold spacing; destruct Rlt_dec; lra).
  assert (V : / 2 * spacing < Rabs v - e).
  { eapply Rle_lt_trans; [|exact H]. apply Rmult_le_compat_r; lra. }
  unfold spacing in *. apply Rabs_le_inv in Hv. destruct (Rlt_dec 0 v) as [P|P].
  - rewrite Rabs_pos_eq in V by lra. pose proof (beyond_above t near Ft ltac:(lra)). lra.
  - rewrite Rabs_left1 in V by lra. pose proof (beyond_below t near Ft ltac:(lra)). lra.
Qed.
End Root.

(* ---- The residual, the slope and the discriminant ---- *)
Lemma twice_product_le : forall k x y, 0 < k -> 2 * (x * y) <= k * (x * x) + y * y / k.
Proof.
  intros k x y K. pose proof (sq_pos (k * x - y)) as S. apply Rmult_le_reg_r with k; [assumption|].
  replace ((k * (x * x) + y * y / k) * k) with (k * k * (x * x) + y * y) by (field; lra). lra.
Qed.
Section Step.
(* the exact n, as it is without what the first step lost, as computed h + l; the direction and the radius *)
Variables N1 N2 N3 M1 M2 M3 h1 h2 h3 l1 l2 l3 d1 d2 d3 r eta : R.
Let n1 := h1 + l1. Let n2 := h2 + l2. Let n3 := h3 + l3.
Let L := len n1 n2 n3. Let D := len d1 d2 d3. Let A := D * D.
Let T := bp (-1060).
Hypotheses (Dd1 : dd h1 l1) (Dd2 : dd h2 l2) (Dd3 : dd h3 l3)
  (E1 : Rabs (n1 - M1) <= 6 * (u * u) * Rabs M1 + T) (E2 : Rabs (n2 - M2) <= 6 * (u * u) * Rabs M2 + T)
  (E3 : Rabs (n3 - M3) <= 6 * (u * u) * Rabs M3 + T) (Eta : len (M1 - N1) (M2 - N2) (M3 - N3) <= eta)
  (B1 : Rabs h1 <= bp 402) (B2 : Rabs h2 <= bp 402) (B3 : Rabs h3 <= bp 402) (Br : bp (-150) <= r <= bp 300)
  (Bd : bp (-100) <= D <= bp 101) (Small : eta <= / 2 * u * r).

Lemma eta_pos : 0 <= eta. Proof. pose proof (len_pos (M1 - N1) (M2 - N2) (M3 - N3)). lra. Qed.
Lemma component_off : forall n M, Rabs (n - M) <= 6 * (u * u) * Rabs M + T ->
  Rabs (n - M) <= (6 + / 1000) * (u * u) * Rabs n + 2 * T /\ Rabs (n * n - M * M) <= (12 + / 100) * (u * u) * (n * n)
    + bp (-1700).
Proof.
  intros n M H. assert (T0 : 0 < T) by apply bp_pos. pose proof (Rabs_triang_inv M n) as I. rewrite (Rabs_minus_sym M)
    in I.
  pose proof (Rabs_pos n). pose proof (Rabs_pos M).
  assert (P : Rabs (n - M) <= (6 + / 1000) * (u * u) * Rabs n + 2 * T) by (rewrite u_val in *; lra). split; [exact P|].
  replace (n * n - M * M) with ((n - M) * (2 * n - (n - M))) by ring. rewrite Rabs_mult.
  assert (Q : Rabs (2 * n - (n - M)) <= (2 + / 100000) * Rabs n + 2 * T).
  { eapply Rle_trans; [apply Rabs_minus_le; [apply Rle_refl | exact P]|]. rewrite Rabs_mult, (Rabs_pos_eq 2) by lra.
    rewrite u_val in *. lra. }
  assert (R : Rabs (n - M) * Rabs (2 * n - (n - M)) <=
    ((6 + / 1000) * (u * u) * Rabs n + 2 * T) * ((2 + / 100000) * Rabs n + 2 * T)) by (apply Rmult_le_compat; auto
      using Rabs_pos).
  eapply Rle_trans; [exact R|]. rewrite <- (abs_sq n). set (x := Rabs n) in *.
  pose proof (twice_product_le (bp (-120)) x T (bp_pos _)) as G.
  assert (TT : T * T = bp (-2120)) by (unfold T; now rewrite <- bp_add).
  assert (G2 : T * T / bp (-120) = bp (-2000)).
  { rewrite TT. unfold Rdiv. change (bp (-120)) with (bpow radix2 (- (120))). rewrite (bpow_opp radix2 120), Rinv_inv.
    rewrite <- bp_add. reflexivity. }
  rewrite G2 in G. assert (K1 : bp (-2120) <= bp (-2000)) by (apply bp_le; lia).
  assert (K2 : bp (-2000) <= / 1000000000000 * bp (-1700)) by (apply bp_part12; lia).
  assert (K3 : bp (-120) <= / 1000 * (u * u)).
  { unfold u. rewrite <- bp_add. apply Rle_trans with (bp (-10) * bp (-53 + -53)); [rewrite <- bp_add; apply bp_le;
    lia|].
    apply Rmult_le_compat_r; [apply Rlt_le, bp_pos | simpl; lra]. }
  pose proof (sq_pos x) as X2. assert (bp (-120) * (x * x) <= / 1000 * (u * u) * (x * x)) by (apply Rmult_le_compat_r;
    lra).
  assert (0 <= x * T) by (apply Rmult_le_pos; lra). pose proof (bp_pos (-1700)).
  replace (((6 + / 1000) * (u * u) * x + 2 * T) * ((2 + / 100000) * x + 2 * T)) with
    ((6 + / 1000) * (2 + / 100000) * (u * u) * (x * x) + (2 * (6 + / 1000) * (u * u) + 2 * (2 + / 100000)) * (x * T) +
      4 * (T * T)) by ring.
  rewrite TT. rewrite u_val in *. lra.
Qed.
Lemma lengths : len (n1 - M1) (n2 - M2) (n3 - M3) <= (6 + / 500) * (u * u) * L + 8 * T /\
  len M1 M2 M3 <= (1 + / 1000000) * L + 8 * T /\ len h1 h2 h3 <= (1 + 2 * u) * L /\ len (h1 - n1) (h2 - n2) (h3 - n3)
    <= (1 + 2 * u) * u * L.
Proof.
  assert (T0 : 0 < T) by apply bp_pos. pose proof u_pos. pose proof (len_pos n1 n2 n3) as L0. fold L in L0.
  destruct (component_off _ _ E1) as [C1 _]. destruct (component_off _ _ E2) as [C2 _]. destruct (component_off _ _
    E3) as [C3 _].
  assert (P : len (n1 - M1) (n2 - M2) (n3 - M3) <= (6 + / 500) * (u * u) * L + 8 * T).
  { eapply Rle_trans; [apply (len_mono _ _ _ ((6 + / 1000) * (u * u) * Rabs n1 + 2 * T) ((6 + / 1000) * (u * u) * Rabs
    n2 + 2 * T)
      ((6 + / 1000) * (u * u) * Rabs n3 + 2 * T))|].
    - eapply Rle_trans; [exact C1 | apply Rle_abs].
    - eapply Rle_trans; [exact C2 | apply Rle_abs].
    - eapply Rle_trans; [exact C3 | apply Rle_abs].
    - eapply Rle_trans; [apply len_add|]. rewrite len_scale by (rewrite u_val; lra).
      assert (len (Rabs n1) (Rabs n2) (Rabs n3) = L) by (unfold L, len; now rewrite !abs_sq). rewrite H0.
      pose proof (len_le_norm1 (2 * T) (2 * T) (2 * T)) as Q. unfold norm1 in Q. rewrite (Rabs_pos_eq (2 * T)) in Q by
        lra.
      rewrite u_val in *. lra. }
  split; [exact P|]. split.
  - pose proof (len_sub M1 M2 M3 n1 n2 n3) as S. fold L in S.
    assert (len (M1 - n1) (M2 - n2) (M3 - n3) = len (n1 - M1) (n2 - M2) (n3 - M3)) by (unfold len; f_equal; ring).
    rewrite u_val in *. lra.
  - assert (C : forall h l, dd h l -> Rabs (h - (h + l)) <= (1 + 2 * u) * u * Rabs (h + l)).
    { intros h l Hd. pose proof (dd_low _ _ Hd). pose proof (dd_value _ _ Hd). replace (h - (h + l)) with (- l) by ring.
      rewrite Rabs_Ropp. pose proof (Rabs_pos h). rewrite u_val in *. lra. }
    assert (Q : len (h1 - n1) (h2 - n2) (h3 - n3) <= (1 + 2 * u) * u * L).
    { apply len_part; [rewrite u_val; lra | now apply C | now apply C | now apply C]. }
    split; [|exact Q]. pose proof (len_sub h1 h2 h3 n1 n2 n3) as S. fold L in S. rewrite u_val in *. lra.
Qed.

(* f in double-double against N.N - r^2 *)
Let FF := N1 * N1 + N2 * N2 + N3 * N3 - r * r.
Definition tf x1 x2 x3 := Sub (tdot (X x1 403) (X x2 403) (X x3 403) (X x1 403) (X x2 403) (X x3 403)) (XX r r 600).
Variables f square fe : R.
Hypotheses (Hf : twice (tf n1 n2 n3) f) (Hsquare : (1 - 8 * u) * (L * L) - T <= square)
  (Hfe : (1 - 16 * u) * (RESIDUAL_ERROR * (square + r * r) + 21 / 10 * (eta * sqrt square) + UNDERFLOW) <= fe).

Lemma residual : Rabs (f - FF) <= (39 + 2 / 10) * (u * u) * (L * L) + (27 + 4 / 10) * (u * u) * (r * r) + (2 + / 1000)
  * (eta * L)
  + / 1000 * UNDERFLOW.
Proof.
  pose proof eta_pos as H0. assert (T0 : 0 < T) by apply bp_pos. pose proof u_pos. pose proof (len_pos n1 n2 n3) as
    L0. fold L in L0.
  assert (R0 : 0 < r) by (pose proof (bp_pos (-150)); lra). assert (U0 : 0 < UNDERFLOW) by apply bp_pos.
  destruct (component_off _ _ E1) as [_ C1]. destruct (component_off _ _ E2) as [_ C2]. destruct (component_off _ _
    E3) as [_ C3].
  destruct lengths as (_ & LM & _ & _).
  assert (LL : n1 * n1 + n2 * n2 + n3 * n3 = L * L) by (unfold L; now rewrite len_sq).
  assert (V : forall h l, dd h l -> Rabs h <= bp 402 -> Rabs (h + l) <= bp 403).
  { intros h l Hd Hh. destruct (dd_value _ _ Hd) as [_ V]. assert (bp 403 = 2 * bp 402) by
      (change 403%Z with (1 + 402)%Z; rewrite bp_add, bp_1; ring). pose proof (Rabs_pos h). rewrite u_val in V. lra. }
  assert (B : bounded (tf n1 n2 n3)).
  { unfold tf, tdot. cbn [bounded]. repeat split; try (apply V; assumption). rewrite Rabs_mult. change 600%Z with (300
    + 300)%Z.
    rewrite bp_add. rewrite (Rabs_pos_eq r) by lra. apply Rmult_le_compat; lra. }
  pose proof (twice_error_at _ f 27 (low2 (tf n1 n2 n3)) Hf B eq_refl eq_refl ltac:(lia)) as Q.
  assert (SZ : size (tf n1 n2 n3) = L * L + r * r).
  { unfold tf, tdot. cbn [size]. rewrite !abs_sq, LL, (Rabs_pos_eq (r * r)) by apply sq_pos. reflexivity. }
  assert (EX : exact (tf n1 n2 n3) = L * L - r * r) by (unfold tf, tdot; cbn [exact]; rewrite LL; reflexivity).
  rewrite SZ, EX in Q.
  assert (LT : bp (low2 (tf n1 n2 n3)) <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; vm_compute; discriminate).
  assert (K1 : bp (-1700) <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; lia).
  (* what the first step lost *)
  pose proof (dot_off M1 M2 M3 M1 M2 M3 N1 N2 N3 N1 N2 N3) as O.
  set (el := len (M1 - N1) (M2 - N2) (M3 - N3)) in *. assert (e0 : 0 <= el) by apply len_pos.
  assert (O2 : el * len M1 M2 M3 + len M1 M2 M3 * el + el * el <= (2 + / 100000) * (eta * L) + 3 / 10 * (u * u) * (r *
    r)).
  { pose proof (len_pos M1 M2 M3) as M0.
    assert (X1 : el * len M1 M2 M3 <= eta * ((1 + / 1000000) * L + 8 * T)) by (apply Rmult_le_compat; assumption).
    assert (X2 : el * el <= (/ 2 * u * r) * (/ 2 * u * r)) by (apply Rmult_le_compat; lra).
    assert (X3 : eta * T <= / 1000 * (u * u) * (r * r)).
    { apply Rle_trans with ((/ 2 * u * r) * (u * / 1000 * r)); [|rewrite u_val; pose proof (sq_pos r); lra].
      apply Rmult_le_compat; try lra. apply Rle_trans with (u * / 1000 * bp (-150)).
      - unfold T, u. apply Rle_trans with (bp (-53) * bp (-10) * bp (-150)); [rewrite <- !bp_add; apply bp_le; lia|].
        apply Rmult_le_compat_r; [apply Rlt_le, bp_pos|]. apply Rmult_le_compat_l; [apply Rlt_le, bp_pos | simpl; lra].
      - apply Rmult_le_compat_l; lra. }
    replace (len M1 M2 M3 * el) with (el * len M1 M2 M3) by ring.
    replace (eta * ((1 + / 1000000) * L + 8 * T)) with ((1 + / 1000000) * (eta * L) + 8 * (eta * T)) in X1 by ring.
    replace ((/ 2 * u * r) * (/ 2 * u * r)) with (/ 4 * (u * u) * (r * r)) in X2 by field.
    assert (0 <= eta * L) by (apply Rmult_le_pos; assumption). pose proof (sq_pos r). rewrite u_val in *. lra. }
  replace (f - FF) with ((f - (L * L - r * r)) + ((n1 * n1 - M1 * M1) + (n2 * n2 - M2 * M2) + (n3 * n3 - M3 * M3))
    + (M1 * M1 + M2 * M2 + M3 * M3 - (N1 * N1 + N2 * N2 + N3 * N3))) by (unfold FF; rewrite <- LL; ring).
  eapply Rle_trans; [apply Rabs_plus_le; [apply Rabs_plus_le; [exact Q |
    apply Rabs_plus_le; [apply Rabs_plus_le; [exact C1 | exact C2] | exact C3]] | eapply Rle_trans; [exact O | exact
      O2]]|].
  assert (0 <= eta * L) by (apply Rmult_le_pos; assumption). pose proof (sq_pos r).
  replace ((12 + / 100) * (u * u) * (n1 * n1) + bp (-1700) + ((12 + / 100) * (u * u) * (n2 * n2) + bp (-1700)) +
    ((12 + / 100) * (u * u) * (n3 * n3) + bp (-1700))) with ((12 + / 100) * (u * u) * (L * L) + 3 * bp (-1700)) by
      (rewrite <- LL; ring).
  pose proof (sq_pos L). rewrite u_val in *. lra.
Qed.
(* The bound, through at most 16 roundings. *)
Lemma bound_of_residual : (40 - / 1000) * (u * u) * (L * L + r * r) + (2 + / 20) * (eta * L) + 99 / 100 * UNDERFLOW <=
  fe.
Proof.
  pose proof eta_pos as H0. assert (T0 : 0 < T) by apply bp_pos. pose proof u_pos. pose proof (len_pos n1 n2 n3) as
    L0. fold L in L0.
  assert (R0 : 0 < r) by (pose proof (bp_pos (-150)); lra). assert (U0 : 0 < UNDERFLOW) by apply bp_pos.
  assert (LT : T <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; lia).
  assert (K : (2 + 9 / 100) * (eta * L) <= 21 / 10 * (eta * sqrt square) + / 1000000 * (u * u) * (r * r)).
  { destruct (Rle_or_lt L (bp (-500))) as [S|S].
    - assert (eta * L <= (/ 2 * u * r) * bp (-500)) by (apply Rmult_le_compat; assumption).
      assert (r * bp (-500) <= / 10000000 * u * (r * r)).
      { replace (/ 10000000 * u * (r * r)) with (r * (/ 10000000 * u * r)) by ring. apply Rmult_le_compat_l; [lra|].
        apply Rle_trans with (/ 10000000 * u * bp (-150)).
        - apply Rle_trans with (bp (-30) * bp (-53) * bp (-150)); [rewrite <- !bp_add; apply bp_le; lia|].
          apply Rmult_le_compat_r; [apply Rlt_le, bp_pos|]. apply Rmult_le_compat_r; [apply Rlt_le, bp_pos | simpl;
            lra].
        - apply Rmult_le_compat_l; [rewrite u_val; lra | lra]. }
      pose proof (sqrt_pos square). assert (0 <= eta * sqrt square) by (apply Rmult_le_pos; assumption).
      assert (/ 2 * u * (r * bp (-500)) <= / 2 * u * (/ 10000000 * u * (r * r))) by (apply Rmult_le_compat_l; [rewrite
        u_val|]; lra).
      pose proof (sq_pos r). rewrite u_val in *. lra.
    - assert (LL : bp (-1000) <= L * L) by (change (-1000)%Z with (-500 + -500)%Z; rewrite bp_add; pose proof (bp_pos
      (-500));
        apply Rmult_le_compat; lra).
      assert (TL : T <= / 1000000000000 * bp (-1000)) by (apply bp_part12; lia).
      assert ((1 - / 1000) * L <= sqrt square).
      { apply below_root; [apply sqrt_pos|]. rewrite sqrt_sqrt by (rewrite u_val in *; lra). rewrite u_val in *. lra. }
      assert (eta * ((1 - / 1000) * L) <= eta * sqrt square) by (apply Rmult_le_compat_l; assumption).
      assert (0 <= eta * L) by (apply Rmult_le_pos; assumption). pose proof (sq_pos r). rewrite u_val in *. lra. }
  unfold RESIDUAL_ERROR in Hfe. pose proof (sq_pos r). pose proof (sq_pos L). assert (0 <= eta * L) by (apply
    Rmult_le_pos; assumption).
  pose proof (sqrt_pos square). assert (0 <= eta * sqrt square) by (apply Rmult_le_pos; assumption).
  set (es := eta * sqrt square) in *. set (el := eta * L) in *. clearbody es el. rewrite u_val in *. lra.
Qed.
Theorem RESIDUAL_ERROR_holds : Rabs (f - FF) <= fe.
Proof.
  eapply Rle_trans; [exact residual|]. eapply Rle_trans; [|exact bound_of_residual]. pose proof eta_pos as H0.
  pose proof (len_pos n1 n2 n3) as L0. fold L in L0. assert (U0 : 0 < UNDERFLOW) by apply bp_pos.
  assert (0 <= eta * L) by (apply Rmult_le_pos; assumption). pose proof (sq_pos r). pose proof (sq_pos L). rewrite
    u_val in *. lra.
Qed.

(* g in doubles against N.d *)
Let G := N1 * d1 + N2 * d2 + N3 * d3.
Let tau := bp (-940).
Variables g hn dn ge : R.
Definition tg x1 x2 x3 y1 y2 y3 := tdot (X x1 402) (X x2 402) (X x3 402) (X y1 101) (X y2 101) (X y3 101).
Hypotheses (Hg : plain (tg h1 h2 h3 d1 d2 d3) g) (Hhn : (1 - 4 * u) * norm1 h1 h2 h3 <= hn) (Hdn : (1 - 4 * u) * norm1
  d1 d2 d3 <= dn)
  (Hge : (1 - 16 * u) * (SLOPE_ERROR * (hn * dn) + 101 / 100 * (eta * dn) + UNDERFLOW) <= ge).

Lemma slope : Rabs (g - G) <= (3 + / 100) * u * (Rabs h1 * Rabs d1 + Rabs h2 * Rabs d2 + Rabs h3 * Rabs d3)
    + (1 + / 100) * u * (L * D) + eta * D + tau /\ Rabs g <= (1 + 8 * u) * (L * D) + tau.
Proof.
  pose proof eta_pos as H0. assert (T0 : 0 < T) by apply bp_pos. pose proof u_pos. pose proof (len_pos n1 n2 n3) as
    L0. fold L in L0.
  pose proof (len_pos d1 d2 d3) as D0. fold D in D0. destruct lengths as (P1 & _ & P3 & P4).
  assert (B : bounded (tg h1 h2 h3 d1 d2 d3)).
  { destruct (len_component d1 d2 d3) as (Q1 & Q2 & Q3). fold D in Q1, Q2, Q3. unfold tg, tdot. cbn [bounded].
    repeat split; try assumption; lra. }
  pose proof (plain_error_at _ g 3 (low (tg h1 h2 h3 d1 d2 d3)) Hg B eq_refl eq_refl ltac:(lia)) as Q.
  unfold tg, tdot in Q. cbn [exact size] in Q. fold (tdot (X h1 402) (X h2 402) (X h3 402) (X d1 101) (X d2 101) (X d3
    101)) in Q.
  fold (tg h1 h2 h3 d1 d2 d3) in Q. set (S := Rabs h1 * Rabs d1 + Rabs h2 * Rabs d2 + Rabs h3 * Rabs d3) in *.
  assert (LT : bp (low (tg h1 h2 h3 d1 d2 d3)) <= / 1000000000000 * tau) by (apply bp_part12; vm_compute; discriminate).
  assert (S1 : S <= (1 + 2 * u) * (L * D)).
  { pose proof (abs_dot h1 h2 h3 d1 d2 d3) as K. fold S in K. fold D in K. assert (len h1 h2 h3 * D <= (1 + 2 * u) * L
    * D) by
      (apply Rmult_le_compat_r; assumption). lra. }
  pose proof (len_dot (h1 - n1) (h2 - n2) (h3 - n3) d1 d2 d3) as K1. pose proof (len_dot (n1 - M1) (n2 - M2) (n3 - M3)
    d1 d2 d3) as K2.
  pose proof (len_dot (M1 - N1) (M2 - N2) (M3 - N3) d1 d2 d3) as K3. fold D in K1, K2, K3.
  assert (K1' : len (h1 - n1) (h2 - n2) (h3 - n3) * D <= (1 + 2 * u) * u * L * D) by (apply Rmult_le_compat_r;
    assumption).
  assert (K2' : len (n1 - M1) (n2 - M2) (n3 - M3) * D <= ((6 + / 500) * (u * u) * L + 8 * T) * D) by (apply
    Rmult_le_compat_r; assumption).
  assert (K3' : len (M1 - N1) (M2 - N2) (M3 - N3) * D <= eta * D) by (apply Rmult_le_compat_r; assumption).
  assert (TD : T * D <= / 1000 * tau).
  { apply Rle_trans with (T * bp 101); [apply Rmult_le_compat_l; lra|]. apply Rle_trans with (bp (-10) * tau).
    - unfold T, tau. rewrite <- !bp_add. apply bp_le. lia.
    - apply Rmult_le_compat_r; [apply Rlt_le, bp_pos | simpl; lra]. }
  assert (LD : 0 <= L * D) by (apply Rmult_le_pos; assumption). assert (0 < tau) by apply bp_pos.
  replace (((6 + / 500) * (u * u) * L + 8 * T) * D) with ((6 + / 500) * (u * u) * (L * D) + 8 * (T * D)) in K2' by ring.
  replace ((1 + 2 * u) * u * L * D) with ((1 + 2 * u) * u * (L * D)) in K1' by ring. split.
  - replace (g - G) with ((g - (h1 * d1 + h2 * d2 + h3 * d3)) + ((h1 - n1) * d1 + (h2 - n2) * d2 + (h3 - n3) * d3)
      + ((n1 - M1) * d1 + (n2 - M2) * d2 + (n3 - M3) * d3) + ((M1 - N1) * d1 + (M2 - N2) * d2 + (M3 - N3) * d3)) by
        (unfold G; ring).
    eapply Rle_trans; [apply Rabs_plus_le; [apply Rabs_plus_le; [apply Rabs_plus_le; [exact Q | exact K1] | exact K2]
      | exact K3]|].
    assert (0 <= S) by (unfold S; pose proof (Rabs_pos h1); pose proof (Rabs_pos h2); pose proof (Rabs_pos h3); pose
      proof (Rabs_pos d1);
      pose proof (Rabs_pos d2); pose proof (Rabs_pos d3); repeat apply Rplus_le_le_0_compat; apply Rmult_le_pos;
        assumption).
    clear - Q K1' K2' K3' TD LT LD H H1 H2. rewrite u_val in *. lra.
  - pose proof (len_dot h1 h2 h3 d1 d2 d3) as K4. fold D in K4.
    assert (K4' : len h1 h2 h3 * D <= (1 + 2 * u) * L * D) by (apply Rmult_le_compat_r; assumption).
    replace g with ((g - (h1 * d1 + h2 * d2 + h3 * d3)) + (h1 * d1 + h2 * d2 + h3 * d3)) by ring.
    eapply Rle_trans; [apply Rabs_plus_le; [exact Q | exact K4]|]. rewrite u_val in *. lra.
Qed.
Theorem SLOPE_ERROR_holds : Rabs (g - G) <= ge.
Proof.
  destruct slope as [S _]. eapply Rle_trans; [exact S|]. eapply Rle_trans; [|exact Hge]. pose proof eta_pos as H0.
  pose proof (norm1_pos h1 h2 h3) as H1. pose proof (norm1_pos d1 d2 d3) as H2. pose proof (len_pos d1 d2 d3) as D0.
    fold D in D0.
  pose proof (len_le_norm1 d1 d2 d3) as D1. fold D in D1. pose proof (len_pos n1 n2 n3) as L0. fold L in L0. pose
    proof u_pos.
  assert (L1 : L <= (1 + 3 * u) * norm1 h1 h2 h3).
  { destruct lengths as (_ & _ & _ & P4). pose proof (len_sub n1 n2 n3 h1 h2 h3) as Y. fold L in Y.
    assert (len (n1 - h1) (n2 - h2) (n3 - h3) = len (h1 - n1) (h2 - n2) (h3 - n3)) by (unfold len; f_equal; ring).
    pose proof (len_le_norm1 h1 h2 h3). rewrite u_val in *. lra. }
  set (x := norm1 h1 h2 h3) in *. set (y := norm1 d1 d2 d3) in *.
  assert (X1 : Rabs h1 * Rabs d1 + Rabs h2 * Rabs d2 + Rabs h3 * Rabs d3 <= x * y).
  { unfold x, y, norm1. pose proof (Rabs_pos h1). pose proof (Rabs_pos h2). pose proof (Rabs_pos h3). pose proof
    (Rabs_pos d1).
    pose proof (Rabs_pos d2). pose proof (Rabs_pos d3).
    repeat match goal with H1 : 0 <= Rabs ?a, H2 : 0 <= Rabs ?b |- _ => lazymatch goal with
      | H : 0 <= Rabs a * Rabs b |- _ => fail | _ => pose proof (Rmult_le_pos _ _ H1 H2) end end. lra. }
  assert (X2 : L * D <= (1 + 3 * u) * x * y) by (apply Rmult_le_compat; assumption).
  assert (X3 : eta * D <= eta * y) by (apply Rmult_le_compat_l; assumption).
  assert (X4 : (1 - 4 * u) * x * ((1 - 4 * u) * y) <= hn * dn) by (apply Rmult_le_compat; try assumption; apply
    Rmult_le_pos; try assumption; rewrite u_val; lra).
  assert (X5 : eta * ((1 - 4 * u) * y) <= eta * dn) by (apply Rmult_le_compat_l; assumption).
  assert (X6 : tau <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; lia).
  assert (U0 : 0 < UNDERFLOW) by apply bp_pos. assert (0 <= x * y) by (apply Rmult_le_pos; assumption).
  assert (0 <= eta * y) by (apply Rmult_le_pos; assumption). unfold SLOPE_ERROR.
  replace ((1 - 4 * u) * x * ((1 - 4 * u) * y)) with ((1 - 4 * u) * (1 - 4 * u) * (x * y)) in X4 by ring.
  replace (eta * ((1 - 4 * u) * y)) with ((1 - 4 * u) * (eta * y)) in X5 by ring.
  replace ((1 + 3 * u) * x * y) with ((1 + 3 * u) * (x * y)) in X2 by ring.
  set (p := x * y) in *. set (q := hn * dn) in *. set (e1 := eta * y) in *. set (e2 := eta * dn) in *.
  clear - X1 X2 X3 X4 X5 X6 U0 H3 H4. rewrite u_val in *. lra.
Qed.

(* the discriminant *)
Variables a fh fl delta sz de : R.
Hypotheses (Ha : Rabs (a - A) <= (3 + / 100) * u * A) (Ffl : dd fh fl) (Ef : f = fh + fl) (Hdelta : delta = RN (RN (g
  * g) - RN (a * fh)))
  (Hsz : (1 - 8 * u) * (a * square + a * Rabs fh) <= sz)
  (Hde : (1 - 16 * u) * (DELTA_ERROR * sz + 21 / 10 * (Rabs g * (eta * dn)) + a * fe + UNDERFLOW) <= de).

(* The parts of the error, and what the bound has for each; k is |g| eta |d|. *)
Lemma delta_parts : exists k, 0 <= k /\ k <= (1 + / 1000) * (A * (eta * L)) + u * u * (A * (r * r)) + / 1000000 *
  UNDERFLOW /\
  Rabs (delta - (G * G - A * FF)) <= (10 + / 5) * u * (A * (L * L)) + (7 + / 5) * u * (a * Rabs fh) + 28 * (u * u) *
    (A * (r * r))
    + (2 + / 100) * (A * (eta * L)) + 2 * k + / 100 * UNDERFLOW + / 500 * (A * UNDERFLOW) /\
  (16 - / 1000) * u * (A * (L * L) + a * Rabs fh) + (39 + 9 / 10) * (u * u) * (A * (L * L) + A * (r * r)) + (2 + / 25)
    * (A * (eta * L)) + (2 + / 20) * k
    + 9 / 10 * UNDERFLOW + 9 / 10 * (A * UNDERFLOW) <= de.
Proof.
  pose proof eta_pos as H0. pose proof u_pos. pose proof (len_pos n1 n2 n3) as L0. fold L in L0. pose proof (len_pos
    d1 d2 d3) as D0. fold D in D0.
  assert (R0 : 0 < r) by (pose proof (bp_pos (-150)); lra). assert (U0 : 0 < UNDERFLOW) by apply bp_pos.
  destruct slope as [S1 S2]. pose proof residual as RS. pose proof bound_of_residual as BR.
  assert (SS : Rabs h1 * Rabs d1 + Rabs h2 * Rabs d2 + Rabs h3 * Rabs d3 <= (1 + 2 * u) * (L * D)).
  { pose proof (abs_dot h1 h2 h3 d1 d2 d3) as K. fold D in K. destruct lengths as (_ & _ & P3 & _).
    assert (len h1 h2 h3 * D <= (1 + 2 * u) * L * D) by (apply Rmult_le_compat_r; assumption). lra. }
  set (P := L * D) in *. assert (P0 : 0 <= P) by (apply Rmult_le_pos; assumption). set (ed := eta * D) in *.
  assert (ed0 : 0 <= ed) by (apply Rmult_le_pos; assumption). assert (t0 : 0 < tau) by apply bp_pos.
  assert (Gam : Rabs (g - G) <= (4 + / 40) * u * P + ed + tau).
  { eapply Rle_trans; [exact S1|]. clear - SS P0 ed0 t0 H. rewrite u_val in *. lra. }
  clear S1 SS. set (ag := Rabs g) in *. assert (ag0 : 0 <= ag) by apply Rabs_pos.
  (* products *)
  assert (A0 : 0 < A) by (unfold A; pose proof (bp_pos (-100)); apply Rmult_lt_0_compat; lra).
  assert (A1 : A <= bp 202) by (unfold A; change 202%Z with (101 + 101)%Z; rewrite bp_add; apply Rmult_le_compat; lra).
  assert (PP : P * P = A * (L * L)) by (unfold P, A; ring). assert (PE : P * ed = A * (eta * L)) by (unfold P, ed, A;
    ring).
  assert (EE : ed * ed <= / 4 * (u * u) * (A * (r * r))).
  { replace (ed * ed) with (A * (eta * eta)) by (unfold ed, A; ring).
    replace (/ 4 * (u * u) * (A * (r * r))) with (A * ((/ 2 * u * r) * (/ 2 * u * r))) by field.
    apply Rmult_le_compat_l; [lra | apply Rmult_le_compat; lra]. }
  pose proof (twice_product_le (u * / 1000) P tau ltac:(lra)) as TP. pose proof (twice_product_le 1 ed tau ltac:(lra))
    as TE.
  assert (TT : tau * tau <= / 1000000000000 * u * / 1000 * UNDERFLOW).
  { unfold tau. rewrite <- bp_add. apply Rle_trans with (bp (-40) * bp (-53) * bp (-10) * bp (-900)); [rewrite <-
    !bp_add; apply bp_le; lia|].
    apply Rmult_le_compat_r; [apply Rlt_le, bp_pos|]. apply Rmult_le_compat; [apply Rmult_le_pos; apply Rlt_le, bp_pos
      | apply Rlt_le, bp_pos | | simpl; lra].
    apply Rmult_le_compat_r; [apply Rlt_le, bp_pos | simpl; lra]. }
  assert (TU : tau * tau / (u * / 1000) <= / 1000000000000 * UNDERFLOW).
  { apply Rmult_le_reg_r with (u * / 1000); [lra|]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra. lra. }
  assert (TTs : tau * tau <= / 1000000000000 * UNDERFLOW) by (rewrite u_val in TT; lra).
  replace (tau * tau / 1) with (tau * tau) in TE by field.
  (* g^2 *)
  assert (G2 : Rabs (g * g - G * G) <= (8 + / 10) * u * (P * P) + 2 * (ag * ed) + 9 * u * (P * ed) + 2 * (ed * ed) + /
    1000000 * UNDERFLOW).
  { replace (g * g - G * G) with ((g - G) * (2 * g - (g - G))) by ring. rewrite Rabs_mult.
    set (ga := (4 + / 40) * u * P + ed + tau) in *. assert (ga0 : 0 <= ga) by (pose proof (Rabs_pos (g - G)); lra).
    assert (Y : Rabs (2 * g - (g - G)) <= 2 * ag + ga).
    { apply Rabs_minus_le; [rewrite Rabs_mult, (Rabs_pos_eq 2) by lra; fold ag; lra | exact Gam]. }
    assert (Z : Rabs (g - G) * Rabs (2 * g - (g - G)) <= ga * (2 * ag + ga)) by (apply Rmult_le_compat; auto using
      Rabs_pos).
    eapply Rle_trans; [exact Z|].
    assert (Y1 : ag * P <= ((1 + 8 * u) * P + tau) * P) by (apply Rmult_le_compat_r; assumption).
    assert (Y2 : ag * tau <= ((1 + 8 * u) * P + tau) * tau) by (apply Rmult_le_compat_r; lra).
    replace (ga * (2 * ag + ga)) with (2 * (4 + / 40) * u * (ag * P) + 2 * (ag * ed) + 2 * (ag * tau) + (4 + / 40) *
      (4 + / 40) * (u * u) * (P * P)
      + ed * ed + tau * tau + 2 * (4 + / 40) * u * (P * ed) + 2 * (4 + / 40) * u * (P * tau) + 2 * (ed * tau)) by
        (unfold ga; ring).
    replace (((1 + 8 * u) * P + tau) * P) with ((1 + 8 * u) * (P * P) + P * tau) in Y1 by ring.
    replace (((1 + 8 * u) * P + tau) * tau) with ((1 + 8 * u) * (P * tau) + tau * tau) in Y2 by ring.
    assert (0 <= P * P) by apply sq_pos. assert (0 <= P * ed) by (apply Rmult_le_pos; assumption).
    assert (0 <= P * tau) by (apply Rmult_le_pos; lra). assert (0 <= tau * tau) by apply sq_pos.
    set (pp := P * P) in *. set (pe := P * ed) in *. set (ee := ed * ed) in *. set (pt := P * tau) in *. set (tt :=
      tau * tau) in *.
    set (et := ed * tau) in *. set (x := ag * P) in *. set (y := ag * tau) in *. set (z := ag * ed) in *.
    clear - Y1 Y2 TP TE TU TTs H1 H2 H3 H4 U0. rewrite u_val in *. lra. }
  assert (gg : g * g <= (1 + / 1000) * (P * P) + / 1000000 * UNDERFLOW).
  { rewrite <- abs_sq. fold ag. assert (ag * ag <= ((1 + 8 * u) * P + tau) * ((1 + 8 * u) * P + tau)) by (apply
    Rmult_le_compat; assumption).
    replace (((1 + 8 * u) * P + tau) * ((1 + 8 * u) * P + tau)) with ((1 + 8 * u) * (1 + 8 * u) * (P * P) + 2 * (1 + 8
      * u) * (P * tau) + tau * tau) in H1 by ring.
    assert (0 <= P * P) by apply sq_pos. rewrite u_val in *. lra. }
  (* a f *)
  pose proof Ha as Ha'. apply Rabs_le_inv in Ha'. assert (a0 : 0 < a) by (rewrite u_val in *; lra).
  pose proof (dd_low _ _ Ffl) as LF. set (af := Rabs fh) in *. assert (af0 : 0 <= af) by apply Rabs_pos.
  assert (FA : Rabs f <= (1 + u) * af) by (rewrite Ef; destruct (dd_value _ _ Ffl); assumption).
  assert (W1 : Rabs (a * fh - A * FF) <= 5 * u * (a * af) + A * ((39 + 2 / 10) * (u * u) * (L * L) + (27 + 4 / 10) *
    (u * u) * (r * r) + (2 + / 1000) * (eta * L)
    + / 1000 * UNDERFLOW)).
  { replace (a * fh - A * FF) with (- (a * fl) + ((a - A) * f + A * (f - FF))) by (rewrite Ef; ring).
    apply Rle_trans with (a * (u * af) + ((3 + / 100) * u * A * ((1 + u) * af) + A * ((39 + 2 / 10) * (u * u) * (L *
      L) + (27 + 4 / 10) * (u * u) * (r * r) + (2 + / 1000) * (eta * L)
      + / 1000 * UNDERFLOW))).
    - apply Rabs_plus_le; [rewrite Rabs_Ropp, Rabs_mult, (Rabs_pos_eq a) by lra; apply Rmult_le_compat_l; lra|].
      apply Rabs_plus_le; [apply Rabs_mult_le; assumption|]. rewrite Rabs_mult, (Rabs_pos_eq A) by lra. apply
        Rmult_le_compat_l; lra.
    - assert (A * af <= (1 + 4 * u) * a * af) by (apply Rmult_le_compat_r; [assumption | rewrite u_val in *; lra]).
      assert (0 <= a * af) by (apply Rmult_le_pos; lra).
      replace ((3 + / 100) * u * A * ((1 + u) * af)) with ((3 + / 100) * u * (1 + u) * (A * af)) by ring.
      replace (a * (u * af)) with (u * (a * af)) by ring.
      replace ((1 + 4 * u) * a * af) with ((1 + 4 * u) * (a * af)) in H1 by ring. set (q := A * _) in *. clear - H1 H2
        H. rewrite u_val in *. lra. }
  (* the roundings *)
  pose proof (RN_err (g * g)) as X1. pose proof (RN_err (a * fh)) as X2. pose proof (RN_diff (RN (g * g)) (RN (a *
    fh)) (RN_F _) (RN_F _)) as X3.
  rewrite <- Hdelta in X3. set (x := RN (g * g)) in *. set (y := RN (a * fh)) in *.
  rewrite (Rabs_pos_eq (g * g)) in X1 by apply sq_pos.
  assert (AF : Rabs (a * fh) = a * af) by (rewrite Rabs_mult, (Rabs_pos_eq a) by lra; reflexivity). rewrite AF in X2.
  assert (T1 : bp (-1075) <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; lia).
  assert (Y0 : 0 <= a * af) by (apply Rmult_le_pos; lra). pose proof (sq_pos g) as Y1. pose proof (bp_pos (-1075)) as
    T0'.
  assert (X4 : Rabs (x - y) <= (1 + u) * (g * g) + (1 + u) * (a * af) + 2 * bp (-1075)).
  { replace (x - y) with ((x - g * g) + g * g - ((y - a * fh) + a * fh)) by ring. eapply Rle_trans; [apply
    Rabs_minus_le; [apply Rabs_plus_le;
      [exact X1 | rewrite Rabs_pos_eq by assumption; apply Rle_refl] | apply Rabs_plus_le; [exact X2 | rewrite AF;
        apply Rle_refl]]|]. lra. }
  (* the bound *)
  assert (Z1 : (1 - 20 * u) * (A * (L * L)) - a * T <= a * square).
  { assert (a * ((1 - 8 * u) * (L * L) - T) <= a * square) by (apply Rmult_le_compat_l; lra).
    assert ((1 - 4 * u) * A * (L * L) <= a * (L * L)) by (apply Rmult_le_compat_r; [apply sq_pos | rewrite u_val in *;
      lra]).
    assert (0 <= A * (L * L)) by (apply Rmult_le_pos; [lra | apply sq_pos]).
    replace (a * ((1 - 8 * u) * (L * L) - T)) with ((1 - 8 * u) * (a * (L * L)) - a * T) in H1 by ring.
    replace ((1 - 4 * u) * A * (L * L)) with ((1 - 4 * u) * (A * (L * L))) in H2 by ring. rewrite u_val in *. lra. }
  assert (Z2 : u * (a * T) <= / 400 * UNDERFLOW).
  { assert (a <= bp 203).
    { assert (bp 203 = 2 * bp 202) by (change 203%Z with (1 + 202)%Z; rewrite bp_add, bp_1; ring). pose proof (bp_pos
      202). rewrite u_val in *. lra. }
    apply Rle_trans with (u * (bp 203 * T)); [apply Rmult_le_compat_l; [lra|]; apply Rmult_le_compat_r; [apply Rlt_le,
      bp_pos | assumption]|].
    unfold u, T. rewrite <- !bp_add. apply Rle_trans with (bp (-10) * UNDERFLOW); [unfold UNDERFLOW; rewrite <-
      bp_add; apply bp_le; lia|].
    apply Rmult_le_compat_r; [lra | simpl; lra]. }
  assert (Z3 : (1 - 4 * u) * (A * ((40 - / 1000) * (u * u) * (L * L + r * r) + (2 + / 20) * (eta * L) + 99 / 100 *
    UNDERFLOW)) <= a * fe).
  { set (q := (40 - / 1000) * (u * u) * (L * L + r * r) + (2 + / 20) * (eta * L) + 99 / 100 * UNDERFLOW) in *.
    assert (0 <= q) by (unfold q; pose proof (sq_pos L); pose proof (sq_pos r); assert (0 <= eta * L) by (apply
      Rmult_le_pos; assumption);
      repeat apply Rplus_le_le_0_compat; repeat apply Rmult_le_pos; rewrite ?u_val; lra).
    apply Rle_trans with (a * q); [|apply Rmult_le_compat_l; lra]. replace ((1 - 4 * u) * (A * q)) with ((1 - 4 * u) *
      A * q) by ring.
    apply Rmult_le_compat_r; [assumption | rewrite u_val in *; lra]. }
  assert (Z4 : (1 - 4 * u) * (ag * ed) <= ag * (eta * dn)).
  { replace ((1 - 4 * u) * (ag * ed)) with (ag * (eta * ((1 - 4 * u) * D))) by (unfold ed; ring). apply
    Rmult_le_compat_l; [assumption|].
    apply Rmult_le_compat_l; [assumption|]. pose proof (len_le_norm1 d1 d2 d3) as K. fold D in K.
    apply Rle_trans with ((1 - 4 * u) * norm1 d1 d2 d3); [apply Rmult_le_compat_l; [rewrite u_val; lra | exact K] |
      exact Hdn]. }
  exists (ag * ed). split; [apply Rmult_le_pos; assumption|]. split.
  { assert (Y2 : ag * ed <= ((1 + 8 * u) * P + tau) * ed) by (apply Rmult_le_compat_r; assumption).
    replace (((1 + 8 * u) * P + tau) * ed) with ((1 + 8 * u) * (P * ed) + ed * tau) in Y2 by ring.
    rewrite <- PE. assert (0 <= P * ed) by (apply Rmult_le_pos; assumption). pose proof (sq_pos tau). pose proof
      (sq_pos ed).
    assert (0 <= u * u * (A * (r * r))) by (apply Rmult_le_pos; [apply sq_pos | apply Rmult_le_pos; [lra | apply
      sq_pos]]).
    set (pe := P * ed) in *. set (ee := ed * ed) in *. set (et := ed * tau) in *. set (tt := tau * tau) in *. set (ar
      := A * (r * r)) in *.
    clear - Y2 TE EE TTs U0 H1 H2 H3 H4. rewrite u_val in *. lra. }
  set (al := A * (L * L)) in *. set (ar := A * (r * r)) in *. set (ae := A * (eta * L)) in *. set (au := A *
    UNDERFLOW) in *. rewrite PP in *. rewrite PE in *.
  assert (al0 : 0 <= al) by (apply Rmult_le_pos; [lra | apply sq_pos]). assert (ar0 : 0 <= ar) by (apply Rmult_le_pos;
    [lra | apply sq_pos]).
  assert (ae0 : 0 <= ae) by (apply Rmult_le_pos; [lra | apply Rmult_le_pos; assumption]). assert (au0 : 0 <= au) by
    (apply Rmult_le_pos; lra).
  assert (Z3' : (1 - 4 * u) * ((40 - / 1000) * (u * u) * (al + ar) + (2 + / 20) * ae + 99 / 100 * au) <= a * fe).
  { eapply Rle_trans; [|exact Z3]. apply Req_le. unfold al, ar, ae, au. ring. }
  assert (ge0 : 0 <= ag * ed) by (apply Rmult_le_pos; assumption).
  set (k1 := g * g) in *. set (k2 := a * af) in *. set (k3 := ag * ed) in *. set (k4 := a * square) in *. set (k5 := a
    * T) in *. set (k6 := a * fe) in *.
  set (k7 := ag * (eta * dn)) in *. set (k8 := ed * ed) in *. split.
  - replace (delta - (G * G - A * FF)) with ((delta - (x - y)) + (x - k1) - (y - a * fh) + (k1 - G * G) - (a * fh - A
    * FF)) by ring.
    eapply Rle_trans; [apply Rabs_minus_le; [apply Rabs_plus_le; [apply Rabs_minus_le; [apply Rabs_plus_le; [exact X3
      | exact X1] | exact X2] | exact G2] | exact W1]|].
    replace (A * ((39 + 2 / 10) * (u * u) * (L * L) + (27 + 4 / 10) * (u * u) * (r * r) + (2 + / 1000) * (eta * L) + /
      1000 * UNDERFLOW)) with
      ((39 + 2 / 10) * (u * u) * al + (27 + 4 / 10) * (u * u) * ar + (2 + / 1000) * ae + / 1000 * au) by (unfold al,
        ar, ae, au; ring).
    assert (XX : u * Rabs (x - y) <= u * ((1 + u) * k1 + (1 + u) * k2 + 2 * bp (-1075))) by (apply Rmult_le_compat_l;
      lra).
    set (k9 := Rabs (x - y)) in *. set (t9 := bp (-1075)) in *.
    clear - XX EE gg T1 Y0 Y1 T0' al0 ar0 ae0 au0 ge0 U0. rewrite u_val in *. lra.
  - unfold DELTA_ERROR in Hde. clear - Hde Hsz Z1 Z2 Z3' Z4 Y0 al0 ar0 ae0 au0 ge0 U0. rewrite u_val in *. lra.
Qed.
(* What f is, roughly, and the true discriminant. *)
Lemma sizes : A * (r * r) <= (1 + / 1000) * (A * (L * L) + a * Rabs fh) + / 100 * (A * UNDERFLOW) /\ G * G - A * FF <=
  A * (r * r) /\
  0 <= a * Rabs fh /\ 0 < a.
Proof.
  pose proof u_pos. assert (U0 : 0 < UNDERFLOW) by apply bp_pos. pose proof (bp_pos (-100)) as B0.
  assert (A0 : 0 < A) by (unfold A; apply Rmult_lt_0_compat; lra). pose proof Ha as Ha'. apply Rabs_le_inv in Ha'.
  assert (a0 : 0 < a) by (rewrite u_val in *; lra). assert (af0 : 0 <= a * Rabs fh) by (apply Rmult_le_pos; [lra |
    apply Rabs_pos]).
  split; [|split; [|split; assumption]].
  - assert (LL : n1 * n1 + n2 * n2 + n3 * n3 = L * L) by (unfold L; now rewrite len_sq).
    assert (V : forall h l, dd h l -> Rabs h <= bp 402 -> Rabs (h + l) <= bp 403).
    { intros h l Hd Hh. destruct (dd_value _ _ Hd) as [_ V]. assert (bp 403 = 2 * bp 402) by
        (change 403%Z with (1 + 402)%Z; rewrite bp_add, bp_1; ring). pose proof (Rabs_pos h). rewrite u_val in V. lra. }
    assert (B : bounded (tf n1 n2 n3)).
    { assert (R0 : 0 < r) by (pose proof (bp_pos (-150)); lra).
      unfold tf, tdot. cbn [bounded]. repeat split; try (apply V; assumption). rewrite Rabs_mult. change 600%Z with
        (300 + 300)%Z.
      rewrite bp_add. rewrite (Rabs_pos_eq r) by lra. apply Rmult_le_compat; lra. }
    pose proof (twice_error_at _ f 27 (low2 (tf n1 n2 n3)) Hf B eq_refl eq_refl ltac:(lia)) as Q.
    assert (SZ : size (tf n1 n2 n3) = L * L + r * r).
    { unfold tf, tdot. cbn [size]. rewrite !abs_sq, LL, (Rabs_pos_eq (r * r)) by apply sq_pos. reflexivity. }
    assert (EX : exact (tf n1 n2 n3) = L * L - r * r) by (unfold tf, tdot; cbn [exact]; rewrite LL; reflexivity).
    rewrite SZ, EX in Q.
    assert (LT : bp (low2 (tf n1 n2 n3)) <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; vm_compute; discriminate).
    pose proof (dd_value _ _ Ffl) as [_ V2]. rewrite <- Ef in V2. pose proof (Rle_abs (- f)) as V3. rewrite Rabs_Ropp
      in V3.
    pose proof (sq_pos L). pose proof (sq_pos r). pose proof (Rabs_pos fh).
    assert (R2 : r * r <= (1 + / 2000) * (L * L + Rabs fh) + / 1000 * UNDERFLOW).
    { apply Rabs_le_inv in Q. rewrite u_val in *. lra. }
    assert (R3 : A * (r * r) <= A * ((1 + / 2000) * (L * L + Rabs fh) + / 1000 * UNDERFLOW)) by (apply
      Rmult_le_compat_l; lra).
    assert (R4 : A * Rabs fh <= (1 + 4 * u) * a * Rabs fh) by (apply Rmult_le_compat_r; [assumption | rewrite u_val in
      *; lra]).
    assert (0 <= A * (L * L)) by (apply Rmult_le_pos; lra). assert (0 < A * UNDERFLOW) by (apply Rmult_lt_0_compat;
      assumption).
    replace (A * ((1 + / 2000) * (L * L + Rabs fh) + / 1000 * UNDERFLOW)) with ((1 + / 2000) * (A * (L * L) + A * Rabs
      fh) + / 1000 * (A * UNDERFLOW)) in R3 by ring.
    replace ((1 + 4 * u) * a * Rabs fh) with ((1 + 4 * u) * (a * Rabs fh)) in R4 by ring. rewrite u_val in *. lra.
  - pose proof (cauchy_schwarz N1 N2 N3 d1 d2 d3) as C.
    assert (AD : A = d1 * d1 + d2 * d2 + d3 * d3) by (unfold A, D; apply len_sq). unfold G, FF. rewrite AD.
    replace (N1 * d1 + N2 * d2 + N3 * d3) with (N1 * d1 + N2 * d2 + N3 * d3) by ring. lra.
Qed.
Theorem DELTA_ERROR_holds : Rabs (delta - (G * G - A * FF)) <= 7 / 10 * de.
Proof.
  destruct delta_parts as (k & K0 & K1 & K2 & K3). destruct sizes as (S & _ & k20 & _). assert (U0 : 0 < UNDERFLOW) by
    apply bp_pos.
  pose proof (bp_pos (-100)) as B. assert (A0 : 0 < A) by (unfold A; apply Rmult_lt_0_compat; lra). pose proof u_pos.
  assert (au0 : 0 < A * UNDERFLOW) by (apply Rmult_lt_0_compat; assumption).
  assert (E : A * (eta * L) <= / 4 * u * (A * (L * L) + A * (r * r))).
  { replace (/ 4 * u * (A * (L * L) + A * (r * r))) with (A * (/ 4 * u * (L * L + r * r))) by ring. apply
    Rmult_le_compat_l; [lra|].
    pose proof (len_pos n1 n2 n3) as L0. fold L in L0. apply Rle_trans with (/ 2 * u * r * L); [apply
      Rmult_le_compat_r; assumption|].
    pose proof (sq_pos (L - r)) as Y. assert (0 <= / 4 * u * ((L - r) * (L - r))) by (apply Rmult_le_pos; lra). lra. }
  assert (0 <= A * (L * L)) by (apply Rmult_le_pos; [lra | apply sq_pos]). assert (0 <= A * (r * r)) by (apply
    Rmult_le_pos; [lra | apply sq_pos]).
  eapply Rle_trans; [exact K2|]. set (al := A * (L * L)) in *. set (ar := A * (r * r)) in *. set (ae := A * (eta * L))
    in *. set (au := A * UNDERFLOW) in *.
  set (k2 := a * Rabs fh) in *. clear - K0 K1 K3 S U0 au0 E H0 H1 k20. rewrite u_val in *. lra.
Qed.
(* What HALF_BELOW and the roots ask for, where the test of the discriminant passes. *)
Theorem CERTAIN_holds : CERTAIN * de < delta -> Rabs (delta - (G * G - A * FF)) <= delta / 16 /\ 16 * (a * fe) <= (1 +
  32 * u) * delta /\
  (eta = 0 -> Rabs (g - G) <= / 1000 * sqrt delta).
Proof.
  unfold CERTAIN. intro H. pose proof DELTA_ERROR_holds as DE. pose proof eta_pos as H0. pose proof u_pos.
  pose proof (len_pos n1 n2 n3) as L0. fold L in L0. pose proof (len_pos d1 d2 d3) as D0. fold D in D0.
  assert (U0 : 0 < UNDERFLOW) by apply bp_pos. pose proof (Rabs_pos (delta - (G * G - A * FF))).
  assert (de0 : 0 <= de) by (rewrite u_val in *; lra).
  assert (A0 : 0 < A) by (unfold A; pose proof (bp_pos (-100)); apply Rmult_lt_0_compat; lra).
  pose proof Ha as Ha'. apply Rabs_le_inv in Ha'. assert (a0 : 0 < a) by (rewrite u_val in *; lra).
  assert (dn0 : 0 <= dn) by (pose proof (norm1_pos d1 d2 d3); rewrite u_val in *; lra).
  assert (ge0 : 0 <= Rabs g * (eta * dn)) by (apply Rmult_le_pos; [apply Rabs_pos | apply Rmult_le_pos; assumption]).
  pose proof bound_of_residual as BR. assert (0 <= eta * L) by (apply Rmult_le_pos; assumption). pose proof (sq_pos
    L). pose proof (sq_pos r).
  assert (fe0 : 0 <= fe) by (rewrite u_val in *; lra). assert (afe : 0 <= a * fe) by (apply Rmult_le_pos; lra).
  assert (af0 : 0 <= a * Rabs fh) by (apply Rmult_le_pos; [lra | apply Rabs_pos]).
  (* a lower bound of sz *)
  assert (Z1 : (1 - 20 * u) * (A * (L * L)) - a * T <= a * square).
  { assert (a * ((1 - 8 * u) * (L * L) - T) <= a * square) by (apply Rmult_le_compat_l; lra).
    assert ((1 - 4 * u) * A * (L * L) <= a * (L * L)) by (apply Rmult_le_compat_r; [apply sq_pos | rewrite u_val in *;
      lra]).
    assert (0 <= A * (L * L)) by (apply Rmult_le_pos; [lra | apply sq_pos]).
    replace (a * ((1 - 8 * u) * (L * L) - T)) with ((1 - 8 * u) * (a * (L * L)) - a * T) in H6 by ring.
    replace ((1 - 4 * u) * A * (L * L)) with ((1 - 4 * u) * (A * (L * L))) in H7 by ring. rewrite u_val in *. lra. }
  assert (Z2 : u * (a * T) <= / 400 * UNDERFLOW).
  { assert (A1 : A <= bp 202) by (unfold A; change 202%Z with (101 + 101)%Z; rewrite bp_add; apply Rmult_le_compat;
    lra).
    assert (a <= bp 203).
    { assert (bp 203 = 2 * bp 202) by (change 203%Z with (1 + 202)%Z; rewrite bp_add, bp_1; ring). pose proof (bp_pos
      202). rewrite u_val in *. lra. }
    apply Rle_trans with (u * (bp 203 * T)); [apply Rmult_le_compat_l; [lra|]; apply Rmult_le_compat_r; [apply Rlt_le,
      bp_pos | assumption]|].
    unfold u, T. rewrite <- !bp_add. apply Rle_trans with (bp (-10) * UNDERFLOW); [unfold UNDERFLOW; rewrite <-
      bp_add; apply bp_le; lia|].
    apply Rmult_le_compat_r; [lra | simpl; lra]. }
  assert (al0 : 0 <= A * (L * L)) by (apply Rmult_le_pos; [lra | assumption]).
  assert (DL : 15 * u * (A * (L * L)) + / 2 * UNDERFLOW + (1 - 20 * u) * (a * fe) <= de).
  { unfold DELTA_ERROR in Hde. set (k := a * fe) in *. set (k2 := a * square) in *. set (k3 := a * T) in *. set (k4 :=
    a * Rabs fh) in *.
    set (k5 := Rabs g * (eta * dn)) in *. set (al := A * (L * L)) in *. clear - Hde Hsz Z1 Z2 ge0 afe af0 al0 U0 H1.
      rewrite u_val in *. lra. }
  split; [rewrite u_val in *; lra|]. split; [rewrite u_val in *; lra|].
  intro EZ. destruct slope as [S1 _]. rewrite EZ, Rmult_0_l in S1.
  assert (SS : Rabs h1 * Rabs d1 + Rabs h2 * Rabs d2 + Rabs h3 * Rabs d3 <= (1 + 2 * u) * (L * D)).
  { pose proof (abs_dot h1 h2 h3 d1 d2 d3) as K. fold D in K. destruct lengths as (_ & _ & P3 & _).
    assert (len h1 h2 h3 * D <= (1 + 2 * u) * L * D) by (apply Rmult_le_compat_r; assumption). lra. }
  assert (P0 : 0 <= L * D) by (apply Rmult_le_pos; assumption). assert (t0 : 0 < tau) by apply bp_pos.
  assert (G1 : Rabs (g - G) <= (4 + / 40) * u * (L * D) + tau) by (rewrite u_val in *; lra).
  eapply Rle_trans; [exact G1|]. assert (D1 : 0 < delta) by lra.
  assert (Q1 : 10 * bp (-26) * (L * D) <= sqrt delta).
  { apply below_root; [apply sqrt_pos|]. rewrite sqrt_sqrt by lra.
    replace (10 * bp (-26) * (L * D) * (10 * bp (-26) * (L * D))) with (100 * (bp (-26) * bp (-26)) * (A * (L * L)))
      by (unfold A; ring).
    replace (bp (-26) * bp (-26)) with (2 * u) by (unfold u; rewrite <- bp_add, <- bp_1, <- bp_add; reflexivity).
      rewrite u_val in *. lra. }
  assert (Q2 : bp (-450) <= sqrt delta).
  { apply below_root; [apply sqrt_pos|]. rewrite sqrt_sqrt, bp_sq by lra. change (-450 + -450)%Z with (-900)%Z. fold
    UNDERFLOW.
    assert (0 <= u * (A * (L * L))) by (apply Rmult_le_pos; lra). rewrite u_val in *. lra. }
  assert (Q3 : tau <= / 1000000000000 * bp (-450)) by (apply bp_part12; lia).
  assert (B26 : bp (-26) = / 67108864) by (simpl; lra). rewrite B26 in Q1. set (q := sqrt delta) in *. rewrite u_val
    in *. lra.
Qed.

(* the root of the discriminant, and its sum with |g| *)
Variables q sqe sum se : R.
Hypotheses (Hcertain : CERTAIN * de < delta) (Hq : q = RN (sqrt delta)) (Hsqe : (1 - 8 * u) * (ROOT_ERROR * (de / q) +
  ROOT_ROUNDING * q) <= sqe)
  (Hsum : sum = RN (Rabs g + q)) (Hse : (1 - 8 * u) * (ge + sqe + u * sum) <= se) (Fg : F g).
Let Delta := G * G - A * FF.
Let Q := sqrt Delta.
Let s := if Rlt_dec g 0 then 1 else -1.
Let Y := - (s * G) + Q.
Let sigma := (4 + / 40) * u * (L * D) + eta * D + tau + 3541 / 10000 * (de / sqrt delta) + u * sqrt delta + u * sum.

Lemma slope_bound : (4 + 19 / 100) * u * (L * D) + (1 + 99 / 10000) * (eta * D) + 9 / 10 * UNDERFLOW <= ge.
Proof.
  eapply Rle_trans; [|exact Hge]. pose proof eta_pos as H0.
  pose proof (norm1_pos h1 h2 h3) as H1. pose proof (norm1_pos d1 d2 d3) as H2. pose proof (len_pos d1 d2 d3) as D0.
    fold D in D0.
  pose proof (len_le_norm1 d1 d2 d3) as D1. fold D in D1. pose proof (len_pos n1 n2 n3) as L0. fold L in L0. pose
    proof u_pos.
  assert (L1 : (1 - 3 * u) * L <= norm1 h1 h2 h3).
  { destruct lengths as (_ & _ & _ & P4). pose proof (len_sub n1 n2 n3 h1 h2 h3) as K. fold L in K.
    assert (len (n1 - h1) (n2 - h2) (n3 - h3) = len (h1 - n1) (h2 - n2) (h3 - n3)) by (unfold len; f_equal; ring).
    pose proof (len_le_norm1 h1 h2 h3). rewrite u_val in *. lra. }
  set (x := norm1 h1 h2 h3) in *. set (y := norm1 d1 d2 d3) in *.
  assert (X2 : (1 - 3 * u) * L * D <= x * y) by (apply Rmult_le_compat; try assumption; apply Rmult_le_pos; [rewrite
    u_val; lra | assumption]).
  assert (X3 : eta * D <= eta * y) by (apply Rmult_le_compat_l; assumption).
  assert (X4 : (1 - 4 * u) * x * ((1 - 4 * u) * y) <= hn * dn) by (apply Rmult_le_compat; try assumption; apply
    Rmult_le_pos; try assumption; rewrite u_val; lra).
  assert (X5 : eta * ((1 - 4 * u) * y) <= eta * dn) by (apply Rmult_le_compat_l; assumption).
  assert (U0 : 0 < UNDERFLOW) by apply bp_pos. assert (0 <= L * D) by (apply Rmult_le_pos; assumption).
  assert (0 <= eta * D) by (apply Rmult_le_pos; assumption). unfold SLOPE_ERROR.
  replace ((1 - 4 * u) * x * ((1 - 4 * u) * y)) with ((1 - 4 * u) * (1 - 4 * u) * (x * y)) in X4 by ring.
  replace (eta * ((1 - 4 * u) * y)) with ((1 - 4 * u) * (eta * y)) in X5 by ring.
  replace ((1 - 3 * u) * L * D) with ((1 - 3 * u) * (L * D)) in X2 by ring.
  set (p := x * y) in *. set (q1 := hn * dn) in *. set (e1 := eta * y) in *. set (e2 := eta * dn) in *. set (e3 := eta
    * D) in *. set (p0 := L * D) in *.
  clear - X2 X3 X4 X5 U0 H3 H4. rewrite u_val in *. lra.
Qed.

Lemma denominator : 0 < sum /\ bp (-451) <= sum /\ Rabs (sum - Y) <= sigma /\ sigma <= 2215 / 100000 * sum /\
  (1 + 227 / 10000) * sigma <= (1 + / 100) * se + 8 / 10 * u * sum /\ 0 <= Delta /\ 0 <= se.
Proof.
  pose proof eta_pos as H0. pose proof u_pos as up. assert (U0 : 0 < UNDERFLOW) by apply bp_pos. destruct sizes as (S1
    & S2 & S3 & a0).
  destruct delta_parts as (k & K0 & _ & _ & K3). pose proof DELTA_ERROR_holds as DE. destruct slope as [G1 _].
  pose proof slope_bound as GB. pose proof (len_pos n1 n2 n3) as L0. fold L in L0. pose proof (len_pos d1 d2 d3) as
    D0. fold D in D0.
  pose proof (bp_pos (-100)) as B0. pose proof (bp_pos (-150)) as B1'.
  assert (Dp : 0 < D) by lra. assert (A0 : 0 < A) by (unfold A; apply Rmult_lt_0_compat; assumption). assert (R0 : 0 <
    r) by lra.
  assert (au0 : 0 < A * UNDERFLOW) by (apply Rmult_lt_0_compat; assumption).
  assert (ae0 : 0 <= A * (eta * L)) by (apply Rmult_le_pos; [lra | apply Rmult_le_pos; assumption]).
  assert (al0 : 0 <= A * (L * L)) by (apply Rmult_le_pos; [lra | apply sq_pos]). assert (ar0 : 0 <= A * (r * r)) by
    (apply Rmult_le_pos; [lra | apply sq_pos]).
  unfold CERTAIN in Hcertain. fold Delta in S2, DE.
  (* de, delta and w, its root *)
  assert (D1 : (158 / 10) * u * (A * (r * r)) <= de /\ 15 * u * (A * (L * L)) <= de /\ / 2 * UNDERFLOW <= de).
  { set (al := A * (L * L)) in *. set (ar := A * (r * r)) in *. set (ae := A * (eta * L)) in *. set (au := A *
    UNDERFLOW) in *. set (k2 := a * Rabs fh) in *.
    clear - K0 K3 S1 S3 al0 ar0 ae0 au0 U0. rewrite u_val in *. repeat split; lra. }
  destruct D1 as (D1 & D2 & D3). assert (de0 : 0 < de) by lra.
  set (w := sqrt delta) in *. assert (ww : w * w = delta) by (apply sqrt_sqrt; lra). assert (w0 : 0 < w) by (apply
    sqrt_lt_R0; lra).
  apply Rabs_le_inv in DE.
  assert (W1 : w <= 1023 / 1000 * (D * r)).
  { apply below_root; [apply Rmult_le_pos; [lra | apply Rmult_le_pos; lra]|].
    replace (1023 / 1000 * (D * r) * (1023 / 1000 * (D * r))) with (1023 / 1000 * (1023 / 1000) * (A * (r * r))) by
      (unfold A; ring).
    rewrite ww. lra. }
  set (dq := de / w) in *. assert (dqw : dq * w = de) by (unfold dq; field; lra).
  assert (dq0 : 0 < dq) by (unfold dq; apply Rmult_lt_0_compat; [assumption | apply Rinv_0_lt_compat; assumption]).
  assert (dq1 : dq <= w / 16) by (apply Rmult_le_reg_r with w; [assumption|]; lra).
  assert (dq2 : 15 * u * (D * r) <= dq).
  { apply Rmult_le_reg_r with (1023 / 1000 * (D * r)); [apply Rmult_lt_0_compat; [lra | apply Rmult_lt_0_compat; lra]|].
    apply Rle_trans with (dq * w); [|apply Rmult_le_compat_l; lra]. rewrite dqw.
    replace (15 * u * (D * r) * (1023 / 1000 * (D * r))) with (15 * (1023 / 1000) * u * (A * (r * r))) by (unfold A;
      ring). rewrite u_val in *. lra. }
  assert (P1 : 10 * bp (-26) * (L * D) <= w).
  { apply below_root; [lra|]. rewrite ww.
    replace (10 * bp (-26) * (L * D) * (10 * bp (-26) * (L * D))) with (100 * (bp (-26) * bp (-26)) * (A * (L * L)))
      by (unfold A; ring).
    replace (bp (-26) * bp (-26)) with (2 * u) by (unfold u; rewrite <- bp_add, <- bp_1, <- bp_add; reflexivity).
      rewrite u_val in *. lra. }
  assert (R1 : 10 * bp (-26) * (D * r) <= w).
  { apply below_root; [lra|]. rewrite ww.
    replace (10 * bp (-26) * (D * r) * (10 * bp (-26) * (D * r))) with (100 * (bp (-26) * bp (-26)) * (A * (r * r)))
      by (unfold A; ring).
    replace (bp (-26) * bp (-26)) with (2 * u) by (unfold u; rewrite <- bp_add, <- bp_1, <- bp_add; reflexivity).
      rewrite u_val in *. lra. }
  assert (B26 : bp (-26) = / 67108864) by (simpl; lra). rewrite B26 in P1, R1.
  assert (W2 : bp (-450) <= w) by (apply below_root; [lra|]; rewrite ww, bp_sq; change (-450 + -450)%Z with (-900)%Z;
    fold UNDERFLOW; lra).
  assert (T1 : tau <= / 1000000000000 * bp (-450)) by (apply bp_part12; lia). assert (t0 : 0 < tau) by apply bp_pos.
  assert (T2 : tau <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; lia).
  assert (ed1 : eta * D <= / 2 * u * (D * r)).
  { replace (/ 2 * u * (D * r)) with (/ 2 * u * r * D) by ring. apply Rmult_le_compat_r; assumption. }
  assert (ed0 : 0 <= eta * D) by (apply Rmult_le_pos; assumption). assert (P0 : 0 <= L * D) by (apply Rmult_le_pos;
    assumption).
  assert (SS : Rabs h1 * Rabs d1 + Rabs h2 * Rabs d2 + Rabs h3 * Rabs d3 <= (1 + 2 * u) * (L * D)).
  { pose proof (abs_dot h1 h2 h3 d1 d2 d3) as K. fold D in K. destruct lengths as (_ & _ & P3 & _).
    assert (len h1 h2 h3 * D <= (1 + 2 * u) * L * D) by (apply Rmult_le_compat_r; assumption). lra. }
  assert (Gam : Rabs (g - G) <= (4 + / 40) * u * (L * D) + eta * D + tau).
  { eapply Rle_trans; [exact G1|]. set (x := Rabs h1 * Rabs d1 + Rabs h2 * Rabs d2 + Rabs h3 * Rabs d3) in *.
    clear - SS P0 ed0 t0 up. rewrite u_val in *. lra. }
  clear G1 SS.
  (* the exact root *)
  assert (DP : 0 <= Delta) by lra.
  assert (Q1 : 977 / 1000 * w <= Q).
  { apply below_root; [apply sqrt_pos|]. unfold Q. rewrite sqrt_sqrt by assumption.
    replace (977 / 1000 * w * (977 / 1000 * w)) with (977 / 1000 * (977 / 1000) * (w * w)) by ring. lra. }
  assert (Q2 : Rabs (w - Q) <= 3541 / 10000 * dq).
  { assert (QQ : Q * Q = Delta) by (apply sqrt_sqrt; assumption).
    assert (E : Rabs (w - Q) * (w + Q) <= 7 / 10 * dq * w).
    { rewrite <- (Rabs_pos_eq (w + Q)) by lra. rewrite <- Rabs_mult. replace ((w - Q) * (w + Q)) with (delta - Delta)
      by (rewrite <- ww, <- QQ; ring).
      apply Rabs_le. lra. }
    apply Rmult_le_reg_r with (1977 / 1000 * w); [lra|]. apply Rle_trans with (Rabs (w - Q) * (w + Q)).
    - apply Rmult_le_compat_l; [apply Rabs_pos | lra].
    - assert (0 <= dq * w) by (apply Rmult_le_pos; lra). lra. }
  assert (q1 : Rabs (q - w) <= u * w).
  { rewrite Hq. pose proof (RN_normal w) as N. rewrite (Rabs_pos_eq w) in N by lra. apply N. eapply Rle_trans; [|exact
    W2]. apply bp_le. lia. }
  pose proof (Rabs_pos g) as g0. assert (q0 : 0 < q) by (apply Rabs_le_inv in q1; rewrite u_val in *; lra).
  assert (sm1 : Rabs (sum - (Rabs g + q)) <= u * sum).
  { assert (Fq : F q) by (rewrite Hq; apply RN_F). assert (Fg' : F (Rabs g)) by now apply generic_format_abs.
    destruct (two_sum_error_le _ _ Fg' Fq) as [_ E]. pose proof (two_sum _ _ Fg' Fq) as TS. rewrite <- Hsum in E, TS.
    rewrite (Rabs_pos_eq sum) in E; [|rewrite Hsum, <- RN_0; apply RN_le; lra].
    replace (sum - (Rabs g + q)) with (- two_sum_error (Rabs g) q) by lra. now rewrite Rabs_Ropp. }
  assert (sum0 : 0 < sum) by (apply Rabs_le_inv in sm1; apply Rabs_le_inv in q1; rewrite u_val in *; lra).
  assert (sumw : (1 - 4 * u) * w <= sum) by (apply Rabs_le_inv in sm1; apply Rabs_le_inv in q1; rewrite u_val in *;
    lra).
  assert (SQ : (1 - 20 * u) * (6 / 10 * dq + 11 / 10 * u * w) <= sqe).
  { eapply Rle_trans; [|exact Hsqe]. unfold ROOT_ERROR, ROOT_ROUNDING.
    assert (K : (1 - 2 * u) * dq <= de / q).
    { apply Rmult_le_reg_r with q; [assumption|]. replace (de / q * q) with de by (field; lra). rewrite <- dqw.
      apply Rle_trans with ((1 - 2 * u) * dq * ((1 + u) * w)).
      - apply Rmult_le_compat_l; [apply Rmult_le_pos; [rewrite u_val; lra | lra] | apply Rabs_le_inv in q1; lra].
      - assert (0 <= dq * w) by (apply Rmult_le_pos; lra). rewrite u_val in *. lra. }
    apply Rabs_le_inv in q1. set (x := de / q) in *. clear - K q1 dq0 w0. rewrite u_val in *. lra. }
  assert (Main : Rabs (sum - Y) <= sigma).
  { assert (E : Rabs (Rabs g - - (s * G)) <= Rabs (g - G)).
    { unfold s. destruct (Rlt_dec g 0) as [N|N].
      - rewrite (Rabs_left g) by assumption. replace (- g - - (1 * G)) with (- (g - G)) by ring. rewrite Rabs_Ropp. lra.
      - rewrite (Rabs_pos_eq g) by lra. replace (g - - (-1 * G)) with (g - G) by ring. lra. }
    replace (sum - Y) with ((sum - (Rabs g + q)) + (Rabs g - - (s * G)) + ((q - w) + (w - Q))) by (unfold Y; ring).
    eapply Rle_trans; [apply Rabs_plus_le; [apply Rabs_plus_le; [exact sm1 | eapply Rle_trans; [exact E | exact Gam]] |
      apply Rabs_plus_le; [exact q1 | exact Q2]]|]. unfold sigma. fold w dq. lra. }
  split; [exact sum0|]. split.
  { assert (bp (-450) = 2 * bp (-451)) by (change (-450)%Z with (1 + -451)%Z; rewrite bp_add, bp_1; ring). rewrite
    u_val in *. lra. }
  split; [exact Main|]. unfold sigma. fold w dq. set (p := L * D) in *. set (ed := eta * D) in *. set (dr := D * r) in
    *.
  split; [|split; [|split; [exact DP|]]].
  - clear - P1 R1 ed1 T1 W2 dq1 sumw w0 t0. rewrite u_val in *. lra.
  - clear - Hse GB SQ ed1 dq2 T2 U0 sumw w0 P0 ed0 dq0 t0 sum0. rewrite u_val in *. lra.
  - clear - Hse GB SQ U0 w0 P0 ed0 dq0 sum0. rewrite u_val in *. lra.
Qed.

(* Both roots of the step: s times these. The bounds, through a few roundings. *)
Theorem LARGE_FACTOR_holds : forall e, (1 - 8 * u) * (LARGE_FACTOR * (se / a) + LARGE_ROUNDING * (sum / a)) <= e ->
  Rabs (s * RN (sum / a) - (- G + s * Q) / A) <= e.
Proof.
  intros e He. destruct denominator as (sum0 & sum1 & M & S1 & S2 & _ & se1). destruct sizes as (_ & _ & _ & a0). pose
    proof u_pos as up.
  pose proof (bp_pos (-100)) as B0. assert (A0 : 0 < A) by (unfold A; apply Rmult_lt_0_compat; lra).
  assert (A1 : A <= bp 202) by (unfold A; change 202%Z with (101 + 101)%Z; rewrite bp_add; apply Rmult_le_compat; lra).
  assert (a1 : a <= bp 203).
  { apply Rabs_le_inv in Ha. assert (bp 203 = 2 * bp 202) by (change 203%Z with (1 + 202)%Z; rewrite bp_add, bp_1;
    ring).
    pose proof (bp_pos 202). rewrite u_val in *. lra. }
  assert (E : Rabs (s * RN (sum / a) - (- G + s * Q) / A) = Rabs (RN (sum / a) - Y / A)).
  { unfold Y, s. destruct (Rlt_dec g 0).
    - f_equal. field. lra.
    - replace (-1 * RN (sum / a) - (- G + -1 * Q) / A) with (- (RN (sum / a) - (- (-1 * G) + Q) / A)) by (field; lra).
      apply Rabs_Ropp. }
  rewrite E. clear E. set (k := sum / a) in *. assert (k0 : 0 < k) by (unfold k; apply Rmult_lt_0_compat; [lra | apply
    Rinv_0_lt_compat; assumption]).
  assert (ka : k * a = sum) by (unfold k; field; lra). assert (sa : se / a * a = se) by (field; lra).
  pose proof (RN_err k) as R. rewrite (Rabs_pos_eq k) in R by lra.
  assert (T75 : bp (-1075) <= / 1000 * u * k).
  { apply Rmult_le_reg_r with a; [assumption|]. replace (/ 1000 * u * k * a) with (/ 1000 * u * sum) by (rewrite <-
    ka; ring).
    apply Rle_trans with (bp (-1075) * bp 203); [apply Rmult_le_compat_l; [apply Rlt_le, bp_pos | assumption]|].
    apply Rle_trans with (/ 1000 * u * bp (-451)); [|apply Rmult_le_compat_l; lra].
    apply Rle_trans with (bp (-10) * u * bp (-451)).
    - unfold u. rewrite <- !bp_add. apply bp_le. lia.
    - apply Rmult_le_compat_r; [apply Rlt_le, bp_pos|]. apply Rmult_le_compat_r; [lra | simpl; lra]. }
  assert (D1 : Rabs (k - Y / A) * a <= sigma + (3 + / 5) * u * sum).
  { rewrite <- (Rabs_pos_eq a) at 1 by lra. rewrite <- Rabs_mult.
    replace ((k - Y / A) * a) with ((sum - Y) - Y / A * (a - A)) by (rewrite <- ka; field; lra).
    apply Rabs_minus_le; [exact M|].
    assert (Y1 : Rabs (Y / A) * A <= 103 / 100 * sum).
    { rewrite <- (Rabs_pos_eq A) at 2 by lra. rewrite <- Rabs_mult. replace (Y / A * A) with (sum - (sum - Y)) by
      (field; lra).
      eapply Rle_trans; [apply Rabs_minus_le; [apply Rle_refl | exact M]|]. rewrite (Rabs_pos_eq sum) by lra. lra. }
    rewrite Rabs_mult. apply Rle_trans with (Rabs (Y / A) * ((3 + / 100) * u * A)); [apply Rmult_le_compat_l; [apply
      Rabs_pos | exact Ha]|].
    replace (Rabs (Y / A) * ((3 + / 100) * u * A)) with ((3 + / 100) * u * (Rabs (Y / A) * A)) by ring. rewrite u_val
      in *. lra. }
  apply Rmult_le_reg_r with a; [assumption|]. apply Rle_trans with ((1 - 8 * u) * (LARGE_FACTOR * se + LARGE_ROUNDING
    * sum)).
  - apply Rle_trans with (u * sum + / 1000 * u * sum + (sigma + (3 + / 5) * u * sum)).
    + apply Rle_trans with ((u * k + / 1000 * u * k) * a + Rabs (k - Y / A) * a); [|rewrite <- ka; rewrite <- ka in
      D1; lra].
      rewrite <- Rmult_plus_distr_r. apply Rmult_le_compat_r; [lra|].
      replace (RN k - Y / A) with ((RN k - k) + (k - Y / A)) by ring. eapply Rle_trans; [apply Rabs_triang|]. lra.
    + unfold LARGE_FACTOR, LARGE_ROUNDING. clear - S1 S2 sum0 M. pose proof (Rabs_pos (sum - Y)). rewrite u_val in *.
      lra.
  - apply Rle_trans with ((1 - 8 * u) * (LARGE_FACTOR * (se / a) + LARGE_ROUNDING * k) * a); [|apply
    Rmult_le_compat_r; lra].
    apply Req_le. rewrite <- ka. rewrite <- sa at 1. unfold LARGE_FACTOR, LARGE_ROUNDING. ring.
Qed.
Theorem LARGE_ROUNDING_holds : forall e, (1 - 8 * u) * (LARGE_FACTOR * (se / a) + LARGE_ROUNDING * (sum / a)) <= e ->
  Rabs (s * RN (sum / a) - (- G + s * Q) / A) <= e.
Proof. exact LARGE_FACTOR_holds. Qed.

Theorem SMALL_FACTOR_holds : forall e,
  (1 - 8 * u) * (SMALL_FACTOR * (fe / sum + Rabs fh / sum * (se / sum)) + SMALL_ROUNDING * (Rabs fh / sum)) <= e ->
    sum <= bp 510 ->
  Rabs (s * RN (fh / sum) - (- G - s * Q) / A) <= e.
Proof.
  intros e He St. destruct denominator as (sum0 & sum1 & M & S1 & S2 & DP & se1). destruct sizes as (_ & _ & _ & a0).
    pose proof u_pos as up.
  pose proof (bp_pos (-100)) as B0. assert (A0 : 0 < A) by (unfold A; apply Rmult_lt_0_compat; lra).
  assert (QQ : Q * Q = Delta) by (apply sqrt_sqrt; assumption). assert (U0 : 0 < UNDERFLOW) by apply bp_pos.
  pose proof residual as RS. pose proof bound_of_residual as BR. pose proof eta_pos as E0.
  pose proof (len_pos n1 n2 n3) as L0. fold L in L0. assert (eL : 0 <= eta * L) by (apply Rmult_le_pos; assumption).
  assert (Y1 : 97785 / 100000 * sum <= Y) by (apply Rabs_le_inv in M; lra).
  assert (E : Rabs (s * RN (fh / sum) - (- G - s * Q) / A) = Rabs (RN (fh / sum) - FF / Y)).
  { assert (X : (- G - s * Q) / A = s * (FF / Y)).
    { apply Rmult_eq_reg_r with A; [|lra]. apply Rmult_eq_reg_r with Y; [|lra].
      replace ((- G - s * Q) / A * A * Y) with ((- G - s * Q) * Y) by (field; lra).
      replace (s * (FF / Y) * A * Y) with (s * (A * FF)) by (field; lra).
      replace (A * FF) with (G * G - Q * Q) by (rewrite QQ; unfold Delta; ring). unfold Y, s. destruct (Rlt_dec g 0);
        ring. }
    rewrite X. replace (s * RN (fh / sum) - s * (FF / Y)) with (s * (RN (fh / sum) - FF / Y)) by ring. rewrite
      Rabs_mult.
    replace (Rabs s) with 1; [ring|]. unfold s. destruct (Rlt_dec g 0); unfold Rabs; destruct Rcase_abs; lra. }
  rewrite E. set (k := fh / sum). set (m := Rabs fh / sum) in *. set (af := Rabs fh) in *. assert (af0 : 0 <= af) by
    apply Rabs_pos.
  assert (km : Rabs k = m) by (unfold k, m, Rdiv; rewrite Rabs_mult, Rabs_inv, (Rabs_pos_eq sum) by lra; reflexivity).
  assert (ms : m * sum = af) by (unfold m; field; lra). assert (m0 : 0 <= m) by (rewrite <- km; apply Rabs_pos).
  pose proof (RN_err k) as R. rewrite km in R.
  pose proof (dd_low _ _ Ffl) as LF. fold af in LF.
  set (res := (39 + 2 / 10) * (u * u) * (L * L) + (27 + 4 / 10) * (u * u) * (r * r) + (2 + / 1000) * (eta * L) + /
    1000 * UNDERFLOW) in *.
  assert (D1 : Rabs (k - FF / Y) * sum <= 1022652 / 1000000 * (res + u * af + m * sigma)).
  { apply Rmult_le_reg_r with (97785 / 100000); [lra|].
    apply Rle_trans with (Rabs (k - FF / Y) * Y).
    - rewrite Rmult_assoc. apply Rmult_le_compat_l; [apply Rabs_pos | lra].
    - rewrite <- (Rabs_pos_eq Y) at 2 by lra. rewrite <- Rabs_mult.
      replace ((k - FF / Y) * Y) with ((f - FF) - fl - k * (sum - Y)) by (unfold k; rewrite Ef; field; split; lra).
      apply Rle_trans with (res + u * af + m * sigma).
      + apply Rabs_minus_le; [apply Rabs_minus_le; assumption|]. apply Rabs_mult_le; [lra | exact M].
      + assert (0 <= res) by (pose proof (Rabs_pos (f - FF)); lra). assert (0 <= u * af) by (apply Rmult_le_pos; lra).
        assert (0 <= m * sigma) by (apply Rmult_le_pos; [assumption | pose proof (Rabs_pos (sum - Y)); lra]). lra. }
  assert (T75 : bp (-1075) * sum <= / 1000 * (u * u) * (r * r)).
  { apply Rle_trans with (bp (-1075) * bp 510); [apply Rmult_le_compat_l; [apply Rlt_le, bp_pos | assumption]|].
    apply Rle_trans with (bp (-10) * bp (-106) * bp (-300)); [rewrite <- !bp_add; apply bp_le; lia|].
    apply Rmult_le_compat; [apply Rmult_le_pos; apply Rlt_le, bp_pos | apply Rlt_le, bp_pos | |].
    - apply Rmult_le_compat; try (apply Rlt_le, bp_pos); [simpl; lra|]. unfold u. rewrite <- bp_add. apply bp_le. lia.
    - change (-300)%Z with (-150 + -150)%Z. rewrite bp_add. pose proof (bp_pos (-150)). apply Rmult_le_compat; lra. }
  assert (S3 : m * ((1 + 227 / 10000) * sigma) <= m * ((1 + / 100) * se + 8 / 10 * u * sum)) by (apply
    Rmult_le_compat_l; assumption).
  replace (m * ((1 + / 100) * se + 8 / 10 * u * sum)) with ((1 + / 100) * (m * se) + 8 / 10 * u * af) in S3 by
    (rewrite <- ms; ring).
  replace (m * ((1 + 227 / 10000) * sigma)) with ((1 + 227 / 10000) * (m * sigma)) in S3 by ring.
  assert (se0 : 0 <= m * se) by (apply Rmult_le_pos; assumption).
  apply Rmult_le_reg_r with sum; [assumption|]. apply Rle_trans with ((1 - 8 * u) * (SMALL_FACTOR * (fe + m * se) +
    SMALL_ROUNDING * af)).
  - apply Rle_trans with (u * af + bp (-1075) * sum + Rabs (k - FF / Y) * sum).
    + rewrite <- ms. replace (u * (m * sum) + bp (-1075) * sum + Rabs (k - FF / Y) * sum) with ((u * m + bp (-1075) +
      Rabs (k - FF / Y)) * sum) by ring.
      apply Rmult_le_compat_r; [lra|]. replace (RN k - FF / Y) with ((RN k - k) + (k - FF / Y)) by ring. eapply
        Rle_trans; [apply Rabs_triang|]. lra.
    + unfold SMALL_FACTOR, SMALL_ROUNDING. assert (sg : 0 <= m * sigma) by (apply Rmult_le_pos; [assumption | pose
      proof (Rabs_pos (sum - Y)); lra]).
      pose proof (sq_pos L) as sqL. pose proof (sq_pos r) as sqr. unfold res in D1. set (x := m * sigma) in *. set (y
        := m * se) in *. set (z := Rabs (k - FF / Y) * sum) in *.
      set (t9 := bp (-1075) * sum) in *. set (el := eta * L) in *. clear - D1 S3 T75 BR U0 eL af0 se0 sg sqL sqr.
        rewrite u_val in *. lra.
  - apply Rle_trans with ((1 - 8 * u) * (SMALL_FACTOR * (fe / sum + m * (se / sum)) + SMALL_ROUNDING * m) * sum);
    [|apply Rmult_le_compat_r; lra].
    apply Req_le. rewrite <- ms. unfold SMALL_FACTOR, SMALL_ROUNDING. field. lra.
Qed.
Theorem SMALL_ROUNDING_holds : forall e,
  (1 - 8 * u) * (SMALL_FACTOR * (fe / sum + Rabs fh / sum * (se / sum)) + SMALL_ROUNDING * (Rabs fh / sum)) <= e ->
    sum <= bp 510 ->
  Rabs (s * RN (fh / sum) - (- G - s * Q) / A) <= e.
Proof. exact SMALL_FACTOR_holds. Qed.
Theorem ROOT_ERROR_holds : Rabs (sum - Y) <= sigma /\ sigma <= 2215 / 100000 * sum.
Proof. destruct denominator as (_ & _ & K1 & K2 & _). split; assumption. Qed.
Theorem ROOT_ROUNDING_holds : (1 + 227 / 10000) * sigma <= (1 + / 100) * se + 8 / 10 * u * sum.
Proof. apply denominator. Qed.
(* What the first step loses: so small is eta in the second. *)
Theorem eta_of_the_first_step : eta = 0 -> (1 + 8 * u) * (61 / 10 * (u * u) * norm1 h1 h2 h3) <= / 2 * u * r.
Proof.
  intro EZ. destruct sizes as (_ & S2 & _ & a0). destruct (CERTAIN_holds Hcertain) as (D1 & D2 & _). pose proof
    bound_of_residual as BR.
  fold Delta in D1, S2. pose proof (len_pos n1 n2 n3) as L0. fold L in L0. pose proof (bp_pos (-100)) as B0. pose
    proof (bp_pos (-150)) as B1'.
  assert (A0 : 0 < A) by (unfold A; apply Rmult_lt_0_compat; lra). assert (U0 : 0 < UNDERFLOW) by apply bp_pos. pose
    proof u_pos.
  rewrite EZ, Rmult_0_l in BR. pose proof (sq_pos r). pose proof (sq_pos L).
  assert (K : 39 * (u * u) * (A * (L * L)) <= a * fe).
  { apply Rle_trans with (a * ((39 + / 2) * (u * u) * (L * L))).
    - apply Rabs_le_inv in Ha. replace (39 * (u * u) * (A * (L * L))) with (39 * A * (u * u * (L * L))) by ring.
      replace (a * ((39 + / 2) * (u * u) * (L * L))) with ((39 + / 2) * a * (u * u * (L * L))) by ring.
      apply Rmult_le_compat_r; [apply Rmult_le_pos; [apply sq_pos | assumption] | rewrite u_val in *; lra].
    - apply Rmult_le_compat_l; [lra|]. rewrite u_val in *. lra. }
  apply Rabs_le_inv in D1. assert (K2 : delta <= 1067 / 1000 * (A * (r * r))) by lra.
  assert (K3 : 583 * (u * u) * (A * (L * L)) <= A * (r * r)).
  { assert (0 <= A * (r * r)) by (apply Rmult_le_pos; lra). rewrite u_val in *. lra. }
  assert (K4 : 583 * (u * u) * (L * L) <= r * r).
  { apply Rmult_le_reg_l with A; [assumption|]. lra. }
  assert (K5 : 24 * u * L <= r) by (apply below_root; [lra|]; rewrite u_val in *; lra).
  destruct lengths as (_ & _ & P3 & _). pose proof (norm1_le_len h1 h2 h3) as N1'.
  assert (K6 : (1 + 8 * u) * (61 / 10) * norm1 h1 h2 h3 <= 106 / 10 * L) by (rewrite u_val in *; lra).
  assert (u * u * ((1 + 8 * u) * (61 / 10) * norm1 h1 h2 h3) <= u * u * (106 / 10 * L)) by (apply Rmult_le_compat_l;
    [apply sq_pos | assumption]).
  assert (u * (24 * u * L) <= u * r) by (apply Rmult_le_compat_l; lra). lra.
Qed.
End Step.
(* A vector of differences up to FARTHEST and a way up to FARTHEST times the direction is in the range of the dot
  products. *)
Theorem FARTHEST_holds : forall o c t d n M, Rabs o <= FARTHEST -> Rabs c <= FARTHEST -> Rabs t <= FARTHEST -> Rabs d
  <= bp 100 ->
  M = o - c + t * d -> Rabs (n - M) <= 6 * (u * u) * Rabs M + bp (-1060) -> Rabs n <= bp 402.
Proof.
  intros o c t d n M Ho Hc Ht Hd E H. unfold FARTHEST in *.
  assert (B : Rabs M <= bp 401).
  { rewrite E. apply Rle_trans with (bp 300 + bp 300 + bp 300 * bp 100); [apply Rabs_plus_le; [apply Rabs_minus_le |
    apply Rabs_mult_le]; assumption|].
    rewrite <- bp_add. change (300 + 100)%Z with 400%Z. assert (bp 401 = 2 * bp 400) by (change 401%Z with (1 +
      400)%Z; rewrite bp_add, bp_1; ring).
    assert (bp 300 <= / 1000000000000 * bp 400) by (apply bp_part12; lia). pose proof (bp_pos 400). lra. }
  assert (bp 402 = 2 * bp 401) by (change 402%Z with (1 + 401)%Z; rewrite bp_add, bp_1; ring).
  assert (bp (-1060) <= / 1000000000000 * bp 401) by (apply bp_part12; lia). pose proof (bp_pos 401).
  replace n with ((n - M) + M) by ring. eapply Rle_trans; [apply Rabs_triang|]. rewrite u_val in *. lra.
Qed.
(* What underflows in a residual is below a part of 10^12 of UNDERFLOW. *)
Theorem UNDERFLOW_holds : forall x y z, bp (low2 (tf 0 x y z)) <= / 1000000000000 * UNDERFLOW.
Proof. intros. apply bp_part12. vm_compute. discriminate. Qed.
