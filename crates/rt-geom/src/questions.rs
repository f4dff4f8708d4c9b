//! What a mesh is asked: every hit in order, crossings, and whether a point is inside.
//!
//! The same on the fast tree and on a plain [`List`]: one obvious loop, the tree's oracle.

use std::collections::HashMap;
use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use crate::crossings::{self, Crossing};
use crate::leaf::{Leaf, Leaves, Query, Surrounds};
use crate::ray::{PreparedRay, is_open};
use crate::{Bvh, Hit, Ray, Shape, Side, Sphere, Triangle, Visits};

/// The ray's own range: from its origin on, without end.
pub const AHEAD: Range<f64> = 0.0..f64::INFINITY;

/// The direction in which [`Bvh::contains`] counts: any will do; this one is rarely along a face.
const DIRECTION: DVec3 = DVec3::new(0.539_503_1, 0.614_770_9, 0.575_331_3);

/// Questions that a thread takes at once.
const BATCH: usize = 1024;

/// Spheres and triangles in the order in which they are listed: every question asks them all.
#[derive(Clone, Debug, Default)]
pub struct List {
    /// The spheres; their indices come first.
    pub spheres: Vec<Sphere>,
    /// The triangles.
    pub triangles: Vec<Triangle>,
}

/// An edge of a mesh that is not closed: it lies in an odd number of triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenEdge {
    /// Its two ends.
    pub ends: [DVec3; 2],
    /// The index, among the triangles, of one in which it lies.
    pub triangle: usize,
}

/// Gathers every hit.
struct Hits {
    found: Vec<Hit>,
}

impl Query for Hits {
    type Answer = Vec<Hit>;

    fn begin(place: &mut Vec<Hit>) -> Self {
        place.clear();
        Self { found: std::mem::take(place) }
    }

    fn meet<const FMA: bool, L: Leaf>(&mut self, leaf: &L, place: usize, leaves: &Leaves, ray: &PreparedRay) {
        leaf.each_hit(ray, |t| self.found.extend(leaves.indices(place).map(|index| Hit { index, t })));
    }

    fn answer(&mut self, _: &Leaves, _: &PreparedRay) -> Vec<Hit> {
        sort_hits(&mut self.found);
        std::mem::take(&mut self.found)
    }
}

/// Gathers every crossing.
struct Crossings {
    found: Vec<Crossing>,
}

impl Query for Crossings {
    type Answer = Vec<Crossing>;

    fn begin(place: &mut Vec<Crossing>) -> Self {
        place.clear();
        Self { found: std::mem::take(place) }
    }

    fn meet<const FMA: bool, L: Leaf>(&mut self, leaf: &L, place: usize, leaves: &Leaves, ray: &PreparedRay) {
        leaf.each_crossing(ray.ray, |pass| {
            self.found.extend(leaves.indices(place).map(|index| Crossing::new(index, pass)));
        });
    }

    fn answer(&mut self, leaves: &Leaves, ray: &PreparedRay) -> Vec<Crossing> {
        crossings::sort(&mut self.found, ray.ray, |index| leaves.shape(index));
        std::mem::take(&mut self.found)
    }
}

/// How many hits there are.
#[derive(Default)]
struct Count(usize);

impl Query for Count {
    type Answer = usize;

    fn begin(_: &mut usize) -> Self {
        Self::default()
    }

    fn meet<const FMA: bool, L: Leaf>(&mut self, leaf: &L, place: usize, leaves: &Leaves, ray: &PreparedRay) {
        leaf.each_hit(ray, |_| self.0 += leaves.indices(place).count());
    }

    fn answer(&mut self, _: &Leaves, _: &PreparedRay) -> usize {
        self.0
    }
}

/// Counts what surrounds the ray's origin.
#[derive(Default)]
struct Around {
    on: bool,
    within: bool,
    odd: bool,
}

impl Around {
    fn add(&mut self, surrounds: Surrounds) {
        match surrounds {
            Surrounds::No => {}
            Surrounds::On => self.on = true,
            Surrounds::Within => self.within = true,
            Surrounds::Crossed => self.odd = !self.odd,
        }
    }

    fn side(&self) -> Side {
        if self.on {
            Side::On
        } else if self.within || self.odd {
            Side::Inside
        } else {
            Side::Outside
        }
    }
}

impl Query for Around {
    type Answer = Option<Side>;

    fn begin(_: &mut Option<Side>) -> Self {
        Self::default()
    }

    fn is_settled(&self) -> bool {
        self.on
    }

    fn meet<const FMA: bool, L: Leaf>(&mut self, leaf: &L, place: usize, leaves: &Leaves, ray: &PreparedRay) {
        let surrounds = leaf.surrounds(ray.ray);
        for _ in leaves.indices(place) {
            self.add(surrounds);
        }
    }

    fn answer(&mut self, _: &Leaves, _: &PreparedRay) -> Option<Side> {
        Some(self.side())
    }
}

fn sort_hits(hits: &mut [Hit]) {
    hits.sort_unstable_by(|a, b| a.t.total_cmp(&b.t).then(a.index.cmp(&b.index)));
}

/// The ray that counts for a point; `None` for a point that is not finite.
fn counting_ray(point: DVec3) -> Option<Ray> {
    Ray::new(point, DIRECTION).ok()
}

impl Bvh {
    /// Writes every hit with its `t` in the range, in ascending order of `t`, and of equal `t` by index; so the first is
    /// [`closest`](Self::closest)'s answer.
    ///
    /// A sphere gives both its roots, one where the ray touches it; both triangles of a shared edge are listed. What was
    /// in the buffer is gone; nothing is allocated but what it needs.
    ///
    /// ```
    /// use glam::DVec3;
    /// use rt_geom::{AHEAD, Bvh, Ray, Sphere};
    ///
    /// let balls = [3.0, 6.0].map(|z| Sphere::new(DVec3::new(0.0, 0.0, z), 1.0).unwrap());
    /// let tree = Bvh::new(balls.to_vec(), vec![]);
    /// let mut hits = Vec::new();
    /// tree.hits(&Ray::new(DVec3::ZERO, DVec3::Z).unwrap(), AHEAD, &mut hits);
    /// assert_eq!(hits.iter().map(|hit| (hit.index, hit.t)).collect::<Vec<_>>(), [(0, 2.0), (0, 4.0), (1, 5.0), (1, 7.0)]);
    /// ```
    pub fn hits(&self, ray: &Ray, within: Range<f64>, hits: &mut Vec<Hit>) {
        *hits = self.query(ray, within, Hits::begin(hits), &mut Visits::default());
    }

    /// [`hits`](Self::hits) of each ray, in parallel on rayon's current pool.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn hits_batch(&self, rays: &[Ray], within: Range<f64>, hits: &mut [Vec<Hit>]) {
        assert_eq!(rays.len(), hits.len(), "one list for the hits of each ray");
        let parts = rays.par_chunks(BATCH).zip(hits.par_chunks_mut(BATCH));
        parts.for_each(|(rays, hits)| self.batch::<Hits>(rays, &within, hits));
    }

    /// Returns how many [`hits`](Self::hits) there are: each root of a sphere, each triangle of a shared edge.
    ///
    /// Nothing is allocated. What a closed surface makes of a ray is the number of [`crossings`](Self::crossings).
    #[must_use]
    pub fn count(&self, ray: &Ray, within: Range<f64>) -> usize {
        self.query(ray, within, Count::default(), &mut Visits::default())
    }

    /// [`count`](Self::count) of each ray, in parallel on rayon's current pool.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn count_batch(&self, rays: &[Ray], within: Range<f64>, counts: &mut [usize]) {
        assert_eq!(rays.len(), counts.len(), "one place for the count of each ray");
        let parts = rays.par_chunks(BATCH).zip(counts.par_chunks_mut(BATCH));
        parts.for_each(|(rays, counts)| self.batch::<Count>(rays, &within, counts));
    }

    /// Writes where the turned ray of [`Triangle::crosses`] crosses surfaces, in its exact order.
    ///
    /// Entering and leaving alternate for each closed surface, however the ray as given passes through edges, vertices
    /// and along faces. An origin on a surface is judged just ahead of it on the turned ray. A sphere of radius 0 is
    /// never crossed. Crossings that stay together on the turned ray, as those of equal primitives, come by index.
    ///
    /// ```
    /// use glam::DVec3;
    /// use rt_geom::{Bvh, Ray, Triangle};
    ///
    /// // A tetrahedron, seen from outside its normals; the ray passes through a vertex and an edge.
    /// let [o, x, y, z] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    /// let faces = [[o, y, x], [o, x, z], [o, z, y], [x, y, z]].map(|[a, b, c]| Triangle::new(a, b, c).unwrap());
    /// let tree = Bvh::new(vec![], faces.to_vec());
    /// let ray = Ray::new(DVec3::splat(-1.0), DVec3::ONE).unwrap();
    /// let mut crossings = Vec::new();
    /// tree.crossings(&ray, &mut crossings);
    /// assert_eq!(crossings.iter().map(|crossing| crossing.entering).collect::<Vec<_>>(), [true, false]);
    /// ```
    pub fn crossings(&self, ray: &Ray, crossings: &mut Vec<Crossing>) {
        *crossings = self.query(ray, AHEAD, Crossings::begin(crossings), &mut Visits::default());
    }

    /// [`crossings`](Self::crossings) of each ray, in parallel on rayon's current pool.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn crossings_batch(&self, rays: &[Ray], crossings: &mut [Vec<Crossing>]) {
        assert_eq!(rays.len(), crossings.len(), "one list for the crossings of each ray");
        let parts = rays.par_chunks(BATCH).zip(crossings.par_chunks_mut(BATCH));
        parts.for_each(|(rays, crossings)| self.batch::<Crossings>(rays, &AHEAD, crossings));
    }

    /// Returns whether a point is inside, exactly: all triangles are one surface, and each sphere is its own.
    ///
    /// [`Side::On`] where the point lies on any closed triangle or sphere; else [`Side::Inside`] where it is in any
    /// sphere, or where an odd number of triangles is crossed on the way out; else [`Side::Outside`], also for a point
    /// that is not finite. Of triangles that are not closed ([`open_edges`](Self::open_edges)) this is no more than the
    /// parity in one direction.
    ///
    /// ```
    /// use glam::DVec3;
    /// use rt_geom::{Bvh, Side, Triangle};
    ///
    /// let [o, x, y, z] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    /// let faces = [[o, y, x], [o, x, z], [o, z, y], [x, y, z]].map(|[a, b, c]| Triangle::new(a, b, c).unwrap());
    /// let tree = Bvh::new(vec![], faces.to_vec());
    /// assert!(tree.open_edges().is_empty());
    /// assert_eq!(tree.contains(DVec3::splat(0.25)), Side::Inside);
    /// assert_eq!(tree.contains(DVec3::new(0.25, 0.25, 0.5)), Side::On);
    /// assert_eq!(tree.contains(DVec3::new(0.25, 0.25, 0.5f64.next_up())), Side::Outside);
    /// ```
    #[must_use]
    pub fn contains(&self, point: impl Into<DVec3>) -> Side {
        let ray = counting_ray(point.into());
        let side = ray.and_then(|ray| self.query(&ray, AHEAD, Around::default(), &mut Visits::default()));
        side.unwrap_or(Side::Outside)
    }

    /// Writes whether each point is inside, in parallel on rayon's current pool.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn contains_batch(&self, points: &[DVec3], sides: &mut [Side]) {
        assert_eq!(points.len(), sides.len(), "one place for the answer to each point");
        let nowhere = counting_ray(DVec3::ZERO).expect("zero is finite");
        points.par_chunks(BATCH).zip(sides.par_chunks_mut(BATCH)).for_each(|(points, sides)| {
            let rays: Vec<Ray> = points.iter().map(|&point| counting_ray(point).unwrap_or(nowhere)).collect();
            let mut answers = vec![None; rays.len()];
            self.batch::<Around>(&rays, &AHEAD, &mut answers);
            for ((side, answer), point) in sides.iter_mut().zip(answers).zip(points) {
                *side = answer.filter(|_| point.is_finite()).unwrap_or(Side::Outside);
            }
        });
    }

    /// The edges in which the triangles are not closed, as [`open_edges`].
    #[must_use]
    pub fn open_edges(&self) -> Vec<OpenEdge> {
        let triangles: Vec<Triangle> = (0..self.len())
            .filter_map(|index| if let Shape::Triangle(triangle) = self.shape(index) { Some(triangle) } else { None })
            .collect();
        open_edges(&triangles)
    }
}

impl List {
    fn each(&self, mut ask: impl FnMut(usize, Shape)) {
        let shapes = self.spheres.iter().map(|&sphere| Shape::Sphere(sphere));
        let shapes = shapes.chain(self.triangles.iter().map(|&triangle| Shape::Triangle(triangle)));
        shapes.enumerate().for_each(|(index, shape)| ask(index, shape));
    }

    /// What [`Bvh::shape`] returns.
    ///
    /// # Panics
    /// If there is no such primitive.
    #[must_use]
    pub fn shape(&self, index: usize) -> Shape {
        match self.spheres.get(index) {
            Some(&sphere) => Shape::Sphere(sphere),
            None => Shape::Triangle(self.triangles[index - self.spheres.len()]),
        }
    }

    /// What [`Bvh::closest`] returns.
    #[must_use]
    pub fn closest(&self, ray: &Ray, within: Range<f64>) -> Option<Hit> {
        let mut best: Option<Hit> = None;
        self.each(|index, shape| {
            let t = match shape {
                Shape::Sphere(sphere) => sphere.closest(ray, within.clone()),
                Shape::Triangle(triangle) => triangle.closest(ray, within.clone()),
            };
            if let Some(t) = t
                && best.is_none_or(|best| t.total_cmp(&best.t).is_lt())
            {
                best = Some(Hit { index, t });
            }
        });
        best
    }

    /// What [`Bvh::any`] returns.
    #[must_use]
    pub fn any(&self, ray: &Ray, within: Range<f64>) -> bool {
        self.closest(ray, within).is_some()
    }

    fn each_hit(&self, ray: &Ray, within: Range<f64>, mut found: impl FnMut(Hit)) {
        if !is_open(&within) {
            return;
        }
        let prepared = PreparedRay::new(ray, within);
        self.each(|index, shape| {
            let found = |t| found(Hit { index, t });
            match shape {
                Shape::Sphere(sphere) => sphere.each_hit(&prepared, found),
                Shape::Triangle(triangle) => triangle.each_hit(&prepared, found),
            }
        });
    }

    /// What [`Bvh::hits`] writes.
    pub fn hits(&self, ray: &Ray, within: Range<f64>, hits: &mut Vec<Hit>) {
        hits.clear();
        self.each_hit(ray, within, |hit| hits.push(hit));
        sort_hits(hits);
    }

    /// What [`Bvh::count`] returns.
    #[must_use]
    pub fn count(&self, ray: &Ray, within: Range<f64>) -> usize {
        let mut count = 0;
        self.each_hit(ray, within, |_| count += 1);
        count
    }

    /// What [`Bvh::crossings`] writes.
    pub fn crossings(&self, ray: &Ray, crossings: &mut Vec<Crossing>) {
        crossings.clear();
        self.each(|index, shape| {
            let found = |pass| crossings.push(Crossing::new(index, pass));
            match shape {
                Shape::Sphere(sphere) => sphere.each_crossing(ray, found),
                Shape::Triangle(triangle) => triangle.each_crossing(ray, found),
            }
        });
        crossings::sort(crossings, ray, |index| self.shape(index));
    }

    /// What [`Bvh::contains`] returns.
    #[must_use]
    pub fn contains(&self, point: impl Into<DVec3>) -> Side {
        let Some(ray) = counting_ray(point.into()) else { return Side::Outside };
        let mut around = Around::default();
        self.each(|_, shape| {
            around.add(match shape {
                Shape::Sphere(sphere) => sphere.surrounds(&ray),
                Shape::Triangle(triangle) => triangle.surrounds(&ray),
            });
        });
        around.side()
    }
}

/// Returns the edges that lie in an odd number of triangles with area, in the order of the triangles; none where the
/// triangles are closed.
///
/// Edges are the same if both ends are, by equal coordinates (so -0.0 is 0.0), whatever their direction.
#[must_use]
pub fn open_edges(triangles: &[Triangle]) -> Vec<OpenEdge> {
    // Adding 0.0 turns -0.0 into 0.0.
    let bits = |v: DVec3| v.to_array().map(|x| (x + 0.0).to_bits());
    let mut edges: HashMap<[[u64; 3]; 2], (bool, OpenEdge)> = HashMap::new();
    for (triangle, shape) in triangles.iter().enumerate().filter(|(_, triangle)| !triangle.is_degenerate()) {
        let [a, b, c] = shape.vertices();
        for ends in [[a, b], [b, c], [c, a]] {
            let mut key = ends.map(bits);
            key.sort_unstable();
            edges.entry(key).or_insert((false, OpenEdge { ends, triangle })).0 ^= true;
        }
    }
    let mut open: Vec<OpenEdge> = edges.into_values().filter_map(|(odd, edge)| odd.then_some(edge)).collect();
    let order = |edge: &OpenEdge| (edge.triangle, edge.ends.map(bits));
    open.sort_unstable_by_key(order);
    open
}
