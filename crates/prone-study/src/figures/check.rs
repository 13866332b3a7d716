//! Refuses records with numbers that no axis can show, before anything is drawn.

use super::FigureError;
use prone::torque_map::{Row, TorqueMap};

use prone_sim::crawl::Crawl;

use crate::record::{ChainRecord, CostRecord, JOINTS, PullRecord};

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
pub(super) fn crawl(gait: &str, crawl: &Crawl) -> Result<(), FigureError> {
    for (index, row) in crawl.rows.iter().enumerate() {
        let angles = row.command.as_slice().iter().chain(row.angles.as_slice());
        for value in angles.chain([&row.time]) {
            drawable(*value, || format!("crawl of {gait}, row {index}"))?;
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
