(* rt-shade, phong.rs: unit vectors, the cosine of a light and the alignment of its reflection, within bounds. *)
From Proofs Require Import Rounding Steps.
Open Scope R_scope.

(* The error of a unit vector whose vector is exact, and the factor of that of the vector over its length. *)
Definition UNIT_ERROR := 46 / 10 * u.
Definition UNIT_FACTOR := 101 / 100.
(* The error of the direction from a light. *)
Definition INCIDENT_ERROR := 7 * u.
(* Errors of directions are known up to here. *)
Definition LARGEST_ERROR := bp (-7).
(* The factors of the errors of both directions, and what rounding adds. *)
Definition COSINE_FACTOR := 102 / 100.
Definition COSINE_ROUNDING := 32 / 10 * u.
Definition ALIGNMENT_FACTOR := 105 / 100.
Definition ALIGNMENT_ROUNDING := 175 / 10 * u.

(* ---- The angle between a vector and one that is near it ---- *)
Lemma chord : forall x y z a b c e, len (x - a) (y - b) (z - c) <= e -> 0 < len x y z -> 128 * e <= len x y z ->
  let l := len x y z in let m := len a b c in 0 < m /\ len (x / l - a / m) (y / l - b / m) (z / l - c / m) <= (1 + /
    1000) * (e / l).
Proof.
  intros x y z a b c e He L0 Small l m. fold l in L0, Small. pose proof (len_pos (x - a) (y - b) (z - c)) as E0.
  assert (e0 : 0 <= e) by lra. pose proof (len_sub x y z a b c) as T. fold l m in T. assert (m0 : 0 < m) by lra.
    split; [exact m0|].
  set (p := x * a + y * b + z * c).
  assert (LL : l * l = x * x + y * y + z * z) by apply len_sq. assert (MM : m * m = a * a + b * b + c * c) by apply
    len_sq.
  assert (DD : len (x - a) (y - b) (z - c) * len (x - a) (y - b) (z - c) <= e * e) by (apply Rmult_le_compat;
    assumption).
  rewrite len_sq in DD. assert (PP : 2 * p >= l * l + m * m - e * e) by (rewrite LL, MM; unfold p; lra).
  assert (p0 : 0 < p).
  { assert (e * e <= l * / 128 * (l * / 128)) by (apply Rmult_le_compat; lra). assert (0 < l * l) by (apply
    Rmult_lt_0_compat; assumption).
    assert (0 < m * m) by (apply Rmult_lt_0_compat; assumption). lra. }
  (* l^2 m^2 - p^2 <= e^2 m^2 *)
  assert (SS : l * l * (m * m) - p * p <= e * e * (m * m)).
  { pose proof (lagrange x y z a b c) as G1. pose proof (lagrange (x - a) (y - b) (z - c) a b c) as G2. rewrite <- LL,
    <- MM in G1. rewrite <- MM in G2. fold p in G1.
    assert ((x - a) * (x - a) + (y - b) * (y - b) + (z - c) * (z - c) <= e * e) by exact DD.
    assert (0 <= m * m) by apply sq_pos. pose proof (sq_pos ((x - a) * a + (y - b) * b + (z - c) * c)).
    assert (((x - a) * (x - a) + (y - b) * (y - b) + (z - c) * (z - c)) * (m * m) <= e * e * (m * m)) by (apply
      Rmult_le_compat_r; assumption).
    replace ((y - b) * c - (z - c) * b) with (y * c - z * b) in G2 by ring. replace ((z - c) * a - (x - a) * c) with
      (z * a - x * c) in G2 by ring.
    replace ((x - a) * b - (y - b) * a) with (x * b - y * a) in G2 by ring. lra. }
  set (q := p / (l * m)). set (k := e / l). assert (lm : 0 < l * m) by (apply Rmult_lt_0_compat; assumption).
  assert (q0 : 0 < q) by (unfold q; apply Rmult_lt_0_compat; [assumption | apply Rinv_0_lt_compat; assumption]).
  assert (k0 : 0 <= k) by (unfold k; apply Rmult_le_pos; [assumption | apply Rlt_le, Rinv_0_lt_compat; assumption]).
  assert (K1 : k <= / 128) by (unfold k; apply Rmult_le_reg_r with l; [assumption|]; replace (e / l * l) with e by
    (field; lra); lra).
  assert (Q : 1 - q * q <= k * k).
  { apply Rmult_le_reg_r with (l * l * (m * m)); [apply Rmult_lt_0_compat; apply Rmult_lt_0_compat; assumption|].
    replace ((1 - q * q) * (l * l * (m * m))) with (l * l * (m * m) - p * p) by (unfold q; field; lra).
    replace (k * k * (l * l * (m * m))) with (e * e * (m * m)) by (unfold k; field; lra). exact SS. }
  assert (KK : k * k <= / 128 * / 128) by (apply Rmult_le_compat; lra).
  assert (Q1 : 999 / 1000 <= q) by (apply below_root; [lra|]; lra).
  assert (Q2 : q <= 1).
  { pose proof (len_dot x y z a b c) as D. fold l m p in D. rewrite Rabs_pos_eq in D by lra. apply Rmult_le_reg_r with
    (l * m); [assumption|].
    replace (q * (l * m)) with p by (unfold q; field; lra). lra. }
  apply below_root; [apply Rmult_le_pos; lra|]. rewrite len_sq.
  replace ((x / l - a / m) * (x / l - a / m) + (y / l - b / m) * (y / l - b / m) + (z / l - c / m) * (z / l - c / m))
    with
    ((x * x + y * y + z * z) / (l * l) + (a * a + b * b + c * c) / (m * m) - 2 * q) by (unfold q, p; field; lra).
  rewrite <- LL, <- MM. replace (l * l / (l * l)) with 1 by (field; lra). replace (m * m / (m * m)) with 1 by (field;
    lra).
  replace ((1 + / 1000) * k * ((1 + / 1000) * k)) with ((1 + / 1000) * (1 + / 1000) * (k * k)) by ring.
  assert ((1 - q) * (1999 / 1000) <= (1 - q) * (1 + q)) by (apply Rmult_le_compat_l; lra).
  replace ((1 - q) * (1 + q)) with (1 - q * q) in H by ring. lra.
Qed.

(* ---- The unit vector of doubles ---- *)
Section Unit.
Variables v1 v2 v3 sq : R.
Let L := len v1 v2 v3.
Hypotheses (Range : bp (-400) <= L <= bp 400).
Definition tsq x y z := tdot (X x 400) (X y 400) (X z 400) (X x 400) (X y 400) (X z 400).
Hypothesis Hsq : plain (tsq v1 v2 v3) sq.
Let inverse := RN (1 / RN (sqrt sq)).
Lemma inverse_near : 0 < L /\ Rabs (inverse * L - 1) <= (352 / 100) * u /\ 0 < inverse.
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
    * (L * L)) by ring.
    rewrite u_val in *. lra. }
  assert (W2 : Rabs (w - L) <= (1502 / 1000) * u * L).
  { apply Rmult_le_reg_r with (1999 / 1000 * L); [lra|]. apply Rle_trans with (Rabs (w - L) * (w + L)); [apply
    Rmult_le_compat_l; [apply Rabs_pos | lra]|].
    rewrite <- (Rabs_pos_eq (w + L)) by lra. rewrite <- Rabs_mult. replace ((w - L) * (w + L)) with (sq - L * L) by
      (rewrite <- ww; ring).
    replace (1502 / 1000 * u * L * (1999 / 1000 * L)) with (1502 / 1000 * (1999 / 1000) * u * (L * L)) by ring. apply
      Rabs_le.
    assert (0 <= u * (L * L)) by (apply Rmult_le_pos; [apply Rlt_le, u_pos | apply sq_pos]). lra. }
  pose proof (RN_normal w) as R1. rewrite (Rabs_pos_eq w) in R1 by lra.
  assert (LB : bp (-1022) <= 999 / 1000 * bp (-400)) by (assert (bp (-1022) <= / 1000000000000 * bp (-400)) by (apply
    bp_part12; lia); lra).
  specialize (R1 ltac:(lra)). set (r := RN w) in *. apply Rabs_le_inv in R1. apply Rabs_le_inv in W2. pose proof u_pos.
  assert (r0 : 0 < r) by (rewrite u_val in *; lra).
  assert (R2 : Rabs (r - L) <= (2503 / 1000) * u * L) by (apply Rabs_le; rewrite u_val in *; lra).
  pose proof (RN_err (1 / r)) as R3. fold inverse in R3. assert (i0 : 0 < 1 / r) by (unfold Rdiv; rewrite Rmult_1_l;
    now apply Rinv_0_lt_compat).
  rewrite (Rabs_pos_eq (1 / r)) in R3 by lra. apply Rabs_le_inv in R2.
  assert (T : bp (-1075) * L <= / 1000 * u).
  { apply Rle_trans with (bp (-1075) * bp 400); [apply Rmult_le_compat_l; [apply Rlt_le, bp_pos | lra]|].
    apply Rle_trans with (bp (-10) * u); [unfold u; rewrite <- !bp_add; apply bp_le; lia|]. apply Rmult_le_compat_r;
      [lra | simpl; lra]. }
  assert (rL : Rabs (1 / r * L - 1) <= (2504 / 1000) * u).
  { replace (1 / r * L - 1) with ((L - r) / r) by (field; lra). apply Rabs_div_le; [lra|]. rewrite (Rabs_pos_eq r) by
    lra. apply Rabs_le. rewrite u_val in *. lra. }
  assert (IL : Rabs (inverse * L - 1) <= 352 / 100 * u).
  { replace (inverse * L - 1) with ((inverse - 1 / r) * L + (1 / r * L - 1)) by ring.
    eapply Rle_trans; [apply Rabs_plus_le; [rewrite Rabs_mult, (Rabs_pos_eq L) by lra; apply Rmult_le_compat_r; [lra |
      exact R3] | exact rL]|].
    apply Rabs_le_inv in rL. replace ((u * (1 / r) + bp (-1075)) * L) with (u * (1 / r * L) + bp (-1075) * L) by ring.
      rewrite u_val in *. lra. }
  split; [exact L0|]. split; [exact IL|]. apply Rabs_le_inv in IL. apply Rnot_le_lt. intro N.
  assert (inverse * L <= 0) by (rewrite <- (Rmult_0_l L); apply Rmult_le_compat_r; lra). rewrite u_val in *. lra.
Qed.
Let c1 := RN (v1 * inverse). Let c2 := RN (v2 * inverse). Let c3 := RN (v3 * inverse).
Lemma unit_exact : len (c1 - v1 / L) (c2 - v2 / L) (c3 - v3 / L) <= (454 / 100) * u.
Proof.
  destruct inverse_near as (L0 & I & i0). pose proof u_pos.
  assert (C : forall v, Rabs (RN (v * inverse) - v / L) <= (4525 / 1000) * u * Rabs (v / L) + bp (-1075)).
  { intro v. pose proof (RN_err (v * inverse)) as R. replace (RN (v * inverse) - v / L) with ((RN (v * inverse) - v *
    inverse) + v / L * (inverse * L - 1)) by (field; lra).
    assert (V : Rabs (v * inverse) <= (1 + 4 * u) * Rabs (v / L)).
    { replace (v * inverse) with (inverse * L * (v / L)) by (field; lra). rewrite Rabs_mult. apply Rmult_le_compat_r;
      [apply Rabs_pos|]. apply Rabs_le_inv in I.
      apply Rabs_le. rewrite u_val in *. lra. }
    assert (W : Rabs (v / L * (inverse * L - 1)) <= Rabs (v / L) * (352 / 100 * u)) by (rewrite Rabs_mult; apply
      Rmult_le_compat_l; [apply Rabs_pos | exact I]).
    eapply Rle_trans; [apply Rabs_plus_le; [exact R | exact W]|]. pose proof (Rabs_pos (v / L)). rewrite u_val in *.
      lra. }
  apply Rle_trans with (len ((4525 / 1000) * u * Rabs (v1 / L) + bp (-1075)) ((4525 / 1000) * u * Rabs (v2 / L) + bp
    (-1075)) ((4525 / 1000) * u * Rabs (v3 / L) + bp (-1075))).
  - apply len_mono; (eapply Rle_trans; [apply C | apply Rle_abs]).
  - eapply Rle_trans; [apply len_add|]. rewrite len_scale by lra.
    assert (one : len (Rabs (v1 / L)) (Rabs (v2 / L)) (Rabs (v3 / L)) = 1).
    { unfold len at 1. rewrite !abs_sq. replace (v1 / L * (v1 / L) + v2 / L * (v2 / L) + v3 / L * (v3 / L)) with ((v1
      * v1 + v2 * v2 + v3 * v3) / (L * L)) by (field; lra).
      rewrite <- (len_sq v1 v2 v3). fold L. replace (L * L / (L * L)) with 1 by (field; lra). apply sqrt_1. }
    rewrite one. pose proof (len_le_norm1 (bp (-1075)) (bp (-1075)) (bp (-1075))) as K. unfold norm1 in K. rewrite
      (Rabs_pos_eq (bp (-1075))) in K by apply Rlt_le, bp_pos.
    assert (bp (-1075) <= / 1000 * u). { apply Rle_trans with (bp (-10) * u); [unfold u; rewrite <- bp_add; apply
      bp_le; lia | apply Rmult_le_compat_r; [lra | simpl; lra]]. }
    lra.
Qed.
(* The vector is within e of the exact one V: the unit vector as computed is within the bound of its direction. *)
Variables V1 V2 V3 e : R.
Hypotheses (He : len (v1 - V1) (v2 - V2) (v3 - V3) <= e) (Small : 128 * e <= L).
Let M := len V1 V2 V3.
Theorem UNIT_FACTOR_holds : len (c1 - V1 / M) (c2 - V2 / M) (c3 - V3 / M) <= (1 - 8 * u) * (UNIT_FACTOR * (e *
  inverse) + UNIT_ERROR).
Proof.
  destruct inverse_near as (L0 & I & i0). destruct (chord v1 v2 v3 V1 V2 V3 e He L0 Small) as [_ C]. cbv zeta in C.
    fold L M in C.
  pose proof unit_exact as E. pose proof (len_pos (v1 - V1) (v2 - V2) (v3 - V3)). pose proof u_pos.
  replace (len (c1 - V1 / M) (c2 - V2 / M) (c3 - V3 / M)) with
    (len ((c1 - v1 / L) + (v1 / L - V1 / M)) ((c2 - v2 / L) + (v2 / L - V2 / M)) ((c3 - v3 / L) + (v3 / L - V3 / M)))
      by (f_equal; ring).
  eapply Rle_trans; [apply len_add|]. assert (K : (1 - 4 * u) * (e / L) <= e * inverse).
  { apply Rmult_le_reg_r with L; [assumption|]. replace ((1 - 4 * u) * (e / L) * L) with (e * (1 - 4 * u)) by (field;
    lra).
    replace (e * inverse * L) with (e * (inverse * L)) by ring. apply Rmult_le_compat_l; [lra|]. apply Rabs_le_inv in
      I. rewrite u_val in *. lra. }
  assert (0 <= e / L) by (apply Rmult_le_pos; [lra | apply Rlt_le, Rinv_0_lt_compat; assumption]). unfold UNIT_FACTOR,
    UNIT_ERROR.
  set (x := e / L) in *. set (y := e * inverse) in *. clear - C E K H1. rewrite u_val in *. lra.
Qed.
Theorem UNIT_ERROR_holds : e = 0 -> len (c1 - V1 / M) (c2 - V2 / M) (c3 - V3 / M) <= (1 - 8 * u) * UNIT_ERROR.
Proof. intro Z. pose proof UNIT_FACTOR_holds as H. rewrite Z, Rmult_0_l, Rmult_0_r, Rplus_0_l in H. exact H. Qed.
End Unit.

(* ---- The direction from a light: v = (point - light) + offset, each rounded ---- *)
Theorem INCIDENT_ERROR_holds : forall v1 v2 v3 sq p1 p2 p3 l1 l2 l3 o1 o2 o3 V1 V2 V3 e ep, let L := len v1 v2 v3 in
  F p1 -> F p2 -> F p3 -> F l1 -> F l2 -> F l3 -> F o1 -> F o2 -> F o3 ->
  v1 = RN (RN (p1 - l1) + o1) -> v2 = RN (RN (p2 - l2) + o2) -> v3 = RN (RN (p3 - l3) + o3) ->
  len (p1 - l1 + o1 - V1) (p2 - l2 + o2 - V2) (p3 - l3 + o3 - V3) <= e -> bp (-400) <= L <= bp 400 -> plain (tsq v1 v2
    v3) sq ->
  (1 - 8 * u) * (e + 101 / 100 * u * norm1 o1 o2 o3) <= ep -> 130 * ep <= L ->
  let i := RN (1 / RN (sqrt sq)) in let M := len V1 V2 V3 in
  len (RN (v1 * i) - V1 / M) (RN (v2 * i) - V2 / M) (RN (v3 * i) - V3 / M) <= (1 - 8 * u) * (UNIT_FACTOR * (ep * i) +
    INCIDENT_ERROR).
Proof.
  intros v1 v2 v3 sq p1 p2 p3 l1 l2 l3 o1 o2 o3 V1 V2 V3 e ep L Fp1 Fp2 Fp3 Fl1 Fl2 Fl3 Fo1 Fo2 Fo3 E1 E2 E3 He Range
    Hsq Hep Small i M.
  pose proof u_pos. pose proof (bp_pos (-400)). assert (L0 : 0 < L) by lra.
  assert (C : forall p l o v, F p -> F l -> F o -> v = RN (RN (p - l) + o) -> Rabs (v - (p - l + o)) <= (2 + 9 * u) *
    u * Rabs v + (1 + 9 * u) * u * Rabs o).
  { intros p l o v Fp Fl Fo E. pose proof (RN_diff p l Fp Fl) as A. pose proof (RN_sum _ o (RN_F (p - l)) Fo) as B.
    rewrite <- E in B.
    set (x := RN (p - l)) in *. pose proof (Rabs_triang_inv (x + o) v) as T1. rewrite (Rabs_minus_sym (x + o)) in T1.
    pose proof (Rabs_triang (x + o) (- o)) as T2. replace (x + o + - o) with x in T2 by ring. rewrite Rabs_Ropp in T2.
    pose proof (Rabs_triang_inv (p - l) x) as T3. rewrite (Rabs_minus_sym (p - l)) in T3. pose proof (Rabs_pos v).
      pose proof (Rabs_pos o).
    pose proof (Rabs_pos (p - l)). pose proof (Rabs_pos (x + o)).
    replace (v - (p - l + o)) with ((v - (x + o)) + (x - (p - l))) by ring. eapply Rle_trans; [apply Rabs_triang|].
      rewrite u_val in *. lra. }
  pose proof (C p1 l1 o1 v1 Fp1 Fl1 Fo1 E1) as C1. pose proof (C p2 l2 o2 v2 Fp2 Fl2 Fo2 E2) as C2. pose proof (C p3
    l3 o3 v3 Fp3 Fl3 Fo3 E3) as C3. clear C.
  assert (R : len (v1 - (p1 - l1 + o1)) (v2 - (p2 - l2 + o2)) (v3 - (p3 - l3 + o3)) <= (2 + 9 * u) * u * L + (1 + 9 *
    u) * u * norm1 o1 o2 o3).
  { eapply Rle_trans; [apply (len_mono _ _ _ ((2 + 9 * u) * u * Rabs v1 + (1 + 9 * u) * u * Rabs o1) ((2 + 9 * u) * u
    * Rabs v2 + (1 + 9 * u) * u * Rabs o2)
      ((2 + 9 * u) * u * Rabs v3 + (1 + 9 * u) * u * Rabs o3))|].
    - eapply Rle_trans; [exact C1 | apply Rle_abs].
    - eapply Rle_trans; [exact C2 | apply Rle_abs].
    - eapply Rle_trans; [exact C3 | apply Rle_abs].
    - eapply Rle_trans; [apply len_add|]. rewrite !len_scale by (rewrite u_val; lra).
      assert (A1 : len (Rabs v1) (Rabs v2) (Rabs v3) = L) by (unfold L, len; now rewrite !abs_sq). rewrite A1.
      assert (A2 : len (Rabs o1) (Rabs o2) (Rabs o3) <= norm1 o1 o2 o3) by (pose proof (len_le_norm1 (Rabs o1) (Rabs
        o2) (Rabs o3)) as K; unfold norm1 in *; now rewrite !Rabs_Rabsolu in K).
      apply Rplus_le_compat_l. apply Rmult_le_compat_l; [rewrite u_val; lra | exact A2]. }
  set (no := norm1 o1 o2 o3) in *. assert (no0 : 0 <= no) by apply norm1_pos.
  set (et := e + ((2 + 9 * u) * u * L + (1 + 9 * u) * u * no)).
  assert (e0 : 0 <= e) by (pose proof (len_pos (p1 - l1 + o1 - V1) (p2 - l2 + o2 - V2) (p3 - l3 + o3 - V3)); lra).
  assert (V : len (v1 - V1) (v2 - V2) (v3 - V3) <= et).
  { replace (len (v1 - V1) (v2 - V2) (v3 - V3)) with (len ((v1 - (p1 - l1 + o1)) + (p1 - l1 + o1 - V1)) ((v2 - (p2 -
    l2 + o2)) + (p2 - l2 + o2 - V2))
      ((v3 - (p3 - l3 + o3)) + (p3 - l3 + o3 - V3))) by (f_equal; ring). eapply Rle_trans; [apply len_add|]. unfold
        et. lra. }
  assert (Et : et <= (1 + 20 * u) * ep + (2 + 9 * u) * u * L) by (unfold et; clear - Hep no0 e0; rewrite u_val in *;
    lra).
  assert (S : 128 * et <= L) by (rewrite u_val in *; lra).
  destruct (inverse_near v1 v2 v3 sq Range Hsq) as (_ & I & i0). fold L i in I. fold i in i0.
  destruct (chord v1 v2 v3 V1 V2 V3 et V L0 S) as [_ CH]. cbv zeta in CH. fold L M in CH. pose proof (unit_exact v1 v2
    v3 sq Range Hsq) as UE. fold L i in UE.
  replace (len (RN (v1 * i) - V1 / M) (RN (v2 * i) - V2 / M) (RN (v3 * i) - V3 / M)) with
    (len ((RN (v1 * i) - v1 / L) + (v1 / L - V1 / M)) ((RN (v2 * i) - v2 / L) + (v2 / L - V2 / M)) ((RN (v3 * i) - v3
      / L) + (v3 / L - V3 / M))) by (f_equal; ring).
  eapply Rle_trans; [apply len_add|].
  assert (ep0 : 0 <= ep) by (rewrite u_val in *; lra).
  assert (K : (1 - 4 * u) * (ep / L) <= ep * i).
  { apply Rmult_le_reg_r with L; [assumption|]. replace ((1 - 4 * u) * (ep / L) * L) with (ep * (1 - 4 * u)) by
    (field; lra).
    replace (ep * i * L) with (ep * (i * L)) by ring. apply Rmult_le_compat_l; [lra|]. apply Rabs_le_inv in I. rewrite
      u_val in *. lra. }
  assert (K2 : et / L <= (1 + 20 * u) * (ep / L) + (2 + 9 * u) * u).
  { apply Rmult_le_reg_r with L; [assumption|]. replace (et / L * L) with et by (field; lra).
    replace (((1 + 20 * u) * (ep / L) + (2 + 9 * u) * u) * L) with ((1 + 20 * u) * ep + (2 + 9 * u) * u * L) by
      (field; lra). exact Et. }
  assert (0 <= ep / L) by (apply Rmult_le_pos; [lra | apply Rlt_le, Rinv_0_lt_compat; assumption]). unfold
    UNIT_FACTOR, INCIDENT_ERROR.
  set (x := ep / L) in *. set (y := ep * i) in *. set (z := et / L) in *. clear - CH UE K K2 H1. rewrite u_val in *.
    lra.
Qed.

(* ---- Cosine and alignment ---- *)
Section Directions.
(* exact unit vectors, as known, within i, n and j *)
Variables L1 L2 L3 N1 N2 N3 D1 D2 D3 l1 l2 l3 n1 n2 n3 d1 d2 d3 i n : R.
Hypotheses (UL : len L1 L2 L3 = 1) (UN : len N1 N2 N3 = 1) (UD : len D1 D2 D3 = 1)
  (HL : len (l1 - L1) (l2 - L2) (l3 - L3) <= i) (HN : len (n1 - N1) (n2 - N2) (n3 - N3) <= n) (HD : len (d1 - D1) (d2
    - D2) (d3 - D3) <= UNIT_ERROR)
  (Si : i <= LARGEST_ERROR) (Sn : n <= LARGEST_ERROR).
Lemma known : 0 <= i /\ 0 <= n /\ i <= / 128 /\ n <= / 128 /\ len l1 l2 l3 <= 1 + i /\ len n1 n2 n3 <= 1 + n /\ len d1
  d2 d3 <= 1 + UNIT_ERROR.
Proof.
  assert (B : LARGEST_ERROR = / 128) by (unfold LARGEST_ERROR; simpl; lra). pose proof (len_pos (l1 - L1) (l2 - L2)
    (l3 - L3)).
  pose proof (len_pos (n1 - N1) (n2 - N2) (n3 - N3)). pose proof (len_sub l1 l2 l3 L1 L2 L3). pose proof (len_sub n1
    n2 n3 N1 N2 N3). pose proof (len_sub d1 d2 d3 D1 D2 D3).
  repeat split; lra.
Qed.
Lemma component1 : forall x y z k, len x y z <= k -> k <= 2 -> Rabs x <= bp 1 /\ Rabs y <= bp 1 /\ Rabs z <= bp 1.
Proof. intros. destruct (len_component x y z) as (A & B & C). rewrite bp_1. repeat split; lra. Qed.
Definition tcos x1 x2 x3 y1 y2 y3 := tdot (X x1 1) (X x2 1) (X x3 1) (X y1 1) (X y2 1) (X y3 1).
Variable cosine : R.
Hypothesis Hc : plain (tcos (- l1) (- l2) (- l3) n1 n2 n3) cosine.
Let tiny := bp (-1000).
Lemma cosine_rounded : Rabs (cosine - - (l1 * n1 + l2 * n2 + l3 * n3)) <= (305 / 100) * u.
Proof.
  destruct known as (i0 & n0 & i1 & n1' & KL & KN & _). destruct (component1 _ _ _ _ KL ltac:(lra)) as (A1 & A2 & A3).
    destruct (component1 _ _ _ _ KN ltac:(lra)) as (B1 & B2 & B3).
  assert (B : bounded (tcos (- l1) (- l2) (- l3) n1 n2 n3)) by (unfold tcos, tdot; cbn [bounded]; rewrite ?Rabs_Ropp;
    repeat split; assumption).
  pose proof (plain_error_at _ _ 3 (low (tcos (- l1) (- l2) (- l3) n1 n2 n3)) Hc B eq_refl eq_refl ltac:(lia)) as Q.
  assert (LT : bp (low (tcos (- l1) (- l2) (- l3) n1 n2 n3)) <= / 1000 * u).
  { apply Rle_trans with (bp (-10) * u); [unfold u; rewrite <- bp_add; apply bp_le; vm_compute; discriminate | apply
    Rmult_le_compat_r; [apply Rlt_le, u_pos | simpl; lra]]. }
  set (t0 := bp (low _)) in *. clearbody t0. unfold tcos, tdot in Q. cbn [exact size] in Q. rewrite !Rabs_Ropp in Q.
    pose proof (abs_dot l1 l2 l3 n1 n2 n3) as S.
  pose proof (len_pos l1 l2 l3). pose proof (len_pos n1 n2 n3).
  assert (P : len l1 l2 l3 * len n1 n2 n3 <= (1 + / 128) * (1 + / 128)) by (apply Rmult_le_compat; lra).
  replace (- (l1 * n1 + l2 * n2 + l3 * n3)) with (- l1 * n1 + - l2 * n2 + - l3 * n3) by ring. rewrite u_val in *. lra.
Qed.
Theorem COSINE_FACTOR_holds : forall e, (1 - 4 * u) * (COSINE_FACTOR * (i + n) + COSINE_ROUNDING) <= e -> let C := -
  (L1 * N1 + L2 * N2 + L3 * N3) in
  Rabs (cosine - C) <= e /\ (cosine > e -> 0 < C) /\ (cosine < - e -> C < 0).
Proof.
  intros e He C. assert (G : Rabs (cosine - C) <= e); [|split; [exact G | now apply certain_sign with (v := cosine)]].
  pose proof cosine_rounded as R. destruct known as (i0 & n0 & i1 & n1' & KL & KN & _).
  pose proof (len_dot (l1 - L1) (l2 - L2) (l3 - L3) n1 n2 n3) as X1. pose proof (len_dot L1 L2 L3 (n1 - N1) (n2 - N2)
    (n3 - N3)) as X2. rewrite UL in X2.
  assert (X3 : len (l1 - L1) (l2 - L2) (l3 - L3) * len n1 n2 n3 <= i * (1 + / 128)) by (apply Rmult_le_compat; try
    apply len_pos; lra).
  replace (cosine - C) with ((cosine - - (l1 * n1 + l2 * n2 + l3 * n3)) - ((l1 - L1) * n1 + (l2 - L2) * n2 + (l3 - L3)
    * n3)
    - (L1 * (n1 - N1) + L2 * (n2 - N2) + L3 * (n3 - N3))) by (unfold C; ring).
  eapply Rle_trans; [apply Rabs_minus_le; [apply Rabs_minus_le; [exact R | exact X1] | exact X2]|]. unfold
    COSINE_FACTOR, COSINE_ROUNDING in He.
  clear - He X3 HN i0 n0. rewrite u_val in *. lra.
Qed.
Theorem COSINE_ROUNDING_holds : Rabs (cosine - - (l1 * n1 + l2 * n2 + l3 * n3)) <= COSINE_ROUNDING.
Proof. pose proof cosine_rounded. unfold COSINE_ROUNDING. pose proof u_pos. lra. Qed.
Theorem LARGEST_ERROR_holds : i <= / 128 /\ n <= / 128.
Proof. destruct known as (_ & _ & H1 & H2 & _). split; assumption. Qed.

(* the reflected direction, l + 2 cosine n, and its alignment with the view *)
Variables r1 r2 r3 alignment : R.
Hypotheses (Hr1 : r1 = RN (l1 + RN (2 * cosine * n1))) (Hr2 : r2 = RN (l2 + RN (2 * cosine * n2))) (Hr3 : r3 = RN (l3
  + RN (2 * cosine * n3)))
  (Ha : plain (tcos (- d1) (- d2) (- d3) r1 r2 r3) alignment).
Let c := - (l1 * n1 + l2 * n2 + l3 * n3).
Let C := - (L1 * N1 + L2 * N2 + L3 * N3).
Lemma reflected : len (l1 + 2 * c * n1 - (L1 + 2 * C * N1)) (l2 + 2 * c * n2 - (L2 + 2 * C * N2)) (l3 + 2 * c * n3 -
  (L3 + 2 * C * N3)) <= i + 405 / 100 * n /\
  len (L1 + 2 * C * N1) (L2 + 2 * C * N2) (L3 + 2 * C * N3) = 1.
Proof.
  destruct known as (i0 & n0 & i1 & n1' & KL & KN & _).
  assert (NN : N1 * N1 + N2 * N2 + N3 * N3 = 1) by (rewrite <- len_sq, UN; ring).
  assert (ISO : forall x y z, let k := x * N1 + y * N2 + z * N3 in len (x - 2 * k * N1) (y - 2 * k * N2) (z - 2 * k *
    N3) = len x y z).
  { intros x y z k. unfold len. f_equal.
    replace ((x - 2 * k * N1) * (x - 2 * k * N1) + (y - 2 * k * N2) * (y - 2 * k * N2) + (z - 2 * k * N3) * (z - 2 * k
      * N3)) with
      (x * x + y * y + z * z - 4 * k * (x * N1 + y * N2 + z * N3) + 4 * (k * k) * (N1 * N1 + N2 * N2 + N3 * N3)) by
        ring. rewrite NN. fold k. ring. }
  split.
  - set (k := (l1 - L1) * N1 + (l2 - L2) * N2 + (l3 - L3) * N3). set (m := (n1 - N1) * l1 + (n2 - N2) * l2 + (n3 - N3)
    * l3).
    set (q := N1 * l1 + N2 * l2 + N3 * l3).
    assert (P1 : len (l1 - L1 - 2 * k * N1) (l2 - L2 - 2 * k * N2) (l3 - L3 - 2 * k * N3) <= i) by (unfold k; rewrite
      ISO; exact HL).
    pose proof (len_pos l1 l2 l3) as l0. pose proof (len_pos n1 n2 n3) as nn0. pose proof (len_pos (n1 - N1) (n2 - N2)
      (n3 - N3)) as nn1.
    assert (Pm : Rabs m <= n * (1 + / 128)).
    { eapply Rle_trans; [apply len_dot|]. apply Rmult_le_compat; lra. }
    assert (Pq : Rabs q <= 1 + / 128) by (pose proof (len_dot N1 N2 N3 l1 l2 l3) as X; rewrite UN in X; fold q in X;
      lra).
    assert (LS : forall x a1 a2 a3, len (x * a1) (x * a2) (x * a3) = Rabs x * len a1 a2 a3).
    { intros x a1 a2 a3. rewrite <- len_scale by apply Rabs_pos. unfold len. f_equal.
      replace (Rabs x * a1 * (Rabs x * a1) + Rabs x * a2 * (Rabs x * a2) + Rabs x * a3 * (Rabs x * a3)) with (Rabs x *
        Rabs x * (a1 * a1 + a2 * a2 + a3 * a3)) by ring.
      rewrite abs_sq. ring. }
    replace (len (l1 + 2 * c * n1 - (L1 + 2 * C * N1)) (l2 + 2 * c * n2 - (L2 + 2 * C * N2)) (l3 + 2 * c * n3 - (L3 +
      2 * C * N3))) with
      (len (l1 - L1 - 2 * k * N1 + (- 2 * m * n1 + - 2 * q * (n1 - N1))) (l2 - L2 - 2 * k * N2 + (- 2 * m * n2 + - 2 *
        q * (n2 - N2)))
        (l3 - L3 - 2 * k * N3 + (- 2 * m * n3 + - 2 * q * (n3 - N3)))) by (unfold c, C, k, m, q; f_equal; ring).
    eapply Rle_trans; [apply len_add|]. eapply Rle_trans; [apply Rplus_le_compat; [exact P1 | apply len_add]|].
      rewrite !LS, !Rabs_mult.
    replace (Rabs (-2)) with 2 by (unfold Rabs; destruct Rcase_abs; lra).
    assert (2 * Rabs m * len n1 n2 n3 <= 2 * (n * (1 + / 128)) * (1 + / 128)).
    { apply Rmult_le_compat; try lra. pose proof (Rabs_pos m). lra. }
    assert (2 * Rabs q * len (n1 - N1) (n2 - N2) (n3 - N3) <= 2 * (1 + / 128) * n).
    { apply Rmult_le_compat; try lra. pose proof (Rabs_pos q). lra. }
    lra.
  - replace (len (L1 + 2 * C * N1) (L2 + 2 * C * N2) (L3 + 2 * C * N3)) with
      (let k := L1 * N1 + L2 * N2 + L3 * N3 in len (L1 - 2 * k * N1) (L2 - 2 * k * N2) (L3 - 2 * k * N3)); [rewrite
        ISO; exact UL|].
    cbv zeta. unfold C. f_equal; ring.
Qed.
Theorem ALIGNMENT_FACTOR_holds : forall e, (1 - 8 * u) * (ALIGNMENT_FACTOR * (i + 4 * n) + ALIGNMENT_ROUNDING) <= e ->
  Rabs (alignment - - (D1 * (L1 + 2 * C * N1) + D2 * (L2 + 2 * C * N2) + D3 * (L3 + 2 * C * N3))) <= e.
Proof.
  intros e He. destruct known as (i0 & n0 & i1 & n1' & KL & KN & KD). pose proof u_pos. pose proof cosine_rounded as
    CR. fold c in CR. destruct reflected as [RF RL].
  set (R1 := L1 + 2 * C * N1) in *. set (R2 := L2 + 2 * C * N2) in *. set (R3 := L3 + 2 * C * N3) in *.
  pose proof (len_pos l1 l2 l3) as l0. pose proof (len_pos n1 n2 n3) as nn0. assert (T : bp (-1075) <= / 1000 * u).
  { apply Rle_trans with (bp (-10) * u); [unfold u; rewrite <- bp_add; apply bp_le; lia | apply Rmult_le_compat_r;
    [lra | simpl; lra]]. }
  pose proof (bp_pos (-1075)) as T0.
  assert (c1 : Rabs c <= (1 + / 128) * (1 + / 128)).
  { unfold c. rewrite Rabs_Ropp. eapply Rle_trans; [apply len_dot|]. apply Rmult_le_compat; lra. }
  assert (LC : len (l1 + 2 * c * n1) (l2 + 2 * c * n2) (l3 + 2 * c * n3) <= 104 / 100).
  { pose proof (len_sub (l1 + 2 * c * n1) (l2 + 2 * c * n2) (l3 + 2 * c * n3) R1 R2 R3). lra. }
  (* a component of the reflected direction: the two roundings and that of the cosine *)
  assert (K : forall l m r, r = RN (l + RN (2 * cosine * m)) ->
    Rabs (r - (l + 2 * c * m)) <= u * Rabs (l + 2 * c * m) + (8153 / 1000) * u * Rabs m + 3 * bp (-1075)).
  { intros l m r E. pose proof (RN_err (2 * cosine * m)) as A. set (t := RN (2 * cosine * m)) in *. pose proof (RN_err
    (l + t)) as B. rewrite <- E in B.
    pose proof (Rabs_pos m).
    assert (P1 : Rabs (2 * cosine * m - 2 * c * m) <= (61 / 10) * u * Rabs m).
    { replace (2 * cosine * m - 2 * c * m) with (2 * (cosine - c) * m) by ring. rewrite !Rabs_mult, (Rabs_pos_eq 2) by
      lra. apply Rmult_le_compat_r; lra. }
    assert (P2 : Rabs (2 * cosine * m) <= (205 / 100) * Rabs m).
    { replace (2 * cosine * m) with (2 * ((cosine - c) + c) * m) by ring. rewrite !Rabs_mult, (Rabs_pos_eq 2) by lra.
      apply Rmult_le_compat_r; [assumption|].
      pose proof (Rabs_triang (cosine - c) c). rewrite u_val in *. lra. }
    assert (P3 : Rabs (t - 2 * c * m) <= (8151 / 1000) * u * Rabs m + bp (-1075)).
    { replace (t - 2 * c * m) with ((t - 2 * cosine * m) + (2 * cosine * m - 2 * c * m)) by ring. eapply Rle_trans;
      [apply Rabs_triang|]. rewrite u_val in *. lra. }
    assert (P4 : Rabs (l + t) <= Rabs (l + 2 * c * m) + Rabs (t - 2 * c * m)).
    { replace (l + t) with ((l + 2 * c * m) + (t - 2 * c * m)) by ring. apply Rabs_triang. }
    replace (r - (l + 2 * c * m)) with ((r - (l + t)) + (t - 2 * c * m)) by ring. eapply Rle_trans; [apply
      Rabs_triang|]. rewrite u_val in *. lra. }
  pose proof (K l1 n1 r1 Hr1) as K1. pose proof (K l2 n2 r2 Hr2) as K2. pose proof (K l3 n3 r3 Hr3) as K3. clear K.
  set (x1 := l1 + 2 * c * n1) in *. set (x2 := l2 + 2 * c * n2) in *. set (x3 := l3 + 2 * c * n3) in *.
  assert (RX : len (r1 - x1) (r2 - x2) (r3 - x3) <= (927 / 100) * u).
  { eapply Rle_trans; [apply (len_mono _ _ _ (u * Rabs x1 + ((8153 / 1000) * u * Rabs n1 + 3 * bp (-1075))) (u * Rabs
    x2 + ((8153 / 1000) * u * Rabs n2 + 3 * bp (-1075)))
      (u * Rabs x3 + ((8153 / 1000) * u * Rabs n3 + 3 * bp (-1075))))|].
    - eapply Rle_trans; [|apply Rle_abs]. lra.
    - eapply Rle_trans; [|apply Rle_abs]. lra.
    - eapply Rle_trans; [|apply Rle_abs]. lra.
    - eapply Rle_trans; [apply len_add|]. eapply Rle_trans; [apply Rplus_le_compat_l, len_add|]. rewrite !len_scale by
      lra.
      assert (A1 : len (Rabs x1) (Rabs x2) (Rabs x3) = len x1 x2 x3) by (unfold len; now rewrite !abs_sq).
      assert (A2 : len (Rabs n1) (Rabs n2) (Rabs n3) = len n1 n2 n3) by (unfold len; now rewrite !abs_sq). rewrite A1,
        A2.
      pose proof (len_le_norm1 (3 * bp (-1075)) (3 * bp (-1075)) (3 * bp (-1075))) as Z. unfold norm1 in Z. rewrite
        (Rabs_pos_eq (3 * bp (-1075))) in Z by lra. rewrite len_scale in Z by lra. rewrite u_val in *. lra. }
  assert (RR : len (r1 - R1) (r2 - R2) (r3 - R3) <= i + 405 / 100 * n + (927 / 100) * u).
  { replace (len (r1 - R1) (r2 - R2) (r3 - R3)) with (len ((r1 - x1) + (x1 - R1)) ((r2 - x2) + (x2 - R2)) ((r3 - x3) +
    (x3 - R3))) by (f_equal; ring).
    eapply Rle_trans; [apply len_add|]. lra. }
  assert (LR : len r1 r2 r3 <= 104 / 100 + / 1000) by (pose proof (len_sub r1 r2 r3 x1 x2 x3); rewrite u_val in *; lra).
  (* the dot product *)
  assert (UE : UNIT_ERROR <= / 1000000) by (unfold UNIT_ERROR; rewrite u_val; lra).
  destruct (component1 _ _ _ _ KD ltac:(lra)) as (A1 & A2 & A3). destruct (component1 _ _ _ _ LR ltac:(lra)) as (B1 &
    B2 & B3).
  assert (B : bounded (tcos (- d1) (- d2) (- d3) r1 r2 r3)) by (unfold tcos, tdot; cbn [bounded]; rewrite ?Rabs_Ropp;
    repeat split; assumption).
  pose proof (plain_error_at _ _ 3 (low (tcos (- d1) (- d2) (- d3) r1 r2 r3)) Ha B eq_refl eq_refl ltac:(lia)) as Q.
  assert (LT : bp (low (tcos (- d1) (- d2) (- d3) r1 r2 r3)) <= / 1000 * u).
  { apply Rle_trans with (bp (-10) * u); [unfold u; rewrite <- bp_add; apply bp_le; vm_compute; discriminate | apply
    Rmult_le_compat_r; [lra | simpl; lra]]. }
  set (t0 := bp (low _)) in *. clearbody t0. unfold tcos, tdot in Q. cbn [exact size] in Q. rewrite !Rabs_Ropp in Q.
    pose proof (abs_dot d1 d2 d3 r1 r2 r3) as S.
  assert (P : len d1 d2 d3 * len r1 r2 r3 <= (1 + / 1000000) * (104 / 100 + / 1000)) by (apply Rmult_le_compat; try
    apply len_pos; lra).
  pose proof (len_dot (d1 - D1) (d2 - D2) (d3 - D3) r1 r2 r3) as X1. pose proof (len_dot D1 D2 D3 (r1 - R1) (r2 - R2)
    (r3 - R3)) as X2. rewrite UD in X2.
  assert (X3 : len (d1 - D1) (d2 - D2) (d3 - D3) * len r1 r2 r3 <= UNIT_ERROR * (104 / 100 + / 1000)) by (apply
    Rmult_le_compat; try apply len_pos; lra).
  replace (alignment - - (D1 * R1 + D2 * R2 + D3 * R3)) with ((alignment - (- d1 * r1 + - d2 * r2 + - d3 * r3)) - ((d1
    - D1) * r1 + (d2 - D2) * r2 + (d3 - D3) * r3)
    - (D1 * (r1 - R1) + D2 * (r2 - R2) + D3 * (r3 - R3))) by ring.
  eapply Rle_trans; [apply Rabs_minus_le; [apply Rabs_minus_le; [exact Q | exact X1] | exact X2]|]. unfold
    ALIGNMENT_FACTOR, ALIGNMENT_ROUNDING in He. unfold UNIT_ERROR in X3.
  clear - He S P X3 RR LT i0 n0. rewrite u_val in *. lra.
Qed.
Theorem ALIGNMENT_ROUNDING_holds : i = 0 -> n = 0 ->
  Rabs (alignment - - (D1 * (L1 + 2 * C * N1) + D2 * (L2 + 2 * C * N2) + D3 * (L3 + 2 * C * N3))) <= ALIGNMENT_ROUNDING.
Proof.
  intros I Z. apply ALIGNMENT_FACTOR_holds. rewrite I, Z. unfold ALIGNMENT_ROUNDING. pose proof u_pos. rewrite u_val.
    lra.
Qed.
End Directions.
