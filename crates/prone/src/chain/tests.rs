//! Reference values: the check values published for the NAO's chain, and identities.

use proptest::prelude::*;

use super::*;

/// The chain as published for the NAO H25 V4: toe-ankle √(45.19² + 93.5²) mm.
pub(crate) const PUBLISHED: ClosedChain = ClosedChain {
    toe_to_ankle: 0.103_847,
    ankle_to_knee: 0.1029,
    knee_to_hip: 0.1,
    hip_to_shoulder: 0.1885,
    shoulder_to_elbow: 0.08975,
    span: 0.43,
};

const KNEE: f64 = 0.287_98;
const HIP: f64 = 0.479_97;

/// α in degrees, θ1, θ2, θ5 in radians, then ankle, knee, hip, shoulder (x, z) in millimetres.
type Row = (f64, [f64; 3], [(f64, f64); 4]);

/// Published check values for θ3 = 0.28798, θ4 = 0.47997.
const CHECK: [Row; 5] = [
    (
        -30.0,
        [1.7016, -2.3038, -0.6894],
        [(-13.5, 103.0), (71.3, 44.7), (166.4, 13.8), (352.3, 44.9)],
    ),
    (
        -38.0,
        [1.6476, -2.2230, -0.8557],
        [(-8.0, 103.5), (78.4, 47.5), (174.3, 19.2), (359.3, 55.3)],
    ),
    (
        -55.0,
        [1.4809, -2.0064, -1.2023],
        [(9.3, 103.4), (98.3, 51.8), (195.5, 28.3), (378.5, 73.5)],
    ),
    (
        -72.0,
        [1.2565, -1.7374, -1.5437],
        [(32.1, 98.8), (123.3, 51.2), (221.5, 32.0), (402.3, 85.4)],
    ),
    (
        -90.0,
        [0.9592, -1.3912, -1.9068],
        [(59.6, 85.0), (153.1, 41.9), (252.0, 27.6), (430.0, 89.8)],
    ),
];

fn nominal(alpha_deg: f64) -> GaitParameters {
    GaitParameters {
        knee: KNEE,
        hip: HIP,
        upper_arm: alpha_deg.to_radians(),
    }
}

#[test]
fn reference_angles_and_joint_centres_match_the_published_table() {
    for (alpha_deg, angles, centres) in CHECK {
        let solved = PUBLISHED.close(nominal(alpha_deg)).unwrap();
        // Half of the last printed digit, and as much again for the four-digit l1.
        for (ours, theirs) in [solved.toe, solved.ankle, solved.shoulder]
            .iter()
            .zip(angles)
        {
            assert!(
                (ours - theirs).abs() < 1e-4,
                "{alpha_deg}°: {ours} vs {theirs}"
            );
        }
        let posture = PUBLISHED.posture(&solved);
        for (ours, (x, z)) in posture.points()[1..5].iter().zip(centres) {
            assert!(
                (ours.x() * 1e3 - x).abs() < 0.06,
                "{alpha_deg}°: x {} vs {x}",
                ours.x()
            );
            assert!(
                (ours.z() * 1e3 - z).abs() < 0.06,
                "{alpha_deg}°: z {} vs {z}",
                ours.z()
            );
        }
    }
}

#[test]
fn reference_shoulder_advances_77_7_mm() {
    let shoulder = |alpha_deg| {
        let solved = PUBLISHED.close(nominal(alpha_deg)).unwrap();
        PUBLISHED.posture(&solved).shoulder.x()
    };
    let stride_mm = (shoulder(-90.0) - shoulder(-30.0)) * 1e3;
    assert!((stride_mm - 77.7).abs() < 0.05, "{stride_mm}");
}

#[test]
fn reference_leg_is_above_and_forward_of_the_mirrored_root() {
    // For the NAO the right root has θ1 > 0 > θ2 over the whole published torque table
    // (θ3 −5…45°, θ4 −30…27.5°, α −90…−30°); the original's table mirrors 17 % of it.
    for knee in -1..=9 {
        for hip in -6..=5 {
            for arm in -18..=-6 {
                let parameters = GaitParameters {
                    knee: f64::from(knee * 5).to_radians(),
                    hip: f64::from(hip * 5).to_radians(),
                    upper_arm: f64::from(arm * 5).to_radians(),
                };
                let solved = PUBLISHED.close(parameters).unwrap();
                assert!(
                    solved.toe > 0.0 && solved.ankle < 0.0,
                    "{parameters:?}: {solved:?}"
                );
                assert!(PUBLISHED.posture(&solved).ankle.z() > 0.0, "{parameters:?}");
            }
        }
    }
}

#[test]
fn out_of_reach_and_nan_are_errors() {
    let stretched = ClosedChain {
        span: 0.7,
        ..PUBLISHED
    };
    let error = stretched.close(nominal(-30.0)).unwrap_err();
    assert!(matches!(error, ClosureError { cosine } if cosine > 1.0));
    let folded = GaitParameters {
        knee: 2.6,
        hip: 2.6,
        upper_arm: -1.0,
    };
    let short = ClosedChain {
        span: 0.9,
        ..PUBLISHED
    };
    assert!(short.close(folded).is_err());
    assert!(PUBLISHED.close(nominal(f64::NAN)).is_err());
}

#[test]
fn a_leg_stretched_to_its_limit_still_closes() {
    // Span so long that toe, ankle and shoulder are in line: the cosine is one.
    let parameters = GaitParameters {
        knee: 0.0,
        hip: 0.0,
        upper_arm: 0.0,
    };
    let reach: f64 = PUBLISHED.links().iter().sum();
    let straight = ClosedChain {
        span: reach,
        ..PUBLISHED
    };
    if let Ok(solved) = straight.close(parameters) {
        assert!(solved.ankle.abs() < 1e-6);
    }
    let nearly = ClosedChain {
        span: reach - 1e-6,
        ..PUBLISHED
    };
    let solved = nearly.close(parameters).unwrap();
    assert!(
        solved.ankle < 0.0 && solved.ankle > -0.1,
        "{}",
        solved.ankle
    );
}

proptest! {
    /// Built forwards: choose a posture with the leg above the toe-shoulder line, put the elbow
    /// where it lands, and ask for it back.
    #[test]
    fn closing_recovers_the_posture(
        toe in 0.5..2.0_f64,
        ankle in -2.6..-0.8_f64,
        knee in -0.1..0.8_f64,
        hip in -0.5..0.5_f64,
        drop in 0.1..1.0_f64,
    ) {
        let upright = ChainAngles { toe, ankle, knee, hip, shoulder: 0.0 };
        let shoulder = PUBLISHED.posture(&upright).shoulder;
        let ankle_centre = PUBLISHED.posture(&upright).ankle;
        let above = shoulder.x() * ankle_centre.z() - shoulder.z() * ankle_centre.x();
        prop_assume!(shoulder.z() > 1e-3 && shoulder.x() > 0.05 && above > 1e-6);
        // The arm that reaches the floor at the angle −drop·π/2.
        let upper_arm = -drop * std::f64::consts::FRAC_PI_2;
        let chain = ClosedChain {
            shoulder_to_elbow: shoulder.z() / (-upper_arm).sin(),
            ..PUBLISHED
        };
        let chain = ClosedChain {
            span: shoulder.x() + chain.shoulder_to_elbow * upper_arm.cos(),
            ..chain
        };
        let solved = chain.close(GaitParameters { knee, hip, upper_arm }).unwrap();
        prop_assert!((solved.toe - toe).abs() < 1e-6, "{} {}", solved.toe, toe);
        prop_assert!((solved.ankle - ankle).abs() < 1e-6);
        let again = solved.gait_parameters();
        prop_assert!((again.upper_arm - upper_arm).abs() < 1e-9);
    }

    /// Equations (1) to (3), on the published chain.
    #[test]
    fn closed_chains_touch_the_ground_at_the_span(
        knee in -0.08..0.78_f64, hip in -0.52..0.47_f64, upper_arm in -1.57..-0.53_f64,
    ) {
        let solved = PUBLISHED.close(GaitParameters { knee, hip, upper_arm }).unwrap();
        let elbow = PUBLISHED.posture(&solved).elbow;
        prop_assert!((elbow.x() - PUBLISHED.span).abs() < 1e-12);
        prop_assert!(elbow.z().abs() < 1e-12);
    }
}
