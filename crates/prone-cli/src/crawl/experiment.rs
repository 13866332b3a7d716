//! What was typed about a crawl, as an experiment.

use anyhow::anyhow;

use prone_files::names::{NameKind, UnknownName};
use prone_files::{shipped, text_file};
use prone_record::experiment::{
    CrawlExperiment, Detail, Ending, GaitText, RobotText, SceneChoice, SceneText, ServoChoice,
    SteeringChoice,
};

use crate::Failure;
use crate::args::{CrawlRunArgs, ServoName};
use crate::gait::find_cycle;
use crate::outputs::Files;

/// What was typed, with the texts of all files that it names; and which these are.
pub(super) fn of(args: &CrawlRunArgs) -> Result<(CrawlExperiment, Files), Failure> {
    let draws_nothing =
        args.joint_offset_deg.is_none() && args.uphill.is_none() && args.late_commands_ms.is_none();
    if args.seed.is_some() && draws_nothing {
        return Err(Failure::Input(anyhow!(
            "--seed draws joint offsets, an inertial unit's noise or delays: it goes with --joint-offset-deg, --uphill or --late-commands-ms"
        )));
    }
    let files = crate::robot::files(args.robot.name())?;
    let find = |name: &str| -> Result<GaitText, Failure> {
        let gait = find_cycle(&files.gaits, name)?;
        Ok(GaitText::new(&gait.file, &gait.text))
    };
    let gait = find(args.gait.name())?;
    let named = args.gait.name().to_owned();
    let named = std::iter::once(&named).chain(&args.uphill);
    let mut read = Files::of_robot(&files).reading_gaits(&files.gaits, named);
    if let Some(scene) = args
        .scene
        .as_deref()
        .filter(|it| shipped::scene_text(it).is_none())
    {
        read = read.reading(scene);
    }
    let experiment = CrawlExperiment {
        uphill: args.uphill.as_deref().map(find).transpose()?,
        scene: scene(args)?,
        ending: if args.until_past {
            Ending::PastObstacles(args.cycles.map(usize::from))
        } else {
            Ending::Cycles(args.cycles.map_or(CrawlExperiment::CYCLES, usize::from))
        },
        steering: steering(args),
        time_scale: args.time_scale.value(),
        rest_s: args.rest_s,
        gear_efficiency: args.gear_efficiency,
        servo: match (args.stiffness_factor, args.servo) {
            (Some(factor), _) => ServoChoice::Times(factor),
            (None, ServoName::Normal) => ServoChoice::Normal,
            (None, ServoName::Soft) => ServoChoice::Soft,
            (None, ServoName::Stiff) => ServoChoice::Stiff,
        },
        mass_factor: args.mass_factor,
        backlash_deg: args.backlash_deg,
        late_commands_ms: args.late_commands_ms,
        time_step_s: args.time_step_ms.seconds(),
        joint_offset_deg: args.joint_offset_deg,
        seed: args.seed,
        detail: if args.record.is_some() {
            Detail::Rows
        } else {
            Detail::Sums
        },
        ..CrawlExperiment::new(RobotText::from_files(&files), gait)
    };
    Ok((experiment, read))
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
        let known = shipped::scene_names();
        return Err(Failure::input(UnknownName::new(
            NameKind::Scene,
            name,
            known,
        )));
    }
    let text = text_file::read(path)
        .map_err(|error| Failure::Input(anyhow!("cannot read {name}: {error}")))?;
    Ok(SceneText::new(name, &text))
}
