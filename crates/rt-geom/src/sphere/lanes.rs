//! The filter and the last bits of eight rays at once, in vectors: the operations of `filter.rs` and `finish.rs`. What a
//! lane leaves open is for the kernels of one ray.

use fearless_simd::{Simd, f64x8, mask64x8, prelude::*};
use rt_math::exact::{rounded_ends, two_diff, two_sum};

use super::Sphere;
use super::filter::{ERROR, LARGEST, SMALLEST};
use super::finish::{RESIDUAL_ERROR, square};
use crate::lanes::{LaneCandidates, LaneKernels, PencilLanes, RayLanes, cross, dot, lanes, minus};
use crate::ray::dot as dot_of_one;
use crate::simd::two_prod;

/// What the filter finds of eight lines, each with a sphere.
struct LaneCrossings<S: Simd> {
    center: [f64x8<S>; 3],
    radius: f64x8<S>,
    misses: mask64x8<S>,
    crosses: mask64x8<S>,
    squares: f64x8<S>,
    error: f64x8<S>,
    near: f64x8<S>,
    far: f64x8<S>,
    root_error: f64x8<S>,
    inverse_root: f64x8<S>,
}

impl<S: Simd> LaneCrossings<S> {
    // The operations of `filter` and `approximation`, modelled in docs/proofs/Sphere.v: tlane_squares and others.
    #[inline(always)]
    fn new(simd: S, spheres: [&Sphere; 8], rays: &RayLanes<S>) -> Self {
        let center = [
            lanes(simd, spheres, |s| s.center.x),
            lanes(simd, spheres, |s| s.center.y),
            lanes(simd, spheres, |s| s.center.z),
        ];
        let radius = lanes(simd, spheres, |s| s.radius);
        let w = minus(&rays.origin, &center);
        let x = cross(&w, &rays.direction);
        let (w_square, radius_square) = (dot(&w, &w), radius * radius);
        let delta = rays.square.mul_sub(radius_square, dot(&x, &x));
        let squares = w_square + radius_square;
        let error = (rays.square * ERROR) * squares;
        let proved = squares.simd_gt(f64x8::splat(simd, SMALLEST)) & squares.simd_lt(f64x8::splat(simd, LARGEST));
        let b = dot(&w, &rays.direction);
        let (root, inverse) = (delta.sqrt(), f64x8::splat(simd, 1.0) / delta);
        Self {
            center,
            radius,
            misses: proved & delta.simd_lt(-error),
            crosses: proved & delta.simd_gt(error),
            squares,
            error,
            near: (-b - root) * rays.inverse_square,
            far: (root - b) * rays.inverse_square,
            root_error: ((error * 1.6) * rays.inverse_square) * inverse * root,
            inverse_root: inverse * root,
        }
    }
}

impl LaneKernels for Sphere {
    // Near roots alone. The operations of `filter` and `approximation`, in docs/proofs/Sphere.v: tpencil_x, tpencil_b.
    #[inline(always)]
    fn pencil_candidates<S: Simd>(&self, simd: S, rays: &PencilLanes<S>, range: (f64, f64)) -> LaneCandidates<S> {
        let w = rays.origin - self.center;
        let [x, y, z] = rays.cross(w);
        let (w_square, radius_square) = (dot_of_one::<false>(w, w), self.radius * self.radius);
        let delta = rays.square.mul_sub(radius_square, x.mul_add(x, y.mul_add(y, z * z)));
        let squares = w_square + radius_square;
        let error = (rays.square * ERROR) * squares;
        let proved = if squares > SMALLEST && squares < LARGEST { u64::MAX } else { 0 };
        let misses = delta.simd_lt(-error).to_bitmask() & proved;
        let crosses = delta.simd_gt(error).to_bitmask() & proved;
        if crosses == 0 {
            return LaneCandidates { low: delta, high: delta, none: misses, some: 0 };
        }
        let (root, inverse) = (delta.sqrt(), f64x8::splat(simd, 1.0) / delta);
        let near = (-rays.dot(w) - root) * rays.inverse_square;
        let error = ((error * 1.6) * rays.inverse_square) * inverse * root;
        let mut found = LaneCandidates::new(simd, (misses, crosses), (near - error, near + error), range);
        // Before the range comes the near root alone.
        found.none &= misses | found.low.simd_gt(f64x8::splat(simd, range.1)).to_bitmask();
        found
    }

    #[inline(always)]
    fn lane_candidates<S: Simd>(
        simd: S,
        spheres: [&Self; 8],
        rays: &RayLanes<S>,
        range: (f64, f64),
    ) -> LaneCandidates<S> {
        let LaneCrossings { misses, crosses, near, far, root_error, .. } = LaneCrossings::new(simd, spheres, rays);
        let t = (near + root_error).simd_lt(f64x8::splat(simd, range.0)).select(far, near);
        let lines = (misses.to_bitmask(), crosses.to_bitmask());
        LaneCandidates::new(simd, lines, (t - root_error, t + root_error), range)
    }

    // The operations of `refined` and `residual`.
    #[inline(always)]
    fn lane_roundings<const FMA: bool, S: Simd>(
        simd: S,
        spheres: [&Self; 8],
        rays: &RayLanes<S>,
        (low, high): (f64x8<S>, f64x8<S>),
    ) -> (f64x8<S>, u64) {
        let crossings = LaneCrossings::new(simd, spheres, rays);
        let LaneCrossings { center, radius, near, far, root_error, inverse_root, .. } = crossings;
        // The hit is the one root that its bounds allow.
        let is_near = (near - root_error).simd_le(high) & (near + root_error).simd_ge(low);
        let is_far = (far - root_error).simd_le(high) & (far + root_error).simd_ge(low);
        let t = is_near.select(near, far);
        let half_inverse = is_near.select(inverse_root * 0.5, inverse_root * -0.5);
        let slack = crossings.error * inverse_root * inverse_root;
        let known = crossings.crosses & (is_near ^ is_far) & slack.simd_le(f64x8::splat(simd, 0.125));

        // |w + t d|² - r², the squares as square + low.
        let (o, d) = (&rays.origin, &rays.direction);
        let (x, x_low) = square::<FMA, S, _>((o[0], d[0]), center[0], t);
        let (y, y_low) = square::<FMA, S, _>((o[1], d[1]), center[1], t);
        let (z, z_low) = square::<FMA, S, _>((o[2], d[2]), center[2], t);
        let (r, r_low) = two_prod::<FMA, S, _>(radius, radius);
        let ((xz, xz_error), (yr, yr_error)) = (two_sum(x, z), two_diff(y, r));
        let residual = ((xz + yr) + (xz_error + yr_error)) + ((x_low + z_low) + (y_low - r_low));

        let step = residual * half_inverse;
        let relative = slack * 2.5 * half_inverse.abs();
        let error = residual.abs() * relative + crossings.squares * RESIDUAL_ERROR * inverse_root;
        let (lower, upper) = rounded_ends(t, step, error);
        (upper, (known & lower.simd_eq(upper)).to_bitmask())
    }
}
