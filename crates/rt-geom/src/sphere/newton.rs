//! The correctly rounded roots of a line that surely crosses a sphere: one Newton step on a precise residual.
//!
//! The filter's root `t` in doubles is put into `f(t) = |w + t d|² - r²`, which is computed to twice the precision. If
//! `t*` is the root, `f(t) = a (t - near) (t - far)` and `far - near = 2 sqrt(Delta) / a` give
//!
//! ```text
//!     t* - t = f(t) / (2 sqrt(Delta) + a (t* - t))        for the near root, and for the far one with both signs turned
//! ```
//!
//! of which the filter knows `sqrt(Delta)`, and that `t* - t` is small. A rounding test tells whether `t` and this step decide the
//! last bit. `docs/numerics.md`, section 5, proves the bounds.

use rt_math::Roots;
use rt_math::exact::{round_if_certain, two_diff, two_prod, two_sum};
use rt_math::fma_dispatch;

use super::{Approximation, Crossing, Line, Place, Sphere, U, exact};
use crate::Ray;
use crate::ray::holds;

/// The error of the residual, relative to `w.w + r²`.
const RESIDUAL_ERROR: f64 = 1024.0 * U * U;

fma_dispatch! {
    /// Returns the correctly rounded closest root between the ends of the range.
    pub(super) fn closest(sphere: &Sphere, ray: &Ray, start: f64, end: f64) -> Option<f64> = closest_kernel;
}

#[inline(always)]
fn closest_kernel<const FMA: bool>(sphere: &Sphere, ray: &Ray, start: f64, end: f64) -> Option<f64> {
    let within = start..end;
    let root = match sphere.line::<FMA>(ray) {
        Line::Misses => return None,
        Line::Crosses(crossing) => {
            let roots = crossing.approximation();
            match crossing.first(start, &roots) {
                Some(Some(place)) => rounded::<FMA>(sphere, ray, &crossing, &roots, place),
                Some(None) => return None,
                None => None,
            }
        }
        Line::Unsure => None,
    };
    match root {
        Some(t) => holds(&within, t).then_some(t),
        None => exact::closest(sphere, ray, within),
    }
}

fma_dispatch! {
    /// Returns the correctly rounded roots.
    pub(super) fn roots(sphere: &Sphere, ray: &Ray) -> Roots = roots_kernel;
}

#[inline(always)]
fn roots_kernel<const FMA: bool>(sphere: &Sphere, ray: &Ray) -> Roots {
    match sphere.line::<FMA>(ray) {
        Line::Misses => Roots::None,
        Line::Crosses(crossing) => {
            let roots = crossing.approximation();
            let near = rounded::<FMA>(sphere, ray, &crossing, &roots, Place::Near);
            let far = rounded::<FMA>(sphere, ray, &crossing, &roots, Place::Far);
            match (near, far) {
                (Some(near), Some(far)) => Roots::Two(near, far),
                _ => exact::roots(sphere, ray),
            }
        }
        Line::Unsure => exact::roots(sphere, ray),
    }
}

/// Returns a root, correctly rounded, if one step is enough for certainty.
#[inline(always)]
pub(super) fn rounded<const FMA: bool>(
    sphere: &Sphere,
    ray: &Ray,
    crossing: &Crossing,
    roots: &Approximation,
    place: Place,
) -> Option<f64> {
    let inverse_root = roots.inverse_root;
    let (t, half_inverse) = match place {
        Place::Near => (roots.near, 0.5 * inverse_root),
        Place::Far => (roots.far, -0.5 * inverse_root),
    };
    // How far off 2 sqrt(Delta) is, relatively.
    let slack = crossing.error * inverse_root * inverse_root;
    let error = RESIDUAL_ERROR * crossing.squares * inverse_root;
    if slack > 0.125 {
        return None;
    }
    let step = residual::<FMA>(sphere, ray, t) * half_inverse;
    round_if_certain(t, step, step.abs() * (2.0 * slack + 8.0 * U) + error)
}

/// `|w + t d|² - r²` for a `t` that is nearly a root.
#[inline(always)]
fn residual<const FMA: bool>(sphere: &Sphere, ray: &Ray, t: f64) -> f64 {
    let (o, c, d, r) = (ray.origin(), sphere.center, ray.direction(), sphere.radius);
    // The square of a component of w + t d, as high + low.
    let square = |o: f64, c: f64, d: f64| {
        let (w, w_low) = two_diff(o, c);
        let (step, step_low) = two_prod::<FMA>(t, d);
        let (high, error) = two_sum(w, step);
        let low = error + (w_low + step_low);
        let (square, square_low) = two_prod::<FMA>(high, high);
        (square, square_low + 2.0 * high * low)
    };
    let (x, x_low) = square(o.x, c.x, d.x);
    let (y, y_low) = square(o.y, c.y, d.y);
    let (z, z_low) = square(o.z, c.z, d.z);
    let (r, r_low) = two_prod::<FMA>(r, r);
    // ((z - r²) + x) + y is nearly zero, so each step is exact but for an error that is easily had, and the last one is as
    // good as exact.
    let first = z - r;
    let first_error = z - (first + r);
    let second = first + x;
    let second_error = x - (second - first);
    (second + y) + (((x_low + y_low) + (z_low - r_low)) + (first_error + second_error))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::ray::PreparedRay;

    /// Numbers in -1..1 from a fixed seed (splitmix64).
    fn random(state: &mut u64) -> f64 {
        *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (*state ^ (*state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector(state: &mut u64) -> DVec3 {
        DVec3::new(random(state), random(state), random(state))
    }

    /// A sphere and a ray at it, from up to 2^20 radii away.
    fn case(state: &mut u64, i: i32) -> (Sphere, Ray) {
        let (origin, center) = (10.0 * vector(state), vector(state));
        let sphere = Sphere::new(center, 2f64.powi(-(i % 20))).unwrap();
        let target = center + 0.5 * sphere.radius * vector(state);
        (sphere, Ray::new(origin, target - origin).unwrap())
    }

    #[test]
    fn fused_and_plain_arithmetic_give_the_same_roots() {
        let state = &mut 3;
        for i in 0..4096 {
            let (sphere, ray) = case(state, i);
            let roots = roots_kernel::<false>(&sphere, &ray);
            assert_eq!(roots, roots_kernel::<true>(&sphere, &ray), "{sphere:?} {ray:?}");
            let closest = closest_kernel::<false>(&sphere, &ray, 0.0, f64::INFINITY);
            assert_eq!(closest, closest_kernel::<true>(&sphere, &ray, 0.0, f64::INFINITY));
            assert!(matches!(roots, Roots::Two(near, _) if closest == Some(near)), "{sphere:?} {ray:?}");
        }
    }

    #[test]
    fn the_bounds_of_a_candidate_hold_its_t() {
        let state = &mut 4;
        for i in 0..4096 {
            let (sphere, ray) = case(state, i);
            let whole = PreparedRay::new(&ray, 0.0..f64::INFINITY);
            let bounds = sphere.candidate::<true>(&whole, f64::INFINITY).unwrap();
            let Roots::Two(near, _) = exact::roots(&sphere, &ray) else { panic!("{sphere:?} {ray:?}") };
            assert!(bounds.low <= near && near <= bounds.high, "{sphere:?} {ray:?} {bounds:?} {near}");
            assert!(bounds.low < bounds.high);
        }
    }
}
