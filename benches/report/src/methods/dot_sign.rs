//! The sign of an inner product. A case is two vectors; the verdict is 0 negative, 1 zero, 2 positive, 3 none of them;
//! there is no value.

use std::cmp::Ordering;

use super::method::{Answer, Method};
use super::real::dvec3;

/// Returns the methods that tell the sign.
pub(crate) fn dot_sign() -> Vec<Method<6, 0>> {
    // A sum of infinities has no sign.
    let of = |sum: f64| sum.partial_cmp(&0.0).map_or(Answer::without_values(3), signed);
    vec![
        Method::new("textbook", "the sum of products", move |[a, b, c, x, y, z]| of(a * x + b * y + c * z)),
        Method::new("fused", "the sum of products, with FMA", move |[a, b, c, x, y, z]| {
            of(a.mul_add(*x, b.mul_add(*y, c * z)))
        }),
        Method::ours("ours", |case| {
            signed(rt_math::exact::dot_sign(dvec3(case, 0), dvec3(case, 3)).expect("cases are finite"))
        }),
    ]
}

/// The verdict of a sign.
pub(crate) fn signed(sign: Ordering) -> Answer<0> {
    Answer::without_values(match sign {
        Ordering::Less => 0,
        Ordering::Equal => 1,
        Ordering::Greater => 2,
    })
}
