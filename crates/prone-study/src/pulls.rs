//! What a planned and what a simulated pull leave behind.

use prone::gait::{CheckedTrajectory, Gait, PhaseDuration, TrajectoryError};
use prone::robot::{ContactGroup, JointAngles, Robot};
use prone::scene::ContactForce;
use prone_record::pulls::{ChainRecord, ChainSample, PullRecord, PullRow};
use prone_sim::World;
use prone_sim::pull::Pull;

/// Samples of a planned chain: 1 % of the phase apart.
const CHAIN_INTERVALS: usize = 100;

/// The planned chain of a gait.
///
/// # Errors
/// [`TrajectoryError`] where the robot cannot follow the gait.
pub fn chain(
    world: &World,
    gait: &Gait,
    duration: PhaseDuration,
) -> Result<ChainRecord, TrajectoryError> {
    plan_chain(world, gait, duration).map(|trajectory| chain_record(gait, &trajectory))
}

/// Plans a pull at the samples of a [`ChainRecord`].
///
/// # Errors
/// [`TrajectoryError`] where the robot cannot follow the gait.
pub fn plan_chain(
    world: &World,
    gait: &Gait,
    duration: PhaseDuration,
) -> Result<CheckedTrajectory, TrajectoryError> {
    CheckedTrajectory::plan(
        world.robot(),
        world.stops(),
        gait,
        duration,
        CHAIN_INTERVALS,
    )
}

/// The planned chain of a planned pull.
pub fn chain_record(gait: &Gait, trajectory: &CheckedTrajectory) -> ChainRecord {
    let samples = trajectory.samples().iter().map(|sample| {
        let parameters = sample.chain.gait_parameters();
        ChainSample {
            s: sample.s,
            parameters_deg: [parameters.knee, parameters.hip, parameters.upper_arm]
                .map(f64::to_degrees),
            points_mm: sample
                .posture
                .points()
                .map(|point| (point.x() * 1e3, point.z() * 1e3)),
        }
    });
    ChainRecord {
        gait: gait.name.clone(),
        samples: samples.collect(),
    }
}

/// What a simulated pull leaves behind.
pub fn pull_record(robot: &Robot, gait: &Gait, duration: PhaseDuration, pull: &Pull) -> PullRecord {
    let side = &robot.chain.right;
    let pitch = side.pitch_joints();
    let commanded = side.commanded_joints();
    let pick = |angles: &JointAngles| commanded.map(|id| angles[id]);
    let steps = pull.rows.len() as f64;
    let rows = pull.rows.iter().enumerate().map(|(k, row)| PullRow {
        time_s: row.time,
        cycle_percent: 100.0 * (k + 1) as f64 / steps,
        // The recordings report minus the motor torque about the joint's axis.
        torque_nm: pitch.map(|id| -row.applied_torque[id.0]),
        command_rad: pick(&row.command),
        angle_rad: pick(&row.angles),
        contact_n: ContactGroup::as_in_the_study(row.contact),
        squeeze_n: squeeze(robot, &row.forces),
        top_mm: row.top * 1e3,
        head_top_mm: row.head_top * 1e3,
    });
    PullRecord {
        gait: gait.name.clone(),
        duration_s: duration.seconds(),
        rows: rows.collect(),
    }
}

/// Internal squeeze of the planted chain, N a side: half the difference of the horizontal forces
/// forwards that the ground has on toes and on arms, half of which each side carries. Positive where
/// the ground pushes them towards one another.
fn squeeze(robot: &Robot, forces: &[ContactForce]) -> f64 {
    let on_ground = forces.iter().filter(|it| it.obstacle.is_none());
    let forwards = on_ground.map(|it| {
        let group = robot.bodies[it.body.0].contact_group;
        match group {
            ContactGroup::Toe => it.force.x,
            _ if group.is_front() => -it.force.x,
            _ => 0.0,
        }
    });
    forwards.sum::<f64>() / 4.0
}
