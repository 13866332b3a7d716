//! What is wrong with what was typed, in the words and units of the options.

use anyhow::anyhow;

use prone::scene::{Quantity, SceneError};
use prone_record::experiment::{Experiment, Under};
use prone_record::frontier::Quantity as Held;
use prone_study::crawl::CrawlSetupError;
use prone_study::run::RunError;
use prone_study::search::cycle_jobs::CycleSearchError;
use prone_study::search::pull_error::{HEAVIEST, PullCostError};
use prone_study::search::room::NoRoom;
use prone_thesis::reproduce::ReproduceError;

use crate::Failure;

/// Why an experiment has no outcome.
pub(crate) fn of_study(error: RunError, experiment: &Experiment) -> Failure {
    let message = match error {
        RunError::Stopped => return Failure::Stopped,
        RunError::StoppedSearch { checkpoint } => {
            return Failure::Paused(format!(
                "the search is kept in {}, and --resume goes on from there",
                checkpoint.display()
            ));
        }
        RunError::StoppedMap {
            done,
            rows,
            journal,
        } => {
            return Failure::Paused(format!(
                "{done} of {rows} rows are in {}, and are taken over by the same command",
                journal.display()
            ));
        }
        RunError::Setup(error) => return of_crawl(error),
        RunError::CycleSearch(error) => return of_cycle_search(*error, experiment),
        RunError::NoRoom(error) => no_room("--ceiling-mm", error),
        RunError::Searches { .. } => format!("{error}; without --resume it is replaced"),
        RunError::Pulls(error) => of_pulls(&error),
        error if error.is_work() => return Failure::work(error),
        error => return Failure::input(error),
    };
    Failure::Input(anyhow!(message))
}

fn of_pulls(error: &PullCostError) -> String {
    match error {
        PullCostError::OtherKind { .. } => {
            format!("{error}: leave out --from, or name a gait of the same kind there")
        }
        PullCostError::NameTaken { .. } => format!("{error}: give it another --name"),
        PullCostError::PublishedForm => {
            format!("{error}: leave out --gait-form and --ends")
        }
        PullCostError::Weights { weights } => of_weights(weights),
        _ => error.to_string(),
    }
}

/// Weights that are not four, or weigh nothing or too much.
pub(crate) fn of_weights(weights: &[f64]) -> String {
    format!(
        "--weights takes four numbers from 0 to {HEAVIEST}, not all 0 (ankle, knee, hip, shoulder), not {weights:?}"
    )
}

/// Why a reproduction has no outcome.
pub(crate) fn of_reproduction(error: ReproduceError) -> Failure {
    match error {
        error if error.is_stopped() => Failure::Stopped,
        error if error.is_work() => Failure::work(error),
        error => Failure::input(error),
    }
}

fn of_cycle_search(error: CycleSearchError, experiment: &Experiment) -> Failure {
    let message = match &error {
        CycleSearchError::Twice {
            held: Held::Ceiling,
            value,
        } => format!("--ceilings-mm has {value} twice"),
        CycleSearchError::Twice { value, .. } => format!("--at has {value} twice"),
        CycleSearchError::Same { quantity } => format!(
            "--of takes two quantities, not {} twice",
            quantity.name()
        ),
        CycleSearchError::WorstOverUnused => {
            "--worst-over with --objective peak changes what --most-heat is a share of, and nothing \
             without it: give --most-heat, or leave it out"
                .to_owned()
        }
        CycleSearchError::NoRoom(error) => no_room("--ceilings-mm", *error),
        CycleSearchError::TooLow {
            ceiling_mm,
            robot,
            reason,
        } => format!(
            "{} {ceiling_mm} is too low for {robot}: {reason}",
            ceiling_option(experiment)
        ),
        CycleSearchError::HeatUnused { what } => format!(
            "--{} goes with --objective heat and peak, which alone look at several servos",
            what.replace('_', "-")
        ),
        CycleSearchError::DriftUnused => {
            "--most-drift-mm is looked at in corners, which --ideal leaves out".to_owned()
        }
        CycleSearchError::WorstOver { .. } => format!("--worst-over {error}"),
        _ => return Failure::input(error),
    };
    Failure::Input(anyhow!(message))
}

/// The option that names the ceilings of a search.
fn ceiling_option(experiment: &Experiment) -> &'static str {
    match experiment {
        Experiment::CycleSearch(it) if matches!(it.under, Under::One { .. }) => "--ceiling-mm",
        _ => "--ceilings-mm",
    }
}

/// A margin that is as large as its ceiling.
fn no_room(option: &str, error: NoRoom) -> String {
    let NoRoom {
        ceiling_mm,
        margin_mm,
    } = error;
    format!("--margin-mm {margin_mm} must be smaller than {option} {ceiling_mm}")
}

/// What is wrong with a crawl, in the words of the options.
fn of_crawl(error: CrawlSetupError) -> Failure {
    match error {
        CrawlSetupError::Turn {
            degrees,
            limit_deg,
            gait,
        } => Failure::Input(anyhow!(
            "--turn-deg-per-cycle {degrees} is outside {} to {limit_deg}, by which {gait} can be turned",
            0.0 - limit_deg
        )),
        CrawlSetupError::CannotTurn { gait, .. } => Failure::Input(anyhow!(
            "--turn-deg-per-cycle needs a cycle that can turn; {gait} has no [steering]"
        )),
        CrawlSetupError::NoSteering { gait } => Failure::Input(anyhow!(
            "--heading-hold and --heading-deg need a cycle that can turn; {gait} has no [steering]"
        )),
        CrawlSetupError::NothingToPass { scene } => Failure::Input(anyhow!(
            "--until-past needs a plate or a panel: scene {scene} has none"
        )),
        CrawlSetupError::NoGears { source } => {
            Failure::Input(anyhow!("--gear-efficiency changes nothing: {source}"))
        }
        CrawlSetupError::ShortRest { seconds, step } => Failure::Input(anyhow!(
            "--rest-s {seconds} is shorter than a command step of {step} s, and would be no rest"
        )),
        CrawlSetupError::Scene(error) => of_scene(error),
        other => Failure::input(other),
    }
}

fn of_scene(error: SceneError) -> Failure {
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
