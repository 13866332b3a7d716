//! A result folder: what it says of itself, and its files.

use std::fs;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use serde_json::Value;

use super::ReportError;
use super::cut_table::CutTable;
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
    /// All of `run.json`.
    pub run: Value,
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

    /// A word or number of `run.json`.
    pub fn said(&self, pointer: &str) -> Option<String> {
        match self.run.pointer(pointer)? {
            Value::Null => None,
            Value::String(text) => Some(text.clone()),
            other => Some(other.to_string()),
        }
    }

    /// Folders of records within this one.
    pub fn records(&self) -> Vec<String> {
        let mut found = Vec::new();
        for group in ["crawls", "pulls"] {
            let Ok(entries) = fs::read_dir(self.path.join(group)) else {
                continue;
            };
            let folders = entries
                .filter_map(Result::ok)
                // Not a link, which may lead back here.
                .filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_dir()))
                .filter(|entry| entry.path().join(RUN_FILE).is_file());
            found.extend(
                folders.map(|entry| format!("{group}/{}", entry.file_name().to_string_lossy())),
            );
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
    ///
    /// # Errors
    /// [`ReportError`] where it is missing or malformed.
    pub fn json<T: DeserializeOwned>(&self, file: &str) -> Result<T, ReportError> {
        let path = self.file(file)?;
        serde_json::from_str(&text(&path)?)
            .map_err(|source| ReportError::Json { file: path, source })
    }

    /// A table, up to where it breaks off.
    ///
    /// # Errors
    /// [`ReportError`] where it is missing.
    pub fn table(&self, file: &str) -> Result<CutTable, ReportError> {
        let path = self.file(file)?;
        // What breaks off may break off within a letter.
        let bytes = fs::read(&path).map_err(|source| ReportError::Read {
            file: path.clone(),
            source,
        })?;
        Ok(CutTable::read(
            path,
            format!("{}/{file}", self.name),
            &String::from_utf8_lossy(&bytes),
        ))
    }

    /// A file as it is.
    ///
    /// # Errors
    /// [`ReportError`] where it is missing.
    pub fn bytes(&self, file: &str) -> Result<Vec<u8>, ReportError> {
        let path = self.file(file)?;
        fs::read(&path).map_err(|source| ReportError::Read { file: path, source })
    }

    /// The drawings and pictures that the command made.
    ///
    /// # Errors
    /// [`ReportError`] where its list is missing or malformed.
    pub fn figures(&self) -> Result<Vec<FigureEntry>, ReportError> {
        self.json(FIGURES_FILE)
    }

    fn file(&self, file: &str) -> Result<PathBuf, ReportError> {
        let path = self.path.join(file);
        if path.exists() {
            Ok(path)
        } else {
            Err(ReportError::Missing {
                folder: self.path.clone(),
                file: file.to_owned(),
            })
        }
    }
}

fn text(file: &Path) -> Result<String, ReportError> {
    fs::read_to_string(file).map_err(|source| ReportError::Read {
        file: file.to_owned(),
        source,
    })
}
