//! What is to be built: a source, a grid and a robot, under the conditions of the published table.
//!
//! Those are the mapping `original`, fixed arms, the study's stops and, in simulation, the regime
//! `table`. The statics lets any shape carry and squeezes nothing.

use std::collections::BTreeMap;
use std::path::PathBuf;

use prone::mapping::{ArmMode, Mapping, MappingError, MappingVariant};
use prone::regime::Regime;
use prone::statics::{HalfRobot, SymmetryError};
use prone::torque_map::{COLUMNS, GridError};
use prone_record::resumption::ResumptionError;
use prone_sim::settled::STILL;
use prone_sim::{LoadedRobot, WorldError};

use super::{NodeGrid, NodeGridError};
use prone_record::experiment::MapSource;
use prone_record::program::Program;

const VARIANT: MappingVariant = MappingVariant::Original;
const ARM: ArmMode = ArmMode::Fixed;

/// The regime of a simulated map.
pub(super) const REGIME: Regime = Regime::TABLE;

/// A map to build.
#[derive(Debug)]
pub struct Job<'r> {
    pub(super) robot: &'r LoadedRobot,
    pub(super) source: MapSource,
    pub(super) grid: NodeGrid,
    pub(super) mapping: Mapping,
    program: Program,
}

/// Why there is no map.
#[derive(Debug, thiserror::Error)]
pub enum BuildError {
    /// There is no such grid.
    #[error(transparent)]
    Nodes(#[from] NodeGridError),
    /// The robot lacks what the mapping needs.
    #[error(transparent)]
    Mapping(#[from] MappingError),
    /// The statics needs a mirrored robot.
    #[error(transparent)]
    Symmetry(#[from] SymmetryError),
    /// The engine refuses the robot's world.
    #[error(transparent)]
    World(#[from] WorldError),
    /// The journal cannot be used.
    #[error(transparent)]
    Journal(#[from] ResumptionError),
    /// The rows do not fill the grid.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// The user asked to stop; so many rows are in the journal, which is gone if there are none.
    #[error("stopped with {kept} of {rows} rows done")]
    Stopped {
        /// Rows done.
        kept: usize,
        /// Rows of the map.
        rows: usize,
        /// The journal, where there is one.
        journal: Option<PathBuf>,
    },
}

impl BuildError {
    /// Whether the work failed, and not what was asked for.
    pub const fn is_work(&self) -> bool {
        matches!(
            self,
            Self::Grid(_) | Self::Journal(ResumptionError::Write(_)) | Self::Stopped { .. }
        )
    }
}

/// What a source does, with its number where it has one.
fn meaning(source: MapSource) -> String {
    match source {
        MapSource::Statics => "rigid body at rest, any shape may carry, no squeeze".to_owned(),
        MapSource::Simulation => format!(
            "pose held until at rest: no motor's mean torque changes by more than {STILL} N·m per control step"
        ),
    }
}

const fn regime(source: MapSource) -> &'static str {
    match source {
        MapSource::Statics => "none, the study's stops hold",
        MapSource::Simulation => REGIME.name,
    }
}

impl<'r> Job<'r> {
    /// A map of a robot, to be built by a program.
    ///
    /// # Errors
    /// [`BuildError`], before anything is measured.
    pub fn new(
        robot: &'r LoadedRobot,
        source: MapSource,
        grid: NodeGrid,
        program: &Program,
    ) -> Result<Self, BuildError> {
        let mapping = Mapping::new(robot.robot(), VARIANT, ARM)?;
        if source == MapSource::Statics {
            HalfRobot::from_robot(robot.robot())?;
        }
        Ok(Self {
            robot,
            source,
            grid,
            mapping,
            program: program.clone(),
        })
    }

    /// How many rows the map has.
    pub fn rows(&self) -> usize {
        self.grid.grid().len()
    }

    /// What decides every byte of the result, and tells two builds apart, name by name.
    pub(super) fn identity(&self) -> BTreeMap<String, String> {
        let Program { version, commit } = &self.program;
        let others = [
            ("program", format!("prone {version}, commit {commit}")),
            ("source", self.source.name().to_owned()),
            ("regime", regime(self.source).to_owned()),
            ("mapping", VARIANT.name().to_owned()),
            ("arms", ARM.name().to_owned()),
            ("robot", self.robot.robot().name.clone()),
            ("robot sha256", self.robot.files().hash()),
            ("engine", prone_sim::engine_version()),
        ];
        let names = self.grid.bounds().into_iter().chain(others);
        names
            .map(|(name, value)| (name.to_owned(), value))
            .collect()
    }

    /// The comments at the head of the file, one per line.
    pub(super) fn comments(&self) -> Vec<String> {
        let Program { version, commit } = &self.program;
        let grid = self.grid.grid();
        let (knees, hips, arms) = (grid.knee.len(), grid.hip.len(), grid.upper_arm.len());
        let [theta3, theta4, alpha, step] = self.grid.bounds().map(|bound| bound.1);
        let robot = &self.robot.robot().name;
        let files = self.robot.files();
        let version_of_family = files.version.as_ref().map_or_else(String::new, |version| {
            format!(" (version {} of {})", version.version, version.family)
        });
        vec![
            format!("torque map by prone {version}, commit {commit}"),
            format!("source: {}: {}", self.source.name(), meaning(self.source)),
            format!("regime: {}", regime(self.source)),
            format!("mapping: {}; arms: {}", VARIANT.name(), ARM.name()),
            format!("robot: {robot}, sha256 {}{version_of_family}", files.hash()),
            format!("engine: {}", prone_sim::engine_version()),
            format!("grid: theta3 {theta3}, theta4 {theta4}, alpha {alpha}, step {step}"),
            format!("rows: {knees} x {hips} x {arms} = {}", grid.len()),
            "order: alpha outermost, descending; theta3 ascending; theta4 innermost, descending"
                .to_owned(),
            "units: angles rad, torques N·m, forces N".to_owned(),
            "tau2 to tau5: minus the motor torque about the joint's axis, right side: the sign of \
             the published recordings"
                .to_owned(),
            "toe to leg: normal force of the floor on that part, both sides".to_owned(),
            "NaN: without theta1 no chain closes there, else the source had no torques".to_owned(),
            format!("columns: {}", COLUMNS.join(",")),
        ]
    }
}
