(* rt-geom, enclosing/certify.rs, `pair`: the minimal sphere of two spheres in closed form. *)
From Proofs Require Import Rounding ErrorFree Norm Spacing Reach Step Frame.
From Flocq Require Import Mult_error.
Open Scope R_scope.

(* With a larger error of the radius, as a share of it, the reaches are computed anew. *)
Definition PAIR_ERROR := bp (-64).
(* With the center closer than this to that of a sphere, as a share of the radius, there is no closed form. *)
Definition NEARLY_INSIDE := bp (-20).
(* The errors of what rounding the center does to the reaches. *)
Definition AWAY_ERROR := 16 * u.

(* ---- Two spheres exactly: a and b, radii r and s, the vector v from one center to the other ---- *)
(* No sphere that encloses both is smaller. *)
Theorem pair_minimal : forall a1 a2 a3 b1 b2 b3 r s c1 c2 c3 m, norm (c1 - a1) (c2 - a2) (c3 - a3) + r <= m ->
  norm (c1 - b1) (c2 - b2) (c3 - b3) + s <= m -> (norm (b1 - a1) (b2 - a2) (b3 - a3) + r + s) / 2 <= m.
Proof.
  intros a1 a2 a3 b1 b2 b3 r s c1 c2 c3 m H1 H2.
  pose proof (norm_triangle (c1 - a1) (c2 - a2) (c3 - a3) (- (c1 - b1)) (- (c2 - b2)) (- (c3 - b3))) as T.
  rewrite norm_opp in T. replace (c1 - a1 + - (c1 - b1)) with (b1 - a1) in T by ring.
  replace (c2 - a2 + - (c2 - b2)) with (b2 - a2) in T by ring. replace (c3 - a3 + - (c3 - b3)) with (b3 - a3) in T by
  ring. lra.
Qed.
(* The center is at the share k of the way; e moves it. The larger reach is the radius and the part of e along the way,
   and what the distance bends. *)
Theorem pair_reaches : forall v1 v2 v3 e1 e2 e3 r s, let L := norm v1 v2 v3 in let E := norm e1 e2 e3 in
  let m := (L + r + s) / 2 in let k := (L + s - r) / (2 * L) in let along := Rabs (v1 * e1 + v2 * e2 + v3 * e3) / L in
  let n := Rmin (k * L) ((1 - k) * L) in 0 < n -> 0 < L ->
  let reach := Rmax (norm (k * v1 + e1) (k * v2 + e2) (k * v3 + e3) + r)
    (norm (k * v1 + e1 - v1) (k * v2 + e2 - v2) (k * v3 + e3 - v3) + s) in
  m + along <= reach <= m + along + E * E / (2 * n).
Proof.
  intros v1 v2 v3 e1 e2 e3 r s L E m k along n N0 L0 reach. set (d := v1 * e1 + v2 * e2 + v3 * e3) in *.
  assert (KL : k * L = (L + s - r) / 2) by (unfold k; field; lra).
  pose proof (Rmin_l (k * L) ((1 - k) * L)) as M1. pose proof (Rmin_r (k * L) ((1 - k) * L)) as M2. fold n in M1, M2.
  assert (K0 : 0 < k) by nra. assert (K1 : 0 < 1 - k) by nra. pose proof (sq_pos E) as EE.
  assert (B : forall x, n <= x -> E * E / (2 * x) <= E * E / (2 * n)).
  { intros x X. unfold Rdiv. apply Rmult_le_compat_l; [assumption|]. apply Rinv_le_contravar; lra. }
  (* from the first center *)
  pose proof (bend (k * v1) (k * v2) (k * v3) e1 e2 e3) as A. cbv zeta in A.
  rewrite norm_scaled, (Rabs_pos_eq k) in A by
    lra. fold L E in A. replace (k * v1 * e1 + k * v2 * e2 + k * v3 * e3) with (k * d) in A by (unfold d; ring).
  replace (k * d / (k * L)) with (d / L) in A by (field; split; lra). specialize (A ltac:(lra)).
  (* and from the second *)
  pose proof (bend (- (1 - k) * v1) (- (1 - k) * v2) (- (1 - k) * v3) e1 e2 e3) as C. cbv zeta in C.
  rewrite norm_scaled, Rabs_Ropp, (Rabs_pos_eq (1 - k)) in C by lra. fold L E in C.
  replace (- (1 - k) * v1 * e1 + - (1 - k) * v2 * e2 + - (1 - k) * v3 * e3) with (- (1 - k) * d) in C by (unfold d;
    ring).
  replace (- (1 - k) * d / ((1 - k) * L)) with (- (d / L)) in C by (field; split; lra). specialize (C ltac:(lra)).
  replace (- (1 - k) * v1 + e1) with (k * v1 + e1 - v1) in C by ring.
  replace (- (1 - k) * v2 + e2) with (k * v2 + e2 - v2) in C by ring.
  replace (- (1 - k) * v3 + e3) with (k * v3 + e3 - v3) in C by ring.
  pose proof (B _ M1) as B1. pose proof (B _ M2) as B2.
  assert (AL : along = Rabs (d / L)) by (unfold along, Rdiv; rewrite Rabs_mult, Rabs_inv, (Rabs_pos_eq L) by lra; ring).
  rewrite AL. pose proof (Rle_abs (d / L)). pose proof (Rle_abs (- (d / L))) as N. rewrite Rabs_Ropp in N.
  set (g := d / L) in *. set (p := norm (k * v1 + e1) (k * v2 + e2) (k * v3 + e3)) in *.
  set (p' := norm (k * v1 + e1 - v1) (k * v2 + e2 - v2) (k * v3 + e3 - v3)) in *.
  unfold reach. split.
  - unfold Rabs. destruct Rcase_abs; [apply Rle_trans with (2 := Rmax_r _ _) | apply Rle_trans with (2 := Rmax_l _ _)];
      unfold m; lra.
  - apply Rmax_lub; unfold m; lra.
Qed.

(* ---- Rounded sums of two doubles, upward and downward ---- *)
Definition summed_up high low := let sum := RN (high + low) in
  if Rlt_dec 0 (fast_two_sum_error high low) then succ radix2 fexp sum else sum.
Definition summed_down high low := let sum := RN (high + low) in
  if Rlt_dec (fast_two_sum_error high low) 0 then pred radix2 fexp sum else sum.
Lemma summed : forall high low, F high -> F low -> Rabs low <= Rabs high ->
  summed_down high low <= high + low <= summed_up high low /\
  forall R, F R -> high + low <= R -> summed_up high low <= R.
Proof.
  intros high low Fh Fl H. pose proof (fast_two_sum high low Fh Fl H) as E. unfold summed_up, summed_down.
  set (sum := RN (high + low)) in *. assert (Fs : F sum) by apply RN_F. set (e := fast_two_sum_error high low) in *.
  split; [split|].
  - destruct Rlt_dec; [apply pred_round_le_id; typeclasses eauto | lra].
  - destruct Rlt_dec; [apply succ_round_ge_id; typeclasses eauto | lra].
  - intros R FR HR. destruct Rlt_dec.
    + apply succ_le_lt; [typeclasses eauto | exact Fs | exact FR | lra].
    + rewrite <- (RN_id R FR). apply RN_le. exact HR.
Qed.

(* ---- The radius ---- *)
Section Radius.
(* the distance exactly, and as computed (Reach.v): its double and the rest; the radii *)
Variables L q rest r s : R.
Hypotheses (Fq : F q) (Fr : F r) (Fs : F s) (Frest : F rest) (Hr : 0 <= r) (Hs : 0 <= s) (L0 : bp (-200) <= L)
  (HL : Rabs (q + rest - L) <= 34 * (u * u) * L) (Hrest : Rabs rest <= 4 * u * L) (Hq : Rabs (q - L) <= 4 * u * L).
Let radii := RN (r + s). Let radii_low := two_sum_error r s.
Let twice := RN (q + radii). Let twice_low := two_sum_error q radii.
Let radius := twice * / 2. Let low := RN (RN (twice_low + RN (radii_low + rest)) * / 2).
Let m := (L + r + s) / 2.
Let z := u * (u * m).
Lemma m_pos : bp (-202) <= m /\ L <= 2 * m /\ 0 < L.
Proof.
  pose proof (bp_pos (-200)). assert (bp (-200) = 4 * bp (-202)) by (change (-200)%Z with (2 + -202)%Z; rewrite bp_add;
    simpl (bp 2); lra). pose proof (bp_pos (-202)). unfold m. lra.
Qed.
Lemma tiny : bp (-1075) <= / 1000000 * z.
Proof.
  destruct m_pos as (M & _). apply Rle_trans with (bp (-20 + (-53 + (-53 + -202)))); [apply bp_le; lia|].
  rewrite !bp_add. fold u. pose proof u_pos. pose proof (bp_pos (-202)). apply Rmult_le_compat; try lra;
    [apply Rlt_le, bp_pos | apply Rmult_le_pos; [lra|]; apply Rmult_le_pos; lra | simpl; lra|].
  unfold z. apply Rmult_le_compat_l; [lra|]. apply Rmult_le_compat_l; lra.
Qed.
Lemma F_radius : F radius /\ (1 - 6 * u) * m <= radius <= (1 + 6 * u) * m.
Proof.
  destruct m_pos as (M & LM & LP). pose proof u_pos as U. pose proof (bp_pos (-202)) as B.
  pose proof (RN_sum r s Fr Fs) as E1. fold radii in E1. rewrite (Rabs_pos_eq (r + s)) in E1 by lra.
  pose proof (RN_sum q radii Fq (RN_F _)) as E2. fold twice in E2. apply Rabs_le_inv in E1.
  apply Rabs_le_inv in Hq as Hq'. assert (Q : 0 <= q + radii) by (rewrite u_val in *; lra).
  rewrite (Rabs_pos_eq (q + radii)) in E2 by assumption. apply Rabs_le_inv in E2.
  assert (R : (1 - 6 * u) * m <= radius <= (1 + 6 * u) * m) by (unfold radius, m in *; rewrite u_val in *; split; lra).
  split; [|assumption]. unfold radius. replace (/ 2) with (bp (-1)) by (simpl; lra).
  apply mult_bpow_exact_FLT; [apply RN_F|].
  assert (T : bp (-204) <= Rabs twice).
  { assert (bp (-202) = 4 * bp (-204)) by (change (-202)%Z with (2 + -204)%Z; rewrite bp_add; simpl (bp 2); lra).
    pose proof (bp_pos (-204)). unfold radius in R. rewrite Rabs_pos_eq; rewrite u_val in *; lra. }
  assert (G : (-204 < mag radix2 twice)%Z) by now apply mag_gt_bpow. lia.
Qed.
(* The radius is off by 20 u^2 of the distance and 3 u^2 of itself. *)
Lemma radius_near : Rabs (radius + low - m) <= (201 / 10) * (u * (u * L)) + (31 / 10) * z /\ Rabs low <= (201 / 100) *
  (u * m) + (151 / 100) * (u * L) /\ F low.
Proof.
  destruct m_pos as (M & LM & LP). pose proof u_pos as U. pose proof (bp_pos (-202)) as B. pose proof tiny as T.
  destruct F_radius as [_ FR]. pose proof (two_sum r s Fr Fs) as S1. fold radii radii_low in S1.
  pose proof (two_sum q radii Fq (RN_F _)) as S2. fold twice twice_low in S2.
  destruct (two_sum_error_le r s Fr Fs) as [L1 _]. fold radii_low in L1. rewrite (Rabs_pos_eq (r + s)) in L1 by lra.
  destruct (two_sum_error_le q radii Fq (RN_F _)) as [_ L2]. fold twice_low twice in L2.
  assert (TW : twice = 2 * radius) by (unfold radius; field). rewrite TW in L2.
  assert (RS : r + s = 2 * m - L) by (unfold m; field). rewrite RS in L1.
  rewrite (Rabs_pos_eq (2 * radius)) in L2 by (rewrite u_val in *; lra).
  set (ul := u * L). set (um := u * m). assert (ul0 : 0 < ul) by (apply Rmult_lt_0_compat; lra).
  assert (um0 : 0 < um) by (apply Rmult_lt_0_compat; lra). assert (ulm : ul <= 2 * um) by (unfold ul, um; nra).
  assert (UL : u * ul <= / 1000000000000 * ul) by (apply Rmult_le_compat_r; [lra | rewrite u_val; lra]).
  assert (UM : u * um <= / 1000000000000 * um) by (apply Rmult_le_compat_r; [lra | rewrite u_val; lra]).
  assert (UL0 : 0 < u * ul) by (apply Rmult_lt_0_compat; lra).
  assert (UM0 : 0 < u * um) by (apply Rmult_lt_0_compat; lra).
  assert (A1 : Rabs radii_low <= 2 * um - ul) by (unfold um, ul; lra).
  assert (A2 : Rabs twice_low <= (2 + / 1000) * um).
  { eapply Rle_trans; [exact L2|]. assert (u * (2 * radius) <= u * (2 * ((1 + 6 * u) * m))) by (apply
      Rmult_le_compat_l; lra). unfold um in *. rewrite u_val in *. lra. }
  assert (A3 : Rabs rest <= 4 * ul) by (unfold ul; lra).
  assert (B1 : Rabs (radii_low + rest) <= 2 * um + 3 * ul) by (eapply Rle_trans; [apply Rabs_triang|]; lra).
  pose proof (rounding _ _ B1) as E1. set (m1 := RN (radii_low + rest)) in *.
  replace (u * (2 * um + 3 * ul)) with (2 * (u * um) + 3 * (u * ul)) in E1 by ring.
  change (u * um) with z in *. pose proof (near_le _ _ _ E1) as N1.
  assert (B2 : Rabs (twice_low + m1) <= (4 + / 500) * um + (3 + / 1000) * ul) by (eapply Rle_trans;
    [apply Rabs_triang|]; lra).
  pose proof (rounding _ _ B2) as E2. set (m2 := RN (twice_low + m1)) in *.
  replace (u * ((4 + / 500) * um + (3 + / 1000) * ul)) with ((4 + / 500) * z + (3 + / 1000) * (u * ul)) in E2 by (unfold
    z, um; ring). pose proof (near_le _ _ _ E2) as N2.
  assert (B3 : Rabs (m2 * / 2) <= (2 + / 500) * um + (15 / 10 + / 500) * ul) by
    (rewrite Rabs_mult, (Rabs_pos_eq (/ 2)) by
    lra; lra).
  (* halving is exact but for underflow *)
  assert (E3 : Rabs (RN (m2 * / 2) - m2 * / 2) <= bp (-1075)).
  { replace (/ 2) with (bp (-1)) by (simpl; lra). apply Frame.scaled. apply RN_F. }
  fold low in E3. pose proof (near_le _ _ _ E3) as N3.
  assert (Fl : F low) by (unfold low; apply RN_F).
  split; [|split; [|exact Fl]].
  - replace (radius + low - m) with ((low - m2 * / 2) + (m2 - (twice_low + m1)) * / 2 + (m1 - (radii_low + rest)) * / 2
    +
      (q + rest - L) * / 2) by (unfold m; lra).
    eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
    eapply Rle_trans; [apply Rplus_le_compat_r, Rplus_le_compat_r, Rabs_triang|].
    rewrite !(Rabs_mult _ (/ 2)), (Rabs_pos_eq (/ 2)) by lra.
    replace (34 * (u * u) * L) with (34 * (u * ul)) in HL by (unfold ul; ring). lra.
  - assert (z <= / 1000000000000 * um) by exact UM. fold um ul.
    lra.
Qed.
(* The lower bound. *)
Theorem pair_bound : summed_down radius (RN (low - RN (radius * REACH_ERROR))) <= m.
Proof.
  destruct m_pos as (M & LM & LP). pose proof u_pos as U. pose proof (bp_pos (-202)) as B. pose proof tiny as T.
  destruct F_radius as [F1 FR]. destruct radius_near as (RN1 & LN & Fl).
  assert (m0 : 0 < m) by lra. set (ul := u * L) in *. set (um := u * m) in *.
  assert (um0 : 0 < um) by (apply Rmult_lt_0_compat; lra). assert (ulm : ul <= 2 * um) by (unfold ul, um; nra).
  assert (zu : u * um = z) by reflexivity. assert (z0 : 0 < z) by (rewrite <- zu; apply Rmult_lt_0_compat; lra).
  assert (UM : z <= / 1000000000000 * um) by (rewrite <- zu; apply Rmult_le_compat_r; [lra | rewrite u_val; lra]).
  assert (UZ : u * ul <= 2 * z) by (rewrite <- zu; replace (2 * (u * um)) with (u * (2 * um)) by ring;
    apply Rmult_le_compat_l; lra).
  pose proof (RN_err (radius * REACH_ERROR)) as E1. set (g := RN (radius * REACH_ERROR)) in *. unfold REACH_ERROR in E1.
  assert (G : (128 - / 1000) * z <= radius * (128 * u * u) <= (128 + / 1000) * z).
  { replace (radius * (128 * u * u)) with (128 * (u * (u * radius))) by ring.
    assert (u * (u * ((1 - 6 * u) * m)) <= u * (u * radius) <= u * (u * ((1 + 6 * u) * m))) by (split; apply
      Rmult_le_compat_l; try lra; apply Rmult_le_compat_l; lra).
    replace (u * (u * ((1 - 6 * u) * m))) with ((1 - 6 * u) * z) in * by (unfold z, um; ring).
    replace (u * (u * ((1 + 6 * u) * m))) with ((1 + 6 * u) * z) in * by (unfold z, um; ring). rewrite u_val in *.
    lra. }
  rewrite (Rabs_pos_eq (radius * _)) in E1 by lra. apply Rabs_le_inv in E1.
  assert (G2 : (128 - / 100) * z <= g <= (128 + / 100) * z) by (rewrite u_val in *; lra).
  assert (B1 : Rabs (low - g) <= 6 * um).
  { unfold Rminus. eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp, (Rabs_pos_eq g) by lra. lra. }
  pose proof (rounding _ _ B1) as E2. replace (u * (6 * um)) with (6 * z) in E2 by (rewrite <- zu; ring).
  set (down := RN (low - g)) in *. pose proof (near_le _ _ _ E2) as N2.
  assert (D : Rabs down <= Rabs radius) by (rewrite (Rabs_pos_eq radius) by (rewrite u_val in *; lra);
    unfold um in *; rewrite u_val in *; lra).
  destruct (summed radius down F1 (RN_F _) D) as [[S _] _]. apply Rle_trans with (1 := S).
  apply Rabs_le_inv in E2. apply Rabs_le_inv in RN1. lra.
Qed.

(* ---- The bracket around the center as it is rounded ----
   It is off the exact one by e + g: e as computed, g what that is off, of which the part along the way matters. *)
Section Bracket.
Variables v1 v2 v3 e1 e2 e3 g1 g2 g3 : R.
Hypotheses (HLv : L = norm v1 v2 v3) (Lt : L <= bp 200).
Let E := norm e1 e2 e3. Let G := norm g1 g2 g3.
Let k := (L + s - r) / (2 * L).
Let n := Rmin (k * L) ((1 - k) * L).
(* As computed: the scalar product of e and the way, the inverse of the distance, the lesser distance. *)
Variables p1 p2 p3 dot inverse nearest size : R.
Hypotheses (Hp1 : Rabs (p1 - v1) <= u * Rabs v1) (Hp2 : Rabs (p2 - v2) <= u * Rabs v2) (Hp3 : Rabs (p3 - v3) <= u * Rabs
  v3) (B1 : Rabs e1 <= bp 300) (B2 : Rabs e2 <= bp 300) (B3 : Rabs e3 <= bp 300) (B4 : Rabs p1 <= bp 300)
  (B5 : Rabs p2 <= bp 300) (B6 : Rabs p3 <= bp 300) (Fe1 : F e1) (Fe2 : F e2) (Fe3 : F e3).
Hypothesis Hdot : plain (tdot (X e1 300) (X e2 300) (X e3 300) (X p1 300) (X p2 300) (X p3 300)) dot.
Hypotheses (Hinverse : Rabs (inverse * L - 1) <= 6 * u) (Hnearest : Rabs (nearest - n) <= / 1000 * n)
  (Hinside : NEARLY_INSIDE * radius <= nearest) (Hsize : 0 <= size).
Let along := RN (Rabs dot * inverse).
Let away := RN (RN (Rabs e1 + Rabs e2) + Rabs e3).
Let bend := RN (RN (away * away) / nearest).
Let error := RN (RN (RN (radius * REACH_ERROR) + bend) + RN (AWAY_ERROR * RN (away + RN (u * size)))).
(* what the center as computed is off *)
Hypotheses (HG : Rabs (v1 * g1 + v2 * g2 + v3 * g3) / L <= 36 * (u * (u * L)) + 59 * (u * (u * Rabs (s - r))) + 15 * (u
  *
  (u * size))) (HG2 : G <= 1000 * z + 5 * (u * (u * size))).
Hypothesis Hpair : error <= radius * PAIR_ERROR.

Lemma rho : 2 * m - L = r + s /\ Rabs (s - r) <= r + s /\ 0 < u * (u * L) /\ 0 <= u * (u * Rabs (s - r)) /\
  u * (u * L) + u * (u * Rabs (s - r)) <= 2 * z /\ 0 < z /\ 0 < m /\ z <= / 1000000000000 * (u * m).
Proof.
  destruct m_pos as (M & LM & LP). pose proof (bp_pos (-202)) as B. pose proof u_pos as U.
  assert (A : Rabs (s - r) <= r + s) by (apply Rabs_le; lra).
  assert (UL : 0 < u * L) by (apply Rmult_lt_0_compat; lra). assert (UM : 0 < u * m) by (apply Rmult_lt_0_compat; lra).
  split; [unfold m; field|]. split; [assumption|]. split; [apply Rmult_lt_0_compat; lra|].
  split; [apply Rmult_le_pos; [lra|]; apply Rmult_le_pos; [lra | apply Rabs_pos]|]. split; [|split; [apply
    Rmult_lt_0_compat; lra | split; [lra|]]].
  - unfold z. replace (2 * (u * (u * m))) with (u * (u * (2 * m))) by ring. rewrite <- !Rmult_plus_distr_l.
    apply Rmult_le_compat_l; [lra|]. apply Rmult_le_compat_l; [lra|]. unfold m. lra.
  - unfold z. apply Rmult_le_compat_r; [lra | rewrite u_val; lra].
Qed.
Lemma very_tiny : forall j, (j <= -600)%Z -> bp j <= / 1000000 * z.
Proof.
  intros j H. destruct m_pos as (M & _). apply Rle_trans with (bp (-20 + (-53 + (-53 + -202)))); [apply bp_le; lia|].
  rewrite !bp_add. fold u. pose proof u_pos. pose proof (bp_pos (-202)). apply Rmult_le_compat; try lra;
    [apply Rlt_le, bp_pos | apply Rmult_le_pos; [lra|]; apply Rmult_le_pos; lra | simpl; lra|].
  unfold z. apply Rmult_le_compat_l; [lra|]. apply Rmult_le_compat_l; lra.
Qed.
(* How far e is along the way. *)
Lemma along_e : Rabs (along - Rabs (v1 * e1 + v2 * e2 + v3 * e3) / L) <= (112 / 10) * (u * E) + / 1000 * z /\
  0 <= along <= (1 + / 1000) * E + / 1000 * z.
Proof.
  destruct m_pos as (M & LM & LP). destruct rho as (_ & _ & _ & _ & _ & z0 & m0 & _). pose proof u_pos as U.
  pose proof (norm_pos e1 e2 e3) as E0. fold E in E0. set (d := v1 * e1 + v2 * e2 + v3 * e3).
  assert (UE : 0 <= u * E) by (apply Rmult_le_pos; lra).
  assert (NP : norm (p1 - v1) (p2 - v2) (p3 - v3) <= u * L) by (rewrite HLv; apply norm_relative; auto; lra).
  assert (PL : norm p1 p2 p3 <= (1 + u) * L) by (pose proof (norm_difference p1 p2 p3 v1 v2 v3) as T;
    rewrite <- HLv in T;
    lra).
  assert (P : Rabs (dot - (e1 * p1 + e2 * p2 + e3 * p3)) <= (3 + / 500) * u * (E * L) + bp (-1000)).
  { clear - Hdot B1 B2 B3 B4 B5 B6 PL E0 U LP. unfold tdot in Hdot. error_of Hdot P.
    eapply Rle_trans; [exact P|]. apply Rplus_le_compat; [|apply bp_le; lia].
    assert (S : Rabs e1 * Rabs p1 + Rabs e2 * Rabs p2 + Rabs e3 * Rabs p3 <= E * ((1 + u) * L)).
    { eapply Rle_trans; [apply Rle_abs|]. eapply Rle_trans; [apply dot_le|]. rewrite !norm_abs.
      apply mul2; split; auto using norm_pos. fold E. lra. }
    apply Rle_trans with ((3 + / 1000) * u * (E * ((1 + u) * L))); [apply Rmult_le_compat_l; lra|].
    assert (0 <= u * (E * L)) by (apply Rmult_le_pos; [lra|]; apply Rmult_le_pos; lra).
    replace ((3 + / 1000) * u * (E * ((1 + u) * L))) with ((3 + / 1000) * (1 + u) * (u * (E * L))) by ring.
    rewrite u_val in *. lra. }
  pose proof (dot_le e1 e2 e3 (p1 - v1) (p2 - v2) (p3 - v3)) as Q. fold E in Q.
  assert (Q2 : E * norm (p1 - v1) (p2 - v2) (p3 - v3) <= E * (u * L)) by (apply Rmult_le_compat_l; lra).
  assert (PD : Rabs (dot - d) <= (4 + / 500) * u * (E * L) + bp (-1000)).
  { replace (dot - d) with ((dot - (e1 * p1 + e2 * p2 + e3 * p3)) + (e1 * (p1 - v1) + e2 * (p2 - v2) + e3 * (p3 - v3)))
    by
      (unfold d; ring). eapply Rle_trans; [apply Rabs_triang|]. lra. }
  set (i := / L). assert (i0 : 0 < i) by now apply Rinv_0_lt_compat. assert (iL : i * L = 1) by (unfold i; field; lra).
  assert (iT : i <= bp 200) by (unfold i; change 200%Z with (Z.opp (-200)); rewrite bpow_opp; apply Rinv_le_contravar;
    [apply bp_pos | assumption]).
  assert (IN : Rabs (inverse - i) <= 6 * u * i).
  { replace (inverse - i) with ((inverse * L - 1) * i) by (replace ((inverse * L - 1) * i) with (inverse * (i * L) - i)
    by
      ring; rewrite iL; ring). rewrite Rabs_mult, (Rabs_pos_eq i) by lra. apply Rmult_le_compat_r; lra. }
  assert (DI : Rabs d * i <= E).
  { apply Rle_trans with (L * E * i); [apply Rmult_le_compat_r; [lra|]; rewrite HLv; apply dot_le|].
    replace (L * E * i) with (i * L * E) by ring. rewrite iL. lra. }
  assert (T9 : bp (-1000) * i <= / 1000000 * z).
  { apply Rle_trans with (bp (-1000) * bp 200); [apply Rmult_le_compat_l; [apply Rlt_le, bp_pos | assumption]|].
    rewrite <- bp_add. apply very_tiny. lia. }
  assert (PI : Rabs (dot - d) * i <= (4 + / 500) * (u * E) + / 1000000 * z).
  { apply Rle_trans with (((4 + / 500) * u * (E * L) + bp (-1000)) * i); [apply Rmult_le_compat_r; lra|].
    replace (((4 + / 500) * u * (E * L) + bp (-1000)) * i) with ((4 + / 500) * (u * E) * (i * L) + bp (-1000) * i) by
      ring.
    rewrite iL. lra. }
  assert (I1 : 0 <= inverse <= (1 + 6 * u) * i) by (apply Rabs_le_inv in IN; rewrite u_val in *; lra).
  assert (X : Rabs (Rabs dot * inverse - Rabs d * i) <= (101 / 10) * (u * E) + / 500000 * z).
  { replace (Rabs dot * inverse - Rabs d * i) with ((Rabs dot - Rabs d) * inverse + Rabs d * (inverse - i)) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite (Rabs_mult (_ - _)), (Rabs_mult (Rabs d)), Rabs_Rabsolu,
      (Rabs_pos_eq inverse) by lra.
    assert (X1 : Rabs (Rabs dot - Rabs d) * inverse <= Rabs (dot - d) * ((1 + 6 * u) * i)) by (apply mul2; split;
      auto using Rabs_pos; [apply Rabs_triang_inv2 | lra | lra]).
    replace (Rabs (dot - d) * ((1 + 6 * u) * i)) with ((1 + 6 * u) * (Rabs (dot - d) * i)) in X1 by ring.
    assert (X2 : (1 + 6 * u) * (Rabs (dot - d) * i) <= (1 + 6 * u) * ((4 + / 500) * (u * E) + / 1000000 * z)) by (apply
      Rmult_le_compat_l; lra).
    assert (X3 : Rabs d * Rabs (inverse - i) <= Rabs d * (6 * u * i)) by (apply Rmult_le_compat_l; [apply Rabs_pos |
      assumption]). replace (Rabs d * (6 * u * i)) with (6 * u * (Rabs d * i)) in X3 by ring.
    assert (X4 : 6 * u * (Rabs d * i) <= 6 * u * E) by (apply Rmult_le_compat_l; lra). rewrite u_val in *. lra. }
  pose proof (near_le _ _ _ X) as NX. rewrite (Rabs_pos_eq (Rabs d * i)) in NX by (apply Rmult_le_pos; [apply Rabs_pos |
    lra]). pose proof (RN_err (Rabs dot * inverse)) as R. fold along in R.
    pose proof (very_tiny (-1075) ltac:(lia)) as T.
  change (Rabs d / L) with (Rabs d * i).
  assert (Y : Rabs (along - Rabs d * i) <= (112 / 10) * (u * E) + / 1000 * z).
  { replace (along - Rabs d * i) with ((along - Rabs dot * inverse) + (Rabs dot * inverse - Rabs d * i)) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite u_val in *. lra. }
  split; [assumption|]. split.
  - unfold along. rewrite <- RN_0. apply RN_le. apply Rmult_le_pos; [apply Rabs_pos | lra].
  - apply Rabs_le_inv in Y. rewrite u_val in *. lra.
Qed.

Lemma away_low : (1 - 4 * u) * E <= away.
Proof.
  pose proof u_pos as U. pose proof (norm_le_sum e1 e2 e3) as NS. fold E in NS.
  assert (A1 : F (Rabs e1)) by now apply generic_format_abs. assert (A2 : F (Rabs e2)) by now apply generic_format_abs.
  assert (A3 : F (Rabs e3)) by now apply generic_format_abs. unfold away.
  pose proof (Rabs_pos e1) as Z1. pose proof (Rabs_pos e2) as Z2. pose proof (Rabs_pos e3) as Z3.
  pose proof (RN_sum _ _ A1 A2) as R1. set (j := RN (Rabs e1 + Rabs e2)) in *.
  rewrite (Rabs_pos_eq (_ + _)) in R1 by lra.
  apply Rabs_le_inv in R1. assert (j0 : 0 <= j) by (rewrite u_val in *; lra).
  pose proof (RN_sum j _ (RN_F _) A3) as R2. set (w := RN (j + Rabs e3)) in *.
  rewrite (Rabs_pos_eq (j + _)) in R2 by lra.
  apply Rabs_le_inv in R2. rewrite u_val in *. lra.
Qed.
(* The lesser distance is a share of the radius. *)
Theorem NEARLY_INSIDE_holds : bp (-21) * m <= n /\ 0 < n.
Proof.
  destruct F_radius as [_ FR]. destruct m_pos as (M & _). pose proof (bp_pos (-202)). unfold NEARLY_INSIDE in Hinside.
  apply Rabs_le_inv in Hnearest. assert (B : bp (-20) = 2 * bp (-21)) by (change (-20)%Z with (1 + -21)%Z;
    rewrite bp_add,
    bp_1; ring). rewrite B in Hinside. pose proof (bp_pos (-21)) as B0.
  assert (Q : 2 * bp (-21) * ((1 - 6 * u) * m) <= 2 * bp (-21) * radius) by (apply Rmult_le_compat_l; lra).
  assert (0 < bp (-21) * m) by (apply Rmult_lt_0_compat; lra).
  replace (2 * bp (-21) * ((1 - 6 * u) * m)) with (2 * (1 - 6 * u) * (bp (-21) * m)) in Q by ring.
  rewrite u_val in *. split; lra.
Qed.
Lemma error_low : (128 - / 100) * z + (98 / 100) * (E * E / n) + (16 - / 50) * (u * E) + (16 - / 50) * (u * (u * size))
  <=
  (1 + 4 * u) * error /\ 0 <= error.
Proof.
  destruct F_radius as [_ FR]. destruct rho as (_ & _ & _ & _ & _ & z0 & m0 & zm).
  destruct NEARLY_INSIDE_holds as [NL N0].
  pose proof u_pos as U. pose proof (norm_pos e1 e2 e3) as E0. fold E in E0. pose proof away_low as AL.
  pose proof (very_tiny (-1075) ltac:(lia)) as T. assert (UE : 0 <= u * E) by (apply Rmult_le_pos; lra).
  assert (US : 0 <= u * size) by (apply Rmult_le_pos; lra). assert (UUS : 0 <= u * (u * size)) by (apply Rmult_le_pos;
    lra).
  apply Rabs_le_inv in Hnearest as HN. assert (NP : 0 < nearest) by lra.
  assert (A0 : 0 <= away) by (apply Rle_trans with (2 := AL); apply Rmult_le_pos; [rewrite u_val; lra | assumption]).
  (* the radius's share *)
  pose proof (RN_err (radius * REACH_ERROR)) as E1. set (g := RN (radius * REACH_ERROR)) in *. unfold REACH_ERROR in E1.
  assert (GL : (128 - / 1000) * z <= radius * (128 * u * u)).
  { replace (radius * (128 * u * u)) with (128 * (u * (u * radius))) by ring.
    assert (Q : u * (u * ((1 - 6 * u) * m)) <= u * (u * radius)) by (apply Rmult_le_compat_l; [lra|]; apply
      Rmult_le_compat_l; lra). replace (u * (u * ((1 - 6 * u) * m))) with ((1 - 6 * u) * z) in Q by (unfold z; ring).
    rewrite u_val in *. lra. }
  rewrite (Rabs_pos_eq (radius * _)) in E1 by lra. apply Rabs_le_inv in E1.
  assert (G1 : (128 - / 500) * z <= g) by (rewrite u_val in *; lra).
  (* the bend *)
  set (ee := E * E). assert (ee0 : 0 <= ee) by apply sq_pos. set (a2 := RN (away * away)).
  assert (AA : (1 - 10 * u) * ee - bp (-1075) <= a2).
  { pose proof (RN_err (away * away)) as R. fold a2 in R. rewrite (Rabs_pos_eq (away * away)) in R by apply sq_pos.
    assert (LL : (1 - 4 * u) * E * ((1 - 4 * u) * E) <= away * away) by (apply mul2; split; try assumption;
      apply Rmult_le_pos; try assumption; rewrite u_val; lra).
    replace ((1 - 4 * u) * E * ((1 - 4 * u) * E)) with ((1 - 4 * u) * (1 - 4 * u) * ee) in LL by (unfold ee; ring).
    apply Rabs_le_inv in R. rewrite u_val in *. lra. }
  assert (a20 : 0 <= a2) by (unfold a2; rewrite <- RN_0; apply RN_le, sq_pos).
  set (j := / n). set (i := / nearest). assert (j0 : 0 < j) by now apply Rinv_0_lt_compat.
  assert (i0 : 0 < i) by now apply Rinv_0_lt_compat.
  assert (IJ : (99 / 100) * j <= i).
  { unfold i, j. apply Rle_trans with (/ ((1 + / 1000) * n)); [|apply Rinv_le_contravar; lra].
    rewrite Rinv_mult. apply Rmult_le_compat_r; [apply Rlt_le; exact j0 | lra]. }
  assert (IT : i <= bp 230).
  { unfold i. change 230%Z with (Z.opp (-230)). rewrite bpow_opp. apply Rinv_le_contravar; [apply bp_pos|].
    destruct m_pos as (M & _). assert (bp (-21) * bp (-202) <= bp (-21) * m) by (apply Rmult_le_compat_l; [apply Rlt_le,
      bp_pos | assumption]). rewrite <- bp_add in *. assert (2 * bp (-230) <= bp (-21 + -202)) by (rewrite <- bp_1,
      <- bp_add; apply bp_le; lia). pose proof (bp_pos (-230)). lra. }
  assert (TI : bp (-1075) * i <= / 1000000 * z).
  { apply Rle_trans with (bp (-1075) * bp 230); [apply Rmult_le_compat_l; [apply Rlt_le, bp_pos | assumption]|].
    rewrite <- bp_add. apply very_tiny. lia. }
  assert (BI : (985 / 1000) * (ee * j) - / 1000000 * z <= a2 * i).
  { apply Rle_trans with (((1 - 10 * u) * ee - bp (-1075)) * i); [|apply Rmult_le_compat_r; lra].
    assert (Q : ee * ((99 / 100) * j) <= ee * i) by (apply Rmult_le_compat_l; lra).
    assert (0 <= ee * j) by (apply Rmult_le_pos; lra). rewrite u_val in *. lra. }
  pose proof (RN_err (a2 * i)) as R1. change (RN (a2 * i)) with bend in R1.
  assert (ai : 0 <= a2 * i) by (apply Rmult_le_pos; lra). rewrite (Rabs_pos_eq (a2 * i)) in R1 by assumption.
  apply Rabs_le_inv in R1. assert (EJ : 0 <= ee * j) by (apply Rmult_le_pos; lra).
  assert (BL : (984 / 1000) * (ee * j) - / 100000 * z <= bend) by (rewrite u_val in *; lra).
  assert (b0 : 0 <= bend) by (change bend with (RN (a2 * i)); rewrite <- RN_0; apply RN_le; exact ai).
  (* the rest *)
  pose proof (RN_err (u * size)) as R2. rewrite (Rabs_pos_eq (u * size)) in R2 by assumption.
  set (h1 := RN (u * size)) in *.
  apply Rabs_le_inv in R2. assert (h10 : 0 <= h1) by (unfold h1; rewrite <- RN_0; apply RN_le; exact US).
  pose proof (RN_err (away + h1)) as R3. rewrite (Rabs_pos_eq (away + h1)) in R3 by lra.
  set (h2 := RN (away + h1)) in *.
  apply Rabs_le_inv in R3. assert (h20 : 0 <= h2) by (unfold h2; rewrite <- RN_0; apply RN_le; lra).
  pose proof (RN_err (AWAY_ERROR * h2)) as R4. unfold AWAY_ERROR in R4 at 2 3. assert (uh : 0 <= u * h2) by (apply
    Rmult_le_pos; lra). rewrite (Rabs_pos_eq (16 * u * h2)) in R4 by lra. set (h3 := RN (AWAY_ERROR * h2)) in *.
  apply Rabs_le_inv in R4. assert (h30 : 0 <= h3) by (unfold h3, AWAY_ERROR; rewrite <- RN_0; apply RN_le; lra).
  assert (H2 : (1 - 6 * u) * (u * E) + (1 - 6 * u) * (u * (u * size)) - / 100000 * z <= u * h2).
  { assert (Q : u * ((1 - 6 * u) * E + (1 - 3 * u) * (u * size) - 2 * bp (-1075)) <= u * h2) by
    (apply Rmult_le_compat_l;
      [lra|]; rewrite u_val in *; lra). assert (u * (2 * bp (-1075)) <= 2 * bp (-1075)) by (pose proof (bp_pos (-1075));
      rewrite u_val; lra). rewrite u_val in *. lra. }
  assert (H3 : (16 - / 100) * (u * E) + (16 - / 100) * (u * (u * size)) - / 1000 * z <= h3) by (rewrite u_val in *;
    lra).
  pose proof (RN_err (g + bend)) as R5. assert (g0 : 0 <= g) by lra. rewrite (Rabs_pos_eq (g + bend)) in R5 by lra.
  set (gb := RN (g + bend)) in *. apply Rabs_le_inv in R5.
  assert (gb0 : 0 <= gb) by (unfold gb; rewrite <- RN_0; apply RN_le; lra).
  pose proof (RN_err (gb + h3)) as R6. rewrite (Rabs_pos_eq (gb + h3)) in R6 by lra.
  change (RN (gb + h3)) with error in R6. apply Rabs_le_inv in R6.
  assert (e0 : 0 <= error) by (change error with (RN (gb + h3)); rewrite <- RN_0; apply RN_le; lra).
  assert (Z1 : g + bend + h3 - 3 * bp (-1075) <= (1 + 4 * u) * error).
  { clear - R5 R6 g0 b0 h30 gb0 e0 U. pose proof (bp_pos (-1075)). clearbody g bend h3 gb error. rewrite u_val in *.
  lra. }
  split; [|assumption]. change (ee / n) with (ee * j).
  clear - Z1 H3 BL G1 T z0 EJ UUS UE. lra.
Qed.

(* Where the closed form is taken, the spheres are not far from the origin, and the center moves little. *)
Theorem PAIR_ERROR_holds : u * (u * size) <= (51 / 100) * (bp (-66) * m) /\ u * E <= bp (-66) * m /\
  error <= bp (-63) * m.
Proof.
  destruct F_radius as [_ FR]. destruct rho as (_ & _ & _ & _ & _ & z0 & m0 & _).
  destruct NEARLY_INSIDE_holds as [_ N0].
  destruct error_low as [EL e0]. pose proof u_pos as U. pose proof (norm_pos e1 e2 e3) as E0. fold E in E0.
  assert (UE : 0 <= u * E) by (apply Rmult_le_pos; lra).
  assert (UUS : 0 <= u * (u * size)) by (apply Rmult_le_pos; [lra | apply Rmult_le_pos; lra]).
  assert (EJ : 0 <= E * E / n) by (apply Rmult_le_pos; [apply sq_pos | apply Rlt_le; now apply Rinv_0_lt_compat]).
  assert (P64 : error <= bp (-63) * m).
  { unfold PAIR_ERROR in Hpair. apply Rle_trans with (1 := Hpair). change (-63)%Z with (1 + -64)%Z.
  rewrite bp_add, bp_1.
    pose proof (bp_pos (-64)). rewrite (Rmult_comm radius). rewrite (Rmult_comm 2), Rmult_assoc.
    apply Rmult_le_compat_l; [lra|]. rewrite u_val in *. lra. }
  assert (B : bp (-63) = 8 * bp (-66)) by (change (-63)%Z with (3 + -66)%Z; rewrite bp_add; reflexivity).
  assert (P0 : 0 < bp (-66) * m) by (apply Rmult_lt_0_compat; [apply bp_pos | lra]).
  assert (4 * u * error <= / 1000 * error) by (apply Rmult_le_compat_r; [assumption | rewrite u_val; lra]).
  split; [|split; [|exact P64]]; rewrite B in P64; lra.
Qed.
(* The bracket: one of its ends encloses both spheres, and no double below the other does. *)
Theorem AWAY_ERROR_holds : let reach := Rmax (norm (k * v1 + (e1 + g1)) (k * v2 + (e2 + g2)) (k * v3 + (e3 + g3)) + r)
    (norm (k * v1 + (e1 + g1) - v1) (k * v2 + (e2 + g2) - v2) (k * v3 + (e3 + g3) - v3) + s) in
  let l := RN (low + along) in
  reach <= summed_up radius (RN (l + error)) /\ forall R, F R -> reach <= R -> summed_up radius (RN (l - error)) <= R.
Proof.
  intros reach l. destruct F_radius as [F1 FR]. destruct m_pos as (M & LM & LP).
  destruct rho as (_ & _ & l0 & r0 & LR & z0 & m0 & zm). destruct NEARLY_INSIDE_holds as [NL N0].
  destruct along_e as [AE [A0 AU]].
  destruct error_low as [EL e0]. destruct radius_near as (RN1 & LN & Fl). pose proof u_pos as U.
  pose proof (norm_pos e1 e2 e3) as E0. fold E in E0. pose proof (norm_pos g1 g2 g3) as G0. fold G in G0.
  pose proof (very_tiny (-1075) ltac:(lia)) as T. assert (UE : 0 <= u * E) by (apply Rmult_le_pos; lra).
  assert (UUS : 0 <= u * (u * size)) by (apply Rmult_le_pos; [lra | apply Rmult_le_pos; lra]).
  pose proof (pair_reaches v1 v2 v3 (e1 + g1) (e2 + g2) (e3 + g3) r s) as PR. cbv zeta in PR. rewrite <- HLv in PR.
  fold k in PR. fold m in PR. fold n in PR. specialize (PR N0 LP). fold reach in PR.
  set (d := v1 * e1 + v2 * e2 + v3 * e3) in *. set (dg := v1 * g1 + v2 * g2 + v3 * g3) in *.
  replace (v1 * (e1 + g1) + v2 * (e2 + g2) + v3 * (e3 + g3)) with (d + dg) in PR by (unfold d, dg; ring).
  set (i := / L). assert (i0 : 0 < i) by now apply Rinv_0_lt_compat.
  set (K := 36 * (u * (u * L)) + 59 * (u * (u * Rabs (s - r))) + 15 * (u * (u * size))) in *.
  assert (DD : Rabs d / L - K <= Rabs (d + dg) / L <= Rabs d / L + K).
  { unfold Rdiv in *. fold i in HG |- *. pose proof (Rabs_triang d dg) as T1.
    pose proof (Rabs_triang (d + dg) (- dg)) as T2. rewrite Rabs_Ropp in T2.
    replace (d + dg + - dg) with d in T2 by ring.
    assert (Rabs (d + dg) * i <= (Rabs d + Rabs dg) * i) by (apply Rmult_le_compat_r; lra).
    assert (Rabs d * i <= (Rabs (d + dg) + Rabs dg) * i) by (apply Rmult_le_compat_r; lra). lra. }
  destruct PAIR_ERROR_holds as (SZ & SE & P64). assert (P0 : 0 < bp (-63) * m) by (apply Rmult_lt_0_compat;
    [apply bp_pos
    | lra]). set (ee := E * E) in *. assert (ee0 : 0 <= ee) by apply sq_pos. set (j := / n).
  assert (j0 : 0 < j) by now apply Rinv_0_lt_compat. assert (EJ : 0 <= ee * j) by (apply Rmult_le_pos; lra).
  change (ee / n) with (ee * j) in EL.
  assert (E1 : E <= / 1000 * m).
  { assert (B : bp (-66) = u * bp (-13)) by (unfold u; rewrite <- bp_add; reflexivity). rewrite B in SE.
    assert (Q : u * E <= u * (bp (-13) * m)) by lra. apply Rmult_le_reg_l in Q; [|assumption].
    assert (bp (-13) <= / 1000) by (simpl; lra). assert (bp (-13) * m <= / 1000 * m) by (apply Rmult_le_compat_r; lra).
    lra. }
  (* what the distances bend *)
  assert (GM : G <= (26 / 10) * (bp (-66) * m)).
  { apply Rle_trans with (1 := HG2). assert (z <= bp (-106) * m).
    { unfold z. rewrite <- Rmult_assoc. unfold u. rewrite <- bp_add. apply Rle_refl. }
    assert (bp (-106) * m <= / 1000000 * bp (-66) * m).
    { apply Rmult_le_compat_r; [lra|]. change (-106)%Z with (-40 + -66)%Z. rewrite bp_add. apply Rmult_le_compat_r;
        [apply Rlt_le, bp_pos | simpl; lra]. } lra. }
  assert (BEND : norm (e1 + g1) (e2 + g2) (e3 + g3) * norm (e1 + g1) (e2 + g2) (e3 + g3) / (2 * n) <= (63 / 100) * (ee
    * j)
    + (55 / 100) * z).
  { pose proof (norm_triangle e1 e2 e3 g1 g2 g3) as NT. fold E G in NT. pose proof (norm_pos (e1 + g1) (e2 + g2) (e3
      + g3)) as N1. set (w := norm (e1 + g1) (e2 + g2) (e3 + g3)) in *.
    assert (W : w * w <= (126 / 100) * ee + 5 * (G * G)).
    { apply Rle_trans with ((E + G) * (E + G)); [apply mul2; split; lra|]. pose proof (sq_pos (E / 2 - 2 * G)).
    pose proof (sq_pos E).
      unfold ee. lra. }
    unfold Rdiv. rewrite Rinv_mult. fold j. replace (w * w * (/ 2 * j)) with (w * w * j * / 2) by ring.
    assert (W2 : w * w * j <= ((126 / 100) * ee + 5 * (G * G)) * j) by (apply Rmult_le_compat_r; lra).
    assert (GJ : G * G * j <= (22 / 100) * z).
    { assert (JB : j <= / (bp (-21) * m)) by (apply Rinv_le_contravar; [apply Rmult_lt_0_compat; [apply bp_pos | lra] |
        assumption]). set (h := (26 / 10) * (bp (-66) * m)) in *.
      apply Rle_trans with (h * h * / (bp (-21) * m)).
      - apply mul3; split; lra.
      - assert (HH : h * h * / (bp (-21) * m) = 676 / 100 * (bp (-111) * m)).
        { unfold h. replace (bp (-111)) with (bp (-66) * bp (-66) * bp 21) by (rewrite <- !bp_add; reflexivity).
          change 21%Z with (Z.opp (-21)). rewrite bpow_opp. field. split; first [apply Rgt_not_eq, bp_pos | lra]. }
        rewrite HH. assert (Z : z = 32 * (bp (-111) * m)).
        { unfold z, u. replace (32 * (bp (-111) * m)) with (32 * bp (-111) * m) by ring.
          change 32 with (bp 5). rewrite <- bp_add, <- Rmult_assoc, <- bp_add. reflexivity. }
        rewrite Z in *. lra. }
    lra. }
  (* the sums *)
  set (A := Rabs d / L) in *. set (um := u * m) in *. set (ul := u * L) in *.
  assert (C1 : Rabs (low + along) <= (201 / 100) * um + (151 / 100) * ul + (1 + / 1000) * E + / 1000 * z).
  { eapply Rle_trans; [apply Rabs_triang|]. rewrite (Rabs_pos_eq along) by assumption. lra. }
  pose proof (rounding _ _ C1) as R1. fold l in R1.
  replace (u * ((201 / 100) * um + (151 / 100) * ul + (1 + / 1000) * E + / 1000 * z)) with ((201 / 100) * z + (151 /
    100)
    * (u * ul) + (1 + / 1000) * (u * E) + / 1000 * (u * z)) in R1 by (unfold z, um; ring).
  assert (UZ : u * z <= / 1000 * z) by (apply Rmult_le_compat_r; [lra | rewrite u_val; lra]).
  assert (UZ0 : 0 <= u * z) by (apply Rmult_le_pos; lra). assert (ulm : ul <= 2 * um) by (unfold ul, um; nra).
  assert (um0 : 0 < um) by (apply Rmult_lt_0_compat; lra).
  assert (ulul : u * ul <= / 1000000 * ul) by (apply Rmult_le_compat_r; [unfold ul; apply Rmult_le_pos; lra | rewrite
    u_val; lra]). assert (uEE : u * E <= / 1000000 * E) by (apply Rmult_le_compat_r; [assumption | rewrite u_val; lra]).
  pose proof (near_le _ _ _ R1) as N1. set (b := (202 / 100) * um + (152 / 100) * ul + (101 / 100) * E) in *.
  assert (LB : Rabs l <= b) by (unfold b in *; lra).
  assert (Up : Rabs (l + error) <= b + error) by (eapply Rle_trans; [apply Rabs_triang|]; rewrite (Rabs_pos_eq error) by
    assumption; lra).
  assert (Down : Rabs (l - error) <= b + error) by (unfold Rminus; eapply Rle_trans; [apply Rabs_triang|];
    rewrite Rabs_Ropp, (Rabs_pos_eq error) by assumption; lra).
  pose proof (rounding _ _ Up) as R2. pose proof (rounding _ _ Down) as R3.
  replace (u * (b + error)) with ((202 / 100) * z + (152 / 100) * (u * ul) + (101 / 100) * (u * E) + u * error) in R2,
    R3
    by (unfold b, z, um; ring).
  set (x2 := RN (l + error)) in *. set (x3 := RN (l - error)) in *.
  assert (RP : Rabs radius = radius) by (apply Rabs_pos_eq; rewrite u_val in *; lra).
  assert (mm : um <= / 1000000 * m) by (apply Rmult_le_compat_r; [lra | rewrite u_val; lra]).
  assert (P63 : bp (-63) * m <= / 1000000 * m) by (apply Rmult_le_compat_r; [lra | apply Rle_trans with (bp (-20));
    [apply bp_le; lia | simpl; lra]]).
  assert (ue : 0 <= u * error <= / 1000000 * error) by (split; [apply Rmult_le_pos; lra | apply Rmult_le_compat_r;
    [lra |
    rewrite u_val; lra]]).
  assert (BS : b + error <= / 100 * m) by (unfold b; lra).
  assert (X2 : Rabs x2 <= Rabs radius).
  { pose proof (near_le _ _ _ R2). rewrite RP. unfold b in *. rewrite u_val in *. lra. }
  assert (X3 : Rabs x3 <= Rabs radius).
  { pose proof (near_le _ _ _ R3). rewrite RP. unfold b in *. rewrite u_val in *. lra. }
  destruct (summed radius x2 F1 (RN_F _) X2) as [[_ S2] _]. destruct (summed radius x3 F1 (RN_F _) X3) as [_ S3].
  apply Rabs_le_inv in RN1. apply Rabs_le_inv in R1. apply Rabs_le_inv in R2. apply Rabs_le_inv in R3.
  apply Rabs_le_inv in AE. assert (EL' : (128 - / 50) * z + (97 / 100) * (ee * j) + (16 - / 20) * (u * E) + (16 - / 20)
    *
    (u * (u * size)) <= (1 - u) * error).
  { assert (Q : (1 - 6 * u) * ((1 + 4 * u) * error) <= (1 - u) * error) by (replace ((1 - 6 * u) * ((1 + 4 * u) *
    error))
      with ((1 - 6 * u) * (1 + 4 * u) * error) by ring; apply Rmult_le_compat_r; [assumption | rewrite u_val; lra]).
    assert (Q2 : (1 - 6 * u) * ((128 - / 100) * z + 98 / 100 * (ee * j) + (16 - / 50) * (u * E) + (16 - / 50) * (u * (u
      *
      size))) <= (1 - 6 * u) * ((1 + 4 * u) * error)) by (apply Rmult_le_compat_l; [rewrite u_val; lra | assumption]).
    set (ue1 := u * E) in *. set (us1 := u * (u * size)) in *. clearbody ue1 us1. rewrite u_val in *. lra. }
  fold ul in l0. unfold K in DD. destruct DD as [DL DH]. destruct PR as [PL PH]. destruct AE as [AL AH].
  destruct R1 as [R1L R1H]. destruct R2 as [R2L _]. destruct R3 as [_ R3H]. destruct RN1 as [RL RH].
  fold ul in LR. set (lam := u * ul) in *. set (rh := u * (u * Rabs (s - r))) in *. set (sg := u * (u * size)) in *.
  set (ua := u * E) in *. set (uw := u * error) in *. set (uz := u * z) in *. set (ej := ee * j) in *.
  assert (EL2 : error - uw = (1 - u) * error) by (unfold uw; ring). rewrite <- EL2 in EL'.
  set (AG := Rabs (d + dg) / L) in *. set (bb := norm (e1 + g1) (e2 + g2) (e3 + g3) * norm (e1 + g1) (e2 + g2) (e3 +
    g3) /
    (2 * n)) in *.
  clearbody lam rh sg ua uw uz ej AG bb A reach x2 x3 l along error radius low m z.
  split.
  - apply Rle_trans with (2 := S2).
    clear - PH BEND DH AL RL R1L R2L EL' LR l0 r0 z0 T UZ UZ0 UE UUS EJ ue. lra.
  - intros R FR' HR. apply (S3 R FR').
    clear - PL DL AH RH R1H R3H EL' LR l0 r0 z0 T UZ UZ0 UE UUS EJ ue HR. lra.
Qed.
End Bracket.
End Radius.
