//! What a search leaves in its result folder.

use prone::gait::{CheckedTrajectory, Gait};
use prone_files::gait_file;
use prone_record::gait_search::{self, Confirmation, Outcome, Refusal};
use prone_record::output::Artefacts;
use prone_record::pulls::ChainRecord;
use prone_record::search::Search;
use prone_record::tables;
use prone_report::figure_list::FigureList;
use prone_report::figures::{self, ConfirmedRecord, PNG_SCALE, Scores, SearchRecord};
use prone_study::optimize::pricer::Aim;
use prone_study::optimize::rules::INTERVALS;
use prone_study::pulls;

use super::report::sentence;
use crate::Failure;
use crate::pricing::Pricing;

/// The gait, the tables, the figures.
pub(super) fn artefacts(
    search: &Search,
    gait: &Gait,
    others: &[Gait],
    outcome: &Outcome,
    confirmation: &Confirmation,
    pricing: &Pricing,
) -> Result<Artefacts, Failure> {
    let mut artefacts = Artefacts::new();
    let header = header(gait, outcome, pricing);
    artefacts.insert(
        "gait.toml".into(),
        gait_file::write(gait, &header).into_bytes(),
    );
    artefacts.insert("result.json".into(), pretty(outcome)?);
    let history = gait_search::history_csv(search).map_err(Failure::work)?;
    artefacts.insert("history.csv".into(), history);
    let confirmation_csv = gait_search::confirmation_csv(confirmation).map_err(Failure::work)?;
    artefacts.insert("confirmation.csv".into(), confirmation_csv);
    let scores = match pricing.aim {
        Aim::Published(_) => Scores::Published,
        Aim::Graded(_) => Scores::Graded,
    };
    let objective = pricing.objective();
    let history = SearchRecord::of(search, &objective, scores);
    let history = history.map(|history| figures::generations(&history));
    let rows = ConfirmedRecord::of(confirmation);
    let drawn = [
        history.transpose().map_err(Failure::work)?.flatten(),
        figures::confirmation(&rows, objective.name()).map_err(Failure::work)?,
    ];
    let mut list = FigureList::default();
    for figure in drawn.into_iter().flatten() {
        let png = figure.png(PNG_SCALE).map_err(Failure::work)?;
        list.drawing(&mut artefacts, "figures/", figure, png);
    }
    list.finish(&mut artefacts).map_err(Failure::work)?;
    let chains = tables::chains(&chains(gait, others, pricing)).map_err(Failure::work)?;
    artefacts.insert("chains.csv".into(), chains);
    Ok(artefacts)
}

/// The planned chains, the found gait's last. One that cannot be planned was refused by the
/// confirmation too, which says why.
fn chains(gait: &Gait, others: &[Gait], pricing: &Pricing) -> Vec<ChainRecord> {
    let gaits = others.iter().chain([gait]);
    let chains = gaits.map(|gait| pulls::chain(&pricing.world, gait, pricing.duration));
    chains.filter_map(Result::ok).collect()
}

/// How the gait was found and what it does, for whoever reads its file.
fn header(gait: &Gait, outcome: &Outcome, pricing: &Pricing) -> String {
    let mut lines = vec![format!(
        "Found by prone {} ({}), seed {}, {} evaluations in {} runs, on robot {}.",
        env!("CARGO_PKG_VERSION"),
        env!("PRONE_COMMIT"),
        outcome.seed,
        outcome.evaluations,
        outcome.runs.len(),
        pricing.robot.robot().name
    )];
    if let Some(cost) = outcome.price.cost {
        lines.push(format!(
            "Cost {cost:.4} ({}), violations {:.4}.",
            outcome.unit, outcome.price.violations
        ));
    }
    lines.push(
        "Simulated from its own first pose at several durations, cost over another gait's:".into(),
    );
    lines.extend(outcome.verdicts.iter().map(sentence));
    let refused = outcome.refused.iter().map(|refused| {
        let Refusal {
            regime,
            gait,
            reason,
        } = refused;
        format!("{regime}: {gait} cannot be simulated: {reason}.")
    });
    lines.extend(refused);
    lines.extend(clamps(gait, pricing));
    lines.join("\n")
}

/// Which joints the gait asks past their stops, where it asks any.
fn clamps(gait: &Gait, pricing: &Pricing) -> Option<String> {
    let robot = pricing.robot.robot();
    // The manufacturer's: a regime may have moved them.
    let stops = robot.stops();
    let trajectory =
        CheckedTrajectory::plan(robot, &stops, gait, pricing.duration, INTERVALS).ok()?;
    let clamped = trajectory.clamps().iter().map(|clamp| {
        let by = clamp.largest.abs().to_degrees();
        format!("{} by up to {by:.1}°", robot.joints[clamp.joint.0].name)
    });
    let clamped: Vec<_> = clamped.collect();
    (!clamped.is_empty()).then(|| format!("Clamped at its limit: {}.", clamped.join(", ")))
}

pub(super) fn pretty(value: &impl serde::Serialize) -> Result<Vec<u8>, Failure> {
    serde_json::to_vec_pretty(value).map_err(Failure::work)
}
