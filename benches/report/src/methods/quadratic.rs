//! Real roots of `a x² + b x + c`. A case is `a, b, c`; the verdict is the number of roots (3: every number); the
//! values are the roots in ascending order.

use rt_math::{Roots, solve_quadratic};

use super::method::{Answer, Method};
use super::real::Float;

/// Returns the methods that solve a quadratic.
pub(crate) fn quadratic() -> Vec<Method<3, 2>> {
    vec![
        Method::new("textbook f32", "(-b ± √(b² - 4ac)) / 2a", textbook::<f32>),
        Method::new("textbook", "(-b ± √(b² - 4ac)) / 2a", textbook::<f64>),
        Method::new("q-form", "Press et al., Numerical Recipes, section 5.6", |case| stable(case, plain)),
        Method::new("q-form, Kahan's D", "Kahan 2004; Jeannerod, Louvet, Muller 2013", |case| stable(case, fused)),
        Method::ours("ours", |&[a, b, c]| answer(solve_quadratic(a, b, c))),
    ]
}

fn answer(roots: Roots) -> Answer<2> {
    match roots {
        Roots::None => Answer::without_values(0),
        Roots::One(x) => Answer { verdict: 1, values: [x, f64::NAN] },
        Roots::Two(x, y) => Answer { verdict: 2, values: [x, y] },
        Roots::All => Answer::without_values(3),
    }
}

fn linear(b: f64, c: f64) -> Roots {
    if b != 0.0 {
        Roots::One(-c / b)
    } else if c == 0.0 {
        Roots::All
    } else {
        Roots::None
    }
}

fn ascending(x: f64, y: f64) -> Roots {
    if x < y { Roots::Two(x, y) } else { Roots::Two(y, x) }
}

fn textbook<T: Float>(&[a, b, c]: &[f64; 3]) -> Answer<2> {
    let (a, b, c, zero) = (T::of(a), T::of(b), T::of(c), T::of(0.0));
    if a == zero {
        return answer(linear(b.wide(), c.wide()));
    }
    let discriminant = b * b - T::of(4.0) * a * c;
    if discriminant < zero {
        return Answer::without_values(0);
    }
    if discriminant == zero {
        return answer(Roots::One((-b / (a + a)).wide()));
    }
    let root = discriminant.sqrt();
    answer(ascending(((-b - root) / (a + a)).wide(), ((-b + root) / (a + a)).wide()))
}

/// Adds what has the same sign, and takes the other root from the product of the two.
fn stable(&[a, b, c]: &[f64; 3], discriminant: fn(f64, f64, f64) -> f64) -> Answer<2> {
    if a == 0.0 {
        return answer(linear(b, c));
    }
    let half = 0.5 * b;
    let d = discriminant(a, half, c);
    if d < 0.0 {
        return Answer::without_values(0);
    }
    if d == 0.0 {
        return answer(Roots::One(-half / a));
    }
    let q = -(half + d.sqrt().copysign(half));
    answer(ascending(q / a, c / q))
}

fn plain(a: f64, half: f64, c: f64) -> f64 {
    half * half - a * c
}

/// `half² - a c` with the rounding error of one product added: within 3/2 ulp, barring over- and underflow.
fn fused(a: f64, half: f64, c: f64) -> f64 {
    let product = a * c;
    let error = (-a).mul_add(c, product);
    half.mul_add(half, -product) + error
}
