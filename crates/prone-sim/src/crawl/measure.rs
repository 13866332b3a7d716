//! What is measured in a crawl.

use prone::crawl::Stage;
use prone::frames::{Ground, Root, Transform};
use prone::gait::cycle::CheckedCycle;
use prone::robot::{BodyPart, JointAngles, Tops};
use prone::steering::Bearing;

use super::effort::{Effort, MotorStep};
use super::touch::Touches;
use super::{Crawl, Detail, ROW_STEP};
use crate::driven::SimulatedRobot;
use crate::simulation::Simulation;
use prone::scene::ContactForce;

/// One instant of a crawl.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Since the first pull began, s.
    pub time: f64,
    /// Cycle, from 0.
    pub cycle: usize,
    /// What it was doing.
    pub stage: Stage,
    /// Commanded joint angles, rad.
    pub command: JointAngles,
    /// Joint angles, rad.
    pub angles: JointAngles,
    /// **Actuator torque** of each joint about its axis, mean over the row, N·m.
    pub actuator_torque: Vec<f64>,
    /// Normal contact force of the ground by [`prone::robot::ContactGroup::ALL`], mean over the row, N.
    pub contact: [f64; 4],
    /// What the world does to the robot now, contact by contact.
    pub forces: Vec<ContactForce>,
    /// Pose of the root.
    pub ground_from_root: Transform<Ground, Root>,
    /// Highest points.
    pub tops: Tops,
}

/// One cycle.
#[derive(Debug, Clone, PartialEq)]
pub struct CycleRow {
    /// Name of the pull's gait; the recovery leads to the next pull's extension.
    pub gait: String,
    /// Turn command of its pull, rad.
    pub turn: f64,
    /// When its pull began, s.
    pub begin: f64,
    /// How long it lasted, s.
    pub seconds: f64,
    /// Where the root was when it began.
    pub from: Bearing,
    /// Where it was when its pull ended and the recovery began.
    pub pulled: Bearing,
    /// Where it was when it ended.
    pub to: Bearing,
    /// Highest points.
    pub tops: Tops,
    /// What the motors did.
    pub effort: Effort,
    /// Share of the ground's force on trunk and legs during the pull.
    pub body_share: f64,
    /// The same during the recovery, in which limbs go back and the body may lie.
    pub recovery_body_share: f64,
}

/// How far a cycle came, seen from where it began.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Advance {
    /// Along its heading, m.
    pub forward: f64,
    /// To its left, m.
    pub left: f64,
    /// Change of heading, rad.
    pub yaw: f64,
}

impl CycleRow {
    /// How far it came.
    pub fn advance(&self) -> Advance {
        self.advance_to(self.to)
    }

    /// How far its pull came; the rest of [`Self::advance`] is the recovery's.
    pub fn pull_advance(&self) -> Advance {
        self.advance_to(self.pulled)
    }

    fn advance_to(&self, to: Bearing) -> Advance {
        let (sin, cos) = self.from.yaw.sin_cos();
        let (dx, dy) = (to.x - self.from.x, to.y - self.from.y);
        Advance {
            forward: cos * dx + sin * dy,
            left: cos * dy - sin * dx,
            yaw: wrapped(to.yaw - self.from.yaw),
        }
    }
}

/// An angle brought to −π…π, rad.
fn wrapped(angle: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    (angle + PI).rem_euclid(TAU) - PI
}

/// Measures while a crawl goes on.
pub(super) struct Meter {
    /// What is known of the crawl so far.
    crawl: Crawl,
    detail: Detail,
    parts: Vec<BodyPart>,
    begin: Option<f64>,
    cycle: Option<CycleRow>,
    loads: [BodyLoad; 2],
    means: Means,
    touches: Touches,
}

/// Sums over a stage of what the ground carries.
#[derive(Debug, Clone, Copy, Default)]
struct BodyLoad {
    body: f64,
    all: f64,
}

impl BodyLoad {
    fn add(&mut self, [toe, elbow, torso, leg]: [f64; 4]) {
        self.body += torso + leg;
        self.all += toe + elbow + torso + leg;
    }

    /// Share on trunk and legs; 0 where nothing is carried.
    fn share(self) -> f64 {
        if self.all > 0.0 {
            self.body / self.all
        } else {
            0.0
        }
    }
}

/// Sums since the last row.
struct Means {
    steps: usize,
    torque: Vec<f64>,
    contact: [f64; 4],
}

impl Means {
    fn none(joints: usize) -> Self {
        Self {
            steps: 0,
            torque: vec![0.0; joints],
            contact: [0.0; 4],
        }
    }
}

impl Meter {
    pub(super) fn new(simulation: &Simulation, detail: Detail) -> Self {
        let robot = simulation.robot();
        Self {
            crawl: Crawl {
                start: simulation.snapshot(),
                cycles: Vec::new(),
                effort: Effort::none(robot),
                tops: Tops::NONE,
                touches: Vec::new(),
                stopped: Vec::new(),
                rows: Vec::new(),
                snapshots: Vec::new(),
                arrived: false,
                engine_steps: 0,
            },
            touches: Touches::new(simulation.world()),
            detail,
            parts: BodyPart::of_shapes(robot),
            begin: None,
            cycle: None,
            loads: [BodyLoad::default(); 2],
            means: Means::none(robot.joints.len()),
        }
    }

    pub(super) fn begin_cycle(&mut self, simulation: &Simulation, checked: &CheckedCycle) {
        if self.crawl.cycles.is_empty() {
            self.crawl.start = simulation.snapshot();
        }
        let zero = *self.begin.get_or_insert(simulation.time());
        let from = Bearing::of_prone(&simulation.ground_from_root());
        self.loads = [BodyLoad::default(); 2];
        self.cycle = Some(CycleRow {
            gait: checked.name().to_owned(),
            turn: checked.turn(),
            begin: simulation.time() - zero,
            seconds: 0.0,
            from,
            pulled: from,
            to: from,
            tops: Tops::NONE,
            effort: Effort::none(simulation.robot()),
            body_share: 0.0,
            recovery_body_share: 0.0,
        });
    }

    pub(super) fn end_pull(&mut self, simulation: &Simulation) {
        if let Some(cycle) = &mut self.cycle {
            cycle.pulled = Bearing::of_prone(&simulation.ground_from_root());
        }
    }

    pub(super) fn end_cycle(&mut self, simulation: &Simulation) {
        let Some(mut cycle) = self.cycle.take() else {
            return;
        };
        [cycle.body_share, cycle.recovery_body_share] = self.loads.map(BodyLoad::share);
        cycle.to = Bearing::of_prone(&simulation.ground_from_root());
        cycle.seconds = cycle.effort.seconds;
        self.crawl.effort.add(&cycle.effort);
        self.crawl.tops.raise(&cycle.tops);
        self.crawl.cycles.push(cycle);
    }

    /// After each engine step, with what was commanded for it and what that is for.
    pub(super) fn step(&mut self, simulation: &Simulation, command: (&JointAngles, Stage)) {
        let Some(cycle) = &mut self.cycle else {
            return;
        };
        let dt = simulation.time_step();
        cycle.effort.seconds += dt;
        let since = simulation.time() - self.begin.unwrap_or_default();
        self.touches.step(simulation, since);
        let joints = simulation.robot().joints.iter();
        for (index, (effort, joint)) in cycle.effort.joints.iter_mut().zip(joints).enumerate() {
            let step = MotorStep {
                torque: simulation.actuator_torque()[index],
                demanded: simulation.demanded_torque()[index],
                speed: simulation.joint_speeds()[index],
                seconds: dt,
            };
            effort.add_step(&step, joint);
        }
        let contact = simulation.ground_contact();
        self.loads[usize::from(command.1 == Stage::Recovery)].add(contact);
        self.means.steps += 1;
        for (sum, torque) in self
            .means
            .torque
            .iter_mut()
            .zip(simulation.actuator_torque())
        {
            *sum += torque;
        }
        for (sum, force) in self.means.contact.iter_mut().zip(contact) {
            *sum += force;
        }
        let steps_per_row = simulation.world().regime().steps_in(ROW_STEP);
        if simulation.steps().is_multiple_of(steps_per_row) {
            self.row(simulation, command);
        }
    }

    fn row(&mut self, simulation: &Simulation, (command, stage): (&JointAngles, Stage)) {
        let robot = simulation.robot();
        let means = std::mem::replace(&mut self.means, Means::none(robot.joints.len()));
        let (Some(cycle), Some(begin)) = (&mut self.cycle, self.begin) else {
            return;
        };
        let poses = simulation.body_poses();
        let tops = Tops::from_poses(robot, &self.parts, &poses);
        cycle.tops.raise(&tops);
        if self.detail == Detail::Sums {
            return;
        }
        let mean = |sum: f64| sum / means.steps as f64;
        self.crawl.snapshots.push(simulation.snapshot());
        self.crawl.rows.push(Row {
            time: simulation.time() - begin,
            cycle: self.crawl.cycles.len(),
            stage,
            command: command.clone(),
            angles: simulation.joint_angles(),
            actuator_torque: means.torque.iter().map(|&sum| mean(sum)).collect(),
            contact: means.contact.map(mean),
            forces: simulation.contact_forces(),
            ground_from_root: simulation.ground_from_root(),
            tops,
        });
    }

    /// The record of what `robot` has done, and whether it has `arrived`.
    pub(super) fn finish(self, robot: &SimulatedRobot, arrived: bool) -> Crawl {
        Crawl {
            touches: self.touches.finish(),
            stopped: robot.stopped(),
            arrived,
            engine_steps: robot.simulation().steps(),
            ..self.crawl
        }
    }
}
