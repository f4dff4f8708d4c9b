//! How large a picture is, and the memory that it takes.

use super::outcome::DecodeError;
use crate::limits::Limits;

/// Bytes that a decoder may take besides samples: profiles, tables, rows.
pub(super) const SLACK: usize = 32 << 20;

/// The size of a picture that may be decoded, which gives room for it or an error that names it.
#[derive(Clone, Copy)]
pub(super) struct Dimensions {
    pub(super) width: u32,
    pub(super) height: u32,
}

impl Dimensions {
    /// Refuses a size that is too large for the caller or for the file.
    pub(super) fn check(
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
    pub(super) fn in_memory(&self) -> Result<(usize, usize), DecodeError> {
        let countable = u64::from(self.width) * u64::from(self.height) <= isize::MAX as u64 / 16;
        match (usize::try_from(self.width), usize::try_from(self.height)) {
            (Ok(columns), Ok(rows)) if countable => Ok((columns, rows)),
            _ => Err(self.out_of_memory(u64::MAX)),
        }
    }

    pub(super) fn out_of_memory(&self, bytes: u64) -> DecodeError {
        DecodeError::OutOfMemory { width: self.width, height: self.height, bytes }
    }

    /// An empty list with room for `length` items.
    pub(super) fn room<T>(&self, length: usize) -> Result<Vec<T>, DecodeError> {
        let mut list = Vec::new();
        match list.try_reserve_exact(length) {
            Ok(()) => Ok(list),
            Err(_) => Err(self.out_of_memory(length.saturating_mul(size_of::<T>()) as u64)),
        }
    }

    /// A list of `length` items, all the same.
    pub(super) fn filled<T: Clone>(&self, length: usize, item: T) -> Result<Vec<T>, DecodeError> {
        let mut list = self.room(length)?;
        list.resize(length, item);
        Ok(list)
    }
}
