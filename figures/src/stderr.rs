//! What goes to stderr: one line at a time, and nothing in it that would steer a terminal.
//!
//! Messages quote names of files, arguments and pieces of files, and these may hold any character. Whatever made the
//! message, it passes through here.

use std::io::{self, Write};

use crate::text::escaped;

/// Writes one line. Whatever in it is not to be shown but done by a terminal, a line end too, is escaped: `\u{1b}`.
pub fn tell(line: &str) {
    // Nobody is left to be told when stderr itself is gone.
    let _ = writeln!(io::stderr(), "{}", escaped(line));
}

/// Writes lines, each as [`tell`] does.
pub fn tell_lines(lines: &str) {
    lines.lines().for_each(tell);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_that_steers_a_terminal_is_left() {
        assert_eq!(escaped("\u{1b}[2J\r\n\t\0\u{7f}\u{9b}1A\u{202e}"), r"\u{1b}[2J\r\n\t\u{0}\u{7f}\u{9b}1A\u{202e}");
        // Text in any script stays, and so does a quote or a backslash.
        let plain = r#"Größe 大きさ "a\b" × ½"#;
        assert_eq!(escaped(plain), plain);
        let all: String = (0..=0x0010_ffff_u32).filter_map(char::from_u32).collect();
        assert!(!escaped(&all).contains(char::is_control));
    }
}
