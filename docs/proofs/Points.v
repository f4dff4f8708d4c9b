(* rt-geom: points of a ray and unit normals of spheres and triangles, as the docstrings promise them. *)
From Proofs Require Import Rounding ErrorFree DoubleDouble Twice Steps Light.
Open Scope R_scope.

(* `Ray::at`: parts of u times the way and the point. *)
Definition AT_WAY := 201 / 100.
Definition AT_POINT := 101 / 100.
(* Unit normals, in units of u: of a sphere at a point, of a triangle, and at a hit. *)
Definition SPHERE_NORMAL := 46 / 10.
Definition TRIANGLE_NORMAL := 46 / 10.
Definition HIT_NORMAL := 7.
(* A normal in double-double is certain if its largest component is that part of the square of the edges'. *)
Definition CERTAIN_NORMAL := 1 / 1000000000000.
(* What the division by the radius adds, and up to where the result is taken, in units of u. *)
Definition DIVISION := 101 / 100.
Definition TAKEN := 6.

(* ---- Points ---- *)
Section At.
Variables o1 o2 o3 d1 d2 d3 exactly : R.
Hypotheses (F1 : F o1) (F2 : F o2) (F3 : F o3).
Let t := RN exactly.
Definition normal_or_zero x := x = 0 \/ bp (-1022) <= Rabs x.
Hypotheses (Nt : normal_or_zero exactly) (N1 : normal_or_zero (t * d1)) (N2 : normal_or_zero (t * d2)) (N3 :
  normal_or_zero (t * d3)).
Lemma relative : forall x, normal_or_zero x -> Rabs (RN x - x) <= u * Rabs x.
Proof.
  intros x [Z|N]; [|now apply RN_normal]. rewrite Z, RN_0. replace (0 - 0) with 0 by ring. rewrite Rabs_R0. lra.
Qed.
Lemma point_component : forall o d, F o -> normal_or_zero (t * d) ->
  Rabs (RN (o + RN (t * d)) - (o + exactly * d)) <= u * (2005 / 1000 * Rabs (t * d) + Rabs (RN (o + RN (t * d)))).
Proof.
  intros o d Fo N. pose proof (relative _ Nt) as E1. fold t in E1. pose proof (relative _ N) as E2. set (m := RN (t *
    d)) in *. pose proof u_pos.
  destruct (two_sum_error_le o m Fo (RN_F _)) as [_ E3]. pose proof (two_sum o m Fo (RN_F _)) as TS. set (p := RN (o +
    m)) in *.
  pose proof (Rabs_triang_inv exactly t) as I. rewrite (Rabs_minus_sym exactly) in I. pose proof (Rabs_pos t). pose
    proof (Rabs_pos exactly).
  assert (E1' : Rabs (t - exactly) <= (1 + 3 * u) * u * Rabs t) by (rewrite u_val in *; lra).
  assert (E4 : Rabs ((t - exactly) * d) <= (1 + 3 * u) * u * Rabs (t * d)).
  { rewrite !Rabs_mult. replace ((1 + 3 * u) * u * (Rabs t * Rabs d)) with ((1 + 3 * u) * u * Rabs t * Rabs d) by
    ring. apply Rmult_le_compat_r; [apply Rabs_pos | assumption]. }
  replace (p - (o + exactly * d)) with (- two_sum_error o m + (m - t * d) + (t - exactly) * d) by lra.
  eapply Rle_trans; [apply Rabs_plus_le; [apply Rabs_plus_le; [rewrite Rabs_Ropp; exact E3 | exact E2] | exact E4]|].
    pose proof (Rabs_pos (t * d)). rewrite u_val in *. lra.
Qed.
Let p1 := RN (o1 + RN (t * d1)). Let p2 := RN (o2 + RN (t * d2)). Let p3 := RN (o3 + RN (t * d3)).
Theorem AT_WAY_holds :
  (forall o d, F o -> normal_or_zero (t * d) ->
     Rabs (RN (o + RN (t * d)) - (o + exactly * d)) <= u * (AT_WAY * Rabs (t * d) + AT_POINT * Rabs (RN (o + RN (t *
       d))))) /\
  len (p1 - (o1 + exactly * d1)) (p2 - (o2 + exactly * d2)) (p3 - (o3 + exactly * d3)) <=
    u * (AT_WAY * (Rabs t * len d1 d2 d3) + AT_POINT * len p1 p2 p3).
Proof.
  pose proof u_pos. split.
  - intros o d Fo N. eapply Rle_trans; [now apply point_component|]. apply Rmult_le_compat_l; [lra|]. unfold AT_WAY,
    AT_POINT.
    pose proof (Rabs_pos (t * d)). pose proof (Rabs_pos (RN (o + RN (t * d)))). lra.
  - assert (C : forall o d p, p = RN (o + RN (t * d)) -> F o -> normal_or_zero (t * d) -> Rabs (p - (o + exactly * d))
    <= Rabs (2005 / 1000 * u * (Rabs t * Rabs d) + u * Rabs p)).
    { intros o d p E Fo N. rewrite E. eapply Rle_trans; [now apply point_component|]. eapply Rle_trans; [|apply
      Rle_abs]. rewrite Rabs_mult. lra. }
    eapply Rle_trans; [apply (len_mono _ _ _ _ _ _ (C o1 d1 p1 eq_refl F1 N1) (C o2 d2 p2 eq_refl F2 N2) (C o3 d3 p3
      eq_refl F3 N3))|].
    eapply Rle_trans; [apply len_add|]. rewrite !len_scale by (try apply Rmult_le_pos; lra).
    rewrite len_scale by apply Rabs_pos. rewrite (len_scale u) by lra.
    assert (A1 : len (Rabs d1) (Rabs d2) (Rabs d3) = len d1 d2 d3) by (unfold len; now rewrite !abs_sq).
    assert (A2 : len (Rabs p1) (Rabs p2) (Rabs p3) = len p1 p2 p3) by (unfold len; now rewrite !abs_sq). rewrite A1, A2.
    pose proof (len_pos d1 d2 d3). pose proof (len_pos p1 p2 p3). assert (0 <= Rabs t * len d1 d2 d3) by (apply
      Rmult_le_pos; [apply Rabs_pos | assumption]).
    unfold AT_WAY, AT_POINT. set (x := Rabs t * len d1 d2 d3) in *. rewrite u_val. lra.
Qed.
Theorem AT_POINT_holds : forall o d, F o -> normal_or_zero (t * d) ->
  Rabs (RN (o + RN (t * d)) - (o + exactly * d)) <= u * (AT_WAY * Rabs (t * d) + AT_POINT * Rabs (RN (o + RN (t * d)))).
Proof. apply AT_WAY_holds. Qed.
End At.

(* ---- Unit vectors by division ---- *)
Section Divided.
Variables v1 v2 v3 sq : R.
Let L := len v1 v2 v3.
Hypotheses (Range : bp (-400) <= L <= bp 400) (Hsq : plain (tsq v1 v2 v3) sq).
Let l := RN (sqrt sq).
Lemma length_near : 0 < L /\ 0 < l /\ Rabs (l - L) <= 2505 / 1000 * u * L.
Proof.
  pose proof (bp_pos (-400)) as P0. assert (L0 : 0 < L) by lra. destruct (len_component v1 v2 v3) as (C1 & C2 & C3).
    fold L in C1, C2, C3.
  assert (B : bounded (tsq v1 v2 v3)) by (unfold tsq, tdot; cbn [bounded]; repeat split; lra).
  pose proof (plain_error_at _ _ 3 (low (tsq v1 v2 v3)) Hsq B eq_refl eq_refl ltac:(lia)) as Q.
  assert (SZ : size (tsq v1 v2 v3) = L * L) by (unfold tsq, tdot; cbn [size]; rewrite !abs_sq; unfold L; now rewrite
    len_sq).
  assert (EX : exact (tsq v1 v2 v3) = L * L) by (unfold tsq, tdot; cbn [exact]; unfold L; now rewrite len_sq). rewrite
    SZ, EX in Q.
  assert (LL : bp (-800) <= L * L) by (change (-800)%Z with (-400 + -400)%Z; rewrite bp_add; apply Rmult_le_compat;
    lra).
  assert (LT : bp (low (tsq v1 v2 v3)) <= / 1000 * u * bp (-800)).
  { apply Rle_trans with (bp (-10) * u * bp (-800)); [unfold u; rewrite <- !bp_add; apply bp_le; vm_compute;
    discriminate|].
    apply Rmult_le_compat_r; [apply Rlt_le, bp_pos|]. apply Rmult_le_compat_r; [apply Rlt_le, u_pos | simpl; lra]. }
  assert (S1 : Rabs (sq - L * L) <= (3 + / 500) * u * (L * L)) by (pose proof (bp_pos (-800)); rewrite u_val in *; lra).
  apply Rabs_le_inv in S1. assert (s0 : 0 < sq) by (pose proof (bp_pos (-800)); rewrite u_val in *; lra).
  set (w := sqrt sq) in *. assert (ww : w * w = sq) by (apply sqrt_sqrt; lra). assert (w0 : 0 < w) by (apply
    sqrt_lt_R0; assumption).
  assert (W1 : 999 / 1000 * L <= w).
  { apply below_root; [lra|]. rewrite ww. replace (999 / 1000 * L * (999 / 1000 * L)) with (999 / 1000 * (999 / 1000)
    * (L * L)) by ring. rewrite u_val in *. lra. }
  assert (W2 : Rabs (w - L) <= (1502 / 1000) * u * L).
  { apply Rmult_le_reg_r with (1999 / 1000 * L); [lra|]. apply Rle_trans with (Rabs (w - L) * (w + L)); [apply
    Rmult_le_compat_l; [apply Rabs_pos | lra]|].
    rewrite <- (Rabs_pos_eq (w + L)) by lra. rewrite <- Rabs_mult. replace ((w - L) * (w + L)) with (sq - L * L) by
      (rewrite <- ww; ring).
    replace (1502 / 1000 * u * L * (1999 / 1000 * L)) with (1502 / 1000 * (1999 / 1000) * u * (L * L)) by ring. apply
      Rabs_le.
    assert (0 <= u * (L * L)) by (apply Rmult_le_pos; [apply Rlt_le, u_pos | apply sq_pos]). lra. }
  pose proof (RN_normal w) as R1. rewrite (Rabs_pos_eq w) in R1 by lra.
  assert (LB : bp (-1022) <= / 1000000000000 * bp (-400)) by (apply bp_part12; lia).
  specialize (R1 ltac:(lra)). fold l in R1. apply Rabs_le_inv in R1. apply Rabs_le_inv in W2. split; [exact L0|].
    split; [rewrite u_val in *; lra|].
  apply Rabs_le. rewrite u_val in *. lra.
Qed.
Let c1 := RN (v1 / l). Let c2 := RN (v2 / l). Let c3 := RN (v3 / l).
Lemma divided_exact : len (c1 - v1 / L) (c2 - v2 / L) (c3 - v3 / L) <= (352 / 100) * u.
Proof.
  destruct length_near as (L0 & l0 & E). pose proof u_pos.
  assert (K : Rabs (L / l - 1) <= (2506 / 1000) * u).
  { replace (L / l - 1) with (- (l - L) / l) by (field; lra). apply Rabs_div_le; [lra|]. rewrite Rabs_Ropp,
    (Rabs_pos_eq l) by lra. eapply Rle_trans; [exact E|].
    apply Rabs_le_inv in E. rewrite u_val in *. lra. }
  assert (C : forall v, Rabs (RN (v / l) - v / L) <= (351 / 100) * u * Rabs (v / L) + bp (-1075)).
  { intro v. pose proof (RN_err (v / l)) as R. replace (RN (v / l) - v / L) with ((RN (v / l) - v / l) + v / L * (L /
    l - 1)) by (field; lra).
    assert (V : Rabs (v / l) <= (1 + 3 * u) * Rabs (v / L)).
    { replace (v / l) with (L / l * (v / L)) by (field; lra). rewrite Rabs_mult. apply Rmult_le_compat_r; [apply
      Rabs_pos|]. apply Rabs_le_inv in K. apply Rabs_le. rewrite u_val in *. lra. }
    assert (W : Rabs (v / L * (L / l - 1)) <= Rabs (v / L) * (2506 / 1000 * u)) by (rewrite Rabs_mult; apply
      Rmult_le_compat_l; [apply Rabs_pos | exact K]).
    eapply Rle_trans; [apply Rabs_plus_le; [exact R | exact W]|]. pose proof (Rabs_pos (v / L)). rewrite u_val in *.
      lra. }
  apply Rle_trans with (len ((351 / 100) * u * Rabs (v1 / L) + bp (-1075)) ((351 / 100) * u * Rabs (v2 / L) + bp
    (-1075)) ((351 / 100) * u * Rabs (v3 / L) + bp (-1075))).
  - apply len_mono; (eapply Rle_trans; [apply C | apply Rle_abs]).
  - eapply Rle_trans; [apply len_add|]. rewrite len_scale by lra.
    assert (one : len (Rabs (v1 / L)) (Rabs (v2 / L)) (Rabs (v3 / L)) = 1).
    { unfold len at 1. rewrite !abs_sq. replace (v1 / L * (v1 / L) + v2 / L * (v2 / L) + v3 / L * (v3 / L)) with ((v1
      * v1 + v2 * v2 + v3 * v3) / (L * L)) by (field; lra).
      rewrite <- (len_sq v1 v2 v3). fold L. replace (L * L / (L * L)) with 1 by (field; lra). apply sqrt_1. }
    rewrite one. pose proof (len_le_norm1 (bp (-1075)) (bp (-1075)) (bp (-1075))) as Z. unfold norm1 in Z. rewrite
      (Rabs_pos_eq (bp (-1075))) in Z by apply Rlt_le, bp_pos.
    assert (bp (-1075) <= / 1000 * u). { apply Rle_trans with (bp (-10) * u); [unfold u; rewrite <- bp_add; apply
      bp_le; lia | apply Rmult_le_compat_r; [lra | simpl; lra]]. }
    lra.
Qed.
(* of a vector that is within k u of itself *)
Lemma divided : forall V1 V2 V3, len (v1 - V1) (v2 - V2) (v3 - V3) <= (102 / 100) * u * L ->
  len (c1 - V1 / len V1 V2 V3) (c2 - V2 / len V1 V2 V3) (c3 - V3 / len V1 V2 V3) <= 455 / 100 * u.
Proof.
  intros V1 V2 V3 H. destruct length_near as (L0 & _ & _). pose proof u_pos. pose proof divided_exact as E.
  destruct (chord v1 v2 v3 V1 V2 V3 (102 / 100 * u * L) H L0 ltac:(fold L; rewrite u_val; lra)) as [_ C]. cbv zeta in
    C. fold L in C. set (M := len V1 V2 V3) in *.
  replace (102 / 100 * u * L / L) with (102 / 100 * u) in C by (field; lra).
  replace (len (c1 - V1 / M) (c2 - V2 / M) (c3 - V3 / M)) with
    (len ((c1 - v1 / L) + (v1 / L - V1 / M)) ((c2 - v2 / L) + (v2 / L - V2 / M)) ((c3 - v3 / L) + (v3 / L - V3 / M)))
      by (f_equal; ring).
  eapply Rle_trans; [apply len_add|]. lra.
Qed.
End Divided.

(* A sphere's normal: the point less the center, rounded, times a power of two that brings it near 1. *)
Theorem SPHERE_NORMAL_holds : forall p1 p2 p3 c1 c2 c3 k sq, F p1 -> F p2 -> F p3 -> F c1 -> F c2 -> F c3 ->
  let v1 := RN (p1 - c1) * bp k in let v2 := RN (p2 - c2) * bp k in let v3 := RN (p3 - c3) * bp k in
  bp (-400) <= len v1 v2 v3 <= bp 400 -> plain (tsq v1 v2 v3) sq ->
  let l := RN (sqrt sq) in let M := len (p1 - c1) (p2 - c2) (p3 - c3) in
  len (RN (v1 / l) - (p1 - c1) / M) (RN (v2 / l) - (p2 - c2) / M) (RN (v3 / l) - (p3 - c3) / M) <= SPHERE_NORMAL * u.
Proof.
  intros p1 p2 p3 c1 c2 c3 k sq Fp1 Fp2 Fp3 Fc1 Fc2 Fc3 v1 v2 v3 Range Hsq l M. pose proof u_pos. pose proof (bp_pos
    k) as K.
  assert (C : forall p c, F p -> F c -> Rabs (RN (p - c) * bp k - (p - c) * bp k) <= (101 / 100) * u * Rabs (RN (p -
    c) * bp k)).
  { intros p c Fp Fc. pose proof (RN_diff p c Fp Fc) as E. replace (RN (p - c) * bp k - (p - c) * bp k) with ((RN (p -
    c) - (p - c)) * bp k) by ring.
    rewrite !Rabs_mult, (Rabs_pos_eq (bp k)) by lra. rewrite <- Rmult_assoc. apply Rmult_le_compat_r; [lra|].
    pose proof (Rabs_triang_inv (p - c) (RN (p - c))) as I. rewrite (Rabs_minus_sym (p - c)) in I. pose proof
      (Rabs_pos (p - c)). rewrite u_val in *. lra. }
  assert (H0 : len (v1 - (p1 - c1) * bp k) (v2 - (p2 - c2) * bp k) (v3 - (p3 - c3) * bp k) <= 102 / 100 * u * len v1
    v2 v3).
  { apply Rle_trans with (101 / 100 * u * len v1 v2 v3).
    - apply len_part; [lra | now apply C | now apply C | now apply C].
    - apply Rmult_le_compat_r; [apply len_pos | lra]. }
  pose proof (divided v1 v2 v3 sq Range Hsq _ _ _ H0) as D. fold l in D.
  assert (MK : len ((p1 - c1) * bp k) ((p2 - c2) * bp k) ((p3 - c3) * bp k) = bp k * M).
  { unfold M. rewrite <- len_scale by lra. f_equal; ring. }
  rewrite MK in D. assert (M0 : M <> 0).
  { intro Z. destruct (length_near v1 v2 v3 sq Range Hsq) as (L0 & _ & _). pose proof (len_sub v1 v2 v3 ((p1 - c1) *
    bp k) ((p2 - c2) * bp k) ((p3 - c3) * bp k)) as T.
    rewrite MK, Z, Rmult_0_r in T. rewrite u_val in H0. lra. }
  replace ((p1 - c1) * bp k / (bp k * M)) with ((p1 - c1) / M) in D by (field; split; lra). replace ((p2 - c2) * bp k
    / (bp k * M)) with ((p2 - c2) / M) in D by (field; split; lra).
  replace ((p3 - c3) * bp k / (bp k * M)) with ((p3 - c3) / M) in D by (field; split; lra). eapply Rle_trans; [exact
    D|]. unfold SPHERE_NORMAL. lra.
Qed.
(* A triangle's: the product of the edges in double-double, within 32 u^2 of the square of the largest component m of
  the edges; its high parts. *)
Theorem CERTAIN_NORMAL_holds : forall h1 h2 h3 l1 l2 l3 N1 N2 N3 m, dd h1 l1 -> dd h2 l2 -> dd h3 l3 -> 0 <= m ->
  Rabs (h1 + l1 - N1) <= 32 * (u * u) * (m * m) -> Rabs (h2 + l2 - N2) <= 32 * (u * u) * (m * m) -> Rabs (h3 + l3 -
    N3) <= 32 * (u * u) * (m * m) ->
  (1 - 8 * u) * CERTAIN_NORMAL * (m * m) <= Rmax (Rabs h1) (Rmax (Rabs h2) (Rabs h3)) ->
  len (h1 - N1) (h2 - N2) (h3 - N3) <= (102 / 100) * u * len h1 h2 h3.
Proof.
  intros h1 h2 h3 l1 l2 l3 N1 N2 N3 m D1 D2 D3 M0 E1 E2 E3 C. pose proof u_pos. set (L := len h1 h2 h3). destruct
    (len_component h1 h2 h3) as (C1 & C2 & C3). fold L in C1, C2, C3.
  assert (LM : (1 - 8 * u) * CERTAIN_NORMAL * (m * m) <= L) by (eapply Rle_trans; [exact C|]; repeat apply Rmax_lub;
    assumption). unfold CERTAIN_NORMAL in LM.
  set (k := 32 * (u * u) * (m * m)) in *. assert (KL : k <= / 250 * u * L) by (unfold k; pose proof (sq_pos m);
    rewrite u_val in *; lra).
  assert (k0 : 0 <= k) by (unfold k; pose proof (sq_pos m); rewrite u_val in *; lra).
  assert (P : forall h l N, dd h l -> Rabs (h + l - N) <= k -> Rabs (h - N) <= Rabs (u * Rabs h + k)).
  { intros h l N Hd HN. pose proof (dd_low _ _ Hd). eapply Rle_trans; [|apply Rle_abs]. replace (h - N) with ((h + l -
    N) - l) by ring.
    eapply Rle_trans; [apply Rabs_minus_le; eassumption|]. lra. }
  eapply Rle_trans; [apply (len_mono _ _ _ _ _ _ (P _ _ _ D1 E1) (P _ _ _ D2 E2) (P _ _ _ D3 E3))|]. eapply Rle_trans;
    [apply len_add|]. rewrite len_scale by lra.
  assert (A1 : len (Rabs h1) (Rabs h2) (Rabs h3) = L) by (unfold L, len; now rewrite !abs_sq). rewrite A1.
  pose proof (len_le_norm1 k k k) as Z. unfold norm1 in Z. rewrite (Rabs_pos_eq k) in Z by assumption. assert (0 <= L)
    by apply len_pos.
  assert (0 <= u * L) by (apply Rmult_le_pos; lra). lra.
Qed.
Theorem TRIANGLE_NORMAL_holds : forall v1 v2 v3 sq V1 V2 V3, bp (-400) <= len v1 v2 v3 <= bp 400 -> plain (tsq v1 v2
  v3) sq ->
  len (v1 - V1) (v2 - V2) (v3 - V3) <= (102 / 100) * u * len v1 v2 v3 -> let l := RN (sqrt sq) in let M := len V1 V2
    V3 in
  len (RN (v1 / l) - V1 / M) (RN (v2 / l) - V2 / M) (RN (v3 / l) - V3 / M) <= TRIANGLE_NORMAL * u.
Proof.
  intros v1 v2 v3 sq V1 V2 V3 Range Hsq H l M. eapply Rle_trans; [now apply divided|]. unfold TRIANGLE_NORMAL. pose
    proof u_pos. lra.
Qed.
(* At a hit of a sphere: the vector v from the center, within e, over the radius. *)
Theorem DIVISION_holds : forall v1 v2 v3 N1 N2 N3 r e, 0 < r -> len N1 N2 N3 = r -> len (v1 - N1) (v2 - N2) (v3 - N3)
  <= e ->
  e / r + DIVISION * u <= TAKEN * u -> len (RN (v1 / r) - N1 / r) (RN (v2 / r) - N2 / r) (RN (v3 / r) - N3 / r) <= e /
    r + DIVISION * u.
Proof.
  intros v1 v2 v3 N1 N2 N3 r e R0 HN He Ht. pose proof u_pos. unfold DIVISION, TAKEN in *.
  assert (S : forall a b c, len (a / r) (b / r) (c / r) = len a b c / r).
  { intros. unfold Rdiv at 4. rewrite Rmult_comm, <- len_scale by (apply Rlt_le, Rinv_0_lt_compat; assumption).
    f_equal; field; lra. }
  assert (C : forall v, Rabs (RN (v / r) - v / r) <= Rabs (u * Rabs (v / r) + bp (-1075))) by (intro v; eapply
    Rle_trans; [apply RN_err | apply Rle_abs]).
  replace (len (RN (v1 / r) - N1 / r) (RN (v2 / r) - N2 / r) (RN (v3 / r) - N3 / r)) with
    (len ((RN (v1 / r) - v1 / r) + (v1 - N1) / r) ((RN (v2 / r) - v2 / r) + (v2 - N2) / r) ((RN (v3 / r) - v3 / r) +
      (v3 - N3) / r)) by (f_equal; field; lra).
  eapply Rle_trans; [apply len_add|]. rewrite S.
  assert (E1 : len (v1 - N1) (v2 - N2) (v3 - N3) / r <= e / r) by (apply Rmult_le_compat_r; [apply Rlt_le,
    Rinv_0_lt_compat; assumption | exact He]).
  assert (E2 : len (v1 / r) (v2 / r) (v3 / r) <= 1 + / 1000).
  { rewrite S. pose proof (len_sub v1 v2 v3 N1 N2 N3) as T. rewrite HN in T. apply Rmult_le_reg_r with r; [assumption|].
    replace (len v1 v2 v3 / r * r) with (len v1 v2 v3) by (field; lra). assert (e <= 6 * u * r).
    { apply Rmult_le_reg_r with (/ r); [now apply Rinv_0_lt_compat|]. replace (6 * u * r * / r) with (6 * u) by
      (field; lra). unfold Rdiv in Ht. lra. }
    rewrite u_val in *. lra. }
  assert (E3 : len (RN (v1 / r) - v1 / r) (RN (v2 / r) - v2 / r) (RN (v3 / r) - v3 / r) <= u * len (v1 / r) (v2 / r)
    (v3 / r) + 3 * bp (-1075)).
  { eapply Rle_trans; [apply (len_mono _ _ _ _ _ _ (C v1) (C v2) (C v3))|]. eapply Rle_trans; [apply len_add|].
    rewrite len_scale by lra.
    assert (A1 : len (Rabs (v1 / r)) (Rabs (v2 / r)) (Rabs (v3 / r)) = len (v1 / r) (v2 / r) (v3 / r)) by (unfold len;
      now rewrite !abs_sq). rewrite A1.
    pose proof (len_le_norm1 (bp (-1075)) (bp (-1075)) (bp (-1075))) as Z. unfold norm1 in Z. rewrite (Rabs_pos_eq (bp
      (-1075))) in Z by apply Rlt_le, bp_pos. lra. }
  assert (bp (-1075) <= / 1000 * u). { apply Rle_trans with (bp (-10) * u); [unfold u; rewrite <- bp_add; apply bp_le;
    lia | apply Rmult_le_compat_r; [lra | simpl; lra]]. }
  assert (u * len (v1 / r) (v2 / r) (v3 / r) <= u * (1 + / 1000)) by (apply Rmult_le_compat_l; lra). lra.
Qed.
Theorem TAKEN_holds : Rmax (TAKEN * u) (Rmax (UNIT_ERROR) (TRIANGLE_NORMAL * u)) <= HIT_NORMAL * u.
Proof. unfold TAKEN, UNIT_ERROR, TRIANGLE_NORMAL, HIT_NORMAL. pose proof u_pos. repeat apply Rmax_lub; lra. Qed.
Theorem HIT_NORMAL_holds : forall v1 v2 v3 N1 N2 N3 r e, 0 < r -> len N1 N2 N3 = r -> len (v1 - N1) (v2 - N2) (v3 -
  N3) <= e ->
  e / r + DIVISION * u <= TAKEN * u -> len (RN (v1 / r) - N1 / r) (RN (v2 / r) - N2 / r) (RN (v3 / r) - N3 / r) <=
    HIT_NORMAL * u.
Proof.
  intros. eapply Rle_trans; [eapply DIVISION_holds; eauto|]. eapply Rle_trans; [eassumption|]. unfold TAKEN,
    HIT_NORMAL. pose proof u_pos. lra.
Qed.
