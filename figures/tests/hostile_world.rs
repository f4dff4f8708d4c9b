//! Whatever happens to the program while it saves, be it a kill, a full disk or a folder that may not be written, the
//! target is the old file or the new one, whole, and nothing else stays behind for long.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::{MetadataExt, PermissionsExt};
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use tempfile::TempDir;

const PROGRAM: &str = env!("CARGO_BIN_EXE_figures");

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// Starts `program` in `folder` with these arguments, separated by spaces.
fn command(program: &str, folder: &Path, arguments: &str) -> Command {
    let mut command = Command::new(program);
    command.args(arguments.split(' ')).current_dir(folder);
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn succeed(folder: &Path, arguments: &str) {
    let output = command(PROGRAM, folder, arguments).output().unwrap();
    assert!(output.status.success(), "{arguments}: {}", String::from_utf8_lossy(&output.stderr));
}

/// Checks that the program has said this, failed with exit code 1, and written nothing to stdout.
fn check_refusal(output: &Output, message: &str) {
    assert_eq!(String::from_utf8_lossy(&output.stderr), format!("error: {message}\n"));
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(output.stdout.is_empty(), "{message}");
}

/// The names of all files, sorted.
fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn two_hundred_kills_leave_the_old_or_the_new_picture_whole() {
    // Numbers as text take longest to write, so that most of the program's life is the save.
    let images = folder();
    let mut wholes = Vec::new();
    for (figure, name) in [("3", "a"), ("6", "b")] {
        succeed(images.path(), &format!("{figure} --size 320x240 --depth 16 -o {name}.ppm --quiet"));
        succeed(images.path(), &format!("convert {name}.ppm {name}-whole.ppm --format ppm-plain"));
        wholes.push(fs::read(images.path().join(format!("{name}-whole.ppm"))).unwrap());
    }
    assert!(wholes[0] != wholes[1]);
    let convert = |kill: u32| {
        let name = if kill.is_multiple_of(2) { "a" } else { "b" };
        let picture = images.path().join(name).with_extension("ppm");
        format!("convert {} picture.ppm --format ppm-plain", picture.display())
    };

    let folder = folder();
    let target = folder.path().join("picture.ppm");
    let stale = || names(folder.path()).into_iter().filter(|name| name != "picture.ppm").count();
    let version = || {
        let bytes = fs::read(&target).unwrap();
        let found = wholes.iter().position(|whole| *whole == bytes);
        found.unwrap_or_else(|| panic!("{} bytes are neither the old picture nor the new one", bytes.len()))
    };

    // How long a whole life is, at its longest of a few: kills are spread over that and a little more.
    let life = |kill| {
        let start = Instant::now();
        succeed(folder.path(), &convert(kill));
        start.elapsed()
    };
    let life = (0..4).map(life).max().unwrap();

    let (mut alive, mut inside, mut renewed) = (0, 0, 0);
    for kill in 0..200 {
        let before = (version(), stale());
        let mut child = command(PROGRAM, folder.path(), &convert(kill)).spawn().unwrap();
        // Steps of the golden ratio fill the time evenly, and have no common rhythm with the alternating pictures.
        let moment = (f64::from(kill) * 0.618_033_988_749_895).fract();
        sleep(life.mul_f64(1.05 * moment));
        child.kill().unwrap();
        let status = child.wait().unwrap();
        assert!(status.success() || status.signal() == Some(9), "{status}");

        alive += usize::from(status.signal() == Some(9));
        // Never more than one: a save begins by removing what a killed one left.
        assert!(stale() <= 1, "kill {kill}: {:?}", names(folder.path()));
        inside += usize::from(stale() == 1 && before.1 == 0);
        renewed += usize::from(version() != before.0);
    }
    assert!(alive >= 50, "{alive} of 200 kills found the program alive");
    assert!(
        inside >= 10,
        "{inside} of 200 kills left a temporary where there was none: they fell into a save"
    );
    assert!(renewed >= 2, "{renewed} of 200 programs had replaced the picture");
    succeed(folder.path(), &convert(0));
    assert_eq!((version(), stale()), (0, 0));
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
