//! The stages after the filter: double-double and integers.

use std::cmp::Ordering;
use std::ops::Range;

use glam::DVec3;
use rt_math::exact::{Dyadic, round_if_certain, two_diff, two_prod, two_sum};
use rt_math::fma_dispatch;

use super::{FARTHEST, Triangle, U, UNDERFLOW, UNDERFLOW_T, Verdict};
use crate::Ray;
use crate::ray::{holds, larger, max_abs};

/// A number as `high + low`; the low part is at most a few units in the last place of what `high` was summed from.
#[derive(Clone, Copy)]
pub(crate) struct Pair {
    pub(crate) high: f64,
    pub(crate) low: f64,
}

/// A vector of pairs.
pub(crate) type Pairs = [Pair; 3];

/// `p - q`, exactly.
#[inline(always)]
pub(crate) fn difference(p: DVec3, q: DVec3) -> Pairs {
    let part = |p, q| {
        let (high, low) = two_diff(p, q);
        Pair { high, low }
    };
    [part(p.x, q.x), part(p.y, q.y), part(p.z, q.z)]
}

/// The vector itself.
#[inline(always)]
fn pairs(v: DVec3) -> Pairs {
    let part = |high| Pair { high, low: 0.0 };
    [part(v.x), part(v.y), part(v.z)]
}

/// `v x w`; component `i` is off by at most `16 u² (|v_j w_k| + |v_k w_j|)`.
#[inline(always)]
pub(crate) fn cross<const FMA: bool>(v: &Pairs, w: &Pairs) -> Pairs {
    let part = |j: usize, k: usize| {
        let (p, p_low) = two_prod::<FMA>(v[j].high, w[k].high);
        let (q, q_low) = two_prod::<FMA>(v[k].high, w[j].high);
        let (high, error) = two_diff(p, q);
        let crossed =
            (v[j].high * w[k].low + v[j].low * w[k].high) - (v[k].high * w[j].low + v[k].low * w[j].high);
        Pair { high, low: error + ((p_low - q_low) + crossed) }
    };
    [part(1, 2), part(2, 0), part(0, 1)]
}

/// `v . w` where `v` is a cross product and `w` a difference: off by at most `91 u²` times the permanent.
#[inline(always)]
pub(crate) fn dot<const FMA: bool>(v: &Pairs, w: &Pairs) -> Pair {
    let part = |i: usize| {
        let (high, low) = two_prod::<FMA>(v[i].high, w[i].high);
        (high, low + (v[i].high * w[i].low + v[i].low * w[i].high))
    };
    let ((x, x_low), (y, y_low), (z, z_low)) = (part(0), part(1), part(2));
    let (sum, e1) = two_sum(x, y);
    let (high, e2) = two_sum(sum, z);
    Pair { high, low: (x_low + y_low) + (z_low + (e1 + e2)) }
}

/// A divisor: a pair, a bound of its error, which includes all underflow, and the reciprocal of the high part.
#[derive(Clone, Copy)]
pub(crate) struct Divisor {
    pair: Pair,
    error: f64,
    inverse: f64,
}

impl Divisor {
    #[inline(always)]
    pub(crate) fn new(pair: Pair, error: f64) -> Self {
        Self { pair, error, inverse: 1.0 / pair.high }
    }

    /// Returns `n / self`, correctly rounded, or `None` if the errors leave it open; `n` is off by at most `n_error`.
    #[inline(always)]
    pub(crate) fn divide<const FMA: bool>(&self, n: Pair, n_error: f64) -> Option<f64> {
        let Self { pair: d, error: d_error, inverse } = *self;
        let t = n.high * inverse;
        let (product, product_low) = two_prod::<FMA>(t, d.high);
        // The first difference is exact, since `t` is within a few units in the last place.
        let rest = ((n.high - product) - product_low) + (n.low - t * d.low);
        let step = rest * inverse;
        let relative = (d.low.abs() + d_error) * inverse.abs();
        let low_parts = n.low.abs() + t.abs() * d.low.abs();
        let absolute = (n_error + t.abs() * d_error + 3.0 * U * low_parts) * inverse.abs();
        let error = 1.2 * (absolute + step.abs() * relative) + 8.0 * U * step.abs() + UNDERFLOW_T;
        if relative <= 0.125 { round_if_certain(t, step, error) } else { None }
    }
}

fma_dispatch! {
    /// Returns the correctly rounded `t`, or `None` if it takes integers. The filter must have found a hit.
    pub(super) fn rounded_t(triangle: &Triangle, ray: &Ray) -> Option<f64> = t_kernel;
}

#[inline(always)]
fn t_kernel<const FMA: bool>(triangle: &Triangle, ray: &Ray) -> Option<f64> {
    let [a, b, c] = triangle.vertices;
    let d = ray.direction();
    let (e, f, from) = (difference(b, a), difference(c, a), difference(a, ray.origin()));
    let n = cross::<FMA>(&e, &f);
    let (height, slope) = (dot::<FMA>(&n, &from), dot::<FMA>(&n, &pairs(d)));
    let most = |i: usize| larger(e[i].high.abs(), f[i].high.abs());
    let size = most(0) + most(1) + most(2);
    let relative = 64.0 * U * U * size * size;
    let farthest = larger(from[0].high.abs(), larger(from[1].high.abs(), from[2].high.abs()));
    let height_error = relative * farthest + UNDERFLOW;
    let slope_error = relative * max_abs(d) + UNDERFLOW;
    Divisor::new(slope, slope_error).divide::<FMA>(height, height_error)
}

fma_dispatch! {
    /// Returns the correctly rounded weights, or `None` if they take integers. The filter must have found a hit.
    pub(super) fn rounded_weights(triangle: &Triangle, ray: &Ray) -> Option<[f64; 3]> = weights_kernel;
}

#[inline(always)]
fn weights_kernel<const FMA: bool>(triangle: &Triangle, ray: &Ray) -> Option<[f64; 3]> {
    let span = Span::new::<FMA>(triangle, ray)?;
    let (sum, sum_error) = span.sum();
    span.weights::<FMA>(&Divisor::new(sum, sum_error))
}

fma_dispatch! {
    /// Returns the correctly rounded `t` and weights, or `None` if they take integers. The filter must have found a hit.
    pub(super) fn rounded_hit(triangle: &Triangle, ray: &Ray) -> Option<(f64, [f64; 3])> = hit_kernel;
}

#[inline(always)]
fn hit_kernel<const FMA: bool>(triangle: &Triangle, ray: &Ray) -> Option<(f64, [f64; 3])> {
    let span = Span::new::<FMA>(triangle, ray)?;
    let (sum, sum_error) = span.sum();
    let weights = span.weights::<FMA>(&Divisor::new(sum, sum_error))?;
    // t d = (u a + v b + w c) / (u + v + w), of which the longest axis is taken.
    let d = ray.direction().to_array();
    let z = if d[0].abs() == span.reach {
        0
    } else if d[1].abs() == span.reach {
        1
    } else {
        2
    };
    let height = dot::<FMA>(&span.volumes, &[span.vertices[0][z], span.vertices[1][z], span.vertices[2][z]]);
    let (high, low) = two_prod::<FMA>(sum.high, d[z]);
    let slope = Pair { high, low: low + sum.low * d[z] };
    let height_error = 7.0 * span.error * span.size + UNDERFLOW;
    let slope_error = 6.0 * span.error * span.reach + UNDERFLOW;
    let t = Divisor::new(slope, slope_error).divide::<FMA>(height, height_error)?;
    Some((t, weights))
}

/// What a ray and a triangle span, in pairs.
struct Span {
    /// The vertices relative to the origin of the ray.
    vertices: [Pairs; 3],
    /// `u`, `v`, `w`, each within `error`.
    volumes: [Pair; 3],
    error: f64,
    /// The sum over the axes of the largest component of the vertices.
    size: f64,
    /// The largest component of the direction.
    reach: f64,
}

impl Span {
    /// Returns `None` out of the range where the bounds hold.
    #[inline(always)]
    fn new<const FMA: bool>(triangle: &Triangle, ray: &Ray) -> Option<Self> {
        let d = ray.direction();
        let vertices = triangle.vertices.map(|vertex| difference(vertex, ray.origin()));
        let [a, b, c] = &vertices;
        let most = |i: usize| larger(a[i].high.abs(), larger(b[i].high.abs(), c[i].high.abs()));
        let size = most(0) + most(1) + most(2);
        let reach = max_abs(d);
        let in_range = size < FARTHEST && (1e-30..=1e30).contains(&reach);
        let error = 64.0 * U * U * reach * size * size + UNDERFLOW;
        let beside_a = cross::<FMA>(&pairs(d), a);
        let beside_b = cross::<FMA>(&pairs(d), b);
        let u = dot::<FMA>(&beside_b, c);
        let v = dot::<FMA>(&beside_a, c);
        let w = dot::<FMA>(&beside_a, b);
        let volumes = [u, Pair { high: -v.high, low: -v.low }, w];
        in_range.then_some(Self { vertices, volumes, error, size, reach })
    }

    /// `u + v + w` and a bound of its error: three times that of a volume, and the roundings of the low parts.
    #[inline(always)]
    fn sum(&self) -> (Pair, f64) {
        let [u, v, w] = self.volumes;
        let (sum, e1) = two_sum(u.high, v.high);
        let (high, e2) = two_sum(sum, w.high);
        (Pair { high, low: (u.low + v.low) + (w.low + (e1 + e2)) }, 5.0 * self.error)
    }

    #[inline(always)]
    fn weights<const FMA: bool>(&self, sum: &Divisor) -> Option<[f64; 3]> {
        let [u, v, w] = self.volumes;
        Some([
            sum.divide::<FMA>(u, self.error)?,
            sum.divide::<FMA>(v, self.error)?,
            sum.divide::<FMA>(w, self.error)?,
        ])
    }
}

/// Returns the hit's `t` if it is in the range, whatever it takes.
#[cold]
#[inline(never)]
pub(super) fn closest(triangle: &Triangle, ray: &Ray, within: Range<f64>) -> Option<f64> {
    let t = line_verdict(triangle, ray).is_hit().then(|| integer_t(triangle, ray))?;
    holds(&within, t).then_some(t)
}

/// Returns how the whole line meets the triangle, whatever it takes.
#[cold]
#[inline(never)]
pub(super) fn line_verdict(triangle: &Triangle, ray: &Ray) -> Verdict {
    let signs = double_double_signs(triangle, ray).unwrap_or_else(|| Volumes::new(triangle, ray).signs());
    verdict(signs)
        .unwrap_or_else(|| if is_degenerate(triangle) { Verdict::Degenerate } else { Verdict::Parallel })
}

/// The verdict from the signs of the volumes and of their sum; `None` if the sum is zero.
fn verdict(signs: [Ordering; 4]) -> Option<Verdict> {
    let [corners @ .., sum] = signs;
    if sum == Ordering::Equal {
        return None;
    }
    if corners.contains(&sum.reverse()) {
        return Some(Verdict::Miss);
    }
    Some(match corners.map(|sign| sign == Ordering::Equal) {
        [false, false, false] => Verdict::Interior,
        [false, false, true] => Verdict::Edge(0),
        [true, false, false] => Verdict::Edge(1),
        [false, true, false] => Verdict::Edge(2),
        [false, true, true] => Verdict::Vertex(0),
        [true, false, true] => Verdict::Vertex(1),
        // Not all three, since their sum is not zero.
        [true, true, _] => Verdict::Vertex(2),
    })
}

/// The signs of the volumes and of their sum, in double-double, if all are certain.
fn double_double_signs(triangle: &Triangle, ray: &Ray) -> Option<[Ordering; 4]> {
    let Span { volumes, error, .. } = Span::new::<false>(triangle, ray)?;
    let [u, v, w] = volumes.map(|volume| volume.high + volume.low);
    // One rounding more per volume, three for the sum.
    let sum = u + v + w;
    let certain = |x: f64, bound: f64| (x.abs() > bound).then(|| x.total_cmp(&0.0));
    let sum_error = 4.0 * U * (u.abs() + v.abs() + w.abs()) + 4.0 * error;
    let error = 2.0 * error;
    Some([certain(u, error)?, certain(v, error)?, certain(w, error)?, certain(sum, sum_error)?])
}

/// Limbs for what a ray and a triangle span, of degree three: multiples of 2^-3222 below 2^3079 take 101, and their
/// quotients two more.
type Integer = Dyadic<104>;
type IntegerVector = [Integer; 3];

/// The exact volumes, with what they come from.
struct Volumes {
    /// The vertices relative to the origin of the ray.
    vertices: [IntegerVector; 3],
    /// `b x c`, `c x a`, `a x b`.
    planes: [IntegerVector; 3],
    /// `u`, `v`, `w`.
    volumes: [Integer; 3],
}

impl Volumes {
    fn new(triangle: &Triangle, ray: &Ray) -> Self {
        let direction = ray.direction().to_array().map(Integer::from_f64);
        let vertices = triangle.vertices.map(|vertex| integer_difference(vertex, ray.origin()));
        let [a, b, c] = &vertices;
        let planes = [integer_cross(b, c), integer_cross(c, a), integer_cross(a, b)];
        let volumes = [0, 1, 2].map(|i| integer_dot(&planes[i], &direction));
        Self { vertices, planes, volumes }
    }

    fn sum(&self) -> Integer {
        &self.volumes[0] + &self.volumes[1] + &self.volumes[2]
    }

    fn signs(&self) -> [Ordering; 4] {
        let [u, v, w] = &self.volumes;
        [u.sign(), v.sign(), w.sign(), self.sum().sign()]
    }

    /// `(b - a) x (c - a)`: the sum of the three planes' normals.
    fn normal(&self) -> IntegerVector {
        let [p, q, r] = &self.planes;
        [0, 1, 2].map(|i| &p[i] + &q[i] + &r[i])
    }

    /// Six times the volume that the triangle spans with the origin of the ray: `a . b x c`.
    fn height(&self) -> Integer {
        integer_dot(&self.planes[0], &self.vertices[0])
    }
}

/// Returns the correctly rounded `t` where the line meets the plane; the line must not be parallel to it.
#[cold]
#[inline(never)]
pub(super) fn integer_t(triangle: &Triangle, ray: &Ray) -> f64 {
    let volumes = Volumes::new(triangle, ray);
    Integer::quotient(&volumes.height(), &volumes.sum())
}

/// Returns the correctly rounded weights if the line meets the triangle.
#[cold]
#[inline(never)]
pub(super) fn integer_weights(triangle: &Triangle, ray: &Ray) -> Option<[f64; 3]> {
    let volumes = Volumes::new(triangle, ray);
    let sum = volumes.sum();
    verdict(volumes.signs())?.is_hit().then(|| volumes.volumes.map(|volume| Integer::quotient(&volume, &sum)))
}

/// Whether the turned ray crosses the triangle: [`Triangle::crosses`], whatever it takes.
#[cold]
#[inline(never)]
pub(super) fn crosses(triangle: &Triangle, ray: &Ray) -> bool {
    let volumes = Volumes::new(triangle, ray);
    // The sign of (d + (e, e², e³)) . v for an infinitely small e > 0.
    let turned = |volume: &Integer, v: &IntegerVector| {
        [volume, &v[0], &v[1], &v[2]].map(Integer::sign).into_iter().fold(Ordering::Equal, Ordering::then)
    };
    let height = volumes.height().sign();
    let slope = turned(&volumes.sum(), &volumes.normal());
    // Height zero: the origin is in the plane, or there is no plane.
    height != Ordering::Equal
        && height == slope
        && (0..3).all(|i| turned(&volumes.volumes[i], &volumes.planes[i]) == slope)
}

/// Limbs for the normal, of degree two: a multiple of 2^-2148 below 2^2052.
type NormalInteger = Dyadic<68>;

fn integer_normal(triangle: &Triangle) -> [NormalInteger; 3] {
    let [a, b, c] = triangle.vertices;
    integer_cross(&integer_difference(b, a), &integer_difference(c, a))
}

/// Whether the triangle has no area, in integers.
#[cold]
#[inline(never)]
pub(crate) fn is_degenerate(triangle: &Triangle) -> bool {
    integer_normal(triangle).iter().all(|part| part.sign() == Ordering::Equal)
}

/// Returns `(b - a) x (c - a)` times a power of two, with a largest component near 1, or `None` if it is zero.
///
/// Each component is off by at most `1.01 u` of the largest.
pub(super) fn scaled_normal(triangle: &Triangle) -> Option<DVec3> {
    let [a, b, c] = triangle.vertices;
    let (e, f) = (difference(b, a), difference(c, a));
    let n = DVec3::from_array(cross::<false>(&e, &f).map(|part| part.high + part.low));
    let largest = larger(max_abs(b - a), max_abs(c - a));
    // Here the error of the pairs, 32 u² largest², is below 2^-61 of the normal.
    let certain = (1e-70..=1e70).contains(&largest) && max_abs(n) >= 1e-12 * largest * largest;
    let n = if certain { n } else { integer_scaled_normal(triangle)? };
    Some(n * crate::sphere::power_of_two_near_inverse(max_abs(n)))
}

#[cold]
fn integer_scaled_normal(triangle: &Triangle) -> Option<DVec3> {
    let n = integer_normal(triangle);
    let rounded = |k: i32| DVec3::from_array([0, 1, 2].map(|i| n[i].scale(k).to_f64()));
    // The largest component lies between 2^-2148 and 2^2052: one of three scales puts it well inside the range.
    let inside = |v: &DVec3| (1e-150..=1e150).contains(&max_abs(*v));
    match rounded(0) {
        v if inside(&v) => Some(v),
        _ if n.iter().all(|part| part.sign() == Ordering::Equal) => None,
        v if max_abs(v) > 1.0 => Some(rounded(-1250)),
        _ => Some(rounded(1300)),
    }
}

pub(crate) fn integer_difference<const LIMBS: usize>(p: DVec3, q: DVec3) -> [Dyadic<LIMBS>; 3] {
    [0, 1, 2].map(|i| Dyadic::from_f64(p[i]) - Dyadic::from_f64(q[i]))
}

pub(crate) fn integer_cross<const LIMBS: usize>(
    v: &[Dyadic<LIMBS>; 3],
    w: &[Dyadic<LIMBS>; 3],
) -> [Dyadic<LIMBS>; 3] {
    let part = |j: usize, k: usize| &v[j] * &w[k] - &v[k] * &w[j];
    [part(1, 2), part(2, 0), part(0, 1)]
}

pub(crate) fn integer_dot<const LIMBS: usize>(
    v: &[Dyadic<LIMBS>; 3],
    w: &[Dyadic<LIMBS>; 3],
) -> Dyadic<LIMBS> {
    &v[0] * &w[0] + &v[1] * &w[1] + &v[2] * &w[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ray::PreparedRay;

    /// Numbers in -1..1 from a fixed seed (splitmix64).
    fn random(state: &mut u64) -> f64 {
        *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (*state ^ (*state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector(state: &mut u64) -> DVec3 {
        DVec3::new(random(state), random(state), random(state))
    }

    /// A triangle and a ray aimed at the place with these weights of the second and third vertex.
    fn case(state: &mut u64, v: f64, w: f64) -> (Triangle, Ray) {
        let [a, b, c] = [vector(state), vector(state), vector(state)];
        let origin = 5.0 * vector(state);
        let direction = a + v * (b - a) + w * (c - a) - origin;
        (Triangle::new(a, b, c).unwrap(), Ray::new(origin, direction).unwrap())
    }

    /// How many verdicts each stage has reached, and how many `t` and weights.
    #[derive(Debug, Default)]
    struct Stages {
        filter: usize,
        double_double: usize,
        integers: usize,
        rounded: usize,
        not_rounded: usize,
    }

    impl Stages {
        fn count(&mut self, triangle: &Triangle, ray: &Ray) {
            let prepared = PreparedRay::new(ray, 0.0..f64::INFINITY);
            let exact = Volumes::new(triangle, ray);
            if let Some(order) = triangle.line_beside(&prepared) {
                self.filter += 1;
                let expected = verdict(exact.signs()).unwrap();
                assert_eq!(order == Ordering::Less, expected == Verdict::Miss, "{triangle:?} {ray:?}");
                if order == Ordering::Less {
                    return;
                }
                assert_eq!(expected, Verdict::Interior, "{triangle:?} {ray:?}");
                match (rounded_t(triangle, ray), rounded_weights(triangle, ray), rounded_hit(triangle, ray)) {
                    (Some(t), Some(weights), Some(both)) => {
                        self.rounded += 1;
                        assert_eq!(t, integer_t(triangle, ray), "{triangle:?} {ray:?}");
                        assert_eq!(Some(weights), integer_weights(triangle, ray), "{triangle:?} {ray:?}");
                        assert_eq!(both, (t, weights), "{triangle:?} {ray:?}");
                    }
                    _ => self.not_rounded += 1,
                }
            } else if let Some(signs) = double_double_signs(triangle, ray) {
                self.double_double += 1;
                assert_eq!(signs, exact.signs(), "{triangle:?} {ray:?}");
            } else {
                self.integers += 1;
            }
        }
    }

    #[test]
    fn benign_rays_never_leave_the_first_stages() {
        let (mut stages, state) = (Stages::default(), &mut 1);
        for _ in 0..4096 {
            let (v, w) = (0.5 * random(state) + 0.4, 0.5 * random(state) + 0.4);
            let (triangle, ray) = case(state, v, w);
            stages.count(&triangle, &ray);
        }
        assert_eq!((stages.filter, stages.not_rounded), (4096, 0), "{stages:?}");
        assert!(stages.rounded > 1000, "{stages:?}");
    }

    #[test]
    fn every_stage_decides_hard_cases() {
        let (mut stages, state) = (Stages::default(), &mut 2);
        for i in 0..4096 {
            // within less and less of an edge
            let (v, w) = (random(state), 2f64.powi(-(i % 60)) * random(state));
            let (triangle, ray) = case(state, v, w);
            stages.count(&triangle, &ray);
        }
        for k in 0..64 {
            // exactly through an edge
            let triangle = Triangle::new(DVec3::ZERO, DVec3::X, DVec3::Y).unwrap();
            let origin = DVec3::new(f64::from(k) / 64.0, 0.0, 1.0);
            stages.count(&triangle, &Ray::new(origin, DVec3::NEG_Z).unwrap());
            // t is halfway between two doubles
            let origin = DVec3::new(0.25, 0.25, 1.0 + f64::from(k) * f64::EPSILON);
            let plane = -(f64::EPSILON / 2.0);
            let [a, b, c] = triangle.vertices.map(|vertex| vertex + DVec3::new(0.0, 0.0, plane));
            stages.count(&Triangle::new(a, b, c).unwrap(), &Ray::new(origin, DVec3::NEG_Z).unwrap());
        }
        let all = [stages.filter, stages.double_double, stages.integers, stages.rounded, stages.not_rounded];
        assert!(all.iter().all(|&n| n >= 60), "{stages:?}");
    }

    #[test]
    fn fused_and_plain_arithmetic_give_the_same_values() {
        let state = &mut 3;
        for _ in 0..2000 {
            let (v, w) = (0.5 * random(state).abs(), 0.5 * random(state).abs());
            let (triangle, ray) = case(state, v, w);
            assert_eq!(t_kernel::<false>(&triangle, &ray), t_kernel::<true>(&triangle, &ray));
            assert_eq!(weights_kernel::<false>(&triangle, &ray), weights_kernel::<true>(&triangle, &ray));
            assert_eq!(hit_kernel::<false>(&triangle, &ray), hit_kernel::<true>(&triangle, &ray));
        }
    }
}
