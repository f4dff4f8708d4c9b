//! Reflection, pseudo-inverse and quadratic solving on glam's f64 vectors.

mod pseudo_inverse;
mod quadratic;

pub use pseudo_inverse::{PseudoInverse, pseudo_inverse, pseudo_inverse_with_tolerance};
pub use quadratic::Roots;
