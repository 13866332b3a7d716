//! A robot's crawling chain, as a table: derived from the model beside what was published.

use glam::DVec3;
use serde::Serialize;

use prone::chain::ClosedChain;
use prone::frames::{Ground, Root, Transform};
use prone::mapping::{ArmMode, Mapping, MappingError, MappingVariant};
use prone::robot::{ContactGroup, JointAngles, Robot, SideLayout};

/// A robot as the crawl sees it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RobotSheet {
    /// The manufacturer's name.
    pub robot: String,
    /// Total mass, kg.
    pub mass_kg: f64,
    /// Number of bodies.
    pub bodies: usize,
    /// Number of joints.
    pub joints: usize,
    /// Number of colliding shapes.
    pub shapes: usize,
    /// The chain derived from the model: what the mapping `exact` uses.
    pub derived: ChainSheet,
    /// The chain as published: what the mapping `original` uses.
    pub published: Option<ChainSheet>,
    /// How far the front edge of the sole is ahead of the ankle, mm (the chain's toe contact is a
    /// point of its own).
    pub toe_edge_mm: f64,
    /// How far the elbow's shape reaches below its centre, mm (the chain has its elbow on the
    /// floor).
    pub elbow_radius_mm: f64,
    /// The joints of the left chain with limits and torques.
    pub drives: Vec<DriveSheet>,
    /// Postures that ask a joint for more than its limit.
    pub postures_outside: Vec<PostureOutside>,
    /// Names of all postures.
    pub postures: Vec<String>,
}

/// Lengths and offsets of a chain.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ChainSheet {
    /// l1 to l5, mm.
    pub links_mm: [f64; 5],
    /// Toe contact to elbow, mm.
    pub span_mm: f64,
    /// Ankle joint angle minus θ2, degrees.
    pub ankle_offset_deg: f64,
    /// Outward shoulder roll, degrees.
    pub shoulder_roll_deg: f64,
}

/// One joint of the chain.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DriveSheet {
    /// The manufacturer's name.
    pub joint: String,
    /// Limits, degrees.
    pub range_deg: [f64; 2],
    /// The manufacturer's effort limit, N·m.
    pub effort_nm: f64,
    /// The motor's continuous torque at the joint, N·m.
    pub nominal_nm: Option<f64>,
    /// The motor's stall torque at the joint, N·m.
    pub stall_nm: Option<f64>,
    /// The manufacturer's speed limit, rad/s.
    pub speed_rad_s: f64,
}

/// A posture's joint outside its limit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PostureOutside {
    /// Name of the posture.
    pub posture: String,
    /// The manufacturer's name of the joint.
    pub joint: String,
    /// How far outside, degrees, negative below.
    pub excess_deg: f64,
}

/// Limits are printed with four digits; less than one of them is no violation of a posture.
const POSTURE_ROUNDING: f64 = 1e-4;

/// Reads the sheet from a robot.
///
/// # Errors
/// [`MappingError`] where the limbs form no sagittal chain.
pub fn of(robot: &Robot) -> Result<RobotSheet, MappingError> {
    let sheet = |variant| {
        let mapping = Mapping::new(robot, variant, ArmMode::FlatForearm)?;
        Ok::<_, MappingError>(chain_sheet(mapping.chain(), &mapping))
    };
    let published = match robot.chain.published {
        None => None,
        Some(_) => Some(sheet(MappingVariant::Original)?),
    };
    let left = &robot.chain.left;
    Ok(RobotSheet {
        robot: robot.name.clone(),
        mass_kg: robot.mass(),
        bodies: robot.bodies.len(),
        joints: robot.joints.len(),
        shapes: robot.shapes.len(),
        derived: sheet(MappingVariant::Exact)?,
        published,
        toe_edge_mm: toe_edge(robot, left) * 1e3,
        elbow_radius_mm: elbow_radius(robot, left) * 1e3,
        drives: left.commanded_joints().map(|id| drive(robot, id)).to_vec(),
        postures_outside: postures_outside(robot),
        postures: robot.postures.keys().cloned().collect(),
    })
}

fn chain_sheet(chain: &ClosedChain, mapping: &Mapping) -> ChainSheet {
    ChainSheet {
        links_mm: chain.links().map(|metres| metres * 1e3),
        span_mm: chain.span * 1e3,
        ankle_offset_deg: mapping.ankle_offset().to_degrees(),
        shoulder_roll_deg: mapping.shoulder_roll().to_degrees(),
    }
}

fn drive(robot: &Robot, id: prone::robot::JointId) -> DriveSheet {
    let joint = &robot.joints[id.0];
    DriveSheet {
        joint: joint.name.clone(),
        range_deg: [joint.range.lower, joint.range.upper].map(f64::to_degrees),
        effort_nm: joint.effort_limit,
        nominal_nm: joint.motor.map(|motor| motor.nominal),
        stall_nm: joint.motor.map(|motor| motor.stall),
        speed_rad_s: joint.speed_limit,
    }
}

fn standing(robot: &Robot) -> prone::robot::BodyPoses<Ground> {
    robot.forward_kinematics(
        Transform::<Ground, Root>::translation(DVec3::ZERO),
        &JointAngles::zero(robot),
    )
}

/// Farthest reach of the toe body's shapes ahead of the ankle, m, standing.
fn toe_edge(robot: &Robot, side: &SideLayout) -> f64 {
    let poses = standing(robot);
    let ankle = &robot.joints[side.ankle.0];
    let ankle_x = poses.point((ankle.body, ankle.anchor)).x();
    let reach = robot
        .shapes
        .iter()
        .filter(|shape| shape.body == side.toe.0)
        .map(|shape| shape.reach_along(poses.of(shape.body), DVec3::X));
    reach.fold(f64::NEG_INFINITY, f64::max) - ankle_x
}

/// How far the arm shape nearest to the elbow reaches below the elbow, m, standing.
fn elbow_radius(robot: &Robot, side: &SideLayout) -> f64 {
    let poses = standing(robot);
    let elbow = poses.point(side.elbow).metres();
    let arms = robot
        .shapes
        .iter()
        .filter(|shape| robot.bodies[shape.body.0].contact_group == ContactGroup::Elbow);
    let nearest = arms.min_by(|a, b| {
        let apart = |shape: &prone::robot::Shape| {
            let centre = *poses.of(shape.body) * shape.link_from_geom.origin();
            (centre.metres() - elbow).length()
        };
        apart(a).total_cmp(&apart(b))
    });
    nearest.map_or(f64::NAN, |shape| {
        shape.reach_along(poses.of(shape.body), DVec3::NEG_Z) + elbow.z
    })
}

fn postures_outside(robot: &Robot) -> Vec<PostureOutside> {
    let mut outside = Vec::new();
    for (posture, angles) in &robot.postures {
        for (joint, &angle) in robot.joints.iter().zip(angles.as_slice()) {
            let excess = joint.range.excess(angle);
            if excess.abs() > POSTURE_ROUNDING {
                outside.push(PostureOutside {
                    posture: posture.clone(),
                    joint: joint.name.clone(),
                    excess_deg: excess.to_degrees(),
                });
            }
        }
    }
    outside
}
