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
//! which loses nothing when the sphere is small and far. Plain doubles with an error bound decide nearly every
//! case here; `exact.rs` decides the rest. The roots `(-(w.d) -+ sqrt(Delta)) / d.d` get their last bits, the ones
//! that cancel as well, from a Newton step on the residual `|w + t d|² - r²` in `finish.rs`.

mod exact;
mod finish;

use std::ops::Range;

use glam::DVec3;
use rt_math::Roots;
use rt_math::exact::{U, power_of_two, power_of_two_near_inverse};

use crate::Ray;
use crate::ray::{Candidate, PreparedRay, cross, dot, max_abs};

/// Where the filter's bounds are proved: `w.w + r²` is at least `2^-250` and at most `2^600`. Nothing overflows there, and what
/// underflows is far below the bounds.
const SMALLEST: f64 = power_of_two(-250);
const LARGEST: f64 = power_of_two(600);

/// The error of `Delta` in the filter, relative to `d.d (w.w + r²)`, as `docs/numerics.md`, section 5, has it.
const ERROR: f64 = 17.0 * U;

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

impl Sphere {
    /// Returns the sphere, or `None` if a number is not finite or the radius is negative. Radius 0 is allowed.
    pub fn new(center: DVec3, radius: f64) -> Option<Self> {
        let valid = center.is_finite() && radius.is_finite() && radius >= 0.0;
        valid.then_some(Self { center, radius })
    }

    /// The center; finite.
    #[inline]
    pub fn center(&self) -> DVec3 {
        self.center
    }

    /// The radius; finite and not negative.
    #[inline]
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
    /// Exact for every finite ray and sphere, over- and underflow included; `docs/numerics.md`, section 5, has the proof.
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
    pub fn closest(&self, ray: &Ray, within: Range<f64>) -> Option<f64> {
        finish::closest(self, ray, within.start, within.end)
    }

    /// Whether the ray meets the surface in the range: the same as `closest(..).is_some()`, found sooner.
    #[inline]
    pub fn any(&self, ray: &Ray, within: Range<f64>) -> bool {
        self.meets::<false>(&PreparedRay::new(ray, within))
    }

    /// Returns where the whole line meets the surface, in ascending order.
    ///
    /// The number of roots is exact, a tangent line has one, and each root is correctly rounded: two that differ by
    /// less than the spacing of doubles come out equal. Never `Roots::All`.
    pub fn roots(&self, ray: &Ray) -> Roots {
        finish::roots(self, ray)
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
    pub fn side(&self, point: DVec3) -> Side {
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
    /// Within `4.6 * 2^-53` of the exact unit vector through the point given, in Euclidean length, for any scale (proved);
    /// a point that is off the surface by `e` turns it by `e / radius` more. At the center itself, so for
    /// radius 0, there is no normal: the answer is NaN.
    pub fn normal(&self, point: DVec3) -> DVec3 {
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

    /// What `any` returns.
    #[inline(always)]
    pub(crate) fn meets<const FMA: bool>(&self, prepared: &PreparedRay) -> bool {
        match self.line::<FMA>(prepared.ray) {
            Line::Misses => false,
            // For the whole ray the signs are enough, and need no root.
            Line::Crosses(crossing) => match crossing.first_ahead(prepared.start) {
                Some(None) => false,
                Some(Some(_)) if prepared.end == f64::INFINITY => true,
                _ => self.offer(&crossing, prepared, f64::INFINITY).is_some(),
            },
            Line::Unsure => self.exact_candidate(prepared.ray, prepared.within(), f64::INFINITY).is_some(),
        }
    }

    /// Returns bounds of the closest hit's `t`, or `None` if nothing in the range is hit or the hit surely lies
    /// beyond `limit`.
    #[inline(always)]
    pub(crate) fn candidate<const FMA: bool>(&self, prepared: &PreparedRay, limit: f64) -> Option<Candidate> {
        match self.line::<FMA>(prepared.ray) {
            Line::Misses => None,
            Line::Crosses(crossing) => self.offer(&crossing, prepared, limit),
            Line::Unsure => self.exact_candidate(prepared.ray, prepared.within(), limit),
        }
    }

    /// Returns the candidate of a line that crosses the surface.
    #[inline(always)]
    fn offer(&self, crossing: &Crossing, prepared: &PreparedRay, limit: f64) -> Option<Candidate> {
        let roots = crossing.approximation();
        let (low, high) = (roots.near - roots.error, roots.near + roots.error);
        if low > prepared.start && high < prepared.end {
            (low <= limit).then_some(Candidate { low, high })
        } else {
            self.offer_far(roots.near, roots.far, roots.error, prepared, limit)
        }
    }

    /// The same where the near root is not surely in the range. Apart, so that the usual case waits for no choice of the root.
    #[inline(never)]
    fn offer_far(&self, near: f64, far: f64, error: f64, prepared: &PreparedRay, limit: f64) -> Option<Candidate> {
        let t = if near + error < prepared.start { far } else { near };
        prepared.admit((t - error, t + error), limit, || self.exact_candidate(prepared.ray, prepared.within(), limit))
    }

    #[cold]
    #[inline(never)]
    fn exact_candidate(&self, ray: &Ray, within: Range<f64>, limit: f64) -> Option<Candidate> {
        Candidate::exact(exact::closest(self, ray, within), limit)
    }

    /// The filter: tells in plain doubles whether the line crosses the surface, where that is certain.
    #[inline(always)]
    fn line<const FMA: bool>(&self, ray: &Ray) -> Line {
        let d = ray.direction();
        let w = ray.origin() - self.center;
        let x = cross::<FMA>(w, d);
        let (w_square, radius_square) = (dot::<FMA>(w, w), self.radius * self.radius);
        let delta = ray.square() * radius_square - dot::<FMA>(x, x);
        let squares = w_square + radius_square;
        // NaN if the direction is out of the range where this is proved.
        let error = (ERROR * ray.square()) * squares;
        if !(squares > SMALLEST && squares < LARGEST) {
            return Line::Unsure;
        }
        if delta < -error {
            return Line::Misses;
        }
        if delta > error {
            let (b, c) = (dot::<FMA>(w, d), w_square - radius_square);
            return Line::Crosses(Crossing { b, c, squares, delta, error, inverse_a: ray.inverse_square() });
        }
        Line::Unsure
    }
}

/// What the filter says about a line and a sphere.
enum Line {
    Misses,
    Crosses(Crossing),
    Unsure,
}

/// `a t² + 2 b t + c`, for a line that surely crosses the surface twice.
struct Crossing {
    b: f64,
    c: f64,
    /// `w.w + r²`
    squares: f64,
    delta: f64,
    /// A bound for the error of `delta`, less than `delta` itself.
    error: f64,
    inverse_a: f64,
}

/// One of the two places where a line crosses a sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Place {
    /// Where it enters.
    Near,
    /// Where it leaves.
    Far,
}

/// Both roots in doubles.
struct Approximation {
    near: f64,
    far: f64,
    /// A bound of the error of both, and of the rounding when it is added to them or subtracted.
    error: f64,
    /// `1 / sqrt(Delta)`, rounded three times
    inverse_root: f64,
}

impl Crossing {
    #[inline(always)]
    fn approximation(&self) -> Approximation {
        // The division need not wait for the root.
        let (root, inverse) = (self.delta.sqrt(), 1.0 / self.delta);
        Approximation {
            near: (-self.b - root) * self.inverse_a,
            far: (root - self.b) * self.inverse_a,
            error: ((1.6 * self.error) * self.inverse_a) * inverse * root,
            inverse_root: inverse * root,
        }
    }

    /// Which root, if any, is the first from +0.0 on; `None` if the range starts elsewhere or it is not certain.
    ///
    /// The signs of the coefficients tell: of the roots' product c / a and, if it is positive, of their sum -2 b / a.
    /// `docs/numerics.md` shows that the sign of b is then certain.
    #[inline(always)]
    fn first_ahead(&self, start: f64) -> Option<Option<Place>> {
        let certain = start.to_bits() == 0 && self.c.abs() > 14.0 * U * self.squares;
        let first = match (self.c < 0.0, self.b < 0.0) {
            (true, _) => Some(Place::Far),
            (false, true) => Some(Place::Near),
            (false, false) => None,
        };
        certain.then_some(first)
    }

    /// Which root, if any, is the first not before the start of a range; `None` if that is not certain.
    #[inline(always)]
    fn first(&self, start: f64, roots: &Approximation) -> Option<Option<Place>> {
        let Approximation { near, far, error, .. } = *roots;
        if let Some(first) = self.first_ahead(start) {
            Some(first)
        } else if near - error > start {
            Some(Some(Place::Near))
        } else if near + error < start && far - error > start {
            Some(Some(Place::Far))
        } else if far + error < start {
            Some(None)
        } else {
            None
        }
    }
}
