//! Big numbers of fixed size on the stack: a sign and an integer times a power of two.
//!
//! Every finite double is such a number, and so are sums, differences and products of doubles: a polynomial of doubles
//! has an exact value here, over- and underflow included. A value is a run of 64-bit limbs, of which only the
//! live ones are worked on, at a position that is a whole number of limbs; so numbers are aligned by construction, no
//! operation shifts bits, and trailing zero limbs are dropped. In the usual case (doubles of like magnitude) a
//! number has a handful of limbs, whatever the capacity.
//!
//! Quotients and square roots are not dyadic, but their correctly rounded double is found exactly: the leading 64 bits
//! of the operands enclose the result so tightly that at most one midpoint between two doubles lies in the enclosure,
//! and one exact comparison with that midpoint decides. There is no loop, and an exact tie is seen as equality.

use core::cmp::Ordering;
use core::ops::{Add, Mul, Neg, Sub};

use super::by_value::by_value;
use super::enclosure::{Interval, Leading, add_with_carry, enclose, high, low, round, subtract_with_borrow};

/// An exact number: an integer of at most `LIMBS` 64-bit limbs times a power of two, with a sign.
///
/// # How many limbs
///
/// A number of which the highest bit has the weight 2ᵗ and the lowest set bit 2ᵇ takes at most `(t - b) / 64 + 2`
/// limbs (the two ends may each stick into a limb); so
///
/// - a double takes 2;
/// - a product of two numbers takes at most the sum of their limbs;
/// - a sum takes its span: with all terms bounded by 2ᵗ in magnitude and multiples of 2ᵇ, a sum of up to `k` terms
///   takes at most `(t + log2 k - b) / 64 + 2`.
///
/// Each kernel derives its `LIMBS` from the exponents of its inputs by this rule, for any doubles, which makes an
/// overflow impossible; a finite double is a multiple of 2⁻¹⁰⁷⁴ below 2¹⁰²⁴. The methods that round state what they
/// need besides. Every number is cleared and moved at its full size: where [`bits_spanned`] by the input shows that
/// fewer limbs do, a kernel takes fewer.
///
/// # Panics
/// An operation whose result does not fit panics. The rule above excludes it.
#[derive(Clone)]
pub struct Dyadic<const LIMBS: usize> {
    negative: bool,
    /// The weight of `limbs[0]` is `2^(64 base)`.
    base: i32,
    /// The number of live limbs. The first and the last live limb are not zero, so a value has one representation.
    len: usize,
    limbs: [u64; LIMBS],
}

impl<const LIMBS: usize> Dyadic<LIMBS> {
    /// Zero.
    pub const ZERO: Self = Self { negative: false, base: 0, len: 0, limbs: [0; LIMBS] };

    /// The exact value of a finite double; infinity is read as 2¹⁰²⁴ (its place in the sequence of doubles), and NaN
    /// has no meaning. `LIMBS` must be at least 2.
    #[must_use]
    pub fn from_f64(x: f64) -> Self {
        const { assert!(LIMBS >= 2) };
        let (mantissa, exponent) = mantissa_and_weight(x);
        let wide = u128::from(mantissa) << exponent.rem_euclid(64);
        let mut number = Self::blank(x.is_sign_negative(), exponent.div_euclid(64), 2);
        (number.limbs[0], number.limbs[1]) = (low(wide), high(wide));
        number.trim();
        number
    }

    /// The integer with these limbs, the lowest first, times `2^exponent`.
    pub(super) fn from_integer(negative: bool, limbs: &[u64], exponent: i32) -> Self {
        let (shift, base) = (exponent.rem_euclid(64), exponent.div_euclid(64));
        let mut number = Self::blank(negative, base, limbs.len() + 1);
        let mut carry = 0;
        for (place, &limb) in number.limbs.iter_mut().zip(limbs) {
            let wide = u128::from(limb) << shift;
            (*place, carry) = (low(wide) | carry, high(wide));
        }
        number.limbs[limbs.len()] = carry;
        number.trim();
        number
    }

    /// Whether it is negative, the position of the lowest live limb, and the live limbs, the lowest first.
    pub(super) fn parts(&self) -> (bool, i32, &[u64]) {
        (self.negative, self.base, self.live())
    }

    /// 2ᵏ.
    #[must_use]
    pub fn power_of_two(k: i32) -> Self {
        let mut limbs = [0; LIMBS];
        limbs[0] = 1 << k.rem_euclid(64);
        Self { negative: false, base: k.div_euclid(64), len: 1, limbs }
    }

    /// The value times 2ᵏ; takes at most one limb more.
    #[must_use]
    pub fn scale(&self, k: i32) -> Self {
        self * &Self::power_of_two(k)
    }

    /// How the value compares with zero: `Less` is negative.
    #[must_use]
    pub fn sign(&self) -> Ordering {
        match (self.len, self.negative) {
            (0, _) => Ordering::Equal,
            (_, true) => Ordering::Less,
            (_, false) => Ordering::Greater,
        }
    }

    /// The magnitude.
    #[must_use]
    pub fn abs(mut self) -> Self {
        self.negative = false;
        self
    }

    /// The square; the same as a product with itself.
    #[must_use]
    pub fn square(&self) -> Self {
        self * self
    }

    /// The correctly rounded double: ties to even, subnormals and overflow to infinity included. Zero gives +0.0, and a
    /// value that underflows keeps its sign.
    #[must_use]
    pub fn to_f64(&self) -> f64 {
        let Some(leading) = self.leading() else { return 0.0 };
        let magnitude = round(u128::from(leading.bits), leading.exponent, leading.sticky);
        if self.negative { -magnitude } else { magnitude }
    }

    /// The correctly rounded quotient `numerator / denominator`, with ties, range and zero as in [`to_f64`].
    ///
    /// The denominator must not be zero (zero gives NaN). With `n` and `d` limbs it needs
    /// `LIMBS >= max(n + 1, d + 2)`.
    ///
    /// [`to_f64`]: Self::to_f64
    #[must_use]
    pub fn quotient(numerator: &Self, denominator: &Self) -> f64 {
        let Some(d) = denominator.leading() else { return f64::NAN };
        let Some(n) = numerator.leading() else { return 0.0 };
        let (lower, upper) = enclose(n.interval(), d.interval());
        let magnitude = decide(lower, upper, |twice_midpoint: &Self| {
            (numerator + numerator).cmp_magnitude(&(twice_midpoint * denominator))
        });
        if numerator.negative == denominator.negative { magnitude } else { -magnitude }
    }

    /// The correctly rounded value of `(p + √r) / q`, or of `(p - √r) / q` if `minus`, with ties, range and zero as in
    /// [`to_f64`].
    ///
    /// The radicand must not be negative and `q` not zero (the answer is NaN then). Let all of `p`, `√r` and `2 m q` be
    /// below 2ᵗ in magnitude and multiples of 2ᵇ (for `√r`: `r` a multiple of 2²ᵇ), for every double or midpoint `m`
    /// next to the result; then `LIMBS >= (2 (t + 2) - 2 b) / 64 + 2` is enough. If `p` and the root cancel,
    /// `q (p ∓ √r)` must not be zero unless the result is, which holds by itself.
    ///
    /// [`to_f64`]: Self::to_f64
    #[must_use]
    pub fn root(p: &Self, minus: bool, r: &Self, q: &Self) -> f64 {
        let (Some(q_leading), Ordering::Equal | Ordering::Greater) = (q.leading(), r.sign()) else {
            return f64::NAN;
        };
        let (Some(p_leading), Some(r_leading)) = (p.leading(), r.leading()) else {
            if r.len == 0 {
                return Self::quotient(p, q);
            }
            let (lower, upper) = enclose(r.leading().map_or(Interval::ZERO, Leading::sqrt), q_leading.interval());
            let magnitude = decide(lower, upper, |twice_midpoint: &Self| {
                (r + r).scale(1).cmp_magnitude(&(twice_midpoint * q).square())
            });
            return if minus == q.negative { magnitude } else { -magnitude };
        };
        let sum = p_leading.interval().plus(r_leading.sqrt());
        let cancels = p.negative != minus;
        let (numerator_negative, (lower, upper)) = if cancels {
            // (p ± √r) / q = (p² - r) / (q (p ∓ √r)), where the last factor does not cancel
            let difference = p.square() - r;
            let Some(leading) = difference.leading() else { return 0.0 };
            let negative = difference.negative != p.negative;
            (negative, enclose(leading.interval(), sum.times(q_leading.interval())))
        } else {
            (p.negative, enclose(sum, q_leading.interval()))
        };
        let magnitude = decide(lower, upper, |twice_midpoint: &Self| {
            // s (p ± √r) against m |q|, s the sign that makes it positive: twice, ±2√r against 2 m |q| - 2 s p
            let twice_p = if numerator_negative { -(p + p) } else { p + p };
            let rest = (twice_midpoint * q).abs() - twice_p;
            let four_r = (r + r).scale(1);
            if minus == numerator_negative {
                if rest.negative { Ordering::Greater } else { four_r.cmp_magnitude(&rest.square()) }
            } else if rest.negative {
                rest.square().cmp_magnitude(&four_r)
            } else {
                Ordering::Less
            }
        });
        if numerator_negative == q.negative { magnitude } else { -magnitude }
    }

    /// The leading 64 bits; `None` for zero.
    fn leading(&self) -> Option<Leading> {
        let top = self.len.checked_sub(1)?;
        let shift = self.limbs[top].leading_zeros();
        let below = |depth| if top < depth { 0 } else { self.limbs[top - depth] };
        let wide =
            (u128::from(self.limbs[top]) << 64 | u128::from(below(1))) << shift | (u128::from(below(2)) << shift) >> 64;
        // the lowest live limb is not zero: with a third one, something is left after 64 bits
        let sticky = low(wide) != 0 || top >= 2;
        let exponent = 64 * (self.base + index(top)) - shift.cast_signed();
        Some(Leading { bits: high(wide), next: low(wide), exponent, sticky })
    }

    /// The position one above the highest live limb, in limbs.
    fn top(&self) -> i32 {
        self.base + index(self.len)
    }

    fn live(&self) -> &[u64] {
        &self.limbs[..self.len]
    }

    /// A number with `len` live limbs, all still zero.
    #[inline(always)]
    fn blank(negative: bool, base: i32, len: usize) -> Self {
        Self { negative, base, len, limbs: [0; LIMBS] }
    }

    /// Restores the promise on the first and the last limb.
    #[inline(always)]
    fn trim(&mut self) {
        if self.len == 0 || self.limbs[0] == 0 || self.limbs[self.len - 1] == 0 {
            self.trim_zeros();
        }
    }

    fn trim_zeros(&mut self) {
        while self.len > 0 && self.limbs[self.len - 1] == 0 {
            self.len -= 1;
        }
        if self.len == 0 {
            *self = Self::ZERO;
            return;
        }
        let zeros = self.live().iter().take_while(|&&limb| limb == 0).count();
        self.limbs.copy_within(zeros..self.len, 0);
        self.len -= zeros;
        self.limbs[self.len..self.len + zeros].fill(0);
        self.base += index(zeros);
    }

    fn cmp_magnitude(&self, other: &Self) -> Ordering {
        if self.len == 0 || other.len == 0 {
            return self.len.cmp(&other.len);
        }
        self.top().cmp(&other.top()).then_with(|| {
            // same highest position: the first difference from the top decides, and a longer number is larger
            let (mut a, mut b) = (self.live().iter().rev(), other.live().iter().rev());
            loop {
                match (a.next(), b.next()) {
                    (Some(x), Some(y)) if x == y => {}
                    (Some(x), Some(y)) => return x.cmp(y),
                    (x, y) => return x.is_some().cmp(&y.is_some()),
                }
            }
        })
    }

    /// `|self| + |other|` with the sign of `self`; both not zero.
    fn add_magnitude(&self, other: &Self) -> Self {
        let base = self.base.min(other.base);
        let mut sum = Self::blank(self.negative, base, span(base, self.top().max(other.top())));
        let at = span(base, self.base);
        sum.limbs[at..at + self.len].copy_from_slice(self.live());
        let mut carry = false;
        let at = span(base, other.base);
        for (limb, &more) in sum.limbs[at..at + other.len].iter_mut().zip(other.live()) {
            (*limb, carry) = add_with_carry(*limb, more, carry);
        }
        if carry {
            for limb in &mut sum.limbs[at + other.len..sum.len] {
                (*limb, carry) = limb.overflowing_add(1);
                if !carry {
                    break;
                }
            }
        }
        if carry {
            sum.limbs[sum.len] = 1;
            sum.len += 1;
        }
        sum.trim();
        sum
    }

    /// `|self| - |other|` with the sign of `self`; needs `|self| > |other| > 0`.
    fn sub_magnitude(&self, other: &Self) -> Self {
        let base = self.base.min(other.base);
        let mut difference = Self { negative: self.negative, base, len: span(base, self.top()), ..Self::ZERO };
        let at = span(base, self.base);
        difference.limbs[at..at + self.len].copy_from_slice(self.live());
        let mut borrow = false;
        let at = span(base, other.base);
        for (limb, &less) in difference.limbs[at..at + other.len].iter_mut().zip(other.live()) {
            (*limb, borrow) = subtract_with_borrow(*limb, less, borrow);
        }
        if borrow {
            for limb in &mut difference.limbs[at + other.len..difference.len] {
                (*limb, borrow) = limb.overflowing_sub(1);
                if !borrow {
                    break;
                }
            }
        }
        difference.trim();
        difference
    }
}

impl<const LIMBS: usize> Add for &Dyadic<LIMBS> {
    type Output = Dyadic<LIMBS>;

    fn add(self, other: Self) -> Dyadic<LIMBS> {
        if self.len == 0 || other.len == 0 {
            return if self.len == 0 { other.clone() } else { self.clone() };
        }
        if self.negative == other.negative {
            return self.add_magnitude(other);
        }
        match self.cmp_magnitude(other) {
            Ordering::Equal => Dyadic::ZERO,
            Ordering::Greater => self.sub_magnitude(other),
            Ordering::Less => other.sub_magnitude(self),
        }
    }
}

impl<const LIMBS: usize> Sub for &Dyadic<LIMBS> {
    type Output = Dyadic<LIMBS>;

    fn sub(self, other: Self) -> Dyadic<LIMBS> {
        // a - b = -(b - a) = -(b + -a) needs one negation; -b + a would copy b as well
        if self.len == 0 || other.len == 0 {
            return if self.len == 0 { -other.clone() } else { self.clone() };
        }
        if self.negative != other.negative {
            return self.add_magnitude(other);
        }
        match self.cmp_magnitude(other) {
            Ordering::Equal => Dyadic::ZERO,
            Ordering::Greater => self.sub_magnitude(other),
            Ordering::Less => -other.sub_magnitude(self),
        }
    }
}

impl<const LIMBS: usize> Mul for &Dyadic<LIMBS> {
    type Output = Dyadic<LIMBS>;

    fn mul(self, other: Self) -> Dyadic<LIMBS> {
        if self.len == 0 || other.len == 0 {
            return Dyadic::ZERO;
        }
        let len = self.len + other.len - 1; // and one more if the last carry is not zero
        let mut product = Dyadic::blank(self.negative != other.negative, self.base + other.base, len);
        let mut last_carry = 0;
        for (i, &x) in self.live().iter().enumerate() {
            let mut carry = 0;
            for (limb, &y) in product.limbs[i..i + other.len].iter_mut().zip(other.live()) {
                let wide = u128::from(x) * u128::from(y) + u128::from(*limb) + u128::from(carry);
                (*limb, carry) = (low(wide), high(wide));
            }
            if i + 1 < self.len {
                product.limbs[i + other.len] = carry;
            } else {
                last_carry = carry;
            }
        }
        if last_carry != 0 {
            product.limbs[len] = last_carry;
            product.len += 1;
        }
        product.trim();
        product
    }
}

impl<const LIMBS: usize> Neg for Dyadic<LIMBS> {
    type Output = Self;

    fn neg(mut self) -> Self {
        self.negative = self.len != 0 && !self.negative;
        self
    }
}

by_value!(Dyadic: Add add Sub sub Mul mul);

impl<const LIMBS: usize> Ord for Dyadic<LIMBS> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.sign().cmp(&other.sign()).then_with(|| {
            let magnitude = self.cmp_magnitude(other);
            if self.negative { magnitude.reverse() } else { magnitude }
        })
    }
}

impl<const LIMBS: usize> PartialOrd for Dyadic<LIMBS> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<const LIMBS: usize> PartialEq for Dyadic<LIMBS> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl<const LIMBS: usize> Eq for Dyadic<LIMBS> {}

impl<const LIMBS: usize> core::fmt::Debug for Dyadic<LIMBS> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let sign = if self.negative { "-" } else { "" };
        write!(f, "{sign}{:x?} * 2^{}", self.live(), 64 * self.base)
    }
}

/// Chooses between two equal or neighbouring doubles that enclose a positive value: `compare(2 m)` tells how the value
/// compares with the midpoint `m` of the two.
fn decide<const LIMBS: usize>(lower: f64, upper: f64, compare: impl FnOnce(&Dyadic<LIMBS>) -> Ordering) -> f64 {
    if lower == upper {
        return upper;
    }
    debug_assert!(lower.next_up() == upper, "{lower:e} {upper:e}");
    // an infinite upper neighbour counts as 2^1024 here, which is where rounding puts it
    match compare(&(Dyadic::from_f64(lower) + Dyadic::from_f64(upper))) {
        Ordering::Less => lower,
        Ordering::Greater => upper,
        Ordering::Equal if lower.to_bits() & 1 == 0 => lower,
        Ordering::Equal => upper,
    }
}

/// Returns the number of bits from the highest to the lowest one that any of these finite doubles has set; zeros have
/// none.
///
/// ```
/// use rt_math::exact::bits_spanned;
///
/// assert_eq!(bits_spanned(&[1.0, 0.0, -0.75]), 3);
/// ```
#[must_use]
pub fn bits_spanned(numbers: &[f64]) -> i32 {
    let (mut top, mut bottom) = (i32::MIN, i32::MAX);
    for x in numbers {
        let (mantissa, exponent) = mantissa_and_weight(*x);
        if mantissa != 0 {
            top = top.max(exponent + 64 - mantissa.leading_zeros().cast_signed());
            bottom = bottom.min(exponent + mantissa.trailing_zeros().cast_signed());
        }
    }
    if top < bottom { 0 } else { top - bottom }
}

/// The magnitude of a double as an integer times a power of two.
#[inline(always)]
pub(super) fn mantissa_and_weight(x: f64) -> (u64, i32) {
    let bits = x.to_bits();
    let biased = ((bits >> 52) & 0x7ff) as i32;
    let fraction = bits & ((1 << 52) - 1);
    (if biased == 0 { fraction } else { fraction | 1 << 52 }, biased.max(1) - 1075)
}

/// A limb count as a signed position.
#[expect(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "at most LIMBS, a few hundred")]
fn index(limbs: usize) -> i32 {
    limbs as i32
}

/// The number of limbs from position `from` up to `to`.
fn span(from: i32, to: i32) -> usize {
    to.abs_diff(from) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use oracle::{Big, Random, cases, exact, is_rounded_quotient, is_rounding_of, is_tie, power_of_two, rounded, sign};

    /// Holds a cubic polynomial of any doubles, and its square.
    type Number = Dyadic<208>;

    fn value(x: &Number) -> Big {
        let whole = |digit: u64| Big::from(digit).with_precision(0).value();
        let integer = x.live().iter().rev().fold(Big::ZERO, |sum, &digit| sum * power_of_two(64) + whole(digit));
        let magnitude = integer * power_of_two(64 * x.base);
        if x.negative { -magnitude } else { magnitude }
    }

    fn sqr(x: &Big) -> Big {
        x * x
    }

    fn assert_normal(x: &Number) {
        assert!(x.len == 0 || x.limbs[0] != 0 && x.limbs[x.len - 1] != 0, "{x:?}");
        assert!(x.limbs[x.len..].iter().all(|&limb| limb == 0), "{x:?}");
        assert!(x.len > 0 || !x.negative && x.base == 0, "{x:?}");
    }

    /// A sum of up to three products of up to three doubles, wide, narrow or cancelling.
    fn polynomial(rng: &mut Random) -> (Number, Big) {
        let (mut sum, mut truth) = (Number::ZERO, Big::ZERO);
        for _ in 0..rng.below(3) + 1 {
            let (mut term, mut term_truth) = (Number::power_of_two(0), exact(1.0));
            for _ in 0..rng.below(3) + 1 {
                let x = if rng.below(3) == 0 { rng.finite() } else { rng.with_exponent(-60..60) };
                (term, term_truth) = (term * Number::from_f64(x), term_truth * exact(x));
            }
            if rng.below(2) == 0 {
                (sum, truth) = (sum + term, truth + term_truth);
            } else {
                (sum, truth) = (sum - term, truth - term_truth);
            }
            assert_normal(&sum);
        }
        (sum, truth)
    }

    #[test]
    fn arithmetic_is_exact() {
        let mut rng = Random::new(6);
        for _ in 0..cases(100_000) / 5 {
            let ((x, x_truth), (y, y_truth)) = (polynomial(&mut rng), polynomial(&mut rng));
            assert_eq!(value(&x), x_truth);
            assert_eq!(x.partial_cmp(&y), Some(x_truth.cmp(&y_truth)));
            assert_eq!(x.sign(), sign(&x_truth));
            assert_eq!(&(&x + &y) - &y, x);
            assert_eq!(-(&x - &y), &y - &x);
            assert_eq!(value(&(&x - &y)), &x_truth - &y_truth);
            let k = rng.integer(-300..300);
            assert_eq!(x.scale(k).scale(-k), x);
            assert_eq!(&x - &x, Number::ZERO);
        }
    }

    #[test]
    fn spans_hold_every_bit_and_end_at_two_of_them() {
        let mut rng = Random::new(11);
        for _ in 0..cases(100_000) {
            let numbers = [0; 3].map(|_| match rng.below(3) {
                0 => 0.0,
                1 => rng.finite(),
                _ => f64::from(rng.integer(-9..9)) * 2f64.powi(rng.integer(-60..60)),
            });
            let lowest = (-1074..1024).find(|&k| numbers.iter().any(|&x| has_bit(x, k)));
            let highest = (-1074..1024).rev().find(|&k| numbers.iter().any(|&x| has_bit(x, k)));
            let expected = lowest.zip(highest).map_or(0, |(lowest, highest)| highest - lowest + 1);
            assert_eq!(bits_spanned(&numbers), expected, "{numbers:?}");
        }
    }

    /// Whether a double has the bit of weight `2^k`.
    fn has_bit(x: f64, k: i32) -> bool {
        let limbs = Number::from_f64(x);
        let place = k.div_euclid(64) - limbs.base;
        let limb = usize::try_from(place).ok().and_then(|place| limbs.live().get(place));
        limb.is_some_and(|limb| limb >> k.rem_euclid(64) & 1 == 1)
    }

    #[test]
    fn doubles_go_in_and_out_unchanged() {
        let mut rng = Random::new(7);
        for _ in 0..cases(1_000_000) {
            let x = rng.finite() + 0.0;
            assert_eq!(Number::from_f64(x).to_f64().to_bits(), x.to_bits(), "{x:e}");
            assert_eq!(value(&Number::from_f64(x)), exact(x), "{x:e}");
        }
        assert_eq!(Number::from_f64(-0.0).to_f64().to_bits(), 0);
    }

    #[test]
    fn integers_round_correctly() {
        let mut rng = Random::new(8);
        let mut ties = 0;
        for _ in 0..cases(100_000) {
            let (x, truth) = hard_to_round(&mut rng);
            assert_eq!(x.to_f64().to_bits(), rounded(&truth).to_bits(), "{x:?}");
            ties += usize::from(is_tie(x.to_f64(), |m| truth.cmp(m)));
        }
        assert!(ties > 100, "{ties}");
    }

    /// A number at, or hardly off, a double or a midpoint of two, from end to end of the range and a little beyond.
    fn hard_to_round(rng: &mut Random) -> (Number, Big) {
        let range = [-1080..-1015, -1080..1024, 1000..1024][rng.below(3)].clone();
        let x = rng.with_exponent(range);
        let (mut number, mut truth) = (Number::from_f64(x), exact(x));
        let ulp = x.abs().next_up() - x.abs();
        if ulp.is_finite() && rng.below(4) > 0 {
            (number, truth) = (number + Number::from_f64(ulp).scale(-1), truth + exact(ulp) * exact(0.5));
        }
        if rng.below(2) == 0 {
            let shift = rng.integer(-1100..-30);
            let dust = rng.with_exponent(-10..10);
            number = number + Number::from_f64(dust).scale(shift) * Number::from_f64(ulp.min(1e300));
            truth += exact(dust) * power_of_two(shift) * exact(ulp.min(1e300));
        }
        if rng.below(8) == 0 {
            (number, truth) = (number.scale(60), truth * power_of_two(60));
        }
        (number, truth)
    }

    #[test]
    fn quotients_round_correctly() {
        let mut rng = Random::new(9);
        let mut ties = 0;
        for i in 0..cases(100_000) {
            // a quotient that is hard by construction, its terms multiplied by something, or any
            let ((n, n_truth), (d, d_truth)) = if i % 2 == 0 {
                let ((x, x_truth), (y, y_truth)) = (hard_to_round(&mut rng), polynomial(&mut rng));
                if y.sign() == Ordering::Equal {
                    continue;
                }
                ((&x * &y, x_truth * &y_truth), (y, y_truth))
            } else {
                (polynomial(&mut rng), polynomial(&mut rng))
            };
            if d.sign() == Ordering::Equal {
                assert!(Number::quotient(&n, &d).is_nan());
                continue;
            }
            let found = Number::quotient(&n, &d);
            // They are equal exactly at the midpoint.
            ties += usize::from(is_tie(found, |m| n_truth.cmp(&(m * &d_truth))));
            assert!(is_rounded_quotient(found, &n_truth, &d_truth), "{n:?} / {d:?} gives {found:e}");
        }
        assert!(ties > 100, "{ties}");
    }

    #[test]
    fn root_forms_round_correctly() {
        let mut rng = Random::new(10);
        let mut ties = 0;
        for i in 0..cases(100_000) {
            let double = |rng: &mut Random| {
                let x = if rng.below(4) == 0 { rng.finite() } else { rng.with_exponent(-60..60) };
                (Number::from_f64(x), exact(x))
            };
            let (mut q, q_truth) = double(&mut rng);
            if q.sign() == Ordering::Equal {
                q = Number::power_of_two(0);
            }
            let q_truth = if q_truth == Big::ZERO { exact(1.0) } else { q_truth };
            let minus = rng.below(2) == 0;
            let ((p, p_truth), (r, r_truth)) = match i % 4 {
                // a perfect square, with a result that is hard to round: p = x q -+ s, r = s^2
                0 => {
                    let ((x, x_truth), (s, s_truth)) = (hard_to_round(&mut rng), double(&mut rng));
                    let (s, s_truth) = if s_truth < Big::ZERO { (-s, -s_truth) } else { (s, s_truth) };
                    let xq = (&x * &q, x_truth * &q_truth);
                    let p = if minus { (&xq.0 + &s, xq.1 + &s_truth) } else { (&xq.0 - &s, xq.1 - &s_truth) };
                    (p, (s.square(), sqr(&s_truth)))
                }
                // p^2 and r nearly equal
                1 => {
                    let ((p, p_truth), (dust, dust_truth)) = (double(&mut rng), double(&mut rng));
                    (
                        (p.clone(), p_truth.clone()),
                        (p.square() + dust.square() * dust, sqr(&p_truth) + sqr(&dust_truth) * dust_truth),
                    )
                }
                2 => ((Number::ZERO, Big::ZERO), double(&mut rng)),
                _ => (double(&mut rng), double(&mut rng)),
            };
            let found = Number::root(&p, minus, &r, &q);
            if r_truth < Big::ZERO {
                assert!(found.is_nan());
                continue;
            }
            // sign of s (p + sigma sqrt r) / q - m, without the root
            let compare = |m: &Big| {
                let rest = m * &q_truth - &p_truth; // sigma sqrt r against rest, if q > 0
                let order = match (minus, sign(&rest)) {
                    (false, Ordering::Less) => Ordering::Greater,
                    (false, _) => r_truth.cmp(&sqr(&rest)),
                    (true, Ordering::Greater) => Ordering::Less,
                    (true, _) => sqr(&rest).cmp(&r_truth),
                };
                if q_truth < Big::ZERO { order.reverse() } else { order }
            };
            assert!(is_rounding_of(found, compare), "({p:?} {minus} sqrt {r:?}) / {q:?} gives {found:e}");
            if i % 4 == 0 {
                ties += usize::from(is_tie(found, compare));
            }
        }
        assert!(ties > 30, "{ties}");
    }
}
