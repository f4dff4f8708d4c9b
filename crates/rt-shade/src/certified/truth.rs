//! What the tests of this folder share: the ends of a ball as exact numbers, and references a little longer than it.

use oracle::{Big, exact, power_of_two};
use rt_math::exact::Ball;

/// Bits by which the references are longer.
const MORE: usize = 300;

/// Returns a number in the length of the references for balls of `LIMBS` limbs.
pub(super) fn long<const LIMBS: usize>(x: &Big) -> Big {
    x.clone().with_precision(64 * LIMBS + MORE).value()
}

/// Returns half a turn in this length.
pub(super) fn pi<const LIMBS: usize>() -> Big {
    Big::pi(64 * LIMBS + MORE)
}

/// Returns exact numbers between which the whole ball lies, hardly wider than it.
pub(super) fn big<const LIMBS: usize>(x: &Ball<LIMBS>) -> (Big, Big) {
    // The midpoint as a sum of doubles, each of which is taken away exactly.
    let (mut sum, mut rest) = (Big::ZERO, x.with_limbs::<40>());
    for _ in 0..=64 * LIMBS / 50 {
        if let Some(exponent) = rest.exponent().filter(|_| !rest.contains_zero()) {
            let lower = rest.scale(-exponent).ends().0;
            sum += exact(lower) * power_of_two(exponent);
            rest = rest - Ball::from_f64(lower).scale(exponent);
        }
    }
    // What is left may be below all doubles, or above.
    let scale = rest.abs().exponent().unwrap_or(0);
    let (lower, upper) = rest.scale(-scale).ends();
    let end = |x: f64| &sum + exact(x) * power_of_two(scale);
    (end(lower), end(upper))
}

/// Checks that a ball contains the truth, whose own error is 250 bits below the ball's last, and that it is not wider
/// than `width`.
pub(super) fn assert_encloses<const LIMBS: usize>(ball: &Ball<LIMBS>, truth: &Big, width: &Big) {
    let (lower, upper) = big(ball);
    let size = if *truth < Big::ZERO { -truth } else { truth.clone() };
    let slack = size * power_of_two(-250 - 64 * i32::try_from(LIMBS).expect("small"));
    assert!(
        &lower - &slack <= *truth && *truth <= &upper + &slack,
        "{ball:?} does not contain {}",
        truth.to_f64().value()
    );
    let found = upper - lower;
    assert!(found <= *width, "{ball:?} is {:e} wide, {:e} is enough", found.to_f64().value(), width.to_f64().value());
}

/// Returns `|truth| 2^(lost - 64 LIMBS)`: the width with this number of bits lost.
pub(super) fn but_for<const LIMBS: usize>(lost: i32, truth: &Big) -> Big {
    let size = if *truth < Big::ZERO { -truth } else { truth.clone() };
    size * power_of_two(lost - 64 * i32::try_from(LIMBS).expect("small"))
}
