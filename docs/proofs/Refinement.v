(* rt-geom, triangle/finish.rs: the rest of a solution of the line, and the step that solves for it. *)
From Proofs Require Import Rounding ErrorFree DoubleDouble Steps.
Open Scope R_scope.

(* The error of a component of the rest, relative to the size of the coordinates. *)
Definition REST_ERROR := 136 * u * u.
(* The error of solving, relative to the rest and the steepness. *)
Definition SOLUTION_ERROR := 21 * u.
(* The factor of the first weight's bound. *)
Definition FIRST_WEIGHT := 25 / 10.
(* Weights from here on have a second step. *)
Definition LEAST_WEIGHT := - 1 / 4.

(* Weights of at least -1/4 that sum to 1, up to two roundings: what they weigh is at most 2.1 of the largest. *)
Theorem LEAST_WEIGHT_holds : forall al be ga a b c x, LEAST_WEIGHT <= al -> LEAST_WEIGHT <= be -> LEAST_WEIGHT <= ga
  -> Rabs (al + be + ga - 1) <= 4 * u ->
  Rabs a <= x -> Rabs b <= x -> Rabs c <= x ->
  Rabs (al * a) + Rabs (be * b) + Rabs (ga * c) <= (201 / 100) * x /\ Rabs al <= 151 / 100 /\ Rabs be <= 151 / 100 /\
    Rabs ga <= 151 / 100.
Proof.
  intros al be ga a b c x A B G S Ha Hb Hc. unfold LEAST_WEIGHT in *. apply Rabs_le_inv in S. pose proof (Rabs_pos a).
    assert (x0 : 0 <= x) by lra.
  assert (W : Rabs al + Rabs be + Rabs ga <= 201 / 100) by (rewrite u_val in *; unfold Rabs; repeat destruct
    Rcase_abs; lra).
  split; [|rewrite u_val in *; unfold Rabs; repeat destruct Rcase_abs; lra].
  rewrite !Rabs_mult. apply Rle_trans with (Rabs al * x + Rabs be * x + Rabs ga * x).
  - repeat apply Rplus_le_compat; apply Rmult_le_compat_l; try apply Rabs_pos; assumption.
  - replace (Rabs al * x + Rabs be * x + Rabs ga * x) with ((Rabs al + Rabs be + Rabs ga) * x) by ring. apply
    Rmult_le_compat_r; assumption.
Qed.

(* A component of the rest o + t d - al a - be b - ga c - missing a. *)
Section Component.
(* the exact products pt = t d, pa = al a, pb, pc; as computed with their errors; missing = 1 - al - be - ga and as
  computed *)
Variables o a pt pa pb pc td aa bb cc td' aa' bb' cc' missing m' X : R.
Hypotheses (Fo : F o) (Ft : F td) (Fa : F aa) (Fb : F bb) (Fc : F cc) (Ft' : F td') (Fa' : F aa') (Fb' : F bb') (Fc' :
  F cc')
  (Et : td + td' = pt) (Ea : aa + aa' = pa) (Eb : bb + bb' = pb) (Ec : cc + cc' = pc)
  (Bt : Rabs td' <= u * Rabs pt) (Ba : Rabs aa' <= u * Rabs pa) (Bb : Rabs bb' <= u * Rabs pb) (Bc : Rabs cc' <= u *
    Rabs pc)
  (Bp : Rabs pa + Rabs pb + Rabs pc <= (201 / 100) * X) (Bo : Rabs o <= (1 + 2 * u) * X) (BA : Rabs a <= X)
  (Bm : Rabs missing <= 3 * u) (Bm' : Rabs (m' - missing) <= 3 * (u * u)) (Tiny : bp (-1075) <= / 1000 * (u * u) * X).
Let point := RN (o + td). Let e1 := two_sum_error o td.
Let two := RN (bb + cc). Let e2 := two_sum_error bb cc.
Let three := RN (two + aa). Let e3 := two_sum_error two aa.
Let low := RN (RN (td' - aa') - RN (bb' + cc')).
Let ma := RN (m' * a).
Let r := RN (RN (point - three) + RN (RN (RN (e1 - e2) - e3) + RN (low - ma))).
Let R := o + pt - pa - pb - pc - missing * a.

Lemma rest_near : Rabs (r - R) <= 72 * (u * u) * X + (201 / 100) * u * Rabs R.
Proof.
  pose proof u_pos as up. assert (X0 : 0 <= X) by (pose proof (Rabs_pos a); lra). pose proof (bp_pos (-1075)) as P0.
  pose proof (two_sum o td Fo Ft) as T1. pose proof (two_sum bb cc Fb Fc) as T2. pose proof (two_sum two aa (RN_F _)
    Fa) as T3.
  fold point e1 in T1. fold two e2 in T2. fold three e3 in T3.
  destruct (two_sum_error_le o td Fo Ft) as [E1 _]. destruct (two_sum_error_le bb cc Fb Fc) as [E2 _]. destruct
    (two_sum_error_le two aa (RN_F _) Fa) as [E3 _].
  fold e1 in E1. fold e2 in E2. fold e3 in E3. set (q := Rabs R) in *. assert (q0 : 0 <= q) by apply Rabs_pos.
  pose proof (Rabs_pos pa) as pa0. pose proof (Rabs_pos pb) as pb0. pose proof (Rabs_pos pc) as pc0.
  assert (MA : Rabs (missing * a) <= 3 * u * X) by (apply Rabs_mult_le; assumption).
  assert (PT : Rabs pt <= (302 / 100) * X + q).
  { replace pt with (R - o + (pa + pb + pc) + missing * a) by (unfold R; ring).
    eapply Rle_trans; [apply Rabs_plus_le; [apply Rabs_plus_le; [apply Rabs_minus_le; [apply Rle_refl | exact Bo] |
      apply Rabs_plus_le; [apply Rabs_triang | apply Rle_refl]] | exact MA]|].
    fold q. rewrite u_val in *. lra. }
  assert (TD : Rabs (o + td) <= (403 / 100) * X + (1 + 2 * u) * q).
  { replace (o + td) with (o + pt - td') by lra. eapply Rle_trans; [apply Rabs_minus_le; [apply Rabs_triang | exact
    Bt]|]. rewrite u_val in *. lra. }
  assert (BC : Rabs (bb + cc) <= (1 + u) * (Rabs pb + Rabs pc)).
  { replace (bb + cc) with (pb + pc - bb' - cc') by lra. eapply Rle_trans; [apply Rabs_minus_le; [apply Rabs_minus_le;
    [apply Rabs_triang | exact Bb] | exact Bc]|]. lra. }
  assert (e2B : Rabs e2 <= (1 + u) * u * (Rabs pb + Rabs pc)) by (eapply Rle_trans; [exact E2|]; apply Rle_trans with
    (u * ((1 + u) * (Rabs pb + Rabs pc))); [apply Rmult_le_compat_l; lra | lra]).
  assert (TA : Rabs (two + aa) <= (202 / 100) * X).
  { replace (two + aa) with ((bb + cc) - e2 + (pa - aa')) by lra. eapply Rle_trans; [apply Rabs_plus_le; [apply
    Rabs_minus_le; [exact BC | exact e2B] | apply Rabs_minus_le; [apply Rle_refl | exact Ba]]|].
    clear - Bp pa0 pb0 pc0 X0 up. rewrite u_val in *. lra. }
  assert (e1B : Rabs e1 <= u * ((403 / 100) * X + (1 + 2 * u) * q)) by (eapply Rle_trans; [exact E1|]; apply
    Rmult_le_compat_l; lra).
  assert (e3B : Rabs e3 <= u * ((202 / 100) * X)) by (eapply Rle_trans; [exact E3|]; apply Rmult_le_compat_l; lra).
  assert (e2B' : Rabs e2 <= (202 / 100) * u * X) by (clear - e2B Bp pa0 pb0 pc0 X0; rewrite u_val in *; lra).
  assert (tB : Rabs td' <= u * ((302 / 100) * X + q)) by (eapply Rle_trans; [exact Bt|]; apply Rmult_le_compat_l; lra).
  assert (abc : Rabs aa' + Rabs bb' + Rabs cc' <= (201 / 100) * u * X) by (clear - Ba Bb Bc Bp; rewrite u_val in *;
    lra).
  pose proof (Rabs_pos aa') as a0. pose proof (Rabs_pos bb') as b0. pose proof (Rabs_pos cc') as c0.
  (* the roundings *)
  pose proof (RN_diff td' aa' Ft' Fa') as R1. set (y1 := RN (td' - aa')) in *. pose proof (RN_sum bb' cc' Fb' Fc') as
    R2. set (y2 := RN (bb' + cc')) in *.
  pose proof (RN_diff y1 y2 (RN_F _) (RN_F _)) as R3. fold low in R3. pose proof (RN_err (m' * a)) as R4. fold ma in R4.
  pose proof (RN_diff low ma (RN_F _) (RN_F _)) as R5. set (y5 := RN (low - ma)) in *.
  pose proof (RN_diff e1 e2 (two_sum_error_F _ _) (two_sum_error_F _ _)) as R6. set (y6 := RN (e1 - e2)) in *.
  pose proof (RN_diff y6 e3 (RN_F _) (two_sum_error_F _ _)) as R7. set (y7 := RN (y6 - e3)) in *.
  pose proof (RN_sum y7 y5 (RN_F _) (RN_F _)) as R8. set (y8 := RN (y7 + y5)) in *.
  pose proof (RN_diff point three (RN_F _) (RN_F _)) as R9. set (y9 := RN (point - three)) in *.
  pose proof (RN_sum y9 y8 (RN_F _) (RN_F _)) as R10. fold r in R10.
  assert (S1 : Rabs (td' - aa') <= u * ((302 / 100) * X + q) + Rabs aa') by (apply Rabs_minus_le; [exact tB | apply
    Rle_refl]).
  assert (S2 : Rabs (bb' + cc') <= Rabs bb' + Rabs cc') by apply Rabs_triang.
  assert (U1 : Rabs (y1 - (td' - aa')) <= u * (u * ((302 / 100) * X + q) + Rabs aa')) by (eapply Rle_trans; [exact
    R1|]; apply Rmult_le_compat_l; lra).
  assert (U2 : Rabs (y2 - (bb' + cc')) <= u * (Rabs bb' + Rabs cc')) by (eapply Rle_trans; [exact R2|]; apply
    Rmult_le_compat_l; lra).
  assert (S3 : Rabs (y1 - y2) <= (504 / 100) * u * X + (1 + 2 * u) * u * q).
  { replace (y1 - y2) with ((y1 - (td' - aa')) + (td' - aa') - ((y2 - (bb' + cc')) + (bb' + cc'))) by ring.
    eapply Rle_trans; [apply Rabs_minus_le; [apply Rabs_plus_le; [exact U1 | exact S1] | apply Rabs_plus_le; [exact U2
      | exact S2]]|]. clear - abc a0 b0 c0 X0 q0. rewrite u_val in *. lra. }
  assert (U3 : Rabs (low - (y1 - y2)) <= u * ((504 / 100) * u * X + (1 + 2 * u) * u * q)) by (eapply Rle_trans; [exact
    R3|]; apply Rmult_le_compat_l; lra).
  assert (S4 : Rabs (m' * a) <= (301 / 100) * u * X).
  { apply Rabs_mult_le; [|exact BA]. replace m' with ((m' - missing) + missing) by ring. eapply Rle_trans; [apply
    Rabs_plus_le; eassumption|]. rewrite u_val. lra. }
  assert (U4 : Rabs (ma - missing * a) <= (602 / 100) * (u * u) * X).
  { replace (ma - missing * a) with ((ma - m' * a) + (m' - missing) * a) by ring.
    eapply Rle_trans; [apply Rabs_plus_le; [exact R4 | apply Rabs_mult_le; [exact Bm' | exact BA]]|]. assert (u * Rabs
      (m' * a) <= u * ((301 / 100) * u * X)) by (apply Rmult_le_compat_l; lra).
    clear - H Tiny X0. rewrite u_val in *. lra. }
  assert (S5 : Rabs (low - ma) <= (806 / 100) * u * X + (1 + 4 * u) * u * q).
  { replace (low - ma) with ((low - (y1 - y2)) + (y1 - y2) - ((ma - missing * a) + missing * a)) by ring.
    eapply Rle_trans; [apply Rabs_minus_le; [apply Rabs_plus_le; [exact U3 | exact S3] | apply Rabs_plus_le; [exact U4
      | exact MA]]|]. clear - X0 q0. rewrite u_val in *. lra. }
  assert (U5 : Rabs (y5 - (low - ma)) <= u * ((806 / 100) * u * X + (1 + 4 * u) * u * q)) by (eapply Rle_trans; [exact
    R5|]; apply Rmult_le_compat_l; lra).
  assert (S6 : Rabs (e1 - e2) <= (606 / 100) * u * X + (1 + 2 * u) * u * q) by (eapply Rle_trans; [apply
    Rabs_minus_le; [exact e1B | exact e2B']|]; clear - X0 q0; rewrite u_val in *; lra).
  assert (U6 : Rabs (y6 - (e1 - e2)) <= u * ((606 / 100) * u * X + (1 + 2 * u) * u * q)) by (eapply Rle_trans; [exact
    R6|]; apply Rmult_le_compat_l; lra).
  assert (S7 : Rabs (y6 - e3) <= (809 / 100) * u * X + (1 + 4 * u) * u * q).
  { replace (y6 - e3) with ((y6 - (e1 - e2)) + (e1 - e2) - e3) by ring. eapply Rle_trans; [apply Rabs_minus_le; [apply
    Rabs_plus_le; [exact U6 | exact S6] | exact e3B]|]. clear - X0 q0. rewrite u_val in *. lra. }
  assert (U7 : Rabs (y7 - (y6 - e3)) <= u * ((809 / 100) * u * X + (1 + 4 * u) * u * q)) by (eapply Rle_trans; [exact
    R7|]; apply Rmult_le_compat_l; lra).
  assert (S8 : Rabs (y7 + y5) <= (1617 / 100) * u * X + (2 + 20 * u) * u * q).
  { replace (y7 + y5) with ((y7 - (y6 - e3)) + (y6 - e3) + ((y5 - (low - ma)) + (low - ma))) by ring.
    eapply Rle_trans; [apply Rabs_plus_le; [apply Rabs_plus_le; [exact U7 | exact S7] | apply Rabs_plus_le; [exact U5
      | exact S5]]|]. clear - X0 q0. rewrite u_val in *. lra. }
  assert (U8 : Rabs (y8 - (y7 + y5)) <= u * ((1617 / 100) * u * X + (2 + 20 * u) * u * q)) by (eapply Rle_trans;
    [exact R8|]; apply Rmult_le_compat_l; lra).
  (* point - three is R but for the low terms *)
  assert (I : point - three = R - (e1 - e2 - e3) - (td' - aa' - (bb' + cc')) + missing * a) by (unfold R; lra).
  assert (S9 : Rabs (point - three) <= (1612 / 100) * u * X + (1 + 3 * u) * q).
  { rewrite I. eapply Rle_trans; [apply Rabs_plus_le; [apply Rabs_minus_le; [apply Rabs_minus_le; [apply Rle_refl |
    apply Rabs_minus_le; [exact S6 | exact e3B]] |
      apply Rabs_minus_le; [exact S1 | exact S2]] | exact MA]|]. fold q. clear - abc a0 b0 c0 X0 q0. rewrite u_val in
        *. lra. }
  assert (U9 : Rabs (y9 - (point - three)) <= u * ((1612 / 100) * u * X + (1 + 3 * u) * q)) by (eapply Rle_trans;
    [exact R9|]; apply Rmult_le_compat_l; lra).
  assert (Dif : Rabs (y9 + y8 - R) <= (7135 / 100) * (u * u) * X + (1 + 40 * u) * u * q).
  { replace (y9 + y8 - R) with ((y9 - (point - three)) + (y8 - (y7 + y5)) + (y7 - (y6 - e3)) + (y6 - (e1 - e2)) + (y5
    - (low - ma)) + (low - (y1 - y2)) + (y1 - (td' - aa')) - (y2 - (bb' + cc')) - (ma - missing * a))
      by (rewrite I; ring).
    eapply Rle_trans; [apply Rabs_minus_le; [apply Rabs_minus_le; [apply Rabs_plus_le; [apply Rabs_plus_le; [apply
      Rabs_plus_le; [apply Rabs_plus_le; [apply Rabs_plus_le; [apply Rabs_plus_le; [exact U9 | exact U8] | exact U7] |
        exact U6] | exact U5] | exact U3] | exact U1] | exact U2] | exact U4]|].
    clear - abc a0 b0 c0 X0 q0. rewrite u_val in *. lra. }
  assert (S10 : Rabs (y9 + y8) <= (7135 / 100) * (u * u) * X + (1 + 2 * u) * q).
  { replace (y9 + y8) with ((y9 + y8 - R) + R) by ring. eapply Rle_trans; [apply Rabs_plus_le; [exact Dif | apply
    Rle_refl]|]. fold q. clear - X0 q0. rewrite u_val in *. lra. }
  replace (r - R) with ((r - (y9 + y8)) + (y9 + y8 - R)) by ring. eapply Rle_trans; [apply Rabs_plus_le; [exact R10 |
    exact Dif]|].
  assert (u * Rabs (y9 + y8) <= u * ((7135 / 100) * (u * u) * X + (1 + 2 * u) * q)) by (apply Rmult_le_compat_l; lra).
  clear - H X0 q0. rewrite u_val in *. lra.
Qed.
Theorem REST_ERROR_holds : Rabs (r - R) <= (1 - 16 * u) * (REST_ERROR * X) + (201 / 100) * u * Rabs R.
Proof.
  eapply Rle_trans; [exact rest_near|]. assert (0 <= X) by (pose proof (Rabs_pos a); lra). unfold REST_ERROR. rewrite
    u_val. lra.
Qed.
End Component.

(* ---- Solving: a correction is R.n / Sum for the exact rest R and a vector n of the crossing. ---- *)
Section Solve.
Variables n1 n2 n3 r1 r2 r3 R1 R2 R3 C DE2 sum Sum num X : R.
Let r := norm1 r1 r2 r3.
Let inverse := RN (1 / sum).
Let step := RN (num * inverse).
Hypotheses (Hn : norm1 n1 n2 n3 <= C) (X0 : 0 <= X)
  (H1 : Rabs (r1 - R1) <= 72 * (u * u) * X + (201 / 100) * u * Rabs R1) (H2 : Rabs (r2 - R2) <= 72 * (u * u) * X +
    (201 / 100) * u * Rabs R2)
  (H3 : Rabs (r3 - R3) <= 72 * (u * u) * X + (201 / 100) * u * Rabs R3)
  (Hnum : Rabs (num - (r1 * n1 + r2 * n2 + r3 * n3)) <= (7 + / 100) * u * (r * C)) (s0 : 0 < sum) (Hsum : Rabs (sum -
    Sum) <= (71 / 10) * u * DE2)
  (Certain : 50 * u * DE2 <= sum) (Steep : (1 - 8 * u) * sum <= DE2) (Hinv : Rabs (inverse - 1 / sum) <= u * (1 / sum))
  (Tiny : bp (-1075) <= / 1000 * (u * u) * (C / sum * X)).
Let bound := C / sum * (REST_ERROR * X + SOLUTION_ERROR * (DE2 / sum * r)).

Lemma solved : Rabs ((R1 * n1 + R2 * n2 + R3 * n3) / Sum - step) <= (C / sum * (85 * (u * u) * X) + C / sum * ((209 /
  10) * u * (DE2 / sum * r))) - u * Rabs step /\
  Rabs step <= (1 + 20 * u) * (C / sum * r) + / 1000 * u * (C / sum * X).
Proof.
  pose proof u_pos as up. assert (r0 : 0 <= r) by apply norm1_pos. assert (C0 : 0 <= C) by (pose proof (norm1_pos n1
    n2 n3); lra).
  set (k := DE2 / sum) in *. assert (kd : k * sum = DE2) by (unfold k; field; lra). assert (k1 : 1 - 8 * u <= k) by
    (apply Rmult_le_reg_r with sum; lra).
  assert (k2 : 50 * u * k <= 1) by (apply Rmult_le_reg_r with sum; [assumption|]; replace (50 * u * k * sum) with (50
    * u * DE2) by (rewrite <- kd; ring); lra).
  set (c := C / sum) in *. assert (cs : c * sum = C) by (unfold c; field; lra). assert (c0 : 0 <= c) by (unfold c;
    apply Rmult_le_pos; [assumption | apply Rlt_le, Rinv_0_lt_compat; assumption]).
  assert (SS : 858 / 1000 * sum <= Sum) by (apply Rabs_le_inv in Hsum; lra). assert (S0 : 0 < Sum) by lra.
  set (m := 72 * (u * u) * X) in *. assert (m0 : 0 <= m) by (unfold m; rewrite u_val; lra).
  unfold norm1 in *. pose proof (Rabs_pos n1) as p1. pose proof (Rabs_pos n2) as p2. pose proof (Rabs_pos n3) as p3.
  (* R against r *)
  assert (B : forall a b, Rabs (a - b) <= m + (201 / 100) * u * Rabs b -> Rabs b <= (1 + 3 * u) * (Rabs a + m)).
  { intros a b H. pose proof (Rabs_triang_inv b a) as I. rewrite (Rabs_minus_sym b) in I. pose proof (Rabs_pos a).
    pose proof (Rabs_pos b). rewrite u_val in *. lra. }
  pose proof (B _ _ H1) as B1. pose proof (B _ _ H2) as B2. pose proof (B _ _ H3) as B3. clear B.
  pose proof (Rabs_pos r1) as q1. pose proof (Rabs_pos r2) as q2. pose proof (Rabs_pos r3) as q3.
  assert (RB : forall b a, Rabs b <= (1 + 3 * u) * (Rabs a + m) -> Rabs a <= r -> Rabs b <= (1 + 3 * u) * (r + m)).
  { intros b a H G. eapply Rle_trans; [exact H|]. apply Rmult_le_compat_l; lra. }
  assert (r1r : Rabs r1 <= r) by (unfold r; lra). assert (r2r : Rabs r2 <= r) by (unfold r; lra). assert (r3r : Rabs
    r3 <= r) by (unfold r; lra).
  pose proof (RB _ _ B1 r1r) as D1. pose proof (RB _ _ B2 r2r) as D2. pose proof (RB _ _ B3 r3r) as D3. clear RB.
  set (w := m + (202 / 100) * u * (r + m)). assert (w0 : 0 <= w) by (unfold w; assert (0 <= u * (r + m)) by (apply
    Rmult_le_pos; lra); lra).
  assert (W : forall a b, Rabs (a - b) <= m + (201 / 100) * u * Rabs b -> Rabs b <= (1 + 3 * u) * (r + m) -> Rabs (a -
    b) <= w).
  { intros a b H G. eapply Rle_trans; [exact H|]. unfold w. assert (u * Rabs b <= u * ((1 + 3 * u) * (r + m))) by
    (apply Rmult_le_compat_l; lra). assert (0 <= r + m) by lra. rewrite u_val in *. lra. }
  pose proof (W _ _ H1 D1) as W1. pose proof (W _ _ H2 D2) as W2. pose proof (W _ _ H3 D3) as W3. clear W.
  set (N := R1 * n1 + R2 * n2 + R3 * n3). set (M := r1 * n1 + r2 * n2 + r3 * n3) in *.
  assert (MN : Rabs (M - N) <= w * C).
  { replace (M - N) with ((r1 - R1) * n1 + (r2 - R2) * n2 + (r3 - R3) * n3) by (unfold M, N; ring).
    eapply Rle_trans; [apply Rabs_plus_le; [apply Rabs_plus_le; apply Rabs_mult_le; [exact W1 | apply Rle_refl | exact
      W2 | apply Rle_refl] | apply Rabs_mult_le; [exact W3 | apply Rle_refl]]|].
    assert (w * (Rabs n1 + Rabs n2 + Rabs n3) <= w * C) by (apply Rmult_le_compat_l; assumption). lra. }
  assert (MB : Rabs M <= r * C).
  { unfold M. eapply Rle_trans; [apply Rabs_plus_le; [apply Rabs_plus_le; apply Rabs_mult_le; [exact r1r | apply
    Rle_refl | exact r2r | apply Rle_refl] | apply Rabs_mult_le; [exact r3r | apply Rle_refl]]|].
    assert (r * (Rabs n1 + Rabs n2 + Rabs n3) <= r * C) by (apply Rmult_le_compat_l; assumption). lra. }
  assert (rC : 0 <= r * C) by (apply Rmult_le_pos; assumption). assert (wC : 0 <= w * C) by (apply Rmult_le_pos;
    assumption).
  (* the computed step, times sum *)
  assert (IS : Rabs (inverse * sum - 1) <= u).
  { replace (inverse * sum - 1) with ((inverse - 1 / sum) * sum) by (field; lra). rewrite Rabs_mult, (Rabs_pos_eq sum)
    by lra.
    apply Rle_trans with (u * (1 / sum) * sum); [apply Rmult_le_compat_r; lra|]. apply Req_le. field. lra. }
  assert (NB : Rabs num <= (1 + 8 * u) * (r * C)).
  { replace num with ((num - M) + M) by ring. eapply Rle_trans; [apply Rabs_plus_le; eassumption|]. rewrite u_val in
    *. lra. }
  pose proof (RN_err (num * inverse)) as E. fold step in E.
  assert (NI : Rabs (num * inverse) * sum <= (1 + 10 * u) * (r * C)).
  { rewrite <- (Rabs_pos_eq sum) at 1 by lra. rewrite <- Rabs_mult. replace (num * inverse * sum) with (num * (inverse
    * sum)) by ring.
    apply Rle_trans with ((1 + 8 * u) * (r * C) * (1 + u)); [apply Rabs_mult_le; [exact NB | apply Rabs_le_inv in IS;
      apply Rabs_le; lra] | rewrite u_val in *; lra]. }
  assert (T : bp (-1075) * sum <= / 1000 * (u * u) * (C * X)).
  { apply Rle_trans with (/ 1000 * (u * u) * (c * X) * sum); [apply Rmult_le_compat_r; lra|]. apply Req_le. rewrite <-
    cs. ring. }
  assert (CX : 0 <= C * X) by (apply Rmult_le_pos; assumption).
  assert (Es : Rabs (step * sum - num * inverse * sum) <= (1 + 10 * u) * u * (r * C) + / 1000 * (u * u) * (C * X)).
  { replace (step * sum - num * inverse * sum) with ((step - num * inverse) * sum) by ring. rewrite Rabs_mult,
    (Rabs_pos_eq sum) by lra.
    apply Rle_trans with ((u * Rabs (num * inverse) + bp (-1075)) * sum); [apply Rmult_le_compat_r; lra|].
    replace ((u * Rabs (num * inverse) + bp (-1075)) * sum) with (u * (Rabs (num * inverse) * sum) + bp (-1075) * sum)
      by ring.
    assert (u * (Rabs (num * inverse) * sum) <= u * ((1 + 10 * u) * (r * C))) by (apply Rmult_le_compat_l; lra). lra. }
  assert (SB : Rabs step * sum <= (1 + 12 * u) * (r * C) + / 1000 * (u * u) * (C * X)).
  { rewrite <- (Rabs_pos_eq sum) at 1 by lra. rewrite <- Rabs_mult. replace (step * sum) with ((step * sum - num *
    inverse * sum) + num * inverse * sum) by ring.
    eapply Rle_trans; [apply Rabs_plus_le; [exact Es | rewrite Rabs_mult, (Rabs_pos_eq sum) by lra; exact NI]|].
      rewrite u_val in *. lra. }
  (* N / Sum, times sum *)
  assert (Nb : Rabs N <= r * C + w * C).
  { replace N with (M - (M - N)) by ring. eapply Rle_trans; [apply Rabs_minus_le; [exact MB | exact MN]|]. lra. }
  assert (QB : Rabs (N / Sum) <= (11656 / 10000) * (c * (r + w))).
  { apply Rabs_div_le; [lra|]. rewrite (Rabs_pos_eq Sum) by lra. eapply Rle_trans; [exact Nb|]. apply Rle_trans with
    (11656 / 10000 * (c * (r + w)) * (858 / 1000 * sum)).
    - replace (11656 / 10000 * (c * (r + w)) * (858 / 1000 * sum)) with (11656 / 10000 * (858 / 1000) * ((r + w) * C))
      by (rewrite <- cs; ring). lra.
    - apply Rmult_le_compat_l; [apply Rmult_le_pos; [lra | apply Rmult_le_pos; lra] | exact SS]. }
  assert (Q : Rabs (N / Sum * sum - N) <= (8276 / 1000) * u * k * (r * C + w * C)).
  { replace (N / Sum * sum - N) with (N / Sum * (sum - Sum)) by (field; lra).
    apply Rle_trans with (11656 / 10000 * (c * (r + w)) * (71 / 10 * u * DE2)); [apply Rabs_mult_le; assumption|].
    replace (11656 / 10000 * (c * (r + w)) * (71 / 10 * u * DE2)) with (11656 / 10000 * (71 / 10) * u * k * (r * C + w
      * C)) by (rewrite <- kd, <- cs; ring).
    assert (kp : 0 <= k) by (clear - k1; rewrite u_val in k1; lra). apply Rmult_le_compat_r; [lra|]. apply
      Rmult_le_compat_r; [lra|]. apply Rmult_le_compat_r; lra. }
  assert (Main : Rabs (N / Sum - step) * sum <= (8276 / 1000) * u * k * (r * C + w * C) + w * C + (7 + / 100) * u * (r
    * C) + (201 / 100) * u * (r * C) + / 1000 * (u * u) * (C * X)).
  { rewrite <- (Rabs_pos_eq sum) at 1 by lra. rewrite <- Rabs_mult.
    replace ((N / Sum - step) * sum) with ((N / Sum * sum - N) - (M - N) - (num - M) - num * (inverse * sum - 1) -
      (step * sum - num * inverse * sum)) by ring.
    eapply Rle_trans; [apply Rabs_minus_le; [apply Rabs_minus_le; [apply Rabs_minus_le; [apply Rabs_minus_le; [exact Q
      | exact MN] | exact Hnum] | apply Rabs_mult_le; [exact NB | exact IS]] | exact Es]|].
    set (v := 8276 / 1000 * u * k * (r * C + w * C)) in *. rewrite u_val in *. lra. }
  split.
  - apply Rmult_le_reg_r with sum; [assumption|].
    replace ((c * (85 * (u * u) * X) + c * (209 / 10 * u * (k * r)) - u * Rabs step) * sum) with
      (85 * (u * u) * (C * X) + (209 / 10) * u * k * (r * C) - u * (Rabs step * sum)) by (rewrite <- cs; ring).
    assert (SU : u * (Rabs step * sum) <= u * ((1 + 12 * u) * (r * C) + / 1000 * (u * u) * (C * X))) by (apply
      Rmult_le_compat_l; lra).
    assert (WE : w * C <= (72 + / 10) * (u * u) * (C * X) + (202 / 100) * u * (r * C)).
    { unfold w, m. replace ((72 * (u * u) * X + 202 / 100 * u * (r + 72 * (u * u) * X)) * C) with (72 * (1 + 202 / 100
      * u) * (u * u) * (C * X) + 202 / 100 * u * (r * C)) by ring.
      rewrite u_val in *. lra. }
    assert (kr : (1 - 8 * u) * (r * C) <= k * (r * C)) by (apply Rmult_le_compat_r; assumption).
    assert (kw : u * k * (w * C) <= / 50 * (w * C)) by (apply Rmult_le_compat_r; lra).
    set (cx := C * X) in *. set (rc := r * C) in *. set (wc := w * C) in *. set (z := Rabs step * sum) in *.
    replace (8276 / 1000 * u * k * (rc + wc)) with (8276 / 1000 * u * (k * rc) + 8276 / 1000 * (u * k * wc)) in Main
      by ring.
    replace (209 / 10 * u * k * rc) with (209 / 10 * u * (k * rc)) by ring. set (krc := k * rc) in *. set (kwc := u *
      k * wc) in *.
    set (main := Rabs (N / Sum - step) * sum) in *. clear - Main SU WE kr kw CX rC wC. rewrite u_val in *. lra.
  - apply Rmult_le_reg_r with sum; [assumption|]. eapply Rle_trans; [exact SB|].
    replace (((1 + 20 * u) * (c * r) + / 1000 * u * (c * X)) * sum) with ((1 + 20 * u) * (r * C) + / 1000 * u * (C *
      X)) by (rewrite <- cs; ring).
    rewrite u_val in *. lra.
Qed.
Theorem SOLUTION_ERROR_holds : forall e, (1 - 16 * u) * (C / sum * (REST_ERROR * X + SOLUTION_ERROR * (DE2 / sum *
  r))) <= e ->
  Rabs ((R1 * n1 + R2 * n2 + R3 * n3) / Sum - step) <= e - u * (Rabs step + e).
Proof.
  intros e He. destruct solved as [S1 _]. pose proof u_pos as up. eapply Rle_trans; [exact S1|]. assert (r0 : 0 <= r)
    by apply norm1_pos.
  assert (C0 : 0 <= C) by (pose proof (norm1_pos n1 n2 n3); lra). assert (c0 : 0 <= C / sum) by (apply Rmult_le_pos;
    [assumption | apply Rlt_le, Rinv_0_lt_compat; assumption]).
  assert (k0 : 0 <= DE2 / sum) by (apply Rmult_le_pos; [rewrite u_val in *; lra | apply Rlt_le, Rinv_0_lt_compat;
    assumption]).
  assert (P : 0 <= C / sum * (DE2 / sum * r)) by (apply Rmult_le_pos; [assumption | apply Rmult_le_pos; assumption]).
    assert (Q : 0 <= C / sum * X) by (apply Rmult_le_pos; assumption).
  unfold REST_ERROR, SOLUTION_ERROR in He. replace (C / sum * (136 * u * u * X + 21 * u * (DE2 / sum * r))) with (136
    * (u * u) * (C / sum * X) + 21 * u * (C / sum * (DE2 / sum * r))) in He by ring.
  replace (C / sum * (85 * (u * u) * X) + C / sum * (209 / 10 * u * (DE2 / sum * r))) with (85 * (u * u) * (C / sum *
    X) + 209 / 10 * u * (C / sum * (DE2 / sum * r))) by ring.
  set (x := C / sum * X) in *. set (y := C / sum * (DE2 / sum * r)) in *. set (z := Rabs step) in *. clear - He P Q.
    rewrite u_val in *. lra.
Qed.
End Solve.
(* ---- The first weight: its correction is missing - (beta + gamma), two corrections within e, which is at least 270
  u^2. ---- *)
Theorem FIRST_WEIGHT_holds : forall missing m' be ga BE GA e c x y, Rabs (m' - missing) <= 3 * (u * u) -> Rabs missing
  <= 3 * u ->
  Rabs (BE - be) <= e - u * (Rabs be + e) -> Rabs (GA - ga) <= e - u * (Rabs ga + e) -> e = c * (REST_ERROR * x +
    SOLUTION_ERROR * y) -> 0 <= c -> 0 <= x -> 0 <= y ->
  2 * (1 - 8 * u) <= c * x -> Rabs be <= (1 + 20 * u) * (c * y) + / 1000 * u * (c * x) -> Rabs ga <= (1 + 20 * u) * (c
    * y) + / 1000 * u * (c * x) ->
  let al := RN (m' - RN (be + ga)) in F m' -> F be -> F ga -> forall f, (1 - 8 * u) * (FIRST_WEIGHT * e) <= f ->
  Rabs (missing - BE - GA - al) <= f - u * (Rabs al + f).
Proof.
  intros missing m' be ga BE GA e c x y Hm Hs Hb Hg He c0 x0 y0 cx Bb Bg al Fm Fb Fg f Hf. pose proof u_pos as up.
    pose proof (RN_sum be ga Fb Fg) as E1. set (s := RN (be + ga)) in *.
  pose proof (RN_diff m' s Fm (RN_F _)) as E2. fold al in E2. assert (cy : 0 <= c * y) by (apply Rmult_le_pos;
    assumption). assert (cx0 : 0 <= c * x) by (apply Rmult_le_pos; assumption).
  assert (He' : e = 136 * (u * u) * (c * x) + 21 * u * (c * y)) by (rewrite He; unfold REST_ERROR, SOLUTION_ERROR;
    ring).
  set (p := c * x) in *. set (q := c * y) in *. pose proof (Rabs_pos be). pose proof (Rabs_pos ga).
  assert (S1 : Rabs (be + ga) <= 2 * ((1 + 20 * u) * q + / 1000 * u * p)) by (eapply Rle_trans; [apply Rabs_triang|];
    lra).
  assert (E1' : Rabs (s - (be + ga)) <= u * (2 * ((1 + 20 * u) * q + / 1000 * u * p))) by (eapply Rle_trans; [exact
    E1|]; apply Rmult_le_compat_l; lra).
  assert (S2 : Rabs (m' - s) <= 4 * u + (2 + / 100) * q + / 400 * u * p).
  { replace (m' - s) with ((m' - missing) + missing - ((s - (be + ga)) + (be + ga))) by ring. eapply Rle_trans; [apply
    Rabs_minus_le; [apply Rabs_plus_le; [exact Hm | exact Hs] | apply Rabs_plus_le; [exact E1' | exact S1]]|].
    rewrite u_val in *. lra. }
  assert (E2' : Rabs (al - (m' - s)) <= u * (4 * u + (2 + / 100) * q + / 400 * u * p)) by (eapply Rle_trans; [exact
    E2|]; apply Rmult_le_compat_l; lra).
  assert (S3 : Rabs al <= 5 * u + (2 + / 50) * q + / 300 * u * p).
  { replace al with ((al - (m' - s)) + (m' - s)) by ring. eapply Rle_trans; [apply Rabs_plus_le; eassumption|].
    rewrite u_val in *. lra. }
  replace (missing - BE - GA - al) with (- (m' - missing) - (al - (m' - s)) + (s - (be + ga)) - (BE - be) - (GA - ga))
    by ring.
  eapply Rle_trans; [apply Rabs_minus_le; [apply Rabs_minus_le; [apply Rabs_plus_le; [apply Rabs_minus_le; [rewrite
    Rabs_Ropp; exact Hm | exact E2'] | exact E1'] | exact Hb] | exact Hg]|].
  unfold FIRST_WEIGHT in Hf. clear - Hf He' S3 cx cx0 cy H H0. rewrite u_val in *. lra.
Qed.
