//! The fast tree: sixteen children a node, boxes above blocks of balls, culled in f32 sixteen at a time.
//!
//! `build` makes it, `node.rs` says how it lies in memory, `walk.rs` takes one ray through it and `batch.rs` many;
//! `tiles.rs` finds rays of one origin that `tile_walk.rs` takes through it together, with the cull of `tile.rs`.
//! Where sizes are too far apart for one frame, which `crowd.rs` tells, `groups.rs` parts them, and `crown.rs` stands
//! above the parts.
//! The cull (`cull.rs`) may keep too much and never drops a hit; the exact kernels of the primitives decide.

mod batch;
mod build;
mod crowd;
mod crown;
mod cull;
mod groups;
mod node;
mod tile;
mod tile_walk;
mod tiles;
mod walk;

use std::ops::Range;

use fearless_simd::Level;

use crate::leaf::{Any, Closest, Leaves, Query};
use crate::simd::dispatch;
use crate::{Hit, Ray, Shape, Sphere, Triangle, Visits, enclosing_sphere};
use batch::fly;
use crown::Crown;
use node::{Balls, Boxes, Node, Region};
use walk::cast;

/// The tree to cast rays with: answers equal the plain loop's, bit for bit.
///
/// A query usually takes time in the order of the logarithm of the number of primitives. It takes time in proportion to
/// their number where bounds cannot part them: where many distinct primitives share a point that the ray passes, as a
/// fan of triangles does or spheres with one center. Equal primitives cost no more than one of them: the lowest index
/// answers. However different sizes and distances are, each part of the scene is bounded as finely as if it were alone.
/// A ray that starts beyond 2^42 radii from such a part, or whose direction is so long or so short that one unit of `t`
/// in radii of it is not a normal double, meets all of it once it meets its box.
///
/// ```
/// use rt_geom::{AHEAD, Bvh, Hit, Ray, Sphere, Triangle};
///
/// let ball = Sphere::new([0.0, 0.0, 5.0], 1.0).unwrap();
/// let wall = Triangle::new([-9.0, -9.0, 9.0], [9.0, -9.0, 9.0], [0.0, 9.0, 9.0]).unwrap();
/// let tree = Bvh::new(vec![ball], vec![wall]);
///
/// let ray = Ray::new([0.0; 3], [0.0, 0.0, 1.0]).unwrap();
/// assert_eq!(tree.closest(&ray, AHEAD), Some(Hit { index: 0, t: 4.0 }));
/// assert_eq!(tree.closest(&ray, 7.0..f64::INFINITY), Some(Hit { index: 1, t: 9.0 }));
/// assert!(!tree.any(&ray, 0.0..4.0));
/// ```
#[derive(Clone, Debug)]
pub struct Bvh {
    leaves: Leaves,
    nodes: Vec<Node>,
    sphere_blocks: Vec<Balls>,
    triangle_blocks: Vec<Boxes>,
    /// One, or any number below a crown; none in an empty tree.
    regions: Vec<Region>,
    crown: Option<Crown>,
    /// How many pending entries a walk can need.
    stack: usize,
    level: Level,
    /// Whether rays of a batch that make no tile are on their way together, and not one after the other.
    flies: bool,
}

/// With more primitives than this, what walks read is not in the last level of the cache.
///
/// Up to there, rays together win with AVX-512 alone. On a Zen 3 with AVX2 (32 MiB of cache) they took 0.8 to 1.35 times
/// as long as one after the other up to 100,000 spheres, most of all among stars; 0.9 to 1.05 times at 200,000; and 0.6 to
/// 1 times from 400,000 on. Of SSE2 and NEON alone this was not measured. No answer depends on it.
const CACHED: usize = 1 << 18;

/// Whether rays together are faster, in a tree of so many primitives.
fn flies(level: Level, count: usize) -> bool {
    is_wide(level) || count > CACHED
}

/// Whether vectors have 512 bits.
#[cfg(target_arch = "x86_64")]
fn is_wide(level: Level) -> bool {
    level.as_avx512().is_some()
}

/// Whether vectors have 512 bits.
#[cfg(not(target_arch = "x86_64"))]
fn is_wide(_: Level) -> bool {
    false
}

impl Bvh {
    /// Builds the tree, in parallel on rayon's current pool. Any input will do, also none at all.
    ///
    /// # Panics
    /// With 2^32 primitives or more.
    #[must_use]
    pub fn new(spheres: Vec<Sphere>, triangles: Vec<Triangle>) -> Self {
        let count = spheres.len() + triangles.len();
        assert!(u32::try_from(count).is_ok(), "a tree holds fewer than 2^32 primitives, not {count}");
        let (trunk, crown) = groups::grow(spheres, triangles);
        let trunk = trunk.finish();
        let mut index = trunk.spheres.index;
        index.reserve_exact(trunk.triangles.index.len());
        index.extend(trunk.triangles.index);
        let leaves = Leaves::new(trunk.spheres.leaves, trunk.triangles.leaves, index).with_twins(trunk.twins);
        let level = Level::new();
        Self {
            leaves,
            nodes: trunk.nodes,
            sphere_blocks: trunk.spheres.blocks,
            triangle_blocks: trunk.triangles.blocks,
            regions: trunk.regions,
            crown,
            stack: trunk.stack,
            level,
            flies: flies(level, count),
        }
    }

    /// How many primitives the tree holds.
    #[must_use]
    pub fn len(&self) -> usize {
        self.leaves.len()
    }

    /// Whether it holds none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the primitive with this index: spheres as listed, then triangles as listed.
    ///
    /// # Panics
    /// If `index >= self.len()`.
    #[must_use]
    pub fn shape(&self, index: usize) -> Shape {
        self.leaves.shape(index)
    }

    /// The same tree with another instruction set: `"sse2"`, `"avx2"`, `"avx512"` or `"neon"`; `None` if this CPU lacks
    /// it. Rays of a batch are on their way together whatever is faster. For tests and benches: every set gives the same
    /// answers.
    #[doc(hidden)]
    #[must_use]
    pub fn with_simd(mut self, name: &str) -> Option<Self> {
        let best = Level::new();
        self.level = match name {
            #[cfg(target_arch = "x86_64")]
            "sse2" => Level::Sse2(best.as_sse2()?),
            #[cfg(target_arch = "x86_64")]
            "avx2" => Level::Avx2(best.as_avx2()?),
            #[cfg(target_arch = "x86_64")]
            "avx512" => Level::Avx512(best.as_avx512()?),
            #[cfg(target_arch = "aarch64")]
            "neon" => Level::Neon(best.as_neon()?),
            _ => return None,
        };
        self.flies = true;
        Some(self)
    }

    /// Returns the closest hit with its `t` in the range: the smallest `t`, and of equal `t` the lowest index.
    #[must_use]
    pub fn closest(&self, ray: &Ray, within: Range<f64>) -> Option<Hit> {
        self.query(ray, within, Closest::default(), &mut Visits::default())
    }

    /// As [`closest`](Self::closest), with what the query did.
    #[must_use]
    pub fn closest_counted(&self, ray: &Ray, within: Range<f64>) -> (Option<Hit>, Visits) {
        let mut visits = Visits::default();
        (self.query(ray, within, Closest::default(), &mut visits), visits)
    }

    /// Returns whether anything is hit with its `t` in the range.
    #[must_use]
    pub fn any(&self, ray: &Ray, within: Range<f64>) -> bool {
        self.query(ray, within, Any::default(), &mut Visits::default())
    }

    /// Writes the closest hit of each ray, bit for bit what [`closest`](Self::closest) returns.
    ///
    /// Rays on their way together wait for memory together: up to 1.5 times the rays a second of single ones. Without
    /// AVX-512 they go one after the other in trees of up to 2^18 primitives, where that is as fast. Rays from one
    /// point through neighbouring pixels walk the tree together, two to five times as many a second: in one slice the rays
    /// of a picture's rows, eight rows and more best, or of its tiles one after the other.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn closest_batch(&self, rays: &[Ray], within: Range<f64>, hits: &mut [Option<Hit>]) {
        self.closest_of_all(rays, &within, hits);
    }

    /// Writes for each ray whether it hits anything.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn any_batch(&self, rays: &[Ray], within: Range<f64>, hits: &mut [bool]) {
        self.batch::<Any>(rays, &within, hits);
    }

    #[inline(never)]
    pub(crate) fn query<Q: Query>(&self, ray: &Ray, within: Range<f64>, query: Q, visits: &mut Visits) -> Q::Answer {
        // Two numbers: a copy of the range would load both at once, and wait until either is stored.
        let Range { start, end } = within;
        dispatch!(self.level, simd => cast::<_, Q>(simd, self, ray, (start, end), query, visits))
    }

    #[inline(never)]
    fn closest_of_all(&self, rays: &[Ray], within: &Range<f64>, answers: &mut [Option<Hit>]) {
        assert_eq!(rays.len(), answers.len(), "one place for the answer to each ray");
        dispatch!(self.level, simd => tiles::closest_batch(simd, self, rays, within, answers));
    }

    #[inline(never)]
    pub(crate) fn batch<Q: Query>(&self, rays: &[Ray], within: &Range<f64>, answers: &mut [Q::Answer]) {
        assert_eq!(rays.len(), answers.len(), "one place for the answer to each ray");
        if self.flies {
            dispatch!(self.level, simd => fly::<_, Q>(simd, self, rays, None, within, answers));
        } else {
            self.one_by_one::<Q>(rays, 0..rays.len(), within, answers);
        }
    }

    /// Answers a query for the rays at some places, one after the other.
    fn one_by_one<Q: Query>(
        &self,
        rays: &[Ray],
        places: impl Iterator<Item = usize>,
        within: &Range<f64>,
        answers: &mut [Q::Answer],
    ) {
        for place in places {
            let query = Q::begin(&mut answers[place]);
            answers[place] = self.query(&rays[place], within.clone(), query, &mut Visits::default());
        }
    }
}

/// A sphere around everything, minimal for spheres alone.
fn scene_sphere(spheres: &[Sphere], triangles: &[Triangle]) -> Option<Sphere> {
    let minimal = |spheres: &[Sphere]| enclosing_sphere(spheres).map(|enclosing| enclosing.sphere);
    let corner = |v| Sphere::new(v, 0.0).expect("vertices are finite");
    let corners = || -> Vec<Sphere> { triangles.iter().flat_map(Triangle::vertices).map(corner).collect() };
    match (spheres, triangles) {
        (_, []) => minimal(spheres),
        ([], _) => minimal(&corners()),
        _ => minimal(&[minimal(spheres)?, minimal(&corners())?]),
    }
}
