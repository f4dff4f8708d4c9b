//! Single and double precision, for methods that are compared in both.

use std::ops::{Add, Div, Mul, Neg, Sub};

use glam::DVec3;

/// A floating-point number.
pub(super) trait Real:
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
    /// The same number in double precision.
    fn wide(self) -> f64;
    fn sqrt(self) -> Self;
    fn abs(self) -> Self;
    fn copysign(self, sign: Self) -> Self;
    fn atan2(self, x: Self) -> Self;
    fn asin(self) -> Self;
}

macro_rules! real {
    ($float:ident) => {
        impl Real for $float {
            #[allow(
                clippy::cast_possible_truncation,
                clippy::unnecessary_cast,
                reason = "narrowing is the point"
            )]
            fn of(x: f64) -> Self {
                x as $float
            }
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
                $float::atan2(self, x)
            }
            fn asin(self) -> Self {
                $float::asin(self)
            }
        }
    };
}

real!(f32);
real!(f64);

/// A vector with components of either precision.
pub(super) type Vector<T> = [T; 3];

/// Returns components `from`, `from + 1` and `from + 2` of a case.
pub(super) fn vector<T: Real>(case: &[f64], from: usize) -> Vector<T> {
    [case[from], case[from + 1], case[from + 2]].map(T::of)
}

/// Returns the same components as a vector of glam's.
pub(super) fn dvec3(case: &[f64], from: usize) -> DVec3 {
    DVec3::new(case[from], case[from + 1], case[from + 2])
}

pub(super) fn sub<T: Real>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(super) fn add<T: Real>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(super) fn scaled<T: Real>(a: Vector<T>, s: T) -> Vector<T> {
    a.map(|x| x * s)
}

pub(super) fn dot<T: Real>(a: Vector<T>, b: Vector<T>) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross<T: Real>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
