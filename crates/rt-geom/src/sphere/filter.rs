//! The filter of lines and spheres, and what follows it: last bits where it is certain, exact arithmetic where it is
//! not.

use std::ops::Range;

use fearless_simd::Simd;
use rt_math::Roots;
use rt_math::exact::{U, power_of_two};

use super::finish::{Approximation, SphereCrossing, WhichRoot, rounded};
use super::{Sphere, exact};
use crate::Ray;
use crate::ray::{Candidate, Candidates, FilterVerdict, PreparedRay, cross, dot, holds};
use crate::simd::dispatch;

/// Where the filter's bounds are proved: `w.w + r²` is at least `2^-250` and at most `2^600`. Nothing overflows there,
/// and what underflows is far below the bounds.
pub(super) const SMALLEST: f64 = power_of_two(-250);
pub(super) const LARGEST: f64 = power_of_two(600);

/// The error of `Delta` in the filter, relative to `d.d (w.w + r²)`, as `docs/numerics.md`, section 5, has it.
pub(super) const ERROR: f64 = 17.0 * U;

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
            let mut first = crossing.first(start, &roots);
            if first.is_none() && start.to_bits() == 0 {
                first = roots.first_by_side(exact::side(sphere, ray.origin()));
            }
            match first {
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

impl Candidates for Sphere {
    #[inline(always)]
    fn meets<const FMA: bool>(&self, prepared: &PreparedRay) -> bool {
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

    #[inline(always)]
    fn candidate<const FMA: bool>(&self, prepared: &PreparedRay, limit: f64) -> Candidate {
        match filter::<FMA>(self, prepared.ray) {
            FilterVerdict::Misses => Candidate::NONE,
            FilterVerdict::Crosses(crossing) => self.offer(&crossing, prepared, limit),
            FilterVerdict::Unsure => self.exact_candidate(prepared.ray, prepared.within(), limit),
        }
    }
}

impl Sphere {
    /// Returns the candidate of a line that crosses the surface.
    #[inline(always)]
    fn offer(&self, crossing: &SphereCrossing, prepared: &PreparedRay, limit: f64) -> Candidate {
        let roots = crossing.approximation();
        let (low, high) = (roots.near - roots.error, roots.near + roots.error);
        if low > prepared.start && high < prepared.end {
            if low <= limit { Candidate { low, high } } else { Candidate::NONE }
        } else {
            self.offer_far(&roots, prepared, limit)
        }
    }

    /// The same where the near root is not surely in the range. Apart, so that the usual case waits for no choice of
    /// the root.
    #[inline(never)]
    fn offer_far(&self, roots: &Approximation, prepared: &PreparedRay, limit: f64) -> Candidate {
        let Approximation { near, far, error, .. } = *roots;
        let mut t = if near + error < prepared.start { far } else { near };
        if prepared.start.to_bits() == 0 && near - error <= 0.0 && near + error >= 0.0 {
            match roots.first_by_side(exact::side(self, prepared.ray.origin())) {
                Some(Some(WhichRoot::Far)) => t = far,
                Some(None) => return Candidate::NONE,
                _ => {}
            }
        }
        prepared.admit((t - error, t + error), limit, || self.exact_candidate(prepared.ray, prepared.within(), limit))
    }

    #[cold]
    #[inline(never)]
    fn exact_candidate(&self, ray: &Ray, within: Range<f64>, limit: f64) -> Candidate {
        Candidate::exact(exact::closest(self, ray, within), limit)
    }
}
