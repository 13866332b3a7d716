//! `prone report`.

use std::ffi::OsStr;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::anyhow;

use prone_record::output;
use prone_record::single_file;
use prone_report::report::{Arrangement, PAGE_FILE, Report, ReportError, Source};
use prone_thesis::chapter::Thesis;

use crate::args::ReportArgs;
use crate::outputs::{Files, Kind};
use crate::printed;
use crate::{Failure, interrupt, record_folder};

pub(crate) fn run(args: &ReportArgs) -> Result<(), Failure> {
    let sources = sources(&args.runs)?;
    let place = Place::of(&args.out);
    for source in sources.iter().filter(|source| source.folder.is_dir()) {
        match place {
            Place::Page(file) => record_folder::check_place(file, &source.folder)?,
            Place::Folder(folder) => refuse_overlap(folder, &source.folder)?,
        }
    }
    let kind = match place {
        Place::Page(_) => Kind::Lasting,
        Place::Folder(_) => Kind::Folder,
    };
    let read = sources.iter().map(|source| &source.folder);
    let read = read.fold(Files::default(), Files::reading);
    let files = read.writing("--out", &args.out, kind);
    files.check_made_by("report")?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(args.threads.map_or(0, usize::from))
        .build()
        .map_err(|error| Failure::Work(anyhow!("cannot start worker threads: {error}")))?;
    let arrangement = if args.chapter {
        Arrangement::Chapter
    } else {
        Arrangement::Runs
    };
    let report = pool
        .install(|| Report::from_folders(&sources, &Thesis, arrangement))
        .map_err(failure)?;
    match place {
        Place::Page(file) => {
            interrupt::publish(|| Ok(single_file::write(file, report.html.as_bytes())?))?;
        }
        Place::Folder(folder) => {
            let program = crate::program();
            let artefacts = pool
                .install(|| report.files(&program))
                .map_err(Failure::work)?;
            interrupt::publish(|| Ok(output::publish(folder, &artefacts)?))?;
        }
    }
    print(args, &report, &place.page())?;
    record_folder::say_missing(&report.numbers.shortfalls)
}

/// Where a report goes.
#[derive(Clone, Copy)]
enum Place<'a> {
    /// The page alone, into this file.
    Page(&'a Path),
    /// Page, figures and numbers, into this folder.
    Folder(&'a Path),
}

impl<'a> Place<'a> {
    fn of(out: &'a Path) -> Self {
        if out.extension() == Some(OsStr::new("html")) {
            Self::Page(out)
        } else {
            Self::Folder(out)
        }
    }

    /// The page's file.
    fn page(self) -> PathBuf {
        match self {
            Self::Page(file) => file.to_owned(),
            Self::Folder(folder) => folder.join(PAGE_FILE),
        }
    }
}

/// The folders under the names that were typed, each once.
fn sources(runs: &[PathBuf]) -> Result<Vec<Source>, Failure> {
    let mut sources: Vec<Source> = Vec::new();
    for run in runs {
        let name = run.display().to_string();
        let name = name.strip_suffix('/').unwrap_or(&name).to_owned();
        let real = fs::canonicalize(run).unwrap_or_else(|_| run.clone());
        let again = sources
            .iter()
            .find(|source| fs::canonicalize(&source.folder).is_ok_and(|folder| folder == real));
        if let Some(again) = again {
            return Err(Failure::Input(anyhow!(
                "{name} is the same folder as {}",
                again.name
            )));
        }
        sources.push(Source {
            name,
            folder: run.clone(),
        });
    }
    Ok(sources)
}

/// A result is replaced whole: nothing is put into one that is read, and none that holds one is
/// replaced.
fn refuse_overlap(out: &Path, run: &Path) -> Result<(), Failure> {
    let result = record_folder::result(run)?;
    let out_real = real(out);
    if out_real.starts_with(&result) || result.starts_with(&out_real) {
        return Err(Failure::Input(anyhow!(
            "--out {} and {}, which is read, are one in the other: a result is replaced whole",
            out.display(),
            run.display()
        )));
    }
    Ok(())
}

/// A path without links; what does not exist yet is appended to what does.
fn real(path: &Path) -> PathBuf {
    let mut missing = Vec::new();
    let mut above = path;
    loop {
        let place = if above.as_os_str().is_empty() {
            Path::new(".")
        } else {
            above
        };
        if let Ok(found) = fs::canonicalize(place) {
            return missing
                .iter()
                .rev()
                .fold(found, |path, name| path.join(name));
        }
        match (above.parent(), above.file_name()) {
            (Some(parent), Some(name)) => {
                missing.push(name.to_owned());
                above = parent;
            }
            _ => return path.to_owned(),
        }
    }
}

fn failure(error: ReportError) -> Failure {
    if error.is_input() {
        Failure::input(error)
    } else {
        Failure::work(error)
    }
}

fn print(args: &ReportArgs, report: &Report, page: &Path) -> Result<(), Failure> {
    let mut out = printed::out();
    if args.json {
        let text = prone_record::output::json_text(&report.numbers).map_err(Failure::work)?;
        writeln!(out, "{text}")?;
        return Ok(());
    }
    let numbers = &report.numbers;
    let (cards, megabytes) = (numbers.cards.len(), report.html.len() as f64 / 1e6);
    let figures = if args.chapter {
        let chapter = numbers.chapter_figures();
        let others = numbers.figures.iter();
        let others = others.filter(|figure| figure.number.is_empty()).count();
        format!(
            "{chapter} of {} figures of the chapter, {others} others",
            chapter + numbers.missing.len()
        )
    } else {
        format!("{} figures", numbers.figures.len())
    };
    let cards = match cards {
        1 => "1 report card".to_owned(),
        count => format!("{count} report cards"),
    };
    writeln!(out, "{figures}; {cards}; {megabytes:.2} MB")?;
    for missing in &numbers.missing {
        let made_by = missing
            .command
            .as_deref()
            .unwrap_or("a robot on the wire, not driven yet");
        writeln!(out, "  no figure {}: {made_by}", missing.number)?;
    }
    for gap in &numbers.unrecorded {
        writeln!(out, "  {gap}")?;
    }
    writeln!(out, "\nreport: {}", page.display())?;
    Ok(())
}
