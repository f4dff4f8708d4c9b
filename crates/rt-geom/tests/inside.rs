//! Whether a point is inside a triangle, or in its plane, is exact, and its barycentric weights are correctly rounded,
//! for every finite input.

use std::cmp::Ordering;

use glam::DVec3;
use oracle::{Place, Projection, Random, cases, is_rounded_quotient, scale_point, sign};
use rt_geom::{PointInTriangle, Triangle, inside_triangle};

/// Random cases per class with `RT_LONG`, instead of ten thousand.
const LONG: usize = 500_000;

fn check(point: DVec3, vertices: [DVec3; 3]) -> PointInTriangle {
    let [a, b, c] = vertices;
    let (triangle, truth) = (Triangle::new(a, b, c).unwrap(), Projection::new(point, vertices));
    let expected = match truth.place() {
        Place::Interior => PointInTriangle::Interior,
        Place::Edge(_) => PointInTriangle::Edge,
        Place::Vertex(_) => PointInTriangle::Vertex,
        Place::Miss | Place::Parallel | Place::Degenerate => PointInTriangle::Outside,
    };
    assert_eq!(inside_triangle(point, &triangle), expected, "{point:?} {triangle:?}");
    let coplanar = sign(&truth.height) == Ordering::Equal;
    assert_eq!(triangle.is_coplanar(point), coplanar, "{point:?} {triangle:?}");
    let weights = triangle.barycentric(point);
    assert_eq!(weights.is_none(), truth.place() == Place::Degenerate, "{triangle:?}");
    if let Some(weights) = weights {
        let right = (0..3).all(|i| is_rounded_quotient(weights[i], &truth.turns[i], &truth.square));
        assert!(right, "{point:?} {triangle:?} gives {weights:?}");
    }
    expected
}

/// Runs a class; returns how many points were interior, on an edge, at a vertex, outside.
fn run(seed: u64, mut case: impl FnMut(&mut Random) -> (DVec3, [DVec3; 3])) -> [usize; 4] {
    let mut rng = Random::new(seed);
    let mut counts = [0; 4];
    for _ in 0..cases(LONG) {
        let (point, vertices) = case(&mut rng);
        counts[check(point, vertices) as usize] += 1;
    }
    counts
}

#[test]
fn benign_in_and_off_the_plane() {
    let counts = run(1, |rng| {
        let [a, b, c] = [rng.point(), rng.point(), rng.point()];
        let in_plane = a + rng.uniform() * (b - a) + rng.uniform() * (c - a);
        let off = if rng.bits() & 1 == 0 { DVec3::ZERO } else { 3.0 * rng.uniform() * (b - a).cross(c - a) };
        (in_plane + off, [a, b, c])
    });
    assert!(counts[0] > 1000 && counts[3] > 1000, "{counts:?}");
}

#[test]
fn on_edges_and_vertices_and_above_them() {
    let counts = run(2, |rng| {
        let vertices = [0; 3].map(|_| 12.0 * rng.small_point(30));
        let i = rng.below(3);
        let (from, to) = (vertices[i], vertices[(i + 1) % 3]);
        let n = (vertices[1] - vertices[0]).cross(vertices[2] - vertices[0]);
        let point = from + rng.small(12) / 12.0 * (to - from) + rng.small(3) * n;
        let point = if rng.bits() & 3 == 0 { rng.nudge_point(point, 1) } else { point };
        let k = rng.integer(-50..50);
        (scale_point(point, k), vertices.map(|v| scale_point(v, k)))
    });
    assert!(counts.iter().all(|&n| n > 400), "{counts:?}");
}

/// Rounding decides on which side of an edge the point is.
#[test]
fn within_a_rounding_error_of_an_edge() {
    let counts = run(8, |rng| {
        let place = rng.pick(&[0.0, 1.0, 100.0]) * rng.point();
        let vertices = [rng.point(), rng.point(), rng.point()].map(|v| place + v);
        let i = rng.below(3);
        let point = vertices[i] + rng.uniform().abs() * (vertices[(i + 1) % 3] - vertices[i]);
        (rng.nudge_point(point, 1), vertices)
    });
    assert!(counts[0] > 1000 && counts[3] > 1000, "{counts:?}");
}

/// All in the plane z = x + 3 y, with products too long for a double.
#[test]
fn in_the_plane_exactly() {
    run(9, |rng| {
        let mut point = || {
            let mut part = || f64::from(rng.integer(0..1 << 25)) * 33_554_393.0 - 2f64.powi(49);
            let (x, y) = (part(), part());
            DVec3::new(x, y, x + 3.0 * y)
        };
        (point(), [point(), point(), point()])
    });
}

#[test]
fn slivers_and_triangles_without_area() {
    run(3, |rng| {
        let (a, along) = (rng.point(), rng.point());
        let c = a + rng.uniform() * along + rng.point() * 2f64.powi(-rng.integer(0..60));
        (a + rng.uniform() * along, [a, a + along, c])
    });
    run(4, |rng| {
        let (a, along) = (rng.small_point(50), rng.small_point(5));
        (a + rng.small(5) * along, [a, a + rng.small(5) * along, a + rng.small(5) * along])
    });
}

#[test]
fn far_points_and_every_exponent() {
    run(5, |rng| {
        let vertices = [rng.point(), rng.point(), rng.point()];
        (rng.point() * 10f64.powi(rng.integer(0..17)), vertices)
    });
    run(6, |rng| (rng.finite_point(), [0; 3].map(|_| rng.finite_point())));
    let counts = run(7, |rng| {
        let k = rng.integer(-1070..1020);
        let vertices = [0; 3].map(|_| rng.small_point(3) / 2.0);
        let point = vertices[0] + rng.pick(&[0.0, 0.25, -0.5]) * (vertices[1] - vertices[0]);
        let point = point + rng.pick(&[0.0, 0.25, 0.5]) * (vertices[2] - vertices[0]);
        (scale_point(point, k), vertices.map(|v| scale_point(v, k)))
    });
    assert!(counts.iter().all(|&n| n > 400), "{counts:?}");
}

#[test]
fn a_point_that_is_not_finite_is_outside() {
    let triangle = Triangle::new(DVec3::ZERO, DVec3::X, DVec3::Y).unwrap();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let point = DVec3::new(0.25, bad, 0.0);
        assert_eq!(inside_triangle(point, &triangle), PointInTriangle::Outside);
        assert_eq!(triangle.barycentric(point), None);
        assert!(!triangle.is_coplanar(point));
    }
}
