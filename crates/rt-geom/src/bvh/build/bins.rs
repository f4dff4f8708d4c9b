//! Cuts of long ranges: between two of thirty-two bins along an axis, where the estimated cost is least.

use std::cmp::Ordering;

use fearless_simd::{Level, Simd, f32x4, f32x8, prelude::*};

use super::item::{Extent, Item, bounds_of, half_area, middle, nothing};
use crate::bvh::node::WIDTH;
use crate::simd::dispatch;

const BINS: usize = 32;
/// Of longer ranges a sample is binned.
const LONG: usize = 1 << 15;
/// Items of a sample that follow each other.
const RUN: usize = 16;
/// Longer ranges are binned in parallel.
const PARALLEL: usize = 1 << 16;

#[expect(clippy::cast_precision_loss, reason = "a weight of an estimate")]
pub(super) fn count(n: usize) -> f32 {
    n as f32
}

/// What makes `steps` of a spread.
pub(super) fn scale(spread: f32, steps: f32) -> f32 {
    // A spread so small that the quotient overflows counts as none.
    let scale = steps / spread;
    if scale.is_finite() { scale } else { 0.0 }
}

/// The corners of a box, as an item has them.
#[derive(Clone, Copy)]
#[repr(C, align(32))]
struct Corners([f32; 8]);

/// The boxes around the items of each bin along each axis, and how many these are.
struct Bins {
    corners: [[Corners; BINS]; 3],
    counts: [[u32; BINS]; 3],
}

impl Bins {
    const EMPTY: Self = Self { corners: [[Corners([f32::INFINITY; 8]); BINS]; 3], counts: [[0; BINS]; 3] };

    /// Puts items into bins that are empty.
    fn fill(&mut self, items: &[Item], binning: Binning) {
        if items.len() <= PARALLEL {
            return dispatch!(Level::new(), simd => self.fill_all(simd, items, binning));
        }
        let (left, right) = items.split_at(items.len() / 2);
        let mut others = Box::new(Self::EMPTY);
        rayon::join(|| self.fill(left, binning), || others.fill(right, binning));
        dispatch!(Level::new(), simd => self.merge(simd, &others));
    }

    /// The four quarters go side by side: neighbours often share a bin, and an update depends on the one before.
    #[inline(always)]
    fn fill_all<S: Simd>(&mut self, simd: S, items: &[Item], binning: Binning) {
        let quarter = items.len() / 4;
        let (a, rest) = items.split_at(quarter);
        let (b, rest) = rest.split_at(quarter);
        let (c, rest) = rest.split_at(quarter);
        let (d, rest) = rest.split_at(quarter);
        for (((a, b), c), d) in a.iter().zip(b).zip(c).zip(d) {
            self.add(simd, a, binning);
            self.add(simd, b, binning);
            self.add(simd, c, binning);
            self.add(simd, d, binning);
        }
        for item in rest {
            self.add(simd, item, binning);
        }
    }

    #[inline(always)]
    fn add<S: Simd>(&mut self, simd: S, item: &Item, binning: Binning) {
        let corners = item.corners(simd);
        for (axis, bin) in binning.bins(simd, middle(corners)).into_iter().enumerate() {
            // One bin of all items would be slow: each update depends on the one before.
            if binning.scale[axis] == 0.0 {
                continue;
            }
            let Corners(all) = &mut self.corners[axis][bin];
            // `min(new, old)`: in this order a NaN in an unused lane stays out of the others' way.
            *all = corners.min(f32x8::simd_from(simd, *all)).into();
            self.counts[axis][bin] += 1;
        }
    }

    #[inline(always)]
    fn merge<S: Simd>(&mut self, simd: S, others: &Self) {
        for (all, other) in self.corners.as_flattened_mut().iter_mut().zip(others.corners.as_flattened()) {
            all.0 = f32x8::simd_from(simd, other.0).min(f32x8::simd_from(simd, all.0)).into();
        }
        for (all, other) in self.counts.as_flattened_mut().iter_mut().zip(others.counts.as_flattened()) {
            *all += other;
        }
    }

    /// The axis, and the first bin of the second side, where a cut costs least; `None` if there are no two sides.
    #[inline(always)]
    fn cheapest_cut<S: Simd>(&self, simd: S, binning: Binning) -> Option<(usize, usize)> {
        let (mut least, mut best) = (f32::INFINITY, None);
        for (axis, (corners, counts)) in self.corners.iter().zip(&self.counts).enumerate() {
            if binning.scale[axis] == 0.0 {
                continue;
            }
            let mut tails = [0.0; BINS];
            let (mut tail, mut behind) = (nothing(simd), 0);
            for bin in (1..BINS).rev() {
                tail = f32x8::simd_from(simd, corners[bin].0).min(tail);
                behind += counts[bin] as usize;
                tails[bin] = half_area(tail) * count(behind.div_ceil(WIDTH));
            }
            let (mut head, mut before) = (nothing(simd), 0);
            let n = behind + counts[0] as usize;
            for bin in 1..BINS {
                head = f32x8::simd_from(simd, corners[bin - 1].0).min(head);
                before += counts[bin - 1] as usize;
                let cost = half_area(head) * count(before.div_ceil(WIDTH)) + tails[bin];
                if before > 0 && before < n && cost < least {
                    (least, best) = (cost, Some((axis, bin)));
                }
            }
        }
        best
    }
}

/// Which bin a middle falls into along each axis.
#[derive(Clone, Copy)]
struct Binning {
    low: [f32; 4],
    scale: [f32; 4],
}

impl Binning {
    fn new(extent: &Extent) -> Self {
        let [x, y, z] = extent.spread().map(|spread| scale(spread, BINS as f32 - 1.0));
        let [a, b, c, ..] = extent.middles;
        Self { low: [a, b, c, 0.0], scale: [x, y, z, 0.0] }
    }

    /// The bins of the three axes. Adding 2^23 rounds to an integer and leaves it in the low bits.
    #[inline(always)]
    fn bins<S: Simd>(&self, simd: S, middle: f32x4<S>) -> [usize; 3] {
        let place = (middle - f32x4::simd_from(simd, self.low)) * f32x4::simd_from(simd, self.scale) + 8_388_608.0;
        let [x, y, z, _]: [f32; 4] = place.into();
        [x, y, z].map(|p| p.to_bits() as usize % BINS)
    }

    /// The bin of one axis.
    #[inline]
    fn bin(&self, item: &Item, axis: usize) -> usize {
        ((item.middle(axis) - self.low[axis]) * self.scale[axis] + 8_388_608.0).to_bits() as usize % BINS
    }
}

/// A cut between two bins.
pub(in crate::bvh) struct BinCut {
    binning: Binning,
    axis: usize,
    /// The first bin of the second side.
    bin: usize,
}

impl BinCut {
    /// The cut of the least cost; `None` if the middles cannot be told apart.
    pub(in crate::bvh) fn new(items: &[Item], extent: &Extent) -> Option<Self> {
        let binning = Binning::new(extent);
        let mut bins = Bins::EMPTY;
        bins.fill(items, binning);
        let (axis, bin) = dispatch!(Level::new(), simd => bins.cheapest_cut(simd, binning))?;
        Some(Self { binning, axis, bin })
    }

    /// The cut of the least cost for a sample, one item of four, unless that cannot be told apart.
    pub(in crate::bvh) fn of_sample(items: &[Item], extent: &Extent) -> Option<Self> {
        // (Runs of items that lie together in memory.)
        let runs = items.chunks(RUN).step_by(4);
        let mut sample = Vec::with_capacity(runs.len() * RUN);
        runs.for_each(|run| sample.extend_from_slice(run));
        Self::new(&sample, extent).or_else(|| Self::new(items, extent))
    }

    /// Puts the items of the first side before the others. Returns how many they are, and the bounds of both sides.
    pub(in crate::bvh) fn part(&self, items: &mut [Item]) -> (usize, [Extent; 2]) {
        part_with_bounds(items, |item| self.is_first(item))
    }

    #[inline]
    fn is_first(&self, item: &Item) -> bool {
        self.binning.bin(item, self.axis) < self.bin
    }
}

/// Cuts between two bins, and moves at most eight items across so that the sides are multiples of [`WIDTH`]. Returns how
/// many items the first side has, and bounds of both, which for long ranges may be a little larger than needed.
pub(super) fn binned_cut(items: &mut [Item], extent: &Extent) -> (usize, [Extent; 2]) {
    let leaves = items.len().div_ceil(WIDTH);
    let long = items.len() > LONG;
    let cut = if long { BinCut::of_sample(items, extent) } else { BinCut::new(items, extent) };
    let Some(cut) = cut else {
        // All middles coincide (or cannot be told apart): any halves will do.
        let first = leaves / 2 * WIDTH;
        return (first, bounds_of_sides(items, first));
    };
    let known = long.then(|| cut.part(items));
    let before = known.map_or_else(|| partition(items, |item| cut.is_first(item)), |(before, _)| before);
    // The nearest multiple that leaves something on both sides.
    let first = ((before + WIDTH / 2) / WIDTH).clamp(1, leaves - 1) * WIDTH;
    let (head, tail) = items.split_at_mut(before);
    let key = |item: &Item| item.middle(cut.axis);
    if first < before {
        // The last ones of the first side move over.
        move_to_border(head, before - first, |a, b| key(a).total_cmp(&key(b)));
    } else if first > before {
        tail.reverse();
        move_to_border(tail, first - before, |a, b| key(b).total_cmp(&key(a)));
        tail.reverse();
    }
    let Some((_, [head, tail])) = known else { return (first, bounds_of_sides(items, first)) };
    let moved = bounds_of(&items[first.min(before)..first.max(before)]);
    (first, if first < before { [head, tail.merge(&moved)] } else { [head.merge(&moved), tail] })
}

fn bounds_of_sides(items: &[Item], first: usize) -> [Extent; 2] {
    let (head, tail) = items.split_at(first);
    [bounds_of(head), bounds_of(tail)]
}

/// Puts the items for which `first` holds before the others, without a branch that cannot be predicted (N. Lomuto's
/// way), and returns how many they are.
pub(in crate::bvh) fn partition(items: &mut [Item], first: impl Fn(&Item) -> bool) -> usize {
    dispatch!(Level::new(), _simd => {
        let mut border = 0;
        for i in 0..items.len() {
            let one_more = usize::from(first(&items[i]));
            items.swap(i, border);
            border += one_more;
        }
        border
    })
}

/// [`partition`], with the bounds of both sides: one pass over memory in place of two.
pub(in crate::bvh) fn part_with_bounds(items: &mut [Item], first: impl Fn(&Item) -> bool) -> (usize, [Extent; 2]) {
    dispatch!(Level::new(), simd => {
        let mut sides = [(nothing(simd), nothing(simd)); 2];
        let mut border = 0;
        for i in 0..items.len() {
            let item = items[i];
            let is_first = first(&item);
            items.swap(i, border);
            border += usize::from(is_first);
            let corners = item.corners(simd);
            let middle = middle(corners);
            let middles = middle.combine(-middle);
            let (here, there) = if is_first { (0.0, f32::INFINITY) } else { (f32::INFINITY, 0.0) };
            for ((all, all_middles), add) in sides.iter_mut().zip([here, there]) {
                *all = (corners + add).min(*all);
                *all_middles = (middles + add).min(*all_middles);
            }
        }
        (border, sides.map(|(items, middles)| Extent { items: items.into(), middles: middles.into() }))
    })
}

/// Puts the `many` greatest items last.
fn move_to_border(items: &mut [Item], many: usize, order: impl Fn(&Item, &Item) -> Ordering) {
    let at = items.len() - many;
    items.select_nth_unstable_by(at, order);
}

#[cfg(test)]
mod tests {
    use oracle::Random;

    use super::*;
    use crate::bvh::build::item::items_at_random;

    #[test]
    fn a_cut_parts_the_items_and_knows_the_bounds_of_both_sides() {
        let random = &mut Random::new(11);
        for n in [2, 3, 17, 1_000, 3 * LONG] {
            let mut items = items_at_random(n, random);
            let cut = BinCut::of_sample(&items, &bounds_of(&items)).expect("they differ");
            let mut same = items.clone();
            let (before, sides) = cut.part(&mut items);
            assert!(before > 0 && before < n);
            assert_eq!(partition(&mut same, |item| cut.is_first(item)), before);
            let numbers =
                |extent: &Extent| [extent.items, extent.middles].map(|[x, y, z, _, a, b, c, _]| [x, y, z, a, b, c]);
            for (side, exact) in sides.iter().zip(&bounds_of_sides(&same, before)) {
                assert_eq!(numbers(side), numbers(exact), "{n}");
            }
        }
    }

    #[test]
    fn sides_are_multiples_of_a_block_within_their_bounds() {
        let random = &mut Random::new(12);
        for n in [WIDTH + 1, 200, 1_000, LONG + 1, 2 * LONG + 77] {
            let mut items = items_at_random(n, random);
            let extent = bounds_of(&items);
            let (first, sides) = binned_cut(&mut items, &extent);
            assert!(first > 0 && first < n && first % WIDTH == 0, "{first} {n}");
            for (side, exact) in sides.into_iter().zip(bounds_of_sides(&items, first)) {
                let both = side.merge(&exact);
                assert_eq!([both.items[0], both.items[5]], [side.items[0], side.items[5]], "{n}");
                assert_eq!([both.middles[1], both.middles[6]], [side.middles[1], side.middles[6]], "{n}");
            }
        }
    }
}
