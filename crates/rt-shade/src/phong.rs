//! Phong's reflection model: ambient, diffuse and specular light at a point of a surface.
//!
//! ```text
//!      light            -D (to the eye)
//!          \      N    /
//!        L  \     ^   /    R      L: from the light to the point
//!            \    |  /   /        R: L reflected at the surface, 2 <-L|N> N + L
//!             v   | / /           ambient  = k_a surface
//!   --------------P-----------    diffuse  = k_d <-L|N> surface light
//!                                 specular = k_s max(0, <-D|R>)^shininess light
//! ```
//!
//! Point lights without attenuation, no shadows. Only a light on the side that the ray comes from adds anything. Both
//! sides, the eye's and the light's, are decided exactly, since the specular term jumps where the light sets.

use std::cmp::Ordering;

use glam::DVec3;
use rt_math::exact::{difference_dot_sign, dot_sign};
use rt_math::reflect;

use crate::color::clamp_channel;
use crate::power::power;

/// Bound of the error of the cosine between the directions to a light and along a normal, both of which [`unit`]
/// rounds: a cosine beyond it has the exact sign. `6.1 * 2^-53` is proved in `docs/numerics.md`, section 11.
pub(crate) const COSINE_ERROR: f64 = 4.0 * f64::EPSILON;

/// How a surface answers light: the coefficients of Phong's terms.
///
/// The coefficients are meant to be finite and not negative, and `shininess` finite and positive. Nothing refuses
/// other numbers: a NaN or infinite coefficient makes the colour NaN or infinite (which [`crate::color::to_sample`]
/// stores as 0 or as full), a negative one takes light away, and [`phong`] says what a bad shininess does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// `k_a`: the share of the surface colour that is there without any light.
    pub ambient: f64,
    /// `k_d`: the share of light that is scattered to all sides, in the surface colour.
    pub diffuse: f64,
    /// `k_s`: the share of light that is mirrored, in the light's colour.
    pub specular: f64,
    /// The exponent of the specular term: the higher, the smaller the highlight.
    pub shininess: f64,
}

/// A light that shines from one point to all sides, without attenuation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLight {
    /// Where it is.
    pub position: DVec3,
    /// Its colour, linear RGB.
    pub color: DVec3,
}

/// Returns the colour of a surface point, seen along `direction`, in the light of `lights`.
///
/// `direction` leads from the eye to the point and `normal` is perpendicular to the surface; both may have any length,
/// and the normal is turned to the side that the ray comes from. `surface` is the surface's own colour. Each light adds
/// a diffuse and a specular term, both only if it is on the eye's side of the surface; a light in the plane of the
/// surface or exactly at the point adds nothing. Without lights the result is `surface` itself: a flat picture.
///
/// On which side of the plane through `point` the eye and each light are is exact for all finite vectors given, however
/// far or near. The terms themselves are rounded: a light that is on the eye's side by less than rounding may have a
/// diffuse term of 0, and none is negative.
///
/// Channels are not clamped. A zero or non-finite direction, normal or distance to a light leaves the term out that
/// needs it. A NaN shininess makes the specular term NaN; one of 0 or less counts as a power all the same; a specular
/// coefficient of 0 leaves the term out, whatever the shininess.
///
/// Source: B. T. Phong, "Illumination for Computer Generated Pictures", CACM 18(6), 1975.
///
/// ```
/// use glam::DVec3;
/// use rt_shade::{Material, PointLight, phong};
///
/// let material = Material { ambient: 0.25, diffuse: 0.5, specular: 1.0, shininess: 32.0 };
/// let above = PointLight { position: DVec3::new(0.0, 0.0, 3.0), color: DVec3::ONE };
/// let below = PointLight { position: DVec3::new(0.0, 0.0, -3.0), color: DVec3::ONE };
/// let shade = |lights: &[PointLight]| {
///     phong(DVec3::ZERO, DVec3::NEG_Z, DVec3::Z, DVec3::X, &material, lights)
/// };
/// assert_eq!(shade(&[above]), DVec3::new(1.75, 1.0, 1.0));
/// assert_eq!(shade(&[below]), DVec3::new(0.25, 0.0, 0.0)); // behind the surface: ambient alone
/// assert_eq!(shade(&[]), DVec3::X); // no light at all: flat
/// ```
pub fn phong(
    point: DVec3,
    direction: DVec3,
    normal: DVec3,
    surface: DVec3,
    material: &Material,
    lights: &[PointLight],
) -> DVec3 {
    if lights.is_empty() {
        return surface;
    }
    // The side is decided by the vectors as given: once they are rounded to length 1, a grazing view may change it.
    let turn = if dot_sign(direction, normal) == Some(Ordering::Greater) { -1.0 } else { 1.0 };
    let given_normal = turn * normal;
    let direction = unit(direction);
    let normal = unit(given_normal);

    let mut color = material.ambient * surface;
    for light in lights {
        let incident = unit(towards(light.position, point)); // L
        let cosine = (-incident).dot(normal);
        // NaN goes the exact way too, and is on no side there.
        let lit =
            if cosine.abs() > COSINE_ERROR { cosine > 0.0 } else { is_above(light.position, point, given_normal) };
        if lit {
            color += material.diffuse * clamp_channel(cosine) * surface * light.color;
            // Most surfaces are matt: no mirrored term, no power.
            if material.specular != 0.0 {
                let alignment = clamp_channel((-direction).dot(reflect(incident, normal)));
                color += material.specular * power(alignment, material.shininess) * light.color;
            }
        }
    }
    color
}

/// Returns whether `light` is on the side of the plane through `point` to which `normal` leads, by the vectors as
/// given.
#[cold]
#[inline(never)]
fn is_above(light: DVec3, point: DVec3, normal: DVec3) -> bool {
    difference_dot_sign(light, point, normal) == Some(Ordering::Greater)
}

/// Returns the vector of length 1 in the same direction, each component within 4 ulp (tested); zero stays zero, and a
/// vector that is not finite has no direction: NaN.
#[inline]
fn unit(v: DVec3) -> DVec3 {
    let (unit, ordinary) = ordinary_unit(v);
    if ordinary { unit } else { unit_scaled(v) }
}

/// Returns what [`unit`] returns, and whether it is that: `false` for lengths out of the ordinary.
#[inline(always)]
pub(crate) fn ordinary_unit(v: DVec3) -> (DVec3, bool) {
    let length_squared = v.length_squared();
    // Within these limits no square that counts has left the range of f64.
    (v * (1.0 / length_squared.sqrt()), (1e-200..1e200).contains(&length_squared))
}

/// [`unit`] for what is not ordinary.
#[cold]
fn unit_scaled(v: DVec3) -> DVec3 {
    if v == DVec3::ZERO {
        return v;
    }
    if !v.is_finite() {
        return DVec3::NAN;
    }
    // The longest component lies in 2^-474 .. 2^424 then, and its square in the range of f64.
    let v = v * if v.abs().max_element() < 1.0 { 2f64.powi(600) } else { 2f64.powi(-600) };
    v * (1.0 / v.length())
}

/// Returns a vector in the direction from `from` to `to`; zero only if they are the same point.
fn towards(from: DVec3, to: DVec3) -> DVec3 {
    let difference = to - from;
    // Only the sum of two huge numbers overflows, and those can be halved without loss.
    if difference.is_finite() { difference } else { 0.5 * to - 0.5 * from }
}

#[cfg(test)]
mod tests {
    use oracle::{Random, cases, dot, sign, sub, vector};
    use proptest::prelude::*;

    use super::*;

    const SHINY: Material = Material { ambient: 0.1, diffuse: 0.6, specular: 0.3, shininess: 32.0 };

    fn any_vector() -> impl Strategy<Value = DVec3> {
        prop::array::uniform3(-1.0f64..1.0)
            .prop_map(DVec3::from_array)
            .prop_filter("not too short", |v| v.length() > 0.01)
    }

    fn lamp(position: DVec3) -> PointLight {
        PointLight { position, color: DVec3::new(1.0, 0.8, 0.6) }
    }

    /// The formulas of the model, term by term, for vectors of ordinary size.
    fn plain_phong(point: DVec3, direction: DVec3, normal: DVec3, light: &PointLight) -> DVec3 {
        let surface = DVec3::new(0.9, 0.5, 0.1);
        let d = direction.normalize();
        let n = if d.dot(normal) > 0.0 { -normal.normalize() } else { normal.normalize() };
        let l = (point - light.position).normalize();
        let lit = (-l).dot(n);
        let mut color = SHINY.ambient * surface;
        if lit > 0.0 {
            let r = l - 2.0 * l.dot(n) * n;
            color += SHINY.diffuse * lit * surface * light.color;
            color += SHINY.specular * (-d).dot(r).max(0.0).powi(32) * light.color;
        }
        color
    }

    proptest! {
        #[test]
        fn it_is_the_sum_of_the_terms(p in any_vector(), d in any_vector(), n in any_vector(), l in any_vector()) {
            prop_assume!((p - l).length() > 0.01);
            let surface = DVec3::new(0.9, 0.5, 0.1);
            let light = lamp(l);
            let color = phong(p, d, n, surface, &SHINY, &[light]);
            let expected = plain_phong(p, d, n, &light);
            // A rounding error may decide whether a light that grazes the surface counts: then both terms are tiny,
            // or the mirrored term is not; skip the 1e-12 around it.
            let cosine = (l - p).normalize().dot(n.normalize()).abs();
            prop_assume!(cosine > 1e-12 && d.normalize().dot(n.normalize()).abs() > 1e-12);
            prop_assert!((color - expected).length() < 1e-12, "{} instead of {}", color, expected);
        }

        #[test]
        fn lights_add_up(p in any_vector(), d in any_vector(), n in any_vector(), l in any_vector(), m in any_vector()) {
            let shade = |lights: &[PointLight]| phong(p, d, n, DVec3::ONE, &SHINY, lights);
            let ambient = DVec3::splat(SHINY.ambient);
            let sum = shade(&[lamp(l)]) + shade(&[lamp(m)]) - ambient;
            prop_assert!((shade(&[lamp(l), lamp(m)]) - sum).length() < 1e-14);
        }

        #[test]
        fn both_sides_of_a_surface_are_shaded_alike(p in any_vector(), d in any_vector(), n in any_vector(), l in any_vector()) {
            let shade = |normal| phong(p, d, normal, DVec3::ONE, &SHINY, &[lamp(l)]);
            prop_assume!(d.dot(n) != 0.0);
            prop_assert_eq!(shade(n), shade(-n));
        }

        #[test]
        fn lengths_do_not_matter(p in any_vector(), d in any_vector(), n in any_vector(), l in any_vector(), e in -900..900, f in -900..900) {
            let shade = |d, n| phong(p, d, n, DVec3::ONE, &SHINY, &[lamp(l)]);
            let (long_d, long_n) = (d * 2f64.powi(e), n * 2f64.powi(f));
            prop_assert!((shade(d, n) - shade(long_d, long_n)).length() < 1e-13);
        }

        #[test]
        fn a_light_behind_the_surface_adds_nothing(d in any_vector(), n in any_vector(), l in any_vector()) {
            // Eye and light on different sides of the plane through the origin.
            prop_assume!(d.dot(n) * l.dot(n) > 1e-9);
            let color = phong(DVec3::ZERO, d, n, DVec3::ONE, &SHINY, &[lamp(l)]);
            prop_assert_eq!(color, DVec3::splat(SHINY.ambient));
        }

        #[test]
        fn the_highlight_is_where_the_mirrored_eye_meets_the_light(n in any_vector(), d in any_vector(), s in 1.0f64..1000.0) {
            prop_assume!(d.dot(n).abs() > 1e-3);
            let material = Material { ambient: 0.0, diffuse: 0.0, specular: 1.0, shininess: s };
            let towards_light = reflect(d, n);
            let light = PointLight { position: 3.0 * towards_light, color: DVec3::ONE };
            let highlight = phong(DVec3::ZERO, d, n, DVec3::ZERO, &material, &[light]);
            // The alignment is 1 within some roundings; its power is worse by the exponent.
            prop_assert!((highlight.x - 1.0).abs() < 20.0 * s * f64::EPSILON, "{}", highlight);
        }

        #[test]
        fn a_unit_vector_has_length_one(v in prop::array::uniform3(any::<u64>())) {
            let v = DVec3::from_array(v.map(f64::from_bits));
            prop_assume!(v.is_finite() && v != DVec3::ZERO);
            let unit = unit(v);
            prop_assert!((unit.length() - 1.0).abs() < 4.0 * f64::EPSILON, "{:?} gave {:?}", v, unit);
            prop_assert!(unit.dot(v.signum()) > 0.0, "{:?} gave {:?}", v, unit);
        }
    }

    #[test]
    fn a_grazing_view_has_its_exact_side() {
        let mut random = Random::new(1);
        let mut rounding_would_err = 0;
        for _ in 0..10_000 {
            let (n, x, y) = (random.point(), random.uniform(), random.uniform());
            // Perpendicular within the rounding of z.
            let d = DVec3::new(x, y, -(x * n.x + y * n.y) / n.z);
            let away = sign(&dot(&vector(d), &vector(n))) == Ordering::Greater;
            rounding_would_err += usize::from((unit(d).dot(unit(n)) > 0.0) != away);
            let lit_from = |position| {
                phong(DVec3::ZERO, d, n, DVec3::ONE, &SHINY, &[lamp(position)]) != DVec3::splat(SHINY.ambient)
            };
            assert_eq!([lit_from(-n), lit_from(n)], [away, !away], "direction {d:?}, normal {n:?}");
        }
        assert!(rounding_would_err > 500, "{rounding_would_err}");
    }

    /// Checks the side of a light near the plane through `point`, seen from the side that `normal` leads to and from
    /// the other; returns whether the rounded cosine would put it on another side.
    fn check_side(point: DVec3, light: DVec3, normal: DVec3) -> bool {
        use crate::phong_batch::{SurfacePoint, phong_batch};
        let side = sign(&dot(&sub(&vector(light), &vector(point)), &vector(normal)));
        // The mirrored light runs nearly into the eye: where it counts, the colour is about 1, and 0 elsewhere.
        let material = &Material { ambient: 0.0, diffuse: 0.0, specular: 1.0, shininess: 1.0 };
        let incident = unit(towards(light, point));
        for (up, above) in [(unit(normal), Ordering::Greater), (-unit(normal), Ordering::Less)] {
            let seen = SurfacePoint { point, direction: -incident - 0.1 * up, normal, surface: DVec3::ONE, material };
            let lights = [PointLight { position: light, color: DVec3::ONE }];
            let color = seen.shaded(&lights).x;
            assert!(
                if side == above { color > 0.9 } else { color == 0.0 },
                "{light:?} is {side:?} of {normal:?} at {point:?}, and the colour {color}"
            );
            let mut colors = [DVec3::NAN; 3];
            phong_batch(&[seen; 3], &lights, &mut colors);
            assert_eq!(colors, [DVec3::splat(color); 3], "together");
        }
        (-incident).dot(unit(normal)).partial_cmp(&0.0) != Some(side)
    }

    /// The number of random cases: ten thousand, or a million with the environment variable `RT_LONG` set.
    const LONG: usize = 1_000_000;

    #[test]
    fn a_light_beside_the_plane_of_the_surface_has_its_exact_side() {
        let mut random = Random::new(1);
        let mut rounding_would_err = 0;
        for _ in 0..cases(LONG) {
            let scale = random.power(-900..900);
            let point = scale * random.power(-30..30) * random.point();
            let normal = random.power(-900..900) * random.point();
            let across = random.point();
            // In the plane within rounding, and then a few doubles away.
            let z = -(across.x * normal.x + across.y * normal.y) / normal.z;
            let mut light = point + scale * DVec3 { z, ..across };
            for axis in 0..3 {
                for _ in 0..random.below(3) {
                    light[axis] = light[axis].next_up();
                }
            }
            if light != point && light.is_finite() {
                rounding_would_err += usize::from(check_side(point, light, normal));
            }
        }
        assert!(rounding_would_err > cases(LONG) / 10, "{rounding_would_err}");
    }

    #[test]
    fn a_light_in_the_plane_of_the_surface_is_on_no_side() {
        let mut random = Random::new(2);
        let mut rounding_would_err = 0;
        for _ in 0..cases(LONG) {
            // Small integers: corners, normal and light are exact.
            let mut corner = || (100.0 * random.point()).round();
            let [point, edge, other] = [corner(), corner(), corner()];
            let scale = random.power(-400..400);
            let normal = edge.cross(other) * random.power(-400..400);
            let (s, t) = (random.small(50), random.small(50));
            let light = (point + s * edge + t * other) * scale;
            if normal != DVec3::ZERO && light != point * scale {
                rounding_would_err += usize::from(check_side(point * scale, light, normal));
            }
        }
        assert!(rounding_would_err > cases(LONG) / 10, "{rounding_would_err}");
    }

    #[test]
    fn the_side_of_a_light_is_exact_where_the_difference_is_not_a_double() {
        let top = f64::MAX;
        let least = f64::from_bits(1);
        let mut rounding_would_err = 0;
        for (point, light, normal) in [
            // by one unit of the last place, beside a difference beyond f64
            (DVec3::new(-top, -top, 0.0), DVec3::new(top, top.next_down(), 0.0), DVec3::new(1.0, -1.0, 0.0)),
            (DVec3::new(-top, -top, 0.0), DVec3::new(top, top, 0.0), DVec3::new(1.0, -1.0, 0.0)),
            (DVec3::new(-top, -top, -top), DVec3::new(top, -top, least), DVec3::new(least, top, -least)),
            // by less than the difference keeps
            (DVec3::new(1e-30, 0.0, 0.0), DVec3::new(0.5, 0.5, 0.0), DVec3::new(1.0, -1.0, 0.0)),
            (DVec3::new(least, 0.0, 0.0), DVec3::new(1.0, 1.0, 1.0), DVec3::new(1.0, -1.0, least)),
            (DVec3::ZERO, DVec3::new(least, least, -least), DVec3::new(least, -least, 0.0)),
        ] {
            rounding_would_err += usize::from(check_side(point, light, normal));
        }
        assert!(rounding_would_err >= 3, "{rounding_would_err}");
    }

    #[test]
    fn no_term_is_negative_where_rounding_puts_the_light_behind() {
        let material = Material { ambient: 0.0, diffuse: 1.0, specular: 0.0, shininess: 1.0 };
        let mut random = Random::new(3);
        for _ in 0..cases(LONG) {
            let (normal, across, point) = (random.point(), random.point(), random.point());
            let z = -(across.x * normal.x + across.y * normal.y) / normal.z;
            let light = PointLight { position: point + DVec3 { z, ..across }, color: DVec3::ONE };
            let color = phong(point, -normal, normal, DVec3::ONE, &material, &[light]);
            assert!((0.0..1e-9).contains(&color.x), "{color} from {light:?} at {point:?}, {normal:?}");
        }
    }

    #[test]
    fn without_lights_the_surface_is_flat() {
        let surface = DVec3::new(0.3, 0.6, 0.9);
        assert_eq!(phong(DVec3::ONE, DVec3::NEG_Z, DVec3::Z, surface, &SHINY, &[]), surface);
    }

    #[test]
    fn a_light_at_the_point_adds_nothing() {
        for point in [DVec3::ZERO, DVec3::ONE, DVec3::splat(1e300)] {
            let color = phong(point, DVec3::NEG_Z, DVec3::Z, DVec3::ONE, &SHINY, &[lamp(point)]);
            assert_eq!(color, DVec3::splat(SHINY.ambient), "at {point}");
        }
    }

    #[test]
    fn the_nearest_and_the_farthest_light_are_lights() {
        let shade =
            |point: DVec3, position| phong(point, DVec3::NEG_Z, DVec3::Z, DVec3::ONE, &SHINY, &[lamp(position)]);
        let expected = shade(DVec3::ZERO, DVec3::Z);
        for height in [f64::from_bits(1), 1e-310, 1e-160, 1e160, f64::MAX] {
            assert_eq!(shade(DVec3::ZERO, height * DVec3::Z), expected, "height {height:e}");
        }
        assert_eq!(shade(f64::MIN * DVec3::Z, f64::MAX * DVec3::Z), expected, "a distance beyond f64");
    }

    #[test]
    fn a_tangent_light_adds_nothing() {
        let color = phong(DVec3::ZERO, DVec3::NEG_Z, DVec3::Z, DVec3::ONE, &SHINY, &[lamp(DVec3::X)]);
        assert_eq!(color, DVec3::splat(SHINY.ambient));
    }

    #[test]
    fn bad_numbers_do_no_harm() {
        let ambient = DVec3::splat(SHINY.ambient);
        let shade = |p, d, n, l| phong(p, d, n, DVec3::ONE, &SHINY, &[lamp(l)]);
        for bad in [f64::NAN, f64::INFINITY] {
            let bad = DVec3::new(bad, 0.0, 1.0);
            assert_eq!(shade(bad, DVec3::NEG_Z, DVec3::Z, DVec3::Z), ambient, "point");
            assert_eq!(shade(DVec3::ZERO, DVec3::NEG_Z, bad, DVec3::Z), ambient, "normal");
            assert_eq!(shade(DVec3::ZERO, DVec3::NEG_Z, DVec3::Z, bad), ambient, "light");
            let diffuse = shade(DVec3::ZERO, bad, DVec3::Z, DVec3::Z);
            let expected = ambient + SHINY.diffuse * lamp(DVec3::Z).color;
            assert_eq!(diffuse, expected, "a direction that is none leaves out the mirrored term");
        }
        assert_eq!(shade(DVec3::ZERO, DVec3::NEG_Z, DVec3::ZERO, DVec3::Z), ambient, "zero normal");
        let nan = Material { shininess: f64::NAN, ..SHINY };
        let color = phong(DVec3::ZERO, DVec3::new(0.1, 0.0, -1.0), DVec3::Z, DVec3::ONE, &nan, &[lamp(DVec3::Z)]);
        assert!(color.is_nan(), "a NaN shininess shows: {color}");
    }
}
