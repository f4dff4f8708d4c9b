//! Triangles from STL files, text and binary.
//!
//! Text is `solid`, then facets of `vertex x y z` three times in a loop, and may have several solids. Binary is 80 bytes
//! of anything, a count, and 50 bytes for each triangle, in little-endian floats of 32 bits. Normals are passed over:
//! they follow from the vertices. So are the colours that some programs put into a facet's last two bytes.

use std::io::{self, BufRead, Read};

use glam::DVec3;

use super::blocks::next_record;
use super::mesh::{FaceColor, Faces, Mesh, Vertices};
use super::problem::{FileProblem, ImportError, LineProblem};
use super::words::{Words, number, shown};

/// Bytes of a binary file before its first triangle.
const HEADER: usize = 84;

/// Reads a mesh from `source`, which errors call `name`.
///
/// # Errors
/// What is wrong, with the line, or with the number of the triangle.
pub fn read(mut source: impl BufRead, name: &str) -> Result<Mesh, ImportError> {
    let failed = |source| FileProblem::Read { path: name.to_owned(), source };
    let mut start = Vec::new();
    source.by_ref().take(HEADER as u64).read_to_end(&mut start).map_err(failed)?;
    let buffered = source.fill_buf().map_err(failed)?;
    let mesh = if is_text(&start, buffered) {
        text(io::Cursor::new(start).chain(source), name)?
    } else {
        binary(&start, source, name)?
    };
    mesh.some(name)
}

/// Whether a file is text that begins with these bytes. A binary one may begin with `solid` too.
pub(super) fn is_text(start: &[u8], more: &[u8]) -> bool {
    let more = &more[..more.len().min(512)];
    let first = start.trim_ascii_start().get(..5).unwrap_or_default();
    first.eq_ignore_ascii_case(b"solid") && !start.contains(&0) && !more.contains(&0)
}

/// Whether a file that begins with these bytes can be a binary STL: its first triangles are ordinary numbers.
pub(super) fn can_be_binary(start: &[u8]) -> bool {
    let Some((head, rest)) = start.split_at_checked(HEADER) else { return false };
    let count = u32::from_le_bytes([head[80], head[81], head[82], head[83]]);
    let ordinary = |number: f32| number == 0.0 || (1e-20..1e20).contains(&number.abs());
    let facets = rest.as_chunks::<50>().0;
    !facets.is_empty() && count > 0 && facets.iter().take(count as usize).all(|facet| floats(facet).all(ordinary))
}

/// The twelve numbers of a facet.
fn floats(facet: &[u8; 50]) -> impl Iterator<Item = f32> {
    facet.as_chunks::<4>().0.iter().map(|&bytes| f32::from_le_bytes(bytes))
}

fn text(mut source: impl BufRead, name: &str) -> Result<Mesh, ImportError> {
    let (mut mesh, mut faces) = (Mesh::default(), Faces::default());
    let (mut bytes, mut line) = (Vec::new(), 0);
    let mut corners = Vertices::default();
    while next_record(&mut source, &mut bytes, &mut line, name)? {
        let refuse = |problem| ImportError::in_line(name, line, problem);
        let mut words = Words(&bytes);
        let Some(keyword) = words.next() else { continue };
        match keyword.to_ascii_lowercase().as_slice() {
            b"vertex" => {
                let numbers: Vec<f64> = words.map(number).collect::<Result<_, _>>().map_err(refuse)?;
                let &[x, y, z] = &numbers[..] else { return Err(refuse(LineProblem::Corner(numbers.len()))) };
                let corner = DVec3::new(x, y, z);
                if !corner.is_finite() {
                    return Err(refuse(LineProblem::Coordinate));
                }
                if corners.len() == 3 {
                    return Err(refuse(LineProblem::Loop(4)));
                }
                corners.push(corner, None);
            }
            b"endloop" => {
                if corners.len() != 3 {
                    return Err(refuse(LineProblem::Loop(corners.len())));
                }
                let added = faces.add(&mut mesh, &[0, 1, 2], &corners, FaceColor::Unsaid);
                added.map_err(refuse)?;
                corners.clear();
            }
            b"solid" | b"facet" | b"outer" | b"endfacet" | b"endsolid" => {}
            // Between the solids of a file some programs write more.
            b"color" | b"end" => {}
            _ => return Err(refuse(LineProblem::StlKeyword(shown(keyword)))),
        }
    }
    if corners.is_empty() {
        return Ok(mesh);
    }
    Err(ImportError::in_line(name, line, LineProblem::Loop(corners.len())))
}

fn binary(start: &[u8], mut source: impl Read, name: &str) -> Result<Mesh, ImportError> {
    let refuse = |what: String| FileProblem::Binary { path: name.to_owned(), what };
    let Some(count) = start.get(80..HEADER).and_then(|bytes| bytes.try_into().ok()).map(u32::from_le_bytes) else {
        return Err(refuse("neither a text that begins with solid nor 84 bytes long".to_owned()).into());
    };
    let (mut mesh, mut faces) = (Mesh::default(), Faces::default());
    let (mut corners, mut colored) = (Vertices::default(), false);
    for triangle in 1..=count {
        let mut facet = [0; 50];
        match source.read_exact(&mut facet) {
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => {
                return Err(refuse(format!("the file ends after {} of {count} triangles", triangle - 1)).into());
            }
            read => read.map_err(|source| FileProblem::Read { path: name.to_owned(), source })?,
        }
        let mut numbers = [0.0; 12];
        numbers.iter_mut().zip(floats(&facet)).for_each(|(place, number)| *place = f64::from(number));
        let positions = [3, 6, 9].map(|at| DVec3::new(numbers[at], numbers[at + 1], numbers[at + 2]));
        if !positions.iter().all(|corner| corner.is_finite()) {
            return Err(refuse(format!("triangle {triangle}: a coordinate must be finite")).into());
        }
        corners.clear();
        positions.into_iter().for_each(|corner| corners.push(corner, None));
        let added = faces.add(&mut mesh, &[0, 1, 2], &corners, FaceColor::Unsaid);
        added.map_err(|problem| refuse(problem.to_string()))?;
        colored |= facet[48..] != [0, 0];
    }
    if colored {
        mesh.passed_over.push("colors of facets");
    }
    if matches!(source.read(&mut [0]), Ok(1)) {
        mesh.notes.push("what follows the last triangle is passed over".to_owned());
    }
    Ok(mesh)
}

#[cfg(test)]
mod tests {
    use rt_geom::Triangle;

    use super::*;

    fn parse(bytes: &[u8]) -> Result<Mesh, ImportError> {
        read(bytes, "a.stl")
    }

    const FACET: &str =
        "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 1e0 0.5\n endloop\nendfacet\n";

    fn triangle() -> Triangle {
        Triangle::new(DVec3::ZERO, DVec3::X, DVec3::new(0.0, 1.0, 0.5)).unwrap()
    }

    /// A binary file of triangles, with these last bytes each.
    fn packed(head: &str, corners: &[[[f32; 3]; 3]], last: [u8; 2]) -> Vec<u8> {
        let mut bytes = format!("{head:80}").into_bytes();
        bytes.extend(u32::try_from(corners.len()).unwrap().to_le_bytes());
        for corners in corners {
            bytes.extend([0; 12]);
            bytes.extend(corners.as_flattened().iter().flat_map(|number| number.to_le_bytes()));
            bytes.extend(last);
        }
        bytes
    }

    #[test]
    fn text_and_binary_give_the_same_triangles() {
        let text =
            parse(format!("solid a b\n{FACET}endsolid a b\nSOLID c\n{}", FACET.to_uppercase()).as_bytes()).unwrap();
        assert_eq!(text.triangles, [triangle(), triangle()]);
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.5]];
        for head in ["", "solid made by a program that begins every file so\0"] {
            let bytes = packed(head, &[corners, corners], [0, 0]);
            assert_eq!(parse(&bytes).unwrap(), text, "{head:?}");
            assert!(can_be_binary(&bytes) && !is_text(&bytes[..84], &bytes[84..]));
        }
        let colored = parse(&packed("", &[corners], [1, 0x80])).unwrap();
        assert_eq!((colored.triangles.len(), &colored.passed_over[..]), (1, &["colors of facets"][..]));
    }

    #[test]
    fn what_is_wrong_is_told_with_its_place() {
        for (text, message) in [
            ("solid\nvertex 1 2\n", "a.stl:2: a vertex of a facet has 3 coordinates, found 2"),
            ("solid\nvertex 1 2 x\n", "a.stl:2: expected a number, found \"x\""),
            ("solid\nvertex 1 2 inf\n", "a.stl:2: a coordinate must be finite"),
            ("solid\nvertex 1 2 3\nendloop\n", "a.stl:3: a facet has 3 vertices, found 1"),
            ("solid\nvertex 1 2 3\n", "a.stl:2: a facet has 3 vertices, found 1"),
            ("solid\nvortex 1 2 3\n", "a.stl:2: expected facet, outer, vertex or the end of one, found \"vortex\""),
            ("solid\nendsolid\n", "a.stl: no faces"),
            ("nothing", "a.stl: neither a text that begins with solid nor 84 bytes long"),
        ] {
            let error = parse(text.as_bytes()).unwrap_err().to_string();
            assert!(error.starts_with(message), "{text}: {error}");
        }
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.5]];
        let mut bytes = packed("", &[corners, corners], [0, 0]);
        let more = [&bytes[..], &[7]].concat();
        assert_eq!(parse(&more).unwrap().notes, ["what follows the last triangle is passed over"]);
        bytes.pop();
        assert_eq!(parse(&bytes).unwrap_err().to_string(), "a.stl: the file ends after 1 of 2 triangles");
        let bytes = packed("", &[[[f32::NAN; 3]; 3]], [0, 0]);
        assert_eq!(parse(&bytes).unwrap_err().to_string(), "a.stl: triangle 1: a coordinate must be finite");
    }
}
