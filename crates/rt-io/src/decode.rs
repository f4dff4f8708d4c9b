//! Reading whatever picture a file holds, by its first bytes: PPM by our own codec, PNG and TIFF through the crates of
//! those names, JPEG through `zune-jpeg`.
//!
//! The size is known and judged before anything is allocated for it: against the caller's limit, against what a file of
//! that length can hold at all, and against the memory that there is. What a decoder would get wrong, or panic on, is
//! refused by its name before it sees it; a panic that is left becomes an error.
//!
//! Samples are those of the file. PNG and TIFF give the same as netpbm's `pngtopnm` and `tifftopnm`, scaled to 8 bits
//! where the file has fewer; JPEG is near to what libjpeg-turbo's `djpeg` gives: within 4 of 255, but for the last column
//! and row and pictures of at most four columns where chroma is halved (`jpeg.rs` has the measure). A palette is looked up,
//! alpha is dropped, colour profiles and gamma are ignored. A TIFF's orientation is obeyed.

mod fence;
mod jpeg;
mod png;
mod tiff;
mod tiff_directory;

use std::error::Error;
use std::fs::File;
use std::io::{self, Cursor, Read};
use std::path::{Path, PathBuf};

use crate::Limits;
use crate::pixmap::Pixmap;
use crate::ppm::{self, PpmError};
use fence::fenced;

/// A picture that was read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Decoded {
    /// Its samples; `maxval` is the file's own for PPM, else 255 or 65535.
    pub pixmap: Pixmap,
    /// Whether a sample was not opaque, so that dropping alpha lost something.
    pub transparent: bool,
}

/// Why the bytes are not a picture that can be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DecodeError {
    /// The first bytes belong to no format that is known.
    #[error("not an image: expected PPM, PGM, PNG, JPEG or TIFF")]
    Unknown,
    /// A format that is not read.
    #[error("{0} is not read; convert it to PNG or PPM first")]
    Format(&'static str),
    /// A kind of PNG, JPEG or TIFF that is not read.
    #[error("{format} with {what} is not read; convert it to PNG or PPM first")]
    Kind {
        /// `PNG`, `JPEG` or `TIFF`.
        format: &'static str,
        /// The part that is not read.
        what: String,
    },
    /// What the PPM codec found.
    #[error(transparent)]
    Ppm(#[from] PpmError),
    /// The bytes break the rules of their format, or end early.
    #[error("broken {format}")]
    Broken {
        /// `PNG`, `JPEG` or `TIFF`.
        format: &'static str,
        /// What the decoder says.
        source: Box<dyn Error + Send + Sync>,
    },
    /// The decoder panicked.
    #[error("the decoder of {format} failed ({message}); convert the picture to PNG or PPM first")]
    Panicked {
        /// `PNG`, `JPEG` or `TIFF`.
        format: &'static str,
        /// What it said.
        message: String,
    },
    /// The operating system has not enough memory.
    #[error("not enough memory for {width} x {height} pixels: {bytes} more bytes; scale the picture down first")]
    OutOfMemory {
        /// Number of columns.
        width: u32,
        /// Number of rows.
        height: u32,
        /// How many bytes could not be had at once.
        bytes: u64,
    },
    /// The file ends inside the picture.
    #[error("the {format} ends early")]
    Truncated {
        /// `PNG`, `JPEG` or `TIFF`.
        format: &'static str,
    },
    /// More pixels than [`Limits::max_pixels`].
    #[error("{width} x {height} pixels are more than the limit of {limit}")]
    TooManyPixels {
        /// Number of columns.
        width: u32,
        /// Number of rows.
        height: u32,
        /// The limit that the caller may raise.
        limit: u64,
    },
    /// More pixels than a file of this length can hold, however well it is compressed.
    #[error("{width} x {height} pixels are more than the {length} bytes of a {format} can hold")]
    TooDense {
        /// `PNG`, `JPEG` or `TIFF`.
        format: &'static str,
        /// Number of columns.
        width: u32,
        /// Number of rows.
        height: u32,
        /// Length of the file.
        length: u64,
    },
    /// A file that is larger than any picture within the limit.
    #[error("more than {limit} bytes, the most for a picture within the limit of pixels")]
    TooLong {
        /// The largest number of bytes.
        limit: u64,
    },
    /// Reading failed.
    #[error("reading failed")]
    Read(#[source] io::Error),
}

impl DecodeError {
    fn broken(format: &'static str, source: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        Self::Broken { format, source: source.into() }
    }
}

/// [`DecodeError`] with the file that it is about.
#[derive(Debug, thiserror::Error)]
#[error("cannot read the image {}", path.display())]
pub struct ReadImageError {
    /// The path as given.
    pub path: PathBuf,
    /// What is wrong.
    pub source: DecodeError,
}

/// Reads the picture in the file at `path`, whatever the file is called.
///
/// # Errors
/// [`ReadImageError`] names the path; its source names the cause.
pub fn read_image(path: &Path, limits: &Limits) -> Result<Decoded, ReadImageError> {
    read_file(path, limits).map_err(|source| ReadImageError { path: path.to_path_buf(), source })
}

fn read_file(path: &Path, limits: &Limits) -> Result<Decoded, DecodeError> {
    let mut file = File::open(path).map_err(DecodeError::Read)?;
    let metadata = file.metadata().map_err(DecodeError::Read)?;
    // A pipe and the like tell no length.
    let length = Some(metadata.len()).filter(|&length| metadata.is_file() && length > 0);
    let mut head = Vec::new();
    file.by_ref().take(HEAD).read_to_end(&mut head).map_err(DecodeError::Read)?;
    let reader = Cursor::new(head.clone()).chain(file);
    if sniff(&head)? == Format::Ppm {
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
        Format::Png => ("PNG", fenced(|| png::decode(bytes, limits))),
        Format::Jpeg => ("JPEG", fenced(|| jpeg::decode(bytes, limits))),
        Format::Tiff => ("TIFF", fenced(|| tiff::decode(bytes, limits))),
        Format::Ppm => return Ok(Decoded { pixmap: ppm::read_bytes(bytes, limits)?, transparent: false }),
    };
    decoded.unwrap_or_else(|message| Err(DecodeError::Panicked { format, message }))
}

/// Bytes that tell every format.
const HEAD: u64 = 16;

/// More bytes than any sensible file with a picture within the limit: 8 a pixel, and room for what is no pixel.
fn longest(limits: &Limits) -> u64 {
    limits.max_pixels.saturating_mul(8).saturating_add(SLACK as u64)
}

/// Bytes that a decoder may take besides samples: profiles, tables, rows.
const SLACK: usize = 32 << 20;

/// A format that is read.
#[derive(Clone, Copy, PartialEq)]
enum Format {
    Ppm,
    Png,
    Jpeg,
    Tiff,
}

fn sniff(head: &[u8]) -> Result<Format, DecodeError> {
    let name = match head {
        [] => return Err(PpmError::Magic { found: Vec::new() }.into()),
        [b'P', b'1'..=b'7', ..] => return Ok(Format::Ppm),
        [0x89, b'P', b'N', b'G', ..] => return Ok(Format::Png),
        [0xff, 0xd8, 0xff, ..] => return Ok(Format::Jpeg),
        // 43 instead of 42: BigTIFF, which has its own error.
        [b'I', b'I', 42 | 43, 0, ..] | [b'M', b'M', 0, 42 | 43, ..] => return Ok(Format::Tiff),
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

/// The size of a picture that may be decoded, which gives room for it or an error that names it.
#[derive(Clone, Copy)]
struct Size {
    width: u32,
    height: u32,
}

impl Size {
    /// Refuses a size that is too large for the caller or for the file.
    fn check(
        format: &'static str,
        width: u32,
        height: u32,
        bytes: &[u8],
        pixels_per_byte: u64,
        limits: &Limits,
    ) -> Result<Self, DecodeError> {
        let pixels = u64::from(width) * u64::from(height);
        if pixels > limits.max_pixels {
            return Err(DecodeError::TooManyPixels { width, height, limit: limits.max_pixels });
        }
        let length = bytes.len() as u64;
        if pixels > length.saturating_mul(pixels_per_byte) {
            return Err(DecodeError::TooDense { format, width, height, length });
        }
        Ok(Self { width, height })
    }

    /// Columns and rows, if the bytes of such a picture can be counted.
    fn in_memory(&self) -> Result<(usize, usize), DecodeError> {
        let countable = u64::from(self.width) * u64::from(self.height) <= isize::MAX as u64 / 16;
        match (usize::try_from(self.width), usize::try_from(self.height)) {
            (Ok(columns), Ok(rows)) if countable => Ok((columns, rows)),
            _ => Err(self.out_of_memory(u64::MAX)),
        }
    }

    fn out_of_memory(&self, bytes: u64) -> DecodeError {
        DecodeError::OutOfMemory { width: self.width, height: self.height, bytes }
    }

    /// An empty list with room for `length` items.
    fn room<T>(&self, length: usize) -> Result<Vec<T>, DecodeError> {
        let mut list = Vec::new();
        match list.try_reserve_exact(length) {
            Ok(()) => Ok(list),
            Err(_) => Err(self.out_of_memory(length.saturating_mul(size_of::<T>()) as u64)),
        }
    }

    /// A list of `length` items, all the same.
    fn filled<T: Clone>(&self, length: usize, item: T) -> Result<Vec<T>, DecodeError> {
        let mut list = self.room(length)?;
        list.resize(length, item);
        Ok(list)
    }
}
