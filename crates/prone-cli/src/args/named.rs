//! What every command calls by the same name: a gait, a robot.

use std::path::{Path, PathBuf};

/// A gait or a cycle, named once: as the argument or as `--gait`.
#[derive(Debug, clap::Args)]
#[group(required = true, multiple = false)]
pub(crate) struct GaitArg {
    /// Gait or cycle: a name, of the robot's own or that ships (nominal, low-175, …), or a file
    #[arg(value_name = "GAIT")]
    argument: Option<String>,
    /// Gait or cycle, in place of the argument
    #[arg(long, value_name = "GAIT")]
    gait: Option<String>,
}

impl GaitArg {
    /// The name or the path, as typed.
    pub(crate) fn name(&self) -> &str {
        let Some(name) = self.argument.as_ref().or(self.gait.as_ref()) else {
            unreachable!("one of the two is required");
        };
        name
    }
}

/// Any number of cycles, as arguments or as `--gait`.
#[derive(Debug, clap::Args)]
pub(crate) struct GaitArgs {
    /// Cycles to try, names or files [default: those of the robot's [defaults], of the NAO all]
    #[arg(value_name = "GAIT")]
    arguments: Vec<String>,
    /// Cycle to try, in place of the arguments; may be given several times
    #[arg(long, value_name = "GAIT", conflicts_with = "arguments")]
    gait: Vec<String>,
}

impl GaitArgs {
    /// The names or paths, as typed; none where none was.
    pub(crate) fn names(&self) -> &[String] {
        if self.gait.is_empty() {
            &self.arguments
        } else {
            &self.gait
        }
    }
}

/// Which robot.
#[derive(Debug, clap::Args)]
pub(crate) struct RobotArg {
    /// Robot: a name that ships with prone (nao, nao/v4, nao/v5, …), or the folder of a robot, or of a family
    /// for its default version [default: nao]
    #[arg(long, value_name = "ROBOT")]
    robot: Option<PathBuf>,
}

impl RobotArg {
    /// The name or the folder, as typed; none where none was.
    pub(crate) fn name(&self) -> Option<&Path> {
        self.robot.as_deref()
    }
}

/// Which robot, as the argument or as `--robot`.
#[derive(Debug, clap::Args)]
pub(crate) struct RobotArgument {
    /// Robot, in place of --robot
    #[arg(value_name = "ROBOT", conflicts_with = "robot")]
    argument: Option<PathBuf>,
    #[command(flatten)]
    option: RobotArg,
}

impl RobotArgument {
    /// The name or the folder, as typed; none where none was.
    pub(crate) fn name(&self) -> Option<&Path> {
        self.argument.as_deref().or(self.option.name())
    }
}
