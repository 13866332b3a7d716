//! Reading a table that may break off: what stands before is taken, and where it ends is known.

use std::path::PathBuf;

use csv::StringRecord;
use prone_record::broken_table::BrokenTable;

use super::ReportError;

/// Why a line cannot be used.
const NOT_WHOLE: &str = "the line is not whole; what stands before it is shown";

/// What is said where every line is whole, but some are missing at the end.
const MISSING: &str = "rows are missing from here on; what stands before is shown";

/// A table up to its first incomplete line.
#[derive(Debug, Clone, PartialEq)]
pub struct CutTable {
    path: PathBuf,
    /// How the file is called in the report.
    name: String,
    content: BrokenTable,
}

/// A line, read by the places of its columns.
pub struct Line<'a>(&'a StringRecord);

/// A cell that is neither empty nor a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NoNumber;

/// A column that the table is known to have.
#[derive(Debug, Clone, Copy)]
pub struct Column(usize);

impl CutTable {
    /// Splits a text into lines and cells.
    pub fn read(path: PathBuf, name: String, text: &str) -> Self {
        Self {
            path,
            name,
            content: BrokenTable::new(text),
        }
    }

    /// Where some columns are.
    ///
    /// # Errors
    /// [`ReportError::Column`].
    pub fn columns<const N: usize>(
        &self,
        columns: [impl AsRef<str>; N],
    ) -> Result<[Column; N], ReportError> {
        let mut found = [Column(0); N];
        for (found, column) in found.iter_mut().zip(columns) {
            let column = column.as_ref();
            let place = self.content.column(column);
            *found = Column(place.ok_or_else(|| ReportError::Column {
                file: self.path.clone(),
                column: column.to_owned(),
            })?);
        }
        Ok(found)
    }

    /// Every line that `read` takes, up to the first that it does not; the table ends there, and `cuts`
    /// gets a sentence that says so.
    pub fn rows<T>(
        &self,
        cuts: &mut Vec<String>,
        read: impl FnMut(&Line<'_>) -> Option<T>,
    ) -> Vec<T> {
        self.all_rows(cuts, read, |_| true)
    }

    /// The same of a table that is not whole, although every line is, unless its rows are `all`.
    pub fn all_rows<T>(
        &self,
        cuts: &mut Vec<String>,
        mut read: impl FnMut(&Line<'_>) -> Option<T>,
        all: impl Fn(&[T]) -> bool,
    ) -> Vec<T> {
        let mut cut = self.content.broken().map(|(line, _)| (line, NOT_WHOLE));
        let mut rows = Vec::new();
        for (line, cells) in self.content.lines() {
            let Some(row) = read(&Line(cells)) else {
                cut = Some((*line, NOT_WHOLE));
                break;
            };
            rows.push(row);
        }
        if cut.is_none() && !all(&rows) {
            let line = self.content.lines().last().map_or(2, |(line, _)| line + 1);
            cut = Some((line, MISSING));
        }
        let name = &self.name;
        cuts.extend(cut.map(|(line, damage)| format!("{name}, line {line}: {damage}")));
        rows
    }
}

impl<'a> Line<'a> {
    /// What stands in a column.
    pub fn text(&self, Column(column): Column) -> &'a str {
        &self.0[column]
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

    /// The numbers of a column, and the line in which the table breaks off.
    fn numbers(text: &str) -> (Vec<f64>, Option<usize>) {
        let mut cuts = Vec::new();
        let table = table(text);
        let [column] = table.columns(["b"]).unwrap();
        let rows = table.rows(&mut cuts, |line| line.number(column));
        let line = cuts.first().map(|cut| {
            let line = cut.strip_prefix("a.csv, line ").unwrap();
            line.strip_suffix(&format!(": {NOT_WHOLE}"))
                .unwrap()
                .parse()
                .unwrap()
        });
        (rows, line)
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
            let error = table(text).columns(["b"]).unwrap_err();
            assert_eq!(error.to_string(), "a.csv has no column b");
        }
    }

    #[test]
    fn an_end_that_came_early_is_after_the_last_line() {
        let mut cuts = Vec::new();
        let early = table("a,b\n1,2\n");
        let rows = early.all_rows(&mut cuts, |_| Some(()), |rows| rows.len() > 1);
        assert_eq!(rows.len(), 1);
        assert_eq!(cuts, [format!("a.csv, line 3: {MISSING}")]);
    }
}
