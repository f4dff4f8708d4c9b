//! `figures ask`: is a point inside, and what does a ray hit, all of it, in order.

use std::fs;
use std::io::Write;
use std::process::{Command, Stdio};

use oracle::files::folder;
use serde_json::{Value, json};

/// The cube from 0 to 1, its faces squares, seen counterclockwise from outside.
const CUBE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n\
                    f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

/// Asks about a mesh, with these files beside it; returns the exit code, the answers, and what was said.
fn ask(mesh: &str, questions: &[u8], arguments: &[&str]) -> (Option<i32>, String, String) {
    let folder = folder();
    fs::write(folder.path().join("cube.obj"), mesh).unwrap();
    fs::write(folder.path().join("questions.xyz"), questions).unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_figures"))
        .args(["ask", "cube.obj"])
        .args(arguments)
        .current_dir(folder.path())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let _ = child.stdin.take().unwrap().write_all(questions);
    let output = child.wait_with_output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code(), text(output.stdout), text(output.stderr))
}

#[test]
fn points_are_inside_on_or_outside() {
    let points = b"0.5 0.5 0.5\n\n1 0.25 0.25\n1 1 1\n1.0000000000000002 0.5 0.5\n";
    for file in ["questions.xyz", "-"] {
        let (code, answers, said) = ask(CUBE, points, &["--contains", file]);
        assert_eq!((code, answers.as_str(), said.as_str()), (Some(0), "inside\non\non\noutside\n", ""), "{file}");
    }
    let (_, answers, _) = ask(CUBE, points, &["--contains", "-", "--json"]);
    assert_eq!(answers.lines().next(), Some("{\"side\":\"inside\"}"));
}

#[test]
fn an_xyz_file_is_a_file_of_points() {
    let (code, answers, _) =
        ask(CUBE, b"2\na comment\nC 0.5 0.5 0.5 1 1 1\nO 2 2 2\n", &["--contains", "questions.xyz"]);
    assert_eq!((code, answers.as_str()), (Some(0), "inside\noutside\n"));
}

#[test]
fn rays_hit_everything_in_order() {
    // Through the middle of two faces, each cut along a diagonal; then beside the cube.
    let rays = b"0.5 0.25 -1 0 0 2\n5 5 5 1 0 0\n";
    let (code, answers, _) = ask(CUBE, rays, &["--rays", "-"]);
    assert_eq!(code, Some(0));
    let lines: Vec<&str> = answers.split('\n').collect();
    assert_eq!(lines.len(), 3, "{answers}");
    let ts: Vec<&str> = lines[0].split("  ").map(|hit| hit.split_once(' ').unwrap().1).collect();
    assert_eq!((ts, lines[1]), (vec!["0.5", "1.0"], ""));
    let (_, answers, _) = ask(CUBE, rays, &["--rays", "-", "--json"]);
    let answers: Vec<Value> = answers.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let crossings = answers[0]["crossings"].as_array().unwrap();
    let seen: Vec<Value> = crossings.iter().map(|crossing| json!([crossing["t"], crossing["entering"]])).collect();
    assert_eq!(seen, [json!([0.5, true]), json!([1.0, false])]);
    assert_eq!(answers[1], json!({ "hits": [], "crossings": [] }));
}

#[test]
fn an_open_mesh_says_so() {
    let open = CUBE.strip_suffix("f 2 4 8 6\n").unwrap();
    let (code, answers, said) = ask(open, b"0.5 0.5 0.5\n", &["--contains", "-"]);
    assert_eq!(code, Some(0));
    assert!(answers == "inside\n" || answers == "outside\n", "{answers}");
    assert!(said.starts_with("warning: the mesh is not closed: 4 of its edges"), "{said}");
    assert_eq!(ask(open, b"0.5 0.5 0.5\n", &["--contains", "-", "--quiet"]).2, "");
}

#[test]
fn a_bad_question_is_told_with_its_line_and_answers_before_it_stand() {
    let (code, answers, said) = ask(CUBE, b"0.5 0.5 0.5\n1 2\n", &["--contains", "questions.xyz"]);
    assert_eq!((code, answers.as_str()), (Some(1), "inside\n"));
    assert_eq!(said, "error: questions.xyz:2: expected three finite numbers: x y z, found \"1 2\"\n");
    let (code, _, said) = ask(CUBE, b"0 0 0 0 0 0\n", &["--rays", "-"]);
    assert_eq!(code, Some(1));
    assert!(said.contains("stdin:1: expected six numbers"), "{said}");
    assert!(ask(CUBE, b"", &["--rays", "nothing.txt"]).2.contains("cannot read nothing.txt"));
    assert_eq!(ask(CUBE, b"", &[]).0, Some(2));
}
