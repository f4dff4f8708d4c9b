//! `reflect` beside the plain formula and glam, which takes unit normals only.
//!
//! `benign`: vectors of like size. `diagonal`: a component of the image is exactly zero, which only integers can tell.
//! `RUSTFLAGS="--cfg rt_math_without_fma" cargo bench --bench reflect` measures without hardware FMA.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec3;
use rt_math::reflect;

const COUNT: usize = 4096;

/// Returns pseudo-random vectors in the cube `-1..1` from a fixed seed (xorshift64).
fn random() -> impl FnMut() -> DVec3 {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut number = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    move || DVec3::new(number(), number(), number())
}

fn plain(v: DVec3, n: DVec3) -> DVec3 {
    v - 2.0 * v.dot(n) / n.dot(n) * n
}

fn reflections(criterion: &mut Criterion) {
    let mut random = random();
    let benign: Vec<_> = (0..COUNT).map(|_| (random(), random().normalize())).collect();
    let diagonal = (0..COUNT).map(|_| (random() * DVec3::X, DVec3::new(0.6, 0.6, 0.0))).collect();
    for (case, pairs) in [("benign", benign), ("diagonal", diagonal)] {
        let mut group = criterion.benchmark_group("reflect");
        group.throughput(Throughput::Elements(COUNT as u64));
        let mut run = |name: &str, all: &dyn Fn(&[(DVec3, DVec3)])| {
            group.bench_function(BenchmarkId::new(name, case), |bencher| {
                bencher.iter(|| all(black_box(&pairs)))
            });
        };
        run("plain", &|all| all.iter().for_each(|&(v, n)| drop(black_box(plain(v, n)))));
        run("glam", &|all| all.iter().for_each(|&(v, n)| drop(black_box(v.reflect(n)))));
        run("rt_math", &|all| all.iter().for_each(|&(v, n)| drop(black_box(reflect(v, n)))));
    }
}

criterion_group!(benches, reflections);
criterion_main!(benches);
