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

/// Touches are counted, and the forces of the rows are those of the ground on the robot.
#[test]
fn a_low_plate_is_touched_and_the_floor_carries_the_rest() {
    let robot = nao();
    let in_scene = |height| {
        let scene = prone::scene::Scene::under_plate(height, 0.5);
        let world = World::in_scene(&robot, Regime::LOCOMOTION, &scene).unwrap();
        let cycles = [shipped::cycle("low-175").unwrap().unwrap()];
        let plan = CrawlPlan {
            cycles: &cycles,
            scale: TimeScale::ONE,
            end: End::Cycles(3),
            offsets: None,
            detail: Detail::Rows,
        };
        run(&world, &plan, &mut HoldLine::new(Exact, 0.2)).unwrap()
    };
    let free = in_scene(0.3);
    assert_eq!(free.touches, []);
    let forces = free.rows.iter().flat_map(|row| &row.forces);
    let carried = forces.map(|contact| contact.force.z).sum::<f64>() / free.rows.len() as f64;
    let weight = robot.robot().mass() * prone::statics::GRAVITY;
    // 2 %: forces of single instants, where rows are 20 ms apart.
    assert!(
        (carried / weight - 1.0).abs() < 0.02,
        "{carried} N of {weight} N"
    );

    let low = in_scene(0.13);
    assert!(!low.touches.is_empty());
    for touch in &low.touches {
        assert!(
            touch.count > 0 && touch.seconds > 0.0 && touch.peak > 0.0,
            "{touch:?}"
        );
        assert!(
            (0.0..=low.effort.seconds).contains(&touch.first),
            "{touch:?}"
        );
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

/// The slope that each pull feels, rad, and the cycles that were crawled.
fn felt(degrees: f64) -> (Vec<f64>, Vec<String>) {
    let robot = nao();
    let mut scene = prone::scene::Scene::level();
    scene.floor.slope = degrees.to_radians();
    let world = World::in_scene(&robot, Regime::LOCOMOTION, &scene).unwrap();
    let cycles = ["low-165", "low-175"].map(|name| shipped::cycle(name).unwrap().unwrap());
    let plan = CrawlPlan {
        cycles: &cycles,
        scale: TimeScale::ONE,
        end: End::Cycles(4),
        offsets: None,
        detail: Detail::Sums,
    };
    let imu = crate::imu::SimulatedImu::new(&world, 1).unwrap();
    let mut pilot = SlopeAware::new(Straight::default(), imu, 4.0_f64.to_radians());
    let crawl = run(&world, &plan, &mut pilot).unwrap();
    let gaits = crawl.cycles.iter().map(|cycle| cycle.gait.clone());
    (pilot.felt().to_vec(), gaits.collect())
}

#[test]
fn a_slope_is_felt_and_only_uphill_the_other_cycle_is_taken() {
    for degrees in [-10.0, 0.0, 10.0] {
        let (slopes, gaits) = felt(degrees);
        for slope in slopes {
            let off = slope.to_degrees() - degrees;
            assert!(off.abs() < 1.5, "{off}° on a slope of {degrees}°");
        }
        let uphill = if degrees > 4.0 { "low-175" } else { "low-165" };
        // The first cycle is begun before anything is felt.
        assert!(
            gaits[1..].iter().all(|gait| gait == uphill),
            "{degrees}°: {gaits:?}"
        );
    }
}
