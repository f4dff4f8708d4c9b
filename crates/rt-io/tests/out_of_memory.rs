//! A picture for which the system has not enough memory is an error that says how much and what to do, and no abort.
#![cfg(all(unix, feature = "decode"))]

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::Command;

use oracle::files::full_message;
use oracle::images::{Tag, black_jpeg, tiff};
use rt_io::{Limits, Pixmap, decode_image, png, read_image};

/// The address space of a helper: less than what any of the pictures here takes, more than a test program.
const KILOBYTES: &str = "400000";

/// Does nothing unless it is started by another test: reads an image, or writes one, and tells how that went.
#[test]
fn helper_process() {
    let Some(path) = std::env::var_os("RT_IO_IMAGE") else { return };
    let says = match path.to_str() {
        Some("write") => {
            // 144 MB, twice of which are more than there is left.
            let pixmap = Pixmap::new(8000, 3000, 65535, vec![65535; 72_000_000]).unwrap();
            png::write(&pixmap, &mut io::sink()).map_err(|error| error.to_string())
        }
        _ => read_image(Path::new(&path), &Limits::default()).map(|_| ()).map_err(|error| full_message(&error)),
    };
    println!("\nsays: {says:?}");
}

/// What the helper says with so little memory, `None` if it cannot be started so.
fn helper_says(image: &OsStr) -> Option<String> {
    let script = format!(r#"ulimit -v {KILOBYTES} && exec "$0" "$@""#);
    let mut command = Command::new("sh");
    command.args(["-c", &script]).arg(std::env::current_exe().unwrap());
    command.args(["--exact", "helper_process", "--nocapture", "--test-threads=1"]).env("RT_IO_IMAGE", image);
    let output = command.output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let says = text.lines().find_map(|line| line.strip_prefix("says: "));
    if says.is_none() {
        eprintln!("{text}\n{}", String::from_utf8_lossy(&output.stderr));
    }
    says.map(str::to_string)
}

/// A grey PNG of `2^14` columns and rows, all black.
fn large_png(path: &Path) {
    let mut encoder = ::png::Encoder::new(File::create(path).unwrap(), 1 << 14, 1 << 14);
    encoder.set_color(::png::ColorType::Grayscale);
    encoder.set_depth(::png::BitDepth::Sixteen);
    let mut writer = encoder.write_header().unwrap();
    let mut rows = writer.stream_writer().unwrap();
    for _ in 0..1 << 14 {
        rows.write_all(&[0; 2 << 14]).unwrap();
    }
    rows.finish().unwrap();
}

#[test]
fn too_little_memory_is_an_error_that_names_file_size_and_remedy() {
    let folder = oracle::files::folder();
    let folder = folder.path();
    let file = |name: &str, bytes: &[u8], length: u64| -> PathBuf {
        let path = folder.join(name);
        fs::write(&path, bytes).unwrap();
        File::options().write(true).open(&path).unwrap().set_len(length).unwrap();
        path
    };
    // Files as long as they say, or long enough, but for the PNG full of nothing.
    let ppm = file("a.ppm", b"P6 16384 16384 255\n", 19 + (3 << 28));
    let jpeg = black_jpeg([1 << 14; 2], false, false);
    let jpeg = file("a.jpg", &jpeg, jpeg.len() as u64);
    let tags: [Tag<'_>; 4] = [(256, &[1 << 14]), (257, &[1 << 14]), (258, &[8]), (262, &[1])];
    let tiff = file("a.tiff", &tiff(&tags, &[0; 1 << 20]), 2 << 20);
    let png = folder.join("a.png");
    large_png(&png);

    let Some(_) = helper_says("missing".as_ref()) else {
        eprintln!("SKIPPED: no limit on the memory of a process");
        return;
    };
    for (path, what) in [
        (&ppm, "805306368 samples;"),
        (&png, "16384 x 16384 pixels: 536870912 more bytes;"),
        (&jpeg, "16384 x 16384 pixels: "),
        (&tiff, "16384 x 16384 pixels: "),
    ] {
        let says = helper_says(path.as_os_str()).unwrap();
        let start = format!(r#"Err("cannot read the image {}: not enough memory for {what}"#, path.display());
        assert!(says.starts_with(&start), "{says}\n{start}");
        assert!(says.ends_with(r#"; scale the picture down first")"#), "{says}");
    }
    let says = helper_says("write".as_ref()).unwrap();
    assert!(says.starts_with("Err(") && says.contains("memory"), "{says}");
}

/// The other way round: with so little memory a picture that fits is read.
#[test]
fn a_picture_that_fits_is_read_with_little_memory() {
    let mut bytes = Vec::new();
    png::write(&Pixmap::new(2, 1, 255, vec![1, 2, 3, 4, 5, 6]).unwrap(), &mut bytes).unwrap();
    assert!(decode_image(&bytes, &Limits::default()).is_ok());
    let path = std::env::temp_dir().join(format!("rt-io-little-{}.png", std::process::id()));
    fs::write(&path, bytes).unwrap();
    if let Some(says) = helper_says(path.as_os_str()) {
        assert_eq!(says, "Ok(())");
    }
    fs::remove_file(&path).unwrap();
}
