//! What a search of cycles leaves in its result folder.

use prone::gait::cycle::Cycle;
use prone_files::cycle_file;
use prone_record::frontier::{self, Found, Frontier};
use prone_record::output::Artefacts;
use prone_record::search::Search;
use prone_report::figure_list::FigureList;
use prone_report::figures::{PNG_SCALE, frontier_figure};

use super::Quest;
use crate::Failure;

/// Tables, figure and cycles; of a named quest the best one as `gait.toml`.
pub(super) fn artefacts(
    quest: &Quest<'_>,
    frontier: &Frontier,
    gaits: &[Cycle],
    searches: &[Search],
) -> Result<Artefacts, Failure> {
    let mut artefacts = Artefacts::new();
    artefacts.insert("run.json".into(), pretty(&quest.plan)?);
    artefacts.insert("result.json".into(), pretty(frontier)?);
    let table = frontier::csv(frontier).map_err(Failure::work)?;
    artefacts.insert("frontier.csv".into(), table);
    let ceilings: Vec<Option<f64>> = quest.jobs.iter().map(|job| job.ceiling_mm).collect();
    let history = frontier::history_csv(&ceilings, searches).map_err(Failure::work)?;
    artefacts.insert("history.csv".into(), history);
    for (cycle, found) in gaits.iter().zip(&frontier.found) {
        let text = cycle_file::write(cycle, &header(cycle, found));
        artefacts.insert(format!("gaits/{}.toml", cycle.pull.name), text.into_bytes());
    }
    if let (Some(name), Some(best)) = (&quest.name, best(&frontier.found)) {
        let mut cycle = gaits[best].clone();
        cycle.pull.name.clone_from(name);
        let text = cycle_file::write(&cycle, &header(&cycle, &frontier.found[best]));
        artefacts.insert("gait.toml".into(), text.into_bytes());
    }
    let mut list = FigureList::default();
    if let Some(figure) = frontier_figure(frontier) {
        let png = figure.png(PNG_SCALE).map_err(Failure::work)?;
        list.drawing(&mut artefacts, "figures/", figure, png);
    }
    list.finish(&mut artefacts).map_err(Failure::work)?;
    Ok(artefacts)
}

/// The least violation, then the least value; the first of equals.
fn best(found: &[Found]) -> Option<usize> {
    let key = |found: &Found| (found.violation, found.value.unwrap_or(f64::INFINITY));
    let order = |a: &usize, b: &usize| {
        let ((va, a), (vb, b)) = (key(&found[*a]), key(&found[*b]));
        va.total_cmp(&vb).then(a.total_cmp(&b))
    };
    (0..found.len()).min_by(order)
}

fn header(cycle: &Cycle, found: &Found) -> String {
    format!(
        "Found by prone {} ({}): {}.\nBreaks {:.4} of the rules of its search. Crawled in other settings:\n{}",
        env!("CARGO_PKG_VERSION"),
        env!("PRONE_COMMIT"),
        cycle.pull.description,
        found.violation,
        found.sentence()
    )
}

pub(super) fn pretty(value: &impl serde::Serialize) -> Result<Vec<u8>, Failure> {
    serde_json::to_vec_pretty(value).map_err(Failure::work)
}
