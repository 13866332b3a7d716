//! Choosing the cycle by the slope that the robot feels.

use crate::attitude::{AttitudeError, AttitudeFilter, Gains, ImuReading};
use crate::port::InertialUnit;

use super::pilot::{Decision, Moment, Pilot, PilotError, Stage};

/// Part of the pull whose attitude counts, phases: before it, the body is still being lifted.
const CARRIED: (f64, f64) = (0.3, 0.95);

/// Share of the slope at which the uphill cycle is taken below which it is left again.
const LEAVE: f64 = 0.8;

/// Crawls one cycle on the flat and another uphill. The slope is what the inertial unit tells of
/// the trunk's pitch, less the pitch that the measured joints would give it on a level floor
/// ([`crate::robot::Robot::level_pitch`]: the planned chain knows neither sag nor the thickness of
/// an elbow, which is worth 3°), mean over the pull.
///
/// It feels nothing in a cycle without a pull, and ends the crawl there, as it does where the
/// inertial unit fails.
#[derive(Debug, Clone)]
pub struct SlopeAware<P> {
    /// Who steers; its choice of cycle is replaced.
    pub steering: P,
    filter: Option<AttitudeFilter>,
    choice: UphillChoice,
    sum: f64,
    count: f64,
    felt: Vec<f64>,
}

/// Whether the uphill cycle is crawled, with hysteresis.
#[derive(Debug, Clone, Copy, PartialEq)]
struct UphillChoice {
    /// Above which slope, rad, the uphill cycle is taken.
    up: f64,
    uphill: bool,
}

impl UphillChoice {
    fn take(&mut self, slope: f64) {
        let leave = LEAVE * self.up;
        self.uphill = slope > if self.uphill { leave } else { self.up };
    }
}

impl<P: Pilot> SlopeAware<P> {
    /// A pilot that takes cycle 1 above `up`, rad, and cycle 0 again somewhat below it.
    pub fn new(steering: P, up: f64) -> Self {
        Self {
            steering,
            filter: None,
            choice: UphillChoice { up, uphill: false },
            sum: 0.0,
            count: 0.0,
            felt: Vec::new(),
        }
    }

    /// The slope felt in each pull so far, rad, uphill positive.
    pub fn felt(&self) -> &[f64] {
        &self.felt
    }

    /// Adds the slope of one instant at which toes and elbows carry the body.
    fn add(
        &mut self,
        filter: &AttitudeFilter,
        now: &Moment<'_>,
        pitch: f64,
    ) -> Result<(), PilotError> {
        let level = now.robot.level_pitch(&now.senses.angles, pitch);
        let level = level.ok_or(PilotError::NoLevelPitch)?;
        self.sum += filter.attitude().slope(level)?;
        self.count += 1.0;
        Ok(())
    }
}

impl<P: Pilot> Pilot for SlopeAware<P> {
    fn decide(&mut self, now: &Moment<'_>) -> Result<Decision, PilotError> {
        if self.count == 0.0 {
            return Err(PilotError::NotFelt);
        }
        let slope = self.sum / self.count;
        self.choice.take(slope);
        self.felt.push(slope);
        (self.sum, self.count) = (0.0, 0.0);
        Ok(Decision {
            cycle: usize::from(self.choice.uphill),
            ..self.steering.decide(now)?
        })
    }

    fn feel(&mut self, now: &Moment<'_>) -> Result<(), PilotError> {
        self.steering.feel(now)?;
        let reading = match &now.senses.inertial {
            InertialUnit::Reading(reading) => reading,
            InertialUnit::Absent => return Err(PilotError::NoInertialUnit),
            InertialUnit::Failed { reason } => {
                let reason = reason.clone();
                return Err(PilotError::InertialUnit { reason });
            }
        };
        let Some(mut filter) = self.filter.take() else {
            // A pull has no rest in it that an attitude could be taken from.
            if !matches!(now.stage, Stage::Pull { .. }) {
                self.filter = begin(reading)?;
            }
            return Ok(());
        };
        filter.update(reading, now.elapsed)?;
        if let Stage::Pull { s, planned_pitch } = now.stage
            && (CARRIED.0..CARRIED.1).contains(&s)
        {
            self.add(&filter, now, planned_pitch)?;
        }
        self.filter = Some(filter);
        Ok(())
    }
}

/// A filter that begins with a reading at rest, `None` while the robot is still being shaken: the
/// next reading is tried. A pull that is over before there is a filter ends the crawl with
/// [`PilotError::NotFelt`].
fn begin(reading: &ImuReading) -> Result<Option<AttitudeFilter>, AttitudeError> {
    match AttitudeFilter::aligned(Gains::PUBLISHED, reading) {
        Ok(filter) => Ok(Some(filter)),
        Err(AttitudeError::NotAtRest { .. }) => Ok(None),
        Err(error) => Err(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Taken above the threshold, left well below it: in between, whatever was crawled goes on.
    #[test]
    fn the_uphill_cycle_is_taken_late_and_left_late() {
        let mut choice = UphillChoice {
            up: 10.0,
            uphill: false,
        };
        let course = [
            (9.9, false),
            (10.1, true),
            (9.0, true),
            (8.1, true),
            (7.9, false),
            (9.0, false),
            (-20.0, false),
            (10.1, true),
            (-20.0, false),
        ];
        for (slope, uphill) in course {
            choice.take(slope);
            assert_eq!(choice.uphill, uphill, "at {slope}");
        }
    }
}
