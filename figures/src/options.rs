//! What the command line says about a picture.

use std::path::PathBuf;
use std::str::FromStr;

use clap::{Args, ValueEnum};
use glam::DVec3;

use crate::objects::Method;
use crate::output::PictureFormat;
use crate::stage::Direction;
use crate::tile::Tile;

/// The largest number of pixels in a picture: 1.5 GiB of samples.
const MAX_PIXELS: u64 = 1 << 28;
/// The largest width and height, so that positions in the grid of samples fit 32 bits.
const MAX_SIDE: u32 = 1 << 20;

/// How a picture is drawn and where it goes.
#[derive(Args, Clone, Debug)]
pub struct DrawOptions {
    /// Where to: a .ppm or .png, a folder, or `-` for stdout [default: out/]
    #[arg(short, long, value_name = "FILE|DIR|-")]
    pub out: Option<PathBuf>,
    /// Columns and rows of the picture
    #[arg(long, value_name = "WxH", default_value = "1024x768")]
    pub size: PictureSize,
    /// Threads [default: one for each core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Take N x N samples in each pixel
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=64))]
    pub samples: u32,
    /// The format to write, whatever the name [default: by the ending of FILE, else PNG for `render`, PPM
    /// for the six figures]
    #[arg(long)]
    pub format: Option<PictureFormat>,
    /// Bits per sample
    #[arg(long, default_value = "8")]
    pub depth: Depth,
    /// Draw only band I of N, rows (I-1)H/N to IH/N, for `merge`
    #[arg(long, value_name = "I/N")]
    pub tile: Option<Tile>,
    /// How the object that a ray hits is found; the picture is the same
    #[arg(long, value_name = "METHOD", default_value = "bvh")]
    pub tree: Method,
    /// Write no progress and no notes
    #[arg(long)]
    pub quiet: bool,
    /// Write size, rays, hits, seconds and memory to stdout as JSON
    #[arg(long)]
    pub json: bool,
}

/// What is changed in the files that are drawn.
#[derive(Args, Clone, Copy, Debug)]
pub struct ChangeOptions {
    /// Look from x, y, z, iso, or from AZ degrees about +z, from +x, and EL above the ground; +z is up, for z +y
    ///
    /// Only for what lies on the stage: files without a scene, and scenes with `stage = true`.
    #[arg(long, value_name = "x|y|z|iso|AZ,EL", allow_hyphen_values = true)]
    pub view: Option<Direction>,
    /// The color where no object is hit: R,G,B from 0 to 1, #RRGGBB, black, white; none: a PNG is transparent there
    #[arg(long, value_name = "COLOR|none")]
    pub background: Option<Background>,
    /// Multiply the radii of all spheres
    #[arg(long, value_name = "FACTOR", value_parser = factor)]
    pub radius_scale: Option<f64>,
    /// Draw this frame of an XYZ file, or model of a PDB file [default: 1]
    #[arg(long, value_name = "N", value_parser = frame)]
    pub frame: Option<u64>,
}

/// What is behind the objects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Background {
    /// Nothing.
    None,
    /// A colour, each channel in `0..=1`.
    Color(DVec3),
}

impl FromStr for Background {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let hex = |text: &str| {
            let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6)?;
            let [_, red, green, blue] = u32::from_str_radix(digits, 16).ok()?.to_be_bytes();
            Some(DVec3::new(red.into(), green.into(), blue.into()) / 255.0)
        };
        let numbers = |text: &str| {
            let channels = text.split(',').map(|channel| channel.trim().parse().ok()).collect::<Option<Vec<f64>>>()?;
            let color = DVec3::from_array(channels.try_into().ok()?);
            color.to_array().iter().all(|channel| (0.0..=1.0).contains(channel)).then_some(color)
        };
        match text {
            "none" => Ok(Self::None),
            "black" => Ok(Self::Color(DVec3::ZERO)),
            "white" => Ok(Self::Color(DVec3::ONE)),
            _ => hex(text).or_else(|| numbers(text)).map(Self::Color).ok_or_else(|| {
                "expected none, black, white, #RRGGBB, or three numbers from 0 to 1, such as 0.2,0.3,0.5".to_owned()
            }),
        }
    }
}

fn factor(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(factor) if factor > 0.0 && f64::is_finite(factor) => Ok(factor),
        _ => Err("expected a number more than 0".to_owned()),
    }
}

fn frame(text: &str) -> Result<u64, String> {
    text.parse().ok().filter(|&frame| frame > 0).ok_or_else(|| "expected a whole number, 1 or more".to_owned())
}

/// Columns and rows of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PictureSize {
    /// Columns, at least 1.
    pub width: u32,
    /// Rows, at least 1.
    pub height: u32,
}

impl FromStr for PictureSize {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (width, height) = text.split_once('x').ok_or("expected columns x rows, such as 640x480".to_owned())?;
        let side = |digits: &str| match digits.parse::<u32>() {
            Ok(side @ 1..=MAX_SIDE) => Ok(side),
            _ => Err(format!("expected a whole number from 1 to {MAX_SIDE}, found {digits:?}")),
        };
        let (width, height) = (side(width)?, side(height)?);
        if u64::from(width) * u64::from(height) > MAX_PIXELS {
            return Err(format!("expected at most {MAX_PIXELS} pixels"));
        }
        Ok(Self { width, height })
    }
}

/// Bits per sample of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Depth {
    /// 8 bits, samples from 0 to 255.
    #[value(name = "8")]
    Eight,
    /// 16 bits, samples from 0 to 65535.
    #[value(name = "16")]
    Sixteen,
}

impl Depth {
    /// The largest sample.
    pub fn maxval(self) -> u16 {
        match self {
            Self::Eight => 255,
            Self::Sixteen => 65535,
        }
    }
}
