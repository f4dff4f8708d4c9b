//! Powers of two: multiplication by them is exact, but for subnormal results.

/// 2ᵏ, for `k` from -1022 to 1023.
#[expect(clippy::cast_sign_loss, reason = "the biased exponent of a normal double is positive")]
#[inline(always)]
pub(crate) const fn power_of_two(k: i32) -> f64 {
    assert!(-1022 <= k && k <= 1023, "outside the normal range");
    f64::from_bits(((1023 + k) as u64) << 52)
}

/// A finite double that is not zero as `m 2^e` with `1 <= |m| < 2`, subnormal ones included.
#[inline(always)]
pub(crate) fn mantissa_and_exponent(x: f64) -> (f64, i32) {
    let (x, less) = if x.abs() < f64::MIN_POSITIVE { (x * power_of_two(64), 64) } else { (x, 0) };
    let exponent = ((x.to_bits() >> 52 & 0x7ff) as i32) - 1023;
    (f64::from_bits(x.to_bits() & !(0x7ff << 52) | 1023 << 52), exponent - less)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oracle::{Exact, Rng, exact};

    #[test]
    fn mantissa_and_exponent_make_the_number() {
        let mut rng = Rng::new(51);
        for _ in 0..10_000 {
            let x = rng.finite();
            if x == 0.0 {
                continue;
            }
            let (mantissa, exponent) = mantissa_and_exponent(x);
            assert!((1.0..2.0).contains(&mantissa.abs()), "{x:e}");
            assert_eq!(exact(mantissa) * Exact::from(2).pow(exponent as isize), exact(x), "{x:e}");
        }
    }
}
