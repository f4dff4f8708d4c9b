(* rt-math, reflect.rs: a component of a reflected vector in double-double, `bounds`. *)
From Proofs Require Import Rounding ErrorFree.
Open Scope R_scope.

(* The error of a component, relative to |v_i| + A |n_i| / N. *)
Definition ERROR := bp (-97).

(* In the range of the stage (docs/numerics.md, 4.4) a product is zero or normal. *)
Definition in_range x := x = 0 \/ bp (-1022) <= Rabs x.
Lemma RN_product : forall x, in_range x -> Rabs (RN x - x) <= u * Rabs x.
Proof.
  intros x [Z|N]; [|now apply RN_normal]. rewrite Z, RN_0. replace (0 - 0) with 0 by ring. rewrite Rabs_R0. lra.
Qed.

(* `dot_and_size`: three products and two sums with their errors, and these summed. *)
Section Dot.
Variables p0 p1 p2 x y z xl yl zl : R. (* the exact products, their high and low parts *)
Hypotheses (H0 : x + xl = p0) (H1 : y + yl = p1) (H2 : z + zl = p2) (Fx : F x) (Fy : F y) (Fz : F z)
  (Fxl : F xl) (Fyl : F yl) (Fzl : F zl)
  (L0 : Rabs xl <= u * Rabs p0) (L1 : Rabs yl <= u * Rabs p1) (L2 : Rabs zl <= u * Rabs p2).
Let xy := RN (x + y). Let xy_low := two_sum_error x y.
Let sum := RN (xy + z). Let sum_low := two_sum_error xy z.
Let low := RN (RN (xy_low + sum_low) + RN (RN (xl + yl) + zl)).
Let A := Rabs p0 + Rabs p1 + Rabs p2.
Theorem dot_error : Rabs (sum + low - (p0 + p1 + p2)) <= (7 + / 50) * (u * u) * A /\ Rabs low <= (3 + / 100) * u * A /\
  Rabs sum <= (1 + 4 * u) * A.
Proof.
  pose proof (two_sum x y Fx Fy) as T1. pose proof (two_sum xy z (RN_F _) Fz) as T2. fold xy xy_low in T1.
  fold sum sum_low in T2.
  destruct (two_sum_error_le x y Fx Fy) as [E1 _]. destruct (two_sum_error_le xy z (RN_F _) Fz) as [E2 _].
  fold xy_low in E1. fold sum_low in E2.
  pose proof (RN_sum xy_low sum_low (RN_F _) (RN_F _)) as R1. set (a := RN (xy_low + sum_low)) in *.
  pose proof (RN_sum xl yl Fxl Fyl) as R2. set (b := RN (xl + yl)) in *.
  pose proof (RN_sum b zl (RN_F _) Fzl) as R3. set (c := RN (b + zl)) in *.
  pose proof (RN_sum a c (RN_F _) (RN_F _)) as R4. change (RN (a + c)) with low in R4.
  pose proof (Rabs_pos p0). pose proof (Rabs_pos p1). pose proof (Rabs_pos p2). assert (A0 : 0 <= A) by (unfold A; lra).
  assert (I : forall p, - Rabs p <= p <= Rabs p) by (intro p; apply Rabs_le_inv; lra).
  pose proof (I p0) as I0. pose proof (I p1) as I1. pose proof (I p2) as I2.
  set (m0 := Rabs p0) in *. set (m1 := Rabs p1) in *. set (m2 := Rabs p2) in *.
  pose proof L0 as L0'. pose proof L1 as L1'. pose proof L2 as L2'.
  apply Rabs_le_inv in L0'. apply Rabs_le_inv in L1'. apply Rabs_le_inv in L2'.
  assert (B1 : Rabs (x + y) <= (1 + u) * A) by (unfold A; apply Rabs_le; rewrite u_val in *; lra).
  assert (B2 : Rabs xy_low <= (1 + / 1000) * (u * A)) by (rewrite u_val in *; lra).
  pose proof B2 as B2'. apply Rabs_le_inv in B2'.
  assert (B3 : Rabs (xy + z) <= (1 + 3 * u) * A) by (unfold A in *; apply Rabs_le; rewrite u_val in *; lra).
  assert (B4 : Rabs sum_low <= (1 + / 1000) * (u * A)) by (rewrite u_val in *; lra).
  pose proof B4 as B4'. apply Rabs_le_inv in B4'.
  assert (C1 : Rabs (xy_low + sum_low) <= (2 + / 400) * (u * A)) by (apply Rabs_le; lra).
  assert (C2 : Rabs (xl + yl) <= u * (m0 + m1)) by (apply Rabs_le; lra).
  assert (D1' : Rabs (a - (xy_low + sum_low)) <= (2 + / 300) * (u * u * A)) by (rewrite u_val in *; lra).
  assert (D2' : Rabs (b - (xl + yl)) <= u * u * A) by (unfold A; rewrite u_val in *; lra).
  pose proof D2' as D2''. apply Rabs_le_inv in D2''. pose proof C2 as C2'. apply Rabs_le_inv in C2'.
  assert (C3 : Rabs (b + zl) <= (1 + / 1000) * (u * A)) by (unfold A in *; apply Rabs_le; rewrite u_val in *; lra).
  assert (D3' : Rabs (c - (b + zl)) <= (1 + / 500) * (u * u * A)) by (rewrite u_val in *; lra).
  pose proof D1' as D1''. apply Rabs_le_inv in D1''. pose proof D3' as D3''. apply Rabs_le_inv in D3''.
  pose proof C1 as C1'. apply Rabs_le_inv in C1'. pose proof C3 as C3'. apply Rabs_le_inv in C3'.
  assert (C4 : Rabs (a + c) <= (3 + / 200) * (u * A)) by (apply Rabs_le; rewrite u_val in *; lra).
  assert (D4 : Rabs (low - (a + c)) <= (3 + / 200) * (u * u * A)) by (rewrite u_val in *; lra).
  pose proof D4 as D4'. apply Rabs_le_inv in D4'. pose proof C4 as C4'. apply Rabs_le_inv in C4'.
  split; [|split].
  - apply Rabs_le. lra.
  - apply Rabs_le. rewrite u_val in *. lra.
  - apply Rabs_le. unfold A in *. rewrite u_val in *. lra.
Qed.
End Dot.

Section Component.
(* A = sum |v_j n_j| and N = n.n exactly; S = v.n as vn + vl, N as nn + nl; the component v with its normal's n *)
Variables A N S vn vl nn nl v n size : R.
Hypotheses (N0 : 0 < N) (A0 : 0 < A)
  (HS : Rabs (vn + vl - S) <= (7 + / 50) * (u * u) * A) (Hvl : Rabs vl <= (3 + / 100) * u * A) (Hvn : Rabs vn <= (1 +
    4 * u) * A)
  (HN : Rabs (nn + nl - N) <= (7 + / 50) * (u * u) * N) (Hnl : Rabs nl <= (3 + / 100) * u * N)
  (Fvl : F vl) (Fnl : F nl) (Fv : F v) (Fn : F n) (Hsize : (1 - 4 * u) * A <= size).
Let inverse := RN (1 / nn).
Let k := RN (2 * vn * inverse).
(* the remainder 2 vn - k nn, rounded once *)
Let rest := RN (2 * vn - k * nn).
Let correction := RN (rest + RN (2 * vl - RN (k * nl))).
Let k_low := RN (correction * inverse).
Variables kn kl : R.
Hypotheses (Hk : kn + kl = k * n) (Fkn : F kn) (Fkl : F kl) (Hkl : Rabs kl <= u * Rabs (k * n)).
Let x := RN (v - kn). Let x_error := two_sum_error v (- kn).
Let x_low := RN (x_error - RN (kl + RN (k_low * n))).
Hypotheses (R1 : in_range (1 / nn)) (R2 : in_range (2 * vn * inverse)) (R3 : in_range (2 * vn - k * nn))
  (R4 : in_range (k * nl)) (R5 : in_range (correction * inverse)) (R6 : in_range (k_low * n)) (F2 : F (2 * vl)).
Let K := 2 * S / N.

(* The factor k + k_low. *)
Lemma factor : Rabs (k + k_low - K) <= 170 * (u * u) * (A / N) /\ Rabs k_low <= (16 + 8 / 10) * u * (A / N) /\
  Rabs k <= (2 + / 100) * (A / N).
Proof.
  apply Rabs_le_inv in Hnl. apply Rabs_le_inv in HN. pose proof u_pos.
  assert (N1 : (1 - (3 + / 50) * u) * N <= nn <= (1 + (3 + / 50) * u) * N) by (rewrite u_val in *; lra).
  assert (nn0 : 0 < nn) by (rewrite u_val in *; lra).
  (* everything times N *)
  set (q := inverse * N). assert (Q1 : Rabs (q - 1) <= (4 + / 20) * u).
  { pose proof (RN_product _ R1) as P. fold inverse in P. rewrite (Rabs_pos_eq (1 / nn)) in P by (apply Rlt_le;
    unfold Rdiv; rewrite Rmult_1_l; now apply Rinv_0_lt_compat).
    assert (P2 : Rabs (inverse * nn - 1) <= u).
    { replace (inverse * nn - 1) with ((inverse - 1 / nn) * nn) by (field; lra).
    rewrite Rabs_mult, (Rabs_pos_eq nn) by lra.
      apply Rle_trans with (u * (1 / nn) * nn); [apply Rmult_le_compat_r; lra|]. right. field. lra. }
    apply Rabs_le_inv in P2. assert (I1 : inverse * ((1 - (3 + / 50) * u) * N) <= 1 + u).
    { apply Rle_trans with (inverse * nn); [|lra]. apply Rmult_le_compat_l; [|lra].
      apply Rmult_le_reg_r with nn; [assumption|]. rewrite u_val in *. lra. }
    assert (I0 : 0 <= inverse) by (apply Rmult_le_reg_r with nn; [assumption|]; rewrite u_val in *; lra).
    assert (I2 : 1 - u <= inverse * ((1 + (3 + / 50) * u) * N)) by (apply Rle_trans with (inverse * nn);
      [lra | apply Rmult_le_compat_l; lra]).
    replace (inverse * ((1 - (3 + / 50) * u) * N)) with ((1 - (3 + / 50) * u) * q) in I1 by (unfold q; ring).
    replace (inverse * ((1 + (3 + / 50) * u) * N)) with ((1 + (3 + / 50) * u) * q) in I2 by (unfold q; ring).
    clearbody q. apply Rabs_le. rewrite u_val in *. split; lra. }
  assert (NN : forall a, a / N * N = a) by (intro; field; lra).
  pose proof (RN_product _ R1) as P1. fold inverse in P1.
  assert (V : Rabs (inverse * nn - 1) <= u).
  { replace (inverse * nn - 1) with ((inverse - 1 / nn) * nn) by (field; lra).
  rewrite Rabs_mult, (Rabs_pos_eq nn) by lra.
    rewrite (Rabs_pos_eq (1 / nn)) in P1 by (apply Rlt_le; unfold Rdiv; rewrite Rmult_1_l; now apply Rinv_0_lt_compat).
    apply Rle_trans with (u * (1 / nn) * nn); [apply Rmult_le_compat_r; lra|]. right. field. lra. }
  (* k nn is nearly 2 vn *)
  assert (M1 : Rabs (2 * vn - k * nn) <= (4 + / 50) * (u * A)).
  { pose proof (RN_product _ R2) as P. fold k in P.
    replace (2 * vn - k * nn) with (- ((k - 2 * vn * inverse) * nn) - 2 * vn * (inverse * nn - 1)) by ring.
    unfold Rminus at 1. eapply Rle_trans; [apply Rabs_triang|].
    rewrite !Rabs_Ropp, !Rabs_mult, (Rabs_pos_eq nn), (Rabs_pos_eq 2) by lra.
    assert (Rabs (inverse * nn) <= 1 + u) by (apply Rabs_le_inv in V; apply Rabs_le; lra).
    assert (J1 : Rabs (k - 2 * vn * inverse) * nn <= u * (2 * (Rabs vn * Rabs (inverse * nn)))).
    { apply Rle_trans with (u * Rabs (2 * vn * inverse) * nn); [apply Rmult_le_compat_r; lra|].
    rewrite !Rabs_mult, (Rabs_pos_eq 2), (Rabs_pos_eq nn) by lra.
      right. ring. }
    assert (J2 : Rabs vn * Rabs (inverse * nn - 1) <= ((1 + 4 * u) * A) * u) by (apply Rmult_le_compat;
      auto using Rabs_pos).
    assert (J3 : Rabs vn * Rabs (inverse * nn) <= ((1 + 4 * u) * A) * (1 + u)) by (apply Rmult_le_compat;
      auto using Rabs_pos).
    rewrite u_val in *. lra. }
  assert (K1 : Rabs (k * nn) <= (2 + 20 * u) * A).
  { replace (k * nn) with (2 * vn + - (2 * vn - k * nn)) by ring. eapply Rle_trans; [apply Rabs_triang|].
  rewrite Rabs_Ropp, (Rabs_mult 2), (Rabs_pos_eq 2) by lra.
    rewrite u_val in *. lra. }
  assert (K2 : Rabs (k * N) <= (2 + 40 * u) * A).
  { rewrite Rabs_mult, (Rabs_pos_eq N) by lra. rewrite Rabs_mult, (Rabs_pos_eq nn) in K1 by lra.
  pose proof (Rabs_pos k).
    assert (Rabs k * ((1 - (3 + / 50) * u) * N) <= Rabs k * nn) by (apply Rmult_le_compat_l; lra).
    set (kN := Rabs k * N) in *. assert ((1 - (3 + / 50) * u) * kN <= (2 + 20 * u) * A) by (unfold kN; lra).
    clearbody kN. rewrite u_val in *. lra. }
  assert (KL : Rabs (k * nl) <= (6 + / 30) * (u * A)).
  { assert (Rabs nl <= (3 + / 100) * u * N) by (apply Rabs_le; lra). rewrite Rabs_mult.
    apply Rle_trans with (Rabs k * ((3 + / 100) * u * N)); [apply Rmult_le_compat_l; [apply Rabs_pos | assumption]|].
    replace (Rabs k * ((3 + / 100) * u * N)) with ((3 + / 100) * (u * Rabs (k * N))) by (rewrite Rabs_mult,
      (Rabs_pos_eq N); lra).
    assert (u * Rabs (k * N) <= u * ((2 + 40 * u) * A)) by (apply Rmult_le_compat_l; lra). rewrite u_val in *. lra. }
  pose proof (RN_product _ R3) as E1. fold rest in E1. pose proof (RN_product _ R4) as E2. set (m := RN (k * nl)) in *.
  pose proof (RN_diff (2 * vl) m F2 (RN_F _)) as E3. set (g := RN (2 * vl - m)) in *.
  pose proof (RN_sum rest g (RN_F _) (RN_F _)) as E4. change (RN (rest + g)) with correction in E4.
  pose proof (RN_product _ R5) as E5. change (RN (correction * inverse)) with k_low in E5.
  apply Rabs_le_inv in Hvl.
  assert (G1 : Rabs (rest - (2 * vn - k * nn)) <= (4 + / 40) * (u * u * A)) by (rewrite u_val in *; lra).
  assert (G2 : Rabs (m - k * nl) <= (6 + / 30) * (u * u * A)) by (rewrite u_val in *; lra).
  pose proof G1 as G1'. apply Rabs_le_inv in G1'. pose proof G2 as G2'. apply Rabs_le_inv in G2'.
  pose proof M1 as M1'. apply Rabs_le_inv in M1'.
  pose proof KL as KL'. apply Rabs_le_inv in KL'.
  assert (G3 : Rabs (2 * vl - m) <= (12 + / 10) * (u * A)) by (apply Rabs_le; rewrite u_val in *; lra).
  assert (G4 : Rabs (g - (2 * vl - m)) <= (12 + / 10) * (u * u * A)) by (rewrite u_val in *; lra).
  pose proof G4 as G4'. apply Rabs_le_inv in G4'. pose proof G3 as G3'. apply Rabs_le_inv in G3'.
  assert (G5 : Rabs (rest + g) <= (16 + 2 / 10) * (u * A)) by (apply Rabs_le; rewrite u_val in *; lra).
  assert (G6 : Rabs (correction - (rest + g)) <= (16 + 2 / 10) * (u * u * A)) by (rewrite u_val in *; lra).
  pose proof G6 as G6'. apply Rabs_le_inv in G6'. pose proof G5 as G5'. apply Rabs_le_inv in G5'.
  assert (G7 : Rabs correction <= (16 + 3 / 10) * (u * A)) by (apply Rabs_le; rewrite u_val in *; lra).
  (* against the exact (K - k) N *)
  apply Rabs_le_inv in HS.
  assert (G8 : Rabs (correction - (2 * S - k * N)) <= (39 + 1 / 10 + 14 + 15 + / 10) * (u * u * A)).
  { assert (KN : Rabs (k * (nn + nl - N)) <= (14 + / 10 + / 100) * (u * u * A)).
    { rewrite Rabs_mult. apply Rle_trans with (Rabs k * ((7 + / 50) * (u * u) * N)); [apply Rmult_le_compat_l;
      [apply Rabs_pos | apply Rabs_le; lra]|].
      replace (Rabs k * ((7 + / 50) * (u * u) * N)) with ((7 + / 50) * (u * u) * Rabs (k * N)) by (rewrite Rabs_mult,
        (Rabs_pos_eq N); lra).
      assert (u * u * Rabs (k * N) <= u * u * ((2 + 40 * u) * A)) by (apply Rmult_le_compat_l; [rewrite u_val;
        lra | assumption]).
      rewrite u_val in *. lra. }
    apply Rabs_le_inv in KN. apply Rabs_le. rewrite Rmult_minus_distr_l, Rmult_plus_distr_l in KN. split; lra. }
  assert (AN : 0 < A / N) by (apply Rmult_lt_0_compat; [assumption | now apply Rinv_0_lt_compat]).
  assert (W1 : Rabs (correction * inverse * N - correction) <= (16 + 3 / 10) * (u * A) * ((4 + / 20) * u)).
  { replace (correction * inverse * N - correction) with (correction * (q - 1)) by (unfold q; ring). rewrite Rabs_mult.
    apply Rmult_le_compat; auto using Rabs_pos. }
  assert (W2 : Rabs (correction * inverse * N) <= (16 + 4 / 10) * (u * A)).
  { replace (correction * inverse * N) with ((correction * inverse * N - correction) + correction) by ring.
  eapply Rle_trans; [apply Rabs_triang|].
    rewrite u_val in *. lra. }
  assert (W3 : Rabs (k_low * N - correction * inverse * N) <= (16 + 4 / 10) * (u * u * A)).
  { replace (k_low * N - correction * inverse * N) with ((k_low - correction * inverse) * N) by ring.
  rewrite Rabs_mult, (Rabs_pos_eq N) by lra.
    apply Rle_trans with (u * Rabs (correction * inverse) * N); [apply Rmult_le_compat_r; lra|].
    replace (u * Rabs (correction * inverse) * N) with (u * Rabs (correction * inverse * N)) by (rewrite (Rabs_mult
      (correction * inverse)), (Rabs_pos_eq N); lra).
    assert (u * Rabs (correction * inverse * N) <= u * ((16 + 4 / 10) * (u * A))) by (apply Rmult_le_compat_l; lra).
    lra. }
  assert (DIV : forall a b, Rabs (a * N) <= b * A -> Rabs a <= b * (A / N)).
  { intros a b H2. rewrite Rabs_mult, (Rabs_pos_eq N) in H2 by lra. apply Rmult_le_reg_r with N; [assumption|].
    replace (b * (A / N) * N) with (b * A) by (field; lra). exact H2. }
  split; [|split].
  - apply DIV. unfold K. replace ((k + k_low - 2 * S / N) * N) with
      ((k_low * N - correction * inverse * N) + (correction * inverse * N - correction) + (correction - (2 * S - k *
        N))) by (field; lra).
    eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
    rewrite u_val in *. lra.
  - apply DIV. replace (k_low * N) with ((k_low * N - correction * inverse * N) + correction * inverse * N) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite u_val in *. lra.
  - apply DIV. rewrite u_val in *. lra.
Qed.

(* A component is off by less than ERROR (|v| + A |n| / N), the rounding test included. *)
Theorem ERROR_holds : forall e, (1 - 32 * u) * (ERROR * (Rabs v + A / N * Rabs n)) <= e ->
  Rabs (v - K * n - (x + x_low)) <= e - u * (Rabs x_low + e).
Proof.
  intros e He. destruct factor as (E1 & E2 & E3). set (w := A / N * Rabs n) in *.
  assert (AN : 0 < A / N) by (apply Rmult_lt_0_compat; [assumption | now apply Rinv_0_lt_compat]).
  assert (w0 : 0 <= w) by (apply Rmult_le_pos; [lra | apply Rabs_pos]). pose proof (Rabs_pos v) as v0.
  set (a := Rabs v) in *. pose proof u_pos.
  assert (P1 : Rabs ((k + k_low - K) * n) <= 170 * (u * u) * w).
  { rewrite Rabs_mult. unfold w. replace (170 * (u * u) * (A / N * Rabs n)) with (170 * (u * u) * (A / N) * Rabs n) by
    ring.
    apply Rmult_le_compat_r; [apply Rabs_pos | assumption]. }
  assert (P2 : Rabs (k_low * n) <= (16 + 8 / 10) * (u * w)).
  { rewrite Rabs_mult. unfold w. replace ((16 + 8 / 10) * (u * (A / N * Rabs n))) with ((16 + 8 / 10) * u * (A / N) *
    Rabs n) by ring.
    apply Rmult_le_compat_r; [apply Rabs_pos | assumption]. }
  assert (P3 : Rabs (k * n) <= (2 + / 100) * w).
  { rewrite Rabs_mult. unfold w. replace ((2 + / 100) * (A / N * Rabs n)) with ((2 + / 100) * (A / N) * Rabs n) by ring.
    apply Rmult_le_compat_r; [apply Rabs_pos | assumption]. }
  pose proof (RN_product _ R6) as Q1. set (m := RN (k_low * n)) in *.
  pose proof (RN_sum kl m Fkl (RN_F _)) as Q2. set (c := RN (kl + m)) in *.
  pose proof (two_sum v (- kn) Fv (F_opp _ Fkn)) as T. change (v + - kn) with (v - kn) in T. fold x in T.
  destruct (two_sum_error_le v (- kn) Fv (F_opp _ Fkn)) as [X1 _]. change (v + - kn) with (v - kn) in X1.
  fold x_error in T, X1.
  pose proof (RN_diff x_error c (RN_F _) (RN_F _)) as Q3. change (RN (x_error - c)) with x_low in Q3.
  assert (B1 : Rabs kl <= (2 + / 100) * (u * w)) by (rewrite u_val in *; lra).
  assert (B2 : Rabs (m - k_low * n) <= (16 + 8 / 10) * (u * u * w)) by (rewrite u_val in *; lra).
  pose proof B1 as B1'. apply Rabs_le_inv in B1'. pose proof B2 as B2'. apply Rabs_le_inv in B2'.
  pose proof P2 as P2'. apply Rabs_le_inv in P2'.
  pose proof P3 as P3'. apply Rabs_le_inv in P3'.
  assert (B3 : Rabs (kl + m) <= 19 * (u * w)) by (apply Rabs_le; rewrite u_val in *; lra).
  assert (B4 : Rabs (c - (kl + m)) <= 19 * (u * u * w)) by (rewrite u_val in *; lra).
  pose proof B4 as B4'. apply Rabs_le_inv in B4'. pose proof B3 as B3'. apply Rabs_le_inv in B3'.
  assert (B5 : Rabs (v - kn) <= a + (2 + / 50) * w).
  { replace (v - kn) with (v + - (k * n) + kl) by lra. eapply Rle_trans; [apply Rabs_triang|].
  eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
    rewrite Rabs_Ropp. fold a. rewrite u_val in *. lra. }
  assert (B6 : Rabs x_error <= u * (a + (2 + / 50) * w)) by (rewrite u_val in *; lra).
  pose proof B6 as B6'. apply Rabs_le_inv in B6'.
  assert (B7 : Rabs (x_error - c) <= u * a + 22 * (u * w)) by (apply Rabs_le; rewrite u_val in *; lra).
  assert (B8 : Rabs (x_low - (x_error - c)) <= u * u * a + 22 * (u * u * w)) by (rewrite u_val in *; lra).
  pose proof B8 as B8'. apply Rabs_le_inv in B8'. pose proof B7 as B7'. apply Rabs_le_inv in B7'.
  assert (B9 : Rabs x_low <= (1 + / 1000) * (u * a) + 23 * (u * w)) by (apply Rabs_le; rewrite u_val in *; lra).
  assert (C : Rabs (v - K * n - (x + x_low)) <= 229 * (u * u * w) + u * u * a).
  { apply Rabs_le_inv in P1. rewrite Rmult_minus_distr_r, Rmult_plus_distr_r in P1. apply Rabs_le. split; lra. }
  assert (EV : ERROR = 512 * (u * u)) by (rewrite u_val; unfold ERROR; simpl; lra). rewrite EV in He.
  set (y := Rabs x_low) in *. clearbody y. rewrite u_val in *. lra.
Qed.
End Component.
