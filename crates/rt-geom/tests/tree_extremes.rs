//! The trees give the plain loop's answer, bit for bit, from one end of the range of doubles to the other: for scenes
//! of any size and place, directions of any length, and ranges that end within a few doubles of a hit.
//!
//! `RT_LONG=1` casts 300,000 rays.

use std::ops::Range;

use glam::DVec3;
use oracle::{Random, holds, scale, scale_point};
use rt_geom::{Bvh, Hit, Ray, Sphere, SphereTree, Triangle};
use rt_math::Roots;

const ALL: Range<f64> = f64::NEG_INFINITY..f64::INFINITY;

struct Scene {
    spheres: Vec<Sphere>,
    triangles: Vec<Triangle>,
    place: DVec3,
    /// The exponent of the size, two to the power of which is about the extent.
    size: i32,
}

/// An exponent of every order of magnitude, more often near the ends.
fn exponent(rng: &mut Random) -> i32 {
    match rng.below(8) {
        0 => rng.integer(-1074..-1010),
        1 => 1022 - rng.integer(0..64),
        2 => rng.integer(-64..64),
        _ => rng.integer(-1074..1022),
    }
}

fn scene(rng: &mut Random) -> Scene {
    let size = exponent(rng);
    let place = match rng.below(4) {
        0 => DVec3::ZERO,
        1 => scale_point(rng.point(), (size + rng.integer(0..8)).min(1022)),
        // Only some bits of the shapes are left.
        2 => scale_point(rng.point(), (size + rng.integer(0..56)).min(1022)),
        _ => {
            let k = exponent(rng);
            scale_point(rng.point(), k)
        }
    };
    let count = if rng.below(64) == 0 { 300 } else { rng.pick(&[1, 3, 6, 17, 20, 33]) };
    let part = rng.pick(&[0.0, 0.5, 1.0]);
    let decades = rng.pick(&[1, 20, 60]);
    let (mut spheres, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..count {
        let at = |rng: &mut Random, k: i32| place + scale_point(rng.point(), k);
        let small = size - rng.integer(0..decades);
        let again = rng.below(4) == 0;
        if f64::from(i) < part * f64::from(count) {
            let radius = scale(rng.uniform().abs(), small);
            let sphere = Sphere::new(at(rng, size), if rng.below(6) == 0 { 0.0 } else { radius }).ok();
            spheres.extend(if again { spheres.last().copied().or(sphere) } else { sphere });
        } else {
            let a = at(rng, size);
            let corner = |rng: &mut Random| a + scale_point(rng.point(), small);
            let triangle = Triangle::new(a, corner(rng), corner(rng)).ok();
            triangles.extend(if again { triangles.last().copied().or(triangle) } else { triangle });
        }
    }
    Scene { spheres, triangles, place, size }
}

/// A direction of any length, down to a few units of the smallest subnormal.
fn direction(rng: &mut Random, size: i32) -> DVec3 {
    match rng.below(8) {
        0 => scale_point(rng.small_point(20), rng.integer(-1074..-1066)),
        1 => scale_point(rng.direction(), rng.integer(-1074..-1010)),
        2 => scale_point(rng.direction(), 1023 - rng.integer(0..16)),
        3 => scale_point(rng.direction(), (size + rng.integer(-20..20)).clamp(-1074, 1023)),
        // The parameters of hits are at the ends of the range.
        4 => scale_point(rng.direction(), (size - 1020 + rng.integer(0..40)).clamp(-1074, 1023)),
        5 => scale_point(rng.direction(), (size + 1074 - rng.integer(0..40)).clamp(-1074, 1023)),
        6 => rng.direction(),
        _ => DVec3::from_array([0; 3].map(|_| {
            let k = exponent(rng);
            scale(rng.uniform(), k)
        })),
    }
}

/// The direction as a unit vector.
fn unit_of(direction: DVec3) -> DVec3 {
    let largest = direction.abs().max_element();
    let k = if largest < 1e-200 { 1000 } else { -((largest.to_bits() >> 52) as i32 - 1023) };
    scale_point(direction, k).normalize()
}

/// A ray that most often meets something, or nearly.
fn ray(rng: &mut Random, scene: &Scene) -> Option<Ray> {
    let Scene { spheres, triangles, place, size } = scene;
    let direction = direction(rng, *size);
    if direction == DVec3::ZERO {
        return None;
    }
    let along = unit_of(direction);
    let target = match rng.below(4) {
        0 => *place + scale_point(rng.point(), *size),
        _ => match (spheres.is_empty(), triangles.is_empty()) {
            (false, all) if all || rng.below(2) == 0 => {
                let sphere = rng.pick(spheres);
                let out = rng.pick(&[0.0, 0.5, 1.0, 1.0 - 1e-12, 1.0 + 1e-12]) * along.any_orthonormal_vector();
                sphere.center() + sphere.radius() * out
            }
            (_, false) => {
                let [a, b, c] = rng.pick(triangles).vertices();
                rng.pick(&[a, 0.5 * a + 0.5 * b, 0.25 * a + 0.25 * b + 0.5 * c])
            }
            _ => *place,
        },
    };
    let far = match rng.below(4) {
        0 => DVec3::ZERO,
        1 => scale_point(along, (size + rng.integer(0..4)).min(1023)),
        2 => scale_point(along, (size + rng.integer(-10..40)).min(1023)),
        _ => {
            let k = exponent(rng);
            scale_point(along, k)
        }
    };
    let origin = if rng.below(3) > 0 { target - far } else { target + far };
    Ray::new(origin, direction).ok()
}

/// Every hit on the whole line, those of a sphere in ascending order, with the indices.
fn all_hits(scene: &Scene, ray: &Ray) -> Vec<Hit> {
    let mut hits = Vec::new();
    for (index, sphere) in scene.spheres.iter().enumerate() {
        match sphere.roots(ray) {
            Roots::One(t) => hits.push(Hit { index, t }),
            Roots::Two(near, far) => hits.extend([near, far].map(|t| Hit { index, t })),
            Roots::None | Roots::All => {}
        }
    }
    for (index, triangle) in (scene.spheres.len()..).zip(&scene.triangles) {
        hits.extend(triangle.closest(ray, ALL).map(|t| Hit { index, t }));
    }
    hits
}

/// The plain loop.
fn closest_of(hits: &[Hit], within: &Range<f64>) -> Option<Hit> {
    let mut best: Option<Hit> = None;
    for &hit in hits.iter().filter(|hit| holds(within, hit.t)) {
        if best.is_none_or(|best| hit.t.total_cmp(&best.t).is_lt()) {
            best = Some(hit);
        }
    }
    best
}

fn bits(hit: Option<Hit>) -> Option<(usize, u64)> {
    hit.map(|hit| (hit.index, hit.t.to_bits()))
}

/// A range of which each end may be near a hit.
fn range(rng: &mut Random, hits: &[Hit]) -> Range<f64> {
    let mut end = |whole: f64| {
        if hits.is_empty() || rng.below(3) == 0 {
            let smallest = f64::from_bits(1);
            rng.pick(&[whole, whole, 0.0, -0.0, smallest, -smallest, f64::MAX, f64::MIN])
        } else {
            let mut t = rng.pick(hits).t;
            for _ in 0..rng.below(4) {
                t = if rng.below(2) == 0 { t.next_up() } else { t.next_down() };
            }
            t
        }
    };
    let (start, end) = (end(f64::NEG_INFINITY), end(f64::INFINITY));
    if start <= end { start..end } else { end..start }
}

#[derive(Debug, Default)]
struct Counts {
    rays: usize,
    hits: usize,
    /// With `t` subnormal, and infinite.
    tiny: usize,
    infinite: usize,
}

/// Casts `rays` rays.
fn compare(seed: u64, rays: usize) -> Counts {
    let mut rng = Random::new(seed);
    let mut counts = Counts::default();
    for turn in 0.. {
        if counts.rays >= rays {
            break;
        }
        let scene = scene(&mut rng);
        let rays: Vec<Ray> = (0..8).filter_map(|_| ray(&mut rng, &scene)).collect();
        counts.rays += rays.len();
        let tree = Bvh::new(scene.spheres.clone(), scene.triangles.clone());
        let level = ["sse2", "avx2", "avx512", "neon"][turn % 4];
        let tree = tree.clone().with_simd(level).unwrap_or(tree);
        let sphere_tree = [SphereTree::new, SphereTree::sorted][turn % 2];
        let sphere_tree = sphere_tree(scene.spheres.clone(), scene.triangles.clone());
        let hits: Vec<Vec<Hit>> = rays.iter().map(|ray| all_hits(&scene, ray)).collect();
        let mut check = |within: &Range<f64>, chosen: Range<usize>| {
            let (rays, hits) = (&rays[chosen.clone()], &hits[chosen]);
            let (mut batch, mut any) = (vec![None; rays.len()], vec![false; rays.len()]);
            tree.closest_batch(rays, within.clone(), &mut batch);
            tree.any_batch(rays, within.clone(), &mut any);
            for (i, ray) in rays.iter().enumerate() {
                let expected = closest_of(&hits[i], within);
                let message = || {
                    let Scene { spheres, triangles, .. } = &scene;
                    format!("{level} {within:?} {ray:?}\n{spheres:?}\n{triangles:?}")
                };
                let (expected, is_hit) = (bits(expected), expected.is_some());
                counts.hits += usize::from(is_hit);
                assert_eq!(bits(tree.closest(ray, within.clone())), expected, "{}", message());
                assert_eq!(tree.any(ray, within.clone()), is_hit, "any: {}", message());
                assert_eq!(bits(batch[i]), expected, "batch: {}", message());
                assert_eq!(any[i], is_hit, "batch of any: {}", message());
                let found = bits(sphere_tree.closest(ray, within.clone()));
                assert_eq!(found, expected, "sphere tree: {}", message());
                assert_eq!(sphere_tree.any(ray, within.clone()), is_hit, "sphere tree, any: {}", message());
            }
        };
        check(&(0.0..f64::INFINITY), 0..rays.len());
        check(&ALL, 0..rays.len());
        for (i, hits) in hits.iter().enumerate() {
            check(&range(&mut rng, hits), i..i + 1);
            check(&range(&mut rng, hits), i..i + 1);
        }
        for hit in hits.iter().flatten() {
            counts.tiny += usize::from(hit.t.is_subnormal());
            counts.infinite += usize::from(hit.t.is_infinite());
        }
    }
    counts
}

#[test]
fn every_tree_gives_the_plain_loops_hit() {
    let rays = if std::env::var_os("RT_LONG").is_some() { 300_000 } else { 2_000 };
    let counts = compare(1, rays);
    assert!(counts.hits > rays, "{counts:?}");
    assert!(counts.tiny > rays / 20 && counts.infinite > rays / 20, "{counts:?}");
}

/// Balls in a row, each a step from the last.
fn row(step: DVec3, radius: f64) -> Vec<Sphere> {
    (0..40).map(|i| Sphere::new(step * f64::from(i), radius).unwrap()).collect()
}

/// The direction's length in doubles keeps two or three bits, but times the frame's scale it is an ordinary number.
#[test]
fn a_direction_of_a_few_units_of_the_smallest_double_in_a_small_scene() {
    let smallest = f64::from_bits(1);
    for (x, y) in [(1.0, 1.0), (2.0, 1.0), (3.0, 2.0), (1.0, -4.0)] {
        let along = DVec3::new(x, y, 0.0);
        let tree = Bvh::new(row(along * 1e-20, 2e-21), vec![]);
        let ray = Ray::new(along * 1e-18, along * -smallest).unwrap();
        let t = tree.closest(&ray, ALL).unwrap().t;
        for within in [0.0..f64::INFINITY, t..t.next_up(), 0.0..t.next_up(), t..f64::INFINITY] {
            assert_eq!(tree.closest(&ray, within.clone()), Some(Hit { index: 39, t }), "{within:?} {ray:?}");
        }
        assert_eq!(tree.closest(&ray, 0.0..t), None, "{ray:?}");
    }
}

/// All parameters are beyond the most negative double, so that they are equal, however far apart the balls are.
#[test]
fn hits_at_minus_infinity_are_equal() {
    let tree = Bvh::new(row(DVec3::X, 0.25), vec![]);
    let (listed, sorted) =
        (SphereTree::new(row(DVec3::X, 0.25), vec![]), SphereTree::sorted(row(DVec3::X, 0.25), vec![]));
    for direction in [1e-300, -1e-300] {
        let origin = DVec3::X * (direction * 1e300) * 1e9;
        let ray = Ray::new(origin, DVec3::X * direction).unwrap();
        let expected = Some(Hit { index: 0, t: f64::NEG_INFINITY });
        assert_eq!(tree.closest(&ray, ALL), expected, "{ray:?}");
        assert_eq!(listed.closest(&ray, ALL), expected, "{ray:?}");
        assert_eq!(sorted.closest(&ray, ALL), expected, "{ray:?}");
        let mut batch = [None; 2];
        tree.closest_batch(&[ray; 2], ALL, &mut batch);
        assert_eq!(batch, [expected; 2], "{ray:?}");
    }
}
