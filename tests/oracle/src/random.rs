//! Pseudo-random numbers from a fixed seed, hard ones among them.
//!
//! Only operations that IEEE 754 rounds correctly are used, so the numbers are the same on every platform. A *point* is
//! a `DVec3`, a *vector* the three numbers that the report's cases are made of.

use std::ops::Range;

use glam::DVec3;

use crate::{exact, power_of_two, rounded};

/// Returns the number of random cases of a class: ten thousand, or `long` with the environment variable `RT_LONG` set.
#[must_use]
pub fn cases(long: usize) -> usize {
    if std::env::var_os("RT_LONG").is_some() { long } else { 10_000 }
}

/// Pseudo-random numbers: splitmix64, by G. L. Steele, D. Lea and C. H. Flood, "Fast splittable pseudorandom number
/// generators", 2014.
#[derive(Clone, Debug)]
pub struct Random(u64);

/// Whole numbers and choices.
impl Random {
    /// Starts from any seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// A number below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        usize::try_from(self.bits() % n as u64).expect("below n")
    }

    /// A number of the range.
    pub fn integer(&mut self, range: Range<i32>) -> i32 {
        range.start + i32::try_from(self.bits() % u64::from(range.end.abs_diff(range.start))).expect("a small range")
    }

    /// True once in `n` times.
    pub fn one_in(&mut self, n: u64) -> bool {
        self.bits().is_multiple_of(n)
    }

    /// One of the items.
    pub fn pick<T: Clone>(&mut self, items: &[T]) -> T {
        items[self.below(items.len())].clone()
    }

    /// Changes the order of the items.
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, self.below(i + 1));
        }
    }
}

/// Doubles.
impl Random {
    /// A number in `low..high`.
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    /// A number in 0..1.
    pub fn share(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number in -1..1.
    pub fn uniform(&mut self) -> f64 {
        2.0 * self.share() - 1.0
    }

    /// A whole number in `low..=high`.
    pub fn whole(&mut self, low: i32, high: i32) -> f64 {
        self.within(f64::from(low), f64::from(high) + 1.0).floor()
    }

    /// A whole number in `-limit..=limit`, which is at most 2^53.
    pub fn small(&mut self, limit: u64) -> f64 {
        (self.bits() % (2 * limit + 1)) as f64 - limit as f64
    }

    /// 1 or -1.
    pub fn sign(&mut self) -> f64 {
        if self.bits() & 1 == 0 { 1.0 } else { -1.0 }
    }

    /// A number of either sign whose exponent to base 10 is in `low..high`.
    pub fn exponent(&mut self, low: f64, high: f64) -> f64 {
        let sign = self.sign();
        let mantissa = self.within(1.0, 10.0);
        #[expect(clippy::cast_possible_truncation, reason = "an exponent in the range of f64")]
        let binary = (self.within(low, high) * std::f64::consts::LOG2_10).floor() as i32;
        sign * mantissa * f64::from_bits(u64::from((binary + 1023).clamp(1, 2046).unsigned_abs()) << 52)
    }

    /// `2^k` with `k` of the range.
    pub fn power(&mut self, range: Range<i32>) -> f64 {
        let k = self.integer(range);
        2f64.powi(k / 2) * 2f64.powi(k - k / 2)
    }

    /// A number of either sign with the exponent of its leading bit uniform in the range; a quarter have few bits.
    pub fn with_exponent(&mut self, range: Range<i32>) -> f64 {
        let exponent = self.integer(range);
        let bits = self.bits();
        let mut significand = (1 << 52) | (bits >> 12);
        if bits & 3 == 0 {
            significand &= u64::MAX << (self.bits() % 53);
        }
        // in two steps, since 2^-1074 times a number rounds once only if the other factor is a normal double
        let half = exponent / 2;
        let magnitude = significand as f64 * 2f64.powi(-52) * 2f64.powi(half) * 2f64.powi(exponent - half);
        if bits & 4 == 0 { magnitude } else { -magnitude }
    }

    /// Any finite number: all exponents alike, subnormals, zeros and the ends of the range among them, some with few
    /// bits.
    pub fn finite(&mut self) -> f64 {
        let bits = self.bits();
        let x = f64::from_bits(match self.below(16) {
            0 => bits & 1 << 63 | self.pick(&[0, 1, 2, 7, f64::MAX.to_bits()]),
            1 => bits & u64::MAX << self.below(64),
            _ => bits,
        });
        if x.is_finite() { x } else { f64::from_bits(bits & !(1 << 62)) }
    }

    /// The number itself or one of its neighbours.
    pub fn near(&mut self, x: f64) -> f64 {
        let step = self.bits() % 5;
        if x == 0.0 { x } else { f64::from_bits(x.to_bits() + step - 2) }
    }

    /// The number up to `steps` doubles up or down; it stays finite.
    pub fn nudge(&mut self, x: f64, steps: u64) -> f64 {
        let up = self.bits() & 1 == 0;
        let step = |x: f64, _| if up { x.next_up() } else { x.next_down() };
        (0..self.bits() % (steps + 1)).fold(x, step).clamp(f64::MIN, f64::MAX)
    }
}

/// Points.
impl Random {
    /// A point of the cube -1..1.
    pub fn point(&mut self) -> DVec3 {
        DVec3::new(self.uniform(), self.uniform(), self.uniform())
    }

    /// A point of the unit sphere.
    pub fn direction(&mut self) -> DVec3 {
        loop {
            let v = self.point();
            if (0.01..1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }

    /// A point of the grid of whole numbers, up to `limit`.
    pub fn small_point(&mut self, limit: u64) -> DVec3 {
        DVec3::new(self.small(limit), self.small(limit), self.small(limit))
    }

    /// Any point.
    pub fn finite_point(&mut self) -> DVec3 {
        DVec3::new(self.finite(), self.finite(), self.finite())
    }

    /// A point of three numbers [`with_exponent`](Self::with_exponent).
    pub fn point_with_exponent(&mut self, range: Range<i32>) -> DVec3 {
        DVec3::from_array([0; 3].map(|_| self.with_exponent(range.clone())))
    }

    /// The point with each coordinate up to `steps` doubles aside.
    pub fn nudge_point(&mut self, point: DVec3, steps: u64) -> DVec3 {
        DVec3::from_array(point.to_array().map(|x| self.nudge(x, steps)))
    }
}

/// Vectors of the report's cases.
impl Random {
    /// Three numbers up to `size`.
    pub fn vector(&mut self, size: f64) -> [f64; 3] {
        [0; 3].map(|_| self.within(-size, size))
    }

    /// Three whole numbers up to `size`.
    pub fn whole_vector(&mut self, size: i32) -> [f64; 3] {
        [0; 3].map(|_| self.whole(-size, size))
    }

    /// Three whole numbers; zeros have either sign.
    pub fn signed_vector(&mut self, size: i32) -> [f64; 3] {
        [0; 3].map(|_| self.sign() * self.whole(0, size))
    }

    /// A vector of length 1.
    pub fn unit(&mut self) -> [f64; 3] {
        loop {
            let v = self.vector(1.0);
            let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
            if (0.1..1.0).contains(&length) {
                return v.map(|x| x / length);
            }
        }
    }
}

/// Returns `x 2^k`, rounded once.
#[must_use]
pub fn scale(x: f64, k: i32) -> f64 {
    rounded(&(exact(x) * power_of_two(k)))
}

/// Returns the point with its coordinates [scaled](scale).
#[must_use]
pub fn scale_point(point: DVec3, k: i32) -> DVec3 {
    DVec3::from_array(point.to_array().map(|x| scale(x, k)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stream_is_splitmix64() {
        let mut random = Random::new(1_234_567);
        // From the author's program.
        assert_eq!(
            [0; 3].map(|_| random.bits()),
            [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423]
        );
    }

    #[test]
    fn numbers_are_in_their_ranges() {
        let mut random = Random::new(5);
        let (mut zeros, mut few_bits) = (0, 0);
        for _ in 0..10_000 {
            assert!((-1.0..1.0).contains(&random.uniform()) && random.below(3) < 3);
            assert!((-5..7).contains(&random.integer(-5..7)) && random.small(9).abs() <= 9.0);
            let x = random.with_exponent(-1074..-1000);
            assert!(x.abs() >= f64::from_bits(1) && x.abs() < scale(1.0, -1000), "{x:e}");
            assert!((1.0..2.0).contains(&random.with_exponent(0..1).abs()));
            let x = random.finite();
            assert!(x.is_finite());
            zeros += usize::from(x == 0.0);
            few_bits += usize::from(x.to_bits().trailing_zeros() > 20);
            assert!((1e3..1e6).contains(&random.exponent(3.0, 5.0).abs().max(1e3)));
            assert!((random.nudge(1.0, 2) - 1.0).abs() <= 2.0 * f64::EPSILON);
            assert!((random.direction().length() - 1.0).abs() < 1e-15);
        }
        assert!(zeros > 50 && few_bits > 200, "{zeros} {few_bits}");
        assert_eq!(
            [random.nudge(f64::MAX, 0), scale(3.0, -1075), scale(1.0, 1024)],
            [f64::MAX, f64::from_bits(2), f64::INFINITY]
        );
    }
}
