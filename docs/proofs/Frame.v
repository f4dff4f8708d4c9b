(* rt-geom, bvh/node.rs: cull coordinates, and the bounds of primitives in them. *)
From Proofs Require Import Rounding Single Norm.
From Flocq Require Import Mult_error.
Open Scope R_scope.

(* The error of a cull coordinate of a point of the unit ball, and of one to which a radius is added. *)
Definition COORDINATE_ERROR := bp (-50).

(* A double times a power of two: exact, or off by half of the least double. *)
Lemma scaled : forall x k, F x -> Rabs (RN (x * bp k) - x * bp k) <= bp (-1075).
Proof.
  intros x k Fx. destruct (Req_dec x 0) as [Z|N].
  - rewrite Z, Rmult_0_l, RN_0, Rminus_0_r, Rabs_R0. apply Rlt_le, bp_pos.
  - destruct (Z_le_gt_dec (-1074 + 53 - mag radix2 x) k) as [L|G].
    + rewrite RN_id by now apply mult_bpow_exact_FLT. replace (x * bp k - x * bp k) with 0 by ring. rewrite Rabs_R0.
      apply Rlt_le, bp_pos.
    + pose proof (error_le_half_ulp radix2 fexp even (x * bp k)) as H.
      change (round radix2 fexp (Znearest even) (x * bp k)) with (RN (x * bp k)) in H.
      assert (U : ulp radix2 fexp (x * bp k) = bp (-1074)).
      { rewrite ulp_neq_0 by (apply Rmult_integral_contrapositive_currified; [assumption | apply Rgt_not_eq, bp_pos]).
        f_equal. unfold cexp, fexp, FLT_exp. rewrite mag_mult_bpow by assumption. lia. }
      rewrite U in H. change (-1074)%Z with (1 + -1075)%Z in H. rewrite bp_add, bp_1 in H. lra.
Qed.
Lemma scaled_up : forall x k, F x -> (0 <= k)%Z -> RN (x * bp k) = x * bp k.
Proof.
  intros x k Fx K. apply RN_id. destruct (FLT_format_generic radix2 (-1074) 53 x Fx) as [f E M L].
  apply generic_format_FLT. exists (Float radix2 (Fnum f) (Fexp f + k)); simpl; [|assumption | lia].
  rewrite E. unfold F2R. simpl. rewrite bp_add. ring.
Qed.

(* ---- A point: halved, the difference of the halves, times the scale 2^k and 2 ---- *)
Definition point p c k := RN (RN (RN (RN (p * bp (-1)) - RN (c * bp (-1))) * bp k) * bp 1).
Theorem point_error : forall p c k, F p -> F c -> (k <= 1021)%Z ->
  Rabs (point p c k - (p - c) * bp k) <= (1 + / 1000) * u * Rabs (point p c k) + bp (-52).
Proof.
  intros p c k Fp Fc K. pose proof (scaled p (-1) Fp) as E1. pose proof (scaled c (-1) Fc) as E2. unfold point.
  set (a := RN (p * bp (-1))) in *. set (b := RN (c * bp (-1))) in *.
  pose proof (RN_diff a b (RN_F _) (RN_F _)) as E3. set (m := RN (a - b)) in *.
  assert (Fm : F m) by apply RN_F. pose proof (scaled m k Fm) as E4. set (n := RN (m * bp k)) in *.
  assert (Fn : F n) by apply RN_F. rewrite (scaled_up n 1 Fn) by lia. rewrite bp_1 in *.
  assert (B1 : bp (-1) = / 2) by (simpl; lra). rewrite B1 in *. pose proof (bp_pos k) as S0. set (s := bp k) in *.
  assert (E5 : Rabs (n - m * s) <= bp (-1075) /\ ((0 <= k)%Z -> n = m * s)).
  { split; [assumption|]. intro Z. unfold n, s. now apply scaled_up. }
  destruct E5 as [E5 E6].
  (* both halves *)
  assert (H3 : Rabs (2 * s * (a - b - (p * / 2 - c * / 2))) <= 4 * (bp (-1075) * s)).
  { rewrite Rabs_mult, (Rabs_pos_eq (2 * s)) by lra.
    assert (Rabs (a - b - (p * / 2 - c * / 2)) <= 2 * bp (-1075)).
    { replace (a - b - (p * / 2 - c * / 2)) with ((a - p * / 2) - (b - c * / 2)) by ring. unfold Rminus at 1.
      eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. lra. }
    apply Rle_trans with (2 * s * (2 * bp (-1075))); [apply Rmult_le_compat_l; lra | lra]. }
  assert (H2 : Rabs (2 * s * (m - (a - b))) <= (1 + / 2000) * u * Rabs (2 * s * m)).
  { rewrite !Rabs_mult, (Rabs_pos_eq 2), (Rabs_pos_eq s) by lra.
    assert (A : Rabs (m - (a - b)) <= (1 + / 2000) * u * Rabs m).
    { assert (Rabs (a - b) <= Rabs m + u * Rabs (a - b)).
      { replace (a - b) with (m + - (m - (a - b))) at 1 by ring. eapply Rle_trans; [apply Rabs_triang|].
        rewrite Rabs_Ropp. lra. }
      rewrite u_val in *. pose proof (Rabs_pos m). lra. }
    apply Rle_trans with (2 * s * ((1 + / 2000) * u * Rabs m)); [apply Rmult_le_compat_l; lra | right; ring]. }
  replace (n * 2 - (p - c) * s) with (2 * (n - m * s) + 2 * s * (m - (a - b)) + 2 * s * (a - b - (p * / 2 - c * / 2)))
    by field.
  eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
  destruct (Z_le_gt_dec 0 k) as [P|P].
  - rewrite (E6 P) in *. replace (m * s - m * s) with 0 by ring. rewrite Rmult_0_r, Rabs_R0.
    replace (m * s * 2) with (2 * s * m) by ring.
    assert (4 * (bp (-1075) * s) <= bp (-52)).
    { unfold s. rewrite <- bp_add. change 4 with (bp 2). rewrite <- bp_add. apply bp_le. lia. }
    pose proof (Rabs_pos (2 * s * m)). pose proof u_pos. nra.
  - assert (S1 : s <= 1) by (unfold s; change 1 with (bp 0); apply bp_le; lia).
    assert (T : 8 * bp (-1075) <= bp (-60)) by (change 8 with (bp 3); rewrite <- bp_add; apply bp_le; lia).
    assert (T2 : 2 * bp (-60) <= bp (-52)) by (rewrite <- bp_1, <- bp_add; apply bp_le; lia).
    pose proof (bp_pos (-1075)) as T0. assert (bp (-1075) * s <= bp (-1075)) by nra.
    assert (A : Rabs (2 * (n - m * s)) <= 2 * bp (-1075)) by (rewrite Rabs_mult, (Rabs_pos_eq 2) by lra; lra).
    assert (B : Rabs (2 * s * m) <= Rabs (n * 2) + 2 * bp (-1075)).
    { replace (2 * s * m) with (n * 2 + - (2 * (n - m * s))) by ring. eapply Rle_trans; [apply Rabs_triang|].
      rewrite Rabs_Ropp. lra. }
    pose proof (Rabs_pos (n * 2)). rewrite u_val in *. lra.
Qed.
Lemma B52 : bp (-52) = 2 * u. Proof. unfold u. change (-52)%Z with (1 + -53)%Z. rewrite bp_add, bp_1. reflexivity. Qed.
Lemma C8 : COORDINATE_ERROR = 8 * u.
Proof. unfold COORDINATE_ERROR, u. change (-50)%Z with (3 + -53)%Z. rewrite bp_add. reflexivity. Qed.
Lemma tiny : bp (-1075) <= / 1000000 * u.
Proof.
  apply Rle_trans with (bp (-20 + -53)); [apply bp_le; lia|]. rewrite bp_add. fold u. pose proof u_pos.
  simpl (bp (-20)). lra.
Qed.
(* in the unit ball *)
Lemma point_unit : forall p c k, F p -> F c -> (k <= 1021)%Z -> Rabs ((p - c) * bp k) <= 1 ->
  Rabs (point p c k - (p - c) * bp k) <= (3 + / 500) * u.
Proof.
  intros p c k Fp Fc K H. pose proof (point_error p c k Fp Fc K) as E. rewrite B52 in E.
  set (x := point p c k) in *. set (X := (p - c) * bp k) in *.
  assert (Rabs x <= Rabs X + Rabs (x - X)) by (replace x with (X + (x - X)) at 1 by ring; apply Rabs_triang).
  rewrite u_val in *. lra.
Qed.

(* ---- Bounds: what is off by less than the error lies between planes that are moved outward by it ---- *)
Lemma planes : forall x X, Rabs (x - X) <= (6 + / 10) * u -> Rabs X <= 1 ->
  down (RN (x - COORDINATE_ERROR)) <= X <= up (RN (x + COORDINATE_ERROR)).
Proof.
  intros x X H B. rewrite C8. apply Rabs_le_inv in H. apply Rabs_le_inv in B. pose proof tiny as T. split.
  - apply Rle_trans with (1 := down_below _). pose proof (RN_err (x - 8 * u)) as E.
    assert (Rabs (x - 8 * u) <= 1 + / 1000) by (apply Rabs_le; rewrite u_val in *; lra). apply Rabs_le_inv in E.
    rewrite u_val in *. lra.
  - apply Rle_trans with (2 := up_above _). pose proof (RN_err (x + 8 * u)) as E.
    assert (Rabs (x + 8 * u) <= 1 + / 1000) by (apply Rabs_le; rewrite u_val in *; lra). apply Rabs_le_inv in E.
    rewrite u_val in *. lra.
Qed.
(* A radius, scaled; a coordinate less or plus it. *)
Definition scaled_length r k := RN (r * bp k).
Lemma ends : forall p c r k, F p -> F c -> F r -> (k <= 1021)%Z -> Rabs ((p - c) * bp k) <= 1 ->
  let X := (p - c) * bp k in let R := r * bp k in let x := point p c k in let y := scaled_length r k in
  (Rabs (X - R) <= 1 -> Rabs (RN (x - y) - (X - R)) <= (4 + / 10) * u) /\
  (Rabs (X + R) <= 1 -> Rabs (RN (x + y) - (X + R)) <= (4 + / 10) * u).
Proof.
  intros p c r k Fp Fc Fr K H X R x y. pose proof (point_unit p c k Fp Fc K H) as E. fold x in E. fold X in E.
  pose proof (scaled r k Fr) as E2. change (RN (r * bp k)) with y in E2. fold R in E2. pose proof tiny as T.
  apply Rabs_le_inv in E. apply Rabs_le_inv in E2. split; intro B; apply Rabs_le_inv in B.
  - pose proof (RN_err (x - y)) as E3. assert (Rabs (x - y) <= 1 + / 1000) by (apply Rabs_le; rewrite u_val in *; lra).
    apply Rabs_le_inv in E3. apply Rabs_le. rewrite u_val in *. lra.
  - pose proof (RN_err (x + y)) as E3. assert (Rabs (x + y) <= 1 + / 1000) by (apply Rabs_le; rewrite u_val in *; lra).
    apply Rabs_le_inv in E3. apply Rabs_le. rewrite u_val in *. lra.
Qed.

(* ---- Balls: the f32 nearest to the center, the radius grown by the distance moved and twice the error ---- *)
Lemma length_low : forall y1 y2 y3 q, Rabs y1 <= bp 1 -> Rabs y2 <= bp 1 -> Rabs y3 <= bp 1 ->
  plain (tdot (X y1 1) (X y2 1) (X y3 1) (X y1 1) (X y2 1) (X y3 1)) q ->
  norm y1 y2 y3 <= (1 + 5 * u) * RN (sqrt q) + bp (-500).
Proof.
  intros y1 y2 y3 q H1 H2 H3 Hq. unfold tdot in Hq. error_of Hq E. rewrite !abs_sq in E.
  pose proof (norm_sq y1 y2 y3) as NN. pose proof (norm_pos y1 y2 y3) as N0. rewrite <- NN in E.
  set (n := norm y1 y2 y3) in *. assert (S0 : 0 <= RN (sqrt q)) by (rewrite <- RN_0; apply RN_le, sqrt_pos).
  pose proof u_pos as U. destruct (Rle_or_lt n (bp (-500))) as [L|L]; [nra|].
  assert (NL : bp (-1000) <= n * n) by (change (-1000)%Z with (-500 + -500)%Z; rewrite <- bp_sq; apply mul2; split;
    try (apply Rlt_le, bp_pos); lra).
  match type of E with _ <= _ + bp ?p => assert (T : bp p <= / 1000 * u * bp (-1000)) end.
  { apply Rle_trans with (bp (-10 + (-53 + -1000))); [apply bp_le; lia|]. rewrite !bp_add. fold u. simpl (bp (-10)).
    pose proof (Rmult_lt_0_compat u (bp (-1000)) U (bp_pos _)). lra. }
  apply Rabs_le_inv in E. assert (Q : (1 - (3 + / 100) * u) * (n * n) <= q) by (rewrite u_val in *; lra).
  assert (q0 : 0 < q) by (pose proof (bp_pos (-1000)); rewrite u_val in *; lra). set (s := sqrt q) in *.
  assert (ss : s * s = q) by (apply sqrt_sqrt; lra). assert (s0 : 0 < s) by (now apply sqrt_lt_R0).
  assert (SL : (1 - (3 + / 10) * u) * n <= s).
  { apply below_root; [lra|]. rewrite ss. rewrite u_val in *. set (nn := n * n) in *.
    replace ((1 - (3 + / 10) * / 9007199254740992) * n * ((1 - (3 + / 10) * / 9007199254740992) * n)) with
      ((1 - (3 + / 10) * / 9007199254740992) * (1 - (3 + / 10) * / 9007199254740992) * nn) by (unfold nn; ring).
    lra. }
  assert (R : Rabs (RN s - s) <= u * Rabs s).
  { apply RN_normal. rewrite Rabs_pos_eq by lra. apply Rle_trans with (bp (-501)); [apply bp_le; lia|].
    change (-500)%Z with (1 + -501)%Z in L. rewrite bp_add, bp_1 in L. pose proof (bp_pos (-501)).
    rewrite u_val in *. lra. }
  rewrite (Rabs_pos_eq s) in R by lra. apply Rabs_le_inv in R. pose proof (bp_pos (-500)). rewrite u_val in *. lra.
Qed.
Section Ball.
(* exact center and radius; center as computed, and its f32 *)
Variables X1 X2 X3 R x1 x2 x3 y q : R.
Hypotheses (H1 : Rabs (x1 - X1) <= (3 + / 500) * u) (H2 : Rabs (x2 - X2) <= (3 + / 500) * u)
  (H3 : Rabs (x3 - X3) <= (3 + / 500) * u) (B1 : Rabs X1 <= 1) (B2 : Rabs X2 <= 1) (B3 : Rabs X3 <= 1)
  (F1 : F x1) (F2 : F x2) (F3 : F x3) (HR : 0 <= R <= 1) (Hy : Rabs (y - R) <= bp (-1075)).
Let y1 := RN (x1 - RNs x1). Let y2 := RN (x2 - RNs x2). Let y3 := RN (x3 - RNs x3).
Hypothesis Hq : plain (tdot (X y1 1) (X y2 1) (X y3 1) (X y1 1) (X y2 1) (X y3 1)) q.
Let moved := RN (sqrt q).
Let radius := up (RN (RN (y + moved) + 2 * COORDINATE_ERROR)).
Lemma part_moved : forall x Z, F x -> Rabs (x - Z) <= (3 + / 500) * u -> Rabs Z <= 1 ->
  Rabs (x - RNs x) <= (1 + 2 * u) * Rabs (RN (x - RNs x)) /\ Rabs (RN (x - RNs x)) <= / 1000000.
Proof.
  clear. intros x Z Fx H B. pose proof (RN_diff x (RNs x) Fx (Fs_F _ (RNs_F x))) as E. pose proof (UNIT_holds x) as E2.
  assert (Rabs x <= 1 + / 1000) by (replace x with ((x - Z) + Z) by ring; eapply Rle_trans; [apply Rabs_triang|];
    rewrite u_val in *; lra).
  assert (T : bp (-150) <= / 1000 * UNIT) by (apply Rle_trans with (bp (-10 + -24)); [apply bp_le; lia|];
    rewrite bp_add;
    fold UNIT; pose proof v_pos; simpl (bp (-10)); lra).
  rewrite Rabs_minus_sym in E2. set (d := x - RNs x) in *.
  assert (Rabs d <= Rabs (RN d) + u * Rabs d) by (replace d with (RN d + - (RN d - d)) at 1 by ring;
    eapply Rle_trans; [apply Rabs_triang|]; rewrite Rabs_Ropp; lra).
  assert (Rabs (RN d) <= Rabs d + u * Rabs d) by (replace (RN d) with (d + (RN d - d)) at 1 by ring;
    eapply Rle_trans; [apply Rabs_triang|]; lra).
  pose proof (Rabs_pos d). rewrite u_val, v_val in *. lra.
Qed.
Lemma ball_contains : R + norm (X1 - RNs x1) (X2 - RNs x2) (X3 - RNs x3) <= radius.
Proof.
  destruct (part_moved x1 X1 F1 H1 B1) as [P1 Q1]. destruct (part_moved x2 X2 F2 H2 B2) as [P2 Q2].
  destruct (part_moved x3 X3 F3 H3 B3) as [P3 Q3]. fold y1 in P1, Q1. fold y2 in P2, Q2. fold y3 in P3, Q3.
  pose proof u_pos as U. assert (b1 : bp 1 = 2) by (simpl; lra).
  assert (L : norm y1 y2 y3 <= (1 + 5 * u) * moved + bp (-500)) by (apply length_low; try (rewrite b1; lra);
    assumption).
  assert (N1 : norm (X1 - RNs x1) (X2 - RNs x2) (X3 - RNs x3) <= (1 + 2 * u) * norm y1 y2 y3 + (53 / 10) * u).
  { eapply Rle_trans; [apply (norm_difference _ _ _ (x1 - RNs x1) (x2 - RNs x2) (x3 - RNs x3))|].
    apply Rplus_le_compat.
    - apply norm_relative; try assumption. lra.
    - replace (X1 - RNs x1 - (x1 - RNs x1)) with (- (x1 - X1)) by ring.
      replace (X2 - RNs x2 - (x2 - RNs x2)) with (- (x2 - X2)) by ring.
      replace (X3 - RNs x3 - (x3 - RNs x3)) with (- (x3 - X3)) by ring. rewrite norm_opp.
      eapply Rle_trans; [apply (norm_equal _ _ _ ((3 + / 500) * u)); try assumption; lra | lra]. }
  assert (N2 : norm y1 y2 y3 <= / 100000).
  { eapply Rle_trans; [apply norm_le_sum|]. lra. }
  assert (M0 : 0 <= moved) by (unfold moved; rewrite <- RN_0; apply RN_le, sqrt_pos).
  unfold radius. apply Rle_trans with (2 := up_above _). rewrite C8. pose proof tiny as T.
  assert (T5 : bp (-500) <= / 1000 * u) by (apply Rle_trans with (bp (-10 + -53)); [apply bp_le; lia|];
    rewrite bp_add; fold u; simpl (bp (-10)); lra).
  apply Rabs_le_inv in Hy. set (n := norm y1 y2 y3) in *.
  (* a moved that is too large only makes the radius larger *)
  set (z := (1 - 6 * u) * n - / 500 * u). assert (ZM : z <= moved).
  { unfold z. assert ((1 - 6 * u) * ((1 + 5 * u) * moved) <= moved).
    { replace ((1 - 6 * u) * ((1 + 5 * u) * moved)) with ((1 - 6 * u) * (1 + 5 * u) * moved) by ring.
      rewrite <- (Rmult_1_l moved) at 2. apply Rmult_le_compat_r; [assumption | rewrite u_val; lra]. }
    assert ((1 - 6 * u) * n <= (1 - 6 * u) * ((1 + 5 * u) * moved + bp (-500))) by (apply Rmult_le_compat_l;
      rewrite ?u_val in *; lra).
    rewrite u_val in *. lra. }
  pose proof (norm_pos y1 y2 y3) as n0. fold n in n0.
  assert (K1 : RN (y + z) <= RN (y + moved)) by (apply RN_le; lra).
  assert (K2 : RN (RN (y + z) + 2 * (8 * u)) <= RN (RN (y + moved) + 2 * (8 * u))) by (apply RN_le; lra).
  apply Rle_trans with (2 := K2). pose proof (RN_err (y + z)) as E1. set (a := RN (y + z)) in *.
  pose proof (RN_err (a + 2 * (8 * u))) as E2.
  assert (A1 : Rabs (y + z) <= 1 + / 1000) by (unfold z; apply Rabs_le; rewrite u_val in *; lra).
  apply Rabs_le_inv in E1. assert (A2 : Rabs (a + 2 * (8 * u)) <= 1 + / 500) by (apply Rabs_le;
    apply Rabs_le_inv in A1 as A1';
    rewrite u_val in *; lra).
  apply Rabs_le_inv in E2. unfold z in *. rewrite u_val in *. lra.
Qed.
End Ball.

(* What lies in the unit ball lies within its bounds: a vertex, the ends of a sphere along an axis,
  a sphere in a ball. *)
Theorem COORDINATE_ERROR_holds :
  (forall p c k, F p -> F c -> (k <= 1021)%Z -> let X := (p - c) * bp k in let x := point p c k in
    Rabs X <= 1 -> down (RN (x - COORDINATE_ERROR)) <= X <= up (RN (x + COORDINATE_ERROR))) /\
  (forall p c r k, F p -> F c -> F r -> (k <= 1021)%Z -> let X := (p - c) * bp k in let R := r * bp k in
    let x := point p c k in let y := scaled_length r k in
    Rabs X <= 1 -> Rabs (X - R) <= 1 -> Rabs (X + R) <= 1 ->
    down (RN (RN (x - y) - COORDINATE_ERROR)) <= X - R /\ X + R <= up (RN (RN (x + y) + COORDINATE_ERROR))) /\
  (forall p1 p2 p3 c1 c2 c3 r k q, F p1 -> F p2 -> F p3 -> F c1 -> F c2 -> F c3 -> F r -> (k <= 1021)%Z ->
    let X1 := (p1 - c1) * bp k in let X2 := (p2 - c2) * bp k in let X3 := (p3 - c3) * bp k in let R := r * bp k in
    let x1 := point p1 c1 k in let x2 := point p2 c2 k in let x3 := point p3 c3 k in
    let y1 := RN (x1 - RNs x1) in let y2 := RN (x2 - RNs x2) in let y3 := RN (x3 - RNs x3) in
    Rabs X1 <= 1 -> Rabs X2 <= 1 -> Rabs X3 <= 1 -> 0 <= R <= 1 ->
    plain (tdot (X y1 1) (X y2 1) (X y3 1) (X y1 1) (X y2 1) (X y3 1)) q ->
    R + norm (X1 - RNs x1) (X2 - RNs x2) (X3 - RNs x3) <=
      up (RN (RN (scaled_length r k + RN (sqrt q)) + 2 * COORDINATE_ERROR))).
Proof.
  split; [|split].
  - intros. apply planes; [|assumption]. pose proof (point_unit p c k H H0 H1 H2) as E. pose proof u_pos.
    eapply Rle_trans; [exact E|]. lra.
  - intros p c r k Fp Fc Fr K X R x y HX HL HH. destruct (ends p c r k Fp Fc Fr K HX) as [E1 E2].
    specialize (E1 HL). specialize (E2 HH). pose proof u_pos. split; apply planes; try assumption;
      (eapply Rle_trans; [eassumption | lra]).
  - intros. unfold x1, x2, x3. apply ball_contains; try assumption; try apply RN_F; try (apply point_unit; assumption).
    now apply scaled.
Qed.
