//! Ray and sphere: exact verdicts and correctly rounded `t`, beside the textbook's test and that of Ray Tracing Gems.
//!
//! `any` is the verdict alone, by the same bounds that the tree works with; `closest` is the verdict and `t`.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use oracle::Random;
use rt_geom::{Ray, Sphere};

/// Inputs of each bench: enough that branches are not learnt by heart.
const COUNT: usize = 4096;

/// `c`, `b² - a c` and the smaller of the roots that are not negative, as every textbook has it.
fn textbook(ray: &Ray, sphere: &Sphere) -> Option<f64> {
    let (d, w) = (ray.direction(), ray.origin() - sphere.center());
    let (a, b) = (d.dot(d), w.dot(d));
    let c = w.dot(w) - sphere.radius() * sphere.radius();
    let discriminant = b * b - a * c;
    if discriminant < 0.0 {
        return None;
    }
    let root = discriminant.sqrt();
    let near = (-b - root) / a;
    if near >= 0.0 {
        return Some(near);
    }
    let far = (-b + root) / a;
    (far >= 0.0).then_some(far)
}

/// The textbook's verdict alone: the discriminant, and the signs that tell whether a root lies ahead.
fn textbook_verdict(ray: &Ray, sphere: &Sphere) -> bool {
    let (d, w) = (ray.direction(), ray.origin() - sphere.center());
    let (a, b) = (d.dot(d), w.dot(d));
    let c = w.dot(w) - sphere.radius() * sphere.radius();
    b * b - a * c >= 0.0 && (b <= 0.0 || c <= 0.0)
}

/// Haines, Günther, Akenine-Möller, "Precision improvements for ray/sphere intersection", Ray Tracing Gems, 2019.
fn gems(ray: &Ray, sphere: &Sphere) -> Option<f64> {
    let (d, f) = (ray.direction(), ray.origin() - sphere.center());
    let (a, b) = (d.dot(d), -f.dot(d));
    let radius_square = sphere.radius() * sphere.radius();
    let discriminant = radius_square - (f + (b / a) * d).length_squared();
    if discriminant < 0.0 {
        return None;
    }
    let q = b + (a * discriminant).sqrt().copysign(b);
    let c = f.dot(f) - radius_square;
    let (x, y) = (c / q, q / a);
    let (near, far) = if x < y { (x, y) } else { (y, x) };
    if near >= 0.0 { Some(near) } else { (far >= 0.0).then_some(far) }
}

fn cases(hits: bool, misses: bool) -> Vec<(Ray, Sphere)> {
    let mut random = Random::new(1);
    let make = move || {
        let (origin, center, radius) = (10.0 * random.point(), 10.0 * random.point(), 3.0 * random.uniform().abs());
        let ray = Ray::new(origin, center + 1.4 * radius * random.point() - origin).ok()?;
        Some((ray, Sphere::new(center, radius).ok()?))
    };
    std::iter::repeat_with(make)
        .flatten()
        .filter(|(ray, sphere)| if sphere.any(ray, 0.0..f64::INFINITY) { hits } else { misses })
        .take(COUNT)
        .collect()
}

fn ray_sphere(criterion: &mut Criterion) {
    for (name, hits, misses) in [("mixed", true, true), ("hits", true, false), ("misses", false, true)] {
        let cases = cases(hits, misses);
        let mut group = criterion.benchmark_group(format!("ray_sphere/{name}"));
        group.throughput(Throughput::Elements(COUNT as u64));
        let all = 0.0..f64::INFINITY;
        macro_rules! bench {
            ($name:literal, $test:expr) => {
                group.bench_function($name, |b| {
                    b.iter(|| {
                        for (ray, sphere) in &cases {
                            black_box($test(black_box(ray), sphere));
                        }
                    });
                });
            };
        }
        bench!("textbook_verdict", textbook_verdict);
        bench!("textbook", textbook);
        bench!("gems", gems);
        bench!("any", |ray: &Ray, sphere: &Sphere| sphere.any(ray, all.clone()));
        bench!("closest", |ray: &Ray, sphere: &Sphere| sphere.closest(ray, all.clone()));
        group.finish();
    }
}

criterion_group!(benches, ray_sphere);
criterion_main!(benches);
