//! Writing PNG, through the `png` crate; and reading back what was written with transparency.

use std::hint::black_box;
use std::io::{self, BufRead, Seek, Write};

use png::{BitDepth, ColorType, Compression, Decoder, Encoder, EncodingError, Filter};

use crate::limits::Limits;
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
    let size = sizes(pixmap.width(), pixmap.height())?;
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
    let color = if pixmap.is_grey() { ColorType::Grayscale } else { ColorType::Rgb };
    encode(size, color, depth, bytes, None, out)
}

/// A picture with transparency, as PNG has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rgba {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The largest sample: 255 or 65535.
    pub maxval: u16,
    /// Red, green, blue and alpha, row by row from the top; colours are not multiplied by alpha.
    pub samples: Vec<u16>,
}

/// Writes a picture with transparency, and a comment if there is one.
///
/// # Errors
/// As [`write()`]; samples that are not four for each pixel, or a comment beyond Latin-1.
///
/// ```
/// use rt_io::{Limits, png};
/// let picture = png::Rgba { width: 1, height: 2, maxval: 255, samples: vec![1, 2, 3, 255, 0, 0, 0, 0] };
/// let mut bytes = std::io::Cursor::new(Vec::new());
/// png::write_rgba(&picture, Some("half of it"), &mut bytes)?;
/// bytes.set_position(0);
/// assert_eq!(png::read_rgba(bytes, &Limits::default())?, (picture, vec!["half of it".to_owned()]));
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn write_rgba(picture: &Rgba, comment: Option<&str>, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
    let Rgba { width, height, maxval, samples } = picture;
    if width.checked_mul(*height).and_then(|pixels| pixels.checked_mul(4)) != Some(samples.len()) {
        return Err(io::Error::other("a pixel has four samples"));
    }
    let wide = *maxval > 255;
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(samples.len() << u32::from(wide))?;
    let depth = if wide {
        bytes.extend(samples.iter().flat_map(|sample| sample.to_be_bytes()));
        BitDepth::Sixteen
    } else {
        bytes.extend(samples.iter().map(|&sample| u8::try_from(sample).unwrap_or(u8::MAX)));
        BitDepth::Eight
    };
    encode(sizes(*width, *height)?, ColorType::Rgba, depth, &bytes, comment, out)
}

/// Reads a picture with transparency, and its comments. A PNG without alpha is refused, and one that is interlaced.
///
/// # Errors
/// What `source` or the decoder says, a size beyond the limits, or too little memory.
pub fn read_rgba(source: impl BufRead + Seek, limits: &Limits) -> io::Result<(Rgba, Vec<String>)> {
    let mut reader = Decoder::new(source).read_info()?;
    let info = reader.info();
    let (width, height, depth) = (info.width, info.height, info.bit_depth);
    if info.color_type != ColorType::Rgba || info.interlaced {
        return Err(io::Error::other("expected a PNG with transparency, not interlaced"));
    }
    if u64::from(width) * u64::from(height) > limits.max_pixels {
        return Err(io::Error::other(format!("more than {} pixels", limits.max_pixels)));
    }
    // Row by row, so that a file with a false size takes no more than its rows.
    let (mut samples, wide) = (Vec::new(), depth == BitDepth::Sixteen);
    while let Some(row) = reader.next_row()? {
        let row = row.data();
        samples.try_reserve(row.len())?;
        if wide {
            samples.extend(row.as_chunks().0.iter().map(|&pair| u16::from_be_bytes(pair)));
        } else {
            samples.extend(row.iter().map(|&byte| u16::from(byte)));
        }
    }
    reader.finish()?;
    let comments = reader.info().uncompressed_latin1_text.iter().map(|chunk| chunk.text.clone()).collect();
    let maxval = if wide { 65535 } else { 255 };
    Ok((Rgba { width: width as usize, height: height as usize, maxval, samples }, comments))
}

/// Width and height, if a PNG can have them.
fn sizes(width: usize, height: usize) -> io::Result<(u32, u32)> {
    let size = |number: usize| {
        let fits = u32::try_from(number).ok().filter(|&number| number < 1 << 31);
        fits.ok_or_else(|| io::Error::other("a PNG has less than 2^31 columns and rows"))
    };
    Ok((size(width)?, size(height)?))
}

fn encode(
    (width, height): (u32, u32),
    color: ColorType,
    depth: BitDepth,
    bytes: &[u8],
    comment: Option<&str>,
    out: &mut (impl Write + ?Sized),
) -> io::Result<()> {
    // The encoder gathers what it writes, at most a little more than the samples; the room is asked for, and given
    // back. Without the black box neither would happen.
    let mut gathered = Vec::<u8>::new();
    gathered.try_reserve_exact(bytes.len() + bytes.len() / 4 + SLACK)?;
    drop(black_box(gathered));

    let mut encoder = Encoder::new(out, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    encoder.set_compression(Compression::Fast);
    encoder.set_filter(Filter::Adaptive);
    let text = comment.map_or(Ok(()), |text| encoder.add_text_chunk("Comment".to_owned(), text.to_owned()));
    let written = text.and_then(|()| encoder.write_header()).and_then(|mut writer| writer.write_image_data(bytes));
    written.map_err(|error| match error {
        EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    })
}
