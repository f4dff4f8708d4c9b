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

/// Returns `a + b` exactly, if `|a| >= |b|` or `a == 0`.
#[inline]
pub(crate) fn fast_two_sum(a: f64, b: f64) -> DoubleWord {
    let (hi, lo) = rt_math::exact::fast_two_sum(a, b);
    DoubleWord { hi, lo }
}

/// Returns `a b` within `2^-76 |a b|`.
#[inline]
pub(crate) fn product(a: f64, b: f64) -> DoubleWord {
    let ((a_top, a_rest), (b_top, b_rest)) = (split(a), split(b));
    let hi = a * b;
    DoubleWord { hi, lo: ((a_top * b_top - hi) + (a_top * b_rest + a_rest * b_top)) + a_rest * b_rest }
}

/// A quotient as `top + rest`, where `top` has 26 bits, beside that sum rounded.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Quotient {
    pub(crate) top: f64,
    pub(crate) rest: f64,
    pub(crate) rounded: f64,
}

/// Returns `n / d`, with a relative error below 2^-74, if the low words are at most 2 ulp of the high ones.
#[inline]
pub(crate) fn quotient(n: DoubleWord, d: DoubleWord) -> Quotient {
    let inverse = 1.0 / d.hi;
    let top = split(n.hi * inverse).0;
    // n - top d: the products are exact, and so is the first difference, of two nearly equal numbers.
    let (d_top, d_rest) = split(d.hi);
    let remainder = ((n.hi - top * d_top) - top * d_rest) + (n.lo - top * d.lo);
    let rest = remainder * inverse;
    Quotient { top, rest, rounded: top + rest }
}
