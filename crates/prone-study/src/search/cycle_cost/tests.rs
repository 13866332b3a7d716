use prone::robot::BodyPart;
use prone_files::shipped;
use prone_sim::{LoadedRobot, RobotFiles};

use super::super::cycle_jobs::usual_rules;
use super::super::settings;
use super::*;
use prone_record::frontier::SettingKind;

fn warm(heat_per_metre: f64) -> Trial {
    Trial {
        setting: SettingKind::AsItIs,
        advance: 0.1,
        seconds: 2.0,
        top: (0.2, BodyPart::Head),
        heat_per_metre,
        duty: (0.5, String::new()),
        peak_over_limit: (1.0, String::new()),
        demanded_shoulder: heat_per_metre,
        head: 0.0,
        weight: 50.0,
        body_share: 0.0,
        yaw: 0.0,
        drift: 0.0,
        verdict: None,
    }
}

fn nao() -> LoadedRobot {
    LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap()
}

fn cycle(name: &str) -> Cycle {
    shipped::cycle(name).unwrap().unwrap()
}

const ADVANCE: CycleAim = CycleAim {
    objective: CycleObjective::Advance,
    merge: Merge::Mean,
    rules: ANYHOW,
};

/// The shipped cycles rest on the head, which is not what these tests are about.
const ANYHOW: CycleRules = CycleRules {
    head: f64::INFINITY,
    ..CycleRules::FREE
};

#[track_caller]
fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-12, "{found}, not {expected}");
}

#[test]
fn heats_merge_geometrically_or_to_the_worst_of_shares() {
    let (four, nine, much) = (warm(4.0), warm(9.0), warm(81.0));
    let mean = Merge::Mean.heat(&[&four, &nine]);
    assert!((mean - 6.0).abs() < 1e-12, "{mean}");
    let over = Merge::WorstOver(vec![8.0, 90.0]);
    assert!((over.heat(&[&four, &nine]) - 0.5).abs() < 1e-12);
    assert!((over.heat(&[&four, &much]) - 0.9).abs() < 1e-12);
    // Of other objectives the robot's own servos decide.
    let tried = [&four, &much];
    let of = |objective: CycleObjective| value(objective, &tried, &tried, &Merge::Mean);
    assert!((of(CycleObjective::Peak) - 4.0).abs() < 1e-12);
    assert!((of(CycleObjective::Speed) + 0.05).abs() < 1e-12);
    assert!((of(CycleObjective::Advance) + 0.1).abs() < 1e-12);
    assert!((of(CycleObjective::Heat) - 18.0).abs() < 1e-12);
}

/// What a cycle advances where everything is as in the model says little: the value is that of the
/// setting in which it is worst.
#[test]
fn advance_and_speed_are_those_of_the_worst_setting() {
    let as_it_is = warm(4.0);
    let sticky = Trial {
        advance: 0.06,
        ..warm(4.0)
    };
    let slow = Trial {
        seconds: 4.0,
        ..warm(4.0)
    };
    let of = |objective, kept: &[&Trial]| value(objective, &[&as_it_is], kept, &Merge::Mean);
    let all = [&as_it_is, &sticky, &slow];
    near(of(CycleObjective::Advance, &all), -0.06);
    near(of(CycleObjective::Speed, &all), -0.025);
    // What else is searched is that of the first setting, wherever else it is tried.
    near(of(CycleObjective::Duty, &all), 0.5);
    for order in [[&as_it_is, &warm_nowhere()], [&warm_nowhere(), &as_it_is]] {
        assert!(of(CycleObjective::Advance, &order).is_nan());
    }
    assert!(of(CycleObjective::Advance, &[]).is_nan());
}

/// A trial whose advance is not a number.
fn warm_nowhere() -> Trial {
    Trial {
        advance: f64::NAN,
        ..warm(4.0)
    }
}

/// A heat that is not a number is the worst, whatever the others are.
#[test]
fn limit_a_heat_that_is_no_number_is_not_left_out() {
    let (four, none) = (warm(4.0), warm(f64::NAN));
    for merge in [Merge::Mean, Merge::WorstOver(vec![8.0, 90.0])] {
        for trials in [[&four, &none], [&none, &four]] {
            assert!(merge.heat(&trials).is_nan(), "{merge:?}");
        }
    }
}

/// A cycle over itself is 1, whatever the servos.
#[test]
fn a_cycle_is_as_warm_as_itself() {
    let robot = nao();
    let cycle = cycle("thesis-nominal");
    let settings = settings::for_heat(&robot).unwrap();
    let merge = Merge::worst_over(&settings, &cycle).unwrap();
    let aim = CycleAim {
        objective: CycleObjective::Heat,
        merge,
        rules: CycleRules {
            demanded_shoulder: 1.0,
            heat: 0.5,
            ..CycleRules::FREE
        },
    };
    let costs = CycleCosts::new(settings.into(), aim, &cycle).unwrap();
    let cost = costs.cost(&cycle, Depth::Everything);
    assert!((cost.value - 1.0).abs() < 1e-12, "{}", cost.value);
    assert_eq!(cost.refusal, None);
    // Stiff servos demand several times as much; only the robot's own are held to the rule.
    let [own, stiff] = &cost.trials[..] else {
        panic!("two servos");
    };
    assert!(stiff.demanded_shoulder > 2.0 * own.demanded_shoulder);
    // Twice the heat that is allowed, and what is demanded above 1 N·m.
    assert!((cost.violation - own.demanded_shoulder).abs() < 1e-12);
}

#[test]
fn a_joint_may_not_be_stopped_further_than_in_the_base() {
    let clamp = |joint: usize, largest: f64| Clamp {
        joint: JointId(joint),
        samples: 1,
        largest,
        from: 0.0,
        to: 0.0,
    };
    // Which stop it is does not matter: those of a NAO's ankles are beyond either.
    let allowed = [clamp(3, -0.2), clamp(5, 0.1)];
    let further = |clamps: &[Clamp]| clamped_further(&allowed, clamps);
    near(further(&[]), 0.0);
    near(further(&[clamp(3, -0.2), clamp(5, 0.1)]), 0.0);
    near(further(&[clamp(3, -0.1), clamp(5, -0.05)]), 0.0);
    near(further(&[clamp(3, -0.25), clamp(5, 0.13)]), 0.08);
    near(further(&[clamp(4, -0.03)]), 0.03);
}

#[test]
fn a_joint_may_not_be_asked_for_more_speed() {
    let speed = |speed: f64| CycleError::Speed {
        cycle: String::new(),
        place: String::new(),
        joint: String::new(),
        speed,
        limit: 5.0,
    };
    near(excess_speed(&speed(5.0)), 0.0);
    near(excess_speed(&speed(5.5)), 0.1);
    near(excess_speed(&speed(f64::NAN)), UNTRIED);
    let turn = CycleError::Turn {
        cycle: String::new(),
        what: "turn",
        asked_deg: 3.0,
        limit_deg: 0.0,
    };
    near(excess_speed(&turn), UNTRIED);
}

#[test]
fn limbs_may_not_be_in_one_another() {
    near(depth_of(0.001), 0.0);
    near(depth_of(0.0), 0.0);
    near(depth_of(-0.001), 0.1);
    for distance in [f64::NAN, f64::INFINITY] {
        near(depth_of(distance), UNTRIED);
    }
}

/// Where a cycle is played faster than it is written, its joints have to be fast enough for that; it
/// does not help that it is played slowly elsewhere.
#[test]
fn the_fastest_setting_decides_whether_joints_are_fast_enough() {
    let robot = nao();
    let base = cycle("hip-10");
    let refused = |settings: &[Setting]| {
        let costs = CycleCosts::new(settings.into(), ADVANCE, &base).unwrap();
        costs.cost_of_plan(&base).refusal
    };
    let [as_it_is] = &settings::for_search(CycleObjective::Advance, &robot).unwrap()[..] else {
        panic!("one setting");
    };
    let settings = [1.0, 1.7, 0.8].map(|scale| {
        let mut setting = as_it_is.clone();
        setting.spec.scale = TimeScale::new(scale).unwrap();
        setting
    });
    assert_eq!(refused(&settings[..2]), None);
    let refusal = refused(&settings);
    assert!(
        matches!(refusal, Some(Refusal::Plan(CycleError::Speed { .. }))),
        "{refusal:?}"
    );
}

/// What a plan breaks before anything moves, and why it cannot be crawled.
fn in_plan(base: &Cycle, rules: CycleRules, cycle: &Cycle) -> (f64, Option<Refusal>) {
    let robot = nao();
    let settings = &settings::for_search(CycleObjective::Advance, &robot).unwrap()[..1];
    let aim = CycleAim { rules, ..ADVANCE };
    let costs = CycleCosts::new(settings.into(), aim, base).unwrap();
    let cost = costs.cost_of_plan(cycle);
    (cost.violation, cost.refusal)
}

#[test]
fn a_shipped_cycle_breaks_nothing_in_its_plan_and_a_longer_one_its_duration() {
    let base = cycle("hip-10");
    let rules = usual_rules(CycleObjective::Advance, 0.2, &base, nao().robot());
    assert_eq!(in_plan(&base, rules, &base), (0.0, None));
    let mut longer = base.clone();
    longer.pull.as_mut().unwrap().approach.seconds += 0.1 * rules.seconds;
    let (broken, refusal) = in_plan(&base, rules, &longer);
    near(broken, 0.1);
    assert_eq!(refusal, None);
}

#[test]
fn crossed_legs_are_as_deep_in_one_another_as_the_scan_says() {
    let base = cycle("hip-10");
    let mut crossed = base.clone();
    let roll = &mut crossed.waypoints[0].joints;
    roll.insert("LHipRoll".to_owned(), -0.3);
    let (broken, refusal) = in_plan(&base, CycleRules::FREE, &crossed);
    // A leg is some centimetres thick.
    assert!((1.0..10.0).contains(&broken), "{broken} cm");
    assert_eq!(refusal, None);
}

#[test]
fn a_cycle_that_cannot_be_planned_says_why_and_by_how_much() {
    let base = cycle("hip-10");
    let mut hasty = base.clone();
    hasty.waypoints[0].approach.seconds = 0.1;
    let (broken, refusal) = in_plan(&base, CycleRules::FREE, &hasty);
    let Some(Refusal::Plan(CycleError::Speed { speed, limit, .. })) = refusal else {
        panic!("{refusal:?}");
    };
    near(broken, UNTRIED + speed / limit - 1.0);
    let mut unknown = base.clone();
    unknown.waypoints[0].joints.insert("Tail".to_owned(), 0.1);
    let (broken, refusal) = in_plan(&base, CycleRules::FREE, &unknown);
    near(broken, 2.0 * UNTRIED);
    let reason = refusal.unwrap().to_string();
    assert!(reason.contains("has no joint Tail"), "{reason}");
}

/// A search stops at the first setting in which a rule is broken; a quotation does not.
#[test]
fn settings_after_a_broken_one_are_not_tried() {
    let robot = nao();
    let base = cycle("hip-10");
    let mut settings = settings::for_search(CycleObjective::Advance, &robot).unwrap();
    settings.push(settings[0].clone());
    settings[1].spec.role = Role::Keep(0.5);
    settings[1].spec.scale = TimeScale::new(1.7).unwrap();
    let rules = CycleRules {
        ceiling: 0.1,
        ..ANYHOW
    };
    let aim = CycleAim { rules, ..ADVANCE };
    let costs = CycleCosts::new(settings.into(), aim, &base).unwrap();
    let cost = |depth| costs.cost(&base, depth);
    let (short, whole) = (cost(Depth::UntilBroken), cost(Depth::Everything));
    assert_eq!((short.trials.len(), whole.trials.len()), (1, 2));
    let too_high = |trial: &Trial| trial.top.0 / 0.1 - 1.0;
    near(short.violation, too_high(&short.trials[0]) + UNTRIED);
    let high: f64 = whole.trials.iter().map(too_high).sum();
    near(whole.violation, high);
    near(short.value, -short.trials[0].advance);
    // Where its advance has to be kept, it counts: the value is that of the worst of both.
    let advances = [&whole.trials[0], &whole.trials[1]].map(|trial| trial.advance);
    assert!((advances[0] - advances[1]).abs() > 1e-4, "{advances:?}");
    near(whole.value, -advances[0].min(advances[1]));
}

/// What happens in a setting is a reason too, with the setting's name.
#[test]
fn a_setting_that_cannot_be_crawled_is_named() {
    let robot = nao();
    let base = Cycle {
        steering: None,
        ..cycle("hip-10")
    };
    let mut settings = settings::for_search(CycleObjective::Advance, &robot).unwrap();
    let turning = &settings::for_steering(&robot).unwrap()[0];
    settings.push(turning.clone());
    // A turn that the steering allows and joints are too slow for.
    let mut hasty = base.clone();
    hasty.steering = cycle("hip-10").steering;
    hasty.steering.as_mut().unwrap().limit = 3.0;
    hasty.steering.as_mut().unwrap().spread = 3.0;
    let kind = settings[1].spec.kind;
    let costs = CycleCosts::new(settings.into(), ADVANCE, &base).unwrap();
    let cost = costs.cost(&hasty, Depth::UntilBroken);
    let Some(Refusal::Crawl { setting, source }) = cost.refusal else {
        panic!("{cost:?}");
    };
    assert_eq!(setting, kind);
    near(cost.violation, UNTRIED + excess_speed_of_crawl(&source));
}

#[test]
fn limit_what_cannot_be_compared_is_refused() {
    let base = cycle("hip-10");
    let settings = |files| settings::for_heat(&LoadedRobot::load(files).unwrap()).unwrap();
    let shipped = RobotFiles::shipped(&shipped::NAO);
    let unknown = RobotFiles {
        toml: shipped.toml.replace("\nmotor = ", "\n#"),
        ..shipped.clone()
    };
    let refused = |files, aim: CycleAim| {
        let settings = settings(files);
        let costs = CycleCosts::new(settings.into(), aim, &base);
        costs.err().unwrap().to_string()
    };
    let other = CycleAim {
        merge: Merge::WorstOver(vec![1.0; 3]),
        ..ADVANCE
    };
    assert_eq!(
        refused(shipped, other),
        "3 heats to compare with are given, and 2 settings have a value"
    );
    // Its heat would be 0, whatever it does.
    let heat = CycleAim {
        objective: CycleObjective::Heat,
        ..ADVANCE
    };
    assert_eq!(
        refused(unknown, heat),
        "joint HeadYaw has no motor with all of its figures in robot.toml (ratio, nominal and stall torque, no-load speed), without which its load is not known"
    );
}

#[test]
fn an_objective_is_written_and_read_under_its_name() {
    for objective in CycleObjective::ALL {
        let name = serde_json::to_value(objective).unwrap();
        assert_eq!(name, objective.name());
        let read: CycleObjective = serde_json::from_value(name).unwrap();
        assert_eq!(read, objective);
    }
    assert!(serde_json::from_str::<CycleObjective>("\"torque\"").is_err());
}

/// Of all motors' heats, the worst motor's is no more than all of them and no less than their mean.
#[test]
fn identity_the_duty_of_the_worst_motor_is_within_what_all_heats_allow() {
    let robot = nao();
    let setting = &settings::for_heat(&robot).unwrap()[0];
    let trial = try_out(setting, &cycle("hip-10")).unwrap();
    let robot = robot.robot();
    let heat = trial.heat_per_metre * trial.advance;
    // RMS over what the gears pass on, of one motor that had all the heat.
    let alone = (heat / trial.seconds).sqrt() / robot.control.gear_efficiency;
    let evenly = alone / (robot.drives().len() as f64).sqrt();
    let (duty, joint) = &trial.duty;
    assert!(
        (evenly..alone).contains(duty),
        "{joint} {duty}, {evenly}..{alone}"
    );
    assert!(robot.joints.iter().any(|it| it.name == *joint));
}
