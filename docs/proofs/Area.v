(* figures, import/polygon.rs, `facing`: the area of a polygon along an axis, a sum of any number of terms. *)
From Proofs Require Import Rounding.
Open Scope R_scope.

(* The error of an area of n terms is (PER_TERM n + AT_ONCE) u of the sum of all magnitudes; an axis is taken whose area
   exceeds FACING times that. *)
Definition PER_TERM := 2.
Definition AT_ONCE := 16.
Definition FACING := 4.

Section Area.
(* the products of a term, exactly and as computed *)
Variables L Q l q : nat -> R.
Hypotheses (Fl : forall i, F (l i)) (Fq : forall i, F (q i))
  (Hl : forall i, Rabs (l i - L i) <= (3 + / 500) * u * Rabs (L i) + bp (-1060))
  (Hq : forall i, Rabs (q i - Q i) <= (3 + / 500) * u * Rabs (Q i) + bp (-1060)).
Fixpoint area k := match k with O => 0 | S k => RN (area k + RN (l k - q k)) end.
Fixpoint size k := match k with O => 0 | S k => RN (size k + RN (Rabs (l k) + Rabs (q k))) end.
Fixpoint exactly k := match k with O => 0 | S k => exactly k + (L k - Q k) end.
(* the magnitudes of what was computed *)
Fixpoint sizes k := match k with O => 0 | S k => sizes k + (Rabs (l k) + Rabs (q k)) end.
Let t := bp (-1060).
Lemma t_pos : 0 < t /\ bp (-1075) <= / 1000 * t.
Proof.
  split; [apply bp_pos|]. apply Rle_trans with (bp (-10 + -1060)); [apply bp_le; lia|]. rewrite bp_add. fold t.
  unfold t. pose proof (bp_pos (-1060)). simpl (bp (-10)). lra.
Qed.
Lemma sizes_pos : forall k, 0 <= sizes k.
Proof. induction k; simpl; [lra|]. pose proof (Rabs_pos (l k)). pose proof (Rabs_pos (q k)). lra. Qed.
Lemma term_error : forall i, Rabs (RN (l i - q i) - (L i - Q i)) <= (402 / 100) * u * (Rabs (l i) + Rabs (q i)) + 3 * t
  /\ Rabs (L i - Q i) <= (1 + / 1000) * (Rabs (l i) + Rabs (q i)) + 3 * t.
Proof.
  intro i. destruct t_pos as [T0 T1]. pose proof u_pos as U. pose proof (Hl i) as E1. pose proof (Hq i) as E2.
  fold t in E1, E2.
  pose proof (RN_diff (l i) (q i) (Fl i) (Fq i)) as E3.
  assert (A : forall x X, Rabs (x - X) <= (3 + / 500) * u * Rabs X + t ->
    Rabs (x - X) <= (3 + / 300) * u * Rabs x + (1 + / 1000) * t /\ Rabs X <= (1 + / 2000) * Rabs x + (1 + / 500) * t).
  { intros x X H. assert (B : Rabs X <= Rabs x + Rabs (x - X)) by (replace X with (x + - (x - X)) at 1 by ring;
      eapply Rle_trans; [apply Rabs_triang|]; rewrite Rabs_Ropp; lra).
    pose proof (Rabs_pos x). pose proof (Rabs_pos X). rewrite u_val in *. split; lra. }
  destruct (A _ _ E1) as [A1 A2]. destruct (A _ _ E2) as [A3 A4].
  assert (D : Rabs (l i - q i) <= Rabs (l i) + Rabs (q i)) by (unfold Rminus; eapply Rle_trans; [apply Rabs_triang|];
    rewrite Rabs_Ropp; lra).
  assert (D2 : u * Rabs (l i - q i) <= u * (Rabs (l i) + Rabs (q i))) by (apply Rmult_le_compat_l; lra).
  pose proof (Rabs_pos (l i)). pose proof (Rabs_pos (q i)). split.
  - replace (RN (l i - q i) - (L i - Q i)) with ((RN (l i - q i) - (l i - q i)) + (l i - L i) + - (q i - Q i)) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
    rewrite Rabs_Ropp.
    rewrite u_val in *. lra.
  - unfold Rminus. eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. lra.
Qed.
(* up to 2^21 terms *)
Lemma area_error : forall k, INR k <= 2097152 ->
  Rabs (area k - exactly k) <= (403 / 100 + (1 + / 100) * INR k) * (u * sizes k) + 4 * INR k * t /\
  Rabs (exactly k) <= (1 + / 1000) * sizes k + 3 * INR k * t.
Proof.
  destruct t_pos as [T0 T1]. pose proof u_pos as U. induction k as [|k IH]; intro K.
  - change (INR 0) with 0. cbn [area exactly sizes]. rewrite Rminus_0_r, Rabs_R0. split; lra.
  - rewrite S_INR in *. destruct (IH ltac:(lra)) as [I1 I2]. clear IH. cbn [area exactly sizes].
    destruct (term_error k) as [E1 E2]. pose proof (pos_INR k) as K0. pose proof (sizes_pos k) as S0.
    set (s := sizes k) in *. set (o := Rabs (l k) + Rabs (q k)) in *.
    assert (o0 : 0 <= o) by (unfold o; pose proof (Rabs_pos (l k)); pose proof (Rabs_pos (q k)); lra).
    set (d := RN (l k - q k)) in *. set (n := INR k) in *. set (D := L k - Q k) in *.
    split.
    2:{ eapply Rle_trans; [apply Rabs_triang|]. lra. }
    pose proof (RN_err (area k + d)) as R. set (a := area k) in *. set (x := exactly k) in *.
    assert (us0 : 0 <= u * s) by (apply Rmult_le_pos; lra). assert (uo0 : 0 <= u * o) by (apply Rmult_le_pos; lra).
    assert (nt : 0 <= n * t) by (apply Rmult_le_pos; lra).
    (* the magnitude of the sum *)
    assert (C : (403 / 100 + (1 + / 100) * n) * (u * s) <= / 1000 * s).
    { replace ((403 / 100 + (1 + / 100) * n) * (u * s)) with ((403 / 100 + (1 + / 100) * n) * u * s) by ring.
      apply Rmult_le_compat_r; [assumption|]. rewrite u_val. lra. }
    assert (M : Rabs (a + d) <= (1 + / 200) * (s + o) + 8 * (n + 1) * t).
    { replace (a + d) with ((a - x) + (d - D) + (x + D)) by ring. eapply Rle_trans; [apply Rabs_triang|].
      eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|]. pose proof (Rabs_triang x D).
      replace ((402 / 100) * u * o) with ((402 / 100) * (u * o)) in E1 by ring.
      assert (u * o <= / 1000000 * o) by (apply Rmult_le_compat_r; [assumption | rewrite u_val; lra]). lra. }
    assert (UM : u * Rabs (a + d) <= u * ((1 + / 200) * (s + o) + 8 * (n + 1) * t)) by (apply Rmult_le_compat_l; lra).
    replace (u * ((1 + / 200) * (s + o) + 8 * (n + 1) * t)) with ((1 + / 200) * (u * s) + (1 + / 200) * (u * o) +
      8 * u * (n * t + t)) in UM by ring.
    assert (UT : 8 * u * (n * t + t) <= / 1000 * t).
    { replace (8 * u * (n * t + t)) with (8 * u * (n + 1) * t) by ring.
    apply Rmult_le_compat_r; [lra | rewrite u_val; lra]. }
    replace (RN (a + d) - (x + D)) with ((RN (a + d) - (a + d)) + (a - x) + (d - D)) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
    replace ((403 / 100 + (1 + / 100) * (n + 1)) * (u * (s + o))) with ((403 / 100 + (1 + / 100) * n) * (u * s) + (1
      + / 100) *
      (u * s) + (403 / 100) * (u * o) + (1 + / 100) * (u * o) + (1 + / 100) * (n * (u * o))) by ring.
    assert (0 <= n * (u * o)) by (apply Rmult_le_pos; lra).
    replace (4 * (n + 1) * t) with (4 * (n * t) + 4 * t) by ring. replace (4 * n * t) with (4 * (n * t)) in I1 by ring.
    replace ((402 / 100) * u * o) with ((402 / 100) * (u * o)) in E1 by ring. lra.
Qed.
Lemma size_low : forall k, INR k <= 2097152 -> (1 - (INR k + 2) * u) * sizes k <= size k /\ F (size k) /\ 0 <= size k.
Proof.
  pose proof u_pos as U. induction k as [|k IH]; intro K.
  - change (INR 0) with 0. cbn [size sizes]. split; [lra|]. split; [apply F_0 | lra].
  - rewrite S_INR in *. destruct (IH ltac:(lra)) as (I1 & I2 & I3). clear IH. cbn [size sizes].
  pose proof (pos_INR k) as K0.
    pose proof (sizes_pos k) as S0. set (o := Rabs (l k) + Rabs (q k)).
    assert (o0 : 0 <= o) by (unfold o; pose proof (Rabs_pos (l k)); pose proof (Rabs_pos (q k)); lra).
    assert (Fa : forall x, F x -> F (Rabs x)) by (intros; now apply generic_format_abs).
    pose proof (RN_sum _ _ (Fa _ (Fl k)) (Fa _ (Fq k))) as E1. fold o in E1. set (p := RN o) in *.
    rewrite (Rabs_pos_eq o) in E1 by lra.
    apply Rabs_le_inv in E1. assert (p0 : 0 <= p) by (unfold p; rewrite <- RN_0; now apply RN_le).
    pose proof (RN_sum (size k) p I2 (RN_F _)) as E2. rewrite (Rabs_pos_eq (size k + p)) in E2 by lra.
    apply Rabs_le_inv in E2.
    split; [|split; [apply RN_F | rewrite <- RN_0; apply RN_le; lra]]. set (s := sizes k) in *. set (n := INR k) in *.
    assert (NU : (n + 2) * u <= / 1000) by (rewrite u_val; lra).
    assert (A : (1 - (n + 2) * u) * (s + o) <= size k + p).
    { assert ((1 - (n + 2) * u) * o <= (1 - u) * o) by (apply Rmult_le_compat_r; [assumption|];
      assert (0 <= (n + 1) * u) by
        (apply Rmult_le_pos; lra); lra). lra. }
    assert (B : (1 - u) * ((1 - (n + 2) * u) * (s + o)) <= (1 - u) * (size k + p)) by (apply Rmult_le_compat_l;
      [rewrite u_val; lra | assumption]).
    assert (C : (1 - (n + 1 + 2) * u) * (s + o) <= (1 - u) * ((1 - (n + 2) * u) * (s + o))).
    { rewrite <- Rmult_assoc. apply Rmult_le_compat_r; [lra|]. assert (0 <= (n + 2) * u * u) by (apply Rmult_le_pos;
      [apply Rmult_le_pos|]; lra). lra. }
    lra.
Qed.
End Area.

(* The bound as computed, of any size that is at least the sum of this axis. *)
Definition bound n s := RN (RN ((PER_TERM * n + AT_ONCE) * u * s) + RN (n * bp (-1022))).
Theorem AT_ONCE_holds : forall L Q l q k s, (forall i, F (l i)) -> (forall i, F (q i)) ->
  (forall i, Rabs (l i - L i) <= (3 + / 500) * u * Rabs (L i) + bp (-1060)) ->
  (forall i, Rabs (q i - Q i) <= (3 + / 500) * u * Rabs (Q i) + bp (-1060)) -> 1 <= INR k <= 2097152 ->
  size l q k <= s -> Rabs (area l q k - exactly L Q k) <= / 2 * (1 + / 4) * bound (INR k) s.
Proof.
  intros L Q l q k s Fl Fq Hl Hq [K1 K] Hs. destruct (area_error L Q l q Fl Fq Hl Hq k K) as [E _].
  destruct (size_low l q Fl Fq k K) as (S1 & _ & S2). pose proof (sizes_pos l q k) as S0. pose proof u_pos as U.
  set (n := INR k) in *. set (z := sizes l q k) in *. unfold bound, PER_TERM, AT_ONCE.
  assert (NU : (n + 2) * u <= / 1000) by (rewrite u_val; lra).
  assert (SZ : (1 - / 1000) * z <= s) by (assert ((1 - / 1000) * z <= (1 - (n
    + 2) * u) * z) by (apply Rmult_le_compat_r; lra); lra).
  assert (s0 : 0 <= s) by lra.
  pose proof (RN_err ((2 * n + 16) * u * s)) as R1. set (g := RN ((2 * n + 16) * u * s)) in *.
  assert (G0 : 0 <= (2 * n + 16) * u * s) by (apply Rmult_le_pos; [apply Rmult_le_pos|]; lra).
  rewrite (Rabs_pos_eq ((2 * n + 16) * u * s)) in R1 by assumption. apply Rabs_le_inv in R1.
  pose proof (RN_err (n * bp (-1022))) as R2. set (h := RN (n * bp (-1022))) in *. pose proof (bp_pos (-1022)) as M0.
  assert (nm : bp (-1022) <= n * bp (-1022)) by (rewrite <- (Rmult_1_l (bp (-1022))) at 1; apply Rmult_le_compat_r;
    lra).
  rewrite (Rabs_pos_eq (n * bp (-1022))) in R2 by lra. apply Rabs_le_inv in R2.
  assert (g0 : 0 <= g) by (unfold g; rewrite <- RN_0; apply RN_le; assumption).
  assert (h0 : 0 <= h) by (unfold h; rewrite <- RN_0; apply RN_le; lra).
  pose proof (RN_err (g + h)) as R3. rewrite (Rabs_pos_eq (g + h)) in R3 by lra. apply Rabs_le_inv in R3.
  assert (T1 : bp (-1075) <= / 1000 * bp (-1022)) by (apply Rle_trans with (bp (-10 + -1022)); [apply bp_le; lia|];
    rewrite bp_add; simpl (bp (-10)); lra).
  assert (T2 : bp (-1060) <= / 1000 * bp (-1022)) by (apply Rle_trans with (bp (-10 + -1022)); [apply bp_le; lia|];
    rewrite bp_add; simpl (bp (-10)); lra).
  assert (T3 : n * bp (-1060) <= / 1000 * (n * bp (-1022))) by (replace (/ 1000 * (n * bp (-1022))) with (n * (/ 1000 *
    bp (-1022))) by ring; apply Rmult_le_compat_l; lra).
  assert (uz : 0 <= u * z) by (apply Rmult_le_pos; lra). assert (us : (1 - / 1000) * (u * z) <= u * s).
  { replace ((1 - / 1000) * (u * z)) with (u * ((1 - / 1000) * z)) by ring. apply Rmult_le_compat_l; lra. }
  assert (nus : n * ((1 - / 1000) * (u * z)) <= n * (u * s)) by (apply Rmult_le_compat_l; lra).
  assert (nuz : 0 <= n * (u * z)) by (apply Rmult_le_pos; lra).
  replace ((403 / 100 + (1 + / 100) * n) * (u * z)) with ((403 / 100) * (u * z) + (1
    + / 100) * (n * (u * z))) in E by ring.
  replace (4 * n * bp (-1060)) with (4 * (n * bp (-1060))) in E by ring.
  replace ((2 * n + 16) * u * s) with (2 * (n * (u * s)) + 16 * (u * s)) in * by ring.
  replace (n * ((1 - / 1000) * (u * z))) with ((1 - / 1000) * (n * (u * z))) in nus by ring.
  rewrite u_val in *. lra.
Qed.
(* What area_error counts is hardly more than half of the factor. *)
Theorem PER_TERM_holds : forall n : R, 1 <= n -> 403 / 100 + (1 + / 100) * n <= (/ 2 + / 100) * (PER_TERM * n
  + AT_ONCE).
Proof. intros. unfold PER_TERM, AT_ONCE. lra. Qed.
(* An axis that is taken: the turn is that of the exact area,
  and along no other axis there is more than twice as much. *)
Theorem FACING_holds : forall a A b B e, Rabs (a - A) <= e -> Rabs (b - B) <= e -> Rabs b <= Rabs a -> FACING * e <
  Rabs a ->
  (0 < a -> 0 < A) /\ (a < 0 -> A < 0) /\ Rabs B <= 2 * Rabs A.
Proof.
  intros a A b B e H1 H2 H3 H4. unfold FACING in H4. pose proof (Rabs_pos (a - A)).
  assert (A1 : Rabs a <= Rabs A + e) by (replace a with (A + (a - A)) at 1 by ring; eapply Rle_trans;
    [apply Rabs_triang|]; lra).
  assert (B1 : Rabs B <= Rabs b + e) by (replace B with (b + - (b - B)) at 1 by ring; eapply Rle_trans;
    [apply Rabs_triang|];
    rewrite Rabs_Ropp; lra).
  apply Rabs_le_inv in H1. split; [|split; [|lra]].
  - intro P. rewrite (Rabs_pos_eq a) in H4 by lra. lra.
  - intro P. rewrite (Rabs_left a) in H4 by lra. lra.
Qed.
