//! `contacts.csv`: every point of contact at every instant.

use std::collections::BTreeSet;
use std::path::Path;

use glam::DVec3;

use prone::frames::Point;

use crate::record_columns::{BODY, FORCE, PLACE, TIME, WITH};
use crate::record_info::Extent;

use super::error::text;
use super::table::{Cells, Table, same_instant};
use super::{
    CONTACTS_FILE, Cut, Damage, Part, ReadError, RecordedBody, RecordedContact, RecordedRow,
};

/// Names of things that a robot touches: more than any scene has.
const MOST_NAMES: usize = 10_000;

/// What `contacts.csv` holds.
#[derive(Default)]
pub(super) struct Contacts {
    pub(super) points: Vec<RecordedContact>,
    /// Of how many rows, from the first on, all contacts are there; none where contacts were not
    /// recorded.
    pub(super) rows: usize,
    pub(super) cut: Option<Cut>,
}

/// Reads the contacts of rows that have so many of them; `rows_cut` says where those break off.
pub(super) fn read(
    folder: &Path,
    extent: &Extent,
    bodies: &[RecordedBody],
    rows: &[RecordedRow],
    counts: &[usize],
    rows_cut: Option<&Cut>,
) -> Result<Contacts, ReadError> {
    if !folder.join(CONTACTS_FILE).exists() {
        let cut = Some(Cut {
            part: Part::Contacts,
            line: 1,
            damage: Damage::NoFile,
        });
        return Ok(Contacts {
            cut,
            ..Contacts::default()
        });
    }
    let table = Table::new(Part::Contacts, &text(folder, CONTACTS_FILE)?);
    let places = Places {
        names: table.columns(folder, [BODY, WITH])?,
        time: table.columns(folder, [TIME])?,
        place: table.columns(folder, PLACE)?,
        force: table.columns(folder, FORCE)?,
    };
    table.check_header(folder, extent)?;
    let mut points = Vec::new();
    let mut names: BTreeSet<String> = BTreeSet::new();
    let mut course = Course::new(rows, counts);
    let cut = table.each(|cells| {
        if course.is_over() && rows_cut.is_some() {
            return Ok(());
        }
        let contact = places.contact(cells, bodies)?;
        course.take(contact.time_s)?;
        if !names.contains(&contact.with) {
            if names.len() == MOST_NAMES {
                return Err(cells.wrong(places.names[1]));
            }
            names.insert(contact.with.clone());
        }
        points.push(contact);
        Ok(())
    });
    let cut = match cut {
        // Of rows that are not there, nothing is missed.
        Some(_) if course.is_over() && rows_cut.is_some() => None,
        Some(cut) => Some(cut),
        None => course.missing().map(|damage| table.cut_at_end(damage)),
    };
    points.truncate(counts[..course.row].iter().sum());
    Ok(Contacts {
        points,
        rows: course.row,
        cut,
    })
}

/// Where the columns are.
struct Places {
    names: [usize; 2],
    time: [usize; 1],
    place: [usize; 3],
    force: [usize; 3],
}

impl Places {
    fn contact(
        &self,
        cells: Cells<'_>,
        bodies: &[RecordedBody],
    ) -> Result<RecordedContact, Damage> {
        let [body, with] = self.names;
        let [time_s] = cells.numbers(self.time)?;
        let millimetres = DVec3::from_array(cells.numbers(self.place)?);
        let force_n = DVec3::from_array(cells.numbers(self.force)?);
        let place = bodies
            .iter()
            .position(|known| known.name == cells.text(body));
        Ok(RecordedContact {
            time_s,
            body: place.ok_or_else(|| cells.wrong(body))?,
            with: cells.text(with).to_owned(),
            at: Point::new(millimetres / 1e3),
            force_n,
        })
    }
}

/// Which contact comes next.
struct Course<'a> {
    rows: &'a [RecordedRow],
    counts: &'a [usize],
    /// The first row of which not all contacts have come.
    row: usize,
    /// How many of that row have.
    taken: usize,
}

impl<'a> Course<'a> {
    fn new(rows: &'a [RecordedRow], counts: &'a [usize]) -> Self {
        let mut course = Self {
            rows,
            counts,
            row: 0,
            taken: 0,
        };
        course.pass_whole();
        course
    }

    fn pass_whole(&mut self) {
        while self.counts.get(self.row) == Some(&self.taken) {
            self.row += 1;
            self.taken = 0;
        }
    }

    fn is_over(&self) -> bool {
        self.row == self.rows.len()
    }

    /// One more contact, at this time.
    fn take(&mut self, time_s: f64) -> Result<(), Damage> {
        match self.rows.get(self.row) {
            Some(row) if same_instant(time_s, row.time_s) => {
                self.taken += 1;
                self.pass_whole();
                Ok(())
            }
            Some(row) if time_s > row.time_s => {
                Err(self.missing().unwrap_or(Damage::ManyContacts { time_s }))
            }
            _ => Err(Damage::ManyContacts { time_s }),
        }
    }

    /// What has not come.
    fn missing(&self) -> Option<Damage> {
        self.rows.get(self.row).map(|row| Damage::FewContacts {
            found: self.taken,
            expected: self.counts[self.row],
            time_s: row.time_s,
        })
    }
}
