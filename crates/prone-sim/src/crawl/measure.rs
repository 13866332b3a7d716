//! What is measured in a crawl.

use prone::crawl::Stage;
use prone::frames::{Ground, Root, Transform};
use prone::gait::cycle::CheckedCycle;
use prone::motor::{Commands, Effort};
use prone::robot::{BodyPart, ContactGroup, Drive, JointAngles, Tops};
use prone::scene::ContactForce;
use prone::steering::Bearing;

use super::extent::{Nearness, Sides};
use super::ground::{BodyLoad, GroundLoad};
use super::touch::Touches;
use super::{Crawl, Detail, ROW_STEP};
use crate::driven::SimulatedRobot;
use crate::simulation::{ContactSums, Kept, Simulation};

/// A row of a crawl: the time since the row before, and the instant at its end.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Since the first pull began, s.
    pub time: f64,
    /// Cycle, from 0.
    pub cycle: usize,
    /// What it was doing.
    pub stage: Stage,
    /// Commanded joint angles, rad: the command that had reached the servos.
    pub command: JointAngles,
    /// Joint angles, rad.
    pub angles: JointAngles,
    /// **Applied torque** of each joint's motor about the joint's axis, mean over the row, N·m.
    pub applied_torque: Vec<f64>,
    /// What each motor did over the row, by [`prone::robot::Robot::drives`].
    pub effort: Effort,
    /// Normal contact force of the ground by [`ContactGroup::ALL`], mean over the row, N.
    pub contact: [f64; ContactGroup::COUNT],
    /// What the world does to each body that it touches, mean over the row.
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
    /// Shift command, rad.
    pub shift: f64,
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
    /// What the ground carried.
    pub ground: GroundLoad,
    /// Share of the ground's force on trunk, head and legs during the pull.
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

fn steps_per_row(simulation: &Simulation) -> usize {
    simulation.world().regime().steps_in(ROW_STEP)
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
    drives: Vec<Drive>,
    begin: Option<f64>,
    cycle: Option<CycleRow>,
    loads: [BodyLoad; 2],
    sums: RowSums,
    /// What was commanded last, however late it reaches the servos, and since when, s.
    command: Option<(JointAngles, f64)>,
    /// What has reached the servos last.
    reached: JointAngles,
    touches: Touches,
    nearness: Nearness,
}

/// What a command asks of the motors.
struct Planned {
    commands: Commands,
    /// By drive where the command has just changed, rad/s; else nothing.
    speeds: Vec<f64>,
}

/// Sums since the last row.
struct RowSums {
    steps: usize,
    torque: Vec<f64>,
    contacts: ContactSums,
    effort: Effort,
    stage: Stage,
}

impl RowSums {
    fn none(simulation: &Simulation) -> Self {
        let robot = simulation.robot();
        Self {
            steps: 0,
            torque: vec![0.0; robot.joints.len()],
            contacts: ContactSums::default(),
            effort: Effort::none(robot),
            stage: Stage::Recovery,
        }
    }
}

impl Meter {
    pub(super) fn new(simulation: &Simulation, detail: Detail) -> Self {
        let robot = simulation.robot();
        Self {
            crawl: Crawl {
                start: simulation.snapshot(),
                start_speeds: simulation.speeds().to_vec(),
                commands: Vec::new(),
                cycles: Vec::new(),
                effort: Effort::none(robot),
                ground: GroundLoad::default(),
                tops: Tops::NONE,
                sides: Sides::NONE,
                nearest: None,
                touches: Vec::new(),
                stopped: Vec::new(),
                rows: Vec::new(),
                snapshots: Vec::new(),
                arrived: false,
                engine_steps: 0,
            },
            touches: Touches::new(simulation.world()),
            nearness: Nearness::new(simulation.world()),
            detail,
            parts: BodyPart::of_shapes(robot),
            drives: robot.drives(),
            begin: None,
            cycle: None,
            loads: [BodyLoad::default(); 2],
            sums: RowSums::none(simulation),
            command: None,
            reached: simulation.reference(),
        }
    }

    pub(super) fn begin_cycle(&mut self, simulation: &Simulation, checked: &CheckedCycle) {
        if self.crawl.cycles.is_empty() {
            self.crawl.start = simulation.snapshot();
            self.crawl.start_speeds = simulation.speeds().to_vec();
        }
        let zero = *self.begin.get_or_insert(simulation.time());
        let from = Bearing::of_prone(&simulation.ground_from_root());
        self.loads = [BodyLoad::default(); 2];
        self.cycle = Some(CycleRow {
            gait: checked.name().to_owned(),
            turn: checked.turn(),
            shift: checked.steer().shift,
            begin: simulation.time() - zero,
            seconds: 0.0,
            from,
            pulled: from,
            to: from,
            tops: Tops::NONE,
            effort: Effort::none(simulation.robot()),
            ground: GroundLoad::default(),
            body_share: 0.0,
            recovery_body_share: 0.0,
        });
    }

    /// Whether the robot has touched an obstacle so far.
    pub(super) fn has_touched(&self) -> bool {
        self.touches.any()
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
        self.crawl.cycles.push(cycle);
    }

    /// After each engine step, with what the commands of it are for.
    pub(super) fn step(&mut self, robot: &SimulatedRobot, stage: Stage) {
        let (simulation, reached) = (robot.simulation(), robot.reached());
        let dt = simulation.time_step();
        let planned = self.planned(simulation, robot.commanded());
        if self.reached != *reached {
            self.reached.clone_from(reached);
        }
        let Some(cycle) = &mut self.cycle else {
            return;
        };
        let since = simulation.time() - self.begin.unwrap_or_default();
        let commands = &mut self.crawl.commands;
        let is_new = commands.last().is_none_or(|(_, last)| last != reached);
        if self.detail == Detail::Rows && is_new {
            commands.push((since - dt, reached.clone()));
        }
        self.touches.step(simulation, since);
        for effort in [&mut cycle.effort, &mut self.sums.effort] {
            effort.add_step(simulation.motor_steps(), dt, planned.commands);
            for (motor, speed) in effort.motors.iter_mut().zip(&planned.speeds) {
                motor.planned_speed = motor.planned_speed.max(*speed);
            }
        }
        self.sums.stage = stage;
        self.sums.steps += 1;
        for (sum, torque) in self.sums.torque.iter_mut().zip(simulation.applied_torque()) {
            *sum += torque;
        }
        let kept = match self.detail {
            Detail::Sums => Kept::Ground,
            Detail::Rows => Kept::EachBody,
        };
        let carried = self.sums.contacts.add(simulation, kept);
        cycle.ground.add_step(carried, dt);
        self.loads[usize::from(stage == Stage::Recovery)].add(carried);
        if simulation.steps().is_multiple_of(steps_per_row(simulation)) {
            self.row(simulation);
        }
    }

    /// What the command of an engine step asks of the motors.
    fn planned(&mut self, simulation: &Simulation, command: &JointAngles) -> Planned {
        let dt = simulation.time_step();
        let between = simulation.robot().control.command_step.max(dt);
        let now = simulation.time() - dt;
        let (before, since) = self.command.get_or_insert_with(|| (command.clone(), now));
        let held = now - *since;
        if before == command {
            // A step is as good as half of one later.
            let commands = if held < between - dt / 2.0 {
                Commands::Move
            } else {
                Commands::Rest
            };
            return Planned {
                commands,
                speeds: Vec::new(),
            };
        }
        let seconds = held.clamp(dt, between);
        let speeds = self.drives.iter().map(|drive| {
            let joints = drive.joints.iter();
            let moves = joints.map(|joint| (command[*joint] - before[*joint]).abs());
            moves.fold(0.0, f64::max) / seconds
        });
        let speeds = speeds.collect();
        self.command = Some((command.clone(), now));
        Planned {
            commands: Commands::Move,
            speeds,
        }
    }

    /// Ends a row, where one has begun.
    fn row(&mut self, simulation: &Simulation) {
        if self.sums.steps == 0 {
            return;
        }
        let robot = simulation.robot();
        let sums = std::mem::replace(&mut self.sums, RowSums::none(simulation));
        let contact = sums.contacts.ground();
        let poses = simulation.body_poses();
        let tops = Tops::from_poses(robot, &self.parts, &poses);
        let (root, angles) = (simulation.ground_from_root(), simulation.joint_angles());
        let time = simulation.time() - self.begin.unwrap_or_default();
        let sides = Sides::from_poses(robot, &poses, &root);
        self.crawl.sides.widen(sides);
        self.nearness.see(&angles, time);
        let done = self.crawl.cycles.len();
        // The last row of all ends with the last cycle.
        let (cycle, index) = match &mut self.cycle {
            Some(cycle) => (Some(cycle), done),
            None => (self.crawl.cycles.last_mut(), done.saturating_sub(1)),
        };
        if let Some(cycle) = cycle {
            cycle.tops.raise(&tops);
            // The mean of a shorter time than others are of would be no match for their bounds.
            if sums.steps >= steps_per_row(simulation) {
                cycle.ground.add_row(contact, sums.effort.seconds);
            }
        }
        if self.detail == Detail::Sums {
            return;
        }
        let mean = |sum: f64| sum / sums.steps as f64;
        self.crawl.snapshots.push(simulation.snapshot());
        self.crawl.rows.push(Row {
            time,
            cycle: index,
            stage: sums.stage,
            command: self.reached.clone(),
            angles,
            applied_torque: sums.torque.iter().map(|&sum| mean(sum)).collect(),
            contact,
            forces: sums.contacts.forces(),
            effort: sums.effort,
            ground_from_root: root,
            tops,
        });
    }

    /// The record of what `robot` has done, and whether it has `arrived`.
    pub(super) fn finish(mut self, robot: &SimulatedRobot, arrived: bool) -> Crawl {
        self.row(robot.simulation());
        for cycle in &self.crawl.cycles {
            self.crawl.effort.add(&cycle.effort);
            self.crawl.ground.add(&cycle.ground);
            self.crawl.tops.raise(&cycle.tops);
        }
        Crawl {
            touches: self.touches.finish(),
            nearest: self.nearness.finish(),
            stopped: robot.stopped(),
            arrived,
            engine_steps: robot.simulation().steps(),
            ..self.crawl
        }
    }
}
