//! A CSV file in memory, up to where it breaks off: the one reader of tables that may be cut.

use csv::StringRecord;

use prone::csv_text::{self, Dialect};

/// Whole lines of a CSV file, and what ends them.
#[derive(Debug, Clone, PartialEq)]
pub struct BrokenTable {
    header: StringRecord,
    lines: Vec<(usize, StringRecord)>,
    broken: Option<(usize, Break)>,
    after: usize,
}

/// What ends the whole lines of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Break {
    /// The file ends within the line, of which digits may be missing.
    #[error("the file ends within the line")]
    Unfinished,
    /// The line has more or fewer cells than the header.
    #[error("{found} cells, where the header has {expected}")]
    Cells {
        /// Cells of the line.
        found: usize,
        /// Cells of the header.
        expected: usize,
    },
}

impl BrokenTable {
    /// Splits a text into cells, up to a line without its end or with more or fewer cells than the
    /// first line.
    pub fn new(text: &str) -> Self {
        let whole = text.rfind('\n').map_or("", |end| &text[..=end]);
        let mut table = Self {
            header: StringRecord::new(),
            lines: Vec::new(),
            broken: None,
            after: whole.matches('\n').count() + 1,
        };
        let mut lines = csv_text::lines(whole);
        if let Some(header) = lines.next() {
            table.header = header.cells;
        }
        for line in lines {
            let (found, expected) = (line.cells.len(), table.header.len());
            if found != expected {
                table.broken = Some((line.number, Break::Cells { found, expected }));
                return table;
            }
            table.lines.push((line.number, line.cells));
        }
        if whole.len() < text.len() {
            table.broken = Some((table.after, Break::Unfinished));
        }
        table
    }

    /// Names of the columns.
    pub const fn header(&self) -> &StringRecord {
        &self.header
    }

    /// By what the cells are separated, where that is not commas.
    pub fn dialect(&self) -> Option<Dialect> {
        Dialect::of(&self.header)
    }

    /// Place of a column, if the table has it.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.header.iter().position(|column| column == name)
    }

    /// Whole lines in their order, each with its number in the file, from 1.
    pub fn lines(&self) -> &[(usize, StringRecord)] {
        &self.lines
    }

    /// The first line that is not whole, by its number from 1, and what is wrong with it.
    pub const fn broken(&self) -> Option<(usize, Break)> {
        self.broken
    }

    /// Number of the line after the last line end, from 1.
    pub const fn after(&self) -> usize {
        self.after
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(text: &str) -> (usize, Option<(usize, Break)>) {
        let table = BrokenTable::new(text);
        (table.lines().len(), table.broken())
    }

    #[test]
    fn a_table_is_read_to_its_first_line_that_is_not_whole() {
        assert_eq!(cells("a,b\n1,2\n3,4\n"), (2, None));
        assert_eq!(cells("a,b\n1,2\n3,4"), (1, Some((3, Break::Unfinished))));
        let short = Break::Cells {
            found: 1,
            expected: 2,
        };
        assert_eq!(cells("a,b\n1,2\n3\n5,6\n"), (1, Some((3, short))));
        assert_eq!(cells("a,b"), (0, Some((1, Break::Unfinished))));
        assert_eq!(cells(""), (0, None));
    }

    /// A name with a comma or a quote is one cell; a quote that nothing closes ends the table.
    #[test]
    fn quoted_cells_are_one_cell() {
        let table = BrokenTable::new("a,b\n\"x, \"\"y\"\"\",2\n3,4\n");
        assert_eq!(&table.lines()[0].1[0], "x, \"y\"");
        let (lines, broken) = cells("a,b\n1,2\n\"3,4\n5,6\n");
        assert_eq!((lines, broken.map(|(line, _)| line)), (1, Some(3)));
    }
}
