//! A sphere, and where a ray meets it.
//!
//! With `w = origin - center` and `d` the direction, the line meets the sphere where
//! `(d.d) t² + 2 (w.d) t + (w.w - r²) = 0`. Whether it does is the sign of a quarter of the discriminant in
//! Lagrange's form,
//!
//! ```text
//!     Delta = (d.d) r² - |w x d|²        (d.d times: radius² minus the squared distance of the line from the center)
//! ```
//!
//! which loses nothing when the sphere is small and far. Plain doubles with an error bound decide nearly every case in
//! `filter.rs`; `exact.rs` decides the rest. The roots `(-(w.d) -+ sqrt(Delta)) / d.d` get their last bits, the ones
//! that cancel as well, from a Newton step on the residual `|w + t d|² - r²` in `finish.rs`.

mod exact;
mod filter;
mod finish;
mod lanes;

use std::fmt;
use std::ops::Range;

use glam::DVec3;
use rt_math::Roots;
use rt_math::exact::{U, power_of_two, power_of_two_near_inverse};

use crate::Ray;
use crate::ray::{Candidates, PreparedRay, max_abs};

/// Swallows what underflow does to a comparison of squares: `2^-1000`.
const UNDERFLOW: f64 = power_of_two(-1000);

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

/// Why there is no such sphere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SphereError {
    /// A coordinate of the center is infinite or NaN.
    CenterNotFinite,
    /// The radius is infinite or NaN.
    RadiusNotFinite,
    /// The radius is below zero.
    NegativeRadius,
}

impl fmt::Display for SphereError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::CenterNotFinite => "the center of a sphere must be finite",
            Self::RadiusNotFinite => "the radius of a sphere must be finite",
            Self::NegativeRadius => "the radius of a sphere must not be negative",
        })
    }
}

impl std::error::Error for SphereError {}

impl Sphere {
    /// Returns the sphere around a center, a vector or three numbers. Radius 0 is allowed.
    ///
    /// ```
    /// use rt_geom::{Sphere, SphereError};
    ///
    /// assert!(Sphere::new([1.0, 2.0, 3.0], 0.0).is_ok());
    /// assert_eq!(Sphere::new([1.0, 2.0, 3.0], -1.0), Err(SphereError::NegativeRadius));
    /// ```
    ///
    /// # Errors
    /// If a number is not finite or the radius is negative.
    #[inline]
    pub fn new(center: impl Into<DVec3>, radius: f64) -> Result<Self, SphereError> {
        let center = center.into();
        if !center.is_finite() {
            Err(SphereError::CenterNotFinite)
        } else if !radius.is_finite() {
            Err(SphereError::RadiusNotFinite)
        } else if radius < 0.0 {
            Err(SphereError::NegativeRadius)
        } else {
            Ok(Self { center, radius })
        }
    }

    /// The center; finite.
    #[inline]
    #[must_use]
    pub fn center(&self) -> DVec3 {
        self.center
    }

    /// The radius; finite and not negative.
    #[inline]
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Returns the `t` of the closest hit in the range, correctly rounded, or `None`.
    ///
    /// A root counts if `within.start <= t < within.end` for its correctly rounded `t`, compared with
    /// [`f64::total_cmp`]: an exact zero is +0.0, and a negative root that underflows is -0.0, which lies before it. An
    /// infinite end is no bound, and a root beyond the largest double is then a hit at infinity. A range that is
    /// empty or has a NaN holds nothing. From inside the sphere the far side is hit.
    ///
    /// Exact for every finite ray and sphere, over- and underflow included; `docs/numerics.md`, section 5, has the
    /// proof.
    ///
    /// ```
    /// use glam::DVec3;
    /// use rt_geom::{Ray, Sphere};
    ///
    /// let sphere = Sphere::new(DVec3::new(0.0, 0.0, -3.0), 1.0).unwrap();
    /// let ray = Ray::new(DVec3::ZERO, DVec3::new(0.0, 0.0, -0.5)).unwrap();
    /// assert_eq!(sphere.closest(&ray, 0.0..f64::INFINITY), Some(4.0)); // in units of the direction
    /// assert_eq!(sphere.closest(&ray, 5.0..f64::INFINITY), Some(8.0));
    /// assert_eq!(sphere.closest(&ray, 0.0..4.0), None);
    /// ```
    #[inline]
    #[must_use]
    pub fn closest(&self, ray: &Ray, within: Range<f64>) -> Option<f64> {
        filter::closest(self, ray, within.start, within.end)
    }

    /// Whether the ray meets the surface in the range: the same as `closest(..).is_some()`, at less cost.
    #[inline]
    #[must_use]
    pub fn any(&self, ray: &Ray, within: Range<f64>) -> bool {
        self.meets::<false>(&PreparedRay::new(ray, within))
    }

    /// Returns where the whole line meets the surface, in ascending order.
    ///
    /// The number of roots is exact, a tangent line has one, and each root is correctly rounded: two that differ by
    /// less than the spacing of doubles come out equal. Never `Roots::All`.
    #[must_use]
    pub fn roots(&self, ray: &Ray) -> Roots {
        filter::roots(self, ray)
    }

    /// Returns on which side of the surface a point lies, exactly. A point that is not finite lies outside.
    ///
    /// ```
    /// use glam::DVec3;
    /// use rt_geom::{Side, Sphere};
    ///
    /// let sphere = Sphere::new(DVec3::ZERO, 3.0).unwrap();
    /// assert_eq!(sphere.side(DVec3::new(1.0, 2.0, 2.0)), Side::On);
    /// assert_eq!(sphere.side(DVec3::new(1.0, 2.0, 2f64.next_up())), Side::Outside);
    /// ```
    #[must_use]
    pub fn side(&self, point: impl Into<DVec3>) -> Side {
        let point = point.into();
        // Modelled in docs/proofs/Sphere.v: tc, tside.
        let w = point - self.center;
        let (square, radius_square) = (w.length_squared(), self.radius * self.radius);
        let excess = square - radius_square;
        let error = 7.0 * U * (square + radius_square) + UNDERFLOW;
        if excess > error {
            Side::Outside
        } else if excess < -error {
            Side::Inside
        } else {
            exact::side(self, point)
        }
    }

    /// Returns the outward unit normal at a point of the surface: `(point - center) / |point - center|`.
    ///
    /// Within `4.6 * 2^-53` of the exact unit vector through the point given, in Euclidean length, for any scale
    /// (proved); a point that is off the surface by `e` turns it by `e / radius` more. At the center itself, so for
    /// radius 0, there is no normal: the answer is NaN.
    #[must_use]
    pub fn normal(&self, point: impl Into<DVec3>) -> DVec3 {
        let point = point.into();
        let w = point - self.center;
        let w = if w.is_finite() { w } else { 0.5 * point - 0.5 * self.center };
        let largest = max_abs(w);
        if largest == 0.0 {
            return DVec3::NAN;
        }
        // Scaled by a power of two, so that no square over- or underflows.
        let scaled = w * power_of_two_near_inverse(largest);
        scaled / scaled.length()
    }
}
