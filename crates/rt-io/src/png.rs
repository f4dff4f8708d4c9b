//! Writing PNG, through the `png` crate.

use std::io::{self, Write};

use png::{BitDepth, ColorType, Compression, Encoder, EncodingError, Filter};

use crate::pixmap::{Pixmap, Samples};

/// Bytes that the encoder takes besides: a table for matches, rows.
const SLACK: usize = 1 << 20;

/// Writes an RGB picture, grey if it was read from a grey file, of 8 bits where `maxval <= 255`, else of 16; samples are scaled if `maxval` is not 255 or 65535,
/// the two that a PNG can have.
///
/// # Errors
/// Whatever `out` reports, a width or height of 2^31 or more, and too little memory: what is written is gathered first.
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
            scaled = pixmap.try_scaled(255)?;
            &scaled
        }
        (Samples::Sixteen(_), _) => {
            scaled = pixmap.try_scaled(65535)?;
            &scaled
        }
    };
    // The encoder gathers what it writes, at most a little more than the samples; the room is asked for, and given back.
    let length = match pixmap.raw() {
        Samples::Eight(samples) => samples.len(),
        Samples::Sixteen(samples) => 2 * samples.len(),
    };
    Vec::<u8>::new().try_reserve_exact(length + length / 4 + SLACK)?;
    let mut encoder = Encoder::new(out, width, height);
    encoder.set_color(if pixmap.is_grey() { ColorType::Grayscale } else { ColorType::Rgb });
    encoder.set_compression(Compression::Fast);
    encoder.set_filter(Filter::Adaptive);
    match pixmap.raw() {
        Samples::Eight(samples) => {
            encoder.set_depth(BitDepth::Eight);
            encoder.write_header().and_then(|mut writer| writer.write_image_data(samples))
        }
        Samples::Sixteen(samples) => {
            encoder.set_depth(BitDepth::Sixteen);
            let mut bytes = Vec::new();
            bytes.try_reserve_exact(length)?;
            bytes.extend(samples.iter().flat_map(|sample| sample.to_be_bytes()));
            encoder.write_header().and_then(|mut writer| writer.write_image_data(&bytes))
        }
    }
    .map_err(|error| match error {
        EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    })
}
