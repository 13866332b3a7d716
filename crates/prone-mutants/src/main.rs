//! Mutants of every file that prone reads, by the hundred thousand, or one by its number.

#![expect(
    clippy::disallowed_methods,
    reason = "a tool for developers, which prints no foreign text"
)]

use std::io::{IsTerminal as _, Write as _};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context as _, bail};
use clap::Parser;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;

use prone_mutants::Format;
use prone_mutants::campaign::{self, Door, Tally};
use prone_mutants::program::{self, STOPPED};
use prone_mutants::reading::Reader;

/// Reads mutants of files, and tells which of them end as no file may.
#[derive(Debug, Parser)]
struct Args {
    /// Mutants of each format
    #[arg(long, value_name = "N", default_value_t = 1000)]
    mutants: u64,
    /// Number of the first mutant
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Formats, by commas [default: all]
    #[arg(long, value_name = "FORMAT", value_delimiter = ',')]
    format: Vec<String>,
    /// The program: mutants go through it instead of through the readers
    #[arg(long, value_name = "FILE")]
    program: Option<PathBuf>,
    /// Ends after so long, whatever --mutants says; every format gets its share
    #[arg(long, value_name = "SECONDS")]
    seconds: Option<u64>,
    /// Formats at once
    #[arg(long, value_name = "N", default_value_t = 1)]
    jobs: usize,
    /// Prints the mutant of --seed and --format, and reads nothing
    #[arg(long)]
    show: bool,
    /// Prints the counts as JSON
    #[arg(long)]
    json: bool,
    /// What the child of a campaign does
    #[arg(long, value_name = "FORMAT", hide = true)]
    read: Option<String>,
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(2)
        }
    }
}

fn named(name: &str) -> anyhow::Result<Format> {
    let names: Vec<&str> = Format::ALL.iter().map(|format| format.name()).collect();
    Format::named(name)
        .with_context(|| format!("no format {name:?}; there are {}", names.join(", ")))
}

fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let seeds = args.seed..args.seed.saturating_add(args.mutants);
    program::limit().context("cannot limit the memory of this process")?;
    if let Some(name) = &args.read {
        campaign::read(named(name)?, seeds)?;
        return Ok(ExitCode::SUCCESS);
    }
    let formats: Vec<Format> = if args.format.is_empty() {
        Format::ALL.to_vec()
    } else {
        args.format
            .iter()
            .map(|name| named(name))
            .collect::<Result<_, _>>()?
    };
    if args.show {
        let [format] = formats[..] else {
            bail!("--show needs one --format")
        };
        std::io::stdout().write_all(Reader::new(format)?.mutant(args.seed).as_bytes())?;
        return Ok(ExitCode::SUCCESS);
    }
    let door = match &args.program {
        Some(program) => Door::Program(
            program
                .canonicalize()
                .with_context(|| format!("no {}", program.display()))?,
        ),
        None => Door::Readers,
    };
    let mut signals = Signals::new([SIGHUP, SIGINT, SIGTERM])?;
    thread::spawn(move || {
        for _ in signals.forever() {
            STOPPED.store(true, Ordering::Relaxed);
        }
    });
    let tallies: Vec<Mutex<Tally>> = formats
        .iter()
        .map(|format| Mutex::new(Tally::new(*format, &door)))
        .collect();
    let failures = work(args, &formats, &door, &tallies, &seeds);
    let tallies: Vec<Tally> = tallies
        .into_iter()
        .filter_map(|tally| tally.into_inner().ok())
        .collect();
    print(args, &tallies)?;
    if let Some(failure) = failures.into_iter().next() {
        return Err(failure);
    }
    if STOPPED.load(Ordering::Relaxed) {
        return Ok(ExitCode::from(130));
    }
    let wrong = tallies.iter().any(|tally| tally.wrong > 0);
    Ok(if wrong {
        ExitCode::FAILURE
    } else {
        ExitCode::SUCCESS
    })
}

/// Takes the formats one after another, `--jobs` at once.
fn work(
    args: &Args,
    formats: &[Format],
    door: &Door,
    tallies: &[Mutex<Tally>],
    seeds: &std::ops::Range<u64>,
) -> Vec<anyhow::Error> {
    let (next, done) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let failures = Mutex::new(Vec::new());
    let jobs = args.jobs.clamp(1, formats.len());
    // Each format has its share of the time, so that all of them have their turn.
    let share = args
        .seconds
        .map(|seconds| Duration::from_secs(seconds).mul_f64(jobs as f64 / formats.len() as f64));
    thread::scope(|scope| {
        for _ in 0..jobs {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let (Some(format), Some(tally)) = (formats.get(index), tallies.get(index))
                    else {
                        break;
                    };
                    let until = share.map(|share| Instant::now() + share);
                    if let Err(error) = campaign::run(*format, door, seeds.clone(), until, tally)
                        && let Ok(mut failures) = failures.lock()
                    {
                        failures.push(anyhow::Error::new(error).context(format.name()));
                    }
                }
                done.fetch_add(1, Ordering::Relaxed);
            });
        }
        let terminal = std::io::stderr().is_terminal();
        while done.load(Ordering::Relaxed) < jobs {
            thread::sleep(Duration::from_millis(100));
            if terminal {
                let sums = tallies
                    .iter()
                    .filter_map(|tally| tally.lock().ok().map(|tally| (tally.ran, tally.wrong)));
                let (ran, wrong) = sums.fold((0, 0), |sum, one| (sum.0 + one.0, sum.1 + one.1));
                eprint!("\r{ran} mutants, {wrong} wrong ");
            }
        }
        if terminal {
            eprintln!();
        }
    });
    failures.into_inner().unwrap_or_default()
}

fn print(args: &Args, tallies: &[Tally]) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    if args.json {
        serde_json::to_writer_pretty(&mut out, tallies)?;
        return Ok(writeln!(out)?);
    }
    writeln!(
        out,
        "{:<16} {:>8} {:>8} {:>6}  {:>18}  {:>18}",
        "format", "mutants", "accepted", "wrong", "slowest", "largest"
    )?;
    for tally in tallies {
        let (slow, seconds) = tally.slowest;
        let (large, megabytes) = tally.largest;
        writeln!(
            out,
            "{:<16} {:>8} {:>8} {:>6}  {seconds:>7.3} s of {slow:<7} {megabytes:>5} MB of {large:<7}",
            tally.format, tally.ran, tally.accepted, tally.wrong
        )?;
        for found in tally.found.iter().take(20) {
            writeln!(
                out,
                "  --format {} --seed {}: {}",
                tally.format, found.seed, found.what
            )?;
        }
    }
    Ok(())
}
