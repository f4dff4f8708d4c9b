//! From a scene to pixels: rays, the closest hit of each, its colour, and the mean of the colours in a pixel.
//!
//! The picture is cut into bands of rows that rayon hands to threads, each band into square tiles whose rays go through
//! the tree together. A pixel's value depends on nothing but its own rays, summed in a fixed order, so the bytes are
//! the same for any number of threads.

use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;
use rt_geom::{Hit, Ray, Shape, SphereTree};
use rt_shade::color::{clamp, interpolate, to_sample};
use rt_shade::{PointLight, phong, texture_uv};

use crate::camera::{Size, View};
use crate::scene::{COLOR, DEFAULT_MATERIAL, Filter, Look, Paint, Scene};

/// The side of a tile in pixels: its rays are close enough together to visit the same nodes of the tree.
const TILE: u32 = 8;

/// The ray's own range: from its origin on, without end.
pub(crate) const AHEAD: Range<f64> = 0.0..f64::INFINITY;

/// A scene made ready for rays: its objects in a tree.
#[derive(Debug)]
pub struct Renderer {
    background: DVec3,
    lights: Vec<PointLight>,
    looks: Vec<Look>,
    colors: Vec<DVec3>,
    sphere_looks: Vec<u32>,
    triangle_looks: Vec<u32>,
    vertex_colors: Vec<Option<[DVec3; 3]>>,
    tree: SphereTree,
}

/// Rows of a picture, and how many rays they took.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rows {
    /// RGB samples, row by row from the top.
    pub samples: Vec<u16>,
    /// Rays that were sent.
    pub rays: u64,
    /// Rays that met an object.
    pub hits: u64,
}

impl Renderer {
    /// Builds the tree over the scene's objects.
    pub fn new(scene: Scene) -> Self {
        let Scene { background, lights, looks, colors, spheres, triangles, .. } = scene;
        let Scene { sphere_looks, triangle_looks, vertex_colors, .. } = scene;
        let tree = SphereTree::new(spheres, triangles);
        Self { background, lights, looks, colors, sphere_looks, triangle_looks, vertex_colors, tree }
    }

    /// Draws the given rows of a picture, samples in `0..=maxval`.
    ///
    /// `advance` is called from any thread with the number of rows that have just been done.
    pub fn rows(&self, view: &View, rows: Range<u32>, maxval: u16, advance: &(dyn Fn(u64) + Sync)) -> Rows {
        let Size { width, samples, .. } = view.size();
        let row_length = 3 * width as usize;
        let mut picture = vec![0; row_length * rows.len()];
        let hits = (rows.clone().into_par_iter().step_by(TILE as usize))
            .zip(picture.par_chunks_mut(row_length * TILE as usize))
            .map_init(Tile::default, |tile, (top, band)| {
                let bottom = rows.end.min(top + TILE);
                let mut hits = 0;
                for left in (0..width).step_by(TILE as usize) {
                    let right = width.min(left + TILE);
                    hits += tile.trace(self, view, left..right, top..bottom);
                    for (tile_row, line) in tile
                        .pixels
                        .chunks_exact((right - left) as usize)
                        .zip(band.chunks_exact_mut(row_length))
                    {
                        for (color, pixel) in
                            tile_row.iter().zip(line[3 * left as usize..].chunks_exact_mut(3))
                        {
                            pixel
                                .copy_from_slice(&color.to_array().map(|channel| to_sample(channel, maxval)));
                        }
                    }
                }
                advance(u64::from(bottom - top));
                hits
            })
            .sum();
        let rays = u64::from(width) * rows.len() as u64 * u64::from(samples) * u64::from(samples);
        Rows { samples: picture, rays, hits }
    }

    /// The colour that a ray brings back.
    pub(crate) fn color(&self, ray: &Ray, hit: Option<Hit>) -> DVec3 {
        let Some(Hit { index, t }) = hit else { return self.background };
        let point = ray.at(t);
        match self.tree.shape(index) {
            Shape::Sphere(sphere) => {
                // A sphere of radius 0 faces whoever looks at it.
                let normal = if sphere.radius() > 0.0 { sphere.normal(point) } else { -ray.direction() };
                let look = self.sphere_looks[index];
                let (surface, material) = match look.checked_sub(COLOR) {
                    Some(position) => (self.colors[position as usize], &DEFAULT_MATERIAL),
                    None => {
                        let Look { paint, material } = &self.looks[look as usize];
                        (paint_at(paint, normal), material)
                    }
                };
                phong(point, ray.direction(), normal, surface, material, &self.lights)
            }
            Shape::Triangle(triangle) => {
                let index = index - self.sphere_looks.len();
                let look = &self.looks[self.triangle_looks[index] as usize];
                let colors = self.vertex_colors.get(index).and_then(Option::as_ref);
                let surface = match (colors, &look.paint) {
                    (Some(colors), _) => triangle
                        .hit_barycentric(ray)
                        .map_or(colors[0], |weights| interpolate(colors, weights)),
                    (None, Paint::Color(color)) => *color,
                    (None, Paint::Image { .. }) => unreachable!("a triangle's look has a color"),
                };
                let normal = triangle.normal().unwrap_or(-ray.direction());
                phong(point, ray.direction(), normal, surface, &look.material, &self.lights)
            }
        }
    }
}

/// The colour of a sphere where its outward normal is `normal`.
fn paint_at(paint: &Paint, normal: DVec3) -> DVec3 {
    match paint {
        Paint::Color(color) => *color,
        Paint::Image { texture, mirrored, filter } => {
            let (u, v) = texture_uv(normal, *mirrored);
            match filter {
                Filter::Nearest => texture.nearest(u, v),
                Filter::Bilinear => texture.bilinear(u, v),
            }
        }
    }
}

/// A thread's workspace for the rays of one tile.
#[derive(Default)]
struct Tile {
    rays: Vec<Ray>,
    hits: Vec<Option<Hit>>,
    /// The colours of the tile's pixels, row by row: the result.
    pixels: Vec<DVec3>,
}

impl Tile {
    /// Finds the colours of a tile's pixels and returns how many rays hit something.
    fn trace(&mut self, renderer: &Renderer, view: &View, columns: Range<u32>, rows: Range<u32>) -> u64 {
        let samples = view.size().samples;
        self.rays.clear();
        self.pixels.clear();
        let pixels = rows.flat_map(|row| columns.clone().map(move |column| (column, row)));
        for (column, row) in pixels {
            let parts = (0..samples).flat_map(|y| (0..samples).map(move |x| (x, y)));
            let cells = parts.map(|(x, y)| (column * samples + x, row * samples + y));
            self.rays.extend(cells.map(|(column, row)| view.ray(column, row)));
        }
        self.hits.clear();
        self.hits.resize(self.rays.len(), None);
        renderer.tree.closest_batch(&self.rays, AHEAD, &mut self.hits);

        // Each sample is clamped before the mean, so that one bright highlight does not outshine its pixel.
        let per_pixel = (samples * samples) as usize;
        for (rays, hits) in self.rays.chunks_exact(per_pixel).zip(self.hits.chunks_exact(per_pixel)) {
            let sum: DVec3 = rays.iter().zip(hits).map(|(ray, hit)| clamp(renderer.color(ray, *hit))).sum();
            self.pixels.push(sum / f64::from(samples * samples));
        }
        self.hits.iter().flatten().count() as u64
    }
}
