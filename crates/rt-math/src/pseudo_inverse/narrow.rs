//! Matrices whose entries are integers of at most 62 bits times a common power of two: exact in 128 and 256 bits.
//!
//! That holds for doubles of like magnitude, and for small whole numbers: the usual singular or nearly singular
//! matrix. The polynomials of [`integers`](super::integers) are computed exactly in registers here, and only the quotients
//! are rounded, in double-double. For rank 2 the same numerator is written with `G`, the dot products of the columns:
//! row 0 of the pseudo-inverse is `(a_0 (G_11 + G_22) - a_1 G_01 - a_2 G_02) / (sum of the 2 x 2 principal minors of G)`.

use glam::DMat3;

use super::{PseudoInverse, graded::shifted, power_of_two, regular::Reciprocal};

/// The exact rank and the correctly rounded pseudo-inverse of a finite matrix, if it is of this kind, no entry of the
/// answer is subnormal, and double-double is enough to round every entry.
#[cold]
#[inline(never)]
pub(super) fn pseudo_inverse(m: &DMat3) -> Option<PseudoInverse> {
    let (a, exponent) = integers(m)?;
    let product = |x: i64, y: i64| i128::from(x) * i128::from(y);
    // Below 2^125, since entries are below 2^62.
    let cross = |x: [i64; 3], y: [i64; 3]| {
        [(1, 2), (2, 0), (0, 1)].map(|(i, j)| product(x[i], y[j]) - product(x[j], y[i]))
    };
    let cofactors = [cross(a[1], a[2]), cross(a[2], a[0]), cross(a[0], a[1])];
    let determinant = Wide::dot(a[0], cofactors[0]);
    if !determinant.is_zero() {
        let matrix = divided(&cofactors.map(|row| row.map(Wide::from)), &determinant, exponent)?;
        return Some(PseudoInverse { matrix, rank: 3 });
    }
    // Below 2^126.
    let dot = |i: usize, j: usize| {
        product(a[i][0], a[j][0]) + product(a[i][1], a[j][1]) + product(a[i][2], a[j][2])
    };
    let [g00, g11, g22] = [dot(0, 0), dot(1, 1), dot(2, 2)];
    if cofactors == [[0; 3]; 3] {
        if a == [[0; 3]; 3] {
            return Some(PseudoInverse { matrix: DMat3::ZERO, rank: 0 });
        }
        let squares = Wide::from(g00) + Wide::from(g11) + Wide::from(g22);
        let matrix = divided(&a.map(|row| row.map(|x| Wide::from(i128::from(x)))), &squares, exponent)?;
        return Some(PseudoInverse { matrix, rank: 1 });
    }
    let [g12, g20, g01] = [dot(1, 2), dot(2, 0), dot(0, 1)];
    let row = |i: usize, j: usize, k: usize, jj_kk: i128, ij: i128, ik: i128| {
        [0, 1, 2].map(|n| Wide::dot([a[i][n], a[j][n], a[k][n]], [jj_kk, -ij, -ik]))
    };
    let rows = [
        row(0, 1, 2, g11 + g22, g01, g20),
        row(1, 2, 0, g22 + g00, g12, g01),
        row(2, 0, 1, g00 + g11, g20, g12),
    ];
    // Each product below 2^252.
    let minor = |ii, jj, ij: i128| Wide::product(ii, jj) + Wide::product(-ij, ij);
    let minors = minor(g00, g11, g01) + minor(g11, g22, g12) + minor(g22, g00, g20);
    Some(PseudoInverse { matrix: divided(&rows, &minors, exponent)?, rank: 2 })
}

/// The columns of the matrix as integers below 2^62 in magnitude, and the exponent of their common power of two.
fn integers(m: &DMat3) -> Option<([[i64; 3]; 3], i32)> {
    let parts = m.to_cols_array_2d().map(|column| column.map(decode));
    let exponent =
        parts.as_flattened().iter().filter(|part| part.0 != 0).map(|part| part.1).min().unwrap_or(0);
    let mut fits = true;
    let columns = parts.map(|column| {
        column.map(|(significand, e)| {
            let shift = if significand == 0 { 0 } else { e - exponent };
            fits &= significand.unsigned_abs().leading_zeros().cast_signed() >= 2 + shift;
            significand << (shift & 63)
        })
    });
    fits.then_some((columns, exponent))
}

/// A double as an odd integer, or zero, times a power of two.
fn decode(x: f64) -> (i64, i32) {
    let bits = x.to_bits().cast_signed();
    let (biased, fraction) = ((bits >> 52 & 0x7ff) as i32, bits & ((1 << 52) - 1));
    let significand = if biased == 0 { fraction } else { fraction | 1 << 52 };
    if significand == 0 {
        return (0, 0);
    }
    let zeros = significand.trailing_zeros();
    let odd = significand >> zeros;
    (if bits < 0 { -odd } else { odd }, biased.max(1) - 1075 + zeros.cast_signed())
}

/// The matrix of the given rows over `denominator`, times `2^-exponent`.
fn divided(rows: &[[Wide; 3]; 3], denominator: &Wide, exponent: i32) -> Option<DMat3> {
    let (s, low) = denominator.leading();
    // The two doubles hold all but 2 u^2 of a number.
    const CUT: f64 = 2.0 * f64::EPSILON * f64::EPSILON / 4.0;
    let reciprocal = Reciprocal::<false>::new(s, low, CUT * s.abs())?;
    let mut inverse = DMat3::ZERO;
    for (i, row) in rows.iter().enumerate() {
        for (j, numerator) in row.iter().enumerate() {
            let (h, l) = numerator.leading();
            let (lower, upper) = reciprocal.times(h, l, l.abs() + f64::EPSILON * h.abs());
            if lower != upper {
                return None;
            }
            inverse.col_mut(j)[i] = shifted(upper, -exponent)?;
        }
    }
    Some(inverse)
}

/// An integer of 256 bits: `high 2^128 + low`.
#[derive(Clone, Copy)]
struct Wide {
    high: i128,
    low: u128,
}

impl Wide {
    fn product(x: i128, y: i128) -> Self {
        let (low, high) = x.unsigned_abs().carrying_mul(y.unsigned_abs(), 0);
        let magnitude = Self { high: high.cast_signed(), low };
        if (x < 0) == (y < 0) { magnitude } else { magnitude.negated() }
    }

    fn dot(x: [i64; 3], y: [i128; 3]) -> Self {
        let product = |i: usize| Self::product(x[i].into(), y[i]);
        product(0) + product(1) + product(2)
    }

    fn negated(self) -> Self {
        let (low, borrow) = 0u128.overflowing_sub(self.low);
        Self { high: -self.high - i128::from(borrow), low }
    }

    fn is_zero(self) -> bool {
        self.high == 0 && self.low == 0
    }

    /// Two doubles `h + l` within `2 u^2 |h|` of the number, with `|l| < 2 u |h|`.
    fn leading(self) -> (f64, f64) {
        let magnitude = if self.high < 0 { self.negated() } else { self };
        let (high, low) = (magnitude.high.cast_unsigned(), magnitude.low);
        // The leading 128 bits, the first of them set unless the number is zero.
        let (bits, shift) = match (high, low) {
            (0, 0) => return (0.0, 0.0),
            (0, _) => (low << low.leading_zeros(), 0 - low.leading_zeros().cast_signed()),
            _ => {
                let shift = high.leading_zeros(); // at least 1, for the sign
                (high << shift | low >> (128 - shift), 128 - shift.cast_signed())
            }
        };
        // 53 of them, exactly, and the other 75.
        let (first, second) = (bits >> 75, bits & ((1 << 75) - 1));
        let unit = if self.high < 0 { -power_of_two(shift) } else { power_of_two(shift) };
        #[expect(clippy::cast_precision_loss, reason = "53 bits, and 75 of which the first 53 count")]
        let (first, second) = (first as f64, second as f64);
        (first * power_of_two(75) * unit, second * unit)
    }
}

impl From<i128> for Wide {
    fn from(x: i128) -> Self {
        Self { high: x >> 127, low: x.cast_unsigned() }
    }
}

impl core::ops::Add for Wide {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (low, carry) = self.low.overflowing_add(other.low);
        Self { high: self.high + other.high + i128::from(carry), low }
    }
}
