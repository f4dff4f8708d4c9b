//! The exact picture: what is seen is decided by the reference, and its colour computed in 400 bits; only the lookup in
//! a texture, between exact coordinates, is in doubles.

use glam::DVec3;
use oracle::{
    Big, Crossing, Lamp, coordinates, cross, exact, long, nearest_root, point_at, rounded, shade, sub, vector,
};
use rayon::prelude::*;
use rt_geom::{Ray, Sphere};

use super::pixels::samples;
use figures::camera::{Size, View};
use figures::scene::{Filter, Paint, Scene};

/// Returns the samples of a picture.
pub(super) fn picture(scene: &Scene, view: &View) -> Vec<u8> {
    let Size { width, height, .. } = view.size();
    let lamps: Vec<Lamp> = scene
        .lights
        .iter()
        .map(|light| Lamp { position: vector(light.position), color: vector(light.color) })
        .collect();
    let pixel = |i: u32| samples(color(scene, &lamps, &view.ray(i % width, i / width)));
    (0..width * height).into_par_iter().flat_map_iter(pixel).collect()
}

/// The colour that a ray brings back.
fn color(scene: &Scene, lamps: &[Lamp], ray: &Ray) -> DVec3 {
    let (origin, direction) = (vector(ray.origin()), vector(ray.direction()));
    let Some((t, index)) = closest(scene, ray, &origin, &direction) else { return scene.background };
    let point = point_at(&origin, &direction, &t);
    let (look, normal, surface) = match scene.spheres.get(index) {
        Some(sphere) => {
            let look = scene.look(scene.sphere_looks[index]).expect("a sphere of these scenes has a look");
            let normal = sub(&point, &vector(sphere.center()));
            let surface = paint_at(&look.paint, &normal);
            (look, normal, surface)
        }
        None => {
            let index = index - scene.spheres.len();
            let look = scene.look(scene.triangle_looks[index]).expect("a triangle has a look");
            let [a, b, c] = scene.triangles[index].vertices().map(vector);
            let normal = cross(&sub(&b, &a), &sub(&c, &a));
            let surface = match scene.vertex_colors.get(index) {
                Some(Some(colors)) => {
                    let vertices = [a, b, c].map(|vertex| sub(&vertex, &origin));
                    let weights = Crossing::new(&direction, vertices).weights().expect("the triangle is hit");
                    let colors = colors.map(vector);
                    [0, 1, 2].map(|i| {
                        let parts = weights.iter().zip(&colors).map(|(weight, color)| weight * &color[i]);
                        parts.fold(Big::ZERO, |sum, part| sum + part)
                    })
                }
                _ => paint_at(&look.paint, &normal),
            };
            (look, normal, surface)
        }
    };
    let material = &look.material;
    let coefficients = [material.ambient, material.diffuse, material.specular];
    let color = shade(&point, &direction, &normal, &surface, coefficients, material.shininess, lamps);
    DVec3::from_array(color.each_ref().map(rounded))
}

/// The closest object on a ray, and its `t`.
fn closest(scene: &Scene, ray: &Ray, origin: &[Big; 3], direction: &[Big; 3]) -> Option<(Big, usize)> {
    let mut best: Option<(Big, usize)> = None;
    // Equal distances go to the lower index; distances are equal if they round to the same double.
    let mut offer = |t: Option<Big>, index| {
        let Some(t) = t else { return };
        if best.as_ref().is_none_or(|(least, _)| rounded(&t) < rounded(least)) {
            best = Some((t, index));
        }
    };
    for (index, sphere) in scene.spheres.iter().enumerate() {
        if !surely_beside(ray, sphere) {
            let offset = sub(origin, &vector(sphere.center()));
            offer(nearest_root(direction, &offset, &exact(sphere.radius())), index);
        }
    }
    for (index, triangle) in scene.triangles.iter().enumerate() {
        let vertices = triangle.vertices().map(|vertex| sub(&vector(vertex), origin));
        offer(Crossing::new(direction, vertices).t(), scene.spheres.len() + index);
    }
    best
}

/// The colour of a surface; of an image, where its outward normal is `normal`.
fn paint_at(paint: &Paint, normal: &[Big; 3]) -> [Big; 3] {
    match paint {
        Paint::Color(color) => vector(*color),
        Paint::Image { texture, mirrored, filter } => {
            let [x, y, z] = normal.clone();
            let place = [x, y, if *mirrored { z } else { -z }].map(|c| long(&c));
            let [u, v] = coordinates(&place, [0, 1, 2].map(|i| place[i] < Big::ZERO));
            vector(match filter {
                Filter::Nearest => texture.nearest(rounded(&u), rounded(&v)),
                Filter::Bilinear => texture.bilinear(rounded(&u), rounded(&v)),
            })
        }
    }
}

/// Whether a ray passes far beside a sphere: the distance of center and line, in doubles, is above the radius by more
/// than a millionth of all lengths involved. Rounding does not move it by a billionth; so what is nearer is left to
/// exact numbers.
fn surely_beside(ray: &Ray, sphere: &Sphere) -> bool {
    let (d, w) = (ray.direction(), ray.origin() - sphere.center());
    let middle = w.dot(d) / d.length_squared();
    let distance = (w - middle * d).length();
    distance > sphere.radius() + 1e-6 * (ray.origin().length() + sphere.center().length() + sphere.radius())
}
