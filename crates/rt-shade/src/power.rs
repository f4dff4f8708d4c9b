//! A power of a number between 0 and 1.

/// Returns `base` to the power `exponent`.
pub(crate) fn power(base: f64, exponent: f64) -> f64 {
    pxfm::f_pow(base, exponent)
}
