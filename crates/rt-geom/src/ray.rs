//! A ray: an origin and a direction of any length.

use std::ops::Range;

use glam::DVec3;

/// The points `origin + t direction` with `t >= 0`.
///
/// The direction need not be a unit vector: `t` counts in units of it, and nothing normalises it behind the
/// caller's back, because that would move the ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    origin: DVec3,
    direction: DVec3,
}

impl Ray {
    /// Returns the ray, or `None` if a component is not finite or the direction is zero.
    pub fn new(origin: DVec3, direction: DVec3) -> Option<Self> {
        let valid = origin.is_finite() && direction.is_finite() && direction != DVec3::ZERO;
        valid.then_some(Self { origin, direction })
    }

    /// Where the ray starts; finite.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// Where the ray goes; finite and not zero, of any length.
    pub fn direction(&self) -> DVec3 {
        self.direction
    }

    /// Returns the point `origin + t direction`, rounded twice per component.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.direction
    }
}

/// A ray and a range, with the quantities that every shape needs computed once.
#[derive(Clone, Debug)]
pub(crate) struct PreparedRay {
    pub(crate) ray: Ray,
    pub(crate) within: Range<f64>,
}

impl PreparedRay {
    #[inline]
    pub(crate) fn new(ray: &Ray, within: Range<f64>) -> Self {
        Self { ray: *ray, within }
    }
}

/// Bounds of the correctly rounded `t` of a shape's closest hit in the range: `low <= t <= high`.
///
/// That there is a hit in the range is certain. Of two candidates with `a.high < b.low` the first is closer;
/// where the bounds overlap, `closest` on both shapes decides, and equal `t` means the lower index.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Candidate {
    pub(crate) low: f64,
    pub(crate) high: f64,
}

/// Whether the range holds `t`: `start <= t < end` by `total_cmp`, where an infinite end is no bound.
///
/// NaN as a bound or an empty range holds nothing.
pub(crate) fn holds(within: &Range<f64>, t: f64) -> bool {
    let Range { start, end } = *within;
    !start.is_nan()
        && !end.is_nan()
        && start.total_cmp(&end).is_lt()
        && start.total_cmp(&t).is_le()
        && (t.total_cmp(&end).is_lt() || end == f64::INFINITY)
}
