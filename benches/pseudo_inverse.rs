//! The pseudo-inverse beside adjugate over determinant, glam's inverse, and nalgebra's inverse and SVD.
//!
//! Each function runs over 1024 matrices of each class of the tests, one after the other; `benign` is the class for
//! which all of them have an answer. A time is for one matrix.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use glam::{DMat3, DVec3};
use nalgebra::Matrix3;
use oracle::Random;
use oracle::matrices::CLASSES;
use rt_math::{pseudo_inverse, pseudo_inverse_with_tolerance};

/// numpy's default for 3 x 3 matrices is of this order.
const TOLERANCE: f64 = 3.0 * f64::EPSILON;

/// The textbook's inverse: adjugate over determinant.
fn adjugate_over_determinant(m: &DMat3) -> DMat3 {
    let rows = [m.y_axis.cross(m.z_axis), m.z_axis.cross(m.x_axis), m.x_axis.cross(m.y_axis)];
    let reciprocal = 1.0 / m.x_axis.dot(rows[0]);
    let scaled = rows.map(|row: DVec3| row * reciprocal);
    DMat3::from_cols(scaled[0], scaled[1], scaled[2]).transpose()
}

/// Times `function` on matrices of a class, prepared beforehand by `convert`.
fn measure<T, R>(
    criterion: &mut Criterion,
    name: &str,
    class: &str,
    convert: impl Fn(DMat3) -> T,
    function: impl Fn(&T) -> R,
) {
    const COUNT: usize = 1024;
    let (_, make) = CLASSES.iter().find(|(name, _)| *name == class).expect("a class of the tests");
    let mut random = Random::new(1);
    let inputs: Vec<T> = (0..COUNT).map(|_| convert(make(&mut random))).collect();
    let mut next = 0;
    criterion.bench_function(&format!("{name}/{class}"), |bencher| {
        bencher.iter(|| {
            next = (next + 1) % COUNT;
            function(black_box(&inputs[next]))
        });
    });
}

fn benches(criterion: &mut Criterion) {
    let same = |m| m;
    let foreign = |m: DMat3| Matrix3::from_column_slice(&m.to_cols_array());

    measure(criterion, "adjugate_over_determinant", "benign", same, adjugate_over_determinant);
    measure(criterion, "pseudo_inverse", "benign", same, |m| pseudo_inverse(*m));
    measure(criterion, "pseudo_inverse_with_tolerance", "benign", same, |m| {
        pseudo_inverse_with_tolerance(*m, TOLERANCE)
    });
    measure(criterion, "glam_inverse", "benign", same, |m| m.inverse());
    measure(criterion, "nalgebra_try_inverse", "benign", foreign, |m| m.try_inverse());
    measure(criterion, "nalgebra_svd_pseudo_inverse", "benign", foreign, |m| m.pseudo_inverse(TOLERANCE));

    for (class, _) in CLASSES.iter().filter(|(name, _)| *name != "benign") {
        measure(criterion, "pseudo_inverse", class, same, |m| pseudo_inverse(*m));
    }
    for class in ["ill_conditioned", "rank_two", "rank_one"] {
        let tolerant = |m: &DMat3| pseudo_inverse_with_tolerance(*m, TOLERANCE);
        measure(criterion, "pseudo_inverse_with_tolerance", class, same, tolerant);
        measure(criterion, "nalgebra_svd_pseudo_inverse", class, foreign, |m| m.pseudo_inverse(TOLERANCE));
    }
}

criterion_group!(group, benches);
criterion_main!(group);
