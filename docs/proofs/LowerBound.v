(* rt-geom, enclosing/certify.rs, `lower_bound`: no sphere that encloses the support is smaller. *)
From Proofs Require Import Rounding ErrorFree Norm Spacing Reach Step.
From Coq Require Import List.
Open Scope R_scope.

(* Any positive number gives a true bound. *)
Definition BALANCE := bp (-26).
(* The error of the mean, relative to it. *)
Definition MEAN_ERROR := 16 * u.
(* The slack, for the roundings of the bound itself. *)
Definition BOUND_ERROR := 16 * u.

(* ---- Spheres, exactly ---- *)
Record sphere := { s1 : R; s2 : R; s3 : R; radius : R }.
Definition reach_of x1 x2 x3 s := norm (x1 - s1 s) (x2 - s2 s) (x3 - s3 s) + radius s.
Definition encloses x1 x2 x3 m l := forall s, In s l -> reach_of x1 x2 x3 s <= m.
Lemma norm_between : forall s a1 a2 a3 b1 b2 b3, let y a b := (1 - s) * a + s * b in
  norm (y a1 b1) (y a2 b2) (y a3 b3) * norm (y a1 b1) (y a2 b2) (y a3 b3) =
  (1 - s) * (norm a1 a2 a3 * norm a1 a2 a3) + s * (norm b1 b2 b3 * norm b1 b2 b3) -
    s * (1 - s) * (norm (b1 - a1) (b2 - a2) (b3 - a3) * norm (b1 - a1) (b2 - a2) (b3 - a3)).
Proof. intros. unfold y. rewrite !norm_sq. ring. Qed.

Section Minimal.
(* the smallest sphere that encloses some, around z with the radius m; another that does, around x with the radius M
   *)
Variables (l : list sphere) (z1 z2 z3 m x1 x2 x3 M : R).
Hypotheses (Hr : forall s, In s l -> 0 <= radius s) (Hz : encloses z1 z2 z3 m l) (Hx : encloses x1 x2 x3 M l)
  (Hm : forall y1 y2 y3 n, encloses y1 y2 y3 n l -> m <= n).
Let d := norm (x1 - z1) (x2 - z2) (x3 - z3).
Lemma some : exists s, In s l.
Proof.
  destruct l as [|s t]; [|exists s; now left]. exfalso. assert (m <= m - 1); [|lra]. apply (Hm 0 0 0).
  intros s H. destruct H.
Qed.
Lemma m_pos : 0 <= m /\ m <= M.
Proof.
  destruct some as [s I]. split; [|now apply (Hm x1 x2 x3)]. specialize (Hz s I). specialize (Hr s I). unfold
    reach_of in Hz.
  pose proof (norm_pos (z1 - s1 s) (z2 - s2 s) (z3 - s3 s)). lra.
Qed.
(* How far the centers are from each other. *)
Theorem centers : d * d <= M * M - m * m.
Proof.
  destruct m_pos as [m0 mM]. apply Rnot_lt_le. intro C. set (k := M * M - m * m) in *.
  assert (k0 : 0 <= k) by (unfold k; pose proof (mul2 m m M M ltac:(lra) ltac:(lra)); lra).
  assert (d0 : 0 <= d) by apply norm_pos. destruct m0 as [m0|m0].
  - (* a center between the two has all nearer by as much *)
    set (dd := d * d) in *. assert (dd0 : 0 < dd) by lra. set (s := (dd - k) / (2 * dd)).
    assert (sd : s * dd = (dd - k) / 2) by (unfold s; field; lra).
    assert (s0 : 0 < s) by (unfold s; apply Rmult_lt_0_compat; [lra | apply Rinv_0_lt_compat; lra]).
    assert (s1' : s <= 1) by (apply Rmult_le_reg_r with dd; lra).
    set (less := s * ((dd - k) / 2)). assert (l0 : 0 < less) by (apply Rmult_lt_0_compat; lra).
    assert (LE : s * ((1 - s) * dd - k) = less) by (unfold less; rewrite <- sd; replace ((1 - s) * dd - k) with (dd
      - s * dd -
      k) by ring; rewrite sd; field).
    set (q := less / (2 * m)). assert (q0 : 0 < q) by (apply Rmult_lt_0_compat; [assumption | apply
      Rinv_0_lt_compat; lra]).
    assert (qm : 2 * (q * m) = less) by (unfold q; field; lra).
    assert (E : encloses ((1 - s) * z1 + s * x1) ((1 - s) * z2 + s * x2) ((1 - s) * z3 + s * x3) (m - q) l).
    { intros p I. pose proof (Hr p I) as r0. pose proof (Hz p I) as A. pose proof (Hx p I) as B. unfold reach_of in *.
      set (r := radius p) in *. set (c1 := s1 p) in *. set (c2 := s2 p) in *. set (c3 := s3 p) in *.
      pose proof (norm_between s (z1 - c1) (z2 - c2) (z3 - c3) (x1 - c1) (x2 - c2) (x3 - c3)) as N. cbv zeta in N.
      replace (x1 - c1 - (z1 - c1)) with (x1 - z1) in N by ring. replace (x2 - c2 - (z2 - c2)) with (x2 - z2) in N
        by ring.
      replace (x3 - c3 - (z3 - c3)) with (x3 - z3) in N by ring. fold d in N. fold dd in N.
      replace ((1 - s) * z1 + s * x1 - c1) with ((1 - s) * (z1 - c1) + s * (x1 - c1)) by ring.
      replace ((1 - s) * z2 + s * x2 - c2) with ((1 - s) * (z2 - c2) + s * (x2 - c2)) by ring.
      replace ((1 - s) * z3 + s * x3 - c3) with ((1 - s) * (z3 - c3) + s * (x3 - c3)) by ring.
      set (n := norm ((1 - s) * (z1 - c1) + s * (x1 - c1)) ((1 - s) * (z2 - c2) + s * (x2 - c2)) ((1 - s) * (z3 -
        c3) + s *
        (x3 - c3))) in *.
      set (a := norm (z1 - c1) (z2 - c2) (z3 - c3)) in *. set (b := norm (x1 - c1) (x2 - c2) (x3 - c3)) in *.
      assert (a0 : 0 <= a) by apply norm_pos. assert (b0 : 0 <= b) by apply norm_pos. assert (n0 : 0 <= n) by apply
        norm_pos.
      set (v := m - r) in *. assert (AA : a * a <= v * v) by (apply mul2; unfold v; lra).
      assert (BB : b * b <= (M - r) * (M - r)) by (apply mul2; lra).
      assert (KK : (M - r) * (M - r) - v * v <= k).
      { unfold v, k. replace ((M - r) * (M - r) - (m - r) * (m - r)) with (M * M - m * m - 2 * ((M - m) * r)) by ring.
        assert (0 <= (M - m) * r) by (apply Rmult_le_pos; lra). lra. }
      assert (NN : n * n <= v * v - less).
      { rewrite N, <- LE. assert ((1 - s) * (a * a) <= (1 - s) * (v * v)) by (apply Rmult_le_compat_l; lra).
        assert (s * (b * b) <= s * (v * v + k)) by (apply Rmult_le_compat_l; lra).
        replace (s * ((1 - s) * dd - k)) with (s * (1 - s) * dd - s * k) by ring. lra. }
      assert (v0 : 0 <= v) by (unfold v; lra). assert (vm : q * v <= q * m) by (apply Rmult_le_compat_l; unfold v;
        lra).
      assert (P : n <= v - q).
      { assert (vq : q <= v).
        { apply Rnot_lt_le. intro Q. assert (v * v <= q * v) by (apply Rmult_le_compat_r; lra). pose proof (sq_pos
          n). lra. }
        apply below_root; [lra|]. replace ((v - q) * (v - q)) with (v * v - 2 * (q * v) + q * q) by ring.
        pose proof (sq_pos q). lra. }
      unfold v in P. lra. }
    pose proof (Hm _ _ _ _ E). lra.
  - (* a single point *)
    destruct some as [p I]. pose proof (Hr p I) as r0. pose proof (Hz p I) as A. pose proof (Hx p I) as B.
    unfold reach_of in *. pose proof (norm_triangle (x1 - s1 p) (x2 - s2 p) (x3 - s3 p) (- (z1 - s1 p)) (- (z2 - s2
      p))
      (- (z3 - s3 p))) as T. rewrite norm_opp in T. replace (x1 - s1 p + - (z1 - s1 p)) with (x1 - z1) in T by ring.
    replace (x2 - s2 p + - (z2 - s2 p)) with (x2 - z2) in T by ring. replace (x3 - s3 p + - (z3 - s3 p)) with (x3 -
      z3) in T by
      ring. fold d in T. pose proof (norm_pos (x1 - s1 p) (x2 - s2 p) (x3 - s3 p)).
    pose proof (norm_pos (z1 - s1 p) (z2 - s2 p) (z3 - s3 p)). assert (d <= M) by lra.
    pose proof (mul2 d d M M ltac:(lra) ltac:(lra)). unfold k in C. rewrite <- m0 in C. lra.
Qed.

(* Four of the spheres (some may be the same) with shares: their mean reach from x, and the mean of the directions. *)
Variables p q r t : sphere.
Hypotheses (Ip : In p l) (Iq : In q l) (Ir : In r l) (It : In t l).
Variables wp wq wr wt : R.
Hypotheses (Wp : 0 <= wp) (Wq : 0 <= wq) (Wr : 0 <= wr) (Wt : 0 <= wt) (Sum : wp + wq + wr + wt = 1).
Let away s := norm (x1 - s1 s) (x2 - s2 s) (x3 - s3 s).
Hypotheses (Ap : 0 < away p) (Aq : 0 < away q) (Ar : 0 < away r) (At : 0 < away t).
Let mean := wp * reach_of x1 x2 x3 p + wq * reach_of x1 x2 x3 q + wr * reach_of x1 x2 x3 r + wt * reach_of x1 x2 x3 t.
Let g1 := wp * ((x1 - s1 p) / away p) + wq * ((x1 - s1 q) / away q) + wr * ((x1 - s1 r) / away r) + wt * ((x1 - s1
  t) / away
  t).
Let g2 := wp * ((x2 - s2 p) / away p) + wq * ((x2 - s2 q) / away q) + wr * ((x2 - s2 r) / away r) + wt * ((x2 - s2
  t) / away
  t).
Let g3 := wp * ((x3 - s3 p) / away p) + wq * ((x3 - s3 q) / away q) + wr * ((x3 - s3 r) / away r) + wt * ((x3 - s3
  t) / away
  t).
Lemma below_mean : mean - norm g1 g2 g3 * d <= m.
Proof.
  assert (One : forall s, In s l -> 0 < away s -> reach_of x1 x2 x3 s + ((x1 - s1 s) / away s * (z1 - x1) + (x2 -
    s2 s) / away s
    * (z2 - x2) + (x3 - s3 s) / away s * (z3 - x3)) <= m).
  { intros s I A. pose proof (Hz s I) as Z. unfold reach_of in *. fold (away s).
    pose proof (bend (x1 - s1 s) (x2 - s2 s) (x3 - s3 s) (z1 - x1) (z2 - x2) (z3 - x3)) as B. cbv zeta in B.
    fold (away s) in B. specialize (B A). replace (x1 - s1 s + (z1 - x1)) with (z1 - s1 s) in B by ring.
    replace (x2 - s2 s + (z2 - x2)) with (z2 - s2 s) in B by ring. replace (x3 - s3 s + (z3 - x3)) with (z3 - s3 s)
      in B by ring.
    replace ((x1 - s1 s) / away s * (z1 - x1) + (x2 - s2 s) / away s * (z2 - x2) + (x3 - s3 s) / away s * (z3 -
      x3)) with
      (((x1 - s1 s) * (z1 - x1) + (x2 - s2 s) * (z2 - x2) + (x3 - s3 s) * (z3 - x3)) / away s) by (field; lra). lra. }
  pose proof (One p Ip Ap) as P. pose proof (One q Iq Aq) as Q. pose proof (One r Ir Ar) as R'. pose proof (One t
    It At) as T.
  assert (D : - (norm g1 g2 g3 * d) <= g1 * (z1 - x1) + g2 * (z2 - x2) + g3 * (z3 - x3)).
  { pose proof (dot_le g1 g2 g3 (z1 - x1) (z2 - x2) (z3 - x3)) as H. replace (norm (z1 - x1) (z2 - x2) (z3 - x3))
    with d in H by
      (unfold d; rewrite <- norm_opp; f_equal; ring). apply Rabs_le_inv in H. lra. }
  pose proof (Rmult_le_compat_l _ _ _ Wp P) as P'. pose proof (Rmult_le_compat_l _ _ _ Wq Q) as Q'.
  pose proof (Rmult_le_compat_l _ _ _ Wr R') as R''. pose proof (Rmult_le_compat_l _ _ _ Wt T) as T'.
  assert (SM : wp * m + wq * m + wr * m + wt * m = m) by (replace (wp * m + wq * m + wr * m + wt * m) with ((wp +
    wq + wr + wt)
    * m) by ring; rewrite Sum; ring).
  assert (E : mean + (g1 * (z1 - x1) + g2 * (z2 - x2) + g3 * (z3 - x3)) <= m); [|lra].
  rewrite <- SM at 1. unfold mean, g1, g2, g3. lra.
Qed.
(* The bound, of any pull that is not less than that of the mean direction. *)
Theorem bound_holds : forall pull b, norm g1 g2 g3 <= pull -> 0 < b ->
  mean - pull * ((M - mean + 2 * M * pull) / (2 * b) + M * b) <= m.
Proof.
  intros pull b HP B0. pose proof below_mean as BM. pose proof centers as C. destruct m_pos as [m0 mM].
  assert (d0 : 0 <= d) by apply norm_pos. pose proof (norm_pos g1 g2 g3) as G0.
  assert (dM : d <= M) by (apply below_root; [lra|]; pose proof (sq_pos m); lra).
  set (gap := M - mean + 2 * M * pull).
  assert (GP : M - m <= gap).
  { assert (norm g1 g2 g3 * d <= pull * M) by (apply mul2; split; lra). assert (0 <= pull * M) by (apply
    Rmult_le_pos; lra).
    unfold gap. lra. }
  assert (far0 : 0 <= gap / (2 * b) + M * b).
  { apply Rplus_le_le_0_compat; [|apply Rmult_le_pos; lra]. apply Rmult_le_pos; [lra | apply Rlt_le,
    Rinv_0_lt_compat; lra]. }
  assert (DF : d <= gap / (2 * b) + M * b).
  { apply below_root; [assumption|]. set (h := gap / (2 * b)). assert (hb : 2 * (h * b) = gap) by (unfold h; field;
    lra).
    assert (d * d <= 2 * M * gap).
    { apply Rle_trans with (1 := C). replace (M * M - m * m) with ((M - m) * (M + m)) by ring.
      rewrite (Rmult_comm (2 * M)). apply mul2; split; lra. }
    replace ((h + M * b) * (h + M * b)) with ((h - M * b) * (h - M * b) + 2 * M * (2 * (h * b))) by ring. rewrite hb.
    pose proof (sq_pos (h - M * b)). lra. }
  assert (norm g1 g2 g3 * d <= pull * (gap / (2 * b) + M * b)) by (apply mul2; split; lra). lra.
Qed.
End Minimal.

(* ---- As computed ---- *)
Section Rounded.
(* The largest reach, the first one, the mean reach less the first, the pull, the error of reaches: all computed.
  The mean
   reach, the length of the mean direction and the radius m of the smallest sphere exactly. *)
Variables M base mean pull err mu g m : R.
Hypotheses (FM : F M) (Fbase : F base) (Fmean : F mean) (Fpull : F pull) (Ferr : F err).
Hypotheses (M0 : bp (-200) <= M) (Hm : bp (-300) <= m <= M) (Hb : 0 <= base) (Hmu : mu <= M)
  (Herr : 0 <= err <= 1030 * (u * (u * M)))
  (Hmean : Rabs (mu - (base + mean)) <= err + 11 * (u * Rabs mean) + 22 * (u * (M - mu)))
  (Hg : 0 <= g <= (1 + / 1000) * pull) (Hsmall : pull <= / 1048576 -> g <= pull - u * / 2) (Hpull : 0 < pull).
(* `below_mean` with `centers`, and `bound_holds` *)
Hypotheses (H1 : mu - g * M <= m)
  (H2 : forall p, g <= p -> mu - p * ((M - mu + 2 * M * p) / (2 * BALANCE) + M * BALANCE) <= m).
Let doubt := RN (MEAN_ERROR * Rabs mean).
Let gap := RN (RN (RN (M - base) - mean) + RN (RN (2 * M * pull) + doubt)).
Let far := RN (RN (gap * (/ 2 / BALANCE)) + RN (M * BALANCE)).
Let slack := RN (RN (err + RN (pull * far)) + doubt).
Let taken := RN (slack * (1 + BOUND_ERROR)).
Let below := RN (mean - taken).
Let sum := RN (base + below).
Let bound := RN (sum - (if Rlt_dec (fast_two_sum_error base below) 0 then RN (sum * SPACING) else 0)).

Let X := M - mu.
Let a := Rabs mean.
Let t := bp (-1075).
Lemma t_small : 0 < t /\ t <= / 1000000 * (u * (u * M)).
Proof.
  split; [apply bp_pos|]. apply Rle_trans with (bp (-20 + (-53 + (-53 + -200)))); [apply bp_le; lia|]. rewrite
    !bp_add. fold u.
  pose proof u_pos. pose proof (bp_pos (-200)). assert (u * (u * bp (-200)) <= u * (u * M)) by (apply
    Rmult_le_compat_l; [lra|];
    apply Rmult_le_compat_l; lra). assert (bp (-20) <= / 1000000) by (simpl; lra). pose proof (bp_pos (-20)).
  apply Rmult_le_compat; try lra. apply Rmult_le_pos; [lra | apply Rmult_le_pos; lra].
Qed.
Lemma signs : 0 < M /\ 0 <= X /\ 0 <= a /\ 0 < pull /\ BALANCE = / 67108864 /\ / 2 / BALANCE = 33554432.
Proof.
  pose proof u_pos. pose proof (bp_pos (-200)). assert (B : BALANCE = / 67108864) by (unfold BALANCE; simpl; lra).
  repeat split; try lra; try (unfold X; lra); [apply Rabs_pos | rewrite B; lra].
Qed.
Lemma doubt_near : (16 - / 1000) * (u * a) - t <= doubt <= (16 + / 1000) * (u * a) + t.
Proof.
  destruct signs as (_ & _ & A0 & _). pose proof (RN_err (MEAN_ERROR * Rabs mean)) as E. fold doubt a t in E.
    unfold MEAN_ERROR in E.
  rewrite (Rabs_pos_eq (16 * u * a)) in E by (pose proof u_pos; apply Rmult_le_pos; lra). apply Rabs_le_inv in E.
  rewrite u_val in *. lra.
Qed.
Let pM := pull * M. Let pX := pull * X. Let pe := pull * err. Let pa := pull * a. Let ppM := pull * (pull * M). Let
  pt := pull * t.
Lemma gap_low : (1 - 30 * u) * X + (2 - 20 * u) * pM - (101 / 100) * err + / 2 * (u * a) - 5 * t <= gap /\ Rabs gap
  <= 2 * X + 3 *
  pM + 2 * err + 40 * (u * a) + 7 * t.
Proof.
  destruct signs as (MP & X0 & A0 & P0 & _). pose proof u_pos as U. destruct t_small as [T0 T1]. pose proof
    doubt_near as D.
  assert (pM0 : 0 <= pM) by (apply Rmult_le_pos; lra).
  set (e0 := mu - (base + mean)) in *. change (M - mu) with X in Hmean. fold a in Hmean.
  assert (K : M - base - mean = X + e0) by (unfold X, e0; ring).
  pose proof (RN_diff M base FM Fbase) as E1. set (j := RN (M - base)) in *.
  pose proof (RN_diff j mean (RN_F _) Fmean) as E2. set (k := RN (j - mean)) in *.
  assert (W2 : 2 * M * pull = 2 * pM) by (unfold pM; ring).
  pose proof (RN_err (2 * M * pull)) as E3. set (w := RN (2 * M * pull)) in *. rewrite W2 in E3.
  rewrite (Rabs_pos_eq (2 * pM)) in E3 by lra. fold t in E3.
  assert (A1 : Rabs (M - base) <= X + Rabs e0 + a).
  { replace (M - base) with (X + e0 + mean) by (rewrite <- K; ring). eapply Rle_trans; [apply Rabs_triang|].
    eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|]. rewrite (Rabs_pos_eq X) by assumption. unfold a. lra. }
  assert (A2 : Rabs (j - mean - (X + e0)) <= u * (X + Rabs e0 + a)).
  { replace (j - mean - (X + e0)) with (j - (M - base)) by (rewrite <- K; ring). eapply Rle_trans; [exact E1|].
    apply Rmult_le_compat_l; lra. }
  assert (A3 : Rabs (j - mean) <= X + Rabs e0 + u * (X + Rabs e0 + a)).
  { apply (near_le (j - mean) (X + e0)) in A2. assert (Rabs (X + e0) <= X + Rabs e0) by (eapply Rle_trans; [apply
    Rabs_triang|];
      rewrite (Rabs_pos_eq X) by assumption; lra). lra. }
  assert (A4 : Rabs (k - (X + e0)) <= u * ((2 + / 1000) * X + (2 + / 1000) * Rabs e0 + 2 * a)).
  { replace (k - (X + e0)) with ((k - (j - mean)) + (j - mean - (X + e0))) by ring. eapply Rle_trans; [apply
    Rabs_triang|].
    assert (u * Rabs (j - mean) <= u * (X + Rabs e0 + u * (X + Rabs e0 + a))) by (apply Rmult_le_compat_l; lra).
    pose proof (Rabs_pos e0). clear - H E2 A2 X0 A0 H0. rewrite u_val in *. lra. }
  pose proof (RN_err (w + doubt)) as E4. fold t in E4. set (y := RN (w + doubt)) in *.
  pose proof (RN_err (k + y)) as E5. change (RN (k + y)) with gap in E5. fold t in E5.
  pose proof (Rabs_pos e0) as e00. apply Rabs_le_inv in E3.
  assert (W : 0 <= w + doubt <= (2 + / 1000) * pM + (161 / 10) * (u * a) + 3 * t).
  { split.
    - assert (0 <= w) by (unfold w; rewrite <- RN_0; apply RN_le; rewrite W2; lra). assert (0 <= doubt) by (unfold
      doubt; rewrite <- RN_0;
        apply RN_le; unfold MEAN_ERROR; apply Rmult_le_pos; [lra | apply Rabs_pos]). lra.
    - clear - E3 D pM0 A0 T0 U. rewrite u_val in *. lra. }
  rewrite (Rabs_pos_eq (w + doubt)) in E4 by lra. apply Rabs_le_inv in E4.
  assert (KB : Rabs (k + y) <= (3 / 2) * X + (5 / 2) * pM + (3 / 2) * err + 39 * (u * a) + 5 * t).
  { eapply Rle_trans; [apply Rabs_triang|]. apply (near_le k (X + e0)) in A4.
    assert (Rabs (X + e0) <= X + Rabs e0) by (eapply Rle_trans; [apply Rabs_triang|]; rewrite (Rabs_pos_eq X) by
      assumption;
      lra). assert (Rabs y <= (1 + / 100) * (w + doubt) + t) by (apply Rabs_le; clear - E4 W T0; rewrite u_val in
        *; lra).
    clear - A4 H H0 W Hmean X0 pM0 A0 T0 Herr U. rewrite u_val in *. lra. }
  apply Rabs_le_inv in A4. assert (Q : u * Rabs (k + y) <= u * ((3 / 2) * X + (5 / 2) * pM + (3 / 2) * err + 39 *
    (u * a) + 5 *
    t)) by (apply Rmult_le_compat_l; lra). apply Rabs_le_inv in Hmean as HM2. split.
  - apply Rabs_le_inv in E5. clear - E5 Q A4 HM2 Hmean E4 W E3 D X0 pM0 A0 T0 Herr U e00. rewrite u_val in *. lra.
  - pose proof (near_le gap (k + y) _ E5) as N. clear - N Q KB X0 pM0 A0 T0 Herr U. rewrite u_val in *. lra.
Qed.
Lemma far_low : (1 - 40 * u) * (33554432 * X) + (2 - 40 * u) * (33554432 * pM) - (102 / 100) * (33554432 * err) +
  (1 - 3 * u) * (M * /
  67108864) - 33554432 * (20 * t) <= far.
Proof.
  destruct signs as (MP & X0 & A0 & P0 & B & C). pose proof u_pos as U. destruct t_small as [T0 T1]. destruct
    gap_low as [GL GA].
  assert (pM0 : 0 <= pM) by (apply Rmult_le_pos; lra). assert (ua : 0 <= u * a) by (apply Rmult_le_pos; lra).
  pose proof (RN_err (gap * (/ 2 / BALANCE))) as E1. rewrite C in E1. fold t in E1.
  pose proof (RN_err (M * BALANCE)) as E2. rewrite B in E2. fold t in E2. rewrite (Rabs_pos_eq (M * / 67108864)) in
    E2 by lra.
  unfold far. rewrite C, B. set (h := RN (gap * 33554432)) in *. set (k := RN (M * / 67108864)) in *.
  pose proof (RN_err (h + k)) as E3. fold t in E3. set (f := RN (h + k)) in *.
  rewrite Rabs_mult, (Rabs_pos_eq 33554432) in E1 by lra.
  assert (HH : Rabs h <= Rabs gap * 33554432 * (1 + u) + t).
  { pose proof (near_le h (gap * 33554432) _ E1) as N. rewrite Rabs_mult, (Rabs_pos_eq 33554432) in N by lra. lra. }
  apply Rabs_le_inv in E2. assert (KK : Rabs k <= M * / 67108864 * (1 + u) + t) by (apply Rabs_le; lra).
  assert (HK : Rabs (h + k) <= Rabs h + Rabs k) by apply Rabs_triang.
  assert (Q : u * Rabs (h + k) <= u * (Rabs gap * 33554432 * (1 + u) + M * / 67108864 * (1 + u) + 2 * t)) by (apply
    Rmult_le_compat_l; lra). apply Rabs_le_inv in E1. apply Rabs_le_inv in E3.
  clear - E1 E2 E3 Q GL GA X0 A0 pM0 T0 MP Herr ua U. rewrite u_val in *. lra.
Qed.
(* What is taken from the mean covers the bound of the exact numbers, and a bit more. *)
Lemma taken_low : base + mean - m + (32 / 10) * (u * a) + 2 * u * taken + 3 * t <= taken /\ 0 <= taken.
Proof.
  destruct signs as (MP & X0 & A0 & P0 & B & C). pose proof u_pos as U. destruct t_small as [T0 T1]. pose proof
    far_low as FL.
  pose proof doubt_near as D. assert (pM0 : 0 <= pM) by (apply Rmult_le_pos; lra).
  assert (ua : 0 <= u * a) by (apply Rmult_le_pos; lra). assert (pX0 : 0 <= pX) by (apply Rmult_le_pos; lra).
  assert (uuM : 0 <= u * (u * M)) by (apply Rmult_le_pos; [lra | apply Rmult_le_pos; lra]).
  assert (f0 : 0 <= far).
  { clear - FL X0 pM0 T1 T0 Herr MP uuM. rewrite u_val in *. lra. }
  (* far times the pull *)
  assert (PF : (1 - 40 * u) * (33554432 * pX) + (2 - 40 * u) * (33554432 * ppM) - (102 / 100) * (33554432 * pe) +
    (1 - 3 * u) *
    (pM * / 67108864) - 33554432 * (20 * pt) <= pull * far).
  { apply Rle_trans with (pull * ((1 - 40 * u) * (33554432 * X) + (2 - 40 * u) * (33554432 * pM) - (102 / 100) *
    (33554432 * err)
      + (1 - 3 * u) * (M * / 67108864) - 33554432 * (20 * t))); [right; unfold pX, ppM, pe, pM, pt; ring | apply
      Rmult_le_compat_l; lra]. }
  assert (pf0 : 0 <= pull * far) by (apply Rmult_le_pos; lra).
  assert (PE : 0 <= pe <= 1030 * (u * (u * pM))).
  { split; [apply Rmult_le_pos; lra|]. apply Rle_trans with (pull * (1030 * (u * (u * M)))); [apply
    Rmult_le_compat_l; lra|].
    right. unfold pM. ring. }
  assert (PT : 0 <= pt <= / 1000000 * (u * (u * pM))).
  { split; [apply Rmult_le_pos; lra|]. apply Rle_trans with (pull * (/ 1000000 * (u * (u * M)))); [apply
    Rmult_le_compat_l; lra|].
    right. unfold pM. ring. }
  (* the slack as computed *)
  pose proof (RN_err (pull * far)) as E1. fold t in E1. rewrite (Rabs_pos_eq (pull * far)) in E1 by assumption.
  set (h := RN (pull * far)) in *. assert (h0 : 0 <= h) by (unfold h; rewrite <- RN_0; apply RN_le; assumption).
  apply Rabs_le_inv in E1. pose proof (RN_err (err + h)) as E2. fold t in E2. rewrite (Rabs_pos_eq (err + h)) in E2
    by lra.
  set (k := RN (err + h)) in *. assert (k0 : 0 <= k) by (unfold k; rewrite <- RN_0; apply RN_le; lra).
  assert (d0 : 0 <= doubt) by (unfold doubt; rewrite <- RN_0; apply RN_le; unfold MEAN_ERROR; apply Rmult_le_pos;
    [lra | apply
    Rabs_pos]).
  apply Rabs_le_inv in E2. pose proof (RN_err (k + doubt)) as E3. fold t in E3. rewrite (Rabs_pos_eq (k + doubt))
    in E3 by lra.
  change (RN (k + doubt)) with slack in E3. apply Rabs_le_inv in E3.
  assert (sl0 : 0 <= slack) by (unfold slack; rewrite <- RN_0; apply RN_le; fold h; fold k; lra).
  pose proof (RN_err (slack * (1 + BOUND_ERROR))) as E4. fold t in E4. change (RN (slack * (1 + BOUND_ERROR))) with
    taken in E4.
  unfold BOUND_ERROR in E4. rewrite (Rabs_pos_eq (slack * (1 + 16 * u))) in E4 by (apply Rmult_le_pos; lra).
  apply Rabs_le_inv in E4.
  assert (tk0 : 0 <= taken) by (unfold taken; rewrite <- RN_0; apply RN_le; unfold BOUND_ERROR; apply Rmult_le_pos;
    lra).
  split; [|assumption].
  assert (TK : err + pull * far + (159 / 10) * (u * a) - 10 * t <= (1 - 4 * u) * taken).
  { clear - E1 E2 E3 E4 D T0 ua Herr pf0 U. rewrite u_val in *. lra. }
  assert (TK2 : err + pull * far + (159 / 10) * (u * a) - 14 * t + 2 * u * taken <= taken) by (clear - TK tk0 T0;
    rewrite u_val in
    *; lra).
  apply Rle_trans with (2 := TK2). clear E1 E2 E3 E4 TK TK2. apply Rplus_le_reg_r with (- (2 * u * taken)).
  replace (base + mean - m + 32 / 10 * (u * a) + 2 * u * taken + 3 * t + - (2 * u * taken)) with (base + mean - m +
    32 / 10 * (u *
    a) + 3 * t) by ring. replace (err + pull * far + 159 / 10 * (u * a) - 14 * t + 2 * u * taken + - (2 * u *
      taken)) with (err +
    pull * far + 159 / 10 * (u * a) - 14 * t) by ring.
  apply Rabs_le_inv in Hmean. change (M - mu) with X in Hmean. fold a in Hmean.
  destruct (Rle_or_lt (/ 1048576) pull) as [L|S].
  - (* a pull that is not small: the first bound would do *)
    assert (G1 : g * M <= (1 + / 1000) * pM).
    { replace ((1 + / 1000) * pM) with ((1 + / 1000) * pull * M) by (unfold pM; ring). apply Rmult_le_compat_r; lra. }
    assert (Q1 : / 1048576 * pM <= ppM) by (unfold ppM; apply Rmult_le_compat_r; [exact pM0 | lra]).
    assert (Q2 : / 1048576 * X <= pX) by (unfold pX; apply Rmult_le_compat_r; lra).
    assert (UM : u * (u * M) <= u * (u * (1048576 * pM))).
    { apply Rmult_le_compat_l; [lra|]. apply Rmult_le_compat_l; [lra|]. assert (/ 1048576 * M <= pM) by (unfold pM;
        apply Rmult_le_compat_r; lra). lra. }
    clear - H1 G1 Q1 Q2 UM Hmean PF PE PT T0 T1 Herr X0 A0 ua pM0 pX0 U. rewrite u_val in *. lra.
  - pose proof (Hsmall (Rlt_le _ _ S)) as GS. set (p := pull - u * / 2) in *. pose proof (H2 p GS) as H.
    change (M - mu) with X in H. rewrite B in H.
    replace ((X + 2 * M * p) / (2 * / 67108864)) with (33554432 * X + 67108864 * (M * p)) in H by field.
    assert (p0 : 0 <= p) by lra.
    assert (EP : p * (33554432 * X + 67108864 * (M * p) + M * / 67108864) = pull * (33554432 * X + 67108864 * (M *
      p) + M * /
      67108864) - u * / 2 * (33554432 * X + 67108864 * (M * p) + M * / 67108864)) by (unfold p; ring).
    assert (MPp : M * p = pM - u * / 2 * M) by (unfold p, pM; ring). rewrite MPp in EP.
    assert (EP2 : pull * (33554432 * X + 67108864 * (pM - u * / 2 * M) + M * / 67108864) = 33554432 * pX + 67108864
      * ppM - 67108864
      * (u * / 2 * pM) + pM * / 67108864) by (unfold pX, ppM, pM; ring). rewrite MPp in H. rewrite EP, EP2 in H.
    assert (Q1 : ppM <= / 1048576 * pM) by (unfold ppM; apply Rmult_le_compat_r; [exact pM0 | lra]).
    assert (Q2 : pX <= / 1048576 * X) by (unfold pX; apply Rmult_le_compat_r; lra).
    assert (ppM0 : 0 <= ppM) by (unfold ppM; apply Rmult_le_pos; [lra | exact pM0]).
    clear - H Q1 Q2 ppM0 Hmean PF PE PT T0 T1 Herr X0 A0 ua pM0 pX0 MP U. rewrite u_val in *. lra.
Qed.
Theorem MEAN_ERROR_holds : bound <= m.
Proof.
  destruct signs as (MP & X0 & A0 & P0 & _). pose proof u_pos as U. destruct t_small as [T0 T1]. destruct taken_low
    as [TL TK0].
  assert (ua : 0 <= u * a) by (apply Rmult_le_pos; lra).
  pose proof (RN_diff mean taken Fmean (RN_F _)) as E1. fold below in E1.
  assert (A : Rabs (mean - taken) <= a + taken) by (unfold Rminus; eapply Rle_trans; [apply Rabs_triang|]; rewrite
    Rabs_Ropp,
    (Rabs_pos_eq taken) by assumption; unfold a; lra).
  assert (UA : u * Rabs (mean - taken) <= u * (a + taken)) by (apply Rmult_le_compat_l; lra). apply Rabs_le_inv in E1.
  assert (BL : base + below + (21 / 10) * (u * a) <= m).
  { clear - E1 UA TL T0 TK0 ua U. assert (0 <= u * taken) by (apply Rmult_le_pos; lra). lra. }
  assert (bm : below <= mean) by (rewrite <- (RN_id mean Fmean); apply RN_le; lra).
  assert (Fbelow : F below) by apply RN_F. assert (Fsum : F sum) by apply RN_F. pose proof (bp_pos (-300)) as B3.
  assert (SP : 0 < SPACING) by (unfold SPACING; apply Rmult_lt_0_compat; lra).
  assert (Take : 0 <= sum -> bound <= sum).
  { intro S0. apply Rle_trans with (RN sum); [|rewrite (RN_id sum Fsum); lra]. unfold bound. apply RN_le. destruct
    Rlt_dec; [|lra].
    assert (0 <= RN (sum * SPACING)) by (rewrite <- RN_0; apply RN_le; apply Rmult_le_pos; lra). lra. }
  destruct (Rle_or_lt 0 (base + below)) as [P|N].
  - assert (S0 : 0 <= sum) by (unfold sum; rewrite <- RN_0; apply RN_le; assumption). specialize (Take S0).
    destruct (Rle_or_lt (Rabs below) (Rabs base)) as [L|G].
    + pose proof (fast_two_sum base below Fbase Fbelow L) as E. fold sum in E.
      destruct (Rle_or_lt (bp (-900)) sum) as [Big|Tiny].
      * unfold bound. destruct Rlt_dec as [Z|Z].
        -- destruct (SPACING_holds sum Fsum Big) as [_ Before]. apply Rle_trans with (1 := Before).
           assert (PR : pred radix2 fexp sum <= base + below) by (unfold sum; apply pred_round_le_id; typeclasses
             eauto). lra.
        -- rewrite Rminus_0_r, (RN_id sum Fsum). lra.
      * pose proof (bp_lt (-900) (-300) ltac:(lia)). lra.
    + rewrite (Rabs_pos_eq base) in G by assumption.
      assert (BP : base < below) by (unfold Rabs in G; destruct Rcase_abs in G; lra).
      pose proof (RN_sum base below Fbase Fbelow) as E. fold sum in E. rewrite (Rabs_pos_eq (base + below)) in E by
        assumption.
      apply Rabs_le_inv in E. assert (u * (base + below) <= u * (2 * a)).
      { apply Rmult_le_compat_l; [lra|]. assert (mean <= a) by apply Rle_abs. lra. }
      lra.
  - assert (S0 : sum <= 0) by (unfold sum; rewrite <- RN_0; apply RN_le; lra). apply Rle_trans with 0; [|lra].
    apply Rle_trans with (RN 0); [|rewrite RN_0; lra]. unfold bound. apply RN_le. destruct Rlt_dec; [|lra].
    assert (Q : sum <= RN (sum * SPACING)); [|lra]. apply Rle_trans with (RN sum); [rewrite (RN_id sum Fsum);
      lra|]. apply RN_le.
    assert (SPACING <= 1) by (unfold SPACING; rewrite u_val; lra).
    assert (0 <= - sum * (1 - SPACING)) by (apply Rmult_le_pos; lra). lra.
Qed.
Theorem BALANCE_holds : BALANCE = bp (-26) /\ 0 < BALANCE /\ / 2 / BALANCE = bp 25.
Proof. destruct signs as (_ & _ & _ & _ & B & C). rewrite B in *. simpl. repeat split; lra. Qed.
Theorem BOUND_ERROR_holds : base + mean - m + (32 / 10) * (u * a) + 2 * u * taken + 3 * t <= taken.
Proof. exact (proj1 taken_low). Qed.
End Rounded.
