//! `prone cost`.

use std::io::Write;

use prone_record::experiment::{CostExperiment, Experiment, RobotText};
use prone_record::resumption::Opening;
use prone_study::run::CostOutcome;

use crate::Failure;
use crate::args::optimize::CostArgs;
use crate::plan::{OnContact, Plan, Work};
use crate::pull_terms;

pub(crate) fn plan(args: &CostArgs) -> Result<Plan, Failure> {
    let files = crate::robot::files(args.terms.robot.name())?;
    let costed = crate::gait::find(&files.gaits, args.gait.name())?;
    let experiment = CostExperiment {
        robot: RobotText::from_files(&files),
        terms: pull_terms::choice(&args.terms, &files, Some(&costed))?,
        gait: costed.1,
    };
    Ok(Plan {
        work: Work::Study(Experiment::Cost(Box::new(experiment))),
        out: None,
        opening: Opening::Restart,
        threads: None,
        json: args.json,
        on_contact: OnContact::Report,
    })
}

/// The cost of a pull, and what it breaks.
pub(crate) fn print(outcome: &CostOutcome, out: &mut dyn Write) -> std::io::Result<()> {
    let CostOutcome { gait, cost, unit } = outcome;
    let number = |value: Option<f64>| {
        value.map_or_else(|| "not known".to_owned(), |value| format!("{value:.4}"))
    };
    writeln!(
        out,
        "{}
  cost        {}
  torque      {} {unit}
  violations  {}",
        gait.name,
        number(cost.cost),
        number(cost.torque),
        trimmed(cost.violations)
    )?;
    for broken in &cost.broken {
        writeln!(
            out,
            "    {:<12}{} times, {} in all",
            broken.rule,
            broken.count,
            trimmed(broken.sum)
        )?;
    }
    Ok(())
}

/// Four decimals, without zeros at the end.
fn trimmed(value: f64) -> String {
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
