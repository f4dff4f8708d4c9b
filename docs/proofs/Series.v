(* rt-shade, certified/mod.rs and certified/power.rs: what the series leave out. *)
From Proofs Require Import Rounding.
From Coq Require Import Ratan Rpower MVT Ranalysis1 Machin.
Open Scope R_scope.

(* Half-angle steps of N limbs: this and the root of N. *)
Definition STEPS := 4%Z.
(* The limbs of the constants. *)
Definition LONGEST := 33%Z.
(* Halvings of the argument of the exponential function: this and the root of 4 N. *)
Definition EXP_STEPS := 3%Z.
(* What is below LOWEST has an exponential function below 2^LEAST. *)
Definition LOWEST := -14000.
Definition LEAST := (-20000)%Z.

(* ---- A function that grows from 0 ---- *)
Lemma grows : forall f f' t, 0 <= t -> f 0 = 0 -> (forall c, 0 <= c <= t -> derivable_pt_lim f c (f' c)) ->
  (forall c, 0 <= c <= t -> 0 <= f' c) -> 0 <= f t.
Proof.
  intros f f' t T0 F0 D P. destruct T0 as [T0|T0]; [|rewrite <- T0; lra].
  destruct (MVT_cor2 f f' 0 t T0 D) as (c & E & C). specialize (P c ltac:(lra)). rewrite F0 in E.
  assert (0 <= f' c * (t - 0)) by (apply Rmult_le_pos; lra). lra.
Qed.
(* A function whose derivative is at most K c^n in magnitude. *)
Lemma bounded_growth : forall f f' K n t, 0 <= t -> f 0 = 0 -> (forall c, 0 <= c <= t -> derivable_pt_lim f c (f' c)) ->
  (forall c, 0 <= c <= t -> Rabs (f' c) <= K * c ^ n) -> Rabs (f t) <= K * (t ^ S n / INR (S n)).
Proof.
  intros f f' K n t T0 F0 D B. assert (N0 : 0 < INR (S n)) by (apply lt_0_INR; lia).
  assert (DP : forall c, derivable_pt_lim (fun x => K * (x ^ S n / INR (S n))) c (K * c ^ n)).
  { intro c. replace (K * c ^ n) with (K * (/ INR (S n) * (INR (S n) * c ^ Nat.pred (S n)))) by (simpl Nat.pred;
    field; lra).
    replace (fun x => K * (x ^ S n / INR (S n))) with (mult_real_fct K (mult_real_fct (/ INR (S n)) (fun x => x ^ S n)))
      by (unfold mult_real_fct; apply FunctionalExtensionality.functional_extensionality; intro; field; lra).
    apply derivable_pt_lim_scal, derivable_pt_lim_scal, derivable_pt_lim_pow. }
  assert (P0 : K * (0 ^ S n / INR (S n)) = 0) by (rewrite pow_i by lia; field; lra).
  apply Rabs_le. split.
  - assert (0 <= (fun x => K * (x ^ S n / INR (S n)) + f x) t); [|cbv beta in *; lra].
    apply (grows (fun x => K * (x ^ S n / INR (S n)) + f x) (fun c => K * c ^ n + f' c) t T0); [lra | |].
    + intros c C. apply derivable_pt_lim_plus with (f1 := fun x => K * (x ^ S n / INR (S n))); auto.
    + intros c C. specialize (B c C). apply Rabs_le_inv in B. lra.
  - assert (0 <= (fun x => K * (x ^ S n / INR (S n)) - f x) t); [|cbv beta in *; lra].
    apply (grows (fun x => K * (x ^ S n / INR (S n)) - f x) (fun c => K * c ^ n - f' c) t T0); [lra | |].
    + intros c C. apply derivable_pt_lim_minus with (f1 := fun x => K * (x ^ S n / INR (S n))); auto.
    + intros c C. specialize (B c C). apply Rabs_le_inv in B. lra.
Qed.

(* ---- Arc tangent (s = -1) and inverse hyperbolic tangent (s = 1): t + s t^3/3 + t^5/5 + s t^7/7 + ... ---- *)
Fixpoint series s n t := match n with O => 0 | S n => series s n t + s ^ n * (t ^ S (2 * n) / INR (S (2 * n))) end.
Fixpoint slope s n t := match n with O => 0 | S n => slope s n t + s ^ n * t ^ (2 * n) end.
Lemma series_slope : forall s n t, derivable_pt_lim (series s n) t (slope s n t).
Proof.
  intros s n t. induction n as [|n IH]; [apply derivable_pt_lim_const|].
  assert (N0 : 0 < INR (S (2 * n))) by (apply lt_0_INR; lia). cbn [slope].
  apply derivable_pt_lim_plus with (f1 := series s n) (f2 := fun t => s ^ n * (t ^ S (2 * n) / INR (S (2 * n))));
    [exact IH|].
  replace (s ^ n * t ^ (2 * n)) with (s ^ n * (/ INR (S (2 * n)) * (INR (S (2 * n)) * t ^ Nat.pred (S (2 * n))))) by
    (change (Nat.pred (S (2 * n))) with (2 * n)%nat; field; lra).
  replace (fun t => s ^ n * (t ^ S (2 * n) / INR (S (2 * n)))) with (mult_real_fct (s ^ n) (mult_real_fct (/ INR (S (2
    * n)))
    (fun x => x ^ S (2 * n)))) by (unfold mult_real_fct; apply FunctionalExtensionality.functional_extensionality;
      intro; field; lra).
  apply derivable_pt_lim_scal, derivable_pt_lim_scal, derivable_pt_lim_pow.
Qed.
Lemma series_0 : forall s n, series s n 0 = 0.
Proof.
  intros s n. induction n as [|n IH]; [reflexivity|]. cbn [series]. rewrite IH, pow_i by lia.
  assert (0 < INR (S (2 * n))) by (apply lt_0_INR; lia). field. lra.
Qed.
Lemma slope_sum : forall s n t, slope s n t * (1 - s * (t * t)) = 1 - s ^ n * t ^ (2 * n).
Proof.
  intros s n t. induction n as [|n IH]; [simpl; ring|]. cbn [slope]. rewrite Rmult_plus_distr_r, IH.
  replace (2 * S n)%nat with (S (S (2 * n))) by lia. cbn [pow]. ring.
Qed.
Theorem series_rest : forall s f n t d, s = 1 \/ s = - 1 -> 0 <= t -> 0 < d -> f 0 = 0 ->
  (forall c, 0 <= c <= t -> d <= 1 - s * (c * c) /\ derivable_pt_lim f c (/ (1 - s * (c * c)))) ->
  Rabs (f t - series s n t) <= / d * (t ^ S (2 * n) / INR (S (2 * n))).
Proof.
  intros s f n t d Hs T0 D0 F0 H.
  apply (bounded_growth (fun x => f x - series s n x) (fun c => / (1 - s * (c * c)) - slope s n c)); [assumption | | |].
  - rewrite F0, series_0. ring.
  - intros c C. apply derivable_pt_lim_minus with (f1 := f); [apply H; assumption | apply series_slope].
  - intros c C. destruct (H c C) as [L _]. pose proof (slope_sum s n c) as E. set (w := 1 - s * (c * c)) in *.
    replace (/ w - slope s n c) with (s ^ n * c ^ (2 * n) * / w) by (replace (s ^ n * c ^ (2 * n)) with (1 - slope s n
      c * w) by lra;
      field; lra).
    rewrite !Rabs_mult, Rabs_inv, (Rabs_pos_eq w) by lra. assert (SN : Rabs (s ^ n) = 1).
    { rewrite <- RPow_abs. replace (Rabs s) with 1 by (destruct Hs as [E1|E1]; rewrite E1;
      [now rewrite Rabs_R1 | rewrite Rabs_left; lra]).
      apply pow1. }
    rewrite SN, (Rabs_pos_eq (c ^ _)) by (apply pow_le; lra). rewrite Rmult_1_l, Rmult_comm.
    apply Rmult_le_compat_r; [apply pow_le; lra | now apply Rinv_le_contravar].
Qed.
Theorem arctangent_rest : forall n t, 0 <= t -> Rabs (atan t - series (- 1) n t) <= t ^ S (2 * n) / INR (S (2 * n)).
Proof.
  intros n t T0. rewrite <- (Rmult_1_l (t ^ _ / _)). rewrite <- Rinv_1 at 1.
  apply series_rest; auto; [lra | apply atan_0|].
  intros c C. pose proof (sq_pos c). split; [lra|].
  replace (/ (1 - -1 * (c * c))) with (/ (1 + c ^ 2)) by (f_equal; simpl; ring).
  apply derivable_pt_lim_atan.
Qed.
Definition artanh t := / 2 * (ln (1 + t) - ln (1 - t)).
Lemma artanh_slope : forall c, - 1 < c < 1 -> derivable_pt_lim artanh c (/ (1 - 1 * (c * c))).
Proof.
  intros c C. replace (/ (1 - 1 * (c * c))) with (/ 2 * (/ (1 + c) * (0 + 1) - / (1 - c) * (0 - 1))) by (field; nra).
  change artanh with (mult_real_fct (/ 2) (fun t => ln (1 + t) - ln (1 - t))). apply derivable_pt_lim_scal.
  apply derivable_pt_lim_minus with (f1 := fun t => ln (1 + t)) (f2 := fun t => ln (1 - t)).
  - apply (derivable_pt_lim_comp (fun t => 1 + t) ln); [|apply derivable_pt_lim_ln; lra].
    apply derivable_pt_lim_plus with (f1 := fct_cte 1) (f2 := id);
      [apply derivable_pt_lim_const | apply derivable_pt_lim_id].
  - apply (derivable_pt_lim_comp (fun t => 1 - t) ln); [|apply derivable_pt_lim_ln; lra].
    apply derivable_pt_lim_minus with (f1 := fct_cte 1) (f2 := id);
      [apply derivable_pt_lim_const | apply derivable_pt_lim_id].
Qed.
Theorem hyperbolic_rest : forall n t, 0 <= t <= / 2 -> Rabs (artanh t - series 1 n t) <= 4 / 3 * (t ^ S (2 * n) / INR
  (S (2 * n))).
Proof.
  intros n t T0. replace (4 / 3) with (/ (3 / 4)) by field. apply series_rest; [now left | lra | lra | |].
  - unfold artanh. rewrite Rplus_0_r, Rminus_0_r, ln_1. ring.
  - intros c C. split; [nra|]. apply artanh_slope. lra.
Qed.

(* After n terms at most t 2^-b is left out, where t is at most 2^-j and 2 n j is at least b. *)
Lemma power_small : forall t j n b, 0 <= t <= bp (- j) -> (b <= 2 * Z.of_nat n * j)%Z -> t ^ (2 * n) <= bp (- b).
Proof.
  intros t j n b T B. apply Rle_trans with (bp (- j) ^ (2 * n)); [apply pow_incr; lra|].
  assert (P : forall m, bp (- j) ^ m = bp (- (Z.of_nat m * j))).
  { induction m; [reflexivity|]. cbn [pow]. rewrite IHm, <- bp_add. f_equal. lia. }
  rewrite P. apply bp_le. lia.
Qed.
Lemma rests_small : forall t j n b, (1 <= j)%Z -> (1 <= b)%Z -> 0 <= t <= bp (- j) -> (b <= 2 * Z.of_nat n * j)%Z ->
  Rabs (atan t - series (- 1) n t) <= t * bp (- b) /\ Rabs (artanh t - series 1 n t) <= t * bp (- b).
Proof.
  intros t j n b J B T H. pose proof (power_small t j n b T H) as P. pose proof (bp_pos (- b)) as B0.
  assert (t12 : t <= / 2) by (apply Rle_trans with (1 := proj2 T); apply Rle_trans with (bp (-1)); [apply bp_le;
    lia | simpl; lra]).
  assert (N1 : (1 <= n)%nat) by nia. assert (I : 3 <= INR (S (2 * n))).
  { replace 3 with (INR 3) by (simpl; lra). apply le_INR. lia. }
  assert (X : 4 / 3 * (t ^ S (2 * n) / INR (S (2 * n))) <= t * bp (- b)).
  { cbn [pow]. assert (Q : 0 <= t ^ (2 * n)) by (apply pow_le; lra). assert (Y : t * t ^ (2 * n) <= t * bp (- b)) by
      (apply Rmult_le_compat_l; lra).
    apply Rmult_le_reg_r with (INR (S (2 * n))); [lra|]. unfold Rdiv.
    replace (4 * / 3 * (t * t ^ (2 * n) * / INR (S (2 * n))) * INR (S (2 * n))) with (4 / 3 * (t * t ^ (2 * n))) by
      (field; lra).
    assert (0 <= t * bp (- b)) by (apply Rmult_le_pos; lra). nra. }
  assert (Z0 : 0 <= t ^ S (2 * n) / INR (S (2 * n))) by (unfold Rdiv; apply Rmult_le_pos; [apply pow_le;
    lra | apply Rlt_le,
    Rinv_0_lt_compat; lra]).
  split; [pose proof (arctangent_rest n t ltac:(lra)) | pose proof (hyperbolic_rest n t ltac:(lra))]; lra.
Qed.
Theorem STEPS_holds : forall N n t, (1 <= N)%Z -> let k := (STEPS
  + Z.sqrt N)%Z in (64 * N <= 2 * Z.of_nat n * (k - 1))%Z ->
  0 <= t <= bp (1 - k) ->
  Rabs (atan t - series (- 1) n t) <= t * bp (- (64 * N)) /\ Rabs (artanh t - series 1 n t) <= t * bp (- (64 * N)).
Proof.
  intros N n t HN k H T. pose proof (Z.sqrt_nonneg N). unfold STEPS in *.
  apply (rests_small t (k - 1)); try (unfold k; lia).
  replace (- (k - 1))%Z with (1 - k)%Z by ring. exact T.
Qed.
(* The constants: the series of 1/m with 64 LONGEST / 4 terms. *)
Theorem LONGEST_holds : forall m, 4 <= m -> let n := Z.to_nat (64 * LONGEST / 4) in
  Rabs (atan (/ m) - series (- 1) n (/ m)) <= / m * bp (- (64 * LONGEST)) /\
  Rabs (artanh (/ m) - series 1 n (/ m)) <= / m * bp (- (64 * LONGEST)).
Proof.
  intros m M n. apply (rests_small (/ m) 2); try (unfold LONGEST; lia).
  - split; [apply Rlt_le, Rinv_0_lt_compat; lra|]. simpl (bp _). apply Rinv_le_contravar; lra.
  - unfold n, LONGEST. rewrite Z2Nat.id; [reflexivity | discriminate].
Qed.
Theorem pi_by_arctangents : PI = 16 * atan (/ 5) - 4 * atan (/ 239).
Proof. pose proof Machin_4_5_239 as M. replace (1 / 5) with (/ 5) in M by lra.
replace (1 / 239) with (/ 239) in M by lra. lra. Qed.
Lemma artanh_inverse : forall m, 1 < m -> artanh (/ m) = / 2 * ln ((m + 1) / (m - 1)).
Proof.
  intros m M. assert (I : 0 < / m) by (apply Rinv_0_lt_compat; lra). unfold artanh, Rdiv.
  replace (1 + / m) with ((m + 1) * / m) by (field; lra). replace (1 - / m) with ((m - 1) * / m) by (field; lra).
  rewrite !ln_mult by (try assumption; try apply Rinv_0_lt_compat; lra). rewrite !ln_Rinv by lra. ring.
Qed.
Theorem ln_2_by_tangents : ln 2 = 18 * artanh (/ 26) - 2 * artanh (/ 4801) + 8 * artanh (/ 8749).
Proof.
  rewrite !artanh_inverse by lra. replace ((26 + 1) / (26 - 1)) with (27 / 25) by field.
  replace ((4801 + 1) / (4801 - 1)) with (2401 / 2400) by field.
  replace ((8749 + 1) / (8749 - 1)) with (4375 / 4374) by field.
  assert (A : ln ((27 / 25) ^ 9) = 9 * ln (27 / 25)) by (rewrite ln_pow by lra; f_equal; simpl; lra).
  assert (B : ln ((4375 / 4374) ^ 4) = 4 * ln (4375 / 4374)) by (rewrite ln_pow by lra; f_equal; simpl; lra).
  assert (C : ln (2 * (2401 / 2400)) = ln 2 + ln (2401 / 2400)) by (apply ln_mult; lra).
  assert (D : ln ((27 / 25) ^ 9 * (4375 / 4374) ^ 4) = ln ((27 / 25) ^ 9) + ln ((4375 / 4374) ^ 4)) by (apply ln_mult;
    apply
    pow_lt; lra).
  assert (E : (27 / 25) ^ 9 * (4375 / 4374) ^ 4 = 2 * (2401 / 2400)) by field. rewrite E in D. lra.
Qed.

(* ---- The exponential function: s = 1 or -1 is the sign of the argument ---- *)
Fixpoint taylor s n x := match n with O => 0 | S n => taylor s n x + s ^ n * (x ^ n / INR (fact n)) end.
Lemma fact_pos : forall n, 0 < INR (fact n). Proof. intro. apply lt_0_INR, lt_O_fact. Qed.
Lemma taylor_0 : forall s n, taylor s (S n) 0 = 1.
Proof.
  intros s n. induction n as [|n IH]; [simpl; field|]. cbn [taylor] in *. rewrite IH, pow_i by lia.
  pose proof (fact_pos (S n)).
  field. lra.
Qed.
Lemma taylor_slope : forall s n x, derivable_pt_lim (taylor s (S n)) x (s * taylor s n x).
Proof.
  intros s n x. induction n as [|n IH].
  - cbn [taylor]. rewrite Rmult_0_r. replace (fun x => 0 + s ^ 0 * (x ^ 0 / INR (fact 0))) with (fct_cte 1) by
      (apply FunctionalExtensionality.functional_extensionality; intro; unfold fct_cte; simpl; field).
      apply derivable_pt_lim_const.
  - change (taylor s (S (S n))) with (fun x => taylor s (S n) x + s ^ S n * (x ^ S n / INR (fact (S n)))).
    cbn [taylor] in IH |- *. pose proof (fact_pos n) as F0. pose proof (fact_pos (S n)) as F1.
    assert (N0 : 0 < INR (S n)) by (apply lt_0_INR; lia).
    assert (FE : INR (fact (S n)) = INR (S n) * INR (fact n)) by (rewrite <- mult_INR; reflexivity).
    rewrite Rmult_plus_distr_l. apply derivable_pt_lim_plus with (f1 := fun x => taylor s n x
      + s ^ n * (x ^ n / INR (fact n)))
      (f2 := fun x => s ^ S n * (x ^ S n / INR (fact (S n)))); [exact IH|].
    replace (s * (s ^ n * (x ^ n / INR (fact n)))) with (s ^ S n * (/ INR (fact (S n)) * (INR (S n) * x ^ Nat.pred (S
      n)))).
    + replace (fun x => s ^ S n * (x ^ S n / INR (fact (S n)))) with (mult_real_fct (s ^ S n) (mult_real_fct (/ INR
      (fact (S n)))
        (fun x => x ^ S n))) by (unfold mult_real_fct; apply FunctionalExtensionality.functional_extensionality;
          intro; field; lra).
      apply derivable_pt_lim_scal, derivable_pt_lim_scal, derivable_pt_lim_pow.
    + rewrite FE. cbn [Nat.pred pow]. field. lra.
Qed.
Lemma exp_half : forall s c, s = 1 \/ s = - 1 -> 0 <= c <= / 2 -> Rabs (exp (s * c)) <= 2.
Proof.
  intros s c Hs C. rewrite Rabs_pos_eq by (apply Rlt_le, exp_pos). apply Rle_trans with (exp (/ 2)).
  - destruct (Req_dec (s * c) (/ 2)) as [E|E]; [rewrite E; lra|]. apply Rlt_le, exp_increasing. destruct Hs; subst; lra.
  - apply below_root; [lra|]. rewrite <- exp_plus. replace (/ 2 + / 2) with 1 by field. pose proof exp_le_3. lra.
Qed.
Theorem exponential_rest : forall s n x, s = 1 \/ s = - 1 -> 0 <= x <= / 2 ->
  Rabs (exp (s * x) - taylor s n x) <= 2 * (x ^ n / INR (fact n)).
Proof.
  intros s n. induction n as [|n IH]; intros x Hs X.
  - simpl. replace (exp (s * x) - 0) with (exp (s * x)) by ring. pose proof (exp_half s x Hs X). lra.
  - pose proof (fact_pos n) as F0. assert (N0 : 0 < INR (S n)) by (apply lt_0_INR; lia).
    assert (FE : INR (fact (S n)) = INR (S n) * INR (fact n)) by (rewrite <- mult_INR; reflexivity).
    replace (2 * (x ^ S n / INR (fact (S n)))) with (2 / INR (fact n) * (x ^ S n / INR (S n))) by (rewrite FE; field;
      lra).
    apply (bounded_growth (fun x => exp (s * x) - taylor s (S n) x) (fun c => exp (s * c) * (s * 1) - s * taylor s n
      c)); [lra | | |].
    + rewrite taylor_0, Rmult_0_r, exp_0. ring.
    + intros c C. apply derivable_pt_lim_minus with (f1 := fun x => exp (s * x)).
      * apply (derivable_pt_lim_comp (fun x => s * x) exp); [|apply derivable_pt_lim_exp].
        apply (derivable_pt_lim_scal id s c 1), derivable_pt_lim_id.
      * apply taylor_slope.
    + intros c C. replace (exp (s * c) * (s * 1) - s * taylor s n c) with (s * (exp (s * c) - taylor s n c)) by ring.
      rewrite Rabs_mult. replace (Rabs s) with 1 by (destruct Hs as [E|E]; rewrite E;
        [now rewrite Rabs_R1 | rewrite Rabs_left; lra]).
      rewrite Rmult_1_l. replace (2 / INR (fact n) * c ^ n) with (2 * (c ^ n / INR (fact n))) by (field; lra).
      apply IH; [assumption | lra].
Qed.
(* the exponents that the terms are counted by *)
Fixpoint below k n := match n with O => 0 | S n => below k n + (k + 1 + Z.log2 (Z.of_nat (S n))) end%Z.
Lemma term_small : forall k n y, 0 <= y <= bp (- (1 + k)) -> y ^ n / INR (fact n) <= bp (- below k n).
Proof.
  intros k n y Y. induction n as [|n IH]; [simpl; lra|]. pose proof (fact_pos n) as F0.
  assert (N0 : 0 < INR (S n)) by (apply lt_0_INR; lia).
  assert (FE : INR (fact (S n)) = INR (S n) * INR (fact n)) by (rewrite <- mult_INR; reflexivity).
  replace (y ^ S n / INR (fact (S n))) with (y ^ n / INR (fact n) * (y * / INR (S n))) by (rewrite FE; cbn [pow];
    field; lra).
  cbn [below]. replace (- (below k n + (k + 1 + Z.log2 (Z.of_nat (S n)))))%Z with (- below k n + (- (1 + k)
    + - Z.log2 (Z.of_nat
    (S n))))%Z by ring. rewrite !bp_add.
  assert (L : / INR (S n) <= bp (- Z.log2 (Z.of_nat (S n)))).
  { rewrite bpow_opp. apply Rinv_le_contravar; [apply bp_pos|].
  rewrite INR_IZR_INZ, <- IZR_Zpower by apply Z.log2_nonneg.
    apply IZR_le. apply Z.log2_spec. lia. }
  assert (I0 : 0 <= / INR (S n)) by (apply Rlt_le, Rinv_0_lt_compat; assumption).
  apply mul2; split; try assumption.
  - unfold Rdiv. apply Rmult_le_pos; [apply pow_le; lra | apply Rlt_le, Rinv_0_lt_compat; assumption].
  - apply Rmult_le_pos; lra.
  - apply Rmult_le_compat; lra.
Qed.
Theorem EXP_STEPS_holds : forall N n s y,
  (1 <= N)%Z -> let k := (EXP_STEPS + Z.sqrt (4 * N))%Z in (64 * N <= below k n)%Z ->
  s = 1 \/ s = - 1 -> 0 <= y <= bp (- (1 + k)) -> Rabs (exp (s * y) - taylor s n y) <= bp (1 - 64 * N).
Proof.
  intros N n s y HN k H Hs Y. pose proof (Z.sqrt_nonneg (4 * N)). unfold EXP_STEPS in *.
  assert (y <= / 2) by (apply Rle_trans with (1 := proj2 Y); apply Rle_trans with (bp (-1)); [apply bp_le; unfold k;
    lia | simpl; lra]).
  eapply Rle_trans; [apply exponential_rest; [assumption | lra]|].
  replace (1 - 64 * N)%Z with (1 + - (64 * N))%Z by ring.
  rewrite bp_add, bp_1.
  apply Rmult_le_compat_l; [lra|]. apply Rle_trans with (1 := term_small k n y Y). apply bp_le. lia.
Qed.
(* exp(-14000) is below 2^-20000, as e^7 exceeds 2^10. *)
Lemma exp_times : forall n x, exp (INR n * x) = exp x ^ n.
Proof.
  intros n x. induction n as [|n IH]; [simpl; rewrite Rmult_0_l; apply exp_0|].
  rewrite S_INR, Rmult_plus_distr_r, exp_plus, IH.
  cbn [pow]. rewrite Rmult_1_l. ring.
Qed.
Theorem LOWEST_holds : forall x, x < LOWEST -> exp x < bp LEAST.
Proof.
  intros x X. apply Rlt_trans with (exp LOWEST); [now apply exp_increasing|]. unfold LOWEST, LEAST.
  assert (E1 : 27 / 10 <= exp 1).
  { replace 1 with (INR 100 * / 100) by (rewrite INR_IZR_INZ; simpl Z.of_nat; lra). rewrite exp_times.
    apply Rle_trans with ((101 / 100) ^ 100); [lra|]. apply pow_incr. pose proof (exp_ineq1 (/ 100) ltac:(lra)). lra. }
  assert (E7 : 1024 < exp 7).
  { replace 7 with (INR 7 * 1) by (rewrite INR_IZR_INZ; simpl Z.of_nat; lra). rewrite exp_times.
    apply Rlt_le_trans with ((27 / 10) ^ 7); [lra|]. apply pow_incr. lra. }
  replace (-14000) with (- (INR 2000 * 7)) by (rewrite INR_IZR_INZ; simpl Z.of_nat; lra). rewrite exp_Ropp, exp_times.
  assert (P : bp 20000 = 1024 ^ 2000).
  { assert (Q : forall n, 1024 ^ n = bp (10 * Z.of_nat n)).
    { induction n as [|n IH]; [reflexivity|]. cbn [pow]. rewrite IH.
    replace (10 * Z.of_nat (S n))%Z with (10 + 10 * Z.of_nat n)%Z by lia.
      rewrite bp_add. f_equal. }
    rewrite Q. reflexivity. }
  change (-20000)%Z with (Z.opp 20000). rewrite bpow_opp, P. apply Rinv_lt_contravar.
  - apply Rmult_lt_0_compat; apply pow_lt; lra.
  - assert (L : forall n, 1024 ^ S n < exp 7 ^ S n).
    { induction n as [|n IH]; [simpl; lra|]. change (1024 * 1024 ^ S n < exp 7 * exp 7 ^ S n).
    apply Rmult_le_0_lt_compat; try lra.
      apply pow_le. lra. }
    exact (L 1999%nat).
Qed.
Theorem LEAST_holds : forall x, x < LOWEST -> 0 < exp x < bp LEAST.
Proof. intros x X. split; [apply exp_pos | now apply LOWEST_holds]. Qed.
