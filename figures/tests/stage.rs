//! What is drawn without a scene file, or on the stage: seen from a chosen side, before a chosen background or none, in a
//! chosen frame.

mod program;

use std::fs;

use oracle::files::{folder, names};
use program::{refusal, run, stdout};
use rt_io::ppm;
use serde_json::Value;

/// A light that shows on one side, and a ball for each axis: red at +x, green at +y, blue at +z.
const AXES: &str = "stage = true\nbackground = [1, 1, 1]\n\
    [material]\nr = { color = [1, 0, 0] }\ng = { color = [0, 1, 0] }\nb = { color = [0, 0, 1] }\n\
    [[sphere]]\ncenter = [9, 0, 0]\nradius = 2\nmaterial = \"r\"\n\
    [[sphere]]\ncenter = [0, 9, 0]\nradius = 2\nmaterial = \"g\"\n\
    [[sphere]]\ncenter = [0, 0, 9]\nradius = 2\nmaterial = \"b\"\n";

/// The middle of the pixels in which a channel is the largest, to the right and down from the middle of the picture.
fn spot(picture: &rt_io::Pixmap, channel: usize) -> (f64, f64) {
    let (mut sum, mut count) = ((0.0, 0.0), 0.0);
    for (x, y) in (0..picture.height()).flat_map(|y| (0..picture.width()).map(move |x| (x, y))) {
        let pixel = picture.pixel(x, y);
        if (0..3).all(|other| other == channel || pixel[other] < pixel[channel]) {
            sum = (sum.0 + x as f64, sum.1 + y as f64);
            count += 1.0;
        }
    }
    (sum.0 / count - picture.width() as f64 / 2.0, sum.1 / count - picture.height() as f64 / 2.0)
}

#[test]
fn a_view_turns_what_lies_on_the_stage() {
    let folder = folder();
    fs::write(folder.path().join("axes.toml"), AXES).unwrap();
    let seen = |view: &str| {
        let bytes = stdout(folder.path(), &["render", "axes.toml", "--view", view, "--size", "90x90", "-o", "-"]);
        let picture = rt_io::decode_image(&bytes, &rt_io::Limits::default()).unwrap().pixmap;
        assert_eq!(picture.pixel(0, 0), [255; 3], "the scene's own background");
        [0, 1, 2].map(|channel| spot(&picture, channel))
    };
    let [_, green, blue] = seen("x");
    assert!(green.0 > 10.0 && blue.1 < -10.0, "{green:?} {blue:?}");
    let [red, _, blue] = seen("y");
    assert!(red.0 < -10.0 && blue.1 < -10.0, "{red:?} {blue:?}");
    let [red, green, _] = seen("z");
    assert!(red.0 > 10.0 && green.1 < -10.0, "{red:?} {green:?}");
    // A little to the right of +x, -y is nearer.
    assert_ne!(seen("0,0"), seen("-20,10"));
    assert_eq!(seen("x"), seen("0,0"));

    let own = AXES.replace("stage = true\n", "") + "[camera]\nfit = true\n";
    fs::write(folder.path().join("own.toml"), &own).unwrap();
    assert_eq!(
        refusal(folder.path(), &["render", "own.toml", "--view", "x"], "", 1),
        "error: own.toml:18:1: the scene has a camera of its own; --view is for files, and scenes with stage = true\n"
    );
    for (more, what) in [("[camera]\nfov = 20\n", "[camera]"), ("[[light]]\nposition = [0, 0, 1]\n", "[[light]]")] {
        fs::write(folder.path().join("both.toml"), AXES.to_owned() + more).unwrap();
        let message = format!(
            "error: both.toml:19:1: the scene is on the stage (stage = true), which has its own; remove the {what} or the \
             stage\n"
        );
        assert_eq!(refusal(folder.path(), &["render", "both.toml"], "", 1), message);
    }
}

#[test]
fn the_stage_is_that_of_a_bare_file() {
    let folder = folder();
    fs::write(folder.path().join("a.xyz"), "2\n\nC 0 0 0\nO 3 1 0\n").unwrap();
    fs::write(folder.path().join("a.toml"), "stage = true\n[[spheres]]\nfile = \"a.xyz\"\n").unwrap();
    let draw = |name: &str| stdout(folder.path(), &["render", name, "--view", "iso", "--size", "64x48", "-o", "-"]);
    let picture = draw("a.xyz");
    assert!(picture.starts_with(b"\x89PNG"), "PNG unless told otherwise");
    assert!(draw("a.toml") == picture);
}

#[test]
fn a_light_turns_with_the_camera() {
    let folder = folder();
    let scene = |eye: &str, light: &str| {
        let text = format!(
            "[camera]\neye = {eye}\nlook_at = [0, 0, 0]\nfit = true\nfov = 20\n[[light]]\n{light}\n\
             [material.m]\ncolor = [1, 1, 1]\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 2\nmaterial = \"m\"\n"
        );
        fs::write(folder.path().join("a.toml"), text).unwrap();
        stdout(folder.path(), &["render", "a.toml", "--format", "ppm", "--size", "40x40", "-o", "-"])
    };
    // Half of the box around the ball is 2 times the root of 3: the light is seen at the same place from both sides.
    let front = scene("[0, 0, 9]", "camera = [0, 2, 1]");
    assert!(front == scene("[9, 0, 0]", "camera = [0, 2, 1]"));
    let radius = 12_f64.sqrt();
    assert!(front == scene("[0, 0, 9]", &format!("position = [0, {}, {radius}]", 2.0 * radius)));
    assert!(front != scene("[9, 0, 0]", &format!("position = [0, {}, {radius}]", 2.0 * radius)));
}

#[test]
fn a_background_of_none_is_transparent() {
    let folder = folder();
    fs::write(folder.path().join("axes.toml"), AXES).unwrap();
    let draw_to = |out: &str, background: &str, more: &[&str]| {
        let first = ["render", "axes.toml", "--size", "31x23", "--samples", "3", "--background", background, "-o", out];
        stdout(folder.path(), &[&first[..], more].concat())
    };
    let draw = |background: &str, more: &[&str]| draw_to("-", background, more);
    let read = |bytes: Vec<u8>| {
        rt_io::png::read_rgba(std::io::Cursor::new(bytes), &rt_io::Limits::default()).unwrap().0.samples
    };
    for depth in ["8", "16"] {
        let clear = read(draw("none", &["--depth", depth]));
        let [black, white] = ["black", "white"].map(|color| {
            let bytes = draw(color, &["--depth", depth, "--format", "ppm"]);
            ppm::read_bytes(&bytes, &rt_io::Limits::default()).unwrap()
        });
        let full = f64::from(black.maxval());
        let mut partly = 0;
        for (at, pixel) in clear.chunks_exact(4).enumerate() {
            let [red, green, blue, alpha] = pixel.try_into().unwrap();
            let (x, y) = (at % 31, at / 31);
            // A ninth of the samples each.
            let ninths = f64::from(alpha) / full * 9.0;
            assert!((ninths - ninths.round()).abs() <= 4.5 / full, "{alpha}");
            partly += usize::from(alpha != 0 && f64::from(alpha) < full);
            for (channel, color) in [red, green, blue].into_iter().enumerate() {
                assert!(alpha > 0 || color == 0);
                // Put over a background it is the picture with that background: three samples are rounded.
                let share = ninths.round() / 9.0;
                for (picture, behind) in [(&black, 0.0), (&white, full)] {
                    let expected = share * f64::from(color) + (1.0 - share) * behind;
                    let found = f64::from(picture.pixel(x, y)[channel]);
                    assert!((found - expected).abs() <= 0.5 + 0.5 * share + 1e-9, "{x} {y}: {found} {expected}");
                }
            }
        }
        assert!(partly > 20, "{partly} pixels on an edge");
    }
    // On an edge too the colour is that of the samples that hit, to the byte.
    let ball =
        "[[sphere]]\ncenter = [0, 0, -3]\nradius = 1\nmaterial = \"m\"\n[material.m]\ncolor = [0.25, 0.5, 0.75]\n";
    fs::write(folder.path().join("ball.toml"), ball).unwrap();
    let arguments = ["render", "ball.toml", "--size", "31x23", "--samples", "5", "--background", "none", "-o", "-"];
    let pixels = read(stdout(folder.path(), &arguments));
    let (hit, missed): (Vec<_>, Vec<_>) = pixels.chunks_exact(4).partition(|pixel| pixel[3] > 0);
    assert!(hit.iter().all(|pixel| pixel[..3] == [64, 128, 191]) && missed.iter().all(|pixel| **pixel == [0; 4]));
    let shares: Vec<u16> = hit.iter().map(|pixel| pixel[3]).collect();
    assert!(shares.iter().all(|&alpha| (0..=25).any(|n| (510 * n + 25) / 50 == alpha)), "{shares:?}");
    assert_eq!(draw("#ffffff", &[]), draw("1,1,1", &[]));
    // Bands carry it, and so does what they are joined to.
    for band in ["1/3", "2/3", "3/3"] {
        draw_to(&format!("band-{}.png", &band[..1]), "none", &["--tile", band]);
    }
    let bands = ["band-3.png", "band-1.png", "band-2.png"];
    let joined = stdout(folder.path(), &[&["merge", "-"], &bands[..]].concat());
    assert!(joined == draw("none", &[]));
    let no_alpha = "error: a picture without a background is a PNG; PPM has no transparency\n";
    assert_eq!(refusal(folder.path(), &[&["merge", "a.ppm"], &bands[..]].concat(), "", 2), no_alpha);
    assert_eq!(
        refusal(folder.path(), &["render", "axes.toml", "--background", "none", "-o", "a.ppm"], "", 2),
        no_alpha
    );
    let missing = refusal(folder.path(), &["merge", "a.png", "band-1.png", "band-3.png"], "", 1);
    assert_eq!(missing, "error: rows 7..15 are missing\n");
}

#[test]
fn several_files_are_drawn_each_into_its_own_picture() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    let atom = format!("{:30}{:8.3}{:8.3}{:8.3}\n", "ATOM      1  CA  GLY A   1", 1.0, 2.0, 3.0);
    fs::write(path("a.pdb"), &atom).unwrap();
    fs::write(path("b.xyz"), "1\n\nC 0 0 0\n1\n\nO 1 0 0\n").unwrap();
    let output = run(folder.path(), &["render", "a.pdb", "b.xyz", "--size", "8x6", "-o", "new/"], "");
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(names(&path("new")), ["a.png", "b.png"], "{said}");
    assert!(said.contains("note: b.xyz: frame 1 is drawn; another one follows in line 4 (--frame)\n"), "{said}");
    // From stdin, whatever it is.
    let from_stdin = run(folder.path(), &["render", "-", "--size", "8x6", "-o", "-"], &atom);
    assert_eq!(from_stdin.stdout, fs::read(path("new/a.png")).unwrap());
    let scene = run(folder.path(), &["render", "-", "--size", "8x6", "--quiet"], AXES);
    assert!(scene.status.success() && path("out/stdin.png").is_file(), "{scene:?}");
    // Another frame, and larger balls.
    let draw =
        |more: &[&str]| stdout(folder.path(), &[&["render", "b.xyz", "--size", "8x6", "-o", "-"], more].concat());
    assert_ne!(draw(&[]), draw(&["--frame", "2"]));
    assert_eq!(
        refusal(folder.path(), &["render", "b.xyz", "--frame", "3"], "", 1),
        "error: b.xyz:7: there is no frame 3; the file has 2\n"
    );
    let hits = |factor: &str| {
        fs::write(path("two.xyz"), "2\n\nC 0 0 0\nC 9 0 0\n").unwrap();
        let arguments = ["render", "two.xyz", "--radius-scale", factor, "--size", "64x48", "--json", "-o", "two.png"];
        let account: Value = serde_json::from_slice(&stdout(folder.path(), &arguments)).unwrap();
        account["hits"].as_u64().unwrap()
    };
    assert!(hits("2") > 2 * hits("1"), "{} {}", hits("2"), hits("1"));
    let said = refusal(folder.path(), &["render", "two.xyz", "--radius-scale", "1.5e308"], "", 2);
    assert_eq!(said, "error: no radius is finite if it is multiplied by 1.5e308\n");
}
