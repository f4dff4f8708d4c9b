//! Sets so large or so small that squares over- or underflow: solved on a copy scaled by a power of two.

use glam::DVec3;

use super::certify::{U, contains_exactly, smallest_radius};
use super::{Enclosing, enclosing_sphere};
use crate::Sphere;

/// [`enclosing_sphere`] for a set whose extent is out of the ordinary range.
#[cold]
#[inline(never)]
pub(super) fn extreme(spheres: &[Sphere]) -> Option<Enclosing> {
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
    let exponent = if whole.is_finite() { exponent(whole) } else { exponent(extent(0.25)) + 2 };
    let scale = Scale(-exponent);
    // Scaling up overflows only where the extent is below the spacing of doubles: there all coordinates are equal.
    let mut equal = DVec3::ZERO;
    for axis in 0..3 {
        if !scale.up(origin[axis]).is_finite() {
            equal[axis] = origin[axis];
        }
    }
    let scaled: Vec<Sphere> = spheres
        .iter()
        .map(|sphere| {
            let center = sphere.center() - if equal == DVec3::ZERO { DVec3::ZERO } else { equal };
            let center = DVec3::new(scale.up(center.x), scale.up(center.y), scale.up(center.z));
            Sphere::new(center, scale.up(sphere.radius()))
        })
        .collect::<Option<_>>()?;
    let mut answer = enclosing_sphere(&scaled)?;
    let found = answer.sphere;
    let down = found.center();
    let center = DVec3::new(scale.down(down.x), scale.down(down.y), scale.down(down.z)) + equal;
    // The copy may have lost the last bits of small coordinates, and the center those of a subnormal one: judge the
    // spheres near the boundary themselves. Integers are asked at most three questions a sphere.
    let rounded = center - equal;
    let rounded = DVec3::new(scale.up(rounded.x), scale.up(rounded.y), scale.up(rounded.z));
    let reach = |copy: &Sphere| (copy.center() - rounded).length() + copy.radius();
    let reaches = || scaled.iter().map(reach).enumerate();
    let (farthest, most) = reaches().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let mut radius = smallest_radius(center, &spheres[farthest]);
    for (index, reach) in reaches() {
        if reach > most * (1.0 - 32.0 * U) && !contains_exactly(center, radius, &spheres[index]) {
            radius = smallest_radius(center, &spheres[index]);
        }
    }
    answer.sphere = Sphere::new(center, radius)?;
    let bound = scale.down(answer.lower_bound).next_down().max(0.0);
    let largest = answer.support().iter().map(|&index| spheres[index].radius()).fold(bound, f64::max);
    answer.lower_bound = largest;
    Some(answer)
}

/// The exponent `e` of a positive double: it lies in `2^e .. 2^(e+1)`.
fn exponent(x: f64) -> i32 {
    let (x, less) = if x < f64::MIN_POSITIVE { (x * 2.0_f64.powi(60), 60) } else { (x, 0) };
    ((x.to_bits() >> 52) as i32) - 1023 - less
}

/// Multiplication by a power of two, whose factor itself may be out of range.
struct Scale(i32);

impl Scale {
    fn up(&self, x: f64) -> f64 {
        Self::by(x, self.0)
    }

    fn down(&self, x: f64) -> f64 {
        Self::by(x, -self.0)
    }

    /// Rounded once: the first factor keeps the number normal if it is.
    fn by(x: f64, exponent: i32) -> f64 {
        let half = exponent / 2;
        x * 2.0_f64.powi(half) * 2.0_f64.powi(exponent - half)
    }
}
