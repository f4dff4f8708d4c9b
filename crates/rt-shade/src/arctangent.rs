//! The arc tangent of a quotient, as a share of half a turn.
//!
//! With `c` the multiple of 1/32 next to `q = n / d`, and `r = (n - c d) / (d + c n)`, at most 1/64 or so,
//!
//! ```text
//! atan q = atan c + atan r,    atan r = r - r^3/3 + r^5/5 - r^7/7 + r^9/9 - ...
//! ```
//!
//! `atan(c)/pi` comes from a table of two doubles each, `r` is a division carried to two doubles, and the terms after
//! the first are so small against it that doubles do. `docs/numerics.md`, section 10, has the bound.

use crate::double_word::{DoubleWord, fast_two_sum, quotient, split};

/// Returns `atan(n / d) / pi`, in `0..=1/4`, with a relative error below 2^-62, for `0 <= n <= d`, where `d` and,
/// unless it is zero, `n` lie in `2^-450 .. 2^450`.
#[inline(always)]
pub(crate) fn arctangent_over_pi(n: f64, d: f64) -> DoubleWord {
    /// 1/pi: the first 26 bits, the rest, and the sum of the two.
    const TOP: f64 = 0.31830988079309464;
    const REST: f64 = 5.390696036528002e-9;
    const WHOLE: f64 = std::f64::consts::FRAC_1_PI;
    /// Adding it to a small number rounds to an integer, which is then in the last bits of the sum.
    const TO_INTEGER: f64 = 6_755_399_441_055_744.0; // 3/2 2^52

    let nearest = 32.0 * (n / d) + TO_INTEGER;
    let k = (nearest.to_bits() & 63) as usize;
    let c = (nearest - TO_INTEGER) / 32.0;

    // n - c d and d + c n: c has 6 bits, so that its products with halves of a double are exact.
    let ((n_top, n_rest), (d_top, d_rest)) = (split(n), split(d));
    let difference = fast_two_sum(n - c * d_top, -(c * d_rest));
    let product = c * n;
    let sum = fast_two_sum(d, product);
    let sum = DoubleWord { hi: sum.hi, lo: sum.lo + ((c * n_top - product) + c * n_rest) };
    let r = quotient(difference, sum);

    let s = r.rounded * r.rounded;
    let series = s * (-1.0 / 3.0 + s * (1.0 / 5.0 + s * (-1.0 / 7.0 + s * (1.0 / 9.0))));
    let tail = r.top * REST + (r.rest + r.rounded * series) * WHOLE;

    let (at_c, at_c_lo) = ARCTANGENT_OVER_PI[k];
    let lead = fast_two_sum(at_c, r.top * TOP);
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
    use oracle::{exact, pi, quotient, relative_error};
    use proptest::prelude::*;

    use super::*;

    fn check(n: f64, d: f64) {
        let result = arctangent_over_pi(n, d);
        let truth = quotient(&exact(n), &exact(d)).atan() / pi();
        let error = relative_error((result.hi, result.lo), &truth);
        assert!(error <= 2f64.powi(-62), "atan({n:e} / {d:e}) / pi is off by {error:e}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(1000))]

        #[test]
        fn the_error_is_below_the_bound(q in 0.0f64..=1.0, d in 1.0f64..2.0, e in -450..0) {
            let n = q * d;
            prop_assume!(n > 1e-9);
            check(n, d);
            check(n * 2f64.powi(e), d);
        }

        #[test]
        fn the_error_is_below_the_bound_where_the_table_changes(k in 1u32..=64, d in 1.0f64..2.0, step in -3i64..=3) {
            let n = f64::from(k) / 64.0 * d;
            check(f64::from_bits(n.to_bits().wrapping_add_signed(step)).min(d), d);
        }
    }

    #[test]
    fn the_table_holds_the_nearest_pairs_of_doubles() {
        for (k, &pair) in ARCTANGENT_OVER_PI.iter().enumerate() {
            let truth = quotient(&exact(k as f64), &exact(32.0)).atan() / pi();
            assert!(relative_error(pair, &truth) <= 2f64.powi(-106), "atan({k}/32)/pi");
        }
    }
}
