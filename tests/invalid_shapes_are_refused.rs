//! A value with an invariant cannot be built from numbers that break it, and the refusal says why.

use glam::DVec3;
use rt_geom::{Ray, RayError, Sphere, SphereError, Triangle, TriangleError};

#[test]
fn bad_numbers_are_refused_at_construction() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let broken = DVec3::new(0.0, bad, 0.0);
        assert_eq!(Ray::new(broken, DVec3::X), Err(RayError::OriginNotFinite), "origin {broken}");
        assert_eq!(Ray::new(DVec3::ZERO, broken), Err(RayError::DirectionNotFinite), "direction {broken}");
        assert_eq!(Sphere::new(broken, 1.0), Err(SphereError::CenterNotFinite), "center {broken}");
        assert_eq!(Sphere::new(DVec3::ZERO, bad), Err(SphereError::RadiusNotFinite), "radius {bad}");
        let triangle = Triangle::new(DVec3::X, broken, DVec3::Y);
        assert_eq!(triangle, Err(TriangleError::VertexNotFinite(1)), "vertex {broken}");
    }
    assert_eq!(Ray::new(DVec3::ZERO, DVec3::ZERO), Err(RayError::ZeroDirection));
    assert_eq!(Sphere::new(DVec3::ZERO, -1.0), Err(SphereError::NegativeRadius));
}
