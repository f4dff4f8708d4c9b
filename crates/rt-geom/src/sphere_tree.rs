//! The report's bounding-sphere tree: a list is halved again and again, and every part has its minimal sphere.
//!
//! The root holds all `n` primitives; its two children hold the first `⌊n/2⌋` and the rest, and so on. A query walks
//! the minimal spheres: a part is visited if the ray may meet its sphere before the best hit so far, the nearer of two
//! first. That test is made in plain doubles with a proved margin, so it may visit too much and never loses a hit; the
//! exact kernels decide about the primitives alone.
//!
//! Halving a list halves space only as far as the list is sorted in space. [`SphereTree::new`] takes the list as it
//! is, [`SphereTree::sorted`] sorts it along a Hilbert curve first (`hilbert.rs`).
//!
//! Where the spheres of a part would cost more tests than they are expected to save, its primitives are tested one
//! after the other. A ray that meets a sphere of radius `R` meets a sphere of radius `r` within it with the probability
//! `r²/R²`, if it comes from anywhere (J. Goldsmith, J. Salmon, "Automatic Creation of Object Hierarchies for Ray
//! Tracing", 1987).

use std::ops::Range;

use rt_math::exact::{U, power_of_two, power_of_two_near_inverse};
use rt_math::fma_dispatch;

use crate::enclosing::nodes::{Subtree, enclosing_nodes};
use crate::hilbert;
use crate::leaf::{Any, Closest, Leaves, Query};
use crate::ray::{PreparedRay, is_open, larger, max_abs};
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

/// A part of two halves, with the minimal spheres of both; scaled. A radius is infinite where no finite sphere
/// encloses.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
struct Node {
    center: [[f64; 2]; 3],
    radius: [f64; 2],
    halves: [Child; 2],
}

/// A node, or primitives at neighbouring places that are tested one after the other.
#[derive(Clone, Copy, Debug)]
struct Child {
    first: u32,
    /// How many primitives; 0 for a node.
    count: u32,
}

/// What testing both spheres of a node costs, in tests of primitives. So many primitives and fewer are never worth a
/// node.
const PAIR_COST: usize = 8;

/// The rounding errors of a sphere's test, relative to its radius and its distance from the ray's origin:
/// `docs/numerics.md`, lemma 9.8.
const MARGIN: f64 = 64.0 * U;

/// The rounding errors of numbers that underflow, and of `t`: `2^-100`.
const UNDERFLOW: f64 = power_of_two(-100);

/// A unit of `t` must be as long as this or its reciprocal in scaled coordinates, or every `t` counts: `2^960`.
const LONGEST: f64 = power_of_two(960);

/// The depth of a tree of fewer than 2^32 primitives.
const DEPTH: usize = 32;

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
            let runs = tree.runs(&parts, &spheres);
            tree.root = tree.plant(whole, &parts, &spheres, &runs);
        }
        tree
    }

    /// For each part how many of its primitives are tested one after the other; 0 if its halves are visited in its
    /// place.
    fn runs(&self, parts: &[Subtree], spheres: &[Option<Sphere>]) -> Vec<u32> {
        let radius = |at: usize| spheres[at].map_or(f64::INFINITY, |sphere| sphere.radius());
        let equal = |a: usize, b: usize| self.leaves.placed(a) == self.leaves.placed(b);
        let mut costs = vec![0.0; parts.len()];
        let mut runs = vec![0; parts.len()];
        for (at, part) in parts.iter().enumerate() {
            let (first, count) = (part.leaves.start, part.leaves.len());
            let halves = || part.children.clone();
            let all_equal = if halves().is_empty() {
                part.leaves.clone().all(|place| equal(first, place))
            } else {
                halves().all(|half| runs[half] == 1 && equal(first, parts[half].leaves.start))
            };
            let share = |half: usize| {
                let ratio = radius(half) / radius(at);
                // NaN, of two that are infinite or 0, counts as 1.
                costs[half] * (ratio * ratio).min(1.0)
            };
            let split = PAIR_COST as f64 + halves().map(share).sum::<f64>();
            (costs[at], runs[at]) = if all_equal {
                // The first, whose index is the lowest, answers for all.
                (1.0, 1)
            } else if halves().is_empty() || count as f64 <= split {
                (count as f64, short(count))
            } else {
                (split, 0)
            };
        }
        runs
    }

    /// Appends the nodes of a part; the recursion is no deeper than the tree, [`DEPTH`].
    fn plant(&mut self, at: usize, parts: &[Subtree], spheres: &[Option<Sphere>], runs: &[u32]) -> Child {
        let part = &parts[at];
        if runs[at] > 0 {
            return Child { first: short(part.leaves.start), count: runs[at] };
        }
        let child = Child { first: short(self.nodes.len()), count: 0 };
        let halves = [part.children.start, part.children.start + 1];
        let [a, b] = halves.map(|half| match spheres[half] {
            Some(sphere) => (sphere.center() * self.scale, sphere.radius() * self.scale),
            None => (glam::DVec3::ZERO, f64::INFINITY),
        });
        let center = std::array::from_fn(|axis| [a.0[axis], b.0[axis]]);
        self.nodes.push(Node { center, radius: [a.1, b.1], halves: [child; 2] });
        for (side, half) in halves.into_iter().enumerate() {
            self.nodes[child.first as usize].halves[side] = self.plant(half, parts, spheres, runs);
        }
        child
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

/// Lists the parts below a range of places, the halves of a part next to each other, and the range itself last.
fn halve(range: Range<usize>, parts: &mut Vec<Subtree>) {
    fn below(range: Range<usize>, parts: &mut Vec<Subtree>) -> Range<usize> {
        if range.len() <= PAIR_COST {
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

    /// How the line passes a sphere of a node.
    ///
    /// With `v` from the center to the origin, the line is nearest to the center at `s = -v.u`, and passes it there at
    /// the distance `|v + s u|`. NaN, from numbers out of range, counts as met.
    #[inline(always)]
    fn pass<const FMA: bool>(&self, node: &Node, side: usize) -> Passage {
        let [cx, cy, cz] = node.center;
        let (x, y, z) = (self.origin[0] - cx[side], self.origin[1] - cy[side], self.origin[2] - cz[side]);
        let ([u, v, w], radius) = (self.direction, node.radius[side]);
        let s = -fused::<FMA>(x, u, fused::<FMA>(y, v, z * w));
        let far = (x.abs() + y.abs()) + (z.abs() + radius);
        let reach = radius + fused::<FMA>(MARGIN, far, UNDERFLOW);
        let (x, y, z) = (fused::<FMA>(s, u, x), fused::<FMA>(s, v, y), fused::<FMA>(s, w, z));
        let aside = fused::<FMA>(x, x, fused::<FMA>(y, y, z * z));
        // (Not fused: where both squares overflow, this must be NaN.)
        Passage { nearest: s, chord: reach * reach - aside }
    }

    /// Where the segment may enter the sphere; `None` if it surely misses it.
    ///
    /// Branches in this order, which are predicted: the usual miss need not wait for the root.
    #[inline(always)]
    fn enter(&self, passage: &Passage) -> Option<f64> {
        if passage.chord < 0.0 {
            return None;
        }
        let half = passage.chord.sqrt();
        let misses = (passage.nearest - half > self.last) | (self.start - passage.nearest > half);
        if misses { None } else { Some(larger(passage.nearest - half, f64::MIN)) }
    }
}

/// How a line passes a sphere.
#[derive(Clone, Copy)]
struct Passage {
    /// Where it is nearest to the center.
    nearest: f64,
    /// Half the chord, squared; negative for a line that misses.
    chord: f64,
}

#[inline(always)]
fn fused<const FMA: bool>(a: f64, b: f64, c: f64) -> f64 {
    if FMA { a.mul_add(b, c) } else { a * b + c }
}

fma_dispatch! {
    fn closest(tree: &SphereTree, ray: &Ray, start: f64, end: f64) -> (Option<Hit>, Visits) = walk_closest;
}

fma_dispatch! {
    fn any(tree: &SphereTree, ray: &Ray, start: f64, end: f64) -> bool = walk_any;
}

#[inline(always)]
fn walk_closest<const FMA: bool>(tree: &SphereTree, ray: &Ray, start: f64, end: f64) -> (Option<Hit>, Visits) {
    walk::<FMA, Closest>(tree, ray, start..end)
}

#[inline(always)]
fn walk_any<const FMA: bool>(tree: &SphereTree, ray: &Ray, start: f64, end: f64) -> bool {
    walk::<FMA, Any>(tree, ray, start..end).0
}

#[inline(always)]
fn walk<const FMA: bool, Q: Query>(tree: &SphereTree, ray: &Ray, within: Range<f64>) -> (Q::Answer, Visits) {
    let mut visits = Visits::default();
    if !is_open(&within) || tree.is_empty() {
        return (Q::Answer::default(), visits);
    }
    let leaves = &tree.leaves;
    let ray = &PreparedRay::new(ray, within);
    let mut segment = Segment::new(ray, tree.scale);
    let mut query = Q::begin(&mut Q::Answer::default());
    let mut stack = [(0.0, Child { first: 0, count: 0 }); DEPTH];
    let mut height = 0;
    let mut at = tree.root;
    loop {
        if at.count == 0 {
            let node = &tree.nodes[at.first as usize];
            visits.nodes += 2;
            let (a, b) = (segment.pass::<FMA>(node, 0), segment.pass::<FMA>(node, 1));
            match (segment.enter(&a), segment.enter(&b)) {
                (Some(enter_a), Some(enter_b)) => {
                    let (near, far, enter) = if b.nearest < a.nearest { (1, 0, enter_a) } else { (0, 1, enter_b) };
                    stack[height] = (enter, node.halves[far]);
                    height += 1;
                    at = node.halves[near];
                    continue;
                }
                (Some(_), None) => {
                    at = node.halves[0];
                    continue;
                }
                (None, Some(_)) => {
                    at = node.halves[1];
                    continue;
                }
                (None, None) => {}
            }
        } else {
            let places = at.first as usize..(at.first + at.count) as usize;
            visits.tests += places.len();
            let spheres = leaves.spheres.len();
            for place in places.start..places.end.min(spheres) {
                query.meet::<FMA, _>(&leaves.spheres[place], place, leaves, ray);
            }
            for place in places.start.max(spheres)..places.end {
                query.meet::<FMA, _>(&leaves.triangles[place - spheres], place, leaves, ray);
            }
            if query.is_settled() {
                break;
            }
            segment.shorten(query.limit());
        }
        // Back to the nearest part that is still of interest.
        loop {
            if height == 0 {
                return (query.answer(leaves, ray), visits);
            }
            height -= 1;
            let (enter, child) = stack[height];
            if enter <= segment.last {
                at = child;
                break;
            }
        }
    }
    (query.answer(leaves, ray), visits)
}

#[cfg(test)]
mod tests {
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
        let first = enclosing_sphere(&rows()[..15]).unwrap().sphere;
        assert!((root.radius[0] / tree.scale / first.radius() - 1.0).abs() < 1e-14, "{root:?} {first:?}");
    }

    #[test]
    fn a_ray_past_everything_tests_two_spheres() {
        let tree = SphereTree::new(rows(), vec![]);
        let ray = Ray::new(DVec3::new(0.0, 1e4, 0.0), DVec3::X).unwrap();
        assert_eq!(tree.closest_counted(&ray, AHEAD), (None, Visits { nodes: 2, tests: 0 }));
    }

    #[test]
    fn the_nearer_half_comes_first_and_hides_the_other() {
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
            let node = Node {
                center: center.to_array().map(|x| [x; 2]),
                radius: [radius; 2],
                halves: [Child { first: 0, count: 1 }; 2],
            };
            let Some(t) = sphere.closest(&ray, f64::NEG_INFINITY..f64::INFINITY) else { continue };
            met += 1;
            // The range is `start <= t < end`, and a hit of equal `t` may still win.
            for (start, last) in [(f64::NEG_INFINITY, t), (t, f64::INFINITY), (t, t.next_up())] {
                let prepared = PreparedRay::new(&ray, start..last);
                let segment = Segment::new(&prepared, 1.0);
                for passage in [segment.pass::<false>(&node, 0), segment.pass::<true>(&node, 1)] {
                    let enter = segment.enter(&passage);
                    assert!(enter.is_some_and(|enter| enter <= segment.last), "{sphere:?} {ray:?} {t} {enter:?}");
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
            let node = Node { center: [[0.0; 2]; 3], radius: [1.0; 2], halves: [Child { first: 0, count: 1 }; 2] };
            for passage in [segment.pass::<false>(&node, 0), segment.pass::<true>(&node, 1)] {
                assert!(segment.enter(&passage).is_some(), "from {far}");
            }
        }
    }
}
