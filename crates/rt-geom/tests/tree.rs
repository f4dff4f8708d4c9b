//! The trees give the plain loop's answer, bit for bit: index and `t`, on every kind of scene and every instruction
//! set.
//!
//! `RT_LONG=1` casts a million rays at each scene, fewer where exact integers answer them.

use std::ops::Range;

use glam::DVec3;
use oracle::Random;
use rt_geom::{Bvh, Hit, Ray, Shape, Sphere, SphereTree, Triangle};

const AHEAD: Range<f64> = 0.0..f64::INFINITY;

struct Scene {
    name: &'static str,
    spheres: Vec<Sphere>,
    triangles: Vec<Triangle>,
    /// Rays are aimed at the cube of this center and half side.
    center: DVec3,
    size: f64,
}

fn ball(center: DVec3, radius: f64) -> Sphere {
    Sphere::new(center, radius).unwrap()
}

fn soup(random: &mut Random, n: usize, size: f64) -> Vec<Triangle> {
    let triangle = |_| {
        let a = random.point();
        Triangle::new(a, a + size * random.point(), a + size * random.point()).unwrap()
    };
    (0..n).map(triangle).collect()
}

/// A closed surface: a sphere of quadrilaterals, each cut in two.
fn globe(n: usize) -> Vec<Triangle> {
    let point = |i: usize, j: usize| {
        let (u, v) = (i as f64 / n as f64 * std::f64::consts::TAU, j as f64 / n as f64 * std::f64::consts::PI);
        DVec3::new(v.sin() * u.cos(), v.cos(), v.sin() * u.sin())
    };
    let mut out = Vec::new();
    for i in 0..n {
        for j in 0..n {
            let (a, b) = (point(i % n, j), point((i + 1) % n, j));
            let (c, d) = (point(i % n, j + 1), point((i + 1) % n, j + 1));
            out.extend([Triangle::new(a, b, c).unwrap(), Triangle::new(b, d, c).unwrap()]);
        }
    }
    out
}

fn scenes() -> Vec<Scene> {
    let random = &mut Random::new(7);
    let mut scenes = Vec::new();
    let mut add = |name, spheres, triangles, center, size| {
        scenes.push(Scene { name, spheres, triangles, center, size });
    };
    let uniform = |random: &mut Random, n: usize, scale: f64, center: DVec3| -> Vec<Sphere> {
        (0..n).map(|_| ball(center + scale * random.point(), 0.08 * scale)).collect()
    };
    add("uniform", uniform(random, 300, 1.0, DVec3::ZERO), vec![], DVec3::ZERO, 1.0);
    add("one", vec![ball(DVec3::X, 0.5)], vec![], DVec3::X, 1.0);
    add("a full block", uniform(random, 16, 1.0, DVec3::ZERO), vec![], DVec3::ZERO, 1.0);
    add("one more than a block", uniform(random, 17, 1.0, DVec3::ZERO), vec![], DVec3::ZERO, 1.0);
    let log = |random: &mut Random, decades: f64| 10f64.powf(-decades * random.share());
    add(
        "twelve decades of radius",
        (0..300).map(|_| ball(random.point(), log(random, 12.0))).collect(),
        vec![],
        DVec3::ZERO,
        1.0,
    );
    let mut giant = uniform(random, 200, 1.0, DVec3::ZERO);
    giant.insert(77, ball(DVec3::new(0.0, -1e6, 0.0), 1e6));
    add("a giant among small ones", giant, vec![], DVec3::ZERO, 1.0);
    add("coincident", vec![ball(DVec3::Y, 0.5); 150], vec![], DVec3::Y, 0.6);
    let shells = (0..200).map(|i| ball(DVec3::Y, 0.5 + f64::from(i % 5) * f64::EPSILON)).collect();
    add("nearly coincident", shells, vec![], DVec3::Y, 0.6);
    let line = |i: i32| ball(DVec3::new(f64::from(i), 0.0, 0.0), 0.5);
    add("touching on a line", (-100..100).map(line).collect(), vec![], DVec3::ZERO, 100.0);
    let powers = |i: i32| ball(DVec3::new(2f64.powi(i), 0.0, 0.0), 2f64.powi(i - 2));
    add("powers of two on a line", (-120..120).map(powers).collect(), vec![], DVec3::ZERO, 1e3);
    let points = |_| ball((8.0 * random.point()).round() / 8.0, if random.share() < 0.5 { 0.0 } else { 0.125 });
    add("points on a grid", (0..300).map(points).collect(), vec![], DVec3::ZERO, 1.0);
    let far = DVec3::new(1e9, -2e9, 3e9);
    add("far away", uniform(random, 200, 1.0, far), vec![], far, 1.0);
    for (name, scale) in [("1e30", 1e30), ("1e-30", 1e-30), ("1e300", 1e300), ("1e-300", 1e-300)] {
        add(name, uniform(random, 100, scale, DVec3::ZERO), vec![], DVec3::ZERO, scale);
    }
    let huge = |_| ball(random.point() * f64::MAX, random.share() * f64::MAX);
    add("no finite sphere encloses", (0..60).map(huge).collect(), vec![], DVec3::ZERO, 1e308);
    let tiny = |_| ball(random.point() * 1e-310, 1e-310 * random.share());
    add("subnormal", (0..60).map(tiny).collect(), vec![], DVec3::ZERO, 1e-310);
    add("triangles", vec![], soup(random, 250, 0.3), DVec3::ZERO, 1.0);
    add("a closed mesh", vec![], globe(12), DVec3::ZERO, 1.0);
    let mixed = (uniform(random, 100, 1.0, DVec3::ZERO), soup(random, 100, 0.3));
    add("spheres and triangles", mixed.0, mixed.1, DVec3::ZERO, 1.0);
    add("nothing", vec![], vec![], DVec3::ZERO, 1.0);
    scenes
}

/// Rays of every kind at a scene: from within, from outside, and from far away past the edge of something.
fn rays(scene: &Scene, n: usize) -> Vec<Ray> {
    let random = &mut Random::new(n as u64);
    let Scene { spheres, triangles, center, size, .. } = scene;
    let shape_point = |random: &mut Random| {
        let i = random.below((spheres.len() + triangles.len()).max(1));
        match (spheres.get(i), triangles.get(i.wrapping_sub(spheres.len()))) {
            (Some(sphere), _) => (sphere.center(), sphere.radius()),
            (None, Some(triangle)) => (triangle.vertices()[random.below(3)], 0.0),
            (None, None) => (*center, *size),
        }
    };
    let mut rays = Vec::with_capacity(n);
    for attempt in 0.. {
        if rays.len() == n {
            break;
        }
        let length = 10f64.powf(3.0 * random.uniform());
        // At the ends of the range of doubles some of these overflow: then the next kind takes its turn.
        let (origin, direction) = match attempt % 4 {
            0 => (*center + *size * random.point(), random.direction() * length),
            1 => {
                let origin = *center + 4.0 * *size * random.direction();
                (origin, (*center - origin + *size * random.point()) * (length / *size))
            }
            _ => {
                // Grazing: aimed at the silhouette, within a few parts in 10^7 or exactly up to rounding.
                let (at, radius) = shape_point(random);
                let away = random.direction();
                let distance = *size * 10f64.powf(4.0 * random.share());
                let miss = [0.0, 1e-7 * random.uniform(), 1e-12 * random.uniform()][random.below(3)];
                let edge = at + away.any_orthonormal_vector() * radius * (1.0 + miss);
                let origin = edge + away * distance;
                (origin, if radius > 0.0 { -away * length } else { (edge - origin) * (length / *size) })
            }
        };
        rays.extend(Ray::new(origin, direction));
    }
    rays
}

fn closest_by_loop(scene: &Scene, ray: &Ray, within: &Range<f64>) -> Option<Hit> {
    let spheres = scene.spheres.iter().map(|sphere| sphere.closest(ray, within.clone()));
    let triangles = scene.triangles.iter().map(|triangle| triangle.closest(ray, within.clone()));
    let mut best: Option<Hit> = None;
    for (index, t) in spheres.chain(triangles).enumerate() {
        if let Some(t) = t.filter(|t| best.is_none_or(|best| t.total_cmp(&best.t).is_lt())) {
            best = Some(Hit { index, t });
        }
    }
    best
}

fn bits(hit: Option<Hit>) -> Option<(usize, u64)> {
    hit.map(|hit| (hit.index, hit.t.to_bits()))
}

fn rays_per_scene(scene: &Scene) -> usize {
    let long = std::env::var_os("RT_LONG").is_some();
    // Out of the filters' range a test takes a thousand times as long.
    match (long, (1e-60..1e60).contains(&scene.size)) {
        (false, true) => 4_000,
        (false, false) => 400,
        (true, true) => 1_000_000,
        (true, false) => 25_000,
    }
}

/// The tree with the best instruction set, by whose batches rays are on their way together.
fn flying(tree: &Bvh) -> Bvh {
    let sets = ["avx512", "avx2", "neon", "sse2"];
    sets.iter().find_map(|name| tree.clone().with_simd(name)).unwrap_or_else(|| tree.clone())
}

#[test]
fn tree_gives_the_plain_loops_hit() {
    let mut hits = 0;
    for scene in scenes() {
        let tree = Bvh::new(scene.spheres.clone(), scene.triangles.clone());
        let rays = rays(&scene, rays_per_scene(&scene));
        let mut batch = vec![None; rays.len()];
        tree.closest_batch(&rays, AHEAD, &mut batch);
        let mut batch_any = vec![false; rays.len()];
        tree.any_batch(&rays, AHEAD, &mut batch_any);
        // On their way together, if they were not.
        let tree = flying(&tree);
        let mut together = vec![None; rays.len()];
        tree.closest_batch(&rays, AHEAD, &mut together);
        assert!(together == batch, "{}", scene.name);
        for (i, ray) in rays.iter().enumerate() {
            let expected = bits(closest_by_loop(&scene, ray, &AHEAD));
            hits += usize::from(expected.is_some());
            assert_eq!(bits(tree.closest(ray, AHEAD)), expected, "{}: {ray:?}", scene.name);
            assert_eq!(tree.any(ray, AHEAD), expected.is_some(), "any, {}: {ray:?}", scene.name);
            assert_eq!(bits(batch[i]), expected, "batch, {}: {ray:?}", scene.name);
            assert_eq!(batch_any[i], expected.is_some(), "batch of any, {}: {ray:?}", scene.name);
        }
    }
    assert!(hits > 10_000, "the rays hit too little to prove anything: {hits}");
}

#[test]
fn sphere_trees_give_the_plain_loops_hit() {
    for scene in scenes() {
        for tree in [SphereTree::new, SphereTree::sorted] {
            let tree = tree(scene.spheres.clone(), scene.triangles.clone());
            for ray in rays(&scene, rays_per_scene(&scene) / 20) {
                let expected = closest_by_loop(&scene, &ray, &AHEAD);
                assert_eq!(bits(tree.closest(&ray, AHEAD)), bits(expected), "{}: {ray:?}", scene.name);
                assert_eq!(tree.any(&ray, AHEAD), expected.is_some(), "any, {}: {ray:?}", scene.name);
            }
        }
    }
}

#[test]
fn every_range_gives_the_plain_loops_hit() {
    for scene in scenes() {
        let tree = Bvh::new(scene.spheres.clone(), scene.triangles.clone());
        let sorted = SphereTree::sorted(scene.spheres.clone(), scene.triangles.clone());
        for ray in rays(&scene, rays_per_scene(&scene) / 40) {
            let t = closest_by_loop(&scene, &ray, &AHEAD).map_or(1.0, |hit| hit.t);
            let infinity = f64::INFINITY;
            let ranges = [
                -infinity..infinity,
                t..infinity,
                t.next_up()..infinity,
                0.0..t,
                0.0..t.next_up(),
                -infinity..0.0,
                f64::from_bits(1)..infinity,
                1.0..1.0,
                2.0..1.0,
                f64::NAN..1.0,
                0.0..f64::NAN,
                infinity..infinity,
            ];
            for within in ranges {
                let expected = bits(closest_by_loop(&scene, &ray, &within));
                let message = format!("{} in {within:?}: {ray:?}", scene.name);
                assert_eq!(bits(tree.closest(&ray, within.clone())), expected, "{message}");
                assert_eq!(tree.any(&ray, within.clone()), expected.is_some(), "any, {message}");
                assert_eq!(bits(sorted.closest(&ray, within.clone())), expected, "sorted, {message}");
                let mut batch = [None];
                tree.closest_batch(&[ray], within, &mut batch);
                assert_eq!(bits(batch[0]), expected, "batch, {message}");
            }
        }
    }
}

#[test]
fn every_instruction_set_gives_the_same_bits() {
    let mut tried = 0;
    for scene in scenes() {
        let tree = Bvh::new(scene.spheres.clone(), scene.triangles.clone());
        let rays = rays(&scene, rays_per_scene(&scene) / 10);
        let mut expected = vec![None; rays.len()];
        for (hit, ray) in expected.iter_mut().zip(&rays) {
            *hit = tree.closest(ray, AHEAD);
        }
        for name in ["sse2", "avx2", "avx512", "neon"] {
            let Some(tree) = tree.clone().with_simd(name) else { continue };
            tried += 1;
            let mut batch = vec![None; rays.len()];
            tree.closest_batch(&rays, AHEAD, &mut batch);
            let mut any = vec![false; rays.len()];
            tree.any_batch(&rays, AHEAD, &mut any);
            for (i, ray) in rays.iter().enumerate() {
                let expected = bits(expected[i]);
                assert_eq!(bits(tree.closest(ray, AHEAD)), expected, "{name}, {}: {ray:?}", scene.name);
                assert_eq!(bits(batch[i]), expected, "{name} batch, {}: {ray:?}", scene.name);
                assert_eq!(any[i], expected.is_some(), "{name} any, {}: {ray:?}", scene.name);
                assert_eq!(tree.any(ray, AHEAD), expected.is_some(), "{name} any, {}: {ray:?}", scene.name);
            }
        }
    }
    assert!(tried >= 2 * scenes().len(), "at least the scalar level and one other");
}

/// Pictures of every scene: by eyes within it, at its primitives and up to a few hundred sizes away, wide and down to a
/// few doubles across, in rows and in disorder. They walk the tree in tiles.
#[test]
fn tiles_of_pictures_give_the_plain_loops_hits() {
    const SIDE: i32 = 20;
    let long = std::env::var_os("RT_LONG").is_some();
    let random = &mut Random::new(11);
    let mut hits = 0;
    for scene in scenes() {
        let tree = Bvh::new(scene.spheres.clone(), scene.triangles.clone());
        for _ in 0..if long { 100 } else { 4 } {
            let seed = rays(&scene, 16 + random.below(64));
            let at = random.pick(&seed);
            let target = match closest_by_loop(&scene, &at, &AHEAD) {
                Some(hit) if !random.one_in(4) => at.at(hit.t),
                _ => scene.center + scene.size * random.point(),
            };
            let away = random.direction() * scene.size * 10f64.powf(random.within(-2.0, 2.0));
            let eye = random.pick(&[at.origin(), target + away, scene.center]);
            let along = target - eye;
            let sides = [along.cross(DVec3::Y), along.cross(random.point())];
            let right = random.pick(&sides);
            let width = along.length() * 10f64.powf(random.within(-16.0, 0.0)) / f64::from(SIDE);
            let right = right.normalize_or_zero() * width;
            let up = right.cross(along).normalize_or_zero() * width;
            let pixels = (0..SIDE * SIDE).map(|i| (f64::from(i % SIDE - SIDE / 2), f64::from(i / SIDE - SIDE / 2)));
            let mut rays: Vec<Ray> =
                pixels.filter_map(|(x, y)| Ray::new(eye, along + x * right + y * up).ok()).collect();
            if random.one_in(4) {
                random.shuffle(&mut rays);
            }
            let t = rays.first().and_then(|ray| tree.closest(ray, AHEAD)).map_or(1.0, |hit| hit.t);
            for within in [AHEAD, 0.0..t, 0.0..t.next_up(), t..f64::INFINITY] {
                let expected: Vec<_> = rays.iter().map(|ray| bits(closest_by_loop(&scene, ray, &within))).collect();
                hits += expected.iter().flatten().count();
                for name in ["sse2", "avx2", "avx512", "neon"] {
                    let Some(tree) = tree.clone().with_simd(name) else { continue };
                    let mut batch = vec![None; rays.len()];
                    tree.closest_batch(&rays, within.clone(), &mut batch);
                    for ((hit, &expected), ray) in batch.into_iter().zip(&expected).zip(&rays) {
                        assert_eq!(bits(hit), expected, "{name}, {} in {within:?}: {ray:?}", scene.name);
                    }
                }
            }
        }
    }
    assert!(hits > 20_000, "the pictures show too little: {hits}");
}

#[test]
fn rays_of_extreme_exponents_are_answered_as_by_the_loop() {
    let random = &mut Random::new(3);
    let exponents = [-1074, -1022, -600, -300, -60, 0, 60, 300, 600, 1000];
    for scene in scenes() {
        let tree = Bvh::new(scene.spheres.clone(), scene.triangles.clone());
        for _ in 0..200 {
            let power = |random: &mut Random| 2f64.powi(exponents[random.below(exponents.len())]);
            let origin = random.point() * power(random);
            let direction = random.direction() * power(random);
            let aimed = (scene.center - origin) * random.share();
            for direction in [direction, aimed] {
                let Ok(ray) = Ray::new(origin, direction) else { continue };
                let expected = bits(closest_by_loop(&scene, &ray, &AHEAD));
                assert_eq!(bits(tree.closest(&ray, AHEAD)), expected, "{}: {ray:?}", scene.name);
            }
        }
    }
}

#[test]
fn shapes_keep_their_index() {
    for scene in scenes() {
        let tree = Bvh::new(scene.spheres.clone(), scene.triangles.clone());
        assert_eq!(tree.len(), scene.spheres.len() + scene.triangles.len());
        for (i, &sphere) in scene.spheres.iter().enumerate() {
            assert_eq!(tree.shape(i), Shape::Sphere(sphere), "{}", scene.name);
        }
        for (i, &triangle) in scene.triangles.iter().enumerate() {
            assert_eq!(tree.shape(scene.spheres.len() + i), Shape::Triangle(triangle), "{}", scene.name);
        }
    }
}

#[test]
fn the_tree_is_the_same_for_any_number_of_threads() {
    let random = &mut Random::new(11);
    let spheres: Vec<Sphere> = (0..20_000).map(|_| ball(random.point(), 0.02 * random.share())).collect();
    let tree = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let tree = pool.install(|| Bvh::new(spheres.clone(), vec![]));
        format!("{tree:?}")
    };
    let one = tree(1);
    for threads in [2, 3] {
        assert!(tree(threads) == one, "{threads} threads build another tree than one");
    }
}

#[test]
fn no_input_overflows_the_stack_or_takes_forever() {
    let many = 200_000;
    let on_a_line = |i: u32| ball(DVec3::new(f64::from(i).powi(3), 0.0, 0.0), 1e-3);
    let mut giant = vec![ball(DVec3::ZERO, 1e-6); many];
    giant[many / 2] = ball(DVec3::ZERO, 1e9);
    let inputs: [Vec<Sphere>; 4] = [
        vec![ball(DVec3::ONE, 1.0); many],
        (0..200_000).map(on_a_line).collect(),
        giant,
        // Each twice as far as the last, over and over: as unbalanced as doubles allow.
        (0..200_000).map(|i| ball(DVec3::X * 2f64.powi(i % 2000 - 1000), 0.0)).collect(),
    ];
    let ray = Ray::new(DVec3::new(-3.0, 1.0, 1.0), DVec3::X).unwrap();
    for spheres in inputs {
        let expected = spheres.iter().map(|sphere| sphere.any(&ray, AHEAD)).filter(|hit| *hit).count() > 0;
        let tree = Bvh::new(spheres, vec![]);
        assert_eq!(tree.any(&ray, AHEAD), expected);
        let hit = tree.closest(&ray, AHEAD);
        assert_eq!(hit.is_some(), expected);
        // Each with a stack as deep as the tree needs.
        let mut hits = [None; 2];
        tree.closest_batch(&[ray; 2], AHEAD, &mut hits);
        assert_eq!(hits, [hit; 2]);
    }
}

/// Listed once, and then `many` times, with something else before and after.
fn copies<T: Copy>(one: T, many: usize, other: [T; 2]) -> [Vec<T>; 2] {
    [1, many].map(|n| [vec![other[0]], vec![one; n], vec![other[1]]].concat())
}

#[test]
fn equal_primitives_cost_what_one_does_and_the_lowest_index_answers() {
    let far = [DVec3::new(0.0, 9.0, 0.0), DVec3::new(0.0, 0.0, 9.0)];
    let triangle = |at: DVec3| Triangle::new(at - DVec3::Y, at - DVec3::Z, at + DVec3::Y + DVec3::Z).unwrap();
    // The zeros' signs differ, the sphere does not.
    let (plus, minus) = (ball(DVec3::new(1.0, 0.0, 0.0), 1.0), ball(DVec3::new(1.0, -0.0, -0.0), 1.0));
    for many in [2, 16, 17, 40, 128, 129, 10_000] {
        let [one, mut spheres] = copies(plus, many, far.map(|at| ball(at, 0.5)));
        spheres[2] = minus;
        let [one_triangle, triangles] = copies(triangle(DVec3::ZERO), many, far.map(triangle));
        let scenes = [
            // Nothing else.
            (vec![plus; many], vec![], vec![plus], vec![]),
            (vec![], vec![triangle(DVec3::ZERO); many], vec![], vec![triangle(DVec3::ZERO)]),
            (spheres.clone(), vec![], one.clone(), vec![]),
            (spheres, triangles, one, one_triangle),
        ];
        for (spheres, triangles, one, one_triangle) in scenes {
            let tree = Bvh::new(spheres.clone(), triangles.clone());
            let sphere_trees = [SphereTree::new, SphereTree::sorted]
                .map(|tree| (tree(spheres.clone(), triangles.clone()), tree(one.clone(), one_triangle.clone())));
            let alone = Bvh::new(one, one_triangle);
            for (i, &sphere) in spheres.iter().enumerate() {
                assert_eq!(tree.shape(i), Shape::Sphere(sphere));
            }
            for origin in [DVec3::new(-3.0, 0.0, 0.0), DVec3::new(-3.0, 0.125, 0.25), DVec3::new(-3.0, 5.0, 5.0)] {
                let ray = Ray::new(origin, DVec3::X).unwrap();
                let scene = Scene {
                    name: "",
                    spheres: spheres.clone(),
                    triangles: triangles.clone(),
                    center: origin,
                    size: 1.0,
                };
                let expected = bits(closest_by_loop(&scene, &ray, &AHEAD));
                let ((hit, visits), (_, least)) =
                    (tree.closest_counted(&ray, AHEAD), alone.closest_counted(&ray, AHEAD));
                assert_eq!(bits(hit), expected, "{many} copies, {ray:?}");
                // Beside other primitives, two leaf blocks of each kind may be filled up with copies.
                assert!(
                    visits.nodes <= 2 * least.nodes + 4 && visits.tests <= least.tests + 64,
                    "{many}: {visits:?} for {least:?}"
                );
                if spheres.len().max(triangles.len()) == many {
                    assert_eq!(visits, least, "{many} copies and nothing else");
                }
                for (tree, alone) in &sphere_trees {
                    let (hit, visits) = tree.closest_counted(&ray, AHEAD);
                    assert_eq!(bits(hit), expected, "sphere tree, {many} copies, {ray:?}");
                    let (work, least) = (visits.nodes + visits.tests, alone.closest_counted(&ray, AHEAD).1);
                    assert!(work <= least.nodes + least.tests + 160, "sphere tree, {many}: {visits:?} for {least:?}");
                }
                let mut batch = [None; 3];
                tree.closest_batch(&[ray; 3], AHEAD, &mut batch);
                assert_eq!(batch.map(bits), [expected; 3], "batch, {many} copies, {ray:?}");
            }
        }
    }
}

#[test]
fn copies_of_spheres_with_one_center_are_left_out_too() {
    let random = &mut Random::new(13);
    let shells: Vec<Sphere> = (0..40_000).map(|i| ball(DVec3::ONE, 1.0 + f64::from(i % 37) / 64.0)).collect();
    let scene = Scene { name: "shells", spheres: shells, triangles: vec![], center: DVec3::ONE, size: 1.0 };
    let tree = Bvh::new(scene.spheres.clone(), vec![]);
    for _ in 0..100 {
        let ray = Ray::new(DVec3::new(1.0, 1.0, -5.0), DVec3::Z + 0.5 * random.point()).unwrap();
        let (hit, visits) = tree.closest_counted(&ray, AHEAD);
        assert_eq!(bits(hit), bits(closest_by_loop(&scene, &ray, &AHEAD)), "{ray:?}");
        assert!(visits.tests <= 37, "{visits:?}");
    }
}

#[test]
fn the_tree_saves_tests() {
    let random = &mut Random::new(5);
    let spheres: Vec<Sphere> = (0..10_000).map(|_| ball(random.point(), 0.01)).collect();
    let tree = Bvh::new(spheres, vec![]);
    let (mut work, mut tests) = (0, 0);
    for _ in 0..1000 {
        let ray = Ray::new(random.point(), random.direction()).unwrap();
        let (hit, visits) = tree.closest_counted(&ray, AHEAD);
        assert_eq!(bits(hit), bits(tree.closest(&ray, AHEAD)));
        assert_eq!(tree.any(&ray, AHEAD), hit.is_some());
        work += visits.nodes;
        tests += visits.tests;
    }
    assert!(work < 30_000, "{work} nodes and leaf blocks for a thousand rays");
    assert!(tests < 4_000, "{tests} exact tests for a thousand rays");
}
