//! Triangles from Wavefront OBJ files.
//!
//! Read are vertices, `v x y z` or `v x y z r g b`, and faces, `f 1 2 3`, which count vertices from 1 or, negative,
//! back from the last above; of `1/2/3` the first number counts. A face may name vertices that come later. `polygon.rs`
//! cuts faces of more than three vertices. A line that ends in `\` goes on in the next one, unless it has a comment.
//! Everything else (texture coordinates, normals, materials, lines, points) is ignored, and the mesh lists what it was:
//! the scene model has no use for it.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use glam::DVec3;
use rt_geom::Triangle;

use super::foreign;
use super::polygon::{Cutter, Outcome};
use super::problem::{FileProblem, ImportError, LONGEST_LINE, LineProblem};
use super::words::{Words, number, shown};
use crate::scene::{LookIndex, Scene};
use crate::text::{file_name, without_mark};

/// The triangles of a mesh.
#[derive(Debug, Default, PartialEq)]
pub struct Mesh {
    /// The triangles that have an area, in the file's order.
    pub triangles: Vec<Triangle>,
    /// For each of them the colours at its vertices, if all three have one.
    pub vertex_colors: Vec<Option<[DVec3; 3]>>,
    /// How many triangles without area were left out.
    pub flat: usize,
    /// How many faces cross themselves, so that their triangles may overlap.
    pub crossed: usize,
    /// What the file has that a mesh has not, such as `normals (vn)`.
    pub passed_over: Vec<&'static str>,
}

/// What is ignored, with its keywords.
const PASSED_OVER: [(&str, &[&str]); 6] = [
    ("materials (mtllib, usemtl)", &["mtllib", "usemtl"]),
    ("normals (vn)", &["vn"]),
    ("texture coordinates (vt)", &["vt"]),
    ("lines (l)", &["l"]),
    ("points (p)", &["p"]),
    ("curves and surfaces (curv, curv2, surf)", &["curv", "curv2", "surf"]),
];

/// Reads the mesh in the file at `path`.
///
/// # Errors
/// What is wrong, with the line.
pub fn load(path: &Path) -> Result<Mesh, ImportError> {
    let name = file_name(path);
    let file = File::open(path).map_err(|source| FileProblem::Read { path: name.clone(), source })?;
    read(BufReader::new(file), &name).map_err(|error| foreign::explained(error, path))
}

/// Reads a mesh from `source`, which errors call `name`.
///
/// # Errors
/// What is wrong, with the line.
pub fn read(mut source: impl BufRead, name: &str) -> Result<Mesh, ImportError> {
    let mut reader = Reader::default();
    let mut bytes = Vec::new();
    let mut line = 0;
    let path = || name.to_owned();
    loop {
        let (first, read) = (line + 1, statement(&mut source, &mut bytes, &mut line));
        if !read.map_err(|source| FileProblem::Read { path: path(), source })? {
            break;
        }
        let complete = bytes.len() != LONGEST_LINE || bytes.ends_with(b"\n");
        let done = if complete { reader.statement(&bytes, first) } else { Err(LineProblem::Long) };
        done.map_err(|problem| ImportError::in_line(name, first, problem))?;
    }
    let mesh = reader.finish().map_err(|(line, problem)| ImportError::in_line(name, line, problem))?;
    match (mesh.triangles.len(), mesh.flat) {
        (0, 0) => Err(FileProblem::NoFaces(path()).into()),
        (0, flat) => Err(FileProblem::Flat { path: path(), flat }.into()),
        _ => Ok(mesh),
    }
}

/// Reads a line and those that continue it, at most [`LONGEST_LINE`] bytes in all, and counts them; false at the end.
fn statement(source: &mut impl BufRead, bytes: &mut Vec<u8>, line: &mut usize) -> io::Result<bool> {
    bytes.clear();
    loop {
        let room = LONGEST_LINE - bytes.len();
        if source.by_ref().take(room as u64).read_until(b'\n', bytes)? == 0 {
            return Ok(!bytes.is_empty());
        }
        *line += 1;
        let text = bytes.strip_suffix(b"\n").unwrap_or(bytes);
        let text = text.strip_suffix(b"\r").unwrap_or(text);
        match text.strip_suffix(b"\\") {
            // A comment may end in a path of another system.
            Some(text) if !text.contains(&b'#') => {
                let length = text.len();
                bytes.truncate(length);
                bytes.push(b' ');
            }
            _ => return Ok(true),
        }
    }
}

/// A vertex, and its colour if it has one.
type Vertex = (DVec3, Option<DVec3>);

/// A mesh that is being read.
#[derive(Default)]
struct Reader {
    mesh: Mesh,
    vertices: Vec<Vertex>,
    /// Bit `k` is set if `PASSED_OVER[k]` occurs.
    passed_over: u32,
    /// The faces from the first one on that names a vertex that comes later: their lines, and where their corners end.
    later: Vec<(usize, usize)>,
    /// The corners of those faces.
    later_corners: Vec<usize>,
    faces: Faces,
    /// A place to read a face's corners into.
    corners: Vec<usize>,
}

impl Reader {
    /// Reads what begins in this line.
    fn statement(&mut self, bytes: &[u8], line: usize) -> Result<(), LineProblem> {
        let bytes = if line == 1 { without_mark(bytes)? } else { bytes };
        let mut words = Words(bytes);
        let Some(keyword) = words.next() else { return Ok(()) };
        let words = words.take_while(|word| !word.starts_with(b"#"));
        match keyword {
            b"v" => {
                self.vertices.try_reserve(1).map_err(|_| LineProblem::MeshMemory)?;
                self.vertices.push(vertex(words)?);
            }
            b"f" => {
                self.corners.clear();
                for word in words {
                    self.corners.push(position(word, self.vertices.len())?);
                }
                self.face(line)?;
            }
            _ => {
                let known = |(_, keywords): &(_, &[&str])| keywords.iter().any(|word| word.as_bytes() == keyword);
                if let Some(at) = PASSED_OVER.iter().position(known) {
                    self.passed_over |= 1 << at;
                }
            }
        }
        Ok(())
    }

    /// Cuts the face, or keeps it for later: faces stay in order.
    fn face(&mut self, line: usize) -> Result<(), LineProblem> {
        let known = self.vertices.len();
        if self.corners.len() < 3 {
            return Err(LineProblem::Face(self.corners.len()));
        }
        if self.later.is_empty() && self.corners.iter().all(|&corner| corner < known) {
            return self.faces.add(&mut self.mesh, &self.corners, &self.vertices);
        }
        self.later.try_reserve(1).map_err(|_| LineProblem::MeshMemory)?;
        self.later_corners.try_reserve(self.corners.len()).map_err(|_| LineProblem::MeshMemory)?;
        self.later_corners.extend_from_slice(&self.corners);
        self.later.push((line, self.later_corners.len()));
        Ok(())
    }

    /// Cuts the faces that were kept; an error comes with its line.
    fn finish(mut self) -> Result<Mesh, (usize, LineProblem)> {
        let mut start = 0;
        for &(line, end) in &self.later {
            let corners = &self.later_corners[start..end];
            if let Some(&corner) = corners.iter().find(|&&corner| corner >= self.vertices.len()) {
                let missing = LineProblem::Missing { number: corner + 1, vertices: self.vertices.len() };
                return Err((line, missing));
            }
            let added = self.faces.add(&mut self.mesh, corners, &self.vertices);
            added.map_err(|problem| (line, problem))?;
            start = end;
        }
        let occurs = |at: &usize| self.passed_over & 1 << at != 0;
        self.mesh.passed_over = (0..PASSED_OVER.len()).filter(occurs).map(|at| PASSED_OVER[at].0).collect();
        Ok(self.mesh)
    }
}

/// What turns faces into triangles, with places to work in.
#[derive(Default)]
struct Faces {
    cutter: Cutter,
    points: Vec<DVec3>,
    cuts: Vec<[u32; 3]>,
}

impl Faces {
    /// Adds the triangles of a face, which has at least three corners, all of them known.
    fn add(&mut self, mesh: &mut Mesh, corners: &[usize], vertices: &[Vertex]) -> Result<(), LineProblem> {
        let most = corners.len() - 2;
        mesh.triangles.try_reserve(most).map_err(|_| LineProblem::MeshMemory)?;
        mesh.vertex_colors.try_reserve(most).map_err(|_| LineProblem::MeshMemory)?;
        let before = mesh.triangles.len();
        if let &[a, b, c] = corners {
            mesh.push([a, b, c].map(|corner| vertices[corner]));
        } else {
            self.points.clear();
            self.points.extend(corners.iter().map(|&corner| vertices[corner].0));
            self.cuts.clear();
            match self.cutter.cut(&self.points, &mut self.cuts) {
                Outcome::Exact => {}
                Outcome::Crossed => mesh.crossed += 1,
                Outcome::TooLarge => return Err(LineProblem::LargeFace(corners.len())),
            }
            for cut in &self.cuts {
                mesh.push(cut.map(|at| vertices[corners[at as usize]]));
            }
        }
        mesh.flat += most - (mesh.triangles.len() - before);
        Ok(())
    }
}

impl Mesh {
    /// Adds the mesh, read from the file at `path`, to a scene, with this look.
    pub fn add_to(self, scene: &mut Scene, look: LookIndex, path: &Path) {
        let Self { triangles, vertex_colors, flat, crossed, passed_over } = self;
        let mut warn = |warning: String| scene.warnings.push(format!("{}: {warning}", file_name(path)));
        if flat > 0 {
            let triangles = if flat == 1 { "triangle" } else { "triangles" };
            warn(format!("left out {flat} {triangles} without area"));
        }
        if crossed > 0 {
            let faces = if crossed == 1 { "face crosses itself" } else { "faces cross themselves" };
            warn(format!("{crossed} {faces}; the triangles of such a face may overlap"));
        }
        if !passed_over.is_empty() {
            warn(format!("passed over: {}", passed_over.join(", ")));
        }
        scene.triangle_looks.resize(scene.triangle_looks.len() + triangles.len(), look);
        if vertex_colors.iter().any(Option::is_some) || !scene.vertex_colors.is_empty() {
            scene.vertex_colors.resize(scene.triangles.len(), None);
            scene.vertex_colors.extend(vertex_colors);
        }
        scene.triangles.extend(triangles);
    }

    /// Adds a triangle if it has an area.
    fn push(&mut self, [a, b, c]: [Vertex; 3]) {
        let triangle = Triangle::new(a.0, b.0, c.0).expect("vertices were checked when they were read");
        if !triangle.is_degenerate() {
            self.triangles.push(triangle);
            self.vertex_colors.push(a.1.zip(b.1).zip(c.1).map(|((a, b), c)| [a, b, c]));
        }
    }
}

/// Reads a vertex.
fn vertex<'a>(words: impl Iterator<Item = &'a [u8]>) -> Result<Vertex, LineProblem> {
    let (mut numbers, mut count) = ([0.0; 6], 0);
    for word in words {
        let value = number(word)?;
        if let Some(place) = numbers.get_mut(count) {
            *place = value;
        }
        count += 1;
    }
    let [x, y, z, red, green, blue] = numbers;
    // A fourth number alone is the weight of a rational curve, which a mesh does not have.
    let (position, color) = match count {
        3 | 4 => (DVec3::new(x, y, z), None),
        6 => (DVec3::new(x, y, z), Some(DVec3::new(red, green, blue))),
        _ => return Err(LineProblem::Vertex(count)),
    };
    if !position.is_finite() {
        return Err(LineProblem::Coordinate);
    }
    let bad = color.and_then(|color| color.to_array().into_iter().find(|c| !(0.0..=1.0).contains(c)));
    match bad {
        Some(channel) => Err(LineProblem::VertexColor(channel)),
        None => Ok((position, color)),
    }
}

/// The position in the list of vertices that a face's word means; it may lie beyond those read so far.
fn position(word: &[u8], vertices: usize) -> Result<usize, LineProblem> {
    let number = word.split(|&byte| byte == b'/').next().unwrap_or(word);
    let number = std::str::from_utf8(number).ok().and_then(|number| number.parse::<i64>().ok());
    let position = match number {
        Some(number @ 1..) => usize::try_from(number - 1).ok(),
        Some(number @ ..=-1) => usize::try_from(number.unsigned_abs()).ok().and_then(|n| vertices.checked_sub(n)),
        _ => None,
    };
    position.ok_or_else(|| LineProblem::Index { found: shown(word), vertices })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Mesh, ImportError> {
        read(text.as_bytes(), "mesh.obj")
    }

    const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

    #[test]
    fn a_square_is_two_triangles() {
        let mesh = parse(&format!("# a square\no it\n{SQUARE}vn 0 0 1\nf 1//1 2/7/1 3 4\n")).unwrap();
        let corners = |indices: [usize; 3]| {
            let all = [DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y];
            Triangle::new(all[indices[0]], all[indices[1]], all[indices[2]]).unwrap()
        };
        assert_eq!(mesh.triangles, [corners([0, 1, 2]), corners([0, 2, 3])]);
        assert_eq!((mesh.vertex_colors, mesh.flat), (vec![None, None], 0));
    }

    #[test]
    fn a_notched_face_is_the_same_whichever_corner_comes_first() {
        let vertices = "v 0 0 0\nv 4 0 1\nv 4 4 2\nv 2 1 1\nv 0 4 1\n";
        let expected = parse(&format!("{vertices}f 1 2 3 4 5\n")).unwrap();
        for face in ["2 3 4 5 1", "3 4 5 1 2", "4 5 1 2 3", "5 1 2 3 4"] {
            assert_eq!(parse(&format!("{vertices}f {face}\n")).unwrap(), expected, "{face}");
        }
        // What the notch takes out is covered by none of them.
        let notch = rt_geom::Ray::new(DVec3::new(2.0, 3.0, 9.0), DVec3::NEG_Z).unwrap();
        assert!(expected.triangles.iter().all(|triangle| !triangle.any(&notch, 0.0..f64::INFINITY)));
    }

    #[test]
    fn a_face_that_crosses_itself_is_counted() {
        let mesh = parse("v 0 0 0\nv 3 3 0\nv 3 0 0\nv 0 1 0\nf 1 2 3 4\nf 1 2 3\n").unwrap();
        assert_eq!(mesh.crossed, 1);
        assert_eq!(parse(&format!("{SQUARE}f 1 2 3 4\n")).unwrap().crossed, 0);
    }

    #[test]
    fn negative_numbers_count_back() {
        assert_eq!(parse(&format!("{SQUARE}f -4 -3 -2\n")).unwrap(), parse(&format!("{SQUARE}f 1 2 3\n")).unwrap());
    }

    #[test]
    fn a_face_may_come_before_its_vertices() {
        let expected = parse(&format!("{SQUARE}f 1 2 3\nf 1 3 4\nf 1 2 4\n")).unwrap();
        let mixed = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nf 1 3 4\nf -3 -2 4\nv 0 1 0\n";
        assert_eq!(parse(mixed).unwrap(), expected);
        assert_eq!(parse(&format!("f 1 2 3\nf 1 3 4\nf 1 2 4\n{SQUARE}")).unwrap(), expected);
        // Faces stay in order, those that could be cut at once too.
        let ordered = parse(&format!("{SQUARE}f 1 3 4\nf 1 2 3\n")).unwrap();
        assert_eq!(parse("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 3 4\nf 1 2 3\nv 0 1 0\n").unwrap(), ordered);
        let error = parse(&format!("f 1 2 3\nf 1 2 5\n{SQUARE}")).unwrap_err();
        assert_eq!(error.to_string(), "mesh.obj:2: no vertex 5 among the 4 of the file");
    }

    #[test]
    fn a_line_goes_on_after_a_backslash() {
        let expected = parse(&format!("{SQUARE}f 1 2 3\n")).unwrap();
        assert_eq!(parse(&format!("{SQUARE}f 1 \\\n2\\\r\n 3\n")).unwrap(), expected);
        // Not in a comment; and the end of the file ends it.
        assert_eq!(parse(&format!("# C:\\\n{SQUARE}f 1 2 3 \\")).unwrap(), expected);
        let error = parse(&format!("{SQUARE}f 1 \\\n2 3\nv 0 0 \\\n\\\nzero\n")).unwrap_err();
        assert_eq!(error.to_string(), "mesh.obj:7: expected a number, found \"zero\"");
    }

    #[test]
    fn a_byte_order_mark_is_passed_over() {
        let expected = parse(&format!("{SQUARE}f 1 2 3\n")).unwrap();
        assert_eq!(parse(&format!("\u{feff}{SQUARE}f 1 2 3\n")).unwrap(), expected);
        let error = read(&b"\xff\xfev\0 \0"[..], "mesh.obj").unwrap_err();
        assert_eq!(error.to_string(), "mesh.obj:1: UTF-16 text; save it as UTF-8");
    }

    #[test]
    fn what_is_passed_over_is_told() {
        let text = "vn 0 0 1\nusemtl red\nvt 0 0\nmtllib a.mtl\ng part\ns off\nl 1 2\n";
        let mesh = parse(&format!("{SQUARE}{text}f 1 2 3\n")).unwrap();
        assert_eq!(
            mesh.passed_over,
            ["materials (mtllib, usemtl)", "normals (vn)", "texture coordinates (vt)", "lines (l)"]
        );
        assert!(parse(&format!("{SQUARE}f 1 2 3\n")).unwrap().passed_over.is_empty());
    }

    #[test]
    fn colors_belong_to_their_own_vertices() {
        let text = "v 0 0 0\nv 1 0 0 1 0 0\nv 1 1 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\nf 2 3 4\n";
        let mesh = parse(text).unwrap();
        assert_eq!(mesh.vertex_colors, [None, Some([DVec3::X, DVec3::Y, DVec3::Z])]);
    }

    #[test]
    fn flat_triangles_are_left_out_and_counted() {
        let mesh = parse(&format!("{SQUARE}f 1 2 2\nf 1 2 3\nf 1 1 1\nf 1 2 1 2\n")).unwrap();
        assert_eq!((mesh.triangles.len(), mesh.flat), (1, 4));
        let error = parse(&format!("{SQUARE}f 1 2 2\n")).unwrap_err();
        assert!(error.to_string().contains("none of its 1 triangles has an area"), "{error}");
    }
}
