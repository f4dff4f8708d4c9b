//! From a scene to pixels: rays, the closest hit of each, its colour, and the mean of the colours in a pixel, certified.
//!
//! The picture is cut into bands of rows that rayon hands to threads, each band into tiles whose rays go through
//! the tree together. A pixel's value depends on nothing but its own rays, summed in a fixed order, so the bytes are
//! the same for any number of threads.

use std::mem::take;
use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;
use rt_geom::{Hit, Ray};
use rt_shade::{Shaded, SurfacePoint, phong, phong_batch};

use crate::camera::{Size, View};
use crate::certify::{Certified, Certifier};
use crate::objects::{Method, Objects};
use crate::scene::Scene;
use crate::seen::Seen;

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
    /// RGB samples, row by row from the top; RGBA if the scene has no background.
    pub samples: Vec<u16>,
    /// Rays that were sent.
    pub rays: u64,
    /// Rays that met an object.
    pub hits: u64,
    /// What decided the samples.
    pub certified: Certified,
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
        let channels = if self.scene.transparent { 4 } else { 3 };
        let row_length = channels * width as usize;
        let tile_width = (TILE_RAYS / TILE_HEIGHT / samples / samples).clamp(1, TILE_WIDTH);
        let mut picture = vec![0; row_length * rows.len()];
        let (hits, certified) = (rows.clone().into_par_iter().step_by(TILE_HEIGHT as usize))
            .zip(picture.par_chunks_mut(row_length * TILE_HEIGHT as usize))
            .map_init(RayTile::default, |tile, (top, band)| {
                let bottom = rows.end.min(top + TILE_HEIGHT);
                let (mut hits, mut certifier) = (0, self.certifier(maxval));
                for left in (0..width).step_by(tile_width as usize) {
                    let right = width.min(left + tile_width);
                    hits += tile.trace(self, view, left..right, top..bottom, &mut certifier);
                    for (tile_row, line) in
                        tile.pixels.chunks_exact((right - left) as usize).zip(band.chunks_exact_mut(row_length))
                    {
                        let pixels = line[channels * left as usize..].chunks_exact_mut(channels);
                        for ((samples, alpha), pixel) in tile_row.iter().zip(pixels) {
                            pixel[..3].copy_from_slice(samples);
                            pixel[3..].fill(*alpha);
                        }
                    }
                }
                advance(u64::from(bottom - top));
                (hits, certifier.counts)
            })
            .reduce(Default::default, |a: (u64, Certified), b| (a.0 + b.0, a.1.plus(b.1)));
        let rays = u64::from(width) * rows.len() as u64 * u64::from(samples) * u64::from(samples);
        Rows { samples: picture, rays, hits, certified }
    }

    /// The certified samples of a pixel with the one ray, which hits this, in `0..=maxval`.
    pub fn sample(&self, ray: &Ray, hit: Option<Hit>, maxval: u16) -> [u16; 3] {
        let shaded = hit.map(|hit| phong(&self.seen(ray, hit).estimated(), &self.scene.lights));
        self.certifier(maxval).pixel(&[*ray], &[hit], shaded.as_slice())
    }

    fn seen<'ray>(&self, ray: &'ray Ray, hit: Hit) -> Seen<'_, 'ray> {
        Seen::new(&self.scene, &self.objects, ray, hit)
    }

    fn certifier(&self, maxval: u16) -> Certifier<'_> {
        Certifier { scene: &self.scene, objects: &self.objects, maxval, counts: Certified::default() }
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
    shaded: Vec<Shaded>,
    /// The tile's pixels, row by row, each with its alpha: the result.
    pixels: Vec<([u16; 3], u16)>,
}

impl<'a> RayTile<'a> {
    /// Finds the samples of a tile's pixels and returns how many rays hit something.
    fn trace(
        &mut self,
        renderer: &'a Renderer,
        view: &View,
        columns: Range<u32>,
        rows: Range<u32>,
        certifier: &mut Certifier,
    ) -> u64 {
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

        let met = self.rays.iter().zip(&self.hits).filter_map(|(ray, hit)| hit.map(|hit| (ray, hit)));
        let lights = &renderer.scene.lights;
        self.shaded.clear();
        if lights.is_empty() {
            self.shaded.extend(met.map(|(ray, hit)| {
                let seen = renderer.seen(ray, hit);
                seen.flat().unwrap_or_else(|| phong(&seen.estimated(), lights))
            }));
        } else {
            self.seen.clear();
            self.seen.extend(met.map(|(ray, hit)| renderer.seen(ray, hit).estimated()));
            self.shaded.resize(self.seen.len(), Shaded { color: DVec3::ZERO, error: f64::INFINITY });
            phong_batch(&self.seen, lights, &mut self.shaded);
            let met = self.rays.iter().zip(&self.hits).filter_map(|(ray, hit)| hit.map(|hit| (ray, hit)));
            for (((ray, hit), point), shaded) in met.zip(&self.seen).zip(&mut self.shaded) {
                // A side is open: that of a light in the plane of a surface, say.
                if !shaded.is_known() {
                    *shaded = renderer.seen(ray, hit).sided(point, lights);
                }
            }
        }

        self.pixels.clear();
        let mut shaded = &self.shaded[..];
        let in_pixel = (samples * samples) as usize;
        for (rays, hits) in self.rays.chunks_exact(in_pixel).zip(self.hits.chunks_exact(in_pixel)) {
            let (now, later) = shaded.split_at(hits.iter().flatten().count());
            shaded = later;
            let alpha = if certifier.scene.transparent { share(now.len(), in_pixel, certifier.maxval) } else { 0 };
            self.pixels.push((certifier.pixel(rays, hits, now), alpha));
        }
        self.shaded.len() as u64
    }
}

/// `⌊maxval hits / rays + ½⌋`: the alpha of a pixel.
fn share(hits: usize, rays: usize, maxval: u16) -> u16 {
    let (hits, rays) = (hits as u64, rays as u64);
    u16::try_from((2 * u64::from(maxval) * hits + rays) / (2 * rays)).expect("a share of maxval")
}
