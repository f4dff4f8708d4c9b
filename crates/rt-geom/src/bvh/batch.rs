//! Many independent rays at once: each waits for memory while the others work.
//!
//! A walk of one ray is a chain of loads and hard-to-predict branches. Here [`FLIGHT`] rays are on their way together.
//! A round takes one step of each: rays at an inner node test it, rays at a leaf block test that, and what survives
//! there meets the exact kernels one round later. What a ray needs next is prefetched a round ahead, and a step has no
//! branch that depends on how many children are met: the children are compressed, sorted in registers and stored on
//! the ray's stack whole, and a ray is appended to the list of its next kind of work by arithmetic.

use std::ops::Range;

use fearless_simd::{Simd, mask32x8, prelude::*, u8x32, u32x8, u32x16};

use super::Bvh;
use super::crown::{Line64, Tour};
use super::cull::{CullRay, Culled, box_keys};
use super::node::{Blocked, Child, Kind, Region, WIDTH};
use super::walk::{Areas, meet, next_region};
use crate::lanes::RayLanes;
use crate::leaf::{Closest, Query, finish};
use crate::ray::{Candidate, PreparedRay, is_open};
use crate::simd::prefetch_lines;
use crate::{Ray, Sphere, Triangle, Visits};

/// Rays on their way at once.
const FLIGHT: usize = 64;
/// Hits that are rounded at once.
const EIGHT: usize = 8;

/// The low bits of a pending key tell the child's lane.
const LANE: u32 = 15;
const _: () = assert!(WIDTH == 16);

struct Slot<'a, Q> {
    line: CullRay,
    ray: PreparedRay<'a>,
    query: Q,
    at: Child,
    height: usize,
    /// Whose answer it is.
    target: usize,
    /// Where its stack begins.
    base: usize,
}

/// The stacks of all slots: the keys of what is pending, with the lane in the low bits, and the node that it is in.
struct Stacks {
    keys: Vec<u32>,
    nodes: Vec<u32>,
}

impl<'a, Q: Query> Slot<'a, Q> {
    fn new(ray: &'a Ray, within: &Range<f64>, base: usize) -> Self {
        Self {
            line: CullRay::EVERYTHING,
            ray: PreparedRay::new(ray, within.clone()),
            query: Q::begin(&mut Q::Answer::default()),
            at: Child::from_bits(0),
            height: 0,
            target: 0,
            base,
        }
    }
}

/// Which slots have what to do next.
struct Lists {
    slots: [[u8; FLIGHT]; 5],
    len: [usize; 5],
}

const INNER: usize = Kind::Inner as usize;
const SPHERES: usize = Kind::Spheres as usize;
const TRIANGLES: usize = Kind::Triangles as usize;
const DONE: usize = 3;
/// The step is done: take up what is pending.
const RESUME: usize = 4;

impl Lists {
    const NONE: Self = Self { slots: [[0; FLIGHT]; 5], len: [0; 5] };

    #[inline(always)]
    fn push(&mut self, list: usize, slot: usize) {
        self.slots[list][self.len[list]] = byte(slot);
        self.len[list] += 1;
    }

    #[inline(always)]
    fn take(&mut self, list: usize) -> ([u8; FLIGHT], usize) {
        let len = std::mem::take(&mut self.len[list]);
        (self.slots[list], len)
    }
}

/// Primitives that the cull left, and whose they are.
struct Survivors {
    places: [u32; FLIGHT * WIDTH + WIDTH],
    slots: [u32; FLIGHT * WIDTH + WIDTH],
    len: usize,
}

/// Rays that are still to be launched, each with its place.
struct Waiting<'a> {
    rays: &'a [Ray],
    only: Option<&'a [usize]>,
    next: usize,
}

impl<'a> Iterator for Waiting<'a> {
    type Item = (usize, &'a Ray);

    #[inline(always)]
    fn next(&mut self) -> Option<Self::Item> {
        let place = match self.only {
            Some(only) => *only.get(self.next)?,
            None => self.next,
        };
        self.next += 1;
        Some((place, self.rays.get(place)?))
    }
}

/// Answers a query for all rays, or only those at some places.
#[inline(always)]
pub(super) fn fly<S: Simd, Q: Query>(
    simd: S,
    tree: &Bvh,
    rays: &[Ray],
    only: Option<&[usize]>,
    within: &Range<f64>,
    answers: &mut [Q::Answer],
) {
    if !is_open(within) {
        for (ray, answer) in rays.iter().zip(answers) {
            *answer = Q::begin(answer).answer(&tree.leaves, &PreparedRay::new(ray, within.clone()));
        }
        return;
    }
    let mut waiting = Waiting { rays, only, next: 0 };
    let mut lists = Lists::NONE;
    // A step writes sixteen entries, however many are met.
    let depth = tree.stack + WIDTH;
    let flight = FLIGHT.min(only.map_or(rays.len(), <[usize]>::len));
    let mut slots: Vec<Slot<Q>> = (0..flight).map(|i| Slot::new(&rays[0], within, i * depth)).collect();
    let mut stacks = Stacks { keys: vec![0; flight * depth], nodes: vec![0; flight * depth] };
    let tour = |slot: &Slot<Q>| tree.crown.as_ref().map(|crown| Tour::new(crown, Line64::new(&slot.ray)));
    let mut tours: Vec<Tour> = slots.iter().filter_map(tour).collect();
    for (at, slot) in slots.iter_mut().enumerate() {
        if let Some(list) = launch(simd, slot, tours.get_mut(at), tree, within, &mut waiting, answers) {
            lists.push(list, at);
        }
    }
    let mut flying: usize = lists.len.iter().sum();
    let (mut spheres, mut triangles) = (Survivors::NONE, Survivors::NONE);
    while flying > 0 {
        // What the cull left in the last round.
        spheres.meet::<S, Q, Sphere>(simd, tree, &mut slots, within);
        triangles.meet::<S, Q, Triangle>(simd, tree, &mut slots, within);
        resume(tree, &mut slots, &stacks, &mut lists);
        descend(simd, tree, &mut slots, &mut stacks, &mut lists);
        spheres.cull(simd, &tree.sphere_blocks, SPHERES, &mut slots, &mut lists);
        for &place in &spheres.places[..spheres.len] {
            prefetch_lines(&tree.leaves.spheres[place as usize], 1);
        }
        triangles.cull(simd, &tree.triangle_blocks, TRIANGLES, &mut slots, &mut lists);
        for &place in &triangles.places[..triangles.len] {
            prefetch_lines(&tree.leaves.triangles[place as usize], 2);
        }
        flying -= land(simd, tree, &mut slots, &mut tours, &mut lists, within, &mut waiting, answers);
    }
}

/// Takes up what is pending, where the last step is done. In a loop of its own: the loads of one slot need not wait for
/// the stores of another.
#[inline(always)]
fn resume<Q: Query>(tree: &Bvh, slots: &mut [Slot<Q>], stacks: &Stacks, lists: &mut Lists) {
    let (fetch, areas) = (tree.is_large(), Areas::of(tree));
    let (resumed, len) = lists.take(RESUME);
    for &at in &resumed[..len] {
        let slot = &mut slots[usize::from(at)];
        let child = next(slot, tree, stacks);
        lists.push(child.map_or(DONE, |child| child.kind() as usize), usize::from(at));
        if fetch && let Some(child) = child {
            areas.prefetch(child);
        }
    }
}

/// Tests the nodes where slots are, and puts the children met on their stacks, farthest first.
#[inline(always)]
fn descend<S: Simd, Q: Query>(simd: S, tree: &Bvh, slots: &mut [Slot<Q>], stacks: &mut Stacks, lists: &mut Lists) {
    let (inner, len) = lists.take(INNER);
    for &at in &inner[..len] {
        let at = usize::from(at);
        let slot = &mut slots[at];
        let index = slot.at.index();
        let node = &tree.nodes[index];
        let (keys, mask) = box_keys(simd, &slot.line, &node.boxes);
        let lanes = u32x16::from_fn(simd, word);
        let met = ((keys & !LANE) | lanes).compress(mask);
        let count = mask.to_bitmask().count_ones() as usize;
        let top = slot.base + slot.height;
        let low: &mut [u32; WIDTH] = (&mut stacks.keys[top..top + WIDTH]).try_into().expect("a slice of sixteen");
        if count <= 8 {
            let (first, _) = met.split();
            descending(simd, first).store_slice(&mut low[..8]);
        } else {
            met.store_slice(low);
            low[..count].sort_unstable_by(|a, b| b.cmp(a));
        }
        stacks.nodes[top..top + WIDTH].fill(word(index));
        slot.height += count;
        lists.push(RESUME, at);
    }
}

/// Answers the rays that have met all, and launches others from their slots; returns how many slots stay empty.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "a part of the flight, inlined into it")]
fn land<'a, S: Simd, Q: Query>(
    simd: S,
    tree: &Bvh,
    slots: &mut [Slot<'a, Q>],
    tours: &mut [Tour],
    lists: &mut Lists,
    within: &Range<f64>,
    waiting: &mut Waiting<'a>,
    answers: &mut [Q::Answer],
) -> usize {
    let (done, len) = lists.take(DONE);
    // Eight at a time, as long as others are on their way.
    let now = if lists.len.iter().sum::<usize>() > 0 { len - len % EIGHT } else { len };
    for &at in &done[now..len] {
        lists.push(DONE, usize::from(at));
    }
    for done in done[..now].chunks(EIGHT) {
        finish_slots(simd, tree, slots, done);
    }
    let mut empty = 0;
    for &at in &done[..now] {
        let at = usize::from(at);
        let slot = &mut slots[at];
        if let Some(tour) = tours.get_mut(at)
            && let Some(list) = travel(simd, slot, tour, tree)
        {
            lists.push(list, at);
            continue;
        }
        answers[slot.target] = slot.query.answer(&tree.leaves, &slot.ray);
        match launch(simd, slot, tours.get_mut(at), tree, within, waiting, answers) {
            Some(list) => lists.push(list, at),
            None => empty += 1,
        }
    }
    empty
}

/// Works out the last bits of what up to eight rays hit.
#[inline(always)]
fn finish_slots<S: Simd, Q: Query>(simd: S, tree: &Bvh, slots: &mut [Slot<Q>], at: &[u8]) {
    let lanes: [usize; EIGHT] = std::array::from_fn(|lane| usize::from(at[lane.min(at.len() - 1)]));
    let mut best = [Closest::default(); EIGHT];
    for (best, &at) in best.iter_mut().zip(&lanes) {
        match slots[at].query.closest() {
            Some(closest) => *best = *closest,
            None => return,
        }
    }
    finish(simd, &tree.leaves, &mut best, lanes.map(|at| slots[at].ray.ray));
    for (best, at) in best.into_iter().zip(lanes) {
        if let Some(closest) = slots[at].query.closest() {
            *closest = best;
        }
    }
}

/// Puts the next ray that may meet anything into the slot, and returns the list for it; `None` if no ray is left.
#[inline(always)]
fn launch<'a, S: Simd, Q: Query>(
    simd: S,
    slot: &mut Slot<'a, Q>,
    mut tour: Option<&mut Tour>,
    tree: &Bvh,
    within: &Range<f64>,
    waiting: &mut Waiting<'a>,
    answers: &mut [Q::Answer],
) -> Option<usize> {
    let only = tree.regions.first();
    for (target, ray) in waiting {
        slot.ray = PreparedRay::new(ray, within.clone());
        slot.query = Q::begin(&mut answers[target]);
        slot.target = target;
        if let (Some(tour), Some(crown)) = (&mut tour, &tree.crown) {
            tour.begin(crown, Line64::new(&slot.ray));
            if let Some(list) = travel(simd, slot, tour, tree) {
                return Some(list);
            }
        } else if let Some(Region { frame, root }) = only
            && slot.line.set(simd, frame, &slot.ray, tree.has_balls())
        {
            slot.at = *root;
            slot.height = 0;
            return Some(root.kind() as usize);
        }
        answers[target] = slot.query.answer(&tree.leaves, &slot.ray);
    }
    None
}

/// Takes the ray of a slot on to the next region below the crown that it may meet, and returns the list for it.
#[cold]
#[inline(never)]
fn travel<S: Simd, Q: Query>(simd: S, slot: &mut Slot<Q>, tour: &mut Tour, tree: &Bvh) -> Option<usize> {
    loop {
        let region = next_region(simd, tour, tree, &slot.ray, &mut slot.query, &mut Visits::default())?;
        let meets = simd.vectorize(
            #[inline(always)]
            || slot.line.set(simd, &region.frame, &slot.ray, tree.has_balls()),
        );
        if meets {
            slot.line.shorten(slot.query.limit());
            slot.at = region.root;
            slot.height = 0;
            return Some(region.root.kind() as usize);
        }
    }
}

/// Takes the nearest pending part that is still of interest.
#[inline(always)]
fn next<Q>(slot: &mut Slot<Q>, tree: &Bvh, stacks: &Stacks) -> Option<Child> {
    let last = slot.line.last_key();
    let mut top = slot.base + slot.height;
    while top > slot.base && stacks.keys[top - 1] & !LANE > last {
        top -= 1;
    }
    if top == slot.base {
        return None;
    }
    top -= 1;
    slot.height = top - slot.base;
    let node = &tree.nodes[stacks.nodes[top] as usize];
    slot.at = node.children[(stacks.keys[top] & LANE) as usize];
    Some(slot.at)
}

impl Survivors {
    const NONE: Self = Self { places: [0; _], slots: [0; _], len: 0 };

    /// Culls the leaf blocks where slots are.
    #[inline(always)]
    fn cull<S: Simd, Q, B: Culled>(
        &mut self,
        simd: S,
        blocks: &[B],
        list: usize,
        slots: &mut [Slot<Q>],
        lists: &mut Lists,
    ) {
        let (leaf, len) = lists.take(list);
        for &at in &leaf[..len] {
            let slot = &slots[usize::from(at)];
            let block = slot.at.index();
            self.add(simd, blocks[block].meet(simd, &slot.line), block, at);
            lists.push(RESUME, usize::from(at));
        }
    }

    /// Hands all to the queries of their slots. A slot's survivors follow each other.
    #[inline(always)]
    fn meet<S: Simd, Q: Query, L: Blocked>(
        &mut self,
        simd: S,
        tree: &Bvh,
        slots: &mut [Slot<Q>],
        Range { start, end }: &Range<f64>,
    ) {
        let len = std::mem::take(&mut self.len);
        for first in (0..len).step_by(EIGHT) {
            let count = EIGHT.min(len - first);
            let places: [usize; EIGHT] = std::array::from_fn(|lane| self.places[first + lane.min(count - 1)] as usize);
            let at: [usize; EIGHT] = std::array::from_fn(|lane| self.slots[first + lane.min(count - 1)] as usize);
            let (mut none, mut some, mut low, mut high) = (0, 0, [0.0; EIGHT], [0.0; EIGHT]);
            if Q::TAKES_CANDIDATES {
                let shapes = places.map(|place| &L::of(&tree.leaves)[place]);
                let rays = RayLanes::new(simd, at.map(|at| slots[at].ray.ray));
                let found = L::lane_candidates(simd, shapes, &rays, (*start, *end));
                (none, some) = (found.none, found.some);
                found.low.store_slice(&mut low);
                found.high.store_slice(&mut high);
            }
            for lane in 0..count {
                if none >> lane & 1 == 1 {
                    continue;
                }
                let slot = &mut slots[at[lane]];
                let before = slot.query.limit();
                if some >> lane & 1 == 1 {
                    let bounds = Candidate { low: low[lane], high: high[lane] };
                    slot.query.offer(bounds, L::first_place(&tree.leaves) + places[lane], &tree.leaves, &slot.ray);
                } else {
                    meet::<S, Q, L>(simd, &mut slot.query, places[lane], &tree.leaves, &slot.ray);
                }
                if slot.query.is_settled() {
                    slot.height = 0;
                }
                if slot.query.limit() < before {
                    slot.line.shorten(slot.query.limit());
                }
            }
        }
    }

    #[inline(always)]
    fn add<S: Simd>(&mut self, simd: S, met: u32, block: usize, slot: u8) {
        let places = u32x16::from_fn(simd, word) + word(block * WIDTH);
        let mask = fearless_simd::mask32x16::from_bitmask(simd, u64::from(met));
        places.compress(mask).store_slice(&mut self.places[self.len..self.len + WIDTH]);
        self.slots[self.len..self.len + WIDTH].fill(u32::from(slot));
        self.len += met.count_ones() as usize;
    }
}

/// Sorts eight numbers, the greatest first: a bitonic network (K. Batcher, "Sorting Networks and Their Applications",
/// 1968).
#[inline(always)]
fn descending<S: Simd>(simd: S, v: u32x8<S>) -> u32x8<S> {
    // Swap neighbours, reverse fours, swap pairs.
    let neighbours = shuffle(simd, [1, 0, 3, 2]);
    let fours = shuffle(simd, [3, 2, 1, 0]);
    let pairs = shuffle(simd, [2, 3, 0, 1]);
    let v = step(simd, v, v.swizzle_dyn_within_blocks(neighbours), 0b0101_0101);
    let v = step(simd, v, v.swizzle_dyn_within_blocks(fours), 0b0011_0011);
    let v = step(simd, v, v.swizzle_dyn_within_blocks(neighbours), 0b0101_0101);
    let v = step(simd, v, v.swizzle_dyn_within_blocks(fours).rotate_elements_left::<4>(), 0b0000_1111);
    let v = step(simd, v, v.swizzle_dyn_within_blocks(pairs), 0b0011_0011);
    step(simd, v, v.swizzle_dyn_within_blocks(neighbours), 0b0101_0101)
}

/// An order of four numbers as one of bytes, for both halves.
#[inline(always)]
fn shuffle<S: Simd>(simd: S, order: [u8; 4]) -> u8x32<S> {
    let bytes: [u8; 32] = std::array::from_fn(|i| 4 * order[i / 4 % 4] + byte(i % 4));
    u8x32::from_slice(simd, &bytes)
}

/// The greater of each pair where `greater` has a bit, the smaller elsewhere.
#[inline(always)]
fn step<S: Simd>(simd: S, v: u32x8<S>, partner: u32x8<S>, greater: u64) -> u32x8<S> {
    mask32x8::from_bitmask(simd, greater).select(v.max(partner), v.min(partner))
}

#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "a slot, of which there are few, or a lane")]
fn byte(x: usize) -> u8 {
    x as u8
}

#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "a place or a node, of which there are fewer than 2^32")]
fn word(x: usize) -> u32 {
    x as u32
}

#[cfg(test)]
mod tests {
    use fearless_simd::Level;
    use oracle::Random;

    use super::*;
    use crate::simd::dispatch;

    #[inline(always)]
    fn sorted<S: Simd>(simd: S, numbers: [u32; 8]) -> [u32; 8] {
        descending(simd, u32x8::simd_from(simd, numbers)).into()
    }

    /// A network that sorts all numbers of zeros and ones sorts everything (D. Knuth, TAOCP 3, 5.3.4, theorem Z).
    #[test]
    fn the_network_sorts_all_zeros_and_ones_and_random_numbers() {
        let random = &mut Random::new(6);
        let bits = (0..256u32).map(|bits| std::array::from_fn(|i| bits >> i & 1));
        let any = (0..1000).map(|_| std::array::from_fn(|_| (random.bits() >> 32) as u32 >> (random.bits() % 32)));
        let numbers: Vec<[u32; 8]> = bits.chain(any).collect();
        for numbers in numbers {
            let mut expected = numbers;
            expected.sort_unstable_by(|a, b| b.cmp(a));
            for level in [Level::new(), Level::baseline()] {
                assert_eq!(dispatch!(level, simd => sorted(simd, numbers)), expected, "{level:?} {numbers:?}");
            }
        }
    }
}
