//! A point and a triangle, seen along the normal: the inside test of the textbook.

use std::cmp::Ordering;

use crate::{Big, Place, Vector, cross, dot, sign, sub, vector};

/// The projection of a point to the plane of a triangle.
#[derive(Clone, Debug)]
pub struct Projection {
    /// The weights of the vertices are `turns / square`.
    pub turns: [Big; 3],
    /// The square of the normal.
    pub square: Big,
    /// Zero if the point is in the plane.
    pub height: Big,
}

impl Projection {
    /// Projects a point to the plane of three vertices.
    #[must_use]
    pub fn new(point: impl Into<[f64; 3]>, vertices: [impl Into<[f64; 3]>; 3]) -> Self {
        let (p, [a, b, c]) = (vector(point), vertices.map(vector));
        let normal = cross(&sub(&b, &a), &sub(&c, &a));
        let turn = |from: &Vector, to: &Vector| dot(&normal, &cross(&sub(to, from), &sub(&p, from)));
        let turns = [turn(&b, &c), turn(&c, &a), turn(&a, &b)];
        Self { turns, square: dot(&normal, &normal), height: dot(&normal, &sub(&p, &a)) }
    }

    /// Returns where the projection lies.
    #[must_use]
    pub fn place(&self) -> Place {
        let degenerate = sign(&self.square) == Ordering::Equal;
        if degenerate { Place::Degenerate } else { Place::of(self.turns.each_ref().map(sign)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_places_are_found() {
        let flat = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
        let place = |x: f64, y: f64| Projection::new([x, y, 7.0], flat).place();
        assert_eq!([place(1.0, 1.0), place(3.0, 2.0), place(9.0, 0.0)], [Place::Interior, Place::Miss, Place::Miss]);
        assert_eq!([place(2.0, 2.0), place(0.0, 4.0)], [Place::Edge(1), Place::Vertex(2)]);
        assert_eq!(Projection::new([0.0; 3], [[1.0; 3], [2.0; 3], [3.0; 3]]).place(), Place::Degenerate);
    }
}
