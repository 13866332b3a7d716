//! A robot as JSON: mirrors of the types in [`prone::robot`], whose keys say the units.
//!
//! Bodies and joints are referred to by name. Every key has to be there, and no other: an optional
//! part that is left out, which `Option::deserialize` refuses, is a text that was cut and not a robot
//! without the part. Each mirror is made of its part of a robot by `new`, and checks and
//! gives it back by `read`. Both name all fields, so that one that the domain gains does not compile
//! until it is read, and written.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use prone::mapping;
use prone::plausible::{self, About, Implausible};
use prone::robot::{Body, ContactGroup, JointAngles, JointId, Robot, check_limbs};

use super::bodies::{BodyDocument, JointDocument, ShapeDocument, check_moved};
use super::chain::ChainDocument;
use super::control::{ControlDocument, ImuDocument, SearchDocument, StudyDocument};
use super::coupled::CoupledLimitDocument;
use super::names::{self, Names, joint_name};
use super::place::{Place, Violation, optional};
use crate::part_name;

/// More bodies, and so more joints, than any robot has.
const MOST_BODIES: usize = 250;
/// More shapes than any robot has.
const MOST_SHAPES: usize = 2_000;
/// More postures than anybody lists.
const MOST_POSTURES: usize = 1_000;

/// A robot as it stands in a JSON text: in a compiled robot, and in whatever else will hold one.
///
/// [`RobotDocument::from_robot`] and [`RobotDocument::robot`] convert; in between it is text that
/// nobody has checked.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RobotDocument {
    name: String,
    #[serde(deserialize_with = "Option::deserialize")]
    standing_height_m: Option<f64>,
    pub(super) bodies: Vec<BodyDocument>,
    pub(super) joints: Vec<JointDocument>,
    /// Joints that one motor turns together, by name.
    shared_motors: Vec<Vec<String>>,
    coupled_limits: Vec<CoupledLimitDocument>,
    pub(super) shapes: Vec<ShapeDocument>,
    pub(super) chain: ChainDocument,
    postures: Vec<PostureDocument>,
    study: StudyDocument,
    #[serde(deserialize_with = "Option::deserialize")]
    imu: Option<ImuDocument>,
    control: ControlDocument,
    search: SearchDocument,
    lying_length_m: f64,
}

/// A posture, one angle for each joint in their order. Postures are a list, not an object: of two
/// keys with one name JSON's readers take the last one in silence.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PostureDocument {
    name: String,
    angles_rad: Vec<f64>,
}

impl RobotDocument {
    /// Writes a robot down, every number as it is.
    ///
    /// # Panics
    /// Where the robot's bodies and joints refer to ones that it has not.
    pub fn from_robot(robot: &Robot) -> Self {
        let (bodies, joints, shapes) = (&robot.bodies, &robot.joints, &robot.shapes);
        let postures = robot.postures.iter().map(|(name, angles)| PostureDocument {
            name: name.clone(),
            angles_rad: angles.as_slice().to_vec(),
        });
        Self {
            name: robot.name.clone(),
            standing_height_m: robot.standing_height,
            bodies: bodies
                .iter()
                .map(|body| BodyDocument::new(robot, body))
                .collect(),
            joints: joints
                .iter()
                .map(|joint| JointDocument::new(robot, joint))
                .collect(),
            shared_motors: robot
                .shared_motors
                .iter()
                .map(|them| them.iter().map(|id| joint_name(robot, *id)).collect())
                .collect(),
            coupled_limits: robot
                .coupled_limits
                .iter()
                .map(|limit| CoupledLimitDocument::new(robot, limit))
                .collect(),
            shapes: shapes
                .iter()
                .map(|shape| ShapeDocument::new(robot, shape))
                .collect(),
            chain: ChainDocument::new(robot),
            postures: postures.collect(),
            study: StudyDocument::new(robot),
            imu: robot.imu.as_ref().map(ImuDocument::new),
            control: ControlDocument::new(&robot.control),
            search: SearchDocument::new(&robot.search),
            lying_length_m: robot.lying_length,
        }
    }

    /// The robot, checked: what loads can crawl.
    ///
    /// # Errors
    /// [`Violation`], the first one, with its place below `root`, the key that this document has in
    /// the text around it.
    pub fn robot(&self, root: &'static str) -> Result<Robot, Violation> {
        let at = Place::Root(root);
        let (bodies, joints) = (at.key("bodies"), at.key("joints"));
        let (shapes, postures) = (at.key("shapes"), at.key("postures"));
        let names = Names {
            bodies: names::index(bodies, &self.bodies, MOST_BODIES, |it| &it.name)?,
            joints: names::index(joints, &self.joints, MOST_BODIES, |it| &it.name)?,
        };
        names::check_parts(bodies, "body", &names.bodies, part_name::check_body)?;
        names::check_parts(joints, "joint", &names.joints, part_name::check_joint)?;
        names::index(shapes, &self.shapes, MOST_SHAPES, |it| &it.name)?;
        names::index(postures, &self.postures, MOST_POSTURES, |it| &it.name)?;
        let height = at.key("standing_height_m");
        let robot = Robot {
            name: at.key("name").name(&self.name)?,
            standing_height: optional(self.standing_height_m, |metres| height.length(metres))?,
            bodies: bodies.each(&self.bodies, |at, index, body| body.read(at, index, &names))?,
            joints: joints.each(&self.joints, |at, _, joint| joint.read(at, &names))?,
            shared_motors: self.shared_motors(at.key("shared_motors"), &names)?,
            coupled_limits: at
                .key("coupled_limits")
                .each(&self.coupled_limits, |at, _, it| it.read(at, &names))?,
            shapes: shapes.each(&self.shapes, |at, _, shape| shape.read(at, &names))?,
            chain: self.chain.read(at.key("chain"), &names)?,
            postures: postures
                .each(&self.postures, |at, _, it| it.read(at, self.joints.len()))?
                .into_iter()
                .collect(),
            study: self.study.read(at.key("study"), &names)?,
            imu: optional(self.imu.as_ref(), |imu| imu.read(at.key("imu")))?,
            control: self.control.read(at.key("control"))?,
            search: self.search.read(at.key("search"))?,
            lying_length: at.key("lying_length_m").length(self.lying_length_m)?,
        };
        check_moved(at, &robot)?;
        check_whole(at, &robot)?;
        Ok(robot)
    }
}

impl RobotDocument {
    /// Joints that share a motor, each in one list.
    fn shared_motors(
        &self,
        at: Place<'_>,
        names: &Names<'_>,
    ) -> Result<Vec<Vec<JointId>>, Violation> {
        let mut seen = BTreeSet::new();
        at.each(&self.shared_motors, |at, _, joints| {
            if joints.len() < 2 {
                return Err(at.violation("a motor is shared by two joints or more"));
            }
            at.each(joints, |at, _, name| {
                let joint = names.joint(at, name)?;
                if !seen.insert(joint) {
                    return Err(at.violation(format!("{name:?} is there twice")));
                }
                Ok(joint)
            })
        })
    }
}

impl PostureDocument {
    fn read(&self, at: Place<'_>, joints: usize) -> Result<(String, JointAngles), Violation> {
        let (place, angles) = (at.key("angles_rad"), &self.angles_rad);
        if angles.len() != joints {
            let given = angles.len();
            return Err(place.violation(format!("{given} angles for {joints} joints")));
        }
        let name = at.key("name").name(&self.name)?;
        let angle = |JointId(index)| Place::Element(&place, index).angle(angles[index]);
        Ok((name, JointAngles::try_from_fn(joints, angle)?))
    }
}

/// What the parts say together.
fn check_whole(at: Place<'_>, robot: &Robot) -> Result<(), Violation> {
    let bodies = at.key("bodies");
    if robot.bodies.is_empty() {
        return Err(bodies.violation("a robot has a body"));
    }
    let mass = robot.mass();
    if mass.is_nan() || mass <= 0.0 {
        return Err(bodies.violation("the robot has no mass"));
    }
    let is_toe = |body: &Body| body.contact_group == ContactGroup::Toe;
    if !robot.bodies.iter().any(is_toe) {
        return Err(bodies.violation("no contact_group is toe"));
    }
    for drive in robot.drives() {
        let motor = |id: &JointId| {
            let joint = &robot.joints[id.0];
            let limits = (joint.effort_limit, joint.speed_limit);
            (limits, joint.servo_stiffness, joint.motor)
        };
        if drive
            .joints
            .iter()
            .any(|it| motor(it) != motor(&drive.joints[0]))
        {
            let joint = &drive.named_after(robot).name;
            let message = format!("joints that share the motor of {joint:?} have other figures");
            return Err(at.key("shared_motors").violation(message));
        }
    }
    if robot.shapes.is_empty() {
        return Err(at.key("shapes").violation("nothing can touch the floor"));
    }
    let start = &robot.study.start_posture;
    if !robot.postures.contains_key(start) {
        let study = at.key("study");
        let place = study.key("start_posture");
        return Err(place.violation(format!("{start:?} is none of the postures")));
    }
    let chain = at.key("chain");
    check_limbs(robot).map_err(|error| chain.violation(error))?;
    // The chain must be a sagittal one and its arm projectable, or nothing else works.
    mapping::check_kinematics(robot).map_err(|error| chain.violation(error))?;
    // What the sources were refused for, this is too: the gate of a real robot relies on these numbers.
    plausible::check(robot)
        .map(drop)
        .map_err(|error| implausible(at, &error))
}

/// A number that no robot has, at its place.
fn implausible(at: Place<'_>, Implausible { about, message }: &Implausible) -> Violation {
    let (bodies, joints) = (at.key("bodies"), at.key("joints"));
    let in_body = |index, key| Place::Element(&bodies, index).key(key).violation(message);
    let in_joint = |index, key| Place::Element(&joints, index).key(key).violation(message);
    match *about {
        About::Robot => bodies.violation(message),
        About::Span => at.key("chain").key("span_m").violation(message),
        About::StandingHeight => at.key("standing_height_m").violation(message),
        About::LyingLength => at.key("lying_length_m").violation(message),
        About::Mass(body) => in_body(body.0, "mass_kg"),
        About::CentreOfMass(body) => in_body(body.0, "centre_of_mass_m"),
        About::Range(joint) => in_joint(joint.0, "range_rad"),
        About::Hinge(joint) => in_joint(joint.0, "axis"),
        About::Effort(joint) => in_joint(joint.0, "effort_limit_nm"),
        About::Speed(joint) => in_joint(joint.0, "speed_limit_rad_s"),
        About::Stiffness(joint) => in_joint(joint.0, "servo_stiffness_nm_rad"),
        About::ContinuousTorque(joint) | About::Stall(joint) => in_joint(joint.0, "motor"),
    }
}
