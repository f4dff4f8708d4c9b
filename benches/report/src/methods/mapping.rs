//! The texture coordinates of a normal. A case is the normal, of any length; there is no verdict; the values are
//! `u` and `v`.

use std::f64::consts::{PI, TAU};

use pxfm::{f_asin, f_atan2, f_hypot};
use rt_shade::sphere_uv;

use super::method::{Answer, Method};
use super::real::{Components, Float, dvec3, vector};

/// Returns the methods that give texture coordinates.
pub(crate) fn mapping() -> Vec<Method<3, 2>> {
    vec![
        Method::new("textbook f32", "½ + atan2(z, x)/2π, ½ - asin(y)/π", textbook::<f32>),
        Method::new("textbook", "½ + atan2(z, x)/2π, ½ - asin(y)/π", textbook::<f64>),
        Method::new("normalised", "the textbook's, of the normal divided by its length", |case| {
            let normal = dvec3(case, 0).normalize();
            let v = 0.5 - f_asin(normal.y.clamp(-1.0, 1.0)) / PI;
            Answer { verdict: 0, values: [0.5 + f_atan2(normal.z, normal.x) / TAU, v] }
        }),
        Method::new("two atan2, folded", "v by atan2(hypot(x, z), y); u counted from the seam", folded),
        Method::ours("ours", |case| Answer { verdict: 0, values: sphere_uv(dvec3(case, 0)).into() }),
    ]
}

fn textbook<T: Float>(case: &[f64; 3]) -> Answer<2> {
    Answer { verdict: 0, values: textbook_coordinates(vector::<T>(case, 0)).map(T::wide) }
}

/// The textbook's `u` and `v` of a unit normal.
pub(crate) fn textbook_coordinates<T: Float>([x, y, z]: Components<T>) -> [T; 2] {
    let (half, pi) = (T::of(0.5), T::of(PI));
    [half + z.atan2(x) / (pi + pi), half - y.asin() / pi]
}

fn folded(&[x, y, z]: &[f64; 3]) -> Answer<2> {
    let u = if x < 0.0 && z.is_sign_negative() { f_atan2(-z, -x) / TAU } else { 0.5 + f_atan2(z, x) / TAU };
    Answer { verdict: 0, values: [u, f_atan2(f_hypot(x, z), y) / PI] }
}
