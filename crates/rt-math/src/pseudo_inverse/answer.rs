//! What is found.

use glam::DMat3;

/// A pseudo-inverse and the rank it was made for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PseudoInverse {
    /// The pseudo-inverse itself.
    pub matrix: DMat3,
    /// Rank of the matrix that was inverted, 0 to 3.
    pub rank: usize,
}
