//! What stands where a result is to go, and whether it may be replaced.
//!
//! A folder is an earlier result if `run.json` in it says that prone wrote it, and if every file
//! below it is on the list `artefacts` that [`record`] puts there. One file more, and it is left
//! alone.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::Path;

use prone::foreign_text::escaped_json;
use serde::Deserialize;

use prone_files::text_file;

use super::{Artefacts, OutputError, RUN_FILE, write_error};

/// The largest `run.json` that is read; ours have a few kilobytes.
const LARGEST_RUN_FILE: u64 = 16 << 20;

/// What stands at a place, if it is no stranger.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Standing {
    /// Nothing.
    Nothing,
    /// An empty folder or an earlier result.
    Replaceable,
}

/// The part of `run.json` by which a result is known.
#[derive(Deserialize)]
struct Record {
    program: String,
    artefacts: BTreeSet<String>,
}

/// What a `run.json` must hold before the list is added: an entry, so that a comma fits behind it.
#[derive(Deserialize)]
struct Unlisted {
    #[expect(dead_code, reason = "only its presence counts")]
    program: String,
}

/// Looks at a place; links are not followed.
pub(super) fn standing(folder: &Path) -> Result<Standing, OutputError> {
    match fs::symlink_metadata(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Standing::Nothing),
        Err(error) => return Err(write_error(folder, error)),
        Ok(found) if !found.is_dir() => {
            return Err(OutputError::NotAFolder {
                folder: folder.to_owned(),
            });
        }
        Ok(_) => {}
    }
    let stranger = match stranger(folder) {
        Ok(None) => return Ok(Standing::Replaceable),
        Ok(Some(stranger)) => stranger,
        Err(error) => return Err(write_error(folder, error)),
    };
    Err(OutputError::Foreign {
        folder: folder.to_owned(),
        stranger,
    })
}

/// The command that a result names as the one that made it.
pub(super) fn command(result: &Path) -> Option<String> {
    #[derive(Deserialize)]
    struct Made {
        command: String,
    }
    let bytes = text_file::read_bytes(&result.join(RUN_FILE), LARGEST_RUN_FILE).ok()?;
    let made: Made = serde_json::from_slice(&bytes).ok()?;
    Some(made.command)
}

/// Whether a result's list names a file in a folder below it.
pub(super) fn lists_files_in(result: &Path, folder: &Path) -> bool {
    let Ok(below) = folder.strip_prefix(result) else {
        return false;
    };
    let run_file = result.join(RUN_FILE);
    let record = text_file::read_bytes(&run_file, LARGEST_RUN_FILE).ok();
    let record = record.and_then(|bytes| serde_json::from_slice::<Record>(&bytes).ok());
    record.is_some_and(|record| {
        let mut files = record.artefacts.iter().map(Path::new);
        record.program == "prone" && files.any(|file| file.starts_with(below))
    })
}

/// What in a folder is not known to be ours, if anything.
fn stranger(folder: &Path) -> io::Result<Option<String>> {
    if fs::read_dir(folder)?.next().is_none() {
        return Ok(None);
    }
    let run_file = folder.join(RUN_FILE);
    match fs::symlink_metadata(&run_file) {
        Ok(found) if found.is_file() && found.len() <= LARGEST_RUN_FILE => {}
        _ => return Ok(Some(format!("it holds no {RUN_FILE}"))),
    }
    match serde_json::from_slice::<Record>(&text_file::read_bytes(&run_file, LARGEST_RUN_FILE)?) {
        Ok(record) if record.program == "prone" => unlisted(folder, "", &record.artefacts),
        _ => Ok(Some(format!(
            "its {RUN_FILE} does not list what prone wrote"
        ))),
    }
}

/// The first path below `folder`, itself at `prefix` of the result, that is not on the list.
fn unlisted(
    folder: &Path,
    prefix: &str,
    artefacts: &BTreeSet<String>,
) -> io::Result<Option<String>> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let path = format!("{prefix}{}", entry.file_name().to_string_lossy());
        let kind = entry.file_type()?;
        let below = format!("{path}/");
        let found = if kind.is_dir() && artefacts.iter().any(|name| name.starts_with(&below)) {
            unlisted(&entry.path(), &below, artefacts)?
        } else if kind.is_file() && artefacts.contains(&path) {
            None
        } else {
            Some(format!("prone did not write {path}"))
        };
        if found.is_some() {
            return Ok(found);
        }
    }
    Ok(None)
}

/// `run.json` with one entry more, the list of all files of the result; its other entries keep
/// their order and their digits.
pub(super) fn record(artefacts: &Artefacts) -> Result<Vec<u8>, OutputError> {
    let run = artefacts.get(RUN_FILE).map_or(&[][..], Vec::as_slice);
    let _: Unlisted = serde_json::from_slice(run).map_err(OutputError::Unrecorded)?;
    let names: Vec<&str> = artefacts.keys().map(String::as_str).collect();
    let list = serde_json::to_string_pretty(&names).map_err(OutputError::Unrecorded)?;
    let mut text = run.trim_ascii_end().to_vec();
    // The closing brace, and the line that it stood on.
    text.pop();
    text.truncate(text.trim_ascii_end().len());
    text.extend_from_slice(b",\n  \"artefacts\": ");
    text.extend_from_slice(escaped_json(&list).replace('\n', "\n  ").as_bytes());
    text.extend_from_slice(b"\n}\n");
    Ok(text)
}
