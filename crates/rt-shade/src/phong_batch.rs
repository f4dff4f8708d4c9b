//! Phong's model for many points at once.
//!
//! Points go through the formulas of [`phong`] in groups of [`LANES`], operation by operation, without a branch, so
//! that the compiler makes vector instructions of them. Every operation rounds as the same one in [`phong`] does, and
//! so the bits are the same. What is out of the ordinary in a point (a length beyond 1e±100, an odd shininess) makes
//! its colour NaN on the way, a side that rounding leaves open makes its error infinite; then [`phong`] itself answers,
//! unless the vectors are not exact, and the side stays open.

use fearless_simd::Level;
use glam::DVec3;
use rt_math::exact::U;

use crate::phong::{
    INCIDENT_ERROR, PointLight, Shaded, SurfacePoint, UNDERFLOW, UNIT_ERROR, alignment, alignment_error, brightest,
    cosine_error, diffuse_error, norm, ordinary_unit, phong, power_error, relative, slope, sum_rounding,
};
use crate::power::ordinary_power;

/// Points that go together.
const LANES: usize = 8;

/// Writes the colour of each point in the light of `lights`: bit for bit what [`phong`] returns, except that a NaN may
/// have other bits, and that the bound of the error may be the larger one where no light shines.
///
/// # Panics
/// If the slices differ in length.
///
/// ```
/// use glam::DVec3;
/// use rt_shade::{Material, PointLight, SurfacePoint, phong, phong_batch};
///
/// let material = &Material { ambient: 0.25, diffuse: 0.5, specular: 1.0, shininess: 32.0 };
/// let lamp = PointLight { position: DVec3::new(0.0, 0.0, 3.0), color: DVec3::ONE };
/// let points = [DVec3::ZERO, DVec3::X, 4.0 * DVec3::Z]
///     .map(|point| SurfacePoint::new(point, DVec3::NEG_Z, DVec3::Z, DVec3::X, material));
/// let mut colors = [phong(&points[0], &[]); 3];
/// phong_batch(&points, &[lamp], &mut colors);
/// assert_eq!(colors.map(|shaded| shaded.color), points.map(|point| phong(&point, &[lamp]).color));
/// ```
pub fn phong_batch(points: &[SurfacePoint], lights: &[PointLight], colors: &mut [Shaded]) {
    assert_eq!(points.len(), colors.len(), "one place for the colour of each point");
    shade_at(Level::new(), points, lights, colors);
}

/// [`phong_batch`] with the instructions of a given level; the bits do not depend on it.
fn shade_at(level: Level, points: &[SurfacePoint], lights: &[PointLight], colors: &mut [Shaded]) {
    // Compiles the kernel once for each of these levels of x86; elsewhere vector instructions are always there, or
    // never.
    #[cfg(target_arch = "x86_64")]
    macro_rules! compiled_for {
        ($($as_level:ident)*) => {
            $(if let Some(simd) = level.$as_level() {
                return fearless_simd::Simd::vectorize(
                    simd,
                    #[inline(always)]
                    || kernel(points, lights, colors),
                );
            })*
        };
    }
    #[cfg(target_arch = "x86_64")]
    compiled_for!(as_avx512 as_avx2);
    let _ = level;
    kernel(points, lights, colors);
}

/// A number of each point of a group.
type EachPoint = [f64; LANES];

/// A vector of each point of a group.
#[derive(Clone, Copy)]
struct Vectors([EachPoint; 3]);

impl Vectors {
    #[inline(always)]
    fn new(vector: impl Fn(usize) -> DVec3) -> Self {
        let mut lanes = Self([[0.0; LANES]; 3]);
        for i in 0..LANES {
            lanes.set(i, vector(i));
        }
        lanes
    }

    #[inline(always)]
    fn at(&self, i: usize) -> DVec3 {
        DVec3::new(self.0[0][i], self.0[1][i], self.0[2][i])
    }

    #[inline(always)]
    fn set(&mut self, i: usize, vector: DVec3) {
        [self.0[0][i], self.0[1][i], self.0[2][i]] = vector.to_array();
    }
}

#[inline(always)]
fn kernel(points: &[SurfacePoint], lights: &[PointLight], colors: &mut [Shaded]) {
    for (points, colors) in points.chunks(LANES).zip(colors.chunks_mut(LANES)) {
        let (shaded, errors) = group(points, lights);
        for (i, (seen, color)) in points.iter().zip(colors).enumerate() {
            *color = Shaded { color: shaded.at(i), error: errors[i] };
            // An exact normal decides the eye's side where rounding leaves it open, and with an exact point a light's.
            let open = !color.is_known() && seen.errors.normal == 0.0;
            if open || color.color.is_nan() || lights.is_empty() {
                *color = phong(seen, lights);
            }
        }
    }
}

/// The colours of up to [`LANES`] points, at least one, and bounds of their errors: a colour that is NaN has to come from
/// [`phong`] itself, and an error that is infinite or NaN says that a side is open.
///
/// One function, since the compiler makes better code of arrays that are local: as methods of a structure with these
/// arrays the steps took a quarter more time.
#[expect(clippy::needless_range_loop, reason = "a loop over lanes reads and writes many arrays alike")]
#[inline(always)]
fn group(points: &[SurfacePoint], lights: &[PointLight]) -> (Vectors, EachPoint) {
    // Gather. The last lanes of a small group repeat its last point.
    let seen = |i: usize| &points[i.min(points.len() - 1)];
    let number = |number: fn(&SurfacePoint) -> f64| -> EachPoint {
        let mut lanes = [0.0; LANES];
        for i in 0..LANES {
            lanes[i] = number(seen(i));
        }
        lanes
    };
    let point = Vectors::new(|i| seen(i).point);
    let offset = Vectors::new(|i| seen(i).offset);
    let given_direction = Vectors::new(|i| seen(i).direction);
    let given_normal = Vectors::new(|i| seen(i).normal);
    let surface = Vectors::new(|i| seen(i).surface);
    let ambient = number(|seen| seen.material.ambient);
    let diffuse = number(|seen| seen.material.diffuse);
    let specular = number(|seen| seen.material.specular);
    let shininess = number(|seen| seen.material.shininess);
    let mut point_error = number(|seen| seen.errors.point);
    let mut normal_error = number(|seen| seen.errors.normal);
    let surface_error = number(|seen| seen.errors.surface);

    // Unit vectors, the side of the eye, and the ambient term.
    let mut direction = given_direction;
    let mut normal = given_normal;
    let mut color = surface;
    let [mut brightest_surface, mut errors] = [[0.0; LANES]; 2];
    for i in 0..LANES {
        let (value, error) = slope(given_direction.at(i), given_normal.at(i), normal_error[i]);
        let (unit_direction, ordinary) = ordinary_unit(given_direction.at(i));
        let (unit_normal, also_ordinary) = ordinary_unit(given_normal.at(i));
        let turn = if value > 0.0 { -1.0 } else { 1.0 };
        let turn = if ordinary & also_ordinary { turn } else { f64::NAN };
        errors[i] = if value.abs() > error { 0.0 } else { f64::INFINITY };
        direction.set(i, unit_direction.vector);
        normal.set(i, turn * unit_normal.vector);
        color.set(i, ambient[i] * surface.at(i));
        normal_error[i] = relative(normal_error[i], unit_normal.inverse) + UNIT_ERROR;
        point_error[i] += 1.01 * U * norm(offset.at(i));
        brightest_surface[i] = brightest(surface.at(i));
    }
    // The other two terms, light by light: angles, powers, errors, colours.
    for light in lights {
        let brightest_light = brightest(light.color);
        let [mut cosine, mut aligned, mut scattered, mut mirrored] = [[0.0; LANES]; 4];
        let [mut powers, mut cosine_errors, mut alignment_errors] = [[0.0; LANES]; 3];
        for i in 0..LANES {
            let (incident, ordinary) = ordinary_unit(point.at(i) - light.position + offset.at(i));
            let incident_error = relative(point_error[i], incident.inverse) + INCIDENT_ERROR;
            cosine[i] = (-incident.vector).dot(normal.at(i));
            aligned[i] = alignment(direction.at(i), incident.vector, normal.at(i), cosine[i]);
            cosine_errors[i] = cosine_error(incident_error, normal_error[i]);
            alignment_errors[i] = alignment_error(incident_error, normal_error[i]);
            cosine[i] = if ordinary { cosine[i] } else { f64::NAN };
        }
        for i in 0..LANES {
            powers[i] = ordinary_power(clamp_but_nan(aligned[i]), shininess[i]);
            scattered[i] = diffuse[i] * if cosine[i] > 1.0 { 1.0 } else { cosine[i] };
            mirrored[i] = specular[i] * powers[i];
        }
        for i in 0..LANES {
            let matt = diffuse_error(brightest_surface[i], surface_error[i], cosine_errors[i]);
            let matt = diffuse[i] * brightest_light * matt;
            let shiny = power_error(aligned[i], alignment_errors[i], powers[i], shininess[i]);
            let shiny = matt + specular[i] * brightest_light * shiny;
            let lit = if specular[i] == 0.0 { matt } else { shiny };
            let lit = if cosine[i] <= 0.0 { 0.0 } else { lit };
            // On which side the light is, must be beyond the error.
            errors[i] += if cosine[i].abs() > cosine_errors[i] { lit } else { f64::INFINITY };
        }
        for axis in 0..3 {
            for i in 0..LANES {
                let below = color.0[axis][i];
                let matt = below + scattered[i] * surface.0[axis][i] * light.color[axis];
                let shiny = matt + mirrored[i] * light.color[axis];
                let lit = if specular[i] == 0.0 { matt } else { shiny };
                // As in `phong`, except that NaN passes the comparison and stays.
                color.0[axis][i] = if cosine[i] <= 0.0 { below } else { lit };
            }
        }
    }
    // What rounding adds.
    for i in 0..LANES {
        let rounding = sum_rounding(lights.len()) * brightest(color.at(i)) + UNDERFLOW;
        errors[i] = 1.01 * (errors[i] + rounding + ambient[i] * surface_error[i]);
    }
    (color, errors)
}

/// Brings a number into `0..=1`, but leaves NaN.
#[inline(always)]
fn clamp_but_nan(x: f64) -> f64 {
    let x = if x < 0.0 { 0.0 } else { x };
    if x > 1.0 { 1.0 } else { x }
}

#[cfg(test)]
mod tests {
    use fearless_simd::Fallback;
    use proptest::prelude::*;

    use super::*;
    use crate::phong::{Errors, Material};

    /// A point as plain data.
    #[derive(Clone, Debug)]
    struct Case {
        vectors: [DVec3; 4],
        offset: DVec3,
        errors: Errors,
        material: Material,
    }

    impl Case {
        fn seen(&self) -> SurfacePoint<'_> {
            let [point, direction, normal, surface] = self.vectors;
            let exact = SurfacePoint::new(point, direction, normal, surface, &self.material);
            SurfacePoint { offset: self.offset, errors: self.errors, ..exact }
        }
    }

    /// To be overwritten.
    const NOTHING: Shaded = Shaded { color: DVec3::NAN, error: f64::NAN };

    fn ordinary() -> BoxedStrategy<f64> {
        (-1.0f64..1.0).boxed()
    }

    /// Mostly ordinary numbers, with every kind of other among them.
    fn any_number() -> BoxedStrategy<f64> {
        let special = vec![0.0, -0.0, 1.0, 1e-200, 1e-310, 1e120, f64::MAX, f64::INFINITY, f64::NAN];
        prop_oneof![8 => ordinary(), 1 => prop::sample::select(special), 1 => any::<u64>().prop_map(f64::from_bits)]
            .boxed()
    }

    fn vector(number: BoxedStrategy<f64>) -> impl Strategy<Value = DVec3> {
        prop::array::uniform3(number).prop_map(DVec3::from_array)
    }

    fn case(number: BoxedStrategy<f64>) -> impl Strategy<Value = Case> {
        let vectors = prop::array::uniform4(vector(number.clone()));
        let shininess = prop_oneof![2 => 1.0f64..100.0, 1 => number.clone(), 1 => Just(5e5)];
        let specular = prop_oneof![3 => number.clone(), 1 => Just(0.0)];
        let within = prop_oneof![Just(0.0), 0.0..1e-14, Just(1e-3), Just(f64::INFINITY)];
        let errors = (within.clone(), within.clone(), within).prop_map(|(point, normal, surface)| Errors {
            point,
            normal,
            surface,
        });
        let offset = prop_oneof![Just(DVec3::ZERO), vector(number.clone())];
        (vectors, offset, errors, (number.clone(), number, specular, shininess)).prop_map(
            |(vectors, offset, errors, (ambient, diffuse, specular, shininess))| Case {
                vectors,
                offset,
                errors,
                material: Material { ambient, diffuse, specular, shininess },
            },
        )
    }

    fn light(number: BoxedStrategy<f64>) -> impl Strategy<Value = PointLight> {
        let sides = vector(number.clone());
        (sides, vector(number)).prop_map(|(position, color)| PointLight { position: 4.0 * position, color })
    }

    /// The instruction sets that this processor has.
    fn levels() -> Vec<Level> {
        let best = Level::new();
        #[cfg(target_arch = "x86_64")]
        let more = [best.as_avx2().map(Level::Avx2), best.as_avx512().map(Level::Avx512)];
        #[cfg(not(target_arch = "x86_64"))]
        let more = [None];
        [Some(Level::Fallback(Fallback::new())), Some(best)].into_iter().chain(more).flatten().collect()
    }

    fn check(cases: &[Case], lights: &[PointLight]) -> Result<(), TestCaseError> {
        let points: Vec<_> = cases.iter().map(Case::seen).collect();
        let bits = |color: DVec3| color.to_array().map(|c| if c.is_nan() { None } else { Some(c.to_bits()) });
        for level in levels() {
            let mut colors = vec![NOTHING; points.len()];
            shade_at(level, &points, lights, &mut colors);
            for (point, shaded) in points.iter().zip(&colors) {
                let alone = phong(point, lights);
                let (color, error) = (bits(shaded.color), shaded.error);
                prop_assert_eq!(color, bits(alone.color), "{:?} gave {:?} instead of {:?}", point, shaded, alone);
                // Of negative colours the bound says nothing.
                let Material { ambient, diffuse, specular, .. } = *point.material;
                let least = lights.iter().map(|light| light.color).fold(point.surface, DVec3::min).min_element();
                let positive = least.min(ambient).min(diffuse).min(specular) >= 0.0;
                prop_assert!(
                    !(positive && error < alone.error),
                    "{:?} gave {:?} instead of {:?}",
                    point,
                    shaded,
                    alone
                );
            }
        }
        Ok(())
    }

    proptest! {
        #[test]
        fn together_points_have_the_bits_that_they_have_alone(
            cases in prop::collection::vec(case(ordinary()), 0..20),
            lights in prop::collection::vec(light(ordinary()), 0..4),
        ) {
            check(&cases, &lights)?;
        }

        #[test]
        fn odd_numbers_disturb_no_neighbour(
            cases in prop::collection::vec(case(any_number()), 1..20),
            lights in prop::collection::vec(light(any_number()), 0..4),
        ) {
            check(&cases, &lights)?;
        }

        #[test]
        fn grazing_views_and_highlights_have_their_bits(
            cases in prop::collection::vec((case(ordinary()), 0..4), 1..10),
            lamp in light(ordinary()),
        ) {
            let cases: Vec<Case> = cases
                .into_iter()
                .map(|(mut case, kind)| {
                    let [point, direction, normal, _] = case.vectors;
                    let z = -(direction.x * normal.x + direction.y * normal.y) / normal.z;
                    case.vectors[1] = match kind {
                        0 => DVec3 { z, ..direction }, // from the side, within rounding
                        1 => rt_math::reflect(point - lamp.position, normal), // the light mirrored into the eye
                        2 => point - lamp.position, // the light behind the eye
                        _ => DVec3::new(normal.y, -normal.x, 0.0), // from the side, exactly
                    };
                    case
                })
                .collect();
            check(&cases, &[lamp])?;
        }
    }

    #[test]
    fn ordinary_points_are_shaded_together() {
        let material = Material { ambient: 0.1, diffuse: 0.6, specular: 0.3, shininess: 32.0 };
        let lights = [PointLight { position: DVec3::new(3.0, 4.0, 5.0), color: DVec3::ONE }; 2];
        let mut random = oracle::Random::new(7);
        for _ in 0..1000 {
            let cases = [0; LANES].map(|_| Case {
                vectors: [0; 4].map(|_| random.point()),
                offset: random.point(),
                errors: Errors { point: 1e-14, normal: 1e-14, surface: 1e-14 },
                material,
            });
            let points = cases.each_ref().map(Case::seen);
            let (shaded, errors) = group(&points, &lights);
            let known = |i: usize| !shaded.at(i).is_nan() && errors[i] < 1e-9;
            assert!((0..LANES).all(known), "{points:?} {errors:?}");
        }
    }

    #[test]
    fn what_rounding_leaves_open_is_left_to_phong() {
        let material = &Material { ambient: 0.1, diffuse: 0.6, specular: 0.3, shininess: 32.0 };
        let lights = [PointLight { position: DVec3::X, color: DVec3::ONE }];
        let seen = |direction, normal| SurfacePoint::new(DVec3::ZERO, direction, normal, DVec3::ONE, material);
        let points = [
            seen(DVec3::new(-1.0, 1.0, 1e-17), DVec3::ONE),  // from which side?
            seen(DVec3::NEG_Y, DVec3::new(1e-17, 1.0, 0.0)), // is the light above?
            seen(DVec3::new(-1.0, 1.0, 0.1), DVec3::ONE),
        ];
        let (_, errors) = group(&points, &lights);
        assert_eq!([0, 1, 2].map(|i| errors[i] < f64::INFINITY), [false, false, true]);
        let mut colors = [NOTHING; 3];
        phong_batch(&points, &lights, &mut colors);
        assert_eq!(colors.map(|shaded| shaded.color), points.map(|point| phong(&point, &lights).color));
    }

    #[test]
    fn an_exact_normal_decides_the_eyes_side_beside_a_point_that_is_not_exact() {
        let material = &Material { ambient: 0.1, diffuse: 0.6, specular: 0.3, shininess: 32.0 };
        let mut random = oracle::Random::new(8);
        let mut decided = 0;
        for _ in 0..10_000 {
            let (normal, x, y) = (random.point(), random.uniform(), random.uniform());
            // From the side, within rounding.
            let direction = DVec3::new(x, y, -(x * normal.x + y * normal.y) / normal.z);
            let exact = SurfacePoint::new(DVec3::ZERO, direction, normal, DVec3::ONE, material);
            let seen = SurfacePoint { errors: Errors { point: 1e-16, ..Errors::default() }, ..exact };
            let lights = [PointLight { position: random.sign() * normal, color: DVec3::ONE }];
            let mut colors = [NOTHING];
            phong_batch(&[seen], &lights, &mut colors);
            let alone = phong(&seen, &lights);
            assert_eq!(colors[0].color, alone.color, "{seen:?}");
            decided += usize::from(colors[0].error < f64::INFINITY);
        }
        assert!(decided > 9_000, "{decided}");
    }

    #[test]
    #[should_panic(expected = "one place for the colour of each point")]
    fn a_missing_place_is_refused() {
        phong_batch(&[], &[], &mut [NOTHING]);
    }
}
