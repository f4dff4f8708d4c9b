//! The fast tree beside the plain loop and the report's tree, as listed and sorted: one ray at a time, and batches.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use oracle::Random;
use rt_geom::{AHEAD, Bvh, Ray, Sphere, SphereTree};

const RAYS: usize = 1024;

/// Spheres that fill a tenth of a cube of side 2, and rays from within it.
fn scene(n: usize) -> (Vec<Sphere>, Vec<Ray>) {
    let random = &mut Random::new(0x5EED);
    let radius = (0.8 / (n as f64 * 4.188_790_204_786_391)).cbrt();
    let spheres = (0..n).map(|_| Sphere::new(random.point(), radius).unwrap()).collect();
    let rays = (0..RAYS).map(|_| Ray::new(random.point(), random.point()).unwrap()).collect();
    (spheres, rays)
}

fn closest(c: &mut Criterion) {
    for (n, name) in [(1_000, "1k_spheres"), (100_000, "100k_spheres")] {
        let (spheres, rays) = scene(n);
        let tree = Bvh::new(spheres.clone(), vec![]);
        let mut group = c.benchmark_group("tree_closest");
        group.throughput(Throughput::Elements(RAYS as u64)).sample_size(10);
        group.bench_function(format!("single/{name}"), |b| {
            b.iter(|| rays.iter().filter_map(|ray| tree.closest(black_box(ray), AHEAD)).count());
        });
        let mut hits = vec![None; RAYS];
        group.bench_function(format!("batch/{name}"), |b| {
            b.iter(|| tree.closest_batch(black_box(&rays), AHEAD, &mut hits));
        });
        let sorted = SphereTree::sorted(spheres.clone(), vec![]);
        group.bench_function(format!("sphere_tree_sorted/{name}"), |b| {
            b.iter(|| rays.iter().filter_map(|ray| sorted.closest(black_box(ray), AHEAD)).count());
        });
        if n <= 1_000 {
            let listed = SphereTree::new(spheres.clone(), vec![]);
            group.bench_function(format!("sphere_tree_listed/{name}"), |b| {
                b.iter(|| rays.iter().filter_map(|ray| listed.closest(black_box(ray), AHEAD)).count());
            });
            group.bench_function(format!("brute_force/{name}"), |b| {
                let closest =
                    |ray: &Ray| spheres.iter().filter_map(|sphere| sphere.closest(ray, AHEAD)).min_by(f64::total_cmp);
                b.iter(|| rays.iter().filter_map(|ray| closest(black_box(ray))).count());
            });
        }
        group.finish();
    }
}

fn any(c: &mut Criterion) {
    let (spheres, rays) = scene(100_000);
    let tree = Bvh::new(spheres, vec![]);
    let mut group = c.benchmark_group("tree_any");
    group.throughput(Throughput::Elements(RAYS as u64)).sample_size(10);
    group.bench_function("single/100k_spheres", |b| {
        b.iter(|| rays.iter().filter(|ray| tree.any(black_box(ray), AHEAD)).count());
    });
    let mut hits = vec![false; RAYS];
    group.bench_function("batch/100k_spheres", |b| {
        b.iter(|| tree.any_batch(black_box(&rays), AHEAD, &mut hits));
    });
    group.finish();
}

fn build(c: &mut Criterion) {
    let (spheres, _) = scene(100_000);
    let mut group = c.benchmark_group("tree_build");
    group.throughput(Throughput::Elements(100_000)).sample_size(10);
    group.bench_function("bvh/100k_spheres", |b| b.iter(|| Bvh::new(black_box(&spheres).clone(), vec![])));
    group.bench_function("sphere_tree_sorted/100k_spheres", |b| {
        b.iter(|| SphereTree::sorted(black_box(&spheres).clone(), vec![]));
    });
    group.finish();
}

criterion_group!(benches, closest, any, build);
criterion_main!(benches);
