//! Powers of two: multiplication by them is exact, but for subnormal results.

/// 2ᵏ, for `k` from -1022 to 1023.
///
/// # Panics
/// For any other `k`.
#[expect(clippy::cast_sign_loss, reason = "the biased exponent of a normal double is positive")]
#[inline(always)]
#[must_use]
pub const fn power_of_two(k: i32) -> f64 {
    assert!(-1022 <= k && k <= 1023, "outside the normal range");
    f64::from_bits(((1023 + k) as u64) << 52)
}

/// A finite double that is not zero as `m 2^e` with `1 <= |m| < 2`, subnormal ones included.
#[inline(always)]
#[must_use]
pub fn mantissa_and_exponent(x: f64) -> (f64, i32) {
    let (x, less) = if x.abs() < f64::MIN_POSITIVE { (x * power_of_two(64), 64) } else { (x, 0) };
    let exponent = ((x.to_bits() >> 52 & 0x7ff) as i32) - 1023;
    (f64::from_bits(x.to_bits() & !(0x7ff << 52) | 1023 << 52), exponent - less)
}

/// A power of two by which a positive number becomes about 1; at most 2¹⁰²².
#[inline]
#[must_use]
pub fn power_of_two_near_inverse(x: f64) -> f64 {
    let exponent = (x.to_bits() >> 52).min(2045);
    f64::from_bits((2046 - exponent).min(2045) << 52)
}

/// Returns `x 2^k` for `k` from -2044 to 2046, also where the factor lies beyond the doubles. Rounded once, unless the
/// result is subnormal and `x` is not: then a last bit may be lost twice.
///
/// # Panics
/// For any other `k`.
#[inline(always)]
#[must_use]
pub fn scale<T: core::ops::Mul<f64, Output = T>>(x: T, k: i32) -> T {
    let half = k / 2;
    x * power_of_two(half) * power_of_two(k - half)
}

#[cfg(test)]
mod tests {
    use super::*;
    use oracle::{Random, exact, power_of_two};

    #[test]
    fn mantissa_and_exponent_make_the_number() {
        let mut rng = Random::new(51);
        for _ in 0..10_000 {
            let x = rng.finite();
            if x == 0.0 {
                continue;
            }
            let (mantissa, exponent) = mantissa_and_exponent(x);
            assert!((1.0..2.0).contains(&mantissa.abs()), "{x:e}");
            assert_eq!(exact(mantissa) * power_of_two(exponent), exact(x), "{x:e}");
        }
    }
}
