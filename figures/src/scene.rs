//! A scene as checked data: what is drawn, in which colours, under which light, seen from where.
//!
//! A scene is plain data; `scene_file` makes it from a file and does all the checking. Its objects have one
//! order, which decides equal distances: spheres as listed, bulk files in order, triangles as listed, meshes in order.

use glam::DVec3;
use rt_geom::{Sphere, Triangle};
use rt_shade::{Material, PointLight, Texture};

use crate::camera::{Camera, Size, View};

/// Everything that a picture depends on, besides its size; by default nothing, black, seen by the report's camera.
#[derive(Debug, Default)]
pub struct Scene {
    /// Where the picture is taken from.
    pub camera: Camera,
    /// The colour where no object is hit.
    pub background: DVec3,
    /// Whether there is no background: only what hits an object has a colour, and the rest is transparent.
    pub transparent: bool,
    /// The point lights. Without any, every object is drawn flat, in its own colour.
    pub lights: Vec<PointLight>,
    /// The looks that a [`LookIndex`] may stand for.
    pub looks: Vec<Look>,
    /// The spheres.
    pub spheres: Vec<Sphere>,
    /// The colours of spheres that came with nothing else; their material is [`DEFAULT_MATERIAL`].
    ///
    /// A file may give each of its spheres a colour of its own: here it takes 24 bytes, in `looks` four times that.
    pub colors: Vec<DVec3>,
    /// What each sphere looks like.
    pub sphere_looks: Vec<LookIndex>,
    /// The triangles; each has an area.
    pub triangles: Vec<Triangle>,
    /// What each triangle looks like: a look, not a colour alone.
    pub triangle_looks: Vec<LookIndex>,
    /// For each triangle that has them, the colours at its vertices; they take the place of the look's colour.
    /// Empty when no triangle has any, else as long as `triangles`.
    pub vertex_colors: Vec<Option<[DVec3; 3]>>,
    /// Warnings for the user; none of them is an error.
    pub warnings: Vec<String>,
    /// What the user may want to know.
    pub notes: Vec<String>,
}

impl Scene {
    /// Returns the number of objects.
    pub fn len(&self) -> usize {
        self.spheres.len() + self.triangles.len()
    }

    /// Returns whether there is nothing to draw.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Checks that the lists agree with each other, as all that reads a scene relies on.
    ///
    /// # Panics
    /// If they do not.
    pub fn check(&self) {
        assert_eq!(self.sphere_looks.len(), self.spheres.len());
        assert_eq!(self.triangle_looks.len(), self.triangles.len());
        assert!(self.vertex_colors.is_empty() || self.vertex_colors.len() == self.triangles.len());
        assert!(self.sphere_looks.iter().all(|look| match look.place() {
            LookPlace::Look(at) => at < self.looks.len(),
            LookPlace::Color(at) => at < self.colors.len(),
        }));
        assert!(self.triangle_looks.iter().all(|&look| self.look(look).is_some()));
        assert!(!self.triangles.iter().any(Triangle::is_degenerate));
    }

    /// Multiplies the radius of each sphere; `None`, and some of them as they were, if that leaves the f64 range.
    pub fn scale_radii(&mut self, factor: f64) -> Option<()> {
        self.spheres.iter_mut().try_for_each(|sphere| {
            *sphere = Sphere::new(sphere.center(), factor * sphere.radius()).ok()?;
            Some(())
        })
    }

    /// Adds a look to the list, and returns its index; `None` if there are [`LookIndex::MOST`] already.
    pub fn add_look(&mut self, look: Look) -> Option<LookIndex> {
        let index = LookIndex::look(self.looks.len())?;
        self.looks.push(look);
        Some(index)
    }

    /// Returns the look with this index; `None` if the index stands for a colour.
    pub fn look(&self, index: LookIndex) -> Option<&Look> {
        match index.place() {
            LookPlace::Look(at) => self.looks.get(at),
            LookPlace::Color(_) => None,
        }
    }

    /// Returns a hash of the scene, which tells the tiles of one picture from another's.
    pub fn fingerprint(&self) -> u64 {
        let mut sum = Fingerprint(0);
        let Self { camera, background, lights, looks, colors, spheres, sphere_looks, .. } = self;
        let Self { triangles, triangle_looks, vertex_colors, .. } = self;
        if self.transparent {
            sum.word(1);
        }
        // Short lists are hashed as text, in which two different doubles differ; long ones by their bits.
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
            sum.word(u64::from(look.0));
        }
        for (triangle, look) in triangles.iter().zip(triangle_looks) {
            triangle.vertices().into_iter().for_each(|vertex| sum.vector(vertex));
            sum.word(u64::from(look.0));
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
    pub(crate) fn balls(&self) -> impl Iterator<Item = (DVec3, f64)> {
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

/// What an object looks like, in four bytes: a position in [`Scene::looks`] or, for a sphere, in [`Scene::colors`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LookIndex(u32);

/// What a [`LookIndex`] stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LookPlace {
    /// A position in [`Scene::looks`].
    Look(usize),
    /// A position in [`Scene::colors`].
    Color(usize),
}

impl LookIndex {
    /// The most looks that have an index, and the most colours.
    pub const MOST: u32 = 1 << 31;

    /// The index of the look at this position.
    pub fn look(position: usize) -> Option<Self> {
        u32::try_from(position).ok().filter(|&position| position < Self::MOST).map(Self)
    }

    /// The index of the colour at this position.
    pub fn color(position: usize) -> Option<Self> {
        Self::look(position).map(|Self(position)| Self(position | Self::MOST))
    }

    /// What it stands for.
    #[inline]
    pub fn place(self) -> LookPlace {
        match self.0.checked_sub(Self::MOST) {
            None => LookPlace::Look(self.0 as usize),
            Some(position) => LookPlace::Color(position as usize),
        }
    }
}

/// A running hash of 64 bits: each word is mixed in by a rotation, an exclusive or, and a product with an odd constant.
struct Fingerprint(u64);

impl Fingerprint {
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
