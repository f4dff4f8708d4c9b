(* rt-math, pseudo_inverse/regular.rs: a reciprocal, quotients by it, and the sums of rows. *)
From Proofs Require Import Rounding ErrorFree DoubleDouble Steps Round.
Open Scope R_scope.

(* The relative error of a quotient: parts of that of the determinant, and of u^2 + T (u + T^2) for a step T. *)
Definition ETA_FACTOR := 2.
Definition ETA_ROUNDING := 16.
(* What the low part adds. *)
Definition LOW_ROUNDING := 8 * u.
(* Row sums: parts of the magnitudes of what is added, and of the errors of the entries. *)
Definition TERMS_FACTOR := 4.
Definition ENTRIES_FACTOR := 1125 / 1000.

Section Reciprocal.
(* the determinant D within `bound` of s + low; r = 1/s rounded, and rho = 1 - r s exactly *)
Variables D s low bound : R.
Hypotheses (S0 : s <> 0) (Rs : bp (-460) <= Rabs s <= bp 310) (HD : Rabs (D - (s + low)) <= bound).
Let r := RN (1 / s).
Let rho := 1 - r * s.
Let tau := RN (rho - RN (low * r)).
Let T := Rabs tau.
Let r_low := RN (r * RN (tau + RN (tau * tau))).
Let r_sum := RN (r + r_low).
Variable eta0 : R.
Hypotheses (T1 : T <= bp (-19)) (He0 : eta0 = RN (bound * Rabs r)) (E1 : eta0 <= / 8) (Fb : F bound).

Lemma r_near : r <> 0 /\ bp (-311) <= Rabs r <= bp 461 /\ Rabs rho <= (1 + / 1000) * u.
Proof.
  pose proof (bp_pos (-460)). assert (SP : 0 < Rabs s) by lra. pose proof u_pos.
  assert (Q : Rabs (1 / s) * Rabs s = 1) by (rewrite <- Rabs_mult; replace (1 / s * s) with 1 by (field; assumption);
    apply Rabs_R1).
  assert (L : bp (-310) <= Rabs (1 / s)).
  { apply Rmult_le_reg_r with (Rabs s); [assumption|]. rewrite Q. apply Rle_trans with (bp (-310) * bp 310); [apply
    Rmult_le_compat_l; [apply Rlt_le, bp_pos | lra]|].
    rewrite <- bp_add. simpl. lra. }
  assert (G : Rabs (1 / s) <= bp 460).
  { apply Rmult_le_reg_r with (Rabs s); [assumption|]. rewrite Q. apply Rle_trans with (bp 460 * bp (-460)); [rewrite
    <- bp_add; simpl; lra|]. apply Rmult_le_compat_l; [apply Rlt_le, bp_pos | lra]. }
  pose proof (RN_normal (1 / s) ltac:(eapply Rle_trans; [|exact L]; apply bp_le; lia)) as E. fold r in E.
  assert (F1 : bp (-310) = 2 * bp (-311)) by (change (-310)%Z with (1 + -311)%Z; rewrite bp_add, bp_1; ring).
  assert (F2 : bp 461 = 2 * bp 460) by (change 461%Z with (1 + 460)%Z; rewrite bp_add, bp_1; ring). pose proof (bp_pos
    (-311)).
  pose proof (Rabs_triang_inv (1 / s) r) as I1. rewrite (Rabs_minus_sym (1 / s)) in I1. pose proof (Rabs_triang_inv r
    (1 / s)) as I2.
  assert (B : bp (-311) <= Rabs r <= bp 461) by (rewrite u_val in *; lra).
  split; [intro Z; rewrite Z, Rabs_R0 in B; lra|]. split; [exact B|].
  replace rho with (- ((r - 1 / s) * s)) by (unfold rho; field; assumption). rewrite Rabs_Ropp, Rabs_mult.
  apply Rle_trans with (u * Rabs (1 / s) * Rabs s); [apply Rmult_le_compat_r; lra|]. rewrite Rmult_assoc, Q. lra.
Qed.
(* 1 - r D is near tau *)
Let sigma := 1 - r * D.
Let kappa := (1 + / 1000) * eta0 + (202 / 100) * u * T + (104 / 100) * (u * u).
Lemma sigma_near : Rabs (sigma - tau) <= kappa /\ 0 <= eta0 /\ Rabs sigma <= 126 / 1000.
Proof.
  destruct r_near as (r0 & Rr & Hrho). pose proof u_pos as up. assert (T0 : 0 <= T) by apply Rabs_pos.
  pose proof (RN_err (low * r)) as El. pose proof (RN_back (rho - RN (low * r))) as Et. fold tau in Et. set (lr := RN
    (low * r)) in *. fold T in Et.
  assert (Tiny : bp (-1075) <= / 10000 * (u * u)).
  { apply Rle_trans with (bp (-20) * (u * u)); [unfold u; rewrite <- !bp_add; apply bp_le; lia | apply
    Rmult_le_compat_r; [apply sq_pos | simpl; lra]]. }
  pose proof (bp_pos (-1075)) as P0. assert (B19 : bp (-19) = / 524288) by (simpl; lra). rewrite B19 in T1.
  assert (LR : Rabs lr <= (1 + / 100) * (T + u)).
  { replace lr with (rho - tau + (tau - (rho - lr))) by ring. eapply Rle_trans; [apply Rabs_plus_le; [apply
    Rabs_minus_le; [exact Hrho | apply Rle_refl] | exact Et]|].
    fold T. rewrite u_val in *. lra. }
  pose proof (RN_back (low * r)) as Eb. fold lr in Eb.
  assert (LR2 : Rabs lr <= (1 + / 900) * u + (1 + 2 * u) * T).
  { replace lr with (rho - tau + (tau - (rho - lr))) by ring. eapply Rle_trans; [apply Rabs_plus_le; [apply
    Rabs_minus_le; [exact Hrho | apply Rle_refl] | exact Et]|].
    fold T. rewrite u_val in *. lra. }
  assert (E3 : Rabs (lr - low * r) <= (1 + / 500) * (u * u) + (1 + 3 * u) * u * T).
  { eapply Rle_trans; [exact Eb|]. assert (u * Rabs lr <= u * ((1 + / 900) * u + (1 + 2 * u) * T)) by (apply
    Rmult_le_compat_l; lra). rewrite u_val in *. lra. }
  assert (b0 : 0 <= bound) by (pose proof (Rabs_pos (D - (s + low))); lra).
  assert (br0 : 0 <= bound * Rabs r) by (apply Rmult_le_pos; [assumption | apply Rabs_pos]).
  assert (e0 : 0 <= eta0) by (rewrite He0, <- RN_0; now apply RN_le).
  assert (E4 : Rabs (r * (D - (s + low))) <= (1 + 2 * u) * eta0 + / 5000 * (u * u)).
  { rewrite Rabs_mult. apply Rle_trans with (Rabs r * bound); [apply Rmult_le_compat_l; [apply Rabs_pos | exact HD]|].
    pose proof (RN_back (bound * Rabs r)) as E. rewrite <- He0 in E.
    rewrite (Rabs_pos_eq eta0) in E by assumption. apply Rabs_le_inv in E. rewrite (Rmult_comm (Rabs r)). rewrite
      u_val in *. lra. }
  assert (K : Rabs (sigma - tau) <= kappa).
  { replace (sigma - tau) with (- (tau - (rho - lr)) + (lr - low * r) - r * (D - (s + low))) by (unfold sigma, rho;
    ring).
    eapply Rle_trans; [apply Rabs_minus_le; [apply Rabs_plus_le; [rewrite Rabs_Ropp; exact Et | exact E3] | exact
      E4]|]. unfold kappa. rewrite u_val in *. lra. }
  split; [exact K|]. split; [exact e0|]. replace sigma with ((sigma - tau) + tau) by ring. eapply Rle_trans; [apply
    Rabs_plus_le; [exact K | apply Rle_refl]|]. fold T. unfold kappa. rewrite u_val in *. lra.
Qed.
Let etaR := (1147 / 1000) * eta0 + (434 / 100) * u * T + (121 / 100) * (u * u) + (1001 / 1000) * (T * T * T).
Lemma reciprocal : D <> 0 /\ Rabs (1 / D - (r + r_low)) <= etaR * Rabs r /\ Rabs (1 / D) <= 1145 / 1000 * Rabs r /\
  Rabs r_low <= ((101 / 100) * T + / 500 * (u * u)) * Rabs r.
Proof.
  destruct r_near as (r0 & Rr & Hrho). destruct sigma_near as (K & e0 & SG). pose proof u_pos as up. assert (T0 : 0 <=
    T) by apply Rabs_pos. pose proof (Rabs_pos_lt r r0) as RP.
  assert (B19 : bp (-19) = / 524288) by (simpl; lra). rewrite B19 in T1. pose proof SG as SG'. apply Rabs_le_inv in SG'.
  assert (RD : r * D = 1 - sigma) by (unfold sigma; ring). assert (D0 : D <> 0) by (intro Z; rewrite Z, Rmult_0_r in
    RD; lra). split; [exact D0|].
  assert (ID : 1 / D = r / (1 - sigma)) by (rewrite <- RD; field; split; assumption).
  assert (TT : Rabs tau <= / 524288) by exact T1. pose proof TT as TT'. apply Rabs_le_inv in TT'.
  (* 1 / (1 - sigma) - (1 + tau + tau^2) *)
  assert (A1 : Rabs (/ (1 - sigma) - (1 + tau + tau * tau)) <= (1145 / 1000) * kappa + (1001 / 1000) * (T * T * T)).
  { replace (/ (1 - sigma) - (1 + tau + tau * tau)) with ((sigma - tau) / ((1 - sigma) * (1 - tau)) + tau * tau * tau
    / (1 - tau)) by (field; split; lra).
    apply Rabs_plus_le.
    - assert (P : 8739 / 10000 <= (1 - sigma) * (1 - tau)) by (apply Rle_trans with (874 / 1000 * (1 - / 524288));
      [lra | apply Rmult_le_compat; lra]).
      apply Rabs_div_le; [lra|]. rewrite (Rabs_pos_eq ((1 - sigma) * (1 - tau))) by lra. eapply Rle_trans; [exact K|].
      assert (kappa0 : 0 <= kappa) by (pose proof (Rabs_pos (sigma - tau)); lra).
      apply Rle_trans with (1145 / 1000 * kappa * (8739 / 10000)); [lra | apply Rmult_le_compat_l; lra].
    - apply Rabs_div_le; [lra|]. rewrite !Rabs_mult. fold T. rewrite (Rabs_pos_eq (1 - tau)) by lra. assert (0 <= T *
      T * T) by (repeat apply Rmult_le_pos; assumption).
      apply Rle_trans with (1001 / 1000 * (T * T * T) * (1 - / 524288)); [lra | apply Rmult_le_compat_l; lra]. }
  (* r_low *)
  assert (Tiny : bp (-1075) <= / 100000 * (u * u) * bp (-311)).
  { apply Rle_trans with (bp (-20) * (u * u) * bp (-311)); [unfold u; rewrite <- !bp_add; apply bp_le; lia|]. apply
    Rmult_le_compat_r; [apply Rlt_le, bp_pos|].
    apply Rmult_le_compat_r; [apply sq_pos | simpl; lra]. }
  assert (Tiny1 : bp (-1075) <= / 100000 * (u * u)).
  { eapply Rle_trans; [exact Tiny|]. rewrite <- (Rmult_1_r (/ 100000 * (u * u))) at 2. apply Rmult_le_compat_l;
    [rewrite u_val; lra|]. apply Rle_trans with (bp 0); [apply bp_le; lia | simpl; lra]. }
  assert (TinyR : bp (-1075) <= / 100000 * (u * u) * Rabs r) by (eapply Rle_trans; [exact Tiny|]; apply
    Rmult_le_compat_l; [rewrite u_val|]; lra).
  pose proof (bp_pos (-1075)) as P0. assert (T2 : 0 <= T * T) by (apply Rmult_le_pos; assumption). assert (T3 : T * T
    <= / 524288 * T) by (apply Rmult_le_compat_r; assumption).
  pose proof (RN_err (tau * tau)) as X1. rewrite Rabs_mult in X1. fold T in X1. set (q := RN (tau * tau)) in *.
  pose proof (RN_sum tau q (RN_F _) (RN_F _)) as X2. set (w := RN (tau + q)) in *. pose proof (RN_err (r * w)) as X3.
    fold r_low in X3.
  assert (Q1 : Rabs q <= (1 + / 1000) * (T * T) + / 100000 * (u * u)).
  { replace q with ((q - tau * tau) + tau * tau) by ring. eapply Rle_trans; [apply Rabs_plus_le; [exact X1 | rewrite
    Rabs_mult; fold T; apply Rle_refl]|]. rewrite u_val in *. lra. }
  assert (W0 : Rabs (tau + q) <= (1 + / 1000) * T + / 100000 * (u * u)).
  { eapply Rle_trans; [apply Rabs_plus_le; [apply Rle_refl | exact Q1]|]. fold T. lra. }
  assert (W1 : Rabs (w - (tau + tau * tau)) <= (1 + / 500) * u * T + / 50000 * (u * u)).
  { replace (w - (tau + tau * tau)) with ((w - (tau + q)) + (q - tau * tau)) by ring. eapply Rle_trans; [apply
    Rabs_plus_le; [exact X2 | exact X1]|].
    assert (u * Rabs (tau + q) <= u * ((1 + / 1000) * T + / 100000 * (u * u))) by (apply Rmult_le_compat_l; lra).
    assert (u * (T * T) <= u * (/ 524288 * T)) by (apply Rmult_le_compat_l; lra). rewrite u_val in *. lra. }
  assert (W2 : Rabs w <= (1 + / 500) * T + / 1000 * (u * u)).
  { replace w with ((w - (tau + q)) + (tau + q)) by ring. eapply Rle_trans; [apply Rabs_plus_le; [exact X2 | exact
    W0]|].
    assert (u * Rabs (tau + q) <= u * ((1 + / 1000) * T + / 100000 * (u * u))) by (apply Rmult_le_compat_l; lra).
      rewrite u_val in *. lra. }
  rewrite Rabs_mult in X3. assert (RW : Rabs r * Rabs w <= Rabs r * ((1 + / 500) * T + / 1000 * (u * u))) by (apply
    Rmult_le_compat_l; lra).
  assert (X3' : Rabs (r_low - r * w) <= ((1 + / 400) * u * T + / 20000 * (u * u)) * Rabs r).
  { eapply Rle_trans; [exact X3|]. assert (u * (Rabs r * Rabs w) <= u * (Rabs r * ((1 + / 500) * T + / 1000 * (u *
    u)))) by (apply Rmult_le_compat_l; lra).
    replace (u * (Rabs r * ((1 + / 500) * T + / 1000 * (u * u)))) with ((1 + / 500) * u * (T * Rabs r) + / 1000 * (u *
      u * u) * Rabs r) in H by ring.
    replace (((1 + / 400) * u * T + / 20000 * (u * u)) * Rabs r) with ((1 + / 400) * u * (T * Rabs r) + / 20000 * (u *
      u) * Rabs r) by ring.
    assert (0 <= T * Rabs r) by (apply Rmult_le_pos; lra). set (tr := T * Rabs r) in *. set (ar := Rabs r) in *. clear
      - H H0 TinyR RP. rewrite u_val in *. lra. }
  split; [|split].
  - replace (1 / D - (r + r_low)) with (r * (/ (1 - sigma) - (1 + tau + tau * tau)) - r * (w - (tau + tau * tau)) -
    (r_low - r * w)) by (rewrite ID; field; lra).
    eapply Rle_trans; [apply Rabs_minus_le; [apply Rabs_minus_le; [rewrite Rabs_mult; apply Rmult_le_compat_l; [lra |
      exact A1] | rewrite Rabs_mult; apply Rmult_le_compat_l; [lra | exact W1]] | exact X3']|].
    unfold etaR, kappa. set (t3 := T * T * T) in *. replace (Rabs r * (1145 / 1000 * ((1 + / 1000) * eta0 + 202 / 100
      * u * T + 104 / 100 * (u * u)) + 1001 / 1000 * t3) +
      Rabs r * ((1 + / 500) * u * T + / 50000 * (u * u)) + ((1 + / 400) * u * T + / 20000 * (u * u)) * Rabs r) with
      ((1145 / 1000 * ((1 + / 1000) * eta0 + 202 / 100 * u * T + 104 / 100 * (u * u)) + 1001 / 1000 * t3 + ((1 + /
        500) * u * T + / 50000 * (u * u)) + ((1 + / 400) * u * T + / 20000 * (u * u))) * Rabs r) by ring.
    apply Rmult_le_compat_r; [lra|]. clear - e0 T0. rewrite u_val. lra.
  - rewrite ID. unfold Rdiv. rewrite Rabs_mult, Rmult_comm. apply Rmult_le_compat_r; [lra|]. rewrite Rabs_inv,
    Rabs_pos_eq by lra. apply Rmult_le_reg_r with (1 - sigma); [lra|]. rewrite Rinv_l by lra. lra.
  - replace r_low with ((r_low - r * w) + r * w) by ring. eapply Rle_trans; [apply Rabs_plus_le; [exact X3' | rewrite
    Rabs_mult; exact RW]|].
    replace (((1 + / 400) * u * T + / 20000 * (u * u)) * Rabs r + Rabs r * ((1 + / 500) * T + / 1000 * (u * u))) with
      (((1 + / 400) * u * T + / 20000 * (u * u) + ((1 + / 500) * T + / 1000 * (u * u))) * Rabs r) by ring. 
    apply Rmult_le_compat_r; [lra|]. clear - T0. rewrite u_val. lra.
Qed.

(* A quotient: the numerator c within u b of h + l, |l| <= b; quotient + error = h r exactly; z the sum of h r_low and
  l r_sum, rounded once
   or twice. What underflows is far below. *)
Variables c h l b x z quotient error eta bd : R.
Hypotheses (Fh : F h) (Fl : F l) (Hc : Rabs (c - (h + l)) <= u * b) (Hl : Rabs l <= b) (Hq : quotient = RN (h * r))
  (Hqe : quotient + error = h * r) (Fe : F error)
  (Hx : Rabs (x - h * r_low) <= u * Rabs (h * r_low) + bp (-1075)) (Hz : z = RN (x + RN (l * r_sum)))
  (Tiny : bp (-1075) <= / 100000 * (u * u) * ((Rabs h + b) * Rabs r))
  (Heta : (1 - 16 * u) * (ETA_FACTOR * eta0 + ETA_ROUNDING * (u * u + T * (u + T * T))) <= eta)
  (Hbd : (1 - 8 * u) * (Rabs r * (eta * Rabs h + (eta + LOW_ROUNDING) * b)) <= bd) (Fbd : F bd).
Let correction := RN (error + z).

Theorem ETA_FACTOR_holds : D <> 0 /\ Rabs (c / D - (quotient + correction)) <= bd - u * (Rabs correction + bd).
Proof.
  destruct reciprocal as (D0 & R1 & R2 & R3). split; [exact D0|]. destruct r_near as (r0 & Rr & _). destruct
    sigma_near as (_ & e0 & _). pose proof u_pos as up.
  assert (T0 : 0 <= T) by apply Rabs_pos. assert (B19 : bp (-19) = / 524288) by (simpl; lra). rewrite B19 in T1. pose
    proof (Rabs_pos_lt r r0) as RP. pose proof (Rabs_pos h) as h0.
  assert (b0 : 0 <= b) by (pose proof (Rabs_pos l); lra). set (A := Rabs h * Rabs r). set (B := b * Rabs r). assert
    (A0 : 0 <= A) by (apply Rmult_le_pos; lra). assert (B0 : 0 <= B) by (apply Rmult_le_pos; lra).
  replace ((Rabs h + b) * Rabs r) with (A + B) in Tiny by (unfold A, B; ring). pose proof (bp_pos (-1075)) as P0.
  set (ph := (101 / 100) * T + / 500 * (u * u)) in *. assert (ph0 : 0 <= ph <= / 500000) by (unfold ph; split;
    [|rewrite u_val; lra]; assert (0 <= u * u) by apply sq_pos; lra).
  (* sizes *)
  assert (RL : Rabs (r_low) <= / 500000 * Rabs r) by (eapply Rle_trans; [exact R3|]; apply Rmult_le_compat_r; lra).
  pose proof (RN_sum r r_low (RN_F _) (RN_F _)) as RS. fold r_sum in RS. assert (RS1 : Rabs (r + r_low) <= (1 + /
    500000) * Rabs r) by (eapply Rle_trans; [apply Rabs_triang|]; lra).
  assert (RS2 : Rabs (r_sum - (r + r_low)) <= (1 + / 400000) * u * Rabs r).
  { eapply Rle_trans; [exact RS|]. assert (u * Rabs (r + r_low) <= u * ((1 + / 500000) * Rabs r)) by (apply
    Rmult_le_compat_l; lra). assert (0 <= u * Rabs r) by (apply Rmult_le_pos; lra). lra. }
  assert (RS3 : Rabs r_sum <= (1 + / 300000) * Rabs r).
  { replace r_sum with ((r_sum - (r + r_low)) + (r + r_low)) by ring. eapply Rle_trans; [apply Rabs_plus_le;
    eassumption|]. rewrite u_val in *. lra. }
  assert (HR : Rabs (h * r_low) <= ph * A) by (rewrite Rabs_mult; unfold A; replace (ph * (Rabs h * Rabs r)) with
    (Rabs h * (ph * Rabs r)) by ring; apply Rmult_le_compat_l; lra).
  assert (LR : Rabs (l * r_sum) <= (1 + / 300000) * B).
  { rewrite Rabs_mult. unfold B. replace ((1 + / 300000) * (b * Rabs r)) with (b * ((1 + / 300000) * Rabs r)) by ring.
    apply Rmult_le_compat; auto using Rabs_pos. }
  pose proof (RN_err (l * r_sum)) as Ey. set (y := RN (l * r_sum)) in *. pose proof (RN_err (x + y)) as Ez. rewrite <-
    Hz in Ez.
  assert (pa : 0 <= ph * A <= / 500000 * A) by (split; [apply Rmult_le_pos; lra | apply Rmult_le_compat_r; lra]). set
    (q := ph * A) in *.
  assert (Hx' : Rabs (x - h * r_low) <= u * q + / 100000 * (u * u) * (A + B)).
  { eapply Rle_trans; [exact Hx|]. assert (u * Rabs (h * r_low) <= u * q) by (apply Rmult_le_compat_l; lra). lra. }
  assert (Ey' : Rabs (y - l * r_sum) <= (1 + / 250000) * u * B + / 100000 * (u * u) * (A + B)).
  { eapply Rle_trans; [exact Ey|]. assert (u * Rabs (l * r_sum) <= u * ((1 + / 300000) * B)) by (apply
    Rmult_le_compat_l; lra). assert (0 <= u * B) by (apply Rmult_le_pos; lra). lra. }
  assert (XY : Rabs (x + y) <= (1 + / 100000) * q + (1 + / 200000) * B + / 10000 * u * A).
  { replace (x + y) with ((x - h * r_low) + h * r_low + ((y - l * r_sum) + l * r_sum)) by ring. eapply Rle_trans;
    [apply Rabs_plus_le; [apply Rabs_plus_le; [exact Hx' | exact HR] | apply Rabs_plus_le; [exact Ey' | exact LR]]|].
    clear - pa A0 B0. rewrite u_val in *. lra. }
  assert (Ez' : Rabs (z - (x + y)) <= (1 + / 100000) * u * q + (1 + / 100000) * u * B + / 5000 * (u * u) * A).
  { eapply Rle_trans; [exact Ez|]. assert (u * Rabs (x + y) <= u * ((1 + / 100000) * q + (1 + / 200000) * B + / 10000
    * u * A)) by (apply Rmult_le_compat_l; lra).
    clear - H Tiny pa A0 B0. rewrite u_val in *. lra. }
  assert (Z1 : Rabs z <= (1 + / 50000) * q + (1 + / 100000) * B + / 5000 * u * A).
  { replace z with ((z - (x + y)) + (x + y)) by ring. eapply Rle_trans; [apply Rabs_plus_le; [exact Ez' | exact XY]|].
    clear - pa A0 B0. rewrite u_val in *. lra. }
  assert (ER : Rabs error <= (1 + / 1000) * u * A + / 1000 * (u * u) * B).
  { pose proof (RN_err (h * r)) as E. rewrite <- Hq in E. replace error with (- (quotient - h * r)) by lra. rewrite
    Rabs_Ropp. eapply Rle_trans; [exact E|]. rewrite Rabs_mult. fold A. clear - Tiny A0 B0. rewrite u_val in *. lra. }
  pose proof (RN_sum error z Fe ltac:(rewrite Hz; apply RN_F)) as Ec. fold correction in Ec.
  assert (CS : Rabs (error + z) <= (1 + / 40000) * q + (1 + / 50000) * B + (1 + / 500) * u * A).
  { eapply Rle_trans; [apply Rabs_plus_le; eassumption|]. clear - pa A0 B0. rewrite u_val in *. lra. }
  assert (Ec' : Rabs (correction - (error + z)) <= u * ((1 + / 40000) * q + (1 + / 50000) * B + (1 + / 500) * u * A))
    by (eapply Rle_trans; [exact Ec|]; apply Rmult_le_compat_l; lra).
  assert (CB : Rabs correction <= (1 + / 30000) * q + (1 + / 40000) * B + (1 + / 400) * u * A).
  { replace correction with ((correction - (error + z)) + (error + z)) by ring. eapply Rle_trans; [apply Rabs_plus_le;
    [exact Ec' | exact CS]|]. clear - pa A0 B0. rewrite u_val in *. lra. }
  (* the exact quotient *)
  set (eR := 1147 / 1000 * eta0 + 434 / 100 * u * T + 121 / 100 * (u * u) + 1001 / 1000 * (T * T * T)) in *.
  assert (T3 : 0 <= T * T * T) by (repeat apply Rmult_le_pos; assumption). assert (eR0 : 0 <= eR) by (unfold eR; clear
    - e0 T0 T3; rewrite u_val; lra).
  assert (M1 : Rabs ((c - (h + l)) * (1 / D)) <= (1145 / 1000) * u * B).
  { rewrite Rabs_mult. apply Rle_trans with (u * b * (1145 / 1000 * Rabs r)); [apply Rmult_le_compat; auto using
    Rabs_pos | unfold B; apply Req_le; ring]. }
  assert (HL : Rabs (h + l) <= Rabs h + b) by (eapply Rle_trans; [apply Rabs_triang|]; lra).
  assert (M2 : Rabs ((h + l) * (1 / D - (r + r_low))) <= eR * (A + B)).
  { rewrite Rabs_mult. apply Rle_trans with ((Rabs h + b) * (eR * Rabs r)); [apply Rmult_le_compat; auto using
    Rabs_pos | unfold A, B; apply Req_le; ring]. }
  assert (M3 : Rabs (l * (r_sum - (r + r_low))) <= (1 + / 400000) * u * B).
  { rewrite Rabs_mult. apply Rle_trans with (b * ((1 + / 400000) * u * Rabs r)); [apply Rmult_le_compat; auto using
    Rabs_pos | unfold B; apply Req_le; ring]. }
  assert (Sum : Rabs (c / D - (quotient + correction)) + u * Rabs correction <= eR * (A + B) + (41 / 10) * u * q + (21
    / 10) * (u * u) * A + (62 / 10) * u * B).
  { replace (c / D - (quotient + correction)) with ((c - (h + l)) * (1 / D) + (h + l) * (1 / D - (r + r_low)) - l *
    (r_sum - (r + r_low)) - (x - h * r_low) - (y - l * r_sum) - (z - (x + y)) - (correction - (error + z))).
    - assert (u * Rabs correction <= u * ((1 + / 30000) * q + (1 + / 40000) * B + (1 + / 400) * u * A)) by (apply
      Rmult_le_compat_l; lra).
      eapply Rle_trans; [apply Rplus_le_compat; [|exact H]; apply Rabs_minus_le; [apply Rabs_minus_le; [apply
        Rabs_minus_le; [apply Rabs_minus_le; [apply Rabs_minus_le; [apply Rabs_plus_le; [exact M1 | exact M2] | exact
          M3] | exact Hx'] | exact Ey'] | exact Ez'] | exact Ec']|].
      set (v := eR * (A + B)) in *. clear - pa A0 B0. rewrite u_val in *. lra.
    - replace (c / D) with (c * (1 / D)) by (field; assumption). replace quotient with (h * r - error) by lra. ring. }
  assert (PQ : q <= (101 / 100) * (T * A) + / 500 * (u * u) * A) by (unfold q, ph; apply Req_le; ring).
  assert (TA : 0 <= T * A) by (apply Rmult_le_pos; assumption).
  assert (ET : eR + (42 / 10) * u * T + (22 / 10) * (u * u) <= 6 / 10 * eta).
  { unfold ETA_FACTOR, ETA_ROUNDING in Heta. unfold eR. replace (T * (u + T * T)) with (u * T + T * T * T) in Heta by
    ring. set (t3 := T * T * T) in *. clear - Heta e0 T0 T3. rewrite u_val in *. lra. }
  assert (eta1 : 0 <= eta) by (assert (0 <= 42 / 10 * u * T) by (apply Rmult_le_pos; lra); assert (0 <= u * u) by
    apply sq_pos; clear - ET eR0 H H0; rewrite u_val in *; lra).
  assert (BD : (1 - 8 * u) * (eta * A + (eta + 8 * u) * B) <= bd).
  { eapply Rle_trans; [|exact Hbd]. unfold LOW_ROUNDING, A, B. apply Req_le. ring. }
  assert (F1 : (eR + 42 / 10 * u * T + 22 / 10 * (u * u)) * (A + B) <= 6 / 10 * eta * (A + B)) by (apply
    Rmult_le_compat_r; lra).
  assert (eA : 0 <= eta * A) by (apply Rmult_le_pos; assumption). assert (eB : 0 <= eta * B) by (apply Rmult_le_pos;
    assumption).
  replace ((eR + 42 / 10 * u * T + 22 / 10 * (u * u)) * (A + B)) with (eR * (A + B) + 42 / 10 * u * (T * A) + 42 / 10
    * u * (T * B) + 22 / 10 * (u * u) * (A + B)) in F1 by ring.
  replace (6 / 10 * eta * (A + B)) with (6 / 10 * (eta * A + eta * B)) in F1 by ring. replace (eta * A + (eta + 8 * u)
    * B) with (eta * A + eta * B + 8 * u * B) in BD by ring.
  assert (TB : 0 <= T * B) by (apply Rmult_le_pos; assumption). set (v := eR * (A + B)) in *. set (ea := eta * A) in
    *. set (eb := eta * B) in *. set (ta := T * A) in *. set (tb := T * B) in *.
  set (w1 := Rabs (c / D - (quotient + correction))) in *. set (w2 := Rabs correction) in *.
  assert (Goal1 : w1 + u * w2 <= (1 - 3 * u) * bd); [|assert (0 <= bd) by (clear - BD eA eB B0; rewrite u_val in *;
    lra); rewrite u_val in *; lra].
  clear - Sum PQ F1 BD TA TB eA eB A0 B0 pa. rewrite u_val in *. lra.
Qed.
Theorem ETA_ROUNDING_holds : RN (quotient + RN (correction - bd)) = RN (quotient + RN (correction + bd)) -> RN
  (quotient + RN (correction + bd)) = RN (c / D).
Proof.
  intro Same. destruct ETA_FACTOR_holds as [_ H]. pose proof u_pos as up. pose proof (Rabs_pos (c / D - (quotient +
    correction))). pose proof (Rabs_pos correction).
  assert (0 <= bd) by (assert (0 <= u * Rabs correction) by (apply Rmult_le_pos; lra); rewrite u_val in *; lra).
  apply (Round.round_if_certain (c / D) quotient correction bd); auto; try (rewrite Hq; apply RN_F); apply RN_F.
Qed.
Theorem LOW_ROUNDING_holds : (62 / 10) * u <= (1 - 32 * u) * LOW_ROUNDING.
Proof. unfold LOW_ROUNDING. rewrite u_val. lra. Qed.
End Reciprocal.

(* ---- Sums of rows: three numerators h_k + l_k within u b_k; the high parts are summed without error. ---- *)
Theorem TERMS_FACTOR_holds : forall c0 c1 c2 h0 h1 h2 l0 l1 l2 b0 b1 b2 e1 e2 s b, F l0 -> F l1 -> F l2 -> F e1 -> F
  e2 -> s + e1 + e2 = h0 + h1 + h2 ->
  Rabs (c0 - (h0 + l0)) <= u * b0 -> Rabs (c1 - (h1 + l1)) <= u * b1 -> Rabs (c2 - (h2 + l2)) <= u * b2 ->
  let low := RN (RN (e1 + e2) + RN (RN (l0 + l1) + l2)) in
  (1 - 16 * u) * (TERMS_FACTOR * (Rabs e1 + Rabs e2 + (Rabs l0 + Rabs l1 + Rabs l2)) + ENTRIES_FACTOR * (b0 + b1 +
    b2)) <= b ->
  Rabs (c0 + c1 + c2 - (s + low)) <= u * b /\ Rabs low <= b.
Proof.
  intros c0 c1 c2 h0 h1 h2 l0 l1 l2 b0 b1 b2 e1 e2 s b F0 F1 F2 Fe1 Fe2 HS C0 C1 C2 low Hb. pose proof u_pos as up.
  pose proof (RN_sum e1 e2 Fe1 Fe2) as E1. pose proof (RN_sum l0 l1 F0 F1) as E2. set (x := RN (e1 + e2)) in *. set (y
    := RN (l0 + l1)) in *.
  pose proof (RN_sum y l2 (RN_F _) F2) as E3. set (z := RN (y + l2)) in *. pose proof (RN_sum x z (RN_F _) (RN_F _))
    as E4. fold low in E4.
  pose proof (Rabs_pos (c0 - (h0 + l0))). pose proof (Rabs_pos (c1 - (h1 + l1))). pose proof (Rabs_pos (c2 - (h2 +
    l2))).
  assert (B0 : 0 <= b0) by (apply Rmult_le_reg_l with u; lra). assert (B1 : 0 <= b1) by (apply Rmult_le_reg_l with u;
    lra). assert (B2 : 0 <= b2) by (apply Rmult_le_reg_l with u; lra).
  set (E := Rabs e1 + Rabs e2) in *. set (L := Rabs l0 + Rabs l1 + Rabs l2) in *.
  assert (X1 : Rabs (e1 + e2) <= E) by apply Rabs_triang. assert (Y1 : Rabs (l0 + l1) + Rabs l2 <= L) by (unfold L;
    pose proof (Rabs_triang l0 l1); lra).
  pose proof (Rabs_pos l2) as p2. pose proof (Rabs_pos (l0 + l1)) as p1. assert (E0 : 0 <= E) by (pose proof (Rabs_pos
    (e1 + e2)); lra). assert (L0 : 0 <= L) by lra.
  assert (X2 : Rabs x <= (1 + u) * E).
  { replace x with ((x - (e1 + e2)) + (e1 + e2)) by ring. eapply Rle_trans; [apply Rabs_triang|]. assert (u * Rabs (e1
    + e2) <= u * E) by (apply Rmult_le_compat_l; lra). lra. }
  assert (Y2 : Rabs (y + l2) <= (1 + u) * L).
  { replace (y + l2) with ((y - (l0 + l1)) + (l0 + l1) + l2) by ring. eapply Rle_trans; [apply Rabs_triang|]. eapply
    Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
    assert (u * Rabs (l0 + l1) <= u * L) by (apply Rmult_le_compat_l; lra). lra. }
  assert (Z2 : Rabs z <= (1 + 3 * u) * L).
  { replace z with ((z - (y + l2)) + (y + l2)) by ring. eapply Rle_trans; [apply Rabs_triang|]. assert (u * Rabs (y +
    l2) <= u * ((1 + u) * L)) by (apply Rmult_le_compat_l; lra). rewrite u_val in *. lra. }
  assert (XZ : Rabs (x + z) <= (1 + 3 * u) * (E + L)) by (eapply Rle_trans; [apply Rabs_triang|]; rewrite u_val in *;
    lra).
  assert (L1 : Rabs low <= (1 + 5 * u) * (E + L)).
  { replace low with ((low - (x + z)) + (x + z)) by ring. eapply Rle_trans; [apply Rabs_triang|]. assert (u * Rabs (x
    + z) <= u * ((1 + 3 * u) * (E + L))) by (apply Rmult_le_compat_l; lra). rewrite u_val in *. lra. }
  unfold TERMS_FACTOR, ENTRIES_FACTOR in Hb. split.
  - replace (c0 + c1 + c2 - (s + low)) with ((c0 - (h0 + l0)) + (c1 - (h1 + l1)) + (c2 - (h2 + l2)) - (low - (x + z))
    - (z - (y + l2)) - (y - (l0 + l1)) - (x - (e1 + e2))) by lra.
    eapply Rle_trans; [apply Rabs_minus_le; [apply Rabs_minus_le; [apply Rabs_minus_le; [apply Rabs_minus_le; [apply
      Rabs_plus_le; [apply Rabs_plus_le; [exact C0 | exact C1] | exact C2] | exact E4] | exact E3] | exact E2] | exact
        E1]|].
    assert (G : b0 + b1 + b2 + Rabs (x + z) + Rabs (y + l2) + Rabs (l0 + l1) + Rabs (e1 + e2) <= b).
    { set (v1 := Rabs (x + z)) in *. set (v2 := Rabs (y + l2)) in *. set (v3 := Rabs (l0 + l1)) in *. set (v4 := Rabs
      (e1 + e2)) in *. clear - XZ Y2 Y1 X1 Hb B0 B1 B2 E0 L0 p2. rewrite u_val in *. lra. }
    apply Rmult_le_compat_l with (r := u) in G; [|lra]. lra.
  - clear - L1 Hb B0 B1 B2 E0 L0. rewrite u_val in *. lra.
Qed.
Theorem ENTRIES_FACTOR_holds : 1 <= (1 - 16 * u) * ENTRIES_FACTOR. Proof. unfold ENTRIES_FACTOR. rewrite u_val. lra.
  Qed.
