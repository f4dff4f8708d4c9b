//! The command `report`: what it cannot read or compare is told by name.

use std::fs;
use std::process::{Command, Output};

fn figures(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_figures")).args(arguments).output().expect("the program starts")
}

fn complaint(output: &Output) -> String {
    assert!(output.stdout.is_empty(), "stdout is for what was asked");
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn a_missing_report_is_named() {
    for option in ["--from", "--check"] {
        let output = figures(&["report", option, "no/such/report.json"]);
        assert_eq!(output.status.code(), Some(1), "{option}");
        let complaint = complaint(&output);
        assert!(complaint.starts_with("error: no/such/report.json: "), "{complaint}");
    }
}

#[test]
fn a_file_that_is_no_report_is_named_with_the_place() {
    let folder = tempfile::tempdir().expect("a folder for the test");
    let path = folder.path().join("report.json");
    fs::write(&path, "{\n  \"machine\": 7\n}\n").expect("the file can be written");
    let path = path.to_str().expect("a plain path");
    let output = figures(&["report", "--from", path, "--out", folder.path().to_str().expect("a plain path")]);
    assert_eq!(output.status.code(), Some(1));
    let complaint = complaint(&output);
    assert!(complaint.contains("report.json: ") && complaint.contains("line 2"), "{complaint}");
}

#[test]
fn options_that_contradict_are_wrong_usage() {
    let output = figures(&["report", "--quick", "--from", "report.json"]);
    assert_eq!(output.status.code(), Some(2));
}
