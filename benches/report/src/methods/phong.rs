//! The brightness of a white point in one white light. A case is point, direction, normal, light, shininess (a whole
//! number); there is no verdict; the value is the sum of the ambient, diffuse and specular terms.

use glam::DVec3;
use rt_shade::{Material, PointLight, SurfacePoint, phong as ours};

use super::method::{Answer, Method};
use super::real::{Components, Float, dot, dvec3, normalized, power, scaled, sub, vector};

/// What the point is made of; the shininess is the case's.
pub(crate) const MATERIAL: Material = Material { ambient: 0.125, diffuse: 0.75, specular: 0.5, shininess: 1.0 };

/// Returns the methods that light a point.
pub(crate) fn phong() -> Vec<Method<13, 1>> {
    vec![
        Method::new("textbook f32", "Phong 1975: v/|v|, 2(n·l)n - l, repeated squaring", one_lamp::<f32>),
        Method::new("textbook", "Phong 1975: v/|v|, 2(n·l)n - l, repeated squaring", one_lamp::<f64>),
        Method::new("half vector", "Blinn 1977, exponent times 4: another highlight", half_vector),
        Method::ours("ours", |case| {
            let lamp = PointLight { position: dvec3(case, 9), color: DVec3::ONE };
            let material = Material { shininess: case[12], ..MATERIAL };
            let seen = SurfacePoint::new(dvec3(case, 0), dvec3(case, 3), dvec3(case, 6), DVec3::ONE, &material);
            Answer { verdict: 0, values: [ours(&seen, &[lamp]).color.x] }
        }),
    ]
}

fn one_lamp<T: Float>(case: &[f64; 13]) -> Answer<1> {
    let [point, direction, normal, lamp] = [0, 3, 6, 9].map(|from| vector::<T>(case, from));
    let (diffuse, specular) = terms(point, direction, normal, lamp, case[12]);
    let [a, d, s] = [MATERIAL.ambient, MATERIAL.diffuse, MATERIAL.specular].map(T::of);
    Answer { verdict: 0, values: [(a + d * diffuse + s * specular).wide()] }
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
fn half_vector(case: &[f64; 13]) -> Answer<1> {
    let [point, direction, normal, lamp] = [0, 3, 6, 9].map(|from| vector::<f64>(case, from));
    let eye = normalized(direction).map(|x| -x);
    let normal = normalized(normal);
    let normal = if dot(eye, normal) < 0.0 { normal.map(|x| -x) } else { normal };
    let towards = normalized(sub(lamp, point));
    let cosine = dot(towards, normal).max(0.0);
    let half = normalized([0, 1, 2].map(|i| towards[i] + eye[i]));
    let specular = if cosine > 0.0 { power(dot(half, normal).max(0.0), 4.0 * case[12]) } else { 0.0 };
    let brightness = MATERIAL.ambient + MATERIAL.diffuse * cosine + MATERIAL.specular * specular;
    Answer { verdict: 0, values: [brightness] }
}
