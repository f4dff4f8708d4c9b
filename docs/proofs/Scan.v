(* rt-geom, enclosing/scan.rs: bounds of blocks, and which blocks are skipped. *)
From Proofs Require Import Rounding Norm Reach Near.
Open Scope R_scope.

(* The errors of a bound where a sphere sticks out, and of a square where none does. *)
Definition REACH_ERROR := 128 * u.
Definition MEASURE_ERROR := 256 * u.
(* What a skipped block is below the limit, relative to limit and way, and how many steps the way has. *)
Definition SKIPPED := 128 * u.
Definition MAX_ROUNDS := 64.

Notation T := (bp (-1000)).
Lemma T_small : bp (-1075) <= / 1000 * T /\ bp (-1060) <= / 1000 * T /\ 0 < T.
Proof.
  assert (A : bp (-10 + -1000) <= / 1000 * T) by (rewrite bp_add; pose proof (bp_pos (-1000)); simpl (bp (-10)); lra).
  repeat split; [| | apply bp_pos]; (apply Rle_trans with (2 := A); apply bp_le; lia).
Qed.
(* The squares of computed offsets. *)
Lemma squares_low : forall d1 d2 d3, Rabs d1 <= bp 1023 -> Rabs d2 <= bp 1023 -> Rabs d3 <= bp 1023 ->
  let n := norm d1 d2 d3 in (1 - (31 / 10) * u) * (n * n) - / 100 * T <= squares d1 d2 d3.
Proof.
  intros d1 d2 d3 B1 B2 B3 n. pose proof (squares_plain d1 d2 d3 1023) as Hs. unfold tdot in Hs. error_of Hs P.
  rewrite !abs_sq in P. pose proof (norm_sq d1 d2 d3) as NN. fold n in NN. rewrite <- NN in P. pose proof (sq_pos n).
  destruct T_small as (_ & T2 & T0). apply Rabs_le_inv in P.
  match type of P with _ <= _ <= _ + bp ?k => assert (T1 : bp k <= bp (-1060)) by (apply bp_le; lia) end.
  rewrite u_val in *. lra.
Qed.

Section Sphere.
(* offsets and radius of a sphere of the block, the radius L of the sphere found so far; the measure, and with marks *)
Variables d1 d2 d3 r L rho most marked : R.
Hypotheses (B1 : Rabs d1 <= bp 1023) (B2 : Rabs d2 <= bp 1023) (B3 : Rabs d3 <= bp 1023) (Fr : F r) (FL : F L)
  (Frho : F rho) (Hr : 0 <= r <= rho) (HL : 0 <= L).
Let n := norm d1 d2 d3.
Let room := RN (L - r).
Let measure := RN (squares d1 d2 d3 - RN (room * Rabs room)).
Hypotheses (Hmark : Rabs (marked - measure) <= 126 * u * Rabs measure + / 100 * T) (Hmost : marked <= most).

Lemma room_le : L - r <= 0 /\ room <= 0 \/ 0 < L - r /\ 0 <= room <= (1 + u) * (L - r).
Proof.
  destruct (Rle_or_lt (L - r) 0) as [Z|Z]; [left | right].
  - split; [assumption|]. unfold room. rewrite <- RN_0. now apply RN_le.
  - split; [assumption|]. pose proof (RN_diff L r FL Fr) as E. fold room in E.
  rewrite (Rabs_pos_eq (L - r)) in E by lra.
    apply Rabs_le_inv in E. split; [|lra]. unfold room. rewrite <- RN_0. apply RN_le. lra.
Qed.
(* the difference of which the measure is the rounding *)
Let y := squares d1 d2 d3 - RN (room * Rabs room).
Lemma y_error : Rabs (measure - y) <= u * Rabs y + / 1000 * T.
Proof. destruct T_small as (T1 & _). eapply Rle_trans; [apply RN_err|]. fold y. lra. Qed.

(* ---- A sphere sticks out ---- *)
Lemma sticks_out : 0 < most -> n + r <= (1 + 69 * u) * (rho + sqrt ((L - rho) * (L - rho) + most + T)).
Proof.
  intro M0. pose proof u_pos as U. destruct T_small as (T1 & T2 & T0). pose proof (norm_pos d1 d2 d3) as N0.
  fold n in N0.
  pose proof (squares_low d1 d2 d3 B1 B2 B3) as SL. cbv zeta in SL. fold n in SL. pose proof y_error as YE.
  assert (Y : y <= (1 + 130 * u) * most + / 10 * T).
  { destruct (Rle_or_lt y 0) as [Z|Z]; [assert (0 <= u * most) by (apply Rmult_le_pos; lra); lra|].
    rewrite (Rabs_pos_eq y) in YE by lra. apply Rabs_le_inv in YE.
    assert (m0 : - T <= measure) by (rewrite u_val in *; lra).
    assert (MA : Rabs measure <= measure + 2 * T) by (unfold Rabs; destruct Rcase_abs; lra). apply Rabs_le_inv in Hmark.
    rewrite u_val in *. lra. }
  assert (NN : n * n <= (1 + 134 * u) * ((L - r) * (L - r) + most + T) /\ (L < r -> n * n <= (1 + 134 * u) * (most
    + T))).
  { pose proof (sq_pos (L - r)) as Q. destruct room_le as [[Z1 Z2]|[Z1 [Z2 Z3]]].
    - assert (R : 0 <= RN (room * room)) by (rewrite <- RN_0; apply RN_le, sq_pos). unfold y in Y.
      rewrite (Rabs_left1 room) in Y by assumption. replace (room * - room) with (- (room * room)) in Y by ring.
      rewrite RN_opp in Y. pose proof (sq_pos n). assert (0 <= u * ((L - r) * (L - r))) by (apply Rmult_le_pos; lra).
      rewrite u_val in *. split; [|intros _]; lra.
    - split; [|lra]. unfold y in Y. rewrite (Rabs_pos_eq room) in Y by assumption.
      pose proof (RN_err (room * room)) as E. rewrite (Rabs_pos_eq (room * room)) in E by apply sq_pos.
      apply Rabs_le_inv in E.
      assert (RR : room * room <= (1 + u) * (L - r) * ((1 + u) * (L - r))) by (apply mul2; split; assumption).
      replace ((1 + u) * (L - r) * ((1 + u) * (L - r))) with ((1 + u) * (1 + u) * ((L - r) * (L - r))) in RR by ring.
      pose proof (sq_pos n). rewrite u_val in *. lra. }
  destruct NN as [NN1 NN2].
  (* the root, which is larger for the larger radius *)
  assert (ROOT : forall z, 0 <= z -> n * n <= (1 + 134 * u) * z -> n <= (1 + 68 * u) * sqrt z).
  { intros z z0 H. apply below_root; [apply Rmult_le_pos; [lra | apply sqrt_pos]|].
    replace ((1 + 68 * u) * sqrt z * ((1 + 68 * u) * sqrt z)) with ((1 + 68 * u) * (1
      + 68 * u) * (sqrt z * sqrt z)) by ring.
    rewrite sqrt_sqrt by assumption. apply Rle_trans with (1 := H).
    apply Rmult_le_compat_r; [assumption | rewrite u_val; lra]. }
  set (c := most + T). assert (c0 : 0 < c) by (unfold c; lra).
  replace ((L - rho) * (L - rho) + most + T) with ((L - rho) * (L - rho) + c) by (unfold c; ring).
  replace ((L - r) * (L - r) + most + T) with ((L - r) * (L - r) + c) in NN1 by (unfold c; ring). fold c in NN2.
  set (S := sqrt ((L - rho) * (L - rho) + c)). pose proof (sq_pos (L - rho)) as Q1. pose proof (sq_pos (L - r)) as Q2.
  assert (SS : S * S = (L - rho) * (L - rho) + c) by (apply sqrt_sqrt; lra). assert (S0 : 0 <= S) by apply sqrt_pos.
  assert (G : r + sqrt ((L - r) * (L - r) + c) <= rho + S \/ L < r).
  { destruct (Rle_or_lt r L) as [Z|Z]; [left | right; assumption].
    set (R := sqrt ((L - r) * (L - r) + c)). assert (RR : R * R = (L - r) * (L - r) + c) by (apply sqrt_sqrt; lra).
    assert (R0 : 0 <= R) by apply sqrt_pos. assert (RL : L - r <= R) by (apply below_root; [assumption | lra]).
    (* R - S <= rho - r: as R + S is at least the sum of L - r and |L - rho| *)
    destruct (Rle_or_lt R (S + (rho - r))) as [W|W]; [lra|]. exfalso.
    assert (SQ : (S + (rho - r)) * (S + (rho - r)) < R * R) by (apply Rmult_le_0_lt_compat; lra).
    assert (SL2 : L - rho <= S) by (apply below_root; [assumption | lra]).
    assert (P : 0 <= (rho - r) * (S - (L - rho))) by (apply Rmult_le_pos; lra).
    replace ((S + (rho - r)) * (S + (rho - r))) with (S * S + 2 * ((rho - r) * (S - (L - rho)))
      + (2 * (rho - r) * (L - rho) +
      (rho - r) * (rho - r))) in SQ by ring.
    replace (2 * (rho - r) * (L - rho) + (rho - r) * (rho - r)) with ((L - r) * (L - r) - (L - rho) * (L - rho)) in SQ
      by ring.
    lra. }
  destruct G as [G|G].
  - pose proof (ROOT ((L - r) * (L - r) + c) ltac:(lra) NN1) as X.
  assert (0 <= u * (rho + S)) by (apply Rmult_le_pos; lra).
    assert (0 <= u * r) by (apply Rmult_le_pos; lra). pose proof (sqrt_pos ((L - r) * (L - r) + c)).
    rewrite u_val in *. lra.
  - pose proof (ROOT c ltac:(lra) (NN2 G)) as X. assert (sqrt c <= S) by (apply sqrt_le_1_alt; lra).
    assert (0 <= u * (rho + S)) by (apply Rmult_le_pos; lra). assert (0 <= u * r) by (apply Rmult_le_pos; lra).
    pose proof (sqrt_pos c). rewrite u_val in *. lra.
Qed.
(* The bound as computed. *)
Let far := RN (L - rho).
Let bound := RN (RN (rho + RN (sqrt (RN (RN (far * far) + most)))) * (1 + REACH_ERROR)).
Lemma bound_out : 0 < most -> (1 + 110 * u) * (rho + sqrt ((L - rho) * (L - rho) + most)) <= bound + 2 * bp (-500).
Proof.
  intro M0. pose proof u_pos as U. destruct T_small as (T1 & T2 & T0). pose proof (RN_diff L rho FL Frho) as E1.
  fold far in E1.
  set (q := (L - rho) * (L - rho)). pose proof (sq_pos (L - rho)) as q0. fold q in q0.
  assert (FF : (1 - 2 * u) * q <= far * far).
  { unfold q. rewrite <- (abs_sq far), <- (abs_sq (L - rho)). rewrite Rabs_minus_sym in E1.
  pose proof (near_le _ _ _ E1) as NL.
    pose proof (Rabs_pos (L - rho)). assert (A : (1 - u) * Rabs (L - rho) <= Rabs far) by lra.
    assert (A0 : 0 <= (1 - u) * Rabs (L - rho)) by (apply Rmult_le_pos; [rewrite u_val; lra | assumption]).
    apply Rle_trans with ((1 - u) * Rabs (L - rho) * ((1 - u) * Rabs (L - rho))); [|apply mul2; split; assumption].
    replace ((1 - u) * Rabs (L - rho) * ((1 - u) * Rabs (L - rho))) with ((1 - u) * (1 - u) * (Rabs (L - rho) * Rabs
      (L - rho)))
      by ring. apply Rmult_le_compat_r; [apply sq_pos | rewrite u_val; lra]. }
  pose proof (RN_err (far * far)) as E2. set (ff := RN (far * far)) in *.
  rewrite (Rabs_pos_eq (far * far)) in E2 by apply sq_pos.
  apply Rabs_le_inv in E2. assert (ff0 : 0 <= ff) by (unfold ff; rewrite <- RN_0; apply RN_le, sq_pos).
  pose proof (RN_err (ff + most)) as E3. set (z := RN (ff + most)) in *. rewrite (Rabs_pos_eq (ff + most)) in E3 by lra.
  apply Rabs_le_inv in E3. assert (z0 : 0 <= z) by (unfold z; rewrite <- RN_0; apply RN_le; lra).
  assert (Z : (1 - 5 * u) * (q + most) <= z + T) by (pose proof (sq_pos far); rewrite u_val in *; lra).
  set (y' := sqrt z). assert (yy : y' * y' = z) by now apply sqrt_sqrt. assert (y0 : 0 <= y') by apply sqrt_pos.
  set (S := sqrt (q + most)). assert (SS : S * S = q + most) by (apply sqrt_sqrt; lra).
  assert (S0 : 0 <= S) by apply sqrt_pos.
  assert (TT : bp (-500) * bp (-500) = T) by (rewrite bp_sq; reflexivity). pose proof (bp_pos (-500)) as P5.
  assert (YS : (1 - 3 * u) * S <= y' + bp (-500)).
  { apply below_root; [lra|]. replace ((1 - 3 * u) * S * ((1 - 3 * u) * S)) with ((1 - 3 * u) * (1 - 3 * u) * (S * S))
    by ring.
    replace ((y' + bp (-500)) * (y' + bp (-500))) with (y' * y' + 2 * (y' * bp (-500)) + bp (-500) * bp (-500)) by ring.
    rewrite yy, TT, SS. assert (0 <= y' * bp (-500)) by (apply Rmult_le_pos; lra). rewrite u_val in *. lra. }
  assert (T5 : bp (-1075) <= / 1000 * bp (-500)) by (apply Rle_trans with (bp (-10 + -500)); [apply bp_le; lia|];
    rewrite bp_add; simpl (bp (-10)); lra).
  pose proof (RN_err y') as E4. set (w := RN y') in *. rewrite (Rabs_pos_eq y') in E4 by assumption.
  apply Rabs_le_inv in E4.
  assert (w0 : 0 <= w) by (unfold w; rewrite <- RN_0; now apply RN_le).
  pose proof (RN_err (rho + w)) as E5. set (x := RN (rho + w)) in *. rewrite (Rabs_pos_eq (rho + w)) in E5 by lra.
  apply Rabs_le_inv in E5. assert (x0 : 0 <= x) by (unfold x; rewrite <- RN_0; apply RN_le; lra).
  pose proof (RN_err (x * (1 + REACH_ERROR))) as E6. change (RN (x * (1 + REACH_ERROR))) with bound in E6.
  unfold REACH_ERROR in E6.
  rewrite (Rabs_pos_eq (x * (1 + 128 * u))) in E6 by (apply Rmult_le_pos; lra). apply Rabs_le_inv in E6.
  fold q. fold S. rewrite u_val in *. lra.
Qed.

(* ---- No sphere sticks out ---- *)
Let inner := RN (sqrt (Rmax (RN (RN (RN (L * L) * (1 + MEASURE_ERROR)) + most)) 0)).
Lemma inside : most <= 0 -> n + r <= inner + 4 * bp (-500).
Proof.
  intro M0. pose proof u_pos as U. destruct T_small as (T1 & T2 & T0). pose proof (norm_pos d1 d2 d3) as N0.
  fold n in N0.
  pose proof (squares_low d1 d2 d3 B1 B2 B3) as SL. cbv zeta in SL. fold n in SL. pose proof y_error as YE.
  pose proof (sq_pos n) as n2. set (a := - most). assert (a0 : 0 <= a) by (unfold a; lra).
  assert (Y : y <= - ((1 - 129 * u) * a) + / 10 * T).
  { apply Rabs_le_inv in Hmark. assert (m1 : measure <= / 10 * T).
    { unfold Rabs in Hmark. destruct Rcase_abs; rewrite u_val in *; lra. }
    destruct (Rle_or_lt measure 0) as [Z|Z].
    - rewrite (Rabs_left1 measure) in Hmark by assumption.
      assert (m2 : measure <= - ((1 - 127 * u) * a) + / 50 * T) by (unfold a; rewrite u_val in *; lra).
      destruct (Rle_or_lt y 0) as [W|W].
      + rewrite (Rabs_left1 y) in YE by assumption. apply Rabs_le_inv in YE. rewrite u_val in *. lra.
      + rewrite (Rabs_pos_eq y) in YE by lra. apply Rabs_le_inv in YE. rewrite u_val in *. lra.
    - rewrite (Rabs_pos_eq measure) in Hmark by lra.
      assert (a1 : a <= / 10 * T) by (unfold a; rewrite u_val in *; lra).
      destruct (Rle_or_lt y 0) as [W|W]; [rewrite u_val in *; lra|]. rewrite (Rabs_pos_eq y) in YE by lra.
      apply Rabs_le_inv in YE. assert (measure <= / 80 * T) by (rewrite u_val in *; lra).
      assert (a <= / 80 * T) by (unfold a; rewrite u_val in *; lra). rewrite u_val in *. lra. }
  pose proof (squares_pos d1 d2 d3) as SP.
  (* p = L - r is not negative, but for underflow *)
  assert (P : exists p, 0 <= p <= L /\ r <= L - p + bp (-500) /\ n * n <= (1
    + (62 / 10) * u) * (p * p) - (1 - 129 * u) * a + / 5 * T
    /\ (1 - 129 * u) * a <= (1 + 4 * u) * (p * p) + / 5 * T).
  { destruct room_le as [[Z1 Z2]|[Z1 [Z2 Z3]]].
    - exists 0. assert (R : - RN (room * room) <= 0) by (assert (0 <= RN (room * room)) by (rewrite <- RN_0;
      apply RN_le,
        sq_pos); lra).
      unfold y in Y. rewrite (Rabs_left1 room) in Y by assumption.
      replace (room * - room) with (- (room * room)) in Y by ring.
      rewrite RN_opp in Y. assert (RT : RN (room * room) <= / 10 * T).
      { assert (0 <= (1 - 129 * u) * a) by (apply Rmult_le_pos; [rewrite u_val; lra | assumption]). lra. }
      pose proof (RN_err (room * room)) as E. rewrite (Rabs_pos_eq (room * room)) in E by apply sq_pos.
      apply Rabs_le_inv in E.
      assert (RB : Rabs room <= / 2 * bp (-500)).
      { apply abs_below; [pose proof (bp_pos (-500)); lra|].
      replace (/ 2 * bp (-500) * (/ 2 * bp (-500))) with (/ 4 * (bp (-500) *
          bp (-500))) by field. rewrite bp_sq. change (-500 + -500)%Z with (-1000)%Z. rewrite u_val in *. lra. }
      pose proof (RN_diff L r FL Fr) as E2. fold room in E2. rewrite Rabs_minus_sym in E2.
      pose proof (near_le _ _ _ E2) as NL.
      pose proof (bp_pos (-500)). assert (LR : Rabs (L - r) <= bp (-500)) by (rewrite u_val in *;
        pose proof (Rabs_pos (L - r)); lra).
      apply Rabs_le_inv in LR. split; [lra|]. split; [lra|].
      assert (0 <= (1 - 129 * u) * a) by (apply Rmult_le_pos; [rewrite u_val; lra | assumption]).
      split; [rewrite u_val in *; lra | rewrite u_val in *; lra].
    - exists (L - r). unfold y in Y. rewrite (Rabs_pos_eq room) in Y by assumption.
      pose proof (RN_err (room * room)) as E. rewrite (Rabs_pos_eq (room * room)) in E by apply sq_pos.
      apply Rabs_le_inv in E.
      assert (RR : room * room <= (1 + u) * (L - r) * ((1 + u) * (L - r))) by (apply mul2; split; assumption).
      replace ((1 + u) * (L - r) * ((1 + u) * (L - r))) with ((1 + u) * (1 + u) * ((L - r) * (L - r))) in RR by ring.
      pose proof (sq_pos (L - r)). pose proof (bp_pos (-500)). split; [lra|]. split; [lra|].
      assert (0 <= (1 - 129 * u) * a) by (apply Rmult_le_pos; [rewrite u_val; lra | assumption]).
      split; rewrite u_val in *; lra. }
  destruct P as (p & [p0 pL] & RP & NP & AP). pose proof (bp_pos (-500)) as P5.
  assert (TT : bp (-500) * bp (-500) = T) by (rewrite bp_sq; reflexivity).
  set (q := (1 + 69 * u) * p). assert (q0 : 0 <= q) by (unfold q; apply Rmult_le_pos; lra).
  assert (NQ : n * n <= q * q - a + T).
  { unfold q. replace ((1 + 69 * u) * p * ((1 + 69 * u) * p)) with ((1 + 69 * u) * (1 + 69 * u) * (p * p)) by ring.
    pose proof (sq_pos p). rewrite u_val in *. lra. }
  set (Q := (1 + 69 * u) * L). assert (qQ : q <= Q) by (unfold q, Q; apply Rmult_le_compat_l; lra).
  assert (Q0 : 0 <= Q) by lra.
  (* n - q <= sqrt (Q^2 - a + T) - Q *)
  set (c := a - T). assert (qc : 0 <= q * q - c) by (unfold c; lra).
  assert (QQ : q * q <= Q * Q) by (apply mul2; split; lra).
  set (S := sqrt (Q * Q - c)). assert (SS : S * S = Q * Q - c) by (apply sqrt_sqrt; lra).
  assert (S0 : 0 <= S) by apply sqrt_pos.
  assert (NS : n + (Q - q) <= S + bp (-500)).
  { destruct (Rle_or_lt c 0) as [C|C].
    - (* a is below T: n is at most q + 2^-500 *)
      assert (n <= q + bp (-500)) by (apply below_root; [lra|];
        replace ((q + bp (-500)) * (q + bp (-500))) with (q * q +
        2 * (q * bp (-500)) + bp (-500) * bp (-500)) by ring; rewrite TT;
          assert (0 <= q * bp (-500)) by (apply Rmult_le_pos; lra);
        unfold c in *; lra).
      assert (Q <= S) by (apply below_root; [assumption | lra]). lra.
    - assert (nq : n <= q) by (apply below_root; [assumption | unfold c in *; lra]).
      assert (n + (Q - q) <= S); [|lra]. apply below_root; [assumption|]. rewrite SS.
      assert ((Q - q) * n <= (Q - q) * q) by (apply Rmult_le_compat_l; lra).
      replace ((n + (Q - q)) * (n + (Q - q))) with (n * n + 2 * ((Q - q) * n) + (Q - q) * (Q - q)) by ring.
      replace (Q * Q - c) with (q * q - c + (2 * ((Q - q) * q) + (Q - q) * (Q - q))) by ring. unfold c in *. lra. }
  assert (GOAL1 : n + r <= S + 69 * u * (q - L) + 2 * bp (-500)).
  { assert (L - p = L - q + 69 * u * p) by (unfold q; ring). assert (Q = L + 69 * u * L) by (unfold Q; ring).
    assert (u * p <= u * q) by (apply Rmult_le_compat_l; [lra|]; unfold q; assert (0 <= u * p) by (apply Rmult_le_pos;
      lra); lra).
    lra. }
  assert (qL : 69 * u * (q - L) <= 69 * u * (69 * (u * L))) by (apply Rmult_le_compat_l; [lra|]; unfold Q in qQ; lra).
  (* as computed *)
  pose proof (RN_err (L * L)) as E1. set (l2 := RN (L * L)) in *. pose proof (sq_pos L) as LL.
  rewrite (Rabs_pos_eq (L * L)) in E1 by assumption. apply Rabs_le_inv in E1.
  assert (l20 : 0 <= l2) by (unfold l2; rewrite <- RN_0; now apply RN_le).
  pose proof (RN_err (l2 * (1 + MEASURE_ERROR))) as E2. set (wide := RN (l2 * (1 + MEASURE_ERROR))) in *.
  unfold MEASURE_ERROR in E2. rewrite (Rabs_pos_eq (l2 * (1 + 256 * u))) in E2 by (apply Rmult_le_pos; lra).
  apply Rabs_le_inv in E2.
  assert (W : (1 + 253 * u) * (L * L) - / 100 * T <= wide) by (rewrite u_val in *; lra).
  assert (AL : a <= (1 + 140 * u) * (L * L) + T).
  { assert (p * p <= L * L) by (apply mul2; split; lra). rewrite u_val in *. lra. }
  pose proof (RN_err (wide + most)) as E3. set (z := RN (wide + most)) in *.
  assert (WM : (1 + 253 * u) * (L * L) - a - / 100 * T <= wide + most) by (unfold a; lra).
  assert (ZL : (1 + 245 * u) * (L * L) - a - / 5 * T <= Rmax z 0).
  { destruct (Rle_or_lt 0 (wide + most)) as [V|V].
    - apply Rle_trans with z; [|apply Rmax_l]. rewrite (Rabs_pos_eq (wide + most)) in E3 by assumption.
      apply Rabs_le_inv in E3.
      assert (X : (1 - u) * ((1 + 253 * u) * (L * L) - a - / 100 * T) <= (1 - u) * (wide
        + most)) by (apply Rmult_le_compat_l;
        [rewrite u_val; lra | assumption]). rewrite u_val in *. lra.
    - apply Rle_trans with 0; [|apply Rmax_r]. assert (0 <= u * (L * L)) by (apply Rmult_le_pos; lra). lra. }
  set (zz := Rmax z 0) in *. assert (zz0 : 0 <= zz) by apply Rmax_r. set (s := sqrt zz).
  assert (ss : s * s = zz) by now apply sqrt_sqrt.
  assert (s0 : 0 <= s) by apply sqrt_pos. pose proof (RN_err s) as E4. change (RN s) with inner in E4.
  rewrite (Rabs_pos_eq s) in E4 by assumption. apply Rabs_le_inv in E4.
  assert (T5 : bp (-1075) <= / 1000 * bp (-500)) by (apply Rle_trans with (bp (-10 + -500)); [apply bp_le; lia|];
    rewrite bp_add; simpl (bp (-10)); lra).
  (* S + 4761 u^2 L <= (1 - u) s + 2^-500 *)
  assert (ulL : 0 <= u * L) by (apply Rmult_le_pos; lra). set (k := 4761 * (u * (u * L))).
  assert (k0 : 0 <= k) by (unfold k; apply Rmult_le_pos; [lra|]; apply Rmult_le_pos; lra).
  assert (kL : k <= / 1000000 * (u * L)) by (unfold k; rewrite <- Rmult_assoc; apply Rmult_le_compat_r;
    [assumption | rewrite u_val; lra]).
  assert (S2L : S <= 2 * L + bp (-500)).
  { apply below_root; [lra|]. rewrite SS. replace ((2 * L + bp (-500)) * (2 * L + bp (-500))) with (4 * (L * L)
    + 4 * (L * bp (-500))
      + bp (-500) * bp (-500)) by ring. rewrite TT. assert (0 <= L * bp (-500)) by (apply Rmult_le_pos; lra).
    unfold c, Q. replace ((1 + 69 * u) * L * ((1 + 69 * u) * L)) with ((1 + 69 * u) * (1 + 69 * u) * (L * L)) by ring.
    rewrite u_val in *. lra. }
  assert (FIN : S + k <= (1 - u) * s + 2 * bp (-500) - / 100 * bp (-500)).
  { assert (SK : (S + k) * (S + k) <= Q * Q - c + / 100000 * (u * (L * L)) + / 1000 * T).
    { replace ((S + k) * (S + k)) with (S * S + 2 * (S * k) + k * k) by ring. rewrite SS.
      assert (A1 : S * k <= (2 * L + bp (-500)) * (/ 1000000 * (u * L))) by (apply mul2; split; assumption).
      assert (A2 : k * k <= / 1000000 * (u * L) * (/ 1000000 * (u * L))) by (apply mul2; split; assumption).
      assert (A3 : u * (L * bp (-500)) <= u * (L * L + T)).
      { apply Rmult_le_compat_l; [lra|]. pose proof (sq_pos (L - bp (-500))) as V.
        replace ((L - bp (-500)) * (L - bp (-500))) with (L * L - 2 * (L * bp (-500))
          + bp (-500) * bp (-500)) in V by ring.
        rewrite TT in V. assert (0 <= L * bp (-500)) by (apply Rmult_le_pos; lra). lra. }
      replace ((2 * L + bp (-500)) * (/ 1000000 * (u * L))) with (/ 500000 * (u * (L * L))
        + / 1000000 * (u * (L * bp (-500)))) in A1
        by field.
      replace (/ 1000000 * (u * L) * (/ 1000000 * (u * L))) with (/ 1000000 * / 1000000 * (u * (u * (L * L)))) in A2
        by ring.
      assert (0 <= u * (L * L)) by (apply Rmult_le_pos; lra).
      assert (u * (u * (L * L)) <= u * (L * L)) by (rewrite <- (Rmult_1_l (u * (L * L))) at 2; apply Rmult_le_compat_r;
        [assumption | rewrite u_val; lra]).
      rewrite u_val in *. lra. }
    apply below_root; [assert (0 <= (1 - u) * s) by (apply Rmult_le_pos; [rewrite u_val; lra | assumption]); lra|].
    apply Rle_trans with (1 := SK).
    replace (((1 - u) * s + 2 * bp (-500) - / 100 * bp (-500)) * ((1 - u) * s + 2 * bp (-500) - / 100 * bp (-500))) with
      ((1 - u) * (1 - u) * (s * s) + 2 * (199 / 100) * (1 - u) * (s * bp (-500))
        + (199 / 100) * (199 / 100) * (bp (-500) * bp (-500)))
      by field.
    rewrite ss, TT. assert (0 <= s * bp (-500)) by (apply Rmult_le_pos; lra).
    assert (0 <= (1 - u) * (s * bp (-500))) by (apply Rmult_le_pos; [rewrite u_val; lra | assumption]).
    assert (Q2 : Q * Q = (1 + 69 * u) * (1 + 69 * u) * (L * L)) by (unfold Q; ring). rewrite Q2. unfold c.
    rewrite u_val in *. lra. }
  unfold k in *. replace (69 * u * (69 * (u * L))) with (4761 * (u * (u * L))) in qL by ring. lra.
Qed.
End Sphere.

(* No sphere of a block reaches farther than its bound, in computed offsets,
  but for 2^-498: where the largest measure is
   positive, and where it is not. *)
Theorem REACH_ERROR_holds : forall d1 d2 d3 r L rho most marked, Rabs d1 <= bp 1023 -> Rabs d2 <= bp 1023 ->
  Rabs d3 <= bp 1023 -> F r -> F L -> F rho -> 0 <= r <= rho -> 0 <= L -> let room := RN (L - r) in
  let measure := RN (squares d1 d2 d3 - RN (room * Rabs room)) in
  Rabs (marked - measure) <= 126 * u * Rabs measure + / 100 * T -> marked <= most -> 0 < most ->
  let far := RN (L - rho) in
  norm d1 d2 d3 + r <= RN (RN (rho + RN (sqrt (RN (RN (far * far) + most)))) * (1 + REACH_ERROR)) + 4 * bp (-500).
Proof.
  intros d1 d2 d3 r L rho most marked B1 B2 B3 Fr FL Frho Hr HL room measure Hmark Hmost M0 far. pose proof u_pos as U.
  pose proof (sticks_out d1 d2 d3 r L rho most marked B1 B2 B3 Fr FL Hr HL Hmark Hmost M0) as S1.
  pose proof (bound_out d1 d2 d3 r L rho most marked FL Frho Hr Hmark M0) as S2. fold far in S2.
  pose proof (bp_pos (-500)) as P5.
  set (q := (L - rho) * (L - rho)) in *. assert (q0 : 0 <= q) by apply sq_pos.
  assert (TT : bp (-500) * bp (-500) = T) by (rewrite bp_sq; reflexivity).
  assert (R : sqrt (q + most + T) <= sqrt (q + most) + bp (-500)).
  { pose proof (sqrt_pos (q + most)) as Z. apply below_root; [lra|]. destruct T_small as (_ & _ & T0).
    rewrite sqrt_sqrt by lra. replace ((sqrt (q + most) + bp (-500)) * (sqrt (q + most) + bp (-500))) with (sqrt (q
      + most) *
      sqrt (q + most) + 2 * (sqrt (q + most) * bp (-500)) + bp (-500) * bp (-500)) by ring.
    rewrite sqrt_sqrt, TT by lra. assert (0 <= sqrt (q + most) * bp (-500)) by (apply Rmult_le_pos; lra). lra. }
  pose proof (sqrt_pos (q + most)). rewrite u_val in *. lra.
Qed.
Theorem MEASURE_ERROR_holds : forall d1 d2 d3 r L most marked, Rabs d1 <= bp 1023 -> Rabs d2 <= bp 1023 ->
  Rabs d3 <= bp 1023 -> F r -> F L -> 0 <= r -> 0 <= L -> let room := RN (L - r) in
  let measure := RN (squares d1 d2 d3 - RN (room * Rabs room)) in
  Rabs (marked - measure) <= 126 * u * Rabs measure + / 100 * T -> marked <= most -> most <= 0 ->
  norm d1 d2 d3 + r <= RN (sqrt (Rmax (RN (RN (RN (L * L) * (1 + MEASURE_ERROR)) + most)) 0)) + 4 * bp (-500).
Proof. intros. apply (inside d1 d2 d3 r L r most marked); try assumption. lra. Qed.

(* ---- The way of the center: a sum of lengths ---- *)
Fixpoint way (len : nat -> R) k := match k with O => 0 | S k => RN (way len k + len k) end.
Fixpoint total (len : nat -> R) k := match k with O => 0 | S k => total len k + len k end.
Section Way.
Variables len tau : nat -> R.
Hypotheses (Flen : forall i, F (len i)) (Hlen : forall i, 0 <= len i) (Htau : forall i,
  tau i <= (1 + 4 * u) * len i + bp (-510)).
Lemma way_F : forall k, F (way len k) /\ 0 <= way len k.
Proof.
  induction k as [|k [IF I0]]; simpl; [split; [apply F_0 | lra]|]. split; [apply RN_F|]. rewrite <- RN_0. apply RN_le.
  pose proof (Hlen k). lra.
Qed.
Lemma way_step : forall k, way len k <= way len (S k) /\ len k <= way len (S k) - way len k + (1
  + / 100) * u * way len (S k).
Proof.
  intro k. destruct (way_F k) as [F0 P0]. pose proof (Hlen k) as L0. pose proof u_pos as U. simpl.
  pose proof (RN_sum (way len k) (len k) F0 (Flen k)) as E. set (w := way len k) in *. set (x := RN (w + len k)) in *.
  split; [rewrite <- (RN_id w F0); apply RN_le; lra|]. rewrite (Rabs_pos_eq (w + len k)) in E by lra.
  apply Rabs_le_inv in E.
  rewrite u_val in *. lra.
Qed.
Lemma way_sum : forall j k, total len (j + k) - total len j <= way len (j + k) - way len j +
  INR k * ((1 + / 100) * u) * way len (j + k) /\ way len j <= way len (j + k).
Proof.
  intros j k. induction k as [|k [IH IM]].
  - rewrite Nat.add_0_r. simpl. split; lra.
  - rewrite Nat.add_succ_r, S_INR. destruct (way_step (j + k)) as [M S]. change (total len (Datatypes.S (j + k))) with
      (total len (j + k) + len (j + k)%nat). set (w := way len (j + k)) in *.
      set (w' := way len (Datatypes.S (j + k))) in *.
    assert (K : INR k * ((1 + / 100) * u) * w <= INR k * ((1 + / 100) * u) * w').
    { apply Rmult_le_compat_l; [|assumption]. apply Rmult_le_pos; [apply pos_INR | pose proof u_pos; lra]. }
    split; lra.
Qed.
Lemma tau_sum : forall j k, total tau (j + k) - total tau j <= (1 + 4 * u) * (total len (j + k) - total len j) +
  INR k * bp (-510).
Proof.
  intros j k. induction k as [|k IH].
  - rewrite Nat.add_0_r. change (INR 0) with 0. lra.
  - rewrite Nat.add_succ_r, S_INR. pose proof (Htau (j + k)%nat).
    change (total tau (Datatypes.S (j + k))) with (total tau (j + k) + tau (j + k)%nat).
    change (total len (Datatypes.S (j + k))) with (total len (j + k) + len (j + k)%nat). lra.
Qed.
Lemma way_enough : forall j k, (j + k <= 64)%nat ->
  total tau (j + k) - total tau j <= way len (j + k) - way len j + 70 * u * way len (j + k) + bp (-500).
Proof.
  intros j k H. destruct (way_sum j k) as [W M]. pose proof (tau_sum j k) as TS. destruct (way_F (j + k)) as [_ W0].
  assert (K : INR k <= 64) by (rewrite INR_IZR_INZ; apply IZR_le; lia). pose proof (pos_INR k) as K0.
  pose proof u_pos as U. set (w := way len (j + k)) in *. assert (uw : 0 <= u * w) by (apply Rmult_le_pos; lra).
  assert (A : INR k * ((1 + / 100) * u) * w <= 64 * ((1 + / 100) * (u * w))).
  { replace (INR k * ((1 + / 100) * u) * w) with (INR k * ((1 + / 100) * (u * w))) by ring.
  apply Rmult_le_compat_r; lra. }
  assert (B : INR k * bp (-510) <= bp (-500)).
  { apply Rle_trans with (64 * bp (-510)); [apply Rmult_le_compat_r; [apply Rlt_le, bp_pos | assumption]|].
    change (-500)%Z with (10 + -510)%Z. rewrite bp_add. pose proof (bp_pos (-510)). simpl (bp 10). lra. }
  destruct (way_F j) as [_ J0]. rewrite u_val in *. lra.
Qed.
End Way.
Theorem MAX_ROUNDS_holds : forall len tau, (forall i, F (len i)) -> (forall i, 0 <= len i) ->
  (forall i, tau i <= (1 + 4 * u) * len i + bp (-510)) -> forall j k, INR (j + k) <= MAX_ROUNDS ->
  total tau (j + k) - total tau j <= way len (j + k) - way len j + 70 * u * way len (j + k) + bp (-500).
Proof.
  intros len tau H1 H2 H3 j k H. apply way_enough; auto. unfold MAX_ROUNDS in H. rewrite INR_IZR_INZ in H.
  apply le_IZR in H. lia.
Qed.

(* A block that is skipped: D is the distance of a sphere from the center at its scan,
  X how far that center was from the
   origin of the offsets, t how far the center has come since. *)
Theorem SKIPPED_holds : forall n r b w0 w1 limit X D t,
  F b -> F w0 -> F w1 -> F limit -> 0 <= w0 <= w1 -> bp (-140) <= limit ->
  0 <= n -> 0 <= r -> n + r <= b + 4 * bp (-500) -> D <= (1 + 3 * u) * n + (1 + / 100) * u * X -> X <= 30 * (limit
    + w1) ->
  t <= w1 - w0 + 70 * u * w1 + bp (-500) ->
  RN (b - w0) <= RN (RN (limit - w1) - RN (SKIPPED * RN (limit + w1))) -> D + r + t <= limit.
Proof.
  intros n r b w0 w1 limit X D t Fb F0 F1 Fl [W0 W1] Hl Hn Hr HB HD HX Ht H. pose proof u_pos as U.
  pose proof (bp_pos (-140)) as L0. pose proof (bp_pos (-500)) as P5. set (s := limit + w1).
  assert (s0 : 0 < s) by (unfold s; lra).
  assert (T5 : bp (-500) <= / 1000 * (u * s)).
  { apply Rle_trans with (bp (-10 + (-53 + -140))); [apply bp_le; lia|]. rewrite !bp_add. fold u.
    assert (u * bp (-140) <= u * s) by (apply Rmult_le_compat_l; unfold s; lra).
    assert (bp (-10) <= / 1000) by (simpl; lra).
    pose proof (bp_pos (-10)). apply Rmult_le_compat; try lra. apply Rmult_le_pos; lra. }
  assert (T7 : bp (-1075) <= bp (-500)) by (apply bp_le; lia).
  assert (us : 0 < u * s) by now apply Rmult_lt_0_compat.
  pose proof (RN_diff limit w1 Fl F1) as E1. set (x := RN (limit - w1)) in *.
  assert (A1 : Rabs (limit - w1) <= s) by (unfold s; apply Rabs_le; lra).
  assert (A1' : u * Rabs (limit - w1) <= u * s) by (apply Rmult_le_compat_l; lra).
  pose proof (RN_sum limit w1 Fl F1) as E2. set (y := RN (limit + w1)) in *. fold s in E2.
  rewrite (Rabs_pos_eq s) in E2 by lra.
  apply Rabs_le_inv in E2. pose proof (RN_err (SKIPPED * y)) as E3. set (z := RN (SKIPPED * y)) in *.
  unfold SKIPPED in E3.
  assert (y0 : 0 <= y) by (rewrite u_val in *; lra).
  rewrite (Rabs_pos_eq (128 * u * y)) in E3 by (apply Rmult_le_pos; lra).
  assert (uy : (1 - u) * (u * s) <= u * y <= (1 + u) * (u * s)).
  { replace ((1 - u) * (u * s)) with (u * ((1 - u) * s)) by ring.
  replace ((1 + u) * (u * s)) with (u * ((1 + u) * s)) by ring.
    split; apply Rmult_le_compat_l; lra. }
  apply Rabs_le_inv in E3. assert (Z : (128 - / 50) * (u * s) <= z <= 129 * (u * s)) by (rewrite u_val in *; lra).
  pose proof (RN_diff x z (RN_F _) (RN_F _)) as E4. set (S := RN (x - z)) in *. apply Rabs_le_inv in E1.
  assert (A2 : Rabs (x - z) <= (1 + / 1000) * s).
  { apply Rabs_le. apply Rabs_le_inv in A1. rewrite u_val in *. lra. }
  assert (A2' : u * Rabs (x - z) <= (1 + / 1000) * (u * s)) by (replace ((1 + / 1000) * (u * s)) with (u * ((1
    + / 1000) * s))
    by ring; apply Rmult_le_compat_l; lra).
  apply Rabs_le_inv in E4. assert (SU : S <= limit - w1 - (125 + / 2) * (u * s)) by lra.
  assert (SA : Rabs S <= (1 + / 500) * s) by (apply Rabs_le; apply Rabs_le_inv in A2; rewrite u_val in *; lra).
  (* b - w0 before it was rounded *)
  pose proof (RN_diff b w0 Fb F0) as E5. set (d := RN (b - w0)) in *.
  assert (BD : b - w0 <= S + (1 + / 100) * (u * s)).
  { destruct (Rle_or_lt (b - w0) 0) as [N|N].
    - rewrite (Rabs_left1 (b - w0)) in E5 by assumption. apply Rabs_le_inv in E5. apply Rabs_le_inv in SA.
      (* d <= S, and b - w0 is below d by a share of itself *)
      destruct (Rle_or_lt S 0) as [SN|SN]; [|lra].
      assert (b - w0 <= (1 - 2 * u) * d \/ b - w0 <= S) by (left; rewrite u_val in *; lra).
      assert (d <= 0) by lra. rewrite u_val in *. lra.
    - rewrite (Rabs_pos_eq (b - w0)) in E5 by lra. apply Rabs_le_inv in E5. apply Rabs_le_inv in SA.
    rewrite u_val in *. lra. }
  assert (bs : b <= 2 * s) by (apply Rabs_le_inv in SA; unfold s in *; rewrite u_val in *; lra).
  assert (un : u * n <= u * (limit + w0 + / 1000 * s)).
  { apply Rmult_le_compat_l; [lra|]. rewrite u_val in *. unfold s in *. lra. }
  assert (uX : u * X <= 30 * (u * s)) by (replace (30 * (u * s)) with (u * (30 * s)) by ring; apply Rmult_le_compat_l;
    unfold s in *; lra).
  assert (uw : u * w1 <= u * s) by (apply Rmult_le_compat_l; unfold s; lra).
  assert (uw0 : u * (limit + w0 + / 1000 * s) <= (1 + / 1000) * (u * s)) by (replace ((1 + / 1000) * (u * s)) with (u *
    ((1 + / 1000) * s)) by ring; apply Rmult_le_compat_l; unfold s in *; lra).
  lra.
Qed.
