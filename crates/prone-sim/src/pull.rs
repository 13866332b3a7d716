//! One closed-chain phase in simulation, from a stated start pose.
//!
//! The robot lies on its belly in the start pose ([`Start`]), the servos hold it until it has
//! settled, then the phase begins. The command changes every control step and is held in between;
//! row k is the mean over control step k, stamped with its end.
//!
//! [`run`] does all of it. A search that simulates many gaits with one first pose settles once
//! ([`settle`]) and goes on from there as often as it likes ([`proceed_unless`]), to the same bits.

use std::f64::consts::FRAC_PI_2;

use prone::frames::{Ground, Root, Transform};
use prone::gait::{CheckedTrajectory, Gait, PhaseDuration, TrajectoryError};
use prone::motor::Effort;
use prone::robot::{BodyPart, ContactGroup, JointAngles, Tops};

use crate::simulation::{Placement, Simulation, SimulationError, Snapshot};
use crate::world::World;
use prone::regime::CONTROL_STEP;
use prone::scene::ContactForce;

/// How long the servos hold the start pose before the phase, s. From half a second on, longer
/// changes nothing; none at all starts the phase in mid-fall.
pub const SETTLE: f64 = 1.0;

/// The pose in which the servos hold the robot before the phase.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Start {
    /// The robot's study names it ([`prone::robot::StudySetup::start_posture`]): the pose stored in
    /// the scene of the published recordings.
    Recorded,
    /// The first sample of the gait itself, the trunk pitched as in its planar chain: what a crawl
    /// hands over, and what makes gaits comparable that begin differently.
    FirstPose,
}

/// What is kept of a phase.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Keep {
    /// Its rows.
    Rows,
    /// What it takes to show it as well: [`Shown`] at each row, and positions for pictures.
    Shown {
        /// How many positions.
        pictures: usize,
    },
}

/// Record of one phase.
#[derive(Debug, Clone, PartialEq)]
pub struct Pull {
    /// The trajectory that was commanded.
    pub trajectory: CheckedTrajectory,
    /// Pose of the root when the phase began.
    pub start: Transform<Ground, Root>,
    /// One row per control step.
    pub rows: Vec<Row>,
    /// Positions at equally spaced instants, first at the start, last at the end of the phase.
    pub snapshots: Vec<Snapshot>,
    /// Engine steps done, settling included.
    pub engine_steps: usize,
}

/// One control step of a pull.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// End of the step, s since the phase began.
    pub time: f64,
    /// Commanded joint angles, rad.
    pub command: JointAngles,
    /// Joint angles at the end of the step, rad.
    pub angles: JointAngles,
    /// **Applied torque** of each joint's motor about the joint's axis, mean over the step, N·m.
    pub applied_torque: Vec<f64>,
    /// Normal contact force by [`ContactGroup::ALL`], mean over the step, N.
    pub contact: [f64; ContactGroup::COUNT],
    /// What the world does to each body that it touches, mean over the step.
    pub forces: Vec<ContactForce>,
    /// What the motors did in the step.
    pub effort: Effort,
    /// Highest point of any shape at the end of the step, m.
    pub top: f64,
    /// Highest point of the head at the end of the step, m.
    pub head_top: f64,
    /// Pose of the root at the end of the step.
    pub ground_from_root: Transform<Ground, Root>,
    /// What else is shown, where it is kept.
    pub shown: Option<Shown>,
}

/// What a replay shows of one control step, at its end.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown {
    /// Phase of the command, 0 to 1.
    pub s: f64,
    /// Highest points by part of the body.
    pub tops: Tops,
}

/// Why a pull has no record.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PullError {
    /// The gait gives no trajectory.
    #[error(transparent)]
    Trajectory(#[from] TrajectoryError),
    /// The run broke down.
    #[error("gait {gait} at {duration_s} s: {source}")]
    Simulation {
        /// The gait's name.
        gait: String,
        /// Duration of the phase, s.
        duration_s: f64,
        /// What happened.
        source: SimulationError,
    },
    /// The robot's study names a posture it does not have.
    #[error("robot {robot} has no posture {posture:?} to start from")]
    StartPosture {
        /// The robot's name.
        robot: String,
        /// The posture's name.
        posture: String,
    },
    /// The user stopped it.
    #[error("stopped")]
    Stopped,
}

impl PullError {
    /// Of a pull that broke down, or was stopped, on its way.
    pub fn in_simulation(gait: &Gait, duration: PhaseDuration, source: SimulationError) -> Self {
        match source {
            SimulationError::Stopped => Self::Stopped,
            source @ SimulationError::Diverged { .. } => Self::Simulation {
                gait: gait.name.clone(),
                duration_s: duration.seconds(),
                source,
            },
        }
    }
}

/// The trajectory that [`run`] commands: one sample per control step.
pub fn plan(
    world: &World,
    gait: &Gait,
    duration: PhaseDuration,
) -> Result<CheckedTrajectory, TrajectoryError> {
    CheckedTrajectory::plan(
        world.robot(),
        world.stops(),
        gait,
        duration,
        whole_steps(duration.seconds()),
    )
}

/// Runs one phase of a gait.
pub fn run(
    world: &World,
    gait: &Gait,
    duration: PhaseDuration,
    start: Start,
    keep: Keep,
) -> Result<Pull, PullError> {
    run_unless(&|| false, world, gait, duration, start, keep)
}

/// The same, ended at once when `stopped` says so.
///
/// # Errors
/// [`PullError`]; [`PullError::Stopped`] where it was stopped.
pub fn run_unless(
    stopped: &dyn Fn() -> bool,
    world: &World,
    gait: &Gait,
    duration: PhaseDuration,
    start: Start,
    keep: Keep,
) -> Result<Pull, PullError> {
    let trajectory = plan(world, gait, duration)?;
    let placement = placement(world, &trajectory, start)?;
    let broken = |source| PullError::in_simulation(gait, duration, source);
    let settled = settle_unless(stopped, world, &placement).map_err(broken)?;
    proceed_unless(stopped, settled, trajectory, keep).map_err(broken)
}

/// How the robot is laid down before the phase.
///
/// # Errors
/// [`PullError::StartPosture`].
pub fn placement(
    world: &World,
    trajectory: &CheckedTrajectory,
    start: Start,
) -> Result<Placement, PullError> {
    let robot = world.robot();
    match start {
        Start::Recorded => {
            let name = &robot.study.start_posture;
            let posture = robot.postures.get(name);
            let posture = posture.ok_or_else(|| PullError::StartPosture {
                robot: robot.name.clone(),
                posture: name.clone(),
            })?;
            Ok(Placement {
                posture: posture.clone(),
                pitch: FRAC_PI_2,
            })
        }
        Start::FirstPose => {
            let first = trajectory.first();
            Ok(Placement {
                posture: first.joints.clone(),
                pitch: first.root_pitch,
            })
        }
    }
}

/// Lays the robot down and lets the servos hold it for [`SETTLE`].
pub fn settle(world: &World, placement: &Placement) -> Result<Simulation, SimulationError> {
    settle_unless(&|| false, world, placement)
}

/// The same, ended at once when `stopped` says so.
///
/// # Errors
/// [`SimulationError`]; [`SimulationError::Stopped`] where it was stopped.
pub fn settle_unless(
    stopped: &dyn Fn() -> bool,
    world: &World,
    placement: &Placement,
) -> Result<Simulation, SimulationError> {
    let mut simulation = Simulation::new(world, placement);
    for _ in 0..whole_steps(SETTLE) {
        if stopped() {
            return Err(SimulationError::Stopped);
        }
        simulation.control_step()?;
    }
    Ok(simulation)
}

/// Commands a trajectory made by [`plan`] from where the robot is, and ends at once when `stopped` says
/// so.
///
/// # Errors
/// As [`settle_unless`].
pub fn proceed_unless(
    stopped: &dyn Fn() -> bool,
    mut simulation: Simulation,
    trajectory: CheckedTrajectory,
    keep: Keep,
) -> Result<Pull, SimulationError> {
    let world = simulation.world().clone();
    let robot = world.robot();
    let pictures = match keep {
        Keep::Rows => 0,
        Keep::Shown { pictures } => pictures,
    };
    let parts = BodyPart::of_shapes(robot);
    let start = simulation.ground_from_root();
    let steps = trajectory.samples().len() - 1;
    let mut snapshots = Vec::with_capacity(pictures);
    let mut rows = Vec::with_capacity(steps);
    for (k, sample) in trajectory.samples()[..steps].iter().enumerate() {
        if stopped() {
            return Err(SimulationError::Stopped);
        }
        while snapshots.len() < pictures && due(snapshots.len(), pictures, steps) <= k {
            snapshots.push(simulation.snapshot());
        }
        simulation.command(&sample.joints);
        let means = simulation.control_step()?;
        let poses = simulation.body_poses();
        rows.push(Row {
            time: (k + 1) as f64 * CONTROL_STEP,
            command: sample.joints.clone(),
            angles: simulation.joint_angles(),
            applied_torque: means.applied_torque,
            contact: means.contact,
            forces: means.forces,
            effort: means.effort,
            top: robot.top(&poses, |_| true),
            head_top: robot.top(&poses, |shape| robot.bodies[shape.body.0].is_head()),
            ground_from_root: simulation.ground_from_root(),
            shown: match keep {
                Keep::Rows => None,
                Keep::Shown { .. } => Some(Shown {
                    s: sample.s,
                    tops: Tops::from_poses(robot, &parts, &poses),
                }),
            },
        });
    }
    while snapshots.len() < pictures {
        snapshots.push(simulation.snapshot());
    }
    Ok(Pull {
        trajectory,
        start,
        rows,
        snapshots,
        engine_steps: simulation.steps(),
    })
}

/// Control step before which picture `index` of `count` is taken.
fn due(index: usize, count: usize, steps: usize) -> usize {
    if count < 2 {
        0
    } else {
        index * steps / (count - 1)
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a phase lasts 0.1 to 600 s, so this is 2 to 12,000"
)]
fn whole_steps(seconds: f64) -> usize {
    (seconds / CONTROL_STEP).round() as usize
}
