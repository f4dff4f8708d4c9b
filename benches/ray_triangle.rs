//! Ray and triangle: exact verdicts, correctly rounded `t` and weights, beside Möller-Trumbore and Woop's watertight
//! test.
//!
//! `any` is the verdict alone, by the same bounds of `t` that the tree works with; `closest` is the verdict and `t`.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec3;
use oracle::Random;
use rt_geom::{PointInTriangle, Ray, Triangle, inside_triangle};

/// Inputs of each bench: enough that branches are not learnt by heart.
const COUNT: usize = 4096;

/// T. Möller, B. Trumbore, "Fast, minimum storage ray/triangle intersection", 1997, without culling or epsilon.
fn moller_trumbore(ray: &Ray, triangle: &Triangle) -> Option<(f64, f64, f64)> {
    let [a, b, c] = triangle.vertices();
    let (e, f) = (b - a, c - a);
    let p = ray.direction().cross(f);
    let determinant = e.dot(p);
    if determinant == 0.0 {
        return None;
    }
    let inverse = 1.0 / determinant;
    let s = ray.origin() - a;
    let u = s.dot(p) * inverse;
    if !(0.0..=1.0).contains(&u) {
        return None;
    }
    let q = s.cross(e);
    let v = ray.direction().dot(q) * inverse;
    if v < 0.0 || u + v > 1.0 {
        return None;
    }
    let t = f.dot(q) * inverse;
    (t >= 0.0).then_some((t, u, v))
}

/// The ray as Woop's test wants it: axes permuted so that z is the longest, and the shear that makes it the z axis.
struct Sheared {
    origin: [f64; 3],
    axes: [usize; 3],
    shear: [f64; 3],
}

impl Sheared {
    fn new(ray: &Ray) -> Self {
        let d = ray.direction().to_array();
        let z = (0..3).max_by(|&i, &j| d[i].abs().total_cmp(&d[j].abs())).expect("three axes");
        let (mut x, mut y) = ((z + 1) % 3, (z + 2) % 3);
        if d[z] < 0.0 {
            (x, y) = (y, x);
        }
        let shear = [d[x] / d[z], d[y] / d[z], 1.0 / d[z]];
        Self { origin: ray.origin().to_array(), axes: [x, y, z], shear }
    }
}

/// S. Woop, C. Benthin, I. Wald, "Watertight ray/triangle intersection", 2013, in double precision throughout.
fn woop(ray: &Sheared, triangle: &Triangle) -> Option<(f64, f64, f64)> {
    let [x, y, z] = ray.axes;
    let [sx, sy, sz] = ray.shear;
    let [a, b, c] = triangle.vertices().map(|v| {
        let v = v.to_array();
        let (px, py, pz) = (v[x] - ray.origin[x], v[y] - ray.origin[y], v[z] - ray.origin[z]);
        (px - sx * pz, py - sy * pz, sz * pz)
    });
    let u = c.0 * b.1 - c.1 * b.0;
    let v = a.0 * c.1 - a.1 * c.0;
    let w = b.0 * a.1 - b.1 * a.0;
    if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
        return None;
    }
    let determinant = u + v + w;
    if determinant == 0.0 {
        return None;
    }
    let inverse = 1.0 / determinant;
    let t = (u * a.2 + v * b.2 + w * c.2) * inverse;
    (t >= 0.0).then_some((t, u * inverse, v * inverse))
}

fn cases(hits: bool, misses: bool) -> Vec<(Ray, Triangle)> {
    let mut random = Random::new(1);
    let make = move || {
        let place = 5.0 * random.point();
        let [a, b, c] = [random.point(), random.point(), random.point()].map(|v| place + v);
        let origin = 10.0 * random.point();
        let target = a + (0.7 * random.uniform() + 0.4) * (b - a) + (0.7 * random.uniform() + 0.4) * (c - a);
        let ray = Ray::new(origin, (target - origin) * (1.5 + random.uniform())).ok()?;
        Some((ray, Triangle::new(a, b, c).ok()?))
    };
    std::iter::repeat_with(make)
        .flatten()
        .filter(|(ray, triangle)| if triangle.any(ray, 0.0..f64::INFINITY) { hits } else { misses })
        .take(COUNT)
        .collect()
}

fn ray_triangle(criterion: &mut Criterion) {
    for (name, hits, misses) in [("mixed", true, true), ("hits", true, false), ("misses", false, true)] {
        let cases = cases(hits, misses);
        let sheared: Vec<_> = cases.iter().map(|(ray, triangle)| (Sheared::new(ray), *triangle)).collect();
        let mut group = criterion.benchmark_group(format!("ray_triangle/{name}"));
        group.throughput(Throughput::Elements(COUNT as u64));
        let all = 0.0..f64::INFINITY;
        macro_rules! bench {
            ($name:literal, $cases:ident, $test:expr) => {
                group.bench_function($name, |b| {
                    b.iter(|| {
                        for (ray, triangle) in &$cases {
                            black_box($test(black_box(ray), triangle));
                        }
                    });
                });
            };
        }
        bench!("moller_trumbore", cases, moller_trumbore);
        bench!("woop", sheared, woop);
        bench!("any", cases, |ray: &Ray, triangle: &Triangle| triangle.any(ray, all.clone()));
        bench!("closest", cases, |ray: &Ray, triangle: &Triangle| triangle.closest(ray, all.clone()));
        bench!("closest_and_weights", cases, |ray: &Ray, triangle: &Triangle| {
            triangle.closest_with_barycentric(ray, all.clone())
        });
        bench!("verdict", cases, |ray: &Ray, triangle: &Triangle| triangle.verdict(ray));
        bench!("crosses", cases, |ray: &Ray, triangle: &Triangle| triangle.crosses(ray));
        group.finish();
    }
}

/// The report's inside test in plain doubles.
fn plain_inside(point: DVec3, triangle: &Triangle) -> bool {
    let [a, b, c] = triangle.vertices();
    let n = (b - a).cross(c - a);
    [(a, b), (b, c), (c, a)].iter().all(|&(from, to)| n.dot((to - from).cross(point - from)) >= 0.0)
}

fn inside(criterion: &mut Criterion) {
    let points: Vec<_> = cases(true, true)
        .into_iter()
        .map(|(ray, triangle)| {
            let [a, b, c] = triangle.vertices();
            let n = (b - a).cross(c - a);
            (ray.at(n.dot(a - ray.origin()) / n.dot(ray.direction())), triangle)
        })
        .collect();
    let mut group = criterion.benchmark_group("inside_triangle");
    group.throughput(Throughput::Elements(COUNT as u64));
    group.bench_function("plain", |b| {
        b.iter(|| {
            for (point, triangle) in &points {
                black_box(plain_inside(black_box(*point), triangle));
            }
        });
    });
    group.bench_function("exact", |b| {
        b.iter(|| {
            for (point, triangle) in &points {
                black_box(inside_triangle(black_box(*point), triangle) != PointInTriangle::Outside);
            }
        });
    });
    group.bench_function("barycentric", |b| {
        b.iter(|| {
            for (point, triangle) in &points {
                black_box(triangle.barycentric(black_box(*point)));
            }
        });
    });
    group.finish();
}

criterion_group!(benches, ray_triangle, inside);
criterion_main!(benches);
