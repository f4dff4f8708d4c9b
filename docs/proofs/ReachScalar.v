(* rt-geom, enclosing/certify.rs, `enclose_all`: a reach in the type of double-doubles. *)
From Proofs Require Import Rounding ErrorFree DoubleDouble Twice Norm Spacing Reach.
Open Scope R_scope.

Section Scalar.
(* the squared distance, its root and the reach, exactly; as computed, each high and low *)
Variables a1 a2 a3 b1 b2 b3 r sh sl wh wl zh zl : R.
Let S := (a1 - b1) * (a1 - b1) + (a2 - b2) * (a2 - b2) + (a3 - b3) * (a3 - b3).
Let root := sqrt S.
Let reach := root + r.
Let d a b := D a b 500.
Hypotheses (B1 : Rabs (a1 - b1) <= bp 500) (B2 : Rabs (a2 - b2) <= bp 500) (B3 : Rabs (a3 - b3) <= bp 500)
  (Hs : twice (tdot (d a1 b1) (d a2 b2) (d a3 b3) (d a1 b1) (d a2 b2) (d a3 b3)) (sh + sl))
  (Hw : Rabs (wh + wl - sqrt (sh + sl)) <= ROOT * (u * u) * sqrt (sh + sl))
  (Hz : Rabs (zh + zl - (wh + wl + r)) <= SUM * (u * u) * Rabs (wh + wl + r)) (Dz : dd zh zl) (Hr : 0 <= r)
  (HS : bp (-700) <= S).
Lemma square_near : Rabs (sh + sl - S) <= (21 + / 100) * (u * u) * S.
Proof.
  pose proof Hs as H. clear - H B1 B2 B3 HS. unfold d, tdot in H.
  assert (B : bounded (Add (Add (Mul (D a1 b1 500) (D a1 b1 500)) (Mul (D a2 b2 500) (D a2 b2 500))) (Mul (D a3 b3 500)
    (D a3 b3 500)))) by (cbn [bounded]; repeat split; assumption).
  pose proof (twice_error_at _ _ 21 _ H B eq_refl eq_refl ltac:(lia)) as E. cbn [exact size] in E.
  rewrite !abs_sq in E. fold S in E.
  eapply Rle_trans; [exact E|]. match goal with |- _ + bp ?k <= _ => assert (T : bp k <= / 1000 * (u * u * S)) end.
  { apply Rle_trans with (bp (-10 + (-53 + -53 + -700))); [apply bp_le; vm_compute; discriminate|]. rewrite !bp_add.
  fold u.
    pose proof u_pos. assert (U2 : 0 <= u * u) by (apply Rmult_le_pos; lra). pose proof (bp_pos (-700)).
    assert (u * u * bp (-700) <= u * u * S) by (apply Rmult_le_compat_l; lra).
    assert (bp (-10) <= / 1000) by (simpl; lra).
    pose proof (bp_pos (-10)). apply Rmult_le_compat; try lra. apply Rmult_le_pos; lra. }
  assert (0 <= u * u * S) by (apply Rmult_le_pos; [apply sq_pos | pose proof (bp_pos (-700)); lra]). lra.
Qed.
Lemma reach_near : Rabs (zh + zl - reach) <= 24 * (u * (u * reach)) /\ bp (-350) <= root /\ root <= reach.
Proof.
  pose proof square_near as E. pose proof u_pos as U. assert (S0 : 0 < S) by (pose proof (bp_pos (-700)); lra).
  set (X := sh + sl) in *. assert (U2 : 0 < u * u) by (apply Rmult_lt_0_compat; lra).
  assert (X0 : 0 < X) by (apply Rabs_le_inv in E; rewrite u_val in *; lra).
  set (y := sqrt X) in *. assert (yy : y * y = X) by (apply sqrt_sqrt; lra).
  assert (y0 : 0 < y) by now apply sqrt_lt_R0.
  assert (rr : root * root = S) by (apply sqrt_sqrt; lra). assert (r0 : 0 < root) by now apply sqrt_lt_R0.
  assert (RL : bp (-350) <= root) by (apply below_root; [lra | rewrite rr, bp_sq; exact HS]).
  assert (yr : 99 / 100 * root <= y).
  { apply below_root; [lra|]. rewrite yy. replace (99 / 100 * root * (99 / 100 * root)) with (9801 / 10000 * (root *
    root)) by field.
    rewrite rr. apply Rabs_le_inv in E. rewrite u_val in *. lra. }
  assert (Y : Rabs (y - root) <= (106 / 10) * (u * (u * root))).
  { apply Rmult_le_reg_r with (199 / 100 * root); [lra|].
    apply Rle_trans with (Rabs (y - root) * (y + root)); [apply Rmult_le_compat_l; [apply Rabs_pos | lra]|].
    rewrite <- (Rabs_pos_eq (y + root)) by lra. rewrite <- Rabs_mult.
    replace ((y - root) * (y + root)) with (X - S) by (rewrite <- yy, <- rr; ring). eapply Rle_trans; [exact E|].
    replace ((106 / 10) * (u * (u * root)) * (199 / 100 * root)) with ((106 / 10) * (199 / 100) * (u * u * (root *
      root))) by field.
    rewrite rr. assert (0 <= u * u * S) by (apply Rmult_le_pos; lra). lra. }
  assert (ur0 : 0 < u * (u * root)) by (apply Rmult_lt_0_compat; [lra|]; apply Rmult_lt_0_compat; lra).
  assert (W : Rabs (wh + wl - root) <= (167 / 10) * (u * (u * root))).
  { replace (wh + wl - root) with ((wh + wl - y) + (y - root)) by ring. eapply Rle_trans; [apply Rabs_triang|].
    assert (y <= (1 + / 1000) * root) by (pose proof (near_le _ _ _ Y) as N;
      rewrite (Rabs_pos_eq y), (Rabs_pos_eq root) in N by lra;
      rewrite u_val in *; lra).
    assert (u * u * y <= u * u * ((1 + / 1000) * root)) by (apply Rmult_le_compat_l; lra).
    replace (u * u * ((1 + / 1000) * root)) with ((1 + / 1000) * (u * (u * root))) in * by ring. unfold ROOT in Hw.
    lra. }
  assert (RM : root <= reach) by (unfold reach; lra). split; [|split; assumption].
  assert (UM : u * (u * root) <= u * (u * reach)) by (apply Rmult_le_compat_l; [lra|]; apply Rmult_le_compat_l; lra).
  set (z := u * (u * reach)) in *. assert (V : Rabs (wh + wl + r - reach) <= (167 / 10) * z).
  { replace (wh + wl + r - reach) with (wh + wl - root) by (unfold reach; ring). lra. }
  assert (N : Rabs (wh + wl + r) <= (1 + / 1000) * reach).
  { pose proof (near_le _ _ _ V) as N. rewrite (Rabs_pos_eq reach) in N by lra. unfold z in N. rewrite u_val in *.
  lra. }
  assert (SZ : SUM * (u * u) * Rabs (wh + wl + r) <= (6 + / 100) * z).
  { unfold SUM, z. replace ((6 + / 100) * (u * (u * reach))) with (u * u * ((6 + / 100) * reach)) by ring.
    replace (6 * (u * u) * Rabs (wh + wl + r)) with (u * u * (6 * Rabs (wh + wl + r))) by ring.
    apply Rmult_le_compat_l; lra. }
  replace (zh + zl - reach) with ((zh + zl - (wh + wl + r)) + (wh + wl + r - reach)) by ring.
  eapply Rle_trans; [apply Rabs_triang|]. assert (0 < z) by lra. lra.
Qed.
Let error := RN (zh * REACH_ERROR).
Theorem scalar_bracketed : zh + RN (zl - error) <= reach <= zh + RN (zl + error).
Proof.
  destruct reach_near as (E & R0 & RM). pose proof u_pos as U. pose proof (bp_pos (-350)) as P0.
  assert (M0 : 0 < reach) by lra.
  pose proof (dd_low _ _ Dz) as L. set (z := u * (u * reach)) in *.
  assert (ur : 0 < u * reach) by now apply Rmult_lt_0_compat.
  assert (z0 : 0 < z) by now apply Rmult_lt_0_compat.
  assert (zs : z <= / 1000000 * (u * reach)) by (apply Rmult_le_compat_r; [lra | rewrite u_val; lra]).
  assert (TZ : bp (-1075) <= / 1000000 * z).
  { apply Rle_trans with (bp (-40 + (-53 + (-53 + -350)))); [apply bp_le; lia|]. rewrite !bp_add. fold u.
    assert (u * (u * bp (-350)) <= z) by (unfold z; apply Rmult_le_compat_l; [lra|]; apply Rmult_le_compat_l; lra).
    assert (bp (-40) <= / 1000000) by (simpl; lra). pose proof (bp_pos (-40)).
    apply Rmult_le_compat; try lra. apply Rmult_le_pos; [lra|]. apply Rmult_le_pos; lra. }
  apply Rabs_le_inv in E. apply Rabs_le_inv in L as L'. unfold Rabs in L'. destruct (Rcase_abs zh) as [N|N].
  { exfalso. rewrite u_val in *. lra. }
  assert (Z : (1 - 3 * u) * reach <= zh <= (1 + 3 * u) * reach) by (rewrite u_val in *; lra).
  pose proof (RN_err (zh * REACH_ERROR)) as ER. fold error in ER. unfold REACH_ERROR in ER.
  replace (zh * (128 * u * u)) with (128 * (u * (u * zh))) in ER by ring.
  assert (US : (1 - 3 * u) * z <= u * (u * zh) <= (1 + 3 * u) * z).
  { unfold z. replace ((1 - 3 * u) * (u * (u * reach))) with (u * (u * ((1 - 3 * u) * reach))) by ring.
    replace ((1 + 3 * u) * (u * (u * reach))) with (u * (u * ((1 + 3 * u) * reach))) by ring.
    split; apply Rmult_le_compat_l; try lra; apply Rmult_le_compat_l; lra. }
  rewrite (Rabs_pos_eq (128 * (u * (u * zh)))) in ER by (rewrite u_val in *; lra). apply Rabs_le_inv in ER.
  assert (E0 : (128 - / 1000) * z <= error <= (128 + / 1000) * z) by (rewrite u_val in *; lra).
  rewrite (Rabs_pos_eq zh) in L by lra.
  assert (uz : u * zh <= (1 + / 1000) * (u * reach)) by (replace ((1 + / 1000) * (u * reach)) with (u * ((1
    + / 1000) * reach)) by ring;
    apply Rmult_le_compat_l; [lra|]; rewrite u_val in *; lra).
  assert (D1 : Rabs (zl - error) <= (1 + / 500) * (u * reach)).
  { unfold Rminus. eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp, (Rabs_pos_eq error) by lra. lra. }
  assert (D2 : Rabs (zl + error) <= (1 + / 500) * (u * reach)).
  { eapply Rle_trans; [apply Rabs_triang|]. rewrite (Rabs_pos_eq error) by lra. lra. }
  pose proof (rounding _ _ D1) as R2. pose proof (rounding _ _ D2) as R3.
  replace (u * ((1 + / 500) * (u * reach))) with ((1 + / 500) * z) in R2, R3 by (unfold z; ring).
  apply Rabs_le_inv in R2. apply Rabs_le_inv in R3. lra.
Qed.
End Scalar.
