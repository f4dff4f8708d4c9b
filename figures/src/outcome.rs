//! How a run ends: done, failed, or wrongly used; and stdout, which carries only the result.

use std::error::Error;
use std::io::{self, BufWriter, Write};
use std::process::ExitCode;

use clap::Parser;

use crate::stderr;

/// Why a program ends without doing its work.
#[derive(Debug)]
pub enum Failure {
    /// The arguments make no sense.
    Usage(String),
    /// Something went wrong; the causes are printed one after the other.
    Failed(Box<dyn Error + Send + Sync>),
    /// A check found these differences.
    Different(Vec<String>),
    /// stdout was closed.
    PipeClosed,
}

impl<E: Error + Send + Sync + 'static> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::Failed(Box::new(error))
    }
}

/// Returns the arguments that the program was started with, or, once the reason is printed, the exit code.
///
/// # Errors
/// 2 for wrong usage. Help and version end the program at once.
pub fn parsed<Arguments: Parser>() -> Result<Arguments, ExitCode> {
    match Arguments::try_parse() {
        Ok(arguments) => Ok(arguments),
        Err(error) if error.use_stderr() => {
            stderr::tell_lines(&error.to_string());
            Err(ExitCode::from(2))
        }
        Err(help) => help.exit(),
    }
}

/// Prints the reason of a failure to stderr, and returns the exit code: 0 done (or stdout was closed), 1 failed, 2
/// wrong usage.
pub fn exit_code(outcome: Result<(), Failure>) -> ExitCode {
    match outcome {
        Ok(()) | Err(Failure::PipeClosed) => ExitCode::SUCCESS,
        Err(Failure::Usage(message)) => {
            stderr::tell(&format!("error: {message}"));
            ExitCode::from(2)
        }
        Err(Failure::Failed(error)) => {
            let mut message = error.to_string();
            let mut cause = error.source();
            while let Some(error) = cause {
                // A wrapper's text may end in its cause's already.
                let text = error.to_string();
                if !message.ends_with(&text) {
                    message = format!("{message}: {text}");
                }
                cause = error.source();
            }
            stderr::tell(&format!("error: {message}"));
            ExitCode::FAILURE
        }
        Err(Failure::Different(differences)) => {
            stderr::tell(&format!("error: {} differences from the stored report:", differences.len()));
            for difference in differences {
                stderr::tell(&difference);
            }
            ExitCode::FAILURE
        }
    }
}

/// Writes the result to stdout.
///
/// # Errors
/// [`Failure::PipeClosed`] if stdout was closed, else the failed write.
pub fn to_stdout(bytes: &[u8]) -> Result<(), Failure> {
    stream_to_stdout(|out| out.write_all(bytes))
}

/// Writes to stdout what `write` does.
///
/// # Errors
/// As [`to_stdout`].
pub fn stream_to_stdout(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Failure> {
    let mut out = BufWriter::with_capacity(1 << 16, io::stdout().lock());
    match write(&mut out).and_then(|()| out.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Err(Failure::PipeClosed),
        Err(error) => Err(Failure::Failed(format!("cannot write to stdout: {error}").into())),
        Ok(()) => Ok(()),
    }
}
