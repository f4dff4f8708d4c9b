//! The report's plane of a triangle, `a x + b y + c z = 1`, by the pseudo-inverse.

use glam::{DMat3, DVec3};
use rt_math::pseudo_inverse_row_sums;

use crate::Triangle;

/// Returns the coefficients `(a, b, c)` of the plane `a x + b y + c z = 1` through the vertices: `M+ (1, 1, 1)`, where
/// the rows of `M` are the vertices and `M+` is its pseudo-inverse.
///
/// Each coefficient is correctly rounded: the three sums have one denominator, so each is one exact quotient.
///
/// A plane through the origin has no such form. The answer is then the least-squares solution, which is another
/// plane: nothing in the answer itself shows it. The intersection of rays and triangles does not use this form.
///
/// ```
/// use glam::DVec3;
/// use rt_geom::{Triangle, plane_by_pseudo_inverse};
///
/// let triangle = Triangle::new(2.0 * DVec3::X, 4.0 * DVec3::Y, 8.0 * DVec3::Z).unwrap();
/// assert_eq!(plane_by_pseudo_inverse(&triangle), DVec3::new(0.5, 0.25, 0.125));
/// ```
#[must_use]
pub fn plane_by_pseudo_inverse(triangle: &Triangle) -> DVec3 {
    let [a, b, c] = triangle.vertices();
    let rows = DMat3::from_cols(a, b, c).transpose();
    pseudo_inverse_row_sums(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_satisfy_the_equation() {
        let triangle =
            Triangle::new(DVec3::new(1.0, 0.5, -3.0), DVec3::new(-2.0, 1.5, -4.0), DVec3::new(0.25, -1.0, -2.5));
        let triangle = triangle.unwrap();
        let plane = plane_by_pseudo_inverse(&triangle);
        for vertex in triangle.vertices() {
            assert!((plane.dot(vertex) - 1.0).abs() < 1e-13, "{vertex} is off the plane {plane}");
        }
    }

    #[test]
    fn a_plane_through_the_origin_has_no_such_form() {
        // The plane z = 0, seen by the report's form: the least-squares answer is a plane at right angles to it.
        let triangle = Triangle::new(DVec3::X, DVec3::Y, -DVec3::X).unwrap();
        let plane = plane_by_pseudo_inverse(&triangle);
        assert_eq!(plane.z, 0.0, "found {plane}");
        let worst = triangle.vertices().map(|vertex| (plane.dot(vertex) - 1.0).abs()).into_iter().fold(0.0, f64::max);
        assert!(worst >= 1.0, "a vertex misses the equation by {worst}");
    }
}
