//! Says what is being measured while it takes time.

use std::io::{self, IsTerminal};

use figures::stderr;

/// Says what is being measured, if stderr is a terminal.
pub(super) fn progress(what: &str) {
    if io::stderr().is_terminal() {
        stderr::tell(&format!("measuring {what}"));
    }
}
