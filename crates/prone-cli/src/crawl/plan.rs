//! What was typed about a crawl, checked and loaded.

use anyhow::anyhow;

use prone::crawl::{CrawlerError, HoldHeading, HoldLine, Pilot, SlopeAware, Straight};
use prone::gait::cycle::{CheckedCycle, Cycle};
use prone::regime::Regime;
use prone::regime::Servo;
use prone::robot::{JointAngles, Robot};
use prone::scene::{Obstacle, Quantity, Scene, SceneError, SideFriction};
use prone::steering::{HeadingHold, TurnTo};
use prone_files::{scene_file, shipped, text_file};
use prone_sim::crawl::{CrawlError, End, LimbsError, check_limbs};
use prone_sim::{LoadedRobot, World};
use prone_study::crawl::{Conditions, GaitSource, PastObstacles};
use prone_study::search::settings::offsets;

use crate::Failure;
use crate::args::{CrawlRunArgs, ServoName, TimeStepName};
use crate::gait::{find_cycle, is_shipped, refused};

/// How many cycles where nothing is said.
const CYCLES: usize = 9;

/// How many cycles a robot has to get past its obstacles.
const MOST_CYCLES: usize = 60;

/// Everything that decides a crawl, loaded.
pub(super) struct Plan {
    pub(super) robot: LoadedRobot,
    pub(super) world: World,
    pub(super) gait: GaitSource,
    uphill: Option<GaitSource>,
    pub(super) imu_seed: Option<u64>,
    pub(super) end: End,
    pub(super) past: Option<PastObstacles>,
    pub(super) offsets: Option<JointAngles>,
    pub(super) conditions: Conditions,
    steering: Steering,
}

#[derive(Debug, Clone, Copy)]
enum Steering {
    Straight { turn: f64 },
    Hold { limit: f64 },
    To(TurnTo),
}

impl Plan {
    pub(super) fn new(args: &CrawlRunArgs) -> Result<Self, Failure> {
        if args.seed.is_some() && args.joint_offset_deg.is_none() && args.uphill.is_none() {
            return Err(Failure::Input(anyhow!(
                "--seed draws joint offsets or an inertial unit's noise: it goes with --joint-offset-deg or --uphill"
            )));
        }
        let robot = crate::robot::load(args.robot.name())?;
        let find = |name: &str| find_cycle(&robot.files().gaits, name);
        let gait = find(args.gait.name())?;
        let uphill = args.uphill.as_deref().map(find).transpose()?;
        let (scene, scene_text) = scene(args)?;
        let world =
            World::in_scene(&robot, regime(args, robot.robot()), &scene).map_err(Failure::input)?;
        let steering = steering(args, &gait)?;
        for turn in steering.extremes() {
            let stops = world.stops();
            for gait in [Some(&gait), uphill.as_ref()].into_iter().flatten() {
                let scale = args.time_scale;
                let checked = CheckedCycle::plan(world.robot(), stops, &gait.cycle, turn, scale)
                    .map_err(|error| refused(gait, &error))?;
                check_limbs(&world, &checked).map_err(|error| in_file(gait, error))?;
            }
        }
        let imu_seed = uphill.as_ref().and(args.seed);
        let past = args.until_past.then(|| past(&world)).transpose()?;
        let most_cycles = match past {
            None => args.cycles.map_or(CYCLES, usize::from),
            Some(_) => MOST_CYCLES,
        };
        let end = past.map_or(End::Cycles(most_cycles), |past| End::Past {
            x: past.x,
            at_most: most_cycles,
        });
        let offsets = args
            .joint_offset_deg
            .zip(args.seed)
            .map(|(degrees, seed)| offsets(world.robot(), degrees.to_radians(), seed));
        let conditions = Conditions {
            most_cycles,
            until_past_mm: past.map(|past| past.x * 1e3),
            time_scale: args.time_scale.value(),
            steering: match steering {
                Steering::Hold { .. } => "heading-hold",
                Steering::To(_) => "heading",
                Steering::Straight { .. } if args.turn_deg_per_cycle.is_some() => "constant",
                Steering::Straight { .. } => "none",
            },
            turn_command_deg: args.turn_deg_per_cycle.unwrap_or_default(),
            heading_deg: args.heading_deg,
            joint_offset_deg: args.joint_offset_deg.unwrap_or_default(),
            seed: args.seed,
            joint_offsets_rad: Conditions::offsets_by_name(world.robot(), offsets.as_ref()),
            scene_text,
            uphill: uphill
                .as_ref()
                .map(|gait| (gait.file.clone(), gait.text.clone())),
        };
        Ok(Self {
            robot,
            world,
            gait,
            uphill,
            imu_seed,
            end,
            past,
            offsets,
            conditions,
            steering,
        })
    }

    /// An error of the crawl itself; of a cycle, with its file.
    pub(super) fn failure(&self, error: CrawlError) -> Failure {
        let CrawlError::Crawler(CrawlerError::Cycle { gait, source, .. }) = &error else {
            return super::failure(error);
        };
        let sources = [Some(&self.gait), self.uphill.as_ref()];
        let mut sources = sources.into_iter().flatten();
        match sources.find(|it| it.cycle.pull.name == *gait) {
            Some(gait) => refused(gait, source),
            None => super::failure(error),
        }
    }

    /// The cycles between which the pilot chooses.
    pub(super) fn cycles(&self) -> Vec<Cycle> {
        let sources = [Some(&self.gait), self.uphill.as_ref()];
        sources
            .into_iter()
            .flatten()
            .map(|gait| gait.cycle.clone())
            .collect()
    }

    pub(super) fn pilot(&self) -> Box<dyn Pilot> {
        let control = &self.world.robot().control;
        let steering: Box<dyn Pilot> = match self.steering {
            Steering::Straight { turn } => Box::new(Straight { turn }),
            Steering::Hold { limit } => Box::new(HoldLine {
                hold: HeadingHold::new(control.steering, limit),
            }),
            Steering::To(to) => Box::new(HoldHeading { to }),
        };
        if self.uphill.is_none() {
            return steering;
        }
        Box::new(SlopeAware::new(steering, control.uphill))
    }
}

impl Steering {
    /// The turns between which all others lie.
    fn extremes(self) -> [f64; 2] {
        match self {
            // The first pull is straight.
            Self::Straight { turn } => [0.0, turn],
            Self::Hold { limit } | Self::To(TurnTo { limit, .. }) => [-limit, limit],
        }
    }
}

fn steering(args: &CrawlRunArgs, gait: &GaitSource) -> Result<Steering, Failure> {
    if !args.heading_hold && args.heading_deg.is_none() {
        let degrees = args.turn_deg_per_cycle.unwrap_or_default();
        let limit = gait.cycle.steering.as_ref().map_or(0.0, |it| it.limit);
        let limit = (limit.to_degrees() * 1e9).round() / 1e9;
        // NaN is no turn either.
        if !(-limit..=limit).contains(&degrees) {
            let name = &gait.cycle.pull.name;
            return Err(Failure::Input(anyhow!(
                "--turn-deg-per-cycle {degrees} is outside {} to {limit}, by which {name} can be turned",
                0.0 - limit
            )));
        }
        let turn = degrees.to_radians();
        return Ok(Steering::Straight { turn });
    }
    match &gait.cycle.steering {
        Some(steering) => Ok(match args.heading_deg {
            None => Steering::Hold {
                limit: steering.limit,
            },
            Some(degrees) => Steering::To(TurnTo {
                heading: degrees.to_radians(),
                limit: steering.limit,
            }),
        }),
        None => Err(Failure::Input(anyhow!(
            "--heading-hold and --heading-deg need a cycle that can turn; {} has no [steering]",
            gait.cycle.pull.name
        ))),
    }
}

/// An error of a user's cycle, with the file.
fn in_file(gait: &GaitSource, error: LimbsError) -> Failure {
    if is_shipped(gait) {
        return Failure::input(error);
    }
    Failure::Input(anyhow!("{}: {error}", gait.file))
}

fn regime(args: &CrawlRunArgs, robot: &Robot) -> Regime {
    let regime = match args.servo {
        ServoName::Soft => Regime::LOCOMOTION,
        ServoName::Stiff => {
            let gain = robot.control.stiff_servo_gain;
            Regime::LOCOMOTION.with_servo(Servo::Uniform(gain))
        }
    };
    match args.time_step_ms {
        TimeStepName::Usual => regime,
        TimeStepName::Fine => regime.with_time_step(0.001),
    }
}

/// The scene, and the text of its file where it has one.
fn scene(args: &CrawlRunArgs) -> Result<(Scene, Option<String>), Failure> {
    let (mut scene, text) = match (&args.scene, args.ceiling_mm.zip(args.length_m)) {
        (Some(name), _) => {
            let (scene, text) = find_scene(name)?;
            (scene, Some(text))
        }
        (None, Some((mm, metres))) => (Scene::under_plate(mm / 1e3, metres), None),
        (None, None) => (Scene::level(), None),
    };
    let twice = |what: &str| {
        Failure::Input(anyhow!(
            "scene {} sets {what} itself",
            args.scene.as_deref().unwrap_or_default()
        ))
    };
    if let Some((left, right)) = args.friction_left.zip(args.friction_right) {
        if scene.floor.friction.is_some() {
            return Err(twice("the friction"));
        }
        scene.floor.friction = Some(SideFriction { left, right });
    }
    if let Some(degrees) = args.slope_deg {
        if scene.floor.slope != 0.0 {
            return Err(twice("the slope"));
        }
        scene.floor.slope = degrees.to_radians();
    }
    scene.check().map_err(refuse)?;
    Ok((scene, text))
}

/// The same error in the words and units of the options.
fn refuse(error: SceneError) -> Failure {
    let SceneError::OutOfBounds {
        quantity,
        value,
        lowest,
        highest,
        ..
    } = error
    else {
        return Failure::input(error);
    };
    let (option, unit) = match quantity {
        Quantity::Height => ("--ceiling-mm", 1e3),
        Quantity::Length => ("--length-m", 1.0),
        Quantity::Slope => ("--slope-deg", 1_f64.to_degrees()),
        Quantity::LeftFriction => ("--friction-left", 1.0),
        Quantity::RightFriction => ("--friction-right", 1.0),
        _ => return Failure::input(error),
    };
    // Nine decimals: finer than what anyone types, coarser than rounding.
    let [value, lowest, highest] =
        [value, lowest, highest].map(|number| (number * unit * 1e9).round() / 1e9);
    Failure::Input(anyhow!("{option} {value} is outside {lowest} to {highest}"))
}

/// A shipped scene by name, or the scene of a file, with the file's text.
fn find_scene(name: &str) -> Result<(Scene, String), Failure> {
    if let (Some(scene), Some(text)) = (shipped::scene(name), shipped::scene_text(name)) {
        return Ok((scene.map_err(Failure::input)?, text.to_owned()));
    }
    let path = std::path::Path::new(name);
    if !path.exists() {
        let known: Vec<_> = shipped::scene_names().collect();
        return Err(Failure::Input(anyhow!(
            "there is no scene {name:?}: it is neither one that ships with prone ({}) nor a file",
            known.join(", ")
        )));
    }
    let text = text_file::read(path)
        .map_err(|error| Failure::Input(anyhow!("cannot read {name}: {error}")))?;
    Ok((
        scene_file::parse(name, &text).map_err(Failure::input)?,
        text,
    ))
}

/// Behind the last plate, leg or panel.
fn past(world: &World) -> Result<PastObstacles, Failure> {
    let far = |obstacle: &Obstacle| obstacle.ground_from_box.origin().x() + obstacle.half_edges.x;
    let walls = world.obstacles().iter().filter(|it| !it.kind.is_ground());
    let x = walls.map(far).reduce(f64::max).ok_or_else(|| {
        Failure::Input(anyhow!(
            "--until-past needs a plate or a panel: scene {} has none",
            world.scene().name
        ))
    })?;
    Ok(PastObstacles { x })
}
