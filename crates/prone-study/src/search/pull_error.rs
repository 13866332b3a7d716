//! Why pulls have no costs, or cannot be searched.

use prone::cost::objective::NoMotor;
use prone::gait::PhaseDurationError;
use prone::mapping::MappingError;
use prone::statics::SymmetryError;
use prone::torque_map::ParseError;
use prone_files::plain_name::GaitNameError;
use prone_record::experiment::{Limit, TextError};
use prone_sim::WorldError;
use prone_sim::pull::PullError;

use super::published::PublishedProblemError;
use super::pull_form::FormError;
use crate::torque_map::NodeGridError;

/// Largest weight of a squared torque: such a product is far from overflowing.
pub const HEAVIEST: f64 = 1e6;

/// Why pulls have no costs, or cannot be searched.
#[derive(Debug, thiserror::Error)]
pub enum PullCostError {
    /// A number that no search can have.
    #[error(transparent)]
    Limit(#[from] Limit),
    /// A name that is none of a file.
    #[error(transparent)]
    Name(#[from] GaitNameError),
    /// A gait cannot be read.
    #[error(transparent)]
    Text(#[from] TextError),
    /// A torque map is malformed.
    #[error("{file}: {source}")]
    Map {
        /// Its file.
        file: String,
        /// What is wrong.
        source: ParseError,
    },
    /// The robot does not compile with its floor.
    #[error(transparent)]
    World(#[from] WorldError),
    /// Weights that weigh nothing, or too much.
    #[error(
        "weights are four numbers from 0 to {HEAVIEST}, not all 0 (ankle, knee, hip, shoulder), not {weights:?}"
    )]
    Weights {
        /// What was asked for.
        weights: [f64; 4],
    },
    /// A duration that no pull can have.
    #[error(transparent)]
    Duration(#[from] PhaseDurationError),
    /// A gait's mapping does not fit the robot.
    #[error(transparent)]
    Mapping(#[from] MappingError),
    /// The ends of the curve of a gait's upper arm do not carry the shoulder forward.
    #[error(
        "gait {gait} has no cost per metre: its shoulder advances {advance_mm:.1} mm in a pull"
    )]
    NoAdvance {
        /// The gait's name.
        gait: String,
        /// Planned advance, mm.
        advance_mm: f64,
    },
    /// The gait whose share of the weight is the limit cannot be simulated.
    #[error(transparent)]
    BodyShare(#[from] PullError),
    /// The published objective cannot be made.
    #[error(transparent)]
    Published(#[from] PublishedProblemError),
    /// There is no grid to measure a table on, which constants exclude.
    #[error(transparent)]
    Grid(#[from] NodeGridError),
    /// The published objective looks torques up; a simulation of a whole gait has no table.
    #[error(
        "the objective `published` looks torques up in a table; its source is a file or `statics`"
    )]
    PublishedNeedsTable,
    /// The published objective knows polynomials only.
    #[error(
        "gait {gait} has a curve that is no polynomial of degree 3 or less, and the objective `published` has a cost for nothing else"
    )]
    NotCubic {
        /// The gait's name.
        gait: String,
    },
    /// A peak does not add up.
    #[error("there is no peak per metre: a peak does not add up")]
    PeakPerMetre,
    /// The robot lacks what the objective needs.
    #[error(transparent)]
    NoMotor(#[from] NoMotor),
    /// The statics needs a mirrored robot.
    #[error(transparent)]
    Symmetry(#[from] SymmetryError),
    /// A pull and the base of its costs are of two kinds.
    #[error("gait {gait}, but the base gait {base}")]
    OtherKind {
        /// The pull's name, mapping and arms, in words.
        gait: String,
        /// Those of the base gait.
        base: String,
    },
    /// The form cannot be searched.
    #[error(transparent)]
    Form(#[from] FormError),
    /// The published problem is one of six coefficients.
    #[error("the objective `published` has a cost for cubics with fixed ends only")]
    PublishedForm,
    /// The confirmation tells gaits apart by their names.
    #[error("the found gait would be called {name:?}, like one that it is compared with")]
    NameTaken {
        /// The name.
        name: String,
    },
}
