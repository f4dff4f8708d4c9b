//! Any picture, and its bytes as a PPM.

use proptest::prelude::*;
use rt_io::Pixmap;
use rt_io::ppm::{self, Encoding};

/// Pictures of at most this size, with every `maxval`, those at which its digits and bytes change above all.
pub(crate) fn pixmaps(columns: usize, rows: usize) -> impl Strategy<Value = Pixmap> {
    let maxval = prop_oneof![
        prop::sample::select(vec![1, 9, 10, 99, 100, 255, 256, 999, 1000, 9999, 10000, 65535]),
        1..=65535_u16
    ];
    (1..=columns, 1..=rows, maxval).prop_flat_map(|(width, height, maxval)| {
        prop::collection::vec(0..=maxval, 3 * width * height)
            .prop_map(move |samples| Pixmap::new(width, height, maxval, samples).unwrap())
    })
}

pub(crate) fn encode(pixmap: &Pixmap, encoding: Encoding) -> Vec<u8> {
    let mut bytes = Vec::new();
    ppm::write(pixmap, encoding, &mut bytes).unwrap();
    bytes
}
