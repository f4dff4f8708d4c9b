//! The filter for eight rays of one origin, and the last bits of eight hits, in vectors: the operations of `filter.rs` and
//! `finish.rs`. What a lane leaves open is for the kernels of one ray.

use fearless_simd::{Simd, f64x8, prelude::*};
use rt_math::exact::{rounded_ends, two_diff, two_sum};

use super::Sphere;
use super::filter::{ERROR, LARGEST, SMALLEST};
use super::finish::RESIDUAL_ERROR;
use crate::ray::{LaneCandidates, LaneHits, RayLanes, cross_lanes, dot, dot_lanes, lanes};
use crate::simd::two_prod;

impl Sphere {
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

    /// The correctly rounded `t` of eight hits, where one step is enough for certainty: with these lanes as bits.
    // The operations of `filter`, `approximation`, `refined` and `residual`.
    #[inline(always)]
    pub(crate) fn lane_roundings<const FMA: bool, S: Simd>(
        simd: S,
        spheres: [&Self; 8],
        hits: &LaneHits<S>,
    ) -> (f64x8<S>, u64) {
        let center = [lanes(simd, spheres, |s| s.center.x), lanes(simd, spheres, |s| s.center.y)];
        let center = [center[0], center[1], lanes(simd, spheres, |s| s.center.z)];
        let radius = lanes(simd, spheres, |s| s.radius);
        let (o, d, inverse_a) = (&hits.origin, &hits.direction, hits.inverse_square);
        let w = [o[0] - center[0], o[1] - center[1], o[2] - center[2]];
        let x = cross_lanes(&w, d);
        let (w_square, radius_square) = (dot_lanes(&w, &w), radius * radius);
        let delta = hits.square.mul_sub(radius_square, dot_lanes(&x, &x));
        let squares = w_square + radius_square;
        let error = (hits.square * ERROR) * squares;
        let crosses = delta.simd_gt(error)
            & squares.simd_gt(f64x8::splat(simd, SMALLEST))
            & squares.simd_lt(f64x8::splat(simd, LARGEST));
        let b = dot_lanes(&w, d);
        let (root, inverse) = (delta.sqrt(), f64x8::splat(simd, 1.0) / delta);
        let inverse_root = inverse * root;
        let (near, far) = ((-b - root) * inverse_a, (root - b) * inverse_a);
        let root_error = ((error * 1.6) * inverse_a) * inverse * root;
        // The hit is the one root that its bounds allow.
        let is_near = (near - root_error).simd_le(hits.high) & (near + root_error).simd_ge(hits.low);
        let is_far = (far - root_error).simd_le(hits.high) & (far + root_error).simd_ge(hits.low);
        let t = is_near.select(near, far);
        let half_inverse = is_near.select(inverse_root * 0.5, inverse_root * -0.5);
        let slack = error * inverse_root * inverse_root;
        let known = crosses & (is_near ^ is_far) & slack.simd_le(f64x8::splat(simd, 0.125));

        // |w + t d|² - r², the squares as square + low.
        let (x, x_low) = square::<FMA, S>(o[0], center[0], t, d[0]);
        let (y, y_low) = square::<FMA, S>(o[1], center[1], t, d[1]);
        let (z, z_low) = square::<FMA, S>(o[2], center[2], t, d[2]);
        let (r, r_low) = two_prod::<FMA, S, _>(radius, radius);
        let ((xz, xz_error), (yr, yr_error)) = (two_sum(x, z), two_diff(y, r));
        let residual = ((xz + yr) + (xz_error + yr_error)) + ((x_low + z_low) + (y_low - r_low));

        let step = residual * half_inverse;
        let relative = slack * 2.5 * half_inverse.abs();
        let error = residual.abs() * relative + squares * RESIDUAL_ERROR * inverse_root;
        let (lower, upper) = rounded_ends(t, step, error);
        (upper, (known & lower.simd_eq(upper)).to_bitmask())
    }
}

/// `(o - c + t d)²` of one coordinate, as square + low.
#[inline(always)]
fn square<const FMA: bool, S: Simd>(o: f64x8<S>, c: f64x8<S>, t: f64x8<S>, d: f64x8<S>) -> (f64x8<S>, f64x8<S>) {
    let (w, w_low) = two_diff(o, c);
    let (step, step_low) = two_prod::<FMA, S, _>(t, d);
    let (high, error) = two_sum(w, step);
    let low = error + (w_low + step_low);
    let (square, square_low) = two_prod::<FMA, S, _>(high, high);
    (square, (high + high).mul_add(low, square_low))
}
