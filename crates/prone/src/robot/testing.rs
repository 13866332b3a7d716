//! A small made-up robot for unit tests: axes of mixed sign, links of odd lengths, an upper arm
//! that does not point along an axis.

use std::collections::BTreeMap;

use glam::{DQuat, DVec3};

use super::{
    Body, BodyId, ChainLayout, ContactGroup, Control, FixedArm, Joint, JointAngles, JointId, Motor,
    PublishedChain, Range, Robot, SearchSetup, Shape, SideLayout, Solid, SteeringGains, StudySetup,
};
use crate::chain::ClosedChain;
use crate::frames::{Point, Transform};

struct Builder {
    bodies: Vec<Body>,
    joints: Vec<Joint>,
}

impl Builder {
    /// Adds a hinged body and returns its two ids.
    fn hinge(&mut self, name: &str, parent: BodyId, at: DVec3, axis: DVec3) -> (BodyId, JointId) {
        let (body, joint) = (BodyId(self.bodies.len()), JointId(self.joints.len()));
        // Frames of the bodies are turned against each other, as in many models; the axis is
        // given as in the root frame at zero pose, so undo the turns.
        let turn = DQuat::from_rotation_x(0.3);
        let mut root_from_parent = DQuat::IDENTITY;
        let mut ancestor = Some(parent);
        while let Some(id) = ancestor {
            root_from_parent = self.bodies[id.0].parent_from_body.rotation() * root_from_parent;
            ancestor = self.bodies[id.0].parent;
        }
        let root_from_body = root_from_parent * turn;
        self.bodies.push(Body {
            name: name.to_owned(),
            parent: Some(parent),
            parent_from_body: Transform::new(turn, root_from_parent.inverse() * at),
            joint: Some(joint),
            mass: 0.3,
            centre_of_mass: Point::ORIGIN,
            contact_group: ContactGroup::Leg,
        });
        self.joints.push(Joint {
            name: name.to_owned(),
            body,
            axis: root_from_body.inverse() * axis,
            anchor: Point::ORIGIN,
            range: Range {
                lower: -3.0,
                upper: 3.0,
            },
            effort_limit: 3.0,
            speed_limit: 5.0,
            servo_stiffness: 40.0,
            motor: None,
        });
        (body, joint)
    }

    fn side(&mut self, left: f64) -> SideLayout {
        let trunk = BodyId(0);
        // The left hip turns about −y: a sign the mapping has to read from the model.
        let hip_axis = DVec3::NEG_Y;
        let (thigh, hip) = self.hinge("hip", trunk, DVec3::new(0.01, 0.06 * left, -0.1), hip_axis);
        let (shin, knee) = self.hinge("knee", thigh, DVec3::new(0.02, 0.0, -0.13), DVec3::Y);
        let (foot, ankle) = self.hinge("ankle", shin, DVec3::new(0.0, 0.0, -0.14), DVec3::Y);
        let (pitch, shoulder) = self.hinge(
            "shoulder",
            trunk,
            DVec3::new(0.0, 0.12 * left, 0.14),
            DVec3::NEG_Y,
        );
        // The roll axis misses the pitch centre, as in arms whose shoulder is no ball.
        let at_roll = DVec3::new(0.02, 0.0, 0.01);
        let (upper, shoulder_roll) = self.hinge("roll", pitch, at_roll, DVec3::Z * left);
        let at_elbow = DVec3::new(0.12, 0.01 * left, -0.03);
        let (yawed, yaw) = self.hinge("yaw", upper, at_elbow, DVec3::X * left);
        let (forearm, bend) = self.hinge("bend", yawed, DVec3::ZERO, DVec3::Z * left);
        let in_body = |body: BodyId, vector: DVec3, this: &Self| {
            let mut rotation = DQuat::IDENTITY;
            let mut ancestor = Some(body);
            while let Some(id) = ancestor {
                rotation = this.bodies[id.0].parent_from_body.rotation() * rotation;
                ancestor = this.bodies[id.0].parent;
            }
            rotation.inverse() * vector
        };
        SideLayout {
            toe: (
                foot,
                Point::new(in_body(foot, DVec3::new(0.09, 0.0, -0.05), self)),
            ),
            ankle,
            knee,
            hip,
            shoulder,
            shoulder_roll,
            elbow: (upper, Point::new(in_body(upper, at_elbow, self))),
            forearm: [yaw, bend],
            forearm_direction: in_body(forearm, DVec3::X, self),
        }
    }
}

/// A robot with two legs and two arms.
pub(crate) fn two_armed() -> Robot {
    let mut builder = Builder {
        bodies: vec![Body {
            name: "trunk".to_owned(),
            parent: None,
            parent_from_body: Transform::translation(DVec3::ZERO),
            joint: None,
            mass: 1.0,
            centre_of_mass: Point::ORIGIN,
            contact_group: ContactGroup::Torso,
        }],
        joints: Vec::new(),
    };
    let left = builder.side(1.0);
    let right = builder.side(-1.0);
    let mut robot = Robot {
        standing_height: None,
        name: "two-armed".to_owned(),
        bodies: builder.bodies,
        joints: builder.joints,
        shared_motors: Vec::new(),
        coupled_limits: Vec::new(),
        shapes: vec![Shape {
            name: "trunk".to_owned(),
            body: BodyId(0),
            link_from_geom: Transform::translation(DVec3::ZERO),
            solid: Solid::Sphere { radius: 0.1 },
        }],
        chain: ChainLayout {
            left,
            right,
            span: 0.55,
            projected_upper_arm: 0.11,
            published: Some(PublishedChain {
                chain: ClosedChain {
                    toe_to_ankle: 0.1,
                    ankle_to_knee: 0.14,
                    knee_to_hip: 0.13,
                    hip_to_shoulder: 0.24,
                    shoulder_to_elbow: 0.11,
                    span: 0.55,
                },
                ankle_offset: 1.0,
                shoulder_roll: 0.3,
            }),
            fixed_arm: Some(FixedArm {
                shoulder_roll: 0.3,
                forearm: [-1.5, -1.4],
            }),
        },
        postures: BTreeMap::new(),
        study: StudySetup {
            start_posture: "zero".to_owned(),
            stops: Vec::new(),
        },
        imu: None,
        control: Control {
            command_step: 0.02,
            gear_efficiency: 0.7,
            steering: SteeringGains {
                yaw: 0.8,
                lateral: 3.0,
                lateral_sum: 0.3,
                aside: 0.5,
                yaw_sum: 0.2,
                ahead: 0.3,
            },
            uphill: 0.03,
        },
        search: SearchSetup {
            least_advance: 0.1,
            upper_arm: Range {
                lower: -1.8,
                upper: -0.3,
            },
        },
        lying_length: 0.7,
    };
    let zero = JointAngles::zero(&robot);
    robot.postures.insert("zero".to_owned(), zero);
    robot
}

/// It, with a motor on each joint that may give 0.5 N·m for ever.
pub(crate) fn two_armed_with_motors() -> Robot {
    let mut robot = two_armed();
    for joint in &mut robot.joints {
        joint.motor = Some(Motor {
            ratio: 100.0,
            nominal: 0.5,
            stall: 2.5,
            no_load_speed: Some(5.0),
        });
    }
    robot
}

/// It, with joints that are named by side, as `Lknee`, and a right arm that rolls the other way round:
/// twins of a robot have axes of either sign.
pub(crate) fn two_armed_by_side() -> Robot {
    let mut robot = two_armed();
    for (index, joint) in robot.joints.iter_mut().enumerate() {
        let side = if index < 7 { "L" } else { "R" };
        joint.name = format!("{side}{}", joint.name);
        if joint.name == "Rroll" {
            joint.axis = -joint.axis;
        }
    }
    robot
}
