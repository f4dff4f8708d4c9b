//! Error-free transformations: a sum or product of two doubles as the rounded result and its exact error.
//!
//! Each returns `(value, error)` with `value` the correctly rounded result and `value + error` the exact one. The
//! sums hold for all finite operands whose sum does not overflow; the product in the range stated there. Sums and
//! [`two_prod_with`] take vectors of doubles as well, and do the same in every lane.

use core::ops::{Add, Mul, Neg, Sub};

/// 2⁻⁵³, the unit roundoff: the relative error of one rounded operation is at most this.
pub const U: f64 = f64::EPSILON / 2.0;

/// Returns `RN(a + b)` and its error: `a + b = value + error` exactly, unless the sum overflows.
///
/// Source: D. Knuth, "The Art of Computer Programming", vol. 2, section 4.2.2, theorem B.
#[inline(always)]
#[must_use]
pub fn two_sum<T: Copy + Add<Output = T> + Sub<Output = T>>(a: T, b: T) -> (T, T) {
    let value = a + b;
    let b_part = value - a;
    let a_part = value - b_part;
    (value, (a - a_part) + (b - b_part))
}

/// Returns `RN(a - b)` and its error: `a - b = value + error` exactly, unless the difference overflows.
#[inline(always)]
#[must_use]
pub fn two_diff<T: Copy + Add<Output = T> + Sub<Output = T> + Neg<Output = T>>(a: T, b: T) -> (T, T) {
    two_sum(a, -b)
}

/// Returns `RN(a + b)` and its error in half the work of [`two_sum`], if `|a| >= |b|` or `a == 0`.
///
/// More generally it is exact when `a` is a multiple of the last bit of `b`.
///
/// Source: T. J. Dekker, "A floating-point technique for extending the available precision", 1971.
#[inline(always)]
#[must_use]
pub fn fast_two_sum(a: f64, b: f64) -> (f64, f64) {
    let value = a + b;
    (value, b - (value - a))
}

/// Returns `RN(a b)` and its error: `a b = value + error` exactly.
///
/// This holds, with the same bits for either `FMA`, if `|a|` and `|b|` are at most 2⁹⁹⁵, `|a b|` at most 2¹⁰²¹, and
/// `a b` is zero or at least 2⁻⁹⁶⁸ in magnitude (then the error, a multiple of 2⁻¹⁰⁷⁴, is a double). Outside this
/// range the error is not meaningful, and may be NaN.
///
/// With `FMA` the error is one fused multiply-add: one instruction inside a function compiled for it
/// ([`fma_dispatch!`](crate::fma_dispatch)), otherwise a slow library call. Without, each factor is split in halves
/// whose products are exact.
///
/// Source: T. J. Dekker, "A floating-point technique for extending the available precision", 1971 (with G. W.
/// Veltkamp's splitting).
#[inline(always)]
#[must_use]
pub fn two_prod<const FMA: bool>(a: f64, b: f64) -> (f64, f64) {
    two_prod_with::<FMA, _>(
        a,
        b,
        #[inline(always)]
        |a, b, c| a.mul_add(b, -c),
    )
}

/// [`two_prod`] of numbers of any kind, vectors of doubles for one: `fused(a, b, c)` is `a b - c`, rounded once.
#[inline(always)]
#[must_use]
pub fn two_prod_with<const FMA: bool, T>(a: T, b: T, fused: impl FnOnce(T, T, T) -> T) -> (T, T)
where
    T: Copy + Add<Output = T> + Sub<Output = T> + Mul<Output = T> + Mul<f64, Output = T>,
{
    let value: T = a * b;
    if FMA {
        return (value, fused(a, b, value));
    }
    let (a_high, a_low) = split(a);
    let (b_high, b_low) = split(b);
    let error = ((a_high * b_high - value) + a_high * b_low + a_low * b_high) + a_low * b_low;
    (value, error)
}

/// Returns `z - x y`, rounded once, where `z` and `x y` are so close that `z - RN(x y)` is exact.
///
/// That is so if they agree within a factor of 2 (Sterbenz). If the result is a double, as after `x = RN(z / y)` or
/// `x = y = RN(√z)`, it is exact. The range is that of [`two_prod`], and `FMA` means the same as there.
#[inline(always)]
#[must_use]
pub fn remainder<const FMA: bool>(z: f64, x: f64, y: f64) -> f64 {
    if FMA {
        return (-x).mul_add(y, z);
    }
    let (product, error) = two_prod::<FMA>(x, y);
    (z - product) - error
}

/// Splits a double of magnitude at most 2⁹⁹⁵ into two of at most 26 bits each, `a = high + low`.
#[inline(always)]
fn split<T: Copy + Sub<Output = T> + Mul<f64, Output = T>>(a: T) -> (T, T) {
    const FACTOR: f64 = 134_217_729.0; // 2^27 + 1
    let scaled = a * FACTOR;
    let high = scaled - (scaled - a);
    (high, a - high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use oracle::{Random, exact};

    #[test]
    fn sums_are_error_free() {
        let mut rng = Random::new(1);
        for _ in 0..10_000 {
            let (a, b) = (rng.finite(), rng.finite());
            let (value, error) = two_sum(a, b);
            if value.is_finite() {
                assert_eq!(exact(value) + exact(error), exact(a) + exact(b), "{a:e} + {b:e}");
                let (large, small) = if a.abs() >= b.abs() { (a, b) } else { (b, a) };
                assert_eq!(fast_two_sum(large, small), (value, error), "{a:e} + {b:e}");
            }
            let (value, error) = two_diff(a, b);
            if value.is_finite() {
                assert_eq!(exact(value) + exact(error), exact(a) - exact(b), "{a:e} - {b:e}");
            }
        }
    }

    #[test]
    fn products_are_error_free_with_the_same_bits_either_way() {
        let mut rng = Random::new(2);
        let mut in_range = 0;
        for _ in 0..10_000 {
            let (a, b) = (rng.finite(), rng.finite());
            let valid = |x: f64| x.abs() <= 2f64.powi(995);
            let product = (a * b).abs();
            if !(valid(a) && valid(b) && product <= 2f64.powi(1020) && product >= 2f64.powi(-968)) {
                continue;
            }
            in_range += 1;
            let (value, error) = two_prod::<false>(a, b);
            assert_eq!(exact(value) + exact(error), exact(a) * exact(b), "{a:e} * {b:e}");
            let fused = two_prod::<true>(a, b);
            assert_eq!((value.to_bits(), error.to_bits()), (fused.0.to_bits(), fused.1.to_bits()), "{a:e} * {b:e}");
        }
        assert!(in_range > 3_000, "{in_range}");
    }
}
