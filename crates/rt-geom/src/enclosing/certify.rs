//! From an approximate answer to one that is proved: the center rounded to doubles, the radius rounded up so that
//! everything lies inside in exact arithmetic, and a lower bound for the radius of any enclosing sphere.
//!
//! Reaches are computed in double-double arithmetic, four spheres side by side. `docs/numerics.md`, section 8, proves
//! every bound used here.

use fearless_simd::{Simd, f64x4, f64x8, prelude::*};
use glam::DVec3;
use rt_math::exact::vector::{difference, dot};
use rt_math::exact::{DoubleDouble, U, power_of_two, two_diff, two_prod, two_sum};
use rt_math::fma_dispatch;

use super::exact::{contains_exactly, smallest_radius};
use super::tangent::{ORDINARY, Tangent};
use crate::Sphere;
use crate::simd::{self as lanes, has_fma};

/// Relative error bound of a reach computed in double-double arithmetic (proved: 75 u² at most).
const REACH_ERROR: f64 = 128.0 * U * U;

/// A center, and the radius around it that is proved to enclose some spheres, between two doubles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bracket {
    pub(super) center: DVec3,
    /// No smaller double encloses them.
    pub(super) low: f64,
    /// This double encloses them.
    pub(super) high: f64,
}

/// `a b` and its rounding error, exactly, lane by lane.
#[inline(always)]
fn two_product<S: Simd>(simd: S, a: f64x4<S>, b: f64x4<S>) -> (f64x4<S>, f64x4<S>) {
    if has_fma(simd) { lanes::two_prod::<true, _, _>(a, b) } else { lanes::two_prod::<false, _, _>(a, b) }
}

/// How far four spheres reach from a center.
#[derive(Clone, Copy)]
struct Reach<S: Simd> {
    /// The center less those of the spheres, rounded.
    offset: [f64x4<S>; 3],
    /// The length of the offset, rounded.
    distance: f64x4<S>,
    /// Its inverse, rounded.
    inverse: f64x4<S>,
    /// The reach is `high + low`, up to `error`; `high` is the sum rounded.
    high: f64x4<S>,
    low: f64x4<S>,
    error: f64x4<S>,
}

/// Along one axis: the offset of the center from the spheres', rounded; its square, and the rest of the square.
#[inline(always)]
fn axis<S: Simd>(simd: S, from: f64, to: [f64; 4]) -> (f64x4<S>, f64x4<S>, f64x4<S>) {
    let (high, low) = two_diff(f64x4::splat(simd, from), f64x4::simd_from(simd, to));
    let (square, error) = two_product(simd, high, high);
    (high, square, error + (high + high) * low)
}

#[inline(always)]
fn reach<S: Simd>(simd: S, spheres: [&Sphere; 4], center: DVec3) -> Reach<S> {
    let (dx, x, x_error) = axis(simd, center.x, spheres.map(|sphere| sphere.center().x));
    let (dy, y, y_error) = axis(simd, center.y, spheres.map(|sphere| sphere.center().y));
    let (dz, z, z_error) = axis(simd, center.z, spheres.map(|sphere| sphere.center().z));
    let radius = f64x4::simd_from(simd, spheres.map(Sphere::radius));
    let (sum, sum_error) = two_sum(x, y);
    let (square, square_error) = two_sum(sum, z);
    let tail = (x_error + y_error) + (z_error + (sum_error + square_error));
    let root = square.sqrt();
    let (again, again_error) = two_product(simd, root, root);
    let inverse = f64x4::splat(simd, 1.0) / root;
    let rest = (((square - again) - again_error) + tail) * (inverse * 0.5);
    // At the very center the root is zero, and the product not a number.
    let zero = f64x4::splat(simd, 0.0);
    let rest = root.simd_eq(zero).select(zero, rest);
    let (high, low) = two_sum(root, radius);
    let low = low + rest;
    let sum = high + low;
    let low = low - (sum - high);
    let same = (dx.abs() + dy.abs() + dz.abs()).simd_eq(zero);
    let error = same.select(zero, sum * REACH_ERROR);
    Reach { offset: [dx, dy, dz], distance: root, inverse, high: sum, low, error }
}

/// The double after a positive normal one, lane by lane (S. Rump, P. Zimmermann, S. Boldo, G. Melquiond, "Computing
/// predecessor and successor in rounding to nearest", 2009).
#[inline(always)]
fn next_up<S: Simd>(a: f64x4<S>) -> f64x4<S> {
    a + a * SPACING
}

/// A number times this, added to or taken from the number, gives the double after or before it, if it is normal.
const SPACING: f64 = U * (1.0 + 2.0 * U);

/// The smallest double that is not below `high + low`, for `high` positive and normal and the larger by far.
#[inline(always)]
fn round_up<S: Simd>(simd: S, high: f64x4<S>, low: f64x4<S>) -> f64 {
    let sum = high + low;
    let rest = low - (sum - high);
    let up = rest.simd_gt(f64x4::splat(simd, 0.0)).select(next_up(sum), sum);
    up.reduce_max()
}

/// The smallest double that is not below `high + low`, for `high` the larger by far.
#[inline(always)]
fn sum_up(high: f64, low: f64) -> f64 {
    let sum = high + low;
    if low - (sum - high) > 0.0 { sum.next_up() } else { sum }
}

/// Moves the center of `tangent` to the doubles nearest to the true center, and brackets the radius there.
///
/// Returns the bracket, and a lower bound for the radius of any sphere that encloses the spheres of `tangent`.
#[inline(never)]
pub(super) fn certify<S: Simd>(simd: S, tangent: &Tangent<f64>, all: &[Sphere]) -> (Bracket, f64) {
    simd.vectorize(
        #[inline(always)]
        || {
            let first = &all[tangent.support()[0]];
            if tangent.support().len() == 1 {
                let radius = first.radius();
                return (Bracket { center: first.center(), low: radius, high: radius }, radius);
            }
            let [_, b, c, d] = tangent.padded();
            let spheres = [first, &all[b], &all[c], &all[d]];
            let far = first.center().abs().max_element() > FAR * (tangent.rho + first.radius());
            if !far {
                let (bracket, bound, clear) = certify_in_place(simd, tangent, spheres);
                if clear {
                    return (bracket, bound);
                }
            }
            certify_apart(simd, tangent, spheres)
        },
    )
}

/// Beyond so many radii from the origin the rounding of the center moves it too far for the lower bound to be sharp.
const FAR: f64 = power_of_two(20);

/// [`certify`] for spheres so far from the origin that doubles lie far apart there: the lower bound is found on a copy
/// near the origin, and of the doubles around the center the best is taken.
#[cold]
#[inline(never)]
fn certify_apart<S: Simd>(simd: S, tangent: &Tangent<f64>, spheres: [&Sphere; 4]) -> (Bracket, f64) {
    let origin = spheres[0].center();
    let mut lost = 0.0_f64;
    let moved = spheres.map(|sphere| {
        let to = sphere.center();
        let [x, y, z] = [0, 1, 2].map(|axis| two_diff(to[axis], origin[axis]));
        lost = lost.max(x.1.abs() + y.1.abs() + z.1.abs());
        Sphere::new(DVec3::new(x.0, y.0, z.0), sphere.radius()).expect("distances in an ordinary set are finite")
    });
    // (The center of the copy is less than its radius from the origin: it is not far, and no rounding is unclear.)
    let (bracket, bound) = certify(simd, &tangent.renumbered(), &moved);
    // Moving a center changes the radius by at most as much.
    let bound = if lost > 0.0 { (bound - lost * (1.0 + 8.0 * U)).next_down() } else { bound };
    let [x, y, z] = [0, 1, 2].map(|axis| two_sum(origin[axis], bracket.center[axis]));
    let (center, rest) = (DVec3::new(x.0, y.0, z.0), DVec3::new(x.1, y.1, z.1));
    let around = Bracket::around(simd, center, rest, spheres, tangent.support().len());
    (around, bound.max(spheres[0].radius()))
}

/// Brackets the radius around the doubles nearest to the center of `tangent`, whose spheres are given, the largest
/// first.
///
/// Returns the bracket, a lower bound, and whether the nearest doubles are clear.
#[inline(always)]
fn certify_in_place<S: Simd>(simd: S, tangent: &Tangent<f64>, spheres: [&Sphere; 4]) -> (Bracket, f64, bool) {
    let origin = spheres[0].center();
    let mut center = origin + DVec3::from(tangent.x);
    let mut rounds = 0;
    loop {
        let reach = reach(simd, spheres, center);
        let base = reach.high[0];
        let step = NewtonStep::new(simd, tangent, origin, center, &reach);
        rounds += 1;
        let good = step.error.reduce_max() <= base * NEGLIGIBLE;
        if !good && rounds < MAX_ROUNDS {
            center = step.to;
            continue;
        }
        // Where doubles lie far apart, of a center half-way between two both are to be tried.
        let coarse = step.to.abs().max_element() * U > 32.0 * U * base;
        let clear = !(coarse && half_way(step.to, step.rest));
        let step = if good { step } else { NewtonStep::none(simd, center, &reach) };
        let low = reach.low + step.along;
        let bracket = Bracket {
            center: step.to,
            low: round_up(simd, reach.high, low - step.error),
            high: round_up(simd, reach.high, low + step.error),
        };
        let bound = lower_bound(simd, tangent, &reach, &step, bracket.high);
        return (bracket, bound.max(spheres[0].radius()), clear);
    }
}

/// A step of Newton's iteration for the center from which all spheres reach equally far.
struct NewtonStep<S: Simd> {
    /// The next center.
    to: DVec3,
    /// What rounding took from it.
    rest: DVec3,
    /// From the last center to the next.
    by: DVec3,
    /// At least the length of that, and sooner known.
    length: f64,
    /// What the reaches grow by, and the error of the reaches then.
    along: f64x4<S>,
    error: f64x4<S>,
}

impl<S: Simd> NewtonStep<S> {
    #[inline(always)]
    fn new(simd: S, tangent: &Tangent<f64>, origin: DVec3, center: DVec3, reach: &Reach<S>) -> Self {
        let [k1, k2, k3] = tangent.dual;
        let (k1, k2, k3) = (DVec3::from(k1), DVec3::from(k2), DVec3::from(k3));
        let q = DVec3::from(tangent.q);
        // The reaches less the first one are the residuals.
        let residual = (reach.high - reach.high[0]) + (reach.low - reach.low[0]);
        let moved = residual * reach.distance;
        let a = k1 * moved[1] + k2 * moved[2] + k3 * moved[3];
        let x = center - origin;
        let wider = x.dot(a) * (1.0 / (reach.distance[0] - x.dot(q)));
        // The rounding of the center may have left the flat of the centers: go back too, by what the dual basis
        // leaves of the difference from the unrounded center.
        let [dx, dy, dz] = reach.offset;
        let lost = (center - origin) - DVec3::from(tangent.x);
        let seen = dx * lost.x + dy * lost.y + dz * lost.z;
        let inside = k1 * (seen[0] - seen[1]) + k2 * (seen[0] - seen[2]) + k3 * (seen[0] - seen[3]);
        let wish = a + q * wider - (lost - inside);
        let to = center + wish;
        let to = if to.is_finite() { to } else { center };
        let by = to - center;
        // The reaches at the next center: |v + e| is between |v| + u.e and that plus |e|² / 2|v|.
        let along = (dx * by.x + dy * by.y + dz * by.z) * reach.inverse;
        let length = by.abs().element_sum();
        let bend = reach.inverse * (length * length);
        let none = f64x4::splat(simd, 0.0);
        let still = f64x4::splat(simd, length).simd_eq(none);
        let along = still.select(none, along);
        let error = reach.error + still.select(none, bend + 16.0 * U * length);
        Self { to, rest: wish - by, by, length, along, error }
    }

    /// To stay where the reaches are known.
    #[inline(always)]
    fn none(simd: S, center: DVec3, reach: &Reach<S>) -> Self {
        let along = f64x4::splat(simd, 0.0);
        Self { to: center, rest: DVec3::ZERO, by: DVec3::ZERO, length: 0.0, along, error: reach.error }
    }
}

/// The lower bound, from weights that nearly balance the directions from the touching points to the center; `most` is
/// the radius around it.
#[inline(always)]
fn lower_bound<S: Simd>(simd: S, tangent: &Tangent<f64>, reach: &Reach<S>, step: &NewtonStep<S>, most: f64) -> f64 {
    let base = reach.high[0];
    let [dx, dy, dz] = reach.offset;
    let weight = f64x4::simd_from(simd, tangent.weight).max(f64x4::splat(simd, 0.0));
    let share = weight * reach.distance;
    let total = share.reduce_sum();
    let mean = (share * ((reach.high - base) + (reach.low + step.along))).reduce_sum() / total;
    let pull = (weight * (dx + step.by.x)).reduce_sum().abs()
        + (weight * (dy + step.by.y)).reduce_sum().abs()
        + (weight * (dz + step.by.z)).reduce_sum().abs();
    let nearest = reach.distance.reduce_min();
    let pull = pull / total + 16.0 * U + 2.0 * step.length / nearest;
    // What the mean errs by, and its own roundings: relative to it, since reaches that differ widen the gap.
    let doubt = 16.0 * U * mean.abs();
    let gap = (most - base) - mean + (2.0 * most * pull + doubt);
    let far = gap * (0.5 / BALANCE) + most * BALANCE;
    let slack = step.error.reduce_max() + pull * far + doubt;
    let below = mean - slack * (1.0 + 16.0 * U);
    let sum = base + below;
    sum - if below - (sum - base) < 0.0 { sum * SPACING } else { 0.0 }
}

/// Whether `rest`, what rounding took from `center`, is so close to half the spacing of doubles on some axis that its
/// own error could have changed the rounding.
#[cold]
fn half_way(center: DVec3, rest: DVec3) -> bool {
    let near = |center: f64, rest: f64| {
        let spacing = center.abs().next_up() - center.abs();
        rest.abs() > (0.5 - 1e-4) * spacing
    };
    near(center.x, rest.x) || near(center.y, rest.y) || near(center.z, rest.z)
}

/// An error of the reaches that is small beside a unit in the last place.
const NEGLIGIBLE: f64 = 1024.0 * U * U;

/// Newton's iteration converges quadratically from an approximation that is good to a few digits.
const MAX_ROUNDS: usize = 4;

/// Any positive number gives a true bound; this one a sharp bound if the gap is a few units in the last place.
const BALANCE: f64 = power_of_two(-26);

impl Bracket {
    /// Brackets the radius that encloses four spheres (of which only the first `count` differ) around one of the eight
    /// doubles next to `center + rest`: the one from which they reach least far, as far as doubles can tell.
    #[inline(never)]
    fn around<S: Simd>(simd: S, center: DVec3, rest: DVec3, spheres: [&Sphere; 4], count: usize) -> Self {
        simd.vectorize(
            #[inline(always)]
            || Self::around_here(simd, center, rest, spheres, count),
        )
    }

    #[inline(always)]
    fn around_here<S: Simd>(simd: S, center: DVec3, rest: DVec3, spheres: [&Sphere; 4], count: usize) -> Self {
        let nearest = f64x4::simd_from(simd, [center.x, center.y, center.z, 0.0]);
        let rest = f64x4::simd_from(simd, [rest.x, rest.y, rest.z, 0.0]);
        let other = nearest + (nearest.abs() * SPACING).copysign(rest);
        let other = rest.simd_eq(f64x4::splat(simd, 0.0)).select(nearest, other);
        let ([a, b, c, _], [d, e, f, _]): ([f64; 4], [f64; 4]) = (nearest.into(), other.into());
        let x = f64x8::simd_from(simd, [a, d, a, d, a, d, a, d]);
        let y = f64x8::simd_from(simd, [b, b, e, e, b, b, e, e]);
        let z = f64x8::simd_from(simd, [c, c, c, c, f, f, f, f]);
        let mut most = f64x8::splat(simd, 0.0);
        for sphere in &spheres[..count] {
            let to = sphere.center();
            let (dx, dy, dz) = (x - to.x, y - to.y, z - to.z);
            most = most.max((dx * dx + dy * dy + dz * dz).sqrt() + sphere.radius());
        }
        // (Which it is cannot be predicted: no branch.)
        let least = f64x8::splat(simd, most.reduce_min());
        let best = most.simd_le(least).to_bitmask().trailing_zeros();
        let pick = |bit: u32, nearest: f64, other: f64| if best >> bit & 1 == 1 { other } else { nearest };
        let center = DVec3::new(pick(0, a, d), pick(1, b, e), pick(2, c, f));
        let mut bracket = Self { center, low: 0.0, high: 0.0 };
        bracket.enclose_here(simd, spheres);
        bracket
    }

    /// Widens the bracket so that it holds for four more spheres (which may repeat).
    #[inline(never)]
    pub(super) fn enclose<S: Simd>(&mut self, simd: S, spheres: [&Sphere; 4]) {
        simd.vectorize(
            #[inline(always)]
            || self.enclose_here(simd, spheres),
        );
    }

    #[inline(always)]
    fn enclose_here<S: Simd>(&mut self, simd: S, spheres: [&Sphere; 4]) {
        let reach = reach(simd, spheres, self.center);
        self.low = self.low.max(round_up(simd, reach.high, reach.low - reach.error));
        self.high = self.high.max(round_up(simd, reach.high, reach.low + reach.error));
    }

    /// Widens the bracket so that it holds for all of `spheres`, or to `limit` at least.
    pub(super) fn enclose_all(&mut self, spheres: &[Sphere], limit: f64) {
        enclose_all(self, spheres, limit);
    }

    /// The smallest double of the bracket that encloses all spheres. Asks integers at most three questions a sphere.
    #[cold]
    #[inline(never)]
    pub(super) fn settle(&self, spheres: &[Sphere]) -> f64 {
        let mut radius = self.low;
        for sphere in spheres {
            let reach = (sphere.center() - self.center).length() + sphere.radius();
            if reach * (1.0 + 16.0 * U) <= radius {
                continue;
            }
            if radius < self.high && !contains_exactly(self.center, radius, sphere) {
                radius = smallest_radius(self.center, sphere);
            }
        }
        radius
    }
}

fma_dispatch! {
    #[cold]
    fn enclose_all(bracket: &mut Bracket, spheres: &[Sphere], limit: f64) = enclose_all_kernel;
}

#[inline(always)]
fn enclose_all_kernel<const FMA: bool>(bracket: &mut Bracket, spheres: &[Sphere], limit: f64) {
    for sphere in spheres {
        let rough = (sphere.center() - bracket.center).length() + sphere.radius();
        // A sphere that is inside by more than the error of this estimate changes nothing.
        if rough < bracket.low * (1.0 - 16.0 * U) {
            continue;
        }
        let from = difference::<DoubleDouble<FMA>>(sphere.center(), bracket.center);
        let reach = dot(&from, &from).sqrt() + DoubleDouble::new(sphere.radius());
        let error = if from == [DoubleDouble::ZERO; 3] { 0.0 } else { reach.high() * REACH_ERROR };
        bracket.low = bracket.low.max(sum_up(reach.high(), reach.low() - error));
        bracket.high = bracket.high.max(sum_up(reach.high(), reach.low() + error));
        if bracket.high >= limit {
            return;
        }
    }
}

/// The minimal sphere of two spheres, in closed form: the bracket, and a lower bound.
///
/// `None` if one lies inside the other or nearly so.
#[inline(always)]
pub(super) fn pair<S: Simd>(simd: S, a: &Sphere, b: &Sphere) -> Option<(Bracket, f64)> {
    if has_fma(simd) { pair_with::<S, true>(simd, a, b) } else { pair_with::<S, false>(simd, a, b) }
}

#[inline(always)]
fn pair_with<S: Simd, const FMA: bool>(simd: S, a: &Sphere, b: &Sphere) -> Option<(Bracket, f64)> {
    // The differences of the coordinates and, in the last lane, of the radii: exactly high + low.
    let row = |s: &Sphere| [s.center().x, s.center().y, s.center().z, s.radius()];
    let from = f64x4::simd_from(simd, row(a));
    let (p, p_low) = two_diff(f64x4::simd_from(simd, row(b)), from);
    let (square, error) = two_product(simd, p, p);
    let error = error + (p + p) * p_low;
    // Their distance, length + length_low.
    let (sum, sum_error) = two_sum(square[0], square[1]);
    let (sum, rest) = two_sum(sum, square[2]);
    let tail = (error[0] + error[1]) + (error[2] + (sum_error + rest));
    let length = sum.sqrt();
    let inverse = 1.0 / length;
    let (again, again_error) = two_prod::<FMA>(length, length);
    let length_low = (((sum - again) - again_error) + tail) * (0.5 * inverse);
    // The share of the way from a to b, (distance + difference of the radii) / 2 distance, as share + share_low.
    let share = 0.5 + (0.5 * p[3]) * inverse;
    let (half, half_low) = two_sum(0.5 * length, 0.5 * p[3]);
    let (part, part_low) = two_prod::<FMA>(share, length);
    let left = (half - part) + (half_low - part_low) + (0.5 * p_low[3] + length_low * (0.5 - share));
    let share_low = left * inverse;
    let nearest = length * share.min(1.0 - share);
    // The radius is half of distance + radii.
    let (radii, radii_low) = two_sum(a.radius(), b.radius());
    let (twice, twice_low) = two_sum(length, radii);
    let radius = 0.5 * twice;
    let radius_low = 0.5 * (twice_low + (radii_low + length_low));
    let apart = nearest > radius * NEARLY_INSIDE;
    if !apart || !ORDINARY.contains(&twice) {
        return None;
    }
    // The center, and by how much rounding it to doubles moved it.
    let (way, way_low) = two_product(simd, p, f64x4::splat(simd, share));
    let way_low = way_low + (p * share_low + p_low * share);
    let (c, c_low) = two_sum(from, way);
    let c_low = c_low + way_low;
    let center = c + c_low;
    let e = (center - c) - c_low;
    // |v + e| is between |v| + u.e and that plus |e|² / 2|v|, where u is the direction from one to the other.
    let along = e * p;
    let along = ((along[0] + along[1]) + along[2]).abs() * inverse;
    let away = (e[0].abs() + e[1].abs()) + e[2].abs();
    let size = (center[0].abs() + center[1].abs()) + center[2].abs();
    let bend = away * away / nearest;
    let error = radius * REACH_ERROR + bend + 16.0 * U * (away + U * size);
    let down = radius_low - radius * REACH_ERROR;
    let sum = radius + down;
    let bound = if down - (sum - radius) < 0.0 { sum.next_down() } else { sum };
    let place = |v: f64x4<S>| DVec3::new(v[0], v[1], v[2]);
    if error > radius * PAIR_ERROR {
        return Some((Bracket::around(simd, place(center), place(-e), [a, b, a, b], 2), bound));
    }
    let low = sum_up(radius, (radius_low + along) - error);
    let high = sum_up(radius, (radius_low + along) + error);
    Some((Bracket { center: place(center), low, high }, bound))
}

/// With a larger error of the radius, as a share of it, the reaches are computed anew at the center rounded to doubles.
/// (With a smaller one, hardly one radius in a thousand is so close to a double that exact integers are asked.)
const PAIR_ERROR: f64 = power_of_two(-64);

/// With the center closer than this to that of a sphere, as a share of the radius, the bend of the distance is not
/// small beside a unit in the last place.
const NEARLY_INSIDE: f64 = power_of_two(-20);

#[cfg(test)]
mod tests {
    use oracle::{Big, Random, exact, root, sub, vector};

    use super::super::refine::refine;
    use super::*;

    /// How far a sphere reaches from a point: a square root of 400 bits.
    fn reach_of(center: DVec3, sphere: &Sphere) -> Big {
        let [x, y, z] = sub(&vector(sphere.center()), &vector(center));
        root(&(&x * &x + &y * &y + &z * &z)) + exact(sphere.radius())
    }

    #[test]
    fn the_bracket_of_a_pair_holds_the_reach_and_the_bound_is_below_the_minimum() {
        let random = &mut Random::new(3);
        let mut sharp = 0;
        for round in 0..4_000 {
            let offset = random.point() * 2f64.powi(round % 40);
            let [a, b] = [(); 2].map(|()| Sphere::new(offset + random.point(), 0.5 * random.share()).unwrap());
            let Some((bracket, bound)) = pair(crate::simd::baseline(), &a, &b) else { continue };
            let [from_a, from_b] = [&a, &b].map(|sphere| reach_of(bracket.center, sphere));
            let reach = if from_a > from_b { from_a } else { from_b };
            assert!(exact(bracket.high) >= reach && exact(bracket.low.next_down()) < reach, "{a:?} {b:?} {bracket:?}");
            let minimum = (reach_of(a.center(), &b) + exact(a.radius())) / Big::from(2);
            let (_, _, cold) = refine(&[a, b], &[0]);
            assert!(exact(bound.max(cold)) <= minimum, "{a:?} {b:?}: {bound} or {cold} is no lower bound");
            sharp += usize::from(exact(bound.next_up().next_up()) > minimum);
        }
        assert!(sharp > 3_000, "{sharp}");
    }

    #[test]
    fn the_bracket_holds_the_reach_of_everything_and_settles_on_the_smallest_double() {
        let random = &mut Random::new(4);
        for _ in 0..500 {
            let spheres: Vec<Sphere> =
                (0..7).map(|_| Sphere::new(random.point(), 0.1 * random.share()).unwrap()).collect();
            let mut bracket = Bracket { center: 0.1 * random.point(), low: 0.0, high: 0.0 };
            bracket.enclose(crate::simd::baseline(), [0, 1, 2, 3].map(|i| &spheres[i]));
            bracket.enclose_all(&spheres[4..], f64::INFINITY);
            let reaches = spheres.iter().map(|sphere| reach_of(bracket.center, sphere));
            let most = reaches.reduce(|a, b| if a > b { a } else { b }).unwrap();
            let radius = bracket.settle(&spheres);
            assert!(bracket.low <= radius && radius <= bracket.high, "{bracket:?} {radius}");
            assert!(exact(radius) >= most && exact(radius.next_down()) < most, "{spheres:?} {radius}");
        }
    }

    #[test]
    fn a_reach_above_a_double_by_less_than_double_double_knows_is_enclosed() {
        let random = &mut Random::new(5);
        for _ in 0..100 {
            let (x, more) = (1.0 + random.share(), random.power(-120..-104));
            let sphere = Sphere::new(x * DVec3::X, 0.0).unwrap();
            let mut bracket = Bracket { center: -more * DVec3::X, low: 0.0, high: 0.0 };
            let mut lanes = bracket;
            bracket.enclose_all(&[sphere], f64::INFINITY);
            lanes.enclose(crate::simd::baseline(), [&sphere; 4]);
            assert_eq!([bracket.high, lanes.high], [x.next_up(); 2], "{x} and {more:e} more");
        }
    }
}
