//! Many rays in tiles: which of them may make one, and where tiles pay.
//!
//! Rays of one origin and nearly one direction walk the tree together (`tile_walk.rs`), the others many at once (`batch.rs`).
//! Tiles are found by a look at the rays alone: neighbours in the caller's order, or in the rows of a picture. How many
//! rays are worth a tile depends on the scene; the tests that the last tiles took tell.

use std::ops::Range;

use fearless_simd::Simd;

use super::Bvh;
use super::batch::fly;
use super::node::WIDTH;
use super::tile::{RAYS, Tile};
use super::tile_walk::{Outcome, closest};
use crate::leaf::Closest;
use crate::ray::is_open;
use crate::{Hit, Ray};

/// Rays of which tiles are made at once.
const BLOCK: usize = 1 << 16;

/// Tests of bounds after which smaller tiles are cheaper, rays one by one are cheaper, and larger tiles are again. Above
/// a million and a hundred thousand spheres and triangles the turning points were 200 to 330, 140 to 190 and about 50
/// (Intel, AVX-512). No answer depends on them.
const WORTH_LARGE: u32 = 240;
const WORTH_SMALL: u32 = 160;
const WORTH_GROWING: u32 = 48;
/// A tile is given up after this many times what is worth it.
const GIVE_UP: u32 = 2;
/// Tiles that are left out at most where they do not pay, before the next is tried.
const LONGEST_PAUSE: u32 = 64;

/// Which tiles pay, judged by the last ones.
struct Judge {
    large: bool,
    pause: u32,
    next_pause: u32,
}

impl Judge {
    const HOPEFUL: Self = Self { large: true, pause: 0, next_pause: 1 };

    /// Judges by the tests that a large tile took, or small ones on average; `None` if there was none.
    fn learn(&mut self, large: bool, work: Option<u32>) {
        let (worth, growing) = if large { (WORTH_LARGE, WORTH_LARGE) } else { (WORTH_SMALL, WORTH_GROWING) };
        self.large = work.is_some_and(|work| work <= growing);
        if large || work.is_some_and(|work| work <= worth) {
            self.next_pause = 1;
        } else {
            self.pause = self.next_pause;
            self.next_pause = LONGEST_PAUSE.min(2 * self.next_pause);
        }
    }
}

/// Writes the closest hit of each ray: in tiles where rays make some, the others many at once.
#[inline(always)]
pub(super) fn closest_batch<S: Simd>(
    simd: S,
    tree: &Bvh,
    rays: &[Ray],
    within: &Range<f64>,
    answers: &mut [Option<Hit>],
) {
    // A range from -0 on holds hits behind the origin that round to -0, which the boxes of a tile do not count on.
    if !(within.start.is_sign_positive() && is_open(within)) {
        tree.batch::<Closest>(rays, within, answers);
        return;
    }
    let mut tile = Tile::new(tree.leaves.spheres.len(), tree.leaves.triangles.len());
    let mut stack = vec![0; tree.stack];
    let mut alone = Vec::new();
    let mut judge = Judge::HOPEFUL;
    for (rays, answers) in rays.chunks(BLOCK).zip(answers.chunks_mut(BLOCK)) {
        alone.clear();
        let mut tiles = Tiles::new(rays);
        while let Some(order) = tiles.next() {
            if judge.pause > 0 {
                judge.pause -= 1;
                alone.extend_from_slice(order);
                continue;
            }
            // A tile that is none may be four small ones.
            let mut large = judge.large;
            let (mut works, mut count) = (0, 0);
            loop {
                let (size, worth) = if large { (RAYS, WORTH_LARGE) } else { (WIDTH, WORTH_SMALL) };
                for order in order.chunks(size) {
                    let whole = (&mut tile, &mut stack[..]);
                    match closest(simd, tree, whole, (rays, order), within, answers, GIVE_UP * worth) {
                        Outcome::Done(work) => {
                            works += work;
                            count += 1;
                        }
                        Outcome::NoTile if large => {}
                        Outcome::NoTile => alone.extend_from_slice(order),
                    }
                }
                if !large || count > 0 {
                    break;
                }
                large = false;
            }
            judge.learn(large, (count > 0).then(|| works / count));
        }
        if !tree.flies {
            tree.one_by_one::<Closest>(rays, alone.iter().copied(), within, answers);
        } else if !alone.is_empty() {
            fly::<S, Closest>(simd, tree, rays, Some(&alone), within, answers);
        }
    }
}

/// Parts rays into what may be tiles: squares where the rays are rows of a picture, else as they follow each other.
struct Tiles {
    rays: usize,
    /// Rays of a row; no less than a tile's where there are no rows.
    width: usize,
    /// The first ray of the row and the column where the next tile begins.
    row: usize,
    column: usize,
    order: [usize; RAYS],
}

impl Tiles {
    fn new(rays: &[Ray]) -> Self {
        Self { rays: rays.len(), width: row_length(rays), row: 0, column: 0, order: [0; RAYS] }
    }

    /// The next rays; each ray comes once at least.
    #[inline(always)]
    fn next(&mut self) -> Option<&[usize]> {
        let left = self.rays - self.row;
        let rows = [8, 4, 2].into_iter().find(|rows| rows * self.width <= left && RAYS / rows <= self.width);
        let Some(rows) = rows else {
            let len = left.min(RAYS);
            self.order.iter_mut().zip(self.row..).for_each(|(place, ray)| *place = ray);
            self.row += len;
            return (len > 0).then_some(&self.order[..len]);
        };
        // Squares of four by four rays follow each other.
        let columns = RAYS / rows;
        let first = self.row + self.column.min(self.width - columns);
        for (lane, place) in self.order.iter_mut().enumerate() {
            let (square, row, column) = (lane / 16, lane / 4 % 4, lane % 4);
            let (row, column) = match rows {
                2 => (lane / 4 % 2, lane / 8 * 4 + column),
                _ => (square / (columns / 4) * 4 + row, square % (columns / 4) * 4 + column),
            };
            *place = first + row * self.width + column;
        }
        self.column += columns;
        if self.column >= self.width {
            self.column = 0;
            self.row += rows * self.width;
        }
        Some(&self.order)
    }
}

/// After how many rays the directions begin anew, as those of a picture's rows do; the number of rays if they do not.
fn row_length(rays: &[Ray]) -> usize {
    let Some(first) = rays.first() else { return 1 };
    let apart = |a: &Ray, b: &Ray| (a.direction() - b.direction()).length_squared();
    let mut pairs = rays.windows(2).enumerate().take_while(|(_, pair)| pair[1].origin() == first.origin());
    let row = pairs.find(|(i, pair)| *i > 0 && apart(&pair[1], first) < apart(&pair[1], &pair[0]));
    row.map_or(rays.len(), |(i, _)| i + 1)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use oracle::Random;

    use super::*;
    use crate::simd::baseline;
    use crate::{AHEAD, Sphere};

    fn picture(width: i32, height: i32) -> Vec<Ray> {
        let pixels = (0..width * height).map(|i| DVec3::new(f64::from(i % width), f64::from(i / width), 1e3));
        pixels.map(|direction| Ray::new(DVec3::ZERO, direction).unwrap()).collect()
    }

    #[test]
    fn the_rows_of_a_picture_are_found() {
        for (width, height, expected) in [(100, 9, 100), (7, 3, 7), (1, 5, 5), (5, 1, 5), (64, 64, 64), (2, 2, 2)] {
            assert_eq!(row_length(&picture(width, height)), expected, "{width} x {height}");
        }
        assert_eq!((row_length(&[]), row_length(&picture(1, 1))), (1, 1));
    }

    /// Each ray comes, and where a picture has eight rows of eight, tiles are squares of squares.
    #[test]
    fn tiles_take_every_ray() {
        for (width, height) in [(1, 1), (64, 8), (37, 19), (8, 8), (9, 9), (200, 3), (130, 5), (5, 200), (16, 4)] {
            let rays = picture(width, height);
            let mut count = vec![0; rays.len()];
            let mut tiles = Tiles::new(&rays);
            while let Some(order) = tiles.next() {
                order.iter().for_each(|&ray| count[ray] += 1);
                let (rows, columns): (Vec<_>, Vec<_>) =
                    order.iter().map(|&ray| (ray / width as usize, ray % width as usize)).unzip();
                let extent = |numbers: &[usize]| numbers.iter().max().unwrap() - numbers.iter().min().unwrap();
                let whole = rows[0] + 8 <= height as usize;
                assert!(!whole || width < 9 || (extent(&rows), extent(&columns)) == (7, 7), "{width} x {height}");
            }
            assert!(count.iter().all(|&count| count >= 1), "{width} x {height}: {count:?}");
        }
    }

    #[test]
    fn tiles_that_do_not_pay_are_left_out_for_longer_and_longer() {
        let mut judge = Judge::HOPEFUL;
        judge.learn(true, Some(WORTH_LARGE));
        assert!(judge.large && judge.pause == 0);
        judge.learn(true, Some(WORTH_LARGE + 1));
        assert!(!judge.large && judge.pause == 0);
        judge.learn(false, Some(WORTH_SMALL));
        assert!(!judge.large && judge.pause == 0);
        for pause in [1, 2, 4, 8, 16, 32, 64, 64] {
            judge.learn(false, [None, Some(WORTH_SMALL + 1)][pause as usize % 2]);
            assert_eq!((judge.large, judge.pause), (false, pause));
        }
        judge.learn(false, Some(WORTH_GROWING));
        assert!(judge.large && judge.next_pause == 1);
    }

    #[inline(always)]
    fn attempt<S: Simd>(simd: S, tree: &Bvh, rays: &[Ray], most: u32) -> Option<u32> {
        let order: Vec<usize> = (0..rays.len()).collect();
        let (mut tile, mut stack) =
            (Tile::new(tree.leaves.spheres.len(), tree.leaves.triangles.len()), vec![0; tree.stack]);
        let answers = &mut vec![None; rays.len()];
        let whole = (&mut tile, &mut stack[..]);
        match closest(simd, tree, whole, (rays, &order), &AHEAD, answers, most) {
            Outcome::Done(work) => Some(work),
            Outcome::NoTile => None,
        }
    }

    /// The tests of bounds that the rays cost as a tile, if they are one and these are at most `most`.
    fn work(tree: &Bvh, rays: &[Ray], most: u32) -> Option<u32> {
        attempt(baseline(), tree, rays, most)
    }

    /// A tile costs a few tests, where its rays alone take several each; what is no tile is refused.
    #[test]
    fn coherent_rays_walk_together_and_others_do_not() {
        let random = &mut Random::new(2);
        let ball = |random: &mut Random| Sphere::new(random.point(), 0.02).unwrap();
        let tree = Bvh::new((0..10_000).map(|_| ball(random)).collect(), vec![]);
        let tile = |origin: DVec3, direction: DVec3, width: f64| -> Vec<Ray> {
            let ray = |i: u32| {
                let (x, y) = (f64::from(i % 8), f64::from(i / 8));
                Ray::new(origin, direction + width * DVec3::new(x, y, 0.0)).unwrap()
            };
            (0..64).map(ray).collect()
        };
        let (eye, ahead) = (DVec3::new(0.0, 0.0, -3.0), DVec3::new(0.05, 0.07, 1.0));
        let good = tile(eye, ahead, 1e-3);
        let all = work(&tree, &good, u32::MAX).unwrap();
        let alone: usize = good.iter().map(|ray| tree.closest_counted(ray, AHEAD).1.nodes).sum();
        assert!((3..60).contains(&all) && 4 * all as usize <= alone, "{all} {alone}");
        assert_eq!(work(&tree, &good, all / 2), None);

        let mut two_eyes = good.clone();
        two_eyes[63] = Ray::new(eye + DVec3::X, ahead).unwrap();
        let mut short = good.clone();
        short[5] = Ray::new(eye, ahead * 1e-200).unwrap();
        let refused = [
            ("two eyes", two_eyes),
            ("a short direction", short),
            ("wide", tile(eye, ahead, 0.1)),
            ("on both sides of an axis", tile(eye, DVec3::new(-0.002, 0.07, 1.0), 1e-3)),
            ("far away", tile(eye * 1e3, ahead, 1e-3)),
        ];
        for (name, rays) in refused {
            assert_eq!(work(&tree, &rays, u32::MAX), None, "{name}");
        }
        assert!(work(&tree, &tile(eye, DVec3::new(0.0, -0.0, 1.0), 1e-3), u32::MAX).is_some(), "along an axis");
    }

    /// A fan of rays in a plane across an axis, as a line scanner casts it: one component is zero in all of them, with
    /// either sign. Single rays give the same answers.
    #[test]
    fn a_fan_in_a_plane_across_an_axis_is_a_tile() {
        let random = &mut Random::new(7);
        let ball = |random: &mut Random| Sphere::new(0.5 * random.point(), 0.03).unwrap();
        let triangle = |random: &mut Random| {
            let at = 0.5 * random.point();
            let [a, b, c] = [(); 3].map(|()| at + 0.05 * random.point());
            crate::Triangle::new(a, b, c).unwrap()
        };
        let (mut hits, mut tiles) = (0, 0);
        for round in 0..60 {
            let tree = match round % 3 {
                0 => Bvh::new((0..2_000).map(|_| ball(random)).collect(), vec![]),
                1 => Bvh::new(vec![], (0..2_000).map(|_| triangle(random)).collect()),
                _ => Bvh::new((0..500).map(|_| ball(random)).collect(), (0..500).map(|_| triangle(random)).collect()),
            };
            let axis = round / 3 % 3;
            let mut eye = 0.3 * random.point();
            eye[(axis + 1) % 3] = -2.0;
            let ray = |i: u32| {
                let mut direction = DVec3::splat(0.05 + 0.002 * f64::from(i));
                direction[axis] = if round % 2 == 0 { 0.0 } else { -0.0 };
                direction[(axis + 1) % 3] = 1.0;
                Ray::new(eye, direction).unwrap()
            };
            let rays: Vec<Ray> = (0..64).map(ray).collect();
            tiles += usize::from(work(&tree, &rays, u32::MAX).is_some());
            let mut together = vec![None; rays.len()];
            tree.closest_batch(&rays, AHEAD, &mut together);
            let alone: Vec<Option<Hit>> = rays.iter().map(|ray| tree.closest(ray, AHEAD)).collect();
            assert_eq!(together, alone, "{round}");
            hits += alone.iter().flatten().count();
        }
        assert!(tiles > 30 && hits > 200, "{tiles} {hits}");
    }
}
