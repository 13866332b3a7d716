//! Whole crawl cycles in simulation: pull, recovery, pull, until a number of cycles is done or the
//! robot is past an obstacle.
//!
//! The robot begins in the first pull's extension, settled, with its foremost point at x = 0. What
//! it commands are the postures of [`CheckedCycle`]s: every [`COMMAND_STEP`] the one that is to be
//! reached when the next command comes, held until then. At the end of each pull a [`Pilot`] says which cycle comes next and how it
//! turns; the recovery then leads to that cycle's extension.

mod effort;
mod measure;
mod pilot;
mod slope;
mod tops;
mod touch;

pub use effort::{Effort, JointEffort};
pub use measure::{Advance, CycleRow, Row};
pub use pilot::{
    Bearing, BearingSource, Decision, Exact, HoldHeading, HoldLine, Moment, Pilot, Stage, Straight,
    bearing,
};
pub use slope::SlopeAware;
pub use tops::{BodyPart, Tops};
pub use touch::Touch;

use prone::gait::cycle::{CheckedCycle, Cycle, CycleError, TimeScale};
use prone::mapping::{Mapping, MappingError};
use prone::robot::JointAngles;

use crate::pull::SETTLE;
use crate::self_collision::{SelfCollision, SelfCollisionError};
use crate::simulation::{Placement, Simulation, SimulationError, Snapshot};
use crate::world::World;
use measure::Meter;

/// Time between two commands, s: the cycle of the motor boards of the first robot that crawled so.
pub const COMMAND_STEP: f64 = 0.01;

/// Last part of settling in which a pilot's senses are on, s.
const FELT_AT_REST: f64 = 0.3;

/// Time between two rows of a record, s.
pub const ROW_STEP: f64 = 0.02;

/// What is crawled.
#[derive(Debug, Clone)]
pub struct CrawlPlan<'a> {
    /// The cycles between which the pilot chooses; the first one begins.
    pub cycles: &'a [Cycle],
    /// What all durations are multiplied by.
    pub scale: TimeScale,
    /// When it ends.
    pub end: End,
    /// What every commanded angle is off by, rad: joints are not calibrated exactly.
    pub offsets: Option<JointAngles>,
    /// What is kept.
    pub detail: Detail,
}

/// When a crawl ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum End {
    /// After that many cycles.
    Cycles(usize),
    /// After the cycle in which the robot's last point has passed x, m; or after that many cycles.
    Past {
        /// Where, m.
        x: f64,
        /// How many at most.
        at_most: usize,
    },
}

/// What is kept of a crawl.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Detail {
    /// What adds up: cycles, heights, efforts.
    Sums,
    /// A row every [`ROW_STEP`] as well, and the position at each row.
    Rows,
}

/// Record of a crawl.
#[derive(Debug, Clone, PartialEq)]
pub struct Crawl {
    /// Pose and posture when the first pull begins.
    pub start: Snapshot,
    /// One row per cycle.
    pub cycles: Vec<CycleRow>,
    /// What the motors did.
    pub effort: Effort,
    /// The highest points by part of the body.
    pub tops: Tops,
    /// What it bumped into, by part of the robot, then by obstacle.
    pub touches: Vec<Touch>,
    /// Every [`ROW_STEP`], where asked for.
    pub rows: Vec<Row>,
    /// The position at each row.
    pub snapshots: Vec<Snapshot>,
    /// Whether the end came before the most cycles were done.
    pub arrived: bool,
    /// Engine steps, settling included.
    pub engine_steps: usize,
}

/// Why a crawl has no record.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CrawlError {
    /// A cycle cannot be planned.
    #[error(transparent)]
    Cycle(#[from] CycleError),
    /// A cycle's mapping does not fit the robot.
    #[error(transparent)]
    Mapping(#[from] MappingError),
    /// The pilot asks for a cycle that is not there.
    #[error("there is no cycle {asked}: there are {cycles}")]
    NoCycle {
        /// Its index.
        asked: usize,
        /// How many there are.
        cycles: usize,
    },
    /// The run broke down.
    #[error("cycle {cycle} ({gait}): {source}")]
    Simulation {
        /// From 1.
        cycle: usize,
        /// The gait's name.
        gait: String,
        /// What happened.
        source: SimulationError,
    },
    /// Two limbs would go through one another, which the simulation does not keep them from.
    #[error(
        "cycle {cycle}: {} and {} would be {depth_mm:.1} mm in one another, {place}",
        shapes.0, shapes.1
    )]
    Limbs {
        /// The cycle's name.
        cycle: String,
        /// Names of the two shapes.
        shapes: (String, String),
        /// How deep, mm.
        depth_mm: f64,
        /// In the pull or the recovery, and when.
        place: String,
    },
    /// The limbs cannot be compared.
    #[error(transparent)]
    SelfCollision(#[from] SelfCollisionError),
    /// The user stopped it.
    #[error("stopped")]
    Stopped,
}

/// Crawls.
///
/// # Errors
/// [`CrawlError`].
pub fn run(
    world: &World,
    plan: &CrawlPlan<'_>,
    pilot: &mut dyn Pilot,
) -> Result<Crawl, CrawlError> {
    let Some(first) = plan.cycles.first() else {
        return Err(CrawlError::NoCycle {
            asked: 0,
            cycles: 0,
        });
    };
    let mut decision = Decision {
        cycle: 0,
        turn: 0.0,
    };
    let mut planned = Planned::new(world, plan, decision)?;
    let broken = |cycle: usize, source| CrawlError::Simulation {
        cycle: cycle + 1,
        gait: first.pull.name.clone(),
        source,
    };
    let simulation = settle(world, &planned, plan, pilot).map_err(|source| broken(0, source))?;
    let start = simulation.snapshot();
    let mut crawler = Crawler {
        world,
        plan,
        simulation,
        meter: Meter::new(world, plan.detail),
    };
    let mut arrived = false;
    let most = match plan.end {
        End::Cycles(cycles)
        | End::Past {
            at_most: cycles, ..
        } => cycles,
    };
    let mut done = 0;
    while done < most && !arrived {
        crawler
            .meter
            .begin_cycle(&crawler.simulation, &planned.checked);
        crawler
            .pull(&planned, pilot)
            .map_err(|source| broken(done, source))?;
        crawler.meter.end_pull(&crawler.simulation);
        decision = pilot.decide(&crawler.moment(Stage::Recovery))?;
        let next = Planned::new(world, plan, decision)?;
        crawler
            .recover(&planned, &next, pilot)?
            .map_err(|source| broken(done, source))?;
        crawler.meter.end_cycle(&crawler.simulation);
        planned = next;
        done += 1;
        arrived = match plan.end {
            End::Cycles(_) => done == most,
            End::Past { x, .. } => crawler.rear() > x,
        };
    }
    let engine_steps = crawler.simulation.steps();
    let (record, snapshots) = crawler.meter.finish();
    Ok(Crawl {
        start,
        cycles: record.cycles,
        effort: record.effort,
        tops: record.tops,
        touches: record.touches,
        rows: record.rows,
        snapshots,
        arrived,
        engine_steps,
    })
}

/// Looks whether limbs go through one another in a cycle's plan.
///
/// # Errors
/// [`CrawlError::Limbs`] with the deepest place; a millimetre is not deep, as a model's shapes are
/// rounder than its robot.
pub fn check_limbs(world: &World, checked: &CheckedCycle) -> Result<(), CrawlError> {
    let times = |seconds: f64| {
        let count = (seconds / LIMB_STEP).ceil();
        (0..)
            .map(f64::from)
            .take_while(move |k| *k <= count)
            .map(move |k| seconds * k / count)
    };
    let pull = checked.pull().duration().seconds();
    let path = checked.recovery_after(checked)?;
    let forth: Vec<f64> = times(pull).collect();
    let back: Vec<f64> = times(checked.recovery_seconds()).collect();
    let pulled = forth.iter().map(|&time| checked.pull_at(time));
    let recovered = back.iter().map(|&time| path.at(time));
    let postures: Vec<JointAngles> = pulled.chain(recovered).collect();
    let near = SelfCollision::new(world)?.scan(&postures, 0.0)?.closest;
    if near.closest.distance_m >= -DEEP {
        return Ok(());
    }
    let place = match near.index.checked_sub(forth.len()) {
        None => format!("{:.2} s into the pull", forth[near.index]),
        Some(index) => format!("{:.2} s into the recovery", back[index]),
    };
    Err(CrawlError::Limbs {
        cycle: checked.name().to_owned(),
        shapes: near.closest.shapes,
        depth_mm: -near.closest.distance_m * 1e3,
        place,
    })
}

/// Time between two postures that are looked at for limbs in one another, s.
const LIMB_STEP: f64 = 0.02;
/// How deep limbs may be in one another, m.
const DEEP: f64 = 1e-3;

/// A cycle ready to be commanded.
struct Planned {
    checked: CheckedCycle,
    mapping: Mapping,
}

impl Planned {
    fn new(world: &World, plan: &CrawlPlan<'_>, decision: Decision) -> Result<Self, CrawlError> {
        let cycle = plan.cycles.get(decision.cycle).ok_or(CrawlError::NoCycle {
            asked: decision.cycle,
            cycles: plan.cycles.len(),
        })?;
        let robot = world.robot();
        let pull = &cycle.pull;
        Ok(Self {
            checked: CheckedCycle::plan(robot, world.stops(), cycle, decision.turn, plan.scale)?,
            mapping: Mapping::new(robot, pull.mapping, pull.arm)?,
        })
    }

    /// Pitch of the root in the planned chain at a phase, rad.
    fn root_pitch(&self, s: f64) -> f64 {
        let samples = self.checked.pull().samples();
        let last = samples.len() - 1;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 0 and the number of samples"
        )]
        let nearest = ((s.clamp(0.0, 1.0) * last as f64).round() as usize).min(last);
        self.mapping.root_pitch(&samples[nearest].chain)
    }
}

fn settle<'w>(
    world: &'w World,
    planned: &Planned,
    plan: &CrawlPlan<'_>,
    pilot: &mut dyn Pilot,
) -> Result<Simulation<'w>, SimulationError> {
    let placement = Placement {
        posture: planned.checked.extension().clone(),
        pitch: planned.root_pitch(0.0),
    };
    let mut simulation = Simulation::new(world, &placement);
    simulation.place_front_at(0.0);
    simulation.command(&off_by(world, plan, planned.checked.extension().clone()));
    let (steps, felt) = (
        world.regime().steps_in(SETTLE),
        world.regime().steps_in(FELT_AT_REST),
    );
    for step in 0..steps {
        simulation.step();
        if step + felt >= steps {
            pilot.sense(&Moment {
                simulation: &simulation,
                stage: Stage::Recovery,
            });
        }
    }
    simulation.check()?;
    Ok(simulation)
}

/// A command as the motors take it: off by the joints' calibration, within the stops.
fn off_by(world: &World, plan: &CrawlPlan<'_>, command: JointAngles) -> JointAngles {
    let Some(offsets) = &plan.offsets else {
        return command;
    };
    let stops = world.stops();
    command.map(|joint, angle| {
        let stop = stops[joint.0];
        (angle + offsets[joint]).clamp(stop.lower, stop.upper)
    })
}

struct Crawler<'a, 'w> {
    world: &'w World,
    plan: &'a CrawlPlan<'a>,
    simulation: Simulation<'w>,
    meter: Meter,
}

impl<'w> Crawler<'_, 'w> {
    fn pull(&mut self, planned: &Planned, pilot: &mut dyn Pilot) -> Result<(), SimulationError> {
        let seconds = planned.checked.pull().duration().seconds();
        self.follow(seconds, pilot, |time| {
            let s = time / seconds;
            let planned_pitch = planned.root_pitch(s);
            (
                planned.checked.pull_at(time),
                Stage::Pull { s, planned_pitch },
            )
        })
    }

    fn recover(
        &mut self,
        from: &Planned,
        next: &Planned,
        pilot: &mut dyn Pilot,
    ) -> Result<Result<(), SimulationError>, CrawlError> {
        let path = next.checked.recovery_after(&from.checked)?;
        let seconds = next.checked.recovery_seconds();
        Ok(self.follow(seconds, pilot, |time| (path.at(time), Stage::Recovery)))
    }

    /// Commands a course over time, one posture every [`COMMAND_STEP`].
    fn follow(
        &mut self,
        seconds: f64,
        pilot: &mut dyn Pilot,
        at: impl Fn(f64) -> (JointAngles, Stage),
    ) -> Result<(), SimulationError> {
        let regime = self.world.regime();
        let (steps, every) = (regime.steps_in(seconds), regime.steps_in(COMMAND_STEP));
        let mut stage = Stage::Recovery;
        for step in 0..steps {
            if step % every == 0 {
                // What is to be reached when the next command comes.
                let time = ((step + every) as f64 * regime.time_step).min(seconds);
                let posture;
                (posture, stage) = at(time);
                self.simulation
                    .command(&off_by(self.world, self.plan, posture.clone()));
                self.meter.command(posture, stage);
            }
            self.simulation.step();
            pilot.sense(&self.moment(stage));
            self.meter.step(&self.simulation);
        }
        self.simulation.check()
    }

    fn moment(&self, stage: Stage) -> Moment<'_, 'w> {
        Moment {
            simulation: &self.simulation,
            stage,
        }
    }

    /// The last point of the robot, m.
    fn rear(&self) -> f64 {
        -self
            .world
            .robot()
            .reach(&self.simulation.body_poses(), glam::DVec3::NEG_X)
    }
}

#[cfg(test)]
mod tests;
