(* rt-geom, enclosing/certify.rs, `reach`: how far a sphere reaches, in double-double,
  and what rounding up makes of it. *)
From Proofs Require Import Rounding ErrorFree Norm Spacing.
Open Scope R_scope.

(* The error of a reach, relative to it. *)
Definition REACH_ERROR := 128 * u * u.

(* A rounding, by what its argument is at most. *)
Lemma rounding : forall x k, Rabs x <= k -> Rabs (RN x - x) <= u * k + bp (-1075).
Proof.
  intros x k H. eapply Rle_trans; [apply RN_err|]. apply Rplus_le_compat_r, Rmult_le_compat_l; [apply Rlt_le, u_pos|].
  assumption.
Qed.
Lemma near_le : forall x y k, Rabs (x - y) <= k -> Rabs x <= Rabs y + k.
Proof.
  intros x y k H. replace x with (y + (x - y)) at 1 by ring. eapply Rle_trans; [apply Rabs_triang|]. lra.
Qed.

Section Axis.
(* a - b is h + l exactly; h^2 is p + e but for underflow *)
Variables a b e : R.
Hypotheses (Fa : F a) (Fb : F b).
Let h := RN (a - b). Let l := two_sum_error a (- b).
Let p := RN (h * h).
Hypothesis He : Rabs (p + e - h * h) <= bp (-1071).
Let g := RN (e + RN (2 * h * l)).
Lemma axis_exact : h + l = a - b /\ Rabs l <= u * Rabs h.
Proof.
  unfold h, l. replace (a - b) with (a + - b) by ring.
  split; [apply two_sum | apply two_sum_error_le]; auto using F_opp.
Qed.
Lemma axis_error : Rabs (g - (h * h - p + 2 * h * l + l * l)) <= (6 + / 100) * (u * u) * (h * h) + bp (-1065)
  /\ Rabs g <= (3 + / 100) * u * (h * h) + bp (-1065) /\ Rabs (p - h * h) <= u * (h * h) + bp (-1075).
Proof.
  destruct axis_exact as [_ L]. pose proof u_pos as U. pose proof (sq_pos h) as HH. set (n := h * h) in *.
  assert (P : Rabs (p - n) <= u * n + bp (-1075)).
  { eapply Rle_trans; [apply RN_err|]. fold n. rewrite (Rabs_pos_eq n) by assumption. lra. }
  assert (HL : Rabs (2 * h * l) <= 2 * u * n).
  { rewrite !Rabs_mult, (Rabs_pos_eq 2) by lra. apply Rle_trans with (2 * Rabs h * (u * Rabs h)).
    - apply Rmult_le_compat_l; [pose proof (Rabs_pos h); lra | assumption].
    - unfold n. rewrite <- (abs_sq h). right. ring. }
  assert (LL : Rabs (l * l) <= u * u * n).
  { rewrite Rabs_mult. apply Rle_trans with (u * Rabs h * (u * Rabs h)); [apply mul2; auto using Rabs_pos|].
    unfold n. rewrite <- (abs_sq h). right. ring. }
  pose proof (rounding _ _ HL) as R1. set (m := RN (2 * h * l)) in *.
  assert (T : bp (-1075) <= / 16 * bp (-1071)).
  { change (-1075)%Z with (-4 + -1071)%Z. rewrite bp_add. pose proof (bp_pos (-1071)). simpl (bp (-4)). lra. }
  assert (T2 : bp (-1071) <= / 64 * bp (-1065)).
  { change (-1071)%Z with (-6 + -1065)%Z. rewrite bp_add. pose proof (bp_pos (-1065)). simpl (bp (-6)). lra. }
  pose proof (bp_pos (-1071)) as T0.
  assert (E : Rabs e <= u * n + 2 * bp (-1071)).
  { replace e with ((p + e - n) - (p - n)) by ring. unfold Rminus at 1. eapply Rle_trans; [apply Rabs_triang|].
    rewrite Rabs_Ropp. lra. }
  assert (M : Rabs m <= 2 * u * n + (u * (2 * u * n) + bp (-1075))) by (eapply Rle_trans; [apply (near_le _ _ _ R1)|];
    lra).
  assert (EM : Rabs (e + m) <= (3 + / 1000) * u * n + 3 * bp (-1071)).
  { eapply Rle_trans; [apply Rabs_triang|]. rewrite u_val in *. lra. }
  pose proof (rounding _ _ EM) as R2. fold g in R2.
  split; [|split; [|assumption]].
  - replace (g - (n - p + 2 * h * l + l * l)) with ((g - (e + m)) + (m - 2 * h * l) + (p + e - n) + - (l * l)) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
    eapply Rle_trans; [apply Rplus_le_compat_r, Rplus_le_compat_r, Rabs_triang|]. rewrite Rabs_Ropp.
    replace (u * u * n) with (u * (u * n)) in * by ring.
    replace ((6 + / 100) * (u * u) * n) with ((6 + / 100) * (u * (u * n))) by ring.
    assert (0 <= u * n) by (apply Rmult_le_pos; lra). rewrite u_val in *. lra.
  - eapply Rle_trans; [apply (near_le _ _ _ R2)|]. assert (0 <= u * n) by (apply Rmult_le_pos; lra).
  rewrite u_val in *. lra.
Qed.
End Axis.

Section Reach.
(* the center, that of a sphere and its radius *)
Variables a1 a2 a3 b1 b2 b3 r e1 e2 e3 ae : R.
Hypotheses (Fa1 : F a1) (Fa2 : F a2) (Fa3 : F a3) (Fb1 : F b1) (Fb2 : F b2) (Fb3 : F b3) (Fr : F r) (Hr : 0 <= r).
Let h1 := RN (a1 - b1). Let h2 := RN (a2 - b2). Let h3 := RN (a3 - b3).
Let l1 := two_sum_error a1 (- b1). Let l2 := two_sum_error a2 (- b2). Let l3 := two_sum_error a3 (- b3).
Let p1 := RN (h1 * h1). Let p2 := RN (h2 * h2). Let p3 := RN (h3 * h3).
Hypotheses (He1 : Rabs (p1 + e1 - h1 * h1) <= bp (-1071)) (He2 : Rabs (p2 + e2 - h2 * h2) <= bp (-1071))
  (He3 : Rabs (p3 + e3 - h3 * h3) <= bp (-1071)).
Let g1 := RN (e1 + RN (2 * h1 * l1)). Let g2 := RN (e2 + RN (2 * h2 * l2)). Let g3 := RN (e3 + RN (2 * h3 * l3)).
Let s1 := RN (p1 + p2). Let f1 := two_sum_error p1 p2. Let s := RN (s1 + p3). Let f2 := two_sum_error s1 p3.
Let tail := RN (RN (g1 + g2) + RN (g3 + RN (f1 + f2))).
Let q := RN (sqrt s).
Let again := RN (q * q).
Hypothesis Hae : Rabs (again + ae - q * q) <= bp (-1071).
Let inverse := RN (/ q).
Let rest := RN (RN (RN (RN (s - again) - ae) + tail) * RN (inverse * / 2)).
Let S := (a1 - b1) * (a1 - b1) + (a2 - b2) * (a2 - b2) + (a3 - b3) * (a3 - b3).
Let N := h1 * h1 + h2 * h2 + h3 * h3.
(* The centers are not closer together than some 2^-350, where squares lose bits. *)
Hypothesis Hs : bp (-700) <= s <= bp 700.

Lemma s_pos : 0 < s. Proof. pose proof (bp_pos (-700)). lra. Qed.
Lemma tiny : forall k, (k <= -1000)%Z -> bp k <= / 100000000 * (u * u * s).
Proof.
  intros k H. apply Rle_trans with (bp (-40 + (-53 + -53 + -700))); [apply bp_le; lia|]. rewrite !bp_add. fold u.
  pose proof u_pos. assert (U2 : 0 < u * u) by (apply Rmult_lt_0_compat; lra).
  assert (u * u * bp (-700) <= u * u * s) by (apply Rmult_le_compat_l; lra).
  assert (bp (-40) <= / 100000000) by (simpl; lra). pose proof (bp_pos (-40)). 
  apply Rmult_le_compat; try lra. apply Rmult_le_pos; [lra | apply Rlt_le, bp_pos].
Qed.
Lemma Fp : F p1 /\ F p2 /\ F p3 /\ F s1 /\ F s. Proof. repeat split; apply RN_F. Qed.
Lemma p_pos : 0 <= p1 /\ 0 <= p2 /\ 0 <= p3 /\ 0 <= s1.
Proof.
  assert (P1 : 0 <= p1) by (unfold p1; rewrite <- RN_0; apply RN_le, sq_pos).
  assert (P2 : 0 <= p2) by (unfold p2; rewrite <- RN_0; apply RN_le, sq_pos).
  assert (P3 : 0 <= p3) by (unfold p3; rewrite <- RN_0; apply RN_le, sq_pos).
  repeat split; try assumption. unfold s1. rewrite <- RN_0. apply RN_le. lra.
Qed.
Lemma sum_exact : s + (f1 + f2) = p1 + p2 + p3 /\ Rabs f1 <= (1 + / 1000) * u * s /\ Rabs f2 <= u * s.
Proof.
  destruct Fp as (F1 & F2 & F3 & F4 & F5). destruct p_pos as (P1 & P2 & P3 & P4). pose proof s_pos as S0.
  pose proof (two_sum p1 p2 F1 F2) as T1. pose proof (two_sum s1 p3 F4 F3) as T2. fold s1 f1 in T1. fold s f2 in T2.
  destruct (two_sum_error_le p1 p2 F1 F2) as [_ L1]. destruct (two_sum_error_le s1 p3 F4 F3) as [_ L2].
  fold s1 f1 in L1. fold s f2 in L2. rewrite (Rabs_pos_eq s) in L2 by lra. rewrite (Rabs_pos_eq s1) in L1 by assumption.
  split; [lra|]. split; [|assumption]. assert (s1 <= (1 + 2 * u) * s).
  { pose proof (RN_sum s1 p3 F4 F3) as E. fold s in E.
    rewrite (Rabs_pos_eq (s1 + p3)) in E by lra. apply Rabs_le_inv in E.
    rewrite u_val in *. lra. }
  rewrite u_val in *. lra.
Qed.
Lemma N_le : N <= (1 + 4 * u) * s /\ 0 <= N.
Proof.
  pose proof s_pos as S0. destruct (axis_error a1 b1 e1 Fa1 Fb1 He1) as (_ & _ & A1).
  destruct (axis_error a2 b2 e2 Fa2 Fb2 He2) as (_ & _ & A2).
  destruct (axis_error a3 b3 e3 Fa3 Fb3 He3) as (_ & _ & A3).
  fold h1 p1 in A1. fold h2 p2 in A2. fold h3 p3 in A3. destruct sum_exact as (E & L1 & L2).
  pose proof (tiny (-1075) ltac:(lia)) as T. apply Rabs_le_inv in A1, A2, A3, L1, L2. unfold N.
  pose proof (sq_pos h1). pose proof (sq_pos h2). pose proof (sq_pos h3). rewrite u_val in *. split; lra.
Qed.
Let v := u * u * s.
Lemma tail_error : Rabs (s + tail - S) <= (186 / 10) * v /\ Rabs tail <= (51 / 10) * u * s.
Proof.
  destruct (axis_exact a1 b1 Fa1 Fb1) as [X1 _]. destruct (axis_exact a2 b2 Fa2 Fb2) as [X2 _].
  destruct (axis_exact a3 b3 Fa3 Fb3) as [X3 _]. fold h1 l1 in X1. fold h2 l2 in X2. fold h3 l3 in X3.
  destruct (axis_error a1 b1 e1 Fa1 Fb1 He1) as (A1 & B1 & _).
  destruct (axis_error a2 b2 e2 Fa2 Fb2 He2) as (A2 & B2 & _).
  destruct (axis_error a3 b3 e3 Fa3 Fb3 He3) as (A3 & B3 & _).
  fold h1 l1 in A1, B1. fold h2 l2 in A2, B2. fold h3 l3 in A3, B3. fold p1 g1 in A1, B1. fold p2 g2 in A2, B2.
  fold p3 g3 in A3, B3.
  destruct sum_exact as (E & L1 & L2). destruct N_le as [NL N0]. pose proof s_pos as S0. pose proof u_pos as U.
  pose proof (tiny (-1075) ltac:(lia)) as T. pose proof (tiny (-1065) ltac:(lia)) as T2.
  assert (V0 : 0 < v) by (unfold v; apply Rmult_lt_0_compat; [apply Rmult_lt_0_compat|]; lra). fold v in T, T2.
  assert (SV : v <= / 1000000 * (u * s)) by (unfold v; rewrite Rmult_assoc; apply Rmult_le_compat_r;
    [apply Rmult_le_pos; lra
    | rewrite u_val; lra]).
  set (n1 := h1 * h1) in *. set (n2 := h2 * h2) in *. set (n3 := h3 * h3) in *.
  assert (n10 : 0 <= n1) by apply sq_pos. assert (n20 : 0 <= n2) by apply sq_pos.
  assert (n30 : 0 <= n3) by apply sq_pos.
  assert (NN : n1 + n2 + n3 = N) by reflexivity.
  assert (C1 : Rabs (g1 + g2) <= (3 + / 100) * u * (n1 + n2) + 2 * bp (-1065)) by (eapply Rle_trans;
    [apply Rabs_triang|]; lra).
  pose proof (rounding _ _ C1) as R1. set (c1 := RN (g1 + g2)) in *.
  assert (C2 : Rabs (f1 + f2) <= (2 + / 500) * u * s) by (eapply Rle_trans; [apply Rabs_triang|]; lra).
  pose proof (rounding _ _ C2) as R2. set (c2 := RN (f1 + f2)) in *.
  assert (C2' : Rabs c2 <= (2 + / 400) * u * s) by (eapply Rle_trans; [apply (near_le _ _ _ R2)|]; rewrite u_val in *;
    lra).
  assert (C3 : Rabs (g3 + c2) <= (3 + / 100) * u * n3 + (2 + / 300) * u * s) by (eapply Rle_trans; [apply Rabs_triang|];
    rewrite u_val in *; lra).
  pose proof (rounding _ _ C3) as R3. set (c3 := RN (g3 + c2)) in *.
  assert (C1' : Rabs c1 <= (3 + / 50) * u * (n1 + n2) + / 1000 * (u * s)) by (eapply Rle_trans;
    [apply (near_le _ _ _ R1)|];
    rewrite u_val in *; lra).
  assert (C3' : Rabs c3 <= (3 + / 50) * u * n3 + (2 + / 200) * u * s) by (eapply Rle_trans; [apply (near_le _ _ _ R3)|];
    rewrite u_val in *; lra).
  assert (C4 : Rabs (c1 + c3) <= (504 / 100) * u * s) by (eapply Rle_trans; [apply Rabs_triang|]; rewrite <- NN in NL;
    rewrite u_val in *; lra).
  pose proof (rounding _ _ C4) as R4. fold tail in R4.
  split; [|eapply Rle_trans; [apply (near_le _ _ _ R4)|]; rewrite u_val in *; lra].
  assert (SE : S = (p1 + (n1 - p1 + 2 * h1 * l1 + l1 * l1)) + (p2 + (n2 - p2 + 2 * h2 * l2 + l2 * l2)) +
    (p3 + (n3 - p3 + 2 * h3 * l3 + l3 * l3))) by (unfold S; rewrite <- X1, <- X2, <- X3; unfold n1, n2, n3; ring).
  replace (s + tail - S) with ((tail - (c1 + c3)) + (c1 - (g1 + g2)) + (c3 - (g3 + c2)) + (c2 - (f1 + f2)) +
    (g1 - (n1 - p1 + 2 * h1 * l1 + l1 * l1)) + (g2 - (n2 - p2 + 2 * h2 * l2 + l2 * l2)) +
    (g3 - (n3 - p3 + 2 * h3 * l3 + l3 * l3))) by (rewrite SE; lra).
  clearbody tail c1 c2 c3. clear SE X1 X2 X3 C1 C2 C2' C3 C1' C3' C4.
  set (z1 := n1 - p1 + 2 * h1 * l1 + l1 * l1) in *. set (z2 := n2 - p2 + 2 * h2 * l2 + l2 * l2) in *.
  set (z3 := n3 - p3 + 2 * h3 * l3 + l3 * l3) in *. clearbody z1 z2 z3.
  apply Rabs_le_inv in A1, A2, A3, R1, R2, R3, R4. unfold v in *. apply Rabs_le. rewrite <- NN in NL.
  clear - A1 A2 A3 R1 R2 R3 R4 NL T T2 n10 n20 n30 S0.
  clearbody n1 n2 n3 g1 g2 g3 f1 f2 s p1 p2 p3. rewrite u_val in *. split; lra.
Qed.
(* the root *)
Let root := sqrt S.
Lemma q_near : Rabs (q - sqrt s) <= u * sqrt s /\ 0 < sqrt s /\ sqrt s * sqrt s = s /\ bp (-351) <= sqrt s.
Proof.
  pose proof s_pos as S0. assert (Q0 : 0 < sqrt s) by now apply sqrt_lt_R0.
  assert (QQ : sqrt s * sqrt s = s) by (apply sqrt_sqrt; lra).
  assert (L : bp (-351) <= sqrt s).
  { apply below_root; [lra|]. rewrite QQ, bp_sq. apply Rle_trans with (2 := proj1 Hs). apply bp_le. lia. }
  repeat split; try assumption. rewrite <- (Rabs_pos_eq (sqrt s)) at 2 by lra. apply RN_normal.
  rewrite Rabs_pos_eq by lra. apply Rle_trans with (2 := L). apply bp_le. lia.
Qed.
Lemma root_error : Rabs (q + rest - root) <= 34 * (u * u) * root /\ Rabs rest <= 4 * u * root /\ 0 < root /\
  Rabs (q - root) <= 4 * u * root.
Proof.
  destruct q_near as (E & Q0 & QQ & QL). destruct tail_error as [TE TL]. pose proof s_pos as S0. pose proof u_pos as U.
  set (y := sqrt s) in *. apply Rabs_le_inv in E as E'. assert (q0 : 0 < q) by (rewrite u_val in *; lra).
  assert (V0 : 0 < v) by (unfold v; apply Rmult_lt_0_compat; [apply Rmult_lt_0_compat|]; lra).
  assert (US : 0 < u * s) by now apply Rmult_lt_0_compat.
  assert (SV : v <= / 1000000 * (u * s)) by (unfold v; rewrite Rmult_assoc; apply Rmult_le_compat_r;
    [lra | rewrite u_val; lra]).
  pose proof (tiny (-1071) ltac:(lia)) as T. pose proof (tiny (-1075) ltac:(lia)) as T2. fold v in T, T2.
  (* s - q^2 *)
  assert (SQ : Rabs (s - q * q) <= (2 + / 1000) * u * s).
  { replace (s - q * q) with (- ((q - y) * (q + y))) by (rewrite <- QQ; ring). rewrite Rabs_Ropp, Rabs_mult.
    rewrite (Rabs_pos_eq (q + y)) by lra. apply Rle_trans with (u * y * ((2 + u) * y)).
    - apply mul2; split; auto using Rabs_pos; lra.
    - replace (u * y * ((2 + u) * y)) with (u * (2 + u) * (y * y)) by ring. rewrite QQ. rewrite u_val in *. lra. }
  assert (AG : Rabs (again - q * q) <= (1 + / 1000) * u * s).
  { eapply Rle_trans; [apply RN_err|]. rewrite Rabs_pos_eq by apply sq_pos. apply Rabs_le_inv in SQ.
    rewrite u_val in *. lra. }
  assert (SA : Rabs (s - again) <= (3 + / 400) * u * s).
  { replace (s - again) with ((s - q * q) - (again - q * q)) by ring. unfold Rminus at 1.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. lra. }
  pose proof (rounding _ _ SA) as R1. set (c1 := RN (s - again)) in *.
  assert (D1 : Rabs (c1 - ae - (s - q * q)) <= (301 / 100) * v).
  { replace (c1 - ae - (s - q * q)) with ((c1 - (s - again)) - (again + ae - q * q)) by ring. unfold Rminus at 1.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp.
    replace (u * ((3 + / 400) * u * s)) with ((3 + / 400) * v) in R1
      by (unfold v; ring). lra. }
  assert (D2 : Rabs (c1 - ae) <= (2 + / 500) * u * s) by (eapply Rle_trans; [apply (near_le _ _ _ D1)|]; lra).
  pose proof (rounding _ _ D2) as R2. set (c2 := RN (c1 - ae)) in *.
  assert (D3 : Rabs (c2 - (s - q * q)) <= (502 / 100) * v).
  { replace (c2 - (s - q * q)) with ((c2 - (c1 - ae)) + (c1 - ae - (s - q * q))) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. replace (u * ((2 + / 500) * u * s)) with ((2
      + / 500) * v) in R2 by (unfold v; ring).
    lra. }
  assert (D4 : Rabs (c2 + tail) <= (711 / 100) * u * s).
  { eapply Rle_trans; [apply Rabs_triang|]. pose proof (near_le _ _ _ D3). lra. }
  pose proof (rounding _ _ D4) as R3. set (c3 := RN (c2 + tail)) in *.
  assert (D5 : Rabs (c3 - (S - q * q)) <= (308 / 10) * v).
  { replace (c3 - (S - q * q)) with ((c3 - (c2 + tail)) + (c2 - (s - q * q)) + (s + tail - S)) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
    replace (u * ((711 / 100) * u * s)) with ((711 / 100) * v) in R3 by (unfold v; ring). lra. }
  assert (D6 : Rabs c3 <= (712 / 100) * u * s).
  { eapply Rle_trans; [apply (near_le _ _ _ R3)|].
  replace (u * ((711 / 100) * u * s)) with ((711 / 100) * v) by (unfold v; ring).
    lra. }
  (* the root exactly *)
  assert (SS : Rabs (S - s) <= (52 / 10) * u * s).
  { replace (S - s) with (tail - (s + tail - S)) by ring. unfold Rminus at 1. eapply Rle_trans; [apply Rabs_triang|].
    rewrite Rabs_Ropp. lra. }
  assert (Sp : 0 < S) by (apply Rabs_le_inv in SS; rewrite u_val in *; lra).
  assert (root0 : 0 < root) by now apply sqrt_lt_R0. assert (RR : root * root = S) by (apply sqrt_sqrt; lra).
  assert (RY : Rabs (root - y) <= (27 / 10) * u * y).
  { assert (yr : 99 / 100 * y <= root). { apply below_root; [lra|]. rewrite RR. apply Rabs_le_inv in SS.
      rewrite <- QQ in SS at 1. replace (99 / 100 * y * (99 / 100 * y)) with (9801 / 10000 * (y * y)) by field.
      rewrite QQ.
      rewrite u_val in *. lra. }
    apply Rmult_le_reg_r with (199 / 100 * y); [lra|].
    apply Rle_trans with (Rabs (root - y) * (root + y)); [apply Rmult_le_compat_l; [apply Rabs_pos | lra]|].
    rewrite <- (Rabs_pos_eq (root + y)) by lra. rewrite <- Rabs_mult. replace ((root - y) * (root + y)) with (S - s) by
      (rewrite <- RR, <- QQ; ring). replace ((27 / 10) * u * y * (199 / 100 * y)) with ((27 / 10) * (199 / 100) * u *
        (y * y)) by ring.
    rewrite QQ. lra. }
  apply Rabs_le_inv in RY as RY'.
  assert (QR : Rabs (q - root) <= (375 / 100) * u * root).
  { replace (q - root) with ((q - y) - (root - y)) by ring. unfold Rminus at 1. eapply Rle_trans; [apply Rabs_triang|].
    rewrite Rabs_Ropp. rewrite u_val in *. lra. }
  apply Rabs_le_inv in QR as QR'.
  (* in units of root *)
  assert (VR : v <= (1 + 6 * u) * (u * u) * (root * root)).
  { rewrite RR. unfold v. replace ((1 + 6 * u) * (u * u) * S) with (u * u * ((1 + 6 * u) * S)) by ring.
    apply Rmult_le_compat_l; [apply Rmult_le_pos; lra|]. apply Rabs_le_inv in SS. rewrite u_val in *. lra. }
  assert (IQ : Rabs (inverse - / q) <= u * / q).
  { assert (0 < / q) by now apply Rinv_0_lt_compat. rewrite <- (Rabs_pos_eq (/ q)) at 2 by lra.
    apply RN_normal. rewrite Rabs_pos_eq by lra. apply Rle_trans with (bp (-400)); [apply bp_le; lia|].
    change (-400)%Z with (Z.opp 400). rewrite bpow_opp. apply Rinv_le_contravar; [assumption|].
    assert (Y1 : y <= bp 350) by (apply below_root; [apply Rlt_le, bp_pos|]; rewrite QQ, bp_sq; apply Hs).
    assert (bp 351 = 2 * bp 350) by (change 351%Z with (1 + 350)%Z; rewrite bp_add, bp_1; ring).
    assert (bp 351 <= bp 400) by (apply bp_le; lia). pose proof (bp_pos 350). rewrite u_val in *. lra. }
  set (iq := / (2 * q)). assert (iq0 : 0 < iq) by (apply Rinv_0_lt_compat; lra).
  assert (qi : q * iq = / 2) by (unfold iq; field; lra).
  pose proof (RN_err (inverse * / 2)) as R4. set (w := RN (inverse * / 2)) in *.
  assert (W1 : Rabs (inverse * / 2 - iq) <= u * iq).
  { replace (inverse * / 2 - iq) with ((inverse - / q) * / 2) by (unfold iq; field; lra).
    rewrite Rabs_mult, (Rabs_pos_eq (/ 2)) by lra. replace (u * iq) with (u * / q * / 2) by (unfold iq; field; lra).
    apply Rmult_le_compat_r; lra. }
  assert (IL : bp (-400) <= iq).
  { unfold iq. change (-400)%Z with (Z.opp 400). rewrite bpow_opp. apply Rinv_le_contravar; [lra|].
    assert (Y1 : y <= bp 350) by (apply below_root; [apply Rlt_le, bp_pos|]; rewrite QQ, bp_sq; apply Hs).
    assert (bp 352 = 4 * bp 350) by (change 352%Z with (2 + 350)%Z; rewrite bp_add; simpl (bp 2); lra).
    assert (bp 352 <= bp 400) by (apply bp_le; lia). pose proof (bp_pos 350). rewrite u_val in *. lra. }
  assert (T3 : bp (-1075) <= / 1000000 * (u * iq)).
  { apply Rle_trans with (bp (-40 + (-53 + -400))); [apply bp_le; lia|]. rewrite !bp_add. fold u.
    assert (u * bp (-400) <= u * iq) by (apply Rmult_le_compat_l; lra). assert (bp (-40) <= / 1000000) by (simpl; lra).
    pose proof (bp_pos (-40)). pose proof (bp_pos (-400)). apply Rmult_le_compat; try lra. apply Rmult_le_pos; lra. }
  assert (W2 : Rabs (w - iq) <= (2 + / 1000) * u * iq).
  { assert (Rabs (inverse * / 2) <= (1 + u) * iq) by (eapply Rle_trans; [apply (near_le _ _ _ W1)|]; rewrite
      (Rabs_pos_eq iq); lra).
    replace (w - iq) with ((w - inverse * / 2) + (inverse * / 2 - iq)) by ring. eapply Rle_trans; [apply Rabs_triang|].
    rewrite u_val in *. lra. }
  (* s / 2q *)
  assert (K : s * iq <= (1 + 8 * u) * / 2 * root /\ 0 <= s * iq).
  { split; [|apply Rmult_le_pos; lra]. apply Rle_trans with ((1 + 3 * u) * q * q * iq).
    - apply Rmult_le_compat_r; [lra|]. rewrite <- QQ.
    apply Rle_trans with (((1 + (11 / 10) * u) * q) * ((1 + (11 / 10) * u) * q)).
      + apply mul2; split; try lra; rewrite u_val in *; lra.
      + replace ((1 + (11 / 10) * u) * q * ((1 + (11 / 10) * u) * q)) with ((1 + (11 / 10) * u) * (1
        + (11 / 10) * u) * (q * q)) by ring.
        rewrite (Rmult_assoc (1 + 3 * u)). apply Rmult_le_compat_r; [apply sq_pos | rewrite u_val; lra].
    - replace ((1 + 3 * u) * q * q * iq) with ((1 + 3 * u) * q * (q * iq)) by ring. rewrite qi. rewrite u_val in *.
    lra. }
  destruct K as [K K0]. set (k := s * iq) in *.
  assert (G1 : Rabs c3 * iq <= (357 / 100) * u * root).
  { apply Rle_trans with ((712 / 100) * u * s * iq); [apply Rmult_le_compat_r; lra|].
    replace ((712 / 100) * u * s * iq) with ((712 / 100) * u * k) by (unfold k; ring). rewrite u_val in *. lra. }
  assert (UR : 0 < u * root) by now apply Rmult_lt_0_compat.
  assert (G2 : Rabs (c3 * w - c3 * iq) <= (72 / 10) * (u * (u * root))).
  { replace (c3 * w - c3 * iq) with (c3 * (w - iq)) by ring. rewrite Rabs_mult.
    apply Rle_trans with (Rabs c3 * ((2 + / 1000) * u * iq)); [apply Rmult_le_compat_l; [apply Rabs_pos | assumption]|].
    replace (Rabs c3 * ((2 + / 1000) * u * iq)) with ((2 + / 1000) * u * (Rabs c3 * iq)) by ring.
    apply Rle_trans with ((2 + / 1000) * u * ((357 / 100) * u * root)); [apply Rmult_le_compat_l; lra|].
    replace ((2 + / 1000) * u * ((357 / 100) * u * root)) with ((2 + / 1000) * (357 / 100) * (u * (u * root))) by ring.
    assert (0 <= u * (u * root)) by (apply Rmult_le_pos; lra). lra. }
  assert (U2 : 0 <= u * (u * root)) by (apply Rmult_le_pos; lra).
  assert (U3 : u * (u * root) <= / 1000000 * (u * root)) by (apply Rmult_le_compat_r; [lra | rewrite u_val; lra]).
  assert (G3 : Rabs (c3 * w) <= (358 / 100) * u * root).
  { eapply Rle_trans; [apply (near_le _ _ _ G2)|]. rewrite Rabs_mult, (Rabs_pos_eq iq) by lra. lra. }
  pose proof (rounding _ _ G3) as R5. fold rest in R5.
  assert (T4 : bp (-1075) <= / 1000000 * (u * (u * root))).
  { apply Rle_trans with (bp (-40 + (-53 + (-53 + -400)))); [apply bp_le; lia|]. rewrite !bp_add. fold u.
    assert (bp (-400) <= root) by (apply Rle_trans with (bp (-352)); [apply bp_le; lia|];
      assert (bp (-351) = 2 * bp (-352)) by (change (-351)%Z with (1 + -352)%Z; rewrite bp_add, bp_1; ring);
      pose proof (bp_pos (-352)); rewrite u_val in *; lra).
    assert (u * (u * bp (-400)) <= u * (u * root)) by (apply Rmult_le_compat_l; [lra|]; apply Rmult_le_compat_l; lra).
    assert (bp (-40) <= / 1000000) by (simpl; lra). pose proof (bp_pos (-40)). pose proof (bp_pos (-400)).
    apply Rmult_le_compat; try lra. apply Rmult_le_pos; [lra|]. apply Rmult_le_pos; lra. }
  assert (G4 : Rabs (c3 * iq - (S - q * q) * iq) <= (155 / 10) * (u * (u * root))).
  { replace (c3 * iq - (S - q * q) * iq) with ((c3 - (S - q * q)) * iq) by ring.
  rewrite Rabs_mult, (Rabs_pos_eq iq) by lra.
    apply Rle_trans with ((308 / 10) * v * iq); [apply Rmult_le_compat_r; lra|].
    replace ((308 / 10) * v * iq) with ((308 / 10) * (u * (u * k))) by (unfold v, k; ring).
    assert (u * (u * k) <= u * (u * ((1 + 8 * u) * / 2 * root))) by (apply Rmult_le_compat_l; [lra|];
      apply Rmult_le_compat_l; lra).
    replace (u * (u * ((1 + 8 * u) * / 2 * root))) with ((1 + 8 * u) * / 2 * (u * (u * root))) in * by ring.
    rewrite u_val in *. lra. }
  assert (G5 : Rabs ((S - q * q) * iq - (root - q)) <= (71 / 10) * (u * (u * root))).
  { replace ((S - q * q) * iq - (root - q)) with ((q - root) * (q - root) * iq).
    - rewrite Rabs_mult, (Rabs_pos_eq iq) by lra. rewrite Rabs_mult.
      apply Rle_trans with ((375 / 100) * u * root * ((375 / 100) * u * root) * iq).
      + apply Rmult_le_compat_r; [lra|]. apply mul2; split; auto using Rabs_pos.
      + assert (RI : root * iq <= (1 + 5 * u) * / 2).
        { apply Rle_trans with ((1 + 5 * u) * q * iq); [apply Rmult_le_compat_r; [lra|]; rewrite u_val in *; lra|].
          rewrite Rmult_assoc, qi. lra. }
        replace ((375 / 100) * u * root * ((375 / 100) * u * root) * iq) with
          ((375 / 100) * (375 / 100) * (root * iq) * (u * (u * root))) by ring.
        apply Rmult_le_compat_r; [assumption|]. rewrite u_val in *. lra.
    - rewrite <- RR. replace ((root * root - q * q) * iq) with ((root - q) * ((root + q) * iq)) by ring.
      replace ((root + q) * iq) with (1 + (root - q) * iq) by (replace ((root + q) * iq) with ((root - q) * iq
        + 2 * (q * iq)) by ring;
        rewrite qi; field). ring. }
  replace (u * ((358 / 100) * u * root)) with ((358 / 100) * (u * (u * root))) in R5 by ring.
  replace (34 * (u * u) * root) with (34 * (u * (u * root))) by ring. split; [|split; [|split]].
  - replace (q + rest - root) with ((rest - c3 * w) + (c3 * w - c3 * iq) + (c3 * iq - (S - q * q) * iq)
    + ((S - q * q) * iq -
      (root - q))) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
    eapply Rle_trans; [apply Rplus_le_compat_r, Rplus_le_compat_r, Rabs_triang|]. lra.
  - eapply Rle_trans; [apply (near_le _ _ _ R5)|]. lra.
  - assumption.
  - lra.
Qed.

(* ---- The reach and what is made of it ---- *)
Let high := RN (q + r). Let first := RN (two_sum_error q r + rest).
Let sum := RN (high + first). Let low := fast_two_sum_error high first.
Let error := RN (sum * REACH_ERROR).
Let reach := root + r.
Lemma reach_bracketed : sum + RN (low - error) <= reach <= sum + RN (low + error) /\ F sum /\
  Rabs (RN (low - error)) <= / 1000 * sum /\ Rabs (RN (low + error)) <= / 1000 * sum /\ bp (-360) <= sum.
Proof.
  destruct root_error as (E & L & R0 & QR). destruct q_near as (E1 & Q0 & QQ & QL). pose proof u_pos as U.
  assert (Fq : F q) by apply RN_F. pose proof (two_sum q r Fq Fr) as T. destruct (two_sum_error_le q r Fq Fr) as [_ TL].
  fold high in T, TL. set (t := two_sum_error q r) in *. apply Rabs_le_inv in QR as QR'.
  assert (q0 : 0 < q) by (rewrite u_val in *; lra). assert (M0 : 0 < reach) by (unfold reach; lra).
  assert (HN : Rabs (high - (q + r)) <= u * (q + r)).
  { rewrite <- (Rabs_pos_eq (q + r)) at 2 by lra. now apply RN_sum. }
  assert (QM : q + r <= (1 + 4 * u) * reach) by (unfold reach; rewrite u_val in *; lra).
  assert (QM2 : (1 - 4 * u) * reach <= q + r) by (unfold reach; rewrite u_val in *; lra).
  apply Rabs_le_inv in HN. assert (H0 : (1 - 6 * u) * reach <= high) by (rewrite u_val in *; lra).
  assert (H1 : high <= (1 + 6 * u) * reach) by (rewrite u_val in *; lra).
  assert (Hp : 0 < high) by (rewrite u_val in *; lra).
  rewrite (Rabs_pos_eq high) in TL by lra. assert (RM : root <= reach) by (unfold reach; lra).
  assert (UM : 0 < u * reach) by now apply Rmult_lt_0_compat. set (z := u * (u * reach)).
  assert (z0 : 0 < z) by now apply Rmult_lt_0_compat.
  assert (zs : z <= / 1000000 * (u * reach)) by (apply Rmult_le_compat_r; [lra | rewrite u_val; lra]).
  assert (Lr : bp (-352) <= root).
  { assert (bp (-351) = 2 * bp (-352)) by (change (-351)%Z with (1 + -352)%Z; rewrite bp_add, bp_1; ring).
    pose proof (bp_pos (-352)). apply Rabs_le_inv in E1. rewrite u_val in *. lra. }
  assert (TZ : bp (-1075) <= / 1000000 * z).
  { apply Rle_trans with (bp (-40 + (-53 + (-53 + -352)))); [apply bp_le; lia|]. rewrite !bp_add. fold u.
    assert (u * (u * bp (-352)) <= z) by (unfold z; apply Rmult_le_compat_l; [lra|]; apply Rmult_le_compat_l; lra).
    assert (bp (-40) <= / 1000000) by (simpl; lra). pose proof (bp_pos (-40)). pose proof (bp_pos (-352)).
    apply Rmult_le_compat; try lra. apply Rmult_le_pos; [lra|]. apply Rmult_le_pos; lra. }
  assert (UR : u * root <= u * reach) by (apply Rmult_le_compat_l; lra).
  assert (TL2 : Rabs t <= (1 + / 1000) * (u * reach)).
  { assert (u * high <= u * ((1 + 6 * u) * reach)) by (apply Rmult_le_compat_l; lra).
    replace (u * ((1 + 6 * u) * reach)) with ((1 + 6 * u) * (u * reach)) in * by ring. rewrite u_val in *. lra. }
  assert (F1 : Rabs (t + rest) <= (5 + / 500) * (u * reach)) by (eapply Rle_trans; [apply Rabs_triang|]; lra).
  pose proof (rounding _ _ F1) as R1. fold first in R1.
  replace (u * ((5 + / 500) * (u * reach))) with ((5 + / 500) * z) in R1 by (unfold z; ring).
  assert (F2 : Rabs first <= (51 / 10) * (u * reach)) by (eapply Rle_trans; [apply (near_le _ _ _ R1)|]; lra).
  assert (UZ : u * (u * root) <= z) by (apply Rmult_le_compat_l; lra).
  replace (34 * (u * u) * root) with (34 * (u * (u * root))) in E by ring.
  assert (V : Rabs (high + first - reach) <= (391 / 10) * z).
  { replace (high + first - reach) with ((first - (t + rest)) + (q + rest - root)) by (unfold reach; lra).
    eapply Rle_trans; [apply Rabs_triang|]. lra. }
  assert (Fh : F high) by apply RN_F. assert (Ff : F first) by apply RN_F.
  assert (FH : Rabs first <= Rabs high) by (rewrite (Rabs_pos_eq high) by lra; rewrite u_val in *; lra).
  pose proof (fast_two_sum high first Fh Ff FH) as X. fold sum low in X.
  pose proof (RN_sum high first Fh Ff) as SN. fold sum in SN. apply Rabs_le_inv in F2.
  rewrite (Rabs_pos_eq (high + first)) in SN by (rewrite u_val in *; lra). apply Rabs_le_inv in SN.
  assert (S0 : (1 - 14 * u) * reach <= sum <= (1 + 14 * u) * reach) by (rewrite u_val in *; lra).
  assert (S1 : 0 < sum) by (rewrite u_val in *; lra).
  assert (LL : Rabs low <= (1 + / 1000) * (u * reach)).
  { replace low with (high + first - sum) by lra. apply Rabs_le. rewrite u_val in *. lra. }
  pose proof (RN_err (sum * REACH_ERROR)) as ER. fold error in ER. unfold REACH_ERROR in ER.
  replace (sum * (128 * u * u)) with (128 * (u * (u * sum))) in ER by ring.
  assert (US : (1 - 14 * u) * z <= u * (u * sum) <= (1 + 14 * u) * z).
  { unfold z. replace ((1 - 14 * u) * (u * (u * reach))) with (u * (u * ((1 - 14 * u) * reach))) by ring.
    replace ((1 + 14 * u) * (u * (u * reach))) with (u * (u * ((1 + 14 * u) * reach))) by ring.
    split; apply Rmult_le_compat_l; try lra; apply Rmult_le_compat_l; lra. }
  rewrite (Rabs_pos_eq (128 * (u * (u * sum)))) in ER by (rewrite u_val in *; lra). apply Rabs_le_inv in ER.
  assert (E0 : (128 - / 1000) * z <= error <= (128 + / 1000) * z) by (rewrite u_val in *; lra).
  assert (D1 : Rabs (low - error) <= (1 + / 500) * (u * reach)).
  { unfold Rminus. eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp, (Rabs_pos_eq error) by lra. lra. }
  assert (D2 : Rabs (low + error) <= (1 + / 500) * (u * reach)).
  { eapply Rle_trans; [apply Rabs_triang|]. rewrite (Rabs_pos_eq error) by lra. lra. }
  pose proof (rounding _ _ D1) as R2. pose proof (rounding _ _ D2) as R3.
  replace (u * ((1 + / 500) * (u * reach))) with ((1 + / 500) * z) in R2, R3 by (unfold z; ring).
  apply Rabs_le_inv in V. pose proof (near_le _ _ _ R2) as N2. pose proof (near_le _ _ _ R3) as N3.
  apply Rabs_le_inv in R2. apply Rabs_le_inv in R3.
  split; [lra|]. split; [apply RN_F|]. split; [rewrite u_val in *; lra|]. split; [rewrite u_val in *; lra|].
  assert (bp (-360) <= / 2 * bp (-352)) by (apply Rle_trans with (bp (-1 + -352)); [apply bp_le; lia|]; rewrite bp_add;
    pose proof (bp_pos (-352)); simpl (bp (-1)); lra). pose proof (bp_pos (-352)). rewrite u_val in *. lra.
Qed.
(* The upper end encloses the sphere, and no double below the lower end does. *)
Lemma reach_rounded : reach <= rounded_up sum (RN (low + error)) /\
  forall R, F R -> reach <= R -> rounded_up sum (RN (low - error)) <= R.
Proof.
  destruct reach_bracketed as ([B1 B2] & Fs & L1 & L2 & S0). pose proof (bp_pos (-360)).
  assert (G : forall x, F x -> Rabs x <= / 1000 * sum -> Rabs x <= Rabs sum /\ bp (-900) <= RN (sum + x)).
  { intros x Fx Hx. split; [rewrite (Rabs_pos_eq sum) by lra; lra|].
  rewrite <- (RN_id (bp (-900))) by (apply F_bp; lia).
    apply RN_le. apply Rabs_le_inv in Hx. assert (bp (-900) <= / 2 * bp (-360)) by (apply Rle_trans with (bp (-1
      + -360));
      [apply bp_le; lia|]; rewrite bp_add; simpl (bp (-1)); lra). lra. }
  destruct (G _ (RN_F (low + error)) L2) as [G1 G2]. destruct (G _ (RN_F (low - error)) L1) as [G3 G4].
  destruct (round_up sum _ Fs (RN_F _) G1 G2) as (_ & U1 & _).
  destruct (round_up sum _ Fs (RN_F _) G3 G4) as (_ & _ & U2).
  split; [lra|]. intros R FR HR. apply U2; [assumption | lra].
Qed.
End Reach.

(* In the words of the code: the reach of a sphere lies within the error of the sum of two doubles;
  the first end rounded
   up is at most every double that encloses it, the second one encloses it. *)
Theorem REACH_ERROR_holds : forall a1 a2 a3 b1 b2 b3 r e1 e2 e3 ae,
  F a1 -> F a2 -> F a3 -> F b1 -> F b2 -> F b3 -> F r -> 0 <= r ->
  let h1 := RN (a1 - b1) in let h2 := RN (a2 - b2) in let h3 := RN (a3 - b3) in
  let p1 := RN (h1 * h1) in let p2 := RN (h2 * h2) in let p3 := RN (h3 * h3) in
  let s1 := RN (p1 + p2) in let s := RN (s1 + p3) in let q := RN (sqrt s) in let again := RN (q * q) in
  Rabs (p1 + e1 - h1 * h1) <= bp (-1071) -> Rabs (p2 + e2 - h2 * h2) <= bp (-1071) ->
  Rabs (p3 + e3 - h3 * h3) <= bp (-1071) -> Rabs (again + ae - q * q) <= bp (-1071) -> bp (-700) <= s <= bp 700 ->
  let g1 := RN (e1 + RN (2 * h1 * two_sum_error a1 (- b1))) in
  let g2 := RN (e2 + RN (2 * h2 * two_sum_error a2 (- b2))) in
  let g3 := RN (e3 + RN (2 * h3 * two_sum_error a3 (- b3))) in
  let tail := RN (RN (g1 + g2) + RN (g3 + RN (two_sum_error p1 p2 + two_sum_error s1 p3))) in
  let rest := RN (RN (RN (RN (s - again) - ae) + tail) * RN (RN (/ q) * / 2)) in
  let high := RN (q + r) in let first := RN (two_sum_error q r + rest) in
  let sum := RN (high + first) in let low := fast_two_sum_error high first in let error := RN (sum * REACH_ERROR) in
  let reach := sqrt ((a1 - b1) * (a1 - b1) + (a2 - b2) * (a2 - b2) + (a3 - b3) * (a3 - b3)) + r in
  reach <= rounded_up sum (RN (low + error)) /\ forall R, F R -> reach <= R -> rounded_up sum (RN (low - error)) <= R.
Proof. intros. now apply reach_rounded. Qed.
