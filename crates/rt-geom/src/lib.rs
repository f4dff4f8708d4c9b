//! Spheres, triangles and the minimal bounding-sphere tree, with exact verdicts.
//!
//! What a ray hits, how often, on which side a point lies: decided as in real arithmetic on the doubles given, for every
//! finite input. A `t` that is returned is the double nearest to the exact one. A vector is taken as a [`glam::DVec3`] or
//! as three numbers, `[f64; 3]`, into which `to_array` turns an answer.
//!
//! ```
//! use rt_geom::{AHEAD, Bvh, Hit, Ray, Side, Sphere};
//!
//! let balls = [[0.0, 0.0, -3.0], [0.0, 0.0, -9.0]].map(|center| Sphere::new(center, 1.0).unwrap());
//! let tree = Bvh::new(balls.to_vec(), vec![]);
//! let ray = Ray::new([0.0; 3], [0.0, 0.0, -1.0]).unwrap();
//! let hit = tree.closest(&ray, AHEAD).unwrap();
//! assert_eq!(hit, Hit { index: 0, t: 2.0 });
//!
//! // The exact point of the hit: from the center, its normal, the side of a light.
//! let point = tree.shape(hit.index).hit_point(&ray, hit.t);
//! assert_eq!(point.normal().vector.to_array(), [0.0, 0.0, 1.0]);
//! assert!(point.faces_ray() && point.side_of([0.0, 5.0, 1.0]).is_gt());
//!
//! assert_eq!(tree.contains([0.0, 0.0, -3.5]), Side::Inside);
//! ```

mod bvh;
mod crossings;
mod enclosing;
mod hilbert;
mod lanes;
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
