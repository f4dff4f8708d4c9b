//! A triangle, where a ray meets it, and which points are inside.

use std::ops::Range;

use glam::DVec3;

use crate::Ray;
use crate::ray::{Candidate, PreparedRay, holds};

/// How a ray meets a triangle.
///
/// Edge `i` joins vertex `i` to vertex `(i + 1) % 3`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It does not.
    Miss,
    /// In the interior.
    Interior,
    /// In an edge, not at its ends.
    Edge(usize),
    /// At a vertex.
    Vertex(usize),
    /// The ray is parallel to the plane or lies in it: no hit.
    Parallel,
    /// The triangle has no area: no hit.
    Degenerate,
}

/// The closed triangle with three given vertices: its boundary belongs to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    vertices: [DVec3; 3],
}

impl Triangle {
    /// Returns the triangle, or `None` if a coordinate is not finite. A triangle without area is allowed, and
    /// nothing hits it.
    pub fn new(a: DVec3, b: DVec3, c: DVec3) -> Option<Self> {
        let valid = a.is_finite() && b.is_finite() && c.is_finite();
        valid.then_some(Self { vertices: [a, b, c] })
    }

    /// The three vertices, as given; finite.
    pub fn vertices(&self) -> [DVec3; 3] {
        self.vertices
    }

    /// Returns the `t` of the hit, if it is in the range.
    pub fn closest(&self, ray: &Ray, within: Range<f64>) -> Option<f64> {
        let [a, b, c] = self.vertices;
        match self.line_verdict(ray) {
            Verdict::Interior | Verdict::Edge(_) | Verdict::Vertex(_) => {
                let n = (b - a).cross(c - a);
                let t = n.dot(a - ray.origin()) / n.dot(ray.direction()) + 0.0;
                holds(&within, t).then_some(t)
            }
            Verdict::Miss | Verdict::Parallel | Verdict::Degenerate => None,
        }
    }

    /// Whether the ray meets the triangle in the range: the same as `closest(..).is_some()`.
    pub fn any(&self, ray: &Ray, within: Range<f64>) -> bool {
        self.closest(ray, within).is_some()
    }

    /// Returns how the ray, from its origin on, meets the triangle.
    pub fn verdict(&self, ray: &Ray) -> Verdict {
        match self.line_verdict(ray) {
            hit @ (Verdict::Interior | Verdict::Edge(_) | Verdict::Vertex(_)) => {
                if self.any(ray, 0.0..f64::INFINITY) { hit } else { Verdict::Miss }
            }
            other => other,
        }
    }

    /// Returns the unit normal, on the side from which the vertices turn counterclockwise; `None` if degenerate.
    pub fn normal(&self) -> Option<DVec3> {
        let [a, b, c] = self.vertices;
        (b - a).cross(c - a).try_normalize()
    }

    /// Whether the triangle has no area: its vertices lie on a line.
    pub fn is_degenerate(&self) -> bool {
        let [a, b, c] = self.vertices;
        (b - a).cross(c - a) == DVec3::ZERO
    }

    /// Returns the weights of the three vertices at the orthogonal projection of a point into the plane, or `None`
    /// if the triangle is degenerate.
    pub fn barycentric(&self, point: DVec3) -> Option<[f64; 3]> {
        let [a, b, c] = self.vertices;
        let n = (b - a).cross(c - a);
        let nn = n.length_squared();
        (nn > 0.0).then(|| {
            let weight = |from: DVec3, to: DVec3| n.dot((to - from).cross(point - from)) / nn;
            [weight(b, c), weight(c, a), weight(a, b)]
        })
    }

    /// Returns the weights of the three vertices where the ray's line meets the triangle, or `None` if it does not.
    pub fn hit_barycentric(&self, ray: &Ray) -> Option<[f64; 3]> {
        let volumes = self.edge_volumes(ray);
        let det: f64 = volumes.iter().sum();
        match self.line_verdict(ray) {
            Verdict::Interior | Verdict::Edge(_) | Verdict::Vertex(_) => Some(volumes.map(|v| v / det)),
            Verdict::Miss | Verdict::Parallel | Verdict::Degenerate => None,
        }
    }

    /// Returns bounds of the hit's `t`, or `None` if nothing in the range is hit or the hit surely lies beyond
    /// `limit`.
    #[inline]
    pub(crate) fn candidate(&self, prepared: &PreparedRay, limit: f64) -> Option<Candidate> {
        let t = self.closest(&prepared.ray, prepared.within())?;
        (t <= limit).then_some(Candidate { low: t, high: t })
    }

    /// Returns the volumes that the line spans with the edge opposite each vertex; their signs tell on which side
    /// of the edge it passes, and their sum is `direction . (b - a) x (c - a)`.
    fn edge_volumes(&self, ray: &Ray) -> [f64; 3] {
        let [a, b, c] = self.vertices.map(|vertex| vertex - ray.origin());
        let d = ray.direction();
        [d.dot(b.cross(c)), d.dot(c.cross(a)), d.dot(a.cross(b))]
    }

    fn line_verdict(&self, ray: &Ray) -> Verdict {
        let [u, v, w] = self.edge_volumes(ray);
        if self.is_degenerate() {
            Verdict::Degenerate
        } else if u + v + w == 0.0 {
            Verdict::Parallel
        } else if u.min(v).min(w) < 0.0 && u.max(v).max(w) > 0.0 {
            Verdict::Miss
        } else {
            match [u == 0.0, v == 0.0, w == 0.0] {
                [false, true, true] => Verdict::Vertex(0),
                [true, false, true] => Verdict::Vertex(1),
                [true, true, false] => Verdict::Vertex(2),
                [false, false, true] => Verdict::Edge(0),
                [true, false, false] => Verdict::Edge(1),
                [false, true, false] => Verdict::Edge(2),
                _ => Verdict::Interior,
            }
        }
    }
}
