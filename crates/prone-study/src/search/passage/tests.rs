use prone_files::shipped;
use prone_sim::{LoadedRobot, RobotFiles};

use super::*;
use crate::watch::Unwatched;

fn nao() -> LoadedRobot {
    LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap()
}

fn under(mm: f64, names: &[&str]) -> Passage {
    let cycles: Vec<Cycle> = names
        .iter()
        .map(|name| shipped::cycle(name).unwrap().unwrap())
        .collect();
    let offered = names.iter().zip(&cycles);
    let offered = offered.map(|(name, cycle)| Offered {
        cycle,
        called: name,
        origin: "shipped",
    });
    let offered: Vec<Offered<'_>> = offered.collect();
    let under = Under {
        height: mm * 1e-3,
        length: 0.5,
        margin: 2e-3,
    };
    let plates = Plates::new(&nao(), under).unwrap();
    Passage::answer(&plates, &offered, &Unwatched)
}

#[test]
fn what_the_shapes_rule_out_is_impossible_and_nothing_else_is() {
    let low = under(115.9, &["hip-10"]);
    assert!(low.impossible && !low.feasible && !low.may_be_searched());
    assert!(low.limited_by.contains("Head"), "{}", low.limited_by);
    assert!(low.candidates.is_empty());
    // Too low for that cycle, which is tried all the same.
    let tried = under(120.0, &["hip-10"]);
    assert!(!tried.impossible && !tried.feasible && tried.may_be_searched());
    let [candidate] = tried.candidates.as_slice() else {
        panic!("one candidate");
    };
    assert!(candidate.obstructed.is_some() && !candidate.passes);
    assert!(candidate.open_top_mm > 120.0);
}

/// The fastest as in the model touches the plate in a corner, the next one gets through all of them, and
/// the slowest is not tried there.
#[test]
fn the_answer_is_the_fastest_that_gets_through_every_corner() {
    let passage = under(200.0, &["thesis-nominal", "robot", "far-200"]);
    assert!(passage.feasible && passage.robust, "{passage:?}");
    assert_eq!(passage.gait.as_deref(), Some("robot"));
    let [far, low, tall] = passage.candidates.as_slice() else {
        panic!("{passage:?}");
    };
    assert_eq!(
        [&far.gait, &low.gait, &tall.gait],
        ["far-200", "robot", "thesis-nominal"]
    );
    assert!(far.time_s < low.time_s);
    assert_eq!((far.robust, low.robust), (Some(false), Some(true)));
    let failed = far.failed.as_ref().unwrap();
    assert!(failed.reason.contains("plate"), "{failed:?}");
    assert!(far.corners_passed < passage.corners);
    assert_eq!(low.corners_passed, passage.corners);
    assert!(low.worst_mm_per_cycle < low.mm_per_cycle && low.drift_mm > 0.0);
    assert!(!tall.passes && tall.open_top_mm > 200.0);
    assert_eq!(passage.named(), Some(low));
}

#[test]
fn a_ceiling_is_told_as_it_was_typed() {
    assert!((under(175.3, &[]).ceiling_mm - 175.3).abs() < f64::EPSILON);
}
