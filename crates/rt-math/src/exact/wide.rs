//! Sums, products and quotients of fractions of a fixed number of limbs, before they are cut.
//!
//! Every loop runs over the limbs; what a short number has as zeros is skipped where that saves a row.

use core::array::from_fn;

use super::enclosure::{add_with_carry, high, low, subtract_with_borrow};

/// A fraction of twice the length, as a sum or a product is before it is cut.
pub(super) struct Wide<const LIMBS: usize> {
    pub(super) high: [u64; LIMBS],
    pub(super) low: [u64; LIMBS],
}

impl<const LIMBS: usize> Wide<LIMBS> {
    /// The limb at a position, counted from the lowest; zero beyond the highest.
    fn limb(&self, at: usize) -> u64 {
        if at < LIMBS {
            self.low[at]
        } else if at < 2 * LIMBS {
            self.high[at - LIMBS]
        } else {
            0
        }
    }

    fn from_limbs(limb: impl Fn(usize) -> u64) -> Self {
        Self { low: from_fn(&limb), high: from_fn(|i| limb(i + LIMBS)) }
    }

    /// The bits above the highest that is set; `None` for zero.
    pub(super) fn leading_zeros(&self) -> Option<usize> {
        let zeros = |limbs: &[u64; LIMBS]| {
            let (depth, limb) = limbs.iter().rev().enumerate().find(|&(_, &limb)| limb != 0)?;
            Some(64 * depth + limb.leading_zeros() as usize)
        };
        zeros(&self.high).or_else(|| zeros(&self.low).map(|zeros| 64 * LIMBS + zeros))
    }

    /// The fraction times `2^bits`; what is moved beyond the top must be zero.
    pub(super) fn shift_up(mut self, bits: usize) -> Self {
        let (limbs, bits) = (bits / 64, bits % 64);
        if limbs > 0 {
            // Positions below zero wrap around to far above the top, where all is zero.
            self = Self::from_limbs(|i| self.limb(i.wrapping_sub(limbs)));
        }
        if bits > 0 {
            let mut below = 0;
            for limb in &mut self.low {
                (*limb, below) = (*limb << bits | below, *limb >> (64 - bits));
            }
            for limb in &mut self.high {
                (*limb, below) = (*limb << bits | below, *limb >> (64 - bits));
            }
        }
        self
    }

    /// The fraction over `2^bits`; what is moved below the last bit is lost.
    pub(super) fn shift_down(mut self, bits: usize) -> Self {
        let (limbs, bits) = (bits / 64, bits % 64);
        if limbs > 0 {
            self = Self::from_limbs(|i| self.limb(i + limbs));
        }
        if bits > 0 {
            let mut above = 0;
            for limb in self.high.iter_mut().rev() {
                (*limb, above) = (*limb >> bits | above, *limb << (64 - bits));
            }
            for limb in self.low.iter_mut().rev() {
                (*limb, above) = (*limb >> bits | above, *limb << (64 - bits));
            }
        }
        self
    }

    /// The sum, and whether it has a carry.
    pub(super) fn plus(mut self, other: &Self) -> (Self, bool) {
        let mut carry = false;
        for (x, &y) in self.low.iter_mut().zip(&other.low) {
            (*x, carry) = add_with_carry(*x, y, carry);
        }
        for (x, &y) in self.high.iter_mut().zip(&other.high) {
            (*x, carry) = add_with_carry(*x, y, carry);
        }
        (self, carry)
    }

    /// The difference, which is not negative.
    pub(super) fn minus(mut self, other: &Self) -> Self {
        let mut borrow = false;
        for (x, &y) in self.low.iter_mut().zip(&other.low) {
            (*x, borrow) = subtract_with_borrow(*x, y, borrow);
        }
        for (x, &y) in self.high.iter_mut().zip(&other.high) {
            (*x, borrow) = subtract_with_borrow(*x, y, borrow);
        }
        debug_assert!(!borrow);
        self
    }

    /// The product of two fractions.
    pub(super) fn product(x: &[u64; LIMBS], y: &[u64; LIMBS]) -> Self {
        let mut product = Self { high: [0; LIMBS], low: [0; LIMBS] };
        for (i, &x) in x.iter().enumerate() {
            // Short numbers have zeros below.
            if x == 0 {
                continue;
            }
            let mut carry = 0;
            let mut add = |limb: &mut u64, y: u64| {
                let wide = u128::from(x) * u128::from(y) + u128::from(*limb) + u128::from(carry);
                (*limb, carry) = (low(wide), high(wide));
            };
            let (below, above) = y.split_at(LIMBS - i);
            for (limb, &y) in product.low[i..].iter_mut().zip(below) {
                add(limb, y);
            }
            for (limb, &y) in product.high[..i].iter_mut().zip(above) {
                add(limb, y);
            }
            product.high[i] = carry;
        }
        product
    }
}

/// The quotient of two numbers whose highest bits are set: whether it is at least 1, the fraction of its rest, cut off,
/// and whether nothing was.
///
/// Source: D. Knuth, "The Art of Computer Programming", vol. 2, section 4.3.1, algorithm D.
pub(super) fn quotient<const LIMBS: usize>(x: &[u64; LIMBS], y: &[u64; LIMBS]) -> (bool, [u64; LIMBS], bool) {
    let mut rest = *x;
    let whole = x.iter().rev().ge(y.iter().rev());
    if whole {
        let mut borrow = false;
        for (r, &y) in rest.iter_mut().zip(y) {
            (*r, borrow) = subtract_with_borrow(*r, y, borrow);
        }
    }
    // A short divisor has zeros below, which take nothing away.
    let zeros = y.iter().take_while(|&&limb| limb == 0).count();
    let divisor = y[LIMBS - 1];
    let mut digits = [0; LIMBS];
    for digit in digits.iter_mut().rev() {
        let mut top = rest[LIMBS - 1];
        rest.copy_within(..LIMBS - 1, 1);
        rest[0] = 0;
        // The estimate is at most two too large, as the divisor has its highest bit set.
        let two = u128::from(top) << 64 | u128::from(rest[LIMBS - 1]);
        let mut estimate = if top >= divisor { u64::MAX } else { low(two / u128::from(divisor)) };
        let (mut carry, mut borrow) = (0, false);
        for (r, &y) in rest[zeros..].iter_mut().zip(&y[zeros..]) {
            let wide = u128::from(estimate) * u128::from(y) + u128::from(carry);
            (*r, borrow) = subtract_with_borrow(*r, low(wide), borrow);
            carry = high(wide);
        }
        (top, borrow) = subtract_with_borrow(top, carry, borrow);
        for _ in 0..2 {
            if borrow {
                estimate -= 1;
                let mut carry = false;
                for (r, &y) in rest[zeros..].iter_mut().zip(&y[zeros..]) {
                    (*r, carry) = add_with_carry(*r, y, carry);
                }
                (top, carry) = top.overflowing_add(carry.into());
                borrow = !carry;
            }
        }
        debug_assert!(top == 0 && !borrow);
        *digit = estimate;
    }
    (whole, digits, rest.iter().all(|&limb| limb == 0))
}
