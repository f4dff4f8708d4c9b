//! Groups by scale: a frame resolves what is not much smaller than the scene, so what is goes to frames of its own.
//!
//! A group is cut up where its frame is too coarse for it: where a few small primitives lie so close together that the
//! slack of the cull (`cull.rs`) is no longer small beside their distances. All that is large stays. The rest is cut
//! from the top down, between bins, until the parts are small beside the group; the parts that are too fine for the
//! frame become groups, and the others stay with the large ones. What stays is a region, or, if it is little, single
//! primitives of the crown. A scene of one scale is one group, and has no crown.

use rayon::prelude::*;

use super::build::{BinCut, Binary, Item, Trunk, bounds_of};
use super::crown::{Box64, Crown, Part};
use super::node::{Frame, WIDTH};
use super::scene_sphere;
use crate::{Shape, Sphere, Triangle};

/// Distances that a frame resolves: the slack of the balls is a 32nd of it.
const FINEST: f32 = 1.0 / (1 << 13) as f32;
/// The extent of the largest groups within a group. (Both in units of a radius between 1/2 and 1.)
const NESTED: f32 = 1.0 / (1 << 6) as f32;
/// So many primitives that are too close together are too many: fewer cost no more than their tests.
const CROWD: usize = 4;
/// No part is cut more often than this.
const MAX_CUTS: u32 = 64;
/// Groups within groups may hold so many times the scene's primitives in all, which bounds the time to build, and some
/// more: a small scene has all that it needs.
const WORK: usize = 16;
const FREE_WORK: usize = 1 << 20;

/// Primitives of one part of the scene.
#[derive(Default)]
struct Group {
    spheres: Vec<Sphere>,
    triangles: Vec<Triangle>,
    /// Their indices; `None` if they are the whole scene.
    index: Option<Vec<u32>>,
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
        self.index.as_ref().map_or(place, |index| index[place as usize])
    }

    /// Those at some places.
    fn some(&self, mut places: Vec<u32>) -> Self {
        places.sort_unstable();
        let mut out = Self { index: Some(places.iter().map(|&place| self.index(place)).collect()), ..Self::default() };
        for place in places {
            match self.shape(place) {
                Shape::Sphere(sphere) => out.spheres.push(sphere),
                Shape::Triangle(triangle) => out.triangles.push(triangle),
            }
        }
        out
    }

    fn bounds(&self) -> Box64 {
        let boxes = self.spheres.iter().map(Box64::of_sphere).chain(self.triangles.iter().map(Box64::of_triangle));
        boxes.fold(Box64::EMPTY, Box64::merge)
    }

    /// The trees over both kinds in the group's frame.
    fn trees(&self) -> (Frame, Binary<'_, Sphere>, Binary<'_, Triangle>) {
        let frame = Frame::around(scene_sphere(&self.spheres, &self.triangles).as_ref());
        (frame, Binary::new(&self.spheres, &frame), Binary::new(&self.triangles, &frame))
    }
}

/// What the crown has for a group.
enum Entry {
    Part(Part),
    Group(usize),
}

/// Builds the tree, and a crown if it has more than one region.
pub(super) fn grow(spheres: Vec<Sphere>, triangles: Vec<Triangle>) -> (Trunk, Option<Crown>) {
    let mut trunk = Trunk::default();
    let mut work = WORK * (spheres.len() + triangles.len()) + FREE_WORK;
    let mut groups = vec![Group { spheres, triangles, index: None }];
    let mut entries: Vec<Vec<(Box64, Entry)>> = Vec::new();
    // (Their number for now: their places follow those of all regions.)
    let mut singles: Vec<(Shape, u32)> = Vec::new();
    while let Some(group) = groups.get_mut(entries.len()).map(std::mem::take) {
        let nested = group.index.is_some();
        let mut inside = Vec::new();
        let mut rest = Group::default();
        if nested && group.len() <= WIDTH {
            rest = group;
        } else {
            let (frame, spheres, triangles) = group.trees();
            let crowded = group.len() <= work && (is_crowded(&spheres.items) || is_crowded(&triangles.items));
            work -= group.len().min(work);
            let parts = if crowded { Parts::new(&group, &spheres.items, &triangles.items) } else { Parts::default() };
            if parts.groups.is_empty() && !(crowded && group.len() <= WIDTH) {
                let bounds = if nested { group.bounds() } else { Box64::EMPTY };
                inside.push((bounds, Entry::Part(trunk.grow(frame, (spheres, triangles), |i| group.index(i)))));
            } else {
                rest = group.some(parts.rest);
                for places in parts.groups {
                    let part = group.some(places);
                    inside.push((part.bounds(), Entry::Group(groups.len())));
                    groups.push(part);
                }
            }
        }
        if rest.len() > WIDTH {
            let (frame, spheres, triangles) = rest.trees();
            let part = trunk.grow(frame, (spheres, triangles), |i| rest.index(i));
            inside.push((rest.bounds(), Entry::Part(part)));
        } else {
            for place in (0..).take(rest.len()) {
                let (shape, number) = (rest.shape(place), place_of(singles.len()));
                inside.push(match shape {
                    Shape::Sphere(sphere) => (Box64::of_sphere(&sphere), Entry::Part(Part::Sphere(number))),
                    Shape::Triangle(triangle) => (Box64::of_triangle(&triangle), Entry::Part(Part::Triangle(number))),
                });
                singles.push((shape, rest.index(place)));
            }
        }
        entries.push(inside);
    }
    if let [only] = &entries[..]
        && let [(_, Entry::Part(Part::Region(_)))] = only[..]
    {
        return (trunk, None);
    }
    let places: Vec<usize> = singles.into_iter().map(|(shape, index)| trunk.add(shape, index)).collect();
    let crown = crown(entries, |number| place_of(places[number as usize]));
    (trunk, Some(crown))
}

/// Joins the entries of all groups, of which those of a group follow it.
fn crown(entries: Vec<Vec<(Box64, Entry)>>, place: impl Fn(u32) -> u32) -> Crown {
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

/// Whether a leaf block holds more small primitives close together than its frame resolves.
fn is_crowded(items: &[Item]) -> bool {
    items.par_chunks(WIDTH).any(is_crowded_block)
}

fn is_crowded_block(block: &[Item]) -> bool {
    let fine = |item: &&Item| item.twin_of().is_none() && item.size() < FINEST;
    block.iter().filter(fine).count() >= CROWD
        && block.iter().filter(fine).any(|a| {
            let near = |b: &&Item| a.distance(b) < FINEST;
            block.iter().filter(fine).filter(near).count() >= CROWD
        })
}

/// The places of what stays in a group, and of the groups within it.
#[derive(Default)]
struct Parts {
    rest: Vec<u32>,
    groups: Vec<Vec<u32>>,
}

impl Parts {
    fn new(group: &Group, spheres: &[Item], triangles: &[Item]) -> Self {
        let first = place_of(spheres.len());
        let triangles = triangles.iter().map(|item| item.with_index(first + item.index()));
        let items = spheres.iter().map(|item| item.with_index(item.index())).chain(triangles);
        let (large, mut small): (Vec<Item>, Vec<Item>) = items.partition(|item| item.size() >= NESTED);
        let mut parts = Self::default();
        parts.stay(&large);
        parts.sort_out(group, &mut small, 0);
        if let ([], [_]) = (&parts.rest[..], &parts.groups[..]) {
            // The frame of subnormal numbers, which no other magnifies more.
            parts.rest = parts.groups.remove(0);
        }
        parts
    }

    fn stay(&mut self, items: &[Item]) {
        self.rest.extend(items.iter().map(Item::index));
    }

    /// Sorts small primitives out. The recursion is no deeper than [`MAX_CUTS`].
    fn sort_out(&mut self, group: &Group, items: &mut [Item], cuts: u32) {
        let extent = bounds_of(items);
        if items.len() < CROWD || cuts == MAX_CUTS {
            self.stay(items);
        } else if extent.size() < NESTED {
            if is_too_fine(group, items, cuts) {
                self.groups.push(items.iter().map(Item::index).collect());
            } else {
                self.stay(items);
            }
        } else if let Some((a, b)) = BinCut::new(items, &extent).part(items) {
            self.sort_out(group, a, cuts + 1);
            self.sort_out(group, b, cuts + 1);
        } else {
            self.stay(items);
        }
    }
}

/// Whether some of the primitives, and not all equal, are closer together than the frame resolves.
fn is_too_fine(group: &Group, items: &mut [Item], cuts: u32) -> bool {
    let extent = bounds_of(items);
    if items.len() <= WIDTH || extent.size() < FINEST {
        is_crowded_block(items) && differ(group, items)
    } else if cuts < MAX_CUTS
        && let Some((a, b)) = BinCut::new(items, &extent).part(items)
    {
        is_too_fine(group, a, cuts + 1) || is_too_fine(group, b, cuts + 1)
    } else {
        false
    }
}

/// Whether there are several different primitives.
fn differ(group: &Group, items: &[Item]) -> bool {
    let mut different: Vec<Shape> = Vec::new();
    items.iter().any(|item| {
        let shape = group.shape(item.index());
        if !different.contains(&shape) {
            different.push(shape);
        }
        different.len() == CROWD
    })
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
