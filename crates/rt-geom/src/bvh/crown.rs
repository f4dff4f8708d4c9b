//! The crown: what stands above the regions of a scene whose sizes are too far apart for one frame.
//!
//! Its bounds are boxes in doubles, as the scene has them, so a box is met or not with an error relative to the ray's
//! parameter there: no scale is too small (T. Ize, "Robust BVH Ray Traversal", 2013). The leaves are regions, each a
//! tree in a frame of its own, and single primitives. `docs/numerics.md`, section 9, has the margins.

use std::ops::Range;

use fearless_simd::{Simd, f64x8, prelude::*};
use glam::DVec3;
use rt_math::exact::{U, power_of_two};

use super::node::WIDTH;
use crate::ray::{PreparedRay, larger, smaller};
use crate::{Sphere, Triangle, Visits};

/// The rounding errors of a parameter, relative to it.
const PARAMETER_ERROR: f64 = 8.0 * U;
/// What parameters err by that underflow.
const UNDERFLOW: f64 = power_of_two(-1000);
/// Planes beyond this count as infinitely far, and from origins beyond it everything is met.
const FARTHEST: f64 = power_of_two(400);
/// Rays with a component of the direction below this that is not zero meet everything.
const SHORTEST: f64 = power_of_two(-500);

/// What a child of a crown's node is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    Node(u32),
    Region(u32),
    /// The primitive at a place.
    Sphere(u32),
    Triangle(u32),
}

/// A box in doubles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Box64 {
    low: DVec3,
    high: DVec3,
}

impl Box64 {
    pub(super) const EMPTY: Self = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };

    /// Contains the spheres in its interior.
    pub(super) fn of_spheres(spheres: &[Sphere]) -> Self {
        let corners = |sphere: &Sphere| (sphere.center() - sphere.radius(), sphere.center() + sphere.radius());
        Self::outward(spheres.iter().map(corners))
    }

    /// Contains the triangles in its interior.
    pub(super) fn of_triangles(triangles: &[Triangle]) -> Self {
        let corners = |triangle: &Triangle| {
            let [a, b, c] = triangle.vertices();
            (a.min(b).min(c), a.max(b).max(c))
        };
        Self::outward(triangles.iter().map(corners))
    }

    /// The box around others, given by rounded corners.
    fn outward(corners: impl Iterator<Item = (DVec3, DVec3)>) -> Self {
        let merge = |(low, high): (DVec3, DVec3), (a, b)| (low.min(a), high.max(b));
        let (low, high) = corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), merge);
        let down = |x: f64| if x < -FARTHEST { f64::NEG_INFINITY } else { x.min(FARTHEST).next_down() };
        Self { low: low.to_array().map(down).into(), high: (-high).to_array().map(|x| -down(x)).into() }
    }

    pub(super) fn merge(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    fn size(&self) -> f64 {
        (self.high - self.low).max_element()
    }

    /// Halfway along an axis.
    fn middle(&self, axis: usize) -> f64 {
        0.5 * self.low[axis].max(-FARTHEST) + 0.5 * self.high[axis].min(FARTHEST)
    }
}

/// Up to sixteen boxes: the three lower planes, then the three upper ones. Children are in order of size.
#[derive(Clone, Debug)]
struct Node {
    planes: [[f64; WIDTH]; 6],
    children: [Part; WIDTH],
    len: usize,
}

#[derive(Clone, Debug)]
pub(super) struct Crown {
    nodes: Vec<Node>,
    /// All that is in it.
    bounds: Box64,
    root: Part,
    /// How many pending entries a walk can need.
    stack: usize,
}

impl Default for Crown {
    fn default() -> Self {
        Self { nodes: Vec::new(), bounds: Box64::EMPTY, root: Part::Node(0), stack: 1 }
    }
}

impl Crown {
    /// The whole, with the part at its top.
    pub(super) fn with_root(self, root: Part) -> Self {
        // Nodes below a node come before it. A walk that goes down has less than all children of each pending.
        let mut needs: Vec<usize> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let need = |part: &Part| if let Part::Node(index) = part { needs[*index as usize] } else { 0 };
            needs.push(node.len + node.children[..node.len].iter().map(need).max().unwrap_or(0));
        }
        let stack = 1 + needs.last().copied().unwrap_or(0);
        Self { root, stack, ..self }
    }

    /// Whether a ray may meet anything.
    #[inline(always)]
    pub(super) fn is_met(&self, line: &Line64) -> bool {
        line.meets(&self.bounds)
    }

    /// Appends a tree over the entries, and returns its root.
    pub(super) fn add(&mut self, mut entries: Vec<(Box64, Part)>) -> Part {
        if let [(bounds, part)] = entries[..] {
            self.bounds = self.bounds.merge(bounds);
            return part;
        }
        entries.sort_by(|a, b| a.0.size().total_cmp(&b.0.size()));
        if entries.len() > WIDTH {
            entries = self.bundle(entries);
        }
        let (low, high) = ([f64::INFINITY; WIDTH], [f64::NEG_INFINITY; WIDTH]);
        self.bounds = entries.iter().fold(self.bounds, |all, entry| all.merge(entry.0));
        let mut node = Node { planes: [low, low, low, high, high, high], children: [Part::Node(0); WIDTH], len: 0 };
        for (lane, (bounds, part)) in entries.into_iter().enumerate() {
            for axis in 0..3 {
                node.planes[axis][lane] = bounds.low[axis];
                node.planes[axis + 3][lane] = bounds.high[axis];
            }
            node.children[lane] = part;
            node.len += 1;
        }
        self.nodes.push(node);
        Part::Node(u32::try_from(self.nodes.len() - 1).expect("fewer nodes than primitives"))
    }

    /// Makes sixteen of more, in order of size: the largest few stay alone, the others are halved again and again.
    fn bundle(&mut self, mut entries: Vec<(Box64, Part)>) -> Vec<(Box64, Part)> {
        let largest = entries.last().map_or(0.0, |entry| entry.0.size());
        let alone = entries.iter().rev().take(WIDTH / 2).take_while(|entry| entry.0.size() >= largest / 8.0).count();
        let mut out = entries.split_off(entries.len() - alone);
        let mut bundles = vec![entries];
        while bundles.len() + alone < WIDTH {
            bundles.sort_by_key(Vec::len);
            let mut most = bundles.pop().expect("one at least");
            let axis = |axis| {
                let middles = most.iter().map(|entry| entry.0.middle(axis));
                let (low, high) = middles.fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)));
                high - low
            };
            let axis = DVec3::new(axis(0), axis(1), axis(2)).max_position();
            let half = most.len() / 2;
            most.select_nth_unstable_by(half, |a, b| a.0.middle(axis).total_cmp(&b.0.middle(axis)));
            let rest = most.split_off(half);
            bundles.extend([most, rest]);
        }
        for bundle in bundles.into_iter().filter(|bundle| !bundle.is_empty()) {
            let bounds = bundle.iter().fold(Box64::EMPTY, |all, entry| all.merge(entry.0));
            out.push((bounds, self.add(bundle)));
        }
        out.sort_by(|a, b| a.0.size().total_cmp(&b.0.size()));
        out
    }
}

/// A child that is still to be visited, and a lower bound of the parameter where the ray enters it.
type Pending = (f64, Part);

/// Entries that a usual crown needs.
const SMALL_STACK: usize = 24;

/// A ray, or many from one origin, as boxes in doubles meet it.
#[derive(Clone, Debug)]
pub(super) struct Line64 {
    origin: [f64; 3],
    /// Rows of the near planes.
    near: [usize; 3],
    /// By which distances from the origin are multiplied, to the near planes and to the far ones.
    inverse: [[f64; 3]; 2],
    within: Range<f64>,
    /// Whether every box is met.
    everything: bool,
}

impl Line64 {
    #[inline(always)]
    pub(super) fn new(prepared: &PreparedRay) -> Self {
        let PreparedRay { ray, start, end, .. } = *prepared;
        let (origin, direction) = (ray.origin().to_array(), ray.direction().to_array());
        let (mut inverse, mut near) = ([0.0; 3], [0; 3]);
        let mut ordinary = ray.reach() > 0.0;
        for axis in 0..3 {
            inverse[axis] = 1.0 / direction[axis];
            near[axis] = axis + 3 * usize::from(direction[axis].is_sign_negative());
            ordinary &= origin[axis].abs() < FARTHEST && is_ordinary(direction[axis]);
        }
        Self { origin, inverse: [inverse; 2], near, within: start..end, everything: !ordinary }
    }

    /// For all rays from the origin whose directions have components between the least and the greatest, none of which
    /// differ in sign, and a range that begins at zero or later: what is entered first by the greatest component is left
    /// last by the least.
    #[inline(always)]
    pub(super) fn of_many(origin: DVec3, least: DVec3, greatest: DVec3, within: Range<f64>) -> Self {
        let (mut inverse, mut near) = ([[0.0; 3]; 2], [0; 3]);
        let mut ordinary = true;
        for axis in 0..3 {
            let (least, greatest) = (least[axis], greatest[axis]);
            let side = usize::from(greatest < 0.0 || least < 0.0);
            let (fast, slow) = if side == 0 { (greatest, least) } else { (least, greatest) };
            // Of zeros the sign of the others.
            let sign = if side == 0 { 1.0 } else { -1.0 };
            inverse[0][axis] = sign / fast.abs();
            inverse[1][axis] = sign / slow.abs();
            near[axis] = axis + 3 * side;
            ordinary &= origin[axis].abs() < FARTHEST && is_ordinary(fast) && is_ordinary(slow);
        }
        Self { origin: origin.to_array(), inverse, near, within, everything: !ordinary }
    }

    /// Whether a box may be met: the test of a node's boxes, for one.
    #[inline(always)]
    fn meets(&self, bounds: &Box64) -> bool {
        let planes = [bounds.low.to_array(), bounds.high.to_array()];
        let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
        for axis in [0, 1, 2] {
            let (side, [near, far]) = (self.near[axis] / 3, self.inverse);
            // NaN bounds nothing.
            enter = larger((planes[side][axis] - self.origin[axis]) * near[axis], enter);
            leave = smaller((planes[1 - side][axis] - self.origin[axis]) * far[axis], leave);
        }
        let enter = enter - (enter.abs() * PARAMETER_ERROR + UNDERFLOW);
        let leave = leave + (leave.abs() * PARAMETER_ERROR + UNDERFLOW);
        // An infinite number less itself is NaN, which excludes nothing.
        self.everything || !(enter > leave || enter > self.within.end || leave < self.within.start)
    }

    /// The boxes met, as bits, and lower bounds of the parameters there.
    #[inline(always)]
    fn meet<S: Simd>(&self, simd: S, node: &Node, enters: &mut [f64; WIDTH]) -> u32 {
        let mut met = 0;
        let (start, end) = (f64x8::splat(simd, self.within.start), f64x8::splat(simd, self.within.end));
        for (half, enters) in enters.as_chunks_mut::<8>().0.iter_mut().enumerate().take(node.len.div_ceil(8)) {
            let near = |axis: usize| (self.near[axis], self.inverse[0][axis], axis, 8 * half);
            let far = |axis: usize| ((self.near[axis] + 3) % 6, self.inverse[1][axis], axis, 8 * half);
            let enter = self.plane(simd, node, near(0)).max(self.plane(simd, node, near(1)));
            let enter = enter.max(self.plane(simd, node, near(2)));
            let leave = self.plane(simd, node, far(0)).min(self.plane(simd, node, far(1)));
            let leave = leave.min(self.plane(simd, node, far(2)));
            let enter = enter - (enter.abs() * PARAMETER_ERROR + UNDERFLOW);
            let leave = leave + (leave.abs() * PARAMETER_ERROR + UNDERFLOW);
            enter.max(start).store_slice(enters);
            // (NaN, where a line passes outside of planes along it, is no hit.)
            let mask = enter.simd_le(leave) & enter.simd_le(end) & start.simd_le(leave);
            met |= u32::try_from(mask.to_bitmask()).expect("eight bits") << (8 * half);
        }
        met
    }

    /// Where the line meets a row of planes. NaN, of a line in a plane, which lies outside the box, meets nothing or
    /// leaves the decision to the other planes.
    #[inline(always)]
    fn plane<S: Simd>(&self, simd: S, node: &Node, (row, inverse, axis, lane): (usize, f64, usize, usize)) -> f64x8<S> {
        (f64x8::from_slice(simd, &node.planes[row][lane..lane + 8]) - self.origin[axis]) * inverse
    }
}

/// Whether a component of a direction is one for which the margins are proved.
#[inline(always)]
fn is_ordinary(component: f64) -> bool {
    component.abs() > SHORTEST || component == 0.0
}

/// The way of one ray through a crown.
#[derive(Clone, Debug)]
pub(super) struct Tour {
    line: Line64,
    small: [Pending; SMALL_STACK],
    large: Vec<Pending>,
    height: usize,
}

impl Tour {
    /// At the beginning of a ray's way.
    #[inline(always)]
    pub(super) fn new(crown: &Crown, line: Line64) -> Self {
        let nothing = (0.0, crown.root);
        let large = if crown.stack > SMALL_STACK { vec![nothing; crown.stack] } else { Vec::new() };
        let mut tour = Self { line, small: [nothing; SMALL_STACK], large, height: 1 };
        tour.stack()[0].0 = tour.line.within.start;
        tour
    }

    /// Sends another ray on its way, unless it passes by the whole.
    #[inline(always)]
    pub(super) fn begin(&mut self, crown: &Crown, line: Line64) {
        self.height = usize::from(crown.is_met(&line));
        self.stack()[0] = (line.within.start, crown.root);
        self.line = line;
    }

    #[inline(always)]
    fn stack(&mut self) -> &mut [Pending] {
        if self.large.is_empty() { &mut self.small } else { &mut self.large }
    }

    /// The nearest region or primitive that is left and that the ray may enter with a parameter of at most `limit`;
    /// where any hit will do, first the primitives, which cost less.
    #[inline(always)]
    pub(super) fn next<S: Simd>(
        &mut self,
        simd: S,
        crown: &Crown,
        any: bool,
        limit: f64,
        visits: &mut Visits,
    ) -> Option<Part> {
        while self.height > 0 {
            self.height -= 1;
            let height = self.height;
            let (enter, part) = self.stack()[height];
            if enter > limit {
                continue;
            }
            let Part::Node(index) = part else { return Some(part) };
            visits.nodes += 1;
            let node = &crown.nodes[index as usize];
            let mut enters = [self.line.within.start; WIDTH];
            let mut met = (1 << node.len) - 1;
            if !self.line.everything {
                met &= self.line.meet(simd, node, &mut enters);
            }
            let mut top = height;
            while met != 0 {
                let lane = met.trailing_zeros() as usize;
                met &= met - 1;
                if any && matches!(node.children[lane], Part::Sphere(_) | Part::Triangle(_)) {
                    enters[lane] = f64::NEG_INFINITY;
                }
                let stack = self.stack();
                let mut hole = top;
                // Of two that are entered together the smaller comes first.
                while hole > height && stack[hole - 1].0 <= enters[lane] {
                    stack[hole] = stack[hole - 1];
                    hole -= 1;
                }
                stack[hole] = (enters[lane], node.children[lane]);
                top += 1;
            }
            self.height = top;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use fearless_simd::Level;
    use oracle::{Random, scale_point};

    use super::*;
    use crate::Ray;
    use crate::simd::dispatch;

    /// All that a tour gives.
    fn met(crown: &Crown, level: Level, line: Line64) -> Vec<Part> {
        if !crown.is_met(&line) {
            return Vec::new();
        }
        let mut tour = Tour::new(crown, line);
        let visits = &mut Visits::default();
        std::iter::from_fn(|| dispatch!(level, simd => tour.next(simd, crown, false, f64::INFINITY, visits))).collect()
    }

    fn line(ray: &Ray, within: Range<f64>) -> Line64 {
        Line64::new(&PreparedRay::new(ray, within))
    }

    /// The ray with others from its origin, of which each component has the same sign or is zero.
    fn with_others(ray: &Ray, within: Range<f64>, random: &mut Random) -> Line64 {
        let (mut least, mut greatest) = (ray.direction(), ray.direction());
        for _ in 0..random.below(4) {
            let zero = random.one_in(4);
            // Of zeros the sign says nothing.
            let share = if zero { random.pick(&[DVec3::ZERO, -DVec3::ZERO]) } else { 1.5 * random.point().abs() };
            let other = share * ray.direction();
            (least, greatest) = (least.min(other), greatest.max(other));
        }
        Line64::of_many(ray.origin(), least, greatest, within)
    }

    /// Flat boxes of which one corner is met, within a range of one double, at any scale, by a ray and by many.
    #[test]
    fn the_crown_drops_no_hit_and_most_of_the_rest() {
        let random = &mut Random::new(3);
        let (mut hits, mut kept) = (0, 0);
        for _ in 0..3_000 {
            let at = |random: &mut Random| {
                let k = random.integer(-40..40);
                scale_point(random.point(), k)
            };
            let flat = |random: &mut Random| {
                let (axis, a) = (random.below(3), at(random));
                let mut corner = || {
                    let mut b = a + random.uniform() * a.length() * random.point();
                    b[axis] = a[axis];
                    b
                };
                Triangle::new(a, corner(), corner()).unwrap()
            };
            let triangles: Vec<Triangle> = (0..40).map(|_| flat(random)).collect();
            let mut crown = Crown::default();
            let root = crown
                .add((0..).zip(&triangles).map(|(i, t)| (Box64::of_triangles(&[*t]), Part::Triangle(i))).collect());
            let crown = crown.with_root(root);
            let origin = if random.below(4) == 0 { triangles[1].vertices()[1] } else { at(random) };
            let along = random.below(40);
            let [a, b, c] = triangles[along].vertices();
            let target = random.pick(&[a, b, 0.5 * (a + b), (a + b + c) / 3.0]);
            let length = random.integer(-90..50);
            let direction = random.pick(&[target - origin, DVec3::X, DVec3::new(0.0, -1.0, -0.0)]);
            let Ok(ray) = Ray::new(origin, scale_point(direction, length)) else { continue };
            for (i, triangle) in (0..).zip(&triangles) {
                let Some(t) = triangle.closest(&ray, f64::NEG_INFINITY..f64::INFINITY) else { continue };
                for level in [Level::new(), Level::baseline()] {
                    let met_by = |line: Line64| {
                        let met = met(&crown, level, line);
                        assert!(met.contains(&Part::Triangle(i)), "{level:?} {t:?} {ray:?} {triangle:?}");
                        met.len()
                    };
                    kept += met_by(line(&ray, t..t.next_up()));
                    hits += 1;
                    if t >= 0.0 {
                        met_by(with_others(&ray, t..t.next_up(), random));
                        met_by(with_others(&ray, 0.0..t.next_up(), random));
                    }
                }
            }
        }
        assert!(hits > 1_500 && kept < 6 * hits, "{kept} met for {hits} hits");
    }

    #[test]
    fn rays_that_are_not_ordinary_meet_everything_and_others_what_is_far_away() {
        let far = Sphere::new(DVec3::splat(1e300), 1e299).unwrap();
        let near = Sphere::new(DVec3::X, 0.5).unwrap();
        let mut crown = Crown::default();
        let root = crown
            .add(vec![(Box64::of_spheres(&[far]), Part::Sphere(0)), (Box64::of_spheres(&[near]), Part::Sphere(1))]);
        let crown = crown.with_root(root);
        let all = f64::NEG_INFINITY..f64::INFINITY;
        let [o, x] = [DVec3::ZERO, DVec3::X];
        // The origin, the direction, and how many may be hit.
        for (origin, direction, count) in [
            (o, DVec3::ONE, 2),
            (o, x, 1),
            (o, -x, 1),
            (o, DVec3::Y, 0),
            (o, x * 1e-300, 2),
            (o, DVec3::new(1.0, 1e-300, 0.0), 2),
            (x * 1e200, x, 2),
        ] {
            let ray = Ray::new(origin, direction).unwrap();
            assert_eq!(met(&crown, Level::new(), line(&ray, all.clone())).len(), count, "{ray:?}");
        }
    }
}
