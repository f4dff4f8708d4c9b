//! The nearest hit of a ray and a sphere. A case is origin, direction, center, radius; the verdict is 1 for a hit with
//! `t >= 0`; the value is the smallest such `t`.

use rt_geom::{Ray, Sphere};

use super::method::{Answer, Method};
use super::real::{Components, Float, add, dot, dvec3, scaled, sub, vector};

/// Returns the methods that intersect a ray with a sphere.
pub(crate) fn sphere() -> Vec<Method<10, 1>> {
    vec![
        Method::new("textbook f32", "(-b ± √(b² - ac)) / a", textbook::<f32>),
        Method::new("textbook", "(-b ± √(b² - ac)) / a", textbook::<f64>),
        Method::new("q-form", "Press et al., Numerical Recipes, section 5.6", q_form::<f64>),
        Method::new("RTG f32", "Haines, Günther, Akenine-Möller, Ray Tracing Gems, chapter 7", gems::<f32>),
        Method::new("RTG", "Haines, Günther, Akenine-Möller, Ray Tracing Gems, chapter 7", gems::<f64>),
        Method::new("projection", "the form of Embree's sphere intersector", projection::<f64>),
        Method::ours_on("ours, verdict", shapes, |(ray, sphere)| {
            Answer::without_values(u8::from(sphere.any(ray, 0.0..f64::INFINITY)))
        })
        .verdict_alone(),
        Method::ours_on("ours", shapes, |(ray, sphere)| hit(sphere.closest(ray, 0.0..f64::INFINITY))),
    ]
}

fn shapes(case: &[f64; 10]) -> (Ray, Sphere) {
    let ray = Ray::new(dvec3(case, 0), dvec3(case, 3)).expect("cases are valid rays");
    (ray, Sphere::new(dvec3(case, 6), case[9]).expect("cases are valid spheres"))
}

fn hit(t: Option<f64>) -> Answer<1> {
    t.map_or(Answer::without_values(0), |t| Answer { verdict: 1, values: [t] })
}

/// The smaller of two parameters that is not negative; NaN is a miss.
fn nearest<T: Float>(near: T, far: T) -> Answer<1> {
    let zero = T::of(0.0);
    if near >= zero {
        hit(Some(near.wide()))
    } else if far >= zero {
        hit(Some(far.wide()))
    } else {
        hit(None)
    }
}

struct RayAndSphere<T> {
    direction: Components<T>,
    /// From the center to the origin of the ray.
    offset: Components<T>,
    radius: T,
}

impl<T: Float> RayAndSphere<T> {
    fn new(case: &[f64; 10]) -> Self {
        let offset = sub(vector::<T>(case, 0), vector(case, 6));
        Self { direction: vector(case, 3), offset, radius: T::of(case[9]) }
    }
}

fn textbook<T: Float>(case: &[f64; 10]) -> Answer<1> {
    let RayAndSphere { direction, offset, radius } = RayAndSphere::<T>::new(case);
    textbook_roots(direction, offset, radius).map_or(hit(None), |[near, far]| nearest(near, far))
}

/// The textbook's two roots, if it finds any; `offset` leads from the center to the origin of the ray.
pub(crate) fn textbook_roots<T: Float>(direction: Components<T>, offset: Components<T>, radius: T) -> Option<[T; 2]> {
    let (a, b) = (dot(direction, direction), dot(direction, offset));
    let discriminant = b * b - a * (dot(offset, offset) - radius * radius);
    if discriminant < T::of(0.0) {
        return None;
    }
    let root = discriminant.sqrt();
    Some([(-b - root) / a, (-b + root) / a])
}

fn q_form<T: Float>(case: &[f64; 10]) -> Answer<1> {
    let RayAndSphere { direction, offset, radius } = RayAndSphere::<T>::new(case);
    let (a, b) = (dot(direction, direction), dot(direction, offset));
    let c = dot(offset, offset) - radius * radius;
    roots_from_q(a, b, c, b * b - a * c)
}

/// The discriminant from the distance between center and line, so that `|offset|²` never enters it.
fn gems<T: Float>(case: &[f64; 10]) -> Answer<1> {
    let RayAndSphere { direction, offset, radius } = RayAndSphere::<T>::new(case);
    let (a, b) = (dot(direction, direction), dot(direction, offset));
    let perpendicular = sub(offset, scaled(direction, b / a));
    let reduced = radius * radius - dot(perpendicular, perpendicular);
    let c = dot(offset, offset) - radius * radius;
    roots_from_q(a, b, c, a * reduced)
}

fn roots_from_q<T: Float>(a: T, b: T, c: T, discriminant: T) -> Answer<1> {
    if discriminant < T::of(0.0) {
        return hit(None);
    }
    let q = -(b + discriminant.sqrt().copysign(b));
    let (x, y) = (c / q, q / a);
    if x < y { nearest(x, y) } else { nearest(y, x) }
}

/// Half a chord on either side of the point of the line that is nearest to the center.
fn projection<T: Float>(case: &[f64; 10]) -> Answer<1> {
    let RayAndSphere { direction, offset, radius } = RayAndSphere::<T>::new(case);
    let a = dot(direction, direction);
    let middle = -dot(direction, offset) / a;
    let perpendicular = add(offset, scaled(direction, middle));
    let chord = radius * radius - dot(perpendicular, perpendicular);
    if chord < T::of(0.0) {
        return hit(None);
    }
    let half = (chord / a).sqrt();
    nearest(middle - half, middle + half)
}
