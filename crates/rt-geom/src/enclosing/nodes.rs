//! The minimal spheres of all nodes of a tree, each over all leaves below it, from the bottom up.
//!
//! The minimal sphere of the children's supports is a lower bound for the node's and nearly always is it. A query for
//! the farthest leaf verifies it: a subtree whose own sphere lies inside is skipped whole. A leaf that sticks out
//! joins the candidates, and the node is solved again.

use std::ops::Range;

use fearless_simd::{Level, Simd};
use glam::DVec3;

use super::basis::Tangent;
use super::certify::U;
use super::few::pivot;
use super::lanes::{LANES, Lanes};
use super::{ORDINARY, by_level, enclosing_sphere};
use crate::Sphere;

/// A node of a tree over spheres in leaf order.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    /// The leaves below the node: a range that is not empty.
    pub(crate) leaves: Range<usize>,
    /// The children: nodes listed before this one, whose leaves together are those of this one; or none.
    pub(crate) children: Range<usize>,
}

/// Returns for each node a sphere that encloses all leaves below it, in exact arithmetic, and is minimal up to a
/// relative excess of 10⁻¹⁴ over what the rounding of the center to doubles costs; `None` where no finite double sphere
/// encloses.
///
/// Children are listed before their parents.
pub(crate) fn enclosing_nodes(leaves: &[Sphere], nodes: &[Node]) -> Vec<Option<Sphere>> {
    by_level!(Level::new(), simd => all(simd, leaves, nodes))
}

/// What is known of a finished node.
#[derive(Clone, Copy)]
struct Done {
    sphere: Option<Sphere>,
    support: [u32; 4],
    support_len: u32,
}

#[inline(always)]
fn all<S: Simd>(simd: S, leaves: &[Sphere], nodes: &[Node]) -> Vec<Option<Sphere>> {
    let mut builder = Builder { leaves, nodes, done: Vec::with_capacity(nodes.len()), stack: Vec::new() };
    for node in nodes {
        let done = builder.node(simd, node);
        builder.done.push(done);
    }
    builder.done.into_iter().map(|done| done.sphere).collect()
}

struct Builder<'a> {
    leaves: &'a [Sphere],
    nodes: &'a [Node],
    done: Vec<Done>,
    /// Nodes still to look at in a query.
    stack: Vec<usize>,
}

/// How many candidates a node may have.
const MOST: usize = 8 * LANES;

impl Builder<'_> {
    #[inline(always)]
    fn node<S: Simd>(&mut self, simd: S, node: &Node) -> Done {
        let range = node.leaves.clone();
        if let [a, b] = &self.leaves[range.clone()]
            && let Some(sphere) = pair(a, b)
        {
            return done(Some(sphere), &[range.start, range.start + 1]);
        }
        let mut these = [range.start; MOST];
        let mut count = 0;
        if range.len() <= LANES {
            for index in range.clone() {
                these[count] = index;
                count += 1;
            }
        } else {
            for child in node.children.clone() {
                let child = &self.done[child];
                for &index in &child.support[..child.support_len as usize] {
                    if count < MOST {
                        these[count] = index as usize;
                        count += 1;
                    }
                }
            }
        }
        for _ in 0..MAX_ROUNDS {
            if count == 0 {
                break;
            }
            let tangent = if count <= LANES {
                self.solve::<S, 1>(simd, &these[..count])
            } else {
                self.solve::<S, 8>(simd, &these[..count])
            };
            let Some((center, radius)) = tangent.as_ref().and_then(|tangent| self.sound(tangent)) else {
                break;
            };
            let tangent = tangent.expect("it was sound");
            let spacing = center.abs().max_element() * (4.0 * U);
            let (far, reach) = self.farthest(node, center, radius);
            if reach <= radius * (1.0 + 16.0 * U) + spacing {
                let sphere = Sphere::new(center, reach * (1.0 + 16.0 * U));
                return done(sphere, tangent.support());
            }
            if count == MOST || these[..count].contains(&far) {
                break;
            }
            these[count] = far;
            count += 1;
        }
        self.whole(range)
    }

    /// The minimal sphere of a few leaves; `None` if it is out of the ordinary range.
    #[inline(always)]
    fn solve<S: Simd, const VECTORS: usize>(&self, simd: S, these: &[usize]) -> Option<Tangent<f64>> {
        let origin = self.leaves[these[0]].center();
        let lanes = Lanes::<S, VECTORS>::new(simd, these.iter().map(|&index| &self.leaves[index]), origin);
        let (far, reach) = lanes.farthest_from_origin(simd);
        if !ORDINARY.contains(&reach) {
            return None;
        }
        Some(pivot(simd, &Tangent::single(these[far]), &lanes, these, self.leaves, origin))
    }

    /// The center, rounded, and the largest reach of the support from it, if the support is balanced: then the sphere is
    /// minimal up to a few units in the last place.
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

    /// The leaf below `node` that reaches farthest from `center`, if one reaches farther than `radius`, and how far; else
    /// any leaf, and `radius`.
    fn farthest(&mut self, node: &Node, center: DVec3, radius: f64) -> (usize, f64) {
        let mut best = (node.leaves.start, radius);
        let reach = |sphere: &Sphere| (sphere.center() - center).length() + sphere.radius();
        let look = |leaves: &[Sphere], range: Range<usize>, best: &mut (usize, f64)| {
            for index in range {
                let reach = reach(&leaves[index]);
                if reach > best.1 {
                    *best = (index, reach);
                }
            }
        };
        if node.children.is_empty() || node.leaves.len() <= LANES {
            look(self.leaves, node.leaves.clone(), &mut best);
            return best;
        }
        self.stack.clear();
        self.stack.extend(node.children.clone());
        while let Some(index) = self.stack.pop() {
            let below = &self.nodes[index];
            if let Some(sphere) = self.done[index].sphere
                && reach(&sphere) <= best.1
            {
                continue;
            }
            if below.children.is_empty() || below.leaves.len() <= LANES {
                look(self.leaves, below.leaves.clone(), &mut best);
            } else {
                self.stack.extend(below.children.clone());
            }
        }
        best
    }

    /// The careful way.
    #[cold]
    #[inline(never)]
    fn whole(&self, range: Range<usize>) -> Done {
        let Some(answer) = enclosing_sphere(&self.leaves[range.clone()]) else {
            return done(None, &[range.start]);
        };
        let mut support = [range.start; 4];
        for (place, &index) in support.iter_mut().zip(answer.support()) {
            *place += index;
        }
        done(Some(answer.sphere), &support[..answer.support().len()])
    }
}

/// No node known needs more than a few rounds.
const MAX_ROUNDS: usize = 32;

/// The minimal sphere of two, up to a few units in the last place; `None` if one lies inside the other or nearly, or far out
/// of the ordinary range.
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
    if good { Sphere::new(center, most * (1.0 + 16.0 * U)) } else { None }
}

fn done(sphere: Option<Sphere>, support: &[usize]) -> Done {
    let mut four = [0; 4];
    for (place, &index) in four.iter_mut().zip(support) {
        *place = u32::try_from(index).expect("a tree has fewer than 2^32 leaves");
    }
    Done { sphere, support: four, support_len: u32::try_from(support.len()).expect("at most four") }
}

#[cfg(test)]
mod tests {
    use super::super::certify::contains_exactly;
    use super::*;

    /// Lists the nodes of the tree that cuts a range into `ways` parts, children first; returns the last one's place.
    fn cut(range: Range<usize>, ways: usize, smallest: usize, nodes: &mut Vec<Node>) {
        let mut level = vec![range];
        let mut levels = Vec::new();
        while !level.is_empty() {
            let mut next = Vec::new();
            let mut made = Vec::new();
            for range in level {
                let from = next.len();
                if range.len() > smallest {
                    let parts = ways.min(range.len());
                    for part in 0..parts {
                        let at = |part: usize| range.start + range.len() * part / parts;
                        next.push(at(part)..at(part + 1));
                    }
                }
                made.push((range, from..next.len()));
            }
            levels.push(made);
            level = next;
        }
        let mut start = 0;
        for made in levels.into_iter().rev() {
            let below = start;
            start = nodes.len();
            for (leaves, children) in made {
                let children =
                    if children.is_empty() { 0..0 } else { below + children.start..below + children.end };
                nodes.push(Node { leaves, children });
            }
        }
    }

    fn leaves(count: usize, kind: usize) -> Vec<Sphere> {
        let mut state = 5_u64;
        let mut unit = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 * (-53.0_f64).exp2()
        };
        let mut leaves: Vec<Sphere> = (0..count)
            .map(|_| {
                let center = DVec3::new(unit(), unit(), unit());
                let center = if kind == 1 { (center * 4.0).round() } else { center };
                let center = if kind == 2 { center + 1e7 } else { center };
                let scale = if kind == 3 { 1e-200 } else { 1.0 };
                Sphere::new(center * scale, 0.1 * unit() * scale).unwrap()
            })
            .collect();
        leaves.sort_by(|a, b| a.center().x.total_cmp(&b.center().x));
        leaves
    }

    #[test]
    fn every_node_encloses_its_leaves_and_is_minimal() {
        for kind in 0..4 {
            for (ways, smallest) in [(2, 1), (3, 2), (16, 16), (16, 1)] {
                let leaves = leaves(1000, kind);
                let mut nodes = Vec::new();
                cut(0..leaves.len(), ways, smallest, &mut nodes);
                let spheres = enclosing_nodes(&leaves, &nodes);
                assert_eq!(spheres.len(), nodes.len());
                for (node, sphere) in nodes.iter().zip(spheres) {
                    let sphere = sphere.unwrap();
                    let below = &leaves[node.leaves.clone()];
                    for leaf in below {
                        assert!(
                            contains_exactly(sphere.center(), sphere.radius(), leaf),
                            "{node:?} {leaf:?}"
                        );
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
