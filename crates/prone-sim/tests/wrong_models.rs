//! The shipped NAO with one change that no robot has: refused with its place.

mod changed;

use std::fs;

use changed::{SAME, changed};
use prone_files::robot_folder::RobotFolderError;
use prone_files::shipped::NAO;
use prone_files::text_file::ReadError;
use prone_sim::{LoadedRobot, RobotFiles};

/// The message for one change in `robot.xml`.
fn model(from: &str, to: &str) -> String {
    message(changed(SAME, (from, to)))
}

/// The message for one change in `robot.toml`.
fn table(from: &str, to: &str) -> String {
    message(changed((from, to), SAME))
}

fn message(files: RobotFiles) -> String {
    LoadedRobot::load(files).unwrap_err().to_string()
}

/// `from`, `to`, message.
type Refusal = (&'static str, &'static str, &'static str);

const MODELS: &[Refusal] = &[
    (
        "<worldbody>",
        "<worldbody><geom name=\"ramp\" type=\"box\" size=\"1 1 .1\"/>",
        "nao/robot.xml: geom ramp belongs to the world; the floor is added by the program",
    ),
    (
        "</equality>",
        "<connect name=\"hook\" body1=\"torso\" anchor=\"0 0 .1\"/></equality>",
        "nao/robot.xml: equality hook ties the robot to the world",
    ),
    (
        "</equality>",
        "<weld body1=\"LHand\" body2=\"RHand\"/></equality>",
        "nao/robot.xml:240:3: <weld> is not read here: bodies that do not move against each other are one body, or fixed to it",
    ),
    (
        "</equality>",
        "<joint joint1=\"LKneePitch\" polycoef=\"0.5 0 0 0 0\"/></equality>",
        "nao/robot.xml:240:3: it holds a joint still, where a robot has none: it names no joint2",
    ),
    (
        "</equality>",
        "<joint joint1=\"LKneePitch\" joint2=\"RKneePitch\" polycoef=\"0 0 1 0 0\"/></equality>",
        "nao/robot.xml:240:3: polycoef: a joint follows another in a straight line, with a ratio of 0.05 to 20",
    ),
    (
        "</worldbody>\n\n  <equality>",
        "<site name=\"hook\"/></worldbody><equality><connect name=\"held\" site1=\"imu\" site2=\"hook\"/>",
        "nao/robot.xml: equality held ties the robot to the world",
    ),
    (
        "<equality>",
        "<contact><exclude name=\"through\" body1=\"world\" body2=\"LFoot\"/></contact><equality>",
        "nao/robot.xml: exclude through keeps a body from touching the world",
    ),
    (
        "name=\"LKneePitch\" axis=\"0 1 0\"",
        "name=\"LKneePitch\" actuatorfrcrange=\"-1 1\" axis=\"0 1 0\"",
        "nao/robot.xml: joint LKneePitch has actuatorfrcrange; what servos do is set by the program, from robot.toml",
    ),
    (
        "name=\"LKneePitch\" axis=\"0 1 0\"",
        "name=\"LKneePitch\" actuatorgravcomp=\"true\" axis=\"0 1 0\"",
        "nao/robot.xml: joint LKneePitch has actuatorgravcomp; what servos do is set by the program, from robot.toml",
    ),
    (
        "name=\"LKneePitch\" axis=\"0 1 0\"",
        "name=\"LKneePitch\" ref=\".1\" axis=\"0 1 0\"",
        "nao/robot.xml: joint LKneePitch has ref 0.1 rad; it must be 0: the zero pose is the standing one",
    ),
    (
        "contype=\"0\" conaffinity=\"1\"",
        "contype=\"0\" conaffinity=\"0\"",
        "nao/robot.xml: no geom can touch the floor: none has conaffinity 1 or contype 1",
    ),
    (
        "contype=\"0\" conaffinity=\"1\"",
        "contype=\"2\" conaffinity=\"2\"",
        "nao/robot.xml: no geom can touch the floor: none has conaffinity 1 or contype 1",
    ),
    (
        "<default>",
        "<size memory=\"1000G\"/><default>",
        "nao/robot.xml:24:3: <size> is not read here: the engine finds its sizes itself",
    ),
    (
        "<asset>",
        "<asset>\n<hfield name=\"h\" nrow=\"-1\" ncol=\"2\" size=\"1 1 1 1\"/>",
        "nao/robot.xml:34:1: <hfield> is not read here: robots are made of primitives",
    ),
    (
        "<asset>",
        "<asset>\n<texture name=\"t\" type=\"2d\" builtin=\"flat\" width=\"-1\" height=\"-1\"/>",
        "nao/robot.xml:34:1: <texture> is not read here: robots are made of primitives",
    ),
    (
        "<asset>",
        "<asset><mesh file=\"a.stl\"/>",
        "nao/robot.xml:33:10: <mesh> is not read here: robots are made of primitives",
    ),
    (
        "<asset>",
        "<asset><skin file=\"a.skn\"/>",
        "nao/robot.xml:33:10: <skin> is not read here: robots are made of primitives",
    ),
    (
        "<asset>",
        "<include file=\"b.xml\"/><asset>",
        "nao/robot.xml:33:3: <include> is not read here: a model is one file",
    ),
    (
        "<asset>",
        "<actuator><motor joint=\"HeadYaw\"/></actuator><asset>",
        "nao/robot.xml:33:3: <actuator> is not read here: servos are added by the program, from robot.toml",
    ),
    (
        "<asset>",
        "<keyframe/><asset>",
        "nao/robot.xml:33:3: <keyframe> is not read here: postures are in robot.toml",
    ),
    (
        "<asset>",
        "<tendon/><asset>",
        "nao/robot.xml:33:3: <tendon> is not read here: a robot needs none",
    ),
    (
        "<gyro name=\"Gyrometer\" site=\"imu\"/>",
        "<touch site=\"imu\"/>",
        "nao/robot.xml:245:5: <touch> is not read here: a robot needs none",
    ),
    (
        "<gyro name=\"Gyrometer\" site=\"imu\"/>",
        "<gyro name=\"Gyrometer\" site=\"imu\" nsample=\"100000000\"/>",
        "nao/robot.xml:245:39: nsample of <gyro> is not read here: a sensor has a name and a site; its noise is in robot.toml",
    ),
    (
        "<gyro name=\"Gyrometer\" site=\"imu\"/>",
        "",
        "nao/robot.toml:392:8: nao/robot.xml has no gyro at site imu",
    ),
    (
        "<accelerometer name=\"Accelerometer\" site=\"imu\"/>",
        "<accelerometer name=\"Accelerometer\" site=\"LToe\"/>",
        "nao/robot.toml:392:8: nao/robot.xml has no accelerometer at site imu",
    ),
    (
        "<mujoco model",
        "\0<mujoco model",
        "nao/robot.xml:21:1: a zero byte in a text file",
    ),
    (
        "</mujoco>",
        "",
        "nao/robot.xml:1:1: the root node was opened but never closed",
    ),
    (
        "<mujoco model",
        "<!DOCTYPE m [<!ENTITY a \"b\">]><mujoco model",
        "nao/robot.xml:1:1: XML with DTD detected",
    ),
    (
        "name=\"LThighShell\" type=\"capsule\" size=\".038\"",
        "name=\"LThighShell\" type=\"capsule\" size=\"nan\"",
        "nao/robot.xml:92:53: size: NaN is outside -1e9..1e9",
    ),
    (
        "mass=\"1.04956\"",
        "mass=\"inf\"",
        "nao/robot.xml:45:17: mass: inf is outside -1e9..1e9",
    ),
    (
        "mass=\"1.04956\"",
        "mass=\"1e12\"",
        "nao/robot.xml:45:17: mass: 1000000000000 is outside -1e9..1e9",
    ),
    (
        "mass=\"1.04956\"",
        "mass=\"10495.6\"",
        "nao/robot.xml:45:17: mass: 10495.6 is outside 0..1000 kg: no body weighs less than nothing, or more than a car",
    ),
    (
        "body name=\"LTibia\" pos=\"0 0 -.1\"",
        "body name=\"LTibia\" pos=\"0 0 -100\"",
        "nao/robot.xml:94:33: body LTibia: pos -100 m is outside -10..10 m",
    ),
    (
        "name=\"LThighShell\" type=\"capsule\" size=\".038\"",
        "name=\"LThighShell\" type=\"capsule\" size=\"38\"",
        "nao/robot.xml:92:53: geom LThighShell: size 38 m is outside -10..10 m",
    ),
    (
        "site name=\"LToe\" pos=\".0935 0 -.04519\"",
        "site name=\"LToe\" pos=\"93.5 0 -45.19\"",
        "nao/robot.xml:114:37: site LToe: pos 93.5 m is outside -10..10 m",
    ),
    (
        "body name=\"RTibia\" pos=\"0 0 -.1\"",
        "body name=\"RTibia\" pos=\"0 0 -.11\"",
        "nao/robot.toml:26:7: the right toe leaves the sagittal chain by 10.000 mm when the joints move: its joints and sites are not those of one limb, or left and right differ",
    ),
    (
        "<joint armature=\".005\"/>",
        "<joint armature=\".005\" damping=\"-50\"/>",
        "nao/robot.xml:25:28: damping: -50 is outside 0..1000 N·m·s/rad: damping takes energy out, and lets a joint move",
    ),
    (
        "<joint armature=\".005\"/>",
        "<joint armature=\"-1\"/>",
        "nao/robot.xml:25:12: armature: -1 is outside 0..100 kg·m²: a rotor resists turning, and no more than a robot does",
    ),
    (
        "<joint armature=\".005\"/>",
        "<joint armature=\".005\" stiffness=\"-1000\"/>",
        "nao/robot.xml:25:28: stiffness: -1000 is outside 0..100000 N·m/rad: a spring pulls back, and lets a joint move",
    ),
    (
        "<joint armature=\".005\"/>",
        "<joint armature=\".005\" frictionloss=\"-1\"/>",
        "nao/robot.xml:25:28: frictionloss: -1 is outside 0..1000 N·m: dry friction takes energy out, and a motor overcomes it",
    ),
    (
        "<joint armature=\".005\"/>",
        "<joint armature=\".005\" frictionloss=\"2\"/>",
        "nao/robot.xml:56:9: joint HeadYaw: frictionloss 2 is outside 0..0.6447 N·m: half of what its motor gives is left after the dry friction",
    ),
    (
        "<joint armature=\".005\"/>",
        "<joint armature=\".005\" damping=\"20\"/>",
        "nao/robot.xml:56:9: joint HeadYaw: damping 20 is outside 0..3.4613 N·m·s/rad: its motor moves it at a twentieth of its speed limit",
    ),
    (
        "<joint armature=\".005\"/>",
        "<joint armature=\".005\" stiffness=\"100\"/>",
        "nao/robot.xml:56:9: joint HeadYaw: stiffness 100 is outside 0..1.2363 N·m/rad: its motor moves it against the spring",
    ),
    (
        "<joint armature=\".005\"/>",
        "<joint armature=\"50\"/>",
        "nao/robot.xml:56:9: joint HeadYaw: armature 50 is outside 0..0.1895 kg·m²: its motor turns its own rotor, which is a part of the robot",
    ),
    (
        "<body name=\"torso\"",
        "<body gravcomp=\"1000000\" name=\"torso\"",
        "nao/robot.xml:43:11: gravcomp: 1000000 is outside 0..0: gravity acts on all of a robot",
    ),
    (
        "<compiler angle",
        "<compiler settotalmass=\"1e-6\" angle",
        "nao/robot.xml:22:13: the mass of the robot 1.000e-6 is outside 0.05..500 kg: no humanoid is lighter or heavier",
    ),
    (
        "<compiler angle",
        "<compiler settotalmass=\".06\" angle",
        "nao/robot.xml:22:13: of a robot whose chain is 0.604 m long the mass 0.06 is outside 0.22028..33.0424 kg: a body of that size is no lighter or heavier",
    ),
    (
        "<compiler angle",
        "<compiler settotalmass=\"500\" angle",
        "nao/robot.xml:22:13: the mass of the robot 500 is outside 0.05..500 kg: no humanoid is lighter or heavier",
    ),
    (
        "mass=\"1.04956\"",
        "mass=\"999\"",
        "nao/robot.xml:45:17: the mass of the robot 1003.14579 is outside 0.05..500 kg: no humanoid is lighter or heavier",
    ),
    (
        "pos=\"-.00413 0 .04342\"",
        "pos=\"-.00413 0 .4342\"",
        "nao/robot.xml:45:32: body torso: z of the centre of mass, 0.4342 is outside -0.16047..0.20747 m: it is within what the body's hinges and shapes reach to, and a margin",
    ),
    (
        "fullinertia=\".00308361 .0028835 .0015924 1.43116e-5 -3.30211e-5 -2.70793e-5\"",
        "fullinertia=\"308361 288350 159240 0 0 0\"",
        "nao/robot.xml:46:17: body torso: inertia 308361 kg·m² is outside -100000..100000 kg·m²",
    ),
    (
        "name=\"RKneePitch\" axis=\"0 1 0\"",
        "name=\"RKneePitch\" axis=\"0 -1 0\"",
        "nao/robot.xml:140:54: the stops of LKneePitch and RKneePitch do not mirror each other: RKneePitch has -0.0923..2.1125 rad, and the image of LKneePitch is -2.1125..0.0923 rad: 2.0202 rad apart, more than the 0.2 rad allowed, as both sides are commanded alike",
    ),
    (
        "name=\"RHipRoll\" axis=\"1 0 0\"",
        "name=\"RHipRoll\" axis=\"1 .2 0\"",
        "nao/robot.xml:129:34: the axes of LHipRoll and RHipRoll do not mirror each other: 0.1974 rad apart, more than the 0.05 rad allowed, as both sides are commanded alike",
    ),
    (
        "name=\"RHipRoll\" axis=\"1 0 0\" range=\"-.7905 .3795\"",
        "name=\"RHipRoll\" axis=\"1 0 0\" range=\"-.3795 .7905\"",
        "nao/robot.xml:129:47: the stops of LHipRoll and RHipRoll do not mirror each other: RHipRoll has -0.3795..0.7905 rad, and the image of LHipRoll is -0.7905..0.3795 rad: 0.411 rad apart, more than the 0.2 rad allowed, as both sides are commanded alike",
    ),
    (
        "class=\"visual\" type=\"capsule\" size=\".022\"",
        "class=\"%s%s%s%s%s\" type=\"capsule\" size=\".022\"",
        "nao/robot.xml:49:32: class: no <default> defines the class %s%s%s%s%s",
    ),
    (
        "<site name=\"LToe\"",
        "<site user=\"1 1\" name=\"LToe\"",
        "nao/robot.xml:114:25: user of <site> is not read here: nothing uses such numbers, and their memory has no bound",
    ),
    (
        "name=\"RAnkleRoll\" axis=\"1 0 0\"",
        "name=\"RAnkleRoll\" frictionloss=\"1\" axis=\"1 0 0\"",
        "nao/robot.xml:153:44: frictionloss of LAnkleRoll and RAnkleRoll differ: 0 and 1 N·m, more than the 0.2500 N·m allowed, as both sides are commanded alike",
    ),
    (
        "<joint armature=\".005\"/>",
        "<joint armature=\".005\" margin=\"1\"/>",
        "nao/robot.xml:25:28: margin: 1 is outside 0..0.01 rad: a stop acts at its angle",
    ),
    (
        "solref=\".02 1\"",
        "solref=\"-1000 -.001\"",
        "nao/robot.xml:26:49: solref: -1000 -0.001 is neither a time constant of 0.0001 to 0.5 s with a damping ratio of 0.05 to 20, nor minus a stiffness and minus a damping of the same: a contact like that would not hold",
    ),
    (
        "<inertial mass=\"1.04956\" pos=\"-.00413 0 .04342\"\n                fullinertia=\".00308361 .0028835 .0015924 1.43116e-5 -3.30211e-5 -2.70793e-5\"/>",
        "<inertial mass=\"1.04956\" pos=\"-.00413 0 .04342\" diaginertia=\".308361 .28835 .15924\"/>",
        "nao/robot.xml:45:7: body torso: with 3.084e-1 kg·m² and 1.04956 kg its radius of gyration 5.42e-1 m is outside 6.0e-4..0.281 m: its mass is within what it reaches to",
    ),
];

/// Every refusal has its message.
fn check(refusals: &[Refusal], message: fn(&str, &str) -> String) {
    let wrong: Vec<String> = refusals
        .iter()
        .map(|(from, to, expected)| (message(from, to), expected))
        .filter(|(found, expected)| found != *expected)
        .map(|(found, expected)| format!("found    {found}\nexpected {expected}\n"))
        .collect();
    assert!(wrong.is_empty(), "\n{}", wrong.concat());
}

#[test]
fn models_that_are_no_robot_are_refused() {
    check(MODELS, model);
}

const TABLES: &[Refusal] = &[
    (
        "model = \"robot.xml\"",
        "model = \"../robot.xml\"",
        "nao/robot.toml:5:9: model must be the name of a file beside this one, not \"../robot.xml\"",
    ),
    (
        "model = \"robot.xml\"",
        "model = \"/etc/passwd\"",
        "nao/robot.toml:5:9: model must be the name of a file beside this one, not \"/etc/passwd\"",
    ),
    (
        "model = \"robot.xml\"",
        "model = \"..\"",
        "nao/robot.toml:5:9: model must be the name of a file beside this one, not \"..\"",
    ),
    (
        "model = \"robot.xml\"",
        "model = \"\"",
        "nao/robot.toml:5:9: model must be the name of a file beside this one, not \"\"",
    ),
    (
        "model = \"robot.xml\"",
        "model = \"a\\u0000b\"",
        "nao/robot.toml:5:9: model must be the name of a file beside this one, not \"a\\0b\"",
    ),
    (
        "knee = \"LKneePitch\"\nhip = \"LHipPitch\"",
        "knee = \"LHipPitch\"\nhip = \"LKneePitch\"",
        "nao/robot.toml:17:8: knee LHipPitch does not hang on hip LKneePitch",
    ),
    (
        "knee = \"LKneePitch\"",
        "knee = \"LHipPitch\"",
        "nao/robot.toml:18:7: joint LHipPitch is the left knee already",
    ),
    (
        "knee = \"RKneePitch\"",
        "knee = \"LKneePitch\"",
        "nao/robot.toml:28:8: joint LKneePitch is the left knee already",
    ),
    (
        "knee = \"LKneePitch\"\nhip = \"LHipPitch\"",
        "knee = \"LKneePitch\"\nhip = \"HeadPitch\"",
        "nao/robot.toml:17:8: knee LKneePitch does not hang on hip HeadPitch",
    ),
    (
        "shoulder = \"LShoulderPitch\"",
        "shoulder = \"HeadPitch\"",
        "nao/robot.toml:20:17: shoulder_roll LShoulderRoll does not hang on shoulder HeadPitch",
    ),
    (
        "toe = \"LToe\"",
        "toe = \"LKnee\"",
        "nao/robot.toml:15:7: toe LKnee does not hang on ankle LAnklePitch",
    ),
    (
        "toe = \"LToe\"",
        "toe = \"RToe\"",
        "nao/robot.toml:15:7: toe RToe does not hang on ankle LAnklePitch",
    ),
    (
        "elbow = \"LElbow\"\n",
        "elbow = \"LShoulder\"\n",
        "nao/robot.toml:21:9: elbow LShoulder does not hang on shoulder_roll LShoulderRoll",
    ),
    (
        "elbow = \"LElbow\"\n",
        "elbow = \"LHip\"\n",
        "nao/robot.toml:21:9: elbow LHip does not hang on shoulder_roll LShoulderRoll",
    ),
    (
        "[\"LElbowYaw\", \"LElbowRoll\"]\nforearm_direction",
        "[\"LElbowRoll\", \"LElbowYaw\"]\nforearm_direction",
        "nao/robot.toml:22:26: lower forearm joint LElbowYaw does not hang on upper forearm joint LElbowRoll",
    ),
    (
        "[\"LElbowYaw\", \"LElbowRoll\"]\nforearm_direction",
        "[\"LElbowYaw\", \"LWristYaw\"]\nforearm_direction",
        "nao/robot.toml:15:7: LWristYaw does not point the forearm: it turns about the forearm itself",
    ),
    (
        "[\"LElbowYaw\", \"LElbowRoll\"]\nforearm_direction",
        "[\"RElbowYaw\", \"LElbowRoll\"]\nforearm_direction",
        "nao/robot.toml:33:12: joint RElbowYaw is the left upper forearm already",
    ),
    (
        "knee = \"LKneePitch\"",
        "knee = \"LAnkleRoll\"",
        "nao/robot.toml:16:9: ankle LAnklePitch does not hang on knee LAnkleRoll",
    ),
    (
        "standing_height_mm = 574.0",
        "standing_height_mm = 574000.0",
        "nao/robot.toml:6:22: standing_height_mm must be at most 10000, not 574000",
    ),
    (
        "no_load_rpm = 10700.0",
        "no_load_rpm = -1.0",
        "nao/robot.toml:72:15: no_load_rpm must be positive and finite, not -1",
    ),
    (
        "span_mm = 430.0",
        "span_mm = 430000.0",
        "nao/robot.toml:11:11: span_mm must be at most 10000, not 430000",
    ),
    (
        "span_mm = 430.0",
        "span_mm = nan",
        "nao/robot.toml:11:11: span_mm must be positive and finite, not NaN",
    ),
    (
        "ankle_offset_deg = 60.0",
        "ankle_offset_deg = 6000.0",
        "nao/robot.toml:15:7: ankle_offset_deg must be within -360..360, not 6000",
    ),
    (
        "forearm_deg = [-90.0, -87.0]",
        "forearm_deg = [inf, -87.0]",
        "nao/robot.toml:15:7: every one of forearm_deg must be within -360..360, not inf",
    ),
    (
        "effort_nm = 1.547",
        "effort_nm = 1547.0",
        "nao/robot.toml:80:13: effort_nm must be at most 1000, not 1547",
    ),
    (
        "speed_rad_s = 7.45",
        "speed_rad_s = inf",
        "nao/robot.toml:81:15: speed_rad_s must be positive and finite, not inf",
    ),
    (
        "servo_stiffness_nm_rad = 80.0",
        "servo_stiffness_nm_rad = 2e9",
        "nao/robot.toml:82:26: servo_stiffness_nm_rad must be at most 100000, not 2000000000",
    ),
    (
        "ratio = 150.27",
        "ratio = 1e9",
        "nao/robot.toml:84:9: ratio must be at most 100000, not 1000000000",
    ),
    (
        "nominal_mnm = 6.2",
        "nominal_mnm = 6.2e9",
        "nao/robot.toml:70:15: nominal_mnm must be at most 1000000, not 6200000000",
    ),
    (
        "LHipPitch = [-1.5359, 0.8]",
        "LHipPitch = [-88.0, 45.0]",
        "nao/robot.toml:194:1: a range needs -2π <= lower < upper <= 2π, not -88..45",
    ),
    (
        "LHipPitch = 0.4712",
        "LHipPitch = 27.0",
        "nao/robot.toml:198:1: LHipPitch must be within -2π..2π rad, not 27",
    ),
    (
        "LHipPitch = 0.4712",
        "LHipPitch = nan",
        "nao/robot.toml:198:1: LHipPitch must be within -2π..2π rad, not NaN",
    ),
    (
        "site = \"imu\"",
        "site = \"inu\"",
        "nao/robot.toml:392:8: there is no site \"inu\" in nao/robot.xml; did you mean \"imu\"?",
    ),
    (
        "site = \"imu\"",
        "site = \"LToe\"",
        "nao/robot.toml:392:8: site LToe is on LFoot; the inertial unit must be on the root torso",
    ),
    (
        "gyroscope_noise_rad_s = 0.0009",
        "gyroscope_noise_rad_s = -0.0009",
        "nao/robot.toml:392:8: gyroscope_noise_rad_s must be within 0..10, not -0.0009",
    ),
    (
        "accelerometer_bias_m_s2 = 0.05",
        "accelerometer_bias_m_s2 = nan",
        "nao/robot.toml:392:8: accelerometer_bias_m_s2 must be within 0..100, not NaN",
    ),
    (
        "command_step_ms = 10.0",
        "command_step_ms = 0.0",
        "nao/robot.toml:401:19: command_step_ms must be positive and finite, not 0",
    ),
    (
        "command_step_ms = 10.0",
        "command_step_ms = 10000.0",
        "nao/robot.toml:401:19: command_step_ms must be at most 1000, not 10000",
    ),
    (
        "gear_efficiency = 0.6",
        "gear_efficiency = 1.1",
        "nao/robot.toml:402:19: gear_efficiency must be within 0.05..1, not 1.1",
    ),
    (
        "speed_rad_s = 7.45          # published 8.27",
        "speed_rad_s = 8.27",
        "nao/robot.toml:81:15: speed limit 8.27 rad/s of HeadYaw is above the no-load speed of its motor, 7.457 rad/s",
    ),
    (
        "joints = [\"LHipRoll\", \"LAnkleRoll\", \"RHipRoll\", \"RAnkleRoll\"]\n",
        "joints = [\"LHipRoll\", \"LAnkleRoll\", \"RHipRoll\", \"RAnkleRoll\"]\none_motor = true\n",
        "nao/robot.toml:104:23: one_motor: no equality of nao/robot.xml keeps joint LAnkleRoll at the angle of LHipRoll",
    ),
    (
        "uphill_deg = 1.5",
        "uphill_deg = 150.0",
        "nao/robot.toml:403:14: uphill_deg must be at most 90, not 150",
    ),
    (
        "yaw = 0.8",
        "yaw = -0.9",
        "nao/robot.toml:409:7: yaw must be within 0..100, not -0.9",
    ),
    (
        "lateral_rad_m = 2.0",
        "lateral_rad_m = 200.0",
        "nao/robot.toml:410:17: lateral_rad_m must be within 0..100, not 200",
    ),
    (
        "lateral_sum_rad_m = 0.3",
        "lateral_sum_rad_m = inf",
        "nao/robot.toml:411:21: lateral_sum_rad_m must be within 0..100, not inf",
    ),
    (
        "least_advance_mm = 120.0",
        "least_advance_mm = 0.0",
        "nao/robot.toml:419:20: least_advance_mm must be positive and finite, not 0",
    ),
    (
        "upper_arm_rad = [-1.75, -0.35]",
        "upper_arm_rad = [-0.35, -1.75]",
        "nao/robot.toml:420:18: a range needs -2π <= lower < upper <= 2π, not -0.35..-1.75",
    ),
    (
        "upper_arm_rad = [-1.75, -0.35]",
        "upper_arm_rad = [-100.0, -20.0]",
        "nao/robot.toml:420:18: a range needs -2π <= lower < upper <= 2π, not -100..-20",
    ),
    (
        "upper_arm_rad = [-1.75, -0.35]",
        "upper_arm_rad = [-1.75]",
        "nao/robot.toml:420:17: invalid length 1, expected an array of exactly 2 values",
    ),
    (
        "lying_length_mm = 600.0",
        "lying_length_mm = 600000.0",
        "nao/robot.toml:423:19: lying_length_mm must be at most 10000, not 600000",
    ),
    (
        "[control]\ncommand_step_ms = 10.0\n",
        "[control]\ncommand_step_ms = 10.0\nservo_rate_per_s = 20.0\n",
        "nao/robot.toml:402:1: unknown field `servo_rate_per_s`, expected one of `command_step_ms`, `gear_efficiency`, `uphill_deg`, `steering`; docs/robot.md describes every section and key",
    ),
    (
        "[control]\ncommand_step_ms = 10.0\n",
        "[control]\n",
        "nao/robot.toml:400:1: missing field `command_step_ms`; docs/robot.md describes every section and key",
    ),
    (
        "by = \"HeadYaw\"",
        "by = \"HeadPitch\"",
        "nao/robot.toml:163:9: a joint cannot limit itself",
    ),
    (
        "by = \"HeadYaw\"",
        "by = \"HeadJaw\"",
        "nao/robot.toml:164:6: there is no joint \"HeadJaw\" in nao/robot.xml; did you mean \"HeadYaw\"?",
    ),
    (
        "[-87.49, -18.91, 11.46], [-62.45",
        "[-187.49, -18.91, 11.46], [-62.45",
        "nao/robot.toml:163:9: the angle of line 2 is not above that of the line before",
    ),
    (
        "yaw_sum = 0.3",
        "yaw_sum = -0.3",
        "nao/robot.toml:413:11: yaw_sum must be within 0..100, not -0.3",
    ),
    (
        "[control.steering]\nyaw = 0.8\nlateral_rad_m = 2.0\nlateral_sum_rad_m = 0.3\naside_rad_m = 0.7             # these three of cycles that can be shifted\nyaw_sum = 0.3\nahead_m = 0.4                 # between elbows and head: a turn slides the trunk 5 mm to the other side per degree\n",
        "",
        "nao/robot.toml:400:1: missing field `steering`; docs/robot.md describes every section and key",
    ),
    (
        "[search]\nleast_advance_mm = 120.0\nupper_arm_rad = [-1.75, -0.35]\n",
        "",
        "nao/robot.toml:1:1: missing field `search`; docs/robot.md describes every section and key",
    ),
    (
        "nominal_mnm = 16.1",
        "nominal_mnm = 99999.0",
        "nao/robot.toml:60:15: joint LHipYawPitch: nominal (continuous) torque 20129.7987 is outside 0.01369..13.6884 N·m at the joint: what a motor gives for ever is a part of what it gives at stall",
    ),
    (
        "effort_nm = 1.547",
        "effort_nm = 0.000001",
        "nao/robot.toml:80:13: joint HeadYaw: effort_nm 1.000e-6 is outside 0.00308..1539.03068 N·m: a motor moves some of the robot's weight, and is carried by it",
    ),
    (
        "effort_nm = 1.547",
        "effort_nm = 5.0",
        "nao/robot.toml:80:13: joint HeadYaw: effort_nm 5 is outside 0.01074..4.29772 N·m: a current limit is a part of what the motor gives at stall, or little above it",
    ),
    (
        "speed_rad_s = 7.45",
        "speed_rad_s = 0.00001",
        "nao/robot.toml:81:15: joint HeadYaw: speed_rad_s 1.000e-5 is outside 0.2..200 rad/s: a joint moves within seconds",
    ),
    (
        "servo_stiffness_nm_rad = 80.0",
        "servo_stiffness_nm_rad = 0.001",
        "nao/robot.toml:82:26: joint HeadYaw: servo_stiffness_nm_rad 0.001 is outside 0.24621..100000 N·m/rad: a servo gives its effort at an error of a turn at most",
    ),
    (
        "lying_length_mm = 600.0",
        "lying_length_mm = 6.0",
        "nao/robot.toml:423:19: lying_length_mm 6 is outside 181.18186..2415.75812 mm: from toe to elbow the chain is what the model says",
    ),
    (
        "[motors.leg]",
        "[motors.\"%s leg\"]",
        "nao/robot.toml:59:9: the name of a motor is made of letters, digits, _, - and ., with a letter or a digit among them, not \"%s leg\"",
    ),
];

#[test]
fn tables_that_fit_no_robot_are_refused() {
    check(TABLES, table);
}

#[test]
fn folders_that_hold_no_two_texts_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let read = || match RobotFiles::read(folder.path()) {
        Err(RobotFolderError::Read(ReadError { path, source })) => {
            let file = path.file_name().unwrap().display().to_string();
            format!("{file}: {source}")
        }
        other => panic!("{other:?}"),
    };
    fs::create_dir(folder.path().join("robot.toml")).unwrap();
    assert_eq!(read(), "robot.toml: it is not a regular file");
    fs::remove_dir(folder.path().join("robot.toml")).unwrap();
    let alone = NAO.toml.replacen("family = \"nao\"\n", "", 1);
    fs::write(folder.path().join("robot.toml"), alone).unwrap();
    let mjcf = fs::File::create(folder.path().join("robot.xml")).unwrap();
    mjcf.set_len((16 << 20) + 1).unwrap();
    assert_eq!(read(), "robot.xml: it is larger than 16 MiB");
}
