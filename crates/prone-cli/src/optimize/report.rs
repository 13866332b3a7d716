//! What a search prints.

use std::io::Write as _;

use prone::regime::Regime;
use prone_record::gait_search::{Confirmation, Outcome, Verdict};

use crate::Failure;
use crate::args::optimize::OptimizeArgs;

/// A table of the runs, what was found beside others, and what simulation says; or the outcome as
/// JSON.
pub(super) fn report(
    args: &OptimizeArgs,
    outcome: &Outcome,
    confirmation: &Confirmation,
) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    if args.json {
        let text = serde_json::to_string_pretty(outcome).map_err(Failure::work)?;
        writeln!(out, "{text}")?;
        return Ok(());
    }
    let number = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |v| format!("{v:.4}"));
    writeln!(
        out,
        "{:>8}{:>14}{:>14}{:>12}{:>13}",
        "seed", "cost", "torque", "violations", "evaluations"
    )?;
    for run in &outcome.runs {
        let price = run.price.as_ref();
        writeln!(
            out,
            "{:>8}{:>14}{:>14}{:>12}{:>13}",
            run.seed,
            number(price.and_then(|price| price.cost)),
            number(price.and_then(|price| price.torque)),
            number(price.map(|price| price.violations)),
            run.evaluations
        )?;
    }
    writeln!(
        out,
        "\n{}: cost {} ({})",
        outcome.gait,
        number(outcome.price.cost),
        outcome.unit
    )?;
    for other in &outcome.compared {
        writeln!(
            out,
            "  {:<10} cost {}, violations {:.4}; torque part found / {}: {}",
            other.gait,
            number(other.price.cost),
            other.price.violations,
            other.gait,
            number(other.torque_ratio)
        )?;
    }
    if !outcome.complete {
        writeln!(out, "  stopped by the time budget; --resume goes on")?;
    }
    if outcome.price.violations > 0.0 {
        writeln!(
            out,
            "\nwhat was found breaks rules of the search, by {:.4}: what it saves is partly that",
            outcome.price.violations
        )?;
    }
    writeln!(out, "\nconfirmed by simulation, found over other")?;
    for verdict in &outcome.verdicts {
        writeln!(out, "  {}", sentence(verdict))?;
    }
    for refused in &outcome.refused {
        writeln!(
            out,
            "  {}: {} cannot be simulated: {}",
            refused.regime, refused.gait, refused.reason
        )?;
    }
    if let Some(base) = outcome.compared.first() {
        for regime in [Regime::TORQUE_STUDY.name, Regime::LOCOMOTION.name] {
            if !confirmation.holds(regime, &base.gait) {
                writeln!(
                    out,
                    "  the gain over {} does not hold in {regime}",
                    base.gait
                )?;
            }
        }
    }
    writeln!(out, "\ngait: {}", args.out.join("gait.toml").display())?;
    Ok(())
}

/// A verdict in words, for the screen and for the gait's file.
pub(super) fn sentence(verdict: &Verdict) -> String {
    let Verdict {
        regime,
        against,
        cheaper_at,
        of,
        best_ratio,
        worst_ratio,
    } = verdict;
    if *of == 0 {
        return format!("{regime}: not compared with {against}.");
    }
    format!(
        "{regime}: {best_ratio:.3} to {worst_ratio:.3} of {against}, cheaper at {cheaper_at} of {of} durations."
    )
}
