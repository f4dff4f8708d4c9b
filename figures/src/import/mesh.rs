//! A mesh as it comes from a file: triangles, the colours of each, and what was left out.

use std::collections::TryReserveError;
use std::ops::Range;

use glam::DVec3;
use rt_geom::Triangle;

use super::polygon::{Cutter, Outcome};
use super::problem::{FileProblem, ImportError, LineProblem};
use super::spheres::append;
use crate::scene::{Look, LookIndex, Scene};

/// The triangles of a mesh.
#[derive(Debug, Default, PartialEq)]
pub struct Mesh {
    /// The triangles that have an area, in the file's order.
    pub triangles: Vec<Triangle>,
    /// For each of them the colours at its vertices, if all three have one; empty if none has.
    pub vertex_colors: Vec<Option<[DVec3; 3]>>,
    /// The colours of the materials that faces name.
    pub materials: Vec<DVec3>,
    /// For each triangle the position of its material in `materials`, or [`NO_MATERIAL`]; empty if none has one.
    pub material_of: Vec<u32>,
    /// How many triangles without area were left out.
    pub flat: usize,
    /// How many faces cross themselves, so that their triangles may overlap.
    pub crossed: usize,
    /// What the file has and a mesh does not, such as `normals (vn)`.
    pub passed_over: Vec<&'static str>,
    /// Other warnings.
    pub notes: Vec<String>,
}

/// The material of a triangle that has none.
pub const NO_MATERIAL: u32 = u32::MAX;

/// What a file says about the colour of a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum FaceColor {
    /// Nothing; its vertices may have colours.
    Unsaid,
    /// The position of a material.
    Material(u32),
    /// A colour of its own.
    Plain(DVec3),
}

/// A vertex, and its colour if it has one.
pub(super) type Vertex = (DVec3, Option<DVec3>);

/// The vertices of a mesh.
#[derive(Default)]
pub(super) struct Vertices {
    positions: Vec<DVec3>,
    /// The colour of each; empty if none has one.
    colors: Vec<Option<DVec3>>,
}

impl Vertices {
    pub(super) fn len(&self) -> usize {
        self.positions.len()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.len() == 0
    }

    pub(super) fn clear(&mut self) {
        self.truncate(0);
    }

    pub(super) fn truncate(&mut self, len: usize) {
        self.positions.truncate(len);
        self.colors.truncate(len);
    }

    /// Appends a vertex; an error if there is no memory for it.
    pub(super) fn try_push(&mut self, position: DVec3, color: Option<DVec3>) -> Result<(), TryReserveError> {
        self.positions.try_reserve(1)?;
        if color.is_some() || !self.colors.is_empty() {
            self.colors.try_reserve(self.positions.len() + 1 - self.colors.len())?;
        }
        self.push(position, color);
        Ok(())
    }

    #[inline]
    pub(super) fn push(&mut self, position: DVec3, color: Option<DVec3>) {
        if color.is_some() || !self.colors.is_empty() {
            self.colors.resize(self.positions.len(), None);
            self.colors.push(color);
        }
        self.positions.push(position);
    }

    /// Appends some vertices of others.
    pub(super) fn append(&mut self, more: &Self, range: Range<usize>) -> Result<(), TryReserveError> {
        self.positions.try_reserve(range.len())?;
        if !more.colors.is_empty() || !self.colors.is_empty() {
            self.colors.try_reserve(self.positions.len() + range.len() - self.colors.len())?;
            self.colors.resize(self.positions.len(), None);
            self.colors.extend(range.clone().map(|at| more.color(at)));
        }
        self.positions.extend_from_slice(&more.positions[range]);
        Ok(())
    }

    #[inline]
    fn color(&self, at: usize) -> Option<DVec3> {
        self.colors.get(at).copied().flatten()
    }

    #[inline]
    fn at(&self, at: usize) -> Vertex {
        (self.positions[at], self.color(at))
    }
}

/// What turns faces into triangles, with places to work in.
#[derive(Default)]
pub(super) struct Faces {
    cutter: Cutter,
    points: Vec<DVec3>,
    cuts: Vec<[u32; 3]>,
}

impl Faces {
    /// Adds the triangles of a face, which has at least three corners, all of them known.
    pub(super) fn add(
        &mut self,
        mesh: &mut Mesh,
        corners: &[usize],
        vertices: &Vertices,
        color: FaceColor,
    ) -> Result<(), LineProblem> {
        let most = corners.len() - 2;
        mesh.triangles.try_reserve(most).map_err(|_| LineProblem::MeshMemory)?;
        if !vertices.colors.is_empty() || !mesh.vertex_colors.is_empty() || matches!(color, FaceColor::Plain(_)) {
            let missing = mesh.triangles.len() + most - mesh.vertex_colors.len();
            mesh.vertex_colors.try_reserve(missing).map_err(|_| LineProblem::MeshMemory)?;
        }
        let before = mesh.triangles.len();
        if let &[a, b, c] = corners {
            mesh.push([a, b, c].map(|corner| vertices.at(corner)), color);
        } else {
            self.points.clear();
            self.points.extend(corners.iter().map(|&corner| vertices.positions[corner]));
            self.cuts.clear();
            match self.cutter.cut(&self.points, &mut self.cuts) {
                Outcome::Exact => {}
                Outcome::Crossed => mesh.crossed += 1,
                Outcome::TooLarge => return Err(LineProblem::LargeFace(corners.len())),
            }
            for cut in &self.cuts {
                mesh.push(cut.map(|at| vertices.at(corners[at as usize])), color);
            }
        }
        mesh.flat += most - (mesh.triangles.len() - before);
        let material = if let FaceColor::Material(material) = color { material } else { NO_MATERIAL };
        if material != NO_MATERIAL || !mesh.material_of.is_empty() {
            let missing = mesh.triangles.len() - mesh.material_of.len();
            mesh.material_of.try_reserve(missing).map_err(|_| LineProblem::MeshMemory)?;
            mesh.material_of.resize(before, NO_MATERIAL);
            mesh.material_of.resize(mesh.triangles.len(), material);
        }
        Ok(())
    }
}

impl Mesh {
    /// The mesh, or what is wrong with a file that gave no triangle.
    pub(super) fn some(self, name: &str) -> Result<Self, ImportError> {
        match (self.triangles.len(), self.flat) {
            (0, 0) => Err(FileProblem::NoFaces(name.to_owned()).into()),
            (0, flat) => Err(FileProblem::Flat { path: name.to_owned(), flat }.into()),
            _ => Ok(self),
        }
    }

    /// Adds the mesh, read from the file called `name`, to a scene: all of it with one look, or, with
    /// `Err(default)`, in the materials of the file, and what has none with a default look.
    ///
    /// # Errors
    /// More materials than can be numbered.
    pub fn add_to(self, scene: &mut Scene, look: Result<LookIndex, LookIndex>, name: &str) -> Result<(), ImportError> {
        let Self { triangles, vertex_colors, materials, material_of, flat, crossed, passed_over, notes } = self;
        let mut warn = |warning: String| scene.warnings.push(format!("{name}: {warning}"));
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
        notes.into_iter().for_each(warn);
        match look {
            Err(default) if !material_of.is_empty() => {
                let looks = materials.into_iter().map(|color| scene.add_look(Look::colored(color)));
                let looks = looks.collect::<Option<Vec<_>>>().ok_or(FileProblem::TooManyColors)?;
                let look = |&material: &u32| looks.get(material as usize).copied().unwrap_or(default);
                scene.triangle_looks.extend(material_of.iter().map(look));
            }
            Ok(look) | Err(look) => {
                scene.triangle_looks.resize(scene.triangle_looks.len() + triangles.len(), look);
            }
        }
        if !vertex_colors.is_empty() || !scene.vertex_colors.is_empty() {
            scene.vertex_colors.resize(scene.triangles.len(), None);
            scene.vertex_colors.extend(vertex_colors);
            scene.vertex_colors.resize(scene.triangles.len() + triangles.len(), None);
        }
        append(&mut scene.triangles, triangles);
        Ok(())
    }

    /// Adds a triangle if it has an area.
    pub(super) fn push(&mut self, [a, b, c]: [Vertex; 3], color: FaceColor) {
        let triangle = Triangle::new(a.0, b.0, c.0).expect("vertices were checked when they were read");
        if !triangle.is_degenerate() {
            let colors = match color {
                FaceColor::Plain(color) => Some([color; 3]),
                _ => a.1.zip(b.1).zip(c.1).map(|((a, b), c)| [a, b, c]),
            };
            if colors.is_some() || !self.vertex_colors.is_empty() {
                self.vertex_colors.resize(self.triangles.len(), None);
                self.vertex_colors.push(colors);
            }
            self.triangles.push(triangle);
        }
    }
}
