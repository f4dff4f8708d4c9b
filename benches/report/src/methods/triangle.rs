//! The hit of a ray and a triangle. A case is origin, direction and three vertices; the verdict is 1 for a hit with
//! `t >= 0`, boundary included; the value is `t`.

use rt_geom::{Ray, Triangle};

use super::inside::orientations;
use super::method::{Answer, Method};
use super::plane::plain_plane;
use super::real::{Components, Float, add, cross, dot, dvec3, scaled, sub, vector};

/// Returns the methods that intersect a ray with a triangle.
pub(crate) fn triangle() -> Vec<Method<15, 1>> {
    vec![
        Method::new("Möller-Trumbore f32", "Möller, Trumbore 1997", |case| moller_trumbore::<f32>(case, 0.0)),
        Method::new("Möller-Trumbore", "Möller, Trumbore 1997", |case| moller_trumbore::<f64>(case, 0.0)),
        Method::new("Möller-Trumbore, ε", "Möller, Trumbore 1997, with the tolerance 1e-8", |case| {
            moller_trumbore::<f64>(case, 1e-8)
        }),
        Method::new("Woop", "Woop, Benthin, Wald 2013", woop),
        Method::new("plane form", "the original report: ax + by + cz = 1, then orientations", plane_form),
        Method::ours_on("ours, verdict", shapes, |(ray, triangle)| {
            Answer::without_values(u8::from(triangle.any(ray, 0.0..f64::INFINITY)))
        })
        .verdict_alone(),
        Method::ours_on("ours", shapes, |(ray, triangle)| hit(triangle.closest(ray, 0.0..f64::INFINITY))),
    ]
}

/// The ray and the triangle of a case.
pub(super) fn shapes(case: &[f64; 15]) -> (Ray, Triangle) {
    let ray = Ray::new(dvec3(case, 0), dvec3(case, 3)).expect("cases are valid rays");
    let [a, b, c] = [6, 9, 12].map(|from| dvec3(case, from));
    (ray, Triangle::new(a, b, c).expect("cases are valid triangles"))
}

fn hit(t: Option<f64>) -> Answer<1> {
    t.filter(|&t| t >= 0.0).map_or(Answer::without_values(0), |t| Answer { verdict: 1, values: [t] })
}

fn moller_trumbore<T: Float>(case: &[f64; 15], tolerance: f64) -> Answer<1> {
    let vertices = [6, 9, 12].map(|from| vector::<T>(case, from));
    let found = crossing(vector(case, 0), vector(case, 3), vertices, tolerance);
    hit(found.map(|(t, _, _)| t.wide()))
}

/// Möller and Trumbore's `t` and the weights of the second and the third vertex, if the line hits.
pub(crate) fn crossing<T: Float>(
    origin: Components<T>,
    direction: Components<T>,
    [a, b, c]: [Components<T>; 3],
    tolerance: f64,
) -> Option<(T, T, T)> {
    let (edge_1, edge_2) = (sub(b, a), sub(c, a));
    let (zero, one) = (T::of(0.0), T::of(1.0));
    let p = cross(direction, edge_2);
    let determinant = dot(edge_1, p);
    if determinant == zero || determinant.abs() < T::of(tolerance) {
        return None;
    }
    let inverse = one / determinant;
    let s = sub(origin, a);
    let u = dot(s, p) * inverse;
    if u < zero || u > one {
        return None;
    }
    let q = cross(s, edge_1);
    let v = dot(direction, q) * inverse;
    if v < zero || u + v > one {
        return None;
    }
    Some((dot(edge_2, q) * inverse, u, v))
}

/// The ray becomes the z axis by a shear; the signs of three areas decide.
fn woop(case: &[f64; 15]) -> Answer<1> {
    let (origin, d): (Components<f64>, Components<f64>) = (vector(case, 0), vector(case, 3));
    let [u, v, w] = sheared_areas(case);
    if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
        return hit(None);
    }
    let determinant = u + v + w;
    if determinant == 0.0 {
        return hit(None);
    }
    let [_, _, z] = axes(d);
    let [a, b, c] = [6, 9, 12].map(|from| vector::<f64>(case, from)[z] - origin[z]);
    hit(Some((1.0 / d[z]) * (u * a + v * b + w * c) / determinant))
}

/// The axes in an order that keeps turns as they are and has the direction's longest last.
fn axes(d: Components<f64>) -> [usize; 3] {
    let size = d.map(f64::abs);
    let z = if size[0] > size[1] {
        if size[0] > size[2] { 0 } else { 2 }
    } else if size[1] > size[2] {
        1
    } else {
        2
    };
    let (x, y) = ((z + 1) % 3, (z + 2) % 3);
    if d[z] < 0.0 { [y, x, z] } else { [x, y, z] }
}

/// The areas opposite to the vertices, as the sheared ray sees them.
pub(super) fn sheared_areas(case: &[f64; 15]) -> [f64; 3] {
    let (origin, d): (Components<f64>, Components<f64>) = (vector(case, 0), vector(case, 3));
    let [x, y, z] = axes(d);
    let (shear_x, shear_y) = (d[x] / d[z], d[y] / d[z]);
    let [(ax, ay), (bx, by), (cx, cy)] = [6, 9, 12].map(|from| {
        let p = sub(vector::<f64>(case, from), origin);
        (p[x] - shear_x * p[z], p[y] - shear_y * p[z])
    });
    [cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax]
}

/// Where a line meets the plane of a triangle, and the plane's normal.
pub(super) fn hit_point(
    origin: Components<f64>,
    direction: Components<f64>,
    [a, b, c]: [Components<f64>; 3],
) -> (f64, Components<f64>) {
    let normal = cross(sub(b, a), sub(c, a));
    (dot(normal, sub(a, origin)) / dot(normal, direction), normal)
}

/// The plane as `ax + by + cz = 1`, the point where the ray meets it, then three orientations.
fn plane_form(case: &[f64; 15]) -> Answer<1> {
    let (origin, direction): (Components<f64>, Components<f64>) = (vector(case, 0), vector(case, 3));
    let vertices = [6, 9, 12].map(|from| vector(case, from));
    let plane = plain_plane(vertices);
    let t = (1.0 - dot(plane, origin)) / dot(plane, direction);
    let point = add(origin, scaled(direction, t));
    hit(Some(t).filter(|_| orientations(point, vertices)))
}
