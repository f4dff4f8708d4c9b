//! The rank is exact and every entry of the pseudo-inverse is correctly rounded, for every finite matrix.
//!
//! 10^4 matrices of each class; `RT_LONG=1 cargo test --release -p rt-math --test pseudo_inverse` runs 10^6 of each.

mod matrices;
mod oracle;

use glam::DMat3;
use matrices::{CLASSES, Random};
use rt_math::{PseudoInverse, pseudo_inverse, pseudo_inverse_row_sums};

/// Matrices per class: 10^4, or 10^6 with `RT_LONG` in the environment.
fn cases() -> usize {
    if std::env::var_os("RT_LONG").is_some() { 1_000_000 } else { 10_000 }
}

/// Matrices per class for the Penrose conditions, each of which costs as much as four of the others: 10^3, or 25,000.
fn penrose_cases() -> usize {
    if std::env::var_os("RT_LONG").is_some() { 25_000 } else { 1000 }
}

fn check(name: &str, m: &DMat3) {
    let exact = oracle::pseudo_inverse(m);
    let PseudoInverse { matrix, rank } = pseudo_inverse(*m);
    assert_eq!(rank, exact.rank, "{name}: rank of {:?}", m.to_cols_array());
    for i in 0..3 {
        for j in 0..3 {
            let (found, expected) = (matrix.col(j)[i], exact.rounded(i, j));
            assert!(
                found.to_bits() == expected.to_bits(),
                "{name}: entry {i} {j} is {found:e}, not {expected:e}, for {:?}",
                m.to_cols_array()
            );
        }
    }
}

/// Runs `check` on `cases()` matrices of every class, the classes shared out over the processors.
fn for_every_class(cases: usize, check: impl Fn(&str, &DMat3) + Sync) {
    let next = std::sync::atomic::AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                while let Some((name, class)) = CLASSES.get(next.fetch_add(1, std::sync::atomic::Ordering::Relaxed)) {
                    let mut random = Random(name.len() as u64);
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
    for_every_class(cases(), check);
}

#[test]
fn row_sums_are_correctly_rounded() {
    for_every_class(cases() / 4, |name, m| {
        let (found, exact) = (pseudo_inverse_row_sums(*m), oracle::pseudo_inverse(m));
        for i in 0..3 {
            let expected = exact.rounded_row_sum(i);
            assert!(
                found[i].to_bits() == expected.to_bits(),
                "{name}: sum {i} is {:e}, not {expected:e}, for {:?}",
                found[i],
                m.to_cols_array()
            );
        }
    });
    assert!(pseudo_inverse_row_sums(DMat3::NAN).is_nan());
}

#[test]
fn oracle_meets_the_penrose_conditions_exactly() {
    for_every_class(penrose_cases(), |_, m| oracle::pseudo_inverse(m).assert_penrose(m));
}

#[test]
fn answer_meets_the_penrose_conditions_within_its_rounding() {
    for_every_class(penrose_cases(), |_, m| {
        let answer = pseudo_inverse(*m).matrix;
        if answer.is_finite() {
            oracle::assert_penrose_within_rounding(m, &answer);
        }
    });
}

#[test]
fn matrices_of_every_rank_are_tested() {
    let mut ranks = [0; 4];
    for (_, class) in CLASSES {
        let mut random = Random(1);
        for _ in 0..1000 {
            ranks[pseudo_inverse(class(&mut random)).rank] += 1;
        }
    }
    assert!(ranks.iter().all(|&count| count >= 1000), "{ranks:?}");
}
