//! Bad input ends with its own message and exit code, and nothing is written: the lists in `tests/bad/`.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// One entry of a list: what is wrong, the message, and the input.
struct Case {
    claim: &'static str,
    message: &'static str,
    input: String,
}

/// Reads a list: `== claim`, `-- message`, then the input up to the next entry; its last empty line is only a gap.
fn cases(list: &'static str) -> Vec<Case> {
    let entries = list.split("\n== ").skip(1);
    let case = |entry: &'static str| {
        let (claim, rest) = entry.split_once("\n-- ").expect("a claim, then a message");
        let (message, input) = rest.split_once('\n').unwrap_or((rest, ""));
        let input = input.strip_suffix('\n').unwrap_or(input);
        Case { claim, message, input: if input.is_empty() { String::new() } else { format!("{input}\n") } }
    };
    entries.map(case).collect()
}

/// Runs the program in `folder`.
fn figures(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_figures"))
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::null())
        .output()
        .unwrap()
}

/// Checks that a run has failed with this code and message, printed nothing else, and left the folder as it was.
fn check(folder: &Path, before: usize, output: &Output, code: i32, message: &str, claim: &str) {
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(stderr.trim_end(), format!("error: {message}"), "{claim}");
    assert_eq!(output.status.code(), Some(code), "{claim}: {stderr}");
    assert!(output.stdout.is_empty(), "{claim}: nothing belongs on stdout");
    assert_eq!(fs::read_dir(folder).unwrap().count(), before, "{claim}: nothing is written");
}

/// Gives every input of a list to the program as the file `name`.
fn check_files(list: &'static str, name: &str, arguments: &[&str], at_least: usize) {
    let cases = cases(list);
    assert!(cases.len() >= at_least, "{} cases", cases.len());
    let folder = oracle::files::folder();
    for Case { claim, message, input } in cases {
        fs::write(folder.path().join(name), input).unwrap();
        check(folder.path(), 1, &figures(folder.path(), arguments), 1, message, claim);
    }
}

#[test]
fn a_bad_scene_is_refused_with_its_place_and_reason() {
    let arguments = ["render", "scene.toml", "--size", "8x6", "-o", "picture.ppm"];
    check_files(include_str!("bad/scenes.txt"), "scene.toml", &arguments, 40);
}

#[test]
fn a_bad_file_of_spheres_is_refused_with_its_line_and_reason() {
    let arguments = ["render", "atoms.xyz", "--size", "8x6", "-o", "picture.ppm"];
    check_files(include_str!("bad/xyz.txt"), "atoms.xyz", &arguments, 20);
}

#[test]
fn a_bad_mesh_is_refused_with_its_line_and_reason() {
    let arguments = ["render", "mesh.obj", "--size", "8x6", "-o", "picture.ppm"];
    check_files(include_str!("bad/obj.txt"), "mesh.obj", &arguments, 20);
}

#[test]
fn a_bad_image_is_refused_with_its_byte_and_reason() {
    let arguments = ["convert", "image.ppm", "picture.ppm"];
    check_files(include_str!("bad/ppm.txt"), "image.ppm", &arguments, 20);
}

#[test]
fn a_bad_command_line_is_refused_with_the_reason() {
    let cases = cases(include_str!("bad/commands.txt"));
    assert!(cases.len() >= 30, "{} cases", cases.len());
    let folder = oracle::files::folder();
    for Case { claim, message, .. } in cases {
        let arguments: Vec<&str> = claim.split(' ').collect();
        let output = figures(folder.path(), &arguments);
        let stderr = String::from_utf8_lossy(&output.stderr);
        let (code, message) = message.split_once(' ').unwrap();
        assert_eq!(stderr.lines().next(), Some(format!("error: {message}").as_str()), "{claim}");
        assert_eq!(output.status.code(), Some(code.parse().unwrap()), "{claim}: {stderr}");
        assert!(output.stdout.is_empty(), "{claim}: nothing belongs on stdout");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "{claim}: nothing is written");
    }
}
