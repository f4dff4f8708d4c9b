//! Scenes that are hard to draw right to the last byte, by families: balls that are far, grounds that are huge, scenes
//! that stand far from the origin, light that grazes, textures where their coordinates are hard to tell.
//!
//! Each is lit and shaded as a picture would be; nothing in them is special but the numbers.

use figures::camera::Camera;
use figures::scene::{Filter, Look, LookIndex, Paint, Scene};
use glam::DVec3;
use rt_geom::{Sphere, Triangle};
use rt_shade::{Material, PointLight, Texture};

/// A scene by name, made anew at each call.
pub(super) struct Made {
    pub(super) name: String,
    pub(super) scene: Box<dyn Fn() -> Scene>,
    /// Whether its pictures are kept.
    pub(super) shown: bool,
}

/// Distances of the far ball.
const DISTANCES: [f64; 6] = [1e3, 1e6, 1e9, 1e12, 1e15, 1e18];
/// Radii of the ground.
const GROUNDS: [f64; 4] = [1e6, 1e10, 1e16, 1e22];
/// How far from the origin a scene stands.
const OFFSETS: [f64; 3] = [1e6, 1e10, 1e14];
/// The far ball whose pictures are kept.
const SHOWN: f64 = 1e15;

/// All scenes, from easy to hard in each family.
pub(super) fn certified() -> Vec<Made> {
    let made = |name: String, scene: Box<dyn Fn() -> Scene>| {
        let shown = name == shown();
        Made { name, scene, shown }
    };
    let mut all = Vec::new();
    for distance in DISTANCES {
        all.push(made(far_ball(distance), Box::new(move || ball(distance, None))));
    }
    for radius in GROUNDS {
        all.push(made(format!("ground of radius {radius:e}"), Box::new(move || ground(radius))));
    }
    for offset in OFFSETS {
        all.push(made(format!("scene at {offset:e}"), Box::new(move || elsewhere(offset))));
    }
    all.push(made("light in the plane".to_owned(), Box::new(|| plane(2.0))));
    all.push(made("light one double above it".to_owned(), Box::new(|| plane(2f64.next_up()))));
    for (filter, reading) in [(Filter::Nearest, "nearest"), (Filter::Bilinear, "bilinear")] {
        all.push(made(format!("texture, seam, {reading}"), Box::new(move || close(DVec3::NEG_X, filter))));
        all.push(made(format!("texture, pole, {reading}"), Box::new(move || close(DVec3::Y, filter))));
        all.push(made(format!("texture, far, {reading}"), Box::new(move || ball(1e12, Some(filter)))));
    }
    all
}

/// The scene whose pictures are kept.
pub(super) fn shown() -> String {
    far_ball(SHOWN)
}

fn far_ball(distance: f64) -> String {
    format!("ball at {distance:e}")
}

const MATERIAL: Material = Material { ambient: 0.1, diffuse: 0.7, specular: 0.3, shininess: 20.0 };
const BACKGROUND: DVec3 = DVec3::new(0.05, 0.06, 0.08);
const ORANGE: DVec3 = DVec3::new(0.9, 0.6, 0.25);
const BLUE: DVec3 = DVec3::new(0.25, 0.4, 0.75);
const GREY: DVec3 = DVec3::new(0.6, 0.6, 0.55);

/// An empty scene seen from `eye`, `fov` degrees high.
fn seen(eye: DVec3, look_at: DVec3, up: DVec3, fov: f64) -> Scene {
    let camera = Camera::new(eye, look_at, up, fov).expect("two points that differ");
    Scene { camera, background: BACKGROUND, ..Scene::default() }
}

fn look(scene: &mut Scene, paint: Paint) -> LookIndex {
    scene.add_look(Look { paint, material: MATERIAL }).expect("there are few looks")
}

fn add_ball(scene: &mut Scene, center: DVec3, radius: f64, paint: Paint) {
    scene.spheres.push(Sphere::new(center, radius).expect("a radius above 0"));
    let look = look(scene, paint);
    scene.sphere_looks.push(look);
}

fn add_light(scene: &mut Scene, position: DVec3, color: DVec3) {
    scene.lights.push(PointLight { position, color });
}

/// The degrees that a height takes up at a distance, if it is far.
fn degrees(height: f64, distance: f64) -> f64 {
    (height / distance).to_degrees()
}

/// A ball of radius 1 that fills the picture through a telescope, however far; the lights are near it.
fn ball(distance: f64, filter: Option<Filter>) -> Scene {
    let center = DVec3::new(0.3, -0.2, -distance);
    let mut scene = seen(DVec3::ZERO, center, DVec3::Y, degrees(2.2, distance));
    add_ball(&mut scene, center, 1.0, filter.map_or(Paint::Color(ORANGE), map));
    // Where doubles lie farther apart than that, the next one on this side.
    let before = (center.z + 7.0).max(center.z.next_up());
    add_light(&mut scene, DVec3::new(-4.0, 5.0, before), DVec3::ONE);
    add_light(&mut scene, DVec3::new(6.0, -1.0, center.z), DVec3::new(0.3, 0.4, 0.6));
    scene
}

/// A ball on a ground that is a sphere through the origin, with lamps a few units above.
fn ground(radius: f64) -> Scene {
    let mut scene = seen(DVec3::new(0.4, 1.7, 6.0), DVec3::new(0.0, 0.5, 0.0), DVec3::Y, 40.0);
    add_ball(&mut scene, DVec3::new(0.0, -radius, 0.0), radius, Paint::Color(GREY));
    add_ball(&mut scene, DVec3::new(0.0, 1.0, 0.0), 1.0, Paint::Color(BLUE));
    add_light(&mut scene, DVec3::new(-1.6, 0.45, 2.2), DVec3::new(1.0, 0.75, 0.4));
    add_light(&mut scene, DVec3::new(2.0, 3.0, 3.0), DVec3::splat(0.6));
    scene
}

/// Two balls and a triangle, all coordinates moved by `offset`; they stay whole numbers.
fn elsewhere(offset: f64) -> Scene {
    let at = |x: f64, y: f64, z: f64| DVec3::new(offset + x, 2.0 * y - offset, offset / 2.0 + z);
    let mut scene = seen(at(1.0, 1.0, 9.0), at(0.0, 0.0, 0.0), DVec3::Y, 40.0);
    add_ball(&mut scene, at(-1.0, 0.0, 0.0), 2.0, Paint::Color(ORANGE));
    add_ball(&mut scene, at(2.0, 0.0, 2.0), 1.0, Paint::Color(BLUE));
    add_triangle(&mut scene, [at(-9.0, -1.0, 5.0), at(9.0, -1.0, 5.0), at(0.0, 2.0, -9.0)]);
    add_light(&mut scene, at(-5.0, 4.0, 8.0), DVec3::ONE);
    scene
}

fn add_triangle(scene: &mut Scene, [a, b, c]: [DVec3; 3]) {
    scene.triangles.push(Triangle::new(a, b, c).expect("finite vertices"));
    let look = look(scene, Paint::Color(GREY));
    scene.triangle_looks.push(look);
}

/// A triangle in the plane `x + 5y + 2z = 0` and a lamp at `(2, height, -6)`: for a height of 2 it is in the plane and
/// adds nothing.
fn plane(height: f64) -> Scene {
    let mut scene = seen(DVec3::new(0.5, 0.5, 6.0), DVec3::new(0.25, 0.0, -0.5), DVec3::Y, 60.0);
    let corners = [[10.0, -4.0, 5.0], [-10.0, 0.0, 5.0], [0.0, 4.0, -10.0]];
    add_triangle(&mut scene, corners.map(DVec3::from_array));
    add_light(&mut scene, DVec3::new(2.0, height, -6.0), DVec3::new(1.0, 0.75, 0.4));
    scene
}

/// A textured ball, so close to the point in this direction that neighbouring pixels are neighbouring doubles.
fn close(towards: DVec3, filter: Filter) -> Scene {
    let center = DVec3::new(0.3, -0.2, 0.7);
    let mut scene = seen(center + 3.0 * towards, center, DVec3::Z, degrees(4e-15, 2.0));
    add_ball(&mut scene, center, 1.0, map(filter));
    add_light(&mut scene, center + 4.0 * towards + DVec3::new(0.5, 0.25, 1.0), DVec3::ONE);
    scene
}

/// A map of 15 x 8 texels, each unlike its neighbours.
fn map(filter: Filter) -> Paint {
    let samples = (0..3 * 15 * 8u32).map(|i| u8::try_from(i * 89 % 256).expect("below 256")).collect();
    let texture = Texture::from_bytes(15, 8, samples, 255).expect("a sample for each channel");
    Paint::Image { texture, mirrored: false, filter }
}
