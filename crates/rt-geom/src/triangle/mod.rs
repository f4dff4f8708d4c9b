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
//! closed mesh has no gap.
//!
//! Möller and Trumbore's formulas give the same volumes (negative, and two of them as differences from the sum). In plain
//! doubles with an error bound they decide nearly every case here, and `exact.rs` decides the rest. The last bits of `t`
//! and of the weights come from one step of iterative refinement, in `finish.rs`.

mod exact;
mod finish;
mod locate;

use std::ops::Range;

use glam::DVec3;
use rt_math::exact::{U, power_of_two};

use crate::Ray;
use crate::ray::{Candidate, PreparedRay, cross, dot, larger, max_abs, smaller};
pub use locate::{Inside, inside_triangle};

/// Where the filter's bounds are proved: the edges are at least this long, `2^-150`, and the triangle with the ray's origin
/// is smaller than `2^300`. Nothing overflows there, and what underflows is far below the bounds.
const SHORTEST: f64 = power_of_two(-150);
const FARTHEST: f64 = power_of_two(300);

/// The error of each volume that the filter computes, relative to `D E (E + S)`, and of the height, relative to `E² (E + S)`,
/// as `docs/numerics.md`, section 6, has them.
const ERROR: f64 = 18.0 * U;

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
    /// `E`: the sum over the axes of the larger component of the edges from the first vertex. Infinite, so that no filter is
    /// certain, if that is too small for the filters' bounds.
    edge: f64,
}

impl Triangle {
    /// Returns the triangle, or `None` if a coordinate is not finite. A triangle without area is allowed, and
    /// nothing hits it.
    pub fn new(a: DVec3, b: DVec3, c: DVec3) -> Option<Self> {
        let valid = a.is_finite() && b.is_finite() && c.is_finite();
        let (e, f) = (b - a, c - a);
        let most = |x: f64, y: f64| larger(x.abs(), y.abs());
        let edge = most(e.x, f.x) + most(e.y, f.y) + most(e.z, f.z);
        let edge = if edge > SHORTEST { edge } else { f64::INFINITY };
        valid.then_some(Self { vertices: [a, b, c], edge })
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
        finish::closest(self, ray, within.start, within.end)
    }

    /// Whether the ray meets the triangle in the range: the same as `closest(..).is_some()`, found sooner.
    #[inline]
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
    pub fn verdict(&self, ray: &Ray) -> Verdict {
        let line = match self.line::<false>(ray) {
            Line::Hits(_) => Verdict::Interior,
            Line::Misses if self.surely_leans(ray) => Verdict::Miss,
            Line::Misses | Line::Unsure => exact::line_verdict(self, ray),
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
    pub fn crosses(&self, ray: &Ray) -> bool {
        match self.line::<false>(ray) {
            Line::Misses => false,
            Line::Hits(crossing) => match crossing.height() {
                (height, error) if height > error => true,
                (height, error) if height < -error => false,
                _ => exact::crosses(self, ray),
            },
            Line::Unsure => exact::crosses(self, ray),
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
        let area = max_abs((b - a).cross(c - a));
        let certain = self.edge < FARTHEST && area > 16.0 * U * self.edge * self.edge;
        !certain && exact::is_degenerate(self)
    }

    /// Returns the weights of the three vertices where the ray's whole line meets the triangle, each correctly rounded,
    /// or `None` if it does not.
    ///
    /// The weights lie in 0..=1, and their sum is 1 but for the rounding of each. A weight is zero exactly on the
    /// opposite edge, or where it underflows.
    pub fn hit_barycentric(&self, ray: &Ray) -> Option<[f64; 3]> {
        finish::weights(self, ray)
    }

    /// Returns `t` and the weights of the three vertices at the hit, if it is in the range: what [`Self::closest`] and
    /// [`Self::hit_barycentric`] give, in less time than both.
    pub fn closest_with_barycentric(&self, ray: &Ray, within: Range<f64>) -> Option<(f64, [f64; 3])> {
        finish::closest_with_weights(self, ray, within.start, within.end)
    }

    /// What `any` returns.
    #[inline(always)]
    pub(crate) fn meets<const FMA: bool>(&self, prepared: &PreparedRay) -> bool {
        if prepared.start.to_bits() != 0 || prepared.end != f64::INFINITY {
            return self.candidate::<FMA>(prepared, f64::INFINITY).is_some();
        }
        // For the whole ray the sign of `t` is enough, and needs no division.
        match self.line::<FMA>(prepared.ray) {
            Line::Misses => return false,
            Line::Hits(crossing) => {
                let (height, error) = crossing.height();
                if height.abs() > error {
                    return height > 0.0;
                }
            }
            Line::Unsure => {}
        }
        self.exact_candidate(prepared.ray, prepared.within(), f64::INFINITY).is_some()
    }

    /// Returns bounds of the hit's `t`, or `None` if nothing in the range is hit or the hit surely lies beyond
    /// `limit`.
    #[inline(always)]
    pub(crate) fn candidate<const FMA: bool>(&self, prepared: &PreparedRay, limit: f64) -> Option<Candidate> {
        match self.line::<FMA>(prepared.ray) {
            Line::Misses => None,
            Line::Hits(crossing) => prepared.admit(crossing.bounds(prepared.ray), limit, || {
                self.exact_candidate(prepared.ray, prepared.within(), limit)
            }),
            Line::Unsure => self.exact_candidate(prepared.ray, prepared.within(), limit),
        }
    }

    #[cold]
    #[inline(never)]
    fn exact_candidate(&self, ray: &Ray, within: Range<f64>, limit: f64) -> Option<Candidate> {
        Candidate::exact(exact::closest(self, ray, within), limit)
    }

    /// The filter: tells in plain doubles whether the line meets the interior or passes beside the triangle, where that
    /// is certain.
    ///
    /// Source: T. Möller, B. Trumbore, "Fast, minimum storage ray/triangle intersection", 1997; the bounds are ours.
    #[inline(always)]
    fn line<const FMA: bool>(&self, ray: &Ray) -> Line {
        let [a, b, c] = self.vertices;
        let (e, f, s) = (b - a, c - a, ray.origin() - a);
        let edge = self.edge;
        let size = edge + (s.x.abs() + s.y.abs() + s.z.abs());
        let spread = (ERROR * edge) * size;
        // NaN if the direction is out of the range where this is proved.
        let error = spread * ray.reach();
        if size >= FARTHEST {
            return Line::Unsure;
        }
        let p = cross::<FMA>(ray.direction(), f);
        let sum = dot::<FMA>(e, p);
        // From here on as if the sum were positive.
        let sign = 1f64.copysign(sum);
        let (sum, v) = (sum.abs(), sign * dot::<FMA>(s, p));
        let q = cross::<FMA>(s, e);
        let w = sign * dot::<FMA>(ray.direction(), q);
        let u = (sum - v) - w;
        // All three at once: one branch to foretell.
        let least = smaller(v, smaller(u, w));
        // False for NaN.
        if smaller(sum, least.abs()) > error {
            if least < 0.0 {
                return Line::Misses;
            }
            let height = sign * dot::<FMA>(f, q);
            return Line::Hits(Crossing { e, f, p, sign, sum, v, w, height, edge, size, spread });
        }
        if self.passes_beside(ray, error) { Line::Misses } else { Line::Unsure }
    }

    /// Whether a line of which the filter is not sure passes surely beside the triangle: two volumes have opposite signs,
    /// be it parallel to the plane or not.
    #[cold]
    #[inline(never)]
    fn passes_beside(&self, ray: &Ray, error: f64) -> bool {
        let [a, b, c] = self.vertices;
        let (e, f, s) = (b - a, c - a, ray.origin() - a);
        let p = ray.direction().cross(f);
        let (sum, v, w) = (e.dot(p), s.dot(p), ray.direction().dot(s.cross(e)));
        let u = (sum - v) - w;
        smaller(u, smaller(v, w)) < -error && larger(u, larger(v, w)) > error
    }

    /// Whether the ray is surely not parallel to the triangle, which surely has a plane.
    fn surely_leans(&self, ray: &Ray) -> bool {
        let [a, b, c] = self.vertices;
        let error = (ERROR * self.edge) * self.edge * ray.reach();
        self.edge < FARTHEST && ray.direction().cross(c - a).dot(b - a).abs() > error
    }
}

/// What the filter says about a line and a triangle.
enum Line {
    Misses,
    /// Through the interior, whatever the range.
    Hits(Crossing),
    Unsure,
}

/// Möller and Trumbore's quantities for a line that surely meets the interior, all but `e`, `f`, `p` with the sign that makes the
/// sum of the volumes positive.
struct Crossing {
    /// The edges from the first vertex to the others.
    e: DVec3,
    f: DVec3,
    /// `d x f`
    p: DVec3,
    /// What the others have been multiplied with: 1 or -1.
    sign: f64,
    /// The sum of the three volumes, and two of them: the weights of the vertices times the sum.
    sum: f64,
    v: f64,
    w: f64,
    /// `t` times the sum.
    height: f64,
    /// `E`: the sum over the axes of the largest component of the edges.
    edge: f64,
    /// `E + S`, with `S` the same for the origin relative to the first vertex.
    size: f64,
    /// What the errors of volumes and height are proportional to.
    spread: f64,
}

impl Crossing {
    /// The height, which has the sign of `t`, and a bound of its error.
    #[inline(always)]
    fn height(&self) -> (f64, f64) {
        (self.height, self.spread * self.edge)
    }

    /// Bounds of the exact and of the correctly rounded `t`.
    #[inline(always)]
    fn bounds(&self, ray: &Ray) -> (f64, f64) {
        let inverse = 1.0 / self.sum;
        let t = self.height * inverse;
        let error = self.spread * (self.edge + t.abs() * ray.reach()) * inverse;
        (t - error, t + error)
    }
}
