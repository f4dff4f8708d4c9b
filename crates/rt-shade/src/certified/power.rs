//! Powers with any exponent, through the logarithm and the exponential function.
//!
//! `ln x = 2 artanh((x - 1) / (x + 1))` after a factor `2^k` has brought `x` close to 1; nothing cancels, so the
//! logarithm has its relative precision also beside 1. The exponential function halves its argument a fixed number of
//! times, sums Taylor's series, and squares as often.

use std::cmp::Ordering;
use std::sync::LazyLock;

use rt_math::exact::Ball;

use super::{LONGEST, bits, constant, inverse_tangent, inverse_tangent_of_inverse};

/// ln 2, by a formula of Machin's kind.
static LN_2: LazyLock<Ball<LONGEST>> = LazyLock::new(|| {
    let artanh = inverse_tangent_of_inverse::<true>;
    let [a, b, c] = [(18, 26), (-2, 4801), (8, 8749)].map(|(factor, n)| Ball::from_integer(factor) * artanh(n));
    a + b + c
});

/// Powers below this exponent to the base 2 are only known to be between 0 and that.
const LEAST: i32 = -20_000;

/// An argument of the exponential function whose result is below `2^LEAST`: `-14000 / ln 2` is `-20197.7`.
const LOWEST: f64 = -14_000.0;

/// The largest whole exponent that is raised by products: below 2^`WHOLE_BITS`.
const WHOLE_BITS: u32 = 10;

/// Returns `base` to the power `exponent`, for a base in `0..=1`, to which it is clamped, and a positive finite exponent.
///
/// 0 and 1 are exact. A base that may be zero gives a ball from 0 on; a power below `2^-20000` may only be known to be
/// between 0 and that.
///
/// ```
/// use rt_math::exact::Ball;
/// use rt_shade::certified::power;
///
/// let quarter = Ball::<2>::ONE.scale(-2);
/// assert_eq!(power(&quarter, 3.0).ends(), (0.015625, 0.015625));
/// assert_eq!(power(&quarter, 0.5).nearest_integer(), Some(1));
/// assert!((power(&quarter, 1.5).scale(3) - Ball::ONE).contains_zero());
/// ```
#[must_use]
pub fn power<const LIMBS: usize>(base: &Ball<LIMBS>, exponent: f64) -> Ball<LIMBS> {
    let base = base.clamp();
    let (low, high) = base.ends();
    // A wide ball, or one that may be zero: the power rises, so its ends tell. Those are doubles, and exact.
    if !base.is_exact() && high - low >= low / 1024.0 {
        let [lower, upper] = [low.max(0.0), high.min(1.0)].map(|end| narrow_power(&Ball::from_f64(end), exponent));
        return lower.hull(&upper);
    }
    narrow_power(&base, exponent)
}

/// Returns the power of a ball in `0..=1`, or hardly outside, that is exact or narrow.
fn narrow_power<const LIMBS: usize>(base: &Ball<LIMBS>, exponent: f64) -> Ball<LIMBS> {
    if base.sign() == Some(Ordering::Equal) {
        return Ball::ZERO;
    }
    if (base - Ball::ONE).sign() == Some(Ordering::Equal) {
        return Ball::ONE;
    }
    if exponent.fract() == 0.0 && exponent < f64::from(1 << WHOLE_BITS) {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small whole number")]
        return whole_power(base, exponent as u32);
    }
    exponential(&(logarithm(base) * Ball::from_f64(exponent)))
}

/// Returns a power with a whole exponent below 2^`WHOLE_BITS`.
fn whole_power<const LIMBS: usize>(base: &Ball<LIMBS>, exponent: u32) -> Ball<LIMBS> {
    let mut power = Ball::ONE;
    for bit in (0..WHOLE_BITS).rev() {
        power = power.square();
        if exponent >> bit & 1 == 1 {
            power = power * base;
        }
    }
    power
}

/// Returns the natural logarithm of a positive number.
fn logarithm<const LIMBS: usize>(x: &Ball<LIMBS>) -> Ball<LIMBS> {
    let Some(exponent) = x.exponent() else { return Ball::UNKNOWN };
    // A rest between 0.7 and 1.42, so that the argument of the series is below 0.18.
    let exponent = exponent - i32::from(x.scale(-exponent).ends().0 < std::f64::consts::FRAC_1_SQRT_2);
    let rest = x.scale(-exponent);
    let argument = (rest - Ball::ONE) / (rest + Ball::ONE);
    if (argument.abs() - Ball::ONE.scale(-1)).sign() != Some(Ordering::Less) {
        return Ball::UNKNOWN;
    }
    let whole = if exponent == 0 { Ball::ZERO } else { Ball::from_integer(exponent.into()) * constant(&LN_2) };
    whole + inverse_tangent::<true, LIMBS>(&argument).scale(1)
}

/// Returns the exponential function of a number that is at most 0, or hardly above.
fn exponential<const LIMBS: usize>(x: &Ball<LIMBS>) -> Ball<LIMBS> {
    let (low, high) = x.ends();
    if high < LOWEST {
        return Ball::ZERO.hull(&Ball::ONE.scale(LEAST));
    }
    // A wide ball: the function rises, so its ends tell. Those are doubles, and narrow.
    if high - low > 1.0 / 1024.0 {
        let lower = if low < LOWEST { Ball::ZERO } else { narrow_exponential(&Ball::from_f64(low)) };
        return lower.hull(&narrow_exponential(&Ball::from_f64(high.min(0.0))));
    }
    narrow_exponential(x)
}

/// Halvings of the argument.
const fn halvings(limbs: usize) -> i32 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "a small number")]
    let steps = 3 + (4 * limbs).isqrt() as i32;
    steps
}

/// Terms of the series: for `|x| <= 2^(-1 - halvings)` the term `x^n / n!` is then at most `2^(-64 limbs)`, since `j` is at
/// least `2^⌊log2 j⌋`.
const fn terms(limbs: usize) -> i64 {
    let (mut n, mut below) = (0u32, 0);
    while below < 64 * limbs {
        n += 1;
        below += (halvings(limbs).unsigned_abs() + 1 + n.ilog2()) as usize;
    }
    n as i64
}

/// Returns the exponential function of a ball not wider than 1/1024, between about -14000 and 0.
fn narrow_exponential<const LIMBS: usize>(x: &Ball<LIMBS>) -> Ball<LIMBS> {
    let steps = const { halvings(LIMBS) };
    let ln_2 = constant(&LN_2);
    // Any whole number near by will do; this one leaves a rest below 0.36.
    let Some(whole) = (x / ln_2).nearest_integer() else { return Ball::UNKNOWN };
    let (Ok(exponent), rest) = (i32::try_from(whole), x - Ball::from_integer(whole) * ln_2) else {
        return Ball::UNKNOWN;
    };
    if (rest.abs() - Ball::ONE.scale(-1)).sign() != Some(Ordering::Less) {
        return Ball::UNKNOWN;
    }
    let rest = rest.scale(-steps);
    let mut sum = Ball::ONE;
    for term in (1..const { terms(LIMBS) }).rev() {
        sum = Ball::ONE + rest * sum / Ball::from_integer(term);
    }
    // What is left out is below twice its first term.
    let mut power = sum.widen(&Ball::ONE.scale(1 - bits::<LIMBS>()));
    for _ in 0..steps {
        power = power.square();
    }
    power.scale(exponent)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::certified::truth::{assert_encloses, but_for, long};
    use oracle::{Big, Random, exact, power_of_two};

    /// Bits that a power may lose (`docs/numerics.md`, 13.6).
    const LOST: i32 = 24;

    fn truth<const LIMBS: usize>(base: f64, exponent: f64) -> Big {
        (long::<LIMBS>(&exact(base)).ln() * long::<LIMBS>(&exact(exponent))).exp()
    }

    /// A base between 0 and 1, some near these, and an exponent by which the power is not always tiny.
    fn case(rng: &mut Random) -> (f64, f64) {
        let base = match rng.below(4) {
            0 => rng.with_exponent(-300..0).abs(),
            1 => 1.0 - rng.with_exponent(-53..-1).abs(),
            _ => rng.within(0.01, 1.0),
        };
        let exponent = match rng.below(4) {
            0 => rng.within(0.0, 10.0),
            1 => rng.whole(1, 2000),
            2 => rng.within(0.0, 9000.0) / -base.ln(),
            _ => rng.exponent(-5.0, 4.0).abs(),
        };
        (base, exponent)
    }

    fn powers_are_enclosed<const LIMBS: usize>(cases: usize) {
        let mut rng = Random::new(LIMBS as u64);
        let mut tiny = 0;
        for _ in 0..cases {
            let (base, exponent) = case(&mut rng);
            let found = power(&Ball::<LIMBS>::from_f64(base), exponent);
            let truth = truth::<LIMBS>(base, exponent);
            if truth < power_of_two(LEAST + 100) {
                assert_encloses(&found, &truth, &power_of_two(LEAST + 101));
                tiny += 1;
            } else {
                assert_encloses(&found, &truth, &but_for::<LIMBS>(LOST, &truth));
            }
        }
        assert!(tiny > 0 || cases < 100, "{tiny}");
    }

    #[test]
    fn powers_are_enclosed_at_any_precision() {
        powers_are_enclosed::<1>(300);
        powers_are_enclosed::<2>(300);
        powers_are_enclosed::<4>(300);
        powers_are_enclosed::<32>(20);
    }

    #[test]
    fn a_power_of_a_wide_ball_contains_those_of_its_numbers() {
        let mut rng = Random::new(50);
        for _ in 0..300 {
            let (base, exponent) = case(&mut rng);
            let radius = base * rng.with_exponent(-40..2).abs();
            let found = power(&Ball::<2>::from_f64(base).widen(&Ball::from_f64(radius)), exponent);
            for share in [-1.0, -0.5, 0.0, 0.5, 1.0] {
                let inside = (base + radius * share * 0.99).clamp(0.0, 1.0);
                if inside > 0.0 && (inside - base).abs() <= radius {
                    assert_encloses(&found, &truth::<2>(inside, exponent), &exact(1.001));
                }
            }
            assert!(found.ends().0 <= 1.0 && found.ends().1 >= 0.0, "{found:?}");
        }
    }

    #[test]
    fn zero_and_one_are_exact_and_what_is_outside_is_clamped() {
        type Number = Ball<2>;
        for exponent in [1e-300, 0.5, 1.0, 64.0, 1e4, f64::MAX] {
            for (base, expected) in
                [(Number::ZERO, 0.0), (Number::ONE, 1.0), (-Number::ONE, 0.0), (Number::ONE.scale(1), 1.0)]
            {
                let found = power(&base, exponent);
                assert_eq!((found.is_exact(), found.ends()), (true, (expected, expected)), "{base:?} {exponent}");
            }
            let dust = Number::ONE.scale(-100);
            let (low, high) = power(&Number::ZERO.widen(&dust), exponent).ends();
            assert!(low <= 0.0 && low > -1e-9 && high >= 0.0 && high <= 2f64.powf(-100.0 * exponent) * 1.001 + 1e-300);
        }
        assert_eq!(power(&Number::from_f64(0.75), 2.0).ends(), (0.5625, 0.5625), "whole exponents are products");
        let (low, high) = power(&Number::UNKNOWN, 2.5).ends();
        assert!((-0.001..=0.0).contains(&low) && (1.0..=1.001).contains(&high));
    }
}
