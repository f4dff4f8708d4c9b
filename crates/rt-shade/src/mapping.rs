//! Where on a map of the sphere a normal points: longitude and latitude, both in `0..=1`.
//!
//! The formulas of the textbook, `u = 1/2 + atan2(z, x) / 2 pi` and `v = 1/2 - asin(y / |N|) / pi`, lose everything
//! near the seam and the poles, where they subtract nearly equal numbers, and need a normal of length exactly 1.
//! Here both come from the angle in one octant, `atan(smaller / larger) / pi` in `0..=1/4`, which is then counted up or
//! down from the nearest multiple of a quarter turn: nothing cancels, and the length of the normal falls out.
//!
//! ```text
//!            +z                      longitude, seen from above (from +y):
//!        5/8..|..3/4..7/8            u = 1/2 at +x, 3/4 at +z, 1/4 at -z,
//!             |                      and at -x the seam: u = 1 where z = +0, u = 0 where z = -0
//!  seam 0|1 --+-- 1/2  +x
//!             |                      latitude:  v = 0 at +y, 1/2 on the equator, 1 at -y
//!        1/8..|..1/4..3/8
//!            -z
//! ```

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;
use rt_math::exact::{U, mantissa_and_exponent, power_of_two_near_inverse};

use crate::arctangent::arctangent_over_pi;
use crate::double_word::{DoubleWord, fast_two_sum, split};
use crate::power::power_of_two;

/// Returns the texture coordinates `(u, v)`, each in `0..=1`, of an outward normal of any length.
///
/// `u = 1/2 + atan2(z, x) / 2 pi` and `v = 1/2 - asin(y / |N|) / pi` of the exact direction of the three doubles, for
/// every finite normal that is not zero, each with an error below 0.504 ulp (0.754 ulp where the result is
/// subnormal). Signs of zero count as in IEEE 754's `atan2`: the seam `x < 0` is `u = 1` for `z = +0` and `u = 0` for
/// `z = -0`; at the poles `u` is 1/2 for `x = +0`, and for `x = -0` as on the seam. A zero normal has no direction:
/// both coordinates are NaN, and so they are when a component is not finite.
///
/// Only additions, multiplications, divisions and square roots are used: the same bits on every platform.
/// `docs/numerics.md`, section 10, derives the bound.
///
/// ```
/// use glam::DVec3;
/// use rt_shade::sphere_uv;
///
/// assert_eq!(sphere_uv(DVec3::new(2.0, 0.0, 0.0)), (0.5, 0.5));
/// assert_eq!(sphere_uv(DVec3::new(0.0, 1e300, 0.0)), (0.5, 0.0)); // the north pole
/// assert_eq!(sphere_uv(DVec3::new(-1e-300, 0.0, 0.0)), (1.0, 0.5)); // the seam
/// assert_eq!(sphere_uv(DVec3::new(3.0, 0.0, -3.0)), (0.375, 0.5));
/// ```
#[inline]
#[must_use]
pub fn sphere_uv(normal: impl Into<DVec3>) -> (f64, f64) {
    let DVec3 { x, y, z } = normal.into();
    if [x, y, z].into_iter().all(is_moderate) {
        (longitude(x, z), latitude(Hypotenuse::new(x, z), y))
    } else {
        sphere_uv_scaled(x, y, z)
    }
}

/// Returns the coordinates at which a scene's texture is read, for an outward normal of any length.
///
/// Seen from outside, the `u` of [`sphere_uv`] falls from left to right, which would mirror the map. So a texture is
/// read at `1 - u`, or with `mirrored` at `u` itself. `1 - u` is the `u` of the normal with `z` negated, and as exact.
///
/// ```
/// use rt_shade::texture_uv;
///
/// let normal = [1.0, 0.0, 1.0];
/// assert_eq!(texture_uv(normal, true), (0.625, 0.5));
/// assert_eq!(texture_uv(normal, false), (0.375, 0.5));
/// ```
#[must_use]
pub fn texture_uv(normal: impl Into<DVec3>, mirrored: bool) -> (f64, f64) {
    let DVec3 { x, y, z } = normal.into();
    sphere_uv([x, y, if mirrored { z } else { -z }])
}

/// Returns what [`texture_uv`] returns for a normal that may be off by a vector of length `error`, and bounds of the
/// errors of `u` and `v`: infinite or NaN where nothing is known, as `u` is near a pole.
///
/// An angle is off by at most `1.01 e / h` where the direction is off by `e` beside its length `h`; in shares of a turn,
/// and of half a turn, `docs/numerics.md`, section 14, has the proof.
#[must_use]
pub fn texture_uv_within(normal: impl Into<DVec3>, error: f64, mirrored: bool) -> ((f64, f64), (f64, f64)) {
    let normal = normal.into();
    let coordinates = texture_uv(normal, mirrored);
    let h_square = normal.x * normal.x + normal.z * normal.z;
    let length_square = h_square + normal.y * normal.y;
    let largest = normal.abs().max_element();
    if !(1e-100..1e100).contains(&largest) && largest.is_finite() && largest > 0.0 {
        // By a power of two, so that no square leaves the range of f64.
        let factor = power_of_two_near_inverse(largest);
        return (coordinates, texture_uv_within(normal * factor, error * factor, mirrored).1);
    }
    let share = |turns: f64, square: f64| {
        let relative = error / square.sqrt();
        // Beside an axis that a normal may lie on, nothing is said. False for NaN.
        let known = relative <= 1.0 / 16.0 && square > 1e-240;
        if known { turns * relative + 1.1 * U } else { f64::INFINITY }
    };
    (coordinates, (share(0.161, h_square), share(0.322, length_square)))
}

/// Says whether `|v|` is in `2^-200 .. 2^201`, where no square and no quotient leaves the range of a double.
#[inline]
fn is_moderate(v: f64) -> bool {
    (1023 - 200..=1023 + 200).contains(&(v.to_bits() >> 52 & 0x7ff))
}

/// Returns `u`, for coordinates that are moderate or zero, and not both zero.
#[inline]
fn longitude(x: f64, z: f64) -> f64 {
    /// The multiple of a quarter turn to count from, by `z < 0`, `x < 0` and `|x| < |z|`, and which way.
    const FROM: [(f64, f64); 8] =
        [(0.5, 0.5), (0.75, -0.5), (1.0, -0.5), (0.75, 0.5), (0.5, -0.5), (0.25, 0.5), (0.0, 0.5), (0.25, -0.5)];
    let (x_abs, z_abs) = (x.abs(), z.abs());
    let angle = arctangent_over_pi(x_abs.min(z_abs), x_abs.max(z_abs));
    let octant =
        4 * usize::from(z.is_sign_negative()) + 2 * usize::from(x.is_sign_negative()) + usize::from(x_abs < z_abs);
    let (from, sign) = FROM[octant];
    count_from(from, sign, angle, 0.0)
}

/// Returns `v` for the distance `h` from the axis and the height `y`; each is moderate or zero, and not both are zero.
#[inline]
fn latitude(h: Hypotenuse, y: f64) -> f64 {
    /// What to count from, by `y < 0` and `|y| < h`, and which way.
    const FROM: [(f64, f64); 4] = [(0.0, 1.0), (0.5, -1.0), (1.0, -1.0), (0.5, 1.0)];
    let Hypotenuse { rounded: h, remainder } = h;
    let y_abs = y.abs();
    let angle = arctangent_over_pi(y_abs.min(h), y_abs.max(h));
    // The exact distance is longer than h by remainder / 2h, and the derivative of atan(h / y) by h is y / (h^2 + y^2).
    let correction = remainder * (y * (0.5 * FRAC_1_PI) / (h * (h * h + y * y)));
    let (from, sign) = FROM[2 * usize::from(y.is_sign_negative()) + usize::from(y_abs < h)];
    count_from(from, sign, angle, correction)
}

/// Returns `from + share angle + correction`, where `share` is a power of two or its negative: only the last sum has a
/// rounding error that counts.
#[inline]
fn count_from(from: f64, share: f64, angle: DoubleWord, correction: f64) -> f64 {
    let sum = fast_two_sum(from, share * angle.hi);
    sum.hi + (sum.lo + (share * angle.lo + correction))
}

/// The length of a vector in the plane: the double next to it, and what its square leaves of the exact square.
struct Hypotenuse {
    rounded: f64,
    remainder: f64,
}

impl Hypotenuse {
    /// Returns the length of `(x, z)`, for coordinates that are moderate, or negligible beside the other.
    #[inline]
    fn new(x: f64, z: f64) -> Self {
        let (x, z) = (x.abs(), z.abs());
        let (a, b) = if x < z { (z, x) } else { (x, z) };
        let h = (a * a + b * b).sqrt();
        // a^2 + b^2 - h^2, from exact products of the halves: first the large ones, then the crossed, then the small.
        let ((a_top, a_rest), (b_top, b_rest), (h_top, h_rest)) = (split(a), split(b), split(h));
        let large = fast_two_sum(a_top * a_top, b_top * b_top);
        let crossed = 2.0 * ((a_top * a_rest + b_top * b_rest) - h_top * h_rest);
        let small = (a_rest * a_rest + b_rest * b_rest) - h_rest * h_rest;
        Self { rounded: h, remainder: (large.hi - h_top * h_top) + (large.lo + (crossed + small)) }
    }
}

/// [`sphere_uv`] for what the fast path refuses: zeros, extreme exponents, and what has no direction.
#[cold]
fn sphere_uv_scaled(x: f64, y: f64, z: f64) -> (f64, f64) {
    let zero = x == 0.0 && y == 0.0 && z == 0.0;
    if zero || !(x.is_finite() && y.is_finite() && z.is_finite()) {
        return (f64::NAN, f64::NAN);
    }
    if x == 0.0 && z == 0.0 {
        // A pole. Any length of x does: its sign and z's decide.
        return (longitude(1f64.copysign(x), z), if y > 0.0 { 0.0 } else { 1.0 });
    }
    let ((x, x_exponent), (y, y_exponent), (z, z_exponent)) = (normalized(x), normalized(y), normalized(z));

    // Each quotient is taken between numbers whose exponents differ by 200 at most. What is cut off only shows where
    // the small angle itself is the result; it is then proportional to the quotient, and scaled back.
    let difference = if x == 0.0 || z == 0.0 { 0 } else { z_exponent - x_exponent };
    let kept = difference.clamp(-200, 200);
    let u = scale_if_tiny(longitude(x, scale(z, kept)), -(difference - kept).abs());

    let exponent = x_exponent.max(z_exponent);
    let h = Hypotenuse::new(scale(x, x_exponent - exponent), scale(z, z_exponent - exponent));
    let difference = if y == 0.0 { 0 } else { y_exponent - exponent };
    let kept = difference.clamp(-200, 200);
    let v = scale_if_tiny(latitude(h, scale(y, kept)), -(difference - kept).abs());
    (u, v)
}

/// Returns `share 2^e` if the share is that of a tiny angle, counted from zero; other shares are at least 1/8.
fn scale_if_tiny(share: f64, e: i32) -> f64 {
    if share < 0.125 { scale(share, e) } else { share }
}

/// Returns `(m, e)` with `v = m 2^e` and `|m|` in `1..2`; a zero stays as it is, with the least exponent.
fn normalized(v: f64) -> (f64, i32) {
    if v == 0.0 { (v, -1074) } else { mantissa_and_exponent(v) }
}

/// Returns `v 2^e`, rounded once at most, for `e <= 200` and `|v|` in `2^-210 .. 2`, or zero.
fn scale(v: f64, e: i32) -> f64 {
    if e >= -700 {
        return v * power_of_two(e);
    }
    // Down to 2^-910 exactly, then below the smallest number in one step.
    v * power_of_two(-700) * power_of_two((e + 700).max(-1022))
}

#[cfg(test)]
mod tests {
    use oracle::{ulps, uv};
    use proptest::prelude::*;

    use super::*;

    /// What `docs/numerics.md` proves: half an ulp for the last rounding, and 2^-8 for all that goes before.
    const BOUND: f64 = 0.5 + 1.0 / 256.0;

    fn check(normal: DVec3) {
        let (u, v) = sphere_uv(normal);
        let [exact_u, exact_v] = uv(normal);
        for (name, computed, exact) in [("u", u, &exact_u), ("v", v, &exact_v)] {
            assert!((0.0..=1.0).contains(&computed), "{name} = {computed:e} of {normal:?}");
            // A subnormal result is rounded twice: the first time by at most a quarter of its last place.
            let bound = if computed < f64::MIN_POSITIVE { BOUND + 0.25 } else { BOUND };
            let error = ulps(computed, exact);
            assert!(error <= bound, "{name} = {computed:e} of {normal:?} is {error} ulp away");
        }
    }

    /// A number of either sign, with its exponent anywhere in the range.
    fn any_exponent() -> impl Strategy<Value = f64> {
        any::<u64>().prop_map(f64::from_bits).prop_filter("finite", |x| x.is_finite())
    }

    fn unit() -> impl Strategy<Value = f64> {
        -1.0..1.0
    }

    /// A number and a few of its neighbours.
    fn near(x: f64) -> impl Strategy<Value = f64> {
        (-3i64..=3).prop_map(move |step| f64::from_bits(x.to_bits().wrapping_add_signed(step)))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(1000))]

        #[test]
        fn uv_is_within_the_bound_for_ordinary_normals(x in unit(), y in unit(), z in unit()) {
            check(DVec3::new(x, y, z));
        }

        #[test]
        fn uv_is_within_the_bound_for_any_finite_normal(x in any_exponent(), y in any_exponent(), z in any_exponent()) {
            check(DVec3::new(x, y, z));
        }

        #[test]
        fn uv_is_within_the_bound_near_each_axis(axis in 0usize..3, tiny in -320..0, a in unit(), b in unit(), c in unit()) {
            let mut normal = [a, b, c].map(|x| x * 10f64.powi(tiny));
            normal[axis] = if a > 0.0 { b } else { 1.0 };
            prop_assume!(normal != [0.0; 3]);
            check(DVec3::from_array(normal));
        }

        #[test]
        fn uv_is_within_the_bound_near_each_limit_of_the_table(
            k in 1usize..=64,
            x in 0.5..1.0,
            nudge in near(1.0),
            signs in 0..8,
            swap in any::<bool>(),
            scale in -1000..1000,
        ) {
            // z / x next to k/64: every second one is where the nearest multiple of 1/32 changes.
            let z: f64 = x * k as f64 / 64.0 * nudge;
            let (x, z) = if swap { (z, x) } else { (x, z) };
            let sign = |bit: i32| if signs >> bit & 1 == 1 { -1.0 } else { 1.0 };
            let normal = DVec3::new(x * sign(0), x.hypot(z) * (k as f64 / 64.0) * sign(1), z * sign(2));
            check(normal);
            check(normal * 2f64.powi(scale));
        }

        #[test]
        fn uv_is_within_the_bound_for_subnormal_normals(x in -9i64..9, y in -9i64..9, z in -9i64..9, huge in 0..8) {
            prop_assume!((x, y, z) != (0, 0, 0));
            let length = |units: i64, bit: i32| {
                let huge = if huge >> bit & 1 == 1 { f64::MAX / 16.0 } else { f64::from_bits(1) };
                units as f64 * huge
            };
            check(DVec3::new(length(x, 0), length(y, 1), length(z, 2)));
        }

        #[test]
        fn the_length_of_a_normal_does_not_matter(x in unit(), y in unit(), z in unit(), e in -900..1000) {
            let normal = DVec3::new(x, y, z);
            let scaled = normal * 2f64.powi(e);
            // Only a power of two keeps the direction exactly, and only without underflow.
            prop_assume!(normal.to_array().iter().all(|c| (c * 2f64.powi(e)).abs() > 1e-290));
            prop_assert_eq!(sphere_uv(normal), sphere_uv(scaled));
        }

        #[test]
        fn the_scenes_reading_is_one_minus_u(x in unit(), y in unit(), z in unit()) {
            let normal = DVec3::new(x, y, z);
            let ((raw, v), (read, same_v)) = (texture_uv(normal, true), texture_uv(normal, false));
            prop_assert_eq!(v, same_v);
            prop_assert!((raw + read - 1.0).abs() <= f64::EPSILON, "{} + {}", raw, read);
        }
    }

    #[test]
    fn poles_equator_and_seam_are_exact() {
        for length in [f64::from_bits(1), 1e-300, 0.1, 1.0, 3e7, f64::MAX] {
            let uv = |x: f64, y: f64, z: f64| sphere_uv(DVec3::new(x, y, z) * length);
            for (zero, u_seam) in [(0.0, 1.0), (-0.0, 0.0)] {
                assert_eq!(uv(0.0, 1.0, zero), (0.5, 0.0), "north pole, length {length:e}");
                assert_eq!(uv(0.0, -1.0, zero), (0.5, 1.0), "south pole, length {length:e}");
                assert_eq!(uv(-0.0, 1.0, zero), (u_seam, 0.0), "north pole on the seam, length {length:e}");
                assert_eq!(uv(-1.0, 0.0, zero), (u_seam, 0.5), "seam, length {length:e}");
                assert_eq!(uv(1.0, zero, zero), (0.5, 0.5), "opposite the seam, length {length:e}");
            }
            assert_eq!(uv(0.0, 0.0, 1.0), (0.75, 0.5), "+z, length {length:e}");
            assert_eq!(uv(0.0, 0.0, -1.0), (0.25, 0.5), "-z, length {length:e}");
            assert_eq!(uv(1.0, 0.0, 1.0).0, 0.625, "+x +z, length {length:e}");
            assert_eq!(uv(-1.0, 0.0, -1.0).0, 0.125, "-x -z, length {length:e}");
        }
    }

    #[test]
    fn a_normal_without_direction_has_no_coordinates() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for normal in [DVec3::new(bad, 1.0, 1.0), DVec3::new(0.0, bad, 0.0), DVec3::new(1.0, 0.0, bad)] {
                let (u, v) = sphere_uv(normal);
                assert!(u.is_nan() && v.is_nan(), "{normal:?} gave {u}, {v}");
            }
        }
        let (u, v) = sphere_uv(DVec3::ZERO);
        assert!(u.is_nan() && v.is_nan(), "zero gave {u}, {v}");
    }

    /// The bounds hold what an exact normal loses, and what the worst direction of an error does; neither is much more.
    #[test]
    fn coordinates_within_errors_are_bounded_and_hardly_more() {
        let mut random = oracle::Random::new(5);
        let (mut worst, mut sharpest) = (0.0f64, [0.0f64; 2]);
        for _ in 0..oracle::cases(20_000) {
            let normal = random.point();
            let ((u, v), bounds) = texture_uv_within(normal * random.power(-300..300), 0.0, true);
            for ((x, exact), bound) in [u, v].into_iter().zip(uv(normal)).zip([bounds.0, bounds.1]) {
                let off = (oracle::exact(x) - exact).to_f64().value().abs();
                assert!(off <= bound && bound < 2.0 * U, "{normal:?}: {x} is {off:e} off, {bound:e}");
                worst = worst.max(off / bound);
            }

            let size = normal.length() * random.power(-30..-10);
            let h = DVec3::new(normal.x, 0.0, normal.z);
            let around = size * DVec3::new(-normal.z, 0.0, normal.x).normalize();
            let along = size * (normal.y * h - h.length_squared() * DVec3::Y).normalize();
            for (i, wrong) in [around, along].into_iter().enumerate() {
                let (found, bounds) = texture_uv_within(normal + wrong, 1.000_001 * size, true);
                let (off, bound) = [((found.0 - u).abs(), bounds.0), ((found.1 - v).abs(), bounds.1)][i];
                // Across the seam `u` jumps; beside a pole it is not known.
                if off < 0.5 && bound.is_finite() {
                    assert!(off <= bound + 2.0 * U, "{normal:?} {wrong:?}: {off:e} off, {bound:e}");
                    sharpest[i] = sharpest[i].max(off / bound);
                    assert!(off > 0.9 * bound - 4.0 * U || bound > 1e-4, "{normal:?} {wrong:?}: {off:e}, {bound:e}");
                }
            }
        }
        assert!(worst > 0.4 && sharpest.iter().all(|&share| share > 0.9), "{worst} {sharpest:?}");
    }

    #[test]
    fn coordinates_are_known_up_to_the_ends_that_the_proof_needs() {
        let known = |normal: [f64; 3], error: f64| {
            let (u, v) = texture_uv_within(DVec3::from_array(normal), error, false).1;
            [u, v].map(f64::is_finite)
        };
        assert_eq!([0.06, 0.065].map(|error| known([1.0, 0.0, 0.0], error)), [[true; 2], [false; 2]]);
        assert_eq!([1.1e-120, 0.9e-120].map(|h| known([h, 1.0, 0.0], 0.0)), [[true; 2], [false, true]]);
        for length in [1e-320, 1e-150, 1e-99, 1e99, 1e150, f64::MAX] {
            assert_eq!(known([length, length, 0.0], 0.0), [true; 2], "{length:e}");
        }
    }
}
