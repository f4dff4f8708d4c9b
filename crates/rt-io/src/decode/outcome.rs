//! What decoding gives: a picture, or the reason why there is none.

use std::error::Error;
use std::io;
use std::path::PathBuf;

use crate::pixmap::Pixmap;
use crate::ppm::PpmError;

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
#[expect(missing_docs, reason = "the messages say what the fields are")]
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
    Kind { format: &'static str, what: String },
    /// What the PPM codec found.
    #[error(transparent)]
    Ppm(#[from] PpmError),
    /// The bytes break the rules of their format, or end early.
    #[error("broken {format}")]
    Broken { format: &'static str, source: Box<dyn Error + Send + Sync> },
    /// The decoder panicked.
    #[error("the decoder of {format} failed ({message}); convert the picture to PNG or PPM first")]
    Panicked { format: &'static str, message: String },
    /// The operating system has not enough memory.
    #[error("not enough memory for {width} x {height} pixels: {bytes} more bytes; scale the picture down first")]
    OutOfMemory { width: u32, height: u32, bytes: u64 },
    /// The file ends inside the picture.
    #[error("the {format} ends early")]
    Truncated { format: &'static str },
    /// More pixels than [`Limits::max_pixels`](crate::limits::Limits::max_pixels).
    #[error("{width} x {height} pixels are more than the limit of {limit}")]
    TooManyPixels { width: u32, height: u32, limit: u64 },
    /// More pixels than a file of this length can hold, however well it is compressed.
    #[error("{width} x {height} pixels are more than the {length} bytes of a {format} can hold")]
    TooDense { format: &'static str, width: u32, height: u32, length: u64 },
    /// A file that is larger than any picture within the limit.
    #[error("more than {limit} bytes, the most for a picture within the limit of pixels")]
    TooLong { limit: u64 },
    /// Reading failed.
    #[error("reading failed")]
    Read(#[source] io::Error),
}

impl DecodeError {
    pub(super) fn broken(format: &'static str, source: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
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
