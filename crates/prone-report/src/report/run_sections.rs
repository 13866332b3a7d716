//! What searches found, and under which conditions each run was made.

use maud::{Markup, html};
use prone_record::frontier::{ConfirmedSetting, Found, Frontier, Quantity};
use prone_record::measure::broken_sentence;

use super::folder::Given;
use super::html_table::{optional, table};
use super::run::pull_search::PullSearch;
use super::run::{Content, Run};

/// What searches found; nothing without searches.
pub(super) fn searches(runs: &[Run]) -> Markup {
    let searches: Vec<Markup> = runs.iter().filter_map(found).collect();
    html! {
        @if !searches.is_empty() {
            section {
                h2 { "Searches" }
                @for search in &searches { (search) }
            }
        }
    }
}

/// What a search found; nothing where the run is none.
pub(super) fn found(run: &Run) -> Option<Markup> {
    match &run.content {
        Content::Pulls(search) => Some(pulls(&run.folder.name, search)),
        Content::Cycles(result) => Some(cycles(&run.folder.name, result)),
        Content::Published(_) | Content::Record(_) | Content::Map => None,
    }
}

/// A search of pulls: its cost beside the others', and the simulation's verdicts.
fn pulls(name: &str, search: &PullSearch) -> Markup {
    let (result, cost) = (&search.result, &search.result.cost);
    let caption = html! {
        "What the simulation says of " strong { (result.gait) } ": its cost over another gait's, \
         at the durations of the confirmation. Ours."
    };
    let ratio = |ratio: Option<f64>| optional(ratio, |ratio| format!("{ratio:.3}"));
    html! {
        p {
            strong { (result.gait) } ", found in " (name) " by the objective "
            (search.aim) " on " (search.source) ", " (result.evaluations) " evaluations"
            @if !result.complete { ", ended by its time budget" }
            ": "
            @match (cost.cost, cost.torque) {
                (Some(cost), Some(torque)) if (cost - torque).abs() > 1e-12 => {
                    "cost " (format!("{cost:.4}")) ", torque part " (format!("{torque:.4} {}", result.unit))
                }
                (Some(cost), _) => { "cost " (format!("{cost:.4} {}", result.unit)) }
                (None, Some(torque)) => { "torque part " (format!("{torque:.4} {}", result.unit)) }
                (None, None) => { "no cost" }
            }
            ", violations " (format!("{:.4}", cost.violations)) "."
            @for compared in &result.compared {
                @if let Some(ratio) = compared.torque_ratio {
                    " " (format!("{ratio:.3}")) " of " (compared.gait) "'s there."
                }
            }
        }
        (table(caption, &["regime", "against", "cheaper at", "lowest ratio", "highest ratio"], result.verdicts.iter().map(|verdict| html! {
            th scope="row" { (verdict.regime) }
            td { (verdict.against) }
            td { (verdict.cheaper_at) " of " (verdict.of) }
            td { (ratio(verdict.best_ratio)) }
            td { (ratio(verdict.worst_ratio)) }
        })))
    }
}

/// A search of cycles: what each found, in the setting that was asked for.
fn cycles(name: &str, result: &Frontier) -> Markup {
    let first = |found: &Found, of: fn(&_) -> Option<f64>, decimals: usize| {
        let row = found.confirmed.settings.first();
        optional(row.and_then(of), |value| format!("{value:.decimals$}"))
    };
    let measure = result.measure();
    let caption = html! {
        strong { "Cycles, " (name) "." } " Searched for " (measure.what)
        @if result.held == Quantity::Ceiling {
            ", " (result.margin_mm) " mm kept free of the ceiling"
        }
        "; ours, simulated in the regime locomotion. Robust: in all other settings of the \
         confirmation it keeps 80 % of its advance without touching. Ideal: it keeps the rules of its \
         search only."
    };
    html! {
        (table(caption, &[
            "cycle", result.held.name(), "seed", "evaluations", "searched", "advance", "speed",
            "highest point", "heat", "duty", "standing",
        ], result.found.iter().map(|found| html! {
            th scope="row" { (found.gait) }
            td { (optional(found.at, |at| format!("{at} {}", result.held.unit()))) }
            td { (found.seed) }
            td { (found.evaluations) }
            td { (optional(found.value, |value| measure.sentence(value))) }
            td { (first(found, |row: &ConfirmedSetting| row.mm_per_cycle, 1)) " mm" }
            td { (first(found, |row| row.mm_per_s, 1)) " mm/s" }
            td { (first(found, |row| row.top_mm, 0)) " mm" }
            td { (first(found, |row| row.heat_per_metre_s, 0)) " s/m" }
            td { (first(found, |row| row.duty, 2)) }
            td {
                (found.standing(result.held).name())
                @if let Some(broken) = broken_sentence(found.violation, &found.broken) { ", " (broken) }
            }
        })))
    }
}

/// Conditions of every run.
pub(super) fn what_was_run(runs: &[Run]) -> Markup {
    html! {
        section {
            h2 { "What was run" }
            // What is within another folder was made under the conditions of that one.
            @for run in runs.iter().filter(|run| run.folder.given == Given::Named) {
                @let head = &run.folder.head;
                h3 { (run.folder.name) }
                dl {
                    dt { "command" } dd { (head.command) ", by prone built from commit " (head.commit) }
                    @if let Some(engine) = &head.engine { dt { "engine" } dd { (engine) } }
                    (run.facts)
                }
            }
        }
    }
}
