(* rt-math, exact/fixed.rs: quotients and roots of fixed-point numbers in double-double; pseudo_inverse/fixed.rs: the
  cut. *)
From Proofs Require Import Rounding ErrorFree DoubleDouble Steps Round.
From Flocq Require Import Mult_error.
Open Scope R_scope.

(* The error of a quotient or root before the last rounding, relative. *)
Definition ERROR := 64 * u * u.
(* Exponents of a result in 1/4..4 that keep it normal. *)
Definition SAFE_LEAST := (-1018)%Z.
(* Operands are multiplied by powers of two above that. *)
Definition SMALL := 400%Z.
(* How far the two doubles of a number are from it, relative. *)
Definition CUT := 2 * u * u.

(* ---- The leading 53 bits of a number in 1..2, and the next 63, rounded to a double ---- *)
Theorem CUT_holds : forall x, 1 <= x < 2 -> let h := IZR (Zfloor (x * bp 52)) * bp (-52) in
  let l := RN (IZR (Zfloor ((x - h) * bp 115))) * bp (-115) in Rabs (h + l - x) <= CUT * x /\ 0 <= l <= bp (-52) /\ 1
    <= h < 2.
Proof.
  intros x Hx h l. assert (U2 : bp (-106) = u * u) by (unfold u; now rewrite <- bp_add).
  assert (P : bp 52 * bp (-52) = 1) by (rewrite <- bp_add; reflexivity). assert (P2 : bp 115 * bp (-115) = 1) by
    (rewrite <- bp_add; reflexivity).
  pose proof (bp_pos 52). pose proof (bp_pos (-52)). pose proof (bp_pos 115). pose proof (bp_pos (-115)).
  set (m := Zfloor (x * bp 52)) in *. pose proof (Zfloor_lb (x * bp 52)) as L. pose proof (Zfloor_ub (x * bp 52)) as
    G. fold m in L, G.
  assert (HX : h <= x < h + bp (-52)).
  { unfold h. split.
    - apply Rmult_le_compat_r with (r := bp (-52)) in L; [|lra]. rewrite Rmult_assoc, P in L. lra.
    - apply Rmult_lt_compat_r with (r := bp (-52)) in G; [|lra]. rewrite Rmult_assoc, P in G. lra. }
  assert (h1 : 1 <= h).
  { unfold h. assert (Z : (2 ^ 52 <= m)%Z).
    { apply Zfloor_lub. replace (IZR (2 ^ 52)) with (bp 52) by (simpl; lra). rewrite <- (Rmult_1_l (bp 52)) at 1.
      apply Rmult_le_compat_r; lra. }
    apply IZR_le in Z. replace (IZR (2 ^ 52)) with (bp 52) in Z by (simpl; lra). rewrite <- P. apply
      Rmult_le_compat_r; lra. }
  set (k := Zfloor ((x - h) * bp 115)) in *. pose proof (Zfloor_lb ((x - h) * bp 115)) as L2. pose proof (Zfloor_ub
    ((x - h) * bp 115)) as G2. fold k in L2, G2.
  assert (k0 : 0 <= IZR k).
  { apply IZR_le. apply Zfloor_lub. simpl. apply Rmult_le_pos; lra. }
  assert (k1 : IZR k <= bp 63).
  { apply Rle_trans with ((x - h) * bp 115); [exact L2|]. apply Rle_trans with (bp (-52) * bp 115); [apply
    Rmult_le_compat_r; lra | rewrite <- bp_add; apply bp_le; lia]. }
  set (r := RN (IZR k)) in *. assert (r0 : 0 <= r) by (unfold r; rewrite <- RN_0; now apply RN_le).
  assert (r1 : r <= bp 63) by (unfold r; rewrite <- (RN_id (bp 63)) by (apply F_bp; lia); now apply RN_le).
  pose proof (RN_err (IZR k)) as E. fold r in E. rewrite (Rabs_pos_eq (IZR k)) in E by assumption.
  assert (T : bp (-1075) <= / 1000 * (u * bp 63)).
  { apply Rle_trans with (bp (-10) * (u * bp 63)); [unfold u; rewrite <- !bp_add; apply bp_le; lia|]. apply
    Rmult_le_compat_r; [apply Rmult_le_pos; [apply Rlt_le, u_pos | apply Rlt_le, bp_pos] | simpl; lra]. }
  assert (E2 : Rabs (r - IZR k) <= (1 + / 1000) * (u * bp 63)).
  { eapply Rle_trans; [exact E|]. assert (u * IZR k <= u * bp 63) by (apply Rmult_le_compat_l; [apply Rlt_le, u_pos |
    assumption]). lra. }
  assert (UU : u * bp 63 * bp (-115) = 2 * (u * u)).
  { replace (2 * (u * u)) with (bp 1 * (u * u)) by (rewrite bp_1; ring). unfold u. rewrite <- !bp_add. f_equal. }
  split; [|split].
  - replace (h + l - x) with ((r - IZR k) * bp (-115) - ((x - h) * bp 115 - IZR k) * bp (-115)).
    + (* the rounding has 2^-53 of a number below 2^63, so a part of 2^-105 at most; by its own exponent it is half of
      that *)
      assert (H3 : Rabs (r - IZR k) <= bp 9).
      { destruct (Req_dec (IZR k) 0) as [Z|N].
        - unfold r. rewrite Z, RN_0. replace (0 - 0) with 0 by ring. rewrite Rabs_R0. apply Rlt_le, bp_pos.
        - pose proof (error_le_half_ulp radix2 fexp even (IZR k)) as HU. change (round radix2 fexp (Znearest even)
          (IZR k)) with r in HU.
          eapply Rle_trans; [exact HU|]. rewrite ulp_neq_0 by assumption.
          assert (K64 : (mag radix2 (IZR k) <= 63)%Z).
          { apply mag_le_bpow; [assumption|]. rewrite Rabs_pos_eq by assumption. eapply Rle_lt_trans; [exact L2|].
            apply Rlt_le_trans with (bp (-52) * bp 115); [apply Rmult_lt_compat_r; lra | rewrite <- bp_add; apply
              bp_le; lia]. }
          apply Rle_trans with (/ 2 * bp (1 + 9)); [apply Rmult_le_compat_l; [lra|]; apply bp_le; unfold cexp, fexp,
            FLT_exp; lia | rewrite bp_add, bp_1; lra]. }
      apply Rle_trans with (bp 9 * bp (-115) + 1 * bp (-115)).
      * apply Rabs_minus_le; rewrite Rabs_mult, (Rabs_pos_eq (bp (-115))) by lra; apply Rmult_le_compat_r; try lra.
        apply Rabs_le. lra.
      * rewrite <- bp_add. change (9 + -115)%Z with (-106)%Z. assert (bp (-115) <= / 500 * bp (-106)).
        { change (-115)%Z with (-9 + -106)%Z. rewrite bp_add. apply Rmult_le_compat_r; [apply Rlt_le, bp_pos | simpl;
          lra]. }
        pose proof (bp_pos (-106)). unfold CUT. rewrite <- U2 in *. replace (2 * u * u * x) with (2 * (u * u) * x) by
          ring. rewrite <- U2.
        assert (2 * bp (-106) * 1 <= 2 * bp (-106) * x) by (apply Rmult_le_compat_l; lra). lra.
    + unfold l. replace (((x - h) * bp 115 - IZR k) * bp (-115)) with ((x - h) * (bp 115 * bp (-115)) - IZR k * bp
      (-115)) by ring. rewrite P2. ring.
  - unfold l. split; [apply Rmult_le_pos; lra|]. apply Rle_trans with (bp 63 * bp (-115)); [apply Rmult_le_compat_r;
    lra | rewrite <- bp_add; apply bp_le; lia].
  - split; [exact h1 | lra].
Qed.

(* ---- Quotients and roots ---- *)
(* q the quotient in double-double of n and d, which are within CUT of N and D *)
Lemma quotient_near : forall n d N D q, 0 < N -> 0 < D -> Rabs (n - N) <= CUT * N -> Rabs (d - D) <= CUT * D -> 
  Rabs (q - n / d) <= QUOTIENT * (u * u) * Rabs (n / d) -> Rabs (q - N / D) <= (181 / 10) * (u * u) * (N / D).
Proof.
  intros n d N D q N0 D0 Hn Hd Hq. unfold CUT in *. pose proof Hn as Hn'. pose proof Hd as Hd'. apply Rabs_le_inv in
    Hn'. apply Rabs_le_inv in Hd'. pose proof u_pos.
  assert (n0 : 0 < n) by (rewrite u_val in *; lra). assert (d0 : 0 < d) by (rewrite u_val in *; lra). assert (Q0 : 0 <
    N / D) by (apply Rmult_lt_0_compat; [assumption | now apply Rinv_0_lt_compat]).
  assert (E : Rabs (n / d - N / D) <= (4 + / 100) * (u * u) * (N / D)).
  { apply Rmult_le_reg_r with (d * D); [apply Rmult_lt_0_compat; assumption|]. rewrite <- (Rabs_pos_eq (d * D)) at 1
    by (apply Rmult_le_pos; lra). rewrite <- Rabs_mult.
    replace ((n / d - N / D) * (d * D)) with ((n - N) * D - N * (d - D)) by (field; split; lra). replace ((4 + / 100)
      * (u * u) * (N / D) * (d * D)) with ((4 + / 100) * (u * u) * (N * d)) by (field; lra).
    apply Rle_trans with (2 * u * u * N * D + N * (2 * u * u * D)).
    - apply Rabs_minus_le; rewrite Rabs_mult; [rewrite (Rabs_pos_eq D) by lra; apply Rmult_le_compat_r; lra | rewrite
      (Rabs_pos_eq N) by lra; apply Rmult_le_compat_l; lra].
    - assert (0 <= N * D) by (apply Rmult_le_pos; lra). assert (N * ((1 - 2 * u * u) * D) <= N * d) by (apply
      Rmult_le_compat_l; lra).
      replace (N * ((1 - 2 * u * u) * D)) with ((1 - 2 * u * u) * (N * D)) in H1 by ring. replace (2 * u * u * N * D +
        N * (2 * u * u * D)) with (4 * (u * u) * (N * D)) by ring. rewrite u_val in *. lra. }
  assert (P : 0 < n / d) by (apply Rmult_lt_0_compat; [assumption | now apply Rinv_0_lt_compat]). rewrite (Rabs_pos_eq
    (n / d)) in Hq by lra. pose proof E as E'. apply Rabs_le_inv in E'.
  replace (q - N / D) with ((q - n / d) + (n / d - N / D)) by ring. eapply Rle_trans; [apply Rabs_plus_le; [exact Hq |
    exact E]|]. unfold QUOTIENT. rewrite u_val in *. lra.
Qed.
(* p + sqrt r of the same sign *)
Lemma sum_near : forall p r root s P R, 0 <= P -> 0 < R -> Rabs (p - P) <= CUT * P -> Rabs (r - R) <= CUT * R -> 0 < r
  ->
  Rabs (root - sqrt r) <= ROOT * (u * u) * sqrt r -> Rabs (s - (p + root)) <= SUM * (u * u) * Rabs (p + root) ->
  Rabs (s - (P + sqrt R)) <= (141 / 10) * (u * u) * (P + sqrt R).
Proof.
  intros p r root s P R P0 R0 Hp Hr r0 Hroot Hs. unfold CUT in *. pose proof u_pos. pose proof (sqrt_lt_R0 R R0) as
    S0. pose proof (sqrt_lt_R0 r r0) as s0.
  pose proof (root_near R r R0 ltac:(lra)) as RN1. rewrite (Rabs_minus_sym R) in RN1.
  assert (E1 : Rabs (sqrt R - sqrt r) <= 2 * u * u * sqrt R).
  { apply Rmult_le_reg_r with (sqrt R); [assumption|]. eapply Rle_trans; [exact RN1|]. eapply Rle_trans; [exact Hr|].
    rewrite <- (sqrt_sqrt R) at 1 by lra. apply Req_le. ring. }
  set (W := sqrt R) in *. set (w := sqrt r) in *. pose proof E1 as E1'. apply Rabs_le_inv in E1'. unfold ROOT in
    Hroot. unfold SUM in Hs.
  assert (E2 : Rabs (root - W) <= (801 / 100) * (u * u) * W).
  { replace (root - W) with ((root - w) - (W - w)) by ring. eapply Rle_trans; [apply Rabs_minus_le; eassumption|].
    rewrite u_val in *. lra. }
  assert (E3 : Rabs (p + root - (P + W)) <= (801 / 100) * (u * u) * (P + W)).
  { replace (p + root - (P + W)) with ((p - P) + (root - W)) by ring. eapply Rle_trans; [apply Rabs_plus_le; [exact Hp
    | exact E2]|]. rewrite u_val in *. lra. }
  pose proof E3 as E3'. apply Rabs_le_inv in E3'. rewrite (Rabs_pos_eq (p + root)) in Hs by (rewrite u_val in *; lra).
  replace (s - (P + W)) with ((s - (p + root)) + (p + root - (P + W))) by ring. eapply Rle_trans; [apply Rabs_plus_le;
    [exact Hs | exact E3]|]. rewrite u_val in *. lra.
Qed.
(* one quotient of such by another number, either way round *)
Lemma ratio_near : forall a b A B q, 0 < A -> 0 < B -> Rabs (a - A) <= (141 / 10) * (u * u) * A -> Rabs (b - B) <=
  (141 / 10) * (u * u) * B ->
  Rabs (a - A) <= CUT * A \/ Rabs (b - B) <= CUT * B ->
  Rabs (q - a / b) <= QUOTIENT * (u * u) * Rabs (a / b) -> Rabs (q - A / B) <= (302 / 10) * (u * u) * (A / B).
Proof.
  intros a b A B q A0 B0 Ha Hb Hc Hq. unfold CUT in Hc. pose proof u_pos. pose proof Ha as Ha'. pose proof Hb as Hb'.
    apply Rabs_le_inv in Ha'. apply Rabs_le_inv in Hb'.
  assert (a0 : 0 < a) by (rewrite u_val in *; lra). assert (b0 : 0 < b) by (rewrite u_val in *; lra). assert (Q0 : 0 <
    A / B) by (apply Rmult_lt_0_compat; [assumption | now apply Rinv_0_lt_compat]).
  assert (E : Rabs (a / b - A / B) <= (1612 / 100) * (u * u) * (A / B)).
  { apply Rmult_le_reg_r with (b * B); [apply Rmult_lt_0_compat; assumption|]. rewrite <- (Rabs_pos_eq (b * B)) at 1
    by (apply Rmult_le_pos; lra). rewrite <- Rabs_mult.
    replace ((a / b - A / B) * (b * B)) with ((a - A) * B - A * (b - B)) by (field; split; lra). replace (1612 / 100 *
      (u * u) * (A / B) * (b * B)) with (1612 / 100 * (u * u) * (A * b)) by (field; lra).
    assert (AB : 0 <= A * B) by (apply Rmult_le_pos; lra).
    apply Rle_trans with ((1611 / 100) * (u * u) * (A * B)).
    - assert (X : Rabs ((a - A) * B - A * (b - B)) <= Rabs (a - A) * B + A * Rabs (b - B)).
      { eapply Rle_trans; [apply Rabs_minus_le; [apply Rle_refl | apply Rle_refl]|]. rewrite !Rabs_mult, (Rabs_pos_eq
        A), (Rabs_pos_eq B) by lra. lra. }
      eapply Rle_trans; [exact X|]. destruct Hc as [Hc|Hc].
      + assert (Rabs (a - A) * B <= 2 * u * u * A * B) by (apply Rmult_le_compat_r; lra). assert (A * Rabs (b - B) <=
        A * (141 / 10 * (u * u) * B)) by (apply Rmult_le_compat_l; lra).
        assert (0 <= u * u * (A * B)) by (apply Rmult_le_pos; [apply sq_pos | assumption]). lra.
      + assert (Rabs (a - A) * B <= 141 / 10 * (u * u) * A * B) by (apply Rmult_le_compat_r; lra). assert (A * Rabs (b
        - B) <= A * (2 * u * u * B)) by (apply Rmult_le_compat_l; lra).
        assert (0 <= u * u * (A * B)) by (apply Rmult_le_pos; [apply sq_pos | assumption]). lra.
    - assert (A * ((1 - 15 * (u * u)) * B) <= A * b) by (apply Rmult_le_compat_l; lra). replace (A * ((1 - 15 * (u *
      u)) * B)) with ((1 - 15 * (u * u)) * (A * B)) in H0 by ring. rewrite u_val in *. lra. }
  assert (P : 0 < a / b) by (apply Rmult_lt_0_compat; [assumption | now apply Rinv_0_lt_compat]). rewrite (Rabs_pos_eq
    (a / b)) in Hq by lra. pose proof E as E'. apply Rabs_le_inv in E'.
  replace (q - A / B) with ((q - a / b) + (a / b - A / B)) by ring. eapply Rle_trans; [apply Rabs_plus_le; [exact Hq |
    exact E]|]. unfold QUOTIENT. rewrite u_val in *. lra.
Qed.
(* Both pass the rounding test with ERROR of the high part. *)
Theorem ERROR_holds : forall x h l e, 0 < x -> dd h l -> Rabs (h + l - x) <= (302 / 10) * (u * u) * x -> F e -> (1 - 4
  * u) * (ERROR * h) <= e ->
  RN (h + RN (l - e)) = RN (h + RN (l + e)) -> RN (h + RN (l + e)) = RN x.
Proof.
  intros x h l e X0 Hd H Fe He Same. pose proof (dd_low _ _ Hd) as L. pose proof u_pos. pose proof H as H'. apply
    Rabs_le_inv in H'. unfold ERROR in He.
  assert (h0 : 0 < h).
  { apply Rnot_le_lt. intro N. rewrite (Rabs_left1 h) in L by assumption. apply Rabs_le_inv in L. rewrite u_val in *.
    lra. }
  rewrite (Rabs_pos_eq h) in L by lra. pose proof L as L'. apply Rabs_le_inv in L'. destruct Hd as (Fh & Fl & _).
  assert (e0 : 0 <= e) by (rewrite u_val in *; lra). apply (Round.round_if_certain x h l e); auto. rewrite
    Rabs_minus_sym. eapply Rle_trans; [exact H|].
  assert (Rabs l <= u * h) by assumption. clear - H' L L' He h0 e0 X0 H1. rewrite u_val in *. lra.
Qed.

(* ---- Powers of two ---- *)
Theorem SAFE_LEAST_holds : forall x k, / 4 <= Rabs x -> (SAFE_LEAST <= k)%Z -> RN (x * bp k) = RN x * bp k /\ (x * bp
  k = 0 \/ bp (-1020) <= Rabs (x * bp k)).
Proof.
  intros x k X K. unfold SAFE_LEAST in K. assert (x0 : x <> 0) by (intro Z; rewrite Z, Rabs_R0 in X; lra).
  assert (M : (-2 < mag radix2 x)%Z).
  { apply (lt_bpow radix2). eapply Rle_lt_trans; [|apply (bpow_mag_gt radix2)]. replace (bp (-2)) with (/ 4) by
    (simpl; lra). exact X. }
  assert (MK : (mag radix2 (x * bp k) = mag radix2 x + k :> Z)%Z) by now apply mag_mult_bpow.
  split.
  - unfold RN, round, scaled_mantissa, cexp. rewrite MK. replace (fexp (mag radix2 x + k)) with (fexp (mag radix2 x) +
    k)%Z by (unfold fexp, FLT_exp; lia).
    unfold F2R. simpl. replace (x * bp k * bp (- (fexp (mag radix2 x) + k))) with (x * bp (- fexp (mag radix2 x))).
    + rewrite bp_add. ring.
    + rewrite Rmult_assoc, <- bp_add. do 2 f_equal. ring.
  - right. rewrite Rabs_mult, (Rabs_pos_eq (bp k)) by apply Rlt_le, bp_pos. apply Rle_trans with (/ 4 * bp k).
    + replace (/ 4) with (bp (-2)) by (simpl; lra). rewrite <- bp_add. apply bp_le. lia.
    + apply Rmult_le_compat_r; [apply Rlt_le, bp_pos | exact X].
Qed.
Theorem SMALL_holds : forall x k, F x -> x = 0 \/ bp (-115) <= Rabs x -> (- SMALL < k)%Z -> F (x * bp k) /\ (x * bp k
  = 0 \/ bp (-600) <= Rabs (x * bp k)).
Proof.
  intros x k Fx [Z|X] K; unfold SMALL in K.
  - rewrite Z, Rmult_0_l. split; [apply F_0 | now left].
  - assert (M : (-115 < mag radix2 x)%Z) by (apply (lt_bpow radix2); eapply Rle_lt_trans; [exact X | apply
    (bpow_mag_gt radix2)]).
    split; [apply mult_bpow_exact_FLT; [exact Fx | lia]|]. right. rewrite Rabs_mult, (Rabs_pos_eq (bp k)) by apply
      Rlt_le, bp_pos.
    apply Rle_trans with (bp (-115) * bp k); [rewrite <- bp_add; apply bp_le; lia | apply Rmult_le_compat_r; [apply
      Rlt_le, bp_pos | exact X]].
Qed.
