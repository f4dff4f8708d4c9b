//! From the binary tree to nodes of sixteen children.

use fearless_simd::{Level, Simd, f32x16, prelude::*};

use super::branch::Branch;
use crate::bvh::node::{Child, Kind, Node, WIDTH};
use crate::simd::dispatch;

/// A part of the collapsed tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Collapsed {
    pub(super) child: Child,
    /// How many entries a walk can need to keep for later.
    pub(super) stack: usize,
}

/// Turns the binary tree into nodes of up to sixteen children each, above leaf blocks of the given kind from the given
/// one on, and appends them, parents first.
///
/// Of all ways to do so it takes the one with the least sum of the nodes' surfaces, which is the number of nodes that
/// a random ray is expected to visit.
pub(super) fn collapse(branches: &[Branch], (kind, block): (Kind, usize), nodes: &mut Vec<Node>) -> Collapsed {
    Collapse { branches, costs: costs(branches), kind, nodes }.part(0, block)
}

/// For each branch and `j` the least cost of what is below it as at most `j + 1` children of one node.
fn costs(branches: &[Branch]) -> Vec<[f32; WIDTH]> {
    dispatch!(Level::new(), simd => costs_of(simd, branches))
}

#[inline(always)]
fn costs_of<S: Simd>(simd: S, branches: &[Branch]) -> Vec<[f32; WIDTH]> {
    let mut costs = vec![[0.0; WIDTH]; branches.len()];
    for (at, branch) in branches.iter().enumerate().rev() {
        if branch.first > 0 {
            // For all `j` at once the least of `shares`: nothing before the first cost of the right side counts.
            let left = costs[at + 1];
            let mut right = [f32::INFINITY; 2 * WIDTH];
            right[WIDTH..].copy_from_slice(&costs[at + 2 * branch.first as usize]);
            let mut least = f32x16::splat(simd, f32::INFINITY);
            for (k, left) in left[..WIDTH - 1].iter().enumerate() {
                let right = f32x16::from_slice(simd, &right[WIDTH - 1 - k..2 * WIDTH - 1 - k]);
                least = least.min(right + *left);
            }
            let mut cost: [f32; WIDTH] = least.into();
            cost[0] = branch.half_area() + cost[WIDTH - 1];
            for j in 1..WIDTH {
                cost[j] = cost[j].min(cost[j - 1]);
            }
            costs[at] = cost;
        }
    }
    costs
}

/// The ways to share `j + 1` places between two sides: how many less one go to the first, and the cost.
fn shares(left: &[f32; WIDTH], right: &[f32; WIDTH], j: usize) -> impl Iterator<Item = (usize, f32)> {
    left[..j].iter().zip(right[..j].iter().rev()).map(|(a, b)| a + b).enumerate()
}

struct Collapse<'a> {
    branches: &'a [Branch],
    costs: Vec<[f32; WIDTH]>,
    kind: Kind,
    nodes: &'a mut Vec<Node>,
}

impl Collapse<'_> {
    /// The part below the branch `at`, whose first leaf block is `leaf`. The recursion is no deeper than the binary
    /// tree, so [`MAX_DEPTH`](super::binary::MAX_DEPTH) bounds it.
    fn part(&mut self, at: usize, leaf: usize) -> Collapsed {
        if self.branches[at].first == 0 {
            return Collapsed { child: Child::new(self.kind, leaf), stack: 0 };
        }
        let mut parts = Vec::with_capacity(WIDTH);
        self.share(at, leaf, WIDTH - 1, &mut parts);
        let index = self.nodes.len();
        self.nodes.push(Node::EMPTY);
        let mut stack = 0;
        for (lane, &(at, leaf)) in parts.iter().enumerate() {
            let part = self.part(at, leaf);
            let Branch { low, high, .. } = self.branches[at];
            self.nodes[index].children[lane] = part.child;
            self.nodes[index].boxes.set(lane, low, high);
            stack = stack.max(part.stack);
        }
        // All are stacked for a moment when four or more are met.
        Collapsed { child: Child::new(Kind::Inner, index), stack: stack + parts.len() }
    }

    /// Collects the children that make up the branch `at` at the least cost, sharing `j + 1` places between its sides.
    fn share(&self, at: usize, leaf: usize, j: usize, parts: &mut Vec<(usize, usize)>) {
        let first = self.branches[at].first as usize;
        let (left, right) = (at + 1, at + 2 * first);
        let cheapest = shares(&self.costs[left], &self.costs[right], j).min_by(|a, b| a.1.total_cmp(&b.1));
        let (k, _) = cheapest.expect("two places or more");
        self.fill(left, leaf, k, parts);
        self.fill(right, leaf + first, j - 1 - k, parts);
    }

    /// Collects the branch `at` as at most `j + 1` children.
    fn fill(&self, at: usize, leaf: usize, mut j: usize, parts: &mut Vec<(usize, usize)>) {
        let cost = &self.costs[at];
        while j > 0 && cost[j - 1] <= cost[j] {
            j -= 1;
        }
        if j == 0 { parts.push((at, leaf)) } else { self.share(at, leaf, j, parts) }
    }
}

#[cfg(test)]
mod tests {
    use oracle::Random;

    use super::*;

    /// A random binary tree over some leaf blocks, in preorder.
    fn branches(leaves: u32, random: &mut Random, all: &mut Vec<Branch>) {
        let at = all.len();
        all.push(Branch { low: [0.0; 3], high: [0; 3].map(|_| random.below(100) as f32), first: 0 });
        if leaves > 1 {
            let first = 1 + u32::try_from(random.below(leaves as usize - 1)).unwrap();
            all[at].first = first;
            branches(first, random, all);
            branches(leaves - first, random, all);
        }
    }

    /// The least sum of surfaces of the nodes below a branch, itself included: all ways to choose at most sixteen
    /// children.
    fn least(branches: &[Branch], at: usize) -> f32 {
        if branches[at].first == 0 {
            return 0.0;
        }
        let cheapest = ways(branches, at, false).into_iter().filter(|(children, _)| *children <= WIDTH);
        branches[at].half_area() + cheapest.map(|(_, cost)| cost).fold(f32::INFINITY, f32::min)
    }

    /// Every way to cover a branch by branches below it, or by itself: how many, and their least cost.
    fn ways(branches: &[Branch], at: usize, itself: bool) -> Vec<(usize, f32)> {
        let mut ways = if itself { vec![(1, least(branches, at))] } else { Vec::new() };
        if branches[at].first > 0 {
            let right = at + 2 * branches[at].first as usize;
            for (a, x) in self::ways(branches, at + 1, true) {
                ways.extend(self::ways(branches, right, true).into_iter().map(|(b, y)| (a + b, x + y)));
            }
        }
        ways
    }

    #[test]
    fn the_collapse_is_the_cheapest_of_all() {
        let random = &mut Random::new(8);
        for leaves in [2, 5, 16, 17, 17, 18, 18, 19, 20] {
            let mut binary = Vec::new();
            branches(leaves, random, &mut binary);
            let mut nodes = Vec::new();
            let root = collapse(&binary, (Kind::Spheres, 0), &mut nodes);
            assert_eq!(root.child.kind(), Kind::Inner);
            // The surface of the root, and of the box of every child that is a node.
            let inner = |node: &Node| {
                let children = node.children.iter().enumerate().filter(|(_, child)| child.kind() == Kind::Inner);
                let used = children.filter(|(lane, _)| node.boxes.0[0].0[*lane] < f32::INFINITY);
                used.map(|(lane, _)| {
                    let high: [f32; 3] = std::array::from_fn(|axis| node.boxes.0[axis + 3].0[lane]);
                    Branch { low: [0.0; 3], high, first: 1 }.half_area()
                })
                .sum::<f32>()
            };
            let cost = binary[0].half_area() + nodes.iter().map(inner).sum::<f32>();
            // (Whole numbers: sums are exact.)
            assert_eq!(cost, least(&binary, 0), "{leaves} {binary:?}");
            assert!(leaves > 16 || nodes.len() == 1);
        }
    }
}
