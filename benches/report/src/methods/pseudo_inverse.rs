//! The pseudo-inverse of a 3x3 matrix. A case is the matrix by columns; the verdict is the rank; the values are the
//! nine entries by columns.

use glam::DMat3;
use rt_math::{pseudo_inverse as ours, pseudo_inverse_with_tolerance};

use super::method::{Answer, Method};
use super::real::{Float, cross, dot, vector};

/// Returns the methods that give a pseudo-inverse.
pub(crate) fn pseudo_inverse() -> Vec<Method<9, 9>> {
    vec![
        Method::new("adjugate f32", "adj A / det A", adjugate::<f32>),
        Method::new("adjugate", "adj A / det A", adjugate::<f64>),
        Method::new("normal equations", "(AᵀA)⁻¹ Aᵀ", normal_equations),
        Method::ours("ours, tolerance", |case| {
            let result = pseudo_inverse_with_tolerance(DMat3::from_cols_array(case), 3.0 * f64::EPSILON);
            answer(result.rank, result.matrix.to_cols_array())
        }),
        Method::ours("ours", |case| {
            let result = ours(DMat3::from_cols_array(case));
            answer(result.rank, result.matrix.to_cols_array())
        }),
    ]
}

fn answer(rank: usize, values: [f64; 9]) -> Answer<9> {
    Answer { verdict: u8::try_from(rank).expect("a rank is at most 3"), values }
}

/// What is no rank: the method has no answer for a singular matrix.
const NO_ANSWER: u8 = 9;

fn adjugate<T: Float>(case: &[f64; 9]) -> Answer<9> {
    let [a, b, c] = [0, 3, 6].map(|from| vector::<T>(case, from));
    let (bc, ca, ab) = (cross(b, c), cross(c, a), cross(a, b));
    let determinant = dot(a, bc);
    if determinant == T::of(0.0) {
        return Answer::without_values(NO_ANSWER);
    }
    // The rows of the inverse are the cross products.
    let entry = |row: usize, column: usize| ([bc, ca, ab][row][column] / determinant).wide();
    answer(3, std::array::from_fn(|i| entry(i % 3, i / 3)))
}

fn normal_equations(case: &[f64; 9]) -> Answer<9> {
    let a = DMat3::from_cols_array(case);
    let square = a.transpose() * a;
    if square.determinant() == 0.0 {
        return Answer::without_values(NO_ANSWER);
    }
    answer(3, (square.inverse() * a.transpose()).to_cols_array())
}
