//! A cost in two parts: torque, and by how much the gait breaks the rules.
//!
//! Costs compare lexicographically (Deb 2000, *An efficient constraint handling method for
//! genetic algorithms*): less violation wins, and only between equals less torque. A violation is
//! graded, as a share of its limit, so that a search knows its way to the feasible gaits:
//!
//! ```text
//! rate:       |Δθ| / (Δt · limit) − 1      per joint and interval               (1)
//! clearance:  (required − height) / required                                    (2)
//! closure:    |cos| − 1                    of equation (4) of the chain         (3)
//! floor:      depth / l5                   of the lowest joint centre           (4)
//! torque:     1                            where the source has no answer       (5)
//! body share: (share − allowed) / (1 − allowed), once a phase                   (6)
//! limits:     |θ − stop| / (upper − lower stop)  per joint                     (7)
//! ```
//!
//! summed over samples. (1) to (4) are the planned chain's own ([`violations`]) and need no torques;
//! (7) needs the robot's joints and is added by whoever maps them ([`Violations::add_limits`]).
//! The torque part is one of (trapezoid rule over equal intervals)
//!
//! ```text
//! ∫ Σ w τ² dt  [N²·m²·s],   max |τ|/τ_rated  [1],   ∫ Σ (τ/τ_nominal)² dt  [s]   (8)
//! ```
//!
//! per phase, or divided by the metres the phase advances.

use std::collections::BTreeMap;

use crate::chain::{ChainAngles, ClosedChain, ClosureError, GaitParameters};
use crate::robot::Range;
use crate::torque_map::{JointTorques, TorqueGap, TorqueSource};

/// A rule that a gait can break.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rule {
    /// The chain closes.
    Closure,
    /// No joint centre is below the floor.
    Floor,
    /// The source knows the torques.
    Torque,
    /// The body keeps its height.
    Clearance,
    /// No joint is faster than its limit.
    Rate,
    /// Trunk and legs carry no more than their share of the weight.
    BodyShare,
    /// No joint is commanded further than it may be.
    Limits,
}

impl Rule {
    /// Name in files and records.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Closure => "closure",
            Self::Floor => "floor",
            Self::Torque => "torque",
            Self::Clearance => "clearance",
            Self::Rate => "rate",
            Self::BodyShare => "body-share",
            Self::Limits => "limits",
        }
    }
}

/// By how much a rule is broken.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Excess {
    /// How often.
    pub count: u32,
    /// Sum, shares of the limit.
    pub sum: f64,
    /// The largest, share of the limit.
    pub worst: f64,
}

/// All rules that are broken.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Violations(BTreeMap<Rule, Excess>);

impl Violations {
    /// Adds an excess, a share of the limit; nothing unless it is positive or not a number.
    pub fn add(&mut self, rule: Rule, excess: f64) {
        if excess <= 0.0 {
            return;
        }
        let excess = if excess.is_nan() { f64::MAX } else { excess };
        let entry = self.0.entry(rule).or_default();
        entry.count += 1;
        entry.sum += excess;
        entry.worst = entry.worst.max(excess);
    }

    /// Adds (7) for each joint that lies outside its stops; angles and stops are by joint of the
    /// robot, rad. A posture that has not one stop for each joint is held by none: that counts as
    /// not a number.
    pub fn add_limits(&mut self, angles: &[f64], stops: &[Range]) {
        if angles.len() != stops.len() {
            self.add(Rule::Limits, f64::NAN);
        }
        for (&angle, stop) in angles.iter().zip(stops) {
            let excess = stop.excess(angle).abs() / (stop.upper - stop.lower);
            self.add(Rule::Limits, excess);
        }
    }

    /// Sum over all rules; zero exactly for a feasible gait.
    pub fn total(&self) -> f64 {
        self.0
            .values()
            .fold(0.0, |total, excess| total + excess.sum)
    }

    /// The broken rules, in order.
    pub fn iter(&self) -> impl Iterator<Item = (Rule, Excess)> + '_ {
        self.0.iter().map(|(&rule, &excess)| (rule, excess))
    }
}

/// Which torque part of (8); arrays are in the order of [`JointTorques`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Norm {
    /// ∫ Σ w τ² dt.
    SquaredTorque {
        /// w.
        weights: [f64; 4],
    },
    /// max |τ|/`τ_rated`.
    Peak {
        /// `τ_rated`, N·m.
        rated: [f64; 4],
    },
    /// ∫ Σ (τ/`τ_nominal`)² dt.
    Heat {
        /// `τ_nominal`, N·m.
        nominal: [f64; 4],
    },
}

impl Norm {
    /// The norm of equally spaced torques, `interval` seconds apart.
    pub fn of(&self, torques: &[JointTorques], interval: f64) -> f64 {
        match self {
            Self::SquaredTorque { weights } => integral(torques, interval, |tau| {
                tau.iter()
                    .zip(weights)
                    .map(|(tau, weight)| weight * tau * tau)
                    .sum()
            }),
            Self::Peak { rated } => torques
                .iter()
                .flat_map(|row| row.to_array().into_iter().zip(rated))
                .map(|(tau, rated)| tau.abs() / rated)
                .fold(0.0, f64::max),
            Self::Heat { nominal } => integral(torques, interval, |tau| {
                tau.iter()
                    .zip(nominal)
                    .map(|(tau, nominal)| (tau / nominal).powi(2))
                    .sum()
            }),
        }
    }
}

fn integral(torques: &[JointTorques], interval: f64, of: impl Fn([f64; 4]) -> f64) -> f64 {
    let values: Vec<f64> = torques.iter().map(|row| of(row.to_array())).collect();
    values
        .windows(2)
        .map(|pair| 0.5 * (pair[0] + pair[1]) * interval)
        .sum()
}

/// What the torque part is divided by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Per {
    /// Nothing: one phase.
    Phase,
    /// The metres that one phase advances.
    Metre {
        /// Advance of the shoulder in one phase, m.
        advance: f64,
    },
}

impl Per {
    /// That share of a phase's torque part.
    pub fn of(self, torque: f64) -> f64 {
        match self {
            Self::Phase => torque,
            Self::Metre { advance } => torque / advance,
        }
    }
}

/// What a gait has to keep to.
pub struct Rules<Height> {
    /// Height to be kept by whatever `height` measures, m; where it is not positive, none is asked.
    pub clearance: f64,
    /// Height of the lowest part that must not touch, m: the hip centre, or the body's shapes.
    pub height: Height,
    /// Fastest joint allowed, rad/s; infinite for none.
    pub rate: f64,
}

/// A phase whose cost is asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Phase<'a> {
    /// Gait parameters at equal intervals.
    pub samples: &'a [GaitParameters],
    /// Time between samples, s.
    pub interval: f64,
}

/// The torque part (8) of a phase, and in how many samples the source does not know the torques of a
/// chain that closes (5). It is not a number where some sample has no torques.
pub fn torque_part(phase: Phase<'_>, source: &impl TorqueSource, norm: &Norm) -> (f64, u32) {
    let mut gaps = 0;
    let mut torques = Vec::with_capacity(phase.samples.len());
    for &sample in phase.samples {
        match source.torques(sample) {
            Ok(row) => torques.push(row),
            // Graded already, as (3).
            Err(TorqueGap::Closure(_)) => {}
            Err(_) => gaps += 1,
        }
    }
    let known = torques.len() == phase.samples.len();
    let torque = known.then(|| norm.of(&torques, phase.interval));
    (torque.unwrap_or(f64::NAN), gaps)
}

/// The rules (1) to (4) that the planned chain breaks.
pub fn violations<Height: Fn(&ChainAngles) -> f64>(
    chain: &ClosedChain,
    phase: Phase<'_>,
    rules: &Rules<Height>,
) -> Violations {
    let mut violations = Violations::default();
    let mut before = None;
    for &sample in phase.samples {
        let angles = match chain.close(sample) {
            Ok(angles) => angles,
            Err(ClosureError { cosine }) => {
                violations.add(Rule::Closure, cosine.abs() - 1.0);
                before = None;
                continue;
            }
        };
        let depth = chain.posture(&angles).points().map(|point| -point.z());
        // The elbow is on the floor up to rounding.
        let depth = depth[..5].iter().copied().fold(f64::NEG_INFINITY, f64::max);
        violations.add(Rule::Floor, depth / chain.shoulder_to_elbow);
        if rules.clearance > 0.0 {
            let height = (rules.height)(&angles);
            violations.add(
                Rule::Clearance,
                (rules.clearance - height) / rules.clearance,
            );
        }
        for rate in before
            .iter()
            .flat_map(|before| rates(before, &angles, phase.interval))
        {
            violations.add(Rule::Rate, rate / rules.rate - 1.0);
        }
        before = Some(angles);
    }
    violations
}

/// Speeds of ankle, knee, hip and shoulder, rad/s.
fn rates(before: &ChainAngles, after: &ChainAngles, interval: f64) -> [f64; 4] {
    let ([_, before @ ..], [_, after @ ..]) = (before.to_array(), after.to_array());
    std::array::from_fn(|joint| (after[joint] - before[joint]).abs() / interval)
}

#[cfg(test)]
mod tests;
