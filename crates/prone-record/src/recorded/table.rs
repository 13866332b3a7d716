//! A table of a record, and what its cells may hold.

use std::path::Path;

use csv::StringRecord;

use prone::foreign_text;

use super::{Cut, Damage, Part, ReadError};
use crate::broken_table::BrokenTable;
use crate::record_columns::labels;
use crate::record_info::Extent;

/// No quantity of a record comes near: not in mm, N, N·m, degrees or seconds.
const LARGEST: f64 = 1e9;

/// Two instants that differ by less are one, s: tables have four decimals of a second.
const SAME_INSTANT: f64 = 0.6e-4;

/// The largest count: of cycles, and of contacts at one instant.
const MOST: usize = 65_535;

/// Of what stands in a cell, as many letters are shown.
const SHOWN: usize = 30;

/// A table of a record.
pub(super) struct Table {
    part: Part,
    content: BrokenTable,
}

impl Table {
    pub(super) fn new(part: Part, text: &str) -> Self {
        Self {
            part,
            content: BrokenTable::new(text),
        }
    }

    /// The names of the columns.
    pub(super) fn header(&self) -> impl Iterator<Item = &str> {
        self.content.header().iter()
    }

    /// Checks that there is what `run.json` lists, nothing else, and nothing twice.
    pub(super) fn check_header(&self, folder: &Path, extent: &Extent) -> Result<(), ReadError> {
        for column in extent.columns(self.part) {
            self.column(folder, column)?;
        }
        let labels = labels(self.part);
        for (place, column) in self.header().enumerate() {
            let problem = if self.find(column) != Some(place) {
                format!("the column {} is there twice", foreign_text::cut(column))
            } else if labels.contains(&column) || extent.columns(self.part).any(|it| it == column) {
                continue;
            } else {
                let column = foreign_text::cut(column);
                format!("record.channels of run.json does not list the column {column}")
            };
            let file = folder.join(self.part.file()).display().to_string();
            return Err(ReadError::Content { file, problem });
        }
        Ok(())
    }

    /// Where some columns are.
    pub(super) fn columns<const N: usize>(
        &self,
        folder: &Path,
        names: [&str; N],
    ) -> Result<[usize; N], ReadError> {
        let mut places = [0; N];
        for (place, name) in places.iter_mut().zip(names) {
            *place = self.column(folder, name)?;
        }
        Ok(places)
    }

    /// Where a column is that must be there.
    pub(super) fn column(&self, folder: &Path, name: &str) -> Result<usize, ReadError> {
        self.find(name).ok_or_else(|| {
            let file = folder.join(self.part.file()).display().to_string();
            match self.content.dialect() {
                Some(dialect) => ReadError::Content {
                    file,
                    problem: dialect.to_string(),
                },
                None => ReadError::Column {
                    file,
                    column: foreign_text::cut(name).into_owned(),
                },
            }
        })
    }

    /// Where a column is, if it is there.
    pub(super) fn find(&self, name: &str) -> Option<usize> {
        self.content.column(name)
    }

    /// Hands over line by line, up to the first in which `take` finds damage.
    pub(super) fn each(
        &self,
        mut take: impl FnMut(Cells<'_>) -> Result<(), Damage>,
    ) -> Option<Cut> {
        let header = self.content.header();
        for (line, cells) in self.content.lines() {
            if let Err(damage) = take(Cells { header, cells }) {
                return Some(self.cut(*line, damage));
            }
        }
        let (line, broken) = self.content.broken()?;
        Some(self.cut(line, broken.into()))
    }

    /// Damage in the line after the last one.
    pub(super) const fn cut_at_end(&self, damage: Damage) -> Cut {
        self.cut(self.content.after(), damage)
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

impl<'a> Cells<'a> {
    /// What stands in a column.
    pub(super) fn text(&self, column: usize) -> &'a str {
        &self.cells[column]
    }

    /// A number; nothing where the cell is empty.
    pub(super) fn optional(&self, column: usize) -> Result<Option<f64>, Damage> {
        let text = self.text(column).trim();
        if text.is_empty() {
            return Ok(None);
        }
        let number = text.parse().ok();
        match number.filter(|number: &f64| number.abs() < LARGEST) {
            Some(number) => Ok(Some(number)),
            None => Err(self.wrong(column)),
        }
    }

    /// A number that may not have been recorded; NaN where there is no column or the cell is empty.
    pub(super) fn recorded(&self, column: Option<usize>) -> Result<f64, Damage> {
        let number = column.map_or(Ok(None), |column| self.optional(column))?;
        Ok(number.unwrap_or(f64::NAN))
    }

    /// Numbers that must be there.
    pub(super) fn numbers<const N: usize>(&self, columns: [usize; N]) -> Result<[f64; N], Damage> {
        let mut numbers = [0.0; N];
        for (slot, column) in numbers.iter_mut().zip(columns) {
            *slot = self.optional(column)?.ok_or_else(|| self.wrong(column))?;
        }
        Ok(numbers)
    }

    /// A count from `least` on.
    pub(super) fn count(&self, column: usize, least: usize) -> Result<usize, Damage> {
        let count = self.text(column).trim().parse().ok();
        count
            .filter(|count| (least..=MOST).contains(count))
            .ok_or_else(|| self.outside(column, format!("{least} to {MOST}")))
    }

    /// Says that there is no value of a record in a column.
    pub(super) fn wrong(&self, column: usize) -> Damage {
        let (column, text) = self.said(column);
        Damage::Value { column, text }
    }

    /// Says within what the value of a column has to be.
    pub(super) fn outside(&self, column: usize, bound: String) -> Damage {
        let (column, text) = self.said(column);
        Damage::Outside {
            column,
            text,
            bound,
        }
    }

    /// Name of a column, and the beginning of what stands there.
    fn said(&self, column: usize) -> (String, String) {
        let text: String = self.text(column).chars().take(SHOWN).collect();
        (
            foreign_text::cut(&self.header[column]).into_owned(),
            foreign_text::escaped(&text).into_owned(),
        )
    }
}

/// Whether two times are those of one instant.
pub(super) fn same_instant(one_s: f64, other_s: f64) -> bool {
    (one_s - other_s).abs() < SAME_INSTANT
}
