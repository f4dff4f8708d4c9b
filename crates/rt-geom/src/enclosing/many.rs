//! The scan of large sets: blocks that cannot stick out are not read again.

use fearless_simd::Simd;
use glam::DVec3;

use super::ORDINARY;
use super::basis::Tangent;
use super::certify::U;
use super::few::pivot;
use super::lanes::Lanes;
use crate::Sphere;

/// Spheres to a block: enough to make skipping cheap, few enough to skip most blocks.
const BLOCK: usize = 64;

/// How many spheres the small solver takes.
const FEW: usize = 64;

/// Of large sets every so many-th sphere is a set to solve first.
const SAMPLE: usize = 32;

/// Places spread evenly over a set.
fn spread(count: usize) -> [usize; FEW] {
    std::array::from_fn(|i| i * count / FEW)
}

/// The largest reach of each block, at the time of its last scan.
pub(super) struct Blocks {
    /// The reach less the length of the way that the center had come by then.
    reach: Vec<f64>,
    /// The length of the way that the center has come.
    way: f64,
    center: [f64; 3],
}

impl Blocks {
    /// Finds the support of a set of more than a handful of spheres; `None` if its extent is out of the ordinary range.
    ///
    /// Solves a sample first. Then, in turn: every block that may stick out is scanned, the farthest sphere of each
    /// (of those that stick out farthest, if there are many) joins the support, and the minimal sphere of these
    /// takes the place of the last.
    #[inline(always)]
    pub(super) fn support<S: Simd>(
        simd: S,
        spheres: &[Sphere],
        origin: DVec3,
    ) -> Option<(Tangent<f64>, Self)> {
        let mut start = spread(spheres.len());
        let mut count = FEW;
        if spheres.len() > FEW * SAMPLE {
            let sample: Vec<Sphere> = spheres.iter().step_by(SAMPLE).copied().collect();
            // (Of a sample that is a single point nothing can be learned.)
            if let Some((tangent, _)) = Self::rounds(simd, &sample, origin, &spread(sample.len())) {
                count = tangent.support().len();
                for (index, &at) in start.iter_mut().zip(tangent.support()) {
                    *index = at * SAMPLE;
                }
            }
        }
        Self::rounds(simd, spheres, origin, &start[..count])
    }

    /// The support of the whole set, given where to look first.
    #[inline(always)]
    fn rounds<S: Simd>(
        simd: S,
        spheres: &[Sphere],
        origin: DVec3,
        start: &[usize],
    ) -> Option<(Tangent<f64>, Self)> {
        simd.vectorize(
            #[inline(always)]
            || Self::rounds_here(simd, spheres, origin, start),
        )
    }

    #[inline(always)]
    fn rounds_here<S: Simd>(
        simd: S,
        spheres: &[Sphere],
        origin: DVec3,
        start: &[usize],
    ) -> Option<(Tangent<f64>, Self)> {
        let mut tangent = among(simd, &Tangent::single(start[0]), start, spheres, origin);
        let (center, _) = tangent.sphere(spheres, origin);
        let count = spheres.len().div_ceil(BLOCK);
        let mut blocks = Self { reach: vec![f64::INFINITY; count], way: 0.0, center };
        let mut out: Vec<(f64, usize)> = Vec::new();
        for round in 0..MAX_ROUNDS {
            let (center, radius) = tangent.sphere(spheres, origin);
            let limit = radius * (1.0 + 16.0 * U);
            blocks.scan(spheres, origin, center, limit, &mut out);
            if round == 0 {
                let most = blocks.reach.iter().fold(0.0, |most, &reach| f64::max(most, reach));
                let far = DVec3::from(center).length();
                if !ORDINARY.contains(&most) || !ORDINARY.contains(&(most + far)) {
                    return None;
                }
            }
            if out.is_empty() {
                break;
            }
            let take = out.len().min(FEW - 4);
            if out.len() > take {
                out.select_nth_unstable_by(take, |a, b| b.0.total_cmp(&a.0));
            }
            let mut these = [0; FEW];
            let support = tangent.support();
            these[..support.len()].copy_from_slice(support);
            for (slot, &(reach, block)) in these[support.len()..].iter_mut().zip(&out[..take]) {
                *slot = find(spheres, block, origin, center, reach);
            }
            let all = support.len() + take;
            let next = among(simd, &tangent, &these[..all], spheres, origin);
            let grows = next.sphere(spheres, origin).1 > radius;
            if !grows {
                break;
            }
            tangent = next;
        }
        Some((tangent, blocks))
    }

    /// Scans the blocks that may reach beyond `limit` from `center`, and lists those that do.
    #[inline(always)]
    fn scan(
        &mut self,
        spheres: &[Sphere],
        origin: DVec3,
        center: [f64; 3],
        limit: f64,
        out: &mut Vec<(f64, usize)>,
    ) {
        self.go(center);
        out.clear();
        let skip = self.skip(limit);
        for (block, (stored, chunk)) in self.reach.iter_mut().zip(spheres.chunks(BLOCK)).enumerate() {
            if *stored > skip {
                let reach = farthest(chunk, origin, center);
                *stored = reach - self.way;
                if reach > limit {
                    out.push((reach, block));
                }
            }
        }
    }

    /// The stored number up to which a block has nothing beyond `limit`, rounding included.
    fn skip(&self, limit: f64) -> f64 {
        limit - self.way - 128.0 * U * (limit + self.way)
    }

    /// Moves the center.
    fn go(&mut self, center: [f64; 3]) {
        self.way += (DVec3::from(center) - DVec3::from(self.center)).length();
        self.center = center;
    }

    /// Calls `visit` with the spheres that may reach beyond `limit` from `center`.
    pub(super) fn beyond(
        mut self,
        spheres: &[Sphere],
        origin: DVec3,
        center: [f64; 3],
        limit: f64,
        mut visit: impl FnMut(usize),
    ) {
        self.go(center);
        let skip = self.skip(limit);
        for (block, (stored, chunk)) in self.reach.iter().zip(spheres.chunks(BLOCK)).enumerate() {
            if *stored > skip {
                for (i, sphere) in chunk.iter().enumerate() {
                    if reach(sphere, origin, center) >= limit {
                        visit(block * BLOCK + i);
                    }
                }
            }
        }
    }
}

/// No set known needs more than a dozen rounds.
const MAX_ROUNDS: usize = 64;

/// The minimal sphere of a few spheres, in terms of their places in the whole set.
#[inline(always)]
fn among<S: Simd>(
    simd: S,
    start: &Tangent<f64>,
    these: &[usize],
    spheres: &[Sphere],
    origin: DVec3,
) -> Tangent<f64> {
    let lanes = Lanes::<S, { FEW / 8 }>::new(simd, these.iter().map(|&index| &spheres[index]), origin);
    pivot(simd, start, &lanes, these, spheres, origin)
}

/// How far a sphere reaches from `center`, which is relative to `origin`.
#[inline(always)]
fn reach(sphere: &Sphere, origin: DVec3, center: [f64; 3]) -> f64 {
    let c = sphere.center();
    let (x, y, z) =
        ((c.x - origin.x) - center[0], (c.y - origin.y) - center[1], (c.z - origin.z) - center[2]);
    (x * x + y * y + z * z).sqrt() + sphere.radius()
}

/// The largest reach of a block. Plain code that the compiler turns into vectors.
#[inline(always)]
fn farthest(block: &[Sphere], origin: DVec3, center: [f64; 3]) -> f64 {
    let mut most = [0.0_f64; 8];
    let (eights, rest) = block.as_chunks::<8>();
    for eight in eights {
        for (most, sphere) in most.iter_mut().zip(eight) {
            let reach = reach(sphere, origin, center);
            *most = if reach > *most { reach } else { *most };
        }
    }
    for sphere in rest {
        let reach = reach(sphere, origin, center);
        most[0] = if reach > most[0] { reach } else { most[0] };
    }
    most.into_iter().fold(0.0, |most, reach| if reach > most { reach } else { most })
}

/// The place of the sphere that reaches farthest in a block: the one with the given reach.
#[inline(always)]
fn find(spheres: &[Sphere], block: usize, origin: DVec3, center: [f64; 3], most: f64) -> usize {
    let start = block * BLOCK;
    let end = (start + BLOCK).min(spheres.len());
    let at = spheres[start..end].iter().position(|sphere| reach(sphere, origin, center) >= most);
    start + at.unwrap_or(0)
}
