//! The smallest sphere around spheres: by trying every set that could determine it. [`certificate`] is independent of
//! that.

pub mod certificate;

use std::cmp::Ordering;

use dashu::base::Abs;

use crate::{Big, Quadratic, Vector, dot, exact, long, power_of_two, sign, sub, vector};

/// A sphere, exactly.
#[derive(Clone, Debug)]
pub struct Ball {
    /// Its center.
    pub center: Vector,
    /// Its radius.
    pub radius: Big,
}

impl Ball {
    /// Takes center and radius.
    #[must_use]
    pub fn new(center: impl Into<[f64; 3]>, radius: f64) -> Self {
        Self { center: vector(center), radius: exact(radius) }
    }

    /// Whether it contains another.
    #[must_use]
    pub fn contains(&self, other: &Self) -> bool {
        let (room, offset) = (&self.radius - &other.radius, sub(&self.center, &other.center));
        sign(&room) != Ordering::Less && dot(&offset, &offset) <= &room * &room
    }

    fn long(&self) -> Self {
        Self { center: self.center.each_ref().map(long), radius: long(&self.radius) }
    }
}

/// Returns the least radius of a sphere around spheres, in 400 bits: of all spheres that one to four of them determine,
/// that of the smallest that holds the others.
#[must_use]
pub fn smallest_radius(balls: &[Ball]) -> Option<Big> {
    let balls: Vec<Ball> = balls.iter().map(Ball::long).collect();
    let mut smallest: Option<Big> = None;
    for subset in (1u32..1 << balls.len()).filter(|subset| subset.count_ones() <= 4) {
        let chosen: Vec<&Ball> = (0..balls.len()).filter(|i| subset >> i & 1 == 1).map(|i| &balls[i]).collect();
        for found in tangent_around(&chosen) {
            // What 400 bits cannot tell from touching, touches.
            let reach = &found.radius * (long(&exact(1.0)) + power_of_two(-200));
            let outer = Ball { center: found.center, radius: reach };
            let better = smallest.as_ref().is_none_or(|smallest| found.radius < *smallest);
            if better && balls.iter().all(|ball| outer.contains(ball)) {
                smallest = Some(found.radius);
            }
        }
    }
    smallest
}

/// Returns the spheres, at most two, that touch all the given ones from outside with the center in their span.
fn tangent_around(balls: &[&Ball]) -> Vec<Ball> {
    let Ball { center: first, radius: r } = balls[0];
    if balls.len() == 1 {
        return vec![balls[0].clone()];
    }
    // The center is first + x, x = Σ λ_j e_j; |x - e_j| = R - r_j and |x| = R - r give 2 e_j·x = p_j + q_j R.
    let edges: Vec<Vector> = balls[1..].iter().map(|ball| sub(&ball.center, first)).collect();
    let two = long(&exact(2.0));
    let radii = balls[1..].iter().map(|ball| &ball.radius);
    let p: Vec<Big> = edges.iter().zip(radii.clone()).map(|(e, s)| dot(e, e) + r * r - s * s).collect();
    let q: Vec<Big> = radii.map(|s| &two * (s - r)).collect();
    let gram: Vec<Vec<Big>> = edges.iter().map(|e| edges.iter().map(|f| &two * dot(e, f)).collect()).collect();
    let (Some(p), Some(q)) = (solve(gram.clone(), p), solve(gram, q)) else {
        return Vec::new();
    };
    let (start, slope) = (combination(&p, &edges), combination(&q, &edges));
    // |start + R slope|² = (R - r)²
    let equation = Quadratic {
        a: dot(&slope, &slope) - long(&exact(1.0)),
        b: &two * (dot(&start, &slope) + r),
        c: dot(&start, &start) - r * r,
    };
    if sign(&equation.a) == Ordering::Equal || sign(&equation.discriminant()) == Ordering::Less {
        return Vec::new();
    }
    let large_enough = |radius: &Big| balls.iter().all(|ball| *radius >= ball.radius);
    let center = |radius: &Big| [0, 1, 2].map(|i| &first[i] + &start[i] + radius * &slope[i]);
    let radii = equation.roots().into_iter().filter(large_enough);
    radii.map(|radius| Ball { center: center(&radius), radius }).collect()
}

/// Returns the sum of the vectors, each times its weight.
fn combination(weights: &[Big], vectors: &[Vector]) -> Vector {
    [0, 1, 2].map(|i| vectors.iter().zip(weights).map(|(v, w)| &v[i] * w).fold(Big::ZERO, |sum, x| sum + x))
}

/// Solves linear equations by elimination; `None` if the matrix is singular.
fn solve(mut matrix: Vec<Vec<Big>>, right: Vec<Big>) -> Option<Vec<Big>> {
    let n = right.len();
    // What is left of a singular matrix after rounding is far below this.
    let tiny = matrix.iter().flatten().map(|x| x.clone().abs()).max()? * power_of_two(-250);
    matrix.iter_mut().zip(right).for_each(|(row, x)| row.push(x));
    for i in 0..n {
        let size = |k: &usize| matrix[*k][i].clone().abs();
        let pivot = (i..n).max_by(|j, k| size(j).cmp(&size(k))).filter(|pivot| size(pivot) > tiny)?;
        matrix.swap(i, pivot);
        let pivot_row = matrix[i].clone();
        for row in matrix.iter_mut().enumerate().filter(|(k, _)| *k != i).map(|(_, row)| row) {
            let factor = &row[i] / &pivot_row[i];
            // Only to the right of the pivot: to the left are zeros, and rounding would fill them.
            row.iter_mut().zip(&pivot_row).skip(i + 1).for_each(|(x, above)| *x = &*x - &factor * above);
        }
    }
    Some((0..n).map(|i| &matrix[i][n] / &matrix[i][i]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rounded;

    #[test]
    fn the_smallest_spheres_of_small_sets_are_known() {
        let radius = |balls: &[Ball]| rounded(&smallest_radius(balls).expect("finite"));
        let corners: Vec<_> = (0..8).map(|i| Ball::new([i & 1, i >> 1 & 1, i >> 2].map(f64::from), 0.0)).collect();
        assert_eq!(radius(&corners), 0.75f64.sqrt());
        let pair = [Ball::new([-3.0, 0.0, 0.0], 1.0), Ball::new([3.0, 0.0, 0.0], 2.0), Ball::new([0.0; 3], 0.5)];
        assert_eq!([radius(&pair), radius(&pair[1..])], [4.5, 2.75]);
        assert_eq!(radius(&vec![Ball::new([1.0; 3], 2.0); 5]), 2.0);
        let around = |radius| corners.iter().all(|corner| Ball::new([0.5; 3], radius).contains(corner));
        assert!(!around(0.866_025_403) && around(0.866_025_404));
    }

    /// Four spheres with centers in a plane span no space, and what rounding leaves of that must not count.
    #[test]
    fn centers_in_a_plane_or_on_a_line_are_no_trap() {
        let random = &mut crate::Random::new(1);
        for round in 0..200 {
            let balls: Vec<Ball> = (0..6)
                .map(|_| {
                    let (x, y) = (random.whole(-9, 9), random.whole(-9, 9));
                    let y = if round % 2 == 0 { y } else { 3.0 * x };
                    Ball::new([x, y, x + 7.0 * y], f64::from(round % 3) * random.whole(0, 5))
                })
                .collect();
            let radius = smallest_radius(&balls).expect("finite");
            let pair = |a: &Ball, b: &Ball| smallest_radius(&[a.clone(), b.clone()]).expect("finite");
            let least = balls.iter().flat_map(|a| balls.iter().map(move |b| pair(a, b))).max().expect("not empty");
            // Jung's theorem for balls: between that of the widest pair and twice that.
            assert!(radius >= &least * (exact(1.0) - power_of_two(-190)), "{balls:?}");
            assert!(radius <= least * exact(2.0), "{balls:?}");
            if round % 6 == 1 {
                assert_eq!(
                    rounded(&radius),
                    rounded(
                        &balls.iter().flat_map(|a| balls.iter().map(move |b| pair(a, b))).max().expect("not empty")
                    )
                );
            }
        }
    }
}
