//! Exact integers of fixed size for doubles whose exponents lie in a window: the rung between double-double and
//! [`Dyadic`].
//!
//! Numbers that people have (decimals, grid coordinates, what a program computed at one scale) are multiples of one
//! power of two and not much larger than it. A [`Window`] finds that power and turns each double into a [`Fixed`]
//! number, an integer in two's complement of a size that the compiler knows: no loop whose length depends on values, no
//! memory but registers, no error bound to prove. Each product takes the sum of its factors' limbs; a polynomial of
//! degree `k` in numbers of one limb takes `k` limbs, its terms' sum included, if the window leaves a few bits.
//!
//! Quotients and roots are correctly rounded in double-double, from the leading 106 bits, and by [`Dyadic`] where these
//! do not decide: next to a midpoint of two doubles, or at the ends of the range.

use core::cmp::Ordering;
use core::ops::{Add, Neg, Sub};

use glam::DVec3;

use super::double_double::DoubleDouble;
use super::dyadic::{Dyadic, mantissa_and_weight};
use super::enclosure::{Leading, add_with_carry, enclose, high, low, subtract_with_borrow};
use super::error_free::U;
use super::round::round_if_certain;
use super::scaling::power_of_two;
use crate::fma_dispatch;

/// An integer of `64 LIMBS` bits in two's complement. Sums and differences wrap: the caller's window excludes it.
///
/// ```
/// use rt_math::exact::{Fixed, Window};
///
/// // Are three decimal points on a line? In doubles (0.3 - 0.1) (0.2 - 0.1) - (0.2 - 0.1) (0.3 - 0.1) may round to anything.
/// let points = [[0.1, 0.1], [0.2, 0.2], [0.3, 0.3]];
/// let window = Window::<1>::around(points.as_flattened()).unwrap();
/// let [a, b, c] = points.map(|point| point.map(|x| window.fixed(x)));
/// let (e, f) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
/// let turn = Fixed::<2>::product(&e[0], &f[1]) - Fixed::product(&e[1], &f[0]);
/// assert!(turn.sign().is_eq());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fixed<const LIMBS: usize>([u64; LIMBS]);

impl<const LIMBS: usize> Fixed<LIMBS> {
    /// Zero.
    pub const ZERO: Self = Self([0; LIMBS]);

    /// One unit.
    pub const ONE: Self = {
        let mut limbs = [0; LIMBS];
        limbs[0] = 1;
        Self(limbs)
    };

    /// How the value compares with zero: `Less` is negative.
    #[inline(always)]
    #[must_use]
    pub fn sign(&self) -> Ordering {
        if self.is_negative() {
            Ordering::Less
        } else if self.0.iter().fold(0, |all, limb| all | limb) == 0 {
            Ordering::Equal
        } else {
            Ordering::Greater
        }
    }

    /// The exact product; `LIMBS` must be at least `A + B`, which the compiler checks.
    #[inline(always)]
    #[must_use]
    pub fn product<const A: usize, const B: usize>(a: &Fixed<A>, b: &Fixed<B>) -> Self {
        const { assert!(LIMBS >= A + B) };
        // Up to two limbs by one: signed multiplication of the highest ones.
        if A == 1 && B == 1 {
            let wide = i128::from(a.0[0].cast_signed()) * i128::from(b.0[0].cast_signed());
            return Self::from_upper(low(wide.cast_unsigned()), wide >> 64);
        }
        if A == 2 && B == 1 {
            let b = b.0[0];
            let lower = u128::from(a.0[0]) * u128::from(b);
            let taken = a.0[0] & 0u64.wrapping_sub(b >> 63);
            let upper = i128::from(a.0[1].cast_signed()) * i128::from(b.cast_signed());
            return Self::from_upper(low(lower), upper + i128::from(high(lower)) - i128::from(taken));
        }
        if A == 1 && B == 2 {
            return Self::product(b, a);
        }
        let mut product = [0; LIMBS];
        // As if both were not negative.
        for i in 0..A {
            let mut carry = 0;
            for j in 0..B {
                let wide = u128::from(a.0[i]) * u128::from(b.0[j]) + u128::from(product[i + j]) + u128::from(carry);
                (product[i + j], carry) = (low(wide), high(wide));
            }
            product[i + B] = carry;
        }
        // A negative factor counted 2^(64 A) too much: take away the other one there.
        let (mut borrow_a, mut borrow_b) = (false, false);
        let (mask_a, mask_b) = (a.sign_mask(), b.sign_mask());
        for j in 0..B {
            (product[A + j], borrow_a) = subtract_with_borrow(product[A + j], b.0[j] & mask_a, borrow_a);
        }
        for i in 0..A {
            (product[B + i], borrow_b) = subtract_with_borrow(product[B + i], a.0[i] & mask_b, borrow_b);
        }
        let filling = if product[A + B - 1] >> 63 == 1 { u64::MAX } else { 0 };
        product[A + B..].fill(filling);
        Self(product)
    }

    /// The number with this lowest limb and, above it, these two; with less than three limbs, it must fit.
    #[inline(always)]
    fn from_upper(lowest: u64, upper: i128) -> Self {
        let mut limbs = [low((upper >> 127).cast_unsigned()); LIMBS];
        for (limb, value) in limbs.iter_mut().zip([lowest, low(upper.cast_unsigned()), high(upper.cast_unsigned())]) {
            *limb = value;
        }
        Self(limbs)
    }

    /// The same number with more limbs.
    #[inline(always)]
    #[must_use]
    pub fn widen<const WIDE: usize>(&self) -> Fixed<WIDE> {
        const { assert!(WIDE >= LIMBS) };
        let mut wide = [self.sign_mask(); WIDE];
        wide[..LIMBS].copy_from_slice(&self.0);
        Fixed(wide)
    }

    /// The correctly rounded quotient `numerator / denominator · 2^exponent`; NaN if the denominator is zero.
    ///
    /// Ties go to even, subnormals and overflow to infinity included. Zero gives +0.0, and what underflows keeps its
    /// sign.
    ///
    /// At most [`MOST_LIMBS`] limbs each.
    #[inline]
    #[must_use]
    pub fn quotient<const D: usize>(numerator: &Self, denominator: &Fixed<D>, exponent: i32) -> f64 {
        const { assert!(LIMBS <= MOST_LIMBS && D <= MOST_LIMBS) };
        let Some(d) = denominator.leading() else { return f64::NAN };
        let Some(n) = numerator.leading() else { return 0.0 };
        let negative = numerator.is_negative() != denominator.is_negative();
        // Both in 1..2.
        let scale = n.exponent - d.exponent + exponent;
        if SAFE.contains(&scale)
            && let Some(quotient) = rounded_quotient(n.high_and_low(), d.high_and_low())
        {
            return signed(quotient * power_of_two(scale), negative);
        }
        // At the ends of the range, and next to a midpoint.
        let (lower, upper) = enclose(n.interval().scaled(exponent), d.interval());
        if lower == upper {
            return signed(upper, negative);
        }
        Long::quotient(&numerator.long(exponent), &denominator.long(0))
    }

    /// Returns the correctly rounded root `(p + √r) / q · 2^exponent` of `q x² - 2 p x + c`, or
    /// `(p - √r) / q · 2^exponent` if `minus`, where `self` is `p` and `r = p² - q c`; with ties, range and zero as in
    /// [`quotient`](Self::quotient).
    ///
    /// NaN if `q` is zero or `r` negative. At most [`MOST_LIMBS`] limbs each.
    #[inline]
    #[must_use]
    pub fn root<const R: usize, const Q: usize, const C: usize>(
        p: &Self,
        minus: bool,
        r: &Fixed<R>,
        q: &Fixed<Q>,
        c: &Fixed<C>,
        exponent: i32,
    ) -> f64 {
        const { assert!(LIMBS <= MOST_LIMBS && R <= MOST_LIMBS && Q <= MOST_LIMBS && C <= MOST_LIMBS) };
        let (Some(q_leading), false) = (q.leading(), r.is_negative()) else { return f64::NAN };
        let p_negative = match (p.sign(), r.sign()) {
            (Ordering::Equal, Ordering::Equal) => return 0.0,
            (Ordering::Equal, _) => minus,
            (sign, _) => sign.is_lt(),
        };
        let adds = p_negative == minus;
        // (p ± √r) / q = c / (p ∓ √r), where p and the root do not cancel.
        let (other, negative) = if adds {
            (q_leading, p_negative != q.is_negative())
        } else {
            let Some(c_leading) = c.leading() else { return 0.0 };
            (c_leading, c.is_negative() != p_negative)
        };
        let zero = Leading { bits: 0, next: 0, exponent: other.exponent, sticky: false };
        let (p_leading, r_leading) = (p.leading(), r.leading());
        // The root of r times 4^-half is in 1..2, or zero.
        let half = r_leading.map_or(0, |r| (r.exponent + 63).div_euclid(2));
        let whole =
            p_leading.map_or(half, |p| if r_leading.is_some() { half.max(p.exponent + 63) } else { p.exponent + 63 });
        let (p_shift, r_shift) = (p_leading.map_or(0, |p| p.exponent + 63 - whole), half - whole);
        let scale = if adds { whole - (other.exponent + 63) } else { other.exponent + 63 - whole } + exponent;
        if SAFE.contains(&scale) && p_shift > -SMALL && r_shift > -SMALL {
            let odd = r_leading.map_or(0, |r| (r.exponent + 63).rem_euclid(2));
            let [p, root, other] = [p_leading, r_leading, Some(other)].map(|x| x.unwrap_or(zero).high_and_low());
            let shifts = [power_of_two(p_shift), power_of_two(odd), power_of_two(r_shift)];
            if let Some(quotient) = rounded_root(p, root, other, shifts, adds) {
                return signed(quotient * power_of_two(scale), negative);
            }
        }
        // p and √r times 2^exponent, r therefore twice that.
        Long::root(&p.long(exponent), minus, &r.long(2 * exponent), &q.long(0))
    }

    #[inline(always)]
    fn is_negative(&self) -> bool {
        self.0[LIMBS - 1] >> 63 == 1
    }

    /// All ones for a negative number, else 0.
    #[inline(always)]
    fn sign_mask(&self) -> u64 {
        0u64.wrapping_sub(self.0[LIMBS - 1] >> 63)
    }

    /// Without a branch.
    #[inline(always)]
    fn negated_if(self, negative: bool) -> Self {
        let mask = 0u64.wrapping_sub(u64::from(negative));
        let mut inverted = self;
        for limb in &mut inverted.0 {
            *limb ^= mask;
        }
        inverted - Self([mask; LIMBS])
    }

    /// The limbs of the magnitude.
    #[inline(always)]
    fn magnitude(&self) -> [u64; LIMBS] {
        if self.is_negative() { (-*self).0 } else { self.0 }
    }

    /// The leading bits of the magnitude; `None` for zero.
    #[inline(always)]
    fn leading(&self) -> Option<Leading> {
        // Moved up until the highest limb is not zero; each step is one conditional move a limb.
        let mut limbs = self.magnitude();
        let mut top = LIMBS - 1;
        for _ in 1..LIMBS {
            if limbs[LIMBS - 1] == 0 {
                limbs.copy_within(..LIMBS - 1, 1);
                limbs[0] = 0;
                top = top.wrapping_sub(1);
            }
        }
        let limb = |depth: usize| if depth < LIMBS { limbs[LIMBS - 1 - depth] } else { 0 };
        if limb(0) == 0 {
            return None;
        }
        let shift = limb(0).leading_zeros();
        let wide = (u128::from(limb(0)) << 64 | u128::from(limb(1))) << shift | (u128::from(limb(2)) << shift) >> 64;
        let rest = (3..LIMBS).fold(limb(2) << shift, |rest, depth| rest | limb(depth));
        let exponent = position(top) - shift.cast_signed();
        Some(Leading { bits: high(wide), next: low(wide), exponent, sticky: low(wide) != 0 || rest != 0 })
    }

    /// The number as `(high + low) 2^exponent` within `2 u²` of itself, with `|high|` in `1..2` and `|low|` at most
    /// `2^-52`; `None` for zero.
    #[inline(always)]
    pub(crate) fn parts(&self) -> Option<([f64; 2], i32)> {
        let leading = self.leading()?;
        let negative = self.is_negative();
        Some((leading.high_and_low().map(|x| signed(x, negative)), leading.exponent + 63))
    }

    /// The value times `2^exponent` as a long number.
    #[cold]
    #[inline(never)]
    fn long(&self, exponent: i32) -> Long {
        Long::from_integer(self.is_negative(), &self.magnitude(), exponent)
    }
}

impl Leading {
    /// The magnitude times the power of two that brings it to `1..2`, within `2 u²` of itself: the leading 53 bits, and
    /// the next 63 bits rounded. Zero gives zero.
    #[inline(always)]
    fn high_and_low(self) -> [f64; 2] {
        // (Signed: one instruction everywhere.)
        let number = |bits: u64| bits.cast_signed() as f64;
        let rest = (self.bits << 53 | self.next >> 11) >> 1;
        [number(self.bits >> 11) * power_of_two(-52), number(rest) * power_of_two(-115)]
    }
}

/// Exponents of a result in `1/4..4` that keep it and its neighbours normal and finite.
const SAFE: core::ops::Range<i32> = -1018..1018;
/// An operand that is smaller than the other by such a power of two is left to integers.
const SMALL: i32 = 400;

/// The error of [`rounded_quotient`] and [`rounded_root`] before the last rounding, relative: `docs/numerics.md`,
/// section 1.
const ERROR: f64 = 64.0 * U * U;

fma_dispatch! {
    /// The quotient of two numbers in `1..2`, correctly rounded, if that is certain.
    fn rounded_quotient(n: [f64; 2], d: [f64; 2]) -> Option<f64> = rounded_quotient_kernel;
}

#[inline(always)]
fn rounded_quotient_kernel<const FMA: bool>([n, n_low]: [f64; 2], [d, d_low]: [f64; 2]) -> Option<f64> {
    let quotient = DoubleDouble::<FMA>::sum(n, n_low) / DoubleDouble::sum(d, d_low);
    round_if_certain(quotient.high(), quotient.low(), ERROR * quotient.high())
}

fma_dispatch! {
    /// `(p + √r) / q` or, unless `over`, `q / (p + √r)`, correctly rounded, if that is certain; the numbers are not
    /// negative, in `1..2` or zero, `p` then multiplied with the first shift, `r` with the second and its root with the
    /// third.
    fn rounded_root(p: [f64; 2], r: [f64; 2], q: [f64; 2], shifts: [f64; 3], over: bool) -> Option<f64>
        = rounded_root_kernel;
}

#[inline(always)]
fn rounded_root_kernel<const FMA: bool>(
    p: [f64; 2],
    r: [f64; 2],
    q: [f64; 2],
    [p_shift, r_shift, root_shift]: [f64; 3],
    over: bool,
) -> Option<f64> {
    let number = |[high, low]: [f64; 2]| DoubleDouble::<FMA>::sum(high, low);
    let sum = number(p).scale(p_shift) + number(r).scale(r_shift).sqrt().scale(root_shift);
    let quotient = if over { sum / number(q) } else { number(q) / sum };
    round_if_certain(quotient.high(), quotient.low(), ERROR * quotient.high())
}

/// What [`Fixed::quotient`] and [`Fixed::root`] accept.
pub const MOST_LIMBS: usize = 12;

/// Decides what the leading bits do not: an operand of [`MOST_LIMBS`] limbs takes one more where it is shifted, a
/// midpoint times it two more, and both are squared: `2 (MOST_LIMBS + 3)`, and two for the sums.
type Long = Dyadic<32>;

#[inline(always)]
fn signed(magnitude: f64, negative: bool) -> f64 {
    if negative { -magnitude } else { magnitude }
}

/// The weight of the lowest bit of a limb.
#[expect(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "a few limbs")]
fn position(limb: usize) -> i32 {
    64 * limb as i32
}

impl<const LIMBS: usize> Add for Fixed<LIMBS> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let (mut sum, mut carry) = (self.0, false);
        for (limb, &more) in sum.iter_mut().zip(&other.0) {
            (*limb, carry) = add_with_carry(*limb, more, carry);
        }
        Self(sum)
    }
}

impl<const LIMBS: usize> Sub for Fixed<LIMBS> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let (mut difference, mut borrow) = (self.0, false);
        for (limb, &less) in difference.iter_mut().zip(&other.0) {
            (*limb, borrow) = subtract_with_borrow(*limb, less, borrow);
        }
        Self(difference)
    }
}

impl<const LIMBS: usize> Neg for Fixed<LIMBS> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self::ZERO - self
    }
}

/// A power of two of which some doubles are multiples, each below `2^(64 LIMBS - 3)` times it in magnitude: so a
/// [`Fixed`] of `LIMBS` limbs holds each of them and the difference of two, and one of `k LIMBS` limbs the sum of any
/// six products of `k` of these.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window<const LIMBS: usize> {
    exponent: i32,
}

impl<const LIMBS: usize> Window<LIMBS> {
    /// Bits of a magnitude.
    #[expect(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "a few limbs")]
    const BITS: i32 = 64 * LIMBS as i32 - 3;

    /// The window in which all of these lie; `None` if there is none, or one of them is not finite.
    #[inline(always)]
    #[must_use]
    pub fn around(numbers: &[f64]) -> Option<Self> {
        let mut top = 0;
        for x in numbers {
            top = top.max(x.to_bits() & (u64::MAX >> 1));
        }
        // The largest number is below 2^(biased - 1022).
        let biased = (top >> 52) as i32;
        let window = Self { exponent: biased.max(1) - 1022 - Self::BITS };
        let mut lost = 0;
        for x in numbers {
            lost |= window.place(*x).1;
        }
        (biased < 2047 && lost == 0).then_some(window)
    }

    /// The unit: a number `x` of the window is `fixed(x) 2^exponent`.
    #[inline(always)]
    #[must_use]
    pub fn exponent(self) -> i32 {
        self.exponent
    }

    /// The number in units of the window; it must be one of those that the window is around.
    #[inline(always)]
    #[must_use]
    pub fn fixed(self, x: f64) -> Fixed<LIMBS> {
        Fixed(self.place(x).0).negated_if(x.is_sign_negative())
    }

    /// The components of a vector, as [`fixed`](Self::fixed) gives them.
    #[inline(always)]
    #[must_use]
    pub fn vector(self, v: DVec3) -> [Fixed<LIMBS>; 3] {
        [self.fixed(v.x), self.fixed(v.y), self.fixed(v.z)]
    }

    /// The magnitude in units, and the bits that are lost below the unit.
    #[inline(always)]
    fn place(self, x: f64) -> ([u64; LIMBS], u64) {
        let mut limbs = [0; LIMBS];
        let (mantissa, exponent) = mantissa_and_weight(x);
        // The first bit of the significand as high as it may stand, and by how much it stands lower.
        let down = (self.exponent + Self::BITS - 53 - exponent).cast_unsigned();
        let lost = if LIMBS == 1 {
            let (top, down) = (mantissa << 8, down.min(63));
            limbs[0] = top >> down;
            top ^ (limbs[0] << down)
        } else if LIMBS > 2 {
            let most = (Self::BITS - 53).cast_unsigned();
            if let Some(up) = most.checked_sub(down) {
                let (limb, wide) = ((up / 64) as usize, u128::from(mantissa) << (up % 64));
                limbs[limb] = low(wide);
                if limb + 1 < LIMBS {
                    limbs[limb + 1] = high(wide);
                }
                0
            } else {
                let down = (down - most).min(63);
                limbs[0] = mantissa >> down;
                mantissa ^ (limbs[0] << down)
            }
        } else {
            let (top, down) = (u128::from(mantissa) << 72, down.min(127));
            let magnitude = top >> down;
            (limbs[0], limbs[LIMBS - 1]) = (low(magnitude), high(magnitude));
            let lost = top ^ (magnitude << down);
            low(lost) | high(lost)
        };
        (limbs, lost)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use oracle::{Big, Random, cases, exact, is_rounded_quotient, is_rounding_of, power_of_two, sign};

    fn whole(digit: u64) -> Big {
        Big::from(digit).with_precision(0).value()
    }

    fn value<const LIMBS: usize>(x: &Fixed<LIMBS>, exponent: i32) -> Big {
        let digits = x.magnitude();
        let integer = digits.iter().rev().fold(Big::ZERO, |sum, &digit| sum * power_of_two(64) + whole(digit));
        let magnitude = integer * power_of_two(exponent);
        if x.is_negative() { -magnitude } else { magnitude }
    }

    /// Numbers of one scale: full doubles, decimals, grid points, zeros.
    fn numbers<const N: usize>(rng: &mut Random) -> [f64; N] {
        let (kind, scale) = (rng.below(4), 2f64.powi(rng.integer(-300..300)));
        core::array::from_fn(|_| {
            let x = rng.with_exponent(-6..1);
            scale
                * match kind {
                    0 => x,
                    1 => (x * 100.0).round() / 100.0,
                    2 => (x * 8.0).round() / 8.0,
                    _ if rng.below(2) == 0 => 0.0,
                    _ => x,
                }
        })
    }

    #[test]
    fn arithmetic_is_exact() {
        let mut rng = Random::new(41);
        let mut inside = 0;
        for _ in 0..cases(1_000_000) {
            let [a, b, c, d] = numbers(&mut rng);
            let Some(window) = Window::<1>::around(&[a, b, c, d]) else { continue };
            inside += 1;
            let unit = window.exponent();
            let [x, y, z, w] = [a, b, c, d].map(|x| window.fixed(x));
            assert_eq!(value(&x, unit), exact(a), "{a:e} in {window:?}");
            let (xy, zw) = (x - y, z - w);
            assert_eq!(value(&xy, unit), exact(a) - exact(b));
            assert_eq!(xy.sign(), exact(a).cmp(&exact(b)));
            let square = Fixed::<2>::product(&xy, &zw);
            let truth = (exact(a) - exact(b)) * (exact(c) - exact(d));
            assert_eq!(value(&square, 2 * unit), truth);
            let cube = Fixed::<3>::product(&square, &xy) - Fixed::product(&x, &square);
            let truth = &truth * (exact(a) - exact(b)) - exact(a) * &truth;
            assert_eq!(value(&cube, 3 * unit), truth);
            assert_eq!(value(&cube.widen::<6>(), 3 * unit), truth);
            assert_eq!(
                value(&Fixed::<6>::product(&square, &-cube), 5 * unit),
                -(truth.clone() * (exact(a) - exact(b)) * (exact(c) - exact(d)))
            );
        }
        assert!(inside > 5_000, "{inside}");
    }

    fn holds<const LIMBS: usize>(window: Option<Window<LIMBS>>, x: f64) {
        let held = window.map(|window| value(&window.fixed(x), window.exponent()));
        assert!(held.is_none_or(|held| held == exact(x)), "{x:e} in {window:?}");
    }

    #[test]
    fn a_window_holds_what_fits_and_nothing_else() {
        let mut rng = Random::new(42);
        let (mut inside, mut outside) = (0, 0);
        for _ in 0..cases(1_000_000) {
            let spread = rng.integer(1..200);
            let scale = rng.integer(-1074..900);
            let xs: [f64; 3] = core::array::from_fn(|_| rng.with_exponent(scale..scale + spread));
            let largest = xs.iter().fold(0.0f64, |most, x| most.max(x.abs()));
            let check = |window: Option<i32>, bits: i32, count: &mut dyn FnMut(bool)| {
                let Some(unit) = window else { return count(false) };
                count(true);
                // Below 2^bits units, all of them whole numbers.
                assert!(exact(largest) < power_of_two(unit + bits), "{xs:?} {unit}");
            };
            let mut count = |fits: bool| if fits { inside += 1 } else { outside += 1 };
            let one = Window::<1>::around(&xs);
            check(one.map(Window::exponent), 61, &mut count);
            let two = Window::<2>::around(&xs);
            check(two.map(Window::exponent), 125, &mut count);
            let three = Window::<3>::around(&xs);
            check(three.map(Window::exponent), 189, &mut count);
            for x in xs {
                holds(one, x);
                holds(two, x);
                holds(three, x);
            }
            assert!((two.is_some() || one.is_none()) && (three.is_some() || two.is_none()));
        }
        assert!(inside > 1_000 && outside > 1_000, "{inside} {outside}");
        assert_eq!(Window::<1>::around(&[1.0, f64::NAN]), None);
        assert_eq!(Window::<1>::around(&[f64::INFINITY]), None);
        assert!(Window::<1>::around(&[0.0, -0.0]).is_some());
    }

    #[test]
    fn quotients_round_correctly() {
        let mut rng = Random::new(43);
        let mut ties = 0;
        for i in 0..cases(1_000_000) {
            let exponent = [0, rng.integer(-1200..1200)][rng.below(2)];
            let (n, d): (Fixed<3>, Fixed<2>) = match i % 3 {
                0 => (any(&mut rng), any(&mut rng)),
                // halfway between two doubles, or hardly off
                1 => {
                    let d: Fixed<2> = Fixed([rng.bits() >> rng.below(64), 0]);
                    let tie = Fixed([1 << 53 | rng.bits() >> 11 | 1, 0]);
                    let dust = Fixed([rng.below(2) as u64, 0, 0]);
                    let n: Fixed<4> = Fixed::product(&tie, &d);
                    (Fixed([n.0[0], n.0[1], n.0[2]]) + dust, d)
                }
                _ => (Fixed([rng.bits() % 1000, 0, 0]), -Fixed([rng.bits() % 1000, 0])),
            };
            let found = Fixed::quotient(&n, &d, exponent);
            if d.sign().is_eq() {
                assert!(found.is_nan());
                continue;
            }
            ties += usize::from(i % 3 == 1 && found.is_normal());
            let right = is_rounded_quotient(found, &value(&n, exponent), &value(&d, 0));
            assert!(right, "{n:?} / {d:?} {exponent} gives {found:e}");
        }
        assert!(ties > 1_000, "{ties}");
    }

    fn any<const LIMBS: usize>(rng: &mut Random) -> Fixed<LIMBS> {
        let mut limbs = [0; LIMBS];
        let live = 1 + rng.below(LIMBS);
        for limb in &mut limbs[..live] {
            *limb = rng.bits();
        }
        limbs[live - 1] >>= rng.below(64);
        let number = Fixed(limbs);
        if rng.below(2) == 0 { -number } else { number }
    }

    #[test]
    fn roots_round_correctly() {
        let mut rng = Random::new(44);
        let mut cancelling = 0;
        for i in 0..cases(200_000) {
            let exponent = [0, rng.integer(-1100..1000)][rng.below(2)];
            let small = |rng: &mut Random, bits: usize| {
                let x = Fixed([rng.bits() >> (63 - rng.below(bits))]);
                if rng.below(2) == 0 { -x } else { x }
            };
            // q x² - 2 p x + c from its coefficients, or from roots that are whole numbers
            let (p, q, c): (Fixed<2>, Fixed<1>, Fixed<2>) = if i % 2 == 0 {
                (small(&mut rng, 60).widen(), small(&mut rng, 60), small(&mut rng, 20 + i % 40).widen())
            } else {
                let (x, y, q) = (small(&mut rng, 25), small(&mut rng, 25), small(&mut rng, 10));
                let q = q + q;
                let half = |sum: Fixed<1>| Fixed::<1>([sum.0[0] >> 1 | sum.0[0] & 1 << 63]);
                let (sum, product) = (Fixed::<2>::product(&half(q), &(x + y)), Fixed::<2>::product(&x, &y));
                (sum, q, Fixed([Fixed::<3>::product(&product, &q).0[0], Fixed::<3>::product(&product, &q).0[1]]))
            };
            let r = Fixed::<4>::product(&p, &p) - Fixed::<3>::product(&c, &q).widen();
            let (p_truth, r_truth, q_truth) = (value(&p, 0), value(&r, 0), value(&q, 0));
            for minus in [false, true] {
                let found = Fixed::root(&p, minus, &r, &q, &c, exponent);
                if r_truth < Big::ZERO || q_truth == Big::ZERO {
                    assert!(found.is_nan());
                    continue;
                }
                cancelling += usize::from(p.is_negative() != minus);
                // The sign of (p ± √r) unit / q - m.
                let compare = |m: &Big| {
                    let rest = m * &q_truth * power_of_two(-exponent) - &p_truth;
                    let square = &rest * &rest;
                    let order = match (minus, sign(&rest)) {
                        (false, Ordering::Less) => Ordering::Greater,
                        (false, _) => r_truth.cmp(&square),
                        (true, Ordering::Greater) => Ordering::Less,
                        (true, _) => square.cmp(&r_truth),
                    };
                    if q_truth < Big::ZERO { order.reverse() } else { order }
                };
                assert!(is_rounding_of(found, compare), "{p:?} {minus} {r:?} {q:?} {c:?} {exponent}: {found:e}");
            }
        }
        assert!(cancelling > 1_000, "{cancelling}");
    }

    /// Between a midpoint's bits and a last one there may be more zeros than any leading bits hold.
    #[test]
    fn a_single_bit_far_below_a_midpoint_decides_its_rounding() {
        let one = Fixed::<1>::ONE;
        for even in [0, 1] {
            // 53 bits, of which the last is even or odd, and half of it.
            let top = 1 << 62 | even << 10 | 1 << 9;
            let [down, up] = [0, 2].map(|more| ((1u64 << 53) + 2 * even + more) as f64 / 2f64.powi(53));
            let tie = if even == 0 { down } else { up };
            for (rest, expected) in [([0; 3], tie), ([1, 0, 0], up), ([0, 1, 0], up), ([0, 0, 1], up)] {
                let [a, b, c] = rest;
                let number = Fixed([a, b, c, top]);
                assert_eq!(Fixed::quotient(&number, &one, -254), expected, "{number:?}");
                assert_eq!(Fixed::quotient(&-number, &one, -254), -expected, "{number:?}");
            }
        }
    }
}
