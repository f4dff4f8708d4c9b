//! The plane `ax + by + cz = 1` through three points, by the original report. A case is the points; there is no verdict
//! and no such plane through the origin, where the least-squares answer counts; the values are `a`, `b`, `c`.

use glam::DMat3;
use rt_geom::{Triangle, plane_by_pseudo_inverse};

use super::method::{Answer, Method};
use super::real::{Components, Float, cross, dot, dvec3, sub, vector};

/// Returns the methods that find the plane.
pub(crate) fn plane() -> Vec<Method<9, 3>> {
    vec![
        Method::new("Cramer f32", "(q - p)×(r - p) over its product with p", cramer::<f32>),
        Method::new("Cramer", "(q - p)×(r - p) over its product with p", cramer::<f64>),
        Method::new("adjugate", "M⁻¹ (1, 1, 1) with M⁻¹ = adj M / det M", |case| {
            let rows = DMat3::from_cols_array(case).transpose();
            Answer { verdict: 0, values: (rows.inverse() * glam::DVec3::ONE).to_array() }
        }),
        Method::ours("ours", |case| {
            let [p, q, r] = [0, 3, 6].map(|from| dvec3(case, from));
            let triangle = Triangle::new(p, q, r).expect("cases are finite");
            Answer { verdict: 0, values: plane_by_pseudo_inverse(&triangle).to_array() }
        }),
    ]
}

fn cramer<T: Float>(case: &[f64; 9]) -> Answer<3> {
    let vertices = [0, 3, 6].map(|from| vector::<T>(case, from));
    Answer { verdict: 0, values: plain_plane(vertices).map(T::wide) }
}

/// The plane's `(a, b, c)` in `ax + by + cz = 1`, by Cramer's rule.
pub(super) fn plain_plane<T: Float>([p, q, r]: [Components<T>; 3]) -> Components<T> {
    let normal = cross(sub(q, p), sub(r, p));
    let offset = dot(normal, p);
    normal.map(|x| x / offset)
}
