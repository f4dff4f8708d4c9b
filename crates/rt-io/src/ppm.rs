//! The PPM family: reads P3 and P6, and P2 and P5 whose grey becomes RGB; writes P3 and P6.
//!
//! The format (netpbm's `ppm(5)`): a magic number, width, height and `maxval` in decimal, separated by white space and
//! `#` comments, one white-space byte, then the raster: bytes (`maxval < 256`) or big-endian pairs in a raw file,
//! decimal numbers in a plain one.

mod read;
mod write;

#[cfg(feature = "decode")]
pub(crate) use read::read_known;
pub use read::{Field, PpmError, read, read_bytes, read_with_comments};
pub use write::{Encoding, write, write_with_comment};
