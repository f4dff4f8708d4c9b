//! `solve_quadratic` beside the textbook formula, the usual repair of it, and kurbo.
//!
//! `predictable`: two roots always. `random`: half the equations have none, and there are too many to be learnt by
//! heart, so that branch misses count. `double_roots`: the discriminant is exactly zero, `grazing`: it nearly is; no
//! filter helps. `RUSTFLAGS="--cfg rt_math_without_fma" cargo bench --bench quadratic` measures without hardware FMA.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use rt_math::{Roots, solve_quadratic};

type Equation = [f64; 3];

fn cases() -> [(&'static str, Vec<Equation>); 4] {
    let mut random = oracle::Random::new(1);
    let mut random = || random.uniform();
    let from_roots = |a: f64, x: f64, y: f64| [a, -a * (x + y), a * x * y];
    let predictable = (0..4096).map(|_| from_roots(1.5 + random(), 10.0 * random(), 10.0 * random())).collect();
    let any = (0..1 << 17).map(|_| [random(), random(), random()]).collect();
    let mut small = || (1e6 * random()).round();
    let double = (0..4096).map(|_| (small(), small())).map(|(p, q)| [p * p, 2.0 * p * q, q * q]).collect();
    let grazing = (0..4096).map(|_| [random(), random()]).map(|[a, b]| [a, b, b / a * b / 4.0]).collect();
    [("predictable", predictable), ("random", any), ("double_roots", double), ("grazing", grazing)]
}

fn textbook([a, b, c]: Equation) -> Roots {
    if a == 0.0 {
        return if b == 0.0 { Roots::None } else { Roots::One(-c / b) };
    }
    let d = b * b - 4.0 * a * c;
    if d < 0.0 {
        return Roots::None;
    }
    let root = d.sqrt();
    Roots::Two((-b - root) / (2.0 * a), (-b + root) / (2.0 * a))
}

/// Without the cancellation between `b` and the root; that in the discriminant stays.
fn stable([a, b, c]: Equation) -> Roots {
    if a == 0.0 {
        return if b == 0.0 { Roots::None } else { Roots::One(-c / b) };
    }
    let d = b * b - 4.0 * a * c;
    if d < 0.0 {
        return Roots::None;
    }
    let q = -0.5 * (b + d.sqrt().copysign(b));
    let (x, y) = (q / a, c / q);
    if x < y { Roots::Two(x, y) } else { Roots::Two(y, x) }
}

fn solvers(criterion: &mut Criterion) {
    for (case, equations) in cases() {
        measure(criterion, "textbook", case, &equations, textbook);
        measure(criterion, "stable", case, &equations, stable);
        measure(criterion, "rt_math", case, &equations, |[a, b, c]| solve_quadratic(a, b, c));
        measure(criterion, "kurbo", case, &equations, |[a, b, c]| kurbo::common::solve_quadratic(c, b, a));
    }
}

fn measure<R>(
    criterion: &mut Criterion,
    name: &str,
    case: &str,
    equations: &[Equation],
    solve: impl Fn(Equation) -> R,
) {
    let mut group = criterion.benchmark_group("quadratic");
    group.throughput(Throughput::Elements(equations.len() as u64));
    group.bench_function(BenchmarkId::new(name, case), |bencher| {
        bencher.iter(|| {
            for &equation in black_box(equations) {
                black_box(solve(equation));
            }
        });
    });
}

criterion_group!(benches, solvers);
criterion_main!(benches);
