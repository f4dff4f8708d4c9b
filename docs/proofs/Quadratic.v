(* rt-math, quadratic.rs: the number of roots in doubles. *)
From Proofs Require Import Rounding.
Open Scope R_scope.

(* The filter decides if |D| exceeds this part of b^2 ... *)
Definition CANCELLATION := bp (-20).
(* ... and lies between this and its inverse. *)
Definition D_FLOOR := bp (-900).

(* d = b^2 - 4ac as computed, the product fused or not: where it exceeds both, it is D within 2^-31.9 of itself. *)
Theorem CANCELLATION_holds : forall a b c p d,
  p = RN (b * b) ->
  d = RN (4 * a * - c + p) \/ d = RN (RN (4 * a * - c) + p) ->
  RN (CANCELLATION * p) < Rabs d -> D_FLOOR < Rabs d ->
  Rabs (d - (b * b - 4 * a * c)) <= / 4000000000 * Rabs d.
Proof.
  intros a b c p d Hp Hd L1 L2. pose proof (RN_err (b * b)) as E1. rewrite <- Hp in E1.
  set (B := b * b) in *. assert (B0 : 0 <= B) by apply sq_pos. rewrite (Rabs_pos_eq B) in E1 by assumption.
  set (q := 4 * a * - c) in *. replace (B - 4 * a * c) with (B + q) by (unfold q; ring).
  assert (E2 : exists q', Rabs (q' - q) <= u * Rabs q + bp (-1075) /\ d = RN (q' + p)).
  { destruct Hd as [Hd|Hd].
    - exists q. split; [|exact Hd]. replace (q - q) with 0 by ring. rewrite Rabs_R0. pose proof (bp_pos (-1075)).
      pose proof u_pos. pose proof (Rabs_pos q). nra.
    - exists (RN q). split; [apply RN_err | exact Hd]. }
  destruct E2 as (q' & E2 & Hd'). pose proof (RN_back (q' + p)) as E3. rewrite <- Hd' in E3.
  pose proof (RN_err (CANCELLATION * p)) as E4. set (k := RN (CANCELLATION * p)) in *. unfold D_FLOOR in L2.
  small (-900)%Z. set (T := bp (-900)) in *. set (W := Rabs d) in *.
  apply Rabs_le_inv in E1.
  assert (P0 : - (/ 1000000000000000000000000000 * T) <= p) by (rewrite u_val in *; lra).
  assert (CV : CANCELLATION = / 1048576) by (unfold CANCELLATION; simpl; lra). rewrite CV in E4.
  assert (PB : p <= 1048577 * W).
  { destruct (Rle_or_lt 0 p) as [Z|Z]; [|lra]. rewrite (Rabs_pos_eq (/ 1048576 * p)) in E4 by lra.
  apply Rabs_le_inv in E4.
    rewrite u_val in *. lra. }
  assert (BW : B <= 1048578 * W) by (rewrite u_val in *; lra).
  assert (QW : Rabs q <= 1048580 * W).
  { assert (Rabs (q' + p) <= 2 * W).
    { pose proof (Rabs_triang d (- (d - (q' + p)))) as Y. replace (d + - (d - (q' + p))) with (q' + p) in Y by ring.
      rewrite Rabs_Ropp in Y. fold W in Y. rewrite u_val in *. lra. }
    pose proof (Rabs_triang (q' + p) (- (q' - q) + - p)) as Y.
    replace (q' + p + (- (q' - q) + - p)) with q in Y by ring.
    pose proof (Rabs_triang (- (q' - q)) (- p)) as Y2. rewrite !Rabs_Ropp in Y2.
    assert (Rabs p <= 1048577 * W) by (apply Rabs_le; lra). rewrite u_val in *. lra. }
  replace (d - (B + q)) with ((d - (q' + p)) + (q' - q) + (p - B)) by ring.
  eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|].
  assert (Rabs (p - B) <= u * B + / 1000000000000000000000000000000 * T) by (apply Rabs_le; lra).
  rewrite u_val in *. lra.
Qed.
(* So the sign of d is that of D, and D is not zero. *)
Theorem D_FLOOR_holds : forall a b c p d,
  p = RN (b * b) -> d = RN (4 * a * - c + p) \/ d = RN (RN (4 * a * - c) + p) ->
  RN (CANCELLATION * p) < Rabs d -> D_FLOOR < Rabs d ->
  (0 < d -> 0 < b * b - 4 * a * c) /\ (d < 0 -> b * b - 4 * a * c < 0).
Proof.
  intros a b c p d Hp Hd L1 L2. pose proof (CANCELLATION_holds a b c p d Hp Hd L1 L2) as H. apply Rabs_le_inv in H.
  split; intro S; [rewrite (Rabs_pos_eq d) in H by lra | rewrite (Rabs_left d) in H by lra]; lra.
Qed.
