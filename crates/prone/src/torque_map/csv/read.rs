//! Torque maps from text.

use csv::StringRecord;

use crate::csv_text::{self, Dialect, Line};
use crate::{foreign_text, odd_number};

use super::super::{
    Axis, ContactForces, EDGE_TOLERANCE, Grid, GridError, JointTorques, Mask, RecordedMap, Row,
    TorqueMap,
};
use super::{ANKLE, COLUMNS, FIRST_FORCE, FIRST_TORQUE, HIP, KNEE, SHOULDER, TOE, UPPER_ARM};

/// Why a text is not such a table.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ParseError {
    /// The first row has neither number of columns.
    #[error("line {line} has {columns} columns, not 14 or 18{hint}")]
    Columns {
        /// The line of the file, from 1.
        line: usize,
        /// Its columns.
        columns: usize,
        /// What that may come from.
        hint: &'static str,
    },
    /// Cells are not separated by commas.
    #[error("line {line}: {dialect}")]
    Dialect {
        /// The line of the file, from 1.
        line: usize,
        /// What they are separated by.
        dialect: Dialect,
    },
    /// The first row names the columns, and names others, or in another order.
    #[error("line {line}: column {place} is called {found}, where {expected} stands")]
    Header {
        /// The line of the file, from 1.
        line: usize,
        /// Number of the column, from 1.
        place: usize,
        /// Its name, cut.
        found: String,
        /// The name of what belongs there.
        expected: &'static str,
    },
    /// A later row has more or fewer columns than the first.
    #[error("line {line} has {columns} columns, not {expected} as the rows before it")]
    Ragged {
        /// The line of the file, from 1.
        line: usize,
        /// Its columns.
        columns: usize,
        /// Columns of the first row.
        expected: usize,
    },
    /// Not a number, or not a finite one where it must be.
    #[error("line {line}, column {column}: `{value}` is not a number that belongs there{reason}")]
    Number {
        /// The line of the file, from 1.
        line: usize,
        /// The column's name.
        column: &'static str,
        /// What stands there, cut.
        value: String,
        /// What it is, where that is known, after a colon.
        reason: String,
    },
    /// A row is not at its node of a regular grid.
    #[error(
        "line {line}, column {column}: {value} rad, but a regular grid has {expected:.5} there"
    )]
    OffGrid {
        /// The line of the file, from 1.
        line: usize,
        /// The column's name.
        column: &'static str,
        /// What stands there, rad.
        value: f64,
        /// Value of the node, rad.
        expected: f64,
    },
    /// The last line has no end: part of it may be missing.
    #[error("line {line} has no end: the file is cut there")]
    Cut {
        /// The line of the file, from 1.
        line: usize,
    },
    /// Nothing but comments.
    #[error("there are no rows")]
    Empty,
    /// The rows are too few, or not a full block of θ4 × θ3 × α.
    #[error(
        "{rows} rows are no full grid: theta4 repeats after {hips} rows, theta3 after {knees} values"
    )]
    Shape {
        /// Number of rows.
        rows: usize,
        /// Length of the first θ4 run.
        hips: usize,
        /// Number of θ3 values in the first block.
        knees: usize,
    },
    /// An axis does not ascend.
    #[error(transparent)]
    Grid(#[from] GridError),
}

/// One row of the file.
struct Record {
    line: usize,
    /// How many of `numbers` the file has.
    columns: usize,
    /// NaN beyond them.
    numbers: [f64; COLUMNS.len()],
}

/// Reads the torques of a table in either layout.
///
/// # Errors
/// [`ParseError`], naming line, column and value.
pub fn parse(text: &str) -> Result<TorqueMap, ParseError> {
    parse_recorded(text).map(RecordedMap::into_map)
}

/// Reads a table in either layout with its contact forces.
///
/// # Errors
/// [`ParseError`], naming line, column and value.
pub fn parse_recorded(text: &str) -> Result<RecordedMap, ParseError> {
    let mut records: Vec<Record> = Vec::new();
    let mut lines = csv_text::lines(text)
        .filter(|line| !line.is_comment())
        .peekable();
    if let Some(first) = lines.peek()
        && is_header(first)?
    {
        lines.next();
    }
    let mut last = 0;
    for line in lines {
        let expected = records.first().map(|record| record.columns);
        last = line.number;
        records.push(Record::read(&line, expected)?);
    }
    let grid = grid_of(&records)?;
    if !csv_text::is_ended(text) {
        return Err(ParseError::Cut { line: last });
    }
    let mut rows = vec![None; grid.len()];
    let mut contacts = vec![None; grid.len()];
    for (index, record) in grid.recorded_order().zip(&records) {
        record.check_node(&grid, index)?;
        rows[index] = Some(record.row());
        contacts[index] = record.contacts();
    }
    // `grid_of` has made the numbers of records and nodes equal: every node is filled.
    let map = TorqueMap::new(grid, rows.into_iter().flatten().collect())?;
    Ok(RecordedMap::new(map, contacts)?)
}

/// The comments of a table, without what marks them.
pub fn comments(text: &str) -> impl Iterator<Item = String> {
    csv_text::comments(text)
}

/// Whether a line names the columns, by our names or by their numbers, as data frames do.
fn is_header(line: &Line) -> Result<bool, ParseError> {
    if line.counts_columns() {
        return Ok(true);
    }
    let is_name = |cell: &str| COLUMNS.contains(&cell.trim());
    if !line.cells.iter().any(is_name) {
        return Ok(false);
    }
    let named = line.cells.iter().zip(COLUMNS).enumerate();
    for (place, (found, expected)) in named {
        if found.trim() != expected {
            return Err(ParseError::Header {
                line: line.number,
                place: place + 1,
                found: foreign_text::cut(found).into_owned(),
                expected,
            });
        }
    }
    Ok(true)
}

/// What a number of columns that no map has may come from.
fn hint(columns: usize, cells: &StringRecord) -> &'static str {
    let is_count = cells
        .get(0)
        .is_some_and(|cell| cell.trim().parse::<u32>().is_ok() || cell.trim().is_empty());
    match columns {
        15 | 19 if is_count => {
            "; the first one counts the rows: write the table without its index (pandas: index=False)"
        }
        28 | 36 => "; with decimal commas each number is two cells: a number has a point",
        _ => "",
    }
}

impl Record {
    fn read(
        Line {
            number: line,
            cells,
        }: &Line,
        expected: Option<usize>,
    ) -> Result<Self, ParseError> {
        let (line, columns) = (*line, cells.len());
        let fits = match expected {
            None => columns == FIRST_FORCE || columns == COLUMNS.len(),
            Some(expected) => columns == expected,
        };
        if !fits && let Some(dialect) = Dialect::of(cells) {
            return Err(ParseError::Dialect { line, dialect });
        }
        match expected {
            None if !fits => {
                let hint = hint(columns, cells);
                return Err(ParseError::Columns {
                    line,
                    columns,
                    hint,
                });
            }
            Some(expected) if columns != expected => {
                return Err(ParseError::Ragged {
                    line,
                    columns,
                    expected,
                });
            }
            _ => {}
        }
        let mut record = Self {
            line,
            columns,
            numbers: [f64::NAN; COLUMNS.len()],
        };
        for (place, cell) in cells.iter().enumerate() {
            // A data frame writes nothing where it has no number.
            let value = match cell.trim() {
                "" => Ok(f64::NAN),
                cell => cell.parse(),
            };
            record.numbers[place] = value.map_err(|_| record.misplaced(place, cell))?;
        }
        let misplaced = (0..columns).find(|&place| !record.belongs(place));
        misplaced.map_or(Ok(()), |place| Err(record.misplaced(place, &cells[place])))?;
        Ok(record)
    }

    /// Whether a number may stand where it does: all are finite but what a row without torques, or
    /// without known forces, lacks.
    fn belongs(&self, place: usize) -> bool {
        let value = self.numbers[place];
        let may_be_missing = match place {
            KNEE | HIP | UPPER_ARM => false,
            FIRST_TORQUE.. => true,
            _ => self.torques().is_none(),
        };
        value.is_finite() || (value.is_nan() && may_be_missing)
    }

    fn misplaced(&self, place: usize, cell: &str) -> ParseError {
        let reason = odd_number::explained(cell);
        ParseError::Number {
            line: self.line,
            column: COLUMNS[place],
            value: foreign_text::cut(cell.trim()).into_owned(),
            reason: reason.map_or_else(String::new, |reason| format!(": {reason}")),
        }
    }

    fn torques(&self) -> Option<JointTorques> {
        let torques = std::array::from_fn(|joint| self.numbers[FIRST_TORQUE + joint]);
        finite(torques).map(JointTorques::from_array)
    }

    fn contacts(&self) -> Option<ContactForces> {
        let forces = std::array::from_fn(|group| self.numbers[FIRST_FORCE + group]);
        finite(forces).map(ContactForces::from_array)
    }

    fn row(&self) -> Row {
        let recorded = self.torques();
        let chain = [TOE, ANKLE, SHOULDER].map(|place| self.numbers[place]);
        let mask = match recorded {
            Some(_) if chain[0] < 0.0 && chain[1] > 0.0 => Mask::Mirrored,
            Some(torques) => return Row::Torques(torques),
            None if chain.iter().all(|angle| angle.is_nan()) => Mask::Open,
            None if self.columns == FIRST_FORCE => Mask::Missing,
            None => Mask::Failed,
        };
        Row::Masked { mask, recorded }
    }

    fn check_node(&self, grid: &Grid, index: usize) -> Result<(), ParseError> {
        let node = grid.node(index);
        for (column, expected) in [
            (KNEE, node.knee),
            (HIP, node.hip),
            (UPPER_ARM, node.upper_arm),
        ] {
            let value = self.numbers[column];
            if (value - expected).abs() > EDGE_TOLERANCE {
                return Err(ParseError::OffGrid {
                    line: self.line,
                    column: COLUMNS[column],
                    value,
                    expected,
                });
            }
        }
        Ok(())
    }
}

fn finite(numbers: [f64; 4]) -> Option<[f64; 4]> {
    numbers
        .iter()
        .all(|number| number.is_finite())
        .then_some(numbers)
}

/// The grid that a first block of θ4 and the number of rows imply.
fn grid_of(records: &[Record]) -> Result<Grid, ParseError> {
    let same = |a: f64, b: f64| (a - b).abs() <= EDGE_TOLERANCE;
    let Some(first) = records.first() else {
        return Err(ParseError::Empty);
    };
    let run = |column: usize| {
        records
            .iter()
            .take_while(|record| same(record.numbers[column], first.numbers[column]))
            .count()
    };
    let (hips, block) = (run(KNEE), run(UPPER_ARM));
    let knees = block / hips;
    let arms = records.len() / block;
    if hips * knees * arms != records.len() {
        return Err(ParseError::Shape {
            rows: records.len(),
            hips,
            knees,
        });
    }
    let axis = |column: usize, nodes: usize| {
        let values = records.iter().map(|record| record.numbers[column]);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        Axis::new(low, high, nodes)
    };
    Ok(Grid {
        knee: axis(KNEE, knees)?,
        hip: axis(HIP, hips)?,
        upper_arm: axis(UPPER_ARM, arms)?,
    })
}
