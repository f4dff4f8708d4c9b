//! One ray through the tree: nearest children first, and nothing that begins beyond the best hit.
//!
//! A node's bounds are tested all at once. Of the children met the nearest is followed and the others go on a stack,
//! farthest first, each with the parameter at which the ray enters it, so that it can be dropped unseen when a better
//! hit has been found since. At a leaf block the survivors of the cull meet the exact kernels.

use fearless_simd::Simd;

use super::Bvh;
use super::crown::{Crown, Line64, Part, Tour};
use super::cull::{CullRay, Culled, meet_boxes};
use super::node::{Balls, Blocked, Boxes, Child, Kind, Node, Region, WIDTH};
use crate::leaf::{Leaves, Query};
use crate::ray::{PreparedRay, is_open};
use crate::simd::{has_fma, prefetch_lines};
use crate::{Ray, Sphere, Triangle, Visits};

/// A part of the tree that is still to be visited: the key of its entry above its [`Child`].
pub(super) type Pending = u64;

/// Entries of a stack with which a walk begins; [`Bvh::stack`] tells how many it can need. To clear 128 of them took 7 %
/// of the time of a camera's ray to 100,000 triangles.
const SMALL_STACK: usize = 48;

/// With more primitives than this, what a walk reads is no longer in the cache nearby, and is asked for early.
const NEARBY: usize = 1 << 15;

#[inline(always)]
fn pending(keys: &[u32; WIDTH], children: &[Child; WIDTH], lane: usize) -> Pending {
    u64::from(keys[lane]) << 32 | u64::from(children[lane].bits())
}

/// Hands a primitive to the query, in the arithmetic of the instruction set.
#[inline(always)]
pub(super) fn meet<S: Simd, Q: Query, L: Blocked>(
    simd: S,
    query: &mut Q,
    place: usize,
    leaves: &Leaves,
    ray: &PreparedRay,
) {
    let leaf = &L::of(leaves)[place];
    let place = L::first_place(leaves) + place;
    if has_fma(simd) {
        query.meet::<true, _>(leaf, place, leaves, ray);
    } else {
        query.meet::<false, _>(leaf, place, leaves, ray);
    }
}

/// Answers a query for one ray; compiled once for each instruction set and query.
#[inline(always)]
pub(super) fn cast<S: Simd, Q: Query>(
    simd: S,
    tree: &Bvh,
    ray: &Ray,
    (start, end): (f64, f64),
    mut query: Q,
    visits: &mut Visits,
) -> Q::Answer {
    let is_open = is_open(&(start..end));
    let prepared = PreparedRay::new(ray, start..end);
    if !is_open {
        // Nothing is met.
    } else if let Some(crown) = &tree.crown {
        travel(simd, tree, crown, &prepared, &mut query, visits);
    } else if let Some(region) = tree.regions.first() {
        visit(simd, tree, region, &prepared, &mut query, visits);
    }
    query.answer(&tree.leaves, &prepared)
}

/// Takes a ray through all regions below a crown that it may meet. (With the instruction set again, because it is not
/// inlined: a scene of one scale shall not pay for it.)
#[cold]
#[inline(never)]
fn travel<S: Simd, Q: Query>(
    simd: S,
    tree: &Bvh,
    crown: &Crown,
    prepared: &PreparedRay,
    query: &mut Q,
    visits: &mut Visits,
) {
    simd.vectorize(
        #[inline(always)]
        || {
            let line = Line64::new(prepared);
            if !crown.is_met(&line) {
                return;
            }
            let mut tour = Tour::new(crown, line);
            while let Some(region) = after(simd, &mut tour, tree, crown, prepared, query, visits) {
                visit(simd, tree, region, prepared, query, visits);
            }
        },
    );
}

/// Takes a ray through the crown, with the primitives that stand there alone, to the next region that it may meet.
#[cold]
#[inline(never)]
pub(super) fn next_region<'a, S: Simd, Q: Query>(
    simd: S,
    tour: &mut Tour,
    tree: &'a Bvh,
    ray: &PreparedRay,
    query: &mut Q,
    visits: &mut Visits,
) -> Option<&'a Region> {
    let crown = tree.crown.as_ref()?;
    simd.vectorize(
        #[inline(always)]
        || after(simd, tour, tree, crown, ray, query, visits),
    )
}

#[inline(always)]
fn after<'a, S: Simd, Q: Query>(
    simd: S,
    tour: &mut Tour,
    tree: &'a Bvh,
    crown: &Crown,
    ray: &PreparedRay,
    query: &mut Q,
    visits: &mut Visits,
) -> Option<&'a Region> {
    let leaves = &tree.leaves;
    while !query.is_settled() {
        match tour.next(simd, crown, Q::ANY, query.limit(), visits)? {
            Part::Region(index) => return tree.regions.get(index as usize),
            Part::Sphere(place) => meet::<S, Q, Sphere>(simd, query, place as usize, leaves, ray),
            Part::Triangle(place) => meet::<S, Q, Triangle>(simd, query, place as usize, leaves, ray),
            Part::Node(_) => unreachable!("a tour goes through nodes"),
        }
        visits.tests += 1;
    }
    None
}

/// Takes a ray through a region.
#[inline(always)]
pub(super) fn visit<S: Simd, Q: Query>(
    simd: S,
    tree: &Bvh,
    region: &Region,
    prepared: &PreparedRay,
    query: &mut Q,
    visits: &mut Visits,
) {
    let mut line = CullRay::NOTHING;
    if !line.set(simd, &region.frame, prepared, tree.has_balls()) {
        return;
    }
    if tree.crown.is_some() {
        line.shorten(query.limit());
    }
    walk(simd, tree, region.root, prepared, query, &mut line, visits);
}

#[inline(always)]
fn walk<S: Simd, Q: Query>(
    simd: S,
    tree: &Bvh,
    root: Child,
    ray: &PreparedRay,
    query: &mut Q,
    line: &mut CullRay,
    visits: &mut Visits,
) {
    let (mut small, mut large) = ([0; SMALL_STACK], Vec::new());
    let (mut stack, mut spare) = (&mut small[..], Some(&mut large));
    let mut keys = [0; WIDTH];
    let areas = Areas::of(tree);
    let fetch = tree.is_large();
    let mut height = 0;
    let mut at = root;
    loop {
        if at.is_inner() {
            let node = &tree.nodes[at.index()];
            visits.nodes += 1;
            let met = meet_boxes(simd, opaque(line), &node.boxes, &mut keys);
            if met != 0 {
                if height + WIDTH > stack.len()
                    && let Some(large) = spare.take()
                {
                    stack = deeper(stack, large, tree.stack);
                }
                at = nearest(node, &keys, met, fetch.then_some(&areas), stack, &mut height);
                continue;
            }
        } else {
            visits.nodes += 1;
            let before = query.limit();
            match at.kind() {
                Kind::Spheres => {
                    // While the bounds are on their way, so are the spheres.
                    prefetch_lines(tree.leaves.spheres.as_ptr().wrapping_add(at.index() * WIDTH), 8);
                    block(simd, &tree.sphere_blocks, at.index(), query, tree, line, ray, visits);
                }
                _ => {
                    if fetch {
                        prefetch_lines(tree.leaves.triangles.as_ptr().wrapping_add(at.index() * WIDTH), 18);
                    }
                    block(simd, &tree.triangle_blocks, at.index(), query, tree, line, ray, visits);
                }
            }
            if query.is_settled() {
                return;
            }
            if query.limit() < before {
                line.shorten(query.limit());
            }
        }
        match next(stack, &mut height, line.last_key()) {
            Some(next) => at = next,
            None => return,
        }
    }
}

/// The nearest pending part, if its key is at most `last`; farther ones are dropped.
#[inline(always)]
pub(super) fn next(stack: &[Pending], height: &mut usize, last: u32) -> Option<Child> {
    while *height > 0 {
        *height -= 1;
        let pending = stack[*height];
        if (pending >> 32) as u32 <= last {
            return Some(child(pending));
        }
    }
    None
}

/// The stack with room for `depth` entries.
#[cold]
#[inline(never)]
fn deeper<'a>(stack: &[Pending], large: &'a mut Vec<Pending>, depth: usize) -> &'a mut [Pending] {
    large.extend_from_slice(stack);
    large.resize(depth.max(stack.len()), 0);
    large
}

/// The nearest of the children met, of which there is one; the others go on the stack, farthest first. What a visit of
/// them reads first is asked for.
#[inline(always)]
pub(super) fn nearest(
    node: &Node,
    keys: &[u32; WIDTH],
    mut met: u32,
    areas: Option<&Areas>,
    stack: &mut [Pending],
    height: &mut usize,
) -> Child {
    let nearest = sorted(
        #[inline(always)]
        || {
            let lane = met.trailing_zeros() as usize;
            met &= met - 1;
            if let Some(areas) = areas {
                areas.prefetch(node.children[lane]);
            }
            (pending(keys, &node.children, lane), met == 0)
        },
        stack,
        height,
    );
    child(nearest)
}

/// The least of what `next` gives, each with whether it is the last; the others go on the stack, the greatest first.
#[inline(always)]
fn sorted(mut next: impl FnMut() -> (Pending, bool), stack: &mut [Pending], height: &mut usize) -> Pending {
    let (a, last) = next();
    if last {
        return a;
    }
    let (b, last) = next();
    let (a, b) = (a.min(b), a.max(b));
    if last {
        stack[*height] = b;
        *height += 1;
        return a;
    }
    let (c, mut last) = next();
    let (a, c) = (a.min(c), a.max(c));
    let (b, c) = (b.min(c), b.max(c));
    if last {
        stack[*height] = c;
        stack[*height + 1] = b;
        *height += 2;
        return a;
    }
    // Four or more: sorted into place.
    let base = *height;
    stack[base..base + 3].copy_from_slice(&[c, b, a]);
    let mut top = base + 3;
    while !last {
        let new;
        (new, last) = next();
        let mut hole = top;
        while hole > base && stack[hole - 1] < new {
            stack[hole] = stack[hole - 1];
            hole -= 1;
        }
        stack[hole] = new;
        top += 1;
    }
    *height = top - 1;
    stack[*height]
}

/// Hides from the compiler that the ray is the same in every step. It would else spread the ray's thirty numbers over
/// vectors before the loop, and spill them: 3 to 11 % slower for single rays (`closest`, uniform, packed and nested
/// spheres, 64 to 1e5, AVX2 on a Zen 3).
#[inline(always)]
fn opaque(ray: &CullRay) -> &CullRay {
    std::hint::black_box(ray)
}

/// The primitives of a leaf block that the cull leaves.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "a part of the walk, inlined into it")]
fn block<S: Simd, Q: Query, B: Culled>(
    simd: S,
    blocks: &[B],
    index: usize,
    query: &mut Q,
    tree: &Bvh,
    line: &CullRay,
    ray: &PreparedRay,
    visits: &mut Visits,
) {
    let mut met = blocks[index].meet(simd, opaque(line));
    while met != 0 {
        let place = index * WIDTH + met.trailing_zeros() as usize;
        met &= met - 1;
        visits.tests += 1;
        meet::<S, Q, B::Leaf>(simd, query, place, &tree.leaves, ray);
        if query.is_settled() {
            return;
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
pub(super) struct Areas {
    nodes: *const u8,
    spheres: *const u8,
    triangles: *const u8,
}

impl Areas {
    #[inline(always)]
    pub(super) fn of(tree: &Bvh) -> Self {
        Self {
            nodes: tree.nodes.as_ptr().cast(),
            spheres: tree.sphere_blocks.as_ptr().cast(),
            triangles: tree.triangle_blocks.as_ptr().cast(),
        }
    }

    /// Asks for what a visit of the child reads first.
    #[inline(always)]
    pub(super) fn prefetch(&self, child: Child) {
        let (start, size) = match child.kind() {
            Kind::Inner => (self.nodes, size_of::<Node>()),
            Kind::Spheres => (self.spheres, size_of::<Balls>()),
            Kind::Triangles => (self.triangles, size_of::<Boxes>()),
        };
        prefetch_lines(start.wrapping_add(child.index() * size), 7);
    }
}

impl Bvh {
    /// Whether what a walk reads is better asked for early.
    #[inline(always)]
    pub(super) fn is_large(&self) -> bool {
        self.len() > NEARBY
    }

    /// Whether there are leaf blocks of spheres.
    #[inline(always)]
    pub(super) fn has_balls(&self) -> bool {
        !self.sphere_blocks.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use oracle::Random;

    use super::*;
    use crate::{AHEAD, Bvh};

    /// Through balls that all overlap a ray meets every child, so that more is pending than a stack begins with.
    #[test]
    fn a_stack_grows_where_every_child_is_met() {
        let random = &mut Random::new(4);
        let balls: Vec<Sphere> = (0..5_000).map(|_| Sphere::new(random.point(), 8.0).unwrap()).collect();
        let tree = Bvh::new(balls.clone(), vec![]);
        assert!(tree.stack > SMALL_STACK, "{}", tree.stack);
        for _ in 0..20 {
            let origin = 20.0 * random.direction();
            let ray = Ray::new(origin, 0.1 * random.direction() - origin).unwrap();
            let expected = balls.iter().filter_map(|ball| ball.closest(&ray, AHEAD)).min_by(f64::total_cmp);
            assert_eq!(tree.closest(&ray, AHEAD).map(|hit| hit.t), expected);
        }
        assert_eq!(deeper(&[1, 2, 3], &mut Vec::new(), 5), [1, 2, 3, 0, 0]);
    }
}
