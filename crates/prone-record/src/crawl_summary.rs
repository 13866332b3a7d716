//! A crawl in figures: `summary.json`.

use serde::{Deserialize, Serialize};

use prone::gait::Clamp;
use prone::robot::{BodyPart, Robot, Tops};

pub use crate::crawl_outcome::PlateContact;
use crate::crawl_outcome::{OutcomeSummary, SelfCollisionSummary};

/// What came out of a crawl.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CrawlSummary {
    /// The cycle's name.
    pub gait: String,
    /// The robot's name.
    pub robot: String,
    /// The scene's name.
    pub scene: String,
    /// How many cycles were crawled.
    pub cycles: usize,
    /// Whether it came through and what it touched; nothing in a record of an earlier version.
    pub outcome: Option<OutcomeSummary>,
    /// Whether it got past the obstacles, where that was asked for.
    pub arrived: Option<bool>,
    /// Displacement of the root along the heading of the start, mm.
    pub distance_mm: f64,
    /// How far it came along its own heading: sum of the cycles' advances, mm. Where it turns, that
    /// is more than the distance.
    pub path_mm: f64,
    /// How long it took, settling apart, s.
    pub time_s: f64,
    /// Path over cycles, mm.
    pub mm_per_cycle: f64,
    /// What of that the pulls made, mm: mean of the cycles' own advances.
    pub pull_mm_per_cycle: f64,
    /// What the recoveries made, mm.
    pub recovery_mm_per_cycle: f64,
    /// Path over time, mm/s.
    pub mm_per_s: f64,
    /// Displacement to the left of the line of the start, mm.
    pub lateral_mm: f64,
    /// Change of heading, degrees, positive to the left.
    pub yaw_deg: f64,
    /// How often a part of the robot met a plate, its legs or a panel.
    pub plate_contacts: usize,
    /// The same by part of the robot and obstacle.
    pub contacts: Vec<PlateContact>,
    /// Highest points above the floor, mm.
    pub top_mm: TopsMm,
    /// The widest the robot gets: its largest extents to the left and to the right of the line through
    /// its root along its own heading, together, mm; nothing where that was not recorded.
    pub width_mm: Option<f64>,
    /// The two of its parts that came nearest to one another, neighbours apart; nothing where that was
    /// not recorded, or of a robot with no two parts to compare.
    pub self_collision: Option<SelfCollisionSummary>,
    /// Advance of the shoulder in the planned closed chain, mm; nothing of a cycle without a pull.
    pub stride_mm: Option<f64>,
    /// Advance of a pull over that stride; nothing where the plan does not lead forward.
    pub pull_efficiency: Option<f64>,
    /// Advance per cycle over that stride: above 1 where recoveries advance too; nothing where the
    /// plan does not lead forward.
    pub stride_efficiency: Option<f64>,
    /// Share of the ground's force on trunk, head and legs during pulls, mean of the cycles.
    pub pull_body_share: f64,
    /// The same during recoveries.
    pub recovery_body_share: f64,
    /// What the ground carried.
    pub ground: GroundSummary,
    /// Whether the motors of a robot could do it.
    pub verdict: VerdictSummary,
    /// Largest applied torque over the manufacturer's effort limit.
    pub peak_torque_over_rated: f64,
    /// Joint in which `peak_torque_over_rated` was reached.
    pub peak_torque_joint: String,
    /// Largest torque that the position error of a shoulder's pitch asks for before any limit, N·m:
    /// stiffness times lag.
    pub demanded_peak_shoulder_nm: f64,
    /// Share of the time in which the motor of a shoulder's pitch is at its current limit, of the
    /// side where it is larger.
    pub saturated_shoulder_share: f64,
    /// Share of the time in which a motor is at its current limit, of the one where it is largest.
    pub saturated_share: f64,
    /// Joint of that motor, if any was ever at its limit.
    pub saturated_joint: Option<String>,
    /// ∫ Σ (τ / nominal torque)² dt, s; nothing where the figures of a motor are not known.
    pub heat_s: Option<f64>,
    /// Heat per metre of path, s/m; `None` if the crawl made no progress.
    pub heat_per_metre_s: Option<f64>,
    /// Heat per second: what the motors feel.
    pub heat_per_second: Option<f64>,
    /// Positive mechanical work of the motors, J.
    pub work_j: f64,
    /// Positive work of the motors over weight times path; `None` if the crawl made no progress.
    pub cost_of_transport: Option<f64>,
    /// What the windings of the motors lost, J: an estimate; nothing where a motor is not known.
    pub winding_loss_j: Option<f64>,
    /// Work and winding loss over weight times path: an estimate, in which gears lose nothing
    /// and what is braked is not given back.
    pub electrical_cost_of_transport: Option<f64>,
    /// What each motor did.
    pub joints: Vec<MotorSummary>,
    /// Joints stopped at their limits in the plan without a turn.
    pub clamps: Vec<SheetClamp>,
    /// Joints whose calibration error led commands past their limits, where they were stopped.
    #[serde(default)]
    pub calibration_stops: Vec<CalibrationStop>,
    /// One entry per cycle.
    pub per_cycle: Vec<CycleSummary>,
}

/// A joint whose calibration error led commands past its limit, where it was stopped.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CalibrationStop {
    /// Name of the joint.
    pub joint: String,
    /// How many commands, those that held the start posture included.
    pub commands: usize,
    /// Largest amount cut off, degrees, negative at the lower limit.
    pub largest_deg: f64,
}

/// Highest points by part of the body, mm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TopsMm {
    /// Neck and head.
    pub head: f64,
    /// Trunk and pelvis.
    pub trunk: f64,
    /// Shoulders to hands.
    pub arms: f64,
    /// Thighs and shins.
    pub legs: f64,
    /// From the ankles on.
    pub feet: f64,
}

/// One cycle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CycleSummary {
    /// From 1.
    pub cycle: usize,
    /// The turn command of its pull, degrees.
    pub turn_command_deg: f64,
    /// The shift command of its waypoints, degrees.
    #[serde(default)]
    pub shift_command_deg: f64,
    /// When it began, s.
    pub begin_s: f64,
    /// How long it lasted, s.
    pub time_s: f64,
    /// Along the heading with which it began, mm.
    pub advance_mm: f64,
    /// What of that the pull made, mm.
    pub pull_advance_mm: f64,
    /// To the left of that, mm.
    pub left_mm: f64,
    /// Change of heading, degrees.
    pub yaw_deg: f64,
    /// Where it ended along the heading of the start, mm.
    pub x_mm: f64,
    /// Where it ended to the left of the line of the start, mm.
    pub y_mm: f64,
    /// Highest points.
    pub top_mm: TopsMm,
    /// ∫ Σ (τ / nominal torque)² dt, s; nothing where the figures of a motor are not known.
    pub heat_s: Option<f64>,
    /// Positive mechanical work, J.
    pub work_j: f64,
    /// Share of the ground's force on trunk, head and legs during the pull.
    pub body_share: f64,
    /// The same during the recovery.
    pub recovery_body_share: f64,
    /// What the ground carried.
    pub ground: GroundSummary,
    /// Whether the motors of a robot could go on doing it.
    pub verdict: VerdictSummary,
    /// What each motor did.
    pub joints: Vec<MotorSummary>,
}

/// What the ground carried over a time, by groups of bodies.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct GroundSummary {
    /// Feet.
    pub toe: GroupLoad,
    /// Arms to the forearms.
    pub elbow: GroupLoad,
    /// Trunk and pelvis.
    pub torso: GroupLoad,
    /// Thighs and shins.
    pub leg: GroupLoad,
    /// Neck and head.
    pub head: GroupLoad,
    /// Hands.
    pub hand: GroupLoad,
}

/// What the ground carried of a group of bodies, both sides together.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct GroupLoad {
    /// Mean normal force, N.
    pub mean_n: f64,
    /// Largest mean over 20 ms, N.
    pub peak_n: f64,
    /// Share of the time in which that mean was 1 N or more.
    pub share_of_time: f64,
}

/// Whether the motors of a robot could do it, and for how long ([`prone::motor::Verdict`]).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VerdictSummary {
    /// `continuous`, `limited`, `not on a robot`; nothing where the figures of a motor are not known.
    pub duty: Option<String>,
    /// What is beyond what can go on for ever, the worst motor of each measure.
    pub reasons: Vec<ReasonSummary>,
    /// Why there is no verdict, where there is none.
    pub unknown: Option<String>,
    /// Efficiency of the gears that it supposes.
    pub gear_efficiency: f64,
}

/// A measure that is beyond what can go on for ever.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReasonSummary {
    /// What it is, in words.
    pub measure: String,
    /// Joint of the motor; nothing where it is no motor's.
    pub joint: Option<String>,
    /// Its value.
    pub value: f64,
    /// Up to which value it can go on for ever.
    pub continuous: f64,
    /// Up to which value it can go on for minutes.
    pub limited: f64,
}

impl ReasonSummary {
    /// As a sentence without its end.
    pub fn in_words(&self) -> String {
        let Self {
            measure,
            joint,
            value,
            continuous,
            limited: _,
        } = self;
        let joint = joint.as_deref().map(|joint| format!(" ({joint})"));
        let joint = joint.unwrap_or_default();
        format!("{measure} {value:.3}{joint}, more than {continuous}")
    }
}

/// One motor over a time. Torque τ is **applied torque**; of a motor that turns several joints, their
/// sum. What is over nominal torque or no-load speed is nothing where these are not known.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MotorSummary {
    /// The joint that the motor is named after.
    pub joint: String,
    /// All joints that it turns.
    pub joints: Vec<String>,
    /// The manufacturer's effort limit, N·m.
    pub effort_limit_nm: f64,
    /// Continuous torque of the motor at the joint, before gear losses, N·m, where it is known.
    pub nominal_nm: Option<f64>,
    /// Largest |τ|, N·m.
    pub peak_nm: f64,
    /// √(∫ τ² dt / time), N·m.
    pub rms_nm: f64,
    /// The same over what the gear passes on of the nominal torque.
    pub rms_over_nominal: Option<f64>,
    /// Largest torque that the position error asks for before any limit, N·m.
    pub demanded_peak_nm: f64,
    /// Largest position error that its controller went by, degrees; of several joints, their mean's.
    pub largest_lag_deg: f64,
    /// Share of the time in which commands move where the supply's voltage is less than what the
    /// controller asks for.
    pub voltage_clipped_share: Option<f64>,
    /// Share of that time at the current limit.
    pub saturated_share: f64,
    /// Largest commanded speed over the no-load speed.
    pub planned_speed_over_no_load: Option<f64>,
    /// ∫ (τ / nominal torque)² dt, s.
    pub heat_s: Option<f64>,
    /// The same per second.
    pub heat_per_second: Option<f64>,
    /// The same per metre of path, s/m; nothing without progress.
    pub heat_per_metre_s: Option<f64>,
    /// ∫ max(power, 0) dt, J.
    pub work_j: f64,
    /// What the winding lost, J ([`prone::robot::Motor::winding_loss`]): an estimate.
    pub winding_loss_j: Option<f64>,
}

/// A joint stopped at its limit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SheetClamp {
    /// The manufacturer's name of the joint.
    pub joint: String,
    /// In how many of the samples.
    pub samples: usize,
    /// First of them, percent of the phase.
    pub from_percent: f64,
    /// Last of them, percent of the phase.
    pub to_percent: f64,
    /// Largest amount cut off, degrees, negative at the lower limit.
    pub largest_deg: f64,
}

impl SheetClamp {
    /// A clamp of a plan for a robot.
    pub fn from_clamp(robot: &Robot, clamp: &Clamp) -> Self {
        Self {
            joint: robot.joints[clamp.joint.0].name.clone(),
            samples: clamp.samples,
            from_percent: clamp.from * 100.0,
            to_percent: clamp.to * 100.0,
            largest_deg: clamp.largest.to_degrees(),
        }
    }
}

impl TopsMm {
    /// The same heights in mm.
    pub fn from_metres(tops: &Tops) -> Self {
        let [head, trunk, arms, legs, feet] = tops.0.map(|metres| metres * 1e3);
        Self {
            head,
            trunk,
            arms,
            legs,
            feet,
        }
    }

    /// In the order of [`BodyPart::ALL`].
    pub const fn to_array(self) -> [f64; 5] {
        [self.head, self.trunk, self.arms, self.legs, self.feet]
    }

    /// Of all parts.
    pub fn highest(self) -> f64 {
        self.to_array()
            .into_iter()
            .fold(f64::NEG_INFINITY, f64::max)
    }

    /// The part that reaches highest, and how high, mm.
    pub fn highest_part(self) -> (BodyPart, f64) {
        let parts = BodyPart::ALL.into_iter().zip(self.to_array());
        parts
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap_or((BodyPart::Trunk, f64::NEG_INFINITY))
    }
}
