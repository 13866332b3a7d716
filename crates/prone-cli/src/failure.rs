//! How a command ends badly, and the one rule of its exit codes.
//!
//! - **2, the input is wrong**: what was typed, or what is read, is not what it has to be. Nothing was
//!   done. A place for a result belongs to what was typed: one that can be seen to be wrong before the
//!   work begins, as a folder that does not exist or is read-only, is 2.
//! - **1, the work failed**: everything that goes wrong once it has begun, and all that cannot be
//!   written then, on a full disk or to standard output; of every command, `--help` included.
//! - **130, stopped**: by Ctrl-C, SIGTERM or SIGHUP, wherever it was.

use std::io::Write as _;
use std::process::ExitCode;

use prone::foreign_text;
use prone_record::output::OutputError;
use prone_record::single_file::WriteError;

/// Longest message beside what was typed, bytes. Foreign texts in messages are cut where they are put in;
/// this is for what a library says.
const LONGEST_MESSAGE: usize = 900;

/// Exit code of a run that the user stopped.
pub(crate) const STOPPED: u8 = 130;

/// Why a command did not do what was asked.
///
/// The messages of this project's errors are complete in themselves, causes included, so only the
/// outermost is printed.
#[derive(Debug)]
pub(crate) enum Failure {
    /// What was typed or read is wrong: exit code 2. Nothing was written but what could be read of a
    /// record that was cut off.
    Input(anyhow::Error),
    /// The same of arguments; clap has said what.
    Usage,
    /// The work itself failed: exit code 1.
    Work(anyhow::Error),
    /// The user stopped it: exit code 130.
    Stopped,
    /// The user stopped it, and part of the work is kept, as the message says: exit code 130.
    Paused(String),
    /// Whoever reads our output has gone, as `head` does: no reason to complain.
    OutputClosed,
}

impl Failure {
    /// Wrong input.
    pub(crate) fn input(error: impl Into<anyhow::Error>) -> Self {
        Self::Input(error.into())
    }

    /// Failed work.
    pub(crate) fn work(error: impl Into<anyhow::Error>) -> Self {
        Self::Work(error.into())
    }

    /// Refuses the first option that was given of some that do not count here; the reason follows its
    /// name.
    pub(crate) fn if_given(options: &[(&str, bool)], reason: &str) -> Result<(), Self> {
        let given = options.iter().find(|(_, given)| *given);
        given.map_or(Ok(()), |(option, _)| {
            Err(Self::Input(anyhow::anyhow!("{option} {reason}")))
        })
    }

    /// Prints one message and gives the exit code.
    pub(crate) fn report(self) -> ExitCode {
        let (message, code) = match self {
            Self::Input(error) => (format!("error: {error}"), 2),
            Self::Usage => return ExitCode::from(2),
            Self::Work(error) => (format!("error: {error}"), 1),
            Self::Stopped => ("stopped; nothing was written".to_owned(), STOPPED),
            Self::Paused(kept) => (format!("stopped; {kept}"), STOPPED),
            Self::OutputClosed => return ExitCode::SUCCESS,
        };
        say(&message);
        ExitCode::from(code)
    }
}

/// One line to standard error. Where nobody hears, the exit code still speaks.
#[expect(clippy::disallowed_methods, reason = "the one place")]
pub(crate) fn say(line: &str) {
    let line = foreign_text::escaped_lines(line);
    // A path that is escaped is longer than what was typed.
    let typed: usize = std::env::args_os().map(|it| it.len()).sum();
    let _ = writeln!(
        std::io::stderr(),
        "{}",
        foreign_text::bounded(&line, LONGEST_MESSAGE + 4 * typed)
    );
}

/// A result that cannot be written.
impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Self {
        Self::work(error)
    }
}

/// A result folder that cannot be put in its place.
impl From<OutputError> for Failure {
    fn from(error: OutputError) -> Self {
        Self::work(error)
    }
}

/// Errors of writing a command's result to standard output.
impl From<std::io::Error> for Failure {
    fn from(error: std::io::Error) -> Self {
        if error.kind() == std::io::ErrorKind::BrokenPipe {
            Self::OutputClosed
        } else {
            Self::Work(anyhow::anyhow!("cannot write to standard output: {error}"))
        }
    }
}
