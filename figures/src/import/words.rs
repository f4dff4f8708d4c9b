//! The words and numbers of a line.

use std::hint::select_unpredictable;

use super::problem::LineProblem;

/// The words of a line, in half the time that `split` and `filter` take.
pub(super) struct Words<'a>(pub(super) &'a [u8]);

impl<'a> Iterator for Words<'a> {
    type Item = &'a [u8];

    #[inline]
    fn next(&mut self) -> Option<&'a [u8]> {
        let start = self.0.iter().position(|byte| !byte.is_ascii_whitespace())?;
        let rest = &self.0[start..];
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        let (word, rest) = rest.split_at(end);
        self.0 = rest;
        Some(word)
    }
}

/// What follows the keyword in a line: a name, which may have spaces in it.
pub(super) fn rest<'a>(line: &'a [u8], keyword: &[u8]) -> &'a [u8] {
    line.trim_ascii_start().get(keyword.len()..).unwrap_or_default().trim_ascii()
}

/// Reads a number as [`number`] does; `None` for what is none.
pub(crate) fn decimal(word: &[u8]) -> Option<f64> {
    number(word).ok()
}

/// Reads a number, rounded once to the nearest double: what [`str::parse`] gives, in less time.
pub(super) fn number(word: &[u8]) -> Result<f64, LineProblem> {
    fast_float2::parse(word).map_err(|_| LineProblem::Number(shown(word)))
}

/// A place in whole lines, each with its end, from which words are read one by one.
#[derive(Clone)]
pub(super) struct Scanner<'a> {
    text: &'a [u8],
    at: usize,
}

impl<'a> Scanner<'a> {
    pub(super) fn new(text: &'a [u8]) -> Self {
        Self { text, at: 0 }
    }

    /// How many bytes lie behind.
    pub(super) fn position(&self) -> usize {
        self.at
    }

    /// Goes to this place.
    pub(super) fn set_position(&mut self, at: usize) {
        self.at = at;
    }

    /// Passes over space within the line, and returns the byte that follows it; a line's end at the end.
    #[inline(always)]
    pub(super) fn next(&mut self) -> u8 {
        loop {
            match self.text.get(self.at) {
                Some(b' ' | b'\t' | b'\r' | b'\x0c') => self.at += 1,
                Some(&byte) => return byte,
                None => return b'\n',
            }
        }
    }

    /// The next word of the line.
    #[inline(always)]
    pub(super) fn word(&mut self) -> Option<&'a [u8]> {
        if self.next() == b'\n' {
            return None;
        }
        let rest = &self.text[self.at..];
        let quick =
            rest.first_chunk().map(|bytes| up_to_space(u64::from_le_bytes(*bytes)).trailing_zeros() as usize / 8);
        let length = match quick {
            Some(length) if length < 8 && rest[length].is_ascii_whitespace() => length,
            _ => rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len()),
        };
        self.at += length;
        Some(&rest[..length])
    }

    /// The next word of the line as a number, as [`number`] reads it. `None`, somewhere in the word, for what is none.
    #[inline(always)]
    pub(super) fn number(&mut self) -> Option<f64> {
        if self.next() == b'\n' {
            return None;
        }
        if let Some((value, length)) = short_decimal(self.text, self.at) {
            self.at += length;
            return Some(value);
        }
        self.long_number()
    }

    #[inline(never)]
    fn long_number(&mut self) -> Option<f64> {
        let rest = &self.text[self.at..];
        let (value, length) = fast_float2::parse_partial(rest).ok()?;
        self.at += length;
        rest.get(length).is_none_or(u8::is_ascii_whitespace).then_some(value)
    }

    /// The next word of the line as a whole number of up to seven digits, and whether it is negative; a slash and what
    /// follows it in the word are passed over. `None` for what is none.
    #[inline(always)]
    pub(super) fn whole(&mut self) -> Option<(bool, u64)> {
        let negative = self.next() == b'-';
        let start = self.at + usize::from(negative);
        let bytes = u64::from_le_bytes(*self.text.get(start..)?.first_chunk()?);
        let digits = bytes ^ each(b'0');
        // The highest bit of each byte that is no digit: no byte's sum carries into the next.
        let others = (((digits & each(0x7f)) + each(0x80 - 10)) | digits) & each(0x80);
        let count = others.trailing_zeros() as usize / 8;
        if !(1..8).contains(&count) {
            return None;
        }
        let number = eight_digits(digits << (64 - 8 * count)).cast_unsigned();
        self.at = start + count;
        if self.text[self.at] == b'/' {
            self.word();
        }
        self.text.get(self.at).is_none_or(u8::is_ascii_whitespace).then_some((negative, number))
    }

    /// All that lies behind.
    pub(super) fn before(&self) -> &'a [u8] {
        &self.text[..self.at]
    }

    /// Goes behind the end of the line, if no more words are in it.
    #[inline]
    pub(super) fn end_line(&mut self) -> Option<()> {
        (self.next() == b'\n').then(|| self.at = self.text.len().min(self.at + 1))
    }

    /// Goes behind the end of the line.
    #[inline]
    pub(super) fn skip_line(&mut self) {
        let rest = &self.text[self.at..];
        self.at += memchr::memchr(b'\n', rest).map_or(rest.len(), |end| end + 1);
    }
}

/// Reads a number without an exponent that starts at a place of a text, as nearly all numbers do in files of spheres and
/// meshes: a sign or none, up to 8 digits, then a white space or a point with up to 8 digits more. Returns it with its
/// length. `None` for all others, for what is no number, and close to the start and the end of the text.
///
/// Its digits are a whole number below 10^16 and its scale a power of ten up to 10^8. A number up to 2^53 and a power are
/// doubles, so their quotient is the only rounding. Source: W. D. Clinger, "How to Read Floating Point Numbers
/// Accurately", 1990. The eight bytes before the point and the eight before the end are each in one register: there is
/// no loop, and no branch but on whether it is such a number. The length is known first, so that the next number can
/// begin.
#[inline(always)]
fn short_decimal(text: &[u8], at: usize) -> Option<(f64, usize)> {
    const POWERS: [i64; 9] = [1, 10, 100, 1000, 10_000, 100_000, 1_000_000, 10_000_000, 100_000_000];
    const SCALES: [f64; 9] = [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8];
    // So many of the highest bytes, which are the last ones.
    const LAST: [u64; 9] = [0, !0 << 56, !0 << 48, !0 << 40, !0 << 32, !0 << 24, !0 << 16, !0 << 8, !0];
    let window: &[u8; 24] = text.get(at.wrapping_sub(8)..)?.first_chunk()?;
    let eight = |from: usize| u64::from_le_bytes(*window[from..].first_chunk().expect("they lie in the window"));
    let start = eight(8);
    // It ends at a space; without one it is taken as if one followed, and refused below.
    let (early, late) = (up_to_space(start), up_to_space(eight(16)) | 1 << 63);
    let length = select_unpredictable(early != 0, early.trailing_zeros(), 64 + late.trailing_zeros()) as usize / 8;
    let point = (zeros(start ^ each(b'.')) | early).trailing_zeros() as usize / 8;
    let behind = if point == length { 0 } else { length - point - 1 };
    let is_whole = point == length || window[8 + point] == b'.';
    let sign = u64::from(window[8] == b'-' || window[8] == b'+');
    if !is_whole || behind > 8 || !window[8 + length].is_ascii_whitespace() || point as u64 <= sign {
        return None;
    }
    // The digits' values; a sign is a zero. The shift takes away what follows the point.
    let before = ((start ^ each(b'0')) & (!0xff | sign.wrapping_sub(1))) << (64 - 8 * point);
    let after = (eight(length) ^ each(b'0')) & LAST[behind];
    // A byte above 9 sets the highest bit, its own or by what is added to it.
    let above_nine = |digits: u64| (digits.wrapping_add(each(0x80 - 10)) | digits) & each(0x80);
    if above_nine(before) | above_nine(after) != 0 {
        return None;
    }
    let whole = eight_digits(before) * POWERS[behind] + eight_digits(after);
    if whole > 1 << 53 {
        return None;
    }
    let value = whole as f64 / SCALES[behind];
    Some((if window[8] == b'-' { -value } else { value }, length))
}

/// A byte in each place.
const fn each(byte: u8) -> u64 {
    u64::from_ne_bytes([byte; 8])
}

/// The lowest bit that is set marks the lowest byte that is zero: what the difference borrows changes only higher ones.
#[inline(always)]
fn zeros(bytes: u64) -> u64 {
    bytes.wrapping_sub(each(1)) & !bytes & each(0x80)
}

/// The same for a byte that is a space or below.
#[inline(always)]
fn up_to_space(bytes: u64) -> u64 {
    bytes.wrapping_sub(each(b' ' + 1)) & !bytes & each(0x80)
}

/// The number of eight digits, the first of which is in the lowest byte: pairs, then pairs of pairs, then both halves.
#[inline(always)]
fn eight_digits(digits: u64) -> i64 {
    let pairs = digits * 10 + (digits >> 8);
    let (low, high) = (pairs & 0x0000_00ff_0000_00ff, pairs >> 16 & 0x0000_00ff_0000_00ff);
    // (What lies beyond 64 bits is not needed.)
    let (low, high) = (low.wrapping_mul((1_000_000 << 32) + 100), high.wrapping_mul((10_000 << 32) + 1));
    (low.wrapping_add(high) >> 32).cast_signed()
}

/// What was found, for a message; long text is cut.
pub(crate) fn shown(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(200)]);
    let text = text.trim();
    match text.char_indices().nth(40) {
        Some((at, _)) => format!("{}...", &text[..at]),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A word of digits, or of parts of numbers in any order.
    fn word(random: &mut oracle::Random) -> String {
        let mut word = random.pick(&["", "", "-", "+"]).to_owned();
        if random.one_in(8) {
            const PARTS: [&str; 16] =
                ["0", "17", "9", ".", "-", "+", "e", "E5", "e-3", "nan", "inf", "0x1", "_", ",", "\u{b2}", "00000000"];
            (0..random.below(5)).for_each(|_| word += random.pick(&PARTS));
            return word;
        }
        let (digits, point) = (random.below(20), random.below(24));
        for at in 0..digits {
            if at == point {
                word.push('.');
            }
            word.push(char::from(b"0123456789"[random.below(10)]));
        }
        if random.one_in(10) {
            word += &format!("e{}", random.integer(-330..330));
        }
        word
    }

    #[test]
    fn a_number_is_the_nearest_double_or_none() {
        let random = &mut oracle::Random::new(7);
        let mut short = 0;
        for _ in 0..oracle::cases(100_000) {
            let word = word(random);
            let expected = word.parse::<f64>().ok().map(f64::to_bits);
            assert_eq!(number(word.as_bytes()).ok().map(f64::to_bits), expected, "{word:?}");
            // In a line, between other words or at either end of the text.
            let before = random.pick(&["", " ", "a longer one ", "1234567 ", "1234567\t", "x x x x x x\r "]);
            const AFTER: [&str; 6] =
                ["", "\n", " \n", "\t9 and more of it\n", "\r\nand another line\n", " 99999999999999999999\n"];
            let after = random.pick(&AFTER);
            let text = format!("{before}{word}{after}");
            let mut scanner = Scanner::new(text.as_bytes());
            scanner.set_position(before.len());
            let found = scanner.number();
            if word.is_empty() {
                let line = after.split('\n').next().unwrap();
                let next = line.split_ascii_whitespace().next().and_then(|word| word.parse().ok());
                assert_eq!(found, next, "{text:?}");
                continue;
            }
            assert_eq!(found.map(f64::to_bits), expected, "{text:?}");
            if found.is_some() {
                assert_eq!(scanner.position(), before.len() + word.len(), "{text:?}");
            }
            short += usize::from(short_decimal(text.as_bytes(), before.len()).is_some());
        }
        assert!(short > oracle::cases(100_000) / 20, "{short}");
    }

    #[test]
    fn every_byte_ends_a_number_or_makes_it_none() {
        for digits in ["1", "12.5", "-0.123456", "+1234567.12345678", "12345678.", "99999999.99999999", "-0"] {
            for byte in 0..=255 {
                for at in 0..=digits.len() {
                    let mut bytes = [b"before  ", digits.as_bytes(), b"  and more, and more\n"].concat();
                    bytes.insert(8 + at, byte);
                    let word = Words(&bytes[8..]).next().unwrap();
                    let expected = std::str::from_utf8(word).ok().and_then(|word| word.parse::<f64>().ok());
                    let mut scanner = Scanner::new(&bytes);
                    scanner.set_position(8);
                    let found = if byte == b'\n' && at == 0 { expected } else { scanner.number() };
                    assert_eq!(found.map(f64::to_bits), expected.map(f64::to_bits), "{digits} {byte} {at}");
                }
            }
        }
    }

    #[test]
    fn short_numbers_take_the_short_way() {
        for (word, value) in [("-0", -0.0_f64), ("5.", 5.0), ("0.123456", 0.123_456), ("99999999", 99_999_999.0)] {
            let text = format!("12345678{word} 1234567890123456\n");
            let found = short_decimal(text.as_bytes(), 8).map(|(value, length)| (value.to_bits(), length));
            assert_eq!(found, Some((value.to_bits(), word.len())), "{word}");
        }
    }

    #[test]
    fn words_end_with_their_line() {
        let mut scanner = Scanner::new(b" a\tbc\r\n\n d");
        assert_eq!((scanner.word(), scanner.word(), scanner.word()), (Some(&b"a"[..]), Some(&b"bc"[..]), None));
        assert_eq!((scanner.end_line(), scanner.word(), scanner.end_line()), (Some(()), None, Some(())));
        assert_eq!((scanner.end_line(), scanner.word(), scanner.end_line()), (None, Some(&b"d"[..]), Some(())));
        assert_eq!((scanner.position(), scanner.word()), (10, None));
        let mut scanner = Scanner::new(b"a b\nc");
        scanner.skip_line();
        assert_eq!(scanner.word(), Some(&b"c"[..]));
    }
}
