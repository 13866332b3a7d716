//! What every command that reads a record refuses and says alike.

use std::path::{Path, PathBuf};

use anyhow::anyhow;

use prone_record::output;

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
    let shown = out.display();
    if out.is_dir() {
        return Err(Failure::Input(anyhow!(
            "--out {shown} is a folder: name a file in it"
        )));
    }
    // What is written is what a link leads to.
    let linked = out.canonicalize().ok();
    let folder = match linked.as_deref().unwrap_or(out).parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let folder = folder
        .canonicalize()
        .map_err(|error| Failure::Input(anyhow!("cannot write {shown}: {error}")))?;
    let result = result(run)?;
    if folder.starts_with(&result) {
        return Err(Failure::Input(anyhow!(
            "{shown} is inside {}, which keeps its own files only",
            result.display()
        )));
    }
    Ok(())
}

/// The result folder that a record is, or is part of: its real path.
pub(crate) fn result(run: &Path) -> Result<PathBuf, Failure> {
    let real = run.canonicalize();
    let real = real.map_err(|error| Failure::Input(anyhow!("{}: {error}", run.display())))?;
    Ok(output::result_around(&real))
}
