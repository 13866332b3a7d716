use proptest::prelude::*;

use super::*;
use crate::mapping::{ArmMode, Mapping, MappingVariant};
use crate::robot::testing::two_armed;

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
        let corners = grid().corners(at(a, b, c)).unwrap();
        let sum: f64 = corners.iter().map(|(_, weight)| weight).sum();
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

fn file(lines: &[String]) -> String {
    lines.join("\n") + "\n"
}

#[test]
fn limit_a_file_that_is_cut_in_its_last_number_is_refused() {
    let whole = file(&table());
    assert!(parse(&whole).is_ok());
    for cut in 1..3 {
        let error = parse(&whole[..whole.len() - cut]).unwrap_err();
        assert_eq!(
            error.to_string(),
            "line 8 has no end: the file is cut there"
        );
    }
}

#[test]
fn identity_the_recorded_order_is_read() {
    let mut rows = table();
    rows[0] = "1.8,-2.1,0,0.2,-0.6,-0.5236,0,0,0,0,NaN,NaN,NaN,NaN".to_owned();
    rows[3] = "-1.6,2.0,0.1,-0.2,-0.6,-0.5236,0,0,0,0,7,7,7,7".to_owned();
    let map = parse(&file(&rows)).unwrap();
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
        parse(&file(&rows)).unwrap_err().to_string()
    };
    assert_eq!(
        broken(2, ",-0.6,", ",oops,"),
        "line 3, column theta5: `oops` is not a number that belongs there"
    );
    assert_eq!(
        broken(1, ",-0.6,", ",NaN,"),
        "line 2, column theta5: `NaN` is not a number that belongs there"
    );
    assert_eq!(
        broken(4, "1.8,", ""),
        "line 5 has 13 columns, not 14 as the rows before it"
    );
    assert_eq!(broken(0, "1.8,", ""), "line 1 has 13 columns, not 14 or 18");
    assert_eq!(
        broken(6, ",0.1,0.2,-0.6", ",0.05,0.2,-0.6"),
        "line 7, column theta3: 0.05 rad, but a regular grid has 0.10000 there"
    );
    let short = file(&table()[..7]);
    assert!(matches!(
        parse(&short),
        Err(ParseError::Shape { rows: 7, .. })
    ));
    assert_eq!(parse("# none"), Err(ParseError::Empty));
}

#[test]
fn limit_lines_are_those_of_the_file() {
    let mut lines = vec!["# by hand".to_owned(), "#theta1,theta2".to_owned()];
    lines.extend(table());
    let commented = |lines: &[String]| parse(&file(lines));
    assert_eq!(commented(&lines), commented(&table()));
    lines.insert(5, "# in between".to_owned());
    lines[6] = lines[6].replace("1.8", "x");
    assert_eq!(
        commented(&lines).unwrap_err().to_string(),
        "line 7, column theta1: `x` is not a number that belongs there"
    );
    lines[6] = "x".to_owned();
    assert_eq!(
        commented(&lines).unwrap_err().to_string(),
        "line 7 has 1 columns, not 14 as the rows before it"
    );
}

#[test]
fn limit_a_row_without_torques_says_why() {
    let with_forces = |row: &str| format!("{row},10,20,0,0");
    let rows: Vec<_> = table().iter().map(|row| with_forces(row)).collect();
    let first = |row: &str| {
        let mut rows = rows.clone();
        row.clone_into(&mut rows[0]);
        parse_recorded(&file(&rows)).map(|recorded| {
            let index = recorded.map().grid().recorded_order().next().unwrap();
            (recorded.map().rows()[index], recorded.contacts()[index])
        })
    };
    let masked = |mask| Row::Masked {
        mask,
        recorded: None,
    };
    let nan = "NaN,NaN,NaN,NaN";
    assert_eq!(
        first(&format!("NaN,NaN,0,0.2,NaN,-0.5236,{nan},{nan},{nan}")).unwrap(),
        (masked(Mask::Open), None)
    );
    assert_eq!(
        first(&format!("1.8,-2.1,0,0.2,-0.6,-0.5236,0,0,0,0,{nan},{nan}")).unwrap(),
        (masked(Mask::Failed), None)
    );
    let (row, contacts) = first(&rows[0]).unwrap();
    assert!(matches!(row, Row::Torques(_)));
    assert_eq!(contacts.unwrap().to_string(), "toe+elbow");
    for (row, column) in [
        (
            format!("NaN,NaN,NaN,0.2,NaN,-0.5236,{nan},{nan},{nan}"),
            "theta3",
        ),
        (
            format!("1.8,-2.1,0,0.2,-0.6,-0.5236,0,0,0,NaN,1,1,1,1,{nan}"),
            "ShoulderPitch",
        ),
        (
            format!("1.8,-2.1,0,0.2,-0.6,-0.5236,0,0,0,0,1,inf,1,1,{nan}"),
            "tau3",
        ),
        (
            format!("1.8,-2.1,0,0.2,-0.6,-0.5236,0,0,0,0,{nan},1,2,3,inf"),
            "leg",
        ),
    ] {
        let message = first(&row).unwrap_err().to_string();
        assert!(
            message.starts_with(&format!("line 1, column {column}: ")),
            "{message}"
        );
    }
    let mut mixed = rows;
    mixed[3] = table()[3].clone();
    assert_eq!(
        parse(&mixed.join("\n")).unwrap_err().to_string(),
        "line 4 has 14 columns, not 18 as the rows before it"
    );
}

/// A hundredth of 60 N is 0.6 N.
#[test]
fn limit_a_grazing_group_does_not_carry() {
    let mode = |forces| ContactForces::from_array(forces).to_string();
    assert_eq!(mode([30.0, 29.5, 0.0, 0.5]), "toe+elbow");
    assert_eq!(mode([30.0, 0.0, 29.0, 1.0]), "toe+torso+leg");
    assert_eq!(mode([0.0; 4]), "none");
}

#[test]
fn limit_contacts_must_be_those_of_the_grid() {
    let map = TorqueMap::measure(grid(), &Multilinear);
    assert!(RecordedMap::new(map, vec![None; 59]).is_err());
}

/// The two-armed robot's chain closes in a part of this grid only.
fn reach() -> Grid {
    Grid {
        knee: Axis::new(-0.1, 2.4, 5).unwrap(),
        hip: Axis::new(-0.5, 0.5, 3).unwrap(),
        upper_arm: Axis::new(-1.6, -0.5, 4).unwrap(),
    }
}

fn four(range: std::ops::Range<f64>) -> impl Strategy<Value = [f64; 4]> {
    prop::array::uniform4(range)
}

proptest! {
    #[test]
    fn identity_what_is_written_is_read(
        torques in prop::collection::vec(four(-9.0..9.0), 60),
        forces in prop::collection::vec(prop::option::of(four(0.0..60.0)), 60),
        failed in prop::collection::vec(prop::bool::weighted(0.1), 60),
    ) {
        let robot = two_armed();
        let mapping = Mapping::new(&robot, MappingVariant::Original, ArmMode::Fixed).unwrap();
        let masked = |mask| Row::Masked { mask, recorded: None };
        let rows: Vec<_> = (0..60).map(|index| match mapping.chain().close(reach().node(index)) {
            Err(_) => masked(Mask::Open),
            Ok(_) if failed[index] => masked(Mask::Failed),
            Ok(_) => Row::Torques(JointTorques::from_array(torques[index])),
        }).collect();
        let open = rows.iter().filter(|row| **row == masked(Mask::Open)).count();
        prop_assert!(open > 0 && open < 60, "{open} of 60 rows are open");
        let contacts: Vec<_> = rows.iter().zip(&forces).map(|(row, forces)| match row {
            Row::Torques(_) => forces.map(ContactForces::from_array),
            Row::Masked { .. } => None,
        }).collect();
        let map = TorqueMap::new(reach(), rows).unwrap();
        let written = RecordedMap::new(map, contacts).unwrap();
        let comments_written = ["theta1, 2, 3".to_owned(), String::new()];
        let text = write(&comments_written, &robot, &mapping, &written);
        prop_assert_eq!(text.lines().count(), 62);
        prop_assert!(comments(&text).eq(comments_written.iter().map(String::as_str)));
        let read = parse_recorded(&text).unwrap();

        // Ten decimals are written.
        let near = |a: f64, b: f64| (a - b).abs() < 1e-10;
        let all_near = |a: [f64; 4], b: [f64; 4]| a.iter().zip(b).all(|(a, b)| near(*a, b));
        for (ours, theirs) in [
            (written.map().grid().knee, read.map().grid().knee),
            (written.map().grid().hip, read.map().grid().hip),
            (written.map().grid().upper_arm, read.map().grid().upper_arm),
        ] {
            prop_assert_eq!(ours.len(), theirs.len());
            prop_assert!(near(ours.low(), theirs.low()) && near(ours.high(), theirs.high()));
        }
        for (ours, theirs) in written.map().rows().iter().zip(read.map().rows()) {
            match (ours, theirs) {
                (Row::Torques(a), Row::Torques(b)) => prop_assert!(all_near(a.to_array(), b.to_array())),
                (ours, theirs) => prop_assert_eq!(ours, theirs),
            }
        }
        for (ours, theirs) in written.contacts().iter().zip(read.contacts()) {
            match (ours, theirs) {
                (Some(a), Some(b)) => prop_assert!(all_near(a.to_array(), b.to_array())),
                (ours, theirs) => prop_assert_eq!(ours, theirs),
            }
        }
    }
}

/// Chain and joint angles of a written row belong together, as in the original's: `KneePitch` is
/// θ3 up to the robot's zero, and the row says by which angles it was made.
#[test]
fn identity_written_angles_close_the_chain() {
    let robot = two_armed();
    let mapping = Mapping::new(&robot, MappingVariant::Original, ArmMode::Fixed).unwrap();
    let map = TorqueMap::measure(reach(), &Multilinear);
    let contacts = vec![None; reach().len()];
    let text = write(
        &[],
        &robot,
        &mapping,
        &RecordedMap::new(map, contacts).unwrap(),
    );
    let mut closed = 0;
    for line in text.lines() {
        let numbers: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        if numbers[0].is_nan() {
            assert!(numbers[6..10].iter().all(|angle| angle.is_nan()));
            continue;
        }
        closed += 1;
        let chain = mapping
            .chain()
            .close(at(numbers[2], numbers[3], numbers[5]))
            .unwrap();
        let sum: f64 = numbers[..5].iter().sum();
        assert!((sum - numbers[5]).abs() < 1e-9, "equation (3)");
        let joints = mapping.joint_angles(&robot, &chain).unwrap();
        let right = robot.chain.right.pitch_joints().map(|joint| joints[joint]);
        for (angle, written) in right.iter().zip(&numbers[6..10]) {
            assert!((angle - written).abs() < 1e-9);
        }
    }
    assert!(closed > 0);
}

/// What a spreadsheet or a data frame makes of a table is the same table, or is named.
#[test]
fn tables_of_others_are_read_or_named() {
    let mut lines = table();
    // One row without torques.
    lines[3] = "1.8,-2.1,0.1,-0.2,-0.6,-0.5236,0,0,0,0,NaN,NaN,NaN,NaN".to_owned();
    let table = format!("# a, comment\n{}", file(&lines));
    let whole = parse(&table).unwrap();
    let numbers = |text: &str| -> Vec<Vec<String>> {
        let lines = text.lines().filter(|line| !line.starts_with('#'));
        lines
            .map(|line| line.split(',').map(str::to_owned).collect())
            .collect()
    };
    let rows = numbers(&table);
    let written = |separator: &str, cell: &dyn Fn(&str) -> String| -> String {
        let row = |row: &Vec<String>| {
            let cells: Vec<String> = row.iter().map(|it| cell(it)).collect();
            cells.join(separator) + "\n"
        };
        rows.iter().map(row).collect()
    };
    let same = |cell: &str| cell.to_owned();
    let plain = written(",", &same);
    let header = COLUMNS[..rows[0].len()].join(",") + "\n";
    let counted: Vec<String> = (0..rows[0].len()).map(|index| index.to_string()).collect();
    for text in [
        plain.clone(),
        format!("\u{feff}{plain}"),
        plain.replace('\n', "\r\n"),
        plain.replace('\n', "\r"),
        format!("\"# a, \"\"comment\"\"\",,,\n\n{plain},,,\n\n"),
        format!("{header}{plain}"),
        format!("{}\n{plain}", counted.join(",")),
        written(",", &|cell| format!("\"{cell}\"")),
        written(" , ", &same),
        written(",", &|cell| cell.replace("NaN", "")),
        written(",", &|cell| cell.replace("NaN", "nan")),
    ] {
        assert_eq!(parse(&text), Ok(whole.clone()), "{text}");
    }
    let index = |row: usize, line: &str| format!("{row},{line}\n");
    let indexed: String = plain
        .lines()
        .enumerate()
        .map(|(row, line)| index(row, line))
        .collect();
    for (text, says) in [
        (
            written(";", &same),
            "line 1: its cells are separated by semicolons",
        ),
        (
            written(";", &|cell| cell.replace('.', ",")),
            "line 1: its cells are separated by semicolons",
        ),
        (
            written("\t", &same),
            "line 1: its cells are separated by tabs",
        ),
        (
            written(",", &|cell| format!("\"{}\"", cell.replace('.', ","))),
            "is not a number that belongs there: a number has a point, not a comma",
        ),
        (
            written(",", &|cell| cell.replace('-', "\u{2212}")),
            "a sign is written -",
        ),
        (
            written(",", &|cell| cell.replace("NaN", "#N/A")),
            "it stands for a number that is not there",
        ),
        (
            indexed,
            "write the table without its index (pandas: index=False)",
        ),
        (
            format!("{}\n{plain}", header.trim_end().replace("theta1", "theta2")),
            "column 1 is called theta2, where theta1 stands",
        ),
        (format!("sep=;\n{}", written(";", &same)), "semicolons"),
        (
            plain.trim_end().to_owned(),
            "has no end: the file is cut there",
        ),
    ] {
        let error = parse(&text).unwrap_err().to_string();
        assert!(error.contains(says), "{error}\nnot {says}");
    }
}
