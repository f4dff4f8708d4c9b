//! What tests need that start programs and kill them while they save.

use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::files::{Files, files, folder};

/// Starts `program` in `folder` with these arguments, separated by spaces.
pub fn command(program: &str, folder: &Path, arguments: &str) -> Command {
    let mut command = Command::new(program);
    command.args(arguments.split(' ')).current_dir(folder);
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// Runs the program, which has to succeed.
pub fn succeed(program: &str, folder: &Path, arguments: &str) {
    let output = command(program, folder, arguments).output().unwrap();
    assert!(output.status.success(), "{arguments}: {}", String::from_utf8_lossy(&output.stderr));
}

/// Checks that the program has said this, failed with exit code 1, and written nothing to stdout.
pub fn check_refusal(output: &Output, message: &str) {
    assert_eq!(String::from_utf8_lossy(&output.stderr), format!("error: {message}\n"));
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(output.stdout.is_empty(), "{message}");
}

/// Kills programs that write the files `wholes[0]` and `wholes[1]` in turns, and checks after each kill that every file
/// is one of the two, whole, and has at most one temporary beside it; until `enough` kills have fallen into a save.
///
/// How many do so is up to the machine. Where it takes too long, this says that it could not judge, and fails nobody.
pub fn kill_savers(program: &str, wholes: &[Files; 2], arguments: &[String; 2], enough: u32) {
    let limit = Duration::from_secs(if long() { 1200 } else { 60 });
    let folder = folder();
    let target = |temporary: &str| {
        let name = temporary.strip_prefix('.')?.strip_suffix(".tmp")?;
        name.rsplit_once('.').map(|(name, _)| name.to_owned())
    };
    succeed(program, folder.path(), &arguments[1]);
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
        let mut child = command(program, folder.path(), &arguments[tries as usize % 2]).spawn().unwrap();
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
    succeed(program, folder.path(), &arguments[0]);
    assert!(files(folder.path()) == wholes[0], "a save that ends leaves no temporary");
}

/// With `RT_LONG` in the environment, tests kill as often as it takes to trust in rare moments.
pub fn long() -> bool {
    std::env::var_os("RT_LONG").is_some()
}
