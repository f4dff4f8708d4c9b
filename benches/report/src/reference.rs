//! The exact answers: the oracle's, for the numbers of a case, its values computed in 400 bits and then rounded once.

use std::cmp::Ordering;

use oracle::enclosing::{Ball, smallest_radius};
use oracle::{
    Big, Crossing, Lamp, Projection, PseudoInverse, Quadratic, Reflection, Vector, dot, exact, matrix, nearest_root,
    power_of_two, quotient, rounded, shade, sign, sub, uv, vector,
};

use super::methods::{Answer, COUNT, MATERIAL, SIDE};

fn part(case: &[f64], from: usize) -> Vector {
    vector([case[from], case[from + 1], case[from + 2]])
}

/// The verdict 1 and a value, or 0.
fn hit(t: Option<Big>) -> Answer<1> {
    t.map_or(Answer::without_values(0), |t| Answer { verdict: 1, values: [rounded(&t)] })
}

/// The number of roots and the roots of `a x² + b x + c`.
pub(super) fn quadratic(case: &[f64; 3]) -> Answer<2> {
    // An error is a distance between numbers, and the zeros are one number.
    let positive_zero = |x: f64| if x == 0.0 { 0.0 } else { x };
    let [a, b, c] = case.map(exact);
    let line = case[0] == 0.0;
    let equation = Quadratic { a, b, c };
    let count = equation.count();
    let values = match count {
        Some(1) if line => [rounded(&quotient(&-equation.c, &equation.b)), f64::NAN],
        Some(1) => [rounded(&equation.roots()[0]), f64::NAN],
        Some(2) => equation.roots().each_ref().map(rounded),
        _ => [f64::NAN; 2],
    };
    Answer { verdict: count.map_or(3, |count| [0, 1, 2][count]), values: values.map(positive_zero) }
}

/// Whether a ray hits a sphere at some `t >= 0`, and the smallest such `t`.
pub(super) fn sphere(case: &[f64; 10]) -> Answer<1> {
    hit(nearest_root(&part(case, 3), &sub(&part(case, 0), &part(case, 6)), &exact(case[9])))
}

/// The line and the triangle of a case.
fn line(case: &[f64; 15]) -> Crossing {
    let origin = part(case, 0);
    Crossing::new(&part(case, 3), [6, 9, 12].map(|from| sub(&part(case, from), &origin)))
}

/// Whether a ray hits a closed triangle with an area at some `t >= 0`, and `t`.
pub(super) fn triangle(case: &[f64; 15]) -> Answer<1> {
    hit(line(case).t())
}

/// Whether a line hits a closed triangle with an area, and the weights of the vertices there.
pub(super) fn barycentric(case: &[f64; 15]) -> Answer<3> {
    let weights = line(case).weights();
    weights.map_or(Answer::without_values(0), |w| Answer { verdict: 1, values: w.each_ref().map(rounded) })
}

/// Whether the projection of a point lies in a closed triangle with an area.
pub(super) fn inside(case: &[f64; 12]) -> Answer<0> {
    let [p, a, b, c] = [0, 3, 6, 9].map(|from| [case[from], case[from + 1], case[from + 2]]);
    Answer::without_values(u8::from(Projection::new(p, [a, b, c]).place().is_hit()))
}

/// The rank of a 3x3 matrix and its pseudo-inverse, by columns.
pub(super) fn pseudo_inverse(case: &[f64; 9]) -> Answer<9> {
    let inverse = PseudoInverse::new(&matrix(case));
    let values = std::array::from_fn(|i| rounded(&inverse.entry(i % 3, i / 3)));
    Answer { verdict: [0, 1, 2, 3][inverse.rank], values }
}

/// The coefficients of the plane `ax + by + cz = 1` nearest to three vertices: the pseudo-inverse of the matrix of rows
/// times `(1, 1, 1)`.
pub(super) fn plane(case: &[f64; 9]) -> Answer<3> {
    let columns = std::array::from_fn(|i| case[i % 3 * 3 + i / 3]);
    let inverse = PseudoInverse::new(&matrix(&columns));
    Answer { verdict: 0, values: [0, 1, 2].map(|i| rounded(&quotient(&inverse.row_sum(i), &inverse.denominator))) }
}

/// A vector mirrored in the plane with a normal that is not zero.
pub(super) fn reflection(case: &[f64; 6]) -> Answer<3> {
    let [x, y, z, n @ ..] = *case;
    let image = Reflection::new([x, y, z], n);
    Answer { verdict: 0, values: image.numerators.each_ref().map(|x| rounded(&quotient(x, &image.denominator))) }
}

/// The texture coordinates of a normal that is not zero.
pub(super) fn mapping(case: &[f64; 3]) -> Answer<2> {
    Answer { verdict: 0, values: uv(*case).each_ref().map(rounded) }
}

/// The texel that a normal points at, row by row.
pub(super) fn texel(case: &[f64; 3]) -> Answer<0> {
    let [x, y, z] = *case;
    // Counted from the seam, where no bit is lost however near it is: for z > 0 this is 1 - u.
    let [share, v] = uv([x, y, -z.abs()]);
    let [from_seam, down] = [share, v].map(|x| x * exact(SIDE.into()));
    let column = if z > 0.0 { i64::from(SIDE) + whole(&-from_seam) } else { whole(&from_seam) };
    let [column, row] = [column, whole(&down)].map(|x| u8::try_from(x).expect("in 0..=1 times a byte"));
    Answer::without_values(row.min(SIDE - 1) * SIDE + column % SIDE)
}

/// The byte of a white point in one white light. A case is point, direction, normal, light, shininess.
pub(super) fn phong(case: &[f64; 13]) -> Answer<0> {
    let [point, direction, normal, position] = [0, 3, 6, 9].map(|from| part(case, from));
    let white = vector([1.0; 3]);
    // Exactly in the plane of the surface it does not shine, whichever way a root is rounded.
    let shines = sign(&dot(&sub(&position, &point), &normal)) != Ordering::Equal;
    let color = if shines { white.clone() } else { vector([0.0; 3]) };
    let lamp = Lamp { position, color };
    let coefficients = [MATERIAL.ambient, MATERIAL.diffuse, MATERIAL.specular];
    let [brightness, ..] = shade(&point, &direction, &normal, &white, coefficients, case[12], &[lamp]);
    Answer::without_values(byte(&brightness))
}

/// The byte of a brightness: `⌊255 c + ½⌋` of it, clamped.
pub(super) fn byte(brightness: &Big) -> u8 {
    let scaled = floor(&(brightness * exact(255.0) + exact(0.5)));
    u8::try_from(scaled.clamp(0, 255)).expect("within a byte")
}

/// What differs by no more than this from an exact tie is one: numbers of 400 bits are good to far more, relative to
/// the numbers near 1 that they are, and no other number of such short ones comes as close by chance.
pub(super) fn tie() -> Big {
    power_of_two(-250)
}

/// The whole part of a number; what lies below a whole number by less than a [`tie`] is taken for it.
pub(super) fn floor(x: &Big) -> i64 {
    whole(&(x + tie()))
}

/// The whole part of a number.
fn whole(x: &Big) -> i64 {
    #[expect(clippy::cast_possible_truncation, reason = "numbers of samples and texels")]
    let whole = x.floor().to_f64().value() as i64;
    whole
}

fn balls(case: &[f64; 4 * COUNT]) -> Vec<Ball> {
    case.chunks_exact(4).map(|ball| Ball::new([ball[0], ball[1], ball[2]], ball[3])).collect()
}

/// The radius of the smallest sphere around spheres. The verdict is 1: every sphere is inside.
pub(super) fn enclosing(case: &[f64; 4 * COUNT]) -> Answer<4> {
    let radius = smallest_radius(&balls(case)).map_or(f64::NAN, |radius| rounded(&radius));
    Answer { verdict: 1, values: [f64::NAN, f64::NAN, f64::NAN, radius] }
}

/// Judges an answer for spheres: the verdict is 1 if the sphere found holds every other, exactly.
pub(super) fn judge_enclosing(case: &[f64; 4 * COUNT], answer: Answer<4>) -> Answer<4> {
    let [x, y, z, radius] = answer.values;
    let holds = || balls(case).iter().all(|ball| Ball::new([x, y, z], radius).contains(ball));
    let verdict = u8::from(answer.values.iter().all(|value| value.is_finite()) && holds());
    Answer { verdict, values: [f64::NAN, f64::NAN, f64::NAN, radius] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_of_a_case_are_read_in_their_order() {
        let roots = quadratic(&[1.0, -3.0, 2.0]);
        assert_eq!((roots.verdict, roots.values), (2, [1.0, 2.0]));
        assert_eq!([[0.0; 3], [1.0, 2.0, 1.0], [1.0, 0.0, 1.0]].map(|case| quadratic(&case).verdict), [3, 1, 0]);
        let tiny = f64::from_bits(1);
        assert_eq!(quadratic(&[0.0, 2.0, -3.0 * tiny]).values[0], 2.0 * tiny);
        assert_eq!(quadratic(&[0.0, tiny, -1.0]).values[0], f64::INFINITY);
        let hit = sphere(&[0.0, 0.0, 5.0, 0.0, 0.0, -2.0, 0.0, 0.0, 0.0, 1.0]);
        assert_eq!((hit.verdict, hit.values), (1, [2.0]));
        let corner = [0.0, 0.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        assert_eq!((triangle(&corner).values, barycentric(&corner).values), ([1.0], [1.0, 0.0, 0.0]));
        assert_eq!(inside(&[0.5, 0.5, 7.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]).verdict, 1, "on an edge");
        assert_eq!(pseudo_inverse(&[0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]).values[3], 0.5);
        assert_eq!(plane(&[2.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 8.0]).values, [0.5, 0.25, 0.125]);
        assert_eq!(reflection(&[1.0, -1.0, 0.0, 0.0, 5.0, 0.0]).values, [1.0, 1.0, 0.0]);
        assert_eq!(mapping(&[3.0, 0.0, -3.0]).values, [0.375, 0.5]);
        let above = [0.0, 0.0, 0.0, 0.0, 0.0, -3.0, 0.0, 0.0, -0.5, 0.0, 0.0, 7.0, 9.0];
        assert_eq!(phong(&above).verdict, 255, "brighter than full");
        let below = above.map(|x| if x == 7.0 { -7.0 } else { x });
        assert_eq!(phong(&below).verdict, 32, "ambient alone, 31.875");
        assert_eq!(texel(&[1.0, 0.0, 0.0]).verdict, 7 * SIDE + 7, "the middle");
        assert_eq!([0.0, -0.0].map(|z| texel(&[-1.0, 0.0, z]).verdict), [7 * SIDE; 2], "both sides of the seam");
        assert_eq!([1e-300, -1e-300].map(|z| texel(&[-1.0, 0.0, z]).verdict), [7 * SIDE + 14, 7 * SIDE], "beside it");
        let corners: [f64; 4 * COUNT] =
            std::array::from_fn(|i| f64::from(u8::from(i % 4 < 3 && (i / 4) & (1 << (i % 4)) != 0)));
        assert_eq!(enclosing(&corners).values[3], 0.75f64.sqrt());
        let holds = |radius| judge_enclosing(&corners, Answer { verdict: 1, values: [0.5, 0.5, 0.5, radius] }).verdict;
        assert_eq!((holds(0.866_025_403), holds(0.866_025_404)), (0, 1));
    }
}
