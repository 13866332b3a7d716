//! A simulation as something that can be driven: the port of [`prone::port`].
//!
//! A tick is one engine step. Commands reach the servos as the motors of a robot take them: off by
//! the calibration error of each joint, and no farther than its stop; the measured angles are the true
//! ones, without that error. Where commands are late ([`LateCommands`]), they reach the servos some
//! steps after they were given. The bearing that is felt is the
//! simulation's own, without error; what the inertial unit says has noise and bias ([`crate::imu`]).

mod late;

pub use late::LateCommands;

use prone::port::{
    Command, InertialUnit, JointCommand, Limits, Pace, PortError, Segment, Sense, Senses, Stop,
};
use prone::robot::{JointAngles, JointId, Range, Robot};
use prone::steering::Bearing;

use crate::imu::SimulatedImu;
use crate::simulation::Simulation;
use late::Bus;

/// A simulated robot that can be driven.
#[derive(Debug, Clone)]
pub struct SimulatedRobot {
    simulation: Simulation,
    imu: Option<SimulatedImu>,
    /// What every commanded angle is off by, rad.
    offsets: Option<JointAngles>,
    /// What was commanded last, before the offsets, rad.
    commanded: JointAngles,
    /// What commands take their time on, where they are late.
    bus: Option<Bus>,
    /// What has reached the servos last, before the offsets, rad; only kept where commands are late.
    reached: JointAngles,
    path: Option<Path>,
    stopped: Vec<Option<StoppedJoint>>,
}

/// A path in time that is being followed.
#[derive(Debug, Clone)]
struct Path {
    segment: Segment,
    from: JointAngles,
    began: f64,
}

/// A joint whose calibration error has led a command beyond its stop, where it was stopped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StoppedJoint {
    /// Which joint.
    pub joint: JointId,
    /// How many commands.
    pub commands: usize,
    /// The largest angle that was cut off, rad, with the sign of the side it was cut on.
    pub largest: f64,
}

impl SimulatedRobot {
    /// A robot whose joints are exact, whose servos get every command at once, and whose inertial unit is not read.
    pub fn new(simulation: Simulation) -> Self {
        Self {
            imu: None,
            offsets: None,
            commanded: simulation.reference(),
            bus: None,
            reached: simulation.reference(),
            path: None,
            stopped: vec![None; simulation.robot().joints.len()],
            simulation,
        }
    }

    /// The same with joints whose every command is off by an angle, rad.
    #[must_use]
    pub fn with_offsets(self, offsets: Option<JointAngles>) -> Self {
        Self { offsets, ..self }
    }

    /// The same with commands that reach the servos late.
    #[must_use]
    pub fn with_late_commands(self, late: Option<LateCommands>) -> Self {
        let regime = *self.simulation.world().regime();
        Self {
            bus: late.map(|late| Bus::new(late, &regime)),
            ..self
        }
    }

    /// The same with an inertial unit that is read with every look at its senses.
    #[must_use]
    pub fn with_imu(self, imu: Option<SimulatedImu>) -> Self {
        Self { imu, ..self }
    }

    /// The simulation.
    pub const fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// What was commanded last, rad, before any calibration error.
    pub const fn commanded(&self) -> &JointAngles {
        &self.commanded
    }

    /// What has reached the servos last, rad, before any calibration error: what was commanded last,
    /// where commands are not late.
    pub const fn reached(&self) -> &JointAngles {
        match self.bus {
            Some(_) => &self.reached,
            None => &self.commanded,
        }
    }

    /// Joints whose calibration error was stopped at a stop so far.
    pub fn stopped(&self) -> Vec<StoppedJoint> {
        self.stopped.iter().flatten().copied().collect()
    }

    fn hold(&mut self, posture: JointAngles) {
        match &mut self.bus {
            Some(bus) => bus.command(posture.clone()),
            None => self.reach(&posture),
        }
        self.commanded = posture;
    }

    /// Lets the servos hold a posture from now on, off by the calibration errors.
    fn reach(&mut self, posture: &JointAngles) {
        match self.off_by(posture) {
            None => self.simulation.command(posture),
            Some(off) => self.simulation.command(&off),
        }
    }

    /// A command as the motors take it, `None` where they are exact.
    fn off_by(&mut self, command: &JointAngles) -> Option<JointAngles> {
        let offsets = self.offsets.as_ref()?;
        let stops = self.simulation.world().stops();
        let stopped = &mut self.stopped;
        Some(command.map(|joint, angle| {
            let (asked, stop) = (angle + offsets[joint], stops[joint.0]);
            let excess = stop.excess(asked);
            if excess != 0.0 {
                let stopped = stopped[joint.0].get_or_insert(StoppedJoint {
                    joint,
                    commands: 0,
                    largest: 0.0,
                });
                stopped.commands += 1;
                if excess.abs() > stopped.largest.abs() {
                    stopped.largest = excess;
                }
            }
            asked.clamp(stop.lower, stop.upper)
        }))
    }
}

impl Sense for SimulatedRobot {
    fn sense(&mut self) -> Result<Senses, PortError> {
        let simulation = &self.simulation;
        let inertial = match &mut self.imu {
            None => InertialUnit::Absent,
            Some(imu) => InertialUnit::Reading(imu.read(simulation)),
        };
        Ok(Senses {
            time: simulation.time(),
            angles: simulation.joint_angles(),
            inertial,
            bearing: Some(Bearing::of_prone(&simulation.ground_from_root())),
            touch: Some(simulation.ground_contact()),
        })
    }
}

impl Command for SimulatedRobot {
    fn command(&mut self, command: &JointCommand) -> Result<(), PortError> {
        match command {
            JointCommand::Continue => {}
            JointCommand::SetPoint(posture) => {
                self.path = None;
                self.hold(posture.clone());
            }
            JointCommand::Segment(segment) => {
                self.path = Some(Path {
                    segment: segment.clone(),
                    from: self.commanded.clone(),
                    began: self.simulation.time(),
                });
            }
        }
        Ok(())
    }
}

impl Pace for SimulatedRobot {
    fn time(&self) -> f64 {
        self.simulation.time()
    }

    fn tick(&self) -> f64 {
        self.simulation.time_step()
    }

    fn wait(&mut self) -> Result<(), PortError> {
        if let Some(path) = &self.path {
            // What is to be reached when the step is over.
            let time = self.simulation.time() + self.simulation.time_step() - path.began;
            let posture = path.segment.at(time, &path.from);
            let last = path.segment.knots.last();
            if last.is_none_or(|knot| knot.seconds <= time) {
                self.path = None;
            }
            self.hold(posture);
        }
        let step = self.simulation.steps();
        if let Some(posture) = self.bus.as_mut().and_then(|bus| bus.arrived(step)) {
            self.reach(&posture);
            self.reached = posture;
        }
        self.simulation.step();
        let checked = self.simulation.check();
        checked.map_err(|error| PortError::Backend(Box::new(error)))
    }
}

impl Stop for SimulatedRobot {
    fn stop(&mut self) -> Result<(), PortError> {
        self.path = None;
        Ok(())
    }
}

impl Limits for SimulatedRobot {
    fn robot(&self) -> &Robot {
        self.simulation.robot()
    }

    fn stops(&self) -> &[Range] {
        self.simulation.world().stops()
    }
}
