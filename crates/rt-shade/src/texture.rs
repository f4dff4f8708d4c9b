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

use glam::DVec3;

use crate::color::clamp_channel;

/// A picture that colours a surface: `width` x `height` texels of RGB samples, row 0 at the top.
///
/// Samples are used as they are stored, divided by `maxval`: no gamma.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Texture {
    width: usize,
    height: usize,
    samples: Vec<u16>,
    maxval: u16,
}

impl Texture {
    /// Returns the texture with these RGB samples, interleaved, row by row from the top.
    ///
    /// `None` if a dimension or `maxval` is 0, if there are not exactly `3 width height` samples, or if one of
    /// them exceeds `maxval`.
    pub fn new(width: usize, height: usize, samples: Vec<u16>, maxval: u16) -> Option<Self> {
        let length = width.checked_mul(height)?.checked_mul(3)?;
        let valid =
            length != 0 && maxval != 0 && samples.len() == length && samples.iter().all(|&s| s <= maxval);
        valid.then_some(Self { width, height, samples, maxval })
    }

    /// The number of columns; not 0.
    pub fn width(&self) -> usize {
        self.width
    }

    /// The number of rows; not 0.
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
    pub fn texel(&self, u: f64, v: f64) -> (usize, usize) {
        let column = whole(wrap(u) * self.width as f64);
        let row = whole(clamp_channel(v) * self.height as f64);
        (if column >= self.width { 0 } else { column }, row.min(self.height - 1))
    }

    /// Returns the colour of the texel that holds `(u, v)`: the nearest texel center.
    ///
    /// Coordinates outside `0..=1` are treated as [`texel`](Self::texel) says.
    pub fn nearest(&self, u: f64, v: f64) -> DVec3 {
        let (column, row) = self.texel(u, v);
        self.samples_at(column, row) / f64::from(self.maxval)
    }

    /// Returns the colour at `(u, v)`, interpolated linearly between the four nearest texel centers.
    ///
    /// Neighbours wrap around in `u` and end at the first and last row in `v`. Coordinates outside `0..=1` are
    /// treated as [`texel`](Self::texel) says. At a texel center it is that texel's colour.
    pub fn bilinear(&self, u: f64, v: f64) -> DVec3 {
        // Centers lie at half-integers: texel i covers i..i+1. One whole turn is added to stay positive.
        let x = wrap(u) * self.width as f64 + (self.width as f64 - 0.5);
        let y = (clamp_channel(v) * self.height as f64 - 0.5).clamp(0.0, (self.height - 1) as f64);
        let (left, top) = (whole(x), whole(y));
        let (across, down) = (x - x.floor(), y - y.floor());
        let (columns, rows) =
            ([left % self.width, (left + 1) % self.width], [top, (top + 1).min(self.height - 1)]);
        let [upper, lower] = rows.map(|row| {
            let [left, right] = columns.map(|column| self.samples_at(column, row));
            left + (right - left) * across
        });
        (upper + (lower - upper) * down) / f64::from(self.maxval)
    }

    /// The three samples of a texel, not yet divided by `maxval`.
    fn samples_at(&self, column: usize, row: usize) -> DVec3 {
        let start = 3 * (row * self.width + column);
        DVec3::from_array([0, 1, 2].map(|channel| f64::from(self.samples[start + channel])))
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
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a cast saturates: any result is safe"
)]
fn whole(x: f64) -> usize {
    x as usize
}
