//! A power of a number between 0 and 1, for the highlight.
//!
//! `b^s = 2^(s log2 b)`. With `b = 2^e m`, `m` in `3/4 .. 3/2`, and `c` the multiple of 1/64 next to `m`,
//!
//! ```text
//! log2 b = e + log2 c + 2/ln 2 (w + w^3/3 + w^5/5 + w^7/7 + w^9/9),    w = (m - c) / (m + c)
//! ```
//!
//! and with `j` the integer next to `32 x`, `2^x = 2^(j/32) exp((x - j/32) ln 2)`. `log2 c` and `2^(j/32)` come
//! from tables of two doubles each. `docs/numerics.md`, section 10, has the bound.

use crate::double_word::{DoubleWord, fast_two_sum, product, quotient};

/// Returns `base` to the power `exponent`, for `base` in `0..=1`, as IEEE 754's `pow`.
///
/// The error is below 0.59 ulp where the result is at least 2^-64, below 0.75 ulp where it is normal, and below 0.88
/// ulp where it is subnormal. A power of 1 and a power with the exponent 0 are 1, whatever the other is; else NaN gives
/// NaN.
pub(crate) fn power(base: f64, exponent: f64) -> f64 {
    if base == 1.0 || exponent == 0.0 {
        return 1.0;
    }
    if base > 0.0 && base < 1.0 {
        return exp2_of_product(exponent, log2(base));
    }
    match (base == 0.0, exponent > 0.0, exponent < 0.0) {
        (true, true, _) => 0.0,
        (true, _, true) => f64::INFINITY,
        _ => f64::NAN,
    }
}

/// Returns what [`power`] returns where that is ordinary, else NaN: for a base in `0..=1` and an exponent in
/// `0.001..=1e6`.
///
/// It has no branch, so that a loop over many powers can be compiled into vector instructions.
#[inline(always)]
pub(crate) fn ordinary_power(base: f64, exponent: f64) -> f64 {
    let logarithm = log2(base);
    let power = exp2_of_ordinary_product(exponent, logarithm);
    let power = if exponent * logarithm.hi >= -1100.0 { power } else { 0.0 };
    let power = if base > 0.0 { power } else { 0.0 };
    let power = if base < 1.0 { power } else { 1.0 };
    let ordinary = (0.0..=1.0).contains(&base) & (0.001..=1e6).contains(&exponent);
    if ordinary { power } else { f64::NAN }
}

/// Returns the logarithm to base 2 of a number strictly between 0 and 1, with a relative error below 2^-65; unspecified
/// otherwise.
#[inline(always)]
fn log2(b: f64) -> DoubleWord {
    /// 2/ln 2: the first 26 bits, the rest, and the sum of the two.
    const TOP: f64 = 2.885390043258667;
    const REST: f64 = 3.851925982253235e-8;
    const WHOLE: f64 = 2.8853900817779268;
    const TWO_POW_64: f64 = 18_446_744_073_709_551_616.0;

    let (b, shift) = if b < f64::MIN_POSITIVE { (b * TWO_POW_64, 64.0) } else { (b, 0.0) };
    // m in 3/4 .. 3/2: what lies above is halved.
    let fraction = b.to_bits() & ((1 << 52) - 1);
    let halved = fraction >> 51;
    let m = f64::from_bits(fraction | (1023 - halved) << 52);
    #[expect(clippy::cast_possible_truncation, reason = "the sign and eleven bits of the exponent")]
    let e = f64::from(((b.to_bits() >> 52) + halved) as i32) - 1023.0 - shift;

    #[expect(clippy::cast_possible_truncation, reason = "the whole part of a number in 48..=96.5")]
    let k = (64.0 * m + 0.5) as i32;
    let c = f64::from(k) / 64.0;
    let (larger, smaller) = if m > c { (m, c) } else { (c, m) };
    let w = quotient(DoubleWord::exact(m - c), fast_two_sum(larger, smaller));
    let s = w.rounded * w.rounded;
    let series = s * (1.0 / 3.0 + s * (1.0 / 5.0 + s * (1.0 / 7.0 + s * (1.0 / 9.0))));
    let tail = w.top * REST + (w.rest + w.rounded * series) * WHOLE;

    let (at_c, at_c_lo) = LOG2[(k & 63).unsigned_abs() as usize];
    let lead = fast_two_sum(at_c, w.top * TOP);
    let whole = fast_two_sum(e, lead.hi);
    fast_two_sum(whole.hi, whole.lo + (lead.lo + (at_c_lo + tail)))
}

/// Returns 2 to the power `s x`.
fn exp2_of_product(s: f64, x: DoubleWord) -> f64 {
    let y = s * x.hi;
    if !(-1100.0..1100.0).contains(&y) {
        return if y > 0.0 {
            f64::INFINITY
        } else if y < 0.0 {
            0.0
        } else {
            f64::NAN
        };
    }
    exp2_of_ordinary_product(s, x)
}

/// Returns 2 to the power `s x`, for a product in -1100..1100; unspecified otherwise.
#[inline(always)]
fn exp2_of_ordinary_product(s: f64, x: DoubleWord) -> f64 {
    let DoubleWord { hi, lo } = product(s, x.hi);
    let lo = lo + s * x.lo;

    // Adding 3/2 2^52 rounds to an integer.
    const TO_INTEGER: f64 = 6_755_399_441_055_744.0;
    let j = (32.0 * hi + TO_INTEGER) - TO_INTEGER;
    // (hi - j/32) is exact; ln 2 times it and a last part is at most 0.0109.
    let z = ((hi - j / 32.0) + lo) * std::f64::consts::LN_2;
    let series = z + z
        * z
        * (1.0 / 2.0 + z * (1.0 / 6.0 + z * (1.0 / 24.0 + z * (1.0 / 120.0 + z * (1.0 / 720.0 + z / 5040.0)))));
    #[expect(clippy::cast_possible_truncation, reason = "the integer j is within 32 * 1100")]
    let j = j as i32;
    let (root, root_lo) = EXP2[(j & 31).unsigned_abs() as usize];
    let result = root + (root_lo + root * series);
    // Two steps: 2^-1100 itself is no double. Only the second can round.
    let e = j >> 5;
    result * power_of_two(e / 2) * power_of_two(e - e / 2)
}

/// Returns 2 to the power `e`, for `e` in `-1022..=1023`.
#[inline(always)]
pub(crate) fn power_of_two(e: i32) -> f64 {
    f64::from_bits(u64::from((e + 1023).unsigned_abs()) << 52)
}

/// `log2(k/64)` for `k` in `48..=96` at place `k % 64`, as the nearest double and the nearest double to what is left.
/// Places 33 to 47 are not used; they are there so that six bits are always a place.
#[rustfmt::skip]
static LOG2: [(f64, f64); 64] = [
    (0.0, 0.0), (0.02236781302845451, -1.593366605276194e-18),
    (0.044394119358453436, 1.3338680039226223e-18), (0.06608919045777244, -4.130247852756734e-18),
    (0.0874628412503394, 6.765321226991275e-18), (0.10852445677816905, 5.4046572138033075e-18),
    (0.12928301694496647, -1.147571414337692e-17), (0.14974711950468206, 3.3957331682262494e-18),
    (0.16992500144231237, -1.0448980122780218e-17), (0.18982455888001723, -2.362617117852667e-19),
    (0.20945336562894978, -1.747801539116594e-18), (0.22881869049588088, -5.967894054218645e-18),
    (0.2479275134435855, 3.8662183541602335e-18), (0.2667865406949014, -1.148454798555715e-17),
    (0.28540221886224837, -2.726283638197372e-17), (0.30378074817710293, -8.333787019748188e-18),
    (0.32192809488736235, -3.717019964142682e-19), (0.33985000288462475, -2.0897960245560436e-17),
    (0.3575520046180837, 1.8984820907705057e-17), (0.37503943134692475, 1.099000777384843e-17),
    (0.3923174227787603, -1.6328502208352762e-17), (0.4093909361377018, -2.1361956385051908e-17),
    (0.42626475470209796, -1.9932012137193316e-17), (0.4429434958487283, 2.7429379563921325e-17),
    (0.45943161863729726, -3.8053583859449705e-19), (0.47573343096639775, 2.6712179058256416e-18),
    (0.4918530963296747, -1.0820682119194486e-17), (0.5077946401986962, 2.2368792763711565e-17),
    (0.5235619560570128, 3.838472289082233e-17), (0.5391588111080314, -4.246405680857825e-17),
    (0.5545888516776374, -1.2269989151629687e-17), (0.5698556083309478, 3.494516357745965e-18),
    (0.5849625007211562, -5.224490061390109e-18), (0.0, 0.0),
    (0.0, 0.0), (0.0, 0.0),
    (0.0, 0.0), (0.0, 0.0),
    (0.0, 0.0), (0.0, 0.0),
    (0.0, 0.0), (0.0, 0.0),
    (0.0, 0.0), (0.0, 0.0),
    (0.0, 0.0), (0.0, 0.0),
    (0.0, 0.0), (0.0, 0.0),
    (-0.4150374992788438, -5.224490061390109e-18), (-0.38529015588479176, -2.2208024293925304e-17),
    (-0.3561438102252753, -7.434039928285364e-19), (-0.3275746580285044, -2.6214744450027748e-17),
    (-0.2995602818589078, -2.2038346320583612e-17), (-0.2720795454368008, -2.476475356878588e-17),
    (-0.24511249783653147, 1.2082105431458586e-17), (-0.2186402864753404, -7.522378350087652e-19),
    (-0.19264507794239588, -1.1104012146962652e-17), (-0.16710998583525832, -1.358271707229876e-18),
    (-0.14201900487242788, 4.898294009682521e-18), (-0.11735695063815874, -5.45905252946375e-18),
    (-0.09310940439148147, -5.596192057804377e-18), (-0.06926266243711372, -6.924843096294881e-19),
    (-0.04580368961312479, -2.5450972276520026e-18), (-0.02272007650008353, -7.363105580211854e-19),
];

/// `2^(j/32)` for `j` in `0..32`, as the nearest double and the nearest double to what is left.
#[rustfmt::skip]
#[expect(clippy::approx_constant, reason = "a line of a table")]
static EXP2: [(f64, f64); 32] = [
    (1.0, 0.0), (1.0218971486541166, 5.109225028973444e-17), (1.0442737824274138, 8.551889705537965e-17),
    (1.0671404006768237, -7.899853966841582e-17), (1.0905077326652577, -3.046782079812471e-17),
    (1.1143867425958924, 1.0410278456845571e-16), (1.1387886347566916, 8.912812676025408e-17),
    (1.1637248587775775, 3.8292048369240935e-17), (1.189207115002721, 3.982015231465646e-17),
    (1.215247359980469, -7.712630692681488e-17), (1.241857812073484, 4.658027591836937e-17),
    (1.2690509571917332, 2.667932131342186e-18), (1.2968395546510096, 2.5382502794888315e-17),
    (1.3252366431597413, -2.8587312100388614e-17), (1.3542555469368927, 7.70094837980299e-17),
    (1.383909881963832, -6.770511658794786e-17), (1.4142135623730951, -9.667293313452913e-17),
    (1.4451808069770467, -3.0237581349939873e-17), (1.4768261459394993, -3.483994556892796e-17),
    (1.5091644275934228, -1.016455327754295e-16), (1.5422108254079407, 7.949834809697621e-17),
    (1.5759808451078865, -1.0136916471278304e-17), (1.6104903319492543, 2.4707192569797888e-17),
    (1.645755478153965, -1.0125679913674773e-16), (1.681792830507429, 8.199010020581497e-17),
    (1.718619298122478, -1.851380418263111e-17), (1.7562521603732995, 2.960140695448873e-17),
    (1.7947090750031072, 1.8227458427912087e-17), (1.8340080864093424, 3.283107224245627e-17),
    (1.8741676341103, -6.122763413004143e-17), (1.9152065613971474, -1.0619946056195963e-16),
    (1.9571441241754002, 8.960767791036668e-17),
];

#[cfg(test)]
mod tests {
    use oracle::{exact, long, quotient, relative_error, ulps};
    use proptest::prelude::*;

    use super::*;

    fn check(base: f64, exponent: f64) {
        let computed = power(base, exponent);
        let exact = oracle::power(base, exponent);
        let bound = match computed {
            c if c >= 2f64.powi(-64) => 0.59,
            c if c >= f64::MIN_POSITIVE => 0.75,
            _ => 0.88, // the first rounding, counted half, and the second
        };
        let error = ulps(computed, &exact);
        assert!(error <= bound, "{base:e} to the power {exponent:e} gave {computed:e}, {error} ulp away");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(1000))]

        #[test]
        fn a_highlight_is_within_the_bound(base in 0.0f64..1.0, shininess in 0.0f64..300.0) {
            prop_assume!(base > 0.0);
            check(base, shininess);
            check(base, shininess.round());
        }

        #[test]
        fn a_sharp_highlight_is_within_the_bound(distance in -52.0f64..-1.0, log_shininess in 0.0f64..50.0) {
            let base = 1.0 - 2f64.powf(distance);
            let shininess = 2f64.powf(log_shininess.min(9.9 - distance)); // down to 2^-1022 or so
            check(base, shininess);
        }

        #[test]
        fn a_power_of_any_positive_number_is_within_the_bound(bits in 1u64..1.0f64.to_bits(), result in 0.0f64..1100.0) {
            // The exponent is chosen for the result: 2^-1100 .. 1, subnormal numbers and zero included.
            let base = f64::from_bits(bits);
            let exponent = -result / base.log2();
            prop_assume!(exponent.is_finite());
            check(base, exponent);
        }
    }

    #[test]
    fn powers_whose_logarithms_need_every_term_are_within_the_bound() {
        // The logarithm comes from the series alone, and what it is off by counts a thousand times.
        for i in 0..600 {
            let base = 1.0 - 2f64.powf(-7.0 - f64::from(i) / 100.0);
            check(base, -1000.0 / base.log2());
        }
    }

    #[test]
    fn exceptional_powers_are_those_of_ieee_754() {
        let (inf, nan) = (f64::INFINITY, f64::NAN);
        for exponent in [0.0, -0.0, 1.0, -3.0, 1e300, inf, -inf, nan] {
            assert_eq!(power(1.0, exponent), 1.0, "1 to the power {exponent}");
        }
        for base in [0.0, 1e-320, 0.5, nan] {
            assert_eq!(power(base, 0.0), 1.0, "{base} to the power 0");
        }
        for (exponent, expected) in [(f64::from_bits(1), 0.0), (2.0, 0.0), (inf, 0.0), (-2.0, inf), (-inf, inf)] {
            assert_eq!(power(0.0, exponent), expected, "0 to the power {exponent}");
        }
        for (base, exponent, expected) in [
            (0.5, inf, 0.0),
            (0.5, -inf, inf),
            (0.999, 1e300, 0.0),
            (0.999, -1e300, inf),
            (0.5, 1080.0, 0.0),
            (0.5, -1030.0, inf),
        ] {
            assert_eq!(power(base, exponent), expected, "{base} to the power {exponent}");
        }
        assert!(power(0.5, nan).is_nan() && power(nan, 2.0).is_nan() && power(0.0, nan).is_nan());
    }

    #[test]
    fn exact_powers_are_exact() {
        for e in 0..1074 {
            assert_eq!(power(0.5, f64::from(e)), 0.5f64.powi(e), "1/2 to the power {e}");
        }
        assert_eq!(power(0.75, 2.0), 0.5625);
        assert_eq!(power(0.0625, 0.25), 0.5);
        assert_eq!(power(f64::from_bits(1), 1.0), f64::from_bits(1));
    }

    #[test]
    fn tables_are_the_nearest_pairs_of_doubles() {
        let ratio = |n: usize, d: f64| quotient(&exact(n as f64), &exact(d));
        let log_two = long(&exact(2.0)).ln();
        for k in 48..=96 {
            let truth = ratio(k, 64.0).ln() / &log_two;
            assert!(relative_error(LOG2[k % 64], &truth) <= 2f64.powi(-106), "log2 {k}/64");
        }
        for (j, &pair) in EXP2.iter().enumerate() {
            let truth = (ratio(j, 32.0) * &log_two).exp();
            assert!(relative_error(pair, &truth) <= 2f64.powi(-106), "2^({j}/32)");
        }
    }
}
