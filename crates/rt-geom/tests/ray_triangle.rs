//! How a ray meets a triangle is exact, and `t` and the barycentric weights of the hit are correctly rounded, for every
//! finite input.

use std::cmp::Ordering;

use glam::DVec3;
use oracle::{
    Crossing, Place, Random, cases, cross, dot, exact, holds, is_rounded_quotient, scale, scale_point, sign, sub,
    vector,
};
use rt_geom::{Ray, Triangle, Verdict};

/// Random cases per class with `RT_LONG`, instead of ten thousand.
const LONG: usize = 500_000;

/// The verdict on the whole line.
fn verdict(place: Place) -> Verdict {
    match place {
        Place::Degenerate => Verdict::Degenerate,
        Place::Parallel => Verdict::Parallel,
        Place::Miss => Verdict::Miss,
        Place::Interior => Verdict::Interior,
        Place::Edge(i) => Verdict::Edge(i),
        Place::Vertex(i) => Verdict::Vertex(i),
    }
}

fn check(origin: DVec3, direction: DVec3, [a, b, c]: [DVec3; 3], rng: &mut Random) -> Option<Verdict> {
    let (ray, triangle) = (Ray::new(origin, direction).ok()?, Triangle::new(a, b, c).ok()?);
    let truth = Crossing::new(&vector(direction), [a, b, c].map(|v| sub(&vector(v), &vector(origin))));
    let context = || format!("{ray:?} {triangle:?}");

    let hit = truth.place().is_hit();
    let expected = if hit && !truth.is_ahead() { Verdict::Miss } else { verdict(truth.place()) };
    assert_eq!(triangle.verdict(&ray), expected, "{}", context());
    assert_eq!(triangle.crosses(&ray), truth.crosses(), "{}", context());
    assert_eq!(triangle.is_degenerate(), truth.place() == Place::Degenerate, "{}", context());

    let whole = triangle.closest(&ray, f64::NEG_INFINITY..f64::INFINITY);
    assert_eq!(whole.is_some(), hit, "{}", context());
    if let Some(t) = whole {
        assert!(is_rounded_quotient(t, &truth.height, &truth.slope), "t = {t:e}: {}", context());
    }
    let some = whole.unwrap_or(0.5);
    let ends = [f64::NEG_INFINITY, -0.0, 0.0, some, some.next_up(), some.next_down(), f64::INFINITY, f64::NAN];
    let ranges =
        [0.0..f64::INFINITY, f64::from_bits(1)..f64::INFINITY, rng.pick(&ends)..rng.pick(&ends), rng.pick(&ends)..some];
    for within in ranges {
        let expected = whole.filter(|&t| holds(&within, t));
        let found = triangle.closest(&ray, within.clone());
        let same = expected.map(f64::to_bits) == found.map(f64::to_bits);
        assert!(same, "expected {expected:?}, found {found:?} in {within:?}: {}", context());
        assert_eq!(triangle.any(&ray, within.clone()), found.is_some(), "{within:?}: {}", context());
    }
    let weights = triangle.line_barycentric(&ray);
    let both = triangle.closest_with_barycentric(&ray, 0.0..f64::INFINITY);
    let each = triangle.closest(&ray, 0.0..f64::INFINITY).zip(weights);
    assert_eq!(format!("{both:?}"), format!("{each:?}"), "{}", context());
    assert_eq!(weights.is_some(), hit, "{}", context());
    if let Some(weights) = weights {
        for i in 0..3 {
            let right = is_rounded_quotient(weights[i], &truth.volumes[i], &truth.slope);
            assert!(right, "weights {weights:?}: {}", context());
        }
    }
    Some(expected)
}

#[derive(Default, Debug)]
struct Counts {
    miss: usize,
    interior: usize,
    edge: usize,
    vertex: usize,
    parallel: usize,
    degenerate: usize,
}

fn run(seed: u64, mut case: impl FnMut(&mut Random) -> (DVec3, DVec3, [DVec3; 3])) -> Counts {
    let mut rng = Random::new(seed);
    let mut counts = Counts::default();
    for _ in 0..cases(LONG) {
        let (origin, direction, vertices) = case(&mut rng);
        match check(origin, direction, vertices, &mut rng) {
            Some(Verdict::Miss) => counts.miss += 1,
            Some(Verdict::Interior) => counts.interior += 1,
            Some(Verdict::Edge(_)) => counts.edge += 1,
            Some(Verdict::Vertex(_)) => counts.vertex += 1,
            Some(Verdict::Parallel) => counts.parallel += 1,
            Some(Verdict::Degenerate) => counts.degenerate += 1,
            None => {}
        }
    }
    counts
}

fn triangle(rng: &mut Random) -> [DVec3; 3] {
    [rng.point(), rng.point(), rng.point()]
}

/// A point of the triangle's plane, most often near the triangle.
fn aim(rng: &mut Random, [a, b, c]: [DVec3; 3]) -> DVec3 {
    let (v, w) = (0.7 * rng.uniform() + 0.4, 0.7 * rng.uniform() + 0.4);
    a + v * (b - a) + w * (c - a)
}

#[test]
fn benign() {
    let counts = run(1, |rng| {
        let vertices = triangle(rng);
        let origin = 3.0 * rng.point();
        (origin, aim(rng, vertices) - origin, vertices)
    });
    assert!(counts.interior > 1000 && counts.miss > 1000, "{counts:?}");
}

/// Small integer coordinates: the ray through a point of an edge, a vertex or the interior, exactly or nudged.
#[test]
fn through_edges_and_vertices() {
    let counts = run(2, |rng| {
        let vertices = [0; 3].map(|_| 12.0 * rng.small_point(50));
        let i = rng.below(3);
        let (a, b, c) = (vertices[i], vertices[(i + 1) % 3], vertices[(i + 2) % 3]);
        let s = f64::from(rng.integer(0..13)) / 12.0;
        let target = match rng.below(4) {
            0 => a,
            1 | 2 => a + s * (b - a),
            _ => a + (b - a) / 3.0 + (c - a) / 4.0,
        };
        let direction = rng.small_point(100);
        let origin = target - rng.small(100) * direction;
        let k = rng.integer(-40..40);
        let nudge = u64::from(rng.one_in(4));
        let (origin, direction) = (rng.nudge_point(origin, nudge), rng.nudge_point(direction, nudge));
        (scale_point(origin, k), direction, vertices.map(|v| scale_point(v, k)))
    });
    assert!(counts.edge > 1000 && counts.vertex > 1000 && counts.interior > 1000, "{counts:?}");
}

/// Rounding decides on which side of an edge the line passes.
#[test]
fn within_a_rounding_error_of_an_edge() {
    let counts = run(3, |rng| {
        let vertices = triangle(rng);
        let s = rng.uniform().abs() * 1.1 - 0.05;
        let target = vertices[0] + s * (vertices[1] - vertices[0]);
        let origin = rng.point_with_exponent(0..20);
        (origin, target - origin, vertices)
    });
    assert!(counts.interior > 1000 && counts.miss > 1000, "{counts:?}");
}

#[test]
fn slivers() {
    let counts = run(4, |rng| {
        let (a, along) = (rng.point(), rng.point());
        let b = a + along;
        let c = a + rng.uniform() * along + rng.point() * 2f64.powi(-rng.integer(0..60));
        let vertices = [a, b, if rng.bits() & 3 == 0 { rng.nudge_point(a, 3) } else { c }];
        let origin = 3.0 * rng.point();
        (origin, aim(rng, vertices) - origin, vertices)
    });
    assert!(counts.miss > 1000 && counts.interior > 500, "{counts:?}");
}

#[test]
fn without_area() {
    let counts = run(5, |rng| {
        let (a, along) = (rng.small_point(100), rng.small_point(10));
        let vertices = [a, a + rng.small(10) * along, a + rng.small(10) * along];
        let origin = rng.small_point(100);
        (origin, vertices[rng.below(3)] - origin, vertices)
    });
    assert!(counts.degenerate > 1000, "{counts:?}");
}

/// Vertices on a line, exactly, although their differences are rounded.
#[test]
fn without_area_but_for_rounding() {
    let counts = run(15, |rng| {
        let along = rng.pick(&[DVec3::new(1.0, 3.0, 5.0), DVec3::new(-3.0, 5.0, 7.0), DVec3::new(5.0, 1.0, -7.0)]);
        // 49 bits, so that seven times as much is a double.
        let vertices =
            [0; 3].map(|_| scale(f64::from(rng.integer(0..1 << 24)) * 33_554_393.0, -rng.integer(0..8)) * along);
        let origin = scale_point(rng.point(), 50);
        (origin, vertices[0] - origin, vertices)
    });
    assert!(counts.degenerate > 9000, "{counts:?}");
}

/// The report's plane form does not exist for these.
#[test]
fn planes_through_the_origin() {
    let counts = run(6, |rng| {
        let (e, f) = (rng.small_point(10), rng.small_point(10));
        let vertices = [0; 3].map(|_| rng.small(10) * e + rng.small(10) * f);
        let origin = if rng.bits() & 1 == 0 { DVec3::ZERO } else { rng.small_point(10) };
        (origin, (vertices[0] + vertices[1] + vertices[2]) / 3.0 - origin + rng.small_point(2), vertices)
    });
    assert!(counts.interior > 1000 && counts.parallel > 20, "{counts:?}");
}

#[test]
fn along_the_plane_or_nearly() {
    let counts = run(7, |rng| {
        let vertices = [0; 3].map(|_| 6.0 * rng.small_point(30));
        let [a, b, c] = vertices;
        let inside = rng.small(6) / 6.0 * (b - a) + rng.small(6) / 6.0 * (c - a);
        let mut direction = rng.small(6) * (b - a) + rng.small(6) * (c - a);
        let mut origin = a + inside - direction;
        match rng.below(4) {
            0 => origin = rng.nudge_point(origin, 1),
            1 => direction = rng.nudge_point(direction, 1),
            2 => origin += rng.small_point(1),
            _ => {}
        }
        (origin, direction, vertices)
    });
    assert!(counts.parallel > 1000 && counts.miss > 1000, "{counts:?}");
}

#[test]
fn small_and_far() {
    let counts = run(8, |rng| {
        let place = rng.point() * 10f64.powi(rng.integer(0..12));
        let vertices = triangle(rng).map(|v| place + v);
        let origin = rng.point();
        (origin, (aim(rng, vertices) - origin) * rng.with_exponent(-40..40), vertices)
    });
    assert!(counts.interior > 1000 && counts.miss > 1000, "{counts:?}");
}

#[test]
fn every_exponent() {
    run(9, |rng| (rng.finite_point(), rng.finite_point(), [0; 3].map(|_| rng.finite_point())));
    run(10, |rng| {
        // one huge or tiny number in a plain triangle
        let mut vertices = triangle(rng);
        let (mut origin, mut direction) = (rng.point(), rng.point());
        let (at, axis) = (rng.below(5), rng.below(3));
        let odd = rng.finite();
        match at {
            0 => origin[axis] = odd,
            1 => direction[axis] = odd,
            i => vertices[i - 2][axis] = odd,
        }
        (origin, direction, vertices)
    });
}

#[test]
fn scenes_scaled_to_the_ends_of_the_range() {
    let counts = run(11, |rng| {
        let (k, l) = (rng.integer(-1070..1020), rng.integer(-1070..1020));
        let vertices = if rng.bits() & 1 == 0 { triangle(rng) } else { [0; 3].map(|_| rng.small_point(3) / 2.0) };
        let origin = rng.small_point(8) / 4.0;
        let target = if rng.bits() & 1 == 0 { vertices[0] } else { aim(rng, vertices) };
        (scale_point(origin, k), scale_point(target - origin, l), vertices.map(|v| scale_point(v, k)))
    });
    assert!(counts.interior > 1000 && counts.miss > 1000, "{counts:?}");
}

/// Heights over slopes that are powers of two, a bit too long for a double.
#[test]
fn t_halfway_between_doubles() {
    run(12, |rng| {
        let z = rng.with_exponent(0..3);
        let origin = DVec3::new(0.0, 0.0, rng.with_exponent(-4..6));
        let vertices = [DVec3::new(-1.0, -1.0, z), DVec3::new(3.0, -1.0, z), DVec3::new(-1.0, 3.0, z)];
        let turn = rng.below(3);
        let turned = |v: DVec3| DVec3::from_array([0, 1, 2].map(|i| v[(i + turn) % 3]));
        (turned(origin), turned(DVec3::new(0.0, 0.0, rng.pick(&[1.0, -2.0, 0.25]))), vertices.map(turned))
    });
}

#[test]
fn origin_in_the_triangle() {
    let counts = run(13, |rng| {
        let vertices = [0; 3].map(|_| 12.0 * rng.small_point(20));
        let [a, b, c] = vertices;
        let (v, w) = (f64::from(rng.integer(0..7)) / 6.0, f64::from(rng.integer(0..5)) / 4.0);
        let origin = a + v * (b - a) + w * (c - a);
        (if rng.bits() & 1 == 0 { origin } else { rng.nudge_point(origin, 1) }, rng.point(), vertices)
    });
    assert!(counts.interior > 1000 && counts.edge > 100, "{counts:?}");
}

/// Rounding decides on which side of the plane the ray starts.
#[test]
fn origin_within_a_rounding_error_of_the_triangle() {
    let counts = run(16, |rng| {
        let place = rng.pick(&[0.0, 1.0, 100.0]) * rng.point();
        let vertices = triangle(rng).map(|v| place + v);
        let [a, b, c] = vertices;
        let (v, w) = (0.5 * rng.uniform().abs(), 0.5 * rng.uniform().abs());
        (rng.nudge_point(a + v * (b - a) + w * (c - a), 1), rng.point(), vertices)
    });
    assert!(counts.interior > 1000 && counts.miss > 1000, "{counts:?}");
}

#[test]
fn normals_are_unit_vectors_at_right_angles_to_the_edges() {
    const U: f64 = f64::EPSILON / 2.0;
    let mut rng = Random::new(14);
    for i in 0..cases(LONG) {
        let [a, b, mut c] = triangle(&mut rng);
        if i % 2 == 0 {
            // a sliver, down to a rounding error
            c = a + rng.uniform() * (b - a) + 2f64.powi(-rng.integer(0..60)) * rng.point();
        }
        let k = rng.integer(-1068..1022);
        let [a, b, c] = [a, b, c].map(|v| scale_point(v, k));
        let triangle = Triangle::new(a, b, c).unwrap();
        let [a, b, c] = [a, b, c].map(vector);
        let exact_normal = cross(&sub(&b, &a), &sub(&c, &a));
        let Some(normal) = triangle.normal() else {
            assert!(exact_normal.iter().all(|x| sign(x) == Ordering::Equal), "{triangle:?}");
            continue;
        };
        // |normal x n| <= 4.6 u |n|, and normal . n > 0
        let normal = vector(normal);
        let (off, bound) = (cross(&normal, &exact_normal), exact(4.6 * U));
        assert!(dot(&off, &off) <= &bound * &bound * dot(&exact_normal, &exact_normal), "{triangle:?}");
        assert_eq!(sign(&dot(&normal, &exact_normal)), Ordering::Greater, "{triangle:?}");
        let (excess, limit) = (dot(&normal, &normal) - exact(1.0), exact(8.3 * U));
        assert!(excess < limit && -excess < limit, "{triangle:?}");
    }
}
