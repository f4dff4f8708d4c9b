(* rt-geom, sphere/finish.rs: the residual of a root in doubles, and one step of Newton's. *)
From Proofs Require Import Rounding ErrorFree DoubleDouble Steps.
Open Scope R_scope.

(* The error of half the residual, relative to w.w + r^2. *)
Definition RESIDUAL_ERROR := 160 * u * u.
(* How far off the discriminant may be, relative, and the factor of the step's error. *)
Definition LARGEST_SLACK := 125 / 1000.
Definition SLACK_FACTOR := 25 / 10.

(* ---- The step: f over 2 sqrt(Delta) + s, where the code has f times half of one over the root of delta ---- *)
Section Step.
Variables delta Delta s E f : R.
Let q := sqrt delta.
Hypotheses (d0 : 0 < delta) (HD : Rabs (delta - Delta) <= 75 / 100 * E) (Hs : Rabs s * q <= 147 / 100 * E) (Hslack : E
  <= (LARGEST_SLACK + 8 * u) * delta)
  (Large : (169 / 10) * u * delta <= E) (Range : bp (-700) <= delta <= bp 900).
Let root := RN q. Let inverse := RN (1 / delta). Let inverse_root := RN (inverse * root).
Let step := RN (f * (/ 2 * inverse_root)).
Theorem SLACK_FACTOR_holds : forall slack e, (1 - 16 * u) * (E * (inverse_root * inverse_root)) <= slack -> (1 - 8 *
  u) * (SLACK_FACTOR * slack * (/ 2 * inverse_root) * Rabs f) <= e ->
  0 < 2 * sqrt Delta + s /\ Rabs (f / (2 * sqrt Delta + s) - step) + u * Rabs step <= (1 - 8 * u) * e + 2 * bp (-1075).
Proof.
  intros slack e Hk He. pose proof u_pos as up. unfold LARGEST_SLACK in Hslack. assert (qq : q * q = delta) by (apply
    sqrt_sqrt; lra). assert (q0 : 0 < q) by (apply sqrt_lt_R0; assumption).
  apply Rabs_le_inv in HD. assert (D0 : 0 < Delta) by (rewrite u_val in *; lra). set (Q := sqrt Delta). assert (QQ : Q
    * Q = Delta) by (apply sqrt_sqrt; lra). assert (Q0 : 0 < Q) by (apply sqrt_lt_R0; assumption).
  set (k := E / delta). assert (kd : k * delta = E) by (unfold k; field; lra). assert (k1 : 169 / 10 * u <= k) by
    (apply Rmult_le_reg_r with delta; lra).
  assert (k2 : k <= 125 / 1000 + 8 * u) by (apply Rmult_le_reg_r with delta; lra). assert (k0 : 0 < k) by lra.
  assert (QN : 95 / 100 * q <= Q) by (apply below_root; [lra|]; rewrite QQ; replace (95 / 100 * q * (95 / 100 * q))
    with (95 / 100 * (95 / 100) * (q * q)) by ring; rewrite qq; rewrite u_val in *; lra).
  assert (QD : Rabs (Q - q) <= (385 / 1000) * k * q).
  { apply Rmult_le_reg_r with (195 / 100 * q); [lra|]. apply Rle_trans with (Rabs (Q - q) * (Q + q)); [apply
    Rmult_le_compat_l; [apply Rabs_pos | lra]|].
    rewrite <- (Rabs_pos_eq (Q + q)) by lra. rewrite <- Rabs_mult. replace ((Q - q) * (Q + q)) with (Delta - delta) by
      (rewrite <- qq, <- QQ; ring).
    replace (385 / 1000 * k * q * (195 / 100 * q)) with (385 / 1000 * (195 / 100) * (k * (q * q))) by ring. rewrite
      qq, kd. apply Rabs_le. assert (0 <= E) by (rewrite <- kd; apply Rmult_le_pos; lra). lra. }
  assert (sD : Rabs s <= (147 / 100) * k * q).
  { apply Rmult_le_reg_r with q; [assumption|]. eapply Rle_trans; [exact Hs|]. rewrite <- kd, <- qq. apply Req_le.
    ring. }
  set (d := 2 * Q + s). assert (dD : Rabs (d - 2 * q) <= (224 / 100) * k * q).
  { replace (d - 2 * q) with (2 * (Q - q) + s) by (unfold d; ring). eapply Rle_trans; [apply Rabs_plus_le; [rewrite
    Rabs_mult, (Rabs_pos_eq 2) by lra; apply Rmult_le_compat_l; [lra | exact QD] | exact sD]|]. assert (0 <= k * q) by
      (apply Rmult_le_pos; lra). lra. }
  assert (kq : k * q <= (125 / 1000 + 8 * u) * q) by (apply Rmult_le_compat_r; lra).
  assert (dN : 859 / 1000 * (2 * q) <= d) by (apply Rabs_le_inv in dD; rewrite u_val in *; lra). split; [lra|].
  (* f / d against f / 2q *)
  set (m := Rabs f / (2 * q)). assert (mq : m * (2 * q) = Rabs f) by (unfold m; field; lra). assert (m0 : 0 <= m) by
    (unfold m; apply Rmult_le_pos; [apply Rabs_pos | apply Rlt_le, Rinv_0_lt_compat; lra]).
  assert (A1 : Rabs (f / d - f / (2 * q)) <= (131 / 100) * k * m).
  { replace (f / d - f / (2 * q)) with (f / (2 * q) * (- (d - 2 * q) / d)) by (field; split; lra). rewrite Rabs_mult.
    replace (Rabs (f / (2 * q))) with m by (unfold m, Rdiv; rewrite Rabs_mult, (Rabs_pos_eq (/ (2 * q))); [reflexivity
      | apply Rlt_le, Rinv_0_lt_compat; lra]).
    rewrite (Rmult_comm (131 / 100 * k)). apply Rmult_le_compat_l; [assumption|]. apply Rabs_div_le; [lra|]. rewrite
      Rabs_Ropp, (Rabs_pos_eq d) by lra. eapply Rle_trans; [exact dD|].
    apply Rle_trans with (131 / 100 * k * (859 / 1000 * (2 * q))); [assert (0 <= k * q) by (apply Rmult_le_pos; lra);
      lra | apply Rmult_le_compat_l; lra]. }
  (* the computed inverse *)
  assert (q1 : bp (-350) <= q) by (apply below_root; [lra|]; rewrite qq, bp_sq; exact (proj1 Range)).
  assert (q2 : q <= bp 450) by (apply below_root; [apply Rlt_le, bp_pos|]; rewrite qq, bp_sq; exact (proj2 Range)).
  pose proof (RN_normal q ltac:(rewrite Rabs_pos_eq by lra; eapply Rle_trans; [|exact q1]; apply bp_le; lia)) as R1.
    fold root in R1. rewrite (Rabs_pos_eq q) in R1 by lra.
  assert (i0 : 0 < 1 / delta) by (unfold Rdiv; rewrite Rmult_1_l; now apply Rinv_0_lt_compat).
  assert (i1 : bp (-900) <= 1 / delta).
  { apply Rmult_le_reg_r with delta; [assumption|]. replace (1 / delta * delta) with 1 by (field; lra). apply
    Rle_trans with (bp (-900) * bp 900); [apply Rmult_le_compat_l; [apply Rlt_le, bp_pos | lra] | rewrite <- bp_add;
      simpl; lra]. }
  pose proof (RN_normal (1 / delta) ltac:(rewrite Rabs_pos_eq by lra; eapply Rle_trans; [|exact i1]; apply bp_le;
    lia)) as R2. fold inverse in R2. rewrite (Rabs_pos_eq (1 / delta)) in R2 by lra.
  assert (IQ : 1 / delta * q = 1 / q) by (rewrite <- qq; field; lra). assert (p0 : 0 < 1 / q) by (unfold Rdiv; rewrite
    Rmult_1_l; now apply Rinv_0_lt_compat).
  assert (R3 : Rabs (inverse * root - 1 / q) <= (2 + / 1000) * u * (1 / q)).
  { rewrite <- IQ. replace (inverse * root - 1 / delta * q) with ((inverse - 1 / delta) * root + 1 / delta * (root -
    q)) by ring.
    apply Rle_trans with (u * (1 / delta) * ((1 + u) * q) + 1 / delta * (u * q)).
    - apply Rabs_plus_le; [apply Rabs_mult_le; [exact R2 | apply Rabs_le_inv in R1; apply Rabs_le; lra] | rewrite
      Rabs_mult, (Rabs_pos_eq (1 / delta)) by lra; apply Rmult_le_compat_l; lra].
    - replace (u * (1 / delta) * ((1 + u) * q) + 1 / delta * (u * q)) with ((2 + u) * u * (1 / delta * q)) by ring.
      rewrite IQ. apply Rmult_le_compat_r; [lra|]. rewrite u_val. lra. }
  assert (P1 : bp (-450) <= 1 / q).
  { apply Rmult_le_reg_r with q; [assumption|]. replace (1 / q * q) with 1 by (field; lra). apply Rle_trans with (bp
    (-450) * bp 450); [apply Rmult_le_compat_l; [apply Rlt_le, bp_pos | lra] | rewrite <- bp_add; simpl; lra]. }
  pose proof R3 as R3'. apply Rabs_le_inv in R3'.
  assert (ip : bp (-1022) <= Rabs (inverse * root)).
  { rewrite Rabs_pos_eq by (rewrite u_val in *; lra). assert (bp (-1022) <= / 1000000000000 * bp (-450)) by (apply
    bp_part12; lia). rewrite u_val in *. lra. }
  pose proof (RN_normal (inverse * root) ip) as R4. fold inverse_root in R4. rewrite (Rabs_pos_eq (inverse * root)) in
    R4 by (rewrite u_val in *; lra).
  assert (R5 : Rabs (inverse_root - 1 / q) <= (3 + / 200) * u * (1 / q)).
  { replace (inverse_root - 1 / q) with ((inverse_root - inverse * root) + (inverse * root - 1 / q)) by ring. eapply
    Rle_trans; [apply Rabs_plus_le; [exact R4 | exact R3]|]. rewrite u_val in *. lra. }
  pose proof R5 as R5'. apply Rabs_le_inv in R5'. assert (ir0 : 0 < inverse_root) by (rewrite u_val in *; lra).
  assert (FH : Rabs (f * (/ 2 * inverse_root) - f / (2 * q)) <= (3 + / 200) * u * m).
  { replace (f * (/ 2 * inverse_root) - f / (2 * q)) with (f / 2 * (inverse_root - 1 / q)) by (field; lra). unfold m.
    replace ((3 + / 200) * u * (Rabs f / (2 * q))) with (Rabs (f / 2) * ((3 + / 200) * u * (1 / q))) by (unfold Rdiv
      at 1; rewrite Rabs_mult, (Rabs_pos_eq (/ 2)) by lra; field; lra).
    rewrite Rabs_mult. apply Rmult_le_compat_l; [apply Rabs_pos | exact R5]. }
  assert (fm : Rabs (f / (2 * q)) = m) by (unfold m, Rdiv; rewrite Rabs_mult, (Rabs_pos_eq (/ (2 * q))); [reflexivity
    | apply Rlt_le, Rinv_0_lt_compat; lra]).
  assert (FB : Rabs (f * (/ 2 * inverse_root)) <= (1 + 4 * u) * m).
  { replace (f * (/ 2 * inverse_root)) with ((f * (/ 2 * inverse_root) - f / (2 * q)) + f / (2 * q)) by ring. eapply
    Rle_trans; [apply Rabs_plus_le; [exact FH | rewrite fm; apply Rle_refl]|]. rewrite u_val in *. lra. }
  pose proof (RN_err (f * (/ 2 * inverse_root))) as R6. fold step in R6. pose proof (bp_pos (-1075)) as T0.
  assert (SB : Rabs step <= (1 + 6 * u) * m + (1 + u) * bp (-1075)).
  { replace step with ((step - f * (/ 2 * inverse_root)) + f * (/ 2 * inverse_root)) by ring. eapply Rle_trans; [apply
    Rabs_plus_le; [exact R6 | exact FB]|]. rewrite u_val in *. lra. }
  (* the bound *)
  assert (KS : (1 - 32 * u) * k <= slack).
  { eapply Rle_trans; [|exact Hk]. replace E with (k * (q * q)) by (rewrite qq; exact kd).
    assert (IR : (1 - 4 * u) * (1 / q) * ((1 - 4 * u) * (1 / q)) <= inverse_root * inverse_root) by (apply
      Rmult_le_compat; try (apply Rmult_le_pos; rewrite ?u_val; lra); rewrite u_val in *; lra).
    assert (X : k * (q * q) * ((1 - 4 * u) * (1 / q) * ((1 - 4 * u) * (1 / q))) <= k * (q * q) * (inverse_root *
      inverse_root)) by (apply Rmult_le_compat_l; [apply Rmult_le_pos; [lra | apply Rmult_le_pos; lra] | exact IR]).
    replace (k * (q * q) * ((1 - 4 * u) * (1 / q) * ((1 - 4 * u) * (1 / q)))) with ((1 - 4 * u) * (1 - 4 * u) * k) in
      X by (field; lra). rewrite u_val in *. lra. }
  assert (IM : (1 - 4 * u) * m <= / 2 * inverse_root * Rabs f).
  { replace ((1 - 4 * u) * m) with (/ 2 * ((1 - 4 * u) * (1 / q)) * Rabs f) by (unfold m; field; lra). apply
    Rmult_le_compat_r; [apply Rabs_pos|]. apply Rmult_le_compat_l; [lra|]. rewrite u_val in *. lra. }
  assert (EB : (1 - 32 * u) * k * ((1 - 4 * u) * m) <= slack * (/ 2 * inverse_root * Rabs f)).
  { apply Rmult_le_compat; try assumption; apply Rmult_le_pos; rewrite ?u_val; lra. }
  unfold SLACK_FACTOR in He. replace (25 / 10 * slack * (/ 2 * inverse_root) * Rabs f) with (25 / 10 * (slack * (/ 2 *
    inverse_root * Rabs f))) in He by ring.
  replace ((1 - 32 * u) * k * ((1 - 4 * u) * m)) with ((1 - 32 * u) * (1 - 4 * u) * (k * m)) in EB by ring.
  assert (KM : 169 / 10 * u * m <= k * m) by (apply Rmult_le_compat_r; assumption). replace (131 / 100 * k * m) with
    (131 / 100 * (k * m)) in A1 by ring.
  replace (f / d - step) with ((f / d - f / (2 * q)) - (f * (/ 2 * inverse_root) - f / (2 * q)) - (step - f * (/ 2 *
    inverse_root))) by ring.
  apply Rle_trans with (131 / 100 * (k * m) + (3 + / 200) * u * m + (u * Rabs (f * (/ 2 * inverse_root)) + bp (-1075))
    + u * Rabs step).
  - apply Rplus_le_compat_r. apply Rabs_minus_le; [apply Rabs_minus_le; [exact A1 | exact FH] | exact R6].
  - assert (u * Rabs (f * (/ 2 * inverse_root)) <= u * ((1 + 4 * u) * m)) by (apply Rmult_le_compat_l; lra).
    assert (u * Rabs step <= u * ((1 + 6 * u) * m + (1 + u) * bp (-1075))) by (apply Rmult_le_compat_l; lra). set (km
      := k * m) in *. set (z := slack * (/ 2 * inverse_root * Rabs f)) in *.
    clear - He EB KM H H0 T0 m0. rewrite u_val in *. lra.
Qed.
Theorem LARGEST_SLACK_holds : 90 / 100 * delta <= Delta.
Proof. unfold LARGEST_SLACK in Hslack. apply Rabs_le_inv in HD. rewrite u_val in *. lra. Qed.
End Step.

(* ---- The residual |w + t d|^2 - r^2 ---- *)
(* A lane: W = w + w' and P = s + s' exactly, their sum p as a rounded high part and a low part. *)
Section Lane.
Variables w w' s s' : R.
Hypotheses (Fw : F w) (Fw' : F w') (Fs : F s) (Fs' : F s') (Bw : Rabs w' <= u * Rabs (w + w')) (Bs : Rabs s' <= u *
  Rabs (s + s')).
Definition lhigh := RN (w + s).
Definition llow := RN (two_sum_error w s + RN (w' + s')).
Definition lrest := w + w' + (s + s') - lhigh.
Lemma lane : Rabs llow <= (1 + / 1000) * u * (Rabs (w + w') + Rabs (s + s') + Rabs (w + w' + (s + s'))) /\
  Rabs (llow - lrest) <= (1 + / 1000) * (u * u) * (2 * Rabs (w + w') + 2 * Rabs (s + s') + Rabs (w + w' + (s + s'))) /\
  Rabs lhigh <= (1 + / 1000000) * Rabs (w + w' + (s + s')) + (1 + / 1000) * u * (Rabs (w + w') + Rabs (s + s')).
Proof.
  pose proof u_pos as up. set (W := w + w') in *. set (S := s + s') in *. set (p := W + S) in *. pose proof (Rabs_pos
    W). pose proof (Rabs_pos S). pose proof (Rabs_pos p).
  pose proof (two_sum w s Fw Fs) as T. fold lhigh in T. destruct (two_sum_error_le w s Fw Fs) as [E _]. set (e :=
    two_sum_error w s) in *.
  assert (WS : Rabs (w + s) <= Rabs p + u * (Rabs W + Rabs S)).
  { replace (w + s) with (p - (w' + s')) by (unfold p, W, S; ring). eapply Rle_trans; [apply Rabs_minus_le; [apply
    Rle_refl | apply Rabs_plus_le; [exact Bw | exact Bs]]|]. lra. }
  assert (Eb : Rabs e <= u * (Rabs p + u * (Rabs W + Rabs S))) by (eapply Rle_trans; [exact E|]; apply
    Rmult_le_compat_l; lra).
  pose proof (RN_sum w' s' Fw' Fs') as R1. set (y := RN (w' + s')) in *. assert (LB : Rabs (w' + s') <= u * (Rabs W +
    Rabs S)) by (eapply Rle_trans; [apply Rabs_plus_le; [exact Bw | exact Bs]|]; lra).
  assert (R1' : Rabs (y - (w' + s')) <= u * (u * (Rabs W + Rabs S))) by (eapply Rle_trans; [exact R1|]; apply
    Rmult_le_compat_l; lra).
  pose proof (RN_sum e y (two_sum_error_F _ _) (RN_F _)) as R2. fold e in R2. change (RN (e + y)) with llow in R2.
  assert (EY : Rabs (e + y) <= (1 + / 2000) * u * (Rabs W + Rabs S + Rabs p)).
  { replace (e + y) with (e + ((y - (w' + s')) + (w' + s'))) by ring. eapply Rle_trans; [apply Rabs_plus_le; [exact Eb
    | apply Rabs_plus_le; [exact R1' | exact LB]]|]. rewrite u_val in *. lra. }
  assert (R2' : Rabs (llow - (e + y)) <= u * ((1 + / 2000) * u * (Rabs W + Rabs S + Rabs p))) by (eapply Rle_trans;
    [exact R2|]; apply Rmult_le_compat_l; lra).
  assert (LR : lrest = e + (w' + s')) by (unfold lrest; lra). split; [|split].
  - replace llow with ((llow - (e + y)) + (e + y)) by ring. eapply Rle_trans; [apply Rabs_plus_le; eassumption|].
    rewrite u_val in *. lra.
  - rewrite LR. replace (llow - (e + (w' + s'))) with ((llow - (e + y)) + (y - (w' + s'))) by ring. eapply Rle_trans;
    [apply Rabs_plus_le; eassumption|]. rewrite u_val in *. lra.
  - replace lhigh with (p - (e + (w' + s'))) by (rewrite <- LR; unfold lrest, p, W, S; ring). eapply Rle_trans; [apply
    Rabs_minus_le; [apply Rle_refl | apply Rabs_plus_le; [exact Eb | exact LB]]|]. rewrite u_val in *. lra.
Qed.
End Lane.
Section Residual.
Variables w1 w2 w3 w1' w2' w3' s1 s2 s3 s1' s2' s3' r a : R.
Hypotheses (Fw1 : F w1) (Fw2 : F w2) (Fw3 : F w3) (Fw1' : F w1') (Fw2' : F w2') (Fw3' : F w3') (Fs1 : F s1) (Fs2 : F
  s2) (Fs3 : F s3) (Fs1' : F s1') (Fs2' : F s2') (Fs3' : F s3')
  (Bw1 : Rabs w1' <= u * Rabs (w1 + w1')) (Bw2 : Rabs w2' <= u * Rabs (w2 + w2')) (Bw3 : Rabs w3' <= u * Rabs (w3 +
    w3'))
  (Bs1 : Rabs s1' <= u * Rabs (s1 + s1')) (Bs2 : Rabs s2' <= u * Rabs (s2 + s2')) (Bs3 : Rabs s3' <= u * Rabs (s3 +
    s3')).
Let p1 := w1 + w1' + (s1 + s1'). Let p2 := w2 + w2' + (s2 + s2'). Let p3 := w3 + w3' + (s3 + s3').
Let f := p1 * p1 + p2 * p2 + p3 * p3 - r * r.
(* a^2 = w.w + r^2; what the first guess gives, section 5.6 *)
Hypotheses (a0 : 0 < a) (LW : len (w1 + w1') (w2 + w2') (w3 + w3') <= a) (LS : len (s1 + s1') (s2 + s2') (s3 + s3') <=
  16 / 10 * a)
  (LP : len p1 p2 p3 <= 12248 / 10000 * a) (Lr : r * r <= a * a) (Hf : Rabs f <= 62 * u * (a * a)) (Fr : F r).
Let h1 := lhigh w1 s1. Let h2 := lhigh w2 s2. Let h3 := lhigh w3 s3.
Let l1 := llow w1 w1' s1 s1'. Let l2 := llow w2 w2' s2 s2'. Let l3 := llow w3 w3' s3 s3'.
(* the squares in two words, the cross term fused or not; the fourth lane is -r *)
Variables q1 q2 q3 qr m1 m2 m3 : R.
Hypotheses (Q1 : Rabs (h1 * h1 - RN (h1 * h1)) <= u * (h1 * h1)) (Q2 : Rabs (h2 * h2 - RN (h2 * h2)) <= u * (h2 * h2))
  (Q3 : Rabs (h3 * h3 - RN (h3 * h3)) <= u * (h3 * h3))
  (Qr : Rabs (r * r - RN (r * r)) <= u * (r * r)) (E1 : q1 = h1 * h1 - RN (h1 * h1)) (E2 : q2 = h2 * h2 - RN (h2 *
    h2)) (E3 : q3 = h3 * h3 - RN (h3 * h3)) (Er : qr = r * r - RN (r * r))
  (Fqr : F qr) (Tiny : bp (-1075) <= / 10000 * (u * u) * (a * a))
  (M1 : Rabs (m1 - 2 * h1 * l1) <= u * Rabs (2 * h1 * l1) + bp (-1075)) (M2 : Rabs (m2 - 2 * h2 * l2) <= u * Rabs (2 *
    h2 * l2) + bp (-1075)) (M3 : Rabs (m3 - 2 * h3 * l3) <= u * Rabs (2 * h3 * l3) + bp (-1075)).
Let k1 := RN (m1 + q1). Let k2 := RN (m2 + q2). Let k3 := RN (m3 + q3).
Let x := RN (h1 * h1). Let y := RN (h2 * h2). Let z := RN (h3 * h3). Let rr := RN (r * r).
Let sa := RN (x + z). Let ea := two_sum_error x z. Let sb := RN (y - rr). Let eb := two_sum_error y (- rr).
Let ka := RN (k1 + k3). Let kb := RN (k2 - qr).
Let result := RN (RN (RN (sa + sb) + RN (ea + eb)) + RN (ka + kb)).

Theorem RESIDUAL_ERROR_holds : Rabs (result - f) <= (1 - 16 * u) * (2 * RESIDUAL_ERROR * (a * a)).
Proof.
  pose proof u_pos as up. set (A := a * a) in *. assert (A0 : 0 < A) by (apply Rmult_lt_0_compat; assumption). pose
    proof (bp_pos (-1075)) as T0.
  destruct (lane w1 w1' s1 s1' Fw1 Fw1' Fs1 Fs1' Bw1 Bs1) as (a1 & b1 & c1). destruct (lane w2 w2' s2 s2' Fw2 Fw2' Fs2
    Fs2' Bw2 Bs2) as (a2 & b2 & c2).
  destruct (lane w3 w3' s3 s3' Fw3 Fw3' Fs3 Fs3' Bw3 Bs3) as (a3 & b3 & c3). fold p1 in a1, b1, c1. fold p2 in a2, b2,
    c2. fold p3 in a3, b3, c3.
  fold h1 in c1. fold h2 in c2. fold h3 in c3. fold l1 in a1, b1. fold l2 in a2, b2. fold l3 in a3, b3.
  set (g1 := lrest w1 w1' s1 s1') in *. set (g2 := lrest w2 w2' s2 s2') in *. set (g3 := lrest w3 w3' s3 s3') in *.
  assert (P1 : p1 = h1 + g1) by (unfold g1, lrest, p1, h1; ring). assert (P2 : p2 = h2 + g2) by (unfold g2, lrest, p2,
    h2; ring). assert (P3 : p3 = h3 + g3) by (unfold g3, lrest, p3, h3; ring).
  (* lengths *)
  assert (L3 : forall v1 v2 v3 kw ks kp, 0 <= kw -> 0 <= ks -> 0 <= kp -> Rabs v1 <= kw * Rabs (w1 + w1') + ks * Rabs
    (s1 + s1') + kp * Rabs p1 ->
    Rabs v2 <= kw * Rabs (w2 + w2') + ks * Rabs (s2 + s2') + kp * Rabs p2 -> Rabs v3 <= kw * Rabs (w3 + w3') + ks *
      Rabs (s3 + s3') + kp * Rabs p3 ->
    len v1 v2 v3 <= (kw + ks * (16 / 10) + kp * (12248 / 10000)) * a).
  { intros v1 v2 v3 kw ks kp K1 K2 K3 V1 V2 V3. assert (AB : forall v b, Rabs v <= b -> Rabs v <= Rabs b) by (intros v
    b H; eapply Rle_trans; [exact H | apply Rle_abs]).
    eapply Rle_trans; [apply (len_mono _ _ _ _ _ _ (AB _ _ V1) (AB _ _ V2) (AB _ _ V3))|]. eapply Rle_trans; [apply
      len_add|]. eapply Rle_trans; [apply Rplus_le_compat_r, len_add|]. rewrite !len_scale by assumption.
    assert (LA : forall b1 b2 b3, len (Rabs b1) (Rabs b2) (Rabs b3) = len b1 b2 b3) by (intros; unfold len; now
      rewrite !abs_sq). rewrite !LA.
    assert (kw * len (w1 + w1') (w2 + w2') (w3 + w3') <= kw * a) by (apply Rmult_le_compat_l; assumption). assert (ks
      * len (s1 + s1') (s2 + s2') (s3 + s3') <= ks * (16 / 10 * a)) by (apply Rmult_le_compat_l; assumption).
    assert (kp * len p1 p2 p3 <= kp * (12248 / 10000 * a)) by (apply Rmult_le_compat_l; assumption). lra. }
  assert (NL : len l1 l2 l3 <= (384 / 100) * u * a).
  { eapply Rle_trans; [apply (L3 l1 l2 l3 ((1 + / 1000) * u) ((1 + / 1000) * u) ((1 + / 1000) * u)); lra|]. apply
    Rmult_le_compat_r; lra. }
  assert (ND : len (l1 - g1) (l2 - g2) (l3 - g3) <= (644 / 100) * (u * u) * a).
  { assert (uu : 0 <= u * u) by apply sq_pos. eapply Rle_trans; [apply (L3 _ _ _ ((1 + / 1000) * (u * u) * 2) ((1 + /
    1000) * (u * u) * 2) ((1 + / 1000) * (u * u))); lra|]. apply Rmult_le_compat_r; lra. }
  assert (NG : len g1 g2 g3 <= (385 / 100) * u * a).
  { pose proof (len_sub g1 g2 g3 l1 l2 l3) as I. assert (len (g1 - l1) (g2 - l2) (g3 - l3) = len (l1 - g1) (l2 - g2)
    (l3 - g3)) by (unfold len; f_equal; ring). rewrite u_val in *. lra. }
  assert (NH : len h1 h2 h3 <= (12249 / 10000) * a).
  { eapply Rle_trans; [apply (L3 h1 h2 h3 ((1 + / 1000) * u) ((1 + / 1000) * u) (1 + / 1000000)); lra|]. apply
    Rmult_le_compat_r; [lra|]. rewrite u_val. lra. }
  pose proof (len_pos l1 l2 l3) as nl0. pose proof (len_pos h1 h2 h3) as nh0. pose proof (len_pos (l1 - g1) (l2 - g2)
    (l3 - g3)) as nd0. pose proof (len_pos g1 g2 g3) as ng0.
  (* sums of squares and products *)
  assert (HH : h1 * h1 + h2 * h2 + h3 * h3 <= (15004 / 10000) * A).
  { rewrite <- len_sq. apply Rle_trans with ((12249 / 10000 * a) * (12249 / 10000 * a)); [apply Rmult_le_compat;
    assumption | unfold A; pose proof (sq_pos a); lra]. }
  pose proof (sq_pos h1) as hh1. pose proof (sq_pos h2) as hh2. pose proof (sq_pos h3) as hh3. pose proof (sq_pos r)
    as r2.
  assert (HL : Rabs (h1 * l1) + Rabs (h2 * l2) + Rabs (h3 * l3) <= (471 / 100) * u * A).
  { rewrite !Rabs_mult. eapply Rle_trans; [apply abs_dot|]. apply Rle_trans with ((12249 / 10000 * a) * (384 / 100 * u
    * a)); [apply Rmult_le_compat; assumption|].
    replace (12249 / 10000 * a * (384 / 100 * u * a)) with (12249 / 10000 * (384 / 100) * u * A) by (unfold A; ring).
      apply Rmult_le_compat_r; lra. }
  assert (HD : Rabs (h1 * (l1 - g1) + h2 * (l2 - g2) + h3 * (l3 - g3)) <= (79 / 10) * (u * u) * A).
  { eapply Rle_trans; [apply len_dot|]. apply Rle_trans with ((12249 / 10000 * a) * (644 / 100 * (u * u) * a)); [apply
    Rmult_le_compat; assumption|].
    replace (12249 / 10000 * a * (644 / 100 * (u * u) * a)) with (12249 / 10000 * (644 / 100) * (u * u) * A) by
      (unfold A; ring). apply Rmult_le_compat_r; [lra|]. apply Rmult_le_compat_r; [apply sq_pos | lra]. }
  assert (GG : Rabs (g1 * g1 + g2 * g2 + g3 * g3) <= (149 / 10) * (u * u) * A).
  { rewrite Rabs_pos_eq by apply sum_sq_pos. rewrite <- len_sq. apply Rle_trans with ((385 / 100 * u * a) * (385 / 100
    * u * a)); [apply Rmult_le_compat; assumption|].
    replace (385 / 100 * u * a * (385 / 100 * u * a)) with (385 / 100 * (385 / 100) * (u * u) * A) by (unfold A;
      ring). apply Rmult_le_compat_r; [lra|]. apply Rmult_le_compat_r; [apply sq_pos | lra]. }
  pose proof (Rabs_pos (h1 * l1)) as d1. pose proof (Rabs_pos (h2 * l2)) as d2. pose proof (Rabs_pos (h3 * l3)) as d3.
  assert (AM : forall h l m, Rabs (m - 2 * h * l) <= u * Rabs (2 * h * l) + bp (-1075) -> Rabs (m - 2 * h * l) <= 2 *
    u * Rabs (h * l) + bp (-1075) /\ Rabs m <= (2 + 2 * u) * Rabs (h * l) + bp (-1075)).
  { intros h l m H. replace (2 * h * l) with (2 * (h * l)) in * by ring. rewrite (Rabs_mult 2), (Rabs_pos_eq 2) in H
    by lra. split; [lra|].
    replace m with ((m - 2 * (h * l)) + 2 * (h * l)) by ring. eapply Rle_trans; [apply Rabs_plus_le; [exact H |
      rewrite Rabs_mult, (Rabs_pos_eq 2) by lra; apply Rle_refl]|]. lra. }
  destruct (AM _ _ _ M1) as [M1a M1b]. destruct (AM _ _ _ M2) as [M2a M2b]. destruct (AM _ _ _ M3) as [M3a M3b]. clear
    AM.
  rewrite <- E1 in Q1. rewrite <- E2 in Q2. rewrite <- E3 in Q3. rewrite <- Er in Qr.
  pose proof (RN_err (m1 + q1)) as K1. pose proof (RN_err (m2 + q2)) as K2. pose proof (RN_err (m3 + q3)) as K3. fold
    k1 in K1. fold k2 in K2. fold k3 in K3.
  pose proof (Rabs_triang m1 q1) as t1. pose proof (Rabs_triang m2 q2) as t2. pose proof (Rabs_triang m3 q3) as t3.
  set (v1 := Rabs (h1 * l1)) in *. set (v2 := Rabs (h2 * l2)) in *. set (v3 := Rabs (h3 * l3)) in *. set (T := bp
    (-1075)) in *.
  assert (N1 : Rabs (m1 + q1) <= (2 + 2 * u) * v1 + u * (h1 * h1) + T) by lra. assert (N2 : Rabs (m2 + q2) <= (2 + 2 *
    u) * v2 + u * (h2 * h2) + T) by lra. assert (N3 : Rabs (m3 + q3) <= (2 + 2 * u) * v3 + u * (h3 * h3) + T) by lra.
  assert (UK : forall k m b, Rabs (k - m) <= u * Rabs m + T -> Rabs m <= b -> Rabs (k - m) <= u * b + T /\ Rabs k <=
    (1 + u) * b + T).
  { intros k m b H G. assert (u * Rabs m <= u * b) by (apply Rmult_le_compat_l; lra). split; [lra|]. replace k with
    ((k - m) + m) by ring. eapply Rle_trans; [apply Rabs_plus_le; [exact H | exact G]|]. lra. }
  destruct (UK _ _ _ K1 N1) as [K1a K1b]. destruct (UK _ _ _ K2 N2) as [K2a K2b]. destruct (UK _ _ _ K3 N3) as [K3a
    K3b]. clear UK.
  pose proof (RN_sum k1 k3 (RN_F _) (RN_F _)) as Ka. pose proof (RN_diff k2 qr (RN_F _) Fqr) as Kb. fold ka in Ka.
    fold kb in Kb.
  pose proof (RN_sum ka kb (RN_F _) (RN_F _)) as Kc. set (kc := RN (ka + kb)) in *.
  pose proof (two_sum x z (RN_F _) (RN_F _)) as TA. fold sa ea in TA. pose proof (two_sum y (- rr) (RN_F _) (F_opp _
    (RN_F _))) as TB. change (RN (y + - rr)) with sb in TB. fold eb in TB.
  destruct (two_sum_error_le x z (RN_F _) (RN_F _)) as [EA _]. destruct (two_sum_error_le y (- rr) (RN_F _) (F_opp _
    (RN_F _))) as [EB _]. fold ea in EA. fold eb in EB.
  assert (XB : Rabs x <= (1 + u) * (h1 * h1)) by (replace x with (h1 * h1 - q1) by (unfold x; lra); eapply Rle_trans;
    [apply Rabs_minus_le; [apply Rle_refl | exact Q1]|]; rewrite Rabs_pos_eq by assumption; lra).
  assert (YB : Rabs y <= (1 + u) * (h2 * h2)) by (replace y with (h2 * h2 - q2) by (unfold y; lra); eapply Rle_trans;
    [apply Rabs_minus_le; [apply Rle_refl | exact Q2]|]; rewrite Rabs_pos_eq by assumption; lra).
  assert (ZB : Rabs z <= (1 + u) * (h3 * h3)) by (replace z with (h3 * h3 - q3) by (unfold z; lra); eapply Rle_trans;
    [apply Rabs_minus_le; [apply Rle_refl | exact Q3]|]; rewrite Rabs_pos_eq by assumption; lra).
  assert (RB : Rabs rr <= (1 + u) * (r * r)) by (replace rr with (r * r - qr) by (unfold rr; lra); eapply Rle_trans;
    [apply Rabs_minus_le; [apply Rle_refl | exact Qr]|]; rewrite Rabs_pos_eq by assumption; lra).
  assert (EAb : Rabs ea <= u * ((1 + u) * (h1 * h1 + h3 * h3))) by (eapply Rle_trans; [exact EA|]; apply
    Rmult_le_compat_l; [lra|]; eapply Rle_trans; [apply Rabs_triang|]; lra).
  assert (EBb : Rabs eb <= u * ((1 + u) * (h2 * h2 + r * r))) by (eapply Rle_trans; [exact EB|]; apply
    Rmult_le_compat_l; [lra|]; eapply Rle_trans; [apply Rabs_triang|]; rewrite Rabs_Ropp; lra).
  pose proof (RN_sum ea eb (two_sum_error_F _ _) (two_sum_error_F _ _)) as Ke. fold ea eb in Ke. set (ke := RN (ea +
    eb)) in *.
  pose proof (RN_sum sa sb (RN_F _) (RN_F _)) as Ks. set (ks := RN (sa + sb)) in *. pose proof (RN_sum ks ke (RN_F _)
    (RN_F _)) as Kt. set (kt := RN (ks + ke)) in *.
  pose proof (RN_sum kt kc (RN_F _) (RN_F _)) as Kr. change (RN (kt + kc)) with result in Kr.
  set (H1 := h1 * h1) in *. set (H2 := h2 * h2) in *. set (H3 := h3 * h3) in *. set (R2 := r * r) in *.
  (* sizes of the partial sums *)
  assert (Sa : Rabs (k1 + k3) <= (1 + 3 * u) * (2 * v1 + 2 * v3 + u * H1 + u * H3) + 5 * T) by (eapply Rle_trans;
    [apply Rabs_plus_le; [exact K1b | exact K3b]|]; clear - d1 d3 hh1 hh3 T0; rewrite u_val in *; lra).
  assert (Sb : Rabs (k2 - qr) <= (1 + 3 * u) * (2 * v2 + u * H2 + u * R2) + 5 * T) by (eapply Rle_trans; [apply
    Rabs_minus_le; [exact K2b | exact Qr]|]; clear - d2 hh2 r2 T0; rewrite u_val in *; lra).
  assert (Ua : forall k m b, Rabs (k - m) <= u * Rabs m -> Rabs m <= b -> Rabs (k - m) <= u * b /\ Rabs k <= (1 + u) *
    b).
  { intros k m b H G. assert (u * Rabs m <= u * b) by (apply Rmult_le_compat_l; lra). split; [lra|]. replace k with
    ((k - m) + m) by ring. eapply Rle_trans; [apply Rabs_plus_le; [exact H | exact G]|]. lra. }
  destruct (Ua _ _ _ Ka Sa) as [Ka1 Ka2]. destruct (Ua _ _ _ Kb Sb) as [Kb1 Kb2].
  assert (Low : 2 * v1 + 2 * v2 + 2 * v3 + u * H1 + u * H2 + u * H3 + u * R2 <= (1193 / 100) * u * A) by (clear - HL
    HH Lr up A0; rewrite u_val in *; lra).
  assert (Sc : Rabs (ka + kb) <= (1194 / 100) * u * A) by (eapply Rle_trans; [apply Rabs_plus_le; [exact Ka2 | exact
    Kb2]|]; clear - Low Tiny T0 d1 d2 d3 hh1 hh2 hh3 r2 A0; rewrite u_val in *; lra).
  destruct (Ua _ _ _ Kc Sc) as [Kc1 Kc2].
  assert (Se : Rabs (ea + eb) <= (251 / 100) * u * A) by (eapply Rle_trans; [apply Rabs_plus_le; [exact EAb | exact
    EBb]|]; clear - HH Lr hh1 hh2 hh3 r2 A0; rewrite u_val in *; lra).
  destruct (Ua _ _ _ Ke Se) as [Ke1 Ke2].
  (* sa + sb is f but for the low parts *)
  assert (I : sa + sb = f - 2 * (h1 * g1 + h2 * g2 + h3 * g3) - (g1 * g1 + g2 * g2 + g3 * g3) - (q1 + q2 + q3 - qr) -
    (ea + eb)).
  { replace f with (H1 + H2 + H3 + 2 * (h1 * g1 + h2 * g2 + h3 * g3) + (g1 * g1 + g2 * g2 + g3 * g3) - R2) by (unfold
    f, H1, H2, H3, R2; rewrite P1, P2, P3; ring).
    assert (X1 : x = H1 - q1) by (unfold x; lra). assert (X2 : y = H2 - q2) by (unfold y; lra). assert (X3 : z = H3 -
      q3) by (unfold z; lra). assert (X4 : rr = R2 - qr) by (unfold rr; lra). lra. }
  assert (HG : Rabs (h1 * g1 + h2 * g2 + h3 * g3) <= (472 / 100) * u * A).
  { eapply Rle_trans; [apply len_dot|]. apply Rle_trans with ((12249 / 10000 * a) * (385 / 100 * u * a)); [apply
    Rmult_le_compat; assumption|].
    replace (12249 / 10000 * a * (385 / 100 * u * a)) with (12249 / 10000 * (385 / 100) * u * A) by (unfold A; ring).
      apply Rmult_le_compat_r; lra. }
  assert (Qs : Rabs (q1 + q2 + q3 - qr) <= (2501 / 1000) * u * A).
  { eapply Rle_trans; [apply Rabs_minus_le; [apply Rabs_plus_le; [apply Rabs_plus_le; [exact Q1 | exact Q2] | exact
    Q3] | exact Qr]|]. clear - HH Lr up A0. rewrite u_val in *. lra. }
  assert (Ss : Rabs (sa + sb) <= (765 / 10) * u * A).
  { rewrite I. eapply Rle_trans; [apply Rabs_minus_le; [apply Rabs_minus_le; [apply Rabs_minus_le; [apply
    Rabs_minus_le; [exact Hf | rewrite Rabs_mult, (Rabs_pos_eq 2) by lra; apply Rmult_le_compat_l; [lra | exact HG]] |
      exact GG] | exact Qs] | exact Se]|].
    clear - A0. rewrite u_val in *. lra. }
  destruct (Ua _ _ _ Ks Ss) as [Ks1 Ks2].
  assert (St : Rabs (ks + ke) <= (7902 / 100) * u * A) by (eapply Rle_trans; [apply Rabs_plus_le; [exact Ks2 | exact
    Ke2]|]; clear - A0; rewrite u_val in *; lra).
  destruct (Ua _ _ _ Kt St) as [Kt1 Kt2].
  (* all errors before the last sum *)
  assert (Bef : Rabs (kt + kc - f) <= (2355 / 10) * (u * u) * A).
  { replace (kt + kc - f) with ((kt - (ks + ke)) + (ks - (sa + sb)) + (ke - (ea + eb)) + (kc - (ka + kb)) + (ka - (k1
    + k3)) + (kb - (k2 - qr)) + (k1 - (m1 + q1)) + (k2 - (m2 + q2)) + (k3 - (m3 + q3))
      + (m1 - 2 * h1 * l1) + (m2 - 2 * h2 * l2) + (m3 - 2 * h3 * l3) + 2 * (h1 * (l1 - g1) + h2 * (l2 - g2) + h3 * (l3
        - g3)) - (g1 * g1 + g2 * g2 + g3 * g3)) by (rewrite I; ring).
    eapply Rle_trans; [apply Rabs_minus_le; [apply Rabs_plus_le; [apply Rabs_plus_le; [apply Rabs_plus_le; [apply
      Rabs_plus_le; [apply Rabs_plus_le; [apply Rabs_plus_le; [apply Rabs_plus_le; [apply Rabs_plus_le; [apply
        Rabs_plus_le; [apply Rabs_plus_le; [apply Rabs_plus_le; [apply Rabs_plus_le;
      [exact Kt1 | exact Ks1] | exact Ke1] | exact Kc1] | exact Ka1] | exact Kb1] | exact K1a] | exact K2a] | exact
        K3a] | exact M1a] | exact M2a] | exact M3a] | rewrite Rabs_mult, (Rabs_pos_eq 2) by lra; apply
          Rmult_le_compat_l; [lra | exact HD]] | exact GG]|].
    clear - Low HL HH Tiny T0 d1 d2 d3 hh1 hh2 hh3 r2 A0. rewrite u_val in *. lra. }
  assert (Fin : Rabs (kt + kc) <= (6201 / 100) * u * A).
  { replace (kt + kc) with ((kt + kc - f) + f) by ring. eapply Rle_trans; [apply Rabs_plus_le; [exact Bef | exact
    Hf]|]. clear - A0. rewrite u_val in *. lra. }
  destruct (Ua _ _ _ Kr Fin) as [Kr1 _]. replace (result - f) with ((result - (kt + kc)) + (kt + kc - f)) by ring.
  eapply Rle_trans; [apply Rabs_plus_le; [exact Kr1 | exact Bef]|]. unfold RESIDUAL_ERROR. clear - A0. rewrite u_val
    in *. lra.
Qed.
End Residual.
