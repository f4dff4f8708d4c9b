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
pub fn interpolate(colors: &[DVec3; 3], barycentric: [f64; 3]) -> DVec3 {
    let [alpha, beta, gamma] = barycentric;
    colors[0] * alpha + colors[1] * beta + colors[2] * gamma
}

/// Returns the colour with each channel brought into `0..=1`; NaN becomes 0, an infinity the end on its side.
pub fn clamp(color: DVec3) -> DVec3 {
    DVec3::from_array(color.to_array().map(clamp_channel))
}

/// Returns the sample that stores the channel `c`: `⌊maxval c + ½⌋` of `c` clamped to `0..=1`, in double arithmetic.
///
/// NaN becomes 0, and an infinity the end on its side. For each `maxval`, `to_sample(s / maxval, maxval)` is `s`.
///
/// ```
/// use rt_shade::color::to_sample;
///
/// assert_eq!([-1.0, 0.5, 1.0, f64::NAN].map(|c| to_sample(c, 255)), [0, 128, 255, 0]);
/// ```
pub fn to_sample(c: f64, maxval: u16) -> u16 {
    let scaled = f64::from(maxval) * clamp_channel(c) + 0.5;
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a cast rounds towards zero: the floor that is wanted"
    )]
    let sample = scaled as u16; // 65535.5 at most
    sample
}

/// Returns `c` brought into `0..=1`; NaN becomes 0, which `f64::clamp` would keep.
pub(crate) fn clamp_channel(c: f64) -> f64 {
    if c > 0.0 { c.min(1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
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
            use crate::reference::big;
            let exact = big(c[0]) * big(w[0]) + big(c[1]) * big(w[1]) + big(c[2]) * big(w[2]);
            let mixture = interpolate(&c.map(DVec3::splat), w).x;
            let error = (big(mixture) - exact).to_f64().value().abs();
            let largest = c.iter().zip(&w).map(|(c, w)| (c * w).abs()).fold(0.0, f64::max);
            prop_assert!(error <= 4.0 * f64::EPSILON * largest, "{} is {:e} away", mixture, error);
        }

        #[test]
        fn a_sample_is_never_above_maxval(bits in any::<u64>(), maxval in 1u16..) {
            prop_assert!(to_sample(f64::from_bits(bits), maxval) <= maxval);
        }

        #[test]
        fn a_brighter_channel_has_no_darker_sample(a in -0.5f64..1.5, b in -0.5f64..1.5, maxval in 1u16..) {
            prop_assert!(to_sample(a.min(b), maxval) <= to_sample(a.max(b), maxval));
        }
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
        for (channel, sample) in [
            (f64::NAN, 0),
            (-f64::NAN, 0),
            (f64::NEG_INFINITY, 0),
            (-0.0, 0),
            (f64::INFINITY, 255),
            (1.0000001, 255),
        ] {
            assert_eq!(to_sample(channel, 255), sample, "{channel}");
        }
        assert_eq!(clamp(DVec3::new(f64::NAN, -1.0, f64::INFINITY)), DVec3::new(0.0, 0.0, 1.0));
    }
}
