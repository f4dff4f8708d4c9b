//! Spheres, triangles and the minimal bounding-sphere tree, with exact verdicts.

mod bvh;
mod crossings;
mod enclosing;
mod hilbert;
mod leaf;
mod plane;
mod questions;
mod ray;
mod shape;
mod simd;
mod sphere;
mod sphere_tree;
mod stage;
mod surface;
mod triangle;

pub use bvh::Bvh;
pub use crossings::Crossing;
pub use enclosing::{Enclosing, enclosing_sphere};
/// The vectors of every signature: another version of the crate has other types.
pub use glam;
pub use plane::plane_by_pseudo_inverse;
pub use questions::{AHEAD, List, OpenEdge, open_edges};
pub use ray::{Ray, RayError};
pub use shape::{Hit, Shape, Visits};
pub use sphere::{Side, Sphere, SphereError};
pub use sphere_tree::SphereTree;
pub use surface::{Bounded, EnclosedHit, Estimate, HitPoint};
pub use triangle::{PointInTriangle, Triangle, TriangleError, Verdict, inside_triangle};
