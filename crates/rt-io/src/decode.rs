//! Reads the picture in a file, by its first bytes: PPM by our own codec, PNG and TIFF through the crates of
//! those names, JPEG through `zune-jpeg`.
//!
//! The size is checked before anything is allocated for it: against the caller's limit, against what a file of
//! that length can hold at all, and against the memory that there is. What a decoder would get wrong, or panic on, is
//! refused by its name before it sees it; a panic that is left becomes an error.
//!
//! Samples are those of the file. PNG and TIFF give the same as netpbm's `pngtopnm` and `tifftopnm`, scaled to 8 bits
//! where the file has fewer; JPEG is near to what libjpeg-turbo's `djpeg` gives: within 4 of 255, except for the last
//! column and row and pictures of at most four columns where chroma is halved (`jpeg.rs` has the measure). A palette is
//! looked up, alpha is dropped, colour profiles and gamma are ignored. A TIFF's orientation is obeyed.

mod dimensions;
mod fence;
mod jpeg;
mod outcome;
mod png;
mod tiff;
mod tiff_directory;

use std::fs::File;
use std::io::{Cursor, Read};
use std::path::Path;

use crate::limits::Limits;
use crate::ppm::{self, PpmError};
use dimensions::SLACK;
use fence::fenced;
pub use outcome::{DecodeError, Decoded, ReadImageError};

/// Reads the picture in the file at `path`, whatever its name.
///
/// # Errors
/// [`ReadImageError`] names the path; its source names the cause.
pub fn read_image(path: &Path, limits: &Limits) -> Result<Decoded, ReadImageError> {
    read_file(path, limits).map_err(|source| ReadImageError { path: path.to_path_buf(), source })
}

fn read_file(path: &Path, limits: &Limits) -> Result<Decoded, DecodeError> {
    let mut file = File::open(path).map_err(DecodeError::Read)?;
    let metadata = file.metadata().map_err(DecodeError::Read)?;
    // A pipe has no known length.
    let length = Some(metadata.len()).filter(|&length| metadata.is_file() && length > 0);
    let mut head = Vec::new();
    file.by_ref().take(HEAD).read_to_end(&mut head).map_err(DecodeError::Read)?;
    let reader = Cursor::new(head.clone()).chain(file);
    if sniff(&head)? == ImageKind::Ppm {
        return Ok(Decoded { pixmap: ppm::read_known(reader, length, limits)?, transparent: false });
    }

    // The decoders jump about in their input, and it is seldom larger than the picture.
    let most = longest(limits);
    let mut bytes = Vec::new();
    if let Some(length) = length.filter(|&length| length <= most) {
        // One byte more lets the reader see the end without growing.
        let reserved = bytes.try_reserve_exact(usize::try_from(length).unwrap_or(usize::MAX).saturating_add(1));
        reserved.map_err(|error| DecodeError::Read(error.into()))?;
    }
    reader.take(most.saturating_add(1)).read_to_end(&mut bytes).map_err(DecodeError::Read)?;
    if bytes.len() as u64 > most {
        return Err(DecodeError::TooLong { limit: most });
    }
    decode_image(&bytes, limits)
}

/// Reads the picture that `bytes` hold.
///
/// # Errors
/// [`DecodeError`] says what is wrong, and where if that is known.
pub fn decode_image(bytes: &[u8], limits: &Limits) -> Result<Decoded, DecodeError> {
    let (format, decoded) = match sniff(bytes)? {
        ImageKind::Png => ("PNG", fenced(|| png::decode(bytes, limits))),
        ImageKind::Jpeg => ("JPEG", fenced(|| jpeg::decode(bytes, limits))),
        ImageKind::Tiff => ("TIFF", fenced(|| tiff::decode(bytes, limits))),
        ImageKind::Ppm => return Ok(Decoded { pixmap: ppm::read_bytes(bytes, limits)?, transparent: false }),
    };
    decoded.unwrap_or_else(|message| Err(DecodeError::Panicked { format, message }))
}

/// Bytes that identify every format.
const HEAD: u64 = 16;

/// More bytes than any sensible file with a picture within the limit: 8 a pixel, and room for metadata.
fn longest(limits: &Limits) -> u64 {
    limits.max_pixels.saturating_mul(8).saturating_add(SLACK as u64)
}

/// A format that is read.
#[derive(Clone, Copy, PartialEq)]
enum ImageKind {
    Ppm,
    Png,
    Jpeg,
    Tiff,
}

fn sniff(head: &[u8]) -> Result<ImageKind, DecodeError> {
    let name = match head {
        [] => return Err(PpmError::Magic { found: Vec::new() }.into()),
        [b'P', b'1'..=b'7', ..] => return Ok(ImageKind::Ppm),
        [0x89, b'P', b'N', b'G', ..] => return Ok(ImageKind::Png),
        [0xff, 0xd8, 0xff, ..] => return Ok(ImageKind::Jpeg),
        // 43 instead of 42: BigTIFF, which has its own error.
        [b'I', b'I', 42 | 43, 0, ..] | [b'M', b'M', 0, 42 | 43, ..] => return Ok(ImageKind::Tiff),
        [b'G', b'I', b'F', b'8', ..] => "GIF",
        [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] => "WebP",
        [b'B', b'M', ..] => "BMP",
        [_, _, _, _, b'f', b't', b'y', b'p', b'a', b'v', b'i', b'f' | b's', ..] => "AVIF",
        [_, _, _, _, b'f', b't', b'y', b'p', b'h', b'e', b'i' | b'v', ..] => "HEIC",
        [0xff, 0x0a, ..] | [0, 0, 0, 12, b'J', b'X', b'L', b' ', ..] => "JPEG XL",
        [0, 0, 0, 12, b'j', b'P', b' ', b' ', ..] | [0xff, 0x4f, 0xff, 0x51, ..] => "JPEG 2000",
        [0x76, 0x2f, 0x31, 0x01, ..] => "OpenEXR",
        [b'#', b'?', b'R', b'A', b'D', ..] => "Radiance HDR",
        [b'q', b'o', b'i', b'f', ..] => "QOI",
        [b'D', b'D', b'S', b' ', ..] => "DDS",
        [0, 0, 1, 0, ..] => "ICO",
        [b'f', b'a', b'r', b'b', b'f', b'e', b'l', b'd', ..] => "farbfeld",
        _ => return Err(DecodeError::Unknown),
    };
    Err(DecodeError::Format(name))
}
