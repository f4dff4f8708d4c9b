//! Eight rays at once, or the coordinates of one: what the vector kernels share.

use fearless_simd::{Simd, f64x4, f64x8, prelude::*};
use glam::DVec3;

use crate::Ray;

/// Eight rays with one origin, a quantity a vector.
pub(crate) struct PencilLanes<S: Simd> {
    pub(crate) origin: DVec3,
    pub(crate) direction: [f64x8<S>; 3],
    /// As [`Ray`] has them.
    pub(crate) reach: f64x8<S>,
    pub(crate) square: f64x8<S>,
    pub(crate) inverse_square: f64x8<S>,
}

impl<S: Simd> PencilLanes<S> {
    /// `v . d` in plain doubles.
    #[inline(always)]
    pub(crate) fn dot(&self, v: DVec3) -> f64x8<S> {
        let [x, y, z] = self.direction;
        x.mul_add(v.x, y.mul_add(v.y, z * v.z))
    }

    /// `d x v` in plain doubles.
    #[inline(always)]
    pub(crate) fn cross(&self, v: DVec3) -> [f64x8<S>; 3] {
        let [x, y, z] = self.direction;
        [y.mul_sub(v.z, z * v.y), z.mul_sub(v.x, x * v.z), x.mul_sub(v.y, y * v.x)]
    }
}

/// A shape with kernels for eight rays, as far as a filter and one step decide. What they leave open is for
/// [`candidate`](crate::ray::Candidates::candidate) to decide.
pub(crate) trait LaneKernels {
    /// What a filter says about this shape and eight rays of one origin.
    fn pencil_candidates<S: Simd>(&self, simd: S, rays: &PencilLanes<S>, range: (f64, f64)) -> LaneCandidates<S>;

    /// What a filter says about eight rays, each with a shape.
    fn lane_candidates<S: Simd>(
        simd: S,
        shapes: [&Self; 8],
        rays: &RayLanes<S>,
        range: (f64, f64),
    ) -> LaneCandidates<S>;

    /// The correctly rounded `t` of eight hits with bounds, each with its shape, and in which lanes it is certain, as
    /// bits.
    fn lane_roundings<const FMA: bool, S: Simd>(
        simd: S,
        shapes: [&Self; 8],
        rays: &RayLanes<S>,
        bounds: (f64x8<S>, f64x8<S>),
    ) -> (f64x8<S>, u64);
}

/// What a filter says about eight rays and the shapes that they may meet.
pub(crate) struct LaneCandidates<S: Simd> {
    pub(crate) low: f64x8<S>,
    pub(crate) high: f64x8<S>,
    /// As bits: the rays that surely have no hit in the range, and those of which the bounds are a [`Candidate`]'s.
    pub(crate) none: u64,
    pub(crate) some: u64,
}

impl<S: Simd> LaneCandidates<S> {
    /// Where lines surely miss, or surely cross at a `t` between these bounds, both as bits.
    #[inline(always)]
    pub(crate) fn new(
        simd: S,
        (misses, crosses): (u64, u64),
        (low, high): (f64x8<S>, f64x8<S>),
        (start, end): (f64, f64),
    ) -> Self {
        let (start, end) = (f64x8::splat(simd, start), f64x8::splat(simd, end));
        let inside = (low.simd_gt(start) & high.simd_lt(end)).to_bitmask();
        let outside = (low.simd_gt(end) | high.simd_lt(start)).to_bitmask();
        Self { low, high, none: misses | (crosses & outside), some: crosses & inside }
    }
}

/// Eight rays of any origin, a quantity a vector.
pub(crate) struct RayLanes<S: Simd> {
    pub(crate) origin: [f64x8<S>; 3],
    pub(crate) direction: [f64x8<S>; 3],
    /// As [`Ray`] has them.
    pub(crate) reach: f64x8<S>,
    pub(crate) square: f64x8<S>,
    pub(crate) inverse_square: f64x8<S>,
}

impl<S: Simd> RayLanes<S> {
    #[inline(always)]
    pub(crate) fn new(simd: S, rays: [&Ray; 8]) -> Self {
        Self {
            origin: [
                lanes(simd, rays, |ray| ray.origin().x),
                lanes(simd, rays, |ray| ray.origin().y),
                lanes(simd, rays, |ray| ray.origin().z),
            ],
            direction: [
                lanes(simd, rays, |ray| ray.direction().x),
                lanes(simd, rays, |ray| ray.direction().y),
                lanes(simd, rays, |ray| ray.direction().z),
            ],
            reach: lanes(simd, rays, Ray::reach),
            square: lanes(simd, rays, Ray::square),
            inverse_square: lanes(simd, rays, Ray::inverse_square),
        }
    }
}

/// A vector in the first three lanes.
#[inline(always)]
pub(crate) fn four<S: Simd>(simd: S, v: DVec3) -> f64x4<S> {
    f64x4::simd_from(simd, [v.x, v.y, v.z, v.z])
}

/// A number of each of eight things.
#[inline(always)]
pub(crate) fn lanes<S: Simd, T>(simd: S, things: [&T; 8], number: impl Fn(&T) -> f64) -> f64x8<S> {
    let mut numbers = [0.0; 8];
    for (lane, thing) in numbers.iter_mut().zip(things) {
        *lane = number(thing);
    }
    f64x8::from_slice(simd, &numbers)
}

/// The difference of two points in every lane.
#[inline(always)]
pub(crate) fn minus<S: Simd>(v: &[f64x8<S>; 3], w: &[f64x8<S>; 3]) -> [f64x8<S>; 3] {
    [v[0] - w[0], v[1] - w[1], v[2] - w[2]]
}

/// `v x w` in every lane, in plain doubles.
#[inline(always)]
pub(crate) fn cross<S: Simd>(v: &[f64x8<S>; 3], w: &[f64x8<S>; 3]) -> [f64x8<S>; 3] {
    [v[1].mul_sub(w[2], v[2] * w[1]), v[2].mul_sub(w[0], v[0] * w[2]), v[0].mul_sub(w[1], v[1] * w[0])]
}

/// `v . w` in every lane, in plain doubles.
#[inline(always)]
pub(crate) fn dot<S: Simd>(v: &[f64x8<S>; 3], w: &[f64x8<S>; 3]) -> f64x8<S> {
    v[0].mul_add(w[0], v[1].mul_add(w[1], v[2] * w[2]))
}
