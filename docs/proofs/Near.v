(* rt-geom, enclosing/mod.rs, `near`, and pivot.rs, `measure`: who need not be looked at. *)
From Proofs Require Import Rounding Norm Reach.
Open Scope R_scope.

(* What is taken from the limit, relative to the radius. *)
Definition NEAR_ERROR := 64 * u.

(* A difference and what is left of it less another, as a vector. *)
Lemma F_negative : forall x y, F x -> F y -> RN (x - y) < 0 -> x < y.
Proof. intros x y Fx Fy H. apply Rnot_le_lt. intro L. assert (0 <= RN (x - y)) by (rewrite <- RN_0; apply RN_le; lra).
lra. Qed.
Lemma offset : forall b o x, F b -> F o -> F x -> let p := RN (b - o) in
  Rabs (RN (p - x) - (b - o - x)) <= u * Rabs (b - o)
    + u * Rabs (p - x) /\ Rabs (p - x - (b - o - x)) <= u * Rabs (b - o).
Proof.
  intros b o x Fb Fo Fx p. pose proof (RN_diff b o Fb Fo) as E1. fold p in E1.
  pose proof (RN_diff p x (RN_F _) Fx) as E2.
  assert (E : Rabs (p - x - (b - o - x)) <= u * Rabs (b - o)) by (replace (p - x - (b - o - x)) with (p - (b - o)) by
    ring; exact E1).
  split; [|assumption]. replace (RN (p - x) - (b - o - x)) with ((RN (p - x) - (p - x))
    + (p - x - (b - o - x))) by ring.
  eapply Rle_trans; [apply Rabs_triang|]. lra.
Qed.
(* ... it is shorter than what was computed by the rounding of both. *)
Lemma offsets : forall b1 b2 b3 o1 o2 o3 x1 x2 x3,
  F b1 -> F b2 -> F b3 -> F o1 -> F o2 -> F o3 -> F x1 -> F x2 -> F x3 ->
  norm (b1 - o1 - x1) (b2 - o2 - x2) (b3 - o3 - x3) <=
    (1 + 3 * u) * norm (RN (RN (b1 - o1) - x1)) (RN (RN (b2 - o2) - x2)) (RN (RN (b3 - o3) - x3)) +
    (1 + / 100) * u * norm x1 x2 x3.
Proof.
  intros b1 b2 b3 o1 o2 o3 x1 x2 x3 B1 B2 B3 O1 O2 O3 X1 X2 X3. pose proof u_pos as U.
  destruct (offset b1 o1 x1 B1 O1 X1) as [E1 G1]. destruct (offset b2 o2 x2 B2 O2 X2) as [E2 G2].
  destruct (offset b3 o3 x3 B3 O3 X3) as [E3 G3].
  set (p1 := RN (b1 - o1)) in *. set (p2 := RN (b2 - o2)) in *. set (p3 := RN (b3 - o3)) in *.
  set (D := norm (b1 - o1 - x1) (b2 - o2 - x2) (b3 - o3 - x3)) in *.
  set (d1 := RN (p1 - x1)) in *. set (d2 := RN (p2 - x2)) in *. set (d3 := RN (p3 - x3)) in *.
  assert (P : norm (b1 - o1) (b2 - o2) (b3 - o3) <= D + norm x1 x2 x3).
  { replace (norm (b1 - o1) (b2 - o2) (b3 - o3)) with (norm (b1 - o1 - x1 + x1) (b2 - o2 - x2 + x2) (b3 - o3 - x3
    + x3)) by
      (f_equal; ring). apply norm_triangle. }
  assert (Q : norm (p1 - x1) (p2 - x2) (p3 - x3) <= D + u * norm (b1 - o1) (b2 - o2) (b3 - o3)).
  { eapply Rle_trans; [apply (norm_difference _ _ _ (b1 - o1 - x1) (b2 - o2 - x2) (b3 - o3 - x3))|]. fold D.
    apply Rplus_le_compat_l. apply norm_relative; try assumption. lra. }
  pose proof (norm_difference (b1 - o1 - x1) (b2 - o2 - x2) (b3 - o3 - x3) d1 d2 d3) as T. fold D in T.
  assert (K : norm (b1 - o1 - x1 - d1) (b2 - o2 - x2 - d2) (b3 - o3 - x3 - d3) <= u * norm (b1 - o1) (b2 - o2) (b3 -
    o3) +
    u * norm (p1 - x1) (p2 - x2) (p3 - x3)).
  { rewrite <- norm_opp. replace (- (b1 - o1 - x1 - d1)) with (d1 - (b1 - o1 - x1)) by ring.
    replace (- (b2 - o2 - x2 - d2)) with (d2 - (b2 - o2 - x2)) by ring.
    replace (- (b3 - o3 - x3 - d3)) with (d3 - (b3 - o3 - x3)) by ring.
    eapply Rle_trans; [eapply norm_monotone; eassumption|]. eapply Rle_trans; [apply norm_triangle|].
    rewrite !norm_scaled, !norm_abs, !(Rabs_pos_eq u) by lra. lra. }
  pose proof (norm_pos x1 x2 x3). pose proof (norm_pos d1 d2 d3). assert (0 <= D) by apply norm_pos.
  rewrite u_val in *. lra.
Qed.

(* A sphere (b, r) whose measure is negative: computed offsets shorter than the room,
  and so its reach from x less than the
   limit, but for roundings. *)
Definition squares d1 d2 d3 := RN (RN (RN (d1 * d1) + RN (d2 * d2)) + RN (d3 * d3)).
Lemma squares_plain : forall d1 d2 d3 q, plain (tdot (X d1 q) (X d2 q) (X d3 q) (X d1 q) (X d2 q) (X d3 q)) (squares
  d1 d2 d3).
Proof. intros. unfold tdot, squares. apply plain_Add; [apply plain_Add|]; apply plain_Mul; apply CX. Qed.
Lemma squares_pos : forall d1 d2 d3, 0 <= squares d1 d2 d3.
Proof.
  intros. unfold squares. assert (P : forall d, 0 <= RN (d * d)) by (intro; rewrite <- RN_0; apply RN_le, sq_pos).
  pose proof (P d1). pose proof (P d2). pose proof (P d3). rewrite <- RN_0. apply RN_le.
  assert (0 <= RN (RN (d1 * d1) + RN (d2 * d2))) by (rewrite <- RN_0; apply RN_le; lra). lra.
Qed.
Lemma measured : forall d1 d2 d3 limit r,
  Rabs d1 <= bp 1023 -> Rabs d2 <= bp 1023 -> Rabs d3 <= bp 1023 -> F limit -> F r ->
  0 <= r -> let room := RN (limit - r) in RN (squares d1 d2 d3 - RN (room * Rabs room)) < 0 ->
  norm d1 d2 d3 + r <= limit + 4 * u * limit + bp (-525).
Proof.
  intros d1 d2 d3 limit r B1 B2 B3 Fl Fr Hr room H. pose proof u_pos as U. pose proof (bp_pos (-525)) as T0.
  pose proof (squares_plain d1 d2 d3 1023) as Hs. pose proof (squares_pos d1 d2 d3) as S0.
  pose proof (F_negative _ _ (RN_F _) (RN_F _) H) as L. fold (squares d1 d2 d3) in L. set (s := squares d1 d2 d3) in *.
  clear H. unfold tdot in Hs. error_of Hs P. rewrite !abs_sq in P.
  pose proof (norm_sq d1 d2 d3) as NN. pose proof (norm_pos d1 d2 d3) as N0. rewrite <- NN in P.
  set (n := norm d1 d2 d3) in *.
  pose proof (sq_pos n) as n2. apply Rabs_le_inv in P.
  match type of P with _ <= _ <= _ + bp ?k => assert (T1 : bp k <= / 1000 * bp (-1050)) by (apply Rle_trans with
    (bp (-12 + -1050)); [apply bp_le; lia|]; rewrite bp_add;
    pose proof (bp_pos (-1050)); simpl (bp (-12)); lra) end.
  assert (T2 : bp (-1075) <= / 1000 * bp (-1050)) by (apply Rle_trans with (bp (-12 + -1050)); [apply bp_le; lia|];
    rewrite bp_add; pose proof (bp_pos (-1050)); simpl (bp (-12)); lra).
  assert (TT : bp (-525) * bp (-525) = bp (-1050)) by (rewrite bp_sq; reflexivity).
  pose proof (RN_diff limit r Fl Fr) as E. fold room in E. 
  destruct (Rle_or_lt room 0) as [R0|R0].
  - exfalso. rewrite (Rabs_left1 room) in L by assumption. replace (room * - room) with (- (room * room)) in L by ring.
    rewrite RN_opp in L. assert (0 <= RN (room * room)) by (rewrite <- RN_0; apply RN_le, sq_pos).
    lra.
  - rewrite (Rabs_pos_eq room) in L by lra. pose proof (RN_err (room * room)) as E2.
    rewrite (Rabs_pos_eq (room * room)) in E2 by apply sq_pos. apply Rabs_le_inv in E2.
    assert (N2 : n * n <= (1 + (41 / 10) * u) * (room * room) + / 100 * bp (-1050)).
    { pose proof (sq_pos room). pose proof (bp_pos (-1050)). rewrite u_val in *. lra. }
    assert (N1 : n <= (1 + (21 / 10) * u) * room + bp (-525)).
    { apply below_root; [assert (0 <= (1 + (21 / 10) * u) * room) by (apply Rmult_le_pos; [lra|]; lra); lra|].
      eapply Rle_trans; [exact N2|].
      replace (((1 + (21 / 10) * u) * room + bp (-525)) * ((1 + (21 / 10) * u) * room + bp (-525))) with
        ((1 + (21 / 10) * u) * (1 + (21 / 10) * u) * (room * room) + 2 * (1 + (21 / 10) * u) * (room * bp (-525)) +
        bp (-525) * bp (-525)) by ring.
      rewrite TT. assert (0 <= room * bp (-525)) by (apply Rmult_le_pos; lra). pose proof (sq_pos room).
      pose proof (bp_pos (-1050)). assert (0 <= u * (room * bp (-525))) by (apply Rmult_le_pos; lra).
      rewrite u_val in *. lra. }
    assert (LR : 0 <= limit - r).
    { destruct (Rle_or_lt 0 (limit - r)) as [Z|Z]; [assumption|]. assert (room <= 0) by (unfold room; rewrite <- RN_0;
      apply RN_le; lra). lra. }
    rewrite (Rabs_pos_eq (limit - r)) in E by assumption. apply Rabs_le_inv in E. rewrite u_val in *. lra.
Qed.

(* A sphere that is not looked at lies within `low` of the center C,
  or not farther out than the sphere around the origin
   o of the offsets, which is looked at then. *)
Theorem NEAR_ERROR_holds : forall b1 b2 b3 r o1 o2 o3 x1 x2 x3 C1 C2 C3 low,
  F b1 -> F b2 -> F b3 -> F r -> F o1 -> F o2 -> F o3 -> F x1 -> F x2 -> F x3 -> F C1 -> F C2 -> F C3 -> F low -> 0 <=
    r ->
  bp (-140) <= low ->
  let d1 := RN (RN (b1 - o1) - x1) in let d2 := RN (RN (b2 - o2) - x2) in let d3 := RN (RN (b3 - o3) - x3) in
  let s1 := RN (RN (C1 - o1) - x1) in let s2 := RN (RN (C2 - o2) - x2) in let s3 := RN (RN (C3 - o3) - x3) in
  Rabs d1 <= bp 1023 -> Rabs d2 <= bp 1023 -> Rabs d3 <= bp 1023 ->
  let shift := RN (RN (Rabs s1 + Rabs s2) + Rabs s3) in let limit := RN (RN (low * (1 - NEAR_ERROR)) - shift) in
  let room := RN (limit - r) in RN (squares d1 d2 d3 - RN (room * Rabs room)) < 0 ->
  norm (C1 - b1) (C2 - b2) (C3 - b3) + r <= Rmax low (norm (C1 - o1) (C2 - o2) (C3 - o3)).
Proof.
  intros b1 b2 b3 r o1 o2 o3 x1 x2 x3 C1 C2 C3 low Fb1 Fb2 Fb3 Fr Fo1 Fo2 Fo3 Fx1 Fx2 Fx3 FC1 FC2 FC3 Fl Hr Hlow d1 d2
    d3
    s1 s2 s3 B1 B2 B3 shift limit room H. pose proof u_pos as U. pose proof (bp_pos (-140)) as L0.
  pose proof (measured d1 d2 d3 limit r B1 B2 B3 (RN_F _) Fr Hr H) as M.
  pose proof (offsets b1 b2 b3 o1 o2 o3 x1 x2 x3 Fb1 Fb2 Fb3 Fo1 Fo2 Fo3 Fx1 Fx2 Fx3) as OB. fold d1 d2 d3 in OB.
  pose proof (offsets C1 C2 C3 o1 o2 o3 x1 x2 x3 FC1 FC2 FC3 Fo1 Fo2 Fo3 Fx1 Fx2 Fx3) as OC. fold s1 s2 s3 in OC.
  assert (SH : norm s1 s2 s3 <= (1 + 3 * u) * shift /\ 0 <= shift).
  { pose proof (norm_le_sum s1 s2 s3) as NS. pose proof (Rabs_pos s1). pose proof (Rabs_pos s2).
  pose proof (Rabs_pos s3).
    assert (Fa : forall y, F (RN y) -> F (Rabs (RN y))) by (intros; now apply generic_format_abs).
    pose proof (RN_sum (Rabs s1) (Rabs s2) (Fa _ (RN_F _)) (Fa _ (RN_F _))) as E1.
    set (k := RN (Rabs s1 + Rabs s2)) in *.
    rewrite (Rabs_pos_eq (Rabs s1 + Rabs s2)) in E1 by lra. apply Rabs_le_inv in E1.
    assert (k0 : 0 <= k) by (rewrite u_val in *; lra).
    pose proof (RN_sum k (Rabs s3) (RN_F _) (Fa _ (RN_F _))) as E2. fold shift in E2.
    rewrite (Rabs_pos_eq (k + Rabs s3)) in E2 by lra.
    apply Rabs_le_inv in E2. rewrite u_val in *. split; lra. }
  destruct SH as [SH S0].
  assert (T1 : bp (-525) <= / 1000 * (u * low)).
  { apply Rle_trans with (bp (-10 + (-53 + -140))); [apply bp_le; lia|]. rewrite !bp_add. fold u.
    assert (u * bp (-140) <= u * low) by (apply Rmult_le_compat_l; lra). assert (bp (-10) <= / 1000) by (simpl; lra).
    pose proof (bp_pos (-10)). apply Rmult_le_compat; try lra. apply Rmult_le_pos; lra. }
  assert (T2 : bp (-1075) <= bp (-525)) by (apply bp_le; lia).
  (* the limit *)
  assert (LM : limit + shift <= (1 - (62 - / 10) * u) * low).
  { pose proof (RN_err (low * (1 - NEAR_ERROR))) as E1. unfold NEAR_ERROR in *. set (k := RN (low * (1 - 64 * u))) in *.
    assert (K0 : 0 <= low * (1 - 64 * u)) by (apply Rmult_le_pos; rewrite ?u_val; lra).
    rewrite (Rabs_pos_eq (low * (1 - 64 * u))) in E1 by assumption. apply Rabs_le_inv in E1.
    assert (Fsh : F shift) by apply RN_F. pose proof (RN_diff k shift (RN_F _) Fsh) as E2. fold limit in E2.
    destruct (Rle_or_lt (k - shift) 0) as [Z|Z].
    - rewrite (Rabs_left1 (k - shift)) in E2 by assumption. apply Rabs_le_inv in E2.
      assert (limit <= 0) by (unfold limit; fold k; rewrite <- RN_0; apply RN_le; assumption).
      (* then nothing has a negative measure *)
      exfalso. pose proof (norm_pos d1 d2 d3). assert (LL : 0 <= limit + 4 * u * limit + bp (-525)) by lra.
      assert (RM : room <= 0) by (unfold room; rewrite <- RN_0; apply RN_le; lra).
      pose proof (F_negative _ _ (RN_F _) (RN_F _) H) as L. fold (squares d1 d2 d3) in L.
      pose proof (squares_pos d1 d2 d3).
      rewrite (Rabs_left1 room) in L by assumption. replace (room * - room) with (- (room * room)) in L by ring.
      rewrite RN_opp in L. assert (0 <= RN (room * room)) by (rewrite <- RN_0; apply RN_le, sq_pos). lra.
    - rewrite (Rabs_pos_eq (k - shift)) in E2 by lra. apply Rabs_le_inv in E2. rewrite u_val in *. lra. }
  set (X := norm x1 x2 x3) in *. assert (X0 : 0 <= X) by apply norm_pos.
  pose proof (norm_pos d1 d2 d3) as D0. pose proof (norm_pos s1 s2 s3) as SS0.
  pose proof (bp_pos (-525)) as T0.
  assert (LP : - bp (-525) <= limit) by (assert (0 <= (1 + 4 * u) * limit + bp (-525)) by lra; rewrite u_val in *; lra).
  assert (R1 : norm (b1 - o1 - x1) (b2 - o2 - x2) (b3 - o3 - x3) + r <= limit + 8 * u * low + (1 + / 100) * u * X)
    by (rewrite u_val in *; lra).
  assert (R2 : norm (C1 - o1 - x1) (C2 - o2 - x2) (C3 - o3 - x3) <= shift + 7 * u * low + (1 + / 100) * u * X)
    by (rewrite u_val in *; lra).
  assert (R3 : norm (C1 - b1) (C2 - b2) (C3 - b3) <= norm (C1 - o1 - x1) (C2 - o2 - x2) (C3 - o3 - x3) +
    norm (b1 - o1 - x1) (b2 - o2 - x2) (b3 - o3 - x3)).
  { rewrite <- (norm_opp (b1 - o1 - x1)). replace (C1 - b1) with (C1 - o1 - x1 + - (b1 - o1 - x1)) by ring.
    replace (C2 - b2) with (C2 - o2 - x2 + - (b2 - o2 - x2)) by ring.
    replace (C3 - b3) with (C3 - o3 - x3 + - (b3 - o3 - x3)) by ring. apply norm_triangle. }
  destruct (Rle_or_lt X (3 * low)) as [N|N].
  - apply Rle_trans with low; [|apply Rmax_l]. rewrite u_val in *. lra.
  - apply Rle_trans with (norm (C1 - o1) (C2 - o2) (C3 - o3)); [|apply Rmax_r].
    pose proof (norm_difference x1 x2 x3 (C1 - o1) (C2 - o2) (C3 - o3)) as T. fold X in T.
    assert (E : norm (x1 - (C1 - o1)) (x2 - (C2 - o2)) (x3 - (C3 - o3)) = norm (C1 - o1 - x1) (C2 - o2 - x2) (C3 - o3
      - x3)).
    { rewrite <- norm_opp. f_equal; ring. }
    rewrite E in T. rewrite u_val in *. lra.
Qed.

(* enclosing/apart.rs, `excess` and `is_inside`: the same for offsets from the center of a bracket itself. *)
Definition INSIDE := 64 * u.

(* A sphere that counts as inside reaches no farther from the center C than `low`. *)
Theorem INSIDE_holds : forall b1 b2 b3 r C1 C2 C3 low,
  F b1 -> F b2 -> F b3 -> F r -> F C1 -> F C2 -> F C3 -> F low -> 0 <= r -> bp (-140) <= low ->
  let d1 := RN (b1 - C1) in let d2 := RN (b2 - C2) in let d3 := RN (b3 - C3) in
  Rabs d1 <= bp 1023 -> Rabs d2 <= bp 1023 -> Rabs d3 <= bp 1023 ->
  let limit := RN (low * (1 - INSIDE)) in
  let room := RN (limit - r) in RN (squares d1 d2 d3 - RN (room * Rabs room)) < 0 ->
  norm (b1 - C1) (b2 - C2) (b3 - C3) + r <= low.
Proof.
  intros b1 b2 b3 r C1 C2 C3 low Fb1 Fb2 Fb3 Fr FC1 FC2 FC3 Fl Hr Hlow d1 d2 d3 B1 B2 B3 limit room H.
  pose proof u_pos as U. pose proof (bp_pos (-140)) as L0. pose proof (bp_pos (-525)) as T0.
  pose proof (measured d1 d2 d3 limit r B1 B2 B3 (RN_F _) Fr Hr H) as M.
  assert (T1 : bp (-525) <= / 1000 * (u * low)).
  { apply Rle_trans with (bp (-10 + (-53 + -140))); [apply bp_le; lia|]. rewrite !bp_add. fold u.
    assert (u * bp (-140) <= u * low) by (apply Rmult_le_compat_l; lra). assert (bp (-10) <= / 1000) by (simpl; lra).
    pose proof (bp_pos (-10)). apply Rmult_le_compat; try lra. apply Rmult_le_pos; lra. }
  assert (T2 : bp (-1075) <= bp (-525)) by (apply bp_le; lia).
  pose proof (RN_err (low * (1 - INSIDE))) as E. fold limit in E. unfold INSIDE in E.
  assert (K0 : 0 <= low * (1 - 64 * u)) by (apply Rmult_le_pos; rewrite ?u_val; lra).
  rewrite (Rabs_pos_eq (low * (1 - 64 * u))) in E by assumption. apply Rabs_le_inv in E.
  pose proof (norm_difference (b1 - C1) (b2 - C2) (b3 - C3) d1 d2 d3) as T.
  assert (P : norm (b1 - C1 - d1) (b2 - C2 - d2) (b3 - C3 - d3) <= u * norm (b1 - C1) (b2 - C2) (b3 - C3)).
  { assert (G : forall b C, F b -> F C -> Rabs (b - C - RN (b - C)) <= u * Rabs (b - C))
      by (intros b C Fb FC; rewrite Rabs_minus_sym; now apply RN_diff).
    apply norm_relative; try lra; now apply G. }
  pose proof (norm_pos (b1 - C1) (b2 - C2) (b3 - C3)) as N0. pose proof (norm_pos d1 d2 d3) as D0.
  set (n := norm (b1 - C1) (b2 - C2) (b3 - C3)) in *. set (d := norm d1 d2 d3) in *.
  assert (N : n <= (1 + 2 * u) * d) by (rewrite u_val in *; lra).
  assert (D : d <= 2 * low) by (rewrite u_val in *; lra).
  rewrite u_val in *. lra.
Qed.
