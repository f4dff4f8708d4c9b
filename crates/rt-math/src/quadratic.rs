//! Real roots of a quadratic.

use core::cmp::Ordering;

use crate::exact::Dyadic;

/// The real solutions of an equation, each distinct one once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Roots {
    /// No real number solves it.
    None,
    /// One number solves it: a double root, or the root of a linear equation.
    One(f64),
    /// Two numbers solve it, in ascending order.
    Two(f64, f64),
    /// Every number solves it: all coefficients are zero.
    All,
}

/// Returns the real roots of `a x² + b x + c`, in ascending order.
///
/// With `a == 0` the equation is linear; `a == b == 0` has no root, or `Roots::All` when `c == 0` too. A double root is
/// returned once. The number of roots is exact and each root is correctly rounded, for all finite coefficients:
/// two distinct roots may round to the same double, a root beyond the range of doubles is infinite, one that underflows
/// is a zero with the root's sign, and a root that is exactly zero is +0.0. With a coefficient that is infinite or NaN
/// the answer is `Roots::None`.
///
/// ```
/// use rt_math::{Roots, solve_quadratic};
///
/// assert_eq!(solve_quadratic(1.0, -3.0, 2.0), Roots::Two(1.0, 2.0));
/// assert_eq!(solve_quadratic(1.0, -2.0, 1.0), Roots::One(1.0));
/// assert_eq!(solve_quadratic(1e300, 0.0, 1e300), Roots::None);
/// ```
#[must_use]
pub fn solve_quadratic(a: f64, b: f64, c: f64) -> Roots {
    if !(a.is_finite() && b.is_finite() && c.is_finite()) {
        return Roots::None;
    }
    match (a == 0.0, b == 0.0, c == 0.0) {
        (true, true, true) => Roots::All,
        (true, true, false) => Roots::None,
        (true, false, _) => Roots::One(negated_quotient(c, b)),
        (false, true, true) => Roots::One(0.0),
        (false, false, true) => {
            let other = negated_quotient(b, a);
            if other.is_sign_negative() { Roots::Two(other, 0.0) } else { Roots::Two(0.0, other) }
        }
        (false, _, false) => integers(a, b, c),
    }
}

/// `-n / d`, correctly rounded; an exact zero is +0.0.
fn negated_quotient(n: f64, d: f64) -> f64 {
    if n == 0.0 { 0.0 } else { -n / d }
}

#[cold]
#[inline(never)]
fn integers(a: f64, b: f64, c: f64) -> Roots {
    type Number = Dyadic<104>;
    let [a, b, c] = [a, b, c].map(Number::from_f64);
    let discriminant = b.square() - (&a * &c).scale(2);
    let (minus_b, two_a) = (-b, &a + &a);
    let root = |minus| Number::root(&minus_b, minus, &discriminant, &two_a);
    match discriminant.sign() {
        Ordering::Less => Roots::None,
        Ordering::Equal => Roots::One(Number::quotient(&minus_b, &two_a)),
        Ordering::Greater if a.sign() == Ordering::Less => Roots::Two(root(false), root(true)),
        Ordering::Greater => Roots::Two(root(true), root(false)),
    }
}
