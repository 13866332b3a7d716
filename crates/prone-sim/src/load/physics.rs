//! Physics that no robot has, refused at its place in `robot.toml` or in the model.

use mujoco_rs::prelude::*;

use prone::plausible::{self, About, Implausible};
use prone::robot::{BodyId, JointId, Robot};
use prone_files::FileError;
use prone_files::model_file::{ModelFile, ModelPart};
use prone_files::robot_file::{DriveTable, MotorTable, Name, Number, RobotFile};

use super::lookup::Lookup;
use crate::engine_numbers::FREE_JOINT_SPEEDS;

/// Dry friction over the torque that a motor gives: the rest is for moving.
const FRICTION_SHARE: f64 = 0.5;
/// Inertia of a rotor over mass times squared length of the chain: that of the NAO's is 0.003.
const ROTOR_SHARE: f64 = 0.1;
/// Difference of what the model says of left and right hinges, as a share of the larger value and of
/// what it may be at most.
const SIDES: (f64, f64) = (0.25, 0.05);
/// Speed that a joint reaches against its damping, as a share of its speed limit.
const SPEED_AGAINST_DAMPING: f64 = 0.05;
/// Acceleration of a motor's own rotor by its effort limit, rad/s²: that of a heavy door.
const LEAST_ACCELERATION: f64 = 1.0;
/// Torque of a spring at a joint's stop, as a multiple of the effort limit.
const SPRING_OVER_EFFORT: f64 = 2.0;
/// Least radius of gyration of a body, as a share of the chain's length: that of the thinnest rods of
/// robots is 0.004.
const LEAST_GYRATION: f64 = 1e-3;
/// Largest moment of inertia of a body without mass, kg·m²: what a compiler's `boundinertia` may add.
const MASSLESS: f64 = 1e-3;

/// Where `robot.toml` says what a robot's numbers are.
pub(super) struct Places {
    model: Name,
    span: Number,
    standing_height: Option<Number>,
    lying_length: Number,
    drives: Vec<DriveTable>,
    motors: Vec<(Name, MotorTable)>,
}

impl Places {
    pub(super) fn of(table: &RobotFile) -> Self {
        let motors = table.motors.iter();
        Self {
            model: table.model.clone(),
            span: table.chain.span_mm.clone(),
            standing_height: table.standing_height_mm.clone(),
            lying_length: table.pictures.lying_length_mm.clone(),
            drives: table.drives.clone(),
            motors: motors
                .map(|(name, motor)| (name.clone(), motor.clone()))
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
            About::Span => lookup.error(&self.span, message),
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
            About::ContinuousTorque(id) | About::Stall(id) => {
                let named = drive(id).and_then(|drive| drive.motor.as_ref());
                let mut motors = self.motors.iter();
                let place =
                    motors.find(|(name, _)| Some(name.get_ref()) == named.map(Name::get_ref));
                match (place, *about) {
                    (Some((_, motor)), About::Stall(_)) => lookup.error(&motor.stall_mnm, message),
                    (Some((_, motor)), _) => lookup.error(&motor.nominal_mnm, message),
                    (None, _) => lookup.error(&self.model, message),
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
    let hinges: Vec<[Loss; 4]> = (0..robot.joints.len())
        .map(|index| losses(model, robot, length, index))
        .collect();
    for (joint, losses) in robot.joints.iter().zip(&hinges) {
        for loss in losses {
            let Loss {
                attribute,
                value,
                largest,
                unit,
                protects,
            } = loss;
            // A NaN is in no range.
            if !(0.0..=*largest).contains(value) {
                let message = format!(
                    "joint {}: {attribute} {value} is outside 0..{largest:.4} {unit}: {protects}",
                    joint.name
                );
                return Err(file.error_at(ModelPart::Joint, &joint.name, attribute, message));
            }
        }
    }
    for [left, right] in robot.limb_pairs() {
        for (one, other) in hinges[left.0].iter().zip(&hinges[right.0]) {
            let apart = (one.value - other.value).abs();
            let most = (SIDES.0 * one.value.max(other.value)).max(SIDES.1 * one.largest);
            if apart > most {
                let [left, right] = [left, right].map(|id| &robot.joints[id.0].name);
                let Loss {
                    attribute, unit, ..
                } = one;
                let message = format!(
                    "{attribute} of {left} and {right} differ: {} and {} {unit}, more than the {most:.4} {unit} allowed, as both sides are commanded alike",
                    one.value, other.value
                );
                return Err(file.error_at(ModelPart::Joint, right, attribute, message));
            }
        }
    }
    check_inertias(model, file, robot, length)
}

/// What a hinge loses torque to.
struct Loss {
    attribute: &'static str,
    value: f64,
    largest: f64,
    unit: &'static str,
    protects: &'static str,
}

fn losses(model: &MjModel, robot: &Robot, length: f64, index: usize) -> [Loss; 4] {
    // The engine's joint 0 is the free one.
    let (engine_joint, speed) = (index + 1, FREE_JOINT_SPEEDS + index);
    let joint = &robot.joints[index];
    // What the supply gives at rest behind the gear, or the current limit where that is less.
    let supply = joint
        .motor
        .map(|motor| robot.control.gear_efficiency * motor.stall);
    let torque = joint.effort_limit.min(supply.unwrap_or(f64::INFINITY));
    let spring_rest = springref(model, engine_joint);
    let lever = [joint.range.lower, joint.range.upper]
        .map(|stop| (stop - spring_rest).abs())
        .into_iter()
        .fold(0.0, f64::max);
    let rotor = (torque / LEAST_ACCELERATION).min(ROTOR_SHARE * robot.mass() * length.powi(2));
    [
        Loss {
            attribute: "damping",
            value: model.dof_damping()[speed],
            largest: torque / (SPEED_AGAINST_DAMPING * joint.speed_limit),
            unit: "N·m·s/rad",
            protects: "its motor moves it at a twentieth of its speed limit",
        },
        Loss {
            attribute: "frictionloss",
            value: model.dof_frictionloss()[speed],
            largest: FRICTION_SHARE * torque,
            unit: "N·m",
            protects: "half of what its motor gives is left after the dry friction",
        },
        Loss {
            attribute: "armature",
            value: model.dof_armature()[speed],
            largest: rotor,
            unit: "kg·m²",
            protects: "its motor turns its own rotor, which is a part of the robot",
        },
        Loss {
            attribute: "stiffness",
            value: model.jnt_stiffness()[engine_joint],
            largest: SPRING_OVER_EFFORT * torque / lever,
            unit: "N·m/rad",
            protects: "its motor moves it against the spring",
        },
    ]
}

/// A body is as hard to turn as its mass is, within what the body reaches to.
fn check_inertias(
    model: &MjModel,
    file: &ModelFile,
    robot: &Robot,
    length: f64,
) -> Result<(), FileError> {
    for (index, body) in robot.bodies.iter().enumerate() {
        let refused = |message: String| {
            Err(file.error_at(ModelPart::Inertial, &body.name, "fullinertia", message))
        };
        let (least_corner, largest_corner) = plausible::reach(robot, BodyId(index), length);
        let (least, largest) = (
            LEAST_GYRATION * length,
            0.5 * (largest_corner - least_corner).length(),
        );
        // The engine's body 0 is the world.
        for principal in model.body_inertia()[index + 1] {
            if body.mass > 0.0 {
                let radius = (principal / body.mass).sqrt();
                if !(least..=largest).contains(&radius) {
                    return refused(format!(
                        "body {}: with {principal:.3e} kg·m² and {} kg its radius of gyration {radius:.2e} m is outside {least:.1e}..{largest:.3} m: its mass is within what it reaches to",
                        body.name, body.mass
                    ));
                }
            } else if principal > MASSLESS {
                return refused(format!(
                    "body {}: {principal:.3e} kg·m² without mass: what resists turning has mass",
                    body.name
                ));
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
