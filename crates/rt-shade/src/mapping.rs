//! Where on a map of the sphere a normal points.

use glam::DVec3;

/// Returns the texture coordinates `(u, v)` of an outward normal of any length.
pub fn sphere_uv(normal: DVec3) -> (f64, f64) {
    let DVec3 { x, y, z } = normal;
    let u = if x.is_sign_negative() && z.is_sign_negative() {
        pxfm::f_atan2pi(-z, -x) / 2.0
    } else {
        0.5 + pxfm::f_atan2pi(z, x) / 2.0
    };
    (u, pxfm::f_atan2pi(x.hypot(z), y))
}

/// Returns the coordinates at which a scene's texture is read for an outward normal: the right way round when seen
/// from outside, or with `mirrored` as [`sphere_uv`] gives them.
pub fn texture_uv(normal: DVec3, mirrored: bool) -> (f64, f64) {
    let DVec3 { x, y, z } = normal;
    sphere_uv(if mirrored { normal } else { DVec3::new(x, y, -z) })
}
