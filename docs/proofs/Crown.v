(* rt-geom, bvh/crown.rs: a ray and boxes in doubles, as the scene has them. *)
From Proofs Require Import Rounding.
From Flocq Require Import Plus_error.
Open Scope R_scope.

(* The rounding errors of a value along the ray, relative to it, and what underflows. *)
Definition PARAMETER_ERROR := 8 * u.
Definition UNDERFLOW := bp (-1000).
(* Planes and origins lie within this, components of the direction beyond that. *)
Definition FARTHEST := bp 400.
Definition SHORTEST := bp (-500).

(* ---- Planes: one double outside the rounded end ---- *)
Theorem outward_below : forall x, pred radix2 fexp (RN x) < x.
Proof.
  intro x. assert (H : pred radix2 fexp (RN x) <= x) by (apply pred_round_le_id; auto with typeclass_instances).
  destruct H as [H|H]; [assumption|exfalso].
  assert (Fx : F x) by (rewrite <- H; apply generic_format_pred; [typeclasses eauto | apply RN_F]).
  rewrite (RN_id x Fx) in H. destruct (Req_dec x 0) as [Z|N].
  - rewrite Z, pred_0 in H. assert (U : ulp radix2 fexp 0 = bp (-1074)) by (unfold fexp; now apply ulp_FLT_0).
    rewrite U in H. pose proof (bp_pos (-1074)). lra.
  - pose proof (pred_lt_id radix2 fexp x N). lra.
Qed.
Theorem outward_above : forall x, x < succ radix2 fexp (RN x).
Proof.
  intro x. pose proof (outward_below (- x)) as H. rewrite RN_opp, pred_opp in H. lra.
Qed.
(* A line along an axis whose origin is strictly between the planes: they are infinitely far on either side. *)
Theorem between_planes : forall low o high, F low -> F o -> F high -> low < o < high ->
  RN (low - o) < 0 < RN (high - o).
Proof.
  assert (N : forall a b, F a -> F b -> a < b -> RN (b - a) <> 0).
  { intros a b Fa Fb L Z. assert (b + - a = 0); [|lra].
    apply (round_plus_eq_0 radix2 fexp ZnearestE b (- a)); [exact Fb | now apply F_opp | exact Z]. }
  intros low o high F1 F2 F3 [L1 L2]. split.
  - assert (0 <= RN (o - low)) by (rewrite <- RN_0; apply RN_le; lra). pose proof (N low o F1 F2 L1).
    replace (low - o) with (- (o - low)) by ring. rewrite RN_opp. lra.
  - assert (0 <= RN (high - o)) by (rewrite <- RN_0; apply RN_le; lra). pose proof (N o high F2 F3 L2). lra.
Qed.

(* ---- Range ---- *)
Lemma inverse_error : forall d, SHORTEST < Rabs d <= bp 100 ->
  Rabs (RN (/ d) - / d) <= u * Rabs (/ d) /\ Rabs (/ d) <= bp 500.
Proof.
  intros d [D0 D1]. pose proof (bp_pos (-500)) as P. unfold SHORTEST in D0. split.
  - apply RN_normal. rewrite Rabs_inv. apply Rle_trans with (bp (-100)); [apply bp_le; lia|].
    change (-100)%Z with (Z.opp 100). rewrite bpow_opp. apply Rinv_le_contravar; lra.
  - rewrite Rabs_inv. change 500%Z with (Z.opp (-500)). rewrite bpow_opp. apply Rinv_le_contravar; lra.
Qed.
(* A reciprocal is normal: one relative error. *)
Theorem SHORTEST_holds : forall d, SHORTEST < Rabs d <= bp 100 ->
  Rabs (RN (/ d) - / d) <= u * Rabs (/ d) /\ Rabs (RN (/ d)) <= bp 501.
Proof.
  intros d H. destruct (inverse_error d H) as [E B]. split; [assumption|].
  change 501%Z with (1 + 500)%Z. rewrite bp_add, bp_1.
  replace (RN (/ d)) with ((RN (/ d) - / d) + / d) by ring. eapply Rle_trans; [apply Rabs_triang|].
  rewrite u_val in E. pose proof (Rabs_pos (/ d)). lra.
Qed.
(* Nothing overflows, with planes that are moved outward. *)
Theorem FARTHEST_holds : forall plane o d,
  Rabs plane <= 2 * FARTHEST -> Rabs o <= 2 * FARTHEST -> SHORTEST < Rabs d <= bp 100 ->
  Rabs (RN (RN (plane - o) * RN (/ d))) <= bp 905.
Proof.
  intros plane o d Hp Ho Hd. destruct (SHORTEST_holds d Hd) as [_ B]. unfold FARTHEST in *.
  pose proof (RN_err (plane - o)) as E. assert (P : Rabs (plane - o) <= 4 * bp 400).
  { unfold Rminus. eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. lra. }
  assert (T : bp (-1075) <= bp 400) by (apply bp_le; lia). set (m := RN (plane - o)) in *.
  assert (M : Rabs m <= bp 403).
  { change 403%Z with (3 + 400)%Z. rewrite bp_add. simpl (bp 3).
  replace m with ((m - (plane - o)) + (plane - o)) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite u_val in E. pose proof (bp_pos 400). lra. }
  pose proof (RN_err (m * RN (/ d))) as E2. set (r := RN (/ d)) in *.
  assert (MR : Rabs (m * r) <= bp 904).
  { rewrite Rabs_mult. change 904%Z with (403 + 501)%Z. rewrite bp_add. apply Rmult_le_compat; auto using Rabs_pos. }
  assert (T2 : bp (-1075) <= / 2 * bp 904).
  { apply Rle_trans with (bp (-1 + 904)); [apply bp_le; lia|]. rewrite bp_add. simpl (bp (-1)). lra. }
  change 905%Z with (1 + 904)%Z. rewrite bp_add, bp_1. replace (RN (m * r)) with ((RN (m * r) - m * r) + m * r) by ring.
  eapply Rle_trans; [apply Rabs_triang|]. rewrite u_val in E2. pose proof (bp_pos 904). lra.
Qed.

(* ---- Error ---- *)
(* Where a plane is met, as computed: three roundings, and what underflows. *)
Definition meeting plane o d := RN (RN (plane - o) * RN (/ d)).
Lemma meeting_error : forall plane o d, F plane -> F o -> SHORTEST < Rabs d <= bp 100 ->
  let x := (plane - o) / d in
  Rabs (meeting plane o d - x) <= (3 + / 100) * u * Rabs x + bp (-1075).
Proof.
  intros plane o d Fp Fo Hd x. destruct (inverse_error d Hd) as [E1 _]. pose proof (RN_diff plane o Fp Fo) as E2.
  unfold meeting. set (m := RN (plane - o)) in *. set (r := RN (/ d)) in *. set (D := plane - o) in *.
  pose proof (RN_err (m * r)) as E3. pose proof u_pos as U.
  assert (AX : Rabs x = Rabs D * Rabs (/ d)) by (unfold x, Rdiv; apply Rabs_mult).
  assert (MR : Rabs (m * r - x) <= (2 + / 1000) * u * Rabs x).
  { replace (m * r - x) with ((m - D) * r + D * (r - / d)) by (unfold x, Rdiv; ring).
    eapply Rle_trans; [apply Rabs_triang|]. rewrite !Rabs_mult, AX.
    pose proof (Rabs_pos D) as D0. pose proof (Rabs_pos (/ d)) as I0.
    assert (R1 : Rabs r <= (1 + u) * Rabs (/ d)).
    { replace r with ((r - / d) + / d) by ring. eapply Rle_trans; [apply Rabs_triang|]. lra. }
    assert (X1 : Rabs (m - D) * Rabs r <= u * Rabs D * ((1 + u) * Rabs (/ d))) by (apply Rmult_le_compat;
      auto using Rabs_pos).
    assert (X2 : Rabs D * Rabs (r - / d) <= Rabs D * (u * Rabs (/ d))) by (apply Rmult_le_compat_l; assumption).
    set (a := Rabs D) in *. set (b := Rabs (/ d)) in *. pose proof (Rmult_le_pos _ _ D0 I0).
    replace (u * a * ((1 + u) * b)) with (u * (1 + u) * (a * b)) in X1 by ring.
    replace (a * (u * b)) with (u * (a * b)) in X2 by ring. rewrite u_val in *. lra. }
  replace (RN (m * r) - x) with ((RN (m * r) - m * r) + (m * r - x)) by ring.
  eapply Rle_trans; [apply Rabs_triang|]. assert (A : Rabs (m * r) <= (1 + 3 * u) * Rabs x).
  { replace (m * r) with ((m * r - x) + x) by ring. eapply Rle_trans; [apply Rabs_triang|]. pose proof (Rabs_pos x).
    rewrite u_val in *. lra. }
  pose proof (Rabs_pos x). rewrite u_val in *. lra.
Qed.
(* A plane that is met before t' is met before it as computed, but for the error. *)
Lemma meeting_before : forall plane o d t', F plane -> F o -> SHORTEST < Rabs d <= bp 100 -> (plane - o) / d <= t' ->
  meeting plane o d <= t' + (3 + / 100) * u * Rabs t' + bp (-1075).
Proof.
  intros plane o d t' Fp Fo Hd H. pose proof (meeting_error plane o d Fp Fo Hd) as E. cbv zeta in E.
  set (x := (plane - o) / d) in *. apply Rabs_le_inv in E. pose proof (bp_pos (-1075)). pose proof u_pos.
  destruct (Rle_or_lt 0 t') as [T|T].
  - rewrite (Rabs_pos_eq t') by assumption. destruct (Rle_or_lt 0 x) as [X0|X0].
    + rewrite (Rabs_pos_eq x) in E by assumption. rewrite u_val in *. lra.
    + rewrite (Rabs_left x) in E by assumption. rewrite u_val in *. lra.
  - rewrite (Rabs_left t') by assumption. rewrite (Rabs_left x) in E by lra. rewrite u_val in *. lra.
Qed.
(* The bound of where a box is entered. *)
Definition lowered x := RN (x - RN (RN (Rabs x * PARAMETER_ERROR) + UNDERFLOW)).
Lemma smallest : bp (-1075) <= / 1000000 * UNDERFLOW /\ 0 < UNDERFLOW.
Proof.
  split; [|apply bp_pos]. apply Rle_trans with (bp (-20 + -1000)); [apply bp_le; lia|]. rewrite bp_add. fold UNDERFLOW.
  unfold UNDERFLOW. pose proof (bp_pos (-1000)). simpl (bp (-20)). lra.
Qed.
Lemma lowered_le : forall x, F x -> lowered x <= x - (7 - / 100) * u * Rabs x - (1 - / 1000) * UNDERFLOW.
Proof.
  intros x Fx. unfold lowered. destruct smallest as [T U0]. pose proof (Rabs_pos x) as X0. pose proof u_pos as UP.
  pose proof (RN_err (Rabs x * PARAMETER_ERROR)) as E1. unfold PARAMETER_ERROR in *.
  set (k := RN (Rabs x * (8 * u))) in *. rewrite (Rabs_pos_eq (Rabs x * (8 * u))) in E1 by (apply Rmult_le_pos; lra).
  pose proof (RN_err (k + UNDERFLOW)) as E2. set (m := RN (k + UNDERFLOW)) in *.
  apply Rabs_le_inv in E1. assert (K0 : 0 <= k) by (unfold k; rewrite <- RN_0; apply RN_le; apply Rmult_le_pos; lra).
  rewrite (Rabs_pos_eq (k + UNDERFLOW)) in E2 by lra. apply Rabs_le_inv in E2.
  pose proof (RN_err (x - m)) as E3. assert (A : Rabs (x - m) <= Rabs x + m).
  { unfold Rminus. eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp, (Rabs_pos_eq m); [lra|].
    rewrite u_val in *. lra. }
  assert (A2 : u * Rabs (x - m) <= u * (Rabs x + m)) by (apply Rmult_le_compat_l; lra).
  apply Rabs_le_inv in E3. rewrite u_val in *. lra.
Qed.
Lemma lowered_before : forall x t', F x -> x <= t' + (3 + / 100) * u * Rabs t' + bp (-1075) ->
  lowered x < t' - u * Rabs t' - bp (-1075).
Proof.
  intros x t' Fx H. pose proof (lowered_le x Fx) as L. destruct smallest as [T U0]. pose proof (bp_pos (-1075)) as B.
  pose proof (Rabs_pos x). destruct (Rle_or_lt 0 t') as [Q|Q].
  - rewrite (Rabs_pos_eq t') in * by assumption. destruct (Rle_or_lt 0 x) as [X0|X0].
    + rewrite (Rabs_pos_eq x) in L by assumption. rewrite u_val in *. lra.
    + rewrite (Rabs_left x) in L by assumption. rewrite u_val in *. lra.
  - rewrite (Rabs_left t') in * by assumption. destruct (Rle_or_lt 0 x) as [X0|X0].
    + rewrite (Rabs_pos_eq x) in L by assumption. rewrite u_val in *. lra.
    + rewrite (Rabs_left x) in L by assumption. rewrite u_val in *. lra.
Qed.
(* Far planes: the same with both signs changed. *)
Definition raised x := RN (x + RN (RN (Rabs x * PARAMETER_ERROR) + UNDERFLOW)).
Lemma raised_lowered : forall x, raised x = - lowered (- x).
Proof.
  intro x. unfold raised, lowered. rewrite Rabs_Ropp. set (m := RN (RN (Rabs x * PARAMETER_ERROR) + UNDERFLOW)).
  replace (- x - m) with (- (x + m)) by ring.
  rewrite RN_opp. ring.
Qed.

(* The three axes: enter is one of the near meetings and leave one of the far ones (their maximum and minimum, over the
   axes along which the line goes). A hit with the exact t', rounded to t,
     lies behind the near planes and before the far
   ones: the bounds as computed are on either side of t. *)
Theorem PARAMETER_ERROR_holds : forall near far o d near' far' o' d' t t',
  F near -> F o -> F far' -> F o' -> SHORTEST < Rabs d <= bp 100 -> SHORTEST < Rabs d' <= bp 100 ->
  (near - o) / d <= t' -> t' <= (far' - o') / d' -> Rabs (t - t') <= u * Rabs t' + bp (-1075) ->
  near' = meeting near o d -> far = meeting far' o' d' -> lowered near' < t < raised far.
Proof.
  intros near far o d near' far' o' d' t t' F1 F2 F3 F4 D1 D2 N X Ht En Ef. apply Rabs_le_inv in Ht. split.
  - pose proof (meeting_before near o d t' F1 F2 D1 N) as M. rewrite <- En in M.
    pose proof (lowered_before near' t' ltac:(rewrite En; apply RN_F) M). lra.
  - rewrite raised_lowered.
    assert (M : meeting (- far') (- o') d' <= - t' + (3 + / 100) * u * Rabs (- t') + bp (-1075)).
    { apply meeting_before; auto using F_opp.
    replace ((- far' - - o') / d') with (- ((far' - o') / d')) by (unfold Rdiv;
      ring). lra. }
    assert (E : meeting (- far') (- o') d' = - far).
    { rewrite Ef. unfold meeting. replace (- far' - - o') with (- (far' - o')) by ring. rewrite RN_opp.
      replace (- RN (far' - o') * RN (/ d')) with (- (RN (far' - o') * RN (/ d'))) by ring. apply RN_opp. }
    rewrite E in M. pose proof (lowered_before (- far) (- t') ltac:(apply F_opp; rewrite Ef; apply RN_F) M) as L.
    rewrite Rabs_Ropp in L. lra.
Qed.
(* What underflows is below a part of 10^6 of UNDERFLOW, which stays below the last bits of 1. *)
Theorem UNDERFLOW_holds : bp (-1075) <= / 1000000 * UNDERFLOW /\ UNDERFLOW <= u.
Proof. split; [apply smallest | apply bp_le; lia]. Qed.
