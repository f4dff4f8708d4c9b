//! netpbm and libjpeg-turbo agree: written files are its files byte for byte, and what it converts has the pixels that
//! we decode.
//!
//! Each test says so and passes where they are not installed.
#![cfg(feature = "decode")]

mod pictures;

use std::io::Write;
use std::process::{Command, Stdio};

use pictures::{encode, pixmaps};
use proptest::prelude::*;
use rt_io::ppm::{self, Encoding};
use rt_io::{Limits, Pixmap, decode_image, png};

/// Runs a tool of netpbm or libjpeg-turbo, `None` if it is not installed.
fn netpbm(command: &str, input: &[u8]) -> Option<Vec<u8>> {
    let mut words = command.split_whitespace();
    let tool = words.next().unwrap();
    let spawned =
        Command::new(tool).args(words).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
    let mut child = match spawned {
        Ok(child) => child,
        Err(error) => {
            assert_eq!(error.kind(), std::io::ErrorKind::NotFound, "{command}");
            eprintln!("SKIPPED: {tool} is not installed");
            return None;
        }
    };
    let mut stdin = child.stdin.take().unwrap();
    let input = input.to_vec();
    // A tool that fails early closes its end; the status below tells.
    let feed = std::thread::spawn(move || drop(stdin.write_all(&input)));
    let output = child.wait_with_output().unwrap();
    feed.join().unwrap();
    assert!(output.status.success(), "{command}: {}", String::from_utf8_lossy(&output.stderr));
    Some(output.stdout)
}

/// A picture with soft gradients, flat parts and hard edges, in colour or grey.
fn picture(width: usize, height: usize, maxval: u16, grey: bool) -> Pixmap {
    let most = u64::from(maxval);
    let samples = (0..width * height)
        .flat_map(|index| {
            let (x, y) = ((index % width) as u64, (index / width) as u64);
            let red = x * most / (width as u64 - 1).max(1);
            let green = y * most / (height as u64 - 1).max(1);
            let blue = if (x / 5 + y / 3) % 2 == 0 { most } else { (x * y) % (most + 1) };
            if grey { [green ^ red & most; 3].map(|v| v.min(most)) } else { [red, green, blue] }
        })
        .map(|v| u16::try_from(v).unwrap())
        .collect();
    Pixmap::new(width, height, maxval, samples).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn written_files_are_those_of_pnmtopnm(pixmap in pixmaps(40, 6)) {
        let raw = encode(&pixmap, Encoding::Raw);
        let plain = encode(&pixmap, Encoding::Plain);
        for input in [&raw, &plain] {
            if let Some(found) = netpbm("pnmtopnm", input) {
                prop_assert_eq!(&found, &raw);
            }
            if let Some(found) = netpbm("pnmtopnm -plain", input) {
                prop_assert_eq!(String::from_utf8(found), String::from_utf8(plain.clone()));
            }
        }
    }

    #[test]
    fn scaling_is_that_of_pamdepth(pixmap in pixmaps(40, 6), to in prop_oneof![Just(255), Just(65535), 1..=65535_u16]) {
        let raw = encode(&pixmap, Encoding::Raw);
        if let Some(expected) = netpbm(&format!("pamdepth {to}"), &raw) {
            prop_assert_eq!(encode(&pixmap.scaled(to), Encoding::Raw), expected);
        }
    }

    #[test]
    fn written_png_files_are_read_back_by_pngtopnm(pixmap in pixmaps(40, 6)) {
        let mut bytes = Vec::new();
        png::write(&pixmap, &mut bytes).unwrap();
        if let Some(found) = netpbm("pngtopnm", &bytes) {
            let found = ppm::read_bytes(&found, &Limits::default()).unwrap();
            let maxval = if pixmap.maxval() <= 255 { 255 } else { 65535 };
            prop_assert_eq!(found.scaled(maxval), pixmap.scaled(maxval));
        }
    }
}

/// Encodes by `encoder`, and compares what we decode with what `decoder` does.
fn assert_same_pixels(pixmap: &Pixmap, grey: bool, encoder: &str, decoder: &str, most_apart: u16) {
    let mut input = encode(pixmap, Encoding::Raw);
    if grey {
        let Some(pgm) = netpbm("ppmtopgm", &input) else { return };
        input = pgm;
    }
    if encoder.contains("-g3") || encoder.contains("-g4") || encoder.contains("bits1") {
        let Some(pbm) = netpbm("pamditherbw -threshold", &input).and_then(|pam| netpbm("pamtopnm", &pam)) else {
            return;
        };
        input = pbm;
    }
    let encoder = encoder.trim_end_matches(" bits1");
    let Some(file) = netpbm(encoder, &input) else { return };
    let Some(expected) = netpbm(decoder, &file) else { return };
    let ours = decode_image(&file, &Limits::default()).unwrap_or_else(|error| panic!("{encoder}: {error:?}"));
    let expected = match &expected[..2] {
        b"P4" => netpbm("pamdepth 255", &expected).unwrap(),
        _ => expected,
    };
    let expected = ppm::read_bytes(&expected, &Limits::default()).unwrap();
    let (maxval, size) = (ours.pixmap.maxval(), (ours.pixmap.width(), ours.pixmap.height()));
    assert_eq!(size, (expected.width(), expected.height()), "{encoder}");
    let apart = ours.pixmap.to_samples().into_iter().zip(expected.scaled(maxval).to_samples());
    let apart = apart.map(|(ours, theirs)| ours.abs_diff(theirs)).max().unwrap();
    assert!(apart <= most_apart, "{encoder}: samples differ by {apart} of {maxval}");
}

#[test]
fn png_has_the_pixels_of_pngtopnm() {
    for maxval in [1, 3, 15, 255, 65535] {
        for grey in [false, true] {
            for options in ["", "-interlace", "-force", "-compression=0", "-transparent=black"] {
                assert_same_pixels(&picture(37, 23, maxval, grey), grey, &format!("pnmtopng {options}"), "pngtopnm", 0);
            }
        }
    }
    // Few colours: a palette, of one to eight bits.
    for colors in [2, 4, 16, 200] {
        let all = picture(colors, 1, 255, false);
        let samples = (0..40 * 9).flat_map(|index| all.pixel(index * 7 % colors, 0)).collect();
        assert_same_pixels(&Pixmap::new(40, 9, 255, samples).unwrap(), false, "pnmtopng", "pngtopnm", 0);
    }
}

#[test]
fn tiff_has_the_pixels_of_tifftopnm() {
    for maxval in [255, 65535] {
        for grey in [false, true] {
            for options in [
                "-none -truecolor",
                "-lzw -truecolor",
                "-flate -truecolor",
                "-adobeflate -truecolor",
                "-packbits -truecolor",
                "-lzw -predictor=2 -truecolor",
                "-lzw -rowsperstrip=5 -truecolor",
                "-minisblack",
                "-miniswhite",
            ] {
                if options.starts_with("-minis") && !grey {
                    continue;
                }
                let options = if grey { options.trim_end_matches(" -truecolor") } else { options };
                assert_same_pixels(
                    &picture(37, 23, maxval, grey),
                    grey,
                    &format!("pamtotiff {options}"),
                    // Its default goes through 8 bits.
                    "tifftopnm -byrow",
                    0,
                );
            }
        }
    }
    // A palette of 8-bit indices.
    let samples = (0..40 * 9).flat_map(|index| picture(16, 13, 255, false).pixel(index % 16, index % 13)).collect();
    let palette = Pixmap::new(40, 9, 255, samples).unwrap();
    for options in ["-none", "-lzw", "-flate -predictor=2", "-packbits"] {
        assert_same_pixels(&palette, false, &format!("pamtotiff -color {options}"), "tifftopnm", 0);
    }
    for options in ["-none", "-g4", "-lzw", "-packbits", "-none -miniswhite", "-none -minisblack"] {
        assert_same_pixels(&picture(37, 23, 255, true), true, &format!("pamtotiff {options} bits1"), "tifftopnm", 0);
    }
}

/// Whether the library behind the tools is the one that we are measured against; others fill up chroma in another way.
fn has_libjpeg_turbo() -> bool {
    let version = Command::new("djpeg").arg("-version").output();
    let found = version.is_ok_and(|output| String::from_utf8_lossy(&output.stderr).contains("libjpeg-turbo"));
    if !found {
        eprintln!("SKIPPED: no djpeg of libjpeg-turbo");
    }
    found
}

/// What differs at most from `djpeg`, of 255, where all components have the same size, and where some are halved.
const WHOLE: u16 = 3;
const HALVED: u16 = 4;

#[test]
fn jpeg_is_near_to_djpeg() {
    if !has_libjpeg_turbo() {
        return;
    }
    let codings = ["", "-progressive", "-optimize", "-restart 1B", "-progressive -restart 2", "-rgb", "-baseline"];
    for (width, height) in [(1, 1), (8, 8), (17, 13), (33, 65), (3, 2), (2, 3), (64, 48)] {
        // The last column and row of halved chroma, and few columns, are filled up in another way.
        let alike = |length: usize| length % 2 == 1 || length.is_multiple_of(16);
        let halved = if width > 4 && alike(width) && alike(height) { HALVED } else { 255 };
        for coding in codings {
            for quality in [1, 30, 100] {
                let samplings = [("1x1", WHOLE), ("2x1", halved), ("1x2", halved), ("2x2", halved)];
                for (sample, most) in samplings {
                    let encoder = format!("cjpeg -quality {quality} -sample {sample} {coding}");
                    assert_same_pixels(&picture(width, height, 255, false), false, &encoder, "djpeg -pnm", most);
                }
                if coding != "-rgb" {
                    let encoder = format!("cjpeg -quality {quality} {coding}");
                    assert_same_pixels(&picture(width, height, 255, true), true, &encoder, "djpeg -pnm", WHOLE);
                }
            }
        }
    }
}

/// All that libjpeg can write: whole ratios, at most ten blocks a unit. What the decoder gets wrong is among the
/// refused.
#[test]
fn jpeg_of_every_sampling_is_near_to_djpeg_or_refused() {
    if !has_libjpeg_turbo() {
        return;
    }
    let picture = picture(37, 41, 255, false);
    let factors: Vec<(usize, usize)> = (1..=4).flat_map(|x| (1..=4).map(move |y| (x, y))).collect();
    let (mut count, mut read) = (0, 0);
    for number in 0..16 * 16 * 16 {
        let all = [number / 256, number / 16 % 16, number % 16].map(|index: usize| factors[index]);
        let most = |factors: [usize; 3]| factors.into_iter().fold(0, usize::max);
        let (across, down) = (most(all.map(|(x, _)| x)), most(all.map(|(_, y)| y)));
        let whole = all.iter().all(|(x, y)| across % x == 0 && down % y == 0);
        if !whole || all.iter().map(|(x, y)| x * y).sum::<usize>() > 10 {
            continue;
        }
        count += 1;
        let sample = all.map(|(x, y)| format!("{x}x{y}")).join(",");
        for coding in ["", "-progressive", "-restart 1"] {
            let encoder = format!("cjpeg -quality 95 -sample {sample} {coding}");
            if (across, down) == all[0] && across <= 2 && down <= 2 {
                read += 1;
                assert_same_pixels(&picture, false, &encoder, "djpeg -pnm", HALVED);
            } else {
                let Some(file) = netpbm(&encoder, &encode(&picture, Encoding::Raw)) else { return };
                let error = decode_image(&file, &Limits::default()).expect_err(&encoder);
                let expected = format!("JPEG with sampling {sample} is not read;");
                assert!(error.to_string().starts_with(&expected), "{encoder}: {error}");
            }
        }
    }
    assert_eq!((count, read), (311, 3 * 24));
}

/// Bytes that a scan lacks at its end are missed, whatever follows it, unless they make no difference.
#[test]
fn a_jpeg_with_a_shortened_scan_is_refused() {
    let picture = picture(65, 49, 255, false);
    for encoder in ["cjpeg -quality 90", "cjpeg -quality 90 -restart 3B", "cjpeg -quality 90 -progressive"] {
        let Some(file) = netpbm(encoder, &encode(&picture, Encoding::Raw)) else { return };
        let whole = decode_image(&file, &Limits::default()).unwrap();
        let mut refused = 0;
        let first = file.windows(2).position(|pair| pair == [0xff, 0xda]).unwrap() + 2;
        for end in first..file.len() - 1 {
            if file[end] != 0xff || file[end + 1] == 0 || file[end + 1] == 0xda {
                continue;
            }
            for missing in 1..=12 {
                let cut = [&file[..end - missing], &file[end..]].concat();
                match decode_image(&cut, &Limits::default()) {
                    Ok(decoded) => assert!(decoded == whole, "{encoder}: {missing} bytes before {end}"),
                    Err(_) => refused += 1,
                }
            }
        }
        assert!(refused > 10, "{encoder}: {refused}");
    }
}

/// The densest files that there are, of one colour, are not taken for broken ones.
#[test]
fn the_bound_on_pixels_per_byte_refuses_no_whole_file() {
    let flat = Pixmap::new(2000, 1000, 255, vec![255; 6_000_000]).unwrap();
    for (encoder, decoder) in [
        ("cjpeg -progressive -optimize -quality 1", "djpeg -pnm"),
        ("pnmtopng -compression=9", "pngtopnm"),
        ("pamtotiff -lzw bits1", "tifftopnm"),
        ("pamtotiff -flate bits1", "tifftopnm"),
    ] {
        assert_same_pixels(&flat, true, encoder, decoder, 0);
    }
}
