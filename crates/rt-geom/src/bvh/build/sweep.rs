//! Cuts of short ranges, after sorting.

use std::ops::Range;

use glam::Vec4;

use super::bins::{count, scale};
use super::item::{Bounds, Extent, Item};
use super::rank::{self, ascending};
use crate::bvh::node::WIDTH;

/// Ranges up to this length are sorted; longer ones are binned.
const SORTED: usize = rank::MOST;

/// Tries every cut at a multiple of [`WIDTH`] along each axis.
pub(super) fn sorted_cut(items: &mut [Item], extent: &Extent, spread: Vec4) -> usize {
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
