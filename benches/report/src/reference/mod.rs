//! The exact answers: verdicts from exact arithmetic, values from 400 bits and then rounded once.
//!
//! It shares no code with the kernels: numbers of any length and exponent come from the library dashu, and every formula is
//! the plainest that is exact. Sums, differences and products are exact; only quotients, roots and angles round.

mod enclosing;
mod light;

use dashu::float::FBig;
use dashu::float::round::mode::HalfEven;

use super::methods::Answer;

pub(super) use enclosing::{enclosing, judge_enclosing};
pub(super) use light::{Lamp, phong, shade};

/// A binary number of any length.
pub(super) type Big = FBig<HalfEven, 2>;

/// Bits of what cannot be exact.
const BITS: usize = 400;

pub(super) fn exact(x: f64) -> Big {
    Big::try_from(x).expect("cases are finite").with_precision(0).value()
}

fn vector(case: &[f64], from: usize) -> [Big; 3] {
    [case[from], case[from + 1], case[from + 2]].map(exact)
}

fn dot(a: &[Big; 3], b: &[Big; 3]) -> Big {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

pub(super) fn sub(a: &[Big; 3], b: &[Big; 3]) -> [Big; 3] {
    [0, 1, 2].map(|i| &a[i] - &b[i])
}

pub(super) fn cross(a: &[Big; 3], b: &[Big; 3]) -> [Big; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &a[i] * &b[j] - &a[j] * &b[i])
}

fn is_zero(a: &Big) -> bool {
    *a == Big::ZERO
}

fn is_negative(a: &Big) -> bool {
    *a < Big::ZERO
}

/// Cuts a number to [`BITS`], for what is not exact.
pub(super) fn long(a: &Big) -> Big {
    a.clone().with_precision(BITS).value()
}

fn quotient(a: &Big, b: &Big) -> Big {
    long(a) / long(b)
}

fn root(a: &Big) -> Big {
    long(a).sqrt()
}

/// Returns the double nearest to a number, ties to even; beyond the range it is infinite.
pub(super) fn rounded(a: &Big) -> f64 {
    let size = if is_negative(a) { -a } else { a.clone() };
    if size >= exact(2.0 * f64::MIN_POSITIVE) {
        return a.to_f64().value();
    }
    // Where doubles are evenly spaced, dashu 0.6 rounds 0.57 of the spacing down; so this counts spacings.
    let root_of_their_number = exact(2f64.powi(537));
    let spacings = size * &root_of_their_number * &root_of_their_number;
    let below = spacings.floor();
    let (rest, half) = (spacings - &below, exact(0.5));
    let count = below.to_f64().value();
    let up = rest > half || (rest == half && count % 2.0 != 0.0);
    let magnitude = (count + f64::from(u8::from(up))) * f64::from_bits(1);
    if is_negative(a) { -magnitude } else { magnitude }
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
    let offset = sub(&vector(case, 0), &vector(case, 6));
    hit(nearest_root(&vector(case, 3), &offset, &exact(case[9])))
}

fn hit(t: Option<Big>) -> Answer<1> {
    t.map_or(Answer::without_values(0), |t| Answer { verdict: 1, values: [rounded(&t)] })
}

/// The smallest `t >= 0` at which a ray hits a sphere; `offset` leads from the center to the origin of the ray.
pub(super) fn nearest_root(direction: &[Big; 3], offset: &[Big; 3], radius: &Big) -> Option<Big> {
    let a = dot(direction, direction);
    let b = exact(2.0) * dot(direction, offset);
    let c = dot(offset, offset) - radius * radius;
    let discriminant = &b * &b - exact(4.0) * &a * &c;
    if is_negative(&discriminant) {
        return None;
    }
    let (x, y) = roots(&a, &b, &c, &discriminant);
    let (near, far) = if x < y { (x, y) } else { (y, x) };
    [near, far].into_iter().find(|t| !is_negative(t))
}

/// Whether a ray hits a closed triangle with an area at some `t >= 0`, and `t`.
pub(super) fn triangle(case: &[f64; 15]) -> Answer<1> {
    let origin = vector(case, 0);
    hit(crossing(&vector(case, 3), &[6, 9, 12].map(|from| sub(&vector(case, from), &origin))))
}

/// The `t >= 0` at which a ray hits a closed triangle with an area, whose vertices are seen from the origin of the ray.
pub(super) fn crossing(direction: &[Big; 3], [a, b, c]: &[[Big; 3]; 3]) -> Option<Big> {
    let normal = cross(&sub(b, a), &sub(c, a));
    let facing = dot(&normal, direction);
    if is_zero(&facing) {
        return None;
    }
    let against = |x: &Big| !is_zero(x) && is_negative(x) != is_negative(&facing);
    let volumes = [(a, b), (b, c), (c, a)].map(|(p, q)| dot(direction, &cross(p, q)));
    let ahead = dot(&normal, a);
    let miss = volumes.iter().any(against) || against(&ahead);
    (!miss).then(|| quotient(&ahead, &facing))
}

/// The point of a ray at `t`, in [`BITS`].
pub(super) fn point_at(origin: &[Big; 3], direction: &[Big; 3], t: &Big) -> [Big; 3] {
    [0, 1, 2].map(|i| long(&(&origin[i] + t * &direction[i])))
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

/// Whether a line hits a closed triangle with an area, and the weights of the vertices there.
pub(super) fn barycentric(case: &[f64; 15]) -> Answer<3> {
    let (origin, direction) = (vector(case, 0), vector(case, 3));
    let vertices = [6, 9, 12].map(|from| sub(&vector(case, from), &origin));
    match weights(&direction, &vertices) {
        Some(weights) => Answer { verdict: 1, values: weights.each_ref().map(rounded) },
        None => Answer::without_values(0),
    }
}

/// The weights of the vertices, seen from the origin, where a line through it meets their closed triangle.
pub(super) fn weights(direction: &[Big; 3], [a, b, c]: &[[Big; 3]; 3]) -> Option<[Big; 3]> {
    let facing = dot(&cross(&sub(b, a), &sub(c, a)), direction);
    // In sum they are `facing`.
    let volumes = [(b, c), (c, a), (a, b)].map(|(p, q)| dot(direction, &cross(p, q)));
    let against = |x: &Big| !is_zero(x) && is_negative(x) != is_negative(&facing);
    let hit = !is_zero(&facing) && !volumes.iter().any(against);
    hit.then(|| volumes.map(|volume| quotient(&volume, &facing)))
}

/// A matrix of exact numbers, by columns.
type Matrix = [[Big; 3]; 3];

/// The rank of a matrix, and its pseudo-inverse as exact numerators, by columns, over one denominator.
fn exact_pseudo_inverse(columns: &Matrix) -> (u8, Matrix, Big) {
    let at = |row: usize, column: usize| &columns[column][row];
    let [a, b, c] = columns;
    let minors = [cross(b, c), cross(c, a), cross(a, b)];
    let determinant = dot(a, &minors[0]);
    // Frobenius norms, squared, of the matrix and of its minors: the first two symmetric functions of σ².
    let squares = |rows: &Matrix| rows.iter().map(|row| dot(row, row)).fold(Big::ZERO, |sum, x| sum + x);
    let (s1, s2) = (squares(columns), squares(&minors));
    let matrix = |entry: &dyn Fn(usize, usize) -> Big| [0, 1, 2].map(|column| [0, 1, 2].map(|row| entry(row, column)));
    if !is_zero(&determinant) {
        (3, matrix(&|row, column| minors[row][column].clone()), determinant)
    } else if !is_zero(&s2) {
        // A⁺ = (s1 Aᵀ - Aᵀ A Aᵀ) / s2
        let gram = |i: usize, j: usize| dot(&columns[i], &columns[j]);
        let entry = |row: usize, column: usize| {
            let cube = (0..3).map(|k| gram(row, k) * at(column, k)).fold(Big::ZERO, |sum, x| sum + x);
            &s1 * at(column, row) - cube
        };
        (2, matrix(&entry), s2)
    } else if !is_zero(&s1) {
        (1, matrix(&|row, column| at(column, row).clone()), s1)
    } else {
        (0, matrix(&|_, _| Big::ZERO), exact(1.0))
    }
}

/// The rank of a 3x3 matrix and its pseudo-inverse, by columns.
pub(super) fn pseudo_inverse(case: &[f64; 9]) -> Answer<9> {
    let (rank, numerators, denominator) = exact_pseudo_inverse(&[0, 3, 6].map(|from| vector(case, from)));
    let entry = |i: usize| rounded(&quotient(&numerators[i / 3][i % 3], &denominator));
    Answer { verdict: rank, values: std::array::from_fn(entry) }
}

/// The coefficients of the plane `ax + by + cz = 1` nearest to three vertices: the pseudo-inverse of the matrix of rows
/// times `(1, 1, 1)`.
pub(super) fn plane(case: &[f64; 9]) -> Answer<3> {
    let rows = [0, 3, 6].map(|from| vector(case, from));
    let columns = [0, 1, 2].map(|i| [0, 1, 2].map(|k| rows[k][i].clone()));
    let (_, [a, b, c], denominator) = exact_pseudo_inverse(&columns);
    let coefficient = |i: usize| rounded(&quotient(&(&a[i] + &b[i] + &c[i]), &denominator));
    Answer { verdict: 0, values: [0, 1, 2].map(coefficient) }
}

/// A vector mirrored in the plane with a normal that is not zero.
pub(super) fn reflection(case: &[f64; 6]) -> Answer<3> {
    let (v, n) = (vector(case, 0), vector(case, 3));
    let (vn, nn) = (exact(2.0) * dot(&v, &n), dot(&n, &n));
    Answer { verdict: 0, values: [0, 1, 2].map(|i| rounded(&quotient(&(&v[i] * &nn - &vn * &n[i]), &nn))) }
}

/// The texture coordinates of a normal that is not zero.
pub(super) fn mapping(case: &[f64; 3]) -> Answer<2> {
    let signs = case.map(f64::is_sign_negative);
    Answer { verdict: 0, values: coordinates(&case.map(|c| long(&exact(c))), signs).each_ref().map(rounded) }
}

/// The same for a normal whose zeros have the given signs.
pub(super) fn coordinates([x, y, z]: &[Big; 3], [x_negative, _, z_negative]: [bool; 3]) -> [Big; 2] {
    let half_turn = Big::pi(BITS);
    let turn = &half_turn * long(&exact(2.0));
    let u = match (is_zero(z), x_negative, z_negative) {
        (true, false, _) => exact(0.5),
        (true, true, false) => exact(1.0),
        (true, true, true) => Big::ZERO,
        // Counted from the seam: equal to ½ + atan2(z, x) / turn, without its cancellation.
        (false, true, true) => (-z).atan2(&-x) / &turn,
        _ => long(&exact(0.5)) + z.atan2(x) / &turn,
    };
    let h = root(&(x * x + z * z));
    let v = if is_zero(&h) { exact(if is_negative(y) { 1.0 } else { 0.0 }) } else { h.atan2(y) / half_turn };
    [u, v]
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
        assert_eq!(inside(&[0.5, 0.5, 7.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]).verdict, 1, "on an edge");
        let inverse = pseudo_inverse(&[2.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!((inverse.verdict, inverse.values[0], inverse.values[4]), (2, 0.5, 0.25));
        assert_eq!(reflection(&[1.0, -1.0, 0.0, 0.0, 5.0, 0.0]).values, [1.0, 1.0, 0.0]);
        assert_eq!(mapping(&[3.0, 0.0, -3.0]).values, [0.375, 0.5]);
        assert_eq!(mapping(&[-1.0, 0.0, -0.0]).values, [0.0, 0.5]);
    }

    #[test]
    fn values_at_the_ends_of_the_range_round_as_doubles_do() {
        // 3 x = 2^-1074: the root underflows to zero; 2 x = 3 2^-1074 is halfway and goes to even.
        let tiny = f64::from_bits(1);
        assert_eq!(quadratic(&[0.0, 3.0, -tiny]).values[0], 0.0);
        assert_eq!(quadratic(&[0.0, 2.0, -3.0 * tiny]).values[0], 2.0 * tiny);
        assert_eq!(quadratic(&[0.0, tiny, -1.0]).values[0], f64::INFINITY);
        let share = |part: f64, of: f64| rounded(&(quotient(&exact(part), &exact(of)) * exact(tiny)));
        let shares = [(-172.0, -1.0), (86.0, 1.0), (75.0, 0.0), (76.0, 1.0), (149.0, 1.0), (225.0, 2.0)];
        for (part, expected) in shares {
            assert_eq!(share(part, 150.0), expected * tiny, "{part}/150 of the least double");
        }
        let edge = f64::MIN_POSITIVE.next_down();
        assert_eq!([edge, -edge, 2.0 * edge].map(|x| rounded(&exact(x))), [edge, -edge, 2.0 * edge]);
    }
}
