//! The random generator, and the vector arithmetic that hard cases are made with.
//!
//! Only operations that IEEE 754 rounds correctly are used, so the numbers are the same on every platform.

pub(super) use oracle::Random;

/// Returns the power of two below `10^exponent`, the same on every platform.
pub(super) fn size(exponent: f64) -> f64 {
    #[expect(clippy::cast_possible_truncation, reason = "an exponent in the range of f64")]
    let binary = (exponent * std::f64::consts::LOG2_10).floor() as i32;
    f64::from_bits(u64::from((binary + 1023).clamp(1, 2046).unsigned_abs()) << 52)
}

pub(super) fn length(v: [f64; 3]) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}

pub(super) fn plus(a: [f64; 3], b: [f64; 3], s: f64) -> [f64; 3] {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

pub(super) fn combination(a: [f64; 3], s: f64, b: [f64; 3], t: f64) -> [f64; 3] {
    plus(a.map(|x| x * s), b, t)
}

pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Joins vectors and numbers to one case.
pub(super) fn join<const M: usize>(parts: &[&[f64]]) -> [f64; M] {
    let numbers: Vec<f64> = parts.concat();
    numbers.try_into().expect("the parts have the length of a case")
}
