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

    /// Adds spheres from a bulk file: all with the look at this position, or each in its own colour.
    ///
    /// # Errors
    /// More colours than can be numbered; the spheres are not added then.
    pub fn add_spheres(&mut self, found: Spheres, look: Option<u32>) -> Result<(), TooManyColors> {
        let Spheres { spheres, mut color_indices, colors } = found;
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
        let Mesh { triangles, vertex_colors, flat } = found;
        if flat > 0 {
            let triangles = if flat == 1 { "triangle" } else { "triangles" };
            self.warnings.push(format!("{}: left out {flat} {triangles} without area", path.display()));
        }
        self.triangle_looks.resize(self.triangle_looks.len() + triangles.len(), look);
        if vertex_colors.iter().any(Option::is_some) || !self.vertex_colors.is_empty() {
            self.vertex_colors.resize(self.triangles.len(), None);
            self.vertex_colors.extend(vertex_colors);
        }
        self.triangles.extend(triangles);
    }

    /// Sets a stage for objects that come without one: a camera that shows all of them, two lights, a dark background.
    pub fn set_stage(&mut self) {
        let (low, high) =
            self.balls().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), (center, radius)| {
                (low.min(center - radius), high.max(center + radius))
            });
        let (center, size) = (low.midpoint(high), (high / 2.0 - low / 2.0).length());
        self.background = DVec3::new(0.05, 0.06, 0.08);
        self.camera = Camera::STAGE;
        let lamp = |direction: [f64; 3], color: [f64; 3]| PointLight {
            position: center + size * DVec3::from_array(direction),
            color: DVec3::from_array(color),
        };
        self.lights =
            vec![lamp([-4.0, 6.0, 9.0], [0.95, 0.94, 0.9]), lamp([8.0, -1.0, 3.0], [0.22, 0.25, 0.32])];
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
                    for (row, column) in (0..texture.height())
                        .flat_map(|row| (0..texture.width()).map(move |column| (row, column)))
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
pub const DEFAULT_MATERIAL: Material =
    Material { ambient: 0.1, diffuse: 0.8, specular: 0.3, shininess: 32.0 };

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
