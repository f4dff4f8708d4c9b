//! Three-vectors over any number of the ladder.
//!
//! ```
//! use glam::DVec3;
//! use rt_math::exact::{DoubleDouble, vector};
//!
//! let [a, b, c] = [DVec3::X, DVec3::Y, DVec3::new(1e-30, 1.0, 0.0)];
//! let normal = vector::cross(&vector::difference::<DoubleDouble<false>>(b, a), &vector::difference(c, a));
//! assert_eq!(normal.map(|x| x.high()), [0.0, 0.0, -1e-30]);
//! ```

use core::ops::{Add, Sub};

use glam::DVec3;

use super::{DoubleDouble, Dyadic, Fixed};

/// A number with the difference of two doubles: exact, or what the precision leaves of it.
pub trait FromDifference {
    /// Returns `a - b`.
    fn from_difference(a: f64, b: f64) -> Self;
}

/// A number with products, which may be of another type, as those of [`Fixed`] numbers have more limbs.
pub trait Product<Other, Output> {
    /// Returns `self other`.
    fn product(&self, other: &Other) -> Output;
}

/// Returns `p - q`.
#[inline(always)]
#[must_use]
pub fn difference<T: FromDifference>(p: DVec3, q: DVec3) -> [T; 3] {
    [T::from_difference(p.x, q.x), T::from_difference(p.y, q.y), T::from_difference(p.z, q.z)]
}

/// Returns the difference of two vectors.
#[inline(always)]
#[must_use]
pub fn minus<T: Copy + Sub<Output = T>>(v: &[T; 3], w: &[T; 3]) -> [T; 3] {
    [v[0] - w[0], v[1] - w[1], v[2] - w[2]]
}

/// Returns the dot product of two vectors.
#[inline(always)]
#[must_use]
pub fn dot<A: Product<B, C>, B, C: Add<Output = C>>(v: &[A; 3], w: &[B; 3]) -> C {
    v[0].product(&w[0]) + v[1].product(&w[1]) + v[2].product(&w[2])
}

/// Returns the cross product of two vectors.
#[inline(always)]
#[must_use]
pub fn cross<A: Product<B, C>, B, C: Sub<Output = C>>(v: &[A; 3], w: &[B; 3]) -> [C; 3] {
    let part = |j: usize, k: usize| v[j].product(&w[k]) - v[k].product(&w[j]);
    [part(1, 2), part(2, 0), part(0, 1)]
}

impl FromDifference for f64 {
    #[inline(always)]
    fn from_difference(a: f64, b: f64) -> Self {
        a - b
    }
}

impl Product<Self, Self> for f64 {
    #[inline(always)]
    fn product(&self, other: &Self) -> Self {
        self * other
    }
}

impl<const FMA: bool> FromDifference for DoubleDouble<FMA> {
    #[inline(always)]
    fn from_difference(a: f64, b: f64) -> Self {
        Self::difference(a, b)
    }
}

impl<const FMA: bool> Product<Self, Self> for DoubleDouble<FMA> {
    #[inline(always)]
    fn product(&self, other: &Self) -> Self {
        *self * *other
    }
}

impl<const LIMBS: usize> FromDifference for Dyadic<LIMBS> {
    fn from_difference(a: f64, b: f64) -> Self {
        Self::from_f64(a) - Self::from_f64(b)
    }
}

impl<const LIMBS: usize> Product<Self, Self> for Dyadic<LIMBS> {
    fn product(&self, other: &Self) -> Self {
        self * other
    }
}

impl<const A: usize, const B: usize, const C: usize> Product<Fixed<B>, Fixed<C>> for Fixed<A> {
    #[inline(always)]
    fn product(&self, other: &Fixed<B>) -> Fixed<C> {
        Fixed::product(self, other)
    }
}
