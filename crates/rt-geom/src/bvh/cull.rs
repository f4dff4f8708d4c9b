//! The cull: which of sixteen bounds can a ray still meet within its range? It may keep too much and never drops a hit.
//!
//! A ray enters as a [`CullRay`]: in cull coordinates, measured from the point of its line that is nearest to the
//! scene's center. So every number here is of the order of 1, however far the ray's origin is, and each rounding error
//! is a small multiple of 2^-24. The slack that makes up for them is derived in `docs/numerics.md`, section 9.
//!
//! - Boxes: the entry and exit of three slabs (T. Kay and J. Kajiya, "Ray Tracing Complex Scenes", 1986), each slab
//!   widened by the slack.
//! - Balls: the distance from a center to the *segment* that is still of interest, in a frame of the ray. Nothing
//!   cancels, there is no square root, and one comparison culls in front, behind, beyond the best hit and aside.

use fearless_simd::{Simd, f32x4, f32x16, f64x4, mask32x16, prelude::*, u32x16};
use glam::{DVec3, Vec3};

use super::node::{Balls, Block, Boxes, Frame, Lanes, WIDTH, down, up};
use crate::lanes::four;
use crate::ray::{PreparedRay, larger};

/// Half the spacing of f32 numbers at 1.
pub(super) const U: f32 = 1.0 / (1 << 24) as f32;
/// The rounding errors of the box test, as a displacement of a plane.
const BOX_SLACK: f32 = 8.0 * U;
/// The rounding errors of the ball test, as a distance.
const BALL_SLACK: f32 = 64.0 * U;
/// The rounding errors of the f64 part, for each unit of distance between origin and center.
pub(super) const LINE_ERROR: f64 = 1.0 / (1u64 << 46) as f64;
/// Beyond this error nothing is culled.
const MAX_LINE_ERROR: f64 = 1.0 / 16.0;
/// Parameters of points in the unit ball lie within this, the error included.
const REACH: f64 = 1.125;
/// More than the rounding of a parameter to f32.
const ROUNDING: f64 = 1.0 / (1 << 22) as f64;
/// The reciprocals of a direction's components are no larger than this.
pub(super) const MAX_INVERSE: f32 = (1u64 << 40) as f32;
/// Added to keys: makes them positive, so that their bits are in order.
const KEY_SHIFT: f32 = 4.0;

/// A ray made ready for culling in one frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct CullRay {
    /// Rows of [`Boxes`] that hold the near planes, `axis` or `axis + 3`, and the far ones, the others.
    near: [usize; 3],
    far: [usize; 3],
    /// By axis; the last lane means nothing.
    inverse: [f32; 4],
    near_offset: [f32; 4],
    far_offset: [f32; 4],
    /// Two unit vectors across the direction, and the direction.
    axes: [Vec3; 3],
    offset: [f32; 3],
    ball_slack: f32,
    start: f32,
    end: f32,
    /// The parameter of `t` is at most `t * length + last_offset`, rounded to the nearest f32.
    length: f64,
    last_offset: f64,
}

impl CullRay {
    /// Prepares the ray for parameters `t` from `start` to `end`; `false` if all of it passes by the unit ball.
    ///
    /// Without `balls` it is ready for boxes alone.
    ///
    /// In place, because a copy of what has just been written piece by piece waits for the writes.
    #[inline(always)]
    pub(super) fn set<S: Simd>(&mut self, simd: S, frame: &Frame, prepared: &PreparedRay, balls: bool) -> bool {
        let PreparedRay { ray, start, end, mut square, inverse_square: mut inverse, .. } = *prepared;
        let origin = frame.lanes(simd, ray.origin());
        let mut along = four(simd, ray.direction());
        let mut unit = 1.0;
        if square.is_nan() {
            // The ray is not ordinary: the square of its direction may over- or underflow.
            let direction;
            (direction, unit) = scaled(ray.direction());
            along = four(simd, direction);
            square = direction.length_squared();
            inverse = 1.0 / square;
        }
        let error = (1.0 + sum(origin.abs())) * LINE_ERROR;
        let error_up = up(error);
        // What takes long begins first, and no division waits for another or for the root.
        let reciprocal = 1.0 / along;
        let length = square.sqrt();
        let direction = along * (length * inverse);
        let dot = sum(origin * along);
        let base = -dot * (length * inverse);
        let nearest = origin - along * (dot * inverse);
        let unscaled_length = length;
        let length = length * (unit * frame.scale());
        // Written so that NaN goes this way.
        if !(error < MAX_LINE_ERROR && length > f64::MIN_POSITIVE && length < f64::INFINITY) {
            *self = Self::EVERYTHING;
            return true;
        }
        let first = (start * length - base - error).max(-REACH);
        let last = (end * length - base + error).min(REACH);
        if sum(nearest * nearest) > (1.0 + error) * (1.0 + error) || first > last {
            return false;
        }
        let (w, q) = (narrow_lanes(simd, direction), narrow_lanes(simd, nearest));
        let inverse = narrow_lanes(simd, reciprocal * unscaled_length);
        let inverse = inverse.abs().min(f32x4::splat(simd, MAX_INVERSE)).copysign(inverse);
        let center = q * inverse;
        let slack = inverse.abs() * (BOX_SLACK + error_up);
        inverse.store_slice(&mut self.inverse);
        (-(center + slack)).store_slice(&mut self.near_offset);
        (slack - center).store_slice(&mut self.far_offset);
        for axis in 0..3 {
            let back = 3 * usize::from(inverse[axis].is_sign_negative());
            self.near[axis] = axis + back;
            self.far[axis] = axis + 3 - back;
        }
        if balls {
            self.axes = across(Vec3::new(w[0], w[1], w[2]));
            for (offset, axis) in self.offset.iter_mut().zip(&self.axes) {
                *offset = axis.x * q[0] + axis.y * q[1] + axis.z * q[2];
            }
        }
        self.ball_slack = BALL_SLACK + error_up;
        self.start = down(first);
        self.end = up(last);
        self.length = length;
        self.last_offset = error - base + ROUNDING;
        true
    }

    /// Meets every bound: for rays whose arithmetic has no accuracy left.
    pub(super) const EVERYTHING: Self = Self {
        near: [0, 1, 2],
        far: [3, 4, 5],
        inverse: [1.0 / (1 << 30) as f32; 4],
        near_offset: [-8.0; 4],
        far_offset: [8.0; 4],
        axes: [Vec3::ZERO; 3],
        offset: [0.0; 3],
        ball_slack: 8.0,
        start: -2.0,
        end: 2.0,
        length: 0.0,
        last_offset: 1.0,
    };

    /// Meets nothing.
    pub(super) const NOTHING: Self = Self { start: 2.0, end: -2.0, ..Self::EVERYTHING };

    /// From now on, only what reaches the parameter `t` or less is of interest.
    #[inline(always)]
    pub(super) fn shorten(&mut self, t: f64) {
        // Exact parameters that round to minus infinity lie below the least double, and are equal to each other.
        let t = larger(t, f64::MIN);
        #[expect(clippy::cast_possible_truncation, reason = "the offset makes up for the rounding")]
        let last = (t * self.length + self.last_offset) as f32;
        // NaN, from an infinite t, shortens nothing.
        if last < self.end {
            self.end = last;
        }
    }

    /// The greatest key that is still of interest.
    #[inline(always)]
    pub(super) fn last_key(&self) -> u32 {
        (self.end + KEY_SHIFT).to_bits()
    }
}

/// The sum of the first three lanes.
#[inline(always)]
fn sum<S: Simd>(v: f64x4<S>) -> f64 {
    v[0] + v[1] + v[2]
}

/// The nearest f32 numbers: the error counts in the slack.
#[inline(always)]
fn narrow_lanes<S: Simd>(simd: S, v: f64x4<S>) -> f32x4<S> {
    let (low, high) = v.split();
    simd.narrow_f64x2(low, high)
}

/// The vector divided by a power of two near its greatest component, and that power.
#[cold]
fn scaled(d: DVec3) -> (DVec3, f64) {
    let greatest = d.abs().max_element();
    // The reciprocal must be finite too.
    let power = f64::from_bits((greatest.to_bits() >> 52).clamp(2, 2044) << 52);
    (d / power, power)
}

/// Two unit vectors that form a right-handed frame with the unit vector `w`, and `w`.
///
/// Source: T. Duff et al., "Building an Orthonormal Basis, Revisited", 2017.
#[inline(always)]
pub(super) fn across(w: Vec3) -> [Vec3; 3] {
    let sign = 1.0_f32.copysign(w.z);
    let a = -1.0 / (sign + w.z);
    let b = w.x * w.y * a;
    [Vec3::new(1.0 + sign * w.x * w.x * a, sign * b, -sign * w.x), Vec3::new(b, sign + w.y * w.y * a, -w.y), w]
}

/// The boxes met, as bits; and a key for each: in the order of entry, meaningless where not met.
#[inline(always)]
pub(super) fn meet_boxes<S: Simd>(simd: S, line: &CullRay, boxes: &Boxes, keys: &mut [u32; WIDTH]) -> u32 {
    let (key, mask) = box_keys(simd, line, boxes);
    key.store_slice(keys);
    bits(mask.to_bitmask())
}

/// The same in registers.
#[inline(always)]
pub(super) fn box_keys<S: Simd>(simd: S, line: &CullRay, boxes: &Boxes) -> (u32x16<S>, mask32x16<S>) {
    let near = |axis: usize| (line.near[axis], line.inverse[axis], line.near_offset[axis]);
    let far = |axis: usize| (line.far[axis], line.inverse[axis], line.far_offset[axis]);
    let (enter, leave) =
        slabs(simd, boxes, [near(0), near(1), near(2)], [far(0), far(1), far(2)], (line.start, line.end));
    ((enter + KEY_SHIFT).bitcast(), enter.simd_le(leave))
}

/// A row of planes, and where it is met: the plane times the first number, plus the second.
pub(super) type Slab = (usize, f32, f32);

/// Where each box is entered and left, between two ends.
#[inline(always)]
pub(super) fn slabs<S: Simd>(
    simd: S,
    boxes: &Boxes,
    near: [Slab; 3],
    far: [Slab; 3],
    (start, end): (f32, f32),
) -> (f32x16<S>, f32x16<S>) {
    let [x, y, z] = near;
    let enter = planes(simd, boxes, x).max(planes(simd, boxes, y));
    let enter = enter.max(planes(simd, boxes, z).max(f32x16::splat(simd, start)));
    let [x, y, z] = far;
    let leave = planes(simd, boxes, x).min(planes(simd, boxes, y));
    (enter, leave.min(planes(simd, boxes, z).min(f32x16::splat(simd, end))))
}

/// Where a line meets a row of planes. (Not a closure: a closure would not be compiled for the instruction set.)
#[inline(always)]
fn planes<S: Simd>(simd: S, boxes: &Boxes, (row, inverse, offset): Slab) -> f32x16<S> {
    load(simd, &boxes.0[row]).mul_add(f32x16::splat(simd, inverse), f32x16::splat(simd, offset))
}

/// The balls met, as bits.
#[inline(always)]
fn meet_balls<S: Simd>(simd: S, line: &CullRay, balls: &Balls) -> u32 {
    let center = (load(simd, &balls.center[0]), load(simd, &balls.center[1]), load(simd, &balls.center[2]));
    let x = along(simd, center, line.axes[0], line.offset[0]);
    let y = along(simd, center, line.axes[1], line.offset[1]);
    let t = along(simd, center, line.axes[2], line.offset[2]);
    let beyond = t - t.max(f32x16::splat(simd, line.start)).min(f32x16::splat(simd, line.end));
    let squared = x.mul_add(x, y.mul_add(y, beyond * beyond));
    let reach = load(simd, &balls.radius) + line.ball_slack;
    bits(squared.simd_le(reach * reach).to_bitmask())
}

/// A leaf block that the cull takes.
pub(super) trait Culled: Block {
    /// Which primitives a ray may meet, as bits.
    fn meet<S: Simd>(&self, simd: S, line: &CullRay) -> u32;
}

impl Culled for Balls {
    #[inline(always)]
    fn meet<S: Simd>(&self, simd: S, line: &CullRay) -> u32 {
        meet_balls(simd, line, self)
    }
}

impl Culled for Boxes {
    #[inline(always)]
    fn meet<S: Simd>(&self, simd: S, line: &CullRay) -> u32 {
        meet_boxes(simd, line, self, &mut [0; WIDTH])
    }
}

/// How far along an axis the points are.
#[inline(always)]
pub(super) fn along<S: Simd>(
    simd: S,
    (x, y, z): (f32x16<S>, f32x16<S>, f32x16<S>),
    axis: Vec3,
    offset: f32,
) -> f32x16<S> {
    let z = z.mul_add(f32x16::splat(simd, axis.z), f32x16::splat(simd, -offset));
    let yz = y.mul_add(f32x16::splat(simd, axis.y), z);
    x.mul_add(f32x16::splat(simd, axis.x), yz)
}

#[inline(always)]
pub(super) fn load<S: Simd>(simd: S, lanes: &Lanes) -> f32x16<S> {
    f32x16::from_slice(simd, &lanes.0)
}

#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "sixteen bits are set at most")]
pub(super) fn bits(mask: u64) -> u32 {
    mask as u32
}

#[cfg(test)]
mod tests {
    use fearless_simd::Level;
    use oracle::Random;

    use super::*;
    use crate::simd::dispatch;
    use crate::{Ray, Sphere, Triangle};

    #[inline(always)]
    fn met<S: Simd, B: Culled>(simd: S, frame: &Frame, ray: &PreparedRay, block: &B) -> u32 {
        let mut line = CullRay::EVERYTHING;
        if line.set(simd, frame, ray, true) { block.meet(simd, &line) } else { 0 }
    }

    fn check<B: Culled>(
        leaves: &[B::Leaf],
        hits: impl Fn(&B::Leaf, &Ray) -> Option<f64>,
        random: &mut Random,
    ) -> (u32, u32) {
        let frame = Frame::around(Sphere::new(DVec3::ZERO, 1.75).ok().as_ref());
        let (mut kept, mut hit) = (0, 0);
        let mut block = B::EMPTY;
        for (lane, leaf) in leaves.iter().enumerate() {
            block.bound(lane, leaf, &frame);
        }
        for round in 0..400 {
            let origin = random.point() * 2f64.powi(round % 36);
            let direction = (random.point() - origin) * 2f64.powi(round % 21 - 10);
            let Ok(ray) = Ray::new(origin, direction) else { continue };
            let ts: Vec<Option<f64>> = leaves.iter().map(|leaf| hits(leaf, &ray)).collect();
            let first = ts.iter().flatten().copied().fold(f64::INFINITY, f64::min);
            for (start, end) in [(0.0, f64::INFINITY), (first, first.next_up())] {
                let prepared = PreparedRay::new(&ray, start..end);
                for level in [Level::new(), Level::baseline()] {
                    let mask = dispatch!(level, simd => met(simd, &frame, &prepared, &block));
                    for (lane, t) in ts.iter().enumerate() {
                        let counts = t.is_some_and(|t| start <= t && t < end);
                        assert!(!counts || mask >> lane & 1 == 1, "{level:?} {ray:?} lane {lane} {t:?} {start} {end}");
                        hit += u32::from(counts);
                    }
                    kept += mask.count_ones();
                }
            }
        }
        (kept, hit)
    }

    /// From near and from 2^36 radii away, with directions of any length, and ranges that end just behind the first
    /// hit.
    #[test]
    fn the_cull_drops_no_hit_and_most_of_the_rest() {
        let random = &mut Random::new(9);
        let (mut kept, mut hit) = ([0; 2], [0; 2]);
        for _ in 0..20 {
            let spheres: Vec<Sphere> =
                (0..16).map(|_| Sphere::new(random.point(), 2f64.powi(-random.integer(1..20))).unwrap()).collect();
            let small = |random: &mut Random| 0.2 * random.point();
            let triangles: Vec<Triangle> = (0..16)
                .map(|_| {
                    let at = random.point() * 0.8;
                    Triangle::new(at + small(random), at + small(random), at + small(random)).unwrap()
                })
                .collect();
            let ahead = 0.0..f64::INFINITY;
            let (a, b) = check::<Balls>(&spheres, |sphere, ray| sphere.closest(ray, ahead.clone()), random);
            let (c, d) = check::<Boxes>(&triangles, |triangle, ray| triangle.closest(ray, ahead.clone()), random);
            kept = [kept[0] + a, kept[1] + c];
            hit = [hit[0] + b, hit[1] + d];
        }
        assert!(hit[0] > 1_000 && hit[1] > 1_000, "{hit:?}");
        assert!(kept[0] < 4 * hit[0] && kept[1] < 8 * hit[1], "{kept:?} for {hit:?}");
    }
}
