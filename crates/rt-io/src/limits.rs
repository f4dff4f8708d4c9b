//! What a reader refuses to go beyond.

/// Limits of a reader. Besides these, memory stays in proportion to the bytes that are there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The largest `width * height`. The default is 2^28: 0.8 GB at 8 bits, 1.6 GB at 16.
    pub max_pixels: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { max_pixels: 1 << 28 }
    }
}
