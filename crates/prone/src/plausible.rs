//! Whether a robot's numbers are those of a robot: masses, motors and limits in proportion to its size
//! and to each other.
//!
//! A number can be within all its own bounds ([`crate::robot::bounds`]) and still be wrong by its unit, or by a
//! factor. The engine would simulate that, and what comes out looks like a result. So each is compared
//! with what it has to do. The limits are far from all robots that are built: every one says what it
//! protects.

mod about;
pub mod symmetry;

use glam::DVec3;

use crate::frames::Root;
use crate::robot::{BodyId, BodyPoses, Joint, JointId, Robot, bounds};
use crate::statics::GRAVITY;
pub use about::About;
use about::short;
use symmetry::{Asymmetry, AsymmetryError};

/// Mass over the cube of the chain's length, kg/m³. That of people and of humanoids is 7 to 30.
const MASS_OVER_LENGTH_CUBED: (f64, f64) = (1.0, 150.0);
/// Least mass of a leg or an arm, as a share of the robot's.
const LEAST_LIMB: f64 = 0.005;
/// How far a centre of mass may be outside of what its body is known to reach to, as a share of the
/// chain's length: shapes that do not collide are not known.
const CENTRE_OUTSIDE: f64 = 0.12;
/// Effort limit over weight times length of the chain. That of the NAO's wrist is 0.014.
const EFFORT_SHARE: (f64, f64) = (1e-4, 50.0);
/// Speed limits of joints, rad/s.
const SPEEDS: (f64, f64) = (0.2, 200.0);
/// Least angle between the stops of a joint, rad: three degrees.
const LEAST_TURN: f64 = 0.05;
/// Length that the planted chain spans, over that of the chain.
const SPAN_SHARE: (f64, f64) = (0.2, 1.2);
/// Continuous torque over stall torque of a motor.
const CONTINUOUS_SHARE: (f64, f64) = (1e-3, 1.0);
/// Effort limit over the motor's stall torque at the joint.
const EFFORT_OVER_STALL: (f64, f64) = (0.005, 2.0);
/// Stated lengths over that of the chain.
const LENGTH_SHARE: (f64, f64) = (0.3, 4.0);

/// A number that no robot has.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct Implausible {
    /// What it is the number of.
    pub about: About,
    /// The value, its bound, and what the bound protects.
    pub message: String,
}

impl From<AsymmetryError> for Implausible {
    fn from(AsymmetryError { about, message }: AsymmetryError) -> Self {
        Self { about, message }
    }
}

/// Checks a robot whose chain is that of two legs and two arms; returns the small differences
/// between left and right that real models have.
///
/// # Errors
/// [`Implausible`], the first number that no robot has.
pub fn check(robot: &Robot) -> Result<Vec<Asymmetry>, Implausible> {
    let poses = robot.zero_pose();
    let length = chain_length(robot, &poses);
    check_lengths(robot, length)?;
    check_masses(robot, length)?;
    for (index, joint) in robot.joints.iter().enumerate() {
        check_joint(robot, JointId(index), joint, length)?;
    }
    check_centres(robot, length)?;
    Ok(symmetry::check(robot, &poses, length)?)
}

/// Length of the longer side's chain from toe to elbow, stretched out, m.
pub fn length(robot: &Robot) -> f64 {
    chain_length(robot, &robot.zero_pose())
}

fn chain_length(robot: &Robot, poses: &BodyPoses<Root>) -> f64 {
    let sides = robot.chain.sides().map(|side| {
        let anchor = |id: JointId| poses.anchor(&robot.joints[id.0]).metres();
        let points = [
            poses.point(side.toe).metres(),
            anchor(side.ankle),
            anchor(side.knee),
            anchor(side.hip),
            anchor(side.shoulder),
            poses.point(side.elbow).metres(),
        ];
        points
            .windows(2)
            .map(|pair| pair[0].distance(pair[1]))
            .sum()
    });
    f64::max(sides[0], sides[1])
}

fn within(
    about: About,
    what: &str,
    value: f64,
    (least, largest): (f64, f64),
    unit: &str,
    protects: &str,
) -> Result<(), Implausible> {
    if (least..=largest).contains(&value) {
        return Ok(());
    }
    let message = format!(
        "{what} {} is outside {}..{}{unit}: {protects}",
        short(value),
        short(least),
        short(largest)
    );
    Err(Implausible { about, message })
}

fn check_lengths(robot: &Robot, length: f64) -> Result<(), Implausible> {
    let (least, largest) = LENGTH_SHARE;
    let bound = (least * length * 1e3, largest * length * 1e3);
    let of_the_chain = "from toe to elbow the chain is what the model says";
    let lying = robot.lying_length * 1e3;
    within(
        About::LyingLength,
        "lying_length_mm",
        lying,
        bound,
        " mm",
        of_the_chain,
    )?;
    let (least, largest) = SPAN_SHARE;
    let stretched = "the chain from toe to elbow, stretched out, is what the model says";
    within(
        About::Span,
        "span_mm",
        robot.chain.span * 1e3,
        (least * length * 1e3, largest * length * 1e3),
        " mm",
        stretched,
    )?;
    match robot.standing_height {
        Some(metres) => {
            let about = About::StandingHeight;
            within(
                about,
                "standing_height_mm",
                metres * 1e3,
                bound,
                " mm",
                of_the_chain,
            )
        }
        None => Ok(()),
    }
}

fn check_masses(robot: &Robot, length: f64) -> Result<(), Implausible> {
    let mass = robot.mass();
    let whole = About::Robot;
    let protects = "no humanoid is lighter or heavier";
    within(
        whole,
        "the mass of the robot",
        mass,
        bounds::TOTAL_MASS,
        " kg",
        protects,
    )?;
    let (least, largest) = MASS_OVER_LENGTH_CUBED;
    let cube = length.powi(3);
    let what = format!("of a robot whose chain is {length:.3} m long the mass");
    let protects = "a body of that size is no lighter or heavier";
    within(
        whole,
        &what,
        mass,
        (least * cube, largest * cube),
        " kg",
        protects,
    )?;
    for side in robot.chain.sides() {
        for (limb, joint) in [("leg", side.hip), ("arm", side.shoulder)] {
            let first = robot.joints[joint.0].body;
            let bodies = (0..robot.bodies.len()).map(BodyId);
            let limb_mass: f64 = bodies
                .filter(|body| robot.moves_with(*body, first))
                .map(|body| robot.bodies[body.0].mass)
                .sum();
            let name = &robot.bodies[first.0].name;
            within(
                About::Mass(first),
                &format!("the mass of the {limb} from body {name} on"),
                limb_mass,
                (LEAST_LIMB * mass, mass),
                " kg",
                "a limb has motors and bones",
            )?;
        }
    }
    Ok(())
}

fn check_joint(robot: &Robot, id: JointId, joint: &Joint, length: f64) -> Result<(), Implausible> {
    let name = &joint.name;
    let stops = &joint.range;
    for stop in [stops.lower, stops.upper] {
        within(
            About::Range(id),
            &format!("joint {name}: the stop"),
            stop,
            (-bounds::STOP, bounds::STOP),
            " rad",
            "a joint of a limb turns by less than two turns",
        )?;
    }
    within(
        About::Range(id),
        &format!("joint {name}: the angle between its stops,"),
        stops.upper - stops.lower,
        (LEAST_TURN, 2.0 * bounds::STOP),
        " rad",
        "a joint turns; a model without angle=\"radian\" counts degrees",
    )?;
    let weight = robot.mass() * GRAVITY * length;
    let (least_effort, largest_effort) = (EFFORT_SHARE.0 * weight, EFFORT_SHARE.1 * weight);
    within(
        About::Effort(id),
        &format!("joint {name}: effort_nm"),
        joint.effort_limit,
        (least_effort, largest_effort),
        " N·m",
        "a motor moves some of the robot's weight, and is carried by it",
    )?;
    let protects = "a joint moves within seconds";
    within(
        About::Speed(id),
        &format!("joint {name}: speed_rad_s"),
        joint.speed_limit,
        SPEEDS,
        " rad/s",
        protects,
    )?;
    // A servo reaches its effort limit at an error of a turn.
    let softest = joint.effort_limit / std::f64::consts::TAU;
    within(
        About::Stiffness(id),
        &format!("joint {name}: servo_stiffness_nm_rad"),
        joint.servo_stiffness,
        (softest, bounds::STIFFNESS),
        " N·m/rad",
        "a servo gives its effort at an error of a turn at most",
    )?;
    let Some(motor) = joint.motor else {
        return Ok(());
    };
    let (least, largest) = CONTINUOUS_SHARE;
    within(
        About::ContinuousTorque(id),
        &format!("joint {name}: nominal (continuous) torque"),
        motor.nominal,
        (least * motor.stall, largest * motor.stall),
        " N·m at the joint",
        "what a motor gives for ever is a part of what it gives at stall",
    )?;
    within(
        About::Effort(id),
        &format!("joint {name}: effort_nm"),
        joint.effort_limit,
        (
            EFFORT_OVER_STALL.0 * motor.stall,
            EFFORT_OVER_STALL.1 * motor.stall,
        ),
        " N·m",
        "a current limit is a part of what the motor gives at stall, or little above it",
    )?;
    within(
        About::Stall(id),
        &format!("joint {name}: stall torque"),
        motor.stall,
        (least_effort, largest_effort),
        " N·m at the joint",
        "a motor moves some of the robot's weight, and is carried by it",
    )
}

/// Least and largest coordinates of what a body is known to reach to, and a margin around that, m in the
/// body's frame: its hinge, the hinges and bodies that hang on it, its shapes, the chain's ends.
pub fn reach(robot: &Robot, body: BodyId, length: f64) -> (DVec3, DVec3) {
    let margin = DVec3::splat(CENTRE_OUTSIDE * length);
    let mut reach = (DVec3::ZERO, DVec3::ZERO);
    let mut add = |point: DVec3| reach = (reach.0.min(point), reach.1.max(point));
    for joint in &robot.joints {
        let child = &robot.bodies[joint.body.0];
        if joint.body == body {
            add(joint.anchor.metres());
        } else if child.parent == Some(body) {
            add((child.parent_from_body * joint.anchor).metres());
        }
    }
    for child in robot.bodies.iter().filter(|it| it.parent == Some(body)) {
        add(child.parent_from_body.origin().metres());
    }
    for shape in robot.shapes.iter().filter(|it| it.body == body) {
        let at = shape.link_from_geom.origin().metres();
        let inverse = shape.link_from_geom.rotation().inverse();
        let half = DVec3::from_array(DVec3::AXES.map(|axis| shape.solid.reach(inverse * axis)));
        add(at - half);
        add(at + half);
    }
    for side in robot.chain.sides() {
        let ends = [side.toe, side.elbow].into_iter();
        ends.filter(|(of, _)| *of == body)
            .for_each(|(_, point)| add(point.metres()));
    }
    (reach.0 - margin, reach.1 + margin)
}

/// Each body's centre of mass is where the body is: between its hinge, what hangs on it, and its shapes.
fn check_centres(robot: &Robot, length: f64) -> Result<(), Implausible> {
    for (index, body) in robot.bodies.iter().enumerate() {
        if body.mass <= 0.0 {
            continue;
        }
        let (least, largest) = reach(robot, BodyId(index), length);
        let centre = body.centre_of_mass.metres();
        for (place, axis) in ["x", "y", "z"].into_iter().enumerate() {
            within(
                About::CentreOfMass(BodyId(index)),
                &format!("body {}: {axis} of the centre of mass,", body.name),
                centre[place],
                (least[place], largest[place]),
                " m",
                "it is within what the body's hinges and shapes reach to, and a margin",
            )?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::Point;
    use crate::robot::{Motor, testing};

    fn refusal(change: impl FnOnce(&mut Robot)) -> String {
        let mut robot = testing::two_armed();
        change(&mut robot);
        check(&robot).unwrap_err().to_string()
    }

    #[test]
    fn a_robot_in_proportion_is_taken() {
        assert_eq!(check(&testing::two_armed()), Ok(Vec::new()));
    }

    #[test]
    fn numbers_out_of_proportion_are_refused_with_their_bound() {
        let knee = testing::two_armed().chain.right.knee;
        let joint = |change: fn(&mut Joint)| refusal(|robot| change(&mut robot.joints[knee.0]));
        for (message, says) in [
            (
                refusal(|it| it.bodies.iter_mut().for_each(|body| body.mass *= 1e-6)),
                "outside 0.05..500 kg",
            ),
            (refusal(|it| it.bodies[0].mass = 400.0), "is outside 0."),
            (refusal(|it| it.bodies[2].mass = f64::NAN), "NaN"),
            (
                refusal(|it| it.lying_length = 9.0),
                "lying_length_mm 9000 is outside",
            ),
            (
                refusal(|it| it.standing_height = Some(0.01)),
                "standing_height_mm 10 is outside",
            ),
            (
                refusal(|it| it.bodies[3].centre_of_mass = Point::new(DVec3::X)),
                "centre of mass",
            ),
            (
                joint(|it| it.effort_limit = 1e-6),
                "effort_nm 1.000e-6 is outside",
            ),
            (
                joint(|it| it.speed_limit = 1e-5),
                "speed_rad_s 1.000e-5 is outside 0.2..200 rad/s",
            ),
            (
                joint(|it| it.servo_stiffness = 0.01),
                "servo_stiffness_nm_rad 0.01 is outside",
            ),
            (
                joint(|it| it.range.upper = it.range.lower + 0.01),
                "the angle between its stops",
            ),
            (refusal(|it| it.chain.span *= 1e-3), "span_mm 0."),
            (
                joint(|it| it.range.upper = 1e6),
                "is outside -12.56637..12.56637 rad",
            ),
        ] {
            assert!(message.contains(says), "{message}");
        }
    }

    #[test]
    fn a_motor_gives_more_at_stall_than_for_ever() {
        let message = refusal(|robot| {
            robot.joints[0].motor = Some(Motor {
                ratio: 100.0,
                nominal: 6.0,
                stall: 4.0,
                no_load_speed: None,
            });
        });
        assert!(message.contains("continuous) torque"), "{message}");
    }

    #[test]
    fn sides_that_differ_are_told_or_refused() {
        let robot = testing::two_armed();
        let knee = robot.chain.right.knee.0;
        let told = |change: fn(&mut Robot, usize)| {
            let mut robot = robot.clone();
            change(&mut robot, knee);
            check(&robot)
                .map(|told| told.len())
                .map_err(|error| error.to_string())
        };
        assert_eq!(told(|it, knee| it.joints[knee].range.upper += 0.1), Ok(1));
        assert_eq!(told(|it, knee| it.joints[knee].effort_limit *= 1.1), Ok(1));
        let body = |it: &Robot, knee: usize| it.joints[knee].body.0;
        let heavier = told(|it, knee| it.bodies[it.joints[knee].body.0].mass *= 1.1);
        assert_eq!(heavier, Ok(1), "{}", body(&robot, knee));
        for refused in [
            told(|it, knee| it.joints[knee].range.upper += 0.5),
            told(|it, knee| it.joints[knee].effort_limit *= 1.5),
            told(|it, knee| it.bodies[it.joints[knee].body.0].mass *= 1.5),
            // It bends the other way, with the stops that it had.
            told(|it, knee| {
                it.joints[knee].axis = -it.joints[knee].axis;
                it.joints[knee].range.upper -= 1.0;
            }),
        ] {
            let message = refused.unwrap_err();
            assert!(
                message.contains("allowed, as both sides are commanded alike"),
                "{message}"
            );
        }
    }
}
