//! Pictures as 8-bit samples.

use figures::camera::{Size, View};
use glam::DVec3;
use rt_geom::Ray;
use rt_io::{Pixmap, png};
use rt_shade::color::{clamp, to_sample};

/// A picture's samples, row by row.
pub(super) type Samples8 = Vec<u8>;

/// Draws a picture ray by ray.
pub(super) fn paint(view: &View, samples: impl Fn(&Ray) -> [u8; 3]) -> Samples8 {
    let Size { width, height, .. } = view.size();
    let pixels = (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
    pixels.flat_map(|(column, row)| samples(&view.ray(column, row))).collect()
}

/// The three samples of a pixel.
pub(super) fn samples(color: DVec3) -> [u8; 3] {
    clamp(color).to_array().map(|c| u8::try_from(to_sample(c, 255)).expect("a sample is at most maxval"))
}

/// A picture as the bytes of a PNG file.
pub(super) fn as_png(samples: Samples8, Size { width, height, .. }: Size) -> Vec<u8> {
    let samples = samples.into_iter().map(u16::from).collect();
    let pixmap = Pixmap::new(width as usize, height as usize, 255, samples).expect("as many samples as pixels");
    let mut bytes = Vec::new();
    png::write(&pixmap, &mut bytes).expect("a vector takes every byte");
    bytes
}
