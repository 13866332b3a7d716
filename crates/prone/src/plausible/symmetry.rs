//! In what the sides of a robot differ.
//!
//! A robot's gaits move both sides alike, so the right one has to be the left one's mirror image: in the
//! plane y = 0 of the root, at zero angles. Models of real robots miss that by the rounding of a drawing,
//! a cable, a screw; those differences are told ([`Asymmetry`]). A limb that bends the other way, or weighs
//! twice as much, is an error in the model ([`AsymmetryError`]).

use glam::DVec3;

use super::about::{About, short};
use crate::frames::Root;
use crate::robot::mirror::{LIMBS, hinges_to, limb_pairs, mirrored_axis, mirrored_point};
use crate::robot::{BodyId, BodyPoses, Joint, JointId, Range, Robot};

/// What a difference may be: what is only told above the first, and refused above the second.
#[derive(Clone, Copy)]
struct Limit {
    told: f64,
    refused: f64,
}

/// Angle between an axis and its partner's image, rad: rounding, and three degrees.
const AXIS: Limit = Limit {
    told: 1e-4,
    refused: 0.05,
};
/// Distance of a hinge's line from its partner's image, as a share of the chain's length.
const PLACE: Limit = Limit {
    told: 1e-5,
    refused: 0.01,
};
/// Difference of stops, rad. The NAO's ankles differ by 0.009.
const STOP: Limit = Limit {
    told: 1e-4,
    refused: 0.2,
};
/// Difference of masses, limits and motors, as a share of the larger one.
const SHARE: Limit = Limit {
    told: 1e-3,
    refused: 0.25,
};
/// Distance of a centre of mass from its partner's image, as a share of the chain's length.
const CENTRE: Limit = Limit {
    told: 1e-4,
    refused: 0.05,
};
/// Bodies of this share of the robot's mass and below are cables and covers: nothing is refused of them.
const LIGHT: f64 = 0.002;

impl Limit {
    /// The same as a multiple, for values in a unit.
    fn of(self, whole: f64) -> Self {
        Self {
            told: self.told * whole,
            refused: self.refused * whole,
        }
    }

    /// Told, never refused.
    fn only_told(self) -> Self {
        Self {
            refused: f64::INFINITY,
            ..self
        }
    }
}

/// A difference between the sides that real robots have.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Asymmetry(pub String);

/// A difference between the sides that no robot has.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct AsymmetryError {
    /// What it is a difference of, on the right side.
    pub about: About,
    /// The values, and the bound.
    pub message: String,
}

/// Compares the limbs of both sides, joint by joint on the way from the root to toe and forearm.
pub(super) fn check(
    robot: &Robot,
    poses: &BodyPoses<Root>,
    length: f64,
) -> Result<Vec<Asymmetry>, AsymmetryError> {
    let mut sides = Sides {
        robot,
        poses,
        length,
        told: Vec::new(),
    };
    let [left, right] = robot.chain.sides();
    for ((limb, first), end) in [("leg", right.hip), ("arm", right.shoulder)]
        .into_iter()
        .zip(LIMBS)
    {
        let [lefts, rights] = [left, right].map(|side| hinges_to(robot, end(robot, side)).len());
        if lefts != rights {
            let about = About::Hinge(first);
            let message = format!(
                "the left {limb} has {lefts} joints, the right one {rights}: limbs mirror each other"
            );
            return Err(AsymmetryError { about, message });
        }
    }
    for [left, right] in limb_pairs(robot) {
        sides.joints(left, right)?;
    }
    Ok(sides.told)
}

struct Sides<'a> {
    robot: &'a Robot,
    poses: &'a BodyPoses<Root>,
    length: f64,
    told: Vec<Asymmetry>,
}

impl Sides<'_> {
    fn joints(&mut self, left: JointId, right: JointId) -> Result<(), AsymmetryError> {
        let robot = self.robot;
        let [one, other] = [left, right].map(|id| &robot.joints[id.0]);
        let names = format!("{} and {}", one.name, other.name);
        let sign = self.hinges((left, one), (right, other))?;
        let image = if sign > 0.0 {
            one.range
        } else {
            Range {
                lower: -one.range.upper,
                upper: -one.range.lower,
            }
        };
        let (stops, range) = (other.range, About::Range(right));
        let off = (stops.lower - image.lower)
            .abs()
            .max((stops.upper - image.upper).abs());
        self.compare(STOP, off, "rad", range, || {
            format!(
                "the stops of {names} do not mirror each other: {} has {}..{} rad, and the image of {} is {}..{} rad",
                other.name,
                short(stops.lower),
                short(stops.upper),
                one.name,
                short(image.lower),
                short(image.upper)
            )
        })?;
        let stall = |joint: &Joint| joint.motor.map_or(0.0, |motor| motor.stall);
        let nominal = |joint: &Joint| joint.motor.map_or(0.0, |motor| motor.nominal);
        let both = |of: &dyn Fn(&Joint) -> f64| [of(one), of(other)];
        for (what, unit, values, about) in [
            (
                "effort limits",
                "N·m",
                both(&|it| it.effort_limit),
                About::Effort(right),
            ),
            (
                "speed limits",
                "rad/s",
                both(&|it| it.speed_limit),
                About::Speed(right),
            ),
            (
                "servo stiffnesses",
                "N·m/rad",
                both(&|it| it.servo_stiffness),
                About::Stiffness(right),
            ),
            ("stall torques", "N·m", both(&stall), About::Stall(right)),
            (
                "nominal torques",
                "N·m",
                both(&nominal),
                About::ContinuousTorque(right),
            ),
        ] {
            self.share(SHARE, values, unit, about, || {
                format!("the {what} of {names} differ")
            })?;
        }
        self.bodies(one.body, other.body)
    }

    /// The sign that an angle has on the other side.
    fn hinges(
        &mut self,
        (_, one): (JointId, &Joint),
        (right, other): (JointId, &Joint),
    ) -> Result<f64, AsymmetryError> {
        let (axis, image) = (self.poses.axis(other), mirrored_axis(self.poses.axis(one)));
        let sign = if axis.dot(image) < 0.0 { -1.0 } else { 1.0 };
        let hinge = About::Hinge(right);
        let names = format!("{} and {}", one.name, other.name);
        self.compare(AXIS, axis.angle_between(sign * image), "rad", hinge, || {
            format!("the axes of {names} do not mirror each other")
        })?;
        // Where a hinge's anchor is along its axis moves nothing.
        let [here, there] = [other, one].map(|joint| self.poses.anchor(joint).metres());
        let off = (here - mirrored_point(there)).reject_from_normalized(axis.normalize());
        let place = PLACE.of(self.length * 1e3);
        self.compare(place, off.length() * 1e3, "mm", hinge, || {
            format!("the places of {names} do not mirror each other")
        })?;
        Ok(sign)
    }

    /// Compares what moves with two hinges: their bodies, and those that are fixed to them.
    fn bodies(&mut self, left: BodyId, right: BodyId) -> Result<(), AsymmetryError> {
        let robot = self.robot;
        let [one, other] = [left, right].map(|id| self.rigid(id));
        let masses = [one.0, other.0];
        let is_light = masses.iter().all(|mass| *mass <= LIGHT * robot.mass());
        let limit = |limit: Limit| if is_light { limit.only_told() } else { limit };
        let [left_name, right_name] = [left, right].map(|id| &robot.bodies[id.0].name);
        let names = format!("{left_name} and {right_name}");
        self.share(limit(SHARE), masses, "kg", About::Mass(right), || {
            format!("the masses of {names} differ")
        })?;
        let off = other.1.distance(mirrored_point(one.1)) * 1e3;
        let centre = limit(CENTRE.of(self.length * 1e3));
        self.compare(centre, off, "mm", About::CentreOfMass(right), || {
            format!("the centres of mass of {names} do not mirror each other")
        })
    }

    /// Mass of a body and of those that are fixed to it, kg, and their centre, m in the root's frame.
    fn rigid(&self, body: BodyId) -> (f64, DVec3) {
        let robot = self.robot;
        let is_part = |id: BodyId| {
            let mut above = robot.up_to_root(id);
            let carrier = above.find(|id| robot.bodies[id.0].joint.is_some());
            carrier == Some(body)
        };
        let parts = (0..robot.bodies.len())
            .map(BodyId)
            .filter(|id| is_part(*id));
        let (mut mass, mut moment) = (0.0, DVec3::ZERO);
        for id in parts {
            let part = &robot.bodies[id.0];
            mass += part.mass;
            moment += part.mass * self.poses.point((id, part.centre_of_mass)).metres();
        }
        let centre = if mass > 0.0 { moment / mass } else { moment };
        (mass, centre)
    }

    /// Compares two numbers by the larger one.
    fn share(
        &mut self,
        limit: Limit,
        values: [f64; 2],
        unit: &str,
        about: About,
        message: impl Fn() -> String,
    ) -> Result<(), AsymmetryError> {
        let [left, right] = values;
        let limit = limit.of(left.max(right));
        let said = || format!("{}: {} and {} {unit}", message(), short(left), short(right));
        self.compare(limit, (left - right).abs(), unit, about, said)
    }

    /// Tells a difference, or refuses it.
    fn compare(
        &mut self,
        limit: Limit,
        off: f64,
        unit: &str,
        about: About,
        message: impl Fn() -> String,
    ) -> Result<(), AsymmetryError> {
        // A NaN is refused.
        if off <= limit.told {
            return Ok(());
        }
        if off <= limit.refused {
            self.told.push(Asymmetry(format!(
                "{}: {} {unit} apart",
                message(),
                short(off)
            )));
            return Ok(());
        }
        let message = format!(
            "{}: {} {unit} apart, more than the {} {unit} allowed, as both sides are commanded alike",
            message(),
            short(off),
            short(limit.refused)
        );
        Err(AsymmetryError { about, message })
    }
}
