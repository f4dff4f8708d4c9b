//! Spheres, triangles and the minimal bounding-sphere tree, with exact verdicts.

mod ray;
mod sphere;
mod triangle;

pub use ray::Ray;
pub use sphere::Sphere;
pub use triangle::Triangle;
