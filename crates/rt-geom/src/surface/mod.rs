//! The exact point of a surface that a ray hits: where it lies, seen from any point, and how the surface stands there.
//!
//! [`Ray::at`] rounds the hit: of a ball of radius 1 at a distance of 10^15 the rounded point is off by a tenth of the
//! radius, and a normal made from it is noise. Here the point stays what it is, `P = origin + t* direction` with the
//! exact root `t*`, and only a vector that is asked for is rounded, relative to its own length:
//!
//! 1. `filter`: plain doubles and what they cost, an error relative to the way from the origin; no question of its own
//!    but [`HitPoint::estimate`] for the many hits of a picture;
//! 2. `finish`: `t* = t + step` from a Newton step on a residual in double-double, relative to the center or a vertex;
//! 3. `exact`: integers of any size, and balls of any precision on them.

mod exact;
mod filter;
mod finish;

use std::cmp::Ordering;

use glam::DVec3;
use rt_math::Roots;
use rt_math::exact::U;

use crate::{Ray, Shape, Sphere, Triangle};
pub use exact::EnclosedHit;
pub use filter::Estimate;

/// The error of a vector that is good enough to be given: this part of its length.
const FEW_ULP: f64 = 4.0 * U;

/// A vector, and how far it may be from the exact one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounded {
    /// The vector.
    pub vector: DVec3,
    /// A bound of the length of its difference from the exact vector.
    pub error: f64,
}

/// The exact point where a ray hits a sphere or a triangle.
///
/// ```
/// use glam::DVec3;
/// use rt_geom::{Ray, Sphere};
///
/// // A ball of radius 1, 10^15 away: the rounded point is off by some hundredths, the vector from the center is not.
/// let center = DVec3::new(0.0, 3e14, -1e15);
/// let sphere = Sphere::new(center, 1.0).unwrap();
/// let ray = Ray::new(DVec3::ZERO, DVec3::new(1e-16, 0.3, -1.0)).unwrap();
/// let t = sphere.closest(&ray, 0.0..f64::INFINITY).unwrap();
/// let hit = sphere.hit_point(&ray, t);
/// let offset = hit.from(center);
/// assert!((offset.vector.length() - 1.0).abs() <= 1e-15 && offset.error <= 1e-15);
/// assert!((ray.at(t) - center - offset.vector).length() > 1e-3);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct HitPoint<'a> {
    ray: &'a Ray,
    shape: Shape,
    t: f64,
}

/// One of the places where a line meets a sphere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Root {
    /// Where it enters, or touches.
    Near,
    /// Where it leaves.
    Far,
}

impl Sphere {
    /// Returns the exact point of which `t` is the rounding: a `t` that [`closest`](Self::closest) or
    /// [`roots`](Self::roots) gave for this ray.
    ///
    /// Where both roots round to `t`, it is the near one. Any other `t` gives a point without meaning.
    #[must_use]
    pub fn hit_point<'a>(&self, ray: &'a Ray, t: f64) -> HitPoint<'a> {
        HitPoint { ray, shape: Shape::Sphere(*self), t }
    }
}

impl Triangle {
    /// Returns the exact point of which `t` is the rounding: the `t` that [`closest`](Self::closest) gave for this ray.
    ///
    /// Any other `t` gives a point without meaning.
    #[must_use]
    pub fn hit_point<'a>(&self, ray: &'a Ray, t: f64) -> HitPoint<'a> {
        HitPoint { ray, shape: Shape::Triangle(*self), t }
    }
}

impl Shape {
    /// Returns the exact point of which `t` is the rounding: the `t` of a [`Hit`](crate::Hit) of this primitive.
    #[inline]
    #[must_use]
    pub fn hit_point<'a>(&self, ray: &'a Ray, t: f64) -> HitPoint<'a> {
        HitPoint { ray, shape: *self, t }
    }
}

impl<'a> HitPoint<'a> {
    /// Returns the vector from a point to the hit, within a few ulp of its length, or zero if they are the same point.
    ///
    /// For every finite ray, shape and point: the error is at most `4 * 2^-53` of the length, and where a component
    /// underflows at most `2^-1074` more. A component beyond the largest double is infinite, with an infinite error. A
    /// point that is not finite gives NaN. `docs/numerics.md`, section 14, has the proof.
    #[must_use]
    pub fn from(&self, point: impl Into<DVec3>) -> Bounded {
        self.from_within(point, FEW_ULP)
    }

    /// [`from`](Self::from) in less time, where an error of `tolerance` times the length is good enough.
    #[must_use]
    pub fn from_within(&self, point: impl Into<DVec3>, tolerance: f64) -> Bounded {
        let point = point.into();
        if let Some(found) = finish::from(self, point)
            && found.error <= tolerance * found.vector.length()
        {
            return found;
        }
        exact::from(self, point)
    }

    /// Returns the unit normal: of a sphere outward, of a triangle on the side from which its vertices turn
    /// counterclockwise; within a few ulp, whatever the distance.
    ///
    /// Within `7 * 2^-53` of the exact one, for every finite ray and shape. A sphere of radius 0 faces the ray: its
    /// normal is the reversed direction. A triangle without area has none, and no hit: NaN.
    #[must_use]
    pub fn normal(&self) -> Bounded {
        match self.shape {
            Shape::Sphere(sphere) if sphere.radius() == 0.0 => finish::unit(-self.ray.direction()),
            Shape::Sphere(sphere) => {
                let normal = |offset: Bounded| Bounded {
                    vector: offset.vector / sphere.radius(),
                    error: offset.error / sphere.radius() + 1.01 * U,
                };
                finish::from(self, sphere.center())
                    .map(normal)
                    .filter(|normal| normal.error <= 6.0 * U)
                    .unwrap_or_else(|| exact::sphere_normal(self, &sphere))
            }
            Shape::Triangle(triangle) => {
                let unknown = Bounded { vector: DVec3::NAN, error: f64::NAN };
                triangle.normal().map_or(unknown, |vector| Bounded { vector, error: 4.6 * U })
            }
        }
    }

    /// Whether the normal is on the side that the ray comes from, exactly. So it is at a sphere's near root and where
    /// the ray touches the sphere.
    #[must_use]
    pub fn faces_ray(&self) -> bool {
        match &self.shape {
            Shape::Sphere(sphere) => sphere.radius() == 0.0 || self.root(sphere) == Root::Near,
            Shape::Triangle(triangle) => exact::slope(triangle, self.ray) == Ordering::Less,
        }
    }

    /// On which side of the plane that touches the surface at the hit a point lies, exactly: `Greater` where the normal
    /// leads, `Equal` in the plane. A point that is not finite lies nowhere: `Equal`.
    ///
    /// ```
    /// use std::cmp::Ordering;
    /// use glam::DVec3;
    /// use rt_geom::{Ray, Triangle};
    ///
    /// let triangle = Triangle::new(DVec3::ZERO, DVec3::X, DVec3::new(0.1, 0.3, 0.7)).unwrap();
    /// let ray = Ray::new(DVec3::new(0.3, 5.0, 0.2), DVec3::NEG_Y).unwrap();
    /// let hit = triangle.hit_point(&ray, triangle.closest(&ray, 0.0..f64::INFINITY).unwrap());
    /// assert_eq!(hit.side_of(DVec3::new(-8.0, 0.3, 0.7)), Ordering::Equal);
    /// assert!(hit.faces_ray() == (hit.side_of(ray.origin()) == Ordering::Greater));
    /// ```
    #[must_use]
    pub fn side_of(&self, point: impl Into<DVec3>) -> Ordering {
        let point = point.into();
        if !point.is_finite() {
            return Ordering::Equal;
        }
        match &self.shape {
            Shape::Sphere(sphere) => {
                finish::sphere_side(self, sphere, point).unwrap_or_else(|| exact::sphere_side(self, sphere, point))
            }
            Shape::Triangle(triangle) => exact::plane_side(triangle, point),
        }
    }

    /// The weights of a triangle's vertices, each correctly rounded; `None` for a sphere.
    #[must_use]
    pub fn weights(&self) -> Option<[f64; 3]> {
        match &self.shape {
            Shape::Sphere(_) => None,
            Shape::Triangle(triangle) => triangle.line_barycentric(self.ray),
        }
    }

    /// What plain doubles know of the hit: the cheapest answer, with bounds that tell what it is worth.
    #[inline]
    #[must_use]
    pub fn estimate(&self) -> Estimate {
        filter::estimate(self)
    }

    /// The hit in exact numbers, from which its vectors are enclosed to any precision.
    #[must_use]
    pub fn enclosed(&self) -> EnclosedHit<'a> {
        EnclosedHit::new(self)
    }

    /// The sphere or triangle that is hit.
    #[inline]
    #[must_use]
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// Which root of a sphere it is.
    fn root(&self, sphere: &Sphere) -> Root {
        finish::root(self, sphere).unwrap_or_else(|| match sphere.roots(self.ray) {
            // Where both round to the same double, the near one is hit.
            Roots::Two(near, far) if self.t != near && self.t == far => Root::Far,
            _ => Root::Near,
        })
    }
}

#[cfg(test)]
#[expect(clippy::neg_cmp_op_on_partial_ord, reason = "a bound that is NaN says nothing")]
mod tests {
    use oracle::{Big, Crossing, Random, cases, cross, dot, exact, power_of_two, rounded, sign, sub, vector};

    use super::exact::from as from_integers;
    use super::*;

    /// How many cases the long run has.
    const LONG: usize = 100_000;
    /// Bits of the reference: enough for what cancels between any doubles.
    const BITS: usize = 9_000;

    fn long(x: &Big) -> Big {
        x.clone().with_precision(BITS).value()
    }

    fn length(v: &[Big; 3]) -> f64 {
        rounded(&long(&dot(v, v)).sqrt())
    }

    /// The exact numbers of a hit: how far the vectors lie from the ones that are found.
    struct Truth {
        /// The hit relative to the ray's origin, and a positive multiple of the normal.
        way: [Big; 3],
        normal: [Big; 3],
        /// The length of the normal.
        length: Big,
        /// A point of the plane, of which the distance is exact.
        vertex: Option<DVec3>,
    }

    impl Truth {
        fn at_sphere(ray: &Ray, sphere: &Sphere, far: bool) -> Self {
            let d = vector(ray.direction());
            let w = sub(&vector(ray.origin()), &vector(sphere.center()));
            let r = exact(sphere.radius());
            let (a, b, c) = (dot(&d, &d), dot(&w, &d), dot(&w, &w) - &r * &r);
            let root = long(&(&b * &b - &a * c)).sqrt();
            let t = (if far { root - b } else { -root - b }) / long(&a);
            let way = d.map(|d| long(&(d * &t)));
            let normal = [0, 1, 2].map(|i| &w[i] + &way[i]);
            Self { way, normal, length: r, vertex: None }
        }

        fn at_triangle(ray: &Ray, triangle: &Triangle) -> Self {
            let d = vector(ray.direction());
            let [a, b, c] = triangle.vertices().map(|vertex| sub(&vector(vertex), &vector(ray.origin())));
            let normal = cross(&sub(&b, &a), &sub(&c, &a));
            let t = long(&dot(&normal, &a)) / long(&dot(&normal, &d));
            let length = long(&dot(&normal, &normal)).sqrt();
            let vertex = Some(triangle.vertices()[0]);
            Self { way: d.map(|d| long(&(d * &t))), normal, length, vertex }
        }

        fn from(&self, ray: &Ray, point: DVec3) -> [Big; 3] {
            let w = sub(&vector(ray.origin()), &vector(point));
            [0, 1, 2].map(|i| &w[i] + &self.way[i])
        }

        fn unit_normal(&self) -> [Big; 3] {
            self.normal.each_ref().map(|part| long(part) / &self.length)
        }

        fn side_of(&self, ray: &Ray, point: DVec3) -> Ordering {
            match self.vertex {
                Some(vertex) => sign(&dot(&sub(&vector(point), &vector(vertex)), &self.normal)),
                None => sign(&-dot(&self.from(ray, point), &self.normal)),
            }
        }
    }

    /// The distance of what is found from the exact vector; of what is not finite, infinite.
    fn error(found: DVec3, truth: &[Big; 3]) -> f64 {
        if found.is_finite() { length(&sub(&vector(found), truth)) } else { f64::INFINITY }
    }

    /// Checks all that a hit tells, seen from some points; returns how many vectors double-double found.
    fn check(hit: &HitPoint, truth: &Truth, points: &[DVec3]) -> usize {
        let (ray, enclosed) = (hit.ray, hit.enclosed());
        // What the reference rounds.
        let slack = long(&dot(&truth.way, &truth.way)).sqrt() * power_of_two(20 - 9_000);
        let mut refined = 0;
        for &point in points {
            let exact_vector = truth.from(ray, point);
            let exact_length = length(&exact_vector);
            for found in [Some(hit.from(point)), finish::from(hit, point), Some(from_integers(hit, point))] {
                let Some(Bounded { vector, error: bound }) = found else { continue };
                if !vector.is_finite() {
                    assert!(!(bound < f64::INFINITY) && exact_length > 1e308, "{hit:?} from {point:?}: {found:?}");
                    continue;
                }
                let error = error(vector, &exact_vector);
                assert!(error <= bound, "{hit:?} from {point:?}: {vector:?} is {error:e} off, bound {bound:e}");
            }
            let found = hit.from(point);
            let allowed = 1.001 * FEW_ULP * exact_length + 2.0 * f64::from_bits(1);
            assert!(found.error <= allowed || !found.vector.is_finite(), "{hit:?} from {point:?}: {found:?}");
            refined += usize::from(finish::from(hit, point).is_some_and(|found| found.error <= FEW_ULP * exact_length));
            for (ball, truth) in enclosed.from::<4>(point).iter().zip(&exact_vector) {
                let (low, high) = ball.ends();
                let inside = (low == f64::NEG_INFINITY || exact(low) - &slack <= *truth)
                    && (high == f64::INFINITY || *truth <= exact(high) + &slack);
                assert!(inside, "{hit:?} from {point:?}: {truth} is not in {low:e}..{high:e}");
                let width = 1e-15 * high.abs().max(low.abs()).max(1e-30 * exact_length) + f64::MIN_POSITIVE;
                assert!(!(high - low > width), "{hit:?} from {point:?}: {low:e}..{high:e}");
            }
            assert_eq!(hit.side_of(point), truth.side_of(ray, point), "{hit:?} and {point:?}");
        }
        let normal = hit.normal();
        let wrong = error(normal.vector, &truth.unit_normal());
        assert!(wrong <= normal.error && normal.error <= 7.0 * U, "{hit:?}: {normal:?} is {wrong:e} off");
        assert_eq!(
            hit.faces_ray(),
            sign(&dot(&vector(ray.direction()), &truth.normal)) != Ordering::Greater,
            "{hit:?}"
        );
        let estimate = hit.estimate();
        let (point, normal) =
            (error(estimate.point, &truth.from(ray, DVec3::ZERO)), error(estimate.normal, &truth.normal));
        assert!(!(point > estimate.point_error), "{hit:?}: {estimate:?} is {point:e} off");
        assert!(!(normal > estimate.normal_error), "{hit:?}: {estimate:?} is {normal:e} off");
        refined
    }

    /// Checks the hit of a ray that meets the sphere, seen from the center, the origin, and points near the hit.
    fn check_sphere(ray: &Ray, sphere: &Sphere, random: &mut Random) -> Option<usize> {
        let t = sphere.closest(ray, 0.0..f64::INFINITY)?;
        let near = match sphere.roots(ray) {
            Roots::Two(near, far) => near == t || near == far,
            _ => true,
        };
        let truth = Truth::at_sphere(ray, sphere, !near);
        let hit = sphere.hit_point(ray, t);
        let beside = hit.from(DVec3::ZERO).vector;
        let nudged = beside + sphere.radius() * random.power(-60..4) * random.point();
        let points = [sphere.center(), ray.origin(), random.point(), beside, nudged]
            .map(|point| point.clamp(-DVec3::MAX, DVec3::MAX));
        Some(check(&hit, &truth, &points))
    }

    #[test]
    fn hits_of_spheres_at_any_distance_are_known_to_a_few_ulp() {
        let random = &mut Random::new(1);
        let (mut hits, mut refined) = (0, 0);
        for i in 0..cases(LONG) / 4 {
            let (radius, distance) = (random.power(-3..3), random.power(-2..64));
            let direction = random.power(-4..4) * random.point().normalize();
            let center = distance * random.point();
            let sphere = Sphere::new(center, radius).unwrap();
            let aim = center + radius * [0.5, 1.0, 0.99999][i % 3] * random.point().normalize();
            let ray = Ray::new(aim - distance * direction, direction).unwrap();
            if let Some(found) = check_sphere(&ray, &sphere, random) {
                (hits, refined) = (hits + 1, refined + found);
            }
        }
        assert!(hits > cases(LONG) / 16, "{hits}");
        // Of five points each two lie at the hit itself.
        assert!(refined > 2 * hits && refined < 5 * hits, "double-double found {refined} vectors of {hits} hits");
    }

    #[test]
    fn the_center_and_the_eye_are_seen_without_exact_numbers() {
        let random = &mut Random::new(2);
        let mut open = 0;
        for i in 0..cases(LONG) / 4 {
            let distance = random.power(-2..62);
            let center = distance * random.point();
            let sphere = Sphere::new(center, 1.0).unwrap();
            let direction = center + 0.7 * random.point();
            let ray = Ray::new(DVec3::ZERO, direction / distance).unwrap();
            let Some(t) = sphere.closest(&ray, 0.0..f64::INFINITY) else { continue };
            let found = finish::from(&sphere.hit_point(&ray, t), center);
            open += usize::from(!found.is_some_and(|found| found.error <= FEW_ULP));
            assert!(open < 20 + i / 500, "{open} of {i} are left to exact numbers");
        }
    }

    #[test]
    fn hits_of_spheres_of_any_doubles_are_known() {
        let random = &mut Random::new(3);
        let mut hits = 0;
        for _ in 0..cases(LONG) / 40 {
            let (place, size, way) = (random.power(-1000..1000), random.power(-1000..1000), random.power(-1000..1000));
            let center = place * random.point();
            let radius = if random.one_in(8) { 0.0 } else { size };
            let Ok(sphere) = Sphere::new(center, radius) else { continue };
            let direction = way * random.point();
            let origin = center + size.max(place) * random.point();
            let towards = if random.one_in(2) { center - origin } else { direction };
            let Ok(ray) = Ray::new(origin, towards) else { continue };
            if radius > 0.0 {
                hits += usize::from(check_sphere(&ray, &sphere, random).is_some());
            }
        }
        assert!(hits > cases(LONG) / 400, "{hits}");
    }

    #[test]
    fn a_point_faces_the_ray() {
        let sphere = Sphere::new(DVec3::new(1.0, 2.0, 3.0), 0.0).unwrap();
        let ray = Ray::new(DVec3::ZERO, DVec3::new(0.5, 1.0, 1.5)).unwrap();
        let hit = sphere.hit_point(&ray, sphere.closest(&ray, 0.0..f64::INFINITY).unwrap());
        assert_eq!(hit.from(DVec3::ONE), Bounded { vector: DVec3::new(0.0, 1.0, 2.0), ..hit.from(DVec3::ONE) });
        assert!((hit.normal().vector + ray.direction().normalize()).length() < 8.0 * U && hit.faces_ray());
        assert_eq!(hit.side_of(DVec3::ZERO), Ordering::Greater);
        assert_eq!(hit.side_of(DVec3::new(3.0, 1.0, 3.0)), Ordering::Equal);
        assert_eq!(hit.enclosed().normal::<2>()[2].ends(), (-1.5, -1.5));
    }

    #[test]
    fn hits_of_triangles_are_known_to_a_few_ulp() {
        let random = &mut Random::new(4);
        let (mut hits, mut refined, mut weighed) = (0, 0, 0);
        for i in 0..cases(LONG) / 4 {
            let scale = if i % 8 == 0 { random.power(-300..300) } else { 1.0 };
            let (size, place) = (scale * random.power(-8..8), scale * random.power(-8..60));
            let base = if i % 2 == 0 { place * random.point() } else { DVec3::ZERO };
            let flat = if i % 5 == 0 { random.power(-40..0) } else { 1.0 };
            let [a, b] = [base + size * random.point(), base + size * random.point()];
            let c = a + (b - a) * random.share() + flat * size * random.point();
            let triangle = Triangle::new(a, b, c).unwrap();
            let (u, v) = (0.5 * random.share(), 0.5 * random.share());
            let direction = random.power(-4..4) * random.point();
            let origin = a + u * (b - a) + v * (c - a) - size.max(place) * random.power(-8..4) * direction;
            let ray = Ray::new(origin, direction).unwrap();
            let Some(t) = triangle.closest(&ray, 0.0..f64::INFINITY) else { continue };
            let truth = Truth::at_triangle(&ray, &triangle);
            let hit = triangle.hit_point(&ray, t);
            let beside = hit.from(DVec3::ZERO).vector;
            let points = [a, origin, random.point(), beside, a + 2.0 * (b - a) - 3.0 * (c - a)];
            refined += check(&hit, &truth, &points);
            hits += 1;
            let [d, o] = [ray.direction(), ray.origin()].map(vector);
            let weights =
                Crossing::new(&d, triangle.vertices().map(|vertex| sub(&vector(vertex), &o))).weights().unwrap();
            let (found, bound) = triangle.estimated_weights(&hit.estimate());
            for j in 0..3 {
                if bound < f64::INFINITY {
                    let error = (exact(found[j]) - &weights[j]).to_f64().value().abs();
                    let bound = if j == 0 { 2.0 * bound + 2.0 * U } else { bound };
                    assert!(error <= bound, "{hit:?}: weight {j} of {found:?} is {error:e} off, bound {bound:e}");
                }
                let (low, high) = hit.enclosed().weights::<2>().unwrap()[j].ends();
                assert!(
                    exact(low) <= weights[j] && weights[j] <= exact(high),
                    "{hit:?}: weight {j}, {low:e}..{high:e}"
                );
            }
            weighed += usize::from(bound < 1e-9);
        }
        assert!(hits > cases(LONG) / 16 && weighed > hits / 4, "{hits} {weighed}");
        assert!(refined > hits && refined < 5 * hits, "double-double found {refined} vectors of {hits} hits");
    }

    #[test]
    fn planes_and_tangent_planes_are_decided_exactly() {
        // The plane z = 1 touches the ball at (0, 0, 1), where the ray from above hits it.
        let sphere = Sphere::new(DVec3::ZERO, 1.0).unwrap();
        let ray = Ray::new(DVec3::new(0.0, 0.0, 3.0), DVec3::NEG_Z).unwrap();
        let hit = sphere.hit_point(&ray, 2.0);
        let side = |z: f64| hit.side_of(DVec3::new(5.0, -7.0, z));
        assert_eq!(
            [side(1f64.next_down()), side(1.0), side(1f64.next_up())],
            [Ordering::Less, Ordering::Equal, Ordering::Greater]
        );
        let inside = Ray::new(DVec3::ZERO, DVec3::Z).unwrap();
        assert!(hit.faces_ray() && !sphere.hit_point(&inside, 1.0).faces_ray());
        assert_eq!(hit.side_of(DVec3::NAN), Ordering::Equal);
        assert!(hit.from(DVec3::INFINITY).vector.is_nan());
    }

    #[test]
    fn hits_closer_than_a_square_underflows_are_known_too() {
        let random = &mut Random::new(5);
        let mut hits = 0;
        for _ in 0..cases(LONG) / 20 {
            let corner = if random.one_in(2) { DVec3::ZERO } else { random.power(-1000..-500) * random.point() };
            let [e, f] = [random.point(), random.point()];
            let triangle = Triangle::new(corner, e, f).unwrap();
            let near = random.power(-600..-480);
            let (u, v, direction) = (random.share(), random.share(), random.point());
            let aim = corner + near * (u * e + v * f);
            let Ok(ray) = Ray::new(aim - near * direction, direction) else { continue };
            let Some(t) = triangle.closest(&ray, 0.0..f64::INFINITY) else { continue };
            let truth = Truth::at_triangle(&ray, &triangle);
            let hit = triangle.hit_point(&ray, t);
            let points = [corner, ray.origin(), aim, aim + near * random.point(), near * random.point()];
            check(&hit, &truth, &points);
            hits += 1;
        }
        assert!(hits > cases(LONG) / 80, "{hits}");
    }

    #[test]
    fn roots_a_few_doubles_apart_are_told_apart() {
        let random = &mut Random::new(6);
        let (mut known, mut all) = ([0; 2], 0);
        for _ in 0..cases(LONG) / 2 {
            // About a power of two, where the doubles below are twice as dense.
            let (power, axis) = (random.power(-20..40), DVec3::AXES[random.below(3)]);
            let spacing = power * 2.0 * U;
            let t = power + spacing * 0.5 * random.small(6);
            let direction = random.sign() * random.pick(&[1.0, 3.0, 0.7]) * axis;
            let beside = DVec3::from_array(axis.to_array().map(|on| if on == 1.0 { 0.0 } else { random.uniform() }));
            let radius =
                direction.length() * spacing * random.pick(&[0.3, 0.5, 1.0, 2.5, 1e3, 1e9]) * random.within(0.2, 1.5);
            let origin = DVec3::from_array(axis.to_array().map(|on| on * random.pick(&[0.0, 1.0, -power])));
            let center = origin + t * direction + 0.7 * radius * beside;
            let (Ok(sphere), Ok(ray)) = (Sphere::new(center, radius), Ray::new(origin, direction)) else {
                continue;
            };
            let Roots::Two(near, far) = sphere.roots(&ray) else { continue };
            for t in [near, far] {
                all += 1;
                let expected = if t == near { Root::Near } else { Root::Far };
                if let Some(found) = finish::root(&sphere.hit_point(&ray, t), &sphere) {
                    assert_eq!(found, expected, "{ray:?} {sphere:?}: {near:e} {far:e}, {t:e}");
                    known[usize::from(found == Root::Far)] += 1;
                }
                let truth = Truth::at_sphere(&ray, &sphere, expected == Root::Far);
                check(&sphere.hit_point(&ray, t), &truth, &[center, origin]);
            }
        }
        assert!(known[0] > all / 4 && known[1] > all / 8, "{known:?} of {all}");
    }

    #[test]
    fn hits_at_the_origin_of_the_ray_and_from_inside_are_known() {
        let random = &mut Random::new(7);
        let mut hits = 0;
        for i in 0..cases(LONG) / 10 {
            let (center, radius) = (random.power(-4..8) * random.point(), random.power(-8..60));
            let sphere = Sphere::new(center, radius).unwrap();
            let axis = DVec3::AXES[random.below(3)];
            let origin = match i % 3 {
                // On the surface, exactly or within rounding.
                0 => center + random.sign() * radius * axis,
                1 => center + radius * random.point().normalize(),
                _ => center + 0.9 * radius * random.share() * axis,
            };
            let direction = random.power(-3..3) * if i % 2 == 0 { random.point() } else { random.sign() * axis };
            let Ok(ray) = Ray::new(origin, direction) else { continue };
            hits += usize::from(check_sphere(&ray, &sphere, random).is_some());
        }
        assert!(hits > cases(LONG) / 30, "{hits}");
    }

    #[test]
    fn what_is_unknown_never_looks_small() {
        let triangle = Triangle::new(DVec3::ZERO, DVec3::X, 2.0 * DVec3::X).unwrap();
        let ray = Ray::new(DVec3::ONE, DVec3::NEG_Y).unwrap();
        let flat = triangle.hit_point(&ray, 1.0);
        assert!(flat.normal().error.is_nan());
        let is_unknown = |bound: f64| bound.is_nan() || bound == f64::INFINITY;
        assert!(is_unknown(triangle.estimated_weights(&flat.estimate()).1));
        let sphere = Sphere::new(DVec3::ZERO, 1.0).unwrap();
        for t in [f64::INFINITY, f64::NAN, f64::MAX] {
            let far = Ray::new(DVec3::ONE, 1e10 * DVec3::ONE).unwrap();
            let estimate = sphere.hit_point(&far, t).estimate();
            assert!(is_unknown(estimate.point_error) && is_unknown(estimate.normal_error), "{estimate:?}");
        }
    }

    #[test]
    fn the_weights_of_slivers_are_within_their_bound() {
        let random = &mut Random::new(8);
        let (mut known, mut sharpest) = (0, 0.0f64);
        for i in 0..cases(LONG) / 4 {
            let scale = if i % 4 == 0 { random.power(-280..140) } else { 1.0 };
            let base = scale * random.power(-8..20) * random.point();
            let a = base + scale * random.point();
            let b = base + scale * random.point();
            let c = a + (b - a) * random.within(-0.5, 1.5) + scale * random.power(-30..-4) * random.point();
            let Ok(triangle) = Triangle::new(a, b, c) else { continue };
            let aim = a + 0.5 * random.share() * (b - a) + 0.5 * random.share() * (c - a);
            let direction = scale * random.point();
            let Ok(ray) = Ray::new(aim - random.power(-4..6) * direction, direction) else { continue };
            let Some(t) = triangle.closest(&ray, 0.0..f64::INFINITY) else { continue };
            let [d, o] = [ray.direction(), ray.origin()].map(vector);
            let corners = triangle.vertices().map(|vertex| sub(&vector(vertex), &o));
            let truth = Crossing::new(&d, corners).weights().unwrap();
            let (found, bound) = triangle.estimated_weights(&triangle.hit_point(&ray, t).estimate());
            if bound < 1.0 {
                known += 1;
                for j in 0..3 {
                    let error = (exact(found[j]) - &truth[j]).to_f64().value().abs();
                    let bound = if j == 0 { 2.0 * bound + 2.0 * U } else { bound };
                    assert!(
                        error <= bound,
                        "{triangle:?} {ray:?}: weight {j} of {found:?} is {error:e} off, {bound:e}"
                    );
                    sharpest = sharpest.max(error / bound);
                }
            }
        }
        assert!(known > cases(LONG) / 50 && sharpest > 0.02, "{known} {sharpest}");
    }

    #[test]
    fn double_double_knows_a_hit_up_to_the_ends_of_its_range() {
        let power = |k: i32| 2f64.powi(k);
        let is_known = |center: DVec3, radius: f64, way: f64| {
            let (sphere, ray) = (Sphere::new(center, radius).unwrap(), Ray::new(DVec3::ZERO, way * DVec3::Z).unwrap());
            let hit = sphere.hit_point(&ray, sphere.closest(&ray, 0.0..f64::INFINITY).expect("ahead"));
            (finish::from(&hit, center).is_some(), finish::root(&hit, &sphere))
        };
        for (k, known) in [(299, true), (302, false)] {
            let root = known.then_some(Root::Near);
            assert_eq!(is_known(power(k) * DVec3::Z, power(k - 4), 1.0), (known, root), "center {k}");
            assert_eq!(is_known(power(k - 89) * DVec3::Z, power(k - 93), power(-89)), (known, root), "t {k}");
            assert_eq!(is_known(DVec3::ZERO, power(k), 1.0), (known, known.then_some(Root::Far)), "radius {k}");
        }
        for (k, known) in [(-149, true), (-152, false)] {
            let near = is_known(power(k + 2) * DVec3::Z, power(k), 1.0);
            assert_eq!(near, (known, known.then_some(Root::Near)), "radius {k}");
        }
        // The point from which the hit is seen.
        let (sphere, ray) = (Sphere::new(DVec3::Z, 0.5).unwrap(), Ray::new(DVec3::ZERO, DVec3::Z).unwrap());
        let hit = sphere.hit_point(&ray, 0.5);
        let seen = |k: i32| finish::from(&hit, power(k) * DVec3::X).is_some();
        assert_eq!([299, 302].map(seen), [true, false]);
        // A triangle, of which the first vertex and the edges count.
        let triangle_is_known = |k: i32| {
            let size = power(k);
            let [a, b, c] = [[-1.0, -1.0], [3.0, -1.0], [-1.0, 3.0]].map(|[x, y]| size * DVec3::new(x, y, 1.0));
            let triangle = Triangle::new(a, b, c).unwrap();
            let t = triangle.closest(&ray, 0.0..f64::INFINITY).expect("ahead");
            finish::from(&triangle.hit_point(&ray, t), DVec3::ZERO).is_some()
        };
        assert_eq!([295, 302].map(triangle_is_known), [true, false]);
    }
}
