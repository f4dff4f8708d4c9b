(* rt-geom, bvh/cull.rs: a ray made ready for the cull, in doubles (`CullRay::set`, `shorten`). *)
From Proofs Require Import Rounding Single Norm Boxes.
Open Scope R_scope.

(* The rounding errors, for each unit of distance between origin and center. *)
Definition LINE_ERROR := bp (-46).
(* Beyond this error nothing is culled. *)
Definition MAX_LINE_ERROR := 1 / 16.
(* What the image of the origin may be off beside its rounding: 2 u by `point_error` of Frame.v, the rest where a
   direction is divided by a power of two (Kept.v). *)
Notation IMAGE := ((2 + / 1000) * u).

Lemma pow_le : forall a b, a <= bp b -> forall c, (b <= c)%Z -> a <= bp c.
Proof. intros. apply Rle_trans with (bp b); [assumption | now apply bp_le]. Qed.
(* From what a product and its rounding are off. *)
Lemma rounded : forall x X e, Rabs (x - X) <= e -> Rabs (RN x - X) <= e + u * (Rabs X + e) + bp (-1075).
Proof.
  intros x X e H. pose proof (RN_err x) as E. replace (RN x - X) with ((RN x - x) + (x - X)) by ring.
  eapply Rle_trans; [apply Rabs_triang|]. assert (Rabs x <= Rabs X + e).
  { replace x with ((x - X) + X) by ring. eapply Rle_trans; [apply Rabs_triang|]. lra. }
  pose proof u_pos. nra.
Qed.
(* A product of x, within a part of X, with a factor y near 1. *)
Lemma times_near : forall x X e y k m, Rabs (x - X) <= e -> Rabs (y - 1) <= k -> Rabs X <= m ->
  Rabs (x * y - X) <= e + k * (m + e).
Proof.
  intros x X e y k m H K M. replace (x * y - X) with ((x - X) + x * (y - 1)) by ring.
  eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_mult. apply Rplus_le_compat; [assumption|].
  rewrite Rmult_comm. apply Rmult_le_compat; auto using Rabs_pos.
  replace x with ((x - X) + X) by ring. eapply Rle_trans; [apply Rabs_triang|]. lra.
Qed.

(* A value below s by more than its rounding is rounded below s, however negative it is. *)
Lemma F_2 : F 2. Proof. replace 2 with (bp 1) by (simpl; lra). apply F_bp. lia. Qed.
Lemma RN_lower : forall x s, Rabs s <= 2 -> x <= s - 3 * u -> RN x <= s.
Proof.
  intros x s T H. apply Rabs_le_inv in T. destruct (Rle_or_lt x (- 2)) as [N|N].
  - apply Rle_trans with (- 2); [rewrite <- (RN_id (- 2)) by (apply F_opp, F_2); now apply RN_le | lra].
  - pose proof (RN_err x) as E. assert (bp (-1075) <= / 1000 * u) by (apply Rle_trans with (bp (-10 + -53));
      [apply bp_le; lia | rewrite bp_add; fold u; pose proof u_pos; simpl (bp (-10)); lra]).
    pose proof u_pos. assert (Rabs x <= 2) by (apply Rabs_le; lra).
    assert (u * Rabs x <= u * 2) by (apply Rmult_le_compat_l; lra). apply Rabs_le_inv in E. lra.
Qed.
Lemma RN_upper : forall x s, Rabs s <= 2 -> s + 3 * u <= x -> s <= RN x.
Proof.
  intros x s T H. assert (RN (- x) <= - s) by (apply RN_lower; [now rewrite Rabs_Ropp | lra]).
  rewrite RN_opp in *. lra.
Qed.

(* The bound of the error as computed. *)
Lemma error_bound : forall o1 o2 o3, let total := RN (RN (Rabs o1 + Rabs o2) + Rabs o3) in
  (128 - / 100) * u * (Rabs o1 + Rabs o2 + Rabs o3 + 1) <= RN (RN (1 + total) * LINE_ERROR).
Proof.
  intros o1 o2 o3 total. set (error := RN (RN (1 + total) * LINE_ERROR)).
  pose proof (RN_err (Rabs o1 + Rabs o2)) as E1. pose proof (RN_err (RN (Rabs o1 + Rabs o2) + Rabs o3)) as E2.
  fold total in E2. pose proof (RN_err (1 + total)) as E3. set (m := RN (1 + total)) in *.
  pose proof (RN_err (m * LINE_ERROR)) as E4. fold error in E4.
  pose proof (Rabs_pos o1) as A1. pose proof (Rabs_pos o2) as A2. pose proof (Rabs_pos o3) as A3.
  rewrite (Rabs_pos_eq (Rabs o1 + Rabs o2)) in E1 by lra. set (s := RN (Rabs o1 + Rabs o2)) in *.
  assert (s0 : 0 <= s) by (unfold s; rewrite <- RN_0; apply RN_le; lra). rewrite (Rabs_pos_eq (s + _)) in E2 by lra.
  assert (t0 : 0 <= total) by (unfold total; rewrite <- RN_0; apply RN_le; lra).
  rewrite (Rabs_pos_eq (1 + _)) in E3 by lra.
  assert (m0 : 0 <= m) by (unfold m; rewrite <- RN_0; apply RN_le; lra).
  assert (T : bp (-1075) <= / 1000000 * u) by (apply Rle_trans with (bp (-20 + -53)); [apply bp_le; lia|];
    rewrite bp_add; fold u; simpl (bp (-20)); pose proof u_pos; lra).
  assert (LV : LINE_ERROR = 128 * u) by (unfold LINE_ERROR, u; change (-46)%Z with (7 + -53)%Z; rewrite bp_add;
    reflexivity).
  rewrite LV in E4. pose proof u_pos. rewrite (Rabs_pos_eq (m * (128 * u))) in E4 by (apply Rmult_le_pos; lra).
  apply Rabs_le_inv in E1. apply Rabs_le_inv in E2. apply Rabs_le_inv in E3. apply Rabs_le_inv in E4. 
  rewrite u_val in *. lra.
Qed.

Section Line.
(* the origin's image as computed and exactly, the direction *)
Variables o1 o2 o3 p1 p2 p3 d1 d2 d3 : R.
Let A := d1 * d1 + d2 * d2 + d3 * d3.
Let l := norm d1 d2 d3.
Let w1 := d1 / l. Let w2 := d2 / l. Let w3 := d3 / l.
Let D := Rabs o1 + Rabs o2 + Rabs o3 + 1.
(* the line exactly: where it is nearest to the center, and the parameter of the origin there *)
Let along := p1 * w1 + p2 * w2 + p3 * w3.
Let q1' := p1 - along * w1. Let q2' := p2 - along * w2. Let q3' := p3 - along * w3.
Hypotheses (Hd1 : Rabs d1 <= bp 100) (Hd2 : Rabs d2 <= bp 100) (Hd3 : Rabs d3 <= bp 100) (Hlong : bp (-200) <= A)
  (Ho1 : Rabs o1 <= bp 45) (Ho2 : Rabs o2 <= bp 45) (Ho3 : Rabs o3 <= bp 45)
  (Hp1 : Rabs (o1 - p1) <= (1 + / 1000) * u * Rabs o1 + IMAGE) (Hp2 : Rabs (o2 - p2) <= (1
    + / 1000) * u * Rabs o2 + IMAGE)
  (Hp3 : Rabs (o3 - p3) <= (1 + / 1000) * u * Rabs o3 + IMAGE).
(* as computed *)
Variables S dot x1 x2 x3 : R.
Let x d := X d 100. Let y o := X o 45.
Hypothesis HS : plain (tdot (x d1) (x d2) (x d3) (x d1) (x d2) (x d3)) S.
Hypothesis Hdot : plain (tdot (y o1) (y o2) (y o3) (x d1) (x d2) (x d3)) dot.
Let inverse := RN (/ S). Let length := RN (sqrt S). Let k := RN (length * inverse).
Let base := RN (- dot * k).
Let g := RN (dot * inverse).
Hypotheses (Hx1 : Rabs (x1 - d1 * g) <= u * Rabs (d1 * g) + bp (-1075))
  (Hx2 : Rabs (x2 - d2 * g) <= u * Rabs (d2 * g) + bp (-1075))
  (Hx3 : Rabs (x3 - d3 * g) <= u * Rabs (d3 * g) + bp (-1075)).
Let q1 := RN (o1 - x1). Let q2 := RN (o2 - x2). Let q3 := RN (o3 - x3).

Lemma D1 : 1 <= D. Proof. unfold D. pose proof (Rabs_pos o1). pose proof (Rabs_pos o2). pose proof (Rabs_pos o3). lra.
Qed.
Lemma l_sq : l * l = A. Proof. unfold l. now rewrite norm_sq. Qed.
Lemma l_low : bp (-100) <= l. Proof. apply le_norm. rewrite bp_sq. exact Hlong. Qed.
Lemma l_pos : 0 < l. Proof. pose proof l_low. pose proof (bp_pos (-100)). lra. Qed.
Lemma l_top : l <= bp 102.
Proof.
  eapply Rle_trans; [apply norm_le_sum|]. change 102%Z with (2 + 100)%Z. rewrite bp_add. simpl (bp 2).
  pose proof (bp_pos 100). lra.
Qed.
Lemma w_unit : norm w1 w2 w3 = 1.
Proof.
  unfold w1, w2, w3, Rdiv. rewrite !(Rmult_comm _ (/ l)), norm_scaled. fold l. pose proof l_pos.
  rewrite Rabs_pos_eq by (apply Rlt_le; now apply Rinv_0_lt_compat). now apply Rinv_l, Rgt_not_eq.
Qed.
Lemma o_norm : norm o1 o2 o3 <= D - 1. Proof. unfold D. pose proof (norm_le_sum o1 o2 o3). lra. Qed.

(* What is computed from the direction alone, relative to what it is to be. *)
Lemma square_near : Rabs (S - A) <= (3 + / 500) * u * A.
Proof.
  pose proof HS as E. clear - E Hd1 Hd2 Hd3 Hlong. unfold tdot, x in E. error_of E P. rewrite !abs_sq in P.
  fold A in P. small (-200)%Z.
  rewrite u_val in *. lra.
Qed.
Lemma A_pos : 0 < A. Proof. pose proof (bp_pos (-200)). lra. Qed.
Lemma S_range : bp (-201) <= S <= bp 205.
Proof.
  pose proof square_near as E. pose proof A_pos. apply Rabs_le_inv in E.
  assert (A <= bp 204). { rewrite <- l_sq. change 204%Z with (102 + 102)%Z. rewrite <- bp_sq.
    apply mul2; split; try apply l_top; apply Rlt_le, l_pos. }
  assert (bp 205 = 2 * bp 204) by (change 205%Z with (1 + 204)%Z; rewrite bp_add, bp_1; ring).
  assert (bp (-200) = 2 * bp (-201)) by (change (-200)%Z with (1 + -201)%Z; rewrite bp_add, bp_1; ring).
  rewrite u_val in E. lra.
Qed.
Lemma inverse_near : Rabs (inverse * A - 1) <= (4 + / 100) * u.
Proof.
  destruct S_range as [S0 S1]. pose proof (bp_pos (-201)). assert (SP : 0 < S) by lra. pose proof A_pos as A0.
  assert (E : Rabs (inverse - / S) <= u * / S).
  { assert (I : 0 < / S) by now apply Rinv_0_lt_compat. rewrite <- (Rabs_pos_eq (/ S)) at 2 by lra.
    apply RN_normal. rewrite Rabs_pos_eq by lra. apply Rle_trans with (bp (-205)); [apply bp_le; lia|].
    change (-205)%Z with (Z.opp 205). rewrite bpow_opp. now apply Rinv_le_contravar. }
  pose proof square_near as N. set (a := A * / S).
  assert (a0 : 0 < a) by (apply Rmult_lt_0_compat; [assumption | now apply Rinv_0_lt_compat]).
  assert (aS : a * S = A) by (unfold a; field; lra).
  assert (E2 : Rabs (a - 1) <= (3 + / 400) * u).
  { apply Rabs_le_inv in N. apply Rabs_le. rewrite <- aS in N. rewrite u_val in *. nra. }
  assert (E1 : Rabs (inverse * A - a) <= u * a).
  { replace (inverse * A - a) with ((inverse - / S) * A) by (unfold a; ring). rewrite Rabs_mult, (Rabs_pos_eq A) by lra.
    unfold a. rewrite (Rmult_comm A), <- Rmult_assoc. apply Rmult_le_compat_r; lra. }
  apply Rabs_le_inv in E1. apply Rabs_le_inv in E2. apply Rabs_le. rewrite u_val in *. lra.
Qed.
Lemma length_near : Rabs (length - l) <= (26 / 10) * u * l.
Proof.
  destruct S_range as [S0 S1]. pose proof (bp_pos (-201)). assert (SP : 0 < S) by lra. pose proof l_pos as L0.
  pose proof square_near as N. rewrite <- l_sq in N. set (s := sqrt S).
  assert (ss : s * s = S) by (apply sqrt_sqrt; lra).
  assert (s0 : 0 < s) by (apply sqrt_lt_R0; assumption).
  assert (s1 : 99 / 100 * l <= s). { apply below_root; [lra|]. rewrite ss. apply Rabs_le_inv in N.
    pose proof (Rmult_lt_0_compat l l L0 L0). rewrite u_val in N. lra. }
  assert (E : Rabs (s - l) <= (152 / 100) * u * l).
  { apply Rmult_le_reg_r with (199 / 100 * l); [lra|].
    apply Rle_trans with (Rabs (s - l) * (s + l)); [apply Rmult_le_compat_l; [apply Rabs_pos | lra]|].
    rewrite <- (Rabs_pos_eq (s + l)) by lra. rewrite <- Rabs_mult. replace ((s - l) * (s + l)) with (S - l * l) by
      (rewrite <- ss; ring). eapply Rle_trans; [exact N|]. pose proof (Rmult_lt_0_compat l l L0 L0). rewrite u_val.
      lra. }
  assert (E2 : Rabs (length - s) <= u * s).
  { rewrite <- (Rabs_pos_eq s) at 2 by lra. apply RN_normal. rewrite Rabs_pos_eq by lra.
    apply Rle_trans with (bp (-101)); [apply bp_le; lia|]. pose proof l_low.
    assert (bp (-100) = 2 * bp (-101)) by (change (-100)%Z with (1 + -101)%Z; rewrite bp_add, bp_1; ring). lra. }
  apply Rabs_le_inv in E. apply Rabs_le_inv in E2. apply Rabs_le. rewrite u_val in *. lra.
Qed.
Lemma k_near : Rabs (k * l - 1) <= (77 / 10) * u.
Proof.
  pose proof l_pos as L0. pose proof length_near as E1. pose proof inverse_near as E2. pose proof l_sq as LL.
  assert (N : Rabs (length * inverse * l - 1) <= (662 / 100) * u).
  { set (a := length * / l). assert (aL : a * l = length) by (unfold a; field; lra).
    assert (E3 : Rabs (a - 1) <= (26 / 10) * u).
    { apply Rmult_le_reg_r with l; [assumption|]. rewrite <- (Rabs_pos_eq l) at 1 by lra. rewrite <- Rabs_mult.
      replace ((a - 1) * l) with (length - l) by (rewrite <- aL; ring). lra. }
    replace (length * inverse * l - 1) with ((inverse * A) * a - 1) by (rewrite <- LL, <- aL; ring).
    pose proof (times_near _ 1 _ a _ 1 E2 E3) as T. rewrite Rabs_R1 in T. specialize (T ltac:(lra)).
    rewrite u_val in *. lra. }
  set (m := length * inverse) in *.
  assert (R : Rabs (k - m) <= u * Rabs m).
  { apply RN_normal. apply Rle_trans with (bp (-110)); [apply bp_le; lia|].
    apply Rmult_le_reg_r with l; [assumption|]. apply Rle_trans with (bp (-8)).
    - change (-8)%Z with (-110 + 102)%Z. rewrite (bp_add (-110)).
    apply Rmult_le_compat_l; [apply Rlt_le, bp_pos | apply l_top].
    - rewrite <- (Rabs_pos_eq l) by lra. rewrite <- Rabs_mult. replace (m * l) with (1 - - (m * l - 1)) by ring.
      eapply Rle_trans; [|apply Rabs_triang_inv]. rewrite Rabs_R1, Rabs_Ropp. simpl (bp (-8)). rewrite u_val in *.
      lra. }
  replace (k * l - 1) with ((k - m) * l + (m * l - 1)) by ring. eapply Rle_trans; [apply Rabs_triang|].
  rewrite Rabs_mult. assert (ML : Rabs (m * l) <= 1 + 7 * u).
  { replace (m * l) with ((m * l - 1) + 1) by ring. eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_R1.
    pose proof u_pos. lra. }
  rewrite Rabs_mult in ML. assert (Rabs (k - m) * Rabs l <= u * (1 + 7 * u)).
  { apply Rle_trans with (u * Rabs m * Rabs l); [apply Rmult_le_compat_r; [apply Rabs_pos | assumption]|].
    rewrite Rmult_assoc. apply Rmult_le_compat_l; [apply Rlt_le, u_pos | assumption]. }
  rewrite u_val in *. lra.
Qed.

(* The direction in f32: what Balls.v takes for granted. *)
Lemma direction_near : forall d, Rabs (RNs (RN (d * k)) - d / l) <= (1 + / 1000) * UNIT * Rabs (d / l) + bp (-130).
Proof.
  intro d. pose proof l_pos as L0. pose proof k_near as K. set (w := d / l).
  assert (E : Rabs (d * k - w) <= (77 / 10) * u * Rabs w).
  { replace (d * k - w) with ((k * l - 1) * w) by (unfold w; field; lra). rewrite Rabs_mult.
    apply Rmult_le_compat_r; [apply Rabs_pos | assumption]. }
  pose proof (rounded _ _ _ E) as R. pose proof (UNIT_holds (RN (d * k))) as E2. set (m := RN (d * k)) in *.
  assert (T1 : bp (-1075) <= / 1000 * bp (-130)) by (apply Rle_trans with (bp (-10 + -130)); [apply bp_le; lia|];
    rewrite bp_add; pose proof (bp_pos (-130)); simpl (bp (-10)); lra).
  assert (T2 : bp (-150) <= / 1000 * bp (-130)) by (apply Rle_trans with (bp (-10 + -130)); [apply bp_le; lia|];
    rewrite bp_add; pose proof (bp_pos (-130)); simpl (bp (-10)); lra).
  pose proof (Rabs_pos w). pose proof (bp_pos (-130)). assert (M : Rabs m <= Rabs w + Rabs (m - w)).
  { replace m with (w + (m - w)) at 1 by ring. apply Rabs_triang. }
  replace (RNs m - w) with ((RNs m - m) + (m - w)) by ring. eapply Rle_trans; [apply Rabs_triang|].
  rewrite u_val, v_val in *. lra.
Qed.
Lemma D_top : u * D <= / 80.
Proof.
  assert (D <= 105553116266497) by (unfold D; assert (bp 45 = 35184372088832) by (simpl; lra); lra).
  rewrite u_val. lra.
Qed.

Lemma uD : u <= u * D.
Proof. pose proof u_pos. pose proof D1. rewrite <- (Rmult_1_r u) at 1; apply Rmult_le_compat_l; lra. Qed.

(* <o|w> as computed: dot / l. *)
Let here := o1 * w1 + o2 * w2 + o3 * w3.
Lemma here_le : Rabs here <= D - 1.
Proof.
  eapply Rle_trans; [apply dot_le|]. rewrite w_unit. pose proof o_norm. lra.
Qed.
Lemma w_mul : w1 * l = d1 /\ w2 * l = d2 /\ w3 * l = d3.
Proof. pose proof l_pos. unfold w1, w2, w3. repeat split; field; lra. Qed.
Lemma dot_near : Rabs (dot * / l - here) <= (3 + / 100) * u * D.
Proof.
  pose proof l_pos as L0. destruct w_mul as (W1 & W2 & W3). pose proof Hdot as E. unfold tdot, x, y in E. error_of E P.
  set (M := Rabs o1 * Rabs d1 + Rabs o2 * Rabs d2 + Rabs o3 * Rabs d3) in P.
  assert (MB : M <= (D - 1) * l).
  { destruct (part_le d1 d2 d3) as (L1 & L2 & L3). fold l in L1, L2, L3. unfold M, D.
    pose proof (Rabs_pos o1). pose proof (Rabs_pos o2). pose proof (Rabs_pos o3). nra. }
  assert (T : forall p, (p <= -900)%Z -> bp p <= / 1000 * u * l).
  { intros p Hp. apply Rle_trans with (bp (-63 + -100)); [apply bp_le; lia|]. rewrite bp_add.
    apply Rle_trans with (bp (-63) * l); [apply Rmult_le_compat_l; [apply Rlt_le, bp_pos | apply l_low]|].
    apply Rmult_le_compat_r; [lra|]. change (-63)%Z with (-10 + -53)%Z. rewrite bp_add. fold u. pose proof u_pos.
    simpl (bp (-10)). lra. }
  match type of P with _ <= _ + bp ?p => pose proof (T p ltac:(lia)) end.
  apply Rmult_le_reg_r with l; [assumption|]. rewrite <- (Rabs_pos_eq l) at 2 by lra. rewrite <- Rabs_mult.
  replace ((dot * / l - here) * l) with (dot - (o1 * d1 + o2 * d2 + o3 * d3)) by (unfold here;
    rewrite <- W1, <- W2, <- W3;
    field; lra).
  eapply Rle_trans; [exact P|]. pose proof D1.
  assert (u * M <= u * ((D - 1) * l)) by (apply Rmult_le_compat_l; [apply Rlt_le, u_pos | assumption]).
  replace ((D - 1) * l) with (D * l - l) in * by ring. pose proof u_pos. pose proof (Rmult_lt_0_compat u l u_pos L0).
  pose proof (Rmult_lt_0_compat u (D * l) u_pos ltac:(apply Rmult_lt_0_compat; lra)).
  replace ((3 + / 100) * u * D * l) with ((3 + / 100) * (u * (D * l))) by ring.
  replace (u * (D * l - l)) with (u * (D * l) - u * l) in * by ring. lra.
Qed.
Lemma small_D : forall p, (p <= -100)%Z -> bp p <= / 1000 * u * D.
Proof.
  intros p Hp. apply Rle_trans with (bp (-10 + -53)); [apply bp_le; lia|]. rewrite bp_add. fold u. simpl (bp (-10)).
  pose proof D1. pose proof u_pos. nra.
Qed.
Lemma base_near : Rabs (base + here) <= (118 / 10) * u * D.
Proof.
  pose proof l_pos as L0. pose proof D1 as D1. pose proof here_le as H. pose proof dot_near as N.
  pose proof k_near as K.
  pose proof (times_near _ _ _ _ _ _ N K H) as T. set (m := dot * / l * (k * l)) in *.
  assert (E : - dot * k = - m) by (unfold m; field; lra).
  pose proof (rounded (- m) (- here) ((1071 / 100) * u * D + / 50 * u * D)) as R. rewrite <- E in R. fold base in R.
  replace (base - - here) with (base + here) in R by ring. rewrite Rabs_Ropp in R.
  pose proof (small_D (-1075) ltac:(lia)). assert (0 < u * D) by (apply Rmult_lt_0_compat; [apply u_pos | lra]).
  eapply Rle_trans; [apply R|].
  - rewrite E. replace (- m - - here) with (- (m - here)) by ring. rewrite Rabs_Ropp. eapply Rle_trans; [exact T|].
    rewrite u_val in *. lra.
  - assert (u * (Rabs here + ((1071 / 100) * u * D + / 50 * u * D)) <= u * ((1 + / 100) * D)).
    { apply Rmult_le_compat_l; [apply Rlt_le, u_pos|]. rewrite u_val in *. lra. }
    lra.
Qed.
(* g l, and so what is taken from each coordinate *)
Lemma g_near : Rabs (g * l - here) <= (82 / 10) * u * D.
Proof.
  pose proof l_pos as L0. pose proof D1 as D1. pose proof here_le as H. pose proof dot_near as N.
  pose proof inverse_near as K. pose proof (times_near _ _ _ _ _ _ N K H) as T.
  set (m := dot * / l * (inverse * A)) in *. pose proof l_sq as LL.
  assert (E : dot * inverse * l = m) by (unfold m; rewrite <- LL; field; lra).
  assert (0 < u * D) by (apply Rmult_lt_0_compat; [apply u_pos | lra]).
  pose proof (RN_err (dot * inverse)) as R. fold g in R.
  replace (g * l - here) with ((g - dot * inverse) * l + (m - here)) by (rewrite <- E; ring).
  eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_mult, (Rabs_pos_eq l) by lra.
  assert (T2 : bp (-1075) * l <= / 1000 * u * D).
  { apply Rle_trans with (bp (-1075) * bp 102); [apply Rmult_le_compat_l; [apply Rlt_le, bp_pos | apply l_top]|].
    rewrite <- bp_add. apply small_D. lia. }
  assert (MM : Rabs m <= (1 + / 100) * D).
  { replace m with ((m - here) + here) by ring. eapply Rle_trans; [apply Rabs_triang|]. rewrite u_val in *. lra. }
  assert (E2 : Rabs (dot * inverse) * l = Rabs m) by (rewrite <- E, (Rabs_mult _ l), (Rabs_pos_eq l); lra).
  assert (Rabs (g - dot * inverse) * l <= u * ((1 + / 100) * D) + / 1000 * u * D).
  { apply Rle_trans with ((u * Rabs (dot * inverse) + bp (-1075)) * l); [apply Rmult_le_compat_r; lra|].
    rewrite Rmult_plus_distr_r, Rmult_assoc, E2. apply Rplus_le_compat; [|assumption].
    apply Rmult_le_compat_l; [apply Rlt_le, u_pos | assumption]. }
  rewrite u_val in *. lra.
Qed.
Lemma part_near : forall o d w x, w * l = d -> Rabs (x - d * g) <= u * Rabs (d * g) + bp (-1075) -> Rabs w <= 1 ->
  Rabs (RN (o - x) - (o - here * w)) <= u * Rabs o + (103 / 10) * u * D * Rabs w + / 100 * u * D.
Proof.
  intros o d w z W Hz w1'. pose proof l_pos as L0. pose proof D1 as D1. pose proof here_le as H. pose proof g_near as G.
  assert (UD : 0 < u * D) by (apply Rmult_lt_0_compat; [apply u_pos | lra]). pose proof (Rabs_pos w) as W0.
  pose proof (small_D (-1075) ltac:(lia)) as T.
  assert (E1 : Rabs (d * g - here * w) <= (82 / 10) * u * D * Rabs w).
  { replace (d * g - here * w) with ((g * l - here) * w) by (rewrite <- W; ring). rewrite Rabs_mult.
    now apply Rmult_le_compat_r. }
  assert (E2 : Rabs (d * g) <= (1 + / 100) * D * Rabs w).
  { replace (d * g) with ((d * g - here * w) + here * w) by ring. eapply Rle_trans; [apply Rabs_triang|].
    rewrite (Rabs_mult here). assert (Rabs here * Rabs w <= (D - 1) * Rabs w) by now apply Rmult_le_compat_r.
    assert (0 <= D * Rabs w) by (apply Rmult_le_pos; lra).
    replace ((82 / 10) * u * D * Rabs w) with ((82 / 10) * u * (D * Rabs w)) in E1 by ring. rewrite u_val in *. lra. }
  assert (DW : 0 <= D * Rabs w) by (apply Rmult_le_pos; lra).
  replace ((82 / 10) * u * D * Rabs w) with ((82 / 10) * u * (D * Rabs w)) in E1 by ring.
  replace ((1 + / 100) * D * Rabs w) with ((1 + / 100) * (D * Rabs w)) in E2 by ring.
  replace ((103 / 10) * u * D * Rabs w) with ((103 / 10) * u * (D * Rabs w)) by ring.
  assert (E3 : Rabs (z - here * w) <= (922 / 100) * u * (D * Rabs w) + / 1000 * u * D).
  { replace (z - here * w) with ((z - d * g) + (d * g - here * w)) by ring. eapply Rle_trans; [apply Rabs_triang|].
    assert (u * Rabs (d * g) <= u * ((1 + / 100) * (D * Rabs w))) by (apply Rmult_le_compat_l;
      [apply Rlt_le, u_pos | assumption]). rewrite u_val in *. lra. }
  pose proof (rounded (o - z) (o - here * w) ((922 / 100) * u * (D * Rabs w) + / 1000 * u * D)) as R.
  eapply Rle_trans; [apply R|].
  - replace (o - z - (o - here * w)) with (- (z - here * w)) by ring. now rewrite Rabs_Ropp.
  - assert (Q : Rabs (o - here * w) <= Rabs o + D * Rabs w).
    { unfold Rminus. eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp, (Rabs_mult here).
      assert (Rabs here * Rabs w <= D * Rabs w) by (apply Rmult_le_compat_r; lra). lra. }
    assert (DWD : D * Rabs w <= D) by (rewrite <- (Rmult_1_r D) at 2; apply Rmult_le_compat_l; lra).
    assert (u * (Rabs (o - here * w) + ((922 / 100) * u * (D * Rabs w) + / 1000 * u * D)) <=
      u * (Rabs o + D * Rabs w + / 1000 * D)).
    { apply Rmult_le_compat_l; [apply Rlt_le, u_pos|]. rewrite u_val in *. lra. }
    assert (0 <= u * (D * Rabs w)) by (apply Rmult_le_pos; [apply Rlt_le, u_pos | assumption]). lra.
Qed.

(* The nearest point, as a vector: from the computed origin, and from the exact one. *)
Lemma nearest_near : norm (q1 - q1') (q2 - q2') (q3 - q3') <= (17 + / 10) * u * D.
Proof.
  pose proof D1 as D1. assert (UD : 0 < u * D) by (apply Rmult_lt_0_compat; [apply u_pos | lra]).
  destruct w_mul as (W1 & W2 & W3). destruct (part_le w1 w2 w3) as (U1 & U2 & U3). rewrite w_unit in U1, U2, U3.
  pose proof (part_near o1 d1 w1 x1 W1 Hx1 U1) as E1. pose proof (part_near o2 d2 w2 x2 W2 Hx2 U2) as E2.
  pose proof (part_near o3 d3 w3 x3 W3 Hx3 U3) as E3. fold q1 in E1. fold q2 in E2. fold q3 in E3.
  assert (N1 : norm (q1 - (o1 - here * w1)) (q2 - (o2 - here * w2)) (q3 - (o3 - here * w3)) <= (114 / 10) * u * D).
  { eapply Rle_trans; [eapply norm_monotone; eassumption|].
    set (a := (103 / 10) * u * D). set (t := / 100 * u * D).
    replace (norm (u * Rabs o1 + a * Rabs w1 + t) (u * Rabs o2 + a * Rabs w2 + t) (u * Rabs o3 + a * Rabs w3 + t)) with
      (norm ((u * Rabs o1 + a * Rabs w1) + t) ((u * Rabs o2 + a * Rabs w2) + t) ((u * Rabs o3 + a * Rabs w3) + t))
      by reflexivity.
    eapply Rle_trans; [apply norm_triangle|]. eapply Rle_trans; [apply Rplus_le_compat_r, norm_triangle|].
    rewrite !norm_scaled, !norm_abs, w_unit, !Rabs_pos_eq by (unfold a; pose proof u_pos; lra).
    assert (norm t t t <= 2 * t) by (eapply Rle_trans; [apply (norm_equal _ _ _ t); unfold t; try lra;
      rewrite Rabs_pos_eq; lra | unfold t; lra]).
    pose proof o_norm as O. assert (u * norm o1 o2 o3 <= u * (D - 1)) by (apply Rmult_le_compat_l;
      [apply Rlt_le, u_pos | assumption]).
    pose proof u_pos. unfold a, t in *. lra. }
  set (e1 := o1 - p1) in *. set (e2 := o2 - p2) in *. set (e3 := o3 - p3) in *.
  assert (N2 : norm e1 e2 e3 <= (1 + / 1000) * u * (D - 1) + (35 / 10) * u).
  { eapply Rle_trans; [eapply norm_monotone; eassumption|]. eapply Rle_trans; [apply norm_triangle|].
    pose proof u_pos. rewrite norm_scaled, norm_abs, Rabs_pos_eq by lra.
    assert (norm IMAGE IMAGE IMAGE <= 17321 / 10000 * IMAGE) by (apply norm_equal; try lra;
      rewrite Rabs_pos_eq; lra).
    pose proof o_norm as O. assert (u * norm o1 o2 o3 <= u * (D - 1)) by (apply Rmult_le_compat_l; lra). lra. }
  (* a projection shortens *)
  set (z := e1 * w1 + e2 * w2 + e3 * w3).
  assert (N3 : norm (e1 - z * w1) (e2 - z * w2) (e3 - z * w3) <= norm e1 e2 e3).
  { apply norm_le; [apply norm_pos|]. rewrite norm_sq. pose proof (norm_sq w1 w2 w3) as WW. rewrite w_unit in WW.
    replace ((e1 - z * w1) * (e1 - z * w1) + (e2 - z * w2) * (e2 - z * w2) + (e3 - z * w3) * (e3 - z * w3)) with
      (e1 * e1 + e2 * e2 + e3 * e3 - 2 * z * z + z * z * (w1 * w1 + w2 * w2 + w3 * w3)) by (unfold z; ring).
    rewrite <- WW. pose proof (sq_pos z). lra. }
  eapply Rle_trans; [apply (norm_difference _ _ _ (e1 - z * w1) (e2 - z * w2) (e3 - z * w3))|].
  assert (F1 : q1 - q1' - (e1 - z * w1) = q1 - (o1 - here * w1)) by (unfold q1', along, e1, z, here, e1, e2, e3; ring).
  assert (F2 : q2 - q2' - (e2 - z * w2) = q2 - (o2 - here * w2)) by (unfold q2', along, e2, z, here, e1, e2, e3; ring).
  assert (F3 : q3 - q3' - (e3 - z * w3) = q3 - (o3 - here * w3)) by (unfold q3', along, e3, z, here, e1, e2, e3; ring).
  rewrite F1, F2, F3. assert (u <= u * D) by (pose proof u_pos; nra). lra.
Qed.
Lemma along_near : Rabs (base + along) <= (17 + / 10) * u * D.
Proof.
  pose proof D1 as D1. pose proof base_near as B. pose proof u_pos as U.
  set (e1 := o1 - p1) in *. set (e2 := o2 - p2) in *. set (e3 := o3 - p3) in *.
  assert (N : Rabs (e1 * w1 + e2 * w2 + e3 * w3) <= (1 + / 1000) * u * (D - 1) + (35 / 10) * u).
  { eapply Rle_trans; [apply dot_le|]. rewrite w_unit, Rmult_1_r.
    eapply Rle_trans; [eapply norm_monotone; eassumption|]. eapply Rle_trans; [apply norm_triangle|].
    rewrite norm_scaled, norm_abs, Rabs_pos_eq by lra.
    assert (norm IMAGE IMAGE IMAGE <= 17321 / 10000 * IMAGE) by (apply norm_equal; try lra;
      rewrite Rabs_pos_eq; lra).
    pose proof o_norm as O. assert (u * norm o1 o2 o3 <= u * (D - 1)) by (apply Rmult_le_compat_l; lra). lra. }
  replace (base + along) with ((base + here) - (e1 * w1 + e2 * w2 + e3 * w3)) by (unfold along, here, e1, e2, e3; ring).
  unfold Rminus. eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. assert (u <= u * D) by nra. lra.
Qed.

(* ---- The bound ---- *)
Let total := RN (RN (Rabs o1 + Rabs o2) + Rabs o3).
Let error := RN (RN (1 + total) * LINE_ERROR).
Lemma error_low : (128 - / 100) * u * D <= error. Proof. apply error_bound. Qed.

(* The nearest point is off by less than the error, as a vector; the parameter of a hit, from either side. *)
Section Range.
(* kappa: the power of two that units of t are multiplied with; the length in the frame as computed and exactly *)
Variable kappa : R.
Hypothesis K0 : 0 < kappa.
Let len := RN (length * kappa). Let long := l * kappa.
Hypotheses (Hnormal : bp (-1022) < len) (Hfinite : len < bp 1024).
Lemma len_near : Rabs (len - long) <= (37 / 10) * u * long /\ 0 < long <= (1 + / 100) * bp 1024.
Proof.
  pose proof l_pos as L0. pose proof length_near as E. set (m := length * kappa) in *.
  assert (LP : 0 < long) by now apply Rmult_lt_0_compat.
  assert (E1 : Rabs (m - long) <= (26 / 10) * u * long).
  { unfold m, long. replace (length * kappa - l * kappa) with ((length - l) * kappa) by ring.
    rewrite Rabs_mult, (Rabs_pos_eq kappa) by lra. rewrite <- Rmult_assoc. apply Rmult_le_compat_r; lra. }
  apply Rabs_le_inv in E1. assert (M0 : 0 < m) by (rewrite u_val in E1; lra).
  assert (M1 : bp (-1022) <= m).
  { apply Rnot_lt_le. intro C. assert (len <= bp (-1022)); [|lra]. unfold len. rewrite <- (RN_id (bp (-1022))) by
      (apply F_bp; lia). apply RN_le. fold m. lra. }
  assert (E2 : Rabs (len - m) <= u * m).
  { rewrite <- (Rabs_pos_eq m) at 2 by lra. apply RN_normal. rewrite Rabs_pos_eq; lra. }
  apply Rabs_le_inv in E2.
  split; [|split; [assumption | rewrite u_val in *; lra]]. apply Rabs_le. rewrite u_val in *. lra.
Qed.
(* A hit at the exact parameter t', rounded t, lies at tau on the line;
  what a range's end gives is on its side of tau. *)
Lemma along_le : Rabs along <= D + / 100.
Proof.
  pose proof here_le as H. pose proof base_near as B. pose proof along_near as C. pose proof D1 as D1.
  assert (UD : 0 < u * D) by (apply Rmult_lt_0_compat; [apply u_pos | lra]).
  replace along with ((base + along) - (base + here) + here) by ring.
  eapply Rle_trans; [apply Rabs_triang|]. unfold Rminus. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
  rewrite Rabs_Ropp. pose proof D_top. lra.
Qed.
Section Hit.
Variables t t' : R.
Hypothesis Ht : Rabs (t - t') <= u * Rabs t' + bp (-1075).
Let tau := t' * long + along.
Hypothesis Htau : Rabs tau <= REACH.
(* t times the length, not rounded and rounded *)
Lemma hit_near : Rabs (t * len - t' * long) <= (48 / 10) * u * (D + 2) + (41 / 10) * u
  /\ Rabs (RN (t * len) - t' * long) <= (59 / 10) * u * (D + 2) + (42 / 10) * u /\ Rabs (t' * long) <= D + 12 / 10.
Proof.
  destruct len_near as (E & L0 & L1). pose proof along_le as AL. pose proof D1 as D1. pose proof u_pos as U.
  assert (TL : Rabs (t' * long) <= D + 12 / 10).
  { replace (t' * long) with (tau - along) by (unfold tau; ring). unfold Rminus.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. unfold REACH in Htau. lra. }
  assert (B : bp (-1075) * long <= (404 / 100) * u).
  { apply Rle_trans with (bp (-1075) * ((1 + / 100) * bp 1024)); [apply Rmult_le_compat_l; [apply Rlt_le, bp_pos |
      assumption]|].
    replace (bp (-1075) * ((1 + / 100) * bp 1024)) with ((1 + / 100) * bp (-1075 + 1024)) by (rewrite bp_add; ring).
    change (-1075 + 1024)%Z with (2 + -53)%Z. rewrite bp_add. fold u. simpl (bp 2). lra. }
  assert (HM : Rabs (t * len - t' * long) <= (48 / 10) * u * (D + 2) + (41 / 10) * u).
  { replace (t * len - t' * long) with ((t - t') * len + t' * (len - long)) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite !Rabs_mult. apply Rabs_le_inv in E as E'.
    assert (L2 : Rabs len <= (1 + 4 * u) * long) by (rewrite Rabs_pos_eq; rewrite u_val in *; lra).
    assert (TL' : Rabs t' * long <= D + 12 / 10) by (rewrite <- (Rabs_pos_eq long), <- Rabs_mult by lra; assumption).
    assert (X1 : Rabs (t - t') * Rabs len <= (u * Rabs t' + bp (-1075)) * ((1 + 4 * u) * long)) by (apply
      Rmult_le_compat; auto using Rabs_pos).
    replace ((u * Rabs t' + bp (-1075)) * ((1 + 4 * u) * long)) with ((1 + 4 * u) * (u * (Rabs t' * long)) +
      (1 + 4 * u) * (bp (-1075) * long)) in X1 by ring.
    assert (X2 : Rabs t' * Rabs (len - long) <= (37 / 10) * (u * (Rabs t' * long))).
    { apply Rle_trans with (Rabs t' * ((37 / 10) * u * long)); [apply Rmult_le_compat_l;
      [apply Rabs_pos | assumption]|].
      right. ring. }
    assert (X3 : u * (Rabs t' * long) <= u * (D + 12 / 10)) by (apply Rmult_le_compat_l; lra).
    rewrite u_val in *. lra. }
  split; [assumption|]. split; [|assumption].
  eapply Rle_trans; [apply (rounded _ _ _ HM)|]. set (e := (48 / 10) * u * (D + 2) + (41 / 10) * u) in *.
  pose proof (small_D (-1075) ltac:(lia)). assert (e <= / 10) by (unfold e; pose proof D_top; rewrite u_val in *; lra).
  assert (u * (Rabs (t' * long) + e) <= u * (D + 13 / 10)) by (apply Rmult_le_compat_l; lra).
  assert (0 < u * D) by (apply Rmult_lt_0_compat; lra). unfold e in *. lra.
Qed.
(* the same less the base: off by 24 u D + 18 u *)
Lemma parameter_near : Rabs (RN (t * len) - base - tau) <= 24 * u * D + 18 * u.
Proof.
  destruct hit_near as (_ & H & _). pose proof along_near as B.
  replace (RN (t * len) - base - tau) with ((RN (t * len) - t' * long) - (base + along)) by (unfold tau; ring).
  unfold Rminus at 1. eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. pose proof u_pos. pose proof D1.
  assert (u <= u * D) by (rewrite <- (Rmult_1_r u) at 1; apply Rmult_le_compat_l; lra). lra.
Qed.
Lemma rounded_parameter : Rabs (RN (RN (t * len) - base) - tau) <= 25 * u * D + 20 * u.
Proof.
  eapply Rle_trans; [apply (rounded _ _ _ parameter_near)|]. pose proof D_top. pose proof u_pos. pose proof D1.
  assert (u * (Rabs tau + (24 * u * D + 18 * u)) <= u * (15 / 10)).
  { apply Rmult_le_compat_l; [lra|]. unfold REACH in Htau. rewrite u_val in *. lra. }
  pose proof (small_D (-1075) ltac:(lia)). pose proof uD. lra.
Qed.
Lemma tau_2 : Rabs tau <= 2. Proof. unfold REACH in Htau. lra. Qed.
Lemma len_pos : 0 < len.
Proof. pose proof (bp_pos (-1022)). lra. Qed.
Lemma before : forall start, start <= t -> RN (RN (RN (start * len) - base) - error) <= tau.
Proof.
  intros start H. pose proof rounded_parameter as P. apply Rabs_le_inv in P.
  assert (C : RN (RN (start * len) - base) <= RN (RN (t * len) - base)).
  { apply RN_le. apply Rplus_le_compat_r. apply RN_le. apply Rmult_le_compat_r; [apply Rlt_le, len_pos | assumption]. }
  apply RN_lower; [apply tau_2|]. pose proof error_low. pose proof uD. lra.
Qed.
Lemma after : forall end', t <= end' -> tau <= RN (RN (RN (end' * len) - base) + error).
Proof.
  intros end' H. pose proof rounded_parameter as P. apply Rabs_le_inv in P.
  assert (C : RN (RN (t * len) - base) <= RN (RN (end' * len) - base)).
  { apply RN_le. apply Rplus_le_compat_r. apply RN_le. apply Rmult_le_compat_r; [apply Rlt_le, len_pos | assumption]. }
  apply RN_upper; [apply tau_2|]. pose proof error_low. pose proof uD. lra.
Qed.
(* `shorten`: all that is not beyond the best hit stays *)
Lemma shortened : forall best, t <= best -> error < MAX_LINE_ERROR ->
  tau <= RNs (RN (RN (best * len) + RN (RN (error - base) + ROUNDING))).
Proof.
  intros best H M. apply ROUNDING_holds; [assumption|]. pose proof parameter_near as P. apply Rabs_le_inv in P.
  assert (C : RN (t * len) <= RN (best * len)).
  { apply RN_le. apply Rmult_le_compat_r; [apply Rlt_le, len_pos | assumption]. }
  pose proof error_low as EL. pose proof uD as UD. pose proof D_top as DT. pose proof u_pos as U. pose proof D1 as D1.
  unfold MAX_LINE_ERROR in M.
  assert (BB : Rabs base <= D + / 2).
  { replace base with ((base + along) + - along) by ring. eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp.
    pose proof along_le. pose proof along_near. lra. }
  pose proof (RN_err (error - base)) as E1. set (m := RN (error - base)) in *.
  pose proof (RN_err (m + ROUNDING)) as E2. set (o := RN (m + ROUNDING)) in *.
  pose proof (small_D (-1075) ltac:(lia)) as T.
  assert (RV : ROUNDING = / 4194304) by (unfold ROUNDING; simpl; lra). rewrite RV in *.
  assert (A1 : Rabs (error - base) <= D + 1).
  { unfold Rminus. eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp, (Rabs_pos_eq error) by lra. lra. }
  assert (A2 : u * Rabs (error - base) <= u * (D + 1)) by (apply Rmult_le_compat_l; lra).
  assert (A3 : Rabs (m + / 4194304) <= D + 2).
  { replace (m + / 4194304) with ((m - (error - base)) + (error - base) + / 4194304) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
    rewrite (Rabs_pos_eq (/ 4194304)) by lra. rewrite u_val in *. lra. }
  assert (A4 : u * Rabs (m + / 4194304) <= u * (D + 2)) by (apply Rmult_le_compat_l; lra).
  apply Rabs_le_inv in E1. apply Rabs_le_inv in E2.
  apply RN_upper; [|rewrite u_val in *; lra].
  apply Rabs_le_inv in Htau. unfold REACH in Htau. apply Rabs_le. lra.
Qed.
End Hit.
End Range.

(* Where the origin is so near that the error is below the limit: what the tests of boxes and balls take for granted. *)
Lemma nearest_range : error < MAX_LINE_ERROR -> norm q1' q2' q3' <= 1 ->
  norm q1 q2 q3 <= 1 + / 100 /\
  forall s, plain (tdot (X q1 1) (X q2 1) (X q3 1) (X q1 1) (X q2 1) (X q3 1)) s ->
  s <= RN (RN (1 + error) * RN (1 + error)).
Proof.
  intros M Q. pose proof nearest_near as N. pose proof (norm_difference q1 q2 q3 q1' q2' q3') as T.
  pose proof D_top as DT. pose proof u_pos as U. pose proof D1 as D1. pose proof uD as UD. pose proof error_low as EL.
  unfold MAX_LINE_ERROR in M. assert (B : norm q1 q2 q3 <= 1 + (171 / 10) * (u * D)) by lra.
  assert (B1 : norm q1 q2 q3 <= 2) by lra. split; [lra|]. intros s Hs.
  destruct (part_le q1 q2 q3) as (L1 & L2 & L3).
  assert (BB : bp 1 = 2) by (simpl; lra). assert (C1 : Rabs q1 <= bp 1) by lra. assert (C2 : Rabs q2 <= bp 1) by lra.
  assert (C3 : Rabs q3 <= bp 1) by lra. clear - Hs C1 C2 C3 B EL U D1 UD DT M. unfold tdot in Hs. error_of Hs P.
  rewrite !abs_sq in P. pose proof (norm_sq q1 q2 q3) as NS. set (n2 := q1 * q1 + q2 * q2 + q3 * q3) in *.
  pose proof (norm_pos q1 q2 q3) as N0. set (n := norm q1 q2 q3) in *. set (a := u * D) in *.
  match type of P with _ <= _ + bp ?k => assert (T : bp k <= / 1000 * u) by (apply Rle_trans with (bp (-10 + -53));
    [apply bp_le; lia | rewrite bp_add; fold u; simpl (bp (-10)); lra]) end.
  assert (N2 : n2 <= 1 + 38 * a).
  { rewrite <- NS. apply Rle_trans with ((1 + (171 / 10) * a) * (1 + (171 / 10) * a)); [apply mul2; split; lra|]. nra. }
  replace ((128 - / 100) * u * D) with ((128 - / 100) * a) in EL by (unfold a; ring).
  pose proof (RN_err (1 + error)) as E1. set (m := RN (1 + error)) in *. pose proof (RN_err (m * m)) as E2.
  rewrite (Rabs_pos_eq (1 + error)) in E1 by lra. rewrite (Rabs_pos_eq (m * m)) in E2 by apply sq_pos.
  assert (T2 : bp (-1075) <= / 1000 * u) by (apply Rle_trans with (bp (-10 + -53));
    [apply bp_le; lia | rewrite bp_add; fold u; simpl (bp (-10)); lra]).
  apply Rabs_le_inv in E1. apply Rabs_le_inv in E2. apply Rabs_le_inv in P.
  assert (M1 : 1 + 100 * a <= m) by (rewrite u_val in *; lra). assert (M2 : 1 + 200 * a <= m * m).
  { apply Rle_trans with ((1 + 100 * a) * (1 + 100 * a)); [pose proof (sq_pos a); lra | apply mul2; split; lra]. }
  rewrite u_val in *. lra.
Qed.
End Line.

(* The limit is what keeps the origin within 2^45: the premise above. *)
Theorem MAX_LINE_ERROR_holds : forall o1 o2 o3,
  RN (RN (1 + RN (RN (Rabs o1 + Rabs o2) + Rabs o3)) * LINE_ERROR) < MAX_LINE_ERROR ->
  Rabs o1 <= bp 45 /\ Rabs o2 <= bp 45 /\ Rabs o3 <= bp 45.
Proof.
  intros o1 o2 o3 H. pose proof (error_bound o1 o2 o3) as E. cbv zeta in E. unfold MAX_LINE_ERROR in H.
  assert (B : bp 45 = 35184372088832) by (simpl; lra). rewrite B. pose proof (Rabs_pos o1). pose proof (Rabs_pos o2).
  pose proof (Rabs_pos o3). rewrite u_val in E. repeat split; lra.
Qed.

(* All errors are below the bound: of the nearest point, as a vector; of the parameter of a hit at either end of the
   range, and at the best hit. *)
Theorem LINE_ERROR_holds : forall o1 o2 o3 p1 p2 p3 d1 d2 d3 S dot x1 x2 x3 kappa t t',
  let l := norm d1 d2 d3 in let along := (p1 * (d1 / l) + p2 * (d2 / l) + p3 * (d3 / l)) in
  let inverse := RN (/ S) in let length := RN (sqrt S) in let g := RN (dot * inverse) in
  let base := RN (- dot * RN (length * inverse)) in let len := RN (length * kappa) in
  let error := RN (RN (1 + RN (RN (Rabs o1 + Rabs o2) + Rabs o3)) * LINE_ERROR) in
  let tau := t' * (l * kappa) + along in
  Rabs d1 <= bp 100 -> Rabs d2 <= bp 100 -> Rabs d3 <= bp 100 -> bp (-200) <= d1 * d1 + d2 * d2 + d3 * d3 ->
  Rabs (o1 - p1) <= (1 + / 1000) * u * Rabs o1 + IMAGE -> Rabs (o2 - p2) <= (1 + / 1000) * u * Rabs o2 + IMAGE ->
  Rabs (o3 - p3) <= (1 + / 1000) * u * Rabs o3 + IMAGE ->
  plain (tdot (X d1 100) (X d2 100) (X d3 100) (X d1 100) (X d2 100) (X d3 100)) S ->
  plain (tdot (X o1 45) (X o2 45) (X o3 45) (X d1 100) (X d2 100) (X d3 100)) dot ->
  Rabs (x1 - d1 * g) <= u * Rabs (d1 * g) + bp (-1075) -> Rabs (x2 - d2 * g) <= u * Rabs (d2 * g) + bp (-1075) ->
  Rabs (x3 - d3 * g) <= u * Rabs (d3 * g) + bp (-1075) ->
  0 < kappa -> bp (-1022) < len -> len < bp 1024 -> Rabs (t - t') <= u * Rabs t' + bp (-1075) -> Rabs tau <= REACH ->
  error < MAX_LINE_ERROR ->
  norm (RN (o1 - x1) - (p1 - along * (d1 / l))) (RN (o2 - x2) - (p2 - along * (d2 / l)))
    (RN (o3 - x3) - (p3 - along * (d3 / l))) <= error
  /\ (forall start, start <= t -> down (Rmax (RN (RN (RN (start * len) - base) - error)) (- REACH)) <= tau)
  /\ (forall end', t <= end' -> tau <= up (Rmin (RN (RN (RN (end' * len) - base) + error)) REACH))
  /\ (forall best, t <= best -> tau <= RNs (RN (RN (best * len) + RN (RN (error - base) + ROUNDING)))).
Proof.
  intros until tau. intros. destruct (MAX_LINE_ERROR_holds o1 o2 o3 H16) as (O1 & O2 & O3).
  pose proof (nearest_near o1 o2 o3 p1 p2 p3 d1 d2 d3 H H0 H1 H2 O1 O2 O3 H3 H4 H5 S dot x1 x2 x3 H6 H7 H8 H9 H10) as N.
  pose proof (error_bound o1 o2 o3) as E. cbv zeta in E.
  assert (T : 0 < u * (Rabs o1 + Rabs o2 + Rabs o3 + 1)) by (apply Rmult_lt_0_compat; [apply u_pos|];
    pose proof (Rabs_pos o1); pose proof (Rabs_pos o2); pose proof (Rabs_pos o3); lra).
  split; [eapply Rle_trans; [exact N|]; fold error in E; lra|].
  apply Rabs_le_inv in H15 as TT. split; [|split].
  - intros start Hs. apply Rle_trans with (1 := down_below _). apply Rmax_lub; [|lra].
    eapply (before o1 o2 o3 p1 p2 p3 d1 d2 d3) with (t := t) (t' := t') (x1 := x1) (x2 := x2) (x3 := x3); eassumption.
  - intros end' He. apply Rle_trans with (2 := up_above _). apply Rmin_glb; [|lra].
    eapply (after o1 o2 o3 p1 p2 p3 d1 d2 d3) with (t := t) (t' := t') (x1 := x1) (x2 := x2) (x3 := x3); eassumption.
  - intros best Hb. eapply (shortened o1 o2 o3 p1 p2 p3 d1 d2 d3) with (t := t) (t' := t') (x1 := x1) (x2 := x2) (x3
    := x3);
      eassumption.
Qed.

(* `EVERYTHING`: meets every box and every ball. *)
Theorem everything_boxes : forall p, Rabs p <= 1 + / 1000 -> RNs (p * bp (-30)
  + - 8) <= - 2 /\ 2 <= RNs (p * bp (-30) + 8).
Proof.
  intros p H. apply Rabs_le_inv in H. assert (B : bp (-30) = / 1073741824) by (simpl; lra). rewrite B.
  assert (F2 : Fs 2) by (replace 2 with (bp 1) by (simpl; lra); apply Fs_bp; lia).
  split; [apply RNs_below; [now apply Fs_opp | lra] | apply RNs_above; [assumption | lra]].
Qed.
(* The scale of a direction times that of a frame, powers of two: exact, or zero where it is below 2^-1074 (and then the
   length is, so that everything is met). *)
Theorem scales : forall k, RN (bp k) = bp k \/ RN (bp k) = 0.
Proof.
  intro k. destruct (Z_le_gt_dec (-1074) k) as [L|G]; [left; apply RN_id, F_bp; exact L | right].
  assert (T : RN (bp (-1075)) = 0).
  { unfold RN, round, scaled_mantissa. assert (C : cexp radix2 fexp (bp (-1075)) = (-1074)%Z) by (unfold cexp;
    rewrite mag_bpow;
      reflexivity). rewrite C, <- bp_add. replace (bp (-1075 + - -1074)) with (/ 2) by (simpl; lra).
    replace (ZnearestE (/ 2)) with 0%Z; [unfold F2R; simpl; ring|]. unfold Znearest.
    assert (Z : Zfloor (/ 2) = 0%Z) by (apply Zfloor_imp; simpl; lra).
    rewrite Z, Rminus_0_r, Rcompare_Eq by reflexivity.
    reflexivity. }
  apply Rle_antisym; [rewrite <- T; apply RN_le, bp_le; lia | rewrite <- RN_0; apply RN_le, Rlt_le, bp_pos].
Qed.
