//! The program; [`figures::cli`] is all of it.

use std::process::ExitCode;

fn main() -> ExitCode {
    figures::cli::main()
}
