//! Whatever happens to the report while it saves, be it a kill or a full disk, each of its files is the old one or the
//! new one, whole.
#![cfg(unix)]

use std::fs;
use std::process::Command;

use oracle::files::{files, folder, names};
use oracle::kills::{check_refusal, kill_savers, long, succeed};

const PROGRAM: &str = env!("CARGO_BIN_EXE_report");

/// A quick run, stored.
const REPORT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/report/quick.json");

#[test]
fn kills_leave_every_file_of_a_report_whole() {
    let stored = fs::read_to_string(REPORT).unwrap();
    let inputs = folder();
    let cases = ["another processor", "a processor of another name"].map(|processor| {
        let mut report: serde_json::Value = serde_json::from_str(&stored).unwrap();
        report["machine"]["processor"] = processor.into();
        let input = inputs.path().join(processor.replace(' ', "-"));
        fs::write(&input, report.to_string()).unwrap();
        let arguments = format!("--from {} --out ./", input.display());
        let whole = folder();
        succeed(PROGRAM, whole.path(), &arguments);
        (files(whole.path()), arguments)
    });
    let [(first, write_first), (second, write_second)] = cases;
    for name in ["report.json", "report.md", "report.html"] {
        assert!(first[name] != second[name], "{name}");
    }
    assert!(first.contains_key("quadratic.svg") && first.contains_key("far-sphere-ours.png"));
    kill_savers(PROGRAM, &[first, second], &[write_first, write_second], if long() { 100 } else { 20 });
}

#[test]
fn a_report_that_meets_a_full_disk_keeps_what_it_was_read_from() {
    let folder = folder();
    fs::copy(REPORT, folder.path().join("report.json")).unwrap();
    fs::write(folder.path().join("report.md"), "old").unwrap();
    let before = files(folder.path());
    let script = r#"trap '' XFSZ; ulimit -f 16; exec "$0" --from report.json --out ./"#;
    let output = Command::new("sh").args(["-c", script, PROGRAM]).current_dir(&folder).output().unwrap();
    check_refusal(&output, "./report.json: writing failed: File too large (os error 27)");
    assert!(files(folder.path()) == before, "{:?}", names(folder.path()));
}
