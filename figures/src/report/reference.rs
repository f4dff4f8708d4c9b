//! The exact answers: verdicts from exact arithmetic, values from 400 bits and then rounded once.
//!
//! It shares no code with the kernels: numbers of any length and exponent come from the library dashu, and every formula is
//! the plainest that is exact. Sums, differences and products are exact; only quotients, roots and angles round.

use dashu::float::FBig;
use dashu::float::round::mode::HalfEven;

use super::methods::{Answer, COUNT};

/// A binary number of any length.
type Big = FBig<HalfEven, 2>;

/// Bits of what cannot be exact.
const BITS: usize = 400;

fn exact(x: f64) -> Big {
    Big::try_from(x).expect("cases are finite").with_precision(0).value()
}

fn vector(case: &[f64], from: usize) -> [Big; 3] {
    [case[from], case[from + 1], case[from + 2]].map(exact)
}

fn dot(a: &[Big; 3], b: &[Big; 3]) -> Big {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn sub(a: &[Big; 3], b: &[Big; 3]) -> [Big; 3] {
    [0, 1, 2].map(|i| &a[i] - &b[i])
}

fn cross(a: &[Big; 3], b: &[Big; 3]) -> [Big; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &a[i] * &b[j] - &a[j] * &b[i])
}

fn is_zero(a: &Big) -> bool {
    *a == Big::ZERO
}

fn is_negative(a: &Big) -> bool {
    *a < Big::ZERO
}

/// Cuts a number to [`BITS`], for what is not exact.
fn long(a: &Big) -> Big {
    a.clone().with_precision(BITS).value()
}

fn quotient(a: &Big, b: &Big) -> Big {
    long(a) / long(b)
}

fn root(a: &Big) -> Big {
    long(a).sqrt()
}

/// Returns the double nearest to a number; beyond the range it is infinite.
fn rounded(a: &Big) -> f64 {
    a.to_f64().value()
}

/// The number of roots and the roots of `a x² + b x + c`.
pub(super) fn quadratic(case: &[f64; 3]) -> Answer<2> {
    let [a, b, c] = case.map(exact);
    if is_zero(&a) {
        return match (is_zero(&b), is_zero(&c)) {
            (true, true) => Answer::without_values(3),
            (true, false) => Answer::without_values(0),
            _ => Answer { verdict: 1, values: [positive_zero(rounded(&quotient(&-c, &b))), f64::NAN] },
        };
    }
    let discriminant = &b * &b - exact(4.0) * &a * &c;
    if is_negative(&discriminant) {
        return Answer::without_values(0);
    }
    let (x, y) = roots(&a, &b, &c, &discriminant);
    if is_zero(&discriminant) {
        return Answer { verdict: 1, values: [positive_zero(rounded(&x)), f64::NAN] };
    }
    let (x, y) = if x < y { (x, y) } else { (y, x) };
    Answer { verdict: 2, values: [rounded(&x), rounded(&y)].map(positive_zero) }
}

/// The roots, none of them by a subtraction: `q = -(b ± √D)` with the sign of `b`, then `q / 2a` and `2c / q`.
fn roots(a: &Big, b: &Big, c: &Big, discriminant: &Big) -> (Big, Big) {
    let root = root(discriminant);
    let q = if is_negative(b) { root - b } else { -(root + b) };
    let first = quotient(&q, &(exact(2.0) * a));
    let second = if is_zero(&q) { first.clone() } else { quotient(&(exact(2.0) * c), &q) };
    (first, second)
}

/// An error is a distance between numbers, and the zeros are one number.
fn positive_zero(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x }
}

/// Whether a ray hits a sphere at some `t >= 0`, and the smallest such `t`.
pub(super) fn sphere(case: &[f64; 10]) -> Answer<1> {
    let (direction, radius) = (vector(case, 3), exact(case[9]));
    let offset = sub(&vector(case, 0), &vector(case, 6));
    let a = dot(&direction, &direction);
    let b = exact(2.0) * dot(&direction, &offset);
    let c = dot(&offset, &offset) - &radius * &radius;
    let discriminant = &b * &b - exact(4.0) * &a * &c;
    if is_negative(&discriminant) {
        return Answer::without_values(0);
    }
    let (x, y) = roots(&a, &b, &c, &discriminant);
    let (near, far) = if x < y { (x, y) } else { (y, x) };
    match [near, far].into_iter().find(|t| !is_negative(t)) {
        Some(t) => Answer { verdict: 1, values: [rounded(&t)] },
        None => Answer::without_values(0),
    }
}

/// Whether a ray hits a closed triangle with an area at some `t >= 0`, and `t`.
pub(super) fn triangle(case: &[f64; 15]) -> Answer<1> {
    let (origin, direction) = (vector(case, 0), vector(case, 3));
    let [a, b, c] = [6, 9, 12].map(|from| sub(&vector(case, from), &origin));
    let normal = cross(&sub(&b, &a), &sub(&c, &a));
    let facing = dot(&normal, &direction);
    if is_zero(&facing) {
        return Answer::without_values(0);
    }
    let against = |x: &Big| !is_zero(x) && is_negative(x) != is_negative(&facing);
    let volumes = [(&a, &b), (&b, &c), (&c, &a)].map(|(p, q)| dot(&direction, &cross(p, q)));
    let ahead = dot(&normal, &a);
    if volumes.iter().any(against) || against(&ahead) {
        return Answer::without_values(0);
    }
    Answer { verdict: 1, values: [rounded(&quotient(&ahead, &facing))] }
}

/// Whether the projection of a point lies in a closed triangle with an area.
pub(super) fn inside(case: &[f64; 12]) -> Answer<0> {
    let point = vector(case, 0);
    let [a, b, c] = [3, 6, 9].map(|from| vector(case, from));
    let normal = cross(&sub(&b, &a), &sub(&c, &a));
    let flat = normal.iter().all(is_zero);
    let outside = [(&a, &b), (&b, &c), (&c, &a)]
        .iter()
        .any(|(p, q)| is_negative(&dot(&normal, &cross(&sub(q, p), &sub(&point, p)))));
    Answer::without_values(u8::from(!flat && !outside))
}

/// The rank of a 3x3 matrix and its pseudo-inverse, by columns.
pub(super) fn pseudo_inverse(case: &[f64; 9]) -> Answer<9> {
    let columns = [0, 3, 6].map(|from| vector(case, from));
    let at = |row: usize, column: usize| &columns[column][row];
    let [a, b, c] = &columns;
    let minors = [cross(b, c), cross(c, a), cross(a, b)];
    let determinant = dot(a, &minors[0]);
    // Frobenius norms, squared, of the matrix and of its minors: the first two symmetric functions of σ².
    let squares =
        |rows: &[[Big; 3]; 3]| rows.iter().map(|row| dot(row, row)).fold(Big::ZERO, |sum, x| sum + x);
    let (s1, s2) = (squares(&columns), squares(&minors));
    let (rank, entry): (u8, Box<dyn Fn(usize, usize) -> Big>) = if !is_zero(&determinant) {
        (3, Box::new(|row, column| quotient(&minors[row][column], &determinant)))
    } else if !is_zero(&s2) {
        // A⁺ = (s1 Aᵀ - Aᵀ A Aᵀ) / s2
        let gram = |i: usize, j: usize| dot(&columns[i], &columns[j]);
        (
            2,
            Box::new(move |row, column| {
                let cube = (0..3).map(|k| gram(row, k) * at(column, k)).fold(Big::ZERO, |sum, x| sum + x);
                quotient(&(&s1 * at(column, row) - cube), &s2)
            }),
        )
    } else if !is_zero(&s1) {
        (1, Box::new(|row, column| quotient(at(column, row), &s1)))
    } else {
        (0, Box::new(|_, _| Big::ZERO))
    };
    Answer { verdict: rank, values: std::array::from_fn(|i| rounded(&entry(i % 3, i / 3))) }
}

/// A vector mirrored in the plane with a normal that is not zero.
pub(super) fn reflection(case: &[f64; 6]) -> Answer<3> {
    let (v, n) = (vector(case, 0), vector(case, 3));
    let (vn, nn) = (exact(2.0) * dot(&v, &n), dot(&n, &n));
    Answer { verdict: 0, values: [0, 1, 2].map(|i| rounded(&quotient(&(&v[i] * &nn - &vn * &n[i]), &nn))) }
}

/// The texture coordinates of a normal that is not zero.
pub(super) fn mapping(case: &[f64; 3]) -> Answer<2> {
    let [x, y, z] = case.map(|c| long(&exact(c)));
    let half_turn = Big::pi(BITS);
    let turn = &half_turn * long(&exact(2.0));
    let (x_negative, z_negative) = (case[0].is_sign_negative(), case[2].is_sign_negative());
    let u = match (case[2] == 0.0, x_negative, z_negative) {
        (true, false, _) => exact(0.5),
        (true, true, false) => exact(1.0),
        (true, true, true) => Big::ZERO,
        // Counted from the seam: equal to ½ + atan2(z, x) / turn, without its cancellation.
        (false, true, true) => (-&z).atan2(&-&x) / &turn,
        _ => long(&exact(0.5)) + z.atan2(&x) / &turn,
    };
    let h = root(&(&x * &x + &z * &z));
    let v = if is_zero(&h) { exact(if case[1] > 0.0 { 0.0 } else { 1.0 }) } else { h.atan2(&y) / half_turn };
    Answer { verdict: 0, values: [rounded(&u), rounded(&v)] }
}

/// The radius of the smallest sphere around spheres: of all spheres that one to four of them determine, the smallest that
/// holds the others. The verdict is 1: every sphere is inside.
pub(super) fn enclosing(case: &[f64; 4 * COUNT]) -> Answer<4> {
    let balls: Vec<([Big; 3], Big)> =
        (0..COUNT).map(|i| (vector(case, 4 * i).map(|x| long(&x)), long(&exact(case[4 * i + 3])))).collect();
    let mut smallest: Option<Big> = None;
    for subset in 1u32..1 << COUNT {
        if subset.count_ones() > 4 {
            continue;
        }
        let chosen: Vec<_> = (0..COUNT).filter(|i| subset >> i & 1 == 1).map(|i| &balls[i]).collect();
        for (center, radius) in tangent_around(&chosen) {
            let better = smallest.as_ref().is_none_or(|smallest| radius < *smallest);
            // What 400 bits cannot tell from touching, touches.
            let reach = &radius * (long(&exact(1.0)) + Big::from_parts(1.into(), -200));
            let holds = |(other, r): &([Big; 3], Big)| {
                let (room, offset) = (&reach - r, sub(&center, other));
                !is_negative(&room) && dot(&offset, &offset) <= &room * &room
            };
            if better && balls.iter().all(holds) {
                smallest = Some(radius);
            }
        }
    }
    let radius = smallest.map_or(f64::NAN, |radius| rounded(&radius));
    Answer { verdict: 1, values: [f64::NAN, f64::NAN, f64::NAN, radius] }
}

/// Returns the spheres, at most two, that touch all the given ones from outside with the center in their span.
fn tangent_around(balls: &[&([Big; 3], Big)]) -> Vec<([Big; 3], Big)> {
    let (first, r) = balls[0];
    if balls.len() == 1 {
        return vec![(first.clone(), r.clone())];
    }
    // The center is first + x, x = Σ λ_j e_j; |x - e_j| = R - r_j and |x| = R - r give 2 e_j·x = p_j + q_j R.
    let edges: Vec<[Big; 3]> = balls[1..].iter().map(|(center, _)| sub(center, first)).collect();
    let two = long(&exact(2.0));
    let p: Vec<Big> = edges.iter().zip(&balls[1..]).map(|(e, (_, s))| dot(e, e) + r * r - s * s).collect();
    let q: Vec<Big> = balls[1..].iter().map(|(_, s)| &two * (s - r)).collect();
    let gram: Vec<Vec<Big>> =
        edges.iter().map(|e| edges.iter().map(|f| &two * dot(e, f)).collect()).collect();
    let (Some(p), Some(q)) = (solve(&gram, &p), solve(&gram, &q)) else {
        return Vec::new();
    };
    let combine = |weights: &[Big]| {
        [0, 1, 2].map(|i| edges.iter().zip(weights).map(|(e, w)| &e[i] * w).fold(Big::ZERO, |sum, x| sum + x))
    };
    let (start, slope) = (combine(&p), combine(&q));
    // |start + R slope|² = (R - r)²
    let a = dot(&slope, &slope) - long(&exact(1.0));
    let b = &two * (dot(&start, &slope) + r);
    let c = dot(&start, &start) - r * r;
    let discriminant = &b * &b - &two * &two * &a * &c;
    if is_zero(&a) || is_negative(&discriminant) {
        return Vec::new();
    }
    let (x, y) = roots(&a, &b, &c, &discriminant);
    let large_enough = |radius: &Big| balls.iter().all(|(_, s)| radius >= s);
    let center = |radius: &Big| [0, 1, 2].map(|i| &first[i] + &start[i] + radius * &slope[i]);
    [x, y].into_iter().filter(large_enough).map(|radius| (center(&radius), radius)).collect()
}

/// Solves linear equations by elimination; `None` if the matrix is singular.
fn solve(matrix: &[Vec<Big>], right: &[Big]) -> Option<Vec<Big>> {
    let n = right.len();
    let mut rows: Vec<Vec<Big>> =
        matrix.iter().zip(right).map(|(row, x)| [row.clone(), vec![x.clone()]].concat()).collect();
    // What is left of a singular matrix after rounding is far below this.
    let scale = rows.iter().flatten().map(|x| if is_negative(x) { -x } else { x.clone() }).max()?;
    let tiny = scale * Big::from_parts(1.into(), -250);
    for i in 0..n {
        let pivot = (i..n).find(|&k| rows[k][i] > tiny || -&rows[k][i] > tiny)?;
        rows.swap(i, pivot);
        for k in 0..n {
            if k != i {
                let factor = &rows[k][i] / &rows[i][i];
                let pivot_row = rows[i].clone();
                for (x, above) in rows[k].iter_mut().zip(&pivot_row) {
                    *x = &*x - &factor * above;
                }
            }
        }
    }
    Some((0..n).map(|i| &rows[i][n] / &rows[i][i]).collect())
}

/// Judges an answer for spheres: the verdict is 1 if the sphere found holds every other, exactly.
pub(super) fn judge_enclosing(case: &[f64; 4 * COUNT], answer: Answer<4>) -> Answer<4> {
    let [x, y, z, radius] = answer.values;
    let values = [f64::NAN, f64::NAN, f64::NAN, radius];
    if ![x, y, z, radius].iter().all(|value| value.is_finite()) {
        return Answer { verdict: 0, values };
    }
    let (center, radius) = ([x, y, z].map(exact), exact(radius));
    let holds = (0..COUNT).all(|i| {
        let (room, offset) = (&radius - exact(case[4 * i + 3]), sub(&vector(case, 4 * i), &center));
        !is_negative(&room) && dot(&offset, &offset) <= &room * &room
    });
    Answer { verdict: u8::from(holds), values }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_answers_are_found() {
        let roots = quadratic(&[1.0, -3.0, 2.0]);
        assert_eq!((roots.verdict, roots.values), (2, [1.0, 2.0]));
        assert_eq!(quadratic(&[1.0, 2.0, 1.0]).verdict, 1);
        assert_eq!(quadratic(&[1.0, 2.0, 1.0 + f64::EPSILON]).verdict, 0);
        assert_eq!(quadratic(&[0.0, 0.0, 0.0]).verdict, 3);
        let hit = sphere(&[0.0, 0.0, 5.0, 0.0, 0.0, -2.0, 0.0, 0.0, 0.0, 1.0]);
        assert_eq!((hit.verdict, hit.values), (1, [2.0]));
        assert_eq!(sphere(&[0.0, 0.0, 5.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 1.0]).verdict, 0, "behind");
        assert_eq!(sphere(&[1.0, 0.0, 5.0, 0.0, 0.0, -2.0, 0.0, 0.0, 0.0, 1.0]).values, [2.5], "tangent");
        let corner = [0.0, 0.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        assert_eq!(triangle(&corner).values, [1.0], "through a vertex");
        assert_eq!(
            inside(&[0.5, 0.5, 7.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]).verdict,
            1,
            "on an edge"
        );
        let inverse = pseudo_inverse(&[2.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!((inverse.verdict, inverse.values[0], inverse.values[4]), (2, 0.5, 0.25));
        assert_eq!(reflection(&[1.0, -1.0, 0.0, 0.0, 5.0, 0.0]).values, [1.0, 1.0, 0.0]);
        assert_eq!(mapping(&[3.0, 0.0, -3.0]).values, [0.375, 0.5]);
        assert_eq!(mapping(&[-1.0, 0.0, -0.0]).values, [0.0, 0.5]);
    }

    #[test]
    fn the_smallest_sphere_around_points_of_a_cube_is_found() {
        let corners: Vec<f64> = (0..8).flat_map(|i| [i & 1, i >> 1 & 1, i >> 2, 0].map(f64::from)).collect();
        let case: [f64; 4 * COUNT] = corners.try_into().expect("eight corners");
        let found = enclosing(&case);
        assert_eq!((found.verdict, found.values[3]), (1, 0.75f64.sqrt()));
        let holds =
            |radius| judge_enclosing(&case, Answer { verdict: 1, values: [0.5, 0.5, 0.5, radius] }).verdict;
        assert_eq!((holds(0.866_025_403), holds(0.866_025_404)), (0, 1));
    }

    #[test]
    fn values_at_the_ends_of_the_range_round_as_doubles_do() {
        // 3 x = 2^-1074: the root underflows to zero; 2 x = 3 2^-1074 is halfway and goes to even.
        let tiny = f64::from_bits(1);
        assert_eq!(quadratic(&[0.0, 3.0, -tiny]).values[0], 0.0);
        assert_eq!(quadratic(&[0.0, 2.0, -3.0 * tiny]).values[0], 2.0 * tiny);
        assert_eq!(quadratic(&[0.0, tiny, -1.0]).values[0], f64::INFINITY);
    }
}
