//! Reading a table that may break off: what stands before is taken, and where it ends is known.

use std::path::PathBuf;

use prone_record::broken_table::BrokenTable;

use super::ReportError;

/// Where a table can be used no further.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{file}, line {line}: {damage}")]
pub struct Cut {
    /// Its path, beginning with the folder as it was named.
    pub file: String,
    /// The first line that cannot be used, from 1.
    pub line: usize,
    /// What is wrong there.
    pub damage: Damage,
}

/// What is wrong with a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Damage {
    /// The line is not whole, or holds what is no value of this table.
    #[error("the line is not whole; what stands before it is shown")]
    Line,
    /// Every line is whole, but some are missing at the end.
    #[error("rows are missing from here on; what stands before is shown")]
    Missing,
}

/// A table up to its first incomplete line.
#[derive(Debug, Clone, PartialEq)]
pub struct CutTable {
    path: PathBuf,
    /// How the file is called in the report.
    name: String,
    content: BrokenTable,
    cut: Option<(usize, Damage)>,
}

/// A line, read by the names of its columns.
pub struct Line<'a> {
    cells: &'a csv::StringRecord,
}

/// A cell that is neither empty nor a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NoNumber;

/// A column that the table is known to have.
#[derive(Debug, Clone, Copy)]
pub struct Column(usize);

impl CutTable {
    /// Splits a text into lines and cells.
    pub fn read(path: PathBuf, name: String, text: &str) -> Self {
        let content = BrokenTable::new(text);
        Self {
            path,
            name,
            cut: content.broken().map(|(line, _)| (line, Damage::Line)),
            content,
        }
    }

    /// Where a column is.
    ///
    /// # Errors
    /// [`ReportError::Column`].
    pub fn column(&self, column: &str) -> Result<Column, ReportError> {
        self.content
            .column(column)
            .map(Column)
            .ok_or_else(|| ReportError::Column {
                file: self.path.clone(),
                column: column.to_owned(),
            })
    }

    /// Where some columns are.
    ///
    /// # Errors
    /// [`ReportError::Column`].
    pub fn columns<const N: usize>(&self, columns: [&str; N]) -> Result<[Column; N], ReportError> {
        let mut found = [Column(0); N];
        for (found, column) in found.iter_mut().zip(columns) {
            *found = self.column(column)?;
        }
        Ok(found)
    }

    /// Every line that `read` takes, up to the first that it does not; the table ends there.
    pub fn rows<T>(&mut self, mut read: impl FnMut(&Line<'_>) -> Option<T>) -> Vec<T> {
        let mut rows = Vec::new();
        for (line, cells) in self.content.lines() {
            let Some(row) = read(&Line { cells }) else {
                self.cut = Some((*line, Damage::Line));
                break;
            };
            rows.push(row);
        }
        rows
    }

    /// Says that the table is not whole although every line is, because something is missing.
    pub fn end_early(&mut self) {
        if self.cut.is_none() {
            let line = self.content.lines().last().map_or(2, |(line, _)| line + 1);
            self.cut = Some((line, Damage::Missing));
        }
    }

    /// Where it breaks off, if it does.
    pub fn cut(&self) -> Option<Cut> {
        self.cut.map(|(line, damage)| Cut {
            file: self.name.clone(),
            line,
            damage,
        })
    }
}

impl<'a> Line<'a> {
    /// What stands in a column.
    pub fn text(&self, Column(column): Column) -> &'a str {
        &self.cells[column]
    }

    /// A number that is not infinite.
    pub fn number(&self, column: Column) -> Option<f64> {
        let number: f64 = self.text(column).parse().ok()?;
        number.is_finite().then_some(number)
    }

    /// The numbers of some columns.
    pub fn numbers<const N: usize>(&self, columns: [Column; N]) -> Option<[f64; N]> {
        let mut numbers = [0.0; N];
        for (number, column) in numbers.iter_mut().zip(columns) {
            *number = self.number(column)?;
        }
        Some(numbers)
    }

    /// A number, or nothing where the cell is empty.
    ///
    /// # Errors
    /// [`NoNumber`] where something else stands there.
    pub fn optional(&self, column: Column) -> Result<Option<f64>, NoNumber> {
        if self.text(column).is_empty() {
            Ok(None)
        } else {
            self.number(column).map(Some).ok_or(NoNumber)
        }
    }

    /// A whole number.
    pub fn whole(&self, column: Column) -> Option<u64> {
        self.text(column).parse().ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(text: &str) -> CutTable {
        CutTable::read("a.csv".into(), "a.csv".to_owned(), text)
    }

    fn numbers(text: &str) -> (Vec<f64>, Option<usize>) {
        let mut table = table(text);
        let column = table.column("b").unwrap();
        let rows = table.rows(|line| line.number(column));
        (rows, table.cut().map(|cut| cut.line))
    }

    #[test]
    fn a_table_is_read_to_its_first_line_that_is_not_whole() {
        assert_eq!(numbers("a,b\n1,2\n3,4\n"), (vec![2.0, 4.0], None));
        assert_eq!(numbers("a,b\n1,2\n3,4"), (vec![2.0], Some(3)));
        assert_eq!(numbers("a,b\n1,2\n3\n5,6\n"), (vec![2.0], Some(3)));
        assert_eq!(numbers("a,b\n1,2\n3,x\n5,6\n"), (vec![2.0], Some(3)));
        assert_eq!(numbers("a,b\n1,NaN\n3,4\n"), (vec![], Some(2)));
        assert_eq!(numbers("a,b\n"), (vec![], None));
    }

    #[test]
    fn a_column_that_is_not_there_is_named() {
        for text in ["", "a,c\n1,2\n"] {
            let error = table(text).column("b").unwrap_err();
            assert_eq!(error.to_string(), "a.csv has no column b");
        }
    }

    #[test]
    fn an_end_that_came_early_is_after_the_last_line() {
        let mut early = table("a,b\n1,2\n");
        early.end_early();
        assert_eq!(early.cut().unwrap().line, 3);
    }
}
