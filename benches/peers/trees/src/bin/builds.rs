//! Builds of the tree by wall time: ours with one thread and with two, Embree with one; and bytes a sphere.
//!
//! builds [sizes...], by default 1e5 1e6 1e7. Best of nine (once beyond 1e6), in turn.

use std::any::Any;
use std::time::Instant;

use glam::DVec3;
use rt_geom::{Bvh, Sphere};
use trees::contestants::embree;
use trees::{memory, workload};

#[global_allocator]
static ALLOCATOR: memory::Counting = memory::Counting;

fn main() {
    let mut sizes: Vec<usize> =
        std::env::args().skip(1).map(|n| n.parse::<f64>().expect("a number") as usize).collect();
    if sizes.is_empty() {
        sizes = vec![100_000, 1_000_000, 10_000_000];
    }
    let embree = embree::contestants().into_iter().find(|c| c.name == "embree high").expect("is listed");
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let (one, two) = (pool(1), pool(2));
    println!(
        "| scene | spheres | Embree, 1 thread, s | ours, 1 thread, s | ours, 2 threads, s | times faster, 1 and 2 | bytes a sphere, ours (peak) | Embree (peak) |"
    );
    println!("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    for scene in workload::SCENES {
        for &n in &sizes {
            let spheres = workload::spheres(scene, n);
            let ours = || {
                let sphere = |s: &[f32; 4]| {
                    let [x, y, z, radius] = s.map(f64::from);
                    Sphere::new(DVec3::new(x, y, z), radius).expect("valid")
                };
                Bvh::new(spheres.iter().map(sphere).collect(), Vec::new())
            };
            let per = |bytes: usize| bytes as f64 / spheres.len() as f64;
            let timed = |build: &dyn Fn() -> Box<dyn Any>| {
                let before = memory::live();
                memory::reset_peak();
                let start = Instant::now();
                let built = build();
                let seconds = start.elapsed().as_secs_f64();
                let bytes = (per(memory::live() - before), per(memory::peak() - before));
                drop(built);
                (seconds, bytes)
            };
            let mut best = [f64::INFINITY; 3];
            let (mut mine, mut theirs) = ((0.0, 0.0), (0.0, 0.0));
            for _ in 0..if n > 1_000_000 { 1 } else { 9 } {
                let (seconds, bytes) = timed(&|| Box::new((embree.build)(&spheres)));
                best[0] = best[0].min(seconds);
                theirs = bytes;
                let (seconds, bytes) = timed(&|| Box::new(one.install(ours)));
                best[1] = best[1].min(seconds);
                mine = bytes;
                let (seconds, _) = timed(&|| Box::new(two.install(ours)));
                best[2] = best[2].min(seconds);
            }
            let [e, o1, o2] = best;
            println!(
                "| {scene} | {} | {e:.3} | {o1:.3} | {o2:.3} | {:.2}, {:.2} | {:.1} ({:.1}) | {:.1} ({:.1}) |",
                spheres.len(),
                e / o1,
                e / o2,
                mine.0,
                mine.1,
                theirs.0,
                theirs.1
            );
        }
    }
}
