//! Exact vectors.

use crate::{Big, exact, long, quotient, root};

/// A vector of exact numbers.
pub type Vector = [Big; 3];

/// Returns the exact vector of finite doubles.
#[must_use]
pub fn vector(v: impl Into<[f64; 3]>) -> Vector {
    v.into().map(exact)
}

/// Returns `a - b`.
#[must_use]
pub fn sub(a: &Vector, b: &Vector) -> Vector {
    [0, 1, 2].map(|i| &a[i] - &b[i])
}

/// Returns the inner product.
#[must_use]
pub fn dot(a: &Vector, b: &Vector) -> Big {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// Returns the cross product.
#[must_use]
pub fn cross(a: &Vector, b: &Vector) -> Vector {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &a[i] * &b[j] - &a[j] * &b[i])
}

/// Returns the vector divided by its length, which is not zero, in 400 bits.
#[must_use]
pub fn unit(v: &Vector) -> Vector {
    let length = root(&dot(v, v));
    v.each_ref().map(|x| quotient(x, &length))
}

/// Returns the point `origin + t direction`, in 400 bits.
#[must_use]
pub fn point_at(origin: &Vector, direction: &Vector, t: &Big) -> Vector {
    [0, 1, 2].map(|i| long(&(&origin[i] + t * &direction[i])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_of_small_vectors_are_known() {
        let [x, y, v] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [3.0, 0.0, -4.0]].map(vector);
        assert_eq!(cross(&x, &y), vector([0.0, 0.0, 1.0]));
        assert_eq!(dot(&v, &v), exact(25.0));
        assert_eq!(unit(&v).each_ref().map(|c| c * exact(5.0)).map(|c| c.to_f64().value()), [3.0, 0.0, -4.0]);
        assert_eq!(point_at(&x, &sub(&v, &y), &exact(0.5)), vector([2.5, -0.5, -2.0]));
    }
}
