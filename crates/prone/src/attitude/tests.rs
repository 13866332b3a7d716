use std::f64::consts::{FRAC_PI_2, PI};

use proptest::prelude::*;

use super::*;

const STEP: f64 = 0.01;

/// The attitude of a root that is turned so over the ground.
fn turned(ground_from_root: DQuat) -> Attitude {
    Attitude::from_up(ground_from_root.inverse() * DVec3::Z).unwrap()
}

/// A root that is only pitched, rad.
fn pitched(pitch: f64) -> Attitude {
    turned(DQuat::from_rotation_y(pitch))
}

/// Angle between two ups, rad.
fn between(one: Attitude, two: Attitude) -> f64 {
    let (one, two) = (one.up(), two.up());
    one.cross(two).length().atan2(one.dot(two))
}

fn still(attitude: Attitude) -> ImuReading {
    ImuReading {
        angular_velocity: DVec3::ZERO,
        specific_force: GRAVITY * attitude.up(),
    }
}

proptest! {
    #[test]
    fn identity_pitch_and_roll_are_those_of_the_root(
        pitch in -3.1..3.1_f64, roll in -1.4..1.4_f64, heading in -3.0..3.0_f64,
    ) {
        let turn = DQuat::from_rotation_z(heading)
            * DQuat::from_rotation_x(roll)
            * DQuat::from_rotation_y(pitch);
        let attitude = turned(turn);
        prop_assert!((attitude.pitch().unwrap() - pitch).abs() < 1e-12);
        prop_assert!((attitude.roll() - roll).abs() < 1e-12);
    }

    /// The floor, and the robot with it, is turned by −s about +y.
    #[test]
    fn identity_slope_is_how_far_the_floor_was_turned(
        slope in -0.6..0.6_f64, planned in -3.1..3.1_f64,
    ) {
        let turn = DQuat::from_rotation_y(-slope) * DQuat::from_rotation_y(planned);
        let uphill = DQuat::from_rotation_y(-slope) * DVec3::X;
        prop_assert!(uphill.z * slope >= 0.0, "a positive slope rises in front");
        let attitude = turned(turn);
        prop_assert!((attitude.slope(planned).unwrap() - slope).abs() < 1e-12);
    }

    /// Gyroscopes alone follow any constant turn exactly: a rotation by Ω t.
    #[test]
    fn identity_gyroscopes_follow_a_turn(x in -2.0..2.0_f64, y in -2.0..2.0_f64, z in -2.0..2.0_f64) {
        let rate = DVec3::new(x, y, z);
        let start = pitched(1.2);
        let mut filter = AttitudeFilter::new(Gains::PUBLISHED, start);
        // Falling freely, the accelerometers say nothing.
        let reading = ImuReading { angular_velocity: rate, specific_force: DVec3::ZERO };
        for _ in 0..100 {
            filter.update(&reading, STEP).unwrap();
        }
        // The root turns by Ω t, so what stands still turns back in it.
        let truth = DQuat::from_scaled_axis(-rate) * start.up();
        prop_assert!((filter.attitude().up() - truth).length() < 1e-12);
    }
}

/// Equation (4) has no part along a when û is opposite, so 180° is left out.
#[test]
fn limit_a_wrong_start_is_forgotten() {
    let truth = pitched(FRAC_PI_2);
    for wrong in [0.0, 0.5, FRAC_PI_2 + 2.9] {
        let mut filter = AttitudeFilter::new(Gains::PUBLISHED, pitched(wrong));
        let mut settled_s = 0.0;
        for step in 0..3000 {
            filter.update(&still(truth), STEP).unwrap();
            if between(filter.attitude(), truth) > 0.01 {
                settled_s = f64::from(step) * STEP;
            }
        }
        // s² + kP s + kI decays with 0.5/s; e^(−0.5 · 15 s) is 6e-4, and 2.9 rad start slowly.
        assert!(settled_s < 18.0, "from {wrong} rad in {settled_s} s");
    }
}

#[test]
fn identity_the_gyroscopes_bias_is_learned() {
    let truth = pitched(FRAC_PI_2);
    let bias = DVec3::new(0.0, 0.02, -0.015);
    let reading = ImuReading {
        angular_velocity: bias,
        ..still(truth)
    };
    let mut filter = AttitudeFilter::aligned(Gains::PUBLISHED, &reading).unwrap();
    for _ in 0..4000 {
        filter.update(&reading, STEP).unwrap();
    }
    // e^(−0.5 · 40 s) is 2e-9; up is −x, so y and z are the parts that can be seen.
    assert!((filter.gyroscope_bias - bias).length() < 1e-8);
    assert!(between(filter.attitude(), truth) < 1e-8);
}

/// Dragged gently for 90 ms, jolted back for 10 ms, as friction that sticks and slips does. The mean
/// is gravity; a filter of directions, or one that leaves out the jolts, would lean by up to
/// 1 m/s² / g = 0.10 rad. What is left is the ripple, kP · 9 m/s² / g · 10 ms = 0.009 rad.
#[test]
fn limit_drags_and_jolts_cancel() {
    let truth = pitched(FRAC_PI_2);
    let mut filter = AttitudeFilter::new(Gains::PUBLISHED, truth);
    for step in 0..3000 {
        let pushed = if step % 10 == 9 { 9.0 } else { -1.0 };
        let reading = ImuReading {
            angular_velocity: DVec3::ZERO,
            specific_force: GRAVITY * truth.up() + pushed * DVec3::Z,
        };
        filter.update(&reading, STEP).unwrap();
        let lean = between(filter.attitude(), truth);
        assert!(lean < 0.01, "{lean} rad at step {step}");
    }
}

#[test]
fn limit_no_start_is_taken_from_a_push() {
    let pushed = ImuReading {
        angular_velocity: DVec3::ZERO,
        specific_force: GRAVITY * (DVec3::X + DVec3::Z),
    };
    assert_eq!(
        AttitudeFilter::aligned(Gains::PUBLISHED, &pushed)
            .unwrap_err()
            .to_string(),
        "a specific force of 13.873 m/s² does not tell which way is up"
    );
}

#[test]
fn limit_what_is_no_number_changes_nothing() {
    let truth = pitched(1.0);
    let before = AttitudeFilter::new(Gains::PUBLISHED, truth);
    let good = still(pitched(0.9));
    let mut filter = before.clone();
    for bad in [f64::NAN, f64::INFINITY] {
        let vector = DVec3::new(0.0, bad, 1.0);
        for reading in [
            ImuReading {
                angular_velocity: vector,
                ..good
            },
            ImuReading {
                specific_force: vector,
                ..good
            },
        ] {
            let error = filter.update(&reading, STEP).unwrap_err();
            assert!(matches!(error, AttitudeError::NotFinite { .. }), "{error}");
        }
    }
    for step in [0.0, -STEP, f64::NAN, f64::INFINITY] {
        let error = filter.update(&good, step).unwrap_err();
        assert!(matches!(error, AttitudeError::TimeStep { .. }), "{error}");
    }
    assert_eq!(filter, before);
    assert!(Attitude::from_up(DVec3::ZERO).is_err());
    assert!(Attitude::from_up(DVec3::NAN).is_err());
}

#[test]
fn limit_on_its_side_a_robot_has_no_pitch() {
    let side = Attitude::from_up(DVec3::Y).unwrap();
    assert!((side.roll() - FRAC_PI_2).abs() < 1e-12);
    let error = side.slope(0.0).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the robot lies on its side (roll 90.0°) and has no pitch"
    );
}

/// Standing up is p = 0, on the belly π/2, on the back −π/2; a slope is found across ±π.
#[test]
fn limit_the_four_sagittal_attitudes() {
    for (up, pitch) in [
        (DVec3::Z, 0.0),
        (DVec3::NEG_X, FRAC_PI_2),
        (DVec3::X, -FRAC_PI_2),
        (DVec3::NEG_Z, PI),
    ] {
        let attitude = Attitude::from_up(up).unwrap();
        assert!((attitude.pitch().unwrap().abs() - f64::abs(pitch)).abs() < 1e-12);
        assert!(attitude.slope(pitch).unwrap().abs() < 1e-12);
    }
    let upside_down = pitched(-PI + 0.1);
    assert!((upside_down.slope(PI).unwrap() + 0.1).abs() < 1e-12);
}
