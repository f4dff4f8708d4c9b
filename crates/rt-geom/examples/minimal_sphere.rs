//! The smallest sphere around spheres: `cargo run -p rt-geom --example minimal_sphere`.

use glam::DVec3;
use rt_geom::{Sphere, enclosing_sphere};

fn main() {
    let ball = |x: f64, y: f64, radius| Sphere::new(DVec3::new(x, y, 0.0), radius).expect("a positive radius");
    let balls = [ball(-3.0, 0.0, 1.0), ball(3.0, 0.0, 1.0), ball(0.0, 1.0, 0.5)];
    let found = enclosing_sphere(&balls).expect("there are spheres");
    println!("center {}, radius {}", found.sphere.center(), found.sphere.radius());
    assert_eq!((found.sphere.center(), found.sphere.radius()), (DVec3::ZERO, 4.0));
}

#[test]
fn the_example_runs() {
    main();
}
