//! The formulas of this crate on numbers that are enclosed: every result is a ball that contains the exact one.
//!
//! A renderer that has computed a colour in doubles with a bound, and finds the bound too wide to tell its byte, asks
//! again here, with more and more limbs. Everything is generic over their number; the texture coordinates, the light
//! and the interpolation are those of real numbers, without a rounding anywhere. What even the longest numbers leave
//! open, as an exact tie, stays open in the answer.
//!
//! No function loops longer than its number of limbs says. `docs/numerics.md`, section 13, proves the remainders of the
//! series.
//!
//! ```
//! use rt_math::exact::Ball;
//! use rt_shade::certified;
//!
//! let normal = [3, 0, -3].map(Ball::<4>::from_integer);
//! let [u, v] = certified::texture_uv(&normal, true);
//! assert_eq!([u.ends(), v.ends()], [(0.375, 0.375), (0.5, 0.5)]);
//! ```

mod arctangent;
mod phong;
mod power;
mod texture;

pub use arctangent::{half_turns, texture_uv};
pub use phong::phong;
pub use power::power;
pub use texture::{bilinear, nearest};

use rt_math::exact::Ball;

/// The limbs of the constants, one more than those of the longest numbers.
const LONGEST: usize = 33;

/// Half-angle steps before a series: those for which the steps and the terms together cost the least.
const fn halvings(limbs: usize) -> usize {
    4 + limbs.isqrt()
}

/// Returns the inverse function of the tangent, or if `HYPERBOLIC` that of the hyperbolic tangent, for `|t|` below 2,
/// or below 1/2.
///
/// Half-angle steps bring `t` below `2^(1 - steps)`; there the series `t ± t³/3 + t⁵/5 ± ...` is left after a fixed
/// number of terms. The error is relative to the result, however small.
fn inverse_tangent<const HYPERBOLIC: bool, const LIMBS: usize>(t: &Ball<LIMBS>) -> Ball<LIMBS> {
    let signed = |x: Ball<LIMBS>| if HYPERBOLIC { x } else { -x };
    let steps = const { halvings(LIMBS) };
    let terms = const { (64 * LIMBS).div_ceil(2 * (halvings(LIMBS) - 1)) };
    let mut t = *t;
    for _ in 0..steps {
        // tan(a/2) = tan a / (1 + √(1 + tan² a)), and with 1 - tanh² for the hyperbolic tangent
        t = t / (Ball::ONE + (Ball::ONE - signed(t.square())).sqrt());
    }
    let square = signed(t.square());
    let mut sum = Ball::ZERO;
    for term in (0..terms as i64).rev() {
        sum = Ball::ONE / Ball::from_integer(2 * term + 1) + square * sum;
    }
    // The rest of the series is below |t|^(2 terms + 1), at most |t| 2^(-64 LIMBS).
    let rest = t.scale(-bits::<LIMBS>());
    (t * sum).widen(&rest).scale(i32::try_from(steps).expect("a few"))
}

/// Returns the same function of `1 / n`, for `n >= 4`, with constants' limbs.
fn inverse_tangent_of_inverse<const HYPERBOLIC: bool>(n: i64) -> Ball<LONGEST> {
    // n² is at least 2^4.
    const TERMS: i64 = 64 * LONGEST as i64 / 4;
    let signed = |x: Ball<LONGEST>| if HYPERBOLIC { x } else { -x };
    let square = Ball::from_integer(n * n);
    let mut sum = Ball::ZERO;
    for term in (0..TERMS).rev() {
        sum = Ball::ONE / Ball::from_integer(2 * term + 1) + signed(sum / square);
    }
    sum.widen(&Ball::ONE.scale(-bits::<LONGEST>())) / Ball::from_integer(n)
}

/// The bits of a number.
const fn bits<const LIMBS: usize>() -> i32 {
    const { assert!(0 < LIMBS && LIMBS < 1 << 20) };
    #[expect(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "checked above")]
    let bits = 64 * LIMBS as i32;
    bits
}

/// Returns a constant in the length asked for, at most one limb less than its own.
fn constant<const LIMBS: usize>(value: &Ball<LONGEST>) -> Ball<LIMBS> {
    const { assert!(LIMBS < LONGEST) };
    value.with_limbs()
}

#[cfg(test)]
mod truth;
