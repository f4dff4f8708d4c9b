//! The tags of a TIFF's first picture: enough to name what is not read, before a decoder sees it.
//!
//! Layout (TIFF 6.0, section 2): `II` or `MM` for the byte order, 42, the offset of a directory: a count, and entries of
//! twelve bytes: tag, type, number of values, and the values themselves or, if they take more than four bytes, their
//! offset.

/// A directory whose entries all lie within the file.
pub(super) struct Directory<'a> {
    bytes: &'a [u8],
    big_endian: bool,
    /// Index of the first entry.
    start: usize,
    entries: usize,
}

pub(super) const BITS_PER_SAMPLE: u16 = 258;
pub(super) const COMPRESSION: u16 = 259;
pub(super) const PHOTOMETRIC_INTERPRETATION: u16 = 262;
pub(super) const SAMPLES_PER_PIXEL: u16 = 277;
pub(super) const COLOR_MAP: u16 = 320;
pub(super) const SAMPLE_FORMAT: u16 = 339;

impl<'a> Directory<'a> {
    /// The first directory, or `None` if the file ends before or in it.
    pub(super) fn new(bytes: &'a [u8]) -> Option<Self> {
        let big_endian = bytes.starts_with(b"MM");
        let mut directory = Self { bytes, big_endian, start: 0, entries: 0 };
        let offset = usize::try_from(directory.long(4)?).ok()?;
        directory.entries = directory.short(offset)?.into();
        directory.start = offset + 2;
        (directory.start + 12 * directory.entries <= bytes.len()).then_some(directory)
    }

    fn short(&self, at: usize) -> Option<u16> {
        let pair = *self.bytes.get(at..)?.first_chunk()?;
        Some(if self.big_endian { u16::from_be_bytes(pair) } else { u16::from_le_bytes(pair) })
    }

    fn long(&self, at: usize) -> Option<u32> {
        let four = *self.bytes.get(at..)?.first_chunk()?;
        Some(if self.big_endian { u32::from_be_bytes(four) } else { u32::from_le_bytes(four) })
    }

    /// Index of the tag's first value, whose type is 16-bit numbers, and how many there are.
    fn shorts_at(&self, tag: u16) -> Option<(usize, usize)> {
        let mut entries = (0..self.entries).map(|index| self.start + 12 * index);
        let entry = entries.find(|&entry| self.short(entry) == Some(tag))?;
        let count = usize::try_from(self.long(entry + 4)?).ok()?;
        let at = if count <= 2 { entry + 8 } else { usize::try_from(self.long(entry + 8)?).ok()? };
        (self.short(entry + 2)? == 3 && count.checked_mul(2)?.checked_add(at)? <= self.bytes.len())
            .then_some((at, count))
    }

    /// The values of a tag, `None` unless it is there and holds 16-bit numbers, as each of those above does.
    pub(super) fn shorts(&self, tag: u16) -> Option<Vec<u16>> {
        let (at, count) = self.shorts_at(tag)?;
        (0..count).map(|index| self.short(at + 2 * index)).collect()
    }

    /// The file with the tag's first value changed.
    pub(super) fn with(&self, tag: u16, value: u16) -> Option<Vec<u8>> {
        let (at, _) = self.shorts_at(tag)?;
        let mut bytes = self.bytes.to_vec();
        let value = if self.big_endian { value.to_be_bytes() } else { value.to_le_bytes() };
        bytes.get_mut(at..at + 2)?.copy_from_slice(&value);
        Some(bytes)
    }
}
