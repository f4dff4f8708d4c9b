//! Phong's light on a point, in numbers of 400 bits.

use dashu::integer::IBig;

use super::{Big, dot, exact, is_negative, is_zero, long, quotient, root, rounded, sub, vector};
use crate::methods::{Answer, MATERIAL};

/// A light: where it is and its colour.
pub(in super::super) struct Lamp {
    pub(in super::super) position: [Big; 3],
    pub(in super::super) color: [Big; 3],
}

/// The brightness of a white point in one white light. A case is point, direction, normal, light, shininess.
pub(in super::super) fn phong(case: &[f64; 13]) -> Answer<1> {
    let [point, direction, normal, position] = [0, 3, 6, 9].map(|from| vector(case, from));
    let white = [1.0; 3].map(exact);
    let lamp = Lamp { position, color: white.clone() };
    let coefficients = [MATERIAL.ambient, MATERIAL.diffuse, MATERIAL.specular];
    let [brightness, ..] = shade(&point, &direction, &normal, &white, coefficients, case[12], &[lamp]);
    Answer { verdict: 0, values: [rounded(&brightness)] }
}

/// The colour of a point: ambient, and for each light on the eye's side diffuse and specular. No light: the surface's own.
///
/// # Panics
/// If the shininess is no whole number.
pub(in super::super) fn shade(
    point: &[Big; 3],
    direction: &[Big; 3],
    normal: &[Big; 3],
    surface: &[Big; 3],
    [ambient, diffuse, specular]: [f64; 3],
    shininess: f64,
    lamps: &[Lamp],
) -> [Big; 3] {
    if lamps.is_empty() {
        return surface.clone();
    }
    assert_eq!(shininess.fract(), 0.0, "powers are exact for whole exponents only");
    #[expect(clippy::cast_possible_truncation, reason = "a whole number, which a scene keeps small")]
    let exponent = IBig::from(shininess as i64);
    let [ambient, diffuse, specular] = [ambient, diffuse, specular].map(exact);
    let turned = !is_negative(&dot(direction, normal));
    let normal = unit(normal).map(|x| if turned { -x } else { x });
    let eye = unit(direction).map(|x| -x);
    let mut color = surface.each_ref().map(|c| long(&(&ambient * c)));
    for lamp in lamps {
        let towards = sub(&lamp.position, point);
        if towards.iter().all(is_zero) {
            continue;
        }
        let towards = unit(&towards);
        let cosine = dot(&towards, &normal);
        if is_negative(&cosine) || is_zero(&cosine) {
            continue;
        }
        // The light's direction, mirrored: 2 <towards|N> N - towards.
        let mirrored = [0, 1, 2].map(|i| long(&(exact(2.0) * &cosine * &normal[i] - &towards[i])));
        let alignment = dot(&eye, &mirrored);
        let power = if is_negative(&alignment) { Big::ZERO } else { long(&alignment).powi(exponent.clone()) };
        for ((sum, surface), light) in color.iter_mut().zip(surface).zip(&lamp.color) {
            *sum = long(&(&*sum + (&diffuse * &cosine * surface + &specular * &power) * light));
        }
    }
    color
}

/// A vector divided by its length, which is not zero.
fn unit(v: &[Big; 3]) -> [Big; 3] {
    let length = root(&dot(v, v));
    v.each_ref().map(|x| quotient(x, &length))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_from_straight_above_is_full() {
        let above = [0.0, 0.0, 0.0, 0.0, 0.0, -3.0, 0.0, 0.0, -0.5, 0.0, 0.0, 7.0, 9.0];
        let full = MATERIAL.ambient + MATERIAL.diffuse + MATERIAL.specular;
        assert_eq!(phong(&above).values, [full]);
        let mut below = above;
        below[11] = -7.0;
        assert_eq!(phong(&below).values, [MATERIAL.ambient]);
    }

    #[test]
    fn the_mirrored_direction_has_the_whole_highlight() {
        // The light comes at 3-4-5, the eye looks from the mirrored side.
        let case = [0.0, 0.0, 0.0, -4.0, 0.0, -3.0, 0.0, 0.0, 1.0, -4.0, 0.0, 3.0, 50.0];
        let expected = exact(MATERIAL.ambient)
            + exact(MATERIAL.diffuse) * quotient(&exact(3.0), &exact(5.0))
            + exact(MATERIAL.specular);
        assert_eq!(phong(&case).values, [rounded(&expected)]);
    }
}
