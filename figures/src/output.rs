//! Where a picture goes, and in which format. A file's ending is its format; other endings are refused.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use rt_io::ppm::{self, Encoding};
use rt_io::{Pixmap, png, save_atomically};

use crate::outcome::{Failure, stream_to_stdout};

/// A picture, with transparency or without.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Picture {
    /// Each pixel has a colour.
    Opaque(Pixmap),
    /// And an alpha.
    Transparent(png::Rgba),
}

impl Picture {
    /// Columns and rows.
    pub fn size(&self) -> (usize, usize) {
        match self {
            Self::Opaque(pixmap) => (pixmap.width(), pixmap.height()),
            Self::Transparent(picture) => (picture.width, picture.height),
        }
    }

    /// The largest sample.
    pub fn maxval(&self) -> u16 {
        match self {
            Self::Opaque(pixmap) => pixmap.maxval(),
            Self::Transparent(picture) => picture.maxval,
        }
    }
}

/// Why a transparent picture is not written as PPM.
pub(crate) const NO_ALPHA: &str = "a picture without a background is a PNG; PPM has no transparency";

/// The format of an image file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PictureFormat {
    /// Raw PPM (P6).
    Ppm,
    /// Plain PPM (P3): numbers as text.
    PpmPlain,
    /// PNG.
    Png,
}

impl PictureFormat {
    /// The usual ending of such a file.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Ppm | Self::PpmPlain => "ppm",
            Self::Png => "png",
        }
    }

    /// The format that a file's name asks for, `default` where it asks for none.
    ///
    /// # Errors
    /// Wrong usage: an [`ending`] of something that is not written here.
    pub fn of(path: &Path, default: Self) -> Result<Self, Failure> {
        match ending(path).as_deref() {
            None => Ok(default),
            Some("ppm") => Ok(Self::Ppm),
            Some("png") => Ok(Self::Png),
            Some(other) => Err(Failure::Usage(format!(
                "{}: expected a name that ends in .ppm or .png, found .{other}; --format writes any name",
                path.display()
            ))),
        }
    }

    /// Bytes of memory that [`Target::write`] takes for this many samples up to `maxval`, besides the picture itself.
    pub(crate) fn memory_to_write(self, samples: u64, maxval: u16) -> u64 {
        match (self, maxval) {
            (Self::Ppm | Self::PpmPlain, _) => 0,
            // What is compressed is gathered before it is written, in a vector that may hold twice as much.
            (Self::Png, 0..=255) => 2 * samples,
            // The same at twice the size, and the samples again as bytes.
            (Self::Png, _) => 6 * samples,
        }
    }

    /// Writes the picture, with a comment line in a PPM or in a PNG with transparency.
    fn write(self, picture: &Picture, comment: Option<&str>, out: &mut dyn Write) -> io::Result<()> {
        let pixmap = match (picture, self) {
            (Picture::Opaque(pixmap), _) => pixmap,
            (Picture::Transparent(picture), Self::Png) => return png::write_rgba(picture, comment, out),
            (Picture::Transparent(_), _) => return Err(io::Error::other(NO_ALPHA)),
        };
        match (self, comment) {
            (Self::Ppm, None) => ppm::write(pixmap, Encoding::Raw, out),
            (Self::Ppm, Some(comment)) => ppm::write_with_comment(pixmap, Encoding::Raw, comment, out),
            (Self::PpmPlain, None) => ppm::write(pixmap, Encoding::Plain, out),
            (Self::PpmPlain, Some(comment)) => ppm::write_with_comment(pixmap, Encoding::Plain, comment, out),
            (Self::Png, _) => png::write(pixmap, out),
        }
    }
}

/// The ending of a file's name, in lower case: what follows its last dot, if that is made of ASCII letters and digits
/// and not of digits alone.
///
/// So `run.1` and `step-0.25` have none; `a.jpg`, `a.PNG` and `a.v2` have one. No list of formats is needed.
///
/// ```
/// use figures::output::ending;
/// let of = |name: &str| ending(name.as_ref());
/// assert_eq!(of("folder.d/a.PNG").as_deref(), Some("png"));
/// assert_eq!((of("run.1"), of("folder.d/a"), of("a.")), (None, None, None));
/// ```
pub fn ending(path: &Path) -> Option<String> {
    let name = path.file_name()?.to_string_lossy();
    let (_, ending) = name.rsplit_once('.')?;
    let plain = ending.bytes().all(|byte| byte.is_ascii_alphanumeric());
    let letters = ending.bytes().any(|byte| byte.is_ascii_alphabetic());
    (plain && letters).then(|| ending.to_ascii_lowercase())
}

/// Refuses a new folder with a name like a file's. A slash at the end says that a folder is meant.
///
/// # Errors
/// Wrong usage, with the remedy.
pub fn check_new_folder(folder: &Path) -> Result<(), Failure> {
    match ending(folder) {
        Some(ending) if !ends_in_slash(folder) && !folder.is_dir() => Err(Failure::Usage(format!(
            "{}: expected a folder, found a name that ends in .{ending}; write {0}/ if it is to be a folder",
            folder.display()
        ))),
        _ => Ok(()),
    }
}

fn ends_in_slash(path: &Path) -> bool {
    path.as_os_str().as_encoded_bytes().ends_with(b"/")
}

/// Where the pictures of a command go and in which format, known from the command line alone, before any work.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Destination {
    place: OutPlace,
    format: PictureFormat,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum OutPlace {
    Stdout,
    File(PathBuf),
    Folder(PathBuf),
}

impl Destination {
    /// Finds where pictures go when the user said `out`, and the format: the one asked for, else by the name, else `default`.
    ///
    /// `-` is stdout. A folder that exists and anything that ends in a slash is a folder; with `folder` so is any other
    /// path.
    ///
    /// # Errors
    /// Wrong usage: no format asked for, and an ending that is not written, or a new folder with a name like a file's.
    pub fn new(
        out: Option<&Path>,
        format: Option<PictureFormat>,
        folder: bool,
        default: PictureFormat,
    ) -> Result<Self, Failure> {
        let out = out.unwrap_or(Path::new("out/"));
        let place = if out == Path::new("-") {
            OutPlace::Stdout
        } else if folder || ends_in_slash(out) || out.is_dir() {
            OutPlace::Folder(out.to_owned())
        } else {
            OutPlace::File(out.to_owned())
        };
        let format = match (format, &place) {
            (Some(format), _) => format,
            (None, OutPlace::File(path)) => PictureFormat::of(path, default)?,
            (None, OutPlace::Folder(path)) => {
                check_new_folder(path)?;
                default
            }
            (None, OutPlace::Stdout) => default,
        };
        Ok(Self { place, format })
    }

    /// The format of the pictures.
    pub fn format(&self) -> PictureFormat {
        self.format
    }

    /// The target of the picture called `name`, which gives its name to a file in a folder. The folder is made.
    ///
    /// # Errors
    /// A folder that cannot be made, named.
    pub fn target(&self, name: &str) -> Result<Target, Failure> {
        match &self.place {
            OutPlace::Stdout => Ok(Target::Stdout),
            OutPlace::File(path) => Ok(Target::File(path.clone())),
            OutPlace::Folder(folder) => {
                fs::create_dir_all(folder).map_err(|error| {
                    Failure::Failed(format!("cannot make folder {}: {error}", folder.display()).into())
                })?;
                Ok(Target::File(folder.join(format!("{name}.{}", self.format.ending()))))
            }
        }
    }
}

/// Where one picture goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Target {
    /// Standard output.
    Stdout,
    /// A file, in a folder that exists.
    File(PathBuf),
}

impl Target {
    /// The target that the user named: `-` is stdout, anything else a file.
    pub fn exactly(out: &Path) -> Self {
        if out == Path::new("-") { Self::Stdout } else { Self::File(out.to_owned()) }
    }

    /// The format to write: the one asked for, else by the name, else PPM.
    ///
    /// # Errors
    /// As [`PictureFormat::of`].
    pub fn format(&self, asked: Option<PictureFormat>) -> Result<PictureFormat, Failure> {
        match (asked, self) {
            (Some(format), _) => Ok(format),
            (None, Self::Stdout) => Ok(PictureFormat::Ppm),
            (None, Self::File(path)) => PictureFormat::of(path, PictureFormat::Ppm),
        }
    }

    /// Writes the picture, with a comment line in a PPM: a file appears whole or not at all.
    ///
    /// # Errors
    /// What the system says, with the path.
    pub fn write(&self, picture: &Picture, comment: Option<&str>, format: PictureFormat) -> Result<(), Failure> {
        self.write_with(|out| format.write(picture, comment, out))
    }

    /// Writes what `write` writes: a file appears whole or not at all.
    ///
    /// # Errors
    /// What the system says, with the path; [`Failure::PipeClosed`] if stdout was closed.
    pub fn write_with(&self, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Failure> {
        match self {
            Self::Stdout => stream_to_stdout(write),
            Self::File(path) => Ok(save_atomically(path, write)?),
        }
    }

    /// How the target is named in notes.
    pub fn name(&self) -> String {
        match self {
            Self::Stdout => "stdout".to_owned(),
            Self::File(path) => path.display().to_string(),
        }
    }
}
