//! A ray costs what its surroundings ask for, whatever else the scene holds: walls of huge spheres, a sky, stars, sizes
//! over twelve decades. What small things cost alone they cost among large and far ones too, up to a factor of two, and
//! the answers are the plain loop's.
//!
//! `RT_LONG=1` compares 100,000 rays a scene.

use glam::DVec3;
use oracle::Random;
use rt_geom::{AHEAD, Bvh, List, Ray, Sphere, Triangle, Visits};

fn ball(center: DVec3, radius: f64) -> Sphere {
    Sphere::new(center, radius).unwrap()
}

/// Balls of radius 0.03 at most in the unit cube.
fn room(random: &mut Random, n: usize) -> Vec<Sphere> {
    (0..n).map(|_| ball(random.point(), 0.03 * random.share())).collect()
}

/// Balls that are nearly planes, on five sides of the unit cube.
fn walls(radius: f64) -> Vec<Sphere> {
    let sides = DVec3::AXES.into_iter().chain(DVec3::AXES.map(|axis| -axis)).take(5);
    sides.map(|side| ball(side * (radius + 1.1), radius)).collect()
}

/// A square of two triangles, `size` across, at `y = -1.1`.
fn ground(size: f64) -> Vec<Triangle> {
    let corner = |x: f64, z: f64| DVec3::new(x * size, -1.1, z * size);
    let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    vec![Triangle::new(a, b, c).unwrap(), Triangle::new(a, c, d).unwrap()]
}

/// Balls all around, at distances that grow over some decades, as large as seen from the center.
fn sky(random: &mut Random, n: usize, decades: [f64; 2]) -> Vec<Sphere> {
    let star = |_| {
        let distance = 10f64.powf(decades[0] + (decades[1] - decades[0]) * random.share());
        ball(random.direction() * distance, 0.02 * random.share() * distance)
    };
    (0..n).map(star).collect()
}

struct Scene {
    name: &'static str,
    /// What the rays start among; they cost twice as much at most as there.
    small: Vec<Sphere>,
    spheres: Vec<Sphere>,
    triangles: Vec<Triangle>,
    /// Large things that a ray may have to be tested with beside the small ones.
    large: usize,
}

fn scenes(n: usize) -> Vec<Scene> {
    let random = &mut Random::new(4);
    let small = room(random, n);
    let mut scenes = Vec::new();
    let mut add = |name, large, spheres, triangles| {
        scenes.push(Scene { name, small: small.clone(), spheres, triangles, large });
    };
    for (name, radius) in [("walls 1e3", 1e3), ("walls 1e5", 1e5), ("walls 1e9", 1e9), ("walls 1e15", 1e15)] {
        // A ray heads for three of them.
        add(name, 3, walls(radius), vec![]);
    }
    add("walls 1e100, whose rounding is larger than the room", 5, walls(1e100), vec![]);
    add("a ground of 1e22", 1, vec![ball(DVec3::new(0.0, -1e22, 0.0), 1e22)], vec![]);
    add("a ground of triangles", 2, vec![], ground(1e7));
    add("a dome and a ground", 2, vec![ball(DVec3::ZERO, 1e8), ball(DVec3::new(0.0, -1e6 - 1.0, 0.0), 1e6)], vec![]);
    add("a far star", 0, vec![ball(DVec3::new(1e12, 2e12, -1e12), 1e9)], vec![]);
    add("far stars", 0, (0..1000).map(|_| ball(random.direction() * 1e9, 1e6 * random.share())).collect(), vec![]);
    add("another room far away", 0, small.iter().map(|s| ball(s.center() + 1e8, s.radius())).collect(), vec![]);
    add("a room a million times as large", 3, walls(1e12).into_iter().chain(walls(1e5)).collect(), vec![]);
    scenes
}

/// Rays from the unit cube.
fn rays(random: &mut Random, n: usize) -> Vec<Ray> {
    (0..n).map(|_| Ray::new(random.point(), random.direction()).unwrap()).collect()
}

fn cost(tree: &Bvh, rays: &[Ray]) -> [f64; 2] {
    let visits: Vec<Visits> = rays.iter().map(|ray| tree.closest_counted(ray, AHEAD).1).collect();
    let mean = |of: fn(&Visits) -> usize| visits.iter().map(of).sum::<usize>() as f64 / rays.len() as f64;
    [mean(|visits| visits.nodes), mean(|visits| visits.tests)]
}

#[test]
fn large_and_far_things_do_not_make_small_ones_cost_more() {
    let rays = rays(&mut Random::new(5), 1000);
    for n in [100, 3_000] {
        for Scene { name, small, mut spheres, triangles, large } in scenes(n) {
            let alone = cost(&Bvh::new(small.clone(), vec![]), &rays);
            spheres.splice(spheres.len() / 2..spheres.len() / 2, small);
            let all = cost(&Bvh::new(spheres, triangles), &rays);
            // A node, or a part of one, for each of the larger scales.
            assert!(all[0] <= 2.0 * alone[0] + 2.0, "{name}, {n}: {all:?} nodes and tests, {alone:?} alone");
            assert!(all[1] <= 2.0 * alone[1] + large as f64, "{name}, {n}: {all:?} nodes and tests, {alone:?} alone");
        }
    }
}

/// Six decades of distance cost no more than each of them alone, together.
#[test]
fn stars_cost_what_the_decades_cost_one_by_one() {
    let random = &mut Random::new(6);
    let decades: Vec<Vec<Sphere>> =
        (0..6).map(|decade| sky(random, 1000, [f64::from(decade), f64::from(decade + 1)])).collect();
    let rays = rays(random, 1000);
    let each: Vec<[f64; 2]> = decades.iter().map(|stars| cost(&Bvh::new(stars.clone(), vec![]), &rays)).collect();
    let sum = |of: usize| each.iter().map(|cost| cost[of]).sum::<f64>();
    let all = cost(&Bvh::new(decades.concat(), vec![]), &rays);
    assert!(all[0] < 2.0 * sum(0) && all[1] < 2.0 * sum(1), "{all:?} nodes and tests, {each:?}");
}

/// Radii over twelve decades: those that are too small for the frame of all cost what they cost alone.
#[test]
fn twelve_decades_of_radius_cost_what_the_smallest_cost_alone() {
    let random = &mut Random::new(7);
    // Clusters within clusters: eleven decades of ever smaller ones about a point, each of as many.
    let part = |k: i32| {
        let size = 10f64.powi(-k);
        move |random: &mut Random| ball(random.point() * size, 0.03 * size * random.share())
    };
    let parts: Vec<Vec<Sphere>> = (0..12).map(|k| (0..500).map(|_| part(k)(random)).collect()).collect();
    let all = Bvh::new(parts.concat(), vec![]);
    for k in [0, 4, 11] {
        let size = 10f64.powi(-k);
        let rays: Vec<Ray> =
            (0..500).map(|_| Ray::new(random.point() * size, random.direction() * size).unwrap()).collect();
        let decades = parts[..=k as usize].iter().map(|part| cost(&Bvh::new(part.clone(), vec![]), &rays));
        let [nodes, tests] = decades.fold([0.0; 2], |sum, cost| [sum[0] + cost[0], sum[1] + cost[1]]);
        let found = cost(&all, &rays);
        assert!(found[0] <= 2.0 * nodes + 4.0 && found[1] <= 2.0 * tests + 1.0, "1e-{k}: {found:?}, {nodes} {tests}");
    }
}

/// Bundles of a few primitives in ever smaller places, thousands of them: the crown is deep and wide.
#[test]
fn dust_gives_the_plain_loops_hit() {
    let random = &mut Random::new(8);
    let mut spheres = vec![];
    let mut triangles = vec![];
    for _ in 0..60 {
        let at = random.point();
        for _ in 0..4 {
            let (at, size) = (at + 1e-6 * random.point(), 1e-11 * random.share());
            spheres.extend((0..5).map(|_| ball(at + size * random.point(), 0.2 * size)));
            let corner = |random: &mut Random| at + size * random.point();
            triangles.push(Triangle::new(corner(random), corner(random), corner(random)).unwrap());
        }
    }
    spheres.push(ball(DVec3::ZERO, 10.0));
    compare("dust", List { spheres, triangles }, random, 2_000);
}

#[test]
fn every_scale_gives_the_plain_loops_hit() {
    let random = &mut Random::new(9);
    let long = std::env::var_os("RT_LONG").is_some();
    for Scene { name, small, mut spheres, triangles, .. } in scenes(if long { 1000 } else { 200 }) {
        spheres.extend(small);
        compare(name, List { spheres, triangles }, random, if long { 100_000 } else { 1_000 });
    }
    let spheres = sky(random, 1000, [0.0, 6.0]);
    compare("stars", List { spheres, triangles: vec![] }, random, if long { 100_000 } else { 1_000 });
    // From one end of the range of doubles to the other.
    let spheres = (-1000..1000).map(|k| 2f64.powi(k)).map(|x| ball(x * random.point(), x * random.share())).collect();
    compare("all exponents", List { spheres, triangles: vec![] }, random, if long { 10_000 } else { 200 });
}

/// Every question, on every instruction set, with rays from everywhere: among the small, past edges, from far away.
fn compare(name: &str, list: List, random: &mut Random, rays: usize) {
    let tree = Bvh::new(list.spheres.clone(), list.triangles.clone());
    let rays: Vec<Ray> = (0..rays)
        .filter_map(|i| {
            let target = match random.below(list.spheres.len() + list.triangles.len()) {
                i if i < list.spheres.len() => {
                    let sphere = list.spheres[i];
                    let edge = random.pick(&[0.0, 0.9, 1.0, 1.0 - 1e-12, 1.0 + 1e-12]);
                    sphere.center() + sphere.radius() * edge * random.direction()
                }
                i => random.pick(&list.triangles[i - list.spheres.len()].vertices()),
            };
            let far = 10f64.powf(14.0 * random.share() - 4.0) * random.direction();
            let length = 10f64.powf(3.0 * random.uniform());
            match i % 4 {
                0 => Ray::new(random.point(), random.direction() * length).ok(),
                1 => Ray::new(random.point(), target * length).ok(),
                2 => Ray::new(target + far, -far * length).ok(),
                // Along an axis, where slabs are parallel to the ray.
                _ => Ray::new(target, random.pick(&[DVec3::X, DVec3::NEG_Y, -0.0 * DVec3::ONE + DVec3::Z])).ok(),
            }
        })
        .collect();
    for (k, part) in rays.chunks(rays.len().div_ceil(5)).enumerate() {
        let level = ["", "sse2", "avx2", "avx512", "neon"][k];
        let tree = tree.clone().with_simd(level).unwrap_or_else(|| tree.clone());
        let mut batch = vec![None; part.len()];
        tree.closest_batch(part, AHEAD, &mut batch);
        let mut any = vec![false; part.len()];
        tree.any_batch(part, AHEAD, &mut any);
        let (mut hits, mut expected_hits) = (vec![], vec![]);
        for (i, ray) in part.iter().enumerate() {
            let expected = list.closest(ray, AHEAD);
            assert_eq!(tree.closest(ray, AHEAD), expected, "{name}, {level}: {ray:?}");
            assert_eq!(batch[i], expected, "batch, {name}, {level}: {ray:?}");
            assert_eq!(any[i], expected.is_some(), "batch of any, {name}, {level}: {ray:?}");
            assert_eq!(tree.any(ray, AHEAD), expected.is_some(), "any, {name}, {level}: {ray:?}");
            if i % 16 == 0 {
                tree.hits(ray, f64::NEG_INFINITY..f64::INFINITY, &mut hits);
                list.hits(ray, f64::NEG_INFINITY..f64::INFINITY, &mut expected_hits);
                assert_eq!(hits, expected_hits, "hits, {name}, {level}: {ray:?}");
                assert_eq!(tree.contains(ray.origin()), list.contains(ray.origin()), "{name}: {ray:?}");
                let mut crossings = [vec![], vec![]];
                tree.crossings(ray, &mut crossings[0]);
                list.crossings(ray, &mut crossings[1]);
                assert_eq!(crossings[0], crossings[1], "crossings, {name}, {level}: {ray:?}");
            }
            for within in expected.iter().flat_map(|hit| [0.0..hit.t, 0.0..hit.t.next_up(), hit.t..f64::INFINITY]) {
                assert_eq!(tree.closest(ray, within.clone()), list.closest(ray, within.clone()), "{name}: {within:?}");
            }
        }
    }
}

/// A hit behind the origin by less than half of the smallest double has the parameter `-0`, which a range from `-0` on
/// holds. Another ray of the batch, going across, must not drop it. Things are some units of the smallest double large.
#[test]
fn a_hit_behind_the_origin_that_rounds_to_minus_zero_is_in_a_range_from_there_on() {
    let tiny = f64::from_bits(1);
    let mut spheres: Vec<Sphere> = (0..20).map(|i| ball(-16.0 * f64::from(i) * tiny * DVec3::X, 4.0 * tiny)).collect();
    spheres.extend((0..20).map(|i| ball(DVec3::new(-20.0 - 3.0 * f64::from(i), 10.0, 10.0), 1.0)));
    let list = List { spheres, triangles: vec![] };
    let tree = Bvh::new(list.spheres.clone(), vec![]);
    let origin = 7.0 * tiny * DVec3::X;
    let directions = (0..64).map(|i| DVec3::new(f64::from(i % 2 * 8), 0.0, 1.0 + 1e-3 * f64::from(i)));
    let rays: Vec<Ray> = directions.map(|direction| Ray::new(origin, direction).unwrap()).collect();
    for start in [-0.0, 0.0] {
        let within = start..f64::INFINITY;
        let mut batch = vec![None; rays.len()];
        tree.closest_batch(&rays, within.clone(), &mut batch);
        for (i, ray) in rays.iter().enumerate() {
            let expected = list.closest(ray, within.clone());
            let hit = i % 2 == 1 && start.is_sign_negative();
            assert_eq!(expected.map(|hit| hit.t.to_bits()), hit.then_some((-0f64).to_bits()), "{start} {ray:?}");
            assert_eq!(tree.closest(ray, within.clone()), expected, "{start} {ray:?}");
            assert_eq!(batch[i], expected, "batch: {start} {ray:?}");
        }
    }
}
