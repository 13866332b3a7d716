use prone::gait::cycle::TimeScale;
use prone_files::shipped;

use super::*;
use crate::load::{LoadedRobot, RobotFiles};
use crate::regime::Regime;

fn nao() -> LoadedRobot {
    LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap()
}

fn crawl(world: &World, cycle: &str, cycles: usize, turn: f64) -> Crawl {
    let cycles_of = [shipped::cycle(cycle).unwrap().unwrap()];
    let plan = CrawlPlan {
        cycles: &cycles_of,
        scale: TimeScale::ONE,
        end: End::Cycles(cycles),
        offsets: None,
        detail: Detail::Sums,
    };
    run(world, &plan, &mut Straight { turn }).unwrap()
}

#[test]
fn regression_shipped_cycles_advance_and_repeat_themselves() {
    let robot = nao();
    let world = World::new(&robot, Regime::LOCOMOTION).unwrap();
    // mm per cycle of the third cycle, highest point in mm: today's, rounded.
    for (name, advance, top) in [
        ("thesis-nominal", 75.0, 225.0),
        ("thesis-optimal", 92.0, 225.0),
        ("low-175", 134.0, 175.0),
        ("low-165", 113.0, 164.0),
    ] {
        let crawl = crawl(&world, name, 3, 0.0);
        let third = &crawl.cycles[2];
        let forward = third.advance().forward * 1e3;
        assert!((forward - advance).abs() < 2.0, "{name}: {forward:.1} mm");
        let highest = crawl.tops.highest() * 1e3;
        assert!((highest - top).abs() < 1.0, "{name}: {highest:.1} mm");
        let steady = crawl.cycles[1].advance().forward * 1e3;
        assert!((steady - forward).abs() < 2.0, "{name}: {steady:.1} mm");
        // Symmetric gait, symmetric robot.
        assert!(third.advance().yaw.abs() < 0.005, "{name}");
    }
}

#[test]
fn left_mirrors_right() {
    let robot = nao();
    let world = World::new(&robot, Regime::LOCOMOTION).unwrap();
    let turned = |degrees: f64| {
        let crawl = crawl(&world, "low-175", 3, degrees.to_radians());
        let last = crawl.cycles[2].advance();
        (last.yaw.to_degrees(), last.forward * 1e3)
    };
    let ((left, there), (right, back)) = (turned(12.0), turned(-12.0));
    assert!(left > 6.0, "{left}° a cycle");
    assert!((left + right).abs() < 0.1 * left, "{left}° and {right}°");
    assert!((there - back).abs() < 0.1 * there, "{there} and {back} mm");
}
