//! The arc tangent of a quotient, as a share of half a turn.
//!
//! With `c` the multiple of 1/32 next to `q = n / d`, and `r = (n - c d) / (d + c n)`, at most 1/64 or so,
//!
//! ```text
//! atan q = atan c + atan r,    atan r = r - r^3/3 + r^5/5 - r^7/7 + r^9/9 - r^11/11
//! ```
//!
//! `atan(c)/pi` comes from a table of two doubles each, `r` is a division carried to two doubles, and the terms after
//! the first are so small against it that doubles do. `docs/numerics.md`, section 10, has the bound.

use crate::double_word::{DoubleWord, fast_two_sum, quotient, split, two_diff};

/// Returns `atan(n / d) / pi`, in `0..=1/4`, with a relative error below 2^-60, for `0 <= n <= d` and `d` not 0.
///
/// `d.hi` and, unless it is zero, `n.hi` lie in `2^-450 .. 2^450`; the low words are at most 4 ulp of the high ones.
#[inline]
pub(crate) fn arctangent_over_pi(n: DoubleWord, d: DoubleWord) -> DoubleWord {
    /// 1/pi: the first 26 bits, the rest, and the sum of the two.
    const TOP: f64 = 0.31830988079309464;
    const REST: f64 = 5.390696036528002e-9;
    const WHOLE: f64 = std::f64::consts::FRAC_1_PI;
    // A little under one half, so that k = 1 is only chosen when n - c d needs no rounding.
    const NEARLY_HALF: f64 = 0.4999;

    #[expect(clippy::cast_possible_truncation, reason = "the whole part of a number in 0.4999..=32.4999")]
    let k = (32.0 * (n.hi / d.hi) + NEARLY_HALF) as usize;
    let c = k as f64 / 32.0;

    // n - c d and d + c n: c has 6 bits, so that its products with halves of a double are exact.
    let ((n_top, n_rest), (d_top, d_rest)) = (split(n.hi), split(d.hi));
    let difference = two_diff(n.hi - c * d_top, c * d_rest);
    let difference = DoubleWord { hi: difference.hi, lo: difference.lo + (n.lo - c * d.lo) };
    let product = c * n.hi;
    let sum = fast_two_sum(d.hi, product);
    let sum_lo = sum.lo + (((c * n_top - product) + c * n_rest) + (d.lo + c * n.lo));
    let r = quotient(difference, DoubleWord { hi: sum.hi, lo: sum_lo });

    let s = r.hi * r.hi;
    let series = s * (-1.0 / 3.0 + s * (1.0 / 5.0 + s * (-1.0 / 7.0 + s * (1.0 / 9.0 - s * (1.0 / 11.0)))));
    let (r_top, r_rest) = split(r.hi);
    let tail = r_top * REST + (r_rest + (r.lo + r.hi * series)) * WHOLE;

    let (at_c, at_c_lo) = ARCTANGENT_OVER_PI[k.min(32)];
    let lead = fast_two_sum(at_c, r_top * TOP);
    DoubleWord { hi: lead.hi, lo: lead.lo + (at_c_lo + tail) }
}

/// `atan(k/32) / pi` for `k` in `0..=32`, as the nearest double and the nearest double to what is left.
#[rustfmt::skip]
static ARCTANGENT_OVER_PI: [(f64, f64); 33] = [
    (0.0, 0.0), (0.009943947823589275, -8.306802788607976e-19),
    (0.019868524305540838, 1.3826952600674369e-18), (0.02975458357141772, 6.19561876797682e-19),
    (0.03958342416056554, 2.98137454902751e-18), (0.04933699528066803, -1.9945591155389372e-18),
    (0.05899808486752853, -2.1312105842773903e-18), (0.06855048487958997, 3.602472142229051e-18),
    (0.07797913037736932, 1.504019415502884e-18), (0.08727021016119858, 1.079159322150633e-18),
    (0.09641124797922956, 2.694317570810711e-18), (0.1053911544915919, 6.3017341167833356e-18),
    (0.11420025121990814, -9.4507892552845e-19), (0.12283026857639819, 1.648561479838599e-18),
    (0.1312743207258712, 7.18719402317233e-18), (0.1395268604785809, -3.7426014823117344e-18),
    (0.14758361765043326, 1.1095511164473943e-17), (0.15544152438044526, -9.54357984720992e-18),
    (0.16309863079328485, -1.9322813523895452e-18), (0.17055401417119118, 4.051833404664618e-18),
    (0.17780768448935275, 6.722394259519719e-18), (0.18486048880463846, 1.8276050792582272e-18),
    (0.1917140165981578, -3.083586096533857e-18), (0.19837050778112714, 6.906048711351924e-19),
    (0.20483276469913345, 5.5645532866810265e-18), (0.2111040691250259, -1.2575397548952747e-17),
    (0.21718810492349722, 6.809215105630546e-18), (0.22308888680510733, 9.68352189091287e-18),
    (0.22881069536505358, 8.719313953813051e-18), (0.23435801842104872, 7.085321563707816e-18),
    (0.23973549852225223, 1.3358901762119263e-17), (0.24494788639333812, -1.2415457416903375e-17),
    (0.25, 0.0),
];

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::reference::{big, pair_error, pi, ratio};

    fn check(n: (f64, f64), d: (f64, f64)) {
        let word = |(hi, lo)| DoubleWord { hi, lo };
        let result = arctangent_over_pi(word(n), word(d));
        let exact = ((big(n.0) + big(n.1)) / (big(d.0) + big(d.1))).atan() / pi();
        let error = pair_error((result.hi, result.lo), &exact);
        assert!(error <= 2f64.powi(-60), "atan({n:?} / {d:?}) / pi is off by {error:e}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(1000))]

        #[test]
        fn the_error_is_below_the_bound(q in 0.0f64..=1.0, d in 1.0f64..2.0, n_lo in -4i32..=4, d_lo in -4i32..=4, e in -450..0) {
            let n = q * d;
            prop_assume!(n > 1e-9);
            let low = |x: f64, ulps: i32| f64::from(ulps) / 1.1 * f64::EPSILON / 2.0 * x;
            check((n, low(n, n_lo)), (d, low(d, d_lo)));
            let small = 2f64.powi(e);
            check((n * small, low(n, n_lo) * small), (d, low(d, d_lo)));
        }

        #[test]
        fn the_error_is_below_the_bound_where_the_table_changes(k in 1u32..=64, d in 1.0f64..2.0, step in -3i64..=3) {
            let n = f64::from(k) / 64.0 * d;
            let n = f64::from_bits(n.to_bits().wrapping_add_signed(step)).min(d);
            check((n, 0.0), (d, 0.0));
        }
    }

    #[test]
    fn the_table_holds_the_nearest_pairs_of_doubles() {
        for (k, &pair) in ARCTANGENT_OVER_PI.iter().enumerate() {
            let exact = ratio(k, 32).atan() / pi();
            assert!(pair_error(pair, &exact) <= 2f64.powi(-106), "atan({k}/32)/pi");
        }
    }
}
