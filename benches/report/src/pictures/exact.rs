//! The exact picture: what is seen is decided by the reference; its colour, texels and bytes too, are numbers of 400
//! bits.
//!
//! That leaves 250 bits behind the point in the scenes at hand, whose lengths differ by less than `2^80`. What differs
//! from equality by less than [`tie`] is taken for it: a light in the plane of a surface, a coordinate at the border of
//! a texel, a colour between two bytes.

use glam::DVec3;
use oracle::{
    Big, Crossing, Lamp, Vector, coordinates, cross, dot, exact, long, nearest_root, point_at, rounded, shade, sub,
    unit, vector,
};
use rayon::prelude::*;
use rt_geom::{Ray, Sphere};
use rt_shade::Texture;

use crate::reference::{byte, floor, tie};
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
    let pixel = |i: u32| color(scene, &lamps, &view.ray(i % width, i / width)).each_ref().map(byte);
    (0..width * height).into_par_iter().flat_map_iter(pixel).collect()
}

/// The colour that a ray brings back.
fn color(scene: &Scene, lamps: &[Lamp], ray: &Ray) -> Vector {
    let (origin, direction) = (vector(ray.origin()), vector(ray.direction()));
    let Some((t, index)) = closest(scene, ray, &origin, &direction) else { return vector(scene.background) };
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
    if lamps.is_empty() {
        return surface;
    }
    let out_of_plane: Vec<Lamp> = lamps.iter().filter(|lamp| !is_in_plane(lamp, &point, &normal)).cloned().collect();
    // Without a light the colour would be flat.
    let dark = Lamp { position: sub(&point, &direction), color: vector(DVec3::ZERO) };
    let lamps = if out_of_plane.is_empty() { vec![dark] } else { out_of_plane };
    shade(&point, &direction, &normal, &surface, coefficients, material.shininess, &lamps)
}

/// Whether a lamp lies in the plane that touches the surface, and so does not shine on it.
fn is_in_plane(lamp: &Lamp, point: &Vector, normal: &Vector) -> bool {
    let towards = sub(&lamp.position, point);
    let is_there = towards.iter().all(|x| *x == Big::ZERO);
    is_there || {
        let cosine = dot(&unit(&towards), &unit(normal));
        cosine < tie() && cosine > -tie()
    }
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
            match filter {
                Filter::Nearest => {
                    let [width, height] = size(texture);
                    vector(texel(texture, floor(&(u * exact(width))), floor(&(v * exact(height)))))
                }
                Filter::Bilinear => bilinear(texture, &u, &v),
            }
        }
    }
}

/// Columns and rows.
fn size(texture: &Texture) -> [f64; 2] {
    [texture.width(), texture.height()].map(|side| side as f64)
}

/// The colour of a texel; columns wrap around, rows end.
fn texel(texture: &Texture, column: i64, row: i64) -> DVec3 {
    let [width, height] = size(texture);
    let [column, row] = [(column as f64).rem_euclid(width), (row as f64).clamp(0.0, height - 1.0)];
    texture.nearest((column + 0.5) / width, (row + 0.5) / height)
}

/// The mixture of the four texels around a point by its distances from their centers.
fn bilinear(texture: &Texture, u: &Big, v: &Big) -> Vector {
    let [width, height] = size(texture).map(exact);
    let (x, y) = (u * width - exact(0.5), v * height - exact(0.5));
    let (column, row) = (floor(&x), floor(&y));
    let (across, down) = (x - exact(column as f64), y - exact(row as f64));
    let mixed = |a: &Vector, b: &Vector, share: &Big| [0, 1, 2].map(|i| &a[i] + (&b[i] - &a[i]) * share);
    let [upper, lower] = [row, row + 1].map(|row| {
        let [left, right] = [column, column + 1].map(|column| vector(texel(texture, column, row)));
        mixed(&left, &right, &across)
    });
    mixed(&upper, &lower, &down)
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
