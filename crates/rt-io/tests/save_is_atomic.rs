//! A save leaves the old file or the new one, whole, and nothing else: after a kill at any moment, on a full disk, in a
//! folder that cannot be written, with several savers at once.
#![cfg(unix)]

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Read};
use std::os::unix::fs::{MetadataExt, PermissionsExt, chown, symlink};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use oracle::files::{folder, full_message, names};
use rt_io::{SaveError, save_atomically};

fn save_text(path: &Path, text: &str) -> Result<(), SaveError> {
    save_atomically(path, |out| out.write_all(text.as_bytes()))
}

const LENGTH: usize = 100_000;

/// A file of the `version`: its length and every byte can be checked.
fn save_version(path: &Path, version: u8) -> Result<(), SaveError> {
    save_atomically(path, |out| (0..LENGTH / 100).try_for_each(|_| out.write_all(&[version; 100])))
}

fn check_version(path: &Path) -> u8 {
    let bytes = fs::read(path).unwrap();
    assert_eq!(bytes.len(), LENGTH, "half a file");
    assert!(bytes.iter().all(|byte| *byte == bytes[0]), "a mixture of two files");
    bytes[0]
}

/// This very test program, as another process that runs `helper_process` alone.
fn helper(wrapper: &[&str], mode: &str, target: &Path) -> Command {
    let program = std::env::current_exe().unwrap();
    let mut words = wrapper.iter().map(OsStr::new).chain([program.as_os_str()]);
    let mut command = Command::new(words.next().unwrap());
    command.args(words).args(["--exact", "helper_process", "--nocapture", "--test-threads=1"]);
    command.env("RT_IO_HELPER", mode).env("RT_IO_TARGET", target).stdout(Stdio::piped());
    command
}

/// Does nothing unless it is started by another test: saves once and tells how that went, or saves until it is killed.
#[test]
fn helper_process() {
    let Some(mode) = std::env::var_os("RT_IO_HELPER") else { return };
    let target = PathBuf::from(std::env::var_os("RT_IO_TARGET").unwrap());
    if mode == "once" {
        match save_version(&target, 2) {
            Ok(()) => println!("\nsaved"),
            Err(error) => println!("\nrefused: {}", full_message(&error)),
        }
        return;
    }
    println!("\nready");
    for version in (2..=255).cycle() {
        save_version(&target, version).unwrap();
    }
}

/// What `helper_process` says about its one save, `None` if it could not be started in this way.
fn helper_says(wrapper: &[&str], target: &Path) -> Option<String> {
    let output = helper(wrapper, "once", target).stderr(Stdio::piped()).output().ok()?;
    let text = String::from_utf8(output.stdout).unwrap();
    let line = text.lines().find(|line| line.starts_with("saved") || line.starts_with("refused"));
    if line.is_none() {
        eprintln!("SKIPPED: {wrapper:?} fails here: {}", String::from_utf8_lossy(&output.stderr));
    }
    line.map(str::to_string)
}

/// How long kills may go on until enough of them have hit a save. A machine on which they do not proves nothing.
const TIME_FOR_KILLS: Duration = Duration::from_secs(240);

#[test]
fn two_hundred_kills_leave_whole_files_and_at_most_one_temporary() {
    let folder = folder();
    let target = folder.path().join("image.ppm");
    save_version(&target, 1).unwrap();
    let start = Instant::now();
    let (mut kills, mut advanced, mut left) = (0_u32, 0, 0);
    // Kills are to hit saves, before and after the rename; how often they do is up to the machine.
    while kills < 200 || advanced <= 20 || left <= 20 {
        if start.elapsed() > TIME_FOR_KILLS {
            eprintln!("NOT JUDGED: of {kills} kills {advanced} landed behind a save and {left} within one");
            break;
        }
        let before = check_version(&target);
        let mut child = helper(&[], "forever", &target).spawn().unwrap();
        let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
        assert!(lines.any(|line| line.unwrap() == "ready"));
        // From no time to the time of a few saves as they go now, in steps that have no common rhythm with them.
        let save = Instant::now();
        save_version(&folder.path().join("other.ppm"), 1).unwrap();
        std::thread::sleep(save.elapsed() * (kills * 617 % 1000) / 300);
        child.kill().unwrap();
        child.wait().unwrap();

        kills += 1;
        advanced += usize::from(check_version(&target) != before);
        fs::remove_file(folder.path().join("other.ppm")).unwrap();
        let names = names(folder.path());
        assert!(names.len() <= 2, "{names:?}");
        left += names.len() - 1;
    }
    save_version(&target, 1).unwrap();
    assert_eq!(names(folder.path()), ["image.ppm"]);
}

/// Notes the calls that make a save last, in the file that `SPY_LOG` names, and lets them through.
const SPY: &str = r#"
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>
static void note(const char *call, const char *first, const char *second) {
    FILE *log = fopen(getenv("SPY_LOG"), "a");
    fprintf(log, "%s %s %s\n", call, first, second);
    fclose(log);
}
int fsync(int file) {
    char link[64], name[4096] = "", size[32];
    struct stat status;
    snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    if (readlink(link, name, sizeof name - 1) < 0 || fstat(file, &status) != 0) abort();
    snprintf(size, sizeof size, "%lld", (long long)status.st_size);
    note("fsync", name, size);
    return ((int (*)(int))dlsym(RTLD_NEXT, "fsync"))(file);
}
int rename(const char *from, const char *to) {
    note("rename", from, to);
    return ((int (*)(const char *, const char *))dlsym(RTLD_NEXT, "rename"))(from, to);
}
"#;

#[test]
#[cfg(all(target_os = "linux", target_env = "gnu"))]
fn the_bytes_reach_the_disk_before_they_get_the_name() {
    // No crash of a computer can be tried here, so the calls that guard against one are observed.
    let folder = folder();
    let [source, library, log] = ["spy.c", "spy.so", "log"].map(|name| folder.path().join(name));
    let target = folder.path().join("image.ppm");
    fs::write(&source, SPY).unwrap();
    let mut compiler = Command::new("cc");
    compiler.args(["-shared", "-fPIC", "-o"]).args([&library, &source]).arg("-ldl");
    if !compiler.status().is_ok_and(|status| status.success()) {
        eprintln!("SKIPPED: no C compiler called cc");
        return;
    }
    let [library, log_variable] =
        [("LD_PRELOAD", &library), ("SPY_LOG", &log)].map(|(name, path)| format!("{name}={}", path.display()));
    let wrapper = ["env", library.as_str(), log_variable.as_str()];
    assert_eq!(helper_says(&wrapper, &target).as_deref(), Some("saved"));

    let log = fs::read_to_string(log).unwrap();
    let words: Vec<&str> = log.split_whitespace().collect();
    let ["fsync", temporary, length, "rename", from, to] = words[..] else { panic!("{log}") };
    assert_eq!((from, Path::new(to)), (temporary, target.as_path()));
    assert_ne!(from, to);
    assert_eq!(length, LENGTH.to_string(), "all bytes, before the rename");
}

#[test]
fn savers_at_once_do_not_disturb_each_other() {
    let folder = folder();
    let target = folder.path().join("image.ppm");
    save_version(&target, 1).unwrap();
    std::thread::scope(|scope| {
        for version in 2..8 {
            let target = &target;
            scope.spawn(move || {
                for _ in 0..20 {
                    save_version(target, version).unwrap();
                    check_version(target);
                }
            });
        }
    });
    assert_eq!(names(folder.path()), ["image.ppm"]);
}

#[test]
fn only_dead_temporaries_of_the_same_target_are_removed() {
    let folder = folder();
    let stale = ".a.ppm.0000000000000000.tmp";
    let others = [
        ".a.ppm.000000000000000g.tmp",
        ".a.ppm.00000000.tmp",
        ".a.ppm.0000000000000000.tmp.bak",
        ".b.ppm.0000000000000000.tmp",
        "a.ppm.0000000000000000.tmp",
    ];
    for name in others.iter().chain([&stale]) {
        fs::write(folder.path().join(name), "").unwrap();
    }
    fs::create_dir(folder.path().join(".a.ppm.00000000000000aa.tmp")).unwrap();
    let living = File::create(folder.path().join(".a.ppm.00000000000000bb.tmp")).unwrap();
    living.lock().unwrap();
    save_text(&folder.path().join("a.ppm"), "new").unwrap();
    let mut expected = others.map(str::to_string).to_vec();
    expected.extend(["a.ppm", ".a.ppm.00000000000000aa.tmp", ".a.ppm.00000000000000bb.tmp"].map(str::to_string));
    expected.sort();
    assert_eq!(names(folder.path()), expected);
}

#[test]
fn a_full_disk_leaves_the_old_file_and_no_temporary() {
    // A file system of 64 KiB that only this process and its children see.
    let folder = folder();
    let script = r#"mount -t tmpfs -o size=64k none "$RT_IO_FOLDER" && echo old > "$RT_IO_TARGET" && "$0" "$@";
        ls -A "$RT_IO_FOLDER"; cat "$RT_IO_TARGET""#;
    let output = helper(
        &["unshare", "--mount", "--map-root-user", "sh", "-c", script],
        "once",
        &folder.path().join("image.ppm"),
    )
    .env("RT_IO_FOLDER", folder.path())
    .stderr(Stdio::piped())
    .output();
    match output {
        Ok(output) if output.stderr.is_empty() => {
            let text = String::from_utf8(output.stdout).unwrap();
            let message = format!(
                "refused: {}: writing failed: No space left on device (os error 28)\n",
                folder.path().join("image.ppm").display()
            );
            assert!(text.contains(&message), "{text}");
            assert!(text.ends_with("\nimage.ppm\nold\n"), "{text}");
        }
        other => eprintln!("SKIPPED: no file system of its own: {other:?}"),
    }

    // The same by a limit on the size of a file, which any shell can set.
    let target = folder.path().join("limited.ppm");
    save_text(&target, "old").unwrap();
    let says = helper_says(&["sh", "-c", r#"trap '' XFSZ; ulimit -f 64; exec "$0" "$@""#], &target).unwrap();
    assert_eq!(says, format!("refused: {}: writing failed: File too large (os error 27)", target.display()));
    assert_eq!(fs::read(&target).unwrap(), b"old");
    assert_eq!(names(folder.path()), ["limited.ppm"]);
}

#[test]
fn an_error_of_the_closure_leaves_the_old_file_and_no_temporary() {
    let folder = folder();
    let target = folder.path().join("image.ppm");
    save_text(&target, "old").unwrap();
    let error = save_atomically(&target, |out| {
        out.write_all(b"half")?;
        Err(io::Error::other("no more"))
    });
    assert_eq!(full_message(&error.unwrap_err()), format!("{}: writing failed: no more", target.display()));
    let panic = std::panic::catch_unwind(|| save_atomically(&target, |_| panic!("on purpose")));
    assert!(panic.is_err());
    assert_eq!(fs::read(&target).unwrap(), b"old");
    assert_eq!(names(folder.path()), ["image.ppm"]);
}

#[test]
fn a_place_that_cannot_be_written_is_named() {
    let folder = folder();
    let show = |name: &str| folder.path().join(name).display().to_string();
    let message = |path: &Path| full_message(&save_text(path, "new").unwrap_err());

    assert_eq!(
        message(&folder.path().join("missing/image.ppm")),
        format!("{}: the folder {} does not exist; create it first", show("missing/image.ppm"), show("missing"))
    );
    assert_eq!(message(folder.path()), format!("{} is a folder, not a file", folder.path().display()));
    assert_eq!(message(&folder.path().join("new/")), format!("{} is a folder, not a file", show("new/")));
    assert_eq!(message(Path::new("")), ": cannot be written: an empty path names no file");
    fs::write(folder.path().join("file"), "old").unwrap();
    assert_eq!(
        message(&folder.path().join("file/image.ppm")),
        format!("{}: cannot be written: Not a directory (os error 20)", show("file/image.ppm"))
    );
    symlink("circle", folder.path().join("circle")).unwrap();
    assert_eq!(
        message(&folder.path().join("circle")),
        format!("{}: cannot be written: too many symbolic links", show("circle"))
    );
    let long = "x".repeat(300);
    assert!(message(&folder.path().join(&long)).contains("File name too long"));
    assert_eq!(names(folder.path()), ["circle", "file"]);
    assert_eq!(fs::read(folder.path().join("file")).unwrap(), b"old");
}

#[test]
fn a_read_only_folder_or_file_is_refused() {
    let folder = folder();
    let target = folder.path().join("image.ppm");
    save_text(&target, "old").unwrap();
    // The superuser may write anywhere, so the save is done by somebody else.
    let is_root = fs::metadata("/proc/self").is_ok_and(|metadata| metadata.uid() == 0);
    let wrapper: &[&str] = if is_root { &["setpriv", "--reuid=65534", "--clear-groups"] } else { &[] };
    let denied = format!("refused: {}: cannot be written: Permission denied (os error 13)", target.display());

    // A file that may be written in a folder that may not.
    fs::set_permissions(&target, PermissionsExt::from_mode(0o666)).unwrap();
    fs::set_permissions(folder.path(), PermissionsExt::from_mode(0o555)).unwrap();
    let says = helper_says(wrapper, &target);
    assert!(says.is_none_or(|says| says == denied));

    // A file that may not be written in a folder that may.
    fs::set_permissions(&target, PermissionsExt::from_mode(0o444)).unwrap();
    fs::set_permissions(folder.path(), PermissionsExt::from_mode(0o777)).unwrap();
    let says = helper_says(wrapper, &target);
    assert!(says.is_none_or(|says| says == denied));
    assert_eq!(fs::read(&target).unwrap(), b"old");
    assert_eq!(names(folder.path()), ["image.ppm"]);
}

#[test]
fn devices_and_pipes_are_written_and_not_replaced() {
    if Path::new("/dev/full").exists() {
        let error = save_text(Path::new("/dev/full"), "new").unwrap_err();
        assert_eq!(full_message(&error), "/dev/full: writing failed: No space left on device (os error 28)");
        save_text(Path::new("/dev/null"), "new").unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }

    let folder = folder();
    let fifo = folder.path().join("fifo");
    if Command::new("mkfifo").arg(&fifo).status().is_ok_and(|status| status.success()) {
        let link = folder.path().join("link");
        symlink("fifo", &link).unwrap();
        let reader = std::thread::spawn({
            let fifo = fifo.clone();
            move || fs::read(fifo).unwrap()
        });
        save_text(&link, "through the pipe").unwrap();
        assert_eq!(reader.join().unwrap(), b"through the pipe");
        assert_eq!(names(folder.path()), ["fifo", "link"]);
    }

    // /dev/stdout is a pipe here, and below a file that holds something already.
    if cfg!(target_os = "linux") {
        let mut child = helper(&[], "once", Path::new("/dev/stdout")).spawn().unwrap();
        let mut bytes = Vec::new();
        child.stdout.take().unwrap().read_to_end(&mut bytes).unwrap();
        assert!(child.wait().unwrap().success());
        assert_eq!(bytes.iter().filter(|byte| **byte == 2).count(), LENGTH);

        let out = folder.path().join("out");
        fs::write(&out, "kept").unwrap();
        let appending = File::options().append(true).open(&out).unwrap();
        let inode = fs::metadata(&out).unwrap().ino();
        assert!(helper(&[], "once", Path::new("/dev/stdout")).stdout(appending).status().unwrap().success());
        let bytes = fs::read(&out).unwrap();
        assert!(bytes.starts_with(b"kept") && bytes.iter().filter(|byte| **byte == 2).count() == LENGTH);
        assert_eq!(fs::metadata(&out).unwrap().ino(), inode);
    }
}

#[test]
fn links_are_followed_and_permissions_kept() {
    let folder = folder();
    let mode = |name: &str| fs::metadata(folder.path().join(name)).unwrap().permissions().mode() & 0o7777;

    // A new file is like any other new file.
    File::create(folder.path().join("ordinary")).unwrap();
    save_text(&folder.path().join("new"), "new").unwrap();
    assert_eq!(mode("new"), mode("ordinary"));

    // An old one keeps its mode.
    for bits in [0o600, 0o644, 0o666, 0o755] {
        fs::set_permissions(folder.path().join("new"), PermissionsExt::from_mode(bits)).unwrap();
        save_text(&folder.path().join("new"), "newer").unwrap();
        assert_eq!(mode("new"), bits);
    }

    // A link, and a link to a link from another folder, stay links.
    fs::create_dir(folder.path().join("inner")).unwrap();
    symlink("new", folder.path().join("link")).unwrap();
    symlink("../link", folder.path().join("inner/link")).unwrap();
    save_text(&folder.path().join("inner/link"), "newest").unwrap();
    assert!(fs::symlink_metadata(folder.path().join("link")).unwrap().is_symlink());
    assert!(fs::symlink_metadata(folder.path().join("inner/link")).unwrap().is_symlink());
    assert_eq!(fs::read(folder.path().join("new")).unwrap(), b"newest");

    // A link to nothing makes what it names.
    symlink("created", folder.path().join("dangling")).unwrap();
    save_text(&folder.path().join("dangling"), "there").unwrap();
    assert_eq!(fs::read(folder.path().join("created")).unwrap(), b"there");
    assert_eq!(names(folder.path()), ["created", "dangling", "inner", "link", "new", "ordinary"]);
}

/// Whether this process may give files away; the tests that need that say so otherwise.
fn is_root() -> bool {
    let root = fs::metadata("/proc/self").is_ok_and(|metadata| metadata.uid() == 0);
    if !root {
        eprintln!("SKIPPED: only the superuser can give files away");
    }
    root
}

/// Owner, group and mode.
fn access(path: &Path) -> (u32, u32, u32) {
    let metadata = fs::metadata(path).unwrap();
    (metadata.uid(), metadata.gid(), metadata.mode() & 0o7777)
}

fn set_access(path: &Path, (owner, group, mode): (u32, u32, u32)) {
    chown(path, Some(owner), Some(group)).unwrap();
    fs::set_permissions(path, PermissionsExt::from_mode(mode)).unwrap();
}

#[test]
fn a_replaced_file_keeps_its_owner_group_and_mode() {
    let folder = folder();
    let target = folder.path().join("image.ppm");
    save_text(&target, "old").unwrap();
    let link = folder.path().join("link.ppm");
    fs::hard_link(&target, &link).unwrap();
    save_text(&target, "new").unwrap();
    assert_eq!(fs::read(&link).unwrap(), b"old", "a hard link keeps the old bytes");
    if !is_root() {
        return;
    }
    // The mode last: a change of owner clears the bits that run a program as its owner or group.
    for old in [(65534, 65533, 0o640), (65534, 0, 0o600), (0, 65533, 0o664), (65534, 65533, 0o6755)] {
        set_access(&target, old);
        save_text(&target, "new").unwrap();
        assert_eq!(access(&target), old);
    }
}

#[test]
fn what_cannot_be_kept_grants_no_more() {
    if !is_root() {
        return;
    }
    let folder = folder();
    let target = folder.path().join("image.ppm");
    fs::set_permissions(folder.path(), PermissionsExt::from_mode(0o777)).unwrap();
    let stranger = ["setpriv", "--reuid=65534", "--regid=65533", "--clear-groups"];
    let member = ["setpriv", "--reuid=65534", "--regid=65533", "--groups=65532"];
    let cases: [(&[&str], _, _); 5] = [
        // Another group may do what everybody may.
        (&stranger, (0, 0, 0o666), (65534, 65533, 0o666)),
        (&stranger, (0, 0, 0o662), (65534, 65533, 0o622)),
        (&stranger, (0, 0, 0o6777), (65534, 65533, 0o777)),
        // A member keeps the group, and what it may.
        (&member, (0, 65532, 0o660), (65534, 65532, 0o660)),
        (&member, (0, 65532, 0o2770), (65534, 65532, 0o2770)),
    ];
    for (wrapper, old, new) in cases {
        fs::write(&target, "old").unwrap();
        set_access(&target, old);
        let Some(says) = helper_says(wrapper, &target) else { return };
        assert_eq!(says, "saved", "{old:?}");
        assert_eq!(access(&target), new, "{old:?}");
        fs::remove_file(&target).unwrap();
    }
}

#[test]
fn a_temporary_can_be_read_by_no_more_than_the_file() {
    let folder = folder();
    let target = folder.path().join("image.ppm");
    let during = || {
        let mut found = None;
        save_atomically(&target, |out| {
            out.write_all(b"new")?;
            let temporary = names(folder.path()).into_iter().find(|name| name.ends_with(".tmp")).unwrap();
            found = Some(access(&folder.path().join(&temporary)).2);
            Ok(())
        })
        .unwrap();
        found.unwrap()
    };
    // A new file: from the start what it is at the end.
    let mode = during();
    assert_eq!(mode, access(&target).2);
    for old in [0o600, 0o640, 0o644, 0o666] {
        fs::set_permissions(&target, PermissionsExt::from_mode(old)).unwrap();
        assert_eq!(during(), 0o600, "{old:o}");
        assert_eq!(access(&target).2, old);
    }
}

#[test]
fn names_at_the_limit_and_not_in_unicode_are_saved() {
    use std::os::unix::ffi::OsStrExt;
    let folder = folder();
    let long = "é".repeat(127);
    save_text(&folder.path().join(&long), "long").unwrap();
    assert_eq!(fs::read(folder.path().join(&long)).unwrap(), b"long");
    let odd = folder.path().join(OsStr::from_bytes(b"\xff.ppm"));
    save_text(&odd, "odd").unwrap();
    assert_eq!(fs::read(&odd).unwrap(), b"odd");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}
