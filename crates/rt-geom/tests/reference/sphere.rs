//! A line and a sphere in exact arithmetic: the coefficients of the textbook.

use std::cmp::Ordering;

use rt_geom::{Ray, Sphere};

use super::{Exact, cross, dot, exact, minus, vector};

/// `a t² + 2 b t + c`, exactly.
pub(crate) struct Equation {
    pub(crate) a: Exact,
    pub(crate) b: Exact,
    pub(crate) c: Exact,
    pub(crate) delta: Exact,
}

impl Equation {
    pub(crate) fn new(ray: &Ray, sphere: &Sphere) -> Self {
        let (w, d) = (minus(&vector(ray.origin()), &vector(sphere.center())), vector(ray.direction()));
        let r = exact(sphere.radius());
        let a = dot(&d, &d);
        let b = dot(&w, &d);
        let c = &dot(&w, &w) - &(&r * &r);
        let delta = &(&b * &b) - &(&a * &c);
        // Lagrange's identity, so that a slip in one form is seen in the other
        let x = cross(&w, &d);
        assert_eq!(delta.cmp(&(&(&a * &(&r * &r)) - &dot(&x, &x))), Ordering::Equal);
        Self { a, b, c, delta }
    }

    /// `a x² + 2 b x + c`
    pub(crate) fn value(&self, x: &Exact) -> Exact {
        &(&(&(&self.a * x) + &(&self.b + &self.b)) * x) + &self.c
    }

    /// Compares the near root (the far one if `far`) with `x`.
    pub(crate) fn compare(&self, far: bool, x: &Exact) -> Ordering {
        let slope = &(&self.a * x) + &self.b;
        let value = self.value(x);
        match (far, slope.sign()) {
            (false, Ordering::Greater) => Ordering::Less,
            (false, _) => value.sign(),
            (true, Ordering::Less) => Ordering::Greater,
            (true, _) => value.sign().reverse(),
        }
    }
}
