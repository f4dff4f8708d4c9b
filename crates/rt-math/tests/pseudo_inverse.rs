//! The rank is exact and every entry of the pseudo-inverse is correctly rounded, for every finite matrix.
//!
//! 10^4 matrices of each class; `RT_LONG=1 cargo test --release -p rt-math --test pseudo_inverse` runs 10^6 of each.

use glam::DMat3;
use oracle::matrices::CLASSES;
use oracle::{Random, assert_penrose_within_rounding, cases, is_rounded_quotient, matrix};
use rt_math::{PseudoInverse, pseudo_inverse, pseudo_inverse_row_sums};

/// Runs `check` on `cases` matrices of every class, the classes shared out over the processors.
fn for_every_class(cases: usize, check: impl Fn(&str, &DMat3) + Sync) {
    let next = std::sync::atomic::AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                while let Some((name, class)) = CLASSES.get(next.fetch_add(1, std::sync::atomic::Ordering::Relaxed)) {
                    let mut random = Random::new(name.len() as u64);
                    for _ in 0..cases {
                        let m = class(&mut random);
                        assert!(m.is_finite(), "{name} made {m}");
                        check(name, &m);
                    }
                }
            });
        }
    });
}

#[test]
fn rank_is_exact_and_every_entry_correctly_rounded() {
    for_every_class(cases(1_000_000), |name, m| {
        let (entries, exact) = (m.to_cols_array(), oracle::PseudoInverse::new(&matrix(&m.to_cols_array())));
        let PseudoInverse { matrix: found, rank } = pseudo_inverse(*m);
        assert_eq!(rank, exact.rank, "{name}: rank of {entries:?}");
        assert!(exact.rounds_to(&found.to_cols_array()), "{name}: {found} for {entries:?}");
    });
}

#[test]
fn row_sums_are_correctly_rounded() {
    for_every_class(cases(1_000_000) / 4, |name, m| {
        let (found, exact) = (pseudo_inverse_row_sums(*m), oracle::PseudoInverse::new(&matrix(&m.to_cols_array())));
        let right = (0..3).all(|i| is_rounded_quotient(found[i], &exact.row_sum(i), &exact.denominator));
        assert!(right, "{name}: {found} for {:?}", m.to_cols_array());
    });
    assert!(pseudo_inverse_row_sums(DMat3::NAN).is_nan());
}

/// A thousand matrices of each class, or 25,000 with `RT_LONG`: each costs as much as four of the others.
#[test]
fn answer_meets_the_penrose_conditions_within_its_rounding() {
    for_every_class(cases(250_000) / 10, |_, m| {
        let answer = pseudo_inverse(*m).matrix;
        if answer.is_finite() {
            assert_penrose_within_rounding(&matrix(&m.to_cols_array()), &matrix(&answer.to_cols_array()));
        }
    });
}
