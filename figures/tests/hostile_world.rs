//! Whatever happens to the program while it saves, be it a kill, a full disk or a folder that may not be written, the
//! target is the old file or the new one, whole, and nothing else stays behind for long.
#![cfg(unix)]

use std::collections::BTreeMap;
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

/// The files of a folder and their bytes.
type Files = BTreeMap<String, Vec<u8>>;

fn files(folder: &Path) -> Files {
    names(folder).into_iter().map(|name| (name.clone(), fs::read(folder.join(name)).unwrap())).collect()
}

/// Kills programs that write the files `wholes[0]` and `wholes[1]` in turns, and checks after each kill that every file is
/// one of the two, whole, and has at most one temporary beside it; until `enough` kills have fallen into a save.
///
/// How many do so is up to the machine. Where it takes too long, this says that it could not judge, and fails nobody.
fn kill_savers(wholes: &[Files; 2], arguments: &[String; 2], enough: u32) {
    let limit = Duration::from_secs(if long() { 1200 } else { 60 });
    let folder = folder();
    let target = |temporary: &str| {
        let name = temporary.strip_prefix('.')?.strip_suffix(".tmp")?;
        name.rsplit_once('.').map(|(name, _)| name.to_owned())
    };
    succeed(folder.path(), &arguments[1]);
    let start = Instant::now();
    let mut reach = Duration::from_millis(20);
    let (mut tries, mut inside, mut renewed) = (0, 0, 0);
    let mut before = files(folder.path());
    while inside < enough || renewed < enough / 10 {
        if start.elapsed() > limit {
            eprintln!(
                "COULD NOT JUDGE: of {tries} kills in {limit:?} {inside} fell into a save and {renewed} after one; \
                 {enough} were wanted, and a tenth of that. Nothing was damaged in these."
            );
            break;
        }
        let mut child = command(PROGRAM, folder.path(), &arguments[tries as usize % 2]).spawn().unwrap();
        // Steps of the golden ratio fill the time evenly, and have no common rhythm with the alternating files.
        sleep(reach.mul_f64((f64::from(tries) * 0.618_033_988_749_895).fract()));
        child.kill().unwrap();
        let status = child.wait().unwrap();
        assert!(status.success() || status.signal() == Some(9), "{status}");

        let after = files(folder.path());
        let mut stale: Vec<String> = after.keys().filter_map(|name| target(name)).collect();
        let fell_inside = after.keys().any(|name| target(name).is_some() && !before.contains_key(name));
        // Never more than one: a save begins by removing what a killed one left.
        stale.dedup();
        assert_eq!(after.len(), wholes[0].len() + stale.len(), "kill {tries}: {:?}", after.keys());
        for (name, bytes) in after.iter().filter(|(name, _)| target(name).is_none()) {
            assert!(
                wholes.iter().any(|whole| whole.get(name) == Some(bytes)),
                "kill {tries}: {name} is neither the old file nor the new one: {} bytes",
                bytes.len()
            );
        }
        inside += u32::from(fell_inside);
        renewed += u32::from(wholes[0].keys().any(|name| before[name] != after[name]));
        // As many are to be too late as are too early, however fast the machine is at the moment.
        reach = match (status.success(), fell_inside) {
            (true, _) => reach.mul_f64(0.9),
            (false, false) => reach.mul_f64(1.1),
            (false, true) => reach,
        }
        .max(Duration::from_micros(100));
        before = after;
        tries += 1;
    }
    succeed(folder.path(), &arguments[0]);
    assert!(files(folder.path()) == wholes[0], "a save that ends leaves no temporary");
}

/// With `RT_LONG` in the environment, tests kill as often as it takes to trust in rare moments.
fn long() -> bool {
    std::env::var_os("RT_LONG").is_some()
}

#[test]
fn kills_leave_the_old_or_the_new_picture_whole() {
    // Numbers as text take longest to write, so that most of the program's life is the save.
    let images = folder();
    let cases = ["3", "6"].map(|figure| {
        let picture = images.path().join(figure).with_extension("ppm");
        let arguments = format!("convert {} picture.ppm --format ppm-plain", picture.display());
        succeed(images.path(), &format!("{figure} --size 320x240 --depth 16 -o {figure}.ppm --quiet"));
        let whole = folder();
        succeed(whole.path(), &arguments);
        (files(whole.path()), arguments)
    });
    let [(first, draw_first), (second, draw_second)] = cases;
    assert!(first != second);
    kill_savers(&[first, second], &[draw_first, draw_second], if long() { 500 } else { 100 });
}

/// A quick run of `figures report`, stored.
const REPORT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/report/quick.json");

#[test]
fn kills_leave_every_file_of_a_report_whole() {
    let stored = fs::read_to_string(REPORT).unwrap();
    let inputs = folder();
    let cases = ["another processor", "a processor of another name"].map(|processor| {
        let mut report: serde_json::Value = serde_json::from_str(&stored).unwrap();
        report["machine"]["processor"] = processor.into();
        let input = inputs.path().join(processor.replace(' ', "-"));
        fs::write(&input, report.to_string()).unwrap();
        let arguments = format!("report --from {} --out ./", input.display());
        let whole = folder();
        succeed(whole.path(), &arguments);
        (files(whole.path()), arguments)
    });
    let [(first, write_first), (second, write_second)] = cases;
    for name in ["report.json", "report.md", "report.html"] {
        assert!(first[name] != second[name], "{name}");
    }
    assert!(first.contains_key("quadratic.svg") && first.contains_key("far-sphere-ours.png"));
    kill_savers(&[first, second], &[write_first, write_second], if long() { 100 } else { 20 });
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
fn a_report_that_meets_a_full_disk_keeps_what_it_was_read_from() {
    let folder = folder();
    fs::copy(REPORT, folder.path().join("report.json")).unwrap();
    fs::write(folder.path().join("report.md"), "old").unwrap();
    let before = files(folder.path());
    let script = r#"trap '' XFSZ; ulimit -f 16; exec "$0" report --from report.json --out ./"#;
    let output = Command::new("sh").args(["-c", script, PROGRAM]).current_dir(&folder).output().unwrap();
    check_refusal(&output, "./report.json: writing failed: File too large (os error 27)");
    assert!(files(folder.path()) == before, "{:?}", names(folder.path()));
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
