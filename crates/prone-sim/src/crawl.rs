//! Whole crawl cycles in simulation: pull, recovery, pull, until a number of cycles is done or the
//! robot is past an obstacle.
//!
//! What is commanded is the business of [`prone::crawl::Crawler`]; this module lays the robot down,
//! lets the simulation take the crawler's commands, and measures. [`run`] does all of it: the robot
//! begins in the first pull's extension, settled, with its foremost point at x = 0. A crawl that
//! follows something, or is followed by something, is [`crawler`], [`lie_down`] where the robot does
//! not lie yet, and [`proceed`], which hands the robot back.

mod extent;
mod ground;
mod limbs;
mod measure;
mod pace;
mod touch;

pub use extent::{NearestParts, Sides};
pub use ground::GroundLoad;
pub use limbs::{LimbsError, check_limbs};
pub use measure::{Advance, CycleRow, Row};
pub use pace::{Bound, MOST_CYCLES, WATCHED};
pub use touch::Touch;

use std::f64::consts::TAU;

use glam::DVec3;

use prone::crawl::{
    Begin, Crawler, CrawlerError, Delivery, DriveError, Event, Halt, PhaseKind, Pilot, Program,
    Timing, TimingError, Watch, drive,
};
use prone::gait::cycle::{Cycle, TimeScale};
use prone::motor::Effort;
use prone::port::{Command as _, JointCommand, Pace as _, PortError, Senses};
use prone::robot::{JointAngles, Tops};

use crate::driven::{LateCommands, SimulatedRobot, StoppedJoint};
use crate::imu::{ImuError, SimulatedImu};
use crate::pull::SETTLE;
use crate::simulation::{Placement, Simulation, SimulationError, Snapshot};
use crate::world::World;
use measure::Meter;
use pace::{Pace, Reached};

/// Last part of settling in which a pilot's senses are on, s.
const FELT_AT_REST: f64 = 0.3;

/// Time between two rows of a record, s.
pub const ROW_STEP: f64 = 0.02;

/// What is crawled.
#[derive(Debug, Clone)]
pub struct CrawlPlan {
    /// The cycles between which the pilot chooses; the first one begins.
    pub cycles: Vec<Cycle>,
    /// What all durations are multiplied by.
    pub scale: TimeScale,
    /// When it ends.
    pub end: End,
    /// What a touch of an obstacle does.
    pub on_touch: OnTouch,
    /// What every commanded angle is off by, rad: joints are not calibrated exactly.
    pub offsets: Option<JointAngles>,
    /// How late commands reach the servos, where they do.
    pub late: Option<LateCommands>,
    /// Seed of the inertial unit's noise, where the unit is read.
    pub imu_seed: Option<u64>,
    /// What is kept.
    pub detail: Detail,
}

/// When a crawl ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum End {
    /// After that many cycles.
    Cycles(usize),
    /// After the cycle in which the robot's last point has passed x, m; or where it does not get
    /// there.
    Past {
        /// Where, m.
        x: f64,
        /// How long it may take.
        bound: Bound,
    },
}

/// What it does to a crawl that the robot touches a plate, a leg or a panel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OnTouch {
    /// Nothing: it is counted.
    GoOn,
    /// The crawl ends there, without having arrived.
    End,
}

/// What is kept of a crawl.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Detail {
    /// What adds up: cycles, heights, efforts, what the ground carries.
    Sums,
    /// A row every [`ROW_STEP`] as well, the position at each row, and every command.
    Rows,
}

/// Record of a crawl.
#[derive(Debug, Clone, PartialEq)]
pub struct Crawl {
    /// Pose and posture when the first pull begins.
    pub start: Snapshot,
    /// Speeds of that instant: of the root, m/s in the ground frame, its turn, rad/s in its own, and
    /// of the joints, rad/s.
    pub start_speeds: Vec<f64>,
    /// Every command, with the time at which it reached the servos, s since the first pull began; rad.
    /// That is when it was given, but where commands are late. Kept with rows.
    pub commands: Vec<(f64, JointAngles)>,
    /// One row per cycle.
    pub cycles: Vec<CycleRow>,
    /// What the motors did.
    pub effort: Effort,
    /// What the ground carried.
    pub ground: GroundLoad,
    /// The highest points by part of the body.
    pub tops: Tops,
    /// How far it reached to either side of its own heading, by its rows.
    pub sides: Sides,
    /// The two of its parts that came nearest to one another, by its rows; nothing of a robot with
    /// no two parts to compare.
    pub nearest: Option<NearestParts>,
    /// What it bumped into, by part of the robot, then by obstacle.
    pub touches: Vec<Touch>,
    /// Joints whose calibration error was stopped at a stop.
    pub stopped: Vec<StoppedJoint>,
    /// Every [`ROW_STEP`], where asked for.
    pub rows: Vec<Row>,
    /// The position at each row.
    pub snapshots: Vec<Snapshot>,
    /// Whether all that was asked for was done: every cycle of [`End::Cycles`], or the way past x of
    /// [`End::Past`].
    pub arrived: bool,
    /// Engine steps of the simulation, what came before the crawl included.
    pub engine_steps: usize,
}

impl Crawl {
    /// Farthest from the line on which the first cycle began, at the end of any cycle, m.
    pub fn drift(&self) -> f64 {
        let start = self.cycles.first().map_or(0.0, |cycle| cycle.from.y);
        let ends = self.cycles.iter().map(|cycle| (cycle.to.y - start).abs());
        ends.fold(0.0, f64::max)
    }

    /// How far it heads off that line in the end, to either side, rad.
    pub fn askew(&self) -> f64 {
        let ends = self.cycles.first().zip(self.cycles.last());
        let turned = ends.map_or(0.0, |(first, last)| last.to.yaw - first.from.yaw);
        (turned - (turned / TAU).round() * TAU).abs()
    }
}

/// Why a crawl has no record.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CrawlError {
    /// The crawl cannot begin or go on.
    #[error(transparent)]
    Crawler(#[from] CrawlerError),
    /// The robot's inertial unit cannot be read.
    #[error(transparent)]
    Imu(#[from] ImuError),
    /// The engine's step and the robot's time between commands do not go together.
    #[error(transparent)]
    Timing(#[from] TimingError),
    /// The run broke down.
    #[error("cycle {cycle} ({gait}): {source}")]
    Simulation {
        /// From 1.
        cycle: usize,
        /// The cycle's name.
        gait: String,
        /// What happened.
        source: SimulationError,
    },
    /// The robot does not do what it is asked for, or is not what the crawler was made for.
    #[error("{problem}")]
    Port {
        /// What the port or its driver said.
        problem: String,
    },
    /// The user stopped it.
    #[error("stopped")]
    Stopped,
}

/// Simulates a crawl from a settled start and returns its record.
pub fn run(world: &World, plan: &CrawlPlan, pilot: impl Pilot) -> Result<Crawl, CrawlError> {
    let never = || false;
    run_unless(&never, world, plan, pilot)
}

/// The same, stopped at once when `stopped` says so.
///
/// # Errors
/// [`CrawlError`]; [`CrawlError::Stopped`] where it was stopped.
pub fn run_unless(
    stopped: &dyn Fn() -> bool,
    world: &World,
    plan: &CrawlPlan,
    pilot: impl Pilot,
) -> Result<Crawl, CrawlError> {
    // Settling ends in the extension; the last of it is felt, its first instant by the first tick.
    let rest = FELT_AT_REST - world.regime().time_step;
    let crawler = crawler(world, plan, Begin::InExtension { rest }, pilot)?;
    let robot = lie_down(world, plan, &crawler)?;
    let (crawl, _) = proceed(robot, crawler, plan, stopped)?;
    Ok(crawl)
}

/// A crawler for a plan in a world.
///
/// # Errors
/// [`CrawlError`] where the first cycle cannot be planned.
pub fn crawler<P: Pilot>(
    world: &World,
    plan: &CrawlPlan,
    begin: Begin,
    pilot: P,
) -> Result<Crawler<P>, CrawlError> {
    let most_cycles = match plan.end {
        End::Cycles(cycles) => cycles,
        End::Past { bound, .. } => bound.most_cycles(),
    };
    let tick = world.regime().time_step;
    // A coarser simulation than the robot's own clock commands at every step.
    let every = world.robot().control.command_step.max(tick);
    let program = Program {
        cycles: plan.cycles.clone(),
        scale: plan.scale,
        most_cycles,
        begin,
        timing: Timing::new(tick, Delivery::SetPoints { every })?,
    };
    let stops = world.stops().to_vec();
    Ok(Crawler::new(world.shared_robot(), stops, program, pilot)?)
}

/// Lays the robot down in a crawler's first pose, its foremost point at x = 0, and lets the servos
/// hold it there until it has settled, but for what the crawler is to feel at rest.
///
/// # Errors
/// [`CrawlError::Imu`], [`CrawlError::Simulation`].
pub fn lie_down<P: Pilot>(
    world: &World,
    plan: &CrawlPlan,
    crawler: &Crawler<P>,
) -> Result<SimulatedRobot, CrawlError> {
    let imu = plan.imu_seed.map(|seed| SimulatedImu::new(world, seed));
    let first = crawler.cycle();
    let placement = Placement {
        posture: first.extension().clone(),
        pitch: first.root_pitch(),
    };
    let mut simulation = Simulation::new(world, &placement);
    simulation.place_front_at(0.0);
    let mut robot = SimulatedRobot::new(simulation)
        .with_offsets(plan.offsets.clone())
        .with_late_commands(plan.late)
        .with_imu(imu.transpose()?);
    let regime = world.regime();
    let steps = regime.steps_in(SETTLE) - regime.steps_in(FELT_AT_REST) + 1;
    let settled = robot.command(&JointCommand::SetPoint(placement.posture));
    let settled = settled.and_then(|()| (0..steps).try_for_each(|_| robot.wait()));
    settled.map_err(|error| in_simulation(crawler.at(), error))?;
    Ok(robot)
}

/// Crawls on with a robot that lies where the crawler begins, until the plan's end, and hands the
/// robot back.
///
/// # Errors
/// [`CrawlError`]; [`CrawlError::Stopped`] where `stopped` said so.
pub fn proceed<P: Pilot>(
    mut robot: SimulatedRobot,
    mut crawler: Crawler<P>,
    plan: &CrawlPlan,
    stopped: &dyn Fn() -> bool,
) -> Result<(Crawl, SimulatedRobot), CrawlError> {
    let mut metered = Metered {
        meter: Meter::new(robot.simulation(), plan.detail),
        pace: match plan.end {
            End::Cycles(_) => None,
            End::Past { x, bound } => Some(Pace::new(x, bound, rear(robot.simulation()))),
        },
        on_touch: plan.on_touch,
        stopped,
        was_stopped: false,
        arrived: false,
    };
    drive(&mut robot, &mut crawler, &mut metered).map_err(|error| match error {
        DriveError::Crawler(error) => CrawlError::Crawler(error),
        DriveError::Port {
            cycle,
            gait,
            source,
        } => in_simulation((cycle, gait), source),
        error @ DriveError::Tick { .. } => CrawlError::Port {
            problem: error.to_string(),
        },
    })?;
    if metered.was_stopped {
        return Err(CrawlError::Stopped);
    }
    let arrived = match plan.end {
        End::Cycles(cycles) => crawler.cycles_done() == cycles,
        End::Past { .. } => metered.arrived,
    };
    let crawl = metered.meter.finish(&robot, arrived);
    Ok((crawl, robot))
}

/// A port's error as the simulation's, where it is one.
fn in_simulation((cycle, gait): (usize, String), error: PortError) -> CrawlError {
    let other = |error: &dyn std::fmt::Display| CrawlError::Port {
        problem: format!("cycle {cycle} ({gait}): {error}"),
    };
    match error {
        PortError::Backend(error) => match error.downcast::<SimulationError>() {
            Ok(source) => CrawlError::Simulation {
                cycle,
                gait,
                source: *source,
            },
            Err(error) => other(&error),
        },
        PortError::Lost { .. } | PortError::Refused { .. } => other(&error),
    }
}

/// Measures a crawl, and says when it is over.
struct Metered<'a> {
    meter: Meter,
    /// Of a crawl that is to get past something.
    pace: Option<Pace>,
    on_touch: OnTouch,
    stopped: &'a dyn Fn() -> bool,
    was_stopped: bool,
    arrived: bool,
}

impl<P: Pilot> Watch<SimulatedRobot, P> for Metered<'_> {
    fn before(
        &mut self,
        robot: &SimulatedRobot,
        crawler: &Crawler<P>,
        senses: &Senses,
    ) -> Option<Halt> {
        if (self.stopped)() {
            self.was_stopped = true;
            return Some(Halt::AtOnce);
        }
        if self.on_touch == OnTouch::End && self.meter.has_touched() {
            return Some(Halt::AtOnce);
        }
        let pace = self.pace.as_mut()?;
        if !crawler.cycle_ends_at(senses.time) {
            return None;
        }
        let reached = pace.cycle_ended(rear(robot.simulation()));
        self.arrived = reached == Reached::Past;
        (reached != Reached::OnTheWay).then_some(Halt::AfterCycle)
    }

    fn ticked(&mut self, robot: &SimulatedRobot, crawler: &Crawler<P>, _: &JointCommand) {
        let simulation = robot.simulation();
        for event in crawler.events() {
            match event {
                Event::CycleBegan => self.meter.begin_cycle(simulation, crawler.cycle()),
                Event::PhaseEnded(PhaseKind::ClosedChain) => self.meter.end_pull(simulation),
                Event::PhaseEnded(PhaseKind::Waypoints) | Event::Ended(_) => {}
                Event::CycleEnded => self.meter.end_cycle(simulation),
            }
        }
    }

    fn waited(&mut self, robot: &SimulatedRobot, crawler: &Crawler<P>) {
        self.meter.step(robot, crawler.stage());
    }
}

/// The last point of the robot, m.
fn rear(simulation: &Simulation) -> f64 {
    -simulation
        .robot()
        .reach(&simulation.body_poses(), DVec3::NEG_X)
}

#[cfg(test)]
mod tests;
