//! A closed mesh cannot be passed: a ray from inside hits it, a ray through a shared edge or vertex hits every triangle
//! that owns it, and crossings count to inside or outside whatever the ray passes through.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use oracle::{Crossing, Random, cases, sub, vector};
use rt_geom::{Ray, Triangle, Verdict};

const ALL: std::ops::Range<f64> = 0.0..f64::INFINITY;

/// Random cases per class with `RT_LONG`, instead of ten thousand.
const LONG: usize = 500_000;

/// A closed mesh, its vertices on a grid of `2^-20`: differences of points of the grid are exact, so that a ray can be
/// aimed at a vertex or the middle of an edge and meets it exactly.
struct Mesh {
    name: &'static str,
    vertices: Vec<DVec3>,
    faces: Vec<[usize; 3]>,
    /// A point inside, from which rays start.
    inside: DVec3,
    convex: bool,
}

fn to_grid(v: DVec3) -> DVec3 {
    (v * 2f64.powi(20)).round() * 2f64.powi(-20)
}

impl Mesh {
    fn new(name: &'static str, vertices: Vec<DVec3>, faces: Vec<[usize; 3]>, inside: DVec3, convex: bool) -> Self {
        // Closed: each edge is used once in each direction.
        let mut edges: Vec<(usize, usize)> = faces.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]).collect();
        edges.sort_unstable();
        for &(a, b) in &edges {
            assert!(edges.binary_search(&(b, a)).is_ok(), "{name} is open at {a}-{b}");
        }
        let count = edges.len();
        edges.dedup();
        assert_eq!(edges.len(), count, "{name} uses an edge twice");
        Self { name, vertices: vertices.into_iter().map(to_grid).collect(), faces, inside, convex }
    }

    fn triangles(&self) -> Vec<Triangle> {
        let [v, f] = [&self.vertices, &self.vertices];
        self.faces.iter().map(|&[a, b, c]| Triangle::new(v[a], f[b], v[c]).unwrap()).collect()
    }

    fn icosphere(subdivisions: usize) -> Self {
        let phi = (1.0 + 5f64.sqrt()) / 2.0;
        let mut vertices = vec![];
        for (x, y) in [(-1.0, phi), (1.0, phi), (-1.0, -phi), (1.0, -phi)] {
            vertices.extend([DVec3::new(x, y, 0.0), DVec3::new(0.0, x, y), DVec3::new(y, 0.0, x)]);
        }
        // The faces are the triples of vertices at the least distance, 2, turned outward.
        let mut faces = vec![];
        let near = |v: &[DVec3], i: usize, j: usize| (v[i].distance(v[j]) - 2.0).abs() < 0.1;
        for i in 0..12 {
            for j in i + 1..12 {
                for k in j + 1..12 {
                    if near(&vertices, i, j) && near(&vertices, j, k) && near(&vertices, k, i) {
                        let n = (vertices[j] - vertices[i]).cross(vertices[k] - vertices[i]);
                        faces.push(if n.dot(vertices[i]) > 0.0 { [i, j, k] } else { [i, k, j] });
                    }
                }
            }
        }
        for _ in 0..subdivisions {
            let mut middles = std::collections::HashMap::new();
            faces = faces
                .into_iter()
                .flat_map(|[a, b, c]| {
                    let mut middle = |i: usize, j: usize| {
                        *middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                            vertices.push((vertices[i] + vertices[j]).normalize() * vertices[i].length());
                            vertices.len() - 1
                        })
                    };
                    let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
                })
                .collect();
        }
        Self::new("icosphere", vertices, faces, DVec3::new(0.125, 0.25, -0.0625), true)
    }

    /// A prism over a polygon, whose caps are fans around the polygon's first vertex.
    fn prism(name: &'static str, polygon: &[(f64, f64)], inside: DVec3, convex: bool) -> Self {
        let n = polygon.len();
        let at = |z: f64| polygon.iter().map(move |&(x, y)| DVec3::new(x, y, z));
        let mut faces: Vec<[usize; 3]> = (1..n - 1).flat_map(|i| [[0, i + 1, i], [n, n + i, n + i + 1]]).collect();
        for i in 0..n {
            let j = (i + 1) % n;
            faces.extend([[i, j, n + j], [i, n + j, n + i]]);
        }
        Self::new(name, at(0.0).chain(at(1.0)).collect(), faces, inside, convex)
    }

    fn cube() -> Self {
        let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        Self::prism("cube", &square, DVec3::new(0.5, 0.375, 0.625), true)
    }

    /// Three cubes in an L: from inside, a ray may run along the plane of a face.
    fn corner() -> Self {
        let polygon = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)];
        Self::prism("corner", &polygon, DVec3::new(0.5, 0.5, 0.5), false)
    }

    /// Two fans of thin triangles, base to base.
    fn fan() -> Self {
        let count = 96;
        let ring = |i: usize| {
            let angle = i as f64 / count as f64 * TAU;
            DVec3::new(angle.cos(), angle.sin(), 0.0)
        };
        let mut vertices: Vec<_> = (0..count).map(ring).collect();
        vertices.extend([DVec3::new(0.25, 0.0, 1.0), DVec3::new(0.0, 0.125, -0.01)]);
        let faces = (0..count)
            .flat_map(|i| {
                let j = (i + 1) % count;
                [[i, j, count], [j, i, count + 1]]
            })
            .collect();
        Self::new("fan", vertices, faces, DVec3::new(0.125, 0.0, 0.25), true)
    }

    fn torus() -> Self {
        let (around, across) = (24, 12);
        let mut vertices = vec![];
        for i in 0..around {
            let (sin, cos) = (i as f64 / around as f64 * TAU).sin_cos();
            for j in 0..across {
                let (s, c) = (j as f64 / across as f64 * TAU + PI / 7.0).sin_cos();
                let r = 1.0 + 0.375 * c;
                vertices.push(DVec3::new(r * cos, r * sin, 0.375 * s));
            }
        }
        let at = |i: usize, j: usize| i % around * across + j % across;
        let faces = (0..around * across)
            .flat_map(|k| {
                let (i, j) = (k / across, k % across);
                let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                [[a, b, c], [a, c, d]]
            })
            .collect();
        Self::new("torus", vertices, faces, DVec3::new(1.0, 0.125, 0.0625), false)
    }

    fn all() -> [Self; 5] {
        [Self::icosphere(2), Self::cube(), Self::corner(), Self::fan(), Self::torus()]
    }

    fn random_inside(&self, rng: &mut Random) -> DVec3 {
        to_grid(self.inside + 0.0625 * rng.point())
    }
}

fn hits(triangles: &[Triangle], ray: &Ray) -> usize {
    triangles.iter().filter(|triangle| triangle.any(ray, ALL)).count()
}

fn crossings(triangles: &[Triangle], ray: &Ray) -> usize {
    triangles.iter().filter(|triangle| triangle.crosses(ray)).count()
}

/// Checks a ray from inside the mesh.
fn check_from_inside(mesh: &Mesh, triangles: &[Triangle], ray: &Ray) {
    assert!(hits(triangles, ray) > 0, "{} leaks along {ray:?}", mesh.name);
    let crossings = crossings(triangles, ray);
    assert_eq!(crossings % 2, 1, "{}: {crossings} crossings along {ray:?}", mesh.name);
    assert!(crossings == 1 || !mesh.convex, "{}: {crossings} crossings along {ray:?}", mesh.name);
}

#[test]
fn rays_through_vertices_hit_every_triangle_around() {
    let mut rng = Random::new(1);
    for mesh in Mesh::all() {
        let triangles = mesh.triangles();
        for (i, &vertex) in mesh.vertices.iter().enumerate() {
            let origin = mesh.random_inside(&mut rng);
            let ray = Ray::new(origin, vertex - origin).unwrap();
            check_from_inside(&mesh, &triangles, &ray);
            for (face, triangle) in mesh.faces.iter().zip(&triangles) {
                let Some(corner) = face.iter().position(|&j| j == i) else { continue };
                let verdict = triangle.verdict(&ray);
                let expected = [Verdict::Vertex(corner), Verdict::Parallel];
                assert!(expected.contains(&verdict), "{} vertex {i}: {verdict:?}", mesh.name);
                if verdict.is_hit() {
                    assert_eq!(triangle.closest(&ray, ALL), Some(1.0), "{} vertex {i}", mesh.name);
                }
            }
        }
    }
}

#[test]
fn rays_through_edges_hit_both_triangles() {
    let mut rng = Random::new(2);
    for mesh in Mesh::all() {
        let triangles = mesh.triangles();
        for face in &mesh.faces {
            for i in 0..3 {
                let (a, b) = (face[i], face[(i + 1) % 3]);
                let origin = mesh.random_inside(&mut rng);
                let middle = (mesh.vertices[a] + mesh.vertices[b]) / 2.0;
                let ray = Ray::new(origin, middle - origin).unwrap();
                check_from_inside(&mesh, &triangles, &ray);
                for (other, triangle) in mesh.faces.iter().zip(&triangles) {
                    let Some(edge) = (0..3).find(|&k| {
                        let ends = (other[k], other[(k + 1) % 3]);
                        ends == (a, b) || ends == (b, a)
                    }) else {
                        continue;
                    };
                    let verdict = triangle.verdict(&ray);
                    let expected = [Verdict::Edge(edge), Verdict::Parallel];
                    assert!(expected.contains(&verdict), "{} edge {a}-{b}: {verdict:?}", mesh.name);
                }
            }
        }
    }
}

#[test]
fn random_rays_from_inside_do_not_leak() {
    let mut rng = Random::new(3);
    for mesh in Mesh::all() {
        let triangles = mesh.triangles();
        for _ in 0..cases(LONG) / 20 {
            let ray = Ray::new(mesh.random_inside(&mut rng), rng.point()).unwrap();
            check_from_inside(&mesh, &triangles, &ray);
            // so near an edge that rounding decides
            let face = rng.pick(&mesh.faces);
            let s = rng.uniform().abs();
            let target = mesh.vertices[face[0]] + s * (mesh.vertices[face[1]] - mesh.vertices[face[0]]);
            let origin = mesh.inside + 0.0625 * rng.point();
            check_from_inside(&mesh, &triangles, &Ray::new(origin, target - origin).unwrap());
        }
    }
}

#[test]
fn the_number_of_triangles_hit_is_exact() {
    let mut rng = Random::new(4);
    for mesh in Mesh::all() {
        let triangles = mesh.triangles();
        for i in 0..60 {
            let vertex = rng.pick(&mesh.vertices);
            let origin = if i % 2 == 0 { to_grid(4.0 * rng.point()) } else { mesh.random_inside(&mut rng) };
            let target = if i % 3 == 0 { (vertex + rng.pick(&mesh.vertices)) / 2.0 } else { vertex };
            let ray = Ray::new(origin, target - origin).unwrap();
            let seen = |v: DVec3| sub(&vector(v), &vector(origin));
            let truth = |triangle: &Triangle| Crossing::new(&vector(ray.direction()), triangle.vertices().map(seen));
            let truths: Vec<Crossing> = triangles.iter().map(truth).collect();
            let expected = truths.iter().filter(|truth| truth.place().is_hit() && truth.is_ahead()).count();
            assert_eq!(hits(&triangles, &ray), expected, "{} {ray:?}", mesh.name);
            let expected = truths.iter().filter(|truth| truth.crosses()).count();
            assert_eq!(crossings(&triangles, &ray), expected, "{} {ray:?}", mesh.name);
        }
    }
}

/// From outside, a ray at a vertex or an edge may pass through or only touch: crossings are even, on a convex mesh 0 or
/// 2.
#[test]
fn rays_from_outside_cross_an_even_number_of_times() {
    let mut rng = Random::new(5);
    for mesh in Mesh::all() {
        let triangles = mesh.triangles();
        let (mut touched, mut passed) = (0, 0);
        for i in 0..cases(LONG) / 20 {
            let vertex = rng.pick(&mesh.vertices);
            let target = if i % 2 == 0 { vertex } else { (vertex + rng.pick(&mesh.vertices)) / 2.0 };
            let mut away = rng.point();
            if i % 4 < 2 {
                away.z = 0.0; // in the planes of the cube's caps, past the apex of the fan
            }
            let origin = to_grid(target + 5.0 * away.normalize());
            let ray = Ray::new(origin, target - origin).unwrap();
            let (hits, crossings) = (hits(&triangles, &ray), crossings(&triangles, &ray));
            assert_eq!(crossings % 2, 0, "{}: {crossings} crossings along {ray:?}", mesh.name);
            assert!(crossings <= 2 || !mesh.convex, "{}: {crossings} crossings along {ray:?}", mesh.name);
            touched += usize::from(hits > 0 && crossings == 0);
            passed += usize::from(crossings > 0);
        }
        assert!(touched > 0 && passed > 0, "{}: {touched} touched, {passed} passed", mesh.name);
    }
}

/// Every ray of a lattice, most of them along planes, edges and through vertices: parity is inside or outside.
#[test]
fn parity_tells_inside_from_outside_on_a_lattice() {
    let mesh = Mesh::corner();
    let triangles = mesh.triangles();
    let steps = || (-1..=5).map(|i| f64::from(i) / 2.0);
    let inside_of = |p: DVec3, low: DVec3, high: DVec3| p.cmpgt(low).all() && p.cmplt(high).all();
    let (mut inner, mut outer) = (0, 0);
    for p in steps().flat_map(|x| steps().map(move |y| (x, y))) {
        for z in [-0.5, 0.0, 0.5, 1.0] {
            let p = DVec3::new(p.0, p.1, z);
            // The two arms of the L, and with them the seam between.
            let inside = inside_of(p, DVec3::ZERO, DVec3::new(2.0, 1.0, 1.0))
                || inside_of(p, DVec3::ZERO, DVec3::new(1.0, 2.0, 1.0));
            let closed = |high: DVec3| p.cmpge(DVec3::ZERO).all() && p.cmple(high).all();
            let outside = !closed(DVec3::new(2.0, 1.0, 1.0)) && !closed(DVec3::new(1.0, 2.0, 1.0));
            if !inside && !outside {
                continue; // on the surface
            }
            for k in 0..125 {
                let part = |k: i32| f64::from(k % 5 - 2);
                let Ok(ray) = Ray::new(p, DVec3::new(part(k), part(k / 5), part(k / 25))) else { continue };
                let odd = crossings(&triangles, &ray) % 2 == 1;
                assert_eq!(odd, inside, "{ray:?}");
                (inner, outer) = if inside { (inner + 1, outer) } else { (inner, outer + 1) };
            }
        }
    }
    assert!(inner > 500 && outer > 5000, "{inner} inside, {outer} outside");
}

/// A panorama from inside a closed mesh: single-precision tracers let some of its rays through.
#[test]
fn all_rays_of_a_panorama_from_inside_hit() {
    let mesh = Mesh::icosphere(1);
    let triangles = mesh.triangles();
    let (width, height) = (1024, 512);
    for j in 0..height {
        let (sin, cos) = ((f64::from(j) + 0.5) / f64::from(height) * PI).sin_cos();
        for i in 0..width {
            let (s, c) = (f64::from(i) / f64::from(width) * TAU).sin_cos();
            let ray = Ray::new(mesh.inside, DVec3::new(sin * c, sin * s, cos)).unwrap();
            assert!(triangles.iter().any(|triangle| triangle.any(&ray, ALL)), "{ray:?} leaks");
        }
    }
}

/// A ray from outside through the middle: entry and exit are both found, in order.
#[test]
fn entry_and_exit_are_both_found() {
    let mut rng = Random::new(6);
    let mesh = Mesh::icosphere(2);
    let triangles = mesh.triangles();
    for _ in 0..cases(LONG) / 20 {
        let origin = 100.0 * rng.point().normalize();
        let ray = Ray::new(origin, 0.5 * rng.point() - origin).unwrap();
        let mut t: Vec<f64> = triangles.iter().filter_map(|triangle| triangle.closest(&ray, ALL)).collect();
        t.sort_by(f64::total_cmp);
        t.dedup();
        assert_eq!(t.len(), 2, "{ray:?} meets the sphere at {t:?}");
        assert!(ray.at(t[0]).dot(ray.direction()) < 0.0 && ray.at(t[1]).dot(ray.direction()) > 0.0);
    }
}
