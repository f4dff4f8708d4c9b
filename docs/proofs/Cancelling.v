(* rt-math, pseudo_inverse/regular.rs: the determinant in triple precision, `cancelling_determinant`, and the range. *)
From Coq Require Import List.
From Proofs Require Import Rounding ErrorFree DoubleDouble Steps.
Import ListNotations.
Open Scope R_scope.

(* Magnitudes of entries that are not zero lie between its inverse and it. *)
Definition LARGEST := bp 100.
(* What is left out, relative to the sum of the magnitudes of the terms. *)
Definition CANCELLING_ERROR := 512 * u * u * u.

(* ---- Multiples of a power of two stay multiples when they are rounded. ---- *)
Definition mult k x := exists m, x = IZR m * bp k.
Lemma mult_add : forall k x y, mult k x -> mult k y -> mult k (x + y).
Proof. intros k x y [i I] [j J]. exists (i + j)%Z. rewrite plus_IZR, I, J. ring. Qed.
Lemma mult_sub : forall k x y, mult k x -> mult k y -> mult k (x - y).
Proof. intros k x y [i I] [j J]. exists (i - j)%Z. rewrite minus_IZR, I, J. ring. Qed.
Lemma mult_mul : forall k l x y, mult k x -> mult l y -> mult (k + l) (x * y).
Proof. intros k l x y [i I] [j J]. exists (i * j)%Z. rewrite mult_IZR, bp_add, I, J. ring. Qed.
Lemma mult_RN : forall k x, (-1074 <= k)%Z -> mult k x -> mult k (RN x).
Proof.
  intros k x K [m M]. destruct (Z_le_gt_dec k (cexp radix2 fexp x)) as [L|L].
  - exists (ZnearestE (scaled_mantissa radix2 fexp x) * 2 ^ (cexp radix2 fexp x - k))%Z. rewrite mult_IZR.
    change 2%Z with (radix_val radix2). rewrite IZR_Zpower by lia. rewrite Rmult_assoc, <- bp_add.
    replace (cexp radix2 fexp x - k + k)%Z with (cexp radix2 fexp x) by ring. reflexivity.
  - exists m. rewrite <- M. apply RN_id. rewrite M. apply multiple_F; [assumption|]. rewrite <- M.
    apply Rlt_le. eapply Rlt_le_trans; [apply (bpow_mag_gt radix2)|]. apply bp_le. unfold cexp, fexp, FLT_exp in L. lia.
Qed.
Lemma mult_zero : forall k x, mult k x -> x = 0 \/ bp k <= Rabs x.
Proof.
  intros k x [m M]. destruct (Req_dec x 0) as [Z|N]; [now left | right]. rewrite M in *. now apply multiple_least.
Qed.
Lemma mult_entry : forall x, F x -> x = 0 \/ / LARGEST <= Rabs x -> mult (-152) x.
Proof.
  intros x Fx [Z|H].
  - exists 0%Z. rewrite Z. simpl. ring.
  - apply multiple; [assumption|]. assert (H' : bp (-100) <= Rabs x).
    { replace (bp (-100)) with (/ LARGEST); [assumption|]. unfold LARGEST. symmetry. apply (bpow_opp radix2 100). }
    assert (-100 < mag radix2 x)%Z by (apply (lt_bpow radix2); eapply Rle_lt_trans; [exact H' | apply bpow_mag_gt]).
    unfold cexp, fexp, FLT_exp. lia.
Qed.

(* The error of a sum, and of a product. *)
Definition se x y := x + y - RN (x + y).
Definition pe x y := x * y - RN (x * y).
Lemma se_F : forall x y, F x -> F y -> F (se x y).
Proof.
  intros x y Fx Fy. unfold se. pose proof (two_sum x y Fx Fy) as T. replace (x + y - RN (x + y)) with (two_sum_error x
    y) by lra.
  apply two_sum_error_F.
Qed.
Lemma se_le : forall x y, F x -> F y -> Rabs (se x y) <= u * Rabs (x + y).
Proof. intros. unfold se. rewrite Rabs_minus_sym. now apply RN_sum. Qed.
Lemma se_mult : forall k x y, (-1074 <= k)%Z -> mult k x -> mult k y -> mult k (se x y).
Proof. intros. unfold se. apply mult_sub; [now apply mult_add | apply mult_RN; auto; now apply mult_add]. Qed.
Lemma pe_F : forall k x y, (-960 <= k)%Z -> mult k (x * y) -> F x -> F y -> F (pe x y).
Proof.
  intros k x y K M Fx Fy. unfold pe. destruct (mult_zero _ _ M) as [Z|N].
  - rewrite Z, RN_0, Rminus_0_r. apply F_0.
  - assert (H : x * y = 0 \/ bp (-969) <= Rabs (x * y)) by (right; eapply Rle_trans; [|exact N]; apply bp_le; lia).
    pose proof (fused x y Fx Fy H) as E. replace (x * y - RN (x * y)) with (fused_error x y) by lra. apply RN_F.
Qed.
Lemma mult_RN_le : forall k x, (-960 <= k)%Z -> mult k x -> Rabs (RN x - x) <= u * Rabs x.
Proof.
  intros k x K M. destruct (mult_zero _ _ M) as [Z|N].
  - rewrite Z, RN_0. replace (0 - 0) with 0 by ring. rewrite Rabs_R0. lra.
  - apply RN_normal. eapply Rle_trans; [|exact N]. apply bp_le. lia.
Qed.
Lemma pe_le : forall k x y, (-960 <= k)%Z -> mult k (x * y) -> Rabs (pe x y) <= u * Rabs (x * y).
Proof. intros. unfold pe. rewrite Rabs_minus_sym. now apply (mult_RN_le k). Qed.
Lemma pe_mult : forall k x y, (-960 <= k)%Z -> mult k (x * y) -> mult k (pe x y).
Proof. intros. unfold pe. apply mult_sub; [assumption | apply mult_RN; [lia | assumption]]. Qed.

(* One entry of the first row, and the four entries of its cofactor. *)
Section Entry.
Variables a b1 b2 b3 b4 : R.
Hypotheses (Fa : F a) (F1 : F b1) (F2 : F b2) (F3 : F b3) (F4 : F b4)
  (Ma : mult (-152) a) (M1 : mult (-152) b1) (M2 : mult (-152) b2) (M3 : mult (-152) b3) (M4 : mult (-152) b4).
Definition p := RN (b1 * b2). Definition p' := pe b1 b2. Definition q := RN (b3 * b4). Definition q' := pe b3 b4.
Definition h := RN (p + - q). Definition e := se p (- q). Definition t := RN (p' + - q'). Definition f := se p' (- q').
Definition first := RN (a * h).
Definition sum := RN (pe a h + RN (a * e)).
Definition second := RN (sum + RN (a * t)).
Definition third := RN (RN (RN (pe a e + pe a t) + RN (a * f)) + RN (se (pe a h) (RN (a * e)) + se sum (RN (a * t)))).
Definition msize := Rabs a * (Rabs p + Rabs q).

Lemma entry : Rabs first <= (1 + / 1000) * msize /\ Rabs second <= (3 + / 1000) * u * msize /\
  Rabs third <= (8 + / 100) * (u * u) * msize /\ F second /\ F third /\
  Rabs (a * (b1 * b2 - b3 * b4) - (first + second + third)) <= (19 + / 100) * (u * u * u) * msize.
Proof.
  assert (MP : mult (-304) (b1 * b2)) by exact (mult_mul (-152) (-152) _ _ M1 M2).
  assert (MQ : mult (-304) (b3 * b4)) by exact (mult_mul (-152) (-152) _ _ M3 M4).
  assert (Mp : mult (-304) p) by (apply mult_RN; [lia | assumption]).
  assert (Mq : mult (-304) (- q)).
  { replace (- q) with (0 - q) by ring. apply mult_sub; [exists 0%Z; simpl; ring | apply mult_RN; [lia | assumption]]. }
  assert (Mp' : mult (-304) p') by (apply pe_mult; [lia | assumption]).
  assert (Mq' : mult (-304) (- q')).
  { replace (- q') with (0 - q') by ring. apply mult_sub; [exists 0%Z; simpl; ring | apply pe_mult; [lia |
    assumption]]. }
  assert (Mh : mult (-304) h) by (apply mult_RN; [lia | now apply mult_add]).
  assert (Me : mult (-304) e) by (apply se_mult; auto; lia).
  assert (Mt : mult (-304) t) by (apply mult_RN; [lia | now apply mult_add]).
  assert (Mf : mult (-304) f) by (apply se_mult; auto; lia).
  assert (Fp : F p) by apply RN_F. assert (Fq : F (- q)) by apply F_opp, RN_F.
  assert (Fp' : F p') by (apply (pe_F (-304)); auto; lia). assert (Fq' : F (- q')) by (apply F_opp, (pe_F (-304));
    auto; lia).
  assert (Fh : F h) by apply RN_F. assert (Fe : F e) by now apply se_F. assert (Ft : F t) by apply RN_F.
  assert (Ff : F f) by now apply se_F.
  assert (Mah : mult (-456) (a * h)) by exact (mult_mul (-152) (-304) _ _ Ma Mh).
  assert (Mae : mult (-456) (a * e)) by exact (mult_mul (-152) (-304) _ _ Ma Me).
  assert (Mat : mult (-456) (a * t)) by exact (mult_mul (-152) (-304) _ _ Ma Mt).
  assert (Maf : mult (-456) (a * f)) by exact (mult_mul (-152) (-304) _ _ Ma Mf).
  assert (Fah : F (pe a h)) by (apply (pe_F (-456)); auto; lia).
  assert (Fae : F (pe a e)) by (apply (pe_F (-456)); auto; lia).
  assert (Fat : F (pe a t)) by (apply (pe_F (-456)); auto; lia).
  pose proof (se_F _ _ Fah (RN_F (a * e))) as Fs0. pose proof (se_F sum (RN (a * t)) (RN_F _) (RN_F _)) as Fs1.
  pose proof (pe_le (-304) b1 b2 ltac:(lia) MP) as Ep. fold p' in Ep. pose proof (pe_le (-304) b3 b4 ltac:(lia) MQ) as
    Eq. fold q' in Eq.
  pose proof (mult_RN_le (-304) _ ltac:(lia) MP) as Rp. fold p in Rp. pose proof (mult_RN_le (-304) _ ltac:(lia) MQ)
    as Rq. fold q in Rq.
  pose proof (RN_sum p (- q) Fp Fq) as Rh. fold h in Rh. pose proof (se_le p (- q) Fp Fq) as Ee. fold e in Ee.
  pose proof (RN_sum p' (- q') Fp' Fq') as Rt. fold t in Rt. pose proof (se_le p' (- q') Fp' Fq') as Ef. fold f in Ef.
  set (P := b1 * b2) in *. set (Q := b3 * b4) in *. set (w := Rabs p + Rabs q).
  assert (W0 : 0 <= w) by (unfold w; pose proof (Rabs_pos p); pose proof (Rabs_pos q); lra).
  pose proof u_pos.
  assert (Hp : Rabs P <= (1 + 2 * u) * Rabs p).
  { pose proof (Rabs_triang_inv P p) as T. rewrite (Rabs_minus_sym P) in T. pose proof (Rabs_pos p). rewrite u_val in
    *. lra. }
  assert (Hq : Rabs Q <= (1 + 2 * u) * Rabs q).
  { pose proof (Rabs_triang_inv Q q) as T. rewrite (Rabs_minus_sym Q) in T. pose proof (Rabs_pos q). rewrite u_val in
    *. lra. }
  assert (Hpq : Rabs (p + - q) <= w) by (unfold w; rewrite <- (Rabs_Ropp q); apply Rabs_triang).
  assert (He : Rabs e <= u * w) by (eapply Rle_trans; [exact Ee | apply Rmult_le_compat_l; lra]).
  assert (Hh : Rabs h <= (1 + u) * w).
  { replace h with ((h - (p + - q)) + (p + - q)) by ring. eapply Rle_trans; [apply Rabs_triang|].
    assert (u * Rabs (p + - q) <= u * w) by (apply Rmult_le_compat_l; lra). lra. }
  assert (Hpq' : Rabs (p' + - q') <= (1 + 3 * u) * (u * w)).
  { eapply Rle_trans; [apply Rabs_triang|]. rewrite Rabs_Ropp. unfold w. pose proof (Rabs_pos p). pose proof (Rabs_pos
    q).
    rewrite u_val in *. lra. }
  assert (Hf : Rabs f <= (1 + 3 * u) * (u * u * w)) by (rewrite u_val in *; lra).
  assert (Ht : Rabs t <= (1 + 5 * u) * (u * w)).
  { replace t with ((t - (p' + - q')) + (p' + - q')) by ring. eapply Rle_trans; [apply Rabs_triang|]. rewrite u_val in
    *. lra. }
  (* times a *)
  set (m := Rabs a * w). assert (EM : msize = m) by reflexivity. rewrite EM. pose proof (Rabs_pos a) as A0.
  assert (m0 : 0 <= m) by (apply Rmult_le_pos; assumption).
  assert (AX : forall x k, Rabs x <= k * w -> Rabs (a * x) <= k * m).
  { intros x k Hx. rewrite Rabs_mult. unfold m. replace (k * (Rabs a * w)) with (Rabs a * (k * w)) by ring.
    now apply Rmult_le_compat_l. }
  pose proof (AX h (1 + u) Hh) as Bh. pose proof (AX e u He) as Be.
  pose proof (AX t ((1 + 5 * u) * u) ltac:(lra)) as Bt. pose proof (AX f ((1 + 3 * u) * (u * u)) ltac:(lra)) as Bf.
  pose proof (mult_RN_le (-456) _ ltac:(lia) Mah) as Rah. pose proof (pe_le (-456) a h ltac:(lia) Mah) as Eah.
  pose proof (mult_RN_le (-456) _ ltac:(lia) Mae) as Rae. pose proof (pe_le (-456) a e ltac:(lia) Mae) as Eae.
  pose proof (mult_RN_le (-456) _ ltac:(lia) Mat) as Rat. pose proof (pe_le (-456) a t ltac:(lia) Mat) as Eat.
  pose proof (mult_RN_le (-456) _ ltac:(lia) Maf) as Raf.
  set (ah' := pe a h) in *. set (ae' := pe a e) in *. set (at' := pe a t) in *.
  set (ae := RN (a * e)) in *. set (at0 := RN (a * t)) in *. set (af := RN (a * f)) in *.
  pose proof (RN_sum ah' ae Fah (RN_F _)) as Rs. change (RN (ah' + ae)) with sum in Rs.
  pose proof (se_le ah' ae Fah (RN_F _)) as Es. 
  pose proof (RN_sum sum at0 (RN_F _) (RN_F _)) as R2. change (RN (sum + at0)) with second in R2.
  pose proof (se_le sum at0 (RN_F _) (RN_F _)) as Es2.
  assert (Ds : se ah' ae = ah' + ae - sum) by reflexivity. assert (Ds2 : se sum at0 = sum + at0 - second) by
    reflexivity.
  set (s0 := se ah' ae) in *. set (s1 := se sum at0) in *.
  pose proof (RN_sum ae' at' Fae Fat) as T1. set (x1 := RN (ae' + at')) in *.
  pose proof (RN_sum x1 af (RN_F _) (RN_F _)) as T2. set (x2 := RN (x1 + af)) in *.
  pose proof (RN_sum s0 s1 Fs0 Fs1) as T3. set (x3 := RN (s0 + s1)) in *.
  pose proof (RN_sum x2 x3 (RN_F _) (RN_F _)) as T4. change (RN (x2 + x3)) with third in T4.
  assert (C1 : Rabs ah' <= (1 + 2 * u) * (u * m)) by (rewrite u_val in *; lra).
  assert (C2 : Rabs ae' <= u * u * m) by (rewrite u_val in *; lra).
  assert (C3 : Rabs at' <= (1 + 5 * u) * (u * u * m)) by (rewrite u_val in *; lra).
  assert (D1 : Rabs ae <= (1 + u) * (u * m)).
  { replace ae with ((ae - a * e) + a * e) by ring. eapply Rle_trans; [apply Rabs_triang|]. rewrite u_val in *. lra. }
  assert (D2 : Rabs at0 <= (1 + 9 * u) * (u * m)).
  { replace at0 with ((at0 - a * t) + a * t) by ring. eapply Rle_trans; [apply Rabs_triang|]. rewrite u_val in *. lra. }
  assert (D3 : Rabs af <= (1 + 9 * u) * (u * u * m)).
  { replace af with ((af - a * f) + a * f) by ring. eapply Rle_trans; [apply Rabs_triang|]. rewrite u_val in *. lra. }
  assert (G1 : Rabs (ah' + ae) <= (2 + 9 * u) * (u * m)) by (eapply Rle_trans; [apply Rabs_triang|]; rewrite u_val in
    *; lra).
  assert (G2 : Rabs s0 <= (2 + 9 * u) * (u * u * m)) by (rewrite u_val in *; lra).
  assert (G3 : Rabs sum <= (2 + 20 * u) * (u * m)).
  { replace sum with ((ah' + ae) - s0) by (rewrite Ds; ring). unfold Rminus. eapply Rle_trans; [apply Rabs_triang|].
    rewrite Rabs_Ropp. rewrite u_val in *. lra. }
  assert (G4 : Rabs (sum + at0) <= (3 + 40 * u) * (u * m)) by (eapply Rle_trans; [apply Rabs_triang|]; rewrite u_val
    in *; lra).
  assert (G5 : Rabs s1 <= (3 + 40 * u) * (u * u * m)) by (rewrite u_val in *; lra).
  assert (G6 : Rabs second <= (3 + 80 * u) * (u * m)).
  { replace second with ((sum + at0) - s1) by (rewrite Ds2; ring). unfold Rminus. eapply Rle_trans; [apply
    Rabs_triang|].
    rewrite Rabs_Ropp. rewrite u_val in *. lra. }
  assert (K1 : Rabs (ae' + at') <= (2 + 9 * u) * (u * u * m)) by (eapply Rle_trans; [apply Rabs_triang|]; rewrite
    u_val in *; lra).
  assert (K2 : Rabs (x1 + af) <= (3 + 40 * u) * (u * u * m)).
  { replace (x1 + af) with ((x1 - (ae' + at')) + (ae' + at') + af) by ring. eapply Rle_trans; [apply Rabs_triang|].
    eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|]. rewrite u_val in *. lra. }
  assert (K3 : Rabs (s0 + s1) <= (5 + 60 * u) * (u * u * m)) by (eapply Rle_trans; [apply Rabs_triang|]; rewrite u_val
    in *; lra).
  assert (K4 : Rabs (x2 + x3) <= (8 + 200 * u) * (u * u * m)).
  { replace (x2 + x3) with ((x2 - (x1 + af)) + (x1 + af) + ((x3 - (s0 + s1)) + (s0 + s1))) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. eapply Rle_trans; [apply Rplus_le_compat; apply Rabs_triang|]. rewrite
      u_val in *. lra. }
  split; [|split; [|split; [|split; [apply RN_F | split; [apply RN_F|]]]]].
  - change first with (RN (a * h)). replace (RN (a * h)) with ((RN (a * h) - a * h) + a * h) by ring.
    eapply Rle_trans; [apply Rabs_triang|]. rewrite u_val in *. lra.
  - rewrite u_val in *. lra.
  - replace third with ((third - (x2 + x3)) + (x2 + x3)) by ring. eapply Rle_trans; [apply Rabs_triang|].
    rewrite u_val in *. lra.
  - (* everything but the roundings of third cancels *)
    assert (I : a * (P - Q) = first + ah' + (ae + ae') + (at0 + at') + a * f).
    { unfold first, ah', ae, ae', at0, at', pe.
      assert (HH : h + e = p + - q) by (unfold e, h, se; ring). assert (TT : t + f = p' + - q') by (unfold f, t, se;
        ring).
      assert (PP : p + p' = P) by (unfold p', p, pe, P; ring). assert (QQ : q + q' = Q) by (unfold q', q, pe, Q; ring).
      replace (a * (P - Q)) with (a * ((h + e) + (t + f))) by (rewrite HH, TT, <- PP, <- QQ; ring). ring. }
    replace (a * (P - Q) - (first + second + third)) with
      (- (third - (x2 + x3)) - (x2 - (x1 + af)) - (x3 - (s0 + s1)) - (x1 - (ae' + at')) - (af - a * f))
      by (rewrite I, Ds2, Ds; ring).
    clear - T4 T3 T2 T1 Raf K1 K2 K3 K4 Bf m0. apply Rabs_le_inv in T1. apply Rabs_le_inv in T2. apply Rabs_le_inv in
      T3.
    apply Rabs_le_inv in T4. apply Rabs_le_inv in Raf. apply Rabs_le. rewrite u_val in *. lra.
Qed.
End Entry.

(* The sums over the three entries: f_i, g_i and h_i of the three orders. *)
Section Sums.
Variables f0 f1 f2 g0 g1 g2 t0 t1 t2 m0 m1 m2 : R.
Hypotheses (Ff0 : F f0) (Ff1 : F f1) (Ff2 : F f2) (Fg0 : F g0) (Fg1 : F g1) (Fg2 : F g2) (Ft0 : F t0) (Ft1 : F t1)
  (Ft2 : F t2)
  (Bf0 : Rabs f0 <= (1 + / 1000) * m0) (Bf1 : Rabs f1 <= (1 + / 1000) * m1) (Bf2 : Rabs f2 <= (1 + / 1000) * m2)
  (Bg0 : Rabs g0 <= (3 + / 1000) * u * m0) (Bg1 : Rabs g1 <= (3 + / 1000) * u * m1) (Bg2 : Rabs g2 <= (3 + / 1000) * u
    * m2)
  (Bt0 : Rabs t0 <= (8 + / 100) * (u * u) * m0) (Bt1 : Rabs t1 <= (8 + / 100) * (u * u) * m1)
  (Bt2 : Rabs t2 <= (8 + / 100) * (u * u) * m2).
Definition s01 := RN (f0 + f1). Definition s012 := RN (s01 + f2).
Definition errors := RN (se f0 f1 + se s01 f2). Definition r0 := se (se f0 f1) (se s01 f2).
Definition middle := RN (g0 + g1). Definition r1 := se g0 g1.
Definition errors2 := RN (errors + g2). Definition r2 := se errors g2.
Definition middle2 := RN (middle + errors2). Definition r3 := se middle errors2.
Definition high := RN (s012 + middle2). Definition middle3 := se s012 middle2.
Definition rest := RN (RN (RN (t0 + t1) + t2) + RN (RN (r0 + r1) + RN (r2 + r3))).
Definition low := RN (middle3 + rest).

Lemma sums : Rabs (f0 + f1 + f2 + (g0 + g1 + g2) + (t0 + t1 + t2) - (high + low)) <=
  (69 + 3 / 10) * (u * u * u) * (m0 + m1 + m2) + u * Rabs low.
Proof.
  pose proof u_pos. set (M := m0 + m1 + m2).
  assert (N0 : 0 <= m0) by (pose proof (Rabs_pos f0); lra). assert (N1 : 0 <= m1) by (pose proof (Rabs_pos f1); lra).
  assert (N2 : 0 <= m2) by (pose proof (Rabs_pos f2); lra). assert (N : 0 <= M) by (unfold M; lra).
  pose proof (se_F f0 f1 Ff0 Ff1) as Fa. pose proof (se_F s01 f2 (RN_F _) Ff2) as Fb.
  pose proof (se_le f0 f1 Ff0 Ff1) as Ea. pose proof (se_le s01 f2 (RN_F _) Ff2) as Eb.
  assert (Da : se f0 f1 = f0 + f1 - s01) by reflexivity. assert (Db : se s01 f2 = s01 + f2 - s012) by reflexivity.
  assert (Dm : middle3 = s012 + middle2 - high) by reflexivity.
  set (a := se f0 f1) in *. set (b := se s01 f2) in *.
  pose proof (se_F a b Fa Fb) as Fr0. pose proof (se_le a b Fa Fb) as E0. change (se a b) with r0 in *.
  assert (D0 : r0 = a + b - errors) by reflexivity.
  pose proof (se_F g0 g1 Fg0 Fg1) as Fr1. pose proof (se_le g0 g1 Fg0 Fg1) as E1. change (se g0 g1) with r1 in *.
  assert (D1 : r1 = g0 + g1 - middle) by reflexivity.
  pose proof (se_F errors g2 (RN_F _) Fg2) as Fr2. pose proof (se_le errors g2 (RN_F _) Fg2) as E2. change (se errors
    g2) with r2 in *.
  assert (D2 : r2 = errors + g2 - errors2) by reflexivity.
  pose proof (se_F middle errors2 (RN_F _) (RN_F _)) as Fr3. pose proof (se_le middle errors2 (RN_F _) (RN_F _)) as E3.
  change (se middle errors2) with r3 in *. assert (D3 : r3 = middle + errors2 - middle2) by reflexivity.
  pose proof (RN_sum t0 t1 Ft0 Ft1) as X1. set (x1 := RN (t0 + t1)) in *.
  pose proof (RN_sum x1 t2 (RN_F _) Ft2) as X2. set (x2 := RN (x1 + t2)) in *.
  pose proof (RN_sum r0 r1 Fr0 Fr1) as X3. set (x3 := RN (r0 + r1)) in *.
  pose proof (RN_sum r2 r3 Fr2 Fr3) as X4. set (x4 := RN (r2 + r3)) in *.
  pose proof (RN_sum x3 x4 (RN_F _) (RN_F _)) as X5. set (x5 := RN (x3 + x4)) in *.
  pose proof (RN_sum x2 x5 (RN_F _) (RN_F _)) as X6. change (RN (x2 + x5)) with rest in X6.
  assert (Fm : F middle3) by (apply se_F; apply RN_F).
  assert (X7 : Rabs (middle3 + rest - low) <= u * Rabs low).
  { pose proof (two_sum_error_le middle3 rest Fm (RN_F _)) as [_ Y]. pose proof (two_sum middle3 rest Fm (RN_F _)) as T.
    unfold low. replace (middle3 + rest - RN (middle3 + rest)) with (two_sum_error middle3 rest) by lra. exact Y. }
  (* magnitudes *)
  assert (H1 : Rabs (f0 + f1) <= (1 + / 900) * M) by (eapply Rle_trans; [apply Rabs_triang|]; unfold M; lra).
  assert (H2 : Rabs a <= (1 + / 900) * (u * M)) by (rewrite u_val in *; lra).
  assert (H3 : Rabs (s01 + f2) <= (1 + / 800) * M).
  { replace (s01 + f2) with (f0 + f1 + f2 - a) by (rewrite Da; ring). unfold Rminus. eapply Rle_trans; [apply
    Rabs_triang|].
    rewrite Rabs_Ropp. pose proof (Rabs_triang (f0 + f1) f2). pose proof (Rabs_triang f0 f1). unfold M in *. rewrite
      u_val in *. lra. }
  assert (H4 : Rabs b <= (1 + / 800) * (u * M)) by (rewrite u_val in *; lra).
  assert (H5 : Rabs (a + b) <= (2 + / 300) * (u * M)) by (eapply Rle_trans; [apply Rabs_triang|]; rewrite u_val in *;
    lra).
  assert (H6 : Rabs r0 <= (2 + / 300) * (u * u * M)) by (rewrite u_val in *; lra).
  assert (H7 : Rabs errors <= (2 + / 250) * (u * M)).
  { replace errors with ((a + b) - r0) by (rewrite D0; ring). unfold Rminus. eapply Rle_trans; [apply Rabs_triang|].
    rewrite Rabs_Ropp.
    rewrite u_val in *. lra. }
  assert (H8 : Rabs (g0 + g1) + Rabs g2 <= (3 + / 300) * (u * M)).
  { pose proof (Rabs_triang g0 g1). unfold M. rewrite u_val in *. lra. }
  pose proof (Rabs_pos g2) as G2. pose proof (Rabs_pos (g0 + g1)) as G01.
  assert (H9 : Rabs r1 <= (3 + / 300) * (u * u * M)) by (rewrite u_val in *; lra).
  assert (H10 : Rabs (errors + g2) <= (5 + / 100) * (u * M)) by (eapply Rle_trans; [apply Rabs_triang|]; rewrite u_val
    in *; lra).
  assert (H11 : Rabs r2 <= (5 + / 100) * (u * u * M)) by (rewrite u_val in *; lra).
  assert (H12 : Rabs (middle + errors2) <= (5 + / 90) * (u * M)).
  { replace (middle + errors2) with ((g0 + g1) - r1 + ((errors + g2) - r2)) by (rewrite D1, D2; ring).
    pose proof (Rabs_triang errors g2) as T1. clear - H7 H8 H9 H11 T1 N G2 G01 H.
    assert (Rabs (g0 + g1 - r1) <= Rabs (g0 + g1) + Rabs r1) by (unfold Rminus; rewrite <- (Rabs_Ropp r1); apply
      Rabs_triang).
    assert (Rabs (errors + g2 - r2) <= Rabs (errors + g2) + Rabs r2) by (unfold Rminus; rewrite <- (Rabs_Ropp r2);
      apply Rabs_triang).
    eapply Rle_trans; [apply Rabs_triang|]. rewrite u_val in *. lra. }
  assert (H13 : Rabs r3 <= (5 + / 90) * (u * u * M)) by (rewrite u_val in *; lra).
  assert (K1 : Rabs (t0 + t1) + Rabs t2 <= (8 + / 100) * (u * u * M)).
  { pose proof (Rabs_triang t0 t1). unfold M. rewrite u_val in *. lra. }
  pose proof (Rabs_pos t2) as P1. pose proof (Rabs_pos (t0 + t1)) as P2.
  assert (K2 : Rabs (x1 + t2) <= (8 + / 90) * (u * u * M)).
  { replace (x1 + t2) with ((x1 - (t0 + t1)) + (t0 + t1) + t2) by ring. eapply Rle_trans; [apply Rabs_triang|].
    eapply Rle_trans; [apply Rplus_le_compat_r, Rabs_triang|]. rewrite u_val in *. lra. }
  assert (K3 : Rabs (r0 + r1) <= (5 + / 100) * (u * u * M)) by (eapply Rle_trans; [apply Rabs_triang|]; rewrite u_val
    in *; lra).
  assert (K4 : Rabs (r2 + r3) <= (10 + / 40) * (u * u * M)) by (eapply Rle_trans; [apply Rabs_triang|]; rewrite u_val
    in *; lra).
  assert (K5 : Rabs (x3 + x4) <= (15 + / 20) * (u * u * M)).
  { replace (x3 + x4) with ((x3 - (r0 + r1)) + (r0 + r1) + ((x4 - (r2 + r3)) + (r2 + r3))) by ring. eapply Rle_trans;
    [apply Rabs_triang|].
    eapply Rle_trans; [apply Rplus_le_compat; apply Rabs_triang|]. rewrite u_val in *. lra. }
  assert (K6 : Rabs (x2 + x5) <= (23 + / 10) * (u * u * M)).
  { replace (x2 + x5) with ((x2 - (x1 + t2)) + (x1 + t2) + ((x5 - (x3 + x4)) + (x3 + x4))) by ring. eapply Rle_trans;
    [apply Rabs_triang|].
    eapply Rle_trans; [apply Rplus_le_compat; apply Rabs_triang|]. rewrite u_val in *. lra. }
  replace (f0 + f1 + f2 + (g0 + g1 + g2) + (t0 + t1 + t2) - (high + low)) with
    ((middle3 + rest - low) - (rest - (x2 + x5)) - (x5 - (x3 + x4)) - (x2 - (x1 + t2)) - (x1 - (t0 + t1)) - (x3 - (r0
      + r1)) - (x4 - (r2 + r3)))
    by (rewrite Dm, D3, D2, D1, D0, Db, Da; ring).
  clear - X1 X2 X3 X4 X5 X6 X7 K1 K2 K3 K4 K5 K6 P1 P2 N H.
  apply Rabs_le_inv in X1. apply Rabs_le_inv in X2. apply Rabs_le_inv in X3. apply Rabs_le_inv in X4. apply
    Rabs_le_inv in X5.
  apply Rabs_le_inv in X6. apply Rabs_le_inv in X7. apply Rabs_le. rewrite u_val in *. lra.
Qed.
End Sums.

(* The determinant by the first row; the bound, a sum of terms that are not negative, through at most 16 roundings. *)
Section Determinant.
Variables a b c d e f g h i : R.
Let entries := [a; b; c; d; e; f; g; h; i].
Hypothesis Range : forall x, In x entries -> F x /\ (x = 0 \/ / LARGEST <= Rabs x <= LARGEST).
(* columns (a b c), (d e f), (g h i), the first row a d g *)
Let D := a * (e * i - h * f) + d * (h * c - b * i) + g * (b * f - e * c).
Let f0 := first a e i h f. Let f1 := first d h c b i. Let f2 := first g b f e c.
Let g0 := second a e i h f. Let g1 := second d h c b i. Let g2 := second g b f e c.
Let t0 := third a e i h f. Let t1 := third d h c b i. Let t2 := third g b f e c.
Let s := high f0 f1 f2 g0 g1 g2. Let l := low f0 f1 f2 g0 g1 g2 t0 t1 t2.

Theorem CANCELLING_ERROR_holds : forall bound,
  (1 - 16 * u) * (CANCELLING_ERROR * (msize a e i h f + msize d h c b i + msize g b f e c) + 9 / 8 * u * Rabs l) <=
    bound ->
  Rabs (D - (s + l)) <= bound.
Proof.
  intros bound HB. assert (R : forall x, In x entries -> F x /\ mult (-152) x).
  { intros x Hx. destruct (Range x Hx) as [Fx [Z|[L _]]]; split; auto; apply mult_entry; auto. }
  assert (E : forall x y z v w, In x entries -> In y entries -> In z entries -> In v entries -> In w entries ->
    Rabs (first x y z v w) <= (1 + / 1000) * msize x y z v w /\ Rabs (second x y z v w) <= (3 + / 1000) * u * msize x
      y z v w /\
    Rabs (third x y z v w) <= (8 + / 100) * (u * u) * msize x y z v w /\ F (second x y z v w) /\ F (third x y z v w) /\
    Rabs (x * (y * z - v * w) - (first x y z v w + second x y z v w + third x y z v w)) <= (19 + / 100) * (u * u * u)
      * msize x y z v w).
  { intros x y z v w X Y Z V W. apply R in X. apply R in Y. apply R in Z. apply R in V. apply R in W. apply entry;
    tauto. }
  destruct (E a e i h f) as (A1 & A2 & A3 & A4 & A5 & A6); try (unfold entries; simpl; tauto).
  destruct (E d h c b i) as (B1 & B2 & B3 & B4 & B5 & B6); try (unfold entries; simpl; tauto).
  destruct (E g b f e c) as (C1 & C2 & C3 & C4 & C5 & C6); try (unfold entries; simpl; tauto).
  pose proof (sums f0 f1 f2 g0 g1 g2 t0 t1 t2 (msize a e i h f) (msize d h c b i) (msize g b f e c)
    (RN_F _) (RN_F _) (RN_F _) A4 B4 C4 A5 B5 C5 A1 B1 C1 A2 B2 C2 A3 B3 C3) as S.
  change (high f0 f1 f2 g0 g1 g2) with s in S. change (low f0 f1 f2 g0 g1 g2 t0 t1 t2) with l in S.
  change (Rabs (a * (e * i - h * f) - (f0 + g0 + t0)) <= (19 + / 100) * (u * u * u) * msize a e i h f) in A6.
  change (Rabs (d * (h * c - b * i) - (f1 + g1 + t1)) <= (19 + / 100) * (u * u * u) * msize d h c b i) in B6.
  change (Rabs (g * (b * f - e * c) - (f2 + g2 + t2)) <= (19 + / 100) * (u * u * u) * msize g b f e c) in C6.
  set (m0 := msize a e i h f) in *. set (m1 := msize d h c b i) in *. set (m2 := msize g b f e c) in *.
  assert (N0 : 0 <= m0) by (pose proof (Rabs_pos (first a e i h f)); lra).
  assert (N1 : 0 <= m1) by (pose proof (Rabs_pos (first d h c b i)); lra).
  assert (N2 : 0 <= m2) by (pose proof (Rabs_pos (first g b f e c)); lra). pose proof (Rabs_pos l) as L0.
  unfold CANCELLING_ERROR in HB. unfold D. clear - S A6 B6 C6 N0 N1 N2 HB L0. bounds. apply Rabs_le. rewrite u_val in
    *. lra.
Qed.
End Determinant.
(* Products of two or three entries are zero or far above what underflows, and far below what overflows. *)
Theorem LARGEST_holds : forall x y z, F x -> F y -> F z ->
  x = 0 \/ / LARGEST <= Rabs x <= LARGEST -> y = 0 \/ / LARGEST <= Rabs y <= LARGEST -> z = 0 \/ / LARGEST <= Rabs z
    <= LARGEST ->
  mult (-304) (x * y) /\ mult (-456) (x * y * z) /\ Rabs (x * y) <= bp 200 /\ Rabs (x * y * z) <= bp 300.
Proof.
  intros x y z Fx Fy Fz X Y Z.
  assert (M : forall w, F w -> w = 0 \/ / LARGEST <= Rabs w <= LARGEST -> mult (-152) w /\ Rabs w <= bp 100).
  { intros w Fw W. split; [apply mult_entry; tauto|]. destruct W as [W|W]; [|apply W]. rewrite W, Rabs_R0. apply
    Rlt_le, bp_pos. }
  destruct (M x Fx X) as [X1 X2]. destruct (M y Fy Y) as [Y1 Y2]. destruct (M z Fz Z) as [Z1 Z2].
  assert (P : Rabs (x * y) <= bp 200).
  { change 200%Z with (100 + 100)%Z. rewrite bp_add. apply Rabs_mult_le; assumption. }
  split; [exact (mult_mul (-152) (-152) _ _ X1 Y1)|]. split.
  - exact (mult_mul (-304) (-152) _ _ (mult_mul (-152) (-152) _ _ X1 Y1) Z1).
  - split; [exact P|]. change 300%Z with (200 + 100)%Z. rewrite bp_add. apply Rabs_mult_le; assumption.
Qed.
