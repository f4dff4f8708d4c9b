//! A scene as checked data: what is drawn, in which colours, under which light, seen from where.
//!
//! A scene is plain data; the way from a file to it ([`crate::scene_file`]) does all the checking. Its objects have one
//! order, which decides equal distances: spheres as listed, bulk files in order, triangles as listed, meshes in order.

use glam::DVec3;
use rt_geom::{Sphere, Triangle, enclosing_sphere};
use rt_shade::{Material, PointLight, Texture};

use crate::camera::{Camera, Size, View};

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
    /// For each sphere, the position of its look in `looks`.
    pub sphere_looks: Vec<u32>,
    /// The triangles; each has an area.
    pub triangles: Vec<Triangle>,
    /// For each triangle, the position of its look in `looks`.
    pub triangle_looks: Vec<u32>,
    /// For each triangle that has them, the colours at its vertices; they take the place of the look's colour.
    /// Empty when no triangle has any, else as long as `triangles`.
    pub vertex_colors: Vec<Option<[DVec3; 3]>>,
}

impl Scene {
    /// A scene without objects and lights, black, seen by the report's camera.
    pub fn empty() -> Self {
        Self {
            camera: Camera::default(),
            background: DVec3::ZERO,
            lights: Vec::new(),
            looks: Vec::new(),
            spheres: Vec::new(),
            sphere_looks: Vec::new(),
            triangles: Vec::new(),
            triangle_looks: Vec::new(),
            vertex_colors: Vec::new(),
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

    /// Returns the minimal sphere around everything in the scene; `None` if it is empty or no finite sphere holds it.
    pub fn content(&self) -> Option<Sphere> {
        let corners = self.triangles.iter().flat_map(Triangle::vertices);
        let corners = corners.filter_map(|corner| Sphere::new(corner, 0.0)); // a vertex is always finite
        let enclosing = if self.triangles.is_empty() {
            enclosing_sphere(&self.spheres)
        } else {
            let all: Vec<Sphere> = self.spheres.iter().copied().chain(corners).collect();
            enclosing_sphere(&all)
        };
        enclosing.map(|enclosing| enclosing.sphere)
    }

    /// Returns the view of a picture of this size; `None` if the camera has to fit a scene that no finite sphere
    /// holds.
    pub fn view(&self, size: Size) -> Option<View> {
        if !self.camera.fits() {
            return Some(View::new(self.camera, size));
        }
        let camera = self.camera.framed(&self.content()?, size.width, size.height)?;
        Some(View::new(camera, size))
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
