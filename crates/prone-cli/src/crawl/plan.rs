//! What was typed about a crawl, as an experiment; and what is wrong with it, in the words and units
//! of the options.

use anyhow::anyhow;

use prone::scene::{Quantity, SceneError};
use prone_files::{shipped, text_file};
use prone_record::experiment::{
    CrawlExperiment, Detail, Ending, GaitText, RobotText, SceneChoice, SceneText, ServoChoice,
    SteeringChoice,
};
use prone_study::crawl::CrawlSetupError;

use crate::Failure;
use crate::args::{CrawlRunArgs, ServoName, TimeStepName};
use crate::gait::find_cycle;

/// Length of a fine engine step, s.
const FINE_STEP_S: f64 = 0.001;

/// What was typed, with the texts of all files that it names.
pub(super) fn experiment(args: &CrawlRunArgs) -> Result<CrawlExperiment, Failure> {
    if args.seed.is_some() && args.joint_offset_deg.is_none() && args.uphill.is_none() {
        return Err(Failure::Input(anyhow!(
            "--seed draws joint offsets or an inertial unit's noise: it goes with --joint-offset-deg or --uphill"
        )));
    }
    let files = crate::robot::files(args.robot.name())?;
    let find = |name: &str| -> Result<GaitText, Failure> {
        let gait = find_cycle(&files.gaits, name)?;
        Ok(GaitText::new(&gait.file, &gait.text))
    };
    let gait = find(args.gait.name())?;
    Ok(CrawlExperiment {
        uphill: args.uphill.as_deref().map(find).transpose()?,
        scene: scene(args)?,
        ending: if args.until_past {
            Ending::PastObstacles(CrawlExperiment::MOST_CYCLES)
        } else {
            Ending::Cycles(args.cycles.map_or(CrawlExperiment::CYCLES, usize::from))
        },
        steering: steering(args),
        time_scale: args.time_scale.value(),
        servo: match args.servo {
            ServoName::Soft => ServoChoice::Soft,
            ServoName::Stiff => ServoChoice::Stiff,
        },
        time_step_s: match args.time_step_ms {
            TimeStepName::Usual => None,
            TimeStepName::Fine => Some(FINE_STEP_S),
        },
        joint_offset_deg: args.joint_offset_deg,
        seed: args.seed,
        detail: if args.record.is_some() {
            Detail::Rows
        } else {
            Detail::Sums
        },
        ..CrawlExperiment::new(RobotText::from_files(&files), gait)
    })
}

fn steering(args: &CrawlRunArgs) -> SteeringChoice {
    match (args.heading_deg, args.turn_deg_per_cycle) {
        (Some(degrees), _) => SteeringChoice::Heading { degrees },
        (None, _) if args.heading_hold => SteeringChoice::Line,
        (None, Some(degrees)) => SteeringChoice::Constant { degrees },
        (None, None) => SteeringChoice::None,
    }
}

fn scene(args: &CrawlRunArgs) -> Result<SceneChoice, Failure> {
    Ok(SceneChoice {
        text: args.scene.as_deref().map(scene_text).transpose()?,
        plate: args.ceiling_mm.zip(args.length_m),
        friction: args.friction_left.zip(args.friction_right),
        slope_deg: args.slope_deg,
    })
}

/// The text of a scene that ships, by name, or of a file.
fn scene_text(name: &str) -> Result<SceneText, Failure> {
    if let Some(text) = shipped::scene_text(name) {
        return Ok(SceneText::new(name, text));
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
    Ok(SceneText::new(name, &text))
}

/// What is wrong with a crawl, in the words of the options.
pub(super) fn refused(error: CrawlSetupError) -> Failure {
    match error {
        CrawlSetupError::Turn {
            degrees,
            limit_deg,
            gait,
        } => Failure::Input(anyhow!(
            "--turn-deg-per-cycle {degrees} is outside {} to {limit_deg}, by which {gait} can be turned",
            0.0 - limit_deg
        )),
        CrawlSetupError::NoSteering { gait } => Failure::Input(anyhow!(
            "--heading-hold and --heading-deg need a cycle that can turn; {gait} has no [steering]"
        )),
        CrawlSetupError::NothingToPass { scene } => Failure::Input(anyhow!(
            "--until-past needs a plate or a panel: scene {scene} has none"
        )),
        CrawlSetupError::Scene(error) => refused_scene(error),
        other => Failure::input(other),
    }
}

fn refused_scene(error: SceneError) -> Failure {
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
