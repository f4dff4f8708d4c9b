//! Speed against error, for every kernel, from one command.
//!
//! Each kernel is run by several [`methods`] on several classes of [`cases`], judged by an exact [`reference`] and timed
//! on the very same cases ([`measure`]). What was measured is written as JSON; text and plots are made from it alone.

mod cases;
mod check;
mod document;
mod measure;
mod methods;
mod plot;
mod reference;
mod trees;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde::{Deserialize, Serialize};

use crate::cli::Failure;
use measure::{Effort, Kernel};
use methods::Answer;
use trees::Growth;

/// What `figures report` is asked for.
#[derive(clap::Args, Clone, Debug)]
pub(crate) struct Options {
    /// The folder to write report.json, report.md, report.html and the plots into
    #[arg(short, long, value_name = "DIR", default_value = "report")]
    out: PathBuf,
    /// Measure less: some seconds instead of a minute
    #[arg(long)]
    quick: bool,
    /// Measure nothing; write text and plots of this report.json again
    #[arg(long, value_name = "FILE", conflicts_with_all = ["quick", "check"])]
    from: Option<PathBuf>,
    /// Measure as FILE was measured and fail unless errors are equal
    #[arg(long, value_name = "FILE", conflicts_with = "quick")]
    check: Option<PathBuf>,
    /// With --check: also fail where a time differs by more than this factor
    #[arg(long, value_name = "FACTOR", requires = "check")]
    factor: Option<f64>,
}

/// All that one run measured, and where.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Report {
    machine: Machine,
    effort: Effort,
    kernels: Vec<Kernel>,
    trees: Vec<Growth>,
}

/// Where and when a report was measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Machine {
    processor: String,
    threads: usize,
    fma: bool,
    compiler: String,
    version: String,
    seconds_since_1970: u64,
}

const FULL: Effort = Effort { cases: 1024, rounds: 11, timing: 300_000 };
const QUICK: Effort = Effort { cases: 128, rounds: 9, timing: 20_000 };

/// Measures, or reads what was measured, and writes or compares it.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let read = |path: &Path| -> Result<Report, Failure> {
        let text = fs::read_to_string(path)
            .map_err(|error| Failure::from(ReadError { path: path.to_owned(), cause: error.to_string() }))?;
        serde_json::from_str(&text)
            .map_err(|error| ReadError { path: path.to_owned(), cause: error.to_string() }.into())
    };
    if let Some(path) = &options.check {
        let stored = read(path)?;
        let differences = check::differences(&stored, &measure(stored.effort), options.factor);
        return if differences.is_empty() { Ok(()) } else { Err(Different(differences).into()) };
    }
    let report = match &options.from {
        Some(path) => read(path)?,
        None => measure(if options.quick { QUICK } else { FULL }),
    };
    write(&report, &options.out)
}

/// Measures every kernel.
fn measure(effort: Effort) -> Report {
    fn as_is<const M: usize, const N: usize>(_: &[f64; M], answer: Answer<N>) -> Answer<N> {
        answer
    }
    let n = effort.cases;
    let kernels = vec![
        measure::kernel(
            ["quadratic", "number of roots", "roots"],
            &methods::quadratic(),
            &cases::quadratic(n),
            reference::quadratic,
            as_is,
            effort,
        ),
        measure::kernel(
            ["ray and sphere", "hit or miss", "t of the nearest hit"],
            &methods::sphere(),
            &cases::sphere(n),
            reference::sphere,
            as_is,
            effort,
        ),
        measure::kernel(
            ["ray and triangle", "hit or miss", "t of the hit"],
            &methods::triangle(),
            &cases::triangle(n),
            reference::triangle,
            as_is,
            effort,
        ),
        measure::kernel(
            ["point in triangle", "inside or outside", ""],
            &methods::inside(),
            &cases::inside(n),
            reference::inside,
            as_is,
            effort,
        ),
        measure::kernel(
            ["pseudo-inverse", "rank", "entries"],
            &methods::pseudo_inverses(),
            &cases::pseudo_inverse(n),
            reference::pseudo_inverse,
            as_is,
            effort,
        ),
        measure::kernel(
            ["reflection", "", "components"],
            &methods::reflection(),
            &cases::reflection(n),
            reference::reflection,
            as_is,
            effort,
        ),
        measure::kernel(
            ["texture coordinates", "", "u and v"],
            &methods::mapping(),
            &cases::mapping(n),
            reference::mapping,
            as_is,
            effort,
        ),
        measure::kernel(
            ["enclosing sphere", "all inside", "radius"],
            &methods::enclosing(),
            &cases::enclosing(n.div_ceil(4)),
            reference::enclosing,
            reference::judge_enclosing,
            effort,
        ),
    ];
    let largest = if effort.cases >= FULL.cases { 100_000 } else { 10_000.min(100 * n) };
    Report { machine: machine(), effort, kernels, trees: trees::growth(largest, effort) }
}

fn machine() -> Machine {
    let information = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let processor = information
        .lines()
        .find_map(|line| line.strip_prefix("model name")?.split_once(": "))
        .map_or("unknown".to_owned(), |(_, name)| name.to_owned());
    let compiler = Command::new("rustc").arg("--version").output().map(|output| output.stdout);
    Machine {
        processor,
        threads: std::thread::available_parallelism().map_or(1, usize::from),
        fma: rt_math::exact::has_fma(),
        compiler: String::from_utf8_lossy(&compiler.unwrap_or_default()).trim().to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        seconds_since_1970: std::time::SystemTime::UNIX_EPOCH
            .elapsed()
            .map_or(0, |elapsed| elapsed.as_secs()),
    }
}

fn write(report: &Report, folder: &Path) -> Result<(), Failure> {
    fs::create_dir_all(folder)
        .map_err(|error| ReadError { path: folder.to_owned(), cause: error.to_string() })?;
    let save = |name: &str, text: &str| -> Result<(), Failure> {
        let path = folder.join(name);
        fs::write(&path, text).map_err(|error| ReadError { path, cause: error.to_string() }.into())
    };
    save("report.json", &(serde_json::to_string_pretty(report)? + "\n"))?;
    let blocks = document::blocks(report);
    save("report.md", &document::markdown(&blocks))?;
    save("report.html", &document::html(&blocks))?;
    for (name, svg) in document::plots(&blocks) {
        save(name, svg)?;
    }
    Ok(())
}

/// A file that cannot be read or written.
#[derive(Debug, thiserror::Error)]
#[error("{}: {cause}", path.display())]
struct ReadError {
    path: PathBuf,
    cause: String,
}

/// What a check found.
#[derive(Debug, thiserror::Error)]
#[error("{} differences from the stored report:\n{}", .0.len(), .0.join("\n"))]
struct Different(Vec<String>);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_text_follows_from_the_json_alone() {
        let report = measure(Effort { cases: 8, rounds: 1, timing: 1 });
        let json = serde_json::to_string(&report).unwrap();
        let read: Report = serde_json::from_str(&json).unwrap();
        assert_eq!(read, report);
        let text = |report| {
            document::html(&document::blocks(report)) + &document::markdown(&document::blocks(report))
        };
        assert!(text(&read) == text(&report));
    }

    #[test]
    fn our_kernels_make_no_error() {
        let report = measure(Effort { cases: 64, rounds: 1, timing: 1 });
        for kernel in &report.kernels {
            let ours =
                kernel.methods.iter().find(|method| method.name == "ours").expect("each kernel has ours");
            let total = ours.total();
            assert_eq!(total.wrong_verdicts, 0, "{}", kernel.name);
            // What is correctly rounded has no error; coordinates are within 1 ulp, a radius within a few.
            let bound = match kernel.name.as_str() {
                "texture coordinates" => 1.0,
                "enclosing sphere" => 20.0,
                _ => 0.0,
            };
            assert!(total.max_ulp <= bound, "{}: {} ulp", kernel.name, total.max_ulp);
        }
    }
}
