//! How the tree lies in memory: sixteen children a node, one array of sixteen numbers (a cache line) a quantity.
//!
//! All coordinates here are f32 in *cull coordinates* (see [`Frame`]): the scene lies in the unit ball. Bounds are
//! rounded outward when they are narrowed, so a bound contains exactly what it bounds; what the arithmetic of a query
//! loses is made up for by the query's own slack (`cull.rs`).

use std::cmp::Ordering;

use fearless_simd::{Simd, f32x8, f64x4, prelude::*};
use glam::DVec3;

use crate::lanes::four;
use crate::leaf::{Leaf, Leaves};
use crate::{Sphere, Triangle};

/// Children of a node, and primitives of a leaf block.
pub(super) const WIDTH: usize = 16;

/// One number for each child.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Lanes(pub(super) [f32; WIDTH]);

impl Lanes {
    pub(super) const fn splat(value: f32) -> Self {
        Self([value; WIDTH])
    }
}

/// Up to sixteen balls. An unused lane has NaN for its center, which no test passes.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Balls {
    pub(super) center: [Lanes; 3],
    pub(super) radius: Lanes,
}

impl Balls {
    pub(super) const EMPTY: Self = Self { center: [Lanes::splat(f32::NAN); 3], radius: Lanes::splat(0.0) };

    pub(super) fn set(&mut self, lane: usize, ball: Ball) {
        for axis in 0..3 {
            self.center[axis].0[lane] = ball.center[axis];
        }
        self.radius.0[lane] = ball.radius;
    }
}

/// Up to sixteen boxes: the three lower planes, then the three upper ones. An unused lane is inside out.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Boxes(pub(super) [Lanes; 6]);

impl Boxes {
    pub(super) const EMPTY: Self = {
        let (low, high) = (Lanes::splat(f32::INFINITY), Lanes::splat(f32::NEG_INFINITY));
        Self([low, low, low, high, high, high])
    };

    pub(super) fn set(&mut self, lane: usize, low: [f32; 3], high: [f32; 3]) {
        for axis in 0..3 {
            self.0[axis].0[lane] = low[axis];
            self.0[axis + 3].0[lane] = high[axis];
        }
    }
}

/// A leaf block: the bounds of up to sixteen primitives of one kind.
pub(super) trait Block: Copy + Send {
    type Leaf: Blocked<Block = Self>;

    /// No lane in use.
    const EMPTY: Self;

    /// Bounds the primitive in this lane.
    fn bound(&mut self, lane: usize, leaf: &Self::Leaf, frame: &Frame);

    /// The bounds of the first primitives of at most [`WIDTH`], of which `kept` tells which have one.
    #[inline(always)]
    fn around(leaves: &[Self::Leaf], kept: impl Fn(usize) -> bool, frame: &Frame) -> Self {
        let mut block = Self::EMPTY;
        for (lane, leaf) in leaves.iter().enumerate().filter(|(lane, _)| kept(*lane)) {
            block.bound(lane, leaf, frame);
        }
        block
    }
}

impl Block for Balls {
    type Leaf = Sphere;
    const EMPTY: Self = Self::EMPTY;

    fn bound(&mut self, lane: usize, leaf: &Sphere, frame: &Frame) {
        self.set(lane, frame.ball(leaf));
    }

    /// [`Frame::ball`], step by step in all lanes.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "what it moves is added to the radius")]
    fn around(spheres: &[Sphere], kept: impl Fn(usize) -> bool, frame: &Frame) -> Self {
        let mut numbers = [[0.0; WIDTH]; 4];
        for (lane, sphere) in spheres.iter().enumerate().take(WIDTH) {
            let [x, y, z] = sphere.center().to_array();
            for (row, number) in numbers.iter_mut().zip([x, y, z, sphere.radius()]) {
                row[lane] = number;
            }
        }
        let [centers @ .., radii] = numbers;
        let (middle, scale) = (frame.center.to_array(), frame.scale);
        let mut block = Self::EMPTY;
        let mut moved = [0.0; WIDTH];
        for axis in 0..3 {
            for lane in 0..WIDTH {
                let wide = (centers[axis][lane] * 0.5 - middle[axis] * 0.5) * scale * 2.0;
                let narrow = wide as f32;
                let error = wide - f64::from(narrow);
                moved[lane] += error * error;
                block.center[axis].0[lane] = narrow;
            }
        }
        for lane in 0..WIDTH {
            block.radius.0[lane] = up(radii[lane] * scale + moved[lane].sqrt() + 2.0 * COORDINATE_ERROR);
        }
        for lane in (0..WIDTH).filter(|&lane| lane >= spheres.len() || !kept(lane)) {
            block.set(lane, Ball { center: [f32::NAN; 3], radius: 0.0 });
        }
        block
    }
}

impl Block for Boxes {
    type Leaf = Triangle;
    const EMPTY: Self = Self::EMPTY;

    fn bound(&mut self, lane: usize, leaf: &Triangle, frame: &Frame) {
        let (low, high) = leaf.extent(frame);
        self.set(lane, low, high);
    }
}

/// A primitive that leaf blocks bound.
pub(super) trait Blocked: Leaf {
    type Block: Block<Leaf = Self>;
    const KIND: Kind;

    /// The primitives of this kind in leaf order, and the place of the first.
    fn of(leaves: &Leaves) -> &[Self];
    fn first_place(leaves: &Leaves) -> usize;

    /// How many are of this kind, of so many spheres and triangles.
    fn count(all: (usize, usize)) -> usize;

    /// The corners of a box in cull coordinates that contains the primitive.
    fn extent(&self, frame: &Frame) -> ([f32; 3], [f32; 3]);

    /// The same as low and negated high corners, the first three lanes of either half.
    #[inline(always)]
    fn corners<S: Simd>(&self, _simd: S, frame: &Frame) -> [f32; 8] {
        let ([x, y, z], [a, b, c]) = self.extent(frame);
        [x, y, z, 0.0, -a, -b, -c, 0.0]
    }

    /// Some order of all primitives, in which two are equal only if every ray gets the same answer from both.
    fn order(&self, other: &Self) -> Ordering;
}

impl Blocked for Sphere {
    type Block = Balls;
    const KIND: Kind = Kind::Spheres;

    #[inline(always)]
    fn of(leaves: &Leaves) -> &[Self] {
        &leaves.spheres
    }

    #[inline(always)]
    fn first_place(_: &Leaves) -> usize {
        0
    }

    fn count((spheres, _): (usize, usize)) -> usize {
        spheres
    }

    fn extent(&self, frame: &Frame) -> ([f32; 3], [f32; 3]) {
        let (center, radius) = (frame.point(self.center()), frame.length(self.radius()));
        outward(center - radius, center + radius)
    }

    /// [`extent`](Self::extent), step by step in all lanes.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "rounded to nearest, then outward")]
    fn corners<S: Simd>(&self, simd: S, frame: &Frame) -> [f32; 8] {
        let (center, radius) = (frame.lanes(simd, self.center()), frame.length(self.radius()));
        let out = (radius - center).combine(center + radius) + COORDINATE_ERROR;
        let out: [f64; 8] = out.into();
        let nearest = f32x8::simd_from(simd, out.map(|x| x as f32));
        (-(nearest + (nearest.abs() * f32::EPSILON + f32::MIN_POSITIVE))).into()
    }

    fn order(&self, other: &Self) -> Ordering {
        let numbers = |sphere: &Self| (sphere.center().to_array(), sphere.radius());
        numbers(self).partial_cmp(&numbers(other)).expect("finite numbers")
    }
}

impl Blocked for Triangle {
    type Block = Boxes;
    const KIND: Kind = Kind::Triangles;

    #[inline(always)]
    fn of(leaves: &Leaves) -> &[Self] {
        &leaves.triangles
    }

    #[inline(always)]
    fn first_place(leaves: &Leaves) -> usize {
        leaves.spheres.len()
    }

    fn count((_, triangles): (usize, usize)) -> usize {
        triangles
    }

    fn extent(&self, frame: &Frame) -> ([f32; 3], [f32; 3]) {
        let [a, b, c] = self.vertices().map(|v| frame.point(v));
        outward(a.min(b).min(c), a.max(b).max(c))
    }

    fn order(&self, other: &Self) -> Ordering {
        let numbers = |triangle: &Self| triangle.vertices().map(|v| v.to_array());
        numbers(self).partial_cmp(&numbers(other)).expect("finite numbers")
    }
}

/// The box between two corners given in cull coordinates, rounded outward.
fn outward(low: DVec3, high: DVec3) -> ([f32; 3], [f32; 3]) {
    (low.to_array().map(|x| down(x - COORDINATE_ERROR)), high.to_array().map(|x| up(x + COORDINATE_ERROR)))
}

/// An inner node: the boxes of its children, because boxes cull better than balls above the leaf blocks
/// (`benches/peers` measures it).
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Node {
    pub(super) boxes: Boxes,
    pub(super) children: [Child; WIDTH],
}

impl Node {
    pub(super) const EMPTY: Self = Self { boxes: Boxes::EMPTY, children: [Child(0); WIDTH] };
}

/// What a child is and where: two bits of kind above thirty bits of index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub(super) struct Child(u32);

/// The kinds of [`Child`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A [`Node`].
    Inner,
    /// A block of spheres: block `k` bounds the leaf-ordered spheres `16 k ..`.
    Spheres,
    /// A block of triangles, likewise.
    Triangles,
}

impl Child {
    const SHIFT: u32 = 30;
    pub(super) fn new(kind: Kind, index: usize) -> Self {
        let index = u32::try_from(index).ok().filter(|&i| i < 1 << Self::SHIFT).expect("fewer than 2^34 primitives");
        Self((kind as u32) << Self::SHIFT | index)
    }

    #[inline(always)]
    pub(super) fn from_bits(bits: u32) -> Self {
        Self(bits)
    }

    #[inline(always)]
    pub(super) fn bits(self) -> u32 {
        self.0
    }

    #[inline(always)]
    pub(super) fn is_inner(self) -> bool {
        self.0 >> Self::SHIFT == Kind::Inner as u32
    }

    #[inline(always)]
    pub(super) fn kind(self) -> Kind {
        match self.0 >> Self::SHIFT {
            0 => Kind::Inner,
            1 => Kind::Spheres,
            _ => Kind::Triangles,
        }
    }

    #[inline(always)]
    pub(super) fn index(self) -> usize {
        (self.0 & ((1 << Self::SHIFT) - 1)) as usize
    }
}

/// A part of the scene with a frame of its own.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region {
    pub(super) frame: Frame,
    pub(super) root: Child,
}

/// A ball in cull coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ball {
    pub(super) center: [f32; 3],
    pub(super) radius: f32,
}

/// Cull coordinates: `(p - center) * scale`, where `scale` is a power of two and everything lies in the unit ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame {
    center: DVec3,
    scale: f64,
}

/// Bound of the error of a cull coordinate in f64, for points of the unit ball: `docs/numerics.md`, section 9.
pub(super) const COORDINATE_ERROR: f64 = 1.0 / (1u64 << 50) as f64;

impl Frame {
    /// The frame in which `ball` has a radius between 1/2 and 1. Without a ball, everything finite lies within 1.
    pub(super) fn around(ball: Option<&Sphere>) -> Self {
        match ball {
            Some(ball) if ball.radius() < f64::MAX / 16.0 => {
                // 2^-k with 2^(k-1) <= radius < 2^k; finite for a radius of 0.
                let bits = ball.radius().to_bits() >> 52;
                let exponent = (2045 - bits).min(2044);
                Self { center: ball.center(), scale: f64::from_bits(exponent << 52) }
            }
            // |p| + r <= (sqrt(3) + 1) 2^1024 < 2^1026.
            _ => Self { center: DVec3::ZERO, scale: f64::from_bits(1 << (52 - 4)) },
        }
    }

    /// The cull coordinates of a point: halved first, so that the difference cannot overflow.
    #[inline(always)]
    pub(super) fn point(&self, p: DVec3) -> DVec3 {
        (p * 0.5 - self.center * 0.5) * self.scale * 2.0
    }

    /// The same in the first three lanes of a vector.
    #[inline(always)]
    pub(super) fn lanes<S: Simd>(&self, simd: S, p: DVec3) -> f64x4<S> {
        (four(simd, p) * 0.5 - four(simd, self.center) * 0.5) * self.scale * 2.0
    }

    #[inline(always)]
    pub(super) fn length(&self, length: f64) -> f64 {
        length * self.scale
    }

    #[inline(always)]
    pub(super) fn scale(&self) -> f64 {
        self.scale
    }

    /// The sphere as a ball that contains it.
    pub(super) fn ball(&self, sphere: &Sphere) -> Ball {
        let center = self.point(sphere.center());
        let narrow = center.as_vec3();
        let moved = (center - narrow.as_dvec3()).length();
        Ball { center: narrow.to_array(), radius: up(self.length(sphere.radius()) + moved + 2.0 * COORDINATE_ERROR) }
    }
}

/// An f32 that is not less than `x`, for `x` in the range of f32: the nearest and one or two steps more.
///
/// (`next_up` has branches, and this is on the way of every ray.)
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "rounded to nearest, then outward")]
pub(super) fn up(x: f64) -> f32 {
    let nearest = x as f32;
    nearest + (nearest.abs() * f32::EPSILON + f32::MIN_POSITIVE)
}

/// An f32 that is not more than `x`, likewise.
#[inline(always)]
pub(super) fn down(x: f64) -> f32 {
    -up(-x)
}

#[cfg(test)]
mod tests {
    use fearless_simd::Level;
    use oracle::Random;

    use super::*;
    use crate::simd::dispatch;

    #[test]
    fn all_corners_together_are_those_of_each() {
        let random = &mut Random::new(6);
        for _ in 0..10_000 {
            let size = 2f64.powi(random.integer(-1000..1000));
            let sphere = Sphere::new(size * random.point(), size * random.uniform().abs()).unwrap();
            let frame = Frame::around(Some(&Sphere::new(size * random.point(), 3.0 * size).unwrap()));
            let ([x, y, z], [a, b, c]) = sphere.extent(&frame);
            for level in [Level::new(), Level::baseline()] {
                let [p, q, r, _, u, v, w, _] = dispatch!(level, simd => sphere.corners(simd, &frame));
                assert_eq!([p, q, r, -u, -v, -w], [x, y, z, a, b, c], "{level:?} {sphere:?}");
            }
        }
    }

    #[test]
    fn all_lanes_together_have_the_bounds_of_each() {
        let random = &mut Random::new(5);
        for _ in 0..1_000 {
            let size = 2f64.powi(random.integer(-300..300));
            let spheres: Vec<Sphere> = (0..1 + random.below(WIDTH))
                .map(|_| Sphere::new(size * random.point(), size * random.uniform().abs()).unwrap())
                .collect();
            let frame = Frame::around(Some(&Sphere::new(size * random.point(), 3.0 * size).unwrap()));
            let kept: Vec<bool> = spheres.iter().map(|_| random.below(4) > 0).collect();
            let mut expected = Balls::EMPTY;
            for (lane, sphere) in spheres.iter().enumerate().filter(|(lane, _)| kept[*lane]) {
                expected.bound(lane, sphere, &frame);
            }
            for level in [Level::new(), Level::baseline()] {
                let found = dispatch!(level, _simd => Balls::around(&spheres, |lane| kept[lane], &frame));
                // (NaN is not equal to itself.)
                assert_eq!(format!("{found:?}"), format!("{expected:?}"), "{level:?} {spheres:?}");
            }
        }
    }
}
