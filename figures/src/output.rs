//! Where a picture goes, and in which format.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use rt_io::ppm::{self, Encoding};
use rt_io::{Pixmap, png, save_atomically};

use crate::cli::{Failure, to_stdout};

/// The format of an image file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Raw PPM (P6).
    Ppm,
    /// Plain PPM (P3): numbers as text.
    PpmPlain,
    /// PNG.
    Png,
}

impl Format {
    /// The usual ending of such a file.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Ppm | Self::PpmPlain => "ppm",
            Self::Png => "png",
        }
    }

    /// The format that a file's ending asks for.
    pub fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        match ending.as_str() {
            "ppm" => Some(Self::Ppm),
            "png" => Some(Self::Png),
            _ => None,
        }
    }

    /// Writes the picture, with a comment line in a PPM.
    fn write(self, pixmap: &Pixmap, comment: Option<&str>, out: &mut dyn Write) -> io::Result<()> {
        match (self, comment) {
            (Self::Ppm, None) => ppm::write(pixmap, Encoding::Raw, out),
            (Self::Ppm, Some(comment)) => ppm::write_with_comment(pixmap, Encoding::Raw, comment, out),
            (Self::PpmPlain, None) => ppm::write(pixmap, Encoding::Plain, out),
            (Self::PpmPlain, Some(comment)) => ppm::write_with_comment(pixmap, Encoding::Plain, comment, out),
            (Self::Png, _) => png::write(pixmap, out),
        }
    }
}

/// Where a picture goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Target {
    /// Standard output.
    Stdout,
    /// A file, in a folder that exists.
    File(PathBuf),
}

impl Target {
    /// Finds where the picture called `name` goes when the user said `out`.
    ///
    /// `-` is stdout. A folder that exists, or anything that ends in a slash, takes `name` with the format's ending;
    /// with `folder` so does any other path. Folders are made.
    ///
    /// # Errors
    /// A folder that cannot be made, named.
    pub fn new(
        out: Option<&Path>,
        name: &str,
        format: Option<Format>,
        folder: bool,
    ) -> Result<Self, Failure> {
        let out = out.unwrap_or(Path::new("out/"));
        if out == Path::new("-") {
            return Ok(Self::Stdout);
        }
        let slash = out.as_os_str().as_encoded_bytes().ends_with(b"/");
        if !(folder || slash || out.is_dir()) {
            return Ok(Self::File(out.to_owned()));
        }
        fs::create_dir_all(out).map_err(|error| {
            Failure::Failed(format!("cannot make folder {}: {error}", out.display()).into())
        })?;
        Ok(Self::File(out.join(format!("{name}.{}", format.unwrap_or(Format::Ppm).ending()))))
    }

    /// The target that the user named: `-` is stdout, anything else a file.
    pub fn exactly(out: &Path) -> Self {
        if out == Path::new("-") { Self::Stdout } else { Self::File(out.to_owned()) }
    }

    /// The format to write: the one asked for, else by the ending, else PPM.
    pub fn format(&self, asked: Option<Format>) -> Format {
        let by_ending = match self {
            Self::Stdout => None,
            Self::File(path) => Format::of(path),
        };
        asked.or(by_ending).unwrap_or(Format::Ppm)
    }

    /// Writes the picture, with a comment line in a PPM: a file appears whole or not at all.
    ///
    /// # Errors
    /// What the system says, with the path.
    pub fn write(&self, pixmap: &Pixmap, comment: Option<&str>, format: Format) -> Result<(), Failure> {
        self.write_with(|out| format.write(pixmap, comment, out))
    }

    /// Writes whatever `write` does: a file appears whole or not at all.
    ///
    /// # Errors
    /// What the system says, with the path.
    pub fn write_with(&self, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Failure> {
        match self {
            Self::Stdout => {
                let mut bytes = Vec::new();
                write(&mut bytes)?;
                to_stdout(&bytes)
            }
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
