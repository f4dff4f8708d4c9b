//! A sphere, and where a ray meets it.

use std::ops::Range;

use glam::DVec3;
use rt_math::Roots;

use crate::Ray;
use crate::ray::{Candidate, PreparedRay, holds};

/// Where a point lies with regard to a sphere's surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Nearer to the center than the radius.
    Inside,
    /// On the surface.
    On,
    /// Farther from the center than the radius.
    Outside,
}

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

    /// Returns the `t` of the closest hit in the range, or `None`.
    pub fn closest(&self, ray: &Ray, within: Range<f64>) -> Option<f64> {
        match self.roots(ray) {
            Roots::One(t) if holds(&within, t) => Some(t),
            Roots::Two(near, _) if holds(&within, near) => Some(near),
            Roots::Two(_, far) if holds(&within, far) => Some(far),
            _ => None,
        }
    }

    /// Whether the ray meets the surface in the range: the same as `closest(..).is_some()`.
    pub fn any(&self, ray: &Ray, within: Range<f64>) -> bool {
        self.closest(ray, within).is_some()
    }

    /// Returns where the whole line meets the surface, in ascending order; a tangent line meets it once.
    pub fn roots(&self, ray: &Ray) -> Roots {
        let d = ray.direction();
        let w = ray.origin() - self.center;
        let a = d.length_squared();
        let b = w.dot(d);
        let delta = a * (self.radius * self.radius) - w.cross(d).length_squared();
        if delta == 0.0 {
            Roots::One(0.0 - b / a)
        } else if delta > 0.0 {
            let q = -(b + delta.sqrt().copysign(b));
            let distance = w.length();
            let c = (distance - self.radius) * (distance + self.radius);
            let (s, t) = (q / a + 0.0, c / q + 0.0);
            Roots::Two(s.min(t), s.max(t))
        } else {
            Roots::None
        }
    }

    /// Returns on which side of the surface a point lies.
    pub fn side(&self, point: DVec3) -> Side {
        let distance = (point - self.center).length();
        if distance < self.radius {
            Side::Inside
        } else if distance == self.radius {
            Side::On
        } else {
            Side::Outside
        }
    }

    /// Returns the outward unit normal at a point of the surface.
    pub fn normal(&self, point: DVec3) -> DVec3 {
        (point - self.center).normalize()
    }

    /// Returns bounds of the closest hit's `t`, or `None` if nothing in the range is hit or the hit surely lies
    /// beyond `limit`.
    #[inline]
    pub(crate) fn candidate(&self, prepared: &PreparedRay, limit: f64) -> Option<Candidate> {
        let t = self.closest(&prepared.ray, prepared.within.clone())?;
        (t <= limit).then_some(Candidate { low: t, high: t })
    }
}
