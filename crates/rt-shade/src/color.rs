//! Linear colours: between the corners of a triangle, and on their way to the samples of a picture.
//!
//! A channel may leave `0..=1` while light is added up; [`clamp`] brings it back before samples are averaged, and
//! [`to_sample`] before it is stored. Both turn NaN into 0, so that a bad number shows as black and never as noise.

use glam::DVec3;

/// Returns the colour at the point with these barycentric coordinates, `colors[i]` being the colour of vertex `i`.
///
/// The weights need not sum to one; in each channel the error is at most
/// `4 f64::EPSILON` times the largest product (three products and two sums, each rounded).
///
/// ```
/// use glam::DVec3;
/// use rt_shade::color::interpolate;
///
/// let red_green_blue = [DVec3::X, DVec3::Y, DVec3::Z];
/// assert_eq!(interpolate(&red_green_blue, [0.5, 0.25, 0.25]), DVec3::new(0.5, 0.25, 0.25));
/// ```
#[must_use]
pub fn interpolate(colors: &[DVec3; 3], barycentric: [f64; 3]) -> DVec3 {
    let [alpha, beta, gamma] = barycentric;
    colors[0] * alpha + colors[1] * beta + colors[2] * gamma
}

/// Returns the colour with each channel brought into `0..=1`; NaN becomes 0, an infinity the end on its side.
#[must_use]
pub fn clamp(color: impl Into<DVec3>) -> DVec3 {
    DVec3::from_array(color.into().to_array().map(clamp_channel))
}

/// Returns the sample that stores the channel `c`: `⌊maxval c + ½⌋` of `c` clamped to `0..=1`, exactly for the double
/// given.
///
/// NaN becomes 0, and an infinity the end on its side. For each `maxval`, `to_sample(s / maxval, maxval)` is `s`.
///
/// ```
/// use rt_shade::color::to_sample;
///
/// assert_eq!([-1.0, 0.5, 1.0, f64::NAN].map(|c| to_sample(c, 255)), [0, 128, 255, 0]);
/// // the double 0.7 lies below 7/10, and 255 times it below 178.5, to which the product of doubles rounds
/// assert_eq!((to_sample(0.7, 255), 255.0 * 0.7), (178, 178.5));
/// ```
#[inline]
#[must_use]
pub fn to_sample(c: f64, maxval: u16) -> u16 {
    let c = clamp_channel(c);
    // Two roundings, neither of which passes a half or a whole number: they may lift a sample just below a half onto
    // the next whole number, and do nothing else.
    let scaled = f64::from(maxval) * c + 0.5;
    #[expect(clippy::cast_possible_truncation, reason = "a cast rounds towards zero: the floor that is wanted")]
    let sample = scaled as u16; // 65535.5 at most
    if f64::from(sample) == scaled { integer_sample(c, maxval) } else { sample }
}

/// [`to_sample`] in integers, for a channel in `0..=1`.
#[inline(never)]
fn integer_sample(c: f64, maxval: u16) -> u16 {
    // c = significand 2^(-63 - shift), the significand's top bit being set, and
    // 4 maxval significand 2^-64 is 2 maxval c 2^shift. ⌊x + ½⌋ = ⌊(⌊2x⌋ + 1) / 2⌋: cutting bits off changes no floor.
    let bits = c.to_bits();
    let significand = 1 << 63 | bits << 11;
    let shift = 1023 - (bits >> 52);
    let product = u128::from(significand) * u128::from(4 * u64::from(maxval));
    // Of numbers below 2^18 a shift by 63 leaves 0, as any longer one would: zero and subnormal numbers are among
    // these.
    let doubled = (product >> 64) as u64 >> shift.min(63);
    #[expect(clippy::cast_possible_truncation, reason = "c is at most 1, so this is at most maxval")]
    let sample = ((doubled + 1) >> 1) as u16;
    sample
}

/// Returns `c` brought into `0..=1`; NaN becomes 0, which `f64::clamp` would keep.
pub(crate) fn clamp_channel(c: f64) -> f64 {
    if c > 0.0 { c.min(1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use oracle::{dot, exact, vector};
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_vertex_has_its_own_color(colors in prop::array::uniform3(prop::array::uniform3(0.0f64..1.0)), i in 0usize..3) {
            let colors = colors.map(DVec3::from_array);
            let mut weights = [0.0; 3];
            weights[i] = 1.0;
            prop_assert_eq!(interpolate(&colors, weights), colors[i]);
        }

        #[test]
        fn a_mixture_stays_between_its_colors(
            colors in prop::array::uniform3(prop::array::uniform3(0.0f64..1.0)),
            a in 0.0f64..1.0,
            b in 0.0f64..1.0,
        ) {
            let colors = colors.map(DVec3::from_array);
            let (a, b) = if a + b > 1.0 { (1.0 - a, 1.0 - b) } else { (a, b) };
            let mixture = interpolate(&colors, [a, b, 1.0 - a - b]);
            let lowest = colors[0].min(colors[1]).min(colors[2]);
            let highest = colors[0].max(colors[1]).max(colors[2]);
            // Three products and two sums of numbers up to 1, and weights that sum to 1 within one more rounding.
            let slack = DVec3::splat(4.0 * f64::EPSILON);
            prop_assert!(mixture.cmpge(lowest - slack).all() && mixture.cmple(highest + slack).all(), "{}", mixture);
        }

        #[test]
        fn a_mixture_is_within_four_ulp_of_its_largest_product(
            c in prop::array::uniform3(-1.0f64..1.0),
            w in prop::array::uniform3(-2.0f64..2.0),
        ) {
            let mixture = interpolate(&c.map(DVec3::splat), w).x;
            let error = (exact(mixture) - dot(&vector(c), &vector(w))).to_f64().value().abs();
            let largest = c.iter().zip(&w).map(|(c, w)| (c * w).abs()).fold(0.0, f64::max);
            prop_assert!(error <= 4.0 * f64::EPSILON * largest, "{} is {:e} away", mixture, error);
        }

        #[test]
        fn a_sample_is_never_above_maxval(bits in any::<u64>(), maxval in 1u16..) {
            prop_assert!(to_sample(f64::from_bits(bits), maxval) <= maxval);
        }

        #[test]
        fn samples_of_any_channel_are_exact(c in 0.0f64..=1.0, e in 0i32..1100, maxval in 1u16..) {
            check_sample(c, maxval);
            check_sample(c * 2f64.powi(-(e / 2)) * 2f64.powi(e / 2 - e), maxval); // down to 0
            check_sample(c.round(), maxval);
        }

        #[test]
        fn a_brighter_channel_has_no_darker_sample(a in -0.5f64..1.5, b in -0.5f64..1.5, maxval in 1u16..) {
            prop_assert!(to_sample(a.min(b), maxval) <= to_sample(a.max(b), maxval));
        }
    }

    /// Checks that `⌊maxval c + ½⌋` is what [`to_sample`] gives, for a channel in `0..=1`.
    fn check_sample(c: f64, maxval: u16) {
        let sample = to_sample(c, maxval);
        assert_eq!(integer_sample(c, maxval), sample, "{c:e} of {maxval}, in integers");
        let [doubled, below] =
            [exact(c) * exact(f64::from(2 * u32::from(maxval))), exact(2.0 * f64::from(sample) - 1.0)];
        assert!(below <= doubled && doubled < below + exact(2.0), "{c:e} of {maxval} gives {sample}");
    }

    #[test]
    fn samples_are_exact_beside_every_step() {
        let mut rounding_would_err = 0;
        for maxval in [1, 2, 3, 5, 7, 100, 254, 255, 256, 257, 1000, 1023, 4095, 32767, 32768, 54321, 65534, 65535] {
            for doubled in 0..=2 * u32::from(maxval) {
                // k / maxval and (k + 1/2) / maxval, and the doubles around them
                let c = f64::from(doubled) / f64::from(2 * u32::from(maxval));
                for c in [c.next_down().next_down(), c.next_down(), c, c.next_up(), c.next_up().next_up()] {
                    if (0.0..=1.0).contains(&c) {
                        check_sample(c, maxval);
                        let rounded = (f64::from(maxval) * c + 0.5).floor();
                        rounding_would_err += u32::from(rounded != f64::from(to_sample(c, maxval)));
                    }
                }
            }
        }
        assert!(rounding_would_err > 10_000, "{rounding_would_err}");
    }

    #[test]
    fn samples_of_short_decimals_are_exact() {
        for maxval in [255, 65535] {
            (0..=10_000).for_each(|i| check_sample(f64::from(i) / 10_000.0, maxval));
        }
        assert_eq!(to_sample(0.7, 255), 178);
    }

    #[test]
    fn every_sample_comes_back_from_its_channel() {
        for maxval in (1..=1024).chain([4095, 32767, 65534, 65535]) {
            for sample in 0..=maxval {
                let channel = f64::from(sample) / f64::from(maxval);
                assert_eq!(to_sample(channel, maxval), sample, "of {maxval}");
            }
        }
    }

    #[test]
    fn samples_round_half_up_and_bad_channels_are_black() {
        assert_eq!(to_sample(0.5, 255), 128);
        assert_eq!(to_sample(0.5, 65535), 32768);
        assert_eq!(to_sample(0.5, 1), 1);
        assert_eq!(to_sample(0.499, 1), 0);
        for (channel, sample) in
            [(f64::NAN, 0), (-f64::NAN, 0), (f64::NEG_INFINITY, 0), (-0.0, 0), (f64::INFINITY, 255), (1.0000001, 255)]
        {
            assert_eq!(to_sample(channel, 255), sample, "{channel}");
        }
        assert_eq!(clamp(DVec3::new(f64::NAN, -1.0, f64::INFINITY)), DVec3::new(0.0, 0.0, 1.0));
    }
}
