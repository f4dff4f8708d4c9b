//! Builds the tree: a binary tree by binned surface area, then collapsed to sixteen children a node.
//!
//! 1. Each primitive becomes a box in cull coordinates.
//! 2. Top down, a range of boxes is cut where the estimated cost is least: the surface of each side times the number
//!    of leaf blocks it fills (I. Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", 2007). Cuts
//!    lie at multiples of sixteen, so every leaf block but the last is full, and leaf block `k` holds exactly the
//!    primitives `16 k ..` of the leaf order: no index is stored for it. Long ranges are cut between bins (`bins.rs`,
//!    the longest by a sample), short ones are sorted once and cut down to leaf blocks (`sweep.rs`).
//! 3. Where no cut can part the centers, of equal primitives only the one of the lowest index is kept: the others, its
//!    *twins*, come last in the range, and no node or leaf block has a bound for them.
//! 4. A node takes in those of the branches below it that leave the least sum of surfaces (`collapse.rs`).
//!
//! The two sides of a cut are built in parallel. Where things lie depends on the counts alone, never on the order in
//! which threads finish, so the tree is the same for any number of threads.

mod binary;
mod bins;
mod branch;
mod collapse;
mod item;
mod rank;
mod sweep;

use fearless_simd::Level;
use rayon::prelude::*;

use super::crown::Part;
use super::node::{Block, Blocked, Child, Frame, Kind, Node, Region, WIDTH};
use crate::leaf::Leaves;
use crate::simd::{dispatch, prefetch_lines};
use crate::{Shape, Sphere, Triangle};
pub(super) use binary::{Binary, items_of};
pub(super) use bins::{BinCut, part_with_bounds, partition};
use branch::Branch;
use collapse::{Collapsed, collapse};
pub(super) use item::{Extent, Item, bounds_of, shortest_sides};

/// How many primitives ahead the next ones are asked for.
const AHEAD: usize = 16;

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
    /// How many spheres and triangles all regions have together.
    pub(super) room: (usize, usize),
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

impl Trunk {
    /// Gives back the room that nothing needs.
    pub(super) fn finish(mut self) -> Self {
        self.nodes.shrink_to_fit();
        self.regions.shrink_to_fit();
        self.spheres.finish();
        self.triangles.finish();
        self
    }

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
        let room = self.room;
        let rows = rows(self);
        let first = rows.leaves.len();
        if first == 0 {
            rows.make_room(L::count(room), items.len());
        }
        rows.index.extend(items.iter().map(|item| index(item.index())));
        let leaf = |(place, item): (usize, &Item)| {
            if let Some(later) = items.get(place + AHEAD) {
                prefetch_lines(&raw const leaves[later.index() as usize], 1);
            }
            leaves[item.index() as usize]
        };
        rows.leaves.par_extend(items.par_iter().enumerate().map(leaf));
        let block = |(leaves, items): (&[L], &[Item])| {
            let is_met = |lane: usize| items[lane].twin_of().is_none();
            dispatch!(Level::new(), _simd => L::Block::around(leaves, is_met, frame))
        };
        rows.blocks.par_extend(rows.leaves[first..].par_chunks(WIDTH).zip(items.par_chunks(WIDTH)).map(block));
        Some((part, whole))
    }
}

impl<L: Blocked> Rows<L> {
    /// Makes room for all primitives, of which the first region has some. (Each region begins with a block of its own.)
    fn make_room(&mut self, all: usize, first: usize) {
        let room = if first < all { all + all / 32 } else { all };
        self.leaves.reserve_exact(room);
        self.index.reserve_exact(room);
        self.blocks.reserve_exact(room.div_ceil(WIDTH));
    }

    fn finish(&mut self) {
        self.leaves.shrink_to_fit();
        self.index.shrink_to_fit();
        self.blocks.shrink_to_fit();
    }

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
