//! What a pull costs.

use serde::{Deserialize, Serialize};

use super::{CycleRulesChoice, GaitText, Limit, NamedGait, RobotText, TextFile};
use crate::frontier::CycleObjective;

/// The cost of one pull.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CostExperiment {
    /// The robot that would pull.
    pub robot: RobotText,
    /// The pull whose cost is asked for.
    pub gait: GaitText,
    /// What costs are made of.
    pub terms: PullCostChoice,
}

/// The cost of one cycle, as a search of cycles would cost it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CycleCostExperiment {
    /// The robot that would crawl.
    pub robot: RobotText,
    /// The cycle whose cost is asked for.
    pub gait: GaitText,
    /// The cycle about which would be searched: none further past a stop than it, and for advance and
    /// speed none slower; without one the cycle itself.
    pub from: Option<GaitText>,
    /// What is minimised.
    pub objective: CycleObjective,
    /// Whether it has to be steered.
    pub steerable: bool,
    /// Whether the corners are left out.
    #[serde(default)]
    pub ideal: bool,
    /// The rules.
    pub rules: CycleRulesChoice,
    /// The cycle over whose heats that of this one is.
    pub worst_over: Option<NamedGait>,
}

/// What the costs of pulls are made of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PullCostChoice {
    /// What is minimised, and by which rules.
    pub objective: PullObjective,
    /// Where torques come from.
    pub source: TorqueChoice,
    /// The gait whose mapping, arms and ends hold.
    pub base: GaitText,
}

/// What is minimised, and by which rules.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PullObjective {
    /// The published cost, which has rules of its own.
    Published {
        /// Least height of the hip's centre, mm.
        hip_threshold_mm: f64,
        /// How far outside the table's limits an angle may lie, rad.
        limit_tolerance_rad: f64,
    },
    /// Squared torque, weighted for ankle, knee, hip and shoulder.
    Torque {
        /// The weights.
        weights: [f64; 4],
        /// The rules.
        rules: PullRules,
    },
    /// Largest torque over the manufacturer's effort limit.
    Peak {
        /// The rules.
        rules: PullRules,
    },
    /// Motor heat.
    Heat {
        /// The rules.
        rules: PullRules,
    },
}

/// The rules of an objective with graded violations.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PullRules {
    /// Whether a cost is that of a pull or of a metre of planned advance.
    pub per: Share,
    /// How long a pull lasts, s.
    pub duration_s: f64,
    /// Fastest command of ankle, knee, hip and shoulder, degrees per pull, where there is a limit.
    pub rate_deg_per_phase: Option<f64>,
    /// What stays above the floor in the plan.
    pub clearance: ClearanceChoice,
    /// How far past its stop a joint may be commanded in the plan.
    pub limits: LimitsChoice,
}

impl PullRules {
    /// Checks that every rule that is asked for is one.
    pub fn check(&self) -> Result<(), Limit> {
        if let Some(degrees) = self.rate_deg_per_phase {
            Limit::check("a rate", "° per pull", degrees, (0.001, f64::MAX))?;
        }
        match self.clearance {
            ClearanceChoice::HipMm(mm) | ClearanceChoice::BodyMm(mm) => {
                Limit::check("a clearance", " mm", mm, (f64::MIN_POSITIVE, f64::MAX))
            }
            ClearanceChoice::None | ClearanceChoice::Base => Ok(()),
        }
    }
}

/// Whether a cost is that of a pull or of a metre of planned advance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Share {
    /// One pull.
    Phase,
    /// One metre of planned advance.
    Metre,
}

/// What stays above the floor in the plan.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ClearanceChoice {
    /// Nothing is asked.
    None,
    /// The hip's centre, no lower than in the base gait.
    Base,
    /// The hip's centre, mm.
    HipMm(f64),
    /// The lowest point of trunk, head and legs, mm.
    BodyMm(f64),
}

/// How far past its stop a joint may be commanded in the plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LimitsChoice {
    /// Nowhere further than in the base gait.
    Base,
    /// Anywhere: it is clamped.
    None,
}

/// Where torques come from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum TorqueChoice {
    /// The static solver.
    Statics,
    /// A simulation of each pull.
    Dynamics {
        /// The gait whose share of the weight on trunk, head and legs is the limit.
        body_share_of: BodyShareOf,
    },
    /// A torque map.
    Map(TextFile),
}

/// The gait whose share of the weight on trunk, head and legs is the limit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum BodyShareOf {
    /// This one.
    Gait(GaitText),
    /// This one, or the base gait where the robot cannot follow this one.
    Usual(GaitText),
}
