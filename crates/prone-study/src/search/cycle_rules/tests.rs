use prone::gait::cycle::TimeScale;
use prone::motor::{Reason, Verdict};
use prone::regime::Regime;
use prone::robot::BodyPart;

use super::*;
use prone_record::frontier::SettingKind;

/// Limits that differ from one another.
const RULES: CycleRules = CycleRules {
    ceiling: 0.2,
    advance: 0.1,
    body_share: 0.3,
    seconds: 4.0,
    demanded_shoulder: 2.0,
    head: 1.5,
    heat: 50.0,
    drift: 0.05,
    verdict: Duty::Continuous,
    least_speed: 0.0,
    most_duty: 0.8,
};

/// The robot's own servos.
const OWN: MotorServo = MotorServo::ROBOT;

/// The first setting's advance, m.
const FIRST: f64 = 0.16;

/// The next number above a positive one, and the next one below it.
fn next(limit: f64) -> (f64, f64) {
    let above = f64::from_bits(limit.to_bits() + 1);
    (above, f64::from_bits(limit.to_bits() - 1))
}

/// On every limit, and going straight.
fn on_the_limit() -> Trial {
    Trial {
        setting: SettingKind::AsItIs,
        advance: RULES.advance,
        seconds: 4.0,
        top: (RULES.ceiling, BodyPart::Head),
        heat_per_metre: RULES.heat,
        duty: (RULES.most_duty, String::new()),
        peak_over_limit: (1.0, String::new()),
        demanded_shoulder: RULES.demanded_shoulder,
        head: RULES.head,
        weight: 50.0,
        body_share: RULES.body_share,
        yaw: 0.0,
        drift: RULES.drift,
        verdict: Some(Verdict {
            duty: Duty::Continuous,
            reasons: Vec::new(),
        }),
    }
}

/// A setting of a role, with servos of its own.
fn setting(role: Role, servo: MotorServo) -> SettingSpec {
    SettingSpec {
        kind: SettingKind::AsItIs,
        regime: Regime::LOCOMOTION.with_motors(servo),
        friction: None,
        scale: TimeScale::ONE,
        pull: None,
        offsets: None,
        late: None,
        cycles: 2,
        turn: 0.0,
        held: false,
        role,
    }
}

fn broken(role: Role, trial: &Trial) -> f64 {
    in_all(&RULES.broken_by_trial(&setting(role, OWN), trial, FIRST))
}

fn in_all(broken: &[(&'static str, f64)]) -> f64 {
    broken.iter().map(|(_, amount)| amount).sum()
}

#[track_caller]
fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-12, "{found}, not {expected}");
}

#[test]
fn what_is_on_its_limit_breaks_nothing() {
    near(broken(Role::Value, &on_the_limit()), 0.0);
    near(RULES.broken_by_duration(RULES.seconds), 0.0);
    near(RULES.broken_by_heat(RULES.heat), 0.0);
    let beyond = Trial {
        advance: 2.0 * RULES.advance,
        top: (0.5 * RULES.ceiling, BodyPart::Head),
        demanded_shoulder: 0.5 * RULES.demanded_shoulder,
        body_share: 0.5 * RULES.body_share,
        ..on_the_limit()
    };
    near(broken(Role::Value, &beyond), 0.0);
}

/// Of each rule: just inside, a tenth outside, just outside, not a number. `amount` is what a tenth of
/// the limit outside breaks.
fn holds(limit: f64, inside: Side, amount: f64, broken: impl Fn(f64) -> f64) {
    let (above, below) = next(limit);
    let (inside, outside, far) = match inside {
        Side::Below => (below, above, 1.1 * limit),
        Side::Above => (above, below, 0.9 * limit),
    };
    near(broken(inside), 0.0);
    // A difference in the last digit is as good as none, and must not count as much.
    assert!((0.0..1e-12).contains(&broken(outside)), "{outside}");
    near(broken(far), amount);
    near(broken(f64::NAN), UNTRIED);
}

/// On which side of its limit a value is allowed.
#[derive(Clone, Copy)]
enum Side {
    Below,
    Above,
}

#[test]
fn nothing_may_be_higher_than_the_ceiling() {
    for role in [Role::Value, Role::Keep(0.5)] {
        holds(RULES.ceiling, Side::Below, 0.1, |top| {
            let trial = Trial {
                top: (top, BodyPart::Head),
                ..on_the_limit()
            };
            broken(role, &trial)
        });
    }
}

#[test]
fn a_cycle_may_not_last_longer() {
    holds(RULES.seconds, Side::Below, 0.1, |seconds| {
        RULES.broken_by_duration(seconds)
    });
}

#[test]
fn a_cycle_may_not_be_warmer() {
    holds(RULES.heat, Side::Below, 0.1, |heat| {
        RULES.broken_by_heat(heat)
    });
    let free = CycleRules::FREE;
    near(free.broken_by_heat(f64::NAN), 0.0);
}

#[test]
fn a_cycle_may_not_advance_less() {
    let advanced = |role: Role| {
        move |advance: f64| {
            let trial = Trial {
                advance,
                ..on_the_limit()
            };
            broken(role, &trial)
        }
    };
    holds(RULES.advance, Side::Above, 0.1, advanced(Role::Value));
    // Where it has to hold, it keeps a share of what it does in the first setting.
    holds(0.85 * FIRST, Side::Above, 0.1, advanced(Role::Keep(0.85)));
    // Half of it is left where it turns as hard as it can, and has turned far enough.
    holds(0.5 * FIRST, Side::Above, 0.1, advanced(Role::Turn(0.0)));
    // Going backwards breaks more than standing still.
    near(advanced(Role::Value)(0.0), 1.0);
    near(advanced(Role::Value)(-RULES.advance), 2.0);
}

/// A first setting that advances too little leaves the others no easier task.
#[test]
fn a_share_is_at_least_that_of_the_least_advance() {
    let trial = Trial {
        advance: 0.5 * 0.85 * RULES.advance,
        ..on_the_limit()
    };
    let role = Role::Keep(0.85);
    for first in [0.2 * RULES.advance, 0.0, -1.0, f64::NAN] {
        near(
            in_all(&RULES.broken_by_trial(&setting(role, OWN), &trial, first)),
            0.5,
        );
    }
}

#[test]
fn trunk_and_legs_may_not_carry_more_where_values_count() {
    let carried = |role: Role| {
        move |body_share: f64| {
            let trial = Trial {
                advance: FIRST,
                body_share,
                ..on_the_limit()
            };
            broken(role, &trial)
        }
    };
    holds(RULES.body_share, Side::Below, 0.03, carried(Role::Value));
    near(carried(Role::Keep(0.85))(0.9), 0.0);
    let free = CycleRules {
        body_share: 1.0,
        ..RULES
    };
    let trial = Trial {
        body_share: 1.0,
        ..on_the_limit()
    };
    near(
        in_all(&free.broken_by_trial(&setting(Role::Value, OWN), &trial, FIRST)),
        0.0,
    );
}

#[test]
fn a_shoulders_own_servo_may_not_demand_more() {
    let demanded = |servo: MotorServo| {
        move |demanded_shoulder: f64| {
            let trial = Trial {
                demanded_shoulder,
                ..on_the_limit()
            };
            in_all(&RULES.broken_by_trial(&setting(Role::Value, servo), &trial, FIRST))
        }
    };
    let limit = RULES.demanded_shoulder;
    holds(limit, Side::Below, 0.1, demanded(OWN));
    near(demanded(MotorServo::STIFF)(10.0 * limit), 0.0);
}

#[test]
fn a_motor_may_not_work_more_where_values_count() {
    let loaded = |role: Role, servo: MotorServo| {
        move |duty: f64| {
            let trial = Trial {
                duty: (duty, String::new()),
                advance: FIRST,
                ..on_the_limit()
            };
            in_all(&RULES.broken_by_trial(&setting(role, servo), &trial, FIRST))
        }
    };
    let limit = RULES.most_duty;
    holds(limit, Side::Below, 0.1, loaded(Role::Value, OWN));
    near(loaded(Role::Keep(0.5), OWN)(2.0 * limit), 0.0);
    let stiff = MotorServo::STIFF;
    near(loaded(Role::Value, stiff)(2.0 * limit), 0.0);
}

#[test]
fn a_cycle_may_not_be_slower_where_values_count() {
    let rules = CycleRules {
        least_speed: 0.03,
        ..RULES
    };
    let timed = |role: Role| {
        move |speed: f64| {
            let trial = Trial {
                advance: FIRST,
                seconds: FIRST / speed,
                ..on_the_limit()
            };
            in_all(&rules.broken_by_trial(&setting(role, OWN), &trial, FIRST))
        }
    };
    near(timed(Role::Value)(1.01 * rules.least_speed), 0.0);
    near(timed(Role::Value)(0.9 * rules.least_speed), 0.1);
    near(timed(Role::Value)(f64::NAN), UNTRIED);
    near(timed(Role::Keep(0.5))(0.1 * rules.least_speed), 0.0);
}

#[test]
fn nothing_is_asked_of_what_stands_beside() {
    let bad = Trial {
        advance: -1.0,
        top: (9.0, BodyPart::Head),
        demanded_shoulder: f64::NAN,
        body_share: 1.0,
        yaw: 3.0,
        ..on_the_limit()
    };
    near(broken(Role::Beside, &bad), 0.0);
}

#[test]
fn what_breaks_several_rules_breaks_their_sum() {
    let trial = Trial {
        advance: 0.9 * RULES.advance,
        top: (1.2 * RULES.ceiling, BodyPart::Head),
        demanded_shoulder: 1.3 * RULES.demanded_shoulder,
        body_share: RULES.body_share + 0.4,
        ..on_the_limit()
    };
    near(broken(Role::Value, &trial), 0.1 + 0.2 + 0.3 + 0.4);
}

/// What is not limited may be infinite.
#[test]
fn limit_an_infinite_value_keeps_a_rule_without_a_limit_and_no_other() {
    let infinite = f64::INFINITY;
    near(above(infinite, infinite), 0.0);
    near(CycleRules::FREE.broken_by_duration(infinite), 0.0);
    assert!(RULES.broken_by_duration(infinite).is_infinite());
}

/// Turned by an angle, rad, and far enough for every role.
fn turned(yaw: f64) -> Trial {
    Trial {
        advance: FIRST,
        yaw,
        ..on_the_limit()
    }
}

/// A positive yaw is to the left: turning to the right as far as it should turn to the left is worse
/// than not turning at all.
#[test]
fn a_turn_is_to_the_left() {
    let role = Role::Turn(0.1);
    holds(0.1, Side::Above, 0.1, |yaw| role.misdirected(&turned(yaw)));
    near(role.misdirected(&turned(0.3)), 0.0);
    near(role.misdirected(&turned(0.0)), 1.0);
    near(role.misdirected(&turned(-0.1)), 2.0);
    near(broken(role, &turned(0.1)), 0.0);
    near(broken(role, &turned(-0.1)), 2.0);
}

/// How far a held heading comes off its line is the trial's to say; where none is held nothing is
/// asked.
#[test]
fn a_held_heading_may_not_come_further_off_its_line() {
    for role in [Role::Value, Role::Keep(0.85)] {
        let held = SettingSpec {
            held: true,
            ..setting(role, OWN)
        };
        let drifted = |spec: &SettingSpec, drift: f64| {
            let trial = Trial {
                advance: FIRST,
                drift,
                ..on_the_limit()
            };
            in_all(&RULES.broken_by_trial(spec, &trial, FIRST))
        };
        holds(RULES.drift, Side::Below, 0.1, |drift| drifted(&held, drift));
        near(drifted(&setting(role, OWN), 9.0), 0.0);
    }
}

#[test]
fn other_roles_do_not_ask_for_a_direction() {
    for role in [Role::Value, Role::Keep(0.85), Role::Beside] {
        for yaw in [1.0, -1.0] {
            near(role.misdirected(&turned(yaw)), 0.0);
        }
    }
}

#[test]
fn roles_keep_their_shares() {
    let share = |role: Role| role.keep().unwrap_or(f64::NAN);
    near(share(Role::Keep(0.7)), 0.7);
    // Half of the advance is left where it turns as hard as it can.
    near(share(Role::Turn(0.1)), 0.5);
    assert_eq!((Role::Value.keep(), Role::Beside.keep()), (None, None));
    let slow = Trial {
        advance: 0.25 * FIRST,
        yaw: 0.1,
        ..on_the_limit()
    };
    near(broken(Role::Turn(0.1), &slow), 0.5);
}

/// What a confirmation asks, one thing at a time.
#[test]
fn a_cycle_holds_where_it_is_low_and_far_and_turns() {
    let trial = Trial {
        setting: SettingKind::AsItIs,
        advance: 0.1,
        seconds: 4.0,
        top: (0.17, BodyPart::Head),
        heat_per_metre: 50.0,
        duty: (RULES.most_duty, String::new()),
        peak_over_limit: (1.0, String::new()),
        demanded_shoulder: 2.0,
        head: 0.5,
        weight: 50.0,
        body_share: 0.1,
        yaw: 0.03,
        drift: 9.0,
        verdict: None,
    };
    let at = |role: Role, kept: f64, ceiling: f64| {
        let bounds = Bounds { ceiling, ..BOUNDS };
        super::holds(&setting(role, OWN), &trial, kept, bounds)
    };
    assert!(at(Role::Value, 1.0, 0.18));
    for ceiling in [0.16, 0.17, f64::NAN] {
        assert!(!at(Role::Value, 1.0, ceiling), "under {ceiling} m");
        assert!(at(Role::Beside, 0.0, ceiling), "beside");
    }
    // A share of its own, or the usual one.
    for (role, share) in [(Role::Keep(0.6), 0.6), (Role::Value, HOLDS)] {
        assert!(at(role, share, 0.18));
        assert!(!at(role, share - 0.01, 0.18));
        assert!(!at(role, f64::NAN, 0.18));
    }
    assert!(at(Role::Turn(0.02), 1.0, 0.18));
    assert!(!at(Role::Turn(0.04), 1.0, 0.18));
    for (advance, yaw) in [(-0.1, 0.03), (0.0, 0.03), (0.1, f64::NAN)] {
        let bad = Trial {
            advance,
            yaw,
            ..trial.clone()
        };
        let role = Role::Turn(0.02);
        assert!(
            !super::holds(&setting(role, OWN), &bad, 1.0, BOUNDS),
            "{bad:?}"
        );
    }
    for head in [1.1, f64::NAN] {
        let bad = Trial {
            head,
            ..trial.clone()
        };
        assert!(
            !super::holds(&setting(Role::Value, OWN), &bad, 1.0, BOUNDS),
            "{head} N"
        );
    }
    // Off the line it holds only where no heading is held.
    for (held, drift, on_its_line) in [(true, 9.5, false), (true, 9.0, true), (false, 9.5, true)] {
        let spec = SettingSpec {
            held,
            ..setting(Role::Value, OWN)
        };
        let trial = Trial {
            drift,
            ..trial.clone()
        };
        let holds = super::holds(&spec, &trial, 1.0, BOUNDS);
        assert_eq!(holds, on_its_line, "{drift} m, held: {held}");
    }
}

const BOUNDS: Bounds = Bounds {
    ceiling: 0.18,
    head: 1.0,
    drift: 9.0,
};

/// In shares of the weight, whatever the setting is for.
#[test]
fn the_head_may_not_carry() {
    let carried = |role: Role| {
        move |head: f64| {
            let trial = Trial {
                advance: FIRST,
                head,
                ..on_the_limit()
            };
            broken(role, &trial)
        }
    };
    for role in [Role::Value, Role::Keep(0.85)] {
        near(carried(role)(RULES.head), 0.0);
        near(carried(role)(RULES.head + 10.0), 10.0 / 50.0);
        near(carried(role)(f64::NAN), UNTRIED);
    }
    near(carried(Role::Beside)(40.0), 0.0);
}

/// Beyond the bound that was asked for, motor by motor; the head has a rule of its own.
#[test]
fn motors_may_not_be_beyond_what_a_verdict_allows() {
    let worked = |value: f64, role: Role, servo: MotorServo, verdict: Duty| {
        let rules = CycleRules { verdict, ..RULES };
        let reason = |measure| Reason {
            measure,
            joint: None,
            value,
        };
        let trial = Trial {
            advance: FIRST,
            verdict: Some(Verdict {
                duty: Duty::NotOnARobot,
                reasons: vec![
                    reason(Measure::RmsTorque),
                    Reason {
                        value: 100.0,
                        ..reason(Measure::Head)
                    },
                ],
            }),
            ..on_the_limit()
        };
        in_all(&rules.broken_by_trial(&setting(role, servo), &trial, FIRST))
    };
    for (duty, bound) in [(Duty::Continuous, 1.0), (Duty::Limited, 1.7)] {
        holds(bound, Side::Below, 0.1, |value| {
            worked(value, Role::Value, OWN, duty)
        });
    }
    near(worked(9.0, Role::Value, OWN, Duty::NotOnARobot), 0.0);
    // Only the robot's own servos say what its motors do, and only where values count.
    near(
        worked(9.0, Role::Value, MotorServo::STIFF, Duty::Continuous),
        0.0,
    );
    near(worked(9.0, Role::Keep(0.85), OWN, Duty::Continuous), 0.0);
}

/// Measures add up, so that a search can go down each slope by itself.
#[test]
fn every_measure_of_a_verdict_is_held() {
    let reasons = [
        (Measure::RmsTorque, 1.2),
        (Measure::SupplyClipped, 0.325),
        (Measure::CurrentLimited, 0.07),
        (Measure::PlannedSpeed, 1.2),
    ];
    let reasons = reasons.map(|(measure, value)| Reason {
        measure,
        joint: None,
        value,
    });
    let trial = Trial {
        verdict: Some(Verdict {
            duty: Duty::Limited,
            reasons: reasons.into(),
        }),
        ..on_the_limit()
    };
    near(broken(Role::Value, &trial), 0.2 + 0.3 + 0.4 + 0.5);
}

/// What cannot be judged is not thought possible.
#[test]
fn limit_a_verdict_that_is_unknown() {
    let trial = Trial {
        verdict: None,
        ..on_the_limit()
    };
    near(broken(Role::Value, &trial), UNTRIED);
    let anyhow = CycleRules {
        verdict: Duty::NotOnARobot,
        ..RULES
    };
    let spec = setting(Role::Value, OWN);
    near(in_all(&anyhow.broken_by_trial(&spec, &trial, FIRST)), 0.0);
}
