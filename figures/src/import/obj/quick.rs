//! Lines of vertices and faces, read in parallel.
//!
//! A block of the file is cut into pieces of whole statements, and each piece is read by itself: vertices, and faces
//! with their corners as written. [`ObjReader::append`] then takes the pieces in order. Here a statement of another kind,
//! or one with a fault, is only noted: `append` passes it to [`ObjReader::statement`], which decides every such case.

use std::io::{self, Read};
use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use super::super::blocks::{BLOCK, PIECE};
use super::super::mesh::Vertices;
use super::super::problem::{LONGEST_LINE, LineProblem};
use super::super::words::Scanner;
use super::statement::{ObjReader, PASSED_OVER, statement};

/// Whole statements of the file, and what was read of them.
#[derive(Default)]
pub(super) struct Block {
    text: Vec<u8>,
    pieces: Vec<Piece>,
}

/// What was read from a part of a block. Numbers count from its start.
#[derive(Default)]
struct Piece {
    place: Range<usize>,
    vertices: Vertices,
    faces: Vec<Face>,
    /// The corners of all faces: the position of a vertex in the file or, with [`BACK`], how far back it is.
    corners: Vec<u32>,
    /// The statements that were only noted.
    others: Vec<Other>,
    /// Bit `k` is set if `PASSED_OVER[k]` occurs.
    passed_over: u32,
    lines: usize,
}

/// The bit of a corner that counts back from the last vertex.
const BACK: u32 = 1 << 31;

struct Face {
    /// Where its corners end.
    corners: u32,
    /// The vertices above.
    vertices: u32,
    at: Place,
}

struct Other {
    /// The vertices and faces above.
    vertices: usize,
    faces: usize,
    at: Place,
}

/// Where a statement begins: the byte in the piece, and how many lines are above.
#[derive(Clone, Copy)]
struct Place {
    byte: u32,
    line: u32,
}

/// Numbers in a block fit 32 bits.
fn short(number: usize) -> u32 {
    u32::try_from(number).expect("a block has far fewer bytes")
}

impl Block {
    /// Whether there is nothing left to read.
    pub(super) fn is_empty(&self) -> bool {
        self.text.is_empty()
    }

    /// Takes whole statements from the source and reads them; none at the end. An error of reading comes after the
    /// statements before it.
    pub(super) fn fill(&mut self, source: &mut impl Read, rest: &mut Rest) -> io::Result<()> {
        let text = &mut self.text;
        text.clear();
        if let Some(error) = rest.failed.take() {
            return Err(error);
        }
        text.append(&mut rest.start);
        let mut size = BLOCK;
        let end = loop {
            let missing = size.saturating_sub(text.len()) as u64;
            let ended = match source.take(missing).read_to_end(text) {
                Ok(read) => (read as u64) < missing,
                Err(error) => {
                    rest.failed = Some(error);
                    break last_end(text).unwrap_or(0);
                }
            };
            if ended {
                break text.len();
            }
            if let Some(end) = last_end(text) {
                break end;
            }
            if text.len() >= LONGEST_STATEMENT {
                break text.len();
            }
            size *= 2;
        };
        if rest.failed.is_none() {
            rest.start.extend_from_slice(&text[end..]);
        }
        text.truncate(end);
        if text.is_empty()
            && let Some(error) = rest.failed.take()
        {
            return Err(error);
        }
        let places = cut(text);
        self.pieces.resize_with(places.len(), Piece::default);
        self.pieces.par_iter_mut().zip(places).for_each(|(piece, place)| piece.read(text, place));
        Ok(())
    }
}

/// What is left of the source behind a block.
#[derive(Default)]
pub(super) struct Rest {
    /// The start of the next statement.
    start: Vec<u8>,
    /// Why there is no more.
    failed: Option<io::Error>,
}

/// No statement takes more bytes than this without being too long: each byte may be a line that goes on in the next.
const LONGEST_STATEMENT: usize = 4 * LONGEST_LINE;

/// Where the last whole statement ends.
fn last_end(text: &[u8]) -> Option<usize> {
    let plain = memchr::memrchr_iter(b'\n', text).map(|at| at + 1).find(|&end| ends_plainly(&text[..end]));
    plain.or_else(|| {
        // Each line ends in a backslash: only from the start on is it known which ones go on.
        let (mut left, mut end) = (text, None);
        let mut bytes = Vec::new();
        while let Ok(true) = statement(&mut left, &mut bytes, &mut 0) {
            if left.is_empty() {
                break;
            }
            end = Some(text.len() - left.len());
        }
        end
    })
}

/// Whether the last line of the text has no backslash at its end, so that it surely does not continue.
fn ends_plainly(text: &[u8]) -> bool {
    let line = text.strip_suffix(b"\n").unwrap_or(text);
    !line.strip_suffix(b"\r").unwrap_or(line).ends_with(b"\\")
}

/// Cuts whole statements into pieces of whole statements.
fn cut(text: &[u8]) -> Vec<Range<usize>> {
    let size = (text.len() / rayon::current_num_threads()).max(PIECE);
    let (mut start, mut pieces) = (0, Vec::new());
    while start < text.len() {
        let later = text.get(start + size..).unwrap_or_default();
        let mut ends = memchr::memchr_iter(b'\n', later).map(|at| start + size + at + 1);
        let end = ends.find(|&end| ends_plainly(&text[..end])).unwrap_or(text.len());
        pieces.push(start..end);
        start = end;
    }
    pieces
}

impl Piece {
    fn clear(&mut self) {
        let Self { vertices, faces, corners, others, .. } = self;
        vertices.clear();
        faces.clear();
        corners.clear();
        others.clear();
        (self.passed_over, self.lines) = (0, 0);
    }

    fn read(&mut self, text: &[u8], place: Range<usize>) {
        self.clear();
        let text = &text[place.clone()];
        let is_first = place.start == 0;
        self.place = place;
        let mut bytes = Vec::new();
        let mut scanner = Scanner::new(text);
        while scanner.position() < text.len() {
            let start = scanner.position();
            let at = Place { byte: short(start), line: short(self.lines) };
            // (The first statement of the file may have a byte-order mark before it.)
            if start > 0 || !is_first {
                if self.quick(&mut scanner, at).is_some() {
                    self.lines += 1;
                    continue;
                }
                self.corners.truncate(self.faces.last().map_or(0, |face| face.corners as usize));
            }
            self.others.push(Other { vertices: self.vertices.len(), faces: self.faces.len(), at });
            let mut rest = &text[start..];
            statement(&mut rest, &mut bytes, &mut self.lines).expect("memory can be read");
            scanner.set_position(text.len() - rest.len());
        }
    }

    /// Reads a line; `None` if that is not for this way of reading.
    #[inline]
    fn quick(&mut self, scanner: &mut Scanner, at: Place) -> Option<()> {
        match scanner.next() {
            b'\n' => scanner.end_line(),
            // A comment goes on in no other line.
            b'#' => {
                scanner.skip_line();
                Some(())
            }
            _ => match scanner.word()? {
                b"v" => self.vertex(scanner),
                b"f" => self.face(scanner, at),
                b"mtllib" | b"usemtl" => None,
                keyword => {
                    let known = |(_, keywords): &(_, &[&str])| keywords.iter().any(|word| word.as_bytes() == keyword);
                    scanner.skip_line();
                    if !ends_plainly(scanner.before()) {
                        return None;
                    }
                    if let Some(at) = PASSED_OVER.iter().position(known) {
                        self.passed_over |= 1 << at;
                    }
                    Some(())
                }
            },
        }
    }

    #[inline]
    fn vertex(&mut self, scanner: &mut Scanner) -> Option<()> {
        let position = three_of(scanner).filter(|position| position.is_finite())?;
        let color = if scanner.next() == b'\n' {
            None
        } else {
            Some(three_of(scanner).filter(|c| c.cmpge(DVec3::ZERO).all() && c.cmple(DVec3::ONE).all())?)
        };
        scanner.end_line()?;
        self.vertices.push(position, color);
        Some(())
    }

    #[inline]
    fn face(&mut self, scanner: &mut Scanner, at: Place) -> Option<()> {
        let first = self.corners.len();
        while scanner.next() != b'\n' {
            let (back, number) = scanner.whole()?;
            let number = u32::try_from(number).ok().filter(|number| (1..BACK).contains(number))?;
            self.corners.push(if back { BACK | number } else { number - 1 });
        }
        if self.corners.len() < first + 3 {
            return None;
        }
        scanner.end_line()?;
        // (What follows a slash may end in a backslash.)
        if !ends_plainly(scanner.before()) {
            return None;
        }
        self.faces.push(Face { corners: short(self.corners.len()), vertices: short(self.vertices.len()), at });
        Some(())
    }
}

fn three_of(scanner: &mut Scanner) -> Option<DVec3> {
    Some(DVec3::new(scanner.number()?, scanner.number()?, scanner.number()?))
}

impl ObjReader {
    /// Appends what was read of a block; `line`, the number of its first line, becomes that of the line with an error or
    /// of the first one behind.
    pub(super) fn append(&mut self, block: &Block, line: &mut usize) -> Result<(), LineProblem> {
        let mut bytes = Vec::new();
        for piece in &block.pieces {
            let text = &block.text[piece.place.clone()];
            let first = *line;
            self.passed_over |= piece.passed_over;
            let (mut vertices, mut faces) = (0, 0);
            for other in &piece.others {
                self.run(piece, vertices..other.vertices, faces..other.faces, text, line, first)?;
                (vertices, faces) = (other.vertices, other.faces);
                *line = first + other.at.line as usize;
                self.one(&text[other.at.byte as usize..], &mut bytes, *line)?;
            }
            self.run(piece, vertices..piece.vertices.len(), faces..piece.faces.len(), text, line, first)?;
            *line = first + piece.lines;
        }
        Ok(())
    }

    /// Appends a run of vertices and faces with no other statement between them.
    fn run(
        &mut self,
        piece: &Piece,
        vertices: Range<usize>,
        faces: Range<usize>,
        text: &[u8],
        line: &mut usize,
        first: usize,
    ) -> Result<(), LineProblem> {
        let above = self.vertices.len();
        let start = vertices.start;
        self.vertices.append(&piece.vertices, vertices).map_err(|_| LineProblem::MeshMemory)?;
        let mut corner = faces.start.checked_sub(1).map_or(0, |before| piece.faces[before].corners as usize);
        for face in &piece.faces[faces] {
            let known = above + face.vertices as usize - start;
            let at = first + face.at.line as usize;
            let end = face.corners as usize;
            self.corners.clear();
            for &number in &piece.corners[corner..end] {
                let back = || known.checked_sub((number & !BACK) as usize);
                let position = if number & BACK == 0 { Some(number as usize) } else { back() };
                let Some(position) = position else {
                    *line = at;
                    self.vertices.truncate(known);
                    return self.one(&text[face.at.byte as usize..], &mut Vec::new(), at);
                };
                self.corners.push(position);
            }
            corner = end;
            self.face(at, known).inspect_err(|_| *line = at)?;
        }
        Ok(())
    }

    /// Reads the statement at the start of a text, which begins in this line.
    fn one(&mut self, mut text: &[u8], bytes: &mut Vec<u8>, line: usize) -> Result<(), LineProblem> {
        statement(&mut text, bytes, &mut 0).expect("memory can be read");
        if bytes.len() == LONGEST_LINE && !bytes.ends_with(b"\n") {
            return Err(LineProblem::Long);
        }
        self.statement(bytes, line)
    }
}
