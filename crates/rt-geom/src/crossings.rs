//! Where a ray enters and leaves surfaces, in order: what counts for closed meshes.
//!
//! The ray is turned to the direction `d + (e, e², e³)` with an infinitely small `e > 0`, for all surfaces alike
//! ([`Triangle::crosses`] has the rule). It passes no edge, no vertex and no plane along its face and touches no sphere,
//! unless its origin lies there, so entering and leaving a closed surface alternate. The order is that of the turned
//! ray: by the rounded `t`, and where that is equal by exact numbers,
//!
//! ```text
//!     triangle:  t = h / s(e)                          s(e) = N.d + e N_x + e² N_y + e³ N_z
//!     sphere:    t = (-b -+ sqrt(Delta)) / a
//! ```

use std::cmp::Ordering;

use glam::DVec3;
use rt_math::Roots;
use rt_math::exact::Dyadic;
use rt_math::exact::vector::{cross, difference, dot};

use crate::leaf::{Leaf, Leaves, Query};
use crate::ray::PreparedRay;
use crate::triangle::slope_sign;
use crate::{Ray, Shape, Side, Sphere, Triangle};

/// Limbs for the order of two crossings: of degree ten at most, multiples of 2^-10740 below 2^10260 take 330.
type Number = Dyadic<336>;

/// Limbs for the series of a tangent ray's `Delta`, of degree four.
type SeriesNumber = Dyadic<140>;

/// Where a ray crosses a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Which primitive: spheres as listed, then triangles as listed.
    pub index: usize,
    /// Where on the ray as given, not turned, in units of its direction; correctly rounded.
    pub t: f64,
    /// Whether the ray enters: into a sphere, or through a triangle against its normal, the side from which the
    /// vertices turn counterclockwise.
    pub entering: bool,
}

impl Crossing {
    pub(crate) fn new(index: usize, Pass { t, entering }: Pass) -> Self {
        Self { index, t, entering }
    }
}

/// A crossing of one primitive.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pass {
    t: f64,
    entering: bool,
}

/// The crossing of a triangle.
pub(crate) fn of_triangle(triangle: &Triangle, ray: &Ray) -> Option<Pass> {
    let t = || triangle.closest(ray, 0.0..f64::INFINITY);
    let entering = || slope_sign(triangle, ray) == Ordering::Less;
    // The limit of the crossings of turned rays is a hit.
    triangle.crosses(ray).then(|| t().map(|t| Pass { t, entering: entering() }))?
}

/// The crossings of a sphere, in order.
pub(crate) fn of_sphere(sphere: &Sphere, ray: &Ray) -> [Option<Pass>; 2] {
    let pass = |t: f64, entering, ahead: bool| ahead.then_some(Pass { t, entering });
    // A root that rounds to +0.0 is zero or above it: zero if the origin lies on the sphere, and then it is no crossing.
    let ahead = |t: f64| t > 0.0 || (t.to_bits() == 0 && sphere.side(ray.origin()) != Side::On);
    match sphere.roots(ray) {
        Roots::Two(near, far) => [pass(near, true, ahead(near)), pass(far, false, ahead(far))],
        Roots::One(t) if sphere.radius() > 0.0 && ahead(t) && tangent_series(sphere, ray) == Ordering::Greater => {
            [pass(t, true, true), pass(t, false, true)]
        }
        // From the surface along a tangent: one root stays zero, and the other goes ahead or back.
        Roots::One(t) if sphere.radius() > 0.0 && sphere.side(ray.origin()) == Side::On => {
            let w = sphere.center() - ray.origin();
            let first = [w.x, w.y, w.z].into_iter().find(|&part| part != 0.0);
            // The difference of two doubles is zero only if they are equal.
            [None, pass(t, false, first.is_some_and(|part| part > 0.0))]
        }
        _ => [None, None],
    }
}

/// The sign of `Delta` for the turned direction, of a ray that touches the sphere: that of the first coefficient of
/// `a(e) r² - |w x d(e)|²` that is not zero.
#[cold]
fn tangent_series(sphere: &Sphere, ray: &Ray) -> Ordering {
    let w = difference::<SeriesNumber>(ray.origin(), sphere.center());
    // d(e) = d + X e + Y e² + Z e³
    let directions = [ray.direction(), DVec3::X, DVec3::Y, DVec3::Z].map(|v| v.to_array().map(SeriesNumber::from_f64));
    let products = directions.each_ref().map(|d| cross(&w, d));
    let radius_square = SeriesNumber::from_f64(sphere.radius()).square();
    // The coefficient of e^k: i + j = k.
    let coefficient = |k: usize| {
        (0..4).filter(|&i| k >= i && k - i < 4).fold(SeriesNumber::ZERO, |sum, i| {
            let j = k - i;
            sum + &dot(&directions[i], &directions[j]) * &radius_square - dot(&products[i], &products[j])
        })
    };
    (1..=6).map(|k| coefficient(k).sign()).find(|sign| sign.is_ne()).unwrap_or(Ordering::Equal)
}

/// A crossing of a place, as the walk finds it.
pub(crate) struct Crossings {
    found: Vec<Crossing>,
}

impl Query for Crossings {
    type Answer = Vec<Crossing>;

    fn begin(place: &mut Vec<Crossing>) -> Self {
        place.clear();
        Self { found: std::mem::take(place) }
    }

    fn meet<const FMA: bool, L: Leaf>(&mut self, leaf: &L, place: usize, leaves: &Leaves, ray: &PreparedRay) {
        leaf.each_crossing(ray.ray, |pass| {
            self.found.extend(leaves.indices(place).map(|index| Crossing::new(index, pass)));
        });
    }

    fn answer(&mut self, leaves: &Leaves, ray: &PreparedRay) -> Vec<Crossing> {
        sort(&mut self.found, ray.ray, |index| leaves.shape(index));
        std::mem::take(&mut self.found)
    }
}

/// Brings crossings of a ray into the order of the turned ray.
pub(crate) fn sort(crossings: &mut [Crossing], ray: &Ray, shape: impl Fn(usize) -> Shape) {
    crossings.sort_unstable_by(|a, b| {
        a.t.total_cmp(&b.t).then_with(|| exact_order(ray, (&shape(a.index), a), (&shape(b.index), b)))
    });
}

/// Which of two crossings, of which the `t` rounds to the same double, comes first on the turned ray. Where two surfaces
/// touch, of which one is a sphere, the lower index; where they are the same, entering before leaving.
#[cold]
#[inline(never)]
fn exact_order(ray: &Ray, (a, first): (&Shape, &Crossing), (b, second): (&Shape, &Crossing)) -> Ordering {
    let by_index = first.index.cmp(&second.index).then(second.entering.cmp(&first.entering));
    if first.index == second.index || a == b {
        // The near root of a sphere comes first, also where both round to the same double.
        return second.entering.cmp(&first.entering).then(first.index.cmp(&second.index));
    }
    let order = match (a, b) {
        (Shape::Triangle(a), Shape::Triangle(b)) => order_of_triangles(ray, a, b),
        _ => {
            let [a, b] =
                [(a, first), (b, second)].map(|(shape, crossing)| Parameter::new(ray, shape, crossing.entering));
            a.compare(&b)
        }
    };
    order.then(by_index)
}

/// Compares `h / s(e)` of two triangles: the first power of `e` in which `h₁ s₂(e)` and `h₂ s₁(e)` differ decides.
fn order_of_triangles(ray: &Ray, a: &Triangle, b: &Triangle) -> Ordering {
    let series = |triangle: &Triangle| {
        let (normal, height) = normal_and_height(ray, triangle);
        let slope = dot(&normal, &ray.direction().to_array().map(Number::from_f64));
        let [x, y, z] = normal;
        (height, [slope, x, y, z])
    };
    let ((h, s), (g, q)) = (series(a), series(b));
    let difference = (0..4).map(|k| (&h * &q[k]).cmp(&(&g * &s[k]))).find(|order| order.is_ne());
    let order = difference.unwrap_or(Ordering::Equal);
    if s[0].sign() == q[0].sign() { order } else { order.reverse() }
}

/// The product of the edges, and `N.(a - o)`.
fn normal_and_height(ray: &Ray, triangle: &Triangle) -> ([Number; 3], Number) {
    let [a, b, c] = triangle.vertices();
    let normal = cross(&difference::<Number>(b, a), &difference(c, a));
    let height = dot(&normal, &difference(a, ray.origin()));
    (normal, height)
}

/// An exact `t`: `(p + root) / q` with `q > 0`, where `root` is the square root of `square`, with a sign.
struct Parameter {
    p: Number,
    sign: Ordering,
    square: Number,
    q: Number,
}

impl Parameter {
    fn new(ray: &Ray, shape: &Shape, entering: bool) -> Self {
        let d = ray.direction().to_array().map(Number::from_f64);
        match shape {
            Shape::Sphere(sphere) => {
                let w = difference::<Number>(ray.origin(), sphere.center());
                let (a, b, x) = (dot(&d, &d), dot(&w, &d), cross(&w, &d));
                let square = &a * &Number::from_f64(sphere.radius()).square() - dot(&x, &x);
                let sign = if square.sign().is_eq() {
                    Ordering::Equal
                } else if entering {
                    Ordering::Less
                } else {
                    Ordering::Greater
                };
                Self { p: -b, sign, square, q: a }
            }
            Shape::Triangle(triangle) => {
                let (normal, height) = normal_and_height(ray, triangle);
                let slope = dot(&normal, &d);
                let (p, q) = if slope.sign() == Ordering::Less { (-height, -slope) } else { (height, slope) };
                Self { p, sign: Ordering::Equal, square: Number::ZERO, q }
            }
        }
    }

    /// The sign of the difference times both divisors: `x + root - other`.
    fn compare(&self, other: &Self) -> Ordering {
        // Two spheres have the same divisor.
        let same = self.q == other.q;
        let times = |number: &Number, q: &Number| if same { number.clone() } else { number * q };
        let x = times(&self.p, &other.q) - times(&other.p, &self.q);
        let scaled = |square: &Number, q: &Number| if same { square.clone() } else { square * &q.square() };
        let (square, other_square) = (scaled(&self.square, &other.q), scaled(&other.square, &self.q));
        sign_of_sum(&x, (self.sign, &square), (other.sign.reverse(), &other_square))
    }
}

/// The sign of `x ± √a ± √b`; the sign `Equal` stands for a root that is zero.
fn sign_of_sum(x: &Number, (sign_a, a): (Ordering, &Number), (sign_b, b): (Ordering, &Number)) -> Ordering {
    // The sign of the two roots together.
    let roots = match (sign_a, sign_b) {
        (sign, Ordering::Equal) | (Ordering::Equal, sign) => sign,
        (sign, other) if sign == other => sign,
        (sign, _) => match a.cmp(b) {
            Ordering::Less => sign.reverse(),
            Ordering::Equal => Ordering::Equal,
            Ordering::Greater => sign,
        },
    };
    match (x.sign(), roots) {
        (sign, Ordering::Equal) | (Ordering::Equal, sign) => sign,
        (sign, other) if sign == other => sign,
        // Of opposite signs: x² against a + b ± 2 √(a b).
        (sign, _) => {
            let rest = x.square() - a - b;
            let product = (a * b).scale(2);
            let doubled = if product.sign().is_eq() {
                Ordering::Equal
            } else if sign_a == sign_b {
                Ordering::Greater
            } else {
                Ordering::Less
            };
            let larger = match (rest.sign(), doubled) {
                (sign, Ordering::Equal) => sign,
                (Ordering::Equal, doubled) => doubled.reverse(),
                (sign, doubled) if sign != doubled => sign,
                (Ordering::Greater, _) => rest.square().cmp(&product),
                _ => product.cmp(&rest.square()),
            };
            match larger {
                Ordering::Greater => sign,
                Ordering::Equal => Ordering::Equal,
                Ordering::Less => sign.reverse(),
            }
        }
    }
}
