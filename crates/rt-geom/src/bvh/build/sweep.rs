//! The tree over a short range: its items are sorted once along each axis, then every cut at a multiple of sixteen is
//! tried, again and again; a cut along one axis keeps the order along the others.

use std::ops::Range;

use fearless_simd::{Level, Simd, f32x4, f32x8, prelude::*};

use super::bins::{count, scale};
use super::branch::{Branch, COINCIDENT};
use super::item::{Extent, Item, bounds_of_all, half_area, middle, nothing};
use super::rank::{MOST, ascending};
use crate::bvh::node::WIDTH;
use crate::simd::dispatch;

const LEAVES: usize = MOST / WIDTH;

/// A range of leaf blocks, and its branch.
#[derive(Clone, Copy)]
pub(super) struct Stretch {
    pub(super) at: usize,
    pub(super) first: usize,
    pub(super) leaves: usize,
}

impl Stretch {
    /// The places of its items, of `n`.
    #[inline(always)]
    pub(super) fn places(&self, n: usize) -> Range<usize> {
        self.first * WIDTH..n.min((self.first + self.leaves) * WIDTH)
    }
}

/// Sorts at most [`MOST`] items into leaf order, and makes the branches below the first.
///
/// Returns the ranges, left as they are, whose middles coincide, unless those of all do, which `distinct` tells.
pub(super) fn sweep(items: &mut [Item], branches: &mut [Branch], extent: &Extent, distinct: bool) -> Vec<Stretch> {
    dispatch!(Level::new(), simd => sweep_all(simd, items, branches, extent, distinct))
}

#[inline(always)]
fn sweep_all<S: Simd>(
    simd: S,
    items: &mut [Item],
    branches: &mut [Branch],
    extent: &Extent,
    distinct: bool,
) -> Vec<Stretch> {
    let n = items.len();
    let mut sweep = Sweep::new(simd, items, extent);
    let mut coincident = Vec::new();
    let mut order = [0; MOST];
    let whole = Stretch { at: 0, first: 0, leaves: n.div_ceil(WIDTH) };
    // With the axis along which the bounds of its blocks are known; 3 for none.
    let mut pending = [(whole, 3); LEAVES];
    let mut height = 1;
    while height > 0 {
        height -= 1;
        let (stretch, known) = pending[height];
        let cut = sweep.cut(simd, stretch, known);
        branches[stretch.at].first = u32::try_from(cut.first).expect("eight at most");
        let mut more = false;
        for (side, corners) in cut.sides(stretch) {
            branches[side.at] = Branch::around(corners.into());
            let places = side.places(n);
            let coincide = !distinct && sweep.coincide(simd, cut.axis, places.clone());
            if coincide {
                coincident.push(side);
            }
            if coincide || side.leaves == 1 {
                order[places.clone()].copy_from_slice(&sweep.orders[cut.axis][places]);
            } else {
                pending[height] = (side, cut.axis);
                height += 1;
                more = true;
            }
        }
        if more {
            sweep.part(&cut, stretch);
        }
    }
    for (item, place) in items.iter_mut().zip(order) {
        *item = sweep.items[usize::from(place) % MOST];
    }
    coincident
}

/// A cut of a stretch, with the bounds of both sides.
struct Cut<S: Simd> {
    axis: usize,
    /// Leaf blocks of the first side.
    first: usize,
    cost: f32,
    head: f32x8<S>,
    tail: f32x8<S>,
}

impl<S: Simd> Cut<S> {
    #[inline(always)]
    fn sides(&self, Stretch { at, first, leaves }: Stretch) -> [(Stretch, f32x8<S>); 2] {
        let k = self.first;
        [
            (Stretch { at: at + 1, first, leaves: k }, self.head),
            (Stretch { at: at + 2 * k, first: first + k, leaves: leaves - k }, self.tail),
        ]
    }
}

struct Sweep<S: Simd> {
    items: [Item; MOST],
    n: usize,
    /// How far along each middle lies, in 23 bits, and its place in 7.
    keys: [[u32; MOST]; 3],
    /// The places in the order of each axis.
    orders: [[u8; MOST]; 3],
    /// Bounds of the leaf blocks in that order.
    blocks: [[f32x8<S>; LEAVES]; 3],
    /// Two keys that differ by more belong to middles that do not coincide.
    close: [u32; 3],
}

impl<S: Simd> Sweep<S> {
    #[inline(always)]
    fn new(simd: S, all: &[Item], extent: &Extent) -> Self {
        let n = all.len();
        let mut items = [Item::NONE; MOST];
        items[..n].copy_from_slice(all);
        let scales = extent.spread().map(|spread| scale(spread, 8_388_606.0));
        let [x, y, z] = scales;
        let [a, b, c, ..] = extent.middles;
        let (low, scale) = (f32x4::simd_from(simd, [a, b, c, 0.0]), f32x4::simd_from(simd, [x, y, z, 0.0]));
        let mut keys = [[0; MOST]; 3];
        for (place, item) in (0..).zip(&items[..n]) {
            // Adding 2^23 rounds to an integer in the low bits.
            let along = (middle(item.corners(simd)) - low) * scale + 8_388_608.0;
            let along: [f32; 4] = along.into();
            for axis in 0..3 {
                keys[axis][place as usize] = along[axis].to_bits() << 9 >> 2 | place;
            }
        }
        let mut orders = [[0; MOST]; 3];
        for (order, keys) in orders.iter_mut().zip(&keys) {
            *order = ascending(simd, &keys[..n]);
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive, and saturates")]
        let close = scales.map(|scale| ((COINCIDENT * scale) as u32).saturating_add(2));
        Self { items, n, keys, orders, blocks: [[nothing(simd); LEAVES]; 3], close }
    }

    /// The cut of the least cost. The bounds of the blocks along the axis `known` are there already.
    #[inline(always)]
    fn cut(&mut self, simd: S, stretch: Stretch, known: usize) -> Cut<S> {
        let Stretch { first, leaves, .. } = stretch;
        let mut best = Cut { axis: 0, first: 0, cost: f32::INFINITY, head: nothing(simd), tail: nothing(simd) };
        for axis in 0..3 {
            if axis != known {
                self.bound(simd, stretch, axis);
            }
            let blocks = &self.blocks[axis][first..first + leaves];
            let mut tails = [nothing(simd); LEAVES];
            let mut tail = nothing(simd);
            for k in (1..leaves).rev() {
                tail = blocks[k].min(tail);
                tails[k] = tail;
            }
            let mut head = nothing(simd);
            for k in 1..leaves {
                head = blocks[k - 1].min(head);
                let cost = half_area(head) * count(k) + half_area(tails[k]) * count(leaves - k);
                if cost < best.cost || best.first == 0 {
                    best = Cut { axis, first: k, cost, head, tail: tails[k] };
                }
            }
        }
        best
    }

    /// Bounds the leaf blocks of a stretch in the order of an axis.
    #[inline(always)]
    fn bound(&mut self, simd: S, Stretch { first, leaves, .. }: Stretch, axis: usize) {
        for block in first..first + leaves {
            let order = &self.orders[axis][block * WIDTH..self.n.min((block + 1) * WIDTH)];
            let mut bounds = nothing(simd);
            for &place in order {
                bounds = self.items[usize::from(place) % MOST].corners(simd).min(bounds);
            }
            self.blocks[axis][block] = bounds;
        }
    }

    /// Whether the middles of several items coincide, which are a range of the order of an axis.
    #[inline(always)]
    fn coincide(&self, simd: S, axis: usize, places: Range<usize>) -> bool {
        let order = &self.orders[axis][places];
        let key = |place: u8| self.keys[axis][usize::from(place) % MOST] >> 7;
        let [start, .., end] = order else { return false };
        if key(*end) - key(*start) > self.close[axis] {
            return false;
        }
        let extent = bounds_of_all(simd, order.iter().map(|&place| &self.items[usize::from(place) % MOST]));
        extent.spread().into_iter().all(|spread| spread <= COINCIDENT)
    }

    /// Sorts the orders along the other axes apart as the cut says.
    #[inline(always)]
    fn part(&mut self, cut: &Cut<S>, stretch: Stretch) {
        let places = stretch.places(self.n);
        let mut side = [0u8; MOST];
        for &place in &self.orders[cut.axis][places.start + cut.first * WIDTH..places.end] {
            side[usize::from(place) % MOST] = 1;
        }
        for axis in (0..3).filter(|&axis| axis != cut.axis) {
            let order = &mut self.orders[axis][places.clone()];
            let mut tail = [0; MOST];
            let (mut before, mut behind) = (0, 0);
            for i in 0..order.len() {
                let place = order[i];
                order[before] = place;
                tail[behind % MOST] = place;
                let second = usize::from(side[usize::from(place) % MOST]);
                before += 1 - second;
                behind += second;
            }
            order[before..].copy_from_slice(&tail[..behind]);
        }
    }
}

#[cfg(test)]
mod tests {
    use oracle::Random;

    use super::*;
    use crate::bvh::build::item::{bounds_of, items_at_random};

    /// The least cost of a cut, by sorting along each axis.
    fn least_cost(items: &[Item]) -> f32 {
        let area = |items: &[Item]| Branch::around(bounds_of(items).items).half_area();
        let costs = (0..3).flat_map(|axis| {
            let mut items = items.to_vec();
            items.sort_by(|a, b| a.middle(axis).total_cmp(&b.middle(axis)));
            let blocks = |items: &[Item]| count(items.len().div_ceil(WIDTH));
            let cost = |k: usize| {
                let (head, tail) = items.split_at(k);
                area(head) * blocks(head) + area(tail) * blocks(tail)
            };
            (1..items.len().div_ceil(WIDTH)).map(|k| cost(k * WIDTH)).collect::<Vec<_>>()
        });
        costs.fold(f32::INFINITY, f32::min)
    }

    /// Whether each branch has the bounds of its items, and no cut costs less than the one that was made.
    fn check(items: &[Item], branches: &[Branch]) {
        assert_eq!(branches[0].corners(), Branch::around(bounds_of(items).items).corners());
        let leaves = items.len().div_ceil(WIDTH);
        assert_eq!(branches.len(), 2 * leaves - 1);
        if leaves > 1 {
            let first = branches[0].first as usize;
            let (head, tail) = (&branches[1..2 * first], &branches[2 * first..]);
            let cost = head[0].half_area() * count(first) + tail[0].half_area() * count(leaves - first);
            assert!(cost <= least_cost(items) * (1.0 + 1e-5), "{cost} {items:?}");
            check(&items[..first * WIDTH], head);
            check(&items[first * WIDTH..], tail);
        }
    }

    #[test]
    fn a_sweep_makes_the_cheapest_cuts_and_keeps_every_item() {
        let random = &mut Random::new(9);
        for n in WIDTH + 1..=MOST {
            let mut items = items_at_random(n, random);
            let extent = bounds_of(&items);
            let mut branches = vec![Branch::around(extent.items); 2 * n.div_ceil(WIDTH) - 1];
            assert!(sweep(&mut items, &mut branches, &extent, false).is_empty());
            check(&items, &branches);
            let mut indices: Vec<u32> = items.iter().map(Item::index).collect();
            indices.sort_unstable();
            assert!(indices.into_iter().eq((0..).take(n)), "{items:?}");
        }
    }

    /// Sixty-four copies each of two boxes.
    #[test]
    fn what_coincides_is_told() {
        let random = &mut Random::new(10);
        let two = items_at_random(2, random);
        let mut items: Vec<Item> = (0..128).map(|i| two[i as usize % 2].with_index(i)).collect();
        let extent = bounds_of(&items);
        let mut branches = vec![Branch::around(extent.items); 15];
        let coincident = sweep(&mut items, &mut branches, &extent, false);
        let mut firsts: Vec<(usize, usize)> = coincident.iter().map(|side| (side.first, side.leaves)).collect();
        firsts.sort_unstable();
        assert_eq!(firsts, [(0, 4), (4, 4)]);
        for side in coincident {
            let kinds: Vec<u32> = items[side.places(128)].iter().map(|item| item.index() % 2).collect();
            assert!(kinds.windows(2).all(|pair| pair[0] == pair[1]), "{kinds:?}");
        }
    }
}
