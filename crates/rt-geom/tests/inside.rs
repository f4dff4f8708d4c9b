//! Whether a point is inside a triangle, or in its plane, is exact, and its barycentric weights are correctly rounded, for
//! every finite input.

mod reference;

use std::cmp::Ordering;

use glam::DVec3;
use reference::{Rng, cases, cross, dot, is_rounded_quotient, minus, scale_vector, vector};
use rt_geom::{Inside, Triangle, inside_triangle};

fn check(point: DVec3, [a, b, c]: [DVec3; 3]) -> Inside {
    let triangle = Triangle::new(a, b, c).unwrap();
    let [a, b, c, p] = [a, b, c, point].map(vector);
    let n = cross(&minus(&b, &a), &minus(&c, &a));
    let turns = [(&b, &c), (&c, &a), (&a, &b)].map(|(from, to)| dot(&n, &cross(&minus(to, from), &minus(&p, from))));
    let square = dot(&n, &n);
    let degenerate = square.sign() == Ordering::Equal;
    let signs = [0, 1, 2].map(|i| turns[i].sign());
    let zeros = signs.iter().filter(|&&sign| sign == Ordering::Equal).count();
    let expected = match zeros {
        _ if degenerate || signs.contains(&Ordering::Less) => Inside::Outside,
        0 => Inside::Interior,
        1 => Inside::Edge,
        _ => Inside::Vertex,
    };
    assert_eq!(inside_triangle(point, &triangle), expected, "{point:?} {triangle:?}");
    let coplanar = dot(&n, &minus(&p, &a)).sign() == Ordering::Equal;
    assert_eq!(triangle.is_coplanar(point), coplanar, "{point:?} {triangle:?}");
    let weights = triangle.barycentric(point);
    assert_eq!(weights.is_none(), degenerate, "{triangle:?}");
    if let Some(weights) = weights {
        for i in 0..3 {
            let right = is_rounded_quotient(weights[i], &turns[i], &square);
            assert!(right, "{point:?} {triangle:?} gives {weights:?}");
        }
    }
    expected
}

/// Runs a class; returns how many points were interior, on an edge, at a vertex, outside.
fn run(seed: u64, mut case: impl FnMut(&mut Rng) -> (DVec3, [DVec3; 3])) -> [usize; 4] {
    let mut rng = Rng::new(seed);
    let mut counts = [0; 4];
    for _ in 0..cases() {
        let (point, vertices) = case(&mut rng);
        counts[check(point, vertices) as usize] += 1;
    }
    counts
}

#[test]
fn benign_in_and_off_the_plane() {
    let counts = run(1, |rng| {
        let [a, b, c] = [rng.vector(), rng.vector(), rng.vector()];
        let in_plane = a + rng.uniform() * (b - a) + rng.uniform() * (c - a);
        let off = if rng.bits() & 1 == 0 { DVec3::ZERO } else { 3.0 * rng.uniform() * (b - a).cross(c - a) };
        (in_plane + off, [a, b, c])
    });
    assert!(counts[0] > 1000 && counts[3] > 1000, "{counts:?}");
}

#[test]
fn on_edges_and_vertices_and_above_them() {
    let counts = run(2, |rng| {
        let vertices = [0; 3].map(|_| 12.0 * rng.small_vector(30));
        let i = rng.below(3) as usize;
        let (from, to) = (vertices[i], vertices[(i + 1) % 3]);
        let n = (vertices[1] - vertices[0]).cross(vertices[2] - vertices[0]);
        let point = from + rng.small(12) / 12.0 * (to - from) + rng.small(3) * n;
        let point = if rng.bits() & 3 == 0 { rng.nudge_vector(point, 1) } else { point };
        let k = rng.below(100) - 50;
        (scale_vector(point, k), vertices.map(|v| scale_vector(v, k)))
    });
    assert!(counts.iter().all(|&n| n > 400), "{counts:?}");
}

/// Rounding decides on which side of an edge the point is.
#[test]
fn within_a_rounding_error_of_an_edge() {
    let counts = run(8, |rng| {
        let place = rng.pick(&[0.0, 1.0, 100.0]) * rng.vector();
        let vertices = [rng.vector(), rng.vector(), rng.vector()].map(|v| place + v);
        let i = rng.below(3) as usize;
        let point = vertices[i] + rng.uniform().abs() * (vertices[(i + 1) % 3] - vertices[i]);
        (rng.nudge_vector(point, 1), vertices)
    });
    assert!(counts[0] > 1000 && counts[3] > 1000, "{counts:?}");
}

/// All in the plane z = x + 3 y, with products too long for a double.
#[test]
fn in_the_plane_exactly() {
    run(9, |rng| {
        let mut point = || {
            let mut part = || f64::from(rng.below(1 << 25)) * 33_554_393.0 - 2f64.powi(49);
            let (x, y) = (part(), part());
            DVec3::new(x, y, x + 3.0 * y)
        };
        (point(), [point(), point(), point()])
    });
}

#[test]
fn slivers_and_triangles_without_area() {
    run(3, |rng| {
        let (a, along) = (rng.vector(), rng.vector());
        let c = a + rng.uniform() * along + rng.vector() * 2f64.powi(-rng.below(60));
        (a + rng.uniform() * along, [a, a + along, c])
    });
    run(4, |rng| {
        let (a, along) = (rng.small_vector(50), rng.small_vector(5));
        (a + rng.small(5) * along, [a, a + rng.small(5) * along, a + rng.small(5) * along])
    });
}

#[test]
fn far_points_and_every_exponent() {
    run(5, |rng| {
        let vertices = [rng.vector(), rng.vector(), rng.vector()];
        (rng.vector() * 10f64.powi(rng.below(17)), vertices)
    });
    run(6, |rng| (rng.finite_vector(), [0; 3].map(|_| rng.finite_vector())));
    let counts = run(7, |rng| {
        let k = rng.below(2090) - 1070;
        let vertices = [0; 3].map(|_| rng.small_vector(3) / 2.0);
        let point = vertices[0] + rng.pick(&[0.0, 0.25, -0.5]) * (vertices[1] - vertices[0]);
        let point = point + rng.pick(&[0.0, 0.25, 0.5]) * (vertices[2] - vertices[0]);
        (scale_vector(point, k), vertices.map(|v| scale_vector(v, k)))
    });
    assert!(counts.iter().all(|&n| n > 400), "{counts:?}");
}

#[test]
fn a_point_that_is_not_finite_is_outside() {
    let triangle = Triangle::new(DVec3::ZERO, DVec3::X, DVec3::Y).unwrap();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let point = DVec3::new(0.25, bad, 0.0);
        assert_eq!(inside_triangle(point, &triangle), Inside::Outside);
        assert_eq!(triangle.barycentric(point), None);
        assert!(!triangle.is_coplanar(point));
    }
}
