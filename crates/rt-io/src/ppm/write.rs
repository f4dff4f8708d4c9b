//! Writing: the bytes are those that netpbm's `pnmtopnm` and `pnmtopnm -plain` write, so that `cmp` compares pictures.

use std::io::{self, Write};

use crate::pixmap::{Pixmap, Samples};

/// How the raster is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// P6: one byte a sample where `maxval <= 255`, else two, the high one first.
    Raw,
    /// P3: decimal numbers, three to five times the size.
    Plain,
}

/// Writes the picture with its own `maxval`, in large pieces; `out` needs no buffer of its own.
///
/// # Errors
/// An error of `out`.
///
/// ```
/// use rt_io::{Pixmap, ppm};
/// let pixmap = Pixmap::new(1, 1, 255, vec![1, 2, 30]).unwrap();
/// let mut bytes = Vec::new();
/// ppm::write(&pixmap, ppm::Encoding::Plain, &mut bytes).unwrap();
/// assert_eq!(bytes, b"P3\n1 1\n255\n1 2 30 \n");
/// ```
pub fn write(pixmap: &Pixmap, encoding: Encoding, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
    write_lines(pixmap, encoding, "", out)
}

/// Writes the picture as [`write()`] does, with a second line that holds `comment`.
///
/// # Errors
/// An error of `out`, and [`io::ErrorKind::InvalidInput`] if the comment holds a line end.
///
/// ```
/// use rt_io::{Limits, Pixmap, ppm};
/// let pixmap = Pixmap::new(1, 1, 255, vec![1, 2, 30]).unwrap();
/// let mut bytes = Vec::new();
/// ppm::write_with_comment(&pixmap, ppm::Encoding::Plain, "rows 0..1 of 2", &mut bytes).unwrap();
/// assert_eq!(bytes, b"P3\n# rows 0..1 of 2\n1 1\n255\n1 2 30 \n");
///
/// let (found, comments) = ppm::read_with_comments(&bytes[..], &Limits::default()).unwrap();
/// assert_eq!((found, comments), (pixmap, vec!["rows 0..1 of 2".to_string()]));
/// ```
pub fn write_with_comment(
    pixmap: &Pixmap,
    encoding: Encoding,
    comment: &str,
    out: &mut (impl Write + ?Sized),
) -> io::Result<()> {
    if comment.contains(['\n', '\r']) {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "a comment of a PPM is one line"));
    }
    write_lines(pixmap, encoding, &format!("# {comment}\n"), out)
}

/// Writes the picture with more lines, if any, after the first.
fn write_lines(pixmap: &Pixmap, encoding: Encoding, lines: &str, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
    let magic = match encoding {
        Encoding::Raw => "P6",
        Encoding::Plain => "P3",
    };
    write!(out, "{magic}\n{lines}{} {}\n{}\n", pixmap.width(), pixmap.height(), pixmap.maxval())?;
    match (encoding, pixmap.raw()) {
        (Encoding::Raw, Samples::Eight(samples)) => in_rgb(pixmap, samples, |rows| out.write_all(rows)),
        (Encoding::Raw, Samples::Sixteen(samples)) => in_rgb(pixmap, samples, |rows| write_pairs(rows, out)),
        (Encoding::Plain, Samples::Eight(samples)) => in_rgb(pixmap, samples, |rows| write_plain(pixmap, rows, out)),
        (Encoding::Plain, Samples::Sixteen(samples)) => in_rgb(pixmap, samples, |rows| write_plain(pixmap, rows, out)),
    }
}

/// Passes whole rows of RGB samples to `write`: all at once, or some rows at a time of a picture that is stored as
/// grey.
fn in_rgb<S: Copy>(pixmap: &Pixmap, samples: &[S], mut write: impl FnMut(&[S]) -> io::Result<()>) -> io::Result<()> {
    if !pixmap.is_grey() {
        return write(samples);
    }
    let rows = (PIECE / (3 * pixmap.width())).max(1);
    let mut rgb = Vec::new();
    for grey in samples.chunks(rows * pixmap.width()) {
        rgb.clear();
        rgb.try_reserve(3 * grey.len())?;
        rgb.extend(grey.iter().flat_map(|&sample| [sample; 3]));
        write(&rgb)?;
    }
    Ok(())
}

/// Bytes gathered before they are handed on.
const PIECE: usize = 1 << 16;

fn write_pairs(samples: &[u16], out: &mut (impl Write + ?Sized)) -> io::Result<()> {
    let mut bytes = Vec::with_capacity(PIECE);
    for piece in samples.chunks(PIECE / 2) {
        bytes.clear();
        bytes.extend(piece.iter().flat_map(|sample| sample.to_be_bytes()));
        out.write_all(&bytes)?;
    }
    Ok(())
}

/// Each number is followed by a space. A line ends after as many whole pixels as netpbm puts on one (what fits in 79
/// bytes if a number took one byte less than `maxval` with its space does), and again with the row, so that a row that
/// fills its last line is followed by an empty one.
fn write_plain<S: Copy + Into<u16>>(pixmap: &Pixmap, samples: &[S], out: &mut (impl Write + ?Sized)) -> io::Result<()> {
    let digits = pixmap.maxval().ilog10() as usize + 1;
    let fit = 79 / digits;
    let line = fit - fit % 3;
    let mut text = Vec::with_capacity(PIECE + 1024);
    for row in samples.chunks_exact(3 * pixmap.width()) {
        for piece in row.chunks(line) {
            for &sample in piece {
                push_decimal(sample.into(), &mut text);
                text.push(b' ');
            }
            if piece.len() == line {
                text.push(b'\n');
            }
            if text.len() >= PIECE {
                out.write_all(&text)?;
                text.clear();
            }
        }
        text.push(b'\n');
    }
    out.write_all(&text)
}

/// Appends `value` in decimal.
fn push_decimal(value: u16, text: &mut Vec<u8>) {
    let digit = |unit: u16| b'0' + (value / unit % 10) as u8;
    match value {
        0..10 => text.push(digit(1)),
        10..100 => text.extend([digit(10), digit(1)]),
        100..1000 => text.extend([digit(100), digit(10), digit(1)]),
        1000..10000 => text.extend([digit(1000), digit(100), digit(10), digit(1)]),
        _ => text.extend([digit(10000), digit(1000), digit(100), digit(10), digit(1)]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(width: usize, maxval: u16) -> Vec<usize> {
        let pixmap = Pixmap::new(width, 2, maxval, vec![maxval; 6 * width]).unwrap();
        let mut bytes = Vec::new();
        write(&pixmap, Encoding::Plain, &mut bytes).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        text.lines().skip(3).map(|line| line.split_whitespace().count()).collect()
    }

    #[test]
    fn plain_lines_break_where_those_of_netpbm_do() {
        // Whole pixels, as many as the digits of maxval allow; a new row is a new line.
        assert_eq!(lines(30, 9), [78, 12, 78, 12]);
        assert_eq!(lines(15, 10), [39, 6, 39, 6]);
        assert_eq!(lines(9, 255), [24, 3, 24, 3]);
        assert_eq!(lines(7, 1000), [18, 3, 18, 3]);
        assert_eq!(lines(6, 65535), [15, 3, 15, 3]);
        // A row that ends with a full line is followed by an empty one.
        assert_eq!(lines(8, 255), [24, 0, 24, 0]);
        assert_eq!(lines(10, 65535), [15, 15, 0, 15, 15, 0]);
    }

    #[test]
    fn a_writer_that_fails_is_an_error() {
        struct Full(usize);
        impl Write for Full {
            fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
                let count = bytes.len().min(self.0);
                self.0 -= count;
                if count == 0 { Err(io::ErrorKind::StorageFull.into()) } else { Ok(count) }
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        let pixmap = Pixmap::new(100, 100, 65535, vec![12345; 30_000]).unwrap();
        for encoding in [Encoding::Raw, Encoding::Plain] {
            for room in [0, 5, 20, 50_000] {
                let error = write(&pixmap, encoding, &mut Full(room)).unwrap_err();
                assert_eq!(error.kind(), io::ErrorKind::StorageFull, "{encoding:?} {room}");
            }
        }
    }
}
