//! The original author's table as text.
//!
//! No header; per row fourteen comma-separated numbers, angles in rad, torques in N·m:
//!
//! ```text
//! θ1 θ2 θ3 θ4 θ5 α | AnklePitch KneePitch HipPitch ShoulderPitch | τ2 τ3 τ4 τ5
//! ```
//!
//! α outermost (descending), θ3 (ascending), θ4 innermost (descending). Numbers carry five
//! digits. A row without torques has NaN in all four; a row with θ1 < 0 < θ2 was recorded on the
//! mirrored root of equation (4) and is masked. The limits of the grid are the extreme values of
//! the columns as printed; its inner nodes are equally spaced between them.

use super::{Axis, EDGE_TOLERANCE, Grid, GridError, JointTorques, Mask, Row, TorqueMap};

/// Names of the columns, in order.
const COLUMNS: [&str; 14] = [
    "theta1",
    "theta2",
    "theta3",
    "theta4",
    "theta5",
    "alpha",
    "AnklePitch",
    "KneePitch",
    "HipPitch",
    "ShoulderPitch",
    "tau2",
    "tau3",
    "tau4",
    "tau5",
];

const TOE: usize = 0;
const ANKLE: usize = 1;
const KNEE: usize = 2;
const HIP: usize = 3;
const UPPER_ARM: usize = 5;
const FIRST_TORQUE: usize = 10;

/// Why a text is not such a table.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ParseError {
    /// A row has too few or too many columns.
    #[error("row {row} has {columns} columns, not 14")]
    Columns {
        /// The row, from 1.
        row: usize,
        /// Its columns.
        columns: usize,
    },
    /// Not a number, or not a finite one where it must be.
    #[error("row {row}, column {column}: `{value}` is not a number that belongs there")]
    Number {
        /// The row, from 1.
        row: usize,
        /// The column's name.
        column: &'static str,
        /// What stands there.
        value: String,
    },
    /// A row is not at its node of a regular grid.
    #[error("row {row}, column {column}: {value} rad, but a regular grid has {expected:.5} there")]
    OffGrid {
        /// The row, from 1.
        row: usize,
        /// The column's name.
        column: &'static str,
        /// What stands there, rad.
        value: f64,
        /// Value of the node, rad.
        expected: f64,
    },
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

/// Reads a table in the original's layout.
///
/// # Errors
/// [`ParseError`], naming row, column and value.
pub fn parse(text: &str) -> Result<TorqueMap, ParseError> {
    let lines = text.lines().enumerate();
    let records = lines
        .map(|(line, content)| numbers(line + 1, content))
        .collect::<Result<Vec<_>, _>>()?;
    let grid = grid_of(&records)?;
    let mut rows = vec![None; grid.len()];
    for (number, (index, record)) in grid.recorded_order().zip(&records).enumerate() {
        check_node(number + 1, record, &grid, index)?;
        rows[index] = Some(row_of(record));
    }
    // `grid_of` has made the numbers of records and nodes equal: every node is filled.
    Ok(TorqueMap::new(grid, rows.into_iter().flatten().collect())?)
}

fn numbers(row: usize, line: &str) -> Result<[f64; 14], ParseError> {
    let columns = line.split(',').count();
    if columns != COLUMNS.len() {
        return Err(ParseError::Columns { row, columns });
    }
    let mut record = [0.0; 14];
    for ((place, name), cell) in COLUMNS.iter().enumerate().zip(line.split(',')) {
        let bad = || ParseError::Number {
            row,
            column: name,
            value: cell.trim().to_owned(),
        };
        let value: f64 = cell.trim().parse().map_err(|_| bad())?;
        let may_be_missing = place >= FIRST_TORQUE && value.is_nan();
        if !value.is_finite() && !may_be_missing {
            return Err(bad());
        }
        record[place] = value;
    }
    Ok(record)
}

/// The grid that a first block of θ4 and the number of rows imply.
fn grid_of(records: &[[f64; 14]]) -> Result<Grid, ParseError> {
    let same = |a: f64, b: f64| (a - b).abs() <= EDGE_TOLERANCE;
    let Some(first) = records.first() else {
        return Err(ParseError::Shape {
            rows: 0,
            hips: 0,
            knees: 0,
        });
    };
    let run = |column: usize| {
        records
            .iter()
            .take_while(|r| same(r[column], first[column]))
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
        let values = records.iter().map(|record| record[column]);
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

fn check_node(row: usize, record: &[f64; 14], grid: &Grid, index: usize) -> Result<(), ParseError> {
    let node = grid.node(index);
    for (column, expected) in [
        (KNEE, node.knee),
        (HIP, node.hip),
        (UPPER_ARM, node.upper_arm),
    ] {
        let value = record[column];
        if (value - expected).abs() > EDGE_TOLERANCE {
            return Err(ParseError::OffGrid {
                row,
                column: COLUMNS[column],
                value,
                expected,
            });
        }
    }
    Ok(())
}

fn row_of(record: &[f64; 14]) -> Row {
    let torques = [record[10], record[11], record[12], record[13]];
    let recorded = torques
        .iter()
        .all(|torque| torque.is_finite())
        .then(|| JointTorques::from_array(torques));
    let mirrored = record[TOE] < 0.0 && record[ANKLE] > 0.0;
    match recorded {
        None => Row::Masked {
            mask: Mask::Missing,
            recorded,
        },
        Some(_) if mirrored => Row::Masked {
            mask: Mask::Mirrored,
            recorded,
        },
        Some(torques) => Row::Torques(torques),
    }
}
