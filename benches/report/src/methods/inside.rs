//! Whether a point, projected orthogonally, lies in a triangle. A case is the point and three vertices; the verdict is
//! 1 inside, boundary included; there is no value.

use glam::DVec3;
use rt_geom::{PointInTriangle, Triangle, inside_triangle};

use super::method::{Answer, Method};
use super::real::{Components, Float, cross, dot, dvec3, sub, vector};

/// Returns the methods that tell whether a point is in a triangle.
pub(crate) fn inside() -> Vec<Method<12, 0>> {
    let verdict = |inside| Answer::without_values(u8::from(inside));
    let parts = |case: &[f64; 12]| (vector(case, 0), [3, 6, 9].map(|from| vector(case, from)));
    vec![
        Method::new("orientations f32", "the original report: three orientations", move |case| {
            verdict(orientations::<f32>(vector(case, 0), [3, 6, 9].map(|from| vector(case, from))))
        }),
        Method::new("orientations", "the original report: three orientations", move |case| {
            let (point, vertices) = parts(case);
            verdict(orientations(point, vertices))
        }),
        Method::new("barycentric", "Ericson, Real-Time Collision Detection, section 3.4", move |case| {
            let (point, vertices) = parts(case);
            verdict(barycentric(point, vertices))
        }),
        Method::ours_on("ours", shapes, move |(point, triangle)| {
            verdict(inside_triangle(*point, triangle) != PointInTriangle::Outside)
        }),
    ]
}

fn shapes(case: &[f64; 12]) -> (DVec3, Triangle) {
    let [a, b, c] = [3, 6, 9].map(|from| dvec3(case, from));
    (dvec3(case, 0), Triangle::new(a, b, c).expect("cases are valid triangles"))
}

/// No turn of the three edges around the point is against the triangle's own.
pub(super) fn orientations<T: Float>(point: Components<T>, [a, b, c]: [Components<T>; 3]) -> bool {
    let normal = cross(sub(b, a), sub(c, a));
    let turn = |from, to| dot(normal, cross(sub(to, from), sub(point, from)));
    let zero = T::of(0.0);
    dot(normal, normal) > zero && turn(a, b) >= zero && turn(b, c) >= zero && turn(c, a) >= zero
}

fn barycentric(point: Components<f64>, [a, b, c]: [Components<f64>; 3]) -> bool {
    let (e, f, p) = (sub(b, a), sub(c, a), sub(point, a));
    let (ee, ef, ff, pe, pf) = (dot(e, e), dot(e, f), dot(f, f), dot(p, e), dot(p, f));
    let determinant = ee * ff - ef * ef;
    let v = (ff * pe - ef * pf) / determinant;
    let w = (ee * pf - ef * pe) / determinant;
    v >= 0.0 && w >= 0.0 && v + w <= 1.0
}
