//! The sign of a dot product: on which side of a plane a direction or a point lies.
//!
//! A filter in plain doubles decides unless the terms cancel to their last bits; then fixed-point numbers do, where
//! the numbers lie in a window, and integers of any size elsewhere.

use core::cmp::Ordering;

use glam::DVec3;

use super::stage::{Stage, decided};
use super::{Dyadic, Fixed, Window, bits_spanned, power_of_two, vector};

/// Bound of the error of a dot product: this part of the sum of the magnitudes of its terms; `3.01 * 2^-53` is proved.
const ERROR: f64 = power_of_two(-51);
/// The same where one factor is a rounded difference; `4.01 * 2^-53` is proved.
const DIFFERENCE_ERROR: f64 = power_of_two(-50);
/// ... and an absolute one for terms that underflow; `2^-1073` is proved.
const ERROR_FLOOR: f64 = f64::MIN_POSITIVE;

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
    filter_sign(dot_with_error(a, b)).or_else(|| exact_sign(a, DVec3::ZERO, b))
}

/// Returns the sign of `(a - b) . n`, exact for all finite vectors, also where the difference rounds or overflows;
/// `None` if a component is infinite or NaN.
///
/// It tells on which side of the plane through `b` with the normal `n` the point `a` lies: `Greater` on the side to
/// which the normal points, `Equal` in the plane (everywhere, if the normal is zero).
///
/// ```
/// use core::cmp::Ordering;
/// use glam::DVec3;
/// use rt_math::exact::{difference_dot_sign, dot_sign};
///
/// // a - b rounds to (0.5, 0.5, 0), and so into the plane
/// let (a, b) = (DVec3::new(0.5, 0.5, 0.0), DVec3::new(1e-30, 0.0, 0.0));
/// let n = DVec3::new(1.0, -1.0, 0.0);
/// assert_eq!(dot_sign(a - b, n), Some(Ordering::Equal));
/// assert_eq!(difference_dot_sign(a, b, n), Some(Ordering::Less));
/// ```
#[inline]
#[must_use]
pub fn difference_dot_sign(a: DVec3, b: DVec3, n: DVec3) -> Option<Ordering> {
    filter_sign(sum_with_error((a - b) * n, DIFFERENCE_ERROR)).or_else(|| exact_sign(a, b, n))
}

/// Returns the rounded `a . b` and a bound of its error; where something overflows the bound is no smaller than the
/// value, or NaN.
///
/// `docs/numerics.md`, section 1, has the proof.
#[inline(always)]
#[must_use]
pub fn dot_with_error(a: DVec3, b: DVec3) -> (f64, f64) {
    sum_with_error(a * b, ERROR)
}

/// The rounded sum of the terms, and `error` of the sum of their magnitudes with what may underflow.
// Modelled in docs/proofs/Dot.v: sum3, sum_with_error.
#[inline(always)]
fn sum_with_error(terms: DVec3, error: f64) -> (f64, f64) {
    let size = (terms.x.abs() + terms.y.abs()) + terms.z.abs();
    ((terms.x + terms.y) + terms.z, size * error + ERROR_FLOOR)
}

/// The sign of a value that is larger than the bound of its error; NaN has none.
#[inline(always)]
fn filter_sign((value, error): (f64, f64)) -> Option<Ordering> {
    if value > error {
        decided(Stage::Filter);
        Some(Ordering::Greater)
    } else if value < -error {
        decided(Stage::Filter);
        Some(Ordering::Less)
    } else {
        None
    }
}

/// The sign of `(a - b) . n`; slow path, always decides.
#[cold]
#[inline(never)]
fn exact_sign(a: DVec3, b: DVec3, n: DVec3) -> Option<Ordering> {
    if let Some(sign) = fixed_sign::<1, 2>(a, b, n).or_else(|| fixed_sign::<2, 4>(a, b, n)) {
        decided(Stage::Fixed);
        return Some(sign);
    }
    if !(a.is_finite() && b.is_finite() && n.is_finite()) {
        return None;
    }
    decided(Stage::Integers);
    // Three terms, each a difference times a number; two limbs for the ends.
    let bits = bits_spanned(&[a.x, a.y, a.z, b.x, b.y, b.z]) + 1 + bits_spanned(&n.to_array()) + 2;
    Some(if bits <= 64 * 14 {
        sized_sign::<16>(a, b, n)
    } else {
        sized_sign::<68>(a, b, n) // of any doubles: a multiple of 2^-2148 below 2^2051
    })
}

/// The sign in fixed-point numbers, where the points lie in one window and the normal in another: coordinates of `N`
/// limbs, the product of `S = 2 N`.
#[inline(always)]
fn fixed_sign<const N: usize, const S: usize>(a: DVec3, b: DVec3, n: DVec3) -> Option<Ordering> {
    let points = Window::<N>::around(&[a.x, a.y, a.z, b.x, b.y, b.z])?;
    let normal = Window::<N>::around(&n.to_array())?;
    let difference = vector::minus(&points.vector(a), &points.vector(b));
    let product: Fixed<S> = vector::dot(&difference, &normal.vector(n));
    Some(product.sign())
}

fn sized_sign<const LIMBS: usize>(a: DVec3, b: DVec3, n: DVec3) -> Ordering {
    let n = n.to_array().map(Dyadic::<LIMBS>::from_f64);
    vector::dot(&vector::difference::<Dyadic<LIMBS>>(a, b), &n).sign()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::stage::decisions;
    use oracle::{Random, cases, exact};

    /// Checks a class of pairs against exact rational arithmetic; returns how often filter, fixed-point numbers and
    /// integers decided.
    fn check_class(seed: u64, mut vectors: impl FnMut(&mut Random) -> [[f64; 3]; 2]) -> [usize; 3] {
        let mut rng = Random::new(seed);
        let mut total = [0; 3];
        for _ in 0..cases(1_000_000) {
            let [a, b] = vectors(&mut rng);
            decisions();
            let found = dot_sign(a.into(), b.into());
            let [filter, .., fixed, integers] = decisions();
            total = [total[0] + filter, total[1] + fixed, total[2] + integers];
            let sum = (0..3).map(|i| exact(a[i]) * exact(b[i])).fold(exact(0.0), |sum, term| sum + term);
            assert_eq!(found, Some(sum.cmp(&exact(0.0))), "{a:?} . {b:?}");
        }
        total
    }

    #[test]
    fn benign_vectors_are_decided_by_the_filter() {
        let [filter, fixed, integers] = check_class(70, |rng| [[0; 3]; 2].map(|v| v.map(|_| rng.with_exponent(-4..2))));
        assert!(filter > 1000 * (fixed + integers + 1), "{filter} {fixed} {integers}");
    }

    #[test]
    fn vectors_of_any_doubles_have_their_sign() {
        let [filter, _, integers] = check_class(71, |rng| [[0; 3]; 2].map(|v| v.map(|_| rng.finite())));
        assert!(filter > 100 && integers > 100, "{filter} {integers}");
    }

    #[test]
    fn nearly_perpendicular_vectors_have_their_sign() {
        let [filter, fixed, _] = check_class(72, |rng| {
            let n = [0; 3].map(|_| rng.with_exponent(-4..4));
            let [x, y] = [0; 2].map(|_| rng.with_exponent(-4..4));
            let z = -(x * n[0] + y * n[1]) / n[2];
            [[x, y, f64::from_bits(z.to_bits() + rng.below(8) as u64)], n]
        });
        assert!(filter > 10 && fixed > 1_000, "{filter} {fixed}");
    }

    #[test]
    fn exactly_perpendicular_vectors_have_none() {
        let [_, fixed, integers] = check_class(73, |rng| {
            let small = [0; 3].map(|_| f64::from(rng.integer(-1000..1000)) * 2f64.powi(rng.integer(-400..400)));
            // halves of a cross product: x y - y x + 0 z
            [small, [-small[1], small[0], 0.0]]
        });
        assert!(fixed > 100 && integers > 1_000, "{fixed} {integers}");
        assert_eq!(dot_sign(DVec3::X, DVec3::Y), Some(Ordering::Equal));
    }

    #[test]
    fn terms_that_overflow_or_underflow_have_their_sign() {
        let [.., integers] = check_class(74, |rng| {
            let range = if rng.below(2) == 0 { 500..1024 } else { -1074..-500 };
            [[0; 3]; 2].map(|v| v.map(|_| rng.with_exponent(range.clone())))
        });
        assert!(integers > 1_000, "{integers}");
    }

    /// Checks a class of `(a - b) . n` against exact rational arithmetic; returns how often filter, fixed-point
    /// numbers and integers decided.
    fn check_differences(seed: u64, mut vectors: impl FnMut(&mut Random) -> [[f64; 3]; 3]) -> [usize; 3] {
        let mut rng = Random::new(seed);
        let mut total = [0; 3];
        for _ in 0..cases(1_000_000) {
            let [a, b, n] = vectors(&mut rng);
            decisions();
            let found = difference_dot_sign(a.into(), b.into(), n.into());
            let [filter, .., fixed, integers] = decisions();
            total = [total[0] + filter, total[1] + fixed, total[2] + integers];
            let sum =
                (0..3).map(|i| (exact(a[i]) - exact(b[i])) * exact(n[i])).fold(exact(0.0), |sum, term| sum + term);
            assert_eq!(found, Some(sum.cmp(&exact(0.0))), "({a:?} - {b:?}) . {n:?}");
        }
        total
    }

    #[test]
    fn points_well_off_a_plane_are_decided_by_the_filter() {
        let [filter, fixed, integers] =
            check_differences(75, |rng| [[0; 3]; 3].map(|v| v.map(|_| rng.with_exponent(-4..2))));
        assert!(filter > 1000 * (fixed + integers + 1), "{filter} {fixed} {integers}");
    }

    #[test]
    fn points_of_any_doubles_have_their_side() {
        let [filter, _, integers] = check_differences(76, |rng| [[0; 3]; 3].map(|v| v.map(|_| rng.finite())));
        assert!(filter > 100 && integers > 100, "{filter} {integers}");
    }

    #[test]
    fn points_near_a_plane_have_their_side_at_any_offset_and_scale() {
        let [filter, fixed, integers] = check_differences(77, |rng| {
            let scale = 2f64.powi(rng.integer(-900..900));
            let offset = scale * 2f64.powi(rng.integer(-60..60));
            let n = [0; 3].map(|_| rng.with_exponent(-60..60));
            let b = [0; 3].map(|_| offset * rng.with_exponent(-4..4));
            let [x, y] = [0; 2].map(|_| scale * rng.with_exponent(-4..4));
            let z = -(x * n[0] + y * n[1]) / n[2];
            let z = f64::from_bits((b[2] + z).to_bits() + rng.below(4) as u64);
            [[b[0] + x, b[1] + y, z], b, n]
        });
        assert!(filter > 10 && fixed > 1_000 && integers > 1_000, "{filter} {fixed} {integers}");
    }

    #[test]
    fn points_exactly_in_a_plane_have_no_side() {
        let mut rng = Random::new(78);
        for _ in 0..cases(1_000_000) {
            // all corners are multiples of one unit below 2^30 of it, and so is the normal of two edges, in its square
            let scale = 2f64.powi(rng.integer(-400..400));
            let [a, b, e, f] = [[0; 3]; 4].map(|v| DVec3::from_array(v.map(|_| f64::from(rng.integer(-1000..1000)))));
            let n = e.cross(f) * 2f64.powi(rng.integer(-400..400));
            let [s, t] = [0; 2].map(|_| f64::from(rng.integer(-1000..1000)));
            let [in_plane, b] = [(b + s * e + t * f) * scale, b * scale];
            assert_eq!(difference_dot_sign(in_plane, b, n), Some(Ordering::Equal), "{in_plane:?} {b:?} {n:?}");
            assert_eq!(difference_dot_sign(a, a, n), Some(Ordering::Equal), "the point itself, {a:?} {n:?}");
            assert_eq!(difference_dot_sign(a, b, DVec3::ZERO), Some(Ordering::Equal), "no normal, {a:?} {b:?}");
        }
    }

    #[test]
    fn differences_that_overflow_or_underflow_have_their_sign() {
        let [_, fixed, _] = check_differences(79, |rng| {
            let range = if rng.below(2) == 0 { 1019..1024 } else { -1074..-1000 };
            let n = if rng.below(2) == 0 { -4..4 } else { range.clone() };
            [range.clone(), range, n].map(|range| [0; 3].map(|_| rng.with_exponent(range.clone())))
        });
        assert!(fixed > 1_000, "{fixed}");
        let top = DVec3::splat(f64::MAX);
        assert_eq!(difference_dot_sign(top, -top, DVec3::ONE), Some(Ordering::Greater));
        assert_eq!(difference_dot_sign(top, -top, DVec3::new(1.0, -1.0, 0.0)), Some(Ordering::Equal));
        let least = DVec3::splat(f64::from_bits(1));
        assert_eq!(difference_dot_sign(least, DVec3::ZERO, -least), Some(Ordering::Less));
    }

    #[test]
    fn terms_that_round_to_the_least_doubles_have_their_sign() {
        // products of about 2^-1074: what rounding leaves of them says nothing about their sum
        let vectors = |rng: &mut Random| [[0; 3]; 2].map(|v| v.map(|_| rng.with_exponent(-539..-535)));
        let [_, fixed, _] = check_class(80, vectors);
        assert!(fixed > 1_000, "{fixed}");
        let [_, fixed, _] = check_differences(81, |rng| {
            let [a, n] = vectors(rng);
            [a, [0; 3].map(|_| rng.with_exponent(-539..-535)), n]
        });
        assert!(fixed > 1_000, "{fixed}");
    }

    #[test]
    fn numbers_at_the_ends_of_each_range_fit() {
        for (seed, end) in [(82, 63), (83, 64), (84, 65), (85, 195), (86, 198), (87, 1022)] {
            let [.., integers] = check_differences(seed, |rng| {
                // the large terms cancel, and the small one decides; 16 limbs are shown to do up to 2^195
                let [p, q] = [0; 2].map(|_| rng.with_exponent(end - 3..end + 1));
                let [r, s, t] = [0; 3].map(|_| rng.with_exponent(-end - 1..-end + 3));
                [[p, r, q], [-p, s, -q], [q, t, -p]]
            });
            assert!(integers > 1_000, "{integers} at 2^{end}");
        }
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
                assert_eq!(difference_dot_sign(wrong, DVec3::X, DVec3::Y), None);
                assert_eq!(difference_dot_sign(DVec3::X, wrong, DVec3::Y), None);
                assert_eq!(difference_dot_sign(DVec3::X, DVec3::Y, wrong), None);
            }
        }
    }
}
