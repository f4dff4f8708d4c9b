//! How often a line meets a sphere, whether a ray does in a range, and on which side a point lies are exact, and every
//! `t` is correctly rounded, for every finite input.

use std::cmp::Ordering;

use glam::DVec3;
use oracle::{
    Quadratic, Random, cases, cross, dot, exact, holds, is_rounding_of, scale, scale_point, sphere_equation, sub,
    vector,
};
use rt_geom::{Ray, Side, Sphere};
use rt_math::Roots;

/// Random cases per class with `RT_LONG`, instead of ten thousand.
const LONG: usize = 500_000;

fn equation(ray: &Ray, sphere: &Sphere) -> Quadratic {
    let offset = sub(&vector(ray.origin()), &vector(sphere.center()));
    sphere_equation(&vector(ray.direction()), &offset, &exact(sphere.radius()))
}

/// Checks everything about one line and one sphere; returns the number of roots.
fn check(origin: DVec3, direction: DVec3, center: DVec3, radius: f64, rng: &mut Random) -> usize {
    let (Ok(ray), Ok(sphere)) = (Ray::new(origin, direction), Sphere::new(center, radius)) else {
        return 0;
    };
    let equation = equation(&ray, &sphere);
    let roots = sphere.roots(&ray);
    let context = || format!("{ray:?} {sphere:?} gives {roots:?}");
    let list = match roots {
        Roots::One(t) => vec![t],
        Roots::Two(near, far) => vec![near, far],
        Roots::None | Roots::All => vec![],
    };
    assert_eq!(Some(list.len()), equation.count(), "{}", context());
    for (i, &t) in list.iter().enumerate() {
        assert!(is_rounding_of(t, |x| equation.compare(i == 1, x)), "root {i}: {}", context());
    }
    // every kind of end that a root can meet
    let some = if list.is_empty() { rng.uniform() } else { rng.pick(&list) };
    let ends = [f64::NEG_INFINITY, -0.0, 0.0, some, some.next_up(), some.next_down(), f64::INFINITY, f64::NAN];
    let random = |rng: &mut Random| rng.pick(&ends);
    let ranges = [0.0..f64::INFINITY, f64::from_bits(1)..f64::INFINITY, random(rng)..random(rng), random(rng)..some];
    for within in ranges {
        let expected = list.iter().copied().find(|&t| holds(&within, t));
        let found = sphere.closest(&ray, within.clone());
        let same = expected.map(f64::to_bits) == found.map(f64::to_bits);
        assert!(same, "expected {expected:?}, found {found:?} in {within:?}: {}", context());
        assert_eq!(sphere.any(&ray, within.clone()), found.is_some(), "{within:?}: {}", context());
    }
    let side = match oracle::sign(&equation.c) {
        Ordering::Less => Side::Inside,
        Ordering::Equal => Side::On,
        Ordering::Greater => Side::Outside,
    };
    assert_eq!(sphere.side(origin), side, "{sphere:?} {origin:?}");
    list.len()
}

/// Runs a class; returns how many cases had 0, 1 and 2 roots.
fn run(seed: u64, mut case: impl FnMut(&mut Random) -> (DVec3, DVec3, DVec3, f64)) -> [usize; 3] {
    let mut rng = Random::new(seed);
    let mut counts = [0; 3];
    for _ in 0..cases(LONG) {
        let (origin, direction, center, radius) = case(&mut rng);
        counts[check(origin, direction, center, radius, &mut rng)] += 1;
    }
    counts
}

/// Three vectors at right angles, each of length 3, with integer components, in a random arrangement.
fn integer_frame(rng: &mut Random) -> [DVec3; 3] {
    let mut frame = [DVec3::new(1.0, 2.0, 2.0), DVec3::new(2.0, -2.0, 1.0), DVec3::new(2.0, 1.0, -2.0)];
    rng.shuffle(&mut frame);
    let turn = rng.below(3);
    frame.map(|v| DVec3::new(v[turn], v[(turn + 1) % 3], v[(turn + 2) % 3]))
}

fn distance_to_line(point: DVec3, origin: DVec3, direction: DVec3) -> f64 {
    (point - origin).cross(direction).length() / direction.length()
}

#[test]
fn benign() {
    let counts = run(1, |rng| {
        let (origin, center, radius) = (10.0 * rng.point(), 10.0 * rng.point(), 6.0 * rng.uniform().abs());
        (origin, center + 1.5 * radius * rng.point() - origin, center, radius)
    });
    assert!(counts[0] > 1000 && counts[2] > 1000, "{counts:?}");
}

#[test]
fn tangent_exactly_and_within_a_few_ulps() {
    let counts = run(2, |rng| {
        let [p, e1, e2] = integer_frame(rng);
        let size = rng.whole(1, 1000);
        let direction = rng.small(50) * e1 + rng.small(50) * e2;
        let center = rng.small_point(1000);
        let origin = center + size * p + rng.small(1000) * direction;
        let (mut origin, mut radius, mut center) = (origin, 3.0 * size, center);
        match rng.below(6) {
            0 => radius = rng.nudge(radius, 1),
            1 => origin = rng.nudge_point(origin, 1),
            2 => center.x = rng.nudge(center.x, 2),
            _ => {}
        }
        let k = rng.integer(-30..30);
        (scale_point(origin, k), direction, scale_point(center, k), scale(radius, k))
    });
    assert!(counts.iter().all(|&n| n > 1000), "{counts:?}");
}

#[test]
fn nearly_tangent() {
    let counts = run(3, |rng| {
        let size = [1, 20, 60, 200][rng.below(4)];
        let origin = rng.point_with_exponent(0..size);
        let (direction, center) = (rng.point(), rng.point());
        let radius = distance_to_line(center, origin, direction);
        (origin, direction, center, rng.nudge(radius, 3).abs())
    });
    assert!(counts[0] > 1000 && counts[2] > 1000, "{counts:?}");
}

#[test]
fn origin_on_the_surface_or_just_off() {
    run(4, |rng| {
        let (direction, center) = (rng.point(), rng.small_point(100));
        if rng.bits() & 1 == 0 {
            let size = rng.whole(1, 1000);
            let p = size * integer_frame(rng)[0];
            let origin = center + p;
            (if rng.bits() & 1 == 0 { origin } else { rng.nudge_point(origin, 1) }, direction, center, 3.0 * size)
        } else {
            let origin = center + rng.point_with_exponent(-20..20);
            let radius = rng.nudge((origin - center).length(), 2);
            (origin, direction, center, radius)
        }
    });
}

#[test]
fn small_and_far() {
    let counts = run(5, |rng| {
        let center = rng.point() * 10f64.powi(rng.integer(0..16));
        let radius = rng.uniform().abs();
        let origin = rng.point();
        let offset = 1.5 * radius * rng.point();
        (origin, (center + offset - origin) * rng.with_exponent(-40..40), center, radius)
    });
    assert!(counts[0] > 1000 && counts[2] > 1000, "{counts:?}");
}

#[test]
fn huge_ground() {
    let counts = run(6, |rng| {
        let radius = 10f64.powi(rng.integer(3..16)) * (1.0 + rng.uniform().abs());
        let origin = rng.point();
        let center = DVec3::new(rng.uniform(), -radius + rng.uniform(), rng.uniform());
        let mut direction = rng.point();
        direction.y *= 10f64.powi(-rng.integer(0..8));
        (origin, direction, center, radius)
    });
    assert!(counts[2] > 1000, "{counts:?}");
}

#[test]
fn radius_zero() {
    let counts = run(7, |rng| {
        let (origin, direction) = (rng.small_point(1000), rng.small_point(20));
        let center = origin + rng.small(1000) * direction;
        let center = if rng.bits() & 3 == 0 { rng.nudge_point(center, 1) } else { center };
        (origin, direction, center, if rng.bits() & 7 == 0 { f64::from_bits(1) } else { 0.0 })
    });
    assert!(counts[1] > 1000, "{counts:?}");
}

#[test]
fn every_exponent() {
    run(8, |rng| (rng.finite_point(), rng.finite_point(), rng.finite_point(), rng.finite().abs()));
    let counts = run(9, |rng| {
        let e = rng.integer(-1000..1000);
        let range = e - 3..e + 3;
        let f = rng.integer(-1000..1000);
        (
            rng.point_with_exponent(range.clone()),
            rng.point_with_exponent(f - 2..f + 2),
            rng.point_with_exponent(range.clone()),
            rng.with_exponent(range).abs(),
        )
    });
    assert!(counts[0] > 1000 && counts[2] > 1000, "{counts:?}");
}

#[test]
fn scenes_scaled_to_the_ends_of_the_range() {
    let counts = run(10, |rng| {
        let (k, l) = (rng.integer(-1070..1020), rng.integer(-1070..1020));
        let radius = rng.uniform().abs();
        let center = 3.0 * rng.point();
        let origin = 3.0 * rng.point();
        let direction = center + 1.5 * radius * rng.point() - origin;
        (scale_point(origin, k), scale_point(direction, l), scale_point(center, k), scale(radius, k))
    });
    assert!(counts[0] > 1000 && counts[2] > 1000, "{counts:?}");
}

#[test]
fn roots_halfway_between_doubles() {
    let counts = run(11, |rng| {
        // along an axis the roots are center -+ radius, of up to 60 bits or so
        let e = rng.integer(-20..20);
        let center = rng.with_exponent(e..e + 2);
        let radius = rng.with_exponent(e - 8..e + 2).abs();
        let axis = rng.below(3);
        let (mut c, mut d) = (DVec3::ZERO, DVec3::ZERO);
        (c[axis], d[axis]) = (center, [1.0, -2.0, 0.5][rng.below(3)]);
        (DVec3::ZERO, d, c, radius)
    });
    assert_eq!(counts[1], 0);
}

#[test]
fn from_inside_or_with_the_sphere_behind() {
    run(12, |rng| {
        let center = rng.point();
        let radius = 0.2 + rng.uniform().abs();
        let origin = center + radius * 10f64.powi(rng.integer(-1..2)) * rng.point();
        (origin, (origin - center) * rng.with_exponent(-3..3) + 0.3 * rng.point(), center, radius)
    });
}

/// A far sensor on a small sphere: single-precision tracers show rings of noise and a wrong silhouette.
#[test]
fn the_silhouette_of_a_far_small_sphere_is_the_exact_one() {
    for distance in [1e3, 1e8] {
        let sphere = Sphere::new(DVec3::ZERO, 1.0).unwrap();
        let (size, mut hits) = (160, 0);
        for i in 0..size {
            for j in 0..size {
                let at = |k: i32| (f64::from(k) + 0.5) / f64::from(size) * 2.2 - 1.1;
                let origin = DVec3::new(0.0, 0.0, distance);
                let ray = Ray::new(origin, DVec3::new(at(i), at(j), 0.0) - origin).unwrap();
                let expected = equation(&ray, &sphere).count() != Some(0);
                assert_eq!(sphere.any(&ray, 0.0..f64::INFINITY), expected, "{ray:?}");
                hits += i32::from(expected);
            }
        }
        let area = f64::from(hits) / f64::from(size * size) * 2.2 * 2.2;
        assert!((area - std::f64::consts::PI).abs() < 0.02, "the disc has area {area}");
    }
}

/// A unit sphere seen from 100 units: no hit is on its back.
#[test]
fn a_sphere_is_never_hit_on_its_back_first() {
    let mut rng = Random::new(13);
    let mut hits = 0;
    for _ in 0..cases(LONG) {
        let origin = 100.0 * rng.point().normalize();
        let sphere = Sphere::new(0.01 * rng.point(), 1.0).unwrap();
        let ray = Ray::new(origin, 0.9 * rng.point() - origin).unwrap();
        if let Some(t) = sphere.closest(&ray, 0.0..f64::INFINITY) {
            hits += 1;
            let facing = (ray.at(t) - sphere.center()).dot(ray.direction());
            assert!(facing < 0.0 || matches!(sphere.roots(&ray), Roots::One(_)), "{ray:?} {sphere:?}");
        }
    }
    assert!(hits > cases(LONG) / 4, "{hits}");
}

/// A grazing ray that an interval test with "maybe below zero means miss" drops.
#[test]
fn a_grazing_hit_does_not_vanish() {
    let sphere = Sphere::new(DVec3::ZERO, 1.0).unwrap();
    for (height, count) in [(1f64.next_down(), 2), (1.0, 1), (1f64.next_up(), 0)] {
        let ray = Ray::new(DVec3::new(-1e6, height, 0.0), DVec3::X).unwrap();
        let found = match sphere.roots(&ray) {
            Roots::None => 0,
            Roots::One(_) => 1,
            _ => 2,
        };
        assert_eq!(found, count, "at height {height}");
    }
}

#[test]
fn a_ray_that_starts_on_the_surface_has_the_root_zero_and_leaves() {
    let mut rng = Random::new(14);
    for _ in 0..1000 {
        let p = integer_frame(&mut rng)[0];
        let sphere = Sphere::new(DVec3::ZERO, 3.0).unwrap();
        let outward = p + 0.5 * rng.point();
        let ray = Ray::new(p, outward).unwrap();
        assert_eq!(sphere.closest(&ray, 0.0..f64::INFINITY).map(f64::to_bits), Some(0), "{ray:?}");
        assert_eq!(sphere.closest(&ray, f64::from_bits(1)..f64::INFINITY), None, "{ray:?}");
    }
}

#[test]
fn normals_and_hit_points_keep_their_bounds() {
    const U: f64 = f64::EPSILON / 2.0;
    let mut rng = Random::new(15);
    for i in 0..cases(LONG) {
        // The largest differences overflow.
        let k = if i % 8 == 0 { 1023 } else { rng.integer(-1068..1020) };
        let radius = scale(0.5 + rng.uniform().abs(), k);
        let center = scale_point(rng.point(), k);
        let sphere = Sphere::new(center, radius).unwrap();
        let point = scale_point(2.0 * rng.point(), k);
        if point == center {
            continue;
        }
        let normal = sphere.normal(point);
        // |n| within the bound of 1, and n parallel to w: |n x w|² <= (bound |w|)²
        let (n, w) = (vector(normal), sub(&vector(point), &vector(center)));
        let bound = exact(4.6 * U);
        let x = cross(&n, &w);
        let limit = &bound * &bound * dot(&w, &w);
        assert!(dot(&x, &x) <= limit, "{sphere:?} {point:?} gives {normal:?}");
        let (excess, limit) = (dot(&n, &n) - exact(1.0), exact(8.3 * U));
        assert!(excess < limit && -excess < limit, "{normal:?}");
    }
    let point = Sphere::new(DVec3::ONE, 0.0).unwrap();
    assert!(point.normal(DVec3::ONE).is_nan());
}
