//! Pseudo-random numbers from a fixed seed, and the vector arithmetic that hard cases are made with.
//!
//! Only operations that IEEE 754 rounds correctly are used, so the numbers are the same on every platform.

/// Pseudo-random numbers (splitmix64).
pub(super) struct Random(u64);

impl Random {
    pub(super) fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub(super) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// A number in `low..high`.
    pub(super) fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.bits() >> 11) as f64 / (1u64 << 53) as f64)
    }

    /// A whole number in `low..=high`.
    pub(super) fn whole(&mut self, low: i32, high: i32) -> f64 {
        self.within(f64::from(low), f64::from(high) + 1.0).floor()
    }

    pub(super) fn sign(&mut self) -> f64 {
        if self.bits() & 1 == 0 { 1.0 } else { -1.0 }
    }

    /// A number of either sign whose exponent to base 10 is in `low..high`.
    pub(super) fn exponent(&mut self, low: f64, high: f64) -> f64 {
        self.sign() * self.within(1.0, 10.0) * size(self.within(low, high))
    }

    pub(super) fn vector(&mut self, size: f64) -> [f64; 3] {
        [0; 3].map(|_| self.within(-size, size))
    }

    pub(super) fn whole_vector(&mut self, size: i32) -> [f64; 3] {
        [0; 3].map(|_| self.whole(-size, size))
    }

    /// A vector of whole numbers whose zeros have either sign.
    pub(super) fn signed_vector(&mut self, size: i32) -> [f64; 3] {
        [0; 3].map(|_| self.sign() * self.whole(0, size))
    }

    /// A vector of length 1.
    pub(super) fn unit(&mut self) -> [f64; 3] {
        loop {
            let v = self.vector(1.0);
            let length = length(v);
            if (0.1..1.0).contains(&length) {
                return v.map(|x| x / length);
            }
        }
    }

    /// The number itself or one of its neighbours.
    pub(super) fn near(&mut self, x: f64) -> f64 {
        let step = self.bits() % 5;
        if x == 0.0 { x } else { f64::from_bits(x.to_bits() + step - 2) }
    }
}

/// Returns the power of two below `10^exponent`, the same on every platform.
pub(super) fn size(exponent: f64) -> f64 {
    #[expect(clippy::cast_possible_truncation, reason = "an exponent in the range of f64")]
    let binary = (exponent * std::f64::consts::LOG2_10).floor() as i32;
    f64::from_bits(u64::from((binary + 1023).clamp(1, 2046).unsigned_abs()) << 52)
}

pub(super) fn length(v: [f64; 3]) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}

pub(super) fn plus(a: [f64; 3], b: [f64; 3], s: f64) -> [f64; 3] {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

pub(super) fn combination(a: [f64; 3], s: f64, b: [f64; 3], t: f64) -> [f64; 3] {
    plus(a.map(|x| x * s), b, t)
}

pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Joins vectors and numbers to one case.
pub(super) fn join<const M: usize>(parts: &[&[f64]]) -> [f64; M] {
    let numbers: Vec<f64> = parts.concat();
    numbers.try_into().expect("the parts have the length of a case")
}
