//! What a mesh is asked: every hit in order, crossings that alternate, and inside or outside; from the tree as from the
//! plain list.

use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use glam::DVec3;
use oracle::{Big, Random, cases, dot, exact, power_of_two, sign, sub, vector};
use rayon::prelude::*;
use rt_geom::{AHEAD, Bvh, Crossing, Hit, List, Ray, Shape, Side, Sphere, Triangle, open_edges};

/// How many rays or points the long run has.
const LONG: usize = 1_000_000;

/// An octahedron, each face cut in four `depth` times, with its vertices brought to the sphere of this radius: closed,
/// its normals outward.
fn ball_mesh(depth: u32, radius: f64, center: DVec3) -> Vec<Triangle> {
    let mut vertices = vec![DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    let mut faces = vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [1, 0, 5], [2, 1, 5], [3, 2, 5], [0, 3, 5]];
    for _ in 0..depth {
        let mut middles = HashMap::new();
        let mut middle = |a: usize, b: usize| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                vertices.push((vertices[a] + vertices[b]).normalize());
                vertices.len() - 1
            })
        };
        faces = faces
            .iter()
            .flat_map(|&[a, b, c]| {
                let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    let place = |i: usize| center + radius * vertices[i];
    faces.iter().map(|&[a, b, c]| Triangle::new(place(a), place(b), place(c)).unwrap()).collect()
}

/// The cube from -1 to 1, two triangles a face, its normals outward.
fn cube() -> Vec<Triangle> {
    let corner = |i: usize| DVec3::from_array([0, 1, 2].map(|axis| if i >> axis & 1 == 0 { -1.0 } else { 1.0 }));
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let halves = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    halves.map(|ends| ends.map(corner)).map(|[a, b, c]| Triangle::new(a, b, c).unwrap()).collect()
}

/// A place of a triangle: a vertex, in an edge, or in the interior, as near as doubles come.
fn place(triangle: &Triangle, random: &mut Random) -> DVec3 {
    let [a, b, c] = triangle.vertices();
    match random.below(3) {
        0 => a,
        1 => 0.5 * (a + b),
        _ => a + random.share() * 0.5 * (b - a) + random.share() * 0.5 * (c - a),
    }
}

/// A scene of spheres and triangles, some of them equal.
fn scene(random: &mut Random) -> List {
    let grid = |random: &mut Random| DVec3::from_array([0, 1, 2].map(|_| f64::from(random.integer(-4..5))));
    let mut list = List::default();
    for _ in 0..40 {
        let radius = [0.0, 1.0, 2.0, 0.5][random.below(4)];
        list.spheres.push(Sphere::new(grid(random), radius).unwrap());
        let [a, b, c] = [grid(random), grid(random), grid(random)];
        list.triangles.push(Triangle::new(a, b, c).unwrap());
    }
    for _ in 0..40 {
        list.spheres.push(list.spheres[random.below(3)]);
        list.triangles.push(list.triangles[random.below(3)]);
    }
    list
}

#[test]
fn the_tree_answers_as_the_list_does() {
    let random = &mut Random::new(1);
    let (mut hits, mut crossings, mut sides) = (0, 0, [0; 3]);
    for i in 0..cases(LONG) / 50 {
        let list = scene(random);
        let tree = Bvh::new(list.spheres.clone(), list.triangles.clone());
        let (mut found, mut expected) = (Vec::new(), Vec::new());
        let (mut passed, mut expected_passes) = (Vec::new(), Vec::new());
        for _ in 0..50 {
            let whole = |random: &mut Random| DVec3::from_array([0, 1, 2].map(|_| f64::from(random.integer(-9..10))));
            let origin = if random.one_in(2) { whole(random) } else { 9.0 * random.point() };
            let direction = if i % 2 == 0 { whole(random) } else { random.point() };
            let Ok(ray) = Ray::new(origin, direction) else { continue };
            let within = [AHEAD, f64::NEG_INFINITY..f64::INFINITY, 0.5..2.0, 3.0..1.0][random.below(4)].clone();
            tree.hits(&ray, within.clone(), &mut found);
            list.hits(&ray, within.clone(), &mut expected);
            assert_eq!(found, expected, "{ray:?} in {within:?}");
            let counts = [tree.count(&ray, within.clone()), list.count(&ray, within.clone())];
            assert_eq!(counts, [found.len(); 2], "{ray:?} in {within:?}");
            assert_eq!(found.first().copied(), tree.closest(&ray, within.clone()), "{ray:?} in {within:?}");
            assert_eq!(found.first().copied(), list.closest(&ray, within.clone()));
            tree.crossings(&ray, &mut passed);
            list.crossings(&ray, &mut expected_passes);
            assert_eq!(passed, expected_passes, "{ray:?}");
            let side = tree.contains(origin);
            assert_eq!(side, list.contains(origin), "{origin:?}");
            hits += found.len();
            crossings += passed.len();
            sides[side as usize] += 1;
        }
        assert_eq!(tree.open_edges(), open_edges(&list.triangles));
    }
    assert!(hits > 1000 && crossings > 1000 && sides.iter().all(|&n| n > 100), "{hits} {crossings} {sides:?}");
}

#[test]
fn a_sphere_gives_both_roots_and_a_tangent_one() {
    let list = List { spheres: vec![Sphere::new(DVec3::ZERO, 1.0).unwrap()], triangles: vec![] };
    let hits = |y: f64, within| {
        let mut hits = Vec::new();
        list.hits(&Ray::new(DVec3::new(-2.0, y, 0.0), DVec3::X).unwrap(), within, &mut hits);
        hits
    };
    let hit = |t| Hit { index: 0, t };
    assert_eq!(hits(0.0, AHEAD), [hit(1.0), hit(3.0)]);
    assert_eq!(hits(0.0, 1.5..9.0), [hit(3.0)]);
    assert_eq!(hits(1.0, AHEAD), [hit(2.0)]);
    assert_eq!(hits(1f64.next_up(), AHEAD), []);
}

#[test]
fn a_tangent_is_turned_into_the_sphere_or_past_it() {
    let tree = Bvh::new(vec![Sphere::new(DVec3::ZERO, 1.0).unwrap()], vec![]);
    let crossings = |origin: DVec3, direction: DVec3| {
        let mut crossings = Vec::new();
        tree.crossings(&Ray::new(origin, direction).unwrap(), &mut crossings);
        crossings.iter().map(|&Crossing { t, entering, .. }| (t, entering)).collect::<Vec<_>>()
    };
    // Along y the ray is turned towards +x and +z: from x = 1 away from the sphere, from x = -1 into it.
    assert_eq!(crossings(DVec3::new(1.0, -2.0, 0.0), DVec3::Y), []);
    assert_eq!(crossings(DVec3::new(-1.0, -2.0, 0.0), DVec3::Y), [(2.0, true), (2.0, false)]);
    // From the surface itself: the other root is infinitely near, ahead or behind.
    assert_eq!(crossings(DVec3::X, DVec3::Y), []);
    assert_eq!(crossings(DVec3::NEG_X, DVec3::Y), [(0.0, false)]);
    assert_eq!(crossings(DVec3::NEG_X, DVec3::X), [(2.0, false)]);
    assert_eq!(crossings(DVec3::NEG_X, DVec3::NEG_X), []);
}

/// Surfaces around the origin, each within the next.
struct Nested {
    tree: Bvh,
    triangles: Vec<Triangle>,
    /// Of each surface, by its number from the inside, the radius.
    radii: Vec<f64>,
    /// Of each index, the surface.
    surface: Vec<usize>,
}

impl Nested {
    /// Of each radius a sphere, or a mesh cut so often.
    fn new(surfaces: &[(f64, Option<u32>)]) -> Self {
        let (mut spheres, mut triangles, mut surface, mut surface_of_triangles) = (vec![], vec![], vec![], vec![]);
        for (i, &(radius, cut)) in surfaces.iter().enumerate() {
            match cut {
                None => {
                    spheres.push(Sphere::new(DVec3::ZERO, radius).unwrap());
                    surface.push(i);
                }
                Some(depth) => {
                    triangles.extend(ball_mesh(depth, radius, DVec3::ZERO));
                    surface_of_triangles.resize(triangles.len(), i);
                }
            }
        }
        assert!(open_edges(&triangles).is_empty());
        surface.extend(surface_of_triangles);
        let radii = surfaces.iter().map(|surface| surface.0).collect();
        Self { tree: Bvh::new(spheres, triangles.clone()), triangles, radii, surface }
    }

    /// A ray to a vertex, an edge or a face, along an edge, or along an axis; from the middle, from `between` two
    /// surfaces, from outside or from far away. With the radius at which it begins.
    fn ray(&self, between: f64, i: usize, random: &mut Random) -> Option<(Ray, f64)> {
        let triangle = |random: &mut Random| &self.triangles[random.below(self.triangles.len())];
        let aim = place(triangle(random), random);
        let direction = match i % 4 {
            0 | 3 => random.point(),
            1 => {
                let [a, b, _] = triangle(random).vertices();
                b - a
            }
            _ => [DVec3::X, DVec3::Y, DVec3::Z][random.below(3)],
        };
        let (origin, radius) = match i % 5 {
            0 => (DVec3::ZERO, 0.0),
            1 => (between * random.direction(), between),
            2 => (aim - 1e6 * direction, f64::INFINITY),
            _ => (aim - 8.0 * direction.normalize(), f64::INFINITY),
        };
        let towards = if i % 5 < 2 && i.is_multiple_of(4) { aim - origin } else { direction };
        Some((Ray::new(origin, towards).ok()?, radius))
    }

    /// Checks a ray that begins at this radius: its crossings are properly nested, a stack of surfaces, of which each
    /// is left as the last one entered.
    fn check(&self, crossings: &[Crossing], ray: &Ray, radius: f64) {
        let around = (0..self.radii.len()).rev().filter(|&surface| self.radii[surface] > radius);
        let mut inside: Vec<usize> = around.collect();
        for &Crossing { index, t, entering } in crossings {
            let surface = self.surface[index];
            if entering {
                assert!(!inside.contains(&surface), "{surface} is entered twice, at {t:e} of {ray:?}: {crossings:?}");
                inside.push(surface);
            } else {
                assert_eq!(inside.pop(), Some(surface), "at {t:e} of {ray:?}: {crossings:?}");
            }
        }
        assert!(inside.is_empty(), "{ray:?} ends in {inside:?}: {crossings:?}");
    }
}

#[test]
fn lines_through_nested_surfaces_are_properly_nested() {
    let random = &mut Random::new(3);
    // A mesh in a mesh in a sphere; the outer two are near each other.
    let nested = Nested::new(&[(1.0, Some(2)), (2.0, Some(3)), (2.0 + 1e-9, None)]);
    let mut crossings = Vec::new();
    let mut total = 0;
    for i in 0..100_000 {
        let Some((ray, radius)) = nested.ray(1.5, i, random) else { continue };
        nested.tree.crossings(&ray, &mut crossings);
        nested.check(&crossings, &ray, radius);
        total += crossings.len();
    }
    assert!(total > 100_000, "{total}");
}

/// A thousand crossings; with `RT_LONG` 10^9, in parallel.
#[test]
fn no_crossing_of_many_is_lost() {
    const ROWS: usize = 1000;
    let shell = |i: i32, cut| (1.05f64.powi(i) * if cut { 1.0 } else { 1.0001 }, cut.then_some(3));
    let nested = Nested::new(&(0..12).flat_map(|i| [shell(i, true), shell(i, false)]).collect::<Vec<_>>());
    let wanted = if std::env::var_os("RT_LONG").is_some() { 1_000_000_000 } else { 1000 };
    let total = AtomicUsize::new(0);
    // A line crosses 21 surfaces on average.
    (0..wanted / 20 / ROWS + 1).into_par_iter().for_each(|seed| {
        let random = &mut Random::new(1000 + seed as u64);
        let between = 1.025 * 1.05f64.powi(random.integer(0..11));
        let rays: Vec<(Ray, f64)> = (0..ROWS).filter_map(|i| nested.ray(between, i, random)).collect();
        let mut crossings = vec![Vec::new(); rays.len()];
        nested.tree.crossings_batch(&rays.iter().map(|row| row.0).collect::<Vec<_>>(), &mut crossings);
        for ((ray, radius), crossings) in rays.iter().zip(&crossings) {
            nested.check(crossings, ray, *radius);
        }
        total.fetch_add(crossings.iter().map(Vec::len).sum(), Relaxed);
    });
    assert!(total.load(Relaxed) >= wanted, "{total:?} crossings of {wanted}");
}

/// The parameter of a crossing of the ray turned by `e = 2^-100`, small enough beside the whole numbers of these cases:
/// by the formulas, in 4000 bits. Two of them differ in 3000 bits, or for no `e` at all.
fn turned_parameter(ray: &Ray, shape: Shape, entering: bool) -> Big {
    let long = |x: Big| x.with_precision(4000).value();
    let mut direction = vector(ray.direction());
    for (part, power) in direction.iter_mut().zip([-100, -200, -300]) {
        *part = &*part + power_of_two(power);
    }
    let from = |place: DVec3| sub(&vector(place), &vector(ray.origin()));
    match shape {
        Shape::Triangle(triangle) => {
            let [a, b, c] = triangle.vertices().map(from);
            let normal = oracle::cross(&sub(&b, &a), &sub(&c, &a));
            long(dot(&normal, &a)) / long(dot(&normal, &direction))
        }
        Shape::Sphere(sphere) => {
            let w = from(sphere.center());
            let (a, b) = (dot(&direction, &direction), dot(&w, &direction));
            let c = dot(&w, &w) - exact(sphere.radius()) * exact(sphere.radius());
            let root = long(&b * &b - &a * c).sqrt();
            (long(b) + if entering { -root } else { root }) / long(a)
        }
    }
}

#[test]
fn surfaces_that_touch_are_crossed_in_the_order_of_the_turned_ray() {
    let random = &mut Random::new(9);
    let (mut together, mut against_index) = ([0; 3], 0);
    for _ in 0..cases(LONG) {
        // Spheres and triangles through one point with whole coordinates, and a ray to it.
        let grid = |random: &mut Random, most: i32| DVec3::from_array(random.whole_vector(most));
        let point = grid(random, 2);
        let mut list = List::default();
        for _ in 0..random.below(4) {
            let mut offset = random.pick(&[[1.0, 2.0, 2.0], [0.0, 0.0, 1.0], [0.0, 3.0, 4.0], [0.0, 0.0, 2.0]]);
            random.shuffle(&mut offset);
            let offset = DVec3::from_array(offset.map(|x| x * random.sign())) * random.pick(&[1.0, 2.0]);
            list.spheres.push(Sphere::new(point + offset, offset.length()).unwrap());
        }
        for _ in 0..random.below(4) {
            let [u, v] = [0; 2].map(|_| grid(random, 2));
            let a = random.pick(&[point, point - u, point - u - v]);
            list.triangles.push(Triangle::new(a, point + u, point + v).unwrap());
        }
        let most = random.pick(&[1, 3]);
        let Ok(ray) = Ray::new(point, grid(random, most)) else { continue };
        let ray = Ray::new(point - random.pick(&[1.0, 2.0]) * ray.direction(), ray.direction()).unwrap();
        let mut crossings = Vec::new();
        list.crossings(&ray, &mut crossings);
        for pair in crossings.windows(2) {
            let [a, b] = [0, 1].map(|i| turned_parameter(&ray, list.shape(pair[i].index), pair[i].entering));
            let gap = &b - &a;
            let tied = gap < power_of_two(-3000) && gap > -power_of_two(-3000);
            assert!(if tied { pair[0].index < pair[1].index } else { a < b }, "{list:?}, {ray:?}: {pair:?}");
            if pair[0].t == pair[1].t && pair[0].index != pair[1].index {
                together[pair.iter().filter(|crossing| crossing.index < list.spheres.len()).count()] += 1;
                against_index += usize::from(pair[0].index > pair[1].index);
            }
        }
    }
    assert!(together.iter().all(|&n| n > 100) && against_index > 300, "{together:?} {against_index}");
}

#[test]
fn points_beside_faces_are_inside_or_outside_exactly() {
    let random = &mut Random::new(4);
    let mut counts = [0; 3];
    for offset in [0.0, 4e5, 5e6] {
        let center = DVec3::splat(offset);
        let triangles = ball_mesh(3, 1.0, center);
        let tree = Bvh::new(vec![], triangles.clone());
        for i in 0..cases(LONG) / 3 {
            let triangle = &triangles[random.below(triangles.len())];
            let normal = triangle.normal().unwrap();
            let distance = [0.0, random.power(-44..-24), -random.power(-44..-24)][i % 3];
            let point = place(triangle, random) + distance * normal;
            // The mesh is convex but for rounding: a point surely within or beyond every plane but its neighbours'
            // is judged by three other directions, with the rule that counts every crossing once.
            let parity = |direction: DVec3| {
                let ray = Ray::new(point, direction).unwrap();
                triangles.iter().filter(|triangle| triangle.crosses(&ray)).count() % 2 == 1
            };
            let on = triangles.iter().any(|triangle| {
                let [a, b, c] = triangle.vertices().map(vector);
                let (e, f, p) = (sub(&b, &a), sub(&c, &a), sub(&vector(point), &a));
                let near = (point - triangle.vertices()[0]).length() < 1.0;
                near && sign(&dot(&oracle::cross(&e, &f), &p)).is_eq() && triangle.holds(point)
            });
            let side = tree.contains(point);
            counts[side as usize] += 1;
            assert_eq!(side == Side::On, on, "{point:?} at {offset:e}");
            if !on && i % 16 == 0 {
                let inside = [DVec3::X, random.point(), random.point()].map(parity);
                assert_eq!(inside, [side == Side::Inside; 3], "{point:?} at {offset:e}");
            }
        }
    }
    assert!(counts.iter().all(|&n| n > 100), "{counts:?}");
}

#[test]
fn a_cube_contains_what_lies_between_its_faces() {
    let random = &mut Random::new(5);
    let tree = Bvh::new(vec![], cube());
    let mut counts = [0; 3];
    for _ in 0..cases(LONG) {
        let number = |random: &mut Random| {
            let near = [1.0, 1f64.next_up(), 1f64.next_down(), 0.0, 0.5, 2.0][random.below(6)];
            near * random.sign()
        };
        let point = DVec3::from_array([0; 3].map(|_| number(random)));
        let reach = point.abs().max_element();
        let expected = match reach.partial_cmp(&1.0).unwrap() {
            std::cmp::Ordering::Less => Side::Inside,
            std::cmp::Ordering::Equal => Side::On,
            std::cmp::Ordering::Greater => Side::Outside,
        };
        assert_eq!(tree.contains(point), expected, "{point:?}");
        counts[expected as usize] += 1;
    }
    assert!(counts.iter().all(|&n| n > 100), "{counts:?}");
    assert_eq!(tree.contains(DVec3::NAN), Side::Outside);
}

#[test]
fn batches_answer_as_single_questions_do() {
    let random = &mut Random::new(6);
    let list = scene(random);
    let tree = Bvh::new(list.spheres.clone(), list.triangles.clone());
    let rays: Vec<Ray> = (0..200).map(|_| Ray::new(9.0 * random.point(), random.point()).unwrap()).collect();
    let points: Vec<DVec3> = (0..200).map(|_| 5.0 * random.point()).collect();
    // One after the other or together, as is faster here, and surely together.
    let flying = ["avx512", "avx2", "neon", "sse2"].iter().find_map(|name| tree.clone().with_simd(name));
    for tree in [Some(tree), flying].into_iter().flatten() {
        let (mut hits, mut crossings) = (vec![Vec::new(); 200], vec![Vec::new(); 200]);
        let (mut counts, mut sides) = (vec![0; 200], vec![Side::On; 200]);
        tree.hits_batch(&rays, AHEAD, &mut hits);
        tree.count_batch(&rays, AHEAD, &mut counts);
        tree.crossings_batch(&rays, &mut crossings);
        tree.contains_batch(&points, &mut sides);
        let (mut one, mut pass) = (Vec::new(), Vec::new());
        for (i, ray) in rays.iter().enumerate() {
            tree.hits(ray, AHEAD, &mut one);
            tree.crossings(ray, &mut pass);
            assert_eq!((&hits[i], counts[i], &crossings[i]), (&one, one.len(), &pass));
            assert_eq!(sides[i], tree.contains(points[i]));
        }
    }
}

#[test]
fn a_hole_has_its_edges() {
    let mut triangles = ball_mesh(2, 1.0, DVec3::ZERO);
    assert!(open_edges(&triangles).is_empty());
    let taken = triangles.remove(7);
    let open = open_edges(&triangles);
    let mut ends: Vec<[DVec3; 2]> = open.iter().map(|edge| edge.ends).collect();
    assert_eq!(ends.len(), 3);
    let [a, b, c] = taken.vertices();
    ends.retain(|&[p, q]| ![[a, b], [b, c], [c, a]].iter().any(|&[x, y]| [p, q] == [x, y] || [p, q] == [y, x]));
    assert!(ends.is_empty(), "{open:?}");
    // A triangle without area closes nothing, and -0 is 0.
    triangles.push(Triangle::new(a, a, b).unwrap());
    assert_eq!(open_edges(&triangles).len(), 3);
    let negative_zeros = |v: DVec3| DVec3::from_array(v.to_array().map(|x| if x == 0.0 { -0.0 } else { x }));
    triangles.push(Triangle::new(a, negative_zeros(b), c).unwrap());
    assert!(open_edges(&triangles).is_empty());
}
