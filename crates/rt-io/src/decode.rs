//! Reading whatever picture a file holds, by its first bytes: PPM by our own codec, PNG, JPEG and TIFF through the `image`
//! crate.
//!
//! The library's own limits do not hold for all of its decoders, so the size is known and judged before a decoder may
//! allocate for it: against the caller's limit, and against what a file of that length can hold at all.
//!
//! Samples are those of the file. PNG and TIFF give the same as netpbm's `pngtopnm` and `tifftopnm`, scaled to 8 bits
//! where the file has fewer; JPEG is within 4 of 255 of libjpeg's (it leaves the decoder free). Grey becomes RGB, a
//! palette is looked up, alpha is dropped, colour profiles and gamma are ignored. A TIFF's orientation is obeyed.

mod jpeg_frame;
mod tiff_directory;

use std::fs::File;
use std::io::{self, Cursor, Read};
use std::path::{Path, PathBuf};

use image::codecs::{jpeg::JpegDecoder, png::PngDecoder, tiff::TiffDecoder};
use image::metadata::Orientation;
use image::{ColorType, DynamicImage, ImageBuffer, ImageDecoder, ImageError, ImageFormat, ImageResult};

use crate::Limits;
use crate::pixmap::{Pixmap, Samples};
use crate::ppm::{self, PpmError};
use jpeg_frame::JpegFrame;
use tiff_directory::Directory;

/// A picture that was read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Decoded {
    /// Its samples; `maxval` is the file's own for PPM, else 255 or 65535.
    pub pixmap: Pixmap,
    /// Whether a sample was not opaque, so that dropping alpha lost something.
    pub transparent: bool,
}

/// Why the bytes are not a picture that can be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DecodeError {
    /// The first bytes belong to no format that is known.
    #[error("not an image: expected PPM, PGM, PNG, JPEG or TIFF")]
    Unknown,
    /// A format that is not read.
    #[error("{0} is not read; convert it to PNG or PPM first")]
    Format(&'static str),
    /// A kind of PNG, JPEG or TIFF that is not read.
    #[error("{format} with {what} is not read; convert it to PNG or PPM first")]
    Kind {
        /// `PNG`, `JPEG` or `TIFF`.
        format: &'static str,
        /// The part that is not read.
        what: String,
    },
    /// What the PPM codec found.
    #[error(transparent)]
    Ppm(#[from] PpmError),
    /// The bytes break the rules of their format, or end early.
    #[error("broken {format}")]
    Broken {
        /// `PNG`, `JPEG` or `TIFF`.
        format: &'static str,
        /// What the decoder says.
        source: ImageError,
    },
    /// The file ends inside the picture.
    #[error("the {format} ends early")]
    Truncated {
        /// `PNG`, `JPEG` or `TIFF`.
        format: &'static str,
    },
    /// More pixels than [`Limits::max_pixels`].
    #[error("{width} x {height} pixels are more than the limit of {limit}")]
    TooManyPixels {
        /// Number of columns.
        width: u32,
        /// Number of rows.
        height: u32,
        /// The limit that the caller may raise.
        limit: u64,
    },
    /// More pixels than a file of this length can hold, however well it is compressed.
    #[error("{width} x {height} pixels are more than the {length} bytes of a {format} can hold")]
    TooDense {
        /// `PNG`, `JPEG` or `TIFF`.
        format: &'static str,
        /// Number of columns.
        width: u32,
        /// Number of rows.
        height: u32,
        /// Length of the file.
        length: u64,
    },
    /// A file that is larger than any picture within the limit.
    #[error("more than {limit} bytes, the most for a picture within the limit of pixels")]
    TooLong {
        /// The largest number of bytes.
        limit: u64,
    },
    /// Reading failed.
    #[error("reading failed")]
    Read(#[source] io::Error),
}

/// [`DecodeError`] with the file that it is about.
#[derive(Debug, thiserror::Error)]
#[error("cannot read the image {}", path.display())]
pub struct ReadImageError {
    /// The path as given.
    pub path: PathBuf,
    /// What is wrong.
    pub source: DecodeError,
}

/// Reads the picture in the file at `path`, whatever the file is called.
///
/// # Errors
/// [`ReadImageError`] names the path; its source names the cause.
pub fn read_image(path: &Path, limits: &Limits) -> Result<Decoded, ReadImageError> {
    read_file(path, limits).map_err(|source| ReadImageError { path: path.to_path_buf(), source })
}

fn read_file(path: &Path, limits: &Limits) -> Result<Decoded, DecodeError> {
    let mut file = File::open(path).map_err(DecodeError::Read)?;
    let metadata = file.metadata().map_err(DecodeError::Read)?;
    // A pipe and the like tell no length.
    let length = Some(metadata.len()).filter(|&length| metadata.is_file() && length > 0);
    let mut head = Vec::new();
    file.by_ref().take(HEAD).read_to_end(&mut head).map_err(DecodeError::Read)?;
    let reader = Cursor::new(head.clone()).chain(file);
    if sniff(&head)? == ImageFormat::Pnm {
        return opaque(ppm::read_known(reader, length, limits)?);
    }

    // The decoders jump about in their input, and it is seldom larger than the picture.
    let most = longest(limits);
    let mut bytes = Vec::new();
    if let Some(length) = length.filter(|&length| length <= most) {
        // One byte more lets the reader see the end without growing.
        bytes.reserve_exact(usize::try_from(length).unwrap_or(0) + 1);
    }
    reader.take(most.saturating_add(1)).read_to_end(&mut bytes).map_err(DecodeError::Read)?;
    if bytes.len() as u64 > most {
        return Err(DecodeError::TooLong { limit: most });
    }
    decode_image(&bytes, limits)
}

/// Reads the picture that `bytes` hold.
///
/// # Errors
/// [`DecodeError`] says what is wrong, and where if that is known.
pub fn decode_image(bytes: &[u8], limits: &Limits) -> Result<Decoded, DecodeError> {
    match sniff(bytes)? {
        ImageFormat::Png => decode_png(bytes, limits),
        ImageFormat::Jpeg => decode_jpeg(bytes, limits),
        ImageFormat::Tiff => decode_tiff(bytes, limits),
        _ => opaque(ppm::read_bytes(bytes, limits)?),
    }
}

/// Bytes that tell every format.
const HEAD: u64 = 16;

/// More bytes than any sensible file with a picture within the limit: 8 a pixel, and room for what is no pixel.
fn longest(limits: &Limits) -> u64 {
    limits.max_pixels.saturating_mul(8).saturating_add(SLACK)
}

/// Bytes that a decoder may take besides samples: profiles, tables, rows.
const SLACK: u64 = 32 << 20;

fn opaque(pixmap: Pixmap) -> Result<Decoded, DecodeError> {
    Ok(Decoded { pixmap, transparent: false })
}

fn sniff(head: &[u8]) -> Result<ImageFormat, DecodeError> {
    let format = match image::guess_format(head) {
        Ok(format) => format,
        Err(_) if head.is_empty() => return Err(PpmError::Magic { found: Vec::new() }.into()),
        Err(_) => return Err(DecodeError::Unknown),
    };
    Err(DecodeError::Format(match format {
        ImageFormat::Pnm | ImageFormat::Png | ImageFormat::Jpeg | ImageFormat::Tiff => return Ok(format),
        ImageFormat::Gif => "GIF",
        ImageFormat::WebP => "WebP",
        ImageFormat::Bmp => "BMP",
        ImageFormat::Avif => "AVIF",
        ImageFormat::OpenExr => "OpenEXR",
        ImageFormat::Hdr => "Radiance HDR",
        ImageFormat::Qoi => "QOI",
        ImageFormat::Dds => "DDS",
        ImageFormat::Ico => "ICO",
        ImageFormat::Farbfeld => "farbfeld",
        _ => "this image format",
    }))
}

fn decode_png(bytes: &[u8], limits: &Limits) -> Result<Decoded, DecodeError> {
    // The signature, the length and name of the first chunk, width, height.
    let number =
        |at: usize| bytes.get(at..).and_then(<[u8]>::first_chunk).map(|&four| u32::from_be_bytes(four));
    let (Some(width), Some(height)) = (number(16), number(20)) else {
        return Err(DecodeError::Truncated { format: "PNG" });
    };
    // Deflate: a bit for at most 258 / 2 bytes, each of eight one-bit pixels.
    let limits = check_size("PNG", width, height, bytes, 8 * 8 * 258 / 2, limits)?;
    finish("PNG", PngDecoder::with_limits(Cursor::new(bytes), limits.clone()), &limits)
}

fn decode_jpeg(bytes: &[u8], limits: &Limits) -> Result<Decoded, DecodeError> {
    let frame = JpegFrame::new(bytes).ok_or(DecodeError::Truncated { format: "JPEG" })?;
    let refuse = |what: &str| Err(DecodeError::Kind { format: "JPEG", what: what.to_string() });
    match frame {
        JpegFrame { process: 0xc0..=0xc2, precision: 8, components: 1 | 3, .. } => {}
        JpegFrame { process: 0xc0..=0xc2, precision: 8, components: 4, .. } => {
            return refuse("four components (CMYK or YCCK)");
        }
        JpegFrame { process: 0xc0..=0xc2, precision: 8, components, .. } => {
            return refuse(&format!("{components} components"));
        }
        JpegFrame { process: 0xc0..=0xc2, precision, .. } => {
            return refuse(&format!("{precision}-bit samples"));
        }
        _ => return refuse("lossless, hierarchical or arithmetic coding"),
    }
    // The decoder fills up what is missing with grey. The end marker cannot occur within compressed data.
    if !bytes[frame.end..].windows(2).any(|marker| marker == [0xff, 0xd9]) {
        return Err(DecodeError::Truncated { format: "JPEG" });
    }
    // Every block of 8 x 8 samples takes a bit or more. The fewest blocks for an area: one component has a quarter of the
    // rows, one a quarter of the columns, one of both, that is 4 + 4 + 1 blocks for 32 x 32 pixels.
    let limits = check_size("JPEG", frame.width, frame.height, bytes, 8 * 32 * 32 / 9 + 1, limits)?;
    finish("JPEG", JpegDecoder::new(Cursor::new(bytes)), &limits)
}

fn decode_tiff(bytes: &[u8], limits: &Limits) -> Result<Decoded, DecodeError> {
    let directory = Directory::new(bytes).ok_or(DecodeError::Truncated { format: "TIFF" })?;
    if let Some(what) = tiff_kind_not_read(&directory) {
        return Err(DecodeError::Kind { format: "TIFF", what });
    }
    if directory.shorts(tiff_directory::PHOTOMETRIC_INTERPRETATION) != Some(vec![3]) {
        return decode_tiff_directly(bytes, limits);
    }

    // A palette, which the decoder does not know: as grey, each sample is an index.
    let palette = directory.shorts(tiff_directory::COLOR_MAP).filter(|palette| palette.len() == 3 * 256);
    let grey = directory.with(tiff_directory::PHOTOMETRIC_INTERPRETATION, 1);
    let (Some(palette), Some(grey)) = (palette, grey) else {
        return Err(DecodeError::Kind {
            format: "TIFF",
            what: "a palette of other than 256 colours".to_string(),
        });
    };
    let pixmap = decode_tiff_directly(&grey, limits)?.pixmap;
    // Its colours have 16 bits; some writers fill the low eight alone.
    let shift = if palette.iter().any(|&sample| sample > 255) { 8 } else { 0 };
    let indices = pixmap.to_samples();
    let (pixels, _) = indices.as_chunks::<3>();
    let color = |index: u16| [0, 256, 512].map(|channel| palette[channel + usize::from(index)] >> shift);
    let samples = pixels.iter().flat_map(|&[index, _, _]| color(index)).collect();
    let pixmap = Pixmap::new(pixmap.width(), pixmap.height(), 255, samples);
    opaque(pixmap.expect("the size is that of a picture, and no sample has more than 8 bits"))
}

/// Names the part of a TIFF that is not read. What a directory leaves out has the value that the format gives it.
fn tiff_kind_not_read(directory: &Directory<'_>) -> Option<String> {
    let first =
        |tag, default| directory.shorts(tag).and_then(|values| values.first().copied()).unwrap_or(default);
    let what = match first(tiff_directory::COMPRESSION, 1) {
        // None, fax group 4, LZW, deflate (both numbers), PackBits.
        1 | 4 | 5 | 8 | 32946 | 32773 => None,
        2 | 3 => Some("fax group 3 compression".to_string()),
        6 | 7 => Some("JPEG compression".to_string()),
        other => Some(format!("compression number {other}")),
    };
    let bits = first(tiff_directory::BITS_PER_SAMPLE, 1);
    let samples = first(tiff_directory::SAMPLES_PER_PIXEL, 1);
    what.or(match first(tiff_directory::SAMPLE_FORMAT, 1) {
        1 => None,
        3 => Some("floating-point samples".to_string()),
        _ => Some("samples that are not unsigned integers".to_string()),
    })
    .or(match (first(tiff_directory::PHOTOMETRIC_INTERPRETATION, 1), samples, bits) {
        (0 | 1, 1, 1 | 8 | 16) | (2, 3 | 4, 8 | 16) | (3, 1, 8) => None,
        (0 | 1, 1, _) => Some(format!("{bits}-bit grey")),
        (0 | 1, ..) => Some(format!("grey of {samples} samples")),
        (2, 3 | 4, _) => Some(format!("{bits}-bit colours")),
        (2, ..) => Some(format!("colours of {samples} samples")),
        (3, ..) => Some(format!("a palette of {bits}-bit indices")),
        (4, ..) => Some("a transparency mask".to_string()),
        (5, ..) => Some("CMYK colours".to_string()),
        (6, ..) => Some("YCbCr colours".to_string()),
        (8..=10, ..) => Some("Lab colours".to_string()),
        (other, ..) => Some(format!("photometric interpretation number {other}")),
    })
}

fn decode_tiff_directly(bytes: &[u8], limits: &Limits) -> Result<Decoded, DecodeError> {
    let decoder = TiffDecoder::new(Cursor::new(bytes));
    let decoder = decoder.map_err(|source| decode_error("TIFF", source))?;
    let (width, height) = decoder.dimensions();
    // LZW: twelve bits for at most 3837 bytes, and that only at the end of a table: under 1400 bytes a byte on average,
    // each of eight one-bit pixels. Fax coding can beat this on pages that are blank.
    let limits = check_size("TIFF", width, height, bytes, 8 * 1400, limits)?;
    finish("TIFF", Ok(decoder), &limits)
}

/// Refuses a size that is too large for the caller or for the file; gives the limits for a decoder.
fn check_size(
    format: &'static str,
    width: u32,
    height: u32,
    bytes: &[u8],
    pixels_per_byte: u64,
    limits: &Limits,
) -> Result<image::Limits, DecodeError> {
    let pixels = u64::from(width) * u64::from(height);
    if pixels > limits.max_pixels {
        return Err(DecodeError::TooManyPixels { width, height, limit: limits.max_pixels });
    }
    let length = bytes.len() as u64;
    if pixels > length.saturating_mul(pixels_per_byte) {
        return Err(DecodeError::TooDense { format, width, height, length });
    }
    let mut decoder_limits = image::Limits::no_limits();
    // Eight bytes a pixel are the largest samples (RGBA, 16 bits), twice because some decoders keep a second copy.
    decoder_limits.max_alloc = Some(pixels.saturating_mul(16).saturating_add(SLACK));
    Ok(decoder_limits)
}

fn finish(
    format: &'static str,
    decoder: ImageResult<impl ImageDecoder>,
    limits: &image::Limits,
) -> Result<Decoded, DecodeError> {
    let fail = |source| decode_error(format, source);
    let mut decoder = decoder.map_err(fail)?;
    decoder.set_limits(limits.clone()).map_err(fail)?;
    // netpbm obeys a TIFF's orientation and does not look for a JPEG's or a PNG's.
    let orientation =
        if format == "TIFF" { decoder.orientation().map_err(fail)? } else { Orientation::NoTransforms };
    let (width, height) = decoder.dimensions();
    let color = decoder.color_type();
    let mut bytes = vec![0; usize::try_from(decoder.total_bytes()).unwrap_or(usize::MAX)];
    decoder.read_image(&mut bytes).map_err(fail)?;

    let wide = |bytes: &[u8]| -> Vec<u16> {
        bytes.as_chunks().0.iter().map(|&pair| u16::from_ne_bytes(pair)).collect()
    };
    let (samples, transparent) = match color {
        ColorType::L8 => (Samples::Eight(to_rgb::<1, _>(&bytes)), false),
        ColorType::La8 => (Samples::Eight(to_rgb::<2, _>(&bytes)), has_alpha::<2, _>(&bytes, u8::MAX)),
        ColorType::Rgb8 => (Samples::Eight(bytes), false),
        ColorType::Rgba8 => (Samples::Eight(to_rgb::<4, _>(&bytes)), has_alpha::<4, _>(&bytes, u8::MAX)),
        ColorType::L16 => (Samples::Sixteen(to_rgb::<1, _>(&wide(&bytes))), false),
        ColorType::La16 => {
            let pairs = wide(&bytes);
            (Samples::Sixteen(to_rgb::<2, _>(&pairs)), has_alpha::<2, _>(&pairs, u16::MAX))
        }
        ColorType::Rgb16 => (Samples::Sixteen(wide(&bytes)), false),
        ColorType::Rgba16 => {
            let pairs = wide(&bytes);
            (Samples::Sixteen(to_rgb::<4, _>(&pairs)), has_alpha::<4, _>(&pairs, u16::MAX))
        }
        other => return Err(DecodeError::Kind { format, what: format!("{other:?} samples") }),
    };
    let pixmap = orient(width, height, samples, orientation)
        .ok_or_else(|| DecodeError::Kind { format, what: "no pixels".to_string() })?;
    Ok(Decoded { pixmap, transparent })
}

fn decode_error(format: &'static str, source: ImageError) -> DecodeError {
    match source {
        ImageError::Unsupported(error) => DecodeError::Kind { format, what: error.to_string() },
        ImageError::IoError(error) if error.kind() == io::ErrorKind::UnexpectedEof => {
            DecodeError::Truncated { format }
        }
        source => DecodeError::Broken { format, source },
    }
}

/// The colour of pixels of `N` channels: grey, grey and alpha, or RGB and alpha.
fn to_rgb<const N: usize, S: Copy>(samples: &[S]) -> Vec<S> {
    let (pixels, _) = samples.as_chunks::<N>();
    pixels
        .iter()
        .flat_map(|pixel| if N < 3 { [pixel[0]; 3] } else { [pixel[0], pixel[1], pixel[2]] })
        .collect()
}

/// Whether the last of `N` channels is anywhere below `opaque`.
fn has_alpha<const N: usize, S: Copy + PartialEq>(samples: &[S], opaque: S) -> bool {
    samples.as_chunks::<N>().0.iter().any(|pixel| pixel[N - 1] != opaque)
}

/// A picture of the samples, turned upright.
fn orient(width: u32, height: u32, samples: Samples, orientation: Orientation) -> Option<Pixmap> {
    let (maxval, image) = match samples {
        samples if orientation == Orientation::NoTransforms => {
            let maxval = if matches!(samples, Samples::Eight(_)) { 255 } else { 65535 };
            return Pixmap::from_checked(width as usize, height as usize, maxval, samples);
        }
        Samples::Eight(samples) => {
            (255, DynamicImage::ImageRgb8(ImageBuffer::from_raw(width, height, samples)?))
        }
        Samples::Sixteen(samples) => {
            (65535, DynamicImage::ImageRgb16(ImageBuffer::from_raw(width, height, samples)?))
        }
    };
    let mut image = image;
    image.apply_orientation(orientation);
    let (width, height) = (image.width() as usize, image.height() as usize);
    let samples = match image {
        DynamicImage::ImageRgb8(image) => Samples::Eight(image.into_raw()),
        DynamicImage::ImageRgb16(image) => Samples::Sixteen(image.into_raw()),
        _ => return None,
    };
    Pixmap::from_checked(width, height, maxval, samples)
}
