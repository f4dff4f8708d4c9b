//! Draws scenes into files: loads, builds, traces, writes, and reports the time of each.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::{Duration, Instant};

use clap::ValueEnum;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use rt_io::Pixmap;
use rt_io::png::Rgba;
use serde::Serialize;

use crate::camera::{Size, View};
use crate::certify::Certified;
use crate::figure::Figure;
use crate::objects::{Method, Objects};
use crate::options::{Background, ChangeOptions, DrawOptions, PictureSize};
use crate::outcome::{Failure, to_stdout};
use crate::output::{self, Destination, NO_ALPHA, Picture, PictureFormat, Target};
use crate::render::Renderer;
use crate::scene::Scene;
use crate::scene_file::Changes;
use crate::tile::{self, Label};
use crate::{load, memory, stderr};

/// Work that ends sooner than this shows no progress.
const PATIENCE: Duration = Duration::from_millis(500);

/// What `--json` reports about one picture.
#[derive(Serialize)]
struct Account {
    picture: String,
    width: u32,
    height: usize,
    samples: u32,
    spheres: usize,
    triangles: usize,
    rays: u64,
    hits: u64,
    /// How many of the rays' samples each stage has decided.
    certified: Certified,
    seconds: Seconds,
    /// The largest amount of memory that the process has held so far; null where the system does not say.
    peak_memory_bytes: Option<u64>,
}

#[derive(Serialize)]
struct Seconds {
    load: f64,
    build: f64,
    trace: f64,
    write: f64,
}

/// A watch that returns the seconds since it was last asked.
struct Watch(Instant);

impl Watch {
    fn lap(&mut self) -> f64 {
        let now = Instant::now();
        (now - std::mem::replace(&mut self.0, now)).as_secs_f64()
    }
}

/// Draws figures; with `folder`, `--out` is a folder.
///
/// # Errors
/// Wrong usage, or the first thing that could not be done.
pub fn figures(figures: &[Figure], folder: bool, options: &DrawOptions) -> Result<(), Failure> {
    if folder && options.out.as_deref() == Some(Path::new("-")) {
        return Err(Failure::Usage("six pictures need a folder: --out DIR".to_owned()));
    }
    let destination = destination(options, folder, PictureFormat::Ppm, false)?;
    let pool = pool(options)?;
    figures.iter().try_for_each(|figure| draw(&figure.name(), || Ok(figure.scene()?), &destination, options, &pool))
}

/// Draws each of the files, with these changes, into a picture of its own.
///
/// # Errors
/// As [`figures`].
pub fn files(paths: &[PathBuf], changes: &ChangeOptions, options: &DrawOptions) -> Result<(), Failure> {
    let several = paths.len() > 1;
    if several && options.out.as_deref() == Some(Path::new("-")) {
        return Err(Failure::Usage("several pictures need a folder: --out DIR".to_owned()));
    }
    let names: Vec<String> = paths.iter().map(|path| picture_name(path)).collect();
    for (at, name) in names.iter().enumerate() {
        if let Some(first) = names[..at].iter().position(|other| other == name) {
            let [first, second] = [first, at].map(|at| paths[at].display());
            return Err(Failure::Usage(format!("{first} and {second} would be one picture, {name}; draw them apart")));
        }
    }
    let &ChangeOptions { view, background, radius_scale, frame } = changes;
    // A tile is a PPM, or with transparency a PNG.
    let transparent = background == Some(Background::None);
    let default = if options.tile.is_some() && !transparent { PictureFormat::Ppm } else { PictureFormat::Png };
    let destination = destination(options, several, default, transparent)?;
    let pool = pool(options)?;
    let changes = &Changes { view, radius_scale, frame };
    let load = |path: &Path| {
        let mut scene = load::load(path, changes)?;
        match background {
            Some(Background::None) => scene.transparent = true,
            Some(Background::Color(color)) => scene.background = color,
            None => {}
        }
        Ok(scene)
    };
    paths.iter().zip(&names).try_for_each(|(path, name)| draw(name, || load(path), &destination, options, &pool))
}

/// The name of the picture of a file: its own, without its ending and that of gzip.
fn picture_name(path: &Path) -> String {
    if path == Path::new("-") {
        return "stdin".to_owned();
    }
    let packed = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("gz"));
    let path = if packed { path.with_extension("") } else { path.to_owned() };
    path.file_stem().map_or_else(|| "scene".to_owned(), |stem| stem.to_string_lossy().into_owned())
}

/// Reads a scene file, or a bulk file on a stage.
pub(crate) fn load(path: &Path) -> Result<Scene, Failure> {
    load::load(path, &Changes::default())
}

/// Where the pictures go, and all that is wrong with the options before any work.
fn destination(
    options: &DrawOptions,
    folder: bool,
    default: PictureFormat,
    transparent: bool,
) -> Result<Destination, Failure> {
    if options.json && options.out.as_deref() == Some(Path::new("-")) {
        return Err(Failure::Usage("--json and --out - both write to stdout; choose one".to_owned()));
    }
    let destination = Destination::new(options.out.as_deref(), options.format, folder, default)?;
    if transparent && destination.format() != PictureFormat::Png {
        return Err(Failure::Usage(NO_ALPHA.to_owned()));
    }
    if options.tile.is_some() && destination.format() == PictureFormat::Png && !transparent {
        return Err(Failure::Usage("a tile is a PPM; merge can write PNG".to_owned()));
    }
    Ok(destination)
}

fn pool(options: &DrawOptions) -> Result<ThreadPool, Failure> {
    // 0: one thread for each core.
    Ok(ThreadPoolBuilder::new().num_threads(options.threads.map_or(0, usize::from)).build()?)
}

/// Draws one picture: what `load` gives, into the destination's file `name`.
fn draw(
    name: &str,
    load: impl FnOnce() -> Result<Scene, Failure> + Send,
    destination: &Destination,
    options: &DrawOptions,
    pool: &ThreadPool,
) -> Result<(), Failure> {
    let note = |text: &str| {
        if !options.quiet {
            stderr::tell(text);
        }
    };
    let mut watch = Watch(Instant::now());

    // Load.
    let scene = pool.install(load)?;
    scene.warnings.iter().for_each(|warning| note(&format!("warning: {warning}")));
    scene.notes.iter().for_each(|told| note(&format!("note: {told}")));
    let (spheres, triangles, transparent) = (scene.spheres.len(), scene.triangles.len(), scene.transparent);
    let (PictureSize { width, height }, samples) = (options.size, options.samples);
    let view = view(&scene, options.size, samples)?;
    let rows = options.tile.map_or(0..height, |tile| tile.rows(height));
    let label = options.tile.map(|_| {
        let version = env!("CARGO_PKG_VERSION").to_owned();
        Label { rows: rows.clone(), width, height, samples, scene: scene.fingerprint(), version }.to_string()
    });
    if rows.is_empty() {
        // More tiles than rows: this one has nothing to do, and its absence leaves no gap.
        note(&format!("{name}: this tile has no rows, nothing is written"));
        return Ok(());
    }
    let load = watch.lap();

    // Build.
    let renderer = pool.install(|| Renderer::with(scene, options.tree));
    let build = watch.lap();

    // Trace. The target comes first, so that a folder that cannot be made is reported before the work.
    let name = options.tile.map_or_else(|| name.to_owned(), |tile| format!("{name}-{}", tile.suffix()));
    let target = destination.target(&name)?;
    let (format, maxval, band) = (destination.format(), options.depth.maxval(), rows.len());
    check_memory(if transparent { 4 } else { 3 }, width, band, maxval, format)?;
    let progress = Progress::new(band as u64, options.quiet);
    let drawn = pool.install(|| renderer.rows(&view, rows, maxval, &|rows| progress.advance(rows)));
    progress.finish();
    let trace = watch.lap();

    // Write.
    let (columns, height, all) = (width as usize, band, drawn.samples);
    let picture = if transparent {
        Picture::Transparent(Rgba { width: columns, height, maxval, samples: all })
    } else {
        let pixmap = Pixmap::new(columns, height, maxval, all);
        Picture::Opaque(pixmap.expect("the renderer fills the picture with samples up to maxval"))
    };
    target.write(&picture, label.as_deref(), format)?;
    let seconds = Seconds { load, build, trace, write: watch.lap() };

    let picture = target.name();
    if target != Target::Stdout {
        let total = load + build + trace + seconds.write;
        note(&format!("{picture}: {width} x {band} in {total:.2} s"));
    }
    if options.json {
        let (rays, hits, peak_memory_bytes) = (drawn.rays, drawn.hits, peak_memory());
        let account = Account {
            picture,
            width,
            height: band,
            samples,
            spheres,
            triangles,
            rays,
            hits,
            certified: drawn.certified,
            seconds,
            peak_memory_bytes,
        };
        to_stdout(format!("{}\n", serde_json::to_string(&account)?).as_bytes())?;
    }
    Ok(())
}

/// Joins tiles and writes the picture to `output`.
///
/// # Errors
/// What is wrong with the tiles, or why the picture could not be written.
pub fn merge(output: &Path, tiles: &[PathBuf], format: Option<PictureFormat>) -> Result<(), Failure> {
    let target = Target::exactly(output);
    // A name that is not written is refused before any work.
    let named = target.format(format)?;
    let picture = tile::merge(tiles)?;
    let said = format.is_some() || output::ending(output).is_some();
    let format = match picture {
        Picture::Transparent(_) if said && named != PictureFormat::Png => {
            return Err(Failure::Usage(NO_ALPHA.to_owned()));
        }
        Picture::Transparent(_) => PictureFormat::Png,
        Picture::Opaque(_) => named,
    };
    target.write(&picture, None, format)
}

/// Checks that there is memory for a picture while it is drawn and written.
fn check_memory(channels: u64, width: u32, rows: usize, maxval: u16, format: PictureFormat) -> Result<(), Failure> {
    let samples = channels * u64::from(width) * rows as u64;
    // It is drawn with two bytes a sample; where one is enough, they are copied then.
    let (held, copy) = if maxval <= 255 && channels == 3 { (samples, samples) } else { (2 * samples, 0) };
    let bytes = (2 * samples + copy).max(held + format.memory_to_write(samples, maxval));
    let what = format!("{width} x {rows} pixels");
    memory::check(bytes, &what, "draw a smaller picture (--size) or bands of it (--tile)")
}

fn view(scene: &Scene, size: PictureSize, samples: u32) -> Result<View, Failure> {
    let PictureSize { width, height } = size;
    scene
        .view(Size { width, height, samples })
        .ok_or_else(|| Failure::Failed("the camera cannot fit the scene: it is too large".into()))
}

/// Prints what a ray of the picture costs on average by each way to find what it hits: nodes visited and exact tests.
///
/// `scene` is a figure's number or a scene file.
///
/// # Errors
/// What is wrong with the scene, or a failed write.
pub fn count_tests(scene: &Path, size: PictureSize) -> Result<(), Failure> {
    let figure = scene.to_str().and_then(|text| text.parse().ok()).and_then(Figure::numbered);
    let scene = match figure {
        Some(figure) => figure.scene()?,
        None => load(scene)?,
    };
    let view = view(&scene, size, 1)?;
    let PictureSize { width, height } = size;
    let rays = u64::from(width) * u64::from(height);
    let mut text = format!("{} objects, {rays} rays; a ray on average:\n", scene.len());
    text += "tree            nodes  exact tests\n";
    for &method in Method::value_variants() {
        let objects = Objects::new(method, scene.spheres.clone(), scene.triangles.clone());
        let (nodes, tests) = (0..height)
            .into_par_iter()
            .flat_map_iter(|row| (0..width).map(move |column| (column, row)))
            .map(|(column, row)| objects.closest_counted(&view.ray(column, row)).1)
            .map(|visits| (visits.nodes as u64, visits.tests as u64))
            .reduce(|| (0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
        let value = method.to_possible_value();
        let name = value.as_ref().map_or("", |value| value.get_name());
        let [nodes, tests] = [nodes, tests].map(|count| count as f64 / rays as f64);
        text += &format!("{name:<10} {nodes:>10.1} {tests:>12.1}\n");
    }
    to_stdout(text.as_bytes())
}

/// A line on stderr that shows how far the work is: only at a terminal, and only if it takes a while.
struct Progress {
    start: Instant,
    bar: ProgressBar,
    quiet: bool,
    shown: Mutex<bool>,
}

impl Progress {
    fn new(rows: u64, quiet: bool) -> Self {
        let bar = ProgressBar::with_draw_target(Some(rows), ProgressDrawTarget::hidden());
        let style = ProgressStyle::with_template("{bar:40} {percent}% {eta} left").expect("a valid template");
        bar.set_style(style);
        Self { start: Instant::now(), bar, quiet, shown: Mutex::new(false) }
    }

    fn advance(&self, rows: u64) {
        self.bar.inc(rows);
        if self.quiet || self.start.elapsed() < PATIENCE {
            return;
        }
        let mut shown = self.shown.lock().expect("no thread panics while it holds the lock");
        if !*shown {
            *shown = true;
            // Hidden all the same where stderr is no terminal.
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
    }

    fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// The largest amount of memory that this process has held, in bytes, if the system says.
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix(" kB")?.trim().parse::<u64>().ok().map(|kilobytes| kilobytes * 1024)
}
