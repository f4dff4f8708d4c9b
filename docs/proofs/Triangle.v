(* rt-geom, triangle/filter.rs, triangle/mod.rs, triangle/exact.rs: a line and a triangle in plain doubles. *)
From Proofs Require Import Rounding.
Open Scope R_scope.

(* Where the filter's bounds are proved: edges of at least 2^-150, the triangle with the ray's origin below 2^300. *)
Definition SHORTEST := bp (-150).
Definition FARTHEST := bp 300.
(* The error of each volume, relative to D E (E + S), and of the height, relative to E^2 (E + S). *)
Definition ERROR := 18 * u.
(* The same of the slope and of the height of a plane: `slope_sign`, `height_sign`. *)
Definition PLANE_ERROR := 18 * u.
(* What underflows in a height. *)
Definition UNDERFLOW := bp (-500).
(* The error of a component of the normal, relative to E^2. *)
Definition AREA_ERROR := 16 * u.

(* Permanents: x . (y x z) for |y_i| <= Y, |x_i| <= X_i, |z_i| <= Z_i. *)
Lemma permanent : forall x1 x2 x3 y1 y2 y3 z1 z2 z3 X1 X2 X3 Y Z1 Z2 Z3,
  0 <= x1 <= X1 -> 0 <= x2 <= X2 -> 0 <= x3 <= X3 -> 0 <= y1 <= Y -> 0 <= y2 <= Y -> 0 <= y3 <= Y ->
  0 <= z1 <= Z1 -> 0 <= z2 <= Z2 -> 0 <= z3 <= Z3 ->
  x1 * (y2 * z3 + y3 * z2) + x2 * (y3 * z1 + y1 * z3) + x3 * (y1 * z2 + y2 * z1) <= Y * ((X1 + X2 + X3) * (Z1 + Z2 +
    Z3)).
Proof.
  intros x1 x2 x3 y1 y2 y3 z1 z2 z3 X1 X2 X3 Y Z1 Z2 Z3 A1 A2 A3 B1 B2 B3 C1 C2 C3.
  pose proof (mul3 _ _ _ _ _ _ A1 B2 C3). pose proof (mul3 _ _ _ _ _ _ A1 B3 C2).
  pose proof (mul3 _ _ _ _ _ _ A2 B3 C1).
  pose proof (mul3 _ _ _ _ _ _ A2 B1 C3). pose proof (mul3 _ _ _ _ _ _ A3 B1 C2).
  pose proof (mul3 _ _ _ _ _ _ A3 B2 C1).
  assert (T : forall a b c, 0 <= a -> 0 <= b -> 0 <= c -> 0 <= a * b * c) by (intros; repeat apply Rmult_le_pos;
    assumption).
  pose proof (T X1 Y Z1 ltac:(lra) ltac:(lra) ltac:(lra)). pose proof (T X2 Y Z2 ltac:(lra) ltac:(lra) ltac:(lra)).
  pose proof (T X3 Y Z3 ltac:(lra) ltac:(lra) ltac:(lra)). lra.
Qed.

Section Triangle.
(* the vertices, the ray's origin and direction *)
Variables a1 a2 a3 b1 b2 b3 c1 c2 c3 o1 o2 o3 d1 d2 d3 : R.
Let e1 := b1 - a1. Let e2 := b2 - a2. Let e3 := b3 - a3.
Let f1 := c1 - a1. Let f2 := c2 - a2. Let f3 := c3 - a3.
Let s1 := o1 - a1. Let s2 := o2 - a2. Let s3 := o3 - a3.
(* M_i, E, S and D of docs/numerics.md *)
Let M1 := Rmax (Rabs e1) (Rabs f1). Let M2 := Rmax (Rabs e2) (Rabs f2). Let M3 := Rmax (Rabs e3) (Rabs f3).
Let E := M1 + M2 + M3.
Let S := Rabs s1 + Rabs s2 + Rabs s3.
Variable reach : R.
Hypotheses (R1 : Rabs d1 <= reach) (R2 : Rabs d2 <= reach) (R3 : Rabs d3 <= reach).
(* d x f and s x e, the volumes and the height *)
Let p1 := d2 * f3 - d3 * f2. Let p2 := d3 * f1 - d1 * f3. Let p3 := d1 * f2 - d2 * f1.
Let q1 := s2 * e3 - s3 * e2. Let q2 := s3 * e1 - s1 * e3. Let q3 := s1 * e2 - s2 * e1.
Let Sum := e1 * p1 + e2 * p2 + e3 * p3.
Let V := s1 * p1 + s2 * p2 + s3 * p3.
Let W := d1 * q1 + d2 * q2 + d3 * q3.
Let Height := f1 * q1 + f2 * q2 + f3 * q3.
(* the component of e x f *)
Let n1 := e2 * f3 - e3 * f2.

Definition te1 := D b1 a1 301. Definition te2 := D b2 a2 301. Definition te3 := D b3 a3 301.
Definition tf1 := D c1 a1 301. Definition tf2 := D c2 a2 301. Definition tf3 := D c3 a3 301.
Definition ts1 := D o1 a1 301. Definition ts2 := D o2 a2 301. Definition ts3 := D o3 a3 301.
Definition td1 := X d1 100. Definition td2 := X d2 100. Definition td3 := X d3 100.
Definition tp1 := tminor td2 tf3 td3 tf2. Definition tp2 := tminor td3 tf1 td1 tf3.
Definition tp3 := tminor td1 tf2 td2 tf1.
Definition tq1 := tminor ts2 te3 ts3 te2. Definition tq2 := tminor ts3 te1 ts1 te3.
Definition tq3 := tminor ts1 te2 ts2 te1.
Definition tn1 := tminor te2 tf3 te3 tf2.
Definition tsum := tdot te1 te2 te3 tp1 tp2 tp3.
Definition tv := tdot ts1 ts2 ts3 tp1 tp2 tp3.
Definition tw := tdot td1 td2 td3 tq1 tq2 tq3.
Definition theight := tdot tf1 tf2 tf3 tq1 tq2 tq3.
Definition tedge := Add (Add (Max (Abs te1) (Abs tf1)) (Max (Abs te2) (Abs tf2))) (Max (Abs te3) (Abs tf3)).
Definition tsize := Add tedge (Add (Add (Abs ts1) (Abs ts2)) (Abs ts3)).
Definition tspread := Mul (Mul (X ERROR (-48)) tedge) tsize.
Definition terror := Mul tspread (X reach 100).
Definition theight_error := Mul tspread tedge.
Definition tleans := Mul (Mul (Mul (X ERROR (-48)) tedge) tedge) (X reach 100).
Definition tarea := Mul (Mul (X AREA_ERROR (-48)) tedge) tedge.
Ltac terms := unfold terror, theight_error, tleans, tarea, tspread, tsize, tedge, theight, tw, tv, tsum, tn1, tq1,
  tq2, tq3,
  tp1, tp2, tp3, td1, td2, td3, ts1, ts2, ts3, tf1, tf2, tf3, te1, te2, te3, tdot, tminor in *.
Ltac named H := fold e1 e2 e3 f1 f2 f3 s1 s2 s3 in H; fold M1 M2 M3 in H; fold E S in H.

Hypotheses (He1 : Rabs e1 <= bp 301) (He2 : Rabs e2 <= bp 301) (He3 : Rabs e3 <= bp 301)
  (Hf1 : Rabs f1 <= bp 301) (Hf2 : Rabs f2 <= bp 301) (Hf3 : Rabs f3 <= bp 301)
  (Hs1 : Rabs s1 <= bp 301) (Hs2 : Rabs s2 <= bp 301) (Hs3 : Rabs s3 <= bp 301)
  (Hd : bp (-100) <= reach <= bp 100).

Lemma pieces : Rabs d1 <= bp 100 /\ Rabs d2 <= bp 100 /\ Rabs d3 <= bp 100 /\ Rabs reach <= bp 100 /\
  (0 <= Rabs e1 <= M1 /\ 0 <= Rabs e2 <= M2 /\ 0 <= Rabs e3 <= M3) /\
  (0 <= Rabs f1 <= M1 /\ 0 <= Rabs f2 <= M2 /\ 0 <= Rabs f3 <= M3) /\ 0 <= S /\ 0 <= E /\ 0 < reach.
Proof.
  pose proof (bp_pos (-100)). repeat split; try lra; try apply Rabs_pos; try apply Rmax_l; try apply Rmax_r.
  - rewrite Rabs_pos_eq; lra.
  - unfold S. abs_pos. lra.
  - unfold E, M1, M2, M3. pose proof (Rmax_l (Rabs e1) (Rabs f1)). pose proof (Rmax_l (Rabs e2) (Rabs f2)).
    pose proof (Rmax_l (Rabs e3) (Rabs f3)). abs_pos. lra.
Qed.

(* The computed sum of components is above SHORTEST: E is above 2^-151. *)
Theorem SHORTEST_holds : forall edge, plain tedge edge -> SHORTEST < edge -> bp (-151) <= E.
Proof.
  intros edge H L. destruct pieces as (_ & _ & _ & _ & _ & _ & _ & EP & _). terms. error_of H P. named P.
  fold E in P. small (-150)%Z. unfold SHORTEST in L.
  assert (F : bp (-150) = 2 * bp (-151)) by (change (-150)%Z with (1 + -151)%Z; rewrite bp_add; simpl (bp 1); lra).
  rewrite F in *. pose proof (bp_pos (-151)). apply Rabs_le_inv in P. clearbody E. rewrite u_val in *. lra.
Qed.
(* The computed size is below FARTHEST: no component exceeds 2^301. *)
Theorem FARTHEST_holds : forall x y z v, Rabs x <= bp 1025 -> Rabs y <= bp 1025 -> Rabs z <= bp 1025 ->
  plain (Add (Add (Abs (X x 1025)) (Abs (X y 1025))) (Abs (X z 1025))) v -> v < FARTHEST ->
  Rabs x <= bp 301 /\ Rabs y <= bp 301 /\ Rabs z <= bp 301.
Proof.
  intros x y z v Bx By Bz H L. error_of H P. unfold FARTHEST in L.
  assert (F3 : bp 301 = 2 * bp 300) by (change 301%Z with (1 + 300)%Z; rewrite bp_add, bp_1; ring).
  small 300%Z. abs_pos. apply Rabs_le_inv in P. rewrite F3. 
  pose proof (Rabs_pos x). pose proof (Rabs_pos y). pose proof (Rabs_pos z). rewrite u_val in *. repeat split; lra.
Qed.

(* Sums of terms of a volume, of a height. *)
Lemma sizes : size tsum <= reach * (E * E) /\ size tv <= reach * (S * E) /\ size tw <= reach * (S * E) /\
  size theight <= E * (E * S) /\ size tn1 <= E * E.
Proof.
  destruct pieces as (_ & _ & _ & _ & (X1 & X2 & X3) & (Y1 & Y2 & Y3) & SP & EP & _). terms. cbn [size].
  fold e1 e2 e3 f1 f2 f3 s1 s2 s3.
  assert (D1' : 0 <= Rabs d1 <= reach) by (split; [apply Rabs_pos | assumption]).
  assert (D2' : 0 <= Rabs d2 <= reach) by (split; [apply Rabs_pos | assumption]).
  assert (D3' : 0 <= Rabs d3 <= reach) by (split; [apply Rabs_pos | assumption]).
  assert (S1 : 0 <= Rabs s1 <= Rabs s1) by (split; [apply Rabs_pos | lra]).
  assert (S2 : 0 <= Rabs s2 <= Rabs s2) by (split; [apply Rabs_pos | lra]).
  assert (S3 : 0 <= Rabs s3 <= Rabs s3) by (split; [apply Rabs_pos | lra]).
  unfold E, S. split; [|split; [|split; [|split]]].
  - apply permanent; assumption.
  - apply permanent; assumption.
  - pose proof (permanent _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ S1 S2 S3 D1' D2' D3' X1 X2 X3). lra.
  - set (T := Rabs s1 + Rabs s2 + Rabs s3). assert (0 <= T) by (unfold T; lra).
    assert (Z1 : 0 <= Rabs s1 <= T) by (unfold T; lra). assert (Z2 : 0 <= Rabs s2 <= T) by (unfold T; lra).
    assert (Z3 : 0 <= Rabs s3 <= T) by (unfold T; lra).
    pose proof (permanent _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ Y1 Y2 Y3 Z1 Z2 Z3 X1 X2 X3). lra.
  - pose proof (mul2 _ _ _ _ X2 Y3). pose proof (mul2 _ _ _ _ X3 Y2).
    assert (0 <= M1) by lra. assert (0 <= M2) by lra. assert (0 <= M3) by lra.
    assert (0 <= M1 * M2) by (apply Rmult_le_pos; assumption).
    assert (0 <= M1 * M3) by (apply Rmult_le_pos; assumption).
    pose proof (sq_pos M1). pose proof (sq_pos M2). pose proof (sq_pos M3). nra.
Qed.

(* The bound as computed loses less than 1/200 of itself. *)
Lemma bound_low : forall t z x, plain t z -> bounded t -> (count t <= 20)%nat -> exact t = x -> size t = x ->
  (low t <= -650)%Z -> bp (-530) <= u * x -> (1 - 21 * u) * x <= z.
Proof.
  intros t z x H B N Ex Es L X. pose proof (plain_error t z H B ltac:(lia)) as P. rewrite Ex, Es in P.
  assert (x0 : 0 < x).
  { pose proof (bp_pos (-530)). apply Rmult_lt_reg_l with u; [apply u_pos|]. lra. }
  pose proof (bp_le (low t) (-650)%Z L). pose proof (bp_part (-650) (-530) ltac:(lia)).
  apply le_INR in N. replace (INR 20) with 20 in N by (simpl; lra).
  assert ((INR (count t) + / 1000) * u * x <= (20 + / 1000) * u * x).
  { apply Rmult_le_compat_r; [lra|]. apply Rmult_le_compat_r; [pose proof u_pos|]; lra. }
  apply Rabs_le_inv in P. lra.
Qed.

(* One ray (`filter`), eight rays with a triangle each and eight of one origin (`lanes`): sums of dot products from
  the
   other end, and d . (f x e) for e . (d x f). *)
Ltac order t := exists t; split; [assumption|]; unfold tlane; terms; split; [cbn [bounded]; repeat split;
  assumption|];
  split; [cbn [exact]; ring|]; split; [cbn [size]; ring|]; split; [vm_compute; reflexivity | vm_compute;
    discriminate].
Theorem sums_in_order : forall z, plain tsum z \/ plain (tlane te1 te2 te3 tp1 tp2 tp3) z \/
  plain (tlane td1 td2 td3 (tminor tf2 te3 tf3 te2) (tminor tf3 te1 tf1 te3) (tminor tf1 te2 tf2 te1)) z ->
  in_some_order 7 (-600) tsum z.
Proof.
  intros z H. destruct pieces as (A1 & A2 & A3 & _). destruct H as [H|[H|H]].
  - order tsum.
  - order (tlane te1 te2 te3 tp1 tp2 tp3).
  - order (tlane td1 td2 td3 (tminor tf2 te3 tf3 te2) (tminor tf3 te1 tf1 te3) (tminor tf1 te2 tf2 te1)).
Qed.
Theorem weights_in_order : forall z, plain tv z \/ plain (tlane ts1 ts2 ts3 tp1 tp2 tp3) z \/
  plain (tlane td1 td2 td3 (tminor tf2 ts3 tf3 ts2) (tminor tf3 ts1 tf1 ts3) (tminor tf1 ts2 tf2 ts1)) z ->
  in_some_order 7 (-600) tv z.
Proof.
  intros z H. destruct pieces as (A1 & A2 & A3 & _). destruct H as [H|[H|H]].
  - order tv.
  - order (tlane ts1 ts2 ts3 tp1 tp2 tp3).
  - order (tlane td1 td2 td3 (tminor tf2 ts3 tf3 ts2) (tminor tf3 ts1 tf1 ts3) (tminor tf1 ts2 tf2 ts1)).
Qed.
Theorem others_in_order : forall z, plain tw z \/ plain (tlane td1 td2 td3 tq1 tq2 tq3) z -> in_some_order 7 (-600)
  tw z.
Proof.
  intros z H. destruct pieces as (A1 & A2 & A3 & _). destruct H as [H|H].
  - order tw.
  - order (tlane td1 td2 td3 tq1 tq2 tq3).
Qed.
Theorem heights_in_order : forall z, plain theight z \/ plain (tlane tf1 tf2 tf3 tq1 tq2 tq3) z ->
  in_some_order 8 (-546) theight z.
Proof.
  intros z H. destruct H as [H|H].
  - order theight.
  - order (tlane tf1 tf2 tf3 tq1 tq2 tq3).
Qed.

Section Filter.
(* as computed: the volumes, the bound *)
Variables sum v w error edge : R.
Hypotheses (Hsum : in_some_order 7 (-600) tsum sum) (Hv : in_some_order 7 (-600) tv v) (Hw : in_some_order 7 (-600)
  tw w)
  (Herror : plain terror error)
  (Hedge : plain tedge edge) (Hshort : SHORTEST < edge).

Lemma terror_value : exact terror = ERROR * E * (E + S) * reach /\ size terror = ERROR * E * (E + S) * reach.
Proof.
  destruct pieces as (_ & _ & _ & RP & _ & _ & _ & _ & RR). terms. cbn [exact size]. fold e1 e2 e3 f1 f2 f3 s1 s2 s3.
  rewrite (Rabs_pos_eq ERROR) by (unfold ERROR; rewrite u_val; lra). rewrite (Rabs_pos_eq reach) by lra.
  fold M1 M2 M3. fold E S.
  auto.
Qed.
Lemma error_low : (18 - / 1000) * u * (reach * (E * (E + S))) <= error /\ bp (-460) <= u * (reach * (E * (E + S))).
Proof.
  destruct pieces as (_ & _ & _ & RP & _ & _ & SP & EP & RR). destruct terror_value as [V1 V2].
  pose proof (SHORTEST_holds edge Hedge Hshort) as L.
  assert (EE : bp (-151) * bp (-151) <= E * (E + S)) by (apply Rmult_le_compat; try lra; apply Rlt_le, bp_pos).
  assert (X : bp (-460) <= u * (reach * (E * (E + S)))).
  { apply Rle_trans with (u * (bp (-100) * (bp (-151) * bp (-151)))).
    - unfold u. rewrite <- !bp_add. apply bp_le. lia.
    - apply Rmult_le_compat_l; [apply Rlt_le, u_pos|]. apply Rmult_le_compat; try lra; try (apply Rlt_le, bp_pos).
      rewrite <- bp_add. apply Rlt_le, bp_pos. }
  split; [|exact X].
  assert (Y : (1 - 21 * u) * (ERROR * E * (E + S) * reach) <= error).
  { apply bound_low with (t := terror); auto.
    - terms. cbn [bounded]. repeat split; auto. unfold ERROR. constant.
    - vm_compute. lia.
    - vm_compute. discriminate.
    - replace (u * (ERROR * E * (E + S) * reach)) with (ERROR * (u * (reach * (E * (E + S))))) by ring.
      apply Rle_trans with (u * bp (-460)); [unfold u; rewrite <- bp_add; apply bp_le; lia|]. unfold ERROR.
      pose proof u_pos. pose proof (bp_pos (-460)). apply Rmult_le_compat; lra. }
  eapply Rle_trans; [|exact Y]. unfold ERROR.
  replace ((1 - 21 * u) * (18 * u * E * (E + S) * reach)) with ((18 - 378 * u) * (u * (reach * (E * (E + S))))) by
    ring.
  replace ((18 - / 1000) * u * (reach * (E * (E + S)))) with ((18 - / 1000) * (u * (reach * (E * (E + S))))) by ring.
  apply Rmult_le_compat_r; [pose proof (bp_pos (-460)); lra | rewrite u_val; lra].
Qed.

(* Sum, v and w are within the bound as computed: their signs are certain where they exceed it. *)
Lemma volume_errors : Rabs (sum - Sum) <= (7 + / 500) * u * (reach * (E * E)) + / 1000 * u * (reach * (E * (E +
  S))) /\
  Rabs (v - V) <= (7 + / 500) * u * (reach * (S * E)) + / 1000 * u * (reach * (E * (E + S))) /\
  Rabs (w - W) <= (7 + / 500) * u * (reach * (S * E)) + / 1000 * u * (reach * (E * (E + S))).
Proof.
  destruct pieces as (A1 & A2 & A3 & A4 & _ & _ & SP & EP & RR). destruct sizes as (Z1 & Z2 & Z3 & _).
  destruct error_low as [_ X]. 
  assert (T : forall k, (k <= -600)%Z -> bp k <= / 1000 * u * (reach * (E * (E + S)))).
  { intros k K. pose proof (bp_part k (-460) ltac:(lia)). pose proof (bp_pos (-460)). lra. }
  assert (G : forall t z m, in_some_order 7 (-600) t z -> size t <= m ->
    Rabs (z - exact t) <= (7 + / 500) * u * m + / 1000 * u * (reach * (E * (E + S)))).
  { intros t z m (t' & H & B & Ex & Sz & N & L) M. rewrite <- Ex. rewrite <- Sz in M.
    pose proof (plain_error_at t' z 7 (low t') H B N eq_refl ltac:(lia)) as P.
    pose proof (T _ L). destruct (top_ok t' B). pose proof (Rabs_pos (exact t')).
    assert ((7 + / 1000) * u * size t' <= (7 + / 500) * u * m) by (pose proof u_pos; apply Rmult_le_compat; try lra;
      nra). lra. }
  split; [|split].
  - exact (G tsum sum _ Hsum Z1).
  - exact (G tv v _ Hv Z2).
  - exact (G tw w _ Hw Z3).
Qed.

(* The three volumes and their sum, u = (sum - v) - w rounded twice more, are off by at most 18 u D E (E + S) as
   computed; so a sign is certain where its number exceeds that. *)
Theorem ERROR_holds : F sum -> F v -> F w ->
  Rabs (sum - Sum) <= error /\ Rabs (v - V) <= error /\ Rabs (w - W) <= error /\
  Rabs (RN (RN (sum - v) - w) - (Sum - V - W)) <= error.
Proof.
  intros F1 F2 F3. destruct pieces as (A1 & A2 & A3 & A4 & _ & _ & SP & EP & RR). destruct sizes as (Z1 & Z2 & Z3 &
    _).
  destruct error_low as [L X]. destruct volume_errors as (P1 & P2 & P3).
  pose proof (RN_diff sum v F1 F2) as Q1. pose proof (RN_diff (RN (sum - v)) w (RN_F _) F3) as Q2.
  assert (B1 : Rabs Sum <= reach * (E * E)).
  { eapply Rle_trans; [|exact Z1]. replace Sum with (exact tsum) by (terms; cbn [exact]; reflexivity).
    apply top_ok. terms. cbn [bounded]. repeat split; assumption. }
  assert (B2 : Rabs V <= reach * (S * E)).
  { eapply Rle_trans; [|exact Z2]. replace V with (exact tv) by (terms; cbn [exact]; reflexivity).
    apply top_ok. terms. cbn [bounded]. repeat split; assumption. }
  assert (B3 : Rabs W <= reach * (S * E)).
  { eapply Rle_trans; [|exact Z3]. replace W with (exact tw) by (terms; cbn [exact]; reflexivity).
    apply top_ok. terms. cbn [bounded]. repeat split; assumption. }
  assert (0 <= reach * (E * E)) by (pose proof (Rabs_pos Sum); lra).
  assert (0 <= reach * (S * E)) by (pose proof (Rabs_pos V); lra).
  replace (reach * (E * (E + S))) with (reach * (E * E) + reach * (S * E)) in * by ring.
  set (g := reach * (E * E)) in *. set (h := reach * (S * E)) in *.
  clearbody g h Sum V W. clear - L P1 P2 P3 Q1 Q2 B1 B2 B3 H H0.
  set (m := RN (sum - v)) in *. set (n := RN (m - w)) in *. clearbody m n. rewrite u_val in *.
  assert (Y1 : Rabs (sum - v) <= (1 + / 1000000) * (g + h)).
  { apply Rabs_le_inv in P1. apply Rabs_le_inv in P2. apply Rabs_le_inv in B1. apply Rabs_le_inv in B2.
  apply Rabs_le. lra. }
  assert (Y2 : Rabs (m - w) <= (1 + / 100000) * (g + 2 * h)).
  { assert (H1 : Rabs (m - (sum - v)) <= / 1000000 * (g + h)) by lra. apply Rabs_le_inv in H1.
    apply Rabs_le_inv in P3. apply Rabs_le_inv in B3. apply Rabs_le_inv in Y1. apply Rabs_le. lra. }
  split; [lra|]. split; [lra|]. split; [lra|].
  apply Rabs_le_inv in P1. apply Rabs_le_inv in P2. apply Rabs_le_inv in P3.
  assert (Q1' : Rabs (m - (sum - v)) <= / 9007199254740992 * ((1 + / 1000000) * (g + h))) by lra.
  assert (Q2' : Rabs (n - (m - w)) <= / 9007199254740992 * ((1 + / 100000) * (g + 2 * h))) by lra.
  apply Rabs_le_inv in Q1'. apply Rabs_le_inv in Q2'. apply Rabs_le. lra.
Qed.
End Filter.

(* surely_leans: the sum alone against 18 u E^2 D. *)
Theorem leans : forall sum e edge, plain tsum sum -> plain tleans e -> plain tedge edge -> SHORTEST < edge ->
  Rabs (sum - Sum) <= e.
Proof.
  intros sum e edge Hs He Hedge L. destruct pieces as (A1 & A2 & A3 & A4 & _ & _ & SP & EP & RR).
  destruct sizes as (Z1 & _). pose proof (SHORTEST_holds edge Hedge L) as LE.
  assert (EE : bp (-151) * bp (-151) <= E * E) by (apply Rmult_le_compat; try lra; apply Rlt_le, bp_pos).
  assert (X : bp (-460) <= u * (reach * (E * E))).
  { apply Rle_trans with (u * (bp (-100) * (bp (-151) * bp (-151)))).
    - unfold u. rewrite <- !bp_add. apply bp_le. lia.
    - apply Rmult_le_compat_l; [apply Rlt_le, u_pos|]. apply Rmult_le_compat; try lra; try (apply Rlt_le, bp_pos).
      rewrite <- bp_add. apply Rlt_le, bp_pos. }
  assert (BS : bounded tsum) by (terms; cbn [bounded]; repeat split; assumption).
  pose proof (plain_error_at tsum sum 7 (low tsum) Hs BS eq_refl eq_refl ltac:(lia)) as P.
  assert (LT : bp (low tsum) <= / 1000000000000 * bp (-460)) by (apply bp_part12; vm_compute; discriminate).
  assert (Y : (1 - 21 * u) * (ERROR * E * E * reach) <= e).
  { apply bound_low with (t := tleans); auto.
    - terms. cbn [bounded]. repeat split; auto. unfold ERROR. constant.
    - vm_compute. lia.
    - terms. cbn [size]. fold e1 e2 e3 f1 f2 f3. rewrite (Rabs_pos_eq ERROR) by (unfold ERROR; rewrite u_val; lra).
      rewrite (Rabs_pos_eq reach) by lra. reflexivity.
    - vm_compute. discriminate.
    - replace (u * (ERROR * E * E * reach)) with (ERROR * (u * (reach * (E * E)))) by ring.
      apply Rle_trans with (u * bp (-460)); [unfold u; rewrite <- bp_add; apply bp_le; lia|]. unfold ERROR.
      pose proof u_pos. pose proof (bp_pos (-460)). apply Rmult_le_compat; lra. }
  pose proof (bp_pos (-460)). eapply Rle_trans; [|exact Y]. eapply Rle_trans; [exact P|].
  replace ((1 - 21 * u) * (ERROR * E * E * reach)) with ((1 - 21 * u) * (18 * (u * (reach * (E * E))))) by (unfold
    ERROR; ring).
  assert ((7 + / 1000) * u * size tsum <= (7 + / 1000) * (u * (reach * (E * E)))).
  { rewrite Rmult_assoc. apply Rmult_le_compat_l; [lra|]. apply Rmult_le_compat_l; [apply Rlt_le, u_pos |
    assumption]. }
  set (G := u * (reach * (E * E))) in *. clearbody G. rewrite u_val in *. lra.
Qed.

(* The height against 18 u E^2 (E + S): the spread as computed, times the edge as computed. *)
Theorem height : forall h spread edge,
  in_some_order 8 (-546) theight h -> plain tspread spread -> plain tedge edge -> SHORTEST < edge ->
  Rabs (h - Height) <= RN (spread * edge).
Proof.
  intros h spread edge Hs Hp Hedge L. destruct pieces as (A1 & A2 & A3 & A4 & _ & _ & SP & EP & RR).
  destruct sizes as (_ & _ & _ & Z1 & _). pose proof (SHORTEST_holds edge Hedge L) as LE.
  assert (E2 : bp (-151) * bp (-151) <= E * (E + S)) by (apply Rmult_le_compat; try lra; apply Rlt_le, bp_pos).
  assert (EE : bp (-151) * (bp (-151) * bp (-151)) <= E * (E * (E + S))).
  { apply Rmult_le_compat; try lra; [apply Rlt_le, bp_pos | rewrite <- bp_add; apply Rlt_le, bp_pos]. }
  assert (X : bp (-506) <= u * (E * (E * (E + S)))).
  { apply Rle_trans with (u * (bp (-151) * (bp (-151) * bp (-151)))).
    - unfold u. rewrite <- !bp_add. apply bp_le. lia.
    - apply Rmult_le_compat_l; [apply Rlt_le, u_pos | assumption]. }
  destruct Hs as (t' & Hs & BS & Ex & Sz & N & Lo).
  pose proof (plain_error_at t' h 8 (low t') Hs BS N eq_refl ltac:(lia)) as P. rewrite Ex, Sz in P.
  assert (LT : bp (low t') <= / 1000000000000 * bp (-506)) by (apply bp_part12; lia).
  assert (Y : (1 - 21 * u) * (ERROR * E * (E + S)) <= spread).
  { apply bound_low with (t := tspread); auto.
    - terms. cbn [bounded]. repeat split; auto. unfold ERROR. constant.
    - vm_compute. lia.
    - terms. cbn [size]. fold e1 e2 e3 f1 f2 f3 s1 s2 s3. rewrite (Rabs_pos_eq ERROR) by (unfold ERROR;
      rewrite u_val; lra). reflexivity.
    - vm_compute. discriminate.
    - rewrite Rmult_assoc. apply Rle_trans with (u * (u * (bp (-151) * bp (-151)))).
      + unfold u. rewrite <- !bp_add. apply bp_le. lia.
      + pose proof u_pos. apply Rmult_le_compat_l; [lra|]. apply Rmult_le_compat; try lra.
        rewrite <- bp_add. apply Rlt_le, bp_pos. unfold ERROR. lra. }
  assert (Ye : (1 - 4 * u) * E <= edge).
  { clear - Hedge LE He1 He2 He3 Hf1 Hf2 Hf3. terms. error_of Hedge Q. fold e1 e2 e3 f1 f2 f3 in Q.
  fold M1 M2 M3 in Q. fold E in Q.
    small (-151)%Z. apply Rabs_le_inv in Q. clearbody E. rewrite u_val in *. lra. }
  pose proof (RN_err (spread * edge)) as P2.
  assert (ERE : 0 <= (1 - 21 * u) * (ERROR * E * (E + S))).
  { apply Rmult_le_pos; [rewrite u_val; lra|]. apply Rmult_le_pos; [apply Rmult_le_pos; [unfold ERROR; rewrite u_val;
    lra | lra] | lra]. }
  assert (Y2 : (1 - 26 * u) * (18 * (u * (E * (E * (E + S))))) <= spread * edge).
  { apply Rle_trans with (((1 - 21 * u) * (ERROR * E * (E + S))) * ((1 - 4 * u) * E)).
    - replace ((1 - 21 * u) * (ERROR * E * (E + S)) * ((1 - 4 * u) * E)) with
        ((1 - 21 * u) * (1 - 4 * u) * (18 * (u * (E * (E * (E + S)))))) by (unfold ERROR; ring).
      apply Rmult_le_compat_r; [pose proof (bp_pos (-506)); lra | rewrite u_val; lra].
    - apply Rmult_le_compat; auto. apply Rmult_le_pos; [rewrite u_val; lra | lra]. }
  pose proof (bp_pos (-506)). pose proof (bp_part (-1075) (-506) ltac:(lia)).
  rewrite (Rabs_pos_eq (spread * edge)) in P2 by (rewrite u_val in *; lra).
  assert (Q : Rabs (h - exact theight) <= RN (spread * edge)); [|exact Q].
  eapply Rle_trans; [exact P|]. clear P.
  assert ((8 + / 1000) * u * size theight <= (8 + / 1000) * (u * (E * (E * (E + S))))).
  { rewrite Rmult_assoc. apply Rmult_le_compat_l; [lra|]. apply Rmult_le_compat_l; [apply Rlt_le, u_pos|].
    eapply Rle_trans; [exact Z1|]. apply Rmult_le_compat_l; [assumption|].
    apply Rmult_le_compat_l; [assumption | lra]. }
  set (G := u * (E * (E * (E + S)))) in *. set (r := RN (spread * edge)) in *. set (sp := spread * edge) in *.
  clearbody G r sp.
  apply Rabs_le_inv in P2. rewrite u_val in *. lra.
Qed.

(* A component of the normal against 16 u E^2: where it exceeds that, the triangle has area. *)
Theorem AREA_ERROR_holds : forall n e edge, plain tn1 n -> plain tarea e -> plain tedge edge -> SHORTEST < edge ->
  Rabs (n - n1) <= e /\ (e < Rabs n -> n1 <> 0).
Proof.
  intros n e edge Hs He Hedge L. destruct pieces as (A1 & A2 & A3 & A4 & _ & _ & SP & EP & RR).
  destruct sizes as (_ & _ & _ & _ & Z1). pose proof (SHORTEST_holds edge Hedge L) as LE.
  assert (EE : bp (-151) * bp (-151) <= E * E) by (apply Rmult_le_compat; try lra; apply Rlt_le, bp_pos).
  assert (X : bp (-355) <= u * (E * E)).
  { apply Rle_trans with (u * (bp (-151) * bp (-151))).
    - unfold u. rewrite <- !bp_add. apply bp_le. lia.
    - apply Rmult_le_compat_l; [apply Rlt_le, u_pos | assumption]. }
  assert (BS : bounded tn1) by (terms; cbn [bounded]; repeat split; assumption).
  pose proof (plain_error_at tn1 n 4 (low tn1) Hs BS eq_refl eq_refl ltac:(lia)) as P.
  assert (LT : bp (low tn1) <= / 1000000000000 * bp (-355)) by (apply bp_part12; vm_compute; discriminate).
  assert (BE : bounded tarea) by (terms; cbn [bounded]; repeat split; auto; unfold AREA_ERROR; constant).
  pose proof (plain_error_at tarea e 8 (low tarea) He BE eq_refl eq_refl ltac:(lia)) as P2.
  assert (LT2 : bp (low tarea) <= / 1000000000000 * bp (-408)) by (apply bp_part12; vm_compute; discriminate).
  assert (V2 : exact tarea = 16 * (u * (E * E)) /\ size tarea = 16 * (u * (E * E))).
  { terms. cbn [exact size]. fold e1 e2 e3 f1 f2 f3. rewrite (Rabs_pos_eq AREA_ERROR) by (unfold AREA_ERROR;
    rewrite u_val; lra).
    fold M1 M2 M3. fold E. unfold AREA_ERROR. split; ring. }
  destruct V2 as [V2 V3]. rewrite V2, V3 in P2. assert (bp (-408) <= bp (-355)) by (apply bp_le; lia).
  pose proof (bp_pos (-355)). assert (Q : Rabs (n - exact tn1) <= e).
  { eapply Rle_trans; [exact P|]. clear P.
    assert ((4 + / 1000) * u * size tn1 <= (4 + / 1000) * (u * (E * E))).
    { rewrite Rmult_assoc. apply Rmult_le_compat_l; [lra|]. apply Rmult_le_compat_l;
      [apply Rlt_le, u_pos | assumption]. }
    set (G := u * (E * E)) in *. clearbody G. apply Rabs_le_inv in P2. rewrite u_val in *. lra. }
  change (exact tn1) with n1 in Q. split; [exact Q|]. intros Hn N0. rewrite N0 in Q. rewrite Rminus_0_r in Q. lra.
Qed.

(* `slope_sign`: the sum again, with the products in another order; the bound is that of `surely_leans`. *)
Definition tslope := let n x2 y3 x3 y2 := tminor x2 y3 x3 y2 in
  tdot (n td2 te3 td3 te2) (n td3 te1 td1 te3) (n td1 te2 td2 te1) tf1 tf2 tf3.
Theorem PLANE_ERROR_holds : forall slope e edge, plain tslope slope -> plain tleans e -> plain tedge edge -> SHORTEST
  < edge ->
  Rabs (slope - exact tslope) <= e /\ (slope > e -> 0 < exact tslope) /\ (slope < - e -> exact tslope < 0).
Proof.
  intros slope e edge Hs He Hedge L. destruct pieces as (A1 & A2 & A3 & A4 & (X1 & X2 & X3) & (Y1 & Y2 & Y3) & SP & EP
    & RR).
  pose proof (SHORTEST_holds edge Hedge L) as LE.
  assert (EE : bp (-151) * bp (-151) <= E * E) by (apply Rmult_le_compat; try lra; apply Rlt_le, bp_pos).
  assert (X : bp (-460) <= u * (reach * (E * E))).
  { apply Rle_trans with (u * (bp (-100) * (bp (-151) * bp (-151)))).
    - unfold u. rewrite <- !bp_add. apply bp_le. lia.
    - apply Rmult_le_compat_l; [apply Rlt_le, u_pos|]. apply Rmult_le_compat; try lra; try (apply Rlt_le, bp_pos).
      rewrite <- bp_add. apply Rlt_le, bp_pos. }
  assert (BS : bounded tslope) by (unfold tslope; terms; cbn [bounded]; repeat split; assumption).
  assert (Z1 : size tslope <= reach * (E * E)).
  { unfold tslope. terms. cbn [size]. fold e1 e2 e3 f1 f2 f3.
    assert (D1' : 0 <= Rabs d1 <= reach) by (split; [apply Rabs_pos | assumption]).
    assert (D2' : 0 <= Rabs d2 <= reach) by (split; [apply Rabs_pos | assumption]).
    assert (D3' : 0 <= Rabs d3 <= reach) by (split; [apply Rabs_pos | assumption]).
    pose proof (permanent _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ Y1 Y2 Y3 D1' D2' D3' X1 X2 X3). unfold E. lra. }
  pose proof (plain_error_at tslope slope 7 (low tslope) Hs BS eq_refl eq_refl ltac:(lia)) as Q.
  assert (LT : bp (low tslope) <= / 1000000000000 * bp (-460)) by (apply bp_part12; vm_compute; discriminate).
  assert (Y : (1 - 21 * u) * (ERROR * E * E * reach) <= e).
  { apply bound_low with (t := tleans); auto.
    - terms. cbn [bounded]. repeat split; auto. unfold ERROR. constant.
    - vm_compute. lia.
    - terms. cbn [size]. fold e1 e2 e3 f1 f2 f3. rewrite (Rabs_pos_eq ERROR) by (unfold ERROR; rewrite u_val; lra).
      rewrite (Rabs_pos_eq reach) by lra. reflexivity.
    - vm_compute. discriminate.
    - replace (u * (ERROR * E * E * reach)) with (ERROR * (u * (reach * (E * E)))) by ring.
      apply Rle_trans with (u * bp (-460)); [unfold u; rewrite <- bp_add; apply bp_le; lia|]. unfold ERROR.
      pose proof u_pos. pose proof (bp_pos (-460)). apply Rmult_le_compat; lra. }
  assert (R : Rabs (slope - exact tslope) <= e); [|split; [exact R | now apply certain_sign]].
  pose proof (bp_pos (-460)). eapply Rle_trans; [|exact Y]. eapply Rle_trans; [exact Q|].
  replace ((1 - 21 * u) * (ERROR * E * E * reach)) with ((1 - 21 * u) * (18 * (u * (reach * (E * E))))) by (unfold
    ERROR; ring).
  assert ((7 + / 1000) * u * size tslope <= (7 + / 1000) * (u * (reach * (E * E)))).
  { rewrite Rmult_assoc. apply Rmult_le_compat_l; [lra|]. apply Rmult_le_compat_l; [apply Rlt_le, u_pos |
    assumption]. }
  set (G := u * (reach * (E * E))) in *. clearbody G. rewrite u_val in *. lra.
Qed.
End Triangle.

(* `height_sign`: n . (a - o) for edges and a - o with E S < 2^300;
  the bound 18 u E (E S) + 2^-500, with E and S within four
   roundings and its own roundings. *)
Section Height.
Variables a1 a2 a3 b1 b2 b3 c1 c2 c3 o1 o2 o3 E S : R.
Let e1 := b1 - a1. Let e2 := b2 - a2. Let e3 := b3 - a3. Let f1 := c1 - a1. Let f2 := c2 - a2. Let f3 := c3 - a3.
Let s1 := a1 - o1. Let s2 := a2 - o2. Let s3 := a3 - o3.
Hypotheses (E0 : 0 <= E) (S0 : 0 <= S) (Hm : Rmax (Rabs e1) (Rabs f1) + Rmax (Rabs e2) (Rabs f2) + Rmax (Rabs e3)
  (Rabs f3) <= E)
  (Hs : Rabs s1 + Rabs s2 + Rabs s3 <= S).
Hypotheses (He1 : Rabs e1 <= bp 301) (He2 : Rabs e2 <= bp 301) (He3 : Rabs e3 <= bp 301)
  (Hf1 : Rabs f1 <= bp 301) (Hf2 : Rabs f2 <= bp 301) (Hf3 : Rabs f3 <= bp 301)
  (Hs1 : Rabs s1 <= bp 452) (Hs2 : Rabs s2 <= bp 452) (Hs3 : Rabs s3 <= bp 452).
Definition theight_of_plane :=
  let e x y := D x y 301 in
  tdot (tminor (e b2 a2) (e c3 a3) (e b3 a3) (e c2 a2)) (tminor (e b3 a3) (e c1 a1) (e b1 a1) (e c3 a3))
    (tminor (e b1 a1) (e c2 a2) (e b2 a2) (e c1 a1)) (D a1 o1 452) (D a2 o2 452) (D a3 o3 452).
Theorem UNDERFLOW_holds : forall h e, plain theight_of_plane h ->
  (1 - 32 * u) * (PLANE_ERROR * (E * (E * S)) + UNDERFLOW) <= e ->
  (h > e -> 0 < exact theight_of_plane) /\ (h < - e -> exact theight_of_plane < 0).
Proof.
  intros h e Hh He. apply certain_sign.
  assert (B : bounded theight_of_plane) by (unfold theight_of_plane, tdot, tminor; cbn [bounded]; repeat split;
    assumption).
  pose proof (plain_error_at _ h 8 (low theight_of_plane) Hh B eq_refl eq_refl ltac:(lia)) as Q.
  assert (LT : bp (low theight_of_plane) <= / 1000000000000 * UNDERFLOW) by (apply bp_part12; vm_compute;
    discriminate).
  assert (U0 : 0 < UNDERFLOW) by apply bp_pos.
  assert (Z : size theight_of_plane <= E * (E * S)).
  { unfold theight_of_plane, tdot, tminor. cbn [size]. fold e1 e2 e3 f1 f2 f3 s1 s2 s3.
    assert (X1 : 0 <= Rabs e1 <= Rmax (Rabs e1) (Rabs f1)) by (split; [apply Rabs_pos | apply Rmax_l]).
    assert (X2 : 0 <= Rabs e2 <= Rmax (Rabs e2) (Rabs f2)) by (split; [apply Rabs_pos | apply Rmax_l]).
    assert (X3 : 0 <= Rabs e3 <= Rmax (Rabs e3) (Rabs f3)) by (split; [apply Rabs_pos | apply Rmax_l]).
    assert (Y1 : 0 <= Rabs f1 <= Rmax (Rabs e1) (Rabs f1)) by (split; [apply Rabs_pos | apply Rmax_r]).
    assert (Y2 : 0 <= Rabs f2 <= Rmax (Rabs e2) (Rabs f2)) by (split; [apply Rabs_pos | apply Rmax_r]).
    assert (Y3 : 0 <= Rabs f3 <= Rmax (Rabs e3) (Rabs f3)) by (split; [apply Rabs_pos | apply Rmax_r]).
    pose proof (Rabs_pos s1). pose proof (Rabs_pos s2). pose proof (Rabs_pos s3).
    assert (Z1 : 0 <= Rabs s1 <= S) by lra. assert (Z2 : 0 <= Rabs s2 <= S) by lra.
    assert (Z3 : 0 <= Rabs s3 <= S) by lra.
    pose proof (permanent _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ _ X1 X2 X3 Z1 Z2 Z3 Y1 Y2 Y3) as K.
    set (m1 := Rmax (Rabs e1) (Rabs f1)) in *. set (m2 := Rmax (Rabs e2) (Rabs f2)) in *.
    set (m3 := Rmax (Rabs e3) (Rabs f3)) in *.
    assert (S * ((m1 + m2 + m3) * (m1 + m2 + m3)) <= S * (E * E)) by (apply Rmult_le_compat_l; [assumption|];
      apply Rmult_le_compat; lra).
    lra. }
  assert (G0 : 0 <= E * (E * S)) by (repeat apply Rmult_le_pos; assumption).
  eapply Rle_trans; [exact Q|]. unfold PLANE_ERROR in He. set (T := size _) in *. set (G := E * (E * S)) in *.
  clearbody T G.
  rewrite u_val in *. lra.
Qed.
End Height.
