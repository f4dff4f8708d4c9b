//! The Moore-Penrose pseudo-inverse of a 3 x 3 matrix.
//!
//! Five stages, each one decides what it can and leaves the rest to the next; all give the same bits.
//!
//! 1. [`regular`]: the inverse in double-double. Nearly every matrix is well scaled and regular, and ends here.
//! 2. [`whole`]: small whole numbers times a power of two, all exact in doubles. Here most singular matrices end.
//! 3. [`regular`] again, with the determinant in triple precision: nearly singular matrices.
//! 4. [`fixed`]: entries of like magnitude as exact fixed-point numbers.
//! 5. [`integers`]: exact for every finite matrix.
//!
//! [`truncated`] is for the other function, which takes small singular values as zero.

mod answer;
mod fixed;
mod integers;
mod regular;
mod truncated;
mod whole;

use glam::{DMat3, DVec3};

pub use answer::PseudoInverse;
use truncated::Estimate;

use crate::exact::{mantissa_and_exponent, power_of_two, scale};
use crate::fma_dispatch;

/// Defines a function of the nine entries of a matrix, column by column, whose body is compiled with and without FMA.
///
/// The entries cross the call by value: loads from memory that was just written would stall.
macro_rules! dispatched {
    (fn $name:ident<$fma:ident>($m:ident) -> $result:ty $body:block) => {
        #[inline(always)]
        fn $name($m: &[f64; 9]) -> $result {
            #[expect(clippy::too_many_arguments, reason = "by value")]
            #[inline(always)]
            fn kernel<const $fma: bool>(
                a: f64,
                b: f64,
                c: f64,
                d: f64,
                e: f64,
                f: f64,
                g: f64,
                h: f64,
                i: f64,
            ) -> $result {
                let $m = &[a, b, c, d, e, f, g, h, i];
                $body
            }
            fma_dispatch! {
                #[expect(clippy::too_many_arguments, reason = "by value")]
                fn by_value(a: f64, b: f64, c: f64, d: f64, e: f64, f: f64, g: f64, h: f64, i: f64) -> $result = kernel;
            }
            let [a, b, c, d, e, f, g, h, i] = *$m;
            by_value(a, b, c, d, e, f, g, h, i)
        }
    };
}

/// The same for a cold function, which is compiled once.
macro_rules! cold {
    ($(#[$doc:meta])* fn $name:ident($m:ident) -> $result:ty $body:block) => {
        $(#[$doc])*
        #[inline(always)]
        fn $name($m: &[f64; 9]) -> $result {
            #[cold]
            #[inline(never)]
            #[expect(clippy::too_many_arguments, reason = "by value")]
            fn by_value(a: f64, b: f64, c: f64, d: f64, e: f64, f: f64, g: f64, h: f64, i: f64) -> $result {
                let $m = &[a, b, c, d, e, f, g, h, i];
                $body
            }
            let [a, b, c, d, e, f, g, h, i] = *$m;
            by_value(a, b, c, d, e, f, g, h, i)
        }
    };
}

/// Returns the Moore-Penrose pseudo-inverse of `m` and the rank of `m`.
///
/// The rank is exact and every entry is correctly rounded (to nearest, ties to even), for all finite matrices: an entry
/// beyond the range of doubles is infinite, one that underflows is a zero with the sign of the exact value, and one
/// that is exactly zero is +0.0. For rank 3 this is the inverse. A matrix with an infinite or NaN entry has no
/// pseudo-inverse: every entry of the answer is NaN and the rank is 0.
///
/// The pseudo-inverse jumps where the rank drops: if the entries carry errors, so that a matrix meant to be singular is
/// not, [`pseudo_inverse_with_tolerance`] is the function to use.
///
/// Source: R. Penrose, "A generalized inverse for matrices", 1955, for the definition.
///
/// ```
/// use glam::{DMat3, DVec3};
/// use rt_math::pseudo_inverse;
///
/// // A rank-1 matrix: A+ = A^T / |A|^2.
/// let flat = DMat3::from_diagonal(DVec3::new(0.0, 4.0, 0.0));
/// let answer = pseudo_inverse(flat);
/// assert_eq!(answer.rank, 1);
/// assert_eq!(answer.matrix, DMat3::from_diagonal(DVec3::new(0.0, 0.25, 0.0)));
/// ```
#[must_use]
#[inline]
pub fn pseudo_inverse(m: DMat3) -> PseudoInverse {
    staged(&m.to_cols_array())
}

dispatched! {
    fn staged<FMA>(m) -> PseudoInverse {
        match regular::inverse::<FMA, false>(m) {
            Some(matrix) => PseudoInverse { matrix, rank: 3 },
            None => undecided(m),
        }
    }
}

cold! {
    /// All that double-double does not decide.
    fn undecided(entries) -> PseudoInverse {
        let m = &DMat3::from_cols_array(entries);
        let decided = if whole::is_likely(entries) {
            whole::pseudo_inverse(m)
        } else {
            cancelling(entries).map(|matrix| PseudoInverse { matrix, rank: 3 })
        };
        if let Some(answer) = decided {
            return answer;
        }
        if !m.is_finite() {
            return PseudoInverse { matrix: DMat3::NAN, rank: 0 };
        }
        rescaled(m, pseudo_inverse).or_else(|| fixed::pseudo_inverse(m)).unwrap_or_else(|| integers::pseudo_inverse(m))
    }
}

dispatched! {
    fn cancelling<FMA>(m) -> Option<DMat3> {
        regular::inverse::<FMA, true>(m)
    }
}

/// Returns the row sums of the pseudo-inverse of `m`: the least-squares solution of smallest length of
/// `m x = (1, 1, 1)`.
///
/// Each is correctly rounded, for all finite matrices, with zeros and the ends of the range as for [`pseudo_inverse`].
/// A matrix with an infinite or NaN entry gives NaN. The three sums of a matrix have one denominator, so each is one
/// exact quotient.
///
/// ```
/// use glam::{DMat3, DVec3};
/// use rt_math::pseudo_inverse_row_sums;
///
/// let axes = DMat3::from_diagonal(DVec3::new(2.0, 4.0, 0.0));
/// assert_eq!(pseudo_inverse_row_sums(axes), DVec3::new(0.5, 0.25, 0.0));
/// ```
#[must_use]
#[inline]
pub fn pseudo_inverse_row_sums(m: DMat3) -> DVec3 {
    staged_sums(&m.to_cols_array())
}

dispatched! {
    fn staged_sums<FMA>(m) -> DVec3 {
        match regular::row_sums::<FMA, false>(m) {
            Some(sums) => sums,
            None => undecided_sums(m),
        }
    }
}

cold! {
    /// The same for the row sums.
    fn undecided_sums(entries) -> DVec3 {
        let m = &DMat3::from_cols_array(entries);
        let decided = if whole::is_likely(entries) { whole::row_sums(m) } else { cancelling_sums(entries) };
        if let Some(sums) = decided {
            return sums;
        }
        if !m.is_finite() {
            return DVec3::NAN;
        }
        fixed::row_sums(m).unwrap_or_else(|| integers::row_sums(m))
    }
}

dispatched! {
    fn cancelling_sums<FMA>(m) -> Option<DVec3> {
        regular::row_sums::<FMA, true>(m)
    }
}

/// Returns the pseudo-inverse of `m` with every singular value up to `rtol` times the largest taken as zero.
///
/// This is the meaning of `rtol` in `numpy.linalg.pinv`; the rank is the number of singular values that are kept. If
/// that is the exact rank, the answer is that of [`pseudo_inverse`] to the bit. Otherwise its error, in the spectral
/// norm and relative to its own norm, is at most 16 ε σₖ² / (σₖ² - σₖ₊₁²), with ε = 2⁻⁵², σₖ the last singular value
/// that is kept and σₖ₊₁ the first that is dropped (tested, not proved), where entries neither over- nor underflow.
/// Singular values are compared with an error of about 16 ε of each: so close to the threshold, either answer is
/// possible.
///
/// An `rtol` below 2⁻⁹⁰⁰, zero and negative numbers included, drops nothing; one of 1 or more drops everything. If
/// `rtol` is NaN, or an entry is infinite or NaN, every entry of the answer is NaN and the rank is 0.
///
/// ```
/// use glam::{DMat3, DVec3};
/// use rt_math::pseudo_inverse_with_tolerance;
///
/// let nearly_flat = DMat3::from_diagonal(DVec3::new(2.0, 4.0, 1e-17));
/// let answer = pseudo_inverse_with_tolerance(nearly_flat, 1e-15);
/// assert_eq!(answer.rank, 2);
/// assert_eq!(answer.matrix, DMat3::from_diagonal(DVec3::new(0.5, 0.25, 0.0)));
/// ```
#[must_use]
pub fn pseudo_inverse_with_tolerance(m: DMat3, rtol: f64) -> PseudoInverse {
    const SMALLEST: f64 = power_of_two(-900);
    if !m.is_finite() || rtol.is_nan() {
        return PseudoInverse { matrix: DMat3::NAN, rank: 0 };
    }
    if rtol >= 1.0 {
        return PseudoInverse { matrix: DMat3::ZERO, rank: 0 };
    }
    if rtol < SMALLEST {
        return pseudo_inverse(m);
    }
    rescaled(&m, |m| with_tolerance(m, rtol)).unwrap_or_else(|| with_tolerance(m, rtol))
}

/// The same, for a tolerance between those limits.
#[inline(always)]
fn with_tolerance(m: DMat3, rtol: f64) -> PseudoInverse {
    let entries = m.to_cols_array();
    // Double-double rarely decides small whole numbers that another stage does not decide sooner.
    let exact = if whole::is_likely(&entries) { None } else { regular_inverse(&entries) };
    if let Some(matrix) = exact {
        let exact = PseudoInverse { matrix, rank: 3 };
        if truncated::keeps_all(&m, rtol, &exact) {
            return exact;
        }
    }
    nearly_singular(&m, rtol, exact)
}

/// What has singular values to drop, or may have; `regular` is the inverse, if double-double gives it.
#[cold]
#[inline(never)]
fn nearly_singular(m: &DMat3, rtol: f64, regular: Option<DMat3>) -> PseudoInverse {
    let entries = m.to_cols_array();
    let estimate = if whole::is_likely(&entries) { Estimate::Unknown } else { truncated::estimate(m, rtol) };
    if let Estimate::Dropped(answer) = estimate {
        return answer;
    }
    let exact = match regular {
        Some(matrix) => PseudoInverse { matrix, rank: 3 },
        None => undecided(&entries),
    };
    if matches!(estimate, Estimate::Kept) || truncated::keeps_all(m, rtol, &exact) {
        return exact;
    }
    truncated::truncated(m, rtol, exact, pseudo_inverse)
}

dispatched! {
    fn regular_inverse<FMA>(m) -> Option<DMat3> {
        regular::inverse::<FMA, false>(m)
    }
}

/// What `invert` makes of a finite matrix with entries far from 1, by one that is a power of two times it and about 1.
/// `None` for others, and where the scaling loses a bit of the matrix or might of the answer.
#[inline(always)]
fn rescaled(m: &DMat3, invert: impl FnOnce(DMat3) -> PseudoInverse) -> Option<PseudoInverse> {
    const ORDINARY: core::ops::Range<f64> = power_of_two(-90)..power_of_two(90);
    let largest =
        m.to_cols_array().into_iter().fold(0.0, |largest: f64, x| if x.abs() > largest { x.abs() } else { largest });
    if ORDINARY.contains(&largest) || largest == 0.0 {
        return None;
    }
    rescaled_by(m, -mantissa_and_exponent(largest).1, invert)
}

#[cold]
#[inline(never)]
fn rescaled_by(m: &DMat3, shift: i32, invert: impl FnOnce(DMat3) -> PseudoInverse) -> Option<PseudoInverse> {
    const SMALLEST: f64 = power_of_two(-100);
    let near_one = scale(*m, shift);
    let exact = |(x, y): (f64, f64)| x == 0.0 || y.abs() >= SMALLEST;
    if !m.to_cols_array().into_iter().zip(near_one.to_cols_array()).all(exact) {
        return None;
    }
    let PseudoInverse { matrix, rank } = invert(near_one);
    let answer = scale(matrix, shift);
    // The least normal double may have been rounded up to, and so twice.
    let certain = |(x, y): (f64, f64)| x == 0.0 || y.abs() > f64::MIN_POSITIVE;
    let mut pairs = matrix.to_cols_array().into_iter().zip(answer.to_cols_array());
    pairs.all(certain).then_some(PseudoInverse { matrix: answer, rank })
}

#[cfg(test)]
mod tests {
    use oracle::matrices::CLASSES;
    use oracle::{Random, cases};

    use super::*;

    /// Every stage decides, and what it decides is what the exact integers say, to the bit.
    #[test]
    fn stages_agree_and_each_one_decides() {
        let mut decided = [0; 5];
        for (name, class) in CLASSES {
            let mut random = Random::new(7);
            let mut of_class = [0; 5];
            for _ in 0..cases(100_000) / 10 {
                let m = class(&mut random);
                let entries = m.to_cols_array();
                let regular = |inverse: Option<DMat3>| inverse.map(|matrix| PseudoInverse { matrix, rank: 3 });
                let fused = [regular::inverse::<true, false>(&entries), regular::inverse::<true, true>(&entries)];
                let stages = [
                    regular(regular::inverse::<false, false>(&entries)),
                    whole::pseudo_inverse(&m),
                    regular(regular::inverse::<false, true>(&entries)),
                    fixed::pseudo_inverse(&m),
                    Some(integers::pseudo_inverse(&m)),
                ];
                let expected = bits(&stages[4].expect("integers always decide"));
                for answer in stages.iter().chain(&fused.map(regular)).flatten() {
                    assert_eq!(bits(answer), expected, "{name}: {entries:?}");
                }
                assert_eq!(bits(&pseudo_inverse(m)), expected, "{name}: {entries:?}");
                of_class[stages.iter().position(Option::is_some).expect("the last")] += 1;

                let sums = |sums: DVec3| sums.to_array().map(f64::to_bits);
                let expected = sums(integers::row_sums(&m));
                let stages = [
                    regular::row_sums::<false, false>(&entries),
                    regular::row_sums::<true, true>(&entries),
                    regular::row_sums::<false, true>(&entries),
                    whole::row_sums(&m),
                    fixed::row_sums(&m),
                    Some(pseudo_inverse_row_sums(m)),
                ];
                for answer in stages.into_iter().flatten() {
                    assert_eq!(sums(answer), expected, "{name}, row sums: {entries:?}");
                }
            }
            println!("{name:24} double-double, whole, triple, fixed, integers: {of_class:?}");
            decided.iter_mut().zip(of_class).for_each(|(sum, count)| *sum += count);
        }
        assert!(decided.iter().all(|&count| count > 500), "{decided:?}");
    }

    #[test]
    fn whole_numbers_of_every_rank_and_size_are_inverted() {
        let (mut random, mut decided, mut left) = (Random::new(8), [0; 4], 0);
        for _ in 0..cases(100_000) {
            let limit = 1 << random.integer(1..8);
            let mut column = || DVec3::from_array([(); 3].map(|()| random.whole(-limit, limit)));
            let (a, b, c) = (column(), column(), column());
            let (s, t) = (random.whole(-99, 99), random.whole(-99, 99));
            let last = [c, a * s + b * t, a * s][random.below(3)];
            let second = [b, a * t][random.below(2)];
            let m = DMat3::from_cols(a, second, last) * 2f64.powi(random.integer(-1070..900));
            match whole::pseudo_inverse(&m) {
                Some(answer) => {
                    assert_eq!(bits(&answer), bits(&integers::pseudo_inverse(&m)), "{m}");
                    decided[answer.rank] += 1;
                }
                None => left += 1,
            }
        }
        assert!(decided[1..].iter().all(|&count| count > 500) && left > 500, "{decided:?} {left}");
    }

    #[test]
    fn an_entry_just_below_the_least_normal_double_is_rounded_once() {
        let mut ties = 0;
        for k in 0..64 {
            // The first entry of the inverse is about 1 - (k / 64) 2^-52, times 2^-1022; the others are larger or zero.
            let (b, c) = (1.0 + 2f64.powi(-26), 1.0 + f64::from(128 - k) * 2f64.powi(-32));
            let a = b + c + 2.0 * f64::EPSILON;
            let m = DMat3::from_cols_array(&[a, b, 0.0, c, 1.0, 0.0, 0.0, 0.0, 0.5]) * 2f64.powi(1022);
            let expected = bits(&integers::pseudo_inverse(&m));
            assert_eq!(bits(&pseudo_inverse(m)), expected, "{m:?}");
            assert_eq!(pseudo_inverse_row_sums(m), integers::row_sums(&m), "{m:?}");
            ties += usize::from(expected.1[0] == f64::MIN_POSITIVE.to_bits());
        }
        assert!(0 < ties && ties < 64, "{ties}");
    }

    /// Entries of few bits each, but with fractions of those of others: polynomials in them need not fit a double.
    #[test]
    fn small_numbers_of_different_scales_are_left_or_inverted_exactly() {
        let (mut random, mut decided, mut left) = (Random::new(9), 0, 0);
        for _ in 0..cases(100_000) {
            let mut number = || random.whole(-2047, 2047) * 2f64.powi(random.integer(-6..1));
            let mut column = || DVec3::new(number(), number(), number());
            let (a, b) = (column(), column());
            let scale = 2f64.powi(if random.one_in(2) { 6 } else { 0 });
            let m = DMat3::from_cols(a.map(|x| (x * scale).trunc()), b, DVec3::ZERO);
            match whole::pseudo_inverse(&m) {
                Some(answer) => {
                    assert_eq!(bits(&answer), bits(&integers::pseudo_inverse(&m)), "{m}");
                    decided += 1;
                }
                None => left += 1,
            }
        }
        assert!(decided > 10 && left > 500, "{decided} {left}");
    }

    #[test]
    fn each_stage_decides_up_to_the_ends_of_its_range() {
        let m = DMat3::from_cols(DVec3::new(1.1, 1.2, 1.9), DVec3::new(1.3, 1.7, -1.1), DVec3::new(1.8, -1.4, 1.5));
        let inverse = |k: i32| regular::inverse::<false, false>(&(m * 2f64.powi(k)).to_cols_array()).is_some();
        assert_eq!([-103, -99, 98, 102].map(inverse), [false, true, true, false]);

        // Far from 1 a matrix is scaled, if no entry is far smaller than another.
        let rescales = |k: i32| rescaled(&(m * 2f64.powi(k)), pseudo_inverse).is_some();
        assert_eq!([-94, -88, 87, 93].map(rescales), [true, false, false, true]);
        let tiny = |k: i32| {
            let mut m = m * 2f64.powi(300);
            m.x_axis.y = 2f64.powi(300 - k);
            rescaled(&m, pseudo_inverse).is_some()
        };
        assert_eq!([97, 103].map(tiny), [true, false]);

        // Small whole numbers of any size, unless a quotient may be subnormal.
        let small = DMat3::from_cols(DVec3::new(3.0, 1.0, 0.0), DVec3::new(1.0, 5.0, 2.0), DVec3::new(0.0, 2.0, 7.0));
        let decides = |k: i32| whole::pseudo_inverse(&(small * 2f64.powi(k))).is_some();
        assert_eq!([-1074, 900, 912, 1010].map(decides), [true, true, false, false]);
        for k in 890..1020 {
            let m = small * 2f64.powi(k);
            assert_eq!(bits(&pseudo_inverse(m)), bits(&integers::pseudo_inverse(&m)), "{m}");
        }
    }

    fn bits(answer: &PseudoInverse) -> (usize, [u64; 9]) {
        (answer.rank, answer.matrix.to_cols_array().map(f64::to_bits))
    }

    #[test]
    fn ends_of_the_exponent_range_are_inverted() {
        for x in [f64::MAX, 1e200, 1.0, 1e-200, 1e-300] {
            let answer = pseudo_inverse(DMat3::from_diagonal(DVec3::splat(x)));
            assert_eq!(answer.rank, 3, "{x}");
            assert_eq!(answer.matrix, DMat3::from_diagonal(DVec3::splat(1.0 / x)), "{x}");
        }
    }
}
