(* rt-geom, enclosing/certify.rs, `lower_bound`: the mean reach and the pull of four spheres, as computed. *)
From Proofs Require Import Rounding Norm Reach.
Open Scope R_scope.

(* The errors of the pull, absolute, beside what a step adds to it. *)
Definition PULL_ERROR := 16 * u.

(* ---- Sums of four, one for each sphere ---- *)
Definition sum4 (f : nat -> R) := f 0%nat + f 1%nat + f 2%nat + f 3%nat.
Lemma sum4_le : forall f h, (forall i, f i <= h i) -> sum4 f <= sum4 h.
Proof. intros f h H. unfold sum4. pose proof (H 0%nat). pose proof (H 1%nat). pose proof (H 2%nat).
pose proof (H 3%nat). lra. Qed.
Lemma sum4_abs : forall f, Rabs (sum4 f) <= sum4 (fun i => Rabs (f i)).
Proof.
  intro f. unfold sum4. eapply Rle_trans; [apply Rabs_triang|]. apply Rplus_le_compat_r.
  eapply Rle_trans; [apply Rabs_triang|]. apply Rplus_le_compat_r. apply Rabs_triang.
Qed.
(* Sums that are off term by term. *)
Lemma sum4_near : forall f h b, (forall i, Rabs (f i - h i) <= b i) -> Rabs (sum4 f - sum4 h) <= sum4 b.
Proof.
  intros f h b H. replace (sum4 f - sum4 h) with (sum4 (fun i => f i - h i)) by (unfold sum4; ring).
  eapply Rle_trans; [apply sum4_abs | now apply sum4_le].
Qed.
(* A sum as computed, in pairs or one after the other. *)
Definition summed f z := Rabs (z - sum4 f) <= (3 + / 1000) * u * sum4 (fun i => Rabs (f i)).
Theorem sums_of_four : forall a b c d, F a -> F b -> F c -> F d ->
  let m := Rabs a + Rabs b + Rabs c + Rabs d in
  Rabs (RN (RN (a + b) + RN (c + d)) - (a + b + c + d)) <= (3 + / 1000) * u * m /\
  Rabs (RN (RN (RN (a + b) + c) + d) - (a + b + c + d)) <= (3 + / 1000) * u * m.
Proof.
  intros a b c d Fa Fb Fc Fd m. pose proof (RN_sum a b Fa Fb) as E1. set (x := RN (a + b)) in *.
  pose proof (RN_sum c d Fc Fd) as E2. set (y := RN (c + d)) in *.
  pose proof (RN_sum x y (RN_F _) (RN_F _)) as E3. pose proof (RN_sum x c (RN_F _) Fc) as E4.
  set (z := RN (x + c)) in *. pose proof (RN_sum z d (RN_F _) Fd) as E5.
  pose proof (Rabs_triang a b) as T1. pose proof (Rabs_triang c d) as T2. pose proof (Rabs_triang x y) as T3.
  pose proof (Rabs_triang x c) as T4. pose proof (Rabs_triang z d) as T5.
  pose proof (near_le _ _ _ E1) as N1. pose proof (near_le _ _ _ E2) as N2. pose proof (near_le _ _ _ E4) as N4.
  pose proof (Rabs_pos a). pose proof (Rabs_pos b). pose proof (Rabs_pos c). pose proof (Rabs_pos d). unfold m.
  split.
  - replace (RN (x + y) - (a + b + c + d)) with ((RN (x + y) - (x + y)) + ((x - (a + b)) + (y - (c + d)))) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_l, Rabs_triang|].
    clear - E1 E2 E3 T1 T2 T3 N1 N2 H H0 H1 H2. rewrite u_val in *. lra.
  - replace (RN (z + d) - (a + b + c + d)) with ((RN (z + d) - (z + d)) + ((z - (x + c)) + (x - (a + b)))) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_l, Rabs_triang|].
    clear - E1 E4 E5 T1 T4 T5 N1 N4 H H0 H1 H2. rewrite u_val in *. lra.
Qed.

Section Mean.
(* The shares, what the reaches are above the first one, in two parts, the reaches exactly and the largest of them; the
   sums as computed. What a reach is known by is the conclusion of Step.v. *)
Variables (share h l rho : nat -> R) (base err M total num : R).
Hypotheses (Fh : forall i, F (h i)) (Fbase : F base) (Fl : forall i, F (l i)).
Hypotheses (Hshare : forall i, 0 <= share i) (Hrho : forall i, Rabs (rho i - (h i + l i)) + 2 * (u * Rabs (l i)) <= (1
  - / 100) * err) (Hmost : forall i, rho i <= M).
Let e i := RN (RN (h i - base) + l i).
Let p i := RN (share i * e i).
Hypotheses (Htotal : summed share total) (Hnum : summed p num) (T0 : bp (-500) <= total) (M0 : bp (-200) <= M)
  (Herr : u * (u * M) <= err).
Let mean := RN (num / total).
Let S := sum4 share.
Let mu := sum4 (fun i => share i / S * rho i).
Let t := bp (-1075).
Let delta i := rho i - base.
Let A := sum4 (fun i => share i * Rabs (delta i)).
Let N := sum4 (fun i => share i * delta i).

Lemma total_near : 0 < S /\ Rabs (total - S) <= (3 + / 1000) * u * S /\ bp (-501) <= S.
Proof.
  pose proof Htotal as H. unfold summed in H. fold S in H. assert (E : sum4 (fun i => Rabs (share i)) = S).
  { unfold S, sum4. now rewrite !Rabs_pos_eq by apply Hshare. }
  rewrite E in H. pose proof (bp_pos (-501)) as B. assert (B2 : bp (-500) = 2 * bp (-501)) by (change (-500)%Z with (1 +
    -501)%Z; rewrite bp_add, bp_1; ring). rewrite B2 in T0.
  assert (0 <= S) by (unfold S, sum4; pose proof (Hshare 0%nat); pose proof (Hshare 1%nat); pose proof (Hshare 2%nat);
    pose proof (Hshare 3%nat); lra).
  assert (bp (-501) <= S). { apply Rabs_le_inv in H. rewrite u_val in H. lra. }
  repeat split; lra.
Qed.
Lemma err_pos : 0 < err /\ t <= / 1000000 * err /\ t <= / 1000000 * (err * S).
Proof.
  pose proof u_pos as U. pose proof (bp_pos (-200)). destruct total_near as (S0 & _ & SL).
  assert (L : u * (u * bp (-200)) <= err).
  { eapply Rle_trans; [|exact Herr]. repeat apply Rmult_le_compat_l; lra. }
  assert (L2 : bp (-306) <= err) by (apply Rle_trans with (2 := L); unfold u; rewrite <- !bp_add; apply bp_le; lia).
  pose proof (bp_pos (-306)). assert (B20 : bp (-20) <= / 1000000) by (simpl; lra). pose proof (bp_pos (-20)).
  assert (E0 : 0 < err) by lra. split; [assumption|]. split.
  - apply Rle_trans with (bp (-20) * bp (-306)); [unfold t; rewrite <- bp_add; apply bp_le; lia|].
    apply Rmult_le_compat; lra.
  - apply Rle_trans with (bp (-20) * (bp (-306) * bp (-501))); [unfold t; rewrite <- !bp_add; apply bp_le; lia|].
    pose proof (bp_pos (-501)). apply Rmult_le_compat; try lra; [apply Rmult_le_pos; lra | apply Rmult_le_compat; lra].
Qed.
(* One difference, and its product with the share. *)
Lemma difference_near : forall i, Rabs (e i - delta i) <= (1 - / 200) * err + (2 + / 100) * (u * Rabs (delta i)).
Proof.
  intro i. destruct err_pos as (E0 & _). pose proof u_pos as U. pose proof (Hrho i) as X.
  set (x := rho i - (h i + l i)) in *.
  pose proof (RN_diff (h i) base (Fh i) Fbase) as R1. set (k := RN (h i - base)) in *.
  pose proof (RN_sum k (l i) (RN_F _) (Fl i)) as R2. change (RN (k + l i)) with (e i) in R2.
  assert (K : h i - base = delta i + - x + - l i) by (unfold delta, x; ring).
  assert (A1 : Rabs (h i - base) <= Rabs (delta i) + Rabs x + Rabs (l i)).
  { rewrite K. eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. apply Rplus_le_compat_r.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. lra. }
  assert (A2 : Rabs (k + l i) <= Rabs (delta i) + Rabs x + u * (Rabs (delta i) + Rabs x + Rabs (l i))).
  { replace (k + l i) with (delta i + - x + (k - (h i - base))) by (rewrite K; ring).
    eapply Rle_trans; [apply Rabs_triang|]. apply Rplus_le_compat.
    - eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. lra.
    - eapply Rle_trans; [exact R1|]. apply Rmult_le_compat_l; lra. }
  replace (e i - delta i) with ((e i - (k + l i)) + (k - (h i - base)) + - x) by (rewrite K; ring).
  eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp.
  eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
  pose proof (Rabs_pos x). pose proof (Rabs_pos (l i)). pose proof (Rabs_pos (delta i)).
  clear - R1 R2 A1 A2 X E0 H H0 H1. set (a := Rabs (h i - base)) in *. rewrite u_val in *. lra.
Qed.
Lemma product_near : forall i, Rabs (p i - share i * delta i) <=
  (1 - / 400) * (share i * err) + (3 + / 50) * u * (share i * Rabs (delta i)) + t.
Proof.
  intro i. destruct err_pos as (E0 & _). pose proof (difference_near i) as D. pose proof (Hshare i) as s0.
  pose proof (RN_err (share i * e i)) as R. change (RN (share i * e i)) with (p i) in R. fold t in R.
  rewrite Rabs_mult, (Rabs_pos_eq (share i)) in R by assumption. pose proof (near_le _ _ _ D) as N1.
  replace (p i - share i * delta i) with ((p i - share i * e i) + share i * (e i - delta i)) by ring.
  eapply Rle_trans; [apply Rabs_triang|]. rewrite (Rabs_mult (share i)), (Rabs_pos_eq (share i)) by assumption.
  assert (P1 : share i * Rabs (e i - delta i) <= share i * ((1 - / 200) * err + (2 + / 100) * (u * Rabs (delta i))))
    by (apply Rmult_le_compat_l; assumption).
  assert (P2 : share i * Rabs (e i) <= share i * (Rabs (delta i) + ((1 - / 200) * err + (2 + / 100) * (u * Rabs (delta
    i))))) by (apply Rmult_le_compat_l; assumption).
  assert (0 <= share i * err) by (apply Rmult_le_pos; lra).
  assert (0 <= share i * Rabs (delta i)) by (apply Rmult_le_pos; [assumption | apply Rabs_pos]).
  set (a := share i * err) in *. set (b := share i * Rabs (delta i)) in *.
  replace (share i * ((1 - / 200) * err + (2 + / 100) * (u * Rabs (delta i)))) with ((1 - / 200) * a + (2 + / 100) * u *
    b) in P1 by (unfold a, b; ring).
  replace (share i * (Rabs (delta i) + ((1 - / 200) * err + (2 + / 100) * (u * Rabs (delta i))))) with (b + (1 - /
    200) *
    a + (2 + / 100) * u * b) in P2 by (unfold a, b; ring).
  clear - R P1 P2 H H0. set (q := share i * Rabs (e i)) in *. rewrite u_val in *. lra.
Qed.
(* The sum of differences is hardly larger than the mean one: no reach is above M. *)
Lemma spread : A <= Rabs N + 2 * (S * (M - mu)) /\ N = S * (mu - base).
Proof.
  destruct total_near as (S0 & _). assert (NE : N = S * (mu - base)).
  { unfold N, mu, delta, S, sum4 in *. set (a := share 0%nat) in *. set (b := share 1%nat) in *.
    set (c := share 2%nat) in *. set (d := share 3%nat) in *. field. lra. }
  split; [|exact NE]. set (m := mu - base) in *. assert (SM : S * m = N) by now rewrite NE.
  assert (top : m <= M - base).
  { apply Rmult_le_reg_l with S; [assumption|]. rewrite SM. unfold N, S, sum4.
    assert (P : forall i, share i * delta i <= share i * (M - base)).
    { intro i. apply Rmult_le_compat_l; [apply Hshare|]. unfold delta. pose proof (Hmost i). lra. }
    pose proof (P 0%nat). pose proof (P 1%nat). pose proof (P 2%nat). pose proof (P 3%nat). lra. }
  assert (P : forall i, share i * Rabs (delta i) <= share i * (Rabs m + 2 * (M - base - m) - (delta i - m))).
  { intro i. apply Rmult_le_compat_l; [apply Hshare|]. replace (delta i) with (m + (delta i - m)) at 1 by ring.
    eapply Rle_trans; [apply Rabs_triang|]. pose proof (Hmost i) as D.
    assert (Rabs (delta i - m) <= 2 * (M - base - m) - (delta i - m)); [|lra].
    apply Rabs_le. unfold delta. lra. }
  apply Rle_trans with (sum4 (fun i => share i * (Rabs m + 2 * (M - base - m) - (delta i - m)))).
  - now apply sum4_le.
  - replace (Rabs N) with (S * Rabs m) by (rewrite <- SM, Rabs_mult, (Rabs_pos_eq S); lra).
    replace (M - mu) with (M - base - m) by (unfold m; ring).
    assert (Z : sum4 (fun i => share i * (delta i - m)) = 0).
    { replace (sum4 (fun i => share i * (delta i - m))) with (N - S * m) by (unfold N, S, sum4; ring).
      rewrite SM. ring. }
    right. replace (sum4 (fun i => share i * (Rabs m + 2 * (M - base - m) - (delta i - m)))) with
      (S * (Rabs m + 2 * (M - base - m)) - sum4 (fun i => share i * (delta i - m))) by (unfold S, sum4; ring).
    rewrite Z. ring.
Qed.
(* The mean reach errs by the error of reaches, and by its own roundings. *)
Theorem mean_near : Rabs (mu - (base + mean)) <= err + 11 * (u * Rabs mean) + 22 * (u * (M - mu)).
Proof.
  destruct total_near as (S0 & TN & SL). destruct err_pos as (E0 & E1 & E2). destruct spread as [AN NE].
  pose proof u_pos as U. assert (t0 : 0 < t) by apply bp_pos.
  assert (A0 : 0 <= A).
  { unfold A, sum4. assert (P : forall i, 0 <= share i * Rabs (delta i)) by (intro; apply Rmult_le_pos; [apply Hshare |
      apply Rabs_pos]). pose proof (P 0%nat). pose proof (P 1%nat). pose proof (P 2%nat). pose proof (P 3%nat). lra. }
  set (x := err * S) in *. assert (x0 : 0 < x) by (unfold x; now apply Rmult_lt_0_compat).
  (* the sum of products *)
  assert (P : Rabs (sum4 p - N) <= (1 - / 400) * x + (3 + / 50) * u * A + 4 * t).
  { eapply Rle_trans; [apply (sum4_near p (fun i => share i * delta i)); apply product_near|].
    right. unfold x, A, S, sum4. ring. }
  assert (PA : sum4 (fun i => Rabs (p i)) <= A + ((1 - / 400) * x + (3 + / 50) * u * A + 4 * t)).
  { apply Rle_trans with (sum4 (fun i => share i * Rabs (delta i) + ((1 - / 400) * (share i * err) + (3 + / 50) * u *
      (share i * Rabs (delta i)) + t))).
    - apply sum4_le. intro i. eapply Rle_trans; [apply (near_le _ _ _ (product_near i))|].
      rewrite Rabs_mult, (Rabs_pos_eq (share i)) by apply Hshare. lra.
    - right. unfold x, A, S, sum4. ring. }
  pose proof Hnum as Q. unfold summed in Q.
  assert (NN : Rabs (num - N) <= (1 - / 401) * x + (6 + / 40) * u * A + 5 * t).
  { replace (num - N) with ((num - sum4 p) + (sum4 p - N)) by ring. eapply Rle_trans; [apply Rabs_triang|].
    clear - Q PA P A0 x0 t0. set (s := sum4 (fun i => Rabs (p i))) in *. rewrite u_val in *. lra. }
  assert (AN2 : Rabs N <= A).
  { eapply Rle_trans; [apply sum4_abs|]. apply sum4_le. intro i. rewrite Rabs_mult, (Rabs_pos_eq (share i)) by apply
      Hshare. lra. }
  pose proof (near_le _ _ _ NN) as NB.
  (* the quotient, times S *)
  pose proof (bp_pos (-500)) as B5. assert (tp : 0 < total) by lra. set (q := num / total) in *.
  assert (qt : q * total = num) by (unfold q; field; lra).
  assert (QS : Rabs q * S <= (1 + 4 * u) * Rabs num).
  { rewrite <- qt at 1. rewrite Rabs_mult, (Rabs_pos_eq total) by lra.
    replace ((1 + 4 * u) * (Rabs q * total)) with (Rabs q * ((1 + 4 * u) * total)) by ring.
    apply Rmult_le_compat_l; [apply Rabs_pos|]. apply Rabs_le_inv in TN. clear - TN S0. rewrite u_val in *. lra. }
  assert (Q1 : Rabs (q * S - num) <= (3 + / 1000) * u * (Rabs q * S)).
  { rewrite <- qt. replace (q * S - q * total) with (q * - (total - S)) by ring. rewrite Rabs_mult, Rabs_Ropp.
    replace ((3 + / 1000) * u * (Rabs q * S)) with (Rabs q * ((3 + / 1000) * u * S)) by ring.
    apply Rmult_le_compat_l; [apply Rabs_pos | assumption]. }
  pose proof (RN_err q) as R. change (RN q) with mean in R. fold t in R.
  assert (R2 : Rabs (mean * S - q * S) <= u * (Rabs q * S) + t * S).
  { replace (mean * S - q * S) with ((mean - q) * S) by ring. rewrite Rabs_mult, (Rabs_pos_eq S) by lra.
    replace (u * (Rabs q * S) + t * S) with ((u * Rabs q + t) * S) by ring. apply Rmult_le_compat_r; lra. }
  assert (tS : t * S <= / 1000000 * x).
  { replace (/ 1000000 * x) with (/ 1000000 * err * S) by (unfold x; ring). apply Rmult_le_compat_r; lra. }
  assert (Z : Rabs (mean * S - N) <= (1 - / 500) * x + (10 + / 10) * u * A).
  { replace (mean * S - N) with ((mean * S - q * S) + (q * S - num) + (num - N)) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
    clear - R2 Q1 QS NB NN AN2 tS E2 A0 x0 t0. set (y := Rabs q * S) in *. set (n := Rabs num) in *.
    rewrite u_val in *. lra. }
  (* divided by S *)
  assert (MM : Rabs (mu - base - mean) <= (1 - / 500) * err + (10 + / 10) * u * (Rabs (mu - base) + 2 * (M - mu))).
  { apply Rmult_le_reg_r with S; [assumption|]. rewrite <- (Rabs_pos_eq S) at 1 by lra. rewrite <- Rabs_mult.
    replace ((mu - base - mean) * S) with (- (mean * S - N)) by (rewrite NE; ring). rewrite Rabs_Ropp.
    eapply Rle_trans; [exact Z|]. rewrite NE, Rabs_mult, (Rabs_pos_eq S) in AN by lra.
    replace (((1 - / 500) * err + (10 + / 10) * u * (Rabs (mu - base) + 2 * (M - mu))) * S) with
      ((1 - / 500) * x + (10 + / 10) * u * (S * Rabs (mu - base) + 2 * (S * (M - mu)))) by (unfold x; ring).
    apply Rplus_le_compat_l. apply Rmult_le_compat_l; [lra | exact AN]. }
  replace (mu - (base + mean)) with (mu - base - mean) by ring.
  assert (mM : 0 <= M - mu).
  { apply Rmult_le_reg_l with (2 * S); [lra|]. rewrite Rmult_0_r.
    assert (Rabs N - S * Rabs (mu - base) = 0) by (rewrite NE, Rabs_mult, (Rabs_pos_eq S) by lra; ring).
    assert (P3 : forall i, share i * rho i <= share i * M) by (intro i; apply Rmult_le_compat_l; [apply Hshare | apply
      Hmost]).
    assert (SM : S * mu = sum4 (fun i => share i * rho i)).
    { unfold mu, S, sum4 in *. set (a := share 0%nat) in *. set (b := share 1%nat) in *. set (c := share 2%nat) in *.
      set (d := share 3%nat) in *. field. lra. }
    assert (S * mu <= S * M).
    { rewrite SM. unfold S, sum4. pose proof (P3 0%nat). pose proof (P3 1%nat). pose proof (P3 2%nat).
      pose proof (P3 3%nat). lra. }
    lra. }
  assert (MB : Rabs (mu - base) <= Rabs mean + Rabs (mu - base - mean)).
  { replace (mu - base) with (mean + (mu - base - mean)) at 1 by ring. apply Rabs_triang. }
  pose proof (Rabs_pos mean) as m0. pose proof (Rabs_pos (mu - base - mean)) as d0.
  clear - MM MB E0 mM m0 d0. set (y := Rabs (mu - base - mean)) in *. set (z := Rabs (mu - base)) in *.
  set (w := M - mu) in *. set (m := Rabs mean) in *. clearbody y z w m. rewrite u_val in *. lra.
Qed.
End Mean.

(* ---- The pull ---- *)
Lemma norm_sum4 : forall f h k, norm (sum4 f) (sum4 h) (sum4 k) <= sum4 (fun i => norm (f i) (h i) (k i)).
Proof.
  intros f h k. unfold sum4. eapply Rle_trans; [apply norm_triangle|]. apply Rplus_le_compat_r.
  eapply Rle_trans; [apply norm_triangle|]. apply Rplus_le_compat_r. apply norm_triangle.
Qed.

Section Pull.
(* Offsets v of the center from those of the spheres, by axis, and the step e, both exactly; the offsets and the step
   rounded, weights, distances as computed, and the sums. Distances are off by 4 u at most (Reach.v). *)
Variables (v1 v2 v3 x1 x2 x3 w D : nat -> R) (e1 e2 e3 y1 y2 y3 G1 G2 G3 total length nearest : R).
Let len i := norm (v1 i) (v2 i) (v3 i).
Let away i := norm (v1 i + e1) (v2 i + e2) (v3 i + e3).
Let E := norm e1 e2 e3.
Let share i := RN (w i * D i).
Let S := sum4 share.
Let part (x : nat -> R) y i := RN (w i * RN (x i + y)).
Hypotheses (Fx1 : forall i, F (x1 i)) (Fx2 : forall i, F (x2 i)) (Fx3 : forall i, F (x3 i)) (Fy1 : F y1) (Fy2 : F y2)
  (Fy3 : F y3).
Hypotheses (Hx1 : forall i, Rabs (x1 i - v1 i) <= u * Rabs (v1 i)) (Hx2 : forall i, Rabs (x2 i - v2 i) <= u * Rabs (v2
  i)) (Hx3 : forall i, Rabs (x3 i - v3 i) <= u * Rabs (v3 i)) (Hy1 : Rabs (y1 - e1) <= u * Rabs e1) (Hy2 : Rabs (y2 -
  e2) <= u * Rabs e2) (Hy3 : Rabs (y3 - e3) <= u * Rabs e3).
Hypotheses (Hw : forall i, 0 <= w i) (HD : forall i, Rabs (D i - len i) <= 4 * u * len i) (Hnear : forall i, 0 < nearest
  <= D i) (Haway : forall i, 0 < away i) (Hlength : (1 - 4 * u) * E <= length).
Hypotheses (Htotal : summed share total) (T0 : bp (-500) <= total) (H1 : summed (part x1 y1) G1) (H2 : summed (part x2
  y2) G2) (H3 : summed (part x3 y3) G3).
Let P := RN (RN (Rabs G1 + Rabs G2) + Rabs G3).
Let pull := RN (RN (RN (P / total) + PULL_ERROR) + RN (2 * length / nearest)).
(* the mean of the directions, by the exact shares of what is computed *)
Let g1 := sum4 (fun i => share i / S * ((v1 i + e1) / away i)).
Let g2 := sum4 (fun i => share i / S * ((v2 i + e2) / away i)).
Let g3 := sum4 (fun i => share i / S * ((v3 i + e3) / away i)).
Let t := bp (-1075).
Let ratio := E / nearest.

Lemma share_pos : forall i, 0 <= share i.
Proof.
  intro i. unfold share. rewrite <- RN_0. apply RN_le. apply Rmult_le_pos; [apply Hw | pose proof (Hnear i); lra].
Qed.
Lemma shares_near : 0 < S /\ Rabs (total - S) <= (3 + / 1000) * u * S /\ t <= / 1000000 * (u * S) /\ t <= / 1000000 * u.
Proof.
  destruct (total_near share total share_pos Htotal T0) as (S0 & TN & SL). fold S in S0, TN, SL.
  repeat split; try assumption.
  - apply Rle_trans with (bp (-20) * (u * bp (-501))); [unfold t, u; rewrite <- !bp_add; apply bp_le; lia|].
    pose proof u_pos. pose proof (bp_pos (-501)). assert (B20 : bp (-20) <= / 1000000) by (simpl; lra).
    pose proof (bp_pos (-20)). apply Rmult_le_compat; try lra; [apply Rmult_le_pos; lra | apply Rmult_le_compat_l; lra].
  - apply Rle_trans with (bp (-20) * u); [unfold t, u; rewrite <- !bp_add; apply bp_le; lia|].
    pose proof u_pos. apply Rmult_le_compat_r; simpl; lra.
Qed.
Lemma ratio_pos : 0 <= ratio /\ ratio * nearest = E.
Proof.
  pose proof (Hnear 0%nat) as N. assert (R : ratio * nearest = E) by (unfold ratio; field; lra). split; [|exact R].
  unfold ratio. apply Rmult_le_pos; [apply norm_pos | apply Rlt_le, Rinv_0_lt_compat; lra].
Qed.
(* A weight times a distance, and times the step. *)
Lemma weighted : forall i, w i * D i <= (1 + 2 * u) * share i + 2 * t /\ w i * len i <= (1 + 8 * u) * share i + 3 * t /\
  w i * E <= ratio * ((1 + 2 * u) * share i + 2 * t).
Proof.
  intro i. pose proof (Hnear i) as N. pose proof (Hw i) as W. pose proof u_pos as U.
  assert (t0 : 0 < t) by apply bp_pos.
  destruct ratio_pos as [R0 RE]. assert (wD : 0 <= w i * D i) by (apply Rmult_le_pos; lra).
  pose proof (RN_err (w i * D i)) as R. change (RN (w i * D i)) with (share i) in R. fold t in R.
  rewrite (Rabs_pos_eq (w i * D i)) in R by assumption. apply Rabs_le_inv in R.
  assert (A : w i * D i <= (1 + 2 * u) * share i + 2 * t).
  { pose proof (share_pos i). clear - R wD t0 H. set (a := w i * D i) in *. set (s := share i) in *.
    rewrite u_val in *. lra. }
  split; [exact A|]. split.
  - pose proof (HD i) as Q. apply Rabs_le_inv in Q. assert (L : len i <= (1 + 5 * u) * D i).
    { assert (0 <= len i) by apply norm_pos. clear - Q H. rewrite u_val in *. lra. }
    apply Rle_trans with ((1 + 5 * u) * (w i * D i)).
    + replace ((1 + 5 * u) * (w i * D i)) with (w i * ((1 + 5 * u) * D i)) by ring. apply Rmult_le_compat_l; assumption.
    + pose proof (share_pos i). clear - A H t0 wD. set (a := w i * D i) in *. set (s := share i) in *.
      rewrite u_val in *. lra.
  - rewrite <- RE. replace (w i * (ratio * nearest)) with (ratio * (w i * nearest)) by ring.
    apply Rmult_le_compat_l; [assumption|]. apply Rle_trans with (2 := A). apply Rmult_le_compat_l; lra.
Qed.
(* How far the share of a direction is from the weight of the vector. *)
Lemma direction_near : forall i, Rabs (share i - w i * away i) <= (5 + / 50) * u * share i + 3 * t + ratio * ((1 + 2 *
  u)
  * share i + 2 * t).
Proof.
  intro i. pose proof (Hnear i) as N. pose proof (Hw i) as W. pose proof u_pos as U.
  assert (t0 : 0 < t) by apply bp_pos.
  destruct (weighted i) as (A1 & A2 & A3). assert (wD : 0 <= w i * D i) by (apply Rmult_le_pos; lra).
  pose proof (RN_err (w i * D i)) as R. change (RN (w i * D i)) with (share i) in R. fold t in R.
  rewrite (Rabs_pos_eq (w i * D i)) in R by assumption.
  assert (B1 : Rabs (w i * D i - w i * len i) <= 4 * u * (w i * len i)).
  { replace (w i * D i - w i * len i) with (w i * (D i - len i)) by ring. rewrite Rabs_mult, (Rabs_pos_eq (w i)) by
      assumption. replace (4 * u * (w i * len i)) with (w i * (4 * u * len i)) by ring. apply Rmult_le_compat_l; auto. }
  assert (B2 : Rabs (w i * len i - w i * away i) <= w i * E).
  { replace (w i * len i - w i * away i) with (w i * (len i - away i)) by ring.
    rewrite Rabs_mult, (Rabs_pos_eq (w i)) by
      assumption. apply Rmult_le_compat_l; [assumption|]. apply Rabs_le. split.
    - assert (away i <= len i + E) by (unfold away, len, E; apply norm_triangle). lra.
    - pose proof (norm_triangle (v1 i + e1) (v2 i + e2) (v3 i + e3) (- e1) (- e2) (- e3)) as T. rewrite norm_opp in T.
      replace (v1 i + e1 + - e1) with (v1 i) in T by ring. replace (v2 i + e2 + - e2) with (v2 i) in T by ring.
      replace (v3 i + e3 + - e3) with (v3 i) in T by ring. fold (len i) (away i) E in T. lra. }
  replace (share i - w i * away i) with ((share i - w i * D i) + (w i * D i - w i * len i) + (w i * len i - w i * away
    i))
    by ring. eapply Rle_trans; [apply Rabs_triang|]. apply Rplus_le_compat; [|lra].
  eapply Rle_trans; [apply Rabs_triang|]. pose proof (share_pos i).
  assert (0 <= w i * len i) by (apply Rmult_le_pos; [assumption | apply norm_pos]).
  clear - R A1 A2 B1 t0 H H0 wD. set (a := w i * D i) in *. set (b := w i * len i) in *. set (s := share i) in *.
  rewrite u_val in *. lra.
Qed.
(* One axis of a weighted vector, and their sum. *)
Lemma part_near : forall (x v : nat -> R) y e, (forall i, F (x i)) -> F y -> (forall i, Rabs (x i - v i) <= u * Rabs (v
  i)) -> Rabs (y - e) <= u * Rabs e -> forall i,
  Rabs (part x y i - w i * (v i + e)) <= (3 + / 100) * u * (w i * (Rabs (v i) + Rabs e)) + t.
Proof.
  intros x v y e Fx Fy Hx Hy i. pose proof (RN_sum (x i) y (Fx i) Fy) as R1. set (z := RN (x i + y)) in *.
  pose proof (RN_err (w i * z)) as R2. change (RN (w i * z)) with (part x y i) in R2. fold t in R2.
  pose proof (Hw i) as W.
  specialize (Hx i). pose proof (near_le _ _ _ Hx) as X1. pose proof (near_le _ _ _ Hy) as Y1.
  pose proof (Rabs_triang (x i) y) as T. pose proof (Rabs_pos (v i)) as V0. pose proof (Rabs_pos e) as E0.
  assert (Z : Rabs (z - (v i + e)) <= (2 + / 200) * u * (Rabs (v i) + Rabs e)).
  { replace (z - (v i + e)) with ((z - (x i + y)) + ((x i - v i) + (y - e))) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_l, Rabs_triang|].
    clear - R1 X1 Y1 T Hx Hy V0 E0. set (a := Rabs (x i + y)) in *. rewrite u_val in *. lra. }
  pose proof (near_le _ _ _ Z) as ZB. pose proof (Rabs_triang (v i) e) as T2.
  rewrite Rabs_mult, (Rabs_pos_eq (w i)) in R2 by assumption.
  assert (P1 : w i * Rabs z <= w i * ((1 + 3 * u) * (Rabs (v i) + Rabs e))).
  { apply Rmult_le_compat_l; [assumption|]. clear - ZB T2 V0 E0. rewrite u_val in *. lra. }
  assert (P2 : w i * Rabs (z - (v i + e)) <= w i * ((2 + / 200) * u * (Rabs (v i) + Rabs e))) by (apply
    Rmult_le_compat_l; assumption).
  replace (part x y i - w i * (v i + e)) with ((part x y i - w i * z) + w i * (z - (v i + e))) by ring.
  eapply Rle_trans; [apply Rabs_triang|]. rewrite (Rabs_mult (w i)), (Rabs_pos_eq (w i)) by assumption.
  assert (m0 : 0 <= w i * (Rabs (v i) + Rabs e)) by (apply Rmult_le_pos; lra).
  set (m := w i * (Rabs (v i) + Rabs e)) in *. replace (w i * ((1 + 3 * u) * (Rabs (v i) + Rabs e))) with ((1 + 3 * u)
    * m)
    in P1 by (unfold m; ring). replace (w i * ((2 + / 200) * u * (Rabs (v i) + Rabs e))) with ((2 + / 200) * u * m) in
      P2
    by (unfold m; ring).
  clear - R2 P1 P2 m0. set (a := w i * Rabs z) in *. rewrite u_val in *. lra.
Qed.
Lemma axis_near : forall (x v : nat -> R) y e G, (forall i, F (x i)) -> F y -> (forall i, Rabs (x i - v i) <= u * Rabs
  (v
  i)) -> Rabs (y - e) <= u * Rabs e -> summed (part x y) G ->
  Rabs (G - sum4 (fun i => w i * (v i + e))) <= (6 + / 50) * u * sum4 (fun i => w i * (Rabs (v i) + Rabs e)) + 5 * t.
Proof.
  intros x v y e G Fx Fy Hx Hy HG. pose proof (part_near x v y e Fx Fy Hx Hy) as PN.
  assert (t0 : 0 < t) by apply bp_pos.
  set (m := sum4 (fun i => w i * (Rabs (v i) + Rabs e))).
  assert (m0 : 0 <= m).
  { unfold m, sum4. assert (Q : forall i, 0 <= w i * (Rabs (v i) + Rabs e)).
    { intro i. apply Rmult_le_pos; [apply Hw|]. pose proof (Rabs_pos (v i)). pose proof (Rabs_pos e). lra. }
    pose proof (Q 0%nat). pose proof (Q 1%nat). pose proof (Q 2%nat). pose proof (Q 3%nat). lra. }
  assert (N1 : Rabs (sum4 (part x y) - sum4 (fun i => w i * (v i + e))) <= (3 + / 100) * u * m + 4 * t).
  { eapply Rle_trans; [apply (sum4_near _ _ _ PN)|]. right. unfold m, sum4. ring. }
  assert (N2 : sum4 (fun i => Rabs (part x y i)) <= (1 + 4 * u) * m + 4 * t).
  { apply Rle_trans with (sum4 (fun i => (1 + 4 * u) * (w i * (Rabs (v i) + Rabs e)) + t)).
    - apply sum4_le. intro i. eapply Rle_trans; [apply (near_le _ _ _ (PN i))|].
      rewrite Rabs_mult, (Rabs_pos_eq (w i)) by apply Hw.
      assert (w i * Rabs (v i + e) <= w i * (Rabs (v i) + Rabs e)) by (apply Rmult_le_compat_l; [apply Hw | apply
        Rabs_triang]).
      assert (0 <= w i * (Rabs (v i) + Rabs e)) by (apply Rmult_le_pos; [apply Hw|]; pose proof (Rabs_pos (v i));
        pose proof (Rabs_pos e); lra).
      set (a := w i * (Rabs (v i) + Rabs e)) in *. clear - H H0. rewrite u_val in *. lra.
    - right. unfold m, sum4. ring. }
  unfold summed in HG. replace (G - sum4 (fun i => w i * (v i + e))) with ((G - sum4 (part x y)) + (sum4 (part x y) -
    sum4
    (fun i => w i * (v i + e)))) by ring. eapply Rle_trans; [apply Rabs_triang|].
  clear - HG N1 N2 m0 t0. set (a := sum4 (fun i => Rabs (part x y i))) in *. rewrite u_val in *. lra.
Qed.
(* The mean direction times the sum of shares. *)
Lemma pull_exact : S * norm g1 g2 g3 <= Rabs G1 + Rabs G2 + Rabs G3 + (11 + / 10) * u * S + (1 + / 1000) * (ratio * S).
Proof.
  destruct shares_near as (S0 & _ & TS & _). destruct ratio_pos as [R0 RE]. pose proof u_pos as U.
  assert (t0 : 0 < t) by apply bp_pos.
  set (Y v e := sum4 (fun i => w i * (v i + e))).
  assert (A1 := axis_near x1 v1 y1 e1 G1 Fx1 Fy1 Hx1 Hy1 H1). assert (A2 := axis_near x2 v2 y2 e2 G2 Fx2 Fy2 Hx2 Hy2
    H2).
  assert (A3 := axis_near x3 v3 y3 e3 G3 Fx3 Fy3 Hx3 Hy3 H3). change (Rabs (G1 - Y v1 e1) <= (6 + / 50) * u * sum4
    (fun i
    => w i * (Rabs (v1 i) + Rabs e1)) + 5 * t) in A1. change (Rabs (G2 - Y v2 e2) <= (6 + / 50) * u * sum4 (fun i
    => w i * (Rabs (v2 i) + Rabs e2)) + 5 * t) in A2. change (Rabs (G3 - Y v3 e3) <= (6 + / 50) * u * sum4 (fun i
    => w i * (Rabs (v3 i) + Rabs e3)) + 5 * t) in A3.
  (* the shares against the weights *)
  set (Z v e := sum4 (fun i => (share i / away i - w i) * (v i + e))).
  assert (Q : forall v e, sum4 (fun i => share i / S * ((v i + e) / away i)) * S = Y v e + Z v e).
  { intros v e. unfold Y, Z, sum4. pose proof (Haway 0%nat). pose proof (Haway 1%nat). pose proof (Haway 2%nat).
    pose proof (Haway 3%nat). field. repeat split; lra. }
  assert (NZ : norm (Z v1 e1) (Z v2 e2) (Z v3 e3) <= (5 + / 50) * u * S + 12 * t + ratio * ((1 + 2 * u) * S + 8 * t)).
  { unfold Z. eapply Rle_trans; [apply norm_sum4|]. apply Rle_trans with (sum4 (fun i => (5 + / 50) * u * share i + 3
      * t
      + ratio * ((1 + 2 * u) * share i + 2 * t))).
    - apply sum4_le. intro i. rewrite norm_scaled. fold (away i). pose proof (Haway i) as A0.
      assert (K : Rabs (share i / away i - w i) * away i = Rabs (share i - w i * away i)).
      { replace (share i - w i * away i) with ((share i / away i - w i) * away i) by (field; lra).
        rewrite Rabs_mult, (Rabs_pos_eq (away i)) by lra. reflexivity. }
      rewrite K. apply direction_near.
    - right. unfold S, sum4. ring. }
  assert (NY : norm (G1 - Y v1 e1) (G2 - Y v2 e2) (G3 - Y v3 e3) <= (6 + / 40) * u * (S + ratio * S) + 10 * t + ratio
    * t).
  { eapply Rle_trans; [apply (norm_monotone _ _ _ _ _ _ A1 A2 A3)|]. eapply Rle_trans; [apply norm_triangle|].
    rewrite norm_scaled, Rabs_pos_eq by lra.
    assert (N5 : norm (5 * t) (5 * t) (5 * t) <= 9 * t) by (eapply Rle_trans; [apply (norm_equal _ _ _ (5 * t)); try
      lra;
      rewrite Rabs_pos_eq; lra | lra]).
    assert (NS : norm (sum4 (fun i => w i * (Rabs (v1 i) + Rabs e1))) (sum4 (fun i => w i * (Rabs (v2 i) + Rabs e2)))
      (sum4 (fun i => w i * (Rabs (v3 i) + Rabs e3))) <= (1 + 8 * u) * S + 12 * t + ratio * ((1 + 2 * u) * S + 8 * t)).
    { eapply Rle_trans; [apply norm_sum4|]. apply Rle_trans with (sum4 (fun i => (1 + 8 * u) * share i + 3 * t + ratio *
        ((1 + 2 * u) * share i + 2 * t))).
      - apply sum4_le. intro i. rewrite norm_scaled, (Rabs_pos_eq (w i)) by apply Hw.
        destruct (weighted i) as (_ & L & M).
        apply Rle_trans with (w i * (len i + E)); [|lra]. apply Rmult_le_compat_l; [apply Hw|].
        eapply Rle_trans; [apply norm_triangle|]. rewrite !norm_abs. fold (len i) E. lra.
      - right. unfold S, sum4. ring. }
    set (n := norm (sum4 _) (sum4 _) (sum4 _)) in *. assert (rs : 0 <= ratio * S) by (apply Rmult_le_pos; lra).
    assert (rt : 0 <= ratio * t) by (apply Rmult_le_pos; lra).
    replace (ratio * ((1 + 2 * u) * S + 8 * t)) with ((1 + 2 * u) * (ratio * S) + 8 * (ratio * t)) in NS by ring.
    clear - NS N5 rs rt S0 t0 TS. set (a := ratio * S) in *. set (b := ratio * t) in *. clearbody n a b.
    rewrite u_val in *. lra. }
  assert (K : S * norm g1 g2 g3 <= norm G1 G2 G3 + norm (G1 - Y v1 e1) (G2 - Y v2 e2) (G3 - Y v3 e3) + norm (Z v1 e1)
    (Z v2
    e2) (Z v3 e3)).
  { rewrite <- (Rabs_pos_eq S) at 1 by lra. rewrite <- norm_scaled.
    replace (S * g1) with (Y v1 e1 + Z v1 e1) by (rewrite <- Q; unfold g1; ring).
    replace (S * g2) with (Y v2 e2 + Z v2 e2) by (rewrite <- Q; unfold g2; ring).
    replace (S * g3) with (Y v3 e3 + Z v3 e3) by (rewrite <- Q; unfold g3; ring).
    eapply Rle_trans; [apply norm_triangle|]. apply Rplus_le_compat_r.
    eapply Rle_trans; [apply (norm_difference _ _ _ G1 G2 G3)|]. apply Rplus_le_compat_l.
    rewrite <- norm_opp. right. f_equal; ring. }
  pose proof (norm_le_sum G1 G2 G3) as NG. assert (rs : 0 <= ratio * S) by (apply Rmult_le_pos; lra).
  assert (rt : ratio * t <= / 1000000 * (u * (ratio * S))).
  { replace (/ 1000000 * (u * (ratio * S))) with (ratio * (/ 1000000 * (u * S))) by ring.
    apply Rmult_le_compat_l; lra. }
  assert (rt0 : 0 <= ratio * t) by (apply Rmult_le_pos; lra).
  replace (ratio * ((1 + 2 * u) * S + 8 * t)) with ((1 + 2 * u) * (ratio * S) + 8 * (ratio * t)) in NZ by ring.
  clear - K NG NY NZ rs rt rt0 S0 t0 TS. set (a := ratio * S) in *. set (b := ratio * t) in *.
  set (n := norm G1 G2 G3) in *. rewrite u_val in *. lra.
Qed.
(* The pull is no less than the length of the mean direction: 5 u are left of it where it is small. *)
Theorem PULL_ERROR_holds : norm g1 g2 g3 <= (1 + / 1000) * pull /\ (pull <= / 1048576 -> norm g1 g2 g3 <= pull - 4 *
  u) /\
  0 < pull.
Proof.
  destruct shares_near as (S0 & TN & TS & TU). destruct ratio_pos as [R0 RE]. pose proof u_pos as U.
  assert (t0 : 0 < t) by apply bp_pos. pose proof pull_exact as X. set (g := norm g1 g2 g3) in *.
  pose proof (Hnear 0%nat) as N. pose proof (bp_pos (-500)) as B5.
  (* the three sums of axes *)
  assert (PL : Rabs G1 + Rabs G2 + Rabs G3 <= (1 + 3 * u) * P + 3 * t).
  { pose proof (RN_err (Rabs G1 + Rabs G2)) as E1. pose proof (RN_err (RN (Rabs G1 + Rabs G2) + Rabs G3)) as E2.
    change (RN (RN (Rabs G1 + Rabs G2) + Rabs G3)) with P in E2. fold t in E1, E2. pose proof (Rabs_pos G1).
    pose proof (Rabs_pos G2). pose proof (Rabs_pos G3). rewrite (Rabs_pos_eq (Rabs G1 + Rabs G2)) in E1 by lra.
    set (m := RN (Rabs G1 + Rabs G2)) in *. assert (m0 : 0 <= m) by (unfold m; rewrite <- RN_0; apply RN_le; lra).
    rewrite (Rabs_pos_eq (m + Rabs G3)) in E2 by lra. apply Rabs_le_inv in E1. apply Rabs_le_inv in E2.
    clear - E1 E2 H H0 H4 m0 t0. rewrite u_val in *. lra. }
  assert (P0 : 0 <= P).
  { unfold P. rewrite <- RN_0. apply RN_le. apply Rplus_le_le_0_compat; [|apply Rabs_pos]. rewrite <- RN_0. apply RN_le.
    pose proof (Rabs_pos G1). pose proof (Rabs_pos G2). lra. }
  set (q := P / total). assert (tp : 0 < total) by lra. assert (qt : q * total = P) by (unfold q; field; lra).
  assert (q0 : 0 <= q) by (unfold q; apply Rmult_le_pos; [assumption | apply Rlt_le, Rinv_0_lt_compat; lra]).
  assert (QS : P <= (1 + 4 * u) * (q * S)).
  { rewrite <- qt. replace ((1 + 4 * u) * (q * S)) with (q * ((1 + 4 * u) * S)) by ring. apply Rmult_le_compat_l;
      [assumption|]. apply Rabs_le_inv in TN. clear - TN S0. rewrite u_val in *. lra. }
  assert (gq : g <= (1 + 8 * u) * q + (11 + / 9) * u + (1 + / 1000) * ratio).
  { apply Rmult_le_reg_l with S; [assumption|]. eapply Rle_trans; [exact X|].
    replace (S * ((1 + 8 * u) * q + (11 + / 9) * u + (1 + / 1000) * ratio)) with ((1 + 8 * u) * (q * S) + (11 + / 9) *
      u * S
      + (1 + / 1000) * (ratio * S)) by ring. assert (0 <= q * S) by (apply Rmult_le_pos; lra).
    clear - PL QS H TS S0 t0. set (a := q * S) in *. set (b := ratio * S) in *. rewrite u_val in *. lra. }
  (* the roundings of the pull *)
  pose proof (RN_err q) as E1. fold t in E1. rewrite (Rabs_pos_eq q) in E1 by assumption.
  unfold pull. change (P / total) with q. set (r := RN q) in *.
  assert (r0 : 0 <= r) by (unfold r; rewrite <- RN_0; apply RN_le; assumption).
  unfold PULL_ERROR. pose proof (RN_err (r + 16 * u)) as E2. fold t in E2.
  rewrite (Rabs_pos_eq (r + 16 * u)) in E2 by lra.
  set (m := RN (r + 16 * u)) in *.
  assert (LR : 199 / 100 * ratio <= 2 * length / nearest).
  { apply Rmult_le_reg_r with nearest; [lra|]. replace (2 * length / nearest * nearest) with (2 * length) by (field;
      lra).
    replace (199 / 100 * ratio * nearest) with (199 / 100 * (ratio * nearest)) by ring. rewrite RE.
    assert (0 <= E) by apply norm_pos. clear - Hlength H. rewrite u_val in *. lra. }
  pose proof (RN_err (2 * length / nearest)) as E3. fold t in E3. rewrite (Rabs_pos_eq (2 * length / nearest)) in E3
    by lra.
  set (s := 2 * length / nearest) in *. set (k := RN s) in *.
  assert (m0 : 0 <= m) by (unfold m; rewrite <- RN_0; apply RN_le; lra).
  assert (k0 : 0 <= k) by (unfold k; rewrite <- RN_0; apply RN_le; lra).
  pose proof (RN_err (m + k)) as E4. fold t in E4. rewrite (Rabs_pos_eq (m + k)) in E4 by lra.
  set (n := RN (m + k)) in *.
  apply Rabs_le_inv in E1. apply Rabs_le_inv in E2. apply Rabs_le_inv in E3. apply Rabs_le_inv in E4.
  assert (L : g <= (1 + 13 * u) * n - (4 + / 2) * u).
  { clear - gq E1 E2 E3 E4 LR R0 q0 r0 t0 TU U. clearbody g q r m s k n t. rewrite u_val in *. lra. }
  assert (g0 : 0 <= g) by apply norm_pos.
  split; [|split; [intro Z|]].
  - clear - L g0 U. clearbody g n. rewrite u_val in *. lra.
  - clear - L g0 U Z. clearbody g n. rewrite u_val in *. lra.
  - clear - L g0 U. clearbody g n. rewrite u_val in *. lra.
Qed.
End Pull.
