//! The minimal sphere of spheres beside the usual approximations: Ritter's sphere and merging in sequence.
//!
//! Ritter's is a few percent too large, merging in sequence some twenty. `benches/peers/enclosing` has CGAL beside it.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec3;
use oracle::Random;
use rt_geom::{Sphere, enclosing_sphere};

fn spheres(count: usize, random: &mut Random) -> Vec<Sphere> {
    let largest = 0.5 / (count as f64).cbrt();
    (0..count)
        .map(|_| {
            let center = 0.5 * random.point();
            Sphere::new(center, largest * random.share()).expect("finite")
        })
        .collect()
}

/// The smallest sphere around two.
fn merge(a: (DVec3, f64), b: (DVec3, f64)) -> (DVec3, f64) {
    let way = b.0 - a.0;
    let length = way.length();
    if length + b.1 <= a.1 {
        return a;
    }
    if length + a.1 <= b.1 {
        return b;
    }
    let radius = 0.5 * (length + a.1 + b.1);
    (a.0 + way * ((radius - a.1) / length), radius)
}

fn sphere(s: &Sphere) -> (DVec3, f64) {
    (s.center(), s.radius())
}

fn merge_in_sequence(spheres: &[Sphere]) -> (DVec3, f64) {
    spheres[1..].iter().fold(sphere(&spheres[0]), |merged, next| merge(merged, sphere(next)))
}

/// J. Ritter, "An efficient bounding sphere", Graphics Gems, 1990, for spheres: two far ones, then whatever sticks out.
fn ritter(spheres: &[Sphere]) -> (DVec3, f64) {
    let farthest = |from: DVec3| {
        let reach = |s: &Sphere| (s.center() - from).length() + s.radius();
        spheres.iter().max_by(|a, b| reach(a).total_cmp(&reach(b))).expect("not empty")
    };
    let one = farthest(spheres[0].center());
    let other = farthest(one.center());
    spheres.iter().fold(merge(sphere(one), sphere(other)), |merged, next| merge(merged, sphere(next)))
}

/// Runs a method on every set.
fn each<T>(sets: &[Vec<Sphere>], method: impl Fn(&[Sphere]) -> T) {
    for set in sets {
        black_box(method(black_box(set)));
    }
}

fn enclosing(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("enclosing_sphere");
    for count in [2, 8, 64, 1000, 100_000, 1_000_000] {
        let mut random = Random::new(count as u64);
        let sets: Vec<Vec<Sphere>> =
            (0..(100_000 / count).clamp(1, 1000)).map(|_| spheres(count, &mut random)).collect();
        group.throughput(Throughput::Elements((sets.len() * count) as u64));
        group.sample_size(10);
        group.bench_function(BenchmarkId::new("minimal", count), |bencher| {
            bencher.iter(|| each(&sets, enclosing_sphere));
        });
        group.bench_function(BenchmarkId::new("ritter", count), |bencher| {
            bencher.iter(|| each(&sets, ritter));
        });
        group.bench_function(BenchmarkId::new("merge_in_sequence", count), |bencher| {
            bencher.iter(|| each(&sets, merge_in_sequence));
        });
    }
    group.finish();
}

criterion_group!(benches, enclosing);
criterion_main!(benches);
