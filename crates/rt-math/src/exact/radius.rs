//! Magnitudes of 32 bits that bound others: the radii of balls.
//!
//! Each operation says which way it rounds. The exponents are clamped far outside those of midpoints: below, a bound is
//! the least one; above, it is infinite.

/// A bound that is not negative: `mantissa 2^exponent`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bound {
    /// In `2^31 .. 2^32`, or zero.
    mantissa: u64,
    exponent: i32,
}

/// The largest exponent of a finite bound; its negative is the least of one that is not zero.
const MOST: i32 = 2_000_000_000;

const ONE: u64 = 1 << 31;

impl Bound {
    pub(super) const ZERO: Self = Self { mantissa: 0, exponent: 0 };

    /// Bounds any number.
    pub(super) const INFINITY: Self = Self { mantissa: ONE, exponent: i32::MAX };

    /// The bound next above or at `bits 2^exponent`.
    #[inline]
    pub(super) fn above(bits: u64, exponent: i64) -> Self {
        let drop = 32 - bits.leading_zeros().cast_signed();
        if bits == 0 {
            return Self::ZERO;
        }
        if drop <= 0 {
            return Self::clamped(bits << -drop, exponent + i64::from(drop));
        }
        let kept = bits >> drop;
        match kept + u64::from(kept << drop != bits) {
            carried if carried == 2 * ONE => Self::clamped(ONE, exponent + i64::from(drop) + 1),
            mantissa => Self::clamped(mantissa, exponent + i64::from(drop)),
        }
    }

    /// A bound with an exponent of any size, rounded up.
    #[inline]
    fn clamped(mantissa: u64, exponent: i64) -> Self {
        match i32::try_from(exponent) {
            Ok(exponent) if exponent > MOST => Self::INFINITY,
            Ok(exponent) if exponent >= -MOST => Self { mantissa, exponent },
            _ if exponent > 0 => Self::INFINITY,
            _ => Self { mantissa: ONE, exponent: -MOST },
        }
    }

    /// 2ᵏ.
    #[inline]
    pub(super) fn power_of_two(k: i64) -> Self {
        Self::clamped(ONE, k - 31)
    }

    #[inline]
    pub(super) fn is_zero(self) -> bool {
        self.mantissa == 0
    }

    #[inline]
    pub(super) fn is_infinite(self) -> bool {
        self.exponent > MOST
    }

    /// The mantissa, in `2^31 .. 2^32` or zero, and the exponent of its last bit.
    #[inline]
    pub(super) fn parts(self) -> (u64, i64) {
        (self.mantissa, i64::from(self.exponent))
    }

    /// The sum, rounded up.
    #[inline]
    pub(super) fn plus(self, other: Self) -> Self {
        let (large, small) = if self.exponent >= other.exponent { (self, other) } else { (other, self) };
        if large.is_infinite() || small.is_zero() {
            return large;
        }
        if large.is_zero() {
            return small;
        }
        Self::above((large.mantissa << 16) + small.moved_up(large.exponent), i64::from(large.exponent) - 16)
    }

    /// A lower bound of the difference, zero if it may be negative.
    #[inline]
    pub(super) fn minus(self, other: Self) -> Self {
        if other.is_zero() {
            return self;
        }
        if self.is_zero() || other.exponent > self.exponent {
            return Self::ZERO;
        }
        let difference = (self.mantissa << 16).saturating_sub(other.moved_up(self.exponent));
        // The last bits are cut off, so that this is `above` of a number of 32 bits, which is exact.
        let drop = (32 - difference.leading_zeros().cast_signed()).max(0);
        Self::above(difference >> drop << drop, i64::from(self.exponent) - 16)
    }

    /// The mantissa over `2^(exponent - 16)`, rounded up; the exponent is not below this one's.
    #[inline]
    fn moved_up(self, exponent: i32) -> u64 {
        let shift = i64::from(exponent) - i64::from(self.exponent);
        let wide = self.mantissa << 16;
        let kept = u32::try_from(shift).ok().and_then(|shift| wide.checked_shr(shift)).unwrap_or(0);
        kept + u64::from(shift != 0)
    }

    /// The product, rounded up. Zero times infinity is zero: what is bounded is finite.
    #[inline]
    pub(super) fn times(self, other: Self) -> Self {
        if self.is_infinite() && !other.is_zero() || other.is_infinite() && !self.is_zero() {
            return Self::INFINITY;
        }
        Self::above(self.mantissa * other.mantissa, i64::from(self.exponent) + i64::from(other.exponent))
    }

    /// The quotient, rounded up; infinite if the divisor is zero.
    #[inline]
    pub(super) fn over(self, divisor: Self) -> Self {
        if divisor.is_zero() || self.is_infinite() {
            return Self::INFINITY;
        }
        let exponent = i64::from(self.exponent) - i64::from(divisor.exponent);
        Self::above((self.mantissa << 32).div_ceil(divisor.mantissa), exponent - 32)
    }

    /// The square root, rounded up.
    #[inline]
    pub(super) fn sqrt(self) -> Self {
        if self.is_infinite() {
            return self;
        }
        // 62 or 63 bits with an even exponent
        let odd = self.exponent & 1;
        let wide = self.mantissa << (30 + odd);
        let root = wide.isqrt();
        Self::above(root + u64::from(root * root != wide), (i64::from(self.exponent) - 30 - i64::from(odd)) / 2)
    }

    /// The bound times 2ᵏ.
    #[inline]
    pub(super) fn scale(self, k: i64) -> Self {
        if self.is_zero() || self.is_infinite() {
            return self;
        }
        Self::clamped(self.mantissa, i64::from(self.exponent) + k)
    }
}
