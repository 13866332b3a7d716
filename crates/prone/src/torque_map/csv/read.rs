//! Torque maps from text.

use super::super::{
    Axis, ContactForces, EDGE_TOLERANCE, Grid, GridError, JointTorques, Mask, RecordedMap, Row,
    TorqueMap,
};
use super::{
    ANKLE, COLUMNS, COMMENT, FIRST_FORCE, FIRST_TORQUE, HIP, KNEE, SHOULDER, TOE, UPPER_ARM,
};

/// Why a text is not such a table.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ParseError {
    /// The first row has neither number of columns.
    #[error("line {line} has {columns} columns, not 14 or 18")]
    Columns {
        /// The line of the file, from 1.
        line: usize,
        /// Its columns.
        columns: usize,
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
    #[error("line {line}, column {column}: `{value}` is not a number that belongs there")]
    Number {
        /// The line of the file, from 1.
        line: usize,
        /// The column's name.
        column: &'static str,
        /// What stands there.
        value: String,
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
    for (index, content) in text.lines().enumerate() {
        if !content.starts_with(COMMENT) {
            let expected = records.first().map(|record| record.columns);
            records.push(Record::read(index + 1, content, expected)?);
        }
    }
    let grid = grid_of(&records)?;
    if !text.ends_with('\n') {
        return Err(ParseError::Cut {
            line: text.lines().count(),
        });
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
pub fn comments(text: &str) -> impl Iterator<Item = &str> {
    let marked = text.lines().filter_map(|line| line.strip_prefix(COMMENT));
    marked.map(str::trim)
}

impl Record {
    fn read(line: usize, content: &str, expected: Option<usize>) -> Result<Self, ParseError> {
        let columns = content.split(',').count();
        match expected {
            None if columns != FIRST_FORCE && columns != COLUMNS.len() => {
                return Err(ParseError::Columns { line, columns });
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
        for (place, cell) in content.split(',').enumerate() {
            let value = cell.trim().parse();
            record.numbers[place] = value.map_err(|_| record.misplaced(place, content))?;
        }
        let misplaced = (0..columns).find(|&place| !record.belongs(place));
        misplaced.map_or(Ok(()), |place| Err(record.misplaced(place, content)))?;
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

    fn misplaced(&self, place: usize, content: &str) -> ParseError {
        ParseError::Number {
            line: self.line,
            column: COLUMNS[place],
            value: content
                .split(',')
                .nth(place)
                .unwrap_or("")
                .trim()
                .to_owned(),
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
