//! What both trees hold and look for: primitives behind one trait, and the answer so far.
//!
//! A walk meets primitives one after the other and hands each to its [`Query`]. [`Closest`] keeps bounds of the best
//! hit's `t` and not yet its last bits; those are only worked out where bounds overlap, and for the winner. [`Any`]
//! wants to know no more than whether there is a hit, and ends the walk at the first.

use std::cmp::Ordering;

use crate::ray::{Candidate, PreparedRay};
use crate::simd::prefetch_lines;
use crate::{Hit, Shape, Sphere, Triangle};

/// A primitive at the leaves of a tree.
pub(crate) trait Leaf: Copy + PartialEq + Send + Sync {
    /// Bounds of the closest hit's `t`; `None` if nothing in the range is hit, or the hit surely lies beyond `limit`.
    fn candidate<const FMA: bool>(&self, ray: &PreparedRay, limit: f64) -> Option<Candidate>;

    /// Whether the range holds a hit.
    fn meets<const FMA: bool>(&self, ray: &PreparedRay) -> bool;
}

impl Leaf for Sphere {
    #[inline(always)]
    fn candidate<const FMA: bool>(&self, ray: &PreparedRay, limit: f64) -> Option<Candidate> {
        self.candidate::<FMA>(ray, limit)
    }

    #[inline(always)]
    fn meets<const FMA: bool>(&self, ray: &PreparedRay) -> bool {
        self.meets::<FMA>(ray)
    }
}

impl Leaf for Triangle {
    #[inline(always)]
    fn candidate<const FMA: bool>(&self, ray: &PreparedRay, limit: f64) -> Option<Candidate> {
        self.candidate::<FMA>(ray, limit)
    }

    #[inline(always)]
    fn meets<const FMA: bool>(&self, ray: &PreparedRay) -> bool {
        self.meets::<FMA>(ray)
    }
}

/// The primitives in the order of a tree: at the first *places* the spheres, then the triangles.
#[derive(Clone, Debug)]
pub(crate) struct Leaves {
    pub(crate) spheres: Vec<Sphere>,
    pub(crate) triangles: Vec<Triangle>,
    /// The index of the primitive at each place, as the caller listed them.
    index: Vec<u32>,
    /// The place of the primitive of each index.
    place: Vec<u32>,
}

impl Leaves {
    /// The primitives at their places; `index` tells which is where.
    pub(crate) fn new(spheres: Vec<Sphere>, triangles: Vec<Triangle>, index: Vec<u32>) -> Self {
        let mut place = vec![0; index.len()];
        for (at, &index) in index.iter().enumerate() {
            place[index as usize] = u32::try_from(at).expect("fewer than 2^32 primitives");
        }
        Self { spheres, triangles, index, place }
    }

    pub(crate) fn len(&self) -> usize {
        self.index.len()
    }

    /// The primitive with this index.
    pub(crate) fn shape(&self, index: usize) -> Shape {
        self.placed(self.place[index] as usize)
    }

    /// The primitive at this place.
    pub(crate) fn placed(&self, place: usize) -> Shape {
        match self.spheres.get(place) {
            Some(&sphere) => Shape::Sphere(sphere),
            None => Shape::Triangle(self.triangles[place - self.spheres.len()]),
        }
    }

    /// The correctly rounded `t` of a candidate, which its bounds tell if they are equal.
    #[inline(always)]
    fn rounded(&self, Candidate { low, high }: Candidate, place: usize, ray: &PreparedRay) -> f64 {
        if low.to_bits() == high.to_bits() {
            return low;
        }
        let t = match self.spheres.get(place) {
            Some(sphere) => sphere.closest(ray.ray, ray.within()),
            None => self.triangles[place - self.spheres.len()].closest(ray.ray, ray.within()),
        };
        t.expect("a candidate is a hit")
    }
}

/// What a walk is asked, with the answer so far.
pub(crate) trait Query: Default {
    type Answer: Default;

    /// No hit beyond this changes the answer.
    fn limit(&self) -> f64;

    /// Whether no hit at all changes the answer any more.
    fn is_settled(&self) -> bool;

    /// Meets the primitive at `place`.
    fn meet<const FMA: bool, L: Leaf>(&mut self, leaf: &L, place: usize, leaves: &Leaves, ray: &PreparedRay);

    fn answer(&self, leaves: &Leaves, ray: &PreparedRay) -> Self::Answer;
}

/// Is anything hit?
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Any(bool);

impl Query for Any {
    type Answer = bool;

    #[inline(always)]
    fn limit(&self) -> f64 {
        f64::INFINITY
    }

    #[inline(always)]
    fn is_settled(&self) -> bool {
        self.0
    }

    #[inline(always)]
    fn meet<const FMA: bool, L: Leaf>(&mut self, leaf: &L, _: usize, _: &Leaves, ray: &PreparedRay) {
        self.0 = self.0 || leaf.meets::<FMA>(ray);
    }

    #[inline(always)]
    fn answer(&self, _: &Leaves, _: &PreparedRay) -> bool {
        self.0
    }
}

/// What is hit first: the smallest correctly rounded `t`, and of equal `t` the lowest index.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Closest {
    /// Both infinite as long as nothing is hit.
    bounds: Candidate,
    /// Where the best is; [`NOWHERE`](Self::NOWHERE) as long as nothing is hit. (An `Option` costs a branch a hit.)
    place: usize,
}

impl Default for Closest {
    #[inline(always)]
    fn default() -> Self {
        Self { bounds: Candidate { low: f64::INFINITY, high: f64::INFINITY }, place: Self::NOWHERE }
    }
}

impl Query for Closest {
    type Answer = Option<Hit>;

    #[inline(always)]
    fn limit(&self) -> f64 {
        self.bounds.high
    }

    #[inline(always)]
    fn is_settled(&self) -> bool {
        false
    }

    #[inline(always)]
    fn meet<const FMA: bool, L: Leaf>(&mut self, leaf: &L, place: usize, leaves: &Leaves, ray: &PreparedRay) {
        let Some(bounds) = leaf.candidate::<FMA>(ray, self.limit()) else { return };
        if bounds.high < self.bounds.low {
            *self = Self { bounds, place };
            prefetch_lines(leaves.index.as_ptr().wrapping_add(place), 1);
        } else if bounds.low <= self.bounds.high {
            self.settle(bounds, place, leaves, ray);
        }
    }

    #[inline(always)]
    fn answer(&self, leaves: &Leaves, ray: &PreparedRay) -> Option<Hit> {
        let index = *leaves.index.get(self.place)? as usize;
        Some(Hit { index, t: leaves.rounded(self.bounds, self.place, ray) })
    }
}

impl Closest {
    const NOWHERE: usize = usize::MAX;

    /// The bounds overlap: compares the correctly rounded parameters, then the indices.
    #[cold]
    #[inline(never)]
    fn settle(&mut self, bounds: Candidate, place: usize, leaves: &Leaves, ray: &PreparedRay) {
        let exact = |t: f64, place: usize| Self { bounds: Candidate { low: t, high: t }, place };
        if self.place == Self::NOWHERE {
            *self = exact(leaves.rounded(bounds, place, ray), place);
            return;
        }
        let lower = leaves.index[place].cmp(&leaves.index[self.place]);
        if leaves.placed(place) == leaves.placed(self.place) {
            // Equal primitives have the same `t`.
            if lower == Ordering::Less {
                self.place = place;
            }
            return;
        }
        let new = leaves.rounded(bounds, place, ray);
        let old = leaves.rounded(self.bounds, self.place, ray);
        *self = if new.total_cmp(&old).then(lower).is_lt() { exact(new, place) } else { exact(old, self.place) };
    }
}
