//! The exact root as `t + step`: one or two Newton steps on a residual in double-double.
//!
//! `origin - center + t direction` is within `6 u²` of itself in double-double, however far the origin is, since the
//! difference and the products are exact and the sum of two double-doubles keeps its relative error when they cancel.
//! So is `vertex - origin - t direction` of a triangle. What is left to the root is then small, and plain doubles do:
//!
//! ```text
//!     sphere:    a s² + 2 g s + f = 0     with n = w + t d,  f = n.n - r²,  g = n.d
//!     triangle:  s = N.q / N.d            with q = vertex - origin - t d
//! ```

use std::cmp::Ordering;

use glam::DVec3;
use rt_math::exact::vector::{cross, difference, dot};
use rt_math::exact::{DoubleDouble, U, power_of_two};
use rt_math::fma_dispatch;

use super::{Bounded, HitPoint, Root};
use crate::ray::max_abs;
use crate::{Ray, Shape, Sphere, Triangle};

/// No coordinate, radius or `t` is above it, and no radius below its inverse's root: then nothing overflows, and what
/// underflows is far below the bounds.
const FARTHEST: f64 = power_of_two(300);
const SMALLEST: f64 = power_of_two(-150);
/// Swallows all errors of underflow.
const UNDERFLOW: f64 = power_of_two(-900);

/// The error of `f`, relative to `n.n + r²`; `39.1 u²` is proved.
const RESIDUAL_ERROR: f64 = 40.0 * U * U;
/// The error of `g² - a f`, relative to `a n.n + a |f|`; `10.1 u` is proved.
const DELTA_ERROR: f64 = 16.0 * U;
/// The error of `N.q`, relative to the square of the edges times `q`; `42.1 u²` is proved.
const HEIGHT_ERROR: f64 = 100.0 * U * U;
/// The error of `N.d`, relative to the sizes of `N` and `d`; `4.1 u` is proved.
const SLOPE_ERROR: f64 = 4.2 * U;
/// A step is not repeated if it is known to this part of a radius.
const GOOD_STEP: f64 = 0.5 * U;

/// The exact `t*` is `t` and the two steps, within `error`.
struct Refined {
    steps: [f64; 2],
    error: f64,
}

/// The sum of the magnitudes of the components, at least the length.
fn norm(v: DVec3) -> f64 {
    (v.x.abs() + v.y.abs()) + v.z.abs()
}

/// The unit vector along an exact one that is not zero.
pub(super) fn unit(v: DVec3) -> Bounded {
    let scaled = v * rt_math::exact::power_of_two_near_inverse(max_abs(v));
    Bounded { vector: scaled / scaled.length(), error: 4.6 * U }
}

/// Which root of a sphere `t` is the rounding of, if that is certain.
pub(super) fn root(hit: &HitPoint, sphere: &Sphere) -> Option<Root> {
    in_range(hit, sphere).then(|| at_sphere(hit.ray, hit.t, sphere))?.map(|(root, _)| root)
}

/// The vector from a point to the hit, if double-double knows something of it.
pub(super) fn from(hit: &HitPoint, point: DVec3) -> Option<Bounded> {
    let refined = match &hit.shape {
        Shape::Sphere(sphere) if sphere.radius() == 0.0 => return None,
        Shape::Sphere(sphere) => in_range(hit, sphere).then(|| at_sphere(hit.ray, hit.t, sphere))??.1,
        Shape::Triangle(triangle) => at_triangle(hit.ray, hit.t, triangle)?,
    };
    (max_abs(point) <= FARTHEST).then(|| towards(hit.ray, hit.t, &refined, point))
}

/// On which side of the plane that touches a sphere at the hit a point lies, if that is certain.
pub(super) fn sphere_side(hit: &HitPoint, sphere: &Sphere, point: DVec3) -> Option<Ordering> {
    let (normal, way) = (from(hit, sphere.center())?, from(hit, point)?);
    let height = -normal.vector.dot(way.vector);
    let (n, w) = (norm(normal.vector), norm(way.vector));
    let error = 1.01 * (normal.error * w + n * way.error + normal.error * way.error + 3.1 * U * n * w) + UNDERFLOW;
    // False for NaN.
    (height.abs() > error).then(|| height.total_cmp(&0.0))
}

/// Whether the numbers of a hit of a sphere lie in the range of the bounds.
fn in_range(hit: &HitPoint, sphere: &Sphere) -> bool {
    let far = max_abs(hit.ray.origin()).max(max_abs(sphere.center())).max(hit.t.abs()).max(sphere.radius());
    // The reach is NaN out of the range of directions.
    far <= FARTHEST && sphere.radius() >= SMALLEST && hit.ray.reach() > 0.0
}

fma_dispatch! {
    /// The root and its steps at a sphere.
    fn at_sphere(ray: &Ray, t: f64, sphere: &Sphere) -> Option<(Root, Refined)> = at_sphere_kernel;
}

#[expect(clippy::neg_cmp_op_on_partial_ord, reason = "false for NaN")]
#[inline(always)]
fn at_sphere_kernel<const FMA: bool>(ray: &Ray, t: f64, sphere: &Sphere) -> Option<(Root, Refined)> {
    let (d, a, radius) = (ray.direction(), ray.square(), sphere.radius());
    let mut n = along::<FMA>(difference(ray.origin(), sphere.center()), t, d);
    let mut n_error = 0.0;
    let radius_square = DoubleDouble::<FMA>::product(radius, radius);
    let mut root = None;
    let mut steps = [0.0; 2];
    let mut error = 0.0;
    for step in &mut steps {
        let high = DVec3::from_array(n.map(|x| x.high()));
        let square = high.length_squared();
        let f = (dot(&n, &n) - radius_square).high();
        let f_error = RESIDUAL_ERROR * (square + radius * radius) + 2.1 * n_error * square.sqrt() + UNDERFLOW;
        let g = high.dot(d);
        let g_error = SLOPE_ERROR * norm(high) * norm(d) + 1.01 * n_error * norm(d) + UNDERFLOW;
        let delta = g * g - a * f;
        let size = a * square + a * f.abs();
        let delta_error = DELTA_ERROR * size + 2.1 * g.abs() * n_error * norm(d) + a * f_error + UNDERFLOW;
        // False for NaN. Nearer to grazing the exact numbers take over.
        if !(delta > 16.0 * delta_error) {
            return None;
        }
        let sqrt = delta.sqrt();
        let sqrt_error = 0.6 * delta_error / sqrt + 1.1 * U * sqrt;
        // One root does not cancel: with the sign of g. The other is f / a over it.
        let sum = g.abs() + sqrt;
        let sum_error = g_error + sqrt_error + U * sum;
        let large = (sum / a, 1.01 * (sum_error / a) + 6.0 * U * (sum / a));
        let small =
            (f.abs() / sum, 1.01 * (f_error / sum + (f.abs() / sum) * (sum_error / sum)) + 3.0 * U * (f.abs() / sum));
        // g < 0: the near root is small and has the sign of f, the far one is large and ahead.
        let ahead = if g < 0.0 { 1.0 } else { -1.0 };
        let (small, large) = ((ahead * small.0.copysign(f), small.1), (ahead * large.0, large.1));
        let (near, far) = if g < 0.0 { (small, large) } else { (large, small) };
        if root.is_none() {
            // The near root, if it rounds to `t`: then it lies between the midpoints to both neighbours.
            let spacing = if near.0 > 0.0 { t.next_up() - t } else { t - t.next_down() };
            root = if near.0.abs() + near.1 < 0.49999 * spacing {
                Some(Root::Near)
            } else if near.0.abs() - near.1 > 0.50001 * spacing {
                Some(Root::Far)
            } else {
                return None;
            };
        }
        let (value, bound) = if root == Some(Root::Near) { near } else { far };
        (*step, error) = (value, bound + UNDERFLOW);
        if error * norm(d) <= GOOD_STEP * radius {
            break;
        }
        let next = along::<FMA>(n, value, d);
        // Each sum is within 6 u² of itself; the first one was exact but for that.
        n_error += 6.1 * U * U * norm(high);
        n = next;
    }
    root.map(|root| (root, Refined { steps, error }))
}

/// `v + t d` in double-double.
#[inline(always)]
fn along<const FMA: bool>(v: [DoubleDouble<FMA>; 3], t: f64, d: DVec3) -> [DoubleDouble<FMA>; 3] {
    let part = |v: DoubleDouble<FMA>, d: f64| v + DoubleDouble::product(t, d);
    [part(v[0], d.x), part(v[1], d.y), part(v[2], d.z)]
}

fma_dispatch! {
    /// The step at a triangle.
    fn at_triangle(ray: &Ray, t: f64, triangle: &Triangle) -> Option<Refined> = at_triangle_kernel;
}

#[expect(clippy::neg_cmp_op_on_partial_ord, reason = "false for NaN")]
#[inline(always)]
fn at_triangle_kernel<const FMA: bool>(ray: &Ray, t: f64, triangle: &Triangle) -> Option<Refined> {
    let (d, edge) = (ray.direction(), triangle.size());
    let [a, b, c] = triangle.vertices();
    let far = max_abs(ray.origin()).max(max_abs(a)).max(t.abs());
    if !(far <= FARTHEST && edge <= FARTHEST && ray.reach() > 0.0) {
        return None;
    }
    let n = cross(&difference::<DoubleDouble<FMA>>(b, a), &difference(c, a));
    let q = along::<FMA>(difference(a, ray.origin()), -t, d);
    let height = dot(&n, &q).high();
    let q_size = norm(DVec3::from_array(q.map(|x| x.high())));
    let height_error = HEIGHT_ERROR * (edge * edge) * q_size + UNDERFLOW;
    let normal = DVec3::from_array(n.map(|x| x.high()));
    let slope = normal.dot(d);
    let slope_error = (SLOPE_ERROR * norm(normal) + HEIGHT_ERROR * (edge * edge)) * norm(d) + UNDERFLOW;
    if !(slope.abs() > 1024.0 * slope_error) {
        return None;
    }
    let step = height / slope;
    let error = 1.01 * (height_error + step.abs() * slope_error) / slope.abs() + 3.0 * U * step.abs() + UNDERFLOW;
    Some(Refined { steps: [step, 0.0], error })
}

fma_dispatch! {
    /// `origin - point + (t + steps) direction`.
    fn towards(ray: &Ray, t: f64, refined: &Refined, point: DVec3) -> Bounded = towards_kernel;
}

#[inline(always)]
fn towards_kernel<const FMA: bool>(ray: &Ray, t: f64, refined: &Refined, point: DVec3) -> Bounded {
    let (d, Refined { steps, error }) = (ray.direction(), refined);
    let rounded = along::<FMA>(difference(ray.origin(), point), t, d);
    let exact = along(along(rounded, steps[0], d), steps[1], d);
    let vector = DVec3::from_array(exact.map(|x| x.high()));
    let way = (steps[0].abs() + steps[1].abs()) * norm(d);
    // Not the length, whose squares may underflow.
    let size = norm(vector);
    let error = 1.01 * U * size + 19.0 * U * U * (size + way) + 1.01 * error * norm(d) + UNDERFLOW;
    Bounded { vector, error }
}
