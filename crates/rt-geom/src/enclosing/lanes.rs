//! Up to 64 spheres side by side, eight to a vector, and the scan for the one that sticks out farthest.

use fearless_simd::{Simd, f64x8, prelude::*, u64x8};
use glam::DVec3;

use crate::Sphere;

/// The lanes of a vector.
pub(super) const LANES: usize = 8;

/// Spheres by coordinate, relative to an origin. Unused lanes repeat the first sphere.
#[derive(Clone, Copy)]
pub(super) struct Lanes<S: Simd, const VECTORS: usize> {
    vectors: [[f64x8<S>; 4]; VECTORS],
    used: usize,
    count: usize,
}

impl<S: Simd, const VECTORS: usize> Lanes<S, VECTORS> {
    /// Takes at least one sphere, and at most eight to a vector.
    #[inline(always)]
    pub(super) fn new<'a>(
        simd: S,
        spheres: impl ExactSizeIterator<Item = &'a Sphere> + Clone,
        origin: DVec3,
    ) -> Self {
        let count = spheres.len();
        let used = count.div_ceil(LANES).min(VECTORS);
        let mut vectors = [[f64x8::splat(simd, 0.0); 4]; VECTORS];
        let mut rest = spheres.clone();
        let Some(first) = spheres.clone().next() else { return Self { vectors, used: 0, count } };
        for vector in &mut vectors[..used] {
            let mut at = [first; LANES];
            for at in &mut at {
                let Some(next) = rest.next() else { break };
                *at = next;
            }
            *vector = [
                f64x8::simd_from(simd, at.map(|sphere| sphere.center().x)) - origin.x,
                f64x8::simd_from(simd, at.map(|sphere| sphere.center().y)) - origin.y,
                f64x8::simd_from(simd, at.map(|sphere| sphere.center().z)) - origin.z,
                f64x8::simd_from(simd, at.map(Sphere::radius)),
            ];
        }
        Self { vectors, used, count }
    }

    /// The sphere that reaches farthest from the origin, and how far, up to the six lowest bits.
    #[inline(always)]
    pub(super) fn farthest_from_origin(&self, simd: S) -> (usize, f64) {
        let mut most = f64x8::splat(simd, 0.0);
        let mut lane = u64x8::simd_from(simd, [0, 1, 2, 3, 4, 5, 6, 7]);
        for [x, y, z, r] in &self.vectors[..self.used] {
            // An infinite reach with a mark would be no number.
            let reach = ((*x * *x + *y * *y + *z * *z).sqrt() + *r).min(f64x8::splat(simd, f64::MAX));
            let bits: u64x8<S> = reach.bitcast();
            let marked: f64x8<S> = ((bits & !63) | lane).bitcast();
            most = most.max(marked);
            lane += LANES as u64;
        }
        let most = most.reduce_max();
        let lane = (most.to_bits() & 63) as usize;
        (if lane < self.count { lane } else { 0 }, most)
    }

    /// Returns the sphere that sticks out farthest of the one around `center`, and a measure of how far: positive if
    /// it sticks out.
    ///
    /// The measure is `d² - (radius - r)²`: the excess times about twice the radius, without a root. Its six lowest bits
    /// carry the index, so that one maximum finds both. (An unused lane stands for the first sphere.)
    #[inline(always)]
    pub(super) fn farthest(&self, simd: S, center: [f64; 3], radius: f64) -> (usize, f64) {
        let mut most = f64x8::splat(simd, f64::NEG_INFINITY);
        let mut lane = u64x8::simd_from(simd, [0, 1, 2, 3, 4, 5, 6, 7]);
        for [x, y, z, r] in &self.vectors[..self.used] {
            let (dx, dy, dz) = (*x - center[0], *y - center[1], *z - center[2]);
            let room = radius - *r;
            let measure = (dx * dx + dy * dy + dz * dz) - room * room;
            let bits: u64x8<S> = measure.bitcast();
            let marked: f64x8<S> = ((bits & !63) | lane).bitcast();
            most = most.max(marked);
            lane += LANES as u64;
        }
        let most = most.reduce_max();
        let lane = (most.to_bits() & 63) as usize;
        (if lane < self.count { lane } else { 0 }, most)
    }

    /// Returns which spheres reach farther than `limit` from `center`, as bits.
    #[inline(always)]
    pub(super) fn beyond(&self, simd: S, center: [f64; 3], limit: f64) -> u64 {
        let mut found = 0;
        for (i, [x, y, z, r]) in self.vectors[..self.used].iter().enumerate() {
            let (dx, dy, dz) = (*x - center[0], *y - center[1], *z - center[2]);
            let room = f64x8::splat(simd, limit) - *r;
            let beyond = (dx * dx + dy * dy + dz * dz).simd_ge(room * room.abs()).to_bitmask();
            found |= beyond << (LANES * i);
        }
        found
    }
}
