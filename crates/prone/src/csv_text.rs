//! Comma-separated values, as spreadsheets and data frames write them: the one reader of tables.
//!
//! The form is that of RFC 4180: cells stand between commas, in quotes where they hold commas, quotes or
//! line ends. Lines end in line feed, carriage return, or both; a byte order mark before the first is not
//! part of it. What else spreadsheets call by the same name, with semicolons, tabs or decimal commas, is
//! not guessed at: [`Dialect`] says what it is.

use std::fmt;

use csv::{ReaderBuilder, StringRecord};

/// What a comment begins with.
const COMMENT: char = '#';

/// What a byte order mark is read as.
const BYTE_ORDER_MARK: char = '\u{feff}';

/// A line that holds more than empty cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// Its number in the text, from 1.
    pub number: usize,
    /// Its cells.
    pub cells: StringRecord,
}

/// Splits a text into lines and cells, of which lines may have more or fewer than others. Empty lines, and
/// lines of empty cells, are left out.
pub fn lines(text: &str) -> impl Iterator<Item = Line> {
    let text = without_mark(text);
    let reader = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .from_reader(text.as_bytes());
    // A text in memory of any number of cells has no errors.
    let records = reader.into_records().map_while(Result::ok);
    let mut counter = Counter {
        text: text.as_bytes(),
        byte: 0,
        ends: 0,
    };
    records.filter_map(move |cells| {
        let number = cells.position().map_or(0, |begin| counter.line(begin));
        if cells.iter().all(|cell| cell.trim().is_empty()) {
            return None;
        }
        Some(Line { number, cells })
    })
}

/// Counts lines on the way through a text, whatever ends them.
struct Counter<'t> {
    text: &'t [u8],
    /// How far it has come: bytes, and ends of lines.
    byte: usize,
    ends: usize,
}

impl Counter<'_> {
    /// The line of a record, which begins with the empty lines before it.
    fn line(&mut self, begin: &csv::Position) -> usize {
        let begin = usize::try_from(begin.byte()).unwrap_or(usize::MAX);
        while let Some(byte) = self.text.get(self.byte) {
            let is_end = matches!(byte, b'\n' | b'\r');
            if self.byte >= begin && !is_end {
                break;
            }
            let is_half = *byte == b'\r' && self.text.get(self.byte + 1) == Some(&b'\n');
            self.ends += usize::from(is_end && !is_half);
            self.byte += 1;
        }
        self.ends + 1
    }
}

impl Line {
    /// Whether it is a comment: begins with `#`, in quotes or not.
    pub fn is_comment(&self) -> bool {
        self.cells
            .get(0)
            .is_some_and(|cell| cell.starts_with(COMMENT))
    }

    /// Whether its cells are 0, 1, 2 and so on: names of columns that have none.
    pub fn counts_columns(&self) -> bool {
        let mut cells = self.cells.iter().enumerate();
        self.cells.len() > 1 && cells.all(|(index, cell)| cell.trim() == index.to_string())
    }
}

/// The comments of a text, without what marks them, and without what a spreadsheet puts around them.
pub fn comments(text: &str) -> impl Iterator<Item = String> {
    without_mark(text).lines().filter_map(|line| {
        let comment = match line.strip_prefix('"') {
            Some(quoted) if quoted.starts_with(COMMENT) => {
                let quoted = quoted.trim_end().trim_end_matches(',');
                quoted
                    .strip_suffix('"')
                    .unwrap_or(quoted)
                    .replace("\"\"", "\"")
            }
            _ => line.to_owned(),
        };
        let comment = comment.strip_prefix(COMMENT)?;
        Some(comment.trim().trim_end_matches(',').to_owned())
    })
}

/// A text without the byte order mark before it.
pub fn without_mark(text: &str) -> &str {
    text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text)
}

/// Whether the last line has its end; without, digits of it may be missing.
pub fn is_ended(text: &str) -> bool {
    text.ends_with(['\n', '\r'])
}

/// Cells that are not separated by commas.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dialect {
    /// As spreadsheets write them where the comma is the decimal point.
    Semicolons,
    /// As copies of cells are.
    Tabs,
    /// As databases print them.
    Bars,
    /// As tables for people are.
    Blanks,
}

impl Dialect {
    /// By what the cells of a line are separated, where that is not commas.
    pub fn of(line: &StringRecord) -> Option<Self> {
        let text: Vec<&str> = line.iter().collect();
        let text = text.join(",");
        let (semicolons, tabs) = (text.matches(';').count(), text.matches('\t').count());
        let bars = text.matches('|').count();
        let commas = text.matches(',').count();
        // A decimal comma in every number is one less than the separators between them.
        match () {
            () if semicolons > 0 && 2 * semicolons >= commas => Some(Self::Semicolons),
            () if tabs > 0 && 2 * tabs >= commas => Some(Self::Tabs),
            () if bars > 0 && 2 * bars >= commas => Some(Self::Bars),
            () if commas == 0 && text.split_whitespace().count() > 2 => Some(Self::Blanks),
            () => None,
        }
    }
}

impl fmt::Display for Dialect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let separators = match self {
            Self::Semicolons => {
                "semicolons, as spreadsheets do it where the comma is the decimal point"
            }
            Self::Tabs => "tabs",
            Self::Bars => "bars",
            Self::Blanks => "blanks",
        };
        write!(
            f,
            "its cells are separated by {separators}: a table has commas between cells and points in numbers"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(text: &str) -> Vec<Vec<String>> {
        let cells = |line: Line| line.cells.iter().map(str::to_owned).collect();
        lines(text).map(cells).collect()
    }

    #[test]
    fn what_spreadsheets_write_is_read() {
        let table = [["a,b", "2"], ["c\"d", "4"]];
        for text in [
            "\"a,b\",2\n\"c\"\"d\",4\n",
            "\u{feff}\"a,b\",2\r\n\"c\"\"d\",4\r\n",
            "\"a,b\",2\r\"c\"\"d\",4\r",
            "\"a,b\",\"2\"\n\n,\n\"c\"\"d\",4\n,\n\n",
        ] {
            assert_eq!(cells(text), table, "{text:?}");
        }
        let numbers: Vec<usize> = lines("a\n\n\nb\n").map(|line| line.number).collect();
        assert_eq!(numbers, [1, 4]);
        let numbers: Vec<usize> = lines("a\r\rb\r\nc\n\n\"d\ne\"\nf")
            .map(|line| line.number)
            .collect();
        assert_eq!(numbers, [1, 3, 4, 6, 8]);
        assert_eq!(cells("a\n\"b\nc\"\n"), [["a"], ["b\nc"]]);
    }

    #[test]
    fn comments_survive_a_spreadsheet() {
        let text = "# one, two\n\"# three, \"\"four\"\"\",,\n# five,,,\n1,2\n#six";
        let found: Vec<String> = comments(text).collect();
        assert_eq!(found, ["one, two", "three, \"four\"", "five", "six"]);
        let marked = lines(text).filter(Line::is_comment).count();
        assert_eq!(marked, 4);
    }

    #[test]
    fn other_separators_are_named() {
        let dialect = |text: &str| Dialect::of(&lines(text).next().unwrap().cells);
        assert_eq!(dialect("1;2;3"), Some(Dialect::Semicolons));
        assert_eq!(dialect("0,5;1,5;2,25"), Some(Dialect::Semicolons));
        assert_eq!(dialect("1\t2\t3"), Some(Dialect::Tabs));
        assert_eq!(dialect("1|2|3"), Some(Dialect::Bars));
        assert_eq!(dialect("1 2 3"), Some(Dialect::Blanks));
        for text in ["1,2,3", "plate; a,2,3,4,5", "a", "two words"] {
            assert_eq!(dialect(text), None, "{text}");
        }
    }
}
