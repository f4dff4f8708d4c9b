//! Numbers carried as two doubles, `hi + lo`, with plain IEEE 754 operations only.
//!
//! A product of two doubles is made exact by splitting each into 26 and 27 bits. No fused multiply-add is used, so
//! the result is the same bits whether the processor has one or not. All of it holds as long as nothing overflows
//! and nothing that counts underflows; the callers keep to 2^±900.

/// A number `hi + lo`, where `lo` is small against `hi` but need not be below its last bit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DoubleWord {
    pub(crate) hi: f64,
    pub(crate) lo: f64,
}

impl DoubleWord {
    /// The double itself.
    pub(crate) fn exact(hi: f64) -> Self {
        Self { hi, lo: 0.0 }
    }
}

/// Splits `x` into `top + rest` exactly: 26 significant bits (or fewer) and 27 (or fewer), of the same sign.
#[inline]
pub(crate) fn split(x: f64) -> (f64, f64) {
    let top = f64::from_bits(x.to_bits() & !((1 << 27) - 1));
    (top, x - top)
}

/// Returns `a + b` exactly, if `|a| >= |b|` or `a == 0` (Dekker 1971).
#[inline]
pub(crate) fn fast_two_sum(a: f64, b: f64) -> DoubleWord {
    let hi = a + b;
    DoubleWord { hi, lo: b - (hi - a) }
}

/// Returns `a - b` exactly (Knuth).
#[inline]
pub(crate) fn two_diff(a: f64, b: f64) -> DoubleWord {
    let hi = a - b;
    let from_a = hi + b;
    let from_b = hi - from_a;
    DoubleWord { hi, lo: (a - from_a) - (b + from_b) }
}

/// Returns `a b` within `2^-76 |a b|`.
#[inline]
pub(crate) fn product(a: f64, b: f64) -> DoubleWord {
    let ((a_top, a_rest), (b_top, b_rest)) = (split(a), split(b));
    let hi = a * b;
    DoubleWord { hi, lo: ((a_top * b_top - hi) + (a_top * b_rest + a_rest * b_top)) + a_rest * b_rest }
}

/// Returns `n / d` within `2^-74 |n / d|`, for words whose low part is at most 8 ulp of the high one.
#[inline]
pub(crate) fn quotient(n: DoubleWord, d: DoubleWord) -> DoubleWord {
    let inverse = 1.0 / d.hi;
    let hi = n.hi * inverse;
    // The remainder n.hi - hi d.hi: the first difference is exact, since both are within a factor of two.
    let ((hi_top, hi_rest), (d_top, d_rest)) = (split(hi), split(d.hi));
    let remainder = ((n.hi - hi_top * d_top) - (hi_top * d_rest + hi_rest * d_top)) - hi_rest * d_rest;
    DoubleWord { hi, lo: (remainder + (n.lo - hi * d.lo)) * inverse }
}
