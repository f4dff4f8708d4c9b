//! A scene as checked data: what is drawn, in which colours, under which light, seen from where.
//!
//! A scene is plain data; the way from a file to it ([`crate::scene_file`]) does all the checking. Its objects have one
//! order, which decides equal distances: spheres as listed, bulk files in order, triangles as listed, meshes in order.

use std::path::Path;

use glam::DVec3;
use rt_geom::{Sphere, Triangle};
use rt_shade::{Material, PointLight, Texture};

use crate::camera::{Camera, Size, View};
use crate::import::obj::Mesh;
use crate::import::xyz::Spheres;
use crate::text::file_name;

/// Everything that a picture depends on, besides its size.
#[derive(Debug)]
pub struct Scene {
    /// Where the picture is taken from.
    pub camera: Camera,
    /// The colour where no object is hit.
    pub background: DVec3,
    /// The point lights. Without any, every object is drawn flat, in its own colour.
    pub lights: Vec<PointLight>,
    /// The looks that objects refer to by their position in this list.
    pub looks: Vec<Look>,
    /// The spheres.
    pub spheres: Vec<Sphere>,
    /// The colours of spheres that came with nothing else; their material is [`DEFAULT_MATERIAL`].
    ///
    /// A file may give each of its spheres a colour of its own: here it takes 24 bytes, in `looks` four times that.
    pub colors: Vec<DVec3>,
    /// For each sphere, the position of its look in `looks`, or [`COLOR`] and the position of its colour in `colors`.
    pub sphere_looks: Vec<u32>,
    /// The triangles; each has an area.
    pub triangles: Vec<Triangle>,
    /// For each triangle, the position of its look in `looks`.
    pub triangle_looks: Vec<u32>,
    /// For each triangle that has them, the colours at its vertices; they take the place of the look's colour.
    /// Empty when no triangle has any, else as long as `triangles`.
    pub vertex_colors: Vec<Option<[DVec3; 3]>>,
    /// What whoever draws the scene should know, though it is no error.
    pub warnings: Vec<String>,
}

impl Scene {
    /// A scene without objects and lights, black, seen by the report's camera.
    pub fn empty() -> Self {
        Self {
            camera: Camera::default(),
            background: DVec3::ZERO,
            lights: Vec::new(),
            looks: Vec::new(),
            colors: Vec::new(),
            spheres: Vec::new(),
            sphere_looks: Vec::new(),
            triangles: Vec::new(),
            triangle_looks: Vec::new(),
            vertex_colors: Vec::new(),
            warnings: Vec::new(),
        }
    }

    /// Returns the number of objects.
    pub fn len(&self) -> usize {
        self.spheres.len() + self.triangles.len()
    }

    /// Tells whether there is nothing to draw.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Checks that the lists agree with each other, as everything that reads a scene promises.
    ///
    /// # Panics
    /// If they do not.
    pub fn check(&self) {
        assert_eq!(self.sphere_looks.len(), self.spheres.len());
        assert_eq!(self.triangle_looks.len(), self.triangles.len());
        assert!(self.vertex_colors.is_empty() || self.vertex_colors.len() == self.triangles.len());
        let known = |look: &u32| (*look as usize) < self.looks.len();
        let paint = |look: &u32| look.checked_sub(COLOR).is_some_and(|at| (at as usize) < self.colors.len());
        assert!(self.sphere_looks.iter().all(|look| known(look) || paint(look)));
        assert!(self.triangle_looks.iter().all(known));
        assert!(!self.triangles.iter().any(Triangle::is_degenerate));
    }

    /// Adds spheres from the bulk file at `path`: all with the look at this position, or each in its own colour.
    ///
    /// # Errors
    /// More colours than can be numbered; the spheres are not added then.
    pub fn add_spheres(&mut self, found: Spheres, look: Option<u32>, path: &Path) -> Result<(), TooManyColors> {
        let Spheres { spheres, mut color_indices, colors, notes } = found;
        self.warnings.extend(notes.into_iter().map(|note| format!("{}: {note}", file_name(path))));
        match look {
            Some(look) => color_indices.fill(look),
            None => {
                let last = u32::try_from(self.colors.len() + colors.len()).map_err(|_| TooManyColors)?;
                if last > COLOR {
                    return Err(TooManyColors);
                }
                // No more than `last`, which fits.
                let first = COLOR + u32::try_from(self.colors.len()).unwrap_or(last);
                if self.colors.is_empty() {
                    self.colors = colors;
                } else {
                    self.colors.extend(colors);
                }
                color_indices.iter_mut().for_each(|index| *index += first);
            }
        }
        if self.spheres.is_empty() {
            (self.spheres, self.sphere_looks) = (spheres, color_indices);
        } else {
            self.spheres.extend(spheres);
            self.sphere_looks.extend(color_indices);
        }
        Ok(())
    }

    /// Adds a mesh from the file at `path`, with the look at this position.
    pub fn add_mesh(&mut self, found: Mesh, look: u32, path: &Path) {
        let Mesh { triangles, vertex_colors, flat, crossed, passed_over } = found;
        let mut warn = |warning: String| self.warnings.push(format!("{}: {warning}", file_name(path)));
        if flat > 0 {
            let triangles = if flat == 1 { "triangle" } else { "triangles" };
            warn(format!("left out {flat} {triangles} without area"));
        }
        if crossed > 0 {
            let faces = if crossed == 1 { "face crosses itself" } else { "faces cross themselves" };
            warn(format!("{crossed} {faces}; the triangles of such a face may overlap"));
        }
        if !passed_over.is_empty() {
            warn(format!("passed over: {}", passed_over.join(", ")));
        }
        self.triangle_looks.resize(self.triangle_looks.len() + triangles.len(), look);
        if vertex_colors.iter().any(Option::is_some) || !self.vertex_colors.is_empty() {
            self.vertex_colors.resize(self.triangles.len(), None);
            self.vertex_colors.extend(vertex_colors);
        }
        self.triangles.extend(triangles);
    }

    /// Sets a stage for objects that come without one: a camera that shows all of them, two lights, a dark background.
    ///
    /// The camera is [`Camera::stage`]'s, from [`FROM`]. Objects that lie in one plane which is seen edge-on from there, or at a
    /// slope below `EDGE_ON`, are seen along the plane's normal, from the front or, where the plane runs from front to back,
    /// from the right.
    pub fn set_stage(&mut self) {
        let (low, high) = self.balls().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), (center, radius)| {
            (low.min(center - radius), high.max(center + radius))
        });
        let (center, size) = (low.midpoint(high), (high / 2.0 - low / 2.0).length());
        let from = self
            .flat_normal(2.0 * size)
            .filter(|normal| normal.dot(FROM).abs() < EDGE_ON * FROM.length())
            // A normal so far from FROM has one of the two components.
            .map_or(FROM, |normal| {
                let sided = if normal.z.abs() >= EDGE_ON { normal.z } else { normal.x };
                normal * sided.signum()
            });
        self.background = DVec3::new(0.05, 0.06, 0.08);
        self.camera = Camera::stage(from);
        let [right, up, forward] = self.camera.axes();
        let lamp = |[x, y, z]: [f64; 3], color: [f64; 3]| PointLight {
            position: center + size * (x * right + y * up - z * forward),
            color: DVec3::from_array(color),
        };
        self.lights = vec![lamp([-3.0, 6.0, 9.0], [0.95, 0.94, 0.9]), lamp([8.0, -1.0, 3.0], [0.36, 0.4, 0.48])];
    }

    /// The unit normal, on either side, of the plane that all objects lie in; `None` if there is none, or if they lie on a line.
    ///
    /// A plane is one for this purpose if nothing rises above it by more than `FLAT` of the objects' width, so that seen
    /// edge-on they are at most a line. `size` is the diameter of all objects.
    fn flat_normal(&self, size: f64) -> Option<DVec3> {
        // The objects' width is at most their size: mostly this decides.
        if self.spheres.iter().any(|sphere| sphere.radius() > FLAT * size) {
            return None;
        }
        let start = self.balls().next()?.0;
        // Within 0..=1 in magnitude, whatever the scale. What overflows compares with nothing.
        let relative = |point: DVec3| point / size - start / size;
        // Four points of diameter 1 between two planes this far apart span a tetrahedron of at most half the distance in volume,
        // its base being at most half a square; the triple product is six times that. So a few points show most solids.
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

    /// Returns a number that two different scenes hardly ever share: it tells tiles of one picture from another's.
    pub fn fingerprint(&self) -> u64 {
        let mut sum = Sum(0);
        let Self { camera, background, lights, looks, colors, spheres, sphere_looks, .. } = self;
        let Self { triangles, triangle_looks, vertex_colors, .. } = self;
        // Shortest decimals tell doubles apart; what there is a lot of goes by its bits.
        sum.text(&format!("{camera:?} {background:?} {lights:?}"));
        for Look { paint, material } in looks {
            sum.text(&format!("{material:?}"));
            match paint {
                Paint::Color(color) => sum.vector(*color),
                Paint::Image { texture, mirrored, filter } => {
                    sum.text(&format!("{mirrored} {filter:?} {} {}", texture.width(), texture.height()));
                    let middle = |texel: usize, count: usize| (texel as f64 + 0.5) / count as f64;
                    for (row, column) in
                        (0..texture.height()).flat_map(|row| (0..texture.width()).map(move |column| (row, column)))
                    {
                        let (u, v) = (middle(column, texture.width()), middle(row, texture.height()));
                        sum.vector(texture.nearest(u, v));
                    }
                }
            }
        }
        colors.iter().for_each(|color| sum.vector(*color));
        sum.word(spheres.len() as u64);
        for (sphere, look) in spheres.iter().zip(sphere_looks) {
            sum.vector(sphere.center());
            sum.word(sphere.radius().to_bits());
            sum.word(u64::from(*look));
        }
        for (triangle, look) in triangles.iter().zip(triangle_looks) {
            triangle.vertices().into_iter().for_each(|vertex| sum.vector(vertex));
            sum.word(u64::from(*look));
        }
        for (index, colors) in vertex_colors.iter().enumerate() {
            if let Some(colors) = colors {
                sum.word(index as u64);
                colors.iter().for_each(|color| sum.vector(*color));
            }
        }
        sum.0
    }

    /// The center and radius of each sphere, and each corner of each triangle with radius 0.
    fn balls(&self) -> impl Iterator<Item = (DVec3, f64)> {
        let corners = self.triangles.iter().flat_map(Triangle::vertices).map(|corner| (corner, 0.0));
        self.spheres.iter().map(|sphere| (sphere.center(), sphere.radius())).chain(corners)
    }

    /// Returns the view of a picture of this size; `None` if the camera has to fit a scene and there is no place
    /// in the f64 range from which it sees all of it.
    pub fn view(&self, size: Size) -> Option<View> {
        if !self.camera.fits() {
            return Some(View::new(self.camera, size));
        }
        let camera = self.camera.framed(self.balls(), size.width, size.height)?;
        Some(View::new(camera, size))
    }
}

/// Where a stage is seen from, relative to the middle: 31 degrees to the right of the front and 21 degrees above. A cube along the
/// axes shows three sides, 20, 12 and 9 parts of 25 as large as they are.
pub const FROM: DVec3 = DVec3::new(12.0, 9.0, 20.0);

/// A plane of objects that is seen at less than this slope, the sine of 7.2 degrees, is seen along its normal instead.
const EDGE_ON: f64 = 0.125;

/// Objects that rise above a plane by no more than this part of their width are flat: one pixel of a picture as wide as the
/// program's.
const FLAT: f64 = 1.0 / 1024.0;

/// Objects narrower than this part of their length lie on a line: the normal of a plane through them would be lost in the
/// rounding of their coordinates.
const NEEDLE: f64 = 1e-9;

/// The first of some points where a distance is largest, and that distance; zero if none is more.
fn farthest(points: impl Iterator<Item = DVec3>, distance: impl Fn(DVec3) -> f64) -> (DVec3, f64) {
    points.fold((DVec3::ZERO, 0.0), |most, at| {
        let distance = distance(at);
        if distance > most.1 { (at, distance) } else { most }
    })
}

/// The mark of a colour among a scene's looks: positions from here on count colours, those below looks.
pub const COLOR: u32 = 1 << 31;

/// A scene's spheres have more colours than can be numbered.
#[derive(Debug, thiserror::Error)]
#[error("more than {COLOR} colors; give the spheres a material")]
pub struct TooManyColors;

/// A running sum of 64 bits: each word is turned into it and stirred by a large odd number.
struct Sum(u64);

impl Sum {
    fn word(&mut self, word: u64) {
        self.0 = (self.0.rotate_left(23) ^ word).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    }

    fn vector(&mut self, vector: DVec3) {
        vector.to_array().into_iter().for_each(|number| self.word(number.to_bits()));
    }

    fn text(&mut self, text: &str) {
        text.bytes().for_each(|byte| self.word(u64::from(byte)));
    }
}

/// What a surface looks like: its colour, and how it answers light.
#[derive(Debug)]
pub struct Look {
    /// The colour of the surface.
    pub paint: Paint,
    /// Phong's coefficients.
    pub material: Material,
}

impl Look {
    /// The look of an object that has nothing but a colour.
    pub fn colored(color: DVec3) -> Self {
        Self { paint: Paint::Color(color), material: DEFAULT_MATERIAL }
    }
}

/// What a material is unless it says otherwise; `docs/scene-format.md` states it.
pub const DEFAULT_MATERIAL: Material = Material { ambient: 0.1, diffuse: 0.8, specular: 0.3, shininess: 32.0 };

/// Where a surface takes its colour from.
#[derive(Debug)]
pub enum Paint {
    /// The same colour everywhere, each channel in 0..=1.
    Color(DVec3),
    /// An image around a sphere.
    Image {
        /// The image.
        texture: Texture,
        /// Read as the report's formula does, so that the image shows mirrored from outside.
        mirrored: bool,
        /// How the colour between the centres of texels is found.
        filter: Filter,
    },
}

/// How a texture is read between the centres of its texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Filter {
    /// The colour of the texel that holds the point: the report's rule.
    #[default]
    Nearest,
    /// The weighted mean of the four nearest texels.
    Bilinear,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where a stage looks at such objects from: the unit direction from the middle to the eye.
    fn looks_from(triangles: &[[DVec3; 3]], spheres: &[(DVec3, f64)]) -> DVec3 {
        let mut scene = Scene::empty();
        scene.triangles = triangles.iter().map(|&[a, b, c]| Triangle::new(a, b, c).unwrap()).collect();
        scene.spheres = spheres.iter().map(|&(center, radius)| Sphere::new(center, radius).unwrap()).collect();
        scene.set_stage();
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
    fn points_on_a_line_and_sizes_beyond_the_doubles_have_a_stage_too() {
        let along = |k: f64| (k * FROM, 0.0);
        assert!(is_near(looks_from(&[], &[along(0.0), along(1.0), along(3.0)]), FROM));
        assert!(is_near(looks_from(&sheet(DVec3::ZERO, 5e306 * FROM, 5e306 * DVec3::Y), &[]), FROM));
    }
}
