//! The hit in plain doubles, with bounds of the errors: what most pixels of a picture need.

use glam::DVec3;
use rt_math::exact::{U, power_of_two};

use super::HitPoint;
use crate::{Shape, Triangle};

/// Swallows what underflow does to a component: `2^-1000`.
const UNDERFLOW: f64 = power_of_two(-1000);

/// The error of the rounded point, relative to the way and to the point: `2.01` and `1.01` are proved for exact norms.
const WAY_ERROR: f64 = 2.02 * U;
const POINT_ERROR: f64 = 1.02 * U;

/// The error of the product of two edges, relative to the square of their bound; `4.1 u` is proved.
const PRODUCT_ERROR: f64 = 6.1 * U;

/// A hit in plain doubles. An error that is infinite or NaN says that nothing is known.
#[derive(Clone, Copy, Debug)]
pub struct Estimate {
    /// [`Ray::at`](crate::Ray::at).
    pub point: DVec3,
    /// A bound of its distance from the exact point.
    pub point_error: f64,
    /// The normal as in [`HitPoint::normal`], not of unit length: a sphere's vector from the center, the product of a
    /// triangle's edges.
    pub normal: DVec3,
    /// A bound of the length of its difference from the exact one.
    pub normal_error: f64,
}

/// The sum of the magnitudes of the components, at least the length.
#[inline(always)]
fn norm(v: DVec3) -> f64 {
    (v.x.abs() + v.y.abs()) + v.z.abs()
}

#[inline(always)]
pub(super) fn estimate(hit: &HitPoint) -> Estimate {
    let (ray, t) = (hit.ray, hit.t);
    // Modelled in docs/proofs/SurfaceFilter.v: at_t, tn.
    let point = ray.at(t);
    // A subnormal t is off by half the least double, as one that is nearly normal.
    let way = (t.abs() + f64::MIN_POSITIVE) * norm(ray.direction());
    let point_error = WAY_ERROR * way + POINT_ERROR * norm(point) + UNDERFLOW;
    match &hit.shape {
        Shape::Sphere(sphere) if sphere.radius() > 0.0 => {
            let normal = point - sphere.center();
            let normal_error = point_error + POINT_ERROR * norm(normal);
            Estimate { point, point_error, normal, normal_error }
        }
        // Its one point is hit exactly, and the normal is the reversed direction.
        Shape::Sphere(sphere) => {
            Estimate { point: sphere.center(), point_error: 0.0, normal: -ray.direction(), normal_error: 0.0 }
        }
        Shape::Triangle(triangle) => {
            let [a, b, c] = triangle.vertices();
            let normal = (b - a).cross(c - a);
            let normal_error = PRODUCT_ERROR * (triangle.size() * triangle.size()) + UNDERFLOW;
            Estimate { point, point_error, normal, normal_error }
        }
    }
}

impl Triangle {
    /// Returns the weights of the vertices at an estimated hit, and a bound of the error of the second and the third;
    /// the first is 1 less the others, with twice the error and `2^-52` more.
    ///
    /// An error that is infinite or NaN says that nothing is known.
    #[must_use]
    pub fn estimated_weights(&self, hit: &Estimate) -> ([f64; 3], f64) {
        let [a, b, c] = self.vertices();
        let (p, n, edge) = (hit.point - a, hit.normal, self.size());
        let square = n.length_squared();
        let [beta, gamma] = [p.cross(c - a), (b - a).cross(p)].map(|part| part.dot(n) / square);
        let length = square.sqrt();
        let part_error = edge * (1.01 * (hit.point_error + POINT_ERROR * norm(p)) + PRODUCT_ERROR * norm(p));
        let error = 1.05 * (part_error + 3.1 * hit.normal_error) / length + 10.0 * U;
        // Where no square leaves the range of f64, and where the normal is one.
        let known =
            (power_of_two(-900)..power_of_two(900)).contains(&square) && hit.normal_error <= length * power_of_two(-8);
        ([1.0 - beta - gamma, beta, gamma], if known { error } else { f64::INFINITY })
    }
}
