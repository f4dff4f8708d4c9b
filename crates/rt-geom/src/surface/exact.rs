//! The hit in integers of any size, and balls on them.
//!
//! With `w = origin - X` for any point `X`, the vector from `X` to the hit has the components
//!
//! ```text
//!     sphere:    (w_i a - b d_i -+ d_i sqrt(Delta)) / a      a = d.d, b = (origin - center).d, Delta as in `sphere`
//!     triangle:  (w_i s + h d_i) / s                         s = N.d, h = N.(vertex - origin), N the product of edges
//! ```
//!
//! Seen from the center, `w a - b d` is at most `a` times the radius, however far the origin is: nothing cancels that
//! the sphere does not show.

use std::cmp::Ordering;

use glam::DVec3;
use rt_math::exact::vector::{cross, difference, dot};
use rt_math::exact::{Ball, Dyadic, U, power_of_two};

use super::{Bounded, HitPoint, Root};
use crate::ray::max_abs;
use crate::triangle::{height_sign, slope_sign};
use crate::{Ray, Shape, Sphere, Triangle};

/// Limbs for a component: `p = w a - b d_i` is below 2^3078 and a multiple of 2^-3222, `p² ` and `d_i² Delta` of degree
/// six are below 2^6156 and multiples of 2^-6444: 199, twice a double times `a` included.
type Number = Dyadic<200>;

/// Limbs for the side of a point, of degree eight: multiples of 2^-8592 below 2^8210 take 265.
type SideNumber = Dyadic<268>;

/// The exact numbers of a hit, from which its vectors are enclosed to any precision.
#[derive(Clone, Debug)]
pub struct EnclosedHit<'a> {
    ray: &'a Ray,
    surface: Surface,
}

#[expect(clippy::large_enum_variant, reason = "one at a time, on the stack")]
#[derive(Clone, Debug)]
enum Surface {
    /// A sphere of radius 0.
    Point {
        center: DVec3,
    },
    Sphere {
        center: DVec3,
        a: Number,
        b: Number,
        delta: Number,
        root: Root,
    },
    Triangle {
        vertices: [DVec3; 3],
        normal: [Number; 3],
        slope: Number,
        height: Number,
    },
}

impl<'a> EnclosedHit<'a> {
    pub(super) fn new(hit: &HitPoint<'a>) -> Self {
        let ray = hit.ray;
        let surface = match &hit.shape {
            Shape::Sphere(sphere) if sphere.radius() == 0.0 => Surface::Point { center: sphere.center() },
            Shape::Sphere(sphere) => {
                let (w, d) = (difference::<Number>(ray.origin(), sphere.center()), direction(ray));
                let (a, b, x) = (dot(&d, &d), dot(&w, &d), cross(&w, &d));
                let delta = &a * &Number::from_f64(sphere.radius()).square() - dot(&x, &x);
                Surface::Sphere { center: sphere.center(), a, b, delta, root: hit.root(sphere) }
            }
            Shape::Triangle(triangle) => {
                let vertices @ [a, b, c] = triangle.vertices();
                let normal = cross(&difference::<Number>(b, a), &difference(c, a));
                let slope = dot(&normal, &direction(ray));
                let height = dot(&normal, &difference(a, ray.origin()));
                Surface::Triangle { vertices, normal, slope, height }
            }
        };
        Self { ray, surface }
    }

    /// Encloses the vector from a finite point to the hit, with `64 LIMBS` bits.
    #[must_use]
    pub fn from<const LIMBS: usize>(&self, point: impl Into<DVec3>) -> [Ball<LIMBS>; 3] {
        let point = point.into();
        let w = || difference::<Number>(self.ray.origin(), point);
        let d = direction(self.ray);
        match &self.surface {
            Surface::Point { center } => difference::<Number>(*center, point).each_ref().map(Ball::from_dyadic),
            Surface::Sphere { a, b, delta, root, .. } => {
                let (w, divisor) = (w(), Ball::from_dyadic(a));
                let sqrt = Ball::from_dyadic(delta).sqrt();
                let sqrt = if *root == Root::Near { -sqrt } else { sqrt };
                [0, 1, 2].map(|i| {
                    let middle = &w[i] * a - b * &d[i];
                    (Ball::from_dyadic(&middle) + Ball::from_dyadic(&d[i]) * sqrt) / divisor
                })
            }
            Surface::Triangle { slope, height, .. } => {
                let (w, divisor) = (w(), Ball::from_dyadic(slope));
                [0, 1, 2].map(|i| Ball::from_dyadic(&(&w[i] * slope + height * &d[i])) / divisor)
            }
        }
    }

    /// Encloses the normal as in [`HitPoint::normal`], not of unit length.
    #[must_use]
    pub fn normal<const LIMBS: usize>(&self) -> [Ball<LIMBS>; 3] {
        match &self.surface {
            Surface::Point { .. } => (-self.ray.direction()).to_array().map(Ball::from_f64),
            Surface::Sphere { center, .. } => self.from(*center),
            Surface::Triangle { normal, .. } => normal.each_ref().map(Ball::from_dyadic),
        }
    }

    /// Encloses the weights of a triangle's vertices; `None` for a sphere.
    #[must_use]
    pub fn weights<const LIMBS: usize>(&self) -> Option<[Ball<LIMBS>; 3]> {
        let Surface::Triangle { vertices, slope, .. } = &self.surface else { return None };
        let d = direction(self.ray);
        let [a, b, c] = vertices.map(|vertex| difference::<Number>(vertex, self.ray.origin()));
        let volumes = [dot(&cross(&b, &c), &d), dot(&cross(&c, &a), &d), dot(&cross(&a, &b), &d)];
        let divisor = Ball::from_dyadic(slope);
        Some(volumes.each_ref().map(|volume| Ball::from_dyadic(volume) / divisor))
    }
}

fn direction(ray: &Ray) -> [Number; 3] {
    ray.direction().to_array().map(Number::from_f64)
}

/// The vector from a point to the hit, each component correctly rounded.
#[cold]
#[inline(never)]
pub(super) fn from(hit: &HitPoint, point: DVec3) -> Bounded {
    if !point.is_finite() {
        return Bounded { vector: DVec3::NAN, error: f64::NAN };
    }
    let EnclosedHit { ray, surface } = hit.enclosed();
    let d = direction(ray);
    let w = || difference::<Number>(ray.origin(), point);
    let components = match surface {
        Surface::Point { center } => difference::<Number>(center, point).map(|part| part.to_f64()),
        Surface::Sphere { a, b, delta, root, .. } => {
            let w = w();
            [0, 1, 2].map(|i| {
                let minus = (root == Root::Near) == (ray.direction()[i] > 0.0);
                Number::root(&(&w[i] * &a - &b * &d[i]), minus, &(&delta * &d[i].square()), &a)
            })
        }
        Surface::Triangle { slope, height, .. } => {
            let w = w();
            [0, 1, 2].map(|i| Number::quotient(&(&w[i] * &slope + &height * &d[i]), &slope))
        }
    };
    let vector = DVec3::from_array(components);
    // Half an ulp of each component; where it underflows, half of the least double.
    let error = 1.01 * U * ((vector.x.abs() + vector.y.abs()) + vector.z.abs()).min(2.0 * max_abs(vector));
    Bounded { vector, error: if error < power_of_two(-1000) { error + 2.0 * f64::from_bits(1) } else { error } }
}

/// The unit normal of a sphere that is no point: the vector from the center over the radius.
#[cold]
#[inline(never)]
pub(super) fn sphere_normal(hit: &HitPoint, sphere: &Sphere) -> Bounded {
    let radius = Ball::<2>::from_f64(sphere.radius());
    let normal = hit.enclosed().normal::<2>().map(|part| {
        let (low, high) = (part / radius).ends();
        0.5 * low + 0.5 * high
    });
    Bounded { vector: DVec3::from_array(normal), error: 6.0 * U }
}

/// The sign of `N.d`.
pub(super) fn slope(triangle: &Triangle, ray: &Ray) -> Ordering {
    slope_sign(triangle, ray)
}

/// On which side of a triangle's plane a finite point lies.
pub(super) fn plane_side(triangle: &Triangle, point: DVec3) -> Ordering {
    // As a ray's origin, it sees the height of the plane above itself.
    let ray = Ray::new(point, DVec3::X).expect("a finite point and a direction");
    height_sign(triangle, &ray).reverse()
}

/// On which side of the plane that touches a sphere at the hit a finite point lies.
///
/// Times `a > 0`, `(X - c).n - r²` with `n = (p -+ d sqrt(Delta)) / a` is `A -+ B sqrt(Delta)`.
#[cold]
#[inline(never)]
pub(super) fn sphere_side(hit: &HitPoint, sphere: &Sphere, point: DVec3) -> Ordering {
    let ray = hit.ray;
    let [d, w, towards] = [
        ray.direction().to_array().map(SideNumber::from_f64),
        difference(ray.origin(), sphere.center()),
        difference(point, sphere.center()),
    ];
    let along = dot(&towards, &d);
    if sphere.radius() == 0.0 {
        return along.sign().reverse();
    }
    let (a, b, x) = (dot(&d, &d), dot(&w, &d), cross(&w, &d));
    let radius_square = SideNumber::from_f64(sphere.radius()).square();
    let delta = &a * &radius_square - dot(&x, &x);
    // A = (X - c).(w a - b d) - a r²
    let rational = &a * &(dot(&towards, &w) - radius_square) - &b * &along;
    let root_sign = match hit.root(sphere) {
        Root::Near => along.sign().reverse(),
        Root::Far => along.sign(),
    };
    let irrational = &along.square() * &delta;
    let root_sign = if irrational.sign() == Ordering::Equal { Ordering::Equal } else { root_sign };
    match (rational.sign(), root_sign) {
        (sign, Ordering::Equal) | (Ordering::Equal, sign) => sign,
        (sign, other) if sign == other => sign,
        // Of opposite signs: the larger square decides.
        (sign, _) => match rational.square().cmp(&irrational) {
            Ordering::Greater => sign,
            Ordering::Equal => Ordering::Equal,
            Ordering::Less => sign.reverse(),
        },
    }
}
