(* rt-shade, texture.rs: lookups within bounds; figures, seen.rs and certify.rs: mixtures of colours and bytes. *)
From Proofs Require Import Rounding Steps.
Open Scope R_scope.

(* Roundings of a place in a texture, beside the error of the coordinate. *)
Definition PLACE_ROUNDING := 3 * u.
(* The bound of a bilinear lookup: the factor of the errors of both coordinates, roundings for each texel and more. *)
Definition BILINEAR_FACTOR := 101 / 100.
Definition BILINEAR_ROUNDINGS := 9.
(* A mixture of three colours: the factor of the error of the weights, and its roundings. *)
Definition MIXED_FACTOR := 41 / 10.
Definition MIXED_ROUNDING := 12 * u.
(* A byte: the factor of all, and roundings besides one for each colour. *)
Definition BYTE_FACTOR := 101 / 100.
Definition BYTE_ROUNDINGS := 4.

(* ---- The nearest texel: the exact place lies between the ends as computed. ---- *)
(* c is the coordinate within p of the exact C, in a texture of w texels; an end that rounds to more than w is not
  used *)
Theorem PLACE_ROUNDING_holds : forall c C p w, 0 <= c <= 1 -> 0 <= p <= / 3 -> 1 <= w <= bp 53 -> Rabs (c - C) <= p ->
  let x := RN (c * w) in let across := RN (RN (p + PLACE_ROUNDING) * w) in
  (RN (x + across) <= w -> C * w <= RN (x + across)) /\ (0 <= RN (x - across) -> RN (x - across) <= C * w).
Proof.
  intros c C p w Hc Hp Hw H x across. pose proof u_pos. unfold PLACE_ROUNDING in *. set (q := RN (p + 3 * u)) in *.
  assert (T : bp (-1075) <= / 1000000 * (u * u)).
  { apply Rle_trans with (bp (-20) * (u * u)); [unfold u; rewrite <- !bp_add; apply bp_le; lia | apply
    Rmult_le_compat_r; [apply sq_pos | simpl; lra]]. }
  pose proof (bp_pos (-1075)) as T0.
  assert (Eq : Rabs (q - (p + 3 * u)) <= u * (p + 3 * u) + bp (-1075)) by (pose proof (RN_err (p + 3 * u)) as E;
    rewrite (Rabs_pos_eq (p + 3 * u)) in E by lra; exact E).
  assert (q0 : 0 <= q) by (unfold q; rewrite <- RN_0; apply RN_le; lra).
  pose proof (RN_err (c * w)) as E1. fold x in E1. assert (cw : 0 <= c * w) by (apply Rmult_le_pos; lra). rewrite
    (Rabs_pos_eq (c * w)) in E1 by assumption.
  pose proof (RN_err (q * w)) as E2. fold across in E2. assert (qw : 0 <= q * w) by (apply Rmult_le_pos; lra). rewrite
    (Rabs_pos_eq (q * w)) in E2 by assumption.
  assert (cw1 : c * w <= w) by (rewrite <- (Rmult_1_l w) at 2; apply Rmult_le_compat_r; lra).
  assert (pw : 0 <= p * w) by (apply Rmult_le_pos; lra). assert (pw1 : p * w <= / 3 * w) by (apply Rmult_le_compat_r;
    lra).
  assert (QW : Rabs (q * w - (p + 3 * u) * w) <= u * (p * w) + 4 * (u * u) * w).
  { replace (q * w - (p + 3 * u) * w) with ((q - (p + 3 * u)) * w) by ring. rewrite Rabs_mult, (Rabs_pos_eq w) by lra.
    apply Rle_trans with ((u * p + 4 * (u * u)) * w); [apply Rmult_le_compat_r; [lra|] | lra]. eapply Rle_trans;
      [exact Eq|]. rewrite u_val in *. lra. }
  assert (TW : bp (-1075) <= / 1000000 * (u * u) * w).
  { eapply Rle_trans; [exact T|]. rewrite <- (Rmult_1_r (/ 1000000 * (u * u))) at 1. apply Rmult_le_compat_l; [rewrite
    u_val|]; lra. }
  assert (CW : Rabs (c * w - C * w) <= p * w).
  { replace (c * w - C * w) with ((c - C) * w) by ring. rewrite Rabs_mult, (Rabs_pos_eq w) by lra. apply
    Rmult_le_compat_r; lra. }
  apply Rabs_le_inv in E1. apply Rabs_le_inv in E2. apply Rabs_le_inv in QW. apply Rabs_le_inv in CW.
  split; intro L.
  - pose proof (RN_back (x + across)) as E3. set (z := RN (x + across)) in *.
    assert (x0 : 0 <= x) by (unfold x; rewrite <- RN_0; now apply RN_le). assert (a0 : 0 <= across) by (unfold across;
      rewrite <- RN_0; now apply RN_le).
    assert (z0 : 0 <= z) by (unfold z; rewrite <- RN_0; apply RN_le; lra).
    rewrite (Rabs_pos_eq z) in E3 by assumption. apply Rabs_le_inv in E3.
    set (a := c * w) in *. set (b := q * w) in *. set (d := p * w) in *. set (f := C * w) in *. replace ((p + 3 * u) *
      w) with (d + 3 * u * w) in QW by (unfold d; ring).
    clear - L E1 E2 E3 QW CW TW T0 cw1 pw pw1 Hw z0 cw. rewrite u_val in *. lra.
  - pose proof (RN_back (x - across)) as E3. set (z := RN (x - across)) in *. rewrite (Rabs_pos_eq z) in E3 by
    assumption. apply Rabs_le_inv in E3.
    set (a := c * w) in *. set (b := q * w) in *. set (d := p * w) in *. set (f := C * w) in *. replace ((p + 3 * u) *
      w) with (d + 3 * u * w) in QW by (unfold d; ring).
    clear - L E1 E2 E3 QW CW TW T0 cw1 pw pw1 Hw cw. rewrite u_val in *. lra.
Qed.

(* ---- Bilinear: a mixture changes by at most 1 from texel to texel, and is computed within 7 u at the rounded place.
  ---- *)
Section Bilinear.
Variable mixture : R -> R -> R.
Hypothesis Lipschitz : forall x y x' y', Rabs (mixture x y - mixture x' y') <= Rabs (x - x') + Rabs (y - y').
Theorem BILINEAR_FACTOR_holds : forall c C d D p q w h computed, 0 <= c <= 1 -> 0 <= d <= 1 -> Rabs (c - C) <= p ->
  Rabs (d - D) <= q ->
  1 <= w <= bp 40 -> 1 <= h <= bp 40 -> RN (w - / 2) = w - / 2 ->
  Rabs (computed - mixture (RN (RN (c * w) + (w - / 2))) (RN (RN (d * h) - / 2))) <= 7 * u ->
  Rabs (computed - mixture (C * w + (w - / 2)) (D * h - / 2)) <=
    (1 - 16 * u) * (BILINEAR_FACTOR * (w * p + h * q) + (3 * w + 3 * h + BILINEAR_ROUNDINGS) * u).
Proof.
  intros c C d D p q w h z Hc Hd Hp Hq Hw Hh Fw Hz. pose proof u_pos. pose proof (Rabs_pos (c - C)). pose proof
    (Rabs_pos (d - D)).
  pose proof (bp_pos (-1075)) as T0. assert (T : bp (-1075) <= / 1000 * (u * u)).
  { apply Rle_trans with (bp (-10) * (u * u)); [unfold u; rewrite <- !bp_add; apply bp_le; lia | apply
    Rmult_le_compat_r; [apply sq_pos | simpl; lra]]. }
  assert (P : forall s e k n, 0 <= s <= 1 -> 1 <= n -> 0 <= k <= n -> forall S, Rabs (s - S) <= e -> forall sg, sg = 1
    \/ sg = -1 ->
    Rabs (RN (RN (s * n) + sg * k) - (S * n + sg * k)) <= n * e + (2 + 8 * u) * u * n + u * k).
  { intros s e k n Hs Hn Hk S HS sg Hsg. pose proof (RN_err (s * n)) as E1. assert (sn : 0 <= s * n) by (apply
    Rmult_le_pos; lra).
    assert (sn1 : s * n <= n) by (rewrite <- (Rmult_1_l n) at 2; apply Rmult_le_compat_r; lra). rewrite (Rabs_pos_eq
      (s * n)) in E1 by assumption.
    pose proof (RN_err (RN (s * n) + sg * k)) as E2. set (m := RN (s * n)) in *. apply Rabs_le_inv in E1.
    assert (sk : Rabs (sg * k) <= k) by (rewrite Rabs_mult, (Rabs_pos_eq k) by lra; destruct Hsg as [G|G]; rewrite G;
      unfold Rabs; destruct Rcase_abs; lra).
    assert (mb : Rabs (m + sg * k) <= (1 + 2 * u) * n + k) by (apply Rabs_plus_le; [apply Rabs_le; rewrite u_val in *;
      lra | assumption]).
    assert (SN : Rabs (s * n - S * n) <= n * e).
    { replace (s * n - S * n) with ((s - S) * n) by ring. rewrite Rabs_mult, (Rabs_pos_eq n), Rmult_comm by lra. apply
      Rmult_le_compat_l; lra. }
    replace (RN (m + sg * k) - (S * n + sg * k)) with ((RN (m + sg * k) - (m + sg * k)) + (m - s * n) + (s * n - S *
      n)) by ring.
    assert (E1' : Rabs (m - s * n) <= u * (s * n) + bp (-1075)) by (apply Rabs_le; lra).
    eapply Rle_trans; [apply Rabs_plus_le; [apply Rabs_plus_le; [exact E2 | exact E1'] | exact SN]|].
    set (y := s * n) in *. set (v := n * e) in *. set (k9 := Rabs (m + sg * k)) in *. clear - mb sn1 T T0 Hn Hk.
      rewrite u_val in *. lra. }
  pose proof (P c p (w - / 2) w Hc ltac:(lra) ltac:(lra) C Hp 1 ltac:(now left)) as X. pose proof (P d q (/ 2) h Hd
    ltac:(lra) ltac:(lra) D Hq (-1) ltac:(now right)) as Y.
  rewrite Rmult_1_l in X. replace (RN (d * h) + -1 * / 2) with (RN (d * h) - / 2) in Y by ring. replace (D * h + -1 *
    / 2) with (D * h - / 2) in Y by ring.
  pose proof (Lipschitz (RN (RN (c * w) + (w - / 2))) (RN (RN (d * h) - / 2)) (C * w + (w - / 2)) (D * h - / 2)) as Li.
  set (x1 := RN (RN (c * w) + (w - / 2))) in *. set (y1 := RN (RN (d * h) - / 2)) in *. set (m1 := mixture x1 y1) in
    *. set (m2 := mixture (C * w + (w - / 2)) (D * h - / 2)) in *.
  replace (z - m2) with ((z - m1) + (m1 - m2)) by ring. eapply Rle_trans; [apply Rabs_plus_le; [exact Hz | exact
    Li]|]. unfold BILINEAR_FACTOR, BILINEAR_ROUNDINGS.
  assert (0 <= w * p) by (apply Rmult_le_pos; lra). assert (0 <= h * q) by (apply Rmult_le_pos; lra). set (a := w * p)
    in *. set (b := h * q) in *.
  replace (bp 40) with 1099511627776 in Hw, Hh by (simpl; lra).
  clear - X Y Hw Hh H2 H3. rewrite u_val in *. lra.
Qed.
Theorem BILINEAR_ROUNDINGS_holds : 7 + 2 <= BILINEAR_ROUNDINGS. Proof. unfold BILINEAR_ROUNDINGS. lra. Qed.
End Bilinear.

(* The mixture of four texels at a place, computed from samples of at most m: within 7 u of that of their colours. *)
Lemma RN_share : forall x, 0 <= x <= 1 -> Rabs (RN x - x) <= / 2 * u.
Proof.
  intros x [H0 H1]. pose proof u_pos. destruct (Req_dec x 0) as [Z|N].
  { rewrite Z, RN_0, Rminus_0_r, Rabs_R0. lra. }
  destruct (Rle_lt_or_eq_dec _ _ H1) as [L|E].
  - pose proof (error_le_half_ulp radix2 fexp even x) as P. change (round radix2 fexp (Znearest even) x) with (RN x)
      in P.
    eapply Rle_trans; [exact P|]. rewrite ulp_neq_0 by assumption.
    assert (mag radix2 x <= 0)%Z by (apply mag_le_bpow; [assumption | rewrite Rabs_pos_eq by lra; exact L]).
    apply Rmult_le_compat_l; [lra|]. apply bp_le. unfold cexp, fexp, FLT_exp. lia.
  - rewrite E, RN_id by (change 1 with (bp 0); apply F_bp; lia). replace (1 - 1) with 0 by ring. rewrite Rabs_R0. lra.
Qed.
Section Four.
Variable m : Z.
Hypothesis Hm : (1 <= m <= 65535)%Z.
Let n := IZR m.
Definition row x y s := RN (IZR x + RN (RN (IZR y - IZR x) * s)).
Definition mixed p q w := p + (q - p) * w.
Lemma mixed_between : forall p q w a b, a <= p <= b -> a <= q <= b -> 0 <= w <= 1 -> a <= mixed p q w <= b.
Proof.
  intros p q w a b P Q W. unfold mixed. replace (p + (q - p) * w) with (p * (1 - w) + q * w) by ring.
  assert (a * (1 - w) <= p * (1 - w) <= b * (1 - w)) by (split; apply Rmult_le_compat_r; lra).
  assert (a * w <= q * w <= b * w) by (split; apply Rmult_le_compat_r; lra). lra.
Qed.
Lemma mixed_near : forall p q p' q' w e, Rabs (p - p') <= e -> Rabs (q - q') <= e -> 0 <= w <= 1 ->
  Rabs (mixed p q w - mixed p' q' w) <= e.
Proof.
  intros p q p' q' w e P Q W. replace (mixed p q w - mixed p' q' w) with (mixed (p - p') (q - q') w) by (unfold mixed;
    ring). apply Rabs_le_inv in P. apply Rabs_le_inv in Q. apply Rabs_le. now apply mixed_between.
Qed.
Lemma n_range : 1 <= n <= 65535. Proof. unfold n. split; apply IZR_le; lia. Qed.
Lemma least_small : 0 < bp (-1075) <= / 1000000 * u.
Proof.
  split; [apply bp_pos|]. apply Rle_trans with (bp (-20) * u); [unfold u; rewrite <- !bp_add; apply bp_le; lia|].
  pose proof u_pos. apply Rmult_le_compat_r; simpl; lra.
Qed.
Lemma row_near : forall x y s, (0 <= x <= m)%Z -> (0 <= y <= m)%Z -> 0 <= s <= 1 ->
  Rabs (row x y s - mixed (IZR x) (IZR y) s) <= (2 + / 100) * (u * n) /\ 0 <= mixed (IZR x) (IZR y) s <= n.
Proof.
  intros x y s X Y W. destruct n_range as [N1 N2]. destruct least_small as [T0 T]. pose proof u_pos as U.
  assert (X1 : 0 <= IZR x <= n) by (unfold n; split; apply IZR_le; lia).
  assert (Y1 : 0 <= IZR y <= n) by (unfold n; split; apply IZR_le; lia).
  pose proof (mixed_between _ _ s _ _ X1 Y1 W) as B. split; [|exact B]. unfold row, mixed in *.
  assert (FD : F (IZR y - IZR x)).
  { rewrite <- minus_IZR. replace (IZR (y - x)) with (IZR (y - x) * bp 0) by (simpl; ring). apply F_scaled; lia. }
  rewrite (RN_id _ FD). set (d := (IZR y - IZR x) * s) in *. pose proof (RN_err d) as E1. set (p := RN d) in *.
  pose proof (RN_err (IZR x + p)) as E2. set (z := RN (IZR x + p)) in *.
  assert (D : Rabs d <= n).
  { unfold d. rewrite Rabs_mult, (Rabs_pos_eq s) by lra. assert (Rabs (IZR y - IZR x) <= n) by (apply Rabs_le; lra).
    pose proof (Rabs_pos (IZR y - IZR x)). apply Rle_trans with (n * 1); [apply Rmult_le_compat; lra | lra]. }
  assert (XP : Rabs (IZR x + p) <= n + Rabs (p - d)).
  { replace (IZR x + p) with ((IZR x + d) + (p - d)) by ring. eapply Rle_trans; [apply Rabs_triang|].
    rewrite (Rabs_pos_eq (IZR x + d)) by lra. lra. }
  replace (z - (IZR x + d)) with ((z - (IZR x + p)) + (p - d)) by ring. eapply Rle_trans; [apply Rabs_triang|].
  clear - E1 E2 D XP N1 T0 T. set (a := Rabs (p - d)) in *. rewrite u_val in *. lra.
Qed.
Theorem four_texels : forall a b c d s r, (0 <= a <= m)%Z -> (0 <= b <= m)%Z -> (0 <= c <= m)%Z -> (0 <= d <= m)%Z ->
  0 <= s <= 1 -> 0 <= r <= 1 -> let color x := RN (IZR x / n) in
  let upper := row a b s in let lower := row c d s in
  Rabs (RN (RN (upper + RN (RN (lower - upper) * r)) / n) -
    mixed (mixed (color a) (color b) s) (mixed (color c) (color d) s) r) <= 7 * u.
Proof.
  intros a b c d s r Ha Hb Hc Hd Hs Hr color upper lower. destruct n_range as [N1 N2]. destruct least_small as [T0 T].
  pose proof u_pos as U. destruct (row_near a b s Ha Hb Hs) as [P1 B1]. destruct (row_near c d s Hc Hd Hs) as [P2 B2].
  fold upper in P1. fold lower in P2. set (A := mixed (IZR a) (IZR b) s) in *. set (C := mixed (IZR c) (IZR d) s) in *.
  pose proof (mixed_between _ _ r _ _ B1 B2 Hr) as B3. set (M := mixed A C r) in *.
  assert (nn : n * / n = 1) by (field; lra). assert (i0 : 0 < / n) by (apply Rinv_0_lt_compat; lra).
  (* the colours *)
  assert (K : forall x, (0 <= x <= m)%Z -> Rabs (color x - IZR x * / n) <= / 2 * u).
  { intros x Hx. apply RN_share. assert (0 <= IZR x <= n) by (unfold n; split; apply IZR_le; lia). split.
    - apply Rmult_le_pos; lra.
    - rewrite <- nn. apply Rmult_le_compat_r; lra. }
  assert (KM : Rabs (mixed (mixed (color a) (color b) s) (mixed (color c) (color d) s) r - M * / n) <= / 2 * u).
  { replace (M * / n) with (mixed (mixed (IZR a * / n) (IZR b * / n) s) (mixed (IZR c * / n) (IZR d * / n) s) r) by
      (unfold M, A, C, mixed; ring). apply mixed_near; [| |assumption]; apply mixed_near; auto. }
  (* as computed *)
  assert (FU : F upper) by apply RN_F. assert (FL : F lower) by apply RN_F.
  pose proof (RN_diff lower upper FL FU) as E1. set (e := RN (lower - upper)) in *.
  pose proof (RN_err (e * r)) as E2. set (p := RN (e * r)) in *. pose proof (RN_err (upper + p)) as E3.
  set (v := RN (upper + p)) in *.
  assert (LU : Rabs (lower - upper) <= n + 5 * (u * n)).
  { apply Rabs_le_inv in P1. apply Rabs_le_inv in P2. apply Rabs_le. clear - P1 P2 B1 B2 N1. rewrite u_val in *. lra. }
  assert (ER : Rabs ((e - (lower - upper)) * r) <= (1 + / 1000) * (u * n)).
  { rewrite Rabs_mult, (Rabs_pos_eq r) by lra. apply Rle_trans with (Rabs (e - (lower - upper)) * 1);
      [apply Rmult_le_compat_l; [apply Rabs_pos | lra]|]. clear - E1 LU N1. set (x := Rabs (lower - upper)) in *.
    rewrite u_val in *. lra. }
  assert (EB : Rabs (e * r) <= (1 + / 1000) * n).
  { rewrite Rabs_mult, (Rabs_pos_eq r) by lra. apply Rle_trans with (Rabs e * 1);
      [apply Rmult_le_compat_l; [apply Rabs_pos | lra]|].
    replace e with ((e - (lower - upper)) + (lower - upper)) by ring. rewrite Rmult_1_r.
    eapply Rle_trans; [apply Rabs_triang|]. clear - E1 LU N1. set (x := Rabs (lower - upper)) in *.
    rewrite u_val in *. lra. }
  assert (MM : Rabs (mixed upper lower r - M) <= (2 + / 100) * (u * n)) by (apply mixed_near; assumption).
  assert (UP : Rabs (upper + p - M) <= (4 + / 50) * (u * n)).
  { replace (upper + p - M) with ((mixed upper lower r - M) + (e - (lower - upper)) * r + (p - e * r)) by (unfold mixed;
      ring). eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
    clear - E2 ER EB MM N1 T0 T. set (x := Rabs (e * r)) in *. rewrite u_val in *. lra. }
  assert (UB : Rabs (upper + p) <= (1 + / 1000) * n).
  { replace (upper + p) with ((upper + p - M) + M) by ring. eapply Rle_trans; [apply Rabs_triang|].
    rewrite (Rabs_pos_eq M) by lra. clear - UP B3 N1. rewrite u_val in *. lra. }
  assert (V : Rabs (v - M) <= (5 + / 25) * (u * n)).
  { replace (v - M) with ((v - (upper + p)) + (upper + p - M)) by ring. eapply Rle_trans; [apply Rabs_triang|].
    clear - E3 UP UB N1 T0 T. set (x := Rabs (upper + p)) in *. rewrite u_val in *. lra. }
  assert (VN : Rabs (v / n - M * / n) <= (5 + / 25) * u).
  { replace (v / n - M * / n) with ((v - M) * / n) by (field; lra). rewrite Rabs_mult, (Rabs_pos_eq (/ n)) by lra.
    replace ((5 + / 25) * u) with ((5 + / 25) * (u * n) * / n) by (field; lra). apply Rmult_le_compat_r; lra. }
  pose proof (RN_err (v / n)) as E4. set (z := RN (v / n)) in *.
  assert (MN : 0 <= M * / n <= 1) by (split; [apply Rmult_le_pos; lra | rewrite <- nn; apply Rmult_le_compat_r; lra]).
  set (k := M * / n) in *. set (q := v / n) in *.
  assert (QB : Rabs q <= 1 + / 1000).
  { replace q with ((q - k) + k) by ring. eapply Rle_trans; [apply Rabs_triang|]. rewrite (Rabs_pos_eq k) by lra.
    clear - VN MN. rewrite u_val in *. lra. }
  set (f := mixed (mixed _ _ _) _ _) in *.
  replace (z - f) with ((z - q) + (q - k) - (f - k)) by ring. unfold Rminus at 1.
  eapply Rle_trans; [apply Rabs_triang|].
  rewrite Rabs_Ropp. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
  clear - E4 QB VN KM T0 T. set (x := Rabs q) in *. rewrite u_val in *. lra.
Qed.
End Four.

(* ---- A mixture of three colours by weights within e, the first within 2 e + 2 u ---- *)
Definition tmixed (w1 w2 w3 c1 c2 c3 : R) := tdot (X w1 10) (X w2 10) (X w3 10) (X c1 10) (X c2 10) (X c3 10).
Theorem MIXED_FACTOR_holds : forall w1 w2 w3 W1 W2 W3 c1 c2 c3 e b m bound, W1 + W2 + W3 = 1 -> 0 <= W1 -> 0 <= W2 ->
  0 <= W3 ->
  Rabs (w1 - W1) <= 2 * e + 2 * u -> Rabs (w2 - W2) <= e -> Rabs (w3 - W3) <= e -> e <= 1 -> 0 <= c1 <= b -> 0 <= c2
    <= b -> 0 <= c3 <= b -> b <= 1 ->
  plain (tmixed w1 w2 w3 c1 c2 c3) m -> (1 - 8 * u) * ((MIXED_FACTOR * e + MIXED_ROUNDING) * b + bp (-1022)) <= bound ->
  Rabs (m - (W1 * c1 + W2 * c2 + W3 * c3)) <= bound.
Proof.
  intros w1 w2 w3 W1 W2 W3 c1 c2 c3 e b m bound SW P1 P2 P3 H1 H2 H3 E C1 C2 C3 B Hm Hb. pose proof u_pos. pose proof
    (Rabs_pos (w2 - W2)).
  assert (bp10 : bp 10 = 1024) by (simpl; lra).
  assert (A1 : Rabs w1 <= W1 + 2 * e + 2 * u) by (replace w1 with ((w1 - W1) + W1) by ring; eapply Rle_trans; [apply
    Rabs_triang|]; rewrite (Rabs_pos_eq W1) by lra; lra).
  assert (A2 : Rabs w2 <= W2 + e) by (replace w2 with ((w2 - W2) + W2) by ring; eapply Rle_trans; [apply
    Rabs_triang|]; rewrite (Rabs_pos_eq W2) by lra; lra).
  assert (A3 : Rabs w3 <= W3 + e) by (replace w3 with ((w3 - W3) + W3) by ring; eapply Rle_trans; [apply
    Rabs_triang|]; rewrite (Rabs_pos_eq W3) by lra; lra).
  assert (Bd : bounded (tmixed w1 w2 w3 c1 c2 c3)) by (unfold tmixed, tdot; cbn [bounded]; rewrite bp10, ?(Rabs_pos_eq
    c1), ?(Rabs_pos_eq c2), ?(Rabs_pos_eq c3) by lra;
    rewrite u_val in *; repeat split; lra).
  pose proof (plain_error_at _ _ 3 (low (tmixed w1 w2 w3 c1 c2 c3)) Hm Bd eq_refl eq_refl ltac:(lia)) as Q.
  assert (LT : bp (low (tmixed w1 w2 w3 c1 c2 c3)) <= / 1000 * bp (-1022)).
  { apply Rle_trans with (bp (-10) * bp (-1022)); [rewrite <- bp_add; apply bp_le; vm_compute; discriminate | apply
    Rmult_le_compat_r; [apply Rlt_le, bp_pos | simpl; lra]]. }
  set (t0 := bp (low _)) in *. clearbody t0. unfold tmixed, tdot in Q. cbn [exact size] in Q. rewrite (Rabs_pos_eq
    c1), (Rabs_pos_eq c2), (Rabs_pos_eq c3) in Q by lra.
  assert (K : forall x y c, Rabs (x - y) <= c -> forall k, 0 <= k <= b -> Rabs (x * k - y * k) <= c * b).
  { intros x y c Hc k Hk. replace (x * k - y * k) with ((x - y) * k) by ring. rewrite Rabs_mult, (Rabs_pos_eq k) by
    lra. pose proof (Rabs_pos (x - y)). apply Rmult_le_compat; lra. }
  pose proof (K w1 W1 _ H1 c1 C1) as K1. pose proof (K w2 W2 _ H2 c2 C2) as K2. pose proof (K w3 W3 _ H3 c3 C3) as K3.
  assert (S1 : Rabs w1 * c1 <= (W1 + 2 * e + 2 * u) * b) by (apply Rmult_le_compat; try apply Rabs_pos; lra).
  assert (S2 : Rabs w2 * c2 <= (W2 + e) * b) by (apply Rmult_le_compat; try apply Rabs_pos; lra).
  assert (S3 : Rabs w3 * c3 <= (W3 + e) * b) by (apply Rmult_le_compat; try apply Rabs_pos; lra).
  assert (S : Rabs w1 * c1 + Rabs w2 * c2 + Rabs w3 * c3 <= b + (4 * e + 2 * u) * b).
  { replace (b + (4 * e + 2 * u) * b) with ((W1 + W2 + W3) * b + (4 * e + 2 * u) * b) by (rewrite SW; ring). lra. }
  replace (m - (W1 * c1 + W2 * c2 + W3 * c3)) with ((m - (w1 * c1 + w2 * c2 + w3 * c3)) + (w1 * c1 - W1 * c1) + (w2 *
    c2 - W2 * c2) + (w3 * c3 - W3 * c3)) by ring.
  eapply Rle_trans; [apply Rabs_plus_le; [apply Rabs_plus_le; [apply Rabs_plus_le; [exact Q | exact K1] | exact K2] |
    exact K3]|]. unfold MIXED_FACTOR, MIXED_ROUNDING in Hb.
  assert (b0 : 0 <= b) by lra. assert (eb : 0 <= e * b) by (apply Rmult_le_pos; lra). pose proof (bp_pos (-1022)) as T0.
  replace ((2 * e + 2 * u) * b) with (2 * (e * b) + 2 * u * b) by ring. replace (b + (4 * e + 2 * u) * b) with (b + 4
    * (e * b) + 2 * u * b) in S by ring.
  replace ((41 / 10 * e + 12 * u) * b) with (41 / 10 * (e * b) + 12 * u * b) in Hb by ring.
  set (x := Rabs w1 * c1 + Rabs w2 * c2 + Rabs w3 * c3) in *. set (y := e * b) in *. clear - Hb S LT T0 b0 eb. rewrite
    u_val in *. lra.
Qed.
Theorem MIXED_ROUNDING_holds : 2 * u + (3 + / 1000) * u * (1 + 2 * u) <= (1 - 8 * u) * MIXED_ROUNDING.
Proof. unfold MIXED_ROUNDING. rewrite u_val. lra. Qed.

(* ---- Bytes ---- *)
Lemma RN_below_two : forall x, Rabs x <= 2 -> Rabs (RN x - x) <= u.
Proof.
  intros x H. destruct (Req_dec x 0) as [Z|N].
  { rewrite Z, RN_0. replace (0 - 0) with 0 by ring. rewrite Rabs_R0. apply Rlt_le, u_pos. }
  destruct (Rle_lt_or_eq_dec _ _ H) as [L|E].
  - pose proof (error_le_half_ulp radix2 fexp even x) as P. change (round radix2 fexp (Znearest even) x) with (RN x)
    in P.
    eapply Rle_trans; [exact P|]. rewrite ulp_neq_0 by assumption.
    assert (mag radix2 x <= 1)%Z by (apply mag_le_bpow; [assumption | rewrite bp_1; exact L]).
    apply Rle_trans with (/ 2 * bp (1 + -53)); [apply Rmult_le_compat_l; [lra|]; apply bp_le; unfold cexp, fexp,
      FLT_exp; lia|].
    rewrite bp_add, bp_1. fold u. lra.
  - assert (F2 : F 2) by (rewrite <- bp_1; apply F_bp; lia).
    replace (RN x) with x; [replace (x - x) with 0 by ring; rewrite Rabs_R0; apply Rlt_le, u_pos|]. symmetry. apply
      RN_id.
    unfold Rabs in E. destruct (Rcase_abs x); [replace x with (- 2) by lra; now apply F_opp | rewrite E; exact F2].
Qed.
(* s the sum of n colours as computed, at most n, S the exact one; m the largest sample, a whole number *)
Theorem BYTE_FACTOR_holds : forall s S n e m slack, 1 <= n <= bp 40 -> 0 <= s <= n -> Rabs (s - S) <= e + (n - 1) * (n
  * u) ->
  m = 1 \/ 2 <= m -> m <= bp 20 -> 0 <= e -> (1 - 8 * u) * (BYTE_FACTOR * m * (e / n + (n + BYTE_ROUNDINGS) * u)) <=
    slack -> slack < / 4 ->
  let x := RN (RN (m * RN (s / n)) + / 2) in RN (x - slack) <= m * S / n + / 2 <= RN (x + slack).
Proof.
  intros s S n e m slack Hn Hs HS Hm M2 E0 Hsl Small x. pose proof u_pos. assert (bp20 : bp 20 = 1048576) by (simpl;
    lra).
  assert (T : bp (-1075) <= / 1000000 * u).
  { apply Rle_trans with (bp (-20) * u); [unfold u; rewrite <- !bp_add; apply bp_le; lia | apply Rmult_le_compat_r;
    [lra | simpl; lra]]. }
  assert (m1 : 1 <= m) by lra. assert (q0 : 0 <= s / n) by (apply Rmult_le_pos; [lra | apply Rlt_le, Rinv_0_lt_compat;
    lra]).
  assert (q1 : s / n <= 1) by (apply Rmult_le_reg_r with n; [lra|]; replace (s / n * n) with s by (field; lra); lra).
  pose proof (RN_err (s / n)) as E1. rewrite (Rabs_pos_eq (s / n)) in E1 by assumption. set (q := RN (s / n)) in *.
  assert (Q0 : 0 <= q) by (unfold q; rewrite <- RN_0; now apply RN_le).
  assert (Q1 : q <= 1) by (unfold q; replace 1 with (RN 1) by (apply RN_id; change 1 with (bp 0); apply F_bp; lia);
    now apply RN_le).
  assert (mq : 0 <= m * q <= m) by (split; [apply Rmult_le_pos; lra | rewrite <- (Rmult_1_r m) at 2; apply
    Rmult_le_compat_l; lra]).
  pose proof (RN_err (m * q)) as E2. rewrite (Rabs_pos_eq (m * q)) in E2 by lra. set (p := RN (m * q)) in *.
  assert (P0 : 0 <= p) by (unfold p; rewrite <- RN_0; now apply RN_le). apply Rabs_le_inv in E1. apply Rabs_le_inv in
    E2.
  assert (um : u * m <= / 1000000) by (rewrite u_val; lra).
  assert (p1 : p <= m + / 100000) by (rewrite u_val in *; lra).
  assert (sl0 : 0 <= slack).
  { assert (0 <= e / n) by (apply Rmult_le_pos; [assumption | apply Rlt_le, Rinv_0_lt_compat; lra]).
    assert (0 <= BYTE_FACTOR * m * (e / n + (n + BYTE_ROUNDINGS) * u)) by (unfold BYTE_FACTOR, BYTE_ROUNDINGS; apply
      Rmult_le_pos; [lra|];
      apply Rplus_le_le_0_compat; [assumption | apply Rmult_le_pos; lra]). rewrite u_val in *. lra. }
  (* the last roundings: 3/2 u m each *)
  assert (R : forall y, Rabs y <= m + 7 / 8 -> Rabs (RN y - y) <= 3 / 2 * u * m + bp (-1075)).
  { intros y Hy. pose proof (bp_pos (-1075)). destruct Hm as [Hm|Hm].
    - pose proof (RN_below_two y ltac:(lra)). rewrite Hm. lra.
    - pose proof (RN_err y). assert (u * Rabs y <= u * (3 / 2 * m)) by (apply Rmult_le_compat_l; lra). lra. }
  pose proof (R (p + / 2) ltac:(rewrite Rabs_pos_eq by lra; lra)) as E3. fold x in E3. apply Rabs_le_inv in E3.
  assert (x1 : 0 <= x <= m + / 2 + / 10000) by (split; [unfold x; rewrite <- RN_0; apply RN_le; lra | rewrite u_val in
    *; lra]).
  pose proof (R (x - slack) ltac:(apply Rabs_le; lra)) as E4. pose proof (R (x + slack) ltac:(apply Rabs_le; lra)) as
    E5. apply Rabs_le_inv in E4. apply Rabs_le_inv in E5.
  (* the exact value *)
  assert (V : Rabs (m * (s / n) - m * S / n) <= m * (e / n) + m * ((n - 1) * u)).
  { replace (m * (s / n) - m * S / n) with (m * ((s - S) / n)) by (field; lra). rewrite Rabs_mult, (Rabs_pos_eq m) by
    lra. rewrite <- Rmult_plus_distr_l.
    apply Rmult_le_compat_l; [lra|]. apply Rabs_div_le; [lra|]. rewrite (Rabs_pos_eq n) by lra.
    replace ((e / n + (n - 1) * u) * n) with (e + (n - 1) * (n * u)) by (field; lra). exact HS. }
  apply Rabs_le_inv in V.
  assert (W : Rabs (m * q - m * (s / n)) <= u * m + m * bp (-1075)).
  { replace (m * q - m * (s / n)) with (m * (q - s / n)) by ring. rewrite Rabs_mult, (Rabs_pos_eq m) by lra. replace
    (u * m + m * bp (-1075)) with (m * (u + bp (-1075))) by ring.
    apply Rmult_le_compat_l; [lra|]. apply Rabs_le. assert (u * (s / n) <= u * 1) by (apply Rmult_le_compat_l; lra).
      lra. }
  apply Rabs_le_inv in W. assert (mT : m * bp (-1075) <= / 1000000 * (u * m)) by (replace (/ 1000000 * (u * m)) with
    (m * (/ 1000000 * u)) by ring; apply Rmult_le_compat_l; lra).
  assert (u * (m * q) <= u * m) by (apply Rmult_le_compat_l; lra).
  unfold BYTE_FACTOR, BYTE_ROUNDINGS in Hsl.
  replace (101 / 100 * m * (e / n + (n + 4) * u)) with (101 / 100 * (m * (e / n) + m * ((n - 1) * u) + 5 * (u * m)))
    in Hsl by ring.
  assert (k1 : 0 <= m * (e / n)) by (apply Rmult_le_pos; [lra | apply Rmult_le_pos; [assumption | apply Rlt_le,
    Rinv_0_lt_compat; lra]]).
  assert (k2 : 0 <= m * ((n - 1) * u)) by (apply Rmult_le_pos; [lra | apply Rmult_le_pos; lra]).
  set (a := m * (e / n)) in *. set (b := m * ((n - 1) * u)) in *. set (c := u * m) in *. set (d := m * (s / n)) in *.
    set (f := m * S / n) in *.
  assert (c0 : u <= c) by (unfold c; rewrite <- (Rmult_1_r u) at 1; apply Rmult_le_compat_l; lra).
  replace (3 / 2 * u * m) with (3 / 2 * c) in * by (unfold c; ring). set (g := m * q) in *. set (h := u * g) in *. set
    (t := m * bp (-1075)) in *. set (t9 := bp (-1075)) in *.
  clear - E2 E3 E4 E5 V W Hsl mT H0 k1 k2 c0 T H. rewrite u_val in Hsl. split; lra.
Qed.
Theorem BYTE_ROUNDINGS_holds : 1 + 1 + 3 / 2 + 3 / 2 <= 1 + BYTE_ROUNDINGS. Proof. unfold BYTE_ROUNDINGS. lra. Qed.
