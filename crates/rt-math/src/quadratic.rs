//! Real roots of a quadratic, correctly rounded.
//!
//! With `z = |b| + √D` and `D = b² - 4ac` the roots are `-sign(b) z / 2a` and `-sign(b) 2c / z`: no subtraction of like
//! numbers remains but that in `D`. Four stages, each handing what it cannot decide to the next:
//!
//! 1. doubles: unless `D` cancels by more than 2⁻²⁰, its sign is certain and `z` good to 42 bits; one Newton step on
//!    `z (z - 2|b|) + 4ac = 0`, which `z` solves, doubles that, and both quotients get their remainder as a correction;
//! 2. double-double, of coefficients scaled by powers of two where they need it: `D` of either sign or zero is certain,
//!    whatever the cancellation;
//! 3. fixed-point numbers: what lies too near a midpoint of two doubles;
//! 4. exact integers: the same, for coefficients of very different size, and what over- or underflows.

use core::cmp::Ordering;

use crate::exact::stage::{Stage, decided};
use crate::exact::{
    DoubleDouble, Dyadic, Fixed, Window, fast_two_sum, mantissa_and_exponent, power_of_two, remainder,
    round_if_certain, rounded_ends, scale, two_prod, two_sum,
};
use crate::fma_dispatch;

/// The real solutions of an equation, each distinct one once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Roots {
    /// No real number solves it.
    None,
    /// One number solves it: a double root, or the root of a linear equation.
    One(f64),
    /// Two numbers solve it, in ascending order.
    Two(f64, f64),
    /// Every number solves it: all coefficients are zero.
    All,
}

impl Roots {
    /// Returns the smallest root that is positive; `None` if there is none, or if every number is a root.
    ///
    /// A root that is positive and rounds to +0.0 does not count.
    ///
    /// ```
    /// use rt_math::solve_quadratic;
    ///
    /// assert_eq!(solve_quadratic(1.0, -1.0, -6.0).smallest_positive(), Some(3.0)); // of -2 and 3
    /// assert_eq!(solve_quadratic(1.0, 3.0, 2.0).smallest_positive(), None);
    /// ```
    #[must_use]
    pub fn smallest_positive(self) -> Option<f64> {
        self.into_iter().find(|&root| root > 0.0)
    }
}

/// The one or two numbers, in ascending order; none of [`Roots::All`], which names none.
///
/// ```
/// use rt_math::solve_quadratic;
///
/// assert_eq!(solve_quadratic(2.0, 0.0, -8.0).into_iter().sum::<f64>(), 0.0);
/// ```
impl IntoIterator for Roots {
    type Item = f64;
    type IntoIter = core::iter::Flatten<core::array::IntoIter<Option<f64>, 2>>;

    fn into_iter(self) -> Self::IntoIter {
        let roots = match self {
            Self::None | Self::All => [None, None],
            Self::One(root) => [Some(root), None],
            Self::Two(first, second) => [Some(first), Some(second)],
        };
        roots.into_iter().flatten()
    }
}

fma_dispatch! {
    /// Returns the real roots of `a x² + b x + c`, in ascending order.
    ///
    /// With `a == 0` the equation is linear; `a == b == 0` has no root, or `Roots::All` when `c == 0` too. A double
    /// root is returned once. The number of roots is exact and each root is correctly rounded, for all finite
    /// coefficients: two distinct roots may round to the same double, a root beyond the range of doubles is infinite,
    /// one that underflows is a zero with the root's sign, and a root that is exactly zero is +0.0. With a coefficient
    /// that is infinite or NaN the answer is `Roots::None`. `docs/numerics.md`, section 2, has the proof.
    ///
    /// Source of the form without cancellation: W. Kahan, "On the Cost of Floating-Point Computation Without
    /// Extra-Precise Arithmetic", 2004.
    ///
    /// ```
    /// use rt_math::{Roots, solve_quadratic};
    ///
    /// assert_eq!(solve_quadratic(1.0, -3.0, 2.0), Roots::Two(1.0, 2.0));
    /// assert_eq!(solve_quadratic(1.0, -2.0, 1.0), Roots::One(1.0));
    /// assert_eq!(solve_quadratic(1e300, 0.0, 1e300), Roots::None);
    /// ```
    #[must_use]
    pub fn solve_quadratic(a: f64, b: f64, c: f64) -> Roots = kernel;
}

/// The filter decides if `|D|` exceeds this part of `b²`: below, its rounding errors weigh too much.
const CANCELLATION: f64 = power_of_two(-20);
/// ... and lies between this and its inverse, so that no product that matters over- or underflows.
const D_FLOOR: f64 = power_of_two(-900);
/// Bound of the filter's error in a root: this part of it, and an absolute one for what may underflow.
const FILTER_ERROR: f64 = power_of_two(-73);
const FILTER_ERROR_FLOOR: f64 = power_of_two(-500);
/// Bound of the relative error of a root in double-double: 54 u² is needed.
const DOUBLE_DOUBLE_ERROR: f64 = power_of_two(-100);

#[inline(always)]
fn kernel<const FMA: bool>(a: f64, b: f64, c: f64) -> Roots {
    let square = b * b;
    let d = multiply_add::<FMA>(4.0 * a, -c, square);
    let certain = CANCELLATION * square;
    let certain = if certain > D_FLOOR { certain } else { D_FLOOR };
    // NaN and infinity fail these comparisons
    if d.abs() > certain && d.abs() < 1.0 / D_FLOOR {
        if d < 0.0 {
            decided(Stage::Filter);
            return Roots::None;
        }
        if let Some(roots) = filter::<FMA>(a, b, c, d) {
            decided(Stage::Filter);
            return roots;
        }
    }
    cold_path();
    double_double(a, b, c)
}

/// Makes the branch that reaches it an unlikely one, as `core::hint::cold_path` does from Rust 1.95 on.
#[cold]
fn cold_path() {}

/// The two roots in doubles with corrections, if these decide their rounding; `d` is `D` to 31 bits or better.
#[inline(always)]
fn filter<const FMA: bool>(a: f64, b: f64, c: f64, d: f64) -> Option<Roots> {
    let root = d.sqrt();
    let z = b.abs() + root;
    // the Newton step, its residual as a sum of exact terms
    let (t, t_low) = fast_two_sum(z, -2.0 * b.abs());
    let (zt, zt_low) = two_prod::<FMA>(z, t);
    let (product, product_low) = two_prod::<FMA>(4.0 * a, c);
    let residual = (zt + product) + multiply_add::<FMA>(t_low, z, zt_low + product_low);
    let z_low = residual * (-0.5 / root);
    // both quotients side by side, which the compiler turns into two-lane instructions
    let sign = 1f64.copysign(-b);
    let numerator = [z, sign * (2.0 * c)];
    let numerator_low = [z_low, 0.0];
    let denominator = [sign * (2.0 * a), z];
    let minus_denominator_low = [0.0, -z_low];
    let (mut lower, mut upper) = ([0.0; 2], [0.0; 2]);
    for i in 0..2 {
        let inverse = 1.0 / denominator[i];
        let x = numerator[i] * inverse;
        let rest = remainder::<FMA>(numerator[i], x, denominator[i])
            + multiply_add::<FMA>(x, minus_denominator_low[i], numerator_low[i]);
        let x_low = rest * inverse;
        let error = multiply_add::<FMA>(x.abs(), FILTER_ERROR, FILTER_ERROR_FLOOR);
        // the rounding test, for both roots at once
        (lower[i], upper[i]) = rounded_ends(x, x_low, error);
    }
    if (lower[0] == upper[0]) & (lower[1] == upper[1]) {
        let first_is_smaller = upper[0] < upper[1];
        let smaller = if first_is_smaller { upper[0] } else { upper[1] };
        let larger = if first_is_smaller { upper[1] } else { upper[0] };
        Some(Roots::Two(smaller, larger))
    } else {
        None
    }
}

/// `x y + z` where the rounding of the product does not matter.
#[inline(always)]
fn multiply_add<const FMA: bool>(x: f64, y: f64, z: f64) -> f64 {
    if FMA { x.mul_add(y, z) } else { x * y + z }
}

/// All that is left after the filter and double-double without scaling.
#[cold]
#[inline(never)]
fn slow_path(a: f64, b: f64, c: f64) -> Roots {
    if !(a.is_finite() && b.is_finite() && c.is_finite()) {
        return Roots::None;
    }
    match (a == 0.0, b == 0.0, c == 0.0) {
        (true, true, true) => Roots::All,
        (true, true, false) => Roots::None,
        (true, false, _) => Roots::One(negated_quotient(c, b)),
        (false, true, true) => Roots::One(0.0),
        (false, false, true) => {
            let other = negated_quotient(b, a);
            if other.is_sign_negative() { Roots::Two(other, 0.0) } else { Roots::Two(0.0, other) }
        }
        (false, _, false) => scaled_roots(a, b, c)
            .inspect(|_| decided(Stage::DoubleDouble))
            .or_else(|| fixed::<1, 2>(a, b, c))
            .or_else(|| fixed::<2, 4>(a, b, c))
            .unwrap_or_else(|| integers(a, b, c)),
    }
}

/// `-n / d`, correctly rounded as any division is; an exact zero is +0.0.
fn negated_quotient(n: f64, d: f64) -> f64 {
    if n == 0.0 { 0.0 } else { -n / d }
}

/// If `b² / ac` is larger than the square of two to this power, or smaller than one over it, what is left out of a root
/// is far below what is proved of the others: `docs/numerics.md`, section 2.
const LOPSIDED: i32 = 200;

/// The equation of `y`, where `x = 2^k y`, with its coefficients times powers of two: exactly the given one, with `a`
/// in `1/2..2` and `c` in `1..2`.
struct Balanced {
    a: f64,
    /// In `1..2`, or zero.
    b: f64,
    /// The coefficient of `y` is `b 2^b_exponent`.
    b_exponent: i32,
    c: f64,
    k: i32,
}

impl Balanced {
    /// `a` and `c` are not zero.
    #[inline(always)]
    fn new(a: f64, b: f64, c: f64) -> Self {
        let ((a, a_exponent), (c, c_exponent)) = (mantissa_and_exponent(a), mantissa_and_exponent(c));
        let k = (c_exponent - a_exponent) >> 1;
        let a = a * power_of_two(a_exponent + 2 * k - c_exponent); // 2^0 or 2^-1
        let (b, b_exponent) = if b == 0.0 { (0.0, c_exponent - k) } else { mantissa_and_exponent(b) };
        Self { a, b, b_exponent: b_exponent + k - c_exponent, c, k }
    }
}

fma_dispatch! {
    /// All that the filter does not decide: in double-double, if the coefficients need no scaling.
    fn double_double(a: f64, b: f64, c: f64) -> Roots = double_double_kernel;
}

/// Coefficients of such sizes need no scaling.
const ORDINARY: core::ops::Range<f64> = power_of_two(-256)..power_of_two(256);

#[inline(always)]
fn double_double_kernel<const FMA: bool>(a: f64, b: f64, c: f64) -> Roots {
    let ordinary = |x: f64| ORDINARY.contains(&x.abs());
    if ordinary(a)
        && ordinary(c)
        && (ordinary(b) || b == 0.0)
        && let Some(roots) = double_double_roots::<FMA>(a, b, c)
    {
        decided(Stage::DoubleDouble);
        return roots;
    }
    slow_path(a, b, c)
}

/// The roots of an equation for which nothing over- or underflows.
#[inline(always)]
fn double_double_roots<const FMA: bool>(a: f64, b: f64, c: f64) -> Option<Roots> {
    let d = DoubleDouble::<FMA>::product(b, b) - DoubleDouble::product(4.0 * a, c);
    if d.high() < 0.0 {
        return Some(Roots::None);
    }
    if d.high() == 0.0 {
        return Some(Roots::One(negated_quotient(b, 2.0 * a)));
    }
    // z, with all divisions but those by d and z off the critical path
    let root = d.high().sqrt();
    let root_low = (remainder::<FMA>(d.high(), root, root) + d.low()) * (0.5 / root);
    let (z, z_error) = two_sum(b.abs(), root);
    let z_low = z_error + root_low;
    let sign = 2f64.copysign(-b);
    let (denominator, numerator) = (sign * a, sign * c);
    let quotient = |n: f64, n_low: f64, d: f64, d_low: f64| {
        let inverse = 1.0 / d;
        let x = n * inverse;
        let rest = remainder::<FMA>(n, x, d) + multiply_add::<FMA>(x, -d_low, n_low);
        round_if_certain(x, rest * inverse, x.abs() * DOUBLE_DOUBLE_ERROR)
    };
    let (x, y) = (quotient(z, z_low, denominator, 0.0)?, quotient(numerator, 0.0, z, z_low)?);
    Some(if x < y { Roots::Two(x, y) } else { Roots::Two(y, x) })
}

/// The same for all others, by the balanced equation.
#[cold]
#[inline(never)]
fn scaled_roots(a: f64, b: f64, c: f64) -> Option<Roots> {
    let balanced = Balanced::new(a, b, c);
    let (x, y) = if balanced.b_exponent > LOPSIDED {
        // One root is -b / a and one is -c / b, up to a relative 2^-390.
        (-b / a, -c / b)
    } else {
        let Balanced { a, b, b_exponent, c, k } = balanced;
        let b = if b_exponent < -LOPSIDED { 0.0 } else { b * power_of_two(b_exponent) };
        match double_double_roots::<false>(a, b, c)? {
            Roots::Two(x, y) => (unscaled(x, k)?, unscaled(y, k)?),
            Roots::One(x) => return unscaled(x, k).map(Roots::One),
            none => return Some(none),
        }
    };
    if !(surely_normal(x) && surely_normal(y)) {
        return None;
    }
    Some(if x < y { Roots::Two(x, y) } else { Roots::Two(y, x) })
}

/// Whether a result is above the least normal double, and finite. Subnormal numbers would have been rounded twice, and
/// so would what rounds up to the least normal one; infinite ones are left to integers.
#[inline(always)]
fn surely_normal(x: f64) -> bool {
    x.abs() > f64::MIN_POSITIVE && x.abs() < f64::INFINITY
}

/// `x 2^k`, if that is surely a normal double or zero.
#[inline(always)]
fn unscaled(x: f64, k: i32) -> Option<f64> {
    let product = scale(x, k);
    (surely_normal(product) || x == 0.0).then_some(product)
}

/// The third stage, in coefficients of `N` limbs and squares of `S = 2 N`; `a` and `c` are not zero.
#[cold]
#[inline(never)]
fn fixed<const N: usize, const S: usize>(a: f64, b: f64, c: f64) -> Option<Roots> {
    let Balanced { a, b, b_exponent, c, k } = Balanced::new(a, b, c);
    if b_exponent.abs() > LOPSIDED {
        return None;
    }
    let b = b * power_of_two(b_exponent);
    let window = Window::<N>::around(&[a, b, c])?;
    decided(Stage::Fixed);
    let [a, b, c] = [a, b, c].map(|x| window.fixed(x));
    let (two_a, two_c) = (a + a, c + c);
    let discriminant = Fixed::<S>::product(&b, &b) - Fixed::product(&two_a, &two_c);
    let root = |minus| Fixed::root(&-b, minus, &discriminant, &two_a, &two_c, k);
    Some(match discriminant.sign() {
        Ordering::Less => Roots::None,
        Ordering::Equal => Roots::One(Fixed::quotient(&-b, &two_a, k)),
        Ordering::Greater if a.sign() == Ordering::Less => Roots::Two(root(false), root(true)),
        Ordering::Greater => Roots::Two(root(true), root(false)),
    })
}

/// The last stage, exact for all finite coefficients; `a` and `c` are not zero.
fn integers(a: f64, b: f64, c: f64) -> Roots {
    decided(Stage::Integers);
    // Dyadic::root with p = -b, q = 2a: all of p, √D and 2 m q lie below 2^1028 and are multiples of 2^-2147.
    sized::<104>(a, b, c)
}

#[inline(never)]
fn sized<const LIMBS: usize>(a: f64, b: f64, c: f64) -> Roots {
    let [a, b, c] = [a, b, c].map(Dyadic::<LIMBS>::from_f64);
    let discriminant = b.square() - (&a * &c).scale(2);
    let (minus_b, two_a) = (-b, &a + &a);
    let root = |minus| Dyadic::root(&minus_b, minus, &discriminant, &two_a);
    match discriminant.sign() {
        Ordering::Less => Roots::None,
        Ordering::Equal => Roots::One(Dyadic::quotient(&minus_b, &two_a)),
        Ordering::Greater if a.sign() == Ordering::Less => Roots::Two(root(false), root(true)),
        Ordering::Greater => Roots::Two(root(true), root(false)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::stage::decisions;
    use oracle::{Quadratic, Random, cases, exact, is_rounding_of};

    /// Checks one equation against exact rational arithmetic, with and without FMA.
    fn check(a: f64, b: f64, c: f64) {
        let input = format!("solve_quadratic({a:e}, {b:e}, {c:e})");
        let found = kernel::<false>(a, b, c);
        let bits = |roots| match roots {
            Roots::One(x) => [x.to_bits(), 0],
            Roots::Two(x, y) => [x.to_bits(), y.to_bits()],
            Roots::None | Roots::All => [0, 0],
        };
        for other in [kernel::<true>(a, b, c), solve_quadratic(a, b, c)] {
            let same = core::mem::discriminant(&found) == core::mem::discriminant(&other) && bits(found) == bits(other);
            assert!(same, "{input}: {found:?} without FMA, {other:?} with it");
        }
        if [a, c].iter().all(|x| ORDINARY.contains(&x.abs())) && (b == 0.0 || ORDINARY.contains(&b.abs())) {
            for roots in [double_double_roots::<false>(a, b, c), double_double_roots::<true>(a, b, c)] {
                assert!(roots.is_none_or(|roots| bits(roots) == bits(found)), "{input}: {found:?}, {roots:?}");
            }
        }
        let [a, b, c] = [a, b, c].map(exact);
        let truth = Quadratic { a, b, c };
        let is_root = |x: f64, larger: bool| is_rounding_of(x, |m| truth.compare(larger, m));
        let correct = match found {
            Roots::All => truth.count().is_none(),
            Roots::None => truth.count() == Some(0),
            Roots::One(x) => truth.count() == Some(1) && is_root(x, false),
            Roots::Two(x, y) => {
                truth.count() == Some(2) && x.total_cmp(&y).is_le() && is_root(x, false) && is_root(y, true)
            }
        };
        assert!(correct, "{input} gives {found:?}");
    }

    /// Checks a class of equations; returns how many of them each stage decided.
    fn check_class(seed: u64, mut coefficients: impl FnMut(&mut Random) -> [f64; 3]) -> [usize; 4] {
        let mut rng = Random::new(seed);
        decisions();
        let mut total = [0; 4];
        for _ in 0..cases(1_000_000) {
            let [a, b, c] = coefficients(&mut rng);
            if a.is_finite() && b.is_finite() && c.is_finite() {
                check(a, b, c);
            }
            // three calls each
            let [filter, double_double, _, fixed, integers] = decisions();
            let counts = [filter, double_double, fixed, integers];
            total.iter_mut().zip(counts).for_each(|(sum, count)| *sum += count);
        }
        total
    }

    #[test]
    fn benign_equations_are_decided_by_the_filter() {
        let [filter, double_double, fixed, integers] = check_class(20, |rng| [0; 3].map(|_| rng.with_exponent(-3..3)));
        assert!(filter > 1_000 * (double_double + fixed + integers), "{filter} {double_double} {fixed} {integers}");
    }

    #[test]
    fn roots_of_any_doubles_are_correctly_rounded() {
        let [filter, double_double, _, integers] = check_class(21, |rng| [0; 3].map(|_| rng.finite()));
        assert!(filter > 1_000 && double_double > 1_000 && integers > 100, "{filter} {double_double} {integers}");
    }

    #[test]
    fn discriminants_decided_in_the_last_bits_are_exact() {
        let [_, double_double, ..] = check_class(22, |rng| {
            let range = [-2..2, -200..200, -500..500][rng.below(3)].clone();
            let (a, b) = (rng.with_exponent(range.clone()), rng.with_exponent(range));
            let c = b / a * b / 4.0;
            let steps = rng.below(5);
            [a, b, f64::from_bits((c.to_bits() + steps as u64).saturating_sub(2))]
        });
        assert!(double_double > 5_000, "{double_double}");
    }

    #[test]
    fn double_roots_are_found_once() {
        let mut single = 0;
        check_class(23, |rng| {
            // (p x + q)^2 times a power of two, and now and then a bit off
            let bits = |rng: &mut Random| f64::from(rng.integer(-(1 << 26)..1 << 26));
            let (p, q) = (bits(rng), bits(rng));
            let [i, j] = [0; 2].map(|_| rng.integer(-400..400));
            let scale = |x: f64, k: i32| x * 2f64.powi(k);
            let (a, b, c) = (scale(p * p, 2 * i), scale(2.0 * p * q, i + j), scale(q * q, 2 * j));
            single += usize::from(matches!(solve_quadratic(a, b, c), Roots::One(_)));
            match rng.below(4) {
                0 => [a.next_up(), b, c],
                1 => [a, b.next_down(), c],
                _ => [a, b, c],
            }
        });
        assert!(single > 8_000, "{single}");
    }

    #[test]
    fn roots_next_to_a_midpoint_are_decided_by_fixed_point_numbers() {
        let [_, _, fixed, _] = check_class(24, |rng| {
            // M odd of 54 bits is a midpoint; (x - M) (x + w) = x^2 - (M - w) x - M w, whose last coefficient is
            // rounded
            let midpoint = (1_u64 << 53) | rng.bits() >> 11 | 1;
            let w = (rng.bits() % (2 << rng.below(20))) | 1;
            let power = |rng: &mut Random| 2f64.powi(rng.integer(-100..100));
            #[expect(clippy::cast_precision_loss, reason = "even, hence exact; and the rounding that is wanted")]
            let (b, c) = ((midpoint - w) as f64, (u128::from(midpoint) * u128::from(w)) as f64);
            let (s, t) = (power(rng), power(rng));
            let sign = if rng.below(2) == 0 { 1.0 } else { -1.0 };
            [s, -b * s * t * sign, -c * s * t * t]
        });
        assert!(fixed > 10_000, "{fixed}");
    }

    /// A midpoint of two doubles, an odd integer of 54 bits, and its inverse modulo 2^64.
    fn midpoint_and_inverse(rng: &mut Random) -> (u64, u64) {
        let midpoint = (1 << 53) | (rng.bits() >> 11) | 1;
        let mut inverse = midpoint;
        for _ in 0..6 {
            inverse = inverse.wrapping_mul(2_u64.wrapping_sub(midpoint.wrapping_mul(inverse)));
        }
        assert_eq!(midpoint.wrapping_mul(inverse), 1);
        (midpoint, inverse)
    }

    #[test]
    #[expect(clippy::cast_precision_loss, reason = "53 bits by construction")]
    fn nearly_double_roots_next_to_a_midpoint_are_correct() {
        // (x - M) (x - r) plus a small t: roots near M and r, near each other, and M r + t such that it has 53 bits
        let mut found = 0;
        check_class(38, |rng| {
            let (midpoint, inverse) = midpoint_and_inverse(rng);
            let sign = if rng.below(2) == 0 { 1 } else { u64::MAX };
            let fits = |t: &u64| {
                let r = t.wrapping_mul(sign).wrapping_mul(inverse) % (1 << 55);
                let near = r.abs_diff(midpoint) < midpoint >> 7 && r.abs_diff(midpoint) > midpoint >> 10;
                near && (midpoint + r).is_multiple_of(4)
            };
            let Some(t) = (1..1 << 14).step_by(2).find(fits) else { return [1.0, 0.0, 0.0] };
            let r = t.wrapping_mul(sign).wrapping_mul(inverse) % (1 << 55);
            let product = u128::from(midpoint) * u128::from(r);
            let c = if sign == 1 { product - u128::from(t) } else { product + u128::from(t) };
            assert!(c.is_multiple_of(1 << 55));
            found += 1;
            [1.0, -((midpoint + r) as f64), c as f64]
        });
        assert!(found > 5_000, "{found}");
    }

    #[test]
    #[expect(clippy::cast_precision_loss, reason = "53 bits by construction")]
    fn a_tiny_root_next_to_a_midpoint_is_decided_by_integers() {
        // M b - t is c 2^54: -c / b is next to a midpoint, and so is the smaller root, if the other is far larger
        let [.., integers] = check_class(39, |rng| {
            let (midpoint, inverse) = midpoint_and_inverse(rng);
            let fits = |t: &u64| t.wrapping_mul(inverse) % (1 << 54) < 1 << 53;
            let t = (1..).step_by(2).find(fits).expect("one in two does");
            let b = t.wrapping_mul(inverse) % (1 << 54);
            let c = (u128::from(midpoint) * u128::from(b) - u128::from(t)) >> 54;
            let [i, j, k] = [[11, -116, -64], [970, -1074, -1074], [960, -500, 0], [100, 0, -200]][rng.below(4)];
            let scale = |x: f64, k: i32| x * 2f64.powi(k / 2) * 2f64.powi(k - k / 2);
            let sign = if rng.below(2) == 0 { 1.0 } else { -1.0 };
            [scale(1.0 + f64::EPSILON, k), scale(b as f64, i), scale(sign * c as f64, j)]
        });
        assert!(integers > 10_000, "{integers}");
    }

    /// An equation one of whose roots is beside a midpoint, and how far, relatively: `(x - M) (x + w)` with its last
    /// coefficient rounded, times `s` and with `x / t` for `x`.
    #[expect(clippy::cast_precision_loss, reason = "even, hence exact; and the rounding that is wanted")]
    #[expect(clippy::cast_possible_truncation, reason = "a whole number of up to 105 bits")]
    fn beside_a_midpoint(rng: &mut Random, bits: u32, s: i32, t: i32) -> ([f64; 3], f64) {
        let midpoint = (1_u64 << 53) | rng.bits() >> 11 | 1;
        let w = (1 << bits) | (rng.bits() % (1 << bits)) | 1;
        let product = u128::from(midpoint) * u128::from(w);
        let c = product as f64;
        let off = product.abs_diff(c as u128) as f64 / (midpoint + w) as f64 / midpoint as f64;
        let scale = |x: f64, k: i32| x * 2f64.powi(k);
        ([scale(1.0, s), -scale((midpoint - w) as f64, s + t), -scale(c, s + 2 * t)], off)
    }

    #[test]
    fn each_stage_decides_as_near_to_a_midpoint_as_its_bound_lets_it() {
        let mut rng = Random::new(41);
        // The bounds are FILTER_ERROR and DOUBLE_DOUBLE_ERROR; for a root of 2^-438, 2^-500 takes the first one's place.
        for (bits, s, t, filter_bound) in [(1..50, 0, 0, -73), (50..51, 100, -491, -62)] {
            let mut seen = [0; 3];
            for _ in 0..cases(1_000_000) {
                let bits = u32::try_from(rng.integer(bits.clone())).unwrap();
                let ([a, b, c], off) = beside_a_midpoint(&mut rng, bits, s, t);
                // Farther off, the other root may be near a midpoint as well.
                if off > 2f64.powi(4 + filter_bound) && t != 0 {
                    continue;
                }
                let off = off.log2() - f64::from(filter_bound);
                let stage = if off > 2.0 {
                    Stage::Filter
                } else if off < -2.0 && off > f64::from(-100 - filter_bound) + 2.0 {
                    Stage::DoubleDouble
                } else if off < f64::from(-100 - filter_bound) - 2.0 {
                    Stage::Fixed
                } else {
                    continue;
                };
                decisions();
                let roots = kernel::<false>(a, b, c);
                let found = decisions();
                assert_eq!(
                    found[stage as usize], 1,
                    "solve_quadratic({a:e}, {b:e}, {c:e}) = {roots:?}: {off}, {found:?}"
                );
                check(a, b, c);
                seen[usize::from(off < 2.0) + usize::from(off < -20.0)] += 1;
            }
            assert!(seen[0] > 100 && seen[1] > 10 && (filter_bound != -73 || seen[2] > 100), "{seen:?}");
        }
    }

    #[test]
    fn the_filter_decides_up_to_the_ends_of_its_window() {
        // D is 20 2^(2 k).
        let is_filter = |k: i32| {
            let power = 2f64.powi(k);
            decisions();
            check(power, 6.0 * power, 4.0 * power);
            decisions()[Stage::Filter as usize] > 0
        };
        assert_eq!([-455, -451, 446, 450].map(is_filter), [false, true, true, false]);
    }

    #[test]
    fn roots_around_the_overflow_threshold_round_as_they_should() {
        let mut seen = [0; 2];
        check_class(25, |rng| {
            let k = rng.integer(-60..10);
            let near_one = 1.0 + f64::from(rng.integer(-3..4)) * f64::EPSILON;
            let a = near_one * 2f64.powi(k);
            let b = rng.with_exponent(1022..1024).abs().max(f64::from_bits(f64::MAX.to_bits() - rng.bits() % 8));
            let range = [-1074..1024, 900..1024][rng.below(2)].clone();
            let c = rng.with_exponent(range);
            let b = b * 2f64.powi(k.min(0));
            if let Roots::Two(x, y) = solve_quadratic(a, b, c) {
                seen[usize::from(x.is_infinite() || y.is_infinite())] += 1;
            }
            [a, b, c]
        });
        assert!(seen[0] > 1_000 && seen[1] > 1_000, "{seen:?}");
    }

    #[test]
    fn subnormal_roots_and_ties_between_them_round_to_even() {
        let mut ties = 0;
        check_class(26, |rng| {
            // (2^i x - m 2^(i - 1075)) (x - r): the first root is a midpoint of two subnormals if m is odd
            let m = f64::from(rng.integer(-9..10));
            let r = f64::from(rng.integer(-1000..1000)) * 2f64.powi(rng.integer(-1074..40));
            let i = rng.integer(30..900);
            let scale = 2f64.powi(i);
            let tiny = m * 2f64.powi(i - 1000) * 2f64.powi(-75);
            ties += usize::from(m % 2.0 != 0.0);
            [scale, -(scale * r + tiny), tiny * r]
        });
        assert!(ties > 1_000, "{ties}");
    }

    #[test]
    fn a_root_just_below_the_least_normal_double_is_rounded_once() {
        // The largest subnormal and the least normal double have this midpoint; ties go to the latter.
        let midpoint = |exponent: i32| ((1_u64 << 53) - 1) as f64 * 2f64.powi(exponent - 1075);
        // one root is -c / b, up to 2^-1122 of it
        for sign in [1.0, -1.0] {
            check(sign, 2f64.powi(100), midpoint(100));
            check(sign, -(2f64.powi(300)), midpoint(300));
        }
        // of a balanced equation, one root is about the midpoint, which is a double there
        let mut rng = Random::new(30);
        for _ in 0..cases(10_000) {
            let (a, b) = (rng.with_exponent(0..1), rng.with_exponent(-1..3));
            let c = -(a + b) + (a + a + b) * f64::EPSILON * 0.6;
            check(a * 2f64.powi(1022), b, c * 2f64.powi(-1022));
        }
    }

    #[test]
    fn a_double_root_that_is_subnormal_is_rounded_once() {
        let mut subnormal = 0;
        check_class(42, |rng| {
            // (p x + q)^2, of which no coefficient is rounded
            let p = f64::from(2 * rng.integer(1 << 8..1 << 9) + 1) * 2f64.powi(rng.integer(499..502));
            let q = f64::from(rng.integer(1..1 << 22)) * 2f64.powi(rng.integer(-537..-535));
            let equation = [p * p, 2.0 * p * q, q * q];
            if let Roots::One(x) = solve_quadratic(equation[0], equation[1], equation[2]) {
                subnormal += usize::from(x.is_subnormal());
            }
            equation
        });
        assert!(subnormal > 5_000, "{subnormal}");
    }

    #[test]
    fn subnormal_coefficients_are_solved() {
        check_class(27, |rng| {
            let mut pick = || {
                let range = [-1074..-1020, -1074..-900, -540..-500, 0..30][rng.below(4)].clone();
                if rng.below(8) == 0 { 0.0 } else { rng.with_exponent(range) }
            };
            [pick(), pick(), pick()]
        });
    }

    #[test]
    fn one_root_may_be_far_smaller_than_the_other() {
        let [filter, ..] = check_class(28, |rng| {
            let (small, large) = (rng.with_exponent(-150..-20), rng.with_exponent(20..150));
            [[1.0, large, small], [small, large, rng.with_exponent(-5..5)], [large, small, -large]][rng.below(3)]
        });
        assert!(filter > 10_000, "{filter}");
    }

    #[test]
    fn equations_at_the_edges_of_the_windows_are_solved() {
        let counts = check_class(29, |rng| {
            // the exponents at which the stages and the sizes of integers change, or the extremes
            let edges = [-1074, -1022, -450, -256, -64, 64, 256, 450, 1023];
            let mut pick = || {
                let exponent = (edges[rng.below(9)] + rng.integer(-2..2)).clamp(-1074, 1023);
                rng.with_exponent(exponent..exponent + 1)
            };
            let (a, b, c) = (pick(), pick(), pick());
            match rng.below(4) {
                0 => [a, b, b / a * b / 4.0],
                1 => [a, 2.0 * a.abs().sqrt() * c.abs().sqrt(), c.copysign(a)],
                _ => [a, b, c],
            }
        });
        let [filter, double_double, _, integers] = counts;
        assert!(filter > 1_000 && double_double > 1_000 && integers > 1_000, "{counts:?}");
    }

    #[test]
    fn special_values_in_all_combinations_are_solved() {
        let values = [
            0.0,
            1.0,
            2.0,
            3.0,
            1e-30,
            1e200,
            f64::from_bits(1),
            f64::from_bits(3),
            f64::MIN_POSITIVE,
            f64::MAX,
            2f64.powi(1023),
            2f64.powi(-537),
            f64::MAX / 4.0,
        ];
        let signed: Vec<f64> = values.iter().flat_map(|&x| [x, -x]).collect();
        for &a in &signed {
            for &b in &signed {
                for &c in &signed {
                    check(a, b, c);
                }
            }
        }
    }

    #[test]
    fn a_coefficient_that_is_not_finite_gives_no_root() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for good in [0.0, 1.0, -1.0, f64::MAX, f64::from_bits(1)] {
                for [a, b, c] in [[bad, good, good], [good, bad, good], [good, good, bad], [bad, bad, good], [bad; 3]] {
                    assert_eq!(kernel::<false>(a, b, c), Roots::None);
                    assert_eq!(kernel::<true>(a, b, c), Roots::None);
                }
            }
        }
    }

    #[test]
    fn the_smallest_positive_root_is_neither_zero_nor_negative() {
        let smallest = |a, b, c| solve_quadratic(a, b, c).smallest_positive();
        assert_eq!([smallest(1.0, -1.0, -6.0), smallest(1.0, -5.0, 6.0)], [Some(3.0), Some(2.0)]);
        assert_eq!([smallest(1.0, -2.0, 0.0), smallest(1.0, 2.0, 0.0)], [Some(2.0), None]);
        assert_eq!([smallest(1.0, 3.0, 2.0), smallest(1.0, 0.0, 1.0), smallest(0.0, 1.0, 0.0)], [None; 3]);
        assert_eq!([smallest(0.0, 2.0, -1.0), Roots::All.smallest_positive()], [Some(0.5), None]);
    }

    #[test]
    fn zero_roots_have_the_sign_that_the_docs_state() {
        let bits = |roots: Roots| match roots {
            Roots::One(x) => vec![x.to_bits()],
            Roots::Two(x, y) => vec![x.to_bits(), y.to_bits()],
            Roots::None | Roots::All => vec![],
        };
        let (plus, minus) = (0.0_f64.to_bits(), (-0.0_f64).to_bits());
        assert_eq!(bits(solve_quadratic(-1.0, -0.0, -0.0)), [plus]);
        assert_eq!(bits(solve_quadratic(0.0, -3.0, 0.0)), [plus]);
        assert_eq!(bits(solve_quadratic(1.0, -2.0, -0.0)), [plus, 2.0_f64.to_bits()]);
        let tiny = f64::from_bits(1);
        assert_eq!(bits(solve_quadratic(f64::MAX, tiny, 0.0)), [minus, plus]);
        assert_eq!(bits(solve_quadratic(0.0, f64::MAX, tiny)), [minus]);
        assert_eq!(bits(solve_quadratic(1.0, -1e300, tiny)), [plus, 1e300_f64.to_bits()]);
    }
}
