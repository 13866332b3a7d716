//! Physics that no robot has, refused at its place in `robot.toml` or in the model.

use mujoco_rs::prelude::*;

use prone::plausible::{self, About, Implausible};
use prone::robot::{JointId, Robot};
use prone_files::FileError;
use prone_files::model_file::{ModelFile, ModelPart};
use prone_files::robot_file::{DriveTable, Name, Number, RobotFile};

use super::lookup::Lookup;
use crate::engine_numbers::FREE_JOINT_SPEEDS;

/// Speed that a joint reaches against its damping, as a share of its speed limit.
const SPEED_AGAINST_DAMPING: f64 = 0.05;
/// Acceleration of a motor's own rotor by its effort limit, rad/s²: that of a heavy door.
const LEAST_ACCELERATION: f64 = 1.0;
/// Torque of a spring at a joint's stop, as a multiple of the effort limit.
const SPRING_OVER_EFFORT: f64 = 2.0;
/// Radii of gyration of a body, as shares of the chain's length: a hair, and the robot.
const GYRATION: (f64, f64) = (1e-4, 2.0);

/// Where `robot.toml` says what a robot's numbers are.
pub(super) struct Places {
    model: Name,
    standing_height: Option<Number>,
    lying_length: Number,
    drives: Vec<DriveTable>,
    motors: Vec<(Name, Number)>,
}

impl Places {
    pub(super) fn of(table: &RobotFile) -> Self {
        let motors = table.motors.iter();
        Self {
            model: table.model.clone(),
            standing_height: table.standing_height_mm.clone(),
            lying_length: table.pictures.lying_length_mm.clone(),
            drives: table.drives.clone(),
            motors: motors
                .map(|(name, motor)| (name.clone(), motor.nominal_mnm.clone()))
                .collect(),
        }
    }

    /// The error at the place of its number.
    pub(super) fn error(
        &self,
        lookup: &Lookup<'_>,
        model: &ModelFile,
        robot: &Robot,
        Implausible { about, message }: &Implausible,
    ) -> FileError {
        let joint = |id: JointId| &robot.joints[id.0];
        let drive = |id: JointId| {
            let name = &joint(id).name;
            let mut drives = self.drives.iter();
            drives.find(|drive| drive.joints.iter().any(|joint| joint.get_ref() == name))
        };
        let at_drive = |id: JointId, number: fn(&DriveTable) -> &Number| match drive(id) {
            Some(drive) => lookup.error(number(drive), message),
            None => lookup.error(&self.model, message),
        };
        let in_model =
            |part, name: &str, attribute| model.error_at(part, name, attribute, message.clone());
        match *about {
            About::Robot if model.states(ModelPart::Compiler, "", "settotalmass") => {
                in_model(ModelPart::Compiler, "", "settotalmass")
            }
            About::Robot => {
                let heaviest = robot.bodies.iter().max_by(|a, b| a.mass.total_cmp(&b.mass));
                let name = heaviest.map_or("", |body| &body.name);
                in_model(ModelPart::Inertial, name, "mass")
            }
            About::StandingHeight => match &self.standing_height {
                Some(place) => lookup.error(place, message),
                None => lookup.error(&self.model, message),
            },
            About::LyingLength => lookup.error(&self.lying_length, message),
            About::Mass(body) => in_model(ModelPart::Inertial, &robot.bodies[body.0].name, "mass"),
            About::CentreOfMass(body) => {
                in_model(ModelPart::Inertial, &robot.bodies[body.0].name, "pos")
            }
            About::Range(id) => in_model(ModelPart::Joint, &joint(id).name, "range"),
            About::Hinge(id) => in_model(ModelPart::Joint, &joint(id).name, "axis"),
            About::Effort(id) => at_drive(id, |drive| &drive.effort_nm),
            About::Speed(id) => at_drive(id, |drive| &drive.speed_rad_s),
            About::Stiffness(id) => at_drive(id, |drive| &drive.servo_stiffness_nm_rad),
            About::ContinuousTorque(id) => {
                let motor = drive(id).and_then(|drive| drive.motor.as_ref());
                let mut motors = self.motors.iter();
                let place =
                    motors.find(|(name, _)| Some(name.get_ref()) == motor.map(Name::get_ref));
                match place {
                    Some((_, nominal)) => lookup.error(nominal, message),
                    None => lookup.error(&self.model, message),
                }
            }
        }
    }
}

/// What the engine makes of the model's text, in proportion to what the motors can do: damping, dry
/// friction, springs, rotors, and how hard bodies are to turn.
pub(super) fn check_engine(
    model: &MjModel,
    file: &ModelFile,
    robot: &Robot,
) -> Result<(), FileError> {
    let length = plausible::length(robot);
    for (index, joint) in robot.joints.iter().enumerate() {
        // The engine's joint 0 is the free one.
        let (engine_joint, speed) = (index + 1, FREE_JOINT_SPEEDS + index);
        let effort = joint.effort_limit;
        let lever = [joint.range.lower, joint.range.upper]
            .map(|stop| (stop - springref(model, engine_joint)).abs())
            .into_iter()
            .fold(0.0, f64::max);
        let checks = [
            (
                "damping",
                model.dof_damping()[speed],
                effort / (SPEED_AGAINST_DAMPING * joint.speed_limit),
                "N·m·s/rad",
                "its motor moves it at a twentieth of its speed limit",
            ),
            (
                "frictionloss",
                model.dof_frictionloss()[speed],
                effort,
                "N·m",
                "its motor overcomes the dry friction",
            ),
            (
                "armature",
                model.dof_armature()[speed],
                effort / LEAST_ACCELERATION,
                "kg·m²",
                "its motor turns its own rotor",
            ),
            (
                "stiffness",
                model.jnt_stiffness()[engine_joint],
                SPRING_OVER_EFFORT * effort / lever,
                "N·m/rad",
                "its motor moves it against the spring",
            ),
        ];
        for (attribute, value, largest, unit, protects) in checks {
            // A NaN is in no range.
            if !(0.0..=largest).contains(&value) {
                let message = format!(
                    "joint {}: {attribute} {value} is outside 0..{largest:.4} {unit}: {protects}",
                    joint.name
                );
                return Err(file.error_at(ModelPart::Joint, &joint.name, attribute, message));
            }
        }
    }
    for (index, body) in robot.bodies.iter().enumerate() {
        // The engine's body 0 is the world.
        let inertia = model.body_inertia()[index + 1];
        let (least, largest) = (GYRATION.0 * length, GYRATION.1 * length);
        for principal in inertia {
            let radius = (principal / body.mass).sqrt();
            if body.mass > 0.0 && !(least..=largest).contains(&radius) {
                let message = format!(
                    "body {}: with {principal:e} kg·m² and {} kg its radius of gyration {radius:.2e} m is outside {least:.1e}..{largest:.2} m: its mass is within the robot",
                    body.name, body.mass
                );
                return Err(file.error_at(ModelPart::Inertial, &body.name, "fullinertia", message));
            }
        }
    }
    Ok(())
}

/// The angle at which a joint's spring rests, rad.
fn springref(model: &MjModel, joint: usize) -> f64 {
    let address = usize::try_from(model.jnt_qposadr()[joint]).ok();
    address.map_or(f64::NAN, |address| model.qpos_spring()[address])
}
