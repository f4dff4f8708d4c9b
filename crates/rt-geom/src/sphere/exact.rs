//! The stages after the filter and the Newton step: fixed-point numbers of one limb, double-double, fixed-point numbers
//! of two and three limbs, integers of any size; in the order of their cost.

use std::cmp::Ordering;
use std::ops::Range;

use glam::DVec3;
use rt_math::Roots;
use rt_math::exact::vector::{cross, difference, dot, minus};
use rt_math::exact::{DoubleDouble, Dyadic, Fixed, U, Window, bits_spanned, power_of_two, round_if_certain};
use rt_math::fma_dispatch;

use super::{Side, Sphere};
use crate::Ray;
use crate::ray::{holds, max_abs};
use crate::stage::{Stage, decided};

/// Up to here in magnitude the coordinates relative to the center must be for double-double: `2^300`.
const FARTHEST: f64 = power_of_two(300);

/// Swallows all errors of underflow: `2^-500` (`docs/numerics.md`, section 5).
const UNDERFLOW: f64 = power_of_two(-500);

/// Swallows what underflow does to a `t`: `2^-1000`.
const UNDERFLOW_T: f64 = power_of_two(-1000);

/// Returns the closest root in the range; slow path, always decides.
#[cold]
#[inline(never)]
pub(super) fn closest(sphere: &Sphere, ray: &Ray, within: Range<f64>) -> Option<f64> {
    let first = |roots| match roots {
        Roots::One(t) if holds(&within, t) => Some(t),
        Roots::Two(near, _) if holds(&within, near) => Some(near),
        Roots::Two(_, far) if holds(&within, far) => Some(far),
        _ => None,
    };
    ask(sphere, ray, |equation| equation.closest(&within), first)
}

/// Returns the roots; slow path, always decides.
#[cold]
#[inline(never)]
pub(super) fn roots(sphere: &Sphere, ray: &Ray) -> Roots {
    ask(sphere, ray, |equation| equation.roots(), |roots| roots)
}

/// Asks the first stage that decides: of an equation in fixed-point numbers, or of the roots that the others give.
#[inline(always)]
fn ask<R>(
    sphere: &Sphere,
    ray: &Ray,
    of_equation: impl FnOnce(&dyn Solve) -> R,
    of_roots: impl FnOnce(Roots) -> R,
) -> R {
    if let Some(equation) = Equation::<1, 2, 4>::new(sphere, ray) {
        decided(Stage::Fixed);
        of_equation(&equation)
    } else if let Some(roots) = double_double_roots(sphere, ray) {
        decided(Stage::DoubleDouble);
        of_roots(roots)
    } else if let Some(equation) = Equation::<2, 4, 8>::new(sphere, ray) {
        decided(Stage::Fixed);
        of_equation(&equation)
    } else if let Some(equation) = Equation::<3, 6, 12>::new(sphere, ray) {
        decided(Stage::Fixed);
        of_equation(&equation)
    } else {
        decided(Stage::Integers);
        of_roots(integer_roots(sphere, ray))
    }
}

/// A quadratic equation of any size.
trait Solve {
    fn roots(&self) -> Roots;

    /// The closest root in the range; only roots that may lie in it are computed.
    fn closest(&self, within: &Range<f64>) -> Option<f64>;
}

/// Returns on which side of the surface a point lies; slow path, always decides.
#[cold]
#[inline(never)]
pub(super) fn side(sphere: &Sphere, point: DVec3) -> Side {
    if !point.is_finite() {
        return Side::Outside;
    }
    let sign = fixed_side::<1, 2>(sphere, point)
        .or_else(|| double_double_side(sphere, point))
        .or_else(|| fixed_side::<2, 4>(sphere, point))
        .unwrap_or_else(|| integer_side(sphere, point));
    match sign {
        Ordering::Less => Side::Inside,
        Ordering::Equal => Side::On,
        Ordering::Greater => Side::Outside,
    }
}

/// The quadratic equation of a line and a sphere in fixed-point numbers, where center, radius and origin lie in one
/// window and the direction in another: `a T² + 2 b T + c = 0` with `a`, `b`, `c` of `S = 2 N` limbs, and `Delta` of
/// `Q = 4 N`.
struct Equation<const N: usize, const S: usize, const Q: usize> {
    a: Fixed<S>,
    b: Fixed<S>,
    c: Fixed<S>,
    delta: Fixed<Q>,
    /// `t` is `T 2^exponent`.
    exponent: i32,
}

impl<const N: usize, const S: usize, const Q: usize> Equation<N, S, Q> {
    #[inline(always)]
    fn new(sphere: &Sphere, ray: &Ray) -> Option<Self> {
        let (o, center, d) = (ray.origin(), sphere.center, ray.direction());
        let window = Window::<N>::around(&[o.x, o.y, o.z, center.x, center.y, center.z, sphere.radius])?;
        let direction_window = Window::<N>::around(&d.to_array())?;
        let (w, r) = (minus(&window.vector(o), &window.vector(center)), window.fixed(sphere.radius));
        let d = direction_window.vector(d);
        let (a, b) = (dot(&d, &d), dot(&w, &d));
        let c = dot::<_, _, Fixed<S>>(&w, &w) - Fixed::product(&r, &r);
        let delta = Fixed::product(&b, &b) - Fixed::product(&a, &c);
        Some(Self { a, b, c, delta, exponent: window.exponent() - direction_window.exponent() })
    }

    fn tangent(&self) -> f64 {
        Fixed::quotient(&-self.b, &self.a, self.exponent)
    }

    fn near(&self) -> f64 {
        Fixed::root(&-self.b, true, &self.delta, &self.a, &self.c, self.exponent)
    }

    fn far(&self) -> f64 {
        Fixed::root(&-self.b, false, &self.delta, &self.a, &self.c, self.exponent)
    }
}

impl<const N: usize, const S: usize, const Q: usize> Solve for Equation<N, S, Q> {
    fn roots(&self) -> Roots {
        match self.delta.sign() {
            Ordering::Less => Roots::None,
            Ordering::Equal => Roots::One(self.tangent()),
            Ordering::Greater => Roots::Two(self.near(), self.far()),
        }
    }

    fn closest(&self, within: &Range<f64>) -> Option<f64> {
        let inside = |t: f64| holds(within, t).then_some(t);
        match self.delta.sign() {
            Ordering::Less => None,
            Ordering::Equal => inside(self.tangent()),
            // Two different roots with the product c / a and the sum -2 b / a. A range from +0.0 on holds no negative
            // one.
            Ordering::Greater if within.start.to_bits() == 0 => match (self.c.sign(), self.b.sign()) {
                (Ordering::Greater, Ordering::Greater) => None,
                (Ordering::Less, _) => inside(self.far()),
                (Ordering::Equal, Ordering::Greater) => inside(0.0),
                _ => inside(self.near()).or_else(|| inside(self.far())),
            },
            Ordering::Greater => inside(self.near()).or_else(|| inside(self.far())),
        }
    }
}

/// Compares the distance of a point from the center with the radius, in fixed-point numbers.
fn fixed_side<const N: usize, const S: usize>(sphere: &Sphere, point: DVec3) -> Option<Ordering> {
    let c = sphere.center;
    let window = Window::<N>::around(&[point.x, point.y, point.z, c.x, c.y, c.z, sphere.radius])?;
    let (w, r) = (minus(&window.vector(point), &window.vector(c)), window.fixed(sphere.radius));
    Some((dot::<_, _, Fixed<S>>(&w, &w) - Fixed::product(&r, &r)).sign())
}

fma_dispatch! {
    /// The filter and the roots once more, in double-double; `None` if that is not certain either.
    fn double_double_roots(sphere: &Sphere, ray: &Ray) -> Option<Roots> = double_double_roots_kernel;
}

#[inline(always)]
fn double_double_roots_kernel<const FMA: bool>(sphere: &Sphere, ray: &Ray) -> Option<Roots> {
    let (o, c, d) = (ray.origin(), sphere.center, ray.direction());
    let reach = max_abs(d);
    let far = max_abs(o - c);
    // The range for which the bounds are proved.
    if !(far + sphere.radius <= FARTHEST && (1e-30..=1e30).contains(&reach)) {
        return None;
    }
    let w = difference::<DoubleDouble<FMA>>(o, c);
    let d = d.to_array().map(DoubleDouble::<FMA>::new);
    // Modelled in docs/proofs/SphereExact.v: tx, tsquare, treach.
    let x = cross(&w, &d);
    let x_square = dot(&x, &x);
    let a = dot(&d, &d);
    let radius_square = DoubleDouble::<FMA>::product(sphere.radius, sphere.radius);
    let reach_square = a * radius_square;
    let delta = reach_square - x_square;
    let product = 2.0 * reach * far;
    let x_size = x[0].high().abs() + x[1].high().abs() + x[2].high().abs();
    let permanent = product * (x_size + 32.0 * U * U * product);
    let error = 32.0 * U * U * ((reach_square.high() + x_square.high()) + permanent) + UNDERFLOW;
    if delta.high() < -error {
        return Some(Roots::None);
    }
    if delta.high() <= 16.0 * error {
        return None;
    }

    let b = dot(&w, &d);
    let root = delta.sqrt();
    let q = if b.high() < 0.0 { root - b } else { root + b };
    let q_error = 32.0 * U * U * product + 12.0 * U * U * q.high() + error / root.high();
    let w_square = dot(&w, &w);
    let c = w_square - radius_square;
    let c_error = 32.0 * U * U * (w_square.high() + radius_square.high()) + UNDERFLOW;
    let (small, large) = (c / q, q / a);
    let small_size = small.high().abs();
    let small_error = 1.5 * (small_size * q_error + c_error) / q.high() + 32.0 * U * U * small_size + UNDERFLOW_T;
    let large_error = 1.1 * q_error / a.high() + 32.0 * U * U * large.high() + UNDERFLOW_T;
    let small = round_if_certain(small.high(), small.low(), small_error)?;
    let large = round_if_certain(large.high(), large.low(), large_error)?;
    Some(if b.high() < 0.0 { Roots::Two(small, large) } else { Roots::Two(-large, -small) })
}

/// Compares the distance of a point from the center with the radius, in double-double.
fn double_double_side(sphere: &Sphere, point: DVec3) -> Option<Ordering> {
    // Cold, so without FMA.
    let w = difference::<DoubleDouble<false>>(point, sphere.center);
    let (square, radius_square) = (dot(&w, &w), DoubleDouble::product(sphere.radius, sphere.radius));
    let excess = (square - radius_square).high();
    let error = 32.0 * U * U * (square.high() + radius_square.high()) + UNDERFLOW;
    let in_range = max_abs(point - sphere.center) + sphere.radius <= FARTHEST;
    (in_range && excess.abs() > error).then(|| excess.total_cmp(&0.0))
}

/// Limbs for the roots of any doubles. Coordinates relative to the center are multiples of 2^-1074 below 2^1025.
/// `Delta`, of degree four, is a multiple of 2^-4296 below 2^4103: 134 limbs. To round a root takes
/// `(2 (t + 2) - 2 b) / 64 + 2` limbs with `t = 3077` and `b = -3222`, that of twice a double times `d . d`.
const ANY_LIMBS: usize = 200;

/// Limbs for the roots where points and direction together span at most `NARROW_BITS`: with `s` and `q` bits,
/// `t - b = 2 (s + q) + 62`, since a root that is not zero is at least `c / |b -+ sqrt(Delta)|`.
const NARROW_LIMBS: usize = 24;
const NARROW_BITS: i32 = 320;

#[cold]
#[inline(never)]
fn integer_roots(sphere: &Sphere, ray: &Ray) -> Roots {
    let (o, c) = (ray.origin(), sphere.center);
    let points = bits_spanned(&[o.x, o.y, o.z, c.x, c.y, c.z, sphere.radius]);
    if points + bits_spanned(&ray.direction().to_array()) <= NARROW_BITS {
        roots_in::<NARROW_LIMBS>(sphere, ray)
    } else {
        roots_in::<ANY_LIMBS>(sphere, ray)
    }
}

fn roots_in<const LIMBS: usize>(sphere: &Sphere, ray: &Ray) -> Roots {
    let w = difference::<Dyadic<LIMBS>>(ray.origin(), sphere.center);
    let d = ray.direction().to_array().map(Dyadic::from_f64);
    let r = Dyadic::from_f64(sphere.radius);
    let (a, minus_b, x) = (dot(&d, &d), -dot(&w, &d), cross(&w, &d));
    let delta: Dyadic<LIMBS> = &a * &r.square() - dot(&x, &x);
    match delta.sign() {
        Ordering::Less => Roots::None,
        Ordering::Equal => Roots::One(Dyadic::quotient(&minus_b, &a)),
        Ordering::Greater => {
            let root = |minus| Dyadic::root(&minus_b, minus, &delta, &a);
            Roots::Two(root(true), root(false))
        }
    }
}

/// Limbs for the side: of degree two, a multiple of 2^-2148 below 2^2053.
type SideInteger = Dyadic<68>;

fn integer_side(sphere: &Sphere, point: DVec3) -> Ordering {
    let w = difference::<SideInteger>(point, sphere.center);
    (dot(&w, &w) - SideInteger::from_f64(sphere.radius).square()).sign()
}

#[cfg(test)]
mod tests {
    use fearless_simd::Fallback;
    use oracle::Random;

    use super::super::filter::filter;
    use super::super::finish::rounded;
    use super::*;
    use crate::ray::FilterVerdict;
    use crate::stage::decisions;

    /// How many cases each stage has decided.
    #[derive(Debug, Default)]
    struct Stages {
        filter: usize,
        newton: usize,
        fixed: usize,
        double_double: usize,
        integers: usize,
    }

    impl Stages {
        fn count(&mut self, sphere: &Sphere, ray: &Ray) {
            let newton = match filter::<false>(sphere, ray) {
                FilterVerdict::Misses => {
                    self.filter += 1;
                    return;
                }
                FilterVerdict::Crosses(crossing) => {
                    let roots = crossing.approximation();
                    match crossing.first(0.0, &roots) {
                        Some(None) => {
                            self.filter += 1;
                            return;
                        }
                        Some(Some(place)) => {
                            rounded::<false, _>(Fallback::new(), sphere, ray, &crossing, &roots, place)
                        }
                        None => None,
                    }
                }
                FilterVerdict::Unsure => None,
            };
            // The stages agree, whenever an earlier one decides.
            let integers = integer_roots(sphere, ray);
            decisions();
            assert_eq!(roots(sphere, ray), integers, "{sphere:?} {ray:?}");
            let [double_double, fixed, any_size] = decisions();
            if let Some(t) = newton {
                self.newton += 1;
                let Roots::Two(near, far) = integers else { panic!("{sphere:?} {ray:?}") };
                assert!(t == near || t == far, "{sphere:?} {ray:?}");
            } else {
                self.double_double += double_double;
                self.fixed += fixed;
                self.integers += any_size;
            }
            for roots in [
                double_double_roots(sphere, ray),
                Equation::<1, 2, 4>::new(sphere, ray).map(|equation| equation.roots()),
                Equation::<2, 4, 8>::new(sphere, ray).map(|equation| equation.roots()),
                Equation::<3, 6, 12>::new(sphere, ray).map(|equation| equation.roots()),
            ] {
                assert!(roots.is_none_or(|roots| roots == integers), "{sphere:?} {ray:?}: {roots:?}");
            }
            for start in [0.0, -0.0, f64::NEG_INFINITY, 1.0] {
                let within = start..f64::INFINITY;
                let expected = match integers {
                    Roots::One(t) | Roots::Two(t, _) if holds(&within, t) => Some(t),
                    Roots::Two(_, t) if holds(&within, t) => Some(t),
                    _ => None,
                };
                assert_eq!(closest(sphere, ray, within), expected, "{sphere:?} {ray:?} from {start:?}");
            }
        }
    }

    #[test]
    fn benign_rays_never_leave_the_first_stages() {
        let (mut stages, rng) = (Stages::default(), &mut Random::new(1));
        for _ in 0..4096 {
            let center = 10.0 * rng.point();
            let sphere = Sphere::new(center, 3.0 * rng.uniform().abs()).unwrap();
            let origin = 10.0 * rng.point();
            let ray = Ray::new(origin, center + 1.5 * sphere.radius * rng.point() - origin).unwrap();
            stages.count(&sphere, &ray);
        }
        assert!(stages.filter > 1000 && stages.newton > 1000, "{stages:?}");
        assert_eq!(stages.fixed + stages.double_double + stages.integers, 0, "{stages:?}");
    }

    #[test]
    fn every_stage_decides_hard_cases() {
        let (mut stages, rng) = (Stages::default(), &mut Random::new(2));
        for i in 0..4096 {
            // grazing within some rounding errors, from more and more radii away
            let radius = 2f64.powi(-(i % 30));
            let (mut origin, direction) = (rng.point(), rng.point());
            if i % 4 == 0 {
                origin.z *= 2f64.powi(-80); // no window of one limb
            }
            let side = direction.cross(rng.point()).normalize();
            let off = radius * (1.0 + 2f64.powi(-(20 + i % 40)) * rng.uniform());
            let center = origin + direction + off * side;
            stages.count(&Sphere::new(center, radius).unwrap(), &Ray::new(origin, direction).unwrap());
        }
        // Exactly tangent, with numbers in a window of one limb, of two, and in none.
        for i in 0..192 {
            let sphere = Sphere::new(DVec3::ZERO, f64::from(i)).unwrap();
            let origin = DVec3::new(-[100.0, 2f64.powi(80), 2f64.powi(200)][i as usize % 3], f64::from(i), 0.0);
            stages.count(&sphere, &Ray::new(origin, DVec3::X).unwrap());
        }
        let all = [stages.filter, stages.newton, stages.fixed, stages.double_double, stages.integers];
        assert!(all.iter().all(|&n| n > 60), "{stages:?}");
    }

    #[test]
    fn the_side_is_decided_by_every_stage() {
        let rng = &mut Random::new(4);
        let mut counts = [0; 3];
        for i in 0..4096 {
            let center = rng.point();
            let offset = rng.point().normalize() * (1.0 + f64::from(i % 8) * 1e-16);
            let (sphere, point) = (Sphere::new(center, 1.0).unwrap(), center + offset);
            let w = point - center;
            let stage = if (w.length_squared() - 1.0).abs() > 14.0 * U {
                0
            } else {
                for side in [fixed_side::<1, 2>(&sphere, point), fixed_side::<2, 4>(&sphere, point)] {
                    assert!(side.is_none_or(|side| side == integer_side(&sphere, point)));
                }
                match double_double_side(&sphere, point) {
                    Some(sign) => {
                        assert_eq!(sign, integer_side(&sphere, point));
                        1
                    }
                    None => 2,
                }
            };
            counts[stage] += 1;
        }
        // exactly on the surface
        for k in 0..64 {
            let size = f64::from(k);
            let sphere = Sphere::new(DVec3::ZERO, 3.0 * size).unwrap();
            let point = size * DVec3::new(1.0, 2.0, -2.0);
            assert_eq!(double_double_side(&sphere, point), None);
            assert_eq!(fixed_side::<1, 2>(&sphere, point), Some(Ordering::Equal));
            assert_eq!(side(&sphere, point), Side::On);
            assert_eq!(integer_side(&sphere, point), Ordering::Equal);
            counts[2] += 1;
        }
        assert!(counts[1] > 100 && counts[2] >= 64, "{counts:?}");
    }
}
