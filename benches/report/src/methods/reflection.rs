//! A vector mirrored in a plane. A case is the vector and a normal that is not zero; there is no verdict; the values
//! are the components.

use rt_math::reflect;

use super::method::{Answer, Method};
use super::real::{Float, dot, dvec3, scaled, sub, vector};

/// Returns the methods that mirror a vector.
pub(crate) fn reflection() -> Vec<Method<6, 3>> {
    vec![
        Method::new("unit normal f32", "v - 2 (v·n) n", unit::<f32>),
        Method::new("unit normal", "v - 2 (v·n) n", unit::<f64>),
        Method::new("any normal f32", "v - 2 (v·n) / (n·n) n", any::<f32>),
        Method::new("any normal", "v - 2 (v·n) / (n·n) n", any::<f64>),
        Method::ours("ours", |case| Answer { verdict: 0, values: reflect(dvec3(case, 0), dvec3(case, 3)).to_array() }),
    ]
}

fn unit<T: Float>(case: &[f64; 6]) -> Answer<3> {
    let (v, n) = (vector::<T>(case, 0), vector(case, 3));
    Answer { verdict: 0, values: sub(v, scaled(n, T::of(2.0) * dot(v, n))).map(T::wide) }
}

fn any<T: Float>(case: &[f64; 6]) -> Answer<3> {
    let (v, n) = (vector::<T>(case, 0), vector(case, 3));
    let factor = T::of(2.0) * (dot(v, n) / dot(n, n));
    Answer { verdict: 0, values: sub(v, scaled(n, factor)).map(T::wide) }
}
