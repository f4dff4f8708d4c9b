//! Farthest-first pivoting over at most 64 spheres, side by side in registers, eight to a vector.

use fearless_simd::{Simd, f64x4, f64x8, prelude::*, u64x8};
use glam::DVec3;
use rt_math::exact::U;

use super::tangent::Tangent;
use crate::Sphere;

/// The lanes of a vector.
pub(super) const LANES: usize = 8;

/// Turns the minimal sphere of some of the spheres in `lanes` into that of all of them: adds the sphere that sticks out
/// farthest, until none does. `place` maps a lane to the place in `spheres`.
#[inline(never)]
pub(super) fn pivot<S: Simd, const VECTORS: usize>(
    simd: S,
    tangent: &mut Tangent<f64>,
    lanes: &SphereLanes<S, VECTORS>,
    place: impl Fn(usize) -> usize,
    spheres: &[Sphere],
    origin: DVec3,
) {
    simd.vectorize(
        #[inline(always)]
        || {
            for _ in 0..MAX_PIVOTS {
                let (center, radius) = tangent.sphere(spheres, origin);
                let (lane, measure) = lanes.farthest(simd, center, radius);
                let far = place(lane);
                if (measure <= radius * radius * TOUCHES) | tangent.has(far) {
                    break;
                }
                tangent.add(far, spheres);
            }
        },
    );
}

/// The measure of a sphere that touches from inside is below this share of the squared radius: rounding.
pub(super) const TOUCHES: f64 = 16.0 * U;

/// No set known needs more than a few dozen pivots. What is left to do after so many, the certificate sees.
const MAX_PIVOTS: usize = 100;

/// Spheres by coordinate, relative to an origin. Unused lanes repeat the first sphere.
#[derive(Clone, Copy)]
pub(super) struct SphereLanes<S: Simd, const VECTORS: usize> {
    vectors: [[f64x8<S>; 4]; VECTORS],
    used: usize,
    count: usize,
}

impl<S: Simd, const VECTORS: usize> SphereLanes<S, VECTORS> {
    /// Takes at least one sphere, and at most eight to a vector.
    #[inline(always)]
    pub(super) fn new<'a>(simd: S, spheres: impl ExactSizeIterator<Item = &'a Sphere> + Clone, origin: DVec3) -> Self {
        let count = spheres.len();
        let used = count.div_ceil(LANES).min(VECTORS);
        let mut vectors = [[f64x8::splat(simd, 0.0); 4]; VECTORS];
        let mut rest = spheres.clone();
        let Some(first) = spheres.clone().next() else { return Self { vectors, used: 0, count } };
        for vector in &mut vectors[..used] {
            let mut eight = [first; LANES];
            for at in &mut eight {
                let Some(next) = rest.next() else { break };
                *at = next;
            }
            *vector = columns(simd, eight, origin);
        }
        Self { vectors, used, count }
    }

    /// A sphere that reaches far from the mean of the centers, and the largest `d² + r²` there, up to the six lowest
    /// bits: the square of the largest reach is between this and twice as much.
    #[inline(always)]
    pub(super) fn farthest_from_mean(&self, simd: S) -> (usize, f64) {
        let mut sum = [f64x8::splat(simd, 0.0); 3];
        for [x, y, z, _] in &self.vectors[..self.used] {
            sum = [sum[0] + *x, sum[1] + *y, sum[2] + *z];
        }
        let share = 1.0 / (LANES * self.used) as f64;
        let mean = [sum[0].reduce_sum() * share, sum[1].reduce_sum() * share, sum[2].reduce_sum() * share];
        let mut most = f64x8::splat(simd, 0.0);
        let mut lane = u64x8::simd_from(simd, [0, 1, 2, 3, 4, 5, 6, 7]);
        for vector in &self.vectors[..self.used] {
            // An infinite number with a mark would be none.
            let square = measure(simd, vector, mean, 0.0).min(f64x8::splat(simd, f64::MAX));
            most = most.max(marked(square, lane));
            lane += LANES as u64;
        }
        let most = most.reduce_max();
        let lane = (most.to_bits() & 63) as usize;
        (if lane < self.count { lane } else { 0 }, most)
    }

    /// Returns the sphere that sticks out farthest of the one around `center`, and a measure of how far: positive if
    /// it sticks out.
    ///
    /// The six lowest bits of the [`measure`] carry the index, so that one maximum finds both. (An unused lane stands
    /// for the first sphere.)
    #[inline(always)]
    pub(super) fn farthest(&self, simd: S, center: [f64; 3], radius: f64) -> (usize, f64) {
        let mut most = f64x8::splat(simd, f64::NEG_INFINITY);
        let mut lane = u64x8::simd_from(simd, [0, 1, 2, 3, 4, 5, 6, 7]);
        for vector in &self.vectors[..self.used] {
            most = most.max(marked(measure(simd, vector, center, radius), lane));
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
        for (i, vector) in self.vectors[..self.used].iter().enumerate() {
            let beyond = measure(simd, vector, center, limit).simd_ge(f64x8::splat(simd, 0.0));
            found |= beyond.to_bitmask() << (LANES * i);
        }
        found
    }
}

#[inline(always)]
fn row<S: Simd>(simd: S, sphere: &Sphere) -> f64x4<S> {
    let c = sphere.center();
    f64x4::simd_from(simd, [c.x, c.y, c.z, sphere.radius()])
}

/// Eight spheres by coordinate, relative to an origin: x, y, z and radius.
#[inline(always)]
pub(super) fn columns<S: Simd>(simd: S, eight: [&Sphere; LANES], origin: DVec3) -> [f64x8<S>; 4] {
    let [a, b, c, d, e, f, g, h] = eight.map(
        #[inline(always)]
        |sphere| row(simd, sphere),
    );
    let (xz, yr) = a.combine(b).deinterleave(c.combine(d));
    let (xz_more, yr_more) = e.combine(f).deinterleave(g.combine(h));
    let (x, z) = xz.deinterleave(xz_more);
    let (y, r) = yr.deinterleave(yr_more);
    [x - origin.x, y - origin.y, z - origin.z, r]
}

/// Calls `visit` with eight spheres by coordinate after the other; at the end the first of the last eight is repeated.
#[inline(always)]
pub(super) fn for_eights<S: Simd>(simd: S, spheres: &[Sphere], origin: DVec3, mut visit: impl FnMut(&[f64x8<S>; 4])) {
    let (eights, rest) = spheres.as_chunks::<LANES>();
    for eight in eights {
        visit(&columns(simd, eight.each_ref(), origin));
    }
    if let Some(first) = rest.first() {
        let eight = std::array::from_fn(
            #[inline(always)]
            |i| rest.get(i).unwrap_or(first),
        );
        visit(&columns(simd, eight, origin));
    }
}

/// How far spheres stick out of the one around `center`: `d² - (radius - r)²`, where the square has the sign of what is
/// squared. That is the excess times about twice the radius, without a root; positive if a sphere sticks out.
#[inline(always)]
pub(super) fn measure<S: Simd>(simd: S, [x, y, z, r]: &[f64x8<S>; 4], center: [f64; 3], radius: f64) -> f64x8<S> {
    let (dx, dy, dz) = (*x - center[0], *y - center[1], *z - center[2]);
    let room = f64x8::splat(simd, radius) - *r;
    (dx * dx + dy * dy + dz * dz) - room * room.abs()
}

/// Numbers whose six lowest bits say where they are from.
#[inline(always)]
pub(super) fn marked<S: Simd>(numbers: f64x8<S>, place: u64x8<S>) -> f64x8<S> {
    let bits: u64x8<S> = numbers.bitcast();
    ((bits & !63) | place).bitcast()
}
