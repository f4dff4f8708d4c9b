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
//! Point lights without attenuation, no shadows. Only a light on the side that the ray comes from adds anything.

use glam::DVec3;

use crate::color::clamp_channel;
use crate::power::power;

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
/// `direction` leads from the eye to the point and `normal` is perpendicular to the surface; both may have any
/// length, and the normal is turned to the side that the ray comes from. `surface` is the surface's own colour.
/// Each light adds a diffuse and a specular term, both only if it is on the eye's side of the surface; a light
/// exactly at the point adds nothing. Without lights the result is `surface` itself: a flat picture.
///
/// Channels are not clamped. A zero or non-finite direction, normal or distance to a light leaves the term out that
/// needs it. A NaN shininess makes the specular term NaN; one of 0 or less counts as a power all the same.
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
    let direction = unit(direction);
    let normal = unit(normal);
    let normal = if direction.dot(normal) > 0.0 { -normal } else { normal };

    let mut color = material.ambient * surface;
    for light in lights {
        let incident = unit(towards(light.position, point)); // L
        let cosine = (-incident).dot(normal);
        // Written so that NaN fails it.
        if cosine > 0.0 {
            color += material.diffuse * cosine.min(1.0) * surface * light.color;
            let alignment = clamp_channel((-direction).dot(reflect(incident, normal)));
            color += material.specular * power(alignment, material.shininess) * light.color;
        }
    }
    color
}

/// Returns the vector of length 1 in the same direction, each component within 4 ulp; zero stays zero, and a vector
/// that is not finite has no direction: NaN.
fn unit(v: DVec3) -> DVec3 {
    let largest = v.abs().max_element();
    // Squares of numbers beyond these limits could leave the range of f64, so they are scaled first.
    let v = if (1e-100..1e100).contains(&largest) || v == DVec3::ZERO {
        v
    } else if largest < 1.0 {
        v * 2f64.powi(1000)
    } else {
        v * 2f64.powi(-1000)
    };
    if v == DVec3::ZERO { v } else { v / v.length() }
}

/// Returns a vector in the direction from `from` to `to`; zero only if they are the same point.
fn towards(from: DVec3, to: DVec3) -> DVec3 {
    let difference = to - from;
    // Only the sum of two huge numbers overflows, and those can be halved without loss.
    if difference.is_finite() { difference } else { 0.5 * to - 0.5 * from }
}

/// Mirrors `incident` at the plane through the origin that is perpendicular to `normal`.
fn reflect(incident: DVec3, normal: DVec3) -> DVec3 {
    incident - 2.0 * (incident.dot(normal) / normal.dot(normal)) * normal
}
