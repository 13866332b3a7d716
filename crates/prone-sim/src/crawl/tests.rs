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
fn print_it() {
    let robot = nao();
    let world = World::new(&robot, Regime::LOCOMOTION).unwrap();
    for name in shipped::cycle_names() {
        let crawl = crawl(&world, name, 4, 0.0);
        for c in &crawl.cycles {
            let a = c.advance();
            println!(
                "{name}: {:.1} mm, left {:.1}, yaw {:.2}°, {:.2} s tops {:?} body {:.2} heat {:.2}",
                a.forward * 1e3,
                a.left * 1e3,
                a.yaw.to_degrees(),
                c.seconds,
                c.tops.0.map(|t| (t * 1e4).round() / 10.0),
                c.body_share,
                c.effort.heat(robot.robot())
            );
        }
    }
}
