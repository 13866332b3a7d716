//! Rules that a crawled cycle keeps, and by how much it breaks them.
//!
//! With a value v and its limit, a rule is broken by
//!
//! ```text
//! max(v / largest − 1, 0)    height, duration, demanded torque, heat, duty, drift off the line,
//!                            each measure of the motors against the bound of a verdict        (1)
//! max(1 − v / least, 0)      advance, speed, turn                                             (2)
//! max(v − largest, 0)        share of the weight on trunk, head and legs, and on the head     (3)
//! ```
//!
//! What is not a number keeps no rule: it breaks it by [`UNTRIED`].
//!
//! A search and a confirmation ask for height, head, advance, heading and drift alike. A confirmation does
//! not ask again for what a search holds where values count: verdict, speed, duty, heat and duration. Two
//! more differences are on purpose:
//!
//! - In a search a cycle whose highest point is *at* the height breaks nothing, as violations are
//!   continuous and that height is a margin below the ceiling. In a confirmation it does not hold,
//!   as the height is the ceiling itself, and what touches it is stopped ([`holds`]).
//! - A search's least advance is no less than its rules ask, a confirmation asks for a share of what
//!   the cycle itself comes to in the first setting, and that it advances at all.

use prone::motor::{Duty, HEAD_CARRIES, Measure};
use prone::regime::{MotorServo, Servo};

use super::setting::{HOLDS, Role, SettingSpec};
use super::trial::Trial;

/// Violation of a setting that was not simulated, of a cycle that cannot be crawled, and of a value
/// that is not a number: more than what is usually broken in a cycle that was simulated.
pub const UNTRIED: f64 = 1.0;

/// What holds in every setting.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CycleRules {
    /// Highest point of the robot, m.
    pub ceiling: f64,
    /// Least advance per cycle where values count, m.
    pub advance: f64,
    /// Largest share of the weight on trunk, head and legs during the pull, 0 to 1.
    pub body_share: f64,
    /// Largest duration of a cycle, s.
    pub seconds: f64,
    /// Largest torque that the position error of a shoulder asks for, N·m, with the robot's own
    /// stiffness: a servo that is four times as stiff asks for four times as much of the same lag,
    /// and no gait would be left.
    pub demanded_shoulder: f64,
    /// Largest mean force on the head over 20 ms, N.
    pub head: f64,
    /// Largest heat, merged over servos.
    pub heat: f64,
    /// Farthest from the line where the heading is held, m.
    pub drift: f64,
    /// Least of what the motors of a robot could do in the first setting ([`Duty::NotOnARobot`] asks
    /// for nothing).
    pub verdict: Duty,
    /// Least speed where values count, m/s.
    pub least_speed: f64,
    /// Largest duty, RMS over nominal torque, with the robot's own servos where values count.
    pub most_duty: f64,
}

impl CycleRules {
    /// None but that it advances at all, and not on its head.
    pub const FREE: Self = Self {
        ceiling: f64::INFINITY,
        advance: 0.01,
        body_share: 1.0,
        seconds: f64::INFINITY,
        demanded_shoulder: f64::INFINITY,
        head: HEAD_CARRIES,
        heat: f64::INFINITY,
        drift: f64::INFINITY,
        verdict: Duty::NotOnARobot,
        least_speed: 0.0,
        most_duty: f64::INFINITY,
    };

    /// What a cycle of a duration, s, breaks.
    pub(super) fn broken_by_duration(&self, seconds: f64) -> f64 {
        above(seconds, self.seconds)
    }

    /// What a heat breaks, merged over the settings in which values count.
    pub(super) fn broken_by_heat(&self, heat: f64) -> f64 {
        if self.heat < f64::INFINITY {
            above(heat, self.heat)
        } else {
            0.0
        }
    }

    /// What a trial breaks, rule by rule, in a setting; the first setting's advance is what others keep a
    /// share of, m.
    pub(super) fn broken_by_trial(
        &self,
        spec: &SettingSpec,
        trial: &Trial,
        first_advance: f64,
    ) -> Vec<(&'static str, f64)> {
        let (role, servo) = (spec.role, spec.regime.servo);
        if role == Role::Beside {
            return Vec::new();
        }
        let least = match role.keep() {
            None => self.advance,
            Some(share) => share * first_advance.max(self.advance),
        };
        let mut broken = vec![
            ("advance", below(trial.advance, least)),
            ("heading", role.misdirected(trial)),
            ("ceiling", above(trial.top.0, self.ceiling)),
            ("head", on_the_head(trial, self.head)),
        ];
        if spec.held {
            broken.push(("drift", above(trial.drift, self.drift)));
        }
        if self.body_share < 1.0 && role == Role::Value {
            let excess = number(trial.body_share - self.body_share).max(0.0);
            broken.push(("body-share", excess));
        }
        let own = servo == Servo::DcMotor(MotorServo::ROBOT);
        if own && role == Role::Value {
            broken.push(("verdict", beyond(self.verdict, trial)));
        }
        if self.least_speed > 0.0 && role == Role::Value {
            broken.push(("speed", below(trial.speed(), self.least_speed)));
        }
        if own && self.most_duty < f64::INFINITY && role == Role::Value {
            broken.push(("duty", above(trial.duty.0, self.most_duty)));
        }
        if own {
            let excess = above(trial.demanded_shoulder, self.demanded_shoulder);
            broken.push(("demanded-shoulder", excess));
        }
        broken
    }
}

impl Role {
    /// By how much a trial turns too much or too little, in shares of the limit.
    pub fn misdirected(self, trial: &Trial) -> f64 {
        match self {
            Self::Turn(angle) => below(trial.yaw, angle),
            Self::Value | Self::Keep(_) | Self::Beside => 0.0,
        }
    }
}

/// Whether a cycle does in a setting what its role asks of a confirmation: it stays below the ceiling,
/// m, keeps the force on its head to a bound, N, goes where it should, stays near its line where the heading
/// is held, advances, and keeps its share of the first setting's advance.
pub fn holds(spec: &SettingSpec, trial: &Trial, kept: f64, bounds: Bounds) -> bool {
    let role = spec.role;
    let enough = kept >= role.keep().unwrap_or(HOLDS);
    let on_its_line = !spec.held || trial.drift <= bounds.drift;
    let directed = role.misdirected(trial) <= 0.0 && on_its_line;
    let free = trial.top.0 < bounds.ceiling && trial.head <= bounds.head;
    role == Role::Beside || (free && enough && directed && trial.advance > 0.0)
}

/// What a confirmation holds a cycle to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Below which everything stays, m.
    pub ceiling: f64,
    /// Largest mean force on the head over 20 ms, N.
    pub head: f64,
    /// Farthest from the line where the heading is held, m.
    pub drift: f64,
}

impl Bounds {
    /// Of a cycle that is only compared with.
    pub const NONE: Self = Self {
        ceiling: f64::INFINITY,
        head: f64::INFINITY,
        drift: f64::INFINITY,
    };
}

/// Equation (1) of each measure of a motor that is beyond the bound of a duty; the head has a rule of
/// its own.
fn beyond(duty: Duty, trial: &Trial) -> f64 {
    if duty == Duty::NotOnARobot {
        return 0.0;
    }
    let Some(verdict) = &trial.verdict else {
        return UNTRIED;
    };
    let motors = verdict.reasons.iter();
    let motors = motors.filter(|reason| reason.measure != Measure::Head);
    let excess = motors.map(|reason| {
        let (continuous, limited) = reason.measure.bounds();
        let bound = match duty {
            Duty::Continuous => continuous,
            Duty::Limited | Duty::NotOnARobot => limited,
        };
        above(reason.value, bound)
    });
    excess.sum()
}

/// Equation (3) of the force on the head, over the weight.
fn on_the_head(trial: &Trial, largest: f64) -> f64 {
    if trial.head <= largest {
        return 0.0;
    }
    number((trial.head - largest) / trial.weight).max(0.0)
}

/// Equation (1); what may be infinite is not held.
pub(super) fn above(value: f64, largest: f64) -> f64 {
    if value <= largest {
        return 0.0;
    }
    number(value / largest - 1.0).max(0.0)
}

/// Equation (2).
fn below(value: f64, least: f64) -> f64 {
    if value >= least {
        return 0.0;
    }
    number(1.0 - value / least).max(0.0)
}

/// An amount that adds up and compares.
fn number(amount: f64) -> f64 {
    if amount.is_nan() { UNTRIED } else { amount }
}

#[cfg(test)]
mod tests;
