//! Refuses records with numbers that no axis can show, before anything is drawn.

use prone::torque_map::{Row, TorqueMap};

use super::FigureError;
use super::records::{AngleRecord, ConfirmedRecord, SearchRecord};
use prone_record::pulls::{ChainRecord, CostRecord, JOINTS, PullRecord};

/// Beyond this a difference between neighbouring values is lost; no quantity here comes near it.
const LARGEST: f64 = 1e9;

/// Every sample of every planned chain.
pub(super) fn chains(records: &[ChainRecord]) -> Result<(), FigureError> {
    for record in records {
        for (index, sample) in record.samples.iter().enumerate() {
            let points = sample.points_mm.iter().flat_map(|point| [point.0, point.1]);
            for value in points.chain(sample.parameters_deg).chain([sample.s]) {
                drawable(value, || {
                    format!("planned chain of {}, sample {index}", record.gait)
                })?;
            }
        }
    }
    Ok(())
}

/// Time, cycle and torque of every row of every pull.
pub(super) fn pulls(records: &[PullRecord]) -> Result<(), FigureError> {
    for record in records {
        let PullRecord {
            gait,
            duration_s,
            rows,
        } = record;
        positive(*duration_s, || format!("duration of {gait}, s"))?;
        for (index, row) in rows.iter().enumerate() {
            let place = |what: &str| format!("{what} of {gait}, {duration_s} s, row {index}");
            drawable(row.time_s, || place("time"))?;
            drawable(row.cycle_percent, || place("cycle"))?;
            for (torque, joint) in row.torque_nm.iter().zip(JOINTS) {
                drawable(*torque, || place(&format!("{joint} torque")))?;
            }
        }
    }
    Ok(())
}

/// Both costs at every duration.
pub(super) fn costs(records: &[CostRecord]) -> Result<(), FigureError> {
    for record in records {
        let CostRecord {
            gait,
            duration_s,
            cost_n2m2s,
            published_n2m2s,
        } = record;
        positive(*duration_s, || format!("duration of {gait}, s"))?;
        drawable(*cost_n2m2s, || format!("cost of {gait}, {duration_s} s"))?;
        if let Some(published) = published_n2m2s {
            drawable(*published, || {
                format!("published cost of {gait}, {duration_s} s")
            })?;
        }
    }
    Ok(())
}

/// Time, command and angle of every row of a crawl.
pub(super) fn angles(record: &AngleRecord) -> Result<(), FigureError> {
    for (index, row) in record.rows.iter().enumerate() {
        let angles = row.command_rad.iter().chain(&row.angle_rad);
        for value in angles.chain([&row.time_s]) {
            drawable(*value, || format!("crawl of {}, row {index}", record.gait))?;
        }
    }
    Ok(())
}

/// Every number of a search.
pub(super) fn search(record: &SearchRecord) -> Result<(), FigureError> {
    for row in &record.generations {
        let means = [row.mean_value, row.mean_feasible_value];
        let values = [row.best_violation, row.best_value, row.mean_violation];
        for value in values.into_iter().chain(means.into_iter().flatten()) {
            // A best gait that breaks rules may have no torque at all, and is not drawn there.
            if value.is_finite() {
                drawable(value, || format!("generation {}", row.generation))?;
            }
        }
    }
    Ok(())
}

/// Every number of a confirmation.
pub(super) fn confirmed(rows: &[ConfirmedRecord]) -> Result<(), FigureError> {
    for row in rows {
        let place = || format!("confirmation of {} at {} s", row.gait, row.duration_s);
        positive(row.duration_s, place)?;
        if let Some(ratio) = row.ratio {
            drawable(ratio, place)?;
        }
    }
    Ok(())
}

/// Every torque of a map.
pub(super) fn map(map: &TorqueMap) -> Result<(), FigureError> {
    for (index, row) in map.rows().iter().enumerate() {
        if let Row::Torques(torques) = row {
            for (torque, joint) in torques.to_array().into_iter().zip(JOINTS) {
                drawable(torque, || {
                    format!("{joint} torque of the map's row {index}")
                })?;
            }
        }
    }
    Ok(())
}

fn drawable(value: f64, place: impl FnOnce() -> String) -> Result<(), FigureError> {
    if value.abs() <= LARGEST {
        Ok(())
    } else {
        Err(FigureError::Value {
            place: place(),
            value,
        })
    }
}

fn positive(value: f64, place: impl FnOnce() -> String) -> Result<(), FigureError> {
    /// Shorter than any control step.
    const SHORTEST: f64 = 1e-6;
    if (SHORTEST..=LARGEST).contains(&value) {
        Ok(())
    } else {
        Err(FigureError::Value {
            place: place(),
            value,
        })
    }
}
