//! `prone torque-map build`.

use std::io::Write;
use std::path::Path;

use prone_record::experiment::{Experiment, MapSource, RobotText, TorqueMapExperiment};
use prone_study::torque_map::build::Summary;

use crate::Failure;
use crate::args::{BuildArgs, SourceArg};
use crate::outputs::{Files, Kind};
use crate::plan::{self, OnContact, Plan, Work};

pub(crate) fn plan(args: &BuildArgs) -> Result<Plan, Failure> {
    let files = crate::robot::files(args.robot.name())?;
    let experiment = TorqueMapExperiment {
        robot: RobotText::from_files(&files),
        source: match args.source {
            SourceArg::Statics => MapSource::Statics,
            SourceArg::Simulation => MapSource::Simulation,
        },
        step_deg: args.step_deg,
        theta4_max_deg: args.theta4_max_deg,
    };
    Ok(Plan {
        work: Work::Study(Experiment::TorqueMap(Box::new(experiment))),
        files: Files::of_robot(&files).writing("--out", &args.out, Kind::Lasting),
        opening: plan::searching(!args.restart),
        threads: args.threads,
        json: args.json,
        on_contact: OnContact::Report,
    })
}

/// What is in a map.
pub(crate) fn print(summary: &Summary, map: &Path, out: &mut dyn Write) -> std::io::Result<()> {
    let Summary {
        source,
        rows,
        with_torques,
        open,
        failed,
    } = summary;
    writeln!(
        out,
        "{}: torque map by {source}
{rows:>8} rows
{with_torques:>8} with torques
{open:>8} masked: the chain does not close
{failed:>8} masked: the source had no torques",
        map.display()
    )
}
