//! One ray through the tree: nearest children first, and nothing that begins beyond the best hit.
//!
//! A node's bounds are tested all at once. Of the children met the nearest is followed and the others go on a stack,
//! farthest first, each with the parameter at which the ray enters it, so that it can be dropped unseen when a better
//! hit has been found since. At a leaf block the survivors of the cull meet the exact kernels. They answer with bounds
//! of `t` and not yet with its last bits; those are only worked out for the winner, and where bounds overlap.

use std::hint::black_box;
use std::ops::Range;

use fearless_simd::Simd;

use super::Bvh;
use super::cull::{Line, meet_balls, meet_boxes};
use super::node::{Child, Kind, WIDTH};
use crate::Ray;
use crate::ray::{Candidate, PreparedRay};
use crate::simd::{has_fma, prefetch_lines};
use crate::{Hit, Shape};

/// What a query did, for reports.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Visits {
    /// Inner nodes: tests of up to sixteen bounds at once.
    pub nodes: usize,
    /// Leaf blocks: tests of up to sixteen primitives' bounds at once.
    pub leaves: usize,
    /// Primitives that met the exact test.
    pub tests: usize,
}

/// A part of the tree that is still to be visited: the key of its entry above its [`Child`].
pub(super) type Pending = u64;

/// Entries that stacks of the usual sizes hold; [`Bvh::stack`] tells what a tree needs. To clear more than is
/// needed takes time.
const SMALL_STACK: usize = 48;
const STACK: usize = 128;

/// With more primitives than this, what a walk reads is no longer in the cache nearby, and is asked for early.
const CACHED: usize = 1 << 15;

#[inline(always)]
fn pending(keys: &[u32; WIDTH], children: &[Child; WIDTH], lane: usize) -> Pending {
    u64::from(keys[lane]) << 32 | u64::from(children[lane].bits())
}

/// What a shape says of a ray, in the arithmetic of the instruction set.
macro_rules! ask {
    ($simd:expr, $shape:expr, $method:ident($($argument:expr),*)) => {
        if has_fma($simd) { $shape.$method::<true>($($argument),*) } else { $shape.$method::<false>($($argument),*) }
    };
}
pub(super) use ask;

/// The best hit so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Best {
    bounds: Candidate,
    /// Its place in leaf order, or [`NOWHERE`](Self::NOWHERE).
    place: usize,
}

impl Best {
    const NOWHERE: usize = usize::MAX;

    pub(super) const NONE: Self =
        Self { bounds: Candidate { low: f64::INFINITY, high: f64::INFINITY }, place: Self::NOWHERE };

    /// For queries that ask no more than whether there is a hit.
    pub(super) const SOME: Self = Self { place: 0, ..Self::NONE };

    #[inline(always)]
    pub(super) fn exists(&self) -> bool {
        self.place != Self::NOWHERE
    }

    /// No candidate beyond this can win.
    #[inline(always)]
    pub(super) fn limit(&self) -> f64 {
        self.bounds.high
    }

    /// Takes the candidate if it is closer; returns whether it did.
    #[inline(always)]
    pub(super) fn offer(&mut self, bounds: Candidate, place: usize, tree: &Bvh, ray: &PreparedRay) -> bool {
        let closer =
            bounds.high < self.bounds.low || (bounds.low <= self.bounds.high && self.settle(bounds, place, tree, ray));
        if closer && bounds.high < self.bounds.low {
            *self = Self { bounds, place };
            prefetch_lines(tree.index.as_ptr().wrapping_add(place), 1);
        }
        closer
    }

    /// The bounds overlap: compares the correctly rounded parameters, then the indices.
    #[cold]
    #[inline(never)]
    fn settle(&mut self, bounds: Candidate, place: usize, tree: &Bvh, ray: &PreparedRay) -> bool {
        if !self.exists() {
            let t = tree.rounded_within(bounds, place, ray);
            *self = Self { bounds: Candidate { low: t, high: t }, place };
            return true;
        }
        let lower = tree.index[place] < tree.index[self.place];
        if tree.placed(place) == tree.placed(self.place) {
            // Twins: the same `t`.
            if lower {
                self.place = place;
            }
            return lower;
        }
        let new = tree.rounded_within(bounds, place, ray);
        let old = tree.rounded_within(self.bounds, self.place, ray);
        let closer = new
            .total_cmp(&old)
            .then(if lower { std::cmp::Ordering::Less } else { std::cmp::Ordering::Greater })
            .is_lt();
        let (t, place) = if closer { (new, place) } else { (old, self.place) };
        *self = Self { bounds: Candidate { low: t, high: t }, place };
        closer
    }

    /// The hit, with its `t` correctly rounded.
    #[inline(always)]
    pub(super) fn hit(&self, tree: &Bvh, ray: &PreparedRay) -> Option<Hit> {
        if !self.exists() {
            return None;
        }
        let t = tree.rounded_within(self.bounds, self.place, ray);
        Some(Hit { index: tree.index[self.place] as usize, t })
    }
}

/// Finds the closest hit, or with `any` some hit, of which then only the existence counts.
///
/// Compiled once for each instruction set, so what it is asked for is told by value.
#[inline(always)]
pub(super) fn cast<S: Simd>(
    simd: S,
    tree: &Bvh,
    ray: &Ray,
    within: Range<f64>,
    any: bool,
    visits: &mut Visits,
) -> Option<Hit> {
    let prepared = PreparedRay::new(ray, within);
    let mut line = Line::EVERYTHING;
    if !line.set(simd, &tree.frame, &prepared) {
        return None;
    }
    let (mut small, mut usual, mut large);
    let stack = if tree.stack <= SMALL_STACK {
        small = [0; SMALL_STACK];
        &mut small[..]
    } else if tree.stack <= STACK {
        usual = [0; STACK];
        &mut usual[..]
    } else {
        large = vec![0; tree.stack];
        &mut large[..]
    };
    let best = walk(simd, tree, &prepared, any, &mut line, stack, visits);
    if any { best.exists().then_some(Hit { index: 0, t: 0.0 }) } else { best.hit(tree, &prepared) }
}

#[inline(always)]
fn walk<S: Simd>(
    simd: S,
    tree: &Bvh,
    ray: &PreparedRay,
    any: bool,
    line: &mut Line,
    stack: &mut [Pending],
    visits: &mut Visits,
) -> Best {
    let mut best = Best::NONE;
    let mut keys = [0; WIDTH];
    let areas = Areas::of(tree);
    let fetch = tree.is_large();
    let mut height = 0;
    let Some(mut at) = tree.root else { return best };
    loop {
        if at.is_inner() {
            let node = &tree.nodes[at.index()];
            visits.nodes += 1;
            let mut met = meet_boxes(simd, black_box(&*line), &node.boxes, &mut keys);
            if met != 0 {
                let next = |met: &mut u32| {
                    let lane = met.trailing_zeros() as usize;
                    *met &= *met - 1;
                    if fetch {
                        areas.prefetch(node.children[lane]);
                    }
                    pending(&keys, &node.children, lane)
                };
                let a = next(&mut met);
                if met == 0 {
                    at = child(a);
                    continue;
                }
                let b = next(&mut met);
                let (a, b) = (a.min(b), a.max(b));
                if met == 0 {
                    stack[height] = b;
                    height += 1;
                    at = child(a);
                    continue;
                }
                let c = next(&mut met);
                let (a, c) = (a.min(c), a.max(c));
                let (b, c) = (b.min(c), b.max(c));
                if met == 0 {
                    stack[height] = c;
                    stack[height + 1] = b;
                    height += 2;
                    at = child(a);
                    continue;
                }
                // Four or more: sorted into place.
                let base = height;
                stack[base] = c;
                stack[base + 1] = b;
                stack[base + 2] = a;
                height += 3;
                while met != 0 {
                    let new = next(&mut met);
                    let mut hole = height;
                    while hole > base && stack[hole - 1] < new {
                        stack[hole] = stack[hole - 1];
                        hole -= 1;
                    }
                    stack[hole] = new;
                    height += 1;
                }
                height -= 1;
                at = child(stack[height]);
                continue;
            }
        } else {
            visits.leaves += 1;
            let before = best.limit();
            let block = at.index();
            if at.kind() == Kind::Spheres {
                // While the bounds are on their way, so are the spheres.
                prefetch_lines(tree.spheres.as_ptr().wrapping_add(block * WIDTH), 8);
                let mut met = meet_balls(simd, black_box(&*line), &tree.sphere_blocks[block]);
                while met != 0 {
                    let place = block * WIDTH + met.trailing_zeros() as usize;
                    met &= met - 1;
                    visits.tests += 1;
                    let sphere = &tree.spheres[place];
                    if any {
                        if ask!(simd, sphere, meets(ray)) {
                            return Best::SOME;
                        }
                    } else if let Some(bounds) = ask!(simd, sphere, candidate(ray, best.limit())) {
                        best.offer(bounds, place, tree, ray);
                    }
                }
            } else {
                if fetch {
                    prefetch_lines(tree.triangles.as_ptr().wrapping_add(block * WIDTH), 18);
                }
                let mut met = meet_boxes(simd, black_box(&*line), &tree.triangle_blocks[block], &mut keys);
                while met != 0 {
                    let place = block * WIDTH + met.trailing_zeros() as usize;
                    met &= met - 1;
                    visits.tests += 1;
                    let triangle = &tree.triangles[place];
                    if any {
                        if ask!(simd, triangle, meets(ray)) {
                            return Best::SOME;
                        }
                    } else if let Some(bounds) = ask!(simd, triangle, candidate(ray, best.limit())) {
                        best.offer(bounds, tree.spheres.len() + place, tree, ray);
                    }
                }
            }
            if best.limit() < before {
                line.shorten(best.limit());
            }
        }
        // Back to the nearest part that is still of interest.
        let last = line.last_key();
        loop {
            if height == 0 {
                return best;
            }
            height -= 1;
            if (stack[height] >> 32) as u32 <= last {
                at = child(stack[height]);
                break;
            }
        }
    }
}

#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "the child is the low half")]
fn child(pending: Pending) -> Child {
    Child::from_bits(pending as u32)
}

/// Where children of each kind lie, to prefetch them without a branch.
#[derive(Clone, Copy)]
pub(super) struct Areas([(*const u8, usize); 4]);

impl Areas {
    #[inline(always)]
    pub(super) fn of(tree: &Bvh) -> Self {
        fn area<T>(items: &[T]) -> (*const u8, usize) {
            (items.as_ptr().cast(), size_of::<T>())
        }
        let nodes = area(&tree.nodes);
        Self([nodes, area(&tree.sphere_blocks), area(&tree.triangle_blocks), nodes])
    }

    /// Asks for what a visit of the child reads first.
    #[inline(always)]
    pub(super) fn prefetch(&self, child: Child) {
        let (start, size) = self.0[child.kind() as usize];
        prefetch_lines(start.wrapping_add(child.index() * size), 7);
    }
}

/// Whether a range holds anything: see `docs/architecture.md` on ranges.
#[inline(always)]
pub(super) fn is_open(within: &Range<f64>) -> bool {
    !within.start.is_nan() && !within.end.is_nan() && within.start.total_cmp(&within.end).is_lt()
}

impl Bvh {
    /// Whether what a walk reads is better asked for early.
    #[inline(always)]
    pub(super) fn is_large(&self) -> bool {
        self.len() > CACHED
    }

    /// The primitive at a place of the leaf order.
    #[cold]
    pub(super) fn placed(&self, place: usize) -> Shape {
        match self.spheres.get(place) {
            Some(&sphere) => Shape::Sphere(sphere),
            None => Shape::Triangle(self.triangles[place - self.spheres.len()]),
        }
    }

    /// The correctly rounded parameter of a candidate, which its bounds tell if they are equal.
    #[inline(always)]
    fn rounded_within(&self, Candidate { low, high }: Candidate, place: usize, ray: &PreparedRay) -> f64 {
        if low.to_bits() == high.to_bits() { low } else { self.rounded(place, ray).expect("a candidate is a hit") }
    }

    /// The correctly rounded parameter of the primitive's closest hit.
    #[inline(always)]
    fn rounded(&self, place: usize, ray: &PreparedRay) -> Option<f64> {
        match self.spheres.get(place) {
            Some(sphere) => sphere.closest(ray.ray, ray.within()),
            None => self.triangles[place - self.spheres.len()].closest(ray.ray, ray.within()),
        }
    }
}
