//! Spheres from XYZ files, plain and extended: molecules and particles by the million.
//!
//! A file is a line with the number of atoms, a line of comment, then a line for each atom. In a plain file that is
//! `element x y z`, and the rest of the line is ignored. In an extended one the comment has
//! `Properties=name:type:columns` groups, joined by colons, that say what the columns are; of these `species`, `pos`,
//! `radius` and `color` are read (`element`, `type` and capitals will do too). One frame of several is read, the first
//! unless another is asked for; a note says what follows it. Empty lines may stand before a frame. `elements.rs` has the
//! rule for names that are not symbols.
//!
//! The file streams through a buffer of a megabyte, or more where a line is longer. Each filling ends at a line's end, is
//! cut into pieces at lines' ends, and the pieces are read in parallel; what they hold is appended in order while the
//! next filling is read. So memory is the spheres and the buffer, and the result does not depend on threads.
//!
//! There are two ways to read a line: a quick one, which takes numbers where they stand, and `Columns::atom`, which
//! takes the line apart and says what is wrong with it. The quick one leaves to it every line that is not as expected.

use std::io::Read;

use glam::DVec3;
use rayon::prelude::*;
use rt_geom::Sphere;

use super::blocks::{LineBlocks, PIECE};
use super::elements::{self, ElementName, Found};
use super::problem::{Broken, FileProblem, ImportError, LineProblem};
use super::spheres::{AtomColor, Names, Options, Palette, Spheres};
use super::words::{Scanner, Words, number, shown};
use crate::text::without_mark;

/// Reads spheres from `source`, which errors call `name` and which has about `length` bytes (0: unknown).
///
/// # Errors
/// What is wrong, with the line.
pub fn read(source: impl Read + Send, length: u64, name: &str, options: Options) -> Result<Spheres, ImportError> {
    let mut blocks = LineBlocks::new(source);
    let mut line = 0;
    read_lines(&mut blocks, length, options, &mut line).map_err(|failure| match failure {
        Broken::Read(source) => FileProblem::Read { path: name.to_owned(), source }.into(),
        Broken::Line(problem) => ImportError::in_line(name, line, problem),
    })
}

/// Reads the file; on failure `line` is where.
fn read_lines(
    blocks: &mut LineBlocks<impl Read + Send>,
    length: u64,
    options: Options,
    line: &mut usize,
) -> Result<Spheres, Broken> {
    let (expected, comment) = head(blocks, options.frame, line)?;
    let layout = Columns::of(&comment, options)?;

    let mut found = Spheres::default();
    let no_memory = |_| LineProblem::SphereMemory(expected);
    // An atom takes eight bytes at least, so a false count reserves no more than the file is worth.
    let likely = usize::try_from(expected.min(length / 8)).unwrap_or(0);
    found.spheres.try_reserve_exact(likely).map_err(no_memory)?;
    found.color_indices.try_reserve_exact(likely).map_err(no_memory)?;
    let mut merge = Merge { found, palette: Palette::default(), names: Names::default(), line: *line + 1 };
    // While the atoms of one block are appended, the next is read. Both lists keep their memory.
    let (mut ready, mut next): (Vec<AtomPiece>, Vec<AtomPiece>) = (Vec::new(), Vec::new());
    let mut missing = expected;
    loop {
        let (merged, read) = rayon::join(
            || ready.iter_mut().try_for_each(|piece| merge.append(piece, &layout, expected)),
            || layout.block(blocks, missing, &mut next),
        );
        *line = merge.line;
        merged?;
        missing = read?;
        if next.is_empty() {
            break;
        }
        std::mem::swap(&mut ready, &mut next);
    }
    let Merge { mut found, names, .. } = merge;
    if missing > 0 {
        return Err(LineProblem::Short { expected, found: found.spheres.len() as u64 }.into());
    }
    found.warnings.extend(names.note());
    what_follows(blocks, *line, options.frame, &mut found)?;
    Ok(found)
}

/// Reads up to the first atom of the frame asked for; returns how many atoms it has, and its comment, which is the
/// line `line`, as is one with an error.
fn head(blocks: &mut LineBlocks<impl Read>, asked: u64, line: &mut usize) -> Result<(u64, String), Broken> {
    *line = 1;
    let mut header = without_mark(blocks.line()?).map_err(LineProblem::Utf16)?.to_vec();
    let mut frame = 1;
    loop {
        while header.trim_ascii().is_empty() && !blocks.is_empty()? {
            *line += 1;
            header = blocks.line()?.to_vec();
        }
        if frame > 1 && header.trim_ascii().is_empty() {
            return Err(LineProblem::Frames { frame: asked, found: frame - 1 }.into());
        }
        let expected = text(&header).parse::<u64>().map_err(|_| LineProblem::Count(shown(&header)))?;
        *line += 1;
        let comment = String::from_utf8_lossy(blocks.line()?).into_owned();
        if frame == asked {
            return Ok((expected, comment));
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
    }
}

/// What was appended so far.
struct Merge {
    found: Spheres,
    palette: Palette,
    names: Names,
    /// The number of the next line.
    line: usize,
}

impl Merge {
    /// Appends the atoms of the next piece; on failure `line` is where.
    fn append(&mut self, piece: &mut AtomPiece, layout: &Columns, expected: u64) -> Result<(), LineProblem> {
        let no_memory = |_| LineProblem::SphereMemory(expected);
        let count = piece.spheres.len();
        self.found.spheres.try_reserve(count).map_err(no_memory)?;
        self.found.color_indices.try_reserve(count).map_err(no_memory)?;
        self.found.spheres.extend_from_slice(&piece.spheres);
        let first = self.line;
        for at in 0..count {
            let paint = match layout.painted() {
                Painted::Own => AtomColor::Color(piece.colors[at]),
                Painted::AsElements => AtomColor::Element(piece.elements[at]),
                Painted::Alike => AtomColor::Nothing,
            };
            self.line = first + at;
            self.found.color_indices.push(self.palette.index(paint, &mut self.found.colors)?);
        }
        self.line = first + count;
        for (name, element) in &piece.names.0 {
            self.names.add(name, *element);
        }
        piece.problem.take().map_or(Ok(()), Err)
    }
}

/// Cuts a block of whole lines into pieces of whole lines, at most `lines` lines in all.
fn cut(block: &[u8], lines: usize) -> Vec<&[u8]> {
    let size = (block.len() / rayon::current_num_threads()).max(PIECE);
    let mut rest = block;
    let mut pieces = Vec::new();
    while !rest.is_empty() {
        let end = match rest.get(size..).and_then(|later| memchr::memchr(b'\n', later)) {
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
        let count = memchr::memchr_iter(b'\n', piece).count();
        if count > left {
            let end = left.checked_sub(1).and_then(|last| memchr::memchr_iter(b'\n', piece).nth(last));
            *piece = &piece[..end.map_or(0, |end| end + 1)];
        }
        left -= count.min(left);
    }
    pieces
}

/// Says what follows the last atom, if it is more than space; `line` is the next one's number.
fn what_follows(
    blocks: &mut LineBlocks<impl Read>,
    mut line: usize,
    frame: u64,
    found: &mut Spheres,
) -> Result<(), Broken> {
    while !blocks.is_empty()? {
        let next = match blocks.line() {
            Ok(next) => next.trim_ascii(),
            // A line without an end is something that follows too.
            Err(Broken::Line(_)) => b"...",
            Err(failure) => return Err(failure),
        };
        if !next.is_empty() {
            match text(next).parse::<u64>() {
                Ok(_) => {
                    found.notes.push(format!("frame {frame} is drawn; another one follows in line {line} (--frame)"));
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

/// What a column is to the quick way of reading.
#[derive(Clone, Copy)]
enum Slot {
    /// The place of its number: 0 to 2 the position, 3 the radius, 4 to 6 the colour.
    Number(usize),
    Name,
    Other,
}

/// Where the colours of atoms come from.
#[derive(Clone, Copy, PartialEq)]
enum Painted {
    Own,
    AsElements,
    Alike,
}

/// What was read from a piece of a file: atoms, and the error in the line after them, if any.
#[derive(Default)]
struct AtomPiece {
    spheres: Vec<Sphere>,
    /// The elements, or the colours, where [`Painted`] says so.
    elements: Vec<u8>,
    colors: Vec<DVec3>,
    names: Names,
    problem: Option<LineProblem>,
}

impl AtomPiece {
    fn clear(&mut self) {
        let Self { spheres, elements, colors, names, problem } = self;
        spheres.clear();
        elements.clear();
        colors.clear();
        names.0.clear();
        *problem = None;
    }

    fn push(&mut self, (sphere, paint): (Sphere, AtomColor)) {
        self.spheres.push(sphere);
        match paint {
            AtomColor::Element(element) => self.elements.push(element),
            AtomColor::Color(color) => self.colors.push(color),
            AtomColor::Nothing => {}
        }
    }
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

    fn painted(&self) -> Painted {
        match (self.color, self.element) {
            (Some(_), _) => Painted::Own,
            (None, Some(_)) if self.options.colored => Painted::AsElements,
            (None, _) => Painted::Alike,
        }
    }

    /// Whether something depends on an atom's element; only then it has to be known.
    fn needs_element(&self) -> bool {
        self.painted() == Painted::AsElements || (self.radius.is_none() && self.options.radius.is_none())
    }

    fn slots(&self) -> Vec<Slot> {
        let slot = |at: usize| match at {
            _ if self.color.is_some_and(|first| (first..first + 3).contains(&at)) => {
                Slot::Number(4 + at - self.color.unwrap_or(at))
            }
            _ if self.radius == Some(at) => Slot::Number(3),
            _ if (self.position..self.position + 3).contains(&at) => Slot::Number(at - self.position),
            _ if self.element == Some(at) && self.needs_element() => Slot::Name,
            _ => Slot::Other,
        };
        (0..self.columns).map(slot).collect()
    }

    /// Reads the next block, at most so many atoms of it, into pieces; returns how many are still missing. There are no
    /// pieces at the end.
    fn block(
        &self,
        blocks: &mut LineBlocks<impl Read>,
        missing: u64,
        pieces: &mut Vec<AtomPiece>,
    ) -> Result<u64, Broken> {
        if missing == 0 {
            pieces.clear();
            return Ok(0);
        }
        let block = blocks.next()?;
        let texts = cut(block, usize::try_from(missing).unwrap_or(usize::MAX));
        let behind = block.len() - texts.iter().map(|text| text.len()).sum::<usize>();
        pieces.resize_with(texts.len(), AtomPiece::default);
        let slots = self.slots();
        pieces.par_iter_mut().zip(texts).for_each(|(piece, text)| self.atoms(text, &slots, piece));
        blocks.take_back(behind);
        Ok(missing - pieces.iter().map(|piece| piece.spheres.len() as u64).sum::<u64>())
    }

    /// Reads whole lines.
    fn atoms(&self, lines: &[u8], slots: &[Slot], piece: &mut AtomPiece) {
        piece.clear();
        let mut columns = Vec::with_capacity(self.columns);
        let mut found = Found::default();
        let mut scanner = Scanner::new(lines);
        while scanner.position() < lines.len() {
            let start = scanner.position();
            if let Some(atom) = self.quick_atom(&mut scanner, slots, &mut found, &mut piece.names) {
                piece.push(atom);
                continue;
            }
            scanner.set_position(start);
            scanner.skip_line();
            match self.atom(&lines[start..scanner.position()], &mut columns, &mut piece.names) {
                Ok(atom) => piece.push(atom),
                Err(problem) => {
                    piece.problem = Some(problem);
                    return;
                }
            }
        }
    }

    /// Reads a line as [`Self::atom`] does, if nothing is wrong with it; otherwise that says what.
    fn quick_atom(
        &self,
        scanner: &mut Scanner,
        slots: &[Slot],
        found: &mut Found,
        names: &mut Names,
    ) -> Option<(Sphere, AtomColor)> {
        let (mut values, mut name) = ([0.0; 8], &b""[..]);
        for &slot in slots {
            match slot {
                Slot::Number(at) => values[at % 8] = scanner.number()?,
                Slot::Name => name = scanner.word()?,
                Slot::Other => drop(scanner.word()?),
            }
        }
        scanner.skip_line();
        let [x, y, z, own_radius, red, green, blue, _] = values;
        let element = match self.element.filter(|_| self.needs_element()) {
            Some(_) => match found.find(name)? {
                ElementName::Plain(element) => Some(element),
                ElementName::Label(element) => {
                    names.add(name, element);
                    Some(element)
                }
            },
            None => None,
        };
        let radius = match (self.radius, self.options.radius) {
            (Some(_), _) => own_radius,
            (None, Some(radius)) => radius,
            (None, None) => elements::radius(element?),
        };
        let color = DVec3::new(red, green, blue);
        let is_color = color.cmpge(DVec3::ZERO).all() && color.cmple(DVec3::ONE).all();
        if !is_color || radius < 0.0 {
            return None;
        }
        let sphere = Sphere::new(self.options.scale * DVec3::new(x, y, z), self.options.scale * radius).ok()?;
        let paint = match self.painted() {
            Painted::Own => AtomColor::Color(color),
            Painted::AsElements => element.map_or(AtomColor::Nothing, AtomColor::Element),
            Painted::Alike => AtomColor::Nothing,
        };
        Some((sphere, paint))
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
        let element = match self.element.filter(|_| self.needs_element()) {
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
    use std::io;

    use super::super::problem::LONGEST_LINE;
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
        let long = format!("{frame}{}", "C".repeat(LONGEST_LINE + 1));
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

    /// Reads the first frame line by line, with the library's own parser: positions and radii, or the error.
    fn read_slowly(text: &str, colored: bool) -> Result<Vec<[f64; 4]>, String> {
        let mut lines = text.split_inclusive('\n').zip(1..);
        let (count, comment) = (lines.next().unwrap().0.trim().parse::<usize>().unwrap(), lines.next().unwrap().0);
        let mut found = Vec::new();
        for (line, place) in lines.take(count) {
            found.push(
                ball_slowly(line, comment.trim().is_empty(), colored).map_err(|e| format!("atoms.xyz:{place}: {e}"))?,
            );
        }
        if found.len() < count {
            let place = found.len() + 3;
            return Err(format!("atoms.xyz:{place}: the file ends after {} of {count} atoms", found.len()));
        }
        Ok(found)
    }

    /// The columns of a line: a name and a position, or a position, a radius and perhaps a colour.
    fn columns(named: bool, colored: bool) -> usize {
        if colored && !named { 7 } else { 4 }
    }

    /// Reads such a line.
    fn ball_slowly(line: &str, named: bool, colored: bool) -> Result<[f64; 4], String> {
        let words: Vec<&str> = line.split(|c: char| c.is_ascii_whitespace()).filter(|word| !word.is_empty()).collect();
        let (first, expected) = (usize::from(named), columns(named, colored));
        if words.len() < expected {
            return Err(format!("expected {expected} columns, found {}", words.len()));
        }
        let number =
            |at: usize| words[at].parse::<f64>().map_err(|_| format!("expected a number, found {:?}", words[at]));
        let center = [number(first)?, number(first + 1)?, number(first + 2)?];
        if !center.iter().all(|x| x.is_finite()) {
            return Err(format!(
                "position must be finite, found {}",
                shown(words[first..first + 3].join(" ").as_bytes())
            ));
        }
        if colored {
            let color = [number(4)?, number(5)?, number(6)?];
            if let Some(channel) = color.iter().find(|channel| !(0.0..=1.0).contains(*channel)) {
                return Err(format!("color must be from 0 to 1, found {channel}"));
            }
        }
        let radius = match (named, words[0]) {
            (false, _) => number(3)?,
            (true, "C") => 1.77,
            (true, "OW") => 1.5,
            (true, "Cl") => 1.82,
            (true, word) => {
                let expected = "expected a symbol such as C, a label such as C1 or OW, or an atomic number";
                return Err(format!("unknown element {word:?}; {expected}"));
            }
        };
        match radius {
            ..0.0 => Err(format!("radius must not be negative, found {radius}")),
            0.0..f64::INFINITY => Ok([center[0], center[1], center[2], radius]),
            _ => Err(format!("radius must be finite, found {radius}")),
        }
    }

    #[test]
    fn the_quick_way_reads_as_the_slow_one_does() {
        let random = &mut oracle::Random::new(32);
        let (mut good, rounds) = (0, oracle::cases(100_000) / 10);
        for round in 0..rounds {
            let plain = random.one_in(2);
            let colored = !plain && random.one_in(2);
            let comment = match (plain, colored) {
                (true, _) => "",
                (_, false) => "Properties=pos:R:3:radius:R:1",
                (_, true) => "Properties=pos:R:3:radius:R:1:color:R:3",
            };
            let hostile = random.pick(&[20, 200, 2000, u64::MAX]);
            let count = 1 + random.below(if round % 8 == 0 { 600 } else { 60 });
            let mut text = format!("{}\n{comment}\n", if random.one_in(20) { count + 1 } else { count });
            for _ in 0..count {
                let blank = random.pick(&[" ", " ", " ", "\t", "  ", " \t", "\x0c"]);
                let mut words = Vec::new();
                if plain {
                    words.push(random.pick(&["C", "C", "OW", "Cl"]).to_owned());
                }
                for at in 0..columns(plain, colored) - usize::from(plain) {
                    let limit = if at < 3 { -20.0 } else { 0.0 };
                    words.push(match (at, random.below(5)) {
                        (4.., _) => format!("{:.3}", random.share()),
                        (_, 0) => format!("{:?}", random.within(limit, 20.0)),
                        (_, 1) => format!("{:e}", random.within(limit, 20.0)),
                        (_, digits) => format!("{:.*}", 3 * (digits - 2), random.within(limit, 20.0)),
                    });
                }
                if random.one_in(hostile) {
                    // And an empty one.
                    let parts = " -1 +.5 -0 1e999 nan -inf 0x10 1,5 1e --1 1.5.5 \u{b2} 999999999999999999999";
                    let parts: Vec<&str> = parts.split(' ').collect();
                    let at = usize::from(plain) + random.below(words.len() - usize::from(plain));
                    words[at] = random.pick(&parts).to_owned();
                }
                text += &(words.join(blank) + random.pick(&["\n", "\n", "\r\n", " \n", " and more\n"]));
            }
            if random.one_in(4) {
                text.pop();
            }
            let quickly = parse(&text, Options::default());
            let quickly = quickly.map(|found| {
                let sphere =
                    |sphere: &Sphere| [sphere.center().x, sphere.center().y, sphere.center().z, sphere.radius()];
                found.spheres.iter().map(|s| sphere(s).map(f64::to_bits)).collect::<Vec<_>>()
            });
            let slowly = read_slowly(&text, colored);
            let slowly = slowly.map(|found| found.into_iter().map(|ball| ball.map(f64::to_bits)).collect::<Vec<_>>());
            good += usize::from(slowly.is_ok());
            assert_eq!(quickly.map_err(|error| error.to_string()), slowly, "{text:?}");
        }
        assert!((rounds / 10..rounds).contains(&good), "{good} of {rounds}");
    }
}
