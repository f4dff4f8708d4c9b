//! Cuts of long ranges, between bins.

use std::cmp::Ordering;

use fearless_simd::{Level, Simd, f32x8, prelude::*, u32x8};
use glam::Vec4;

use super::item::{Bounds, Extent, Item};
use crate::bvh::node::WIDTH;
use crate::simd::dispatch;

const BINS: usize = 32;

#[expect(clippy::cast_precision_loss, reason = "a weight of an estimate")]
pub(super) fn count(n: usize) -> f32 {
    n as f32
}

#[derive(Clone, Copy)]
struct Bin {
    bounds: Bounds,
    count: usize,
}

type Bins = [[Bin; BINS]; 3];

/// What makes `steps` of each side of `spread`.
pub(super) fn scale(spread: Vec4, steps: f32) -> Vec4 {
    Vec4::from_array(spread.to_array().map(|s| {
        // A spread so small that the quotient overflows counts as none.
        let scale = steps / s;
        if scale.is_finite() { scale } else { 0.0 }
    }))
}

/// Which bin a middle falls into along each axis.
#[derive(Clone, Copy)]
struct Binning {
    low: Vec4,
    scale: Vec4,
}

impl Binning {
    fn new(middles: &Bounds, spread: Vec4) -> Self {
        let scale = scale(spread, BINS as f32 - 1.0);
        Self { low: middles.low, scale }
    }

    /// The bins of the three axes. Adding 2^23 rounds to an integer and leaves it in the low bits.
    #[inline(always)]
    fn bins(&self, item: &Item) -> [usize; 3] {
        let place = (item.middle() - self.low) * self.scale + 8_388_608.0;
        [place.x, place.y, place.z].map(|p| p.to_bits() as usize % BINS)
    }

    /// The bin of one axis.
    #[inline(always)]
    fn bin(&self, item: &Item, axis: usize) -> usize {
        let middle = item.low[axis] + item.high[axis];
        ((middle - self.low[axis]) * self.scale[axis] + 8_388_608.0).to_bits() as usize % BINS
    }
}

fn fill_bins(items: &[Item], binning: Binning) -> Box<Bins> {
    if items.len() > 1 << 16 {
        let (left, right) = items.split_at(items.len() / 2);
        let (mut a, b) = rayon::join(|| fill_bins(left, binning), || fill_bins(right, binning));
        for (a, b) in a.iter_mut().flatten().zip(b.iter().flatten()) {
            a.bounds.merge(&b.bounds);
            a.count += b.count;
        }
        return a;
    }
    dispatch!(Level::new(), simd => fill(simd, items, binning))
}

/// The four quarters go side by side: neighbours often share a bin, and an update depends on the one before.
#[inline(always)]
fn fill<S: Simd>(simd: S, items: &[Item], binning: Binning) -> Box<Bins> {
    let empty = f32x8::splat(simd, f32::INFINITY);
    // The least low and negated high corners.
    let mut corners = [[empty; BINS]; 3];
    let mut counts = [[0; BINS]; 3];
    let quarter = items.len() / 4;
    for i in 0..quarter {
        add_to_bins(simd, &mut corners, &mut counts, &items[i], binning);
        add_to_bins(simd, &mut corners, &mut counts, &items[quarter + i], binning);
        add_to_bins(simd, &mut corners, &mut counts, &items[2 * quarter + i], binning);
        add_to_bins(simd, &mut corners, &mut counts, &items[3 * quarter + i], binning);
    }
    for item in &items[4 * quarter..] {
        add_to_bins(simd, &mut corners, &mut counts, item, binning);
    }
    let mut bins = Box::new([[Bin { bounds: Bounds::EMPTY, count: 0 }; BINS]; 3]);
    for axis in 0..3 {
        for place in 0..BINS {
            let [a, b, c, d, e, f, g, h] = corners[axis][place].into();
            let bounds = Bounds { low: Vec4::new(a, b, c, d), high: -Vec4::new(e, f, g, h) };
            bins[axis][place] = Bin { bounds, count: counts[axis][place] };
        }
    }
    bins
}

#[inline(always)]
fn add_to_bins<S: Simd>(
    simd: S,
    corners: &mut [[f32x8<S>; BINS]; 3],
    counts: &mut [[usize; BINS]; 3],
    item: &Item,
    binning: Binning,
) {
    let [x, y, z] = binning.bins(item);
    let ([a, b, c, d], [e, f, g, h]) = (item.low.to_array(), item.high.to_array());
    let both: u32x8<S> = f32x8::simd_from(simd, [a, b, c, d, e, f, g, h]).bitcast();
    let signs: u32x8<S> = f32x8::simd_from(simd, [0.0, 0.0, 0.0, 0.0, -0.0, -0.0, -0.0, -0.0]).bitcast();
    let both: f32x8<S> = (both ^ signs).bitcast();
    // `min(new, old)`: in this order a NaN in an unused lane stays out of the others' way.
    corners[0][x] = both.min(corners[0][x]);
    corners[1][y] = both.min(corners[1][y]);
    corners[2][z] = both.min(corners[2][z]);
    counts[0][x] += 1;
    counts[1][y] += 1;
    counts[2][z] += 1;
}

/// A cut between two bins.
pub(in crate::bvh) struct BinCut {
    binning: Binning,
    axis: usize,
    /// The first bin of the second side.
    bin: usize,
    /// Items before it; 0 if the middles cannot be told apart.
    before: usize,
}

impl BinCut {
    /// The cut of the least cost.
    pub(in crate::bvh) fn new(items: &[Item], extent: &Extent) -> Self {
        let n = items.len();
        let binning = Binning::new(&extent.middles, extent.middles.high - extent.middles.low);
        let bins = fill_bins(items, binning);
        let (mut least, mut best) = (f32::INFINITY, Self { binning, axis: 0, bin: 0, before: 0 });
        for (axis, bins) in bins.iter().enumerate() {
            let mut tails = [0.0; BINS];
            let (mut tail, mut behind) = (Bounds::EMPTY, 0);
            for k in (1..BINS).rev() {
                tail.merge(&bins[k].bounds);
                behind += bins[k].count;
                tails[k] = tail.half_area() * count(behind.div_ceil(WIDTH));
            }
            let (mut head, mut before) = (Bounds::EMPTY, 0);
            for bin in 1..BINS {
                head.merge(&bins[bin - 1].bounds);
                before += bins[bin - 1].count;
                let cost = head.half_area() * count(before.div_ceil(WIDTH)) + tails[bin];
                if before > 0 && before < n && cost < least {
                    (least, best) = (cost, Self { binning, axis, bin, before });
                }
            }
        }
        best
    }

    /// Puts the items of the first side before the others; `None` if there are no two sides.
    pub(in crate::bvh) fn part<'a>(&self, items: &'a mut [Item]) -> Option<(&'a mut [Item], &'a mut [Item])> {
        partition(items, |item| self.binning.bin(item, self.axis) < self.bin);
        (self.before > 0).then(|| items.split_at_mut(self.before))
    }
}

/// Cuts between two bins, and moves at most eight items across so that the sides are multiples of [`WIDTH`].
pub(super) fn binned_cut(items: &mut [Item], extent: &Extent) -> usize {
    let n = items.len();
    let cut = BinCut::new(items, extent);
    let BinCut { axis, before, .. } = cut;
    // The nearest multiple that leaves something on both sides.
    let first = ((before + WIDTH / 2) / WIDTH).clamp(1, n.div_ceil(WIDTH) - 1) * WIDTH;
    if before == 0 {
        // All middles coincide (or cannot be told apart): any halves will do.
        return n.div_ceil(WIDTH) / 2 * WIDTH;
    }
    cut.part(items);
    let key = |item: &Item| item.middle()[axis];
    if first < before {
        // The last ones of the first side move over.
        move_to_border(&mut items[..before], before - first, |a, b| key(a).total_cmp(&key(b)));
    } else if first > before {
        let side = &mut items[before..];
        side.reverse();
        move_to_border(side, first - before, |a, b| key(b).total_cmp(&key(a)));
        side.reverse();
    }
    first
}

/// Puts the items for which `first` holds before the others, without a branch that cannot be predicted (N. Lomuto's
/// way).
#[inline(always)]
pub(super) fn partition(items: &mut [Item], first: impl Fn(&Item) -> bool) {
    let mut border = 0;
    for i in 0..items.len() {
        let one_more = usize::from(first(&items[i]));
        items.swap(i, border);
        border += one_more;
    }
}

/// Puts the `many` greatest items last.
fn move_to_border(items: &mut [Item], many: usize, order: impl Fn(&Item, &Item) -> Ordering) {
    let at = items.len() - many;
    items.select_nth_unstable_by(at, order);
}
