//! Exact answers about one sphere in another: in fixed-point numbers, where one window holds all, else in integers of
//! any size.

use glam::DVec3;
use rt_math::exact::vector::{FromDifference, difference, dot, minus};
use rt_math::exact::{Dyadic, Fixed, Window};

use super::stage::{Stage, decided};
use crate::Sphere;

/// Holds what decides whether one sphere contains another, for any doubles: differences are multiples of 2^-1074 below
/// 2^1025, which takes 35 limbs; their squares and the sum of three take 71, and the rounding of the root 68.
type ReachInteger = Dyadic<72>;

fn square_of_distance(a: DVec3, b: DVec3) -> ReachInteger {
    let offset = difference::<ReachInteger>(a, b);
    dot(&offset, &offset)
}

/// Whether a sphere with radius `outer` contains one with radius `inner`, given the square of the distance of the
/// centers.
fn holds(outer: f64, inner: f64, square: &ReachInteger) -> bool {
    decided(Stage::Question);
    let room = ReachInteger::from_difference(outer, inner);
    !room.sign().is_lt() && *square <= room.square()
}

/// Whether `sphere` lies inside the sphere around `center` with `radius`, its boundary included: exactly.
#[cold]
#[inline(never)]
pub(super) fn contains_exactly(center: DVec3, radius: f64, sphere: &Sphere) -> bool {
    contains_fixed::<1, 2>(center, radius, sphere)
        .or_else(|| contains_fixed::<2, 4>(center, radius, sphere))
        .unwrap_or_else(|| holds(radius, sphere.radius(), &square_of_distance(center, sphere.center())))
}

/// The same in fixed-point numbers, if one window holds all: coordinates of `N` limbs, squares of `S = 2 N`.
fn contains_fixed<const N: usize, const S: usize>(center: DVec3, radius: f64, sphere: &Sphere) -> Option<bool> {
    let c = sphere.center();
    let window = Window::<N>::around(&[center.x, center.y, center.z, c.x, c.y, c.z, radius, sphere.radius()])?;
    let offset = minus(&window.vector(center), &window.vector(c));
    let room = window.fixed(radius) - window.fixed(sphere.radius());
    let excess = dot::<_, _, Fixed<S>>(&offset, &offset) - Fixed::product(&room, &room);
    Some(room.sign().is_ge() && excess.sign().is_le())
}

/// The reach of `sphere` from `center` rounded to nearest, in fixed-point numbers.
fn reach_fixed<const N: usize, const S: usize>(center: DVec3, sphere: &Sphere) -> Option<f64> {
    let c = sphere.center();
    let window = Window::<N>::around(&[center.x, center.y, center.z, c.x, c.y, c.z, sphere.radius()])?;
    let (offset, r) = (minus(&window.vector(center), &window.vector(c)), window.fixed(sphere.radius()));
    let square: Fixed<S> = dot(&offset, &offset);
    // r + √square is a root of x² - 2 r x + (r² - square).
    let rest = Fixed::<S>::product(&r, &r) - square;
    Some(Fixed::root(&r, false, &square, &Fixed::<1>::ONE, &rest, window.exponent()))
}

/// The smallest double that is not below the reach of `sphere` from `center`; infinite if no finite one is.
#[cold]
#[inline(never)]
pub(super) fn smallest_radius(center: DVec3, sphere: &Sphere) -> f64 {
    decided(Stage::Question);
    // The reach rounded to nearest: that double or the next.
    let nearest = reach_fixed::<1, 2>(center, sphere)
        .or_else(|| reach_fixed::<2, 4>(center, sphere))
        .unwrap_or_else(|| reach_of_any_size(center, sphere));
    if nearest.is_infinite() || contains_exactly(center, nearest, sphere) { nearest } else { nearest.next_up() }
}

#[cold]
#[inline(never)]
fn reach_of_any_size(center: DVec3, sphere: &Sphere) -> f64 {
    let square = square_of_distance(center, sphere.center());
    ReachInteger::root(&ReachInteger::from_f64(sphere.radius()), false, &square, &ReachInteger::power_of_two(0))
}
