//! A ray: an origin and a direction of any length.

use std::fmt;
use std::ops::Range;

use glam::DVec3;
use rt_math::exact::power_of_two;

/// The points `origin + t direction` with `t >= 0`.
///
/// The direction need not be a unit vector: `t` counts in units of it, and nothing normalises it behind the
/// caller's back, because that would move the ray.
///
/// ```
/// use rt_geom::{AHEAD, Ray, Sphere};
///
/// let ray = Ray::new([1.0, 0.0, 0.0], [0.0, 0.0, -0.5]).unwrap();
/// let t = Sphere::new([1.0, 0.0, -3.0], 1.0).unwrap().closest(&ray, AHEAD).unwrap();
/// assert_eq!((t, ray.at(t).to_array()), (4.0, [1.0, 0.0, -2.0]));
/// ```
// In an order in which no pair of coordinates straddles two pairs that are written together: reading such a pair soon
// after stalls until the stores have reached the cache.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Ray {
    origin: DVec3,
    // What every shape's test needs of the direction, once for all of them.
    reach: f64,
    direction: DVec3,
    square: f64,
    inverse_square: f64,
}

impl Ray {
    /// Returns the ray with this origin and direction, each a vector or three numbers.
    ///
    /// ```
    /// use rt_geom::{Ray, RayError};
    ///
    /// assert!(Ray::new([0.0; 3], [0.0, 0.0, -1e-300]).is_ok());
    /// assert_eq!(Ray::new([0.0; 3], [0.0; 3]), Err(RayError::ZeroDirection));
    /// ```
    ///
    /// # Errors
    /// If a component is not finite or the direction is zero.
    #[inline]
    pub fn new(origin: impl Into<DVec3>, direction: impl Into<DVec3>) -> Result<Self, RayError> {
        Self::between(origin.into(), direction.into())
    }

    #[inline]
    fn between(origin: DVec3, direction: DVec3) -> Result<Self, RayError> {
        const LONGEST: f64 = power_of_two(100);
        let reach = max_abs(direction);
        let square = direction.length_squared();
        // NaN if a component is, and then no comparison holds.
        let far = (origin.x.abs() + origin.y.abs() + origin.z.abs()) + square;
        let ordinary = (1.0 / LONGEST..=LONGEST).contains(&reach) && far < f64::INFINITY;
        if !ordinary && let Some(error) = refused(origin, direction) {
            return Err(error);
        }
        let (reach, square) = if ordinary { (reach, square) } else { (f64::NAN, f64::NAN) };
        Ok(Self { origin, direction, reach, square, inverse_square: 1.0 / square })
    }

    /// Where the ray starts; finite.
    #[inline]
    #[must_use]
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// Where the ray goes; finite and not zero, of any length.
    #[inline]
    #[must_use]
    pub fn direction(&self) -> DVec3 {
        self.direction
    }

    /// Returns the point `origin + t direction`, rounded twice per component.
    ///
    /// With `u = 2^-53` and `t` the correctly rounded parameter of a hit, each component is off the exact hit by at
    /// most `u (2.01 |t direction| + 1.01 |point|)`, barring over- and underflow; `docs/numerics.md`, section 5, has
    /// the proof.
    #[inline]
    #[must_use]
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.direction
    }

    /// The largest component of the direction in magnitude.
    ///
    /// The filters are proved for directions where this lies between 2^-100 and 2^100. For any other direction, and for
    /// an origin whose coordinates add up to infinity, this and the squares are NaN: every comparison with an error
    /// bound then fails, and the exact path decides.
    #[inline(always)]
    pub(crate) fn reach(&self) -> f64 {
        self.reach
    }

    /// `direction . direction`, rounded.
    #[inline(always)]
    pub(crate) fn square(&self) -> f64 {
        self.square
    }

    /// The reciprocal of `square`.
    #[inline(always)]
    pub(crate) fn inverse_square(&self) -> f64 {
        self.inverse_square
    }
}

/// Why there is no such ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayError {
    /// A coordinate of the origin is infinite or NaN.
    OriginNotFinite,
    /// A component of the direction is infinite or NaN.
    DirectionNotFinite,
    /// The direction is zero.
    ZeroDirection,
}

impl fmt::Display for RayError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::OriginNotFinite => "the origin of a ray must be finite",
            Self::DirectionNotFinite => "the direction of a ray must be finite",
            Self::ZeroDirection => "the direction of a ray must not be zero",
        })
    }
}

impl std::error::Error for RayError {}

/// What is wrong with a ray, if anything.
#[inline(always)]
fn refused(origin: DVec3, direction: DVec3) -> Option<RayError> {
    if !origin.is_finite() {
        Some(RayError::OriginNotFinite)
    } else if !direction.is_finite() {
        Some(RayError::DirectionNotFinite)
    } else if direction == DVec3::ZERO {
        Some(RayError::ZeroDirection)
    } else {
        None
    }
}

/// Rays are equal if their origins and directions are.
impl PartialEq for Ray {
    fn eq(&self, other: &Self) -> bool {
        self.origin == other.origin && self.direction == other.direction
    }
}

impl fmt::Debug for Ray {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.debug_struct("Ray").field("origin", &self.origin).field("direction", &self.direction).finish()
    }
}

/// A ray and the range of `t` that counts, as in `holds`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PreparedRay<'a> {
    pub(crate) ray: &'a Ray,
    pub(crate) start: f64,
    pub(crate) end: f64,
    /// As the ray has them.
    pub(crate) square: f64,
    pub(crate) inverse_square: f64,
}

impl<'a> PreparedRay<'a> {
    #[inline(always)]
    pub(crate) fn new(ray: &'a Ray, within: Range<f64>) -> Self {
        let Range { start, end } = within;
        Self { ray, start, end, square: ray.square, inverse_square: ray.inverse_square }
    }

    /// The range.
    #[inline(always)]
    pub(crate) fn within(&self) -> Range<f64> {
        self.start..self.end
    }

    /// Returns what a shape offers whose correctly rounded `t` lies between two bounds: nothing if it is surely out of
    /// the range or beyond `limit`, the bounds if it is surely in the range, and else what `exactly` finds.
    #[inline(always)]
    pub(crate) fn admit(&self, (low, high): (f64, f64), limit: f64, exactly: impl FnOnce() -> Candidate) -> Candidate {
        if low > limit || low > self.end || high < self.start {
            Candidate::NONE
        } else if low > self.start && high < self.end {
            Candidate { low, high }
        } else {
            exactly()
        }
    }
}

/// Bounds of the correctly rounded `t` of a shape's closest hit in the range: `low <= t <= high`.
///
/// That there is a hit in the range is certain. Of two candidates with `a.high < b.low` the first is closer;
/// where the bounds overlap, `closest` on both shapes decides, and equal `t` means the lower index.
///
/// Where nothing is hit it is [`NONE`](Self::NONE): two numbers travel in registers, and an `Option` of them would not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Candidate {
    pub(crate) low: f64,
    pub(crate) high: f64,
}

impl Candidate {
    /// No hit. Every comparison with its bounds is false.
    pub(crate) const NONE: Self = Self { low: f64::NAN, high: f64::NAN };

    /// A hit whose `t` is known, if it is not beyond `limit`.
    pub(crate) fn exact(t: Option<f64>, limit: f64) -> Self {
        t.filter(|&t| t <= limit).map_or(Self::NONE, |t| Self { low: t, high: t })
    }

    /// Whether there is a hit.
    #[inline(always)]
    pub(crate) fn is_some(&self) -> bool {
        self.low <= self.high
    }
}

/// A shape whose hits have candidates.
pub(crate) trait Candidates {
    /// Bounds of the closest hit's `t`: none if nothing in the range is hit, or the hit surely lies beyond `limit`.
    fn candidate<const FMA: bool>(&self, ray: &PreparedRay, limit: f64) -> Candidate;

    /// Whether the range holds a hit.
    fn meets<const FMA: bool>(&self, ray: &PreparedRay) -> bool;
}

/// What a filter in plain doubles says about a line and a shape.
pub(crate) enum FilterVerdict<C> {
    /// The line surely misses it.
    Misses,
    /// The line surely crosses it, whatever the range: a sphere in two points, a triangle in its interior.
    Crosses(C),
    /// A stage of more precision has to decide.
    Unsure,
}

/// Whether the range holds `t`: `start <= t < end` by `total_cmp`, where an infinite end is no bound.
///
/// NaN as a bound or an empty range holds nothing.
#[inline]
pub(crate) fn holds(within: &Range<f64>, t: f64) -> bool {
    // Strictly between numbers there is no question of signed zeros, infinity or NaN.
    (within.start < t && t < within.end) || holds_at_the_ends(within, t)
}

#[cold]
fn holds_at_the_ends(within: &Range<f64>, t: f64) -> bool {
    let Range { start, end } = *within;
    is_open(within) && start.total_cmp(&t).is_le() && (t.total_cmp(&end).is_lt() || end == f64::INFINITY)
}

/// Whether a range holds any number.
#[inline(always)]
pub(crate) fn is_open(within: &Range<f64>) -> bool {
    let Range { start, end } = within;
    start < end || (start == end && start.total_cmp(end).is_lt())
}

/// The larger number; the second if either is NaN. One instruction, unlike `f64::max`.
#[inline(always)]
pub(crate) fn larger(x: f64, y: f64) -> f64 {
    if x > y { x } else { y }
}

/// The smaller number; the second if either is NaN.
#[inline(always)]
pub(crate) fn smaller(x: f64, y: f64) -> f64 {
    if x < y { x } else { y }
}

/// The largest magnitude of a component.
#[inline(always)]
pub(crate) fn max_abs(v: DVec3) -> f64 {
    larger(v.x.abs(), larger(v.y.abs(), v.z.abs()))
}

/// `v x w` in plain doubles, fused where that is asked for.
#[inline(always)]
pub(crate) fn cross<const FMA: bool>(v: DVec3, w: DVec3) -> DVec3 {
    let part = |a: f64, b: f64, c: f64, d: f64| if FMA { a.mul_add(b, -(c * d)) } else { a * b - c * d };
    DVec3::new(part(v.y, w.z, v.z, w.y), part(v.z, w.x, v.x, w.z), part(v.x, w.y, v.y, w.x))
}

/// `v . w` in plain doubles, fused where that is asked for.
#[inline(always)]
pub(crate) fn dot<const FMA: bool>(v: DVec3, w: DVec3) -> f64 {
    if FMA { v.x.mul_add(w.x, v.y.mul_add(w.y, v.z * w.z)) } else { (v.x * w.x + v.y * w.y) + v.z * w.z }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_holds_its_start_and_not_its_end() {
        let tiny = f64::from_bits(1);
        let cases = [
            (0.0..1.0, 0.0, true),
            (0.0..1.0, -0.0, false), // a negative root that underflowed lies before zero
            (0.0..1.0, 1.0, false),
            (0.0..1.0, 1f64.next_down(), true),
            (-0.0..0.0, -0.0, true),
            (-0.0..0.0, 0.0, false),
            (tiny..1.0, 0.0, false),
            (0.0..f64::INFINITY, f64::INFINITY, true), // no upper end
            (0.0..f64::MAX, f64::INFINITY, false),
            (f64::NEG_INFINITY..0.0, f64::NEG_INFINITY, true),
            (f64::INFINITY..f64::INFINITY, f64::INFINITY, false), // empty
            (1.0..0.0, 0.5, false),
            (f64::NAN..1.0, 0.5, false),
            (0.0..f64::NAN, 0.5, false),
            (-f64::NAN..1.0, 0.5, false),
        ];
        for (range, t, expected) in cases {
            assert_eq!(holds(&range, t), expected, "{t:?} in {range:?}");
        }
    }

    #[test]
    fn a_very_long_or_short_direction_leaves_the_filters() {
        for (length, regular) in [(1.0, true), (1e30, true), (1e31, false), (1e-31, false), (5e-324, false)] {
            let ray = Ray::new(DVec3::ONE, DVec3::new(0.0, -length, 0.0)).unwrap();
            assert_eq!(!ray.reach.is_nan(), regular, "direction of length {length}");
            assert_eq!((ray, format!("{ray:?}").contains("NaN")), (ray, false));
        }
    }
}
