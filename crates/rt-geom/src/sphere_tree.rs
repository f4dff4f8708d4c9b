//! The report's bounding-sphere tree: the index range is halved down to single primitives.
//!
//! The root encloses all `n` primitives; its two children take the first `⌊n/2⌋` and the rest, and so on. Every
//! node carries the minimal sphere of what is below it. A ray visits a node if it meets that ball, and tests the
//! primitives at the leaves. This is the baseline that [`Bvh`](crate::Bvh) is measured against: it
//! halves a list, not space, so it saves tests only as far as the list happens to be sorted.
//!
//! The visit is decided by the exact roots of the node's sphere. The ball contains every primitive below it in exact
//! arithmetic, so a primitive's root lies between the ball's two roots, and rounding to nearest keeps that order:
//! no margin is needed, and no hit of the plain loop is lost.

use std::ops::Range;

use rt_math::Roots;

use crate::bvh::minimal_sphere;
use crate::{Hit, Ray, Shape, Sphere, Triangle, enclosing_sphere};

/// The tree by index halves, over spheres and triangles in the order given (spheres first).
///
/// ```
/// use glam::DVec3;
/// use rt_geom::{SphereTree, Hit, Ray, Sphere};
/// let row = |i: i32| Sphere::new(DVec3::new(3.0 * f64::from(i), 0.0, -5.0), 1.0).unwrap();
/// let tree = SphereTree::new((0..64).map(row).collect(), Vec::new());
/// let ray = Ray::new(DVec3::ZERO, DVec3::NEG_Z).unwrap();
/// let (hit, tests) = tree.closest_counted(&ray, 0.0..f64::INFINITY);
/// assert_eq!(hit, Some(Hit { index: 0, t: 4.0 }));
/// assert!(tests < 16, "a plain loop makes 64 tests, the tree {tests}");
/// ```
#[derive(Clone, Debug)]
pub struct SphereTree {
    spheres: Vec<Sphere>,
    triangles: Vec<Triangle>,
    /// Inner nodes, each before its first half's nodes and those before its second half's.
    nodes: Vec<Node>,
}

/// An inner node: more than one primitive is below it.
#[derive(Clone, Copy, Debug)]
struct Node {
    /// Encloses everything below; `None` where no finite sphere does, and then the node is always visited.
    sphere: Option<Sphere>,
    /// Where the nodes of the second half begin.
    second: usize,
    /// Whether all primitives below are equal. The first then answers for all, and no nodes are kept below.
    equal: bool,
}

impl SphereTree {
    /// Builds the tree in `O(n log n)` time. Any input will do, also none at all.
    pub fn new(spheres: Vec<Sphere>, triangles: Vec<Triangle>) -> Self {
        let mut bounds: Vec<Option<Sphere>> = spheres.iter().copied().map(Some).collect();
        bounds.extend(triangles.iter().map(minimal_sphere));
        let mut nodes = Vec::with_capacity(bounds.len());
        let mut tree = Self { spheres, triangles, nodes: Vec::new() };
        tree.build(&bounds, 0, &mut nodes);
        tree.nodes = nodes;
        tree
    }

    /// Appends the nodes over `bounds`, those of the primitives from `first` on, and returns whether these are all equal.
    /// The depth is `log2(n)`, so recursion is safe.
    fn build(&self, bounds: &[Option<Sphere>], first: usize, nodes: &mut Vec<Node>) -> bool {
        if bounds.len() < 2 {
            return true;
        }
        let all: Option<Vec<Sphere>> = bounds.iter().copied().collect();
        let sphere = all.and_then(|spheres| enclosing_sphere(&spheres)).map(|enclosing| enclosing.sphere);
        let at = nodes.len();
        nodes.push(Node { sphere, second: 0, equal: false });
        let middle = bounds.len() / 2;
        let (first_half, second_half) = bounds.split_at(middle);
        let first_equal = self.build(first_half, first, nodes);
        nodes[at].second = nodes.len();
        let second_equal = self.build(second_half, first + middle, nodes);
        let equal = first_equal && second_equal && self.shape(first) == self.shape(first + middle);
        if equal {
            nodes.truncate(at + 1);
            nodes[at].equal = true;
        }
        equal
    }

    /// How many primitives the tree holds.
    pub fn len(&self) -> usize {
        self.spheres.len() + self.triangles.len()
    }

    /// Whether it holds none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the primitive with this index: spheres as listed, then triangles as listed.
    ///
    /// # Panics
    /// If `index >= self.len()`.
    pub fn shape(&self, index: usize) -> Shape {
        match self.spheres.get(index) {
            Some(&sphere) => Shape::Sphere(sphere),
            None => Shape::Triangle(self.triangles[index - self.spheres.len()]),
        }
    }

    /// Returns the closest hit with its `t` in the range: the smallest `t`, and of equal `t` the lowest index.
    pub fn closest(&self, ray: &Ray, within: Range<f64>) -> Option<Hit> {
        self.closest_counted(ray, within).0
    }

    /// As [`closest`](Self::closest), with the number of sphere tests made: nodes' spheres and primitives alike
    /// (a triangle at a leaf counts as one).
    pub fn closest_counted(&self, ray: &Ray, within: Range<f64>) -> (Option<Hit>, usize) {
        self.walk(ray, within, false)
    }

    /// Returns whether anything is hit with its `t` in the range.
    pub fn any(&self, ray: &Ray, within: Range<f64>) -> bool {
        self.any_counted(ray, within).0
    }

    /// As [`any`](Self::any), with the number of sphere tests made.
    pub fn any_counted(&self, ray: &Ray, within: Range<f64>) -> (bool, usize) {
        let (hit, tests) = self.walk(ray, within, true);
        (hit.is_some(), tests)
    }

    /// Depth first, first half before second; stops at the first hit if `any` will do.
    fn walk(&self, ray: &Ray, within: Range<f64>, any: bool) -> (Option<Hit>, usize) {
        let (mut best, mut tests) = (None::<Hit>, 0);
        // What is still to do: primitives `first..end`, and where their node is if there are several.
        let mut stack = vec![(0, self.len(), 0)];
        while let Some((first, end, node)) = stack.pop() {
            if end - first > 1 && !self.nodes[node].equal {
                // (In place: reading in pairs what was just copied in pieces would wait for the memory.)
                let Node { sphere, second, .. } = &self.nodes[node];
                if let Some(sphere) = sphere {
                    tests += 1;
                    let last = best.map_or(within.end, |hit| hit.t);
                    if !meets_ball(sphere, ray, within.start, last) {
                        continue;
                    }
                }
                let middle = first + (end - first) / 2;
                stack.extend([(middle, end, *second), (first, middle, node + 1)]);
            } else if end > first {
                tests += 1;
                let t = match self.spheres.get(first) {
                    Some(sphere) => sphere.closest(ray, within.clone()),
                    None => self.triangles[first - self.spheres.len()].closest(ray, within.clone()),
                };
                // The walk meets indices in ascending order, so an equal t loses.
                if let Some(t) = t.filter(|t| best.is_none_or(|hit| t.total_cmp(&hit.t).is_lt())) {
                    best = Some(Hit { index: first, t });
                    if any {
                        break;
                    }
                }
            }
        }
        (best, tests)
    }
}

/// Whether the line's part from `start` to `last`, both ends included, can meet the solid ball.
fn meets_ball(ball: &Sphere, ray: &Ray, start: f64, last: f64) -> bool {
    let (enter, leave) = match ball.roots(ray) {
        Roots::None => return false,
        Roots::One(t) => (t, t),
        Roots::Two(enter, leave) => (enter, leave),
        Roots::All => return true,
    };
    enter.total_cmp(&last).is_le() && leave.total_cmp(&start).is_ge()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn ball(x: f64, y: f64, z: f64, r: f64) -> Sphere {
        Sphere::new(DVec3::new(x, y, z), r).unwrap()
    }

    #[test]
    fn the_second_child_takes_the_larger_half() {
        // Five spheres: nodes over 5, 2 | 3 and, inside the 3, over 2.
        let tree = SphereTree::new((0..5).map(|i| ball(f64::from(i), 0.0, 0.0, 0.25)).collect(), vec![]);
        let radii: Vec<f64> = tree.nodes.iter().map(|node| node.sphere.unwrap().radius()).collect();
        let expected = [2.25, 0.75, 1.25, 0.75];
        assert_eq!(radii.len(), 4);
        for (radius, expected) in radii.iter().zip(expected) {
            assert!((radius - expected).abs() < 1e-12, "{radii:?}");
        }
        assert_eq!(tree.nodes[0].second, 2);
    }

    #[test]
    fn a_miss_of_the_root_is_one_test() {
        let tree = SphereTree::new((0..100).map(|i| ball(f64::from(i), 0.0, 0.0, 0.25)).collect(), vec![]);
        let ray = Ray::new(DVec3::new(0.0, 10.0, 0.0), DVec3::Y).unwrap();
        assert_eq!(tree.closest_counted(&ray, 0.0..f64::INFINITY), (None, 1));
    }

    #[test]
    fn no_finite_sphere_means_always_visited() {
        let far = f64::MAX;
        let tree = SphereTree::new(vec![ball(-far, 0.0, 0.0, 1.0), ball(far, 0.0, 0.0, far)], vec![]);
        assert!(tree.nodes[0].sphere.is_none());
        let ray = Ray::new(DVec3::new(1.0, 0.0, 0.0), DVec3::X).unwrap();
        assert_eq!(tree.closest(&ray, 0.0..f64::INFINITY).map(|hit| hit.index), Some(1));
    }

    #[test]
    fn nothing_is_hit_in_an_empty_tree_or_range() {
        let ray = Ray::new(DVec3::ZERO, DVec3::X).unwrap();
        assert_eq!(SphereTree::new(vec![], vec![]).closest(&ray, 0.0..f64::INFINITY), None);
        let tree = SphereTree::new(vec![ball(3.0, 0.0, 0.0, 1.0)], vec![]);
        assert_eq!(tree.closest(&ray, f64::NAN..f64::INFINITY), None);
        assert_eq!(tree.closest(&ray, 2.0..2.0), None);
    }
}
