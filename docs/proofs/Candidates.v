(* rt-geom, sphere/finish.rs: the bounds of a root in doubles, `approximation`. *)
From Proofs Require Import Rounding.
Open Scope R_scope.

(* The error of a root and of the rounding when it is added or subtracted, relative to E / (sqrt delta d.d). *)
Definition CANDIDATE := 16 / 10.

Section Candidate.
(* |d|, |w|, r; delta and E as computed, with their bounds; y and Y the roots of delta and Delta. Sphere.v has what
   follows for one ray and for eight: `roots_are_bounded`. *)
Variables d w r A Q delta Delta ef : R.
Hypotheses (d0 : 0 < d) (w0 : 0 <= w) (r0 : 0 < r) (HA : A = d * d) (HQ : Q = w * w + r * r).
Hypotheses (Hdelta : Rabs (delta - Delta) <= 127 / 10 * u * (A * Q)) (Hef : (17 - / 100) * u * (A * Q) <= ef)
  (Hsure : ef < delta) (Htop : sqrt delta <= (1 + 10 * u) * (d * r)).
Let y := sqrt delta. Let Y := sqrt Delta.
(* b, the root, the numerator n of either sign, the reciprocal of d.d, and t, as computed *)
Variables B b root n inverse t error sign : R.
Hypotheses (HB : Rabs B <= d * w) (Hb : Rabs (b - B) <= (4 + / 100) * u * (d * w) + / 100 * (u * y))
  (Hroot : Rabs (root - y) <= u * y)
  (Hsign : sign = 1 \/ sign = - 1) (Hn : Rabs (n - (- b + sign * root)) <= u * Rabs (- b + sign * root))
  (Hinverse : Rabs (inverse * A - 1) <= (4 + / 10) * u).
Hypotheses (Ht : Rabs (t - n * inverse) <= u * Rabs (n * inverse) + bp (-1075)) (Hsmall : bp (-1075) * A * y <= / 100
  * (u * (A * Q)))
  (Herror : (1 - 32 * u) * (CANDIDATE * ef) <= error * (A * y)).

(* The exact root lies between the rounded ends, so its rounding does as well. *)
Theorem CANDIDATE_holds : F t -> F error -> RN (t - error) <= (- B + sign * Y) / A <= RN (t + error).
Proof.
  intros Ft Fe. assert (A0 : 0 < A) by (rewrite HA; now apply Rmult_lt_0_compat).
  assert (Q0 : 0 < Q) by (rewrite HQ; pose proof (sq_pos w); pose proof (Rmult_lt_0_compat r r r0 r0); lra).
  assert (AQ : 0 < A * Q) by now apply Rmult_lt_0_compat. pose proof u_pos.
  assert (E0 : 0 < ef) by (rewrite u_val in *; lra). assert (D0 : 0 < delta) by lra.
  assert (y0 : 0 < y) by (apply sqrt_lt_R0; assumption). assert (YY : y * y = delta) by (apply sqrt_sqrt; lra).
  pose proof Hdelta as Hd'. apply Rabs_le_inv in Hd'. assert (DD : 0 < Delta) by (rewrite u_val in *; lra).
  assert (Y0 : 0 < Y) by (apply sqrt_lt_R0; assumption). assert (YY' : Y * Y = Delta) by (apply sqrt_sqrt; lra).
  (* the unit: g = u A Q / y *)
  set (g := u * (A * Q) / y). assert (gy : g * y = u * (A * Q)) by (unfold g; field; lra).
  assert (g0 : 0 < g) by (unfold g; apply Rmult_lt_0_compat; [apply Rmult_lt_0_compat;
    assumption | now apply Rinv_0_lt_compat]).
  assert (U : forall x k, x * y <= k * (u * (A * Q)) -> x <= k * g).
  { intros x k Hx. apply Rmult_le_reg_r with y; [assumption|]. replace (k * g * y) with (k * (g * y)) by ring.
  now rewrite gy. }
  assert (C1 : Rabs (y - Y) <= 127 / 10 * g).
  { apply U. apply Rle_trans with (Rabs (y - Y) * (y + Y)); [apply Rmult_le_compat_l; [apply Rabs_pos | lra]|].
    rewrite <- (Rabs_pos_eq (y + Y)) by lra. rewrite <- Rabs_mult.
    replace ((y - Y) * (y + Y)) with (delta - Delta) by (rewrite <- YY, <- YY'; ring).
    lra. }
  fold y in Htop.
  assert (W1 : u * (d * w) <= (5001 / 10000) * g).
  { apply U. apply Rle_trans with (u * (d * w) * ((1 + 10 * u) * (d * r))).
    - apply Rmult_le_compat_l; [apply Rmult_le_pos; [lra | apply Rmult_le_pos; lra] | exact Htop].
    - replace (u * (d * w) * ((1 + 10 * u) * (d * r))) with (u * ((1 + 10 * u) * (A * (w * r)))) by (rewrite HA; ring).
      replace (5001 / 10000 * (u * (A * Q))) with (u * (A * (5001 / 10000 * Q))) by ring.
      apply Rmult_le_compat_l; [lra|].
      replace ((1 + 10 * u) * (A * (w * r))) with (A * ((1 + 10 * u) * (w * r))) by ring.
      apply Rmult_le_compat_l; [lra|].
      rewrite HQ. pose proof (sq_pos (w - r)). assert (0 <= w * r) by (apply Rmult_le_pos; lra). rewrite u_val. lra. }
  assert (W2 : u * (d * w + y) <= (12073 / 10000) * g).
  { apply U. apply Rle_trans with (u * ((d * w + (1 + 10 * u) * (d * r)) * ((1 + 10 * u) * (d * r)))).
    - rewrite Rmult_assoc. apply Rmult_le_compat_l; [lra|]. assert (0 <= d * w) by (apply Rmult_le_pos; lra).
      apply Rmult_le_compat; lra.
    - replace (u * ((d * w + (1 + 10 * u) * (d * r)) * ((1 + 10 * u) * (d * r)))) with
        (u * (A * ((1 + 10 * u) * (w * r) + (1 + 10 * u) * (1 + 10 * u) * (r * r)))) by (rewrite HA; ring).
      replace (12073 / 10000 * (u * (A * Q))) with (u * (A * (12073 / 10000 * Q))) by ring.
      apply Rmult_le_compat_l; [lra|]. apply Rmult_le_compat_l; [lra|]. rewrite HQ.
      pose proof (sq_pos (w - 4142 / 10000 * r)). pose proof (sq_pos w). pose proof (sq_pos r).
      assert (0 <= w * r) by (apply Rmult_le_pos; lra).
      rewrite u_val. lra. }
  assert (E1 : (27 + / 10) * g <= error * A).
  { apply Rmult_le_reg_r with y; [assumption|]. replace ((27 + / 10) * g * y) with ((27 + / 10) * (g * y)) by ring.
  rewrite gy.
    replace (error * A * y) with (error * (A * y)) by ring. eapply Rle_trans; [|exact Herror]. unfold CANDIDATE.
    set (G := A * Q) in *. clearbody G. rewrite u_val in *. lra. }
  assert (T0 : bp (-1075) * A <= / 100 * g) by (apply U; lra).
  (* everything times A *)
  set (z := d * w + y) in *. assert (z0 : 0 < z) by (unfold z; pose proof (Rmult_le_pos d w ltac:(lra) w0); lra).
  assert (dw0 : 0 <= d * w) by (apply Rmult_le_pos; lra).
  assert (N1 : Rabs (- b + sign * root - (- B + sign * Y)) <= 127 / 10 * g + (4 + / 100) * (5001 / 10000 * g)
    + (1 + / 100) * (u * z)).
  { assert (R1 : Rabs (root - Y) <= u * y + 127 / 10 * g).
    { replace (root - Y) with ((root - y) + (y - Y)) by ring. eapply Rle_trans; [apply Rabs_triang|]. lra. }
    assert (u * y <= u * z) by (apply Rmult_le_compat_l; unfold z; lra).
    apply Rabs_le_inv in R1. apply Rabs_le_inv in Hb. apply Rabs_le. destruct Hsign as [S|S]; rewrite S; lra. }
  assert (N2 : Rabs (- b + sign * root) <= (1 + 8 * u) * z).
  { assert (Rabs root <= (1 + u) * y) by (replace root with ((root - y) + y) by ring; eapply Rle_trans;
    [apply Rabs_triang|]; rewrite (Rabs_pos_eq y) by lra; lra).
    assert (Rabs b <= (1 + 5 * u) * (d * w) + u * y).
    { replace b with ((b - B) + B) by ring. eapply Rle_trans; [apply Rabs_triang|]. rewrite u_val in *. lra. }
    assert (Rabs (sign * root) = Rabs root) by (destruct Hsign as [S|S]; rewrite S, ?Rmult_1_l;
      [reflexivity | replace (-1 * root) with (- root) by ring; apply Rabs_Ropp]).
    eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp, H2. unfold z. rewrite u_val in *. lra. }
  assert (N3 : Rabs (n - (- b + sign * root)) <= (1 + / 1000) * (u * z)) by (rewrite u_val in *; lra).
  assert (N4 : Rabs n <= (1 + 10 * u) * z).
  { replace n with ((n - (- b + sign * root)) + (- b + sign * root)) by ring. eapply Rle_trans; [apply Rabs_triang|].
  rewrite u_val in *. lra. }
  assert (N5 : Rabs (n * inverse * A - n) <= (4 + / 9) * (u * z)).
  { replace (n * inverse * A - n) with (n * (inverse * A - 1)) by ring. rewrite Rabs_mult.
    apply Rle_trans with (((1 + 10 * u) * z) * ((4 + / 10) * u)); [apply Rmult_le_compat; auto using Rabs_pos|].
    rewrite u_val. lra. }
  assert (N6 : Rabs (n * inverse * A) <= (1 + 20 * u) * z).
  { replace (n * inverse * A) with ((n * inverse * A - n) + n) by ring. eapply Rle_trans; [apply Rabs_triang|].
  rewrite u_val in *. lra. }
  assert (N7 : Rabs (t * A - n * inverse * A) <= (1 + / 1000) * (u * z) + / 100 * g).
  { replace (t * A - n * inverse * A) with ((t - n * inverse) * A) by ring. rewrite Rabs_mult, (Rabs_pos_eq A) by lra.
    apply Rle_trans with ((u * Rabs (n * inverse) + bp (-1075)) * A); [apply Rmult_le_compat_r; lra|].
    rewrite Rmult_plus_distr_r. rewrite Rmult_assoc. replace (Rabs (n * inverse) * A) with (Rabs (n * inverse * A)) by
      (rewrite Rabs_mult, (Rabs_pos_eq A); lra).
    rewrite u_val in *. lra. }
  assert (TA : Rabs (t * A) <= (1 + 30 * u) * z + / 100 * g).
  { replace (t * A) with ((t * A - n * inverse * A) + n * inverse * A) by ring.
  eapply Rle_trans; [apply Rabs_triang|]. rewrite u_val in *. lra. }
  assert (ER : Rabs (t * A - (- B + sign * Y)) <= (234 / 10) * g).
  { apply Rabs_le_inv in N1. apply Rabs_le_inv in N3. apply Rabs_le_inv in N5. apply Rabs_le_inv in N7.
  apply Rabs_le. lra. }
  assert (EA : 0 < error * A) by lra.
  assert (e0 : 0 < error) by (apply Rmult_lt_reg_r with A; [assumption | lra]).
  assert (LO : Rabs ((RN (t - error) - (t - error)) * A) <= u * ((1 + 30 * u) * z + / 100 * g + error * A)).
  { rewrite Rabs_mult, (Rabs_pos_eq A) by lra. pose proof (RN_diff t error Ft Fe) as P.
    apply Rle_trans with (u * Rabs (t - error) * A); [apply Rmult_le_compat_r; lra|]. rewrite Rmult_assoc.
    apply Rmult_le_compat_l; [lra|].
    rewrite <- (Rabs_pos_eq A) at 1 by lra. rewrite <- Rabs_mult.
    replace ((t - error) * A) with (t * A + - (error * A)) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp, (Rabs_pos_eq (error * A)) by lra. lra. }
  assert (HI : Rabs ((RN (t + error) - (t + error)) * A) <= u * ((1 + 30 * u) * z + / 100 * g + error * A)).
  { rewrite Rabs_mult, (Rabs_pos_eq A) by lra. pose proof (RN_sum t error Ft Fe) as P.
    apply Rle_trans with (u * Rabs (t + error) * A); [apply Rmult_le_compat_r; lra|]. rewrite Rmult_assoc.
    apply Rmult_le_compat_l; [lra|].
    rewrite <- (Rabs_pos_eq A) at 1 by lra. rewrite <- Rabs_mult.
    replace ((t + error) * A) with (t * A + error * A) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite (Rabs_pos_eq (error * A)) by lra. lra. }
  apply Rabs_le_inv in ER. apply Rabs_le_inv in LO. apply Rabs_le_inv in HI.
  set (lo := RN (t - error)) in *. set (hi := RN (t + error)) in *. set (X := - B + sign * Y) in *.
  set (eA := error * A) in *.
  assert (L1 : lo * A <= X) by (replace (lo * A) with ((lo - (t - error)) * A + (t * A - eA)) by (unfold eA; ring);
    rewrite u_val in *; lra).
  assert (L2 : X <= hi * A) by (replace (hi * A) with ((hi - (t + error)) * A + (t * A + eA)) by (unfold eA; ring);
    rewrite u_val in *; lra).
  split; apply Rmult_le_reg_r with A; try assumption; unfold Rdiv; rewrite Rmult_assoc, Rinv_l by lra; lra.
Qed.
End Candidate.

(* rt-geom, triangle/finish.rs, `bounds`: height and sum as computed, off by at most 0.446 E s and 0.39 D s with the
   spread s (Triangle.v: 8.01 u E^2 S and 7.01 u D E^2 of an s of at least 17.99 u E (E + S)), on a hit, where the sum
   exceeds 2.9 D s. *)
Section TriangleBounds.
Variables h Height sum Sum E s reach inverse t error : R.
Hypotheses (E0 : 0 < E) (s0 : 0 < s) (reach0 : 0 < reach)
  (Hh : Rabs (h - Height) <= 446 / 1000 * (E * s)) (Hs : Rabs (sum - Sum) <= 39 / 100 * (s * reach))
  (Hhit : 29 / 10 * (s * reach) <= sum) (Hsteep : 17 * u * sum <= s * reach)
  (Hinverse : Rabs (inverse * sum - 1) <= (1 + / 100) * u)
  (Ht : Rabs (t - h * inverse) <= u * Rabs (h * inverse) + bp (-1075)) (Hsmall : bp (-1075) * sum <= / 1000000 * (E *
    s))
  (Herror : (1 - 32 * u) * (s * (E + Rabs t * reach)) <= error * sum).
Theorem triangle_bounds : F t -> F error -> RN (t - error) <= Height / Sum <= RN (t + error).
Proof.
  intros Ft Fe. pose proof u_pos. assert (sr : 0 < s * reach) by now apply Rmult_lt_0_compat.
  assert (Es : 0 < E * s) by now apply Rmult_lt_0_compat. assert (sum0 : 0 < sum) by lra.
  pose proof Hs as Hs'. apply Rabs_le_inv in Hs'. assert (Sum0 : 865 / 1000 * sum <= Sum) by lra.
  assert (S0 : 0 < Sum) by lra.
  (* units: k = s / sum; everything times sum *)
  set (tau := h / sum). assert (HT : tau * sum = h) by (unfold tau; field; lra).
  set (m := Rabs tau). assert (m0 : 0 <= m) by apply Rabs_pos. set (q := m * (s * reach)).
  assert (q0 : 0 <= q) by (apply Rmult_le_pos; lra).
  assert (uq : 17 * (u * (m * sum)) <= q).
  { unfold q. replace (17 * (u * (m * sum))) with (m * (17 * u * sum)) by ring. apply Rmult_le_compat_l; lra. }
  set (um := u * (m * sum)) in *. assert (um0 : 0 <= um) by (unfold um; apply Rmult_le_pos;
    [lra | apply Rmult_le_pos; lra]).
  (* t against tau *)
  assert (T1 : Rabs (h * inverse * sum - tau * sum) <= (1 + / 100) * um).
  { replace (h * inverse * sum - tau * sum) with (h * (inverse * sum - 1)) by (rewrite HT; ring). rewrite Rabs_mult.
    replace ((1 + / 100) * um) with ((m * sum) * ((1 + / 100) * u)) by (unfold um; ring).
    apply Rmult_le_compat; auto using Rabs_pos. rewrite <- HT, Rabs_mult, (Rabs_pos_eq sum) by lra. fold m. lra. }
  assert (MS : Rabs (tau * sum) = m * sum) by (rewrite Rabs_mult, (Rabs_pos_eq sum); [reflexivity | lra]).
  assert (T2 : Rabs (h * inverse * sum) <= (1 + 2 * u) * (m * sum)).
  { replace (h * inverse * sum) with ((h * inverse * sum - tau * sum) + tau * sum) by ring.
  eapply Rle_trans; [apply Rabs_triang|].
    rewrite MS. unfold um in T1. assert (0 <= m * sum) by (apply Rmult_le_pos; lra). set (M := m * sum) in *.
    clearbody M. rewrite u_val in *. lra. }
  assert (T3 : Rabs (t * sum - h * inverse * sum) <= (1 + / 100) * um + / 1000000 * (E * s)).
  { replace (t * sum - h * inverse * sum) with ((t - h * inverse) * sum) by ring.
  rewrite Rabs_mult, (Rabs_pos_eq sum) by lra.
    apply Rle_trans with ((u * Rabs (h * inverse) + bp (-1075)) * sum); [apply Rmult_le_compat_r; lra|].
    rewrite Rmult_plus_distr_r, Rmult_assoc.
    replace (Rabs (h * inverse) * sum) with (Rabs (h * inverse * sum)) by (rewrite Rabs_mult, (Rabs_pos_eq sum); lra).
    assert (u * Rabs (h * inverse * sum) <= (1 + / 100) * um).
    { apply Rle_trans with (u * ((1 + 2 * u) * (m * sum))); [apply Rmult_le_compat_l; lra|]. unfold um.
      assert (0 <= m * sum) by (apply Rmult_le_pos; lra). set (M := m * sum) in *. clearbody M. rewrite u_val. lra. }
    lra. }
  assert (T4 : Rabs (t * sum - tau * sum) <= (2 + / 50) * um + / 1000000 * (E * s)).
  { replace (t * sum - tau * sum) with ((t * sum - h * inverse * sum) + (h * inverse * sum - tau * sum)) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. lra. }
  (* tau against the exact quotient *)
  set (X := Height / Sum). assert (HX : X * Sum = Height) by (unfold X; field; lra).
  assert (T5 : Rabs (X * sum - tau * sum) <= 5157 / 10000 * (E * s) + 451 / 1000 * q).
  { assert (P : Rabs ((X - tau) * Sum) <= 446 / 1000 * (E * s) + 39 / 100 * q).
    { replace ((X - tau) * Sum) with ((Height - h) + tau * (sum - Sum)) by (rewrite Rmult_minus_distr_r, HX,
      Rmult_minus_distr_l, HT; ring).
      eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_minus_sym, Rabs_mult. fold m.
      assert (m * Rabs (sum - Sum) <= m * (39 / 100 * (s * reach))) by (apply Rmult_le_compat_l; assumption).
      unfold q. lra. }
    rewrite Rabs_mult, (Rabs_pos_eq Sum) in P by lra.
    replace (X * sum - tau * sum) with ((X - tau) * sum) by ring. rewrite Rabs_mult, (Rabs_pos_eq sum) by lra.
    assert (Rabs (X - tau) * (865 / 1000 * sum) <= Rabs (X - tau) * Sum) by (apply Rmult_le_compat_l;
      [apply Rabs_pos | assumption]).
    set (R0 := Rabs (X - tau) * sum). assert (865 / 1000 * R0 <= 446 / 1000 * (E * s) + 39 / 100 * q) by (unfold R0;
      lra). lra. }
  (* the error as computed *)
  assert (TS : (1 - / 1000000) * q - / 1000000 * (E * s) <= Rabs t * (s * reach)).
  { pose proof (Rabs_triang (t * sum) (- (t * sum - tau * sum))) as P.
  replace (t * sum + - (t * sum - tau * sum)) with (tau * sum) in P by ring.
    rewrite Rabs_Ropp, MS, (Rabs_mult t sum), (Rabs_pos_eq sum) in P by lra.
    assert (P2 : m * sum - ((2 + / 50) * um + / 1000000 * (E * s)) <= Rabs t * sum) by lra.
    assert (P3 : (m * sum - ((2 + / 50) * um + / 1000000 * (E * s))) * (s * reach) <= Rabs t * sum * (s * reach)) by
      (apply Rmult_le_compat_r; lra).
    apply Rmult_le_reg_r with sum; [assumption|]. replace (Rabs t * (s * reach) * sum) with (Rabs t * sum * (s *
      reach)) by ring.
    eapply Rle_trans; [|exact P3].
    replace ((m * sum - ((2 + / 50) * um + / 1000000 * (E * s))) * (s * reach)) with
      (q * sum - (2 + / 50) * (u * (q * sum)) - / 1000000 * ((E * s) * (s * reach))) by (unfold q, um; ring).
    assert ((E * s) * (s * reach) <= (E * s) * sum) by (apply Rmult_le_compat_l; lra).
    assert (0 <= q * sum) by (apply Rmult_le_pos; lra). rewrite u_val. lra. }
  assert (EE : (1 - / 100000) * (E * s) + (1 - / 100000) * q <= error * sum).
  { eapply Rle_trans; [|exact Herror]. replace (s * (E + Rabs t * reach)) with (E * s + Rabs t * (s * reach)) by ring.
    set (G := Rabs t * (s * reach)) in *. set (V := E * s) in *. clearbody G V. rewrite u_val. lra. }
  assert (TT : Rabs (t * sum) <= m * sum + (2 + / 50) * um + / 1000000 * (E * s)).
  { replace (t * sum) with ((t * sum - tau * sum) + tau * sum) by ring. eapply Rle_trans; [apply Rabs_triang|]. lra. }
  assert (es0 : 0 < error * sum) by lra.
  assert (e0 : 0 < error) by (apply Rmult_lt_reg_r with sum; [assumption | lra]).
  assert (RT : forall x, F x -> Rabs (x * sum) <= error * sum -> Rabs ((RN (t + x) - (t + x)) * sum) <= (1 + / 100) *
    um + u * (E * s) + u * (error * sum)).
  { intros x Fx Hx. rewrite Rabs_mult, (Rabs_pos_eq sum) by lra. pose proof (RN_sum t x Ft Fx) as P.
    apply Rle_trans with (u * Rabs (t + x) * sum); [apply Rmult_le_compat_r; lra|]. rewrite Rmult_assoc.
    replace (Rabs (t + x) * sum) with (Rabs (t * sum + x * sum)) by (rewrite <- Rmult_plus_distr_r, Rabs_mult,
      (Rabs_pos_eq sum); lra).
    apply Rle_trans with (u * (m * sum + (2 + / 50) * um + / 1000000 * (E * s) + error * sum)).
    - apply Rmult_le_compat_l; [lra|]. eapply Rle_trans; [apply Rabs_triang|]. lra.
    - replace (u * (m * sum + (2 + / 50) * um + / 1000000 * (E * s) + error * sum)) with
        (um + (2 + / 50) * (u * um) + / 1000000 * (u * (E * s)) + u * (error * sum)) by (unfold um; ring).
      assert (u * um <= / 1000 * um) by (rewrite u_val; lra). assert (0 <= u * (E * s)) by (apply Rmult_le_pos; lra).
      lra. }
  pose proof (RT (- error) (F_opp _ Fe)) as LO. pose proof (RT error Fe) as HI.
  assert (AE : Rabs (error * sum) <= error * sum) by (rewrite Rabs_pos_eq; lra).
  assert (AE2 : Rabs (- error * sum) <= error * sum) by (replace (- error * sum) with (- (error * sum)) by ring;
    now rewrite Rabs_Ropp).
  specialize (LO AE2). specialize (HI AE). change (t + - error) with (t - error) in LO.
  apply Rabs_le_inv in LO. apply Rabs_le_inv in HI. apply Rabs_le_inv in T4. apply Rabs_le_inv in T5.
  set (lo := RN (t - error)) in *. set (hi := RN (t + error)) in *. set (es := error * sum) in *.
  assert (ue : u * es <= / 1000000 * es) by (rewrite u_val; lra).
  assert (uE : u * (E * s) <= / 1000000 * (E * s)) by (rewrite u_val; lra).
  assert (L1 : lo * sum <= X * sum) by (replace (lo * sum) with ((lo - (t - error)) * sum + (t * sum - es)) by (unfold
    es; ring); lra).
  assert (L2 : X * sum <= hi * sum) by (replace (hi * sum) with ((hi - (t + error)) * sum + (t * sum + es)) by (unfold
    es; ring); lra).
  split; apply Rmult_le_reg_r with sum; assumption.
Qed.
End TriangleBounds.
