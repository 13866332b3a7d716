//! A record of the NAO made by hand: three instants, without an engine.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use prone::robot::{BodyId, JointId, Robot, SideLayout};
use prone_files::compiled_robot::CompiledRobot;
use prone_files::shipped;
use prone_record::record_columns;

/// Times of the rows of a whole record, s.
const TIMES_S: [f64; 3] = [0.02, 0.04, 0.06];

/// The robot that ships.
pub(crate) fn nao() -> CompiledRobot {
    CompiledRobot::shipped(&shipped::NAO).unwrap()
}

/// Bodies and chain as the engine's model has them; inertias and shapes are invented.
fn model(robot: &Robot) -> Value {
    let bodies = robot.bodies.iter().map(|body| {
        let pose = &body.parent_from_body;
        let turn = pose.rotation();
        let joint = body.joint.map(|JointId(joint)| {
            let joint = &robot.joints[joint];
            json!({
                "name": joint.name,
                "axis": joint.axis.to_array(),
                "anchor": joint.anchor.metres().to_array(),
                "range": [joint.range.lower, joint.range.upper],
            })
        });
        json!({
            "name": body.name,
            "parent": body.parent.map(|BodyId(parent)| parent),
            "position": pose.origin().metres().to_array(),
            "quaternion": [turn.w, turn.x, turn.y, turn.z],
            "joint": joint,
            "inertia": {"principal": [1e-3, 2e-3, 3e-3], "quaternion": [1.0, 0.0, 0.0, 0.0]},
        })
    });
    let shape = |body: usize, kind: &str, size: &[f64], group: i32, collides: bool| {
        json!({
            "body": body, "type": kind, "size": size, "position": [0.0, 0.0, 0.1],
            "quaternion": [1.0, 0.0, 0.0, 0.0], "rgba": [1.0, 0.5, 0.0, 1.0],
            "group": group, "collides": collides,
        })
    };
    let side = |side: &SideLayout| {
        let name = |JointId(joint): JointId| robot.joints[joint].name.clone();
        let site = |(BodyId(body), point): (BodyId, prone::frames::Point<prone::frames::Link>)| json!({"body": body, "position": point.metres().to_array()});
        json!({
            "toe": site(side.toe), "elbow": site(side.elbow),
            "ankle": name(side.ankle), "knee": name(side.knee), "hip": name(side.hip),
            "shoulder": name(side.shoulder), "shoulder_roll": name(side.shoulder_roll),
            "forearm": side.forearm.map(name),
        })
    };
    json!({
        "robot": robot.name,
        "bodies": bodies.collect::<Vec<_>>(),
        "shapes": [
            shape(0, "capsule", &[0.05, 0.1], 0, true),
            shape(1, "ellipsoid", &[0.01, 0.02, 0.03], 2, false),
            shape(1, "box", &[0.01, 0.02, 0.03], 3, true),
        ],
        "chain": {"left": side(&robot.chain.left), "right": side(&robot.chain.right)},
        "obstacles": [], "marker": null, "rough": null, "slope": 0.0,
    })
}

/// `run.json` with an origin and what the tables hold.
fn run(robot: &CompiledRobot, origin: &Value, record: &Value, options: &Value) -> Value {
    let gait = shipped::gait_file("hip-10").unwrap();
    json!({
        "program": "prone", "version": env!("CARGO_PKG_VERSION"), "commit": "c",
        "command": "crawl run",
        "robot": {
            "name": robot.robot().name, "family": "nao", "version": "v4", "folder": "robots/nao/v4",
            "sha256": robot.sources_hash(), "standing_height_mm": 574.0,
        },
        "gait": {
            "name": "hip-10", "description": "by hand", "file": gait.file, "mapping": "original",
            "arm": "planted", "text": gait.text,
        },
        "scene": {
            "name": "level", "obstacles": 0, "friction_left": 0.7, "friction_right": 0.7,
            "slope_deg": 0.0, "rough": false,
        },
        "origin": origin, "options": options, "record": record,
    })
}

/// Writes a simulated record, whole.
pub(crate) fn whole(folder: &Path) {
    written(folder, &simulated());
}

/// Writes the same as if a robot had been recorded.
pub(crate) fn driven(folder: &Path) {
    written(folder, &driven_by_hand());
}

fn driven_by_hand() -> Value {
    json!({
        "kind": "robot", "host": "nao.local", "versions": {"NAOqi": "2.1"},
        "settings": {"stiffness": "0.8"},
    })
}

fn simulated() -> Value {
    json!({
        "kind": "simulated", "engine": "by hand", "name": "locomotion", "friction": 0.7,
        "impratio": 10.0, "effort_limit": "the manufacturer's", "stops": "the manufacturer's",
        "servo": "DC motors",
        "time_step_s": 0.0025, "command_step_s": 0.01, "settle_s": 1.0, "solref": [0.02, 1.0],
        "solimp": [0.9, 0.99, 0.001, 0.5, 2.0], "integrator": "implicitfast", "solver": "Newton",
        "solver_iterations": 100, "solver_tolerance": 1e-8, "cone": "elliptic",
        "gravity_m_s2": [0.0, 0.0, -9.81], "servos": {}, "joint_damping_nms_rad": {},
    })
}

/// Writes a whole record with an origin.
fn written(folder: &Path, origin: &Value) {
    let nao = nao();
    let robot = nao.robot();
    let channels = record_columns::channels(robot);
    let record = json!({
        "format": 3, "rows": TIMES_S.len(), "row_step_s": 0.02, "channels": channels,
    });
    let options = json!({
        "most_cycles": 1, "time_scale": 1.0, "steering": "none", "turn_command_deg": 0.0,
        "joint_offset_deg": 0.0, "joint_offsets_rad": [], "scene_text": null,
    });
    write(folder, "run.json", &run(&nao, origin, &record, &options));
    write(folder, "model.json", &model(robot));
    write(folder, "summary.json", &summary());
    write(folder, "figures.json", &json!([]));
    fs::write(folder.join("robot.compiled.json"), nao.text()).unwrap();
    let mut rows = "time_s,cycle,stage,s".to_owned();
    let mut contacts = "time_s,body,with,x_mm,y_mm,z_mm,fx_n,fy_n,fz_n\n".to_owned();
    let columns: Vec<&str> = channels
        .iter()
        .filter(|channel| channel.table == prone_record::recorded::Part::Rows)
        .flat_map(|channel| &channel.columns)
        .map(String::as_str)
        .collect();
    for column in &columns {
        rows += ",";
        rows += column;
    }
    rows += "\n";
    for (index, time_s) in TIMES_S.into_iter().enumerate() {
        write!(rows, "{time_s:.4},1,pull,0.{index}").unwrap();
        for column in &columns {
            let value = match *column {
                "qw" | "contacts" => 1.0,
                "qx" | "qy" | "qz" => 0.0,
                _ => 0.1 * (index as f64 + 1.0),
            };
            write!(rows, ",{value}").unwrap();
        }
        rows += "\n";
        writeln!(
            contacts,
            "{time_s:.4},{},floor,1,2,3,4,5,6",
            robot.bodies[1].name
        )
        .unwrap();
    }
    fs::write(folder.join("rows.csv"), rows).unwrap();
    fs::write(folder.join("contacts.csv"), contacts).unwrap();
}

/// Writes what a robot may leave: angles of all joints but the first, torques of one with a gap,
/// nothing else, and rows when they came.
pub(crate) fn sparse(folder: &Path) {
    let nao = nao();
    let robot = nao.robot();
    let names = || robot.joints.iter().map(|joint| joint.name.as_str());
    let angles: Vec<String> = names().skip(1).map(|name| format!("{name}_rad")).collect();
    let torque = format!("{}_nm", robot.joints[1].name);
    let channels = json!([
        {"table": "rows.csv", "columns": angles, "is": "instant", "unit": "rad"},
        {"table": "rows.csv", "columns": [torque], "is": "instant", "unit": "N·m"},
    ]);
    let origin = driven_by_hand();
    let record = json!({"format": 3, "rows": 3, "row_step_s": null, "channels": channels});
    let options = json!({"time_scale": 1.0});
    write(folder, "run.json", &run(&nao, &origin, &record, &options));
    write(folder, "model.json", &model(robot));
    fs::write(folder.join("robot.compiled.json"), nao.text()).unwrap();
    let mut rows = format!("time_s,{},{torque}\n", angles.join(","));
    for (time_s, torque) in [(0.013, "0.5"), (0.021, ""), (0.058, "0.7")] {
        write!(rows, "{time_s}").unwrap();
        for _ in &angles {
            write!(rows, ",{time_s}").unwrap();
        }
        writeln!(rows, ",{torque}").unwrap();
    }
    fs::write(folder.join("rows.csv"), rows).unwrap();
}

fn write(folder: &Path, file: &str, value: &Value) {
    fs::write(folder.join(file), serde_json::to_vec_pretty(value).unwrap()).unwrap();
}

/// Figures of a crawl that did not get far.
/// What a group of bodies carries, N.
fn load(mean_n: f64) -> Value {
    json!({"mean_n": mean_n, "peak_n": 2.0 * mean_n, "share_of_time": 0.5})
}

fn ground() -> Value {
    json!({
        "toe": load(20.0), "elbow": load(15.0), "torso": load(5.0), "leg": load(3.0),
        "head": load(0.5), "hand": load(8.0),
    })
}

fn verdict() -> Value {
    json!({
        "duty": "limited", "unknown": null, "gear_efficiency": 0.6, "reasons": [{
            "measure": "RMS torque over nominal", "joint": "LKneePitch", "value": 1.2,
            "continuous": 1.0, "limited": 1.7,
        }],
    })
}

fn summary() -> Value {
    json!({
        "gait": "hip-10", "robot": "NAO H25 V4", "scene": "level", "cycles": 1, "arrived": null,
        "distance_mm": 0.2, "path_mm": 0.2, "time_s": 0.06, "mm_per_cycle": 0.2,
        "pull_mm_per_cycle": 0.2, "recovery_mm_per_cycle": 0.0, "mm_per_s": 3.3, "lateral_mm": 0.0,
        "yaw_deg": 0.0, "plate_contacts": 0, "contacts": [],
        "top_mm": {"head": 170.0, "trunk": 150.0, "arms": 120.0, "legs": 110.0, "feet": 160.0},
        "stride_mm": 100.0, "pull_efficiency": null, "stride_efficiency": null,
        "pull_body_share": 0.5, "recovery_body_share": 0.5, "peak_torque_over_rated": 0.5,
        "peak_torque_joint": "LKneePitch", "demanded_peak_shoulder_nm": 1.0,
        "saturated_shoulder_share": 0.0, "saturated_share": 0.0, "saturated_joint": null,
        "heat_s": 0.1, "heat_per_metre_s": 500.0, "work_j": 0.1, "cost_of_transport": 9.6,
        "winding_loss_j": null, "electrical_cost_of_transport": null, "joints": [], "clamps": [],
        "per_cycle": [], "heat_per_second": 1.7, "ground": ground(), "verdict": verdict(),
    })
}
