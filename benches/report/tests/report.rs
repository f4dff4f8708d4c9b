//! The program `report`: text and plots follow from the JSON alone, a check fails on a changed error, and what cannot
//! be read is told by name.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use oracle::files::{files, folder};

/// A quick run, stored.
const STORED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/report/quick.json");

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_report")).args(arguments).output().expect("the program starts")
}

fn complaint(output: &Output) -> String {
    assert!(output.stdout.is_empty(), "stdout is for what was asked");
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a plain path")
}

/// The stored run, cut down to what is measured in a second, with its errors changed by that.
fn smaller(folder: &Path) -> String {
    let stored = fs::read_to_string(STORED).expect("a quick run is stored");
    let mut report: serde_json::Value = serde_json::from_str(&stored).expect("it is JSON");
    report["effort"] = serde_json::json!({ "cases": 2, "rounds": 1, "timing": 1, "spheres": 100, "rows": 3 });
    let path = folder.join("smaller.json");
    fs::write(&path, report.to_string()).expect("the file can be written");
    text(&path).to_owned()
}

#[test]
fn a_report_written_again_from_its_json_has_the_same_bytes() {
    let folder = folder();
    let (first, second) = (folder.path().join("first"), folder.path().join("second"));
    assert!(run(&["--from", STORED, "--out", text(&first)]).status.success());
    let json = first.join("report.json");
    assert!(run(&["--from", text(&json), "--out", text(&second)]).status.success());
    let (first, second) = (files(&first), files(&second));
    let names: Vec<&String> = first.keys().collect();
    for name in ["report.html", "report.md", "pictures.svg", "trees.svg", "quadratic.svg", "far-sphere-ours.png"] {
        assert!(first.contains_key(name), "{name} is missing from {names:?}");
    }
    assert!(first == second, "the bytes of {names:?} differ");
}

#[test]
fn a_check_against_other_errors_fails_and_names_them() {
    let folder = folder();
    let output = run(&["--check", &smaller(folder.path())]);
    assert_eq!(output.status.code(), Some(1));
    let complaint = complaint(&output);
    assert!(complaint.contains(" differences from the stored report:\n"), "{complaint}");
    assert!(complaint.contains("quadratic, textbook, nearly double roots: "), "{complaint}");
}

#[test]
fn a_quick_check_wants_a_quick_run() {
    let folder = folder();
    let output = run(&["--quick", "--check", &smaller(folder.path())]);
    assert_eq!(output.status.code(), Some(1));
    assert!(complaint(&output).ends_with("smaller.json: was not measured with --quick\n"));
}

#[test]
fn a_missing_report_is_named() {
    for option in ["--from", "--check"] {
        let output = run(&[option, "no/such/report.json"]);
        assert_eq!(output.status.code(), Some(1), "{option}");
        let complaint = complaint(&output);
        assert!(complaint.starts_with("error: no/such/report.json: "), "{complaint}");
    }
}

#[test]
fn a_file_that_is_no_report_is_named_with_the_place() {
    let folder = folder();
    let path = folder.path().join("report.json");
    fs::write(&path, "{\n  \"machine\": 7\n}\n").expect("the file can be written");
    let output = run(&["--from", text(&path), "--out", text(folder.path())]);
    assert_eq!(output.status.code(), Some(1));
    let complaint = complaint(&output);
    assert!(complaint.contains("report.json: ") && complaint.contains("line 2"), "{complaint}");
}

/// Takes something out of a report.
type Hole = fn(&mut serde_json::Value);

#[test]
fn a_report_with_a_hole_is_refused() {
    let folder = folder();
    let stored = fs::read_to_string(STORED).expect("a quick run is stored");
    let holes: [(&str, Hole); 4] = [
        ("expected every method of \"quadratic\" with the same classes", |report| {
            report["kernels"][0]["methods"][1]["classes"] = serde_json::json!([]);
        }),
        ("expected at least one kernel, one tree and one picture", |report| {
            report["trees"] = serde_json::json!([]);
        }),
        ("expected a picture in base64", |report| {
            report["pictures"][7]["methods"][1]["png"] = "no picture".into();
        }),
        ("expected a time above 0 for quadratic, textbook f32, ordinary", |report| {
            report["kernels"][0]["methods"][0]["classes"][0]["time"]["median"] = 0.0.into();
        }),
    ];
    for (expected, hole) in holes {
        let mut report: serde_json::Value = serde_json::from_str(&stored).expect("it is JSON");
        hole(&mut report);
        let path = folder.path().join("report.json");
        fs::write(&path, report.to_string()).expect("the file can be written");
        let output = run(&["--from", text(&path), "--out", text(folder.path())]);
        assert_eq!(output.status.code(), Some(1), "{expected}");
        let complaint = complaint(&output);
        assert!(complaint.contains(expected), "{complaint}");
    }
}

#[test]
fn a_folder_that_cannot_be_made_is_named() {
    let folder = folder();
    let file = folder.path().join("file");
    fs::write(&file, "").expect("the file can be written");
    let below = file.join("report");
    let output = run(&["--from", STORED, "--out", text(&below)]);
    assert_eq!(output.status.code(), Some(1));
    let complaint = complaint(&output);
    assert!(complaint.starts_with(&format!("error: {}: ", text(&below))), "{complaint}");
}

#[test]
fn options_that_contradict_are_wrong_usage() {
    for arguments in [
        &["--quick", "--from", "report.json"][..],
        &["--check", "report.json", "--from", "report.json"],
        &["--factor", "2"],
        &["--check", "report.json", "--factor", "0.5"],
        &["--check", "report.json", "--factor", "nan"],
        &["--from", "report.json", "--out", "-"],
        &["--from", "report.json", "--out", "report.html"],
    ] {
        assert_eq!(run(arguments).status.code(), Some(2), "{arguments:?}");
    }
}
