//! The statics against the engine, and both against the original author's table.
//!
//! The table lies outside the repository: in the directory that `PRONE_REFERENCE_DIR` names, or
//! in `../shared/reference` beside it. Where it is absent the tests that need it say so and pass;
//! with `PRONE_REQUIRE_REFERENCE=1` they fail.

#[path = "../../prone/src/statics/tests/virtual_work.rs"]
mod virtual_work;

use std::path::PathBuf;

use rayon::prelude::*;

use prone::chain::GaitParameters;
use prone::mapping::{ArmMode, Mapping, MappingVariant};
use prone::regime::{Regime, Servo, TorqueLimit, VelocityServo};
use prone::robot::{ContactGroup, JointId, Robot};
use prone::statics::{self, HalfRobot, Stance, StaticTorques, SupportRule};
use prone::torque_map::{self, Axis, Grid, Row, TorqueMap, TorqueSource};
use prone_files::shipped;
use prone_sim::settled::SettledTorques;
use prone_sim::{LoadedRobot, RobotFiles, World};

/// Our torques of one side and theirs, N·m.
type Pair = ([f64; 4], [f64; 4]);

const JOINTS: [&str; 4] = ["ankle", "knee", "hip", "shoulder"];

/// Stiff joints on a slippery floor: the rigid body of the statics. 20 N·m·s/rad times the rate of
/// the recordings' servo law is 400 N·m/rad. The torque limit is out of reach: at it such a servo
/// would have no damping.
const STIFF: Regime = Regime {
    name: "stiff",
    torque_limit: TorqueLimit::Uniform(1000.0),
    servo: Servo::Velocity(VelocityServo {
        gain: Some(20.0),
        ..VelocityServo::RECORDINGS
    }),
    ..Regime::TORQUE_STUDY
};

/// Largest median |error| against the recorded table, N·m: what an independent prototype reached,
/// rounded up.
const TABLE_MEDIANS: [f64; 4] = [0.05, 0.06, 0.09, 0.06];

/// Smallest correlation of settled simulation with the recorded table, from the same source.
const TABLE_CORRELATIONS: [f64; 4] = [0.93, 0.85, 0.85, 0.70];

fn nao() -> LoadedRobot {
    LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap()
}

/// The set-up under which the table was recorded.
fn table_mapping(robot: &Robot) -> Mapping {
    Mapping::new(robot, MappingVariant::Original, ArmMode::Fixed).unwrap()
}

fn table_statics(robot: &Robot) -> StaticTorques<&Robot> {
    let stance = Stance::unsqueezed(SupportRule::AnyShape);
    StaticTorques::new(robot, table_mapping(robot), &robot.study_stops(), stance).unwrap()
}

/// The recorded table, or `None` with a word on stderr.
fn recorded_table() -> Option<TorqueMap> {
    let repository = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folder = std::env::var_os("PRONE_REFERENCE_DIR")
        .map_or_else(|| repository.join("../shared/reference"), PathBuf::from);
    let path = folder.join("torque-table-2.5deg.csv");
    match std::fs::read_to_string(&path) {
        Ok(text) => Some(torque_map::parse(&text).unwrap()),
        Err(error) => {
            let required = std::env::var_os("PRONE_REQUIRE_REFERENCE").is_some_and(|v| v == "1");
            assert!(!required, "{}: {error}", path.display());
            eprintln!("skipped: {}: {error}", path.display());
            None
        }
    }
}

/// Postures of the recorded table's grid in an order that only the seed decides.
fn shuffled_nodes(seed: u64) -> Vec<GaitParameters> {
    let axis =
        |low: f64, high: f64, nodes| Axis::new(low.to_radians(), high.to_radians(), nodes).unwrap();
    let grid = Grid {
        knee: axis(-5.0, 45.0, 21),
        hip: axis(-30.0, 27.5, 24),
        upper_arm: axis(-90.0, -30.0, 25),
    };
    // SplitMix64 of seed and index, as a sort key.
    let key = |index: usize| {
        let mut z = seed.wrapping_add((index as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15));
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    };
    let mut order: Vec<usize> = (0..grid.len()).collect();
    order.sort_by_key(|&index| key(index));
    order.into_iter().map(|index| grid.node(index)).collect()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn median_error(pairs: &[Pair], joint: usize) -> f64 {
    median(
        pairs
            .iter()
            .map(|(ours, theirs)| (ours[joint] - theirs[joint]).abs())
            .collect(),
    )
}

fn correlation(pairs: &[Pair], joint: usize) -> f64 {
    let count = pairs.len() as f64;
    let mean = |pick: &dyn Fn(&Pair) -> f64| pairs.iter().map(pick).sum::<f64>() / count;
    let (x, y) = (mean(&|pair| pair.0[joint]), mean(&|pair| pair.1[joint]));
    let covariance = mean(&|pair| (pair.0[joint] - x) * (pair.1[joint] - y));
    let spread_x = mean(&|pair| (pair.0[joint] - x).powi(2));
    let spread_y = mean(&|pair| (pair.1[joint] - y).powi(2));
    covariance / (spread_x * spread_y).sqrt()
}

/// Valid rows of the recorded table, every `stride`-th, beside a source's torques.
fn beside_table(table: &TorqueMap, source: &impl TorqueSource, stride: usize) -> Vec<Pair> {
    let rows: Vec<_> = (0..table.grid().len())
        .filter_map(|index| match table.rows()[index] {
            Row::Torques(torques) => Some((table.grid().node(index), torques.to_array())),
            Row::Masked { .. } => None,
        })
        .step_by(stride)
        .collect();
    rows.into_par_iter()
        .map(|(at, recorded)| (source.torques(at).unwrap().to_array(), recorded))
        .collect()
}

/// The identity of the two routes on the real robot, with its arms in both modes.
#[test]
fn virtual_work_matches_force_balance() {
    let loaded = nao();
    let robot = loaded.robot();
    let half = HalfRobot::from_robot(robot).unwrap();
    let stops = robot.study_stops();
    for (arm, supports) in [
        (ArmMode::Fixed, SupportRule::AnyShape),
        (ArmMode::FlatForearm, SupportRule::ElbowNotHand),
    ] {
        let mapping = Mapping::new(robot, MappingVariant::Exact, arm).unwrap();
        let stance = Stance {
            supports,
            squeeze: 4.0,
        };
        let source = StaticTorques::new(robot.as_ref(), mapping, &stops, stance).unwrap();
        let nodes = shuffled_nodes(7).into_iter();
        // The ankles' stops differ by 0.2°: where one is reached the pose has no mirror image.
        let commands = nodes
            .filter_map(|at| source.command(at).ok())
            .filter(|angles| {
                angles[robot.chain.left.ankle].to_bits()
                    == angles[robot.chain.right.ankle].to_bits()
            });
        for angles in commands.take(40) {
            let balance = statics::rest(robot, &half, &angles, stance).unwrap();
            let work = virtual_work::loads(robot, &half, &angles, stance).unwrap();
            for (index, joint) in robot.joints.iter().enumerate() {
                let difference = (balance.load(JointId(index)) - work[index]).abs();
                assert!(
                    difference < 1e-6,
                    "{}: {difference} N·m, {balance:?}",
                    joint.name
                );
            }
        }
    }
}

/// The rigid body against stiff servos. 0.01 N·m is four times what is left of contacts that give
/// and servos that sag.
#[test]
fn statics_agrees_with_a_settled_stiff_simulation() {
    let loaded = nao();
    let robot = loaded.robot();
    let statics = table_statics(robot);
    let world = World::new(&loaded, STIFF).unwrap();
    let simulation = SettledTorques::new(&world, table_mapping(robot));
    let mut nodes = shuffled_nodes(1);
    nodes.retain(|&at| table_mapping(robot).chain().close(at).is_ok());
    let compared: Vec<_> = nodes[..500]
        .par_iter()
        .map(|&at| {
            let (rest, settled) = (statics.rest(at).unwrap(), simulation.settled(at).unwrap());
            let joints = robot.chain.right.pitch_joints();
            let loads = joints.map(|joint| rest.load(joint));
            let simulated = joints.map(|joint| -settled.means.applied_torque[joint.0]);
            let mut carried = [0.0; ContactGroup::COUNT];
            for support in rest.footing.supports() {
                carried[support.group as usize] += support.reaction;
            }
            let toe = ContactGroup::Toe as usize;
            let toe_error = (carried[toe] - settled.means.contact[toe]).abs();
            let pose = robot.forward_kinematics(settled.ground_from_root, &settled.angles);
            let rigid =
                robot.forward_kinematics(rest.ground_from_root, &statics.command(at).unwrap());
            let [rigid, settled] = [rigid, pose].map(|poses| robot.top(&poses, |_| true));
            let top_error = (rigid - settled).abs();
            ((loads, simulated), toe_error, top_error)
        })
        .collect();
    let pairs: Vec<_> = compared.iter().map(|row| row.0).collect();
    for (joint, name) in JOINTS.into_iter().enumerate() {
        let error = median_error(&pairs, joint);
        println!("{name}: median {error:.4} N·m");
        assert!(error <= 0.01, "{name}: median error {error} N·m");
    }
    // The toes' share of the weight and the height, as far as the same sag moves them.
    let toe_error = median(compared.iter().map(|row| row.1).collect());
    let top_error = median(compared.iter().map(|row| row.2).collect());
    println!(
        "toes: median {toe_error:.4} N, top: median {:.3} mm",
        top_error * 1e3
    );
    assert!(toe_error <= 0.1, "toes carry {toe_error} N more or less");
    assert!(top_error <= 1e-3, "the top is off by {top_error} m");
}

#[test]
fn reference_statics_against_the_recorded_table() {
    let Some(table) = recorded_table() else {
        return;
    };
    let loaded = nao();
    let pairs = beside_table(&table, &table_statics(loaded.robot()), 1);
    assert_eq!(
        pairs.len(),
        10_424,
        "12,600 rows less 2,175 mirrored and one without torques"
    );
    for (joint, name) in JOINTS.into_iter().enumerate() {
        let (error, together) = (median_error(&pairs, joint), correlation(&pairs, joint));
        println!("{name}: median {error:.4} N·m, correlation {together:.3}");
        assert!(
            error <= TABLE_MEDIANS[joint],
            "{name}: median error {error} N·m"
        );
    }
}

/// Every seventh valid row (the innermost axis has 24 nodes, so none is favoured). All 10,424 take
/// two minutes of processor time and give medians of .033 .040 .049 .037 and correlations of
/// .955 .882 .913 .860.
#[test]
fn reference_settled_simulation_against_the_recorded_table() {
    let Some(table) = recorded_table() else {
        return;
    };
    let loaded = nao();
    let world = World::new(&loaded, Regime::TABLE).unwrap();
    let source = SettledTorques::new(&world, table_mapping(loaded.robot()));
    let pairs = beside_table(&table, &source, 7);
    for (joint, name) in JOINTS.into_iter().enumerate() {
        let (error, together) = (median_error(&pairs, joint), correlation(&pairs, joint));
        println!("{name}: median {error:.4} N·m, correlation {together:.3}");
        assert!(
            error <= TABLE_MEDIANS[joint],
            "{name}: median error {error} N·m"
        );
        assert!(
            together >= TABLE_CORRELATIONS[joint],
            "{name}: correlation {together}"
        );
    }
}

/// A flat forearm touches all along; the elbow's soft servos leave the load at the elbow. Taking
/// the hand for the front support instead would be off by 0.9 N·m at the shoulder.
#[test]
fn the_elbow_carries_a_flat_forearm() {
    let loaded = nao();
    let robot = loaded.robot();
    let gait = shipped::gait("optimal").unwrap().unwrap();
    let mapping = Mapping::new(robot, gait.mapping, gait.arm).unwrap();
    let world = World::new(&loaded, Regime::TABLE).unwrap();
    let simulation = SettledTorques::new(&world, mapping.clone());
    let shoulder_error = |supports: SupportRule| {
        let stance = Stance::unsqueezed(supports);
        let stops = robot.study_stops();
        let statics = StaticTorques::new(robot.as_ref(), mapping.clone(), &stops, stance).unwrap();
        let errors = (0..=20).map(|step| {
            let at = gait.parameters(f64::from(step) / 20.0);
            let ours = statics.torques(at).unwrap().shoulder;
            (ours - simulation.torques(at).unwrap().shoulder).abs()
        });
        median(errors.collect())
    };
    // What is left is the forearm's own share, which grows as the upper arm nears the vertical.
    let elbow = shoulder_error(SupportRule::ElbowNotHand);
    let any = shoulder_error(SupportRule::AnyShape);
    println!("shoulder: median {elbow:.3} N·m with the elbow, {any:.3} N·m with the hand");
    assert!(elbow < 0.15, "{elbow} N·m");
    assert!(any > 0.5, "{any} N·m");
}

/// The engine gives the same answer from another start: what is read is a rest, not a transient.
#[test]
fn settled_torques_do_not_depend_on_how_the_robot_was_laid_down() {
    let loaded = nao();
    let robot = loaded.robot();
    let statics = table_statics(robot);
    let world = World::new(&loaded, Regime::TABLE).unwrap();
    let source = SettledTorques::new(&world, table_mapping(robot));
    let nodes = shuffled_nodes(3)
        .into_iter()
        .filter(|&at| statics.rest(at).is_ok());
    for at in nodes.take(20) {
        let from_chain = source.settled(at).unwrap();
        let placement = prone_sim::Placement {
            posture: statics.command(at).unwrap(),
            pitch: virtual_work::pitch(&statics.rest(at).unwrap()),
        };
        let from_rest = prone_sim::settled::settle(&world, &placement).unwrap();
        for joint in robot.chain.right.pitch_joints() {
            let torques = [&from_chain, &from_rest].map(|run| run.means.applied_torque[joint.0]);
            let apart = (torques[0] - torques[1]).abs();
            // Ten times the change per control step that counts as still.
            assert!(apart < 10.0 * prone_sim::settled::STILL, "{apart} N·m");
        }
    }
}
