//! The rounding test: does an approximation, with its error bound, decide the correctly rounded double?
//!
//! Named after A. Ziv ("Fast evaluation of elementary mathematical functions with correctly rounded last bit", 1991).
//! If both ends of the interval that holds the exact value round to the same double, so does the exact value,
//! since rounding is monotonic. No midpoint needs to be looked for, and the argument is the same for subnormal
//! results, where the spacing of doubles is fixed: floating-point addition is correctly rounded there as well.

use core::ops::{Add, Sub};

/// Returns the double nearest to `x`, if `h + l` is close enough to `x` to decide it.
///
/// The condition on `error` is `|x - (h + l)| <= error - u (|l| + error)` with `u` = 2⁻⁵³, the second term for the
/// rounding of `l - error` and `l + error`; `h` must be finite. If any argument is NaN the answer is `None`. The sign
/// of a zero result is not meaningful.
///
/// ```
/// use rt_math::exact::round_if_certain;
///
/// let half_ulp = f64::EPSILON / 2.0;
/// assert_eq!(round_if_certain(1.0, half_ulp, 1e-25), None); // too near a midpoint
/// assert_eq!(round_if_certain(1.0, 0.9 * half_ulp, 1e-25), Some(1.0));
/// ```
#[inline(always)]
#[must_use]
pub fn round_if_certain(h: f64, l: f64, error: f64) -> Option<f64> {
    let (lower, upper) = rounded_ends(h, l, error);
    (lower == upper).then_some(upper)
}

/// Returns the lower and the upper end of the interval of [`round_if_certain`], rounded: where they are equal, so is
/// the nearest double. For tests of several values at once, without a branch for each, or of vectors of doubles.
#[inline(always)]
#[must_use]
pub fn rounded_ends<T: Copy + Add<Output = T> + Sub<Output = T>>(h: T, l: T, error: T) -> (T, T) {
    (h + (l - error), h + (l + error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use oracle::{Random, exact, rounded};

    #[test]
    fn what_is_certain_is_the_nearest_double() {
        let mut rng = Random::new(5);
        let mut certain = [0; 2];
        for _ in 0..10_000 {
            let exponent = [-1074..-1000, -1000..1000, 1000..1024][rng.below(3)].clone();
            let h = rng.with_exponent(exponent);
            let l = h * rng.with_exponent(-56..-52);
            let error = h.abs() * rng.with_exponent(-80..-53).abs();
            let slack = error - 2f64.powi(-53) * (l.abs() + error);
            if slack < 0.0 {
                continue;
            }
            for x in [exact(h) + exact(l) - exact(slack), exact(h) + exact(l) + exact(slack)] {
                match round_if_certain(h, l, error) {
                    Some(found) => {
                        certain[1] += 1;
                        assert_eq!(found, rounded(&x), "{h:e} {l:e} {error:e}");
                    }
                    None => certain[0] += 1,
                }
            }
        }
        assert!(certain[0] > 1_000 && certain[1] > 1_000, "{certain:?}");
    }

    #[test]
    fn not_a_number_is_never_certain() {
        for (h, l, error) in [(f64::NAN, 0.0, 0.0), (1.0, f64::NAN, 0.0), (1.0, 0.0, f64::NAN)] {
            assert_eq!(round_if_certain(h, l, error), None);
        }
    }
}
