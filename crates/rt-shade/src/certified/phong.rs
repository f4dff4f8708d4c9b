//! Phong's light, as `phong` of this crate rounds it.
//!
//! ```text
//! <-L|N> / |L||N|                                       the cosine of the diffuse term
//! -(<D|L> - 2 <L|N> <D|N> / <N|N>) / |D||L|             the base of the highlight
//! ```
//!
//! so that no vector is normalised, and each light takes two roots.

use glam::DVec3;
use rt_math::exact::{Ball, vector};

use super::power;
use crate::Material;

/// Returns the colour of a point, unclamped: the ambient term, and for each of the lights that shine on it the diffuse
/// and the specular one.
///
/// `direction` leads from the eye to the point and `normal` is on the eye's side; of each light there is its colour and
/// the vector from the light to the point, on the other side of the surface than `normal`. None of them is zero; all may
/// have any length. A scene without lights is flat, which is the caller's to know. A coefficient of 0 leaves its term
/// out.
///
/// ```
/// use glam::DVec3;
/// use rt_math::exact::Ball;
/// use rt_shade::{Material, certified};
///
/// let [surface, normal, light] = [[1, 0, 0], [0, 0, 7], [0, 0, -3]].map(|v| v.map(Ball::<2>::from_integer));
/// let material = Material { ambient: 0.25, diffuse: 0.5, specular: 1.0, shininess: 32.5 };
/// let shining = [(DVec3::ONE, light)].into_iter();
/// let color = certified::phong(DVec3::NEG_Z, &normal, &surface, &material, shining);
/// assert_eq!(color.map(|c| c.ends()), [1.75, 1.0, 1.0].map(|c| (c, c)));
/// ```
#[must_use]
pub fn phong<const LIMBS: usize>(
    direction: DVec3,
    normal: &[Ball<LIMBS>; 3],
    surface: &[Ball<LIMBS>; 3],
    material: &Material,
    shining: impl Iterator<Item = (DVec3, [Ball<LIMBS>; 3])>,
) -> [Ball<LIMBS>; 3] {
    let [ambient, diffuse, specular] = [material.ambient, material.diffuse, material.specular].map(Ball::from_f64);
    let direction = direction.to_array().map(Ball::from_f64);
    let normal_squared: Ball<LIMBS> = vector::dot(normal, normal);
    let direction_squared: Ball<LIMBS> = vector::dot(&direction, &direction);
    let against: Ball<LIMBS> = vector::dot(&direction, normal);

    let mut color = surface.map(|c| ambient * c);
    for (light, incident) in shining {
        let light = light.to_array().map(Ball::from_f64);
        let incident_squared: Ball<LIMBS> = vector::dot(&incident, &incident);
        let facing: Ball<LIMBS> = vector::dot(&incident, normal);
        if material.diffuse != 0.0 {
            let cosine = (-facing / (incident_squared * normal_squared).sqrt()).clamp();
            for ((sum, surface), light) in color.iter_mut().zip(surface).zip(&light) {
                *sum = *sum + diffuse * cosine * surface * light;
            }
        }
        if material.specular != 0.0 {
            let straight: Ball<LIMBS> = vector::dot(&direction, &incident);
            let mirrored = (facing * against).scale(1) / normal_squared - straight;
            let alignment = mirrored / (direction_squared * incident_squared).sqrt();
            let highlight = specular * power(&alignment, material.shininess);
            for (sum, light) in color.iter_mut().zip(&light) {
                *sum = *sum + highlight * light;
            }
        }
    }
    color
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::certified::truth::{assert_encloses, but_for};
    use oracle::{Lamp, Random, exact, scale_point};

    /// Bits that a colour may lose: those of a power.
    const LOST: i32 = 24;

    fn colors_are_enclosed<const LIMBS: usize>(cases: usize) {
        let mut rng = Random::new(LIMBS as u64);
        let mut lit = 0;
        for _ in 0..cases {
            let [point, surface] = [0; 2].map(|_| DVec3::new(rng.share(), rng.share(), rng.share()));
            let direction = rng.direction() * rng.power(-40..40);
            let normal = {
                let normal = rng.direction() * rng.power(-40..40);
                if normal.dot(direction) > 0.0 { -normal } else { normal }
            };
            let shininess = rng.whole(1, 1000);
            let material = Material {
                ambient: rng.share(),
                diffuse: rng.pick(&[0.0, 0.5, 0.9]),
                specular: rng.pick(&[0.0, 0.5, 0.9]),
                shininess,
            };
            let lights: Vec<_> = (0..rng.below(3) + 1)
                .map(|_| {
                    // Half of them near the mirrored view.
                    let mirrored = direction.normalize()
                        - 2.0 * direction.normalize().dot(normal.normalize()) * normal.normalize();
                    let towards = if rng.one_in(2) { rng.direction() } else { mirrored + 0.05 * rng.direction() };
                    (point + towards * rng.power(-3..20), DVec3::new(rng.share(), rng.share(), rng.share()))
                })
                .collect();
            let shining: Vec<_> = lights
                .iter()
                .map(|&(position, color)| (color, vector::difference::<Ball<LIMBS>>(point, position)))
                .filter(|(_, incident)| {
                    let facing: Ball<LIMBS> = vector::dot(incident, &normal.to_array().map(Ball::from_f64));
                    facing.sign() == Some(std::cmp::Ordering::Less)
                })
                .collect();
            lit += shining.len();
            let [normal_ball, surface_ball] = [normal, surface].map(|v| v.to_array().map(Ball::<LIMBS>::from_f64));
            let found = phong(direction, &normal_ball, &surface_ball, &material, shining.into_iter());
            let lamps: Vec<_> = lights
                .iter()
                .map(|&(position, color)| Lamp { position: oracle::vector(position), color: oracle::vector(color) })
                .collect();
            let coefficients = [material.ambient, material.diffuse, material.specular];
            let [point, direction, normal, surface] = [point, direction, normal, surface].map(oracle::vector);
            let truth = oracle::shade(&point, &direction, &normal, &surface, coefficients, shininess, &lamps);
            for (found, truth) in found.iter().zip(&truth) {
                // The reference has 400 bits, of which a power may lose ten.
                let dust = Ball::ONE.scale(-380);
                let width = but_for::<LIMBS>(LOST, &exact(4.0)) + oracle::power_of_two(-378);
                assert_encloses(&found.widen(&dust), truth, &width);
            }
        }
        assert!(lit > cases / 3, "{lit}");
    }

    #[test]
    fn colors_are_enclosed_at_any_precision() {
        colors_are_enclosed::<1>(300);
        colors_are_enclosed::<2>(300);
        colors_are_enclosed::<4>(300);
        colors_are_enclosed::<32>(50);
    }

    #[test]
    fn more_limbs_give_a_ball_within_for_any_shininess() {
        fn shade<const LIMBS: usize>(shininess: f64) -> Ball<LIMBS> {
            let [normal, surface] =
                [DVec3::new(0.1, 0.2, 0.9), DVec3::splat(0.3)].map(|v| v.to_array().map(Ball::from_f64));
            let material = Material { ambient: 0.1, diffuse: 0.3, specular: 0.7, shininess };
            let incident = vector::difference(DVec3::ZERO, DVec3::new(0.1, 0.5, 2.0));
            phong(DVec3::new(0.3, 0.1, -1.0), &normal, &surface, &material, [(DVec3::ONE, incident)].into_iter())[0]
        }
        for shininess in [0.5, 1.0, 7.25, 1000.5, 1e4 + 0.1, 1e-3] {
            let [two, eight] = [shade::<2>(shininess).with_limbs(), shade::<8>(shininess).with_limbs::<32>()];
            let most = shade::<32>(shininess);
            for (found, lost) in [(two, 64 * 30), (eight, 64 * 24)] {
                let (lower, upper) = crate::certified::truth::big(&most);
                assert_encloses(&found, &lower, &but_for::<32>(lost + LOST, &lower));
                assert_encloses(&found, &upper, &but_for::<32>(lost + LOST, &lower));
            }
            let (lower, upper) = crate::certified::truth::big(&most);
            assert!(upper - &lower <= but_for::<32>(LOST, &lower));
        }
    }

    #[test]
    fn a_coefficient_of_zero_leaves_its_term_out() {
        let [normal, surface] = [DVec3::Z, DVec3::splat(0.5)].map(|v| v.to_array().map(Ball::<2>::from_f64));
        let material = Material { ambient: 0.5, diffuse: 0.0, specular: 0.0, shininess: f64::NAN };
        let unknown = [(DVec3::ONE, [Ball::UNKNOWN; 3])].into_iter();
        let color = phong(scale_point(DVec3::NEG_Z, 3), &normal, &surface, &material, unknown);
        assert_eq!(color.map(|c| c.ends()), [(0.25, 0.25); 3]);
    }
}
