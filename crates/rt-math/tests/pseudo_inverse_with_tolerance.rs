//! `pseudo_inverse_with_tolerance` drops the singular values that it should and keeps its stated accuracy.
//!
//! The references are matrices with known singular values and vectors, made of rational rotations, so that neither they
//! nor their truncated pseudo-inverses come from another algorithm; and the exact function, where nothing is dropped.

use glam::{DMat3, DVec3};
use oracle::matrices::CLASSES;
use oracle::{Random, cases};
use rt_math::{PseudoInverse, pseudo_inverse, pseudo_inverse_with_tolerance};

/// Matrices per class: 10^4, or 10^6 with `RT_LONG` in the environment.
const LONG: usize = 1_000_000;

fn bits(answer: &PseudoInverse) -> (usize, [u64; 9]) {
    (answer.rank, answer.matrix.to_cols_array().map(f64::to_bits))
}

fn outer(u: DVec3, v: DVec3) -> DMat3 {
    DMat3::from_cols(u * v.x, u * v.y, u * v.z)
}

/// Three orthogonal vectors of whole numbers up to 64, and their common squared length, from Euler's four parameters.
fn rotation(random: &mut Random) -> ([DVec3; 3], f64) {
    loop {
        let [a, b, c, d] = [(); 4].map(|()| random.small(4));
        let n = a * a + b * b + c * c + d * d;
        if n > 0.0 {
            let x = DVec3::new(a * a + b * b - c * c - d * d, 2.0 * (b * c + a * d), 2.0 * (b * d - a * c));
            let y = DVec3::new(2.0 * (b * c - a * d), a * a - b * b + c * c - d * d, 2.0 * (c * d + a * b));
            let z = DVec3::new(2.0 * (b * d + a * c), 2.0 * (c * d - a * b), a * a - b * b - c * c + d * d);
            return ([x, y, z], n);
        }
    }
}

/// A matrix that is exact in doubles, and its singular values and vectors: `sum of value u v^T`, values descending.
struct Known {
    matrix: DMat3,
    values: [f64; 3],
    left: [DVec3; 3],
    right: [DVec3; 3],
}

fn known(random: &mut Random) -> Known {
    let ((u, n), (v, m)) = (rotation(random), rotation(random));
    // At most 12 + 38 + 2 bits in a sum of integers up to 64 64 2^38.
    let mut exponents = [(); 3].map(|()| random.integer(0..39));
    exponents.sort_by_key(|e| -e);
    let weights = exponents.map(|e| 2f64.powi(e));
    let terms = [0, 1, 2].map(|k| outer(u[k], v[k]) * weights[k]);
    Known {
        matrix: terms[0] + terms[1] + terms[2],
        values: weights.map(|weight| weight * n * m),
        left: u.map(|u| u / n),
        right: v.map(|v| v / m),
    }
}

impl Known {
    /// The pseudo-inverse of the part with the first `rank` singular values.
    fn truncated(&self, rank: usize) -> DMat3 {
        (0..rank)
            .rev()
            .map(|k| outer(self.right[k] / self.values[k], self.left[k]))
            .fold(DMat3::ZERO, |sum, term| sum + term)
    }
}

/// An upper bound of the spectral norm.
fn norm(m: &DMat3) -> f64 {
    (m.x_axis.length_squared() + m.y_axis.length_squared() + m.z_axis.length_squared()).sqrt()
}

#[test]
fn known_singular_values_are_dropped_and_the_rest_inverted() {
    let mut random = Random::new(1);
    let (mut worst, mut ranks) = (0.0f64, [0; 4]);
    for _ in 0..cases(LONG) {
        let known = known(&mut random);
        let ratio = [1.0, known.values[1] / known.values[0], known.values[2] / known.values[0], 0.0];
        for rank in 1..=3 {
            if ratio[rank - 1] == ratio[rank] {
                continue; // equal singular values go together
            }
            // Anywhere between the two, or close to one of them.
            let [low, high] = [ratio[rank], ratio[rank - 1]];
            let share = if random.below(2) == 0 { 0.99 * random.share() } else { 0.98 };
            let rtol = if random.below(4) == 0 && low > 0.0 { 1.01 * low } else { low + (high - low) * share };
            let answer = pseudo_inverse_with_tolerance(known.matrix, rtol);
            assert_eq!(answer.rank, rank, "{rtol:e} {:?}", known.matrix.to_cols_array());
            ranks[rank] += 1;
            let error = norm(&(answer.matrix - known.truncated(rank))) * known.values[rank - 1];
            let gap = 1.0 - (ratio[rank] / ratio[rank - 1]).powi(2);
            worst = worst.max(error * gap / f64::EPSILON);
        }
    }
    // The reference itself is a sum of rounded terms, within a few units.
    println!("largest error: {worst} epsilon; ranks {ranks:?}");
    assert!(worst <= 16.0, "{worst}");
    assert!(ranks[1] > cases(LONG) / 2 && ranks[2] > cases(LONG) / 2 && ranks[3] > cases(LONG) / 2, "{ranks:?}");
}

#[test]
fn tolerance_far_below_the_precision_of_a_double_is_kept() {
    // The second and third singular value are those of a 2 x 2 block, 2^-200 and less beside the first.
    let mut random = Random::new(2);
    for _ in 0..cases(LONG) {
        let (a, b) = (random.whole(1, 9), random.whole(1, 9));
        let (small, ratio) = (2f64.powi(-200), random.power(1..21));
        // (a, b) and (-b, a) are orthogonal, of length^2 n.
        let n = a * a + b * b;
        let (first, second) = (DVec3::new(0.0, a, b), DVec3::new(0.0, -b, a));
        let block = (outer(first, first) * ratio + outer(second, second)) * small;
        let (matrix, one) = (outer(DVec3::X, DVec3::X) + block, outer(DVec3::X, DVec3::X));
        let values = [1.0, n * ratio * small, n * small];

        let answer = pseudo_inverse_with_tolerance(matrix, values[2] * 1.01);
        assert_eq!(answer.rank, 2, "{matrix}");
        let error = answer.matrix - (one + outer(first, first) * (1.0 / (n * values[1])));
        assert!(norm(&error) * values[1] <= 64.0 * f64::EPSILON, "{matrix}");

        let answer = pseudo_inverse_with_tolerance(matrix, values[1] * 1.01);
        assert_eq!((answer.rank, answer.matrix), (1, one), "{matrix}");
        let answer = pseudo_inverse_with_tolerance(matrix, values[2] * 0.99);
        assert_eq!(bits(&answer), bits(&pseudo_inverse(matrix)), "{matrix}");
    }
}

#[test]
fn singular_values_beyond_the_range_of_doubles_are_dropped() {
    // Beside the first value, the third is below the smallest double.
    let matrix = DMat3::from_diagonal(DVec3::new(2f64.powi(500), 1.0, f64::from_bits(1)));
    for (rtol, values, rank) in
        [(2f64.powi(-600), [2f64.powi(-500), 1.0], 2), (2f64.powi(-400), [2f64.powi(-500), 0.0], 1)]
    {
        let expected = DMat3::from_diagonal(DVec3::new(values[0], values[1], 0.0));
        let answer = pseudo_inverse_with_tolerance(matrix, rtol);
        assert_eq!((answer.rank, answer.matrix), (rank, expected), "{rtol:e}");
    }
    let matrix = DMat3::from_diagonal(DVec3::new(f64::MAX, f64::from_bits(1), 0.0));
    assert_eq!(pseudo_inverse_with_tolerance(matrix, 1e-200).rank, 1);
}

#[test]
fn without_anything_to_drop_the_answer_is_the_exact_one() {
    for (name, class) in CLASSES {
        let mut random = Random::new(3);
        for _ in 0..cases(LONG) / 10 {
            let m = class(&mut random);
            let exact = bits(&pseudo_inverse(m));
            for rtol in [0.0, -1.0, f64::NEG_INFINITY, 1e-280] {
                assert_eq!(bits(&pseudo_inverse_with_tolerance(m, rtol)), exact, "{name} {:?}", m.to_cols_array());
            }
            for rtol in [1.0, 1.5, f64::INFINITY] {
                let answer = bits(&pseudo_inverse_with_tolerance(m, rtol));
                assert_eq!(answer, (0, [0; 9]), "{name} {rtol} {:?}", m.to_cols_array());
            }
            assert!(pseudo_inverse_with_tolerance(m, f64::NAN).matrix.is_nan(), "{name}");
        }
    }
}

#[test]
fn a_matrix_of_exact_rank_two_has_the_exact_answer() {
    let mut random = Random::new(9);
    for _ in 0..cases(LONG) / 10 {
        // Of 30 bits each, so that the sum is exact.
        let mut column = || (2f64.powi(30) * random.point()).round();
        let (a, b) = (column(), column());
        let m = [DMat3::from_cols(a, b, a + b), DMat3::from_cols(a, a + b, b).transpose()][random.below(2)];
        let m = m * random.power(-80..80);
        let exact = pseudo_inverse(m);
        assert_eq!(exact.rank, 2, "{m}");
        for rtol in [1e-200, 1e-12, 1e-9] {
            assert_eq!(bits(&pseudo_inverse_with_tolerance(m, rtol)), bits(&exact), "{rtol:e} {m}");
        }
    }
}

#[test]
fn answer_is_the_pseudo_inverse_of_a_matrix_within_the_tolerance() {
    for (name, class) in CLASSES {
        let mut random = Random::new(4);
        for _ in 0..cases(LONG) / 10 {
            let m = class(&mut random);
            let rtol = 10f64.powf(-8.0 + 8.0 * random.uniform());
            let PseudoInverse { matrix: x, rank } = pseudo_inverse_with_tolerance(m, rtol);
            assert!(rank <= pseudo_inverse(m).rank, "{name} {:?}", m.to_cols_array());
            let in_range = |m: &DMat3| (1e-140..1e140).contains(&norm(m));
            if rank == 0 || !in_range(&m) || !in_range(&x) {
                continue;
            }
            // With X exact, X A X = X, X A and A X are symmetric, and |A - A X A| is the first value dropped.
            let condition = norm(&m) * norm(&x);
            let (ax, xa, tolerance) = (m * x, x * m, 64.0 * f64::EPSILON * condition);
            let message = || format!("{name} {rtol:e} {:?} {:?}", m.to_cols_array(), x.to_cols_array());
            assert!(norm(&(ax - ax.transpose())) <= tolerance, "{}", message());
            assert!(norm(&(xa - xa.transpose())) <= tolerance, "{}", message());
            assert!(norm(&(xa * x - x)) <= tolerance * norm(&x), "{}", message());
            assert!(norm(&(ax * m - m)) <= (2.0 * rtol + tolerance) * norm(&m), "{}", message());
        }
    }
}

#[test]
fn powers_of_two_scale_the_answer_exactly() {
    let mut random = Random::new(5);
    for _ in 0..cases(LONG) {
        let m = known(&mut random).matrix;
        let rtol = 10f64.powf(-6.0 + 6.0 * random.uniform());
        let answer = pseudo_inverse_with_tolerance(m, rtol);
        for exponent in [-1000, -300, 300, 900] {
            let factor = 2f64.powi(exponent);
            let scaled = pseudo_inverse_with_tolerance(m * factor, rtol);
            let expected = PseudoInverse { matrix: answer.matrix * 2f64.powi(-exponent), rank: answer.rank };
            if expected.matrix.to_cols_array().iter().all(|x| *x == 0.0 || (x.abs() > 1e-290 && x.is_finite())) {
                assert_eq!(bits(&scaled), bits(&expected), "{exponent} {rtol:e} {:?}", m.to_cols_array());
            }
        }
    }
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for k in 0..9 {
            let mut entries = [1.0; 9];
            entries[k] = bad;
            let m = DMat3::from_cols_array(&entries);
            for answer in [pseudo_inverse(m), pseudo_inverse_with_tolerance(m, 1e-9)] {
                assert_eq!(answer.rank, 0, "{m}");
                assert!(answer.matrix.to_cols_array().iter().all(|x| x.is_nan()), "{m}");
            }
        }
    }
}
