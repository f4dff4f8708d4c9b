//! Bands of a picture, for job arrays: which rows a tile has, what its file says about itself, and how tiles are
//! joined.
//!
//! Tile `i` of `n` has the rows from `⌊(i − 1) H / n⌋` up to `⌊i H / n⌋`. Its file is a PPM of these rows, or with
//! transparency a PNG, with one comment that says where they belong. Joined, the rows are byte for byte those of the
//! picture drawn in one run.

use std::fmt;
use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use rt_io::png::{self, Rgba};
use rt_io::ppm::{self, PpmError};
use rt_io::{Limits, Pixmap};

use crate::output::Picture;

/// One tile of several: `i/n`, counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tile {
    number: u32,
    of: u32,
}

impl FromStr for Tile {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('/').and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
        match parts {
            Some((number, of)) if 1 <= number && number <= of => Ok(Self { number, of }),
            _ => Err("expected i/n with i from 1 to n, such as 3/16".to_owned()),
        }
    }
}

impl Tile {
    /// The rows of this tile in a picture of `height` rows; none where there are more tiles than rows.
    ///
    /// ```
    /// use figures::tile::Tile;
    /// let tiles = ["1/3", "2/3", "3/3"].map(|text| text.parse::<Tile>().unwrap());
    /// assert_eq!(tiles.map(|tile| tile.rows(10)), [0..3, 3..6, 6..10]);
    /// ```
    #[expect(clippy::cast_possible_truncation, reason = "at most `height`")]
    pub fn rows(self, height: u32) -> Range<u32> {
        let edge = |number: u32| (u64::from(number) * u64::from(height) / u64::from(self.of)) as u32;
        edge(self.number - 1)..edge(self.number)
    }

    /// The tile in the name of a file.
    pub fn suffix(self) -> String {
        format!("{}-of-{}", self.number, self.of)
    }
}

/// What a tile's file says about itself, in its comment line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// The rows that it has.
    pub rows: Range<u32>,
    /// Columns of the whole picture.
    pub width: u32,
    /// Rows of the whole picture.
    pub height: u32,
    /// Samples along each side of a pixel.
    pub samples: u32,
    /// A fingerprint of the scene.
    pub scene: u64,
    /// The version of the program.
    pub version: String,
}

impl fmt::Display for Label {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { rows: Range { start, end }, width, height, samples, scene, version } = self;
        write!(f, "figures {version} rows {start}..{end} of {width}x{height} samples {samples} scene {scene:016x}")
    }
}

impl Label {
    /// Reads what [`Display`](fmt::Display) has written.
    fn parse(comment: &str) -> Option<Self> {
        let words: Vec<&str> = comment.split_whitespace().collect();
        let ["figures", version, "rows", rows, "of", size, "samples", samples, "scene", scene] = words[..] else {
            return None;
        };
        let (start, end) = rows.split_once("..")?;
        let (width, height) = size.split_once('x')?;
        let label = Self {
            rows: start.parse().ok()?..end.parse().ok()?,
            width: width.parse().ok()?,
            height: height.parse().ok()?,
            samples: samples.parse().ok()?,
            scene: u64::from_str_radix(scene, 16).ok()?,
            version: version.to_owned(),
        };
        (label.rows.start < label.rows.end && label.rows.end <= label.height).then_some(label)
    }
}

/// A tile that was read.
struct TileFile {
    path: PathBuf,
    label: Label,
    picture: Picture,
}

impl TileFile {
    fn is_transparent(&self) -> bool {
        matches!(self.picture, Picture::Transparent(_))
    }

    /// What tiles of one picture have in common, each with its name.
    fn common(&self) -> [(&'static str, String); 6] {
        let Label { width, height, samples, scene, version, .. } = &self.label;
        [
            ("version", version.clone()),
            ("size", format!("{width}x{height}")),
            ("samples", samples.to_string()),
            ("scene", format!("{scene:016x}")),
            ("maxval", self.picture.maxval().to_string()),
            ("transparency", if self.is_transparent() { "some" } else { "none" }.to_owned()),
        ]
    }
}

/// Why tiles cannot be joined.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
pub struct MergeError(#[from] Obstacle);

/// What is in the way of joining tiles; the `first` file is the one that another is compared with.
#[derive(Debug, thiserror::Error)]
enum Obstacle {
    #[error("cannot read {}", path.display())]
    Open { path: PathBuf, source: io::Error },
    #[error("{}: {source}", path.display())]
    Ppm { path: PathBuf, source: PpmError },
    #[error("{}: {source}", path.display())]
    Png { path: PathBuf, source: io::Error },
    #[error("{}: not a tile: {what}", path.display())]
    NoTile { path: PathBuf, what: &'static str },
    #[error("{}: a tile of another picture: {what} {found}, but {expected} in {}", path.display(), first.display())]
    Stranger { path: PathBuf, first: PathBuf, what: &'static str, found: String, expected: String },
    #[error("no tiles")]
    Nothing,
    #[error("rows {}..{} are missing", rows.start, rows.end)]
    Gap { rows: Range<u32> },
    #[error("cannot get {megabytes} MB of memory for {width} x {height} pixels; pnmcat -tb joins tiles in less")]
    Memory { megabytes: u64, width: u32, height: u32 },
    #[error("rows {}..{} are in {} and in {}", rows.start, rows.end, first.display(), second.display())]
    Overlap { rows: Range<u32>, first: PathBuf, second: PathBuf },
}

/// Joins the tiles in these files, in any order, to the whole picture.
///
/// # Errors
/// The first thing that is wrong: a file that is no tile, or a tile of another picture; then rows that are missing or
/// there twice.
#[expect(clippy::missing_panics_doc, reason = "the rows are checked to be all there")]
pub fn merge(paths: &[PathBuf]) -> Result<Picture, MergeError> {
    let mut parts = paths.iter().map(|path| read(path)).collect::<Result<Vec<_>, _>>()?;
    let Some(first) = parts.first() else { return Err(Obstacle::Nothing.into()) };
    for part in &parts[1..] {
        let mut pairs = part.common().into_iter().zip(first.common());
        if let Some(((what, found), (_, expected))) = pairs.find(|((_, found), (_, expected))| found != expected) {
            let (path, first) = (part.path.clone(), first.path.clone());
            return Err(Obstacle::Stranger { path, first, what, found, expected }.into());
        }
    }
    let (width, height, maxval) = (first.label.width, first.label.height, first.picture.maxval());
    let transparent = first.is_transparent();
    parts.sort_by_key(|part| part.label.rows.start);
    for pair in parts.windows(2) {
        let [first, second] = [&pair[0], &pair[1]];
        let (end, start) = (first.label.rows.end, second.label.rows.start);
        if start < end {
            let (rows, first, second) =
                (start..end.min(second.label.rows.end), first.path.clone(), second.path.clone());
            return Err(Obstacle::Overlap { rows, first, second }.into());
        }
    }
    let ends = [0].into_iter().chain(parts.iter().map(|part| part.label.rows.end));
    let starts = parts.iter().map(|part| part.label.rows.start).chain([height]);
    if let Some((end, start)) = ends.zip(starts).find(|(end, start)| end < start) {
        return Err(Obstacle::Gap { rows: end..start }.into());
    }
    let count = if transparent { 4 } else { 3 } * u64::from(width) * u64::from(height);
    let mut samples = Vec::new();
    if !usize::try_from(count).is_ok_and(|count| samples.try_reserve_exact(count).is_ok()) {
        return Err(Obstacle::Memory { megabytes: (2 * count).div_ceil(1_000_000), width, height }.into());
    }
    for part in parts {
        match part.picture {
            Picture::Opaque(pixmap) => samples.extend(pixmap.into_samples()),
            Picture::Transparent(picture) => samples.extend(picture.samples),
        }
    }
    let (width, height) = (width as usize, height as usize);
    if transparent {
        return Ok(Picture::Transparent(Rgba { width, height, maxval, samples }));
    }
    let pixmap = Pixmap::new(width, height, maxval, samples);
    Ok(Picture::Opaque(pixmap.expect("the rows were checked to be all there")))
}

/// Reads a tile.
fn read(path: &Path) -> Result<TileFile, Obstacle> {
    let file = File::open(path).map_err(|source| Obstacle::Open { path: path.to_owned(), source })?;
    let mut file = BufReader::new(file);
    let start = file.fill_buf().map_err(|source| Obstacle::Open { path: path.to_owned(), source })?;
    let (picture, comments) = if start.starts_with(b"\x89PNG") {
        let read = png::read_rgba(file, &Limits::default());
        let (picture, comments) = read.map_err(|source| Obstacle::Png { path: path.to_owned(), source })?;
        (Picture::Transparent(picture), comments)
    } else {
        let read = ppm::read_with_comments(file, &Limits::default());
        let (pixmap, comments) = read.map_err(|source| Obstacle::Ppm { path: path.to_owned(), source })?;
        (Picture::Opaque(pixmap), comments)
    };
    let refuse = |what| Obstacle::NoTile { path: path.to_owned(), what };
    let label = comments.iter().find_map(|comment| Label::parse(comment));
    let label = label.ok_or_else(|| refuse("no comment says which rows it has"))?;
    if picture.size() != (label.width as usize, label.rows.len()) {
        return Err(refuse("its size is not what its comment says"));
    }
    Ok(TileFile { path: path.to_owned(), label, picture })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_every_row_once() {
        for height in [1, 2, 7, 768, 1 << 20] {
            for of in [1, 2, 3, 7, 16, 769] {
                let mut next = 0;
                for number in 1..=of {
                    let rows = Tile { number, of }.rows(height);
                    assert_eq!(rows.start, next, "tile {number}/{of} of {height} rows");
                    next = rows.end;
                }
                assert_eq!(next, height, "{of} tiles of {height} rows");
            }
        }
    }

    #[test]
    fn only_tiles_that_exist_are_named() {
        for text in ["0/3", "4/3", "1/0", "3", "a/b", "1/", "/2", "-1/2", "1/2/3", "", "1/4294967296"] {
            assert!(text.parse::<Tile>().is_err(), "{text}");
        }
        assert_eq!("16/16".parse(), Ok(Tile { number: 16, of: 16 }));
    }

    #[test]
    fn a_label_reads_as_written() {
        let label = Label { rows: 3..7, width: 10, height: 9, samples: 2, scene: 0xBEEF, version: "0.1.0".to_owned() };
        assert_eq!(Label::parse(&label.to_string()), Some(label));
        for text in [
            "",
            "figures 0.1.0 rows 7..3 of 10x9 samples 2 scene 0",
            "figures 0.1.0 rows 3..99 of 10x9 samples 2 scene 0",
        ] {
            assert_eq!(Label::parse(text), None, "{text}");
        }
    }
}
