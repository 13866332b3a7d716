//! What a study simulates: gaits and durations, in one order.

use prone::gait::{Gait, PhaseDuration, TrajectoryError};
use prone_sim::World;
use prone_sim::pull;

/// Duration that pictures and the contact story show, or the nearest that is studied, s.
const SHOWCASE_S: f64 = 5.0;

/// What to simulate.
#[derive(Debug, Clone)]
pub struct Plan {
    pub(super) gaits: Vec<Gait>,
    pub(super) durations: Vec<PhaseDuration>,
    pub(super) showcase: PhaseDuration,
}

/// Why a study cannot be planned.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum PlanError {
    /// Nothing to simulate.
    #[error("a study needs at least one duration")]
    NoDuration,
    /// Not a phase.
    // `:?`: a number of many digits is written with its exponent.
    #[error(
        "a phase of {seconds:?} s is outside {}..{} s",
        PhaseDuration::SHORTEST,
        PhaseDuration::LONGEST
    )]
    Duration {
        /// What was asked for.
        seconds: f64,
    },
    /// Records are named by tenths of a second, and each is two control steps.
    #[error(
        "a duration of the study is a multiple of 0.1 s (two control steps); {seconds:?} s is not"
    )]
    NotTenths {
        /// What was asked for.
        seconds: f64,
    },
}

impl Plan {
    /// Gaits in the order of the records, and durations in seconds; order and repetitions do not
    /// matter.
    pub fn new(gaits: Vec<Gait>, durations_s: &[f64]) -> Result<Self, PlanError> {
        let mut durations = Vec::new();
        for &seconds in durations_s {
            durations.push(tenths_of_a_second(seconds)?);
        }
        durations.sort_by(|a, b| a.seconds().total_cmp(&b.seconds()));
        durations.dedup();
        // The longer of two that are as near.
        let apart = |duration: &PhaseDuration| (duration.seconds() - SHOWCASE_S).abs();
        let mut by_length = durations.iter().rev();
        let first = *by_length.next().ok_or(PlanError::NoDuration)?;
        let showcase = by_length.fold(first, |best, duration| {
            if apart(duration) < apart(&best) {
                *duration
            } else {
                best
            }
        });
        Ok(Self {
            gaits,
            durations,
            showcase,
        })
    }

    /// Plans every phase and simulates none: what the robot cannot follow is known at once.
    pub fn check(&self, world: &World) -> Result<(), TrajectoryError> {
        for job in super::jobs(self) {
            pull::plan(world, &job.gait, job.duration)?;
        }
        Ok(())
    }

    /// How many phases are simulated: every gait at every duration, and once more with the other
    /// mapping.
    pub fn phases(&self) -> usize {
        self.proper_phases() + self.gaits.len()
    }

    /// How many of them are the study's pulls: every gait at every duration.
    pub fn proper_phases(&self) -> usize {
        self.gaits.len() * self.durations.len()
    }

    /// The gaits, in the order of the records.
    pub fn gaits(&self) -> &[Gait] {
        &self.gaits
    }

    /// Duration that pictures and the contact story show, s.
    pub fn showcase_s(&self) -> f64 {
        self.showcase.seconds()
    }

    /// Durations, ascending, s.
    pub fn durations_s(&self) -> Vec<f64> {
        self.durations
            .iter()
            .map(|duration| duration.seconds())
            .collect()
    }
}

/// The duration that is meant: 0.1 + 0.2 is 0.3, and the same phase as 0.3.
fn tenths_of_a_second(seconds: f64) -> Result<PhaseDuration, PlanError> {
    let tenths = (seconds * 10.0).round();
    // 1e-6 of a tenth: decimal durations are not exact in binary.
    if (seconds * 10.0 - tenths).abs() > 1e-6 {
        return Err(PlanError::NotTenths { seconds });
    }
    PhaseDuration::new(tenths / 10.0).map_err(|_| PlanError::Duration { seconds })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_that_mean_the_same_are_one() {
        let durations = [
            0.3,
            0.1 + 0.2,
            2.0,
            0.299_999_999_9,
            0.1 - 1e-12,
            600.0 + 1e-9,
        ];
        let plan = Plan::new(Vec::new(), &durations).unwrap();
        let bits = |seconds: &[f64]| seconds.iter().map(|s| s.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&plan.durations_s()), bits(&[0.1, 0.3, 2.0, 600.0]));
    }

    #[test]
    fn durations_that_are_no_phase_are_refused_in_few_digits() {
        let refusal = |seconds| Plan::new(Vec::new(), &[seconds]).unwrap_err().to_string();
        for seconds in [
            f64::NAN,
            f64::INFINITY,
            -5.0,
            0.0,
            1e-320,
            1e300,
            600.1,
            0.25,
        ] {
            let refusal = refusal(seconds);
            assert!(refusal.contains(&format!("{seconds:?} s is")), "{refusal}");
            assert!(refusal.len() < 100, "{refusal}");
        }
        assert_eq!(
            Plan::new(Vec::new(), &[]).unwrap_err(),
            PlanError::NoDuration
        );
    }
}
