//! The minimal spheres of all nodes of a tree, each over all leaves below it, from the bottom up.
//!
//! The minimal sphere of the children's supports is a lower bound for the node's and nearly always is it. A query for
//! the farthest leaf verifies it: a subtree whose own sphere lies inside is skipped whole. A leaf that sticks out joins
//! the support, and the query is repeated. Where queries would visit much of the subtree, as when all leaves touch one
//! sphere, the leaves are solved as a set of their own.

use std::ops::Range;

use fearless_simd::{Level, Simd, f64x8, prelude::*};
use glam::DVec3;
use rayon::prelude::*;
use rt_math::exact::U;

use super::enclosing_sphere;
use super::pivot::{LANES, SphereLanes, for_eights, measure, pivot};
use super::tangent::{ORDINARY, ORDINARY_SQUARES, Tangent};
use crate::Sphere;
use crate::simd::dispatch;

/// A node of a tree over spheres in leaf order.
#[derive(Clone, Debug)]
pub(crate) struct Subtree {
    /// The leaves below the node: a range that is not empty.
    pub(crate) leaves: Range<usize>,
    /// The children: nodes listed before this one, whose leaves together are those of this one; or none.
    pub(crate) children: Range<usize>,
}

/// Returns for each node a sphere that encloses all leaves below it, in exact arithmetic, and is minimal up to a
/// relative excess of 10⁻¹⁴ over what the rounding of the center to doubles costs; `None` where no finite double sphere
/// encloses.
///
/// Children are listed before their parents, and all that is below a node in one piece. Works in parallel on rayon's
/// current pool; the answer does not depend on the number of threads.
///
/// # Panics
/// With 2^32 leaves or more.
pub(crate) fn enclosing_nodes(leaves: &[Sphere], nodes: &[Subtree]) -> Vec<Option<Sphere>> {
    // Where what is below a node begins; the node itself if nothing is.
    let mut start: Vec<usize> = Vec::with_capacity(nodes.len());
    let mut roots = vec![true; nodes.len()];
    for (index, node) in nodes.iter().enumerate() {
        roots[node.children.clone()].fill(false);
        start.push(start[node.children.clone()].iter().fold(index, |least, &start| least.min(start)));
    }
    // Pieces for one thread each, so small that they stay in its cache; and what is above them.
    let mut pieces: Vec<Range<usize>> = Vec::new();
    let mut above = Vec::new();
    let mut open: Vec<usize> = (0..nodes.len()).filter(|&index| roots[index]).collect();
    while let Some(index) = open.pop() {
        above.push(index);
        let children = nodes[index].children.clone();
        if nodes[index].leaves.len() > PIECE {
            open.extend(children);
        } else if !children.is_empty() {
            pieces.push(start[index]..children.end);
        }
    }
    pieces.sort_unstable_by_key(|piece| piece.start);
    above.sort_unstable();

    let level = Level::new();
    let mut found = vec![NodeSphere::NOTHING; nodes.len()];
    let mut bounds: Vec<Sphere> = nodes.iter().map(|node| leaves[node.leaves.start]).collect();
    let mut parts = Vec::with_capacity(pieces.len());
    let (mut rest, mut at) = ((&mut found[..], &mut bounds[..]), 0);
    for piece in pieces {
        let found = rest.0.split_at_mut(piece.start - at).1.split_at_mut(piece.len());
        let bounds = rest.1.split_at_mut(piece.start - at).1.split_at_mut(piece.len());
        parts.push(Subtrees { leaves, nodes, first: piece.start, found: found.0, bounds: bounds.0 });
        (rest, at) = ((found.1, bounds.1), piece.end);
    }
    parts.into_par_iter().for_each(|mut part| part.solve(level, 0..part.found.len()));
    Subtrees { leaves, nodes, first: 0, found: &mut found, bounds: &mut bounds }.solve(level, above);
    found.into_iter().map(|found| found.sphere).collect()
}

/// A sphere that counts as beyond any limit.
fn everything(center: DVec3) -> Sphere {
    Sphere::new(center, f64::MAX).expect("the center of a sphere is finite, as is the radius")
}

fn short(index: usize) -> u32 {
    u32::try_from(index).expect("a tree has fewer than 2^32 leaves")
}

/// What is known of a finished node.
#[derive(Clone, Copy)]
struct NodeSphere {
    sphere: Option<Sphere>,
    support: [u32; 4],
    support_len: u32,
}

impl NodeSphere {
    const NOTHING: Self = Self { sphere: None, support: [0; 4], support_len: 0 };

    fn new(sphere: Option<Sphere>, support: &[usize]) -> Self {
        let mut four = [0; 4];
        for (place, &index) in four.iter_mut().zip(support) {
            *place = short(index);
        }
        Self { sphere, support: four, support_len: short(support.len()) }
    }
}

/// Nodes that lie together and what is known of them.
struct Subtrees<'a> {
    leaves: &'a [Sphere],
    nodes: &'a [Subtree],
    /// The first node of this part.
    first: usize,
    found: &'a mut [NodeSphere],
    /// The spheres of the finished nodes, without a gap.
    bounds: &'a mut [Sphere],
}

/// Subtrees with at most so many leaves are the work of one thread.
const PIECE: usize = 1 << 14;

/// How many candidates a node may have.
const MOST: usize = 8 * LANES;

/// Nodes with at most so many leaves are solved over all of them.
const SMALL: usize = 2 * LANES;

impl Subtrees<'_> {
    /// Solves the nodes at some places of this part, children first.
    fn solve(&mut self, level: Level, places: impl IntoIterator<Item = usize>) {
        let mut stack = Vec::new();
        for place in places {
            let node = &self.nodes[self.first + place];
            let found = dispatch!(level, simd => self.node(simd, node, &mut stack));
            let any = self.bounds[place].center();
            self.bounds[place] = found.sphere.unwrap_or_else(|| everything(any));
            self.found[place] = found;
        }
    }

    fn node<S: Simd>(&self, simd: S, node: &Subtree, stack: &mut Vec<usize>) -> NodeSphere {
        let range = node.leaves.clone();
        match &self.leaves[range.clone()] {
            [one] => return NodeSphere::new(Some(*one), &[range.start]),
            [a, b] => {
                if let Some(sphere) = pair(a, b) {
                    return NodeSphere::new(Some(sphere), &[range.start, range.start + 1]);
                }
            }
            _ => {}
        }
        let mut these = [range.start; MOST];
        let mut count = 0;
        if range.len() <= SMALL || node.children.is_empty() {
            for (slot, index) in these.iter_mut().zip(range.clone()) {
                *slot = index;
                count += 1;
            }
        } else {
            for child in &self.found[self.places(node)] {
                for &index in &child.support[..child.support_len as usize] {
                    if count < MOST {
                        these[count] = index as usize;
                        count += 1;
                    }
                }
            }
        }
        let these = &these[..count];
        let found = if count <= LANES {
            self.climb::<S, 1>(simd, node, these, stack)
        } else if count <= 2 * LANES {
            self.climb::<S, 2>(simd, node, these, stack)
        } else {
            self.climb::<S, 8>(simd, node, these, stack)
        };
        found.unwrap_or_else(|| self.whole(range))
    }

    /// The places of the children in this part.
    #[inline(always)]
    fn places(&self, node: &Subtree) -> Range<usize> {
        node.children.start - self.first..node.children.end - self.first
    }

    /// From the minimal sphere of some leaves to that of all below the node; `None` if it is out of the ordinary or
    /// takes too many visits.
    fn climb<S: Simd, const VECTORS: usize>(
        &self,
        simd: S,
        node: &Subtree,
        these: &[usize],
        stack: &mut Vec<usize>,
    ) -> Option<NodeSphere> {
        let origin = self.leaves[*these.first()?].center();
        let (lanes, far, square) = simd.vectorize(
            #[inline(always)]
            || {
                let listed = these.iter().map(|&index| &self.leaves[index]);
                let lanes = SphereLanes::<S, VECTORS>::new(simd, listed, origin);
                let (far, square) = lanes.farthest_from_mean(simd);
                (lanes, far, square)
            },
        );
        if !ORDINARY_SQUARES.contains(&square) {
            return None;
        }
        let mut tangent = Tangent::single(these[far]);
        let mut visits = FEW_VISITS + node.leaves.len() / LEAVES_A_VISIT;
        for _ in 0..MAX_ROUNDS {
            pivot(simd, &mut tangent, &lanes, |lane| these[lane], self.leaves, origin);
            let (center, radius) = self.sound(&tangent)?;
            let spacing = center.abs().max_element() * (4.0 * U);
            let (far, reach) = self.farthest(simd, node, center, radius, &mut visits, stack)?;
            if reach <= radius * (1.0 + 16.0 * U) + spacing {
                let sphere = Sphere::new(center, reach * (1.0 + 16.0 * U)).ok();
                return Some(NodeSphere::new(sphere, tangent.support()));
            }
            if tangent.has(far) {
                return None;
            }
            tangent.add(far, self.leaves);
        }
        None
    }

    /// The center, rounded, and the largest reach of the support from it, if the support is balanced: then the sphere
    /// is minimal up to a few units in the last place.
    #[inline(always)]
    fn sound(&self, tangent: &Tangent<f64>) -> Option<(DVec3, f64)> {
        let (center, radius) = tangent.sphere(self.leaves, DVec3::ZERO);
        let center = DVec3::from(center);
        let first = self.leaves[tangent.support()[0]].center();
        let x = DVec3::from(tangent.x);
        let (mut most, mut pull, mut total) = (0.0_f64, DVec3::ZERO, 0.0);
        let (mut highest, mut lowest) = (radius, radius);
        for (place, &index) in tangent.support().iter().enumerate() {
            let leaf = &self.leaves[index];
            most = most.max((leaf.center() - center).length() + leaf.radius());
            let from = x - (leaf.center() - first);
            let distance = from.length();
            let reach = distance + leaf.radius();
            highest = highest.max(reach);
            lowest = lowest.min(reach);
            pull += tangent.weight[place] * from;
            total += tangent.weight[place] * distance;
        }
        // With g the pull and e the spread the excess is at most e + g sqrt(2 (e + 2 g)): see docs/numerics.md.
        let balanced = pull.length() <= total * 1e-10 && highest - lowest <= radius * (16.0 * U);
        (tangent.support().len() == 1 || balanced).then_some((center, most))
    }

    /// The leaf below `node` that reaches farthest from `center`, if one reaches farther than `radius`, and how far;
    /// else any leaf, and `radius`. `None` if that takes more than the given visits of nodes, of which those made are
    /// taken off.
    fn farthest<S: Simd>(
        &self,
        simd: S,
        node: &Subtree,
        center: DVec3,
        radius: f64,
        visits: &mut usize,
        stack: &mut Vec<usize>,
    ) -> Option<(usize, f64)> {
        let mut best = (node.leaves.start, radius);
        let mut node = node;
        stack.clear();
        loop {
            *visits = visits.checked_sub(1)?;
            let leaves = node.leaves.len() <= SMALL || node.children.is_empty();
            let (spheres, first) = if leaves {
                (&self.leaves[node.leaves.clone()], node.leaves.start)
            } else {
                (&self.bounds[self.places(node)], node.children.start)
            };
            let limit = best.1 * (1.0 - 16.0 * U);
            for (block, some) in spheres.chunks(MOST).enumerate() {
                let mut out = beyond(simd, some, center, limit);
                while out != 0 {
                    let at = out.trailing_zeros() as usize;
                    if leaves {
                        let reach = (some[at].center() - center).length() + some[at].radius();
                        if reach > best.1 {
                            best = (first + block * MOST + at, reach);
                        }
                    } else {
                        stack.push(first + block * MOST + at);
                    }
                    out &= out - 1;
                }
            }
            let Some(next) = stack.pop() else { return Some(best) };
            node = &self.nodes[next];
        }
    }

    /// All leaves as a set of their own: the careful way.
    #[cold]
    #[inline(never)]
    fn whole(&self, range: Range<usize>) -> NodeSphere {
        let Some(answer) = enclosing_sphere(&self.leaves[range.clone()]) else {
            return NodeSphere::new(None, &[range.start]);
        };
        let mut support = [range.start; 4];
        for (place, &index) in support.iter_mut().zip(answer.support()) {
            *place += index;
        }
        NodeSphere::new(Some(answer.sphere), &support[..answer.support().len()])
    }
}

/// Which of up to 64 spheres may reach farther than `limit` from `center`, as bits.
#[inline(never)]
fn beyond<S: Simd>(simd: S, spheres: &[Sphere], center: DVec3, limit: f64) -> u64 {
    simd.vectorize(
        #[inline(always)]
        || {
            let (mut found, mut place) = (0, 0);
            for_eights(
                simd,
                spheres,
                center,
                #[inline(always)]
                |eight| {
                    let measure = measure(simd, eight, [0.0; 3], limit);
                    found |= measure.simd_ge(f64x8::splat(simd, 0.0)).to_bitmask() << place;
                    place += LANES;
                },
            );
            // (A lane beyond the end stands for the first of its eight.)
            found & (u64::MAX >> (MOST - spheres.len()))
        },
    )
}

/// For any node so many others may be visited; nearly all take fewer.
const FEW_VISITS: usize = 64;
/// ... and one more for so many leaves: a visit costs about as much as solving these in a set does.
const LEAVES_A_VISIT: usize = 64;

/// No node known needs more than a few rounds.
const MAX_ROUNDS: usize = 32;

/// The minimal sphere of two, up to a few units in the last place; `None` if one lies inside the other or nearly, or
/// far out of the ordinary range.
#[inline(always)]
fn pair(a: &Sphere, b: &Sphere) -> Option<Sphere> {
    let p = b.center() - a.center();
    let length = p.length();
    let share = 0.5 + (b.radius() - a.radius()) * 0.5 / length;
    let center = a.center() + p * share;
    let reach = |sphere: &Sphere| (sphere.center() - center).length() + sphere.radius();
    let most = reach(a).max(reach(b));
    let inner = 1e-3..1.0 - 1e-3;
    let good = inner.contains(&share) && ORDINARY.contains(&length) && ORDINARY.contains(&most);
    if good { Sphere::new(center, most * (1.0 + 16.0 * U)).ok() } else { None }
}

#[cfg(test)]
mod tests {
    use super::super::exact::contains_exactly;
    use super::*;

    /// Lists what is below the node with this range in the tree that cuts ranges into `ways` parts, down to those of at
    /// most `smallest` leaves; returns its children's places.
    fn cut(range: Range<usize>, ways: usize, smallest: usize, nodes: &mut Vec<Subtree>) -> Range<usize> {
        if range.len() <= smallest {
            return 0..0;
        }
        let parts = ways.min(range.len());
        let at = |part: usize| range.start + range.len() * part / parts;
        let parts: Vec<Range<usize>> = (0..parts).map(|part| at(part)..at(part + 1)).collect();
        let below: Vec<Range<usize>> = parts.iter().map(|part| cut(part.clone(), ways, smallest, nodes)).collect();
        let start = nodes.len();
        nodes.extend(parts.into_iter().zip(below).map(|(leaves, children)| Subtree { leaves, children }));
        start..nodes.len()
    }

    fn leaves(count: usize, kind: usize) -> Vec<Sphere> {
        let mut random = oracle::Random::new(5);
        let mut unit = || random.share();
        let mut leaves: Vec<Sphere> = (0..count)
            .map(|_| {
                let center = DVec3::new(unit(), unit(), unit());
                let center = if kind == 1 { (center * 4.0).round() } else { center };
                let center = if kind == 2 { center + 1e7 } else { center };
                let center = if kind == 4 { (center - 0.5).normalize() } else { center };
                let scale = if kind == 3 { 1e-200 } else { 1.0 };
                let radius = if kind == 4 { 0.0 } else { 0.1 * unit() };
                Sphere::new(center * scale, radius * scale).unwrap()
            })
            .collect();
        leaves.sort_by(|a, b| a.center().x.total_cmp(&b.center().x));
        leaves
    }

    #[test]
    fn every_node_encloses_its_leaves_and_is_minimal() {
        for kind in 0..5 {
            for (ways, smallest) in [(2, 1), (3, 2), (16, 16), (16, 1)] {
                let leaves = leaves(1000, kind);
                let mut nodes = Vec::new();
                let children = cut(0..leaves.len(), ways, smallest, &mut nodes);
                nodes.push(Subtree { leaves: 0..leaves.len(), children });
                let spheres = enclosing_nodes(&leaves, &nodes);
                assert_eq!(spheres.len(), nodes.len());
                for (node, sphere) in nodes.iter().zip(spheres) {
                    let sphere = sphere.unwrap();
                    let below = &leaves[node.leaves.clone()];
                    for leaf in below {
                        assert!(contains_exactly(sphere.center(), sphere.radius(), leaf), "{node:?} {leaf:?}");
                    }
                    let minimal = enclosing_sphere(below).unwrap();
                    let spacing = sphere.center().abs().max_element() * 4.0 * U;
                    let limit = minimal.sphere.radius() * (1.0 + 1e-14) + spacing;
                    assert!(sphere.radius() <= limit, "{node:?}: {sphere:?} is not {minimal:?}");
                }
            }
        }
    }
}
