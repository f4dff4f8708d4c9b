//! The smallest sphere around eight spheres. A case is their centers and radii; the values are center and radius.
//! Whether every sphere is inside is judged by the reference.

use glam::DVec3;
use rt_geom::{Sphere, enclosing_sphere};

use super::method::{Answer, Method};
use super::real::dvec3;

/// Spheres of one case.
pub(crate) const COUNT: usize = 8;

/// Returns the methods that enclose spheres; the values are center and radius.
pub(crate) fn enclosing() -> Vec<Method<{ 4 * COUNT }, 4>> {
    vec![
        Method::new("center of the box", "the center of the bounding box, the farthest point", box_center),
        Method::new("pair merging", "the smallest sphere around two, again and again", |case| {
            answer(spheres(case).reduce(merged))
        }),
        Method::new("Ritter", "Ritter 1990, for spheres", ritter),
        Method::ours_on("ours", shapes, |spheres| {
            answer(enclosing_sphere(spheres).map(|found| (found.sphere.center(), found.sphere.radius())))
        }),
    ]
}

fn shapes(case: &[f64; 4 * COUNT]) -> [Sphere; COUNT] {
    std::array::from_fn(|i| Sphere::new(dvec3(case, 4 * i), case[4 * i + 3]).expect("cases are valid spheres"))
}

type CenterAndRadius = (DVec3, f64);

fn spheres(case: &[f64; 4 * COUNT]) -> impl Iterator<Item = CenterAndRadius> + Clone {
    (0..COUNT).map(|i| (dvec3(case, 4 * i), case[4 * i + 3]))
}

fn answer(ball: Option<CenterAndRadius>) -> Answer<4> {
    let ((center, radius), verdict) = (ball.unwrap_or((DVec3::NAN, f64::NAN)), 1);
    Answer { verdict, values: [center.x, center.y, center.z, radius] }
}

/// The smallest sphere around two.
fn merged((c, r): CenterAndRadius, (d, s): CenterAndRadius) -> CenterAndRadius {
    let distance = c.distance(d);
    if distance + s <= r {
        (c, r)
    } else if distance + r <= s {
        (d, s)
    } else {
        let radius = 0.5 * (distance + r + s);
        (c + (d - c) * ((radius - r) / distance), radius)
    }
}

fn box_center(case: &[f64; 4 * COUNT]) -> Answer<4> {
    let low = spheres(case).map(|(c, r)| c - r).reduce(DVec3::min).expect("there are spheres");
    let high = spheres(case).map(|(c, r)| c + r).reduce(DVec3::max).expect("there are spheres");
    let center = 0.5 * (low + high);
    answer(Some((center, spheres(case).map(|(c, r)| center.distance(c) + r).fold(0.0, f64::max))))
}

/// Starts with two that are far apart, then grows to take in each that sticks out.
fn ritter(case: &[f64; 4 * COUNT]) -> Answer<4> {
    let reach = |from: DVec3| move |(c, r): &CenterAndRadius| from.distance(*c) + r;
    let farthest = |from: DVec3| {
        spheres(case).max_by(|a, b| reach(from)(a).total_cmp(&reach(from)(b))).expect("there are spheres")
    };
    let first = spheres(case).next().expect("there are spheres");
    let one = farthest(first.0);
    let other = farthest(one.0);
    answer(Some(spheres(case).fold(merged(one, other), merged)))
}
