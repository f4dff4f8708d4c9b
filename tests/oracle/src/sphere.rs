//! A line and a sphere: the equation of the textbook.

use std::cmp::Ordering;

use crate::{Big, Quadratic, Vector, dot, exact, sign};

/// Returns the equation of the parameters `t` at which a line meets a sphere: `|offset + t direction|² = radius²`,
/// where `offset` leads from the center to the origin of the line. Its constant tells on which side the origin is.
#[must_use]
pub fn sphere_equation(direction: &Vector, offset: &Vector, radius: &Big) -> Quadratic {
    Quadratic {
        a: dot(direction, direction),
        b: exact(2.0) * dot(direction, offset),
        c: dot(offset, offset) - radius * radius,
    }
}

/// Returns the smallest `t >= 0` at which a ray hits a sphere, in 400 bits.
#[must_use]
pub fn nearest_root(direction: &Vector, offset: &Vector, radius: &Big) -> Option<Big> {
    let equation = sphere_equation(direction, offset, radius);
    if sign(&equation.discriminant()) == Ordering::Less {
        return None;
    }
    equation.roots().into_iter().find(|t| sign(t) != Ordering::Less)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Random, cross, rounded, vector};

    #[test]
    fn known_hits_are_found() {
        let hit = |origin: [f64; 3], z: f64| {
            nearest_root(&vector([0.0, 0.0, z]), &vector(origin), &exact(1.0)).as_ref().map(rounded)
        };
        assert_eq!(hit([0.0, 0.0, 5.0], -2.0), Some(2.0));
        assert_eq!(hit([0.0, 0.0, 5.0], 2.0), None, "behind");
        assert_eq!(hit([1.0, 0.0, 5.0], -2.0), Some(2.5), "tangent");
        assert_eq!(hit([0.0, 0.0, 0.0], -2.0), Some(0.5), "from inside");
    }

    /// An independent form of the discriminant: Lagrange's identity.
    #[test]
    fn the_discriminant_is_the_distance_of_center_and_line() {
        let mut random = Random::new(4);
        for _ in 0..1000 {
            let [d, w] = [0; 2].map(|_| vector(random.finite_point()));
            let r = exact(random.finite());
            let x = cross(&w, &d);
            let distance = dot(&d, &d) * &r * &r - dot(&x, &x);
            assert_eq!(sphere_equation(&d, &w, &r).discriminant(), exact(4.0) * distance);
        }
    }
}
