//! The scan of large sets: blocks that cannot stick out are not read again.

use fearless_simd::{Simd, f64x8, prelude::*, u64x8};
use glam::DVec3;
use rt_math::exact::U;

use super::pivot::{LANES, SphereLanes, TOUCHES, for_eights, marked, measure, pivot};
use super::tangent::{ORDINARY, Tangent};
use crate::Sphere;
use crate::simd::prefetch_lines;

/// Spheres to a block: enough to make skipping cheap, few enough to skip most blocks; and the lowest bits of a measure
/// tell them apart.
const BLOCK: usize = 64;

/// How many spheres the small solver takes.
const FEW: usize = 64;

/// Of large sets one run in so many is solved first.
const SAMPLE: usize = 32;

/// Spheres to a run of the sample: enough for the memory's sake.
const RUN: usize = 16;

/// Of sets that no cache holds, what is so many spheres ahead is asked for now: two pages, which the processor's own
/// prefetching does not cross.
const AHEAD: usize = 256;

/// Up to so many blocks are kept on the stack.
const SMALL: usize = 64;

/// The spheres of a set, or a sample of them, in blocks, and how far each may reach.
pub(super) struct SphereBlocks<'a> {
    spheres: &'a [Sphere],
    origin: DVec3,
    /// Spheres to a block.
    size: usize,
    /// From the start of a block to that of the next.
    stride: usize,
    /// An upper bound of each block's reach at its last scan, less the length of the way that the center had come then.
    bounds: &'a mut [f64],
    /// The length of the way that the center has come.
    way: f64,
    center: [f64; 3],
    /// Whether the set is large: asking for blocks ahead pays.
    large: bool,
}

/// Finds the support of a set of more than a handful of spheres, then calls `visit` with it and the blocks; `None` if
/// the extent of the set is out of the ordinary range.
///
/// In turn: every block that may stick out of the sphere that was found last is scanned, the sphere of each that sticks
/// out farthest (of the blocks that stick out farthest, if there are many) joins the support, and the minimal sphere of
/// these takes the place of the last. The first one is a small one in the middle of the box around the set; a large
/// set begins with the minimal sphere of a sample.
#[inline(always)]
pub(super) fn support<S: Simd, T>(
    simd: S,
    spheres: &[Sphere],
    origin: DVec3,
    visit: impl FnOnce(Tangent<f64>, SphereBlocks) -> T,
) -> Option<T> {
    let count = spheres.len().div_ceil(BLOCK);
    let large = count > SMALL;
    let (mut few, mut many) = ([0.0; SMALL], Vec::new());
    let bounds = if large {
        many.resize(count, 0.0);
        &mut many[..]
    } else {
        &mut few[..count]
    };
    let mut start = None;
    if large {
        let stride = RUN * SAMPLE;
        let bounds = &mut bounds[..spheres.len() / stride];
        let mut sample = SphereBlocks::new(spheres, origin, RUN, stride, bounds, large);
        // (Of a sample that is a single point nothing can be learned.)
        start = sample.rounds(simd, None);
    }
    let mut blocks = SphereBlocks::new(spheres, origin, BLOCK, BLOCK, bounds, large);
    let tangent = blocks.rounds(simd, start.as_ref())?;
    Some(visit(tangent, blocks))
}

impl<'a> SphereBlocks<'a> {
    fn new(
        spheres: &'a [Sphere],
        origin: DVec3,
        size: usize,
        stride: usize,
        bounds: &'a mut [f64],
        large: bool,
    ) -> Self {
        Self { spheres, origin, size, stride, bounds, way: 0.0, center: [0.0; 3], large }
    }

    /// The support of all blocks, given that of some spheres.
    #[inline(never)]
    fn rounds<S: Simd>(&mut self, simd: S, start: Option<&Tangent<f64>>) -> Option<Tangent<f64>> {
        simd.vectorize(
            #[inline(always)]
            || self.rounds_here(simd, start),
        )
    }

    #[inline(always)]
    fn rounds_here<S: Simd>(&mut self, simd: S, start: Option<&Tangent<f64>>) -> Option<Tangent<f64>> {
        let (spheres, origin) = (self.spheres, self.origin);
        let mut tangent = start.copied();
        let (mut center, mut radius) = match tangent {
            Some(tangent) => tangent.sphere(spheres, origin),
            None => self.middle(simd),
        };
        self.bounds.fill(f64::INFINITY);
        self.center = center;
        for round in 0..MAX_ROUNDS {
            let far = DVec3::from(center).length();
            if !(radius < ORDINARY.end && far < ORDINARY.end) {
                return None;
            }
            let out = self.scan(simd, center, radius);
            if round == 0 {
                // The largest reach is at least the one and less than the other.
                let root = out.most.sqrt();
                if radius.max(root) < ORDINARY.start || radius + 2.0 * root + far >= ORDINARY.end {
                    return None;
                }
            }
            if out.count == 0 {
                break;
            }
            let mut these = [0; FEW];
            let support = tangent.as_ref().map_or(&[][..], Tangent::support);
            these[..support.len()].copy_from_slice(support);
            for (slot, &at) in these[support.len()..].iter_mut().zip(&out.places[..out.count]) {
                *slot = at;
            }
            let these = &these[..support.len() + out.count];
            let mut next = tangent.unwrap_or_else(|| Tangent::single(these[0]));
            among(simd, &mut next, these, spheres, origin);
            // (A first one may have no radius at all.)
            let last = if tangent.is_some() { radius } else { f64::NEG_INFINITY };
            (center, radius) = next.sphere(spheres, origin);
            if radius <= last {
                break;
            }
            tangent = Some(next);
        }
        tangent
    }

    /// The middle of the box around the spheres, less the origin, and less than the largest reach from it.
    #[inline(always)]
    fn middle<S: Simd>(&self, simd: S) -> ([f64; 3], f64) {
        let mut low = [f64x8::splat(simd, f64::INFINITY); 3];
        let mut high = [f64x8::splat(simd, f64::NEG_INFINITY); 3];
        for block in 0..self.bounds.len() {
            self.prefetch(block + AHEAD / self.size);
            for_eights(
                simd,
                self.block(block),
                self.origin,
                #[inline(always)]
                |[x, y, z, r]| {
                    for ((low, high), c) in low.iter_mut().zip(&mut high).zip([x, y, z]) {
                        *low = low.min(*c - *r);
                        *high = high.max(*c + *r);
                    }
                },
            );
        }
        let low = [low[0].reduce_min(), low[1].reduce_min(), low[2].reduce_min()];
        let high = [high[0].reduce_max(), high[1].reduce_max(), high[2].reduce_max()];
        let half: [f64; 3] = std::array::from_fn(|axis| 0.5 * (high[axis] - low[axis]));
        // Half of the largest half: some sphere reaches farther.
        (std::array::from_fn(|axis| low[axis] + half[axis]), 0.5 * half[0].max(half[1]).max(half[2]))
    }

    #[inline(always)]
    fn block(&self, block: usize) -> &'a [Sphere] {
        let start = block * self.stride;
        &self.spheres[start..self.spheres.len().min(start + self.size)]
    }

    /// Scans the blocks that may stick out of the sphere around `center`.
    #[inline(always)]
    fn scan<S: Simd>(&mut self, simd: S, center: [f64; 3], radius: f64) -> Out {
        self.go(center);
        let skip = self.skip(radius);
        let touches = radius * radius * TOUCHES;
        let widened = radius * radius * (1.0 + MEASURE_ERROR);
        let mut out = Out::new();
        let (mut ahead, mut lead) = (0, 0_usize);
        let (way, origin, center) = (self.way, self.origin, self.center);
        for block in 0..self.bounds.len() {
            if self.bounds[block] <= skip {
                continue;
            }
            if self.large {
                lead = lead.saturating_sub(1);
                while lead < AHEAD / self.size {
                    while ahead < self.bounds.len() && self.bounds[ahead] <= skip {
                        ahead += 1;
                    }
                    self.prefetch(ahead);
                    ahead += 1;
                    lead += 1;
                }
            }
            let (at, most, largest) = farthest(simd, self.block(block), origin, center, radius);
            // The reach d + r with d² - (radius - r)² <= most: if that is positive it grows with r, otherwise it is
            // largest for r = 0.
            let reach = if most > 0.0 {
                let largest = largest.reduce_max();
                let room = radius - largest;
                (largest + (room * room + most).sqrt()) * (1.0 + REACH_ERROR)
            } else {
                (widened + most).max(0.0).sqrt()
            };
            self.bounds[block] = reach - way;
            if most > touches {
                out.add(simd, most, block * self.stride + at);
            }
        }
        out
    }

    /// Asks for a block that will be scanned soon, if there is one.
    #[inline(always)]
    fn prefetch(&self, block: usize) {
        if self.large && block < self.bounds.len() {
            prefetch_lines(&raw const self.spheres[block * self.stride], self.size / 2);
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
    #[inline(always)]
    pub(super) fn beyond<S: Simd>(mut self, simd: S, center: [f64; 3], limit: f64, mut visit: impl FnMut(usize)) {
        self.go(center);
        let skip = self.skip(limit);
        for (block, bound) in self.bounds.iter().enumerate() {
            if *bound > skip {
                let spheres = self.block(block);
                let (mut found, mut place) = (0, 0);
                for_eights(
                    simd,
                    spheres,
                    self.origin,
                    #[inline(always)]
                    |eight| {
                        let measure = measure(simd, eight, center, limit);
                        found |= measure.simd_ge(f64x8::splat(simd, 0.0)).to_bitmask() << place;
                        place += LANES;
                    },
                );
                found &= u64::MAX >> (BLOCK - spheres.len());
                while found != 0 {
                    visit(block * self.stride + found.trailing_zeros() as usize);
                    found &= found - 1;
                }
            }
        }
    }
}

/// The spheres that stick out farthest, one of a block.
struct Out {
    measures: [f64; FEW],
    places: [usize; FEW],
    count: usize,
    /// Which has the least measure, once there is no more room.
    least: usize,
    /// The greatest measure; 0 if none is positive.
    most: f64,
}

impl Out {
    /// A support is solved with them.
    const ROOM: usize = FEW - 4;

    #[inline(always)]
    fn new() -> Self {
        Self { measures: [f64::MAX; FEW], places: [0; FEW], count: 0, least: 0, most: 0.0 }
    }

    #[inline(always)]
    fn add<S: Simd>(&mut self, simd: S, measure: f64, at: usize) {
        self.most = self.most.max(measure);
        let slot = if self.count < Self::ROOM {
            self.count += 1;
            self.count - 1
        } else if measure > self.measures[self.least] {
            self.least
        } else {
            return;
        };
        (self.measures[slot], self.places[slot]) = (measure, at);
        if self.count == Self::ROOM {
            let mut least = f64x8::splat(simd, f64::MAX);
            let mut place = u64x8::simd_from(simd, [0, 1, 2, 3, 4, 5, 6, 7]);
            for eight in self.measures.as_chunks::<LANES>().0 {
                least = least.min(marked(f64x8::simd_from(simd, *eight), place));
                place += LANES as u64;
            }
            self.least = (least.reduce_min().to_bits() & 63) as usize;
        }
    }
}

/// Relative error bound of a reach from a measure that is positive: its marks and the rounding.
const REACH_ERROR: f64 = 128.0 * U;

/// Error bound of a measure that is not positive, as a share of the square of the radius: its marks and the rounding.
const MEASURE_ERROR: f64 = 256.0 * U;

/// No set known needs more than a dozen rounds.
const MAX_ROUNDS: usize = 64;

/// Turns the minimal sphere of some of a few spheres into that of all of them.
#[inline(always)]
fn among<S: Simd>(simd: S, tangent: &mut Tangent<f64>, these: &[usize], spheres: &[Sphere], origin: DVec3) {
    let listed = these.iter().map(|&index| &spheres[index]);
    if these.len() <= 3 * LANES {
        let lanes = SphereLanes::<S, 3>::new(simd, listed, origin);
        pivot(simd, tangent, &lanes, |lane| these[lane], spheres, origin);
    } else {
        let lanes = SphereLanes::<S, { FEW / LANES }>::new(simd, listed, origin);
        pivot(simd, tangent, &lanes, |lane| these[lane], spheres, origin);
    }
}

/// Which sphere of a block sticks out farthest of the one around `center`, its [`measure`], and the largest radii.
#[inline(always)]
fn farthest<S: Simd>(
    simd: S,
    block: &[Sphere],
    origin: DVec3,
    center: [f64; 3],
    radius: f64,
) -> (usize, f64, f64x8<S>) {
    let mut most = f64x8::splat(simd, f64::NEG_INFINITY);
    let mut lane = u64x8::simd_from(simd, [0, 1, 2, 3, 4, 5, 6, 7]);
    let mut largest = f64x8::splat(simd, 0.0);
    for_eights(
        simd,
        block,
        origin,
        #[inline(always)]
        |eight| {
            let measure = measure(simd, eight, center, radius);
            largest = largest.max(eight[3]);
            // An infinite measure with a mark would be no number.
            most = most.max(marked(measure.min(f64x8::splat(simd, f64::MAX)), lane));
            lane += LANES as u64;
        },
    );
    let most = most.reduce_max();
    // A lane beyond the end stands for the first of its eight.
    let at = (most.to_bits() & 63) as usize;
    (if at < block.len() { at } else { at / LANES * LANES }, most, largest)
}

#[cfg(test)]
mod tests {
    use fearless_simd::Fallback;

    use super::super::exact::contains_exactly;
    use super::*;

    /// Blocks of spheres around the origin with radii made of numbers in 0..1.
    fn blocks(radius: impl Fn(f64) -> f64) -> Vec<Sphere> {
        let mut random = oracle::Random::new(5);
        let mut unit = || random.share();
        (0..BLOCK * 50)
            .map(|_| {
                let center = DVec3::new(unit() - 0.5, unit() - 0.5, unit() - 0.5);
                Sphere::new(center, radius(unit())).unwrap()
            })
            .collect()
    }

    #[test]
    fn no_sphere_reaches_beyond_the_bound_of_its_block() {
        // What `skip` allows for besides the bound.
        const ALLOWED: f64 = 6.0 * U;
        let simd = Fallback::new();
        let small = |_: f64| 0.0;
        let equal = |_: f64| 0.125;
        let mixed = |unit: f64| 0.75 * unit * unit;
        for (which, spheres) in [blocks(small), blocks(equal), blocks(mixed)].iter().enumerate() {
            let (mut inside, mut outside) = (0, 0);
            for round in 0..40 {
                let center = DVec3::new(0.01 * f64::from(round), -0.02, 0.3);
                let radius = 0.05 * f64::from(round + 1);
                let mut bounds = vec![f64::INFINITY; spheres.len() / BLOCK];
                let mut blocks = SphereBlocks::new(spheres, DVec3::ZERO, BLOCK, BLOCK, &mut bounds, round % 2 == 0);
                blocks.center = center.into();
                let out = blocks.scan(simd, center.into(), radius);
                for (block, &bound) in spheres.chunks(BLOCK).zip(&bounds) {
                    for sphere in block {
                        let bound = (bound * (1.0 + ALLOWED)).min(f64::MAX);
                        assert!(contains_exactly(center, bound, sphere), "{center} {radius} {sphere:?}");
                    }
                    let reach = |s: &Sphere| (s.center() - center).length() + s.radius();
                    let most = block.iter().map(reach).fold(0.0, f64::max);
                    let sharp = bound < most * (1.0 + 1e-12);
                    match which {
                        // The bound is the reach, on both sides of the sphere.
                        0 => assert!(sharp, "{bound} {most}"),
                        // All radii are equal and below `radius`: it is the reach of those that stick out.
                        1 if most > radius && radius > 0.125 => assert!(sharp, "{bound} {most}"),
                        _ => {}
                    }
                    inside += usize::from(most < radius);
                    outside += usize::from(most > radius);
                }
                assert_eq!(out.count > 0, out.most > 0.0);
            }
            assert!(inside > 300 && outside > 300, "{inside} {outside}");
        }
    }

    #[test]
    fn the_spheres_that_stick_out_farthest_are_kept() {
        let simd = Fallback::new();
        let mut out = Out::new();
        let measures: Vec<f64> = (0..500_u32).map(|i| f64::from(i * 7919 % 500 + 1)).collect();
        for (at, &measure) in measures.iter().enumerate() {
            out.add(simd, measure, at);
        }
        let mut kept: Vec<f64> = out.places[..out.count].iter().map(|&at| measures[at]).collect();
        kept.sort_by(f64::total_cmp);
        let largest: Vec<f64> = (441..=500).map(f64::from).collect();
        assert_eq!(kept, largest);
        assert_eq!(out.most, 500.0);
    }
}
