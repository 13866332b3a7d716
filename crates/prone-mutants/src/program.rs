//! Runs the program as a child, within limits, and judges how it ended.

use std::fs::File;
use std::io::{self, Read as _};
use std::os::unix::process::ExitStatusExt as _;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

use rustix::process::{Pid, Resource, Rlimit, Signal, kill_process, setrlimit};
use wait4::Wait4 as _;

/// How long one run may take.
pub const LONGEST: Duration = Duration::from_secs(20);
/// How much memory one run may have resident, bytes.
pub const MOST_MEMORY: u64 = 1 << 30;
/// How much may be said about one wrong file, bytes.
pub const LONGEST_MESSAGE: usize = 10_000;
/// A child that asks for more ends before the machine does.
const ADDRESS_SPACE: u64 = 8 << 30;

/// Set by whoever is asked to stop: children are ended at once.
pub static STOPPED: AtomicBool = AtomicBool::new(false);

/// How a run ended.
#[derive(Debug, Clone)]
pub struct Ended {
    /// The exit code; `None` after a signal.
    pub code: Option<i32>,
    /// The signal.
    pub signal: Option<i32>,
    /// Whether it was ended because it took too long.
    pub overdue: bool,
    /// Wall time.
    pub took: Duration,
    /// Largest resident memory, bytes.
    pub memory: u64,
    /// What it said on standard error.
    pub said: String,
}

/// Limits this process and its children: address space, and no core files.
///
/// # Errors
/// [`io::Error`].
pub fn limit() -> io::Result<()> {
    let at_most = |bytes| Rlimit {
        current: Some(bytes),
        maximum: Some(bytes),
    };
    setrlimit(Resource::As, at_most(ADDRESS_SPACE))?;
    setrlimit(Resource::Core, at_most(0))?;
    Ok(())
}

/// Runs a program to its end, or for [`LONGEST`].
///
/// # Errors
/// [`io::Error`] where it cannot be run.
pub fn run(program: &Path, arguments: &[String], folder: &Path) -> io::Result<Ended> {
    // A file, not a pipe: whoever writes much into it does not wait for a reader.
    let said = tempfile::NamedTempFile::new()?;
    let begun = Instant::now();
    let child = Command::new(program)
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(said.reopen()?)
        .spawn()?;
    let pid = i32::try_from(child.id()).ok().and_then(Pid::from_raw);
    let (done, waiting) = mpsc::channel::<()>();
    let watch = thread::spawn(move || {
        let tick = Duration::from_millis(50);
        while waiting.recv_timeout(tick) == Err(RecvTimeoutError::Timeout) {
            let overdue = begun.elapsed() > LONGEST;
            if overdue || STOPPED.load(Ordering::Relaxed) {
                let _ = pid.map(|pid| kill_process(pid, Signal::KILL));
                return overdue;
            }
        }
        false
    });
    let ended = child.wait4();
    let took = begun.elapsed();
    drop(done);
    let overdue = watch.join().unwrap_or(false);
    let ended = ended?;
    let mut bytes = Vec::new();
    let limit = 4 * LONGEST_MESSAGE as u64;
    File::open(said.path())?
        .take(limit)
        .read_to_end(&mut bytes)?;
    Ok(Ended {
        code: ended.status.code(),
        signal: ended.status.signal(),
        overdue,
        took,
        memory: ended.rusage.maxrss,
        said: String::from_utf8_lossy(&bytes).into_owned(),
    })
}

impl Ended {
    /// What must not be, in a few words; nothing for a run that ended as it may.
    pub fn wrong(&self) -> Option<String> {
        let control = |letter: &char| letter.is_control() && *letter != '\n';
        let turning = |letter: &char| {
            ('\u{202a}'..='\u{202e}').contains(letter) || ('\u{2066}'..='\u{2069}').contains(letter)
        };
        if self.overdue {
            return Some(format!("not ended after {} s", LONGEST.as_secs()));
        }
        if let Some(signal) = self.signal {
            return Some(format!("ended by signal {signal}"));
        }
        if self.memory > MOST_MEMORY {
            return Some(format!("{} MB of memory", self.memory >> 20));
        }
        match self.code {
            Some(1 | 2) if self.said.trim().is_empty() => {
                return Some("failed without a word".to_owned());
            }
            Some(0..=2) => {}
            code => {
                return Some(format!(
                    "exit code {}: {}",
                    code.unwrap_or(-1),
                    self.first_line()
                ));
            }
        }
        if self.said.contains("panicked at") {
            return Some(format!("panic: {}", self.first_line()));
        }
        if self.said.len() > LONGEST_MESSAGE {
            return Some(format!("a message of {} bytes or more", self.said.len()));
        }
        let letter = self
            .said
            .chars()
            .find(|letter| control(letter) || turning(letter))?;
        Some(format!("{letter:?} is printed to the terminal"))
    }

    /// The beginning of what it said.
    pub fn first_line(&self) -> String {
        let line = self.said.lines().next().unwrap_or_default();
        line.chars()
            .take(200)
            .flat_map(char::escape_debug)
            .collect()
    }
}
