use proptest::prelude::*;

use super::*;

fn grid() -> Grid {
    Grid {
        knee: Axis::new(-0.1, 0.8, 4).unwrap(),
        hip: Axis::new(-0.5, 0.5, 3).unwrap(),
        upper_arm: Axis::new(-1.6, -0.5, 5).unwrap(),
    }
}

fn at(knee: f64, hip: f64, upper_arm: f64) -> GaitParameters {
    GaitParameters {
        knee,
        hip,
        upper_arm,
    }
}

/// Linear in each angle: trilinear interpolation reproduces it.
struct Multilinear;

impl TorqueSource for Multilinear {
    fn torques(&self, at: GaitParameters) -> Result<JointTorques, TorqueGap> {
        let (a, b, c) = (at.knee, at.hip, at.upper_arm);
        Ok(JointTorques::from_array([
            a * b * c,
            1.0 - 2.0 * b,
            a + c,
            b * c - a,
        ]))
    }
}

proptest! {
    #[test]
    fn identity_multilinear_torques_are_reproduced(a in -0.1..0.8_f64, b in -0.5..0.5_f64, c in -1.6..-0.5_f64) {
        let map = TorqueMap::measure(grid(), &Multilinear);
        let (found, exact) = (map.torques(at(a, b, c)).unwrap(), Multilinear.torques(at(a, b, c)).unwrap());
        for (found, exact) in found.to_array().into_iter().zip(exact.to_array()) {
            prop_assert!((found - exact).abs() < 1e-14);
        }
    }

    #[test]
    fn identity_weights_of_a_cell_sum_to_one(a in -0.1..0.8_f64, b in -0.5..0.5_f64, c in -1.6..-0.5_f64) {
        let cell = grid().locate(at(a, b, c)).unwrap();
        let sum: f64 = grid().corners(&cell).iter().map(|(_, weight)| weight).sum();
        prop_assert!((sum - 1.0).abs() < 1e-15);
    }
}

#[test]
fn identity_every_node_answers_with_its_row() {
    let map = TorqueMap::measure(grid(), &Multilinear);
    let mut seen: Vec<usize> = grid().recorded_order().collect();
    for index in 0..grid().len() {
        let Row::Torques(row) = map.rows()[index] else {
            panic!("masked")
        };
        let found = map.torques(grid().node(index)).unwrap();
        for (found, row) in found.to_array().into_iter().zip(row.to_array()) {
            assert!((found - row).abs() < 1e-14);
        }
    }
    seen.sort_unstable();
    assert!(seen.into_iter().eq(0..grid().len()));
}

#[test]
fn limit_outside_and_nan_are_answers_that_say_so() {
    let map = TorqueMap::measure(grid(), &Multilinear);
    assert!(map.torques(at(0.8 + 0.9e-4, 0.0, -1.0)).is_ok());
    let message = map.torques(at(0.0, 0.51, -1.0)).unwrap_err().to_string();
    assert_eq!(
        message,
        "theta4 = 0.5100 rad is outside the map's -0.5000..0.5000"
    );
    assert!(matches!(
        map.torques(at(f64::NAN, 0.0, -1.0)),
        Err(TorqueGap::Outside { .. })
    ));
}

#[test]
fn limit_a_masked_corner_counts_only_where_it_has_weight() {
    let full = TorqueMap::measure(grid(), &Multilinear);
    let mut rows = full.rows().to_vec();
    let masked = grid().index(1, 1, 2);
    let recorded = rows[masked].recorded();
    rows[masked] = Row::Masked {
        mask: Mask::Mirrored,
        recorded,
    };
    let map = TorqueMap::new(grid(), rows).unwrap();
    let node = grid().node(masked);
    assert!(matches!(map.torques(node), Err(TorqueGap::Masked { row, .. }) if row == masked));
    let beside = at(node.knee + 0.01, node.hip + 0.01, node.upper_arm + 0.01);
    assert!(map.torques(beside).is_err());
    // A neighbour whose cell has the masked row for its upper corner.
    assert!(map.torques(grid().node(grid().index(0, 1, 2))).is_ok());
}

/// A 2 × 2 × 2 table in the original's layout and order.
fn table() -> Vec<String> {
    let mut rows = Vec::new();
    for alpha in ["-0.5236", "-1.5708"] {
        for knee in ["0", "0.1"] {
            for hip in ["0.2", "-0.2"] {
                rows.push(format!(
                    "1.8,-2.1,{knee},{hip},-0.6,{alpha},0,0,0,0,{knee},{hip},3,{alpha}"
                ));
            }
        }
    }
    rows
}

#[test]
fn identity_the_recorded_order_is_read() {
    let mut rows = table();
    rows[0] = "1.8,-2.1,0,0.2,-0.6,-0.5236,0,0,0,0,NaN,NaN,NaN,NaN".to_owned();
    rows[3] = "-1.6,2.0,0.1,-0.2,-0.6,-0.5236,0,0,0,0,7,7,7,7".to_owned();
    let map = parse(&rows.join("\n")).unwrap();
    assert_eq!(
        (map.masked(Mask::Missing), map.masked(Mask::Mirrored)),
        (1, 1)
    );
    for (index, row) in map.rows().iter().enumerate() {
        if let Row::Torques(torques) = row {
            let node = map.grid().node(index);
            assert_eq!(
                *torques,
                JointTorques::from_array([node.knee, node.hip, 3.0, node.upper_arm])
            );
        }
    }
}

#[test]
fn limit_errors_name_row_column_and_value() {
    let broken = |row: usize, from: &str, to: &str| {
        let mut rows = table();
        rows[row] = rows[row].replace(from, to);
        parse(&rows.join("\n")).unwrap_err().to_string()
    };
    assert_eq!(
        broken(2, ",-0.6,", ",oops,"),
        "row 3, column theta5: `oops` is not a number that belongs there"
    );
    assert_eq!(
        broken(1, ",-0.6,", ",NaN,"),
        "row 2, column theta5: `NaN` is not a number that belongs there"
    );
    assert_eq!(broken(4, "1.8,", ""), "row 5 has 13 columns, not 14");
    assert_eq!(
        broken(6, ",0.1,0.2,-0.6", ",0.05,0.2,-0.6"),
        "row 7, column theta3: 0.05 rad, but a regular grid has 0.10000 there"
    );
    let short = table()[..7].join("\n");
    assert!(matches!(
        parse(&short),
        Err(ParseError::Shape { rows: 7, .. })
    ));
    assert!(parse("").is_err());
}
