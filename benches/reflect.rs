//! `reflect` beside the plain formula and glam, which takes unit normals only.
//!
//! `benign`: vectors of like size. `diagonal`: a component of the image is exactly zero, which only integers can tell.
//! `RUSTFLAGS="--cfg rt_math_without_fma" cargo bench --bench reflect` measures without hardware FMA.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec3;
use rt_math::reflect;

const COUNT: usize = 4096;

/// A vector and a normal.
type Pair = (DVec3, DVec3);

fn plain(v: DVec3, n: DVec3) -> DVec3 {
    v - 2.0 * v.dot(n) / n.dot(n) * n
}

fn reflections(criterion: &mut Criterion) {
    let mut random = oracle::Random::new(1);
    let benign: Vec<Pair> = (0..COUNT).map(|_| (random.point(), random.direction())).collect();
    let diagonal: Vec<Pair> = (0..COUNT).map(|_| (random.point() * DVec3::X, DVec3::new(0.6, 0.6, 0.0))).collect();
    for (case, pairs) in [("benign", benign), ("diagonal", diagonal)] {
        measure(criterion, "plain", case, &pairs, plain);
        measure(criterion, "glam", case, &pairs, DVec3::reflect);
        measure(criterion, "rt_math", case, &pairs, reflect);
    }
}

fn measure(criterion: &mut Criterion, name: &str, case: &str, pairs: &[Pair], mirror: impl Fn(DVec3, DVec3) -> DVec3) {
    let mut group = criterion.benchmark_group("reflect");
    group.throughput(Throughput::Elements(pairs.len() as u64));
    group.bench_function(BenchmarkId::new(name, case), |bencher| {
        bencher.iter(|| {
            for &(v, n) in black_box(pairs) {
                black_box(mirror(v, n));
            }
        });
    });
}

criterion_group!(benches, reflections);
criterion_main!(benches);
