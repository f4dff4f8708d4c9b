//! From planes to pixels: upsampling and colours, in the integers of libjpeg's `jdsample.c` and `jdcolor.c`.

use super::idct::Plane;

/// Sets `row` to the row `y` of a picture that has `across` columns and `down` rows for each of the plane's.
///
/// Half the columns or rows are filled in linearly, 3 : 1 between the two nearest, where there are more than two columns;
/// samples are repeated for every other ratio. The two directions of a sum of halves round up and down in turn.
pub(super) fn upsample(plane: &Plane, y: usize, (across, down): (usize, usize), row: &mut [u8]) {
    let near = plane.row(y / down);
    // The row on the other side of row y; the first and the last stand in for what is beyond them.
    let far = || {
        plane.row(if y.is_multiple_of(2) {
            (y / 2).saturating_sub(1)
        } else {
            (y / 2 + 1).min(plane.height - 1)
        })
    };
    let sum = |&a: &u8, &b: &u8| 3 * u16::from(a) + u16::from(b);
    match (across, down) {
        (1, 1) => row[..plane.width].copy_from_slice(near),
        (2, 1) if plane.width > 2 => {
            let column = |x: usize| u16::from(near[x]);
            spread(plane.width, column, 2, [1, 2], row);
        }
        (1, 2) => {
            let bias = if y.is_multiple_of(2) { 1 } else { 2 };
            for (out, (a, b)) in row.iter_mut().zip(near.iter().zip(far())) {
                *out = low_byte((sum(a, b) + bias) >> 2);
            }
        }
        (2, 2) if plane.width > 2 => {
            let far = far();
            spread(plane.width, |x| sum(&near[x], &far[x]), 4, [8, 7], row);
        }
        _ => {
            for (out, &sample) in row.chunks_mut(across).zip(near) {
                out.fill(sample);
            }
        }
    }
}

/// Two samples for each of the `width` columns, nearer to its left and to its right neighbour, divided by `2^shift` with
/// these biases.
fn spread(width: usize, column: impl Fn(usize) -> u16, shift: u32, bias: [u16; 2], row: &mut [u8]) {
    for (x, out) in row.as_chunks_mut::<2>().0.iter_mut().take(width).enumerate() {
        let neighbours = [x.saturating_sub(1), (x + 1).min(width - 1)];
        for ((out, neighbour), bias) in out.iter_mut().zip(neighbours).zip(bias) {
            *out = low_byte((3 * column(x) + column(neighbour) + bias) >> shift);
        }
    }
}

fn low_byte(value: u16) -> u8 {
    (value & 0xff) as u8
}

/// Red, green and blue of luma and chroma: T.871, with constants of 16 bits.
pub(super) fn ycc_to_rgb(luma: u8, blue: u8, red: u8) -> [u8; 3] {
    let (luma, blue, red) = (i32::from(luma), i32::from(blue) - 128, i32::from(red) - 128);
    const HALF: i32 = 1 << 15;
    [91881 * red, -22554 * blue - 46802 * red, 116_130 * blue]
        .map(|change| u8::try_from((luma + ((change + HALF) >> 16)).clamp(0, 255)).unwrap_or(u8::MAX))
}
