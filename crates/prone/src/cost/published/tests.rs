use proptest::prelude::*;

use super::*;
use crate::torque_map::{self, Axis, Mask, Row};

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
/// Bell 2015, chapter V, table 3; the objective supplies its own constant terms.
const TABLE_3: Coefficients = Coefficients([
    [0.2365, 0.0893, -0.3267],
    [1.8796, -0.1365, -1.7434],
    [-0.2134, 1.1570, -1.9898],
]);

/// A small table whose torques are smooth functions of the angles.
fn smooth_map() -> TorqueMap {
    let grid = Grid {
        knee: Axis::new(-0.1, 0.8, 5).unwrap(),
        hip: Axis::new(-0.5, 0.5, 4).unwrap(),
        upper_arm: Axis::new(-1.6, -0.5, 6).unwrap(),
    };
    let torques = |index| {
        let at = grid.node(index);
        JointTorques::from_array([
            at.knee.sin(),
            at.hip * at.upper_arm,
            at.hip - 0.3,
            at.upper_arm.cos(),
        ])
    };
    let rows = (0..grid.len())
        .map(|index| Row::Torques(torques(index)))
        .collect();
    TorqueMap::new(grid, rows).unwrap()
}

/// Equation (1) as it reads: the chain closed by [`ClosedChain::close`], one sample at a time.
fn price_as_it_reads(objective: &PublishedObjective, gait: &Coefficients) -> PublishedPrice {
    let mut violated = ViolatedSamples::default();
    let (mut torque, mut before) = (0.0, f64::INFINITY);
    for k in 0..SAMPLES {
        let s = k as f64 / 100.0;
        let cubic = |p: usize| {
            let [c3, c2, c1] = gait.0[p];
            ((c3 * s + c2) * s + c1) * s + START[p]
        };
        let at = GaitParameters {
            knee: cubic(0),
            hip: cubic(1),
            upper_arm: cubic(2),
        };
        let height = NAO.close(at).map(|angles| NAO.posture(&angles).hip.z());
        let outside = |axis: &Axis, value: f64| {
            let tolerance = objective.rules.limit_tolerance;
            u32::from(value < axis.low() - tolerance || value > axis.high() + tolerance)
        };
        violated.arm_returns += u32::from(at.upper_arm - before > 0.0);
        violated.hip_low += u32::from(!height.is_ok_and(|z| z >= objective.rules.hip_threshold));
        violated.knee_range += outside(&objective.grid.knee, at.knee);
        violated.hip_range += outside(&objective.grid.hip, at.hip);
        violated.arm_range += outside(&objective.grid.upper_arm, at.upper_arm);
        before = at.upper_arm;
        let tau = objective.torques(at);
        torque += TIME_STEP
            * (tau.ankle.powi(2) + tau.knee.powi(2) + tau.hip.powi(2) + 5.0 * tau.shoulder.powi(2));
    }
    PublishedPrice {
        violated,
        excess: 0.0,
        torque,
    }
}

fn objective(rules: PublishedRules) -> PublishedObjective {
    PublishedObjective::new(NAO, &smooth_map(), rules).unwrap()
}

proptest! {
    /// identity: the kernel and the formula as it reads, on random gaits of the search space.
    #[test]
    fn kernel_matches_the_formula_as_it_reads(free in prop::array::uniform6(-2.0..2.0_f64), hip_mm in 5.0..45.0_f64) {
        let objective = objective(PublishedRules { hip_threshold: hip_mm / 1000.0, limit_tolerance: 1e-4 });
        let gait = Coefficients::through_end(free);
        let (fast, slow) = (objective.price(&gait), price_as_it_reads(&objective, &gait));
        prop_assert_eq!(fast.violated, slow.violated);
        // Sums of 101 terms of order 0.1, reordered.
        prop_assert!((fast.torque - slow.torque).abs() < 1e-9);
        prop_assert_eq!(fast.excess > 0.0, fast.violated.total() > 0);
    }

    /// identity: the height without an inverse function is that of the closed chain.
    #[test]
    fn hip_height_is_that_of_the_closed_chain(free in prop::array::uniform6(-2.0..2.0_f64)) {
        let gait = Coefficients::through_end(free);
        let phases = std::array::from_fn(|k| k as f64 / 100.0);
        let path = kernel::Path::new(&phases, &gait);
        for (height, [knee, hip, upper_arm]) in path.hip_heights(&NAO).into_iter().zip(path.samples()) {
            match NAO.close(GaitParameters { knee, hip, upper_arm }) {
                Ok(angles) => {
                    // Near the straight leg both lose half the digits to the square root.
                    let slack = if height.is_nan() { 1e-7 } else { 1e-9 };
                    let height = if height.is_nan() { NAO.posture(&angles).hip.z() } else { height };
                    prop_assert!((height - NAO.posture(&angles).hip.z()).abs() < slack);
                }
                Err(_) => prop_assert!(height.is_nan()),
            }
        }
    }

    #[test]
    fn six_free_coefficients_reach_the_end(free in prop::array::uniform6(-2.0..2.0_f64)) {
        let gait = Coefficients::through_end(free);
        for (i, cubic) in gait.0.iter().enumerate() {
            let miss = START[i] + cubic.iter().sum::<f64>() - END[i];
            prop_assert!(miss.abs() < 1e-15);
        }
    }
}

#[test]
fn limit_standing_still_is_not_returning() {
    let mut gait = Coefficients::NOMINAL;
    gait.0[2] = [0.0; 3];
    let count = |gait| {
        objective(PublishedRules::PUBLISHED)
            .price(&gait)
            .violated
            .arm_returns
    };
    assert_eq!(count(gait), 0);
    gait.0[2] = [0.0, 0.0, 0.1];
    assert_eq!(count(gait), 100);
}

#[test]
fn limit_a_row_without_torques_takes_its_neighbours() {
    let map = smooth_map();
    let mut rows = map.rows().to_vec();
    let missing = Row::Masked {
        mask: Mask::Missing,
        recorded: None,
    };
    rows[3] = missing;
    let gappy = TorqueMap::new(*map.grid(), rows.clone()).unwrap();
    let table = without_gaps(&gappy).unwrap();
    assert_eq!(
        Some(table[3]),
        map.rows()[2].recorded().map(JointTorques::to_array)
    );

    rows[2] = missing;
    let hollow = TorqueMap::new(*map.grid(), rows).unwrap();
    assert_eq!(without_gaps(&hollow), Err(PublishedError { row: 3 }));
}

/// A recorded table, or `None` with a word about it.
///
/// # Panics
/// Where it is absent and `PRONE_REQUIRE_REFERENCE=1`.
fn recorded(file: &str) -> Option<TorqueMap> {
    let default = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/reference");
    let folder = std::env::var("PRONE_REFERENCE_DIR").unwrap_or_else(|_| default.to_owned());
    let path = std::path::Path::new(&folder).join(file);
    match std::fs::read_to_string(&path) {
        Ok(text) => Some(torque_map::parse(&text).unwrap()),
        Err(error) => {
            let required = std::env::var("PRONE_REQUIRE_REFERENCE").is_ok_and(|value| value == "1");
            assert!(!required, "{}: {error}", path.display());
            println!("skipped: {}: {error}", path.display());
            None
        }
    }
}

/// The published objective (Bell 2015, chapter IV) on the two tables that its author recorded, as
/// another program computed it.
#[test]
fn reference_published_costs() {
    for (file, nominal, table_3) in [
        ("torque-table-5deg.csv", 203_001.81, 35_001.55),
        ("torque-table-2.5deg.csv", 102_001.68, 15_001.55),
    ] {
        let Some(map) = recorded(file) else { return };
        let objective = PublishedObjective::new(NAO, &map, PublishedRules::PUBLISHED).unwrap();
        for (gait, cost) in [(Coefficients::NOMINAL, nominal), (TABLE_3, table_3)] {
            let price = objective.price(&gait);
            assert!(
                (price.cost() - cost).abs() < 0.01,
                "{file}: {price:?}, not {cost}"
            );
        }
    }
}

/// Rows that were counted in the files of the author: a grid of 2.5° (Bell 2015, chapter IV) that goes
/// on to θ4 = 27.5°, and one of 5° up to 15°, on which the published optimum was found.
#[test]
fn reference_shape_of_the_recorded_tables() {
    for (file, rows, mirrored) in [
        ("torque-table-5deg.csv", 1_430, 325),
        ("torque-table-2.5deg.csv", 12_600, 2_175),
    ] {
        let Some(map) = recorded(file) else { return };
        assert_eq!(map.rows().len(), rows);
        assert_eq!(map.masked(Mask::Mirrored), mirrored);
        assert_eq!(map.masked(Mask::Missing), 1);
    }
}
