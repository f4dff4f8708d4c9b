//! Times the minimal sphere of spheres: ours beside CGAL's, in turn, on one core; see README.md.

use std::hint::black_box;
use std::time::Instant;

use glam::DVec3;
use rt_geom::{Sphere, enclosing_sphere};

unsafe extern "C" {
    fn cgal_farthest_first(spheres: *const f64, n: usize, out: *mut f64);
    fn cgal_farthest_first_no_roots(spheres: *const f64, n: usize, out: *mut f64);
}

/// A generator of even 64-bit numbers: Steele, Lea, Flood, "Fast splittable pseudorandom number generators", 2014.
struct SplitMix(u64);

impl SplitMix {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in 0..1.
    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 * (-53.0_f64).exp2()
    }

    /// Normal with mean 0 and variance 1 (the sum of twelve uniform numbers less six).
    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.unit()).sum::<f64>() - 6.0
    }
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    Cube,
    Gauss,
    Shell,
}

fn spheres(kind: Kind, n: usize, random: &mut SplitMix) -> Vec<Sphere> {
    let largest = 0.5 / (n as f64).cbrt();
    (0..n)
        .map(|_| {
            let center = match kind {
                Kind::Cube => DVec3::new(random.unit(), random.unit(), random.unit()),
                Kind::Gauss => DVec3::new(random.normal(), random.normal(), random.normal()),
                Kind::Shell => DVec3::new(random.normal(), random.normal(), random.normal()).normalize(),
            };
            Sphere::new(center, largest * random.unit()).expect("finite")
        })
        .collect()
}

fn cgal(run: unsafe extern "C" fn(*const f64, usize, *mut f64), set: &[f64]) -> f64 {
    let mut out = [0.0; 4];
    // SAFETY: the shim reads 4 n doubles and writes 4.
    unsafe { run(set.as_ptr(), set.len() / 4, out.as_mut_ptr()) };
    out[3]
}

/// The limit: every number of the set is read once.
fn read(set: &[Sphere]) -> [f64; 4] {
    set.iter().fold([0.0; 4], |most, s| {
        let row = [s.center().x, s.center().y, s.center().z, s.radius()];
        std::array::from_fn(|i| if row[i] > most[i] { row[i] } else { most[i] })
    })
}

fn main() {
    let only: Option<usize> = std::env::args().nth(1).and_then(|n| n.parse().ok());
    println!(
        "{:>8} {:>6} {:>12} {:>12} {:>12} {:>12} {:>8} {:>8}",
        "n", "kind", "CGAL", "no roots", "read once", "ours", "ratio", "ratio"
    );
    for (n, sets, rounds) in [
        (2, 4096, 300),
        (3, 4096, 200),
        (4, 4096, 200),
        (8, 4096, 100),
        (16, 2048, 100),
        (64, 1024, 100),
        (1000, 64, 100),
        (100_000, 1, 60),
        (1_000_000, 1, 20),
    ] {
        if only.is_some_and(|only| only != n) {
            continue;
        }
        for kind in [Kind::Cube, Kind::Gauss, Kind::Shell] {
            let mut random = SplitMix(n as u64);
            let ours: Vec<Vec<Sphere>> = (0..sets).map(|_| spheres(kind, n, &mut random)).collect();
            let flat: Vec<Vec<f64>> = ours
                .iter()
                .map(|set| set.iter().flat_map(|s| [s.center().x, s.center().y, s.center().z, s.radius()]).collect())
                .collect();
            for (ours, flat) in ours.iter().zip(&flat) {
                let radius = enclosing_sphere(ours).expect("not empty").sphere.radius();
                let peer = cgal(cgal_farthest_first, flat);
                assert!((radius - peer).abs() < 1e-12 * peer, "{n} {radius} {peer}");
            }
            let mut best = [f64::INFINITY; 4];
            for _ in 0..rounds {
                for (contestant, best) in best.iter_mut().enumerate() {
                    let start = Instant::now();
                    for (ours, flat) in ours.iter().zip(&flat) {
                        match contestant {
                            0 => {
                                black_box(cgal(cgal_farthest_first, flat));
                            }
                            // Ours and the limit each after a run of CGAL, so that both find the same caches.
                            1 => {
                                black_box(enclosing_sphere(ours));
                            }
                            2 => {
                                black_box(cgal(cgal_farthest_first_no_roots, flat));
                            }
                            _ => {
                                black_box(read(ours));
                            }
                        }
                    }
                    *best = best.min(start.elapsed().as_secs_f64() / sets as f64 * 1e9);
                }
            }
            let [roots, own, none, read] = best;
            let kind = format!("{kind:?}");
            println!(
                "{n:8} {kind:>6} {roots:9.0} ns {none:9.0} ns {read:9.0} ns {own:9.0} ns {:8.2} {:8.2}",
                roots / own,
                none / own
            );
        }
    }
}
