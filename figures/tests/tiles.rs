//! Tiles, joined, are byte for byte the picture drawn in one go; anything else is refused by name.

mod program;

use std::fs;
use std::path::Path;
use std::process::Command;

use oracle::files::folder;
use program::stdout;

/// What merging these files says; nothing may be written.
fn refusal(folder: &Path, tiles: &[&str]) -> String {
    let said = program::refusal(folder, &[&["merge", "joined.ppm"], tiles].concat(), "", 1);
    assert!(!folder.join("joined.ppm").exists(), "{tiles:?}");
    said
}

fn draw(folder: &Path, figure: &str, tile: &str, out: &str, more: &[&str]) {
    stdout(folder, &[&[figure, "--size", "40x30", "--tile", tile, "-o", out, "--quiet"], more].concat());
}

#[test]
fn every_split_gives_the_bytes_of_the_single_run() {
    let folder = folder();
    let whole = stdout(folder.path(), &["3", "--size", "40x30", "-o", "-"]);
    for of in [1, 2, 3, 7, 30, 31] {
        let names: Vec<String> = (1..=of).rev().map(|number| format!("{number}-of-{of}.ppm")).collect();
        for (name, number) in names.iter().rev().zip(1..) {
            // Threads differ from tile to tile, and still the bytes are the same.
            let threads = if number % 2 == 0 { "1" } else { "3" };
            draw(folder.path(), "3", &format!("{number}/{of}"), name, &["--threads", threads]);
        }
        // With more tiles than rows, some have nothing to write, and nothing is missing without them.
        let names: Vec<&str> =
            names.iter().map(String::as_str).filter(|name| folder.path().join(name).exists()).collect();
        assert_eq!(names.len(), of.min(30), "{of} tiles");
        assert!(stdout(folder.path(), &[&["merge", "-"], &names[..]].concat()) == whole, "{of} tiles");
        assert!(
            stdout(folder.path(), &[&["merge", "-", "--format", "png"], &names[..]].concat()).starts_with(b"\x89PNG")
        );
    }
}

#[test]
fn deep_and_sampled_tiles_join_too() {
    let folder = folder();
    let more = ["--depth", "16", "--samples", "2"];
    let whole = stdout(folder.path(), &[&["6", "--size", "40x30", "-o", "-"], &more[..]].concat());
    for number in 1..=4 {
        draw(folder.path(), "6", &format!("{number}/4"), &format!("{number}.ppm"), &more);
    }
    assert!(stdout(folder.path(), &["merge", "-", "4.ppm", "2.ppm", "1.ppm", "3.ppm"]) == whole);
}

#[test]
fn a_tile_goes_to_its_own_file_by_default() {
    let folder = folder();
    stdout(folder.path(), &["1", "--size", "8x8", "--tile", "2/4"]);
    assert!(fs::read(folder.path().join("out/figure-1-2-of-4.ppm")).unwrap().starts_with(b"P6\n# figures "));
}

#[test]
fn gaps_overlaps_and_strangers_are_refused_by_name() {
    let folder = folder();
    let at = folder.path();
    for number in 1..=3 {
        draw(at, "3", &format!("{number}/3"), &format!("t{number}.ppm"), &[]);
    }
    draw(at, "3", "1/2", "half.ppm", &[]);
    draw(at, "2", "2/3", "other-scene.ppm", &[]);
    draw(at, "3", "2/3", "other-samples.ppm", &["--samples", "2"]);
    draw(at, "3", "2/3", "other-depth.ppm", &["--depth", "16"]);
    stdout(at, &["3", "--size", "44x30", "--tile", "2/3", "-o", "other-size.ppm", "--quiet"]);
    stdout(at, &["3", "--size", "40x30", "-o", "whole.ppm", "--quiet"]);
    fs::write(at.join("text.ppm"), "not a picture").unwrap();
    let cut = fs::read(at.join("t2.ppm")).unwrap();
    fs::write(at.join("cut.ppm"), &cut[..cut.len() / 2]).unwrap();
    let mut lie = cut.clone();
    let rows = lie.windows(6).position(|text| text == b"10..20").unwrap();
    lie[rows + 5] = b'1';
    fs::write(at.join("lie.ppm"), lie).unwrap();

    assert_eq!(refusal(at, &["t1.ppm", "t3.ppm"]), "error: rows 10..20 are missing\n");
    assert_eq!(refusal(at, &["t2.ppm", "t3.ppm"]), "error: rows 0..10 are missing\n");
    assert_eq!(refusal(at, &["t2.ppm", "t1.ppm"]), "error: rows 20..30 are missing\n");
    assert_eq!(
        refusal(at, &["t1.ppm", "t2.ppm", "t3.ppm", "t2.ppm"]),
        "error: rows 10..20 are in t2.ppm and in t2.ppm\n"
    );
    assert_eq!(refusal(at, &["t3.ppm", "t2.ppm", "half.ppm"]), "error: rows 10..15 are in half.ppm and in t2.ppm\n");
    for (stranger, what) in [
        ("other-scene.ppm", "scene"),
        ("other-samples.ppm", "samples 2, but 1"),
        ("other-depth.ppm", "maxval 65535, but 255"),
        ("other-size.ppm", "size 44x30, but 40x30"),
    ] {
        let said = refusal(at, &["t1.ppm", stranger, "t3.ppm"]);
        assert!(said.starts_with(&format!("error: {stranger}: a tile of another picture: {what}")), "{said}");
        assert!(said.ends_with(" in t1.ppm\n"), "{said}");
    }
    assert_eq!(
        refusal(at, &["t1.ppm", "whole.ppm"]),
        "error: whole.ppm: not a tile: no comment says which rows it has\n"
    );
    assert_eq!(
        refusal(at, &["t1.ppm", "lie.ppm", "t3.ppm"]),
        "error: lie.ppm: not a tile: its size is not what its comment says\n"
    );
    assert!(refusal(at, &["t1.ppm", "text.ppm"]).starts_with("error: text.ppm: byte 0: "));
    assert!(refusal(at, &["t1.ppm", "cut.ppm", "t3.ppm"]).contains("the file ends inside the raster"));
}

#[test]
fn gnu_parallel_draws_sixteen_tiles() {
    let folder = folder();
    if Command::new("parallel").arg("--version").output().is_err() {
        eprintln!("GNU parallel is not installed: not tried");
        return;
    }
    let program = env!("CARGO_BIN_EXE_figures");
    let line = format!("{program} 6 --size 64x48 --threads 1 --tile {{}}/16 -o t{{}}.ppm --quiet");
    let numbers: Vec<String> = (1..=16).map(|number| number.to_string()).collect();
    let status = Command::new("parallel")
        .args(["--will-cite", "-j2", &line, ":::"])
        .args(&numbers)
        .current_dir(folder.path())
        .env("HOME", folder.path())
        .status()
        .unwrap();
    assert!(status.success());
    let tiles: Vec<String> = numbers.iter().map(|number| format!("t{number}.ppm")).collect();
    let tiles: Vec<&str> = tiles.iter().map(String::as_str).collect();
    let joined = stdout(folder.path(), &[&["merge", "-"], &tiles[..]].concat());
    assert!(joined == stdout(folder.path(), &["6", "--size", "64x48", "-o", "-"]));
    if let Ok(netpbm) = Command::new("pnmcat").arg("-tb").args(&tiles).current_dir(folder.path()).output() {
        assert!(joined == netpbm.stdout, "pnmcat joins them alike");
    }
}
