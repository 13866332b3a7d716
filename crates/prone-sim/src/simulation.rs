//! One run of a world: servos, steps, and what is read from the engine.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use mujoco_rs::prelude::*;

use prone::frames::{Ground, Point, Root, Transform};
use prone::motor::{Commands, Effort, MotorStep};
use prone::robot::{BodyPoses, ContactGroup, JointAngles, Robot};
use prone::scene::ContactForce;

use crate::engine_numbers::{FREE_JOINT, FREE_JOINT_SPEEDS, real_first, rotation};
use crate::world::World;
use prone::regime::CONTROL_STEP;

mod contacts;
mod motors;

pub(crate) use contacts::{ContactSums, Kept};
use motors::Motors;

/// A robot moving in a world. A clone goes on to the same bits as the original.
#[derive(Debug, Clone)]
pub struct Simulation {
    world: World,
    pub(crate) data: MjData<Arc<MjModel>>,
    reference: Vec<f64>,
    motors: Motors,
    steps: usize,
}

/// How a run begins.
#[derive(Debug, Clone, PartialEq)]
pub struct Placement {
    /// Joint angles, brought within the world's stops.
    pub posture: JointAngles,
    /// Turn of the root about +y, rad; a quarter turn lays a standing robot on its belly.
    pub pitch: f64,
}

/// The full position of a run at one instant, for pictures.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot(Vec<f64>);

/// Means and sums over one control step.
#[derive(Debug, Clone, PartialEq)]
pub struct StepMeans {
    /// **Applied torque** of each joint's motor about the joint's axis, N·m.
    pub applied_torque: Vec<f64>,
    /// Normal contact force by [`ContactGroup::ALL`], both sides together, N.
    pub contact: [f64; ContactGroup::COUNT],
    /// What the world does to each body that it touches.
    pub forces: Vec<ContactForce>,
    /// What the motors did in it.
    pub effort: Effort,
}

/// Why a run cannot go on.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SimulationError {
    /// Position or speed is no longer a number the engine accepts.
    #[error("the simulation diverged at {time_s:.3} s")]
    Diverged {
        /// Time since the run began, s.
        time_s: f64,
    },
    /// The user stopped it.
    #[error("stopped")]
    Stopped,
}

impl Simulation {
    /// Lays the robot on the floor: the posture within the stops, the root pitched, the lowest
    /// point of any shape on z = 0, all speeds zero, and the servos holding that posture.
    pub fn new(world: &World, placement: &Placement) -> Self {
        let mut data = MjData::new(Arc::clone(&world.model));
        let robot = world.robot();
        let stops = world.stops();
        let angles = placement
            .posture
            .map(|joint, angle| angle.clamp(stops[joint.0].lower, stops[joint.0].upper));
        let turn = DQuat::from_rotation_y(placement.pitch);
        let poses =
            robot.forward_kinematics(Transform::<Ground, Root>::new(turn, DVec3::ZERO), &angles);
        let height = -robot.bottom(&poses, |_| true);
        let ground_from_root = Transform::new(turn, DVec3::new(0.0, 0.0, height));
        let Snapshot(position) = Snapshot::new(ground_from_root, &angles);
        data.qpos_mut().copy_from_slice(&position);
        data.forward();
        Self {
            world: world.clone(),
            data,
            motors: Motors::at_rest(world),
            reference: angles.as_slice().to_vec(),
            steps: 0,
        }
    }

    /// The robot.
    pub fn robot(&self) -> &Robot {
        self.world.robot()
    }

    /// Where it moves.
    pub const fn world(&self) -> &World {
        &self.world
    }

    /// What the servos hold from now on.
    pub fn command(&mut self, reference: &JointAngles) {
        self.reference.copy_from_slice(reference.as_slice());
    }

    /// What the servos hold, rad.
    pub fn reference(&self) -> JointAngles {
        JointAngles::from_fn(self.reference.len(), |joint| self.reference[joint.0])
    }

    /// One control step; returns means over its engine steps.
    ///
    /// # Errors
    /// [`SimulationError::Diverged`].
    pub fn control_step(&mut self) -> Result<StepMeans, SimulationError> {
        let mut torques = vec![0.0; self.reference.len()];
        let mut contacts = ContactSums::default();
        let mut effort = Effort::none(self.robot());
        let step = self.time_step();
        let steps = self.world.regime().steps_in(CONTROL_STEP);
        for _ in 0..steps {
            self.step();
            for (sum, torque) in torques.iter_mut().zip(self.applied_torque()) {
                *sum += torque;
            }
            contacts.add(self, Kept::EachBody);
            effort.add_step(self.motor_steps(), step, Commands::Move);
        }
        for sum in &mut torques {
            *sum /= steps as f64;
        }
        self.check()?;
        Ok(StepMeans {
            applied_torque: torques,
            contact: contacts.ground(),
            forces: contacts.forces(),
            effort,
        })
    }

    /// One engine step under the servos of the world.
    pub fn step(&mut self) {
        self.motors
            .command(&self.world, &mut self.data, &self.reference);
        self.data.step();
        self.motors.read(&self.world, &self.data);
        self.steps += 1;
    }

    /// Moves the robot along x so that its foremost point is there, m; before the first step.
    pub fn place_front_at(&mut self, x: f64) {
        let poses = self.body_poses();
        self.data.qpos_mut()[0] += x - self.robot().reach(&poses, DVec3::X);
        self.data.forward();
    }

    /// Time since the run began, s.
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.world.regime().time_step
    }

    /// Length of one engine step, s.
    pub const fn time_step(&self) -> f64 {
        self.world.regime().time_step
    }

    /// **Applied torque** of each joint's motor about the joint's axis in the last step, N·m: what acted
    /// over the step, the motor's back-EMF taken off.
    pub fn applied_torque(&self) -> &[f64] {
        self.motors.applied()
    }

    /// What each motor did in the last step, in the order of [`Robot::drives`].
    pub fn motor_steps(&self) -> &[MotorStep] {
        self.motors.steps()
    }

    /// Joint speeds now, rad/s.
    pub fn joint_speeds(&self) -> &[f64] {
        &self.data.qvel()[FREE_JOINT_SPEEDS..]
    }

    /// Joint angles now, rad.
    pub fn joint_angles(&self) -> JointAngles {
        posture(self.robot(), self.data.qpos())
    }

    /// Pose of the root now.
    pub fn ground_from_root(&self) -> Transform<Ground, Root> {
        root_pose(self.data.qpos())
    }

    /// Poses of all bodies now.
    pub fn body_poses(&self) -> BodyPoses<Ground> {
        self.robot()
            .forward_kinematics(self.ground_from_root(), &self.joint_angles())
    }

    /// The position now, for [`crate::camera`].
    pub fn snapshot(&self) -> Snapshot {
        Snapshot(self.data.qpos().to_vec())
    }

    /// Speeds now: of the root, m/s in the ground frame, its turn, rad/s in its own, and of the
    /// joints, rad/s.
    pub(crate) fn speeds(&self) -> &[f64] {
        self.data.qvel()
    }

    /// The readings of the model's sensors, as of the beginning of the last engine step.
    pub(crate) fn sensor_readings(&self) -> &[f64] {
        self.data.sensordata()
    }

    /// Engine steps done so far.
    pub const fn steps(&self) -> usize {
        self.steps
    }

    /// Whether position and speed still are numbers that the engine accepts.
    pub(crate) fn check(&self) -> Result<(), SimulationError> {
        let mut warnings = [
            MjtWarning::mjWARN_BADQPOS,
            MjtWarning::mjWARN_BADQVEL,
            MjtWarning::mjWARN_BADQACC,
        ]
        .into_iter();
        if warnings.any(|warning| self.data.warning()[warning as usize].number > 0) {
            let time_s = self.time();
            return Err(SimulationError::Diverged { time_s });
        }
        Ok(())
    }
}

/// The pose of the free root in a position of the engine.
fn root_pose(qpos: &[f64]) -> Transform<Ground, Root> {
    let Some(&[x, y, z, w, i, j, k]) = qpos.first_chunk::<FREE_JOINT>() else {
        unreachable!("a world has a robot with a free root");
    };
    Transform::new(rotation([w, i, j, k]).normalize(), DVec3::new(x, y, z))
}

/// The joint angles of a position in the engine, after those of the free root.
fn posture(robot: &Robot, qpos: &[f64]) -> JointAngles {
    let angles = &qpos[FREE_JOINT..];
    JointAngles::from_fn(robot.joints.len(), |joint| angles[joint.0])
}

impl Snapshot {
    /// A position that was recorded.
    pub fn new(ground_from_root: Transform<Ground, Root>, angles: &JointAngles) -> Self {
        let at = ground_from_root.origin().metres().to_array();
        let turn = real_first(ground_from_root.rotation());
        Self([&at, &turn[..], angles.as_slice()].concat())
    }
}

impl Snapshot {
    /// Pose of the root.
    pub fn ground_from_root(&self) -> Transform<Ground, Root> {
        root_pose(&self.0)
    }

    /// Joint angles, rad.
    pub fn joint_angles(&self) -> &[f64] {
        &self.0[FREE_JOINT..]
    }
}

impl World {
    /// Centre of mass of the robot at a snapshot.
    pub fn centre_of_mass(&self, snapshot: &Snapshot) -> Point<Ground> {
        let robot = self.robot();
        let Snapshot(position) = snapshot;
        let poses = robot.forward_kinematics(root_pose(position), &posture(robot, position));
        robot.centre_of_mass(&poses)
    }

    /// The engine's data at a snapshot, for [`crate::camera::ray_cast`] and for comparisons with the
    /// engine alone.
    pub fn at(&self, snapshot: &Snapshot) -> MjData<Arc<MjModel>> {
        let mut data = MjData::new(Arc::clone(&self.model));
        data.qpos_mut().copy_from_slice(&snapshot.0);
        data.forward();
        data
    }
}
