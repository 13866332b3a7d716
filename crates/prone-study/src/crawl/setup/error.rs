//! Why a crawl cannot be simulated, or has no result.

use prone::gait::cycle::{CycleError, TimeScaleError};
use prone::motor::UnknownMotor;
use prone::scene::SceneError;
use prone_files::names::UnknownName;
use prone_record::experiment::{ChangedText, Limit, TextError};
use prone_sim::crawl::{CrawlError, LimbsError, ROW_STEP};
use prone_sim::{LoadError, WorldError};

/// Why a crawl cannot be simulated as it was asked for.
#[derive(Debug, thiserror::Error)]
pub enum CrawlSetupError {
    /// The robot's text is not the one that was asked for.
    #[error(transparent)]
    Changed(#[from] ChangedText),
    /// The robot cannot be loaded.
    #[error(transparent)]
    Robot(#[from] LoadError),
    /// A cycle or a scene cannot be read.
    #[error(transparent)]
    Text(#[from] TextError),
    /// A scene cannot be built as it was changed.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The scene's file says it already.
    #[error("scene {scene} sets {quantity} itself")]
    SetTwice {
        /// Its file.
        scene: String,
        /// `the friction` or `the slope`.
        quantity: &'static str,
    },
    /// Robot and scene do not compile together.
    #[error(transparent)]
    World(#[from] WorldError),
    /// A time scale that no crawl can have.
    #[error(transparent)]
    Scale(#[from] TimeScaleError),
    /// A number that no crawl can have.
    #[error(transparent)]
    Limit(#[from] Limit),
    /// An engine step of which rows do not hold a whole number.
    #[error("an engine step of {seconds} s does not divide the {ROW_STEP} s of a row")]
    BrokenStep {
        /// What was asked for, s.
        seconds: f64,
    },
    /// A rest that is none, as commands come less often.
    #[error("a rest of {seconds} s is shorter than a command step of {step} s, and would be none")]
    ShortRest {
        /// What was asked for, s.
        seconds: f64,
        /// Time between two commands, s.
        step: f64,
    },
    /// Efficiency was asked of gears whose motors are not known: it would change nothing.
    #[error("a gear efficiency changes nothing: {source}")]
    NoGears {
        /// Whose.
        source: UnknownMotor,
    },
    /// Something is drawn at random, and there is no seed.
    #[error("{drawn} cannot be drawn without a seed")]
    NoSeed {
        /// What is drawn.
        drawn: &'static str,
    },
    /// A scene's file and a plate exclude each other.
    #[error("scene {scene} and a plate exclude each other")]
    TwoScenes {
        /// The scene's file.
        scene: String,
    },
    /// A turn command beyond what the cycle can be turned by.
    #[error("a turn command of {degrees}° is outside {} to {limit_deg}°, by which {gait} can be turned", 0.0 - limit_deg)]
    Turn {
        /// What was asked for, degrees.
        degrees: f64,
        /// The largest one, degrees.
        limit_deg: f64,
        /// The cycle's name.
        gait: String,
    },
    /// A cycle that cannot turn follows no turn command.
    #[error("a turn command of {degrees}° needs a cycle that can turn; {gait} has no [steering]")]
    CannotTurn {
        /// What was asked for, degrees.
        degrees: f64,
        /// The cycle's name.
        gait: String,
    },
    /// A slope is felt in a pull.
    #[error("a slope is felt in the pull of a cycle; {gait} has none")]
    NoPull {
        /// The cycle's name.
        gait: String,
    },
    /// A cycle that cannot turn cannot keep a heading.
    #[error("keeping a heading needs a cycle that can turn; {gait} has no [steering]")]
    NoSteering {
        /// The cycle's name.
        gait: String,
    },
    /// There is nothing to get past.
    #[error("ending past the obstacles needs a plate or a panel: scene {scene} has none")]
    NothingToPass {
        /// The scene's name.
        scene: String,
    },
    /// The robot cannot crawl a cycle.
    #[error(transparent)]
    Cycle(#[from] RefusedCycle),
    /// Limbs would go through one another.
    #[error("{}{source}", in_place(file.as_deref()))]
    Limbs {
        /// The cycle's file, where it is a user's.
        file: Option<String>,
        /// Which, and how deep.
        source: Box<LimbsError>,
    },
}

/// A cycle that the robot cannot crawl, with its place where it is a user's.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}{source}{}", in_place(place.as_deref()), UnknownName::hint_for_cycle(source))]
pub struct RefusedCycle {
    /// File and line.
    pub(super) place: Option<String>,
    /// What is wrong.
    pub(super) source: Box<CycleError>,
}

/// Why a crawl has no result.
#[derive(Debug, thiserror::Error)]
pub enum CrawlRunError {
    /// The robot cannot crawl the cycle.
    #[error(transparent)]
    Cycle(#[from] RefusedCycle),
    /// The simulation has none.
    #[error(transparent)]
    Crawl(CrawlError),
}

fn in_place(place: Option<&str>) -> String {
    place.map_or_else(String::new, |place| format!("{place}: "))
}
