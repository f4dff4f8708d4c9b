//! Reading: every file that the format allows, a named error with its byte offset for every other, and memory in
//! proportion to the bytes of the file and not to the size in its header.
//!
//! Comments run from `#` to a line feed or carriage return, anywhere up to the byte that ends `maxval`, also touching a
//! number, and anywhere in a plain raster; the byte that ends one is white space. Exactly one white-space byte stands
//! between `maxval` and a raw raster. The first picture counts; bytes after it are ignored. Stricter than netpbm, which
//! takes `1.5` for two samples: a number ends at white space, a comment or the end of the file.

use std::error::Error;
use std::fmt;
use std::io::{self, Read};

use crate::limits::Limits;
use crate::pixmap::{Pixmap, Samples};

/// A number of the format, as error messages name it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Field {
    /// The first number of the header.
    Width,
    /// The second number of the header.
    Height,
    /// The third number of the header.
    Maxval,
    /// A number of a plain raster.
    Sample,
}

impl fmt::Display for Field {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Width => "the width",
            Self::Height => "the height",
            Self::Maxval => "maxval",
            Self::Sample => "a sample",
        })
    }
}

/// Why a file is not a picture. Each offset counts bytes from the start of the file, the first being 0.
#[derive(Debug)]
#[expect(missing_docs, reason = "the messages say what the fields are")]
#[non_exhaustive]
pub enum PpmError {
    /// The file does not begin with the magic number of a format that is read.
    Magic { found: Vec<u8> },
    /// A relative of PPM that is not read: P1, P4 (PBM), P7 (PAM).
    Relative { found: [u8; 2] },
    /// The file ends inside the header.
    HeaderEnds { offset: u64, field: Field },
    /// Something other than a decimal number: a sign, a letter, a control byte.
    NotANumber { offset: u64, field: Field, found: u8 },
    /// Something touches the end of a number: a decimal point, a comma, a letter.
    NotSeparated { offset: u64, after: &'static str, found: u8 },
    /// A number above 4294967295.
    NumberTooLarge { offset: u64, field: Field },
    /// A picture without pixels.
    ZeroSize { offset: u64, field: Field },
    /// A `maxval` of 0 or above 65535.
    Maxval { offset: u64, found: u32 },
    /// More pixels than [`Limits::max_pixels`].
    TooManyPixels { offset: u64, width: u32, height: u32, limit: u64 },
    /// A sample above `maxval`.
    SampleAboveMaxval { offset: u64, found: u32, maxval: u16 },
    /// The file ends inside the raster.
    RasterEnds { offset: u64, expected: u64, found: u64 },
    /// The operating system has not enough memory for a picture whose bytes are there.
    OutOfMemory { samples: u64 },
    /// Reading failed.
    Read { offset: u64, source: io::Error },
}

impl fmt::Display for PpmError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Magic { found } => {
                write!(f, "byte 0: expected P3 or P6 (PPM), P2 or P5 (PGM), found {}", magic(found))
            }
            Self::Relative { found } => {
                write!(f, "byte 0: {} is not read; convert it with netpbm: {}", magic(found), remedy(found))
            }
            Self::HeaderEnds { offset, field } => write!(f, "byte {offset}: the file ends before {field}"),
            Self::NotANumber { offset, field, found } => {
                write!(f, "byte {offset}: expected {field} in decimal digits, found {}", byte(*found))
            }
            Self::NotSeparated { offset, after, found } => {
                write!(f, "byte {offset}: expected white space after {after}, found {}", byte(*found))
            }
            Self::NumberTooLarge { offset, field } => write!(f, "byte {offset}: {field} must be at most 4294967295"),
            Self::ZeroSize { offset, field } => write!(f, "byte {offset}: {field} must be at least 1, found 0"),
            Self::Maxval { offset, found } => write!(f, "byte {offset}: maxval must be in 1..=65535, found {found}"),
            Self::TooManyPixels { offset, width, height, limit } => {
                write!(f, "byte {offset}: {width} x {height} pixels are more than the limit of {limit}")
            }
            Self::SampleAboveMaxval { offset, found, maxval } => {
                write!(f, "byte {offset}: a sample must be at most maxval = {maxval}, found {found}")
            }
            Self::RasterEnds { offset, expected, found } => {
                write!(f, "byte {offset}: the file ends inside the raster: expected {expected} samples, found {found}")
            }
            Self::OutOfMemory { samples } => {
                write!(f, "not enough memory for {samples} samples; scale the picture down first")
            }
            Self::Read { offset, .. } => write!(f, "byte {offset}: cannot read on"),
        }
    }
}

impl Error for PpmError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Read { source, .. } => Some(source),
            _ => None,
        }
    }
}

fn byte(found: u8) -> String {
    if found.is_ascii_graphic() { format!("`{}`", char::from(found)) } else { format!("byte {found:#04x}") }
}

fn magic(found: &[u8]) -> String {
    match found {
        [] => "an empty file".to_string(),
        _ if found.iter().all(u8::is_ascii_graphic) => format!("`{}`", String::from_utf8_lossy(found)),
        _ => format!("bytes {}", found.iter().map(|b| format!("{b:#04x}")).collect::<Vec<_>>().join(" ")),
    }
}

fn remedy(found: &[u8; 2]) -> &'static str {
    match found {
        b"P7" => "pamtopnm",
        _ => "pamdepth 255",
    }
}

/// Reads the picture at the start of a stream whose length is unknown, such as a pipe.
///
/// Memory grows with the bytes that arrive: at most 64 MiB more than the samples take, one byte each where `maxval <=
/// 255`, else two; grey samples count once. The reader needs no buffer of its own, and may be left anywhere after the
/// picture.
///
/// # Errors
/// [`PpmError`] says what is wrong and at which byte.
pub fn read(reader: impl Read, limits: &Limits) -> Result<Pixmap, PpmError> {
    read_known(reader, None, limits)
}

/// Reads as [`read`] does, and returns the comments of the header too, each without its `#` and one blank after it.
///
/// Bytes that are no UTF-8 are replaced; of more than 64 KiB of comments the rest is left out.
///
/// # Errors
/// As [`read`].
pub fn read_with_comments(reader: impl Read, limits: &Limits) -> Result<(Pixmap, Vec<String>), PpmError> {
    let mut source = Source::new(reader, None);
    let (pixmap, comments) = source.pixmap(limits)?;
    let comments = comments.split(|byte| matches!(byte, b'\n' | b'\r')).filter_map(|line| {
        let line = line.strip_prefix(b"#")?;
        Some(String::from_utf8_lossy(line.strip_prefix(b" ").unwrap_or(line)).into_owned())
    });
    Ok((pixmap, comments.collect()))
}

/// Reads the picture at the start of `bytes`.
///
/// # Errors
/// As [`read`]; a raster that cannot be whole is refused before anything is allocated for it.
///
/// ```
/// use rt_io::{Limits, ppm};
/// let pixmap = ppm::read_bytes(b"P2 # a grey pixel\n1 1 15 7", &Limits::default()).unwrap();
/// assert_eq!(pixmap.pixel(0, 0), [7, 7, 7]);
///
/// let error = ppm::read_bytes(b"P3 1 1 255 1 2 1.5", &Limits::default()).unwrap_err();
/// assert_eq!(error.to_string(), "byte 16: expected white space after a sample, found `.`");
/// ```
pub fn read_bytes(bytes: &[u8], limits: &Limits) -> Result<Pixmap, PpmError> {
    read_known(bytes, Some(bytes.len() as u64), limits)
}

/// Reads a picture from a reader that holds `length` bytes, if that is known. A wrong length costs time or memory, no
/// more: what arrives is what counts.
pub(crate) fn read_known(reader: impl Read, length: Option<u64>, limits: &Limits) -> Result<Pixmap, PpmError> {
    Ok(Source::new(reader, length).pixmap(limits)?.0)
}

/// Bytes read at a time; small enough to stay in the second-level cache.
const BUFFER: usize = 1 << 16;

/// Bytes of comments that are kept.
const MOST_COMMENTS: usize = 1 << 16;

/// Bytes by which a raster of unknown length grows: its old and its new place together stay within 64 MiB of it.
const GROWTH: usize = 1 << 24;

struct Header {
    plain: bool,
    channels: u64,
    width: u32,
    height: u32,
    maxval: u16,
}

impl Header {
    /// Number of samples in the file: `Source::header` has checked that this and three times this do not overflow.
    fn samples(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height) * self.channels
    }

    fn out_of_memory(&self) -> PpmError {
        PpmError::OutOfMemory { samples: self.samples() }
    }

    /// Makes room for the rest of the raster, of which at most `present` samples are there (`None`: unknown).
    fn make_room<S>(&self, samples: &mut Vec<S>, present: Option<u64>) -> Result<(), PpmError> {
        let missing = self.samples() - samples.len() as u64;
        let step = present.unwrap_or((GROWTH / size_of::<S>()) as u64);
        // At least one: a file can be longer than it was when its length was asked for.
        let step = usize::try_from(step.clamp(1, missing)).map_err(|_| self.out_of_memory())?;
        samples.try_reserve_exact(step).map_err(|_| self.out_of_memory())
    }
}

struct Decimal {
    offset: u64,
    value: u32,
}

/// A reader with a window on its next bytes, `buffer[start..end]`, that knows where it is.
struct Source<R> {
    reader: R,
    buffer: Vec<u8>,
    start: usize,
    end: usize,
    /// Offset in the file of `buffer[0]`.
    base: u64,
    /// Length of the file, if known.
    length: Option<u64>,
    /// Comments, each from its `#` to the byte that ends it.
    comments: Vec<u8>,
}

impl<R: Read> Source<R> {
    fn new(reader: R, length: Option<u64>) -> Self {
        Self { reader, buffer: vec![0; BUFFER], start: 0, end: 0, base: 0, length, comments: Vec::new() }
    }

    /// The picture, and the comments of its header.
    fn pixmap(&mut self, limits: &Limits) -> Result<(Pixmap, Vec<u8>), PpmError> {
        let header = self.header(limits)?;
        let comments = std::mem::take(&mut self.comments);
        let samples = if header.maxval <= 255 {
            let convert = |value: u16| (value & 0xff) as u8;
            let samples = if header.plain { self.plain(&header, convert)? } else { self.bytes(&header)? };
            Samples::Eight(samples)
        } else {
            let samples = if header.plain { self.plain(&header, |value| value)? } else { self.pairs(&header)? };
            Samples::Sixteen(samples)
        };
        let size = |number| usize::try_from(number).map_err(|_| header.out_of_memory());
        let pixmap = Pixmap::from_checked(size(header.width)?, size(header.height)?, header.maxval, samples);
        Ok((pixmap.expect("the raster holds as many samples as the header promises"), comments))
    }

    fn offset(&self) -> u64 {
        self.base + self.start as u64
    }

    /// Number of bytes of the file that are not read yet, if known.
    fn remaining(&self) -> Option<u64> {
        Some(self.length?.saturating_sub(self.offset()))
    }

    /// Reads more after the bytes not yet used; `false` at the end of the file. The window must not be full.
    fn fill(&mut self) -> Result<bool, PpmError> {
        self.buffer.copy_within(self.start..self.end, 0);
        self.base += self.start as u64;
        self.end -= self.start;
        self.start = 0;
        loop {
            match self.reader.read(&mut self.buffer[self.end..]) {
                Ok(0) => return Ok(false),
                Ok(count) => {
                    self.end += count;
                    return Ok(true);
                }
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(source) => return Err(PpmError::Read { offset: self.base + self.end as u64, source }),
            }
        }
    }

    fn peek(&mut self) -> Result<Option<u8>, PpmError> {
        if self.start == self.end && !self.fill()? {
            return Ok(None);
        }
        Ok(Some(self.buffer[self.start]))
    }

    fn header(&mut self, limits: &Limits) -> Result<Header, PpmError> {
        while self.end < 2 && self.fill()? {}
        let (plain, channels) = match &self.buffer[..self.end.min(2)] {
            b"P2" => (true, 1),
            b"P3" => (true, 3),
            b"P5" => (false, 1),
            b"P6" => (false, 3),
            &[b'P', digit @ (b'1' | b'4' | b'7')] => return Err(PpmError::Relative { found: [b'P', digit] }),
            found => return Err(PpmError::Magic { found: found.to_vec() }),
        };
        self.start = 2;
        self.check_separated("the magic number")?;

        let width = self.header_number(Field::Width)?;
        let height = self.header_number(Field::Height)?;
        for (number, field) in [(&width, Field::Width), (&height, Field::Height)] {
            if number.value == 0 {
                return Err(PpmError::ZeroSize { offset: number.offset, field });
            }
        }
        let maxval = self.header_number(Field::Maxval)?;
        let header = Header {
            plain,
            channels,
            width: width.value,
            height: height.value,
            maxval: u16::try_from(maxval.value)
                .ok()
                .filter(|&maxval| maxval >= 1)
                .ok_or(PpmError::Maxval { offset: maxval.offset, found: maxval.value })?,
        };
        let pixels = u64::from(header.width) * u64::from(header.height);
        // However high the caller's limit, the bytes of a picture must be countable.
        let limit = limits.max_pixels.min(isize::MAX as u64 / 6);
        if pixels > limit {
            let Header { width: columns, height: rows, .. } = header;
            return Err(PpmError::TooManyPixels { offset: width.offset, width: columns, height: rows, limit });
        }

        // The one byte that ends maxval; a comment that touches it ends with that byte.
        match self.peek()? {
            Some(b'#') => self.skip_comment()?,
            Some(_) => self.start += 1,
            None => {}
        }
        Ok(header)
    }

    fn header_number(&mut self, field: Field) -> Result<Decimal, PpmError> {
        self.number(field)?.ok_or_else(|| PpmError::HeaderEnds { offset: self.offset(), field })
    }

    /// The next number, after white space and comments, or `None` at the end of the file.
    fn number(&mut self, field: Field) -> Result<Option<Decimal>, PpmError> {
        let first = loop {
            match self.peek()? {
                None => return Ok(None),
                Some(b'#') => self.skip_comment()?,
                Some(next) if is_space(next) => self.start += 1,
                Some(next) => break next,
            }
        };
        let offset = self.offset();
        if !first.is_ascii_digit() {
            return Err(PpmError::NotANumber { offset, field, found: first });
        }
        let mut value = 0_u32;
        while let Some(digit @ b'0'..=b'9') = self.peek()? {
            value = value
                .checked_mul(10)
                .and_then(|value| value.checked_add(u32::from(digit - b'0')))
                .ok_or(PpmError::NumberTooLarge { offset, field })?;
            self.start += 1;
        }
        self.check_separated(match field {
            Field::Width => "the width",
            Field::Height => "the height",
            Field::Maxval => "maxval",
            Field::Sample => "a sample",
        })?;
        Ok(Some(Decimal { offset, value }))
    }

    /// Checks that white space, a comment or the end of the file is next.
    fn check_separated(&mut self, after: &'static str) -> Result<(), PpmError> {
        match self.peek()? {
            Some(found) if !is_space(found) && found != b'#' => {
                Err(PpmError::NotSeparated { offset: self.offset(), after, found })
            }
            _ => Ok(()),
        }
    }

    /// Skips from `#` to the end of the line, and the byte that ends it.
    fn skip_comment(&mut self) -> Result<(), PpmError> {
        loop {
            let window = &self.buffer[self.start..self.end];
            let end = window.iter().position(|next| matches!(next, b'\n' | b'\r'));
            let length = end.map_or(window.len(), |end| end + 1);
            let room = MOST_COMMENTS - self.comments.len();
            self.comments.extend_from_slice(&window[..length.min(room)]);
            self.start += length;
            if end.is_some() || !self.fill()? {
                return Ok(());
            }
        }
    }

    /// A raster of decimal numbers.
    fn plain<S>(&mut self, header: &Header, convert: impl Fn(u16) -> S) -> Result<Vec<S>, PpmError> {
        let expected = header.samples();
        let mut samples = Vec::new();
        while (samples.len() as u64) < expected {
            if samples.len() == samples.capacity() {
                // Each number but the last takes a digit and a separator.
                header.make_room(&mut samples, self.remaining().map(|bytes| bytes.div_ceil(2)))?;
            }
            let end = samples.capacity().min(usize::try_from(expected).unwrap_or(usize::MAX));
            self.plain_fast(header.maxval, end, &mut samples, &convert);
            if samples.len() == end {
                continue;
            }

            // What the fast loop leaves: comments, leading zeros, errors, and the last bytes of the window.
            let Some(Decimal { offset, value }) = self.number(Field::Sample)? else {
                let found = samples.len() as u64;
                return Err(PpmError::RasterEnds { offset: self.offset(), expected, found });
            };
            match u16::try_from(value) {
                Ok(value) if value <= header.maxval => samples.push(convert(value)),
                _ => {
                    let maxval = header.maxval;
                    return Err(PpmError::SampleAboveMaxval { offset, found: value, maxval });
                }
            }
        }
        Ok(samples)
    }

    /// Takes numbers of at most seven digits, each ended by white space, as long as eight bytes of window are left and
    /// `samples` has fewer than `end`; stops before anything else. Eight bytes are tested at once, without a branch per
    /// digit.
    fn plain_fast<S>(&mut self, maxval: u16, end: usize, samples: &mut Vec<S>, convert: impl Fn(u16) -> S) {
        let window = &self.buffer[..self.end];
        let mut at = self.start;
        while samples.len() < end
            && let Some(eight) = window.get(at..).and_then(<[u8]>::first_chunk)
        {
            // Digits become 0..=9; only they stay below 0x80 when 0x76 is added. A carry out of a byte that is no digit
            // disturbs later bytes alone.
            let word = u64::from_le_bytes(*eight);
            let digits = word ^ 0x3030_3030_3030_3030;
            let others = (digits.wrapping_add(0x7676_7676_7676_7676) | digits) & 0x8080_8080_8080_8080;
            let bits = others.trailing_zeros() & !7;
            if bits == 64 || !is_space((word >> bits & 0xff) as u8) {
                break;
            }
            let length = bits as usize / 8;
            if length > 0 {
                // Left-align, so that zeros stand before the number; then add up pairs, fours, eights.
                let pairs = (digits << (64 - bits)).wrapping_mul(10 << 8 | 1) >> 8 & 0x00ff_00ff_00ff_00ff;
                let fours = pairs.wrapping_mul(100 << 16 | 1) >> 16 & 0x0000_ffff_0000_ffff;
                let value = fours.wrapping_mul(10_000 << 32 | 1) >> 32;
                if value > u64::from(maxval) {
                    break;
                }
                samples.push(convert((value & 0xffff) as u16));
            }
            at += length + 1;
        }
        self.start = at;
    }

    /// A raster of bytes.
    fn bytes(&mut self, header: &Header) -> Result<Vec<u8>, PpmError> {
        let raster = self.offset();
        let expected = header.samples();
        self.check_remaining(expected, 1)?;
        let mut samples = Vec::new();
        while (samples.len() as u64) < expected {
            header.make_room(&mut samples, self.remaining())?;
            let room = samples.capacity().min(usize::try_from(expected).unwrap_or(usize::MAX)) - samples.len();
            let window = &self.buffer[self.start..self.end];
            let window = &window[..window.len().min(room)];
            samples.extend_from_slice(window);
            self.start += window.len();
            let room = room - window.len();
            if room > 0 {
                // The window is empty: the rest goes from the reader into its place.
                let got = self.reader.by_ref().take(room as u64).read_to_end(&mut samples);
                self.base = raster + samples.len() as u64 - self.start as u64;
                let got = got.map_err(|source| PpmError::Read { offset: self.offset(), source })?;
                if got < room {
                    let found = samples.len() as u64;
                    return Err(PpmError::RasterEnds { offset: self.offset(), expected, found });
                }
            }
        }
        check_maxval(&samples, header.maxval, raster)?;
        Ok(samples)
    }

    /// A raster of pairs of bytes, the high one first.
    fn pairs(&mut self, header: &Header) -> Result<Vec<u16>, PpmError> {
        let raster = self.offset();
        let expected = header.samples();
        self.check_remaining(expected, 2)?;
        let mut samples = Vec::new();
        while (samples.len() as u64) < expected {
            if samples.len() == samples.capacity() {
                header.make_room(&mut samples, self.remaining().map(|bytes| bytes / 2))?;
            }
            let room = samples.capacity().min(usize::try_from(expected).unwrap_or(usize::MAX)) - samples.len();
            let (pairs, _) = self.buffer[self.start..self.end].as_chunks::<2>();
            let pairs = &pairs[..pairs.len().min(room)];
            samples.extend(pairs.iter().map(|&pair| u16::from_be_bytes(pair)));
            self.start += 2 * pairs.len();
            if room > pairs.len() && !self.fill()? {
                let found = samples.len() as u64;
                return Err(PpmError::RasterEnds { offset: self.base + self.end as u64, expected, found });
            }
        }
        check_maxval(&samples, header.maxval, raster)?;
        Ok(samples)
    }

    /// Refuses a raw raster that is known to be too short.
    fn check_remaining(&self, expected: u64, sample_size: u64) -> Result<(), PpmError> {
        match self.remaining() {
            Some(bytes) if bytes < expected * sample_size => {
                Err(PpmError::RasterEnds { offset: self.offset() + bytes, expected, found: bytes / sample_size })
            }
            _ => Ok(()),
        }
    }
}

fn check_maxval<S: Copy + Into<u16>>(samples: &[S], maxval: u16, raster: u64) -> Result<(), PpmError> {
    if u32::from(maxval) + 1 == 1 << (8 * size_of::<S>()) {
        return Ok(()); // No byte, or pair of bytes, is above this maxval.
    }
    // In blocks, so that the common case needs no branch per sample.
    for (index, block) in samples.chunks(4096).enumerate() {
        if block.iter().fold(0, |most, &sample| sample.into().max(most)) > maxval {
            let within = block.iter().position(|&sample| sample.into() > maxval).expect("the block holds one");
            let position = index * 4096 + within;
            return Err(PpmError::SampleAboveMaxval {
                offset: raster + (position * size_of::<S>()) as u64,
                found: u32::from(samples[position].into()),
                maxval,
            });
        }
    }
    Ok(())
}

/// White space as the format and C's `isspace` have it: blank, tab, line feed, vertical tab, form feed, carriage
/// return.
fn is_space(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t'..=b'\r')
}
