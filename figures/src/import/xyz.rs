//! Spheres from XYZ files, plain and extended: molecules and particles by the million.
//!
//! A file is a line with the number of atoms, a line of comment, then a line for each atom. In a plain file that is
//! `element x y z`, and the rest of the line is ignored. In an extended one the comment has
//! `Properties=name:type:columns` groups, joined by colons, that say what the columns are; of these `species`, `pos`,
//! `radius` and `color` are read (`element`, `type` and capitals will do too). One frame of several is read, the first
//! unless another is asked for; a note says what follows it. Empty lines may stand before a frame. `elements.rs` has the
//! rule for names that are not symbols.
//!
//! The file streams through a buffer of a few megabytes. Each filling ends at a line's end, is cut into pieces at
//! lines' ends, and the pieces are read in parallel; what they hold is appended in order. So memory is the spheres and
//! the buffer, and the result does not depend on threads.

use std::io::{self, Read};

use glam::DVec3;
use rayon::prelude::*;
use rt_geom::Sphere;

use super::elements::{self, ElementName};
use super::problem::{FileProblem, ImportError, LONGEST_LINE, LineProblem};
use super::spheres::{AtomColor, Names, Options, Palette, Spheres};
use super::words::{Words, number, shown};
use crate::text::without_mark;

/// The size of the buffer.
const BUFFER: usize = LONGEST_LINE;
/// Fewer bytes than this are not worth a thread.
const PIECE: usize = 64 << 10;

/// Reads spheres from `source`, which errors call `name` and which has about `length` bytes (0: unknown).
///
/// # Errors
/// What is wrong, with the line.
pub fn read(source: impl Read, length: u64, name: &str, options: Options) -> Result<Spheres, ImportError> {
    let mut blocks = LineBlocks { source, buffer: Vec::new(), start: 0, ended: false };
    let mut line = 0;
    read_lines(&mut blocks, length, options, &mut line).map_err(|failure| match failure {
        Broken::Read(source) => FileProblem::Read { path: name.to_owned(), source }.into(),
        Broken::Line(problem) => ImportError::in_line(name, line, problem),
    })
}

/// Why reading ended early.
enum Broken {
    Read(io::Error),
    Line(LineProblem),
}

impl From<LineProblem> for Broken {
    fn from(problem: LineProblem) -> Self {
        Self::Line(problem)
    }
}

/// Reads the file; on failure `line` is where.
fn read_lines(
    blocks: &mut LineBlocks<impl Read>,
    length: u64,
    options: Options,
    line: &mut usize,
) -> Result<Spheres, Broken> {
    *line = 1;
    let mut header = without_mark(blocks.line()?).map_err(LineProblem::Utf16)?.to_vec();
    let mut frame = 1;
    let (expected, comment) = loop {
        while header.trim_ascii().is_empty() && !blocks.is_empty()? {
            *line += 1;
            header = blocks.line()?.to_vec();
        }
        if frame > 1 && header.trim_ascii().is_empty() {
            return Err(LineProblem::Frames { frame: options.frame, found: frame - 1 }.into());
        }
        let expected = text(&header).parse::<u64>().map_err(|_| LineProblem::Count(shown(&header)))?;
        *line += 1;
        let comment = String::from_utf8_lossy(blocks.line()?).into_owned();
        if frame == options.frame {
            break (expected, comment);
        }
        for found in 0..expected {
            if blocks.is_empty()? {
                return Err(LineProblem::Short { expected, found }.into());
            }
            *line += 1;
            blocks.line()?;
        }
        frame += 1;
        *line += 1;
        header = blocks.line()?.to_vec();
    };
    let layout = Columns::of(&comment, options)?;

    let mut found = Spheres::default();
    let no_memory = |_| LineProblem::SphereMemory(expected);
    // An atom takes eight bytes at least, so a false count reserves no more than the file is worth.
    let likely = usize::try_from(expected.min(length / 8)).unwrap_or(0);
    found.spheres.try_reserve_exact(likely).map_err(no_memory)?;
    found.color_indices.try_reserve_exact(likely).map_err(no_memory)?;
    let mut palette = Palette::default();
    let mut names = Names::default();
    *line += 1;
    while (found.spheres.len() as u64) < expected {
        let block = blocks.next()?;
        if block.is_empty() {
            return Err(LineProblem::Short { expected, found: found.spheres.len() as u64 }.into());
        }
        let missing = usize::try_from(expected - found.spheres.len() as u64).unwrap_or(usize::MAX);
        let pieces = pieces(block, missing);
        let read = pieces.iter().map(|piece| piece.len()).sum::<usize>();
        let behind = block.len() - read;
        for piece in pieces.par_iter().map(|piece| layout.atoms(piece)).collect::<Vec<_>>() {
            found.spheres.try_reserve(piece.atoms.len()).map_err(no_memory)?;
            found.color_indices.try_reserve(piece.atoms.len()).map_err(no_memory)?;
            for (sphere, paint) in piece.atoms {
                found.spheres.push(sphere);
                found.color_indices.push(palette.index(paint, &mut found.colors)?);
                *line += 1;
            }
            if let Some(problem) = piece.problem {
                return Err(problem.into());
            }
            for (name, element) in piece.names.0 {
                names.add(&name, element);
            }
        }
        blocks.start -= behind;
    }
    found.warnings.extend(names.note());
    blocks.what_follows(*line, options.frame, &mut found)?;
    Ok(found)
}

/// Cuts a block of whole lines into pieces of whole lines, at most `lines` lines in all.
fn pieces(block: &[u8], lines: usize) -> Vec<&[u8]> {
    let size = (block.len() / rayon::current_num_threads()).max(PIECE);
    let mut rest = block;
    let mut pieces = Vec::new();
    while !rest.is_empty() {
        let end = match rest.get(size..).and_then(|later| later.iter().position(|&byte| byte == b'\n')) {
            Some(position) => size + position + 1,
            None => rest.len(),
        };
        let (piece, later) = rest.split_at(end);
        pieces.push(piece);
        rest = later;
    }
    // Lines after the last atom, another frame or anything else, are not read.
    let mut left = lines;
    for piece in &mut pieces {
        let count = piece.iter().filter(|&&byte| byte == b'\n').count();
        if count > left {
            let ends = piece.iter().enumerate().filter(|(_, byte)| **byte == b'\n').map(|(at, _)| at + 1);
            *piece = &piece[..[0].into_iter().chain(ends).nth(left).expect("there are more lines than that")];
        }
        left -= count.min(left);
    }
    pieces
}

/// The source in blocks that end at a line's end.
struct LineBlocks<R> {
    source: R,
    /// What was read; the bytes from `start` on are still to be returned.
    buffer: Vec<u8>,
    start: usize,
    ended: bool,
}

impl<R: Read> LineBlocks<R> {
    /// Fills the buffer up as far as the source goes.
    fn fill(&mut self) -> Result<(), Broken> {
        self.buffer.drain(..self.start);
        self.start = 0;
        let missing = BUFFER - self.buffer.len();
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
    fn next(&mut self) -> Result<&[u8], Broken> {
        self.up_to(|bytes| bytes.iter().rposition(|&byte| byte == b'\n'))
    }

    /// Returns one line, without its end; an empty one at the end.
    fn line(&mut self) -> Result<&[u8], Broken> {
        let line = self.up_to(|bytes| bytes.iter().position(|&byte| byte == b'\n'))?;
        Ok(line.strip_suffix(b"\n").unwrap_or(line))
    }

    /// Returns the bytes up to the line end that `find` finds in the buffer; none at the end.
    fn up_to(&mut self, find: impl Fn(&[u8]) -> Option<usize>) -> Result<&[u8], Broken> {
        if !self.buffer[self.start..].contains(&b'\n') {
            self.fill()?;
        }
        let from = self.start;
        match find(&self.buffer[from..]) {
            Some(end) => {
                self.start += end + 1;
                Ok(&self.buffer[from..self.start])
            }
            None if self.buffer.len() == from => Ok(&[]),
            None => Err(LineProblem::Long.into()),
        }
    }

    /// Whether everything was returned.
    fn is_empty(&mut self) -> Result<bool, Broken> {
        if self.buffer.len() == self.start {
            self.fill()?;
        }
        Ok(self.buffer.len() == self.start)
    }

    /// Says what follows the last atom, if it is more than space; `line` is the next one's number.
    fn what_follows(&mut self, mut line: usize, frame: u64, found: &mut Spheres) -> Result<(), Broken> {
        while !self.is_empty()? {
            let next = match self.line() {
                Ok(next) => next.trim_ascii(),
                // A line without an end is something that follows too.
                Err(Broken::Line(_)) => b"...",
                Err(failure) => return Err(failure),
            };
            if !next.is_empty() {
                match text(next).parse::<u64>() {
                    Ok(_) => {
                        found
                            .notes
                            .push(format!("frame {frame} is drawn; another one follows in line {line} (--frame)"));
                    }
                    Err(_) => {
                        let warning = format!("what follows the last atom is passed over, from line {line} on");
                        found.warnings.push(warning);
                    }
                }
                break;
            }
            line += 1;
        }
        Ok(())
    }
}

/// Which columns hold what.
struct Columns {
    options: Options,
    position: usize,
    element: Option<usize>,
    radius: Option<usize>,
    color: Option<usize>,
    /// As many columns as have to be there.
    columns: usize,
}

/// What was read from a piece of a file: atoms, and the error in the line after them, if any.
struct AtomPiece {
    atoms: Vec<(Sphere, AtomColor)>,
    names: Names,
    problem: Option<LineProblem>,
}

impl Columns {
    /// Reads the comment line.
    fn of(comment: &str, options: Options) -> Result<Self, LineProblem> {
        let mut layout = Self { options, position: 1, element: Some(0), radius: None, color: None, columns: 4 };
        let Some(properties) = value(comment, "properties") else { return Ok(layout) };
        let refuse = || LineProblem::Properties(shown(properties.as_bytes()));
        let fields: Vec<&str> = properties.split(':').collect();
        let mut position = None;
        (layout.element, layout.columns) = (None, 0);
        for group in fields.chunks(3) {
            let &[name, kind, columns] = group else { return Err(refuse()) };
            let columns: usize = columns.parse().ok().filter(|&n| 0 < n && n < 1000).ok_or_else(refuse)?;
            let at = layout.columns;
            layout.columns += columns;
            let number = kind.eq_ignore_ascii_case("R") || kind.eq_ignore_ascii_case("I");
            match (name.to_ascii_lowercase().as_str(), columns) {
                ("pos" | "position", 3) if number => position = Some(at),
                ("species" | "element" | "type", 1) => layout.element = Some(at),
                ("radius", 1) if number => layout.radius = Some(at),
                ("color", 3) if number && options.colored => layout.color = Some(at),
                _ => {}
            }
        }
        layout.position = position.ok_or_else(refuse)?;
        let used = [Some(layout.position + 2), layout.element, layout.radius, layout.color.map(|at| at + 2)];
        layout.columns = used.into_iter().flatten().max().map_or(0, |last| last + 1);
        if layout.element.is_none() && layout.radius.is_none() && options.radius.is_none() {
            return Err(LineProblem::NoRadius);
        }
        Ok(layout)
    }

    /// Reads whole lines.
    fn atoms(&self, lines: &[u8]) -> AtomPiece {
        let mut atoms = Vec::with_capacity(lines.len() / 24);
        let mut columns = Vec::with_capacity(self.columns);
        let mut names = Names::default();
        for line in lines.split_inclusive(|&byte| byte == b'\n') {
            match self.atom(line, &mut columns, &mut names) {
                Ok(atom) => atoms.push(atom),
                Err(problem) => return AtomPiece { atoms, names, problem: Some(problem) },
            }
        }
        AtomPiece { atoms, names, problem: None }
    }

    /// Reads a line; `columns` is a place to work in.
    fn atom<'a>(
        &self,
        line: &'a [u8],
        columns: &mut Vec<&'a [u8]>,
        names: &mut Names,
    ) -> Result<(Sphere, AtomColor), LineProblem> {
        columns.clear();
        columns.extend(Words(line).take(self.columns));
        if columns.len() < self.columns {
            return Err(LineProblem::Columns { expected: self.columns, found: columns.len() });
        }
        let three = |at: usize| -> Result<DVec3, LineProblem> {
            Ok(DVec3::new(number(columns[at])?, number(columns[at + 1])?, number(columns[at + 2])?))
        };
        let center = self.options.scale * three(self.position)?;
        if !center.is_finite() {
            let words = &columns[self.position..self.position + 3];
            return Err(LineProblem::NotFinite { name: "position", found: shown(&words.join(&b' ')) });
        }
        let color = self.color.map(three).transpose()?;
        if let Some(channel) = color.and_then(|color| color.to_array().into_iter().find(|c| !(0.0..=1.0).contains(c))) {
            return Err(LineProblem::SphereColor(channel));
        }
        // An element has to be known only where something depends on it.
        let needed =
            (self.options.colored && color.is_none()) || (self.radius.is_none() && self.options.radius.is_none());
        let element = match self.element.filter(|_| needed) {
            Some(at) => match elements::find(columns[at]) {
                Some(ElementName::Plain(element)) => Some(element),
                Some(ElementName::Label(element)) => {
                    names.add(columns[at], element);
                    Some(element)
                }
                None => return Err(LineProblem::Element(shown(columns[at]))),
            },
            None => None,
        };
        let radius = match (self.radius, self.options.radius, element) {
            (Some(at), ..) => number(columns[at])?,
            (None, Some(radius), _) => radius,
            (None, None, Some(element)) => elements::radius(element),
            (None, None, None) => return Err(LineProblem::NoRadius),
        };
        if radius < 0.0 {
            return Err(LineProblem::NegativeRadius(radius));
        }
        let sphere = Sphere::new(center, self.options.scale * radius)
            .map_err(|_| LineProblem::NotFinite { name: "radius", found: radius.to_string() })?;
        let paint = match (color, element) {
            (Some(color), _) => AtomColor::Color(color),
            (None, Some(element)) if self.options.colored => AtomColor::Element(element),
            (None, _) => AtomColor::Nothing,
        };
        Ok((sphere, paint))
    }
}

/// Returns the value of `key=value` or `key="value"` in a comment line, the key in any case.
fn value<'a>(comment: &'a str, key: &str) -> Option<&'a str> {
    let lower = comment.to_ascii_lowercase();
    let starts = lower.match_indices(key).map(|(at, _)| at);
    // A key stands at the start of a word, and its value follows at once.
    let at = starts.into_iter().find(|&at| {
        (at == 0 || lower.as_bytes()[at - 1].is_ascii_whitespace()) && lower[at + key.len()..].starts_with('=')
    })?;
    let value = &comment[at + key.len() + 1..];
    match value.strip_prefix('"') {
        Some(quoted) => quoted.split('"').next(),
        None => value.split_whitespace().next().or(Some("")),
    }
}

/// A line as text, for numbers; empty if it is not UTF-8.
fn text(line: &[u8]) -> &str {
    std::str::from_utf8(line).unwrap_or("").trim()
}

#[cfg(test)]
mod tests {
    use super::super::spheres::REMEMBERED;
    use super::*;

    fn parse(text: &str, options: Options) -> Result<Spheres, ImportError> {
        read(text.as_bytes(), text.len() as u64, "atoms.xyz", options)
    }

    fn sphere(x: f64, y: f64, z: f64, radius: f64) -> Sphere {
        Sphere::new(DVec3::new(x, y, z), radius).unwrap()
    }

    #[test]
    fn a_plain_file_has_the_elements_radii_and_colors() {
        let text = "3\nwater, and what follows is passed over\nO 0 0 0 -0.8\nH 0.9 1e-1 0\n 1\t-0.9 .2 +0\r\nC 9 9 9\n";
        let found = parse(text, Options::default()).unwrap();
        let expected = [sphere(0.0, 0.0, 0.0, 1.5), sphere(0.9, 0.1, 0.0, 1.2), sphere(-0.9, 0.2, 0.0, 1.2)];
        assert_eq!(found.spheres, expected);
        assert_eq!(found.color_indices, [0, 1, 1]);
        assert_eq!(found.colors, [DVec3::new(255.0, 13.0, 13.0) / 255.0, DVec3::ONE]);
    }

    #[test]
    fn an_extended_file_has_its_own_columns() {
        let comment = "Lattice=\"1 0 0\" Properties=species:S:1:vel:R:2:pos:R:3:radius:R:1:color:R:3 pbc=\"T T T\"";
        let text = format!("2\n{comment}\nXx 7 7 1 2 3 0.5 1 0.5 0\nC 8 8 4 5 6 0 1 0.5 0\n");
        let found = parse(&text, Options { scale: 2.0, ..Options::default() }).unwrap();
        assert_eq!(found.spheres, [sphere(2.0, 4.0, 6.0, 1.0), sphere(8.0, 10.0, 12.0, 0.0)]);
        assert_eq!(found.colors, [DVec3::new(1.0, 0.5, 0.0)]);
    }

    #[test]
    fn a_given_radius_takes_the_place_of_the_elements() {
        let options = Options { radius: Some(0.25), colored: false, ..Options::default() };
        let found = parse("1\n\nUnobtainium 1 2 3\n", options).unwrap();
        assert_eq!(found.spheres, [sphere(1.0, 2.0, 3.0, 0.25)]);
        let found = parse("1\nProperties=pos:R:3\n1 2 3\n", options).unwrap();
        assert_eq!(found.spheres, [sphere(1.0, 2.0, 3.0, 0.25)]);
    }

    #[test]
    fn a_color_for_each_sphere_is_kept_for_each_sphere() {
        // More colours than are remembered, then all of them again: the early ones are found, the late ones kept twice.
        let count = REMEMBERED + 1000;
        let mut text = format!("{}\nProperties=pos:R:3:radius:R:1:color:R:3\n", 2 * count);
        for index in (0..count).chain(0..count) {
            text += &format!("{index} 0 0 1 0.{:03} 0.{:03} 0.5\n", index / 1000, index % 1000);
        }
        let found = parse(&text, Options::default()).unwrap();
        assert_eq!((found.spheres.len(), found.colors.len()), (2 * count, count + 1000));
        for (place, &index) in found.color_indices.iter().enumerate() {
            let number = place % count;
            let channel = |thousandths: usize| thousandths as f64 / 1000.0;
            let expected = DVec3::new(channel(number / 1000), channel(number % 1000), 0.5);
            assert_eq!(found.colors[index as usize], expected, "sphere {place}");
        }
    }

    /// A source that returns few bytes at a time, as a pipe may.
    struct Trickle<'a>(&'a [u8]);

    impl Read for Trickle<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            let count = buffer.len().min(self.0.len()).min(1021);
            buffer[..count].copy_from_slice(&self.0[..count]);
            self.0 = &self.0[count..];
            Ok(count)
        }
    }

    #[test]
    fn many_blocks_and_pieces_are_one_list() {
        // About 9 MB: three fillings of the buffer, each in pieces. The last line has no end; a second frame follows it
        // in the other text.
        let count = 300_000;
        let mut text = format!("{count}\nProperties=pos:R:3:radius:R:1\n");
        for index in 0..count {
            text += &format!("{index} {}.5 -0.125 0.0{index}\n", count - index);
        }
        let expected = |index: u32| {
            let radius: f64 = format!("0.0{index}").parse().unwrap();
            sphere(index.into(), f64::from(count - index) + 0.5, -0.125, radius)
        };
        for text in [text.trim_end().to_owned(), text.clone() + "1\n\nanother frame\n"] {
            let found = read(Trickle(text.as_bytes()), 0, "atoms.xyz", Options::default()).unwrap();
            assert_eq!(found.spheres.len(), count as usize);
            assert!((0..count).zip(&found.spheres).all(|(index, sphere)| *sphere == expected(index)));
        }
    }

    #[test]
    fn labels_are_read_by_their_letters_and_told() {
        let text = "6\n\nOW 0 0 0\nHW1 1 0 0\nC1 2 0 0\nD 3 0 0\nX 4 0 0\nHW1 5 0 0\n";
        let found = parse(text, Options::default()).unwrap();
        let radii: Vec<f64> = found.spheres.iter().map(Sphere::radius).collect();
        assert_eq!(radii, [1.5, 1.2, 1.77, 1.2, 0.5, 1.2]);
        let note = r#"names are read by their letters: "OW" as O, "HW1" as H, "C1" as C, "X" as a dummy atom"#;
        assert_eq!(found.warnings, [note]);
        // A long list is cut, at the same place however the file is cut into pieces.
        let mut text = "100000\n\n".to_owned();
        (0..100_000).for_each(|k| text += &format!("C{k} 0 0 0 and so on, to make it long\n"));
        let [note] = &parse(&text, Options::default()).unwrap().warnings[..] else { panic!("one note") };
        assert!(note.ends_with(r#""C6" as C, "C7" as C and more"#), "{note}");
    }

    #[test]
    fn a_mark_and_empty_lines_may_come_first() {
        for start in ["\u{feff}", "\n", "\u{feff}\n \r\n\n"] {
            let found = parse(&format!("{start}1\n\nC 1 2 3\n"), Options::default()).unwrap();
            assert_eq!(found.spheres, [sphere(1.0, 2.0, 3.0, 1.77)], "{start:?}");
        }
        let error = parse("\n\n1\n\nC 1 2 three\n", Options::default()).unwrap_err();
        assert_eq!(error.to_string(), "atoms.xyz:5: expected a number, found \"three\"");
        let error = read(&b"\xff\xfe1\0"[..], 0, "atoms.xyz", Options::default()).unwrap_err();
        assert_eq!(error.to_string(), "atoms.xyz:1: UTF-16 text; save it as UTF-8");
    }

    #[test]
    fn what_follows_the_first_frame_is_told() {
        let notes = |text: &str| {
            let found = parse(text, Options::default()).unwrap();
            assert!(found.notes.is_empty() || found.warnings.is_empty(), "{found:?}");
            [found.notes, found.warnings].concat()
        };
        let frame = "1\n\nC 1 2 3\n";
        assert!(notes(&format!("{frame}\n \n")).is_empty());
        assert_eq!(notes(&frame.repeat(3)), ["frame 1 is drawn; another one follows in line 4 (--frame)"]);
        let second = |frame| parse("1\n\nC 1 2 3\n\n2\n\nN 1 2 3\nO 4 5 6\n", Options { frame, ..Options::default() });
        let found = second(2).unwrap();
        assert_eq!(found.spheres, [sphere(1.0, 2.0, 3.0, 1.66), sphere(4.0, 5.0, 6.0, 1.5)]);
        assert!(found.notes.is_empty(), "{:?}", found.notes);
        assert_eq!(second(3).unwrap_err().to_string(), "atoms.xyz:9: there is no frame 3; the file has 2");
        assert_eq!(notes(&format!("{frame}\nC 1 2 3")), ["what follows the last atom is passed over, from line 5 on"]);
        let long = format!("{frame}{}", "C".repeat(BUFFER + 1));
        assert_eq!(notes(&long), ["what follows the last atom is passed over, from line 4 on"]);
    }

    #[test]
    fn a_count_beyond_the_memory_is_an_error() {
        // The length of a file with holes can be anything.
        let error = read(&b"1000000000000000000\n\nC 0 0 0\n"[..], u64::MAX, "atoms.xyz", Options::default());
        assert_eq!(error.unwrap_err().to_string(), "atoms.xyz:2: not enough memory for 1000000000000000000 atoms");
    }

    #[test]
    fn an_error_far_into_a_file_names_its_line() {
        let mut text = "200000\n\n".to_owned();
        for index in 0..200_000 {
            text += if index == 123_456 { "C 1 2 three\n" } else { "C 1 2 3 and so on, to make it long\n" };
        }
        let error = parse(&text, Options::default()).unwrap_err();
        assert_eq!(error.to_string(), "atoms.xyz:123459: expected a number, found \"three\"");
    }
}
