//! Gaits priced by simulation: one pull, from the gait's own first pose, held until it has
//! settled.
//!
//! Torque is **joint torque in the sign of the recordings**, of the right side, averaged over
//! control steps, as in [`prone_record::pulls`]; its integral is that of the published study
//! ([`prone::cost::squared_torque_integral`]).
//!
//! What the planned chain breaks is graded first ([`graded::violations`]), and a search does not
//! simulate such a gait. The same holds for one that the robot cannot be commanded or that makes the
//! simulation diverge: it has the rule [`Rule::Torque`] broken, and a violation of at least 1 puts
//! it behind every gait that was simulated. The share of the weight that trunk and legs carry,
//!
//! ```text
//! share = ∫ (N_torso + N_leg) dt / ∫ Σ N dt                                      (1)
//! ```
//!
//! may not pass a limit, or the search lays the robot on its belly, where torque costs nothing.
//!
//! [`graded::violations`]: prone::cost::graded::violations

use prone::cost::graded::{Norm, Per, Price, Rule, Violations};
use prone::cost::{CostError, squared_torque_integral};
use prone::gait::{Gait, PhaseDuration};
use prone::mapping::{Mapping, MappingError};
use prone::regime::CONTROL_STEP;
use prone::robot::{ContactGroup, Robot};
use prone::torque_map::JointTorques;
use prone_sim::pull::{self, Keep, Pull, PullError, Start};
use prone_sim::{Placement, Simulation, World};

use super::pricing::{Pricing, Share};
use super::rules::ChainRules;

/// A gait's price by simulation, and the record it was read from.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// The torque part.
    pub torque: f64,
    /// Equation (1).
    pub body_share: f64,
    /// The record.
    pub pull: Pull,
}

/// What gaits are priced by, whatever simulates them.
#[derive(Debug, Clone, PartialEq)]
pub struct DynamicSetup {
    /// The torque part.
    pub norm: Norm,
    /// Per phase or per metre.
    pub share: Share,
    /// What the planned chain keeps to.
    pub rules: ChainRules,
    /// How long a pull lasts.
    pub duration: PhaseDuration,
    /// Largest share (1), 0 to 1.
    pub body_share: f64,
}

/// Prices gaits by simulation in one world.
#[derive(Debug)]
pub struct DynamicPricing {
    world: World,
    setup: DynamicSetup,
    mapping: Mapping,
    /// Where most gaits of a search begin: settled once for all of them.
    begun: Option<(Placement, Simulation)>,
}

/// Why a gait has no price by simulation.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TrialError {
    /// It cannot be simulated.
    #[error(transparent)]
    Pull(#[from] PullError),
    /// Its record has no price.
    #[error(transparent)]
    Cost(#[from] CostError),
}

impl DynamicPricing {
    /// A pricing of gaits that share mapping and arms with `base`.
    ///
    /// # Errors
    /// [`MappingError`].
    pub fn new(world: &World, base: &Gait, setup: DynamicSetup) -> Result<Self, MappingError> {
        let mut pricing = Self {
            world: world.clone(),
            setup,
            mapping: Mapping::new(world.robot(), base.mapping, base.arm)?,
            begun: None,
        };
        // A base that cannot be simulated is no reason against the gaits around it.
        pricing.begun = pricing.begin(base).ok();
        Ok(pricing)
    }

    fn begin(&self, gait: &Gait) -> Result<(Placement, Simulation), PullError> {
        let trajectory = pull::plan(&self.world, gait, self.setup.duration)?;
        let placement = pull::placement(&self.world, gait, &trajectory, Start::FirstPose)?;
        let simulation = pull::settle(&self.world, &placement);
        let simulation = simulation.map_err(|source| PullError::Simulation {
            gait: gait.name.clone(),
            duration_s: self.setup.duration.seconds(),
            source,
        })?;
        Ok((placement, simulation))
    }

    /// Simulates a gait, whatever rules it breaks.
    ///
    /// # Errors
    /// [`TrialError`].
    pub fn trial(&self, gait: &Gait) -> Result<Trial, TrialError> {
        let duration = self.setup.duration;
        let trajectory = pull::plan(&self.world, gait, duration).map_err(PullError::from)?;
        let placement = pull::placement(&self.world, gait, &trajectory, Start::FirstPose)?;
        let simulation = match &self.begun {
            Some((begun, simulation)) if *begun == placement => simulation.clone(),
            _ => self.begin(gait)?.1,
        };
        let pull = pull::proceed(simulation, trajectory, Keep::Rows).map_err(|source| {
            PullError::Simulation {
                gait: gait.name.clone(),
                duration_s: duration.seconds(),
                source,
            }
        })?;
        let torque = torque_part(self.world.robot(), &pull, &self.setup.norm)?;
        let torque = match self.setup.share.of(self.mapping.chain(), gait) {
            Per::Phase => torque,
            Per::Metre { advance } => torque / advance,
        };
        Ok(Trial {
            torque,
            body_share: body_share(&pull),
            pull,
        })
    }
}

impl Pricing for DynamicPricing {
    fn price(&self, gait: &Gait) -> Price {
        let violations = self.broken(gait);
        if violations.total() > 0.0 {
            return unsimulated(violations);
        }
        self.simulated(gait, violations)
    }

    fn quote(&self, gait: &Gait) -> Price {
        self.simulated(gait, self.broken(gait))
    }
}

impl DynamicPricing {
    /// What the planned chain breaks.
    fn broken(&self, gait: &Gait) -> Violations {
        let DynamicSetup {
            rules, duration, ..
        } = &self.setup;
        rules.broken(self.world.robot(), &self.mapping, gait, *duration)
    }

    fn simulated(&self, gait: &Gait, mut violations: Violations) -> Price {
        let Ok(trial) = self.trial(gait) else {
            return unsimulated(violations);
        };
        let allowed = self.setup.body_share;
        if allowed < 1.0 {
            let excess = (trial.body_share - allowed) / (1.0 - allowed);
            violations.add(Rule::BodyShare, excess);
        }
        Price {
            torque: trial.torque,
            violations,
        }
    }
}

/// The price of a gait that was not simulated: its torque part is not known.
fn unsimulated(mut violations: Violations) -> Price {
    violations.add(Rule::Torque, 1.0);
    Price {
        torque: f64::NAN,
        violations,
    }
}

/// Joint torques of each control step in the sign of the recordings, right side, N·m.
pub(super) fn torques(robot: &Robot, pull: &Pull) -> Vec<[f64; 4]> {
    let joints = robot.chain.right.pitch_joints();
    let rows = pull.rows.iter();
    rows.map(|row| joints.map(|joint| -row.actuator_torque[joint.0]))
        .collect()
}

/// A norm of a record: integrals by the published trapezoid rule, peaks over control steps.
pub(super) fn torque_part(robot: &Robot, pull: &Pull, norm: &Norm) -> Result<f64, CostError> {
    let scale = match norm {
        Norm::SquaredTorque { weights } => weights.map(f64::sqrt),
        Norm::Heat { nominal } => nominal.map(f64::recip),
        Norm::Peak { .. } => {
            let torques = torques(robot, pull).into_iter();
            let torques: Vec<_> = torques.map(JointTorques::from_array).collect();
            return Ok(norm.of(&torques, CONTROL_STEP));
        }
    };
    let times: Vec<f64> = pull.rows.iter().map(|row| row.time).collect();
    let mut torques = torques(robot, pull);
    for row in &mut torques {
        for (torque, scale) in row.iter_mut().zip(scale) {
            *torque *= scale;
        }
    }
    squared_torque_integral(&times, &torques)
}

/// Equation (1); rows are equally long.
pub(super) fn body_share(pull: &Pull) -> f64 {
    let (mut body, mut all) = (0.0, 0.0);
    for (group, column) in ContactGroup::ALL.into_iter().zip(0..) {
        let sum: f64 = pull.rows.iter().map(|row| row.contact[column]).sum();
        all += sum;
        if matches!(group, ContactGroup::Torso | ContactGroup::Leg) {
            body += sum;
        }
    }
    body / all
}
