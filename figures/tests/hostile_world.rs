//! Whatever happens to the program while it saves, be it a kill, a full disk or a folder that may not be written, the
//! target is the old file or the new one, whole, and nothing else stays behind for long.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::{MetadataExt, PermissionsExt};
use std::os::unix::process::ExitStatusExt;
use std::process::Command;
use std::thread::sleep;
use std::time::Duration;

use oracle::files::{files, folder, names};
use oracle::kills::{check_refusal, command, kill_savers, long, succeed};

const PROGRAM: &str = env!("CARGO_BIN_EXE_figures");

#[test]
fn kills_leave_the_old_or_the_new_picture_whole() {
    // Numbers as text take longest to write, so that most of the program's life is the save.
    let images = folder();
    let cases = ["3", "6"].map(|figure| {
        let picture = images.path().join(figure).with_extension("ppm");
        let arguments = format!("convert {} picture.ppm --format ppm-plain", picture.display());
        succeed(PROGRAM, images.path(), &format!("{figure} --size 320x240 --depth 16 -o {figure}.ppm --quiet"));
        let whole = folder();
        succeed(PROGRAM, whole.path(), &arguments);
        (files(whole.path()), arguments)
    });
    let [(first, draw_first), (second, draw_second)] = cases;
    assert!(first != second);
    kill_savers(PROGRAM, &[first, second], &[draw_first, draw_second], if long() { 500 } else { 100 });
}

#[test]
fn an_interrupt_while_drawing_leaves_nothing() {
    let folder = folder();
    let arguments = "3 --size 2000x2000 --samples 16 --quiet -o picture.ppm";
    let mut child = command(PROGRAM, folder.path(), arguments).spawn().unwrap();
    sleep(Duration::from_millis(100));
    // What Ctrl-C sends.
    let killed = Command::new("sh").arg("-c").arg(format!("kill -INT {}", child.id())).status().unwrap();
    assert!(killed.success());
    assert_eq!(child.wait().unwrap().signal(), Some(2));
    assert!(names(folder.path()).is_empty(), "{:?}", names(folder.path()));
}

#[test]
fn a_disk_that_fills_up_leaves_the_old_file_and_no_temporary() {
    let folder = folder();
    fs::write(folder.path().join("picture.ppm"), "old").unwrap();
    // A limit on the size of files stops a write where a full disk would, and needs no disk.
    let script = r#"trap '' XFSZ; ulimit -f 16; exec "$0" 1 --size 200x200 --quiet -o picture.ppm"#;
    let output = Command::new("sh").args(["-c", script, PROGRAM]).current_dir(&folder).output().unwrap();
    check_refusal(&output, "picture.ppm: writing failed: File too large (os error 27)");
    assert_eq!(fs::read(folder.path().join("picture.ppm")).unwrap(), b"old");
    assert_eq!(names(folder.path()), ["picture.ppm"]);

    if cfg!(target_os = "linux") {
        let output = command(PROGRAM, folder.path(), "1 --size 8x6 -o /dev/full").output().unwrap();
        check_refusal(&output, "/dev/full: writing failed: No space left on device (os error 28)");
        let script = r#""$0" 1 --size 8x6 -o - > /dev/full"#;
        let output = Command::new("sh").args(["-c", script, PROGRAM]).current_dir(&folder).output().unwrap();
        check_refusal(&output, "cannot write to stdout: No space left on device (os error 28)");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn a_lack_of_memory_that_can_be_foreseen_is_an_error() {
    // A limit on addresses stands for a small machine: room for the program and a thread, and not for these.
    let folder = folder();
    let run = |arguments: &str| {
        let script = format!(r#"ulimit -v 400000; exec "$0" {arguments}"#);
        Command::new("sh").args(["-c", &script, PROGRAM]).current_dir(&folder).output().unwrap()
    };
    let remedy = "draw a smaller picture (--size) or bands of it (--tile)";
    for (arguments, message) in [
        (
            "1 --size 16384x16384 --threads 1 -o a.ppm",
            format!("cannot get 2416 MB of memory for 16384 x 16384 pixels; {remedy}"),
        ),
        (
            "1 --size 8192x8192 --threads 1 --depth 16 -o a.png",
            format!("cannot get 1611 MB of memory for 8192 x 8192 pixels; {remedy}"),
        ),
        (
            "gen spheres packed --count 100000000 -o a.xyz",
            "cannot get 5600 MB of memory for 100000000 spheres; make fewer of them (--count)".to_owned(),
        ),
        (
            "gen sphereflake --depth 7 -o a.xyz",
            "cannot get 812 MB of memory for depth 7; make fewer generations (--depth)".to_owned(),
        ),
    ] {
        check_refusal(&run(arguments), &message);
        assert!(names(folder.path()).is_empty(), "{arguments}: {:?}", names(folder.path()));
    }

    // A band needs less.
    let output = run("1 --size 16384x16384 --threads 1 --tile 7/128 --quiet -o 7.ppm");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));

    // Two bands that fit, and a whole that does not.
    for (name, rows) in [("1.ppm", "0..2048"), ("2.ppm", "2048..4096")] {
        let label = format!("figures 0.1.0 rows {rows} of 16384x4096 samples 1 scene 0");
        let head = format!("P6\n# {label}\n16384 2048\n255\n");
        fs::write(folder.path().join(name), &head).unwrap();
        let file = fs::File::options().write(true).open(folder.path().join(name)).unwrap();
        file.set_len(head.len() as u64 + 3 * 16384 * 2048).unwrap();
    }
    check_refusal(
        &run("merge a.ppm 1.ppm 2.ppm"),
        "cannot get 403 MB of memory for 16384 x 4096 pixels; pnmcat -tb joins tiles in less",
    );
    assert_eq!(names(folder.path()), ["1.ppm", "2.ppm", "7.ppm"]);
}

#[test]
#[cfg(target_os = "linux")]
fn many_samples_take_no_more_memory_than_one() {
    let folder = folder();
    let peak = |samples: &str| -> u64 {
        let arguments = format!("3 --size 64x48 --threads 2 --samples {samples} --json --quiet -o a.ppm");
        let output = command(PROGRAM, folder.path(), &arguments).output().unwrap();
        let account: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        account["peak_memory_bytes"].as_u64().unwrap()
    };
    let (one, many) = (peak("1"), peak("40"));
    assert!(many < one + (64 << 20), "{one} bytes with a sample in each pixel, {many} with 40 x 40");
}

#[test]
fn a_folder_that_may_not_be_written_is_named_and_stays_as_it_was() {
    let folder = folder();
    let draw = "1 --size 8x6 -o picture.ppm";

    // A file is no folder, whoever asks.
    fs::write(folder.path().join("file"), "old").unwrap();
    let output = command(PROGRAM, folder.path(), "1 --size 8x6 -o file/picture.ppm").output().unwrap();
    check_refusal(&output, "file/picture.ppm: cannot be written: Not a directory (os error 20)");
    assert_eq!(names(folder.path()), ["file"]);

    // Permissions do not bind the superuser, so the program runs as somebody else then.
    fs::write(folder.path().join("picture.ppm"), "old").unwrap();
    fs::set_permissions(folder.path().join("picture.ppm"), PermissionsExt::from_mode(0o666)).unwrap();
    fs::set_permissions(folder.path(), PermissionsExt::from_mode(0o555)).unwrap();
    let superuser = fs::metadata(folder.path()).unwrap().uid() == 0;
    let run = |arguments: &str| {
        if superuser {
            let arguments = format!("--reuid=65534 --clear-groups -- {PROGRAM} {arguments}");
            command("setpriv", folder.path(), &arguments).output()
        } else {
            command(PROGRAM, folder.path(), arguments).output()
        }
    };
    if run("list").is_ok_and(|output| output.status.success()) {
        let output = run(draw).unwrap();
        check_refusal(&output, "picture.ppm: cannot be written: Permission denied (os error 13)");
        let output = run("all --size 8x6 -o new").unwrap();
        check_refusal(&output, "cannot make folder new: Permission denied (os error 13)");
    } else {
        assert!(superuser, "the program itself runs");
        eprintln!("SKIPPED: this is the superuser, and nobody else can be made to run the program");
    }
    fs::set_permissions(folder.path(), PermissionsExt::from_mode(0o755)).unwrap();
    assert_eq!(fs::read(folder.path().join("picture.ppm")).unwrap(), b"old");
    assert_eq!(names(folder.path()), ["file", "picture.ppm"]);
}
