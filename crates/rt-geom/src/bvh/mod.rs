//! The bounding-sphere tree: every node has the minimal sphere of the primitives below it.

mod batch;
mod build;
mod cull;
mod node;
mod rank;
mod walk;

use std::ops::Range;

use fearless_simd::{Fallback, Level, dispatch};
use rayon::prelude::*;

pub use walk::Visits;

use crate::{Hit, Ray, Shape, Sphere, Triangle, enclosing_sphere};
use batch::fly;
use build::{Branch, Item, Part};
use node::{Balls, Boxes, COORDINATE_ERROR, Child, Frame, Kind, Node, WIDTH, down, up};
use walk::{cast, is_open};

/// The tree to cast rays with: answers equal the plain loop's, bit for bit.
///
/// A query usually takes time in the order of the logarithm of the number of primitives. It takes time in proportion to
/// their number where bounds cannot part them: where many distinct primitives share a point that the ray passes, as a
/// fan of triangles does or spheres with one center, or lie closer together than the rounding of the bounds, which is
/// about 2^-21 of the scene's radius. Equal primitives cost no more than one of them: the lowest index answers.
/// So do rays that start beyond 2^42 radii from the scene, or whose direction is so long or so short that one
/// unit of `t` in radii of the scene is not a normal double: they meet every primitive.
#[derive(Clone, Debug)]
pub struct Bvh {
    /// In leaf order, as are the triangles.
    spheres: Vec<Sphere>,
    triangles: Vec<Triangle>,
    /// The index of the primitive at each place: spheres in leaf order, then triangles in leaf order.
    index: Vec<u32>,
    /// The place of the primitive of each index.
    place: Vec<u32>,
    nodes: Vec<Node>,
    /// The minimal spheres of each node's children; `None` where no finite sphere encloses, and for unused lanes.
    minimal: Vec<[Option<Sphere>; WIDTH]>,
    sphere_blocks: Vec<Balls>,
    triangle_blocks: Vec<Boxes>,
    root: Option<Child>,
    frame: Frame,
    /// How many pending entries a walk can need.
    stack: usize,
    level: Level,
}

impl Bvh {
    /// Builds the tree, in parallel on rayon's current pool. Any input will do, also none at all.
    ///
    /// # Panics
    /// With 2^32 primitives or more.
    pub fn new(spheres: Vec<Sphere>, triangles: Vec<Triangle>) -> Self {
        let count = spheres.len() + triangles.len();
        assert!(u32::try_from(count).is_ok(), "a tree holds fewer than 2^32 primitives, not {count}");
        let frame = Frame::around(scene_sphere(&spheres, &triangles).as_ref());

        let sphere_items = |(index, sphere): (usize, &Sphere)| {
            let (center, radius) = (frame.point(sphere.center()), frame.length(sphere.radius()));
            item(center - radius, center + radius, index)
        };
        let triangle_items = |(index, triangle): (usize, &Triangle)| {
            let [a, b, c] = triangle.vertices().map(|v| frame.point(v));
            item(a.min(b).min(c), a.max(b).max(c), spheres.len() + index)
        };
        let mut nodes = Vec::new();
        let mut spans = Vec::new();
        let mut parts: Vec<(Part, Branch)> = Vec::new();
        let mut first_triangle_node = 0;
        let mut index = Vec::with_capacity(count);
        let mut plant = |items: Vec<Item>, branches: &[Branch], kind: Kind| {
            index.extend(items.iter().map(Item::index));
            let twins = items.iter().enumerate().filter(|(_, item)| item.is_twin()).map(|(place, _)| place);
            let twins: Vec<usize> = twins.collect();
            drop(items);
            if let Some(&whole) = branches.first() {
                if kind == Kind::Triangles {
                    first_triangle_node = nodes.len();
                }
                parts.push((build::collapse(branches, kind, &mut nodes, &mut spans), whole));
            }
            twins
        };
        let mut items: Vec<Item> = spheres.par_iter().enumerate().map(sphere_items).collect();
        let branches = build::binary_tree(&mut items, &|a, b| {
            let numbers = |i: u32| {
                let sphere = &spheres[i as usize];
                (sphere.center().to_array(), sphere.radius())
            };
            numbers(a).partial_cmp(&numbers(b)).expect("finite numbers")
        });
        let sphere_twins = plant(items, &branches, Kind::Spheres);
        let mut items: Vec<Item> = triangles.par_iter().enumerate().map(triangle_items).collect();
        let branches = build::binary_tree(&mut items, &|a, b| {
            let numbers = |i: u32| triangles[i as usize - spheres.len()].vertices().map(|v| v.to_array());
            numbers(a).partial_cmp(&numbers(b)).expect("finite numbers")
        });
        let triangle_twins = plant(items, &branches, Kind::Triangles);
        drop(branches);

        let mut place = vec![0; count];
        for (at, &index) in index.iter().enumerate() {
            place[index as usize] = u32::try_from(at).expect("fewer than 2^32 primitives");
        }
        let (sphere_index, triangle_index) = index.split_at(spheres.len());
        let (old_spheres, old_triangles) = (spheres, triangles);
        let spheres: Vec<Sphere> = sphere_index.par_iter().map(|&i| old_spheres[i as usize]).collect();
        let triangles: Vec<Triangle> =
            triangle_index.par_iter().map(|&i| old_triangles[i as usize - old_spheres.len()]).collect();
        drop(old_spheres);
        drop(old_triangles);

        let sphere_blocks = spheres.par_chunks(WIDTH).map(|chunk| {
            let mut block = Balls::EMPTY;
            for (lane, sphere) in chunk.iter().enumerate() {
                block.set(lane, frame.ball(sphere));
            }
            block
        });
        let mut sphere_blocks: Vec<Balls> = sphere_blocks.collect();
        for place in sphere_twins {
            sphere_blocks[place / WIDTH].clear(place % WIDTH);
        }
        let triangle_blocks = triangles.par_chunks(WIDTH).map(|chunk| {
            let mut block = Boxes::EMPTY;
            for (lane, triangle) in chunk.iter().enumerate() {
                let [a, b, c] = triangle.vertices().map(|v| frame.point(v));
                let item = item(a.min(b).min(c), a.max(b).max(c), 0);
                block.set(lane, item.low(), item.high());
            }
            block
        });
        let mut triangle_blocks: Vec<Boxes> = triangle_blocks.collect();
        for place in triangle_twins {
            triangle_blocks[place / WIDTH].clear(place % WIDTH);
        }
        let first_triangle_node = if triangles.is_empty() { nodes.len() } else { first_triangle_node };
        let below = &spans[..first_triangle_node];
        let mut minimal = build::minimal_spheres(&nodes, 0, below, &spheres, WIDTH);
        let (below, vertices) = (&spans[first_triangle_node..], corners(&triangles));
        minimal.extend(build::minimal_spheres(&nodes, first_triangle_node, below, &vertices, 3 * WIDTH));
        let (root, stack) = match parts[..] {
            [] => (None, 0),
            [(part, _)] => (Some(part.child), part.stack),
            _ => {
                let mut join = Node::EMPTY;
                for (lane, (part, whole)) in parts.iter().enumerate() {
                    join.children[lane] = part.child;
                    join.boxes.set(lane, whole.low, whole.high);
                }
                nodes.push(join);
                let mut spheres_of_join = [None; WIDTH];
                spheres_of_join[0] = minimal_sphere_of(&spheres);
                spheres_of_join[1] = minimal_sphere_of(&vertices);
                minimal.push(spheres_of_join);
                let stack = parts.iter().map(|(part, _)| part.stack).max().unwrap_or(0);
                (Some(Child::new(Kind::Inner, nodes.len() - 1)), stack + parts.len())
            }
        };
        nodes.shrink_to_fit();
        Self {
            spheres,
            triangles,
            index,
            place,
            nodes,
            minimal,
            sphere_blocks,
            triangle_blocks,
            root,
            frame,
            stack,
            level: Level::new(),
        }
    }

    /// How many primitives the tree holds.
    pub fn len(&self) -> usize {
        self.index.len()
    }

    /// Whether it holds none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the primitive with this index: spheres as listed, then triangles as listed.
    ///
    /// # Panics
    /// If `index >= self.len()`.
    pub fn shape(&self, index: usize) -> Shape {
        self.placed(self.place[index] as usize)
    }

    /// Calls `visit` with each minimal sphere of the tree and the indices of the primitives below it: one for each node
    /// but the root, and one for each leaf block. `None` where no finite sphere encloses them.
    pub fn for_each_bound(&self, mut visit: impl FnMut(Option<&Sphere>, &[u32])) {
        for (node, minimal) in self.nodes.iter().zip(&self.minimal) {
            for (&child, sphere) in node.children().iter().zip(minimal) {
                visit(sphere.as_ref(), &self.index[self.first_place(child)..self.end_place(child)]);
            }
        }
    }

    fn first_place(&self, child: Child) -> usize {
        match child.kind() {
            Kind::Inner => self.first_place(self.nodes[child.index()].children[0]),
            Kind::Spheres => child.index() * WIDTH,
            Kind::Triangles => self.spheres.len() + child.index() * WIDTH,
        }
    }

    fn end_place(&self, child: Child) -> usize {
        match child.kind() {
            Kind::Inner => {
                let children = self.nodes[child.index()].children();
                self.end_place(children[children.len() - 1])
            }
            Kind::Spheres => self.spheres.len().min((child.index() + 1) * WIDTH),
            Kind::Triangles => self.len().min(self.spheres.len() + (child.index() + 1) * WIDTH),
        }
    }

    /// The same tree with another instruction set: `"scalar"`, `"sse2"`, `"sse4.2"`, `"avx2"`, `"avx512"` or `"neon"`;
    /// `None` if this CPU lacks it. For tests and benches: every set gives the same answers.
    #[doc(hidden)]
    pub fn with_simd(mut self, name: &str) -> Option<Self> {
        let best = Level::new();
        #[cfg(target_arch = "x86_64")]
        let level = match name {
            "sse2" => best.as_sse2().map(Level::Sse2),
            "sse4.2" => best.as_sse4_2().map(Level::Sse4_2),
            "avx2" => best.as_avx2().map(Level::Avx2),
            "avx512" => best.as_avx512().map(Level::Avx512),
            _ => None,
        };
        #[cfg(target_arch = "aarch64")]
        let level = best.as_neon().filter(|_| name == "neon").map(Level::Neon);
        #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
        let level = None;
        self.level = if name == "scalar" { Level::Fallback(Fallback::new()) } else { level? };
        Some(self)
    }

    /// Returns the closest hit with its `t` in the range: the smallest `t`, and of equal `t` the lowest index.
    pub fn closest(&self, ray: &Ray, within: Range<f64>) -> Option<Hit> {
        self.query(ray, within, false, &mut Visits::default())
    }

    /// As [`closest`](Self::closest), with what the query did.
    pub fn closest_counted(&self, ray: &Ray, within: Range<f64>) -> (Option<Hit>, Visits) {
        let mut visits = Visits::default();
        (self.query(ray, within, false, &mut visits), visits)
    }

    /// Returns whether anything is hit with its `t` in the range.
    pub fn any(&self, ray: &Ray, within: Range<f64>) -> bool {
        self.query(ray, within, true, &mut Visits::default()).is_some()
    }

    /// As [`any`](Self::any), with what the query did.
    pub fn any_counted(&self, ray: &Ray, within: Range<f64>) -> (bool, Visits) {
        let mut visits = Visits::default();
        (self.query(ray, within, true, &mut visits).is_some(), visits)
    }

    /// Writes the closest hit of each ray.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn closest_batch(&self, rays: &[Ray], within: Range<f64>, hits: &mut [Option<Hit>]) {
        assert_eq!(rays.len(), hits.len(), "one place for the answer to each ray");
        if !is_open(&within) {
            hits.fill(None);
            return;
        }
        self.fly(rays, &within, false, &mut |i, hit| hits[i] = hit);
    }

    /// Writes for each ray whether it hits anything.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn any_batch(&self, rays: &[Ray], within: Range<f64>, hits: &mut [bool]) {
        assert_eq!(rays.len(), hits.len(), "one place for the answer to each ray");
        if !is_open(&within) {
            hits.fill(false);
            return;
        }
        self.fly(rays, &within, true, &mut |i, hit| hits[i] = hit.is_some());
    }

    #[inline(never)]
    fn query(&self, ray: &Ray, within: Range<f64>, any: bool, visits: &mut Visits) -> Option<Hit> {
        if !is_open(&within) {
            return None;
        }
        dispatch!(self.level, simd => cast(simd, self, ray, within.clone(), any, visits))
    }

    #[inline(never)]
    fn fly(&self, rays: &[Ray], within: &Range<f64>, any: bool, answer: &mut dyn FnMut(usize, Option<Hit>)) {
        dispatch!(self.level, simd => fly(simd, self, rays, within, any, answer));
    }
}

/// A sphere around everything, minimal for spheres alone.
fn scene_sphere(spheres: &[Sphere], triangles: &[Triangle]) -> Option<Sphere> {
    match (spheres, triangles) {
        (_, []) => minimal_sphere_of(spheres),
        ([], _) => minimal_sphere_of(&corners(triangles)),
        _ => minimal_sphere_of(&[minimal_sphere_of(spheres)?, minimal_sphere_of(&corners(triangles))?]),
    }
}

/// The vertices as spheres of radius 0.
fn corners(triangles: &[Triangle]) -> Vec<Sphere> {
    let vertices = triangles.iter().flat_map(Triangle::vertices);
    vertices.map(|v| Sphere::new(v, 0.0).expect("vertices are finite")).collect()
}

/// The minimal sphere of some spheres; `None` if it has no finite radius.
fn minimal_sphere_of(spheres: &[Sphere]) -> Option<Sphere> {
    enclosing_sphere(spheres).map(|enclosing| enclosing.sphere)
}

/// The box between two corners given in cull coordinates, rounded outward.
fn item(low: glam::DVec3, high: glam::DVec3, index: usize) -> Item {
    Item::new(
        low.to_array().map(|x| down(x - COORDINATE_ERROR)),
        high.to_array().map(|x| up(x + COORDINATE_ERROR)),
        u32::try_from(index).expect("fewer than 2^32 primitives"),
    )
}

/// The minimal sphere of a triangle; `None` if it has no finite radius.
pub(crate) fn minimal_sphere(triangle: &Triangle) -> Option<Sphere> {
    minimal_sphere_of(&corners(std::slice::from_ref(triangle)))
}
