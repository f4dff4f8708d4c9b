//! Textures from image files: PPM, PNG, JPEG or TIFF, recognised by their content.

use std::path::Path;

use rt_io::{Limits, Pixmap, ReadImageError, Samples, decode_image, read_image};
use rt_shade::Texture;

/// Reads the image at `path`.
pub(crate) fn load(path: &Path) -> Result<Texture, ReadImageError> {
    read_image(path, &Limits::default()).map(|image| texture(image.pixmap))
}

/// Reads the image in `bytes`, which errors call `path`.
pub(crate) fn decode(bytes: &[u8], path: &str) -> Result<Texture, ReadImageError> {
    let image = decode_image(bytes, &Limits::default());
    image.map(|image| texture(image.pixmap)).map_err(|source| ReadImageError { path: path.into(), source })
}

fn texture(pixmap: Pixmap) -> Texture {
    let (width, height, maxval) = (pixmap.width(), pixmap.height(), pixmap.maxval());
    // As they are stored: a copy of a large image may be more than the memory.
    let texture = match pixmap.into_stored() {
        Samples::Eight(samples) => Texture::from_bytes(width, height, samples, u8::try_from(maxval).unwrap_or(u8::MAX)),
        Samples::Sixteen(samples) => Texture::new(width, height, samples, maxval),
    };
    texture.expect("a pixmap's invariant is a texture's")
}
