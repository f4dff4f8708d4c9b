//! Lines on stderr, without control characters: messages quote file names, arguments and parts of files, which may hold
//! any character.

use std::io::{self, Write};

use crate::text::escaped;

/// Writes one line. Control characters in it, a line end too, are escaped: `\u{1b}`.
pub fn tell(line: &str) {
    // Nothing can be done if stderr is closed.
    let _ = writeln!(io::stderr(), "{}", escaped(line));
}

/// Writes lines, each as [`tell`] does.
pub fn tell_lines(lines: &str) {
    lines.lines().for_each(tell);
}
