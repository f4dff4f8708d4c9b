//! Writing PNG, through the `image` crate.

use std::io::{self, Write};

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder, ImageError};

use crate::pixmap::{Pixmap, Samples};

/// Writes an RGB picture of 8 bits where `maxval <= 255`, else of 16; samples are scaled if `maxval` is not 255 or 65535,
/// the two that a PNG can have.
///
/// # Errors
/// Whatever `out` reports, and a width or height of 2^31 or more.
///
/// ```
/// use rt_io::{Limits, Pixmap, decode_image, png};
/// let pixmap = Pixmap::new(1, 2, 255, vec![1, 2, 3, 4, 5, 6]).unwrap();
/// let mut bytes = Vec::new();
/// png::write(&pixmap, &mut bytes).unwrap();
/// assert_eq!(decode_image(&bytes, &Limits::default()).unwrap().pixmap, pixmap);
/// ```
pub fn write(pixmap: &Pixmap, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
    let size = |number: usize| {
        let fits = u32::try_from(number).ok().filter(|&number| number < 1 << 31);
        fits.ok_or_else(|| io::Error::other("a PNG has less than 2^31 columns and rows"))
    };
    let (width, height) = (size(pixmap.width())?, size(pixmap.height())?);
    let scaled;
    let pixmap = match (pixmap.raw(), pixmap.maxval()) {
        (_, 255 | 65535) => pixmap,
        (Samples::Eight(_), _) => {
            scaled = pixmap.scaled(255);
            &scaled
        }
        (Samples::Sixteen(_), _) => {
            scaled = pixmap.scaled(65535);
            &scaled
        }
    };
    let encoder = PngEncoder::new(out);
    let done = match pixmap.raw() {
        Samples::Eight(samples) => encoder.write_image(samples, width, height, ExtendedColorType::Rgb8),
        Samples::Sixteen(samples) => {
            let bytes: Vec<u8> = samples.iter().flat_map(|sample| sample.to_ne_bytes()).collect();
            encoder.write_image(&bytes, width, height, ExtendedColorType::Rgb16)
        }
    };
    done.map_err(|error| match error {
        ImageError::IoError(error) => error,
        other => io::Error::other(other),
    })
}
