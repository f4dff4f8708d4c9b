//! The weights of a triangle's vertices where a line meets it. A case is origin, direction and three vertices; the
//! verdict is 1 if the line hits, boundary included; the values are the weights.

use super::method::{Answer, Method};
use super::real::{Components, Float, add, cross, dot, scaled, sub, vector};
use super::triangle::{crossing, hit_point, shapes, sheared_areas};

/// Returns the methods that weigh the vertices.
pub(crate) fn barycentric() -> Vec<Method<15, 3>> {
    vec![
        Method::new("Möller-Trumbore f32", "Möller, Trumbore 1997", moller_trumbore::<f32>),
        Method::new("Möller-Trumbore", "Möller, Trumbore 1997", moller_trumbore::<f64>),
        Method::new("Woop", "Woop, Benthin, Wald 2013", |case| {
            let areas = sheared_areas(case);
            let sum = areas.iter().sum::<f64>();
            let hit = sum != 0.0 && (areas.iter().all(|&x| x >= 0.0) || areas.iter().all(|&x| x <= 0.0));
            answer(hit.then(|| areas.map(|area| area / sum)))
        }),
        Method::new("areas at the hit point", "Ericson, Real-Time Collision Detection, section 3.4", areas),
        Method::ours_on("ours", shapes, |(ray, triangle)| answer(triangle.line_barycentric(ray))),
    ]
}

fn answer(weights: Option<[f64; 3]>) -> Answer<3> {
    weights.map_or(Answer::without_values(0), |values| Answer { verdict: 1, values })
}

fn moller_trumbore<T: Float>(case: &[f64; 15]) -> Answer<3> {
    let vertices = [6, 9, 12].map(|from| vector::<T>(case, from));
    let found = crossing(vector(case, 0), vector(case, 3), vertices, 0.0);
    answer(found.map(|(_, u, v)| [T::of(1.0) - u - v, u, v].map(T::wide)))
}

/// The hit's point by the plane, then areas against the whole.
fn areas(case: &[f64; 15]) -> Answer<3> {
    let (origin, direction): (Components<f64>, Components<f64>) = (vector(case, 0), vector(case, 3));
    let [a, b, c] = [6, 9, 12].map(|from| vector::<f64>(case, from));
    let (t, normal) = hit_point(origin, direction, [a, b, c]);
    let point = add(origin, scaled(direction, t));
    let area = |p, q| dot(normal, cross(sub(p, point), sub(q, point))) / dot(normal, normal);
    let weights = [area(b, c), area(c, a), area(a, b)];
    answer(Some(weights).filter(|weights| weights.iter().all(|&x| x >= 0.0)))
}
