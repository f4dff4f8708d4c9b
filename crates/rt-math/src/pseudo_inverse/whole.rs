//! Matrices that are a power of two times small whole numbers: every polynomial is exact in doubles, and each entry of
//! the answer is one division.
//!
//! Such are grid coordinates, zeros and ones, axes: the usual matrix of exact rank 1 or 2. The formulas are those of
//! [`integers`](super::integers); `docs/numerics.md`, section 3, proves the sizes.

use glam::{DMat3, DVec3};

use super::answer::PseudoInverse;
use crate::exact::{mantissa_and_exponent, scale};

/// Entries are below two to this power in units of their common power of two.
const BITS: i32 = 11;
/// Added to a double of at most [`BITS`] bits before the point and taken away again, this rounds it to a whole number.
const ROUNDER: f64 = 1.5 * (1u64 << 52) as f64;
/// Below this power of two, a result might be subnormal.
const LEAST_SHIFT: i32 = -900;

/// The exact rank and the correctly rounded pseudo-inverse of a finite matrix, if it is of this kind.
#[inline(always)]
pub(super) fn pseudo_inverse(m: &DMat3) -> Option<PseudoInverse> {
    let Quotients { rank, rows: [x, y, z], denominator, shift } = Quotients::new(m)?;
    if rank == 0 {
        return Some(PseudoInverse { matrix: DMat3::ZERO, rank });
    }
    let rounded = |row: DVec3| scale(row / denominator + DVec3::ZERO, shift);
    Some(PseudoInverse { matrix: DMat3::from_cols(rounded(x), rounded(y), rounded(z)).transpose(), rank })
}

/// The correctly rounded row sums of the pseudo-inverse of a finite matrix, if it is of this kind.
#[inline(always)]
pub(super) fn row_sums(m: &DMat3) -> Option<DVec3> {
    let Quotients { rank, rows, denominator, shift } = Quotients::new(m)?;
    if rank == 0 {
        return Some(DVec3::ZERO);
    }
    let sums = DVec3::from_array(rows.map(|row| row.x + row.y + row.z));
    Some(scale(sums / denominator + DVec3::ZERO, shift))
}

/// Whether no entry has more bits, or all are subnormal, which have no leading bit to count from: a quick test.
#[inline(always)]
pub(super) fn is_likely(entries: &[f64; 9]) -> bool {
    let bits = entries.iter().fold(0, |bits, x| bits | x.to_bits());
    bits << (11 + BITS) == 0 || bits & f64::INFINITY.to_bits() == 0
}

/// The rows of the pseudo-inverse as exact quotients: `rows` over `denominator`, times `2^shift`. An exact zero has
/// either sign.
struct Quotients {
    rank: usize,
    rows: [DVec3; 3],
    denominator: f64,
    shift: i32,
}

impl Quotients {
    #[inline(always)]
    fn new(m: &DMat3) -> Option<Self> {
        let entries = m.to_cols_array();
        if !is_likely(&entries) {
            return None;
        }
        let largest = entries.iter().fold(0.0, |largest: f64, x| if x.abs() > largest { x.abs() } else { largest });
        let shift = if largest == 0.0 { 0 } else { BITS - 1 - mantissa_and_exponent(largest).1 };
        if shift < LEAST_SHIFT {
            return None;
        }
        let scaled = entries.map(|x| scale(x, shift));
        // What is not zero may only become zero by underflow.
        let whole = |(&x, &y): (&f64, &f64)| ((y + ROUNDER) - ROUNDER == y) & ((y != 0.0) | (x == 0.0));
        if !entries.iter().zip(&scaled).fold(true, |all, pair| all & whole(pair)) {
            return None;
        }
        let DMat3 { x_axis: a, y_axis: b, z_axis: c } = DMat3::from_cols_array(&scaled);
        let [bc, ca, ab] = [b.cross(c), c.cross(a), a.cross(b)];
        let determinant = a.dot(bc);
        if determinant != 0.0 {
            return Some(Self { rank: 3, rows: [bc, ca, ab], denominator: determinant, shift });
        }
        let minors = bc.length_squared() + ca.length_squared() + ab.length_squared();
        if minors != 0.0 {
            let rows = [ca.cross(c) - ab.cross(b), ab.cross(a) - bc.cross(c), bc.cross(b) - ca.cross(a)];
            return Some(Self { rank: 2, rows, denominator: minors, shift });
        }
        let squares = a.length_squared() + b.length_squared() + c.length_squared();
        Some(Self { rank: usize::from(squares != 0.0), rows: [a, b, c], denominator: squares, shift })
    }
}
