//! Reflection, pseudo-inverse and quadratic solving on glam's f64 vectors.
//!
//! The number of roots and the rank are exact, and every value returned is the double nearest to the exact result for
//! the doubles given. No function allocates, loops without bound, or panics on any bit pattern. A vector is taken as a
//! [`glam::DVec3`] or as three numbers, `[f64; 3]`, into which `to_array` turns an answer.
//!
//! ```
//! use rt_math::{Roots, solve_quadratic};
//!
//! // b² - 4ac, 4 ε², is lost when rounded; the roots are not
//! let eps = f64::EPSILON;
//! assert_eq!(solve_quadratic(1.0 - eps, 2.0, 1.0 + eps), Roots::Two(-1.0 - 2.0 * eps, -1.0));
//! ```

pub mod exact;
mod pseudo_inverse;
mod quadratic;
mod reflect;

/// The vectors of every signature: another version of the crate has other types.
pub use glam;
pub use pseudo_inverse::{PseudoInverse, pseudo_inverse, pseudo_inverse_row_sums, pseudo_inverse_with_tolerance};
pub use quadratic::{Roots, solve_quadratic};
pub use reflect::reflect;

#[doc = include_str!("../README.md")]
#[cfg(doctest)]
struct Readme;
