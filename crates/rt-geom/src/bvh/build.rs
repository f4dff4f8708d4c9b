//! Builds the tree: a binary tree by binned surface area, then collapsed to sixteen children a node.
//!
//! 1. Each primitive becomes a box in cull coordinates.
//! 2. Top down, a range of boxes is cut where the estimated cost is least: the surface of each side times the number
//!    of leaf blocks it fills (I. Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", 2007). Cuts
//!    lie at multiples of sixteen, so every leaf block but the last is full, and leaf block `k` holds exactly the
//!    primitives `16 k ..` of the leaf order: no index is stored for it. Long ranges are cut between bins, short ones
//!    after sorting.
//! 3. Where no cut can part the centers, of equal primitives only the one of the lowest index is kept: the others, its
//!    *twins*, come last in the range, and no node or leaf block has a bound for them.
//! 4. A node takes in the largest of its children until it has sixteen.
//!
//! The two sides of a cut are built in parallel. Where things lie depends on the counts alone, never on the order in
//! which threads finish, so the tree is the same for any number of threads.

use std::cmp::Ordering;
use std::ops::Range;

use fearless_simd::{Level, Simd, f32x8, prelude::*, u32x8};
use glam::Vec4;
use rayon::prelude::*;

use super::crown::Part;
use super::node::{Block, Blocked, COORDINATE_ERROR, Child, Frame, Kind, Node, Region, WIDTH};
use super::rank::{self, ascending};
use crate::leaf::Leaves;
use crate::simd::dispatch;
use crate::{Shape, Sphere, Triangle};

/// The tree while it grows, region after region.
#[derive(Default)]
pub(super) struct Trunk {
    pub(super) nodes: Vec<Node>,
    pub(super) regions: Vec<Region>,
    pub(super) spheres: Rows<Sphere>,
    pub(super) triangles: Rows<Triangle>,
    /// The primitives that no leaf block bounds, each after the equal one that stands for it.
    pub(super) twins: Vec<(u32, u32)>,
    /// How many pending entries a walk can need.
    pub(super) stack: usize,
}

/// The primitives of a kind at their places, with their leaf blocks.
pub(super) struct Rows<L: Blocked> {
    pub(super) leaves: Vec<L>,
    pub(super) blocks: Vec<L::Block>,
    /// The index of the primitive at each place.
    pub(super) index: Vec<u32>,
}

impl<L: Blocked> Default for Rows<L> {
    fn default() -> Self {
        Self { leaves: Vec::new(), blocks: Vec::new(), index: Vec::new() }
    }
}

/// The binary tree over the primitives of one kind in a frame, and these in the order of its leaves.
pub(super) struct Binary<'a, L> {
    leaves: &'a [L],
    pub(super) items: Vec<Item>,
    branches: Vec<Branch>,
}

impl<'a, L: Blocked> Binary<'a, L> {
    pub(super) fn new(leaves: &'a [L], frame: &Frame) -> Self {
        let number = |place: usize| u32::try_from(place).expect("fewer than 2^32 primitives");
        let item = |(place, leaf): (usize, &L)| {
            let (low, high) = leaf.extent(frame);
            Item::new(low, high, number(place))
        };
        let mut items: Vec<Item> = leaves.par_iter().enumerate().map(item).collect();
        let branches = binary_tree(&mut items, &|a, b| leaves[a as usize].order(&leaves[b as usize]));
        Self { leaves, items, branches }
    }
}

impl Trunk {
    /// Appends a region. `index` tells the index of a primitive from its number there, spheres first.
    pub(super) fn grow(
        &mut self,
        frame: Frame,
        (spheres, triangles): (Binary<Sphere>, Binary<Triangle>),
        index: impl Fn(u32) -> u32,
    ) -> Part {
        let first = u32::try_from(spheres.leaves.len()).expect("fewer than 2^32 primitives");
        let parts = [
            self.plant(spheres, &frame, |rows| &mut rows.spheres, &index),
            self.plant(triangles, &frame, |rows| &mut rows.triangles, |i| index(first + i)),
        ];
        let (root, stack) = match parts {
            // An empty scene has no region.
            [None, None] => return Part::Region(0),
            [Some((part, _)), None] | [None, Some((part, _))] => (part.child, part.stack),
            [Some(a), Some(b)] => {
                let mut join = Node::EMPTY;
                for (lane, (part, whole)) in [&a, &b].into_iter().enumerate() {
                    join.children[lane] = part.child;
                    join.boxes.set(lane, whole.low, whole.high);
                }
                self.nodes.push(join);
                (Child::new(Kind::Inner, self.nodes.len() - 1), a.0.stack.max(b.0.stack) + 2)
            }
        };
        self.stack = self.stack.max(stack);
        self.regions.push(Region { frame, root });
        Part::Region(u32::try_from(self.regions.len() - 1).expect("fewer regions than primitives"))
    }

    /// Appends a primitive that no region holds, and returns its place among those of its kind.
    pub(super) fn add(&mut self, shape: Shape, index: u32) -> usize {
        match shape {
            Shape::Sphere(sphere) => self.spheres.add(sphere, index),
            Shape::Triangle(triangle) => self.triangles.add(triangle, index),
        }
    }

    /// Appends the primitives of one kind in leaf order with their leaf blocks, and the tree above them.
    fn plant<L: Blocked>(
        &mut self,
        Binary { leaves, items, branches }: Binary<L>,
        frame: &Frame,
        rows: impl Fn(&mut Self) -> &mut Rows<L>,
        index: impl Fn(u32) -> u32,
    ) -> Option<(Collapsed, Branch)> {
        let &whole = branches.first()?;
        let block = rows(self).start_block();
        let part = collapse(&branches, (L::KIND, block), &mut self.nodes);
        drop(branches);
        self.twins.extend(items.iter().filter_map(|item| Some((index(item.twin_of()?), index(item.index())))));
        let rows = rows(self);
        let first = rows.leaves.len();
        rows.index.extend(items.iter().map(|item| index(item.index())));
        rows.leaves.par_extend(items.par_iter().map(|item| leaves[item.index() as usize]));
        let block = |(leaves, items): (&[L], &[Item])| {
            let mut block = L::Block::EMPTY;
            for (lane, (leaf, _)) in
                leaves.iter().zip(items).enumerate().filter(|(_, (_, item))| item.twin_of().is_none())
            {
                block.bound(lane, leaf, frame);
            }
            block
        };
        rows.blocks.par_extend(rows.leaves[first..].par_chunks(WIDTH).zip(items.par_chunks(WIDTH)).map(block));
        Some((part, whole))
    }
}

impl<L: Blocked> Rows<L> {
    fn add(&mut self, leaf: L, index: u32) -> usize {
        self.leaves.push(leaf);
        self.index.push(index);
        self.leaves.len() - 1
    }

    /// Fills the last block up with places where nothing is, and returns the number of the next.
    fn start_block(&mut self) -> usize {
        if let Some(&last) = self.leaves.last() {
            self.leaves.resize(self.leaves.len().next_multiple_of(WIDTH), last);
            self.index.resize(self.leaves.len(), Leaves::NOTHING);
        }
        self.blocks.len()
    }
}

/// A primitive's box. `low.w` carries the primitive's index as bits, `high.w` that of the primitive whose twin it is; no
/// arithmetic uses that lane's value.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item {
    low: Vec4,
    high: Vec4,
}

impl Item {
    const NO_TWIN: u32 = u32::MAX;

    fn new(low: [f32; 3], high: [f32; 3], index: u32) -> Self {
        let [x, y, z] = low;
        Self {
            low: Vec4::new(x, y, z, f32::from_bits(index)),
            high: Vec4::new(high[0], high[1], high[2], f32::from_bits(Self::NO_TWIN)),
        }
    }

    pub(super) fn index(&self) -> u32 {
        self.low.w.to_bits()
    }

    /// The lowest index of a primitive in the same part of the tree that is equal to this one, if it is not its own.
    pub(super) fn twin_of(&self) -> Option<u32> {
        let first = self.high.w.to_bits();
        (first != Self::NO_TWIN).then_some(first)
    }

    /// The same with another index.
    pub(super) fn with_index(mut self, index: u32) -> Self {
        self.low.w = f32::from_bits(index);
        self
    }

    /// The longest side.
    pub(super) fn size(&self) -> f32 {
        (self.high - self.low).truncate().max_element()
    }

    /// How far the centers are apart, along the axis where they are farthest.
    pub(super) fn distance(&self, other: &Self) -> f32 {
        0.5 * (self.middle() - other.middle()).truncate().abs().max_element()
    }

    /// Twice the center.
    #[inline(always)]
    fn middle(&self) -> Vec4 {
        self.low + self.high
    }
}

/// A box that grows.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    low: Vec4,
    high: Vec4,
}

impl Bounds {
    const EMPTY: Self = Self { low: Vec4::splat(f32::INFINITY), high: Vec4::splat(f32::NEG_INFINITY) };

    #[inline(always)]
    fn add(&mut self, low: Vec4, high: Vec4) {
        // `min(new, old)`: in this order a NaN in the unused lane stays out of the others' way.
        self.low = low.min(self.low);
        self.high = high.max(self.high);
    }

    #[inline(always)]
    fn merge(&mut self, other: &Self) {
        self.add(other.low, other.high);
    }

    /// Half the surface; 0 for nothing.
    #[inline(always)]
    fn half_area(&self) -> f32 {
        let side = (self.high - self.low).max(Vec4::ZERO);
        side.x * side.y + side.y * side.z + side.z * side.x
    }
}

/// A node of the binary tree, in preorder: its first side follows it, its second follows that. A side with `k` leaf
/// blocks has `2 k - 1` nodes, so both sides know where they lie before they are built.
#[derive(Clone, Copy, Debug)]
struct Branch {
    low: [f32; 3],
    high: [f32; 3],
    /// Leaf blocks of the first side, with those of its twins; 0 for a leaf block.
    first: u32,
}

impl Branch {
    const NONE: Self = Self { low: [0.0; 3], high: [0.0; 3], first: 0 };

    fn half_area(&self) -> f32 {
        let [x, y, z]: [f32; 3] = std::array::from_fn(|axis| self.high[axis] - self.low[axis]);
        x * y + y * z + z * x
    }
}

/// Ranges longer than this are cut in parallel.
const PARALLEL: usize = 4096;
/// Ranges up to this length are sorted; longer ones are binned.
const SORTED: usize = rank::MOST;
const BINS: usize = 32;
/// The binary tree is never deeper: where the best cuts would lead there, the range is halved.
const MAX_DEPTH: u32 = 64;

/// The spread of doubled centers up to which no cut parts them: boxes are wider by that alone.
#[expect(clippy::cast_possible_truncation, reason = "a power of two")]
const COINCIDENT: f32 = 2.0 * COORDINATE_ERROR as f32;

/// Sorts the items into leaf order and returns the binary tree over them.
fn binary_tree(items: &mut [Item], order: Order) -> Vec<Branch> {
    let leaves = items.len().div_ceil(WIDTH);
    let mut branches = vec![Branch::NONE; (2 * leaves).saturating_sub(1)];
    if leaves > 0 {
        let bounds = bounds_of(items);
        grow(items, &mut branches, &bounds, 0, false, order);
    }
    branches
}

/// How the primitives with two indices compare: as equal only if every ray gets the same answer from both.
type Order<'a> = &'a (dyn Fn(u32, u32) -> Ordering + Sync);

/// Bounds of the items and of their middles.
#[derive(Clone, Copy)]
pub(super) struct Extent {
    items: Bounds,
    middles: Bounds,
}

impl Extent {
    /// The longest side of the items' bounds.
    pub(super) fn size(&self) -> f32 {
        (self.items.high - self.items.low).truncate().max_element()
    }
}

pub(super) fn bounds_of(items: &[Item]) -> Extent {
    let mut extent = Extent { items: Bounds::EMPTY, middles: Bounds::EMPTY };
    for item in items {
        extent.items.add(item.low, item.high);
        let middle = item.middle();
        extent.middles.add(middle, middle);
    }
    extent
}

/// `distinct` tells that no two items are known to be equal.
fn grow(items: &mut [Item], branches: &mut [Branch], extent: &Extent, depth: u32, distinct: bool, order: Order) {
    branches[0] =
        Branch { low: extent.items.low.truncate().to_array(), high: extent.items.high.truncate().to_array(), first: 0 };
    let spread = extent.middles.high - extent.middles.low;
    let coincide = items.len() > 1 && spread.truncate().max_element() <= COINCIDENT;
    let kept = if coincide && !distinct { part_twins(items, order) } else { items.len() };
    let (items, distinct) = (&mut items[..kept], coincide);
    let leaves = items.len().div_ceil(WIDTH);
    if leaves == 1 {
        return;
    }
    let first = cut(items, extent, depth);
    branches[0].first = u32::try_from(first / WIDTH).expect("an index fits in 32 bits");
    let (left, right) = items.split_at_mut(first);
    let (left_branches, right_branches) = branches[1..].split_at_mut(2 * (first / WIDTH) - 1);
    let side = |items: &mut [Item], branches: &mut [Branch]| {
        let extent = bounds_of(items);
        grow(items, branches, &extent, depth + 1, distinct, order);
    };
    if leaves * WIDTH > PARALLEL {
        rayon::join(|| side(left, left_branches), || side(right, right_branches));
    } else {
        side(left, left_branches);
        side(right, right_branches);
    }
}

/// Of equal primitives marks all as twins but the one of the lowest index, puts them last, and returns how many are
/// left.
#[cold]
fn part_twins(items: &mut [Item], order: Order) -> usize {
    let compare = |a: &Item, b: &Item| order(a.index(), b.index());
    items.par_sort_unstable_by(|a, b| compare(a, b).then(a.index().cmp(&b.index())));
    let mut twins = 0;
    let mut first = items[0].index();
    for i in 1..items.len() {
        if compare(&items[i - 1], &items[i]).is_eq() {
            items[i].high.w = f32::from_bits(first);
            twins += 1;
        } else {
            first = items[i].index();
        }
    }
    partition(items, |item| item.twin_of().is_none());
    items.len() - twins
}

/// Reorders the items and returns how many belong to the first side: a multiple of [`WIDTH`], and neither side empty.
fn cut(items: &mut [Item], extent: &Extent, depth: u32) -> usize {
    let leaves = items.len().div_ceil(WIDTH);
    let spread = extent.middles.high - extent.middles.low;
    let halvings = usize::BITS - (leaves - 1).leading_zeros();
    if depth + halvings + 1 >= MAX_DEPTH {
        let axis = spread.truncate().max_position();
        let first = leaves / 2 * WIDTH;
        items.select_nth_unstable_by(first, |a, b| a.middle()[axis].total_cmp(&b.middle()[axis]));
        return first;
    }
    if items.len() <= SORTED { sorted_cut(items, extent, spread) } else { binned_cut(items, extent) }
}

/// Tries every cut at a multiple of [`WIDTH`] along each axis.
fn sorted_cut(items: &mut [Item], extent: &Extent, spread: Vec4) -> usize {
    let n = items.len();
    let leaves = n.div_ceil(WIDTH);
    // How far along each middle lies, in 23 bits, and its place in 7. Adding 2^23 rounds to an integer in the low bits.
    let scale = scale(spread, 8_388_606.0);
    let mut keys = [[0; SORTED]; 3];
    for (place, item) in (0..).zip(&*items) {
        let along = (item.middle() - extent.middles.low) * scale + 8_388_608.0;
        for (keys, along) in keys.iter_mut().zip(along.truncate().to_array()) {
            keys[place as usize] = along.to_bits() << 9 >> 2 | place;
        }
    }
    let orders = keys.map(|keys| ascending(&keys[..n]));
    let mut best = (f32::INFINITY, 0, WIDTH);
    for (axis, order) in orders.iter().enumerate() {
        let order = &order[..n];
        let block = |range: Range<usize>| {
            let mut bounds = Bounds::EMPTY;
            for &place in &order[range] {
                let item = &items[usize::from(place)];
                bounds.add(item.low, item.high);
            }
            bounds
        };
        let mut blocks = [Bounds::EMPTY; SORTED / WIDTH];
        for (k, bounds) in blocks[..leaves].iter_mut().enumerate() {
            *bounds = block(k * WIDTH..n.min((k + 1) * WIDTH));
        }
        let mut tails = blocks;
        for k in (0..leaves - 1).rev() {
            let next = tails[k + 1];
            tails[k].merge(&next);
        }
        let mut head = Bounds::EMPTY;
        for k in 1..leaves {
            head.merge(&blocks[k - 1]);
            let cost = head.half_area() * count(k) + tails[k].half_area() * count(leaves - k);
            if cost < best.0 {
                best = (cost, axis, k * WIDTH);
            }
        }
    }
    let (_, axis, first) = best;
    let mut sorted = [Item { low: Vec4::ZERO, high: Vec4::ZERO }; SORTED];
    for (item, &place) in sorted.iter_mut().zip(&orders[axis][..n]) {
        *item = items[usize::from(place)];
    }
    items.copy_from_slice(&sorted[..n]);
    first
}

#[expect(clippy::cast_precision_loss, reason = "a weight of an estimate")]
fn count(n: usize) -> f32 {
    n as f32
}

#[derive(Clone, Copy)]
struct Bin {
    bounds: Bounds,
    count: usize,
}

type Bins = [[Bin; BINS]; 3];

/// What makes `steps` of each side of `spread`.
fn scale(spread: Vec4, steps: f32) -> Vec4 {
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
pub(super) struct BinCut {
    binning: Binning,
    axis: usize,
    /// The first bin of the second side.
    bin: usize,
    /// Items before it; 0 if the middles cannot be told apart.
    before: usize,
}

impl BinCut {
    /// The cut of the least cost.
    pub(super) fn new(items: &[Item], extent: &Extent) -> Self {
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
    pub(super) fn part<'a>(&self, items: &'a mut [Item]) -> Option<(&'a mut [Item], &'a mut [Item])> {
        partition(items, |item| self.binning.bin(item, self.axis) < self.bin);
        (self.before > 0).then(|| items.split_at_mut(self.before))
    }
}

/// Cuts between two bins, and moves at most eight items across so that the sides are multiples of [`WIDTH`].
fn binned_cut(items: &mut [Item], extent: &Extent) -> usize {
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
fn partition(items: &mut [Item], first: impl Fn(&Item) -> bool) {
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

/// A part of the collapsed tree.
#[derive(Clone, Copy, Debug)]
struct Collapsed {
    child: Child,
    /// How many entries a walk can need to keep for later.
    stack: usize,
}

/// Turns the binary tree into nodes of up to sixteen children each, above leaf blocks of the given kind from the given
/// one on, and appends them, parents first.
///
/// Of all ways to do so it takes the one with the least sum of the nodes' surfaces, which is the number of nodes that
/// a random ray is expected to visit.
fn collapse(branches: &[Branch], (kind, block): (Kind, usize), nodes: &mut Vec<Node>) -> Collapsed {
    Collapse { branches, costs: costs(branches), kind, nodes }.part(0, block)
}

/// For each branch and `j` the least cost of what is below it as at most `j + 1` children of one node.
fn costs(branches: &[Branch]) -> Vec<[f32; WIDTH]> {
    let mut costs = vec![[0.0; WIDTH]; branches.len()];
    for (at, branch) in branches.iter().enumerate().rev() {
        if branch.first > 0 {
            let (left, right) = (costs[at + 1], costs[at + 2 * branch.first as usize]);
            let cost = &mut costs[at];
            for j in 1..WIDTH {
                cost[j] = shares(&left, &right, j).map(|(_, cost)| cost).fold(f32::INFINITY, f32::min);
            }
            cost[0] = branch.half_area() + cost[WIDTH - 1];
            for j in 1..WIDTH {
                cost[j] = cost[j].min(cost[j - 1]);
            }
        }
    }
    costs
}

/// The ways to share `j + 1` places between two sides: how many less one go to the first, and the cost.
fn shares(left: &[f32; WIDTH], right: &[f32; WIDTH], j: usize) -> impl Iterator<Item = (usize, f32)> {
    left[..j].iter().zip(right[..j].iter().rev()).map(|(a, b)| a + b).enumerate()
}

struct Collapse<'a> {
    branches: &'a [Branch],
    costs: Vec<[f32; WIDTH]>,
    kind: Kind,
    nodes: &'a mut Vec<Node>,
}

impl Collapse<'_> {
    /// The part below the branch `at`, whose first leaf block is `leaf`. The recursion is no deeper than the binary
    /// tree, so [`MAX_DEPTH`] bounds it.
    fn part(&mut self, at: usize, leaf: usize) -> Collapsed {
        if self.branches[at].first == 0 {
            return Collapsed { child: Child::new(self.kind, leaf), stack: 0 };
        }
        let mut parts = Vec::with_capacity(WIDTH);
        self.share(at, leaf, WIDTH - 1, &mut parts);
        let index = self.nodes.len();
        self.nodes.push(Node::EMPTY);
        let mut stack = 0;
        for (lane, &(at, leaf)) in parts.iter().enumerate() {
            let part = self.part(at, leaf);
            let Branch { low, high, .. } = self.branches[at];
            self.nodes[index].children[lane] = part.child;
            self.nodes[index].boxes.set(lane, low, high);
            stack = stack.max(part.stack);
        }
        // All are stacked for a moment when four or more are met.
        Collapsed { child: Child::new(Kind::Inner, index), stack: stack + parts.len() }
    }

    /// Collects the children that make up the branch `at` at the least cost, sharing `j + 1` places between its sides.
    fn share(&self, at: usize, leaf: usize, j: usize, parts: &mut Vec<(usize, usize)>) {
        let first = self.branches[at].first as usize;
        let (left, right) = (at + 1, at + 2 * first);
        let cheapest = shares(&self.costs[left], &self.costs[right], j).min_by(|a, b| a.1.total_cmp(&b.1));
        let (k, _) = cheapest.expect("two places or more");
        self.fill(left, leaf, k, parts);
        self.fill(right, leaf + first, j - 1 - k, parts);
    }

    /// Collects the branch `at` as at most `j + 1` children.
    fn fill(&self, at: usize, leaf: usize, mut j: usize, parts: &mut Vec<(usize, usize)>) {
        let cost = &self.costs[at];
        while j > 0 && cost[j - 1] <= cost[j] {
            j -= 1;
        }
        if j == 0 { parts.push((at, leaf)) } else { self.share(at, leaf, j, parts) }
    }
}

#[cfg(test)]
mod tests {
    use oracle::Random;

    use super::*;

    /// A random binary tree over some leaf blocks, in preorder.
    fn branches(leaves: u32, random: &mut Random, all: &mut Vec<Branch>) {
        let at = all.len();
        all.push(Branch { low: [0.0; 3], high: [0; 3].map(|_| random.below(100) as f32), first: 0 });
        if leaves > 1 {
            let first = 1 + u32::try_from(random.below(leaves as usize - 1)).unwrap();
            all[at].first = first;
            branches(first, random, all);
            branches(leaves - first, random, all);
        }
    }

    /// The least sum of surfaces of the nodes below a branch, itself included: all ways to choose at most sixteen
    /// children.
    fn least(branches: &[Branch], at: usize) -> f32 {
        if branches[at].first == 0 {
            return 0.0;
        }
        let cheapest = ways(branches, at, false).into_iter().filter(|(children, _)| *children <= WIDTH);
        branches[at].half_area() + cheapest.map(|(_, cost)| cost).fold(f32::INFINITY, f32::min)
    }

    /// Every way to cover a branch by branches below it, or by itself: how many, and their least cost.
    fn ways(branches: &[Branch], at: usize, itself: bool) -> Vec<(usize, f32)> {
        let mut ways = if itself { vec![(1, least(branches, at))] } else { Vec::new() };
        if branches[at].first > 0 {
            let right = at + 2 * branches[at].first as usize;
            for (a, x) in self::ways(branches, at + 1, true) {
                ways.extend(self::ways(branches, right, true).into_iter().map(|(b, y)| (a + b, x + y)));
            }
        }
        ways
    }

    #[test]
    fn the_collapse_is_the_cheapest_of_all() {
        let random = &mut Random::new(8);
        for leaves in [2, 5, 16, 17, 17, 18, 18, 19, 20] {
            let mut binary = Vec::new();
            branches(leaves, random, &mut binary);
            let mut nodes = Vec::new();
            let root = collapse(&binary, (Kind::Spheres, 0), &mut nodes);
            assert_eq!(root.child.kind(), Kind::Inner);
            // The surface of the root, and of the box of every child that is a node.
            let inner = |node: &Node| {
                let children = node.children.iter().enumerate().filter(|(_, child)| child.kind() == Kind::Inner);
                let used = children.filter(|(lane, _)| node.boxes.0[0].0[*lane] < f32::INFINITY);
                used.map(|(lane, _)| {
                    let high: [f32; 3] = std::array::from_fn(|axis| node.boxes.0[axis + 3].0[lane]);
                    Branch { low: [0.0; 3], high, first: 1 }.half_area()
                })
                .sum::<f32>()
            };
            let cost = binary[0].half_area() + nodes.iter().map(inner).sum::<f32>();
            // (Whole numbers: sums are exact.)
            assert_eq!(cost, least(&binary, 0), "{leaves} {binary:?}");
            assert!(leaves > 16 || nodes.len() == 1);
        }
    }
}
