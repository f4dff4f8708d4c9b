//! A source line by line, or in blocks of whole lines.

use std::io::{BufRead, Read};

use super::problem::{Broken, FileProblem, ImportError, LONGEST_LINE, LONGEST_RECORD, LineProblem};

/// The size of a block, unless a line is longer. It stays in the cache of a core until it is read. (Tests have many.)
pub(super) const BLOCK: usize = if cfg!(test) { 1 << 10 } else { 1 << 20 };
/// Fewer bytes than this are not worth a thread.
pub(super) const PIECE: usize = BLOCK >> 4;

/// Reads the next line, with its end, into `bytes`, and counts it; false at the end of the source.
///
/// # Errors
/// What is wrong with the line, in the file called `name`: it has [`LONGEST_RECORD`] bytes, or cannot be read.
pub(super) fn next_record(
    source: &mut impl BufRead,
    bytes: &mut Vec<u8>,
    line: &mut usize,
    name: &str,
) -> Result<bool, ImportError> {
    bytes.clear();
    let read = source.by_ref().take(LONGEST_RECORD).read_until(b'\n', bytes);
    let read = read.map_err(|source| FileProblem::Read { path: name.to_owned(), source })?;
    *line += usize::from(read > 0);
    if read as u64 == LONGEST_RECORD {
        return Err(ImportError::in_line(name, *line, LineProblem::LongRecord));
    }
    Ok(read > 0)
}

/// The source in blocks that end at a line's end.
pub(super) struct LineBlocks<R> {
    source: R,
    /// What was read; the bytes from `start` on are still to be returned.
    buffer: Vec<u8>,
    start: usize,
    ended: bool,
}

impl<R: Read> LineBlocks<R> {
    pub(super) fn new(source: R) -> Self {
        Self { source, buffer: Vec::new(), start: 0, ended: false }
    }

    /// Fills the buffer up to a block, or to twice what it holds if that is a block or more.
    fn fill(&mut self) -> Result<(), Broken> {
        self.buffer.drain(..self.start);
        self.start = 0;
        let size = if self.buffer.len() < BLOCK { BLOCK } else { LONGEST_LINE.min(2 * self.buffer.len()) };
        let missing = size - self.buffer.len();
        if !self.ended && missing > 0 {
            let read = self.source.by_ref().take(missing as u64).read_to_end(&mut self.buffer);
            self.ended = read.map_err(Broken::Read)? < missing;
            if self.ended && self.buffer.last().is_some_and(|&last| last != b'\n') {
                self.buffer.push(b'\n');
            }
        }
        Ok(())
    }

    /// Returns whole lines, as many as the buffer holds; none at the end.
    pub(super) fn next(&mut self) -> Result<&[u8], Broken> {
        self.up_to(|bytes| memchr::memrchr(b'\n', bytes))
    }

    /// Returns one line, without its end; an empty one at the end.
    pub(super) fn line(&mut self) -> Result<&[u8], Broken> {
        let line = self.up_to(|bytes| memchr::memchr(b'\n', bytes))?;
        Ok(line.strip_suffix(b"\n").unwrap_or(line))
    }

    /// Returns the bytes up to the line end that `find` finds in the buffer; none at the end.
    fn up_to(&mut self, find: impl Fn(&[u8]) -> Option<usize>) -> Result<&[u8], Broken> {
        let end = loop {
            if let Some(end) = find(&self.buffer[self.start..]) {
                break end + 1;
            }
            let held = self.buffer.len() - self.start;
            if held == LONGEST_LINE {
                return Err(LineProblem::Long.into());
            }
            self.fill()?;
            if self.buffer.len() == held {
                // (Without a line end there is nothing, since the source has ended.)
                break 0;
            }
        };
        let from = self.start;
        self.start += end;
        Ok(&self.buffer[from..self.start])
    }

    /// Takes back the last so many bytes of what was returned last.
    pub(super) fn take_back(&mut self, bytes: usize) {
        self.start -= bytes;
    }

    /// Whether everything was returned.
    pub(super) fn is_empty(&mut self) -> Result<bool, Broken> {
        if self.buffer.len() == self.start {
            self.fill()?;
        }
        Ok(self.buffer.len() == self.start)
    }
}
