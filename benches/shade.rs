//! Texture coordinates, powers, Phong shading and texture lookup, beside the plain formulas.

use std::f64::consts::{PI, TAU};
use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec3;
use oracle::Random;
use rt_shade::{Material, PointLight, Shaded, SurfacePoint, Texture, phong, phong_batch, sphere_uv};

/// Inputs of each bench: enough that branches are not learnt by heart.
const COUNT: usize = 4096;

/// Returns unit vectors, uniform over the sphere.
fn unit_vectors() -> Vec<DVec3> {
    let mut random = Random::new(1);
    (0..COUNT).map(|_| random.direction()).collect()
}

/// The textbook's formula: wrong for other lengths than 1, NaN for a length a rounding error above it.
fn textbook_uv(normal: DVec3) -> (f64, f64) {
    (0.5 + normal.z.atan2(normal.x) / TAU, 0.5 - normal.y.asin() / PI)
}

/// The textbook's formula with the normal made a unit vector, as a caller has to do who is not sure of it.
fn normalized_uv(normal: DVec3) -> (f64, f64) {
    let normal = normal.normalize();
    (0.5 + normal.z.atan2(normal.x) / TAU, 0.5 - normal.y.clamp(-1.0, 1.0).asin() / PI)
}

/// Two arc tangents of a library whose angles are correctly rounded in practice.
fn pxfm_uv(normal: DVec3) -> (f64, f64) {
    let DVec3 { x, y, z } = normal;
    let u = if x < 0.0 && z < 0.0 { pxfm::f_atan2pi(-z, -x) / 2.0 } else { 0.5 + pxfm::f_atan2pi(z, x) / 2.0 };
    (u, pxfm::f_atan2pi(x.hypot(z), y))
}

fn texture_coordinates(criterion: &mut Criterion) {
    let normals = unit_vectors();
    let mut group = criterion.benchmark_group("sphere_uv");
    group.throughput(Throughput::Elements(COUNT as u64));
    let mut bench = |name: &str, uv: fn(DVec3) -> (f64, f64)| {
        group.bench_function(name, |b| {
            b.iter(|| {
                for &normal in &normals {
                    black_box(uv(black_box(normal)));
                }
            });
        });
    };
    bench("textbook", textbook_uv);
    bench("ours", sphere_uv);
    bench("textbook_normalized", normalized_uv);
    bench("pxfm_atan2pi", pxfm_uv);
    bench("ours_out_of_range", |normal| sphere_uv(normal * 1e-300));
}

fn shading(criterion: &mut Criterion) {
    let vectors = unit_vectors();
    let mut group = criterion.benchmark_group("phong");
    group.throughput(Throughput::Elements(COUNT as u64));
    let light = |x: f64| PointLight { position: DVec3::new(x, 3.0, 4.0), color: DVec3::ONE };
    let lights = [light(-5.0), light(5.0)];
    for shininess in [32.0, 51.3] {
        let material = Material { ambient: 0.1, diffuse: 0.7, specular: 0.5, shininess };
        for count in [1, 2] {
            let seen = |&v: &DVec3| SurfacePoint::new(v, v - 5.0 * DVec3::Z, v, DVec3::ONE, &material);
            let id = BenchmarkId::new(format!("ours_shininess_{shininess}"), format!("{count}_lights"));
            group.bench_function(id, |b| {
                b.iter(|| {
                    for &v in &vectors {
                        let lights = &lights[..count];
                        black_box(phong(black_box(&seen(&v)), lights));
                    }
                });
            });
            let points: Vec<_> = vectors.iter().map(seen).collect();
            let mut colors = vec![Shaded { color: DVec3::ZERO, error: 0.0 }; COUNT];
            let id = BenchmarkId::new(format!("ours_batch_shininess_{shininess}"), format!("{count}_lights"));
            group.bench_function(id, |b| {
                b.iter(|| phong_batch(black_box(&points), &lights[..count], black_box(&mut colors)));
            });
            let id = BenchmarkId::new(format!("textbook_shininess_{shininess}"), format!("{count}_lights"));
            group.bench_function(id, |b| {
                b.iter(|| {
                    for &v in &vectors {
                        let lights = &lights[..count];
                        black_box(textbook_phong(black_box(v), v - 5.0 * DVec3::Z, v, &material, lights));
                    }
                });
            });
        }
    }
}

/// Phong's model as it is usually written, with the system's power.
fn textbook_phong(point: DVec3, direction: DVec3, normal: DVec3, material: &Material, lights: &[PointLight]) -> DVec3 {
    let direction = direction.normalize();
    let normal = if direction.dot(normal) > 0.0 { -normal } else { normal };
    let mut color = DVec3::splat(material.ambient);
    for light in lights {
        let incident = (point - light.position).normalize();
        let cosine = -incident.dot(normal);
        if cosine > 0.0 {
            let reflected = incident - 2.0 * incident.dot(normal) * normal;
            let alignment = (-direction.dot(reflected)).max(0.0);
            color += (material.diffuse * cosine + material.specular * alignment.powf(material.shininess)) * light.color;
        }
    }
    color
}

fn lookup(criterion: &mut Criterion) {
    let (width, height) = (720, 360);
    let samples = (0..3 * width * height).map(|i| u16::try_from(i % 251).expect("below 251")).collect();
    let texture = Texture::new(width, height, samples, 255).expect("the samples fit");
    let mut random = Random::new(2);
    let uv: Vec<(f64, f64)> = (0..COUNT).map(|_| (random.share(), random.share())).collect();
    let mut group = criterion.benchmark_group("texture");
    group.throughput(Throughput::Elements(COUNT as u64));
    for (name, read) in
        [("nearest", Texture::nearest as fn(&Texture, f64, f64) -> DVec3), ("bilinear", Texture::bilinear)]
    {
        group.bench_function(name, |b| {
            b.iter(|| {
                for &(u, v) in &uv {
                    black_box(read(&texture, black_box(u), black_box(v)));
                }
            });
        });
    }
}

criterion_group!(benches, texture_coordinates, shading, lookup);
criterion_main!(benches);
