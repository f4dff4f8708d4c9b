//! The hit of a ray and a triangle. A case is origin, direction and three vertices; the verdict is 1 for a hit with
//! `t >= 0`, boundary included; the value is `t`.

use rt_geom::{Ray, Triangle};

use super::inside::{orientations, plain_plane};
use super::real::{Real, Vector, add, cross, dot, dvec3, scaled, sub, vector};
use super::{Answer, Method};

/// Returns the methods that intersect a ray with a triangle.
pub(in super::super) fn triangle() -> Vec<Method<15, 1>> {
    vec![
        Method::new("Möller-Trumbore f32", "Möller, Trumbore 1997", |case| {
            moller_trumbore::<f32>(case, 0.0)
        }),
        Method::new("Möller-Trumbore", "Möller, Trumbore 1997", |case| moller_trumbore::<f64>(case, 0.0)),
        Method::new("Möller-Trumbore, ε", "Möller, Trumbore 1997, with the tolerance 1e-8", |case| {
            moller_trumbore::<f64>(case, 1e-8)
        }),
        Method::new("Woop", "Woop, Benthin, Wald 2013", woop),
        Method::new("plane form", "the original report: ax + by + cz = 1, then orientations", plane_form),
        Method::ours("ours, verdict", |case| {
            let (ray, triangle) = shapes(case);
            Answer::without_values(u8::from(triangle.any(&ray, 0.0..f64::INFINITY)))
        })
        .verdict_alone(),
        Method::ours("ours", |case| {
            let (ray, triangle) = shapes(case);
            hit(triangle.closest(&ray, 0.0..f64::INFINITY))
        }),
    ]
}

fn shapes(case: &[f64; 15]) -> (Ray, Triangle) {
    let ray = Ray::new(dvec3(case, 0), dvec3(case, 3)).expect("cases are valid rays");
    let [a, b, c] = [6, 9, 12].map(|from| dvec3(case, from));
    (ray, Triangle::new(a, b, c).expect("cases are valid triangles"))
}

fn hit(t: Option<f64>) -> Answer<1> {
    t.filter(|&t| t >= 0.0).map_or(Answer::without_values(0), |t| Answer { verdict: 1, values: [t] })
}

fn moller_trumbore<T: Real>(case: &[f64; 15], tolerance: f64) -> Answer<1> {
    let (origin, direction): (Vector<T>, Vector<T>) = (vector(case, 0), vector(case, 3));
    let a = vector::<T>(case, 6);
    let (edge_1, edge_2) = (sub(vector(case, 9), a), sub(vector(case, 12), a));
    let (zero, one) = (T::of(0.0), T::of(1.0));
    let p = cross(direction, edge_2);
    let determinant = dot(edge_1, p);
    if determinant == zero || determinant.abs() < T::of(tolerance) {
        return hit(None);
    }
    let inverse = one / determinant;
    let s = sub(origin, a);
    let u = dot(s, p) * inverse;
    if u < zero || u > one {
        return hit(None);
    }
    let q = cross(s, edge_1);
    let v = dot(direction, q) * inverse;
    if v < zero || u + v > one {
        return hit(None);
    }
    hit(Some((dot(edge_2, q) * inverse).wide()))
}

/// The ray becomes the z axis by a shear; the signs of three areas decide.
fn woop(case: &[f64; 15]) -> Answer<1> {
    let (origin, d): (Vector<f64>, Vector<f64>) = (vector(case, 0), vector(case, 3));
    let size = d.map(f64::abs);
    let z = if size[0] > size[1] {
        if size[0] > size[2] { 0 } else { 2 }
    } else if size[1] > size[2] {
        1
    } else {
        2
    };
    let (mut x, mut y) = ((z + 1) % 3, (z + 2) % 3);
    if d[z] < 0.0 {
        std::mem::swap(&mut x, &mut y);
    }
    let (shear_x, shear_y, shear_z) = (d[x] / d[z], d[y] / d[z], 1.0 / d[z]);
    let [a, b, c] = [6, 9, 12].map(|from| sub(vector(case, from), origin));
    let [(ax, ay), (bx, by), (cx, cy)] =
        [a, b, c].map(|p: Vector<f64>| (p[x] - shear_x * p[z], p[y] - shear_y * p[z]));
    let (u, v, w) = (cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax);
    if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
        return hit(None);
    }
    let determinant = u + v + w;
    if determinant == 0.0 {
        return hit(None);
    }
    hit(Some(shear_z * (u * a[z] + v * b[z] + w * c[z]) / determinant))
}

/// The plane as `ax + by + cz = 1`, the point where the ray meets it, then three orientations.
fn plane_form(case: &[f64; 15]) -> Answer<1> {
    let (origin, direction): (Vector<f64>, Vector<f64>) = (vector(case, 0), vector(case, 3));
    let vertices = [6, 9, 12].map(|from| vector(case, from));
    let plane = plain_plane(vertices);
    let t = (1.0 - dot(plane, origin)) / dot(plane, direction);
    let point = add(origin, scaled(direction, t));
    hit(Some(t).filter(|_| orientations(point, vertices)))
}
