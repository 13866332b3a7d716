//! Loads by virtual work: the second route to the torques of [`prone::statics::rest`].
//!
//! Tests of `prone` and of `prone-sim` share this file.
//!
//! A joint and its mirror image turn by ±δ; the robot comes to rest anew, so that its supports
//! stay on the floor: the displacement keeps the chain closed. On a floor without friction the
//! motors' work is all that changes the energy V, so that for one of a pair (a joint on the
//! middle plane has no second half)
//!
//! ```text
//! load_j = −½ (V(q + δ) − V(q − δ)) / 2δ,   V = G H + S L                      (1)
//! ```
//!
//! H is the height of the centre of mass at rest, L the distance of the two material points that
//! touch in the undisturbed pose, S the squeeze. This route shares nothing with the other one but
//! the robot and the squeezed points: full forward kinematics, the shapes' own support functions,
//! a golden-section search for H. It is slow.

use glam::DVec3;

use prone::frames::{Link, Point, Root, Transform};
use prone::robot::{BodyId, BodyPoses, JointAngles, JointId, Mirror, Robot, Shape};
use prone::statics::{Footing, GRAVITY, HalfRobot, Rest, RestError, Stance, SupportRule, rest};

/// Displacement δ, rad: the error of a central difference, about δ² of the load, and that of
/// rounding, about 1e-16 m · G / δ, are both near 1e-9 N·m.
const DISPLACEMENT: f64 = 1e-5;

/// How far the pitch at rest may move for such a displacement, rad.
const PITCH_WINDOW: f64 = 1e-3;

/// Golden-section steps from that window to rounding: 0.618^75 = 2e-16.
const SECTIONS: usize = 75;

/// The load of every joint, N·m, in the order of [`Robot::joints`].
pub(crate) fn loads(
    robot: &Robot,
    half: &HalfRobot,
    angles: &JointAngles,
    stance: Stance,
) -> Result<Vec<f64>, RestError> {
    let undisturbed = rest(robot, half, angles, stance)?;
    let energy = Energy::new(robot, stance, &undisturbed, angles);
    let mirror = Mirror::of(robot);
    let load = |joint: JointId| {
        let twin = mirror
            .twin(joint)
            .expect("statics has found the robot symmetric");
        let [after, before] = [DISPLACEMENT, -DISPLACEMENT].map(|delta| {
            let mut displaced = angles.clone();
            displaced[joint] += delta;
            if twin.joint != joint {
                displaced[twin.joint] += twin.sign * delta;
            }
            energy.at(&displaced)
        });
        let copies = if twin.joint == joint { 1.0 } else { 2.0 };
        -(after - before) / (2.0 * DISPLACEMENT) / copies
    };
    Ok((0..robot.joints.len()).map(JointId).map(load).collect())
}

/// Pitch of the root about +y, rad.
pub(crate) fn pitch(rest: &Rest) -> f64 {
    let forward = rest.ground_from_root.rotate(DVec3::X);
    (-forward.z).atan2(forward.x)
}

/// d of the statics' header.
fn down(pitch: f64) -> DVec3 {
    let (sin, cos) = pitch.sin_cos();
    DVec3::new(sin, 0.0, -cos)
}

/// e of the statics' header.
fn forward(pitch: f64) -> DVec3 {
    let (sin, cos) = pitch.sin_cos();
    DVec3::new(cos, 0.0, sin)
}

/// V of equation (1).
struct Energy<'r> {
    robot: &'r Robot,
    carriers: Vec<&'r Shape>,
    pitch: f64,
    squeeze: f64,
    /// The rear and front points that the floor squeezes, each in its body.
    squeezed: Option<[(BodyId, Point<Link>); 2]>,
}

impl<'r> Energy<'r> {
    fn new(robot: &'r Robot, stance: Stance, undisturbed: &Rest, angles: &JointAngles) -> Self {
        let poses = robot.forward_kinematics(undisturbed.ground_from_root, angles);
        let squeezed = match undisturbed.footing {
            Footing::One(_) => None,
            Footing::Two { rear, front } => Some([rear, front].map(|support| {
                let ground_from_link = poses.of(support.body);
                let offset = support.point.metres() - ground_from_link.origin().metres();
                let in_link = ground_from_link.rotation().inverse() * offset;
                (support.body, Point::new(in_link))
            })),
        };
        let may_carry = |shape: &&Shape| match stance.supports {
            SupportRule::AnyShape => true,
            SupportRule::ElbowNotHand => !robot
                .chain
                .sides()
                .iter()
                .any(|side| robot.moves_with(shape.body, robot.joints[side.forearm[0].0].body)),
        };
        Self {
            robot,
            carriers: robot.shapes.iter().filter(may_carry).collect(),
            pitch: pitch(undisturbed),
            squeeze: stance.squeeze,
            squeezed,
        }
    }

    fn at(&self, angles: &JointAngles) -> f64 {
        let in_root = Transform::<Root, Root>::translation(DVec3::ZERO);
        let poses = self.robot.forward_kinematics(in_root, angles);
        let centre = self.robot.centre_of_mass(&poses).metres();
        let (pitch, height) = self.lowest(&poses, centre);
        let span = self.squeezed.map_or(0.0, |points| {
            let [rear, front] = points.map(|point| poses.point(point).metres());
            (front - rear).dot(forward(pitch))
        });
        self.robot.mass() * GRAVITY * height + self.squeeze * span
    }

    /// Pitch and height of the centre of mass at rest, by golden section.
    fn lowest(&self, poses: &BodyPoses<Root>, centre: DVec3) -> (f64, f64) {
        let height = |pitch: f64| {
            let down = down(pitch);
            let reach = |shape: &&Shape| shape.reach_along(poses.of(shape.body), down);
            self.carriers.iter().map(reach).fold(f64::MIN, f64::max) - centre.dot(down)
        };
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let (mut low, mut high) = (self.pitch - PITCH_WINDOW, self.pitch + PITCH_WINDOW);
        for _ in 0..SECTIONS {
            let inner = golden * (high - low);
            if height(high - inner) < height(low + inner) {
                high = low + inner;
            } else {
                low = high - inner;
            }
        }
        let pitch = f64::midpoint(low, high);
        (pitch, height(pitch))
    }
}
