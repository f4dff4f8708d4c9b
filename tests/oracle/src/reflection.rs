//! A vector mirrored in a plane.

use crate::{Big, Vector, dot, exact, vector};

/// The mirrored vector: `numerators / denominator`.
#[derive(Clone, Debug)]
pub struct Reflection {
    /// `v (n . n) - 2 (v . n) n`
    pub numerators: Vector,
    /// `n . n`
    pub denominator: Big,
}

impl Reflection {
    /// Mirrors `v` in the plane with the normal `n`, which is not zero.
    #[must_use]
    pub fn new(v: impl Into<[f64; 3]>, n: impl Into<[f64; 3]>) -> Self {
        let (v, n) = (vector(v), vector(n));
        let (vn, nn) = (exact(2.0) * dot(&v, &n), dot(&n, &n));
        Self { numerators: [0, 1, 2].map(|i| &v[i] * &nn - &vn * &n[i]), denominator: nn }
    }
}

#[test]
fn a_mirror_changes_the_sign_of_one_axis() {
    let Reflection { numerators, denominator } = Reflection::new([1.0, -1.0, 0.0], [0.0, 5.0, 0.0]);
    assert_eq!(numerators, vector([1.0, 1.0, 0.0]).map(|x| x * &denominator));
}
