//! Exact arithmetic on doubles: the tools from which every kernel of the crate is made.
//!
//! A kernel that promises an exact verdict or a correctly rounded value works in stages, each one dearer and
//! rarer than the one before:
//!
//! 1. a *filter*: plain doubles and an error bound known beforehand;
//! 2. *double-double*: [`DoubleDouble`], about 106 bits, made of the error-free transformations [`two_sum`],
//!    [`two_diff`] and [`two_prod`]; a value so computed is accepted when [`round_if_certain`] shows that its error
//!    cannot change the rounding;
//! 3. *fixed-point numbers*: [`Fixed`], exact for numbers whose exponents lie in a [`Window`]; first where they cost
//!    less than double-double;
//! 4. *integers*: [`Dyadic`], exact for every finite input, over- and underflow included; cold.
//!
//! What is no polynomial or quotient of doubles, such as an angle, has no exact form: it is enclosed by a [`Ball`] of
//! any number of limbs, and what one length leaves open is asked again with the next.
//!
//! [`vector`] has the operations of three-vectors over any of these numbers. Nothing here allocates, and every loop is
//! bounded by the number of limbs.
//!
//! Functions that multiply take the constant parameter `FMA`: whether to use the fused multiply-add, which is one
//! instruction where the processor has it and a slow library call elsewhere. The bits of the result do not depend on
//! it. [`fma_dispatch!`](crate::fma_dispatch) compiles one body both ways and chooses at run time.
//!
//! `docs/numerics.md`, section 1, proves every bound stated here.
//!
//! ```
//! use rt_math::exact::{Dyadic, two_prod, two_sum};
//!
//! assert_eq!(two_sum(1.0, 1e-20), (1.0, 1e-20));
//! let (product, error) = two_prod::<false>(0.1, 0.1);
//! type Integer = Dyadic<4>; // 256 bits hold any product of two doubles
//! let exact = &Integer::from_f64(0.1) * &Integer::from_f64(0.1);
//! assert_eq!(exact, Integer::from_f64(product) + Integer::from_f64(error));
//! ```

mod ball;
mod by_value;
mod dispatch;
mod dot;
mod double_double;
mod dyadic;
mod enclosure;
mod error_free;
mod fixed;
mod radius;
mod round;
mod scaling;
pub(crate) mod stage;
pub mod vector;
mod wide;

pub use ball::Ball;
pub use dispatch::has_fma;
pub use dot::{difference_dot_sign, dot_sign, dot_with_error};
pub use double_double::DoubleDouble;
pub use dyadic::{Dyadic, bits_spanned};
pub use error_free::{U, fast_two_sum, remainder, two_diff, two_prod, two_prod_with, two_sum};
pub use fixed::{Fixed, MOST_LIMBS, Window};
pub use round::{round_if_certain, rounded_ends};
pub use scaling::{mantissa_and_exponent, power_of_two, power_of_two_near_inverse, scale};
