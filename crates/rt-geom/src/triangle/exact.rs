//! The stages after the filter: fixed-point numbers, double-double, integers of any size.
//!
//! Fixed-point comes before double-double here: all three volumes cost less in it, and it always decides.

use std::cell::OnceCell;
use std::cmp::Ordering;
use std::ops::Range;

use glam::DVec3;
use rt_math::exact::vector::{cross, difference, dot, minus};
use rt_math::exact::{DoubleDouble, Dyadic, Fixed, U, Window, bits_spanned, power_of_two, power_of_two_near_inverse};

use super::{FARTHEST, Triangle, Verdict};
use crate::Ray;
use crate::ray::{holds, larger, max_abs};
use crate::stage::{Stage, decided};

/// Swallows all errors of underflow: `2^-500` (`docs/numerics.md`, section 6).
const UNDERFLOW: f64 = power_of_two(-500);

/// Cold stages need no FMA.
type ColdDoubleDouble = DoubleDouble<false>;

/// Asks the smallest exact arithmetic that holds the numbers: the question is compiled for each.
macro_rules! ask {
    ($triangle:ident, $ray:ident, |$volumes:ident| $question:expr) => {
        if let Some($volumes) = FixedVolumes::<1, 2, 3>::new($triangle, $ray) {
            decided(Stage::Fixed);
            $question
        } else {
            ask_wider($triangle, $ray, |$volumes| $question)
        }
    };
}

/// Returns the hit's `t` if it is in the range; slow path, always decides.
#[cold]
#[inline(never)]
pub(super) fn closest(triangle: &Triangle, ray: &Ray, within: Range<f64>) -> Option<f64> {
    let t = ask!(triangle, ray, |volumes| volumes.is_hit().then(|| volumes.t()))?;
    holds(&within, t).then_some(t)
}

/// Returns the correctly rounded `t` where a line that surely crosses the triangle does; slow path, always decides.
#[cold]
#[inline(never)]
pub(super) fn crossing_t(triangle: &Triangle, ray: &Ray) -> f64 {
    ask!(triangle, ray, |volumes| volumes.t())
}

/// Returns how the whole line meets the triangle; slow path, always decides.
#[cold]
#[inline(never)]
pub(super) fn line_verdict(triangle: &Triangle, ray: &Ray) -> Verdict {
    ask!(triangle, ray, |volumes| verdict(volumes.signs()))
        .unwrap_or_else(|| if is_degenerate(triangle) { Verdict::Degenerate } else { Verdict::Parallel })
}

/// Returns the correctly rounded weights if the line meets the triangle.
#[cold]
#[inline(never)]
pub(super) fn exact_weights(triangle: &Triangle, ray: &Ray) -> Option<[f64; 3]> {
    ask!(triangle, ray, |volumes| volumes.is_hit().then(|| volumes.weights()))
}

/// Returns the correctly rounded `t` if it is in the range, and the weights.
#[cold]
#[inline(never)]
pub(super) fn closest_with_weights(triangle: &Triangle, ray: &Ray, within: Range<f64>) -> Option<(f64, [f64; 3])> {
    ask!(triangle, ray, |volumes| {
        let t = volumes.is_hit().then(|| volumes.t()).filter(|&t| holds(&within, t));
        t.map(|t| (t, volumes.weights()))
    })
}

/// Whether the turned ray crosses the triangle: [`Triangle::crosses`]; slow path, always decides.
#[cold]
#[inline(never)]
pub(super) fn crosses(triangle: &Triangle, ray: &Ray) -> bool {
    ask!(triangle, ray, |volumes| {
        let (height, [_, _, _, slope]) = (volumes.height_sign(), volumes.signs());
        // Height zero: the origin is in the plane, or there is no plane. Slope zero: two of the volumes have opposite
        // signs.
        height != Ordering::Equal && height == slope && volumes.turned_signs() == [slope; 3]
    })
}

/// The sign of `d . (b - a) x (c - a)`: `Less` where the ray comes from the side that the normal leads to.
pub(crate) fn slope_sign(triangle: &Triangle, ray: &Ray) -> Ordering {
    let [a, b, c] = triangle.vertices;
    // Modelled in docs/proofs/Triangle.v: tslope, tleans.
    let slope = ray.direction().cross(b - a).dot(c - a);
    // As the filter's `sum`; false for NaN.
    if triangle.edge < FARTHEST && slope.abs() > (18.0 * U * triangle.edge) * triangle.edge * ray.reach() {
        return slope.total_cmp(&0.0);
    }
    normal_sign(triangle, DVec3::ZERO, ray.direction())
}

/// The sign of `(a - o) . (b - a) x (c - a)`, for the ray's origin `o`: `Less` where it lies on the side that the
/// normal leads to.
pub(crate) fn height_sign(triangle: &Triangle, ray: &Ray) -> Ordering {
    let [a, b, c] = triangle.vertices;
    let from = a - ray.origin();
    let height = (b - a).cross(c - a).dot(from);
    let size = triangle.edge * (from.x.abs() + from.y.abs() + from.z.abs());
    if triangle.edge + size < FARTHEST && height.abs() > (18.0 * U * triangle.edge) * size + UNDERFLOW {
        return height.total_cmp(&0.0);
    }
    normal_sign(triangle, ray.origin(), a)
}

/// The sign of `(to - from) . (b - a) x (c - a)`; always decides.
#[cold]
#[inline(never)]
fn normal_sign(triangle: &Triangle, from: DVec3, to: DVec3) -> Ordering {
    fixed_normal_sign::<1, 2, 3>(triangle, from, to)
        .or_else(|| fixed_normal_sign::<2, 4, 6>(triangle, from, to))
        .unwrap_or_else(|| {
            let [a, b, c] = triangle.vertices;
            let normal = cross(&difference::<Dyadic<104>>(b, a), &difference(c, a));
            dot(&normal, &difference(to, from)).sign()
        })
}

fn fixed_normal_sign<const N: usize, const A: usize, const V: usize>(
    triangle: &Triangle,
    from: DVec3,
    to: DVec3,
) -> Option<Ordering> {
    let [a, b, c] = triangle.vertices;
    let window = Window::<N>::around([a, b, c, from, to].map(|point| point.to_array()).as_flattened())?;
    let [a, b, c, from, to] = [a, b, c, from, to].map(|point| window.vector(point));
    let normal: [Fixed<A>; 3] = cross(&minus(&b, &a), &minus(&c, &a));
    Some(dot::<_, _, Fixed<V>>(&normal, &minus(&to, &from)).sign())
}

/// What exact arithmetic, of whatever size, knows of a ray and a triangle. All signs may be the opposite ones together.
trait Volumes {
    /// Whether the line meets the triangle: [`verdict`] of the signs is a hit.
    fn is_hit(&self) -> bool {
        verdict(self.signs()).is_some_and(Verdict::is_hit)
    }

    /// The signs of the three volumes and of their sum.
    fn signs(&self) -> [Ordering; 4];

    /// The signs of the volumes for the direction `d + (e, e², e³)` with an infinitely small `e > 0`.
    fn turned_signs(&self) -> [Ordering; 3];

    /// The sign of `a . b x c`, six times the volume that the triangle spans with the origin of the ray.
    fn height_sign(&self) -> Ordering;

    /// The correctly rounded `t` where the line meets the plane; the sum of the volumes must not be zero.
    fn t(&self) -> f64;

    /// The volumes divided by their sum, correctly rounded; it must not be zero.
    fn weights(&self) -> [f64; 3];
}

/// Asks what follows where no window of one limb holds the numbers.
#[cold]
#[inline(never)]
fn ask_wider<R>(triangle: &Triangle, ray: &Ray, question: impl FnOnce(&dyn Volumes) -> R) -> R {
    if let Some(volumes) = FixedVolumes::<2, 4, 6>::new(triangle, ray) {
        decided(Stage::Fixed);
        question(&volumes)
    } else {
        ask_integers(triangle, ray, question)
    }
}

/// Limbs for volumes of points and directions that span at most [`NARROW`] bits with them.
const NARROW_LIMBS: usize = 24;
const NARROW: i32 = 64 * 20;
/// ... and of any; each with two for the ends and two for a quotient: multiples of 2^-3222 below 2^3079 take 101.
const ANY_LIMBS: usize = 104;

/// Asks integers of the size that the exponents of the numbers need.
#[cold]
#[inline(never)]
fn ask_integers<R>(triangle: &Triangle, ray: &Ray, question: impl FnOnce(&dyn Volumes) -> R) -> R {
    if volume_bits(triangle, ray) <= NARROW {
        question(&WideVolumes::<NARROW_LIMBS> { triangle, ray, integers: OnceCell::new() })
    } else {
        question(&WideVolumes::<ANY_LIMBS> { triangle, ray, integers: OnceCell::new() })
    }
}

/// The bits that volumes and heights span at most: a product of three, two or three of them differences, and the sum of
/// three times six such.
fn volume_bits(triangle: &Triangle, ray: &Ray) -> i32 {
    let ([a, b, c], o) = (triangle.vertices, ray.origin());
    let points = bits_spanned(&[o.x, o.y, o.z, a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z]) + 1;
    2 * points + points.max(bits_spanned(&ray.direction().to_array())) + 5
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
    let [a, b, c] = triangle.vertices.map(|vertex| difference::<ColdDoubleDouble>(vertex, ray.origin()));
    let d = ray.direction().to_array().map(ColdDoubleDouble::new);
    let most = |i: usize| larger(a[i].high().abs(), larger(b[i].high().abs(), c[i].high().abs()));
    let size = most(0) + most(1) + most(2);
    let error = 32.0 * U * U * ray.reach() * size * size + UNDERFLOW;
    // Modelled in docs/proofs/TriangleExact.v: tu, tv, tw, tsum, terror.
    let beside_a = cross(&d, &a);
    let (u, v, w) = (dot(&cross(&d, &b), &c), -dot(&beside_a, &c), dot(&beside_a, &b));
    // False for NaN.
    let certain =
        |x: ColdDoubleDouble, bound: f64| (size < FARTHEST && x.high().abs() > bound).then(|| x.high().total_cmp(&0.0));
    let sum = certain(u + v + w, 4.0 * error)?;
    Some([certain(u, error)?, certain(v, error)?, certain(w, error)?, sum])
}

/// The volumes in fixed-point numbers, where all points lie in one window and the direction in another: coordinates of
/// `N` limbs, areas of `A = 2 N`, volumes of `V = 3 N`. By the formulas of Möller and Trumbore, so all volumes are
/// negative.
struct FixedVolumes<const N: usize, const A: usize, const V: usize> {
    /// The edges from the first vertex, and the origin of the ray relative to it.
    e: [Fixed<N>; 3],
    f: [Fixed<N>; 3],
    s: [Fixed<N>; 3],
    d: [Fixed<N>; 3],
    /// `e . (d x f)`, the sum of the volumes.
    sum: Fixed<V>,
    /// `d x f`
    p: [Fixed<A>; 3],
    /// The height over the sum of the volumes times `2^exponent` is `t`.
    exponent: i32,
}

impl<const N: usize, const A: usize, const V: usize> FixedVolumes<N, A, V> {
    #[inline(always)]
    fn new(triangle: &Triangle, ray: &Ray) -> Option<Self> {
        let ([a, b, c], o) = (triangle.vertices, ray.origin());
        let window = Window::<N>::around(&[o.x, o.y, o.z, a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z])?;
        let direction_window = Window::<N>::around(&ray.direction().to_array())?;
        let a = window.vector(a);
        let (e, f, s) = (minus(&window.vector(b), &a), minus(&window.vector(c), &a), minus(&window.vector(o), &a));
        let d = direction_window.vector(ray.direction());
        let p = cross(&d, &f);
        let sum = dot(&p, &e);
        Some(Self { e, f, s, d, sum, p, exponent: window.exponent() - direction_window.exponent() })
    }

    /// `s x e`
    #[inline(always)]
    fn q(&self) -> [Fixed<A>; 3] {
        cross(&self.s, &self.e)
    }

    /// `u`, `v`, `w`.
    #[inline(always)]
    fn volumes(&self) -> [Fixed<V>; 3] {
        let (v, w): (Fixed<V>, Fixed<V>) = (dot(&self.p, &self.s), dot(&self.q(), &self.d));
        [self.sum - v - w, v, w]
    }

    #[inline(always)]
    fn height(&self) -> Fixed<V> {
        dot(&self.q(), &self.f)
    }
}

impl<const N: usize, const A: usize, const V: usize> Volumes for FixedVolumes<N, A, V> {
    #[inline(always)]
    fn is_hit(&self) -> bool {
        let sum = self.sum.sign();
        if sum == Ordering::Equal {
            return false;
        }
        let [u, v, w] = self.volumes();
        let opposite = sum.reverse();
        (u.sign() != opposite) & (v.sign() != opposite) & (w.sign() != opposite)
    }

    #[inline(always)]
    fn signs(&self) -> [Ordering; 4] {
        let [u, v, w] = self.volumes();
        [u.sign(), v.sign(), w.sign(), self.sum.sign()]
    }

    fn turned_signs(&self) -> [Ordering; 3] {
        // The origin is zero for the vertices of the volumes.
        let a = minus(&[Fixed::ZERO; 3], &self.s);
        let (b, c) = (minus(&self.e, &self.s), minus(&self.f, &self.s));
        let volumes = self.volumes();
        [(volumes[0], c, b), (volumes[1], a, c), (volumes[2], b, a)].map(|(volume, x, y)| {
            volume.sign().then_with(|| {
                let plane: [Fixed<A>; 3] = cross(&x, &y);
                plane[0].sign().then(plane[1].sign()).then(plane[2].sign())
            })
        })
    }

    #[inline(always)]
    fn height_sign(&self) -> Ordering {
        self.height().sign()
    }

    #[inline(always)]
    fn t(&self) -> f64 {
        Fixed::quotient(&self.height(), &self.sum, self.exponent)
    }

    #[inline(always)]
    fn weights(&self) -> [f64; 3] {
        let [u, v, w] = self.volumes();
        [Fixed::quotient(&u, &self.sum, 0), Fixed::quotient(&v, &self.sum, 0), Fixed::quotient(&w, &self.sum, 0)]
    }
}

/// The volumes of numbers that no window holds: signs in double-double where that is certain, all else in integers of
/// any size.
struct WideVolumes<'a, const LIMBS: usize> {
    triangle: &'a Triangle,
    ray: &'a Ray,
    integers: OnceCell<IntegerVolumes<LIMBS>>,
}

impl<const LIMBS: usize> WideVolumes<'_, LIMBS> {
    fn integers(&self) -> &IntegerVolumes<LIMBS> {
        self.integers.get_or_init(|| {
            decided(Stage::Integers);
            IntegerVolumes::new(self.triangle, self.ray)
        })
    }
}

impl<const LIMBS: usize> Volumes for WideVolumes<'_, LIMBS> {
    fn signs(&self) -> [Ordering; 4] {
        let Some(signs) = double_double_signs(self.triangle, self.ray) else { return self.integers().signs() };
        decided(Stage::DoubleDouble);
        signs
    }

    fn turned_signs(&self) -> [Ordering; 3] {
        self.integers().turned_signs()
    }

    fn height_sign(&self) -> Ordering {
        self.integers().height_sign()
    }

    fn t(&self) -> f64 {
        self.integers().t()
    }

    fn weights(&self) -> [f64; 3] {
        self.integers().weights()
    }
}

/// The volumes in integers of any size.
struct IntegerVolumes<const LIMBS: usize> {
    /// The first vertex relative to the origin of the ray.
    vertex: [Dyadic<LIMBS>; 3],
    /// `b x c`, `c x a`, `a x b`.
    planes: [[Dyadic<LIMBS>; 3]; 3],
    /// `u`, `v`, `w`.
    volumes: [Dyadic<LIMBS>; 3],
}

impl<const LIMBS: usize> IntegerVolumes<LIMBS> {
    fn new(triangle: &Triangle, ray: &Ray) -> Self {
        let direction = ray.direction().to_array().map(Dyadic::from_f64);
        let [a, b, c] = triangle.vertices.map(|vertex| difference::<Dyadic<LIMBS>>(vertex, ray.origin()));
        let planes = [cross(&b, &c), cross(&c, &a), cross(&a, &b)];
        let volumes = [0, 1, 2].map(|i| dot(&planes[i], &direction));
        Self { vertex: a, planes, volumes }
    }

    fn sum(&self) -> Dyadic<LIMBS> {
        &self.volumes[0] + &self.volumes[1] + &self.volumes[2]
    }

    fn height(&self) -> Dyadic<LIMBS> {
        dot(&self.planes[0], &self.vertex)
    }
}

impl<const LIMBS: usize> Volumes for IntegerVolumes<LIMBS> {
    fn signs(&self) -> [Ordering; 4] {
        let [u, v, w] = &self.volumes;
        [u.sign(), v.sign(), w.sign(), self.sum().sign()]
    }

    fn turned_signs(&self) -> [Ordering; 3] {
        [0, 1, 2]
            .map(|i| self.planes[i].iter().fold(self.volumes[i].sign(), |sign, part| sign.then_with(|| part.sign())))
    }

    fn height_sign(&self) -> Ordering {
        self.height().sign()
    }

    fn t(&self) -> f64 {
        Dyadic::quotient(&self.height(), &self.sum())
    }

    fn weights(&self) -> [f64; 3] {
        let sum = self.sum();
        [0, 1, 2].map(|i| Dyadic::quotient(&self.volumes[i], &sum))
    }
}

/// Limbs for the normal, of degree two: a multiple of 2^-2148 below 2^2052.
type NormalInteger = Dyadic<68>;

fn integer_normal(triangle: &Triangle) -> [NormalInteger; 3] {
    let [a, b, c] = triangle.vertices;
    cross(&difference::<NormalInteger>(b, a), &difference(c, a))
}

/// Whether the triangle has no area; slow path, always decides.
#[cold]
#[inline(never)]
pub(crate) fn is_degenerate(triangle: &Triangle) -> bool {
    fixed_is_degenerate::<1, 2>(triangle)
        .or_else(|| fixed_is_degenerate::<2, 4>(triangle))
        .unwrap_or_else(|| integer_normal(triangle).iter().all(|part| part.sign() == Ordering::Equal))
}

fn fixed_is_degenerate<const N: usize, const A: usize>(triangle: &Triangle) -> Option<bool> {
    let [a, b, c] = triangle.vertices;
    let window = Window::<N>::around(&[a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z])?;
    let (a, b, c) = (window.vector(a), window.vector(b), window.vector(c));
    let normal: [Fixed<A>; 3] = cross(&minus(&b, &a), &minus(&c, &a));
    Some(normal.iter().all(|part| part.sign() == Ordering::Equal))
}

/// Returns `(b - a) x (c - a)` times a power of two, with a largest component near 1, or `None` if it is zero.
///
/// Each component is off by at most `1.01 u` of the largest.
pub(super) fn scaled_normal(triangle: &Triangle) -> Option<DVec3> {
    let [a, b, c] = triangle.vertices;
    let n = cross(&difference::<ColdDoubleDouble>(b, a), &difference(c, a));
    let n = DVec3::from_array(n.map(ColdDoubleDouble::high));
    let largest = larger(max_abs(b - a), max_abs(c - a));
    // Here the error of the double-doubles, 32 u² largest², is below 2^-61 of the normal.
    let certain = (1e-70..=1e70).contains(&largest) && max_abs(n) >= 1e-12 * largest * largest;
    let n = if certain { n } else { integer_scaled_normal(triangle)? };
    Some(n * power_of_two_near_inverse(max_abs(n)))
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

/// The correctly rounded `t`, by integers of any size alone: the oracle of the other stages.
#[cfg(test)]
pub(super) fn integer_t(triangle: &Triangle, ray: &Ray) -> f64 {
    IntegerVolumes::<ANY_LIMBS>::new(triangle, ray).t()
}

/// The correctly rounded weights, likewise.
#[cfg(test)]
pub(super) fn integer_weights(triangle: &Triangle, ray: &Ray) -> Option<[f64; 3]> {
    let volumes = IntegerVolumes::<ANY_LIMBS>::new(triangle, ray);
    verdict(volumes.signs())?.is_hit().then(|| volumes.weights())
}

#[cfg(test)]
mod tests {
    use fearless_simd::Fallback;
    use oracle::Random;

    use super::super::filter::{again, filter};
    use super::super::finish::Refined;
    use super::*;
    use crate::ray::FilterVerdict;

    /// A triangle and a ray aimed at the place with these weights of the second and third vertex.
    fn case(rng: &mut Random, v: f64, w: f64) -> (Triangle, Ray) {
        let [a, b, c] = [rng.point(), rng.point(), rng.point()];
        let origin = 5.0 * rng.point();
        let direction = a + v * (b - a) + w * (c - a) - origin;
        (Triangle::new(a, b, c).unwrap(), Ray::new(origin, direction).unwrap())
    }

    /// How many verdicts each stage has reached, and how many `t` and weights.
    #[derive(Debug, Default)]
    struct Stages {
        filter: usize,
        fixed: usize,
        fixed_twice: usize,
        double_double: usize,
        integers: usize,
        rounded: usize,
        not_rounded: usize,
        narrow: usize,
    }

    impl Stages {
        fn count(&mut self, triangle: &Triangle, ray: &Ray) {
            let exact = IntegerVolumes::<ANY_LIMBS>::new(triangle, ray);
            let expected = verdict(exact.signs()).unwrap_or(Verdict::Parallel);
            match filter::<false>(triangle, ray) {
                FilterVerdict::Misses => {
                    self.filter += 1;
                    assert!(!expected.is_hit(), "{triangle:?} {ray:?}");
                }
                FilterVerdict::Crosses(crossing) => {
                    self.filter += 1;
                    assert_eq!(expected, Verdict::Interior, "{triangle:?} {ray:?}");
                    let refined =
                        Refined::new::<false, _>(Fallback::new(), &crossing, triangle, ray, crossing.solution());
                    let rounded = match (refined.t::<false>(), refined.weights::<false>()) {
                        (Some(t), Some(weights)) => (Some(t), Some(weights)),
                        _ => again(triangle, ray),
                    };
                    if let (Some(t), Some(weights)) = rounded {
                        self.rounded += 1;
                        assert_eq!(t, integer_t(triangle, ray), "{triangle:?} {ray:?}");
                        assert_eq!(Some(weights), integer_weights(triangle, ray), "{triangle:?} {ray:?}");
                    } else {
                        self.not_rounded += 1;
                    }
                }
                FilterVerdict::Unsure => {
                    let signs = if let Some(fixed) = FixedVolumes::<1, 2, 3>::new(triangle, ray) {
                        self.fixed += 1;
                        fixed.signs().map(Ordering::reverse)
                    } else if let Some(fixed) = FixedVolumes::<2, 4, 6>::new(triangle, ray) {
                        self.fixed_twice += 1;
                        fixed.signs().map(Ordering::reverse)
                    } else if let Some(signs) = double_double_signs(triangle, ray) {
                        self.double_double += 1;
                        signs
                    } else {
                        self.integers += 1;
                        return;
                    };
                    assert_eq!(signs, exact.signs(), "{triangle:?} {ray:?}");
                    if let Some(signs) = double_double_signs(triangle, ray) {
                        assert_eq!(signs, exact.signs(), "{triangle:?} {ray:?}");
                    }
                    if let Some(fixed) = FixedVolumes::<1, 2, 3>::new(triangle, ray) {
                        let turned = fixed.turned_signs().map(Ordering::reverse);
                        assert_eq!(turned, exact.turned_signs(), "{triangle:?} {ray:?}");
                        assert_eq!(fixed.height_sign().reverse(), exact.height_sign(), "{triangle:?} {ray:?}");
                    }
                }
            }
            if volume_bits(triangle, ray) <= NARROW {
                let narrow = IntegerVolumes::<NARROW_LIMBS>::new(triangle, ray);
                assert_eq!(narrow.signs(), exact.signs(), "{triangle:?} {ray:?}");
                assert!(!expected.is_hit() || narrow.t() == exact.t() && narrow.weights() == exact.weights());
                self.narrow += 1;
            }
            // What the exact stages give is what integers of any size give.
            let hit = expected.is_hit();
            let everywhere = f64::NEG_INFINITY..f64::INFINITY;
            let t = hit.then(|| integer_t(triangle, ray));
            let same = |found: Option<f64>| found.map(f64::to_bits) == t.map(f64::to_bits);
            assert!(same(closest(triangle, ray, everywhere.clone())), "{triangle:?} {ray:?}");
            if let Some(t) = t {
                assert_eq!(crossing_t(triangle, ray).to_bits(), t.to_bits(), "{triangle:?} {ray:?}");
            }
            let weights = integer_weights(triangle, ray);
            assert_eq!(exact_weights(triangle, ray), weights, "{triangle:?} {ray:?}");
            assert_eq!(closest_with_weights(triangle, ray, everywhere), t.zip(weights), "{triangle:?} {ray:?}");
        }
    }

    #[test]
    fn benign_rays_never_leave_the_first_stages() {
        let (mut stages, rng) = (Stages::default(), &mut Random::new(1));
        for _ in 0..4096 {
            let (v, w) = (0.5 * rng.uniform() + 0.4, 0.5 * rng.uniform() + 0.4);
            let (triangle, ray) = case(rng, v, w);
            stages.count(&triangle, &ray);
        }
        assert_eq!((stages.filter, stages.not_rounded), (4096, 0), "{stages:?}");
        assert!(stages.rounded > 1000, "{stages:?}");
    }

    #[test]
    fn every_stage_decides_hard_cases() {
        let (mut stages, rng) = (Stages::default(), &mut Random::new(2));
        for i in 0..4096 {
            // Within less and less of an edge, with numbers in a window of one limb, of two, and in none.
            let (v, w) = (rng.uniform(), 2f64.powi(-(i % 60)) * rng.uniform());
            let [mut a, b, c] = [rng.point(), rng.point(), rng.point()];
            a.z *= [1.0, 1.0, 2f64.powi(-40), 2f64.powi(-200)][i as usize % 4];
            let origin = 5.0 * rng.point();
            let direction = a + v * (b - a) + w * (c - a) - origin;
            stages.count(&Triangle::new(a, b, c).unwrap(), &Ray::new(origin, direction).unwrap());
        }
        for k in 0..64 {
            // exactly through an edge
            let triangle = Triangle::new(DVec3::ZERO, DVec3::X, DVec3::Y).unwrap();
            let origin = DVec3::new(f64::from(k) / 64.0, 0.0, 1.0);
            stages.count(&triangle, &Ray::new(origin, DVec3::NEG_Z).unwrap());
            // The same in a plane that no window holds together with the origin.
            let [a, b, c] = triangle.vertices.map(|vertex| vertex + DVec3::new(0.0, 0.0, 2f64.powi(-300)));
            stages.count(&Triangle::new(a, b, c).unwrap(), &Ray::new(origin, DVec3::NEG_Z).unwrap());
            // As many bits as integers that are not of the largest size hold, or nearly.
            let [a, b, c] = triangle.vertices.map(|vertex| vertex + DVec3::new(0.0, 0.0, 1.1 * 2f64.powi(-370)));
            stages.count(&Triangle::new(a, b, c).unwrap(), &Ray::new(origin, DVec3::new(1e-110, 0.0, -1.0)).unwrap());
            // t is halfway between two doubles
            let origin = DVec3::new(0.25, 0.25, 1.0 + f64::from(k) * f64::EPSILON);
            let plane = -(f64::EPSILON / 2.0);
            let [a, b, c] = triangle.vertices.map(|vertex| vertex + DVec3::new(0.0, 0.0, plane));
            stages.count(&Triangle::new(a, b, c).unwrap(), &Ray::new(origin, DVec3::NEG_Z).unwrap());
        }
        let Stages { filter, fixed, fixed_twice, double_double, integers, rounded, not_rounded, narrow } = stages;
        let all = [filter, fixed, fixed_twice, double_double, integers, rounded, not_rounded, narrow];
        assert!(all.iter().all(|&n| n >= 60), "{stages:?}");
    }
}
