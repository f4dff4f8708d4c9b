//! Exact arithmetic on heap integers and generators of hard doubles: the reference of the tests here. Slow, obvious,
//! and independent of the code under test.

#![allow(dead_code, reason = "each test uses its part")]

pub(crate) mod sphere;
pub(crate) mod triangle;

use std::cmp::Ordering;
use std::ops::{Add, Mul, Neg, Range, Sub};

use dashu::base::Sign;
use dashu::integer::IBig;
use glam::DVec3;

/// The number `mantissa 2^exponent`: sums, differences and products of doubles are of this kind.
#[derive(Clone, Debug)]
pub(crate) struct Exact {
    mantissa: IBig,
    exponent: i64,
}

/// The value of a finite double.
pub(crate) fn exact(x: f64) -> Exact {
    assert!(x.is_finite());
    let bits = x.to_bits();
    let biased = ((bits >> 52) & 0x7ff) as i64;
    let fraction = bits & ((1 << 52) - 1);
    let magnitude = IBig::from(if biased == 0 { fraction } else { fraction | 1 << 52 });
    let mantissa = if x.is_sign_negative() { -magnitude } else { magnitude };
    Exact { mantissa, exponent: biased.max(1) - 1075 }
}

/// `2^k`
pub(crate) fn power_of_two(k: i64) -> Exact {
    Exact { mantissa: IBig::ONE, exponent: k }
}

impl Exact {
    pub(crate) fn zero() -> Self {
        exact(0.0)
    }

    /// `Less`: negative.
    pub(crate) fn sign(&self) -> Ordering {
        if self.mantissa.is_zero() {
            Ordering::Equal
        } else if self.mantissa.sign() == Sign::Negative {
            Ordering::Less
        } else {
            Ordering::Greater
        }
    }

    pub(crate) fn cmp(&self, other: &Self) -> Ordering {
        (self - other).sign()
    }

    pub(crate) fn abs(&self) -> Self {
        if self.sign() == Ordering::Less { -self } else { self.clone() }
    }

    fn sum(&self, other: &Self, negate: bool) -> Self {
        let exponent = self.exponent.min(other.exponent);
        let aligned = |x: &Self| &x.mantissa << usize::try_from(x.exponent - exponent).expect("the smaller");
        let (x, y) = (aligned(self), aligned(other));
        Self { mantissa: if negate { x - y } else { x + y }, exponent }
    }
}

impl Add for &Exact {
    type Output = Exact;
    fn add(self, other: &Exact) -> Exact {
        self.sum(other, false)
    }
}

impl Sub for &Exact {
    type Output = Exact;
    fn sub(self, other: &Exact) -> Exact {
        self.sum(other, true)
    }
}

impl Mul for &Exact {
    type Output = Exact;
    fn mul(self, other: &Exact) -> Exact {
        Exact { mantissa: &self.mantissa * &other.mantissa, exponent: self.exponent + other.exponent }
    }
}

impl Neg for &Exact {
    type Output = Exact;
    fn neg(self) -> Exact {
        Exact { mantissa: -&self.mantissa, exponent: self.exponent }
    }
}

/// An exact vector.
pub(crate) type Vector = [Exact; 3];

pub(crate) fn vector(v: DVec3) -> Vector {
    v.to_array().map(exact)
}

pub(crate) fn minus(v: &Vector, w: &Vector) -> Vector {
    [0, 1, 2].map(|i| &v[i] - &w[i])
}

pub(crate) fn dot(v: &Vector, w: &Vector) -> Exact {
    &(&(&v[0] * &w[0]) + &(&v[1] * &w[1])) + &(&v[2] * &w[2])
}

pub(crate) fn cross(v: &Vector, w: &Vector) -> Vector {
    let part = |j: usize, k: usize| &(&v[j] * &w[k]) - &(&v[k] * &w[j]);
    [part(1, 2), part(2, 0), part(0, 1)]
}

/// Whether `found` is the double nearest to a number, ties to even, which `compare` tells from any exact number
/// (`Less`: the number is smaller). Zero is +0.0, and what underflows keeps its sign.
pub(crate) fn is_correctly_rounded(found: f64, compare: impl Fn(&Exact) -> Ordering) -> bool {
    let sign = compare(&Exact::zero());
    if found.is_nan() || sign == Ordering::Equal {
        return found.to_bits() == 0;
    }
    if found.is_sign_negative() != (sign == Ordering::Less) {
        return false;
    }
    let negative = sign == Ordering::Less;
    // how the magnitude compares with a positive number
    let compare = |x: &Exact| if negative { compare(&-x).reverse() } else { compare(x) };
    // infinity stands for 2^1024, where it is in the sequence of doubles
    let value = |bits: u64| {
        let x = f64::from_bits(bits);
        if x == f64::INFINITY { power_of_two(1024) } else { exact(x) }
    };
    let half = power_of_two(-1);
    let middle = |bits: u64| &(&value(bits) + &value(bits + 1)) * &half;
    let bits = found.abs().to_bits();
    let even = bits & 1 == 0;
    let above = bits == 0
        || match compare(&middle(bits - 1)) {
            Ordering::Less => false,
            Ordering::Equal => even,
            Ordering::Greater => true,
        };
    let below = found.is_infinite()
        || match compare(&middle(bits)) {
            Ordering::Less => true,
            Ordering::Equal => even,
            Ordering::Greater => false,
        };
    above && below
}

/// Whether `found` is the double nearest to `numerator / denominator`; the denominator is not zero.
pub(crate) fn is_rounded_quotient(found: f64, numerator: &Exact, denominator: &Exact) -> bool {
    let negative = denominator.sign() == Ordering::Less;
    is_correctly_rounded(found, |x| {
        let order = numerator.cmp(&(x * denominator));
        if negative { order.reverse() } else { order }
    })
}

/// Whether a range holds `t`: the rule as documented, word for word.
pub(crate) fn holds(within: &Range<f64>, t: f64) -> bool {
    if within.start.is_nan() || within.end.is_nan() {
        return false;
    }
    let empty = within.start.total_cmp(&within.end) != Ordering::Less;
    let from = within.start.total_cmp(&t) != Ordering::Greater;
    let to = within.end == f64::INFINITY || t.total_cmp(&within.end) == Ordering::Less;
    !empty && from && to
}

/// The number of random cases per class: ten thousand, or half a million with the environment variable `RT_LONG` set.
pub(crate) fn cases() -> usize {
    if std::env::var_os("RT_LONG").is_some() { 500_000 } else { 10_000 }
}

/// Splitmix64: small, seeded, the same everywhere.
pub(crate) struct Rng(u64);

impl Rng {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x2545_f491_4f6c_dd1d))
    }

    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }

    /// An integer from 0 to `n - 1`.
    pub(crate) fn below(&mut self, n: u64) -> i32 {
        i32::try_from(self.bits() % n).expect("a small range")
    }

    /// One of the items.
    pub(crate) fn pick<T: Copy>(&mut self, items: &[T]) -> T {
        items[usize::try_from(self.bits() % items.len() as u64).expect("an index")]
    }

    /// An integer from `-n` to `n`, as a double.
    pub(crate) fn small(&mut self, n: u64) -> f64 {
        f64::from(self.below(2 * n + 1)) - n as f64
    }

    /// Uniform in -1..1.
    pub(crate) fn uniform(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// `±2^e` times 1..2, `e` uniform from the range; a quarter have few bits.
    pub(crate) fn with_exponent(&mut self, range: Range<i32>) -> f64 {
        let e = range.start + self.below(u64::from(range.end.abs_diff(range.start)));
        let bits = self.bits();
        let mut mantissa = 1 << 52 | bits >> 12;
        if bits & 3 == 0 {
            mantissa &= u64::MAX << (self.bits() % 53);
        }
        let x = scale(mantissa as f64, e - 52);
        if bits & 4 == 0 { x } else { -x }
    }

    /// Any finite double, all exponents alike.
    pub(crate) fn finite(&mut self) -> f64 {
        match self.bits() % 16 {
            0 => 0.0,
            1 => f64::from_bits(self.bits() % 8),
            2 => f64::MAX,
            _ => self.with_exponent(-1074..1024),
        }
    }

    pub(crate) fn vector(&mut self) -> DVec3 {
        DVec3::new(self.uniform(), self.uniform(), self.uniform())
    }

    pub(crate) fn vector_with_exponent(&mut self, range: Range<i32>) -> DVec3 {
        DVec3::from_array([0; 3].map(|_| self.with_exponent(range.clone())))
    }

    pub(crate) fn finite_vector(&mut self) -> DVec3 {
        DVec3::from_array([0; 3].map(|_| self.finite()))
    }

    pub(crate) fn small_vector(&mut self, n: u64) -> DVec3 {
        DVec3::from_array([0; 3].map(|_| self.small(n)))
    }

    /// The same number up to `steps` doubles up or down.
    pub(crate) fn nudge(&mut self, x: f64, steps: u64) -> f64 {
        let up = self.bits() & 1 == 0;
        let mut x = x;
        for _ in 0..self.bits() % (steps + 1) {
            x = if up { x.next_up() } else { x.next_down() };
        }
        if x.is_finite() { x } else { f64::MAX.copysign(x) }
    }

    pub(crate) fn nudge_vector(&mut self, v: DVec3, steps: u64) -> DVec3 {
        DVec3::from_array(v.to_array().map(|x| self.nudge(x, steps)))
    }
}

/// `x 2^k`, rounded once.
pub(crate) fn scale(x: f64, k: i32) -> f64 {
    // the first steps are exact unless the result is infinite or zero anyway
    let mut x = x;
    let mut k = k;
    while k > 1000 {
        x *= 2f64.powi(1000);
        k -= 1000;
    }
    if k < -1000 && x.abs() > 2f64.powi(60) {
        x *= 2f64.powi(-900);
        k += 900;
    }
    if k < -1020 && x.abs() >= 1.0 {
        // towards the subnormal range: bring x near 1 first
        let e = ((x.abs().to_bits() >> 52) as i32) - 1023;
        x *= 2f64.powi(-e);
        k += e;
        return if k < -1022 { x * 2f64.powi(-1022) * 2f64.powi((k + 1022).max(-200)) } else { x * 2f64.powi(k) };
    }
    x * 2f64.powi(k)
}

pub(crate) fn scale_vector(v: DVec3, k: i32) -> DVec3 {
    DVec3::from_array(v.to_array().map(|x| scale(x, k)))
}
