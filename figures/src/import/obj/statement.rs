//! What each statement of an OBJ file means.

use std::collections::HashMap;
use std::io::{self, BufRead, Read};
use std::path::Path;

use glam::DVec3;

use super::super::mesh::{FaceColor, Faces, Mesh, NO_MATERIAL, Vertex, Vertices};
use super::super::mtl::Library;
use super::super::problem::{LONGEST_LINE, LineProblem};
use super::super::words::{Words, number, rest, shown};
use crate::text::{quoted, without_mark};

/// What is ignored, with its keywords.
pub(super) const PASSED_OVER: [(&str, &[&str]); 5] = [
    ("normals (vn)", &["vn"]),
    ("texture coordinates (vt)", &["vt"]),
    ("lines (l)", &["l"]),
    ("points (p)", &["p"]),
    ("curves and surfaces (curv, curv2, surf)", &["curv", "curv2", "surf"]),
];

/// Reads a line and those that continue it, at most [`LONGEST_LINE`] bytes in all, and counts them; false at the end.
pub(super) fn statement(source: &mut impl BufRead, bytes: &mut Vec<u8>, line: &mut usize) -> io::Result<bool> {
    bytes.clear();
    loop {
        let before = bytes.len();
        let room = LONGEST_LINE - before;
        if source.by_ref().take(room as u64).read_until(b'\n', bytes)? == 0 {
            return Ok(!bytes.is_empty());
        }
        *line += 1;
        let text = bytes.strip_suffix(b"\n").unwrap_or(bytes);
        let text = text.strip_suffix(b"\r").unwrap_or(text);
        match text.strip_suffix(b"\\") {
            // A comment may end in a path of another system.
            Some(text) if !text.get(before..).unwrap_or_default().contains(&b'#') => {
                let length = text.len();
                bytes.truncate(length);
                bytes.push(b' ');
            }
            _ => return Ok(true),
        }
    }
}

/// A mesh that is being read.
pub(super) struct ObjReader {
    mesh: Mesh,
    pub(super) vertices: Vertices,
    /// Bit `k` is set if `PASSED_OVER[k]` occurs.
    pub(super) passed_over: u32,
    /// The faces from the first one on that names a vertex that comes later: their lines, where their corners end, and
    /// their colours.
    later: Vec<(usize, usize, FaceColor)>,
    /// The corners of those faces.
    later_corners: Vec<usize>,
    faces: Faces,
    /// A place to read a face's corners into.
    pub(super) corners: Vec<usize>,
    /// The libraries that the file names, and the materials, each once.
    libraries: Vec<Vec<u8>>,
    materials: HashMap<Vec<u8>, u32>,
    color: FaceColor,
}

impl ObjReader {
    pub(super) fn new() -> Self {
        Self {
            mesh: Mesh::default(),
            vertices: Vertices::default(),
            passed_over: 0,
            later: Vec::new(),
            later_corners: Vec::new(),
            faces: Faces::default(),
            corners: Vec::new(),
            libraries: Vec::new(),
            materials: HashMap::new(),
            color: FaceColor::Unsaid,
        }
    }

    /// Reads what begins in this line.
    pub(super) fn statement(&mut self, bytes: &[u8], line: usize) -> Result<(), LineProblem> {
        let bytes = if line == 1 { without_mark(bytes)? } else { bytes };
        let mut words = Words(bytes);
        let Some(keyword) = words.next() else { return Ok(()) };
        let words = words.take_while(|word| !word.starts_with(b"#"));
        match keyword {
            b"v" => {
                let (position, color) = vertex(words)?;
                self.vertices.try_push(position, color).map_err(|_| LineProblem::MeshMemory)?;
            }
            b"f" => {
                self.corners.clear();
                for word in words {
                    self.corners.push(position(word, self.vertices.len())?);
                }
                self.face(line, self.vertices.len())?;
            }
            b"mtllib" if self.libraries.len() < MOST_LIBRARIES => self.libraries.push(rest(bytes, keyword).to_vec()),
            b"usemtl" => {
                let next = u32::try_from(self.materials.len()).map_err(|_| LineProblem::MeshMemory)?;
                let material = *self.materials.entry(rest(bytes, keyword).to_vec()).or_insert(next);
                self.color = FaceColor::Material(material);
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

    /// Cuts the face, above which so many vertices are known, or keeps it for later: faces stay in order.
    pub(super) fn face(&mut self, line: usize, known: usize) -> Result<(), LineProblem> {
        if self.corners.len() < 3 {
            return Err(LineProblem::Face(self.corners.len()));
        }
        if self.later.is_empty() && self.corners.iter().all(|&corner| corner < known) {
            return self.faces.add(&mut self.mesh, &self.corners, &self.vertices, self.color);
        }
        self.later.try_reserve(1).map_err(|_| LineProblem::MeshMemory)?;
        self.later_corners.try_reserve(self.corners.len()).map_err(|_| LineProblem::MeshMemory)?;
        self.later_corners.extend_from_slice(&self.corners);
        self.later.push((line, self.later_corners.len(), self.color));
        Ok(())
    }

    /// Cuts the faces that were kept; an error comes with its line.
    pub(super) fn finish(mut self, folder: Option<&Path>) -> Result<Mesh, (usize, LineProblem)> {
        let mut start = 0;
        for &(line, end, color) in &self.later {
            let corners = &self.later_corners[start..end];
            if let Some(&corner) = corners.iter().find(|&&corner| corner >= self.vertices.len()) {
                let missing = LineProblem::Missing { number: corner + 1, vertices: self.vertices.len() };
                return Err((line, missing));
            }
            let added = self.faces.add(&mut self.mesh, corners, &self.vertices, color);
            added.map_err(|problem| (line, problem))?;
            start = end;
        }
        let occurs = |at: &usize| self.passed_over & 1 << at != 0;
        self.mesh.passed_over = (0..PASSED_OVER.len()).filter(occurs).map(|at| PASSED_OVER[at].0).collect();
        if !self.materials.is_empty() {
            self.paint(folder);
        }
        Ok(self.mesh)
    }

    /// Gives the materials that faces name their colours. One that no library has is none.
    fn paint(&mut self, folder: Option<&Path>) {
        let mut library = Library::default();
        match folder {
            Some(folder) => self.libraries.iter().for_each(|name| library.add(name, folder, &mut self.mesh.notes)),
            None => self.mesh.passed_over.push("materials (mtllib, usemtl): they lie in another file"),
        }
        if library.has_maps {
            self.mesh.passed_over.push("texture maps (map_Kd)");
        }
        let mut positions = vec![NO_MATERIAL; self.materials.len()];
        let (mut missing, mut first) = (0, None);
        let mut names: Vec<(&Vec<u8>, &u32)> = self.materials.iter().collect();
        names.sort_by_key(|(_, material)| **material);
        for (name, &material) in names {
            match library.colors.get(name) {
                Some(&color) => {
                    positions[material as usize] = u32::try_from(self.mesh.materials.len()).unwrap_or(NO_MATERIAL);
                    self.mesh.materials.push(color);
                }
                None => {
                    missing += 1;
                    first = first.or(Some(name));
                }
            }
        }
        if let (Some(first), Some(_)) = (first, folder) {
            let more = if missing > 1 { format!(" and {} more", missing - 1) } else { String::new() };
            let first = quoted(&String::from_utf8_lossy(first));
            self.mesh.notes.push(format!("no color is known of material {first}{more}"));
        }
        if self.mesh.materials.is_empty() {
            self.mesh.material_of.clear();
        }
        for material in &mut self.mesh.material_of {
            *material = positions.get(*material as usize).copied().unwrap_or(NO_MATERIAL);
        }
    }
}

/// More material libraries than this are not read.
const MOST_LIBRARIES: usize = 64;

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
