//! From the leading bits of long integers to the two doubles between which a quotient or a root lies.
//!
//! The leading 64 bits of the operands enclose the result so tightly that both ends round to the same double, or to
//! neighbours; then one exact comparison with the midpoint decides, which is the caller's. `docs/numerics.md`, section
//! 1.

/// The leading 64 bits of a magnitude: it is `(bits + rest) 2^exponent` with `0 <= rest < 1`.
#[derive(Clone, Copy)]
pub(super) struct Leading {
    /// The highest bit is set.
    pub(super) bits: u64,
    /// The 64 bits after these.
    pub(super) next: u64,
    pub(super) exponent: i32,
    /// Whether `rest` is not zero.
    pub(super) sticky: bool,
}

impl Leading {
    pub(super) fn interval(self) -> Interval {
        Interval { low: u128::from(self.bits), width: u128::from(self.sticky), exponent: self.exponent }
    }

    /// The square root, within one unit of 2^-63 relative.
    pub(super) fn sqrt(self) -> Interval {
        // 127 or 128 bits, so that the exponent is even; the rest is below one unit of the radicand, hence of its root
        let wide = u128::from(self.bits) << 64 | u128::from(self.next);
        let odd = self.exponent & 1;
        let radicand = wide >> odd;
        Interval { low: radicand.isqrt(), width: 1, exponent: (self.exponent - 64 + odd) / 2 }
    }
}

/// The numbers from `low 2^exponent` to `(low + width) 2^exponent`, with a small width.
#[derive(Clone, Copy)]
pub(super) struct Interval {
    low: u128,
    width: u128,
    exponent: i32,
}

impl Interval {
    pub(super) const ZERO: Self = Self { low: 0, width: 0, exponent: 0 };

    /// The same numbers times `2^exponent`.
    pub(super) fn scaled(self, exponent: i32) -> Self {
        Self { exponent: self.exponent + exponent, ..self }
    }

    /// The sum, with 63 or 64 bits, of two intervals of 64 bits.
    pub(super) fn plus(self, other: Self) -> Self {
        let exponent = self.exponent.max(other.exponent) + 1;
        let shifted = |x: Self| x.low.checked_shr((exponent - x.exponent).cast_unsigned()).unwrap_or(0);
        // each term is at most one unit wide (of its own exponent, less than half a unit here) and cut by less than
        // one unit to a multiple, so it ends at most one unit above its lower bound
        Self { low: shifted(self) + shifted(other), width: 2, exponent }
    }

    /// The product of two intervals of at most 64 bits, cut to 64 bits.
    pub(super) fn times(self, other: Self) -> Self {
        let lower = self.low * other.low;
        let cut = 64 - lower.leading_zeros().cast_signed();
        let cut = cut.max(0);
        // (a + v) (b + w) - a b = a w + b v + v w
        let width = self.low * other.width + other.low * self.width + self.width * other.width;
        Self { low: lower >> cut, width: (width >> cut) + 2, exponent: self.exponent + other.exponent + cut }
    }
}

/// Rounds both ends of a quotient of two positive intervals of 62 to 65 bits to doubles.
pub(super) fn enclose(numerator: Interval, denominator: Interval) -> (f64, f64) {
    let exponent = numerator.exponent - denominator.exponent - 62;
    let lower = (numerator.low << 62) / (denominator.low + denominator.width);
    let upper = ((numerator.low + numerator.width) << 62).div_ceil(denominator.low);
    (round(lower, exponent, false), round(upper, exponent, false))
}

/// Rounds the positive number `(bits + rest) 2^exponent` to nearest, ties to even; `sticky` tells whether the rest,
/// which is below 1, is not zero.
pub(super) fn round(bits: u128, exponent: i32, sticky: bool) -> f64 {
    if bits == 0 {
        return 0.0; // only with a rest far below the smallest double, or zero itself
    }
    let length = 128 - bits.leading_zeros().cast_signed();
    let highest = exponent + length - 1; // the weight of the leading bit
    if highest > 1023 {
        return f64::INFINITY;
    }
    // the weight of the last bit kept: 53 bits, or the last bit of a subnormal
    let last = (highest - 52).max(-1074);
    let drop = last - exponent;
    if drop <= 0 {
        // all bits fit: exact but for a rest, which callers only have with longer numbers
        debug_assert!(!sticky);
        return compose(low(bits << -drop), highest);
    }
    if drop > 128 {
        return 0.0;
    }
    let drop = drop.cast_unsigned();
    let kept = bits.checked_shr(drop).unwrap_or(0);
    let dropped = bits - kept.checked_shl(drop).unwrap_or(0);
    let half = 1 << (drop - 1);
    let up = dropped > half || dropped == half && (sticky || kept & 1 == 1);
    compose(low(kept) + u64::from(up), highest)
}

/// The double with the 53-bit significand `kept` (2^53 carries over) and leading bit of weight `2^highest`, or the
/// subnormal `kept 2^-1074` if `highest` is below the normal range.
fn compose(kept: u64, highest: i32) -> f64 {
    let biased = u64::from((highest + 1022).max(0).cast_unsigned());
    f64::from_bits((biased << 52) + kept)
}

#[expect(clippy::cast_possible_truncation, reason = "the lower half is asked for")]
pub(super) fn low(wide: u128) -> u64 {
    wide as u64
}

pub(super) fn high(wide: u128) -> u64 {
    low(wide >> 64)
}

/// `x + y + carry`, and the carry: what `u64::carrying_add` does from Rust 1.91 on.
#[inline(always)]
pub(super) fn add_with_carry(x: u64, y: u64, carry: bool) -> (u64, bool) {
    let (sum, first) = x.overflowing_add(y);
    let (sum, second) = sum.overflowing_add(carry.into());
    (sum, first | second)
}

/// `x - y - borrow`, and the borrow: what `u64::borrowing_sub` does from Rust 1.91 on.
#[inline(always)]
pub(super) fn subtract_with_borrow(x: u64, y: u64, borrow: bool) -> (u64, bool) {
    let (difference, first) = x.overflowing_sub(y);
    let (difference, second) = difference.overflowing_sub(borrow.into());
    (difference, first | second)
}
