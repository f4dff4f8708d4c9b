//! The correctly rounded `t` and weights of a hit that the filter has found: one step of iterative refinement.
//!
//! A hit solves the linear system `o + t d = α a + β b + γ c`, `α + β + γ = 1`. The filter's solution in doubles is put
//! back in; what is left over, computed to twice the precision, is a vector `r` some units in the last place long. It
//! is solved for by the same formulas, in plain doubles, since of a correction a few bits are enough:
//!
//! ```text
//!     β' = r . (d x f) / sum      γ' = d . (r x e) / sum      t' = f . (r x e) / sum
//! ```
//!
//! A rounding test then tells whether solution and correction decide the last bit. `docs/numerics.md`, section 6,
//! proves the bounds.

use std::ops::Mul;

use fearless_simd::{Simd, f64x4, prelude::*};
use glam::DVec3;
use rt_math::exact::{U, round_if_certain, two_sum};

use super::Triangle;
use crate::Ray;
use crate::lanes::four;
use crate::ray::{cross, dot, max_abs};
use crate::simd::two_prod;

/// The error of a component of `r`, relative to the size of the coordinates, and that of solving for it, relative to
/// `r`.
pub(super) const REST_ERROR: f64 = 136.0 * U * U;
pub(super) const SOLUTION_ERROR: f64 = 21.0 * U;

/// Möller and Trumbore's quantities for a line that surely meets the interior, all but `e`, `f`, `p` with the sign that
/// makes the sum of the volumes positive.
pub(super) struct TriangleCrossing {
    /// The edges from the first vertex to the others.
    pub(super) e: DVec3,
    pub(super) f: DVec3,
    /// `d x f`
    pub(super) p: DVec3,
    /// What the others have been multiplied with: 1 or -1.
    pub(super) sign: f64,
    /// The sum of the three volumes, and two of them: the weights of the vertices times the sum.
    pub(super) sum: f64,
    pub(super) v: f64,
    pub(super) w: f64,
    /// `t` times the sum.
    pub(super) height: f64,
    /// `E`: the sum over the axes of the largest component of the edges.
    pub(super) edge: f64,
    /// `E + S`, with `S` the same for the origin relative to the first vertex.
    pub(super) size: f64,
    /// What the errors of volumes and height are proportional to.
    pub(super) spread: f64,
}

impl TriangleCrossing {
    /// The height, which has the sign of `t`, and a bound of its error.
    #[inline(always)]
    pub(super) fn height(&self) -> (f64, f64) {
        (self.height, self.spread * self.edge)
    }

    /// Bounds of the exact and of the correctly rounded `t`.
    #[inline(always)]
    pub(super) fn bounds(&self, ray: &Ray) -> (f64, f64) {
        let inverse = 1.0 / self.sum;
        let t = self.height * inverse;
        let error = self.spread * (self.edge + t.abs() * ray.reach()) * inverse;
        (t - error, t + error)
    }

    /// `t`, `β` and `γ` in doubles.
    #[inline(always)]
    pub(super) fn solution(&self) -> [f64; 3] {
        let inverse = 1.0 / self.sum;
        [self.height * inverse, self.v * inverse, self.w * inverse]
    }

    /// Whether two steps of refinement are likely to decide `t`: no promise, the stages after it decide as well.
    #[inline(always)]
    pub(super) fn is_in_reach_of_two_steps(&self, ray: &Ray) -> bool {
        let inverse = 1.0 / self.sum;
        let steepness = (ray.reach() * self.edge) * self.edge * inverse;
        // Of the solution and of each step the steepness, times some roundings, is wrong.
        let rest = SOLUTION_ERROR * (U * steepness) * (U * steepness);
        let way = ray.reach() * (self.height * inverse).abs();
        steepness * (REST_ERROR * self.size + steepness * rest * way) < U * way
    }

    /// Whether the hit surely comes before a range that starts at the origin or later.
    #[inline(always)]
    pub(super) fn is_before(&self, start: f64) -> bool {
        let (height, error) = self.height();
        height < -error && start >= 0.0
    }
}

/// The solution in doubles and what is left over.
pub(super) struct Refined<'a> {
    crossing: &'a TriangleCrossing,
    ray: &'a Ray,
    /// One over the sum of the volumes, with the sum's own sign.
    inverse: f64,
    t: f64,
    /// `α`, `β`, `γ`, and `1 - α - β - γ`.
    pub(super) weights: [f64; 3],
    missing: f64,
    /// `r` and `r x e`
    rest: DVec3,
    q: DVec3,
    /// A bound for the error of `r` and of solving for it: a length.
    error: f64,
}

impl<'a> Refined<'a> {
    #[inline(always)]
    pub(super) fn new<const FMA: bool, S: Simd>(
        simd: S,
        crossing: &'a TriangleCrossing,
        triangle: &Triangle,
        ray: &'a Ray,
        [t, beta, gamma]: [f64; 3],
    ) -> Self {
        let TriangleCrossing { e, sign, sum, edge, size, .. } = *crossing;
        let [a, b, c] = triangle.vertices;
        let (rest, beta_error) = two_sum(1.0, -beta);
        let (alpha, gamma_error) = two_sum(rest, -gamma);
        let missing = beta_error + gamma_error;

        // r = o + t d - α a - β b - γ c - missing a: the three coordinates in lanes.
        let splat = |x| f64x4::splat(simd, x);
        let vertices = [four(simd, a), four(simd, b), four(simd, c)];
        let line = (four(simd, ray.origin()), four(simd, ray.direction()), splat(t));
        let weights = [splat(alpha), splat(beta), splat(gamma)];
        let rest = left_over::<FMA, S, _>(vertices, weights, splat(missing), line);
        let rest = DVec3::new(rest[0], rest[1], rest[2]);
        // How much larger than their product the terms of the sum of the volumes may be.
        let positive = 1.0 / sum;
        let steepness = (ray.reach() * edge) * edge * positive;
        let length = rest.x.abs() + rest.y.abs() + rest.z.abs();
        let error = REST_ERROR * (max_abs(a) + size) + SOLUTION_ERROR * (steepness * length);
        let inverse = positive * sign;
        Self {
            crossing,
            ray,
            inverse,
            t,
            weights: [alpha, beta, gamma],
            missing,
            rest,
            q: cross::<FMA>(rest, e),
            error,
        }
    }

    /// `t`, `β` and `γ` with their corrections, in doubles.
    #[inline(always)]
    pub(super) fn corrected<const FMA: bool>(&self) -> [f64; 3] {
        let [t, beta, gamma] = self.steps::<FMA>();
        [self.t + t, self.weights[1] + beta, self.weights[2] + gamma]
    }

    /// The corrections of `t`, `β` and `γ`.
    #[inline(always)]
    fn steps<const FMA: bool>(&self) -> [f64; 3] {
        let TriangleCrossing { f, p, .. } = *self.crossing;
        let d = self.ray.direction();
        [dot::<FMA>(f, self.q), dot::<FMA>(self.rest, p), dot::<FMA>(d, self.q)].map(|x| x * self.inverse)
    }

    /// The correction of `t`, with a bound of the error that is left.
    #[inline(always)]
    fn t_step<const FMA: bool>(&self) -> (f64, f64) {
        let edge = self.crossing.edge;
        (self.steps::<FMA>()[0], (edge * edge) * self.inverse.abs() * self.error)
    }

    /// The corrections of the weights, each with a bound of the error that is left.
    #[inline(always)]
    fn weight_steps<const FMA: bool>(&self) -> [(f64, f64); 3] {
        let [_, beta, gamma] = self.steps::<FMA>();
        let alpha = self.missing - (beta + gamma);
        let error = 2.0 * (self.crossing.edge * self.ray.reach()) * self.inverse.abs() * self.error;
        [(alpha, 2.5 * error), (beta, error), (gamma, error)]
    }

    /// The correctly rounded `t`, if that is certain.
    #[inline(always)]
    pub(super) fn t<const FMA: bool>(&self) -> Option<f64> {
        let (step, error) = self.t_step::<FMA>();
        round_if_certain(self.t, step, error)
    }

    /// The correctly rounded weights, if all are certain.
    #[inline(always)]
    pub(super) fn weights<const FMA: bool>(&self) -> Option<[f64; 3]> {
        let [alpha, beta, gamma] = self.weight_steps::<FMA>();
        Some([
            round_if_certain(self.weights[0], alpha.0, alpha.1)?,
            round_if_certain(self.weights[1], beta.0, beta.1)?,
            round_if_certain(self.weights[2], gamma.0, gamma.1)?,
        ])
    }
}

/// Coordinates of `o + t d - α a - β b - γ c - missing a`, the large terms without error.
#[inline(always)]
pub(super) fn left_over<const FMA: bool, S: Simd, V>(
    [a, b, c]: [V; 3],
    [alpha, beta, gamma]: [V; 3],
    missing: V,
    (o, d, t): (V, V, V),
) -> V
where
    V: SimdFloat<S, Element = f64> + Mul<f64, Output = V>,
{
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

#[cfg(test)]
mod tests {
    use std::cmp::Ordering;

    use fearless_simd::Fallback;
    use oracle::{Big, Random, cross, dot, exact, sign, sub, vector};

    use super::super::exact as integers;
    use super::super::filter::{again, both_kernel, closest_kernel, filter, weights_kernel};
    use super::*;
    use crate::ray::{Candidates, FilterVerdict, PreparedRay};

    #[test]
    fn fused_and_plain_arithmetic_give_the_same_values() {
        let (rng, simd) = (&mut Random::new(3), Fallback::new());
        let mut hits = 0;
        for _ in 0..4000 {
            let [a, b, c] = [rng.point(), rng.point(), rng.point()];
            let target = a + rng.uniform().abs() * (b - a) + rng.uniform().abs() * (c - a);
            let origin = 5.0 * rng.point();
            let (triangle, ray) = (Triangle::new(a, b, c).unwrap(), Ray::new(origin, target - origin).unwrap());
            let end = f64::INFINITY;
            let t = closest_kernel::<false, _>(simd, &triangle, &ray, 0.0, end);
            assert_eq!(t, closest_kernel::<true, _>(simd, &triangle, &ray, 0.0, end));
            let weights = weights_kernel::<false, _>(simd, &triangle, &ray);
            assert_eq!(weights, weights_kernel::<true, _>(simd, &triangle, &ray));
            let both = both_kernel::<false, _>(simd, &triangle, &ray, 0.0, end);
            assert_eq!(both, both_kernel::<true, _>(simd, &triangle, &ray, 0.0, end));
            assert_eq!(both, t.zip(weights));
            hits += usize::from(t.is_some());
        }
        assert!(hits > 1000, "{hits}");
    }

    #[test]
    fn the_bounds_of_a_candidate_hold_its_t() {
        let rng = &mut Random::new(4);
        let mut hits = 0;
        for i in 0..4000 {
            let size = 2f64.powi(-(i % 20));
            let a = rng.point();
            let (b, c) = (a + size * rng.point(), a + size * rng.point());
            let target = a + 0.5 * rng.uniform().abs() * (b - a) + 0.5 * rng.uniform().abs() * (c - a);
            let origin = 5.0 * rng.point();
            let ray = Ray::new(origin, target - origin).unwrap();
            let triangle = Triangle::new(a, b, c).unwrap();
            let whole = PreparedRay::new(&ray, f64::NEG_INFINITY..f64::INFINITY);
            let bounds = triangle.candidate::<true>(&whole, f64::INFINITY);
            if !bounds.is_some() {
                continue;
            }
            let t = integers::integer_t(&triangle, &ray);
            assert!(bounds.low <= t && t <= bounds.high, "{triangle:?} {ray:?} {bounds:?}");
            hits += usize::from(bounds.low < bounds.high);
        }
        assert!(hits > 1000, "{hits}");
    }

    /// The ray is within 2^-12 to 2^-24 of parallel to the plane: one step is not enough, two are.
    #[test]
    fn a_second_step_decides_nearly_parallel_rays() {
        let rng = &mut Random::new(5);
        let (mut first, mut second, mut hits) = (0, 0, 0);
        for i in 0..2000 {
            let [a, b, c] = [rng.point(), rng.point(), rng.point()];
            let triangle = Triangle::new(a, b, c).unwrap();
            let along = rng.uniform() * (b - a) + rng.uniform() * (c - a);
            let target = a + 0.4 * rng.uniform().abs() * (b - a) + 0.4 * rng.uniform().abs() * (c - a);
            let lean = 2f64.powi(-12 - i % 12) * rng.point();
            let ray = Ray::new(target - along - lean, along + lean).unwrap();
            let FilterVerdict::Crosses(crossing) = filter::<false>(&triangle, &ray) else { continue };
            hits += 1;
            let refined = Refined::new::<false, _>(Fallback::new(), &crossing, &triangle, &ray, crossing.solution());
            if refined.t::<false>().is_some() {
                first += 1;
            } else if let (Some(t), Some(weights)) = again(&triangle, &ray) {
                second += 1;
                assert_eq!(t, integers::integer_t(&triangle, &ray), "{triangle:?} {ray:?}");
                assert_eq!(Some(weights), integers::integer_weights(&triangle, &ray), "{triangle:?} {ray:?}");
            }
        }
        assert!(hits > 1500 && first < hits / 2 && second > hits / 3, "{hits} {first} {second}");
    }
    /// `r`, the solutions for it, and what they leave of `t` and the weights: near the origin and far from it, down to
    /// rays that nearly lie in the plane. Neither constant could be 2^7 times smaller, nor the bounds of a candidate.
    #[test]
    fn the_rest_and_the_steps_keep_their_bounds() {
        let rng = &mut Random::new(6);
        let mut hits = 0;
        for i in 0..24_000 {
            let place = f64::from([0, 10, 1000][i % 3]) * rng.point();
            let [a, b, c] = [0; 3].map(|_| place + rng.point());
            let triangle = Triangle::new(a, b, c).unwrap();
            let mut inside = || 0.4 * rng.uniform().abs() * (b - a) + 0.4 * rng.uniform().abs() * (c - a);
            let (target, along) = (a + inside(), inside());
            let lean = 2f64.powi(-i32::try_from(i % 24).unwrap()) * rng.point();
            let ray = Ray::new(target - along - lean, along + lean).unwrap();
            let FilterVerdict::Crosses(crossing) = filter::<false>(&triangle, &ray) else { continue };
            let refined = Refined::new::<false, _>(Fallback::new(), &crossing, &triangle, &ray, crossing.solution());
            hits += 1;
            let context = || format!("{triangle:?} {ray:?}");
            let below = |x: Big, bound: f64| x < exact(bound) && -x < exact(bound);

            // The points in exact arithmetic, relative to the first vertex.
            let (at, d) = (vector(a), vector(ray.direction()));
            let [s, e, f] = [ray.origin(), b, c].map(|point| sub(&vector(point), &at));
            let [t, beta, gamma] = [refined.t, refined.weights[1], refined.weights[2]].map(exact);
            for i in 0..3 {
                let rest = &s[i] + &t * &d[i] - (&beta * &e[i] + &gamma * &f[i]);
                let bound = REST_ERROR * (max_abs(a) + crossing.size) + 2.1 * U * refined.rest[i].abs();
                assert!(below(rest - exact(refined.rest[i]), bound), "rest: {}", context());
            }

            // Solving for the rest as computed: t' = -r . (e x f) / sum, β' = r . (d x f) / -sum, γ' = r . (e x d) /
            // -sum.
            let origin = vector(ray.origin());
            let truth = oracle::Crossing::new(&d, [a, b, c].map(|vertex| sub(&vector(vertex), &origin)));
            let TriangleCrossing { edge, sum, .. } = crossing;
            let (rest, n) = (vector(refined.rest), cross(&e, &f));
            let length = refined.rest.x.abs() + refined.rest.y.abs() + refined.rest.z.abs();
            let error = SOLUTION_ERROR * (ray.reach() * edge * edge / sum) * length;
            let (step, t_error) = refined.t_step::<false>();
            let left = exact(step) * &truth.slope + dot(&rest, &n);
            assert!(below(left, edge * edge * error), "step of t: {}", context());
            let weights = refined.weight_steps::<false>();
            let normals = [cross(&f, &d), cross(&d, &e)];
            for i in 0..2 {
                let left = exact(weights[i + 1].0) * &truth.slope - dot(&rest, &normals[i]);
                assert!(below(left, 2.0 * edge * ray.reach() * error), "step of a weight: {}", context());
            }

            // The corrected values; times the slope, which is the sum of the volumes.
            let left = (&t + exact(step)) * &truth.slope - &truth.height;
            assert!(below(left, 1.01 * sum * t_error), "t: {}", context());
            for (i, (step, error)) in weights.into_iter().enumerate() {
                let corrected = exact(refined.weights[i]) + exact(step);
                let left = corrected * &truth.slope - &truth.volumes[i];
                assert!(below(left, 1.01 * sum * error), "weight {i}: {}", context());
            }
            let (low, high) = crossing.bounds(&ray);
            let compare = |x: f64| (exact(x) * &truth.slope).cmp(&truth.height);
            let (low, high) = if sign(&truth.slope) == Ordering::Less { (high, low) } else { (low, high) };
            assert!(compare(low) == Ordering::Less && compare(high) == Ordering::Greater, "{}", context());
        }
        assert!(hits > 20_000, "{hits}");
    }
}
