//! The filter and the last bits of eight rays at once, in vectors: the operations of `filter.rs` and `finish.rs`. What a
//! lane leaves open is for the kernels of one ray.

use fearless_simd::{Simd, f64x8, mask64x8, prelude::*};
use rt_math::exact::{rounded_ends, two_sum};

use super::filter::ERROR;
use super::finish::{REST_ERROR, SOLUTION_ERROR, left_over};
use super::{FARTHEST, Triangle};
use crate::lanes::{LaneCandidates, LaneKernels, PencilLanes, RayLanes, cross, dot, lanes, minus};
use crate::ray::{cross as cross_of_one, dot as dot_of_one};

/// What the filter finds of eight lines, each with a triangle.
struct LaneCrossings<S: Simd> {
    vertices: [[f64x8<S>; 3]; 3],
    e: [f64x8<S>; 3],
    f: [f64x8<S>; 3],
    edge: f64x8<S>,
    size: f64x8<S>,
    spread: f64x8<S>,
    misses: mask64x8<S>,
    crosses: mask64x8<S>,
    sign: f64x8<S>,
    /// One over the sum of the volumes, `t`, and the weights of the second vertex and the third.
    inverse: f64x8<S>,
    t: f64x8<S>,
    weights: [f64x8<S>; 2],
}

impl<S: Simd> LaneCrossings<S> {
    // The operations of `filter` and `solution`.
    #[inline(always)]
    fn new(simd: S, triangles: [&Triangle; 8], rays: &RayLanes<S>) -> Self {
        let vertices = [corners(simd, triangles, 0), corners(simd, triangles, 1), corners(simd, triangles, 2)];
        let [a, b, c] = &vertices;
        let edge = lanes(simd, triangles, |t| t.edge);
        let (e, f, s) = (minus(b, a), minus(c, a), minus(&rays.origin, a));
        let size = edge + ((s[0].abs() + s[1].abs()) + s[2].abs());
        let spread = (edge * ERROR) * size;
        let error = spread * rays.reach;
        let (p, q) = (cross(&rays.direction, &f), cross(&s, &e));
        let sum = dot(&e, &p);
        let sign = f64x8::splat(simd, 1.0).copysign(sum);
        let (sum, v, w) = (sum.abs(), sign * dot(&s, &p), sign * dot(&rays.direction, &q));
        let u = (sum - v) - w;
        let least = v.min(u.min(w));
        let decided = sum.simd_gt(error) & least.abs().simd_gt(error) & size.simd_lt(f64x8::splat(simd, FARTHEST));
        let zero = f64x8::splat(simd, 0.0);
        let inverse = f64x8::splat(simd, 1.0) / sum;
        Self {
            vertices,
            e,
            f,
            edge,
            size,
            spread,
            misses: decided & least.simd_lt(zero),
            crosses: decided & least.simd_gt(zero),
            sign,
            inverse,
            t: (sign * dot(&f, &q)) * inverse,
            weights: [v * inverse, w * inverse],
        }
    }
}

impl LaneKernels for Triangle {
    // The operations of `filter` and `TriangleCrossing::bounds`.
    #[inline(always)]
    fn pencil_candidates<S: Simd>(&self, simd: S, rays: &PencilLanes<S>, range: (f64, f64)) -> LaneCandidates<S> {
        let [a, b, c] = self.vertices;
        let (e, f, s) = (b - a, c - a, rays.origin - a);
        let edge = self.edge;
        let size = edge + (s.x.abs() + s.y.abs() + s.z.abs());
        let spread = (ERROR * edge) * size;
        let error = rays.reach * spread;
        let proved = if size < FARTHEST { u64::MAX } else { 0 };
        // `d . (f x e)` for `e . (d x f)`: the same monomials with as many roundings, and a vector for all rays.
        let q = cross_of_one::<false>(s, e);
        let sum = rays.dot(cross_of_one::<false>(f, e));
        let (v, w) = (rays.dot(cross_of_one::<false>(f, s)), rays.dot(q));
        let sign = f64x8::splat(simd, 1.0).copysign(sum);
        let (sum, v, w) = (sum.abs(), sign * v, sign * w);
        let u = (sum - v) - w;
        let least = v.min(u.min(w));
        let decided = (sum.simd_gt(error) & least.abs().simd_gt(error)).to_bitmask() & proved;
        let outside = least.simd_lt(f64x8::splat(simd, 0.0)).to_bitmask();
        let (misses, crosses) = (decided & outside, decided & !outside);
        if crosses == 0 {
            return LaneCandidates { low: sum, high: sum, none: misses, some: 0 };
        }
        let inverse = f64x8::splat(simd, 1.0) / sum;
        let t = (sign * dot_of_one::<false>(f, q)) * inverse;
        let error = (t.abs() * rays.reach + edge) * spread * inverse;
        LaneCandidates::new(simd, (misses, crosses), (t - error, t + error), range)
    }

    // The operations of `TriangleCrossing::bounds`.
    #[inline(always)]
    fn lane_candidates<S: Simd>(
        simd: S,
        triangles: [&Self; 8],
        rays: &RayLanes<S>,
        range: (f64, f64),
    ) -> LaneCandidates<S> {
        let LaneCrossings { misses, crosses, t, edge, spread, inverse, .. } = LaneCrossings::new(simd, triangles, rays);
        let error = (t.abs() * rays.reach + edge) * spread * inverse;
        let lines = (misses.to_bitmask(), crosses.to_bitmask());
        LaneCandidates::new(simd, lines, (t - error, t + error), range)
    }

    // The operations of `Refined::new` and `Refined::t`.
    #[inline(always)]
    fn lane_roundings<const FMA: bool, S: Simd>(
        simd: S,
        triangles: [&Self; 8],
        rays: &RayLanes<S>,
        _: (f64x8<S>, f64x8<S>),
    ) -> (f64x8<S>, u64) {
        let crossings = LaneCrossings::new(simd, triangles, rays);
        let LaneCrossings { vertices: [a, b, c], e, f, edge, size, sign, inverse, t, weights, .. } = crossings;
        let [beta, gamma] = weights;
        let (rest, beta_error) = two_sum(f64x8::splat(simd, 1.0), -beta);
        let (alpha, gamma_error) = two_sum(rest, -gamma);
        let missing = beta_error + gamma_error;
        let weights = [alpha, beta, gamma];
        let (o, d) = (&rays.origin, &rays.direction);
        let rest = [
            left_over::<FMA, S, _>([a[0], b[0], c[0]], weights, missing, (o[0], d[0], t)),
            left_over::<FMA, S, _>([a[1], b[1], c[1]], weights, missing, (o[1], d[1], t)),
            left_over::<FMA, S, _>([a[2], b[2], c[2]], weights, missing, (o[2], d[2], t)),
        ];
        let steepness = (rays.reach * edge) * edge * inverse;
        let length = (rest[0].abs() + rest[1].abs()) + rest[2].abs();
        let largest = a[0].abs().max(a[1].abs().max(a[2].abs()));
        let error = (largest + size) * REST_ERROR + (steepness * length) * SOLUTION_ERROR;
        let step = dot(&f, &cross(&rest, &e)) * (inverse * sign);
        let (lower, upper) = rounded_ends(t, step, (edge * edge) * inverse * error);
        (upper, (crossings.crosses & lower.simd_eq(upper)).to_bitmask())
    }
}

#[inline(always)]
fn corners<S: Simd>(simd: S, triangles: [&Triangle; 8], i: usize) -> [f64x8<S>; 3] {
    let [mut x, mut y, mut z] = [[0.0; 8]; 3];
    for (lane, triangle) in triangles.iter().enumerate() {
        let vertex = triangle.vertices[i];
        (x[lane], y[lane], z[lane]) = (vertex.x, vertex.y, vertex.z);
    }
    [f64x8::from_slice(simd, &x), f64x8::from_slice(simd, &y), f64x8::from_slice(simd, &z)]
}
