(* rt-shade, mapping.rs: texture coordinates of a normal within bounds; certified/power.rs: the exponential series. *)
From Proofs Require Import Rounding Steps.
From Coq Require Import Ratan.
Open Scope R_scope.

(* Shares of a turn and of half a turn for the error over the distance, and what rounding adds. *)
Definition TURN_SHARE := 161 / 1000.
Definition HALF_SHARE := 322 / 1000.
Definition COORDINATE_ROUNDING := 11 / 10 * u.
(* Errors are known up to that part. *)
Definition LARGEST_PART := 1 / 16.

Lemma PI_low : 311 / 100 <= PI.
Proof.
  pose proof (proj1 (PI_ineq 16)) as H. unfold tg_alt, PI_tg in H. cbn [sum_f_R0 Nat.mul Nat.add] in H. rewrite
    !INR_IZR_INZ in H.
  cbn [Z.of_nat Pos.of_succ_nat Pos.succ] in H.
  repeat match type of H with context [(-1) ^ ?n] => let v := eval compute in (Nat.even n) in match v with
    | true => replace ((-1) ^ n) with 1 in H by (simpl; ring) | false => replace ((-1) ^ n) with (-1) in H by (simpl;
      ring) end end.
  lra.
Qed.
(* An angle whose sine is at most s is at most 1.0007 s. *)
Lemma angle_near : forall t s, 0 <= t <= PI / 2 -> sin t <= s -> 0 <= s <= LARGEST_PART -> t <= 10007 / 10000 * s.
Proof.
  intros t s Ht Hs S. unfold LARGEST_PART in S. pose proof PI_low as P. apply Rnot_lt_le. intro N. set (a := 10007 /
    10000 * s) in *.
  assert (A : 0 <= a <= 63 / 1000) by (unfold a; lra).
  assert (L : a - a * a * a / 6 <= sin a).
  { destruct (sin_bound a 0 ltac:(lra) ltac:(lra)) as [L _]. unfold sin_approx, sin_term in L. cbn [sum_f_R0 Nat.mul
    Nat.add] in L.
    assert (F3 : INR (fact 3) = 6) by (simpl; ring). assert (F1 : INR (fact 1) = 1) by (simpl; ring). rewrite F3, F1
      in L. simpl in L. lra. }
  assert (K : s <= sin a).
  { eapply Rle_trans; [|exact L]. assert (a * a <= 63 / 1000 * a) by (apply Rmult_le_compat_r; lra). assert (a * a * a
    <= 63 / 1000 * a * a) by (apply Rmult_le_compat_r; lra). unfold a in *. nra. }
  assert (sin a < sin t) by (apply sin_increasing_1; lra). lra.
Qed.
(* t is the angle between the exact projection of the normal and the one known, h its length, e its error: sin t <=
  e/h. *)
Theorem TURN_SHARE_holds : forall t e h, 0 <= t <= PI / 2 -> 0 < h -> 0 <= e -> e <= LARGEST_PART * h -> sin t <= e /
  h ->
  t / (2 * PI) + 6 / 10 * u <= (1 - 8 * u) * (TURN_SHARE * (e / h) + COORDINATE_ROUNDING) /\
  t / PI + 6 / 10 * u <= (1 - 8 * u) * (HALF_SHARE * (e / h) + COORDINATE_ROUNDING).
Proof.
  intros t e h Ht h0 e0 He Hs. pose proof PI_low as P. pose proof u_pos as up. set (s := e / h) in *.
  assert (S0 : 0 <= s) by (unfold s; apply Rmult_le_pos; [assumption | apply Rlt_le, Rinv_0_lt_compat; assumption]).
  assert (S1 : s <= LARGEST_PART) by (unfold s; apply Rmult_le_reg_r with h; [assumption|]; replace (e / h * h) with e
    by (field; lra); exact He).
  pose proof (angle_near t s Ht Hs (conj S0 S1)) as A. assert (TP : t / PI <= 32178 / 100000 * s).
  { apply Rmult_le_reg_r with PI; [lra|]. replace (t / PI * PI) with t by (field; lra). eapply Rle_trans; [exact A|].
    apply Rle_trans with (32178 / 100000 * s * (311 / 100)); [lra | apply Rmult_le_compat_l; lra]. }
  replace (t / (2 * PI)) with (t / PI / 2) by (field; lra). unfold TURN_SHARE, HALF_SHARE, COORDINATE_ROUNDING. set (x
    := t / PI) in *. clear - TP S0 up. split; rewrite u_val; lra.
Qed.
Theorem HALF_SHARE_holds : forall t e l, 0 <= t <= PI / 2 -> 0 < l -> 0 <= e -> e <= LARGEST_PART * l -> sin t <= e /
  l ->
  t / PI + 6 / 10 * u <= (1 - 8 * u) * (HALF_SHARE * (e / l) + COORDINATE_ROUNDING).
Proof. intros t e l H1 H2 H3 H4 H5. exact (proj2 (TURN_SHARE_holds t e l H1 H2 H3 H4 H5)). Qed.
Theorem COORDINATE_ROUNDING_holds : 6 / 10 * u <= (1 - 8 * u) * COORDINATE_ROUNDING.
Proof. unfold COORDINATE_ROUNDING. rewrite u_val. lra. Qed.
Theorem LARGEST_PART_holds : forall t s, 0 <= t <= PI / 2 -> sin t <= s -> 0 <= s <= LARGEST_PART -> t <= 10007 /
  10000 * s.
Proof. exact angle_near. Qed.

(* ---- The exponential series: what n terms leave out ---- *)
Definition term y i := / INR (fact i) * y ^ i.
Fixpoint taken y n := match n with O => 0 | S m => taken y m + term y m end.
Lemma taken_sum : forall y n, taken y (S n) = sum_f_R0 (term y) n.
Proof. intros y n. induction n; [simpl; ring|]. change (taken y (S (S n))) with (taken y (S n) + term y (S n)).
  rewrite IHn. reflexivity. Qed.
Lemma term_halves : forall y i, Rabs y <= / 2 -> Rabs (term y (S i)) <= / 2 * Rabs (term y i).
Proof.
  intros y i Y. unfold term. rewrite !Rabs_mult. change (y ^ S i) with (y * y ^ i). rewrite Rabs_mult, !Rabs_inv.
    change (fact (S i)) with (S i * fact i)%nat.
  rewrite mult_INR, Rabs_mult, !(Rabs_pos_eq (INR _)) by apply pos_INR. pose proof (INR_fact_lt_0 i) as F. assert (1
    <= INR (S i)) by (rewrite S_INR; pose proof (pos_INR i); lra).
  rewrite Rinv_mult. assert (G : / INR (S i) <= 1) by (rewrite <- Rinv_1; apply Rinv_le_contravar; lra). assert (0 < /
    INR (S i)) by (apply Rinv_0_lt_compat; lra).
  assert (F2 : 0 < / INR (fact i)) by now apply Rinv_0_lt_compat. pose proof (Rabs_pos y). pose proof (Rabs_pos (y ^
    i)).
  assert (/ INR (S i) * Rabs y <= 1 * / 2) by (apply Rmult_le_compat; lra). assert (0 <= / INR (fact i) * Rabs (y ^
    i)) by (apply Rmult_le_pos; lra).
  replace (/ INR (S i) * / INR (fact i) * (Rabs y * Rabs (y ^ i))) with (/ INR (S i) * Rabs y * (/ INR (fact i) * Rabs
    (y ^ i))) by ring. apply Rmult_le_compat_r; lra.
Qed.
Theorem exponential_rest : forall y n, Rabs y <= / 2 -> Rabs (exp y - taken y n) <= 2 * Rabs (term y n).
Proof.
  intros y n Y. assert (Th : forall m, Rabs (term y (n + m)) <= (/ 2) ^ m * Rabs (term y n)).
  { induction m; [rewrite Nat.add_0_r; simpl; lra|]. replace (n + S m)%nat with (S (n + m)) by lia. eapply Rle_trans;
    [now apply term_halves|]. simpl pow. rewrite Rmult_assoc. apply Rmult_le_compat_l; lra. }
  assert (Ta : forall m, Rabs (taken y (n + m) - taken y n) <= (2 - 2 * (/ 2) ^ m) * Rabs (term y n)).
  { induction m; [rewrite Nat.add_0_r; replace (taken y n - taken y n) with 0 by ring; rewrite Rabs_R0; simpl; lra|].
    replace (n + S m)%nat with (S (n + m)) by lia.
    change (taken y (S (n + m))) with (taken y (n + m) + term y (n + m)). replace (taken y (n + m) + term y (n + m) -
      taken y n) with ((taken y (n + m) - taken y n) + term y (n + m)) by ring.
    eapply Rle_trans; [apply Rabs_plus_le; [exact IHm | apply Th]|]. simpl pow. apply Req_le. field. }
  set (b := 2 * Rabs (term y n)). assert (Tb : forall m, Rabs (taken y (n + m) - taken y n) <= b).
  { intro m. eapply Rle_trans; [apply Ta|]. unfold b. apply Rmult_le_compat_r; [apply Rabs_pos|]. pose proof (pow_lt
    (/ 2) m ltac:(lra)). lra. }
  apply Rnot_lt_le. intro N. set (eps := Rabs (exp y - taken y n) - b). assert (E0 : eps > 0) by (unfold eps; lra).
  assert (EX : infinite_sum (term y) (exp y)).
  { unfold exp. destruct (exist_exp y) as [l Hl]. exact Hl. }
  destruct (EX eps E0) as [K HK]. specialize (HK (n + K)%nat ltac:(lia)). unfold R_dist in HK. rewrite <- taken_sum in
    HK. replace (S (n + K)) with (n + S K)%nat in HK by lia.
  pose proof (Tb (S K)) as T. pose proof (Rabs_triang (exp y - taken y (n + S K)) (taken y (n + S K) - taken y n)) as
    Tr.
  replace (exp y - taken y (n + S K) + (taken y (n + S K) - taken y n)) with (exp y - taken y n) in Tr by ring.
    rewrite (Rabs_minus_sym (exp y) (taken y (n + S K))) in Tr. unfold eps in HK. lra.
Qed.
(* The next term is below two to the sum of what the code counts for each factor y / j, where |y| <= 2^-(k+1): k + 1
  and the whole part of log2 j. *)
Fixpoint counted (k : Z) n : Z := match n with O => 0 | S m => counted k m + (k + 1 + Z.log2 (Z.of_nat (S m))) end%Z.
Theorem exponential_terms : forall k y n, Rabs y <= bp (- (k + 1)) -> Rabs (term y n) <= bp (- counted k n).
Proof.
  intros k y n Y. induction n.
  - unfold term. simpl. rewrite Rinv_1, Rmult_1_l, Rabs_R1. lra.
  - assert (E : term y (S n) = y / INR (S n) * term y n).
    { unfold term. change (fact (S n)) with (S n * fact n)%nat. rewrite mult_INR. change (y ^ S n) with (y * y ^ n).
      field. split; [apply INR_fact_neq_0 | apply not_0_INR; lia]. }
    rewrite E. change (counted k (S n)) with (counted k n + (k + 1 + Z.log2 (Z.of_nat (S n))))%Z.
    replace (- (counted k n + (k + 1 + Z.log2 (Z.of_nat (S n)))))%Z with ((- (k + 1) + - Z.log2 (Z.of_nat (S n))) + -
      counted k n)%Z by ring. rewrite !bp_add.
    apply Rabs_mult_le; [|exact IHn]. assert (J : bp (Z.log2 (Z.of_nat (S n))) <= INR (S n)).
    { rewrite INR_IZR_INZ. pose proof (Z.log2_spec (Z.of_nat (S n)) ltac:(lia)) as [L _]. rewrite <- (IZR_Zpower
      radix2) by apply Z.log2_nonneg. apply IZR_le. exact L. }
    pose proof (bp_pos (Z.log2 (Z.of_nat (S n)))). apply Rabs_div_le; [apply not_0_INR; lia|]. rewrite (Rabs_pos_eq
      (INR (S n))) by apply pos_INR. eapply Rle_trans; [exact Y|].
    rewrite Rmult_assoc. rewrite <- (Rmult_1_r (bp (- (k + 1)))) at 1. apply Rmult_le_compat_l; [apply Rlt_le, bp_pos|].
    replace 1 with (bp (- Z.log2 (Z.of_nat (S n))) * bp (Z.log2 (Z.of_nat (S n)))) by (rewrite <- bp_add; replace (-
      Z.log2 (Z.of_nat (S n)) + Z.log2 (Z.of_nat (S n)))%Z with 0%Z by ring; reflexivity).
    apply Rmult_le_compat_l; [apply Rlt_le, bp_pos | exact J].
Qed.
