//! The pseudo-inverse of a 3 x 3 matrix, and the four conditions of Penrose, which define it.

use std::cmp::Ordering;

use dashu::base::Abs;

use crate::{Big, Vector, cross, dot, exact, is_rounded_quotient, power_of_two, quotient, sign, vector};

/// A matrix of exact numbers, by columns.
pub type Matrix = [Vector; 3];

/// Returns the exact matrix of finite doubles, listed by columns.
#[must_use]
pub fn matrix(entries: &[f64; 9]) -> Matrix {
    [0, 3, 6].map(|from| vector([entries[from], entries[from + 1], entries[from + 2]]))
}

/// A pseudo-inverse: `numerators / denominator`.
#[derive(Clone, Debug)]
pub struct PseudoInverse {
    /// The rank of the matrix.
    pub rank: usize,
    /// By columns.
    pub numerators: Matrix,
    /// Not zero.
    pub denominator: Big,
}

impl PseudoInverse {
    /// Finds it by the formula for its rank.
    #[must_use]
    pub fn new(columns: &Matrix) -> Self {
        let [a, b, c] = columns;
        let minors = [cross(b, c), cross(c, a), cross(a, b)];
        let determinant = dot(a, &minors[0]);
        // Frobenius norms, squared, of the matrix and of its minors: the first two symmetric functions of σ².
        let squares = |rows: &Matrix| rows.iter().map(|row| dot(row, row)).fold(Big::ZERO, |sum, x| sum + x);
        let (s1, s2) = (squares(columns), squares(&minors));
        let is_zero = |x: &Big| sign(x) == Ordering::Equal;
        if !is_zero(&determinant) {
            Self { rank: 3, numerators: transpose(&minors), denominator: determinant }
        } else if !is_zero(&s2) {
            // A⁺ = (s1 Aᵀ - Aᵀ A Aᵀ) / s2
            let transposed = transpose(columns);
            let cube = product(&product(&transposed, columns), &transposed);
            Self { rank: 2, numerators: zip(&transposed, &cube, |x, y| &s1 * x - y), denominator: s2 }
        } else if !is_zero(&s1) {
            Self { rank: 1, numerators: transpose(columns), denominator: s1 }
        } else {
            Self { rank: 0, numerators: columns.clone(), denominator: exact(1.0) }
        }
    }

    /// Returns an entry in 400 bits.
    #[must_use]
    pub fn entry(&self, row: usize, column: usize) -> Big {
        quotient(&self.numerators[column][row], &self.denominator)
    }

    /// Returns the numerator of the sum of a row.
    #[must_use]
    pub fn row_sum(&self, row: usize) -> Big {
        let [a, b, c] = &self.numerators;
        &a[row] + &b[row] + &c[row]
    }

    /// Whether each of these entries, listed by columns, is correctly rounded.
    #[must_use]
    pub fn rounds_to(&self, entries: &[f64; 9]) -> bool {
        entries.iter().zip(self.numerators.iter().flatten()).all(|(&x, n)| is_rounded_quotient(x, n, &self.denominator))
    }

    /// Asserts the four conditions, without any rounding.
    pub fn assert_penrose(&self, a: &Matrix) {
        let (x, times_denominator) =
            (&self.numerators, |m: &Matrix| m.each_ref().map(|v| v.each_ref().map(|x| x * &self.denominator)));
        let (ax, xa) = (product(a, x), product(x, a));
        assert_eq!(product(&ax, a), times_denominator(a), "A X A = A for {a:?}");
        assert_eq!(product(&xa, x), times_denominator(x), "X A X = X for {a:?}");
        assert_eq!(ax, transpose(&ax), "A X is symmetric for {a:?}");
        assert_eq!(xa, transpose(&xa), "X A is symmetric for {a:?}");
    }
}

/// Asserts the four conditions for `x`, each entry of which is the rounding of that of the pseudo-inverse of `a`.
///
/// With `X = A+ + E`, where `|E| <= u |X| + 2^-1075` entry by entry, the residuals are `A X A - A = A E A`,
/// `A X - (A X)^T = A E - (A E)^T`, `X A X - X = E A A+ + A+ A E + E A E - E`, and `X A` alike; the absolute values of
/// their terms are the bounds. All in exact arithmetic.
pub fn assert_penrose_within_rounding(a: &Matrix, x: &Matrix) {
    let absolute = |m: &Matrix| m.each_ref().map(|v| v.each_ref().map(|x| x.clone().abs()));
    let sum = |a: &Matrix, b: &Matrix| zip(a, b, |x, y| x + y);
    let error = absolute(x).map(|v| v.map(|x| x * power_of_two(-53) + power_of_two(-1075)));
    let (a_size, x_size) = (absolute(a), sum(&absolute(x), &error));
    let (ax, xa, a_error, error_a) = (product(a, x), product(x, a), product(&a_size, &error), product(&error, &a_size));
    let assert_near = |found: &Matrix, expected: &Matrix, bound: &Matrix, condition: &str| {
        let off = absolute(&zip(found, expected, |x, y| x - y));
        assert!(
            off.iter().flatten().zip(bound.iter().flatten()).all(|(off, bound)| off <= bound),
            "{condition} for {a:?}"
        );
    };
    assert_near(&product(&ax, a), a, &product(&a_error, &a_size), "A X A = A");
    let first = sum(&product(&error_a, &x_size), &product(&product(&x_size, &a_size), &error));
    let bound = sum(&sum(&first, &product(&error_a, &error)), &error);
    assert_near(&product(&xa, x), x, &bound, "X A X = X");
    assert_near(&ax, &transpose(&ax), &sum(&a_error, &transpose(&a_error)), "A X is symmetric");
    assert_near(&xa, &transpose(&xa), &sum(&error_a, &transpose(&error_a)), "X A is symmetric");
}

fn transpose(m: &Matrix) -> Matrix {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| m[j][i].clone()))
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let rows = transpose(a);
    [0, 1, 2].map(|j| [0, 1, 2].map(|i| dot(&rows[i], &b[j])))
}

fn zip(a: &Matrix, b: &Matrix, of: impl Fn(&Big, &Big) -> Big) -> Matrix {
    [0, 1, 2].map(|j| [0, 1, 2].map(|i| of(&a[j][i], &b[j][i])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matrices::CLASSES;
    use crate::{Random, rounded};

    #[test]
    fn a_diagonal_is_inverted_where_it_is_not_zero() {
        let inverse = PseudoInverse::new(&matrix(&[2.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 0.0]));
        assert_eq!((inverse.rank, rounded(&inverse.entry(0, 0)), rounded(&inverse.entry(1, 1))), (2, 0.5, 0.25));
        assert!(inverse.rounds_to(&[0.5, 0.0, 0.0, 0.0, 0.25, 0.0, 0.0, 0.0, 0.0]));
        assert_eq!(inverse.row_sum(1), &inverse.denominator * exact(0.25));
    }

    /// A thousand matrices of each class; 25,000 with `RT_LONG`.
    #[test]
    fn it_meets_the_penrose_conditions_exactly() {
        let mut ranks = [0; 4];
        for (_, class) in CLASSES {
            let mut random = Random::new(1);
            for _ in 0..crate::cases(250_000) / 10 {
                let m = matrix(&class(&mut random).to_cols_array());
                let inverse = PseudoInverse::new(&m);
                inverse.assert_penrose(&m);
                ranks[inverse.rank] += 1;
            }
        }
        assert!(ranks.iter().all(|&count| count >= 1000), "{ranks:?}");
    }
}
