//! A crawl as it was asked for, loaded and checked: robot, world, cycles, pilot.

mod error;

pub use error::{CrawlRunError, CrawlSetupError, RefusedCycle};

use prone::crawl::{CrawlerError, Pilot, SlopeAware, Straight};
use prone::gait::cycle::{CheckedCycle, Cycle, CycleError, Steer, TimeScale};
use prone::regime::{MotorServo, Regime};
use prone::robot::JointAngles;
use prone::scene::{Obstacle, Scene, SideFriction};
use prone::steering::{HeadingHold, TurnTo};
use prone_files::{cycle_file, scene_file};
use prone_record::experiment::{
    CrawlExperiment, Detail, Ending, GaitText, Limit, SceneChoice, ServoChoice, SteeringChoice,
    TextError,
};
use prone_record::record_info::CrawlOptions;
use prone_sim::crawl::{
    self, Bound, Crawl, CrawlError, CrawlPlan, End, OnTouch, ROW_STEP, check_limbs,
};
use prone_sim::driven::LateCommands;
use prone_sim::{LoadedRobot, World};

use super::run::{GaitSource, PastObstacles, offsets_by_name};
use crate::search::corners::offsets;

/// A crawl that can be simulated.
pub struct CrawlSetup {
    /// The robot.
    pub robot: LoadedRobot,
    /// Where it crawls.
    pub world: World,
    /// With which cycle.
    pub gait: GaitSource,
    /// Under which conditions, for its record.
    pub conditions: CrawlOptions,
    /// Where it ends, if past obstacles.
    pub past: Option<PastObstacles>,
    /// What durations are multiplied by.
    pub scale: TimeScale,
    uphill: Option<GaitSource>,
    imu_seed: Option<u64>,
    /// Rest after each cycle, s.
    rest: f64,
    end: End,
    offsets: Option<JointAngles>,
    late: Option<LateCommands>,
    steering: Steering,
    /// What is kept of it.
    pub detail: Detail,
}

#[derive(Debug, Clone, Copy)]
enum Steering {
    Straight { turn: f64 },
    Hold { limit: f64, shift_limit: f64 },
    To(TurnTo),
}

impl GaitSource {
    /// Parses a cycle's text.
    pub fn from_text(gait: &GaitText) -> Result<Self, TextError> {
        Ok(Self {
            cycle: gait.parse(cycle_file::parse)?,
            file: gait.file.clone(),
            text: gait.text.clone(),
        })
    }

    /// Whether the cycle ships with the program, and is not a user's.
    pub fn is_shipped(&self) -> bool {
        let shipped = prone_files::shipped::gait_file(&self.cycle.name);
        shipped.is_some_and(|shipped| shipped.text == self.text)
    }

    /// An error of the cycle; of a user's with file and line.
    pub fn refused(&self, error: &CycleError) -> RefusedCycle {
        let line = || cycle_file::line_of(&self.text, error.place());
        let place = (!self.is_shipped()).then(|| match line() {
            Some(line) => format!("{}:{line}", self.file),
            None => self.file.clone(),
        });
        RefusedCycle {
            place,
            source: Box::new(error.clone()),
        }
    }
}

impl CrawlSetup {
    /// Loads and checks a crawl; nothing is simulated yet.
    pub fn new(experiment: &CrawlExperiment) -> Result<Self, CrawlSetupError> {
        check(experiment)?;
        let robot = LoadedRobot::load(experiment.robot.files()?)?;
        if experiment.gear_efficiency.is_some() {
            let known = robot.robot().check_motors();
            known.map_err(|source| CrawlSetupError::NoGears { source })?;
        }
        let (seconds, step) = (experiment.rest_s, robot.robot().control.command_step);
        if seconds > 0.0 && seconds < step {
            return Err(CrawlSetupError::ShortRest { seconds, step });
        }
        let gait = GaitSource::from_text(&experiment.gait)?;
        let uphill = experiment.uphill.as_ref().map(GaitSource::from_text);
        let uphill = uphill.transpose()?;
        if let Some(uphill) = &uphill {
            let mut both = [&gait, uphill].into_iter();
            if let Some(source) = both.find(|it| it.cycle.pull.is_none()) {
                let gait = source.cycle.name.clone();
                return Err(CrawlSetupError::NoPull { gait });
            }
        }
        let scene = scene(&experiment.scene)?;
        let world = World::in_scene(&robot, regime(experiment), &scene)?;
        let scale = TimeScale::new(experiment.time_scale)?;
        let steering = steering(experiment.steering, &gait)?;
        let sources = [Some(&gait), uphill.as_ref()];
        let sources: Vec<&GaitSource> = sources.into_iter().flatten().collect();
        check_plans(&world, &sources, &steering, scale)?;
        let (end, past) = end(experiment.ending, &world)?;
        let offsets = experiment
            .joint_offset_deg
            .zip(experiment.seed)
            .map(|(degrees, seed)| offsets(world.robot(), degrees.to_radians(), seed));
        let late = experiment.late_commands_ms.zip(experiment.seed);
        let late = late.map(|(ms, seed)| LateCommands::slow(ms, seed));
        let most_cycles = match end {
            End::Cycles(cycles) => cycles,
            End::Past { bound, .. } => bound.most_cycles(),
        };
        let (steering_name, turn_command_deg, heading_deg) = match experiment.steering {
            SteeringChoice::None => ("none", 0.0, None),
            SteeringChoice::Constant { degrees } => ("constant", degrees, None),
            SteeringChoice::Line => ("heading-hold", 0.0, None),
            SteeringChoice::Heading { degrees } => ("heading", 0.0, Some(degrees)),
        };
        let conditions = CrawlOptions {
            most_cycles: Some(most_cycles),
            until_past_mm: past.map(|past| past.x * 1e3),
            time_scale: Some(scale.value()),
            rest_s: Some(experiment.rest_s),
            steering: Some(steering_name.to_owned()),
            turn_command_deg: Some(turn_command_deg),
            heading_deg,
            joint_offset_deg: Some(experiment.joint_offset_deg.unwrap_or_default()),
            seed: experiment.seed,
            joint_offsets_rad: offsets_by_name(world.robot(), offsets.as_ref()),
            mass_factor: experiment.mass_factor,
            stiffness_factor: match experiment.servo {
                ServoChoice::Times(factor) => Some(factor),
                ServoChoice::Normal | ServoChoice::Soft | ServoChoice::Stiff => None,
            },
            backlash_deg: experiment.backlash_deg,
            late_commands_ms: experiment.late_commands_ms,
            scene_text: experiment.scene.text.as_ref().map(|it| it.text.clone()),
            uphill: uphill
                .as_ref()
                .map(|gait| (gait.file.clone(), gait.text.clone())),
        };
        Ok(Self {
            imu_seed: uphill.as_ref().and(experiment.seed),
            rest: experiment.rest_s,
            robot,
            world,
            gait,
            conditions,
            past,
            scale,
            uphill,
            end,
            offsets,
            late,
            steering,
            detail: experiment.detail,
        })
    }

    /// Simulates the crawl, stopped at once when `stopped` says so.
    pub fn run(&self, stopped: &dyn Fn() -> bool) -> Result<Crawl, CrawlRunError> {
        let plan = CrawlPlan {
            cycles: self.cycles(),
            scale: self.scale,
            end: self.end,
            offsets: self.offsets.clone(),
            late: self.late,
            imu_seed: self.imu_seed,
            on_touch: OnTouch::GoOn,
            detail: match self.detail {
                Detail::Sums => crawl::Detail::Sums,
                Detail::Rows => crawl::Detail::Rows,
            },
        };
        let crawl = crawl::run_unless(stopped, &self.world, &plan, self.pilot());
        crawl.map_err(|error| self.placed(error))
    }

    /// An error of the crawl itself; of a user's cycle with its place.
    fn placed(&self, error: CrawlError) -> CrawlRunError {
        let CrawlError::Crawler(CrawlerError::Cycle { gait, source, .. }) = &error else {
            return CrawlRunError::Crawl(error);
        };
        let mut sources = self.sources();
        match sources.find(|it| it.cycle.name == *gait) {
            Some(gait) => gait.refused(source).into(),
            None => CrawlRunError::Crawl(error),
        }
    }

    fn sources(&self) -> impl Iterator<Item = &GaitSource> {
        [Some(&self.gait), self.uphill.as_ref()]
            .into_iter()
            .flatten()
    }

    /// The cycles between which the pilot chooses.
    fn cycles(&self) -> Vec<Cycle> {
        let resting = |gait: &GaitSource| Cycle {
            rest: self.rest,
            ..gait.cycle.clone()
        };
        self.sources().map(resting).collect()
    }

    fn pilot(&self) -> Box<dyn Pilot> {
        let control = &self.world.robot().control;
        let steering: Box<dyn Pilot> = match self.steering {
            Steering::Straight { turn } => Box::new(Straight { turn }),
            Steering::Hold { limit, shift_limit } => {
                Box::new(HeadingHold::new(control.steering, limit).shifting(shift_limit))
            }
            Steering::To(to) => Box::new(to),
        };
        if self.uphill.is_none() {
            return steering;
        }
        Box::new(SlopeAware::new(steering, control.uphill))
    }
}

impl CrawlRunError {
    /// Whether what was asked for is at fault, not the work.
    pub const fn is_input(&self) -> bool {
        matches!(
            self,
            Self::Cycle(_)
                | Self::Crawl(CrawlError::Crawler(CrawlerError::Cycle { .. }) | CrawlError::Imu(_))
        )
    }
}

impl Steering {
    /// What lies at the corners of all that may be commanded.
    fn extremes(self) -> Vec<Steer> {
        let turned = |turn| Steer { turn, shift: 0.0 };
        match self {
            // The first pull is straight.
            Self::Straight { turn } => [0.0, turn].map(turned).to_vec(),
            Self::To(TurnTo { limit, .. }) => [-limit, limit].map(turned).to_vec(),
            Self::Hold { limit, shift_limit } => {
                let shifts = if shift_limit > 0.0 {
                    vec![-shift_limit, shift_limit]
                } else {
                    vec![0.0]
                };
                let steers = [-limit, limit].into_iter().flat_map(|turn| {
                    let shifts = shifts.iter();
                    shifts.map(move |&shift| Steer { turn, shift })
                });
                steers.collect()
            }
        }
    }
}

fn steering(choice: SteeringChoice, gait: &GaitSource) -> Result<Steering, CrawlSetupError> {
    let name = || gait.cycle.name.clone();
    let limit = gait.cycle.steering.as_ref().map(|steering| steering.limit);
    let needed = || limit.ok_or_else(|| CrawlSetupError::NoSteering { gait: name() });
    match choice {
        SteeringChoice::Line => {
            let steering = gait.cycle.steering.as_ref();
            Ok(Steering::Hold {
                limit: needed()?,
                shift_limit: steering.map_or(0.0, |it| it.shift_limit),
            })
        }
        SteeringChoice::Heading { degrees } => Ok(Steering::To(TurnTo {
            heading: degrees.to_radians(),
            limit: needed()?,
        })),
        SteeringChoice::None => Ok(Steering::Straight { turn: 0.0 }),
        SteeringChoice::Constant { degrees } => {
            if limit.is_none() && degrees.abs() > 0.0 {
                let gait = name();
                return Err(CrawlSetupError::CannotTurn { degrees, gait });
            }
            // Nine decimals: finer than what anyone types, coarser than rounding.
            let limit_deg = limit.unwrap_or_default().to_degrees();
            let limit_deg = (limit_deg * 1e9).round() / 1e9;
            // NaN is no turn either.
            if !(-limit_deg..=limit_deg).contains(&degrees) {
                return Err(CrawlSetupError::Turn {
                    degrees,
                    limit_deg,
                    gait: name(),
                });
            }
            let turn = degrees.to_radians();
            Ok(Steering::Straight { turn })
        }
    }
}

/// What can be said of an experiment before anything of it is read.
fn check(experiment: &CrawlExperiment) -> Result<(), CrawlSetupError> {
    if let Ending::Cycles(cycles) | Ending::PastObstacles(Some(cycles)) = experiment.ending {
        let (fewest, most) = CrawlExperiment::CYCLES_BOUNDS;
        let bounds = (fewest as f64, most as f64);
        Limit::check("a crawl", " cycles", cycles as f64, bounds)?;
    }
    if let Some(seconds) = experiment.time_step_s {
        Limit::check("an engine step", " s", seconds, TIME_STEPS)?;
        let steps = ROW_STEP / seconds;
        if (steps - steps.round()).abs() > 1e-6 {
            return Err(CrawlSetupError::BrokenStep { seconds });
        }
    }
    if let Some(efficiency) = experiment.gear_efficiency {
        let bounds = CrawlExperiment::GEAR_EFFICIENCY_BOUNDS;
        Limit::check("a gear efficiency", "", efficiency, bounds)?;
    }
    Limit::check(
        "a rest",
        " s",
        experiment.rest_s,
        CrawlExperiment::REST_BOUNDS_S,
    )?;
    check_imperfections(experiment)?;
    if let Some(degrees) = experiment.joint_offset_deg {
        Limit::check(
            "a calibration error",
            "°",
            degrees,
            CrawlExperiment::OFFSET_BOUNDS_DEG,
        )?;
    }
    if let SteeringChoice::Heading { degrees } = experiment.steering {
        Limit::check(
            "a heading",
            "°",
            degrees,
            CrawlExperiment::HEADING_BOUNDS_DEG,
        )?;
    }
    let no_seed = |drawn| Err(CrawlSetupError::NoSeed { drawn });
    match experiment.seed {
        None if experiment.joint_offset_deg.is_some() => no_seed("calibration errors"),
        None if experiment.uphill.is_some() => no_seed("the noise of the inertial unit"),
        None if experiment.late_commands_ms.is_some() => no_seed("the delays of commands"),
        _ => match (&experiment.scene.text, experiment.scene.plate) {
            (Some(text), Some(_)) => Err(CrawlSetupError::TwoScenes {
                scene: text.file.clone(),
            }),
            _ => Ok(()),
        },
    }
}

/// Holds cycles, steered as far as they are to be, against the robot.
fn check_plans(
    world: &World,
    sources: &[&GaitSource],
    steering: &Steering,
    scale: TimeScale,
) -> Result<(), CrawlSetupError> {
    for steer in steering.extremes() {
        for gait in sources {
            let steer = gait.cycle.shifted_as_far(steer);
            let (robot, stops) = (world.robot(), world.stops());
            let checked = CheckedCycle::plan_steered(robot, stops, &gait.cycle, steer, scale)
                .map_err(|error| gait.refused(&error))?;
            check_limbs(world, &checked).map_err(|source| CrawlSetupError::Limbs {
                file: (!gait.is_shipped()).then(|| gait.file.clone()),
                source: Box::new(source),
            })?;
        }
    }
    Ok(())
}

/// What a robot may have that its model has not.
fn check_imperfections(experiment: &CrawlExperiment) -> Result<(), CrawlSetupError> {
    let stiffness = match experiment.servo {
        ServoChoice::Times(factor) => Some(factor),
        ServoChoice::Normal | ServoChoice::Soft | ServoChoice::Stiff => None,
    };
    let bounds = CrawlExperiment::STIFFNESS_BOUNDS;
    let masses = CrawlExperiment::MASS_BOUNDS;
    let play = CrawlExperiment::BACKLASH_BOUNDS_DEG;
    let late = CrawlExperiment::LATE_BOUNDS_MS;
    for (what, unit, value, bounds) in [
        ("a factor of stiffness", "", stiffness, bounds),
        ("a factor of masses", "", experiment.mass_factor, masses),
        ("a backlash", "°", experiment.backlash_deg, play),
        ("a delay", " ms", experiment.late_commands_ms, late),
    ] {
        if let Some(value) = value {
            Limit::check(what, unit, value, bounds)?;
        }
    }
    Ok(())
}

/// Shortest and longest engine step, s: contacts are too soft for longer ones.
const TIME_STEPS: (f64, f64) = (1e-4, 0.005);

fn regime(experiment: &CrawlExperiment) -> Regime {
    let motors = match experiment.servo {
        ServoChoice::Normal => MotorServo::ROBOT,
        ServoChoice::Soft => MotorServo::SOFT,
        ServoChoice::Stiff => MotorServo::STIFF,
        ServoChoice::Times(stiffness_factor) => MotorServo {
            stiffness_factor,
            ..MotorServo::ROBOT
        },
    };
    let regime = Regime::LOCOMOTION.with_motors(MotorServo {
        gear_efficiency: experiment.gear_efficiency,
        backlash: experiment.backlash_deg.map_or(0.0, f64::to_radians),
        ..motors
    });
    Regime {
        time_step: experiment.time_step_s.unwrap_or(regime.time_step),
        mass_factor: experiment.mass_factor.unwrap_or(regime.mass_factor),
        ..regime
    }
}

fn scene(choice: &SceneChoice) -> Result<Scene, CrawlSetupError> {
    let mut scene = match (&choice.text, choice.plate) {
        (Some(text), _) => text.parse(scene_file::parse)?,
        (None, Some((mm, metres))) => Scene::under_plate(mm / 1e3, metres),
        (None, None) => Scene::level(),
    };
    let twice = |quantity: &'static str| CrawlSetupError::SetTwice {
        scene: choice
            .text
            .as_ref()
            .map_or_else(String::new, |text| text.file.clone()),
        quantity,
    };
    if let Some((left, right)) = choice.friction {
        if scene.floor.friction.is_some() {
            return Err(twice("the friction"));
        }
        scene.floor.friction = Some(SideFriction { left, right });
    }
    if let Some(degrees) = choice.slope_deg {
        if scene.floor.slope != 0.0 {
            return Err(twice("the slope"));
        }
        scene.floor.slope = degrees.to_radians();
    }
    scene.check()?;
    Ok(scene)
}

/// When a crawl ends: past the obstacles, behind the last plate, leg or panel.
fn end(ending: Ending, world: &World) -> Result<(End, Option<PastObstacles>), CrawlSetupError> {
    let bound = match ending {
        Ending::Cycles(cycles) => return Ok((End::Cycles(cycles), None)),
        Ending::PastObstacles(cycles) => cycles.map_or(Bound::Pace, Bound::Cycles),
    };
    let far = |obstacle: &Obstacle| obstacle.ground_from_box.origin().x() + obstacle.half_edges.x;
    let walls = world.obstacles().iter().filter(|it| !it.kind.is_ground());
    let x = walls
        .map(far)
        .reduce(f64::max)
        .ok_or_else(|| CrawlSetupError::NothingToPass {
            scene: world.scene().name.clone(),
        })?;
    Ok((End::Past { x, bound }, Some(PastObstacles { x })))
}
