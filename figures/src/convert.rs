//! Converts an image to PPM: replaces the report's script.

use std::path::Path;

use rt_io::{Limits, read_image};

use crate::outcome::Failure;
use crate::output::{Picture, PictureFormat, Target};
use crate::{memory, stderr};

/// Reads the image `input`, in any format that is read, and writes it to `output`.
///
/// Samples keep their depth unless `maxval` says otherwise: 8 bits, or 16 where the image has more. Grey becomes RGB.
/// Alpha is dropped, with a warning if a sample is not opaque.
///
/// # Errors
/// What is wrong with the image, or why the result could not be written.
pub fn convert(
    input: &Path,
    output: &Path,
    format: Option<PictureFormat>,
    maxval: Option<u16>,
    quiet: bool,
) -> Result<(), Failure> {
    let target = Target::exactly(output);
    let format = target.format(format)?;
    let image = read_image(input, &Limits::default())?;
    let (width, height) = (image.pixmap.width(), image.pixmap.height());
    let samples = 3 * width as u64 * height as u64;
    let scaled = maxval.map_or(0, |maxval| if maxval <= 255 { samples } else { 2 * samples });
    let written = format.memory_to_write(samples, maxval.unwrap_or(image.pixmap.maxval()));
    let what = format!("{width} x {height} pixels");
    memory::check(scaled + written, &what, "convert to PPM and keep the depth, which takes the least")?;
    let pixmap = match maxval {
        Some(maxval) => image.pixmap.scaled(maxval),
        None => image.pixmap,
    };
    target.write(&Picture::Opaque(pixmap), None, format)?;
    if image.transparent && !quiet {
        stderr::tell(&format!("warning: {}: transparency was dropped", input.display()));
    }
    Ok(())
}
