//! The report card of a crawl: what a record says, over what a robot has.
//!
//! Every line is a recorded figure, or a recorded figure over another one. Nothing is simulated and
//! nothing is integrated here.

use serde::Serialize;

use super::Run;
use crate::view::record::not_simulated;
use prone_record::crawl_outcome::SelfCollisionSummary;
use prone_record::crawl_summary::{MotorSummary, ReasonSummary};

/// A joint with a smaller share of the heat is not listed by itself.
const LISTED_HEAT: f64 = 0.01;

/// The report card of one crawl.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Card {
    /// The record's folder, as it was named.
    pub run: String,
    /// The cycle.
    pub gait: String,
    /// The robot.
    pub robot: String,
    /// Where it crawled.
    pub scene: String,
    /// How it was steered: `none`, `constant`, `heading` or `heading-hold`.
    pub steering: String,
    /// Whether joints were off their calibration.
    pub joint_offset_deg: f64,
    /// Whole cycles.
    pub cycles: usize,
    /// Along the heading of the start, mm.
    pub path_mm: f64,
    /// How long it took, s.
    pub time_s: f64,
    /// Distance over time, mm/s.
    pub speed_mm_s: f64,
    /// How high the robot stands, mm, as its manufacturer says.
    pub standing_height_mm: Option<f64>,
    /// Speed over that height, 1/s.
    pub standing_heights_per_s: Option<f64>,
    /// Distance per cycle over the planned chain's stride.
    pub stride_efficiency: Option<f64>,
    /// The pull's part of that.
    pub pull_efficiency: Option<f64>,
    /// Highest point of the robot in the whole run, mm: a lower passage it does not pass.
    pub lowest_passage_mm: f64,
    /// Which part of the body that is.
    pub highest_part: &'static str,
    /// That height over the standing height.
    pub passage_over_standing: Option<f64>,
    /// Whether it came through and what it touched, in words; nothing in an earlier record.
    pub outcome: Option<String>,
    /// The widest the robot gets, mm, where that was recorded.
    pub width_mm: Option<f64>,
    /// The two of its parts that came nearest to one another, in words, where that was recorded.
    pub nearest_parts: Option<String>,
    /// How often it met a plate, its legs or a panel.
    pub plate_contacts: usize,
    /// Positive work of the motors at the joints over weight times distance.
    pub cost_of_transport_mechanical: Option<f64>,
    /// With the estimated loss of the windings.
    pub cost_of_transport_electrical_estimated: Option<f64>,
    /// What the motors of a robot could do of it: `continuous`, `limited`, `not on a robot`; nothing
    /// where the figures of a motor are not known.
    pub verdict: Option<String>,
    /// What speaks against going on for ever, or what is not known.
    pub verdict_reasons: Vec<String>,
    /// Largest mean force on the head over 20 ms, N.
    pub head_peak_n: f64,
    /// Share of the time in which the head carries weight.
    pub head_share: f64,
    /// Largest mean force on the hands over 20 ms, N.
    pub hand_peak_n: f64,
    /// ∫ Σ (τ / nominal torque)² dt over time: the mean number of motors at their continuous rating;
    /// nothing where the figures of a motor are not known.
    pub heat_per_second: Option<f64>,
    /// The same integral per metre, s/m.
    pub heat_per_metre_s: Option<f64>,
    /// Off the line per metre, mm, positive to the left.
    pub drift_mm_per_m: Option<f64>,
    /// Change of heading per metre, degrees, positive to the left.
    pub yaw_deg_per_m: Option<f64>,
    /// The joints that warm most, the warmest first.
    pub joints: Vec<JointCard>,
    /// Share of the heat of all other joints.
    pub other_joints_heat_share: f64,
    /// The contact regime of a simulation, in words.
    #[serde(skip)]
    pub(super) regime: Option<String>,
    /// Where it was recorded, if it was not simulated.
    #[serde(skip)]
    pub(super) not_simulated: Option<String>,
}

/// One motor, by the joint that it is named after. Torque is applied torque.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointCard {
    /// The manufacturer's name.
    pub joint: String,
    /// Continuous torque of the motor at the joint, N·m.
    pub nominal_nm: f64,
    /// Largest |τ|, N·m.
    pub peak_nm: f64,
    /// Root of the mean τ², N·m.
    pub rms_nm: f64,
    /// Peak over nominal.
    pub peak_over_nominal: f64,
    /// RMS over what the gear passes on of the nominal torque; 1 for ever at the rating.
    pub rms_over_nominal: f64,
    /// Share of the time in which the supply's voltage is less than what the controller asks for.
    pub voltage_clipped_share: Option<f64>,
    /// Share of the time at the current limit.
    pub saturated_share: f64,
    /// Its share of ∫ Σ (τ / nominal torque)² dt.
    pub heat_share: f64,
}

impl Card {
    /// The card of a crawl that left figures.
    pub(super) fn from_run(run: &Run) -> Option<Self> {
        let record = run.record()?;
        let summary = record.summary.as_ref()?;
        let standing = record.info.robot.standing_height_mm;
        let options = record.info.options.crawl();
        let regime = record.info.origin.regime().map(|regime| {
            format!(
                "{} (friction {}, torque limits: {}, joint stops: {})",
                regime.name, regime.friction, regime.effort_limit, regime.stops
            )
        });
        let verdict = &summary.verdict;
        let reasons = verdict.reasons.iter().map(ReasonSummary::in_words);
        let (highest_part, highest_mm) = summary.top_mm.highest_part();
        let metres = Some(summary.path_mm / 1e3).filter(|metres| *metres > 0.0);
        let straight = summary.yaw_deg.abs() < STRAIGHT_DEG;
        let (joints, other_joints_heat_share) =
            joints(&summary.joints, summary.heat_s.unwrap_or(0.0));
        Some(Self {
            run: run.folder.name.clone(),
            gait: summary.gait.clone(),
            robot: summary.robot.clone(),
            scene: summary.scene.clone(),
            steering: options
                .and_then(|options| options.steering.clone())
                .unwrap_or_else(|| "unknown".to_owned()),
            joint_offset_deg: options
                .and_then(|options| options.joint_offset_deg)
                .unwrap_or(0.0),
            cycles: summary.cycles,
            path_mm: summary.path_mm,
            time_s: summary.time_s,
            speed_mm_s: summary.mm_per_s,
            standing_height_mm: standing,
            standing_heights_per_s: standing.map(|height| summary.mm_per_s / height),
            stride_efficiency: summary.stride_efficiency,
            pull_efficiency: summary.pull_efficiency,
            lowest_passage_mm: highest_mm,
            highest_part: highest_part.name(),
            passage_over_standing: standing.map(|height| highest_mm / height),
            outcome: summary.outcome.as_ref().map(|it| it.sentence.clone()),
            width_mm: summary.width_mm,
            nearest_parts: summary
                .self_collision
                .as_ref()
                .map(SelfCollisionSummary::in_words),
            plate_contacts: summary.plate_contacts,
            cost_of_transport_mechanical: summary.cost_of_transport,
            cost_of_transport_electrical_estimated: summary.electrical_cost_of_transport,
            verdict: verdict.duty.clone(),
            verdict_reasons: reasons.chain(verdict.unknown.clone()).collect(),
            head_peak_n: summary.ground.head.peak_n,
            head_share: summary.ground.head.share_of_time,
            hand_peak_n: summary.ground.hand.peak_n,
            heat_per_second: summary.heat_per_second,
            heat_per_metre_s: summary.heat_per_metre_s,
            drift_mm_per_m: metres
                .filter(|_| straight)
                .map(|metres| summary.lateral_mm / metres),
            yaw_deg_per_m: metres.map(|metres| summary.yaw_deg / metres),
            joints,
            other_joints_heat_share,
            regime,
            not_simulated: not_simulated(&record.info.origin),
        })
    }
}

/// Up to which change of heading what lies beside the line of the start is drift, degrees.
const STRAIGHT_DEG: f64 = 20.0;

/// The warm ones, and the share of the others.
fn joints(summaries: &[MotorSummary], heat_s: f64) -> (Vec<JointCard>, f64) {
    let card = |joint: &MotorSummary| {
        let (nominal_nm, heat) = joint.nominal_nm.zip(joint.heat_s)?;
        let rms_over_nominal = joint.rms_over_nominal?;
        Some(JointCard {
            joint: joint.joint.clone(),
            nominal_nm,
            peak_nm: joint.peak_nm,
            rms_nm: joint.rms_nm,
            peak_over_nominal: joint.peak_nm / nominal_nm,
            rms_over_nominal,
            voltage_clipped_share: joint.voltage_clipped_share,
            saturated_share: joint.saturated_share,
            heat_share: if heat_s > 0.0 { heat / heat_s } else { 0.0 },
        })
    };
    let mut cards: Vec<JointCard> = summaries.iter().filter_map(card).collect();
    // Stable: equals keep the robot's order.
    cards.sort_by(|a, b| b.heat_share.total_cmp(&a.heat_share));
    let listed = cards.partition_point(|card| card.heat_share >= LISTED_HEAT);
    let others = cards.split_off(listed);
    (cards, others.iter().map(|card| card.heat_share).sum())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn joint(name: &str, nominal_nm: Option<f64>, heat_s: Option<f64>) -> MotorSummary {
        MotorSummary {
            joint: name.to_owned(),
            joints: vec![name.to_owned()],
            effort_limit_nm: 3.0,
            nominal_nm,
            peak_nm: 1.0,
            rms_nm: 0.5,
            rms_over_nominal: nominal_nm.map(|nominal| 0.5 / (0.6 * nominal)),
            demanded_peak_nm: 1.0,
            largest_lag_deg: 1.0,
            voltage_clipped_share: Some(0.0),
            saturated_share: 0.0,
            planned_speed_over_no_load: None,
            heat_s,
            heat_per_second: heat_s,
            heat_per_metre_s: heat_s,
            work_j: 0.0,
            winding_loss_j: None,
        }
    }

    #[test]
    fn joints_are_listed_by_heat_and_shares_make_one() {
        let summaries = [
            joint("cool", Some(2.0), Some(0.05)),
            joint("unknown", None, None),
            joint("warm", Some(2.0), Some(3.0)),
            joint("hot", Some(0.5), Some(6.95)),
        ];
        let (cards, others) = joints(&summaries, 10.0);
        let names: Vec<&str> = cards.iter().map(|card| card.joint.as_str()).collect();
        assert_eq!(names, ["hot", "warm"]);
        assert!((cards[0].peak_over_nominal - 2.0).abs() < 1e-12);
        let all: f64 = cards.iter().map(|card| card.heat_share).sum();
        assert!((all + others - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_robot_that_does_not_warm_has_no_shares() {
        let (cards, others) = joints(&[joint("still", Some(1.0), Some(0.0))], 0.0);
        assert!(cards.is_empty() && others.abs() < 1e-12);
    }
}
