//! A torque map together with what carried the robot at each row.

use std::fmt;

use crate::robot::ContactGroup;

use super::{GridError, TorqueMap};

/// Share of all normal force above which a group counts as carrying: a hundredth, half a newton
/// under a robot of five kilograms.
pub const CARRYING_SHARE: f64 = 0.01;

/// Normal force of the floor by [`ContactGroup::OF_THE_STUDY`], both sides together, N.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactForces([f64; 4]);

/// A map, and the contact forces of those rows of which they are known.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedMap {
    map: TorqueMap,
    contacts: Vec<Option<ContactForces>>,
}

impl ContactForces {
    /// In the order of [`ContactGroup::OF_THE_STUDY`].
    pub const fn from_array(newtons: [f64; 4]) -> Self {
        Self(newtons)
    }

    /// In the order of [`ContactGroup::OF_THE_STUDY`].
    pub const fn to_array(self) -> [f64; 4] {
        self.0
    }

    /// The groups that carry more than [`CARRYING_SHARE`] of the whole: the contact mode.
    pub fn carrying(&self) -> impl Iterator<Item = ContactGroup> {
        let least = CARRYING_SHARE * self.0.iter().sum::<f64>();
        let groups = ContactGroup::OF_THE_STUDY.into_iter().zip(self.0);
        groups.filter_map(move |(group, force)| (force > least).then_some(group))
    }
}

/// The contact mode, such as `toe+elbow`; `none` without any force.
impl fmt::Display for ContactForces {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<_> = self.carrying().map(ContactGroup::name).collect();
        if names.is_empty() {
            f.pad("none")
        } else {
            f.pad(&names.join("+"))
        }
    }
}

impl RecordedMap {
    /// A map with one entry of `contacts` per row, in the grid's order.
    ///
    /// # Errors
    /// [`GridError::Rows`] where their number is not the grid's.
    pub fn new(map: TorqueMap, contacts: Vec<Option<ContactForces>>) -> Result<Self, GridError> {
        if contacts.len() == map.grid().len() {
            Ok(Self { map, contacts })
        } else {
            Err(GridError::Rows {
                rows: contacts.len(),
                nodes: map.grid().len(),
            })
        }
    }

    /// The torques.
    pub const fn map(&self) -> &TorqueMap {
        &self.map
    }

    /// The torques alone.
    pub fn into_map(self) -> TorqueMap {
        self.map
    }

    /// Contact forces in the grid's order; `None` where they are not known.
    pub fn contacts(&self) -> &[Option<ContactForces>] {
        &self.contacts
    }
}
