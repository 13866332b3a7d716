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

#[test]
fn the_answer_is_the_fastest_that_gets_through_every_corner() {
    let passage = under(205.0, &["hip-10", "thesis-nominal"]);
    assert!(passage.feasible, "{passage:?}");
    let times: Vec<f64> = passage.candidates.iter().map(|it| it.time_s).collect();
    assert!(times.is_sorted(), "{times:?}");
    for it in &passage.candidates {
        assert_eq!(
            it.robust == Some(true),
            it.corners_passed == passage.corners
        );
    }
    let named = passage.gait.as_deref();
    let robust = passage.candidates.iter().find(|it| it.robust == Some(true));
    assert_eq!(passage.robust, robust.is_some());
    if let Some(robust) = robust {
        assert_eq!(named, Some(robust.gait.as_str()));
        assert!(robust.worst_mm_per_cycle <= robust.mm_per_cycle);
    }
}

#[test]
fn a_ceiling_is_told_as_it_was_typed() {
    assert!((under(175.3, &[]).ceiling_mm - 175.3).abs() < f64::EPSILON);
}
