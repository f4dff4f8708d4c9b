//! The sign of a dot product: on which side of a plane a direction points.
//!
//! A filter in plain doubles decides unless the terms cancel to their last bits; exact integers decide then.

use core::cmp::Ordering;

use glam::DVec3;

use super::stage::{Stage, decided};
use super::{Dyadic, power_of_two};

/// Bound of the error of a dot product: this part of the sum of the magnitudes of its terms; `3.01 * 2^-53` is proved.
const ERROR: f64 = power_of_two(-51);
/// ... and an absolute one for terms that underflow; `2^-1073` is proved.
const ERROR_FLOOR: f64 = f64::MIN_POSITIVE;

/// Products of two doubles are multiples of 2^-2148, and three of them sum to less than 2^2050.
type Integer = Dyadic<68>;

/// Returns the sign of `a . b`, exact for all finite vectors; `None` if a component is infinite or NaN.
///
/// ```
/// use core::cmp::Ordering;
/// use glam::DVec3;
/// use rt_math::exact::dot_sign;
///
/// // 1e-30 is lost when the terms are summed one after the other
/// let (a, b) = (DVec3::new(1.0, 1e-30, 1.0), DVec3::new(1.0, 1.0, -1.0));
/// assert_eq!(a.dot(b), 0.0);
/// assert_eq!(dot_sign(a, b), Some(Ordering::Greater));
/// ```
#[inline]
#[must_use]
pub fn dot_sign(a: DVec3, b: DVec3) -> Option<Ordering> {
    let (value, error) = dot_with_error(a, b);
    if value > error {
        decided(Stage::Filter);
        Some(Ordering::Greater)
    } else if value < -error {
        decided(Stage::Filter);
        Some(Ordering::Less)
    } else {
        integer_sign(a, b)
    }
}

/// Returns the rounded `a . b` and a bound of its error; where something overflows the bound is no smaller than the value,
/// or NaN.
///
/// `docs/numerics.md`, section 1, has the proof.
#[inline(always)]
#[must_use]
pub fn dot_with_error(a: DVec3, b: DVec3) -> (f64, f64) {
    let terms = a * b;
    let size = (terms.x.abs() + terms.y.abs()) + terms.z.abs();
    ((terms.x + terms.y) + terms.z, size * ERROR + ERROR_FLOOR)
}

#[cold]
#[inline(never)]
fn integer_sign(a: DVec3, b: DVec3) -> Option<Ordering> {
    if !(a.is_finite() && b.is_finite()) {
        return None;
    }
    decided(Stage::Integers);
    let [a, b] = [a, b].map(|v| v.to_array().map(Integer::from_f64));
    Some((&a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]).sign())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::stage::decisions;
    use crate::oracle::{Rng, cases, exact};

    /// Checks a class of pairs against exact rational arithmetic; returns how often filter and integers decided.
    fn check_class(seed: u64, mut vectors: impl FnMut(&mut Rng) -> [[f64; 3]; 2]) -> [usize; 2] {
        let mut rng = Rng::new(seed);
        let mut total = [0; 2];
        for _ in 0..cases(1_000_000) {
            let [a, b] = vectors(&mut rng);
            decisions();
            let found = dot_sign(a.into(), b.into());
            let [filter, _, integers] = decisions();
            total = [total[0] + filter, total[1] + integers];
            let sum = (0..3).map(|i| exact(a[i]) * exact(b[i])).fold(exact(0.0), |sum, term| sum + term);
            assert_eq!(found, Some(sum.cmp(&exact(0.0))), "{a:?} . {b:?}");
        }
        total
    }

    #[test]
    fn benign_vectors_are_decided_by_the_filter() {
        let [filter, integers] =
            check_class(70, |rng| [[0; 3]; 2].map(|v| v.map(|_| rng.with_exponent(-4..2))));
        assert!(filter > 1000 * (integers + 1), "{filter} {integers}");
    }

    #[test]
    fn vectors_of_any_doubles_have_their_sign() {
        let [filter, integers] = check_class(71, |rng| [[0; 3]; 2].map(|v| v.map(|_| rng.finite())));
        assert!(filter > 100 && integers > 100, "{filter} {integers}");
    }

    #[test]
    fn nearly_perpendicular_vectors_have_their_sign() {
        let [filter, integers] = check_class(72, |rng| {
            let n = [0; 3].map(|_| rng.with_exponent(-4..4));
            let [x, y] = [0; 2].map(|_| rng.with_exponent(-4..4));
            let z = -(x * n[0] + y * n[1]) / n[2];
            [[x, y, f64::from_bits(z.to_bits() + rng.below(8) as u64)], n]
        });
        assert!(filter > 10 && integers > 1_000, "{filter} {integers}");
    }

    #[test]
    fn exactly_perpendicular_vectors_have_none() {
        let [_, integers] = check_class(73, |rng| {
            let small =
                [0; 3].map(|_| f64::from(rng.integer(-1000..1000)) * 2f64.powi(rng.integer(-400..400)));
            // halves of a cross product: x y - y x + 0 z
            [small, [-small[1], small[0], 0.0]]
        });
        assert!(integers > 1_000, "{integers}");
        assert_eq!(dot_sign(DVec3::X, DVec3::Y), Some(Ordering::Equal));
    }

    #[test]
    fn terms_that_overflow_or_underflow_have_their_sign() {
        let [_, integers] = check_class(74, |rng| {
            let range = if rng.below(2) == 0 { 500..1024 } else { -1074..-500 };
            [[0; 3]; 2].map(|v| v.map(|_| rng.with_exponent(range.clone())))
        });
        assert!(integers > 1_000, "{integers}");
    }

    #[test]
    fn what_is_not_finite_has_no_sign() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for i in 0..3 {
                let mut wrong = DVec3::new(1.0, 2.0, 3.0);
                wrong[i] = bad;
                assert_eq!(dot_sign(wrong, DVec3::Y), None);
                assert_eq!(dot_sign(DVec3::Y, wrong), None);
                assert_eq!(dot_sign(wrong, wrong), None);
            }
        }
    }
}
