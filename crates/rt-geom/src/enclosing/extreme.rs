//! Sets so large or so small that squares over- or underflow: solved on a copy scaled by a power of two.

use glam::DVec3;
use rt_math::exact::{U, mantissa_and_exponent, scale};

use super::Enclosing;
use super::exact::{contains_exactly, smallest_radius};
use crate::Sphere;

/// The minimal sphere of a set whose extent is out of the ordinary range; `solve` finds it for one in the range.
#[cold]
#[inline(never)]
pub(super) fn extreme(spheres: &[Sphere], solve: impl Fn(&[Sphere]) -> Option<Enclosing>) -> Option<Enclosing> {
    let origin = spheres[0].center();
    // A quarter of the extent cannot overflow; the extent itself loses no bits where that matters.
    let extent = |part: f64| {
        spheres.iter().fold(0.0_f64, |most, sphere| {
            let from = sphere.center() * part - origin * part;
            most.max(from.abs().max_element()).max(sphere.radius() * part)
        })
    };
    let whole = extent(1.0);
    if whole == 0.0 {
        // One point, perhaps many times.
        return Some(Enclosing::single(0, &spheres[0]));
    }
    let exponent = |x: f64| mantissa_and_exponent(x).1;
    let exponent = if whole.is_finite() { exponent(whole) } else { exponent(extent(0.25)) + 2 };
    // Scaling up overflows only where the extent is below the spacing of doubles: there all coordinates are equal.
    let mut equal = DVec3::ZERO;
    for axis in 0..3 {
        if !scale(origin[axis], -exponent).is_finite() {
            equal[axis] = origin[axis];
        }
    }
    let scaled: Vec<Sphere> = spheres
        .iter()
        .map(|sphere| {
            let center = sphere.center() - if equal == DVec3::ZERO { DVec3::ZERO } else { equal };
            Sphere::new(scale(center, -exponent), scale(sphere.radius(), -exponent)).ok()
        })
        .collect::<Option<_>>()?;
    let mut answer = solve(&scaled)?;
    let center = scale(answer.sphere.center(), exponent) + equal;
    // The copy may have lost the last bits of small coordinates, and the center those of a subnormal one: judge the
    // spheres near the boundary themselves. Integers are asked at most three questions a sphere.
    let rounded = scale(center - equal, -exponent);
    let reach = |copy: &Sphere| (copy.center() - rounded).length() + copy.radius();
    let reaches = || scaled.iter().map(reach).enumerate();
    let (farthest, most) = reaches().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let mut radius = smallest_radius(center, &spheres[farthest]);
    for (index, reach) in reaches() {
        if reach > most * (1.0 - 32.0 * U) && !contains_exactly(center, radius, &spheres[index]) {
            radius = smallest_radius(center, &spheres[index]);
        }
    }
    answer.sphere = Sphere::new(center, radius).ok()?;
    let bound = scale(answer.lower_bound, exponent).next_down().max(0.0);
    let largest = answer.support().iter().map(|&index| spheres[index].radius()).fold(bound, f64::max);
    answer.lower_bound = largest;
    Some(answer)
}
