//! `prone export`: each format is read back by a program of somebody else.

mod exporting;
mod program;
mod short_crawl;

use std::collections::BTreeMap;
use std::fs;

use prone_report::export::urdf;
use serde_json::Value;

use exporting::{exported, read, read_beside};
use short_crawl::record;

/// Of the NAO that ships.
const JOINTS: usize = 24;

/// `rows.csv` by column, as texts.
fn rows() -> BTreeMap<String, Vec<String>> {
    let text = fs::read_to_string(record().join("rows.csv")).unwrap();
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned));
    let header: Vec<String> = lines.next().unwrap().collect();
    let lines: Vec<Vec<String>> = lines.map(Iterator::collect).collect();
    let column = |index: usize| lines.iter().map(|line| line[index].clone()).collect();
    let names = header.into_iter().enumerate();
    names.map(|(index, name)| (name, column(index))).collect()
}

fn number(text: &str) -> f64 {
    text.parse().unwrap()
}

fn near(found: &Value, expected: f64, tolerance: f64) {
    let found = found
        .as_f64()
        .unwrap_or_else(|| panic!("{found} is not a number"));
    assert!(
        (found - expected).abs() <= tolerance,
        "{found} is not {expected}"
    );
}

/// Of a JSON list of texts.
fn place(names: &Value, name: &str) -> usize {
    let names = names.as_array().unwrap();
    names.iter().position(|it| it == name).unwrap()
}

#[test]
fn a_table_has_a_line_per_instant_and_joint() {
    let home = tempfile::tempdir().unwrap();
    let table = fs::read_to_string(exported(&home, "csv", &[])).unwrap();
    let rows = rows();
    let joints = rows
        .keys()
        .filter(|name| name.ends_with("_cmd_rad"))
        .count();
    assert_eq!(table.lines().count(), 1 + joints * rows["time_s"].len());
    let mut lines = table.lines();
    assert_eq!(
        lines.next(),
        Some("time_s,joint,command_rad,position_rad,velocity_rad_s,effort_nm")
    );
    let first: Vec<&str> = lines.next().unwrap().split(',').collect();
    assert_eq!(first[..2], ["0.0200", "HeadYaw"]);
    assert_eq!(first[3], rows["HeadYaw_rad"][0]);
    let last: Vec<&str> = lines.last().unwrap().split(',').collect();
    assert_eq!(last[1], "RWristYaw");
    assert_eq!(last[5], *rows["RWristYaw_nm"].last().unwrap());
}

#[test]
fn numpy_reads_the_arrays() {
    let home = tempfile::tempdir().unwrap();
    let file = exported(&home, "npz", &[]);
    let Some(found) = read("npz", &file) else {
        return;
    };
    let rows = rows();
    let (instants, joints) = (rows["time_s"].len(), JOINTS);
    assert_eq!(found["time_s"]["shape"], serde_json::json!([instants]));
    assert_eq!(found["joints"]["kind"], "U");
    for name in ["command_rad", "position_rad", "velocity_rad_s", "effort_nm"] {
        assert_eq!(found[name]["kind"], "f", "{name}");
        assert_eq!(
            found[name]["shape"],
            serde_json::json!([instants, joints]),
            "{name}"
        );
    }
    let knee = place(&found["joints"]["whole"], "LKneePitch");
    for (array, column) in [
        ("position_rad", "LKneePitch_rad"),
        ("effort_nm", "LKneePitch_nm"),
    ] {
        // The very numbers of the record.
        near(
            &found[array]["first"][0][knee],
            number(&rows[column][0]),
            0.0,
        );
        near(
            &found[array]["last"][0][knee],
            number(rows[column].last().unwrap()),
            0.0,
        );
    }
    near(
        &found["root_position_m"]["last"][0][0],
        number(rows["x_mm"].last().unwrap()) / 1e3,
        1e-12,
    );
    near(
        &found["ground_n"]["first"][0][2],
        number(&rows["torso_n"][0]),
        0.0,
    );
    let contacts = fs::read_to_string(record().join("contacts.csv")).unwrap();
    let last: Vec<&str> = contacts.lines().last().unwrap().split(',').collect();
    let count = contacts.lines().count() - 1;
    assert_eq!(
        found["contact_force_n"]["shape"],
        serde_json::json!([count, 3])
    );
    assert_eq!(found["contact_body"]["last"][0], last[1]);
    near(
        &found["contact_force_n"]["last"][0][2],
        number(last[8]),
        0.0,
    );
}

#[test]
fn rerun_converts_the_log() {
    let home = tempfile::tempdir().unwrap();
    let file = exported(&home, "mcap", &[]);
    let Some(found) = read("rerun", &file) else {
        return;
    };
    let rows = rows();
    // Of the joints, which are in the order of the columns, the head's pitch is the second.
    for (field, column) in [("position", "HeadPitch_rad"), ("effort", "HeadPitch_nm")] {
        let (field, column) = (&found[field], &rows[column]);
        assert_eq!(field["count"], column.len());
        near(&field["first"][1][1], number(&column[0]), 0.0);
        near(&field["last"][1][1], number(column.last().unwrap()), 0.0);
    }
    assert_eq!(found["velocity"]["count"], rows["time_s"].len());
    assert_eq!(found["position"]["first"][0], "1970-01-01T00:00:00.020");
}

#[test]
fn mcap_reads_the_log() {
    let home = tempfile::tempdir().unwrap();
    let file = exported(&home, "mcap", &[]);
    let Some(found) = read("mcap", &file) else {
        return;
    };
    assert_eq!(found["profile"], "ros2");
    let rows = rows();
    let instants = rows["time_s"].len();
    let topics = found["topics"].as_object().unwrap();
    let kinds = [
        ("/joint_states", "sensor_msgs/msg/JointState"),
        ("/joint_commands", "sensor_msgs/msg/JointState"),
        ("/tf", "tf2_msgs/msg/TFMessage"),
        ("/contacts/torso/floor", "geometry_msgs/msg/WrenchStamped"),
    ];
    for (topic, schema) in kinds {
        let topic = &topics[topic];
        assert_eq!(topic["schema"], schema);
        assert_eq!(topic["schema_encoding"], "ros2msg");
        assert_eq!(topic["encoding"], "cdr");
        assert_eq!(topic["count"], instants);
        assert_eq!(topic["in_order"], true);
        assert_eq!(topic["begin_ns"], 20_000_000);
        near(
            &topic["end_ns"],
            number(rows["time_s"].last().unwrap()) * 1e9,
            1.0,
        );
    }
    assert_eq!(found["messages"], (topics.len() - 1) * instants + 1);
    // Whoever plays the log offers each topic as it was offered; the robot also to those who come late.
    for (topic, channel) in topics {
        let durability = u8::from(topic != "/robot_description") + 1;
        let profile = channel["metadata"]["offered_qos_profiles"].as_str();
        let line = format!("\n  durability: {durability}\n");
        assert!(profile.unwrap().contains(&line), "{topic}: {profile:?}");
    }
    let description = &topics["/robot_description"];
    assert_eq!(description["schema"], "std_msgs/msg/String");
    assert_eq!(description["begin_ns"], 20_000_000);
    let urdf = fs::read_to_string(exported(&home, "urdf", &[])).unwrap();
    assert_eq!(description["first"]["data"], urdf);
    let (first, last) = (
        &topics["/joint_states"]["first"],
        &topics["/joint_states"]["last"],
    );
    assert_eq!(first["header"]["stamp"]["nanosec"], 20_000_000);
    let knee = place(&first["name"], "LKneePitch");
    near(
        &first["position"][knee],
        number(&rows["LKneePitch_rad"][0]),
        0.0,
    );
    near(
        &last["position"][knee],
        number(rows["LKneePitch_rad"].last().unwrap()),
        0.0,
    );
    near(
        &last["effort"][knee],
        number(rows["LKneePitch_nm"].last().unwrap()),
        0.0,
    );
    assert_eq!(first["velocity"].as_array().unwrap().len(), JOINTS);
    let root = &topics["/tf"]["last"]["transforms"][0];
    assert_eq!(root["header"]["frame_id"], "world");
    assert_eq!(root["child_frame_id"], "torso");
    near(
        &root["transform"]["translation"]["z"],
        number(rows["z_mm"].last().unwrap()) / 1e3,
        1e-12,
    );
    // 1e-6: seven decimals of a unit quaternion.
    near(
        &root["transform"]["rotation"]["w"],
        number(rows["qw"].last().unwrap()),
        1e-6,
    );
    // What presses on the trunk, summed by hand; turning into the trunk's frame keeps its length.
    let contacts = fs::read_to_string(record().join("contacts.csv")).unwrap();
    let mut sum = [0.0; 3];
    for line in contacts
        .lines()
        .filter(|line| line.starts_with("0.0200,torso,floor"))
    {
        let cells: Vec<&str> = line.split(',').collect();
        for axis in 0..3 {
            sum[axis] += number(cells[6 + axis]);
        }
    }
    let force = &topics["/contacts/torso/floor"]["first"]["wrench"]["force"];
    let parts = ["x", "y", "z"].map(|axis| force[axis].as_f64().unwrap());
    let length = |parts: [f64; 3]| parts.iter().map(|part| part * part).sum::<f64>().sqrt();
    assert!(length(sum) > 1.0, "{sum:?}");
    assert!(
        (length(parts) - length(sum)).abs() < 1e-6,
        "{parts:?} is not {sum:?} long"
    );
}

/// By itself, and as a folder that `ros2 bag` plays.
#[test]
fn rosbags_reads_the_log_and_the_bag() {
    let home = tempfile::tempdir().unwrap();
    let (file, folder) = (exported(&home, "mcap", &[]), exported(&home, "bag", &[]));
    let inside = folder.join("short.bag_0.mcap");
    assert!(fs::read(&inside).unwrap() == fs::read(&file).unwrap());
    let (Some(alone), Some(bag)) = (read("rosbags", &file), read("rosbags", &folder)) else {
        return;
    };
    // What the log tells of itself is what metadata.yaml tells.
    assert_eq!(alone, bag);
    let rows = rows();
    let instants = rows["time_s"].len();
    let topics = bag["topics"].as_object().unwrap();
    assert_eq!(bag["messages"], (topics.len() - 1) * instants + 1);
    assert_eq!(bag["begin_ns"], 20_000_000);
    near(
        &bag["end_ns"],
        number(rows["time_s"].last().unwrap()) * 1e9,
        1.0,
    );
    for (name, topic) in topics {
        let (count, qos) = match name.as_str() {
            "/robot_description" => (
                1,
                serde_json::json!(["KEEP_LAST", 1, "RELIABLE", "TRANSIENT_LOCAL"]),
            ),
            _ => (
                instants,
                serde_json::json!(["KEEP_LAST", 10, "RELIABLE", "VOLATILE"]),
            ),
        };
        assert_eq!(topic["qos"], serde_json::json!([qos]), "{name}");
        assert_eq!(
            (&topic["count"], &topic["read"]),
            (&count.into(), &count.into()),
            "{name}"
        );
    }
}

/// The whole of what Pinocchio, yourdfpy and `MuJoCo`'s importer make of the robot.
#[test]
fn engines_and_libraries_read_the_same_robot() {
    let home = tempfile::tempdir().unwrap();
    let file = exported(&home, "urdf", &[]);
    let model = home.path().join("robot.xml");
    fs::write(&model, prone_files::shipped::NAO.mjcf).unwrap();
    // The manufacturer's whole mass of the V4, kg.
    let whole = 5.19535;
    if let Some(found) = read_beside("dynamics", &[&file, &model]) {
        near(&found["mass"], whole, 1e-9);
        near(&found["engine_mass"], whole, 1e-9);
        // kg·m² and N·m: the file has six decimals of a mass, ten digits of an inertia.
        near(&found["mass_matrix_differs"], 0.0, 1e-9);
        near(&found["gravity_differs"], 0.0, 1e-9);
        assert_eq!(found["freedoms"], 6 + JOINTS);
        // One motor turns both HipYawPitch.
        assert_eq!(found["freedoms_with_mimic"], 6 + JOINTS - 1);
    }
    if let Some(found) = read("mujoco", &file) {
        near(&found["mass"], whole, 1e-9);
        assert_eq!(found["joints"], JOINTS);
        assert_eq!(found["equalities"], 1);
    }
    if let Some(found) = read("yourdfpy", &file) {
        assert_eq!(found["valid"], true);
        assert_eq!(found["said"], serde_json::json!([]));
        assert_eq!(found["counts"], found["distinct"]);
        let mimic = serde_json::json!({"RHipYawPitch": ["LHipYawPitch", 1.0, 0.0]});
        assert_eq!(found["mimic"], mimic);
    }
}

#[test]
fn bullet_reads_the_robot() {
    let home = tempfile::tempdir().unwrap();
    let file = exported(&home, "urdf", &[]);
    let Some(found) = read("urdf", &file) else {
        return;
    };
    let model = fs::read_to_string(record().join("model.json")).unwrap();
    let model: Value = serde_json::from_str(&model).unwrap();
    // 1e-4: masses have six decimals in the file.
    near(&found["mass"], model["mass_kg"].as_f64().unwrap(), 1e-4);
    assert_eq!(found["root"], "torso");
    let joints = found["joints"].as_array().unwrap();
    let bodies = model["bodies"].as_array().unwrap();
    assert_eq!(joints.len(), bodies.len() - 1);
    let angles: BTreeMap<&str, f64> = joints
        .iter()
        .map(|joint| {
            (
                joint["name"].as_str().unwrap(),
                joint["angle"].as_f64().unwrap(),
            )
        })
        .collect();
    let shipped =
        prone_sim::LoadedRobot::load(prone_sim::RobotFiles::shipped(&prone_files::shipped::NAO));
    let shipped = shipped.unwrap();
    let robot = shipped.robot();
    let posture = prone::robot::JointAngles::from_fn(robot.joints.len(), |joint| {
        angles[robot.joints[joint.0].name.as_str()]
    });
    let root = prone::frames::Transform::<prone::frames::Ground, prone::frames::Root>::translation(
        glam::DVec3::ZERO,
    );
    let poses = robot.forward_kinematics(root, &posture);
    for joint in joints {
        let known = robot.joint(joint["name"].as_str().unwrap()).unwrap();
        let known = &robot.joints[known.0];
        let body = &robot.bodies[known.body.0];
        assert_eq!(joint["link"], *body.name);
        assert_eq!(joint["kind"], 0, "a hinge");
        near(&joint["lower"], known.range.lower, 1e-9);
        near(&joint["upper"], known.range.upper, 1e-9);
        near(&joint["effort"], known.effort_limit, 1e-9);
        near(&joint["speed"], known.speed_limit, 1e-9);
        let place = poses.of(known.body).origin().metres();
        for axis in 0..3 {
            // Bullet turns in single precision.
            near(&joint["place"][axis], place[axis], 2e-6);
        }
    }
    let shapes = model["shapes"].as_array().unwrap();
    let parts = |wanted: &dyn Fn(&Value) -> bool| -> usize {
        let chosen = shapes.iter().filter(|shape| wanted(shape));
        chosen
            .map(|shape| match shape["type"].as_str().unwrap() {
                "capsule" => 3,
                "ellipsoid" => {
                    let half: [f64; 3] = serde_json::from_value(shape["size"].clone()).unwrap();
                    urdf::ellipsoid::balls(half.into()).len()
                }
                _ => 1,
            })
            .sum()
    };
    assert_eq!(
        found["collisions"],
        parts(&|shape| shape["collides"] == true)
    );
    assert_eq!(
        found["visuals"],
        parts(&|shape| shape["group"].as_i64().unwrap() <= 2)
    );
}

#[test]
fn key_frames_are_the_commands() {
    let home = tempfile::tempdir().unwrap();
    let file = exported(&home, "keyframes", &[]);
    let found: Value = serde_json::from_slice(&fs::read(file).unwrap()).unwrap();
    let rows = rows();
    let frames = found["frames"].as_array().unwrap();
    let joints = found["joints"].as_array().unwrap();
    near(
        &found["period_s"],
        number(rows["time_s"].last().unwrap()),
        1e-9,
    );
    assert_eq!(
        frames[0]["angles_rad"],
        frames.last().unwrap()["angles_rad"]
    );
    let labels: Vec<&str> = frames
        .iter()
        .filter_map(|frame| frame["label"].as_str())
        .collect();
    assert_eq!(
        labels,
        [
            "extension",
            "compression",
            "fold",
            "lift",
            "reach",
            "extension"
        ]
    );
    // How far each joint was behind, and where, is what the table says.
    let mut largest = (0.0, String::new());
    for (joint, lag) in joints
        .iter()
        .zip(found["largest_lag_by_joint"].as_array().unwrap())
    {
        let joint = joint.as_str().unwrap();
        let command = rows[&format!("{joint}_cmd_rad")].iter();
        let lags = command.zip(&rows[&format!("{joint}_rad")]);
        let lags = lags.map(|(command, angle)| (number(command) - number(angle)).abs());
        let lags: Vec<f64> = lags.collect();
        let expected = lags.iter().copied().fold(0.0, f64::max);
        assert_eq!(lag["joint"], joint);
        near(&lag["lag_rad"], expected, 1e-9);
        let time = lag["time_s"].as_f64().unwrap();
        let row = rows["time_s"]
            .iter()
            .position(|row| number(row) >= time)
            .unwrap();
        near(&lag["lag_rad"], lags[row], 1e-9);
        if expected > largest.0 {
            largest = (expected, joint.to_owned());
        }
    }
    assert!(
        largest.0 > 0.1,
        "{largest:?}: the soft servos of a crawl lag"
    );
    assert_eq!(found["largest_lag"]["joint"], largest.1);
    // Straight lines between them lead past what was commanded at each row.
    let tolerance = found["tolerance_rad"].as_f64().unwrap();
    for (row, time) in rows["time_s"].iter().map(|time| number(time)).enumerate() {
        let after = frames
            .iter()
            .position(|frame| frame["time_s"].as_f64().unwrap() >= time - 1e-9);
        let after = after.unwrap().max(1);
        let (from, to) = (&frames[after - 1], &frames[after]);
        let [begin, end] = [from, to].map(|frame| frame["time_s"].as_f64().unwrap());
        let share = (time - begin) / (end - begin);
        for (index, joint) in joints.iter().enumerate() {
            let [a, b] = [from, to].map(|frame| frame["angles_rad"][index].as_f64().unwrap());
            let commanded = number(&rows[&format!("{}_cmd_rad", joint.as_str().unwrap())][row]);
            let line = a + share * (b - a);
            // 1e-5: six decimals in both.
            assert!(
                (line - commanded).abs() < tolerance + 1e-5,
                "{joint} at {time}: {line}, {commanded}"
            );
        }
    }
}

#[test]
fn python_reads_the_timeline() {
    let home = tempfile::tempdir().unwrap();
    let file = exported(&home, "xar", &[]);
    let Some(found) = read("xar", &file) else {
        return;
    };
    let rows = rows();
    assert!(
        found["root"]
            .as_str()
            .unwrap()
            .ends_with("}ChoregrapheProject")
    );
    assert_eq!(found["version"], "3");
    assert_eq!(found["fps"], "25");
    assert_eq!(found["links"], 2);
    let tooltip = found["tooltips"][1].as_str().unwrap();
    assert!(tooltip.contains("ShoulderPitch is up to "), "{tooltip}");
    assert_eq!(found["tangents"], serde_json::json!(["linear"]));
    let curves = found["curves"].as_object().unwrap();
    assert_eq!(curves.len(), JOINTS);
    let size = number(found["size"].as_str().unwrap());
    // Two seconds before it, then the cycle.
    assert!(
        (size - 25.0 * (2.0 + number(rows["time_s"].last().unwrap()))).abs() <= 0.5,
        "{size}"
    );
    for (joint, curve) in curves {
        assert_eq!(curve["unit"], "0", "{joint}: degrees");
        let keys = curve["keys"].as_array().unwrap();
        let frames: Vec<i64> = keys.iter().map(|key| key[0].as_i64().unwrap()).collect();
        assert!(frames.is_sorted_by(|a, b| a < b), "{joint}: {frames:?}");
        assert_eq!(frames[0], 50);
        assert_eq!(keys[0][1], keys[keys.len() - 1][1], "{joint} closes");
        // Keys of frame 50 + n are commanded n / 25 s into the cycle: every second row of 0.02 s.
        for key in &keys[1..keys.len() - 1] {
            let row = 2 * (usize::try_from(key[0].as_i64().unwrap()).unwrap() - 50) - 1;
            let commanded = number(&rows[&format!("{joint}_cmd_rad")][row]).to_degrees();
            // 1e-3: the record has microradians, the timeline four decimals.
            near(&key[1], commanded, 1e-3);
        }
    }
}
