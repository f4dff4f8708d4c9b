//! Real roots of a quadratic.

/// The real solutions of an equation, each distinct one once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Roots {
    /// No real number solves it.
    None,
    /// One number solves it: a double root, or the root of a linear equation.
    One(f64),
    /// Two numbers solve it, in ascending order.
    Two(f64, f64),
    /// Every number solves it: all coefficients are zero.
    All,
}
