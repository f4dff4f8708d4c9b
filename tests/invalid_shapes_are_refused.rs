//! A value with an invariant cannot be built from numbers that break it.

use glam::DVec3;
use rt_geom::{Ray, Sphere, Triangle};

#[test]
fn bad_numbers_are_refused_at_construction() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let broken = DVec3::new(0.0, bad, 0.0);
        assert_eq!(Ray::new(broken, DVec3::X), None, "origin {broken}");
        assert_eq!(Ray::new(DVec3::ZERO, broken), None, "direction {broken}");
        assert_eq!(Sphere::new(broken, 1.0), None, "center {broken}");
        assert_eq!(Sphere::new(DVec3::ZERO, bad), None, "radius {bad}");
        assert_eq!(Triangle::new(DVec3::X, broken, DVec3::Y), None, "vertex {broken}");
    }
    assert_eq!(Ray::new(DVec3::ZERO, DVec3::ZERO), None, "a direction must not be zero");
    assert_eq!(Sphere::new(DVec3::ZERO, -1.0), None, "a radius must not be negative");
}
