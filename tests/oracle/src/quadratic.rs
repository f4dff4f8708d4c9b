//! The real roots of a quadratic equation with exact coefficients.

use std::cmp::Ordering;

use crate::{Big, exact, quotient, root, sign};

/// The equation `a x² + b x + c = 0`.
#[derive(Clone, Debug)]
pub struct Quadratic {
    /// Coefficient of `x²`.
    pub a: Big,
    /// Coefficient of `x`.
    pub b: Big,
    /// Constant.
    pub c: Big,
}

impl Quadratic {
    /// Returns `b² - 4 a c`.
    #[must_use]
    pub fn discriminant(&self) -> Big {
        &self.b * &self.b - exact(4.0) * &self.a * &self.c
    }

    /// Returns `a x² + b x + c`.
    #[must_use]
    pub fn value(&self, x: &Big) -> Big {
        (&self.a * x + &self.b) * x + &self.c
    }

    /// Returns the number of different real roots; `None`: every number is one.
    #[must_use]
    pub fn count(&self) -> Option<usize> {
        match [&self.a, &self.b, &self.c].map(sign) {
            [Ordering::Equal, Ordering::Equal, Ordering::Equal] => None,
            [Ordering::Equal, Ordering::Equal, _] => Some(0),
            [Ordering::Equal, ..] => Some(1),
            _ => Some(match sign(&self.discriminant()) {
                Ordering::Less => 0,
                Ordering::Equal => 1,
                Ordering::Greater => 2,
            }),
        }
    }

    /// Returns how the larger root, or else the smaller one, compares with `x`: the roots exist. No root is computed.
    #[must_use]
    pub fn compare(&self, larger: bool, x: &Big) -> Ordering {
        let value = sign(&self.value(x));
        match sign(&self.a) {
            // The root of a line is right of x where the line is below zero and rises, or above and falls.
            Ordering::Equal if sign(&self.b) == Ordering::Less => value,
            Ordering::Equal => value.reverse(),
            Ordering::Less => Self { a: -&self.a, b: -&self.b, c: -&self.c }.compare(larger, x),
            // The slope tells on which side of the vertex x is, and the value on which side of a root.
            Ordering::Greater => match (larger, sign(&(exact(2.0) * &self.a * x + &self.b))) {
                (false, Ordering::Greater) => Ordering::Less,
                (false, _) => value,
                (true, Ordering::Less) => Ordering::Greater,
                (true, _) => value.reverse(),
            },
        }
    }

    /// Returns the roots in 400 bits, which exist, in ascending order; `a` is not zero.
    ///
    /// None of them by a subtraction: `q = -(b ± √D)` with the sign of `b`, then `q / 2a` and `2c / q`.
    #[must_use]
    pub fn roots(&self) -> [Big; 2] {
        let (b, root) = (&self.b, root(&self.discriminant()));
        let q = if sign(b) == Ordering::Less { root - b } else { -(root + b) };
        let x = quotient(&q, &(exact(2.0) * &self.a));
        let y = if sign(&q) == Ordering::Equal { x.clone() } else { quotient(&(exact(2.0) * &self.c), &q) };
        if x < y { [x, y] } else { [y, x] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Random, is_rounding_of, rounded};

    fn equation(a: f64, b: f64, c: f64) -> Quadratic {
        let [a, b, c] = [a, b, c].map(exact);
        Quadratic { a, b, c }
    }

    #[test]
    fn known_roots_are_found() {
        assert_eq!(equation(1.0, -3.0, 2.0).roots().each_ref().map(rounded), [1.0, 2.0]);
        assert_eq!(equation(-1.0, 0.0, 4.0).roots().each_ref().map(rounded), [-2.0, 2.0]);
        let counts = [[0.0; 3], [0.0, 0.0, 1.0], [0.0, 2.0, 1.0], [1.0, 2.0, 1.0], [1.0, 2.0, 1.0 + f64::EPSILON]];
        assert_eq!(counts.map(|[a, b, c]| equation(a, b, c).count()), [None, Some(0), Some(1), Some(1), Some(0)]);
    }

    #[test]
    fn comparing_agrees_with_computing() {
        let mut random = Random::new(3);
        for _ in 0..1000 {
            let (equation, x) =
                (equation(random.uniform(), random.uniform(), random.uniform()), exact(random.uniform()));
            if equation.count() == Some(2) {
                for (larger, root) in [false, true].into_iter().zip(equation.roots()) {
                    assert_eq!(equation.compare(larger, &x), root.cmp(&x), "{equation:?}");
                    assert!(is_rounding_of(rounded(&root), |m| equation.compare(larger, m)), "{equation:?}");
                }
            }
        }
        for b in [2.0, -2.0] {
            let line = equation(0.0, b, -3.0 * b);
            assert_eq!(
                [2.0, 3.0, 4.0].map(|x| line.compare(false, &exact(x))),
                [Ordering::Greater, Ordering::Equal, Ordering::Less]
            );
        }
    }
}
