//! Single and double precision, for methods that are compared in both.
//!
//! Angles are the crate pxfm's, correctly rounded, and not the system library's: its last bits are not the same
//! everywhere.

use std::ops::{Add, Div, Mul, Neg, Sub};

use glam::DVec3;

/// A floating-point number.
pub(crate) trait Float:
    Copy
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The number nearest to `x`.
    fn of(x: f64) -> Self;
    /// The least number that is not below `x`.
    fn at_least(x: f64) -> Self;
    /// Half the spacing of numbers at 1.
    const HALF_ULP: f64;
    /// The same number in double precision.
    fn wide(self) -> f64;
    fn sqrt(self) -> Self;
    fn abs(self) -> Self;
    fn copysign(self, sign: Self) -> Self;
    fn atan2(self, x: Self) -> Self;
    fn asin(self) -> Self;
}

macro_rules! real {
    ($float:ident, $atan2:ident, $asin:ident) => {
        impl Float for $float {
            #[allow(clippy::cast_possible_truncation, clippy::unnecessary_cast, reason = "narrowing is the point")]
            fn of(x: f64) -> Self {
                x as $float
            }
            fn at_least(x: f64) -> Self {
                let nearest = Self::of(x);
                if nearest.wide() < x { nearest.next_up() } else { nearest }
            }
            #[allow(clippy::unnecessary_cast, reason = "f64 is among the two")]
            const HALF_ULP: f64 = $float::EPSILON as f64 / 2.0;
            fn wide(self) -> f64 {
                f64::from(self)
            }
            fn sqrt(self) -> Self {
                $float::sqrt(self)
            }
            fn abs(self) -> Self {
                $float::abs(self)
            }
            fn copysign(self, sign: Self) -> Self {
                $float::copysign(self, sign)
            }
            fn atan2(self, x: Self) -> Self {
                pxfm::$atan2(self, x)
            }
            fn asin(self) -> Self {
                pxfm::$asin(self)
            }
        }
    };
}

real!(f32, f_atan2f, f_asinf);
real!(f64, f_atan2, f_asin);

/// A vector with components of either precision.
pub(crate) type Components<T> = [T; 3];

/// Returns components `from`, `from + 1` and `from + 2` of a case.
pub(crate) fn vector<T: Float>(case: &[f64], from: usize) -> Components<T> {
    [case[from], case[from + 1], case[from + 2]].map(T::of)
}

/// Returns the same components as a vector of glam's.
pub(crate) fn dvec3(case: &[f64], from: usize) -> DVec3 {
    DVec3::new(case[from], case[from + 1], case[from + 2])
}

pub(crate) fn sub<T: Float>(a: Components<T>, b: Components<T>) -> Components<T> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn add<T: Float>(a: Components<T>, b: Components<T>) -> Components<T> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn scaled<T: Float>(a: Components<T>, s: T) -> Components<T> {
    a.map(|x| x * s)
}

pub(crate) fn dot<T: Float>(a: Components<T>, b: Components<T>) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross<T: Float>(a: Components<T>, b: Components<T>) -> Components<T> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// A vector divided by its length.
pub(crate) fn normalized<T: Float>(a: Components<T>) -> Components<T> {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

/// The power with a whole exponent, by repeated squaring: the same bits on every platform.
pub(crate) fn power<T: Float>(base: T, exponent: f64) -> T {
    let (mut result, mut square, mut rest) = (T::of(1.0), base, exponent);
    while rest >= 1.0 {
        if rest % 2.0 >= 1.0 {
            result = result * square;
        }
        square = square * square;
        rest = (rest / 2.0).floor();
    }
    result
}
