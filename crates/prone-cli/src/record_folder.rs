//! What every command that reads a record refuses and says alike.

use std::path::{Path, PathBuf};

use anyhow::anyhow;

use prone_record::output;
use prone_record::real_path::real_path;

use crate::Failure;

/// Fails with what is missing of some records, if anything is: after what could be read is written.
pub(crate) fn say_incomplete(records: &[(impl AsRef<Path>, Vec<String>)]) -> Result<(), Failure> {
    let sentences = records.iter().flat_map(|(folder, shortfalls)| {
        let folder = folder.as_ref().display();
        shortfalls
            .iter()
            .map(move |shortfall| format!("{folder}: {shortfall}"))
    });
    say_missing(&sentences.collect::<Vec<_>>())
}

/// The same of sentences that name their files.
pub(crate) fn say_missing(sentences: &[String]) -> Result<(), Failure> {
    if sentences.is_empty() {
        return Ok(());
    }
    Err(Failure::Input(anyhow!("{}", sentences.join("\n       "))))
}

/// Refuses a file that is to be made of a record where a folder is, and in the record or the result
/// that it is part of: one file more, and the next result would not replace it.
pub(crate) fn check_place(out: &Path, run: &Path) -> Result<(), Failure> {
    let folder = folder_of("--out", out)?;
    let result = result(run)?;
    if folder.starts_with(&result) {
        return Err(inside(out, &result));
    }
    Ok(())
}

/// Refuses a folder that is to be made of a record, in the record or the result that it is part of.
pub(crate) fn check_folder_place(out: &Path, run: &Path) -> Result<(), Failure> {
    let result = result(run)?;
    let real = real_path(out).map_err(Failure::input)?;
    if real.starts_with(&result) {
        return Err(inside(out, &result));
    }
    Ok(())
}

/// Refuses a file in any result folder, for a command that reads none.
pub(crate) fn check_outside(option: &str, out: &Path) -> Result<(), Failure> {
    match output::result_with(&folder_of(option, out)?) {
        None => Ok(()),
        Some(result) => Err(inside(out, &result)),
    }
}

fn inside(out: &Path, result: &Path) -> Failure {
    Failure::Input(anyhow!(
        "{} is inside {}, which keeps its own files only",
        out.display(),
        result.display()
    ))
}

/// The real path of the folder that a file is to be written in.
fn folder_of(option: &str, out: &Path) -> Result<PathBuf, Failure> {
    let shown = out.display();
    if out.is_dir() {
        return Err(Failure::Input(anyhow!(
            "{option} {shown} is a folder: name a file in it"
        )));
    }
    // What is written is what a link leads to.
    let linked = out.canonicalize().ok();
    let folder = match linked.as_deref().unwrap_or(out).parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    folder
        .canonicalize()
        .map_err(|error| Failure::Input(anyhow!("cannot write {shown}: {error}")))
}

/// The result folder that a record is, or is part of: its real path.
pub(crate) fn result(run: &Path) -> Result<PathBuf, Failure> {
    let real = run.canonicalize();
    let real = real.map_err(|error| Failure::Input(anyhow!("{}: {error}", run.display())))?;
    Ok(output::result_around(&real))
}
