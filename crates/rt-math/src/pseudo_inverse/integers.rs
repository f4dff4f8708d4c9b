//! The pseudo-inverse in exact integers: every finite matrix, whatever its exponents and its rank.
//!
//! With `a_k` the columns of the matrix and `c_k` those of the matrix of its cofactors (`c_0 = a_1 x a_2`, ...), the
//! row `k` of the pseudo-inverse is
//!
//! - rank 3: `c_k / det`, the inverse;
//! - rank 2: `b_k / sum of c^2`, where `b_0 = c_1 x a_2 - c_2 x a_1`, ... (the adjugate, made linear in `a` and in
//!   `c`);
//! - rank 1: `a_k / sum of a^2`;
//! - rank 0: zero.
//!
//! All are quotients of polynomials of the entries, so each is rounded once. `docs/numerics.md`, section 3, proves the
//! formula for rank 2 and the sizes.

use core::cmp::Ordering;

use glam::{DMat3, DVec3};

use super::answer::PseudoInverse;
use crate::exact::Dyadic;
use crate::exact::vector::{cross, dot};

/// The exact rank and the correctly rounded pseudo-inverse of a finite matrix.
#[cold]
#[inline(never)]
pub(super) fn pseudo_inverse(m: &DMat3) -> PseudoInverse {
    if is_narrow(m) { pseudo_inverse_sized::<16>(m) } else { pseudo_inverse_sized::<136>(m) }
}

/// The correctly rounded row sums of the pseudo-inverse of a finite matrix.
#[cold]
#[inline(never)]
pub(super) fn row_sums(m: &DMat3) -> DVec3 {
    if is_narrow(m) { row_sums_sized::<16>(m) } else { row_sums_sized::<136>(m) }
}

/// Whether 16 limbs are enough. Degree 4 in entries of w bits takes `(4 w + 8) / 64 + 2` limbs, sums of rows included,
/// and two more for the rounding: w = 206 fits in 16 limbs, and the 2098 bits from one end of the doubles to the other
/// fit in 136.
fn is_narrow(m: &DMat3) -> bool {
    const NARROW: u64 = 206 - 53;
    let exponents = m.to_cols_array().map(|x| (x.to_bits() >> 52 & 0x7ff).max(1));
    let used = || exponents.iter().zip(m.to_cols_array()).filter(|(_, x)| *x != 0.0).map(|(e, _)| *e);
    used().max().unwrap_or(0) - used().min().unwrap_or(0) <= NARROW
}

fn pseudo_inverse_sized<const LIMBS: usize>(m: &DMat3) -> PseudoInverse {
    let (rows, denominator, rank) = quotients::<LIMBS>(m);
    let row = |k: usize| DVec3::from_array([0, 1, 2].map(|j| divided(&rows[k][j], &denominator)));
    PseudoInverse { matrix: DMat3::from_cols(row(0), row(1), row(2)).transpose(), rank }
}

fn row_sums_sized<const LIMBS: usize>(m: &DMat3) -> DVec3 {
    let (rows, denominator, _) = quotients::<LIMBS>(m);
    DVec3::from_array(rows.map(|[x, y, z]| divided(&(x + y + z), &denominator)))
}

/// The rows of the pseudo-inverse times a common denominator, and the rank; all zero for rank 0.
fn quotients<const LIMBS: usize>(m: &DMat3) -> ([[Dyadic<LIMBS>; 3]; 3], Dyadic<LIMBS>, usize) {
    let a = [m.x_axis, m.y_axis, m.z_axis].map(|column| column.to_array().map(Dyadic::<LIMBS>::from_f64));
    let c = [cross(&a[1], &a[2]), cross(&a[2], &a[0]), cross(&a[0], &a[1])];
    let determinant = dot(&a[0], &c[0]);
    if determinant.sign() != Ordering::Equal {
        return (c, determinant, 3);
    }
    let minors = dot(&c[0], &c[0]) + dot(&c[1], &c[1]) + dot(&c[2], &c[2]);
    if minors.sign() != Ordering::Equal {
        let b = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| {
            let (first, second) = (cross(&c[i], &a[j]), cross(&c[j], &a[i]));
            [0, 1, 2].map(|k| &first[k] - &second[k])
        });
        return (b, minors, 2);
    }
    let squares = dot(&a[0], &a[0]) + dot(&a[1], &a[1]) + dot(&a[2], &a[2]);
    let rank = usize::from(squares.sign() != Ordering::Equal);
    (a, squares, rank)
}

/// The correctly rounded quotient; zero by zero is +0.0 too.
fn divided<const LIMBS: usize>(numerator: &Dyadic<LIMBS>, denominator: &Dyadic<LIMBS>) -> f64 {
    if numerator.sign() == Ordering::Equal { 0.0 } else { Dyadic::quotient(numerator, denominator) }
}
