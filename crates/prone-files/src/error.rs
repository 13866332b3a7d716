//! One error for all text files: where, and what.

use std::ops::Range;

use prone::foreign_text;

use crate::odd_toml;

/// What is wrong with a text file, and where.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{file}:{line}:{column}: {message}")]
pub struct FileError {
    /// The file as the user named it.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// What is wrong, in one line.
    pub message: String,
}

/// A text with the name it was read under, for errors that point into it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Source<'a> {
    pub(crate) file: &'a str,
    pub(crate) text: &'a str,
}

impl Source<'_> {
    /// Parses TOML into `T`.
    pub(crate) fn parse<T: serde::de::DeserializeOwned>(self) -> Result<T, FileError> {
        toml::from_str(self.text).map_err(|error| {
            let span = error.span().unwrap_or(0..0);
            let message = odd_toml::explained(self.text, span.clone())
                .unwrap_or_else(|| foreign_text::message(error.message()));
            self.error(span, message)
        })
    }

    /// An error at a byte range of the text.
    pub(crate) fn error(self, span: Range<usize>, message: impl std::fmt::Display) -> FileError {
        let (line, column) = line_and_column(self.text, span.start);
        FileError {
            file: self.file.to_owned(),
            line,
            column,
            message: message.to_string(),
        }
    }
}

/// Line and column, from 1, of a byte offset.
pub(crate) fn line_and_column(text: &str, offset: usize) -> (usize, usize) {
    let before = text.get(..offset).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    let line = before.matches('\n').count() + 1;
    (line, before[line_start..].chars().count() + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters() {
        assert_eq!(line_and_column("a\nθθ = 1", 6), (2, 3));
        assert_eq!(line_and_column("", 9), (1, 1));
    }
}
