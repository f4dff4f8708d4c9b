//! A triangle, and where a ray meets it.
//!
//! With the vertices `a`, `b`, `c` taken relative to the origin of the ray and `d` its direction, the volumes
//!
//! ```text
//!     u = d . (b x c)      v = d . (c x a)      w = d . (a x b)
//! ```
//!
//! tell on which side of each edge the line passes. It meets the closed triangle where no two of them have opposite
//! signs and their sum, `d . (b - a) x (c - a)`, is not zero. Each sign depends on the two vertices of an edge and the
//! ray alone, and swapping the vertices swaps it: with exact signs, two triangles that share an edge agree about it,
//! and a closed mesh has no gap.
//!
//! Möller and Trumbore's formulas give the same volumes (negative, and two of them as differences from the sum). In
//! plain doubles with an error bound they decide nearly every case in `filter.rs`, and `exact.rs` decides the rest. The
//! last bits of `t` and of the weights come from one step of iterative refinement, in `finish.rs`.

mod exact;
mod filter;
mod finish;
mod lanes;
mod locate;

use std::fmt;
use std::ops::Range;

use glam::DVec3;
use rt_math::exact::{U, power_of_two};

use crate::Ray;
use crate::ray::{Candidates, FilterVerdict, PreparedRay, larger, max_abs};
pub(crate) use exact::{height_sign, slope_sign};
use filter::{filter, surely_leans};
pub use locate::{PointInTriangle, inside_triangle};

/// Where the filter's bounds are proved: the edges are at least this long, `2^-150`, and the triangle with the ray's
/// origin is smaller than `2^300`. Nothing overflows there, and what underflows is far below the bounds.
const SHORTEST: f64 = power_of_two(-150);
const FARTHEST: f64 = power_of_two(300);

/// How a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It does not: the line passes beside the triangle, or meets it before the ray starts.
    Miss,
    /// In the interior.
    Interior,
    /// In the edge from vertex `i` to vertex `(i + 1) % 3`, not at its ends.
    Edge(usize),
    /// At vertex `i`.
    Vertex(usize),
    /// The direction is parallel to the plane, beside it or in it: no hit.
    Parallel,
    /// The triangle has no area: no hit.
    Degenerate,
}

impl Verdict {
    /// Whether it is a hit: in the interior, an edge or a vertex.
    #[must_use]
    pub fn is_hit(self) -> bool {
        matches!(self, Self::Interior | Self::Edge(_) | Self::Vertex(_))
    }
}

/// The closed triangle with three given vertices: its boundary belongs to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    vertices: [DVec3; 3],
    /// `E`: the sum over the axes of the larger component of the edges from the first vertex. Infinite, so that no
    /// filter is certain, if that is too small for the filters' bounds.
    edge: f64,
}

/// Why there is no such triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TriangleError {
    /// A coordinate of this vertex, 0, 1 or 2, is infinite or NaN.
    VertexNotFinite(usize),
}

impl fmt::Display for TriangleError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self::VertexNotFinite(vertex) = self;
        write!(f, "the vertices of a triangle must be finite, and vertex {vertex} is not")
    }
}

impl std::error::Error for TriangleError {}

impl Triangle {
    /// Returns the triangle with these vertices, each a vector or three numbers. A triangle without area is allowed, and
    /// nothing hits it.
    ///
    /// ```
    /// use rt_geom::{Triangle, TriangleError};
    ///
    /// assert!(Triangle::new([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]).is_ok());
    /// assert_eq!(Triangle::new([0.0; 3], [1.0; 3], [f64::NAN; 3]), Err(TriangleError::VertexNotFinite(2)));
    /// ```
    ///
    /// # Errors
    /// If a coordinate is not finite.
    #[inline]
    pub fn new(a: impl Into<DVec3>, b: impl Into<DVec3>, c: impl Into<DVec3>) -> Result<Self, TriangleError> {
        let vertices @ [a, b, c] = [a.into(), b.into(), c.into()];
        if let Some(vertex) = vertices.iter().position(|vertex| !vertex.is_finite()) {
            return Err(TriangleError::VertexNotFinite(vertex));
        }
        let (e, f) = (b - a, c - a);
        let most = |x: f64, y: f64| larger(x.abs(), y.abs());
        let edge = most(e.x, f.x) + most(e.y, f.y) + most(e.z, f.z);
        let edge = if edge > SHORTEST { edge } else { f64::INFINITY };
        Ok(Self { vertices, edge })
    }

    /// The three vertices, as given; finite.
    #[inline]
    #[must_use]
    pub fn vertices(&self) -> [DVec3; 3] {
        self.vertices
    }

    /// The sum over the axes of the largest component of the edges, within a few ulp; infinite below `2^-150`.
    ///
    /// No edge from the first vertex is longer.
    #[inline]
    #[must_use]
    pub fn size(&self) -> f64 {
        self.edge
    }

    /// Returns the `t` of the hit, correctly rounded, if it is in the range.
    ///
    /// The range holds the hit if `within.start <= t < within.end` for the correctly rounded `t`, compared with
    /// [`f64::total_cmp`]: an exact zero is +0.0, and a negative `t` that underflows is -0.0, which lies before it. An
    /// infinite end is no bound. A range that is empty or has a NaN holds nothing. A ray parallel to the plane, even
    /// in it, and a triangle without area are no hit; both sides of the triangle are hit alike.
    ///
    /// Exact for every finite ray and triangle, over- and underflow included; `docs/numerics.md`, section 6, has the
    /// proof.
    ///
    /// ```
    /// use glam::DVec3;
    /// use rt_geom::{Ray, Triangle};
    ///
    /// let triangle = Triangle::new(DVec3::ZERO, DVec3::X, DVec3::Y).unwrap();
    /// let ray = Ray::new(DVec3::new(0.5, 0.5, 3.0), DVec3::NEG_Z).unwrap(); // through the middle of an edge
    /// assert_eq!(triangle.closest(&ray, 0.0..f64::INFINITY), Some(3.0));
    /// assert_eq!(triangle.closest(&ray, 0.0..3.0), None);
    /// ```
    #[inline]
    #[must_use]
    pub fn closest(&self, ray: &Ray, within: Range<f64>) -> Option<f64> {
        filter::closest(self, ray, within.start, within.end)
    }

    /// Whether the ray meets the triangle in the range: the same as `closest(..).is_some()`, at less cost.
    #[inline]
    #[must_use]
    pub fn any(&self, ray: &Ray, within: Range<f64>) -> bool {
        self.meets::<false>(&PreparedRay::new(ray, within))
    }

    /// Returns how the ray, from its origin on, meets the triangle, exactly.
    ///
    /// A hit is what `closest(ray, 0.0..f64::INFINITY)` finds, and never `Parallel` or `Degenerate`.
    ///
    /// ```
    /// use glam::DVec3;
    /// use rt_geom::{Ray, Triangle, Verdict};
    ///
    /// let triangle = Triangle::new(DVec3::ZERO, DVec3::X, DVec3::Y).unwrap();
    /// let down = |x, y| triangle.verdict(&Ray::new(DVec3::new(x, y, 1.0), DVec3::NEG_Z).unwrap());
    /// assert_eq!(down(0.25, 0.25), Verdict::Interior);
    /// assert_eq!(down(0.5, 0.5), Verdict::Edge(1)); // from vertex 1 to vertex 2
    /// assert_eq!(down(0.0, 1.0), Verdict::Vertex(2));
    /// assert_eq!(down(0.5, 0.5f64.next_up()), Verdict::Miss);
    /// ```
    #[must_use]
    pub fn verdict(&self, ray: &Ray) -> Verdict {
        let line = match filter::<false>(self, ray) {
            FilterVerdict::Crosses(_) => Verdict::Interior,
            FilterVerdict::Misses if surely_leans(self, ray) => Verdict::Miss,
            FilterVerdict::Misses | FilterVerdict::Unsure => exact::line_verdict(self, ray),
        };
        if line.is_hit() && !self.any(ray, 0.0..f64::INFINITY) { Verdict::Miss } else { line }
    }

    /// Whether the ray crosses the triangle, by a rule that counts every crossing of a closed mesh once.
    ///
    /// The rule is that of one symbolic perturbation: the direction is turned to `d + (e, e², e³)` for an infinitely
    /// small `e > 0`, for all triangles alike, and a crossing counts if its `t` is positive. Such a ray meets no
    /// edge, no vertex and no plane along its face, unless its origin lies there. So for a mesh without boundary:
    ///
    /// - an origin off the surface is inside exactly if an odd number of triangles is crossed, however the ray passes
    ///   through edges, vertices and within the planes of faces;
    /// - an origin on the surface is judged as the points just ahead of it on the turned ray.
    ///
    /// A triangle without area is never crossed. `docs/numerics.md`, section 6, has the proof.
    ///
    /// ```
    /// use glam::DVec3;
    /// use rt_geom::{Ray, Triangle};
    ///
    /// // Two triangles of one square: a ray through the diagonal they share crosses one of them.
    /// let [a, b, c, d] = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
    /// let halves = [Triangle::new(a, b, c).unwrap(), Triangle::new(a, c, d).unwrap()];
    /// let ray = Ray::new(DVec3::new(0.5, 0.5, 1.0), DVec3::NEG_Z).unwrap();
    /// assert!(halves.iter().all(|half| half.any(&ray, 0.0..f64::INFINITY)));
    /// assert_eq!(halves.iter().filter(|half| half.crosses(&ray)).count(), 1);
    /// ```
    #[must_use]
    pub fn crosses(&self, ray: &Ray) -> bool {
        match filter::<false>(self, ray) {
            FilterVerdict::Misses => false,
            FilterVerdict::Crosses(crossing) => match crossing.height() {
                (height, error) if height > error => true,
                (height, error) if height < -error => false,
                _ => exact::crosses(self, ray),
            },
            FilterVerdict::Unsure => exact::crosses(self, ray),
        }
    }

    /// Returns the unit normal, on the side from which the vertices turn counterclockwise; `None` if degenerate.
    ///
    /// Within `4.6 * 2^-53` of the exact one in Euclidean length, slivers and all scales included (proved in
    /// `docs/numerics.md`, section 6).
    #[must_use]
    pub fn normal(&self) -> Option<DVec3> {
        let n = exact::scaled_normal(self)?;
        Some(n / n.length())
    }

    /// Whether the triangle has no area: its vertices lie on a line. Exact.
    #[must_use]
    pub fn is_degenerate(&self) -> bool {
        let [a, b, c] = self.vertices;
        let area = max_abs((b - a).cross(c - a));
        let certain = self.edge < FARTHEST && area > 16.0 * U * self.edge * self.edge;
        !certain && exact::is_degenerate(self)
    }

    /// Returns the weights of the three vertices where the ray's whole line meets the triangle, each correctly rounded,
    /// or `None` if it does not.
    ///
    /// The weights lie in 0..=1, and their sum is 1 but for the rounding of each. A weight is zero exactly on the
    /// opposite edge, or where it underflows.
    #[must_use]
    pub fn line_barycentric(&self, ray: &Ray) -> Option<[f64; 3]> {
        filter::weights(self, ray)
    }

    /// Returns `t` and the weights of the three vertices at the hit, if it is in the range: what [`Self::closest`] and
    /// [`Self::line_barycentric`] give, in less time than both.
    #[must_use]
    pub fn closest_with_barycentric(&self, ray: &Ray, within: Range<f64>) -> Option<(f64, [f64; 3])> {
        filter::closest_with_weights(self, ray, within.start, within.end)
    }
}
