//! Real numbers enclosed: a midpoint of fixed length and a radius.
//!
//! A number that no format holds, a root or an angle, is known by a ball that contains it. Every operation gives a ball
//! that contains its result for all numbers of the operands, so an answer that is the same for the whole ball is
//! proved. What is still open is asked again with more limbs.
//!
//! The midpoint is computed as with integers, and cut to its leading bits; what is cut off goes into the radius, as do
//! the radii of the operands, always rounded up. So a result that fits is exact: its radius is zero.

use core::array::from_fn;
use core::cmp::Ordering;
use core::ops::{Add, Div, Mul, Neg, Sub};

use super::Dyadic;
use super::by_value::by_value;
use super::radius::Bound;
use super::vector::{FromDifference, Product};
use super::wide::{Wide, quotient};

/// The numbers within `radius` of a midpoint of `64 LIMBS` bits.
///
/// One operation on exact numbers errs by at most one unit of the last of these bits, relative to its result; a result
/// that fits is exact. Exponents reach `±2^30`: what is smaller is a ball around zero, what is larger is
/// [`UNKNOWN`](Self::UNKNOWN).
///
/// ```
/// use rt_math::exact::Ball;
///
/// type Number = Ball<4>;
/// let [two, three] = [2, 3].map(Number::from_integer);
/// let third = Number::ONE / three;
/// assert!((third * three - Number::ONE).contains_zero() && !third.is_exact());
/// assert_eq!(two.sqrt().ends(), (2f64.sqrt().next_down(), 2f64.sqrt()));
/// assert_eq!((three * three).sqrt().floor(), Some(3));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Ball<const LIMBS: usize> {
    negative: bool,
    /// The midpoint is in `2^(exponent - 1) .. 2^exponent`; 0 if it is zero.
    exponent: i32,
    /// The fraction, the lowest limb first; the highest bit is set unless the midpoint is zero.
    limbs: [u64; LIMBS],
    radius: Bound,
}

/// The largest exponent of a midpoint, and the negative of the least.
const LIMIT: i64 = 1 << 30;

/// What is exact, or nothing.
impl<const LIMBS: usize> Ball<LIMBS> {
    /// The bits of a midpoint.
    const BITS: i64 = 64 * LIMBS as i64;

    /// Zero.
    pub const ZERO: Self = Self { negative: false, exponent: 0, limbs: [0; LIMBS], radius: Bound::ZERO };

    /// One.
    pub const ONE: Self = {
        let mut limbs = [0; LIMBS];
        limbs[LIMBS - 1] = 1 << 63;
        Self { exponent: 1, limbs, ..Self::ZERO }
    };

    /// All real numbers.
    pub const UNKNOWN: Self = Self { radius: Bound::INFINITY, ..Self::ZERO };

    /// The exact value of a finite double; of another, [`UNKNOWN`](Self::UNKNOWN).
    #[must_use]
    pub fn from_f64(x: f64) -> Self {
        let bits = x.to_bits();
        let biased = bits >> 52 & 0x7ff;
        let fraction = bits & ((1 << 52) - 1);
        match biased {
            0x7ff => Self::UNKNOWN,
            0 => Self::from_bits(x.is_sign_negative(), fraction, -1074),
            _ => Self::from_bits(x.is_sign_negative(), fraction | 1 << 52, biased.cast_signed() - 1075),
        }
    }

    /// The exact value of an integer.
    #[must_use]
    pub fn from_integer(n: i64) -> Self {
        Self::from_bits(n < 0, n.unsigned_abs(), 0)
    }

    /// The exact value of `±bits 2^exponent`.
    fn from_bits(negative: bool, bits: u64, exponent: i64) -> Self {
        if bits == 0 {
            return Self::ZERO;
        }
        let zeros = bits.leading_zeros();
        let mut limbs = [0; LIMBS];
        limbs[LIMBS - 1] = bits << zeros;
        Self::new(negative, exponent + 64 - i64::from(zeros), limbs, Bound::ZERO)
    }

    /// An integer of any length, rounded to a ball; exact if it fits.
    #[must_use]
    pub fn from_dyadic<const N: usize>(number: &Dyadic<N>) -> Self {
        let (negative, base, live) = number.parts();
        Self::from_fraction(negative, 64 * (i64::from(base) + live.len() as i64), live, Bound::ZERO)
    }

    /// The same number with a midpoint of another length.
    #[must_use]
    pub fn with_limbs<const OTHER: usize>(&self) -> Ball<OTHER> {
        Ball::from_fraction(self.negative, self.exponent.into(), &self.limbs, self.radius)
    }

    /// The ball around a fraction of any length, cut to its own; the lowest limb comes first.
    fn from_fraction(negative: bool, exponent: i64, limbs: &[u64], radius: Bound) -> Self {
        let from_top = |depth: usize| limbs.len().checked_sub(depth + 1).map_or(0, |at| limbs[at]);
        let mut wide =
            Wide { high: from_fn(|i| from_top(LIMBS - 1 - i)), low: from_fn(|i| from_top(2 * LIMBS - 1 - i)) };
        // A last bit stands for what is left out, and is cut off with it.
        let left_out = limbs.len().saturating_sub(2 * LIMBS);
        wide.low[0] |= u64::from(limbs[..left_out].iter().any(|&limb| limb != 0));
        Self::from_wide(negative, exponent, wide, radius)
    }

    /// The ball with the fraction `limbs`, of which the highest bit is set, within the range of exponents.
    fn new(negative: bool, exponent: i64, limbs: [u64; LIMBS], radius: Bound) -> Self {
        if radius.is_infinite() || exponent > LIMIT {
            return Self::UNKNOWN;
        }
        match i32::try_from(exponent) {
            Ok(exponent) if i64::from(exponent) >= -LIMIT => Self { negative, exponent, limbs, radius },
            _ => Self { radius: radius.plus(Bound::power_of_two(exponent)), ..Self::ZERO },
        }
    }

    /// The ball around the fraction `wide`, of any leading bit, cut to its length.
    fn from_wide(negative: bool, exponent: i64, wide: Wide<LIMBS>, radius: Bound) -> Self {
        let Some(zeros) = wide.leading_zeros() else {
            return Self::around_zero(radius);
        };
        let wide = wide.shift_up(zeros);
        let exponent = exponent - zeros as i64;
        let exact = wide.low == [0; LIMBS];
        Self::new(negative, exponent, wide.high, radius.plus(Self::last_bit(exponent, exact)))
    }

    /// What is lost if a midpoint of this exponent is cut off: nothing, or a unit of its last bit.
    fn last_bit(exponent: i64, exact: bool) -> Bound {
        if exact { Bound::ZERO } else { Bound::power_of_two(exponent - Self::BITS) }
    }

    /// The numbers of at most this magnitude.
    fn around_zero(radius: Bound) -> Self {
        Self { radius, ..Self::ZERO }
    }

    /// The numbers from 0 to a bound.
    fn from_zero_to(bound: Bound) -> Self {
        if bound.is_infinite() {
            return Self::UNKNOWN;
        }
        let half = bound.scale(-1);
        Self::exact_bound(half).widened(half)
    }

    /// The number that a finite bound is.
    fn exact_bound(bound: Bound) -> Self {
        let (bits, exponent) = bound.parts();
        Self::from_bits(false, bits, exponent)
    }

    /// The same with a larger radius.
    fn widened(self, by: Bound) -> Self {
        let radius = self.radius.plus(by);
        if radius.is_infinite() { Self::UNKNOWN } else { Self { radius, ..self } }
    }
}

/// Questions.
impl<const LIMBS: usize> Ball<LIMBS> {
    /// Whether the ball is a single number.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        self.radius.is_zero()
    }

    /// Whether the midpoint is zero.
    fn is_centered(&self) -> bool {
        self.limbs[LIMBS - 1] == 0
    }

    /// How the number compares with zero (`Less`: it is negative), if all numbers of the ball do so: `Equal` only for
    /// an exact zero.
    #[must_use]
    pub fn sign(&self) -> Option<Ordering> {
        let (mantissa, exponent) = self.radius.parts();
        let certain = self.is_exact()
            || !self.is_centered() && (exponent + 32, mantissa << 32) < (self.exponent.into(), self.limbs[LIMBS - 1]);
        certain.then(|| match (self.is_centered(), self.negative) {
            (true, _) => Ordering::Equal,
            (_, true) => Ordering::Less,
            (_, false) => Ordering::Greater,
        })
    }

    /// Whether the number may be zero.
    #[must_use]
    pub fn contains_zero(&self) -> bool {
        !matches!(self.sign(), Some(Ordering::Less | Ordering::Greater))
    }

    /// The largest integer that is not above the number, if it is one for the whole ball and below 2⁶² in magnitude. A
    /// ball that touches an integer without being exact leaves it open.
    #[must_use]
    pub fn floor(&self) -> Option<i64> {
        let floor = self.midpoint_floor()?;
        let inside = || {
            let above = self - Self::from_integer(floor);
            let below = Self::from_integer(floor + 1) - self;
            [above, below].iter().all(|x| x.sign() == Some(Ordering::Greater))
        };
        (self.is_exact() || inside()).then_some(floor)
    }

    /// The integer nearest to the midpoint, if it is below 2⁶²: one that the ball holds, if it holds one and is small.
    #[must_use]
    pub fn nearest_integer(&self) -> Option<i64> {
        // The midpoint decides, however wide the ball, unless it is everything.
        (self + Self::ONE.scale(-1)).midpoint_floor()
    }

    /// The floor of the midpoint, if it is below 2⁶² in magnitude.
    fn midpoint_floor(&self) -> Option<i64> {
        let top = self.limbs[LIMBS - 1];
        if self.radius.is_infinite() || self.exponent > 62 {
            return None;
        }
        let below = (64 - self.exponent).cast_unsigned();
        let whole = top.checked_shr(below).unwrap_or(0);
        let is_whole = whole.checked_shl(below).unwrap_or(0) == top && self.limbs[..LIMBS - 1].iter().all(|&x| x == 0);
        let whole = whole.cast_signed();
        Some(if !self.negative {
            whole
        } else if is_whole {
            -whole
        } else {
            -whole - 1
        })
    }

    /// The least exponent `e` such that the midpoint is below `2^e` in magnitude; `None` for the midpoint zero.
    #[must_use]
    pub fn exponent(&self) -> Option<i32> {
        (!self.is_centered()).then_some(self.exponent)
    }

    /// Two doubles between which the whole ball lies: not above its numbers, and not below them.
    #[must_use]
    pub fn ends(&self) -> (f64, f64) {
        if self.radius.is_infinite() {
            return (f64::NEG_INFINITY, f64::INFINITY);
        }
        let midpoint = Self { radius: Bound::ZERO, ..*self };
        let radius = Self::exact_bound(self.radius);
        // From 0.0, so that a zero is positive.
        (0.0 - (radius - midpoint).least_double_above(), (radius + midpoint).least_double_above())
    }

    /// A double that is not below the ball, whose radius is at most a unit of the last bit of the midpoint: the next
    /// one, or one further.
    fn least_double_above(&self) -> f64 {
        let (magnitude, exact) = self.truncated();
        match (self.negative, exact && self.is_exact()) {
            (false, true) => magnitude,
            (false, false) => magnitude.next_up(),
            // A midpoint that is cut off was further from zero by at least the radius.
            (true, certain) if certain || !exact => -magnitude,
            (true, _) => (-magnitude).next_up(),
        }
    }

    /// The magnitude of the midpoint rounded down to a double, and whether it is that.
    fn truncated(&self) -> (f64, bool) {
        if self.is_centered() {
            return (0.0, true);
        }
        if self.exponent > 1024 {
            return (f64::MAX, false);
        }
        let top = self.limbs[LIMBS - 1];
        // the exponent of the last bit kept: 53 bits, or the last bit of a subnormal
        let last = (self.exponent - 53).max(-1074);
        let drop = (last - (self.exponent - 64)).cast_unsigned();
        let kept = top.checked_shr(drop).unwrap_or(0);
        let exact = kept.checked_shl(drop).unwrap_or(0) == top && self.limbs[..LIMBS - 1].iter().all(|&x| x == 0);
        // A normal number has its leading bit in `kept`, which adds one to the biased exponent.
        let biased = u64::from((last + 1074).cast_unsigned());
        (f64::from_bits((biased << 52) + kept), exact)
    }

    /// A bound of the midpoint's magnitude, with a unit of its last bit to spare.
    fn bound_above(&self) -> Bound {
        if self.is_centered() {
            return Bound::ZERO;
        }
        Bound::above((self.limbs[LIMBS - 1] >> 1) + 1, i64::from(self.exponent) - 63)
    }

    /// A lower bound of the magnitudes of the ball.
    fn least(&self) -> Bound {
        // 32 bits: exact
        let midpoint = Bound::above(self.limbs[LIMBS - 1] >> 32, i64::from(self.exponent) - 32);
        midpoint.minus(self.radius)
    }

    /// An upper bound of the magnitudes of the ball.
    fn most(&self) -> Bound {
        self.bound_above().plus(self.radius)
    }
}

/// Functions of one ball, and sets.
impl<const LIMBS: usize> Ball<LIMBS> {
    /// The number times 2ᵏ.
    #[must_use]
    pub fn scale(&self, k: i32) -> Self {
        let radius = self.radius.scale(k.into());
        if self.is_centered() {
            return Self::around_zero(radius);
        }
        Self::new(self.negative, i64::from(self.exponent) + i64::from(k), self.limbs, radius)
    }

    /// The magnitude.
    #[must_use]
    pub fn abs(&self) -> Self {
        match self.sign() {
            Some(_) => Self { negative: false, ..*self },
            None => Self::from_zero_to(self.most()),
        }
    }

    /// The square.
    #[must_use]
    pub fn square(&self) -> Self {
        self * self
    }

    /// The larger of the number and zero.
    #[must_use]
    pub fn max_zero(&self) -> Self {
        match self.sign() {
            Some(Ordering::Less) => Self::ZERO,
            Some(_) => *self,
            None if self.radius.is_infinite() => *self,
            None => {
                let upper_end = Self { radius: Bound::ZERO, ..*self } + Self::exact_bound(self.radius);
                Self::from_zero_to(upper_end.most())
            }
        }
    }

    /// The number, or the nearer of 0 and 1 if it is not between them.
    #[must_use]
    pub fn clamp(&self) -> Self {
        let rest = Self::ONE - self;
        match (rest.sign(), self.contains_zero()) {
            (Some(Ordering::Less), _) => Self::ONE,
            (Some(_), _) => self.max_zero(),
            (None, false) => Self::ONE - rest.max_zero(),
            (None, true) => Self::from_zero_to(Bound::power_of_two(0)),
        }
    }

    /// The square root of the numbers of the ball that are not negative. An exact square is exact.
    #[must_use]
    pub fn sqrt(&self) -> Self {
        if self.is_exact() && self.is_centered() {
            return Self::ZERO;
        }
        if self.sign() != Some(Ordering::Greater) {
            return Self::from_zero_to(self.max_zero().most().sqrt());
        }
        let midpoint = Self { radius: Bound::ZERO, ..*self };
        let root = midpoint.root();
        // |√y - √x| = |y - x| / (√y + √x)
        root.widened(self.radius.over(root.least()))
    }

    /// The square root of an exact positive number.
    fn root(&self) -> Self {
        // The last digit of an even power of two; the rest is between 1/4 and 1.
        let half = (self.exponent + (self.exponent & 1)) / 2;
        let radicand = self.scale(-2 * half);
        let mut root = Self::from_f64(radicand.ends().0.sqrt());
        // Heron's step squares the relative error, from below 2^-50.
        let mut bits = 50;
        while bits < Self::BITS {
            root = Self { radius: Bound::ZERO, ..(root + radicand / root).scale(-1) };
            bits *= 2;
        }
        // The root of an exact square has half its bits.
        let short = root.shortened();
        if (short.square() - radicand).sign() == Some(Ordering::Equal) {
            return short.scale(half);
        }
        // |√x - r| = |x - r²| / (√x + r)
        let error = (radicand - root.square()).most().over(root.least());
        root.widened(error).scale(half)
    }

    /// The midpoint rounded to half its bits.
    fn shortened(&self) -> Self {
        // Added and cut off, half a unit of the last bit kept rounds to nearest.
        let unit = i64::from(self.exponent) - Self::BITS / 2;
        let mut rounded = *self + Self::from_bits(false, 1, unit - 1);
        for (i, limb) in rounded.limbs.iter_mut().enumerate() {
            let bits = 32 * LIMBS - (64 * i).min(32 * LIMBS);
            *limb &= if bits >= 64 { 0 } else { u64::MAX << bits };
        }
        Self { radius: Bound::ZERO, ..rounded }
    }

    /// The number plus any one of at most the magnitude of `bound`.
    #[must_use]
    pub fn widen(&self, bound: &Self) -> Self {
        self.widened(bound.most())
    }

    /// A ball that contains both.
    #[must_use]
    pub fn hull(&self, other: &Self) -> Self {
        // x = (x + y) / 2 + (x - y) / 2
        (self + other).scale(-1).widen(&(self - other).scale(-1))
    }
}

impl<const LIMBS: usize> Add for &Ball<LIMBS> {
    type Output = Ball<LIMBS>;

    fn add(self, other: Self) -> Ball<LIMBS> {
        let radius = self.radius.plus(other.radius);
        if radius.is_infinite() {
            return Ball::UNKNOWN;
        }
        if self.is_centered() || other.is_centered() {
            return Ball { radius, ..if self.is_centered() { *other } else { *self } };
        }
        let by_exponent = self.exponent.cmp(&other.exponent);
        let order = by_exponent.then_with(|| self.limbs.iter().rev().cmp(other.limbs.iter().rev()));
        let (large, small) = if order == Ordering::Less { (other, self) } else { (self, other) };
        let shift = (large.exponent - small.exponent).unsigned_abs() as usize;
        let exponent = i64::from(large.exponent);
        if shift > 64 * LIMBS {
            // Beyond the last bit of the larger one; such a sum does not fit.
            let lost = Bound::power_of_two(small.exponent.into());
            return Ball { radius: Bound::ZERO, ..*large }.widened(radius.plus(lost));
        }
        let small_wide = Wide { high: small.limbs, low: [0; LIMBS] }.shift_down(shift);
        let wide = Wide { high: large.limbs, low: [0; LIMBS] };
        if small.negative != large.negative {
            return Ball::from_wide(large.negative, exponent, wide.minus(&small_wide), radius);
        }
        let (sum, carry) = wide.plus(&small_wide);
        if !carry {
            return Ball::from_wide(large.negative, exponent, sum, radius);
        }
        // No bit is lost: with the last one in use, the summands do not overlap and there is no carry.
        let mut sum = sum.shift_down(1);
        sum.high[LIMBS - 1] |= 1 << 63;
        Ball::from_wide(large.negative, exponent + 1, sum, radius)
    }
}

impl<const LIMBS: usize> Sub for &Ball<LIMBS> {
    type Output = Ball<LIMBS>;

    fn sub(self, other: Self) -> Ball<LIMBS> {
        self + -other
    }
}

impl<const LIMBS: usize> Mul for &Ball<LIMBS> {
    type Output = Ball<LIMBS>;

    fn mul(self, other: Self) -> Ball<LIMBS> {
        // (x + p) (y + q) = x y + x q + y p + p q
        let radius = if self.is_exact() && other.is_exact() {
            Bound::ZERO
        } else {
            let of_self = self.radius.times(other.most());
            self.bound_above().times(other.radius).plus(of_self)
        };
        if self.is_centered() || other.is_centered() || radius.is_infinite() {
            return Ball::around_zero(radius);
        }
        let exponent = i64::from(self.exponent) + i64::from(other.exponent);
        Ball::from_wide(self.negative != other.negative, exponent, Wide::product(&self.limbs, &other.limbs), radius)
    }
}

impl<const LIMBS: usize> Div for &Ball<LIMBS> {
    type Output = Ball<LIMBS>;

    /// The quotient; [`UNKNOWN`](Ball::UNKNOWN) if the divisor may be zero.
    fn div(self, divisor: Self) -> Ball<LIMBS> {
        let least = divisor.least();
        if least.is_zero() || self.radius.is_infinite() {
            return Ball::UNKNOWN;
        }
        if self.is_centered() {
            return Ball::around_zero(self.radius.over(least));
        }
        let (whole, mut limbs, exact) = quotient(&self.limbs, &divisor.limbs);
        let mut exponent = i64::from(self.exponent) - i64::from(divisor.exponent);
        if whole {
            // If nothing is left over, the bit lost is zero: an odd factor of the dividend is not longer than it.
            exponent += 1;
            let shifted = Wide { high: limbs, low: [0; LIMBS] }.shift_down(1);
            limbs = shifted.high;
            limbs[LIMBS - 1] |= 1 << 63;
        }
        let midpoint = Ball::new(self.negative != divisor.negative, exponent, limbs, Bound::ZERO);
        // (x + p) / (y + q) - x / y = (p - q x / y) / (y + q)
        let carried = self.radius.plus(divisor.radius.times(midpoint.most())).over(least);
        midpoint.widened(carried.plus(Ball::<LIMBS>::last_bit(exponent, exact)))
    }
}

impl<const LIMBS: usize> Neg for &Ball<LIMBS> {
    type Output = Ball<LIMBS>;

    fn neg(self) -> Ball<LIMBS> {
        Ball { negative: !self.negative && !self.is_centered(), ..*self }
    }
}

impl<const LIMBS: usize> Neg for Ball<LIMBS> {
    type Output = Self;

    fn neg(self) -> Self {
        -&self
    }
}

by_value!(Ball: Add add Sub sub Mul mul Div div);

impl<const LIMBS: usize> FromDifference for Ball<LIMBS> {
    fn from_difference(a: f64, b: f64) -> Self {
        Self::from_f64(a) - Self::from_f64(b)
    }
}

impl<const LIMBS: usize> Product<Self, Self> for Ball<LIMBS> {
    fn product(&self, other: &Self) -> Self {
        self * other
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use oracle::{Big, Random, exact, power_of_two, sign};

    fn midpoint<const LIMBS: usize>(x: &Ball<LIMBS>) -> Big {
        let whole = |limb: u64| Big::from(limb).with_precision(0).value();
        let integer = x.limbs.iter().rev().fold(Big::ZERO, |sum, &limb| sum * power_of_two(64) + whole(limb));
        let magnitude = integer * power_of_two(x.exponent - 64 * i32::try_from(LIMBS).expect("small"));
        if x.negative { -magnitude } else { magnitude }
    }

    fn radius<const LIMBS: usize>(x: &Ball<LIMBS>) -> Big {
        assert!(!x.radius.is_infinite(), "{x:?}");
        let (bits, exponent) = x.radius.parts();
        Big::from(bits).with_precision(0).value() * power_of_two(i32::try_from(exponent).expect("in range"))
    }

    fn size(x: &Big) -> Big {
        if sign(x) == Ordering::Less { -x } else { x.clone() }
    }

    fn holds<const LIMBS: usize>(x: &Ball<LIMBS>, truth: &Big) -> bool {
        x.radius.is_infinite() || size(&(midpoint(x) - truth)) <= radius(x)
    }

    /// The midpoint and both ends.
    fn points<const LIMBS: usize>(x: &Ball<LIMBS>) -> [Big; 3] {
        let (m, r) = (midpoint(x), radius(x));
        [m.clone(), &m - &r, m + r]
    }

    fn assert_normal<const LIMBS: usize>(x: &Ball<LIMBS>) {
        let centered = x.limbs == [0; LIMBS];
        assert!(x.limbs[LIMBS - 1] >> 63 == 1 || centered, "{x:?}");
        assert!(!centered || !x.negative && x.exponent == 0, "{x:?}");
        let bits = x.radius.parts().0;
        assert!(bits == 0 || bits >> 31 == 1, "{x:?}");
    }

    /// An exact number: of all bits, or few; runs of ones and zeros are hard for carries and quotients.
    fn number<const LIMBS: usize>(rng: &mut Random) -> Ball<LIMBS> {
        let exponent = [-3..3, -40..40, -3000..3000][rng.below(3)].clone();
        let live = rng.below(LIMBS) + 1;
        let mut limbs = from_fn(|_| [rng.bits(), 0, u64::MAX, 1 << rng.below(64)][rng.below(4)]);
        limbs[..LIMBS - live].fill(0);
        limbs[LIMBS - 1] |= 1 << 63;
        Ball::new(rng.one_in(2), rng.integer(exponent).into(), limbs, Bound::ZERO)
    }

    /// A number that is exact in one of three cases.
    fn ball<const LIMBS: usize>(rng: &mut Random) -> Ball<LIMBS> {
        let x = number::<LIMBS>(rng);
        let depth = rng.integer(-2..64 * i32::try_from(LIMBS).expect("small"));
        let radius = Bound::above(rng.bits(), i64::from(x.exponent - depth) - 64);
        if rng.one_in(3) { x } else { x.widened(radius) }
    }

    /// A second operand: any, or one that nearly equals the first or its negative.
    fn partner<const LIMBS: usize>(rng: &mut Random, x: &Ball<LIMBS>) -> Ball<LIMBS> {
        if rng.one_in(2) {
            return ball(rng);
        }
        let mut y = *x;
        y.negative ^= rng.one_in(2);
        y.limbs[rng.below(LIMBS)] ^= rng.bits() >> rng.below(64).max(1);
        y.limbs[LIMBS - 1] |= 1 << 63;
        y.exponent += if rng.one_in(2) { 0 } else { rng.integer(-3..64 * i32::try_from(LIMBS).expect("small") + 3) };
        y
    }

    /// What one operation may add to a radius, relative to its result: a unit of the last bit; and relative to the
    /// radius, for its own rounding: seven steps of `2^-31` each.
    fn slack<const LIMBS: usize>() -> (Big, Big) {
        (power_of_two(1 - 64 * i32::try_from(LIMBS).expect("small")), exact(1.0) + power_of_two(-28))
    }

    /// Judges a result by the truth for each of the points of the operands, given as a quotient.
    fn judge<const LIMBS: usize>(result: &Ball<LIMBS>, exact_operands: bool, truths: &[(Big, Big)], spread: &Big) {
        assert_normal(result);
        let (unit, growth) = slack::<LIMBS>();
        let (m, r) = (midpoint(result), radius(result));
        for (numerator, denominator) in truths {
            assert!(size(&(&m * denominator - numerator)) <= &r * size(denominator), "{result:?}");
        }
        let (numerator, denominator) = &truths[0];
        if exact_operands {
            assert_eq!(sign(&r) == Ordering::Equal, *numerator == &m * denominator, "exact where it fits: {result:?}");
        }
        let allowed = (size(numerator) * unit + spread) * growth;
        assert!(r * size(denominator) <= allowed, "a needlessly large radius: {result:?}");
    }

    fn operations_enclose<const LIMBS: usize>(cases: usize) {
        let mut rng = Random::new(LIMBS as u64);
        let one = exact(1.0);
        for _ in 0..cases {
            let x = ball::<LIMBS>(&mut rng);
            let y = partner(&mut rng, &x);
            let exact_operands = x.is_exact() && y.is_exact();
            let ([xs, ys], [p, q]) = ([points(&x), points(&y)], [radius(&x), radius(&y)]);
            let pairs = || xs.iter().flat_map(|a| ys.iter().map(move |b| (a, b)));
            let all = |operation: &dyn Fn(&Big, &Big) -> Big| -> Vec<(Big, Big)> {
                pairs().map(|(a, b)| (operation(a, b), one.clone())).collect()
            };
            // A sum may be far smaller than what was cut off: relative to the larger operand.
            let cut = if exact_operands { size(&xs[0]).max(size(&ys[0])) * slack::<LIMBS>().0 } else { Big::ZERO };
            let spread = &p + &q + cut;
            judge(&(x + y), exact_operands, &all(&|a, b| a + b), &spread);
            judge(&(x - y), exact_operands, &all(&|a, b| a - b), &spread);
            let spread = size(&xs[0]) * &q + size(&ys[0]) * &p + &p * &q;
            judge(&(x * y), exact_operands, &all(&|a, b| a * b), &spread);
            judge(
                &x.square(),
                x.is_exact(),
                &[(&xs[0] * &xs[0], one.clone())],
                &(size(&xs[0]) * &p * exact(2.0) + &p * &p),
            );

            let quotient = x / y;
            let separated = size(&ys[0]) - &q * (&one + power_of_two(-20));
            if sign(&separated) != Ordering::Greater {
                assert!(
                    y.is_exact() || sign(&(size(&ys[0]) - &q)) == Ordering::Greater || quotient.radius.is_infinite()
                );
            } else if size(&ys[0]) > exact(8.0) * &q {
                // |y| / (|y| - q) is below 1 + 2 q / |y|.
                let truths: Vec<_> = pairs().map(|(a, b)| (a.clone(), b.clone())).collect();
                let first = (&p + oracle::quotient(&(size(&xs[0]) * &q), &size(&ys[0]))) * exact(8.0 / 7.0);
                judge(&quotient, exact_operands, &truths, &first);
            }
        }
    }

    #[test]
    fn operations_enclose_what_they_should_and_little_more() {
        operations_enclose::<1>(4000);
        operations_enclose::<2>(4000);
        operations_enclose::<4>(2000);
        operations_enclose::<32>(300);
    }

    #[test]
    fn a_difference_that_just_fits_is_exact() {
        fn check<const LIMBS: usize>() {
            let bits = 64 * i32::try_from(LIMBS).expect("small");
            let power = Ball::<LIMBS>::ONE.scale(bits);
            let difference = power - Ball::ONE;
            assert!(difference.is_exact() && midpoint(&difference) == power_of_two(bits) - exact(1.0));
            assert_eq!((difference - power + Ball::ONE).sign(), Some(Ordering::Equal));
            assert!(!(power + Ball::ONE).is_exact() && !(power.scale(1) - Ball::ONE).is_exact());
        }
        check::<1>();
        check::<2>();
        check::<32>();
    }

    fn roots_enclose<const LIMBS: usize>(cases: usize) {
        let mut rng = Random::new(100 + LIMBS as u64);
        let (unit, growth) = slack::<LIMBS>();
        for _ in 0..cases {
            let x = ball::<LIMBS>(&mut rng).abs();
            let root = x.sqrt();
            assert_normal(&root);
            let (m, r) = (midpoint(&root), radius(&root));
            let [low, high] = [&m - &r, &m + &r];
            let [middle, least, most] = points(&x);
            assert!(&high * &high >= most, "{x:?} {root:?}");
            assert!(sign(&low) != Ordering::Greater || &low * &low <= least, "{x:?} {root:?}");
            if x.sign() == Some(Ordering::Greater) {
                // Heron's step cuts twice and is off by 1.5 units, its square by 3, and cut once more.
                let allowed = radius(&x) * &growth + &middle * unit.clone() * exact(4.0);
                assert!(&r * &m <= allowed * &growth, "{x:?} {root:?}");
            }
            // Exact squares of half the bits.
            let mut short = number::<LIMBS>(&mut rng).shortened();
            short.negative = false;
            let root = short.square().sqrt();
            assert!(root.is_exact() && midpoint(&root) == midpoint(&short), "{short:?} {root:?}");
        }
    }

    #[test]
    fn roots_enclose_and_exact_squares_are_exact() {
        roots_enclose::<1>(2000);
        roots_enclose::<2>(2000);
        roots_enclose::<4>(1000);
        roots_enclose::<32>(100);
        assert_eq!(Ball::<2>::ZERO.sqrt().sign(), Some(Ordering::Equal));
    }

    fn questions_are_answered<const LIMBS: usize>(cases: usize) {
        let mut rng = Random::new(200 + LIMBS as u64);
        let (zero, one) = (exact(0.0), exact(1.0));
        let bits = 64 * i32::try_from(LIMBS).expect("small");
        let (mut open, mut closed) = (0, 0);
        for _ in 0..cases {
            let mut x = ball::<LIMBS>(&mut rng);
            if rng.one_in(2) {
                // Next to a small integer, by about the radius.
                let small = x.scale(-x.exponent - rng.integer(0..bits + 16));
                x = Ball::from_integer(rng.integer(-3..4).into()) + small.widen(&small.scale(rng.integer(-8..3)));
            }
            let [middle, least, most] = points(&x);
            let (lower, upper) = x.ends();
            let near = |end: &Big, double: f64| {
                if double.is_infinite() || double.abs() == f64::MAX {
                    return size(end) > exact(f64::MAX.next_down());
                }
                let normal = double.abs().max(f64::MIN_POSITIVE);
                size(&(end - exact(double))) <= exact(normal - normal.next_down()) * exact(4.0)
            };
            assert!(lower == f64::NEG_INFINITY || exact(lower) <= least, "{x:?}");
            assert!(upper == f64::INFINITY || exact(upper) >= most, "{x:?}");
            assert!(near(&least, lower) && near(&most, upper), "{x:?} {lower:e} {upper:e}");

            // A sign is left open only if zero is in the ball or nearly.
            let signs = [sign(&least), sign(&most)];
            match x.sign() {
                Some(sign) => assert_eq!(signs, [sign; 2], "{x:?}"),
                None => assert!(size(&middle) <= radius(&x) * (&one + power_of_two(-60)), "{x:?}"),
            }
            if let Some(floor) = x.floor() {
                let floor = exact(0.0) + Big::from(floor).with_precision(0).value();
                assert!(floor <= least && most < &floor + &one, "{x:?} {floor}");
                closed += 1;
            } else if size(&middle) < power_of_two(60) {
                let nearly = radius(&x) * power_of_two(-60);
                assert!((&least - &nearly).floor() != (&most + nearly).floor() || least.floor() == least, "{x:?}");
                open += 1;
            }
            for point in points(&x) {
                let positive = point.clone().max(zero.clone());
                assert!(holds(&x.abs(), &size(&point)), "{x:?}");
                assert!(holds(&x.max_zero(), &positive), "{x:?}");
                assert!(holds(&x.clamp(), &positive.min(one.clone())), "{x:?}");
                assert!(holds(&x.widen(&x), &(&point + &point)), "{x:?}");
                let y = ball::<LIMBS>(&mut rng);
                assert!(holds(&x.hull(&y), &point) && holds(&y.hull(&x), &point), "{x:?} {y:?}");
                let k = rng.integer(-100..100);
                assert!(holds(&x.scale(k), &(point * power_of_two(k))), "{x:?}");
            }
            assert!(x.clamp().ends().0 >= -1e-9 && x.clamp().ends().1 <= 1.0 + 1e-9, "{x:?}");
        }
        assert!(open > cases / 20 && closed > cases / 20, "{open} {closed}");
    }

    #[test]
    fn questions_are_answered_for_the_whole_ball() {
        questions_are_answered::<1>(3000);
        questions_are_answered::<2>(3000);
        questions_are_answered::<32>(300);
    }

    #[test]
    fn doubles_and_integers_are_exact_at_any_length() {
        let mut rng = Random::new(300);
        for _ in 0..3000 {
            let (x, n) = (rng.finite(), rng.bits().cast_signed() >> rng.below(64));
            let ball = Ball::<1>::from_f64(x);
            assert!(ball.is_exact() && midpoint(&ball) == exact(x), "{x:e}");
            assert_eq!(ball.ends(), (x, x));
            let ball = Ball::<1>::from_integer(n);
            assert!(ball.is_exact() && midpoint(&ball) == Big::from(n).with_precision(0).value(), "{n}");
            assert_eq!(ball.floor(), (n.unsigned_abs() < 1 << 62).then_some(n));
            assert_eq!(ball.floor(), ball.nearest_integer());
        }
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(Ball::<1>::from_f64(x).ends(), (f64::NEG_INFINITY, f64::INFINITY));
        }
    }

    #[test]
    fn integers_of_any_length_are_rounded_to_balls() {
        fn check<const LIMBS: usize>(number: &Dyadic<208>, truth: &Big) {
            let ball = Ball::<LIMBS>::from_dyadic(number);
            judge(&ball, true, &[(truth.clone(), exact(1.0))], &Big::ZERO);
        }
        let mut rng = Random::new(301);
        for _ in 0..1000 {
            let (mut number, mut truth) = (Dyadic::ZERO, Big::ZERO);
            for _ in 0..rng.below(5) {
                let [x, y] = [0; 2].map(|_| if rng.one_in(2) { rng.finite() } else { rng.with_exponent(-60..60) });
                number = number + Dyadic::from_f64(x) * Dyadic::from_f64(y);
                truth += exact(x) * exact(y);
            }
            check::<1>(&number, &truth);
            check::<2>(&number, &truth);
            check::<4>(&number, &truth);
            check::<32>(&number, &truth);
            let long = Ball::<64>::from_dyadic(&number);
            judge(&long.with_limbs::<2>(), true, &[(truth.clone(), exact(1.0))], &Big::ZERO);
            let x = ball::<4>(&mut rng);
            for point in points(&x) {
                assert!(holds(&x.with_limbs::<1>().with_limbs::<3>(), &point), "{x:?}");
            }
        }
    }

    #[test]
    fn beyond_the_range_of_exponents_a_ball_still_encloses() {
        type Number = Ball<2>;
        let limit = i32::try_from(LIMIT).expect("2^30");
        let [huge, tiny] = [limit - 1, -limit].map(|k| Number::ONE.scale(k));
        assert!(huge.is_exact() && huge.sign() == Some(Ordering::Greater));
        for beyond in [huge * huge, huge + huge, -huge / tiny, Number::ONE / Number::ZERO, Number::UNKNOWN + tiny] {
            assert_eq!(beyond.ends(), (f64::NEG_INFINITY, f64::INFINITY), "{beyond:?}");
        }
        for below in [tiny * tiny, tiny / huge, tiny.scale(-limit), tiny.scale(-2)] {
            assert_eq!(below.sign(), None, "{below:?}");
            assert_eq!(below.ends(), (-f64::from_bits(1), f64::from_bits(1)));
            assert!(!below.radius.is_zero() && (Number::ONE / below).radius.is_infinite());
            let square = below * below;
            assert!(!square.radius.is_zero() && square.sign().is_none());
        }
        assert!((huge * tiny - Number::ONE.scale(-1)).sign() == Some(Ordering::Equal));
        assert_eq!((Number::UNKNOWN * Number::ZERO).sign(), Some(Ordering::Equal), "what is unknown is finite");
        assert_eq!(Number::UNKNOWN.clamp().floor(), None);
        assert_eq!(Number::UNKNOWN.nearest_integer(), None);
        let (low, high) = Number::UNKNOWN.clamp().ends();
        assert!((-1e-9..=0.0).contains(&low) && (1.0..1.0 + 1e-9).contains(&high), "{low:e} {high:e}");
        assert_eq!(Number::UNKNOWN.sqrt().ends(), (f64::NEG_INFINITY, f64::INFINITY));
    }

    #[test]
    fn vectors_of_balls_have_products() {
        use super::super::vector;
        use glam::DVec3;

        let [a, b, c] = [DVec3::X, DVec3::Y, DVec3::new(1e-30, 1.0, 0.0)];
        let normal = vector::cross(&vector::difference::<Ball<4>>(b, a), &vector::difference(c, a));
        assert_eq!(normal.map(|x| x.ends()), [(0.0, 0.0), (0.0, 0.0), (-1e-30, -1e-30)]);
        assert_eq!(vector::dot(&normal, &normal).sqrt().ends(), (1e-30, 1e-30));
    }
}
