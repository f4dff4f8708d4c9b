//! The correctly rounded roots of a line that surely crosses a sphere: one Newton step on a precise residual.
//!
//! The filter's root `t` in doubles is put into `f(t) = |w + t d|² - r²`, which is computed to twice the precision. If
//! `t*` is the root, `f(t) = a (t - near) (t - far)` and `far - near = 2 sqrt(Delta) / a` give
//!
//! ```text
//!     t* - t = f(t) / (2 sqrt(Delta) + a (t* - t))        for the near root, and for the far one with both signs turned
//! ```
//!
//! of which the filter knows `sqrt(Delta)`, and that `t* - t` is small. A rounding test tells whether `t` and this step
//! decide the last bit. `docs/numerics.md`, section 5, proves the bounds.

use std::ops::Mul;

use fearless_simd::{Simd, f64x2, f64x4, prelude::*};
use rt_math::exact::{U, round_if_certain, two_diff, two_sum};

use super::{Side, Sphere};
use crate::Ray;
use crate::simd::two_prod;

/// The error of half the residual, relative to `w.w + r²`.
pub(super) const RESIDUAL_ERROR: f64 = 160.0 * U * U;

/// `a t² + 2 b t + c`, for a line that surely crosses the surface twice.
pub(super) struct SphereCrossing {
    pub(super) b: f64,
    pub(super) c: f64,
    /// `w.w + r²`
    pub(super) squares: f64,
    pub(super) delta: f64,
    /// A bound for the error of `delta`, less than `delta` itself.
    pub(super) error: f64,
    pub(super) inverse_a: f64,
}

/// One of the two places where a line crosses a sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum WhichRoot {
    /// Where it enters.
    Near,
    /// Where it leaves.
    Far,
}

/// Both roots in doubles.
pub(super) struct Approximation {
    pub(super) near: f64,
    pub(super) far: f64,
    /// A bound of the error of both, and of the rounding when it is added to them or subtracted.
    pub(super) error: f64,
    /// `1 / sqrt(Delta)`, rounded three times
    inverse_root: f64,
}

impl SphereCrossing {
    #[inline(always)]
    pub(super) fn approximation(&self) -> Approximation {
        // The division need not wait for the root.
        let (root, inverse) = (self.delta.sqrt(), 1.0 / self.delta);
        Approximation {
            near: (-self.b - root) * self.inverse_a,
            far: (root - self.b) * self.inverse_a,
            error: ((1.6 * self.error) * self.inverse_a) * inverse * root,
            inverse_root: inverse * root,
        }
    }

    /// Which root, if any, is the first from +0.0 on; `None` if the range starts elsewhere or it is not certain.
    ///
    /// The signs of the coefficients tell: of the roots' product c / a and, if it is positive, of their sum -2 b / a.
    /// `docs/numerics.md` shows that the sign of b is then certain.
    #[inline(always)]
    pub(super) fn first_ahead(&self, start: f64) -> Option<Option<WhichRoot>> {
        let certain = start.to_bits() == 0 && self.c.abs() > 14.0 * U * self.squares;
        let first = match (self.c < 0.0, self.b < 0.0) {
            (true, _) => Some(WhichRoot::Far),
            (false, true) => Some(WhichRoot::Near),
            (false, false) => None,
        };
        certain.then_some(first)
    }

    /// Which root, if any, is the first not before the start of a range; `None` if that is not certain.
    #[inline(always)]
    pub(super) fn first(&self, start: f64, roots: &Approximation) -> Option<Option<WhichRoot>> {
        let Approximation { near, far, error, .. } = *roots;
        if let Some(first) = self.first_ahead(start) {
            Some(first)
        } else if near - error > start {
            Some(Some(WhichRoot::Near))
        } else if near + error < start && far - error > start {
            Some(Some(WhichRoot::Far))
        } else if far + error < start {
            Some(None)
        } else {
            None
        }
    }
}

impl Approximation {
    /// Which root, if any, is the first from +0.0 on for a ray that starts so near to the surface that the filter does not
    /// know on which side; `None` if it starts on it, or the other root is near too.
    ///
    /// The roots have different signs if the origin is inside, and the same if it is outside.
    #[cold]
    #[inline(never)]
    pub(super) fn first_by_side(&self, side: Side) -> Option<Option<WhichRoot>> {
        match side {
            Side::Inside => Some(Some(WhichRoot::Far)),
            Side::Outside if self.far - self.error > 0.0 => Some(Some(WhichRoot::Near)),
            Side::Outside if self.far + self.error < 0.0 => Some(None),
            _ => None,
        }
    }
}

/// Returns a root, correctly rounded, if one step is enough for certainty.
#[inline(always)]
pub(super) fn rounded<const FMA: bool, S: Simd>(
    simd: S,
    sphere: &Sphere,
    ray: &Ray,
    crossing: &SphereCrossing,
    roots: &Approximation,
    place: WhichRoot,
) -> Option<f64> {
    let (t, step, error) = refined::<FMA, S>(simd, sphere, ray, crossing, roots, place)?;
    round_if_certain(t, step, error)
}

/// Returns a root as the filter's `t`, one step, and a bound of the error of their sum as the rounding test wants it;
/// `None` if the filter knows too little of `sqrt(Delta)`.
#[inline(always)]
fn refined<const FMA: bool, S: Simd>(
    simd: S,
    sphere: &Sphere,
    ray: &Ray,
    crossing: &SphereCrossing,
    roots: &Approximation,
    place: WhichRoot,
) -> Option<(f64, f64, f64)> {
    let inverse_root = roots.inverse_root;
    let (t, half_inverse) = match place {
        WhichRoot::Near => (roots.near, 0.5 * inverse_root),
        WhichRoot::Far => (roots.far, -0.5 * inverse_root),
    };
    // How far off 2 sqrt(Delta) is, relatively.
    let slack = crossing.error * inverse_root * inverse_root;
    let error = RESIDUAL_ERROR * crossing.squares * inverse_root;
    if slack > 0.125 {
        return None;
    }
    let residual = residual::<FMA, _>(simd, sphere, ray, t);
    let relative = 2.5 * slack * half_inverse.abs();
    Some((t, residual * half_inverse, residual.abs() * relative + error))
}

/// `|w + t d|² - r²` for a `t` that is nearly a root.
///
/// The four lanes are the coordinates and, as a fourth one that does not move, the radius: its square counts negative.
#[inline(always)]
fn residual<const FMA: bool, S: Simd>(simd: S, sphere: &Sphere, ray: &Ray, t: f64) -> f64 {
    let (o, c, d) = (ray.origin(), sphere.center, ray.direction());
    let origin = f64x4::simd_from(simd, [o.x, o.y, o.z, 0.0]);
    let center = f64x4::simd_from(simd, [c.x, c.y, c.z, sphere.radius]);
    let direction = f64x4::simd_from(simd, [d.x, d.y, d.z, 0.0]);
    let (square, low) = square::<FMA, S, _>((origin, direction), center, f64x4::splat(simd, t));
    // (x² + z²) + (y² - r²) is nearly zero, so that the last of these sums is as good as exact.
    let sign = f64x2::simd_from(simd, [1.0, -1.0]);
    let ((square, square_of_z_r), (low, low_of_z_r)) = (square.split(), low.split());
    let (sum, error) = two_sum(square, square_of_z_r * sign);
    let low = low_of_z_r.mul_add(sign, low);
    let total = |lanes: f64x2<S>| <[f64; 2]>::from(lanes).into_iter().sum::<f64>();
    (total(sum) + total(error)) + total(low)
}

/// The squares of coordinates of `o - c + t d`, as square + low.
#[inline(always)]
pub(super) fn square<const FMA: bool, S: Simd, V>((o, d): (V, V), c: V, t: V) -> (V, V)
where
    V: SimdFloat<S, Element = f64> + Mul<f64, Output = V>,
{
    let (w, w_low) = two_diff(o, c);
    let (step, step_low) = two_prod::<FMA, S, _>(t, d);
    let (high, error) = two_sum(w, step);
    let low = error + (w_low + step_low);
    let (square, square_low) = two_prod::<FMA, S, _>(high, high);
    (square, (high + high).mul_add(low, square_low))
}

#[cfg(test)]
mod tests {
    use std::cmp::Ordering;

    use fearless_simd::Fallback;
    use oracle::{Big, Random, exact, sphere_equation, sub, vector};
    use rt_math::Roots;

    use super::super::exact as integers;
    use super::super::filter::{closest, closest_kernel, filter, roots, roots_kernel};
    use super::*;
    use crate::ray::{Candidates, FilterVerdict, PreparedRay};

    /// A sphere and a ray at it, from up to 2^20 radii away.
    fn case(rng: &mut Random, i: i32) -> (Sphere, Ray) {
        let (origin, center) = (10.0 * rng.point(), rng.point());
        let sphere = Sphere::new(center, 2f64.powi(-(i % 20))).unwrap();
        let target = center + 0.5 * sphere.radius * rng.point();
        (sphere, Ray::new(origin, target - origin).unwrap())
    }

    #[test]
    fn lanes_and_plain_arithmetic_give_the_same_roots() {
        let rng = &mut Random::new(3);
        for i in 0..4096 {
            let (sphere, ray) = case(rng, i);
            let level = Fallback::new();
            // What this processor has, plain arithmetic, and fused multiply-add in software.
            let all = roots(&sphere, &ray);
            assert_eq!(all, roots_kernel::<false, _>(level, &sphere, &ray), "{sphere:?} {ray:?}");
            assert_eq!(all, roots_kernel::<true, _>(level, &sphere, &ray), "{sphere:?} {ray:?}");
            let first = closest(&sphere, &ray, 0.0, f64::INFINITY);
            assert_eq!(first, closest_kernel::<false, _>(level, &sphere, &ray, 0.0, f64::INFINITY));
            assert_eq!(first, closest_kernel::<true, _>(level, &sphere, &ray, 0.0, f64::INFINITY));
            assert!(matches!(all, Roots::Two(near, _) if first == Some(near)), "{sphere:?} {ray:?}");
        }
    }

    #[test]
    fn the_bounds_of_a_candidate_hold_its_t() {
        let rng = &mut Random::new(4);
        for i in 0..4096 {
            let (sphere, ray) = case(rng, i);
            let whole = PreparedRay::new(&ray, 0.0..f64::INFINITY);
            let bounds = sphere.candidate::<true>(&whole, f64::INFINITY);
            let Roots::Two(near, _) = integers::roots(&sphere, &ray) else { panic!("{sphere:?} {ray:?}") };
            assert!(bounds.low <= near && near <= bounds.high, "{sphere:?} {ray:?} {bounds:?} {near}");
            assert!(bounds.low < bounds.high);
        }
    }
    /// From on the surface to 2^10 radii away, and from the middle to within 2^-30 of grazing: both bounds are met, and
    /// nearly enough that neither could be 2^7 times smaller.
    #[test]
    fn the_residual_and_one_step_keep_their_bounds() {
        let rng = &mut Random::new(5);
        let mut steps = 0;
        for i in 0..6000 {
            let radius = 1.0 + rng.uniform().abs();
            let (center, direction) = (rng.point(), rng.point());
            let side = direction.cross(rng.point()).normalize();
            let off = radius * (1.0 - 2f64.powi(-(i % 31)) * rng.uniform().abs());
            let along = radius * 2f64.powi(i % 11) * rng.uniform();
            let sphere = Sphere::new(center, radius).unwrap();
            let ray = Ray::new(center + off * side + along * direction, direction).unwrap();
            let FilterVerdict::Crosses(crossing) = filter::<false>(&sphere, &ray) else { continue };
            let offset = sub(&vector(ray.origin()), &vector(center));
            let truth = sphere_equation(&vector(ray.direction()), &offset, &exact(radius));
            let roots = crossing.approximation();
            for place in [WhichRoot::Near, WhichRoot::Far] {
                let simd = Fallback::new();
                let Some((t, step, error)) = refined::<false, _>(simd, &sphere, &ray, &crossing, &roots, place) else {
                    continue;
                };
                steps += 1;
                let off = truth.value(&exact(t)) - exact(residual::<false, _>(simd, &sphere, &ray, t));
                let bound = exact(2.0 * RESIDUAL_ERROR * crossing.squares);
                assert!(off < bound && -off < bound, "residual: {sphere:?} {ray:?}");
                let (root, error) = (exact(t) + exact(step), exact(error));
                let compare = |x: &Big| truth.compare(place == WhichRoot::Far, x);
                assert_eq!(compare(&(&root - &error)), Ordering::Greater, "step: {sphere:?} {ray:?}");
                assert_eq!(compare(&(&root + &error)), Ordering::Less, "step: {sphere:?} {ray:?}");
            }
        }
        assert!(steps > 9000, "{steps}");
    }
}
