//! Three or four spheres: first the two that reach farthest apart.
//!
//! The minimal sphere of any two is no larger than that of all. So if two alone decide the answer, it is two whose
//! minimal sphere is largest; and where that sphere encloses the others, it is the answer. Where it does not, the one that
//! sticks out farther touches the answer, nearly always together with the two. What is not clear is left to the search.

use std::ops::Range;

use fearless_simd::{Simd, f64x4, prelude::*};
use glam::DVec3;
use rt_math::exact::U;

use super::certify::{Bracket, certify, pair};
use super::pivot::LANES;
use super::tangent::Tangent;
use super::{Enclosing, doubtful, few_spheres, finish};
use crate::Sphere;

/// More than what the rounding of an excess is, as a share of the radius.
const INSIDE: f64 = 64.0 * U;

/// Where the largest extent of two is in this range, the largest reach of all is an ordinary one (`tangent.rs`).
const EXTENTS: Range<f64> = 1e-39..1e49;

/// The minimal sphere of three or four spheres.
#[inline(always)]
pub(super) fn three_or_four<S: Simd>(simd: S, spheres: &[Sphere]) -> Option<Enclosing> {
    let (two, extent) = farthest_apart(simd, spheres);
    // (One that is farther from itself than from the others holds them all.)
    if two[0] == two[1] || !EXTENTS.contains(&extent) {
        return few_spheres::<S, 1>(simd, spheres);
    }
    let [a, b] = two.map(|place| &spheres[place]);
    let (length, wider) = (extent - (a.radius() + b.radius()), b.radius() - a.radius());
    let middle = a.center() + (b.center() - a.center()) * (0.5 + 0.5 * wider / length);
    let mut others = (0..spheres.len()).filter(|place| !two.contains(place));
    let (third, fourth) = (others.next()?, others.next());
    let (c, d) = (&spheres[third], fourth.map(|place| &spheres[place]));
    let [out_c, out_d] = [Some(c), d].map(|sphere| sphere.map_or(-1.0, |sphere| excess(sphere, middle, 0.5 * extent)));
    if out_c < 0.0
        && out_d < 0.0
        && let Some((bracket, bound)) = pair(simd, a, b)
        && [Some(c), d].into_iter().flatten().all(|sphere| is_inside(sphere, &bracket))
    {
        return finish(spheres, &bracket, bound, &two);
    }
    let (third, rest) = match fourth {
        Some(fourth) if out_d > out_c => (fourth, Some(third)),
        _ => (third, fourth),
    };
    touching(simd, [two[0], two[1], third], rest, spheres).unwrap_or_else(|| few_spheres::<S, 1>(simd, spheres))
}

/// The minimal sphere of three and perhaps a fourth, if it touches the three and encloses the fourth, or touches all;
/// `None` if it does not, or not clearly.
#[inline(always)]
fn touching<S: Simd>(simd: S, three: [usize; 3], rest: Option<usize>, spheres: &[Sphere]) -> Option<Option<Enclosing>> {
    let mut tangent = Tangent::of(&three, spheres);
    let (mut rest, origin) = (rest, DVec3::ZERO);
    if let Some(fourth) = rest {
        let encloses = |tangent: &Tangent<f64>| {
            let (center, radius) = tangent.sphere(spheres, origin);
            excess(&spheres[fourth], center.into(), radius) < 0.0
        };
        if !tangent.as_ref().is_some_and(encloses) {
            let [a, b, c] = three;
            tangent = Tangent::of(&[a, b, c, fourth], spheres);
            rest = None;
        }
    }
    let tangent = tangent?;
    let (bracket, bound) = certify(simd, &tangent, spheres);
    if doubtful(&bracket, bound) || !rest.is_none_or(|fourth| is_inside(&spheres[fourth], &bracket)) {
        return None;
    }
    Some(finish(spheres, &bracket, bound, tangent.support()))
}

/// The two of three or four spheres that reach farthest apart, and how far; the same one twice if it reaches farther
/// by itself.
#[inline(always)]
fn farthest_apart<S: Simd>(simd: S, spheres: &[Sphere]) -> ([usize; 2], f64) {
    const PAIRS: [[usize; 2]; LANES] = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2], [1, 3], [2, 0], [3, 1]];
    // With three the first stands for a fourth.
    let four: [&Sphere; 4] = std::array::from_fn(|place| spheres.get(place).unwrap_or(&spheres[0]));
    let each = |number: fn(&Sphere) -> f64| f64x4::simd_from(simd, four.map(number));
    let coordinates = [each(|s| s.center().x), each(|s| s.center().y), each(|s| s.center().z)];
    let [x, y, z] =
        coordinates.map(|v| v.combine(v) - v.rotate_elements_left::<1>().combine(v.rotate_elements_left::<2>()));
    let r = each(Sphere::radius);
    let radii = r.combine(r) + r.rotate_elements_left::<1>().combine(r.rotate_elements_left::<2>());
    let extents = (x * x + y * y + z * z).sqrt() + radii;
    let most = extents.reduce_max();
    // (What overflows is infinite, and out of range.)
    let lane = extents.simd_ge(most).to_bitmask().trailing_zeros() as usize;
    (PAIRS[lane % LANES].map(|place| if place < spheres.len() { place } else { 0 }), most)
}

/// How far a sphere sticks out of another: the excess times about twice the radius; negative if it does not.
#[inline(always)]
fn excess(sphere: &Sphere, center: DVec3, radius: f64) -> f64 {
    let room = radius - sphere.radius();
    (sphere.center() - center).length_squared() - room * room.abs()
}

/// Whether a sphere lies inside that of a bracket, by more than rounding errors.
#[inline(always)]
fn is_inside(sphere: &Sphere, bracket: &Bracket) -> bool {
    excess(sphere, bracket.center, bracket.low * (1.0 - INSIDE)) < 0.0
}

#[cfg(test)]
mod tests {
    use oracle::Random;
    use rt_math::exact::power_of_two;

    use super::super::enclosing_sphere;
    use super::super::exact::contains_exactly;
    use super::*;

    /// A third, and perhaps a fourth, that touches the sphere of two from inside up to a few roundings: what sticks out
    /// by a unit in the last place is enclosed all the same, and the answer is no larger than it must be.
    #[test]
    fn what_touches_the_sphere_of_two_is_enclosed_exactly() {
        let random = &mut Random::new(12);
        let mut supports = [0; 5];
        for round in 0..4_000 {
            let ball = |center: DVec3, radius: f64| Sphere::new(center, radius).unwrap();
            let [a, b] = [(); 2].map(|()| ball(random.point(), 0.2 * random.share()));
            let Some(two) = enclosing_sphere(&[a, b]).map(|found| found.sphere) else { continue };
            let mut touching = || {
                let radius = two.radius() * 0.3 * random.share();
                let off = [0.0, 1e-16, -1e-16, 3e-16, -3e-16, 1e-14, -1e-14][random.below(7)];
                ball(two.center() + random.direction() * (two.radius() * (1.0 + off) - radius), radius)
            };
            let mut set = vec![a, touching(), b];
            if round % 2 == 0 {
                set.insert(1, touching());
            }
            let found = enclosing_sphere(&set).unwrap();
            for sphere in &set {
                assert!(contains_exactly(found.sphere.center(), found.sphere.radius(), sphere), "{set:?} {found:?}");
            }
            let gap = found.sphere.radius() - found.lower_bound;
            assert!(gap <= 16.0 * U * found.sphere.radius(), "{set:?} {found:?}");
            supports[found.support().len()] += 1;
        }
        assert!(supports[2] > 500 && supports[3] > 500, "{supports:?}");
    }

    /// Three and four of any size, where squares under- and overflow too: what is in is in exactly, and the radius is that
    /// of the same spheres at the size of 1, up to a few roundings.
    #[test]
    fn three_and_four_of_any_size_are_enclosed() {
        let random = &mut Random::new(13);
        for exponent in [-900, -600, -420, -300, -200, -135, -128, 0, 150, 160, 170, 300, 450, 600, 900] {
            for round in 0..200 {
                let size = power_of_two(exponent);
                let ball = |center: DVec3, radius: f64| Sphere::new(center, radius).unwrap();
                let set: Vec<Sphere> = (0..3 + round % 2).map(|_| ball(random.point(), 0.3 * random.share())).collect();
                let scaled: Vec<Sphere> = set.iter().map(|s| ball(size * s.center(), size * s.radius())).collect();
                let (one, found) = (enclosing_sphere(&set).unwrap(), enclosing_sphere(&scaled).unwrap());
                for sphere in &scaled {
                    let (center, radius) = (found.sphere.center(), found.sphere.radius());
                    assert!(contains_exactly(center, radius, sphere), "2^{exponent}: {scaled:?} {found:?}");
                }
                assert!(
                    found.sphere.radius() / size <= one.sphere.radius() * (1.0 + 16.0 * U),
                    "2^{exponent}: {set:?}"
                );
                let gap = found.sphere.radius() - found.lower_bound;
                assert!((0.0..=16.0 * U * found.sphere.radius()).contains(&gap), "2^{exponent}: {scaled:?} {found:?}");
            }
        }
    }
}
