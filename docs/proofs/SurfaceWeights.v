(* rt-geom, surface/filter.rs: the weights of the vertices at a hit in doubles, `estimated_weights`. *)
From Proofs Require Import Rounding Steps SurfaceFilter.
Open Scope R_scope.

(* The factors of the point's error and of the sum of errors, that of the normal's, and the roundings. *)
Definition PART_FACTOR := 101 / 100.
Definition SUM_FACTOR := 105 / 100.
Definition NORMAL_FACTOR := 31 / 10.
Definition ROUNDINGS := 10 * u.
(* The normal is one up to that part of it. *)
Definition LARGEST_NORMAL_ERROR := bp (-8).

(* One weight: the exact x with P.N = x N.N for vectors P = x N; the product q and the normal n as computed, the dot
  product and the square. *)
Section Weight.
Variables x N1 N2 N3 n1 n2 n3 q1 q2 q3 part nu L dot square tiny : R.
Hypotheses (Hx : Rabs x <= 1) (Hn : len (n1 - N1) (n2 - N2) (n3 - N3) <= nu) (Hq : len (q1 - x * N1) (q2 - x * N2) (q3
  - x * N3) <= part)
  (HL : L = len n1 n2 n3) (L0 : 0 < L) (Hnu : nu <= LARGEST_NORMAL_ERROR * L)
  (Hdot : Rabs (dot - (q1 * n1 + q2 * n2 + q3 * n3)) <= (3 + / 100) * u * (len q1 q2 q3 * L) + tiny * (L * L))
  (Hsquare : Rabs (square - L * L) <= (3 + / 100) * u * (L * L)) (Htiny : 0 <= tiny <= / 1000 * u).
Let weight := RN (dot / square).

Lemma weight_near : Rabs (weight - x) <= (1 + / 100) * ((part + nu) / L) + (72 / 10) * u /\ 0 <= (part + nu) / L.
Proof.
  pose proof u_pos as up. assert (B8 : LARGEST_NORMAL_ERROR = / 256) by (unfold LARGEST_NORMAL_ERROR; simpl; lra).
    rewrite B8 in Hnu.
  pose proof (len_pos (n1 - N1) (n2 - N2) (n3 - N3)). pose proof (len_pos (q1 - x * N1) (q2 - x * N2) (q3 - x * N3)).
  assert (LL : 0 < L * L) by (apply Rmult_lt_0_compat; assumption). set (S := L * L) in *.
  assert (nn : n1 * n1 + n2 * n2 + n3 * n3 = S) by (unfold S; rewrite HL; now rewrite len_sq).
  (* q.n against x n.n *)
  set (d := q1 * n1 + q2 * n2 + q3 * n3) in *.
  assert (D : Rabs (d - x * S) <= (part + nu) * L).
  { replace (d - x * S) with (((q1 - x * N1) * n1 + (q2 - x * N2) * n2 + (q3 - x * N3) * n3) - x * ((n1 - N1) * n1 +
    (n2 - N2) * n2 + (n3 - N3) * n3)) by (rewrite <- nn; unfold d; ring).
    apply Rle_trans with (part * L + 1 * (nu * L)); [|lra]. apply Rabs_minus_le.
    - eapply Rle_trans; [apply len_dot|]. rewrite <- HL. apply Rmult_le_compat_r; lra.
    - apply Rabs_mult_le; [exact Hx|]. eapply Rle_trans; [apply len_dot|]. rewrite <- HL. apply Rmult_le_compat_r;
      lra. }
  assert (QL : len q1 q2 q3 * L <= (1 + / 200) * S + part * L).
  { pose proof (len_sub q1 q2 q3 (x * N1) (x * N2) (x * N3)) as T. pose proof (len_sub N1 N2 N3 n1 n2 n3) as T2.
    rewrite <- HL in T2.
    assert (E : len (N1 - n1) (N2 - n2) (N3 - n3) = len (n1 - N1) (n2 - N2) (n3 - N3)) by (unfold len; f_equal; ring).
      rewrite E in T2.
    assert (XN : len (x * N1) (x * N2) (x * N3) <= (1 + / 200) * L).
    { apply Rle_trans with (1 * len N1 N2 N3); [|lra]. apply len_part; try lra; rewrite Rabs_mult; apply
      Rmult_le_compat_r; try apply Rabs_pos; assumption. }
    apply Rle_trans with (((1 + / 200) * L + part) * L); [apply Rmult_le_compat_r; lra | unfold S; lra]. }
  set (pe := (part + nu) / L). assert (pl : pe * S = (part + nu) * L) by (unfold pe, S; field; lra).
  assert (pe0 : 0 <= pe) by (unfold pe; apply Rmult_le_pos; [lra | apply Rlt_le, Rinv_0_lt_compat; assumption]).
    assert (pS : part * L <= pe * S) by (rewrite pl; apply Rmult_le_compat_r; lra).
  assert (tS : tiny * S <= / 1000 * u * S) by (apply Rmult_le_compat_r; lra). assert (peS : 0 <= pe * S) by (apply
    Rmult_le_pos; lra).
  rewrite <- pl in D. set (ps := pe * S) in *.
  assert (G : Rabs (dot - x * S) <= (1 + 4 * u) * ps + (304 / 100) * u * S).
  { replace (dot - x * S) with ((dot - d) + (d - x * S)) by ring. eapply Rle_trans; [apply Rabs_plus_le; [exact Hdot |
    exact D]|].
    assert ((3 + / 100) * u * (len q1 q2 q3 * L) <= (3 + / 100) * u * ((1 + / 200) * S + part * L)) by (apply
      Rmult_le_compat_l; lra).
    clear - H1 tS pS LL peS. rewrite u_val in *. lra. }
  pose proof Hsquare as Hs. apply Rabs_le_inv in Hs. assert (sq0 : 0 < square) by (rewrite u_val in *; lra).
  assert (Q : Rabs (dot / square - x) <= (1 + 10 * u) * pe + (607 / 100) * u).
  { apply Rmult_le_reg_r with square; [assumption|]. rewrite <- (Rabs_pos_eq square) at 2 by lra. rewrite <- Rabs_mult.
    replace ((dot / square - x) * square) with ((dot - x * S) - x * (square - S)) by (field; lra).
    apply Rle_trans with ((1 + 4 * u) * ps + (304 / 100) * u * S + 1 * ((3 + / 100) * u * S)); [apply Rabs_minus_le;
      [exact G | apply Rabs_mult_le; assumption]|].
    apply Rle_trans with (((1 + 10 * u) * pe + 607 / 100 * u) * ((1 - 4 * u) * S)).
    - replace (((1 + 10 * u) * pe + 607 / 100 * u) * ((1 - 4 * u) * S)) with ((1 + 10 * u) * (1 - 4 * u) * ps + 607 /
      100 * u * (1 - 4 * u) * S) by (unfold ps; ring). clear - peS LL. rewrite u_val. lra.
    - apply Rmult_le_compat_l; [assert (0 <= 10 * u * pe) by (apply Rmult_le_pos; lra); lra | rewrite u_val in *;
      lra]. }
  split; [|exact pe0].
  assert (T : bp (-1075) <= / 1000 * u).
  { apply Rle_trans with (bp (-10) * u); [unfold u; rewrite <- bp_add; apply bp_le; lia | apply Rmult_le_compat_r;
    [lra | simpl; lra]]. }
  pose proof (RN_err (dot / square)) as E. fold weight in E.
  assert (A : Rabs (dot / square) <= 1 + ((1 + 10 * u) * pe + (607 / 100) * u)).
  { replace (dot / square) with ((dot / square - x) + x) by ring. eapply Rle_trans; [apply Rabs_plus_le; [exact Q |
    exact Hx]|]. lra. }
  replace (weight - x) with ((weight - dot / square) + (dot / square - x)) by ring. eapply Rle_trans; [apply
    Rabs_plus_le; [exact E | exact Q]|].
  assert (u * Rabs (dot / square) <= u * (1 + ((1 + 10 * u) * pe + (607 / 100) * u))) by (apply Rmult_le_compat_l;
    lra). rewrite u_val in *. lra.
Qed.
(* The bound, with the length of n as computed, and without what underflows in a product. *)
Variables length part' error : R.
Hypotheses (Hlen : Rabs (length - L) <= 4 * u * L) (Hpart : (1 - 8 * u) * part <= part' + / 100 * u * L)
  (Herror : (1 - 16 * u) * (SUM_FACTOR * ((part' + NORMAL_FACTOR * nu) / length) + ROUNDINGS) <= error).
Theorem SUM_FACTOR_holds : Rabs (weight - x) <= error.
Proof.
  destruct weight_near as [W P]. eapply Rle_trans; [exact W|]. eapply Rle_trans; [|exact Herror]. pose proof u_pos as
    up. unfold SUM_FACTOR, NORMAL_FACTOR, ROUNDINGS.
  pose proof (len_pos (n1 - N1) (n2 - N2) (n3 - N3)). pose proof (len_pos (q1 - x * N1) (q2 - x * N2) (q3 - x * N3)).
    apply Rabs_le_inv in Hlen.
  assert (l0 : 0 < length) by (rewrite u_val in *; lra).
  assert (K : (1 - 20 * u) * ((part + nu) / L) <= (part' + 31 / 10 * nu) / length + / 50 * u).
  { apply Rmult_le_reg_r with (L * length); [apply Rmult_lt_0_compat; assumption|].
    rewrite Rmult_plus_distr_r.
    replace ((1 - 20 * u) * ((part + nu) / L) * (L * length)) with ((1 - 20 * u) * (part + nu) * length) by (field;
      lra).
    replace ((part' + 31 / 10 * nu) / length * (L * length)) with ((part' + 31 / 10 * nu) * L) by (field; lra).
    apply Rle_trans with ((1 - 20 * u) * (part + nu) * ((1 + 4 * u) * L)).
    - apply Rmult_le_compat_l; [apply Rmult_le_pos; [rewrite u_val; lra | lra] | lra].
    - assert (PL : (1 - 8 * u) * part * L <= (part' + / 100 * u * L) * L) by (apply Rmult_le_compat_r; lra).
      assert (LL : (1 - 4 * u) * (L * L) <= L * length).
      { replace ((1 - 4 * u) * (L * L)) with (L * ((1 - 4 * u) * L)) by ring. apply Rmult_le_compat_l; lra. }
      assert (pL : 0 <= part * L) by (apply Rmult_le_pos; lra). assert (nL : 0 <= nu * L) by (apply Rmult_le_pos; lra).
      assert (L2 : 0 < L * L) by (apply Rmult_lt_0_compat; assumption).
      set (a := part * L) in *. set (b := nu * L) in *. set (c := L * L) in *. set (d := L * length) in *.
      replace ((1 - 20 * u) * (part + nu) * ((1 + 4 * u) * L)) with ((1 - 20 * u) * (1 + 4 * u) * (a + b)) by (unfold a,
        b; ring).
      replace ((part' + 31 / 10 * nu) * L) with (part' * L + 31 / 10 * b) by (unfold b; ring).
      replace ((1 - 8 * u) * part * L) with ((1 - 8 * u) * a) in PL by (unfold a; ring).
      replace ((part' + / 100 * u * L) * L) with (part' * L + / 100 * u * c) in PL by (unfold c; ring).
      set (f := part' * L) in *. clear - PL LL pL nL L2. clearbody a b c d f. rewrite u_val in *. lra. }
  set (y := (part + nu) / L) in *. set (z := (part' + 31 / 10 * nu) / length) in *. clear - K P. rewrite u_val in *.
    lra.
Qed.
Theorem ROUNDINGS_holds : part = 0 -> nu = 0 -> Rabs (weight - x) <= (1 - 16 * u) * ROUNDINGS.
Proof.
  intros P Z. destruct weight_near as [W _]. rewrite P, Z in W. replace ((0 + 0) / L) with 0 in W by (field; lra).
    unfold ROUNDINGS. pose proof u_pos. rewrite u_val in *. lra.
Qed.
Theorem NORMAL_FACTOR_holds : (1 + / 100) * ((part + nu) / L) <= SUM_FACTOR * ((part + NORMAL_FACTOR * nu) / L).
Proof.
  pose proof (len_pos (n1 - N1) (n2 - N2) (n3 - N3)). pose proof (len_pos (q1 - x * N1) (q2 - x * N2) (q3 - x * N3)).
    unfold SUM_FACTOR, NORMAL_FACTOR.
  apply Rle_trans with (105 / 100 * ((part + nu) / L)).
  - apply Rmult_le_compat_r; [|lra]. apply Rmult_le_pos; [lra | apply Rlt_le, Rinv_0_lt_compat; assumption].
  - apply Rmult_le_compat_l; [lra|]. apply Rmult_le_compat_r; [apply Rlt_le, Rinv_0_lt_compat; assumption | lra].
Qed.
Theorem LARGEST_NORMAL_ERROR_holds : len N1 N2 N3 <= (1 + / 256) * L.
Proof.
  pose proof (len_sub N1 N2 N3 n1 n2 n3) as T2. rewrite <- HL in T2. assert (E : len (N1 - n1) (N2 - n2) (N3 - n3) =
    len (n1 - N1) (n2 - N2) (n3 - N3)) by (unfold len; f_equal; ring).
  rewrite E in T2. assert (B8 : LARGEST_NORMAL_ERROR = / 256) by (unfold LARGEST_NORMAL_ERROR; simpl; lra). rewrite B8
    in Hnu. lra.
Qed.
End Weight.

(* The product of the vector p from the first vertex to the point with an edge f, of components at most M with sum E:
  three roundings of terms of
   together norm(p) E at most, and the error of p, that of the point and u of itself. *)
Section Part.
Variables p1 p2 p3 P1 P2 P3 a1 a2 a3 b1 b2 b3 E eps part : R.
Let f1 := b1 - a1. Let f2 := b2 - a2. Let f3 := b3 - a3.
Hypotheses (HE : norm1 f1 f2 f3 <= E) (Bp1 : Rabs p1 <= bp 410) (Bp2 : Rabs p2 <= bp 410) (Bp3 : Rabs p3 <= bp 410)
  (Bf1 : Rabs f1 <= bp 301) (Bf2 : Rabs f2 <= bp 301) (Bf3 : Rabs f3 <= bp 301)
  (Hp : len (p1 - P1) (p2 - P2) (p3 - P3) <= eps + (1 + / 1000) * u * norm1 p1 p2 p3) (e0 : 0 <= eps).
Definition tpart x2 x3 y2 z2 y3 z3 := tminor (X x2 410) (D z3 y3 301) (X x3 410) (D z2 y2 301).
Variables q1 q2 q3 tiny : R.
Hypotheses (H1 : plain (tpart p2 p3 a2 b2 a3 b3) q1) (H2 : plain (tpart p3 p1 a3 b3 a1 b1) q2) (H3 : plain (tpart p1
  p2 a1 b1 a2 b2) q3)
  (Htiny : 3 * bp (-1068) <= tiny).
Theorem PART_FACTOR_holds : (1 - 16 * u) * (E * (PART_FACTOR * (eps + 102 / 100 * u * norm1 p1 p2 p3) + 61 / 10 * u *
  norm1 p1 p2 p3)) + tiny <= part ->
  len (q1 - (P2 * f3 - P3 * f2)) (q2 - (P3 * f1 - P1 * f3)) (q3 - (P1 * f2 - P2 * f1)) <= part.
Proof.
  intro Hb. pose proof u_pos as up.
  assert (B1 : bounded (tpart p2 p3 a2 b2 a3 b3)) by (unfold tpart, tminor; cbn [bounded]; repeat split; assumption).
  assert (B2 : bounded (tpart p3 p1 a3 b3 a1 b1)) by (unfold tpart, tminor; cbn [bounded]; repeat split; assumption).
  assert (B3 : bounded (tpart p1 p2 a1 b1 a2 b2)) by (unfold tpart, tminor; cbn [bounded]; repeat split; assumption).
  pose proof (plain_error_at _ _ 3 (low (tpart p2 p3 a2 b2 a3 b3)) H1 B1 eq_refl eq_refl ltac:(lia)) as Q1.
  pose proof (plain_error_at _ _ 3 (low (tpart p3 p1 a3 b3 a1 b1)) H2 B2 eq_refl eq_refl ltac:(lia)) as Q2.
  pose proof (plain_error_at _ _ 3 (low (tpart p1 p2 a1 b1 a2 b2)) H3 B3 eq_refl eq_refl ltac:(lia)) as Q3.
  assert (T1 : bp (low (tpart p2 p3 a2 b2 a3 b3)) <= bp (-1068)) by (apply bp_le; vm_compute; discriminate).
  assert (T2 : bp (low (tpart p3 p1 a3 b3 a1 b1)) <= bp (-1068)) by (apply bp_le; vm_compute; discriminate).
  assert (T3 : bp (low (tpart p1 p2 a1 b1 a2 b2)) <= bp (-1068)) by (apply bp_le; vm_compute; discriminate).
  set (w1 := bp (low (tpart p2 p3 a2 b2 a3 b3))) in *. set (w2 := bp (low (tpart p3 p1 a3 b3 a1 b1))) in *. set (w3 :=
    bp (low (tpart p1 p2 a1 b1 a2 b2))) in *. clearbody w1 w2 w3.
  unfold tpart, tminor in Q1, Q2, Q3. cbn [exact size] in Q1, Q2, Q3. fold f1 f2 f3 in Q1, Q2, Q3.
  (* what p is off by *)
  set (np := norm1 p1 p2 p3) in *. assert (np0 : 0 <= np) by apply norm1_pos. set (le := len (p1 - P1) (p2 - P2) (p3 -
    P3)) in *.
  assert (C : len ((p2 - P2) * f3 - (p3 - P3) * f2) ((p3 - P3) * f1 - (p1 - P1) * f3) ((p1 - P1) * f2 - (p2 - P2) *
    f1) <= le * E).
  { assert (E0 : 0 <= E) by (pose proof (norm1_pos f1 f2 f3); lra). assert (le0 : 0 <= le) by apply len_pos.
    apply Rle_trans with (le * len f1 f2 f3); [|apply Rmult_le_compat_l; [assumption | eapply Rle_trans; [apply
      len_le_norm1 | exact HE]]].
    apply below_root; [apply Rmult_le_pos; [assumption | apply len_pos]|]. rewrite len_sq.
    replace (le * len f1 f2 f3 * (le * len f1 f2 f3)) with ((le * le) * (len f1 f2 f3 * len f1 f2 f3)) by ring. unfold
      le. rewrite !len_sq.
    pose proof (lagrange (p1 - P1) (p2 - P2) (p3 - P3) f1 f2 f3) as G. pose proof (sq_pos ((p1 - P1) * f1 + (p2 - P2)
      * f2 + (p3 - P3) * f3)). lra. }
  assert (S : Rabs p2 * Rabs f3 + Rabs p3 * Rabs f2 + (Rabs p3 * Rabs f1 + Rabs p1 * Rabs f3) + (Rabs p1 * Rabs f2 +
    Rabs p2 * Rabs f1) <= np * E).
  { apply Rle_trans with (np * norm1 f1 f2 f3); [|apply Rmult_le_compat_l; assumption]. unfold np, norm1. pose proof
    (Rabs_pos p1). pose proof (Rabs_pos p2). pose proof (Rabs_pos p3).
    pose proof (Rabs_pos f1). pose proof (Rabs_pos f2). pose proof (Rabs_pos f3).
    pose proof (Rmult_le_pos (Rabs p1) (Rabs f1)). pose proof (Rmult_le_pos (Rabs p2) (Rabs f2)). pose proof
      (Rmult_le_pos (Rabs p3) (Rabs f3)). lra. }
  eapply Rle_trans; [|exact Hb].
  replace (len (q1 - (P2 * f3 - P3 * f2)) (q2 - (P3 * f1 - P1 * f3)) (q3 - (P1 * f2 - P2 * f1))) with
    (len ((q1 - (p2 * f3 - p3 * f2)) + ((p2 - P2) * f3 - (p3 - P3) * f2)) ((q2 - (p3 * f1 - p1 * f3)) + ((p3 - P3) *
      f1 - (p1 - P1) * f3))
      ((q3 - (p1 * f2 - p2 * f1)) + ((p1 - P1) * f2 - (p2 - P2) * f1))) by (f_equal; ring).
  eapply Rle_trans; [apply len_add|]. eapply Rle_trans; [apply Rplus_le_compat; [apply len_le_norm1 | exact C]|].
    unfold norm1 at 1.
  assert (E0 : 0 <= E) by (pose proof (norm1_pos f1 f2 f3); lra).
  assert (LE : le * E <= (eps + (1 + / 1000) * u * np) * E) by (apply Rmult_le_compat_r; assumption).
  assert (0 <= np * E) by (apply Rmult_le_pos; assumption). assert (0 <= eps * E) by (apply Rmult_le_pos; assumption).
    unfold PART_FACTOR.
  replace (E * (101 / 100 * (eps + 102 / 100 * u * np) + 61 / 10 * u * np)) with (101 / 100 * (eps * E) + (101 / 100 *
    (102 / 100) + 61 / 10) * u * (np * E)) by ring.
  replace ((eps + (1 + / 1000) * u * np) * E) with (eps * E + (1 + / 1000) * u * (np * E)) in LE by ring.
  set (ne := np * E) in *. set (ee := eps * E) in *. set (l2 := le * E) in *. clear - Q1 Q2 Q3 T1 T2 T3 S LE Htiny H
    H0. rewrite u_val in *. lra.
Qed.
End Part.

(* ---- Range: what underflows is nothing beside a normal whose square is at least 2^-900 ---- *)
Theorem underflow_of_weights : forall n1 n2 n3 q1 q2 q3 dot square,
  Rabs n1 <= bp 460 -> Rabs n2 <= bp 460 -> Rabs n3 <= bp 460 -> Rabs q1 <= bp 720 -> Rabs q2 <= bp 720 ->
  Rabs q3 <= bp 720 ->
  plain (tdot (X n1 460) (X n2 460) (X n3 460) (X n1 460) (X n2 460) (X n3 460)) square ->
  plain (tdot (X q1 720) (X q2 720) (X q3 720) (X n1 460) (X n2 460) (X n3 460)) dot -> bp (-900) <= square ->
  let L := len n1 n2 n3 in
  0 < L /\ Rabs (square - L * L) <= (3 + / 100) * u * (L * L) /\ Rabs (RN (sqrt square) - L) <= 4 * u * L /\
  Rabs (dot - (q1 * n1 + q2 * n2 + q3 * n3)) <= (3 + / 100) * u * (len q1 q2 q3 * L) + / 1000 * u * (L * L) /\
  3 * bp (-1068) <= / 200 * u * L.
Proof.
  intros n1 n2 n3 q1 q2 q3 dot square N1 N2 N3 Q1 Q2 Q3 Hs Hd S0 L. pose proof u_pos as U. unfold tdot in *.
  error_of Hs E. error_of Hd K. rewrite !abs_sq in E. rewrite <- len_sq in E. fold L in E.
  assert (L0 : 0 <= L) by apply len_pos. pose proof (bp_pos (-901)) as B1.
  assert (B : bp (-900) = 2 * bp (-901)) by (change (-900)%Z with (1 + -901)%Z; rewrite bp_add, bp_1; ring).
  assert (T : bp (-1065) <= / 1000000000000 * bp (-901)) by (apply bp_part12; lia).
  assert (T2 : bp (-1065) <= / 1000000 * u * bp (-901)).
  { apply Rle_trans with (bp (-20) * u * bp (-901)); [unfold u; rewrite <- !bp_add; apply bp_le; lia|].
    apply Rmult_le_compat_r; [lra|]. apply Rmult_le_compat_r; simpl; lra. }
  assert (SL : bp (-901) <= L * L).
  { apply Rabs_le_inv in E. assert (0 <= L * L) by apply sq_pos. clear - E B S0 T B1 H. set (x := L * L) in *.
    clearbody x.
    rewrite u_val in *. lra. }
  assert (Lp : 0 < L).
  { destruct (Rle_lt_or_eq_dec 0 L L0) as [P|Z]; [exact P|]. rewrite <- Z, Rmult_0_l in SL. lra. }
  assert (TL : bp (-1065) <= / 1000000 * u * (L * L)).
  { eapply Rle_trans; [exact T2|]. apply Rmult_le_compat_l; [lra | exact SL]. }
  assert (SQ : Rabs (square - L * L) <= (3 + / 100) * u * (L * L)).
  { eapply Rle_trans; [exact E|]. assert (0 <= u * (L * L)) by (apply Rmult_le_pos; [lra | apply sq_pos]). lra. }
  split; [exact Lp|]. split; [exact SQ|]. split; [|split].
  - set (y := sqrt square). assert (YY : y * y = square) by (apply sqrt_sqrt; lra).
    assert (Y0 : 0 <= y) by apply sqrt_pos.
    assert (YL : 99 / 100 * L <= y).
    { apply below_root; [exact Y0|]. rewrite YY. replace (99 / 100 * L * (99 / 100 * L)) with (99 / 100 * (99 / 100) *
        (L *
        L)) by ring. apply Rabs_le_inv in SQ. assert (0 <= L * L) by apply sq_pos. clear - SQ H. rewrite u_val in *.
        lra. }
    assert (N : Rabs (y - L) <= 2 * u * L).
    { apply Rmult_le_reg_r with (y + L); [lra|]. rewrite <- (Rabs_pos_eq (y + L)) at 1 by lra. rewrite <- Rabs_mult.
      replace ((y - L) * (y + L)) with (square - L * L) by (rewrite <- YY; ring). eapply Rle_trans; [exact SQ|].
      replace ((3 + / 100) * u * (L * L)) with (u * L * ((3 + / 100) * L)) by ring.
      replace (2 * u * L * (y + L)) with (u * L * (2 * (y + L))) by ring.
      apply Rmult_le_compat_l; [apply Rmult_le_pos; lra | lra]. }
    assert (Yl : bp (-451) <= y).
    { apply below_root; [exact Y0|]. rewrite YY, bp_sq. apply Rle_trans with (2 := S0). apply bp_le. lia. }
    pose proof (RN_normal y) as R. rewrite (Rabs_pos_eq y) in R by exact Y0.
    assert (R' : Rabs (RN y - y) <= u * y) by (apply R; apply Rle_trans with (2 := Yl); apply bp_le; lia).
    replace (RN y - L) with ((RN y - y) + (y - L)) by ring. eapply Rle_trans; [apply Rabs_triang|].
    apply Rabs_le_inv in N as N'. clear - R' N N' Lp. set (a := Rabs (y - L)) in *. rewrite u_val in *. lra.
  - eapply Rle_trans; [exact K|]. assert (W : Rabs q1 * Rabs n1 + Rabs q2 * Rabs n2 + Rabs q3 * Rabs n3 <= len q1 q2
      q3 * L).
    { eapply Rle_trans; [apply Rle_abs|]. eapply Rle_trans; [apply len_dot|]. right. unfold L, len.
      now rewrite !abs_sq. }
    assert (UL : 0 <= u * (L * L)) by (apply Rmult_le_pos; [lra | apply sq_pos]).
    assert (W2 : (3 + / 1000) * u * (Rabs q1 * Rabs n1 + Rabs q2 * Rabs n2 + Rabs q3 * Rabs n3) <= (3 + / 100) * u *
      (len q1
      q2 q3 * L)).
    { apply Rmult_le_compat; try lra. pose proof (Rabs_pos q1). pose proof (Rabs_pos q2). pose proof (Rabs_pos q3).
      pose proof (Rmult_le_pos _ _ H (Rabs_pos n1)). pose proof (Rmult_le_pos _ _ H0 (Rabs_pos n2)).
      pose proof (Rmult_le_pos _ _ H1 (Rabs_pos n3)). lra. }
    lra.
  - assert (LL : bp (-451) <= L).
    { apply below_root; [exact L0|]. rewrite bp_sq. apply Rle_trans with (2 := SL). apply bp_le. lia. }
    apply Rle_trans with (bp (-8) * u * bp (-451)).
    + apply Rle_trans with (bp 2 * bp (-1068)); [pose proof (bp_pos (-1068)); apply Rmult_le_compat_r; simpl; lra|].
      unfold u. rewrite <- !bp_add. apply bp_le. lia.
    + pose proof (bp_pos (-451)). apply Rmult_le_compat; try lra; [apply Rmult_le_pos; [apply Rlt_le, bp_pos | lra]|].
      apply Rmult_le_compat_r; simpl; lra.
Qed.
