//! Choosing the cycle by the slope that the robot feels.

use prone::attitude::{AttitudeFilter, Gains};

use super::CrawlError;
use super::pilot::{Decision, Moment, Pilot, Stage};
use crate::imu::SimulatedImu;

/// Part of the pull whose attitude counts, phases: before it, the body is still being lifted.
const CARRIED: (f64, f64) = (0.3, 0.95);

/// Share of the slope at which the uphill cycle is taken below which it is left again.
const LEAVE: f64 = 0.8;

/// Crawls one cycle on the flat and another uphill. The slope is what the inertial unit tells of
/// the trunk's pitch, less the pitch that the measured joints would give it on a level floor
/// ([`prone::robot::Robot::level_pitch`]: the planned chain knows neither sag nor the thickness of
/// an elbow, which is worth 3°), mean over the pull.
#[derive(Debug)]
pub struct SlopeAware<P> {
    /// Who steers; its choice of cycle is replaced.
    pub steering: P,
    imu: SimulatedImu,
    filter: Option<AttitudeFilter>,
    /// Above which slope, rad, the uphill cycle is taken, and below which it is left again.
    thresholds: (f64, f64),
    uphill: bool,
    sum: f64,
    count: f64,
    felt: Vec<f64>,
}

impl<P: Pilot> SlopeAware<P> {
    /// A pilot that takes cycle 1 above `up`, rad, and cycle 0 again somewhat below it.
    pub fn new(steering: P, imu: SimulatedImu, up: f64) -> Self {
        Self {
            steering,
            imu,
            filter: None,
            thresholds: (up, LEAVE * up),
            uphill: false,
            sum: 0.0,
            count: 0.0,
            felt: Vec::new(),
        }
    }

    /// The slope felt in each pull so far, rad, uphill positive.
    pub fn felt(&self) -> &[f64] {
        &self.felt
    }
}

impl<P: Pilot> Pilot for SlopeAware<P> {
    fn decide(&mut self, now: &Moment<'_, '_>) -> Result<Decision, CrawlError> {
        if self.count > 0.0 {
            let slope = self.sum / self.count;
            let (up, down) = self.thresholds;
            self.uphill = slope > if self.uphill { down } else { up };
            self.felt.push(slope);
        }
        (self.sum, self.count) = (0.0, 0.0);
        Ok(Decision {
            cycle: usize::from(self.uphill),
            ..self.steering.decide(now)?
        })
    }

    fn sense(&mut self, now: &Moment<'_, '_>) {
        self.steering.sense(now);
        let reading = self.imu.read(now.simulation);
        let Some(filter) = &mut self.filter else {
            // At rest: the crawl lets it feel that before the first pull.
            self.filter = AttitudeFilter::aligned(Gains::PUBLISHED, &reading).ok();
            return;
        };
        if filter.update(&reading, now.simulation.time_step()).is_err() {
            return;
        }
        if let Stage::Pull { s, planned_pitch } = now.stage
            && (CARRIED.0..CARRIED.1).contains(&s)
            && let robot = now.simulation.robot()
            && let Some(level) = robot.level_pitch(&now.simulation.joint_angles(), planned_pitch)
            && let Ok(slope) = filter.attitude().slope(level)
        {
            self.sum += slope;
            self.count += 1.0;
        }
    }
}
