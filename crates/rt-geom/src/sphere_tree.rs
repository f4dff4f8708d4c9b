//! The report's bounding-sphere tree: a list is halved again and again, and every part has its minimal sphere.
//!
//! The root holds all `n` primitives; its two children hold the first `⌊n/2⌋` and the rest, and so on. A query walks
//! the minimal spheres: a part is visited if the ray may meet its sphere before the best hit so far, the nearest part
//! first. That test is made in plain doubles with a proved margin, so it may visit too much and never loses a hit; the
//! exact kernels decide about the primitives alone. One step tests eight spheres at once: those of the parts three
//! halvings below, or of the primitives of a part that holds no more than eight.
//!
//! Halving a list halves space only as far as the list is sorted in space. [`SphereTree::new`] takes the list as it
//! is, [`SphereTree::sorted`] sorts it along a Hilbert curve first (`hilbert.rs`).
//!
//! Where the spheres of a part would cost more tests than they are expected to save, its primitives are tested one
//! after the other. A ray that meets a sphere of radius `R` meets a sphere of radius `r` within it with the probability
//! `r²/R²`, if it comes from anywhere (J. Goldsmith, J. Salmon, "Automatic Creation of Object Hierarchies for Ray
//! Tracing", 1987).

use std::ops::Range;

use fearless_simd::{Simd, f64x8, prelude::*};
use rt_math::exact::{U, power_of_two, power_of_two_near_inverse};

use crate::enclosing::nodes::{Subtree, enclosing_nodes};
use crate::hilbert;
use crate::leaf::{Any, Closest, Leaves, Query};
use crate::ray::{PreparedRay, is_open, larger, max_abs};
use crate::simd::{dispatch, prefetch_lines};
use crate::{Hit, Ray, Shape, Sphere, Triangle, Visits, enclosing_sphere};

/// The tree by index halves, over spheres and triangles (spheres first), with the plain loop's answers bit for bit.
///
/// It is the tree of the report, and what [`Bvh`](crate::Bvh), the faster one, is compared with.
///
/// ```
/// use glam::DVec3;
/// use rt_geom::{Hit, Ray, Sphere, SphereTree};
/// let row = |i: i32| Sphere::new(DVec3::new(3.0 * f64::from(i), 0.0, -5.0), 1.0).unwrap();
/// let tree = SphereTree::sorted((0..64).map(row).collect(), Vec::new());
/// let ray = Ray::new(DVec3::ZERO, DVec3::NEG_Z).unwrap();
/// let (hit, visits) = tree.closest_counted(&ray, 0.0..f64::INFINITY);
/// assert_eq!(hit, Some(Hit { index: 0, t: 4.0 }));
/// assert!(visits.nodes + visits.tests < 20, "a plain loop makes 64 tests, the tree {visits:?}");
/// ```
#[derive(Clone, Debug)]
pub struct SphereTree {
    leaves: Leaves,
    nodes: Vec<Node>,
    root: Child,
    /// The power of two that brings the scene's largest coordinate near 1.
    scale: f64,
}

/// Parts of the list with the minimal sphere of each; scaled. A radius is infinite where no finite sphere encloses.
/// Six whole cache lines.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
struct Node {
    center: [[f64; WIDTH]; 3],
    radius: [f64; WIDTH],
    children: [Child; WIDTH],
    /// How many parts there are.
    len: usize,
}

/// A node, or primitives at neighbouring places that are tested one after the other.
#[derive(Clone, Copy, Debug)]
struct Child {
    first: u32,
    /// How many primitives; 0 for a node.
    count: u32,
}

/// As many parts as [`LEVELS`] halvings make. A part of no more primitives is not halved: they are its parts.
const WIDTH: usize = 8;
const LEVELS: u32 = 3;

/// What a visit of a node costs, in tests of primitives. So many primitives and fewer are never worth a node.
const NODE_COST: f64 = 4.0;

/// The rounding errors of a sphere's test, relative to its radius and its distance from the ray's origin:
/// `docs/numerics.md`, lemma 9.8.
const MARGIN: f64 = 64.0 * U;

/// The rounding errors of numbers that underflow, and of `t`: `2^-100`.
const UNDERFLOW: f64 = power_of_two(-100);

/// A unit of `t` must be as long as this or its reciprocal in scaled coordinates, or every `t` counts: `2^960`.
const LONGEST: f64 = power_of_two(960);

/// The most parts that wait for a visit: no more than [`WIDTH`] for each node on the way down. Fewer than 2^32
/// primitives are halved 29 times until no part has more than [`WIDTH`] of them, so that there are eleven nodes: of the
/// heights 0, 3, .., 27, and the root.
const STACK: usize = 11 * WIDTH;

impl SphereTree {
    /// Builds the tree over the list as it is, in parallel on rayon's current pool. Any input will do, also none at
    /// all.
    ///
    /// # Panics
    /// With 2^32 primitives or more.
    #[must_use]
    pub fn new(spheres: Vec<Sphere>, triangles: Vec<Triangle>) -> Self {
        let bounds = bounds_of(&spheres, &triangles);
        let index = (0..short(bounds.len())).collect();
        Self::build(Leaves::new(spheres, triangles, index), &bounds)
    }

    /// Builds the tree over the list sorted along a Hilbert curve through the centers, so that halves of the list lie
    /// in different parts of space. Answers speak of the list as it was.
    ///
    /// # Panics
    /// With 2^32 primitives or more.
    #[must_use]
    pub fn sorted(spheres: Vec<Sphere>, triangles: Vec<Triangle>) -> Self {
        let bounds = bounds_of(&spheres, &triangles);
        let mut index: Vec<u32> = (0..short(bounds.len())).collect();
        let (of_spheres, of_triangles) = index.split_at_mut(spheres.len());
        for part in [of_spheres, of_triangles] {
            hilbert::sort(part, &|i| bounds[i as usize].map_or(glam::DVec3::ZERO, |sphere| sphere.center()));
        }
        let bounds: Vec<Option<Sphere>> = index.iter().map(|&i| bounds[i as usize]).collect();
        let (of_spheres, of_triangles) = index.split_at(spheres.len());
        let first = spheres.len();
        let spheres = of_spheres.iter().map(|&i| spheres[i as usize]).collect();
        let triangles = of_triangles.iter().map(|&i| triangles[i as usize - first]).collect();
        Self::build(Leaves::new(spheres, triangles, index), &bounds)
    }

    fn build(leaves: Leaves, bounds: &[Option<Sphere>]) -> Self {
        let mut parts = Vec::with_capacity(bounds.len() / 2);
        halve(0..bounds.len(), &mut parts);
        let spheres = spheres_of_parts(&parts, bounds);
        // The last part is the whole. (None: an empty tree, or one that no finite sphere encloses.)
        let largest = match spheres.last().copied().flatten() {
            Some(sphere) => max_abs(sphere.center()) / 2.0 + sphere.radius() / 2.0,
            None => f64::MAX,
        };
        let scale = 0.5 * power_of_two_near_inverse(largest);
        let root = Child { first: 0, count: short(leaves.len()) };
        let mut tree = Self { leaves, nodes: Vec::new(), root, scale };
        if let Some(whole) = parts.len().checked_sub(1) {
            let plan = tree.plan(&parts, &spheres, bounds);
            let (parts, spheres, plan) = (&parts, &spheres, &plan);
            let mut planting = Planting { parts, spheres, bounds, plan, scale, nodes: Vec::new() };
            tree.root = planting.plant(whole);
            tree.nodes = planting.nodes;
        }
        tree
    }

    /// What becomes of each part, whichever costs less.
    ///
    /// Of the parts that are split, those become nodes that lie a multiple of [`LEVELS`] halvings above the last ones,
    /// so that the many nodes at the bottom are full.
    fn plan(&self, parts: &[Subtree], spheres: &[Option<Sphere>], bounds: &[Option<Sphere>]) -> Vec<Plan> {
        let radius = |sphere: Option<Sphere>| sphere.map_or(f64::INFINITY, |sphere| sphere.radius());
        let equal = |a: usize, b: usize| self.leaves.placed(a) == self.leaves.placed(b);
        let mut costs = vec![0.0; parts.len()];
        let mut plan: Vec<Plan> = Vec::with_capacity(parts.len());
        for (at, Subtree { leaves, children: halves }) in parts.iter().enumerate() {
            // How often what is within is met by a ray that meets the part. NaN, of two that are infinite or 0, counts
            // as 1.
            let share = |within: Option<Sphere>| {
                let ratio = radius(within) / radius(spheres[at]);
                (ratio * ratio).min(1.0)
            };
            let height = halves.clone().map(|half| plan[half].height() + 1).max().unwrap_or(0);
            let is_node = height % LEVELS == 0 || at + 1 == parts.len();
            let (below, all_equal) = if halves.is_empty() {
                let below: f64 = leaves.clone().map(|place| share(bounds[place])).sum();
                (below, leaves.clone().all(|place| equal(leaves.start, place)))
            } else {
                let same = |half: usize| plan[half] == Plan::Run(1) && equal(leaves.start, parts[half].leaves.start);
                let below: f64 = halves.clone().map(|half| share(spheres[half]) * costs[half]).sum();
                (below, halves.clone().all(same))
            };
            let (split, run) = (if is_node { NODE_COST + below } else { below }, leaves.len() as f64);
            let (cost, planned) = if all_equal {
                // The first, whose index is the lowest, answers for all.
                (1.0, Plan::Run(1))
            } else if run <= split {
                (run, Plan::Run(short(leaves.len())))
            } else {
                (split, Plan::Split(height))
            };
            costs[at] = cost;
            plan.push(planned);
        }
        plan
    }

    /// How many primitives the tree holds.
    #[must_use]
    pub fn len(&self) -> usize {
        self.leaves.len()
    }

    /// Whether it holds none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the primitive with this index: spheres as listed, then triangles as listed.
    ///
    /// # Panics
    /// If `index >= self.len()`.
    #[must_use]
    pub fn shape(&self, index: usize) -> Shape {
        self.leaves.shape(index)
    }

    /// Returns the closest hit with its `t` in the range: the smallest `t`, and of equal `t` the lowest index.
    #[must_use]
    pub fn closest(&self, ray: &Ray, within: Range<f64>) -> Option<Hit> {
        closest(self, ray, within.start, within.end).0
    }

    /// As [`closest`](Self::closest), with what the query did.
    #[must_use]
    pub fn closest_counted(&self, ray: &Ray, within: Range<f64>) -> (Option<Hit>, Visits) {
        closest(self, ray, within.start, within.end)
    }

    /// Returns whether anything is hit with its `t` in the range.
    #[must_use]
    pub fn any(&self, ray: &Ray, within: Range<f64>) -> bool {
        any(self, ray, within.start, within.end)
    }
}

/// What becomes of a part.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Plan {
    /// So many of its primitives are tested one after the other.
    Run(u32),
    /// Its halves are visited in its place, or its primitives one by one; so many halvings lie below.
    Split(u32),
}

impl Plan {
    fn height(self) -> u32 {
        match self {
            Self::Run(_) => 0,
            Self::Split(height) => height,
        }
    }
}

/// The parts, of which nodes are made, with the spheres of the parts and of the primitives, and the nodes so far.
struct Planting<'a> {
    parts: &'a [Subtree],
    spheres: &'a [Option<Sphere>],
    bounds: &'a [Option<Sphere>],
    plan: &'a [Plan],
    scale: f64,
    nodes: Vec<Node>,
}

impl Planting<'_> {
    /// Appends the nodes of a part that is visited; the recursion is no deeper than the tree.
    fn plant(&mut self, at: usize) -> Child {
        let part = &self.parts[at];
        if let Plan::Run(count) = self.plan[at] {
            return Child { first: short(part.leaves.start), count };
        }
        let child = Child { first: short(self.nodes.len()), count: 0 };
        let (center, radius) = ([[0.0; WIDTH]; 3], [0.0; WIDTH]);
        self.nodes.push(Node { center, radius, children: [child; WIDTH], len: 0 });
        if part.children.is_empty() {
            for place in part.leaves.clone() {
                self.add(child.first, self.bounds[place], Child { first: short(place), count: 1 });
            }
        } else {
            self.gather(child.first, at);
        }
        child
    }

    /// Adds to a node the halves of a part, or what stands for them.
    fn gather(&mut self, node: u32, at: usize) {
        for half in self.parts[at].children.clone() {
            match self.plan[half] {
                Plan::Split(height) if height % LEVELS != 0 => self.gather(node, half),
                _ => {
                    let child = self.plant(half);
                    self.add(node, self.spheres[half], child);
                }
            }
        }
    }

    /// Adds a part with its sphere to a node.
    fn add(&mut self, node: u32, sphere: Option<Sphere>, child: Child) {
        let (center, radius) = match sphere {
            Some(sphere) => (sphere.center() * self.scale, sphere.radius() * self.scale),
            None => (glam::DVec3::ZERO, f64::INFINITY),
        };
        let node = &mut self.nodes[node as usize];
        for axis in 0..3 {
            node.center[axis][node.len] = center[axis];
        }
        node.radius[node.len] = radius;
        node.children[node.len] = child;
        node.len += 1;
    }
}

/// Lists the parts below a range of places, the halves of a part next to each other, and the range itself last.
fn halve(range: Range<usize>, parts: &mut Vec<Subtree>) {
    fn below(range: Range<usize>, parts: &mut Vec<Subtree>) -> Range<usize> {
        if range.len() <= WIDTH {
            return 0..0;
        }
        let middle = range.start + range.len() / 2;
        let halves = [range.start..middle, middle..range.end];
        let listed = halves.clone().map(|half| below(half, parts));
        let start = parts.len();
        parts.extend(halves.into_iter().zip(listed).map(|(leaves, children)| Subtree { leaves, children }));
        start..parts.len()
    }
    if !range.is_empty() {
        let children = below(range.clone(), parts);
        parts.push(Subtree { leaves: range, children });
    }
}

/// The sphere of each primitive: of a triangle the minimal one, `None` if it has no finite radius.
fn bounds_of(spheres: &[Sphere], triangles: &[Triangle]) -> Vec<Option<Sphere>> {
    let minimal = |triangle: &Triangle| {
        let corner = |v| Sphere::new(v, 0.0).expect("vertices are finite");
        enclosing_sphere(&triangle.vertices().map(corner)).map(|enclosing| enclosing.sphere)
    };
    spheres.iter().copied().map(Some).chain(triangles.iter().map(minimal)).collect()
}

/// The minimal sphere of each part; `None` where no finite sphere encloses.
fn spheres_of_parts(parts: &[Subtree], bounds: &[Option<Sphere>]) -> Vec<Option<Sphere>> {
    let point = Sphere::new(glam::DVec3::ZERO, 0.0).expect("a valid sphere");
    let leaves: Vec<Sphere> = bounds.iter().map(|bound| bound.unwrap_or(point)).collect();
    // How many primitives before each place have no sphere.
    let mut without = vec![0];
    without.extend(bounds.iter().scan(0, |count, bound| {
        *count += usize::from(bound.is_none());
        Some(*count)
    }));
    let all_have = |part: &Subtree| without[part.leaves.start] == without[part.leaves.end];
    let spheres = enclosing_nodes(&leaves, parts).into_iter().zip(parts);
    spheres.map(|(sphere, part)| sphere.filter(|_| all_have(part))).collect()
}

fn short(count: usize) -> u32 {
    u32::try_from(count).expect("a tree holds fewer than 2^32 primitives")
}

/// The part of a line that is still of interest, in scaled coordinates: the points `origin + s direction` with
/// `start <= s <= last`.
struct Segment {
    origin: [f64; 3],
    /// Of length 1.
    direction: [f64; 3],
    start: f64,
    last: f64,
    /// The length of a unit of `t`; infinite where that is far from ordinary, and then every `t` counts.
    unit: f64,
}

impl Segment {
    fn new(ray: &PreparedRay, scale: f64) -> Self {
        let power = power_of_two_near_inverse(max_abs(ray.ray.direction()));
        let direction = ray.ray.direction() * power;
        let length = direction.length();
        let unit = length * (scale / power);
        let ordinary = (LONGEST.recip()..LONGEST).contains(&unit);
        let mut segment = Self {
            origin: (ray.ray.origin() * scale).to_array(),
            direction: (direction * length.recip()).to_array(),
            start: if ordinary { ray.start * unit } else { f64::NEG_INFINITY },
            last: f64::INFINITY,
            unit: if ordinary { unit } else { f64::INFINITY },
        };
        segment.shorten(ray.end);
        segment
    }

    /// No hit with a larger `t` counts. Hits at minus infinity tie, wherever they are.
    #[inline(always)]
    fn shorten(&mut self, t: f64) {
        let last = t.max(f64::MIN) * self.unit;
        if last < self.last && self.unit < f64::INFINITY {
            self.last = last;
        }
    }

    /// The spheres of a node that the segment may meet, as bits, and where it may enter each.
    ///
    /// With `v` from the center to the origin, the line is nearest to the center at `s = -v.u`, and passes it there at
    /// the distance `|v + s u|`. NaN, from numbers out of range, counts as met.
    #[inline(always)]
    fn meet<S: Simd>(&self, simd: S, node: &Node) -> (u64, [f64; WIDTH]) {
        let [x, y, z] = &node.center;
        let center = [f64x8::from_slice(simd, x), f64x8::from_slice(simd, y), f64x8::from_slice(simd, z)];
        let radius = f64x8::from_slice(simd, &node.radius);
        let [u, v, w] = self.direction;
        let x = f64x8::splat(simd, self.origin[0]) - center[0];
        let y = f64x8::splat(simd, self.origin[1]) - center[1];
        let z = f64x8::splat(simd, self.origin[2]) - center[2];
        let nearest = -x.mul_add(u, y.mul_add(v, z * w));
        let far = (x.abs() + y.abs()) + (z.abs() + radius);
        let reach = far.mul_add(MARGIN, f64x8::splat(simd, UNDERFLOW)) + radius;
        let (x, y, z) = (nearest.mul_add(u, x), nearest.mul_add(v, y), nearest.mul_add(w, z));
        let aside = x.mul_add(x, y.mul_add(y, z * z));
        // (Not fused: where both squares overflow, this must be NaN.)
        let chord = reach * reach - aside;
        let half = chord.sqrt();
        let enter = nearest - half;
        let misses = chord.simd_lt(f64x8::splat(simd, 0.0))
            | enter.simd_gt(f64x8::splat(simd, self.last))
            | (f64x8::splat(simd, self.start) - nearest).simd_gt(half);
        (!misses.to_bitmask() & ((1 << node.len) - 1), enter.into())
    }
}

dispatch! {
    fn closest(tree: &SphereTree, ray: &Ray, start: f64, end: f64) -> (Option<Hit>, Visits) = walk_closest;
}

dispatch! {
    fn any(tree: &SphereTree, ray: &Ray, start: f64, end: f64) -> bool = walk_any;
}

#[inline(always)]
fn walk_closest<const FMA: bool, S: Simd>(
    simd: S,
    tree: &SphereTree,
    ray: &Ray,
    start: f64,
    end: f64,
) -> (Option<Hit>, Visits) {
    walk::<FMA, S, Closest>(simd, tree, ray, start..end)
}

#[inline(always)]
fn walk_any<const FMA: bool, S: Simd>(simd: S, tree: &SphereTree, ray: &Ray, start: f64, end: f64) -> bool {
    walk::<FMA, S, Any>(simd, tree, ray, start..end).0
}

#[inline(always)]
fn walk<const FMA: bool, S: Simd, Q: Query>(
    simd: S,
    tree: &SphereTree,
    ray: &Ray,
    within: Range<f64>,
) -> (Q::Answer, Visits) {
    let mut visits = Visits::default();
    if !is_open(&within) || tree.is_empty() {
        return (Q::Answer::default(), visits);
    }
    let leaves = &tree.leaves;
    let ray = &PreparedRay::new(ray, within);
    let mut segment = Segment::new(ray, tree.scale);
    let mut query = Q::begin(&mut Q::Answer::default());
    // Each part with where the ray enters it, the nearest last.
    let mut stack = [(f64::NEG_INFINITY, tree.root); STACK];
    let mut height = 1;
    while height > 0 && !query.is_settled() {
        height -= 1;
        let (enter, at) = stack[height];
        if enter > segment.last {
            continue;
        }
        if at.count == 0 {
            let node = &tree.nodes[at.first as usize];
            visits.nodes += node.len;
            let (mut met, enter) = segment.meet(simd, node);
            let base = height;
            while met != 0 {
                let side = met.trailing_zeros() as usize;
                met &= met - 1;
                let enter = larger(enter[side], f64::NEG_INFINITY);
                let mut hole = height;
                while hole > base && stack[hole - 1].0 < enter {
                    stack[hole] = stack[hole - 1];
                    hole -= 1;
                }
                let child = node.children[side];
                stack[hole] = (enter, child);
                height += 1;
                if child.count == 0 {
                    prefetch_lines(tree.nodes.as_ptr().wrapping_add(child.first as usize), 6);
                }
            }
            continue;
        }
        let places = at.first as usize..(at.first + at.count) as usize;
        visits.tests += places.len();
        let spheres = leaves.spheres.len();
        for place in places.start..places.end.min(spheres) {
            query.meet::<FMA, _>(&leaves.spheres[place], place, leaves, ray);
        }
        for place in places.start.max(spheres)..places.end {
            query.meet::<FMA, _>(&leaves.triangles[place - spheres], place, leaves, ray);
        }
        segment.shorten(query.limit());
    }
    (query.answer(leaves, ray), visits)
}

#[cfg(test)]
mod tests {
    use fearless_simd::Level;
    use glam::DVec3;
    use oracle::Random;

    use super::*;

    const AHEAD: Range<f64> = 0.0..f64::INFINITY;

    fn ball(x: f64, y: f64, z: f64, r: f64) -> Sphere {
        Sphere::new(DVec3::new(x, y, z), r).unwrap()
    }

    /// Three well-separated rows of ten.
    fn rows() -> Vec<Sphere> {
        (0..30).map(|i| ball(f64::from(i % 10), 1e3 * f64::from(i / 10), 0.0, 0.25)).collect()
    }

    /// A node of three parts with the same sphere.
    fn all_alike(center: DVec3, radius: f64) -> Node {
        let center = center.to_array().map(|x| [x; WIDTH]);
        Node { center, radius: [radius; WIDTH], children: [Child { first: 0, count: 1 }; WIDTH], len: 3 }
    }

    #[test]
    fn the_second_half_is_the_larger() {
        let mut parts = Vec::new();
        halve(0..26, &mut parts);
        let ranges: Vec<Range<usize>> = parts.iter().map(|part| part.leaves.clone()).collect();
        assert_eq!(ranges, [0..6, 6..13, 13..19, 19..26, 0..13, 13..26, 0..26]);
        for part in parts.iter().filter(|part| !part.children.is_empty()) {
            let [first, second] = [part.children.start, part.children.start + 1].map(|at| &parts[at].leaves);
            assert_eq!((first.start, first.end, second.end), (part.leaves.start, second.start, part.leaves.end));
            assert_eq!(first.len(), part.leaves.len() / 2);
        }
    }

    #[test]
    fn every_part_has_its_minimal_sphere() {
        let spheres = rows();
        let bounds: Vec<Option<Sphere>> = spheres.iter().copied().map(Some).collect();
        let mut parts = Vec::new();
        halve(0..spheres.len(), &mut parts);
        for (part, sphere) in parts.iter().zip(spheres_of_parts(&parts, &bounds)) {
            let (sphere, minimal) = (sphere.unwrap(), enclosing_sphere(&spheres[part.leaves.clone()]).unwrap().sphere);
            let excess = minimal.radius() * 1e-14 + minimal.center().abs().max_element() * 4.0 * f64::EPSILON;
            assert!(sphere.radius() <= minimal.radius() + excess, "{part:?}: {sphere:?} {minimal:?}");
        }
        // The spheres of the nodes are those of the parts.
        let tree = SphereTree::new(spheres, vec![]);
        let root = &tree.nodes[tree.root.first as usize];
        let first = enclosing_sphere(&rows()[..7]).unwrap().sphere;
        assert!((root.radius[0] / tree.scale / first.radius() - 1.0).abs() < 1e-14, "{root:?} {first:?}");
    }

    #[test]
    fn nodes_at_the_bottom_are_full() {
        // Halved seven times, into 128 parts of eight.
        let spheres = (0..1024).map(|i| ball(f64::from(i), 0.0, 0.0, 1e-3)).collect();
        let tree = SphereTree::new(spheres, vec![]);
        let count = |len: usize| tree.nodes.iter().filter(|node| node.len == len).count();
        assert_eq!((count(8), count(2), tree.nodes.len()), (128 + 16 + 2, 1, 147));
    }

    #[test]
    fn a_ray_past_everything_tests_the_spheres_of_the_root() {
        let tree = SphereTree::new(rows(), vec![]);
        let ray = Ray::new(DVec3::new(0.0, 1e4, 0.0), DVec3::X).unwrap();
        assert_eq!(tree.closest_counted(&ray, AHEAD), (None, Visits { nodes: 4, tests: 0 }));
    }

    #[test]
    fn the_nearest_part_comes_first_and_hides_the_others() {
        for direction in [1.0, -1.0] {
            let tree = SphereTree::sorted(rows(), vec![]);
            let ray = Ray::new(DVec3::new(1.0, -1e4 * direction, 0.0), DVec3::Y * direction).unwrap();
            let (hit, visits) = tree.closest_counted(&ray, AHEAD);
            assert_eq!(hit.map(|hit| hit.index), Some(if direction > 0.0 { 1 } else { 21 }));
            assert!(visits.tests <= 16, "{visits:?}");
        }
    }

    #[test]
    fn a_list_without_order_in_space_is_scanned() {
        // Every half of the list fills the whole scene.
        let shuffled: Vec<Sphere> = (0..64).map(|i| ball(f64::from(i * 27 % 64), 0.0, 0.0, 1e3)).collect();
        let tree = SphereTree::new(shuffled.clone(), vec![]);
        assert!(tree.nodes.is_empty(), "{} nodes", tree.nodes.len());
        assert!(
            !SphereTree::sorted(shuffled.iter().map(|s| ball(s.center().x, 0.0, 0.0, 0.5)).collect(), vec![])
                .nodes
                .is_empty()
        );
    }

    #[test]
    fn no_finite_sphere_means_always_visited() {
        let far = f64::MAX;
        let tree = SphereTree::new(vec![ball(-far, 0.0, 0.0, 1.0), ball(far, 0.0, 0.0, far)], vec![]);
        let ray = Ray::new(DVec3::new(1.0, 0.0, 0.0), DVec3::X).unwrap();
        assert_eq!(tree.closest(&ray, AHEAD).map(|hit| hit.index), Some(1));
    }

    #[test]
    fn a_triangle_without_a_finite_sphere_is_hit_among_many_others() {
        let far = f64::MAX;
        let huge =
            Triangle::new(DVec3::new(-far, -far, 0.0), DVec3::new(far, -far, 0.0), DVec3::new(0.0, far, 0.0)).unwrap();
        let small = |i: i32| {
            let at = DVec3::new(3.0 * f64::from(i), 0.0, 5.0);
            Triangle::new(at, at + DVec3::X, at + DVec3::Y).unwrap()
        };
        let mut triangles: Vec<Triangle> = (0..40).map(small).collect();
        triangles.extend([huge; 3]);
        assert!(bounds_of(&[], &triangles)[40].is_none());
        for tree in [SphereTree::new, SphereTree::sorted] {
            let tree = tree(vec![], triangles.clone());
            let hit = |z: f64| tree.closest(&Ray::new(DVec3::new(6.25, 0.25, z), DVec3::NEG_Z).unwrap(), AHEAD);
            assert_eq!(hit(9.0).map(|hit| hit.index), Some(2));
            assert_eq!(hit(4.0).map(|hit| hit.index), Some(40));
        }
    }

    #[test]
    fn nothing_is_hit_in_an_empty_tree_or_range() {
        let ray = Ray::new(DVec3::ZERO, DVec3::X).unwrap();
        assert_eq!(SphereTree::new(vec![], vec![]).closest(&ray, AHEAD), None);
        assert!(!SphereTree::sorted(vec![], vec![]).any(&ray, AHEAD));
        let tree = SphereTree::new(vec![ball(3.0, 0.0, 0.0, 1.0)], vec![]);
        assert_eq!(tree.closest(&ray, f64::NAN..f64::INFINITY), None);
        assert_eq!(tree.closest(&ray, 2.0..2.0), None);
    }

    /// Rays that touch the spheres of a node, or end or start where they do, to the last bits: the test never says that
    /// such a ray misses.
    #[test]
    fn the_test_of_a_node_drops_no_hit() {
        let random = &mut Random::new(7);
        let mut met = 0;
        for round in 0..20_000 {
            let mut vector = || random.point();
            let (center, direction) = (vector() * 2f64.powi(-(round % 40)), vector());
            let (aside, away) = (direction.cross(vector()).normalize(), vector().x);
            let radius = 0.5 * vector().x.abs();
            let touching = center + aside * radius;
            let origin = touching + direction * (away * 2f64.powi(round % 30));
            let (Ok(ray), sphere) = (Ray::new(origin, direction), Sphere::new(center, radius).unwrap()) else {
                continue;
            };
            let node = all_alike(center, radius);
            let Some(t) = sphere.closest(&ray, f64::NEG_INFINITY..f64::INFINITY) else { continue };
            met += 1;
            // The range is `start <= t < end`, and a hit of equal `t` may still win.
            for (start, last) in [(f64::NEG_INFINITY, t), (t, f64::INFINITY), (t, t.next_up())] {
                let prepared = PreparedRay::new(&ray, start..last);
                let segment = Segment::new(&prepared, 1.0);
                for level in [Level::new(), Level::baseline()] {
                    let (met, enter) = dispatch!(level, simd => segment.meet(simd, &node));
                    assert_eq!(met, 0b111, "{level:?} {sphere:?} {ray:?} {t}");
                    assert!(enter[0] <= segment.last, "{level:?} {sphere:?} {ray:?} {t} {enter:?}");
                }
            }
        }
        assert!(met > 5_000, "{met}");
    }

    #[test]
    fn a_node_is_met_from_where_squares_overflow() {
        for far in [1e150, 1e160, 1e290, 1e300, 1e307] {
            let ray = Ray::new(DVec3::splat(-far), DVec3::ONE).unwrap();
            let prepared = PreparedRay::new(&ray, AHEAD);
            let segment = Segment::new(&prepared, 1.0);
            for level in [Level::new(), Level::baseline()] {
                let (met, _) = dispatch!(level, simd => segment.meet(simd, &all_alike(DVec3::ZERO, 1.0)));
                assert_eq!(met, 0b111, "{level:?} from {far}");
            }
        }
    }
}
