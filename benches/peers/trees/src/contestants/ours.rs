//! `Bvh`: one ray at a time and batches of 8192 (eight rows of the camera), with the best instruction set and with AVX2 alone.
//!
//! With a set that is named, rays of a batch are on their way together even where one after the other is faster.
//! Narrowing the answers to f32 and widening the rays to f64 is part of the time.

use glam::DVec3;
use rt_geom as geom;

use crate::workload::Mesh;
use crate::{Contestant, Hit, Ray, Sphere, Tracer};

const AHEAD: std::ops::Range<f64> = 0.0..f64::INFINITY;
/// Eight rows of the camera's picture.
const BATCH: usize = 8192;

struct Ours {
    tree: geom::Bvh,
    batch: bool,
}

fn vector(v: [f32; 3]) -> DVec3 {
    DVec3::from(v.map(f64::from))
}

pub fn widen(ray: &Ray) -> geom::Ray {
    geom::Ray::new(vector(ray.origin), vector(ray.direction)).expect("rays of the workload are valid")
}

fn narrow(hit: Option<geom::Hit>) -> Hit {
    hit.map_or(Hit::MISS, |hit| Hit { t: hit.t as f32, id: hit.index as u32 })
}

impl Tracer for Ours {
    fn closest(&self, rays: &[Ray], hits: &mut [Hit]) {
        if !self.batch {
            for (ray, hit) in rays.iter().zip(hits) {
                *hit = narrow(self.tree.closest(&widen(ray), AHEAD));
            }
            return;
        }
        let mut wide = Vec::with_capacity(BATCH);
        let mut answers = vec![None; BATCH];
        for (rays, hits) in rays.chunks(BATCH).zip(hits.chunks_mut(BATCH)) {
            wide.clear();
            wide.extend(rays.iter().map(widen));
            self.tree.closest_batch(&wide, AHEAD, &mut answers[..rays.len()]);
            for (hit, answer) in hits.iter_mut().zip(&answers) {
                *hit = narrow(*answer);
            }
        }
    }

    fn occluded(&self, rays: &[Ray]) -> Option<usize> {
        if !self.batch {
            return Some(rays.iter().filter(|ray| self.tree.any(&widen(ray), AHEAD)).count());
        }
        let mut wide = Vec::with_capacity(BATCH);
        let mut answers = vec![false; BATCH];
        let mut count = 0;
        for rays in rays.chunks(BATCH) {
            wide.clear();
            wide.extend(rays.iter().map(widen));
            self.tree.any_batch(&wide, AHEAD, &mut answers[..rays.len()]);
            count += answers[..rays.len()].iter().filter(|hit| **hit).count();
        }
        Some(count)
    }
}

/// The triangles of a mesh in f64.
pub fn triangles((corners, triangles): &Mesh) -> Vec<geom::Triangle> {
    let triangle = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| vector(corners[i as usize]));
        geom::Triangle::new(a, b, c).expect("finite corners")
    };
    triangles.iter().map(triangle).collect()
}

/// A mesh, one ray at a time or in batches.
pub fn mesh(mesh: &Mesh, batch: bool, simd: Option<&str>) -> Box<dyn Tracer> {
    let tree = geom::Bvh::new(Vec::new(), triangles(mesh));
    let tree = match simd {
        Some(name) => tree.with_simd(name).expect("this CPU has the instruction set"),
        None => tree,
    };
    Box::new(Ours { tree, batch })
}

pub fn contestants() -> Vec<Contestant> {
    let row = |name, batch, simd: Option<&'static str>| Contestant {
        name,
        camera_only: false,
        slow: false,
        build: Box::new(move |spheres: &[Sphere]| {
            let sphere = |s: &Sphere| geom::Sphere::new(vector([s[0], s[1], s[2]]), f64::from(s[3])).expect("valid");
            let tree = geom::Bvh::new(spheres.iter().map(sphere).collect(), Vec::new());
            let tree = match simd {
                Some(name) => tree.with_simd(name).expect("this CPU has the instruction set"),
                None => tree,
            };
            Box::new(Ours { tree, batch })
        }),
    };
    vec![
        row("ours single", false, None),
        row("ours batch", true, None),
        row("ours single avx2", false, Some("avx2")),
        row("ours batch avx2", true, Some("avx2")),
    ]
}
