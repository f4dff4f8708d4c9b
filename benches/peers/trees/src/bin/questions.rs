//! What a closed mesh is asked: all hits along a ray, and whether a point is inside; ours beside Embree 4, one thread.
//!
//! questions FOLDER [sizes...], by default 82e3 1e6. Best of five, in turn. Meshes, rays, points and our exact answers go
//! into the folder as arrays of f32 and u32 (little endian), for `questions.py`, which asks trimesh the same.
//! Embree gathers all hits by asking again from the float after each hit, as trimesh does in steps of its own.

use std::fs;
use std::path::Path;

use glam::DVec3;
use rt_geom::{AHEAD, Bvh, Side};
use trees::contestants::{describe_embree, embree, ours};
use trees::workload::{self, SplitMix};

fn bytes<const N: usize>(rows: impl IntoIterator<Item = [[u8; 4]; N]>) -> Vec<u8> {
    rows.into_iter().flatten().flatten().collect()
}

/// What is lost and wrong on a closed mesh of 81,920 triangles, from inside: rays to every vertex and to the middle of
/// every edge, and points 2^-24 in front of and behind every twentieth face.
fn errors(folder: &Path) -> std::io::Result<()> {
    let mesh = workload::icosphere(6);
    let triangles = ours::triangles(&mesh);
    let tree = Bvh::new(Vec::new(), triangles.clone());
    assert!(tree.open_edges().is_empty(), "an icosphere is closed");
    let embree = embree::every_hit(&mesh).expect("Embree 4: set EMBREE4 to its library");
    let mut rng = SplitMix(0x1C0);
    let (mut rays, mut lost, mut wrong) = (0, [0; 2], [0; 2]);
    let mut crossings = Vec::new();
    for triangle in &mesh.1 {
        let [a, b, _] = triangle.map(|i| mesh.0[i as usize]);
        for aim in [a, std::array::from_fn(|k| 0.5 * (a[k] + b[k]))] {
            let origin = [0.3 * rng.signed(), 0.3 * rng.signed(), 0.3 * rng.signed() - 3.0];
            let ray = workload::Ray { origin, direction: std::array::from_fn(|k| aim[k] - origin[k]) };
            tree.crossings(&ours::widen(&ray), &mut crossings);
            for (i, found) in [crossings.len() as u32, embree(&ray)].into_iter().enumerate() {
                lost[i] += u32::from(found == 0);
                wrong[i] += u32::from(found != 1);
            }
            rays += 1;
        }
    }
    println!(
        "from inside\t{rays} rays\tlost: ours {}, Embree 4 robust {}\tnot one crossing: ours {}, Embree 4 {}",
        lost[0], lost[1], wrong[0], wrong[1]
    );
    let points: Vec<DVec3> = (triangles.iter().step_by(20))
        .flat_map(|triangle| {
            let [a, b, c] = triangle.vertices();
            let normal = (b - a).cross(c - a).normalize();
            [-1.0, 1.0].map(|side| (a + b + c) / 3.0 + side * 2f64.powi(-24) * normal)
        })
        .collect();
    let row = |point: &DVec3| point.to_array().into_iter().flat_map(f64::to_le_bytes).collect::<Vec<u8>>();
    fs::write(folder.join("near.points"), points.iter().flat_map(row).collect::<Vec<u8>>())?;
    fs::write(
        folder.join("near.inside"),
        points.iter().map(|&p| u8::from(tree.contains(p) != Side::Outside)).collect::<Vec<u8>>(),
    )?;
    fs::write(folder.join("near.corners"), bytes(mesh.0.iter().map(|p| p.map(f32::to_le_bytes))))?;
    fs::write(folder.join("near.triangles"), bytes(mesh.1.iter().map(|t| t.map(u32::to_le_bytes))))
}

fn main() -> std::io::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().expect("a folder for the meshes, rays and points");
    let folder = Path::new(&folder);
    fs::create_dir_all(folder)?;
    let mut sizes: Vec<usize> = arguments.map(|n| n.parse::<f64>().expect("a number") as usize).collect();
    if sizes.is_empty() {
        sizes = vec![82_000, 1_000_000];
    }
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    println!("# {}", describe_embree());
    errors(folder)?;
    println!("mesh\ttriangles\tquestion\tcontestant\tM/s\tours/theirs\tbatch/theirs\tsum\tdiffering");
    for size in sizes {
        let mesh = workload::mesh("globe", size);
        let n = mesh.1.len();
        let rays = workload::random_rays(200_000);
        let mut rng = SplitMix(0x1A);
        let points: Vec<[f32; 3]> =
            (0..200_000).map(|_| [1.1 * rng.signed(), 1.1 * rng.signed(), 1.1 * rng.signed() - 3.0]).collect();
        let tree = Bvh::new(Vec::new(), ours::triangles(&mesh));
        assert!(tree.open_edges().is_empty(), "the globe is closed");
        let embree = embree::every_hit(&mesh).expect("Embree 4: set EMBREE4 to its library");

        let mut hits = Vec::new();
        let count = |ray: &trees::Ray, hits: &mut Vec<_>| {
            tree.hits(&ours::widen(ray), AHEAD, hits);
            hits.len() as u32
        };
        let inside = |point: &[f32; 3]| u32::from(tree.contains(point.map(f64::from)) != Side::Outside);
        let along = |&origin: &[f32; 3]| workload::Ray { origin, direction: [0.439_506_44, 0.617_598_6, 0.652_231_57] };
        let [mut a, mut b, mut c, mut d, mut e, mut f] = [(); 6].map(|()| (f64::INFINITY, Vec::new()));
        let mut lists = vec![Vec::new(); rays.len()];
        let mut sides = vec![Side::Outside; points.len()];
        for _ in 0..5 {
            time(&mut a, || rays.iter().map(|ray| count(ray, &mut hits)).collect());
            time(&mut b, || rays.iter().map(|ray| embree(ray)).collect());
            time(&mut c, || points.iter().map(inside).collect());
            time(&mut e, || {
                one.install(|| tree.hits_batch(&rays.iter().map(ours::widen).collect::<Vec<_>>(), AHEAD, &mut lists));
                lists.iter().map(|hits| hits.len() as u32).collect()
            });
            time(&mut f, || {
                let points: Vec<DVec3> = points.iter().map(|point| point.map(f64::from).into()).collect();
                one.install(|| tree.contains_batch(&points, &mut sides));
                sides.iter().map(|&side| u32::from(side != Side::Outside)).collect()
            });
            time(&mut d, || points.iter().map(|point| embree(&along(point)) % 2).collect());
        }
        for (question, [ours, batch, theirs]) in [("all hits", [&a, &e, &b]), ("contains", [&c, &f, &d])] {
            let differing = ours.1.iter().zip(&theirs.1).filter(|(a, b)| a != b).count();
            assert_eq!(ours.1, batch.1, "the same answers in batches");
            let rows =
                [("ours", ours, 0), ("ours, batch", batch, 0), ("Embree 4, repeated rtcIntersect1", theirs, differing)];
            for (name, answers, differing) in rows {
                println!(
                    "globe\t{n}\t{question}\t{name}\t{:.3}\t{:.2}\t{:.2}\t{}\t{differing}",
                    answers.1.len() as f64 / answers.0 / 1e6,
                    answers.0 / ours.0,
                    answers.0 / batch.0,
                    answers.1.iter().sum::<u32>(),
                );
            }
        }
        let file = |name: &str| folder.join(format!("{n}.{name}"));
        fs::write(file("corners"), bytes(mesh.0.iter().map(|p| p.map(f32::to_le_bytes))))?;
        fs::write(file("triangles"), bytes(mesh.1.iter().map(|t| t.map(u32::to_le_bytes))))?;
        let rows = rays.iter().map(|r| [r.origin, r.direction].as_flattened().try_into().expect("six numbers"));
        fs::write(file("rays"), bytes(rows.map(|row: [f32; 6]| row.map(f32::to_le_bytes))))?;
        fs::write(file("points"), bytes(points.iter().map(|p| p.map(f32::to_le_bytes))))?;
        fs::write(file("hits"), bytes(a.1.iter().map(|n| [n.to_le_bytes()])))?;
        fs::write(file("inside"), bytes(c.1.iter().map(|n| [n.to_le_bytes()])))?;
        fs::write(file("seconds"), format!("{} {} {} {}\n", a.0, e.0, c.0, f.0))?;
    }
    Ok(())
}

/// Keeps the answers and the least time.
fn time(best: &mut (f64, Vec<u32>), ask: impl FnOnce() -> Vec<u32>) {
    let start = trees::cpu_seconds();
    best.1 = ask();
    best.0 = best.0.min(trees::cpu_seconds() - start);
}
