//! The scan of large sets: blocks that cannot stick out are not read again.

use fearless_simd::{Simd, f64x8, prelude::*, u64x8};
use glam::DVec3;

use super::ORDINARY;
use super::basis::Tangent;
use super::certify::U;
use super::few::{TOUCHES, pivot};
use super::lanes::{LANES, Lanes, columns, marked, measure};
use crate::Sphere;

/// Spheres to a block: enough to make skipping cheap, few enough to skip most blocks; and the lowest bits of a measure
/// tell them apart.
const BLOCK: usize = 64;

/// How many spheres the small solver takes.
const FEW: usize = 64;

/// Of large sets one run in so many is solved first.
const SAMPLE: usize = 32;

/// Spheres to a run of the sample: enough for the memory's sake.
const RUN: usize = 16;

/// Up to so many blocks are kept on the stack.
const SMALL: usize = 64;

/// The spheres of a set, or a sample of them, in blocks, and how far each may reach.
pub(super) struct Blocks<'a> {
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
    visit: impl FnOnce(Tangent<f64>, Blocks) -> T,
) -> Option<T> {
    let count = spheres.len().div_ceil(BLOCK);
    let (mut few, mut many) = ([0.0; SMALL], Vec::new());
    let bounds = if count <= SMALL {
        &mut few[..count]
    } else {
        many.resize(count, 0.0);
        &mut many[..]
    };
    let mut start = None;
    if count > SMALL {
        let stride = RUN * SAMPLE;
        let bounds = &mut bounds[..spheres.len() / stride];
        let mut sample = Blocks { spheres, origin, size: RUN, stride, bounds, way: 0.0, center: [0.0; 3] };
        // (Of a sample that is a single point nothing can be learned.)
        start = sample.rounds(simd, None);
    }
    let mut blocks =
        Blocks { spheres, origin, size: BLOCK, stride: BLOCK, bounds, way: 0.0, center: [0.0; 3] };
    let tangent = blocks.rounds(simd, start.as_ref())?;
    Some(visit(tangent, blocks))
}

impl<'a> Blocks<'a> {
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
        let (mut center, mut radius) =
            tangent.map_or_else(|| self.middle(simd), |tangent| tangent.sphere(spheres, origin));
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
            for (slot, &(_, at)) in these[support.len()..].iter_mut().zip(&out.found[..out.count]) {
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
            let (eights, rest) = self.block(block).as_chunks::<LANES>();
            for eight in eights {
                widen(&mut low, &mut high, &columns(simd, eight.each_ref(), self.origin));
            }
            if let Some(first) = rest.first() {
                let eight = std::array::from_fn(|i| rest.get(i).unwrap_or(first));
                widen(&mut low, &mut high, &columns(simd, eight, self.origin));
            }
        }
        let low = low.map(|low| low.reduce_min());
        let high = high.map(|high| high.reduce_max());
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
        let square = radius * radius;
        let touches = square * TOUCHES;
        let widened = square * (1.0 + MEASURE_ERROR);
        let mut out = Out { found: [(0.0, 0); FEW - 4], count: 0, least: 0, most: 0.0 };
        for (block, bound) in self.bounds.iter_mut().enumerate() {
            if *bound > skip {
                let start = block * self.stride;
                let end = self.spheres.len().min(start + self.size);
                let (at, most) = farthest(simd, &self.spheres[start..end], self.origin, center, radius);
                // The reach d + r with d² - (radius - r)² <= most: if that is negative it is largest for r = 0.
                let reach = if most > 0.0 { f64::INFINITY } else { (widened + most).max(0.0).sqrt() };
                *bound = reach - self.way;
                if most > touches {
                    out.add(most, start + at);
                }
            }
        }
        out
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
    pub(super) fn beyond<S: Simd>(
        mut self,
        simd: S,
        center: [f64; 3],
        limit: f64,
        mut visit: impl FnMut(usize),
    ) {
        self.go(center);
        let skip = self.skip(limit);
        for (block, bound) in self.bounds.iter().enumerate() {
            if *bound > skip {
                let start = block * self.stride;
                let end = self.spheres.len().min(start + self.size);
                let lanes =
                    Lanes::<S, { BLOCK / LANES }>::new(simd, self.spheres[start..end].iter(), self.origin);
                let mut found = lanes.beyond(simd, center, limit) & (u64::MAX >> (64 - (end - start)));
                while found != 0 {
                    visit(start + found.trailing_zeros() as usize);
                    found &= found - 1;
                }
            }
        }
    }
}

/// The spheres that stick out farthest, one of a block.
struct Out {
    /// The measures and the places.
    found: [(f64, usize); FEW - 4],
    count: usize,
    /// The place of the least one in `found`.
    least: usize,
    /// The greatest measure; 0 if none is positive.
    most: f64,
}

impl Out {
    fn add(&mut self, measure: f64, at: usize) {
        self.most = self.most.max(measure);
        if self.count < self.found.len() {
            self.found[self.count] = (measure, at);
            self.count += 1;
        } else if measure > self.found[self.least].0 {
            self.found[self.least] = (measure, at);
        } else {
            return;
        }
        if self.count == self.found.len() {
            for (place, found) in self.found.iter().enumerate() {
                if found.0 < self.found[self.least].0 {
                    self.least = place;
                }
            }
        }
    }
}

/// Error bound of a measure that is not positive, as a share of the square of the radius: its marks and the rounding.
const MEASURE_ERROR: f64 = 256.0 * U;

/// No set known needs more than a dozen rounds.
const MAX_ROUNDS: usize = 64;

/// Turns the minimal sphere of some of a few spheres into that of all of them.
#[inline(always)]
fn among<S: Simd>(simd: S, tangent: &mut Tangent<f64>, these: &[usize], spheres: &[Sphere], origin: DVec3) {
    let listed = these.iter().map(|&index| &spheres[index]);
    if these.len() <= 3 * LANES {
        let lanes = Lanes::<S, 3>::new(simd, listed, origin);
        pivot(simd, tangent, &lanes, these, spheres, origin);
    } else {
        let lanes = Lanes::<S, { FEW / LANES }>::new(simd, listed, origin);
        pivot(simd, tangent, &lanes, these, spheres, origin);
    }
}

/// Widens a box by eight spheres.
#[inline(always)]
fn widen<S: Simd>(low: &mut [f64x8<S>; 3], high: &mut [f64x8<S>; 3], [x, y, z, r]: &[f64x8<S>; 4]) {
    for ((low, high), c) in low.iter_mut().zip(high).zip([x, y, z]) {
        *low = low.min(*c - *r);
        *high = high.max(*c + *r);
    }
}

/// Which sphere of a block sticks out farthest of the one around `center`, and its [`measure`].
#[inline(always)]
fn farthest<S: Simd>(
    simd: S,
    block: &[Sphere],
    origin: DVec3,
    center: [f64; 3],
    radius: f64,
) -> (usize, f64) {
    let mut most = f64x8::splat(simd, f64::NEG_INFINITY);
    let mut lane = u64x8::simd_from(simd, [0, 1, 2, 3, 4, 5, 6, 7]);
    let (eights, rest) = block.as_chunks::<LANES>();
    for eight in eights {
        let measure = measure(simd, &columns(simd, eight.each_ref(), origin), center, radius);
        // An infinite measure with a mark would be no number.
        most = most.max(marked(measure.min(f64x8::splat(simd, f64::MAX)), lane));
        lane += LANES as u64;
    }
    if let Some(first) = rest.first() {
        let eight = std::array::from_fn(|i| rest.get(i).unwrap_or(first));
        let measure = measure(simd, &columns(simd, eight, origin), center, radius);
        most = most.max(marked(measure.min(f64x8::splat(simd, f64::MAX)), lane));
    }
    let most = most.reduce_max();
    // A lane beyond the end stands for the first of its eight.
    let at = (most.to_bits() & 63) as usize;
    (if at < block.len() { at } else { at / LANES * LANES }, most)
}
