//! Speed against error, for every kernel, from one command.
//!
//! Each kernel is run by several [`methods`] on several classes of [`cases`], judged by an exact [`mod@reference`] and
//! timed on the very same cases ([`measure`]). What was measured is written as JSON; text and plots are made from it
//! alone.

mod cases;
mod check;
mod corpus;
mod cull;
mod document;
mod kernels;
mod labels;
mod machine;
mod markup;
mod measure;
mod methods;
mod pictures;
mod plot;
mod progress;
mod random;
mod reference;
mod results;
mod svg;
mod trees;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use clap::Parser;
use figures::outcome::{Failure, exit_code, parsed};
use figures::output::check_new_folder;
use figures::stderr;
use rt_io::save_atomically;

use markup::{Block, Picture};
use measure::Effort;
use results::Report;

/// Measures the speed and the error of every kernel beside the textbook's methods
#[derive(Parser, Clone, Debug)]
#[command(name = "report", version)]
struct ReportOptions {
    /// The folder to write report.json, report.md, report.html, plots and pictures into
    #[arg(short, long, value_name = "DIR", default_value = "report")]
    out: PathBuf,
    /// Measure less: some seconds instead of a minute or two
    #[arg(long)]
    quick: bool,
    /// Measure nothing; write text, plots and pictures of this report.json again
    #[arg(long, value_name = "FILE", conflicts_with_all = ["quick", "check"])]
    from: Option<PathBuf>,
    /// Measure as FILE was measured, write nothing, and fail unless all errors are equal
    #[arg(long, value_name = "FILE")]
    check: Option<PathBuf>,
    /// Measure nothing; write the hostile corpus, with so many rows for each class of cases
    #[arg(long, value_name = "ROWS", num_args = 0..=1, default_missing_value = "24", conflicts_with_all = ["quick", "check", "from"])]
    corpus: Option<usize>,
    /// Measure nothing; write the picture of the front page: one scene by the textbook and by ours
    #[arg(long, value_name = "FILE", conflicts_with_all = ["quick", "check", "from", "corpus"])]
    front: Option<PathBuf>,
    /// With --check: also fail where a time differs by more than this factor
    #[arg(long, value_name = "FACTOR", requires = "check", value_parser = factor)]
    factor: Option<f64>,
}

/// Reads the factor by which times may differ.
fn factor(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|factor: &f64| (1.0..=1e9).contains(factor));
    number.ok_or_else(|| format!("expected a number of at least 1, found {text:?}"))
}

const FULL: Effort = Effort { cases: 2048, rounds: 11, timing: 300_000, spheres: 1_000_000, rows: 150 };
const QUICK: Effort = Effort { cases: 128, rounds: 9, timing: 20_000, spheres: 10_000, rows: 48 };

fn main() -> ExitCode {
    match parsed() {
        Ok(options) => exit_code(run(&options)),
        Err(code) => code,
    }
}

/// Measures, or reads what was measured, and writes or compares it.
fn run(options: &ReportOptions) -> Result<(), Failure> {
    if let Some(path) = &options.front {
        let png = pictures::front();
        return Ok(save_atomically(path, |out| out.write_all(&png))?);
    }
    if options.out == Path::new("-") {
        return Err(Failure::Usage("a report is many files and needs a folder: --out DIR".to_owned()));
    }
    check_new_folder(&options.out)?;
    if let Some(path) = &options.check {
        let stored = read(path)?;
        if options.quick && stored.effort != QUICK {
            return Err(FileError::new(path, "was not measured with --quick").into());
        }
        let differences = check::differences(&stored, &Report::measure(stored.effort), options.factor);
        return if differences.is_empty() { Ok(()) } else { Err(Failure::Different(differences)) };
    }
    if let Some(rows) = options.corpus {
        fs::create_dir_all(&options.out).map_err(|error| FileError::new(&options.out, error))?;
        for (name, text) in corpus::files(rows) {
            save_atomically(&options.out.join(name), |out| out.write_all(text.as_bytes()))?;
        }
        stderr::tell(&format!("report: corpus written to {}", options.out.display()));
        return Ok(());
    }
    let report = match &options.from {
        Some(path) => read(path)?,
        None => Report::measure(if options.quick { QUICK } else { FULL }),
    };
    write(&report, &options.out)?;
    stderr::tell(&format!("report: written to {}", options.out.display()));
    Ok(())
}

fn read(path: &Path) -> Result<Report, FileError> {
    let text = fs::read_to_string(path).map_err(|error| FileError::new(path, error))?;
    let report: Report = serde_json::from_str(&text).map_err(|error| FileError::new(path, error))?;
    check::whole(&report).map_err(|problem| FileError::new(path, problem))?;
    Ok(report)
}

fn write(report: &Report, folder: &Path) -> Result<(), Failure> {
    fs::create_dir_all(folder).map_err(|error| FileError::new(folder, error))?;
    // Each file is whole at any time, also the one that the report was read from. The measurements come first: the rest
    // can be made of them again.
    let save = |name: &str, bytes: &[u8]| -> Result<(), Failure> {
        Ok(save_atomically(&folder.join(name), |out| out.write_all(bytes))?)
    };
    save("report.json", (serde_json::to_string_pretty(report)? + "\n").as_bytes())?;
    let blocks = document::blocks(report);
    save("report.md", markup::markdown(&blocks).as_bytes())?;
    save("report.html", markup::html(&blocks).as_bytes())?;
    for block in &blocks {
        match block {
            Block::Plot(file, _, svg) => save(file, svg.as_bytes())?,
            Block::Pictures(pictures) => {
                for Picture { file, png, .. } in pictures {
                    save(file, &BASE64_STANDARD.decode(png).expect("a report's pictures were checked"))?;
                }
            }
            _ => {}
        }
    }
    Ok(())
}

/// A file that cannot be used.
#[derive(Debug, thiserror::Error)]
#[error("{}: {problem}", path.display())]
struct FileError {
    path: PathBuf,
    problem: String,
}

impl FileError {
    fn new(path: &Path, problem: impl ToString) -> Self {
        Self { path: path.to_owned(), problem: problem.to_string() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_text_follows_from_the_json_alone() {
        let report = Report::measure(Effort { cases: 8, rounds: 1, timing: 1, spheres: 100, rows: 6 });
        let json = serde_json::to_string(&report).unwrap();
        let read: Report = serde_json::from_str(&json).unwrap();
        assert_eq!(read, report);
        let text = |report| {
            let blocks = document::blocks(report);
            markup::html(&blocks) + &markup::markdown(&blocks)
        };
        assert!(text(&read) == text(&report));
    }

    #[test]
    fn our_kernels_make_no_error_but_those_that_are_stated() {
        for kernel in kernels::kernels(Effort { cases: 64, rounds: 1, timing: 1, spheres: 0, rows: 0 }) {
            let Some(ours) = kernel.methods.iter().find(|method| method.name == "ours") else {
                assert!(kernel.one_sided, "{} has no method of ours", kernel.name);
                continue;
            };
            let total = ours.total();
            assert_eq!((total.wrong_verdicts, total.nan), (0, 0), "{}", kernel.name);
            // What is correctly rounded has no error; coordinates are within 1 ulp and a radius within a few.
            let bound = match kernel.name.as_str() {
                "texture coordinates" => 1.0,
                "enclosing sphere" => 20.0,
                _ => 0.0,
            };
            assert!(total.max_ulp <= bound, "{}: {} ulp", kernel.name, total.max_ulp);
        }
    }

    #[test]
    fn every_kernel_has_a_panel_with_three_methods_and_hard_classes() {
        for kernel in kernels::kernels(Effort { cases: 4, rounds: 1, timing: 1, spheres: 0, rows: 0 }) {
            assert!(kernel.methods.len() >= 3, "{}", kernel.name);
            assert!(kernel.methods.iter().any(|method| method.ours), "{}", kernel.name);
            assert!(kernel.methods[0].classes.len() >= 6, "{}", kernel.name);
        }
    }
}
