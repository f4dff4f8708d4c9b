(* rt-math, quadratic.rs: the roots in double-double, `double_double_roots`. *)
From Proofs Require Import Rounding ErrorFree DoubleDouble Steps Round.
Open Scope R_scope.

(* The error of a root, relative to itself: 64 u^2. *)
Definition DOUBLE_DOUBLE_ERROR := bp (-100).

Section Roots.
Variables a b c h l : R.
Let D := b * b - 4 * a * c.
Hypotheses (Fa : F (2 * a)) (Fb : F b) (Fc : F (2 * c)) (Ra : bp (-400) <= Rabs (2 * a) <= bp 400) (Rb : Rabs b <= bp
  257) (Rc : bp (-400) <= Rabs (2 * c) <= bp 400)
  (RD : bp (-616) <= D <= bp 515) (Dd : dd h l) (HD : Rabs (h + l - D) <= SUM * (u * u) * D).
(* the root of D, z = |b| + sqrt D, each with a correction *)
Let root := RN (sqrt h).
Let root_low := RN (RN (RN (h - root * root) + l) * RN (/ 2 / root)).
Let z := RN (Rabs b + root).
Let z_low := RN (two_sum_error (Rabs b) root + root_low).
Let zeta := Rabs b + sqrt D.

Lemma z_near : Rabs (z + z_low - zeta) <= (166 / 10) * (u * u) * z /\ Rabs z_low <= (262 / 100) * u * z /\ F z /\ bp
  (-310) <= z <= bp 260.
Proof.
  pose proof u_pos as up. pose proof (bp_pos (-616)) as P6. pose proof (dd_low _ _ Dd) as LL. unfold SUM in HD. pose
    proof HD as HD'. apply Rabs_le_inv in HD'.
  assert (h0 : 0 < h).
  { apply Rnot_le_lt. intro N. rewrite (Rabs_left1 h) in LL by assumption. apply Rabs_le_inv in LL. rewrite u_val in
    *. lra. }
  rewrite (Rabs_pos_eq h) in LL by lra. pose proof LL as LL'. apply Rabs_le_inv in LL'.
  assert (hD : (1 - 2 * u) * D <= h <= (1 + 2 * u) * D) by (rewrite u_val in *; lra).
  set (S := sqrt h) in *. assert (SS : S * S = h) by (apply sqrt_sqrt; lra). assert (S0 : 0 < S) by (apply sqrt_lt_R0;
    assumption).
  set (W := sqrt D) in *. assert (WW : W * W = D) by (apply sqrt_sqrt; lra). assert (W0 : 0 < W) by (apply sqrt_lt_R0;
    lra).
  assert (W1 : bp (-308) <= W) by (apply below_root; [lra|]; rewrite WW, bp_sq; exact (proj1 RD)).
  assert (W2 : W <= bp 258).
  { apply below_root; [apply Rlt_le, bp_pos|]. rewrite WW, bp_sq. apply Rle_trans with (bp 515); [lra | apply bp_le;
    lia]. }
  assert (SW : (1 - 2 * u) * W <= S <= (1 + 2 * u) * W).
  { split; apply below_root; try lra; try (apply Rmult_le_pos; rewrite ?u_val; lra).
    - replace ((1 - 2 * u) * W * ((1 - 2 * u) * W)) with ((1 - 2 * u) * (1 - 2 * u) * (W * W)) by ring. rewrite WW,
      SS. rewrite u_val in *. lra.
    - replace ((1 + 2 * u) * W * ((1 + 2 * u) * W)) with ((1 + 2 * u) * (1 + 2 * u) * (W * W)) by ring. rewrite WW,
      SS. rewrite u_val in *. lra. }
  assert (T3 : bp (-1075) <= / 1000000 * (u * u) * (bp (-310) * bp (-310))).
  { apply Rle_trans with (bp (-20) * (u * u) * (bp (-310) * bp (-310))); [unfold u; rewrite <- !bp_add; apply bp_le;
    lia|].
    apply Rmult_le_compat_r; [apply Rmult_le_pos; apply Rlt_le, bp_pos|]. apply Rmult_le_compat_r; [apply sq_pos |
      simpl; lra]. }
  pose proof (bp_pos (-1075)) as T0. pose proof (bp_pos (-310)) as P3.
  assert (F3 : bp (-308) = 4 * bp (-310)) by (change (-308)%Z with (2 + -310)%Z; rewrite bp_add; simpl (bp 2); lra).
  assert (S3 : bp (-310) <= S) by (rewrite u_val in *; lra).
  assert (one : bp (-310) <= 1) by (apply Rle_trans with (bp 0); [apply bp_le; lia | simpl; lra]).
  assert (TS : bp (-1075) <= / 1000000 * (u * u) * S).
  { eapply Rle_trans; [exact T3|]. apply Rmult_le_compat_l; [rewrite u_val; lra|]. rewrite <- (Rmult_1_l S). apply
    Rmult_le_compat; lra. }
  assert (TH : bp (-1075) <= / 1000000 * (u * u) * h).
  { eapply Rle_trans; [exact T3|]. apply Rmult_le_compat_l; [rewrite u_val; lra|]. rewrite <- SS. apply
    Rmult_le_compat; lra. }
  (* the rounded root *)
  assert (R1 : Rabs (root - S) <= u * S).
  { pose proof (RN_normal S) as N. rewrite (Rabs_pos_eq S) in N by lra. apply N. eapply Rle_trans; [|exact S3]. apply
    bp_le. lia. }
  pose proof R1 as R1'. apply Rabs_le_inv in R1'. assert (r0 : 0 < root) by (rewrite u_val in *; lra).
  assert (H1 : Rabs (h - root * root) <= (2 + / 1000) * u * h).
  { rewrite <- SS. replace (S * S - root * root) with (- (root - S) * (S + root)) by ring. replace ((2 + / 1000) * u *
    (S * S)) with (u * S * ((2 + / 1000) * S)) by ring.
    apply Rabs_mult_le; [now rewrite Rabs_Ropp | apply Rabs_le; rewrite u_val in *; lra]. }
  pose proof (RN_err (h - root * root)) as E1. set (rem := RN (h - root * root)) in *.
  assert (E1' : Rabs (rem - (h - root * root)) <= (2 + / 100) * (u * u) * h).
  { eapply Rle_trans; [exact E1|]. assert (u * Rabs (h - root * root) <= u * ((2 + / 1000) * u * h)) by (apply
    Rmult_le_compat_l; lra). rewrite u_val in *. lra. }
  pose proof (RN_sum rem l (RN_F _) (proj1 (proj2 Dd))) as E2. set (rest := RN (rem + l)) in *.
  assert (B2 : Rabs (rem + l) <= (3 + / 500) * u * h).
  { replace (rem + l) with ((rem - (h - root * root)) + (h - root * root) + l) by ring. eapply Rle_trans; [apply
    Rabs_plus_le; [apply Rabs_plus_le; [exact E1' | exact H1] | exact LL]|].
    rewrite u_val in *. lra. }
  set (M0 := h + l - root * root).
  assert (ER : Rabs (rest - (M0 - 0 * (2 * root))) <= (504 / 100) * (u * u) * h).
  { replace (rest - (M0 - 0 * (2 * root))) with ((rest - (rem + l)) + (rem - (h - root * root))) by (unfold M0; ring).
    eapply Rle_trans; [apply Rabs_plus_le; [exact E2 | exact E1']|].
    assert (u * Rabs (rem + l) <= u * ((3 + / 500) * u * h)) by (apply Rmult_le_compat_l; lra). rewrite u_val in *.
      lra. }
  assert (B0 : Rabs (M0 - 0 * (2 * root)) <= (3 + / 500) * u * h).
  { replace (M0 - 0 * (2 * root)) with ((h - root * root) + l) by (unfold M0; ring). eapply Rle_trans; [apply
    Rabs_plus_le; eassumption|]. rewrite u_val in *. lra. }
  (* its inverse *)
  set (inv := RN (/ 2 / root)) in *.
  assert (EI : Rabs (inv * (2 * root) - 1) <= (1 + / 1000) * u).
  { replace (inv * (2 * root) - 1) with ((inv - / 2 / root) * (2 * root)) by (field; lra). rewrite Rabs_mult,
    (Rabs_pos_eq (2 * root)) by lra. pose proof (RN_err (/ 2 / root)) as E. fold inv in E.
    assert (P : 0 < / 2 / root) by (apply Rmult_lt_0_compat; [lra | now apply Rinv_0_lt_compat]). rewrite (Rabs_pos_eq
      (/ 2 / root)) in E by lra.
    apply Rle_trans with ((u * (/ 2 / root) + bp (-1075)) * (2 * root)); [apply Rmult_le_compat_r; lra|].
    replace ((u * (/ 2 / root) + bp (-1075)) * (2 * root)) with (u + 2 * (bp (-1075) * root)) by (field; lra).
    assert (bp (-1075) * root <= / 4000 * u).
    { apply Rle_trans with (bp (-1075) * bp 260).
      - apply Rmult_le_compat_l; [lra|]. assert (bp 260 = 4 * bp 258) by (change 260%Z with (2 + 258)%Z; rewrite
        bp_add; simpl (bp 2); lra). rewrite u_val in *. lra.
      - apply Rle_trans with (bp (-12) * u); [unfold u; rewrite <- !bp_add; apply bp_le; lia | apply
        Rmult_le_compat_r; [lra | simpl; lra]]. }
    lra. }
  assert (RI : Rabs (rest * inv) <= (152 / 100) * u * S).
  { replace (rest * inv) with (rest / (2 * root) * (inv * (2 * root))) by (field; lra).
    assert (RB : Rabs rest <= (301 / 100) * u * h).
    { replace rest with ((rest - (M0 - 0 * (2 * root))) + (M0 - 0 * (2 * root))) by ring. eapply Rle_trans; [apply
      Rabs_plus_le; eassumption|]. rewrite u_val in *. lra. }
    assert (Q1 : Rabs (rest / (2 * root)) <= (1506 / 1000) * u * S).
    { apply Rabs_div_le; [lra|]. rewrite (Rabs_pos_eq (2 * root)) by lra. eapply Rle_trans; [exact RB|]. rewrite <- SS.
      replace (1506 / 1000 * u * S * (2 * root)) with (1506 / 1000 * 2 * u * S * root) by ring. replace (301 / 100 * u
        * (S * S)) with (301 / 100 * u * S * S) by ring.
      apply Rle_trans with (1506 / 1000 * 2 * u * S * ((1 - u) * S)).
      - assert (0 <= u * S * S) by (repeat apply Rmult_le_pos; lra). rewrite u_val in *. lra.
      - apply Rmult_le_compat_l; [repeat apply Rmult_le_pos; lra | lra]. }
    eapply Rle_trans; [apply (Rabs_mult_le _ _ (1506 / 1000 * u * S) (1 + / 1000)); [exact Q1 | apply Rabs_le_inv in
      EI; apply Rabs_le; rewrite u_val in *; lra]|].
    assert (0 <= u * S) by (apply Rmult_le_pos; lra). lra. }
  assert (EK : Rabs (root_low - rest * inv) <= (153 / 100) * (u * u) * S).
  { eapply Rle_trans; [apply RN_err|]. assert (u * Rabs (rest * inv) <= u * ((152 / 100) * u * S)) by (apply
    Rmult_le_compat_l; lra). rewrite u_val in *. lra. }
  pose proof (quotient_step M0 (2 * root) 0 rest inv root_low _ _ _ ltac:(lra) ER EI EK) as QS.
  assert (Q1 : Rabs (root_low - M0 / (2 * root)) <= (56 / 10) * (u * u) * S).
  { replace (root_low - M0 / (2 * root)) with (0 + root_low - M0 / (2 * root)) by ring. eapply Rle_trans; [exact QS|].
    rewrite (Rabs_pos_eq (2 * root)) by lra.
    assert (K : (504 / 100 * (u * u) * h * (1 + (1 + / 1000) * u) + Rabs (M0 - 0 * (2 * root)) * ((1 + / 1000) * u)) /
      (2 * root) <= (405 / 100) * (u * u) * S).
    { apply Rmult_le_reg_r with (2 * root); [lra|]. unfold Rdiv at 1. rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra.
      assert (Rabs (M0 - 0 * (2 * root)) * ((1 + / 1000) * u) <= (3 + / 500) * u * h * ((1 + / 1000) * u)) by (apply
        Rmult_le_compat_r; lra).
      apply Rle_trans with (405 / 100 * (u * u) * S * (2 * ((1 - u) * S))).
      - replace (405 / 100 * (u * u) * S * (2 * ((1 - u) * S))) with (405 / 100 * (u * u) * 2 * (1 - u) * (S * S)) by
        ring. rewrite SS. rewrite u_val in *. lra.
      - apply Rmult_le_compat_l; [repeat apply Rmult_le_pos; lra | lra]. }
    lra. }
  (* the exact root of h + l, and of D *)
  assert (V0 : 0 <= h + l) by (rewrite u_val in *; lra). pose proof (root_step (h + l) root V0 r0) as RS. set (V :=
    sqrt (h + l)) in *. assert (VV : V * V = h + l) by (apply sqrt_sqrt; assumption).
  assert (Vp : 0 <= V) by apply sqrt_pos.
  assert (VS : (1 - u) * S <= V <= (1 + u) * S).
  { split; apply below_root; try lra; try (apply Rmult_le_pos; rewrite ?u_val; lra).
    - replace ((1 - u) * S * ((1 - u) * S)) with ((1 - u) * (1 - u) * (S * S)) by ring. rewrite SS, VV. rewrite u_val
      in *. lra.
    - replace ((1 + u) * S * ((1 + u) * S)) with ((1 + u) * (1 + u) * (S * S)) by ring. rewrite SS, VV. rewrite u_val
      in *. lra. }
  assert (Q2 : Rabs (V - (root + M0 / (2 * root))) <= (201 / 100) * (u * u) * S).
  { unfold M0. rewrite RS, Rabs_Ropp. apply Rabs_div_le; [lra|]. rewrite (Rabs_pos_eq (2 * root)) by lra.
    apply Rle_trans with (2 * (u * S) * (2 * (u * S))); [apply Rabs_mult_le; apply Rabs_le; lra|].
    apply Rle_trans with (201 / 100 * (u * u) * S * (2 * ((1 - u) * S))).
    - replace (201 / 100 * (u * u) * S * (2 * ((1 - u) * S))) with (201 / 100 * 2 * (1 - u) * (u * u * (S * S))) by
      ring.
      replace (2 * (u * S) * (2 * (u * S))) with (4 * (u * u * (S * S))) by ring. apply Rmult_le_compat_r; [apply
        Rmult_le_pos; apply sq_pos | rewrite u_val; lra].
    - apply Rmult_le_compat_l; [repeat apply Rmult_le_pos; lra | lra]. }
  assert (Q3 : Rabs (W - V) <= 6 * (u * u) * W).
  { apply Rmult_le_reg_r with W; [assumption|]. eapply Rle_trans; [apply (root_near D (h + l) ltac:(lra) V0)|].
    rewrite Rabs_minus_sym. replace (6 * (u * u) * W * W) with (6 * (u * u) * (W * W)) by ring.
    rewrite WW. exact HD. }
  assert (Q4 : Rabs (root + root_low - W) <= (137 / 10) * (u * u) * W).
  { replace (root + root_low - W) with ((root_low - M0 / (2 * root)) - (V - (root + M0 / (2 * root))) - (W - V)) by
    ring.
    eapply Rle_trans; [apply Rabs_minus_le; [apply Rabs_minus_le; [exact Q1 | exact Q2] | exact Q3]|]. rewrite u_val
      in *. lra. }
  (* z *)
  assert (Fab : F (Rabs b)) by now apply generic_format_abs. pose proof (Rabs_pos b) as b0.
  destruct (two_sum_error_le (Rabs b) root Fab (RN_F _)) as [_ ZE]. pose proof (two_sum (Rabs b) root Fab (RN_F _)) as
    ZS. fold z in ZE, ZS.
  assert (z0 : root <= z) by (unfold z; rewrite <- (RN_id root (RN_F _)) at 1; apply RN_le; lra). rewrite (Rabs_pos_eq
    z) in ZE by lra.
  set (ze := two_sum_error (Rabs b) root) in *.
  assert (RLB : Rabs root_low <= (153 / 100) * u * S).
  { replace root_low with ((root_low - rest * inv) + rest * inv) by ring. eapply Rle_trans; [apply Rabs_plus_le;
    eassumption|]. rewrite u_val in *. lra. }
  assert (SZ : S <= (1 + 2 * u) * z) by (rewrite u_val in *; lra). assert (WZ : W <= (1 + 6 * u) * z) by (rewrite
    u_val in *; lra).
  pose proof (RN_sum ze root_low (two_sum_error_F _ _) (RN_F _)) as E4. fold z_low in E4.
  assert (B4 : Rabs (ze + root_low) <= (254 / 100) * u * z).
  { eapply Rle_trans; [apply Rabs_plus_le; [exact ZE | exact RLB]|]. rewrite u_val in *. lra. }
  assert (E4' : Rabs (z_low - (ze + root_low)) <= (254 / 100) * (u * u) * z).
  { eapply Rle_trans; [exact E4|]. assert (u * Rabs (ze + root_low) <= u * (254 / 100 * u * z)) by (apply
    Rmult_le_compat_l; lra). lra. }
  split; [|split; [|split; [apply RN_F|]]].
  - replace (z + z_low - zeta) with ((z_low - (ze + root_low)) + (root + root_low - W)) by (unfold zeta; fold W; lra).
    eapply Rle_trans; [apply Rabs_plus_le; eassumption|]. rewrite u_val in *. lra.
  - replace z_low with ((z_low - (ze + root_low)) + (ze + root_low)) by ring. eapply Rle_trans; [apply Rabs_plus_le;
    eassumption|]. rewrite u_val in *. lra.
  - split; [rewrite u_val in *; lra|]. apply Rabs_le_inv in ZE. assert (bp 260 = 8 * bp 257) by (change 260%Z with (3
    + 257)%Z; rewrite bp_add; simpl (bp 3); lra).
    assert (bp 258 = 2 * bp 257) by (change 258%Z with (1 + 257)%Z; rewrite bp_add, bp_1; ring). rewrite u_val in *.
      lra.
Qed.

(* the two quotients; the sign s is that of - b *)
Variable s : R.
Hypothesis Hs : s = 1 \/ s = -1.
Let one_root n m t := let inv := RN (1 / m) in let x := RN (n * inv) in (x, RN (RN (RN (n - x * m) + t) * inv)).
Theorem DOUBLE_DOUBLE_ERROR_holds : forall x k x' k' e e',
  (x, k) = one_root z (s * (2 * a)) z_low ->
  (forall t, t = RN (- (RN (s * (2 * c) * RN (1 / z)) * z_low)) -> (x', k') = one_root (s * (2 * c)) z t) ->
  F e -> F e' -> (1 - 8 * u) * (DOUBLE_DOUBLE_ERROR * Rabs x) <= e -> (1 - 8 * u) * (DOUBLE_DOUBLE_ERROR * Rabs x') <=
    e' ->
  (RN (x + RN (k - e)) = RN (x + RN (k + e)) -> RN (x + RN (k + e)) = RN (zeta / (s * (2 * a)))) /\
  (RN (x' + RN (k' - e')) = RN (x' + RN (k' + e')) -> RN (x' + RN (k' + e')) = RN (s * (2 * c) / zeta)).
Proof.
  intros x k x' k' e e' E1 E2 Fe Fe' He He'. destruct z_near as (ZN & ZL & Fz & Z1 & Z2). pose proof u_pos as up. pose
    proof (bp_pos (-310)) as P3. assert (z0 : 0 < z) by lra.
  assert (D100 : DOUBLE_DOUBLE_ERROR = 64 * (u * u)).
  { unfold DOUBLE_DOUBLE_ERROR, u. rewrite <- bp_add. change (-100)%Z with (6 + (-53 + -53))%Z. rewrite bp_add. simpl
    (bp 6). lra. }
  rewrite D100 in *. assert (As : forall y, Rabs (s * y) = Rabs y) by (intro y; rewrite Rabs_mult; destruct Hs as
    [G|G]; rewrite G; unfold Rabs at 1; destruct Rcase_abs; lra).
  assert (FS : forall y, F y -> F (s * y)) by (intros y Fy; destruct Hs as [G|G]; rewrite G; [now rewrite Rmult_1_l |
    replace (-1 * y) with (- y) by ring; now apply F_opp]).
  assert (Rz : bp (-400) <= Rabs z <= bp 400).
  { rewrite Rabs_pos_eq by lra. assert (bp (-400) <= bp (-310)) by (apply bp_le; lia). assert (bp 260 <= bp 400) by
    (apply bp_le; lia). lra. }
  assert (zp : 0 < zeta) by (pose proof ZN as Q; apply Rabs_le_inv in Q; apply Rabs_le_inv in ZL; rewrite u_val in *;
    lra).
  split; intro Same.
  - injection E1 as Ex Ek. pose proof (corrected z z_low (s * (2 * a)) 0 z_low (262 / 100 * u) 0 0 Fz (FS _ Fa) (RN_F
    _) Rz ltac:(rewrite As; exact Ra)
      ltac:(rewrite (Rabs_pos_eq z) by lra; exact ZL) ltac:(rewrite Rabs_R0, Rmult_0_l; lra) ltac:(rewrite u_val; lra)
        ltac:(lra) ltac:(lra)) as C. cbv zeta in C.
    rewrite <- Ex in *. rewrite <- Ek in C. specialize (C ltac:(replace (z_low - (z_low - x * 0)) with 0 by ring;
      rewrite Rabs_R0, Rmult_0_l; lra)). destruct C as (C1 & C2 & C3).
    set (m := s * (2 * a)) in *. assert (m0 : m <> 0) by (intro Z; assert (Rabs m = 0) by (rewrite Z; apply Rabs_R0);
      unfold m in H; rewrite As in H; pose proof (bp_pos (-400)); lra).
    set (q := Rabs (z / m)) in *. assert (q0 : 0 <= q) by apply Rabs_pos. rewrite Rplus_0_r in C1.
    assert (K1 : Rabs (x + k - (z + z_low) / m) <= 17 * (u * u) * q) by (eapply Rle_trans; [exact C1|]; apply
      Rmult_le_compat_r; [assumption|]; rewrite u_val; lra).
    assert (K2 : Rabs k <= 5 * u * q) by (eapply Rle_trans; [exact C2|]; apply Rmult_le_compat_r; [assumption|];
      rewrite u_val; lra).
    assert (K3 : Rabs ((z + z_low) / m - zeta / m) <= 166 / 10 * (u * u) * q).
    { replace ((z + z_low) / m - zeta / m) with ((z + z_low - zeta) / m) by (field; assumption). apply Rabs_div_le;
      [assumption|]. eapply Rle_trans; [exact ZN|].
      unfold q, Rdiv. rewrite Rabs_mult, Rabs_inv, (Rabs_pos_eq z) by lra. pose proof (Rabs_pos_lt m m0). apply
        Req_le. field. lra. }
    assert (e0 : 0 <= e) by (pose proof (Rabs_pos x); rewrite u_val in *; lra).
    apply (Round.round_if_certain (zeta / m) x k e); auto; try (rewrite Ex; apply RN_F); try (rewrite Ek; apply RN_F).
    replace (zeta / m - (x + k)) with (- ((x + k - (z + z_low) / m) + ((z + z_low) / m - zeta / m))) by ring. rewrite
      Rabs_Ropp.
    eapply Rle_trans; [apply Rabs_plus_le; [exact K1 | exact K3]|]. assert (X : 64 * (u * u) * ((1 - 3 * u) * q) <= 64
      * (u * u) * Rabs x) by (apply Rmult_le_compat_l; [rewrite u_val|]; lra).
    clear - He K2 X q0 e0. rewrite u_val in *. lra.
  - specialize (E2 _ eq_refl). set (n := s * (2 * c)) in *. injection E2 as Ex Ek. set (t := RN (- (RN (n * RN (1 /
    z)) * z_low))) in *. rewrite <- Ex in *.
    assert (n0 : n <> 0) by (intro Z; assert (Rabs n = 0) by (rewrite Z; apply Rabs_R0); unfold n in H; rewrite As in
      H; pose proof (bp_pos (-400)); lra).
    assert (Rn : bp (-400) <= Rabs n <= bp 400) by (unfold n; rewrite As; exact Rc).
    assert (XB : Rabs x' * z <= (1 + 4 * u) * Rabs n).
    { (* x' is n / z, rounded twice *)
      pose proof (corrected n 0 z 0 0 0 0 0 (FS _ Fc) Fz F_0 Rn Rz ltac:(rewrite Rabs_R0, Rmult_0_l; lra)
        ltac:(rewrite Rabs_R0, Rmult_0_l; lra) ltac:(lra) ltac:(lra) ltac:(lra)) as C. cbv zeta in C.
      rewrite <- Ex in C. specialize (C ltac:(replace (0 - (0 - x' * 0)) with 0 by ring; rewrite Rabs_R0, Rmult_0_l;
        lra)). destruct C as (C1 & C2 & _).
      replace ((n + 0) / (z + 0)) with (n / z) in C1 by now rewrite !Rplus_0_r. set (k0 := RN (RN (RN (n - x' * z) +
        0) * RN (1 / z))) in *.
      assert (X : Rabs x' <= (1 + 4 * u) * Rabs (n / z)).
      { replace x' with ((x' + k0 - n / z) + n / z - k0) by ring. eapply Rle_trans; [apply Rabs_minus_le; [apply
        Rabs_plus_le; [exact C1 | apply Rle_refl] | exact C2]|].
        pose proof (Rabs_pos (n / z)). rewrite u_val. lra. }
      apply Rle_trans with ((1 + 4 * u) * Rabs (n / z) * z); [apply Rmult_le_compat_r; lra|]. unfold Rdiv. rewrite
        Rabs_mult, Rabs_inv, (Rabs_pos_eq z) by lra. apply Req_le. field. lra. }
    assert (XL : Rabs (x' * z_low) <= (2625 / 1000) * u * Rabs n).
    { rewrite Rabs_mult. apply Rle_trans with (Rabs x' * (262 / 100 * u * z)); [apply Rmult_le_compat_l; [apply
      Rabs_pos | exact ZL]|].
      replace (Rabs x' * (262 / 100 * u * z)) with (262 / 100 * u * (Rabs x' * z)) by ring. pose proof (Rabs_pos n).
        rewrite u_val in *. lra. }
    assert (TT : Rabs (t - (0 - x' * z_low)) <= (263 / 100) * (u * u) * Rabs n).
    { assert (Et : t = RN (- (x' * z_low))) by (unfold t; rewrite Ex; reflexivity). rewrite Et. replace (0 - x' *
      z_low) with (- (x' * z_low)) by ring. eapply Rle_trans; [apply RN_err|]. rewrite Rabs_Ropp.
      assert (T9 : bp (-1075) <= / 10000 * (u * u) * bp (-400)).
      { apply Rle_trans with (bp (-20) * (u * u) * bp (-400)); [unfold u; rewrite <- !bp_add; apply bp_le; lia|].
        apply Rmult_le_compat_r; [apply Rlt_le, bp_pos|].
        apply Rmult_le_compat_r; [apply sq_pos | simpl; lra]. }
      pose proof (bp_pos (-400)). rewrite u_val in *. lra. }
    pose proof (corrected n 0 z z_low t 0 (262 / 100 * u) (263 / 100 * (u * u)) (FS _ Fc) Fz (RN_F _) Rn Rz
      ltac:(rewrite Rabs_R0, Rmult_0_l; lra)
      ltac:(rewrite (Rabs_pos_eq z) by lra; exact ZL) ltac:(lra) ltac:(rewrite u_val; lra) ltac:(rewrite u_val; lra))
        as C. cbv zeta in C.
    rewrite <- Ex in C. rewrite <- Ek in C. specialize (C TT). destruct C as (C1 & C2 & C3). rewrite Rplus_0_r in C1.
    set (q := Rabs (n / z)) in *. assert (q0 : 0 <= q) by apply Rabs_pos.
    assert (K1 : Rabs (x' + k' - n / (z + z_low)) <= 32 * (u * u) * q) by (eapply Rle_trans; [exact C1|]; apply
      Rmult_le_compat_r; [assumption|]; rewrite u_val; lra).
    assert (K2 : Rabs k' <= 5 * u * q) by (eapply Rle_trans; [exact C2|]; apply Rmult_le_compat_r; [assumption|];
      rewrite u_val; lra).
    apply Rabs_le_inv in ZL. assert (zz : 99 / 100 * z <= z + z_low) by (rewrite u_val in *; lra). pose proof ZN as
      ZN'. apply Rabs_le_inv in ZN'.
    assert (zz2 : 999 / 1000 * (z + z_low) <= zeta) by (rewrite u_val in *; lra).
    assert (zz3 : 999 / 1000 * z <= z + z_low) by (rewrite u_val in *; lra).
    assert (K3 : Rabs (n / (z + z_low) - n / zeta) <= 167 / 10 * (u * u) * q).
    { assert (QN : q * z = Rabs n) by (unfold q, Rdiv; rewrite Rabs_mult, Rabs_inv, (Rabs_pos_eq z) by lra; field; lra).
      apply Rmult_le_reg_r with zeta; [assumption|]. rewrite <- (Rabs_pos_eq zeta) at 2 by lra. rewrite <- Rabs_mult.
      replace ((n / (z + z_low) - n / zeta) * zeta) with (n / (z + z_low) * - (z + z_low - zeta)) by (field; split;
        lra).
      assert (Q2 : Rabs (n / (z + z_low)) <= 1002 / 1000 * q).
      { apply Rabs_div_le; [lra|]. rewrite (Rabs_pos_eq (z + z_low)) by lra. rewrite <- QN. apply Rle_trans with (1002
        / 1000 * q * (999 / 1000 * z)).
        - assert (0 <= q * z) by (apply Rmult_le_pos; lra). lra.
        - apply Rmult_le_compat_l; lra. }
      apply Rle_trans with (1002 / 1000 * q * (166 / 10 * (u * u) * z)); [apply Rabs_mult_le; [exact Q2 | rewrite
        Rabs_Ropp; exact ZN]|].
      replace (1002 / 1000 * q * (166 / 10 * (u * u) * z)) with (1002 / 1000 * (166 / 10) * (u * u) * q * z) by ring.
      apply Rle_trans with (167 / 10 * (u * u) * q * (998 / 1000 * z)).
      - assert (P9 : 0 <= u * u * q * z) by (apply Rmult_le_pos; [apply Rmult_le_pos; [apply sq_pos | assumption] |
        lra]). clear - P9. lra.
      - apply Rmult_le_compat_l; [|clear - zz2 zz3 z0; lra]. apply Rmult_le_pos; [|assumption]. apply Rmult_le_pos;
        [lra | apply sq_pos]. }
    assert (e0 : 0 <= e') by (pose proof (Rabs_pos x'); rewrite u_val in *; lra).
    apply (Round.round_if_certain (n / zeta) x' k' e'); auto; try (rewrite Ex; apply RN_F); try (rewrite Ek; apply
      RN_F).
    replace (n / zeta - (x' + k')) with (- ((x' + k' - n / (z + z_low)) + (n / (z + z_low) - n / zeta))) by ring.
      rewrite Rabs_Ropp.
    eapply Rle_trans; [apply Rabs_plus_le; [exact K1 | exact K3]|]. assert (X : 64 * (u * u) * ((1 - 3 * u) * q) <= 64
      * (u * u) * Rabs x') by (apply Rmult_le_compat_l; [rewrite u_val|]; lra).
    clear - He' K2 X q0 e0. rewrite u_val in *. lra.
Qed.
End Roots.
