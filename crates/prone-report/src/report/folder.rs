//! A result folder: what it says of itself, and its files.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use serde_json::Value;

use prone::foreign_text;

use super::ReportError;
use super::cut_table::CutTable;
use crate::figures::FigureError;
use prone_files::text_file;
use prone_record::figure_entry::{FIGURES_FILE, FigureEntry};
use prone_record::head::Head;
use prone_record::output::RUN_FILE;

/// How a folder came to be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Given {
    /// The user named it.
    Named,
    /// It is in one that the user named.
    Within,
}

/// A result folder of this version of the program.
#[derive(Debug, Clone)]
pub struct Folder {
    /// How it is called in the report.
    pub name: String,
    /// Where it is.
    pub path: PathBuf,
    pub(super) given: Given,
    /// What made it.
    pub head: Head,
    run: Value,
}

impl Folder {
    pub(super) fn open(name: &str, path: &Path, given: Given) -> Result<Self, ReportError> {
        let (head, run) = Head::read(path)?;
        Ok(Self {
            name: name.to_owned(),
            path: path.to_owned(),
            given,
            head,
            run,
        })
    }

    /// Folders of records within this one.
    pub fn records(&self) -> Vec<String> {
        let mut found = Vec::new();
        for group in ["crawls", "pulls"] {
            let entries = fs::read_dir(self.path.join(group)).into_iter().flatten();
            let folders = entries
                .filter_map(Result::ok)
                // Not a link, which may lead back here.
                .filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_dir()))
                .filter(|entry| entry.path().join(RUN_FILE).is_file());
            let names = folders.map(|entry| entry.file_name().to_string_lossy().into_owned());
            found.extend(names.map(|name| format!("{group}/{name}")));
        }
        found.sort();
        found
    }

    /// All of `run.json`.
    ///
    /// # Errors
    /// [`ReportError`] where it is not what that command writes.
    pub fn run<T: DeserializeOwned>(&self) -> Result<T, ReportError> {
        serde_json::from_value(self.run.clone()).map_err(|source| ReportError::Json {
            file: self.path.join(RUN_FILE),
            source,
        })
    }

    /// A JSON file.
    pub fn json<T: DeserializeOwned>(&self, file: &str) -> Result<T, ReportError> {
        serde_json::from_slice(&self.bytes(file)?).map_err(|source| ReportError::Json {
            file: self.path.join(file),
            source,
        })
    }

    /// A table, up to where it breaks off.
    pub fn table(&self, file: &str) -> Result<CutTable, ReportError> {
        // What breaks off may break off within a letter.
        let bytes = self.bytes(file)?;
        Ok(CutTable::read(
            self.path.join(file),
            format!("{}/{file}", self.name),
            &String::from_utf8_lossy(&bytes),
        ))
    }

    /// A file as it is.
    pub fn bytes(&self, file: &str) -> Result<Vec<u8>, ReportError> {
        let path = self.path.join(file);
        let read = text_file::read_within(&self.path, file, text_file::LARGEST_TABLE_BYTES);
        read.map_err(|source| match source.kind() {
            ErrorKind::NotFound => ReportError::Missing {
                folder: self.path.clone(),
                file: file.to_owned(),
            },
            _ => ReportError::Read { file: path, source },
        })
    }

    /// What `run.json` lists and the folder does not hold, as a sentence.
    pub(super) fn absent(&self) -> Option<String> {
        let listed = self.run.get("artefacts").and_then(Value::as_array);
        let listed = listed.into_iter().flatten().filter_map(Value::as_str);
        let absent: Vec<&str> = listed
            .filter(|file| !self.path.join(file).is_file())
            .collect();
        let (first, more) = (absent.first()?, absent.len() - 1);
        let more = match more {
            0 => String::new(),
            1 => " and 1 file more".to_owned(),
            more => format!(" and {more} files more"),
        };
        let first = foreign_text::cut(first);
        Some(format!(
            "{}: {first}{more} that its {RUN_FILE} lists are not there",
            self.name
        ))
    }

    /// The drawings and pictures that the command made.
    pub fn figures(&self) -> Result<Vec<FigureEntry>, ReportError> {
        self.json(FIGURES_FILE)
    }

    /// What was drawn of this folder; an error says that it was of this one.
    ///
    /// # Errors
    /// [`ReportError`] where it could not be drawn.
    pub fn drawn<T>(&self, figures: Result<T, FigureError>) -> Result<T, ReportError> {
        figures.map_err(|source| ReportError::Figure {
            run: self.name.clone(),
            source,
        })
    }
}
