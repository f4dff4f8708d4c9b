//! The bounding-sphere tree: every node has the minimal sphere of the primitives below it.

mod halving;

use std::ops::Range;

pub use halving::HalvingTree;

use crate::{Ray, Sphere, Triangle, enclosing_sphere};

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

/// The tree to cast rays with: answers equal the plain loop's, bit for bit.
#[derive(Clone, Debug)]
pub struct SphereTree {
    halving: HalvingTree,
}

impl SphereTree {
    /// Builds the tree.
    pub fn new(spheres: Vec<Sphere>, triangles: Vec<Triangle>) -> Self {
        Self { halving: HalvingTree::new(spheres, triangles) }
    }

    /// How many primitives the tree holds.
    pub fn len(&self) -> usize {
        self.halving.len()
    }

    /// Whether it holds none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the primitive with this index: spheres as listed, then triangles as listed.
    ///
    /// # Panics
    /// If `index >= self.len()`.
    pub fn shape(&self, index: usize) -> Shape {
        self.halving.shape(index)
    }

    /// Returns the closest hit with its `t` in the range: the smallest `t`, and of equal `t` the lowest index.
    pub fn closest(&self, ray: &Ray, within: Range<f64>) -> Option<Hit> {
        self.halving.closest(ray, within)
    }

    /// Returns whether anything is hit with its `t` in the range.
    pub fn any(&self, ray: &Ray, within: Range<f64>) -> bool {
        self.halving.any(ray, within)
    }

    /// Writes the closest hit of each ray.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn closest_batch(&self, rays: &[Ray], within: Range<f64>, hits: &mut [Option<Hit>]) {
        assert_eq!(rays.len(), hits.len(), "one place for the answer to each ray");
        for (ray, hit) in rays.iter().zip(hits) {
            *hit = self.closest(ray, within.clone());
        }
    }

    /// Writes for each ray whether it hits anything.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn any_batch(&self, rays: &[Ray], within: Range<f64>, hits: &mut [bool]) {
        assert_eq!(rays.len(), hits.len(), "one place for the answer to each ray");
        for (ray, hit) in rays.iter().zip(hits) {
            *hit = self.any(ray, within.clone());
        }
    }
}

/// The minimal sphere of a triangle; `None` if it has no finite radius.
fn minimal_sphere(triangle: &Triangle) -> Option<Sphere> {
    let points = triangle.vertices().map(|v| Sphere::new(v, 0.0).expect("vertices are finite"));
    enclosing_sphere(&points).map(|enclosing| enclosing.sphere)
}
