//! A sphere, and where a ray meets it.

use glam::DVec3;

/// The points at distance `radius` from `center`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    center: DVec3,
    radius: f64,
}

impl Sphere {
    /// Returns the sphere, or `None` if a number is not finite or the radius is negative. Radius 0 is allowed.
    pub fn new(center: DVec3, radius: f64) -> Option<Self> {
        let valid = center.is_finite() && radius.is_finite() && radius >= 0.0;
        valid.then_some(Self { center, radius })
    }

    /// The center; finite.
    pub fn center(&self) -> DVec3 {
        self.center
    }

    /// The radius; finite and not negative.
    pub fn radius(&self) -> f64 {
        self.radius
    }
}
