//! Triangle meshes: ours beside Embree's `rtcIntersect1`, one thread, in turn, in one process on the same rays.
//!
//! meshes [sizes...], by default 1e5 1e6. Best of five; the ratio is to Embree without its robust flag.

use std::time::Instant;

use trees::contestants::{describe_embree, embree, ours};
use trees::{Hit, Tracer, workload};

fn main() {
    println!("# {}", describe_embree());
    let mut sizes: Vec<usize> = std::env::args().skip(1).map(|n| n.parse::<f64>().expect("a number") as usize).collect();
    if sizes.is_empty() {
        sizes = vec![100_000, 1_000_000];
    }
    let sets = [
        ("camera", workload::camera_rays(1024), false),
        ("random", workload::random_rays(500_000), false),
        ("occlusion", workload::random_rays(500_000), true),
    ];
    println!("mesh\ttriangles\trays\tcontestant\tMrays/s\tratio\thits\tbuild_s");
    for name in ["globe", "terrain"] {
        for &size in &sizes {
            let (corners, triangles) = workload::mesh(name, size);
            let build = |what: &dyn Fn() -> Box<dyn Tracer>| {
                let start = Instant::now();
                (what(), start.elapsed().as_secs_f64())
            };
            let field = [
                ("embree", build(&|| embree::mesh(&corners, &triangles, false))),
                ("embree robust", build(&|| embree::mesh(&corners, &triangles, true))),
                ("ours single", build(&|| ours::mesh(&corners, &triangles, false, None))),
                ("ours batch", build(&|| ours::mesh(&corners, &triangles, true, None))),
                ("ours single avx2", build(&|| ours::mesh(&corners, &triangles, false, Some("avx2")))),
                ("ours batch avx2", build(&|| ours::mesh(&corners, &triangles, true, Some("avx2")))),
            ];
            for (set, rays, any) in &sets {
                let mut hits = vec![Hit::MISS; rays.len()];
                let mut best = [f64::INFINITY; 6];
                let mut counts = [0; 6];
                for _ in 0..5 {
                    for (i, (_, (tracer, _))) in field.iter().enumerate() {
                        let start = Instant::now();
                        if *any {
                            counts[i] = tracer.occluded(rays).expect("all have the query");
                        } else {
                            tracer.closest(rays, &mut hits);
                        }
                        best[i] = best[i].min(start.elapsed().as_secs_f64());
                        if !any {
                            counts[i] = hits.iter().filter(|hit| hit.is_hit()).count();
                        }
                    }
                }
                for (i, (contestant, (_, built))) in field.iter().enumerate() {
                    println!(
                        "{name}\t{}\t{set}\t{contestant}\t{:.3}\t{:.2}\t{}\t{built:.3}",
                        triangles.len(),
                        rays.len() as f64 / best[i] / 1e6,
                        best[0] / best[i],
                        counts[i],
                    );
                }
            }
        }
    }
}
