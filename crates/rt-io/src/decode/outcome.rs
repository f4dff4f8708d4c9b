//! What decoding gives: a picture, or the reason why there is none.

use std::error::Error;
use std::fmt;
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
#[derive(Debug)]
#[expect(missing_docs, reason = "the messages say what the fields are")]
#[non_exhaustive]
pub enum DecodeError {
    /// The first bytes belong to no format that is known.
    Unknown,
    /// A format that is not read.
    Format(&'static str),
    /// A kind of PNG, JPEG or TIFF that is not read.
    Kind { format: &'static str, what: String },
    /// What the PPM codec found.
    Ppm(PpmError),
    /// The bytes break the rules of their format, or end early.
    Broken { format: &'static str, source: Box<dyn Error + Send + Sync> },
    /// The decoder panicked.
    Panicked { format: &'static str, message: String },
    /// The operating system has not enough memory.
    OutOfMemory { width: u32, height: u32, bytes: u64 },
    /// The file ends inside the picture.
    Truncated { format: &'static str },
    /// More pixels than [`Limits::max_pixels`](crate::limits::Limits::max_pixels).
    TooManyPixels { width: u32, height: u32, limit: u64 },
    /// More pixels than a file of this length can hold, however well it is compressed.
    TooDense { format: &'static str, width: u32, height: u32, length: u64 },
    /// A file that is larger than any picture within the limit.
    TooLong { limit: u64 },
    /// Reading failed.
    Read(io::Error),
}

impl fmt::Display for DecodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown => f.write_str("not an image: expected PPM, PGM, PNG, JPEG or TIFF"),
            Self::Format(name) => write!(f, "{name} is not read; convert it to PNG or PPM first"),
            Self::Kind { format, what } => {
                write!(f, "{format} with {what} is not read; convert it to PNG or PPM first")
            }
            Self::Ppm(error) => error.fmt(f),
            Self::Broken { format, .. } => write!(f, "broken {format}"),
            Self::Panicked { format, message } => {
                write!(f, "the decoder of {format} failed ({message}); convert the picture to PNG or PPM first")
            }
            Self::OutOfMemory { width, height, bytes } => write!(
                f,
                "not enough memory for {width} x {height} pixels: {bytes} more bytes; scale the picture down first"
            ),
            Self::Truncated { format } => write!(f, "the {format} ends early"),
            Self::TooManyPixels { width, height, limit } => {
                write!(f, "{width} x {height} pixels are more than the limit of {limit}")
            }
            Self::TooDense { format, width, height, length } => {
                write!(f, "{width} x {height} pixels are more than the {length} bytes of a {format} can hold")
            }
            Self::TooLong { limit } => {
                write!(f, "more than {limit} bytes, the most for a picture within the limit of pixels")
            }
            Self::Read(_) => f.write_str("reading failed"),
        }
    }
}

impl Error for DecodeError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            // Its message is this one's.
            Self::Ppm(error) => error.source(),
            Self::Broken { source, .. } => Some(&**source),
            Self::Read(source) => Some(source),
            _ => None,
        }
    }
}

impl From<PpmError> for DecodeError {
    fn from(error: PpmError) -> Self {
        Self::Ppm(error)
    }
}

impl DecodeError {
    pub(super) fn broken(format: &'static str, source: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        Self::Broken { format, source: source.into() }
    }
}

/// [`DecodeError`] with the file that it is about.
#[derive(Debug)]
pub struct ReadImageError {
    /// The path as given.
    pub path: PathBuf,
    /// What is wrong.
    pub source: DecodeError,
}

impl fmt::Display for ReadImageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "cannot read the image {}", self.path.display())
    }
}

impl Error for ReadImageError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        Some(&self.source)
    }
}
