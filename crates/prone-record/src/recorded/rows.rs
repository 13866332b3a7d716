//! `rows.csv`: all instants.

use std::path::Path;

use glam::{DQuat, DVec3};

use prone::frames::Transform;
use prone::robot::{ContactGroup, JointAngles};

use super::table::{Cells, Table, same_instant};
use super::{Cut, Damage, Extent, ReadError, RecordedRow};

/// End of the column of a joint's command; the joint's name is before it.
const COMMAND_COLUMN: &str = "_cmd_rad";

/// The only column that holds no numbers.
const STAGE: &str = "stage";

/// How far the length of a recorded quaternion may be from one: it has seven decimals.
const UNIT: f64 = 1e-4;

/// What `rows.csv` holds.
pub(super) struct Rows {
    pub(super) joints: Vec<String>,
    pub(super) instants: Vec<RecordedRow>,
    pub(super) stages: Vec<(usize, String)>,
    pub(super) columns: Vec<(String, Vec<f64>)>,
    /// How many contacts each row has.
    pub(super) contact_counts: Vec<usize>,
    pub(super) cut: Option<Cut>,
}

/// Where the columns are.
struct Places {
    fixed: [usize; 8],
    cycle: usize,
    contacts: usize,
    stage: usize,
    ground: [usize; 4],
    commands: Vec<usize>,
    angles: Vec<usize>,
    torques: Vec<usize>,
}

impl Places {
    fn of(table: &Table, joints: &[String], folder: &Path) -> Result<Self, ReadError> {
        let fixed = ["time_s", "x_mm", "y_mm", "z_mm", "qw", "qx", "qy", "qz"];
        let ground = ContactGroup::ALL.map(|group| format!("{}_n", group.name()));
        let of_joints = |end: &str| -> Result<Vec<usize>, ReadError> {
            let names = joints.iter().map(|joint| format!("{joint}{end}"));
            names.map(|name| table.column(folder, &name)).collect()
        };
        Ok(Self {
            fixed: table.columns(folder, fixed)?,
            cycle: table.column(folder, "cycle")?,
            contacts: table.column(folder, "contacts")?,
            stage: table.column(folder, STAGE)?,
            ground: table.columns(folder, ground)?,
            commands: of_joints(COMMAND_COLUMN)?,
            angles: of_joints("_rad")?,
            torques: of_joints("_nm")?,
        })
    }

    fn row(&self, cells: Cells<'_>) -> Result<RecordedRow, Damage> {
        let [time_s, x, y, z, qw, qx, qy, qz] = cells.numbers(self.fixed)?;
        let turn = DQuat::from_xyzw(qx, qy, qz, qw);
        let length = turn.length();
        if (length - 1.0).abs() > UNIT {
            return Err(Damage::Turn { length });
        }
        let number = |column: usize| Ok(cells.numbers([column])?[0]);
        let posture = |columns: &[usize]| -> Result<JointAngles, Damage> {
            JointAngles::try_from_fn(columns.len(), |joint| number(columns[joint.0]))
        };
        let torques: Result<_, Damage> = self.torques.iter().map(|&at| number(at)).collect();
        Ok(RecordedRow {
            time_s,
            cycle: cells.count(self.cycle)?,
            ground_from_root: Transform::new(turn.normalize(), DVec3::new(x, y, z) / 1e3),
            command: posture(&self.commands)?,
            angles: posture(&self.angles)?,
            actuator_torque_nm: torques?,
            ground_n: cells.numbers(self.ground)?,
        })
    }
}

impl Rows {
    /// The rows of a table, up to where one is damaged or missing.
    pub(super) fn of(table: &Table, extent: &Extent, folder: &Path) -> Result<Self, ReadError> {
        let commands = table.header();
        let joints: Vec<String> = commands
            .filter_map(|column| column.strip_suffix(COMMAND_COLUMN))
            .map(str::to_owned)
            .collect();
        let places = Places::of(table, &joints, folder)?;
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
            let due = (index + 1) as f64 * extent.row_step_s;
            if !same_instant(row.time_s, due) {
                let found = row.time_s;
                return Err(Damage::Time { found, due });
            }
            let values: Vec<Option<f64>> = numbers
                .iter()
                .map(|&(column, _)| cells.optional(column))
                .collect::<Result<_, _>>()?;
            found.contact_counts.push(cells.count(places.contacts)?);
            found.instants.push(row);
            for ((_, column), value) in found.columns.iter_mut().zip(values) {
                column.push(value.unwrap_or(f64::NAN));
            }
            let stage = cells.text(places.stage);
            if found.stages.last().is_none_or(|(_, last)| last != stage) {
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
