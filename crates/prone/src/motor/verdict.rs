//! Whether the motors of a robot could do it, and for how long.
//!
//! | measure | continuous | limited |
//! |---|---:|---:|
//! | RMS torque over what the gear passes on of the nominal torque | 1 | 1.7 |
//! | share of the time in which commands move where the supply's voltage is not enough | 25 % | 50 % |
//! | share of that time at the current limit | 5 % | 10 % |
//! | planned speed over the no-load speed | 0.8 | 1.6 |
//! | force on the head, mean over 20 ms, N | 1 | 2 |
//!
//! *Continuous* is within the first column and may go on; *limited* is within the second, for
//! minutes; anything else is *not on a robot*. A gait is judged by its worst motor. Where the bounds
//! come from is said in decision 24: the nominal torque is the manufacturer's word for what can go on,
//! the share of the voltage parts the cycles that ship, and the others are a judgement.

use crate::robot::Robot;

use super::effort::{Effort, UnknownMotor};

/// Mean force over 20 ms from which on the head carries weight, N.
pub const HEAD_CARRIES: f64 = 1.0;

/// Share of the time in which commands move, for which a controller may ask for more than the supply gives.
const SUPPLY_CLIPPED: f64 = 0.25;
/// Share of the time in which commands move, for which a motor may be at its current limit.
const CURRENT_LIMITED: f64 = 0.05;
/// Share of the no-load speed that may be planned: a fifth of the stall torque is left there.
const PLANNED_SPEED: f64 = 0.8;
/// RMS over nominal torque at which a winding warms three times as fast as it can go on with.
const MINUTES: f64 = 1.7;
/// How far beyond what can go on for ever the other measures may be for minutes.
const FOR_MINUTES: f64 = 2.0;

/// How long a robot's motors could go on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Duty {
    /// As long as the battery lasts.
    Continuous,
    /// For minutes.
    Limited,
    /// Not at all.
    NotOnARobot,
}

/// What a run is judged by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// RMS torque over what the gear passes on of the nominal torque.
    RmsTorque,
    /// Share of the time in which commands move where the supply's voltage is not enough.
    SupplyClipped,
    /// Share of the time in which commands move at the current limit.
    CurrentLimited,
    /// Planned speed over the no-load speed.
    PlannedSpeed,
    /// Largest mean force on the head over 20 ms, N.
    Head,
}

/// A measure that is beyond what can go on, of the motor where it is largest.
#[derive(Debug, Clone, PartialEq)]
pub struct Reason {
    /// The measure.
    pub measure: Measure,
    /// The joint that the motor is named after; nothing where it is no motor's.
    pub joint: Option<String>,
    /// Its value.
    pub value: f64,
}

/// A judgement with its reasons.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// How long it could go on.
    pub duty: Duty,
    /// All that is beyond the bound of [`Duty::Continuous`], in the order of [`Measure`].
    pub reasons: Vec<Reason>,
}

/// What is judged.
#[derive(Debug, Clone, Copy)]
pub struct Load<'a> {
    /// The robot.
    pub robot: &'a Robot,
    /// Efficiency of its gears.
    pub gear_efficiency: f64,
    /// What its motors did, rests included.
    pub effort: &'a Effort,
    /// Largest mean force on the head over 20 ms, N.
    pub head: f64,
}

impl Duty {
    /// Name in records.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Continuous => "continuous",
            Self::Limited => "limited",
            Self::NotOnARobot => "not on a robot",
        }
    }
}

impl Measure {
    /// In words.
    pub const fn name(self) -> &'static str {
        match self {
            Self::RmsTorque => "RMS torque over nominal",
            Self::SupplyClipped => "share of the time outside rests with too little voltage",
            Self::CurrentLimited => "share of the time outside rests at the current limit",
            Self::PlannedSpeed => "planned speed over no-load speed",
            Self::Head => "force on the head, N",
        }
    }

    /// Bound up to which a run can go on for ever, and up to which for minutes.
    pub const fn bounds(self) -> (f64, f64) {
        match self {
            Self::RmsTorque => (1.0, MINUTES),
            Self::SupplyClipped => (SUPPLY_CLIPPED, FOR_MINUTES * SUPPLY_CLIPPED),
            Self::CurrentLimited => (CURRENT_LIMITED, FOR_MINUTES * CURRENT_LIMITED),
            Self::PlannedSpeed => (PLANNED_SPEED, FOR_MINUTES * PLANNED_SPEED),
            Self::Head => (HEAD_CARRIES, FOR_MINUTES * HEAD_CARRIES),
        }
    }

    /// How long a run of that value could go on. What is not a number could not.
    pub fn duty(self, value: f64) -> Duty {
        let (continuous, limited) = self.bounds();
        if value <= continuous {
            Duty::Continuous
        } else if value <= limited {
            Duty::Limited
        } else {
            Duty::NotOnARobot
        }
    }
}

impl Verdict {
    /// Judges a run.
    ///
    /// # Errors
    /// [`UnknownMotor`]: without a motor's figures there is no judgement.
    pub fn from_load(load: &Load<'_>) -> Result<Self, UnknownMotor> {
        let Load {
            robot,
            gear_efficiency,
            effort,
            head,
        } = *load;
        let seconds = effort.seconds;
        let mut worst: Vec<Reason> = Vec::new();
        for (drive, motor) in effort.by_drive(robot) {
            let it = motor.motor_use(robot, &drive, seconds, gear_efficiency)?;
            for (measure, value) in [
                (Measure::RmsTorque, it.rms_over_nominal),
                (
                    Measure::SupplyClipped,
                    effort.of_moving(motor.supply_clipped),
                ),
                (
                    Measure::CurrentLimited,
                    effort.of_moving(motor.current_limited),
                ),
                (Measure::PlannedSpeed, it.planned_over_no_load),
            ] {
                let reason = Reason {
                    measure,
                    joint: Some(drive.named_after(robot).name.clone()),
                    value,
                };
                match worst.iter_mut().find(|it| it.measure == measure) {
                    // NaN is the worst, and stays.
                    Some(other) if value.is_nan() || value > other.value => *other = reason,
                    Some(_) => {}
                    None => worst.push(reason),
                }
            }
        }
        worst.push(Reason {
            measure: Measure::Head,
            joint: None,
            value: head,
        });
        let duties = worst.iter().map(|it| it.measure.duty(it.value));
        let duty = duties.fold(Duty::Continuous, Duty::max);
        worst.retain(|it| it.measure.duty(it.value) > Duty::Continuous);
        Ok(Self {
            duty,
            reasons: worst,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motor::MotorEffort;
    use crate::robot::testing::two_armed_with_motors as robot;

    type Change = fn(&mut MotorEffort, f64);

    fn judged(head: f64, change: impl FnOnce(&mut [MotorEffort])) -> Verdict {
        let robot = robot();
        let mut effort = Effort::none(&robot);
        (effort.seconds, effort.moving) = (20.0, 10.0);
        change(&mut effort.motors);
        let load = Load {
            robot: &robot,
            gear_efficiency: 0.6,
            effort: &effort,
            head,
        };
        Verdict::from_load(&load).unwrap()
    }

    #[test]
    fn each_measure_decides_at_its_own_bounds() {
        assert_eq!(judged(0.0, |_| {}).duty, Duty::Continuous);
        let square = |over: f64| (over * 0.6 * 0.5) * (over * 0.6 * 0.5) * 20.0;
        let changes: [(Measure, Change); 3] = [
            (Measure::SupplyClipped, |it, v| it.supply_clipped = v * 10.0),
            (Measure::CurrentLimited, |it, v| {
                it.current_limited = v * 10.0;
            }),
            (Measure::PlannedSpeed, |it, v| it.planned_speed = v * 5.0),
        ];
        for (measure, change) in changes {
            let (continuous, limited) = measure.bounds();
            for (value, duty) in [
                (continuous * 0.99, Duty::Continuous),
                (continuous * 1.01, Duty::Limited),
                (limited * 0.99, Duty::Limited),
                (limited * 1.01, Duty::NotOnARobot),
            ] {
                let verdict = judged(0.0, |motors| change(&mut motors[3], value));
                assert_eq!(verdict.duty, duty, "{measure:?} {value}");
                assert_eq!(verdict.reasons.is_empty(), duty == Duty::Continuous);
            }
        }
        for (over, duty) in [
            (0.99, Duty::Continuous),
            (1.01, Duty::Limited),
            (1.69, Duty::Limited),
            (1.71, Duty::NotOnARobot),
        ] {
            let verdict = judged(0.0, |motors| motors[2].square = square(over));
            assert_eq!(verdict.duty, duty, "{over}");
        }
        for (head, duty) in [
            (0.9, Duty::Continuous),
            (1.5, Duty::Limited),
            (30.0, Duty::NotOnARobot),
            (f64::NAN, Duty::NotOnARobot),
        ] {
            assert_eq!(judged(head, |_| {}).duty, duty, "{head}");
        }
    }

    /// The table at the top of this file.
    #[test]
    fn bounds_are_those_of_the_table() {
        for (measure, bounds) in [
            (Measure::RmsTorque, (1.0, 1.7)),
            (Measure::SupplyClipped, (0.25, 0.5)),
            (Measure::CurrentLimited, (0.05, 0.1)),
            (Measure::PlannedSpeed, (0.8, 1.6)),
            (Measure::Head, (1.0, 2.0)),
        ] {
            assert_eq!(measure.bounds(), bounds, "{measure:?}");
        }
    }

    /// Whichever motor it is of.
    #[test]
    fn limit_what_is_no_number_is_not_on_a_robot() {
        for index in [0, 5] {
            let verdict = judged(0.0, |motors| {
                motors[index].square = f64::NAN;
                motors[3].square = 0.01;
            });
            assert_eq!(verdict.duty, Duty::NotOnARobot, "{index}");
        }
    }

    #[test]
    fn reasons_name_the_worst_motor() {
        let verdict = judged(0.0, |motors| {
            motors[1].current_limited = 0.7;
            motors[4].current_limited = 0.9;
        });
        assert_eq!(verdict.duty, Duty::Limited);
        let [reason] = &verdict.reasons[..] else {
            panic!("{verdict:?}");
        };
        assert_eq!(reason.joint.as_deref(), Some(&*robot().joints[4].name));
        assert!((reason.value - 0.09).abs() < 1e-12);
    }

    #[test]
    fn without_figures_of_motors_there_is_no_verdict() {
        let mut robot = robot();
        robot.joints[1].motor = None;
        let effort = Effort {
            seconds: 1.0,
            moving: 1.0,
            ..Effort::none(&robot)
        };
        let load = Load {
            robot: &robot,
            gear_efficiency: 0.6,
            effort: &effort,
            head: 0.0,
        };
        let error = Verdict::from_load(&load).unwrap_err();
        assert_eq!(error.joint, robot.joints[1].name);
    }
}
