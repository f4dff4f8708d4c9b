//! A node of the binary tree.

use crate::bvh::node::COORDINATE_ERROR;

/// The spread of doubled centers up to which no cut parts them: boxes are wider by that alone.
#[expect(clippy::cast_possible_truncation, reason = "a power of two")]
pub(super) const COINCIDENT: f32 = 2.0 * COORDINATE_ERROR as f32;

/// A node of the binary tree, in preorder: its first side follows it, its second follows that. A side with `k` leaf
/// blocks has `2 k - 1` nodes, so both sides know where they lie before they are built.
#[derive(Clone, Copy, Debug)]
pub(super) struct Branch {
    pub(super) low: [f32; 3],
    pub(super) high: [f32; 3],
    /// Leaf blocks of the first side, with those of its twins; 0 for a leaf block.
    pub(super) first: u32,
}

impl Branch {
    pub(super) const NONE: Self = Self { low: [0.0; 3], high: [0.0; 3], first: 0 };

    /// The branch of a leaf block with these corners.
    pub(super) fn around([x, y, z, _, a, b, c, _]: [f32; 8]) -> Self {
        Self { low: [x, y, z], high: [-a, -b, -c], first: 0 }
    }

    #[cfg(test)]
    pub(super) fn corners(&self) -> [[f32; 3]; 2] {
        [self.low, self.high]
    }

    pub(super) fn half_area(&self) -> f32 {
        let [x, y, z]: [f32; 3] = std::array::from_fn(|axis| self.high[axis] - self.low[axis]);
        x * y + y * z + z * x
    }
}
