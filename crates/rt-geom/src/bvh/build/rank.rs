//! The order of a few numbers, found by counting for each how many are less: sixteen at a time, and without a branch on
//! what cannot be foretold. For so few that is several times faster than sorting.

use fearless_simd::{Simd, prelude::*, u32x16};

/// At most so many numbers are ordered.
pub(super) const MOST: usize = 128;

/// The places of the `keys` in ascending order of the keys, which are all different and at most [`MOST`]; zeros follow.
#[inline(always)]
pub(super) fn ascending<S: Simd>(simd: S, keys: &[u32]) -> [u8; MOST] {
    let ranks = ranks(simd, keys);
    let mut order = [0; MOST];
    for (place, &rank) in (0..).zip(&ranks[..keys.len()]) {
        order[rank as usize % MOST] = place;
    }
    order
}

#[inline(always)]
fn ranks<S: Simd>(simd: S, keys: &[u32]) -> [u32; MOST] {
    match keys.len() {
        0..=32 => count_less::<S, 2>(simd, keys),
        33..=64 => count_less::<S, 4>(simd, keys),
        _ => count_less::<S, 8>(simd, keys),
    }
}

/// For each key how many others are less.
#[inline(always)]
fn count_less<S: Simd, const VECTORS: usize>(simd: S, keys: &[u32]) -> [u32; MOST] {
    let mut padded = [u32::MAX; MOST];
    padded[..keys.len()].copy_from_slice(keys);
    let (none, one) = (u32x16::splat(simd, 0), u32x16::splat(simd, 1));
    let mut lanes = [none; VECTORS];
    for (lanes, keys) in lanes.iter_mut().zip(padded.as_chunks().0) {
        *lanes = u32x16::simd_from(simd, *keys);
    }
    let mut less = [none; VECTORS];
    for &key in keys {
        let key = u32x16::splat(simd, key);
        for (less, lanes) in less.iter_mut().zip(&lanes) {
            *less += key.simd_lt(*lanes).select(one, none);
        }
    }
    let mut ranks = [0; MOST];
    for (ranks, less) in ranks.as_chunks_mut().0.iter_mut().zip(less) {
        *ranks = less.into();
    }
    ranks
}

#[cfg(test)]
mod tests {
    use fearless_simd::{Fallback, Level};
    use oracle::Random;

    use super::*;
    use crate::simd::dispatch;

    fn ascending_at(level: Level, keys: &[u32]) -> [u8; MOST] {
        dispatch!(level, simd => ascending(simd, keys))
    }

    #[test]
    fn the_order_is_that_of_sorting() {
        let random = &mut Random::new(1);
        for n in 0..=MOST {
            for spread in [7, 20, 32] {
                // All different, as the place is in the low bits, and up to the largest number.
                let keys: Vec<u32> =
                    (0..).take(n).map(|i| (random.bits() >> 32) as u32 >> (32 - spread) << 7 | i).collect();
                let mut expected: Vec<u8> = (0..).take(n).collect();
                expected.sort_by_key(|&place| keys[usize::from(place)]);
                let best = Level::new();
                for level in [Level::Fallback(Fallback::new()), best] {
                    assert_eq!(ascending_at(level, &keys)[..n], expected, "{level:?} {keys:?}");
                }
            }
        }
    }

    #[test]
    fn the_largest_number_is_a_key_too() {
        assert_eq!(ascending_at(Level::new(), &[u32::MAX, 0, u32::MAX - 1])[..3], [1, 2, 0]);
    }
}
