//! The cull: which of sixteen bounds can a ray still meet within its range? It may keep too much and never drops a hit.
//!
//! A ray enters as a [`Line`]: in cull coordinates, measured from the point of its line that is nearest to the scene's
//! center. So every number here is of the order of 1, however far the ray's origin is, and each rounding error is a
//! small multiple of 2^-24. The slack that makes up for them is derived in `docs/numerics.md`, section 9.
//!
//! - Boxes: the entry and exit of three slabs (T. Kay and J. Kajiya, "Ray Tracing Complex Scenes", 1986), each slab
//!   widened by the slack.
//! - Balls: the distance from a center to the *segment* that is still of interest, in a frame of the ray. Nothing
//!   cancels, there is no square root, and one comparison culls in front, behind, beyond the best hit and aside.

use fearless_simd::{Simd, f32x16, mask32x16, prelude::*, u32x16};
use glam::{DVec3, Vec3};

use super::node::{Balls, Boxes, Frame, Lanes, WIDTH, down, narrow, up};
use crate::ray::PreparedRay;

/// Half the spacing of f32 numbers at 1.
const U: f32 = 1.0 / (1 << 24) as f32;
/// The rounding errors of the box test, as a displacement of a plane.
const BOX_SLACK: f32 = 8.0 * U;
/// The rounding errors of the ball test, as a distance.
const BALL_SLACK: f32 = 64.0 * U;
/// The rounding errors of the f64 part, for each unit of distance between origin and center.
const LINE_ERROR: f64 = 1.0 / (1u64 << 46) as f64;
/// Beyond this error nothing is culled.
const MAX_LINE_ERROR: f64 = 1.0 / 16.0;
/// Parameters of points in the unit ball lie within this, the error included.
const REACH: f64 = 1.125;
/// Smaller direction components count as this, so that reciprocals stay finite.
const MIN_COMPONENT: f32 = 1.0 / (1u64 << 40) as f32;
/// Added to keys: makes them positive, so that their bits are in order.
const KEY_SHIFT: f32 = 4.0;

/// A ray made ready for culling in one frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    /// Rows of [`Boxes`] that hold the near planes, `axis` or `axis + 3`, and the far ones, the others.
    near: [usize; 3],
    far: [usize; 3],
    inverse: [f32; 3],
    near_offset: [f32; 3],
    far_offset: [f32; 3],
    /// Two unit vectors across the direction, and the direction.
    axes: [Vec3; 3],
    offset: [f32; 3],
    ball_slack: f32,
    start: f32,
    end: f32,
    /// The parameter of `t` is `t * length - base`, up to `error`.
    length: f64,
    base: f64,
    error: f64,
}

impl Line {
    /// Prepares the ray for parameters `t` from `start` to `end`; `false` if all of it passes by the unit ball.
    ///
    /// In place, because a copy of what has just been written piece by piece waits for the writes.
    #[inline(always)]
    pub(super) fn set(&mut self, frame: &Frame, prepared: &PreparedRay) -> bool {
        let PreparedRay { ray, start, end, mut square, inverse_square: mut inverse, .. } = *prepared;
        let origin = frame.point(ray.origin());
        let mut along = ray.direction();
        let mut unit = 1.0;
        if !(1e-280..1e280).contains(&square) {
            // The squares over- or underflow.
            (along, unit) = scaled(along);
            square = along.length_squared();
            inverse = 1.0 / square;
        }
        let length = square.sqrt();
        // 1 / length, without waiting for another division.
        let direction = along * (length * inverse);
        let dot = origin.x * along.x + origin.y * along.y + origin.z * along.z;
        let base = -dot * (length * inverse);
        let nearest = origin - (dot * inverse) * along;
        let length = length * unit * frame.scale();
        let error = (1.0 + base.abs() + nearest.x.abs() + nearest.y.abs() + nearest.z.abs()) * LINE_ERROR;
        // Written so that NaN goes this way.
        if !(error < MAX_LINE_ERROR && length > f64::MIN_POSITIVE && length < f64::INFINITY) {
            *self = Self::EVERYTHING;
            return true;
        }
        let first = (start * length - base - error).max(-REACH);
        let last = (end * length - base + error).min(REACH);
        let distance = nearest.x * nearest.x + nearest.y * nearest.y + nearest.z * nearest.z;
        if distance > (1.0 + error) * (1.0 + error) || first > last {
            return false;
        }
        let error_up = up(error);
        for axis in 0..3 {
            let w = narrow(direction[axis]);
            let q = narrow(nearest[axis]);
            let divisor = if w.abs() < MIN_COMPONENT { MIN_COMPONENT.copysign(w) } else { w };
            let inverse = 1.0 / divisor;
            let center = -(q * inverse);
            let slack = inverse.abs() * (BOX_SLACK + error_up);
            let back = 3 * usize::from(w.is_sign_negative());
            self.near[axis] = axis + back;
            self.far[axis] = axis + 3 - back;
            self.inverse[axis] = inverse;
            self.near_offset[axis] = center - slack;
            self.far_offset[axis] = center + slack;
        }
        let w = direction.as_vec3();
        let q = nearest.as_vec3();
        self.axes = across(w);
        for (offset, axis) in self.offset.iter_mut().zip(&self.axes) {
            *offset = axis.x * q.x + axis.y * q.y + axis.z * q.z;
        }
        self.ball_slack = BALL_SLACK + error_up;
        self.start = down(first);
        self.end = up(last);
        self.length = length;
        self.base = base;
        self.error = error;
        true
    }

    /// Meets every bound: for rays whose arithmetic has no accuracy left.
    pub(super) const EVERYTHING: Self = Self {
        near: [0, 1, 2],
        far: [3, 4, 5],
        inverse: [1.0 / (1 << 30) as f32; 3],
        near_offset: [-8.0; 3],
        far_offset: [8.0; 3],
        axes: [Vec3::ZERO; 3],
        offset: [0.0; 3],
        ball_slack: 8.0,
        start: -2.0,
        end: 2.0,
        length: 0.0,
        base: 0.0,
        error: 1.0,
    };

    /// From now on, only what reaches the parameter `t` or less is of interest.
    #[inline(always)]
    pub(super) fn shorten(&mut self, t: f64) {
        let last = t * self.length - self.base + self.error;
        // NaN, from an infinite t, shortens nothing.
        if last < f64::from(self.end) {
            self.end = up(last);
        }
    }

    /// The greatest key that is still of interest.
    #[inline(always)]
    pub(super) fn last_key(&self) -> u32 {
        (self.end + KEY_SHIFT).to_bits()
    }
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
fn across(w: Vec3) -> [Vec3; 3] {
    let sign = 1.0_f32.copysign(w.z);
    let a = -1.0 / (sign + w.z);
    let b = w.x * w.y * a;
    [
        Vec3::new(1.0 + sign * w.x * w.x * a, sign * b, -sign * w.x),
        Vec3::new(b, sign + w.y * w.y * a, -w.y),
        w,
    ]
}

/// The boxes met, as bits; and a key for each: in the order of entry, meaningless where not met.
#[inline(always)]
pub(super) fn meet_boxes<S: Simd>(simd: S, line: &Line, boxes: &Boxes, keys: &mut [u32; WIDTH]) -> u32 {
    let (key, mask) = box_keys(simd, line, boxes);
    key.store_slice(keys);
    bits(mask.to_bitmask())
}

/// The same in registers.
#[inline(always)]
pub(super) fn box_keys<S: Simd>(simd: S, line: &Line, boxes: &Boxes) -> (u32x16<S>, mask32x16<S>) {
    let near = |axis: usize| (line.near[axis], line.inverse[axis], line.near_offset[axis]);
    let far = |axis: usize| (line.far[axis], line.inverse[axis], line.far_offset[axis]);
    let (x, y, z) = (near(0), near(1), near(2));
    let enter = planes(simd, boxes, x).max(planes(simd, boxes, y));
    let enter = enter.max(planes(simd, boxes, z).max(f32x16::splat(simd, line.start)));
    let (x, y, z) = (far(0), far(1), far(2));
    let leave = planes(simd, boxes, x).min(planes(simd, boxes, y));
    let leave = leave.min(planes(simd, boxes, z).min(f32x16::splat(simd, line.end)));
    ((enter + KEY_SHIFT).bitcast(), enter.simd_le(leave))
}

/// Where a line meets a row of planes. (Not a closure: a closure would not be compiled for the instruction set.)
#[inline(always)]
fn planes<S: Simd>(simd: S, boxes: &Boxes, (row, inverse, offset): (usize, f32, f32)) -> f32x16<S> {
    load(simd, &boxes.0[row]).mul_add(f32x16::splat(simd, inverse), f32x16::splat(simd, offset))
}

/// The balls met, as bits.
#[inline(always)]
pub(super) fn meet_balls<S: Simd>(simd: S, line: &Line, balls: &Balls) -> u32 {
    let center = (load(simd, &balls.center[0]), load(simd, &balls.center[1]), load(simd, &balls.center[2]));
    let x = along(simd, center, line.axes[0], line.offset[0]);
    let y = along(simd, center, line.axes[1], line.offset[1]);
    let t = along(simd, center, line.axes[2], line.offset[2]);
    let beyond = t - t.max(f32x16::splat(simd, line.start)).min(f32x16::splat(simd, line.end));
    let squared = x.mul_add(x, y.mul_add(y, beyond * beyond));
    let reach = load(simd, &balls.radius) + line.ball_slack;
    bits(squared.simd_le(reach * reach).to_bitmask())
}

/// How far along an axis the points are.
#[inline(always)]
fn along<S: Simd>(
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
fn load<S: Simd>(simd: S, lanes: &Lanes) -> f32x16<S> {
    f32x16::from_slice(simd, &lanes.0)
}

#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "sixteen bits are set at most")]
fn bits(mask: u64) -> u32 {
    mask as u32
}
