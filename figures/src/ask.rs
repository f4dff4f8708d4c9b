//! What a mesh is asked from the command line: is a point inside, what does a ray hit, all of it, in order.
//!
//! Questions are read line by line and answered in blocks, so that neither the questions nor the answers have to fit in
//! memory.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::mem::take;
use std::path::Path;

use glam::DVec3;
use rayon::prelude::*;
use rt_geom::{AHEAD, Bvh, Crossing, Hit, Ray, Side};
use serde::Serialize;

use crate::import::{decimal, shown};
use crate::outcome::{Failure, stream_to_stdout};
use crate::text::file_name;
use crate::{draw, stderr};

/// Questions that are answered together.
const BLOCK: usize = 4096;
/// No question is longer.
const LONGEST_LINE: u64 = 4096;

/// What is wrong with the questions.
#[derive(Debug, thiserror::Error)]
enum QuestionError {
    #[error("cannot read {path}")]
    Read { path: String, source: io::Error },
    #[error("{path}:{line}: expected {expected}, found {found:?}")]
    Line { path: String, line: usize, expected: &'static str, found: String },
}

/// How answers are written.
#[derive(Clone, Copy, Debug)]
pub struct Style {
    /// JSON, one object a line, instead of text.
    pub json: bool,
    /// No warnings.
    pub quiet: bool,
}

/// Answers for each point in a file, or on stdin for `-`, whether it is inside of the objects in `mesh`.
///
/// A line of the file has three numbers, or is one of an XYZ file, whose labels are passed over.
///
/// # Errors
/// What is wrong with the mesh or a question, or a failed write.
pub fn contains(mesh: &Path, points: &Path, style: Style) -> Result<(), Failure> {
    let tree = tree(mesh, style)?;
    let open = tree.open_edges();
    if let Some(first) = open.first().filter(|_| !style.quiet) {
        let [a, b] = first.ends;
        stderr::tell(&format!(
            "warning: the mesh is not closed: {} of its edges lie in an odd number of triangles, as the one from {a} to {b}; \
             what is inside is no more than the parity in one direction",
            open.len()
        ));
    }
    let point = |numbers: [f64; 3]| Some(DVec3::from_array(numbers)).filter(|point| point.is_finite());
    let answer = |point: &DVec3, text: &mut String| {
        let side = match tree.contains(*point) {
            Side::Inside => "inside",
            Side::On => "on",
            Side::Outside => "outside",
        };
        let _ = if style.json { writeln!(text, "{{\"side\":\"{side}\"}}") } else { writeln!(text, "{side}") };
    };
    stream(points, "three finite numbers: x y z", point, answer)
}

/// Answers for each ray in a file, or on stdin for `-`, what it hits, all of it, in order.
///
/// A line of the file has six numbers: origin and direction.
///
/// # Errors
/// As [`contains`].
pub fn rays(mesh: &Path, rays: &Path, style: Style) -> Result<(), Failure> {
    #[derive(Serialize)]
    struct Answer {
        hits: Vec<JsonHit>,
        crossings: Vec<JsonCrossing>,
    }
    #[derive(Serialize)]
    struct JsonHit {
        index: usize,
        t: f64,
    }
    #[derive(Serialize)]
    struct JsonCrossing {
        index: usize,
        t: f64,
        entering: bool,
    }
    let tree = tree(mesh, style)?;
    let ray = |numbers: [f64; 6]| {
        let [a, b, c, d, e, f] = numbers;
        Ray::new([a, b, c], [d, e, f]).ok()
    };
    let answer = |ray: &Ray, text: &mut String| {
        let (mut hits, mut crossings) = (Vec::<Hit>::new(), Vec::<Crossing>::new());
        tree.hits(ray, AHEAD, &mut hits);
        if style.json {
            tree.crossings(ray, &mut crossings);
            let hits = hits.iter().map(|&Hit { index, t }| JsonHit { index, t }).collect();
            let crossings =
                crossings.iter().map(|&Crossing { index, t, entering }| JsonCrossing { index, t, entering });
            let answer = Answer { hits, crossings: crossings.collect() };
            // Plain data: it cannot fail. A `t` beyond the largest double is null.
            text.push_str(&serde_json::to_string(&answer).unwrap_or_default());
        } else {
            for (at, Hit { index, t }) in hits.iter().enumerate() {
                let _ = write!(text, "{}{index} {t:?}", if at == 0 { "" } else { "  " });
            }
        }
        text.push('\n');
    };
    stream(rays, "six numbers, finite and the last three not all zero: origin and direction", ray, answer)
}

/// The objects in a mesh, a file of spheres or a scene.
fn tree(mesh: &Path, style: Style) -> Result<Bvh, Failure> {
    let scene = draw::load(mesh)?;
    if !style.quiet {
        scene.warnings.iter().for_each(|warning| stderr::tell(&format!("warning: {warning}")));
    }
    Ok(Bvh::new(scene.spheres, scene.triangles))
}

/// Reads questions of `N` numbers, answers them in blocks, and writes the answers in order.
fn stream<const N: usize, Q: Send + Sync>(
    path: &Path,
    expected: &'static str,
    question: impl Fn([f64; N]) -> Option<Q>,
    answer: impl Fn(&Q, &mut String) + Sync,
) -> Result<(), Failure> {
    let name = if path == Path::new("-") { "stdin".to_owned() } else { file_name(path) };
    let failed = |source| QuestionError::Read { path: name.clone(), source };
    let source: Box<dyn Read> =
        if path == Path::new("-") { Box::new(io::stdin().lock()) } else { Box::new(File::open(path).map_err(failed)?) };
    let mut source = BufReader::with_capacity(1 << 16, source);
    let mut line = Vec::new();
    let (mut number_of_line, mut block) = (0, Vec::with_capacity(BLOCK));
    let (mut problem, mut header) = (None, 0);
    stream_to_stdout(|out| {
        let mut flush = |block: Vec<Q>| -> io::Result<()> {
            let texts: Vec<String> = block
                .par_chunks(64)
                .map(|questions| {
                    let mut text = String::new();
                    questions.iter().for_each(|question| answer(question, &mut text));
                    text
                })
                .collect();
            texts.iter().try_for_each(|text| out.write_all(text.as_bytes()))
        };
        loop {
            line.clear();
            match source.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut line) {
                Ok(0) => break,
                Ok(_) => number_of_line += 1,
                Err(error) => {
                    problem = Some(failed(error));
                    break;
                }
            }
            let text = line.trim_ascii();
            // The head of an XYZ file: a count, and a comment of any kind.
            if N == 3 && number_of_line == 1 && text.iter().all(u8::is_ascii_digit) && !text.is_empty() {
                header = 2;
            }
            if text.is_empty() || number_of_line <= header {
                continue;
            }
            match numbers(text, header > 0).and_then(&question) {
                Some(question) => block.push(question),
                None => {
                    let found = shown(text);
                    problem = Some(QuestionError::Line { path: name.clone(), line: number_of_line, expected, found });
                    break;
                }
            }
            if block.len() == BLOCK {
                flush(take(&mut block))?;
            }
        }
        flush(take(&mut block))
    })?;
    problem.map_or(Ok(()), |problem| Err(problem.into()))
}

/// The `N` numbers of a line; of an XYZ file after a label, and whatever follows them.
fn numbers<const N: usize>(line: &[u8], labelled: bool) -> Option<[f64; N]> {
    let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    if labelled {
        words.next()?;
    }
    let mut numbers = [0.0; N];
    for place in &mut numbers {
        *place = decimal(words.next()?)?;
    }
    (labelled || words.next().is_none()).then_some(numbers)
}
