//! The filter for eight rays of one origin, and the last bits of eight hits, in vectors: the operations of `filter.rs` and
//! `finish.rs`. What a lane leaves open is for the kernels of one ray.

use fearless_simd::{Simd, f64x8, prelude::*};
use glam::DVec3;
use rt_math::exact::{rounded_ends, two_sum};

use super::filter::ERROR;
use super::finish::{REST_ERROR, SOLUTION_ERROR};
use super::{FARTHEST, Triangle};
use crate::ray::{LaneCandidates, LaneHits, RayLanes, cross, cross_lanes, dot, dot_lanes, lanes};
use crate::simd::two_prod;

impl Triangle {
    /// The same for eight rays, as far as the filter decides.
    // The operations of `filter` and `TriangleCrossing::bounds`.
    #[inline(always)]
    pub(crate) fn lane_candidates<S: Simd>(
        &self,
        simd: S,
        rays: &RayLanes<S>,
        (start, end): (f64, f64),
    ) -> LaneCandidates<S> {
        let [a, b, c] = self.vertices;
        let (e, f, s) = (b - a, c - a, rays.origin - a);
        let edge = self.edge;
        let size = edge + (s.x.abs() + s.y.abs() + s.z.abs());
        let spread = (ERROR * edge) * size;
        let error = rays.reach * spread;
        let proved = if size < FARTHEST { u64::MAX } else { 0 };
        let [x, y, z] = rays.cross(f);
        let along = |v: DVec3| x.mul_add(v.x, y.mul_add(v.y, z * v.z));
        let q = cross::<false>(s, e);
        let (sum, v, w) = (along(e), along(s), rays.dot(q));
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
        let t = (sign * dot::<false>(f, q)) * inverse;
        let error = (t.abs() * rays.reach + edge) * spread * inverse;
        let (low, high) = (t - error, t + error);
        let (start, end) = (f64x8::splat(simd, start), f64x8::splat(simd, end));
        let in_range = (low.simd_gt(start) & high.simd_lt(end)).to_bitmask();
        let beside = (low.simd_gt(end) | high.simd_lt(start)).to_bitmask();
        LaneCandidates { low, high, none: misses | (crosses & beside), some: crosses & in_range }
    }

    /// The correctly rounded `t` of eight hits, where one step is enough for certainty: with these lanes as bits.
    // The operations of `filter`, `Refined::new` and `Refined::t`.
    #[inline(always)]
    pub(crate) fn lane_roundings<const FMA: bool, S: Simd>(
        simd: S,
        triangles: [&Self; 8],
        hits: &LaneHits<S>,
    ) -> (f64x8<S>, u64) {
        let vertex = [vertices(simd, triangles, 0), vertices(simd, triangles, 1), vertices(simd, triangles, 2)];
        let [a, b, c] = &vertex;
        let edge = lanes(simd, triangles, |t| t.edge);
        let (o, d) = (&hits.origin, &hits.direction);
        let (e, f, s) = (minus(b, a), minus(c, a), minus(o, a));
        let size = edge + ((s[0].abs() + s[1].abs()) + s[2].abs());
        let error = (edge * ERROR) * size * hits.reach;
        let (p, q) = (cross_lanes(d, &f), cross_lanes(&s, &e));
        let sum = dot_lanes(&e, &p);
        let sign = f64x8::splat(simd, 1.0).copysign(sum);
        let (sum, v, w) = (sum.abs(), sign * dot_lanes(&s, &p), sign * dot_lanes(d, &q));
        let u = (sum - v) - w;
        let least = v.min(u.min(w));
        let crosses = sum.simd_gt(error) & least.simd_gt(error) & size.simd_lt(f64x8::splat(simd, FARTHEST));
        let inverse = f64x8::splat(simd, 1.0) / sum;
        let t = (sign * dot_lanes(&f, &q)) * inverse;
        let (beta, gamma) = (v * inverse, w * inverse);

        let (rest, beta_error) = two_sum(f64x8::splat(simd, 1.0), -beta);
        let (alpha, gamma_error) = two_sum(rest, -gamma);
        let missing = beta_error + gamma_error;
        let weights = [alpha, beta, gamma];
        let rest = [
            left_over::<FMA, S>([a[0], b[0], c[0]], weights, missing, (o[0], d[0], t)),
            left_over::<FMA, S>([a[1], b[1], c[1]], weights, missing, (o[1], d[1], t)),
            left_over::<FMA, S>([a[2], b[2], c[2]], weights, missing, (o[2], d[2], t)),
        ];
        let steepness = (hits.reach * edge) * edge * inverse;
        let length = (rest[0].abs() + rest[1].abs()) + rest[2].abs();
        let largest = a[0].abs().max(a[1].abs().max(a[2].abs()));
        let error = (largest + size) * REST_ERROR + (steepness * length) * SOLUTION_ERROR;
        let step = dot_lanes(&f, &cross_lanes(&rest, &e)) * (inverse * sign);
        let (lower, upper) = rounded_ends(t, step, (edge * edge) * inverse * error);
        (upper, (crosses & lower.simd_eq(upper)).to_bitmask())
    }
}

#[inline(always)]
fn vertices<S: Simd>(simd: S, triangles: [&Triangle; 8], i: usize) -> [f64x8<S>; 3] {
    let [mut x, mut y, mut z] = [[0.0; 8]; 3];
    for (lane, triangle) in triangles.iter().enumerate() {
        let vertex = triangle.vertices[i];
        (x[lane], y[lane], z[lane]) = (vertex.x, vertex.y, vertex.z);
    }
    [f64x8::from_slice(simd, &x), f64x8::from_slice(simd, &y), f64x8::from_slice(simd, &z)]
}

#[inline(always)]
fn minus<S: Simd>(v: &[f64x8<S>; 3], w: &[f64x8<S>; 3]) -> [f64x8<S>; 3] {
    [v[0] - w[0], v[1] - w[1], v[2] - w[2]]
}

/// A coordinate of `o + t d - α a - β b - γ c - missing a`, the large terms without error.
#[inline(always)]
fn left_over<const FMA: bool, S: Simd>(
    [a, b, c]: [f64x8<S>; 3],
    [alpha, beta, gamma]: [f64x8<S>; 3],
    missing: f64x8<S>,
    (o, d, t): (f64x8<S>, f64x8<S>, f64x8<S>),
) -> f64x8<S> {
    let (td, td_low) = two_prod::<FMA, S, _>(t, d);
    let (aa, aa_low) = two_prod::<FMA, S, _>(alpha, a);
    let (bb, bb_low) = two_prod::<FMA, S, _>(beta, b);
    let (cc, cc_low) = two_prod::<FMA, S, _>(gamma, c);
    let (point, e1) = two_sum(o, td);
    let (two, e2) = two_sum(bb, cc);
    let (three, e3) = two_sum(two, aa);
    let low = (td_low - aa_low) - (bb_low + cc_low);
    (point - three) + (((e1 - e2) - e3) + (low - missing * a))
}
