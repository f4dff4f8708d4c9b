//! The cold path: the support found in double-double arithmetic, for sets that are degenerate in doubles.
//!
//! Same pivoting, but a sphere counts as sticking out when it does so by more than a few units of 2⁻¹⁰⁰, and the center
//! is known far beyond its rounding.

use glam::DVec3;
use rt_math::exact::vector::{difference, dot};
use rt_math::exact::{DoubleDouble, U};
use rt_math::fma_dispatch;

use super::certify::Bracket;
use super::tangent::{SolverNumber, Tangent, Wide};
use crate::Sphere;

/// Returns the support, a bracket around the center rounded to doubles, and a lower bound.
///
/// `start` is where to begin: places of spheres, at least one.
#[cold]
#[inline(never)]
pub(super) fn refine(spheres: &[Sphere], start: &[usize]) -> (Tangent<Wide>, Bracket, f64) {
    let mut tangent = Tangent::<Wide>::single(start[0]);
    for _ in 0..MAX_PIVOTS {
        // The farthest of a few first: the support of the fast path.
        let Some(far) = farthest(&tangent, spheres, start) else { break };
        tangent.add(far, spheres);
    }
    let mut stalled = 0;
    for _ in 0..MAX_PIVOTS {
        let Some(far) = farthest(&tangent, spheres, &[]) else { break };
        let radius = |tangent: &Tangent<Wide>| tangent.sphere(spheres, DVec3::ZERO).1;
        let before = radius(&tangent);
        tangent.add(far, spheres);
        stalled = if before.below(radius(&tangent)) { 0 } else { stalled + 1 };
        if stalled == 3 {
            break;
        }
    }
    let (center, _) = tangent.sphere(spheres, DVec3::ZERO);
    let mut best = bracket(spheres, tangent.support(), DVec3::from(center.map(SolverNumber::round)), f64::INFINITY);
    // Far from the origin doubles lie far apart, and which of the eight around the center is best shows.
    if best.center.abs().max_element() > best.high {
        let away = |c: Wide| if c.low() > 0.0 { c.high().next_up() } else { c.high().next_down() };
        for corner in 1..8 {
            let pick = |axis: usize| {
                let c = center[axis];
                if corner >> axis & 1 == 1 && c.low() != 0.0 { away(c) } else { c.high() }
            };
            let other = DVec3::new(pick(0), pick(1), pick(2));
            let other = bracket(spheres, tangent.support(), other, best.high);
            if other.high < best.high {
                best = other;
            }
        }
    }
    let bound = lower_bound(&tangent, spheres, &best);
    (tangent, best, bound)
}

/// The place, among `these` (all, if these are none), of the sphere that sticks out farthest; `None` if it is of the
/// support or does not stick out by more than a rounding error.
fn farthest(tangent: &Tangent<Wide>, spheres: &[Sphere], these: &[usize]) -> Option<usize> {
    farthest_of(tangent, spheres, these).filter(|index| !tangent.support().contains(index))
}

fma_dispatch! {
    fn farthest_of(tangent: &Tangent<Wide>, spheres: &[Sphere], these: &[usize]) -> Option<usize> = farthest_kernel;
}

#[inline(always)]
fn farthest_kernel<const FMA: bool>(tangent: &Tangent<Wide>, spheres: &[Sphere], these: &[usize]) -> Option<usize> {
    let (center, radius) = tangent.sphere(spheres, DVec3::ZERO);
    let center = DVec3::new(center[0].high(), center[1].high(), center[2].high());
    let rounded = radius.high();
    // What lies inside by more than the rounding of the center and of the reach need not be looked at closely.
    let spacing = center.abs().max_element() * (4.0 * U);
    let limit = (rounded - spacing) * (1.0 - 32.0 * U);
    let number = |x: Wide| DoubleDouble::<FMA>::sum(x.high(), x.low());
    let x = [number(tangent.x[0]), number(tangent.x[1]), number(tangent.x[2])];
    let (first, radius) = (spheres[tangent.support()[0]].center(), number(radius));
    let mut most = DoubleDouble::new(rounded * (16.0 * Wide::INSIDE));
    let mut found = None;
    for place in 0..if these.is_empty() { spheres.len() } else { these.len() } {
        let index = if these.is_empty() { place } else { these[place] };
        let sphere = &spheres[index];
        if (sphere.center() - center).length() + sphere.radius() >= limit {
            let from = difference::<DoubleDouble<FMA>>(first, sphere.center());
            let from = [from[0] + x[0], from[1] + x[1], from[2] + x[2]];
            let excess = dot(&from, &from).sqrt() + (DoubleDouble::new(sphere.radius()) - radius);
            if most.high() < excess.high() || (most.high() == excess.high() && most.low() < excess.low()) {
                (most, found) = (excess, Some(index));
            }
        }
    }
    found
}

/// Brackets the radius that encloses all spheres around a center; where it reaches `limit`, perhaps not all. Those of
/// the support, which most likely decide, come first.
fn bracket(spheres: &[Sphere], support: &[usize], center: DVec3, limit: f64) -> Bracket {
    let mut bracket = Bracket { center, low: 0.0, high: 0.0 };
    for &index in support {
        bracket.enclose_all(&spheres[index..=index], limit);
    }
    if bracket.high < limit {
        bracket.enclose_all(spheres, limit);
    }
    bracket
}

/// A lower bound for the radius of any sphere that encloses `spheres`.
fn lower_bound(tangent: &Tangent<Wide>, spheres: &[Sphere], bracket: &Bracket) -> f64 {
    let origin = bracket.center;
    let (center, _) = tangent.sphere(spheres, origin);
    let away = dot(&center, &center).sqrt().round();
    let mut sum = Wide::ZERO;
    let mut total = Wide::ZERO;
    let mut pull = [Wide::ZERO; 3];
    let mut largest = 0.0_f64;
    for (place, &index) in tangent.support().iter().enumerate() {
        let sphere = &spheres[index];
        largest = largest.max(sphere.radius());
        let weight = tangent.weight[place];
        if weight.below(Wide::ZERO) {
            continue;
        }
        let (from, _) = tangent.sphere(spheres, sphere.center());
        let distance = dot(&from, &from).sqrt();
        let share = weight * distance;
        sum = sum + share * (distance + Wide::new(sphere.radius()));
        total = total + share;
        for axis in 0..3 {
            pull[axis] = pull[axis] + weight * from[axis];
        }
    }
    let mean = sum / total;
    // All spheres reach at most this far from the center.
    let most = (bracket.high + away) * (1.0 + 4.0 * U);
    let pull = dot(&pull, &pull).sqrt().round() / total.round() + 256.0 * U * U;
    // Spheres that all are inside both this sphere and the minimal one hold the two centers together.
    let mut bound = largest;
    for _ in 0..2 {
        let apart = ((most - bound) * (most + bound)).sqrt().min(2.0 * most) * (1.0 + 8.0 * U);
        let loss = pull * apart * (1.0 + 8.0 * U) + most * (256.0 * U * U);
        let value = mean - Wide::new(loss);
        let rounded = if value.low() < 0.0 { value.high().next_down() } else { value.high() };
        if rounded > bound {
            bound = rounded;
        }
    }
    bound
}

/// No set known needs more than a few dozen pivots. The bracket encloses all spheres in any case.
const MAX_PIVOTS: usize = 200;
