//! Writing PNG, through the `png` crate.

use std::hint::black_box;
use std::io::{self, Write};

use png::{BitDepth, ColorType, Compression, Encoder, EncodingError, Filter};

use crate::pixmap::{Pixmap, Samples};

/// Bytes that the encoder takes besides: a table for matches, rows.
const SLACK: usize = 1 << 20;

/// Writes an RGB picture, grey if it was read from a grey file, of 8 bits where `maxval <= 255`, else of 16; samples
/// are scaled if `maxval` is not 255 or 65535, the two that a PNG can have.
///
/// # Errors
/// An error of `out`, a width or height of 2^31 or more, or too little memory: the output is buffered first.
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
    let mut pairs = Vec::new();
    let (depth, bytes): (_, &[u8]) = match pixmap.raw() {
        Samples::Eight(samples) => (BitDepth::Eight, samples),
        Samples::Sixteen(samples) => {
            pairs.try_reserve_exact(2 * samples.len())?;
            pairs.extend(samples.iter().flat_map(|sample| sample.to_be_bytes()));
            (BitDepth::Sixteen, &pairs)
        }
    };
    // The encoder gathers what it writes, at most a little more than the samples; the room is asked for, and given
    // back. Without the black box neither would happen.
    let mut gathered = Vec::<u8>::new();
    gathered.try_reserve_exact(bytes.len() + bytes.len() / 4 + SLACK)?;
    drop(black_box(gathered));

    let mut encoder = Encoder::new(out, width, height);
    encoder.set_color(if pixmap.is_grey() { ColorType::Grayscale } else { ColorType::Rgb });
    encoder.set_depth(depth);
    encoder.set_compression(Compression::Fast);
    encoder.set_filter(Filter::Adaptive);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(bytes));
    written.map_err(|error| match error {
        EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    })
}
