//! PNG: every colour type, depth and interlacing, through the `png` crate, row by row, so that alpha and the second
//! copy that some depths need never take the memory of a whole picture. All checksums are checked.

use std::io::{self, Cursor};

use png::{BitDepth, ColorType, DecodeOptions, Decoder, DecodingError, Limits as PngLimits, Reader, Transformations};

use super::dimensions::{Dimensions, SLACK};
use super::outcome::{DecodeError, Decoded};
use crate::limits::Limits;
use crate::pixmap::{Pixmap, Samples};

pub(super) fn decode(bytes: &[u8], limits: &Limits) -> Result<Decoded, DecodeError> {
    // The signature, the length and name of the first chunk, width, height.
    let number = |at: usize| bytes.get(at..).and_then(<[u8]>::first_chunk).map(|&four| u32::from_be_bytes(four));
    let (Some(width), Some(height)) = (number(16), number(20)) else {
        return Err(DecodeError::Truncated { format: "PNG" });
    };
    // Deflate: a bit for at most 258 / 2 bytes, each of eight one-bit pixels.
    let size = Dimensions::check("PNG", width, height, bytes, 8 * 8 * 258 / 2, limits)?;

    let mut reader = reader(bytes, width)?;
    let (color, depth) = reader.output_color_type();
    let channels = color.samples();
    let kept = match color {
        ColorType::Grayscale | ColorType::GrayscaleAlpha => 1,
        ColorType::Rgb | ColorType::Rgba => 3,
        ColorType::Indexed => return Err(DecodeError::broken("PNG", "a palette that was not looked up")),
    };
    let (columns, rows) = size.in_memory()?;

    // The seven passes of an interlaced picture come together in a whole one.
    let mut frame = Vec::new();
    let line = reader.output_line_size(width).ok_or_else(|| size.out_of_memory(u64::MAX))?;
    let interlaced = reader.info().interlaced;
    if interlaced {
        frame = size.filled(line.checked_mul(rows).ok_or_else(|| size.out_of_memory(u64::MAX))?, 0)?;
        reader.next_frame(&mut frame).map_err(error)?;
    }
    let mut samples = match depth {
        BitDepth::Sixteen => Samples::Sixteen(size.room(kept * columns * rows)?),
        _ => Samples::Eight(size.room(kept * columns * rows)?),
    };
    let mut transparent = false;
    for y in 0..rows {
        let next;
        let row = if interlaced {
            &frame[y * line..][..line]
        } else {
            next = reader.next_row().map_err(error)?.ok_or(DecodeError::Truncated { format: "PNG" })?;
            next.data()
        };
        transparent |= append(&mut samples, row, channels, kept);
    }
    // The rest of the file: the checksum of the samples, and the last chunk.
    reader.finish().map_err(error)?;
    let maxval = if depth == BitDepth::Sixteen { 65535 } else { 255 };
    let pixmap = Pixmap::from_checked(columns, rows, maxval, samples);
    let pixmap = pixmap.ok_or_else(|| DecodeError::broken("PNG", "rows of another length"))?;
    Ok(Decoded { pixmap, transparent })
}

/// Appends the first `kept` of every `channels` samples of a row; returns whether the sample after them, alpha, is ever
/// less than full.
fn append(samples: &mut Samples, row: &[u8], channels: usize, kept: usize) -> bool {
    let mut transparent = false;
    match samples {
        Samples::Eight(samples) if kept == channels => samples.extend_from_slice(row),
        Samples::Eight(samples) => {
            for pixel in row.chunks_exact(channels) {
                transparent |= pixel[kept] != u8::MAX;
                samples.extend_from_slice(&pixel[..kept]);
            }
        }
        Samples::Sixteen(samples) => {
            let (pairs, _) = row.as_chunks();
            let all = pairs.iter().map(|&pair| u16::from_be_bytes(pair));
            transparent = kept < channels && all.clone().skip(kept).step_by(channels).any(|alpha| alpha != u16::MAX);
            samples.extend(all.enumerate().filter(|(at, _)| at % channels < kept).map(|(_, sample)| sample));
        }
    }
    transparent
}

/// The decoder of a file, at its first row.
fn reader(bytes: &[u8], width: u32) -> Result<Reader<Cursor<&[u8]>>, DecodeError> {
    let mut options = DecodeOptions::default();
    options.set_ignore_checksums(false);
    options.set_ignore_text_chunk(true);
    options.set_ignore_iccp_chunk(true);
    let mut decoder = Decoder::new_with_options(Cursor::new(bytes), options);
    // A row, or what is in memory besides the picture.
    let most = usize::try_from(width).unwrap_or(usize::MAX).saturating_mul(16).saturating_add(SLACK);
    decoder.set_limits(PngLimits { bytes: most });
    // To whole bytes; a palette is looked up; a transparent colour becomes alpha.
    decoder.set_transformations(Transformations::EXPAND);
    let reader = decoder.read_info().map_err(error)?;
    match &reader.info().palette {
        // The decoder panics on the incomplete one.
        Some(palette) if !palette.len().is_multiple_of(3) => {
            let what = format!("a palette of {} bytes, which are no whole colours", palette.len());
            Err(DecodeError::broken("PNG", what))
        }
        _ => Ok(reader),
    }
}

fn error(error: DecodingError) -> DecodeError {
    match error {
        DecodingError::IoError(error) if error.kind() == io::ErrorKind::UnexpectedEof => {
            DecodeError::Truncated { format: "PNG" }
        }
        error => DecodeError::broken("PNG", error),
    }
}
