//! Regular matrices with rows and columns of very different size: brought to like size by powers of two, then inverted.
//!
//! With `D` and `E` diagonal, the inverse of `D A E` is `E^-1 A^-1 D^-1`. This holds for regular matrices only: a
//! pseudo-inverse does not follow a scaling of rows and columns.

use glam::DMat3;

use super::{fixed, power_of_two, regular};

/// The correctly rounded inverse of a finite matrix, if one of the first two stages can find it for the scaled matrix,
/// and neither that nor the answer has a subnormal entry.
#[cold]
#[inline(never)]
pub(super) fn inverse(m: &DMat3) -> Option<DMat3> {
    let entries = m.to_cols_array();
    // First the rows are scaled to a largest entry of exponent 0, then the columns.
    let exponents = entries.map(exponent);
    let mut rows = [ZERO; 3];
    for (k, e) in exponents.iter().enumerate() {
        rows[k % 3] = rows[k % 3].max(*e);
    }
    let mut columns = [ZERO; 3];
    for (k, e) in exponents.iter().enumerate().filter(|(_, e)| **e != ZERO) {
        columns[k / 3] = columns[k / 3].max(e - rows[k % 3]);
    }
    if rows.contains(&ZERO) || columns.contains(&ZERO) {
        return None; // a row or column of zeros
    }
    let mut scaled = [0.0; 9];
    for k in 0..9 {
        scaled[k] = shifted(entries[k], -rows[k % 3] - columns[k / 3])?;
    }
    let regular = || fixed::pseudo_inverse(&DMat3::from_cols_array(&scaled)).filter(|answer| answer.rank == 3);
    let inverse = regular::inverse::<false>(&scaled).or_else(|| Some(regular()?.matrix))?.to_cols_array();
    let mut answer = [0.0; 9];
    for k in 0..9 {
        // Row k % 3 of the inverse belongs to a column of the matrix, column k / 3 to a row.
        answer[k] = shifted(inverse[k], -columns[k % 3] - rows[k / 3])?;
    }
    Some(DMat3::from_cols_array(&answer))
}

/// The exponent that stands for zero: below all others.
const ZERO: i32 = i32::MIN / 2;

/// The exponent of a finite double, -1023 for all subnormal ones.
fn exponent(x: f64) -> i32 {
    if x == 0.0 { ZERO } else { (x.to_bits() >> 52 & 0x7ff) as i32 - 1023 }
}

/// `x` times `2^shift` if that is zero, a normal double, which is exact then, or infinite.
fn shifted(x: f64, shift: i32) -> Option<f64> {
    const LIMIT: i32 = 2 * 1022;
    if x == 0.0 {
        return Some(x);
    }
    if shift.abs() > LIMIT {
        return None;
    }
    // The factor itself may lie beyond the doubles. Two steps in the same direction: the first is exact if the second is.
    let result = x * power_of_two(shift / 2) * power_of_two(shift - shift / 2);
    (result.abs() > f64::MIN_POSITIVE).then_some(result)
}
