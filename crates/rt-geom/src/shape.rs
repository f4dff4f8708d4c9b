//! What both trees hold, and what they answer.

use crate::{Sphere, Triangle};

/// Where a ray meets a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Which primitive: spheres as listed, then triangles as listed.
    pub index: usize,
    /// Where on the ray, in units of its direction; correctly rounded.
    pub t: f64,
}

/// One primitive of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A sphere.
    Sphere(Sphere),
    /// A triangle.
    Triangle(Triangle),
}

/// What a query did, for reports.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Visits {
    /// Tests of bounds: in a [`Bvh`](crate::Bvh) of up to sixteen at once, in a [`SphereTree`](crate::SphereTree) of
    /// one sphere.
    pub nodes: usize,
    /// Primitives that met the exact test.
    pub tests: usize,
}
