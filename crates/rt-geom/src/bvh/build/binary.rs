//! The binary tree, from the top down.

use std::cmp::Ordering;

use rayon::prelude::*;

use super::bins::{binned_cut, partition};
use super::item::{Extent, Item, bounds_of};
use super::rank;
use super::sweep::sorted_cut;
use crate::bvh::node::{Blocked, COORDINATE_ERROR, Frame, WIDTH};

/// The binary tree over the primitives of one kind in a frame, and these in the order of its leaves.
pub(in crate::bvh) struct Binary<'a, L> {
    pub(super) leaves: &'a [L],
    pub(in crate::bvh) items: Vec<Item>,
    pub(super) branches: Vec<Branch>,
}

impl<'a, L: Blocked> Binary<'a, L> {
    pub(in crate::bvh) fn new(leaves: &'a [L], frame: &Frame) -> Self {
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

/// A node of the binary tree, in preorder: its first side follows it, its second follows that. A side with `k` leaf
/// blocks has `2 k - 1` nodes, so both sides know where they lie before they are built.
#[derive(Clone, Copy, Debug)]
pub(super) struct Branch {
    pub(super) low: [f32; 3],
    pub(super) high: [f32; 3],
    /// Leaf blocks of the first side, with those of its twins; 0 for a leaf block.
    pub(super) first: u32,
}

impl Branch {
    const NONE: Self = Self { low: [0.0; 3], high: [0.0; 3], first: 0 };

    pub(super) fn half_area(&self) -> f32 {
        let [x, y, z]: [f32; 3] = std::array::from_fn(|axis| self.high[axis] - self.low[axis]);
        x * y + y * z + z * x
    }
}

/// Ranges longer than this are cut in parallel.
const PARALLEL: usize = 4096;
/// The binary tree is never deeper: where the best cuts would lead there, the range is halved.
pub(super) const MAX_DEPTH: u32 = 64;

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
    if items.len() <= rank::MOST { sorted_cut(items, extent, spread) } else { binned_cut(items, extent) }
}
