//! The inverse of a well-scaled regular matrix in double-double, vectorised by the compiler: the fast path.
//!
//! Cofactors and determinant are kept as unevaluated sums of two doubles with running error bounds; the rounding test
//! decides each entry. Symbols and the proof of every constant: `docs/numerics.md`, section 3.

use glam::{DMat3, DVec3};

use crate::exact::{U, power_of_two, rounded_ends, two_diff, two_prod, two_sum};

/// Where the series for the reciprocal is bounded, and the determinant is proved not to be zero.
const TAU_LIMIT: f64 = power_of_two(-19);
const ETA_LIMIT: f64 = 1.0 / 8.0;

/// Bound of what the determinant in triple precision leaves out: this part of the sum of the magnitudes of its terms.
const CANCELLING_ERROR: f64 = 512.0 * U * U * U;

/// Magnitudes of entries, besides zero, for which no product, error term or quotient can over- or underflow.
const SMALLEST: f64 = 1.0 / LARGEST;
const LARGEST: f64 = power_of_two(100);

/// The adjugate of a matrix, column by column as in the inverse: each entry is `h + l` within `u b`, and `|l| <= b`.
pub(super) struct Adjugate {
    h: [f64; 9],
    l: [f64; 9],
    b: [f64; 9],
}

impl Adjugate {
    /// The entries, each within a few units in the last place of itself or of `u` times its terms.
    pub(super) fn high(&self) -> &[f64; 9] {
        &self.h
    }
}

/// The adjugate, unless an entry is out of range.
#[inline(always)]
pub(super) fn adjugate<const FMA: bool>(m: &[f64; 9]) -> Option<Adjugate> {
    if !m.iter().fold(true, |all, &x| all & ((x == 0.0) | ((x.abs() >= SMALLEST) & (x.abs() <= LARGEST)))) {
        return None;
    }

    // Entries of the adjugate, column by column as in the answer: h + l, within u b.
    let (mut h, mut l, mut b) = ([0.0; 9], [0.0; 9], [0.0; 9]);
    for column in 0..3 {
        for row in 0..3 {
            let (j1, j2, i1, i2) = ((column + 1) % 3, (column + 2) % 3, (row + 1) % 3, (row + 2) % 3);
            let (p, q, r, s) = (m[3 * i1 + j1], m[3 * i2 + j2], m[3 * i2 + j1], m[3 * i1 + j2]);
            let (first, first_error) = two_prod::<FMA>(p, q);
            let (second, second_error) = two_prod::<FMA>(r, s);
            let (high, high_error) = two_diff(first, second);
            let errors = first_error - second_error;
            let low = high_error + errors;
            let k = 3 * column + row;
            (h[k], l[k], b[k]) = (high, low, errors.abs() + low.abs());
        }
    }

    Some(Adjugate { h, l, b })
}

/// The adjugate and the reciprocal of the determinant, unless an entry is out of range or the determinant may be zero.
/// If `CANCELS`, the determinant is computed in triple precision.
#[inline(always)]
fn parts<const FMA: bool, const CANCELS: bool>(m: &[f64; 9]) -> Option<(Adjugate, Reciprocal<FMA>)> {
    let adjugate = adjugate::<FMA>(m)?;
    let (s, low, bound) = if CANCELS { cancelling_determinant::<FMA>(m) } else { determinant::<FMA>(m, &adjugate) };
    let reciprocal = Reciprocal::new(s, low, bound)?;
    Some((adjugate, reciprocal))
}

/// The determinant by the first row: `s + low`, within `bound`.
#[inline(always)]
pub(super) fn determinant<const FMA: bool>(m: &[f64; 9], Adjugate { h, l, b }: &Adjugate) -> (f64, f64, f64) {
    // Modelled in docs/proofs/Determinant.v, by the same letters.
    let a = [m[0], m[3], m[6]];
    let [(p0, w0), (p1, w1), (p2, w2)] = [0, 1, 2].map(|k| two_prod::<FMA>(a[k], h[k]));
    let v = [a[0] * l[0], a[1] * l[1], a[2] * l[2]];
    let x = [w0 + v[0], w1 + v[1], w2 + v[2]];
    let (s, first_error) = two_sum(p0, p1);
    let (s, second_error) = two_sum(s, p2);
    let y = [x[0] + x[1], x[0] + x[1] + x[2], first_error + second_error];
    let low = y[1] + y[2];
    let sum = |v: [f64; 3]| v[0].abs() + v[1].abs() + v[2].abs();
    let bound = 1.125 * U * (sum([a[0] * b[0], a[1] * b[1], a[2] * b[2]]) + sum(v) + sum(x) + sum(y) + low.abs());
    (s, low, bound)
}

/// The determinant by the first row, where it is far smaller than its terms: `s + low`, within `bound`.
#[inline(always)]
fn cancelling_determinant<const FMA: bool>(m: &[f64; 9]) -> (f64, f64, f64) {
    // A cofactor is exactly h + e + t + f. Times the entry that gives terms of three orders, each about u of the one
    // before.
    let (mut first, mut second, mut third, mut size) = ([0.0; 3], [0.0; 3], [0.0; 3], [0.0; 3]);
    for i in 0..3 {
        let (j, k) = (3 * ((i + 1) % 3), 3 * ((i + 2) % 3));
        let (p, p_error) = two_prod::<FMA>(m[j + 1], m[k + 2]);
        let (q, q_error) = two_prod::<FMA>(m[k + 1], m[j + 2]);
        let ((h, e), (t, f)) = (two_diff(p, q), two_diff(p_error, q_error));
        let a = m[3 * i];
        let (ah, ah_error) = two_prod::<FMA>(a, h);
        let (ae, ae_error) = two_prod::<FMA>(a, e);
        let (at, at_error) = two_prod::<FMA>(a, t);
        let (sum, error_0) = two_sum(ah_error, ae);
        let (sum, error_1) = two_sum(sum, at);
        (first[i], second[i]) = (ah, sum);
        third[i] = ((ae_error + at_error) + a * f) + (error_0 + error_1);
        size[i] = a.abs() * (p.abs() + q.abs());
    }
    // The terms of the first two orders are summed without error.
    let (s, error_0) = two_sum(first[0], first[1]);
    let (s, error_1) = two_sum(s, first[2]);
    let (errors, rest_0) = two_sum(error_0, error_1);
    let (middle, rest_1) = two_sum(second[0], second[1]);
    let (errors, rest_2) = two_sum(errors, second[2]);
    let (middle, rest_3) = two_sum(middle, errors);
    let (s, middle) = two_sum(s, middle);
    let rest = ((third[0] + third[1]) + third[2]) + ((rest_0 + rest_1) + (rest_2 + rest_3));
    let low = middle + rest;
    (s, low, CANCELLING_ERROR * (size[0] + size[1] + size[2]) + 1.125 * U * low.abs())
}

/// The inverse; for `CANCELS` see [`parts`].
#[inline(always)]
pub(super) fn inverse<const FMA: bool, const CANCELS: bool>(m: &[f64; 9]) -> Option<DMat3> {
    let (Adjugate { h, l, b }, reciprocal) = parts::<FMA, CANCELS>(m)?;
    let mut inverse = [0.0; 9];
    let mut certain = true;
    for k in 0..9 {
        let (lower, upper) = reciprocal.times(h[k], l[k], b[k]);
        certain &= lower == upper;
        inverse[k] = upper;
    }
    certain.then(|| DMat3::from_cols_array(&inverse))
}

/// The sums of the rows of the inverse; for `CANCELS` see [`parts`].
#[inline(always)]
pub(super) fn row_sums<const FMA: bool, const CANCELS: bool>(m: &[f64; 9]) -> Option<DVec3> {
    let (Adjugate { h, l, b }, reciprocal) = parts::<FMA, CANCELS>(m)?;
    let mut sums = [0.0; 3];
    let mut certain = true;
    for k in 0..3 {
        let (sum, first_error) = two_sum(h[k], h[k + 3]);
        let (sum, second_error) = two_sum(sum, h[k + 6]);
        let errors = first_error + second_error;
        let low = errors + ((l[k] + l[k + 3]) + l[k + 6]);
        // Four additions of terms that are no larger than the sum of these magnitudes.
        let terms = (first_error.abs() + second_error.abs()) + ((l[k].abs() + l[k + 3].abs()) + l[k + 6].abs());
        let (lower, upper) = reciprocal.times(sum, low, 4.0 * terms + 1.125 * ((b[k] + b[k + 3]) + b[k + 6]));
        certain &= lower == upper;
        sums[k] = upper;
    }
    certain.then(|| DVec3::from_array(sums))
}

/// The reciprocal of a number that is not zero, `r (1 + tau + tau^2)` with a relative error, to divide by it.
pub(super) struct Reciprocal<const FMA: bool> {
    r: f64,
    /// `r (tau + tau^2)`
    r_low: f64,
    r_sum: f64,
    /// Error of a quotient by `h` of the numerator, and by `b`.
    weights: (f64, f64),
}

impl<const FMA: bool> Reciprocal<FMA> {
    /// The reciprocal of a number within `bound` of `s + low`, unless that may be zero or is too inexact.
    #[inline(always)]
    pub(super) fn new(s: f64, low: f64, bound: f64) -> Option<Self> {
        let r = 1.0 / s;
        let (product, product_error) = two_prod::<FMA>(r, s);
        let tau = ((1.0 - product) - product_error) - low * r;
        let (t, eta_0) = (tau.abs(), bound * r.abs());
        if !((t < TAU_LIMIT) & (eta_0 < ETA_LIMIT)) {
            return None;
        }
        let r_low = r * (tau + tau * tau);
        let eta = 2.0 * eta_0 + 16.0 * (U * U + t * (U + t * t));
        Some(Self { r, r_low, r_sum: r + r_low, weights: (r.abs() * eta, r.abs() * (eta + 8.0 * U)) })
    }

    /// Two doubles, the roundings of a lower and an upper bound of the quotient: where they are equal, so is its
    /// rounding. The numerator is within `u b` of `h + l`, and `|l| <= b`; zero, with `b = 0`, gives +0.0.
    #[inline(always)]
    pub(super) fn times(&self, h: f64, l: f64, b: f64) -> (f64, f64) {
        let (quotient, error) = two_prod::<FMA>(h, self.r);
        let correction = error + fused::<FMA>(h, self.r_low, l * self.r_sum);
        let bound = fused::<FMA>(self.weights.0, h.abs(), self.weights.1 * b);
        rounded_ends(quotient, correction, bound)
    }
}

/// `a b + c`, rounded once or twice: for terms whose bound allows either.
#[inline(always)]
fn fused<const FMA: bool>(a: f64, b: f64, c: f64) -> f64 {
    if FMA { a.mul_add(b, c) } else { a * b + c }
}

#[cfg(test)]
mod tests {
    use oracle::{Random, cases, exact};

    use super::*;
    use crate::exact::DoubleDouble;

    #[test]
    fn determinant_in_triple_precision_keeps_its_bound_however_small() {
        let (mut random, mut beyond_the_last_rounding) = (Random::new(6), 0);
        for _ in 0..cases(100_000) {
            // Two proportional columns but for one row, of any size: the determinant is that row's alone.
            let mut number = || random.with_exponent(-3..3);
            let (a, b) = ([number(), number(), number()], [number(), number(), number()]);
            let mut columns = [a, b, a.map(|x| 2.0 * x)];
            let row = 1 + random.below(2);
            let tiny = random.integer(-99..0);
            columns[0][row] = random.with_exponent(tiny..tiny + 1);
            columns[2][row] = random.with_exponent(tiny..tiny + 1);
            random.shuffle(&mut columns);
            let m: [f64; 9] = columns.concat().try_into().expect("nine entries");
            let [[a, b, c], [d, e, f], [g, h, i]] = columns.map(|column| column.map(exact));
            let determinant = &a * (&e * &i - &f * &h) - &d * (&b * &i - &c * &h) + &g * (&b * &f - &c * &e);
            for (s, low, bound) in [cancelling_determinant::<false>(&m), cancelling_determinant::<true>(&m)] {
                let error = exact(s) + exact(low) - &determinant;
                let square = &error * &error;
                assert!(square <= exact(bound) * exact(bound), "{m:?} gives {s:e} + {low:e}, {bound:e}");
                let rounding = exact(1.125 * U * low.abs());
                beyond_the_last_rounding += usize::from(square > &rounding * &rounding);
            }
        }
        assert!(beyond_the_last_rounding > 100, "{beyond_the_last_rounding}");
    }

    /// Numerators whose quotient lies beside a midpoint, by so much of it: from where on is the rounding certain?
    #[test]
    fn a_quotient_is_certain_as_near_to_a_midpoint_as_its_bound_lets_it() {
        let mut random = Random::new(7);
        let mut seen = 0;
        for _ in 0..cases(1_000_000) {
            let s = random.within(1.0, 2.0);
            let midpoint = DoubleDouble::<false>::sum(1.0 + random.share(), 0.5 * f64::EPSILON);
            let (q, half) = (midpoint.high() + midpoint.low(), 0.5 * f64::EPSILON);
            let exactly = DoubleDouble::<false>::product(q, s) + DoubleDouble::new(half * s);
            // A low double that weighs little.
            if exactly.low().abs() > U / 64.0 * exactly.high() {
                continue;
            }
            seen += 1;
            let certain = |off: f64, b: f64, eta: f64| {
                let numerator = exactly + DoubleDouble::new(off * U * U * exactly.high());
                let (h, l) = (numerator.high(), numerator.low());
                let reciprocal = Reciprocal::<false>::new(s, 0.0, eta * U * U * s).expect("far from zero");
                let (lower, upper) = reciprocal.times(h, l, (b * U * h).max(l.abs()));
                lower == upper
            };
            // 16 u² to 32 u² for the reciprocal, 8 u b for what the numerator is off, and twice the share of s.
            assert_eq!([4.0, 64.0].map(|off| certain(off, 0.0, 0.0)), [false, true], "{s} {q}");
            assert_eq!([2048.0, 32768.0].map(|off| certain(off, 1024.0, 0.0)), [false, true], "{s} {q}");
            assert_eq!([512.0, 8192.0].map(|off| certain(off, 0.0, 1024.0)), [false, true], "{s} {q}");
        }
        assert!(seen > 50, "{seen}");
    }
}
