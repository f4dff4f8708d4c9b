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
//! ray alone, and swapping the vertices swaps it: with exact signs, two triangles that share an edge agree about it, and a
//! closed mesh has no gap. Plain doubles with an error bound decide nearly every case here; `exact.rs` decides the
//! rest.

pub(crate) mod exact;

use std::cmp::Ordering;
use std::ops::Range;

use glam::DVec3;

use crate::Ray;
use crate::ray::{Candidate, PreparedRay, larger, max_abs, smaller};

/// `2^-53`, the unit roundoff.
const U: f64 = f64::EPSILON / 2.0;

/// Swallows all errors of underflow: `2^-500` (`docs/numerics.md`, section 6).
const UNDERFLOW: f64 = f64::from_bits((1023 - 500) << 52);

/// Swallows what underflow does to a `t`: `2^-1000`.
const UNDERFLOW_T: f64 = f64::from_bits((1023 - 1000) << 52);

/// Up to here in magnitude the vertices relative to the origin must be for plain doubles and double-double: `2^300`.
const FARTHEST: f64 = f64::from_bits((1023 + 300) << 52);

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
    pub fn is_hit(self) -> bool {
        matches!(self, Self::Interior | Self::Edge(_) | Self::Vertex(_))
    }
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
    #[inline]
    pub fn vertices(&self) -> [DVec3; 3] {
        self.vertices
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
    pub fn closest(&self, ray: &Ray, within: Range<f64>) -> Option<f64> {
        let prepared = PreparedRay::new(ray, within);
        let Candidate { low, high } = self.candidate(&prepared, f64::INFINITY)?;
        // Bounds that meet came from the exact stages.
        if low == high {
            return Some(low);
        }
        Some(self.refine(ray))
    }

    /// Whether the ray meets the triangle in the range: the same as `closest(..).is_some()`, found sooner.
    #[inline]
    pub fn any(&self, ray: &Ray, within: Range<f64>) -> bool {
        let prepared = PreparedRay::new(ray, within);
        // For the whole ray the sign of `t` is enough, and needs no division.
        if prepared.start.to_bits() == 0 && prepared.end == f64::INFINITY {
            match self.line_beside(&prepared) {
                Some(Ordering::Less) => return false,
                Some(_) => {
                    let (n, relative) = self.plane();
                    let from = self.vertices[0] - ray.origin();
                    let (height, slope) = (n.dot(from), n.dot(ray.direction()));
                    let certain = |x: f64, v: f64| x.abs() > relative * v + UNDERFLOW;
                    if certain(height, max_abs(from)) && certain(slope, prepared.reach) {
                        return (height < 0.0) == (slope < 0.0);
                    }
                }
                None => {}
            }
            return exact::closest(self, ray, prepared.within()).is_some();
        }
        self.candidate(&prepared, f64::INFINITY).is_some()
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
    pub fn verdict(&self, ray: &Ray) -> Verdict {
        let prepared = PreparedRay::new(ray, 0.0..f64::INFINITY);
        let line = match self.line(&prepared) {
            Line::Hits(_) => Verdict::Interior,
            Line::Misses if self.surely_leans(&prepared) => Verdict::Miss,
            Line::Misses | Line::Unsure => exact::line_verdict(self, ray),
        };
        if line.is_hit() && self.candidate(&prepared, f64::INFINITY).is_none() { Verdict::Miss } else { line }
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
    pub fn crosses(&self, ray: &Ray) -> bool {
        match self.line(&PreparedRay::new(ray, 0.0..f64::INFINITY)) {
            Line::Misses => false,
            Line::Hits(hit) if hit.low > 0.0 => true,
            Line::Hits(hit) if hit.high < 0.0 => false,
            Line::Hits(_) | Line::Unsure => exact::crosses(self, ray),
        }
    }

    /// Returns the unit normal, on the side from which the vertices turn counterclockwise; `None` if degenerate.
    ///
    /// Within `4.6 * 2^-53` of the exact one in Euclidean length, slivers and all scales included (proved in
    /// `docs/numerics.md`, section 6).
    pub fn normal(&self) -> Option<DVec3> {
        let n = exact::scaled_normal(self)?;
        Some(n / n.length())
    }

    /// Whether the triangle has no area: its vertices lie on a line. Exact.
    pub fn is_degenerate(&self) -> bool {
        let [a, b, c] = self.vertices;
        let (e, f) = (b - a, c - a);
        let largest = larger(max_abs(e), max_abs(f));
        let area = max_abs(e.cross(f));
        // False for what overflows.
        let certain = largest < FARTHEST && area > 16.0 * U * largest * largest + UNDERFLOW;
        !certain && exact::is_degenerate(self)
    }

    /// Returns the weights of the three vertices where the ray's whole line meets the triangle, each correctly rounded,
    /// or `None` if it does not.
    ///
    /// The weights lie in 0..=1, and their sum is 1 but for the rounding of each. A weight is zero exactly on the
    /// opposite edge, or where it underflows.
    pub fn hit_barycentric(&self, ray: &Ray) -> Option<[f64; 3]> {
        match self.line_beside(&PreparedRay::new(ray, 0.0..f64::INFINITY)) {
            Some(Ordering::Less) => None,
            Some(_) => exact::rounded_weights(self, ray).or_else(|| exact::integer_weights(self, ray)),
            None => exact::integer_weights(self, ray),
        }
    }

    /// Returns `t` and the weights of the three vertices at the hit, if it is in the range: what [`Self::closest`] and
    /// [`Self::hit_barycentric`] give, in less time than both.
    pub fn closest_with_barycentric(&self, ray: &Ray, within: Range<f64>) -> Option<(f64, [f64; 3])> {
        let Candidate { low, high } =
            self.candidate(&PreparedRay::new(ray, within.clone()), f64::INFINITY)?;
        if low < high
            && let Some(hit) = exact::rounded_hit(self, ray)
        {
            return Some(hit);
        }
        Some((self.closest(ray, within)?, self.hit_barycentric(ray)?))
    }

    /// Returns the correctly rounded `t` of a hit that is known to exist: what `closest` gives.
    #[inline]
    pub(crate) fn refine(&self, ray: &Ray) -> f64 {
        exact::rounded_t(self, ray).unwrap_or_else(|| exact::integer_t(self, ray))
    }

    /// Returns bounds of the hit's `t`, or `None` if nothing in the range is hit or the hit surely lies beyond
    /// `limit`.
    #[inline(always)]
    pub(crate) fn candidate(&self, prepared: &PreparedRay, limit: f64) -> Option<Candidate> {
        match self.line(prepared) {
            Line::Misses => None,
            Line::Hits(Candidate { low, high }) => prepared
                .admit((low, high), limit, || self.exact_candidate(prepared.ray, prepared.within(), limit)),
            Line::Unsure => self.exact_candidate(prepared.ray, prepared.within(), limit),
        }
    }

    #[cold]
    #[inline(never)]
    fn exact_candidate(&self, ray: &Ray, within: Range<f64>, limit: f64) -> Option<Candidate> {
        Candidate::exact(exact::closest(self, ray, within), limit)
    }

    /// The filter for the verdict: `Less` if the line surely passes beside the triangle, `Greater` if through its
    /// interior, in plain doubles; `None` where that is not certain.
    #[inline(always)]
    fn line_beside(&self, prepared: &PreparedRay) -> Option<Ordering> {
        let d = prepared.ray.direction();
        let [a, b, c] = self.vertices.map(|vertex| vertex - prepared.ray.origin());
        let most = |x: f64, y: f64, z: f64| larger(x.abs(), larger(y.abs(), z.abs()));
        let size = most(a.x, b.x, c.x) + most(a.y, b.y, c.y) + most(a.z, b.z, c.z);
        // NaN out of the range for which the bound is proved: nothing is certain then.
        let error =
            if size < FARTHEST { 5.0 * U * prepared.reach * size * size + UNDERFLOW } else { f64::NAN };
        let beside_a = d.cross(a);
        let w = b.dot(beside_a);
        let v = -c.dot(beside_a);
        if v * w < 0.0 && smaller(v.abs(), w.abs()) > error {
            return Some(Ordering::Less);
        }
        let u = c.dot(d.cross(b));
        let least = smaller(u, smaller(v, w));
        let most = larger(u, larger(v, w));
        if least > error || most < -error {
            Some(Ordering::Greater)
        } else if least < -error && most > error {
            Some(Ordering::Less)
        } else {
            None
        }
    }

    /// The filter: the verdict as `line_beside` has it, and for a hit the `t` with a bound of its error.
    #[inline(always)]
    fn line(&self, prepared: &PreparedRay) -> Line {
        match self.line_beside(prepared) {
            Some(Ordering::Less) => return Line::Misses,
            Some(_) => {}
            None => return Line::Unsure,
        }
        let (n, relative) = self.plane();
        let a = self.vertices[0] - prepared.ray.origin();
        let slope = n.dot(prepared.ray.direction());
        let inverse = 1.0 / slope.abs();
        let t = n.dot(a) / slope;
        let error =
            (relative * (max_abs(a) + t.abs() * prepared.reach) + UNDERFLOW * (1.0 + t.abs())) * inverse;
        let error = 1.15 * error + 4.0 * U * t.abs() + UNDERFLOW_T;
        if (relative * prepared.reach + UNDERFLOW) * inverse <= 0.125 {
            Line::Hits(Candidate { low: t - error, high: t + error })
        } else {
            Line::Unsure
        }
    }

    /// Whether the ray is surely not parallel to the triangle, which surely has a plane.
    fn surely_leans(&self, prepared: &PreparedRay) -> bool {
        let (n, relative) = self.plane();
        let slope = n.dot(prepared.ray.direction()).abs();
        slope.is_finite() && slope > relative * prepared.reach + UNDERFLOW
    }

    /// `n = (b - a) x (c - a)` and what to multiply with the largest component of a vector `v` for a bound of the error
    /// of `n . v`.
    #[inline(always)]
    fn plane(&self) -> (DVec3, f64) {
        let [a, b, c] = self.vertices;
        let (e, f) = (b - a, c - a);
        let most = |x: f64, y: f64| larger(x.abs(), y.abs());
        let size = most(e.x, f.x) + most(e.y, f.y) + most(e.z, f.z);
        (e.cross(f), 6.0 * U * size * size)
    }
}

/// What the filter says about a line and a triangle.
enum Line {
    Misses,
    /// Through the interior; the bounds hold for the exact and the correctly rounded `t`, whatever the range.
    Hits(Candidate),
    Unsure,
}
