//! The filter of lines and spheres, and what follows it: last bits where it is certain, exact arithmetic where it is
//! not.

use std::ops::Range;

use fearless_simd::{Simd, f64x8, prelude::*};
use rt_math::Roots;
use rt_math::exact::{U, power_of_two};

use super::finish::{SphereCrossing, WhichRoot, rounded};
use super::{Sphere, exact};
use crate::Ray;
use crate::ray::{Candidate, FilterVerdict, LaneCandidates, PreparedRay, RayLanes, cross, dot, holds};
use crate::simd::dispatch;

/// Where the filter's bounds are proved: `w.w + r²` is at least `2^-250` and at most `2^600`. Nothing overflows there,
/// and what underflows is far below the bounds.
const SMALLEST: f64 = power_of_two(-250);
const LARGEST: f64 = power_of_two(600);

/// The error of `Delta` in the filter, relative to `d.d (w.w + r²)`, as `docs/numerics.md`, section 5, has it.
const ERROR: f64 = 17.0 * U;

/// The filter: decides in plain doubles whether the line crosses the surface, where that is certain.
// Modelled in docs/proofs/Sphere.v: tx, tdelta, tsquares, terror, tb, tc.
#[inline(always)]
pub(super) fn filter<const FMA: bool>(sphere: &Sphere, ray: &Ray) -> FilterVerdict<SphereCrossing> {
    let d = ray.direction();
    let w = ray.origin() - sphere.center;
    let x = cross::<FMA>(w, d);
    let (w_square, radius_square) = (dot::<FMA>(w, w), sphere.radius * sphere.radius);
    let delta = ray.square() * radius_square - dot::<FMA>(x, x);
    let squares = w_square + radius_square;
    // NaN if the direction is out of the range where this is proved.
    let error = (ERROR * ray.square()) * squares;
    if !(squares > SMALLEST && squares < LARGEST) {
        return FilterVerdict::Unsure;
    }
    if delta < -error {
        return FilterVerdict::Misses;
    }
    if delta > error {
        let (b, c) = (dot::<FMA>(w, d), w_square - radius_square);
        return FilterVerdict::Crosses(SphereCrossing { b, c, squares, delta, error, inverse_a: ray.inverse_square() });
    }
    FilterVerdict::Unsure
}

dispatch! {
    /// Returns the correctly rounded closest root between the ends of the range.
    pub(super) fn closest(sphere: &Sphere, ray: &Ray, start: f64, end: f64) -> Option<f64> = closest_kernel;
}

#[inline(always)]
pub(super) fn closest_kernel<const FMA: bool, S: Simd>(
    simd: S,
    sphere: &Sphere,
    ray: &Ray,
    start: f64,
    end: f64,
) -> Option<f64> {
    let within = start..end;
    let root = match filter::<FMA>(sphere, ray) {
        FilterVerdict::Misses => return None,
        FilterVerdict::Crosses(crossing) => {
            let roots = crossing.approximation();
            match crossing.first(start, &roots) {
                Some(Some(place)) => rounded::<FMA, _>(simd, sphere, ray, &crossing, &roots, place),
                Some(None) => return None,
                None => None,
            }
        }
        FilterVerdict::Unsure => None,
    };
    match root {
        Some(t) => holds(&within, t).then_some(t),
        None => exact::closest(sphere, ray, within),
    }
}

dispatch! {
    /// Returns the correctly rounded roots.
    pub(super) fn roots(sphere: &Sphere, ray: &Ray) -> Roots = roots_kernel;
}

#[inline(always)]
pub(super) fn roots_kernel<const FMA: bool, S: Simd>(simd: S, sphere: &Sphere, ray: &Ray) -> Roots {
    match filter::<FMA>(sphere, ray) {
        FilterVerdict::Misses => Roots::None,
        FilterVerdict::Crosses(crossing) => {
            let roots = crossing.approximation();
            let near = rounded::<FMA, _>(simd, sphere, ray, &crossing, &roots, WhichRoot::Near);
            let far = rounded::<FMA, _>(simd, sphere, ray, &crossing, &roots, WhichRoot::Far);
            match (near, far) {
                (Some(near), Some(far)) => Roots::Two(near, far),
                _ => exact::roots(sphere, ray),
            }
        }
        FilterVerdict::Unsure => exact::roots(sphere, ray),
    }
}

impl Sphere {
    /// What `any` returns.
    #[inline(always)]
    pub(crate) fn meets<const FMA: bool>(&self, prepared: &PreparedRay) -> bool {
        match filter::<FMA>(self, prepared.ray) {
            FilterVerdict::Misses => false,
            // For the whole ray the signs are enough, and need no root.
            FilterVerdict::Crosses(crossing) => match crossing.first_ahead(prepared.start) {
                Some(None) => false,
                Some(Some(_)) if prepared.end == f64::INFINITY => true,
                _ => self.offer(&crossing, prepared, f64::INFINITY).is_some(),
            },
            FilterVerdict::Unsure => self.exact_candidate(prepared.ray, prepared.within(), f64::INFINITY).is_some(),
        }
    }

    /// Returns bounds of the closest hit's `t`, or `None` if nothing in the range is hit or the hit surely lies
    /// beyond `limit`.
    #[inline(always)]
    pub(crate) fn candidate<const FMA: bool>(&self, prepared: &PreparedRay, limit: f64) -> Option<Candidate> {
        match filter::<FMA>(self, prepared.ray) {
            FilterVerdict::Misses => None,
            FilterVerdict::Crosses(crossing) => self.offer(&crossing, prepared, limit),
            FilterVerdict::Unsure => self.exact_candidate(prepared.ray, prepared.within(), limit),
        }
    }

    /// The same for eight rays, as far as the filter decides and the near root is the hit.
    // The operations of `filter` and `approximation`.
    #[inline(always)]
    pub(crate) fn lane_candidates<S: Simd>(
        &self,
        simd: S,
        rays: &RayLanes<S>,
        (start, end): (f64, f64),
    ) -> LaneCandidates<S> {
        let w = rays.origin - self.center;
        let [x, y, z] = rays.cross(w);
        let (w_square, radius_square) = (dot::<false>(w, w), self.radius * self.radius);
        let delta = rays.square.mul_sub(radius_square, x.mul_add(x, y.mul_add(y, z * z)));
        let squares = w_square + radius_square;
        let error = (rays.square * ERROR) * squares;
        let is_proved = squares > SMALLEST && squares < LARGEST;
        let proved = if is_proved { u64::MAX } else { 0 };
        let misses = delta.simd_lt(-error).to_bitmask() & proved;
        let crosses = delta.simd_gt(error).to_bitmask() & proved;
        if crosses == 0 {
            return LaneCandidates { low: delta, high: delta, none: misses, some: 0 };
        }
        let (root, inverse) = (delta.sqrt(), f64x8::splat(simd, 1.0) / delta);
        let near = (-rays.dot(w) - root) * rays.inverse_square;
        let error = ((error * 1.6) * rays.inverse_square) * inverse * root;
        let (low, high) = (near - error, near + error);
        let in_range = (low.simd_gt(f64x8::splat(simd, start)) & high.simd_lt(f64x8::splat(simd, end))).to_bitmask();
        let beyond = low.simd_gt(f64x8::splat(simd, end)).to_bitmask();
        LaneCandidates { low, high, none: misses | (crosses & beyond), some: crosses & in_range }
    }

    /// Returns the candidate of a line that crosses the surface.
    #[inline(always)]
    fn offer(&self, crossing: &SphereCrossing, prepared: &PreparedRay, limit: f64) -> Option<Candidate> {
        let roots = crossing.approximation();
        let (low, high) = (roots.near - roots.error, roots.near + roots.error);
        if low > prepared.start && high < prepared.end {
            (low <= limit).then_some(Candidate { low, high })
        } else {
            self.offer_far(roots.near, roots.far, roots.error, prepared, limit)
        }
    }

    /// The same where the near root is not surely in the range. Apart, so that the usual case waits for no choice of
    /// the root.
    #[inline(never)]
    fn offer_far(&self, near: f64, far: f64, error: f64, prepared: &PreparedRay, limit: f64) -> Option<Candidate> {
        let t = if near + error < prepared.start { far } else { near };
        prepared.admit((t - error, t + error), limit, || self.exact_candidate(prepared.ray, prepared.within(), limit))
    }

    #[cold]
    #[inline(never)]
    fn exact_candidate(&self, ray: &Ray, within: Range<f64>, limit: f64) -> Option<Candidate> {
        Candidate::exact(exact::closest(self, ray, within), limit)
    }
}
