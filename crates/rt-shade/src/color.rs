//! Linear colours: between the corners of a triangle, and on their way to the samples of a picture.
//!
//! A channel may leave `0..=1` while light is added up; [`clamp`] brings it back before samples are averaged, and
//! [`to_sample`] before it is stored. Both turn NaN into 0, so that a bad number shows as black and never as noise.

use glam::DVec3;

/// Returns the colour at the point with these barycentric coordinates, `colors[i]` being the colour of vertex `i`.
///
/// The weights need not sum to one; the error is at most 3 ulp of the largest product in each channel (tested).
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
