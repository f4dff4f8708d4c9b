//! The tags of a TIFF's first picture: enough to name what is not read, before a decoder sees it.
//!
//! Layout (TIFF 6.0, section 2): `II` or `MM` for the byte order, 42, the offset of a directory: a count, and entries
//! of twelve bytes: tag, type, number of values, and the values themselves or, if they take more than four bytes, their
//! offset.

/// A directory whose entries all lie within the file.
pub(super) struct Directory<'a> {
    bytes: &'a [u8],
    big_endian: bool,
    /// Index of the first entry.
    start: usize,
    entries: usize,
}

pub(super) const IMAGE_WIDTH: u16 = 256;
pub(super) const IMAGE_LENGTH: u16 = 257;
pub(super) const BITS_PER_SAMPLE: u16 = 258;
pub(super) const COMPRESSION: u16 = 259;
pub(super) const PHOTOMETRIC_INTERPRETATION: u16 = 262;
pub(super) const FILL_ORDER: u16 = 266;
pub(super) const ORIENTATION: u16 = 274;
pub(super) const SAMPLES_PER_PIXEL: u16 = 277;
pub(super) const PLANAR_CONFIGURATION: u16 = 284;
pub(super) const PREDICTOR: u16 = 317;
pub(super) const COLOR_MAP: u16 = 320;
pub(super) const TILE_WIDTH: u16 = 322;
pub(super) const TILE_LENGTH: u16 = 323;
pub(super) const TILE_OFFSETS: u16 = 324;
pub(super) const EXTRA_SAMPLES: u16 = 338;
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

    /// Index of the tag's entry.
    fn entry(&self, tag: u16) -> Option<usize> {
        (0..self.entries).map(|index| self.start + 12 * index).find(|&entry| self.short(entry) == Some(tag))
    }

    /// Whether the tag is there.
    pub(super) fn has(&self, tag: u16) -> bool {
        self.entry(tag).is_some()
    }

    /// Index of the tag's first value, how many there are, and whether each takes four bytes and not two; `None` unless
    /// it is there, of 16-bit or 32-bit numbers, and lies within the file.
    fn values(&self, tag: u16) -> Option<(usize, usize, bool)> {
        let entry = self.entry(tag)?;
        let is_long = match self.short(entry + 2)? {
            3 => false,
            4 => true,
            _ => return None,
        };
        let count = usize::try_from(self.long(entry + 4)?).ok()?;
        let length = count.checked_mul(if is_long { 4 } else { 2 })?;
        let at = if length <= 4 { entry + 8 } else { usize::try_from(self.long(entry + 8)?).ok()? };
        (count > 0 && length.checked_add(at)? <= self.bytes.len()).then_some((at, count, is_long))
    }

    /// The values of a tag, `None` unless it is there and holds 16-bit numbers.
    pub(super) fn shorts(&self, tag: u16) -> Option<Vec<u16>> {
        let (at, count, is_long) = self.values(tag)?;
        if is_long { None } else { (0..count).map(|index| self.short(at + 2 * index)).collect() }
    }

    /// The first value of a tag, `None` unless it is there and holds 16-bit or 32-bit numbers.
    pub(super) fn number(&self, tag: u16) -> Option<u32> {
        let (at, _, is_long) = self.values(tag)?;
        if is_long { self.long(at) } else { self.short(at).map(u32::from) }
    }

    /// Index and value of the bytes that give tags another first value; `None` if one is not there or too small for it.
    pub(super) fn patches(&self, numbers: &[(u16, u32)]) -> Option<Vec<(usize, u8)>> {
        let mut patches = Vec::new();
        for &(tag, number) in numbers {
            let (at, _, is_long) = self.values(tag)?;
            let length = if is_long { 4 } else { 2 };
            if !is_long {
                u16::try_from(number).ok()?;
            }
            let bytes: Vec<u8> = number.to_le_bytes().into_iter().take(length).collect();
            patches.extend(
                (0..length).map(|index| (at + index, bytes[if self.big_endian { length - 1 - index } else { index }])),
            );
        }
        Some(patches)
    }
}
