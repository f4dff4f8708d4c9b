//! Which points are inside a closed mesh, on it, or outside: `cargo run -p rt-geom --example point_in_mesh`.

use glam::DVec3;
use rt_geom::{AHEAD, Bvh, Ray, Side, Triangle};

fn main() {
    // The tetrahedron between the origin and the three axes, its faces counterclockwise from outside.
    let [o, x, y, z] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let faces = [[o, y, x], [o, x, z], [o, z, y], [x, y, z]];
    let faces = faces.map(|[a, b, c]| Triangle::new(a, b, c).expect("finite vertices"));
    let tree = Bvh::new(vec![], faces.to_vec());
    assert!(tree.open_edges().is_empty(), "the mesh is closed");

    for (point, expected) in [
        (DVec3::splat(0.25), Side::Inside),
        (DVec3::new(0.25, 0.25, 0.5), Side::On),
        (DVec3::new(0.25, 0.25, 0.5f64.next_up()), Side::Outside),
    ] {
        let side = tree.contains(point);
        println!("{point} is {side:?}");
        assert_eq!(side, expected);
    }

    // Every hit of a ray through an edge, and where it enters and leaves.
    let ray = Ray::new(DVec3::new(0.5, 0.0, -1.0), DVec3::Z).expect("a direction that is not zero");
    let (mut hits, mut crossings) = (Vec::new(), Vec::new());
    tree.hits(&ray, AHEAD, &mut hits);
    tree.crossings(&ray, &mut crossings);
    println!("{} hits: {hits:?}", hits.len());
    println!("{} crossings: {crossings:?}", crossings.len());
    assert_eq!(crossings.len() % 2, 0, "what is entered is left");
}

#[test]
fn the_example_runs() {
    main();
}
