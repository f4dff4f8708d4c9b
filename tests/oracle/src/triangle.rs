//! A line and a triangle, by the definitions.

use std::cmp::Ordering;

use crate::{Big, Vector, cross, dot, quotient, sign, sub};

/// Where the point of a triangle's plane that is asked about lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The triangle has no area.
    Degenerate,
    /// The line is parallel to the plane.
    Parallel,
    /// Outside of the triangle.
    Miss,
    /// Inside.
    Interior,
    /// On the edge from vertex `i` to vertex `i + 1`.
    Edge(usize),
    /// At a vertex.
    Vertex(usize),
}

impl Place {
    /// The place of a point with weights of these signs, which do not vanish all.
    pub(crate) fn of(signs: [Ordering; 3]) -> Self {
        if signs.contains(&Ordering::Less) && signs.contains(&Ordering::Greater) {
            return Self::Miss;
        }
        // Weight i belongs to the edge opposite vertex i: from i + 1 to i + 2.
        match (0..3).filter(|&i| signs[i] == Ordering::Equal).collect::<Vec<_>>()[..] {
            [] => Self::Interior,
            [i] => Self::Edge((i + 1) % 3),
            [i, j] => Self::Vertex(3 - i - j),
            _ => unreachable!("their sum is not zero"),
        }
    }

    /// Whether it is in the closed triangle.
    #[must_use]
    pub fn is_hit(self) -> bool {
        matches!(self, Self::Interior | Self::Edge(_) | Self::Vertex(_))
    }
}

/// A line through the origin and a triangle.
#[derive(Clone, Debug)]
pub struct Crossing {
    vertices: [Vector; 3],
    normal: Vector,
    /// The weights of the vertices are `volumes / slope`.
    pub volumes: [Big; 3],
    /// The parameter is `t = height / slope`.
    pub height: Big,
    /// In sum the volumes are this.
    pub slope: Big,
}

impl Crossing {
    /// Takes the vertices as they are seen from the origin of the line.
    #[must_use]
    pub fn new(direction: &Vector, vertices: [Vector; 3]) -> Self {
        let [a, b, c] = &vertices;
        // Each volume from its own edge, as direction . (p x q); the plane from the edges.
        let volumes = [(b, c), (c, a), (a, b)].map(|(p, q)| dot(direction, &cross(p, q)));
        let normal = cross(&sub(b, a), &sub(c, a));
        let (height, slope) = (dot(&normal, a), dot(&normal, direction));
        Self { vertices, normal, volumes, height, slope }
    }

    /// Returns where the whole line meets the plane.
    #[must_use]
    pub fn place(&self) -> Place {
        if self.normal.iter().all(|x| sign(x) == Ordering::Equal) {
            Place::Degenerate
        } else if sign(&self.slope) == Ordering::Equal {
            Place::Parallel
        } else {
            Place::of(self.volumes.each_ref().map(sign))
        }
    }

    /// Whether `t >= 0`.
    #[must_use]
    pub fn is_ahead(&self) -> bool {
        let height = sign(&self.height);
        height == Ordering::Equal || height == sign(&self.slope)
    }

    /// Returns the `t >= 0` at which the ray hits the closed triangle, in 400 bits.
    #[must_use]
    pub fn t(&self) -> Option<Big> {
        (self.place().is_hit() && self.is_ahead()).then(|| quotient(&self.height, &self.slope))
    }

    /// Returns the weights of the vertices where the line meets the closed triangle, in 400 bits.
    #[must_use]
    pub fn weights(&self) -> Option<[Big; 3]> {
        self.place().is_hit().then(|| self.volumes.each_ref().map(|volume| quotient(volume, &self.slope)))
    }

    /// Whether the ray crosses the triangle when its direction is turned by an infinitely small amount `(ε, ε², ε³)`:
    /// then it meets no edge.
    #[must_use]
    pub fn crosses(&self) -> bool {
        let turned = |x: &Big, v: &Vector| {
            let signs = [x, &v[0], &v[1], &v[2]].map(sign);
            signs.into_iter().find(|&sign| sign != Ordering::Equal).unwrap_or(Ordering::Equal)
        };
        let slope = turned(&self.slope, &self.normal);
        let [a, b, c] = &self.vertices;
        sign(&self.height) != Ordering::Equal
            && sign(&self.height) == slope
            && [(b, c), (c, a), (a, b)].iter().zip(&self.volumes).all(|((p, q), x)| turned(x, &cross(p, q)) == slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{exact, rounded, vector};

    #[test]
    fn known_places_are_found() {
        let flat = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]].map(vector);
        let from = |origin: [f64; 3], direction: [f64; 3]| {
            Crossing::new(&vector(direction), flat.each_ref().map(|v| sub(v, &vector(origin))))
        };
        let down = [0.0, 0.0, -2.0];
        for (x, y, place) in [
            (1.0, 1.0, Place::Interior),
            (1.0, 0.0, Place::Edge(0)),
            (2.0, 2.0, Place::Edge(1)),
            (0.0, 1.0, Place::Edge(2)),
            (0.0, 0.0, Place::Vertex(0)),
            (4.0, 0.0, Place::Vertex(1)),
            (0.0, 4.0, Place::Vertex(2)),
            (3.0, 2.0, Place::Miss),
        ] {
            let crossing = from([x, y, 1.0], down);
            assert_eq!(crossing.place(), place, "{x} {y}");
            assert_eq!(crossing.t().as_ref().map(rounded), place.is_hit().then_some(0.5));
            assert_eq!(from([x, y, -1.0], down).t(), None, "behind");
        }
        assert_eq!(from([1.0, 1.0, 1.0], [1.0, 0.0, 0.0]).place(), Place::Parallel);
        let quarters = from([1.0, 1.0, 1.0], down).weights().expect("a hit");
        assert_eq!(quarters.each_ref().map(rounded), [0.5, 0.25, 0.25]);
        let line = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]].map(vector);
        assert_eq!(Crossing::new(&vector(down), line).place(), Place::Degenerate);
    }

    #[test]
    fn a_shared_edge_is_crossed_once() {
        let corners = [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, 1.0, 1.0]].map(vector);
        let count = |x: f64, y: f64, z: f64| {
            let crosses = |of: [usize; 3]| {
                let seen = of.map(|i| sub(&corners[i], &vector([x, y, 0.0])));
                Crossing::new(&[exact(0.0), exact(0.0), exact(z)], seen).crosses()
            };
            usize::from(crosses([0, 1, 2])) + usize::from(crosses([1, 3, 2]))
        };
        assert_eq!([count(0.5, 0.5, 1.0), count(0.25, 0.75, 1.0), count(0.2, 0.2, 1.0)], [1; 3]);
        assert_eq!([count(0.5, 0.5, -1.0), count(2.0, 0.5, 1.0)], [0; 2]);
    }
}
