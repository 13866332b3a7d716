//! The simulated study against the published recordings and costs.
//!
//! The study's robot is that of the recording scene, as far as it is known. The limits are what a
//! simulation of another engine, mass and start pose can be expected to reach without being tuned (the
//! recorded curves themselves differ by a few hundredths of a newton metre between durations). Below
//! 3 s the unknown start pose decides.

use prone::regime::Regime;
use prone_files::shipped::{self, NAO, NAO_OF_THE_SCENE, RobotSource};
use prone_sim::{LoadedRobot, RobotFiles, World};
use prone_study::watch::Unwatched;
use prone_thesis::torque_study::{self, Plan, TorqueStudy};
use prone_thesis::{agreement, published, squeeze, summary};

fn robot(source: &RobotSource) -> LoadedRobot {
    LoadedRobot::load(RobotFiles::shipped(source)).unwrap()
}

fn study_of(robot: &LoadedRobot, durations_s: &[f64]) -> TorqueStudy {
    let world = World::new(robot, Regime::TORQUE_STUDY).unwrap();
    let gaits = ["nominal", "optimal"].map(|name| shipped::gait(name).unwrap().unwrap());
    let plan = Plan::new(gaits.to_vec(), durations_s).unwrap();
    torque_study::run_pulls(&world, &plan, &Unwatched).unwrap()
}

fn study(durations_s: &[f64]) -> TorqueStudy {
    study_of(&robot(&NAO_OF_THE_SCENE), durations_s)
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

/// Of the scene's robot, and of the V4, whose knee and hip are the nearer ones.
#[test]
fn reference_torques_follow_the_recordings() {
    for source in [&NAO_OF_THE_SCENE, &NAO] {
        let study = study_of(&robot(source), &[3.0, 5.0, 7.0, 10.0]);
        let agreement = agreement::of(&study.pulls, &published::torque_bins().unwrap());
        assert_eq!(
            agreement.len(),
            2 * 4 * 4,
            "two gaits, four durations, four joints"
        );
        for row in agreement {
            let (rms, correlation) = limits(&row.gait, &row.joint);
            assert!(row.rms_nm <= rms, "{}: {row:?}", source.version);
            if let Some(least) = correlation {
                assert!(
                    row.correlation.is_some_and(|value| value >= least),
                    "{}: {row:?}",
                    source.version
                );
            }
        }
    }
}

/// Sign and side of the records: minus the applied torque, right side. (Costs are even in the
/// torque, and left and right differ by up to 0.08 N·m.)
#[test]
fn regression_records_are_minus_the_right_actuators() {
    let study = study(&[5.0]);
    let row = &study.pulls[0].rows[49];
    for (ours, expected) in row
        .torque_nm
        .iter()
        .zip([0.005_99, 0.562_36, 0.829_61, -0.496_87])
    {
        assert!(
            (ours - expected).abs() < 1e-3,
            "{ours} is not {expected} N·m"
        );
    }
    // Of the optimal gait, where the sides part while the chain lifts.
    let lifting = &study.pulls[1].rows[8];
    let right = [-0.414, 0.320];
    for (ours, expected) in lifting.torque_nm.iter().zip(right) {
        assert!((ours - expected).abs() < 0.02, "{:?}", lifting.torque_nm);
    }
}

/// From 5 s on. The V4 is within the limits of an untuned simulation, 10 and 17 %. The scene's robot,
/// whose trunk has its centre of mass 25 mm lower, is dearer: up to 12.0 and 22.6 %.
#[test]
fn reference_costs_are_near_the_published_ones() {
    for (source, nominal, optimal) in [(&NAO, 0.10, 0.17), (&NAO_OF_THE_SCENE, 0.13, 0.24)] {
        let study = study_of(&robot(source), &[3.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0]);
        let summary = summary::of(&study, Vec::new(), Vec::new(), Vec::new());
        for row in summary.costs.iter().filter(|row| row.duration_s >= 5.0) {
            let limit = if row.gait == "nominal" {
                nominal
            } else {
                optimal
            };
            let version = source.version;
            assert!(
                row.relative_difference.unwrap().abs() <= limit,
                "{version}: {row:?}"
            );
        }
        for row in &summary.ratios {
            assert!(row.ours < 1.0, "the optimal gait is cheaper: {row:?}");
            if row.duration_s >= 5.0 {
                assert!((0.84..=0.92).contains(&row.ours), "{row:?}");
            }
        }
    }
}

/// While the chain carries, without the squeeze of either: ours is 9 to 10 % dearer than the published
/// nominal gait and 3 to 5 % dearer than the optimal one. As they are, the optimal gait is 31 % off at
/// 7 s.
#[test]
fn reference_rates_without_squeeze_are_near_the_published_ones() {
    let robot = robot(&NAO_OF_THE_SCENE);
    let study = study_of(&robot, &[3.0, 5.0, 7.0, 10.0]);
    let bins = published::torque_bins().unwrap();
    let squeezes = squeeze::of(robot.robot(), &study.pulls, &bins);
    assert_eq!(squeezes.len(), 8);
    for it in &squeezes {
        let theirs = it.published.unwrap();
        let apart = it.ours.rate_without_n2m2 / theirs.rate_without_n2m2 - 1.0;
        assert!(apart.abs() <= 0.11, "{it:?}");
        assert!(it.rms_with_its_squeeze_nm < it.rms_nm, "{it:?}");
    }
    for ratio in squeeze::ratios(&squeezes) {
        let apart = ratio.published_without.unwrap() - ratio.ours_without;
        // 0.04 to 0.06; with the squeeze -0.08 to -0.01.
        assert!((0.0..=0.08).contains(&apart), "{ratio:?}");
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
