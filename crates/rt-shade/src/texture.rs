//! A texture: a rectangle of RGB samples, looked up by coordinates in `0..=1`.
//!
//! `u` runs along a row, `v` down from the top row:
//!
//! ```text
//!        u = 0                u = 1
//! v = 0    +----+----+----+----+        texel (column, row) covers
//!          |0,0 |1,0 |2,0 |3,0 |        column/width .. (column + 1)/width and
//!          +----+----+----+----+        row/height .. (row + 1)/height
//!          |0,1 |1,1 |2,1 |3,1 |
//! v = 1    +----+----+----+----+
//! ```
//!
//! A map of a sphere closes at the sides and ends at the poles, so `u` wraps around and `v` is clamped.

use std::error::Error;
use std::fmt;

use glam::DVec3;
use rt_math::exact::U;

use crate::color::clamp_channel;

/// A picture that colours a surface: `width` x `height` texels of RGB samples, row 0 at the top.
///
/// Samples are used as they are stored, divided by `maxval`: no gamma. They take a byte each if they are given as
/// bytes, else two.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Texture {
    width: usize,
    height: usize,
    /// Samples of a texel: 3, or 1 that stands for all three.
    channels: usize,
    samples: Texels,
    maxval: u16,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Texels {
    Eight(Vec<u8>),
    Sixteen(Vec<u16>),
}

/// Why samples are no texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the messages say what the fields are")]
pub enum TextureError {
    /// There is no column or no row.
    Empty { width: usize, height: usize },
    /// The sample of full intensity is 0.
    ZeroMaxval,
    /// The samples are neither one nor three a texel.
    Length { width: usize, height: usize, found: usize },
    /// A sample exceeds that of full intensity.
    SampleAboveMaxval { index: usize, found: u16, maxval: u16 },
}

impl fmt::Display for TextureError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Empty { width, height } => write!(f, "a texture must have a texel, found {width} x {height}"),
            Self::ZeroMaxval => f.write_str("maxval of a texture must be at least 1, found 0"),
            Self::Length { width, height, found } => {
                write!(f, "{width} x {height} texels need one sample each or three, found {found} samples in all")
            }
            Self::SampleAboveMaxval { index, found, maxval } => {
                write!(f, "sample {index} of a texture must be at most maxval = {maxval}, found {found}")
            }
        }
    }
}

impl Error for TextureError {}

impl Texture {
    /// Returns the texture with these samples, row by row from the top: RGB interleaved, or one a texel, which is grey.
    ///
    /// ```
    /// use rt_shade::{Texture, TextureError};
    ///
    /// let refused = Texture::new(1, 1, vec![0, 300, 0], 255).unwrap_err();
    /// assert_eq!(refused, TextureError::SampleAboveMaxval { index: 1, found: 300, maxval: 255 });
    /// ```
    ///
    /// # Errors
    /// If a dimension or `maxval` is 0, if there are neither `3 width height` nor `width height` samples, or if one of
    /// them exceeds `maxval`.
    pub fn new(width: usize, height: usize, samples: Vec<u16>, maxval: u16) -> Result<Self, TextureError> {
        let channels = channels(width, height, &samples, maxval)?;
        Ok(Self { width, height, channels, samples: Texels::Sixteen(samples), maxval })
    }

    /// Returns the texture with samples that are bytes, as [`new`](Self::new) does with larger ones.
    ///
    /// ```
    /// use rt_shade::Texture;
    ///
    /// let grey = Texture::from_bytes(2, 1, vec![0, 51], 255).unwrap();
    /// assert_eq!(grey.nearest(0.75, 0.5), glam::DVec3::splat(0.2));
    /// ```
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn from_bytes(width: usize, height: usize, samples: Vec<u8>, maxval: u8) -> Result<Self, TextureError> {
        let channels = channels(width, height, &samples, maxval.into())?;
        Ok(Self { width, height, channels, samples: Texels::Eight(samples), maxval: maxval.into() })
    }

    /// The number of columns; not 0.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// The number of rows; not 0.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// Returns the column and the row of the texel that holds `(u, v)`, always inside the image.
    ///
    /// These are `⌊u width⌋`, where `u = 1` wraps to column 0, and `⌊v height⌋`, where `v = 1` is the last row.
    /// Any other `u` is first taken modulo 1 and any other `v` clamped; NaN counts as 0, and so does an infinite `u`.
    ///
    /// ```
    /// use rt_shade::Texture;
    ///
    /// let texture = Texture::new(4, 2, vec![0; 24], 255).unwrap();
    /// assert_eq!(texture.texel(0.75, 0.5), (3, 1));
    /// assert_eq!(texture.texel(1.0, 1.0), (0, 1));
    /// ```
    #[must_use]
    pub fn texel(&self, u: f64, v: f64) -> (usize, usize) {
        let column = whole(wrap(u) * self.width as f64);
        let row = whole(clamp_channel(v) * self.height as f64);
        (if column >= self.width { 0 } else { column }, row.min(self.height - 1))
    }

    /// Returns the colour of the texel that holds `(u, v)`: the nearest texel center.
    ///
    /// Coordinates outside `0..=1` are treated as [`texel`](Self::texel) says.
    #[must_use]
    pub fn nearest(&self, u: f64, v: f64) -> DVec3 {
        let (column, row) = self.texel(u, v);
        self.color_at(column, row)
    }

    /// Returns the colour at `(u, v)`, interpolated linearly between the four nearest texel centers.
    ///
    /// Neighbours wrap around in `u` and end at the first and last row in `v`. Coordinates outside `0..=1` are
    /// treated as [`texel`](Self::texel) says. At a texel center it is that texel's colour.
    #[must_use]
    pub fn bilinear(&self, u: f64, v: f64) -> DVec3 {
        // Centers lie at half-integers: texel i covers i..i+1. One whole turn is added to stay positive.
        let x = wrap(u) * self.width as f64 + (self.width as f64 - 0.5);
        let y = (clamp_channel(v) * self.height as f64 - 0.5).clamp(0.0, (self.height - 1) as f64);
        let (left, top) = (whole(x), whole(y));
        let (across, down) = (x - left as f64, y - top as f64);
        let (columns, rows) = ([left % self.width, (left + 1) % self.width], [top, (top + 1).min(self.height - 1)]);
        let [upper, lower] = rows.map(|row| {
            let [left, right] = columns.map(|column| self.samples_at(column, row));
            left + (right - left) * across
        });
        (upper + (lower - upper) * down) / f64::from(self.maxval)
    }

    /// The colour of a texel: each channel is the double nearest to its sample over `maxval`.
    pub(crate) fn color_at(&self, column: usize, row: usize) -> DVec3 {
        self.samples_at(column, row) / f64::from(self.maxval)
    }

    /// Returns what [`nearest`](Self::nearest) returns if that is the same for all coordinates in `0..=1` that are
    /// within these errors of `u` and `v`.
    #[must_use]
    pub fn nearest_within(&self, (u, v): (f64, f64), (u_error, v_error): (f64, f64)) -> Option<DVec3> {
        let (width, height) = (self.width as f64, self.height as f64);
        let (x, y) = (u * width, v * height);
        // The product is rounded, and so are the ends.
        let (across, down) = ((u_error + 3.0 * U) * width, (v_error + 3.0 * U) * height);
        // From 0 to the last column, so that nothing wraps; v ends where it ends. False for NaN, of which the whole part
        // is 0.
        let column = whole(x + across);
        let inside = x - across >= 0.0 && x + across < width && whole(x - across) == column;
        let [top, bottom] = [y - down, y + down].map(|end| whole(end).min(self.height - 1));
        let known = y - down <= y + down;
        (inside && known && top == bottom).then(|| self.color_at(column, bottom))
    }

    /// Returns what [`bilinear`](Self::bilinear) returns, and a bound of its error for coordinates with these errors.
    ///
    /// A channel changes by at most 1 from texel to texel. `docs/numerics.md`, section 14, has the proof.
    #[must_use]
    pub fn bilinear_within(&self, (u, v): (f64, f64), (u_error, v_error): (f64, f64)) -> (DVec3, f64) {
        let (width, height) = (self.width as f64, self.height as f64);
        let error = 1.01 * (width * u_error + height * v_error) + (3.0 * width + 3.0 * height + 9.0) * U;
        (self.bilinear(u, v), error)
    }

    /// The three samples of a texel, not yet divided by `maxval`.
    #[inline]
    fn samples_at(&self, column: usize, row: usize) -> DVec3 {
        let start = self.channels * (row * self.width + column);
        let places = start..start + self.channels;
        match &self.samples {
            Texels::Eight(samples) => color_of(&samples[places]),
            Texels::Sixteen(samples) => color_of(&samples[places]),
        }
    }
}

/// The colour of a texel: three samples, or one that stands for all three.
fn color_of<S: Copy + Into<f64>>(texel: &[S]) -> DVec3 {
    match *texel {
        [red, green, blue] => DVec3::new(red.into(), green.into(), blue.into()),
        _ => DVec3::splat(texel[0].into()),
    }
}

/// The number of samples of a texel, if these samples are a texture.
fn channels<S: Copy + Into<u16>>(
    width: usize,
    height: usize,
    samples: &[S],
    maxval: u16,
) -> Result<usize, TextureError> {
    let found = samples.len();
    if width == 0 || height == 0 {
        return Err(TextureError::Empty { width, height });
    }
    if maxval == 0 {
        return Err(TextureError::ZeroMaxval);
    }
    let fits =
        |&channels: &usize| width.checked_mul(height).and_then(|texels| texels.checked_mul(channels)) == Some(found);
    let channels = [1, 3].into_iter().find(fits).ok_or(TextureError::Length { width, height, found })?;
    match samples.iter().position(|&sample| sample.into() > maxval) {
        Some(index) => Err(TextureError::SampleAboveMaxval { index, found: samples[index].into(), maxval }),
        None => Ok(channels),
    }
}

/// Returns `u` modulo 1, in `0..=1` (1 itself, and what rounds to it, stay 1); not a finite number: 0.
fn wrap(u: f64) -> f64 {
    if (0.0..=1.0).contains(&u) {
        u
    } else if u.is_finite() {
        u - u.floor()
    } else {
        0.0
    }
}

/// Returns the whole part of a number that is not negative.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a cast saturates: any result is safe")]
fn whole(x: f64) -> usize {
    x as usize
}

#[cfg(test)]
mod tests {
    use oracle::{Big, Random, cases, dot, exact, long, root, rounded, sub, vector};
    use proptest::prelude::*;

    use super::*;
    use crate::texture_uv_within;

    /// A texture whose texel (column, row) has the samples (column, row, column + row).
    fn ramp(width: usize, height: usize) -> Texture {
        let samples = (0..height)
            .flat_map(|row| (0..width).flat_map(move |column| [column, row, column + row]))
            .map(|sample| u16::try_from(sample).expect("a small texture"));
        Texture::new(width, height, samples.collect(), u16::MAX).expect("the samples fit")
    }

    fn texel_of(color: DVec3) -> (f64, f64) {
        (color.x * f64::from(u16::MAX), color.y * f64::from(u16::MAX))
    }

    #[test]
    fn what_is_no_picture_is_refused() {
        assert!(Texture::new(2, 1, vec![0, 1, 2, 3, 4, 5], 5).is_ok());
        let length = |width, height, found| Err(TextureError::Length { width, height, found });
        let above = |index| Err(TextureError::SampleAboveMaxval { index, found: 6, maxval: 5 });
        assert_eq!(Texture::new(2, 1, vec![0, 1, 2, 3, 4, 6], 5), above(5));
        assert_eq!(Texture::new(2, 1, vec![0; 5], 5), length(2, 1, 5));
        assert_eq!(Texture::new(2, 1, vec![0; 7], 5), length(2, 1, 7));
        assert_eq!(Texture::new(0, 1, vec![], 5), Err(TextureError::Empty { width: 0, height: 1 }));
        assert_eq!(Texture::new(1, 0, vec![], 5), Err(TextureError::Empty { width: 1, height: 0 }));
        assert_eq!(Texture::new(1, 1, vec![0; 3], 0), Err(TextureError::ZeroMaxval));
        assert_eq!(Texture::new(usize::MAX, 2, vec![], 5), length(usize::MAX, 2, 0));
        assert_eq!(Texture::from_bytes(1, 1, vec![0, 6, 0], 5), above(1));
        assert_eq!(Texture::from_bytes(1, 1, vec![0; 2], 5), length(1, 1, 2));
        assert_eq!(Texture::from_bytes(1, 1, vec![0; 3], 0), Err(TextureError::ZeroMaxval));
    }

    #[test]
    fn bytes_and_grey_look_up_as_larger_samples_do() {
        let grey: Vec<u8> = (0..12).map(|index| index * 20).collect();
        let rgb: Vec<u8> = grey.iter().flat_map(|&sample| [sample; 3]).collect();
        let wide = |samples: &[u8]| samples.iter().map(|&sample| u16::from(sample)).collect();
        let expected = Texture::new(4, 3, wide(&rgb), 255).expect("the samples fit");
        for texture in [
            Texture::new(4, 3, wide(&grey), 255),
            Texture::from_bytes(4, 3, grey.clone(), 255),
            Texture::from_bytes(4, 3, rgb.clone(), 255),
        ] {
            let texture = texture.expect("the samples fit");
            for index in 0..100 {
                let (u, v) = (f64::from(index % 11) / 10.0, f64::from(index) / 99.0);
                assert_eq!(texture.nearest(u, v), expected.nearest(u, v), "{u} {v}");
                assert_eq!(texture.bilinear(u, v), expected.bilinear(u, v), "{u} {v}");
            }
        }
    }

    proptest! {
        #[test]
        fn the_texel_is_inside_for_any_numbers(u in any::<u64>(), v in any::<u64>(), w in 1usize..9, h in 1usize..9) {
            let texture = ramp(w, h);
            let (u, v) = (f64::from_bits(u), f64::from_bits(v));
            let (column, row) = texture.texel(u, v);
            prop_assert!(column < w && row < h, "({}, {}) gave ({}, {})", u, v, column, row);
            prop_assert!(texture.nearest(u, v).is_finite() && texture.bilinear(u, v).is_finite());
        }

        #[test]
        fn both_lookups_give_the_texel_at_its_center(w in 1usize..40, h in 1usize..40, i in 0usize..40, j in 0usize..40) {
            let (i, j) = (i % w, j % h);
            let texture = ramp(w, h);
            let (u, v) = ((i as f64 + 0.5) / w as f64, (j as f64 + 0.5) / h as f64);
            prop_assert_eq!(texture.texel(u, v), (i, j));
            let (nearest, bilinear) = (texture.nearest(u, v), texture.bilinear(u, v));
            // The center itself is rounded; a neighbour differs by at most 80 samples.
            prop_assert!((nearest - bilinear).length() < 80.0 * 80.0 * f64::EPSILON, "{} {}", nearest, bilinear);
        }

        #[test]
        fn bilinear_lookup_is_linear_between_centers(u in 0.125f64..0.875, v in 0.125f64..0.875) {
            // A ramp is a linear function of the coordinates, away from the seam and the poles.
            let (column, row) = texel_of(ramp(4, 4).bilinear(u, v));
            prop_assert!((column - (4.0 * u - 0.5)).abs() < 1e-12, "column {} for {}", column, u);
            prop_assert!((row - (4.0 * v - 0.5)).abs() < 1e-12, "row {} for {}", row, v);
        }

        #[test]
        fn one_turn_more_is_the_same_place(u in 0.0f64..1.0, v in 0.0f64..1.0, turns in -5i32..5) {
            let texture = ramp(8, 4);
            // 2^-20 keeps u + turns exact.
            let u = (u * 1_048_576.0).floor() / 1_048_576.0;
            prop_assert_eq!(texture.texel(u + f64::from(turns), v), texture.texel(u, v));
            prop_assert_eq!(texture.bilinear(u + f64::from(turns), v), texture.bilinear(u, v));
        }
    }

    #[test]
    fn u_wraps_and_v_ends() {
        let texture = ramp(4, 3);
        let below_one = 1.0 - f64::EPSILON / 2.0;
        assert_eq!(texture.texel(1.0, 1.0), (0, 2), "u = 1 is the first column, v = 1 the last row");
        assert_eq!(texture.texel(below_one, below_one), (3, 2));
        assert_eq!(texture.texel(0.0, 0.0), (0, 0));
        assert_eq!(texture.texel(-f64::from_bits(1), -1.0), (0, 0), "a hair below 0 rounds to a whole turn");
        assert_eq!(texture.texel(-0.25, 2.0), (3, 2));
        assert_eq!(texture.texel(f64::NAN, f64::NAN), (0, 0));
        assert_eq!(texture.texel(f64::INFINITY, f64::INFINITY), (0, 2));
    }

    #[test]
    fn bilinear_lookup_closes_at_the_seam_and_ends_at_the_poles() {
        let texture = ramp(4, 3);
        // Halfway between the last column and the first.
        assert_eq!(texel_of(texture.bilinear(0.0, 0.5)), (1.5, 1.0));
        assert_eq!(texture.bilinear(0.0, 0.5), texture.bilinear(1.0, 0.5));
        // Above the center of the top row and below that of the last there is nothing to mix with.
        assert_eq!(texel_of(texture.bilinear(0.375, 0.0)), (1.0, 0.0));
        assert_eq!(texel_of(texture.bilinear(0.375, 1.0)), (1.0, 2.0));
    }

    #[test]
    fn samples_are_divided_by_maxval_and_nothing_else() {
        let texture = Texture::new(1, 1, vec![0, 51, 255], 255).expect("the samples fit");
        let expected = DVec3::new(0.0, 0.2, 1.0);
        assert_eq!(texture.nearest(0.3, 0.7), expected);
        assert_eq!(texture.bilinear(0.3, 0.7), expected);
    }

    #[test]
    fn a_map_reads_the_right_way_round_from_outside() {
        // Seen from +z with +y up, +x is on the right: a map's next column lies further to the right.
        let texture = ramp(16, 8);
        let left = DVec3::new(-0.3, 0.2, 1.0);
        let right = DVec3::new(0.3, 0.2, 1.0);
        let column = |normal, mirrored| {
            let (u, v) = crate::texture_uv(normal, mirrored);
            texture.texel(u, v).0
        };
        assert!(column(left, false) < column(right, false), "the right way round");
        assert!(column(left, true) > column(right, true), "the report's raw orientation");
        let (_, north) = crate::texture_uv(DVec3::new(0.1, 0.9, 0.1), false);
        assert!(north < 0.5, "north is at the top row");
    }

    /// Whether a bound says that nothing is known.
    fn is_unknown(bound: f64) -> bool {
        bound.is_nan() || bound == f64::INFINITY
    }

    /// The exact coordinates of a lookup, in texels.
    fn exact_place(normal: DVec3, mirrored: bool, texture: &Texture) -> [Big; 2] {
        let sides = normal.to_array().map(f64::is_sign_negative);
        let turned = if mirrored { normal } else { DVec3 { z: -normal.z, ..normal } };
        let [u, v] = oracle::coordinates(&vector(turned).map(|part| long(&part)), {
            let [x, y, z] = sides;
            [x, y, z == mirrored]
        });
        [u * long(&exact(texture.width as f64)), v * long(&exact(texture.height as f64))]
    }

    /// The texel's channel that the exact mixture takes.
    fn exact_mixture(texture: &Texture, [x, y]: &[Big; 2], axis: usize) -> Big {
        let half = long(&exact(0.5));
        let cell = |place: &Big| {
            let below = (place - &half).floor();
            (below.to_f64().value(), place - &half - &below)
        };
        let ((left, across), (top, down)) = (cell(x), cell(y));
        let column = |k: f64| whole(k.rem_euclid(texture.width as f64));
        let row = |k: f64| whole(k.clamp(0.0, (texture.height - 1) as f64));
        let texel = |i: f64, j: f64| long(&exact(texture.color_at(column(left + i), row(top + j))[axis]));
        let mix = |a: Big, b: Big, share: &Big| &a + (b - &a) * share;
        let [upper, lower] = [0.0, 1.0].map(|j| mix(texel(0.0, j), texel(1.0, j), &across));
        mix(upper, lower, &down)
    }

    /// A normal beside the seam, a pole, the border or the center of a texel, or anywhere.
    fn hard_normal(random: &mut Random, texture: &Texture, kind: usize) -> DVec3 {
        let tiny = random.power(-60..-4);
        match kind {
            0 => DVec3::new(-1.0, random.uniform(), tiny * random.uniform()),
            1 => DVec3::new(tiny * random.uniform(), random.sign(), tiny * random.uniform()),
            2 => {
                let (width, height) = (2 * texture.width, 2 * texture.height);
                let turn = std::f64::consts::TAU * random.below(width) as f64 / width as f64;
                let fall = std::f64::consts::PI * random.below(height) as f64 / height as f64;
                let (sin, cos) = (fall + tiny * random.uniform()).sin_cos();
                let (z, x) = (turn + tiny * random.uniform()).sin_cos();
                DVec3::new(sin * x, cos, sin * z)
            }
            _ => random.point(),
        }
    }

    #[test]
    fn lookups_within_errors_are_those_of_the_exact_coordinates() {
        let mut random = Random::new(21);
        let textures = [(1, 1), (2, 1), (7, 5), (64, 2), (333, 256), (65_535, 1), (1, 40_000), (30_001, 3)];
        let textures = textures.map(|(width, height)| {
            let mut sample = || u8::try_from(random.below(2)).expect("0 or 1");
            let samples = (0..width * height).map(|_| sample()).collect();
            Texture::from_bytes(width, height, samples, 1).expect("bits")
        });
        let (mut found, mut open, mut sharpest) = (0, 0, 0.0f64);
        for i in 0..cases(100_000) {
            let texture = &textures[i % textures.len()];
            let mirrored = random.one_in(2);
            let normal = hard_normal(&mut random, texture, i / textures.len() % 4);
            let length = if random.one_in(4) { random.power(-900..900) } else { 1.0 };
            // From no error at all to one that is too large to say anything.
            let size = if random.one_in(8) { 0.0 } else { random.power(-56..0) };
            let wrong = normal + size * random.point();
            let error = rounded(&root(&{
                let difference = sub(&vector(wrong), &vector(normal));
                dot(&difference, &difference)
            }))
            .next_up();
            let error = if wrong == normal { 0.0 } else { error };
            let (coordinates, errors) = texture_uv_within(length * wrong, length * error, mirrored);
            // Scaling is exact, or the normal is what it gives.
            if length * wrong / length != wrong || normal == DVec3::ZERO || length * error / length < error {
                continue;
            }
            let place = exact_place(normal, mirrored, texture);
            match texture.nearest_within(coordinates, errors) {
                None => open += 1,
                Some(color) => {
                    found += 1;
                    let [column, row] = place.each_ref().map(|place| whole(place.floor().to_f64().value()));
                    let expected = texture.color_at(column % texture.width, row.min(texture.height - 1));
                    assert_eq!(color, expected, "{normal:?} as {wrong:?}, {coordinates:?} {errors:?}, {column} {row}");
                }
            }
            let (color, bound) = texture.bilinear_within(coordinates, errors);
            let off = (exact(color.x) - exact_mixture(texture, &place, 0)).to_f64().value().abs();
            assert!(
                off <= bound || is_unknown(bound),
                "{normal:?} as {wrong:?}: {color} is {off:e} off, bound {bound:e}"
            );
            if bound < 0.5 {
                sharpest = sharpest.max(off / bound);
            }
        }
        assert!(found > cases(100_000) / 4 && open > cases(100_000) / 10, "{found} {open}");
        assert!(sharpest > 0.5, "{sharpest}");
    }

    #[test]
    fn coordinates_without_a_bound_show_no_texel() {
        let texture = ramp(4, 2);
        for error in [f64::INFINITY, f64::NAN] {
            for (u, v) in [(error, 0.0), (0.0, error)] {
                assert_eq!(texture.nearest_within((0.4, 0.3), (u, v)), None);
                assert!(is_unknown(texture.bilinear_within((0.4, 0.3), (u, v)).1));
            }
            assert_eq!(texture.nearest_within((error, 0.3), (0.0, 0.0)), None);
            let (_, (u, v)) = texture_uv_within(DVec3::new(1.0, 2.0, 3.0), error, false);
            assert!(is_unknown(u) && is_unknown(v));
        }
        // At a pole the longitude is unknown, and the latitude is not.
        let (_, (u, v)) = texture_uv_within(DVec3::Y, 0.0, false);
        assert!(is_unknown(u) && v < 1e-15);
    }

    /// Beside the border of a texel, the rounded product of a coordinate and the size may lie on the other side of it.
    #[test]
    fn coordinates_beside_a_border_show_the_texel_of_their_exact_product() {
        let mut random = Random::new(22);
        let (mut open, mut rounding_would_err) = (0, 0);
        for _ in 0..cases(100_000) {
            let size = 2 + random.below(1000);
            let samples = |size| (0..size).map(|k| u16::try_from(k).expect("small")).collect();
            let row = Texture::new(size, 1, samples(size), u16::try_from(size).expect("small")).expect("grey");
            let column = Texture::new(1, size, samples(size), u16::try_from(size).expect("small")).expect("grey");
            let k = 1 + random.below(size - 1);
            let border = k as f64 / size as f64;
            for place in [border.next_down(), border, border.next_up()] {
                let exact = whole((exact(place) * exact(size as f64)).floor().to_f64().value());
                rounding_would_err += usize::from(whole(place * size as f64) != exact);
                for (texture, at) in [(&row, (place, 0.5)), (&column, (0.5, place))] {
                    match texture.nearest_within(at, (0.0, 0.0)) {
                        Some(color) => assert_eq!(color.x, exact as f64 / size as f64, "{place} of {size}"),
                        None => open += 1,
                    }
                }
            }
            // Some last places of the largest coordinate farther, each is known.
            for (place, texel) in [(border - 8.0 * U, k - 1), (border + 8.0 * U, k)] {
                for (texture, at) in [(&row, (place, 0.5)), (&column, (0.5, place))] {
                    let color = texture.nearest_within(at, (0.0, 0.0)).expect("far from the border");
                    assert_eq!(color.x, texel as f64 / size as f64, "{place} of {size}");
                }
            }
        }
        assert!(open > 1000 && rounding_would_err > 100, "{open} {rounding_would_err}");
    }
}
