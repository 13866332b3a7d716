//! `rows.csv`: all instants, with the channels that were recorded.

use std::path::Path;

use glam::{DQuat, DVec3};

use prone::frames::{Ground, Root, Transform};
use prone::robot::{ContactGroup, JointAngles};

use super::table::{Cells, Table, same_instant};
use super::{Cut, Damage, ReadError, RecordedRow};
use crate::record_columns::{
    ANGLE_END, COMMAND_END, CONTACTS, CYCLE, PHASE, PLACE, STAGE, STAGES, TIME, TORQUE_END, TURN,
    grounds,
};
use crate::record_info::Extent;

/// How far the length of a recorded quaternion may be from one: it has seven decimals.
const UNIT: f64 = 1e-4;

/// What `rows.csv` holds.
pub(super) struct Rows {
    pub(super) joints: Vec<String>,
    pub(super) instants: Vec<RecordedRow>,
    pub(super) stages: Vec<(usize, String)>,
    pub(super) columns: Vec<(String, Vec<f64>)>,
    /// How many contacts each row has; empty where that was not recorded.
    pub(super) contact_counts: Vec<usize>,
    pub(super) cut: Option<Cut>,
}

/// Where the columns are that there are.
struct Places {
    time: usize,
    cycle: Option<usize>,
    stage: Option<usize>,
    phase: Option<usize>,
    contacts: Option<usize>,
    /// x, y, z; w, x, y, z of the root's quaternion.
    root: Option<[usize; 7]>,
    ground: [Option<usize>; ContactGroup::COUNT],
    commands: Vec<Option<usize>>,
    angles: Vec<Option<usize>>,
    torques: Vec<Option<usize>>,
}

impl Places {
    fn find(table: &Table, joints: &[String], folder: &Path) -> Result<Self, ReadError> {
        let of_joints = |end: &str| {
            let names = joints.iter().map(|joint| format!("{joint}{end}"));
            names.map(|name| table.find(&name)).collect()
        };
        let root = PLACE.iter().chain(&TURN).map(|name| table.find(name));
        let root: Option<Vec<usize>> = root.collect();
        Ok(Self {
            time: table.column(folder, TIME)?,
            cycle: table.find(CYCLE),
            stage: table.find(STAGE),
            phase: table.find(PHASE),
            contacts: table.find(CONTACTS),
            root: root.and_then(|columns| columns.try_into().ok()),
            ground: grounds().map(|name| table.find(&name)),
            commands: of_joints(COMMAND_END),
            angles: of_joints(ANGLE_END),
            torques: of_joints(TORQUE_END),
        })
    }

    /// Name of the stage; empty where it was not recorded.
    fn stage<'a>(&self, cells: Cells<'a>) -> Result<&'a str, Damage> {
        if let Some(column) = self.phase
            && let Some(phase) = cells.optional(column)?
            && !(0.0..=1.0).contains(&phase)
        {
            return Err(cells.outside(column, "0 to 1".to_owned()));
        }
        match self.stage {
            Some(column) if !["", STAGES[0], STAGES[1]].contains(&cells.text(column)) => {
                Err(cells.outside(column, STAGES.join(" or ")))
            }
            stage => Ok(stage.map_or("", |column| cells.text(column))),
        }
    }

    fn row(&self, cells: Cells<'_>) -> Result<RecordedRow, Damage> {
        let posture = |columns: &[Option<usize>]| -> Result<JointAngles, Damage> {
            JointAngles::try_from_fn(columns.len(), |joint| cells.recorded(columns[joint.0]))
        };
        let torques = self.torques.iter().map(|&at| cells.recorded(at));
        let torques: Vec<f64> = torques.collect::<Result<_, Damage>>()?;
        let mut ground_n = [f64::NAN; ContactGroup::COUNT];
        for (force, column) in ground_n.iter_mut().zip(self.ground) {
            *force = cells.recorded(column)?;
        }
        let [time_s] = cells.numbers([self.time])?;
        Ok(RecordedRow {
            time_s,
            cycle: self.cycle.map_or(Ok(1), |column| cells.count(column, 1))?,
            ground_from_root: self.pose(cells)?,
            command: posture(&self.commands)?,
            angles: posture(&self.angles)?,
            motor_torque_nm: torques,
            ground_n,
        })
    }

    /// Pose of the root; nothing where a part of it was not recorded.
    fn pose(&self, cells: Cells<'_>) -> Result<Option<Transform<Ground, Root>>, Damage> {
        let Some(columns) = self.root else {
            return Ok(None);
        };
        let mut numbers = [f64::NAN; 7];
        for (number, column) in numbers.iter_mut().zip(columns) {
            *number = cells.recorded(Some(column))?;
        }
        let [x, y, z, qw, qx, qy, qz] = numbers;
        if numbers.iter().any(|number| number.is_nan()) {
            return Ok(None);
        }
        let turn = DQuat::from_xyzw(qx, qy, qz, qw);
        let length = turn.length();
        if (length - 1.0).abs() > UNIT {
            return Err(Damage::Turn { length });
        }
        let at = DVec3::new(x, y, z) / 1e3;
        Ok(Some(Transform::new(turn.normalize(), at)))
    }
}

/// Names of the joints of which something was recorded, in the order of their first columns.
fn joints(table: &Table) -> Vec<String> {
    let mut joints: Vec<String> = Vec::new();
    for column in table.header() {
        let ends = [COMMAND_END, ANGLE_END, TORQUE_END];
        let joint = ends.iter().find_map(|end| column.strip_suffix(end));
        if let Some(joint) = joint
            && !joints.iter().any(|known| known == joint)
        {
            joints.push(joint.to_owned());
        }
    }
    joints
}

impl Rows {
    /// The rows of a table, up to where one is damaged or missing. `model_joints` that have no
    /// column follow those that have.
    pub(super) fn read(
        table: &Table,
        extent: &Extent,
        model_joints: &[String],
        folder: &Path,
    ) -> Result<Self, ReadError> {
        let mut joints = joints(table);
        for joint in model_joints {
            if !joints.contains(joint) {
                joints.push(joint.clone());
            }
        }
        let places = Places::find(table, &joints, folder)?;
        table.check_header(folder, extent)?;
        let numbers: Vec<(usize, &str)> = table
            .header()
            .enumerate()
            .filter(|&(_, name)| name != STAGE)
            .collect();
        let mut found = Self {
            joints,
            instants: Vec::new(),
            stages: Vec::new(),
            columns: numbers
                .iter()
                .map(|(_, name)| ((*name).to_owned(), Vec::new()))
                .collect(),
            contact_counts: Vec::new(),
            cut: None,
        };
        let expected = extent.rows;
        let cut = table.each(|cells| {
            let index = found.instants.len();
            if index == expected {
                return Err(Damage::ManyRows { expected });
            }
            let row = places.row(cells)?;
            let stage = places.stage(cells)?;
            check_time(row.time_s, extent, index, found.instants.last())?;
            let values: Vec<Option<f64>> = numbers
                .iter()
                .map(|&(column, _)| cells.optional(column))
                .collect::<Result<_, _>>()?;
            if let Some(column) = places.contacts {
                found.contact_counts.push(cells.count(column, 0)?);
            }
            found.instants.push(row);
            for ((_, column), value) in found.columns.iter_mut().zip(values) {
                column.push(value.unwrap_or(f64::NAN));
            }
            if !stage.is_empty() && found.stages.last().is_none_or(|(_, last)| last != stage) {
                found.stages.push((index, stage.to_owned()));
            }
            Ok(())
        });
        let rows = found.instants.len();
        // A record has at least one, whatever it says of itself.
        let expected = expected.max(1);
        found.cut = cut.or_else(|| {
            let few = Damage::FewRows {
                found: rows,
                expected,
            };
            (rows < expected).then(|| table.cut_at_end(few))
        });
        match &found.cut {
            Some(cut) if rows == 0 => Err(ReadError::NoRows {
                folder: folder.display().to_string(),
                cut: cut.clone(),
            }),
            _ => Ok(found),
        }
    }
}

/// Checks that a row is the one that is due, or follows the one before where rows have no fixed
/// step. The last one may come early, as it ends with the record.
fn check_time(
    found: f64,
    extent: &Extent,
    index: usize,
    before: Option<&RecordedRow>,
) -> Result<(), Damage> {
    match (extent.row_step_s, before) {
        (Some(step), _) => {
            let due = (index + 1) as f64 * step;
            let is_last = index + 1 == extent.rows;
            let early = is_last && found < due && found > due - step;
            if same_instant(found, due) || early {
                Ok(())
            } else {
                Err(Damage::Time { found, due })
            }
        }
        (None, Some(before)) if found <= before.time_s => {
            let last = before.time_s;
            Err(Damage::Order { found, last })
        }
        (None, _) => Ok(()),
    }
}
