//! One cycle on its way under a plate, in one setting.

use prone::gait::cycle::{Cycle, TimeScale};
use prone::motor::Verdict;
use prone::robot::BodyPart;
use prone::scene::obstacle_name;
use prone_sim::crawl::{self, Bound, Crawl, CrawlError, CrawlPlan, Detail, End, OnTouch};

use super::super::setting::Setting;

/// What became of a cycle under a plate.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Attempt {
    /// Whether it came out behind the plate.
    pub(super) passed: bool,
    /// What it touched first: part of the body and obstacle.
    pub(super) touched: Option<String>,
    /// How long it took, s, or until it was given up.
    pub(super) seconds: f64,
    /// How many cycles.
    pub(super) cycles: usize,
    /// How far it came, m.
    pub(super) distance: f64,
    /// Advance per cycle, m, mean of all.
    pub(super) advance: f64,
    /// Highest point, m, and of which part of the body.
    pub(super) top: (f64, BodyPart),
    /// The widest it got about its own heading, m.
    pub(super) width: f64,
    /// Farthest from the line of the start, m, at the end of a cycle.
    pub(super) drift: f64,
    /// How far it heads off the line in the end, rad.
    pub(super) askew: f64,
    /// Largest mean force on the head over 20 ms, N.
    pub(super) head: f64,
    /// What the motors did over the nominal, where they are known.
    pub(super) verdict: Option<Verdict>,
    /// Heat per metre, s/m, where the motors are known.
    pub(super) heat_per_metre: Option<f64>,
}

/// Crawls a cycle under the plate of a setting's scene until its last point is past x, m. It is given up when
/// it touches anything, and, as any crawl, when its pace does not lead past.
pub(super) fn attempt(
    setting: &Setting,
    cycle: &Cycle,
    x: f64,
    stopped: &dyn Fn() -> bool,
) -> Result<Attempt, CrawlError> {
    let plan = CrawlPlan {
        cycles: vec![cycle.clone()],
        scale: TimeScale::ONE,
        end: End::Past {
            x,
            bound: Bound::Pace,
        },
        on_touch: OnTouch::End,
        offsets: setting.spec.offsets.clone(),
        late: setting.spec.late,
        imu_seed: None,
        detail: Detail::Sums,
    };
    let pilot = setting.pilot(cycle);
    let crawl = crawl::run_unless(stopped, &setting.world, &plan, pilot)?;
    Ok(measured(setting, &crawl))
}

fn measured(setting: &Setting, crawl: &Crawl) -> Attempt {
    let world = &setting.world;
    let robot = world.robot();
    let touched = crawl
        .touches
        .iter()
        .min_by(|a, b| a.first.total_cmp(&b.first));
    let touched = touched.map(|touch| {
        let obstacle = obstacle_name(world.obstacles(), touch.obstacle);
        format!("{} touches {obstacle}", robot.bodies[touch.body.0].name)
    });
    let start = crawl.cycles.first().map(|cycle| cycle.from);
    let path: f64 = crawl.cycles.iter().map(|it| it.advance().forward).sum();
    let distance = crawl.cycles.last().zip(start);
    let heat = crawl.effort.heat(robot).ok();
    Attempt {
        passed: crawl.arrived && crawl.touches.is_empty(),
        touched,
        seconds: crawl.effort.seconds,
        cycles: crawl.cycles.len(),
        distance: distance.map_or(0.0, |(last, from)| last.to.x - from.x),
        advance: path / crawl.cycles.len().max(1) as f64,
        top: (crawl.tops.highest(), crawl.tops.part()),
        width: crawl.sides.width(),
        drift: crawl.drift(),
        askew: crawl.askew(),
        head: crawl.ground.head_peak(),
        verdict: setting.verdict(crawl),
        heat_per_metre: heat.filter(|_| path > 0.0).map(|heat| heat / path),
    }
}
