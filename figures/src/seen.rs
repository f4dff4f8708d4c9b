//! What a ray sees where it hits: the surface's place, normal and colour, ready for Phong's model, three times over.
//!
//! From doubles, which is what most pixels need; from vectors that are good to a few ulp whatever the distance; and
//! enclosed with any number of bits.

use std::cmp::Ordering;

use glam::DVec3;
use rt_geom::{Bounded, Estimate, Hit, HitPoint, Ray, Shape};
use rt_math::exact::{Ball, U, power_of_two};
use rt_shade::color::interpolate;
use rt_shade::{
    Errors, Material, PointLight, Shaded, Sides, SurfacePoint, certified, phong_with_sides, texture_uv_within,
};

use crate::objects::Objects;
use crate::scene::{DEFAULT_MATERIAL, Filter, Look, LookPlace, Paint, Scene};

/// A sphere's normal that is known no better than this in doubles is asked for again at once: far balls.
const COARSE: f64 = power_of_two(-30);
/// And a triangle's place that is known no better than this part of its size.
const COARSER: f64 = power_of_two(-20);

/// The colour of a surface before any light falls on it.
#[derive(Clone, Copy)]
enum Coloring<'a> {
    /// The same everywhere.
    Plain(DVec3),
    /// Between the vertices of a triangle.
    Vertices(&'a [DVec3; 3]),
    /// An image around a sphere.
    Image(&'a Paint),
}

/// One object that a ray has hit.
pub(crate) struct Seen<'scene, 'ray> {
    ray: &'ray Ray,
    hit: HitPoint<'ray>,
    coloring: Coloring<'scene>,
    material: &'scene Material,
}

impl<'scene, 'ray> Seen<'scene, 'ray> {
    /// What a ray sees at its hit.
    #[inline]
    pub(crate) fn new(scene: &'scene Scene, objects: &Objects, ray: &'ray Ray, Hit { index, t }: Hit) -> Self {
        let shape = objects.shape(index);
        let (coloring, material) = match index.checked_sub(scene.sphere_looks.len()) {
            None => match scene.sphere_looks[index].place() {
                LookPlace::Color(at) => (Coloring::Plain(scene.colors[at]), &DEFAULT_MATERIAL),
                LookPlace::Look(at) => of_look(&scene.looks[at]),
            },
            Some(index) => {
                let look = scene.look(scene.triangle_looks[index]).expect("a triangle has a look");
                let colors = scene.vertex_colors.get(index).and_then(Option::as_ref);
                match colors {
                    Some(colors) => (Coloring::Vertices(colors), &look.material),
                    None => of_look(look),
                }
            }
        };
        Self { ray, hit: shape.hit_point(ray, t), coloring, material }
    }

    /// The point as doubles know it.
    #[inline]
    pub(crate) fn estimated(&self) -> SurfacePoint<'scene> {
        let found = self.hit.estimate();
        let coarse = match self.hit.shape() {
            Shape::Sphere(sphere) => found.normal_error > COARSE * sphere.radius(),
            // Its normal does not depend on the point, the way to a light does: 2^-20 of the size of the triangle.
            Shape::Triangle(triangle) => found.point_error > COARSER * triangle.size(),
        };
        if coarse {
            return self.placed(&found);
        }
        let Estimate { point, point_error, normal, normal_error } = found;
        let (surface, surface_error) = match (self.coloring, self.hit.shape()) {
            (Coloring::Vertices(colors), Shape::Triangle(triangle)) => {
                let (weights, error) = triangle.estimated_weights(&found);
                mixed(colors, weights, error)
            }
            _ => self.plain_or_image(normal, normal_error),
        };
        let errors = Errors { point: point_error, normal: normal_error, surface: surface_error };
        self.point((point, DVec3::ZERO), normal, surface, errors)
    }

    /// The surface's own colour, if it is the same everywhere: all that is seen without lights.
    pub(crate) fn flat(&self) -> Option<Shaded> {
        match self.coloring {
            Coloring::Plain(color) => Some(Shaded { color, error: 0.0 }),
            _ => None,
        }
    }

    /// The colour of a point as doubles know it, with sides that are exact.
    pub(crate) fn sided(&self, point: &SurfacePoint, lights: &[PointLight]) -> Shaded {
        phong_with_sides(point, lights, self)
    }

    /// The colour from vectors that are good to a few ulp, with sides that are exact.
    pub(crate) fn refined(&self, lights: &[PointLight]) -> Shaded {
        phong_with_sides(&self.placed(&self.hit.estimate()), lights, self)
    }

    /// The point placed from a sphere's center or a triangle's first vertex, where that is better known than from the
    /// eye.
    fn placed(&self, found: &Estimate) -> SurfacePoint<'scene> {
        let (base, offset, normal) = match self.hit.shape() {
            // Its one point, which faces the ray.
            Shape::Sphere(sphere) if sphere.radius() == 0.0 => {
                let exact = |vector| Bounded { vector, error: 0.0 };
                (sphere.center(), exact(DVec3::ZERO), exact(-self.ray.direction()))
            }
            Shape::Sphere(sphere) => {
                let offset = self.hit.from_within(sphere.center(), COARSE);
                (sphere.center(), offset, offset)
            }
            Shape::Triangle(triangle) => {
                let vertex = triangle.vertices()[0];
                (vertex, self.hit.from_within(vertex, COARSE), self.hit.normal())
            }
        };
        let (surface, surface_error) = match self.coloring {
            // Each weight is correctly rounded.
            Coloring::Vertices(colors) => {
                self.hit.weights().map_or((DVec3::ZERO, f64::INFINITY), |weights| mixed(colors, weights, U))
            }
            _ => self.plain_or_image(normal.vector, normal.error),
        };
        // `phong` rounds once more where there is an offset.
        let from_base = offset.error + 2.0 * U * offset.vector.length();
        let (point, offset, point_error) = if found.point_error < from_base {
            (found.point, DVec3::ZERO, found.point_error)
        } else {
            (base, offset.vector, offset.error)
        };
        let errors = Errors { point: point_error, normal: normal.error, surface: surface_error };
        self.point((point, offset), normal.vector, surface, errors)
    }

    fn point(
        &self,
        (point, offset): (DVec3, DVec3),
        normal: DVec3,
        surface: DVec3,
        errors: Errors,
    ) -> SurfacePoint<'scene> {
        SurfacePoint {
            point,
            offset,
            direction: self.ray.direction(),
            normal,
            surface,
            material: self.material,
            errors,
        }
    }

    /// The colour of a surface with this outward normal, and a bound of its error.
    fn plain_or_image(&self, normal: DVec3, normal_error: f64) -> (DVec3, f64) {
        let paint = match self.coloring {
            Coloring::Plain(color) => return (color, 0.0),
            Coloring::Vertices(colors) => return (colors[0], f64::INFINITY),
            Coloring::Image(paint) => paint,
        };
        let Paint::Image { texture, mirrored, filter } = paint else { return (DVec3::ZERO, f64::INFINITY) };
        let (coordinates, errors) = texture_uv_within(normal, normal_error, *mirrored);
        match filter {
            Filter::Nearest => {
                texture.nearest_within(coordinates, errors).map_or((DVec3::ZERO, f64::INFINITY), |color| (color, 0.0))
            }
            Filter::Bilinear => texture.bilinear_within(coordinates, errors),
        }
    }

    /// Encloses the colour with `64 LIMBS` bits; `None` if a texel is open. Where `ties` is given, what is open is taken
    /// for equality, and counted there.
    pub(crate) fn enclosed<const LIMBS: usize>(
        &self,
        lights: &[PointLight],
        ties: Option<&mut u32>,
    ) -> Option<[Ball<LIMBS>; 3]> {
        let exact = self.hit.enclosed();
        let normal = exact.normal::<LIMBS>();
        let surface = match self.coloring {
            Coloring::Plain(color) => color.to_array().map(Ball::from_f64),
            Coloring::Vertices(colors) => {
                let weights = exact.weights::<LIMBS>()?;
                let part = |i: usize, axis: usize| weights[i] * Ball::from_f64(colors[i][axis]);
                [0, 1, 2].map(|axis| part(0, axis) + part(1, axis) + part(2, axis))
            }
            Coloring::Image(Paint::Color(color)) => color.to_array().map(Ball::from_f64),
            Coloring::Image(Paint::Image { texture, mirrored, filter }) => {
                let coordinates = certified::texture_uv(&normal, *mirrored);
                match filter {
                    Filter::Bilinear => certified::bilinear(texture, &coordinates),
                    Filter::Nearest => match (certified::nearest(texture, &coordinates, false), ties) {
                        (Some(color), _) => color,
                        (None, None) => return None,
                        (None, Some(ties)) => {
                            *ties += 1;
                            certified::nearest(texture, &coordinates, true)?
                        }
                    },
                }
            }
        };
        if lights.is_empty() {
            return Some(surface);
        }
        let faces_ray = self.hit.faces_ray();
        let (normal, above) =
            if faces_ray { (normal, Ordering::Greater) } else { (normal.map(|part| -part), Ordering::Less) };
        let shining = lights.iter().filter(|light| self.hit.side_of(light.position) == above);
        let shining = shining.map(|light| (light.color, exact.from(light.position)));
        Some(certified::phong(self.ray.direction(), &normal, &surface, self.material, shining))
    }
}

/// Exact, whatever the distance.
impl Sides for Seen<'_, '_> {
    fn faces_eye(&self) -> Option<bool> {
        Some(self.hit.faces_ray())
    }

    fn side_of(&self, light: DVec3) -> Option<Ordering> {
        Some(self.hit.side_of(light))
    }
}

fn of_look(look: &Look) -> (Coloring<'_>, &Material) {
    let coloring = match &look.paint {
        Paint::Color(color) => Coloring::Plain(*color),
        image @ Paint::Image { .. } => Coloring::Image(image),
    };
    (coloring, &look.material)
}

/// The mixture of colours by weights, of which the first has twice the error of the others, and a bound of its error.
fn mixed(colors: &[DVec3; 3], weights: [f64; 3], error: f64) -> (DVec3, f64) {
    let brightest = colors[0].max(colors[1]).max(colors[2]).max_element();
    (interpolate(colors, weights), (4.1 * error + 12.0 * U) * brightest + f64::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use oracle::{Random, cases, exact, long};

    use super::*;

    #[test]
    fn mixtures_are_within_their_bound() {
        let mut random = Random::new(1);
        let mut sharpest = 0.0f64;
        for _ in 0..cases(100_000) {
            let dark = if random.one_in(4) { random.power(-1070..0) } else { 1.0 };
            // Black and bright corners are the worst.
            let colors = [0; 3].map(|_| dark * random.pick(&[0.0, 0.3, 1.0]) * random.point().abs());
            let (beta, gamma) = (random.share(), random.share());
            let (beta, gamma) = if beta + gamma > 1.0 { (1.0 - beta, 1.0 - gamma) } else { (beta, gamma) };
            let size = random.pick(&[0.0, 1.0]) * random.power(-40..-4);
            // The second and the third weight are off by the error, the first by what is left.
            let [second, third] = [beta, gamma].map(|weight| weight + 0.999 * size * random.sign());
            let first = 1.0 - second - third;
            let (found, bound) = mixed(&colors, [first, second, third], size);
            for axis in 0..3 {
                let part = |i: usize, weight| exact(colors[i][axis]) * weight;
                let [beta, gamma] = [beta, gamma].map(exact);
                let truth = part(0, exact(1.0) - &beta - &gamma) + part(1, beta) + part(2, gamma);
                let off = long(&(exact(found[axis]) - truth)).to_f64().value().abs();
                sharpest = sharpest.max(off / bound);
                assert!(off <= bound, "{colors:?} {first} {second} {third} {size:e}: {off:e} off, bound {bound:e}");
            }
        }
        assert!(sharpest > 0.3, "{sharpest}");
        for error in [f64::NAN, f64::INFINITY] {
            let (_, bound) = mixed(&[DVec3::ZERO; 3], [1.0, 0.0, 0.0], error);
            assert!(bound.is_nan() || bound == f64::INFINITY);
        }
    }
}
