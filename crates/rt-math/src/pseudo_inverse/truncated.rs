//! The pseudo-inverse with small singular values taken as zero.
//!
//! If nothing is to be dropped, the answer is the exact function's. Otherwise only the largest singular value of some
//! matrix is ever needed, which one-sided Jacobi (Hestenes) finds with a small relative error: `s_1` of the matrix `A`,
//! `s_1 s_2` of its cofactors, `1 / s_3` of its inverse. The singular vectors that go with the first two, `u_1`, `v_1`
//! and `u_3`, `v_3`, give the missing ones as `u_2 = u_3 x u_1` and `v_2 = v_3 x v_1`. So no small value is ever read
//! off beside a large one, and the tolerance may be far below the precision of a double.
//!
//! Before that, [`estimate`] decides where the singular values are far apart: then powers of the matrix and of its
//! cofactors give their vectors.

use glam::{DMat3, DVec3};

use super::answer::PseudoInverse;
use super::regular::{adjugate, determinant};
use crate::exact::{U, mantissa_and_exponent, power_of_two, scale, two_prod};
use crate::fma_dispatch;

/// Whether nothing is to be dropped, by the norms of the finite `m` and its pseudo-inverse; `false` if they leave it
/// open.
#[inline(always)]
pub(super) fn keeps_all(m: &DMat3, rtol: f64, exact: &PseudoInverse) -> bool {
    // s_r / s_1 is at least 1 / (|A| |A+|), with Frobenius norms; the margin is far above the error of the norms,
    // unless squares underflow, which the lower limit excludes.
    const MARGIN: f64 = 1.0 - 1e-6;
    const SMALLEST_SQUARE: f64 = 1e-200;
    let (a, x) = (square(m), square(&exact.matrix));
    exact.rank <= 1 || a > SMALLEST_SQUARE && x > SMALLEST_SQUARE && rtol * (a * x).sqrt() < MARGIN
}

/// The square of the Frobenius norm.
#[inline(always)]
fn square(m: &DMat3) -> f64 {
    m.x_axis.length_squared() + m.y_axis.length_squared() + m.z_axis.length_squared()
}

/// What estimates of the singular values say.
pub(super) enum Estimate {
    /// Some are dropped: the answer.
    Dropped(PseudoInverse),
    /// None is.
    Kept,
    /// They are too near to the threshold, or to each other, or out of range.
    Unknown,
}

/// Where singular values are apart by [`FAR`] and from the threshold by a small part of it: the answer, or that nothing
/// is to be dropped.
pub(super) fn estimate(m: &DMat3, rtol: f64) -> Estimate {
    // In the range of `adjugate`, with what is smaller by up to 2^-160.
    let shift = 60 - exponent(m);
    match estimate_scaled(&scale(*m, shift), rtol) {
        Estimate::Dropped(PseudoInverse { matrix, rank }) => {
            Estimate::Dropped(PseudoInverse { matrix: scale(matrix, shift), rank })
        }
        other => other,
    }
}

fma_dispatch! {
    fn estimate_scaled(m: &DMat3, rtol: f64) -> Estimate = estimate_kernel;
}

/// Values whose ratio is below this leave less than the rounding errors of each other, squared, in what one
/// multiplication gives.
const FAR: f64 = power_of_two(-27);

#[inline(always)]
fn estimate_kernel<const FMA: bool>(m: &DMat3, rtol: f64) -> Estimate {
    const MORE: f64 = 1.0 + 1e-6;
    const SMALLEST_SQUARE: f64 = 1e-200;
    let entries = m.to_cols_array();
    let Some(adjugate) = adjugate::<FMA>(&entries) else { return Estimate::Unknown };
    let (high, low, bound) = determinant::<FMA>(&entries, &adjugate);
    let (d, d_error) = ((high + low).abs(), bound + U * high.abs());
    let cofactors = DMat3::from_cols_array(adjugate.high()).transpose();
    // Between s_1^2 and three times that, and the same for (s_1 s_2)^2.
    let (f, p) = (square(m), square(&cofactors));
    if p < SMALLEST_SQUARE {
        return Estimate::Unknown;
    }
    let root = p.sqrt();
    if 3.0 * root * MORE <= rtol.min(FAR) * f {
        // A (A^T g), where A^T g is along v_1.
        let right = m.transpose() * longest(m);
        let left = *m * right;
        let matrix = outer(right / left.length_squared(), left);
        return Estimate::Dropped(PseudoInverse { matrix, rank: 1 });
    }
    // At least rank 2; s_3 / s_2 is at most 3 |D| s_1 / (s_1 s_2)^2.
    if root < 1.75 * rtol * f || 3.0 * d * f.sqrt() > FAR * p {
        return Estimate::Unknown;
    }
    // So s_1^2 + s_2^2 and s_1 s_2 are known, hence s_1 to half the digits at least, and s_3 is |D| / (s_1 s_2).
    let threshold = rtol * root * (0.5 * (f + (f * f - 4.0 * p).max(0.0).sqrt())).sqrt();
    if d - d_error >= MORE * threshold {
        return Estimate::Kept;
    }
    if d <= d_error || (d + d_error) * MORE > threshold {
        return Estimate::Unknown; // perhaps singular: then the rank is exact, and so is the answer
    }
    // The cofactors are s_1 s_2 u_3 v_3^T: their product with this is along v_3, and with that along u_3.
    let right = cofactors.transpose() * longest(&cofactors);
    let left = cofactors * right;
    // The adjugate of rank 2, with these as cofactors.
    let over = left / left.length_squared();
    let row = |i: usize, j: usize| over.cross(right[i] * m.col(j) - right[j] * m.col(i));
    let matrix = DMat3::from_cols(row(1, 2), row(2, 0), row(0, 1)).transpose();
    Estimate::Dropped(PseudoInverse { matrix, rank: 2 })
}

/// The longest column.
#[inline(always)]
fn longest(m: &DMat3) -> DVec3 {
    let longer = |a: DVec3, b: DVec3| if b.length_squared() > a.length_squared() { b } else { a };
    longer(longer(m.x_axis, m.y_axis), m.z_axis)
}

/// The pseudo-inverse of the finite `m` with a tolerance, given the exact one and the function that finds such.
#[cold]
#[inline(never)]
pub(super) fn truncated(
    m: &DMat3,
    rtol: f64,
    exact: PseudoInverse,
    pseudo_inverse: fn(DMat3) -> PseudoInverse,
) -> PseudoInverse {
    let shift = -exponent(m);
    let a = scale(*m, shift);
    let first = Singular::largest(&a);
    let product = Singular::largest(&cofactors(&a));
    let second = product.value / first.value;
    let threshold = rtol * first.value;
    let rank = if second <= threshold {
        1
    } else if exact.rank == 3 && smallest(pseudo_inverse(a)) <= threshold {
        2
    } else {
        return exact;
    };
    let mut matrix = outer(first.right / first.value, first.left);
    if rank == 2 {
        matrix += outer(product.right.cross(first.right) / second, product.left.cross(first.left));
    }
    PseudoInverse { matrix: scale(matrix, shift), rank }
}

/// A singular value with its vectors: `A right = value left`.
struct Singular {
    value: f64,
    left: DVec3,
    right: DVec3,
}

impl Singular {
    /// The largest singular value of a finite matrix; for a zero matrix, 0 with any vectors.
    ///
    /// Source: M. R. Hestenes, "Inversion of Matrices by Biorthogonalization and Related Results", 1958.
    fn largest(m: &DMat3) -> Self {
        if *m == DMat3::ZERO {
            return Self { value: 0.0, left: DVec3::X, right: DVec3::X };
        }
        let shift = -exponent(m);
        let m = scale(*m, shift);
        let mut g = [m.x_axis, m.y_axis, m.z_axis];
        let mut v = [DVec3::X, DVec3::Y, DVec3::Z];
        // Rotations from the right make the columns of `g = m v` orthogonal. Convergence is quadratic: few sweeps do.
        for _ in 0..30 {
            let mut rotated = false;
            for (p, q) in [(0, 1), (0, 2), (1, 2)] {
                rotated |= rotate(&mut g, &mut v, p, q);
            }
            if !rotated {
                break;
            }
        }
        let length = g.map(DVec3::length);
        let k = (0..3).fold(0, |best, k| if length[k] > length[best] { k } else { best });
        Self { value: scale(length[k], -shift), left: g[k] / length[k], right: v[k] }
    }
}

/// Makes the columns `p` and `q` of `g` orthogonal by a rotation, which is applied to `v` too; false if they are
/// orthogonal already, as far as it matters for the largest.
fn rotate(g: &mut [DVec3; 3], v: &mut [DVec3; 3], p: usize, q: usize) -> bool {
    let (alpha, beta, gamma) = (g[p].length_squared(), g[q].length_squared(), g[p].dot(g[q]));
    if gamma.abs() <= 0.5 * f64::EPSILON * alpha.max(beta) {
        return false;
    }
    let zeta = (beta - alpha) / gamma * 0.5; // at most 1 / epsilon, after the test above
    let t = 1f64.copysign(zeta) / (zeta.abs() + (1.0 + zeta * zeta).sqrt());
    let c = 1.0 / (1.0 + t * t).sqrt();
    let s = c * t;
    for columns in [g, v] {
        let (x, y) = (columns[p], columns[q]);
        columns[p] = x * c - y * s;
        columns[q] = x * s + y * c;
    }
    true
}

/// The matrix of cofactors, each within a few units in the last place, for entries of at most 2 in magnitude.
fn cofactors(m: &DMat3) -> DMat3 {
    let minor = |a: f64, b: f64, c: f64, d: f64| {
        let ((first, first_error), (second, second_error)) = (two_prod::<false>(a, d), two_prod::<false>(b, c));
        (first - second) + (first_error - second_error)
    };
    let cross = |x: DVec3, y: DVec3| {
        DVec3::new(minor(x.y, x.z, y.y, y.z), minor(x.z, x.x, y.z, y.x), minor(x.x, x.y, y.x, y.y))
    };
    DMat3::from_cols(cross(m.y_axis, m.z_axis), cross(m.z_axis, m.x_axis), cross(m.x_axis, m.y_axis))
}

/// The smallest singular value of a matrix with this inverse; 0 if it is below about 2^-1022.
fn smallest(inverse: PseudoInverse) -> f64 {
    let regular = inverse.rank == 3 && inverse.matrix.is_finite();
    if regular { 1.0 / Singular::largest(&inverse.matrix).value } else { 0.0 }
}

/// The matrix `u v^T`.
fn outer(u: DVec3, v: DVec3) -> DMat3 {
    DMat3::from_cols(u * v.x, u * v.y, u * v.z)
}

/// The exponent `e` of the largest magnitude in a finite matrix that is not zero: it is in `2^e..2^(e+1)`.
fn exponent(m: &DMat3) -> i32 {
    mantissa_and_exponent(m.to_cols_array().into_iter().fold(0.0, |largest: f64, x| largest.max(x.abs()))).1
}
