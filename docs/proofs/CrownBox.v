(* rt-geom, bvh/crown.rs, `Line64`: the whole test of a box, by one ray and by many from one origin, with infinite
  planes,
   reciprocals and parameters, and NaN. *)
From Proofs Require Import Rounding Crown.
Open Scope R_scope.

(* ---- Doubles with their infinities (the sign of a zero decides nothing here) ---- *)
Inductive ext := Fin (x : R) | Top | Bottom | Nan.
Definition neg a := match a with Fin x => Fin (- x) | Top => Bottom | Bottom => Top | Nan => Nan end.
Definition sign a := match a with Fin x => x | Top => 1 | Bottom => - 1 | Nan => 0 end.
Definition infinite s := if Rlt_dec 0 s then Top else if Rlt_dec s 0 then Bottom else Nan.
Definition minus a o := match a with Fin x => Fin (RN (x - o)) | _ => a end.
Definition times a b := match a, b with
  | Fin x, Fin y => Fin (RN (x * y)) | Nan, _ => Nan | _, Nan => Nan | _, _ => infinite (sign a * sign b) end.
Definition le a b := match a, b with
  | Nan, _ => False | _, Nan => False | Bottom, _ => True | _, Top => True | Fin x, Fin y => x <= y | _, _ => False
    end.
(* The larger and the smaller of two; where one is NaN, either. *)
Definition larger a b m := (m = a \/ m = b) /\ (a <> Nan -> b <> Nan -> le a m /\ le b m).
Definition smaller a b m := (m = a \/ m = b) /\ (a <> Nan -> b <> Nan -> le m a /\ le m b).
(* One over a component, along an axis on whose side s the rays go. *)
Definition inverse s d := if Req_EM_T d 0 then infinite s else Fin (RN (/ d)).
Definition lowered_ext a := match a with Fin x => Fin (lowered x) | Bottom => Bottom | _ => Nan end.
Definition raised_ext a := match a with Fin x => Fin (raised x) | Top => Top | _ => Nan end.

Lemma infinite_opp : forall s, infinite (- s) = neg (infinite s).
Proof. intro s. unfold infinite. repeat destruct Rlt_dec; simpl; try reflexivity; exfalso; lra. Qed.
Lemma minus_neg : forall p o, minus (neg p) (- o) = neg (minus p o).
Proof.
  destruct p; intro o; simpl; try reflexivity. f_equal. replace (- x - - o) with (- (x - o)) by ring. apply RN_opp.
Qed.
Lemma times_neg : forall a b, times (neg a) (neg b) = times a b.
Proof.
  destruct a, b; simpl; try reflexivity; f_equal; try (f_equal; ring); ring.
Qed.
Lemma inverse_neg : forall s d, inverse (- s) (- d) = neg (inverse s d).
Proof.
  intros s d. unfold inverse. destruct (Req_EM_T (- d) 0) as [A|A]; destruct (Req_EM_T d 0) as [B|B]; try (exfalso;
    lra).
  - apply infinite_opp.
  - simpl. f_equal. rewrite Rinv_opp. apply RN_opp.
Qed.

(* ---- One axis ---- *)
Definition ordinary d := d = 0 \/ SHORTEST < Rabs d <= bp 100.
(* Whether a point is strictly inside of the planes. *)
Definition below low P := match low with Fin l => F l /\ l < P | Bottom => True | _ => False end.
Definition above high P := match high with Fin h => F h /\ P < h | Top => True | _ => False end.
(* What a plane must give for a hit at t'. *)
Definition enters n t' := n = Bottom \/ exists x, n = Fin x /\ F x /\ x <= t' + (3 + / 100) * u * Rabs t' + bp
  (-1075).
Definition leaves f t' := f = Top \/ exists x, f = Fin x /\ F x /\ t' - (3 + / 100) * u * Rabs t' - bp (-1075) <= x.
Lemma RN_neg : forall x y, F x -> F y -> x < y -> RN (x - y) < 0.
Proof.
  intros x y Fx Fy H. assert (N : RN (x - y) <= 0) by (rewrite <- RN_0; apply RN_le; lra).
  destruct N as [N|N]; [assumption|]. exfalso. assert (x + - y = 0); [|lra].
  apply (Plus_error.round_plus_eq_0 radix2 fexp ZnearestE x (- y)); [exact Fx | now apply F_opp | exact N].
Qed.
Lemma inverse_pos : forall d, SHORTEST < d <= bp 100 -> 0 < RN (/ d) /\ SHORTEST < Rabs d <= bp 100.
Proof.
  intros d [D0 D1]. assert (P : 0 < SHORTEST) by apply bp_pos. rewrite Rabs_pos_eq by lra. split; [|lra].
  apply Rlt_le_trans with (bp (-100)); [apply bp_pos|]. rewrite <- (RN_id (bp (-100))) by (apply F_bp; lia).
  apply RN_le. change (-100)%Z with (Z.opp 100). rewrite bpow_opp. apply Rinv_le_contravar; lra.
Qed.
Lemma slack_pos : forall t', 0 <= (3 + / 100) * u * Rabs t' /\ 0 < bp (-1075).
Proof. intro t'. pose proof u_pos. pose proof (Rabs_pos t'). split; [apply Rmult_le_pos; lra | apply bp_pos]. Qed.

(* Rays that go up meet the lower plane by the greatest component. *)
Lemma near_up : forall low o d fast t', F o -> below low (o + t' * d) -> 0 <= fast -> ordinary fast ->
  t' * d <= t' * fast -> enters (times (minus low o) (inverse 1 fast)) t'.
Proof.
  intros low o d fast t' Fo Hl F0 Of Hf. pose proof (bp_pos (-500)) as S0. destruct (slack_pos t') as [K0 K1].
  unfold inverse, infinite. destruct (Rlt_dec 0 1) as [_|]; [|lra]. destruct (Req_EM_T fast 0) as [Z|N].
  - left. destruct low as [l| | |]; simpl in Hl; try contradiction; simpl.
    + destruct Hl as [Fl L]. assert (LO : l < o) by (subst fast; lra). pose proof (RN_neg l o Fl Fo LO) as Q.
      unfold infinite. rewrite Rmult_1_r. destruct Rlt_dec; [lra|]. now destruct Rlt_dec; [|lra].
    + unfold infinite. destruct Rlt_dec; [lra|]. now destruct Rlt_dec; [|lra].
  - destruct Of as [Z|Of]; [contradiction|]. rewrite Rabs_pos_eq in Of by assumption.
    destruct (inverse_pos fast Of) as [I0 Oa].
    destruct low as [l| | |]; simpl in Hl; try contradiction; simpl.
    + destruct Hl as [Fl L]. right. exists (meeting l o fast). split; [reflexivity|]. split; [apply RN_F|].
      apply meeting_before; auto. apply Rmult_le_reg_r with fast; [lra|].
      unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra. lra.
    + left. unfold infinite. destruct Rlt_dec; [exfalso; nra|]. destruct Rlt_dec; [reflexivity | exfalso; nra].
Qed.
(* And they meet the upper plane by the least. *)
Lemma far_up : forall high o slow t', F o -> 0 <= slow -> ordinary slow -> above high (o + t' * slow) ->
  leaves (times (minus high o) (inverse 1 slow)) t'.
Proof.
  intros high o slow t' Fo S0 Os Hh. pose proof (bp_pos (-500)) as P5. destruct (slack_pos t') as [K0 K1].
  unfold inverse, infinite. destruct (Rlt_dec 0 1) as [_|]; [|lra]. destruct (Req_EM_T slow 0) as [Z|N].
  - left. destruct high as [h| | |]; try contradiction; simpl.
    + destruct Hh as [Fh H]. assert (HO : o < h) by (subst slow; lra). pose proof (RN_neg o h Fo Fh HO) as Q.
      replace (h - o) with (- (o - h)) by ring. rewrite RN_opp. unfold infinite. now destruct Rlt_dec; [|lra].
    + unfold infinite. now destruct Rlt_dec; [|lra].
  - destruct Os as [Z|Os]; [contradiction|]. rewrite Rabs_pos_eq in Os by assumption.
    destruct (inverse_pos slow Os) as [I0 Oa].
    destruct high as [h| | |]; try contradiction; simpl.
    + destruct Hh as [Fh H]. right. exists (meeting h o slow). split; [reflexivity|]. split; [apply RN_F|].
      assert (M : meeting (- h) (- o) slow <= - t' + (3 + / 100) * u * Rabs (- t') + bp (-1075)).
      { apply meeting_before; auto using F_opp. apply Rmult_le_reg_r with slow; [lra|]. unfold Rdiv.
        rewrite Rmult_assoc, Rinv_l by lra. lra. }
      assert (E : meeting (- h) (- o) slow = - meeting h o slow).
      { unfold meeting. replace (- h - - o) with (- (h - o)) by ring. rewrite RN_opp.
        replace (- RN (h - o) * RN (/ slow)) with (- (RN (h - o) * RN (/ slow))) by ring. apply RN_opp. }
      rewrite E, Rabs_Ropp in M. lra.
    + left. unfold infinite. destruct Rlt_dec; [reflexivity | exfalso; nra].
Qed.

(* ---- Both sides of an axis ---- *)
(* s is the side to which rays go along the axis, 1 or -1; planes are swapped below. *)
Definition near_of s (low high : ext) := if Rlt_dec 0 s then low else high.
Definition far_of s (low high : ext) := if Rlt_dec 0 s then high else low.
Definition hit_axis low high o d t' := F o /\ below low (o + t' * d) /\ above high (o + t' * d).
Lemma below_neg : forall a P, above a P -> below (neg a) (- P).
Proof. destruct a; simpl; intros P H; auto. destruct H. split; [now apply F_opp | lra]. Qed.
Lemma above_neg : forall a P, below a P -> above (neg a) (- P).
Proof. destruct a; simpl; intros P H; auto. destruct H. split; [now apply F_opp | lra]. Qed.
Lemma ordinary_neg : forall d, ordinary d -> ordinary (- d).
Proof. intros d [H|H]; [left; lra | right; now rewrite Rabs_Ropp]. Qed.
Lemma neg_neg : forall a, neg (neg a) = a.
Proof. destruct a; simpl; auto. f_equal. ring. Qed.
Lemma mirrored : forall p o s d, times (minus p o) (inverse s d) = times (minus (neg p) (- o)) (inverse (- s) (- d)).
Proof. intros. rewrite minus_neg, inverse_neg, times_neg. reflexivity. Qed.

(* One ray, with a component d; of zero the sign is s. *)
Lemma axis_of_one : forall s low high o d t', s = 1 \/ s = - 1 -> 0 <= s * d -> ordinary d ->
  hit_axis low high o d t' -> enters (times (minus (near_of s low high) o) (inverse s d)) t' /\
  leaves (times (minus (far_of s low high) o) (inverse s d)) t'.
Proof.
  assert (Up : forall low high o d t', 0 <= d -> ordinary d -> hit_axis low high o d t' ->
    enters (times (minus low o) (inverse 1 d)) t' /\ leaves (times (minus high o) (inverse 1 d)) t').
  { intros low high o d t' D O (Fo & B & A). split.
    - apply (near_up low o d d); auto. lra.
    - apply far_up; auto. }
  intros s low high o d t' [S|S] D O (Fo & B & A); subst s; unfold near_of, far_of; destruct Rlt_dec; try (exfalso;
    lra).
  - apply Up; auto; [lra | repeat split; auto].
  - rewrite (mirrored high), (mirrored low). replace (- -1) with 1 by ring. apply Up; [lra | now apply ordinary_neg
    |].
    split; [now apply F_opp|]. replace (- o + t' * - d) with (- (o + t' * d)) by ring.
    split; [now apply below_neg | now apply above_neg].
Qed.
(* Many rays: one of them has the component d, and all are between slow and fast, away from zero. *)
Lemma axis_of_many : forall s low high o d slow fast t', s = 1 \/ s = - 1 -> 0 <= s * slow <= s * d ->
  s * d <= s * fast -> ordinary slow -> ordinary fast -> 0 <= t' -> hit_axis low high o d t' ->
  enters (times (minus (near_of s low high) o) (inverse s fast)) t' /\
  leaves (times (minus (far_of s low high) o) (inverse s slow)) t'.
Proof.
  assert (Up : forall low high o d slow fast t', 0 <= slow <= d -> d <= fast -> ordinary slow -> ordinary fast ->
    0 <= t' -> hit_axis low high o d t' -> enters (times (minus low o) (inverse 1 fast)) t' /\
    leaves (times (minus high o) (inverse 1 slow)) t').
  { intros low high o d slow fast t' S M Os Of T (Fo & B & A). split.
    - apply (near_up low o d fast); auto; [lra|]. apply Rmult_le_compat_l; lra.
    - apply far_up; auto; [lra|]. assert (t' * slow <= t' * d) by (apply Rmult_le_compat_l; lra).
      destruct high; simpl in *; auto. destruct A. split; [assumption | lra]. }
  intros s low high o d slow fast t' [S|S] D M Os Of T (Fo & B & A); subst s; unfold near_of, far_of;
    destruct Rlt_dec; try (exfalso; lra).
  - apply (Up low high o d); auto; [lra | lra | repeat split; auto].
  - rewrite (mirrored high), (mirrored low). replace (- -1) with 1 by ring.
    apply (Up (neg high) (neg low) (- o) (- d)); auto using ordinary_neg; [lra | lra |].
    split; [now apply F_opp|]. replace (- o + t' * - d) with (- (o + t' * d)) by ring.
    split; [now apply below_neg | now apply above_neg].
Qed.
(* Where t overflows: a plane that a ray crosses that far away is infinitely far. *)
Lemma above_top : forall high o o' d slow t', 0 <= slow <= d -> ordinary slow -> Rabs o <= FARTHEST -> F o' -> o'
  <= o ->
  above high (o + t' * d) -> (forall x, high = Fin x -> Rabs x <= 2 * FARTHEST) -> bp 1000 <= t' ->
  times (minus high o') (inverse 1 slow) = Top.
Proof.
  intros high o o' d slow t' S Os Ho Fo' O' A R T. pose proof (bp_pos (-500)) as P5. pose proof (bp_pos 1000) as P10.
  unfold FARTHEST in *. apply Rabs_le_inv in Ho. pose proof (bp_pos 400) as P4.
  unfold inverse, infinite. destruct (Rlt_dec 0 1) as [_|]; [|lra]. destruct (Req_EM_T slow 0) as [Z|N].
  - destruct high as [h| | |]; simpl in A; try contradiction; simpl; unfold infinite.
    + destruct A as [Fh A]. assert (HO : o' < h) by (assert (0 <= t' * d) by (apply Rmult_le_pos; lra); lra).
      pose proof (RN_neg o' h Fo' Fh HO) as Q. replace (h - o') with (- (o' - h)) by ring. rewrite RN_opp.
      now destruct Rlt_dec; [|lra].
    + now destruct Rlt_dec; [|lra].
  - destruct Os as [Z|Os]; [contradiction|]. rewrite Rabs_pos_eq in Os by lra. destruct (inverse_pos slow Os) as
    [I0 _].
    destruct high as [h| | |]; simpl in A; try contradiction; simpl; unfold infinite.
    + exfalso. destruct A as [Fh A]. specialize (R h eq_refl). apply Rabs_le_inv in R. unfold SHORTEST in Os.
      assert (Q : bp 1000 * bp (-500) <= t' * d) by (apply mul2; split; lra). rewrite <- bp_add in Q.
      assert (W : bp (2 + 400) <= bp (1000 + -500)) by (apply bp_le; lia). rewrite bp_add in W. simpl (bp 2) in W.
        lra.
    + destruct Rlt_dec; [reflexivity | exfalso; nra].
Qed.
Lemma mirrored_of_neg : forall p o s d, times (minus (neg p) (- o)) (inverse s d) = times (minus p o) (inverse (-
  s) (- d)).
Proof. intros. rewrite (mirrored (neg p)), neg_neg, Ropp_involutive. reflexivity. Qed.
Lemma axis_top : forall s low high o o' d slow t', s = 1 \/ s = - 1 -> 0 <= s * slow <= s * d -> ordinary slow ->
  Rabs o <= FARTHEST -> F o' -> s * o' <= s * o -> hit_axis low high o d t' ->
  (forall x, low = Fin x \/ high = Fin x -> Rabs x <= 2 * FARTHEST) -> bp 1000 <= t' ->
  times (minus (far_of s low high) o') (inverse s slow) = Top.
Proof.
  intros s low high o o' d slow t' [S|S] D Os Ho Fo' O' (Fo & B & A) R T; subst s; unfold far_of; destruct Rlt_dec;
    try (exfalso; lra).
  - apply (above_top high o o' d slow t'); auto; lra.
  - rewrite (mirrored low). replace (- -1) with 1 by ring.
    apply (above_top (neg low) (- o) (- o') (- d) (- slow) t'); auto using ordinary_neg, F_opp; try lra.
    + now rewrite Rabs_Ropp.
    + replace (- o + t' * - d) with (- (o + t' * d)) by ring. now apply above_neg.
    + intros x X. rewrite <- (Rabs_Ropp x). apply R. left. rewrite <- (neg_neg low), X. reflexivity.
Qed.
(* The other end: the ray turned around. *)
Lemma axis_bottom : forall s low high o d t', s = 1 \/ s = - 1 -> 0 <= s * d -> ordinary d ->
  Rabs o <= FARTHEST -> hit_axis low high o d t' -> (forall x, low = Fin x \/ high = Fin x -> Rabs x <= 2 *
    FARTHEST) ->
  t' <= - bp 1000 -> times (minus (near_of s low high) o) (inverse s d) = Bottom.
Proof.
  assert (Turn : forall p o s d, times (minus p o) (inverse (- s) (- d)) = Top -> times (minus p o) (inverse s d) =
    Bottom).
  { intros p o s d. rewrite inverse_neg. destruct (minus p o) as [x| | |], (inverse s d) as [y| | |]; simpl; unfold
    infinite;
      repeat destruct Rlt_dec; intro H; try reflexivity; try discriminate; exfalso; lra. }
  intros s low high o d t' S D Od Ho (Fo & B & A) R T. apply Turn. replace (near_of s low high) with (far_of (- s)
    low high).
  - assert (E : o + - t' * - d = o + t' * d) by ring.
    assert (S' : - s = 1 \/ - s = - 1) by (destruct S; [right | left]; lra).
    assert (H : hit_axis low high o (- d) (- t')) by (unfold hit_axis; rewrite E; auto).
    apply (axis_top (- s) low high o o (- d) (- d) (- t') S'); auto using ordinary_neg; lra.
  - unfold near_of, far_of. destruct S; subst s; repeat destruct Rlt_dec; try reflexivity; exfalso; lra.
Qed.

(* ---- The three axes together ---- *)
Lemma le_refl : forall a, a <> Nan -> le a a.
Proof. destruct a; simpl; intro H; auto. lra. Qed.
Section Box.
Variables n1 n2 n3 n12 n f1 f2 f3 f12 f : ext.
Hypotheses (N12 : larger n1 n2 n12) (N : larger n12 n3 n) (F12 : smaller f1 f2 f12) (Ff : smaller f12 f3 f).
Variable t' : R.
Hypotheses (E1 : enters n1 t') (E2 : enters n2 t') (E3 : enters n3 t') (L1 : leaves f1 t') (L2 : leaves f2 t')
  (L3 : leaves f3 t').
Lemma enters_box : enters n t'.
Proof.
  destruct N12 as [[A|A] _], N as [[B|B] _]; subst; assumption.
Qed.
Lemma leaves_box : leaves f t'.
Proof.
  destruct F12 as [[A|A] _], Ff as [[B|B] _]; subst; assumption.
Qed.
(* With t' rounded to t in the range from start to end, the box is met, and it is not dropped by a best hit that is
  not
   closer than t. *)
Theorem box_is_met : forall t start stop, Rabs (t - t') <= u * Rabs t' + bp (-1075) -> le start (Fin t) -> le (Fin
  t) stop ->
  le (lowered_ext n) (raised_ext f) /\ le (lowered_ext n) stop /\ le start (raised_ext f) /\ le (lowered_ext n)
    (Fin t).
Proof.
  intros t start stop Ht S E. apply Rabs_le_inv in Ht.
  assert (A : lowered_ext n = Bottom \/ exists x, lowered_ext n = Fin x /\ x < t).
  { destruct enters_box as [Z|(x & Z & Fx & X)]; rewrite Z; simpl; [now left | right].
    exists (lowered x). split; [reflexivity|]. pose proof (lowered_before x t' Fx X). lra. }
  assert (B : raised_ext f = Top \/ exists x, raised_ext f = Fin x /\ t < x).
  { destruct leaves_box as [Z|(x & Z & Fx & X)]; rewrite Z; simpl; [now left | right].
    exists (raised x). split; [reflexivity|]. rewrite raised_lowered.
    assert (Y : - x <= - t' + (3 + / 100) * u * Rabs (- t') + bp (-1075)) by (rewrite Rabs_Ropp; lra).
    pose proof (lowered_before (- x) (- t') ltac:(now apply F_opp) Y) as Q. rewrite Rabs_Ropp in Q. lra. }
  destruct A as [A|(x & A & X)]; destruct B as [B|(y & B & Y)]; rewrite A, B; destruct start, stop; simpl in *;
    repeat split;
    try exact I; try lra; contradiction.
Qed.
(* Where t overflows, one of the ends of the box does. *)
Theorem box_is_met_far : forall t start stop, t = Top \/ t = Bottom -> (t = Top -> f = Top) -> (t = Bottom -> n =
  Bottom) ->
  le start t -> le t stop ->
  le (lowered_ext n) (raised_ext f) /\ le (lowered_ext n) stop /\ le start (raised_ext f) /\ le (lowered_ext n) t.
Proof.
  intros t start stop T HT HB S E.
  assert (A : lowered_ext n = Bottom \/ exists x, lowered_ext n = Fin x).
  { destruct enters_box as [Z|(x & Z & _)]; rewrite Z; simpl; eauto. }
  assert (B : raised_ext f = Top \/ exists x, raised_ext f = Fin x).
  { destruct leaves_box as [Z|(x & Z & _)]; rewrite Z; simpl; eauto. }
  destruct T as [T|T]; subst t.
  - rewrite (HT eq_refl). simpl. destruct A as [A|(x & A)]; rewrite A; destruct start, stop; simpl in *; repeat
    split; auto;
      contradiction.
  - rewrite (HB eq_refl). simpl. destruct B as [B|(x & B)]; rewrite B; destruct start, stop; simpl in *; repeat
    split; auto;
      contradiction.
Qed.
End Box.

(* ---- The whole: one ray, and many ---- *)
Section Whole.
Variables s1 s2 s3 o1 o2 o3 d1 d2 d3 t' : R.
Variables low1 low2 low3 high1 high2 high3 : ext.
Hypotheses (S1 : s1 = 1 \/ s1 = - 1) (S2 : s2 = 1 \/ s2 = - 1) (S3 : s3 = 1 \/ s3 = - 1).
(* The point at t' is strictly inside of the box. *)
Hypotheses (H1 : hit_axis low1 high1 o1 d1 t') (H2 : hit_axis low2 high2 o2 d2 t') (H3 : hit_axis low3 high3 o3 d3
  t').
Variables n12 n f12 f t start stop : ext.
(* What is found: t, the parameter rounded, in the range. *)
Hypotheses (Hstart : le start t) (Hstop : le t stop) (Ht : (exists x, t = Fin x /\ Rabs (x - t') <= u * Rabs t' +
  bp (-1075)) \/
  t = Top /\ bp 1000 <= t' \/ t = Bottom /\ t' <= - bp 1000).
Let near s low high o fast := times (minus (near_of s low high) o) (inverse s fast).
Let far s low high o slow := times (minus (far_of s low high) o) (inverse s slow).
Let met := le (lowered_ext n) (raised_ext f) /\ le (lowered_ext n) stop /\ le start (raised_ext f) /\ le
  (lowered_ext n) t.
Hypotheses (O1 : Rabs o1 <= FARTHEST) (O2 : Rabs o2 <= FARTHEST) (O3 : Rabs o3 <= FARTHEST)
  (P1 : forall x, low1 = Fin x \/ high1 = Fin x -> Rabs x <= 2 * FARTHEST)
  (P2 : forall x, low2 = Fin x \/ high2 = Fin x -> Rabs x <= 2 * FARTHEST)
  (P3 : forall x, low3 = Fin x \/ high3 = Fin x -> Rabs x <= 2 * FARTHEST).
Lemma all_of : forall (P : ext -> Prop) a b m, (m = a \/ m = b) -> P a -> P b -> P m.
Proof. intros P a b m [A|A] Pa Pb; subst; assumption. Qed.

Theorem one_ray_meets : 0 <= s1 * d1 -> 0 <= s2 * d2 -> 0 <= s3 * d3 -> ordinary d1 -> ordinary d2 -> ordinary d3 ->
  larger (near s1 low1 high1 o1 d1) (near s2 low2 high2 o2 d2) n12 -> larger n12 (near s3 low3 high3 o3 d3) n ->
  smaller (far s1 low1 high1 o1 d1) (far s2 low2 high2 o2 d2) f12 -> smaller f12 (far s3 low3 high3 o3 d3) f -> met.
Proof.
  intros D1 D2 D3 R1 R2 R3 N12 N F12 Ff.
  destruct (axis_of_one s1 low1 high1 o1 d1 t' S1 D1 R1 H1) as [E1 L1].
  destruct (axis_of_one s2 low2 high2 o2 d2 t' S2 D2 R2 H2) as [E2 L2].
  destruct (axis_of_one s3 low3 high3 o3 d3 t' S3 D3 R3 H3) as [E3 L3].
  unfold met. destruct Ht as [(x & T & X)|[[T B]|[T B]]].
  - rewrite T in Hstart, Hstop |- *. exact (box_is_met _ _ _ _ _ _ _ _ _ _ N12 N F12 Ff t' E1 E2 E3 L1 L2 L3 x
    start stop X Hstart Hstop).
  - refine (box_is_met_far _ _ _ _ _ _ _ _ _ _ N12 N F12 Ff t' E1 E2 E3 L1 L2 L3 t start stop (or_introl T) _ _
    Hstart Hstop);
      [|intro Z; congruence].
    intros _. destruct F12 as [F12 _], Ff as [Ff _].
    apply (all_of (fun a => a = Top) _ _ _ Ff); [apply (all_of (fun a => a = Top) _ _ _ F12)|];
      [eapply (axis_top _ _ _ o1 o1 d1) | eapply (axis_top _ _ _ o2 o2 d2) | eapply (axis_top _ _ _ o3 o3 d3)]; try
        eassumption;
      try lra; first [apply H1 | apply H2 | apply H3].
  - refine (box_is_met_far _ _ _ _ _ _ _ _ _ _ N12 N F12 Ff t' E1 E2 E3 L1 L2 L3 t start stop (or_intror T) _ _
    Hstart Hstop);
      [intro Z; congruence|].
    intros _. destruct N12 as [N12 _], N as [N _].
    apply (all_of (fun a => a = Bottom) _ _ _ N); [apply (all_of (fun a => a = Bottom) _ _ _ N12)|];
      eapply axis_bottom; eassumption.
Qed.
(* Of the rays of a tile each has components from slow to fast along each axis. *)
Variables slow1 slow2 slow3 fast1 fast2 fast3 : R.
Theorem many_rays_meet : 0 <= t' ->
  0 <= s1 * slow1 <= s1 * d1 -> 0 <= s2 * slow2 <= s2 * d2 -> 0 <= s3 * slow3 <= s3 * d3 ->
  s1 * d1 <= s1 * fast1 -> s2 * d2 <= s2 * fast2 -> s3 * d3 <= s3 * fast3 ->
  ordinary slow1 -> ordinary slow2 -> ordinary slow3 -> ordinary fast1 -> ordinary fast2 -> ordinary fast3 ->
  larger (near s1 low1 high1 o1 fast1) (near s2 low2 high2 o2 fast2) n12 -> larger n12 (near s3 low3 high3 o3
    fast3) n ->
  smaller (far s1 low1 high1 o1 slow1) (far s2 low2 high2 o2 slow2) f12 ->
  smaller f12 (far s3 low3 high3 o3 slow3) f -> met.
Proof.
  intros A D1 D2 D3 G1 G2 G3 R1 R2 R3 Q1 Q2 Q3 N12 N F12 Ff.
  destruct (axis_of_many s1 low1 high1 o1 d1 slow1 fast1 t' S1 D1 G1 R1 Q1 A H1) as [E1 L1].
  destruct (axis_of_many s2 low2 high2 o2 d2 slow2 fast2 t' S2 D2 G2 R2 Q2 A H2) as [E2 L2].
  destruct (axis_of_many s3 low3 high3 o3 d3 slow3 fast3 t' S3 D3 G3 R3 Q3 A H3) as [E3 L3].
  unfold met. destruct Ht as [(x & T & X)|[[T B]|[T B]]].
  - rewrite T in Hstart, Hstop |- *. exact (box_is_met _ _ _ _ _ _ _ _ _ _ N12 N F12 Ff t' E1 E2 E3 L1 L2 L3 x
    start stop X Hstart Hstop).
  - assert (TO : forall s low high o d slow, s = 1 \/ s = - 1 -> 0 <= s * slow <= s * d -> ordinary slow ->
      Rabs o <= FARTHEST -> hit_axis low high o d t' -> (forall x, low = Fin x \/ high = Fin x -> Rabs x <= 2 *
        FARTHEST) ->
      far s low high o slow = Top).
    { intros s low high o d slow S D R O H P. apply (axis_top s low high o o d slow t'); auto; [apply H | lra]. }
    refine (box_is_met_far _ _ _ _ _ _ _ _ _ _ N12 N F12 Ff t' E1 E2 E3 L1 L2 L3 t start stop (or_introl T) _ _
      Hstart Hstop);
      [|intro Z; congruence].
    intros _. destruct F12 as [F12 _], Ff as [Ff _].
    apply (all_of (fun a => a = Top) _ _ _ Ff); [apply (all_of (fun a => a = Top) _ _ _ F12)|];
      eapply TO; eassumption.
  - exfalso. pose proof (bp_pos 1000). lra.
Qed.
End Whole.
