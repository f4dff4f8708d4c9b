//! Reflection, pseudo-inverse and quadratic solving on glam's f64 vectors.

mod quadratic;

pub use quadratic::Roots;
