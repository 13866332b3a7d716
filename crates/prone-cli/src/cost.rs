//! `prone cost`.

use std::io::Write as _;

use anyhow::anyhow;

use prone_record::gait_search::Priced;
use prone_study::search::candidates::{Depth, Refusal};
use prone_study::search::pull_cost::{PullAim, PullCosts};

use crate::Failure;
use crate::args::optimize::CostArgs;
use crate::pricing::Pricing;

pub(crate) fn run(args: &CostArgs) -> Result<(), Failure> {
    let robot = crate::robot::load(args.pricing.robot.name())?;
    let gait = crate::gait::find(&robot.files().gaits, args.gait.name())?;
    let Pricing { world, terms, .. } = Pricing::new(&args.pricing, robot, Some(&gait))?;
    let (graded, base) = (matches!(terms.aim, PullAim::Graded(_)), &terms.base);
    if graded && (gait.mapping, gait.arm) != (base.mapping, base.arm) {
        return Err(Failure::Input(anyhow!(
            "gait {} has mapping {} and arms {}, but {} of --from has {} and {}: leave out --from, or name a gait of the same kind there",
            gait.name,
            gait.mapping.name(),
            gait.arm.name(),
            base.name,
            base.mapping.name(),
            base.arm.name()
        )));
    }
    let unit = terms.aim.objective().unit();
    let costs = PullCosts::new(&world, terms).map_err(Failure::input)?;
    let cost = costs.cost(&gait, Depth::Everything);
    if let Some(refusal @ Refusal::NotCubic { .. }) = cost.refusal {
        return Err(Failure::input(refusal));
    }
    let price = costs.record(&cost);
    let mut out = std::io::stdout().lock();
    if args.json {
        let text = serde_json::to_string_pretty(&price).map_err(Failure::work)?;
        writeln!(out, "{text}")?;
    } else {
        print(&gait.name, &price, unit, &mut out)?;
    }
    Ok(())
}

fn print(
    gait: &str,
    price: &Priced,
    unit: &str,
    out: &mut impl std::io::Write,
) -> std::io::Result<()> {
    let number = |value: Option<f64>| {
        value.map_or_else(|| "not known".to_owned(), |value| format!("{value:.4}"))
    };
    writeln!(out, "{gait}")?;
    writeln!(out, "  cost        {}", number(price.cost))?;
    writeln!(out, "  torque      {} {unit}", number(price.torque))?;
    writeln!(out, "  violations  {}", trimmed(price.violations))?;
    for broken in &price.broken {
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
