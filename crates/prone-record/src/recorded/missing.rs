//! What was never recorded, in sentences: it is no damage.

use super::{Part, Recorded, RecordedRow};

/// How many joints are named before the others are counted.
const NAMED: usize = 4;

impl Recorded {
    /// What was not recorded, a sentence each. What is missing because a table breaks off is not
    /// among that; [`Recorded::shortfalls`] says it.
    pub fn unrecorded(&self) -> Vec<String> {
        let mut sentences = Vec::new();
        let posed = |row: &RecordedRow| row.ground_from_root.is_some();
        sentences.extend(self.gaps("the pose of the root", posed));
        sentences.extend(self.unrecorded_joints("the angle", |row| row.angles.as_slice()));
        sentences.extend(self.unrecorded_joints("the command", |row| row.command.as_slice()));
        sentences.extend(self.unrecorded_joints("the torque", |row| &row.motor_torque_nm));
        let carried = |row: &RecordedRow| row.ground_n.iter().all(|force| !force.is_nan());
        sentences.extend(self.gaps("the ground's force on every part", carried));
        if !self.run.record.has(Part::Contacts) {
            sentences.push("contacts were not recorded".to_owned());
        }
        sentences
    }

    /// Whether every instant has the angle of every hinge of the model, so that it can be replayed.
    pub fn has_all_angles(&self) -> bool {
        self.missing_angle().is_none()
    }

    /// The first instant, s, that lacks the angle of a hinge of the model, and the hinge's joint.
    pub fn missing_angle(&self) -> Option<(&str, f64)> {
        let hinges = || self.bodies.iter().filter_map(|body| body.hinge);
        self.rows.iter().find_map(|row| {
            let angles = row.angles.as_slice();
            let missing = hinges().find(|hinge| angles[hinge.joint].is_nan())?;
            Some((self.joints[missing.joint].as_str(), row.time_s))
        })
    }

    fn gaps(&self, what: &str, recorded: impl Fn(&RecordedRow) -> bool) -> Option<String> {
        let all = self.rows.len();
        match self.rows.iter().filter(|row| recorded(row)).count() {
            0 => Some(format!("{what} was not recorded")),
            known if known < all => {
                let missing = all - known;
                Some(format!("{what} is missing in {missing} of {all} instants"))
            }
            _ => None,
        }
    }

    fn unrecorded_joints(
        &self,
        what: &str,
        values: impl Fn(&RecordedRow) -> &[f64],
    ) -> Vec<String> {
        let all = self.rows.len();
        let (mut without, mut sentences) = (Vec::new(), Vec::new());
        for (place, joint) in self.joints.iter().enumerate() {
            let known = self.rows.iter().filter(|row| !values(row)[place].is_nan());
            match known.count() {
                0 => without.push(joint.as_str()),
                known if known < all => sentences.push(format!(
                    "{what} of {joint} is missing in {} of {all} instants",
                    all - known
                )),
                _ => {}
            }
        }
        if without.len() == self.joints.len() {
            sentences.push(format!("{what} of the joints was not recorded"));
        } else if !without.is_empty() {
            let named = without.iter().take(NAMED).copied();
            let mut names: Vec<String> = named.map(str::to_owned).collect();
            if let Some(others) = without
                .len()
                .checked_sub(NAMED)
                .filter(|others| *others > 0)
            {
                names.push(format!("{others} others"));
            }
            sentences.push(format!("{what} of {} was not recorded", names.join(", ")));
        }
        sentences
    }
}
