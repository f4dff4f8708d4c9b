//! TIFF: the first picture of a file. The `tiff` crate undoes the compression of one strip or tile at a time; what its
//! samples mean, where they belong and how many of their bits count is decided here.
//!
//! What is read: grey (black or white is zero) of 1, 2, 4, 8 and 16 bits, palettes of up to 8, and RGB of 8 and 16
//! bits, also with one sample more; in strips or tiles, interleaved or in planes, of either byte order; not compressed
//! or by LZW, deflate, `PackBits` or fax group 4.

use std::io::{self, Cursor, Read, Seek, SeekFrom};

use tiff::TiffError;
use tiff::decoder::{Decoder, Limits as TiffLimits};

use super::dimensions::{Dimensions, SLACK};
use super::outcome::{DecodeError, Decoded};
use super::tiff_directory::{self as tag, Directory};
use crate::limits::Limits;
use crate::pixmap::{Pixmap, Samples};

/// What the samples of a picture mean.
enum Colors {
    BlackIsZero,
    WhiteIsZero,
    Rgb,
    /// Colours of 8 bits: all reds, all greens, all blues.
    Palette(Vec<u16>),
}

/// How the samples of a picture are stored.
struct SampleLayout {
    colors: Colors,
    bits: u16,
    /// Of a pixel.
    samples: usize,
    /// Whether the last of them is alpha.
    has_alpha: bool,
    planar: bool,
}

pub(super) fn decode(bytes: &[u8], limits: &Limits) -> Result<Decoded, DecodeError> {
    let refuse = |what: String| DecodeError::Kind { format: "TIFF", what };
    if matches!(bytes.get(..4), Some(b"II+\0" | b"MM\0+")) {
        return Err(refuse("64-bit offsets (BigTIFF)".to_string()));
    }
    let directory = Directory::new(bytes).ok_or(DecodeError::Truncated { format: "TIFF" })?;
    let layout = layout(&directory).map_err(refuse)?;
    let number = |tag, name: &str| {
        let number = directory.number(tag).filter(|&number| number > 0);
        number.ok_or_else(|| DecodeError::broken("TIFF", format!("no {name}")))
    };
    let (width, height) = (number(tag::IMAGE_WIDTH, "width")?, number(tag::IMAGE_LENGTH, "height")?);
    // LZW: twelve bits for at most 3837 bytes, and that only at the end of a table: under 1400 bytes a byte on average,
    // each of eight one-bit pixels. Fax coding can beat this on pages that are blank.
    let check = |width, height| Dimensions::check("TIFF", width, height, bytes, 8 * 1400, limits);
    let size = check(width, height)?;
    let (columns, rows) = size.in_memory()?;

    // As grey of so many samples, the decoder gives what is stored, as it is.
    let mut patches = vec![(tag::PHOTOMETRIC_INTERPRETATION, 1)];
    let tile = if directory.has(tag::TILE_OFFSETS) {
        let tile = (number(tag::TILE_WIDTH, "width of a tile")?, number(tag::TILE_LENGTH, "height of a tile")?);
        check(tile.0, tile.1)?;
        // The decoder fails on what fills up the last tiles of a row: it may find no end of LZW data there. So it is
        // told of whole tiles alone. (It panics on planes of tiles only if asked for the whole picture.)
        let whole = width.checked_next_multiple_of(tile.0);
        patches.push((tag::IMAGE_WIDTH, whole.ok_or_else(|| refuse("tiles that reach too far".to_string()))?));
        Some(tile)
    } else {
        None
    };
    let patches = directory.patches(&patches).ok_or_else(|| refuse("a tag of an unusual type".to_string()))?;
    let decoder = Decoder::new(Patched { file: Cursor::new(bytes), patches }).map_err(error)?;
    let (across, down) = tile.unwrap_or((width, decoder.chunk_dimensions().1.min(height)));
    let (across, down) = (usize::try_from(across), usize::try_from(down));
    let (Ok(across), Ok(down)) = (across, down) else { return Err(size.out_of_memory(u64::MAX)) };

    let (samples, transparent) = chunks(decoder, &layout, &size, (columns, rows), (across, down))?;
    let orientation = directory.number(tag::ORIENTATION).unwrap_or(1);
    let pixmap = upright(&size, samples, columns, rows, orientation)?;
    Ok(Decoded { pixmap, transparent })
}

/// Reads all strips or tiles, `across` columns and `down` rows each: the samples, and whether one was not opaque.
fn chunks(
    decoder: Decoder<Patched<'_>>,
    layout: &SampleLayout,
    size: &Dimensions,
    (columns, rows): (usize, usize),
    (across, down): (usize, usize),
) -> Result<(Samples, bool), DecodeError> {
    // One of each plane, packed as in the file.
    let (planes, interleaved) = if layout.planar { (layout.samples, 1) } else { (1, layout.samples) };
    let row_bits = across.checked_mul(interleaved * usize::from(layout.bits));
    let chunk_bytes = row_bits.and_then(|bits| bits.div_ceil(8).checked_mul(down));
    let chunk_bytes = chunk_bytes.ok_or_else(|| size.out_of_memory(u64::MAX))?;
    let mut packed = Vec::new();
    for _ in 0..planes {
        packed.push(size.filled::<u8>(chunk_bytes, 0)?);
    }
    let mut most = TiffLimits::default();
    most.decoding_buffer_size = chunk_bytes;
    most.intermediate_buffer_size = chunk_bytes.saturating_add(SLACK);
    most.ifd_value_size = SLACK;
    let mut decoder = decoder.with_limits(most);

    let channels = if matches!(layout.colors, Colors::BlackIsZero | Colors::WhiteIsZero) { 1 } else { 3 };
    let count = channels * columns * rows;
    let mut samples = match layout.bits {
        16 => Samples::Sixteen(size.filled(count, 0)?),
        _ => Samples::Eight(size.filled(count, 0)?),
    };
    let mut transparent = false;
    let mut unpacked = vec![Vec::new(); planes];
    let (wide, high) = (columns.div_ceil(across), rows.div_ceil(down));
    for chunk in 0..wide * high {
        let (left, top) = (chunk % wide * across, chunk / wide * down);
        for (plane, packed) in packed.iter_mut().enumerate() {
            let index = u32::try_from(plane * wide * high + chunk).map_err(|_| size.out_of_memory(u64::MAX))?;
            decoder.read_chunk_bytes(index, packed).map_err(error)?;
        }
        let row_bytes = chunk_bytes / down;
        for y in 0..down.min(rows - top) {
            for (packed, row) in packed.iter().zip(&mut unpacked) {
                unpack(&packed[y * row_bytes..][..row_bytes], layout.bits, row);
            }
            let at = channels * ((top + y) * columns + left);
            transparent |= put(&mut samples, at, layout, &unpacked, across.min(columns - left));
        }
    }
    Ok((samples, transparent))
}

/// Sets the samples from index `at` on to those of the first `count` pixels of a row, given by plane; returns whether
/// one of the pixels is not opaque.
fn put(samples: &mut Samples, at: usize, layout: &SampleLayout, row: &[Vec<u16>], count: usize) -> bool {
    let full = u16::try_from((1_u32 << layout.bits) - 1).unwrap_or(u16::MAX);
    // Full intensity of so few bits divides that of 8.
    let scale = if layout.bits < 8 { 255 / full } else { 1 };
    let mut transparent = false;
    for x in 0..count {
        let sample = |channel: usize| match row {
            [row] => row[layout.samples * x + channel],
            rows => rows[channel][x],
        };
        match &layout.colors {
            Colors::BlackIsZero => set(samples, at + x, [sample(0) * scale]),
            Colors::WhiteIsZero => set(samples, at + x, [(full - sample(0)) * scale]),
            Colors::Rgb => set(samples, at + 3 * x, [0, 1, 2].map(sample)),
            Colors::Palette(palette) => {
                let color = |channel: usize| palette[channel * (palette.len() / 3) + usize::from(sample(0))];
                set(samples, at + 3 * x, [0, 1, 2].map(color));
            }
        }
        transparent |= layout.has_alpha && sample(layout.samples - 1) != full;
    }
    transparent
}

/// The layout of a picture that is read, or the name of what is not. What a directory leaves out has the value that the
/// format gives it.
fn layout(directory: &Directory<'_>) -> Result<SampleLayout, String> {
    let first = |tag, default| match directory.number(tag) {
        None if directory.has(tag) => Err(format!("a tag {tag} of an unusual type")),
        number => Ok(number.unwrap_or(default)),
    };
    match first(tag::COMPRESSION, 1)? {
        // None, fax group 4, LZW, deflate (both numbers), PackBits.
        1 | 4 | 5 | 8 | 32946 | 32773 => {}
        2 | 3 => return Err("fax group 3 compression".to_string()),
        6 | 7 => return Err("JPEG compression".to_string()),
        other => return Err(format!("compression number {other}")),
    }
    if first(tag::FILL_ORDER, 1)? != 1 {
        return Err("its bits in reverse (FillOrder 2)".to_string());
    }
    match first(tag::SAMPLE_FORMAT, 1)? {
        1 => {}
        3 => return Err("floating-point samples".to_string()),
        _ => return Err("samples that are not unsigned integers".to_string()),
    }
    let (bits, samples) = (first(tag::BITS_PER_SAMPLE, 1)?, first(tag::SAMPLES_PER_PIXEL, 1)?);
    if first(tag::PREDICTOR, 1)? != 1 && bits < 8 {
        return Err(format!("a predictor of {bits}-bit samples"));
    }
    let colors = match (directory.number(tag::PHOTOMETRIC_INTERPRETATION), samples, bits) {
        (Some(0), 1, 1 | 2 | 4 | 8 | 16) | (Some(0), 2, 8 | 16) => Colors::WhiteIsZero,
        (Some(1), 1, 1 | 2 | 4 | 8 | 16) | (Some(1), 2, 8 | 16) => Colors::BlackIsZero,
        (Some(2), 3 | 4, 8 | 16) => Colors::Rgb,
        (Some(3), 1, 1 | 2 | 4 | 8) => Colors::Palette(palette(directory, 1 << bits)?),
        (Some(0 | 1), 1 | 2, _) => return Err(format!("{bits}-bit grey")),
        (Some(0 | 1), ..) => return Err(format!("grey of {samples} samples")),
        (Some(2), 3 | 4, _) => return Err(format!("{bits}-bit colours")),
        (Some(2), ..) => return Err(format!("colours of {samples} samples")),
        (Some(3), 1, _) => return Err(format!("a palette of {bits}-bit indices")),
        (Some(3), ..) => return Err(format!("a palette and {samples} samples")),
        (Some(4), ..) => return Err("a transparency mask".to_string()),
        (Some(5), ..) => return Err("CMYK colours".to_string()),
        (Some(6), ..) => return Err("YCbCr colours".to_string()),
        (Some(8..=10), ..) => return Err("Lab colours".to_string()),
        (Some(other), ..) => return Err(format!("photometric interpretation number {other}")),
        (None, ..) => return Err("no photometric interpretation".to_string()),
    };
    let bits = u16::try_from(bits).map_err(|_| format!("{bits}-bit samples"))?;
    // A sample more is alpha, as most readers have it, unless the file says that it is something else.
    let has_alpha = samples % 2 == 0 && first(tag::EXTRA_SAMPLES, 2)? != 0;
    let planar = samples > 1 && first(tag::PLANAR_CONFIGURATION, 1)? == 2;
    Ok(SampleLayout { colors, bits, samples: samples as usize, has_alpha, planar })
}

fn palette(directory: &Directory<'_>, colors: usize) -> Result<Vec<u16>, String> {
    let palette = directory.shorts(tag::COLOR_MAP).filter(|palette| palette.len() == 3 * colors);
    let palette = palette.ok_or_else(|| format!("a palette of other than {colors} colours"))?;
    // They have 16 bits; some writers fill the low eight alone.
    let shift = if palette.iter().any(|&sample| sample > 255) { 8 } else { 0 };
    Ok(palette.iter().map(|sample| sample >> shift).collect())
}

/// A file in which some bytes are others.
struct Patched<'a> {
    file: Cursor<&'a [u8]>,
    /// Index and value of each.
    patches: Vec<(usize, u8)>,
}

impl Read for Patched<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let start = usize::try_from(self.file.position()).unwrap_or(usize::MAX);
        let count = self.file.read(buffer)?;
        for &(at, byte) in &self.patches {
            if at >= start && at - start < count {
                buffer[at - start] = byte;
            }
        }
        Ok(count)
    }
}

impl Seek for Patched<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

/// Sets `samples` to those of a row, each of `bits`: 1, 2, 4, 8 or 16.
fn unpack(row: &[u8], bits: u16, samples: &mut Vec<u16>) {
    samples.clear();
    match bits {
        16 => samples.extend(row.as_chunks().0.iter().map(|&pair| u16::from_ne_bytes(pair))),
        8 => samples.extend(row.iter().map(|&byte| u16::from(byte))),
        _ => samples.extend(row.iter().flat_map(|&byte| {
            (1..=8 / bits).map(move |part| u16::from(byte) >> (8 - part * bits) & ((1 << bits) - 1))
        })),
    }
}

/// Sets the samples from index `at` on; those of eight bits are less than 256.
fn set<const N: usize>(samples: &mut Samples, at: usize, values: [u16; N]) {
    match samples {
        Samples::Eight(samples) => {
            samples[at..at + N].copy_from_slice(&values.map(|value| (value & 0xff) as u8));
        }
        Samples::Sixteen(samples) => samples[at..at + N].copy_from_slice(&values),
    }
}

/// A picture of the samples, turned as the tag says (TIFF 6.0, section 8); a number that it does not have turns
/// nothing.
fn upright(
    size: &Dimensions,
    samples: Samples,
    columns: usize,
    rows: usize,
    orientation: u32,
) -> Result<Pixmap, DecodeError> {
    let (width, height) = if (5..=8).contains(&orientation) { (rows, columns) } else { (columns, rows) };
    let samples = match samples {
        samples if !(2..=8).contains(&orientation) => samples,
        Samples::Eight(samples) => Samples::Eight(turned(size, &samples, columns, rows, orientation)?),
        Samples::Sixteen(samples) => Samples::Sixteen(turned(size, &samples, columns, rows, orientation)?),
    };
    let maxval = if matches!(samples, Samples::Eight(_)) { 255 } else { 65535 };
    let pixmap = Pixmap::from_checked(width, height, maxval, samples);
    pixmap.ok_or_else(|| DecodeError::broken("TIFF", "no pixels"))
}

fn turned<S: Copy>(
    size: &Dimensions,
    samples: &[S],
    columns: usize,
    rows: usize,
    orientation: u32,
) -> Result<Vec<S>, DecodeError> {
    let channels = samples.len() / (columns * rows);
    let (right, bottom) = (columns - 1, rows - 1);
    let (width, height) = if orientation >= 5 { (rows, columns) } else { (columns, rows) };
    let mut result = size.room(samples.len())?;
    for y in 0..height {
        for x in 0..width {
            let (x, y) = match orientation {
                2 => (right - x, y),
                3 => (right - x, bottom - y),
                4 => (x, bottom - y),
                5 => (y, x),
                6 => (y, bottom - x),
                7 => (right - y, bottom - x),
                _ => (right - y, x),
            };
            result.extend_from_slice(&samples[channels * (y * columns + x)..][..channels]);
        }
    }
    Ok(result)
}

fn error(error: TiffError) -> DecodeError {
    match error {
        TiffError::IoError(error) if error.kind() == io::ErrorKind::UnexpectedEof => {
            DecodeError::Truncated { format: "TIFF" }
        }
        TiffError::UnsupportedError(error) => DecodeError::Kind { format: "TIFF", what: error.to_string() },
        error => DecodeError::broken("TIFF", error),
    }
}
