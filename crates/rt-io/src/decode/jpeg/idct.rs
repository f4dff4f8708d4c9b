//! The inverse transform of a block, in the integers of libjpeg's `jidctint.c`, so that samples are the same to the bit.
//!
//! Source: C. Loeffler, A. Ligtenberg, G. Moschytz, "Practical Fast 1-D DCT Algorithms with 11 Multiplications", 1989.

/// The samples of one component, whole blocks of them.
pub(super) struct Plane {
    /// Columns and rows that belong to the picture.
    pub(super) width: usize,
    pub(super) height: usize,
    /// Samples from one row to the next: a multiple of 8.
    pub(super) stride: usize,
    pub(super) samples: Vec<u8>,
}

/// Place in the block of the coefficients as they are sent (figure A.6).
const ZIGZAG: [usize; 64] = [
    0, 1, 8, 16, 9, 2, 3, 10, 17, 24, 32, 25, 18, 11, 4, 5, 12, 19, 26, 33, 40, 48, 41, 34, 27, 20, 13, 6, 7,
    14, 21, 28, 35, 42, 49, 56, 57, 50, 43, 36, 29, 22, 15, 23, 30, 37, 44, 51, 58, 59, 52, 45, 38, 31, 39,
    46, 53, 60, 61, 54, 47, 55, 62, 63,
];

impl Plane {
    /// The row `y`, without what fills up its last block.
    pub(super) fn row(&self, y: usize) -> &[u8] {
        &self.samples[y * self.stride..][..self.width]
    }

    /// Sets the block in `column` and `row` from its coefficients in zigzag order, each to be multiplied by its step.
    pub(super) fn set_block(
        &mut self,
        column: usize,
        row: usize,
        coefficients: &[i32; 64],
        steps: &[u16; 64],
    ) {
        let mut work = [0_i64; 64];
        for ((&place, &coefficient), &step) in ZIGZAG.iter().zip(coefficients).zip(steps) {
            work[place] = i64::from(coefficient) * i64::from(step);
        }
        // Columns, kept with two bits more; then rows, with the 8 of both passes' scale.
        for x in 0..8 {
            let column = [0, 1, 2, 3, 4, 5, 6, 7].map(|y| work[8 * y + x]);
            let column = match column {
                // Most columns of a picture; the same numbers in one step.
                [constant, 0, 0, 0, 0, 0, 0, 0] => [constant << EXTRA; 8],
                _ => one_dimension(column, SCALE - EXTRA),
            };
            for (y, value) in column.into_iter().enumerate() {
                work[8 * y + x] = value;
            }
        }
        for (y, line) in work.as_chunks().0.iter().enumerate() {
            let start = (8 * row + y) * self.stride + 8 * column;
            let samples = one_dimension(*line, SCALE + EXTRA + 3);
            for (sample, value) in self.samples[start..start + 8].iter_mut().zip(samples) {
                *sample = u8::try_from((value + 128).clamp(0, 255)).unwrap_or(u8::MAX);
            }
        }
    }
}

/// Bits behind the point of the constants.
const SCALE: u32 = 13;

/// Bits more that the first pass keeps.
const EXTRA: u32 = 2;

/// One dimension; results are divided by `2^shift` and rounded. Coefficients of 16 bits by steps of 16 give less than
/// 2^31; each pass makes that larger by less than 2^18 and the first then divides by 2^11: nothing overflows.
fn one_dimension(input: [i64; 8], shift: u32) -> [i64; 8] {
    // Even part: the rotation is by 6 pi / 16.
    let z1 = (input[2] + input[6]) * 4433;
    let t2 = z1 - input[6] * 15137;
    let t3 = z1 + input[2] * 6270;
    let t0 = (input[0] + input[4]) << SCALE;
    let t1 = (input[0] - input[4]) << SCALE;
    let even = [t0 + t3, t1 + t2, t1 - t2, t0 - t3];

    // Odd part: figure 8 of the paper, turned round.
    let [t0, t1, t2, t3] = [input[7], input[5], input[3], input[1]];
    let (z1, z2, z3, z4) = (t0 + t3, t1 + t2, t0 + t2, t1 + t3);
    let z5 = (z3 + z4) * 9633;
    let (z1, z2, z3, z4) = (z1 * -7373, z2 * -20995, z3 * -16069 + z5, z4 * -3196 + z5);
    let odd = [t3 * 12299 + z1 + z4, t2 * 25172 + z2 + z3, t1 * 16819 + z2 + z4, t0 * 2446 + z1 + z3];

    let half = 1 << (shift - 1);
    let place = |index: usize| {
        let value = if index < 4 { even[index] + odd[index] } else { even[7 - index] - odd[7 - index] };
        (value + half) >> shift
    };
    [0, 1, 2, 3, 4, 5, 6, 7].map(place)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The transform as it is defined (A.3.3), in f64.
    fn defined(coefficients: &[i32; 64], x: usize, y: usize) -> f64 {
        let wave = |position: usize, frequency: usize| {
            let scale = if frequency == 0 { 0.125_f64.sqrt() } else { 0.5 };
            let angle = (2 * position + 1) as f64 * frequency as f64 * std::f64::consts::PI / 16.0;
            scale * angle.cos()
        };
        let term =
            |(&place, &value): (&usize, &i32)| f64::from(value) * wave(x, place % 8) * wave(y, place / 8);
        ZIGZAG.iter().zip(coefficients).map(term).sum()
    }

    #[test]
    fn a_block_is_within_one_of_its_definition() {
        let mut state = 7_u64;
        for _ in 0..200 {
            let coefficients = [(); 64].map(|()| {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                i32::try_from(state >> 60).unwrap() * 20 - 150
            });
            let mut plane = Plane { width: 16, height: 8, stride: 16, samples: vec![0; 128] };
            plane.set_block(1, 0, &coefficients, &[1; 64]);
            for y in 0..8 {
                assert_eq!(plane.row(y)[..8], [0; 8], "the block beside it");
                for x in 0..8 {
                    let expected = (defined(&coefficients, x, y) + 128.0).clamp(0.0, 255.0);
                    let found = f64::from(plane.row(y)[8 + x]);
                    assert!(
                        (found - expected).abs() <= 1.0,
                        "{coefficients:?} at {x} {y}: {found} for {expected}"
                    );
                }
            }
        }
    }

    #[test]
    fn the_largest_numbers_do_not_overflow() {
        let mut plane = Plane { width: 8, height: 8, stride: 8, samples: vec![0; 64] };
        for value in [i32::from(i16::MIN), i32::from(i16::MAX)] {
            plane.set_block(0, 0, &[value; 64], &[u16::MAX; 64]);
        }
    }
}
