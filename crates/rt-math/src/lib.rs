//! Reflection, pseudo-inverse and quadratic solving on glam's f64 vectors.

pub mod exact;
mod pseudo_inverse;
mod quadratic;
mod reflect;

#[cfg(test)]
mod oracle;

pub use pseudo_inverse::{PseudoInverse, pseudo_inverse, pseudo_inverse_with_tolerance};
pub use quadratic::{Roots, solve_quadratic};
pub use reflect::reflect;
