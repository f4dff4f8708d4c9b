//! The running program: every command, what it writes and where, and what it says when it cannot.

mod program;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use oracle::files::{folder, names};
use program::{refusal, run, stdout};
use rt_io::ppm;
use serde_json::Value;

/// The scene file of a figure, as it lies in the sources.
fn scene(figure: u8) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/figure-{figure}.toml"))
}

/// Checks that a picture is the golden one of this name, or makes it that.
fn check_golden(name: &str, found: &[u8]) {
    let golden = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name);
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        fs::write(&golden, found).unwrap();
    }
    assert!(found == fs::read(&golden).unwrap(), "the picture differs from {}", golden.display());
}

#[test]
fn each_figure_is_its_golden_picture() {
    let folder = folder();
    for figure in 1..=6 {
        let found = stdout(folder.path(), &[&figure.to_string(), "--size", "64x48", "-o", "-"]);
        check_golden(&format!("figure-{figure}.ppm"), &found);
    }
}

#[test]
fn a_molecule_on_the_stage_is_its_golden_picture() {
    let folder = folder();
    fs::write(folder.path().join("a.pdb"), include_str!("../../tests/fuzz/seeds/pdb/ions.pdb")).unwrap();
    let arguments = ["render", "a.pdb", "--size", "64x48", "--format", "ppm", "-o", "-"];
    check_golden("stage.ppm", &stdout(folder.path(), &arguments));
}

#[test]
fn a_figure_is_its_scene_file() {
    let folder = folder();
    for figure in 1..=6 {
        let built_in = stdout(folder.path(), &[&figure.to_string(), "--size", "48x64", "-o", "-"]);
        let scene = scene(figure);
        let from_file = stdout(folder.path(), &["render", scene.to_str().unwrap(), "--size", "48x64", "-o", "a.ppm"]);
        let from_file = [from_file, fs::read(folder.path().join("a.ppm")).unwrap()].concat();
        assert!(built_in == from_file, "figure {figure}");
    }
}

#[test]
fn the_bytes_do_not_depend_on_threads() {
    let folder = folder();
    for figure in ["3", "6"] {
        let pictures = ["1", "2", "7"].map(|threads| {
            stdout(folder.path(), &[figure, "--size", "101x67", "--samples", "2", "--threads", threads, "-o", "-"])
        });
        assert!(pictures.iter().all(|picture| *picture == pictures[0]), "figure {figure}");
    }
}

#[test]
fn all_draws_six_pictures_into_the_named_folder() {
    let folder = folder();
    stdout(folder.path(), &["all", "--size", "16x12", "-o", "new/pictures", "--quiet"]);
    let expected: Vec<String> = (1..=6).map(|figure| format!("figure-{figure}.ppm")).collect();
    assert_eq!(names(&folder.path().join("new/pictures")), expected);
    for name in expected {
        let bytes = fs::read(folder.path().join("new/pictures").join(&name)).unwrap();
        assert!(bytes.starts_with(b"P6\n16 12\n255\n"), "{name}");
    }
}

#[test]
fn a_figure_goes_to_out_unless_told_otherwise() {
    let folder = folder();
    let output = run(folder.path(), &["4"], "");
    assert!(output.status.success());
    assert!(output.stdout.is_empty(), "nothing was asked for on stdout");
    assert!(String::from_utf8_lossy(&output.stderr).starts_with("out/figure-4.ppm: 1024 x 768 in "));
    let bytes = fs::read(folder.path().join("out/figure-4.ppm")).unwrap();
    assert!(bytes.starts_with(b"P6\n1024 768\n255\n"));
    assert_eq!(bytes.len(), 16 + 3 * 1024 * 768);
}

#[test]
fn without_an_argument_the_number_comes_from_stdin() {
    let folder = folder();
    for answer in ["4\n", "4", " 4 \n"] {
        let asked = run(folder.path(), &["--size", "16x12", "-o", "-"], answer);
        assert!(asked.status.success(), "{answer:?}");
        assert!(asked.stdout == stdout(folder.path(), &["4", "--size", "16x12", "-o", "-"]), "{answer:?}");
        assert!(asked.stderr.is_empty(), "only a terminal is asked");
    }
    for (answer, quoted) in [("", "\"\""), ("\n", "\"\""), ("7\n", "\"7\""), ("three\n", "\"three\"")] {
        let said = refusal(folder.path(), &[], answer, 2);
        assert_eq!(said, format!("error: expected the number of a figure, 1 to 6, or \"all\", found {quoted}\n"));
    }
    assert!(names(folder.path()).is_empty(), "a wrong answer draws nothing");
}

#[test]
fn the_help_states_formats_and_colors() {
    let text = String::from_utf8(stdout(folder().path(), &["--help"])).unwrap();
    assert!(text.contains(" .ppm or .png") && text.contains("no gamma"), "{text}");
}

#[test]
fn list_names_the_six_figures() {
    let text = String::from_utf8(stdout(folder().path(), &["list"])).unwrap();
    assert_eq!(text.lines().count(), 6);
    for (line, number) in text.lines().zip(1..) {
        assert!(line.starts_with(&format!("{number}  ")), "{line}");
    }
}

#[test]
fn the_format_follows_the_ending_unless_it_is_named() {
    let folder = folder();
    let magic = |arguments: &[&str], file: &str| {
        stdout(folder.path(), &[&["1", "--size", "8x6", "--quiet"], arguments].concat());
        fs::read(folder.path().join(file)).unwrap()[..2].to_vec()
    };
    assert_eq!(magic(&["-o", "a.ppm"], "a.ppm"), b"P6");
    assert_eq!(magic(&["-o", "a.png"], "a.png"), b"\x89P");
    assert_eq!(magic(&["-o", "a.PNG"], "a.PNG"), b"\x89P");
    // What follows these dots is no ending.
    assert_eq!(magic(&["-o", "run.1"], "run.1"), b"P6");
    assert_eq!(magic(&["-o", "v2.0-final"], "v2.0-final"), b"P6");
    assert_eq!(magic(&["-o", "no-ending"], "no-ending"), b"P6");
    assert_eq!(magic(&["-o", "a.jpg", "--format", "png"], "a.jpg"), b"\x89P");
    assert_eq!(magic(&["-o", "b.png", "--format", "ppm-plain"], "b.png"), b"P3");
    assert_eq!(magic(&["-o", ".", "--format", "png"], "figure-1.png"), b"\x89P");
    assert_eq!(magic(&["-o", "folder/"], "folder/figure-1.ppm"), b"P6");
}

#[test]
fn a_name_that_promises_what_is_not_written_is_refused_before_any_work() {
    let folder = folder();
    fs::write(folder.path().join("in.ppm"), b"P3 1 1 255 1 2 3").unwrap();
    let endings = [
        "jpg", "JPEG", "tif", "tiff", "gif", "bmp", "webp", "svg", "pdf", "exr", "hdr", "pgm", "pbm", "pnm", "pam",
        "jp2", "avif", "html", "md", "json", "toml", "xyz", "obj", "txt", "csv", "zip", "gz", "image", "7z",
    ];
    for ending in endings {
        let name = format!("a.{ending}");
        let expected = format!(
            "error: {name}: expected a name that ends in .ppm or .png, found .{}; --format writes any name\n",
            ending.to_ascii_lowercase()
        );
        // Neither the scene nor the images are read: they do not exist.
        for arguments in [
            &["1", "-o", &name][..],
            &["render", "no.toml", "-o", &name],
            &["1", "--tile", "1/2", "-o", &name],
            &["convert", "no.png", &name],
            &["merge", &name, "no.ppm"],
        ] {
            assert_eq!(refusal(folder.path(), arguments, "", 2), expected);
        }
        let expected = format!("error: {name}: expected a folder, found a name that ends in ");
        assert!(refusal(folder.path(), &["all", "-o", &name], "", 2).starts_with(&expected));
        stdout(folder.path(), &["convert", "in.ppm", &name, "--format", "ppm"]);
        assert_eq!(fs::read(folder.path().join(&name)).unwrap(), b"P6\n1 1\n255\n\x01\x02\x03");
        fs::remove_file(folder.path().join(&name)).unwrap();
    }
    for ending in ["ppm", "png", "jpg", "stl", "md"] {
        let name = format!("a.{ending}");
        for piece in [&["spheres", "packed"][..], &["sphereflake"], &["knot"]] {
            refusal(folder.path(), &[&["gen"], piece, &["-o", &name]].concat(), "", 2);
        }
        assert_eq!(
            refusal(folder.path(), &["all", "-o", &name], "", 2),
            format!(
                "error: {name}: expected a folder, found a name that ends in .{ending}; write {name}/ if it is to be a \
                 folder\n"
            )
        );
    }
    assert_eq!(names(folder.path()), ["in.ppm"]);

    // A slash says what is meant, and so does a folder that is there.
    for out in ["all.ppm/", "all.ppm"] {
        stdout(folder.path(), &["all", "--size", "8x6", "-o", out, "--quiet"]);
        assert_eq!(names(&folder.path().join("all.ppm")).len(), 6);
    }
}

#[test]
#[cfg(unix)]
fn no_message_steers_the_terminal() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let folder = folder();
    let name = "a\u{1b}[31m\u{9b}2J\r\n\u{7f}\u{202e}";
    let shown = r"a\u{1b}[31m\u{9b}2J\r\n\u{7f}\u{202e}";
    let path = |ending: &str| folder.path().join(format!("{name}.{ending}"));
    fs::write(path("toml"), "raduis = 1").unwrap();
    fs::write(path("obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 2\n").unwrap();
    fs::write(path("png"), [PNG_HEAD, HALF_RED, PNG_END].concat()).unwrap();
    let name = |ending: &str| format!("{name}.{ending}");
    for (arguments, expected) in [
        (vec!["render".to_owned(), name("toml")], format!("error: {shown}.toml:1:1: ")),
        (vec!["render".to_owned(), name("missing")], format!("error: cannot read {shown}.missing: ")),
        (
            vec!["render".to_owned(), name("obj"), "-o".to_owned(), "a.ppm".to_owned()],
            format!("warning: {shown}.obj: "),
        ),
        (vec!["convert".to_owned(), name("png"), "a.ppm".to_owned()], format!("warning: {shown}.png: ")),
        (vec!["4".to_owned(), "-o".to_owned(), name("ppm")], format!("{shown}.ppm: 1024 x 768 in ")),
        (vec!["4".to_owned(), "-o".to_owned(), name("jpg")], format!("error: {shown}.jpg: expected")),
        (vec![name("x")], "error: invalid value ".to_owned()),
        (vec!["--size".to_owned(), name("x")], "error: invalid value ".to_owned()),
    ] {
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let said = String::from_utf8(run(folder.path(), &arguments, "").stderr).unwrap();
        assert!(said.starts_with(&expected), "{arguments:?}: {said:?}");
        let steers = |c: char| (c.is_control() && c != '\n') || c == '\u{202e}';
        assert!(!said.contains(steers), "{arguments:?}: {said:?}");
    }
    let odd = Command::new(env!("CARGO_BIN_EXE_figures"))
        .args([OsStr::new("render"), OsStr::from_bytes(b"\xff\x1b[0m.toml")])
        .output()
        .unwrap();
    assert!(!odd.stderr.contains(&b'\x1b') && odd.status.code() == Some(1), "{odd:?}");
}

#[test]
fn raw_plain_and_png_hold_the_same_pixels() {
    let folder = folder();
    for depth in ["8", "16"] {
        let pictures = ["ppm", "ppm-plain", "png"].map(|format| {
            let bytes =
                stdout(folder.path(), &["6", "--size", "32x24", "--depth", depth, "--format", format, "-o", "-"]);
            rt_io::decode_image(&bytes, &rt_io::Limits::default()).unwrap().pixmap
        });
        assert_eq!(pictures[0].maxval(), if depth == "8" { 255 } else { 65535 });
        assert!(pictures.iter().all(|picture| *picture == pictures[0]), "{depth} bits");
    }
}

#[test]
fn sixteen_bits_hold_more_than_eight() {
    let folder = folder();
    let bytes = stdout(folder.path(), &["5", "--size", "32x24", "--depth", "16", "-o", "-"]);
    let fine = ppm::read_bytes(&bytes, &rt_io::Limits::default()).unwrap();
    let inner = fine.to_samples().iter().filter(|&&sample| sample % 257 != 0).count();
    assert!(inner > 100, "only {inner} samples lie between those of 8 bits");
}

#[test]
fn more_samples_give_the_mean_of_their_colors() {
    // A picture of twice the size has the four samples of each pixel as its pixels. Flat figures have colours k / 255
    // nowhere near rounding, so the mean can be checked to the last bit at 16 bits: each sample is off by 1/2 at most.
    let folder = folder();
    let read = |arguments: &[&str]| {
        let bytes = stdout(folder.path(), &[arguments, &["--depth", "16", "-o", "-"]].concat());
        ppm::read_bytes(&bytes, &rt_io::Limits::default()).unwrap()
    };
    let mean = read(&["2", "--size", "20x15", "--samples", "2"]);
    let single = read(&["2", "--size", "40x30"]);
    for (x, y) in (0..15).flat_map(|y| (0..20).map(move |x| (x, y))) {
        for channel in 0..3 {
            let four = [(0, 0), (1, 0), (0, 1), (1, 1)];
            let sum: u32 = four.iter().map(|(i, j)| u32::from(single.pixel(2 * x + i, 2 * y + j)[channel])).sum();
            let found = u32::from(mean.pixel(x, y)[channel]);
            assert!((4 * found).abs_diff(sum) <= 4, "pixel {x}, {y}: {found} is no quarter of {sum}");
        }
    }
}

#[test]
fn json_tells_what_was_done() {
    let folder = folder();
    let text = stdout(folder.path(), &["all", "--size", "16x12", "--samples", "2", "--json", "-o", "here/"]);
    let accounts: Vec<Value> =
        String::from_utf8(text).unwrap().lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(accounts.len(), 6);
    for (account, number) in accounts.iter().zip(1..) {
        assert_eq!(account["picture"], format!("here/figure-{number}.ppm"));
        assert_eq!(account["width"], 16);
        assert_eq!(account["height"], 12);
        assert_eq!(account["rays"], 16 * 12 * 4);
        let hits = account["hits"].as_u64().unwrap();
        assert!(0 < hits && hits < 16 * 12 * 4, "every figure has an object and a background: {hits}");
        for phase in ["load", "build", "trace", "write"] {
            assert!(account["seconds"][phase].as_f64().unwrap() >= 0.0, "{phase}");
        }
        if cfg!(target_os = "linux") {
            assert!(account["peak_memory_bytes"].as_u64().unwrap() > 1 << 20);
        }
    }
}

#[test]
fn hits_are_the_pixels_of_the_object() {
    let folder = folder();
    let bytes = stdout(folder.path(), &["1", "--size", "64x48", "-o", "-"]);
    let white = bytes[13..].chunks(3).filter(|pixel| *pixel == [255; 3]).count();
    let text = stdout(folder.path(), &["1", "--size", "64x48", "--json", "-o", "a.ppm"]);
    let account: Value = serde_json::from_slice(&text).unwrap();
    assert_eq!(account["hits"], white);
}

#[test]
fn the_trees_save_tests_in_figure_3() {
    let folder = folder();
    let text = String::from_utf8(stdout(folder.path(), &["tests", "3", "--size", "64x48"])).unwrap();
    assert!(text.starts_with("233 objects, 3072 rays"), "{text}");
    let row = |name: &str| -> (f64, f64) {
        let words = text.lines().find_map(|line| line.strip_prefix(name)).unwrap();
        let mut words = words.split_whitespace().map(|word| word.parse().unwrap());
        (words.next().unwrap(), words.next().unwrap())
    };
    assert_eq!(row("loop"), (0.0, 233.0));
    let [halves, sorted, bvh] = ["halves", "sorted", "bvh"].map(row);
    assert!(halves.0 + halves.1 < 233.0 / 4.0 && sorted.0 + sorted.1 < 233.0 / 6.0, "{text}");
    // In both a conservative test of its own lets few primitives pass to the kernels.
    assert!(bvh.0 < sorted.0 && bvh.1 <= sorted.1 && sorted.1 < 1.0, "{text}");
}

#[test]
fn every_tree_draws_the_same_bytes() {
    let folder = folder();
    for scene in ["3", "5", "6"] {
        let [first, others @ ..] = ["bvh", "loop", "halves", "sorted"]
            .map(|tree| stdout(folder.path(), &[scene, "--size", "48x36", "--tree", tree, "-o", "-"]));
        assert!(others.iter().all(|other| *other == first), "figure {scene}");
    }
}

#[test]
fn quiet_says_nothing() {
    let folder = folder();
    let output = run(folder.path(), &["3", "--size", "16x12", "--quiet"], "");
    assert!(output.status.success() && output.stdout.is_empty() && output.stderr.is_empty());
}

#[test]
fn convert_gives_netpbms_bytes() {
    let folder = folder();
    let texture = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/earth-natural-720x360.png");
    let found = stdout(folder.path(), &["convert", texture.to_str().unwrap(), "-"]);
    let Ok(netpbm) = Command::new("pngtopnm").arg(&texture).output() else {
        eprintln!("pngtopnm is not installed: not compared with it");
        return;
    };
    assert!(found == netpbm.stdout);
}

#[test]
fn convert_keeps_the_depth_unless_told_otherwise() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    fs::write(path("deep.ppm"), b"P3 2 1 65535  0 257 65535  514 1 128").unwrap();
    stdout(folder.path(), &["convert", "deep.ppm", "kept.ppm"]);
    stdout(folder.path(), &["convert", "deep.ppm", "eight.ppm", "--depth", "8", "--format", "ppm-plain"]);
    stdout(folder.path(), &["convert", "eight.ppm", "back.ppm", "--depth", "16", "--format", "ppm-plain"]);
    let kept = fs::read(path("kept.ppm")).unwrap();
    assert_eq!(kept, b"P6\n2 1\n65535\n\x00\x00\x01\x01\xff\xff\x02\x02\x00\x01\x00\x80");
    let pixels = |name: &str| ppm::read_bytes(&fs::read(path(name)).unwrap(), &rt_io::Limits::default()).unwrap();
    assert_eq!(pixels("eight.ppm").to_samples(), [0, 1, 255, 2, 0, 0]);
    assert_eq!(pixels("back.ppm").to_samples(), [0, 257, 65535, 514, 0, 0]);
}

#[test]
fn convert_makes_grey_rgb_and_warns_of_transparency() {
    let folder = folder();
    fs::write(folder.path().join("grey.pgm"), b"P2 2 1 255  7 200").unwrap();
    stdout(folder.path(), &["convert", "grey.pgm", "grey.ppm"]);
    assert_eq!(fs::read(folder.path().join("grey.ppm")).unwrap(), b"P6\n2 1\n255\n\x07\x07\x07\xc8\xc8\xc8");

    let png = |alpha_data: &[u8]| [PNG_HEAD, alpha_data, PNG_END].concat();
    fs::write(folder.path().join("glass.png"), png(HALF_RED)).unwrap();
    fs::write(folder.path().join("paint.png"), png(OPAQUE_RED)).unwrap();
    for (name, warning) in [("glass", "warning: glass.png: transparency was dropped\n"), ("paint", "")] {
        let output = run(folder.path(), &["convert", &format!("{name}.png"), &format!("{name}.ppm")], "");
        assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
        assert_eq!(String::from_utf8_lossy(&output.stderr), warning, "{name}");
        let ppm = fs::read(folder.path().join(format!("{name}.ppm"))).unwrap();
        assert_eq!(ppm, b"P6\n1 1\n255\n\xff\x00\x00", "{name}");
    }
}

/// The signature and header of a PNG of one pixel with alpha.
const PNG_HEAD: &[u8] = b"\x89\x50\x4e\x47\x0d\x0a\x1a\x0a\x00\x00\x00\x0d\x49\x48\x44\x52\x00\x00\x00\x01\x00\x00\x00\x01\x08\x06\x00\x00\x00\x1f\x15\xc4\x89";
/// Its pixel: red, half transparent.
const HALF_RED: &[u8] =
    b"\x00\x00\x00\x0d\x49\x44\x41\x54\x78\x9c\x63\xf8\xcf\xc0\xd0\x00\x00\x04\x81\x01\x80\x2c\x55\xce\xb0";
/// Its pixel: red, opaque.
const OPAQUE_RED: &[u8] =
    b"\x00\x00\x00\x0d\x49\x44\x41\x54\x78\x9c\x63\xf8\xcf\xc0\xf0\x1f\x00\x05\x00\x01\xff\x89\x99\x3d\x1d";
/// The end of a PNG.
const PNG_END: &[u8] = b"\x00\x00\x00\x00\x49\x45\x4e\x44\xae\x42\x60\x82";

#[test]
fn a_user_error_is_told_with_its_place() {
    let folder = folder();
    let text = "[material.m]\ncolor = [1, 1, 1]\n[[sphere]]\nraduis = 1\n";
    fs::write(folder.path().join("my.toml"), text).unwrap();
    assert_eq!(
        refusal(folder.path(), &["render", "my.toml"], "", 1),
        "error: my.toml:4:1: unknown field \"raduis\", expected one of \"center\", \"radius\", \"material\"\n"
    );
    assert!(!folder.path().join("out").exists(), "nothing is made before the scene is read");
}

#[test]
fn what_cannot_be_written_is_told() {
    let folder = folder();
    let said = |out: &str| refusal(folder.path(), &["1", "--size", "8x6", "-o", out], "", 1);
    fs::write(folder.path().join("file"), "").unwrap();
    assert_eq!(
        said("no/such/folder.ppm"),
        "error: no/such/folder.ppm: the folder no/such does not exist; create it first\n"
    );
    assert!(said("file/").starts_with("error: cannot make folder file/: "));
    if cfg!(target_os = "linux") {
        assert!(said("/dev/full").contains("No space left"));
        assert!(said("/proc/figure.ppm").starts_with("error: /proc/figure.ppm: "));
    }
}

#[test]
fn a_closed_pipe_ends_quietly() {
    let folder = folder();
    let mut child = Command::new(env!("CARGO_BIN_EXE_figures"))
        .args(["1", "-o", "-"])
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{:?}", output.status);
    assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn a_slip_is_answered_with_what_was_meant() {
    let folder = folder();
    fs::write(folder.path().join("my file"), "").unwrap();
    for (word, meant) in [
        ("a.xyz", "render a.xyz"),
        ("m.pdb.gz", "render m.pdb.gz"),
        ("my file", "render 'my file'"),
        ("rendr", "render"),
    ] {
        let expected = format!("error: invalid value '{word}' for '[FIGURE]': did you mean `figures {meant}`?\n");
        for more in [&[][..], &["m.pdb"], &["-o", "m.png"]] {
            let said = refusal(folder.path(), &[&[word], more].concat(), "", 2);
            assert!(said.starts_with(&expected), "{said}");
        }
    }
    let help = String::from_utf8(stdout(folder.path(), &["help", "render"])).unwrap();
    assert!(help.contains("--view") && help.contains("figures render molecule.pdb -o molecule.png"), "{help}");
}

#[test]
fn completions_and_the_man_page_know_the_commands() {
    let folder = folder();
    let text = |arguments: &[&str]| String::from_utf8(stdout(folder.path(), arguments)).unwrap();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = text(&["completions", shell]);
        assert!(script.contains("render") && script.contains("radius-scale"), "{shell}: {script}");
    }
    let page = text(&["man"]);
    assert!(page.starts_with(".ie") && page.contains("figures\\-render(1)"), "{page}");
}
