//! The hostile corpus in `tests/corpus/` is what the generators and the oracle make.

use std::path::Path;
use std::process::Command;

use oracle::files::{files, folder};

#[test]
fn the_stored_corpus_is_what_is_made() {
    let folder = folder();
    let path = folder.path().to_str().expect("a plain path");
    let made = Command::new(env!("CARGO_BIN_EXE_report")).args(["--corpus", "--out", path]).status();
    assert!(made.expect("the program starts").success());
    let (made, stored) =
        (files(folder.path()), files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/corpus")));
    assert_eq!(made.len(), 7, "a file for each kernel, and the scores");
    for (name, bytes) in made {
        assert!(
            stored.get(&name) == Some(&bytes),
            "tests/corpus/{name} differs: cargo run --release -p report -- --corpus --out tests/corpus"
        );
    }
}

#[test]
fn more_rows_begin_with_the_same() {
    let rows = |count: &str| {
        let folder = folder();
        let path = folder.path().to_str().expect("a plain path");
        let made = Command::new(env!("CARGO_BIN_EXE_report")).args(["--corpus", count, "--out", path]).status();
        assert!(made.expect("the program starts").success());
        String::from_utf8(files(folder.path()).remove("ray_sphere.txt").expect("a kernel's file")).expect("text")
    };
    let (few, more) = (rows("1"), rows("3"));
    assert!(few.lines().count() < more.lines().count() && few.lines().all(|line| more.contains(line)));
}
