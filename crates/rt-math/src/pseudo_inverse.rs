//! The Moore-Penrose pseudo-inverse of a 3 x 3 matrix.
//!
//! Nearly every matrix is well scaled and regular, and then [`regular`] finds the correctly rounded inverse in
//! double-double. Whatever that cannot decide goes to [`integers`], which are exact. [`truncated`] is another function:
//! singular values below a tolerance are taken as zero.

mod integers;
mod narrow;
mod regular;

use glam::{DMat3, DVec3};

use crate::fma_dispatch;

/// A pseudo-inverse and the rank it was made for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PseudoInverse {
    /// The pseudo-inverse itself.
    pub matrix: DMat3,
    /// Rank of the matrix that was inverted, 0 to 3.
    pub rank: usize,
}

/// Returns the Moore-Penrose pseudo-inverse of `m` and the rank of `m`.
///
/// The rank is exact and every entry is correctly rounded (to nearest, ties to even), for all finite matrices: an entry
/// beyond the range of doubles is infinite, one that underflows is a zero with the sign of the exact value, and one that
/// is exactly zero is +0.0. For rank 3 this is the inverse. A matrix with an infinite or NaN entry has no pseudo-inverse:
/// every entry of the answer is NaN and the rank is 0.
///
/// The pseudo-inverse jumps where the rank drops: if the entries carry errors, so that a matrix meant to be singular is
/// not, [`pseudo_inverse_with_tolerance`] is the function to use.
///
/// Source: R. Penrose, "A generalized inverse for matrices", 1955, for the definition.
///
/// ```
/// use glam::{DMat3, DVec3};
/// use rt_math::pseudo_inverse;
///
/// // A rank-1 matrix: A+ = A^T / |A|^2.
/// let flat = DMat3::from_diagonal(DVec3::new(0.0, 4.0, 0.0));
/// let answer = pseudo_inverse(flat);
/// assert_eq!(answer.rank, 1);
/// assert_eq!(answer.matrix, DMat3::from_diagonal(DVec3::new(0.0, 0.25, 0.0)));
/// ```
#[inline]
pub fn pseudo_inverse(m: DMat3) -> PseudoInverse {
    let [a, b, c, d, e, f, g, h, i] = m.to_cols_array();
    staged(a, b, c, d, e, f, g, h, i)
}

fma_dispatch! {
    #[expect(clippy::too_many_arguments, reason = "nine numbers in registers; from memory just written they come late")]
    fn staged(a: f64, b: f64, c: f64, d: f64, e: f64, f: f64, g: f64, h: f64, i: f64) -> PseudoInverse = staged_kernel;
}

#[expect(clippy::too_many_arguments, reason = "as above")]
#[inline(always)]
fn staged_kernel<const FMA: bool>(
    a: f64,
    b: f64,
    c: f64,
    d: f64,
    e: f64,
    f: f64,
    g: f64,
    h: f64,
    i: f64,
) -> PseudoInverse {
    let m = [a, b, c, d, e, f, g, h, i];
    match regular::inverse::<FMA>(&m) {
        Some(matrix) => PseudoInverse { matrix, rank: 3 },
        None => undecided(&DMat3::from_cols_array(&m)),
    }
}

#[cold]
#[inline(never)]
fn undecided(m: &DMat3) -> PseudoInverse {
    if !m.is_finite() {
        return PseudoInverse { matrix: DMat3::NAN, rank: 0 };
    }
    narrow::pseudo_inverse(m).unwrap_or_else(|| integers::pseudo_inverse(m))
}

/// Returns the pseudo-inverse of `m` with every singular value up to `rtol` times the largest taken as zero.
///
/// This is the meaning that `rcond` has in `numpy.linalg.pinv`. A matrix with an infinite or NaN entry has no
/// pseudo-inverse: every entry of the answer is NaN and the rank is 0.
///
/// Source: M. R. Hestenes, "Inversion of Matrices by Biorthogonalization and Related Results", 1958.
pub fn pseudo_inverse_with_tolerance(m: DMat3, rtol: f64) -> PseudoInverse {
    if !m.is_finite() {
        return PseudoInverse { matrix: DMat3::NAN, rank: 0 };
    }
    let largest = m.to_cols_array().into_iter().fold(0.0, |sum: f64, x| sum.max(x.abs()));
    if largest == 0.0 {
        return PseudoInverse { matrix: DMat3::ZERO, rank: 0 };
    }
    // Scaled to a largest entry near 2^500, no square overflows and only columns 2^-1000 times smaller underflow.
    let shift = 500 - exponent(largest);
    let mut g = [m.x_axis, m.y_axis, m.z_axis].map(|column| scale(column, shift));
    let mut v = [DVec3::X, DVec3::Y, DVec3::Z];
    orthogonalize(&mut g, &mut v);

    let sigma = g.map(DVec3::length);
    let threshold = rtol * sigma[0].max(sigma[1]).max(sigma[2]);
    let mut matrix = DMat3::ZERO;
    let mut rank = 0;
    for k in 0..3 {
        if sigma[k] > threshold {
            let u = g[k] / sigma[k] / sigma[k];
            matrix += DMat3::from_cols(v[k] * u.x, v[k] * u.y, v[k] * u.z);
            rank += 1;
        }
    }
    let columns = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|column| scale(column, shift));
    PseudoInverse { matrix: DMat3::from_cols(columns[0], columns[1], columns[2]), rank }
}

/// Rotates pairs of the columns of `g`, and of `v` alike, until the columns of `g` are orthogonal.
fn orthogonalize(g: &mut [DVec3; 3], v: &mut [DVec3; 3]) {
    // Convergence is quadratic: 3 x 3 matrices need 4 to 8 sweeps.
    for _ in 0..30 {
        let mut rotated = false;
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let (alpha, beta, gamma) = (g[p].length_squared(), g[q].length_squared(), g[p].dot(g[q]));
            if gamma.abs() <= f64::EPSILON * alpha.sqrt() * beta.sqrt() {
                continue;
            }
            rotated = true;
            let zeta = (beta - alpha) / gamma * 0.5;
            // From 2^30 on, sqrt(1 + zeta^2) rounds to |zeta|, and zeta^2 could overflow.
            let root = if zeta.abs() < f64::from(1 << 30) { (1.0 + zeta * zeta).sqrt() } else { zeta.abs() };
            let t = 1.0f64.copysign(zeta) / (zeta.abs() + root);
            let c = 1.0 / (1.0 + t * t).sqrt();
            let s = c * t;
            for columns in [&mut *g, &mut *v] {
                let (x, y) = (columns[p], columns[q]);
                columns[p] = x * c - y * s;
                columns[q] = x * s + y * c;
            }
        }
        if !rotated {
            return;
        }
    }
}

/// `x` times `2^shift`, exact unless the result leaves the normal range; `shift` within -2100..=2100.
fn scale(x: DVec3, shift: i32) -> DVec3 {
    let third = shift / 3;
    x * power_of_two(shift - 2 * third) * power_of_two(third) * power_of_two(third)
}

/// `2^n` for `n` in -1022..=1023.
fn power_of_two(n: i32) -> f64 {
    f64::from_bits(u64::try_from(1023 + n).expect("n >= -1022") << 52)
}

/// The exponent `e` of the positive finite `x`: `2^e <= x < 2^(e+1)`.
fn exponent(x: f64) -> i32 {
    if x < f64::MIN_POSITIVE {
        return exponent(x * power_of_two(54)) - 54;
    }
    i32::try_from(x.to_bits() >> 52).expect("eleven bits") - 1023
}

#[cfg(test)]
#[path = "../tests/pseudo_inverse/matrices.rs"]
mod matrices;

#[cfg(test)]
mod tests {
    use super::matrices::{CLASSES, Random};
    use super::*;
    use crate::oracle::cases;

    /// Every stage decides, and what it decides is what the exact integers say, to the bit.
    #[test]
    fn stages_agree_and_each_one_decides() {
        let mut decided = [0; 3];
        for (name, class) in CLASSES {
            let mut random = Random(7);
            let mut of_class = [0; 3];
            for _ in 0..cases(100_000) / 10 {
                let m = class(&mut random);
                let expected = integers::pseudo_inverse(&m);
                let entries = m.to_cols_array();
                let fused = regular::inverse::<true>(&entries);
                let split = regular::inverse::<false>(&entries);
                let narrow = narrow::pseudo_inverse(&m);
                for inverse in [fused, split].into_iter().flatten() {
                    assert_eq!(
                        bits(&PseudoInverse { matrix: inverse, rank: 3 }),
                        bits(&expected),
                        "{name}: {entries:?}"
                    );
                }
                if let Some(answer) = narrow {
                    assert_eq!(bits(&answer), bits(&expected), "{name}: {entries:?}");
                }
                of_class[if split.is_some() {
                    0
                } else if narrow.is_some() {
                    1
                } else {
                    2
                }] += 1;
            }
            println!("{name:24} double-double, 256 bits, any size: {of_class:?}");
            decided.iter_mut().zip(of_class).for_each(|(sum, count)| *sum += count);
        }
        assert!(decided.iter().all(|&count| count > 1000), "{decided:?}");
    }

    fn bits(answer: &PseudoInverse) -> (usize, [u64; 9]) {
        (answer.rank, answer.matrix.to_cols_array().map(f64::to_bits))
    }

    #[test]
    fn inverse_of_a_rotation_is_its_transpose() {
        let rotation = DMat3::from_euler(glam::EulerRot::XYZ, 0.3, -1.2, 2.5);
        let answer = pseudo_inverse(rotation);
        assert_eq!(answer.rank, 3);
        assert!(answer.matrix.abs_diff_eq(rotation.transpose(), 8.0 * f64::EPSILON), "{answer:?}");
    }

    #[test]
    fn rank_two_meets_the_penrose_conditions() {
        let m = DMat3::from_cols_array(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]);
        let PseudoInverse { matrix, rank } = pseudo_inverse(m);
        assert_eq!(rank, 2);
        assert!((m * matrix * m).abs_diff_eq(m, 1e-13), "{matrix}");
        assert!((matrix * m * matrix).abs_diff_eq(matrix, 1e-13), "{matrix}");
        assert!((m * matrix).abs_diff_eq((m * matrix).transpose(), 1e-13), "{matrix}");
        assert!((matrix * m).abs_diff_eq((matrix * m).transpose(), 1e-13), "{matrix}");
    }

    #[test]
    fn ends_of_the_exponent_range_are_scaled() {
        for x in [f64::MAX, 1e200, 1.0, 1e-200, 1e-300] {
            let answer = pseudo_inverse(DMat3::from_diagonal(DVec3::splat(x)));
            assert_eq!(answer.rank, 3, "{x}");
            assert_eq!(answer.matrix, DMat3::from_diagonal(DVec3::splat(1.0 / x)), "{x}");
        }
        assert_eq!(pseudo_inverse(DMat3::NAN).rank, 0);
        assert!(pseudo_inverse(DMat3::NAN).matrix.is_nan());
    }
}
