//! In what the sides of a robot differ.
//!
//! A robot's gaits move both sides alike, so the right one has to be the left one's mirror image: in the
//! plane y = 0 of the root, at zero angles. Models of real robots miss that by the rounding of a drawing,
//! a cable, a screw; those differences are told ([`Asymmetry`]). A limb that bends the other way, or weighs
//! twice as much, is an error in the model ([`AsymmetryError`]).

use glam::DVec3;

use super::about::{About, short};
use crate::frames::Root;
use crate::robot::mirror::{mirrored_axis, mirrored_point};
use crate::robot::{Body, BodyId, BodyPoses, ChainSide, Joint, JointId, Range, Robot, SideLayout};

/// What a difference may be: what is only told above the first, and refused above the second.
struct Limit {
    told: f64,
    refused: f64,
    unit: &'static str,
}

/// Angle between an axis and its partner's image, rad: rounding, and three degrees.
const AXIS: Limit = Limit {
    told: 1e-4,
    refused: 0.05,
    unit: "rad",
};
/// Distance of a hinge from its partner's image, as a share of the chain's length.
const PLACE: Limit = Limit {
    told: 1e-5,
    refused: 0.01,
    unit: "of the chain's length",
};
/// Difference of stops, rad. The NAO's ankles differ by 0.009.
const STOP: Limit = Limit {
    told: 1e-4,
    refused: 0.2,
    unit: "rad",
};
/// Difference of masses, as a share of the larger one.
const MASS: Limit = Limit {
    told: 1e-3,
    refused: 0.25,
    unit: "of the larger one",
};
/// Distance of a centre of mass from its partner's image, as a share of the chain's length.
const CENTRE: Limit = Limit {
    told: 1e-4,
    refused: 0.05,
    unit: "of the chain's length",
};
/// Difference of effort and speed limits, as a share of the larger one.
const DRIVE: Limit = Limit {
    told: 1e-3,
    refused: 0.25,
    unit: "of the larger one",
};
/// Bodies of this share of the robot's mass and below are cables and covers: nothing is refused of them.
const LIGHT: f64 = 0.002;

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
    for (limb, end) in [
        (
            "leg",
            (|side, _| side.toe.0) as fn(&SideLayout, &Robot) -> BodyId,
        ),
        ("arm", |side, robot| robot.joints[side.forearm[1].0].body),
    ] {
        let ways = [left, right].map(|side| way(robot, end(side, robot)));
        let hinges = |bodies: &[BodyId]| {
            let joints = bodies.iter().filter_map(|body| robot.bodies[body.0].joint);
            joints.collect::<Vec<_>>()
        };
        let [lefts, rights] = [hinges(&ways[0]), hinges(&ways[1])];
        if lefts.len() != rights.len() {
            let about = About::Hinge(if limb == "leg" {
                right.hip
            } else {
                right.shoulder
            });
            let message = format!(
                "the {} {limb} has {} joints, the {} one {}: limbs mirror each other",
                ChainSide::Left,
                lefts.len(),
                ChainSide::Right,
                rights.len()
            );
            return Err(AsymmetryError { about, message });
        }
        for (left, right) in lefts.into_iter().zip(rights) {
            sides.joints(left, right)?;
        }
    }
    Ok(sides.told)
}

/// The bodies from below the root to one.
fn way(robot: &Robot, to: BodyId) -> Vec<BodyId> {
    let mut bodies: Vec<BodyId> = robot.up_to_root(to).collect();
    bodies.pop();
    bodies.reverse();
    bodies
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
        self.compare(&STOP, off, range, || {
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
        for (what, unit, values, about) in [
            (
                "effort limits",
                "N·m",
                [one.effort_limit, other.effort_limit],
                About::Effort(right),
            ),
            (
                "speed limits",
                "rad/s",
                [one.speed_limit, other.speed_limit],
                About::Speed(right),
            ),
        ] {
            self.compare(&DRIVE, share(values), about, || {
                let [left, right] = values.map(short);
                format!("the {what} of {names} differ: {left} and {right} {unit}")
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
        let off = axis.angle_between(sign * image);
        let hinge = About::Hinge(right);
        self.compare(&AXIS, off, hinge, || {
            format!(
                "the axes of {} and {} do not mirror each other: they are {} rad apart",
                one.name,
                other.name,
                short(off)
            )
        })?;
        let [here, there] = [other, one].map(|joint| self.poses.anchor(joint).metres());
        let off = here.distance(mirrored_point(there));
        self.compare(&PLACE, off / self.length, hinge, || {
            format!(
                "{} and {} do not mirror each other: {} mm apart",
                one.name,
                other.name,
                short(off * 1e3)
            )
        })?;
        Ok(sign)
    }

    fn bodies(&mut self, left: BodyId, right: BodyId) -> Result<(), AsymmetryError> {
        let robot = self.robot;
        let [one, other] = [left, right].map(|id| &robot.bodies[id.0]);
        let masses = [one.mass, other.mass];
        let is_light = masses.iter().all(|mass| *mass <= LIGHT * robot.mass());
        let mass = Limit {
            refused: if is_light {
                f64::INFINITY
            } else {
                MASS.refused
            },
            ..MASS
        };
        self.compare(&mass, share(masses), About::Mass(right), || {
            let [left, right] = masses.map(short);
            format!(
                "the masses of {} and {} differ: {left} and {right} kg",
                one.name, other.name
            )
        })?;
        let centre = |id: BodyId, body: &Body| self.poses.point((id, body.centre_of_mass)).metres();
        let (here, there): (DVec3, DVec3) = (centre(right, other), centre(left, one));
        let off = here.distance(mirrored_point(there));
        let limit = Limit {
            refused: if is_light {
                f64::INFINITY
            } else {
                CENTRE.refused
            },
            ..CENTRE
        };
        self.compare(
            &limit,
            off / self.length,
            About::CentreOfMass(right),
            || {
                format!(
                    "the centres of mass of {} and {} do not mirror each other: {} mm apart",
                    one.name,
                    other.name,
                    short(off * 1e3)
                )
            },
        )
    }

    /// Tells a difference, or refuses it.
    fn compare(
        &mut self,
        limit: &Limit,
        off: f64,
        about: About,
        message: impl FnOnce() -> String,
    ) -> Result<(), AsymmetryError> {
        // A NaN is refused.
        if off <= limit.told {
            return Ok(());
        }
        if off <= limit.refused {
            self.told.push(Asymmetry(message()));
            return Ok(());
        }
        let message = format!(
            "{}; at most {} {} may they be apart, as both sides are commanded alike",
            message(),
            limit.refused,
            limit.unit
        );
        Err(AsymmetryError { about, message })
    }
}

/// Difference of two numbers as a share of the larger one.
fn share([one, other]: [f64; 2]) -> f64 {
    let larger = one.max(other);
    if larger > 0.0 {
        (one - other).abs() / larger
    } else {
        0.0
    }
}
