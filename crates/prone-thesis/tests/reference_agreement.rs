//! The simulated study against the published recordings and costs.
//!
//! The limits are what a simulation of another engine, mass and start pose can be expected to
//! reach without being tuned (the recorded curves themselves differ by a few hundredths of a
//! newton metre between durations). Below 3 s the unknown start pose decides.

use prone::regime::Regime;
use prone_files::shipped;
use prone_sim::{LoadedRobot, RobotFiles, World};
use prone_study::watch::Unwatched;
use prone_thesis::torque_study::{self, Plan, TorqueStudy};
use prone_thesis::{agreement, published, summary};

fn study(durations_s: &[f64]) -> TorqueStudy {
    let robot = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
    let world = World::new(&robot, Regime::TORQUE_STUDY).unwrap();
    let gaits = ["nominal", "optimal"].map(|name| shipped::gait(name).unwrap().unwrap());
    let plan = Plan::new(gaits.to_vec(), durations_s).unwrap();
    torque_study::run(&world, &plan, &Unwatched).unwrap()
}

/// Largest RMS, N·m, and smallest correlation, where one is asked for.
fn limits(gait: &str, joint: &str) -> (f64, Option<f64>) {
    match (gait, joint) {
        (_, "ankle" | "knee") => (0.15, Some(0.90)),
        ("nominal", "hip") => (0.30, Some(0.90)),
        // The optimal gait's hip torque hardly varies, so that its correlation says nothing.
        (_, "hip") => (0.12, None),
        _ => (0.20, Some(0.80)),
    }
}

#[test]
fn reference_torques_follow_the_recordings() {
    let study = study(&[3.0, 5.0, 7.0, 10.0]);
    let agreement = agreement::of(&study.pulls, &published::torque_bins().unwrap());
    assert_eq!(
        agreement.len(),
        2 * 4 * 4,
        "two gaits, four durations, four joints"
    );
    for row in agreement {
        let (rms, correlation) = limits(&row.gait, &row.joint);
        assert!(row.rms_nm <= rms, "{row:?}");
        if let Some(least) = correlation {
            assert!(
                row.correlation.is_some_and(|value| value >= least),
                "{row:?}"
            );
        }
    }
}

/// Sign and side of the records: minus the actuator torque, right side. (Costs are even in the
/// torque, and left and right differ by up to 0.08 N·m.)
#[test]
fn regression_records_are_minus_the_right_actuators() {
    let study = study(&[5.0]);
    let row = &study.pulls[0].rows[49];
    for (ours, expected) in row
        .torque_nm
        .iter()
        .zip([0.009_65, 0.538_11, 0.769_95, -0.479_62])
    {
        assert!(
            (ours - expected).abs() < 1e-3,
            "{ours} is not {expected} N·m"
        );
    }
    // Of the optimal gait, where the sides part while the chain lifts.
    let lifting = &study.pulls[1].rows[8];
    let right = [-0.409, 0.317];
    for (ours, expected) in lifting.torque_nm.iter().zip(right) {
        assert!((ours - expected).abs() < 0.02, "{:?}", lifting.torque_nm);
    }
}

#[test]
fn reference_costs_are_near_the_published_ones() {
    let study = study(&[3.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0]);
    let summary = summary::of(&study, Vec::new(), Vec::new(), Vec::new());
    for row in summary.costs.iter().filter(|row| row.duration_s >= 5.0) {
        let limit = if row.gait == "nominal" { 0.10 } else { 0.17 };
        assert!(row.relative_difference.unwrap().abs() <= limit, "{row:?}");
    }
    for row in &summary.ratios {
        assert!(row.ours < 1.0, "the optimal gait is cheaper: {row:?}");
        if row.duration_s >= 5.0 {
            assert!((0.84..=0.92).contains(&row.ours), "{row:?}");
        }
    }
}

#[test]
fn reference_planned_chain_of_the_nominal_gait() {
    let summary = summary::of(&study(&[1.0]), Vec::new(), Vec::new(), Vec::new());
    let peak = summary
        .ankle_peak
        .iter()
        .find(|peak| peak.gait == "nominal")
        .unwrap();
    assert!((103.0..=104.0).contains(&peak.height_mm), "{peak:?}");
    let (_, stride) = summary
        .stride
        .chain_mm
        .iter()
        .find(|(gait, _)| gait == "nominal")
        .unwrap();
    assert!((stride - 77.7).abs() < 0.05, "{stride} mm");
}
