//! Triangles from Wavefront OBJ files.
//!
//! Read are vertices, `v x y z` or `v x y z r g b`, and faces, `f 1 2 3`, which count vertices from 1 or, negative, back
//! from the last; of `1/2/3` the first number counts. A face of more than three vertices is cut into a fan. Everything
//! else (texture coordinates, normals, groups, materials) is passed over: the scene model has no use for it.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use glam::DVec3;
use rt_geom::Triangle;

use super::shown;

/// The longest line.
const LINE: u64 = 4 << 20;

/// Why a mesh cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ObjError {
    /// The file could not be opened or read.
    #[error("cannot read {path}")]
    Read {
        /// The file.
        path: String,
        /// What the system says.
        source: io::Error,
    },
    /// A line is not what it should be.
    #[error("{path}:{line}: {problem}")]
    Line {
        /// The file.
        path: String,
        /// The line, from 1.
        line: usize,
        /// What is wrong there.
        problem: Problem,
    },
    /// The file has no face with an area.
    #[error("{path}: no triangles")]
    Empty {
        /// The file.
        path: String,
    },
}

/// What is wrong with a line.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Problem {
    /// Something else stands where a number should.
    #[error("expected a number, found {0:?}")]
    Number(String),
    /// A vertex with too few or too many numbers.
    #[error("a vertex has 3 coordinates, and 3 colors or none; found {0} numbers")]
    Vertex(usize),
    /// NaN or an infinity.
    #[error("a coordinate must be finite")]
    NotFinite,
    /// A colour outside 0 to 1.
    #[error("a color must be from 0 to 1, found {0}")]
    Color(f64),
    /// A face with fewer than three vertices.
    #[error("a face has at least 3 vertices, found {0}")]
    Face(usize),
    /// A vertex that is not there.
    #[error("no vertex {found:?} among the {vertices} above")]
    Index {
        /// As written.
        found: String,
        /// So many vertices have been read.
        vertices: usize,
    },
    /// A line that does not end.
    #[error("a line is longer than {} MiB", LINE >> 20)]
    LongLine,
}

/// The triangles of a mesh.
#[derive(Debug, Default, PartialEq)]
pub struct Mesh {
    /// The triangles that have an area, in the file's order.
    pub triangles: Vec<Triangle>,
    /// For each of them the colours at its vertices, if all three have one.
    pub vertex_colors: Vec<Option<[DVec3; 3]>>,
    /// How many triangles without area were left out.
    pub flat: usize,
}

/// Reads the mesh in the file at `path`.
///
/// # Errors
/// What is wrong, with the line.
pub fn load(path: &Path) -> Result<Mesh, ObjError> {
    let name = path.display().to_string();
    let file = File::open(path).map_err(|source| ObjError::Read { path: name.clone(), source })?;
    read(BufReader::new(file), &name)
}

/// Reads a mesh from `source`, which errors call `name`.
///
/// # Errors
/// What is wrong, with the line.
pub fn read(mut source: impl BufRead, name: &str) -> Result<Mesh, ObjError> {
    let mut mesh = Mesh::default();
    let mut vertices = Vec::new();
    let mut bytes = Vec::new();
    for line in 1.. {
        bytes.clear();
        let read = source.by_ref().take(LINE).read_until(b'\n', &mut bytes);
        if read.map_err(|source| ObjError::Read { path: name.to_owned(), source })? == 0 {
            break;
        }
        let complete = bytes.len() as u64 != LINE || bytes.ends_with(b"\n");
        let done = if complete { mesh.line(&bytes, &mut vertices) } else { Err(Problem::LongLine) };
        done.map_err(|problem| ObjError::Line { path: name.to_owned(), line, problem })?;
    }
    if mesh.triangles.is_empty() {
        return Err(ObjError::Empty { path: name.to_owned() });
    }
    Ok(mesh)
}

impl Mesh {
    fn line(&mut self, line: &[u8], vertices: &mut Vec<(DVec3, Option<DVec3>)>) -> Result<(), Problem> {
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        match words.next() {
            Some(b"v") => {
                let words = words.take_while(|word| !word.starts_with(b"#"));
                vertices.push(vertex(
                    &words.map(super::number).collect::<Result<Vec<_>, _>>().map_err(Problem::Number)?,
                )?);
            }
            Some(b"f") => {
                let words = words.take_while(|word| !word.starts_with(b"#"));
                let corners: Vec<usize> =
                    words.map(|word| index(word, vertices.len())).collect::<Result<_, _>>()?;
                if corners.len() < 3 {
                    return Err(Problem::Face(corners.len()));
                }
                for pair in corners[1..].windows(2) {
                    self.push([corners[0], pair[0], pair[1]].map(|corner| vertices[corner]));
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn push(&mut self, [a, b, c]: [(DVec3, Option<DVec3>); 3]) {
        let triangle = Triangle::new(a.0, b.0, c.0).expect("vertices were checked when they were read");
        if triangle.is_degenerate() {
            self.flat += 1;
            return;
        }
        self.triangles.push(triangle);
        self.vertex_colors.push(a.1.zip(b.1).zip(c.1).map(|((a, b), c)| [a, b, c]));
    }
}

/// A vertex, and its colour if it has one.
fn vertex(numbers: &[f64]) -> Result<(DVec3, Option<DVec3>), Problem> {
    // A fourth number alone is the weight of a rational curve, which a mesh does not have.
    let (position, color) = match *numbers {
        [x, y, z] | [x, y, z, _] => (DVec3::new(x, y, z), None),
        [x, y, z, red, green, blue] => (DVec3::new(x, y, z), Some(DVec3::new(red, green, blue))),
        _ => return Err(Problem::Vertex(numbers.len())),
    };
    if !position.is_finite() {
        return Err(Problem::NotFinite);
    }
    let bad = color.and_then(|color| color.to_array().into_iter().find(|c| !(0.0..=1.0).contains(c)));
    match bad {
        Some(channel) => Err(Problem::Color(channel)),
        None => Ok((position, color)),
    }
}

/// The position in the list of vertices that a face's word means.
fn index(word: &[u8], vertices: usize) -> Result<usize, Problem> {
    let number = word.split(|&byte| byte == b'/').next().unwrap_or(word);
    let number = std::str::from_utf8(number).ok().and_then(|number| number.parse::<i64>().ok());
    let position = match number {
        Some(number @ 1..) => usize::try_from(number - 1).ok(),
        Some(number @ ..=-1) => {
            usize::try_from(number.unsigned_abs()).ok().and_then(|n| vertices.checked_sub(n))
        }
        _ => None,
    };
    position
        .filter(|&position| position < vertices)
        .ok_or_else(|| Problem::Index { found: shown(word), vertices })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Mesh, ObjError> {
        read(text.as_bytes(), "mesh.obj")
    }

    const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

    #[test]
    fn a_square_is_a_fan_of_two_triangles() {
        let mesh = parse(&format!("# a square\no it\n{SQUARE}vn 0 0 1\nf 1//1 2/7/1 3 4\n")).unwrap();
        let corners = |indices: [usize; 3]| {
            let all = [DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y];
            Triangle::new(all[indices[0]], all[indices[1]], all[indices[2]]).unwrap()
        };
        assert_eq!(mesh.triangles, [corners([0, 1, 2]), corners([0, 2, 3])]);
        assert_eq!((mesh.vertex_colors, mesh.flat), (vec![None, None], 0));
    }

    #[test]
    fn negative_numbers_count_back() {
        assert_eq!(
            parse(&format!("{SQUARE}f -4 -3 -2\n")).unwrap(),
            parse(&format!("{SQUARE}f 1 2 3\n")).unwrap()
        );
    }

    #[test]
    fn colors_belong_to_their_own_vertices() {
        let text = "v 0 0 0\nv 1 0 0 1 0 0\nv 1 1 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\nf 2 3 4\n";
        let mesh = parse(text).unwrap();
        assert_eq!(mesh.vertex_colors, [None, Some([DVec3::X, DVec3::Y, DVec3::Z])]);
    }

    #[test]
    fn flat_triangles_are_left_out_and_counted() {
        let mesh = parse(&format!("{SQUARE}f 1 2 2\nf 1 2 3\nf 1 1 1\n")).unwrap();
        assert_eq!((mesh.triangles.len(), mesh.flat), (1, 2));
        assert!(matches!(parse(&format!("{SQUARE}f 1 2 2\n")), Err(ObjError::Empty { .. })));
    }
}
