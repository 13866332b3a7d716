//! A CSV file that may break off.

use std::fs;
use std::path::Path;

use super::record::ViewError;

/// A CSV file up to where it breaks off.
pub(super) struct Table {
    pub(super) header: csv::StringRecord,
    pub(super) records: Vec<csv::StringRecord>,
    /// The first record that is not whole, from 0.
    pub(super) broken: Option<usize>,
}

impl Table {
    /// Reads all whole records.
    pub(super) fn read(path: &Path) -> Result<Self, ViewError> {
        let text = text(path)?;
        // A last line without its end may have lost digits.
        let whole = text.rfind('\n').map_or("", |end| &text[..=end]);
        let mut reader = csv::Reader::from_reader(whole.as_bytes());
        let header = reader
            .headers()
            .cloned()
            .map_err(|error| ViewError::Damaged {
                file: path.to_owned(),
                reason: error.to_string(),
            })?;
        let mut records = Vec::new();
        let mut broken = None;
        for record in reader.records() {
            let Ok(record) = record else {
                broken = Some(records.len());
                break;
            };
            records.push(record);
        }
        if broken.is_none() && whole.len() < text.len() {
            broken = Some(records.len());
        }
        Ok(Self {
            header,
            records,
            broken,
        })
    }

    /// Where a column stands.
    pub(super) fn column(&self, name: &str) -> Option<usize> {
        self.header.iter().position(|column| column == name)
    }
}

/// A field that is empty is not a number; one that holds something else is damage.
pub(super) fn number(field: &str) -> Option<f64> {
    if field.is_empty() {
        return Some(f64::NAN);
    }
    field.parse().ok()
}

/// A file's text.
pub(super) fn text(path: &Path) -> Result<String, ViewError> {
    let bytes = fs::read(path).map_err(|source| ViewError::Read {
        file: path.to_owned(),
        source,
    })?;
    // What is cut within a letter is cut in its line too.
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
