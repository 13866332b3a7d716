//! Which part carries the body when.

use serde::{Deserialize, Serialize};

use crate::pulls::PullRecord;

/// Shares of the ground's normal force over one pull.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ContactStory {
    /// Name of the gait.
    pub gait: String,
    /// Duration of the phase, s.
    pub duration_s: f64,
    /// Tenths of the phase: percent of the normal force on toes, elbows, torso and legs.
    pub tenths_percent: Vec<[f64; 4]>,
    /// Percent of the whole phase's normal force that torso and legs carry: what the chain does
    /// not.
    pub body_share_percent: f64,
    /// From where on toes and elbows carry more than half to the end, percent of the phase;
    /// `None` where they never do.
    pub carried_from_percent: Option<f64>,
}

/// Reads the story of one pull.
pub fn of(pull: &PullRecord) -> ContactStory {
    let rows = pull.rows.len();
    let tenths_percent = (0..10)
        .map(|tenth| {
            let rows = &pull.rows[tenth * rows / 10..(tenth + 1) * rows / 10];
            shares(rows.iter().map(|row| row.contact_n))
        })
        .collect();
    let [_, _, torso, leg] = shares(pull.rows.iter().map(|row| row.contact_n));
    let on_body = |contact: [f64; 4]| {
        let [_, _, torso, leg] = shares([contact].into_iter());
        torso + leg >= 50.0
    };
    let last_on_body = pull.rows.iter().rposition(|row| on_body(row.contact_n));
    let carried_from_percent = match last_on_body {
        None => Some(0.0),
        Some(last) if last + 1 == rows => None,
        Some(last) => Some(pull.rows[last].cycle_percent),
    };
    ContactStory {
        gait: pull.gait.clone(),
        duration_s: pull.duration_s,
        tenths_percent,
        body_share_percent: torso + leg,
        carried_from_percent,
    }
}

/// Percent of the summed force on each group; zeros where nothing touches.
fn shares(contacts: impl Iterator<Item = [f64; 4]>) -> [f64; 4] {
    let mut sums = [0.0; 4];
    for contact in contacts {
        for (sum, force) in sums.iter_mut().zip(contact) {
            *sum += force;
        }
    }
    let total: f64 = sums.iter().sum();
    if total > 0.0 {
        sums.map(|sum| 100.0 * sum / total)
    } else {
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pulls::PullRow;

    fn pull(contacts: &[[f64; 4]]) -> PullRecord {
        let rows = contacts.iter().enumerate().map(|(k, &contact_n)| PullRow {
            time_s: 0.05 * (k + 1) as f64,
            cycle_percent: 100.0 * (k + 1) as f64 / contacts.len() as f64,
            torque_nm: [0.0; 4],
            command_rad: [0.0; 7],
            angle_rad: [0.0; 7],
            contact_n,
            squeeze_n: 0.0,
            top_mm: 0.0,
            head_top_mm: 0.0,
        });
        PullRecord {
            gait: "nominal".to_owned(),
            duration_s: 1.0,
            rows: rows.collect(),
        }
    }

    fn assert_shares(ours: [f64; 4], expected: [f64; 4]) {
        for (share, expected) in ours.into_iter().zip(expected) {
            assert!((share - expected).abs() < 1e-9, "{share} is not {expected}");
        }
    }

    #[test]
    fn a_body_that_lifts_at_a_third_is_carried_from_there() {
        let mut contacts = [[0.0, 0.0, 50.0, 0.0]; 30];
        contacts[10..].fill([20.0, 30.0, 0.0, 0.0]);
        let story = of(&pull(&contacts));
        assert!((story.carried_from_percent.unwrap() - 100.0 / 3.0).abs() < 1e-9);
        assert!((story.body_share_percent - 100.0 / 3.0).abs() < 1e-9);
        assert_shares(story.tenths_percent[0], [0.0, 0.0, 100.0, 0.0]);
        assert_shares(story.tenths_percent[9], [40.0, 60.0, 0.0, 0.0]);
    }

    #[test]
    fn ends_of_the_story() {
        assert_eq!(
            of(&pull(&[[0.0, 0.0, 5.0, 5.0]; 20])).carried_from_percent,
            None
        );
        assert_eq!(
            of(&pull(&[[5.0, 5.0, 1.0, 0.0]; 20])).carried_from_percent,
            Some(0.0)
        );
        let airborne = of(&pull(&[[0.0; 4]; 20]));
        assert_shares(airborne.tenths_percent[3], [0.0; 4]);
    }
}
