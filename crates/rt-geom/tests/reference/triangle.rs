//! A line and a triangle in exact arithmetic, by the definitions.

use std::cmp::Ordering;

use rt_geom::{Ray, Triangle, Verdict};

use super::{Exact, Vector, cross, dot, minus, vector};

/// The sign of the first number that is not zero.
fn leading(numbers: &[&Exact]) -> Ordering {
    numbers.iter().map(|x| x.sign()).find(|&sign| sign != Ordering::Equal).unwrap_or(Ordering::Equal)
}

/// Everything about a line and a triangle, exactly.
pub(crate) struct Truth {
    pub(crate) volumes: [Exact; 3],
    /// `t = height / slope`
    pub(crate) height: Exact,
    pub(crate) slope: Exact,
    pub(crate) line: Verdict,
    pub(crate) crosses: bool,
}

impl Truth {
    pub(crate) fn new(ray: &Ray, triangle: &Triangle) -> Self {
        let (o, d) = (vector(ray.origin()), vector(ray.direction()));
        let [a, b, c] = triangle.vertices().map(|v| minus(&vector(v), &o));
        // Each volume from its own edge, as direction . (p x q); the plane from the edges.
        let volumes = [(&b, &c), (&c, &a), (&a, &b)].map(|(p, q)| dot(&d, &cross(p, q)));
        let n = cross(&minus(&b, &a), &minus(&c, &a));
        let (height, slope) = (dot(&n, &a), dot(&n, &d));
        let zero = n.iter().all(|x| x.sign() == Ordering::Equal);
        let signs = [0, 1, 2].map(|i| volumes[i].sign());
        let line = if zero {
            Verdict::Degenerate
        } else if slope.sign() == Ordering::Equal {
            Verdict::Parallel
        } else if signs.contains(&Ordering::Less) && signs.contains(&Ordering::Greater) {
            Verdict::Miss
        } else {
            // Volume i belongs to the edge opposite vertex i: from i + 1 to i + 2.
            let zeros: Vec<usize> = (0..3).filter(|&i| signs[i] == Ordering::Equal).collect();
            match zeros[..] {
                [] => Verdict::Interior,
                [i] => Verdict::Edge((i + 1) % 3),
                [i, j] => Verdict::Vertex(3 - i - j),
                _ => unreachable!("their sum is not zero"),
            }
        };
        let turned = |x: &Exact, v: &Vector| leading(&[x, &v[0], &v[1], &v[2]]);
        let turned_slope = turned(&slope, &n);
        let edges = [(&b, &c), (&c, &a), (&a, &b)];
        let crosses = height.sign() != Ordering::Equal
            && height.sign() == turned_slope
            && (0..3).all(|i| turned(&volumes[i], &cross(edges[i].0, edges[i].1)) == turned_slope);
        Self { volumes, height, slope, line, crosses }
    }

    /// Whether the ray, from its origin on, hits.
    pub(crate) fn ahead(&self) -> bool {
        self.height.sign() == Ordering::Equal || self.height.sign() == self.slope.sign()
    }
}
