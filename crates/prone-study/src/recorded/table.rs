//! The tables of a record: cells to SI.

use csv::{ReaderBuilder, StringRecord};
use glam::{DQuat, DVec3};

use prone::frames::{Point, Transform};
use prone::robot::JointAngles;

use super::{Cut, ReadError, RecordedBody, RecordedContact, RecordedRow, ground_columns};

/// End of the column of a joint's command; the joint's name is before it.
const COMMAND_COLUMN: &str = "_cmd_rad";

/// A CSV file in memory.
pub(super) struct Table<'a> {
    file: &'a str,
    header: StringRecord,
    /// Complete lines with their numbers.
    lines: Vec<(usize, StringRecord)>,
    /// The first line that is not complete.
    cut: Option<usize>,
}

impl<'a> Table<'a> {
    /// Splits a text into cells. A line without its end, and what comes after a line with more or
    /// fewer cells than the first, is cut off.
    pub(super) fn new(file: &'a str, text: &str) -> Self {
        let whole = text.rfind('\n').map_or("", |end| &text[..=end]);
        let mut table = Self {
            file,
            header: StringRecord::new(),
            lines: Vec::new(),
            cut: None,
        };
        let reader = ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .from_reader(whole.as_bytes());
        let mut last_line = 0;
        for record in reader.into_records() {
            last_line += 1;
            match record {
                Ok(record) if last_line == 1 => table.header = record,
                Ok(record) if record.len() == table.header.len() => {
                    table.lines.push((last_line, record));
                }
                _ => {
                    table.cut = Some(last_line);
                    break;
                }
            }
        }
        if whole.len() < text.len() {
            table.cut = table.cut.or(Some(last_line + 1));
        }
        table
    }

    /// The joints that have columns, in their order.
    pub(super) fn joints(&self) -> Vec<String> {
        let columns = self.header.iter();
        columns
            .filter_map(|column| column.strip_suffix(COMMAND_COLUMN))
            .map(str::to_owned)
            .collect()
    }

    /// The lines as rows of `rows.csv`.
    pub(super) fn rows(
        self,
        joints: &[String],
    ) -> Result<(Vec<RecordedRow>, Option<Cut>), ReadError> {
        let names = [
            "time_s", "cycle", "x_mm", "y_mm", "z_mm", "qw", "qx", "qy", "qz",
        ];
        let fixed = self.columns(names)?;
        let ground = self.columns(ground_columns())?;
        let columns = |end: &str| -> Result<Vec<usize>, ReadError> {
            let columns = joints
                .iter()
                .map(|joint| self.column(&format!("{joint}{end}")));
            columns.collect()
        };
        let (commands, angles, torques) =
            (columns(COMMAND_COLUMN)?, columns("_rad")?, columns("_nm")?);
        Ok(self.each(|cells| {
            let [time_s, cycle, x, y, z, qw, qx, qy, qz] = numbers(cells, fixed)?;
            let list = |columns: &[usize]| -> Option<Vec<f64>> {
                columns
                    .iter()
                    .map(|&column| number(cells, column))
                    .collect()
            };
            Some(RecordedRow {
                time_s,
                cycle: whole(cycle)?,
                ground_from_root: Transform::new(
                    DQuat::from_xyzw(qx, qy, qz, qw).normalize(),
                    metres(x, y, z),
                ),
                command: JointAngles::from_vec(list(&commands)?),
                angles: JointAngles::from_vec(list(&angles)?),
                actuator_torque_nm: list(&torques)?,
                ground_n: numbers(cells, ground)?,
            })
        }))
    }

    /// The lines as contacts of `contacts.csv`.
    pub(super) fn contacts(
        self,
        bodies: &[RecordedBody],
    ) -> Result<(Vec<RecordedContact>, Option<Cut>), ReadError> {
        let [body, with] = self.columns(["body", "with"])?;
        let fixed = self.columns(["time_s", "x_mm", "y_mm", "z_mm", "fx_n", "fy_n", "fz_n"])?;
        Ok(self.each(|cells| {
            let [time_s, x, y, z, fx, fy, fz] = numbers(cells, fixed)?;
            Some(RecordedContact {
                time_s,
                body: bodies.iter().position(|known| known.name == cells[body])?,
                with: cells[with].to_owned(),
                at: Point::new(metres(x, y, z)),
                force_n: DVec3::new(fx, fy, fz),
            })
        }))
    }

    /// What `parse` makes of the lines, up to the first of which it makes nothing.
    fn each<T>(self, parse: impl Fn(&StringRecord) -> Option<T>) -> (Vec<T>, Option<Cut>) {
        let mut found = Vec::with_capacity(self.lines.len());
        let mut cut = self.cut;
        for (line, cells) in &self.lines {
            let Some(row) = parse(cells) else {
                cut = Some(*line);
                break;
            };
            found.push(row);
        }
        let cut = cut.map(|line| Cut {
            file: self.file.to_owned(),
            line,
        });
        (found, cut)
    }

    fn columns<const N: usize>(
        &self,
        names: [impl AsRef<str>; N],
    ) -> Result<[usize; N], ReadError> {
        let mut places = [0; N];
        for (place, name) in places.iter_mut().zip(names) {
            *place = self.column(name.as_ref())?;
        }
        Ok(places)
    }

    fn column(&self, name: &str) -> Result<usize, ReadError> {
        let place = self.header.iter().position(|column| column == name);
        place.ok_or_else(|| ReadError::Column {
            file: self.file.to_owned(),
            column: name.to_owned(),
        })
    }
}

fn number(cells: &StringRecord, column: usize) -> Option<f64> {
    let number: f64 = cells.get(column)?.parse().ok()?;
    number.is_finite().then_some(number)
}

fn numbers<const N: usize>(cells: &StringRecord, columns: [usize; N]) -> Option<[f64; N]> {
    let mut numbers = [0.0; N];
    for (slot, column) in numbers.iter_mut().zip(columns) {
        *slot = number(cells, column)?;
    }
    Some(numbers)
}

/// A small count that was read as a number.
fn whole(number: f64) -> Option<usize> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "checked to be a count"
    )]
    (number.fract() == 0.0 && (0.0..1e9).contains(&number)).then_some(number as usize)
}

fn metres(x_mm: f64, y_mm: f64, z_mm: f64) -> DVec3 {
    DVec3::new(x_mm, y_mm, z_mm) / 1e3
}
