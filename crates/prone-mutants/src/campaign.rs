//! Many mutants of one format: within a child of this program, which may die of one, or through the
//! program itself.

use std::io::{self, BufRead as _, BufReader, Write as _};
use std::panic;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use serde::Serialize;
use wait4::Wait4 as _;

use crate::commands;
use crate::format::Format;
use crate::program::{LONGEST, MOST_MEMORY, STOPPED};
use crate::reading::{Answer, Reader};
use crate::seeds::Seeds;

/// Findings of a format that are kept; a thousand of one kind say no more.
const MOST_FINDINGS: usize = 200;
/// With what a child ends that has waited too long for a reader.
const OVERDUE: i32 = 70;

/// By what mutants are read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Door {
    /// The readers, within a child of this program.
    Readers,
    /// The program.
    Program(PathBuf),
}

/// Something that must not be.
#[derive(Debug, Clone, Serialize)]
pub struct Found {
    /// The number of the mutant.
    pub seed: u64,
    /// What it did.
    pub what: String,
}

/// What came out of the mutants of one format.
#[derive(Debug, Clone, Serialize)]
pub struct Tally {
    /// The format's name.
    pub format: &'static str,
    /// `readers` or `program`.
    pub door: &'static str,
    /// How many mutants were read.
    pub ran: u64,
    /// How many of them were accepted.
    pub accepted: u64,
    /// Which one took longest, and how long, s.
    pub slowest: (u64, f64),
    /// Which one needed most memory, and how much, MB.
    pub largest: (u64, u64),
    /// How many did what must not be.
    pub wrong: u64,
    /// The first of them.
    pub found: Vec<Found>,
}

impl Tally {
    /// Nothing yet.
    pub const fn new(format: Format, door: &Door) -> Self {
        let door = match door {
            Door::Readers => "readers",
            Door::Program(_) => "program",
        };
        Self {
            format: format.name(),
            door,
            ran: 0,
            accepted: 0,
            slowest: (0, 0.0),
            largest: (0, 0),
            wrong: 0,
            found: Vec::new(),
        }
    }

    fn add(
        &mut self,
        seed: u64,
        accepted: bool,
        took: Duration,
        memory: u64,
        wrong: Option<String>,
    ) {
        self.ran += 1;
        self.accepted += u64::from(accepted);
        if took.as_secs_f64() > self.slowest.1 {
            self.slowest = (seed, took.as_secs_f64());
        }
        if memory >> 20 > self.largest.1 {
            self.largest = (seed, memory >> 20);
        }
        let Some(what) = wrong else { return };
        self.wrong += 1;
        if self.found.len() < MOST_FINDINGS {
            self.found.push(Found { seed, what });
        }
    }
}

/// Runs the mutants of a range of numbers until a time, and keeps count as it goes.
///
/// # Errors
/// [`io::Error`] of the harness.
pub fn run(
    format: Format,
    door: &Door,
    seeds: std::ops::Range<u64>,
    until: Option<Instant>,
    tally: &Mutex<Tally>,
) -> io::Result<()> {
    match door {
        Door::Readers => {
            let mut next = seeds.start;
            while next < seeds.end && !over(until) {
                next = child(format, next..seeds.end, until, tally)?;
            }
            Ok(())
        }
        Door::Program(program) => through(program, format, seeds, until, tally),
    }
}

fn over(until: Option<Instant>) -> bool {
    STOPPED.load(Ordering::Relaxed) || until.is_some_and(|until| Instant::now() > until)
}

fn through(
    program: &Path,
    format: Format,
    seeds: std::ops::Range<u64>,
    until: Option<Instant>,
    tally: &Mutex<Tally>,
) -> io::Result<()> {
    let shipped = Seeds::of_repository();
    let mut texts = shipped.texts(format)?;
    if format == Format::Checkpoint {
        // The plan has the commit of the program.
        texts = vec![commands::state(program, &shipped.bed()?)?];
    }
    let texts: Vec<&str> = texts.iter().map(String::as_str).collect();
    let mut bed = shipped.bed()?;
    for seed in seeds {
        if over(until) {
            return Ok(());
        }
        bed.put(format, &crate::mutant(format, &texts, seed))?;
        let (ended, wrong) = commands::run(program, &bed, format, seed)?;
        if STOPPED.load(Ordering::Relaxed) {
            return Ok(());
        }
        locked(tally).add(seed, ended.code == Some(0), ended.took, ended.memory, wrong);
        if format == Format::Checkpoint {
            // A search that went on has replaced its folder.
            bed = shipped.bed()?;
        }
    }
    Ok(())
}

fn locked(tally: &Mutex<Tally>) -> std::sync::MutexGuard<'_, Tally> {
    tally
        .lock()
        .unwrap_or_else(std::sync::PoisonError::into_inner)
}

/// A child reads mutants and writes a line before and one after each. Returns the number to go on from.
fn child(
    format: Format,
    seeds: std::ops::Range<u64>,
    until: Option<Instant>,
    tally: &Mutex<Tally>,
) -> io::Result<u64> {
    let mut child = Command::new(std::env::current_exe()?)
        .args([
            "--read",
            format.name(),
            "--seed",
            &seeds.start.to_string(),
            "--mutants",
        ])
        .arg((seeds.end - seeds.start).to_string())
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()?;
    let mut at = (seeds.start, Instant::now());
    for line in BufReader::new(child.stdout.take().ok_or(io::ErrorKind::BrokenPipe)?).lines() {
        let line = line?;
        let mut words = line.splitn(5, ' ');
        let kind = words.next().unwrap_or_default();
        let mut number = || {
            words
                .next()
                .and_then(|word| word.parse::<u64>().ok())
                .unwrap_or(0)
        };
        let seed = number();
        if kind == "begin" {
            at = (seed, Instant::now());
            continue;
        }
        let (micros, memory) = (number(), number());
        let too_large = (memory > MOST_MEMORY).then(|| format!("{} MB of memory", memory >> 20));
        let wrong = (kind == "wrong").then(|| words.next().unwrap_or_default().to_owned());
        locked(tally).add(
            seed,
            kind == "read",
            Duration::from_micros(micros),
            memory,
            wrong.or(too_large),
        );
        at.0 = seed + 1;
        if over(until) {
            let _ = child.kill();
            child.wait()?;
            return Ok(seeds.end);
        }
    }
    let ended = child.wait4()?.status;
    if ended.success() || STOPPED.load(Ordering::Relaxed) {
        return Ok(seeds.end);
    }
    let what = match ended.code() {
        Some(OVERDUE) => format!("not read after {} s", LONGEST.as_secs()),
        _ => format!("the process ended: {ended}"),
    };
    locked(tally).add(at.0, false, at.1.elapsed(), 0, Some(what));
    Ok(at.0 + 1)
}

/// What such a child does.
///
/// # Errors
/// [`io::Error`] of the harness.
pub fn read(format: Format, seeds: std::ops::Range<u64>) -> io::Result<()> {
    let reader = Reader::new(format)?;
    panic::set_hook(Box::new(|_| ()));
    let busy_since = Arc::new(AtomicU64::new(0));
    let begun = Instant::now();
    let watched = Arc::clone(&busy_since);
    thread::spawn(move || {
        loop {
            thread::sleep(Duration::from_millis(100));
            let since = Duration::from_millis(watched.load(Ordering::Relaxed));
            if begun.elapsed().saturating_sub(since) > LONGEST {
                std::process::exit(OVERDUE);
            }
        }
    });
    #[expect(
        clippy::disallowed_methods,
        reason = "numbers, to the process that began this one"
    )]
    let mut out = io::stdout().lock();
    for seed in seeds {
        let text = reader.mutant(seed);
        writeln!(out, "begin {seed}")?;
        out.flush()?;
        forget_peak();
        let at = Instant::now();
        busy_since.store(
            u64::try_from(begun.elapsed().as_millis()).unwrap_or(u64::MAX),
            Ordering::Relaxed,
        );
        let read = panic::catch_unwind(panic::AssertUnwindSafe(|| reader.read(&text)));
        let (kind, what) = match read {
            Ok(Ok(Answer::Read)) => ("read", String::new()),
            Ok(Ok(Answer::Refused(_))) => ("refused", String::new()),
            Ok(Err(finding)) => ("wrong", finding.to_string()),
            Err(panic) => {
                let text = panic.downcast_ref::<String>().cloned();
                let text =
                    text.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()));
                ("wrong", format!("panic: {}", text.unwrap_or_default()))
            }
        };
        let what: String = what
            .chars()
            .take(300)
            .flat_map(char::escape_debug)
            .collect();
        writeln!(
            out,
            "{kind} {seed} {} {} {what}",
            at.elapsed().as_micros(),
            peak()
        )?;
        out.flush()?;
    }
    // Without what a thread holds, and without running destructors of the engine.
    Ok(())
}

/// Largest resident memory since [`forget_peak`], bytes; 0 where the system does not tell.
fn peak() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes = line.and_then(|line| line.split_whitespace().next()?.parse::<u64>().ok());
    kilobytes.unwrap_or(0) << 10
}

fn forget_peak() {
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}
