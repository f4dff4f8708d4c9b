//! Triangle meshes: ours beside Embree 3 and 4, one thread, in turn, in one process on the same rays.
//!
//! meshes [sizes...], by default 1e5 1e6. Best of five. The ratio is to the best of Embree with its robust flag in the mode
//! that the rays allow: single rays for ours single, single rays and tiles of 4 x 4 for ours in batches.

use std::time::Instant;

use trees::contestants::{describe_embree, embree, ours};
use trees::{Hit, Tracer, workload};

fn main() {
    println!("# {}", describe_embree());
    let mut sizes: Vec<usize> =
        std::env::args().skip(1).map(|n| n.parse::<f64>().expect("a number") as usize).collect();
    if sizes.is_empty() {
        sizes = vec![100_000, 1_000_000];
    }
    println!("mesh\ttriangles\trays\tcontestant\tMrays/s\tours/best\thits\tbuild_s");
    for name in workload::MESHES {
        for &size in &sizes {
            let mesh = workload::mesh(name, size);
            let build = |what: &dyn Fn() -> Option<Box<dyn Tracer>>| {
                let start = Instant::now();
                what().map(|tracer| (tracer, start.elapsed().as_secs_f64()))
            };
            let field = [
                ("embree robust", build(&|| embree::mesh(3, &mesh, true, false))),
                ("embree4", build(&|| embree::mesh(4, &mesh, false, false))),
                ("embree4 robust", build(&|| embree::mesh(4, &mesh, true, false))),
                ("embree4 robust packet16 4x4", build(&|| embree::mesh(4, &mesh, true, true))),
                ("ours single", build(&|| Some(ours::mesh(&mesh, false, None)))),
                ("ours batch", build(&|| Some(ours::mesh(&mesh, true, None)))),
                ("ours single avx2", build(&|| Some(ours::mesh(&mesh, false, Some("avx2"))))),
                ("ours batch avx2", build(&|| Some(ours::mesh(&mesh, true, Some("avx2"))))),
            ];
            let field: Vec<_> =
                field.into_iter().filter_map(|(name, built)| built.map(|(t, s)| (name, t, s))).collect();
            let camera = workload::camera_rays(1024);
            let mut hits = vec![Hit::MISS; camera.len()];
            field.iter().find(|f| f.0 == "ours batch").expect("takes part").1.closest(&camera, &mut hits);
            let met: Vec<_> =
                camera.iter().zip(&hits).filter(|(_, h)| h.is_hit()).map(|(r, h)| (*r, f64::from(h.t))).collect();
            let sets = [
                ("camera", camera, false),
                ("random", workload::random_rays(500_000), false),
                ("bounce", workload::bounce_rays(&met), false),
                ("occlusion", workload::random_rays(500_000), true),
            ];
            for (set, rays, any) in &sets {
                let mut best = vec![f64::INFINITY; field.len()];
                let mut counts = vec![0; field.len()];
                for _ in 0..5 {
                    for (i, (name, tracer, _)) in field.iter().enumerate() {
                        if name.contains("packet") && *set != "camera" {
                            continue;
                        }
                        let hits = &mut hits[..rays.len()];
                        let start = trees::cpu_seconds();
                        if *any {
                            counts[i] = tracer.occluded(rays).expect("all have the query");
                        } else {
                            tracer.closest(rays, hits);
                        }
                        best[i] = best[i].min(trees::cpu_seconds() - start);
                        if !any {
                            counts[i] = hits.iter().filter(|hit| hit.is_hit()).count();
                        }
                    }
                }
                let peer = |tiles: bool| {
                    let takes_part = |name: &str| name.contains("robust") && (tiles || !name.contains("packet"));
                    field
                        .iter()
                        .zip(&best)
                        .filter(|(f, _)| takes_part(f.0))
                        .map(|(_, s)| *s)
                        .fold(f64::INFINITY, f64::min)
                };
                for (i, (contestant, _, built)) in field.iter().enumerate().filter(|(i, _)| best[*i].is_finite()) {
                    println!(
                        "{name}\t{}\t{set}\t{contestant}\t{:.3}\t{:.2}\t{}\t{built:.3}",
                        mesh.1.len(),
                        rays.len() as f64 / best[i] / 1e6,
                        peer(contestant.contains("batch")) / best[i],
                        counts[i],
                    );
                }
            }
        }
    }
}
