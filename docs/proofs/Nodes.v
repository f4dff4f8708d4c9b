(* rt-geom, enclosing/nodes.rs, certify.rs (`settle`,
  `enclose_all`) and extreme.rs: reaches in doubles that decide whom to
   pass over. *)
From Proofs Require Import Rounding Norm Reach Near.
Open Scope R_scope.

(* What a limit is below the farthest reach, and the radius of a node above it. *)
Definition NODE_ERROR := 16 * u.
(* How far inside spheres are that `settle` and `enclose_all` pass over. *)
Definition SETTLED := 16 * u.
Definition ENCLOSED := 16 * u.
(* How much less than the farthest of a scaled copy a sphere reaches that is passed over. *)
Definition EXTREME := 32 * u.
(* The pull of the support of a node, relative to its radius. *)
Definition BALANCED := 1 / 10000000000.

(* A length as computed, underflow included. *)
Definition length d1 d2 d3 := RN (sqrt (squares d1 d2 d3)).
Lemma length_error : forall d1 d2 d3, Rabs d1 <= bp 1023 -> Rabs d2 <= bp 1023 -> Rabs d3 <= bp 1023 ->
  norm d1 d2 d3 <= (1 + (28 / 10) * u) * length d1 d2 d3 + bp (-510) /\
  length d1 d2 d3 <= (1 + (28 / 10) * u) * norm d1 d2 d3 + bp (-510) /\ 0 <= length d1 d2 d3.
Proof.
  intros d1 d2 d3 B1 B2 B3. pose proof u_pos as U. pose proof (squares_plain d1 d2 d3 1023) as Hs.
  pose proof (squares_pos d1 d2 d3) as S0. unfold length. set (s := squares d1 d2 d3) in *. unfold tdot in Hs.
  error_of Hs P.
  rewrite !abs_sq in P. pose proof (norm_sq d1 d2 d3) as NN. pose proof (norm_pos d1 d2 d3) as N0. rewrite <- NN in P.
  set (n := norm d1 d2 d3) in *. pose proof (sq_pos n) as n2. pose proof (bp_pos (-520)) as T0.
  assert (TT : bp (-520) * bp (-520) = bp (-1040)) by (rewrite bp_sq; reflexivity).
  match type of P with _ <= _ + bp ?k => assert (T1 : bp k <= / 1000 * bp (-1040)) by (apply Rle_trans with
    (bp (-12 + -1040)); [apply bp_le; lia|]; rewrite bp_add; pose proof (bp_pos (-1040)); simpl (bp (-12)); lra) end.
  assert (T2 : bp (-520) <= / 1000 * bp (-510)) by (apply Rle_trans with (bp (-10 + -510)); [apply bp_le; lia|];
    rewrite bp_add; pose proof (bp_pos (-510)); simpl (bp (-10)); lra).
  assert (T3 : bp (-1075) <= bp (-520)) by (apply bp_le; lia). pose proof (bp_pos (-1040)) as T4.
  set (y := sqrt s). assert (yy : y * y = s) by (now apply sqrt_sqrt). assert (y0 : 0 <= y) by apply sqrt_pos.
  pose proof (RN_err y) as E. rewrite (Rabs_pos_eq y) in E by assumption. apply Rabs_le_inv in E.
  apply Rabs_le_inv in P.
  assert (L0 : 0 <= RN y) by (rewrite <- RN_0; now apply RN_le).
  assert (A : n <= (1 + (16 / 10) * u) * y + bp (-520)).
  { apply below_root; [assert (0 <= u * y) by (apply Rmult_le_pos; lra); lra|].
    replace (((1 + (16 / 10) * u) * y + bp (-520)) * ((1 + (16 / 10) * u) * y + bp (-520))) with ((1 + (16 / 10) * u) *
      (1 + (16 / 10) * u) * (y * y) + 2 * (1 + (16 / 10) * u) * (y * bp (-520)) + bp (-520) * bp (-520)) by ring.
    rewrite yy, TT. assert (0 <= y * bp (-520)) by (apply Rmult_le_pos; lra). rewrite u_val in *. lra. }
  assert (B : y <= (1 + (16 / 10) * u) * n + bp (-520)).
  { apply below_root; [assert (0 <= u * n) by (apply Rmult_le_pos; lra); lra|]. rewrite yy.
    replace (((1 + (16 / 10) * u) * n + bp (-520)) * ((1 + (16 / 10) * u) * n + bp (-520))) with ((1 + (16 / 10) * u) *
      (1 + (16 / 10) * u) * (n * n) + 2 * (1 + (16 / 10) * u) * (n * bp (-520)) + bp (-520) * bp (-520)) by ring.
    rewrite TT. assert (0 <= n * bp (-520)) by (apply Rmult_le_pos; lra). rewrite u_val in *. lra. }
  split; [|split; [|assumption]]; rewrite u_val in *; lra.
Qed.
(* The reach of a sphere from a center in doubles. *)
Definition rough b1 b2 b3 r c1 c2 c3 := RN (length (RN (b1 - c1)) (RN (b2 - c2)) (RN (b3 - c3)) + r).
Definition reach b1 b2 b3 r c1 c2 c3 := norm (b1 - c1) (b2 - c2) (b3 - c3) + r.
Definition in_range b1 b2 b3 c1 c2 c3 := Rabs (RN (b1 - c1)) <= bp 1023 /\ Rabs (RN (b2 - c2)) <= bp 1023 /\
  Rabs (RN (b3 - c3)) <= bp 1023.
Lemma difference_near : forall b1 b2 b3 c1 c2 c3, F b1 -> F b2 -> F b3 -> F c1 -> F c2 -> F c3 ->
  let n := norm (RN (b1 - c1)) (RN (b2 - c2)) (RN (b3 - c3)) in let N := norm (b1 - c1) (b2 - c2) (b3 - c3) in
  N <= (1 + 2 * u) * n /\ n <= (1 + u) * N.
Proof.
  intros. pose proof u_pos as U. assert (E : norm (RN (b1 - c1) - (b1 - c1)) (RN (b2 - c2) - (b2 - c2)) (RN (b3 - c3)
    - (b3 - c3))
    <= u * N) by (apply norm_relative; try (now apply RN_diff); lra).
  pose proof (norm_difference (RN (b1 - c1)) (RN (b2 - c2)) (RN (b3 - c3)) (b1 - c1) (b2 - c2) (b3 - c3)) as A.
  pose proof (norm_difference (b1 - c1) (b2 - c2) (b3 - c3) (RN (b1 - c1)) (RN (b2 - c2)) (RN (b3 - c3))) as B.
  replace (norm (b1 - c1 - RN (b1 - c1)) (b2 - c2 - RN (b2 - c2)) (b3 - c3 - RN (b3 - c3))) with (norm (RN (b1 - c1) -
    (b1 - c1)) (RN (b2 - c2) - (b2 - c2)) (RN (b3 - c3) - (b3 - c3))) in B by (rewrite <- norm_opp; f_equal; ring).
  fold n N in A, B. pose proof (norm_pos (b1 - c1) (b2 - c2) (b3 - c3)) as P. fold N in P. rewrite u_val in *.
  split; lra.
Qed.
Lemma rough_near : forall b1 b2 b3 r c1 c2 c3, F b1 -> F b2 -> F b3 -> F r -> F c1 -> F c2 -> F c3 -> 0 <= r ->
  in_range b1 b2 b3 c1 c2 c3 -> let x := rough b1 b2 b3 r c1 c2 c3 in let X := reach b1 b2 b3 r c1 c2 c3 in
  X <= (1 + 6 * u) * x + 2 * bp (-510) /\ x <= (1 + 6 * u) * X + 2 * bp (-510) /\ 0 <= x /\ F x /\ 0 <= X.
Proof.
  intros b1 b2 b3 r c1 c2 c3 F1 F2 F3 Fr F4 F5 F6 Hr (B1 & B2 & B3) x X. pose proof u_pos as U.
  destruct (difference_near b1 b2 b3 c1 c2 c3 F1 F2 F3 F4 F5 F6) as [D1 D2].
  destruct (length_error _ _ _ B1 B2 B3) as (L1 & L2 & L0). unfold X, reach.
  pose proof (norm_pos (b1 - c1) (b2 - c2) (b3 - c3)) as N0.
  set (n := norm (RN (b1 - c1)) (RN (b2 - c2)) (RN (b3 - c3))) in *. set (N := norm (b1 - c1) (b2 - c2) (b3 - c3)) in *.
  set (l := length (RN (b1 - c1)) (RN (b2 - c2)) (RN (b3 - c3))) in *. assert (Fl : F l) by apply RN_F.
  pose proof (RN_sum l r Fl Fr) as E. change (RN (l + r)) with x in E. rewrite (Rabs_pos_eq (l + r)) in E by lra.
  apply Rabs_le_inv in E. pose proof (bp_pos (-510)). assert (n0 : 0 <= n) by apply norm_pos.
  assert (x0 : 0 <= x) by (unfold x, rough; fold l; rewrite <- RN_0; apply RN_le; lra).
  split; [rewrite u_val in *; lra|]. split; [rewrite u_val in *; lra|]. split; [assumption|]. split; [apply RN_F | lra].
Qed.
Lemma F_above : F (1 + 16 * u) /\ F (1 - 16 * u).
Proof.
  assert (B : bp (-49) = 16 * u) by (unfold u; change (-49)%Z with (4 + -53)%Z; rewrite bp_add; simpl (bp 4); lra).
  split.
  - replace (1 + 16 * u) with (IZR 562949953421313 * bp (-49)) by (rewrite B, u_val; lra). apply F_scaled; lia.
  - replace (1 - 16 * u) with (IZR 562949953421311 * bp (-49)) by (rewrite B, u_val; lra). apply F_scaled; lia.
Qed.
Lemma small : forall x, bp (-300) <= x -> bp (-510) <= / 1000 * (u * x) /\ bp (-525) <= / 1000 * (u * x) /\
  bp (-1075) <= / 1000 * (u * x).
Proof.
  intros x H. pose proof u_pos. assert (A : bp (-510) <= / 1000 * (u * x)).
  { apply Rle_trans with (bp (-10 + (-53 + -300))); [apply bp_le; lia|]. rewrite !bp_add. fold u.
    assert (u * bp (-300) <= u * x) by (apply Rmult_le_compat_l; lra). assert (bp (-10) <= / 1000) by (simpl; lra).
    pose proof (bp_pos (-10)). pose proof (bp_pos (-300)). apply Rmult_le_compat; try lra. apply Rmult_le_pos; lra. }
  assert (bp (-525) <= bp (-510)) by (apply bp_le; lia). assert (bp (-1075) <= bp (-510)) by (apply bp_le; lia).
  repeat split; lra.
Qed.

(* A node: what is set aside does not reach beyond the best reach that was computed;
  and of what is not set aside, the best
   times 1 + 16 u is not below any reach. *)
Theorem NODE_ERROR_holds : forall b1 b2 b3 r c1 c2 c3 best,
  F b1 -> F b2 -> F b3 -> F r -> F c1 -> F c2 -> F c3 -> F best ->
  0 <= r -> in_range b1 b2 b3 c1 c2 c3 -> bp (-300) <= best ->
  let limit := RN (best * (1 - NODE_ERROR)) in let room := RN (limit - r) in
  let d1 := RN (b1 - c1) in let d2 := RN (b2 - c2) in let d3 := RN (b3 - c3) in
  (RN (squares d1 d2 d3 - RN (room * Rabs room)) < 0 -> reach b1 b2 b3 r c1 c2 c3 <= best) /\
  (rough b1 b2 b3 r c1 c2 c3 <= best -> reach b1 b2 b3 r c1 c2 c3 <= RN (best * (1 + NODE_ERROR))).
Proof.
  intros b1 b2 b3 r c1 c2 c3 best F1 F2 F3 Fr F4 F5 F6 Fb Hr HR Hb limit room d1 d2 d3. pose proof u_pos as U.
  pose proof (bp_pos (-300)) as P0. destruct (small best Hb) as (S1 & S2 & S3). unfold NODE_ERROR in *. split.
  - intro H. destruct HR as (B1 & B2 & B3). fold d1 in B1. fold d2 in B2. fold d3 in B3.
    pose proof (measured d1 d2 d3 limit r B1 B2 B3 (RN_F _) Fr Hr H) as M.
    destruct (difference_near b1 b2 b3 c1 c2 c3 F1 F2 F3 F4 F5 F6) as [D1 _]. fold d1 d2 d3 in D1. unfold reach.
    pose proof (RN_err (best * (1 - 16 * u))) as E. fold limit in E.
    rewrite (Rabs_pos_eq (best * (1 - 16 * u))) in E by (apply Rmult_le_pos; rewrite ?u_val; lra).
    apply Rabs_le_inv in E.
    pose proof (norm_pos d1 d2 d3). rewrite u_val in *. lra.
  - intro H. destruct (rough_near b1 b2 b3 r c1 c2 c3 F1 F2 F3 Fr F4 F5 F6 Hr HR) as (X & _).
    pose proof (RN_err (best * (1 + 16 * u))) as E.
    rewrite (Rabs_pos_eq (best * (1 + 16 * u))) in E by (apply Rmult_le_pos; lra). apply Rabs_le_inv in E.
    rewrite u_val in *. lra.
Qed.
Theorem SETTLED_holds : forall b1 b2 b3 r c1 c2 c3 radius, F b1 -> F b2 -> F b3 -> F r -> F c1 -> F c2 -> F c3 ->
  0 <= r -> in_range b1 b2 b3 c1 c2 c3 -> bp (-299) <= radius ->
  RN (rough b1 b2 b3 r c1 c2 c3 * (1 + SETTLED)) <= radius -> reach b1 b2 b3 r c1 c2 c3 <= radius.
Proof.
  intros b1 b2 b3 r c1 c2 c3 radius F1 F2 F3 Fr F4 F5 F6 Hr HR Hb H. pose proof u_pos as U.
  destruct (rough_near b1 b2 b3 r c1 c2 c3 F1 F2 F3 Fr F4 F5 F6 Hr HR) as (X & _ & X0 & _). unfold SETTLED in H.
  set (x := rough b1 b2 b3 r c1 c2 c3) in *. pose proof (RN_err (x * (1 + 16 * u))) as E.
  rewrite (Rabs_pos_eq (x * (1 + 16 * u))) in E by (apply Rmult_le_pos; lra). apply Rabs_le_inv in E.
  assert (HB : bp (-300) <= radius) by (apply Rle_trans with (2 := Hb); apply bp_le; lia).
  destruct (small radius HB) as (S1 & _ & S3). pose proof (bp_pos (-300)). rewrite u_val in *. lra.
Qed.
Theorem ENCLOSED_holds : forall b1 b2 b3 r c1 c2 c3 low, F b1 -> F b2 -> F b3 -> F r -> F c1 -> F c2 -> F c3 ->
  0 <= r -> in_range b1 b2 b3 c1 c2 c3 -> bp (-300) <= low ->
  rough b1 b2 b3 r c1 c2 c3 < RN (low * (1 - ENCLOSED)) -> reach b1 b2 b3 r c1 c2 c3 <= low.
Proof.
  intros b1 b2 b3 r c1 c2 c3 low F1 F2 F3 Fr F4 F5 F6 Hr HR Hb H. pose proof u_pos as U.
  pose proof (bp_pos (-300)) as P0.
  destruct (rough_near b1 b2 b3 r c1 c2 c3 F1 F2 F3 Fr F4 F5 F6 Hr HR) as (X & _). unfold ENCLOSED in H.
  pose proof (RN_err (low * (1 - 16 * u))) as E.
  rewrite (Rabs_pos_eq (low * (1 - 16 * u))) in E by (apply Rmult_le_pos; rewrite ?u_val; lra). apply Rabs_le_inv in E.
  destruct (small low Hb) as (S1 & _ & S3). rewrite u_val in *. lra.
Qed.

(* A scaled copy: whoever is passed over reaches less far than the farthest, also before the copy was made,
  where each reach
   was another by `lost` at most. *)
Theorem EXTREME_holds : forall b1 b2 b3 r f1 f2 f3 s c1 c2 c3 lost X Y,
  F b1 -> F b2 -> F b3 -> F r -> F f1 -> F f2 -> F f3 ->
  F s -> F c1 -> F c2 -> F c3 -> 0 <= r -> 0 <= s -> in_range b1 b2 b3 c1 c2 c3 -> in_range f1 f2 f3 c1 c2 c3 ->
  let most := rough f1 f2 f3 s c1 c2 c3 in bp (-300) <= most -> lost <= bp (-400) ->
  Rabs (X - reach b1 b2 b3 r c1 c2 c3) <= lost -> Rabs (Y - reach f1 f2 f3 s c1 c2 c3) <= lost ->
  rough b1 b2 b3 r c1 c2 c3 <= RN (most * (1 - EXTREME)) -> X < Y.
Proof.
  intros b1 b2 b3 r f1 f2 f3 s c1 c2 c3 lost X Y F1 F2 F3 Fr F4 F5 F6 Fs F7 F8 F9 Hr Hs HR HF most Hm Hl HX HY H.
  pose proof u_pos as U. pose proof (bp_pos (-300)) as P0.
  destruct (rough_near b1 b2 b3 r c1 c2 c3 F1 F2 F3 Fr F7 F8 F9 Hr HR) as (A1 & _).
  destruct (rough_near f1 f2 f3 s c1 c2 c3 F4 F5 F6 Fs F7 F8 F9 Hs HF) as (_ & A2 & _). fold most in A2.
  unfold EXTREME in H. pose proof (RN_err (most * (1 - 32 * u))) as E.
  rewrite (Rabs_pos_eq (most * (1 - 32 * u))) in E by (apply Rmult_le_pos; rewrite ?u_val; lra). apply Rabs_le_inv in E.
  destruct (small most Hm) as (S1 & _ & S3). apply Rabs_le_inv in HX. apply Rabs_le_inv in HY.
  assert (L : bp (-400) <= / 1000 * (u * most)).
  { apply Rle_trans with (bp (-10 + (-53 + -300))); [apply bp_le; lia|]. rewrite !bp_add. fold u.
    assert (u * bp (-300) <= u * most) by (apply Rmult_le_compat_l; lra). assert (bp (-10) <= / 1000) by (simpl; lra).
    pose proof (bp_pos (-10)). apply Rmult_le_compat; try lra. apply Rmult_le_pos; lra. }
  pose proof (bp_pos (-510)). rewrite u_val in *. lra.
Qed.

(* The bound of section 8.11 at a pull of BALANCED and a spread of 16 u. *)
Theorem BALANCED_holds : 16 * u + BALANCED * sqrt (2 * (16 * u + 2 * BALANCED)) < 4 / 1000000000000000.
Proof.
  unfold BALANCED. assert (S : sqrt (2 * (16 * u + 2 * (1 / 10000000000))) <= 20001 / 1000000000).
  { apply below_root; [lra|]. rewrite sqrt_sqrt by (rewrite u_val; lra). rewrite u_val. lra. }
  rewrite u_val in *. lra.
Qed.
