//! Where a frame is too coarse: where small primitives lie closer together than it resolves.
//!
//! A grid finds crowds before there is a tree: its cells are as wide as a crowd may be, and a table tells what is in
//! those that hold anything. Crowds across borders of cells are left to the leaf blocks of the tree.

use fearless_simd::Level;
use rayon::prelude::*;

use super::build::{Item, shortest_sides};
use super::node::WIDTH;
use crate::simd::dispatch;

/// Distances that a frame resolves: the slack of the balls is a 32nd of it. (In units of a radius between 1/2 and 1.)
const FINEST: f32 = 1.0 / (1 << 13) as f32;
/// So many primitives that are too close together are too many: fewer cost no more than their tests.
pub(super) const CROWD: usize = 4;
/// Of so many primitives all are looked at, of more a part.
pub(super) const ALL: usize = 1 << 13;

/// The cells of a grid that hold something.
#[derive(Default)]
pub(super) struct Grid {
    /// An open table.
    cells: Vec<Cell>,
    /// Cells of earlier times count as empty.
    time: u32,
}

/// What a cell holds: different primitives.
#[derive(Clone, Copy)]
struct Cell {
    key: u64,
    time: u32,
    count: u32,
    members: [u32; CROWD],
}

impl Grid {
    /// Whether the centers of a crowd of small primitives lie in one cell. `same` tells which primitives are equal.
    pub(super) fn is_crowded(&mut self, items: &[Item], same: impl Fn(u32, u32) -> bool) -> bool {
        if !may_be_fine(items) {
            return false;
        }
        // Few cells that hold many are found by a part of the primitives, many cells that hold few by a part of the
        // cells.
        let every = items.len().div_ceil(ALL).next_power_of_two();
        let most = items.len().div_ceil(every);
        self.look(items.iter().step_by(every), most, 1, &same)
            || every > 1 && self.look(items.iter(), most, every as u64, &same)
    }

    /// Whether there is a crowd in a cell, of which one in `every` is looked at, and no more than `most`.
    fn look<'a>(
        &mut self,
        items: impl Iterator<Item = &'a Item>,
        most: usize,
        every: u64,
        same: &impl Fn(u32, u32) -> bool,
    ) -> bool {
        // The table is never more than half full.
        let bits = (2 * most).next_power_of_two().ilog2();
        if self.cells.len() < 1 << bits {
            self.cells.resize(1 << bits, Cell { key: 0, time: 0, count: 0, members: [0; CROWD] });
        }
        let cells = &mut self.cells[..1 << bits];
        self.time += 1;
        let mut free = most;
        for item in items.filter(|item| is_fine(item)) {
            let key = key(item);
            // Some bits of the hash tell which cells are looked at.
            let hash = hash(key);
            if hash & (every - 1) != 0 {
                continue;
            }
            let mut at = usize::try_from(hash >> (64 - bits)).expect("a few bits");
            while cells[at].time == self.time && cells[at].key != key {
                at = (at + 1) % cells.len();
            }
            let cell = &mut cells[at];
            if cell.time != self.time {
                let Some(fewer) = free.checked_sub(1) else { return false };
                free = fewer;
                *cell = Cell { key, time: self.time, count: 0, ..*cell };
            }
            let count = cell.count as usize;
            if cell.members[..count].iter().any(|&member| same(member, item.index())) {
                continue;
            }
            cell.members[count] = item.index();
            cell.count += 1;
            if count + 1 == CROWD {
                return true;
            }
        }
        false
    }
}

/// Whether some primitives may be small: no if along one axis all of them are long.
fn may_be_fine(items: &[Item]) -> bool {
    let sides = dispatch!(Level::new(), simd => shortest_sides(simd, items));
    sides.into_iter().all(|side| side < FINEST)
}

/// The cell of a center: fifteen bits for each axis.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and 2^14, or saturates")]
fn key(item: &Item) -> u64 {
    let along = |axis: usize| u64::from(((item.middle(axis) + 4.0) * (0.25 / FINEST)) as u16);
    along(0) << 32 | along(1) << 16 | along(2)
}

/// Spreads keys, of which any bits may be the same, over all bits (the last steps of splitmix64).
fn hash(key: u64) -> u64 {
    let hash = (key ^ key >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let hash = (hash ^ hash >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
    hash ^ hash >> 31
}

#[inline(always)]
fn is_fine(item: &Item) -> bool {
    item.size() < FINEST && item.twin_of().is_none()
}

/// The primitives of the leaf blocks that hold a crowd.
pub(super) fn crowded_blocks(items: &[Item]) -> Vec<Item> {
    if !may_be_fine(items) {
        return Vec::new();
    }
    items.par_chunks(WIDTH).filter(|block| is_crowded_block(block)).flatten_iter().copied().collect()
}

fn is_crowded_block(block: &[Item]) -> bool {
    let fine = || block.iter().filter(|item| is_fine(item));
    fine().count() >= CROWD && fine().any(|a| fine().filter(|b| a.distance(b) < FINEST).count() >= CROWD)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Small items with centers `step` apart.
    fn line(n: u32, step: f32) -> Vec<Item> {
        let at = |i: u32| i as f32 * step - 0.5;
        (0..n).map(|i| Item::new([at(i), 0.1, 0.1, 0.0, -at(i), -0.1, -0.1, 0.0], i)).collect()
    }

    /// All but a few in one place, as small things among huge ones lie.
    #[test]
    fn a_grid_finds_the_only_crowd_of_all() {
        let mut grid = Grid::default();
        for n in [CROWD, 1_000, 100_000, 1_000_000] {
            let mut items = line(u32::try_from(n).unwrap(), 1e-12);
            items.extend(line(3, 0.1));
            assert!(grid.is_crowded(&items, |_, _| false), "{n}");
        }
    }

    #[test]
    fn a_grid_finds_crowds_of_different_primitives() {
        let mut grid = Grid::default();
        for n in [8, 100, 10_000, 100_000] {
            let (close, far) = (line(n, 0.45 * FINEST), line(n, 4.0 * FINEST));
            assert!(grid.is_crowded(&close, |_, _| false) && !crowded_blocks(&close).is_empty(), "{n}");
            // Pairs of equal ones, three or four of which are a crowd, and copies of one.
            assert!(!grid.is_crowded(&close, |a, b| a / 2 == b / 2), "{n}");
            assert!(!grid.is_crowded(&close, |_, _| true), "{n}");
            if n <= 10_000 {
                assert!(!grid.is_crowded(&far, |_, _| false) && crowded_blocks(&far).is_empty(), "{n}");
            }
        }
    }
}
