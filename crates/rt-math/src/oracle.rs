//! Exact rationals, the reference of every test here, and generators of hard doubles. Independent of the code under test.

use core::cmp::Ordering;
use core::ops::Range;

/// An exact rational number.
pub(crate) type Exact = dashu::rational::Relaxed;

/// The exact value of a finite double.
pub(crate) fn exact(x: f64) -> Exact {
    Exact::try_from(x).expect("a finite double")
}

/// The double nearest to `x`, ties to even: found by bisection among all doubles, then a look at the midpoint. Zero
/// is +0.0; what underflows keeps its sign.
pub(crate) fn round(x: &Exact) -> f64 {
    if *x == Exact::ZERO {
        return 0.0;
    }
    if *x < Exact::ZERO {
        return -round(&-x.clone());
    }
    round_by(|boundary| x.cmp(&boundary))
}

/// The double nearest to the positive number that `compare` tells from any rational (`Less`: the number is smaller).
pub(crate) fn round_by(compare: impl Fn(Exact) -> Ordering) -> f64 {
    // the bits of the non-negative doubles are ordered as their values
    let (mut low, mut high) = (0, f64::INFINITY.to_bits());
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if compare(position(middle)) == Ordering::Less { high = middle } else { low = middle }
    }
    let midpoint = (position(low) + position(high)) / exact(2.0);
    f64::from_bits(match compare(midpoint) {
        Ordering::Less => low,
        Ordering::Greater => high,
        Ordering::Equal => low + (low & 1),
    })
}

/// Whether `x` is the double nearest to the number that `compare` tells from any rational (`Less`: the number is
/// smaller): between the midpoints to both neighbours, on one of them only if `x` is even. An exact zero must be +0.0.
pub(crate) fn is_rounding_of(x: f64, compare: impl Fn(&Exact) -> Ordering) -> bool {
    let sign = compare(&Exact::ZERO);
    if sign == Ordering::Equal {
        return x.to_bits() == 0;
    }
    let negative = sign == Ordering::Less;
    if x.is_nan() || x.is_sign_negative() != negative {
        return false;
    }
    let bits = x.abs().to_bits();
    let half = exact(0.5);
    let not_beyond = |first: u64, outside: Ordering| {
        let midpoint = (position(first) + position(first + 1)) * &half;
        let order = if negative { compare(&-midpoint).reverse() } else { compare(&midpoint) };
        order != outside && (order != Ordering::Equal || bits & 1 == 0)
    };
    (bits == 0 || not_beyond(bits - 1, Ordering::Less)) && (x.is_infinite() || not_beyond(bits, Ordering::Greater))
}

/// The value of the double with these bits, not negative; infinity stands for 2^1024, its place in the sequence.
fn position(bits: u64) -> Exact {
    if bits == f64::INFINITY.to_bits() { exact(2f64.powi(1023)) * exact(2.0) } else { exact(f64::from_bits(bits)) }
}

/// The number of random cases per class: 10 000, or `long` with the environment variable `RT_LONG` set.
pub(crate) fn cases(long: usize) -> usize {
    if std::env::var_os("RT_LONG").is_some() { long } else { 10_000 }
}

/// Splitmix64: small, seeded, the same everywhere.
pub(crate) struct Rng(u64);

impl Rng {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x2545_f491_4f6c_dd1d))
    }

    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }

    /// An integer below `n`.
    pub(crate) fn below(&mut self, n: usize) -> usize {
        usize::try_from(self.bits() % n as u64).expect("below n")
    }

    /// An integer of the range.
    pub(crate) fn integer(&mut self, range: Range<i32>) -> i32 {
        range.start + i32::try_from(self.bits() % u64::from(range.end.abs_diff(range.start))).expect("a small range")
    }

    /// Any finite double: all exponents alike, subnormals and zeros among them, some with few bits.
    pub(crate) fn finite(&mut self) -> f64 {
        let mut bits = self.bits();
        if bits & 15 == 0 {
            bits &= u64::MAX << (self.bits() % 64);
        }
        let x = f64::from_bits(bits);
        if x.is_finite() { x } else { f64::from_bits(bits & !(1 << 62)) }
    }

    /// A double of random sign with a uniform exponent from the range (that of its leading bit) and random bits; a
    /// quarter of them have few bits.
    pub(crate) fn with_exponent(&mut self, range: Range<i32>) -> f64 {
        let exponent = self.integer(range);
        let bits = self.bits();
        let mut significand = (1 << 52) | (bits >> 12);
        if bits & 3 == 0 {
            significand &= u64::MAX << (self.bits() % 53);
        }
        #[expect(clippy::cast_precision_loss, reason = "53 bits")]
        let magnitude = significand as f64 * 2f64.powi(-52);
        // in two steps, since 2^-1074 times a number rounds once only if the other factor is a normal double
        let half = exponent / 2;
        let magnitude = magnitude * 2f64.powi(half) * 2f64.powi(exponent - half);
        if bits & 4 == 0 { magnitude } else { -magnitude }
    }
}
