//! Spheres, triangles and the minimal bounding-sphere tree, with exact verdicts.

mod enclosing;
mod ray;
mod sphere;
mod triangle;

pub use enclosing::{Enclosing, enclosing_sphere};
pub use ray::Ray;
pub use sphere::Sphere;
pub use triangle::Triangle;
