//! The objects of a scene behind one of the ways to find what a ray hits. All give the same answers, bit for bit.

use clap::ValueEnum;
use rt_geom::{AHEAD, Bvh, Hit, List, Ray, Shape, Sphere, SphereTree, Triangle, Visits};

/// How the object that a ray hits is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Method {
    /// One object after the other.
    Loop,
    /// The report's tree of minimal spheres over halves of the list.
    Halves,
    /// The report's tree over the list sorted in space.
    Sorted,
    /// The fast tree.
    #[default]
    Bvh,
}

/// Spheres and triangles, ready for rays.
#[derive(Debug)]
pub enum Objects {
    /// As listed.
    Loop(List),
    /// The report's tree, over either order.
    SphereTree(SphereTree),
    /// The fast tree.
    Bvh(Bvh),
}

impl Objects {
    /// Builds what the method needs.
    pub fn new(method: Method, spheres: Vec<Sphere>, triangles: Vec<Triangle>) -> Self {
        match method {
            Method::Loop => Self::Loop(List { spheres, triangles }),
            Method::Halves => Self::SphereTree(SphereTree::new(spheres, triangles)),
            Method::Sorted => Self::SphereTree(SphereTree::sorted(spheres, triangles)),
            Method::Bvh => Self::Bvh(Bvh::new(spheres, triangles)),
        }
    }

    /// The object with this index: spheres as listed, then triangles as listed.
    pub fn shape(&self, index: usize) -> Shape {
        match self {
            Self::Loop(list) => list.shape(index),
            Self::SphereTree(tree) => tree.shape(index),
            Self::Bvh(tree) => tree.shape(index),
        }
    }

    /// Writes the closest hit of each ray.
    pub fn closest_batch(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        if let Self::Bvh(tree) = self {
            tree.closest_batch(rays, AHEAD, hits);
        } else {
            rays.iter().zip(hits).for_each(|(ray, hit)| *hit = self.closest_counted(ray).0);
        }
    }

    /// The closest hit of a ray, and what it took to find it.
    pub fn closest_counted(&self, ray: &Ray) -> (Option<Hit>, Visits) {
        match self {
            Self::Loop(list) => {
                let tests = list.spheres.len() + list.triangles.len();
                (list.closest(ray, AHEAD), Visits { nodes: 0, tests })
            }
            Self::SphereTree(tree) => tree.closest_counted(ray, AHEAD),
            Self::Bvh(tree) => tree.closest_counted(ray, AHEAD),
        }
    }
}
