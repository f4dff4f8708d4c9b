//! A triangle, where a ray meets it, and which points are inside.

use glam::DVec3;

/// The closed triangle with three given vertices: its boundary belongs to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    vertices: [DVec3; 3],
}

impl Triangle {
    /// Returns the triangle, or `None` if a coordinate is not finite. A triangle without area is allowed, and
    /// nothing hits it.
    pub fn new(a: DVec3, b: DVec3, c: DVec3) -> Option<Self> {
        let valid = a.is_finite() && b.is_finite() && c.is_finite();
        valid.then_some(Self { vertices: [a, b, c] })
    }

    /// The three vertices, as given; finite.
    pub fn vertices(&self) -> [DVec3; 3] {
        self.vertices
    }
}
