//! Reflection of a vector.

use glam::DVec3;

use crate::exact::Dyadic;

/// Returns `incident` mirrored in the plane through the origin with the given normal: `v - 2 (v·n) / (n·n) n`.
///
/// The normal may have any length but zero. Each component is correctly rounded, for all finite vectors: one beyond the
/// range of doubles is infinite, one that underflows is a zero with the sign of the exact value, and one that is exactly
/// zero is +0.0. With a zero normal, or an infinite or NaN component in either vector, every component is NaN.
///
/// ```
/// use glam::DVec3;
/// use rt_math::reflect;
///
/// assert_eq!(reflect(DVec3::new(1.0, -1.0, 0.0), DVec3::new(0.0, 5.0, 0.0)), DVec3::new(1.0, 1.0, 0.0));
/// ```
#[must_use]
pub fn reflect(incident: DVec3, normal: DVec3) -> DVec3 {
    if !(incident.is_finite() && normal.is_finite()) || normal == DVec3::ZERO {
        return DVec3::NAN;
    }
    integers(incident, normal)
}

#[cold]
#[inline(never)]
fn integers(v: DVec3, n: DVec3) -> DVec3 {
    type Number = Dyadic<104>;
    let [v, n] = [v, n].map(|x| x.to_array().map(Number::from_f64));
    let dot = |a: &[Number; 3], b: &[Number; 3]| &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2];
    let (twice, nn) = (dot(&v, &n).scale(1), dot(&n, &n));
    DVec3::from_array([0, 1, 2].map(|i| Number::quotient(&(&v[i] * &nn - &twice * &n[i]), &nn)))
}
