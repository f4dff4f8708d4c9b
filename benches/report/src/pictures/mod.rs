//! Whole pictures: how many pixels each method gets wrong, and how many rays it casts in a second.
//!
//! A pixel is wrong if one of its three 8-bit samples is not that of the [exact] picture. The scenes are the six
//! figures, a crowd of spheres, three on which rounding shows, of which the pictures themselves are kept, and [`scenes`]
//! in families from easy to hard.

mod exact;
mod front;
mod pixels;
pub(super) mod plot;
mod results;
mod scenes;
mod textbook;

use std::hint::black_box;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use figures::camera::{Size, View};
use figures::figure::FIGURES;
use figures::generate::sphereflake;
use figures::render::Renderer;
use figures::scene::{Look, Scene};
use figures::scene_file;
use rt_geom::{AHEAD, Bvh, Hit, Ray, Sphere};

use super::measure::{Effort, take_turns};
use super::progress::progress;
pub(super) use front::front;
use pixels::{Samples8, as_png, paint, samples};
pub(super) use results::{Group, Painted, Pictured};
use scenes::Made;
use textbook::Painter;

/// The methods whose pictures are kept, side by side.
pub(super) const SHOWN: [&str; 2] = ["textbook", "ours, batch"];

/// The scenes on which rounding shows, and what to see there.
pub(super) const HARD: [(&str, &str, &str); 3] = [
    (
        "far sphere",
        include_str!("../../../../figures/scenes/hard/far-sphere.toml"),
        "A ball of radius 1, thirty million away. The textbook's b² - ac is the difference of two numbers near 10^15: \
         rings, and an outline in steps.",
    ),
    (
        "shared edges",
        include_str!("../../../../figures/scenes/hard/shared-edges.toml"),
        "Six triangles that leave no gap, seen so close that neighbouring pixels are neighbouring doubles. White is a crack: \
         a ray that passed between two triangles with a common edge.",
    ),
    (
        "huge ground",
        include_str!("../../../../figures/scenes/hard/huge-ground.toml"),
        "Balls on a ground that is a sphere of radius 6·10^15. The textbook's roots cancel: the ground comes in rings, and not where it is.",
    ),
];

/// The scene of the families whose pictures are kept.
pub(super) fn shown() -> String {
    scenes::shown()
}

/// Measures all methods on all scenes, on one thread.
pub(super) fn pictures(effort: Effort) -> Vec<Pictured> {
    let embedded = |text, name: &str| {
        scene_file::embedded(text, name).expect("scenes that are part of the program are valid, a test shows")
    };
    let mut pictured = Vec::new();
    for figure in FIGURES {
        let scene = || embedded(figure.text, &figure.name());
        pictured.push(measure(&format!("figure {}", figure.number), Group::Figures, false, scene, effort));
    }
    pictured.push(measure("sphereflake of 820", Group::Crowd, false, crowd, effort));
    for (name, text, _) in HARD {
        pictured.push(measure(name, Group::Hard, true, || embedded(text, name), effort));
    }
    let small = Effort { rows: (effort.rows / 6).max(LEAST_ROWS), ..effort };
    for Made { name, scene, shown, .. } in scenes::certified() {
        let effort = if shown { effort } else { small };
        pictured.push(measure(&name, Group::Certified, shown, scene, effort));
    }
    pictured
}

/// A sphereflake of three generations, lit as any file of spheres is.
fn crowd() -> Scene {
    let mut scene = Scene::default();
    for ball in sphereflake(3) {
        scene.spheres.push(Sphere::new(ball.center, ball.radius).expect("a sphereflake's radii are positive"));
        let look = scene.add_look(Look::colored(ball.color));
        scene.sphere_looks.push(look.expect("there are few looks"));
    }
    scene.set_stage(None);
    scene
}

/// Rows that a scene of the families has at least: with fewer, nothing hard would be in sight.
const LEAST_ROWS: u32 = 12;

/// Draws a picture.
type Draw<'a> = Box<dyn Fn() -> Samples8 + Sync + 'a>;

fn measure(name: &str, group: Group, keep: bool, scene: impl Fn() -> Scene, effort: Effort) -> Pictured {
    progress(name);
    let size = Size { width: effort.rows / 3 * 4, height: effort.rows, samples: 1 };
    let drawn = scene();
    let view = drawn.view(size).expect("these scenes have a camera that sees them");
    let truth = exact::picture(&drawn, &view);
    let single = Painter::<f32>::new(&drawn);
    let double = Painter::<f64>::new(&drawn);
    let tree = Bvh::new(drawn.spheres.clone(), drawn.triangles.clone());
    let renderer = Renderer::new(scene());
    let by =
        |closest: &dyn Fn(&Ray) -> Option<Hit>| paint(&view, |ray| renderer.sample(ray, closest(ray), 255).map(eight));
    let methods: Vec<(&str, bool, Draw)> = vec![
        ("textbook f32", false, Box::new(|| paint(&view, |ray| samples(single.color(ray))))),
        ("textbook", false, Box::new(|| paint(&view, |ray| samples(double.color(ray))))),
        ("ours, plain loop", true, Box::new(|| by(&|ray| plain(&drawn, ray)))),
        ("ours, tree", true, Box::new(|| by(&|ray| tree.closest(ray, AHEAD)))),
        ("ours, batch", true, Box::new(|| batch(&renderer, &view))),
    ];
    let is_asked = |name: &str| group != Group::Certified || SHOWN.contains(&name);
    let methods: Vec<_> = methods.into_iter().filter(|(name, ..)| is_asked(name)).collect();
    // One thread for all: batches would take them all.
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread can be had");
    let rays = truth.len() / 3;
    let (found, times) = alone.install(|| {
        let found: Vec<Samples8> = methods.iter().map(|(_, _, draw)| draw()).collect();
        let times = take_turns(methods.len(), rays, effort, |i| drop(black_box(methods[i].2())));
        (found, times)
    });
    let methods = methods.iter().zip(found).zip(times).map(|(((method, ours, _), samples), time)| {
        let wrong = samples.chunks_exact(3).zip(truth.chunks_exact(3)).filter(|(is, should)| is != should);
        let wrong_pixels = wrong.count();
        let shown = keep && SHOWN.contains(method);
        let png = shown.then(|| BASE64_STANDARD.encode(as_png(samples, size)));
        Painted { method: (*method).to_owned(), ours: *ours, wrong_pixels, time, png }
    });
    let methods = methods.collect();
    let objects = drawn.len();
    Pictured { scene: name.to_owned(), group, objects, width: size.width, height: size.height, methods }
}

/// The closest hit, by asking every object.
fn plain(scene: &Scene, ray: &Ray) -> Option<Hit> {
    let spheres = scene.spheres.iter().map(|sphere| sphere.closest(ray, AHEAD));
    let triangles = scene.triangles.iter().map(|triangle| triangle.closest(ray, AHEAD));
    let hits = spheres.chain(triangles).enumerate().filter_map(|(index, t)| Some(Hit { index, t: t? }));
    // The first of equal hits is kept: the lower index.
    hits.reduce(|best, hit| if hit.t < best.t { hit } else { best })
}

/// Draws as the program does.
fn batch(renderer: &Renderer, view: &View) -> Samples8 {
    let rows = renderer.rows(view, 0..view.size().height, 255, &|_| ());
    rows.samples.into_iter().map(eight).collect()
}

/// A sample of eight bits.
fn eight(sample: u16) -> u8 {
    u8::try_from(sample).expect("a sample is at most maxval")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Scenes of the families on which the textbook may be right in so small a picture.
    const EASY: [&str; 7] = [
        "ball at 1e3",
        "ball at 1e6",
        "ground of radius 1e6",
        "ground of radius 1e10",
        "scene at 1e6",
        "scene at 1e10",
        // The seam is no border for what lies between texels.
        "texture, seam, bilinear",
    ];

    #[test]
    fn ours_draws_every_scene_as_it_is_and_the_textbook_does_not() {
        let effort = Effort { cases: 1, rounds: 1, timing: 1, spheres: 0, rows: 18 };
        let (mut certified, mut defeats) = (0, 0);
        for Pictured { scene, group, methods, .. } in pictures(effort) {
            let wrong = |name: &str| {
                let found = methods.iter().find(|painted| painted.method == name);
                found.map(|painted| painted.wrong_pixels).expect("a method's name")
            };
            let ours: Vec<_> = methods.iter().filter(|painted| painted.ours).collect();
            assert!(!ours.is_empty(), "{scene}");
            for painted in ours {
                assert_eq!(painted.wrong_pixels, 0, "{scene}, {}", painted.method);
            }
            let hard = match group {
                Group::Hard => true,
                Group::Certified => !EASY.contains(&scene.as_str()),
                _ => false,
            };
            if hard {
                assert!(wrong("textbook") > 0, "{scene} is not hard");
            }
            certified += usize::from(group == Group::Certified);
            defeats += usize::from(hard);
            if group == Group::Hard {
                assert!(wrong("textbook f32") > 0, "{scene} is not hard in single precision");
            }
        }
        assert_eq!((certified, defeats), (21, 21 - EASY.len() + HARD.len()));
    }
}
