//! An order of points in which neighbours in the list are neighbours in space: the Hilbert curve.
//!
//! The curve visits each cell of a grid of `2^BITS` cells an axis once, each next to the one before, and every cube of
//! `2^k` cells in one piece. So halves of the list are compact, and so are their halves.

use glam::DVec3;
use rayon::prelude::*;

/// Steps of each coordinate, as a power of two.
const BITS: u32 = 21;

/// How often a cell's points are told apart by a finer grid: together as good as all the bits of a double.
const LEVELS: u32 = 4;

/// Sorts the indices of points along the curve through their bounding box; equal points by index. The points are
/// finite.
pub(crate) fn sort(indices: &mut [u32], point: &(dyn Fn(u32) -> DVec3 + Sync)) {
    sort_cell(indices, point, LEVELS);
}

fn sort_cell(indices: &mut [u32], point: &(dyn Fn(u32) -> DVec3 + Sync), levels: u32) {
    // Halved, so that no difference overflows.
    let half = |i: u32| 0.5 * point(i);
    let points = || indices.iter().map(|&i| half(i));
    let (low, high) = points().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    let size = (high - low).max_element();
    if levels == 0 || size.is_nan() || size <= 0.0 {
        indices.sort_unstable();
        return;
    }
    let steps = f64::from((1 << BITS) - 1);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 2^21, rounded towards zero")]
    let cell = |p: DVec3| ((p - low) / size * steps).to_array().map(|x| x as u32);
    let mut keys: Vec<(u64, u32)> = indices.par_iter().map(|&i| (place_on_curve(cell(half(i))), i)).collect();
    keys.par_sort_unstable();
    for (index, key) in indices.iter_mut().zip(&keys) {
        *index = key.1;
    }
    let mut rest = indices;
    for cell in keys.chunk_by(|a, b| a.0 == b.0) {
        let (these, others) = rest.split_at_mut(cell.len());
        if cell.len() > 2 {
            sort_cell(these, point, levels - 1);
        }
        rest = others;
    }
}

/// How far along the curve a cell is.
///
/// Source: J. Skilling, "Programming the Hilbert curve", AIP Conference Proceedings 707, 2004.
fn place_on_curve(mut axes: [u32; 3]) -> u64 {
    // From the largest cubes down, undo the swap or the reflection that the curve makes in each.
    for bit in (1..BITS).rev() {
        let low = (1 << bit) - 1;
        for axis in 0..3 {
            let reflect = 0u32.wrapping_sub(axes[axis] >> bit & 1) & low;
            let swap = (axes[0] ^ axes[axis]) & low & !reflect;
            axes[0] ^= reflect | swap;
            axes[axis] ^= swap;
        }
    }
    // What is left is a Gray code.
    axes[1] ^= axes[0];
    axes[2] ^= axes[1];
    let mut parity = 0;
    for bit in 1..BITS {
        parity ^= 0u32.wrapping_sub(axes[2] >> bit & 1) & ((1 << bit) - 1);
    }
    let [x, y, z] = axes.map(|axis| spread(axis ^ parity));
    x << 2 | y << 1 | z
}

/// Moves bit `k` of a number of 21 bits to bit `3 k`.
fn spread(x: u32) -> u64 {
    let x = u64::from(x);
    let x = (x | x << 32) & 0x001f_0000_0000_ffff;
    let x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    let x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    let x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_visits_every_cell_once_and_steps_to_a_neighbour() {
        // The first 512 cells of the curve: a cube of eight cells a side.
        let mut cells: Vec<(u64, [i64; 3])> = Vec::new();
        for cell in 0..512u32 {
            let axes = [cell & 7, cell >> 3 & 7, cell >> 6];
            cells.push((place_on_curve(axes), axes.map(i64::from)));
        }
        cells.sort_unstable();
        for (place, (key, _)) in cells.iter().enumerate() {
            assert_eq!(*key, place as u64);
        }
        for pair in cells.windows(2) {
            let steps: i64 = (0..3).map(|axis| (pair[0].1[axis] - pair[1].1[axis]).abs()).sum();
            assert_eq!(steps, 1, "{pair:?}");
        }
    }

    #[test]
    fn sorting_keeps_every_index_and_equal_points_by_index() {
        let points =
            [DVec3::ZERO, DVec3::ONE, DVec3::ZERO, DVec3::splat(-f64::MAX), DVec3::splat(f64::MAX), DVec3::ZERO];
        let mut indices: Vec<u32> = (0..6).collect();
        sort(&mut indices, &|i| points[i as usize]);
        let places: Vec<usize> = (0..6).map(|i| indices.iter().position(|&j| j == i).unwrap()).collect();
        assert!(places[0] < places[2] && places[2] < places[5], "{indices:?}");
    }

    #[test]
    fn points_of_one_cell_are_told_apart_on_a_finer_grid() {
        // One far point, and a thousand on a line within a cell of the coarsest grid.
        let point = |i: u32| DVec3::X * if i == 0 { 1e9 } else { f64::from(i * 389 % 1009) };
        let mut indices: Vec<u32> = (0..1001).collect();
        sort(&mut indices, &point);
        let jumps: f64 = indices.windows(2).map(|pair| (point(pair[0]).x - point(pair[1]).x).abs()).sum();
        assert!(jumps < 1e9 + 4.0 * 1009.0, "{jumps}");
    }
}
