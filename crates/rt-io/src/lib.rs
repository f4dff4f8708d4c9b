//! Reads and writes PPM; decodes PNG, JPEG and TIFF; saves atomically. Knows only pixels and files.
//!
//! Everything but PPM and saving is the feature `decode`, which is on by default; without it no other crate is needed.
//!
//! ```
//! use rt_io::{Limits, Pixmap, ppm, save_atomically};
//!
//! let pixmap = Pixmap::new(2, 1, 255, vec![255, 0, 0, 0, 0, 255]).unwrap();
//! let path = std::env::temp_dir().join("rt-io-example.ppm");
//! save_atomically(&path, |out| ppm::write(&pixmap, ppm::Encoding::Raw, out))?;
//!
//! let found = ppm::read(std::fs::File::open(&path)?, &Limits::default())?;
//! assert_eq!(found, pixmap);
//! # std::fs::remove_file(&path)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#[cfg(feature = "decode")]
mod decode;
mod limits;
mod pixmap;
#[cfg(feature = "decode")]
pub mod png;
pub mod ppm;
mod save;

#[cfg(feature = "decode")]
pub use decode::{DecodeError, Decoded, ReadImageError, decode_image, read_image};
pub use limits::Limits;
pub use pixmap::{Pixmap, PixmapError, Samples};
pub use save::{SaveError, save_atomically};
