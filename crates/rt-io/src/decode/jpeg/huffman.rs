//! Huffman codes, and the bits of a scan that they are read from.

use super::{ENDS, broken};
use crate::decode::DecodeError;

/// Codes of at most this many bits are found by one look.
const FAST: u32 = 9;

/// A code table.
pub(super) struct Table {
    /// By the next `FAST` bits: the value and the length of the code they begin with; length 0: a longer one.
    fast: [(u8, u8); 1 << FAST],
    /// By length: the first code behind those of this length, shifted up to 16 bits.
    ends: [u32; 17],
    /// By length: what to add to a code, modulo 2^32, for the index of its value.
    offsets: [u32; 17],
    values: Vec<u8>,
}

impl Table {
    /// Numbers the codes (Annex C): `counts[i]` of them have `i + 1` bits. `None` if there are not so many codes.
    pub(super) fn new(counts: &[u8; 16], values: &[u8]) -> Option<Self> {
        let mut table =
            Self { fast: [(0, 0); 1 << FAST], ends: [0; 17], offsets: [0; 17], values: values.to_vec() };
        let (mut code, mut index) = (0_u32, 0_u32);
        for (length, &count) in (1_u8..).zip(counts) {
            let bits = u32::from(length);
            table.offsets[usize::from(length)] = index.wrapping_sub(code);
            for _ in 0..count {
                if bits <= FAST && code >> bits == 0 {
                    let first = (code << (FAST - bits)) as usize;
                    let value = *values.get(index as usize)?;
                    table.fast[first..first + (1 << (FAST - bits))].fill((value, length));
                }
                code += 1;
                index += 1;
            }
            if code > 1 << bits {
                return None;
            }
            table.ends[usize::from(length)] = code << (16 - bits);
            code <<= 1;
        }
        Some(table)
    }
}

/// The bits of a scan, from its first byte to the next marker.
pub(super) struct Bits<'a> {
    bytes: &'a [u8],
    /// Index of the next byte that is not in `buffer`.
    at: usize,
    /// The next `count` bits, from the top; zeros behind them.
    buffer: u64,
    count: u32,
}

impl<'a> Bits<'a> {
    pub(super) fn new(bytes: &'a [u8], at: usize) -> Self {
        Self { bytes, at, buffer: 0, count: 0 }
    }

    /// Where the search for the next marker begins. Bits are never taken from behind a marker.
    pub(super) fn position(&self) -> usize {
        self.at
    }

    /// Makes at least 48 bits ready, or all that there are before the marker.
    fn fill(&mut self) {
        while self.count <= 56 {
            let Some(&byte) = self.bytes.get(self.at) else { return };
            if byte == 0xff {
                // A zero is stuffed behind a byte of ones that is no marker.
                if self.bytes.get(self.at + 1) != Some(&0) {
                    return;
                }
                self.at += 1;
            }
            self.at += 1;
            self.buffer |= u64::from(byte) << (56 - self.count);
            self.count += 8;
        }
    }

    fn skip(&mut self, count: u32) -> Result<(), DecodeError> {
        if count > self.count {
            return Err(self.exhausted());
        }
        self.buffer <<= count;
        self.count -= count;
        Ok(())
    }

    #[cold]
    fn exhausted(&self) -> DecodeError {
        let mut at = self.at;
        match super::next_marker(self.bytes, &mut at) {
            None | Some(0xd9) => ENDS,
            Some(marker) => broken(format!("marker {marker:#04x} within a scan")),
        }
    }

    /// The next `count <= 16` bits, the first one the highest.
    pub(super) fn take(&mut self, count: u32) -> Result<u16, DecodeError> {
        if self.count < count {
            self.fill();
        }
        let bits = (self.buffer >> 48) >> (16 - count);
        self.skip(count)?;
        Ok((bits & 0xffff) as u16)
    }

    /// The value of the next code.
    pub(super) fn decode(&mut self, table: &Table) -> Result<u8, DecodeError> {
        if self.count < 16 {
            self.fill();
        }
        let (value, length) = table.fast[(self.buffer >> (64 - FAST)) as usize];
        if length > 0 {
            self.skip(length.into())?;
            return Ok(value);
        }
        let next = (self.buffer >> 48 & 0xffff) as u32;
        let Some(length) = (1..=16).find(|&length| next < table.ends[length as usize]) else {
            return Err(if self.count < 16 {
                self.exhausted()
            } else {
                broken("a code that no Huffman table has")
            });
        };
        self.skip(length)?;
        let index = (next >> (16 - length)).wrapping_add(table.offsets[length as usize]);
        table.values.get(index as usize).copied().ok_or_else(|| broken("a code that no Huffman table has"))
    }

    /// A signed number of `count <= 15` bits: F.2.2.1, figure F.12 (`EXTEND`).
    pub(super) fn signed(&mut self, count: u8) -> Result<i32, DecodeError> {
        if count == 0 {
            return Ok(0);
        }
        let value = i32::from(self.take(count.into())?);
        Ok(if value >> (count - 1) == 0 { value - (1 << count) + 1 } else { value })
    }

    /// Passes over the end of an interval and its marker, number `index` modulo 8 (F.2.2.5).
    pub(super) fn restart(&mut self, index: usize) -> Result<(), DecodeError> {
        self.fill();
        (self.buffer, self.count) = (0, 0);
        match super::next_marker(self.bytes, &mut self.at) {
            None | Some(0xd9) => Err(ENDS),
            Some(marker) if usize::from(marker) == 0xd0 + index % 8 => Ok(()),
            Some(marker) => Err(broken(format!("expected a restart marker, found {marker:#04x}"))),
        }
    }
}
