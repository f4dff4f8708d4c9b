//! What tests, benches and the report compare with: one exact reference a question, one random generator, and hard
//! cases.
//!
//! It shares no code with the kernels and knows none of their types: numbers go in as doubles, and every formula is the
//! plainest that is exact. Sums, differences and products of [`Big`] are exact; only quotients, roots and angles round.

#![allow(clippy::missing_panics_doc, reason = "a panic is how a test fails")]

pub mod corpus;
pub mod enclosing;
pub mod files;
pub mod images;
mod inside;
#[cfg(unix)]
pub mod kills;
pub mod matrices;
mod number;
mod phong;
mod pseudo_inverse;
mod quadratic;
mod random;
mod range;
mod reflection;
mod sphere;
mod triangle;
mod uv;
mod vector;

pub use inside::Projection;
pub use number::{
    Big, exact, is_rounded_quotient, is_rounding_of, is_tie, long, pi, power, power_of_two, quotient, relative_error,
    root, rounded, sign, ulps,
};
pub use phong::{Lamp, shade};
pub use pseudo_inverse::{Matrix, PseudoInverse, assert_penrose_within_rounding, matrix};
pub use quadratic::Quadratic;
pub use random::{Random, cases, scale, scale_point};
pub use range::holds;
pub use reflection::Reflection;
pub use sphere::{nearest_root, sphere_equation};
pub use triangle::{Crossing, Place};
pub use uv::{coordinates, uv};
pub use vector::{Vector, cross, dot, point_at, sub, unit, vector};
