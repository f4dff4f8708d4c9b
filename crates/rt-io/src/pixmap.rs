//! A picture in memory: RGB samples exactly as a file holds them, with the `maxval` that means full intensity.
//!
//! Samples stay raw. A picture whose `maxval` fits in a byte keeps one byte a sample, any other two; nobody outside
//! this crate sees the difference.

/// An RGB picture: `3 * width * height` samples, row 0 at the top, each in `0..=maxval`.
///
/// Invariant: `width >= 1`, `height >= 1`, `maxval >= 1`, no sample above `maxval`.
///
/// ```
/// use rt_io::Pixmap;
/// let pixmap = Pixmap::new(2, 1, 255, vec![255, 0, 0, 0, 0, 128]).unwrap();
/// assert_eq!(pixmap.pixel(1, 0), [0, 0, 128]);
/// assert_eq!(Pixmap::new(2, 1, 100, vec![255, 0, 0, 0, 0, 128]), None);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pixmap {
    width: usize,
    height: usize,
    maxval: u16,
    samples: Samples,
}

/// `Eight` exactly when `maxval <= 255`, so that equal pictures compare equal.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Samples {
    Eight(Vec<u8>),
    Sixteen(Vec<u16>),
}

impl Pixmap {
    /// A picture of the interleaved RGB `samples`, or `None` if they break the invariant.
    pub fn new(width: usize, height: usize, maxval: u16, samples: Vec<u16>) -> Option<Self> {
        if maxval == 0 || samples.iter().any(|&sample| sample > maxval) {
            return None;
        }
        let samples = match u8::try_from(maxval) {
            Ok(_) => Samples::Eight(samples.iter().map(|&sample| low_byte(sample)).collect()),
            Err(_) => Samples::Sixteen(samples),
        };
        Self::from_checked(width, height, maxval, samples)
    }

    /// A picture of samples that are known to be at most `maxval` and to have its width; checks the size alone.
    pub(crate) fn from_checked(width: usize, height: usize, maxval: u16, samples: Samples) -> Option<Self> {
        let expected = width.checked_mul(height)?.checked_mul(3)?;
        let found = match &samples {
            Samples::Eight(samples) => samples.len(),
            Samples::Sixteen(samples) => samples.len(),
        };
        debug_assert_eq!(maxval <= 255, matches!(samples, Samples::Eight(_)));
        (expected > 0 && found == expected).then_some(Self { width, height, maxval, samples })
    }

    /// Number of columns, at least 1.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Number of rows, at least 1.
    pub fn height(&self) -> usize {
        self.height
    }

    /// The sample value of full intensity, in `1..=65535`.
    pub fn maxval(&self) -> u16 {
        self.maxval
    }

    /// Red, green and blue at column `x` of row `y`; row 0 is the top.
    ///
    /// # Panics
    /// If `x >= width` or `y >= height`.
    pub fn pixel(&self, x: usize, y: usize) -> [u16; 3] {
        assert!(
            x < self.width && y < self.height,
            "pixel ({x}, {y}) of a {} x {} picture",
            self.width,
            self.height
        );
        let start = 3 * (y * self.width + x);
        match &self.samples {
            Samples::Eight(samples) => [0, 1, 2].map(|channel| u16::from(samples[start + channel])),
            Samples::Sixteen(samples) => [0, 1, 2].map(|channel| samples[start + channel]),
        }
    }

    /// All samples, interleaved red, green, blue, row by row from the top.
    pub fn to_samples(&self) -> Vec<u16> {
        match &self.samples {
            Samples::Eight(samples) => samples.iter().map(|&sample| u16::from(sample)).collect(),
            Samples::Sixteen(samples) => samples.clone(),
        }
    }

    /// All samples as [`to_samples`](Self::to_samples) gives them, without a copy where they are 16 bits wide already.
    pub fn into_samples(self) -> Vec<u16> {
        match self.samples {
            Samples::Sixteen(samples) => samples,
            Samples::Eight(_) => self.to_samples(),
        }
    }

    /// The same picture with another `maxval`; each sample `v` becomes the nearest to `v * to / from`.
    ///
    /// The rounding is exact, `(v * to + from / 2) / from` in integers, which is also the rule of netpbm's `pamdepth`.
    ///
    /// # Panics
    /// If `maxval == 0`.
    ///
    /// ```
    /// use rt_io::Pixmap;
    /// let pixmap = Pixmap::new(1, 1, 31, vec![0, 3, 31]).unwrap();
    /// assert_eq!(pixmap.scaled(255).pixel(0, 0), [0, 25, 255]);
    /// ```
    #[must_use]
    pub fn scaled(&self, maxval: u16) -> Self {
        assert!(maxval >= 1, "maxval must be at least 1");
        if maxval == self.maxval {
            return self.clone();
        }
        let (from, to) = (u32::from(self.maxval), u32::from(maxval));
        // One division per value and not per sample. 65535² + 65535/2 still fits in 32 bits.
        let table: Vec<u16> = (0..=from)
            .map(|v| {
                u16::try_from((v * to + from / 2) / from).expect("v <= from, so the result is at most `to`")
            })
            .collect();
        let look_up = |sample: u16| table[usize::from(sample)];
        let samples = match (&self.samples, maxval <= 255) {
            (Samples::Eight(s), true) => {
                Samples::Eight(s.iter().map(|&v| low_byte(look_up(v.into()))).collect())
            }
            (Samples::Eight(s), false) => Samples::Sixteen(s.iter().map(|&v| look_up(v.into())).collect()),
            (Samples::Sixteen(s), true) => Samples::Eight(s.iter().map(|&v| low_byte(look_up(v))).collect()),
            (Samples::Sixteen(s), false) => Samples::Sixteen(s.iter().map(|&v| look_up(v)).collect()),
        };
        Self { maxval, samples, ..*self }
    }

    pub(crate) fn raw(&self) -> &Samples {
        &self.samples
    }
}

/// The sample as a byte; the caller has seen that it is at most 255.
fn low_byte(sample: u16) -> u8 {
    debug_assert!(sample <= 255);
    (sample & 0xff) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_broken_invariant_is_refused() {
        assert!(Pixmap::new(1, 1, 255, vec![0, 0, 255]).is_some());
        assert_eq!(Pixmap::new(0, 1, 255, vec![]), None);
        assert_eq!(Pixmap::new(1, 0, 255, vec![]), None);
        assert_eq!(Pixmap::new(1, 1, 0, vec![0, 0, 0]), None);
        assert_eq!(Pixmap::new(1, 1, 254, vec![0, 0, 255]), None);
        assert_eq!(Pixmap::new(1, 1, 65534, vec![0, 0, 65535]), None);
        assert_eq!(Pixmap::new(1, 1, 255, vec![0, 0]), None);
        assert_eq!(Pixmap::new(1, 1, 255, vec![0; 4]), None);
        assert_eq!(Pixmap::new(usize::MAX, 2, 255, vec![0; 6]), None);
        assert_eq!(Pixmap::new(usize::MAX / 3 + 1, 1, 255, vec![0; 3]), None);
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
    fn scaling_rounds_to_the_nearest_in_exact_arithmetic() {
        for (from, to) in
            [(1, 255), (7, 255), (255, 7), (255, 65535), (65535, 255), (1000, 999), (65535, 65534)]
        {
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
        Pixmap::new(2, 1, 255, vec![0; 6]).unwrap().pixel(2, 0);
    }
}
