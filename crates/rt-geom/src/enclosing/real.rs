//! The few operations that solving for a tangent sphere needs, for f64 and for double-double numbers alike.

use std::ops::{Add, Div, Mul, Neg, Sub};

use rt_math::exact::DoubleDouble;
use rt_math::exact::vector::{FromDifference, Product};

/// A real number at some precision.
pub(super) trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + FromDifference
    + Product<Self, Self>
{
    const ZERO: Self;
    const ONE: Self;
    /// A sphere that sticks out by less than this share of the radius counts as inside while the support is sought:
    /// some ten rounding errors. No proof rests on it.
    const INSIDE: f64;
    fn from(value: f64) -> Self;
    /// The square root; NaN if negative.
    fn sqrt(self) -> Self;
    fn is_finite(self) -> bool;
    /// Whether this is the smaller; false for NaN.
    fn below(self, other: Self) -> bool;
    /// The nearest double.
    fn round(self) -> f64;
}

impl Real for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const INSIDE: Self = 2e-15;
    #[inline(always)]
    fn from(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::sqrt(self)
    }
    #[inline(always)]
    fn is_finite(self) -> bool {
        Self::is_finite(self)
    }
    #[inline(always)]
    fn below(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn round(self) -> f64 {
        self
    }
}

/// The number of the cold path, where hardware does not matter.
pub(super) type Wide = DoubleDouble<false>;

impl Real for Wide {
    const ZERO: Self = Self::ZERO;
    const ONE: Self = Self::new(1.0);
    const INSIDE: f64 = 1e-29;
    fn from(value: f64) -> Self {
        Self::new(value)
    }
    fn sqrt(self) -> Self {
        if self.high() < 0.0 { Self::new(f64::NAN) } else { Self::sqrt(self) }
    }
    fn is_finite(self) -> bool {
        self.high().is_finite() && self.low().is_finite()
    }
    fn below(self, other: Self) -> bool {
        self.high() < other.high() || (self.high() == other.high() && self.low() < other.low())
    }
    fn round(self) -> f64 {
        self.high()
    }
}
