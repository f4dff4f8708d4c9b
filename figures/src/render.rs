//! From a scene to pixels: rays, the closest hit of each, its colour, and the mean of the colours in a pixel.
//!
//! The picture is cut into bands of rows that rayon hands to threads, each band into tiles whose rays go through
//! the tree together. A pixel's value depends on nothing but its own rays, summed in a fixed order, so the bytes are
//! the same for any number of threads.

use std::mem::take;
use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;
use rt_geom::{Hit, Ray, Shape};
use rt_shade::color::{clamp, interpolate, to_sample};
use rt_shade::{SurfacePoint, phong_batch, texture_uv};

use crate::camera::{Size, View};
use crate::objects::{Method, Objects};
use crate::scene::{DEFAULT_MATERIAL, Filter, Look, LookPlace, Paint, Scene};

/// The size of a tile in pixels: its rays are close enough together to visit the same nodes of the tree, and many
/// enough to be worth a call.
const TILE_WIDTH: u32 = 32;
const TILE_HEIGHT: u32 = 8;
/// The most rays of a tile, so that a thread's workspace is some 20 MB at most: with many samples in a pixel a tile is
/// narrower.
const TILE_RAYS: u32 = 1 << 16;

/// A scene made ready for rays: its objects in a tree.
#[derive(Debug)]
pub struct Renderer {
    /// All but its spheres and triangles.
    scene: Scene,
    objects: Objects,
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
    /// Builds the fast tree over the scene's objects.
    pub fn new(scene: Scene) -> Self {
        Self::with(scene, Method::Bvh)
    }

    /// Makes the scene's objects ready to be found in another way; the pictures are the same.
    pub fn with(mut scene: Scene, method: Method) -> Self {
        let objects = Objects::new(method, take(&mut scene.spheres), take(&mut scene.triangles));
        Self { scene, objects }
    }

    /// Draws the given rows of a picture, samples in `0..=maxval`.
    ///
    /// `advance` is called from any thread with the number of rows that have just been done.
    pub fn rows(&self, view: &View, rows: Range<u32>, maxval: u16, advance: &(dyn Fn(u64) + Sync)) -> Rows {
        let Size { width, samples, .. } = view.size();
        let row_length = 3 * width as usize;
        let tile_width = (TILE_RAYS / TILE_HEIGHT / samples / samples).clamp(1, TILE_WIDTH);
        let mut picture = vec![0; row_length * rows.len()];
        let hits = (rows.clone().into_par_iter().step_by(TILE_HEIGHT as usize))
            .zip(picture.par_chunks_mut(row_length * TILE_HEIGHT as usize))
            .map_init(RayTile::default, |tile, (top, band)| {
                let bottom = rows.end.min(top + TILE_HEIGHT);
                let mut hits = 0;
                for left in (0..width).step_by(tile_width as usize) {
                    let right = width.min(left + tile_width);
                    hits += tile.trace(self, view, left..right, top..bottom);
                    for (tile_row, line) in
                        tile.pixels.chunks_exact((right - left) as usize).zip(band.chunks_exact_mut(row_length))
                    {
                        for (color, pixel) in tile_row.iter().zip(line[3 * left as usize..].chunks_exact_mut(3)) {
                            pixel.copy_from_slice(&color.to_array().map(|channel| to_sample(channel, maxval)));
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
    pub fn color(&self, ray: &Ray, hit: Option<Hit>) -> DVec3 {
        hit.map_or(self.scene.background, |hit| self.seen(ray, hit).shaded(&self.scene.lights))
    }

    /// The point that a ray hits.
    fn seen(&self, ray: &Ray, hit: Hit) -> SurfacePoint<'_> {
        let Hit { index, t } = hit;
        let (point, direction) = (ray.at(t), ray.direction());
        match self.objects.shape(index) {
            Shape::Sphere(sphere) => {
                // A sphere of radius 0 faces the eye.
                let normal = if sphere.radius() > 0.0 { sphere.normal(point) } else { -direction };
                let (surface, material) = match self.scene.sphere_looks[index].place() {
                    LookPlace::Color(at) => (self.scene.colors[at], &DEFAULT_MATERIAL),
                    LookPlace::Look(at) => {
                        let Look { paint, material } = &self.scene.looks[at];
                        (paint_at(paint, normal), material)
                    }
                };
                SurfacePoint { point, direction, normal, surface, material }
            }
            Shape::Triangle(triangle) => {
                let index = index - self.scene.sphere_looks.len();
                let look = self.scene.look(self.scene.triangle_looks[index]);
                let Look { paint, material } = look.expect("a triangle has a look");
                let colors = self.scene.vertex_colors.get(index).and_then(Option::as_ref);
                let surface = match (colors, paint) {
                    (Some(colors), _) => {
                        triangle.hit_barycentric(ray).map_or(colors[0], |weights| interpolate(colors, weights))
                    }
                    (None, Paint::Color(color)) => *color,
                    (None, Paint::Image { .. }) => unreachable!("a triangle's look has a color"),
                };
                let normal = triangle.normal().unwrap_or(-direction);
                SurfacePoint { point, direction, normal, surface, material }
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
struct RayTile<'a> {
    /// The directions to the columns of samples, and what to add to them for the rows.
    across: Vec<DVec3>,
    down: Vec<DVec3>,
    rays: Vec<Ray>,
    hits: Vec<Option<Hit>>,
    /// What the rays see, and in which colours, without those that see nothing.
    seen: Vec<SurfacePoint<'a>>,
    colors: Vec<DVec3>,
    /// The colours of the tile's pixels, row by row: the result.
    pixels: Vec<DVec3>,
}

impl<'a> RayTile<'a> {
    /// Finds the colours of a tile's pixels and returns how many rays hit something.
    fn trace(&mut self, renderer: &'a Renderer, view: &View, columns: Range<u32>, rows: Range<u32>) -> u64 {
        let samples = view.size().samples;
        self.rays.clear();
        self.across.clear();
        self.across.extend((samples * columns.start..samples * columns.end).map(|column| view.across(column)));
        for row in rows {
            self.down.clear();
            self.down.extend((samples * row..samples * (row + 1)).map(|row| view.down(row)));
            for across in self.across.chunks_exact(samples as usize) {
                for &down in &self.down {
                    self.rays.extend(across.iter().map(|&across| view.ray_through(across, down)));
                }
            }
        }
        self.hits.clear();
        self.hits.resize(self.rays.len(), None);
        renderer.objects.closest_batch(&self.rays, &mut self.hits);

        self.seen.clear();
        let met = self.rays.iter().zip(&self.hits).filter_map(|(ray, hit)| hit.map(|hit| (ray, hit)));
        self.seen.extend(met.map(|(ray, hit)| renderer.seen(ray, hit)));
        self.colors.resize(self.seen.len(), DVec3::ZERO);
        phong_batch(&self.seen, &renderer.scene.lights, &mut self.colors);

        // Each sample is clamped before the mean, so that one bright highlight does not outshine its pixel.
        self.pixels.clear();
        let mut colors = self.colors.iter();
        let mut color = |hit: &Option<Hit>| {
            clamp(if hit.is_some() { *colors.next().expect("one for each hit") } else { renderer.scene.background })
        };
        for hits in self.hits.chunks_exact((samples * samples) as usize) {
            let sum: DVec3 = hits.iter().map(&mut color).sum();
            self.pixels.push(sum / f64::from(samples * samples));
        }
        self.seen.len() as u64
    }
}
