//! The cases that methods are measured on: for each kernel an ordinary class, then one for each way to be hard.
//!
//! Everything follows from a fixed seed.

use std::f64::consts::{PI, TAU};

use pxfm::{f_cos, f_sin};

use super::methods::{COUNT, MATERIAL, SIDE};
use super::random::{Random, combination, cross, join, length, plus, size};

/// A named set of cases of `M` numbers.
pub(super) struct Class<const M: usize> {
    pub(super) name: &'static str,
    pub(super) cases: Vec<[f64; M]>,
}

/// Makes `count` cases that pass `valid`.
pub(super) fn class<const M: usize>(
    name: &'static str,
    count: usize,
    valid: fn(&[f64; M]) -> bool,
    mut make: impl FnMut(&mut Random) -> [f64; M],
) -> Class<M> {
    let seed = name.bytes().fold(M as u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3));
    let mut random = Random::new(seed);
    let finite = |case: &[f64; M]| case.iter().all(|x| x.is_finite());
    let cases = std::iter::repeat_with(|| make(&mut random)).filter(|case| finite(case) && valid(case));
    Class { name, cases: cases.take(count).collect() }
}

pub(super) fn quadratic(count: usize) -> Vec<Class<3>> {
    let class = |name, make: fn(&mut Random) -> [f64; 3]| class(name, count, |_| true, make);
    vec![
        class("ordinary", |r| r.vector(10.0)),
        class("nearly double roots", |r| {
            let (a, x) = (r.within(0.1, 10.0), r.within(-10.0, 10.0));
            [a, r.near(-2.0 * a * x), r.near(a * x * x)]
        }),
        class("double roots", |r| {
            let (m, n) = (r.whole(1, 9999), r.whole(-9999, 9999));
            [m * m, 2.0 * m * n, n * n]
        }),
        class("roots far apart", |r| [r.within(-1.0, 1.0), r.exponent(3.0, 12.0), r.within(-1.0, 1.0)]),
        class("whole range", |r| [0; 3].map(|_| r.exponent(-307.0, 307.0))),
        class("subnormal", |r| r.whole_vector(20).map(|x| x * f64::from_bits(1))),
        class("zero coefficients, signed", |r| r.signed_vector(1)),
    ]
}

pub(super) fn sphere(count: usize) -> Vec<Class<10>> {
    let valid = |case: &[f64; 10]| case[3..6] != [0.0; 3] && case[9] >= 0.0;
    let class = |name, make: fn(&mut Random) -> [f64; 10]| class(name, count, valid, make);
    vec![
        class("ordinary", |r| join(&[&r.vector(5.0), &r.vector(1.0), &r.vector(2.0), &[r.within(0.5, 3.0)]])),
        class("nearly tangent", |r| {
            let (center, radius, d) = (r.vector(5.0), r.within(0.1, 3.0), r.unit());
            let outward = cross(d, r.unit());
            let outward = outward.map(|x| x / length(outward));
            let point = plus(center, outward, r.near(radius));
            join(&[&plus(point, d, -r.within(1.0, 9.0)), &d, &center, &[radius]])
        }),
        class("tangent", |r| {
            let (center, k) = (r.whole_vector(99), r.whole(1, 99));
            let origin = [center[0] + 3.0 * k, center[1] + 4.0 * k, r.near(center[2] + 200.0)];
            join(&[&origin, &[0.0, 0.0, -r.whole(1, 9)], &center, &[r.near(5.0 * k)]])
        }),
        class("far and small", |r| {
            let (d, radius) = (r.unit(), size(r.within(-12.0, -3.0)));
            let center = plus([0.0; 3], d, 1.0);
            let target = plus(center, r.unit(), radius * r.within(0.0, 1.2));
            join(&[&[0.0; 3], &target, &center, &[radius]])
        }),
        class("huge ground", |r| {
            let radius = size(r.within(6.0, 12.0));
            let origin = [r.within(-9.0, 9.0), r.within(0.0, 2.0), r.within(-9.0, 9.0)];
            join(&[&origin, &r.unit(), &[0.0, -radius, 0.0], &[radius]])
        }),
        class("origin on the surface", |r| {
            let (center, radius) = (r.vector(5.0), r.within(0.1, 3.0));
            join(&[&plus(center, r.unit(), radius), &r.unit(), &center, &[radius]])
        }),
        class("origin just off the surface", |r| {
            let (center, radius) = (r.vector(5.0), r.within(0.1, 3.0));
            let (outward, off) = (r.unit(), r.exponent(-16.0, -6.0));
            join(&[&plus(center, outward, radius + off), &r.unit(), &center, &[radius]])
        }),
        class("along an axis, signed zeros", |r| {
            let (origin, d) = (r.signed_vector(3), r.signed_vector(1));
            join(&[&origin, &d, &r.signed_vector(1), &[r.whole(0, 2)]])
        }),
        class("subnormal", |r| {
            let [origin, center] = [9, 2].map(|reach| r.whole_vector(reach));
            let d = r.whole_vector(9);
            join::<10>(&[&origin, &d, &center, &[r.whole(1, 4)]]).map(|x| x * f64::from_bits(1))
        }),
        class("radius 0", |r| {
            let (origin, d) = (r.whole_vector(9), r.whole_vector(9));
            join(&[&origin, &d, &plus(origin, d, r.whole(0, 4)).map(|x| r.near(x)), &[0.0]])
        }),
        class("whole range", |r| {
            let scale = size(r.within(-300.0, 300.0));
            let stretch = size(r.within(-300.0, 300.0));
            let [origin, center] = [5.0, 2.0].map(|reach| r.vector(reach).map(|x| x * scale));
            join(&[&origin, &r.vector(1.0).map(|x| x * stretch), &center, &[r.within(0.5, 3.0) * scale]])
        }),
    ]
}

/// A triangle with whole coordinates and the point of it with the given whole weights, all times their sum.
fn aimed(r: &mut Random, weights: [f64; 3]) -> ([[f64; 3]; 3], [f64; 3]) {
    let sum: f64 = weights.iter().sum();
    let vertices = [0; 3].map(|_| r.whole_vector(99));
    let point = [0, 1, 2].map(|i| (0..3).map(|k| weights[k] * vertices[k][i]).sum());
    (vertices.map(|v| v.map(|x| x * sum)), point)
}

/// Rays and triangles: for the hit, and for the weights of the vertices at it.
pub(super) fn triangle(count: usize) -> Vec<Class<15>> {
    [triangles_hit, triangles_nearly_flat, triangles_in_plane, triangles_of_files, triangles_of_any_size]
        .into_iter()
        .flat_map(|classes| classes(count))
        .collect()
}

/// A class of rays and triangles.
fn rays(name: &'static str, count: usize, make: fn(&mut Random) -> [f64; 15]) -> Class<15> {
    class(name, count, |case| case[3..6] != [0.0; 3], make)
}

/// Through the middle, an edge, a vertex.
fn triangles_hit(count: usize) -> Vec<Class<15>> {
    let class = |name, make| rays(name, count, make);
    vec![
        class("ordinary", |r| {
            let vertices = [0; 3].map(|_| r.vector(3.0));
            let target = plus([0.0; 3], r.vector(1.0), 1.0);
            let origin = r.vector(5.0);
            join(&[&origin, &plus(target, origin, -1.0), &vertices[0], &vertices[1], &vertices[2]])
        }),
        class("through an edge", |r| {
            let weights = [r.whole(1, 9), r.whole(1, 9), 0.0];
            ray_through(r, weights)
        }),
        class("through a vertex", |r| ray_through(r, [1.0, 0.0, 0.0])),
        class("near an edge", |r| {
            let weights = [r.whole(1, 9), r.whole(1, 9), 0.0];
            ray_through(r, weights).map(|x| r.near(x))
        }),
    ]
}

/// Nearly without area, and nearly edge-on.
fn triangles_nearly_flat(count: usize) -> Vec<Class<15>> {
    let class = |name, make| rays(name, count, make);
    vec![
        class("sliver", |r| {
            let (a, edge) = (r.vector(3.0), r.vector(2.0));
            let b = plus(a, edge, 1.0);
            let c = plus(plus(a, edge, r.within(0.2, 0.8)), r.unit(), size(r.within(-15.0, -6.0)));
            let origin = r.vector(5.0);
            let target = plus(a, edge, r.within(0.0, 1.0));
            join(&[&origin, &plus(target, origin, -1.0), &a, &b, &c])
        }),
        class("nearly edge-on", |r| {
            let [a, b, c] = [0; 3].map(|_| r.vector(3.0));
            let inside = plus(plus(a, plus(b, a, -1.0), 0.3), plus(c, a, -1.0), 0.3);
            let along = plus(plus(b, a, -1.0), plus(c, a, -1.0), r.within(-1.0, 1.0));
            let d = plus(along, r.unit(), size(r.within(-15.0, -6.0)));
            join(&[&plus(inside, d, -r.within(1.0, 3.0)), &d, &a, &b, &c])
        }),
    ]
}

/// Planes through the origin, rays in the plane, no area.
fn triangles_in_plane(count: usize) -> Vec<Class<15>> {
    let class = |name, make| rays(name, count, make);
    vec![
        class("plane through the origin", |r| {
            let (p, q) = (r.whole_vector(99), r.whole_vector(99));
            let [a, b, c] = [0; 3].map(|_| combination(p, r.whole(-9, 9), q, r.whole(-9, 9)));
            let target = plus(plus(a, plus(b, a, -1.0), 0.25), plus(c, a, -1.0), 0.25);
            let d = r.whole_vector(99);
            join(&[&plus(target, d, -2.0), &d, &a, &b, &c])
        }),
        class("ray in the plane", |r| {
            let [a, b, c] = [0; 3].map(|_| r.whole_vector(9));
            let d = plus(plus(b, a, -1.0), plus(c, a, -1.0), r.whole(-2, 2));
            join(&[&plus(a, d, -r.whole(0, 3)), &d, &a, &b, &c])
        }),
        class("no area", |r| {
            let (a, edge) = (r.whole_vector(99), r.whole_vector(9));
            let [b, c] = [0; 2].map(|_| plus(a, edge, r.whole(-9, 9)));
            let d = r.whole_vector(9);
            join(&[&plus(a, d, -1.0), &d, &a, &b, &c])
        }),
        class("along an axis, signed zeros", |r| {
            let [origin, d, a, b, c] = [2, 1, 2, 2, 2].map(|reach| r.signed_vector(reach));
            join(&[&origin, &d, &a, &b, &c])
        }),
    ]
}

/// Coordinates with few decimals.
fn triangles_of_files(count: usize) -> Vec<Class<15>> {
    let class = |name, make| rays(name, count, make);
    vec![
        class("mesh in hundredths", |r| {
            // A ray in any direction at a triangle whose corners have two decimals, as many files of meshes have.
            let origin = r.vector(5.0);
            let [a, b, c] = [0; 3].map(|_| r.whole_vector(300).map(|x| x / 100.0));
            let target =
                plus(plus(a, plus(b, a, -1.0), 0.5 * r.within(0.0, 1.0)), plus(c, a, -1.0), 0.5 * r.within(0.0, 1.0));
            join(&[&origin, &plus(target, origin, -1.0), &a, &b, &c])
        }),
        class("in tenths, at an edge", |r| {
            // Rays at a point of an edge, all rounded to a tenth: nearly exact ties.
            let [a, b] = [0; 2].map(|_| r.whole_vector(99).map(|x| x / 10.0));
            let c = r.whole_vector(99).map(|x| x / 10.0);
            let (origin, share) = (r.whole_vector(99).map(|x| x / 10.0), r.whole(0, 10) / 10.0);
            let target = plus(a, plus(b, a, -1.0), share);
            join(&[&origin, &plus(target, origin, -1.0), &a, &b, &c])
        }),
    ]
}

/// From one end of the doubles to the other.
fn triangles_of_any_size(count: usize) -> Vec<Class<15>> {
    let class = |name, make| rays(name, count, make);
    vec![
        class("subnormal", |r| {
            let [origin, a, b, c] = [9, 5, 5, 5].map(|reach| r.whole_vector(reach));
            let d = plus(r.whole_vector(3), origin, -1.0);
            join::<15>(&[&origin, &d, &a, &b, &c]).map(|x| x * f64::from_bits(1))
        }),
        class("whole range", |r| {
            let (scale, stretch) = (size(r.within(-300.0, 300.0)), size(r.within(-300.0, 300.0)));
            let vertices = [0; 3].map(|_| r.vector(3.0));
            let (origin, target) = (r.vector(5.0), r.vector(1.0));
            let d = plus(target, origin, -1.0).map(|x| x * stretch);
            let [origin, a, b, c] = [origin, vertices[0], vertices[1], vertices[2]].map(|p| p.map(|x| x * scale));
            join(&[&origin, &d, &a, &b, &c])
        }),
    ]
}

/// A ray, exact in whole numbers, through the point with the given weights.
fn ray_through(r: &mut Random, weights: [f64; 3]) -> [f64; 15] {
    let ([a, b, c], point) = aimed(r, weights);
    let d = r.whole_vector(99);
    join(&[&plus(point, d, -r.whole(1, 9)), &d, &a, &b, &c])
}

pub(super) fn inside(count: usize) -> Vec<Class<12>> {
    let class = |name, make: fn(&mut Random) -> [f64; 12]| class(name, count, |_| true, make);
    vec![
        class("ordinary", |r| {
            let [p, a, b, c] = [1.0, 3.0, 3.0, 3.0].map(|size| r.vector(size));
            join(&[&p, &a, &b, &c])
        }),
        class("on an edge", |r| {
            let weights = [r.whole(1, 9), r.whole(1, 9), 0.0];
            let ([a, b, c], p) = aimed(r, weights);
            join(&[&p, &a, &b, &c])
        }),
        class("near an edge", |r| {
            let weights = [r.whole(1, 9), r.whole(1, 9), 0.0];
            let ([a, b, c], p) = aimed(r, weights);
            join::<12>(&[&p, &a, &b, &c]).map(|x| r.near(x / 7.0))
        }),
        class("at a vertex", |r| {
            let [a, b, c] = [0; 3].map(|_| r.vector(3.0));
            join(&[&a.map(|x| r.near(x)), &a, &b, &c])
        }),
        class("off the plane", |r| {
            let weights = [r.whole(1, 9), r.whole(1, 9), 0.0];
            let ([a, b, c], p) = aimed(r, weights);
            let normal = cross(plus(b, a, -1.0), plus(c, a, -1.0));
            join(&[&plus(p, normal, r.whole(-9, 9)), &a, &b, &c])
        }),
        class("sliver", |r| {
            let (a, edge) = (r.vector(3.0), r.vector(2.0));
            let c = plus(plus(a, edge, r.within(0.2, 0.8)), r.unit(), size(r.within(-15.0, -6.0)));
            join(&[&plus(a, edge, r.within(0.0, 1.0)), &a, &plus(a, edge, 1.0), &c])
        }),
        class("no area", |r| {
            let (a, edge) = (r.whole_vector(99), r.whole_vector(9));
            let [p, b, c] = [0; 3].map(|_| plus(a, edge, r.whole(-9, 9)));
            join(&[&p, &a, &b, &c])
        }),
        class("subnormal", |r| {
            let [p, a, b, c] = [3, 5, 5, 5].map(|reach| r.whole_vector(reach));
            join::<12>(&[&p, &a, &b, &c]).map(|x| x * f64::from_bits(1))
        }),
        class("whole range", |r| {
            let scale = size(r.within(-300.0, 300.0));
            let [p, a, b, c] = [1.0, 3.0, 3.0, 3.0].map(|size| r.vector(size).map(|x| x * scale));
            join(&[&p, &a, &b, &c])
        }),
    ]
}

pub(super) fn pseudo_inverse(count: usize) -> Vec<Class<9>> {
    let class = |name, make: fn(&mut Random) -> [f64; 9]| class(name, count, |_| true, make);
    vec![
        class("ordinary", |r| [0; 9].map(|_| r.within(-1.0, 1.0))),
        class("graded", |r| {
            let scale = [0; 3].map(|_| size(r.within(-20.0, 20.0)));
            std::array::from_fn(|i| r.within(-1.0, 1.0) * scale[i % 3])
        }),
        class("ill-conditioned", |r| {
            let (a, b) = (r.vector(1.0), r.vector(1.0));
            let c = combination(a, r.within(-1.0, 1.0), b, r.within(-1.0, 1.0));
            let c = plus(c, r.unit(), size(r.within(-14.0, -4.0)));
            join(&[&a, &b, &c])
        }),
        class("rank 2", |r| {
            let (a, b) = (r.whole_vector(99), r.whole_vector(99));
            let (s, t) = (r.whole(-9, 9), r.whole(-9, 9));
            join(&[&a, &b, &combination(a, s, b, t)])
        }),
        class("rank 1", |r| {
            let (a, s) = (r.whole_vector(99), r.whole_vector(9));
            join(&[&a.map(|x| x * s[0]), &a.map(|x| x * s[1]), &a.map(|x| x * s[2])])
        }),
        class("vertices near a plane through the origin", |r| {
            let (p, q) = (r.whole_vector(99), r.whole_vector(99));
            let rows = [0; 3].map(|_| combination(p, r.whole(-9, 9), q, r.whole(-9, 9)).map(|x| r.near(x)));
            std::array::from_fn(|i| rows[i % 3][i / 3])
        }),
        class("signed zeros", |r| join(&[&r.signed_vector(1), &r.signed_vector(1), &r.signed_vector(1)])),
        class("subnormal", |r| [0; 9].map(|_| r.whole(-99, 99) * f64::from_bits(1))),
        class("whole range", |r| {
            let scale = size(r.within(-290.0, 290.0));
            [0; 9].map(|_| r.within(-1.0, 1.0) * scale)
        }),
    ]
}

/// The three vertices of a triangle, for the plane through them.
pub(super) fn plane(count: usize) -> Vec<Class<9>> {
    let class = |name, make: fn(&mut Random) -> [f64; 9]| class(name, count, |_| true, make);
    vec![
        class("ordinary", |r| [0; 9].map(|_| r.within(-3.0, 3.0))),
        class("far from the origin", |r| {
            let far = r.unit().map(|x| x * 1e6);
            let [a, b, c] = [0; 3].map(|_| plus(far, r.vector(1.0), 1.0));
            join(&[&a, &b, &c])
        }),
        class("sliver", |r| {
            let (a, edge) = (r.vector(3.0), r.vector(2.0));
            let c = plus(plus(a, edge, r.within(0.2, 0.8)), r.unit(), size(r.within(-12.0, -4.0)));
            join(&[&a, &plus(a, edge, 1.0), &c])
        }),
        class("nearly through the origin", |r| {
            let (p, q) = (r.vector(1.0), r.vector(1.0));
            let [a, b, c] = [0; 3].map(|_| combination(p, r.within(-3.0, 3.0), q, r.within(-3.0, 3.0)));
            join(&[&a, &b, &c])
        }),
        class("through the origin", |r| {
            let (p, q) = (r.whole_vector(99), r.whole_vector(99));
            let [a, b, c] = [0; 3].map(|_| combination(p, r.whole(-9, 9), q, r.whole(-9, 9)));
            join(&[&a, &b, &c])
        }),
        class("whole range", |r| {
            let scale = size(r.within(-290.0, 290.0));
            [0; 9].map(|_| r.within(-3.0, 3.0) * scale)
        }),
    ]
}

pub(super) fn reflection(count: usize) -> Vec<Class<6>> {
    let valid = |case: &[f64; 6]| case[3..] != [0.0; 3];
    let class = |name, make: fn(&mut Random) -> [f64; 6]| class(name, count, valid, make);
    vec![
        class("ordinary", |r| join(&[&r.vector(1.0), &r.unit()])),
        class("normal of any length", |r| join(&[&r.vector(1.0), &r.vector(9.0)])),
        class("normal in single precision", |r| {
            #[expect(clippy::cast_possible_truncation, reason = "a normal as a mesh file holds it")]
            let normal = r.unit().map(|x| f64::from(x as f32));
            join(&[&r.vector(1.0), &normal])
        }),
        class("grazing", |r| {
            let n = r.unit();
            let along = cross(n, r.unit());
            join(&[&plus(along, n, r.exponent(-16.0, -4.0)), &n])
        }),
        class("a component cancels", |r| {
            let n = r.unit();
            let v = r.vector(1.0);
            // v_0 is what makes the first component of the reflection nearly zero.
            let (nn, rest) = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2], v[1] * n[1] + v[2] * n[2]);
            join(&[&[r.near(2.0 * rest * n[0] / (nn - 2.0 * n[0] * n[0])), v[1], v[2]], &n])
        }),
        class("along an axis, signed zeros", |r| join(&[&r.signed_vector(2), &r.signed_vector(1)])),
        class("subnormal", |r| join::<6>(&[&r.whole_vector(20), &r.whole_vector(20)]).map(|x| x * f64::from_bits(1))),
        class("whole range", |r| {
            let (scale, stretch) = (size(r.within(-300.0, 300.0)), size(r.within(-300.0, 300.0)));
            join(&[&r.vector(1.0).map(|x| x * scale), &r.vector(1.0).map(|x| x * stretch)])
        }),
    ]
}

pub(super) fn mapping(count: usize) -> Vec<Class<3>> {
    let valid = |case: &[f64; 3]| *case != [0.0; 3];
    let class = |name, make: fn(&mut Random) -> [f64; 3]| class(name, count, valid, make);
    vec![
        class("ordinary", |r| r.unit()),
        class("any length", |r| {
            let scale = size(r.within(-9.0, 9.0));
            r.vector(1.0).map(|x| x * scale)
        }),
        class("seam", seam),
        class("poles", pole),
        class("axes, signed zeros", |r| r.signed_vector(1)),
        class("whole range", |r| [0; 3].map(|_| r.exponent(-307.0, 307.0))),
        class("subnormal", |r| r.whole_vector(20).map(|x| x * f64::from_bits(1))),
    ]
}

/// A normal off the axis, where every column ends.
pub(super) fn texel(count: usize) -> Vec<Class<3>> {
    let valid = |case: &[f64; 3]| case[0] != 0.0 || case[2] != 0.0;
    let class = |name, make: fn(&mut Random) -> [f64; 3]| class(name, count, valid, make);
    vec![
        class("ordinary", |r| r.unit()),
        class("any length", |r| {
            let scale = size(r.within(-9.0, 9.0));
            r.vector(1.0).map(|x| x * scale)
        }),
        class("border of two columns", |r| {
            let turn = (r.whole(0, 14) / f64::from(SIDE) - 0.5) * TAU;
            let (flat, y) = (r.within(0.1, 1.0), r.within(-1.0, 1.0));
            [r.near(flat * f_cos(turn)), y, r.near(flat * f_sin(turn))]
        }),
        class("border of two rows", |r| {
            let (turn, latitude) = (r.within(0.0, TAU), (0.5 - r.whole(1, 14) / f64::from(SIDE)) * PI);
            let flat = f_cos(latitude);
            [r.near(flat * f_cos(turn)), r.near(f_sin(latitude)), r.near(flat * f_sin(turn))]
        }),
        class("seam", seam),
        class("poles", pole),
        class("axes, signed zeros", |r| r.signed_vector(1)),
        class("whole range", |r| {
            // Where u is 1 less 10^-500, 2,048 bits tell.
            [0; 3].map(|_| r.exponent(-250.0, 250.0))
        }),
        class("subnormal", |r| r.whole_vector(20).map(|x| x * f64::from_bits(1))),
    ]
}

fn seam(r: &mut Random) -> [f64; 3] {
    let (x, y) = (-r.within(0.1, 1.0), r.within(-1.0, 1.0));
    let length = (x * x + y * y).sqrt();
    [x / length, y / length, r.exponent(-30.0, -6.0)]
}

fn pole(r: &mut Random) -> [f64; 3] {
    let tiny = size(r.within(-30.0, -6.0));
    let pole = r.sign();
    [r.within(-1.0, 1.0) * tiny, r.near(pole), r.within(-1.0, 1.0) * tiny]
}

/// Point, direction, normal, light, shininess.
pub(super) fn phong(count: usize) -> Vec<Class<13>> {
    let valid = |case: &[f64; 13]| case[3..6] != [0.0; 3] && case[6..9] != [0.0; 3] && case[9..12] != case[..3];
    let class = |name, make: fn(&mut Random) -> [f64; 13]| class(name, count, valid, make);
    vec![
        class("ordinary", |r| {
            let (point, normal) = (r.vector(2.0), r.unit());
            let light = plus(point, plus(r.unit(), normal, 1.0), 5.0);
            join(&[&point, &plus(r.unit(), normal, -1.0), &normal, &light, &[r.whole(1, 60)]])
        }),
        class("grazing view", |r| {
            let (point, normal) = (r.vector(2.0), r.unit());
            let view = plus(cross(normal, r.unit()), normal, -size(r.within(-16.0, -3.0)));
            let light = plus(point, plus(r.unit(), normal, 1.0), 5.0);
            join(&[&point, &view, &normal, &light, &[r.whole(1, 60)]])
        }),
        class("grazing light", |r| {
            let (point, normal) = (r.vector(2.0), r.unit());
            let towards = plus(cross(normal, r.unit()), normal, r.exponent(-16.0, -3.0));
            let light = plus(point, towards, 5.0);
            join(&[&point, &plus(r.unit(), normal, -1.0), &normal, &light, &[r.whole(1, 60)]])
        }),
        class("highlight, shininess to 10⁴", |r| highlight(r, 0.1)),
        class("grazing highlight, shininess to 10⁴", |r| {
            let flat = size(r.within(-6.0, -1.0));
            highlight(r, flat)
        }),
        class("normal and direction of any length", |r| {
            let (normal, d) = (r.exponent(-100.0, 100.0), r.exponent(-100.0, 100.0));
            let shininess = [r.whole(1, 60)];
            join(&[&r.vector(2.0), &r.unit().map(|x| x * d), &r.unit().map(|x| x * normal), &r.vector(5.0), &shininess])
        }),
        class("light very near", |r| {
            let (point, normal) = (r.vector(2.0), r.unit());
            let light = plus(point, plus(r.unit(), normal, 1.0), size(r.within(-12.0, -3.0)));
            join(&[&point, &plus(r.unit(), normal, -1.0), &normal, &light, &[r.whole(1, 60)]])
        }),
        class("border of two bytes", |r| {
            // The diffuse term alone: light from the eye's side, which sees the mirrored light behind itself.
            let (point, normal) = (r.vector(2.0), r.unit());
            let along = cross(normal, r.unit());
            let along = along.map(|x| x / length(along));
            let cosine = ((r.whole(34, 220) - 0.5) / 255.0 - MATERIAL.ambient) / MATERIAL.diffuse;
            let towards = plus(normal.map(|x| x * cosine), along, (1.0 - cosine * cosine).max(0.0).sqrt());
            let view = plus(along.map(|x| -x), normal, -1e-3);
            join(&[&point, &view, &normal, &plus(point, towards, 4.0), &[r.whole(1, 60)]])
        }),
        class("light at the horizon, seen in its mirror", |r| {
            let (point, normal) = (r.vector(2.0), r.unit());
            let along = cross(normal, r.unit());
            let towards = plus(along, normal, r.exponent(-18.0, -14.0));
            let view = plus(along, normal, -1e-3);
            join(&[&point, &view, &normal, &plus(point, towards, 5.0), &[r.whole(1, 20)]])
        }),
    ]
}

/// Seen near the mirrored direction, `flat` above the surface: where the power is steep.
fn highlight(r: &mut Random, flat: f64) -> [f64; 13] {
    let (point, normal) = (r.vector(2.0), r.unit());
    let along = cross(normal, r.unit());
    let light = plus(point, plus(along, normal, flat), 5.0);
    let off = size(r.within(-8.0, -1.0));
    let view = plus(plus(along, normal, -flat), r.unit(), off * flat);
    let shininess = size(r.within(0.0, 4.0)).max(1.0);
    join(&[&point, &view, &normal, &light, &[shininess]])
}

pub(super) fn enclosing(count: usize) -> Vec<Class<{ 4 * COUNT }>> {
    let valid = |case: &[f64; 4 * COUNT]| case.chunks_exact(4).all(|ball| ball[3] >= 0.0);
    let class = |name, make: fn(&mut Random) -> [f64; 4 * COUNT]| class(name, count, valid, make);
    vec![
        class("ordinary", |r| eight(r, |r| (r.vector(5.0), r.within(0.1, 2.0)))),
        class("points", |r| eight(r, |r| (r.vector(5.0), 0.0))),
        class("points of a grid", |r| eight(r, |r| (r.whole_vector(2), 0.0))),
        class("equal spheres of a grid", |r| eight(r, |r| (r.whole_vector(1), 1.0))),
        class("touching from inside", |r| {
            let (center, radius) = (r.vector(5.0), r.within(1.0, 3.0));
            let mut balls = eight(r, |r| (r.unit(), r.within(0.1, 0.9)));
            for ball in balls.chunks_exact_mut(4) {
                let at = plus(center, [ball[0], ball[1], ball[2]], radius * (1.0 - ball[3]));
                ball.copy_from_slice(&[at[0], at[1], at[2], radius * ball[3]]);
            }
            balls[..4].copy_from_slice(&[center[0], center[1], center[2], radius]);
            balls
        }),
        class("all the same", |r| {
            let (center, radius) = (r.vector(5.0), r.within(0.0, 2.0));
            eight(r, |_| (center, radius))
        }),
        class("centers on a line", |r| {
            let (start, along) = (r.vector(5.0), r.vector(1.0));
            eight(r, |r| (plus(start, along, r.within(-5.0, 5.0)), r.within(0.0, 1.0)))
        }),
        class("tiny beside huge", |r| {
            eight(r, |r| {
                let scale = size(r.within(-12.0, 0.0));
                (r.vector(5.0), scale)
            })
        }),
        class("far from the origin", |r| {
            eight(r, |r| ([r.within(-1.0, 1.0), r.within(-1.0, 1.0), 1e8], r.within(0.1, 1.0)))
        }),
    ]
}

fn eight(r: &mut Random, mut ball: impl FnMut(&mut Random) -> ([f64; 3], f64)) -> [f64; 4 * COUNT] {
    let mut balls = [0.0; 4 * COUNT];
    for place in balls.chunks_exact_mut(4) {
        let (center, radius) = ball(r);
        place[..3].copy_from_slice(&center);
        place[3] = radius;
    }
    balls
}
