use super::*;
use crate::torque_map::TorqueGap;

/// The chain of the NAO that Bell 2015 prints (master's thesis, NYU Polytechnic; IROS 2015,
/// doi 10.1109/IROS.2015.7354220).
const NAO: ClosedChain = ClosedChain {
    toe_to_ankle: 0.10385,
    ankle_to_knee: 0.1029,
    knee_to_hip: 0.1,
    hip_to_shoulder: 0.1885,
    shoulder_to_elbow: 0.08975,
    span: 0.430,
};

/// The same torques everywhere.
struct Constant([f64; 4]);

impl TorqueSource for Constant {
    fn torques(&self, _: GaitParameters) -> Result<JointTorques, TorqueGap> {
        Ok(JointTorques::from_array(self.0))
    }
}

fn nominal() -> Vec<GaitParameters> {
    (0..=100)
        .map(|k| GaitParameters {
            knee: 0.28798,
            hip: 0.47997,
            upper_arm: (-30.0 - 0.6 * f64::from(k)).to_radians(),
        })
        .collect()
}

fn broken(samples: &[GaitParameters], clearance: f64, rate: f64) -> Violations {
    let rules = Rules {
        clearance,
        height: |angles: &ChainAngles| NAO.posture(angles).hip.z(),
        rate,
    };
    let phase = Phase {
        samples,
        interval: 0.01,
    };
    violations(&NAO, phase, &rules)
}

const SQUARES: Norm = Norm::SquaredTorque { weights: [1.0; 4] };

#[test]
fn identity_norms_of_constant_torques() {
    assert!(broken(&nominal(), 0.001, f64::INFINITY).total() == 0.0);
    let samples = nominal();
    let phase = Phase {
        samples: &samples,
        interval: 0.01,
    };
    let source = Constant([1.0, -2.0, 0.5, 0.0]);
    let rated = [1.0, 4.0, 1.0, 1.0];
    for (norm, expected) in [
        (SQUARES, 5.25),
        (Norm::Peak { rated }, 1.0),
        (Norm::Heat { nominal: [2.0; 4] }, 1.3125),
    ] {
        let (torque, gaps) = torque_part(phase, &source, &norm);
        assert!((torque - expected).abs() < 1e-12 && gaps == 0, "{norm:?}");
    }
}

/// Every sample of the nominal gait has its hip below 40 mm (14 to 32 mm by the
/// chain of Bell 2015).
#[test]
fn reference_the_nominal_hip_is_below_40_mm_throughout() {
    let violations = broken(&nominal(), 0.040, f64::INFINITY);
    let broken: Vec<_> = violations.iter().collect();
    assert!(
        matches!(broken[..], [(Rule::Clearance, excess)] if excess.count == 101
        && (excess.worst - (40.0 - 13.77) / 40.0).abs() < 1e-3),
        "{broken:?}"
    );
}

#[test]
fn limit_fast_joints_and_open_chains_are_graded() {
    let slow = broken(&nominal(), 0.001, 2.0);
    let slower = broken(&nominal(), 0.001, 1.0);
    assert!(slower.total() > slow.total() && slow.total() >= 0.0);

    // A chain folded at the hip does not reach the elbow; what it lacks is the cosine's excess.
    let mut samples = nominal();
    samples[50].hip = -3.0;
    let open = broken(&samples, 0.001, f64::INFINITY);
    let Err(ClosureError { cosine }) = NAO.close(samples[50]) else {
        panic!("the folded chain closes");
    };
    let excess = cosine.abs() - 1.0;
    let only = Excess {
        count: 1,
        sum: excess,
        worst: excess,
    };
    assert!(open.iter().eq([(Rule::Closure, only)]), "{open:?}");

    samples[51].knee = f64::NAN;
    let nan = broken(&samples, 0.001, f64::INFINITY);
    assert!(
        nan.total() > open.total() && nan.total().is_finite(),
        "{nan:?}"
    );
}

#[test]
fn joint_limits_are_graded_by_the_range_that_is_passed() {
    let stops = [
        Range {
            lower: -1.0,
            upper: 1.0,
        },
        Range {
            lower: 0.0,
            upper: 0.5,
        },
    ];
    let mut violations = Violations::default();
    violations.add_limits(&[0.9, 0.5], &stops);
    assert!(violations.total() == 0.0);
    violations.add_limits(&[-1.5, 0.6], &stops);
    let (rule, excess) = violations.iter().next().unwrap();
    assert_eq!((rule.name(), excess.count), ("limits", 2));
    // 0.5 of 2 rad, and 0.1 of 0.5 rad.
    assert!((excess.sum - 0.45).abs() < 1e-12 && (excess.worst - 0.25).abs() < 1e-12);
}

#[test]
fn an_angle_that_is_no_number_is_outside() {
    let mut violations = Violations::default();
    violations.add_limits(
        &[f64::NAN],
        &[Range {
            lower: -1.0,
            upper: 1.0,
        }],
    );
    assert!(violations.total() > 1e3);
}

/// A sum over the other samples would look like the cost of a cheaper gait.
#[test]
fn torque_that_is_not_known_somewhere_is_not_known() {
    struct Chain;
    impl TorqueSource for Chain {
        fn torques(&self, at: GaitParameters) -> Result<JointTorques, TorqueGap> {
            NAO.close(at).map_err(TorqueGap::Closure)?;
            Ok(JointTorques::from_array([1.0; 4]))
        }
    }

    let mut samples = nominal();
    samples[50].hip = -3.0;
    let phase = Phase {
        samples: &samples,
        interval: 0.01,
    };
    let (torque, gaps) = torque_part(phase, &Chain, &SQUARES);
    // The chain that does not close is a violation of its own.
    assert!(torque.is_nan() && gaps == 0);
}
