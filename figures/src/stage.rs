//! A stage for objects that come without one: a camera that shows all of them, two lights, a dark background.

use std::str::FromStr;

use glam::DVec3;
use rt_geom::Sphere;
use rt_shade::PointLight;

use crate::camera::{Camera, cos_sin};
use crate::scene::Scene;

/// Where a picture on the stage is taken from, relative to the middle of the objects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction {
    /// From the middle to the eye; a unit vector.
    pub from: DVec3,
    /// Upwards in the picture; a unit vector perpendicular to it.
    pub up: DVec3,
}

impl Direction {
    /// The direction that turns about +z by `azimuth`, from +x towards +y, and rises by `elevation`, in degrees; +z, or
    /// at the poles what goes over into it, is upwards.
    ///
    /// `None` if they are not finite, or if the elevation is beyond -90 to 90.
    pub fn new(azimuth: f64, elevation: f64) -> Option<Self> {
        if !(azimuth.is_finite() && (-90.0..=90.0).contains(&elevation)) {
            return None;
        }
        let [(cos, sin), (flat, high)] = [azimuth, elevation].map(cos_sin);
        let [from, up] = [(flat, high), (-high, flat)].map(|(out, z)| DVec3::new(out * cos, out * sin, z));
        Some(Self { from, up })
    }
}

impl FromStr for Direction {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (azimuth, elevation) = match text {
            "x" => ("0", "0"),
            "y" => ("90", "0"),
            // +y is upwards.
            "z" => ("-90", "90"),
            // The three axes are equally long: the tangent of the elevation is the square root of one half.
            "iso" => ("45", "35.264389682754654"),
            _ => text.split_once(',').ok_or("expected x, y, z, iso, or two angles in degrees, such as 30,20")?,
        };
        let angle = |text: &str| text.trim().parse::<f64>().ok();
        let direction =
            angle(azimuth).zip(angle(elevation)).and_then(|(azimuth, elevation)| Self::new(azimuth, elevation));
        direction.ok_or_else(|| "expected a finite angle about z, and one from -90 to 90 above the ground".to_owned())
    }
}

/// The middle of a scene, seen from its camera, and its size.
pub(crate) struct Spot {
    center: DVec3,
    /// Half of the diagonal of the box around the objects.
    radius: f64,
    axes: [DVec3; 3],
}

impl Spot {
    /// The place that lies so many radii to the right, up, and back towards the camera.
    pub(crate) fn at(&self, place: DVec3) -> DVec3 {
        let [right, up, forward] = self.axes;
        self.center + self.radius * (place.x * right + place.y * up - place.z * forward)
    }
}

impl Scene {
    /// Sets a stage for objects that come without one: a camera that shows all of them, two lights, a dark background.
    ///
    /// The camera is [`Camera::stage`]'s, from `view` or else from `FROM`, with +y upwards. Objects that lie in one
    /// plane which is seen edge-on from there, or at a slope below `EDGE_ON`, are then seen along the plane's normal,
    /// from the front or, where the plane runs from front to back, from the right.
    pub fn set_stage(&mut self, view: Option<Direction>) {
        self.background = BACKGROUND;
        self.camera = match view {
            Some(Direction { from, up }) => Camera::stage(from, up),
            None => {
                let size = 2.0 * self.spot().radius;
                let normal = self.flat_normal(size);
                let from = normal.filter(|normal| normal.dot(FROM).abs() < EDGE_ON * FROM.length());
                // A normal so far from FROM has one of the two components.
                let from = from.map_or(FROM, |normal| {
                    let sided = if normal.z.abs() >= EDGE_ON { normal.z } else { normal.x };
                    normal * sided.signum()
                });
                Camera::stage(from, DVec3::Y)
            }
        };
        let spot = self.spot();
        let lamp = |&(place, color): &(DVec3, DVec3)| PointLight { position: spot.at(place), color };
        self.lights = LIGHTS.iter().map(lamp).collect();
    }

    /// The middle of the scene and its size, as the camera sees them.
    pub(crate) fn spot(&self) -> Spot {
        let (low, high) = self.balls().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), (center, radius)| {
            (low.min(center - radius), high.max(center + radius))
        });
        Spot { center: low.midpoint(high), radius: (high / 2.0 - low / 2.0).length(), axes: self.camera.axes() }
    }

    /// The unit normal, on either side, of the plane that all objects lie in; `None` if there is none, or if they lie
    /// on a line.
    ///
    /// A plane is one for this purpose if nothing rises above it by more than `FLAT` of the objects' width, so that
    /// seen edge-on they are at most a line. `size` is the diameter of all objects.
    fn flat_normal(&self, size: f64) -> Option<DVec3> {
        // The objects' width is at most their size: mostly this decides.
        if self.spheres.iter().any(|sphere| sphere.radius() > FLAT * size) {
            return None;
        }
        let start = self.balls().next()?.0;
        // Within 0..=1 in magnitude at any scale. An overflow gives NaN, which fails every comparison.
        let relative = |point: DVec3| point / size - start / size;
        // Four points of diameter 1 between two planes this far apart span a tetrahedron of at most half the distance
        // in volume, its base being at most half a square; the triple product is six times that. So a few points show
        // most solids.
        let few = |count: usize| count / 32 + 1;
        let sample = self.spheres.iter().step_by(few(self.spheres.len())).map(Sphere::center);
        let corners = self.triangles.iter().step_by(few(self.triangles.len())).map(|one| one.vertices()[0]);
        let sample: Vec<DVec3> = sample.chain(corners).map(relative).collect();
        let (along, _) = farthest(sample.iter().copied(), |at| at.length_squared());
        let (across, _) = farthest(sample.iter().copied(), |at| along.cross(at).length_squared());
        let (_, volume) = farthest(sample.iter().copied(), |at| along.cross(across).dot(at).abs());
        if volume > 3.0 * (2.0 * FLAT) {
            return None;
        }
        let centers = || self.balls().map(|(center, _)| relative(center));
        let (along, length) = farthest(centers(), |at| at.length_squared());
        let (across, width) = farthest(centers(), |at| along.cross(at).length_squared());
        // The width of the objects, times their length, which is at least a quarter.
        let width = width.sqrt();
        if !(length > 0.0 && width > NEEDLE) {
            return None;
        }
        let normal = along.cross(across).normalize();
        let height = FLAT * width;
        let within = |(center, radius): (DVec3, f64)| normal.dot(relative(center)).abs() + radius / size <= height;
        self.balls().all(within).then_some(normal)
    }
}

/// Where a stage is seen from, relative to the middle: 31 degrees to the right of the front and 21 degrees above. A
/// cube along the axes shows three sides, 20, 12 and 9 parts of 25 as large as they are.
const FROM: DVec3 = DVec3::new(12.0, 9.0, 20.0);

/// The colour behind the objects.
const BACKGROUND: DVec3 = DVec3::new(0.05, 0.06, 0.08);

/// The lights: their places in radii of the scene, to the right, up and back, and their colours. The first is near, so
/// that it meets equal surfaces at different angles and their shades differ from place to place; the second leaves its
/// shadow side dark, and blue.
const LIGHTS: [(DVec3, DVec3); 2] = [
    (DVec3::new(-1.8, 2.5, 2.6), DVec3::new(1.0, 0.98, 0.93)),
    (DVec3::new(3.0, -1.0, 2.0), DVec3::new(0.3, 0.34, 0.42)),
];

/// A plane of objects that is seen at less than this slope, the sine of 7.2 degrees, is seen along its normal instead.
const EDGE_ON: f64 = 0.125;

/// Objects that rise above a plane by no more than this part of their width are flat: one pixel of a picture as wide as
/// the program's.
const FLAT: f64 = 1.0 / 1024.0;

/// Objects narrower than this part of their length lie on a line: the normal of a plane through them would be lost in
/// the rounding of their coordinates.
const NEEDLE: f64 = 1e-9;

/// The first of some points where a distance is largest, and that distance; zero if none is more.
fn farthest(points: impl Iterator<Item = DVec3>, distance: impl Fn(DVec3) -> f64) -> (DVec3, f64) {
    points.fold((DVec3::ZERO, 0.0), |most, at| {
        let distance = distance(at);
        if distance > most.1 { (at, distance) } else { most }
    })
}

#[cfg(test)]
mod tests {
    use rt_geom::Triangle;

    use super::*;

    /// Where a stage looks at such objects from: the unit direction from the middle to the eye.
    fn looks_from(triangles: &[[DVec3; 3]], spheres: &[(DVec3, f64)]) -> DVec3 {
        let triangles = triangles.iter().map(|&[a, b, c]| Triangle::new(a, b, c).unwrap()).collect();
        let spheres = spheres.iter().map(|&(center, radius)| Sphere::new(center, radius).unwrap()).collect();
        let mut scene = Scene { spheres, triangles, ..Scene::default() };
        scene.set_stage(None);
        // The lights turn with the camera: from the second, the first is to the left, above, and farther back.
        let [right, up, forward] = scene.camera.axes();
        let side = scene.lights[0].position - scene.lights[1].position;
        if side.is_finite() && side != DVec3::ZERO {
            assert!(side.dot(right) < 0.0 && side.dot(up) > 0.0 && side.dot(forward) < 0.0, "{side}");
        }
        -forward
    }

    /// Two triangles in the plane of two directions.
    fn sheet(origin: DVec3, x: DVec3, y: DVec3) -> [[DVec3; 3]; 2] {
        [[origin, origin + x, origin + y], [origin + x, origin + x + y, origin + y]]
    }

    fn is_near(found: DVec3, expected: DVec3) -> bool {
        (found - expected.normalize()).length() < 1e-6
    }

    #[test]
    fn solids_and_sheets_that_show_are_seen_from_the_stages_direction() {
        let sheet = |x, y| sheet(DVec3::new(3.0, -1.0, 2.0), x, y).to_vec();
        let sheets = [
            sheet(DVec3::X, DVec3::Y),
            sheet(DVec3::Y, DVec3::Z),
            sheet(DVec3::Z, DVec3::X),
            sheet(DVec3::X, DVec3::new(0.3, -0.5, 0.7)),
            // Not flat, though each of its triangles is seen edge-on.
            [sheet(FROM, DVec3::X), sheet(FROM, DVec3::Y)].concat(),
        ];
        for triangles in sheets {
            assert!(is_near(looks_from(&triangles, &[]), FROM), "{triangles:?}");
        }
        assert!(is_near(looks_from(&[], &[(DVec3::ONE, 2.0)]), FROM));
        assert!(is_near(looks_from(&[], &[(DVec3::ONE, 0.0)]), FROM));
        assert!(is_near(looks_from(&sheet(FROM, DVec3::X), &[(DVec3::ZERO, 1.0)]), FROM));
    }

    #[test]
    fn a_sheet_seen_edge_on_is_seen_along_its_normal() {
        for (across, expected) in [
            (DVec3::Y, DVec3::new(20.0, 0.0, -12.0)),
            (DVec3::X, DVec3::new(0.0, -20.0, 9.0)),
            (DVec3::Z, DVec3::new(9.0, -12.0, 0.0)),
            (DVec3::new(1.0, 1.0, -3.0), FROM.cross(DVec3::new(-1.0, -1.0, 3.0))),
        ] {
            // From the front, or from the right where the sheet runs from front to back.
            let side = if expected.normalize().z.abs() > EDGE_ON { expected.z } else { expected.x };
            let expected = expected * side.signum();
            for scale in [1.0, 1e-160, 1e150] {
                for place in [DVec3::ZERO, DVec3::new(-7.0, 5.0, 4.0)] {
                    let mut triangles = sheet(scale * place, scale * FROM, scale * 7.0 * across);
                    for _ in 0..2 {
                        let found = looks_from(&triangles, &[]);
                        assert!(is_near(found, expected), "{across} {scale} {place}: {found} {expected}");
                        // The same whatever comes first and however it turns.
                        triangles.reverse();
                        triangles.iter_mut().for_each(|triangle| triangle.reverse());
                    }
                }
            }
        }
    }

    #[test]
    fn named_views_look_along_the_axes() {
        let axes = |text: &str| {
            let mut scene = Scene { spheres: vec![Sphere::new(DVec3::splat(9.0), 1.0).unwrap()], ..Scene::default() };
            scene.set_stage(Some(text.parse().unwrap()));
            scene.camera.axes()
        };
        for (text, right, up) in [
            ("x", DVec3::Y, DVec3::Z),
            ("y", DVec3::NEG_X, DVec3::Z),
            ("z", DVec3::X, DVec3::Y),
            ("90,0", DVec3::NEG_X, DVec3::Z),
            ("-450,0", DVec3::X, DVec3::Z),
            ("0,90", DVec3::Y, DVec3::NEG_X),
            ("0,-90", DVec3::Y, DVec3::X),
        ] {
            assert_eq!(axes(text), [right, up, up.cross(right)], "{text}");
        }
        let [right, up, forward] = axes("iso");
        assert!(is_near(-forward, DVec3::ONE) && is_near(right, DVec3::new(-1.0, 1.0, 0.0)), "{right} {up} {forward}");
        let [_, _, forward] = axes("30, -20");
        let (ground, height) = (20_f64.to_radians().cos(), -20_f64.to_radians().sin());
        let azimuth = 30_f64.to_radians();
        assert!(is_near(-forward, DVec3::new(ground * azimuth.cos(), ground * azimuth.sin(), height)), "{forward}");
        for bad in ["", "up", "10", "10,", "10,91", "nan,0", "0,nan", "inf,0", "1,2,3"] {
            assert!(bad.parse::<Direction>().is_err(), "{bad}");
        }
    }

    #[test]
    fn points_on_a_line_and_sizes_beyond_the_doubles_have_a_stage_too() {
        let along = |k: f64| (k * FROM, 0.0);
        assert!(is_near(looks_from(&[], &[along(0.0), along(1.0), along(3.0)]), FROM));
        assert!(is_near(looks_from(&sheet(DVec3::ZERO, 5e306 * FROM, 5e306 * DVec3::Y), &[]), FROM));
    }
}
