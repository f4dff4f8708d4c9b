//! A ray: an origin and a direction of any length.

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
