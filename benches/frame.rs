//! Whole pictures: each of the six figures at 320 x 240, from the built tree to the samples; and reading their scenes.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use figures::camera::Size;
use figures::figure::FIGURES;
use figures::render::Renderer;

const SIZE: Size = Size { width: 320, height: 240, samples: 1 };

fn frames(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("frame");
    group.throughput(Throughput::Elements(u64::from(SIZE.width * SIZE.height))); // rays
    for figure in FIGURES {
        let scene = figure.scene().unwrap();
        let view = scene.view(SIZE).unwrap();
        let renderer = Renderer::new(scene);
        group.bench_function(format!("figure_{}", figure.number), |bencher| {
            bencher.iter(|| renderer.rows(black_box(&view), 0..SIZE.height, 255, &|_rows| ()));
        });
    }
    group.finish();
}

fn load(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("load");
    for figure in FIGURES {
        group.bench_function(format!("figure_{}", figure.number), |bencher| {
            bencher.iter(|| black_box(&figure).scene().unwrap());
        });
    }
    group.finish();
}

criterion_group!(benches, frames, load);
criterion_main!(benches);
