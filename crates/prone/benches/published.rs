//! Evaluations of the published objective on one core.
//!
//! On a table of the original's shape (21 × 24 × 25) with made-up torques: the time does not
//! depend on what they are.

use prone::chain::ClosedChain;
use prone::cost::published::{Coefficients, PublishedObjective, PublishedRules};
use prone::torque_map::{Axis, Grid, JointTorques, Row, TorqueMap};

const NAO: ClosedChain = ClosedChain {
    toe_to_ankle: 0.10385,
    ankle_to_knee: 0.1029,
    knee_to_hip: 0.1,
    hip_to_shoulder: 0.1885,
    shoulder_to_elbow: 0.08975,
    span: 0.430,
};

fn main() {
    divan::main();
}

fn objective() -> PublishedObjective {
    let grid = Grid {
        knee: Axis::new(-0.09, 0.79, 21).expect("ascending"),
        hip: Axis::new(-0.52, 0.48, 24).expect("ascending"),
        upper_arm: Axis::new(-1.57, -0.52, 25).expect("ascending"),
    };
    let made_up = |k: usize| JointTorques::from_array([(k % 7) as f64, 0.3, -0.1, (k % 3) as f64]);
    let rows = (0..grid.len()).map(|k| Row::Torques(made_up(k))).collect();
    let map = TorqueMap::new(grid, rows).expect("one row per node");
    PublishedObjective::new(NAO, &map, PublishedRules::PUBLISHED).expect("no gaps")
}

#[divan::bench]
fn price(bencher: divan::Bencher) {
    let objective = objective();
    let gait = Coefficients::through_end([0.2365, 0.0893, 1.8796, -0.1365, -0.2134, 1.1570]);
    bencher.bench(|| objective.price(divan::black_box(&gait)));
}
