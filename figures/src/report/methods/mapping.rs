//! The texture coordinates of a normal. A case is the normal, of any length; there is no verdict; the values are
//! `u` and `v`.

use std::f64::consts::{PI, TAU};

use rt_shade::sphere_uv;

use super::real::{Real, dvec3, vector};
use super::{Answer, Method};

/// Returns the methods that give texture coordinates.
pub(in super::super) fn mapping() -> Vec<Method<3, 2>> {
    vec![
        Method::new("textbook f32", "½ + atan2(z, x)/2π, ½ - asin(y)/π", textbook::<f32>),
        Method::new("textbook", "½ + atan2(z, x)/2π, ½ - asin(y)/π", textbook::<f64>),
        Method::new("normalised", "the textbook's, of the normal divided by its length", |case| {
            let normal = dvec3(case, 0).normalize();
            let v = 0.5 - normal.y.clamp(-1.0, 1.0).asin() / PI;
            Answer { verdict: 0, values: [0.5 + normal.z.atan2(normal.x) / TAU, v] }
        }),
        Method::new("two atan2, folded", "v by atan2(hypot(x, z), y); u counted from the seam", folded),
        Method::ours("ours", |case| Answer { verdict: 0, values: sphere_uv(dvec3(case, 0)).into() }),
    ]
}

fn textbook<T: Real>(case: &[f64; 3]) -> Answer<2> {
    let [x, y, z] = vector::<T>(case, 0);
    let (half, pi) = (T::of(0.5), T::of(PI));
    Answer { verdict: 0, values: [half + z.atan2(x) / (pi + pi), half - y.asin() / pi].map(T::wide) }
}

fn folded(&[x, y, z]: &[f64; 3]) -> Answer<2> {
    let u = if x < 0.0 && z.is_sign_negative() { (-z).atan2(-x) / TAU } else { 0.5 + z.atan2(x) / TAU };
    Answer { verdict: 0, values: [u, x.hypot(z).atan2(y) / PI] }
}
