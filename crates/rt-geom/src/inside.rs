//! The report's inside test: a point is inside where it lies on the same side of all three edges.

use glam::DVec3;

use crate::Triangle;

/// Where a point, projected orthogonally into a triangle's plane, lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inside {
    /// In the interior.
    Interior,
    /// In an edge, not at its ends.
    Edge,
    /// At a vertex.
    Vertex,
    /// Outside; also every point if the triangle is degenerate.
    Outside,
}

/// Returns where a point lies, judged by its orthogonal projection into the triangle's plane.
///
/// With `n = (b - a) x (c - a)` the point is inside where none of `n . (to - from) x (point - from)` over the three
/// edges is negative. A degenerate triangle contains nothing.
///
/// ```
/// use glam::DVec3;
/// use rt_geom::{Inside, Triangle, inside_triangle};
///
/// let triangle = Triangle::new(DVec3::ZERO, DVec3::X, DVec3::Y).unwrap();
/// assert_eq!(inside_triangle(DVec3::new(0.25, 0.25, 7.0), &triangle), Inside::Interior);
/// assert_eq!(inside_triangle(DVec3::new(0.5, 0.5, 0.0), &triangle), Inside::Edge);
/// assert_eq!(inside_triangle(DVec3::Y, &triangle), Inside::Vertex);
/// assert_eq!(inside_triangle(DVec3::ONE, &triangle), Inside::Outside);
/// ```
pub fn inside_triangle(point: DVec3, triangle: &Triangle) -> Inside {
    let [a, b, c] = triangle.vertices();
    let n = (b - a).cross(c - a);
    if n == DVec3::ZERO || !point.is_finite() {
        return Inside::Outside;
    }
    let turns = [(a, b), (b, c), (c, a)].map(|(from, to)| n.dot((to - from).cross(point - from)));
    if turns.iter().any(|&turn| turn < 0.0) {
        return Inside::Outside;
    }
    match turns.iter().filter(|&&turn| turn == 0.0).count() {
        0 => Inside::Interior,
        1 => Inside::Edge,
        _ => Inside::Vertex,
    }
}
