//! The report's inside test: a point is inside where it lies on the same side of all three edges.
//!
//! With `n = (b - a) x (c - a)`, the turns `n . (to - from) x (point - from)` over the three edges are the
//! barycentric weights of the point's orthogonal projection into the plane, times `n . n`. Plain doubles, then
//! double-double, then integers give their signs; the weights themselves are correctly rounded quotients.

use std::cmp::Ordering;

use glam::DVec3;
use rt_math::exact::vector::{cross, difference, dot, minus};
use rt_math::exact::{DoubleDouble, Dyadic, Fixed, U, Window, bits_spanned, power_of_two, round_if_certain};
use rt_math::fma_dispatch;

use crate::Triangle;
use crate::ray::{larger, max_abs};

/// Swallows all errors of underflow: `2^-500` (`docs/numerics.md`, section 7).
const UNDERFLOW: f64 = power_of_two(-500);

/// Swallows what underflow does to a weight: `2^-1000`.
const UNDERFLOW_WEIGHT: f64 = power_of_two(-1000);

/// Up to here in magnitude the differences of points may be for plain doubles and double-double: `2^200`.
const FARTHEST: f64 = power_of_two(200);

/// Where a point, projected orthogonally into a triangle's plane, lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointInTriangle {
    /// In the interior.
    Interior,
    /// In an edge, not at its ends.
    Edge,
    /// At a vertex.
    Vertex,
    /// Outside; also every point if the triangle is degenerate.
    Outside,
}

/// Returns where a point lies, judged by its orthogonal projection into the triangle's plane, exactly.
///
/// With `n = (b - a) x (c - a)` the point is inside where none of `n . (to - from) x (point - from)` over the three
/// edges is negative. A degenerate triangle contains nothing, and a point that is not finite lies outside. Whether the
/// point lies in the plane is another question: [`Triangle::is_coplanar`].
///
/// ```
/// use glam::DVec3;
/// use rt_geom::{PointInTriangle, Triangle, inside_triangle};
///
/// let triangle = Triangle::new(DVec3::ZERO, DVec3::X, DVec3::Y).unwrap();
/// assert_eq!(inside_triangle(DVec3::new(0.25, 0.25, 7.0), &triangle), PointInTriangle::Interior);
/// assert_eq!(inside_triangle(DVec3::new(0.5, 0.5, 0.0), &triangle), PointInTriangle::Edge);
/// assert_eq!(inside_triangle(DVec3::Y, &triangle), PointInTriangle::Vertex);
/// assert_eq!(inside_triangle(DVec3::ONE, &triangle), PointInTriangle::Outside);
/// ```
#[must_use]
pub fn inside_triangle(point: impl Into<DVec3>, triangle: &Triangle) -> PointInTriangle {
    let point = point.into();
    if !point.is_finite() {
        return PointInTriangle::Outside;
    }
    let turns = filtered_signs(point, triangle).unwrap_or_else(|| exact_signs(point, triangle));
    if turns.contains(&Ordering::Less) {
        return PointInTriangle::Outside;
    }
    match turns.iter().filter(|&&turn| turn == Ordering::Equal).count() {
        0 => PointInTriangle::Interior,
        1 => PointInTriangle::Edge,
        2 => PointInTriangle::Vertex,
        // The turns add up to n . n, so the triangle is degenerate.
        _ => PointInTriangle::Outside,
    }
}

impl Triangle {
    /// Returns the weights of the three vertices at the orthogonal projection of a point into the plane, each correctly
    /// rounded, or `None` if the triangle is degenerate or the point not finite.
    ///
    /// A weight is negative beyond the edge opposite its vertex; none is negative inside. Their sum is 1 but for the
    /// rounding of each.
    ///
    /// ```
    /// use glam::DVec3;
    /// use rt_geom::Triangle;
    ///
    /// let triangle = Triangle::new(DVec3::ZERO, DVec3::X, DVec3::Y).unwrap();
    /// assert_eq!(triangle.barycentric(DVec3::new(0.25, 0.5, 9.0)), Some([0.25, 0.25, 0.5]));
    /// ```
    #[must_use]
    pub fn barycentric(&self, point: impl Into<DVec3>) -> Option<[f64; 3]> {
        let point = point.into();
        if !point.is_finite() || self.is_degenerate() {
            return None;
        }
        Some(exact_weights(point, self))
    }

    /// Whether a point and the three vertices lie in one plane, exactly; false if the point is not finite.
    ///
    /// Any point is coplanar with a degenerate triangle.
    #[must_use]
    pub fn is_coplanar(&self, point: impl Into<DVec3>) -> bool {
        let point = point.into();
        point.is_finite() && coplanar(point, self)
    }
}

impl Triangle {
    /// Whether a point lies in the closed triangle, exactly: in its plane, and not outside of it.
    ///
    /// A triangle without area holds nothing, and a point that is not finite lies nowhere.
    ///
    /// ```
    /// use glam::DVec3;
    /// use rt_geom::Triangle;
    ///
    /// let triangle = Triangle::new(DVec3::ZERO, DVec3::X, DVec3::Y).unwrap();
    /// assert!(triangle.holds(DVec3::new(0.5, 0.5, 0.0)) && !triangle.holds(DVec3::new(0.5, 0.5, 1e-300)));
    /// ```
    #[must_use]
    pub fn holds(&self, point: impl Into<DVec3>) -> bool {
        let point = point.into();
        let [a, b, c] = self.vertices();
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let near = point.cmpge(low).all() && point.cmple(high).all();
        near && self.is_coplanar(point) && inside_triangle(point, self) != PointInTriangle::Outside
    }
}

/// The largest component among the edges, and among those of the point's differences from the vertices.
fn sizes(point: DVec3, triangle: &Triangle) -> (f64, f64) {
    let [a, b, c] = triangle.vertices();
    let most = |x: DVec3, y: DVec3, z: DVec3| larger(max_abs(x), larger(max_abs(y), max_abs(z)));
    (most(b - a, c - b, a - c), most(point - a, point - b, point - c))
}

/// The signs of the turns around the vertices' opposite edges, if plain doubles are sure of all.
fn filtered_signs(point: DVec3, triangle: &Triangle) -> Option<[Ordering; 3]> {
    let [a, b, c] = triangle.vertices();
    // Modelled in docs/proofs/Locate.v: tn, tturn, terror.
    let n = (b - a).cross(c - a);
    let turn = |from: DVec3, to: DVec3| n.dot((to - from).cross(point - from));
    let (edge, far) = sizes(point, triangle);
    let error = 136.0 * U * (edge * edge * edge) * far + UNDERFLOW;
    certain_signs([turn(b, c), turn(c, a), turn(a, b)], error, edge, far)
}

fn certain_signs(turns: [f64; 3], error: f64, edge: f64, far: f64) -> Option<[Ordering; 3]> {
    let certain = edge < FARTHEST && far < FARTHEST && turns.iter().all(|turn| turn.abs() > error);
    certain.then(|| turns.map(|turn| turn.total_cmp(&0.0)))
}

/// The turns and `n . n`, each within `640 u² edge³ far` and `640 u² edge⁴` (and underflow).
#[inline(always)]
fn double_double_turns<const FMA: bool>(
    point: DVec3,
    triangle: &Triangle,
) -> ([DoubleDouble<FMA>; 3], DoubleDouble<FMA>) {
    let [a, b, c] = triangle.vertices();
    let n = cross(&difference::<DoubleDouble<FMA>>(b, a), &difference(c, a));
    let turn = |from, to| dot(&n, &cross(&difference::<DoubleDouble<FMA>>(to, from), &difference(point, from)));
    ([turn(b, c), turn(c, a), turn(a, b)], dot(&n, &n))
}

/// The signs of the turns; slow path, always decides.
#[cold]
#[inline(never)]
fn exact_signs(point: DVec3, triangle: &Triangle) -> [Ordering; 3] {
    if let Some(turns) = FixedTurns::<4>::new::<1, 2>(point, triangle) {
        turns.signs()
    } else if let Some(turns) = FixedTurns::<8>::new::<2, 4>(point, triangle) {
        turns.signs()
    } else {
        double_double_signs(point, triangle).unwrap_or_else(|| integer_signs(point, triangle))
    }
}

/// The weights, correctly rounded, of a triangle that has area: in fixed-point numbers first, which cost less than
/// double-double.
fn exact_weights(point: DVec3, triangle: &Triangle) -> [f64; 3] {
    match FixedTurns::<4>::new::<1, 2>(point, triangle) {
        Some(turns) => turns.weights(),
        None => double_double_weights(point, triangle).unwrap_or_else(|| wider_weights(point, triangle)),
    }
}

/// The weights where no window of one limb holds the points, nor double-double is certain; always decides.
#[cold]
#[inline(never)]
fn wider_weights(point: DVec3, triangle: &Triangle) -> [f64; 3] {
    if let Some(turns) = FixedTurns::<8>::new::<2, 4>(point, triangle) {
        turns.weights()
    } else {
        integer_weights(point, triangle)
    }
}

/// The turns and `n . n` in fixed-point numbers, where all points lie in one window: coordinates of `N` limbs, dot
/// products of `S = 2 N`, turns of `Q = 4 N`.
///
/// With the edges `e = b - a` and `f = c - a` and `q = point - a`, Lagrange's identity gives the turns as minors of the
/// dot products: `(f.f) (e.q) - (e.f) (f.q)` for the vertex `b`, `(e.e) (f.q) - (e.f) (e.q)` for `c`, and
/// `(e.e) (f.f) - (e.f)²` for their sum.
struct FixedTurns<const Q: usize> {
    turns: [Fixed<Q>; 3],
    sum: Fixed<Q>,
}

impl<const Q: usize> FixedTurns<Q> {
    #[inline(always)]
    fn new<const N: usize, const S: usize>(point: DVec3, triangle: &Triangle) -> Option<Self> {
        let [a, b, c] = triangle.vertices();
        let (window, p) = (Window::<N>::around(&coordinates(point, triangle))?, point);
        let a = window.vector(a);
        let (e, f, q) = (minus(&window.vector(b), &a), minus(&window.vector(c), &a), minus(&window.vector(p), &a));
        let [ee, ef, ff]: [Fixed<S>; 3] = [dot(&e, &e), dot(&e, &f), dot(&f, &f)];
        let [eq, fq]: [Fixed<S>; 2] = [dot(&e, &q), dot(&f, &q)];
        let minor =
            |a: &Fixed<S>, d: &Fixed<S>, b: &Fixed<S>, c: &Fixed<S>| Fixed::<Q>::product(a, d) - Fixed::product(b, c);
        let (sum, b, c) = (minor(&ee, &ff, &ef, &ef), minor(&ff, &eq, &ef, &fq), minor(&ee, &fq, &ef, &eq));
        Some(Self { turns: [sum - b - c, b, c], sum })
    }

    fn signs(&self) -> [Ordering; 3] {
        [self.turns[0].sign(), self.turns[1].sign(), self.turns[2].sign()]
    }

    fn weights(&self) -> [f64; 3] {
        let weight = |turn: &Fixed<Q>| Fixed::quotient(turn, &self.sum, 0);
        [weight(&self.turns[0]), weight(&self.turns[1]), weight(&self.turns[2])]
    }
}

/// The coordinates of the vertices and the point.
#[inline(always)]
fn coordinates(p: DVec3, triangle: &Triangle) -> [f64; 12] {
    let [a, b, c] = triangle.vertices();
    [a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, p.x, p.y, p.z]
}

#[cold]
fn double_double_signs(point: DVec3, triangle: &Triangle) -> Option<[Ordering; 3]> {
    let (turns, _) = double_double_turns::<false>(point, triangle);
    let (edge, far) = sizes(point, triangle);
    let error = 640.0 * U * U * (edge * edge * edge) * far + UNDERFLOW;
    certain_signs(turns.map(DoubleDouble::high), error, edge, far)
}

fma_dispatch! {
    /// The weights, correctly rounded, if double-double is certain of all.
    fn double_double_weights(point: DVec3, triangle: &Triangle) -> Option<[f64; 3]> = double_double_weights_kernel;
}

#[inline(always)]
fn double_double_weights_kernel<const FMA: bool>(point: DVec3, triangle: &Triangle) -> Option<[f64; 3]> {
    let (edge, far) = sizes(point, triangle);
    if !(edge < FARTHEST && far < FARTHEST) {
        return None;
    }
    let (turns, square) = double_double_turns::<FMA>(point, triangle);
    let relative = 640.0 * U * U * (edge * edge * edge);
    let (turn_error, square_error) = (relative * far + UNDERFLOW, relative * edge + UNDERFLOW);
    if 8.0 * square_error > square.high() {
        return None;
    }
    let weight = |turn: DoubleDouble<FMA>| {
        let quotient = turn / square;
        let size = quotient.high().abs();
        let error = 1.2 * (turn_error + size * square_error) / square.high();
        round_if_certain(quotient.high(), quotient.low(), error + 32.0 * U * U * size + UNDERFLOW_WEIGHT)
    };
    Some([weight(turns[0])?, weight(turns[1])?, weight(turns[2])?])
}

/// Limbs for the turns of points that span at most [`NARROW`] bits with them.
const NARROW_LIMBS: usize = 24;
const NARROW: i32 = 64 * 20;
/// ... and of any; each with two for the ends and two for a quotient: multiples of 2^-4296 below 2^4105 take 134.
const ANY_LIMBS: usize = 136;

/// The bits that a turn and `n . n` span at most: twelve products of four differences.
fn turn_bits(point: DVec3, triangle: &Triangle) -> i32 {
    4 * (bits_spanned(&coordinates(point, triangle)) + 1) + 4
}

type Turns<const LIMBS: usize> = [Dyadic<LIMBS>; 3];

/// The turns, and `n`.
fn integer_turns<const LIMBS: usize>(point: DVec3, triangle: &Triangle) -> (Turns<LIMBS>, Turns<LIMBS>) {
    let [a, b, c] = triangle.vertices();
    let n = cross(&difference::<Dyadic<LIMBS>>(b, a), &difference(c, a));
    let turn = |from, to| dot(&n, &cross(&difference::<Dyadic<LIMBS>>(to, from), &difference(point, from)));
    ([turn(b, c), turn(c, a), turn(a, b)], n)
}

#[cold]
#[inline(never)]
fn integer_signs(point: DVec3, triangle: &Triangle) -> [Ordering; 3] {
    if turn_bits(point, triangle) <= NARROW {
        sized_signs::<NARROW_LIMBS>(point, triangle)
    } else {
        sized_signs::<ANY_LIMBS>(point, triangle)
    }
}

#[inline(never)]
fn sized_signs<const LIMBS: usize>(point: DVec3, triangle: &Triangle) -> [Ordering; 3] {
    integer_turns::<LIMBS>(point, triangle).0.map(|turn| turn.sign())
}

#[cold]
#[inline(never)]
fn integer_weights(point: DVec3, triangle: &Triangle) -> [f64; 3] {
    if turn_bits(point, triangle) <= NARROW {
        sized_weights::<NARROW_LIMBS>(point, triangle)
    } else {
        sized_weights::<ANY_LIMBS>(point, triangle)
    }
}

#[inline(never)]
fn sized_weights<const LIMBS: usize>(point: DVec3, triangle: &Triangle) -> [f64; 3] {
    let (turns, n) = integer_turns::<LIMBS>(point, triangle);
    let square = dot(&n, &n);
    turns.map(|turn| Dyadic::quotient(&turn, &square))
}

/// The sign of the volume that the point spans with the triangle, compared with zero.
fn coplanar(point: DVec3, triangle: &Triangle) -> bool {
    let [a, b, c] = triangle.vertices();
    // Modelled in docs/proofs/Locate.v: tvolume, tvolume_error.
    let volume = (b - a).cross(c - a).dot(point - a);
    let (edge, far) = sizes(point, triangle);
    // Eight roundings per term, six terms.
    let error = 64.0 * U * (edge * edge) * far + UNDERFLOW;
    let off = edge < FARTHEST && far < FARTHEST && volume.abs() > error;
    !off && exact_coplanar(point, triangle)
}

#[cold]
#[inline(never)]
fn exact_coplanar(point: DVec3, triangle: &Triangle) -> bool {
    fixed_coplanar::<1, 2, 3>(point, triangle)
        .or_else(|| fixed_coplanar::<2, 4, 6>(point, triangle))
        .unwrap_or_else(|| integer_coplanar(point, triangle))
}

fn fixed_coplanar<const N: usize, const A: usize, const V: usize>(point: DVec3, triangle: &Triangle) -> Option<bool> {
    let [a, b, c] = triangle.vertices();
    let (window, p) = (Window::<N>::around(&coordinates(point, triangle))?, point);
    let a = window.vector(a);
    let (e, f, q) = (minus(&window.vector(b), &a), minus(&window.vector(c), &a), minus(&window.vector(p), &a));
    let n: [Fixed<A>; 3] = cross(&e, &f);
    let volume: Fixed<V> = dot(&n, &q);
    Some(volume.sign() == Ordering::Equal)
}

#[cold]
#[inline(never)]
fn integer_coplanar(point: DVec3, triangle: &Triangle) -> bool {
    let [a, b, c] = triangle.vertices();
    let n = cross(&difference::<Dyadic<ANY_LIMBS>>(b, a), &difference(c, a));
    dot(&n, &difference(point, a)).sign() == Ordering::Equal
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_stage_decides() {
        let (mut counts, mut narrow) = ([0; 3], 0);
        for k in 0..300 {
            let s = f64::from(k) / 300.0;
            let triangle =
                Triangle::new(DVec3::new(0.1, 0.2, 0.3), DVec3::new(1.1, -0.3, 0.7), DVec3::new(0.4, 0.9, -0.2));
            let triangle = triangle.unwrap();
            let [a, b, c] = triangle.vertices();
            // interior; on an edge but for rounding; a vertex
            for point in [a + 0.3 * (b - a) + 0.5 * s * (c - a), a + s * (b - a), b] {
                let exact = sized_signs::<ANY_LIMBS>(point, &triangle);
                assert_eq!(integer_signs(point, &triangle), exact, "{point:?}");
                let weights = sized_weights::<ANY_LIMBS>(point, &triangle);
                assert_eq!(integer_weights(point, &triangle), weights, "{point:?}");
                assert_eq!(triangle.barycentric(point), Some(weights), "{point:?}");
                if let Some(double_double) = double_double_weights(point, &triangle) {
                    assert_eq!(double_double, weights, "{point:?}");
                }
                assert_eq!(exact_signs(point, &triangle), exact, "{point:?}");
                let fixed = FixedTurns::<8>::new::<2, 4>(point, &triangle).expect("a window of two limbs");
                assert_eq!(fixed.signs(), exact, "{point:?}");
                assert_eq!(fixed.weights(), integer_weights(point, &triangle), "{point:?}");
                if let Some(fixed) = FixedTurns::<4>::new::<1, 2>(point, &triangle) {
                    narrow += 1;
                    assert_eq!(fixed.signs(), exact, "{point:?}");
                    assert_eq!(fixed.weights(), integer_weights(point, &triangle), "{point:?}");
                }
                let coplanar = integer_coplanar(point, &triangle);
                assert_eq!(fixed_coplanar::<2, 4, 6>(point, &triangle), Some(coplanar), "{point:?}");
                assert!(fixed_coplanar::<1, 2, 3>(point, &triangle).is_none_or(|fixed| fixed == coplanar));
                if let Some(signs) = filtered_signs(point, &triangle) {
                    counts[0] += 1;
                    assert_eq!(signs, exact, "{point:?}");
                } else if let Some(signs) = double_double_signs(point, &triangle) {
                    counts[1] += 1;
                    assert_eq!(signs, exact, "{point:?}");
                } else {
                    counts[2] += 1;
                }
            }
        }
        assert!(counts[0] > 200 && counts[1] > 200 && counts[2] >= 300 && narrow > 300, "{counts:?} {narrow}");
    }
}
