//! The box of a primitive, and bounds of boxes: eight numbers, the low corner and the negated high one, so that the
//! minimum of two vectors is the box around both.

use fearless_simd::{Level, Simd, f32x4, f32x8, prelude::*};

use crate::simd::dispatch;

/// A primitive's box. The fourth number carries the primitive's index as bits, the eighth that of the primitive whose
/// twin it is; no arithmetic uses the values of these lanes.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(in crate::bvh) struct Item([f32; 8]);

/// Where the two indices are.
const INDEX: usize = 3;
const TWIN: usize = 7;

impl Item {
    const NO_TWIN: u32 = u32::MAX;
    pub(super) const NONE: Self = Self([0.0; 8]);

    /// The item of a low and a negated high corner, the first three numbers of each half.
    #[inline(always)]
    pub(in crate::bvh) fn new(corners: [f32; 8], index: u32) -> Self {
        let [x, y, z, _, a, b, c, _] = corners;
        Self([x, y, z, f32::from_bits(index), a, b, c, f32::from_bits(Self::NO_TWIN)])
    }

    pub(in crate::bvh) fn index(&self) -> u32 {
        self.0[INDEX].to_bits()
    }

    /// The lowest index of a primitive in the same part of the tree that is equal to this one, if it is not its own.
    pub(in crate::bvh) fn twin_of(&self) -> Option<u32> {
        let first = self.0[TWIN].to_bits();
        (first != Self::NO_TWIN).then_some(first)
    }

    pub(super) fn set_twin_of(&mut self, first: u32) {
        self.0[TWIN] = f32::from_bits(first);
    }

    /// The same with another index.
    pub(in crate::bvh) fn with_index(mut self, index: u32) -> Self {
        self.0[INDEX] = f32::from_bits(index);
        self
    }

    /// The longest side.
    #[inline(always)]
    pub(in crate::bvh) fn size(&self) -> f32 {
        longest(&self.0)
    }

    /// How far the centers are apart, along the axis where they are farthest.
    pub(in crate::bvh) fn distance(&self, other: &Self) -> f32 {
        let apart = |axis: usize| (self.middle(axis) - other.middle(axis)).abs();
        0.5 * apart(0).max(apart(1)).max(apart(2))
    }

    /// Whether it lies within a cube around a point.
    #[inline(always)]
    pub(in crate::bvh) fn is_within(&self, center: [f32; 3], reach: f32) -> bool {
        let outside = |axis: usize| (center[axis] - self.0[axis]).max(-self.0[axis + 4] - center[axis]);
        outside(0).max(outside(1)).max(outside(2)) < reach
    }

    /// Twice the center along an axis.
    #[inline(always)]
    pub(in crate::bvh) fn middle(&self, axis: usize) -> f32 {
        self.0[axis] - self.0[axis + 4]
    }

    #[inline(always)]
    pub(super) fn corners<S: Simd>(&self, simd: S) -> f32x8<S> {
        f32x8::simd_from(simd, self.0)
    }
}

/// Twice the center of a box, along the three axes.
#[inline(always)]
pub(super) fn middle<S: Simd>(corners: f32x8<S>) -> f32x4<S> {
    let (low, high) = corners.split();
    low - high
}

fn longest(corners: &[f32; 8]) -> f32 {
    let side = |axis: usize| -(corners[axis] + corners[axis + 4]);
    side(0).max(side(1)).max(side(2))
}

/// Half the surface; 0 for nothing.
#[inline(always)]
pub(super) fn half_area<S: Simd>(corners: f32x8<S>) -> f32 {
    let (low, high) = corners.split();
    let [x, y, z, _]: [f32; 4] = (low + high).min(0.0).into();
    x * y + y * z + z * x
}

/// The box of nothing.
#[inline(always)]
pub(super) fn nothing<S: Simd>(simd: S) -> f32x8<S> {
    f32x8::splat(simd, f32::INFINITY)
}

/// Bounds of the items and of their middles.
#[derive(Clone, Copy)]
pub(in crate::bvh) struct Extent {
    /// Corners, as those of an item.
    pub(super) items: [f32; 8],
    pub(super) middles: [f32; 8],
}

impl Extent {
    /// The longest side of the items' bounds.
    pub(in crate::bvh) fn size(&self) -> f32 {
        longest(&self.items)
    }

    /// Bounds of this and the other.
    pub(super) fn merge(mut self, other: &Self) -> Self {
        for (all, more) in [(&mut self.items, &other.items), (&mut self.middles, &other.middles)] {
            for (all, more) in all.iter_mut().zip(more) {
                *all = all.min(*more);
            }
        }
        self
    }

    /// How far the middles lie apart along each axis.
    pub(super) fn spread(&self) -> [f32; 3] {
        std::array::from_fn(|axis| -(self.middles[axis] + self.middles[axis + 4]))
    }
}

pub(in crate::bvh) fn bounds_of(items: &[Item]) -> Extent {
    dispatch!(Level::new(), simd => bounds_of_all(simd, items.iter()))
}

/// [`bounds_of`], as a kernel.
#[inline(always)]
pub(super) fn bounds_of_all<'a, S: Simd>(simd: S, items: impl Iterator<Item = &'a Item>) -> Extent {
    let (mut all, mut middles) = (nothing(simd), nothing(simd));
    for item in items {
        let corners = item.corners(simd);
        let middle = middle(corners);
        // `min(new, old)`: in this order a NaN in an unused lane stays out of the others' way.
        all = corners.min(all);
        middles = middle.combine(-middle).min(middles);
    }
    Extent { items: all.into(), middles: middles.into() }
}

/// The shortest side of any item along each axis.
#[inline(always)]
pub(in crate::bvh) fn shortest_sides<S: Simd>(simd: S, items: &[Item]) -> [f32; 3] {
    let mut least = f32x4::splat(simd, f32::INFINITY);
    for item in items {
        let (low, high) = item.corners(simd).split();
        least = (-(low + high)).min(least);
    }
    let [x, y, z, _] = least.into();
    [x, y, z]
}

/// Items of any size in the unit cube, with their places for indices.
#[cfg(test)]
#[expect(clippy::cast_possible_truncation, reason = "any numbers will do")]
pub(super) fn items_at_random(n: usize, random: &mut oracle::Random) -> Vec<Item> {
    let item = |index: u32| {
        let center = random.point().as_vec3();
        let size = (0.1 * (random.uniform() * random.uniform()).abs()) as f32;
        let ([x, y, z], [a, b, c]) = ((center - size).to_array(), (-(center + size)).to_array());
        Item::new([x, y, z, 0.0, a, b, c, 0.0], index)
    };
    (0..).take(n).map(item).collect()
}
