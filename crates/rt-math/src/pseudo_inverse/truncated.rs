//! The pseudo-inverse with small singular values taken as zero.
//!
//! If nothing is to be dropped, the answer is the exact function's. Otherwise only the largest singular value of some
//! matrix is ever needed, which one-sided Jacobi (Hestenes) finds with a small relative error: `s_1` of the
//! matrix `A`, `s_1 s_2` of its cofactors, `1 / s_3` of its inverse. The singular vectors that go with the first two, `u_1`,
//! `v_1` and `u_3`, `v_3`, give the missing ones as `u_2 = u_3 x u_1` and `v_2 = v_3 x v_1`. So no small value is ever
//! read off beside a large one, and the tolerance may be far below the precision of a double.

use glam::{DMat3, DVec3};

use super::PseudoInverse;
use crate::exact::{mantissa_and_exponent, scale, two_prod};

/// The pseudo-inverse of the finite `m` with a tolerance, given the exact one and the function that finds such.
pub(super) fn truncated(
    m: &DMat3,
    rtol: f64,
    exact: PseudoInverse,
    pseudo_inverse: fn(DMat3) -> PseudoInverse,
) -> PseudoInverse {
    // s_r / s_1 is at least 1 / (|A| |A+|), with Frobenius norms; the margin is far above the error of the norms, unless
    // squares underflow, which the lower limit excludes.
    const MARGIN: f64 = 1.0 - 1e-6;
    const SMALLEST_SQUARE: f64 = 1e-200;
    let square = |m: &DMat3| m.x_axis.length_squared() + m.y_axis.length_squared() + m.z_axis.length_squared();
    let (a, x) = (square(m), square(&exact.matrix));
    if exact.rank <= 1 || a > SMALLEST_SQUARE && x > SMALLEST_SQUARE && rtol * (a * x).sqrt() < MARGIN {
        return exact;
    }

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

/// Makes the columns `p` and `q` of `g` orthogonal by a rotation, which `v` joins in; false if they are already, as far as
/// it matters for the largest.
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
