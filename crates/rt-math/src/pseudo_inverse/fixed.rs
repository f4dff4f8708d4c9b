//! Matrices whose entries lie in a window of exponents: exact fixed-point polynomials, of which only the quotients are
//! rounded.
//!
//! Such are doubles of like magnitude, and whole numbers: the usual singular or nearly singular matrix. With the
//! columns `a_k`, the cofactors `c_k` and `G`, the dot products of the columns, row `k` of the pseudo-inverse is
//!
//! - rank 3: `c_k / det`;
//! - rank 2: `b_k` over the sum of the principal 2 x 2 minors of `G`, with
//!   `b_0 = a_0 (G_11 + G_22) - a_1 G_01 - a_2 G_02`, ...;
//! - rank 1: `a_k` over the trace of `G`.
//!
//! `docs/numerics.md`, section 3, proves the formula for rank 2 and the sizes.

use glam::{DMat3, DVec3};

use super::answer::PseudoInverse;
use super::regular::Reciprocal;
use crate::exact::vector::{cross, dot};
use crate::exact::{Fixed, U, Window, power_of_two};
use crate::fma_dispatch;

/// The exact rank and the correctly rounded pseudo-inverse of a finite matrix, if it is of this kind.
#[cold]
#[inline(never)]
pub(super) fn pseudo_inverse(m: &DMat3) -> Option<PseudoInverse> {
    match Quotients::<3, 4>::new::<1, 2>(m) {
        Some(quotients) => Some(quotients.pseudo_inverse()),
        None => Some(Quotients::<6, 8>::new::<2, 4>(m)?.pseudo_inverse()),
    }
}

/// The correctly rounded row sums of the pseudo-inverse of a finite matrix, if it is of this kind.
#[cold]
#[inline(never)]
pub(super) fn row_sums(m: &DMat3) -> Option<DVec3> {
    match Quotients::<3, 4>::new::<1, 2>(m) {
        Some(quotients) => Some(quotients.row_sums()),
        None => Some(Quotients::<6, 8>::new::<2, 4>(m)?.row_sums()),
    }
}

/// The pseudo-inverse with its entries as exact quotients: `rows` of `V` limbs over `denominator` of `Q`, times
/// `2^exponent`.
struct Quotients<const V: usize, const Q: usize> {
    rank: usize,
    rows: [[Fixed<V>; 3]; 3],
    denominator: Fixed<Q>,
    exponent: i32,
}

impl<const V: usize, const Q: usize> Quotients<V, Q> {
    /// With entries of `N` limbs, products of two of `S = 2 N`; `V = 3 N` and `Q = 4 N`.
    #[inline(always)]
    fn new<const N: usize, const S: usize>(m: &DMat3) -> Option<Self> {
        let window = Window::<N>::around(&m.to_cols_array())?;
        let a = m.to_cols_array_2d().map(|column| column.map(|x| window.fixed(x)));
        let exponent = -window.exponent();
        let c = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| cross::<_, _, Fixed<S>>(&a[i], &a[j]));
        let determinant: Fixed<V> = dot(&a[0], &c[0]);
        if !determinant.sign().is_eq() {
            let rows = c.map(|row| row.map(|x| x.widen()));
            return Some(Self { rank: 3, rows, denominator: determinant.widen(), exponent });
        }
        let g = |i: usize, j: usize| -> Fixed<S> { dot(&a[i], &a[j]) };
        let [g00, g11, g22] = [g(0, 0), g(1, 1), g(2, 2)];
        if c.as_flattened().iter().all(|x| x.sign().is_eq()) {
            let (rows, trace) = (a.map(|row| row.map(|x| x.widen())), g00 + g11 + g22);
            let rank = usize::from(!trace.sign().is_eq());
            return Some(Self { rank, rows, denominator: trace.widen(), exponent });
        }
        let [g12, g20, g01] = [g(1, 2), g(2, 0), g(0, 1)];
        let row = |i: usize, j: usize, k: usize, others: Fixed<S>, ij: &Fixed<S>, ik: &Fixed<S>| {
            [0, 1, 2].map(|n| {
                Fixed::product(&others, &a[i][n]) - Fixed::product(ij, &a[j][n]) - Fixed::product(ik, &a[k][n])
            })
        };
        let rows = [
            row(0, 1, 2, g11 + g22, &g01, &g20),
            row(1, 2, 0, g22 + g00, &g12, &g01),
            row(2, 0, 1, g00 + g11, &g20, &g12),
        ];
        let minor = |ii, jj, ij| Fixed::product(ii, jj) - Fixed::product(ij, ij);
        let denominator = minor(&g00, &g11, &g01) + minor(&g11, &g22, &g12) + minor(&g22, &g00, &g20);
        Some(Self { rank: 2, rows, denominator, exponent })
    }

    fn pseudo_inverse(&self) -> PseudoInverse {
        let Self { rank, rows: [x, y, z], .. } = self;
        if *rank == 0 {
            return PseudoInverse { matrix: DMat3::ZERO, rank: 0 };
        }
        let entries = self.divided([x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2]]);
        PseudoInverse { matrix: DMat3::from_cols_array(&entries), rank: *rank }
    }

    fn row_sums(&self) -> DVec3 {
        if self.rank == 0 {
            return DVec3::ZERO;
        }
        DVec3::from_array(self.divided(self.rows.map(|row| row[0] + row[1] + row[2])))
    }

    /// The correctly rounded quotients of these numerators; an exact zero is +0.0.
    #[inline(always)]
    fn divided<const COUNT: usize>(&self, numerators: [Fixed<V>; COUNT]) -> [f64; COUNT] {
        let Some((denominator, scale)) = self.denominator.parts() else { return [f64::NAN; COUNT] };
        let mut parts = [[0.0; 2]; 9];
        let mut shifts = [0; COUNT];
        for ((part, shift), numerator) in parts.iter_mut().zip(&mut shifts).zip(&numerators) {
            if let Some((leading, exponent)) = numerator.parts() {
                (*part, *shift) = (leading, exponent - scale + self.exponent);
            }
        }
        let quotients = in_double_double(parts, denominator);
        let mut rounded = [0.0; COUNT];
        for k in 0..COUNT {
            let [lower, upper] = quotients[k];
            // In 1/2..2 as it is, and a normal double after the power of two.
            let certain = lower == upper && (-1020..1020).contains(&shifts[k]);
            rounded[k] = if certain {
                upper * power_of_two(shifts[k])
            } else if lower == upper && shifts[k] > 1024 {
                // At least 2^1024 in magnitude.
                upper * f64::INFINITY
            } else {
                Fixed::quotient(&numerators[k], &self.denominator, self.exponent)
            };
        }
        rounded
    }
}

/// How far the two doubles of [`Fixed::parts`] are from the number, relatively.
const CUT: f64 = 2.0 * U * U;

fma_dispatch! {
    /// For each numerator two doubles, the roundings of a lower and an upper bound of its quotient by the denominator:
    /// where they are equal, so is its rounding. All are `high + low` within [`CUT`], in `1..2` in magnitude, or zero.
    fn in_double_double(numerators: [[f64; 2]; 9], denominator: [f64; 2]) -> [[f64; 2]; 9] = in_double_double_kernel;
}

#[inline(always)]
fn in_double_double_kernel<const FMA: bool>(numerators: [[f64; 2]; 9], [denominator, low]: [f64; 2]) -> [[f64; 2]; 9] {
    let Some(reciprocal) = Reciprocal::<FMA>::new(denominator, low, CUT * denominator.abs()) else {
        return [[0.0, f64::NAN]; 9];
    };
    numerators.map(|[high, low]| {
        let (lower, upper) = reciprocal.times(high, low, low.abs() + f64::EPSILON * high.abs());
        [lower, upper]
    })
}
