//! Where a ray enters and leaves surfaces, in order: what counts for closed meshes.
//!
//! The ray is turned to the direction `d + (e, e², e³)` with an infinitely small `e > 0`, for all surfaces alike
//! ([`Triangle::crosses`] has the rule). It passes no edge, no vertex and no plane along its face and touches no sphere,
//! unless its origin lies there, so entering and leaving a closed surface alternate. The order is that of the turned
//! ray: by the rounded `t`, and where that is equal by exact numbers, polynomials in `e`:
//!
//! ```text
//!     triangle:  t = h / s(e)                          s(e) = N.d + e N_x + e² N_y + e³ N_z
//!     sphere:    a(e) t² + 2 b(e) t + c = 0            a(e) = |d(e)|², b(e) = w.d(e), c = |w|² - r²
//! ```

use std::cmp::Ordering;

use glam::DVec3;
use rt_math::Roots;
use rt_math::exact::Dyadic;
use rt_math::exact::vector::{cross, difference, dot};

use crate::triangle::slope_sign;
use crate::{Ray, Shape, Side, Sphere, Triangle};

/// Limbs for the order of two crossings: of degree eight at most, multiples of 2^-8592 below 2^8211 take 263.
type Number = Dyadic<268>;

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
        Roots::One(t) if sphere.radius() > 0.0 && ahead(t) && turned_delta(sphere, ray) == Ordering::Greater => {
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

/// The sign of `Delta` for the turned direction, of a ray that touches the sphere.
#[cold]
fn turned_delta(sphere: &Sphere, ray: &Ray) -> Ordering {
    let turned = Turned::new(ray);
    let Globe { b, c } = turned.globe(sphere);
    sign(|k| product(&b, &b, k) - turned.a(k) * &c)
}

/// Brings crossings of a ray into the order of the turned ray.
pub(crate) fn sort(crossings: &mut [Crossing], ray: &Ray, shape: impl Fn(usize) -> Shape) {
    crossings.sort_unstable_by(|a, b| {
        a.t.total_cmp(&b.t).then_with(|| exact_order(ray, (&shape(a.index), a), (&shape(b.index), b)))
    });
}

/// Which of two crossings, of which the `t` rounds to the same double, comes first on the turned ray; by index where
/// they stay together.
#[cold]
#[inline(never)]
fn exact_order(ray: &Ray, (a, first): (&Shape, &Crossing), (b, second): (&Shape, &Crossing)) -> Ordering {
    let by_index = first.index.cmp(&second.index);
    if first.index == second.index || a == b {
        // The near root of a sphere comes first, also where both round to the same double.
        return second.entering.cmp(&first.entering).then(by_index);
    }
    let turned = Turned::new(ray);
    let order = match (a, b) {
        (Shape::Triangle(a), Shape::Triangle(b)) => order_of_planes(&turned.plane(a), &turned.plane(b)),
        (Shape::Sphere(a), Shape::Triangle(b)) => turned.root_against_plane(&turned.globe(a), first, &turned.plane(b)),
        (Shape::Triangle(a), Shape::Sphere(b)) => {
            turned.root_against_plane(&turned.globe(b), second, &turned.plane(a)).reverse()
        }
        (Shape::Sphere(a), Shape::Sphere(b)) => {
            turned.order_of_roots((&turned.globe(a), first), (&turned.globe(b), second))
        }
    };
    order.then(by_index)
}

/// A polynomial in `e`; its sign, for an infinitely small `e > 0`, is that of the first coefficient that is not zero.
type Series = [Number; 4];

/// The coefficient of `e^k` in a product.
fn product(x: &Series, y: &Series, k: usize) -> Number {
    (0..4).filter(|&i| k >= i && k - i < 4).fold(Number::ZERO, |sum, i| sum + &x[i] * &y[k - i])
}

/// The sign of a series of degree six at most, by its coefficients.
fn sign(coefficient: impl Fn(usize) -> Number) -> Ordering {
    (0..=6).map(|k| coefficient(k).sign()).find(|sign| sign.is_ne()).unwrap_or(Ordering::Equal)
}

fn sign_of(series: &Series) -> Ordering {
    series.iter().map(Dyadic::sign).find(|sign| sign.is_ne()).unwrap_or(Ordering::Equal)
}

/// A plane, crossed at `t = h / s(e)`.
struct Plane {
    h: Number,
    s: Series,
}

/// A sphere, met where `a(e) t² + 2 b(e) t + c = 0`.
struct Globe {
    b: Series,
    c: Number,
}

/// The first power of `e` in which `h₁ s₂(e)` and `h₂ s₁(e)` differ decides.
fn order_of_planes(first: &Plane, second: &Plane) -> Ordering {
    let mut differences = (0..4).map(|k| (&first.h * &second.s[k]).cmp(&(&second.h * &first.s[k])));
    let order = differences.find(|order| order.is_ne()).unwrap_or(Ordering::Equal);
    if sign_of(&first.s) == sign_of(&second.s) { order } else { order.reverse() }
}

/// The turned direction `d + X e + Y e² + Z e³` and the ray's origin.
struct Turned {
    origin: DVec3,
    directions: [[Number; 3]; 4],
}

impl Turned {
    fn new(ray: &Ray) -> Self {
        let directions = [ray.direction(), DVec3::X, DVec3::Y, DVec3::Z];
        Self { origin: ray.origin(), directions: directions.map(|v| v.to_array().map(Number::from_f64)) }
    }

    fn plane(&self, triangle: &Triangle) -> Plane {
        let [a, b, c] = triangle.vertices();
        let normal = cross(&difference::<Number>(b, a), &difference(c, a));
        let h = dot(&normal, &difference(a, self.origin));
        Plane { h, s: self.directions.each_ref().map(|d| dot(&normal, d)) }
    }

    fn globe(&self, sphere: &Sphere) -> Globe {
        let w = difference::<Number>(self.origin, sphere.center());
        let c = dot(&w, &w) - Number::from_f64(sphere.radius()).square();
        Globe { b: self.directions.each_ref().map(|d| dot(&w, d)), c }
    }

    /// The coefficient of `e^k` in `a(e)`, the square of the direction.
    fn a(&self, k: usize) -> Number {
        let d = &self.directions;
        (0..4).filter(|&i| k >= i && k - i < 4).fold(Number::ZERO, |sum, i| sum + dot(&d[i], &d[k - i]))
    }

    /// Where a root of a sphere lies on the turned ray with regard to a plane.
    ///
    /// With `F` the sphere's equation, `s² F(h/s)` tells whether the plane is crossed between the roots, and else
    /// `s (a h + b s)` whether beyond their middle.
    fn root_against_plane(&self, globe: &Globe, root: &Crossing, plane: &Plane) -> Ordering {
        let (Globe { b, c }, Plane { h, s }) = (globe, plane);
        let (h_square, twice_h) = (h.square(), h.scale(1));
        let outside = sign(|k| self.a(k) * &h_square + &twice_h * &product(b, s, k) + c * &product(s, s, k));
        let beyond = sign(|k| self.a(k) * h + product(b, s, k));
        let beyond = if sign_of(s).is_lt() { beyond.reverse() } else { beyond };
        of_root(root.entering, outside, beyond)
    }

    /// Which of two roots comes first. The spheres' equations differ by `2 (b₁ - b₂) t + c₁ - c₂`, which is a plane's;
    /// so on which side of it the second root lies tells whether it lies between the roots of the first sphere.
    fn order_of_roots(&self, (first, root): (&Globe, &Crossing), (second, other): (&Globe, &Crossing)) -> Ordering {
        let b: Series = [0, 1, 2, 3].map(|k| &first.b[k] - &second.b[k]);
        let rest = &first.c - &second.c;
        let slope = sign_of(&b);
        let outside = if slope.is_eq() {
            rest.sign()
        } else {
            let plane = Plane { h: -rest, s: b.each_ref().map(|part| part.scale(1)) };
            let side = self.root_against_plane(second, other, &plane);
            if slope.is_lt() { side.reverse() } else { side }
        };
        // a t₂ + b₁ is b₁ - b₂ ∓ √Δ₂, where Δ₂ is b₂² - a c₂.
        let side = if other.entering { Ordering::Less } else { Ordering::Greater };
        let larger = sign(|k| product(&b, &b, k) - product(&second.b, &second.b, k) + self.a(k) * &second.c);
        let beyond = match larger {
            _ if slope.is_eq() || slope == side => side,
            Ordering::Greater => slope,
            Ordering::Equal => Ordering::Equal,
            Ordering::Less => side,
        };
        of_root(root.entering, outside, beyond)
    }
}

/// Where the near or the far root of a sphere lies with regard to a place that is outside of it (`Greater`), on it or
/// inside, and beyond the middle of the roots (`Greater`) or before it.
fn of_root(near: bool, outside: Ordering, beyond: Ordering) -> Ordering {
    match (outside, near) {
        (Ordering::Less, true) => Ordering::Less,
        (Ordering::Less, false) => Ordering::Greater,
        (Ordering::Greater, _) => beyond.reverse(),
        // The place is the root of its half.
        (Ordering::Equal, true) if beyond.is_gt() => Ordering::Less,
        (Ordering::Equal, false) if beyond.is_lt() => Ordering::Greater,
        (Ordering::Equal, _) => Ordering::Equal,
    }
}

#[cfg(test)]
mod tests {
    use super::of_root;

    #[test]
    fn a_root_lies_where_numbers_say() {
        let (near, far, middle) = (1, 5, 3i32);
        for place in 0i32..7 {
            let outside = (place - middle).abs().cmp(&(far - middle));
            for (is_near, root) in [(true, near), (false, far)] {
                assert_eq!(of_root(is_near, outside, place.cmp(&middle)), root.cmp(&place), "{root} and {place}");
            }
        }
    }
}
