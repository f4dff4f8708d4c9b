//! Rays from one point in nearly one direction, as a camera sends them through neighbouring pixels: a tile of them walks
//! the tree as one.
//!
//! At a node the whole tile is culled at once, by the greatest and the least component of its directions along each axis.
//! At a leaf block balls meet the four planes around the tile; what is left meets the tile's rays, sixteen at a time in
//! f32. The walk is in `tile_walk.rs`; every ray gets the answer that it would get alone. (I. Wald et al., "Interactive
//! Rendering with Coherent Ray Tracing", 2001; K. Boulos et al., "Packet-based Whitted and Distribution Ray Tracing",
//! 2007, for one test of a whole packet.)

use std::ops::Range;

use fearless_simd::{Simd, f32x16, f64x8, prelude::*};
use glam::{DVec3, Vec3};

use super::crown::Line64;
use super::cull::{LINE_ERROR, MAX_INVERSE, Slab, U, across, bits, load, slabs};
use super::node::{Balls, Block, Boxes, Frame, Lanes, WIDTH, up};
use crate::Ray;
use crate::lanes::PencilLanes;
use crate::leaf::Closest;
use crate::ray::{Candidate, larger, smaller};

/// Rays of a tile at most.
pub(super) const RAYS: usize = 64;
const GROUPS: usize = RAYS / WIDTH;
/// Rays that meet a primitive in f64 at once.
pub(super) const EIGHT: usize = 8;

/// The rounding errors of all tests in f32, as a distance, for each unit of the largest parameter.
const SLACK: f32 = 32.0 * U;
/// The largest parameter, the distance from the origin in cull coordinates, that a tile may have.
const REACH: f64 = 64.0;
/// A vector with a smaller square has no direction: squares that underflow would make it too long.
const LEAST_NORMAL: f32 = 1.0 / (1u128 << 100) as f32;
/// The components of a tile's directions differ by no more than this.
const SPREAD: f32 = 0.25;
/// How wide a tile may be at the scene's center, in spaces between primitives that are spread evenly: at four to six a
/// tile costs what its rays cost alone. No answer depends on it.
const WIDEST: f32 = 8.0;

/// A plane through the origin of the rays; what lies more than its radius beyond is met by none.
#[derive(Clone, Copy, Debug)]
struct Plane {
    normal: Vec3,
    offset: f32,
}

impl Plane {
    /// How far beyond the plane points are.
    #[inline(always)]
    fn beyond<S: Simd>(&self, simd: S, [x, y, z]: [f32x16<S>; 3]) -> f32x16<S> {
        let along = z.mul_add(f32x16::splat(simd, self.normal.z), f32x16::splat(simd, -self.offset));
        let along = y.mul_add(f32x16::splat(simd, self.normal.y), along);
        x.mul_add(f32x16::splat(simd, self.normal.x), along)
    }
}

/// The rays of a tile, made ready in one frame. Lanes beyond the last ray repeat it.
pub(super) struct Tile {
    count: usize,
    /// How wide a tile pays, in cull coordinates.
    widest: f32,
    /// What there is to be culled.
    has_balls: bool,
    has_boxes: bool,
    /// Tests of bounds so far.
    pub(super) work: u32,
    /// In f32 and cull coordinates: the origin, unit directions and their reciprocals, and the parameters up to which
    /// each ray is of interest.
    origin: Vec3,
    along: [[Lanes; 3]; GROUPS],
    inverse: [[Lanes; 3]; GROUPS],
    end: [Lanes; GROUPS],
    /// The greatest of these, and what none exceeds: `D` of the numerics.
    pub(super) last: f32,
    farthest: f32,
    slack: f32,
    /// The cull of boxes for all rays at once.
    pub(super) near: [Slab; 3],
    pub(super) far: [Slab; 3],
    /// The cull of balls for all rays at once: the four sides, and in front.
    planes: [Plane; 5],
    origin64: DVec3,
    direction: [[f64; RAYS]; 3],
    reach: [f64; RAYS],
    square: [f64; RAYS],
    inverse_square: [f64; RAYS],
    /// A unit of `t` in cull coordinates, and the error of parameters in them.
    length: [f64; RAYS],
    error: f64,
    /// The best hits so far.
    pub(super) low: [f64; RAYS],
    pub(super) high: [f64; RAYS],
    pub(super) place: [usize; RAYS],
}

impl Tile {
    /// For [`gather`](Self::gather) and [`enter`](Self::enter) to fill, in a tree of so many primitives.
    #[expect(clippy::cast_possible_truncation, clippy::cast_precision_loss, reason = "no answer depends on it")]
    pub(super) fn new(spheres: usize, triangles: usize) -> Self {
        let widest = WIDEST / ((spheres + triangles) as f64).cbrt() as f32;
        Self { widest, has_balls: spheres > 0, has_boxes: triangles > 0, ..Self::EMPTY }
    }

    const EMPTY: Self = {
        let (zero, slab, plane) = (Lanes::splat(0.0), (0, 0.0, 0.0), Plane { normal: Vec3::ZERO, offset: 0.0 });
        Self {
            count: 0,
            widest: 0.0,
            has_balls: true,
            has_boxes: true,
            work: 0,
            origin: Vec3::ZERO,
            along: [[zero; 3]; GROUPS],
            inverse: [[zero; 3]; GROUPS],
            end: [zero; GROUPS],
            last: 0.0,
            farthest: 0.0,
            slack: 0.0,
            near: [slab; 3],
            far: [slab; 3],
            planes: [plane; 5],
            origin64: DVec3::ZERO,
            direction: [[0.0; RAYS]; 3],
            reach: [0.0; RAYS],
            square: [0.0; RAYS],
            inverse_square: [0.0; RAYS],
            length: [0.0; RAYS],
            error: 0.0,
            low: [0.0; RAYS],
            high: [0.0; RAYS],
            place: [0; RAYS],
        }
    };

    /// Takes up the rays; `false` if they have several origins.
    #[inline(always)]
    pub(super) fn gather(&mut self, rays: &[Ray], order: &[usize]) -> bool {
        let first = &rays[order[0]];
        self.count = order.len();
        self.work = 0;
        let lanes = order.len().next_multiple_of(WIDTH);
        for lane in 0..lanes {
            let ray = &rays[order[lane.min(order.len() - 1)]];
            if ray.origin() != first.origin() {
                return false;
            }
            for (axis, direction) in self.direction.iter_mut().enumerate() {
                direction[lane] = ray.direction()[axis];
            }
            self.reach[lane] = ray.reach();
            self.square[lane] = ray.square();
            self.inverse_square[lane] = ray.inverse_square();
        }
        self.origin64 = first.origin();
        self.low[..lanes].fill(f64::INFINITY);
        self.high[..lanes].fill(f64::INFINITY);
        self.place[..lanes].fill(Closest::NOWHERE);
        // Nothing is better than what these lanes have.
        self.low[order.len()..lanes].fill(0.0);
        self.high[order.len()..lanes].fill(0.0);
        true
    }

    /// Makes the rays ready in a frame; `false` if they do not make a tile there, because they are too far apart or too
    /// far away, or one is not ordinary.
    #[inline(always)]
    pub(super) fn enter<S: Simd>(&mut self, simd: S, frame: &Frame, end: f64) -> bool {
        let origin = frame.point(self.origin64);
        let reach = 1.0 + (origin.x.abs() + origin.y.abs() + origin.z.abs());
        if reach.is_nan() || reach > REACH {
            return false;
        }
        self.origin = origin.as_vec3();
        self.error = reach * LINE_ERROR;
        self.farthest = up(reach);
        self.slack = SLACK * self.farthest + up(self.error);

        let (mut least, mut greatest) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for group in 0..self.groups() {
            let Some(halves) = self.directions(simd, frame, WIDTH * group) else { return false };
            for axis in 0..3 {
                let w = halves[0][axis].narrow(halves[1][axis]);
                w.store_slice(&mut self.along[group][axis].0);
                least[axis] = least[axis].min(w.reduce_min());
                greatest[axis] = greatest[axis].max(w.reduce_max());
            }
        }
        for axis in 0..3 {
            let (least, greatest) = (least[axis], greatest[axis]);
            if greatest - least > SPREAD.min(self.widest / self.farthest) {
                return false;
            }
            let inverse = |x: f32| 1.0 / x.abs().max(1.0 / MAX_INVERSE);
            let o = self.origin[axis];
            // Who goes up enters at the lower plane, and soonest who goes up most.
            let (near, far, from, to) = if least >= 0.0 {
                (axis, axis + 3, inverse(greatest), inverse(least))
            } else if greatest <= 0.0 {
                (axis + 3, axis, -inverse(least), -inverse(greatest))
            } else {
                return false;
            };
            let side = self.slack.copysign(from);
            self.near[axis] = (near, from, -((o + side) * from));
            self.far[axis] = (far, to, -((o - side) * to));
        }
        if self.has_boxes {
            self.invert(simd);
        }
        if self.has_balls {
            self.surround(simd, Vec3::from(least) + Vec3::from(greatest));
        }
        for group in 0..self.groups() {
            self.shorten(simd, group, end);
        }
        self.find_last(simd);
        true
    }

    /// All rays as the crown meets them; `None` if the directions differ in the sign of a component.
    #[inline(always)]
    pub(super) fn line(&self, within: &Range<f64>) -> Option<Line64> {
        let directions = self.direction.each_ref().map(|numbers| &numbers[..self.count]);
        let least = DVec3::from(directions.map(|numbers| numbers.iter().copied().fold(f64::INFINITY, smaller)));
        let greatest = DVec3::from(directions.map(|numbers| numbers.iter().copied().fold(f64::NEG_INFINITY, larger)));
        let ordinary = self.reach[..self.count].iter().all(|&reach| reach > 0.0);
        let one_sign = (least.cmpge(DVec3::ZERO) | greatest.cmple(DVec3::ZERO)).all();
        (ordinary && one_sign).then(|| Line64::of_many(self.origin64, least, greatest, within.clone()))
    }

    /// No hit beyond this changes an answer.
    #[inline(always)]
    pub(super) fn limit(&self) -> f64 {
        self.high[..self.count].iter().copied().fold(0.0, larger)
    }

    pub(super) fn groups(&self) -> usize {
        self.count.div_ceil(WIDTH)
    }

    /// The unit directions of sixteen rays, eight and eight, and their units of `t` in cull coordinates; `None` if one
    /// is not ordinary.
    #[inline(always)]
    fn directions<S: Simd>(&mut self, simd: S, frame: &Frame, at: usize) -> Option<[[f64x8<S>; 3]; 2]> {
        let (mut ordinary, mut halves) = (u64::MAX, [[f64x8::splat(simd, 0.0); 3]; 2]);
        for (half, along) in halves.iter_mut().enumerate() {
            let at = at + EIGHT * half;
            let square = eight(simd, &self.square, at);
            let root = square.sqrt();
            let length = root * frame.scale();
            length.store_slice(&mut self.length[at..at + EIGHT]);
            ordinary &= inside(simd, square, 1e-280..1e280) & inside(simd, length, f64::MIN_POSITIVE..f64::INFINITY);
            let unit = root * eight(simd, &self.inverse_square, at);
            for (along, direction) in along.iter_mut().zip(&self.direction) {
                *along = eight(simd, direction, at) * unit;
            }
        }
        (ordinary & 0xff == 0xff).then_some(halves)
    }

    /// The reciprocals of the directions. Components that are zero, or nearly, count as the least that are not.
    #[inline(always)]
    fn invert<S: Simd>(&mut self, simd: S) {
        for group in 0..self.groups() {
            for axis in 0..3 {
                let sign = f32x16::splat(simd, 1f32.copysign(self.near[axis].1));
                let w = load(simd, &self.along[group][axis]).abs().max(f32x16::splat(simd, 1.0 / MAX_INVERSE));
                (sign / w).store_slice(&mut self.inverse[group][axis].0);
            }
        }
    }

    /// Finds the planes around the rays.
    #[inline(always)]
    fn surround<S: Simd>(&mut self, simd: S, middle: Vec3) {
        let direction = |lane: usize| {
            let along = &self.along[lane / WIDTH];
            Vec3::new(along[0].0[lane % WIDTH], along[1].0[lane % WIDTH], along[2].0[lane % WIDTH])
        };
        let axis = middle.normalize();
        let [first, next] = [0, 3.min(self.count - 1)].map(direction);
        let right = next - first;
        let right = (right - right.dot(axis) * axis).try_normalize().unwrap_or_else(|| across(axis)[0]);
        let top = axis.cross(right);
        let (mut least, mut greatest) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
        for along in &self.along[..self.groups()] {
            let depth = dot(simd, along, axis);
            for (i, side) in [right, top].into_iter().enumerate() {
                let slope = dot(simd, along, side) / depth;
                least[i] = least[i].min(slope.reduce_min());
                greatest[i] = greatest[i].max(slope.reduce_max());
            }
        }
        let sides =
            [right - greatest[0] * axis, least[0] * axis - right, top - greatest[1] * axis, least[1] * axis - top];
        // However the planes were found: how far rays may be outside. A normal of zero, where rays differ by rounding
        // alone, bounds nothing; one that is NaN would bound everything, and one that is too long drops what is touched.
        let groups = self.groups();
        for (plane, side) in self.planes.iter_mut().zip(sides) {
            let is_long = side.length_squared() >= LEAST_NORMAL;
            let normal = if is_long { side.normalize_or_zero() } else { Vec3::ZERO };
            let mut outside = f32x16::splat(simd, 0.0);
            for along in &self.along[..groups] {
                outside = outside.max(dot(simd, along, normal));
            }
            let offset = normal.dot(self.origin) + (self.slack + 2.0 * self.farthest * outside.reduce_max());
            *plane = Plane { normal, offset };
        }
        self.planes[4] = Plane { normal: -axis, offset: self.slack - axis.dot(self.origin) };
    }

    /// What the rays of a group meet beyond `limit` is of no interest any more, nor beyond their best hits.
    #[inline(always)]
    pub(super) fn shorten<S: Simd>(&mut self, simd: S, group: usize, limit: f64) {
        let at = WIDTH * group;
        let end = self.ends(simd, at, limit).narrow(self.ends(simd, at + EIGHT, limit));
        // The rounding to f32.
        let end = end.mul_add(f32x16::splat(simd, 4.0 * U), end).min(f32x16::splat(simd, self.farthest));
        end.store_slice(&mut self.end[group].0);
    }

    /// The ends of eight rays before they are rounded.
    #[inline(always)]
    fn ends<S: Simd>(&self, simd: S, at: usize, limit: f64) -> f64x8<S> {
        let high = eight(simd, &self.high, at).min(f64x8::splat(simd, limit));
        high.mul_add(eight(simd, &self.length, at), f64x8::splat(simd, self.error))
    }

    #[inline(always)]
    pub(super) fn find_last<S: Simd>(&mut self, simd: S) {
        let mut last = f32x16::splat(simd, 0.0);
        for end in &self.end[..self.groups()] {
            last = last.max(load(simd, end));
        }
        self.last = last.reduce_max();
    }

    /// Which of the rays may meet a ball, as bits.
    #[inline(always)]
    fn near_ball<S: Simd>(&self, simd: S, center: Vec3, radius: f32) -> u64 {
        let v = center - self.origin;
        let mut met = 0;
        for group in 0..self.groups() {
            let [x, y, z] = three(simd, &self.along[group]);
            let a = z.mul_sub(f32x16::splat(simd, v.y), y * v.z);
            let b = x.mul_sub(f32x16::splat(simd, v.z), z * v.x);
            let c = y.mul_sub(f32x16::splat(simd, v.x), x * v.y);
            let t = dot(simd, &self.along[group], v);
            let beyond = t - t.max(f32x16::splat(simd, 0.0)).min(load(simd, &self.end[group]));
            let square = a.mul_add(a, b.mul_add(b, c.mul_add(c, beyond * beyond)));
            let reach = f32x16::splat(simd, radius + self.slack);
            met |= square.simd_le(reach * reach).to_bitmask() << (WIDTH * group);
        }
        met
    }

    /// Which of the rays may meet a box, as bits.
    #[inline(always)]
    fn near_box<S: Simd>(&self, simd: S, boxes: &Boxes, lane: usize) -> u64 {
        let mut met = 0;
        let plane = |row: usize, axis: usize| {
            let slack = if row < 3 { -self.slack } else { self.slack };
            boxes.0[row].0[lane] + slack - self.origin[axis]
        };
        let near = [0, 1, 2].map(|axis| plane(self.near[axis].0, axis));
        let far = [0, 1, 2].map(|axis| plane(self.far[axis].0, axis));
        for group in 0..self.groups() {
            let [x, y, z] = three(simd, &self.inverse[group]);
            let enter = (x * near[0]).max(y * near[1]).max((z * near[2]).max(f32x16::splat(simd, 0.0)));
            let leave = (x * far[0]).min(y * far[1]).min((z * far[2]).min(load(simd, &self.end[group])));
            met |= enter.simd_le(leave).to_bitmask() << (WIDTH * group);
        }
        met
    }

    /// The best hit of a ray so far.
    #[inline(always)]
    pub(super) fn best(&self, lane: usize) -> Closest {
        Closest { bounds: Candidate { low: self.low[lane], high: self.high[lane] }, place: self.place[lane] }
    }

    #[inline(always)]
    pub(super) fn keep(&mut self, lane: usize, best: &Closest) {
        (self.low[lane], self.high[lane], self.place[lane]) = (best.bounds.low, best.bounds.high, best.place);
    }

    /// Eight rays for the filters.
    #[inline(always)]
    pub(super) fn lanes<S: Simd>(&self, simd: S, at: usize) -> PencilLanes<S> {
        let [x, y, z] = &self.direction;
        PencilLanes {
            origin: self.origin64,
            direction: [eight(simd, x, at), eight(simd, y, at), eight(simd, z, at)],
            reach: eight(simd, &self.reach, at),
            square: eight(simd, &self.square, at),
            inverse_square: eight(simd, &self.inverse_square, at),
        }
    }
}

#[inline(always)]
pub(super) fn eight<S: Simd>(simd: S, numbers: &[f64; RAYS], at: usize) -> f64x8<S> {
    f64x8::from_slice(simd, &numbers[at..at + EIGHT])
}

/// Which lanes lie strictly between two numbers, as bits.
#[inline(always)]
fn inside<S: Simd>(simd: S, x: f64x8<S>, Range { start, end }: Range<f64>) -> u64 {
    (x.simd_gt(f64x8::splat(simd, start)) & x.simd_lt(f64x8::splat(simd, end))).to_bitmask()
}

#[inline(always)]
fn three<S: Simd>(simd: S, [x, y, z]: &[Lanes; 3]) -> [f32x16<S>; 3] {
    [load(simd, x), load(simd, y), load(simd, z)]
}

#[inline(always)]
fn dot<S: Simd>(simd: S, along: &[Lanes; 3], v: Vec3) -> f32x16<S> {
    let [x, y, z] = three(simd, along);
    x.mul_add(f32x16::splat(simd, v.x), y.mul_add(f32x16::splat(simd, v.y), z * v.z))
}

/// Which of a block's bounds the tile, and which of its rays each may meet.
pub(super) trait TileBlock: Block {
    fn meet_tile<S: Simd>(&self, simd: S, tile: &Tile) -> u32;
    fn near<S: Simd>(&self, simd: S, tile: &Tile, lane: usize) -> u64;
}

impl TileBlock for Balls {
    #[inline(always)]
    fn meet_tile<S: Simd>(&self, simd: S, tile: &Tile) -> u32 {
        let center = three(simd, &self.center);
        let radius = load(simd, &self.radius);
        let [a, b, c, d, behind] = &tile.planes;
        let sides = a.beyond(simd, center).max(b.beyond(simd, center));
        let most = sides.max(c.beyond(simd, center).max(d.beyond(simd, center)));
        let behind = behind.beyond(simd, center);
        // In front is what is not behind, turned about.
        let beyond = -behind - (tile.last + 3.0 * tile.slack);
        bits(most.max(behind.max(beyond)).simd_le(radius).to_bitmask())
    }

    #[inline(always)]
    fn near<S: Simd>(&self, simd: S, tile: &Tile, lane: usize) -> u64 {
        let center = Vec3::new(self.center[0].0[lane], self.center[1].0[lane], self.center[2].0[lane]);
        tile.near_ball(simd, center, self.radius.0[lane])
    }
}

impl TileBlock for Boxes {
    #[inline(always)]
    fn meet_tile<S: Simd>(&self, simd: S, tile: &Tile) -> u32 {
        let (enter, leave) = slabs(simd, self, tile.near, tile.far, (0.0, tile.last));
        bits(enter.simd_le(leave).to_bitmask())
    }

    #[inline(always)]
    fn near<S: Simd>(&self, simd: S, tile: &Tile, lane: usize) -> u64 {
        tile.near_box(simd, self, lane)
    }
}

#[cfg(test)]
mod tests {
    use fearless_simd::Level;
    use oracle::Random;

    use super::super::node::Ball;
    use super::*;
    use crate::simd::dispatch;
    use crate::{AHEAD, Sphere, Triangle};

    /// Which rays each bound is near to, if the tile meets it; the ends are those of the hits themselves.
    #[inline(always)]
    fn near<S: Simd, B: TileBlock>(simd: S, frame: &Frame, rays: &[Ray], block: &B, ends: &[f64]) -> Option<[u64; 16]> {
        let order: Vec<usize> = (0..rays.len()).collect();
        let mut tile = Tile::new(1, 1);
        if !(tile.gather(rays, &order) && tile.enter(simd, frame, f64::INFINITY)) {
            return None;
        }
        tile.high[..ends.len()].copy_from_slice(ends);
        for group in 0..tile.groups() {
            tile.shorten(simd, group, f64::INFINITY);
        }
        tile.find_last(simd);
        let met = block.meet_tile(simd, &tile);
        let mut near = [0; 16];
        for (lane, near) in near.iter_mut().enumerate().filter(|(lane, _)| met >> lane & 1 == 1) {
            *near = block.near(simd, &tile, lane);
        }
        Some(near)
    }

    fn check<B: TileBlock>(
        leaves: &[B::Leaf],
        hit: impl Fn(&B::Leaf, &Ray) -> Option<f64>,
        aim: impl Fn(&B::Leaf, &mut Random) -> DVec3,
        random: &mut Random,
    ) -> (u32, u32) {
        let frame = Frame::around(Sphere::new(DVec3::ZERO, 1.75).ok().as_ref());
        let (mut kept, mut hits) = (0, 0);
        let mut block = B::EMPTY;
        for (lane, leaf) in leaves.iter().enumerate() {
            block.bound(lane, leaf, &frame);
        }
        for round in 0..200 {
            let eye = random.point() * 2f64.powi(round % 6);
            let along = aim(&leaves[random.below(16)], random) - eye;
            let width = along.length() * 2f64.powi(-random.integer(6..54));
            let length = random.power(-90..90);
            let ray = |random: &mut Random| Ray::new(eye, length * (along + width * random.point())).unwrap();
            let rays: Vec<Ray> = (0..1 + random.below(RAYS)).map(|_| ray(random)).collect();
            let ts: Vec<Vec<Option<f64>>> =
                leaves.iter().map(|leaf| rays.iter().map(|ray| hit(leaf, ray)).collect()).collect();
            let first = |ray: usize| ts.iter().filter_map(|ts| ts[ray]).fold(f64::INFINITY, f64::min);
            let ends: Vec<f64> = (0..rays.len()).map(first).collect();
            for level in [Level::new(), Level::baseline()] {
                let near = dispatch!(level, simd => near(simd, &frame, &rays, &block, &ends));
                let Some(near) = near else { continue };
                for (near, ts) in near.iter().zip(&ts) {
                    kept += near.count_ones();
                    for (ray, _) in ts.iter().enumerate().filter(|&(ray, &t)| t.is_some_and(|t| t <= ends[ray])) {
                        assert!(near >> ray & 1 == 1, "{level:?} {:?} {:?}", rays[ray], ends[ray]);
                        hits += 1;
                    }
                }
            }
        }
        (kept, hits)
    }

    /// Tiles down to a few doubles wide, aimed at the silhouettes of balls and at the corners of triangles, with ends
    /// that are the hits themselves.
    #[test]
    fn the_tile_drops_no_hit_and_most_of_the_rest() {
        let random = &mut Random::new(4);
        let (mut kept, mut hits) = ([0; 2], [0; 2]);
        for _ in 0..20 {
            let spheres: Vec<Sphere> =
                (0..16).map(|_| Sphere::new(random.point(), random.power(-20..-1)).unwrap()).collect();
            let triangles: Vec<Triangle> = (0..16)
                .map(|_| {
                    let (at, size) = (0.8 * random.point(), random.power(-12..-2));
                    let mut corner = || at + size * random.point();
                    Triangle::new(corner(), corner(), corner()).unwrap()
                })
                .collect();
            let edge = |sphere: &Sphere, random: &mut Random| sphere.center() + sphere.radius() * random.direction();
            let corner = |triangle: &Triangle, random: &mut Random| random.pick(&triangle.vertices());
            let (a, b) = check::<Balls>(&spheres, |sphere, ray| sphere.closest(ray, AHEAD), edge, random);
            let (c, d) = check::<Boxes>(&triangles, |triangle, ray| triangle.closest(ray, AHEAD), corner, random);
            kept = [kept[0] + a, kept[1] + c];
            hits = [hits[0] + b, hits[1] + d];
        }
        assert!(hits[0] > 10_000 && hits[1] > 10_000, "{hits:?}");
        assert!(kept[0] < 4 * hits[0] && kept[1] < 10 * hits[1], "{kept:?} for {hits:?}");
    }

    #[inline(always)]
    fn around<S: Simd>(simd: S, depths: [f32; 2], block: &Balls) -> ([Plane; 5], u32) {
        let mut tile = Tile::new(1, 0);
        (tile.count, tile.farthest, tile.last) = (16, 4.0, 4.0);
        for (lane, z) in tile.along[0][2].0.iter_mut().enumerate() {
            *z = depths[usize::from(lane != 0)];
        }
        tile.surround(simd, Vec3::new(0.0, 0.0, depths[0] + depths[1]));
        (tile.planes, block.meet_tile(simd, &tile))
    }

    /// The normal of a plane around rays may be anything where they differ along themselves: here two sides of it are so
    /// short that their squares are subnormal, and a vector of length 1.22 came of it.
    #[test]
    fn a_plane_is_a_unit_vector_or_none_and_a_touched_ball_is_kept() {
        #[inline(always)]
        fn met<S: Simd>(simd: S, block: &Balls) -> ([Plane; 5], u32) {
            let mut tile = Tile::new(1, 0);
            (tile.count, tile.farthest, tile.last, tile.slack) = (4, 1.0, 1.0, SLACK);
            let one = std::f32::consts::FRAC_1_SQRT_2;
            let lengths = [one.next_down(), one, one.next_down(), one.next_down().next_down()];
            for lane in 0..WIDTH {
                let length = lengths[lane.min(3)];
                for (axis, x) in [7.717_442e-30, length, length].into_iter().enumerate() {
                    tile.along[0][axis].0[lane] = x;
                }
            }
            let middle = one + one.next_down().next_down();
            tile.surround(simd, Vec3::new(2.0 * 7.717_442e-30, middle, middle));
            (tile.planes, block.meet_tile(simd, &tile))
        }
        // Half-way along the rays, and beside them by nearly the radius.
        let mut block = Balls::EMPTY;
        for (lane, aside) in [0.2, -0.2].into_iter().enumerate() {
            block.set(lane, Ball { center: [0.0, 0.35 + aside, 0.35 - aside], radius: 0.29 });
        }
        for level in [Level::new(), Level::baseline()] {
            let (planes, met) = dispatch!(level, simd => met(simd, &block));
            for plane in planes {
                let length = plane.normal.as_dvec3().length();
                assert!(length == 0.0 || (length - 1.0).abs() <= f64::from(5.0 * U), "{level:?} {plane:?} {length}");
            }
            assert_eq!(met, 3, "{level:?} {planes:?}");
        }
    }

    /// Unit vectors in f32 may differ by a rounding along themselves: then there is no direction across them. Planes are
    /// numbers all the same: whether a maximum with NaN is one depends on the processor.
    #[test]
    fn rays_that_differ_by_rounding_alone_have_planes_and_meet_what_is_ahead() {
        let mut block = Balls::EMPTY;
        block.set(0, Ball { center: [0.0, 0.0, -2.0], radius: 0.5 });
        let one = 1.0f32;
        for depths in [[-one, -one.next_down()], [-one.next_down(), -one], [-one.next_up(), -one], [-one; 2]] {
            for level in [Level::new(), Level::baseline()] {
                let (planes, met) = dispatch!(level, simd => around(simd, depths, &block));
                assert!(planes.iter().all(|plane| plane.normal.is_finite() && plane.offset.is_finite()), "{planes:?}");
                assert_eq!(met, 1, "{level:?} {depths:?}");
            }
        }
    }
}
