//! Cuts a polygon into triangles between its own corners: ear clipping, with exact orientations.
//!
//! The corners are projected along a coordinate axis, which keeps them exact, and the triangles are chosen in that
//! plane. The idea: a corner whose triangle with its two neighbours turns the polygon's way and holds nothing of the
//! rest is an ear; it is cut off, and the rest is a smaller polygon. Cutting off a triangle changes the winding number
//! by just that triangle. So where all triangles turn the polygon's way, as here, each point is covered as often as the
//! polygon winds around it: once inside a simple polygon, never outside. G. H. Meisters, "Polygons Have Ears", 1975.
//!
//! - A polygon first turns so that it starts from its least corner, so the cut does not depend on which is listed
//!   first.
//! - A corner in the middle of a side is no ear. It becomes the corner of some triangle, and the neighbouring face,
//!   which has it too, meets the same sides: no gap opens.
//! - A corner may be listed twice, as where a cut joins a hole to the outline. Such a corner blocks a triangle that it
//!   is a corner of only if one of its own sides leads into it.
//! - A convex polygon without such a corner is a fan and takes linear time. Else the corners that can block, those that
//!   are not convex, stand in a tree of boxes: usually a few microseconds a corner, at worst a time that grows with the
//!   square of their number.

use std::cmp::Ordering;
use std::collections::VecDeque;

use glam::{DVec3, Vec3Swizzles};
use rt_geom::Triangle;
use rt_math::exact::{Dyadic, U};

/// The corners of a polygon that is not convex, at most; it bounds the time that one face can take.
pub(super) const MOST_CORNERS: usize = 1 << 17;

/// Positions in the list of corners.
type Cut = [u32; 3];

/// How a polygon was cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    /// Every triangle turns the polygon's way.
    Exact,
    /// The polygon crosses itself, and what was left when there was no ear is cut as a fan.
    Crossed,
    /// It has more than [`MOST_CORNERS`] and is not convex; nothing was cut.
    TooLarge,
}

/// What a cut needs to work in, kept from polygon to polygon.
#[derive(Default)]
pub(super) struct Cutter {
    /// The corners from the least one on, projected so that the polygon turns counterclockwise.
    points: Vec<PlanePoint>,
    /// The position in the list of corners of the first of them.
    first: usize,
    next: Vec<u32>,
    before: Vec<u32>,
    /// The corners that may be ears, each at most once.
    queue: VecDeque<u32>,
    queued: Vec<bool>,
    posts: Posts,
}

type PlanePoint = [f64; 2];

impl Cutter {
    /// Cuts the polygon with these corners, at least three, and appends its triangles, which turn as the polygon does.
    pub(super) fn cut(&mut self, corners: &[DVec3], triangles: &mut Vec<Cut>) -> Outcome {
        let n = corners.len();
        self.first = least_rotation(corners);
        let first = self.first;
        let from_least = (0..n).map(|at| corners[wrapped(first + at, n)]);
        let Some((axis, turn)) = facing(from_least.clone()) else {
            // No area on the whole: all on a line, or loops that cancel.
            self.fan((0..n).map(index), n, triangles);
            return if are_on_a_line(corners) { Outcome::Exact } else { Outcome::Crossed };
        };
        let (mut i, mut j) = ((axis + 1) % 3, (axis + 2) % 3);
        if turn == Ordering::Less {
            (i, j) = (j, i);
        }
        self.points.clear();
        self.points.extend(from_least.map(|corner| [corner[i], corner[j]]));
        if is_strictly_convex(&self.points) {
            self.fan((0..n).map(index), n, triangles);
            return Outcome::Exact;
        }
        if n > MOST_CORNERS {
            return Outcome::TooLarge;
        }
        self.clip(triangles)
    }

    /// A fan from the first of some corners.
    fn fan(&self, mut corners: impl Iterator<Item = u32>, n: usize, triangles: &mut Vec<Cut>) {
        let (Some(hub), Some(mut last)) = (corners.next(), corners.next()) else { return };
        for corner in corners {
            self.push([hub, last, corner], n, triangles);
            last = corner;
        }
    }

    fn push(&self, corners: Cut, n: usize, triangles: &mut Vec<Cut>) {
        triangles.push(corners.map(|corner| index(wrapped(self.first + corner as usize, n))));
    }

    /// Links the corners into a ring, takes each as a possible ear, and plants those that can block one.
    fn start(&mut self) {
        let n = self.points.len();
        self.next.clear();
        self.next.extend((0..n).map(|at| index(wrapped(at + 1, n))));
        self.before.clear();
        self.before.extend((0..n).map(|at| index(wrapped(at + n - 1, n))));
        self.queued.clear();
        self.queued.resize(n, true);
        self.queue.clear();
        self.queue.extend((0..n).map(index));
        let corner = |at: usize| self.points[wrapped(at, n)];
        let convex = |at: &usize| orientation(corner(at + n - 1), corner(*at), corner(at + 1)) == Ordering::Greater;
        self.posts.plant((0..n).filter(|at| !convex(at)).map(index), &self.points);
    }

    /// Cuts off ear after ear.
    fn clip(&mut self, triangles: &mut Vec<Cut>) -> Outcome {
        self.start();
        let n = self.points.len();
        let (mut left, mut passes, mut some) = (n, 0, 0);
        while left > 2 {
            let Some(v) = self.queue.pop_front() else {
                // Ears of a simple polygon appear beside an ear that is cut, and were queued then. In one whose sides
                // touch, and so in what is left of it, one may appear elsewhere.
                if passes == PASSES {
                    break;
                }
                passes += 1;
                let mut at = some;
                for _ in 0..left {
                    self.queue.push_back(at);
                    self.queued[at as usize] = true;
                    at = self.next[at as usize];
                }
                continue;
            };
            self.queued[v as usize] = false;
            let (u, w) = (self.before[v as usize], self.next[v as usize]);
            let [p, q, r] = [u, v, w].map(|at| self.points[at as usize]);
            match orientation(p, q, r) {
                Ordering::Greater if !self.is_blocked([u, v, w]) => {
                    self.push([u, v, w], n, triangles);
                }
                // A corner twice in a row, or a way there and back along one line.
                Ordering::Equal if p == q || q == r || is_before(p, q) != is_before(q, r) => {}
                _ => continue,
            }
            self.posts.pull(v);
            (self.next[u as usize], self.before[w as usize]) = (w, u);
            (left, some) = (left - 1, u);
            for at in [u, w] {
                let corners = [self.before[at as usize], at, self.next[at as usize]];
                let [p, q, r] = corners.map(|at| self.points[at as usize]);
                if orientation(p, q, r) == Ordering::Greater {
                    self.posts.pull(at);
                }
                if !std::mem::replace(&mut self.queued[at as usize], true) {
                    self.queue.push_back(at);
                }
            }
        }
        if left < 3 {
            return Outcome::Exact;
        }
        let rest = std::iter::successors(Some(some), |&at| Some(self.next[at as usize]));
        self.fan(rest.take(left), n, triangles);
        Outcome::Crossed
    }

    /// Whether a corner of the rest lies in the closed triangle of three that follow each other, so that it is no ear.
    fn is_blocked(&self, corners: Cut) -> bool {
        let [u, v, w] = corners;
        let [p, q, r] = corners.map(|at| self.points[at as usize]);
        self.posts.any(&self.points, [p, q, r], |z| {
            if z == u || z == v || z == w {
                return false;
            }
            let at = self.points[z as usize];
            let sides = [orientation(p, q, at), orientation(q, r, at), orientation(r, p, at)];
            let leads_in = |inside: &dyn Fn(PlanePoint) -> bool| {
                [self.before[z as usize], self.next[z as usize]].into_iter().any(|z| inside(self.points[z as usize]))
            };
            let left_of = |from, to, at| orientation(from, to, at) == Ordering::Greater;
            match sides.map(|side| side == Ordering::Equal) {
                _ if sides.contains(&Ordering::Less) => false,
                [false, false, false] => true,
                // On the cut itself; at its ends its sides cannot lead into the triangle without ending there.
                [_, _, true] => at != p && at != r,
                [true, true, _] => leads_in(&|at| left_of(p, q, at) && left_of(q, r, at)),
                [true, ..] => leads_in(&|at| left_of(p, q, at)),
                [_, true, _] => leads_in(&|at| left_of(q, r, at)),
            }
        })
    }
}

/// How often all corners are tried again when no ear is known. A simple polygon never needs that.
const PASSES: u32 = 8;

/// Some corners in a tree of boxes, to ask which of them lie in a triangle.
#[derive(Default)]
struct Posts {
    /// The corners, those of each node together: a node's first half is its first child's.
    order: Vec<u32>,
    /// For each corner of the polygon its place in `order`, from 1; 0 once it is removed.
    place: Vec<u32>,
    /// Node `k` has the children `2 k + 1` and `2 k + 2`: its box, low and high, and how many of its corners are left.
    nodes: Vec<([PlanePoint; 2], u32)>,
}

/// Up to this many corners are tested one by one.
const LEAF: usize = 8;

impl Posts {
    fn plant(&mut self, corners: impl Iterator<Item = u32>, points: &[PlanePoint]) {
        self.order.clear();
        self.order.extend(corners);
        self.place.clear();
        self.place.resize(points.len(), 0);
        self.nodes.clear();
        if !self.order.is_empty() {
            build(&mut self.order, points, 0, &mut self.nodes);
        }
        for (at, &corner) in (1..).zip(&self.order) {
            self.place[corner as usize] = at;
        }
    }

    /// Takes a corner out, if it is there.
    fn pull(&mut self, corner: u32) {
        let place = std::mem::take(&mut self.place[corner as usize]);
        let Some(place) = (place as usize).checked_sub(1) else { return };
        let (mut node, mut range) = (0, 0..self.order.len());
        loop {
            self.nodes[node].1 -= 1;
            if range.len() <= LEAF {
                return;
            }
            let middle = range.start.midpoint(range.end);
            (node, range) =
                if place < middle { (2 * node + 1, range.start..middle) } else { (2 * node + 2, middle..range.end) };
        }
    }

    /// Whether `blocks` holds for a corner in the tree; those outside the triangle's box are skipped.
    fn any(&self, points: &[PlanePoint], triangle: [PlanePoint; 3], mut blocks: impl FnMut(u32) -> bool) -> bool {
        let [p, q, r] = triangle;
        let low = [0, 1].map(|k| p[k].min(q[k]).min(r[k]));
        let high = [0, 1].map(|k| p[k].max(q[k]).max(r[k]));
        let apart = |from: PlanePoint, to: PlanePoint| (0..2).any(|k| to[k] < low[k] || high[k] < from[k]);
        // A box lies beyond a side if its corner farthest to the side's left does.
        let beyond = |[from, to]: [PlanePoint; 2], [low, high]: [PlanePoint; 2]| {
            let x = if to[1] > from[1] { low[0] } else { high[0] };
            let y = if to[0] > from[0] { high[1] } else { low[1] };
            orientation(from, to, [x, y]) == Ordering::Less
        };
        let mut stack = Vec::with_capacity(64);
        if !self.nodes.is_empty() {
            stack.push((0, 0..self.order.len()));
        }
        while let Some((node, range)) = stack.pop() {
            let (bounds, left) = self.nodes[node];
            if left == 0 || apart(bounds[0], bounds[1]) {
                continue;
            }
            if range.len() > LEAF {
                if [[p, q], [q, r], [r, p]].into_iter().any(|side| beyond(side, bounds)) {
                    continue;
                }
                let middle = range.start.midpoint(range.end);
                stack.push((2 * node + 2, middle..range.end));
                stack.push((2 * node + 1, range.start..middle));
                continue;
            }
            for &corner in &self.order[range] {
                let at = points[corner as usize];
                if self.place[corner as usize] != 0 && !apart(at, at) && blocks(corner) {
                    return true;
                }
            }
        }
        false
    }
}

/// Sorts corners into a tree below `node`: halves along the longer side of their box.
fn build(order: &mut [u32], points: &[PlanePoint], node: usize, nodes: &mut Vec<([PlanePoint; 2], u32)>) {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for &corner in &*order {
        for k in 0..2 {
            low[k] = low[k].min(points[corner as usize][k]);
            high[k] = high[k].max(points[corner as usize][k]);
        }
    }
    if nodes.len() <= node {
        nodes.resize(node + 1, ([[0.0; 2]; 2], 0));
    }
    nodes[node] = ([low, high], index(order.len()));
    if order.len() <= LEAF {
        return;
    }
    let axis = usize::from(high[1] - low[1] > high[0] - low[0]);
    let middle = order.len() / 2;
    order.select_nth_unstable_by(middle, |&a, &b| {
        points[a as usize][axis].total_cmp(&points[b as usize][axis]).then(a.cmp(&b))
    });
    let (first, second) = order.split_at_mut(middle);
    build(first, points, 2 * node + 1, nodes);
    build(second, points, 2 * node + 2, nodes);
}

/// Whether all corners turn left and the outline goes around once.
///
/// Going around once, the direction changes between rising and falling (in x, then y) just twice.
fn is_strictly_convex(points: &[PlanePoint]) -> bool {
    let n = points.len();
    let mut changes = 0;
    for at in 0..n {
        let [p, q, r] = [points[at], points[wrapped(at + 1, n)], points[wrapped(at + 2, n)]];
        if orientation(p, q, r) != Ordering::Greater {
            return false;
        }
        changes += u32::from(is_before(p, q) != is_before(q, r));
    }
    changes == 2
}

fn is_before(p: PlanePoint, q: PlanePoint) -> bool {
    p[0] < q[0] || (p[0] == q[0] && p[1] < q[1])
}

/// How a polygon's corners compare in lists: by x, then y, then z; zeros of both signs are equal.
fn compare(p: DVec3, q: DVec3) -> Ordering {
    p.to_array().partial_cmp(&q.to_array()).expect("corners are finite")
}

/// Returns the start of the rotation of a list that comes first in the order of lists, in linear time.
///
/// Source: Y. Shiloach, "Fast canonization of circular strings", Journal of Algorithms 2 (1981).
fn least_rotation(corners: &[DVec3]) -> usize {
    let n = corners.len();
    let (mut i, mut j, mut equal) = (0, 1, 0);
    while i < n && j < n && equal < n {
        match compare(corners[wrapped(i + equal, n)], corners[wrapped(j + equal, n)]) {
            Ordering::Equal => {
                equal += 1;
                continue;
            }
            // No rotation that starts in the part just compared can be the least.
            Ordering::Greater => i += equal + 1,
            Ordering::Less => j += equal + 1,
        }
        if i == j {
            j += 1;
        }
        equal = 0;
    }
    i.min(j)
}

/// A position below `2 n` among `n` that go around. (A remainder would cost a short polygon more than all else.)
fn wrapped(at: usize, n: usize) -> usize {
    if at < n { at } else { at - n }
}

/// Positions in a polygon fit 32 bits: a line of a file has far fewer bytes than that.
fn index(at: usize) -> u32 {
    u32::try_from(at).expect("a polygon comes from one line of a file")
}

/// Twice the area along an axis is a sum of at most 2^21 terms (a line has so many words), each a multiple of 2^-2148
/// of at most 2^2051: 68 limbs. An orientation is one such term.
type AreaInteger = Dyadic<68>;

/// Returns an axis along which the polygon is seen with an area, and how it turns there.
///
/// The area is at least half of that along any other axis. `None` if all three are exactly zero.
///
/// Each difference is off by `u`, each product by `3.01 u` and what underflows, and a sum of `n` terms by `n u` more,
/// relative to the sum of the magnitudes of all products. The bound is twice that, for the rounding of itself; an area
/// of four times the bound is off by less than a third of the true one.
fn facing(corners: impl Iterator<Item = DVec3> + Clone) -> Option<(usize, Ordering)> {
    let start = corners.clone().next()?;
    let spokes = corners.clone().skip(1).map(|corner| corner - start);
    let (mut area, mut size, mut count) = (DVec3::ZERO, DVec3::ZERO, 0.0);
    for (v, w) in spokes.clone().zip(spokes.skip(1)) {
        let (left, right) = (v.yzx() * w.zxy(), v.zxy() * w.yzx());
        area += left - right;
        size += left.abs() + right.abs();
        count += 1.0;
    }
    let axis = largest(area.to_array().map(f64::abs), |a, b| a > b);
    let error = (2.0 * count + 16.0) * U * size.max_element() + count * f64::MIN_POSITIVE;
    // False for NaN.
    if area[axis].abs() > 4.0 * error && size.is_finite() {
        return Some((axis, area[axis].total_cmp(&0.0)));
    }
    exact_facing(start, corners)
}

#[cold]
fn exact_facing(start: DVec3, corners: impl Iterator<Item = DVec3> + Clone) -> Option<(usize, Ordering)> {
    let spoke = |corner: DVec3| [0, 1, 2].map(|k| AreaInteger::from_f64(corner[k]) - AreaInteger::from_f64(start[k]));
    let mut area = [AreaInteger::ZERO; 3];
    for (v, w) in corners.clone().zip(corners.skip(1)) {
        let (v, w) = (spoke(v), spoke(w));
        for (k, area) in area.iter_mut().enumerate() {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            *area = &*area + &(&v[i] * &w[j] - &v[j] * &w[i]);
        }
    }
    let axis = largest(area.clone().map(AreaInteger::abs), |a, b| (a - b).sign() == Ordering::Greater);
    match area[axis].sign() {
        Ordering::Equal => None,
        turn => Some((axis, turn)),
    }
}

/// The position of the largest of three; of equal ones the last.
fn largest<T>(values: [T; 3], above: impl Fn(&T, &T) -> bool) -> usize {
    let [x, y, z] = &values;
    match (above(x, y), above(x, z), above(y, z)) {
        (true, true, _) => 0,
        (false, _, true) => 1,
        _ => 2,
    }
}

fn are_on_a_line(corners: &[DVec3]) -> bool {
    let start = corners[0];
    let Some(&other) = corners.iter().find(|&&corner| corner != start) else { return true };
    corners.iter().all(|&corner| Triangle::new(start, other, corner).map_or(true, |triangle| triangle.is_degenerate()))
}

/// Which way three points turn: `Greater` is counterclockwise, `Equal` on a line. Exact for finite coordinates.
///
/// Each product in the determinant is off by at most `3.01 u` of itself, and by what underflows; the last subtraction
/// has the sign of its exact operands' difference.
fn orientation(p: PlanePoint, q: PlanePoint, r: PlanePoint) -> Ordering {
    // Modelled in docs/proofs/Polygon.v.
    let left = (q[0] - p[0]) * (r[1] - p[1]);
    let right = (q[1] - p[1]) * (r[0] - p[0]);
    let error = 4.0 * U * (left.abs() + right.abs()) + f64::MIN_POSITIVE;
    let value = left - right;
    // False for NaN, and where a product overflows.
    if value.abs() > error && error < f64::INFINITY { value.total_cmp(&0.0) } else { exact_orientation(p, q, r) }
}

#[cold]
fn exact_orientation(p: PlanePoint, q: PlanePoint, r: PlanePoint) -> Ordering {
    let difference = |a: f64, b: f64| AreaInteger::from_f64(a) - AreaInteger::from_f64(b);
    let left = &difference(q[0], p[0]) * &difference(r[1], p[1]);
    let right = &difference(q[1], p[1]) * &difference(r[0], p[0]);
    (left - right).sign()
}

#[cfg(test)]
mod tests {
    use super::*;
    use oracle::{Big, Random, exact};
    use std::collections::HashMap;

    /// Twice the signed area of a triangle, seen along an axis, exactly.
    fn area(corners: [DVec3; 3], axis: usize) -> Big {
        let [p, q, r] = corners.map(|corner| [1, 2].map(|k| exact(corner[(axis + k) % 3])));
        (&q[0] - &p[0]) * (&r[1] - &p[1]) - (&q[1] - &p[1]) * (&r[0] - &p[0])
    }

    fn total(areas: impl Iterator<Item = Big>) -> Big {
        areas.fold(Big::ZERO, |sum, area| sum + area)
    }

    /// Twice the signed area of a polygon.
    fn whole_area(corners: &[DVec3], axis: usize) -> Big {
        total(corners[1..].windows(2).map(|pair| area([corners[0], pair[0], pair[1]], axis)))
    }

    fn cut(corners: &[DVec3]) -> (Outcome, Vec<Cut>) {
        let mut triangles = Vec::new();
        (Cutter::default().cut(corners, &mut triangles), triangles)
    }

    /// Checks that a simple polygon is cut into triangles that all turn its way and meet side to side; such triangles
    /// cover it exactly once.
    fn check(corners: &[DVec3], what: &str) -> Vec<Cut> {
        let (outcome, triangles) = cut(corners);
        let n = corners.len();
        assert_eq!(outcome, Outcome::Exact, "{what}: {corners:?}");
        assert_eq!(triangles.len(), n - 2, "{what}: {corners:?}");
        // Some axis along which the polygon has an area; all triangles have one of its sign there.
        let axes = [0, 1, 2].map(|axis| whole_area(corners, axis));
        let zero = Big::ZERO;
        let turned = |axis: usize| {
            axes[axis] != zero
                && triangles.iter().all(|cut| {
                    let area = area(cut.map(|at| corners[at as usize]), axis);
                    area != zero && (area > zero) == (axes[axis] > zero)
                })
        };
        assert!((0..3).any(turned), "{what}: a triangle turns the other way: {corners:?}: {triangles:?}");
        let mut sides = HashMap::new();
        for cut in &triangles {
            for k in 0..3 {
                *sides.entry((cut[k], cut[(k + 1) % 3])).or_insert(0) += 1;
            }
        }
        for (&(from, to), &count) in &sides {
            let own = (from + 1) as usize % n == to as usize;
            let back = sides.get(&(to, from)).copied().unwrap_or(0);
            assert_eq!((count, back), (1, i32::from(!own)), "{what}: side {from} {to} of {corners:?}");
        }
        triangles
    }

    /// The triangles' corners themselves, in an order of their own.
    fn shapes(corners: &[DVec3], triangles: &[Cut]) -> Vec<[[f64; 3]; 3]> {
        let mut shapes: Vec<_> = triangles
            .iter()
            .map(|cut| {
                let mut shape = cut.map(|at| corners[at as usize].to_array());
                let least = (0..3).min_by(|&a, &b| shape[a].partial_cmp(&shape[b]).unwrap()).unwrap();
                shape.rotate_left(least);
                shape
            })
            .collect();
        shapes.sort_by(|a, b| a.partial_cmp(b).unwrap());
        shapes
    }

    /// Checks a polygon in the plane from every start, both ways round, in the given planes.
    fn check_all_ways(outline: &[[f64; 2]], planes: &[[DVec3; 3]], what: &str) {
        for [origin, x, y] in planes {
            let mut corners: Vec<DVec3> = outline.iter().map(|at| origin + at[0] * x + at[1] * y).collect();
            for _ in 0..2 {
                let rotations = corners.len().min(7);
                let expected = shapes(&corners, &check(&corners, what));
                for turn in 1..=rotations {
                    corners.rotate_left(turn);
                    let triangles = check(&corners, what);
                    assert_eq!(shapes(&corners, &triangles), expected, "{what}: {corners:?}");
                }
                corners.reverse();
            }
        }
    }

    /// Planes in which whole numbers stay exact, and others in which the corners come out flat but for rounding.
    fn planes(random: &mut Random) -> Vec<[DVec3; 3]> {
        let mut planes = vec![
            [DVec3::ZERO, DVec3::X, DVec3::Y],
            [DVec3::ZERO, DVec3::Y, DVec3::Z],
            [DVec3::new(1.0, 2.0, 3.0), DVec3::new(1.0, 0.0, -1.0), DVec3::new(1.0, 2.0, -1.0)],
            [DVec3::splat(1e9), DVec3::new(2.0, 3.0, 6.0), DVec3::new(-3.0, 6.0, -2.0)],
            [DVec3::ZERO, 1e-200 * DVec3::X, 1e-200 * DVec3::Z],
            [DVec3::ZERO, 1e200 * DVec3::Z, 1e200 * DVec3::Y],
        ];
        planes.extend((0..3).map(|_| [random.point(), random.point(), random.point()]));
        planes
    }

    /// Walks out along one arm of a spiral and back along another.
    fn spiral(corners: u32) -> Vec<[f64; 2]> {
        let arm = |turn: f64, width: f64| {
            let (sine, cosine) = turn.sin_cos();
            [((turn + width) * cosine * 1000.0).round(), ((turn + width) * sine * 1000.0).round()]
        };
        // Twenty corners to a winding, so that the sides of neighbouring windings are parallel.
        let turn = |k: u32| 1.0 + std::f64::consts::TAU / 20.0 * f64::from(k);
        let outward = (0..corners).map(|k| arm(turn(k), 0.0));
        outward.chain((0..corners).rev().map(|k| arm(turn(k), 2.0))).collect()
    }

    /// Teeth of random lengths on a bar.
    fn comb(teeth: u32, random: &mut Random) -> Vec<[f64; 2]> {
        let mut outline = vec![[0.0, 0.0], [f64::from(4 * teeth), 0.0]];
        for tooth in (0..teeth).rev() {
            let x = f64::from(4 * tooth);
            let tip = 2.0 + (100.0 * random.share()).round();
            outline.extend([[x + 3.0, 1.0], [x + 3.0, tip], [x + 1.0, tip], [x + 1.0, 1.0]]);
        }
        outline
    }

    /// Corners at random whole distances along as many directions, in the order of their angles.
    fn star(corners: u32, random: &mut Random) -> Vec<[f64; 2]> {
        let step = std::f64::consts::TAU / f64::from(corners);
        (0..corners)
            .map(|k| {
                let (sine, cosine) = (step * f64::from(k)).sin_cos();
                let far = 1e4 * (0.05 + random.share());
                [(far * cosine).round(), (far * sine).round()]
            })
            .collect()
    }

    /// The same outline with whole points added in the middle of its sides.
    fn with_points_on_sides(outline: &[[f64; 2]], random: &mut Random) -> Vec<[f64; 2]> {
        let mut more = Vec::new();
        for (at, &[x, y]) in outline.iter().enumerate() {
            let [to_x, to_y] = outline[(at + 1) % outline.len()];
            let parts = 1 + random.below(4);
            // Scaled so that every part of a side has whole corners.
            more.extend((0..parts).map(|k| {
                let share = 12.0 * k as f64 / parts as f64;
                [12.0 * x + share * (to_x - x), 12.0 * y + share * (to_y - y)]
            }));
        }
        more
    }

    #[test]
    fn simple_polygons_are_covered_exactly_once_whichever_corner_comes_first() {
        let random = &mut Random::new(1);
        let planes = planes(random);
        let notched = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 1.0], [0.0, 4.0]];
        check_all_ways(&notched, &planes, "notch");
        let l = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
        check_all_ways(&l, &planes, "L");
        check_all_ways(&[[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0]], &planes, "square");
        check_all_ways(&[[0.0, 0.0], [3.0, 0.0], [1.0, 1.0], [0.0, 3.0]], &planes, "arrowhead");
        for corners in [5, 12, 40] {
            check_all_ways(&spiral(corners), &planes, "spiral");
            check_all_ways(&comb(corners / 4, random), &planes, "comb");
            check_all_ways(&star(corners, random), &planes, "star");
        }
    }

    #[test]
    fn corners_on_sides_belong_to_a_triangle() {
        let random = &mut Random::new(2);
        // Planes that keep the corners exactly on their sides.
        let planes = &planes(random)[..4];
        for _ in 0..4 {
            let triangle = with_points_on_sides(&[[0.0, 0.0], [5.0, 1.0], [2.0, 7.0]], random);
            if triangle.len() > 3 {
                check_all_ways(&triangle, planes, "triangle with points on its sides");
            }
            check_all_ways(&with_points_on_sides(&comb(3, random), random), planes, "comb with points on its sides");
            check_all_ways(&with_points_on_sides(&star(9, random), random), planes, "star with points on its sides");
        }
    }

    #[test]
    fn many_small_polygons_on_a_grid_are_cut_exactly() {
        // Whole coordinates from 0 to 6 make every degenerate case; those that cross themselves are sorted out by an
        // oracle that compares all pairs of sides.
        let random = &mut Random::new(3);
        let (mut simple, mut crossed) = (0, 0);
        while simple < 4000 {
            let n = 4 + random.below(6);
            let outline: Vec<[f64; 2]> = (0..n).map(|_| [random.below(7) as f64, random.below(7) as f64]).collect();
            if !is_simple(&outline) {
                crossed += 1;
                // Whatever it is, it ends, with a triangle for each corner but two at most.
                let corners: Vec<DVec3> = outline.iter().map(|at| DVec3::new(at[0], at[1], 0.0)).collect();
                assert!(cut(&corners).1.len() <= n - 2);
                continue;
            }
            simple += 1;
            let plane = [DVec3::ZERO, DVec3::new(2.0, 3.0, 6.0), DVec3::new(-3.0, 6.0, -2.0)];
            check_all_ways(&outline, &[plane], "grid");
        }
        assert!(crossed > 1000);
    }

    /// Whether no two sides meet but at the corner that they share.
    fn is_simple(outline: &[[f64; 2]]) -> bool {
        let n = outline.len();
        let side = |at: usize| (outline[at % n], outline[(at + 1) % n]);
        // Coordinates are small whole numbers, so this is exact.
        let turn = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| {
            ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])).partial_cmp(&0.0).unwrap()
        };
        let within = |p: [f64; 2], q: [f64; 2], at: [f64; 2]| {
            turn(p, q, at) == Ordering::Equal && (0..2).all(|k| p[k].min(q[k]) <= at[k] && at[k] <= p[k].max(q[k]))
        };
        (0..n).all(|i| {
            let (p, q) = side(i);
            let (_, next) = side(i + 1);
            p != q
                && !within(p, q, next)
                && !within(q, next, p)
                && (i + 2..n).filter(|j| (j + 1) % n != i).all(|j| {
                    let (r, s) = side(j);
                    let crosses = turn(p, q, r) != turn(p, q, s) && turn(r, s, p) != turn(r, s, q);
                    !(crosses || within(p, q, r) || within(p, q, s) || within(r, s, p) || within(r, s, q))
                })
        })
    }

    #[test]
    fn a_hole_joined_to_the_outline_stays_a_hole() {
        // A square with a square hole; corners 0 and 5, and 4 and 9, are the same points.
        let outline = [(0, 0), (9, 0), (9, 9), (0, 9), (0, 0), (3, 3), (3, 6), (6, 6), (6, 3), (3, 3)];
        let outline = outline.map(|(x, y)| [f64::from(x), f64::from(y)]);
        for start in 0..10 {
            let corners: Vec<DVec3> =
                (0..10).map(|at| outline[(start + at) % 10]).map(|[x, y]| DVec3::new(x, y, 0.25 * x)).collect();
            let (outcome, triangles) = cut(&corners);
            assert_eq!(outcome, Outcome::Exact, "from {start}");
            let areas: Vec<Big> = triangles.iter().map(|cut| area(cut.map(|at| corners[at as usize]), 2)).collect();
            assert!(areas.iter().all(|area| *area > Big::ZERO), "from {start}: {triangles:?}");
            assert_eq!(total(areas.into_iter()), Big::from(2 * (81 - 9)), "from {start}");
        }
    }

    #[test]
    fn corners_listed_twice_make_no_triangle() {
        let corner = |x: f64, y: f64| DVec3::new(x, 0.0, y);
        let corners = [(0.0, 0.0), (0.0, 0.0), (5.0, 0.0), (5.0, 5.0), (5.0, 5.0), (7.0, 5.0), (5.0, 5.0), (0.0, 5.0)];
        let corners = corners.map(|(x, y)| corner(x, y));
        let (outcome, triangles) = cut(&corners);
        assert_eq!(outcome, Outcome::Exact);
        let areas: Vec<Big> = triangles.iter().map(|cut| area(cut.map(|at| corners[at as usize]), 1)).collect();
        assert_eq!(areas.len(), 2);
        assert_eq!(total(areas.into_iter()), Big::from(-50));
    }

    #[test]
    fn a_polygon_that_crosses_itself_is_told() {
        let cut = |outline: &[(f64, f64)]| {
            let (outcome, triangles) = cut(&outline.iter().map(|&(x, y)| DVec3::new(x, y, 1.0)).collect::<Vec<_>>());
            (outcome, triangles.len())
        };
        // A bow tie with equal wings, one with unequal wings, and corners on a line.
        assert_eq!(cut(&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)]), (Outcome::Crossed, 2));
        assert_eq!(cut(&[(0.0, 0.0), (3.0, 3.0), (3.0, 0.0), (0.0, 1.0)]).0, Outcome::Crossed);
        assert_eq!(cut(&[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0), (3.0, 3.0)]), (Outcome::Exact, 2));
    }

    #[test]
    fn large_polygons_are_cut() {
        let random = &mut Random::new(4);
        let plane = |outline: Vec<[f64; 2]>| -> Vec<DVec3> {
            outline.into_iter().map(|[x, y]| DVec3::new(x, y, 0.5 * x)).collect()
        };
        for (outline, what) in [
            (comb(25_000, random), "comb"),
            (spiral(50_000), "spiral"),
            ((0..100_000).map(|k| [f64::from(k.min(50_000)), f64::from((k - 50_000).max(0))]).collect(), "corner"),
        ] {
            let n = outline.len();
            let (outcome, triangles) = cut(&plane(outline));
            assert_eq!((outcome, triangles.len()), (Outcome::Exact, n - 2), "{what}");
        }
        let n = MOST_CORNERS + 1;
        let circle = (0..n).map(|k| (std::f64::consts::TAU * k as f64 / n as f64).sin_cos());
        let mut corners = plane(circle.map(|(y, x)| [x, y]).collect());
        let (outcome, triangles) = cut(&corners);
        assert_eq!((outcome, triangles.len()), (Outcome::Exact, n - 2));
        corners[1000] = DVec3::ZERO;
        assert_eq!(cut(&corners), (Outcome::TooLarge, vec![]));
    }
}
