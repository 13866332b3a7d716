//! A CSV file up to where it breaks off.

use std::path::Path;

use csv::{ReaderBuilder, StringRecord};

use super::{Cut, Damage, Part, ReadError};

/// No quantity of a record comes near: not in mm, N, N·m, degrees or seconds.
const LARGEST: f64 = 1e9;

/// Two instants that differ by less are one, s: tables have four decimals of a second.
const SAME_INSTANT: f64 = 0.6e-4;

/// Of what stands in a cell, as many letters are shown.
const SHOWN: usize = 30;

/// A CSV file in memory.
pub(super) struct Table {
    part: Part,
    header: StringRecord,
    /// Whole lines with their numbers.
    lines: Vec<(usize, StringRecord)>,
    /// What ends them, if it is not the end of the file.
    broken: Option<(usize, Damage)>,
    /// The number of the line after the last one.
    after: usize,
}

impl Table {
    /// Splits a text into cells, up to a line without its end or with more or fewer cells than the
    /// first one.
    pub(super) fn new(part: Part, text: &str) -> Self {
        let whole = text.rfind('\n').map_or("", |end| &text[..=end]);
        let mut table = Self {
            part,
            header: StringRecord::new(),
            lines: Vec::new(),
            broken: None,
            after: whole.matches('\n').count() + 1,
        };
        let reader = ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .quoting(false)
            .from_reader(whole.as_bytes());
        for (index, record) in reader.into_records().enumerate() {
            // Texts without quotes have no errors.
            let Ok(record) = record else { break };
            if index == 0 {
                table.header = record;
                continue;
            }
            #[expect(
                clippy::cast_possible_truncation,
                reason = "a number of lines in memory"
            )]
            let line = record
                .position()
                .map_or(index + 1, |position| position.line() as usize);
            let (found, expected) = (record.len(), table.header.len());
            if found != expected {
                table.broken = Some((line, Damage::Cells { found, expected }));
                return table;
            }
            table.lines.push((line, record));
        }
        if whole.len() < text.len() {
            table.broken = Some((table.after, Damage::Unfinished));
        }
        table
    }

    /// The names of the columns.
    pub(super) fn header(&self) -> impl Iterator<Item = &str> {
        self.header.iter()
    }

    /// Where some columns are.
    pub(super) fn columns<const N: usize>(
        &self,
        folder: &Path,
        names: [impl AsRef<str>; N],
    ) -> Result<[usize; N], ReadError> {
        let mut places = [0; N];
        for (place, name) in places.iter_mut().zip(names) {
            *place = self.column(folder, name.as_ref())?;
        }
        Ok(places)
    }

    /// Where a column is.
    pub(super) fn column(&self, folder: &Path, name: &str) -> Result<usize, ReadError> {
        let place = self.header().position(|column| column == name);
        place.ok_or_else(|| ReadError::Column {
            file: folder.join(self.part.file()).display().to_string(),
            column: name.to_owned(),
        })
    }

    /// Hands over line by line, up to the first in which `take` finds damage.
    pub(super) fn each(
        &self,
        mut take: impl FnMut(Cells<'_>) -> Result<(), Damage>,
    ) -> Option<Cut> {
        for (line, cells) in &self.lines {
            let header = &self.header;
            if let Err(damage) = take(Cells { header, cells }) {
                return Some(self.cut(*line, damage));
            }
        }
        let (line, damage) = self.broken.clone()?;
        Some(self.cut(line, damage))
    }

    /// Damage in the line after the last one.
    pub(super) fn cut_at_end(&self, damage: Damage) -> Cut {
        self.cut(self.after, damage)
    }

    const fn cut(&self, line: usize, damage: Damage) -> Cut {
        Cut {
            part: self.part,
            line,
            damage,
        }
    }
}

/// One line.
#[derive(Clone, Copy)]
pub(super) struct Cells<'a> {
    header: &'a StringRecord,
    cells: &'a StringRecord,
}

impl Cells<'_> {
    /// What stands in a column.
    pub(super) fn text(&self, column: usize) -> &str {
        &self.cells[column]
    }

    /// A number; nothing where the cell is empty.
    pub(super) fn optional(&self, column: usize) -> Result<Option<f64>, Damage> {
        let text = self.text(column);
        if text.is_empty() {
            return Ok(None);
        }
        let number = text.parse().ok();
        match number.filter(|number: &f64| number.abs() < LARGEST) {
            Some(number) => Ok(Some(number)),
            None => Err(self.wrong(column)),
        }
    }

    /// Numbers that must be there.
    pub(super) fn numbers<const N: usize>(&self, columns: [usize; N]) -> Result<[f64; N], Damage> {
        let mut numbers = [0.0; N];
        for (slot, column) in numbers.iter_mut().zip(columns) {
            *slot = self.optional(column)?.ok_or_else(|| self.wrong(column))?;
        }
        Ok(numbers)
    }

    /// As many as fit into 16 bits, more than which nothing of a robot has.
    pub(super) fn count(&self, column: usize) -> Result<usize, Damage> {
        let count: Option<u16> = self.text(column).parse().ok();
        count.map(usize::from).ok_or_else(|| self.wrong(column))
    }

    /// Says that there is no value of a record in a column.
    pub(super) fn wrong(&self, column: usize) -> Damage {
        Damage::Value {
            column: self.header[column].to_owned(),
            text: self.text(column).chars().take(SHOWN).collect(),
        }
    }
}

/// Whether two times are those of one instant.
pub(super) fn same_instant(one_s: f64, other_s: f64) -> bool {
    (one_s - other_s).abs() < SAME_INSTANT
}
