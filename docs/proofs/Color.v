(* rt-shade, phong.rs: the error of a colour: the power of a highlight, the diffuse term, and the sum over the lights.
  *)
From Coq Require Import List.
From Proofs Require Import Rounding ErrorFree Steps.
Open Scope R_scope.

(* The error of a power, relative to its growth and to itself; where the growth is at most that. *)
Definition POWER_FACTOR := 105 / 100.
Definition POWER_ROUNDING := 21 / 10 * u.
Definition LARGEST_GROWTH := 1 / 32.
(* Else the larger base, if the shininess is at least 1. *)
Definition WIDE_FACTOR := 101 / 100.
(* The roundings of a diffuse term. *)
Definition DIFFUSE_ROUNDING := 31 / 10 * u.
(* The roundings of the sum, besides two for each light. *)
Definition SUM_ROUNDINGS := 5.
(* Swallows what underflows. *)
Definition UNDERFLOW := bp (-1022).

(* ---- Powers ---- *)
Lemma exp_near : forall t g, Rabs t <= g -> g <= / 32 -> Rabs (exp t - 1) <= 1033 / 1000 * g.
Proof.
  intros t g T G. apply Rabs_le_inv in T. pose proof (exp_ineq1_le t) as L. pose proof (exp_ineq1_le (- t)) as L2.
    pose proof (exp_pos t) as P.
  assert (E : exp t * exp (- t) = 1) by (rewrite <- exp_plus; replace (t + - t) with 0 by ring; apply exp_0).
  assert (U : exp t * (1 - t) <= 1) by (rewrite <- E; apply Rmult_le_compat_l; lra).
  apply Rabs_le. split; [lra|]. apply Rmult_le_reg_r with (1 - t); [lra|].
  assert (1033 / 1000 * g * (31 / 32) <= 1033 / 1000 * g * (1 - t)) by (apply Rmult_le_compat_l; lra). lra.
Qed.
Lemma ln_near : forall y z k e, 0 < k -> k <= y -> k <= z -> Rabs (z - y) <= e -> Rabs (ln z - ln y) <= e / k.
Proof.
  assert (H : forall y z k e, 0 < k -> k <= y -> k <= z -> Rabs (z - y) <= e -> ln z - ln y <= e / k).
  { intros y z k e K Y Z E. assert (y0 : 0 < y) by lra. assert (z0 : 0 < z) by lra. pose proof (Rabs_pos (z - y)).
    assert (P : 0 < z / y) by (apply Rmult_lt_0_compat; [assumption | now apply Rinv_0_lt_compat]).
    assert (L : ln (z / y) <= z / y - 1).
    { pose proof (exp_ineq1_le (ln (z / y))) as X. rewrite exp_ln in X by assumption. lra. }
    unfold Rdiv in L at 1. rewrite ln_mult, ln_Rinv in L by (auto; now apply Rinv_0_lt_compat).
    apply Rle_trans with (e / y).
    - replace (z / y - 1) with ((z - y) / y) in L by (field; lra). apply Rabs_le_inv in E.
      assert ((z - y) / y <= e / y) by (apply Rmult_le_compat_r; [apply Rlt_le, Rinv_0_lt_compat; assumption | lra]).
        lra.
    - apply Rmult_le_compat_l; [lra|]. apply Rinv_le_contravar; assumption. }
  intros y z k e K Y Z E. apply Rabs_le. pose proof (H y z k e K Y Z E). rewrite Rabs_minus_sym in E. pose proof (H z
    y k e K Z Y E). lra.
Qed.
Section Power.
(* x the alignment as computed, within e; y its clamped value and z the exact one; s the shininess; h the power as
  computed *)
Variables x y z s e h : R.
Hypotheses (S0 : 0 < s) (y0 : 0 < y) (z0 : 0 < z) (Hzy : Rabs (z - y) <= e) (Hh : Rabs (h - Rpower y s) <= 16 / 10 * u
  * h + / 2 * UNDERFLOW)
  (h0 : 0 <= h).
Theorem POWER_FACTOR_holds : 0 < x - e -> x - e <= y -> x - e <= z -> let g := s * e / (x - e) in g <= LARGEST_GROWTH ->
  Rabs (h - Rpower z s) <= (1 - 8 * u) * ((POWER_FACTOR * g + POWER_ROUNDING) * h + UNDERFLOW).
Proof.
  intros P Y Z g G. unfold LARGEST_GROWTH in G. pose proof (ln_near y z (x - e) e P Y Z Hzy) as L.
  assert (T : Rabs (s * (ln z - ln y)) <= g).
  { rewrite Rabs_mult, (Rabs_pos_eq s) by lra. unfold g. replace (s * e / (x - e)) with (s * (e / (x - e))) by (field;
    lra). apply Rmult_le_compat_l; lra. }
  pose proof (exp_near _ _ T ltac:(lra)) as E. pose proof (Rabs_pos (s * (ln z - ln y))). assert (g0 : 0 <= g) by lra.
  assert (R : Rpower z s = Rpower y s * exp (s * (ln z - ln y))) by (unfold Rpower; rewrite <- exp_plus; f_equal; ring).
  set (p := Rpower y s) in *. assert (p0 : 0 < p) by apply exp_pos. assert (U0 : 0 < UNDERFLOW) by apply bp_pos.
  replace (h - Rpower z s) with ((h - p) - p * (exp (s * (ln z - ln y)) - 1)) by (rewrite R; ring).
  eapply Rle_trans; [apply Rabs_minus_le; [exact Hh | rewrite Rabs_mult, (Rabs_pos_eq p) by lra; apply
    Rmult_le_compat_l; [lra | exact E]]|].
  assert (PB : p <= (1 + 2 * u) * h + / 2 * UNDERFLOW) by (apply Rabs_le_inv in Hh; rewrite u_val in *; lra).
  assert (X : p * (1033 / 1000 * g) <= ((1 + 2 * u) * h + / 2 * UNDERFLOW) * (1033 / 1000 * g)) by (apply
    Rmult_le_compat_r; lra).
  assert (gh : 0 <= g * h) by (apply Rmult_le_pos; assumption).
  assert (gu : UNDERFLOW * g <= / 32 * UNDERFLOW) by (replace (/ 32 * UNDERFLOW) with (UNDERFLOW * (1 / 32)) by lra;
    apply Rmult_le_compat_l; lra).
  replace (((1 + 2 * u) * h + / 2 * UNDERFLOW) * (1033 / 1000 * g)) with (1033 / 1000 * (1 + 2 * u) * (g * h) + 1033 /
    2000 * (UNDERFLOW * g)) in X by lra.
  unfold POWER_FACTOR, POWER_ROUNDING. replace ((105 / 100 * g + 21 / 10 * u) * h + UNDERFLOW) with (105 / 100 * (g *
    h) + 21 / 10 * u * h + UNDERFLOW) by ring.
  set (k := g * h) in *. set (m := UNDERFLOW * g) in *. clear - X gh gu U0 h0. rewrite u_val in *. lra.
Qed.
Theorem LARGEST_GROWTH_holds : 0 < x - e -> x - e <= y -> x - e <= z -> s * e / (x - e) <= LARGEST_GROWTH ->
  Rabs (exp (s * (ln z - ln y)) - 1) <= 1033 / 1000 * (s * e / (x - e)).
Proof.
  intros P Y Z G. pose proof (ln_near y z (x - e) e P Y Z Hzy) as L. apply exp_near; [|unfold LARGEST_GROWTH in G; lra].
  rewrite Rabs_mult, (Rabs_pos_eq s) by lra. replace (s * e / (x - e)) with (s * (e / (x - e))) by (field; lra). apply
    Rmult_le_compat_l; lra.
Qed.
Theorem POWER_ROUNDING_holds : e = 0 -> 0 < x -> x <= y -> x <= z -> Rabs (h - Rpower z s) <= (1 - 8 * u) *
  (POWER_ROUNDING * h + UNDERFLOW).
Proof.
  intros E X Y Z. pose proof POWER_FACTOR_holds as H. cbv zeta in H. rewrite E in H. unfold LARGEST_GROWTH in H.
  replace (s * 0 / (x - 0)) with 0 in H by (field; lra). rewrite Rmult_0_r, Rplus_0_l in H. apply H; lra.
Qed.
(* Both powers lie between 0 and the larger base. *)
Theorem WIDE_FACTOR_holds : 1 <= s -> y <= 1 -> z <= 1 -> y <= Rabs x -> z <= Rabs x + e -> 17 * u <= e ->
  Rabs (h - Rpower z s) <= (1 - 8 * u) * (WIDE_FACTOR * (Rabs x + e)).
Proof.
  intros S1 Y1 Z1 YX ZX E. assert (B : forall b, 0 < b -> b <= 1 -> 0 < Rpower b s <= b).
  { intros b b0 b1. split; [apply exp_pos|]. rewrite <- (Rpower_1 b) at 2 by assumption. unfold Rpower.
    assert (ln b <= 0) by (rewrite <- ln_1; destruct b1 as [b1|b1]; [left; now apply ln_increasing | right; now
      rewrite b1]).
    assert (s * ln b <= 1 * ln b) by (apply Rmult_le_compat_neg_r || nra; assumption).
    destruct (Rle_lt_or_eq_dec _ _ H0) as [K|K]; [left; now apply exp_increasing | right; now rewrite K]. }
  destruct (B y y0 Y1). destruct (B z z0 Z1). assert (U0 : UNDERFLOW <= / 1000 * u).
  { apply Rle_trans with (bp (-10) * u); [unfold u; rewrite <- bp_add; apply bp_le; lia | apply Rmult_le_compat_r;
    [apply Rlt_le, u_pos | simpl; lra]]. }
  apply Rabs_le_inv in Hh. pose proof u_pos. unfold WIDE_FACTOR. apply Rabs_le. rewrite u_val in *. lra.
Qed.
End Power.

(* ---- The diffuse term ---- *)
(* k c s l in three products, of a cosine c and a surface s that are within ce and se of exact ones *)
Theorem DIFFUSE_ROUNDING_holds : forall k l b c' s' c s ce se, 0 <= k -> 0 <= l <= 1 -> 0 <= c' <= 1 -> 0 <= c <= 1 ->
  0 <= s' <= b -> b <= 1 ->
  Rabs (c' - c) <= ce -> Rabs (s' - s) <= se ->
  Rabs (RN (RN (RN (k * c') * s') * l) - k * c * s * l) <= k * l * (b * (ce + (1 - 8 * u) * DIFFUSE_ROUNDING) + se) +
    4 * bp (-1075).
Proof.
  intros k l b c' s' c s ce se K Lb C' C S' B Hc Hs. pose proof u_pos. pose proof (bp_pos (-1075)) as T0.
  assert (b0 : 0 <= b) by lra.
  set (p := RN (k * c')). set (q := RN (p * s')). set (r := RN (q * l)).
  pose proof (RN_err (k * c')) as E1. pose proof (RN_err (p * s')) as E2. pose proof (RN_err (q * l)) as E3. fold p in
    E1. fold q in E2. fold r in E3.
  assert (kc0 : 0 <= k * c') by (apply Rmult_le_pos; lra). assert (kc1 : k * c' <= k) by (rewrite <- (Rmult_1_r k) at
    2; apply Rmult_le_compat_l; lra).
  assert (p0 : 0 <= p) by (unfold p; rewrite <- RN_0; apply RN_le; assumption). rewrite (Rabs_pos_eq (k * c')) in E1
    by assumption.
  assert (q0 : 0 <= q) by (unfold q; rewrite <- RN_0; apply RN_le; apply Rmult_le_pos; lra).
  rewrite (Rabs_pos_eq (p * s')) in E2 by (apply Rmult_le_pos; lra). rewrite (Rabs_pos_eq (q * l)) in E3 by (apply
    Rmult_le_pos; lra).
  set (T := bp (-1075)) in *.
  assert (F1 : Rabs (p * s' - k * c' * s') <= u * (k * b) + T).
  { replace (p * s' - k * c' * s') with ((p - k * c') * s') by ring. rewrite Rabs_mult, (Rabs_pos_eq s') by lra.
    apply Rle_trans with ((u * k + T) * s'); [apply Rmult_le_compat_r; [lra|]; assert (u * (k * c') <= u * k) by
      (apply Rmult_le_compat_l; lra); lra|].
    assert (k * s' <= k * b) by (apply Rmult_le_compat_l; lra). assert (u * (k * s') <= u * (k * b)) by (apply
      Rmult_le_compat_l; lra).
    assert (T * s' <= T * 1) by (apply Rmult_le_compat_l; lra). lra. }
  assert (kb0 : 0 <= k * b) by (apply Rmult_le_pos; lra).
  assert (M1 : k * c' * s' <= k * b) by (apply Rmult_le_compat; lra).
  assert (F2 : Rabs (q - k * c' * s') <= (2 + / 1000) * u * (k * b) + (2 + / 1000) * T).
  { replace (q - k * c' * s') with ((q - p * s') + (p * s' - k * c' * s')) by ring. eapply Rle_trans; [apply
    Rabs_triang|].
    apply Rabs_le_inv in F1. assert (u * (p * s') <= u * (k * b + (u * (k * b) + T))) by (apply Rmult_le_compat_l;
      lra). 
    assert (Rabs (p * s' - k * c' * s') <= u * (k * b) + T) by (apply Rabs_le; lra). rewrite u_val in *. lra. }
  assert (F3 : Rabs (q * l - k * c' * s' * l) <= ((2 + / 1000) * u * (k * b) + (2 + / 1000) * T) * l).
  { replace (q * l - k * c' * s' * l) with ((q - k * c' * s') * l) by ring. rewrite Rabs_mult, (Rabs_pos_eq l) by lra.
    apply Rmult_le_compat_r; lra. }
  assert (q1 : q <= (1 + 3 * u) * (k * b) + 3 * T) by (apply Rabs_le_inv in F2; rewrite u_val in *; lra).
  assert (ql : q * l <= ((1 + 3 * u) * (k * b) + 3 * T) * l) by (apply Rmult_le_compat_r; lra).
  (* exact numbers *)
  assert (F4 : Rabs (k * c' * s' * l - k * c * s * l) <= k * l * (b * ce + se)).
  { replace (k * c' * s' * l - k * c * s * l) with (k * l * ((c' - c) * s' + c * (s' - s))) by ring. rewrite
    Rabs_mult, (Rabs_pos_eq (k * l)) by (apply Rmult_le_pos; lra).
    apply Rmult_le_compat_l; [apply Rmult_le_pos; lra|].
    apply Rabs_plus_le; rewrite Rabs_mult; [rewrite (Rabs_pos_eq s') by lra | rewrite (Rabs_pos_eq c) by lra].
    - pose proof (Rabs_pos (c' - c)). rewrite Rmult_comm. apply Rmult_le_compat; lra.
    - pose proof (Rabs_pos (s' - s)). rewrite <- (Rmult_1_l se). apply Rmult_le_compat; lra. }
  replace (r - k * c * s * l) with ((r - q * l) + (q * l - k * c' * s' * l) + (k * c' * s' * l - k * c * s * l)) by
    ring.
  eapply Rle_trans; [apply Rabs_plus_le; [apply Rabs_plus_le; [exact E3 | exact F3] | exact F4]|]. unfold
    DIFFUSE_ROUNDING.
  assert (Tl : T * l <= T * 1) by (apply Rmult_le_compat_l; lra). assert (0 <= T * l) by (apply Rmult_le_pos; lra).
  assert (U1 : u * (q * l) <= u * (((1 + 3 * u) * (k * b) + 3 * T) * l)) by (apply Rmult_le_compat_l; lra).
  replace (((1 + 3 * u) * (k * b) + 3 * T) * l) with ((1 + 3 * u) * (k * b * l) + 3 * (T * l)) in U1 by ring.
  replace (((2 + / 1000) * u * (k * b) + (2 + / 1000) * T) * l) with ((2 + / 1000) * u * (k * b * l) + (2 + / 1000) *
    (T * l)) by ring.
  replace (k * l * (b * (ce + (1 - 8 * u) * (31 / 10 * u)) + se)) with (k * l * (b * ce + se) + (1 - 8 * u) * (31 /
    10) * u * (k * b * l)) by ring.
  assert (0 <= k * b * l) by (apply Rmult_le_pos; lra). set (y := k * b * l) in *. set (t := T * l) in *. set (w := u
    * (q * l)) in *.
  clear - U1 Tl H0 H1 T0. rewrite u_val in *. lra.
Qed.

(* ---- The sum of terms that are not negative: every partial sum is at most the last. ---- *)
Fixpoint summed s terms := match terms with nil => s | a :: rest => summed (RN (s + a)) rest end.
Fixpoint total (terms : list R) := match terms with nil => 0 | a :: rest => a + total rest end.
Lemma summed_grows : forall terms s, F s -> (forall a, In a terms -> F a /\ 0 <= a) -> s <= summed s terms.
Proof.
  induction terms as [|a rest IH]; intros s Fs H; [simpl; lra|]. simpl. destruct (H a (or_introl eq_refl)) as [Fa a0].
  apply Rle_trans with (RN (s + a)).
  - rewrite <- (RN_id s Fs) at 1. apply RN_le. lra.
  - apply IH; [apply RN_F | intros; apply H; now right].
Qed.
Lemma summed_error : forall terms s, F s -> 0 <= s -> (forall a, In a terms -> F a /\ 0 <= a) ->
  Rabs (summed s terms - (s + total terms)) <= INR (length terms) * (u * summed s terms).
Proof.
  induction terms as [|a rest IH]; intros s Fs s0 H.
  - simpl. replace (s - (s + 0)) with 0 by ring. rewrite Rabs_R0. lra.
  - destruct (H a (or_introl eq_refl)) as [Fa a0]. change (summed s (a :: rest)) with (summed (RN (s + a)) rest).
    assert (R0 : 0 <= RN (s + a)) by (rewrite <- RN_0; apply RN_le; lra).
    assert (Hr : forall b, In b rest -> F b /\ 0 <= b) by (intros; apply H; now right).
    pose proof (IH (RN (s + a)) (RN_F _) R0 Hr) as E. pose proof (summed_grows rest (RN (s + a)) (RN_F _) Hr) as G.
      set (t := summed (RN (s + a)) rest) in *.
    destruct (two_sum_error_le s a Fs Fa) as [_ P]. pose proof (two_sum s a Fs Fa) as TS. rewrite (Rabs_pos_eq (RN (s
      + a))) in P by assumption.
    change (total (a :: rest)) with (a + total rest). replace (length (a :: rest)) with (S (length rest)) by
      reflexivity. rewrite S_INR.
    replace (t - (s + (a + total rest))) with ((t - (RN (s + a) + total rest)) - two_sum_error s a) by lra.
    eapply Rle_trans; [apply Rabs_minus_le; [exact E | exact P]|]. assert (u * RN (s + a) <= u * t) by (apply
      Rmult_le_compat_l; [apply Rlt_le, u_pos | assumption]). lra.
Qed.
(* The ambient term, rounded once, and for each light a diffuse and a specular one, the latter rounded twice more. *)
Theorem SUM_ROUNDINGS_holds : forall lights ambient terms exact_ambient exact_terms, F ambient -> 0 <= ambient ->
  (length terms <= 2 * lights)%nat ->
  (forall a, In a terms -> F a /\ 0 <= a) -> (INR lights <= 1000000000000) ->
  Rabs (ambient - exact_ambient) <= u * ambient + bp (-1075) -> Rabs (total terms - exact_terms) <= (2 + / 1000) * u *
    total terms + bp (-1060) ->
  let s := summed ambient terms in
  Rabs (s - (exact_ambient + exact_terms)) <= (1 - 8 * u) * ((2 * INR lights + SUM_ROUNDINGS) * u * s + UNDERFLOW).
Proof.
  intros lights ambient terms ea et Fa A0 Len H Few Ha Ht s. pose proof (summed_error terms ambient Fa A0 H) as E.
    fold s in E.
  pose proof (summed_grows terms ambient Fa H) as G. fold s in G. pose proof u_pos. apply le_INR in Len. rewrite
    mult_INR in Len. simpl (INR 2) in Len.
  set (n := INR lights) in *. set (k := INR (length terms)) in *. assert (s0 : 0 <= s) by lra. assert (0 <= u * s) by
    (apply Rmult_le_pos; lra).
  assert (K : k * (u * s) <= 2 * n * (u * s)) by (apply Rmult_le_compat_r; lra). assert (n0 : 0 <= n) by apply pos_INR.
  assert (N : 2 * n * (u * s) <= / 1000 * s).
  { replace (2 * n * (u * s)) with (2 * (n * u) * s) by ring. apply Rmult_le_compat_r; [assumption|]. rewrite u_val.
    lra. }
  assert (T : total terms <= (1 + / 1000) * s) by (apply Rabs_le_inv in E; lra).
  assert (U1 : bp (-1075) <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; lia). assert (U2 : bp (-1060) <= / 4096
    * UNDERFLOW).
  { apply Rle_trans with (bp (-12) * UNDERFLOW); [unfold UNDERFLOW; rewrite <- bp_add; apply bp_le; lia | apply
    Rmult_le_compat_r; [apply Rlt_le, bp_pos | simpl; lra]]. }
  assert (U0 : 0 < UNDERFLOW) by apply bp_pos.
  replace (s - (ea + et)) with ((s - (ambient + total terms)) + (ambient - ea) + (total terms - et)) by ring.
  eapply Rle_trans; [apply Rabs_plus_le; [apply Rabs_plus_le; [exact E | exact Ha] | exact Ht]|]. unfold SUM_ROUNDINGS.
  replace ((2 * n + 5) * u * s) with (2 * n * (u * s) + 5 * (u * s)) by ring.
  assert (u * ambient <= u * s) by (apply Rmult_le_compat_l; lra). assert (u * total terms <= u * ((1 + / 1000) * s))
    by (apply Rmult_le_compat_l; lra).
  set (x := 2 * n * (u * s)) in *. set (y := u * s) in *. assert (8 * u * x <= / 100 * y) by (replace (8 * u * x) with
    (x * (8 * u)) by ring;
    replace (/ 100 * y) with (/ 1000 * s * (10 * u)) by (unfold y; field); apply Rle_trans with (/ 1000 * s * (8 *
      u)); [apply Rmult_le_compat_r; lra|];
    apply Rmult_le_compat_l; lra).
  set (w := u * total terms) in *. set (v := u * ambient) in *. replace (u * ((1 + / 1000) * s)) with ((1 + / 1000) *
    y) in H3 by (unfold y; ring).
  replace ((2 + / 1000) * u * total terms) with ((2 + / 1000) * w) by (unfold w; ring).
  clear - K H1 H2 H3 H4 U0 U1 U2. replace ((1 - 8 * u) * (x + 5 * y + UNDERFLOW)) with (x - 8 * u * x + (1 - 8 * u) *
    (5 * y + UNDERFLOW)) by ring.
  set (z := 8 * u * x) in *. rewrite u_val. lra.
Qed.
(* What underflows in four products is below a part of 10^12 of UNDERFLOW. *)
Theorem UNDERFLOW_holds : 4 * bp (-1075) <= / 1000000000000 * UNDERFLOW.
Proof.
  replace (4 * bp (-1075)) with (bp (-1073)); [apply bp_part12; lia|]. change (-1073)%Z with (2 + -1075)%Z. rewrite
    bp_add. simpl (bp 2). lra.
Qed.
