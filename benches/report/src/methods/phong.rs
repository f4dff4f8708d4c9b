//! The byte of a white point in one white light. A case is point, direction, normal, light, shininess (a whole number);
//! the verdict is the byte of the sum of the ambient, diffuse and specular terms; there is no value.

use std::cmp::Ordering;

use glam::DVec3;
use rt_math::exact::{Ball, U, difference_dot_sign, dot_sign, vector as balls};
use rt_shade::color::to_sample;
use rt_shade::{Material, PointLight, Shaded, SurfacePoint, certified, phong as ours};

use super::method::{Answer, Method};
use super::real::{Components, Float, dot, dvec3, normalized, power, scaled, sub, vector};

/// What the point is made of; the shininess is the case's.
pub(crate) const MATERIAL: Material = Material { ambient: 0.125, diffuse: 0.75, specular: 0.5, shininess: 1.0 };

/// Returns the methods that light a point.
pub(crate) fn phong() -> Vec<Method<13, 0>> {
    vec![
        Method::new("textbook f32", "Phong 1975: v/|v|, 2(n·l)n - l, repeated squaring", one_lamp::<f32>),
        Method::new("textbook", "Phong 1975: v/|v|, 2(n·l)n - l, repeated squaring", one_lamp::<f64>),
        Method::new("half vector", "Blinn 1977, exponent times 4: another highlight", half_vector),
        Method::ours("ours, not certified", |case| byte(shaded(case).color.x)),
        Method::ours("ours", |case| match certain(shaded(case)) {
            Some(byte) => Answer::without_values(byte),
            None => climb(case),
        }),
    ]
}

/// The byte of a brightness.
fn byte(brightness: f64) -> Answer<0> {
    Answer::without_values(eight(to_sample(brightness, 255)))
}

fn eight(sample: u16) -> u8 {
    u8::try_from(sample).expect("a sample is at most 255")
}

/// The colour with a bound of its error.
fn shaded(case: &[f64; 13]) -> Shaded {
    let lamp = PointLight { position: dvec3(case, 9), color: DVec3::ONE };
    let material = Material { shininess: case[12], ..MATERIAL };
    ours(&SurfacePoint::new(dvec3(case, 0), dvec3(case, 3), dvec3(case, 6), DVec3::ONE, &material), &[lamp])
}

/// What `255 c + ½` may be off by for a `c` in `0..=1`, in units of `c`: two roundings of numbers below 256, and of the
/// ends of the interval itself.
const ROUNDING: f64 = 4.0 * U;

/// The byte, if all colours within the bound have it: the renderer's rule for one sample.
fn certain(Shaded { color, error }: Shaded) -> Option<u8> {
    let slack = error + ROUNDING;
    let [low, high] = [-slack, slack].map(|slack| to_sample(color.x + slack, 255));
    // False for NaN.
    (slack < 0.001 && low == high).then(|| eight(low))
}

/// The byte by enclosures, as the renderer finds it where doubles leave it open.
#[cold]
#[inline(never)]
fn climb(case: &[f64; 13]) -> Answer<0> {
    let stages = [enclosed::<2>, enclosed::<8>, enclosed::<32>];
    let byte = stages.iter().find_map(|enclosed| enclosed(case, false)).or_else(|| enclosed::<32>(case, true));
    Answer::without_values(byte.unwrap_or(0))
}

/// The byte, if `64 LIMBS` bits decide; with `tie`, a number that may be whole is taken for whole.
fn enclosed<const LIMBS: usize>(case: &[f64; 13], tie: bool) -> Option<u8> {
    let [point, direction, normal, light] = [0, 3, 6, 9].map(|from| dvec3(case, from));
    let material = Material { shininess: case[12], ..MATERIAL };
    let turned = dot_sign(direction, normal) == Some(Ordering::Greater);
    let normal = if turned { -normal } else { normal };
    let shines = difference_dot_sign(light, point, normal) == Some(Ordering::Greater);
    let shining = shines.then(|| (DVec3::ONE, balls::difference::<Ball<LIMBS>>(point, light)));
    let normal = normal.to_array().map(Ball::<LIMBS>::from_f64);
    let color = certified::phong(direction, &normal, &[Ball::ONE; 3], &material, shining.into_iter());
    let scaled = color[0].clamp() * Ball::from_integer(255) + Ball::ONE.scale(-1);
    let whole = scaled.floor().or_else(|| if tie { scaled.nearest_integer() } else { None })?;
    Some(u8::try_from(whole.clamp(0, 255)).expect("within a byte"))
}

fn one_lamp<T: Float>(case: &[f64; 13]) -> Answer<0> {
    let [point, direction, normal, lamp] = [0, 3, 6, 9].map(|from| vector::<T>(case, from));
    let (diffuse, specular) = terms(point, direction, normal, lamp, case[12]);
    let [a, d, s] = [MATERIAL.ambient, MATERIAL.diffuse, MATERIAL.specular].map(T::of);
    byte((a + d * diffuse + s * specular).wide())
}

/// The cosine and the power of Phong's diffuse and specular terms; both are zero where the light is behind the surface.
pub(crate) fn terms<T: Float>(
    point: Components<T>,
    direction: Components<T>,
    normal: Components<T>,
    lamp: Components<T>,
    shininess: f64,
) -> (T, T) {
    let zero = T::of(0.0);
    let eye = normalized(direction).map(|x| -x);
    let normal = normalized(normal);
    let normal = if dot(eye, normal) < zero { normal.map(|x| -x) } else { normal };
    let towards = normalized(sub(lamp, point));
    let cosine = dot(towards, normal);
    if cosine > zero {
        let mirrored = sub(scaled(normal, T::of(2.0) * cosine), towards);
        let alignment = dot(eye, mirrored);
        (cosine, if alignment > zero { power(alignment, shininess) } else { zero })
    } else {
        (zero, zero)
    }
}

/// What is often drawn instead, from the vector halfway between light and eye.
fn half_vector(case: &[f64; 13]) -> Answer<0> {
    let [point, direction, normal, lamp] = [0, 3, 6, 9].map(|from| vector::<f64>(case, from));
    let eye = normalized(direction).map(|x| -x);
    let normal = normalized(normal);
    let normal = if dot(eye, normal) < 0.0 { normal.map(|x| -x) } else { normal };
    let towards = normalized(sub(lamp, point));
    let cosine = dot(towards, normal).max(0.0);
    let half = normalized([0, 1, 2].map(|i| towards[i] + eye[i]));
    let specular = if cosine > 0.0 { power(dot(half, normal).max(0.0), 4.0 * case[12]) } else { 0.0 };
    byte(MATERIAL.ambient + MATERIAL.diffuse * cosine + MATERIAL.specular * specular)
}
