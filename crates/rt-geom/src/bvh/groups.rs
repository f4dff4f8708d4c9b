//! Groups by scale: a frame resolves what is not much smaller than the scene, so what is goes to frames of its own.
//!
//! A group is cut up where its frame is too coarse for it (`crowd.rs`): where a few small primitives lie so close
//! together that the slack of the cull (`cull.rs`) is no longer small beside their distances. All that is large stays.
//! The rest is cut from the top down, between bins, until the parts are small beside the group; the parts that are too
//! fine for the frame become groups, and the others stay with the large ones. What stays is a region, or, if it is
//! little, single primitives of the crown. A scene of one scale is one group, and has no crown.
//!
//! Most scenes that need groups show it before there is a tree over them. Whether a tree is good enough is asked again
//! when it is there, for crowds that are few among many.

use super::build::{BinCut, Binary, Extent, Item, Trunk, bounds_of, items_of, part_with_bounds, partition};
use super::crowd::{ALL, CROWD, Grid, crowded_blocks};
use super::crown::{Box64, Crown, Part};
use super::node::{Frame, WIDTH};
use super::scene_sphere;
use crate::{Shape, Sphere, Triangle};

/// The extent of the largest groups within a group. (In units of a radius between 1/2 and 1.)
const NESTED: f32 = 1.0 / (1 << 6) as f32;
/// No part is cut more often than this.
const MAX_CUTS: u32 = 64;
/// So many primitives tell where many are.
const SAMPLE: usize = 256;
/// Groups within groups may hold so many times the scene's primitives in all, which bounds the time to build, and some
/// more: a small scene has all that it needs.
const WORK: usize = 16;
const FREE_WORK: usize = 1 << 20;

/// Primitives of one part of the scene.
#[derive(Default)]
struct Group {
    spheres: Vec<Sphere>,
    triangles: Vec<Triangle>,
    /// Their indices, in ascending order for each kind.
    indices: Vec<u32>,
    /// Whether they are the whole scene, which needs no list of indices.
    whole: bool,
}

impl Group {
    fn len(&self) -> usize {
        self.spheres.len() + self.triangles.len()
    }

    fn shape(&self, place: u32) -> Shape {
        let place = place as usize;
        match self.spheres.get(place) {
            Some(&sphere) => Shape::Sphere(sphere),
            None => Shape::Triangle(self.triangles[place - self.spheres.len()]),
        }
    }

    fn index(&self, place: u32) -> u32 {
        if self.whole { place } else { self.indices[place as usize] }
    }

    fn bounds(&self) -> Box64 {
        Box64::of_spheres(&self.spheres).merge(Box64::of_triangles(&self.triangles))
    }

    fn frame(&self) -> Frame {
        Frame::around(scene_sphere(&self.spheres, &self.triangles).as_ref())
    }

    /// The boxes of both kinds in a frame.
    fn items(&self, frame: &Frame) -> (Vec<Item>, Vec<Item>) {
        (items_of(&self.spheres, frame), items_of(&self.triangles, frame))
    }

    /// The trees over both kinds.
    fn trees(&self, (spheres, triangles): (Vec<Item>, Vec<Item>)) -> (Binary<'_, Sphere>, Binary<'_, Triangle>) {
        (Binary::new(&self.spheres, spheres), Binary::new(&self.triangles, triangles))
    }

    /// The groups that the parts make, the first of all that stays.
    fn split(mut self, parts: &Parts) -> Vec<Self> {
        let mut counts = vec![(0, 0); parts.count + 1];
        let (spheres, triangles) = parts.owner.split_at(self.spheres.len());
        for &owner in spheres {
            counts[owner as usize].0 += 1;
        }
        for &owner in triangles {
            counts[owner as usize].1 += 1;
        }
        let with_room = |&(spheres, triangles): &(usize, usize)| Self {
            spheres: Vec::with_capacity(spheres),
            triangles: Vec::with_capacity(triangles),
            indices: Vec::new(),
            whole: false,
        };
        let mut groups: Vec<Self> = counts.iter().map(with_room).collect();
        for (&owner, &sphere) in spheres.iter().zip(&self.spheres) {
            groups[owner as usize].spheres.push(sphere);
        }
        for (&owner, &triangle) in triangles.iter().zip(&self.triangles) {
            groups[owner as usize].triangles.push(triangle);
        }
        // (What is copied makes room.)
        self.spheres = Vec::new();
        self.triangles = Vec::new();
        for (group, &(spheres, triangles)) in groups.iter_mut().zip(&counts) {
            group.indices.reserve_exact(spheres + triangles);
        }
        for (place, &owner) in (0..).zip(&parts.owner) {
            groups[owner as usize].indices.push(self.index(place));
        }
        groups
    }
}

/// What the crown has for a group.
enum Entry {
    Part(Part),
    Group(usize),
}

/// What is found inside of a group, with its bounds.
type Inside = Vec<(Box64, Entry)>;

/// Builds the tree, and a crown if it has more than one region.
pub(super) fn grow(spheres: Vec<Sphere>, triangles: Vec<Triangle>) -> (Trunk, Option<Crown>) {
    let work = WORK * (spheres.len() + triangles.len()) + FREE_WORK;
    let groups = vec![Group { spheres, triangles, indices: Vec::new(), whole: true }];
    let room = (groups[0].spheres.len(), groups[0].triangles.len());
    let trunk = Trunk { room, ..Trunk::default() };
    let mut nursery = Nursery { trunk, groups, singles: Vec::new(), grid: Grid::default(), work };
    let mut entries: Vec<Inside> = Vec::new();
    let mut rests: Vec<Group> = Vec::new();
    while let Some(group) = nursery.groups.get_mut(entries.len()).map(std::mem::take) {
        let mut inside = Vec::new();
        rests.push(nursery.part(group, &mut inside));
        entries.push(inside);
    }
    // (Later than all groups, which need the memory more.)
    for (rest, inside) in rests.into_iter().zip(&mut entries) {
        nursery.keep(&rest, inside);
    }
    let Nursery { mut trunk, singles, .. } = nursery;
    if let [only] = &entries[..]
        && let [(_, Entry::Part(Part::Region(_)))] = only[..]
    {
        return (trunk, None);
    }
    let places: Vec<usize> = singles.into_iter().map(|(shape, index)| trunk.add(shape, index)).collect();
    let crown = crown(entries, |number| place_of(places[number as usize]));
    (trunk, Some(crown))
}

/// The groups, and what has grown from them.
struct Nursery {
    trunk: Trunk,
    groups: Vec<Group>,
    /// Primitives of the crown. (Their number for now: their places follow those of all regions.)
    singles: Vec<(Shape, u32)>,
    grid: Grid,
    /// How many primitives may still be looked at.
    work: usize,
}

impl Nursery {
    /// Makes a region of a group, or groups of what its frame is too coarse for. Returns what is left.
    fn part(&mut self, group: Group, inside: &mut Inside) -> Group {
        let nested = !group.whole;
        if nested && group.len() <= WIDTH {
            return group;
        }
        let frame = group.frame();
        let mut items = group.items(&frame);
        let affordable = group.len() <= self.work;
        self.work -= group.len().min(self.work);
        let crowded = affordable && self.is_crowded(&group, &items);
        if crowded {
            if let Some(parts) = Parts::new(&group, items, &mut self.grid) {
                return self.divide(group, &parts, inside);
            }
            items = group.items(&frame);
        }
        let mut trees = group.trees(items);
        let crowds = (crowded_blocks(&trees.0.items), crowded_blocks(&trees.1.items));
        if affordable && !crowded && self.is_crowded(&group, &crowds) {
            if let Some(parts) = Parts::new(&group, (trees.0.items, trees.1.items), &mut self.grid) {
                return self.divide(group, &parts, inside);
            }
            trees = group.trees(group.items(&frame));
        }
        let bounds = if nested { group.bounds() } else { Box64::EMPTY };
        inside.push((bounds, Entry::Part(self.trunk.grow(frame, trees, |i| group.index(i)))));
        Group::default()
    }

    /// Whether a grid shows that a group's frame is too coarse.
    fn is_crowded(&mut self, group: &Group, (spheres, triangles): &(Vec<Item>, Vec<Item>)) -> bool {
        self.grid.is_crowded(spheres, |a, b| group.spheres[a as usize] == group.spheres[b as usize])
            || self.grid.is_crowded(triangles, |a, b| group.triangles[a as usize] == group.triangles[b as usize])
    }

    /// Makes groups of a group's parts, and returns what stays.
    fn divide(&mut self, group: Group, parts: &Parts, inside: &mut Inside) -> Group {
        let mut groups = group.split(parts).into_iter();
        let rest = groups.next().expect("what stays comes first");
        for part in groups {
            inside.push((part.bounds(), Entry::Group(self.groups.len())));
            self.groups.push(part);
        }
        rest
    }

    /// Makes a region of what stays in a group, or leaves it to the crown.
    fn keep(&mut self, rest: &Group, inside: &mut Inside) {
        if rest.len() > WIDTH {
            let frame = rest.frame();
            let trees = rest.trees(rest.items(&frame));
            let part = self.trunk.grow(frame, trees, |i| rest.index(i));
            inside.push((rest.bounds(), Entry::Part(part)));
            return;
        }
        for place in (0..).take(rest.len()) {
            let (shape, number) = (rest.shape(place), place_of(self.singles.len()));
            inside.push(match shape {
                Shape::Sphere(sphere) => (Box64::of_spheres(&[sphere]), Entry::Part(Part::Sphere(number))),
                Shape::Triangle(triangle) => (Box64::of_triangles(&[triangle]), Entry::Part(Part::Triangle(number))),
            });
            self.singles.push((shape, rest.index(place)));
        }
    }
}

/// Joins the entries of all groups, of which those of a group follow it.
fn crown(entries: Vec<Inside>, place: impl Fn(u32) -> u32) -> Crown {
    let mut crown = Crown::default();
    let mut roots = vec![Part::Node(0); entries.len()];
    for (group, inside) in entries.into_iter().enumerate().rev() {
        let part = |(bounds, entry)| {
            let part = match entry {
                Entry::Group(group) => roots[group],
                Entry::Part(Part::Sphere(number)) => Part::Sphere(place(number)),
                Entry::Part(Part::Triangle(number)) => Part::Triangle(place(number)),
                Entry::Part(part) => part,
            };
            (bounds, part)
        };
        roots[group] = crown.add(inside.into_iter().map(part).collect());
    }
    crown.with_root(roots[0])
}

fn place_of(count: usize) -> u32 {
    u32::try_from(count).expect("a tree holds fewer than 2^32 primitives")
}

/// Which part of a group each of its primitives belongs to: 0 for what stays, or the number of a group within it.
struct Parts {
    owner: Vec<u32>,
    count: usize,
}

impl Parts {
    /// The parts of a group, if there are any.
    fn new(group: &Group, (mut items, triangles): (Vec<Item>, Vec<Item>), grid: &mut Grid) -> Option<Self> {
        let first = place_of(items.len());
        items.extend(triangles.iter().map(|item| item.with_index(first + item.index())));
        let small = partition(&mut items, |item| item.size() < NESTED);
        let mut parts = Self { owner: vec![0; group.len()], count: 0 };
        let small = &mut items[..small];
        parts.sort_out(group, grid, small, &bounds_of(small), 0);
        // The frame of subnormal numbers is the one that no other magnifies more.
        let whole = parts.count == 1 && parts.owner.iter().all(|&owner| owner == 1);
        if whole {
            parts = Self { owner: vec![0; group.len()], count: 0 };
        }
        (parts.count > 0 || group.len() <= WIDTH).then_some(parts)
    }

    /// Sorts small primitives out. The recursion is no deeper than [`MAX_CUTS`].
    fn sort_out(&mut self, group: &Group, grid: &mut Grid, items: &mut [Item], extent: &Extent, cuts: u32) {
        if items.len() < CROWD || cuts == MAX_CUTS {
            return;
        }
        let nested = extent.size() < NESTED;
        // (Of more, a crowd may be missed.)
        if (nested || items.len() <= ALL) && !grid.is_crowded(items, |a, b| group.shape(a) == group.shape(b)) {
            return;
        }
        if nested {
            self.count += 1;
            for item in items {
                self.owner[item.index() as usize] = place_of(self.count);
            }
        } else if let Some((first, extents)) = part(items, extent) {
            let (a, b) = items.split_at_mut(first);
            for (items, extent) in [a, b].into_iter().zip(&extents) {
                self.sort_out(group, grid, items, extent, cuts + 1);
            }
        }
    }
}

/// Parts primitives: those of a nested extent from the others, if they are many, or else where a cut costs least.
fn part(items: &mut [Item], extent: &Extent) -> Option<(usize, [Extent; 2])> {
    if items.len() < SAMPLE * WIDTH {
        return BinCut::new(items, extent).map(|cut| cut.part(items));
    }
    let sample: Vec<Item> = items.iter().step_by(items.len() / SAMPLE).copied().collect();
    // Where most are, their median is.
    let center: [f32; 3] = std::array::from_fn(|axis| {
        let mut middles: Vec<f32> = sample.iter().map(|item| item.middle(axis)).collect();
        let half = middles.len() / 2;
        0.5 * *middles.select_nth_unstable_by(half, f32::total_cmp).1
    });
    let is_near = |item: &Item| item.is_within(center, 0.49 * NESTED);
    if sample.iter().filter(|item| is_near(item)).count() > sample.len() / 4 {
        return Some(part_with_bounds(items, is_near));
    }
    BinCut::of_sample(items, extent).map(|cut| cut.part(items))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_no_frame_magnifies_stays_together() {
        let point = |k: u64| Sphere::new([f64::from_bits(k), 0.0, 0.0], 0.0).unwrap();
        let (trunk, crown) = grow((0..100).map(point).collect(), vec![]);
        assert_eq!((trunk.regions.len(), crown.is_some()), (1, false));
        // With a large one there are two groups.
        let large = Sphere::new([0.0; 3], 1.0).unwrap();
        let (trunk, crown) = grow((0..100).map(point).chain([large]).collect(), vec![]);
        assert_eq!((trunk.regions.len(), crown.is_some()), (1, true));
    }

    /// Copies of a few primitives are no crowd, however small they are: the tree stands for each with one.
    #[test]
    fn copies_are_no_crowd() {
        let ball = |i: u32| Sphere::new([f64::from(i % 8), 0.0, 0.0], 1e-9).unwrap();
        let (trunk, crown) = grow((0..800).map(ball).collect(), vec![]);
        assert_eq!((trunk.regions.len(), crown.is_some()), (1, false));
    }
}
