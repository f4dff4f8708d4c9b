//! Phong's light on a point, in numbers of 400 bits.

use std::cmp::Ordering;

use dashu::integer::IBig;

use crate::{Big, Vector, dot, exact, long, sign, sub, unit};

/// A light.
#[derive(Clone, Debug)]
pub struct Lamp {
    /// Where it is.
    pub position: Vector,
    /// Its colour.
    pub color: Vector,
}

/// Returns the colour of a point: ambient, and for each light on the eye's side diffuse and specular, by these three
/// coefficients. No light: the surface's own.
/// The shininess is a whole number.
#[must_use]
pub fn shade(
    point: &Vector,
    direction: &Vector,
    normal: &Vector,
    surface: &Vector,
    coefficients: [f64; 3],
    shininess: f64,
    lamps: &[Lamp],
) -> Vector {
    if lamps.is_empty() {
        return surface.clone();
    }
    assert_eq!(shininess.fract(), 0.0, "powers are exact for whole exponents only");
    #[expect(clippy::cast_possible_truncation, reason = "a whole number, which a scene keeps small")]
    let exponent = IBig::from(shininess as i64);
    let [ambient, diffuse, specular] = coefficients.map(exact);
    let turned = sign(&dot(direction, normal)) != Ordering::Less;
    let normal = unit(normal).map(|x| if turned { -x } else { x });
    let eye = unit(direction).map(|x| -x);
    let mut color = surface.each_ref().map(|c| long(&(&ambient * c)));
    for lamp in lamps {
        let towards = sub(&lamp.position, point);
        if towards.iter().all(|x| sign(x) == Ordering::Equal) {
            continue;
        }
        let towards = unit(&towards);
        let cosine = dot(&towards, &normal);
        if sign(&cosine) != Ordering::Greater {
            continue;
        }
        // The light's direction, mirrored: 2 <towards|N> N - towards.
        let mirrored = [0, 1, 2].map(|i| long(&(exact(2.0) * &cosine * &normal[i] - &towards[i])));
        let alignment = dot(&eye, &mirrored);
        let behind = sign(&alignment) == Ordering::Less;
        let power = if behind { Big::ZERO } else { long(&alignment).powi(exponent.clone()) };
        for ((sum, surface), light) in color.iter_mut().zip(surface).zip(&lamp.color) {
            *sum = long(&(&*sum + (&diffuse * &cosine * surface + &specular * &power) * light));
        }
    }
    color
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{quotient, rounded, vector};

    /// The brightness of the white origin under one white light: ambient 1, diffuse 2, specular 4.
    fn brightness(direction: [f64; 3], normal: [f64; 3], light: [f64; 3], shininess: f64) -> f64 {
        let [white, origin] = [[1.0; 3], [0.0; 3]].map(vector);
        let lamp = Lamp { position: vector(light), color: white.clone() };
        let coefficients = [1.0, 2.0, 4.0];
        rounded(&shade(&origin, &vector(direction), &vector(normal), &white, coefficients, shininess, &[lamp])[0])
    }

    #[test]
    fn light_from_straight_above_is_full() {
        assert_eq!(brightness([0.0, 0.0, -3.0], [0.0, 0.0, -0.5], [0.0, 0.0, 7.0], 9.0), 7.0);
        assert_eq!(brightness([0.0, 0.0, -3.0], [0.0, 0.0, -0.5], [0.0, 0.0, -7.0], 9.0), 1.0);
    }

    #[test]
    fn the_mirrored_direction_has_the_whole_highlight() {
        // The light comes at 3-4-5, the eye looks from the mirrored side.
        let expected = exact(5.0) + exact(2.0) * quotient(&exact(3.0), &exact(5.0));
        assert_eq!(brightness([-4.0, 0.0, -3.0], [0.0, 0.0, 1.0], [-4.0, 0.0, 3.0], 50.0), rounded(&expected));
    }
}
