//! Numbers of any length, and how they round to doubles.

use std::cmp::Ordering;

use dashu::base::{Abs, BitTest};
use dashu::float::FBig;
use dashu::float::round::mode::HalfEven;
use dashu::integer::IBig;

/// A binary number of any length.
pub type Big = FBig<HalfEven, 2>;

/// Bits of what cannot be exact.
const BITS: usize = 400;

/// Returns the value of a finite double.
#[must_use]
pub fn exact(x: f64) -> Big {
    Big::try_from(x).expect("a finite double").with_precision(0).value()
}

/// Returns `2^k`.
#[must_use]
pub fn power_of_two(k: i32) -> Big {
    Big::from_parts(IBig::ONE, k as isize).with_precision(0).value()
}

/// Returns the number in 400 bits, for what is not exact.
#[must_use]
pub fn long(a: &Big) -> Big {
    a.clone().with_precision(BITS).value()
}

/// Returns `a / b` in 400 bits.
#[must_use]
pub fn quotient(a: &Big, b: &Big) -> Big {
    long(a) / long(b)
}

/// Returns the square root in 400 bits.
#[must_use]
pub fn root(a: &Big) -> Big {
    long(a).sqrt()
}

/// Returns half a turn in 400 bits.
#[must_use]
pub fn pi() -> Big {
    Big::pi(BITS)
}

/// Returns the sign; `Less`: negative.
#[must_use]
pub fn sign(a: &Big) -> Ordering {
    a.cmp(&Big::ZERO)
}

/// Returns the double nearest to a number, ties to even. Zero is +0.0; what underflows keeps its sign; beyond the range
/// it is infinite.
#[must_use]
pub fn rounded(a: &Big) -> f64 {
    let size = a.clone().abs();
    if size >= exact(2.0 * f64::MIN_POSITIVE) {
        // dashu 0.6 takes what is above the largest double for infinite.
        let found = a.to_f64().value();
        let too_far = found.is_infinite() && size < midpoint(f64::MAX.to_bits());
        return if too_far { f64::MAX.copysign(found) } else { found };
    }
    // Where doubles are evenly spaced, dashu 0.6 rounds 0.57 of the spacing down; so this counts spacings.
    let spacings = size * power_of_two(1074);
    let below = spacings.floor();
    let (rest, half) = (spacings - &below, exact(0.5));
    let count = below.to_f64().value();
    let up = rest > half || (rest == half && count % 2.0 != 0.0);
    let magnitude = (count + f64::from(u8::from(up))) * f64::from_bits(1);
    if sign(a) == Ordering::Less { -magnitude } else { magnitude }
}

/// Whether `x` is the double nearest to the number that `compare` tells from any other (`Less`: the number is smaller):
/// between the midpoints to both neighbours, on one of them only if `x` is even. An exact zero must be +0.0.
#[must_use]
pub fn is_rounding_of(x: f64, compare: impl Fn(&Big) -> Ordering) -> bool {
    let sign = compare(&Big::ZERO);
    if sign == Ordering::Equal || x.is_nan() {
        return x.to_bits() == 0;
    }
    let negative = sign == Ordering::Less;
    if x.is_sign_negative() != negative {
        return false;
    }
    let bits = x.abs().to_bits();
    let not_beyond = |midpoint: Big, outside: Ordering| {
        let order = if negative { compare(&-midpoint).reverse() } else { compare(&midpoint) };
        order != outside && (order != Ordering::Equal || bits & 1 == 0)
    };
    (bits == 0 || not_beyond(midpoint(bits - 1), Ordering::Less))
        && (x.is_infinite() || not_beyond(midpoint(bits), Ordering::Greater))
}

/// Whether the number that `compare` tells from any other is halfway between `x` and a neighbour of it.
#[must_use]
pub fn is_tie(x: f64, compare: impl Fn(&Big) -> Ordering) -> bool {
    let bits = x.abs().to_bits();
    let is_at = |midpoint: Big| compare(&if x.is_sign_negative() { -midpoint } else { midpoint }) == Ordering::Equal;
    (bits > 0 && is_at(midpoint(bits - 1))) || (x.is_finite() && is_at(midpoint(bits)))
}

/// Halfway from the double with these bits, not negative, to the next; infinity stands for 2^1024, its place in the
/// sequence.
fn midpoint(bits: u64) -> Big {
    let value = |bits: u64| {
        if bits == f64::INFINITY.to_bits() { power_of_two(1024) } else { exact(f64::from_bits(bits)) }
    };
    (value(bits) + value(bits + 1)) * exact(0.5)
}

/// Whether `x` is the double nearest to `numerator / denominator`; the denominator is not zero.
#[must_use]
pub fn is_rounded_quotient(x: f64, numerator: &Big, denominator: &Big) -> bool {
    let negative = sign(denominator) == Ordering::Less;
    is_rounding_of(x, |m| {
        let order = numerator.cmp(&(m * denominator));
        if negative { order.reverse() } else { order }
    })
}

/// Returns the distance of `computed` from `exact`, in units in the last place of a double at `exact`.
#[must_use]
pub fn ulps(computed: f64, exact: &Big) -> f64 {
    let (significand, exponent) = exact.repr().clone().into_parts();
    let leading = if significand == IBig::ZERO { -1022 } else { exponent + significand.bit_len() as isize - 1 };
    let ulp = Big::from_parts(IBig::ONE, leading.max(-1022) - 52);
    quotient(&(self::exact(computed) - exact), &ulp).to_f64().value().abs()
}

/// Returns the relative error of `high + low`.
#[must_use]
pub fn relative_error((high, low): (f64, f64), exact: &Big) -> f64 {
    let difference = self::exact(high) + self::exact(low) - exact;
    if sign(&difference) == Ordering::Equal { 0.0 } else { quotient(&difference, exact).to_f64().value().abs() }
}

/// Returns `base` to the power `exponent`, for a positive base, in 400 bits.
#[must_use]
pub fn power(base: f64, exponent: f64) -> Big {
    (long(&exact(base)).ln() * long(&exact(exponent))).exp()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Random;

    #[test]
    fn values_at_the_ends_of_the_range_round_as_doubles_do() {
        let tiny = f64::from_bits(1);
        let share = |part: f64, of: f64| rounded(&(quotient(&exact(part), &exact(of)) * exact(tiny)));
        let shares = [(-172.0, -1.0), (86.0, 1.0), (75.0, 0.0), (76.0, 1.0), (149.0, 1.0), (225.0, 2.0)];
        for (part, expected) in shares {
            assert_eq!(share(part, 150.0), expected * tiny, "{part}/150 of the least double");
        }
        let edge = f64::MIN_POSITIVE.next_down();
        assert_eq!([edge, -edge, 2.0 * edge].map(|x| rounded(&exact(x))), [edge, -edge, 2.0 * edge]);
        assert_eq!(rounded(&(exact(f64::MAX) + exact(f64::MAX))), f64::INFINITY);
    }

    #[test]
    fn hard_numbers_round_and_are_judged_alike() {
        let mut random = Random::new(1);
        let mut ties = 0;
        for _ in 0..10_000 {
            let x = random.finite();
            let dust = random.pick(&[0.0, 1.0, -1.0]) * x;
            let number = midpoint(x.abs().to_bits()) + exact(dust) * power_of_two(-70);
            let (found, compare) = (rounded(&number), |m: &Big| number.cmp(m));
            assert!(is_rounding_of(found, compare), "{x:e} {dust:e} gives {found:e}");
            assert!(!is_rounding_of(found.next_down(), compare));
            assert!(found.is_infinite() || !is_rounding_of(found.next_up(), compare));
            assert_eq!(is_tie(found, compare), dust == 0.0, "{x:e} {dust:e}");
            ties += usize::from(dust == 0.0);
            let negative = -&number;
            assert!(is_rounding_of(-found, |m| negative.cmp(m)));
        }
        assert!(ties > 1000, "{ties}");
    }

    #[test]
    fn quotients_are_rounded_as_the_hardware_does() {
        let mut random = Random::new(2);
        for _ in 0..10_000 {
            let (n, d) = (random.finite(), random.finite());
            if d != 0.0 {
                assert!(is_rounded_quotient(n / d, &exact(n), &exact(d)) || n == 0.0, "{n:e} / {d:e}");
            }
        }
        assert!(
            !is_rounded_quotient(-0.0, &exact(0.0), &exact(1.0)) && is_rounded_quotient(0.0, &exact(0.0), &exact(1.0))
        );
    }

    #[test]
    fn powers_and_errors_are_known() {
        assert_eq!(rounded(&power(0.25, 1.5)), 0.125);
        assert_eq!(relative_error((0.25, 2f64.powi(-60)), &exact(0.25)), 2f64.powi(-58));
        assert_eq!(relative_error((1.0, 0.0), &exact(1.0)), 0.0);
    }

    #[test]
    fn an_ulp_is_the_spacing_of_doubles() {
        assert_eq!(ulps(1.0, &exact(1.0)), 0.0);
        assert_eq!(ulps(1.0 + f64::EPSILON, &exact(1.0)), 1.0);
        assert_eq!(ulps(2.0, &(exact(2.0) - exact(f64::EPSILON))), 1.0);
        assert_eq!(ulps(f64::from_bits(3), &exact(f64::from_bits(1))), 2.0);
    }
}
