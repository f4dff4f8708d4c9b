(* rt-geom, enclosing/certify.rs: the reach at a center that is moved, `NewtonStep`. *)
From Proofs Require Import Rounding Norm Reach.
Open Scope R_scope.

(* The rounding errors of what a reach grows by, relative to the step. *)
Definition STEP_ERROR := 16 * u.

(* The distance at v + e: between |v| + u.e and that plus |e|^2 / 2|v|. *)
Theorem bend : forall v1 v2 v3 e1 e2 e3, let V := norm v1 v2 v3 in let E := norm e1 e2 e3 in
  let along := (v1 * e1 + v2 * e2 + v3 * e3) / V in 0 < V ->
  V + along <= norm (v1 + e1) (v2 + e2) (v3 + e3) <= V + along + E * E / (2 * V).
Proof.
  intros v1 v2 v3 e1 e2 e3 V E along V0. pose proof (norm_sq v1 v2 v3) as VV. pose proof (norm_sq e1 e2 e3) as EE.
  pose proof (dot_le v1 v2 v3 e1 e2 e3) as D. fold V in VV, D. fold E in EE, D.
  set (d := v1 * e1 + v2 * e2 + v3 * e3) in *.
  assert (dV : along * V = d) by (unfold along; field; lra).
  assert (N : (v1 + e1) * (v1 + e1) + (v2 + e2) * (v2 + e2) + (v3 + e3) * (v3 + e3) = V * V + 2 * d + E * E) by
    (rewrite VV, EE; unfold d; ring).
  assert (A2 : along * along <= E * E).
  { apply Rmult_le_reg_r with (V * V); [now apply Rmult_lt_0_compat|].
    replace (along * along * (V * V)) with (d * d) by (rewrite <- dV; ring). rewrite <- (abs_sq d).
    replace (E * E * (V * V)) with (V * E * (V * E)) by ring. apply mul2; split; auto using Rabs_pos. }
  split.
  - apply le_norm. rewrite N. rewrite <- dV. 
    replace ((V + along) * (V + along)) with (V * V + 2 * (along * V) + along * along) by ring. lra.
  - set (b := E * E / (2 * V)). assert (bV : 2 * (b * V) = E * E) by (unfold b; field; lra).
    assert (b0 : 0 <= b) by (unfold b; apply Rmult_le_pos; [apply sq_pos | apply Rlt_le, Rinv_0_lt_compat; lra]).
    assert (P : 0 <= V + along + b).
    { apply Rmult_le_reg_r with V; [assumption|]. rewrite Rmult_0_l, !Rmult_plus_distr_r, dV.
      pose proof (norm_arg (v1 + e1) (v2 + e2) (v3 + e3)) as NA. rewrite N in NA. pose proof (sq_pos V). lra. }
    apply norm_le; [assumption|]. rewrite N, <- dV, <- bV.
    replace ((V + along + b) * (V + along + b)) with (V * V + 2 * (along * V) + 2 * (b * V) + (along + b) * (along
      + b)) by ring.
    pose proof (sq_pos (along + b)). lra.
Qed.

Section Step.
(* the center, that of a sphere, the next center; the reach, and its error as computed *)
Variables c1 c2 c3 b1 b2 b3 t1 t2 t3 r high low E0 : R.
Let v1 := c1 - b1. Let v2 := c2 - b2. Let v3 := c3 - b3.
Let e1 := t1 - c1. Let e2 := t2 - c2. Let e3 := t3 - c3.
Let V := norm v1 v2 v3. Let E := norm e1 e2 e3.
Let R0 := V + r.
(* Reach.v: bounded by 39.1 u^2 and the error as computed at least 127.9 u^2, an inverse distance off by 5.1 u *)
Variables inverse dot : R.
Hypotheses (Hr : 0 <= r) (HV : bp (-352) <= V <= bp 352) (Hreach : Rabs (high + low - R0) <= 40 * (u * (u * R0)))
  (HE0 : 127 * (u * (u * R0)) <= E0 <= 129 * (u * (u * R0))) (Hlow : Rabs low <= (101 / 100) * (u * R0))
  (Hinverse : Rabs (inverse * V - 1) <= 6 * u).
Hypotheses (B1 : Rabs v1 <= bp 400) (B2 : Rabs v2 <= bp 400) (B3 : Rabs v3 <= bp 400) (B4 : Rabs e1 <= bp 400)
  (B5 : Rabs e2 <= bp 400) (B6 : Rabs e3 <= bp 400).
Let q := 400%Z.
Hypotheses (Hdot : plain (Add (Add (Mul (D c1 b1 q) (D t1 c1 q)) (Mul (D c2 b2 q) (D t2 c2 q))) (Mul (D c3 b3 q) (D t3
  c3 q)))
  dot).
Hypotheses (Fc1 : F c1) (Fc2 : F c2) (Fc3 : F c3) (Ft1 : F t1) (Ft2 : F t2) (Ft3 : F t3).
Let length := RN (RN (Rabs (RN (t1 - c1)) + Rabs (RN (t2 - c2))) + Rabs (RN (t3 - c3))).
Let along := RN (dot * inverse).
Let bent := RN (inverse * RN (length * length)).
Let error := RN (E0 + RN (bent + RN (STEP_ERROR * length))).
Let next := norm (v1 + e1) (v2 + e2) (v3 + e3) + r.
Lemma R0_pos : bp (-352) <= R0 /\ 0 < V. Proof. pose proof (bp_pos (-352)). unfold R0. split; lra. Qed.
Let z := u * (u * R0).
Lemma tiny : forall k, (k <= -500)%Z -> bp k <= / 100000 * z.
Proof.
  intros k H. destruct R0_pos as [L _]. pose proof u_pos.
  apply Rle_trans with (bp (-20 + (-53 + (-53 + -352)))); [apply bp_le; lia|].
  rewrite !bp_add. fold u. assert (u * (u * bp (-352)) <= z) by (unfold z; apply Rmult_le_compat_l; [lra|];
  apply Rmult_le_compat_l; lra).
  assert (bp (-20) <= / 100000) by (simpl; lra). pose proof (bp_pos (-20)). pose proof (bp_pos (-352)).
  apply Rmult_le_compat; try lra. apply Rmult_le_pos; [lra|]. apply Rmult_le_pos; lra.
Qed.
Lemma along_near : Rabs (along - (v1 * e1 + v2 * e2 + v3 * e3) / V) <= (121 / 10) * u * E + / 1000 * z /\
  Rabs along <= (1 + 20 * u) * E + / 1000 * z.
Proof.
  destruct R0_pos as [L V0]. pose proof (bp_pos (-352)) as Bp. pose proof u_pos as U.
  pose proof (norm_pos e1 e2 e3) as EP. fold E in EP.
  set (d := v1 * e1 + v2 * e2 + v3 * e3). 
  assert (P : Rabs (dot - d) <= (5 + / 1000) * u * (V * E) + bp (-900)).
  { pose proof Hdot as H. clear - H B1 B2 B3 B4 B5 B6 V0 EP U. unfold q in H. error_of H P. fold v1 v2 v3 e1 e2 e3 in P.
    eapply Rle_trans; [exact P|]. apply Rplus_le_compat.
    - apply Rmult_le_compat_l; [lra|]. eapply Rle_trans; [apply Rle_abs|]. eapply Rle_trans; [apply dot_le|].
      rewrite !norm_abs. fold V E. lra.
    - apply bp_le. lia. }
  set (i := / V). assert (i0 : 0 < i) by now apply Rinv_0_lt_compat. assert (iV : i * V = 1) by (unfold i; field; lra).
  assert (iT : i <= bp 352) by (unfold i; change 352%Z with (Z.opp (-352)); rewrite bpow_opp; apply Rinv_le_contravar;
    [apply bp_pos | apply HV]).
  assert (IN : Rabs (inverse - i) <= 6 * u * i).
  { replace (inverse - i) with ((inverse * V - 1) * i) by (replace ((inverse * V - 1) * i) with (inverse * (i * V) -
    i) by ring;
      rewrite iV; ring). rewrite Rabs_mult, (Rabs_pos_eq i) by lra. apply Rmult_le_compat_r; lra. }
  assert (DV : Rabs d <= V * E) by (apply dot_le). assert (DI : Rabs d * i <= E).
  { apply Rle_trans with (V * E * i); [apply Rmult_le_compat_r; lra|]. replace (V * E * i) with (i * V * E) by ring.
    rewrite iV. lra. }
  assert (T9 : bp (-900) * i <= / 10000 * z).
  { apply Rle_trans with (bp (-900) * bp 352); [apply Rmult_le_compat_l; [apply Rlt_le, bp_pos | assumption]|].
    rewrite <- bp_add. eapply Rle_trans; [apply tiny; lia|]. assert (0 <= z) by (unfold z; apply Rmult_le_pos; [lra|];
    apply Rmult_le_pos; lra). lra. }
  assert (PI : Rabs (dot - d) * i <= (5 + / 1000) * u * E + / 10000 * z).
  { apply Rle_trans with (((5 + / 1000) * u * (V * E) + bp (-900)) * i); [apply Rmult_le_compat_r; lra|].
    replace (((5 + / 1000) * u * (V * E) + bp (-900)) * i) with ((5 + / 1000) * u * (i * V * E)
      + bp (-900) * i) by ring.
    rewrite iV, Rmult_1_l. lra. }
  assert (UE : 0 <= u * E) by (apply Rmult_le_pos; lra). assert (z0 : 0 <= z) by (unfold z; apply Rmult_le_pos; [lra|];
    apply Rmult_le_pos; lra).
  assert (X : Rabs (dot * inverse - d * i) <= (11 + / 100) * u * E + / 5000 * z).
  { replace (dot * inverse - d * i) with ((dot - d) * inverse + d * (inverse - i)) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite !Rabs_mult. pose proof (near_le _ _ _ IN) as NI.
    rewrite (Rabs_pos_eq i) in NI by lra.
    assert (X1 : Rabs (dot - d) * Rabs inverse <= Rabs (dot - d) * ((1 + 6 * u) * i)) by (apply Rmult_le_compat_l;
      [apply Rabs_pos | lra]).
    replace (Rabs (dot - d) * ((1 + 6 * u) * i)) with ((1 + 6 * u) * (Rabs (dot - d) * i)) in X1 by ring.
    assert (X2 : (1 + 6 * u) * (Rabs (dot - d) * i) <= (1 + 6 * u) * ((5 + / 1000) * u * E + / 10000 * z)) by (apply
      Rmult_le_compat_l; lra).
    assert (X3 : Rabs d * Rabs (inverse - i) <= Rabs d * (6 * u * i)) by (apply Rmult_le_compat_l;
      [apply Rabs_pos | assumption]).
    replace (Rabs d * (6 * u * i)) with (6 * u * (Rabs d * i)) in X3 by ring.
    assert (X4 : 6 * u * (Rabs d * i) <= 6 * u * E) by (apply Rmult_le_compat_l; lra). rewrite u_val in *. lra. }
  replace (d / V) with (d * i) by (unfold i; field; lra).
  assert (DA : Rabs (d * i) <= E) by (rewrite Rabs_mult, (Rabs_pos_eq i); lra).
  pose proof (near_le _ _ _ X) as NX. pose proof (RN_err (dot * inverse)) as R. fold along in R.
  pose proof (tiny (-1075) ltac:(lia)) as T.
  assert (Y : Rabs (along - d * i) <= (121 / 10) * u * E + / 1000 * z).
  { replace (along - d * i) with ((along - dot * inverse) + (dot * inverse - d * i)) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite u_val in *. lra. }
  split; [assumption|]. pose proof (near_le _ _ _ Y). rewrite u_val in *. lra.
Qed.
Lemma length_low : (1 - 4 * u) * E <= length.
Proof.
  pose proof u_pos as U. pose proof (norm_le_sum e1 e2 e3) as NS. fold E in NS.
  assert (P : forall t c, F t -> F c -> F (Rabs (RN (t - c))) /\ (1 - u) * Rabs (t - c) <= Rabs (RN (t - c))).
  { intros t c Ft Fc. split; [apply generic_format_abs, RN_F|]. pose proof (RN_diff t c Ft Fc) as H.
    rewrite Rabs_minus_sym in H. pose proof (near_le _ _ _ H). lra. }
  destruct (P _ _ Ft1 Fc1) as [F1 P1]. destruct (P _ _ Ft2 Fc2) as [F2 P2]. destruct (P _ _ Ft3 Fc3) as [F3 P3].
  unfold length. unfold e1, e2, e3 in NS.
  set (f1 := Rabs (RN (t1 - c1))) in *. set (f2 := Rabs (RN (t2 - c2))) in *. set (f3 := Rabs (RN (t3 - c3))) in *.
  assert (Z1 : 0 <= f1) by apply Rabs_pos. assert (Z2 : 0 <= f2) by apply Rabs_pos.
  assert (Z3 : 0 <= f3) by apply Rabs_pos.
  pose proof (RN_sum f1 f2 F1 F2) as R1. set (k := RN (f1 + f2)) in *. rewrite (Rabs_pos_eq (f1 + f2)) in R1 by lra.
  apply Rabs_le_inv in R1. assert (k0 : 0 <= k) by (rewrite u_val in *; lra).
  pose proof (RN_sum k f3 (RN_F _) F3) as R2. set (m := RN (k + f3)) in *. rewrite (Rabs_pos_eq (k + f3)) in R2 by lra.
  apply Rabs_le_inv in R2. pose proof (Rabs_pos (t1 - c1)). pose proof (Rabs_pos (t2 - c2)).
  pose proof (Rabs_pos (t3 - c3)). rewrite u_val in *. lra.
Qed.
Lemma error_low : E0 + (1 - 30 * u) * (E * E / V) + (16 - / 100) * (u * E) - / 50 * z <= (1
  + 2 * u) * error /\ 0 <= error.
Proof.
  destruct R0_pos as [L V0]. pose proof (bp_pos (-352)) as Bp. pose proof u_pos as U.
  pose proof (norm_pos e1 e2 e3) as EP. fold E in EP.
  assert (z0 : 0 <= z) by (unfold z; apply Rmult_le_pos; [lra|]; apply Rmult_le_pos; lra).
  pose proof length_low as LM. pose proof (tiny (-1075) ltac:(lia)) as T2.
  assert (l0 : 0 <= length) by (apply Rle_trans with (2 := LM); apply Rmult_le_pos; [rewrite u_val; lra | assumption]).
  set (i := / V). assert (i0 : 0 < i) by now apply Rinv_0_lt_compat. assert (iV : i * V = 1) by (unfold i; field; lra).
  assert (iT : i <= bp 352) by (unfold i; change 352%Z with (Z.opp (-352)); rewrite bpow_opp; apply Rinv_le_contravar;
    [apply bp_pos | apply HV]).
  apply Rabs_le_inv in Hinverse as HI.
  assert (IL : (1 - 6 * u) * i <= inverse).
  { apply Rmult_le_reg_r with V; [assumption|]. replace ((1 - 6 * u) * i * V) with ((1 - 6 * u) * (i * V)) by ring.
    rewrite iV. lra. }
  assert (IU : inverse <= 2 * i).
  { apply Rmult_le_reg_r with V; [assumption|]. replace (2 * i * V) with (2 * (i * V)) by ring. rewrite iV.
    rewrite u_val in *. lra. }
  assert (I0 : 0 < inverse) by (apply Rlt_le_trans with (2 := IL); apply Rmult_lt_0_compat; [rewrite u_val;
    lra | assumption]).
  set (k := RN (length * length)) in *. set (ee := E * E). assert (ee0 : 0 <= ee) by apply sq_pos.
  assert (KL : (1 - 10 * u) * ee - bp (-1075) <= k).
  { pose proof (RN_err (length * length)) as R. fold k in R.
  rewrite (Rabs_pos_eq (length * length)) in R by apply sq_pos.
    assert (LL : (1 - 4 * u) * E * ((1 - 4 * u) * E) <= length * length) by (apply mul2; split; try assumption;
      apply Rmult_le_pos; [rewrite u_val; lra | assumption | rewrite u_val; lra | assumption]).
    replace ((1 - 4 * u) * E * ((1 - 4 * u) * E)) with ((1 - 4 * u) * (1 - 4 * u) * ee) in LL by (unfold ee; ring).
    apply Rabs_le_inv in R. rewrite u_val in *. lra. }
  assert (k0 : 0 <= k) by (unfold k; rewrite <- RN_0; apply RN_le, sq_pos).
  assert (TI : 2 * (bp (-1075) * i) <= / 1000 * z).
  { apply Rle_trans with (2 * (bp (-1075) * bp 352)); [apply Rmult_le_compat_l; [lra|]; apply Rmult_le_compat_l;
    [apply Rlt_le, bp_pos | assumption]|]. rewrite <- bp_add. pose proof (tiny (-1075 + 352) ltac:(lia)). lra. }
  assert (BI : (1 - 17 * u) * (ee * i) - / 1000 * z <= inverse * k).
  { apply Rle_trans with (inverse * ((1 - 10 * u) * ee) - inverse * bp (-1075)).
    - assert (inverse * bp (-1075) <= 2 * i * bp (-1075)) by (apply Rmult_le_compat_r; [apply Rlt_le, bp_pos | lra]).
      assert ((1 - 6 * u) * i * ((1 - 10 * u) * ee) <= inverse * ((1 - 10 * u) * ee)) by (apply Rmult_le_compat_r;
        [apply Rmult_le_pos; [rewrite u_val; lra | assumption] | assumption]).
      replace ((1 - 6 * u) * i * ((1 - 10 * u) * ee)) with ((1 - 6 * u) * (1 - 10 * u) * (ee * i)) in * by ring.
      assert (0 <= ee * i) by (apply Rmult_le_pos; lra). rewrite u_val in *. lra.
    - replace (inverse * ((1 - 10 * u) * ee) - inverse * bp (-1075)) with (inverse * ((1 - 10 * u) * ee - bp (-1075)))
      by ring.
      apply Rmult_le_compat_l; lra. }
  pose proof (RN_err (inverse * k)) as R1. change (RN (inverse * k)) with bent in R1.
  assert (ik : 0 <= inverse * k) by (apply Rmult_le_pos; lra). rewrite (Rabs_pos_eq (inverse * k)) in R1 by assumption.
  apply Rabs_le_inv in R1. assert (b0 : 0 <= bent) by (unfold bent; rewrite <- RN_0; apply RN_le; exact ik).
  assert (BL : (1 - 19 * u) * (ee * i) - / 500 * z <= bent) by (assert (0 <= ee * i) by (apply Rmult_le_pos; lra);
    rewrite u_val in *; lra).
  pose proof (RN_err (STEP_ERROR * length)) as R2. unfold STEP_ERROR in R2.
  assert (sl : 0 <= 16 * u * length) by (apply Rmult_le_pos; lra).
  rewrite (Rabs_pos_eq (16 * u * length)) in R2 by assumption.
  fold STEP_ERROR in R2. set (g := RN (STEP_ERROR * length)) in *. apply Rabs_le_inv in R2. unfold STEP_ERROR in *.
  assert (UL : (1 - 4 * u) * (u * E) <= u * length).
  { replace ((1 - 4 * u) * (u * E)) with (u * ((1 - 4 * u) * E)) by ring. apply Rmult_le_compat_l; lra. }
  assert (ue : 0 <= u * E) by (apply Rmult_le_pos; lra).
  assert (GL : (16 - / 1000) * (u * E) - / 1000 * z <= g) by (rewrite u_val in *; lra).
  assert (g0 : 0 <= g) by (unfold g; rewrite <- RN_0; apply RN_le; exact sl).
  pose proof (RN_err (bent + g)) as R3. rewrite (Rabs_pos_eq (bent + g)) in R3 by lra. set (h := RN (bent + g)) in *.
  apply Rabs_le_inv in R3. assert (h0 : 0 <= h) by (unfold h; rewrite <- RN_0; apply RN_le; lra).
  pose proof (RN_err (E0 + h)) as R4. rewrite (Rabs_pos_eq (E0 + h)) in R4 by (unfold z in *; lra).
  change (RN (E0 + h)) with error in R4. apply Rabs_le_inv in R4.
  assert (e0 : 0 <= error) by (unfold error; rewrite <- RN_0; apply RN_le; fold g h; unfold z in *; lra).
  split; [|assumption]. unfold Rdiv. fold ee i. assert (0 <= ee * i) by (apply Rmult_le_pos; lra).
  unfold z in *. rewrite u_val in *. lra.
Qed.
(* The reach at the next center, bracketed as in the code. *)
Lemma step_bracketed : let l := RN (low + along) in high + RN (l - error) <= next <= high + RN (l + error) /\
  Rabs (next - (high + l)) + 2 * (u * Rabs l) <= (1 - / 100) * error.
Proof.
  intro l. destruct R0_pos as [L V0]. pose proof (bp_pos (-352)) as Bp. pose proof u_pos as U.
  pose proof (norm_pos e1 e2 e3) as EP. fold E in EP.
  assert (z0 : 0 < z) by (unfold z; apply Rmult_lt_0_compat; [lra|]; apply Rmult_lt_0_compat;
    pose proof (bp_pos (-352)); lra).
  destruct along_near as [AN AL]. destruct error_low as [EL E0']. pose proof (tiny (-1075) ltac:(lia)) as T.
  destruct (bend v1 v2 v3 e1 e2 e3 V0) as [N1 N2]. fold V E in N1, N2.
  set (a := (v1 * e1 + v2 * e2 + v3 * e3) / V) in *.
  replace (E * E / (2 * V)) with (/ 2 * (E * E / V)) in N2 by (field; lra). set (b := E * E / V) in *.
  assert (b0 : 0 <= b) by (unfold b; apply Rmult_le_pos; [apply sq_pos | apply Rlt_le; now apply Rinv_0_lt_compat]).
  assert (ue : 0 <= u * E) by (apply Rmult_le_pos; lra).
  replace ((121 / 10) * u * E) with ((121 / 10) * (u * E)) in AN by ring.
  assert (ur : z = u * (u * R0)) by reflexivity. rewrite <- ur in *.
  (* low + along, and that less or plus the error *)
  assert (UL : u * Rabs low <= (101 / 100) * z) by (rewrite ur;
    replace ((101 / 100) * (u * (u * R0))) with (u * ((101 / 100) *
    (u * R0))) by ring; apply Rmult_le_compat_l; lra).
  assert (UA : u * Rabs along <= (1 + / 1000) * (u * E) + / 1000 * z).
  { apply Rle_trans with (u * ((1 + 20 * u) * E + / 1000 * z)); [apply Rmult_le_compat_l; lra|].
    replace (u * ((1 + 20 * u) * E + / 1000 * z)) with ((1 + 20 * u) * (u * E) + / 1000 * u * z) by ring.
    rewrite u_val in *. lra. }
  pose proof (RN_err (low + along)) as R1. fold l in R1. pose proof (Rabs_triang low along) as TA.
  assert (X1 : u * Rabs (low + along) <= u * Rabs low + u * Rabs along) by (rewrite <- Rmult_plus_distr_l;
    apply Rmult_le_compat_l; lra).
  assert (LN : Rabs l <= Rabs low + Rabs along + ((102 / 100) * z + (1 + / 1000) * (u * E))) by (eapply Rle_trans;
    [apply (near_le _ _ _ R1)|]; lra).
  assert (ULN : u * Rabs l <= (102 / 100) * z + (1 + / 500) * (u * E)).
  { apply Rle_trans with (u * (Rabs low + Rabs along + ((102 / 100) * z + (1 + / 1000) * (u * E)))); [apply
    Rmult_le_compat_l; lra|]. rewrite !Rmult_plus_distr_l. rewrite u_val in *. lra. }
  assert (R2 : Rabs (RN (l - error) - (l - error)) <= u * Rabs l + u * error + / 1000 * z).
  { eapply Rle_trans; [apply RN_err|]. apply Rplus_le_compat; [|lra]. rewrite <- Rmult_plus_distr_l.
    apply Rmult_le_compat_l; [lra|]. unfold Rminus. eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp,
      (Rabs_pos_eq error); lra. }
  assert (R3 : Rabs (RN (l + error) - (l + error)) <= u * Rabs l + u * error + / 1000 * z).
  { eapply Rle_trans; [apply RN_err|]. apply Rplus_le_compat; [|lra]. rewrite <- Rmult_plus_distr_l.
    apply Rmult_le_compat_l; [lra|]. eapply Rle_trans; [apply Rabs_triang|]. rewrite (Rabs_pos_eq error); lra. }
  apply Rabs_le_inv in R1, R2, R3, AN, Hreach. unfold next. set (n := norm (v1 + e1) (v2 + e2) (v3 + e3)) in *.
  assert (RR : R0 = V + r) by reflexivity. clearbody n z b a l error.
  assert (W : Rabs (n + r - (high + l)) <= (1 - / 100) * error - 2 * ((102 / 100) * z + (1 + / 500) * (u * E))).
  { clear - R1 AN Hreach UL UA X1 EL N1 N2 RR HE0 T z0 b0 ue ur. apply Rabs_le. rewrite u_val in *. split; lra. }
  split; [rewrite u_val in *; split; lra | lra].
Qed.
End Step.

(* In the words of the code: what is known of the reach at a center gives the bracket at the next one, and what
   Balance.v asks for. *)
Theorem STEP_ERROR_holds : forall c1 c2 c3 b1 b2 b3 t1 t2 t3 r high low E0 inverse dot,
  let V := norm (c1 - b1) (c2 - b2) (c3 - b3) in let R0 := V + r in let q := 400%Z in
  0 <= r -> bp (-352) <= V <= bp 352 -> Rabs (high + low - R0) <= 40 * (u * (u * R0)) ->
  127 * (u * (u * R0)) <= E0 <= 129 * (u * (u * R0)) -> Rabs low <= (101 / 100) * (u * R0) ->
  Rabs (inverse * V - 1) <= 6 * u -> Rabs (c1 - b1) <= bp 400 -> Rabs (c2 - b2) <= bp 400 -> Rabs (c3 - b3) <= bp 400 ->
  Rabs (t1 - c1) <= bp 400 -> Rabs (t2 - c2) <= bp 400 -> Rabs (t3 - c3) <= bp 400 ->
  plain (Add (Add (Mul (D c1 b1 q) (D t1 c1 q)) (Mul (D c2 b2 q) (D t2 c2 q))) (Mul (D c3 b3 q) (D t3 c3 q))) dot ->
  F c1 -> F c2 -> F c3 -> F t1 -> F t2 -> F t3 ->
  let length := RN (RN (Rabs (RN (t1 - c1)) + Rabs (RN (t2 - c2))) + Rabs (RN (t3 - c3))) in
  let bent := RN (inverse * RN (length * length)) in
  let error := RN (E0 + RN (bent + RN (STEP_ERROR * length))) in let l := RN (low + RN (dot * inverse)) in
  let next := norm (t1 - b1) (t2 - b2) (t3 - b3) + r in
  high + RN (l - error) <= next <= high + RN (l + error) /\
  Rabs (next - (high + l)) + 2 * (u * Rabs l) <= (1 - / 100) * error.
Proof.
  intros. pose proof (step_bracketed c1 c2 c3 b1 b2 b3 t1 t2 t3 r high low E0 inverse dot) as S. cbv zeta in S.
  replace (c1 - b1 + (t1 - c1)) with (t1 - b1) in S by ring. replace (c2 - b2 + (t2 - c2)) with (t2 - b2) in S by ring.
  replace (c3 - b3 + (t3 - c3)) with (t3 - b3) in S by ring. apply S; assumption.
Qed.
