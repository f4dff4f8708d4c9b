//! A picture in memory: RGB samples exactly as a file holds them, with the `maxval` that means full intensity.
//!
//! Samples stay raw. A picture whose `maxval` fits in a byte keeps one byte a sample, any other two; a grey file's
//! keeps one sample a pixel, any other three. [`Pixmap::into_stored`] alone shows the difference.

use std::collections::TryReserveError;
use std::error::Error;
use std::fmt;

/// An RGB picture: `3 * width * height` samples, row 0 at the top, each in `0..=maxval`.
///
/// Invariant: `width >= 1`, `height >= 1`, `maxval >= 1`, no sample above `maxval`.
///
/// ```
/// use rt_io::Pixmap;
/// let pixmap = Pixmap::new(2, 1, 255, vec![255, 0, 0, 0, 0, 128]).unwrap();
/// assert_eq!(pixmap.pixel(1, 0), [0, 0, 128]);
/// let refused = Pixmap::new(2, 1, 100, vec![255, 0, 0, 0, 0, 128]).unwrap_err();
/// assert_eq!(refused.to_string(), "sample 0 of a picture must be at most maxval = 100, found 255");
/// ```
#[derive(Clone, Debug)]
pub struct Pixmap {
    width: usize,
    height: usize,
    maxval: u16,
    /// Samples of a pixel that are stored: 1 where all three are equal in the file, else 3.
    channels: usize,
    samples: Samples,
}

/// Samples in the width that a picture keeps them in: `Eight` exactly when `maxval <= 255`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Samples {
    /// One byte each.
    Eight(Vec<u8>),
    /// Two bytes each.
    Sixteen(Vec<u16>),
}

/// Why samples are no picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the messages say what the fields are")]
pub enum PixmapError {
    /// There is no column or no row.
    Empty { width: usize, height: usize },
    /// The sample of full intensity is 0.
    ZeroMaxval,
    /// The samples are not three a pixel.
    Length { width: usize, height: usize, found: usize },
    /// A sample exceeds that of full intensity.
    SampleAboveMaxval { index: usize, found: u16, maxval: u16 },
}

impl fmt::Display for PixmapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty { width, height } => write!(f, "a picture must have a pixel, found {width} x {height}"),
            Self::ZeroMaxval => f.write_str("maxval of a picture must be at least 1, found 0"),
            Self::Length { width, height, found } => {
                write!(f, "{width} x {height} pixels need three samples each, found {found} samples in all")
            }
            Self::SampleAboveMaxval { index, found, maxval } => {
                write!(f, "sample {index} of a picture must be at most maxval = {maxval}, found {found}")
            }
        }
    }
}

impl Error for PixmapError {}

/// Pictures are equal if their pixels and their `maxval` are, however they are stored.
impl PartialEq for Pixmap {
    fn eq(&self, other: &Self) -> bool {
        let size = |pixmap: &Self| (pixmap.width, pixmap.height, pixmap.maxval);
        if size(self) != size(other) {
            return false;
        }
        if self.channels == other.channels {
            return self.samples == other.samples;
        }
        let mut places = (0..self.height).flat_map(|y| (0..self.width).map(move |x| (x, y)));
        places.all(|(x, y)| self.pixel(x, y) == other.pixel(x, y))
    }
}

impl Eq for Pixmap {}

impl Pixmap {
    /// A picture of the interleaved RGB `samples`, row by row from the top.
    ///
    /// # Errors
    /// If they break the invariant; [`PixmapError`] says how.
    pub fn new(width: usize, height: usize, maxval: u16, samples: Vec<u16>) -> Result<Self, PixmapError> {
        let found = samples.len();
        if width == 0 || height == 0 {
            return Err(PixmapError::Empty { width, height });
        }
        if maxval == 0 {
            return Err(PixmapError::ZeroMaxval);
        }
        if width.checked_mul(height).and_then(|pixels| pixels.checked_mul(3)) != Some(found) {
            return Err(PixmapError::Length { width, height, found });
        }
        if let Some(index) = samples.iter().position(|&sample| sample > maxval) {
            return Err(PixmapError::SampleAboveMaxval { index, found: samples[index], maxval });
        }
        let samples = match u8::try_from(maxval) {
            Ok(_) => Samples::Eight(samples.iter().map(|&sample| low_byte(sample)).collect()),
            Err(_) => Samples::Sixteen(samples),
        };
        Ok(Self { width, height, maxval, channels: 3, samples })
    }

    /// A picture of samples that are known to be at most `maxval` and to have its width; checks the size alone, which
    /// tells grey from RGB.
    pub(crate) fn from_checked(width: usize, height: usize, maxval: u16, samples: Samples) -> Option<Self> {
        let pixels = width.checked_mul(height)?;
        let found = match &samples {
            Samples::Eight(samples) => samples.len(),
            Samples::Sixteen(samples) => samples.len(),
        };
        debug_assert_eq!(maxval <= 255, matches!(samples, Samples::Eight(_)));
        let channels = if found == pixels { 1 } else { 3 };
        let valid = pixels > 0 && Some(found) == pixels.checked_mul(channels);
        valid.then_some(Self { width, height, maxval, channels, samples })
    }

    /// Number of columns, at least 1.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Number of rows, at least 1.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// The sample value of full intensity, in `1..=65535`.
    #[must_use]
    pub fn maxval(&self) -> u16 {
        self.maxval
    }

    /// Red, green and blue at column `x` of row `y`; row 0 is the top.
    ///
    /// # Panics
    /// If `x >= width` or `y >= height`.
    #[must_use]
    pub fn pixel(&self, x: usize, y: usize) -> [u16; 3] {
        assert!(x < self.width && y < self.height, "pixel ({x}, {y}) of a {} x {} picture", self.width, self.height);
        let start = self.channels * (y * self.width + x);
        let places = [0, 1, 2].map(|channel: usize| start + channel.min(self.channels - 1));
        match &self.samples {
            Samples::Eight(samples) => places.map(|place| u16::from(samples[place])),
            Samples::Sixteen(samples) => places.map(|place| samples[place]),
        }
    }

    /// All samples, interleaved red, green, blue, row by row from the top.
    #[must_use]
    pub fn to_samples(&self) -> Vec<u16> {
        let repeated = 3 / self.channels;
        match &self.samples {
            Samples::Eight(samples) => {
                samples.iter().flat_map(|&sample| std::iter::repeat_n(u16::from(sample), repeated)).collect()
            }
            Samples::Sixteen(samples) => {
                samples.iter().flat_map(|&sample| std::iter::repeat_n(sample, repeated)).collect()
            }
        }
    }

    /// All samples as [`to_samples`](Self::to_samples) gives them, without a copy where they are stored so already.
    #[must_use]
    pub fn into_samples(self) -> Vec<u16> {
        match self.samples {
            Samples::Sixteen(samples) if self.channels == 3 => samples,
            _ => self.to_samples(),
        }
    }

    /// The samples as they are stored, which takes no memory: RGB interleaved, row by row from the top, or one a pixel
    /// where the picture came from a grey file.
    #[must_use]
    pub fn into_stored(self) -> Samples {
        self.samples
    }

    /// The same picture with another `maxval`; each sample `v` becomes the nearest to `v * to / from`.
    ///
    /// The rounding is exact, `(v * to + from / 2) / from` in integers, which is also the rule of netpbm's `pamdepth`.
    ///
    /// # Panics
    /// If `maxval == 0`, and if there is not enough memory, which [`try_scaled`](Self::try_scaled) says instead.
    ///
    /// ```
    /// use rt_io::Pixmap;
    /// let pixmap = Pixmap::new(1, 1, 31, vec![0, 3, 31]).unwrap();
    /// assert_eq!(pixmap.scaled(255).pixel(0, 0), [0, 25, 255]);
    /// ```
    #[must_use]
    pub fn scaled(&self, maxval: u16) -> Self {
        self.try_scaled(maxval).expect("there is memory for the samples")
    }

    /// The same picture with another `maxval`, as [`scaled`](Self::scaled) has it.
    ///
    /// # Errors
    /// If the operating system has not enough memory.
    ///
    /// # Panics
    /// If `maxval == 0`.
    pub fn try_scaled(&self, maxval: u16) -> Result<Self, TryReserveError> {
        assert!(maxval >= 1, "maxval must be at least 1");
        let (from, to) = (u32::from(self.maxval), u32::from(maxval));
        // One division per value and not per sample. 65535² + 65535/2 still fits in 32 bits.
        let table: Vec<u16> = (0..=from)
            .map(|v| u16::try_from((v * to + from / 2) / from).expect("v <= from, so the result is at most `to`"))
            .collect();
        let look_up = |sample: u16| table[usize::from(sample)];
        let samples = match (&self.samples, maxval <= 255) {
            (Samples::Eight(s), true) => Samples::Eight(try_map(s, |v| low_byte(look_up(v.into())))?),
            (Samples::Eight(s), false) => Samples::Sixteen(try_map(s, |v| look_up(v.into()))?),
            (Samples::Sixteen(s), true) => Samples::Eight(try_map(s, |v| low_byte(look_up(v)))?),
            (Samples::Sixteen(s), false) => Samples::Sixteen(try_map(s, look_up)?),
        };
        Ok(Self { maxval, samples, ..*self })
    }

    /// Whether each pixel is stored as one sample.
    pub(crate) fn is_grey(&self) -> bool {
        self.channels == 1
    }

    pub(crate) fn raw(&self) -> &Samples {
        &self.samples
    }
}

fn try_map<A: Copy, B>(samples: &[A], map: impl Fn(A) -> B) -> Result<Vec<B>, TryReserveError> {
    let mut result = Vec::new();
    result.try_reserve_exact(samples.len())?;
    result.extend(samples.iter().map(|&sample| map(sample)));
    Ok(result)
}

/// The sample as a byte; the caller has checked that it is at most 255.
fn low_byte(sample: u16) -> u8 {
    debug_assert!(sample <= 255);
    (sample & 0xff) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_broken_invariant_is_refused() {
        assert!(Pixmap::new(1, 1, 255, vec![0, 0, 255]).is_ok());
        let length = |width, height, found| Err(PixmapError::Length { width, height, found });
        let above = |index, found, maxval| Err(PixmapError::SampleAboveMaxval { index, found, maxval });
        assert_eq!(Pixmap::new(0, 1, 255, vec![]), Err(PixmapError::Empty { width: 0, height: 1 }));
        assert_eq!(Pixmap::new(1, 0, 255, vec![]), Err(PixmapError::Empty { width: 1, height: 0 }));
        assert_eq!(Pixmap::new(1, 1, 0, vec![0, 0, 0]), Err(PixmapError::ZeroMaxval));
        assert_eq!(Pixmap::new(1, 1, 254, vec![0, 0, 255]), above(2, 255, 254));
        assert_eq!(Pixmap::new(1, 1, 65534, vec![0, 65535, 0]), above(1, 65535, 65534));
        assert_eq!(Pixmap::new(1, 1, 255, vec![0, 0]), length(1, 1, 2));
        assert_eq!(Pixmap::new(1, 1, 255, vec![0; 4]), length(1, 1, 4));
        assert_eq!(Pixmap::new(usize::MAX, 2, 255, vec![0; 6]), length(usize::MAX, 2, 6));
        assert_eq!(Pixmap::new(usize::MAX / 3 + 1, 1, 255, vec![0; 3]), length(usize::MAX / 3 + 1, 1, 3));
    }

    #[test]
    fn samples_come_back_at_both_widths() {
        for maxval in [1, 255, 256, 65535] {
            let samples = vec![0, 1, maxval, maxval, 0, 1];
            let pixmap = Pixmap::new(1, 2, maxval, samples.clone()).unwrap();
            assert_eq!(pixmap.to_samples(), samples);
            assert_eq!(pixmap.pixel(0, 1), [maxval, 0, 1]);
            assert_eq!(pixmap.into_samples(), samples);
        }
    }

    #[test]
    fn a_grey_picture_is_stored_once_and_equals_its_rgb() {
        for (maxval, samples) in [(255, Samples::Eight(vec![0, 7])), (65535, Samples::Sixteen(vec![0, 7]))] {
            let grey = Pixmap::from_checked(2, 1, maxval, samples.clone()).unwrap();
            assert!(grey.is_grey());
            assert_eq!(grey.pixel(1, 0), [7; 3]);
            assert_eq!(grey.to_samples(), [0, 0, 0, 7, 7, 7]);
            assert_eq!(grey.clone().into_samples(), [0, 0, 0, 7, 7, 7]);
            let colored = Pixmap::new(2, 1, maxval, vec![0, 0, 0, 7, 7, 7]).unwrap();
            assert!(!colored.is_grey());
            assert_eq!(grey, colored);
            assert_eq!(colored.scaled(maxval), grey.scaled(maxval));
            assert_ne!(grey, Pixmap::new(2, 1, maxval, vec![0, 0, 0, 7, 7, 8]).unwrap());
            assert_ne!(grey, Pixmap::new(1, 2, maxval, vec![0, 0, 0, 7, 7, 7]).unwrap());
            assert_eq!(grey.into_stored(), samples);
        }
        assert!(Pixmap::new(2, 1, 255, vec![0, 7]).is_err(), "RGB is asked for");
    }

    #[test]
    fn scaling_rounds_to_the_nearest_in_exact_arithmetic() {
        for (from, to) in [(1, 255), (7, 255), (255, 7), (255, 65535), (65535, 255), (1000, 999), (65535, 65534)] {
            let samples: Vec<u16> = (0..=from).flat_map(|v| [v; 3]).collect();
            let pixmap = Pixmap::new(usize::from(from) + 1, 1, from, samples).unwrap();
            let scaled = pixmap.scaled(to);
            assert_eq!(scaled.maxval(), to);
            for v in 0..=from {
                let [found, _, _] = scaled.pixel(usize::from(v), 0);
                // |found - v to / from| <= 1/2, times 2 from.
                let off = 2 * (i64::from(found) * i64::from(from) - i64::from(v) * i64::from(to));
                assert!(off.abs() <= i64::from(from), "{v} of {from} became {found} of {to}");
            }
        }
    }

    #[test]
    #[should_panic(expected = "pixel (2, 0) of a 2 x 1 picture")]
    fn a_pixel_outside_panics_with_its_place() {
        let _ = Pixmap::new(2, 1, 255, vec![0; 6]).unwrap().pixel(2, 0);
    }
}
