use proptest::prelude::*;
use serde_json::{Value, json};

use prone::robot::{ContactGroup, Motor};

use super::*;
use crate::shipped;

fn nao() -> CompiledRobot {
    CompiledRobot::shipped(&shipped::NAO).unwrap()
}

fn sources() -> RobotFiles {
    RobotFiles::shipped(&shipped::NAO)
}

/// The shipped text with one value changed.
fn changed(pointer: &str, value: Value) -> String {
    let mut document: Value = serde_json::from_str(shipped::NAO.compiled).unwrap();
    let place = document.pointer_mut(pointer);
    *place.unwrap_or_else(|| panic!("{pointer} is not there")) = value;
    document.to_string()
}

fn refusal(text: &str) -> String {
    CompiledRobot::parse("nao.json", text)
        .unwrap_err()
        .to_string()
}

#[test]
fn identity_the_shipped_text_is_written_again_byte_for_byte() {
    assert_eq!(nao().text(), shipped::NAO.compiled);
}

/// What the keys say stands under them: numbers as `robot.toml` and the model have them.
#[test]
fn reference_keys_hold_what_the_sources_say() {
    let document: Value = serde_json::from_str(shipped::NAO.compiled).unwrap();
    let joints = document["robot"]["joints"].as_array().unwrap();
    let knee = joints.iter().find(|it| it["name"] == "LKneePitch").unwrap();
    let (motor, control) = (&knee["motor"], &document["robot"]["control"]);
    let sole = &document["robot"]["chain"]["left"]["toe"]["position_m"];
    let published = &document["robot"]["chain"]["published"];
    let imu = &document["robot"]["imu"];
    let head = &document["robot"]["coupled_limits"][0]["table_rad"];
    let rpm = std::f64::consts::TAU / 60.0;
    for (what, value, expected) in [
        ("lower", &knee["range_rad"][0], -0.0923),
        ("upper", &knee["range_rad"][1], 2.1125),
        ("axis", &knee["axis"][1], 1.0),
        ("effort", &knee["effort_limit_nm"], 3.023),
        ("speed", &knee["speed_limit_rad_s"], 6.4),
        ("stiffness", &knee["servo_stiffness_nm_rad"], 80.0),
        ("ratio", &motor["ratio"], 130.85),
        ("nominal", &motor["nominal_nm"], 0.0161 * 130.85),
        ("stall", &motor["stall_nm"], 0.068 * 130.85),
        (
            "no load",
            &motor["no_load_speed_rad_s"],
            8300.0 * rpm / 130.85,
        ),
        ("toe", &sole[0], 0.0935),
        ("l4", &published["links_m"][3], 0.1885),
        ("ankle", &published["ankle_offset_rad"], 60_f64.to_radians()),
        ("roll", &published["shoulder_roll_rad"], 22_f64.to_radians()),
        (
            "noise",
            &imu["accelerometer_m_s2"]["standard_deviation"],
            0.039,
        ),
        ("bias", &imu["gyroscope_rad_s"]["bias_bound"], 0.01),
        ("step", &control["command_step_s"], 0.01),
        ("gears", &control["gear_efficiency"], 0.6),
        ("yaw", &control["steering"]["yaw"], 0.8),
        ("lateral", &control["steering"]["lateral_rad_m"], 2.0),
        ("sum", &control["steering"]["lateral_sum_rad_m"], 0.3),
        ("ahead", &control["steering"]["ahead_m"], 0.4),
        ("yaw sum", &control["steering"]["yaw_sum"], 0.3),
        ("aside", &control["steering"]["aside_rad_m"], 0.7),
        ("uphill", &control["uphill_rad"], 1.5_f64.to_radians()),
        ("head yaw", &head[1][0], -87.49_f64.to_radians()),
        ("head down", &head[1][1], -18.91_f64.to_radians()),
        ("head up", &head[1][2], 11.46_f64.to_radians()),
    ] {
        let value = value.as_f64().unwrap();
        assert!((value - expected).abs() < 1e-12, "{what}: {value}");
    }
}

/// A rotation has its real part first.
#[test]
fn a_turn_is_written_with_its_real_part_first() {
    let mut robot = nao().into_robot();
    let turn = glam::DQuat::from_rotation_y(0.2);
    let site = robot.imu.as_mut().unwrap();
    site.root_from_sensor = prone::frames::Transform::new(turn, glam::DVec3::X);
    let compiled = CompiledRobot::new(&robot, &sources(), String::new()).unwrap();
    assert_eq!(compiled.robot(), &robot);
    let document: Value = serde_json::from_str(&compiled.text()).unwrap();
    let pose = &document["robot"]["imu"]["root_from_sensor"];
    assert_eq!(
        pose["quaternion_wxyz"],
        json!([0.1_f64.cos(), 0.0, 0.1_f64.sin(), 0.0])
    );
    assert_eq!(pose["position_m"], json!([1.0, 0.0, 0.0]));
}

/// Robots that differ from the NAO in numbers of every kind, with digits that no decimal shortens.
fn robots() -> impl Strategy<Value = Robot> {
    let numbers = proptest::collection::vec(0.01..1.0_f64, 64);
    (numbers, 0.3..3.0_f64, any::<[bool; 6]>()).prop_map(|(numbers, scale, flags)| {
        let mut robot = nao().into_robot();
        let mut numbers = numbers.into_iter().cycle();
        let mut number = || numbers.next().unwrap();
        enlarge(&mut robot, scale);
        robot.name = format!("\"{}\" \u{1F916}", number());
        for body in &mut robot.bodies {
            body.mass *= 0.9 + 0.1 * number();
            body.contact_group = if flags[0] {
                ContactGroup::Head
            } else {
                body.contact_group
            };
        }
        robot.bodies[3].contact_group = ContactGroup::Toe;
        robot.shared_motors.clear();
        robot.control.command_step = number();
        robot.control.steering.lateral_sum = number();
        robot.control.steering.yaw_sum = number();
        robot.control.steering.ahead = number();
        robot.control.steering.aside = number();
        if flags[5] {
            robot.coupled_limits.clear();
        }
        for limit in &mut robot.coupled_limits {
            for (index, (angle, range)) in limit.table.iter_mut().enumerate() {
                // Angles that rise.
                *angle = index as f64 * 0.1 + 0.09 * number();
                range.lower = -number();
                range.upper = number();
            }
        }
        robot.search.upper_arm.upper = number();
        for joint in &mut robot.joints {
            joint.range.lower -= 0.05 * number();
            joint.range.upper += 0.05 * number();
            let stronger = 0.9 + 0.1 * number();
            joint.effort_limit *= stronger;
            joint.speed_limit *= 0.9 + 0.1 * number();
            joint.servo_stiffness *= stronger;
            let (speed, stall) = (
                joint.speed_limit,
                joint.effort_limit * (1.0 + 0.1 * number()),
            );
            joint.motor = flags[1].then(|| Motor {
                ratio: number() * 100.0,
                nominal: stall * (0.9 + 0.1 * number()),
                stall,
                no_load_speed: flags[2].then(|| speed * (1.0 + number())),
            });
        }
        for angles in robot.postures.values_mut() {
            for index in 0..robot.joints.len() {
                angles[prone::robot::JointId(index)] = number() - 0.5;
            }
        }
        if flags[3] {
            robot.imu = None;
            robot.standing_height = None;
        }
        if flags[4] {
            robot.chain.published = None;
            robot.chain.fixed_arm = None;
        }
        if flags[5] {
            robot.study.stops.clear();
        }
        robot
    })
}

/// The same robot of another size: its chain closes as before.
fn enlarge(robot: &mut Robot, scale: f64) {
    robot.lying_length *= scale;
    robot.standing_height = robot.standing_height.map(|height| height * scale);
    for body in &mut robot.bodies {
        body.mass *= scale.powi(3);
    }
    for joint in &mut robot.joints {
        // Weight times length.
        joint.effort_limit *= scale.powi(4);
        joint.servo_stiffness *= scale.powi(4);
        joint.motor = None;
    }
    let mut document = RobotDocument::from_robot(robot);
    let grow = |metres: &mut [f64; 3]| *metres = metres.map(|metres| metres * scale);
    for body in &mut document.bodies {
        grow(&mut body.parent_from_body.position_m);
        grow(&mut body.centre_of_mass_m);
    }
    for joint in &mut document.joints {
        grow(&mut joint.anchor_m);
    }
    for shape in &mut document.shapes {
        grow(&mut shape.link_from_geom.position_m);
    }
    for side in [&mut document.chain.left, &mut document.chain.right] {
        grow(&mut side.toe.position_m);
        grow(&mut side.elbow.position_m);
    }
    let chain = &mut document.chain;
    chain.span_m *= scale;
    chain.projected_upper_arm_m *= scale;
    *robot = document.robot("robot").unwrap();
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Read after it was written a robot is the same, to the last bit.
    #[test]
    fn identity_what_is_written_is_read_again(robot in robots()) {
        let compiled = CompiledRobot::new(&robot, &sources(), "an engine".to_owned()).unwrap();
        prop_assert_eq!(compiled.robot(), &robot);
        let text = compiled.text();
        let again = CompiledRobot::parse("robot.json", &text).unwrap();
        prop_assert_eq!(&again, &compiled);
        prop_assert_eq!(again.text(), text);
    }
}

#[test]
fn identity_negative_zeros_and_the_smallest_numbers_stay() {
    let mut robot = nao().into_robot();
    let stand = robot.postures.get_mut("stand").unwrap();
    stand[prone::robot::JointId(0)] = -0.0;
    stand[prone::robot::JointId(1)] = f64::MIN_POSITIVE / 3.0;
    let compiled = CompiledRobot::new(&robot, &sources(), String::new()).unwrap();
    let again = CompiledRobot::parse("robot.json", &compiled.text()).unwrap();
    let bits = |robot: &Robot| -> Vec<u64> {
        let angles = robot.postures["stand"].as_slice().iter();
        angles.map(|angle| angle.to_bits()).collect()
    };
    assert_eq!(bits(again.robot()), bits(&robot));
}

/// What a robot has that no text can say.
#[test]
fn limit_a_robot_that_could_not_be_read_again_is_not_written() {
    let refusal = |change: &dyn Fn(&mut Robot)| {
        let mut robot = nao().into_robot();
        change(&mut robot);
        CompiledRobot::new(&robot, &sources(), String::new())
            .unwrap_err()
            .to_string()
    };
    let refusals = [
        refusal(&|it| it.bodies[1].mass = f64::NAN),
        refusal(&|it| it.joints[2].range.upper = f64::INFINITY),
        refusal(&|it| it.name.clear()),
        refusal(&|it| it.shapes.clear()),
        refusal(&|it| it.postures.clear()),
        refusal(&|it| it.bodies.iter_mut().for_each(|body| body.mass = 0.0)),
        refusal(&|it| {
            for body in &mut it.bodies {
                body.contact_group = ContactGroup::Leg;
            }
        }),
    ];
    insta::assert_snapshot!(refusals.join("\n"));
}

/// Each bound, just or far beyond it.
#[test]
fn limit_what_no_robot_has_is_refused_with_place_and_bound() {
    let long = "x".repeat(257);
    let refusals = [
        ("/robot/name", json!("")),
        ("/robot/name", json!(long)),
        ("/robot/standing_height_m", json!(10.5)),
        ("/robot/bodies/0/parent", json!("Head")),
        ("/robot/bodies/0/joint", json!("HeadYaw")),
        ("/robot/bodies/0/parent_from_body/position_m/2", json!(0.1)),
        ("/robot/bodies/2/parent", json!(null)),
        ("/robot/bodies/2/parent", json!("Head")),
        ("/robot/bodies/1/parent", json!("Head")),
        ("/robot/bodies/1/parent", json!("nobody")),
        ("/robot/bodies/1/name", json!("Head")),
        ("/robot/bodies/1/joint", json!("HeadPitch")),
        ("/robot/bodies/1/joint", json!(null)),
        ("/robot/bodies/1/mass_kg", json!(-0.1)),
        ("/robot/bodies/1/mass_kg", json!(1000.5)),
        ("/robot/bodies/1/centre_of_mass_m/1", json!(-10.1)),
        (
            "/robot/bodies/1/parent_from_body/quaternion_wxyz",
            json!([1.0, 0.0, 0.0, 0.01]),
        ),
        ("/robot/joints/0/name", json!("HeadPitch")),
        ("/robot/joints/0/body", json!("Head")),
        ("/robot/joints/0/body", json!("torso")),
        ("/robot/joints/0/axis", json!([0.0, 0.0, 1.001])),
        ("/robot/joints/0/anchor_m/0", json!(1e300)),
        ("/robot/joints/0/range_rad", json!([0.5, 0.5])),
        ("/robot/joints/0/range_rad", json!([0.5, 2e9])),
        ("/robot/joints/0/effort_limit_nm", json!(0.0)),
        ("/robot/joints/0/speed_limit_rad_s", json!(1000.5)),
        ("/robot/joints/0/servo_stiffness_nm_rad", json!(200_000.0)),
        ("/robot/joints/0/motor/ratio", json!(0.0)),
        ("/robot/joints/0/motor/stall_nm", json!(200_000.0)),
        ("/robot/joints/0/motor/no_load_speed_rad_s", json!(1000.0)),
        ("/robot/shapes/0/body", json!("nobody")),
        (
            "/robot/shapes/0/solid",
            json!({"sphere": {"radius_m": 0.0}}),
        ),
        (
            "/robot/shapes/0/solid",
            json!({"cuboid": {"half_edges_m": [1.0, 11.0, 1.0]}}),
        ),
        ("/robot/chain/span_m", json!(-0.43)),
        ("/robot/chain/projected_upper_arm_m", json!(0.5)),
        ("/robot/chain/left/knee", json!("LKneePich")),
        ("/robot/chain/left/knee", json!("LHipPitch")),
        ("/robot/chain/left/knee", json!("LAnkleRoll")),
        ("/robot/chain/left/toe/body", json!("RFoot")),
        ("/robot/chain/left/toe/position_m/0", json!(0.2)),
        (
            "/robot/chain/left/forearm_direction",
            json!([1.0, 1.0, 0.0]),
        ),
        ("/robot/chain/published/links_m/4", json!(0.0)),
        ("/robot/chain/published/ankle_offset_rad", json!(6.3)),
        ("/robot/chain/fixed_arm/forearm_rad/1", json!(-6.3)),
        ("/robot/postures/1/name", json!("crouch")),
        ("/robot/postures/1/name", json!("")),
        ("/robot/postures/0/angles_rad", json!([0.0, 0.1])),
        ("/robot/postures/0/angles_rad/5", json!(6.3)),
        ("/robot/study/start_posture", json!("dance")),
        ("/robot/study/stops/0/range_rad", json!([-1.0, 6.3])),
        ("/robot/study/stops/0/joint", json!("RHipPitch")),
        (
            "/robot/imu/accelerometer_m_s2/standard_deviation",
            json!(-0.1),
        ),
        ("/robot/imu/gyroscope_rad_s/bias_bound", json!(10.5)),
        ("/robot/control/command_step_s", json!(0.0)),
        ("/robot/control/gear_efficiency", json!(1.1)),
        ("/robot/joints/0/servo_stiffness_nm_rad", json!(-1.0)),
        ("/robot/control/steering/yaw", json!(-0.1)),
        ("/robot/control/uphill_rad", json!(1.6)),
        ("/robot/search/least_advance_m", json!(0.0)),
        ("/robot/search/upper_arm_rad", json!([-0.3, -1.7])),
        ("/robot/lying_length_m", json!(600.0)),
        ("/family", json!(null)),
        ("/version", json!(null)),
        ("/version", json!("../v4")),
        ("/sources_sha256", json!("0123")),
        ("/sources_sha256", json!("F0".repeat(32))),
        ("/engine", json!(long)),
    ];
    let lines = refusals.map(|(pointer, value)| {
        let said = refusal(&changed(pointer, value.clone()));
        let value = value.to_string();
        let value = if value.len() > 60 {
            "a long name"
        } else {
            &value
        };
        format!("{pointer} = {value}\n    {said}\n")
    });
    insta::assert_snapshot!(lines.concat());
}

/// Limits by another joint, and the gains that hold a line.
#[test]
fn limit_what_no_limit_by_another_joint_and_no_gain_is() {
    let refusals = [
        ("/robot/control/steering/yaw_sum", json!(-0.1)),
        ("/robot/control/steering/aside_rad_m", json!(100.5)),
        ("/robot/control/steering/ahead_m", json!(-0.4)),
        ("/robot/coupled_limits/0/joint", json!("Tail")),
        ("/robot/coupled_limits/0/joint", json!("HeadYaw")),
        ("/robot/coupled_limits/0/by", json!("Tail")),
        ("/robot/coupled_limits/0/table_rad", json!([])),
        ("/robot/coupled_limits/0/table_rad/1/0", json!(-3.0)),
        ("/robot/coupled_limits/0/table_rad/1/1", json!(0.5)),
        ("/robot/coupled_limits/0/table_rad/1/2", json!(700.0)),
    ];
    let refusals = refusals.map(|(pointer, value)| refusal(&changed(pointer, value)));
    insta::assert_snapshot!(refusals.join("\n"));
}

#[test]
fn limit_motors_that_no_robot_has_are_refused_with_place_and_bound() {
    let refusals = [
        ("/robot/joints/0/speed_limit_rad_s", json!(8.27)),
        ("/robot/joints/2/effort_limit_nm", json!(3.0)),
        ("/robot/shared_motors", json!([["LHipYawPitch"]])),
        (
            "/robot/shared_motors",
            json!([["LHipYawPitch", "LHipYawPitch"]]),
        ),
        ("/robot/shared_motors", json!([["LHipYawPitch", "HipYaw"]])),
    ];
    let lines = refusals.map(|(pointer, value)| refusal(&changed(pointer, value)) + "\n");
    insta::assert_snapshot!(lines.concat(), @r#"
    nao.json: robot.joints[0].speed_limit_rad_s: speed limit 8.27 rad/s of HeadYaw is above the no-load speed of its motor, 7.457 rad/s
    nao.json: robot.shared_motors: joints that share the motor of "LHipYawPitch" have other figures
    nao.json: robot.shared_motors[0]: a motor is shared by two joints or more
    nao.json: robot.shared_motors[0][1]: "LHipYawPitch" is there twice
    nao.json: robot.shared_motors[0][1]: "HipYaw" is none of the joints
    "#);
}

/// Lists that are too long: what reads them takes time and memory by their length.
#[test]
fn limit_lists_are_bounded() {
    let longer = |list: &str, most: usize| {
        let document: Value = serde_json::from_str(shipped::NAO.compiled).unwrap();
        let first = &document.pointer(list).unwrap()[0];
        refusal(&changed(list, json!(vec![first; most + 1])))
    };
    let refusals = [
        longer("/robot/bodies", 250),
        longer("/robot/joints", 250),
        longer("/robot/shapes", 2_000),
        longer("/robot/postures", 1_000),
    ];
    insta::assert_snapshot!(refusals.join("\n"), @r"
    nao.json: robot.bodies: 251 are more than 250
    nao.json: robot.joints: 251 are more than 250
    nao.json: robot.shapes: 2001 are more than 2000
    nao.json: robot.postures: 1001 are more than 1000
    ");
}

#[test]
fn limit_what_is_no_compiled_robot_is_refused() {
    let text = shipped::NAO.compiled;
    let mut lines = text.lines().map(|line| line.trim().trim_end_matches(','));
    let height = lines
        .find(|line| line.contains("standing_height_m"))
        .unwrap();
    let without = |line: &str| {
        assert_eq!(text.matches(line).count(), 1, "{line}");
        text.replacen(line, "", 1)
    };
    let refusals = [
        refusal(""),
        refusal("{}"),
        refusal("[1, 2]"),
        refusal(&text[..text.len() / 2]),
        refusal(&format!("{text}{text}")),
        refusal(&changed("/format", json!("prone-run"))),
        refusal(&changed("/format_version", json!(1))),
        refusal(&without(&format!("    {height},\n"))),
        refusal(&text.replacen("\"imu\"", "\"imus\"", 1)),
        refusal(&text.replacen("\"span_m\"", "\"span_m\": 1.0, \"span_m\"", 1)),
        refusal(&text.replacen(height, "\"standing_height_m\": NaN", 1)),
        refusal(&text.replacen(height, "\"standing_height_m\": 1e999", 1)),
        refusal(&text.replacen(height, "\"standing_height_m\": \"0.5\"", 1)),
        refusal(&changed("/robot/joints/0/axis", json!([0, 0, 1, 0]))),
        refusal(&changed("/robot/joints/0/axis", json!([0, 1]))),
        refusal(&changed("/robot/joints/0/range_rad/0", json!(null))),
        refusal(&changed("/robot/bodies/1/contact_group", json!("arm"))),
        refusal(&changed("/robot/shapes/0/solid", json!({"mesh": {}}))),
    ];
    insta::assert_snapshot!(refusals.join("\n"));
}

#[test]
fn limit_only_a_regular_file_of_a_sane_size_is_read() {
    let home = tempfile::tempdir().unwrap();
    let refusal = |name: &str| {
        let error = CompiledRobot::read(&home.path().join(name)).unwrap_err();
        error
            .to_string()
            .replace(&home.path().display().to_string(), "home")
    };
    let large = std::fs::File::create(home.path().join("large")).unwrap();
    large.set_len(crate::text_file::LARGEST_BYTES + 1).unwrap();
    let refusals = [refusal("."), refusal("large"), refusal("nothing")];
    insta::assert_snapshot!(refusals.join("\n"), @r"
    cannot read home/.: it is not a regular file
    cannot read home/large: it is larger than 16 MiB
    cannot read home/nothing: No such file or directory (os error 2)
    ");
    let path = home.path().join("nao.json");
    std::fs::write(&path, shipped::NAO.compiled).unwrap();
    assert_eq!(CompiledRobot::read(&path).unwrap(), nao());
}

/// The sources of the NAO with a longer span.
fn changed_sources(folder: &str) -> RobotFiles {
    let mut sources = sources();
    sources.folder = folder.to_owned();
    sources.toml = sources
        .toml
        .replacen("span_mm = 430.0", "span_mm = 431.0", 1);
    sources
}

#[test]
fn a_stale_robot_is_refused_with_the_command_that_renews_it() {
    let nao = nao();
    assert!(nao.check_fresh("nao.json", &sources()).is_ok());
    let changed = changed_sources("robots/nao/v4");
    let error = nao.check_fresh("nao.json", &changed).unwrap_err();
    let error = error.to_string().replace(nao.sources_hash(), "<theirs>");
    insta::assert_snapshot!(error.replace(&changed.hash(), "<ours>"), @"nao.json is stale: it was compiled from sources with the hash <theirs>, and those in robots/nao/v4 have <ours>; `prone robot compile robots/nao/v4 --out nao.json` renews it");
}

#[test]
fn beside_its_sources_a_robot_is_read_while_it_is_fresh() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().display().to_string();
    let fresh = RobotFiles {
        folder: folder.clone(),
        ..sources()
    };
    let read = CompiledRobot::read_beside(&fresh);
    assert!(matches!(read, Err(CompiledRobotError::Read { .. })));
    std::fs::write(home.path().join(FILE_NAME), shipped::NAO.compiled).unwrap();
    assert_eq!(CompiledRobot::read_beside(&fresh).unwrap(), nao());
    let stale = CompiledRobot::read_beside(&changed_sources(&folder)).unwrap_err();
    let renewal = format!("; `prone robot compile {folder}` renews it");
    assert!(stale.to_string().ends_with(&renewal), "{stale}");
    let elsewhere = nao().check_fresh("/tmp/nao.json", &changed_sources(&folder));
    let elsewhere = elsewhere.unwrap_err().to_string();
    let renewal = format!("; `prone robot compile {folder} --out /tmp/nao.json` renews it");
    assert!(elsewhere.ends_with(&renewal), "{elsewhere}");
}

#[test]
fn a_robot_knows_its_family_and_version() {
    let nao = nao();
    let version = nao.version().unwrap();
    assert_eq!(
        (version.family.as_str(), version.version.as_str()),
        ("nao", "v4")
    );
    let alone = RobotFiles {
        version: None,
        ..sources()
    };
    let alone = CompiledRobot::new(nao.robot(), &alone, String::new()).unwrap();
    assert!(alone.version().is_none());
    assert_eq!(
        CompiledRobot::parse("alone.json", &alone.text()).unwrap(),
        alone
    );
}
