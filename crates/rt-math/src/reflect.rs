//! Reflection of a vector, correctly rounded.
//!
//! Each component `v_i - k n_i`, with `k = 2 (v·n) / (n·n)`, is computed in double-double: both dot products with the
//! exact errors of their terms, the quotient with its remainder, the difference with its error. Components that cancel
//! are then computed in triple precision. Those that lie too near a midpoint of two doubles, or are out of range, are
//! quotients of exact fixed-point numbers, and of integers of any size where the vectors have components of very
//! different size. A filter in plain doubles before that would decide nothing, since it is the value that is asked for
//! and not a verdict.

use glam::DVec3;

use crate::exact::stage::{Stage, decided};
use crate::exact::vector::dot;
use crate::exact::{
    Dyadic, Fixed, U, Window, bits_spanned, power_of_two, remainder, rounded_ends, two_diff, two_prod, two_sum,
};
use crate::fma_dispatch;

/// Returns `incident` mirrored in the plane through the origin with the given normal: `v - 2 (v·n) / (n·n) n`.
///
/// The normal may have any length but zero. Each component is correctly rounded, for all finite vectors: one beyond the
/// range of doubles is infinite, one that underflows is a zero with the sign of the exact value, and one that is
/// exactly zero is +0.0. With a zero normal, or an infinite or NaN component in either vector, every component is NaN.
/// `docs/numerics.md`, section 4, has the proof.
///
/// ```
/// use rt_math::reflect;
///
/// assert_eq!(reflect([1.0, -1.0, 0.0], [0.0, 5.0, 0.0]).to_array(), [1.0, 1.0, 0.0]);
/// ```
#[must_use]
#[inline]
pub fn reflect(incident: impl Into<DVec3>, normal: impl Into<DVec3>) -> DVec3 {
    let (v, n) = (incident.into(), normal.into());
    dispatch(v.x, v.y, v.z, n.x, n.y, n.z)
}

fma_dispatch! {
    fn dispatch(vx: f64, vy: f64, vz: f64, nx: f64, ny: f64, nz: f64) -> DVec3 = kernel;
}

/// Double-double is used if `n·n` and the sum of the `|v_i n_i|` lie between this and its inverse.
const WINDOW: f64 = power_of_two(500);
/// Bound of the error of component `i`: this part of `|v_i| + |n_i| Σ|v_j n_j| / (n·n)`; 2⁻⁹⁸ is proved.
const ERROR: f64 = power_of_two(-97);
/// ... and an absolute one for what may underflow.
const ERROR_FLOOR: f64 = power_of_two(-800);

#[inline(always)]
fn kernel<const FMA: bool>(vx: f64, vy: f64, vz: f64, nx: f64, ny: f64, nz: f64) -> DVec3 {
    let (v, n) = (DVec3::new(vx, vy, vz), DVec3::new(nx, ny, nz));
    let (lower, upper, in_range) = bounds::<FMA>(v, n);
    if in_range & all_equal(&lower, &upper) {
        decided(Stage::DoubleDouble);
        return DVec3::from_array(upper);
    }
    // What is certain is not computed again.
    let lower = if in_range { lower } else { [f64::NAN; 3] };
    slow_path(v, n, lower, upper)
}

/// Whether triple precision is exact, and worth while: each is zero or in a range where no error term of a product of
/// three underflows, and one has more than 27 bits. Where all have less, components vanish exactly.
#[inline(always)]
fn is_suitable(numbers: &[f64; 6]) -> bool {
    const ORDINARY: core::ops::RangeInclusive<f64> = power_of_two(-100)..=power_of_two(100);
    let in_range = numbers.iter().fold(true, |all, x| all & ((*x == 0.0) | ORDINARY.contains(&x.abs())));
    in_range && numbers.iter().fold(0, |bits, x| bits | x.to_bits()) << 38 != 0
}

#[inline(always)]
fn all_equal(lower: &[f64; 3], upper: &[f64; 3]) -> bool {
    (lower[0] == upper[0]) & (lower[1] == upper[1]) & (lower[2] == upper[2])
}

/// A lower and an upper bound of each component, rounded: where they are equal, so is the component. That holds if the
/// last value says so: the vectors are in the range of double-double.
#[inline(always)]
fn bounds<const FMA: bool>(incident: DVec3, normal: DVec3) -> ([f64; 3], [f64; 3], bool) {
    // Modelled in docs/proofs/Reflect.v, by the same letters.
    let (v, n) = (incident.to_array(), normal.to_array());
    let [(vn, vn_low, size), (nn, nn_low, _)] = [dot_and_size::<FMA>(v, n), dot_and_size::<FMA>(n, n)];
    // NaN and infinity fail these comparisons
    let in_range = (size > 1.0 / WINDOW) & (size < WINDOW) & (nn > 1.0 / WINDOW) & (nn < WINDOW);
    let inverse = 1.0 / nn;
    let k = 2.0 * vn * inverse;
    let k_low = (remainder::<FMA>(2.0 * vn, k, nn) + (2.0 * vn_low - k * nn_low)) * inverse;
    let weight = size * inverse;
    let (mut lower, mut upper) = ([0.0; 3], [0.0; 3]);
    for i in 0..3 {
        let (kn, kn_low) = two_prod::<FMA>(k, n[i]);
        let (x, x_error) = two_diff(v[i], kn);
        let x_low = x_error - (kn_low + k_low * n[i]);
        // with n_i = 0 the component is v_i, and nothing has been rounded
        let floor = if n[i] == 0.0 { 0.0 } else { ERROR_FLOOR };
        let error = (v[i].abs() + weight * n[i].abs()) * ERROR + floor;
        // the rounding test, for all components at once
        (lower[i], upper[i]) = rounded_ends(x, x_low, error);
    }
    (lower, upper, in_range)
}

/// The dot product as a double and a correction, and the sum of the magnitudes of its terms.
#[inline(always)]
fn dot_and_size<const FMA: bool>(a: [f64; 3], b: [f64; 3]) -> (f64, f64, f64) {
    let (x, x_low) = two_prod::<FMA>(a[0], b[0]);
    let (y, y_low) = two_prod::<FMA>(a[1], b[1]);
    let (z, z_low) = two_prod::<FMA>(a[2], b[2]);
    let (xy, xy_low) = two_sum(x, y);
    let (sum, sum_low) = two_sum(xy, z);
    (sum, (xy_low + sum_low) + ((x_low + y_low) + z_low), (x.abs() + y.abs()) + z.abs())
}

fma_dispatch! {
    /// A lower and an upper bound of the first component, rounded, in triple precision: for one that nearly vanishes.
    /// The others follow by turning the indices.
    fn cancelling(vx: f64, vy: f64, vz: f64, nx: f64, ny: f64, nz: f64) -> (f64, f64) = cancelling_kernel;
}

/// Bounds of the error of the numerator: this part of the magnitudes of its terms, and this part of its low double; and
/// of the quotient, this part of it.
const TERMS_ERROR: f64 = 512.0 * U * U * U;
const LOW_ERROR: f64 = 16.0 * U;
const QUOTIENT_ERROR: f64 = 128.0 * U * U;

#[inline(always)]
fn cancelling_kernel<const FMA: bool>(vx: f64, vy: f64, vz: f64, nx: f64, ny: f64, nz: f64) -> (f64, f64) {
    // (v_x (n_y² + n_z² - n_x²) - 2 n_x (v_y n_y + v_z n_z)) / (n·n): each bracket as three doubles, the numerator as
    // two.
    let (a, a_low) = two_prod::<FMA>(nx, nx);
    let (b, b_low) = two_prod::<FMA>(ny, ny);
    let (c, c_low) = two_prod::<FMA>(nz, nz);
    let (bc, bc_low) = two_sum(b, c);
    let (s, s_low) = two_diff(bc, a);
    let (products_low, rest_0) = two_sum(b_low, c_low);
    let (sums_low, rest_1) = two_sum(bc_low, s_low);
    let (products_low, rest_2) = two_diff(products_low, a_low);
    let (s_low, rest_3) = two_sum(sums_low, products_low);
    let s_rest = (rest_0 + rest_1) + (rest_2 + rest_3);

    let (p, p_low) = two_prod::<FMA>(vy, ny);
    let (q, q_low) = two_prod::<FMA>(vz, nz);
    let (t, t_low) = two_sum(p, q);
    let (products_low, rest_0) = two_sum(p_low, q_low);
    let (t_low, rest_1) = two_sum(t_low, products_low);
    let t_rest = rest_0 + rest_1;

    let k = -2.0 * nx;
    let ((vs, vs_low), (kt, kt_low)) = (two_prod::<FMA>(vx, s), two_prod::<FMA>(k, t));
    let ((vs_second, vs_third), (kt_second, kt_third)) = (two_prod::<FMA>(vx, s_low), two_prod::<FMA>(k, t_low));
    let (sum, sum_low) = two_sum(vs, kt);
    let (first, rest_0) = two_sum(vs_low, kt_low);
    let (second, rest_1) = two_sum(vs_second, kt_second);
    let (second, rest_2) = two_sum(first, second);
    let (second, rest_3) = two_sum(second, sum_low);
    let third = (vs_third + kt_third) + (vx * s_rest + k * t_rest);
    let (high, middle) = two_sum(sum, second);
    let low = middle + (third + ((rest_0 + rest_1) + (rest_2 + rest_3)));

    let (nn, nn_low) = two_sum(bc, a);
    let nn_low = (nn_low + bc_low) + ((b_low + c_low) + a_low);
    let inverse = 1.0 / nn;
    let x = high * inverse;
    let x_low = (remainder::<FMA>(high, x, nn) + (low - x * nn_low)) * inverse;
    let terms = vx.abs() * nn + k.abs() * (p.abs() + q.abs());
    rounded_ends(x, x_low, (TERMS_ERROR * terms + LOW_ERROR * low.abs()) * inverse + QUOTIENT_ERROR * x.abs())
}

/// All that double-double does not decide; components whose bounds are equal are known. The lower ones are NaN out of
/// range.
#[cold]
#[inline(never)]
fn slow_path(v: DVec3, n: DVec3, mut lower: [f64; 3], mut upper: [f64; 3]) -> DVec3 {
    if !lower[0].is_nan() && is_suitable(&[v.x, v.y, v.z, n.x, n.y, n.z]) {
        for i in 0..3 {
            if lower[i] != upper[i] {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                (lower[i], upper[i]) = cancelling(v[i], v[j], v[k], n[i], n[j], n[k]);
            }
        }
        if all_equal(&lower, &upper) {
            decided(Stage::Triple);
            return DVec3::from_array(upper);
        }
    }
    if !(v.is_finite() && n.is_finite()) || n == DVec3::ZERO {
        return DVec3::NAN;
    }
    if (0..3).all(|i| v[i] == 0.0 || n[i] == 0.0) {
        return v + DVec3::ZERO; // perpendicular, term by term: unchanged, but for the sign of zeros
    }
    fixed::<1, 2, 3>(v, n, &lower, &upper)
        .or_else(|| fixed::<2, 4, 6>(v, n, &lower, &upper))
        .unwrap_or_else(|| integers(v, n))
}

/// The components that are not known, in fixed-point numbers: vectors of `N` limbs, dot products of `S = 2 N`,
/// numerators of `V = 3 N`.
#[inline(always)]
fn fixed<const N: usize, const S: usize, const V: usize>(
    v: DVec3,
    n: DVec3,
    lower: &[f64; 3],
    upper: &[f64; 3],
) -> Option<DVec3> {
    let (v_window, n_window) = (Window::<N>::around(&v.to_array())?, Window::<N>::around(&n.to_array())?);
    decided(Stage::Fixed);
    let (v, n) = (v_window.vector(v), n_window.vector(n));
    let (vn, nn): (Fixed<S>, Fixed<S>) = (dot(&v, &n), dot(&n, &n));
    let twice = vn + vn;
    let mut image = *upper;
    for i in 0..3 {
        if lower[i] != upper[i] {
            let numerator = Fixed::<V>::product(&nn, &v[i]) - Fixed::product(&twice, &n[i]);
            image[i] = Fixed::quotient(&numerator, &nn, v_window.exponent());
        }
    }
    Some(DVec3::from_array(image))
}

/// The last stage, exact for all finite vectors; `n` is not zero.
fn integers(v: DVec3, n: DVec3) -> DVec3 {
    decided(Stage::Integers);
    // v_i (n·n) - 2 (v·n) n_i has nine terms of degree three; two limbs for the ends and two more for the rounding. Of
    // any doubles it lies below 2^3076 and is a multiple of 2^-3222.
    let bits = bits_spanned(&v.to_array()) + 2 * bits_spanned(&n.to_array()) + 4;
    if bits <= 64 * 20 { sized::<24>(v, n) } else { sized::<104>(v, n) }
}

#[inline(never)]
fn sized<const LIMBS: usize>(v: DVec3, n: DVec3) -> DVec3 {
    let [v, n] = [v, n].map(|x| x.to_array().map(Dyadic::<LIMBS>::from_f64));
    let (vn, nn): (Dyadic<LIMBS>, Dyadic<LIMBS>) = (dot(&v, &n), dot(&n, &n));
    let twice = vn.scale(1);
    DVec3::from_array([0, 1, 2].map(|i| Dyadic::quotient(&(&v[i] * &nn - &twice * &n[i]), &nn)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::stage::decisions;
    use oracle::{Random, Reflection, cases, is_rounded_quotient};

    /// Checks one reflection against exact rational arithmetic, with and without FMA.
    fn check(v: [f64; 3], n: [f64; 3]) -> DVec3 {
        let found = kernel::<false>(v[0], v[1], v[2], n[0], n[1], n[2]);
        let input = format!("reflect({v:?}, {n:?}) gives {found:?}");
        for other in [kernel::<true>(v[0], v[1], v[2], n[0], n[1], n[2]), reflect(v, n)] {
            assert_eq!(found.to_array().map(f64::to_bits), other.to_array().map(f64::to_bits), "{input}, {other:?}");
        }
        let Reflection { numerators, denominator } = Reflection::new(v, n);
        for i in 0..3 {
            assert!(is_rounded_quotient(found[i], &numerators[i], &denominator), "{input}, wrong in component {i}");
            if is_suitable(&[v, n].concat().try_into().expect("six numbers")) {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                let bounds = [cancelling_kernel::<false>, cancelling_kernel::<true>]
                    .map(|bounds| bounds(v[i], v[j], v[k], n[i], n[j], n[k]));
                for (lower, upper) in bounds {
                    assert!(lower <= found[i] && found[i] <= upper, "{input}, {lower:e} to {upper:e} in component {i}");
                }
            }
        }
        found
    }

    /// Checks a class of pairs; returns how often double-double, triple precision, fixed-point numbers and integers
    /// decided.
    fn check_class(seed: u64, mut vectors: impl FnMut(&mut Random) -> [[f64; 3]; 2]) -> [usize; 4] {
        let mut rng = Random::new(seed);
        let mut total = [0; 4];
        for _ in 0..cases(1_000_000) {
            let [v, n] = vectors(&mut rng);
            if n == [0.0; 3] || !v.iter().chain(&n).all(|x| x.is_finite()) {
                continue;
            }
            decisions();
            check(v, n);
            let [_, counts @ ..] = decisions();
            total.iter_mut().zip(counts).for_each(|(sum, count)| *sum += count);
        }
        total
    }

    fn vector(rng: &mut Random, exponents: core::ops::Range<i32>) -> [f64; 3] {
        [0; 3].map(|_| if rng.below(10) == 0 { 0.0 } else { rng.with_exponent(exponents.clone()) })
    }

    #[test]
    fn benign_vectors_are_decided_by_double_double() {
        let [double_double, triple, fixed, integers] =
            check_class(30, |rng| [vector(rng, -4..2), [0; 3].map(|_| rng.with_exponent(-4..2))]);
        assert!(double_double > 50 * (triple + fixed + integers), "{double_double} {triple} {fixed} {integers}");
    }

    #[test]
    fn vectors_of_any_doubles_are_reflected_correctly() {
        let [double_double, .., integers] =
            check_class(31, |rng| [[0; 3].map(|_| rng.finite()), [0; 3].map(|_| rng.finite())]);
        assert!(double_double > 100 && integers > 10_000, "{double_double} {integers}");
    }

    #[test]
    fn a_component_that_nearly_vanishes_is_correct() {
        let [_, triple, ..] = check_class(32, |rng| {
            // a vector is mirrored twice, and then into the axes' directions: r is near (0, 0, z)
            let mut normal = vector(rng, -4..4);
            normal[0] += 1.0;
            let image = reflect(DVec3::new(0.0, 0.0, rng.with_exponent(-3..3)), normal);
            [image.to_array(), normal]
        });
        assert!(triple > 1_000, "{triple}");
    }

    #[test]
    fn a_component_that_nearly_vanishes_is_correct_at_the_ends_of_the_range() {
        let [_, triple, ..] = check_class(38, |rng| {
            let ends = [-100, -60, -3, 0, 58, 97];
            let mut number = || {
                let exponent = ends[rng.below(6)] + rng.integer(0..3);
                rng.with_exponent(exponent..exponent + 1)
            };
            let ([x, y, z], [b, c]) = ([number(), number(), number()], [number(), number()]);
            let a = 2.0 * x * (b * y + c * z) / (y * y + z * z - x * x);
            [[f64::from_bits(a.to_bits() + rng.below(3) as u64), b, c], [x, y, z]]
        });
        assert!(triple > 1_000, "{triple}");
    }

    /// Where the terms cancel but for some `u²` of them, the rounding errors of what is left decide the last bits: the
    /// bound of the terms of third order is needed.
    #[test]
    fn a_component_that_cancels_to_some_last_bits_of_its_terms_is_correct() {
        let mut rng = Random::new(39);
        let mut triple = 0;
        for _ in 0..cases(1_000_000) {
            // Of different size, so that terms of third order have more bits than a double.
            let n = [0; 3].map(|_| i128::from(rng.bits() >> 11) << rng.below(10));
            // With v_y = 0 the component is (v_x g - 2 n_x n_z v_z) / (n·n): zero for v_x : v_z = 2 n_x n_z : g.
            let g = n[1] * n[1] + n[2] * n[2] - n[0] * n[0];
            let (mut a, mut b) = (2 * n[0] * n[2], g.abs());
            let ([mut x, mut z], [mut next_x, mut next_z]) = ([0, 1], [1, 0]);
            while b != 0 {
                let quotient = a / b;
                (a, b) = (b, a - quotient * b);
                ([x, z], [next_x, next_z]) = ([next_x, next_z], [quotient * next_x + x, quotient * next_z + z]);
                if next_x.max(next_z) >= 1 << 53 {
                    break;
                }
                if next_x.min(next_z) >= 1 << 46 {
                    #[expect(clippy::cast_precision_loss, reason = "53 bits by construction")]
                    let [v, n] = [[next_x * g.signum(), 0, next_z], n].map(|v| v.map(|x| x as f64));
                    decisions();
                    check(v, n);
                    triple += decisions()[2];
                }
            }
        }
        assert!(triple > 300, "{triple}");
    }

    #[test]
    fn nearly_perpendicular_vectors_are_reflected_correctly() {
        check_class(33, |rng| {
            let n = [0; 3].map(|_| rng.with_exponent(-4..4));
            let [x, y] = [0; 2].map(|_| rng.with_exponent(-4..4));
            let z = -(x * n[0] + y * n[1]) / n[2];
            [[x, y, f64::from_bits(z.to_bits() + rng.below(3) as u64)], n]
        });
    }

    #[test]
    fn exact_midpoints_round_to_even() {
        let mut ties = 0;
        let [.., fixed, _] = check_class(34, |rng| {
            // n = (1, 2, 2), v·n = 9 j: the image is v - 2 j n, with 54 bits and more
            let j = i64::try_from(rng.bits() >> 12).expect("52 bits") | 1 << 51;
            let y = i64::try_from(rng.bits() >> 11).expect("53 bits");
            let x = (9 * j - 2 * y).rem_euclid(16);
            let z = (9 * j - 2 * y - x) / 2;
            let scale = 2f64.powi(rng.integer(-1000..900));
            let image = (y - 4 * j).unsigned_abs(); // of 54 bits, if odd between two doubles
            ties += usize::from(image >> 53 == 1 && image & 1 == 1);
            #[expect(clippy::cast_precision_loss, reason = "53 bits by construction")]
            let v = [x, y, z].map(|x| x as f64 * scale);
            let normal_scale = 2f64.powi(rng.integer(-500..500));
            [v, [1.0, 2.0, 2.0].map(|x| x * normal_scale)]
        });
        assert!(ties > 500 && fixed > 1_000, "{ties} {fixed}");
    }

    /// The stage that decides a component which lies `2^-(53 + g)` beside a midpoint, relatively: `v_y` less half of its
    /// last bit, and a little, where the vector is `2^k` times one of ordinary size and the normal leads along `x`.
    fn stage_beside_a_midpoint(g: i32, k: i32, weaker: i32) -> Option<usize> {
        let power = |k: i32| 2f64.powi(k);
        let v = [(1.0 + power(-g)) * power(k + weaker), (1.0625 + power(-30) + power(-52)) * power(k), 0.0];
        decisions();
        check(v, [1.0, power(-54 - weaker), 0.0]);
        decisions().iter().position(|count| *count > 0)
    }

    #[test]
    fn each_stage_decides_as_near_to_a_midpoint_as_its_bound_lets_it() {
        let [double_double, triple, fixed] =
            [Stage::DoubleDouble, Stage::Triple, Stage::Fixed].map(|s| Some(s as usize));
        for g in 1..52 {
            let found = stage_beside_a_midpoint(g, 0, 0);
            // 2^-97 and 2^-99, where 2^-53 is half of a last bit.
            let expected = match g {
                ..=42 => double_double,
                45 => triple,
                48.. => fixed,
                _ => continue,
            };
            assert_eq!(found, expected, "{g}");
        }
        // 2^-800, whatever the size of the vector.
        let integers = Some(Stage::Integers as usize);
        assert_eq!([24, 30].map(|g| stage_beside_a_midpoint(g, -720, 420)), [double_double, integers]);
    }

    #[test]
    fn each_stage_decides_up_to_the_ends_of_its_window() {
        let [double_double, triple, fixed] =
            [Stage::DoubleDouble, Stage::Triple, Stage::Fixed].map(|s| Some(s as usize));
        let triple_at = |k| stage_beside_a_midpoint(45, k, 0);
        assert_eq!([-102, -99, 98, 101].map(triple_at), [fixed, triple, triple, fixed]);
        let stage = |k: i32, n: i32| {
            let scaled = |v: [f64; 3], k: i32| v.map(|x| x * 2f64.powi(k));
            decisions();
            check(scaled([1.0, 3.0, 5.0], k), scaled([3.0, 5.0, 7.0], n));
            decisions().iter().position(|count| *count > 0)
        };
        // The sum of the products is 53, the square of the normal 83.
        assert_eq!([-507, -504, 493, 496].map(|k| stage(k, 0)), [fixed, double_double, double_double, fixed]);
        assert_eq!([-255, -252, 245, 248].map(|n| stage(-n, n)), [fixed, double_double, double_double, fixed]);
    }

    #[test]
    fn images_around_overflow_and_underflow_round_as_they_should() {
        let (mut infinite, mut subnormal) = (0, 0);
        check_class(35, |rng| {
            let range = if rng.below(2) == 0 { 1020..1024 } else { -1074..-1015 };
            let normal_range = [-3..3, 1015..1024, -1074..-1010][rng.below(3)].clone();
            let (v, n) = (vector(rng, range), vector(rng, normal_range));
            let image = reflect(v, n);
            infinite += usize::from(image.to_array().iter().any(|x| x.is_infinite()));
            subnormal += usize::from(image.to_array().iter().any(|x| x.is_subnormal()));
            [v, n]
        });
        assert!(infinite > 100 && subnormal > 500, "{infinite} {subnormal}");
    }

    #[test]
    fn components_of_very_different_size_are_reflected_correctly() {
        check_class(36, |rng| {
            let mut wild = |_| if rng.below(5) == 0 { 0.0 } else { rng.with_exponent(-260..260) };
            [[0; 3].map(&mut wild), [0; 3].map(&mut wild)]
        });
    }

    #[test]
    fn vectors_at_the_edges_of_the_windows_are_reflected_correctly() {
        let counts = check_class(37, |rng| {
            // the exponents at which the stages and the sizes of integers change, or the extremes
            let edges = [-1074, -1022, -250, -64, 64, 250, 1023];
            let mut shared = edges[rng.below(7)];
            [0; 2].map(|_| {
                [0; 3].map(|_| {
                    if rng.below(3) == 0 {
                        shared = edges[rng.below(7)];
                    }
                    let exponent = (shared + rng.integer(-2..2)).clamp(-1074, 1023);
                    rng.with_exponent(exponent..exponent + 1)
                })
            })
        });
        let [double_double, _, fixed, integers] = counts; // sums that cancel are another test's
        assert!(double_double > 1_000 && fixed > 1_000 && integers > 1_000, "{counts:?}");
    }

    #[test]
    fn special_values_in_all_combinations_are_reflected_correctly() {
        let values = [0.0, -0.0, 1.0, -3.0, f64::from_bits(1), f64::MAX];
        let mut vectors = vec![];
        for x in values {
            for y in values {
                for z in values {
                    vectors.push([x, y, z]);
                }
            }
        }
        for v in &vectors {
            for n in vectors.iter().filter(|n| **n != [0.0; 3]).step_by(3) {
                check(*v, *n);
            }
        }
    }

    #[test]
    fn a_zero_normal_or_a_component_that_is_not_finite_gives_nan() {
        let good = DVec3::new(1.0, 2.0, 3.0);
        assert!(reflect(good, DVec3::ZERO).is_nan());
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for i in 0..3 {
                let mut wrong = good;
                wrong[i] = bad;
                for image in [reflect(wrong, good), reflect(good, wrong), reflect(wrong, wrong)] {
                    assert!(image.to_array().iter().all(|x| x.is_nan()), "{image}");
                }
            }
        }
    }

    #[test]
    fn an_exact_zero_is_positive() {
        let image = reflect(DVec3::new(-0.0, 1.0, -0.0), DVec3::new(0.0, -0.0, 1.0));
        assert_eq!(image.to_array().map(f64::to_bits), [0.0, 1.0, 0.0].map(f64::to_bits));
        let image = reflect(DVec3::new(-1.0, 0.0, -0.0), DVec3::new(1.0, 1.0, 0.0));
        assert_eq!(image.to_array().map(f64::to_bits), [0.0, 1.0, 0.0].map(f64::to_bits));
    }
}
