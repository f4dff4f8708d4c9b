//! The box of a primitive, and boxes that grow.

use glam::Vec4;

/// A primitive's box. `low.w` carries the primitive's index as bits, `high.w` that of the primitive whose twin it is; no
/// arithmetic uses that lane's value.
#[derive(Clone, Copy, Debug)]
pub(in crate::bvh) struct Item {
    pub(super) low: Vec4,
    pub(super) high: Vec4,
}

impl Item {
    const NO_TWIN: u32 = u32::MAX;

    pub(super) fn new(low: [f32; 3], high: [f32; 3], index: u32) -> Self {
        let [x, y, z] = low;
        Self {
            low: Vec4::new(x, y, z, f32::from_bits(index)),
            high: Vec4::new(high[0], high[1], high[2], f32::from_bits(Self::NO_TWIN)),
        }
    }

    pub(in crate::bvh) fn index(&self) -> u32 {
        self.low.w.to_bits()
    }

    /// The lowest index of a primitive in the same part of the tree that is equal to this one, if it is not its own.
    pub(in crate::bvh) fn twin_of(&self) -> Option<u32> {
        let first = self.high.w.to_bits();
        (first != Self::NO_TWIN).then_some(first)
    }

    /// The same with another index.
    pub(in crate::bvh) fn with_index(mut self, index: u32) -> Self {
        self.low.w = f32::from_bits(index);
        self
    }

    /// The longest side.
    pub(in crate::bvh) fn size(&self) -> f32 {
        (self.high - self.low).truncate().max_element()
    }

    /// How far the centers are apart, along the axis where they are farthest.
    pub(in crate::bvh) fn distance(&self, other: &Self) -> f32 {
        0.5 * (self.middle() - other.middle()).truncate().abs().max_element()
    }

    /// Twice the center.
    #[inline(always)]
    pub(super) fn middle(&self) -> Vec4 {
        self.low + self.high
    }
}

/// A box that grows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub(super) low: Vec4,
    pub(super) high: Vec4,
}

impl Bounds {
    pub(super) const EMPTY: Self = Self { low: Vec4::splat(f32::INFINITY), high: Vec4::splat(f32::NEG_INFINITY) };

    #[inline(always)]
    pub(super) fn add(&mut self, low: Vec4, high: Vec4) {
        // `min(new, old)`: in this order a NaN in the unused lane stays out of the others' way.
        self.low = low.min(self.low);
        self.high = high.max(self.high);
    }

    #[inline(always)]
    pub(super) fn merge(&mut self, other: &Self) {
        self.add(other.low, other.high);
    }

    /// Half the surface; 0 for nothing.
    #[inline(always)]
    pub(super) fn half_area(&self) -> f32 {
        let side = (self.high - self.low).max(Vec4::ZERO);
        side.x * side.y + side.y * side.z + side.z * side.x
    }
}

/// Bounds of the items and of their middles.
#[derive(Clone, Copy)]
pub(in crate::bvh) struct Extent {
    pub(super) items: Bounds,
    pub(super) middles: Bounds,
}

impl Extent {
    /// The longest side of the items' bounds.
    pub(in crate::bvh) fn size(&self) -> f32 {
        (self.items.high - self.items.low).truncate().max_element()
    }
}

pub(in crate::bvh) fn bounds_of(items: &[Item]) -> Extent {
    let mut extent = Extent { items: Bounds::EMPTY, middles: Bounds::EMPTY };
    for item in items {
        extent.items.add(item.low, item.high);
        let middle = item.middle();
        extent.middles.add(middle, middle);
    }
    extent
}
