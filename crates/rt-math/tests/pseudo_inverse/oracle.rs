//! The pseudo-inverse in exact arithmetic on heap integers: slow, obvious, and certified by the Penrose conditions.

use dashu::base::{Abs, BitTest, DivRem, Sign, UnsignedAbs};
use dashu::integer::{IBig, UBig};
use glam::DMat3;

/// Matrix of integers, `[row][column]`, up to 3 x 3.
type Integers = Vec<Vec<IBig>>;

/// The exact pseudo-inverse `numerator / denominator * 2^exponent` of a matrix of doubles.
pub(crate) struct Exact {
    pub(crate) rank: usize,
    numerator: Integers,
    denominator: IBig,
    exponent: i64,
}

/// Returns the exact pseudo-inverse.
///
/// With `F` a maximal set of independent columns of `A` and `R` of independent rows,
/// `A+ = R^T (F^T A R^T)^-1 F^T` (the formula of C. C. `MacDuffee`); for a regular `A` this is the inverse itself.
pub(crate) fn pseudo_inverse(m: &DMat3) -> Exact {
    let (a, exponent) = integers(m);
    let (rows, columns) = independent(&a);
    let rank = rows.len();
    let (numerator, denominator) = match rank {
        0 => (vec![vec![IBig::ZERO; 3]; 3], IBig::ONE),
        3 => (adjugate(&a), determinant(&a)),
        _ => {
            let f = transpose(&columns.iter().map(|&j| transpose(&a)[j].clone()).collect::<Vec<_>>());
            let r: Integers = rows.iter().map(|&i| a[i].clone()).collect();
            let core = product(&product(&transpose(&f), &a), &transpose(&r));
            (product(&product(&transpose(&r), &adjugate(&core)), &transpose(&f)), determinant(&core))
        }
    };
    Exact { rank, numerator, denominator, exponent: -exponent }
}

impl Exact {
    /// The entry in row `i` and column `j`, rounded to the nearest double, ties to even; an exact zero is +0.0.
    pub(crate) fn rounded(&self, i: usize, j: usize) -> f64 {
        quotient(&self.numerator[i][j], &self.denominator, self.exponent)
    }

    /// The sum of row `i`, rounded likewise.
    pub(crate) fn rounded_row_sum(&self, i: usize) -> f64 {
        let sum = self.numerator[i].iter().fold(IBig::ZERO, |sum, entry| sum + entry);
        quotient(&sum, &self.denominator, self.exponent)
    }

    /// Asserts the four conditions that define the pseudo-inverse, without any rounding.
    pub(crate) fn assert_penrose(&self, m: &DMat3) {
        let (a, _) = integers(m);
        let (x, d) = (&self.numerator, &self.denominator);
        let (ax, xa) = (product(&a, x), product(x, &a));
        assert!(!d.is_zero(), "denominator of {m}");
        assert_eq!(product(&ax, &a), scaled(&a, d), "A X A = A for {m}");
        assert_eq!(product(&xa, x), scaled(x, d), "X A X = X for {m}");
        assert_eq!(ax, transpose(&ax), "A X is symmetric for {m}");
        assert_eq!(xa, transpose(&xa), "X A is symmetric for {m}");
    }
}

/// The matrix as integers times one power of two, whose exponent comes second.
fn integers(m: &DMat3) -> (Integers, i64) {
    let parts = m.transpose().to_cols_array().map(decode);
    let exponent = parts.iter().filter(|part| part.0 != 0).map(|part| part.1).min().unwrap_or(0);
    let entry = |k: usize| {
        let (mantissa, e) = parts[k];
        if mantissa == 0 { IBig::ZERO } else { IBig::from(mantissa) << usize::try_from(e - exponent).unwrap() }
    };
    ((0..3).map(|i| (0..3).map(|j| entry(3 * i + j)).collect()).collect(), exponent)
}

/// `x` as an integer times a power of two.
fn decode(x: f64) -> (i64, i64) {
    let bits = x.to_bits();
    let (biased, fraction) = (i64::try_from(bits >> 52 & 0x7ff).unwrap(), i64::try_from(bits << 12 >> 12).unwrap());
    let magnitude = if biased == 0 { fraction } else { fraction | 1 << 52 };
    (if x < 0.0 { -magnitude } else { magnitude }, biased.max(1) - 1075)
}

/// Row and column numbers of a largest submatrix with a determinant that is not zero.
fn independent(a: &Integers) -> (Vec<usize>, Vec<usize>) {
    if !determinant(a).is_zero() {
        return (vec![0, 1, 2], vec![0, 1, 2]);
    }
    let pairs = [[0, 1], [0, 2], [1, 2]];
    for [i, k] in pairs {
        for [j, l] in pairs {
            if &a[i][j] * &a[k][l] != &a[i][l] * &a[k][j] {
                return (vec![i, k], vec![j, l]);
            }
        }
    }
    let nonzero = (0..9).find(|k| !a[k / 3][k % 3].is_zero());
    nonzero.map_or((vec![], vec![]), |k| (vec![k / 3], vec![k % 3]))
}

fn determinant(a: &Integers) -> IBig {
    match a.len() {
        1 => a[0][0].clone(),
        2 => &a[0][0] * &a[1][1] - &a[0][1] * &a[1][0],
        _ => (0..3).map(|j| &a[0][j] * cofactor(a, 0, j)).sum(),
    }
}

fn adjugate(a: &Integers) -> Integers {
    let n = a.len();
    (0..n).map(|i| (0..n).map(|j| cofactor(a, j, i)).collect()).collect()
}

/// The signed determinant of `a` without row `i` and column `j`.
fn cofactor(a: &Integers, i: usize, j: usize) -> IBig {
    if a.len() == 1 {
        return IBig::ONE;
    }
    let without = |skip: usize| (0..a.len()).filter(move |&k| k != skip);
    let minor: Integers = without(i).map(|row| without(j).map(|column| a[row][column].clone()).collect()).collect();
    if (i + j).is_multiple_of(2) { determinant(&minor) } else { -determinant(&minor) }
}

fn transpose(a: &Integers) -> Integers {
    (0..a[0].len()).map(|j| a.iter().map(|row| row[j].clone()).collect()).collect()
}

fn product(a: &Integers, b: &Integers) -> Integers {
    let entry = |row: &Vec<IBig>, j: usize| row.iter().zip(b).map(|(x, y)| x * &y[j]).sum();
    a.iter().map(|row| (0..b[0].len()).map(|j| entry(row, j)).collect()).collect()
}

fn scaled(a: &Integers, factor: &IBig) -> Integers {
    a.iter().map(|row| row.iter().map(|x| x * factor).collect()).collect()
}

/// The double nearest to `n / d * 2^exponent`, ties to even.
fn quotient(n: &IBig, d: &IBig, exponent: i64) -> f64 {
    if n.is_zero() {
        return 0.0;
    }
    let sign = if (n.sign() == Sign::Negative) == (d.sign() == Sign::Negative) { 1.0 } else { -1.0 };
    let (n, d) = (n.unsigned_abs(), d.unsigned_abs());
    // A quotient of 60 bits or more in units of 2^unit, but no unit far below the smallest subnormal, 2^-1074.
    let length = i64::try_from(n.bit_len()).unwrap() - i64::try_from(d.bit_len()).unwrap();
    let unit = (length + exponent - 61).max(-1080);
    let shift = exponent - unit;
    let positive = |x: i64| usize::try_from(x.max(0)).unwrap();
    let (whole, rest) = (n << positive(shift)).div_rem(d << positive(-shift));
    // In units of half of that, with the last bit set if anything is left: enough for every rounding decision.
    let digits = u128::try_from(whole).unwrap() << 1 | u128::from(rest != UBig::ZERO);
    let lowest = (unit - 1 + i64::from(128 - digits.leading_zeros()) - 53).max(-1074);
    let dropped = u32::try_from(lowest - (unit - 1)).unwrap();
    let (kept, tail, half) = (digits >> dropped, digits & ((1 << dropped) - 1), 1 << (dropped - 1));
    let mantissa = kept + u128::from(tail > half || (tail == half && kept & 1 == 1));
    // Exact, or infinite: the power of two is capped where every mantissa overflows.
    sign * mantissa as f64 * power_of_two(lowest.min(1000))
}

/// `2^n` for `n` in -1074..=1023.
fn power_of_two(n: i64) -> f64 {
    if n < -1022 { f64::from_bits(1 << (n + 1074)) } else { f64::from_bits(u64::try_from(n + 1023).unwrap() << 52) }
}

/// Asserts the four Penrose conditions for `x`, each entry of which is the rounding of that of the pseudo-inverse.
///
/// With `X = A+ + E`, where `|E| <= u |X| + 2^-1075` entry by entry, the residuals are `A X A - A = A E A`,
/// `X A X - X = E A A+ + A+ A E + E A E - E`, `A X - (A X)^T = A E - (A E)^T`, and `X A` alike; the absolute values of
/// their terms are the bounds. All in exact arithmetic.
pub(crate) fn assert_penrose_within_rounding(m: &DMat3, x: &DMat3) {
    let ((a, a_unit), (x, x_unit)) = (integers(m), integers(x));
    // X and E in units that hold 2^-53 |X| and 2^-1075.
    let unit = (x_unit - 53).min(-1075);
    let shifted = |x: &Integers, by: i64| scaled(x, &(IBig::ONE << usize::try_from(by).unwrap()));
    let error = shifted(&absolute(&x), x_unit - unit - 53);
    let smallest = IBig::ONE << usize::try_from(-1075 - unit).unwrap();
    let error: Integers = error.iter().map(|row| row.iter().map(|e| e + &smallest).collect()).collect();
    let x = shifted(&x, x_unit - unit);

    let (a_size, x_size) = (absolute(&a), sum(&absolute(&x), &error));
    let (ax, xa, a_error, error_a) =
        (product(&a, &x), product(&x, &a), product(&a_size, &error), product(&error, &a_size));
    let assert_near = |found: &Integers, expected: &Integers, bound: &Integers, condition: &str| {
        for k in 0..9 {
            let (i, j) = (k / 3, k % 3);
            assert!((&found[i][j] - &expected[i][j]).abs() <= bound[i][j], "{condition} for {m}");
        }
    };
    assert_near(&product(&ax, &a), &shifted(&a, -a_unit - unit), &product(&a_error, &a_size), "A X A = A");
    let first = sum(&product(&error_a, &x_size), &product(&product(&x_size, &a_size), &error));
    let bound = sum(&sum(&first, &product(&error_a, &error)), &shifted(&error, -a_unit - unit));
    assert_near(&product(&xa, &x), &shifted(&x, -a_unit - unit), &bound, "X A X = X");
    assert_near(&ax, &transpose(&ax), &sum(&a_error, &transpose(&a_error)), "A X is symmetric");
    assert_near(&xa, &transpose(&xa), &sum(&error_a, &transpose(&error_a)), "X A is symmetric");
}

fn sum(a: &Integers, b: &Integers) -> Integers {
    a.iter().zip(b).map(|(x, y)| x.iter().zip(y).map(|(x, y)| x + y).collect()).collect()
}

fn absolute(a: &Integers) -> Integers {
    a.iter().map(|row| row.iter().map(|x| x.clone().abs()).collect()).collect()
}

#[test]
fn quotients_are_rounded_as_the_hardware_does() {
    let integer = |x: i64| IBig::from(x);
    for (n, d) in [(1, 3), (-1, 3), (2, 3), (1, -10), ((1 << 53) + 1, 1), ((1 << 53) + 3, 1), (i64::MAX, 7), (5, 4)] {
        assert_eq!(quotient(&integer(n), &integer(d), 0), n as f64 / d as f64, "{n} / {d}");
    }
    // Around half of the smallest subnormal, and around the midpoint between the largest double and 2^1024.
    assert_eq!(quotient(&integer(1), &integer(1), -1075).to_bits(), 0);
    assert_eq!(quotient(&integer(-1), &integer(1), -1076).to_bits(), (-0.0f64).to_bits());
    assert_eq!(quotient(&integer(3), &integer(1), -1075), f64::from_bits(2));
    assert_eq!(quotient(&integer(5), &integer(1), -1075), f64::from_bits(2));
    assert_eq!(quotient(&integer(1 << 60 | 1), &integer(1), -1135), f64::from_bits(1));
    assert_eq!(quotient(&integer((1 << 54) - 1), &integer(1), 970), f64::INFINITY);
    assert_eq!(quotient(&integer((1 << 55) - 3), &integer(1), 969), f64::MAX);
    assert_eq!(quotient(&integer(-1), &integer(1), 5000), f64::NEG_INFINITY);
}
