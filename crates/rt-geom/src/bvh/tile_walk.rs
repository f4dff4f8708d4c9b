//! A tile's way through the tree: the walk of one ray (`walk.rs`) with the cull of many (`tile.rs`).
//!
//! What the cull leaves of a leaf block meets the exact kernels' filter, eight rays at a time; all that it leaves open goes
//! to the kernels one by one.

use std::ops::Range;

use fearless_simd::{Simd, mask64x8, prelude::*, u32x16};

use super::Bvh;
use super::crown::{Crown, Part, Tour};
use super::cull::{bits, slabs};
use super::node::{Balls, Blocked, Boxes, Kind, Region, WIDTH};
use super::tile::{EIGHT, Tile, TileBlock, eight};
use super::walk::{Areas, Pending, nearest, next, visit};
use crate::leaf::{Closest, Leaves, Query, finish};
use crate::ray::PreparedRay;
use crate::simd::{has_fma, prefetch_lines};
use crate::{Hit, Ray, Sphere, Triangle, Visits};

/// What has become of a tile.
pub(super) enum Outcome {
    /// The rays do not make one, or it costs too much: their answers are not written.
    NoTile,
    /// All answers are written, after this many tests of bounds.
    Done(u32),
}

/// Writes the closest hits of the rays in this order, unless they do not make a tile or take more than `most` tests.
#[inline(always)]
pub(super) fn closest<S: Simd>(
    simd: S,
    tree: &Bvh,
    (tile, stack): (&mut Tile, &mut [Pending]),
    (rays, order): (&[Ray], &[usize]),
    within: &Range<f64>,
    answers: &mut [Option<Hit>],
    most: u32,
) -> Outcome {
    if !tile.gather(rays, order) {
        return Outcome::NoTile;
    }
    let done = match (&tree.crown, tree.regions.first()) {
        (Some(crown), _) => travel(simd, tree, crown, (tile, stack), (rays, order), within, most),
        (None, Some(region)) => {
            tile.enter(simd, &region.frame, within.end)
                && walk(simd, tree, region, (tile, stack), (rays, order), within, most)
        }
        (None, None) => true,
    };
    if !done {
        return Outcome::NoTile;
    }
    for (first, targets) in (0..).step_by(EIGHT).zip(order.chunks(EIGHT)) {
        let mut best: [Closest; EIGHT] = std::array::from_fn(|lane| tile.best(first + lane));
        let lanes: [&Ray; EIGHT] = std::array::from_fn(|lane| &rays[targets[lane.min(targets.len() - 1)]]);
        finish(simd, &tree.leaves, &mut best, lanes);
        for (mut best, &target) in best.into_iter().zip(targets) {
            answers[target] = best.answer(&tree.leaves, &PreparedRay::new(&rays[target], within.clone()));
        }
    }
    Outcome::Done(tile.work)
}

/// Takes the tile through the crown and all regions below that it may meet; `false` if it takes more than `most` tests.
/// In a region where the rays make no tile they walk one by one.
#[cold]
#[inline(never)]
fn travel<S: Simd>(
    simd: S,
    tree: &Bvh,
    crown: &Crown,
    (tile, stack): (&mut Tile, &mut [Pending]),
    (rays, order): (&[Ray], &[usize]),
    within: &Range<f64>,
    most: u32,
) -> bool {
    simd.vectorize(
        #[inline(always)]
        || {
            let Some(line) = tile.line(within) else { return false };
            if !crown.is_met(&line) {
                return true;
            }
            let mut tour = Tour::new(crown, line);
            let visits = &mut Visits::default();
            while let Some(part) = tour.next(simd, crown, false, tile.limit(), visits) {
                tile.work += 1;
                match part {
                    Part::Region(index) => {
                        let region = &tree.regions[index as usize];
                        if !tile.enter(simd, &region.frame, within.end) {
                            one_by_one(simd, tree, region, tile, (rays, order), within);
                        } else if !walk(simd, tree, region, (tile, stack), (rays, order), within, most) {
                            return false;
                        }
                    }
                    Part::Sphere(place) => {
                        offer::<S, Sphere>(simd, place as usize, u64::MAX, tile, tree, (rays, order), within);
                    }
                    Part::Triangle(place) => {
                        offer::<S, Triangle>(simd, place as usize, u64::MAX, tile, tree, (rays, order), within);
                    }
                    Part::Node(_) => unreachable!("a tour goes through nodes"),
                }
                if tile.work > most {
                    return false;
                }
            }
            true
        },
    )
}

/// Takes the rays through a region one by one.
#[cold]
#[inline(never)]
fn one_by_one<S: Simd>(
    simd: S,
    tree: &Bvh,
    region: &Region,
    tile: &mut Tile,
    (rays, order): (&[Ray], &[usize]),
    within: &Range<f64>,
) {
    simd.vectorize(
        #[inline(always)]
        || {
            let visits = &mut Visits::default();
            for (lane, &ray) in order.iter().enumerate() {
                let mut best = tile.best(lane);
                visit(simd, tree, region, &PreparedRay::new(&rays[ray], within.clone()), &mut best, visits);
                tile.keep(lane, &best);
            }
            tile.work = tile.work.saturating_add(u32::try_from(visits.nodes).unwrap_or(u32::MAX));
        },
    );
}

/// Takes the tile through a region; `false` if it takes more than `most` tests.
#[inline(always)]
fn walk<S: Simd>(
    simd: S,
    tree: &Bvh,
    region: &Region,
    (tile, stack): (&mut Tile, &mut [Pending]),
    (rays, order): (&[Ray], &[usize]),
    within: &Range<f64>,
    most: u32,
) -> bool {
    let mut keys = [0; WIDTH];
    let areas = Areas::of(tree);
    let mut height = 0;
    let mut at = region.root;
    loop {
        tile.work += 1;
        if tile.work > most {
            return false;
        }
        match at.kind() {
            Kind::Inner => {
                let node = &tree.nodes[at.index()];
                let (enter, leave) = slabs(simd, &node.boxes, tile.near, tile.far, (0.0, tile.last));
                let met = bits(enter.simd_le(leave).to_bitmask());
                // (Minus zero plus zero is zero.)
                let key: u32x16<S> = (enter + 0.0).bitcast();
                key.store_slice(&mut keys);
                if met != 0 {
                    at = nearest(node, &keys, met, Some(&areas), stack, &mut height);
                    continue;
                }
            }
            Kind::Spheres => {
                prefetch_lines(tree.leaves.spheres.as_ptr().wrapping_add(at.index() * WIDTH), 8);
                block::<S, Balls>(simd, &tree.sphere_blocks, at.index(), tile, tree, (rays, order), within);
            }
            Kind::Triangles => {
                prefetch_lines(tree.leaves.triangles.as_ptr().wrapping_add(at.index() * WIDTH), 18);
                block::<S, Boxes>(simd, &tree.triangle_blocks, at.index(), tile, tree, (rays, order), within);
            }
        }
        match next(stack, &mut height, tile.last.to_bits()) {
            Some(next) => at = next,
            None => return true,
        }
    }
}

/// Takes the tile through a leaf block.
#[inline(always)]
fn block<S: Simd, B: TileBlock>(
    simd: S,
    blocks: &[B],
    index: usize,
    tile: &mut Tile,
    tree: &Bvh,
    (rays, order): (&[Ray], &[usize]),
    within: &Range<f64>,
) {
    let block = &blocks[index];
    let mut met = block.meet_tile(simd, tile);
    let mut changed = 0;
    while met != 0 {
        let lane = met.trailing_zeros() as usize;
        met &= met - 1;
        tile.work += 1;
        let near = block.near(simd, tile, lane);
        if near != 0 {
            changed |= offer::<S, B::Leaf>(simd, WIDTH * index + lane, near, tile, tree, (rays, order), within);
        }
    }
    if changed != 0 {
        for group in 0..tile.groups() {
            if changed >> (WIDTH * group) & 0xffff != 0 {
                tile.shorten(simd, group, within.end);
            }
        }
        tile.find_last(simd);
    }
}

/// Offers a primitive to the rays given as bits, and returns those with a better hit now.
#[inline(always)]
fn offer<S: Simd, L: Blocked>(
    simd: S,
    place: usize,
    near: u64,
    tile: &mut Tile,
    tree: &Bvh,
    (rays, order): (&[Ray], &[usize]),
    within: &Range<f64>,
) -> u64 {
    let leaf = &L::of(&tree.leaves)[place];
    let place = L::first_place(&tree.leaves) + place;
    let mut changed = 0;
    for at in (0..WIDTH * tile.groups()).step_by(EIGHT) {
        let wanted = near >> at & 0xff;
        if wanted == 0 {
            continue;
        }
        let found = leaf.pencil_candidates(simd, &tile.lanes(simd, at), (within.start, within.end));
        let mut open = wanted & !found.none & !found.some;
        if wanted & found.some != 0 {
            let (low, high) = (eight(simd, &tile.low, at), eight(simd, &tile.high, at));
            let some = wanted & found.some;
            let better = some & found.high.simd_lt(low).to_bitmask();
            open |= some & !better & found.low.simd_le(high).to_bitmask();
            if better != 0 {
                let mask = mask64x8::from_bitmask(simd, better);
                mask.select(found.low, low).store_slice(&mut tile.low[at..at + EIGHT]);
                mask.select(found.high, high).store_slice(&mut tile.high[at..at + EIGHT]);
                for (lane, best) in tile.place[at..at + EIGHT].iter_mut().enumerate() {
                    *best = if better >> lane & 1 == 1 { place } else { *best };
                }
                changed |= better << at;
            }
        }
        while open != 0 {
            let lane = at + open.trailing_zeros() as usize;
            open &= open - 1;
            if lane < order.len() {
                changed |= alone::<S, L>(simd, leaf, place, tile, &tree.leaves, (lane, &rays[order[lane]]), within);
            }
        }
    }
    changed
}

/// Offers a primitive to one ray, which the filter for eight has left open.
#[cold]
#[inline(never)]
fn alone<S: Simd, L: Blocked>(
    simd: S,
    leaf: &L,
    place: usize,
    tile: &mut Tile,
    leaves: &Leaves,
    (lane, ray): (usize, &Ray),
    within: &Range<f64>,
) -> u64 {
    let mut best = tile.best(lane);
    let prepared = PreparedRay::new(ray, within.clone());
    if has_fma(simd) {
        simd.vectorize(
            #[inline(always)]
            || best.meet::<true, _>(leaf, place, leaves, &prepared),
        );
    } else {
        best.meet::<false, _>(leaf, place, leaves, &prepared);
    }
    let changed = u64::from(best.bounds.high < tile.high[lane]) << lane;
    tile.keep(lane, &best);
    changed
}
