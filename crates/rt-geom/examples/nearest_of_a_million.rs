//! The nearest of a million spheres on a ray: `cargo run --release -p rt-geom --example nearest_of_a_million`.

use glam::DVec3;
use rt_geom::{AHEAD, Bvh, List, Ray, Sphere};

/// How many spheres; fewer where the example is run as a test.
const COUNT: u32 = if cfg!(test) { 10_000 } else { 1_000_000 };

fn main() {
    // Places that fill a cube evenly: multiples of three irrational numbers, modulo 1.
    let place = |i: u32| (f64::from(i) * DVec3::new(0.819_172_513, 0.671_043_607, 0.549_700_478)).fract_gl();
    let spheres: Vec<Sphere> =
        (0..COUNT).map(|i| Sphere::new(100.0 * place(i), 0.2).expect("a positive radius")).collect();
    let tree = Bvh::new(spheres.clone(), vec![]);

    let ray = Ray::new(DVec3::new(50.0, 50.0, -10.0), DVec3::new(0.01, 0.02, 1.0)).expect("a direction");
    let hit = tree.closest(&ray, AHEAD);
    match hit {
        Some(hit) => {
            let shape = tree.shape(hit.index);
            let normal = shape.hit_point(&ray, hit.t).normal().vector;
            println!("sphere {} at t = {}, with the normal {normal}", hit.index, hit.t);
        }
        None => println!("nothing"),
    }
    // A loop over all of them says the same.
    assert_eq!(hit, List { spheres, triangles: vec![] }.closest(&ray, AHEAD));
}

#[test]
fn the_example_runs() {
    main();
}
