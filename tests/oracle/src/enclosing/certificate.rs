//! How large a sphere around spheres must be: a certificate by duality, an independent derivation.
//!
//! For any point x and any weights w that are not negative and sum to 1, the radius of every enclosing sphere is at
//! least the sum of `w_i (|x - c_i| + r_i)`, less `|g| |x* - x|`, where g is the sum of the weighted unit vectors from
//! the centers to x and x* the true center. How x and w were found does not matter.

use std::cmp::Ordering;

use super::{Ball, combination, solve};
use crate::{Big, Quadratic, Vector, dot, exact, long, root, rounded, sign, sub, vector};

/// What is known of the least radius.
#[derive(Clone, Debug)]
pub struct Certificate {
    /// No enclosing sphere is smaller.
    pub bound: Big,
    /// Some enclosing sphere is that small: next to the bound if the support is right.
    pub ceiling: Big,
    /// The radius that the best center needs once rounded to doubles.
    pub floor: Big,
}

impl Certificate {
    /// Certifies spheres by some of them, at most four, which are tried as the support. `None`: no sphere touches
    /// these.
    #[must_use]
    pub fn new(balls: &[Ball], support: &[Ball]) -> Option<Self> {
        // The largest first.
        let mut support = support.to_vec();
        support.sort_by(|a, b| b.radius.cmp(&a.radius));
        let (x, mut shares) = tangent(&support)?;
        let sum = |numbers: &[Big]| numbers.iter().fold(long(&Big::ZERO), |sum, x| sum + x);
        if sign(&sum(&shares)) == Ordering::Equal {
            shares[0] = long(&exact(1.0));
        }
        let total = sum(&shares);
        let reach = |x: &Vector, ball: &Ball| distance(x, ball) + &ball.radius;
        let most = |x: &Vector| balls.iter().map(|ball| reach(x, ball)).max().expect("not empty");
        let mean = support.iter().zip(&shares).fold(Big::ZERO, |sum, (ball, share)| sum + share * reach(&x, ball));
        let units: Vec<Vector> = support.iter().map(|ball| direction(&x, ball)).collect();
        let pull = combination(&shares, &units);
        let ceiling = most(&x);
        let bound = mean / &total - exact(2.0) * &ceiling * root(&dot(&pull, &pull)) / total;
        let floor = most(&vector(x.each_ref().map(rounded)));
        Some(Self { bound: bound.max(support[0].radius.clone()), ceiling, floor })
    }
}

fn distance(x: &Vector, ball: &Ball) -> Big {
    let from = sub(x, &ball.center);
    root(&dot(&from, &from))
}

/// The unit vector from the center of a ball, or zero.
fn direction(x: &Vector, ball: &Ball) -> Vector {
    let (from, distance) = (sub(x, &ball.center), distance(x, ball));
    if sign(&distance) == Ordering::Equal { from } else { from.map(|c| c / &distance) }
}

/// The center of the sphere that the given ones touch from inside, by the normal equations, and their weights: in
/// proportion to the distances.
fn tangent(support: &[Ball]) -> Option<(Vector, Vec<Big>)> {
    let largest = support.first()?;
    let origin = largest.center.each_ref().map(long);
    let p: Vec<Vector> = support[1..].iter().map(|ball| sub(&ball.center, &origin)).collect();
    let s: Vec<Big> = support[1..].iter().map(|ball| long(&(&ball.radius - &largest.radius))).collect();
    if p.is_empty() {
        return Some((origin, vec![long(&exact(1.0))]));
    }
    let gram: Vec<Vec<Big>> = p.iter().map(|a| p.iter().map(|b| dot(a, b)).collect()).collect();
    let h = p.iter().zip(&s).map(|(p, s)| (dot(p, p) - s * s) * exact(0.5)).collect();
    let (y0, y1) = (solve(gram.clone(), h)?, solve(gram, s)?);
    // The center is the origin + a + ρ q, at the distance ρ >= 0 from the largest sphere's.
    let (a, q) = (combination(&y0, &p), combination(&y1, &p));
    let equation = Quadratic { a: dot(&q, &q) - exact(1.0), b: exact(2.0) * dot(&a, &q), c: dot(&a, &a) };
    if sign(&equation.discriminant()) == Ordering::Less || sign(&equation.a) == Ordering::Equal {
        return None;
    }
    let [low, high] = equation.roots();
    let rho = if sign(&equation.a) == Ordering::Less { high } else { low };
    let x: Vector = [0, 1, 2].map(|i| &a[i] + &rho * &q[i] + &origin[i]);
    let weights: Vec<Big> = y0.iter().zip(&y1).map(|(a, q)| a + &rho * q).collect();
    let rest = weights.iter().fold(exact(1.0), |rest, weight| rest - weight);
    let share = |(weight, ball): (Big, &Ball)| {
        if sign(&weight) == Ordering::Less { Big::ZERO } else { weight * distance(&x, ball) }
    };
    let shares = std::iter::once(rest).chain(weights).zip(support).map(share).collect();
    Some((x, shares))
}

#[test]
fn bounds_meet_at_the_least_radius() {
    let pair = [Ball::new([-3.0, 0.0, 0.0], 1.0), Ball::new([3.0, 0.0, 0.0], 2.0)];
    let all = [pair[0].clone(), Ball::new([0.0, 1.0, 0.0], 1.0), pair[1].clone()];
    let found = Certificate::new(&all, &pair).expect("the pair has a sphere");
    assert_eq!([&found.bound, &found.ceiling, &found.floor].map(rounded), [4.5; 3]);
    let wrong = Certificate::new(&all, &all[..2]).expect("this pair too");
    assert!(rounded(&wrong.bound) < 4.5 && rounded(&wrong.ceiling) > 4.5);
}
