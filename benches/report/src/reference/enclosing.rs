//! The smallest sphere around spheres, by trying every set that could determine it.

use super::{Big, dot, exact, is_negative, is_zero, long, roots, rounded, sub, vector};
use crate::methods::{Answer, COUNT};

/// The radius of the smallest sphere around spheres: of all spheres that one to four of them determine, the smallest that
/// holds the others. The verdict is 1: every sphere is inside.
pub(in super::super) fn enclosing(case: &[f64; 4 * COUNT]) -> Answer<4> {
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
    let gram: Vec<Vec<Big>> = edges.iter().map(|e| edges.iter().map(|f| &two * dot(e, f)).collect()).collect();
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
pub(in super::super) fn judge_enclosing(case: &[f64; 4 * COUNT], answer: Answer<4>) -> Answer<4> {
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
    fn the_smallest_sphere_around_points_of_a_cube_is_found() {
        let corners: Vec<f64> = (0..8).flat_map(|i| [i & 1, i >> 1 & 1, i >> 2, 0].map(f64::from)).collect();
        let case: [f64; 4 * COUNT] = corners.try_into().expect("eight corners");
        let found = enclosing(&case);
        assert_eq!((found.verdict, found.values[3]), (1, 0.75f64.sqrt()));
        let holds = |radius| judge_enclosing(&case, Answer { verdict: 1, values: [0.5, 0.5, 0.5, radius] }).verdict;
        assert_eq!((holds(0.866_025_403), holds(0.866_025_404)), (0, 1));
    }
}
