//! What both trees hold and look for: primitives behind one trait, and the answer so far.
//!
//! A walk meets primitives one after the other and hands each to its [`Query`]. [`Closest`] keeps bounds of the best
//! hit's `t` and not yet its last bits; those are only worked out where bounds overlap, and for the winner. [`Any`]
//! wants to know no more than whether there is a hit, and ends the walk at the first.

use std::cmp::Ordering;

use fearless_simd::Simd;
use rt_math::Roots;

use crate::crossings::{self, Pass};
use crate::lanes::{LaneKernels, RayLanes, lanes};
use crate::ray::{Candidate, Candidates, PreparedRay, holds};
use crate::simd::{has_fma, prefetch_lines};
use crate::{Hit, Ray, Shape, Side, Sphere, Triangle};

/// A primitive at the leaves of a tree.
pub(crate) trait Leaf: Candidates + LaneKernels + Copy + PartialEq + Send + Sync {
    /// Gives the `t` of each hit in the range, in ascending order.
    fn each_hit(&self, ray: &PreparedRay, found: impl FnMut(f64));

    /// Gives each crossing of the turned ray.
    fn each_crossing(&self, ray: &Ray, found: impl FnMut(Pass));

    /// How the origin of a ray lies with regard to the surface.
    fn surrounds(&self, ray: &Ray) -> Surrounds;
}

/// What one primitive says about a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Surrounds {
    /// Nothing.
    No,
    /// The point lies on it.
    On,
    /// It is a sphere around the point.
    Within,
    /// It is a triangle that the turned ray from the point crosses.
    Crossed,
}

impl Leaf for Sphere {
    fn each_hit(&self, ray: &PreparedRay, mut found: impl FnMut(f64)) {
        let within = ray.within();
        let mut root = |t| {
            if holds(&within, t) {
                found(t);
            }
        };
        match self.roots(ray.ray) {
            Roots::One(t) => root(t),
            Roots::Two(near, far) => {
                root(near);
                root(far);
            }
            _ => {}
        }
    }

    fn each_crossing(&self, ray: &Ray, found: impl FnMut(Pass)) {
        crossings::of_sphere(self, ray).into_iter().flatten().for_each(found);
    }

    fn surrounds(&self, ray: &Ray) -> Surrounds {
        match self.side(ray.origin()) {
            Side::Inside => Surrounds::Within,
            Side::On => Surrounds::On,
            Side::Outside => Surrounds::No,
        }
    }
}

impl Leaf for Triangle {
    fn each_hit(&self, ray: &PreparedRay, mut found: impl FnMut(f64)) {
        if let Some(t) = self.closest(ray.ray, ray.within()) {
            found(t);
        }
    }

    fn each_crossing(&self, ray: &Ray, mut found: impl FnMut(Pass)) {
        if let Some(pass) = crossings::of_triangle(self, ray) {
            found(pass);
        }
    }

    fn surrounds(&self, ray: &Ray) -> Surrounds {
        if self.holds(ray.origin()) {
            Surrounds::On
        } else if self.crosses(ray) {
            Surrounds::Crossed
        } else {
            Surrounds::No
        }
    }
}

/// The primitives in the order of a tree: at the first *places* the spheres, then the triangles.
#[derive(Clone, Debug)]
pub(crate) struct Leaves {
    pub(crate) spheres: Vec<Sphere>,
    pub(crate) triangles: Vec<Triangle>,
    /// The index of the primitive at each place, as the caller listed them; [`NOTHING`](Self::NOTHING) where none is.
    index: Vec<u32>,
    /// The place of the primitive of each index.
    place: Vec<u32>,
    /// The primitives that no walk meets, each after the equal one that stands for it, in ascending order.
    twins: Vec<(u32, u32)>,
}

impl Leaves {
    /// The index of a place where no primitive is.
    pub(crate) const NOTHING: u32 = u32::MAX;

    /// The primitives at their places; `index` tells which is where.
    pub(crate) fn new(spheres: Vec<Sphere>, triangles: Vec<Triangle>, index: Vec<u32>) -> Self {
        let none = index.iter().filter(|&&index| index == Self::NOTHING).count();
        let mut place = vec![0; index.len() - none];
        for (at, &index) in index.iter().enumerate().filter(|&(_, &index)| index != Self::NOTHING) {
            place[index as usize] = u32::try_from(at).expect("fewer than 2^32 primitives");
        }
        Self { spheres, triangles, index, place, twins: Vec::new() }
    }

    /// The same with primitives that no walk meets, each after the equal one that stands for it.
    pub(crate) fn with_twins(mut self, mut twins: Vec<(u32, u32)>) -> Self {
        twins.sort_unstable();
        self.twins = twins;
        self
    }

    /// The index of the primitive at this place, and those of the equal ones for which it stands.
    pub(crate) fn indices(&self, place: usize) -> impl Iterator<Item = usize> {
        let index = self.index[place];
        let start = self.twins.partition_point(|&(first, _)| first < index);
        let twins = self.twins[start..].iter().take_while(move |&&(first, _)| first == index);
        std::iter::once(index).chain(twins.map(|&(_, twin)| twin)).map(|index| index as usize)
    }

    pub(crate) fn len(&self) -> usize {
        self.place.len()
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
pub(crate) trait Query {
    type Answer: Default;

    /// Whether any hit will do, the nearest or another.
    const ANY: bool = false;

    /// The best hit, of which the last bits are still to be worked out.
    #[inline(always)]
    fn closest(&mut self) -> Option<&mut Closest> {
        None
    }

    /// The query at its beginning; it may use what the place for the answer holds.
    fn begin(place: &mut Self::Answer) -> Self;

    /// No hit beyond this changes the answer.
    #[inline(always)]
    fn limit(&self) -> f64 {
        f64::INFINITY
    }

    /// Whether no hit at all changes the answer any more.
    #[inline(always)]
    fn is_settled(&self) -> bool {
        false
    }

    /// Whether a candidate is all that the query wants of a primitive.
    const TAKES_CANDIDATES: bool = false;

    /// Meets a primitive of which this is the candidate.
    #[inline(always)]
    fn offer(&mut self, _: Candidate, _: usize, _: &Leaves, _: &PreparedRay) {}

    /// Meets the primitive at `place`.
    fn meet<const FMA: bool, L: Leaf>(&mut self, leaf: &L, place: usize, leaves: &Leaves, ray: &PreparedRay);

    fn answer(&mut self, leaves: &Leaves, ray: &PreparedRay) -> Self::Answer;
}

/// Is anything hit?
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Any(bool);

impl Query for Any {
    type Answer = bool;
    const ANY: bool = true;

    #[inline(always)]
    fn begin(_: &mut bool) -> Self {
        Self::default()
    }

    #[inline(always)]
    fn is_settled(&self) -> bool {
        self.0
    }

    const TAKES_CANDIDATES: bool = true;

    #[inline(always)]
    fn offer(&mut self, _: Candidate, _: usize, _: &Leaves, _: &PreparedRay) {
        self.0 = true;
    }

    #[inline(always)]
    fn meet<const FMA: bool, L: Leaf>(&mut self, leaf: &L, _: usize, _: &Leaves, ray: &PreparedRay) {
        self.0 = self.0 || leaf.meets::<FMA>(ray);
    }

    #[inline(always)]
    fn answer(&mut self, _: &Leaves, _: &PreparedRay) -> bool {
        self.0
    }
}

/// What is hit first: the smallest correctly rounded `t`, and of equal `t` the lowest index.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Closest {
    /// Both infinite as long as nothing is hit.
    pub(crate) bounds: Candidate,
    /// Where the best is; [`NOWHERE`](Self::NOWHERE) as long as nothing is hit. (An `Option` costs a branch a hit.)
    pub(crate) place: usize,
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
    fn begin(_: &mut Option<Hit>) -> Self {
        Self::default()
    }

    #[inline(always)]
    fn closest(&mut self) -> Option<&mut Closest> {
        Some(self)
    }

    #[inline(always)]
    fn limit(&self) -> f64 {
        self.bounds.high
    }

    const TAKES_CANDIDATES: bool = true;

    #[inline(always)]
    fn offer(&mut self, bounds: Candidate, place: usize, leaves: &Leaves, ray: &PreparedRay) {
        if bounds.high < self.bounds.low {
            *self = Self { bounds, place };
            prefetch_lines(leaves.index.as_ptr().wrapping_add(place), 1);
        } else if bounds.low <= self.bounds.high {
            self.settle(bounds, place, leaves, ray);
        }
    }

    #[inline(always)]
    fn meet<const FMA: bool, L: Leaf>(&mut self, leaf: &L, place: usize, leaves: &Leaves, ray: &PreparedRay) {
        // Where nothing is hit, both comparisons are false.
        self.offer(leaf.candidate::<FMA>(ray, self.limit()), place, leaves, ray);
    }

    #[inline(always)]
    fn answer(&mut self, leaves: &Leaves, ray: &PreparedRay) -> Option<Hit> {
        let index = *leaves.index.get(self.place)? as usize;
        Some(Hit { index, t: leaves.rounded(self.bounds, self.place, ray) })
    }
}

/// Works out the last bits of the best hits of eight rays, where one step is enough.
#[inline(always)]
pub(crate) fn finish<S: Simd>(simd: S, leaves: &Leaves, best: &mut [Closest; 8], rays: [&Ray; 8]) {
    finish_those_on(simd, &leaves.spheres, 0, best, rays);
    finish_those_on(simd, &leaves.triangles, leaves.spheres.len(), best, rays);
}

/// The same for those on shapes of one kind, of which the first has this place.
#[inline(always)]
fn finish_those_on<S: Simd, L: Leaf>(simd: S, shapes: &[L], first: usize, best: &mut [Closest; 8], rays: [&Ray; 8]) {
    let Some(any) = shapes.first() else { return };
    let (mut on, mut open) = ([any; 8], 0);
    for (lane, best) in best.iter().enumerate() {
        if let Some(shape) = shapes.get(best.place.wrapping_sub(first)) {
            on[lane] = shape;
            open |= u64::from(best.bounds.low.to_bits() != best.bounds.high.to_bits()) << lane;
        }
    }
    if open == 0 {
        return;
    }
    let rays = RayLanes::new(simd, rays);
    let bounds = (lanes(simd, best.each_ref(), |b| b.bounds.low), lanes(simd, best.each_ref(), |b| b.bounds.high));
    let (t, certain) = if has_fma(simd) {
        L::lane_roundings::<true, S>(simd, on, &rays, bounds)
    } else {
        L::lane_roundings::<false, S>(simd, on, &rays, bounds)
    };
    let t: [f64; 8] = t.into();
    for (lane, (best, t)) in best.iter_mut().zip(t).enumerate() {
        if (open & certain) >> lane & 1 == 1 {
            best.bounds = Candidate { low: t, high: t };
        }
    }
}

impl Closest {
    pub(crate) const NOWHERE: usize = usize::MAX;

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

#[cfg(test)]
mod tests {
    use std::ops::Range;

    use fearless_simd::{Level, f64x8, prelude::*};
    use glam::DVec3;
    use oracle::Random;

    use super::*;
    use crate::lanes::PencilLanes;
    use crate::simd::dispatch;

    #[inline(always)]
    fn pencil<S: Simd, L: Leaf>(simd: S, leaf: &L, rays: &[Ray; 8], range: (f64, f64)) -> (u64, u64, [[f64; 8]; 2]) {
        let numbers = |number: &dyn Fn(&Ray) -> f64| f64x8::from_slice(simd, &rays.each_ref().map(number));
        let rays = PencilLanes {
            origin: rays[0].origin(),
            direction: [0, 1, 2].map(|axis| numbers(&|ray| ray.direction()[axis])),
            reach: numbers(&Ray::reach),
            square: numbers(&Ray::square),
            inverse_square: numbers(&Ray::inverse_square),
        };
        let found = leaf.pencil_candidates(simd, &rays, range);
        (found.none, found.some, [found.low.into(), found.high.into()])
    }

    #[inline(always)]
    fn each<S: Simd, L: Leaf>(simd: S, leaf: &L, rays: &[Ray; 8], range: (f64, f64)) -> (u64, u64, [[f64; 8]; 2]) {
        let found = L::lane_candidates(simd, [leaf; 8], &RayLanes::new(simd, rays.each_ref()), range);
        (found.none, found.some, [found.low.into(), found.high.into()])
    }

    #[inline(always)]
    fn rounded<S: Simd, L: Leaf>(simd: S, leaf: &L, rays: &[Ray; 8], bounds: [Candidate; 8]) -> ([f64; 8], u64) {
        let rays = RayLanes::new(simd, rays.each_ref());
        let bounds = (lanes(simd, bounds.each_ref(), |b| b.low), lanes(simd, bounds.each_ref(), |b| b.high));
        let (t, certain) = if has_fma(simd) {
            L::lane_roundings::<true, S>(simd, [leaf; 8], &rays, bounds)
        } else {
            L::lane_roundings::<false, S>(simd, [leaf; 8], &rays, bounds)
        };
        (t.into(), certain)
    }

    /// How often the filter ruled out, gave bounds, and left open.
    fn check<L: Leaf>(
        leaf: &L,
        target: DVec3,
        size: f64,
        closest: impl Fn(&Ray, Range<f64>) -> Option<f64>,
        random: &mut Random,
    ) -> [usize; 5] {
        let origin = target + size * random.point() * random.power(-4..8);
        let along = target - origin;
        let width = along.length() / size * random.power(-54..0);
        // One direction is out of the range where the filters are proved.
        let length = if random.one_in(8) { random.power(-400..400) } else { 1.0 };
        let rays: [Ray; 8] = std::array::from_fn(|lane| {
            let aside = if lane == 0 { DVec3::ZERO } else { width * random.point() };
            Ray::new(origin, length * (along / size + aside)).unwrap()
        });
        let mut count = [0; 5];
        let there = size / length;
        let ends = [f64::INFINITY, there, there.next_up()];
        for (start, end) in [(0.0, random.pick(&ends)), (there, f64::INFINITY)] {
            for level in [Level::new(), Level::baseline()] {
                let pencil = dispatch!(level, simd => pencil(simd, leaf, &rays, (start, end)));
                let each = dispatch!(level, simd => each(simd, leaf, &rays, (start, end)));
                for (none, some, [low, high]) in [pencil, each] {
                    for (lane, ray) in rays.iter().enumerate() {
                        let t = closest(ray, start..end);
                        let (none, some) = (none >> lane & 1 == 1, some >> lane & 1 == 1);
                        assert!(!none || t.is_none(), "{level:?} {ray:?} {start} {end} {t:?}");
                        let holds = t.is_some_and(|t| low[lane] <= t && t <= high[lane]);
                        assert!(!some || holds, "{level:?} {ray:?} {start} {end} {t:?} {low:?} {high:?}");
                        count[if none { 0 } else { 2 - usize::from(some) }] += 1;
                    }
                }
                let bounds = rays.each_ref().map(|ray| {
                    let prepared = PreparedRay::new(ray, start..end);
                    leaf.candidate::<false>(&prepared, f64::INFINITY)
                });
                let (t, certain) = dispatch!(level, simd => rounded(simd, leaf, &rays, bounds));
                for (lane, ray) in rays.iter().enumerate().filter(|&(lane, _)| !bounds[lane].low.is_nan()) {
                    let certain = certain >> lane & 1 == 1;
                    let expected = closest(ray, start..end).map(f64::to_bits);
                    assert!(!certain || expected == Some(t[lane].to_bits()), "{level:?} {ray:?} {start} {end} {t:?}");
                    count[3 + usize::from(certain)] += 1;
                }
            }
        }
        count
    }

    /// Rays at silhouettes, edges and corners, exactly and up to rounding, and ranges that end at a hit: what the filter
    /// for eight rays says is what exact arithmetic says, and a `t` that is certain is the nearest double.
    #[test]
    fn eight_rays_are_told_nothing_that_is_wrong() {
        let random = &mut Random::new(8);
        let mut counts = [[0; 5]; 2];
        for round in 0..3_000 {
            // Some so small and so large that squares and volumes leave the range where the filters are proved.
            let size = if round % 8 == 0 { random.power(-520..470) } else { 1.0 };
            let sphere = Sphere::new(size * random.point(), size * random.power(-20..2)).unwrap();
            let sides = [DVec3::X, DVec3::ZERO, random.direction()];
            let target = sphere.center() + sphere.radius() * random.pick(&sides);
            let count = check(&sphere, target, size, |ray, within| sphere.closest(ray, within), random);
            (0..5).for_each(|i| counts[0][i] += count[i]);

            let wide = size * random.power(-12..2);
            let at = size * random.point();
            let mut corner = || at + wide * random.point();
            let triangle = Triangle::new(corner(), corner(), corner()).unwrap();
            let [a, b, c] = triangle.vertices();
            let target = random.pick(&[a, 0.5 * (a + b), 0.25 * a + 0.75 * c, (a + b + c) / 3.0]);
            let count = check(&triangle, target, size, |ray, within| triangle.closest(ray, within), random);
            (0..5).for_each(|i| counts[1][i] += count[i]);
        }
        assert!(counts.iter().flatten().all(|&count| count > 2_000), "{counts:?}");
    }
}
