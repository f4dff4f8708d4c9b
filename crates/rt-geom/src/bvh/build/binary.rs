//! The binary tree, from the top down.

use std::cmp::Ordering;

use fearless_simd::Level;
use glam::Vec3;
use rayon::prelude::*;

use super::bins::{binned_cut, partition};
use super::branch::{Branch, COINCIDENT};
use super::item::{Extent, Item, bounds_of};
use super::rank;
use super::sweep::sweep;
use crate::bvh::node::{Blocked, Frame, WIDTH};
use crate::simd::dispatch;

/// The binary tree over the primitives of one kind in a frame, and these in the order of its leaves.
pub(in crate::bvh) struct Binary<'a, L> {
    pub(super) leaves: &'a [L],
    pub(in crate::bvh) items: Vec<Item>,
    pub(super) branches: Vec<Branch>,
}

/// The boxes of primitives in a frame.
pub(in crate::bvh) fn items_of<L: Blocked>(leaves: &[L], frame: &Frame) -> Vec<Item> {
    let level = Level::new();
    let item = |(place, leaf): (usize, &L)| {
        let corners = dispatch!(level, simd => leaf.corners(simd, frame));
        Item::new(corners, u32::try_from(place).expect("fewer than 2^32 primitives"))
    };
    leaves.par_iter().enumerate().map(item).collect()
}

impl<'a, L: Blocked> Binary<'a, L> {
    pub(in crate::bvh) fn new(leaves: &'a [L], mut items: Vec<Item>) -> Self {
        let branches = binary_tree(&mut items, &|a, b| leaves[a as usize].order(&leaves[b as usize]));
        Self { leaves, items, branches }
    }
}

/// Ranges longer than this are cut in parallel.
const PARALLEL: usize = 4096;
/// The binary tree is never deeper: where the best cuts would lead there, the range is halved.
pub(super) const MAX_DEPTH: u32 = 64;

/// How deep the tree over a range that is sorted can be.
#[expect(clippy::cast_possible_truncation, reason = "a small number")]
const MOST_BELOW: u32 = (rank::MOST / WIDTH) as u32;

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
    branches[0] = Branch::around(extent.items);
    let coincide = items.len() > 1 && extent.spread().into_iter().all(|spread| spread <= COINCIDENT);
    let kept = if coincide && !distinct { part_twins(items, order) } else { items.len() };
    let (items, distinct) = (&mut items[..kept], coincide);
    let leaves = items.len().div_ceil(WIDTH);
    if leaves == 1 {
        return;
    }
    if items.len() <= rank::MOST && depth + MOST_BELOW < MAX_DEPTH {
        for stretch in sweep(items, branches, extent, distinct) {
            let items = &mut items[stretch.places(kept)];
            let extent = bounds_of(items);
            grow(items, &mut branches[stretch.at..], &extent, depth + MOST_BELOW, false, order);
        }
        return;
    }
    let (first, [left_extent, right_extent]) = cut(items, extent, depth);
    branches[0].first = u32::try_from(first / WIDTH).expect("an index fits in 32 bits");
    let (left, right) = items.split_at_mut(first);
    let (left_branches, right_branches) = branches[1..].split_at_mut(2 * (first / WIDTH) - 1);
    let side = |items: &mut [Item], branches: &mut [Branch], extent: &Extent| {
        grow(items, branches, extent, depth + 1, distinct, order);
    };
    if leaves * WIDTH > PARALLEL {
        rayon::join(|| side(left, left_branches, &left_extent), || side(right, right_branches, &right_extent));
    } else {
        side(left, left_branches, &left_extent);
        side(right, right_branches, &right_extent);
    }
}

/// Of equal primitives marks all as twins but the one of the lowest index, puts them last, and returns how many are
/// left.
#[cold]
fn part_twins(items: &mut [Item], order: Order) -> usize {
    let compare = |a: &Item, b: &Item| order(a.index(), b.index());
    items.par_sort_unstable_by(|a, b| compare(a, b).then(a.index().cmp(&b.index())));
    let mut first = items[0].index();
    for i in 1..items.len() {
        if compare(&items[i - 1], &items[i]).is_eq() {
            items[i].set_twin_of(first);
        } else {
            first = items[i].index();
        }
    }
    partition(items, |item| item.twin_of().is_none())
}

/// Reorders the items and returns how many belong to the first side, a multiple of [`WIDTH`] and neither side empty,
/// and the bounds of both.
fn cut(items: &mut [Item], extent: &Extent, depth: u32) -> (usize, [Extent; 2]) {
    let leaves = items.len().div_ceil(WIDTH);
    let halvings = usize::BITS - (leaves - 1).leading_zeros();
    if depth + halvings + 1 < MAX_DEPTH {
        return binned_cut(items, extent);
    }
    let [x, y, z] = extent.spread();
    let axis = Vec3::new(x, y, z).max_position();
    let first = leaves / 2 * WIDTH;
    items.select_nth_unstable_by(first, |a, b| a.middle(axis).total_cmp(&b.middle(axis)));
    let (head, tail) = items.split_at(first);
    (first, [bounds_of(head), bounds_of(tail)])
}
