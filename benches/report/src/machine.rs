//! Where and when a report is measured.

use std::env;
use std::fs;
use std::process::Command;
use std::time::SystemTime;

use serde::{Deserialize, Serialize};

/// Where and when a report was measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Machine {
    pub(super) processor: String,
    pub(super) threads: usize,
    pub(super) fma: bool,
    /// How many processes wanted to run in the minute before, on average.
    pub(super) load: Option<f64>,
    pub(super) compiler: String,
    pub(super) version: String,
    /// The commit that was measured, or "unknown".
    pub(super) commit: String,
    pub(super) seconds_since_1970: u64,
}

impl Machine {
    /// Asks this machine.
    pub(super) fn this() -> Self {
        let processors = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let processor = processors.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
        let load = fs::read_to_string("/proc/loadavg").ok();
        Self {
            processor: processor.map_or("unknown", |(_, name)| name).to_owned(),
            threads: std::thread::available_parallelism().map_or(1, usize::from),
            fma: rt_math::exact::has_fma(),
            load: load.and_then(|text| text.split(' ').next()?.parse().ok()),
            compiler: said_by("rustc", &["--version"]).unwrap_or("unknown".to_owned()),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: commit().unwrap_or("unknown".to_owned()),
            seconds_since_1970: SystemTime::UNIX_EPOCH.elapsed().map_or(0, |elapsed| elapsed.as_secs()),
        }
    }
}

/// Returns the commit that `REPORT_COMMIT` names or, under `cargo run`, that of the source that was compiled.
fn commit() -> Option<String> {
    env::var("REPORT_COMMIT").ok().or_else(|| {
        let source = env::var("CARGO_MANIFEST_DIR").ok()?;
        said_by("git", &["-C", &source, "describe", "--always", "--abbrev=12", "--dirty", "--exclude=*"])
    })
}

/// Returns what a program writes, if it runs and has something to say.
fn said_by(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok().filter(|output| output.status.success())?;
    let text = String::from_utf8_lossy(&output.stdout).trim().to_owned();
    (!text.is_empty()).then_some(text)
}
