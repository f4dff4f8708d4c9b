//! The methods that the report compares: the textbook's and the literature's, restated here, beside ours.
//!
//! Each is a plain function of the numbers of one case, in the form in which its source gives it: none is tuned, and
//! none is made safer than its source makes it. Those that are generic run in `f32` and in `f64`.

mod barycentric;
mod dot_sign;
mod enclosing;
mod inside;
mod mapping;
mod method;
mod phong;
mod plane;
mod pseudo_inverse;
mod quadratic;
pub(super) mod real;
mod reflection;
mod sphere;
mod texel;
mod triangle;

pub(super) use barycentric::barycentric;
pub(super) use dot_sign::{dot_sign, signed};
pub(super) use enclosing::{COUNT, enclosing};
pub(super) use inside::inside;
pub(super) use mapping::{mapping, textbook_coordinates};
pub(super) use method::{Answer, Method, Run};
pub(super) use phong::{MATERIAL, phong, terms};
pub(super) use plane::plane;
pub(super) use pseudo_inverse::pseudo_inverse;
pub(super) use quadratic::quadratic;
pub(super) use reflection::reflection;
pub(super) use sphere::{sphere, textbook_roots};
pub(super) use texel::{SIDE, texel};
pub(super) use triangle::{crossing, triangle};
