//! What a reader refuses to go beyond.

/// Limits of a reader. Besides these, memory stays in proportion to the bytes of the file.
///
/// A picture takes a byte a sample, or two where `maxval > 255`, and one sample a pixel if it is grey, else three.
/// While it is decoded there is besides it: for PPM nothing; for PNG a row, or if it is interlaced all its rows as they
/// are in the file; for TIFF its rows as they are in the file, and again if it is turned upright; for JPEG some rows,
/// and for a progressive one two bytes a sample of each component and once more the picture. Except for PPM the bytes
/// of the file are held as well, those of a TIFF with a palette twice, and those of a JPEG up to four times, with 18
/// bytes more for each restart marker. If the system does not have that much, there is an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The largest `width * height`. The default is 2^28: 0.8 GB at 8 bits, 1.6 GB at 16, a third of it if grey.
    pub max_pixels: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { max_pixels: 1 << 28 }
    }
}
