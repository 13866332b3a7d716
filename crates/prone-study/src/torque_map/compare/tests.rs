//! Comparisons with known results.

use prone::torque_map::{Axis, ContactForces, Grid, JointTorques, TorqueMap};

use super::*;

fn axis(low_deg: f64, high_deg: f64, nodes: usize) -> Axis {
    Axis::new(low_deg.to_radians(), high_deg.to_radians(), nodes).unwrap()
}

fn coarse() -> Grid {
    Grid {
        knee: axis(0.0, 40.0, 3),
        hip: axis(-20.0, 20.0, 3),
        upper_arm: axis(-90.0, -30.0, 4),
    }
}

/// Half the step, and more of θ4.
fn fine() -> Grid {
    Grid {
        knee: axis(0.0, 40.0, 5),
        hip: axis(-20.0, 40.0, 7),
        upper_arm: axis(-90.0, -30.0, 7),
    }
}

const TOE_ELBOW: ContactForces = ContactForces::from_array([30.0, 22.0, 0.0, 0.0]);
const TOE_TORSO: ContactForces = ContactForces::from_array([30.0, 0.0, 22.0, 0.0]);

/// Linear in the angles, so that nodes of both grids agree; `change` alters rows by index.
fn map(grid: Grid, change: impl Fn(usize, [f64; 4]) -> Row) -> RecordedMap {
    let rows: Vec<Row> = (0..grid.len())
        .map(|index| {
            let at = grid.node(index);
            change(index, [at.knee, at.hip, at.upper_arm, 0.5])
        })
        .collect();
    let contacts = rows
        .iter()
        .map(|row| matches!(row, Row::Torques(_)).then_some(TOE_ELBOW));
    let contacts = contacts.collect();
    RecordedMap::new(TorqueMap::new(grid, rows).unwrap(), contacts).unwrap()
}

fn torques(numbers: [f64; 4]) -> Row {
    Row::Torques(JointTorques::from_array(numbers))
}

fn plain(grid: Grid) -> RecordedMap {
    map(grid, |_, numbers| torques(numbers))
}

#[test]
fn identity_a_map_agrees_with_itself_and_with_a_finer_one() {
    for (a, b) in [(coarse(), coarse()), (coarse(), fine()), (fine(), coarse())] {
        let found = compare(&plain(a), &plain(b), 2).unwrap();
        assert_eq!((found.common_nodes, found.compared), (36, 36));
        assert_eq!(
            found.rows,
            Sides {
                a: a.len(),
                b: b.len()
            }
        );
        for joint in &found.joints {
            assert!(
                joint.rms_nm < 1e-12 && joint.percentile_90_nm < 1e-12,
                "{joint:?}"
            );
        }
        assert!(
            found.joints[..3]
                .iter()
                .all(|j| j.correlation.unwrap() > 1.0 - 1e-12)
        );
        assert_eq!(found.joints[3].correlation, None, "a flat torque has none");
        assert_eq!(
            found.modes,
            Some(Modes {
                known: 36,
                same: 36
            })
        );
    }
}

/// The knee's torque is off by 0, 0.01, … 0.35 N·m over 36 rows.
#[test]
fn identity_known_differences_come_back() {
    let shift = |index: usize| 0.01 * index as f64;
    let a = map(coarse(), |index, [ankle, knee, hip, shoulder]| {
        torques([ankle, knee + shift(index), hip, shoulder])
    });
    let found = compare(&a, &plain(coarse()), 3).unwrap();
    let knee = &found.joints[1];
    let squares: f64 = (0..36).map(|index| shift(index).powi(2)).sum();
    assert!((knee.rms_nm - (squares / 36.0).sqrt()).abs() < 1e-12);
    assert!((knee.median_nm - 0.175).abs() < 1e-12);
    assert!((knee.percentile_90_nm - 0.315).abs() < 1e-12);
    assert!(found.joints[0].rms_nm < 1e-15);
    let largest: Vec<f64> = found.worst.iter().map(|row| row.difference_nm).collect();
    for (found, expected) in largest.iter().zip([0.35, 0.34, 0.33]) {
        assert!((found - expected).abs() < 1e-12, "{largest:?}");
    }
    let row = &found.worst[0];
    assert_eq!(
        (row.joint, row.theta3_deg, row.theta4_deg, row.alpha_deg),
        ("knee", 40.0, 20.0, -30.0)
    );
    let turned = compare(&plain(coarse()), &a, 1).unwrap();
    assert!(
        (turned.worst[0].difference_nm + 0.35).abs() < 1e-12,
        "a minus b"
    );
}

#[test]
fn rows_without_torques_are_counted_by_reason() {
    let masked = |mask| Row::Masked {
        mask,
        recorded: None,
    };
    let a = map(coarse(), |index, numbers| match index {
        0 | 1 => masked(Mask::Mirrored),
        2 => masked(Mask::Missing),
        _ => torques(numbers),
    });
    let b = map(coarse(), |index, numbers| match index {
        1 | 5 => masked(Mask::Open),
        6 => masked(Mask::Failed),
        _ => torques(numbers),
    });
    let found = compare(&a, &b, 0).unwrap();
    assert_eq!(found.compared, 36 - 5, "row 1 is masked in both");
    let counts = |missing, mirrored, open, failed| MaskCounts {
        missing,
        mirrored,
        open,
        failed,
    };
    assert_eq!(found.masked.a, counts(1, 2, 0, 0));
    assert_eq!(found.masked.b, counts(0, 0, 2, 1));
    assert!(found.worst.is_empty());
    let none = map(coarse(), |_, _| masked(Mask::Open));
    assert_eq!(
        compare(&a, &none, 0).unwrap_err().to_string(),
        "none of the 36 common rows has torques in both files"
    );
}

#[test]
fn contact_modes_are_compared_where_both_are_known() {
    let a = plain(coarse());
    let mut contacts = a.contacts().to_vec();
    contacts[4] = Some(TOE_TORSO);
    contacts[5] = None;
    let b = map(coarse(), |index, mut numbers| {
        numbers[3] += if index == 4 { 1.0 } else { 0.0 };
        torques(numbers)
    });
    let b = RecordedMap::new(b.into_map(), contacts).unwrap();
    let found = compare(&a, &b, 1).unwrap();
    assert_eq!(
        found.modes,
        Some(Modes {
            known: 35,
            same: 34
        })
    );
    let carrying = &found.worst[0].carrying;
    assert_eq!(carrying.a.as_deref(), Some("toe+elbow"));
    assert_eq!(carrying.b.as_deref(), Some("toe+torso"));
    let unknown = RecordedMap::new(b.into_map(), vec![None; 36]).unwrap();
    let found = compare(&a, &unknown, 1).unwrap();
    assert_eq!((found.modes, &found.worst[0].carrying.b), (None, &None));
}

#[test]
fn limit_grids_that_only_overlap_are_refused() {
    let mut other = coarse();
    other.hip = axis(-20.0, 40.0, 4);
    assert!(compare(&plain(coarse()), &plain(other), 0).is_ok());
    other.knee = axis(0.0, 20.0, 2);
    assert_eq!(
        compare(&plain(coarse()), &plain(other), 0)
            .unwrap_err()
            .to_string(),
        "neither grid lies within the other, node on node: the first has theta3 0..40° by 20°, \
         theta4 -20..20° by 20°, alpha -90..-30° by 20°, the second theta3 0..20° by 20°, \
         theta4 -20..40° by 20°, alpha -90..-30° by 20°"
    );
    let mut shifted = coarse();
    shifted.knee = axis(5.0, 35.0, 3);
    assert!(compare(&plain(coarse()), &plain(shifted), 0).is_err());
}
