//! A file that may be packed: where its bytes come from, how it begins, and what format it is in.

use std::fs::File;
use std::io::{self, BufReader, Cursor, Read};
use std::path::{Path, PathBuf};

use flate2::read::MultiGzDecoder;

use super::foreign::{self, Format, Known};
use super::problem::{FileProblem, ImportError};
use crate::text::file_name;

/// A packed file is read up to this size, or this many times its own: a few kilobytes can unpack to anything.
const MOST_UNPACKED: u64 = 256 << 20;
const MOST_TIMES: u64 = 64;
/// So many bytes at the start tell the format.
const START: u64 = 4096;

/// A file that was opened, or stdin for `-`; what is packed with gzip is unpacked while it is read.
pub(crate) struct Source {
    /// What messages call it.
    pub(crate) name: String,
    /// Where it lies; `None` for stdin.
    path: Option<PathBuf>,
    /// The ending of its name, without that of gzip.
    ending: String,
    /// Its first bytes.
    start: Vec<u8>,
    rest: Box<dyn Read + Send>,
    /// Its length in bytes; 0 if that is not known.
    pub(crate) length: u64,
}

impl Source {
    pub(crate) fn open(path: &Path) -> Result<Self, ImportError> {
        let stdin = path == Path::new("-");
        let name = if stdin { "stdin".to_owned() } else { file_name(path) };
        let failed = |source| FileProblem::Read { path: name.clone(), source };
        let (mut rest, mut length): (Box<dyn Read + Send>, u64) = if stdin {
            (Box::new(io::stdin()), 0)
        } else {
            let file = File::open(path).map_err(failed)?;
            let length = file.metadata().map_or(0, |metadata| metadata.len());
            (Box::new(file), length)
        };
        let mut start = Vec::new();
        rest.by_ref().take(START).read_to_end(&mut start).map_err(failed)?;
        let mut ending = foreign::ending(path);
        if start.starts_with(b"\x1f\x8b") {
            let unpacked = MultiGzDecoder::new(BufReader::new(Cursor::new(start).chain(rest)));
            let most = MOST_UNPACKED.max(MOST_TIMES.saturating_mul(length));
            rest = Box::new(Bounded { source: unpacked, left: most, most });
            (start, length) = (Vec::new(), 0);
            rest.by_ref().take(START).read_to_end(&mut start).map_err(failed)?;
            if ending == "gz" {
                ending = foreign::ending(&path.with_extension(""));
            }
        }
        let path = (!stdin).then(|| path.to_owned());
        Ok(Self { name, path, ending, start, rest, length })
    }

    /// The folder that it lies in.
    pub(crate) fn folder(&self) -> Option<&Path> {
        self.path.as_deref().map(|path| path.parent().unwrap_or(Path::new("")))
    }

    /// All of its bytes.
    pub(crate) fn reader(&mut self) -> BufReader<Box<dyn Read + Send>> {
        let rest = std::mem::replace(&mut self.rest, Box::new(io::empty()));
        BufReader::with_capacity(1 << 16, Box::new(Cursor::new(self.start.clone()).chain(rest)))
    }

    /// The format: by the ending of the name or, if that says nothing, by the content.
    pub(crate) fn format(&self) -> Result<Format, ImportError> {
        if let Some(format) = Format::of_ending(&self.ending) {
            return Ok(format);
        }
        let what = match (foreign::begins_as(&self.start), foreign::of_ending(&self.ending)) {
            (Some(Known::Read(format)), None) => return Ok(format),
            (Some(Known::Foreign(name)), _) | (_, Some(name)) => format!("{name} is not read"),
            // What comes through a pipe without a sign of another format is a scene.
            (None, None) if self.length == 0 && !self.start.is_empty() => return Ok(Format::Scene),
            (None, None) if self.ending.is_empty() => {
                "neither the ending of its name nor how it begins says what it is".to_owned()
            }
            (None, None) => format!("files that end in .{} are not read", self.ending),
        };
        Err(FileProblem::Foreign { path: self.name.clone(), what }.into())
    }

    /// The error of a reader that has failed or, if the file begins as another format does, one that names this format.
    pub(crate) fn explained(&self, error: ImportError, format: Format) -> ImportError {
        if !error.is_of_content() {
            return error;
        }
        let path = self.name.clone();
        match foreign::begins_as(&self.start) {
            Some(Known::Foreign(name)) => {
                FileProblem::Foreign { path, what: format!("it holds {name}, which is not read") }.into()
            }
            Some(Known::Read(found)) if found != format => {
                let (name, ending) = found.name();
                FileProblem::Misplaced { path, what: format!("it holds {name}; its name must end in .{ending}") }.into()
            }
            _ => error,
        }
    }

    /// Refuses a format where others are expected.
    pub(crate) fn misplaced(&self, format: Format, expected: &'static str) -> ImportError {
        let what = format!("it holds {}; expected {expected}", format.name().0);
        FileProblem::Misplaced { path: self.name.clone(), what }.into()
    }
}

/// A reader that fails beyond a number of bytes.
struct Bounded<R> {
    source: R,
    left: u64,
    most: u64,
}

impl<R: Read> Read for Bounded<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.source.read(buffer)?;
        self.left = self.left.checked_sub(read as u64).ok_or_else(|| {
            io::Error::other(format!("it unpacks to more than {} MiB; unpack it first", self.most >> 20))
        })?;
        Ok(read)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bounded_reader_gives_so_many_bytes_and_no_more() {
        let read = |left| Bounded { source: &[7; 10][..], left, most: 5 << 20 }.read_to_end(&mut Vec::new());
        assert_eq!(read(10).unwrap(), 10);
        assert_eq!(read(9).unwrap_err().to_string(), "it unpacks to more than 5 MiB; unpack it first");
    }
}
