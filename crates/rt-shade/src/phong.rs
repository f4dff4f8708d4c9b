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
//!
//! A colour comes with a bound of its error, which holds for vectors that are themselves known within bounds:
//! `docs/numerics.md`, section 14, derives it.

use std::cmp::Ordering;

use glam::DVec3;
use rt_math::exact::{U, difference_dot_sign, dot_sign, dot_with_error, power_of_two, two_prod};

use crate::color::clamp_channel;
use crate::power::power;

/// The error of a vector made one long, relative to 1; `4.51 u` is proved.
pub(crate) const UNIT_ERROR: f64 = 4.6 * U;
/// The same of the direction from a light, whose difference is rounded as well; `6.6 u` is proved.
pub(crate) const INCIDENT_ERROR: f64 = 7.0 * U;
/// What rounding adds to the error of a cosine and of an alignment; `3.1 u` and `17.1 u` are proved.
const COSINE_ROUNDING: f64 = 3.2 * U;
const ALIGNMENT_ROUNDING: f64 = 17.5 * U;
/// Up to here the bounds are proved for the errors of directions: `2^-7`.
const LARGEST_ERROR: f64 = power_of_two(-7);
/// Swallows what underflows in a term, in its bound and in a power.
pub(crate) const UNDERFLOW: f64 = f64::MIN_POSITIVE;

/// How a surface answers light: the coefficients of Phong's terms.
///
/// The coefficients are meant to be finite and not negative, and `shininess` finite and positive. Nothing refuses
/// other numbers: a NaN or infinite coefficient makes the colour NaN or infinite (which [`crate::color::to_sample`]
/// stores as 0 or as full), a negative one takes light away, and [`phong`] says what a bad shininess does. The bound of
/// the error then has no meaning.
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

/// A point of a surface and how it is seen; vectors and colour may be known within bounds only.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint<'a> {
    /// Where it is, together with `offset`.
    pub point: DVec3,
    /// What is to be added to `point`: the sum is not rounded. It places what is far away near a center.
    pub offset: DVec3,
    /// The direction that leads from the eye to it, of any length; exact.
    pub direction: DVec3,
    /// Perpendicular to the surface, of any length and on either side.
    pub normal: DVec3,
    /// The surface's own colour.
    pub surface: DVec3,
    /// How the surface answers light.
    pub material: &'a Material,
    /// How far these may be from the exact ones.
    pub errors: Errors,
}

/// Bounds of the errors of a [`SurfacePoint`]: of lengths of differences, and of a channel of the colour.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Errors {
    /// Of `point + offset`.
    pub point: f64,
    /// Of `normal`.
    pub normal: f64,
    /// Of each channel of `surface`.
    pub surface: f64,
}

/// A colour, and how far each channel may be from the exact one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shaded {
    /// The colour; channels are not clamped.
    pub color: DVec3,
    /// A bound of the error of each channel; infinite or NaN where nothing is known.
    pub error: f64,
}

impl Shaded {
    /// Whether the bound says anything: no side is open.
    #[inline]
    #[must_use]
    pub fn is_known(&self) -> bool {
        // False for NaN.
        self.error < f64::INFINITY
    }
}

/// Decides the sides of a surface where rounding leaves them open.
pub trait Sides {
    /// Whether the normal as given is on the side that the ray comes from, or the ray runs along the surface; `None` if
    /// that is not known.
    fn faces_eye(&self) -> Option<bool>;

    /// On which side of the plane that touches the surface a light is; `Greater` is the side to which the normal as given
    /// leads. `None` if that is not known.
    fn side_of(&self, light: DVec3) -> Option<Ordering>;
}

impl<'a> SurfacePoint<'a> {
    /// Returns the point with these vectors and this colour, all exact; [`SurfacePoint`] explains them.
    #[must_use]
    pub fn new(
        point: impl Into<DVec3>,
        direction: impl Into<DVec3>,
        normal: impl Into<DVec3>,
        surface: impl Into<DVec3>,
        material: &'a Material,
    ) -> Self {
        let (point, direction, normal, surface) = (point.into(), direction.into(), normal.into(), surface.into());
        let (offset, errors) = (DVec3::ZERO, Errors::default());
        Self { point, offset, direction, normal, surface, material, errors }
    }

    /// Whether the vectors as given are exact, so that they decide the sides.
    fn is_exact(&self) -> bool {
        self.errors.point == 0.0 && self.errors.normal == 0.0 && self.offset == DVec3::ZERO
    }
}

/// The vectors as given decide, if they are exact.
impl Sides for SurfacePoint<'_> {
    fn faces_eye(&self) -> Option<bool> {
        (self.errors.normal == 0.0).then(|| dot_sign(self.direction, self.normal) != Some(Ordering::Greater))
    }

    fn side_of(&self, light: DVec3) -> Option<Ordering> {
        // No side for what is not finite.
        self.is_exact().then(|| difference_dot_sign(light, self.point, self.normal).unwrap_or(Ordering::Equal))
    }
}

/// Returns the colour of a surface point in the light of `lights`, and a bound of its error.
///
/// Each light adds a diffuse and a specular term, both only if it is on the side of the surface from which the ray
/// comes; a light in the plane of the surface or exactly at the point adds nothing. Without lights the result is the
/// surface's own colour: a flat picture.
///
/// For exact vectors the sides of the eye and of each light are exact, however far or near, and the bound is below
/// `2e-13` of the colour for a shininess up to 32 (tested; it grows in proportion to the shininess). Where the vectors
/// are known within bounds and these leave a side open, the error is infinite: [`phong_with_sides`] asks.
///
/// Channels are not clamped. A zero or non-finite direction, normal or distance to a light leaves the term out that
/// needs it. A NaN shininess makes the specular term NaN; one of 0 or less counts as a power all the same; a specular
/// coefficient of 0 leaves the term out, whatever the shininess.
///
/// Source: B. T. Phong, "Illumination for Computer Generated Pictures", CACM 18(6), 1975.
///
/// ```
/// use glam::DVec3;
/// use rt_shade::{Material, PointLight, SurfacePoint, phong};
///
/// let material = Material { ambient: 0.25, diffuse: 0.5, specular: 1.0, shininess: 32.0 };
/// let above = PointLight { position: DVec3::new(0.0, 0.0, 3.0), color: DVec3::ONE };
/// let below = PointLight { position: DVec3::new(0.0, 0.0, -3.0), color: DVec3::ONE };
/// let seen = SurfacePoint::new(DVec3::ZERO, DVec3::NEG_Z, DVec3::Z, DVec3::X, &material);
/// assert_eq!(phong(&seen, &[above]).color, DVec3::new(1.75, 1.0, 1.0));
/// assert_eq!(phong(&seen, &[below]).color, DVec3::new(0.25, 0.0, 0.0)); // behind the surface: ambient alone
/// assert_eq!(phong(&seen, &[]).color, DVec3::X); // no light at all: flat
/// assert!(phong(&seen, &[above]).error < 1e-12);
/// ```
#[must_use]
pub fn phong(seen: &SurfacePoint, lights: &[PointLight]) -> Shaded {
    phong_with_sides(seen, lights, seen)
}

/// [`phong`] of a point; where rounding leaves a side open, `sides` decides it.
#[must_use]
pub fn phong_with_sides(seen: &SurfacePoint, lights: &[PointLight], sides: &impl Sides) -> Shaded {
    let SurfacePoint { surface, material, errors, .. } = *seen;
    if lights.is_empty() {
        return Shaded { color: surface, error: errors.surface };
    }
    const UNKNOWN: f64 = f64::INFINITY;
    // The side is decided by the vectors as given: once they are rounded to length 1, a grazing view may change it.
    let (slope, slope_error) = slope(seen.direction, seen.normal, errors.normal);
    let faces_eye = if slope.abs() > slope_error { Some(slope < 0.0) } else { sides.faces_eye() };
    let turn = if faces_eye.unwrap_or(slope <= 0.0) { 1.0 } else { -1.0 };
    let direction = unit(seen.direction).vector;
    let normal = unit(turn * seen.normal);
    let normal_error = relative(errors.normal, normal.inverse) + UNIT_ERROR;
    let point_error = errors.point + 1.01 * U * norm(seen.offset);

    let mut color = material.ambient * surface;
    let mut error = if faces_eye.is_some() { 0.0 } else { UNKNOWN };
    let mut adds = false;
    for light in lights {
        let incident = unit(towards(light.position, seen)); // L
        let incident_error = relative(point_error, incident.inverse) + INCIDENT_ERROR;
        let cosine = (-incident.vector).dot(normal.vector);
        let cosine_error = cosine_error(incident_error, normal_error);
        // NaN goes the exact way too.
        let lit = if cosine.abs() > cosine_error {
            cosine > 0.0
        } else {
            let above = if turn > 0.0 { Ordering::Greater } else { Ordering::Less };
            match sides.side_of(light.position) {
                Some(side) => side == above,
                None => {
                    error = UNKNOWN;
                    cosine > 0.0
                }
            }
        };
        if lit {
            // What a black surface adds is nothing, exactly.
            adds |= material.diffuse != 0.0 || material.specular != 0.0;
            color += material.diffuse * clamp_channel(cosine) * surface * light.color;
            let brightest_light = brightest(light.color);
            let scattered = diffuse_error(brightest(surface), errors.surface, cosine_error);
            error += material.diffuse * brightest_light * scattered;
            // Most surfaces are matt: no mirrored term, no power.
            if material.specular != 0.0 {
                let alignment = alignment(direction, incident.vector, normal.vector, cosine);
                let highlight = power(clamp_channel(alignment), material.shininess);
                color += material.specular * highlight * light.color;
                let alignment_error = alignment_error(incident_error, normal_error);
                let power_error = power_error(alignment, alignment_error, highlight, material.shininess);
                error += material.specular * brightest_light * power_error;
            }
        }
    }
    let rounding =
        if adds { sum_rounding(lights.len()) * brightest(color) + UNDERFLOW } else { product_rounding(seen) };
    Shaded { color, error: 1.01 * (error + rounding + material.ambient * errors.surface) }
}

/// `<D|N>` and a bound of its error.
#[inline(always)]
pub(crate) fn slope(direction: DVec3, normal: DVec3, normal_error: f64) -> (f64, f64) {
    let (slope, rounding) = dot_with_error(direction, normal);
    (slope, rounding + 1.01 * normal_error * norm(direction))
}

/// An error relative to a length, as the error of a direction; an exact vector has none, whatever its length.
#[inline(always)]
pub(crate) fn relative(error: f64, inverse_length: f64) -> f64 {
    if error == 0.0 { 0.0 } else { 1.01 * error * inverse_length }
}

/// The error of the cosine between two directions with these errors; infinite beyond what is proved.
#[inline(always)]
pub(crate) fn cosine_error(incident: f64, normal: f64) -> f64 {
    let error = 1.02 * (incident + normal) + COSINE_ROUNDING;
    if incident.max(normal) <= LARGEST_ERROR { error } else { f64::INFINITY }
}

/// `<-D | L - 2 <L|N> N>`, with `cosine` for `<-L|N>`.
#[inline(always)]
pub(crate) fn alignment(direction: DVec3, incident: DVec3, normal: DVec3, cosine: f64) -> f64 {
    (-direction).dot(incident + 2.0 * cosine * normal)
}

/// The error of [`alignment`], of directions with these errors.
#[inline(always)]
pub(crate) fn alignment_error(incident: f64, normal: f64) -> f64 {
    1.05 * (incident + 4.0 * normal) + ALIGNMENT_ROUNDING
}

/// The error of `power`, the `shininess`-th power of an alignment with an error, clamped.
#[inline(always)]
pub(crate) fn power_error(alignment: f64, error: f64, power: f64, shininess: f64) -> f64 {
    let growth = shininess * error / (alignment - error);
    // (1 + e/x)^s - 1 <= exp(s e / x) - 1, and below likewise
    let near = (1.05 * growth + 2.1 * U) * power + UNDERFLOW;
    // Both powers lie between 0 and that of the larger, which is at most the larger itself.
    let wide = if shininess >= 1.0 { 1.01 * (alignment.abs() + error) } else { f64::INFINITY };
    let bound = if (alignment > error) & (growth <= 1.0 / 32.0) { near } else { wide };
    // Surely turned away: no highlight.
    if alignment < -error { 0.0 } else { bound }
}

/// The error of a diffuse term before its products with the coefficient and the light: the cosine of a surface of this
/// brightness, times it.
#[inline(always)]
pub(crate) fn diffuse_error(brightest_surface: f64, surface_error: f64, cosine_error: f64) -> f64 {
    // A large coefficient may lift what underflows here.
    brightest_surface * (cosine_error + 3.1 * U) + surface_error + UNDERFLOW
}

/// The largest channel.
#[inline(always)]
pub(crate) fn brightest(color: DVec3) -> f64 {
    let larger = |x: f64, y: f64| if x > y { x } else { y };
    larger(color.x, larger(color.y, color.z))
}

/// The rounding of a sum of terms, relative to it: one addition a term, and the three products of a specular one.
#[inline(always)]
pub(crate) fn sum_rounding(lights: usize) -> f64 {
    (2 * lights + 5) as f64 * U
}

/// The rounding of the ambient term alone: exactly what the products lose, where a product is exact in two doubles.
fn product_rounding(seen: &SurfacePoint) -> f64 {
    const ORDINARY: std::ops::Range<f64> = power_of_two(-900)..power_of_two(900);
    let ambient = seen.material.ambient;
    // What underflows in the error of the surface.
    let least = if seen.errors.surface == 0.0 { 0.0 } else { UNDERFLOW };
    seen.surface.to_array().into_iter().fold(least, |most, channel| {
        let product = ambient * channel;
        let exact = ORDINARY.contains(&product.abs()) && ORDINARY.end > ambient.abs().max(channel.abs());
        let lost = if exact {
            two_prod::<false>(ambient, channel).1.abs()
        } else if ambient == 0.0 || channel == 0.0 {
            product.abs()
        } else {
            U * product.abs() + UNDERFLOW
        };
        // NaN stays.
        if most >= lost { most } else { lost + 0.0 * most }
    })
}

/// The sum of the magnitudes of the components: at least the length.
#[inline(always)]
pub(crate) fn norm(v: DVec3) -> f64 {
    (v.x.abs() + v.y.abs()) + v.z.abs()
}

/// A vector of length 1, and the reciprocal of the length that it had.
#[derive(Clone, Copy)]
pub(crate) struct Unit {
    pub(crate) vector: DVec3,
    pub(crate) inverse: f64,
}

/// Returns the vector of length 1 in the same direction, within [`UNIT_ERROR`]; zero stays zero, and a vector that is
/// not finite has no direction: NaN.
#[inline]
fn unit(v: DVec3) -> Unit {
    let (unit, ordinary) = ordinary_unit(v);
    if ordinary { unit } else { unit_scaled(v) }
}

/// Returns what [`unit`] returns, and whether it is that: `false` for lengths out of the ordinary.
#[inline(always)]
pub(crate) fn ordinary_unit(v: DVec3) -> (Unit, bool) {
    let length_squared = v.length_squared();
    let inverse = 1.0 / length_squared.sqrt();
    // Within these limits no square that counts has left the range of f64.
    (Unit { vector: v * inverse, inverse }, (1e-200..1e200).contains(&length_squared))
}

/// [`unit`] for what is not ordinary.
#[cold]
fn unit_scaled(v: DVec3) -> Unit {
    if v == DVec3::ZERO {
        return Unit { vector: v, inverse: f64::INFINITY };
    }
    if !v.is_finite() {
        return Unit { vector: DVec3::NAN, inverse: f64::NAN };
    }
    // The longest component lies in 2^-474 .. 2^424 then, and its square in the range of f64.
    let factor = 2f64.powi(if v.abs().max_element() < 1.0 { 600 } else { -600 });
    let scaled = v * factor;
    let inverse = 1.0 / scaled.length();
    Unit { vector: scaled * inverse, inverse: inverse * factor }
}

/// Returns a vector in the direction from a light to a point; zero only if they are the same point.
fn towards(light: DVec3, seen: &SurfacePoint) -> DVec3 {
    let difference = seen.point - light + seen.offset;
    // Only the sum of huge numbers overflows, and those can be made smaller without loss.
    if difference.is_finite() { difference } else { 0.25 * seen.point - 0.25 * light + 0.25 * seen.offset }
}

#[cfg(test)]
mod tests {
    use oracle::{Big, Lamp, Random, cases, dot, exact, sign, sub, vector};
    use proptest::prelude::*;

    use super::*;

    /// The colour of a point, all vectors exact.
    fn color_of(
        point: DVec3,
        direction: DVec3,
        normal: DVec3,
        surface: DVec3,
        material: &Material,
        lights: &[PointLight],
    ) -> DVec3 {
        phong(&SurfacePoint::new(point, direction, normal, surface, material), lights).color
    }

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
            let color = color_of(p, d, n, surface, &SHINY, &[light]);
            let expected = plain_phong(p, d, n, &light);
            // A rounding error may decide whether a light that grazes the surface counts: then both terms are tiny,
            // or the mirrored term is not; skip the 1e-12 around it.
            let cosine = (l - p).normalize().dot(n.normalize()).abs();
            prop_assume!(cosine > 1e-12 && d.normalize().dot(n.normalize()).abs() > 1e-12);
            prop_assert!((color - expected).length() < 1e-12, "{} instead of {}", color, expected);
        }

        #[test]
        fn lights_add_up(p in any_vector(), d in any_vector(), n in any_vector(), l in any_vector(), m in any_vector()) {
            let shade = |lights: &[PointLight]| color_of(p, d, n, DVec3::ONE, &SHINY, lights);
            let ambient = DVec3::splat(SHINY.ambient);
            let sum = shade(&[lamp(l)]) + shade(&[lamp(m)]) - ambient;
            prop_assert!((shade(&[lamp(l), lamp(m)]) - sum).length() < 1e-14);
        }

        #[test]
        fn both_sides_of_a_surface_are_shaded_alike(p in any_vector(), d in any_vector(), n in any_vector(), l in any_vector()) {
            let shade = |normal| color_of(p, d, normal, DVec3::ONE, &SHINY, &[lamp(l)]);
            prop_assume!(d.dot(n) != 0.0);
            prop_assert_eq!(shade(n), shade(-n));
        }

        #[test]
        fn lengths_do_not_matter(p in any_vector(), d in any_vector(), n in any_vector(), l in any_vector(), e in -900..900, f in -900..900) {
            let shade = |d, n| color_of(p, d, n, DVec3::ONE, &SHINY, &[lamp(l)]);
            let (long_d, long_n) = (d * 2f64.powi(e), n * 2f64.powi(f));
            prop_assert!((shade(d, n) - shade(long_d, long_n)).length() < 1e-13);
        }

        #[test]
        fn a_light_behind_the_surface_adds_nothing(d in any_vector(), n in any_vector(), l in any_vector()) {
            // Eye and light on different sides of the plane through the origin.
            prop_assume!(d.dot(n) * l.dot(n) > 1e-9);
            let color = color_of(DVec3::ZERO, d, n, DVec3::ONE, &SHINY, &[lamp(l)]);
            prop_assert_eq!(color, DVec3::splat(SHINY.ambient));
        }

        #[test]
        fn the_highlight_is_where_the_mirrored_eye_meets_the_light(n in any_vector(), d in any_vector(), s in 1.0f64..1000.0) {
            prop_assume!(d.dot(n).abs() > 1e-3);
            let material = Material { ambient: 0.0, diffuse: 0.0, specular: 1.0, shininess: s };
            let towards_light = rt_math::reflect(d, n);
            let light = PointLight { position: 3.0 * towards_light, color: DVec3::ONE };
            let highlight = color_of(DVec3::ZERO, d, n, DVec3::ZERO, &material, &[light]);
            // The alignment is 1 within some roundings; its power is worse by the exponent.
            prop_assert!((highlight.x - 1.0).abs() < 20.0 * s * f64::EPSILON, "{}", highlight);
        }

        #[test]
        fn a_unit_vector_has_length_one(v in prop::array::uniform3(any::<u64>())) {
            let v = DVec3::from_array(v.map(f64::from_bits));
            prop_assume!(v.is_finite() && v != DVec3::ZERO);
            let unit = unit(v).vector;
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
            rounding_would_err += usize::from((unit(d).vector.dot(unit(n).vector) > 0.0) != away);
            let lit_from = |position| {
                color_of(DVec3::ZERO, d, n, DVec3::ONE, &SHINY, &[lamp(position)]) != DVec3::splat(SHINY.ambient)
            };
            assert_eq!([lit_from(-n), lit_from(n)], [away, !away], "direction {d:?}, normal {n:?}");
        }
        assert!(rounding_would_err > 500, "{rounding_would_err}");
    }

    /// Checks the side of a light near the plane through `point`, seen from the side that `normal` leads to and from
    /// the other; returns whether the rounded cosine would put it on another side.
    fn check_side(point: DVec3, light: DVec3, normal: DVec3) -> bool {
        use crate::phong_batch;
        let side = sign(&dot(&sub(&vector(light), &vector(point)), &vector(normal)));
        // The mirrored light runs nearly into the eye: where it counts, the colour is about 1, and 0 elsewhere.
        let material = &Material { ambient: 0.0, diffuse: 0.0, specular: 1.0, shininess: 1.0 };
        let incident = unit(towards(light, &SurfacePoint::new(point, normal, normal, DVec3::ONE, material))).vector;
        let up = unit(normal).vector;
        for (up, above) in [(up, Ordering::Greater), (-up, Ordering::Less)] {
            let seen = SurfacePoint::new(point, -incident - 0.1 * up, normal, DVec3::ONE, material);
            let lights = [PointLight { position: light, color: DVec3::ONE }];
            let shaded = phong(&seen, &lights);
            assert!(shaded.error < 1e-13, "{shaded:?}");
            let color = shaded.color.x;
            assert!(
                if side == above { color > 0.9 } else { color == 0.0 },
                "{light:?} is {side:?} of {normal:?} at {point:?}, and the colour {color}"
            );
            let mut colors = [Shaded { color: DVec3::NAN, error: f64::NAN }; 3];
            phong_batch(&[seen; 3], &lights, &mut colors);
            assert_eq!(colors.map(|shaded| shaded.color), [DVec3::splat(color); 3], "together");
        }
        (-incident).dot(unit(normal).vector).partial_cmp(&0.0) != Some(side)
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
            let color = color_of(point, -normal, normal, DVec3::ONE, &material, &[light]);
            assert!((0.0..1e-9).contains(&color.x), "{color} from {light:?} at {point:?}, {normal:?}");
        }
    }

    #[test]
    fn without_lights_the_surface_is_flat() {
        let surface = DVec3::new(0.3, 0.6, 0.9);
        assert_eq!(color_of(DVec3::ONE, DVec3::NEG_Z, DVec3::Z, surface, &SHINY, &[]), surface);
    }

    #[test]
    fn a_light_at_the_point_adds_nothing() {
        for point in [DVec3::ZERO, DVec3::ONE, DVec3::splat(1e300)] {
            let color = color_of(point, DVec3::NEG_Z, DVec3::Z, DVec3::ONE, &SHINY, &[lamp(point)]);
            assert_eq!(color, DVec3::splat(SHINY.ambient), "at {point}");
        }
    }

    #[test]
    fn the_nearest_and_the_farthest_light_are_lights() {
        let shade =
            |point: DVec3, position| color_of(point, DVec3::NEG_Z, DVec3::Z, DVec3::ONE, &SHINY, &[lamp(position)]);
        let expected = shade(DVec3::ZERO, DVec3::Z);
        for height in [f64::from_bits(1), 1e-310, 1e-160, 1e160, f64::MAX] {
            assert_eq!(shade(DVec3::ZERO, height * DVec3::Z), expected, "height {height:e}");
        }
        assert_eq!(shade(f64::MIN * DVec3::Z, f64::MAX * DVec3::Z), expected, "a distance beyond f64");
    }

    #[test]
    fn a_tangent_light_adds_nothing() {
        let color = color_of(DVec3::ZERO, DVec3::NEG_Z, DVec3::Z, DVec3::ONE, &SHINY, &[lamp(DVec3::X)]);
        assert_eq!(color, DVec3::splat(SHINY.ambient));
    }

    #[test]
    fn bad_numbers_do_no_harm() {
        let ambient = DVec3::splat(SHINY.ambient);
        let shade = |p, d, n, l| color_of(p, d, n, DVec3::ONE, &SHINY, &[lamp(l)]);
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
        let color = color_of(DVec3::ZERO, DVec3::new(0.1, 0.0, -1.0), DVec3::Z, DVec3::ONE, &nan, &[lamp(DVec3::Z)]);
        assert!(color.is_nan(), "a NaN shininess shows: {color}");
    }

    /// How far a channel is from the exact colour of the point with these exact vectors.
    fn distance(
        shaded: &Shaded,
        vectors: [&[Big; 3]; 3],
        surface: DVec3,
        material: &Material,
        light: &PointLight,
    ) -> f64 {
        let [point, direction, normal] = vectors;
        let coefficients = [material.ambient, material.diffuse, material.specular];
        let lamp = Lamp { position: vector(light.position), color: vector(light.color) };
        let truth =
            oracle::shade(point, direction, normal, &vector(surface), coefficients, material.shininess, &[lamp]);
        let error = |i: usize| (exact(shaded.color[i]) - &truth[i]).to_f64().value().abs();
        error(0).max(error(1)).max(error(2))
    }

    #[test]
    fn the_error_is_within_its_bound_and_the_bound_is_small() {
        let mut random = Random::new(11);
        let (mut sharpest, mut largest) = (0.0f64, 0.0f64);
        for i in 0..cases(LONG) {
            let [point, direction, normal] = [0; 3].map(|_| random.point());
            let light = lamp(4.0 * random.point());
            let material = Material { shininess: (1 + i % 32) as f64, ..SHINY };
            let surface = random.point().abs();
            let shaded = phong(&SurfacePoint::new(point, direction, normal, surface, &material), &[light]);
            let vectors = [&vector(point), &vector(direction), &vector(normal)];
            let error = distance(&shaded, vectors, surface, &material, &light);
            assert!(error <= shaded.error, "{shaded:?} is {error:e} off");
            let sum = shaded.color.max_element();
            largest = largest.max(shaded.error / sum);
            sharpest = sharpest.max(error / shaded.error);
        }
        assert!(largest < 2e-13 && sharpest > 0.01, "{largest:e} {sharpest}");
    }

    #[test]
    fn vectors_known_within_bounds_have_their_colour_within_one() {
        let mut random = Random::new(12);
        let mut open = 0;
        for i in 0..cases(LONG) {
            let [point, direction, normal] = [0; 3].map(|_| random.point());
            let light = lamp(point + random.power(-12..2) * random.point());
            let material = Material { shininess: [1.0, 2.0, 32.0, 1000.0][i % 4], ..SHINY };
            let (surface, size) = (random.point().abs(), random.power(-50..-8));
            // Within `size` of the exact vectors, in pieces and out of them.
            let wrong = |random: &mut Random| 0.57 * size * random.point();
            let errors = Errors { point: size, normal: size, surface: size };
            let offset = if i % 2 == 0 { DVec3::ZERO } else { random.point() };
            let near = point - offset;
            let moved = near + wrong(&mut random);
            let exact_point = [0, 1, 2].map(|axis| exact(near[axis]) + exact(offset[axis]));
            let seen = SurfacePoint {
                offset,
                normal: normal + wrong(&mut random),
                surface: surface + 0.9 * size * random.uniform(),
                errors,
                ..SurfacePoint::new(moved, direction, normal, surface, &material)
            };
            let shaded = phong(&seen, &[light]);
            if shaded.error < f64::INFINITY {
                let vectors = [&exact_point, &vector(direction), &vector(normal)];
                let error = distance(&shaded, vectors, surface, &material, &light);
                assert!(error <= shaded.error, "{seen:?} {light:?} {shaded:?} is {error:e} off");
            } else {
                open += 1;
            }
        }
        assert!(open > 10 && open < cases(LONG) / 2, "{open}");
    }

    #[test]
    fn the_ambient_term_alone_is_known_to_its_last_bit() {
        let below = lamp(DVec3::NEG_Z);
        let shade = |ambient: f64, surface: f64| {
            let material = Material { ambient, ..SHINY };
            phong(&SurfacePoint::new(DVec3::ZERO, DVec3::NEG_Z, DVec3::Z, DVec3::splat(surface), &material), &[below])
        };
        assert_eq!(shade(0.5, 1.0), Shaded { color: DVec3::splat(0.5), error: 0.0 });
        let shaded = shade(0.1, 0.7);
        let lost = (exact(0.1) * exact(0.7) - exact(shaded.color.x)).to_f64().value().abs();
        assert!(lost <= shaded.error && shaded.error <= 1.02 * lost && lost > 0.0, "{shaded:?} {lost:e}");
    }

    #[test]
    fn what_underflows_in_a_product_is_within_the_bound() {
        let mut random = Random::new(13);
        for _ in 0..cases(LONG) / 10 {
            let (normal, light) = (random.point(), lamp(DVec3::Z + random.point()));
            let size = random.power(-40..-8);
            // Coefficients that lift a subnormal colour back to 1 and more.
            let (dark, huge) = (f64::from_bits(1 + random.bits() % 1000), f64::MAX / 1e4);
            let material = Material { ambient: 0.0, diffuse: huge, specular: 0.0, shininess: 1.0 };
            let seen = SurfacePoint {
                errors: Errors { normal: size, ..Errors::default() },
                ..SurfacePoint::new(DVec3::ZERO, -DVec3::Z, normal, DVec3::splat(dark), &material)
            };
            let shaded = phong(&seen, &[light]);
            let moved = normal + 0.5 * size * random.point();
            if shaded.error < f64::INFINITY {
                let vectors = [&vector(DVec3::ZERO), &vector(seen.direction), &vector(moved)];
                let error = distance(&shaded, vectors, seen.surface, &material, &light);
                assert!(error <= shaded.error, "{seen:?} {shaded:?} is {error:e} off");
            }
        }
    }

    #[test]
    fn an_ambient_product_of_any_size_is_within_its_bound() {
        let mut random = Random::new(14);
        let below = lamp(DVec3::NEG_Z);
        for _ in 0..cases(LONG) {
            let ambient = random.with_exponent(-1074..1024).abs();
            let channel = random.with_exponent(-1074..0).abs();
            let material = Material { ambient, ..SHINY };
            let surface = DVec3::new(0.0, channel, 0.0);
            let shaded = phong(&SurfacePoint::new(DVec3::ZERO, DVec3::NEG_Z, DVec3::Z, surface, &material), &[below]);
            let truth = exact(ambient) * exact(channel);
            if shaded.color.y < f64::INFINITY {
                let lost = (truth - exact(shaded.color.y)).to_f64().value().abs();
                assert!(lost <= shaded.error, "{ambient:e} {channel:e}: {shaded:?} is {lost:e} off");
            } else {
                assert_eq!(shaded.error, f64::INFINITY);
            }
        }
        let unknown = |surface: f64, ambient: f64| {
            let errors = Errors { surface: f64::INFINITY, ..Errors::default() };
            let material = Material { ambient, ..SHINY };
            let seen = SurfacePoint::new(DVec3::ZERO, DVec3::NEG_Z, DVec3::Z, DVec3::splat(surface), &material);
            phong(&SurfacePoint { errors, ..seen }, &[below]).error
        };
        assert!(is_unknown(unknown(0.5, 0.1)) && is_unknown(unknown(0.0, 0.0)));
    }

    /// Whether a bound says that nothing is known.
    fn is_unknown(bound: f64) -> bool {
        bound.is_nan() || bound == f64::INFINITY
    }

    #[test]
    fn errors_that_are_unknown_never_look_small() {
        let mut random = Random::new(15);
        for i in 0..1000 {
            let [direction, normal, position] = [0; 3].map(|_| random.point());
            let zero_or = |x: f64, random: &mut Random| if random.one_in(3) { 0.0 } else { x };
            let material = Material {
                ambient: zero_or(0.1, &mut random),
                diffuse: zero_or(0.6, &mut random),
                specular: zero_or(0.3, &mut random),
                shininess: random.pick(&[0.5, 1.0, 32.0, 1e6]),
            };
            let color = DVec3::splat(zero_or(1.0, &mut random));
            let surface = DVec3::splat(zero_or(0.5, &mut random));
            let unknown = random.pick(&[f64::INFINITY, f64::NAN]);
            let errors = match i % 3 {
                0 => Errors { point: unknown, ..Errors::default() },
                1 => Errors { normal: unknown, ..Errors::default() },
                _ => Errors { surface: unknown, ..Errors::default() },
            };
            let seen = SurfacePoint { errors, ..SurfacePoint::new(DVec3::ZERO, direction, normal, surface, &material) };
            for lights in [&[][..], &[PointLight { position, color }]] {
                // Without lights the vectors do not matter.
                if lights.is_empty() && i % 3 != 2 {
                    continue;
                }
                let shaded = phong(&seen, lights);
                assert!(is_unknown(shaded.error), "{seen:?} {lights:?} {shaded:?}");
            }
        }
    }

    #[test]
    fn the_worst_direction_of_an_error_is_within_the_bound() {
        let mut random = Random::new(16);
        let mut sharpest = [0.0f64; 2];
        for i in 0..cases(LONG) {
            let (normal, size) = (random.point().normalize(), random.power(-30..-9));
            let position = 0.5 * normal + 2.0 * random.point();
            let light = PointLight { position, color: DVec3::ONE };
            let incident = -position.normalize();
            let mirrored = incident - 2.0 * incident.dot(normal) * normal;
            let direction = -(mirrored + 0.3 * random.point());
            // The normal turns towards the light, or towards the eye and the light alike; the point moves across.
            let across = |v: DVec3, n: DVec3| (v - v.dot(n) * n).normalize_or_zero();
            let (turned, material) = if i % 2 == 0 {
                (across(incident, normal), Material { ambient: 0.0, diffuse: 1.0, specular: 0.0, shininess: 1.0 })
            } else {
                let towards = across(-direction, mirrored) + across(incident, normal);
                (across(towards, normal), Material { ambient: 0.0, diffuse: 0.0, specular: 1.0, shininess: 8.0 })
            };
            let wrong = random.sign() * 0.999 * size;
            let errors = Errors { normal: size, ..Errors::default() };
            let given = SurfacePoint::new(DVec3::ZERO, direction, normal, DVec3::ONE, &material);
            let shaded = phong(&SurfacePoint { errors, ..given }, &[light]);
            if shaded.error < 1.0 && shaded.color.x > 0.0 {
                let vectors = [&vector(DVec3::ZERO), &vector(direction), &vector(normal + wrong * turned)];
                let error = distance(&shaded, vectors, DVec3::ONE, &material, &light);
                assert!(error <= shaded.error, "{given:?} {shaded:?} is {error:e} off");
                sharpest[i % 2] = sharpest[i % 2].max(error / shaded.error);
            }
        }
        // A normal that turns takes the mirrored light twice as far; the bound allows four times, for lengths.
        assert!(sharpest[0] > 0.9 && sharpest[1] > 0.15, "{sharpest:?}");
    }

    #[test]
    fn what_a_long_offset_loses_is_within_the_bound() {
        let mut random = Random::new(17);
        for _ in 0..cases(LONG) / 10 {
            let (direction, normal, offset) = (random.point(), random.point(), random.power(0..50) * random.point());
            let material = Material { ambient: 0.0, diffuse: 1.0, specular: 0.0, shininess: 1.0 };
            let (point, light) = (random.point() - offset, lamp(random.point()));
            let seen = SurfacePoint { offset, ..SurfacePoint::new(point, direction, normal, DVec3::ONE, &material) };
            let shaded = phong(&seen, &[light]);
            if shaded.error < f64::INFINITY {
                let place = [0, 1, 2].map(|axis| exact(point[axis]) + exact(offset[axis]));
                let error =
                    distance(&shaded, [&place, &vector(direction), &vector(normal)], DVec3::ONE, &material, &light);
                assert!(error <= shaded.error, "{seen:?} {light:?} {shaded:?} is {error:e} off");
            }
        }
    }

    /// The length of the difference of a vector and an exact one.
    fn off(found: DVec3, truth: &[Big; 3]) -> f64 {
        let difference = [0, 1, 2].map(|i| (exact(found[i]) - &truth[i]).to_f64().value());
        DVec3::from_array(difference).length()
    }

    #[test]
    fn directions_are_within_their_bounds_and_not_far_below() {
        let mut random = Random::new(21);
        let (mut unit_share, mut incident_share) = (0.0f64, 0.0f64);
        for _ in 0..cases(LONG) / 10 {
            let (v, light) = (random.power(-200..200) * random.point(), random.point());
            let found = off(unit(v).vector, &oracle::unit(&vector(v)));
            assert!(found <= UNIT_ERROR, "{v:?}: {found:e}");
            unit_share = unit_share.max(found / UNIT_ERROR);
            let point = light + random.power(-10..10) * random.point();
            let way = [0, 1, 2].map(|i| exact(point[i]) - exact(light[i]));
            let found = off(unit(point - light).vector, &oracle::unit(&way));
            assert!(found <= INCIDENT_ERROR, "{point:?} from {light:?}: {found:e}");
            incident_share = incident_share.max(found / INCIDENT_ERROR);
        }
        assert!(unit_share > 0.25 && incident_share > 0.25, "{unit_share} {incident_share}");
    }

    /// Errors far above rounding, in their worst directions: each bound holds what they do, and little more.
    #[test]
    fn what_errors_of_vectors_do_is_bounded_and_hardly_more() {
        let mut random = Random::new(22);
        let mut shares = [0.0f64; 4];
        let mut see = |i: usize, change: f64, bound: f64| {
            assert!(change.abs() <= bound, "{i}: {change:e}, bound {bound:e}");
            shares[i] = shares[i].max(change.abs() / bound);
        };
        for i in 0..cases(LONG) {
            let mut direction = || unit(random.point()).vector;
            let (d, l, n, side) = (direction(), direction(), direction(), direction());
            let e = 1e-5;
            let of = |l: DVec3, n: DVec3| alignment(d, l, n, -l.dot(n));
            let moved = |v: DVec3, to: DVec3| v + e * unit(to - to.dot(v) * v).vector;
            let mirrored = -d - 2.0 * (-d).dot(n) * n;
            see(0, of(moved(l, mirrored), n) - of(l, n), alignment_error(1.001 * e, 0.0));
            let worst = l.dot(n) * d + d.dot(n) * l;
            see(1, of(l, moved(n, worst)) - of(l, n), alignment_error(0.0, 1.001 * e));
            let axis = DVec3::AXES[i % 3];
            see(2, (n + e * axis).dot(axis) - n.dot(axis), slope(axis, n, 1.001 * e).1);
            let length = random.power(-300..300);
            let wrong = length * moved(n, side);
            let turned = unit(wrong).vector - unit(length * n).vector;
            see(3, turned.length(), relative(1.001 * e * length, 1.0 / length));
        }
        assert!(shares[0] > 0.9 && shares[1] > 0.45 && shares[2] > 0.9 && shares[3] > 0.9, "{shares:?}");
    }

    #[test]
    fn what_an_error_does_to_a_highlight_is_bounded_and_hardly_more() {
        let mut random = Random::new(23);
        let (mut near, mut rounding) = (0.0f64, 0.0f64);
        for _ in 0..cases(LONG) / 20 {
            let (x, shininess) = (random.within(0.1, 1.0), random.power(0..8));
            let highlight = power(x, shininess);
            let error = x * random.power(-30..-6) / shininess;
            let bound = power_error(x, error, highlight, shininess);
            for wrong in [x - error, x + error] {
                let change = (wrong.powf(shininess) - x.powf(shininess)).abs();
                assert!(change <= bound, "{x} within {error:e} to the {shininess}: {change:e}, bound {bound:e}");
                near = near.max(change / bound);
            }
            let bound = power_error(x, 0.0, highlight, shininess);
            let off = (exact(highlight) - oracle::power(x, shininess)).to_f64().value().abs();
            assert!(off <= bound, "{x} to the {shininess}: {off:e}, bound {bound:e}");
            rounding = rounding.max(off / bound);
        }
        assert!(near > 0.9 && rounding > 0.2, "{near} {rounding}");

        // Near up to a growth of 1/32, and then the larger alignment itself, if the power is not above it.
        let bound = |x: f64, error: f64, shininess: f64| power_error(x, error, x.powf(shininess), shininess);
        assert!(bound(1.0, 0.0295, 1.0) < 0.035 && (1.0..1.1).contains(&bound(1.0, 0.033, 1.0)));
        assert!((0.6..0.7).contains(&bound(0.5, 0.1, 1.0)) && (0.6..0.7).contains(&bound(0.5, 0.1, 8.0)));
        assert_eq!([bound(1e-4, 1e-2, 0.5), bound(1e-4, 1e-2, 0.99)], [f64::INFINITY; 2]);
        assert_eq!(bound(-0.2, 0.1, 1.0), 0.0);
    }

    #[test]
    fn what_the_products_of_a_diffuse_term_lose_is_bounded_and_hardly_more() {
        let (mut random, mut share) = (Random::new(24), 0.0f64);
        for _ in 0..cases(LONG) {
            let [diffuse, surface, light] = [(); 3].map(|()| random.within(0.1, 4.0));
            let cosine = random.within(0.9, 1.0);
            let product = diffuse * cosine * surface * light;
            let off =
                (exact(product) - exact(diffuse) * exact(cosine) * exact(surface) * exact(light)).to_f64().value();
            let bound = diffuse * light * diffuse_error(surface, 0.0, 0.0);
            assert!(off.abs() <= bound, "{diffuse} {cosine} {surface} {light}: {off:e}, bound {bound:e}");
            share = share.max(off.abs() / bound);
        }
        assert!(share > 0.5, "{share}");
    }
}
