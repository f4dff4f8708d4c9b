//! Reading spheres and meshes from text that is in memory, on one thread and on two, beside the copy of as many bytes.

use std::fmt::Write;
use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use figures::generate::{self, Rule};
use figures::import::spheres::Options;
use figures::import::{obj, xyz};
use oracle::Random;

const SPHERES: u32 = 1_000_000;
/// A grid of so many squares a side: a million triangles.
const SIDE: usize = 707;

/// Spheres with radii and colours, as `figures gen spheres` writes them.
fn generated() -> String {
    let mut bytes = Vec::new();
    generate::write_xyz(&generate::random(Rule::Uniform, SPHERES), "spheres", &mut bytes).expect("memory takes all");
    String::from_utf8(bytes).expect("text")
}

/// Atoms of four elements, with so many decimals.
fn atoms(decimals: usize) -> String {
    let mut random = Random::new(2);
    let mut text = format!("{SPHERES}\n\n");
    for _ in 0..SPHERES {
        let element = ["H", "C", "N", "O"][random.below(4)];
        let [x, y, z] = [(); 3].map(|()| random.within(-100.0, 100.0));
        writeln!(text, "{element} {x:.decimals$} {y:.decimals$} {z:.decimals$}").expect("memory takes all");
    }
    text
}

/// A height field of triangles; `normals` gives every corner a normal too.
fn terrain(normals: bool) -> String {
    let mut random = Random::new(3);
    let mut text = String::new();
    for at in 0..(SIDE + 1) * (SIDE + 1) {
        let (x, y, z) = (at % (SIDE + 1), random.within(0.0, 0.1), at / (SIDE + 1));
        let scale = 1.0 / SIDE as f64;
        writeln!(text, "v {:.6} {y:.6} {:.6}", x as f64 * scale, z as f64 * scale).expect("memory takes all");
        if normals {
            writeln!(text, "vn {:.4} {:.4} {:.4}", y, 1.0 - y, -y).expect("memory takes all");
        }
    }
    for at in (0..SIDE * SIDE).map(|at| at / SIDE * (SIDE + 1) + at % SIDE + 1) {
        let [a, b, c, d] = [at, at + 1, at + SIDE + 2, at + SIDE + 1];
        for [a, b, c] in [[a, b, c], [a, c, d]] {
            if normals {
                writeln!(text, "f {a}//{a} {b}//{b} {c}//{c}").expect("memory takes all");
            } else {
                writeln!(text, "f {a} {b} {c}").expect("memory takes all");
            }
        }
    }
    text
}

fn read(criterion: &mut Criterion, name: &str, text: &str, read: &(dyn Fn(&[u8]) + Sync)) {
    let mut group = criterion.benchmark_group(name);
    group.throughput(Throughput::Bytes(text.len() as u64)).sample_size(10);
    group.warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(3));
    for (threads, name) in [(1, "one_thread"), (2, "two_threads")] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        group.bench_function(name, |bencher| bencher.iter(|| pool.install(|| read(black_box(text.as_bytes())))));
    }
    group.bench_function("copy", |bencher| bencher.iter(|| black_box(text.as_bytes()).to_vec()));
}

fn all(criterion: &mut Criterion) {
    let spheres = |bytes: &[u8]| {
        black_box(xyz::read(bytes, bytes.len() as u64, "a.xyz", Options::default()).expect("a valid file"));
    };
    read(criterion, "read_xyz/1m_with_radius_and_color", &generated(), &spheres);
    read(criterion, "read_xyz/1m_atoms", &atoms(6), &spheres);
    read(criterion, "read_xyz/1m_atoms_of_17_digits", &atoms(15), &spheres);
    let mesh = |bytes: &[u8]| {
        black_box(obj::read(bytes, "a.obj", None).expect("a valid file"));
    };
    read(criterion, "read_obj/1m_triangles", &terrain(false), &mesh);
    read(criterion, "read_obj/1m_triangles_with_normals", &terrain(true), &mesh);
}

criterion_group!(benches, all);
criterion_main!(benches);
