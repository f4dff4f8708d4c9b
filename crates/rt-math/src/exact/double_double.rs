//! Double-double arithmetic: a number as the unevaluated sum of two doubles, about 106 bits.
//!
//! The operations are the classical ones (Dekker 1971; Joldes, Muller, Popescu, "Tight and rigorous error bounds for
//! basic building blocks of double-word arithmetic", 2017); the bounds stated are a little wider than theirs, because
//! `docs/numerics.md` proves them on half a page.

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::error_free::{fast_two_sum, two_diff, two_prod, two_sum};

/// The unevaluated sum `high + low` of two doubles, with `high = RN(high + low)`.
///
/// With `u` = 2⁻⁵³, the relative error of one operation is at most
///
/// | operation | bound | | operation | bound |
/// | --- | --- | --- | --- | --- |
/// | `sum`, `difference`, `product` of doubles | 0 | | `*` | 9 u² |
/// | `+`, `-` | 6 u² | | `/` | 14 u² |
/// | `scale` | 0 | | `sqrt` | 6 u² |
///
/// provided that no operand, intermediate or result overflows and that each non-zero one is large enough: products,
/// dividends and quotients at least 2⁻⁹⁰⁰, radicands at least 2⁻⁸⁰⁰, and factors and quotients at most 2⁹⁹⁵. Sums have
/// no lower limit. `FMA` changes the speed, never the bits.
///
/// ```
/// use rt_math::exact::DoubleDouble;
///
/// let two = DoubleDouble::<false>::new(2.0);
/// let root = two.sqrt();
/// let error = root * root - two;
/// assert!(error.high().abs() < 1e-31);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleDouble<const FMA: bool> {
    high: f64,
    low: f64,
}

impl<const FMA: bool> DoubleDouble<FMA> {
    /// Zero.
    pub const ZERO: Self = Self::new(0.0);

    /// The double `x` itself.
    #[inline(always)]
    #[must_use]
    pub const fn new(x: f64) -> Self {
        Self { high: x, low: 0.0 }
    }

    /// The exact value of `a + b`.
    #[inline(always)]
    #[must_use]
    pub fn sum(a: f64, b: f64) -> Self {
        let (high, low) = two_sum(a, b);
        Self { high, low }
    }

    /// The exact value of `a - b`.
    #[inline(always)]
    #[must_use]
    pub fn difference(a: f64, b: f64) -> Self {
        let (high, low) = two_diff(a, b);
        Self { high, low }
    }

    /// The exact value of `a b`, in the range of [`two_prod`].
    #[inline(always)]
    #[must_use]
    pub fn product(a: f64, b: f64) -> Self {
        let (high, low) = two_prod::<FMA>(a, b);
        Self { high, low }
    }

    /// The leading double: the value rounded to nearest.
    #[inline(always)]
    #[must_use]
    pub const fn high(self) -> f64 {
        self.high
    }

    /// The trailing double, at most half a unit in the last place of `high`.
    #[inline(always)]
    #[must_use]
    pub const fn low(self) -> f64 {
        self.low
    }

    /// The value times `factor`, which must be a power of two; exact unless a part over- or underflows.
    #[inline(always)]
    #[must_use]
    pub fn scale(self, factor: f64) -> Self {
        Self { high: self.high * factor, low: self.low * factor }
    }

    /// The square root; the value must not be negative, and zero gives zero.
    #[inline(always)]
    #[must_use]
    pub fn sqrt(self) -> Self {
        if self.high == 0.0 {
            return Self::ZERO;
        }
        let root = self.high.sqrt();
        let (square, square_error) = two_prod::<FMA>(root, root);
        let remainder = ((self.high - square) - square_error) + self.low;
        Self::normal(root, remainder / (2.0 * root))
    }

    /// `high + low` brought to the form that the type promises; `|high| >= |low|`.
    #[inline(always)]
    fn normal(high: f64, low: f64) -> Self {
        let (high, low) = fast_two_sum(high, low);
        Self { high, low }
    }
}

impl<const FMA: bool> Add for DoubleDouble<FMA> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        // Modelled in docs/proofs/DoubleDouble.v, as the other operations are: add_high, add_low.
        let (sum, sum_error) = two_sum(self.high, other.high);
        let (tail, tail_error) = two_sum(self.low, other.low);
        let (sum, rest) = fast_two_sum(sum, sum_error + tail);
        Self::normal(sum, rest + tail_error)
    }
}

impl<const FMA: bool> Neg for DoubleDouble<FMA> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl<const FMA: bool> Sub for DoubleDouble<FMA> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<const FMA: bool> Mul for DoubleDouble<FMA> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let (product, error) = two_prod::<FMA>(self.high, other.high);
        let crossed = self.high * other.low + self.low * other.high;
        Self::normal(product, error + crossed)
    }
}

impl<const FMA: bool> Div for DoubleDouble<FMA> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let quotient = self.high / other.high;
        let (product, error) = two_prod::<FMA>(quotient, other.high);
        let remainder = ((self.high - product) - error) + (self.low - quotient * other.low);
        Self::normal(quotient, remainder / other.high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use oracle::{Big, Random, exact, power_of_two};

    type Number = DoubleDouble<false>;
    type Fused = DoubleDouble<true>;

    fn value<const FMA: bool>(x: DoubleDouble<FMA>) -> Big {
        exact(x.high) + exact(x.low)
    }

    /// `|approximate - true| <= bound * u^2 * |true|`, where `true` is a quotient.
    fn assert_within(approximate: Number, (truth, divisor): (&Big, &Big), bound: u32, input: (Number, Number)) {
        assert_eq!(approximate.high, approximate.high + approximate.low, "not normal: {input:?}");
        let error = value(approximate) * divisor - truth;
        let limit = exact(f64::from(bound)) * power_of_two(-106) * truth;
        assert!(&error * &error <= &limit * &limit, "{input:?} gives {approximate:?}");
    }

    fn number(rng: &mut Random) -> Number {
        let high = rng.with_exponent(-100..100);
        Number::sum(high, high * rng.with_exponent(-60..-53))
    }

    #[test]
    fn operations_keep_their_bounds_and_their_bits_with_fma() {
        let mut rng = Random::new(3);
        for i in 0..10_000 {
            let x = number(&mut rng);
            // every third pair nearly cancels, in the leading part or in both
            let y = match i % 3 {
                0 => number(&mut rng),
                1 => Number::sum(-x.high, x.high * rng.with_exponent(-60..-53)),
                _ => Number::sum(-x.high.next_up(), -x.low),
            };
            let one = exact(1.0);
            assert_within(x + y, (&(value(x) + value(y)), &one), 6, (x, y));
            assert_within(x - y, (&(value(x) - value(y)), &one), 6, (x, y));
            assert_within(x * y, (&(value(x) * value(y)), &one), 9, (x, y));
            assert_within(x / y, (&value(x), &value(y)), 14, (x, y));
            let fused = |x: Number| Fused { high: x.high, low: x.low };
            assert_eq!(fused(x * y), fused(x) * fused(y));
            assert_eq!(fused(x / y), fused(x) / fused(y));
            let square = if x.high < 0.0 { -x } else { x };
            assert_eq!(fused(square.sqrt()), fused(square).sqrt());
        }
    }

    #[test]
    fn square_root_keeps_its_bound() {
        let mut rng = Random::new(4);
        for _ in 0..10_000 {
            let x = number(&mut rng);
            let x = if x.high < 0.0 { -x } else { x };
            // |r - sqrt x| <= 6 u^2 sqrt x, told without the root: (1 - 6 u^2)^2 x <= r^2 <= (1 + 6 u^2)^2 x
            let (low, high) = (exact(1.0) - bound(), exact(1.0) + bound());
            let sqr = |x: &Big| x * x;
            let square = sqr(&value(x.sqrt()));
            assert!(square >= sqr(&low) * value(x) && square <= sqr(&high) * value(x), "{x:?}");
        }
        fn bound() -> Big {
            exact(6.0 * 2f64.powi(-106))
        }
        assert_eq!(Number::ZERO.sqrt(), Number::ZERO);
    }
}
