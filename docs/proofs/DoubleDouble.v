(* rt-math, exact/double_double.rs: sum, product, quotient and square root of numbers of two doubles. *)
From Proofs Require Import Rounding ErrorFree.
From Flocq Require Import Plus_error Mult_error Sterbenz Relative Div_sqrt_error.
Open Scope R_scope.

(* The relative errors, in units of u^2. *)
Definition SUM := 6.
Definition PRODUCT := 9.
Definition QUOTIENT := 14.
Definition ROOT := 6.

(* high = RN(high + low) *)
Definition dd h l := F h /\ F l /\ RN (h + l) = h.
Lemma dd_low : forall h l, dd h l -> Rabs l <= u * Rabs h.
Proof.
  intros h l (Fh & Fl & H). destruct (FLT_plus_error_N_round_ex radix2 (-1074) 53 even h l Fh Fl) as (e & He & Hr).
  change (round radix2 (FLT_exp (-1074) 53) (Znearest even) (h + l)) with (RN (h + l)) in Hr. rewrite H in Hr.
  replace l with (h * e) by lra. rewrite Rabs_mult, Rmult_comm. apply Rmult_le_compat_r; [apply Rabs_pos|].
  eapply Rle_trans; [apply He|]. unfold u_ro, u. simpl. lra.
Qed.
Lemma dd_half_ulp : forall h l, dd h l -> Rabs l <= / 2 * ulp radix2 fexp h.
Proof.
  intros h l (Fh & Fl & H). pose proof (error_le_half_ulp_round radix2 fexp even (h + l)) as P.
  change (round radix2 fexp (Znearest even) (h + l)) with (RN (h + l)) in P. rewrite H in P.
  replace (h - (h + l)) with (- l) in P by ring. now rewrite Rabs_Ropp in P.
Qed.
Lemma dd_value : forall h l, dd h l -> (1 - u) * Rabs h <= Rabs (h + l) <= (1 + u) * Rabs h.
Proof.
  intros h l H. pose proof (dd_low h l H). pose proof (Rabs_triang h l). pose proof (Rabs_triang (h + l) (- l)) as T.
  replace (h + l + - l) with h in T by ring. rewrite Rabs_Ropp in T. lra.
Qed.
(* fast_two_sum gives the form that the type promises. *)
Lemma normal : forall v w, F v -> F w -> RN (v + w) + fast_two_sum_error v w = v + w -> dd (RN (v + w))
  (fast_two_sum_error v w).
Proof. intros. repeat split; try apply RN_F. now rewrite H1. Qed.

Lemma small_sum : forall v w, F v -> F w -> Rabs w <= Rabs v -> RN (v + w) + fast_two_sum_error v w = v + w.
Proof. intros. now apply fast_two_sum. Qed.

Section Add.
Variables xh xl yh yl : R.
Hypotheses (Hx : dd xh xl) (Hy : dd yh yl).
Let s := RN (xh + yh). Let s' := xh + yh - s.
Let t := RN (xl + yl). Let t' := xl + yl - t.
Let c := RN (s' + t). Let v := RN (s + c). Let v' := fast_two_sum_error s c. Let w := RN (t' + v').
Let z := xh + xl + (yh + yl).

Lemma Fxh : F xh. Proof. apply Hx. Qed.
Lemma Fxl : F xl. Proof. apply Hx. Qed.
Lemma Fyh : F yh. Proof. apply Hy. Qed.
Lemma Fyl : F yl. Proof. apply Hy. Qed.
Lemma s'_eq : s' = two_sum_error xh yh.
Proof. pose proof (two_sum xh yh Fxh Fyh). unfold s', s. lra. Qed.
Lemma t'_eq : t' = two_sum_error xl yl.
Proof. pose proof (two_sum xl yl Fxl Fyl). unfold t', t. lra. Qed.
Lemma Fs' : F s'. Proof. rewrite s'_eq. apply two_sum_error_F. Qed.
Lemma Ft' : F t'. Proof. rewrite t'_eq. apply two_sum_error_F. Qed.
Lemma s'_le : Rabs s' <= u * Rabs (xh + yh).
Proof. rewrite s'_eq. apply two_sum_error_le. apply Fxh. apply Fyh. Qed.
Lemma t'_le : Rabs t' <= u * Rabs (xl + yl) /\ Rabs t' <= u * Rabs t.
Proof. rewrite t'_eq. apply two_sum_error_le. apply Fxl. apply Fyl. Qed.
Definition good := v + v' = s + c /\ RN (v + w) + fast_two_sum_error v w = v + w /\ Rabs (v + w - z) <= SUM * (u * u)
  * Rabs z.

Lemma add_far : Rabs xh <= 2 * Rabs (xh + yh) -> Rabs yh <= Rabs xh -> good.
Proof.
  intros H1 H2. pose proof (dd_low _ _ Hx) as Lx. pose proof (dd_low _ _ Hy) as Ly. pose proof s'_le as S'.
  destruct t'_le as [T' _]. pose proof (RN_sum xl yl Fxl Fyl) as Et. fold t in Et.
  pose proof (RN_sum s' t Fs' (RN_F _)) as Ec. fold c in Ec.
  pose proof (RN_sum xh yh Fxh Fyh) as Es. fold s in Es.
  set (S := Rabs (xh + yh)) in *. assert (S0 : 0 <= S) by apply Rabs_pos.
  assert (H3 : Rabs xh + Rabs yh <= 3 * S) by (unfold S; clear - H1 H2; unfold S in H1; clear S; split_Rabs; lra).
  assert (L : Rabs (xl + yl) <= 3 * (u * S)).
  { eapply Rle_trans; [apply Rabs_triang|]. pose proof u_pos. nra. }
  assert (Et' : Rabs (t - (xl + yl)) <= 3 * (u * u * S)) by (pose proof u_pos; nra).
  assert (T1 : Rabs t' <= 3 * (u * u * S)) by (pose proof u_pos; nra).
  assert (T0 : Rabs t <= 3 * (u * S) + 3 * (u * u * S)).
  { replace t with ((t - (xl + yl)) + (xl + yl)) by ring. eapply Rle_trans; [apply Rabs_triang|]. lra. }
  assert (C0 : Rabs (s' + t) <= 4 * (u * S) + 3 * (u * u * S)) by (eapply Rle_trans; [apply Rabs_triang|]; lra).
  assert (C1 : Rabs (c - (s' + t)) <= 4 * (u * u * S) + 3 * (u * u * u * S)) by (pose proof u_pos; nra).
  assert (C2 : Rabs c <= (4 + / 1000) * (u * S)).
  { replace c with ((c - (s' + t)) + (s' + t)) by ring. eapply Rle_trans; [apply Rabs_triang|]. rewrite u_val in *.
  lra. }
  assert (V1 : (1 - u) * S <= Rabs s).
  { pose proof (Rabs_triang s (- (s - (xh + yh)))) as P. replace (s + - (s - (xh + yh))) with (xh + yh) in P by ring.
    rewrite Rabs_Ropp in P. fold S in P. lra. }
  assert (G1 : v + v' = s + c).
  { apply fast_two_sum; try apply RN_F. rewrite u_val in *. lra. }
  assert (V' : Rabs v' <= (1 + / 1000) * (u * S)).
  { assert (P : Rabs (v - (s + c)) <= u * Rabs (s + c)) by (apply RN_sum; apply RN_F).
    replace v' with (- (v - (s + c))) by lra. rewrite Rabs_Ropp. eapply Rle_trans; [exact P|].
    assert (Rabs (s + c) <= (1 + / 1000) * S).
    { replace (s + c) with ((s - (xh + yh)) + (xh + yh) + c) by ring. eapply Rle_trans; [apply Rabs_triang|].
      eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|]. fold S. rewrite u_val in *. lra. }
    pose proof u_pos. nra. }
  assert (W0 : Rabs (t' + v') <= (1 + / 500) * (u * S)).
  { eapply Rle_trans; [apply Rabs_triang|]. rewrite u_val in *. lra. }
  assert (W1 : Rabs (w - (t' + v')) <= (1 + / 500) * (u * u * S)).
  { pose proof (RN_sum t' v' Ft' (RN_F _)) as P. fold w in P. pose proof u_pos. nra. }
  assert (Z0 : (1 - 4 * u) * S <= Rabs z).
  { pose proof (Rabs_triang z (- (xl + yl))) as P. replace (z + - (xl + yl)) with (xh + yh) in P by (unfold z; ring).
    rewrite Rabs_Ropp in P. fold S in P. assert (0 <= u * S) by (pose proof u_pos; nra). lra. }
  split; [exact G1|]. split.
  - apply fast_two_sum; try apply RN_F.
    assert (Rabs w <= 2 * (u * S)).
    { replace w with ((w - (t' + v')) + (t' + v')) by ring. eapply Rle_trans; [apply Rabs_triang|].
    rewrite u_val in *. lra. }
    assert ((1 - 10 * u) * S <= Rabs v).
    { pose proof (Rabs_triang v (v' + - c)) as P1. replace (v + (v' + - c)) with s in P1 by lra.
      pose proof (Rabs_triang v' (- c)) as P2. rewrite Rabs_Ropp in P2. rewrite u_val in *. lra. }
    rewrite u_val in *. lra.
  - replace (v + w - z) with ((w - (t' + v')) + (c - (s' + t))) by (unfold z, s', t' in *; lra).
    eapply Rle_trans; [apply Rabs_triang|]. unfold SUM. rewrite u_val in *. lra.
Qed.

(* A double that is not smaller is a multiple of the other's last bit. *)
Lemma multiple : forall a e, F a -> (e <= cexp radix2 fexp a)%Z -> exists k, a = IZR k * bp e.
Proof.
  intros a e Fa H. exists (Ztrunc (scaled_mantissa radix2 fexp a) * 2 ^ (cexp radix2 fexp a - e))%Z.
  rewrite mult_IZR. replace (IZR (2 ^ (cexp radix2 fexp a - e))) with (bp (cexp radix2 fexp a - e)).
  - rewrite Rmult_assoc, <- bp_add. replace (cexp radix2 fexp a - e + e)%Z with (cexp radix2 fexp a) by ring. exact Fa.
  - rewrite <- (IZR_Zpower radix2); [reflexivity | lia].
Qed.
Lemma multiple_least : forall k e, IZR k * bp e <> 0 -> bp e <= Rabs (IZR k * bp e).
Proof.
  intros k e H. rewrite Rabs_mult, (Rabs_pos_eq (bp e)) by apply Rlt_le, bp_pos.
  assert (1 <= Rabs (IZR k)); [|pose proof (bp_pos e); nra]. rewrite <- abs_IZR. apply IZR_le.
  assert (k <> 0%Z) by (intro; subst; apply H; simpl; ring). lia.
Qed.

Lemma add_near : 2 * Rabs (xh + yh) < Rabs xh -> Rabs yh <= Rabs xh -> good.
Proof.
  intros H1 H2. pose proof Fxh as F1. pose proof Fyh as F2.
  assert (Y : Rabs xh / 2 < Rabs yh).
  { pose proof (Rabs_triang (xh + yh) (- yh)) as P. replace (xh + yh + - yh) with xh in P by ring.
  rewrite Rabs_Ropp in P. lra. }
  assert (X0 : xh <> 0) by (intro Z; rewrite Z, Rabs_R0 in H1; pose proof (Rabs_pos (0 + yh)); lra).
  assert (Y0 : yh <> 0) by (intro Z; rewrite Z, Rabs_R0 in Y; pose proof (Rabs_pos xh); lra).
  assert (S : s = xh + yh).
  { apply RN_id. apply (generic_format_plus_weak radix2 fexp); auto. apply Rmin_glb; lra. }
  assert (S0 : s' = 0) by (unfold s'; lra).
  assert (C : c = t) by (unfold c; rewrite S0, Rplus_0_l; apply RN_id, RN_F).
  set (e := cexp radix2 fexp yh).
  assert (Ee : (-1074 <= e)%Z) by (unfold e, cexp, fexp, FLT_exp; lia).
  assert (Ex : (e <= cexp radix2 fexp xh <= e + 1)%Z).
  { assert (mag radix2 yh <= mag radix2 xh)%Z by (apply mag_le_abs; assumption).
    assert (mag radix2 xh <= mag radix2 yh + 1)%Z.
    { apply mag_le_bpow; [assumption|]. rewrite bp_add, bp_1. pose proof (bpow_mag_gt radix2 yh). lra. }
    unfold e, cexp, fexp, FLT_exp. lia. }
  destruct (multiple xh e F1 ltac:(lia)) as [kx Kx]. destruct (multiple yh e F2 ltac:(lia)) as [ky Ky].
  assert (Ks : s = IZR (kx + ky) * bp e) by (rewrite plus_IZR; lra). set (ks := (kx + ky)%Z) in Ks.
  assert (T : Rabs t <= 2 * bp e).
  { pose proof (dd_half_ulp _ _ Hx) as P1. pose proof (dd_half_ulp _ _ Hy) as P2.
    rewrite ulp_neq_0 in P1, P2 by assumption. fold e in P2.
    assert (bp (cexp radix2 fexp xh) <= 2 * bp e).
    { apply Rle_trans with (bp (1 + e)); [apply bp_le; lia|]. rewrite bp_add, bp_1. lra. }
    assert (B : bp (1 + e) = 2 * bp e) by (rewrite bp_add, bp_1; ring).
    assert (Rabs (xl + yl) <= bp (1 + e)) by (eapply Rle_trans; [apply Rabs_triang|]; pose proof (bp_pos e); lra).
    rewrite <- B. unfold t. apply Rabs_le. apply Rabs_le_inv in H0. split.
    - rewrite <- (RN_id (- bp (1 + e))) by (apply F_opp, F_bp; lia). apply RN_le. lra.
    - rewrite <- (RN_id (bp (1 + e))) by (apply F_bp; lia). apply RN_le. lra. }
  destruct t'_le as [_ T'].
  destruct (Req_dec s 0) as [Z|NZ].
  - (* s = 0: exact *)
    assert (V : v = t) by (unfold v; rewrite Z, C, Rplus_0_l; apply RN_id, RN_F).
    assert (G1 : v + v' = s + c) by (unfold v, v'; rewrite Z; apply fast_two_sum_zero, RN_F).
    assert (V' : v' = 0) by lra. assert (W : w = t') by (unfold w; rewrite V', Rplus_0_r; apply RN_id, Ft').
    split; [exact G1|]. split.
    + apply fast_two_sum; try apply RN_F. rewrite V, W. pose proof (Rabs_pos t). rewrite u_val in *. lra.
    + replace (v + w - z) with 0 by (rewrite V, W; unfold z, t'; lra). rewrite Rabs_R0. unfold SUM.
      pose proof (Rabs_pos z). rewrite u_val. lra.
  - assert (S1 : bp e <= Rabs s) by (rewrite Ks in *; now apply multiple_least).
    assert (CT : (cexp radix2 fexp t <= e)%Z \/ t = 0).
    { destruct (Req_dec t 0); [now right | left].
      assert (mag radix2 t <= e + 2)%Z.
      { apply mag_le_bpow; [assumption|]. replace (e + 2)%Z with (1 + (1 + e))%Z by ring.
      rewrite bp_add, bp_1, bp_add, bp_1.
        pose proof (bp_pos e). lra. }
      unfold cexp, fexp, FLT_exp. lia. }
    assert (G1 : v + v' = s + c).
    { unfold v, v'. rewrite C. destruct (Req_dec t 0) as [T0|T0].
      - apply fast_two_sum; try apply RN_F. rewrite T0, Rabs_R0. apply Rabs_pos.
      - destruct CT as [CT|CT]; [|contradiction].
        apply fast_two_sum_multiple with (k := (ks * 2 ^ (e - cexp radix2 fexp t))%Z); try apply RN_F; [assumption|].
        rewrite mult_IZR. replace (IZR (2 ^ (e - cexp radix2 fexp t))) with (bp (e - cexp radix2 fexp t)).
        + rewrite Rmult_assoc, <- bp_add. replace (e - cexp radix2 fexp t + cexp radix2 fexp t)%Z with e by ring.
        exact Ks.
        + rewrite <- (IZR_Zpower radix2); [reflexivity | lia]. }
    destruct (Rle_or_lt (Rabs t) (Rabs (s + t))) as [L|L].
    + (* no cancellation *)
      set (m := Rabs (s + t)) in *. assert (0 <= m) by apply Rabs_pos.
      assert (V0 : Rabs (v - (s + t)) <= u * m) by (unfold v; rewrite C; apply RN_sum; apply RN_F).
      rewrite C in G1.
      assert (V' : Rabs v' <= u * m) by (replace v' with (- (v - (s + t))) by lra; now rewrite Rabs_Ropp).
      assert (T1 : Rabs t' <= u * m) by (pose proof u_pos; nra).
      assert (W0 : Rabs (t' + v') <= 2 * (u * m)) by (eapply Rle_trans; [apply Rabs_triang|]; lra).
      assert (W1 : Rabs (w - (t' + v')) <= 2 * (u * u * m)).
      { pose proof (RN_sum t' v' Ft' (RN_F _)) as P. fold w in P. pose proof u_pos. nra. }
      assert (Z0 : (1 - u) * m <= Rabs z).
      { pose proof (Rabs_triang z (- t')) as P. replace (z + - t') with (s + t) in P by (unfold z, t'; lra).
        rewrite Rabs_Ropp in P. fold m in P. lra. }
      split; [rewrite C; exact G1|]. split.
      * apply fast_two_sum; try apply RN_F.
        assert (Rabs w <= 3 * (u * m)).
        { replace w with ((w - (t' + v')) + (t' + v')) by ring. eapply Rle_trans; [apply Rabs_triang|].
        rewrite u_val in *. lra. }
        assert ((1 - u) * m <= Rabs v).
        { pose proof (Rabs_triang v v') as P. rewrite G1 in P. fold m in P. lra. }
        rewrite u_val in *. lra.
      * replace (v + w - z) with (w - (t' + v')) by (unfold z, t' in *; lra). unfold SUM. rewrite u_val in *. lra.
    + (* s and t cancel: their sum is exact *)
      assert (NT : t <> 0) by (intro N; rewrite N, Rabs_R0 in L; pose proof (Rabs_pos (s + 0)); lra).
      destruct CT as [CT|CT]; [|contradiction].
      assert (FV : F (s + t)).
      { apply (generic_format_plus_weak radix2 fexp); try apply RN_F. apply Rmin_glb; [|lra].
        clear - L T S1. split_Rabs; lra. }
      assert (V : v = s + t) by (unfold v; rewrite C; now apply RN_id). rewrite C in G1.
      assert (V' : v' = 0) by lra. assert (W : w = t') by (unfold w; rewrite V', Rplus_0_r; apply RN_id, Ft').
      split; [rewrite C; exact G1|]. split.
      * destruct (Req_dec v 0) as [V0|V0].
        -- rewrite V0. apply fast_two_sum_zero, RN_F.
        -- apply fast_two_sum; try apply RN_F. rewrite W, V.
           pose proof (error_le_half_ulp_round radix2 fexp even (xl + yl)) as P.
           change (round radix2 fexp (Znearest even) (xl + yl)) with t in P.
           rewrite ulp_neq_0 in P by assumption. replace (t - (xl + yl)) with (- t') in P by (unfold t'; ring).
           rewrite Rabs_Ropp in P.
           destruct (multiple t (cexp radix2 fexp t) (RN_F _) ltac:(lia)) as [kt Kt].
           set (et := cexp radix2 fexp t) in *.
           assert (KV : s + t = IZR (ks * 2 ^ (e - et) + kt) * bp et).
           { rewrite plus_IZR, mult_IZR, Rmult_plus_distr_r. replace (IZR (2 ^ (e - et))) with (bp (e - et)).
             - rewrite Rmult_assoc, <- bp_add. replace (e - et + et)%Z with e by ring. rewrite <- Ks, <- Kt.
             reflexivity.
             - rewrite <- (IZR_Zpower radix2); [reflexivity | lia]. }
           rewrite V in V0. rewrite KV in *. pose proof (multiple_least _ _ V0). pose proof (bp_pos et). lra.
      * replace (v + w - z) with 0 by (rewrite V, W; unfold z, t'; lra). rewrite Rabs_R0. unfold SUM.
        pose proof (Rabs_pos z). rewrite u_val. lra.
Qed.
End Add.

(* x + y, as the code computes it. *)
Definition add_low xh xl yh yl :=
  let s := RN (xh + yh) in RN (two_sum_error xl yl + fast_two_sum_error s (RN (two_sum_error xh yh + RN (xl + yl)))).
Definition add_high xh xl yh yl := let s := RN (xh + yh) in RN (s + RN (two_sum_error xh yh + RN (xl + yl))).
(* The sum is normal, and its relative error at most 6 u^2, with no lower limit. *)
Theorem SUM_holds : forall xh xl yh yl, dd xh xl -> dd yh yl ->
  let v := add_high xh xl yh yl in let w := add_low xh xl yh yl in
  dd (RN (v + w)) (fast_two_sum_error v w) /\
  Rabs (RN (v + w) + fast_two_sum_error v w - (xh + xl + (yh + yl))) <= SUM * (u * u) * Rabs (xh + xl + (yh + yl)).
Proof.
  intros xh xl yh yl Hx Hy v w.
  assert (G : good xh xl yh yl /\ v = RN (RN (xh + yh) + RN (xh + yh - RN (xh + yh) + RN (xl + yl))) /\
    w = RN (xl + yl - RN (xl + yl) + fast_two_sum_error (RN (xh + yh)) (RN (xh + yh - RN (xh + yh) + RN (xl + yl))))).
  { split; [|split; [unfold v, add_high | unfold w, add_low]].
    - destruct (Rle_or_lt (Rabs yh) (Rabs xh)) as [L|L].
      + destruct (Rle_or_lt (Rabs xh) (2 * Rabs (xh + yh))); [now apply add_far | now apply add_near].
      + assert (G : good yh yl xh xl).
        { destruct (Rle_or_lt (Rabs yh) (2 * Rabs (yh + xh))); [apply add_far | apply add_near]; auto; lra. }
        unfold good in *. rewrite (Rplus_comm yh xh), (Rplus_comm yl xl), (Rplus_comm (yh + yl)) in G. exact G.
    - rewrite <- (s'_eq xh xl yh yl Hx Hy). reflexivity.
    - rewrite <- (s'_eq xh xl yh yl Hx Hy), <- (t'_eq xh xl yh yl Hx Hy). reflexivity. }
  destruct G as ((G1 & G2 & G3) & Ev & Ew). rewrite <- Ev, <- Ew in *.
  split.
  - apply normal; auto; apply RN_F.
  - rewrite G2. exact G3.
Qed.

(* x y, as the code computes it; `e` is the error of the product of the high parts, by either way. *)
Definition product_low xh xl yh yl e := RN (e + RN (RN (xh * yl) + RN (xl * yh))).
Section Product.
Variables xh xl yh yl e : R.
Hypotheses (Hx : dd xh xl) (Hy : dd yh yl) (Fe : F e) (He : Rabs (RN (xh * yh) + e - xh * yh) <= 4 * bp (-1074)).
Let p := RN (xh * yh). Let w := product_low xh xl yh yl e. Let P := Rabs (xh * yh).

Lemma product_error : Rabs (p + w - (xh + xl) * (yh + yl)) <= (8 + / 500) * (u * u) * P + 8 * bp (-1074) /\
  Rabs w <= (3 + / 1000) * (u * P) + 8 * bp (-1074) /\ Rabs (p - xh * yh) <= u * P + bp (-1074).
Proof.
  pose proof (dd_low _ _ Hx) as Lx. pose proof (dd_low _ _ Hy) as Ly. pose proof u_pos.
  assert (PE : P = Rabs xh * Rabs yh) by (unfold P; apply Rabs_mult).
  pose proof (Rabs_pos xh). pose proof (Rabs_pos yh). pose proof (Rabs_pos xl). pose proof (Rabs_pos yl).
  assert (A1 : Rabs (xh * yl) <= u * P) by (rewrite Rabs_mult, PE; nra).
  assert (A2 : Rabs (xl * yh) <= u * P) by (rewrite Rabs_mult, PE; nra).
  assert (A3 : Rabs (xl * yl) <= u * u * P).
  { rewrite Rabs_mult, PE. replace (u * u * (Rabs xh * Rabs yh)) with ((u * Rabs xh) * (u * Rabs yh)) by ring.
    apply Rmult_le_compat; assumption. }
  pose proof (RN_err (xh * yl)) as E1. pose proof (RN_err (xl * yh)) as E2. pose proof (RN_err (xh * yh)) as E0.
  fold P in E0.
  fold p in E0, He. set (c1 := RN (xh * yl)) in *. set (c2 := RN (xl * yh)) in *.
  pose proof (RN_sum c1 c2 (RN_F _) (RN_F _)) as E3. set (c := RN (c1 + c2)) in *.
  pose proof (RN_sum e c Fe (RN_F _)) as E4. change (RN (e + c)) with w in E4.
  assert (H5 : bp (-1074) = 2 * bp (-1075)) by (change (-1074)%Z with (1 + -1075)%Z; rewrite bp_add, bp_1; ring).
  pose proof (bp_pos (-1075)). set (T := bp (-1075)) in *. rewrite H5 in *. assert (P0 : 0 <= P) by apply Rabs_pos.
  clearbody p c1 c2 c w P T. clear H5.
  assert (B1 : Rabs (c1 - xh * yl) <= u * u * P + T) by nra.
  assert (B2 : Rabs (c2 - xl * yh) <= u * u * P + T) by nra.
  assert (B3 : Rabs (c1 + c2) <= (2 + / 2000) * (u * P) + 2 * T).
  { replace (c1 + c2) with ((c1 - xh * yl) + (c2 - xl * yh) + (xh * yl) + (xl * yh)) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
    eapply Rle_trans; [apply Rplus_le_compat_r, Rplus_le_compat_r, Rabs_triang|]. rewrite u_val in *. lra. }
  assert (B4 : Rabs (c - (c1 + c2)) <= (2 + / 2000) * (u * u * P) + T) by (rewrite u_val in *; lra).
  assert (B5 : Rabs e <= u * P + 10 * T).
  { replace e with ((p + e - xh * yh) - (p - xh * yh)) by ring. unfold Rminus at 1.
  eapply Rle_trans; [apply Rabs_triang|].
    rewrite Rabs_Ropp. lra. }
  assert (B6 : Rabs (e + c) <= (3 + / 1500) * (u * P) + 13 * T).
  { replace (e + c) with (e + (c - (c1 + c2)) + (c1 + c2)) by ring. eapply Rle_trans; [apply Rabs_triang|].
    eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|]. rewrite u_val in *. lra. }
  assert (B7 : Rabs (w - (e + c)) <= (3 + / 1500) * (u * u * P) + T) by (rewrite u_val in *; lra).
  split; [|split].
  - replace (p + w - (xh + xl) * (yh + yl)) with ((w - (e + c)) + (c - (c1 + c2)) + (c1 - xh * yl) + (c2 - xl * yh)
      + (p + e - xh * yh) - xl * yl) by ring.
    apply Rabs_le_inv in B7. apply Rabs_le_inv in B4. apply Rabs_le_inv in B1. apply Rabs_le_inv in B2.
    apply Rabs_le_inv in He. apply Rabs_le_inv in A3. clear - B7 B4 B1 B2 He A3 P0 H4. apply Rabs_le.
    rewrite u_val in *. lra.
  - replace w with ((w - (e + c)) + (e + c)) by ring. eapply Rle_trans; [apply Rabs_triang|]. rewrite u_val in *. lra.
  - lra.
Qed.

(* fast_two_sum is exact even where all is subnormal. *)
Lemma product_normal : RN (p + w) + fast_two_sum_error p w = p + w.
Proof.
  destruct product_error as (_ & W & Q). fold p w in W, Q. pose proof (RN_F (xh * yh)) as Fp. fold p in Fp.
  assert (Fw : F w) by apply RN_F. destruct (Req_dec w 0) as [W0|W0].
  { apply fast_two_sum; auto. rewrite W0, Rabs_R0. apply Rabs_pos. }
  destruct (Rle_or_lt (bp (-1022)) (Rabs w)) as [L|L].
  - apply fast_two_sum; auto. pose proof (Rabs_triang p (- (p - xh * yh))) as P1.
    replace (p + - (p - xh * yh)) with (xh * yh) in P1 by ring. rewrite Rabs_Ropp in P1. fold P in P1.
    assert (bp (-1074) <= / 4000000000000000 * bp (-1022)).
    { change (-1074)%Z with (-52 + -1022)%Z. rewrite bp_add. apply Rmult_le_compat_r; [apply Rlt_le, bp_pos|]. simpl.
    lra. }
    pose proof (bp_pos (-1022)). rewrite u_val in *. lra.
  - assert (C : cexp radix2 fexp w = (-1074)%Z).
    { assert (mag radix2 w <= -1022)%Z by (apply mag_le_bpow; assumption). unfold cexp, fexp, FLT_exp. lia. }
    destruct (multiple p (-1074) Fp) as [k K]; [unfold cexp, fexp, FLT_exp; lia|].
    apply fast_two_sum_multiple with (k := k); auto. now rewrite C.
Qed.

(* The product of any two numbers: within 9 u^2 of itself and 2^-1070. *)
Theorem product_any : dd (RN (p + w)) (fast_two_sum_error p w) /\
  Rabs (RN (p + w) + fast_two_sum_error p w - (xh + xl) * (yh + yl)) <=
    PRODUCT * (u * u) * Rabs ((xh + xl) * (yh + yl)) + bp (-1070).
Proof.
  split; [apply normal; [apply RN_F | apply RN_F | apply product_normal]|]. rewrite product_normal.
  destruct product_error as (E & _ & _). fold p w in E. eapply Rle_trans; [exact E|].
  pose proof (dd_value _ _ Hx) as [Vx _]. pose proof (dd_value _ _ Hy) as [Vy _].
  assert (V : (1 - 2 * u) * P <= Rabs ((xh + xl) * (yh + yl))).
  { rewrite Rabs_mult. apply Rle_trans with ((1 - u) * Rabs xh * ((1 - u) * Rabs yh)).
    - replace ((1 - u) * Rabs xh * ((1 - u) * Rabs yh)) with ((1 - 2 * u + u * u) * P) by (unfold P;
      rewrite Rabs_mult; ring).
      apply Rmult_le_compat_r; [apply Rabs_pos | rewrite u_val; lra].
    - apply Rmult_le_compat; auto; (apply Rmult_le_pos; [rewrite u_val; lra | apply Rabs_pos]). }
  assert (bp (-1070) = 16 * bp (-1074)) by (change (-1070)%Z with (4 + -1074)%Z; rewrite bp_add; simpl (bp 4); lra).
  pose proof (bp_pos (-1074)). assert (0 <= P) by apply Rabs_pos. set (V' := Rabs ((xh + xl) * (yh + yl))) in *.
  clearbody V' P. unfold PRODUCT. rewrite u_val in *. lra.
Qed.
(* From 2^-900 on, and for zero, the relative error alone. *)
Theorem PRODUCT_holds : Rabs (xh * yh) = 0 \/ bp (-900) <= Rabs (xh * yh) ->
  (xh * yh = 0 -> e = 0) ->
  Rabs (RN (p + w) + fast_two_sum_error p w - (xh + xl) * (yh + yl)) <= PRODUCT * (u * u) * Rabs ((xh + xl) * (yh +
    yl)).
Proof.
  intros [Z|L] HZ.
  - assert (Z' : xh * yh = 0) by (rewrite <- Rabs_R0 in Z; revert Z; unfold Rabs; repeat destruct Rcase_abs; lra).
    specialize (HZ Z'). pose proof (dd_low _ _ Hx) as Lx. pose proof (dd_low _ _ Hy) as Ly.
    assert (L0 : forall h l, Rabs l <= u * Rabs h -> h = 0 -> l = 0).
    { intros h l H H0. rewrite H0, Rabs_R0, Rmult_0_r in H. pose proof (Rabs_pos l).
      destruct (Req_dec l 0); [assumption|]. pose proof (Rabs_pos_lt l H2). lra. }
    rewrite product_normal. assert (W0 : w = 0 /\ (xh + xl) * (yh + yl) = 0).
    { unfold w, product_low. destruct (Rmult_integral _ _ Z') as [X|Y].
      - rewrite HZ, X, (L0 _ _ Lx X), !Rmult_0_l, RN_0, !Rplus_0_l, RN_0, RN_0. split; ring.
      - rewrite HZ, Y, (L0 _ _ Ly Y), !Rmult_0_r, RN_0, !Rplus_0_l, RN_0, RN_0. split; ring. }
    destruct W0 as [W0 W1]. rewrite W0, W1. unfold p. rewrite Z', RN_0. replace (0 + 0 - 0) with 0 by ring.
    rewrite Rabs_R0. lra.
  - rewrite product_normal. destruct product_error as (E & _ & _). fold p w in E. eapply Rle_trans; [exact E|].
    fold P in L. pose proof (dd_value _ _ Hx) as [Vx _]. pose proof (dd_value _ _ Hy) as [Vy _].
    assert (V : (1 - 2 * u) * P <= Rabs ((xh + xl) * (yh + yl))).
    { rewrite Rabs_mult. apply Rle_trans with ((1 - u) * Rabs xh * ((1 - u) * Rabs yh)).
      - replace ((1 - u) * Rabs xh * ((1 - u) * Rabs yh)) with ((1 - 2 * u + u * u) * P) by (unfold P;
        rewrite Rabs_mult; ring).
        apply Rmult_le_compat_r; [apply Rabs_pos | rewrite u_val; lra].
      - apply Rmult_le_compat; auto; (apply Rmult_le_pos; [rewrite u_val; lra | apply Rabs_pos]). }
    assert (T : bp (-1074) <= / 1000 * (u * u) * P).
    { apply Rle_trans with (u * u * bp (-960)); [unfold u; rewrite <- !bp_add; apply bp_le; lia|].
      replace (/ 1000 * (u * u) * P) with (u * u * (/ 1000 * P)) by ring.
      apply Rmult_le_compat_l; [rewrite u_val; lra|].
      apply Rle_trans with (/ 1000 * bp (-900)); [|lra]. change (-960)%Z with (-60 + -900)%Z. rewrite bp_add.
      apply Rmult_le_compat_r; [apply Rlt_le, bp_pos|]. simpl. lra. }
    assert (0 <= P) by apply Rabs_pos. set (V' := Rabs ((xh + xl) * (yh + yl))) in *. clearbody V' P. unfold PRODUCT.
    rewrite u_val in *. lra.
Qed.
End Product.

(* x / y, as the code computes it; `e` is the error of the product of the quotient with the high part of y. *)
Section Quotient.
Variables xh xl yh yl : R.
Hypotheses (Hx : dd xh xl) (Hy : dd yh yl) (Y0 : yh <> 0)
  (Lx : bp (-900) <= Rabs xh) (Lq : bp (-900) <= Rabs (xh / yh)).
Let q := RN (xh / yh).
Variable e : R.
Hypotheses (Fe : F e) (He : RN (q * yh) + e = q * yh).
Let p := RN (q * yh).
Let rest := RN (RN (RN (xh - p) - e) + RN (xl - RN (q * yl))).
Let k := RN (rest / yh).

Theorem QUOTIENT_holds : dd (RN (q + k)) (fast_two_sum_error q k) /\
  Rabs (RN (q + k) + fast_two_sum_error q k - (xh + xl) / (yh + yl)) <= QUOTIENT * (u * u) * Rabs ((xh + xl) / (yh +
    yl)).
Proof.
  pose proof (dd_low _ _ Hx) as Mx. pose proof (dd_low _ _ Hy) as My.
  destruct Hx as (Fxh & Fxl & _). destruct Hy as (Fyh & Fyl & _).
  set (Q := xh / yh) in *. assert (XQ : xh = Q * yh) by (unfold Q; field; assumption).
  assert (AX : Rabs xh = Rabs Q * Rabs yh) by (rewrite XQ at 1; apply Rabs_mult).
  pose proof (Rabs_pos_lt yh Y0) as YP. set (Y := Rabs yh) in *. set (Z := Rabs Q) in *.
  pose proof (bp_pos (-900)). pose proof u_pos.
  assert (T1 : bp (-1075) <= / 1000000 * (u * u * Rabs xh)).
  { apply Rle_trans with (/ 1000000 * (u * u * bp (-900))).
    - apply Rle_trans with (bp (-40) * (u * u * bp (-900))); [unfold u; rewrite <- !bp_add; apply bp_le; lia|].
      apply Rmult_le_compat_r; [|simpl; lra]. unfold u. rewrite <- !bp_add. apply Rlt_le, bp_pos.
    - apply Rmult_le_compat_l; [lra|]. apply Rmult_le_compat_l; [rewrite u_val; lra | assumption]. }
  assert (T2 : bp (-1075) <= / 1000000 * (u * u * Z)).
  { apply Rle_trans with (/ 1000000 * (u * u * bp (-900))).
    - apply Rle_trans with (bp (-40) * (u * u * bp (-900))); [unfold u; rewrite <- !bp_add; apply bp_le; lia|].
      apply Rmult_le_compat_r; [|simpl; lra]. unfold u. rewrite <- !bp_add. apply Rlt_le, bp_pos.
    - apply Rmult_le_compat_l; [lra|]. apply Rmult_le_compat_l; [rewrite u_val; lra | assumption]. }
  assert (Eq : Rabs (q - Q) <= u * Z).
  { apply RN_normal. eapply Rle_trans; [|exact Lq]. apply bp_le. lia. }
  assert (Aq : Rabs q <= (1 + u) * Z).
  { replace q with ((q - Q) + Q) by ring. eapply Rle_trans; [apply Rabs_triang|]. fold Z. lra. }
  assert (Er : Rabs (xh - q * yh) <= u * Rabs xh).
  { replace (xh - q * yh) with (- ((q - Q) * yh)) by lra. rewrite Rabs_Ropp, Rabs_mult, AX. fold Y.
    replace (u * (Z * Y)) with (u * Z * Y) by ring. apply Rmult_le_compat_r; lra. }
  assert (Pp : Rabs (p - q * yh) <= (u + 2 * (u * u)) * Rabs xh).
  { eapply Rle_trans; [apply RN_err|].
    assert (Rabs (q * yh) <= (1 + u) * Rabs xh).
    { rewrite Rabs_mult, AX. fold Y. replace ((1 + u) * (Z * Y)) with ((1 + u) * Z * Y) by ring.
    apply Rmult_le_compat_r; lra. }
    rewrite u_val in *. lra. }
  assert (X0 : 0 < Rabs xh) by lra.
  assert (Fp : F (xh - p)).
  { unfold Rminus. apply (generic_format_plus_weak radix2 fexp); [assumption | apply F_opp, RN_F|].
    change (xh + - p) with (xh - p). rewrite Rabs_Ropp.
    assert (S : Rabs (xh - p) <= 3 * u * Rabs xh).
    { replace (xh - p) with ((xh - q * yh) - (p - q * yh)) by ring. unfold Rminus at 1.
    eapply Rle_trans; [apply Rabs_triang|].
      rewrite Rabs_Ropp. rewrite u_val in *. lra. }
    apply Rmin_glb; [rewrite u_val in *; lra|].
    pose proof (Rabs_triang p (xh - p)) as P. replace (p + (xh - p)) with xh in P by ring. rewrite u_val in *. lra. }
  assert (E1 : Rabs (RN (RN (xh - p) - e) - (xh - q * yh)) <= u * u * Rabs xh).
  { rewrite (RN_id _ Fp). replace (xh - q * yh) with (xh - p - e) by (unfold p; lra).
    eapply Rle_trans; [apply RN_diff; assumption|].
    replace (xh - p - e) with (xh - q * yh) by (unfold p; lra). rewrite Rmult_assoc. apply Rmult_le_compat_l; lra. }
  set (r := RN (RN (xh - p) - e)) in *.
  assert (Qy : Rabs (q * yl) <= (1 + u) * (u * Rabs xh)).
  { rewrite Rabs_mult, AX. replace ((1 + u) * (u * (Z * Y))) with (((1 + u) * Z) * (u * Y)) by ring.
    apply Rmult_le_compat; auto using Rabs_pos. }
  pose proof (RN_err (q * yl)) as E2. set (m := RN (q * yl)) in *.
  pose proof (RN_diff xl m Fxl (RN_F _)) as E3. set (d := RN (xl - m)) in *.
  pose proof (RN_sum r d (RN_F _) (RN_F _)) as E4. change (RN (r + d)) with rest in E4.
  set (X := Rabs xh) in *.
  assert (B2 : Rabs (m - q * yl) <= (1 + / 10000) * (u * u * X)) by (rewrite u_val in *; lra).
  assert (B3 : Rabs (xl - m) <= (2 + / 10000) * (u * X)).
  { replace (xl - m) with (xl + - (q * yl) + - (m - q * yl)) by ring. eapply Rle_trans; [apply Rabs_triang|].
    eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|]. rewrite !Rabs_Ropp. rewrite u_val in *. lra. }
  assert (B4 : Rabs (d - (xl - m)) <= (2 + / 10000) * (u * u * X)) by (rewrite u_val in *; lra).
  assert (B5 : Rabs (r + d) <= (3 + / 1000) * (u * X)).
  { apply Rabs_le_inv in E1. apply Rabs_le_inv in Er. apply Rabs_le_inv in B4. apply Rabs_le_inv in B3.
    clear - E1 Er B4 B3 X0. apply Rabs_le. rewrite u_val in *. lra. }
  assert (B6 : Rabs (rest - (r + d)) <= (3 + / 1000) * (u * u * X)) by (rewrite u_val in *; lra).
  (* the exact remainder *)
  set (R0 := xh + xl - q * (yh + yl)).
  assert (B7 : Rabs (rest - R0) <= (7 + / 400) * (u * u * X)).
  { apply Rabs_le_inv in E1. apply Rabs_le_inv in B2. apply Rabs_le_inv in B4. apply Rabs_le_inv in B6.
    clear - E1 B2 B4 B6 X0. unfold R0. apply Rabs_le. rewrite u_val in *. lra. }
  assert (B8 : Rabs R0 <= (3 + / 1000) * (u * X)).
  { apply Rabs_le_inv in Er. apply Rabs_le_inv in Mx. apply Rabs_le_inv in Qy.
    clear - Er Mx Qy X0. unfold R0. apply Rabs_le. rewrite u_val in *. lra. }
  assert (DY : forall a b, Rabs a <= b * X -> Rabs (a / yh) <= b * Z).
  { intros a b Hab. unfold Rdiv. rewrite Rabs_mult, Rabs_inv. fold Y. apply Rmult_le_reg_r with Y; [assumption|].
    rewrite Rmult_assoc, Rinv_l by lra. rewrite AX in Hab. lra. }
  assert (C1 : Rabs (rest / yh - R0 / yh) <= (7 + / 400) * (u * u) * Z).
  { replace (rest / yh - R0 / yh) with ((rest - R0) / yh) by (field; assumption). apply DY. lra. }
  assert (C2 : Rabs (R0 / yh) <= (3 + / 1000) * u * Z) by (apply DY; lra).
  assert (Z0 : 0 < Z) by lra.
  assert (C3 : Rabs (rest / yh) <= (3 + / 500) * u * Z).
  { replace (rest / yh) with ((rest / yh - R0 / yh) + R0 / yh) by ring. eapply Rle_trans; [apply Rabs_triang|].
  rewrite u_val in *. lra. }
  assert (C4 : Rabs (k - rest / yh) <= (3 + / 400) * (u * u) * Z).
  { pose proof (RN_err (rest / yh)) as P. fold k in P. rewrite u_val in *. lra. }
  assert (YY : yh + yl <> 0).
  { intro N. assert (yl = - yh) by lra. rewrite H1, Rabs_Ropp in My. fold Y in My. rewrite u_val in My. lra. }
  assert (C5 : Rabs (R0 / (yh + yl) - R0 / yh) <= (3 + / 400) * (u * u) * Z).
  { replace (R0 / (yh + yl) - R0 / yh) with (- (R0 / yh) * (yl / (yh + yl))) by (field; split; assumption).
    rewrite Rabs_mult, Rabs_Ropp.
    assert (Rabs (yl / (yh + yl)) <= (1 + 2 * u) * u).
    { unfold Rdiv. rewrite Rabs_mult, Rabs_inv. pose proof (Rabs_pos_lt _ YY).
      apply Rmult_le_reg_r with (Rabs (yh + yl)); [assumption|]. rewrite Rmult_assoc, Rinv_l by lra.
      pose proof (dd_value _ _ Hy) as [V _]. fold Y in V. 
      apply Rle_trans with ((1 + 2 * u) * u * ((1 - u) * Y)).
      - rewrite Rmult_1_r. eapply Rle_trans; [exact My|]. rewrite u_val. lra.
      - apply Rmult_le_compat_l; [rewrite u_val; lra | assumption]. }
    apply Rle_trans with (((3 + / 1000) * u * Z) * ((1 + 2 * u) * u)).
    - apply Rmult_le_compat; auto using Rabs_pos.
    - rewrite u_val. lra. }
  assert (V : (xh + xl) / (yh + yl) = q + R0 / (yh + yl)) by (unfold R0; field; assumption).
  assert (N : RN (q + k) + fast_two_sum_error q k = q + k).
  { apply fast_two_sum; try apply RN_F.
    assert (Rabs k <= 4 * u * Z).
    { replace k with ((k - rest / yh) + rest / yh) by ring. eapply Rle_trans; [apply Rabs_triang|].
    rewrite u_val in *. lra. }
    pose proof (Rabs_triang q (- (q - Q))) as P. replace (q + - (q - Q)) with Q in P by ring. rewrite Rabs_Ropp in P.
    fold Z in P.
    rewrite u_val in *. lra. }
  split; [apply normal; auto; apply RN_F|]. rewrite N, V.
  apply Rabs_le_inv in C1. apply Rabs_le_inv in C4. apply Rabs_le_inv in C5.
  assert (W : (1 - 6 * u) * Z <= Rabs (q + R0 / (yh + yl))).
  { pose proof (Rabs_triang (q + R0 / (yh + yl)) (- (q - Q) + - (R0 / (yh + yl)))) as P.
    replace (q + R0 / (yh + yl) + (- (q - Q) + - (R0 / (yh + yl)))) with Q in P by ring. fold Z in P.
    pose proof (Rabs_triang (- (q - Q)) (- (R0 / (yh + yl)))) as P2. rewrite !Rabs_Ropp in P2.
    assert (Rabs (R0 / (yh + yl)) <= (3 + / 100) * u * Z).
    { apply Rabs_le_inv in C2. apply Rabs_le. clear - C2 C5 Z0. rewrite u_val in *. lra. }
    rewrite u_val in *. lra. }
  apply Rle_trans with (QUOTIENT * (u * u) * ((1 - 6 * u) * Z)).
  - clear - C1 C4 C5 Z0. unfold QUOTIENT. apply Rabs_le. rewrite u_val in *. lra.
  - apply Rmult_le_compat_l; [unfold QUOTIENT; rewrite u_val; lra | assumption].
Qed.
End Quotient.

(* The root of x, as the code computes it; `e` is the error of the square of the rounded root. *)
Section Root.
Variables xh xl : R.
Hypotheses (Hx : dd xh xl) (Lx : bp (-800) <= xh).
Let r := RN (sqrt xh).
Variable e : R.
Hypotheses (Fe : F e) (He : RN (r * r) + e = r * r).
Let rest := RN (RN (RN (xh - RN (r * r)) - e) + xl).
Let k := RN (rest / RN (2 * r)).

Theorem ROOT_holds : dd (RN (r + k)) (fast_two_sum_error r k) /\
  Rabs (RN (r + k) + fast_two_sum_error r k - sqrt (xh + xl)) <= ROOT * (u * u) * sqrt (xh + xl).
Proof.
  pose proof (dd_low _ _ Hx) as Mx. destruct Hx as (Fxh & Fxl & _). pose proof (bp_pos (-800)). pose proof u_pos.
  assert (X0 : 0 < xh) by lra. rewrite (Rabs_pos_eq xh) in Mx by lra.
  set (S := sqrt xh) in *. assert (SS : S * S = xh) by (apply sqrt_sqrt; lra).
  assert (S0 : bp (-400) <= S).
  { unfold S. apply below_root; [apply sqrt_pos|]. rewrite sqrt_sqrt by lra. rewrite bp_sq. exact Lx. }
  pose proof (bp_pos (-400)).
  assert (Er : Rabs (r - S) <= u * S).
  { pose proof (RN_normal S) as P. rewrite (Rabs_pos_eq S) in P by lra. apply P. eapply Rle_trans; [|exact S0].
  apply bp_le. lia. }
  apply Rabs_le_inv in Er. assert (R0 : 0 < r) by (rewrite u_val in *; lra).
  assert (D0 : Rabs (xh - r * r) <= (2 + 2 * u) * u * xh).
  { rewrite <- SS. replace (S * S - r * r) with ((S - r) * (S + r)) by ring. rewrite Rabs_mult.
    replace ((2 + 2 * u) * u * (S * S)) with ((u * S) * ((2 + 2 * u) * S)) by ring.
    apply Rmult_le_compat; try apply Rabs_pos; apply Rabs_le; rewrite u_val in *; lra. }
  assert (T1 : bp (-1075) <= / 1000000 * (u * u * S)).
  { apply Rle_trans with (/ 1000000 * (u * u * bp (-400))).
    - apply Rle_trans with (bp (-40) * (u * u * bp (-400))); [unfold u; rewrite <- !bp_add; apply bp_le; lia|].
      apply Rmult_le_compat_r; [|simpl; lra]. unfold u. rewrite <- !bp_add. apply Rlt_le, bp_pos.
    - apply Rmult_le_compat_l; [lra|]. apply Rmult_le_compat_l; [rewrite u_val; lra | assumption]. }
  assert (T0 : bp (-1075) <= u * u * xh).
  { apply Rle_trans with (u * u * bp (-800)); [unfold u; rewrite <- !bp_add; apply bp_le; lia|].
    apply Rmult_le_compat_l; [rewrite u_val; lra | assumption]. }
  pose proof (RN_err (r * r)) as Pp. set (p := RN (r * r)) in *.
  assert (RR : Rabs (r * r) <= (1 + 3 * u) * xh).
  { apply Rabs_le_inv in D0. apply Rabs_le. rewrite u_val in *. lra. }
  assert (Fp : F (xh - p)).
  { unfold Rminus. apply (generic_format_plus_weak radix2 fexp); [assumption | apply F_opp, RN_F|].
    change (xh + - p) with (xh - p). rewrite Rabs_Ropp.
    assert (Q : Rabs (xh - p) <= 4 * u * xh).
    { replace (xh - p) with ((xh - r * r) - (p - r * r)) by ring. unfold Rminus at 1.
    eapply Rle_trans; [apply Rabs_triang|].
      rewrite Rabs_Ropp. rewrite u_val in *. lra. }
    rewrite (Rabs_pos_eq xh) by lra. apply Rmin_glb; [rewrite u_val in *; lra|].
    pose proof (Rabs_triang p (xh - p)) as P. replace (p + (xh - p)) with xh in P by ring.
    rewrite (Rabs_pos_eq xh) in P by lra.
    rewrite u_val in *. lra. }
  set (d := RN (RN (xh - p) - e)) in *.
  assert (E1 : Rabs (d - (xh - r * r)) <= (2 + 2 * u) * (u * u * xh)).
  { unfold d. rewrite (RN_id _ Fp). replace (xh - r * r) with (xh - p - e) by lra.
    eapply Rle_trans; [apply RN_diff; assumption|].
    replace (xh - p - e) with (xh - r * r) by lra. replace ((2 + 2 * u) * (u * u * xh)) with (u * ((2 + 2 * u) * u *
      xh)) by ring.
    apply Rmult_le_compat_l; lra. }
  pose proof (RN_sum d xl (RN_F _) Fxl) as E2. change (RN (d + xl)) with rest in E2.
  assert (B1 : Rabs (d + xl) <= (3 + / 1000) * (u * xh)).
  { apply Rabs_le_inv in E1. apply Rabs_le_inv in D0. apply Rabs_le_inv in Mx. clear - E1 D0 Mx X0. apply Rabs_le.
    rewrite u_val in *. lra. }
  assert (B2 : Rabs (rest - (d + xl)) <= (3 + / 1000) * (u * u * xh)) by (rewrite u_val in *; lra).
  set (M := xh + xl - r * r).
  assert (B3 : Rabs (rest - M) <= (5 + / 500) * (u * u * xh)).
  { apply Rabs_le_inv in E1. apply Rabs_le_inv in B2. clear - E1 B2 X0. unfold M. apply Rabs_le. rewrite u_val in *.
  lra. }
  assert (B4 : Rabs M <= (3 + / 1000) * (u * xh)).
  { apply Rabs_le_inv in D0. apply Rabs_le_inv in Mx. clear - D0 Mx X0. unfold M. apply Rabs_le. rewrite u_val in *.
  lra. }
  assert (F2 : RN (2 * r) = 2 * r).
  { apply RN_id. replace (2 * r) with (r * bp 1) by (rewrite bp_1; ring).
  apply mult_bpow_pos_exact_FLT; [apply RN_F | lia]. }
  (* a / 2r, where a is a part of xh *)
  assert (DR : forall a b, 0 <= b -> Rabs a <= b * xh -> Rabs (a / (2 * r)) <= (1 + 2 * u) / 2 * b * S).
  { intros a b B0 Hab. unfold Rdiv at 1. rewrite Rabs_mult, Rabs_inv, (Rabs_pos_eq (2 * r)) by lra.
    apply Rmult_le_reg_r with (2 * r); [lra|]. rewrite Rmult_assoc, Rinv_l by lra. rewrite Rmult_1_r.
    eapply Rle_trans; [exact Hab|].
    rewrite <- SS. replace ((1 + 2 * u) / 2 * b * S * (2 * r)) with ((b * S) * ((1 + 2 * u) * r)) by field.
    replace (b * (S * S)) with ((b * S) * S) by ring. apply Rmult_le_compat_l; [apply Rmult_le_pos; lra|].
    rewrite u_val in *. lra. }
  assert (C1 : Rabs (rest / (2 * r) - M / (2 * r)) <= (25 / 10 + / 500) * (u * u * S)).
  { replace (rest / (2 * r) - M / (2 * r)) with ((rest - M) / (2 * r)) by (field; lra).
    eapply Rle_trans; [apply (DR _ ((5 + / 500) * (u * u))); [rewrite u_val|]; lra|]. rewrite u_val in *. lra. }
  assert (C2 : Rabs (M / (2 * r)) <= (15 / 10 + / 1000) * (u * S)).
  { eapply Rle_trans; [apply (DR _ ((3 + / 1000) * u)); [rewrite u_val|]; lra|]. rewrite u_val in *. lra. }
  assert (C3 : Rabs (rest / (2 * r)) <= (15 / 10 + / 500) * (u * S)).
  { replace (rest / (2 * r)) with ((rest / (2 * r) - M / (2 * r)) + M / (2 * r)) by ring.
  eapply Rle_trans; [apply Rabs_triang|].
    rewrite u_val in *. lra. }
  assert (C4 : Rabs (k - rest / (2 * r)) <= (15 / 10 + / 400) * (u * u * S)).
  { unfold k. rewrite F2. pose proof (RN_err (rest / (2 * r))) as P. rewrite u_val in *. lra. }
  (* the exact root *)
  set (W := sqrt (xh + xl)). apply Rabs_le_inv in Mx.
  assert (P0 : 0 <= xh + xl) by (rewrite u_val in *; lra).
  assert (WW : W * W = xh + xl) by (apply sqrt_sqrt; assumption). assert (W0 : 0 <= W) by apply sqrt_pos.
  assert (WS : (1 - u) * S <= W <= (1 + u) * S).
  { split; apply below_root; try lra; try (apply Rmult_le_pos; rewrite ?u_val; lra).
    - replace ((1 - u) * S * ((1 - u) * S)) with ((1 - u) * (1 - u) * (S * S)) by ring. rewrite SS, WW.
    rewrite u_val in *. lra.
    - replace ((1 + u) * S * ((1 + u) * S)) with ((1 + u) * (1 + u) * (S * S)) by ring. rewrite SS, WW.
    rewrite u_val in *. lra. }
  assert (ID : W - r = M / (2 * r) - (W - r) * (W - r) / (2 * r)) by (unfold M; rewrite <- WW; field; lra).
  assert (WR : Rabs (W - r) <= (15 / 10 + / 100) * (u * S)).
  { assert (G : Rabs (W - r) <= 2 * (u * S)) by (apply Rabs_le; lra).
    assert (G2 : Rabs ((W - r) * (W - r) / (2 * r)) <= 3 * (u * u * S)).
    { assert (Rabs ((W - r) * (W - r)) <= (4 * (u * u)) * xh).
      { rewrite Rabs_mult, <- SS. replace (4 * (u * u) * (S * S)) with ((2 * (u * S)) * (2 * (u * S))) by ring.
        apply Rmult_le_compat; auto using Rabs_pos. }
      eapply Rle_trans; [apply (DR _ (4 * (u * u))); [rewrite u_val; lra | assumption]|]. rewrite u_val in *. lra. }
    rewrite ID. unfold Rminus at 1. eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. rewrite u_val in *.
    lra. }
  assert (C5 : Rabs ((W - r) * (W - r) / (2 * r)) <= (12 / 10) * (u * u * S)).
  { assert (Rabs ((W - r) * (W - r)) <= ((15 / 10 + / 100) * (15 / 10 + / 100) * (u * u)) * xh).
    { rewrite Rabs_mult, <- SS.
      replace ((15 / 10 + / 100) * (15 / 10 + / 100) * (u * u) * (S * S)) with (((15 / 10 + / 100) * (u * S)) * ((15 /
        10 + / 100) * (u * S))) by ring.
      apply Rmult_le_compat; auto using Rabs_pos. }
    eapply Rle_trans; [apply (DR _ ((15 / 10 + / 100) * (15 / 10 + / 100) * (u * u))); [rewrite u_val;
      lra | assumption]|].
    rewrite u_val in *. lra. }
  assert (N : RN (r + k) + fast_two_sum_error r k = r + k).
  { apply fast_two_sum; try apply RN_F. rewrite (Rabs_pos_eq r) by lra.
    replace k with ((k - rest / (2 * r)) + rest / (2 * r)) by ring. eapply Rle_trans; [apply Rabs_triang|].
    rewrite u_val in *. lra. }
  split; [apply normal; auto; apply RN_F|]. rewrite N.
  replace (r + k - W) with ((k - rest / (2 * r)) + (rest / (2 * r) - M / (2 * r)) + ((M / (2 * r)) - (W - r))) by ring.
  replace (M / (2 * r) - (W - r)) with ((W - r) * (W - r) / (2 * r)) by lra.
  eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
  clear - C1 C4 C5 WS S0 H1. unfold ROOT. rewrite u_val in *. lra.
Qed.
End Root.
