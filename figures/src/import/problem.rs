//! What can be wrong with a file of spheres or a mesh.

use std::io;

use super::polygon::MOST_CORNERS;
use crate::scene::LookIndex;
use crate::text::Utf16;

/// The longest line of a file of spheres, and the longest of a mesh with all lines that continue it.
pub(super) const LONGEST_LINE: usize = 4 << 20;

/// No line of a PDB file or of an STL file in text has so many bytes.
pub(super) const LONGEST_RECORD: u64 = 1 << 16;

/// Why a file of spheres or a mesh cannot be used, and in which line if that is known.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
pub struct ImportError(Box<FileProblem>);

impl From<FileProblem> for ImportError {
    fn from(problem: FileProblem) -> Self {
        Self(Box::new(problem))
    }
}

impl ImportError {
    /// An error in a line, counted from 1, of the file `path`.
    pub(super) fn in_line(path: &str, line: usize, problem: LineProblem) -> Self {
        FileProblem::Line { path: path.to_owned(), line, problem }.into()
    }

    /// Whether another format could be the reason: the file was read, and its text is not what was expected.
    pub(super) fn is_of_content(&self) -> bool {
        !matches!(*self.0, FileProblem::Read { .. })
    }
}

/// What is wrong with a file.
#[derive(Debug, thiserror::Error)]
pub(super) enum FileProblem {
    #[error("cannot read {path}")]
    Read { path: String, source: io::Error },
    #[error("{path}:{line}: {problem}")]
    Line { path: String, line: usize, problem: LineProblem },
    #[error("{0}: no objects")]
    NoSpheres(String),
    #[error("{0}: no faces")]
    NoFaces(String),
    #[error("{path}: none of its {flat} triangles has an area: the vertices of each lie on one line")]
    Flat { path: String, flat: usize },
    #[error("more than {} colors; give the spheres a material", LookIndex::MOST)]
    TooManyColors,
    #[error("{path}: {what}; read are .toml (a scene), .xyz and .pdb (spheres), .obj, .ply and .stl (meshes)")]
    Foreign { path: String, what: String },
    #[error("{path}: {what}")]
    Misplaced { path: String, what: String },
    #[error("{path}: {what}")]
    Binary { path: String, what: String },
}

/// Why reading ended early.
pub(super) enum Broken {
    Read(io::Error),
    Line(LineProblem),
}

impl From<LineProblem> for Broken {
    fn from(problem: LineProblem) -> Self {
        Self::Line(problem)
    }
}

/// What is wrong with a line.
#[derive(Debug, thiserror::Error)]
pub(super) enum LineProblem {
    #[error("expected a number, found {0:?}")]
    Number(String),
    #[error("a line is longer than {} MiB", LONGEST_LINE >> 20)]
    Long,
    #[error("a line is longer than {} bytes", LONGEST_RECORD - 1)]
    LongRecord,
    #[error(transparent)]
    Utf16(#[from] Utf16),

    // Files of spheres.
    #[error("expected the number of atoms, found {0:?}")]
    Count(String),
    #[error("the file ends after {found} of {expected} atoms")]
    Short { expected: u64, found: u64 },
    #[error("Properties must be name:type:columns groups with pos:R:3 among them, found {0:?}")]
    Properties(String),
    #[error("expected {expected} columns, found {found}")]
    Columns { expected: usize, found: usize },
    #[error("{name} must be finite, found {found}")]
    NotFinite { name: &'static str, found: String },
    #[error("radius must not be negative, found {0}")]
    NegativeRadius(f64),
    #[error("color must be from 0 to 1, found {0}")]
    SphereColor(f64),
    #[error("unknown element {0:?}; expected a symbol such as C, a label such as C1 or OW, or an atomic number")]
    Element(String),
    #[error("neither an element nor a radius column; give the spheres a radius")]
    NoRadius,
    #[error("more than {} colors", LookIndex::MOST)]
    TooManyColors,
    #[error("not enough memory for {0} atoms")]
    SphereMemory(u64),

    #[error("there is no frame {frame}; the file has {found}")]
    Frames { frame: u64, found: u64 },
    #[error("expected a number in columns {first} to {}, found {found:?}", first + 7)]
    Columns8 { first: usize, found: String },

    // Meshes.
    #[error("a vertex has 3 coordinates, and 3 colors or none; found {0} numbers")]
    Vertex(usize),
    #[error("a coordinate must be finite")]
    Coordinate,
    #[error("a color must be from 0 to 1, found {0}")]
    VertexColor(f64),
    #[error("a face has at least 3 vertices, found {0}")]
    Face(usize),
    #[error("no vertex {found:?} among the {vertices} above")]
    Index { found: String, vertices: usize },
    #[error("no vertex {number} among the {vertices} of the file")]
    Missing { number: usize, vertices: usize },
    #[error("a face with a notch or a corner on a side has at most {MOST_CORNERS} vertices, found {0}")]
    LargeFace(usize),
    #[error("a vertex of a facet has 3 coordinates, found {0}")]
    Corner(usize),
    #[error("a facet has 3 vertices, found {0}")]
    Loop(usize),
    #[error("expected facet, outer, vertex or the end of one, found {0:?}")]
    StlKeyword(String),
    #[error("{0}")]
    Ply(String),
    #[error("not enough memory for the mesh")]
    MeshMemory,
}
