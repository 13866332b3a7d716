//! A gait on one robot, as a table: chain, joints, limits, heights. No physics.

use glam::{DQuat, DVec3};
use serde::Serialize;

use prone::chain::ChainAngles;
use prone::frames::{Ground, Root, Transform};
use prone::gait::{CheckedTrajectory, Gait, PhaseDuration, Sample, TrajectoryError};
use prone::mapping::Mapping;
use prone::robot::{BodyPoses, JointAngles, JointId, Robot, Shape};
use prone_record::crawl_summary::SheetClamp;
use prone_record::tables;

/// Samples of a sheet: 1 % of the phase apart.
const INTERVALS: usize = 100;

/// A planned gait.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GaitSheet {
    /// Name of the gait.
    pub gait: String,
    /// One sentence on where it comes from.
    pub description: String,
    /// Name of the robot.
    pub robot: String,
    /// `exact` or `original`.
    pub mapping: &'static str,
    /// `flat-forearm` or `fixed`.
    pub arm: &'static str,
    /// Duration of the phase, s.
    pub duration_s: f64,
    /// Names of the commanded joints, left then right.
    pub joints: Vec<String>,
    /// The instants.
    pub rows: Vec<SheetRow>,
    /// What was clamped.
    pub clamps: Vec<SheetClamp>,
    /// The ankle's highest point (joint centre), mm.
    pub ankle_peak_mm: f64,
    /// Advance of the shoulder, mm.
    pub stride_mm: f64,
    /// Highest point of any shape over the phase, mm, with toe and elbow on the chain.
    pub top_mm: f64,
    /// Lowest point of trunk, head and legs over the phase, mm; below zero the real body rests on
    /// the floor there and cannot hold the planned chain.
    pub body_bottom_mm: f64,
    /// Largest speed asked of any joint, and of which, rad/s.
    pub fastest: (String, f64),
}

/// One instant of a gait.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SheetRow {
    /// Phase, percent.
    pub cycle_percent: f64,
    /// Time, s.
    pub time_s: f64,
    /// θ1 to θ5 and α, rad.
    pub chain_rad: [f64; 6],
    /// Joint angles in the order of [`GaitSheet::joints`], rad.
    pub joints_rad: Vec<f64>,
    /// Heights of ankle, knee, hip and shoulder centres, mm.
    pub centres_mm: [f64; 4],
    /// Highest point of any shape, mm.
    pub top_mm: f64,
    /// Lowest point of trunk, head and legs, mm.
    pub body_bottom_mm: f64,
}

/// Plans a gait within the manufacturer's limits.
pub fn of(
    robot: &Robot,
    gait: &Gait,
    duration: PhaseDuration,
) -> Result<GaitSheet, TrajectoryError> {
    let trajectory = CheckedTrajectory::plan(robot, &robot.stops(), gait, duration, INTERVALS)?;
    let mapping = Mapping::new(robot, gait.mapping, gait.arm)?;
    let ids: Vec<JointId> = robot
        .chain
        .sides()
        .iter()
        .flat_map(|side| side.commanded_joints())
        .collect();
    let rows: Vec<SheetRow> = trajectory
        .samples()
        .iter()
        .map(|sample| row(robot, &mapping, sample, duration, &ids))
        .collect();
    let highest =
        |value: fn(&SheetRow) -> f64| rows.iter().map(value).fold(f64::NEG_INFINITY, f64::max);
    let shoulder_x = |sample: Option<&Sample>| {
        sample.map_or(f64::NAN, |sample| sample.posture.shoulder.x() * 1e3)
    };
    let samples = trajectory.samples();
    let clamps = trajectory.clamps().iter();
    Ok(GaitSheet {
        gait: gait.name.clone(),
        description: gait.description.clone(),
        robot: robot.name.clone(),
        mapping: gait.mapping.name(),
        arm: gait.arm.name(),
        duration_s: duration.seconds(),
        joints: ids
            .iter()
            .map(|id| robot.joints[id.0].name.clone())
            .collect(),
        clamps: clamps
            .map(|clamp| SheetClamp::from_clamp(robot, clamp))
            .collect(),
        ankle_peak_mm: highest(|row| row.centres_mm[0]),
        stride_mm: shoulder_x(samples.last()) - shoulder_x(samples.first()),
        top_mm: highest(|row| row.top_mm),
        body_bottom_mm: -highest(|row| -row.body_bottom_mm),
        fastest: fastest(robot, &ids, &rows),
        rows,
    })
}

fn row(
    robot: &Robot,
    mapping: &Mapping,
    sample: &Sample,
    duration: PhaseDuration,
    ids: &[JointId],
) -> SheetRow {
    let chain = &sample.chain;
    let poses = planned_poses(robot, mapping, chain, &sample.joints);
    let posture = &sample.posture;
    SheetRow {
        cycle_percent: sample.s * 100.0,
        time_s: sample.s * duration.seconds(),
        chain_rad: [
            chain.toe,
            chain.ankle,
            chain.knee,
            chain.hip,
            chain.shoulder,
            chain.gait_parameters().upper_arm,
        ],
        joints_rad: ids.iter().map(|&id| sample.joints[id]).collect(),
        centres_mm: [posture.ankle, posture.knee, posture.hip, posture.shoulder]
            .map(|centre| centre.z() * 1e3),
        top_mm: robot.top(&poses, |_| true) * 1e3,
        body_bottom_mm: body_bottom(robot, &poses) * 1e3,
    }
}

/// Where the bodies are in a planned posture: the root is pitched as the chain says and lowered
/// until the toe contact is on the floor.
pub(crate) fn planned_poses(
    robot: &Robot,
    mapping: &Mapping,
    chain: &ChainAngles,
    joints: &JointAngles,
) -> BodyPoses<Ground> {
    let turn = DQuat::from_rotation_y(mapping.root_pitch(chain));
    let hanging = Transform::<Ground, Root>::new(turn, DVec3::ZERO);
    let toe = robot
        .forward_kinematics(hanging, joints)
        .point(robot.chain.left.toe);
    let standing = Transform::<Ground, Root>::new(turn, DVec3::new(-toe.x(), 0.0, -toe.z()));
    robot.forward_kinematics(standing, joints)
}

/// Lowest point of what toes and elbows are to keep off the floor, trunk, head and legs, m.
pub(crate) fn body_bottom(robot: &Robot, poses: &BodyPoses<Ground>) -> f64 {
    robot.bottom(poses, |shape: &Shape| {
        robot.bodies[shape.body.0].contact_group.is_body()
    })
}

fn fastest(robot: &Robot, ids: &[JointId], rows: &[SheetRow]) -> (String, f64) {
    let mut fastest = (String::new(), 0.0);
    for pair in rows.windows(2) {
        let step = pair[1].time_s - pair[0].time_s;
        for (index, id) in ids.iter().enumerate() {
            let speed = (pair[1].joints_rad[index] - pair[0].joints_rad[index]).abs() / step;
            if speed > fastest.1 {
                fastest = (robot.joints[id.0].name.clone(), speed);
            }
        }
    }
    fastest
}

impl GaitSheet {
    /// The instants as CSV.
    pub fn csv(&self) -> Result<Vec<u8>, csv::Error> {
        let mut header = vec!["cycle_percent".to_owned(), "time_s".to_owned()];
        let angles = ["theta1", "theta2", "theta3", "theta4", "theta5", "alpha"];
        header.extend(angles.map(|angle| format!("{angle}_rad")));
        header.extend(self.joints.iter().map(|joint| format!("{joint}_rad")));
        header.extend(["ankle", "knee", "hip", "shoulder"].map(|centre| format!("{centre}_z_mm")));
        header.extend(["top_mm", "body_bottom_mm"].map(String::from));
        let rows = self.rows.iter().map(|row| {
            let mut cells = vec![
                format!("{:.1}", row.cycle_percent),
                format!("{:.4}", row.time_s),
            ];
            let radians = row.chain_rad.iter().chain(&row.joints_rad);
            cells.extend(radians.map(|angle| format!("{angle:.6}")));
            cells.extend(row.centres_mm.map(|height| format!("{height:.3}")));
            cells.extend([row.top_mm, row.body_bottom_mm].map(|height| format!("{height:.3}")));
            cells
        });
        tables::file(header, rows)
    }
}
