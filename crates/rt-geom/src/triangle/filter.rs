//! The filter of lines and triangles, and what follows it: last bits where it is certain, exact arithmetic where it is
//! not.

use std::ops::Range;

use fearless_simd::Simd;
use glam::DVec3;
use rt_math::exact::U;

use super::finish::{Refined, TriangleCrossing};
use super::{FARTHEST, Triangle, exact};
use crate::Ray;
use crate::ray::{Candidate, Candidates, FilterVerdict, PreparedRay, cross, dot, holds, larger, smaller};
use crate::simd::dispatch;

/// The error of each volume that the filter computes, relative to `D E (E + S)`, and of the height, relative to
/// `E² (E + S)`, as `docs/numerics.md`, section 6, has them.
pub(super) const ERROR: f64 = 18.0 * U;

/// The filter: decides in plain doubles whether the line meets the interior or passes beside the triangle, where that
/// is certain.
///
/// Source: T. Möller, B. Trumbore, "Fast, minimum storage ray/triangle intersection", 1997; the bounds are ours.
#[inline(always)]
pub(super) fn filter<const FMA: bool>(triangle: &Triangle, ray: &Ray) -> FilterVerdict<TriangleCrossing> {
    // Modelled in docs/proofs/Triangle.v: tp1, tsum, tv, tq1, tw, theight, terror.
    let [a, b, c] = triangle.vertices;
    let (e, f, s) = (b - a, c - a, ray.origin() - a);
    let edge = triangle.edge;
    let size = edge + (s.x.abs() + s.y.abs() + s.z.abs());
    let spread = (ERROR * edge) * size;
    // NaN if the direction is out of the range where this is proved.
    let error = spread * ray.reach();
    if size >= FARTHEST {
        return FilterVerdict::Unsure;
    }
    let p = cross::<FMA>(ray.direction(), f);
    let sum = dot::<FMA>(e, p);
    // From here on as if the sum were positive.
    let sign = 1f64.copysign(sum);
    let (sum, v) = (sum.abs(), sign * dot::<FMA>(s, p));
    let q = cross::<FMA>(s, e);
    let w = sign * dot::<FMA>(ray.direction(), q);
    let u = (sum - v) - w;
    // All three at once: one branch to predict.
    let least = smaller(v, smaller(u, w));
    // False for NaN.
    if smaller(sum, least.abs()) > error {
        if least < 0.0 {
            return FilterVerdict::Misses;
        }
        let height = sign * dot::<FMA>(f, q);
        return FilterVerdict::Crosses(TriangleCrossing { e, f, p, sign, sum, v, w, height, edge, size, spread });
    }
    if passes_beside(triangle, ray, error) { FilterVerdict::Misses } else { FilterVerdict::Unsure }
}

/// Whether a line of which the filter is not sure passes surely beside the triangle: two volumes have opposite signs,
/// be it parallel to the plane or not.
#[cold]
#[inline(never)]
fn passes_beside(triangle: &Triangle, ray: &Ray, error: f64) -> bool {
    let [a, b, c] = triangle.vertices;
    let (e, f, s) = (b - a, c - a, ray.origin() - a);
    let p = ray.direction().cross(f);
    let (sum, v, w) = (e.dot(p), s.dot(p), ray.direction().dot(s.cross(e)));
    let u = (sum - v) - w;
    smaller(u, smaller(v, w)) < -error && larger(u, larger(v, w)) > error
}

/// Whether the ray is surely not parallel to the triangle, which surely has a plane.
pub(super) fn surely_leans(triangle: &Triangle, ray: &Ray) -> bool {
    let [a, b, c] = triangle.vertices;
    let error = (ERROR * triangle.edge) * triangle.edge * ray.reach();
    triangle.edge < FARTHEST && ray.direction().cross(c - a).dot(b - a).abs() > error
}

dispatch! {
    /// Returns the correctly rounded `t` of the hit, if it is between the ends of the range.
    pub(super) fn closest(triangle: &Triangle, ray: &Ray, start: f64, end: f64) -> Option<f64> = closest_kernel;
}

#[inline(always)]
pub(super) fn closest_kernel<const FMA: bool, S: Simd>(
    simd: S,
    triangle: &Triangle,
    ray: &Ray,
    start: f64,
    end: f64,
) -> Option<f64> {
    let within = start..end;
    match filter::<FMA>(triangle, ray) {
        FilterVerdict::Misses => None,
        FilterVerdict::Crosses(crossing) if crossing.is_before(start) => None,
        FilterVerdict::Crosses(crossing) => {
            let refined = Refined::new::<FMA, S>(simd, &crossing, triangle, ray, crossing.solution());
            let t = refined.t::<FMA>().unwrap_or_else(|| t_again(triangle, ray));
            holds(&within, t).then_some(t)
        }
        FilterVerdict::Unsure => exact::closest(triangle, ray, within),
    }
}

/// The correctly rounded `t` that one step has not decided.
#[cold]
#[inline(never)]
fn t_again(triangle: &Triangle, ray: &Ray) -> f64 {
    again(triangle, ray).0.unwrap_or_else(|| exact::crossing_t(triangle, ray))
}

dispatch! {
    /// Returns the correctly rounded weights where the whole line meets the triangle.
    pub(super) fn weights(triangle: &Triangle, ray: &Ray) -> Option<[f64; 3]> = weights_kernel;
}

#[inline(always)]
pub(super) fn weights_kernel<const FMA: bool, S: Simd>(simd: S, triangle: &Triangle, ray: &Ray) -> Option<[f64; 3]> {
    let weights = match filter::<FMA>(triangle, ray) {
        FilterVerdict::Misses => return None,
        FilterVerdict::Crosses(crossing) => {
            let refined = Refined::new::<FMA, S>(simd, &crossing, triangle, ray, crossing.solution());
            refined.weights::<FMA>().or_else(|| again(triangle, ray).1)
        }
        FilterVerdict::Unsure => None,
    };
    weights.or_else(|| exact::exact_weights(triangle, ray))
}

dispatch! {
    /// Returns both, if `t` is between the ends of the range.
    pub(super) fn closest_with_weights(
        triangle: &Triangle,
        ray: &Ray,
        start: f64,
        end: f64,
    ) -> Option<(f64, [f64; 3])> = both_kernel;
}

#[inline(always)]
pub(super) fn both_kernel<const FMA: bool, S: Simd>(
    simd: S,
    triangle: &Triangle,
    ray: &Ray,
    start: f64,
    end: f64,
) -> Option<(f64, [f64; 3])> {
    let within = start..end;
    let (t, weights) = match filter::<FMA>(triangle, ray) {
        FilterVerdict::Misses => return None,
        FilterVerdict::Crosses(crossing) if crossing.is_before(start) => return None,
        FilterVerdict::Crosses(crossing) => {
            let refined = Refined::new::<FMA, S>(simd, &crossing, triangle, ray, crossing.solution());
            match (refined.t::<FMA>(), refined.weights::<FMA>()) {
                (Some(t), Some(weights)) => (Some(t), Some(weights)),
                _ => again(triangle, ray),
            }
        }
        FilterVerdict::Unsure => (None, None),
    };
    match (t, weights) {
        (Some(t), _) if !holds(&within, t) => None,
        (Some(t), Some(weights)) => Some((t, weights)),
        (Some(t), None) => Some((t, exact::exact_weights(triangle, ray)?)),
        (None, _) => exact::closest_with_weights(triangle, ray, within),
    }
}

dispatch! {
    /// Two steps from the start, for a ray that is nearly parallel to the plane, if the second is likely to decide.
    #[cold]
    pub(super) fn again(triangle: &Triangle, ray: &Ray) -> (Option<f64>, Option<[f64; 3]>) = again_kernel;
}

#[inline(always)]
fn again_kernel<const FMA: bool, S: Simd>(simd: S, triangle: &Triangle, ray: &Ray) -> (Option<f64>, Option<[f64; 3]>) {
    let FilterVerdict::Crosses(crossing) = filter::<FMA>(triangle, ray) else { return (None, None) };
    if !crossing.is_in_reach_of_two_steps(ray) {
        return (None, None);
    }
    let first = Refined::new::<FMA, S>(simd, &crossing, triangle, ray, crossing.solution());
    let refined = Refined::new::<FMA, S>(simd, &crossing, triangle, ray, first.corrected::<FMA>());
    // False for NaN.
    if refined.weights.iter().all(|&weight| weight >= -0.25) {
        (refined.t::<FMA>(), refined.weights::<FMA>())
    } else {
        (None, None)
    }
}

impl Candidates for Triangle {
    #[inline(always)]
    fn meets<const FMA: bool>(&self, prepared: &PreparedRay) -> bool {
        if prepared.start.to_bits() != 0 || prepared.end != f64::INFINITY {
            return self.candidate::<FMA>(prepared, f64::INFINITY).is_some();
        }
        // For the whole ray the sign of `t` is enough, and needs no division.
        match filter::<FMA>(self, prepared.ray) {
            FilterVerdict::Misses => return false,
            FilterVerdict::Crosses(crossing) => {
                let (height, error) = crossing.height();
                if height.abs() > error {
                    return height > 0.0;
                }
                return self.crossed_candidate(prepared.ray, prepared.within(), f64::INFINITY).is_some();
            }
            FilterVerdict::Unsure => {}
        }
        self.exact_candidate(prepared.ray, prepared.within(), f64::INFINITY).is_some()
    }

    #[inline(always)]
    fn candidate<const FMA: bool>(&self, prepared: &PreparedRay, limit: f64) -> Candidate {
        match filter::<FMA>(self, prepared.ray) {
            FilterVerdict::Misses => Candidate::NONE,
            FilterVerdict::Crosses(crossing) => prepared.admit(crossing.bounds(prepared.ray), limit, || {
                self.crossed_candidate(prepared.ray, prepared.within(), limit)
            }),
            FilterVerdict::Unsure => self.exact_candidate(prepared.ray, prepared.within(), limit),
        }
    }
}

impl Triangle {
    #[cold]
    #[inline(never)]
    fn exact_candidate(&self, ray: &Ray, within: Range<f64>, limit: f64) -> Candidate {
        Candidate::exact(exact::closest(self, ray, within), limit)
    }

    /// For a line that surely crosses the triangle: only whether the range holds its `t` is the question, as for a ray that
    /// begins on the triangle.
    #[cold]
    #[inline(never)]
    fn crossed_candidate(&self, ray: &Ray, within: Range<f64>, limit: f64) -> Candidate {
        let [a, b, c] = self.vertices;
        let same = |vertex: DVec3| vertex.cmpeq(ray.origin());
        // In a plane across an axis, with the origin in it, as floors and walls often are.
        let t = if (same(a) & same(b) & same(c)).any() { 0.0 } else { exact::crossing_t(self, ray) };
        Candidate::exact(holds(&within, t).then_some(t), limit)
    }
}

#[cfg(test)]
mod tests {
    use oracle::Random;

    use super::*;

    /// Rays that begin on a triangle or next to it, in planes across an axis and in others, with ranges that end there:
    /// what is offered is what the exact stage finds.
    #[test]
    fn a_ray_that_begins_on_a_triangle_hits_it_where_exact_arithmetic_says() {
        let random = &mut Random::new(6);
        let (mut at_zero, mut hits, mut misses) = (0, 0, 0);
        for round in 0..20_000 {
            let mut corners = [random.point(), random.point(), random.point()];
            if round % 2 == 0 {
                let level = random.point().x;
                corners.iter_mut().for_each(|corner| corner[round % 3] = level);
            }
            let [a, b, c] = corners;
            let Ok(triangle) = Triangle::new(a, b, c) else { continue };
            let origin = 0.25 * a + 0.5 * b + 0.25 * c;
            let Ok(ray) = Ray::new(origin, random.point()) else { continue };
            let tiny = f64::from_bits(1);
            for within in [0.0..f64::INFINITY, -0.0..0.0, -0.0..tiny, tiny..1.0, -1.0..0.0, -1.0..1.0, 1.0..0.0] {
                let prepared = PreparedRay::new(&ray, within.clone());
                let expected = exact::closest(&triangle, &ray, within.clone());
                for (candidate, meets) in [
                    (triangle.candidate::<true>(&prepared, f64::INFINITY), triangle.meets::<true>(&prepared)),
                    (triangle.candidate::<false>(&prepared, f64::INFINITY), triangle.meets::<false>(&prepared)),
                ] {
                    let Candidate { low, high } = candidate;
                    let holds = expected.map_or(low.is_nan(), |t| low <= t && t <= high);
                    assert!(holds, "{triangle:?} {ray:?} {within:?} {candidate:?} {expected:?}");
                    assert!(low != high || Some(low.to_bits()) == expected.map(f64::to_bits), "{low:?} {expected:?}");
                    assert_eq!(meets, expected.is_some(), "{triangle:?} {ray:?} {within:?}");
                }
                match expected {
                    Some(0.0) => at_zero += 1,
                    Some(_) => hits += 1,
                    None => misses += 1,
                }
            }
        }
        assert!(at_zero > 10_000 && hits > 5_000 && misses > 10_000, "{at_zero} {hits} {misses}");
    }
}
