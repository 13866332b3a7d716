//! What searches found, and under which conditions each run was made.

use std::collections::BTreeMap;

use maud::{Markup, html};
use prone_record::frontier::{ConfirmedSetting, Found, Frontier};
use prone_record::origin::Origin;
use prone_record::record_info::RecordInfo;

use super::Run;
use super::folder::Given;
use super::search_run::SearchRun;

/// What searches found; nothing without searches.
pub(super) fn searches(runs: &[Run]) -> Markup {
    let any = runs.iter().any(|run| match run {
        Run::Search(_) => true,
        Run::Drawn(run) => run.cycles.is_some(),
        Run::Published(..) | Run::Crawl(_) | Run::Pull(_) => false,
    });
    html! {
        @if any {
            section {
                h2 { "Searches" }
                @for run in runs {
                    @match run {
                        Run::Search(search) => { (pulls(search)) }
                        Run::Drawn(drawn) => {
                            @if let Some(cycles) = &drawn.cycles { (found(&drawn.folder.name, cycles)) }
                        }
                        Run::Published(..) | Run::Crawl(_) | Run::Pull(_) => {}
                    }
                }
            }
        }
    }
}

/// A search of pulls: its price beside the others', and the simulation's verdicts.
fn pulls(search: &SearchRun) -> Markup {
    let result = &search.result;
    html! {
        p {
            strong { (result.gait) } ", found in " (search.folder.name) " by the objective "
            (search.aim) " on " (search.source) ", " (result.evaluations) " evaluations"
            @if !result.complete { ", ended by its time budget" }
            ": "
            @match (result.cost, result.torque) {
                (Some(cost), Some(torque)) if (cost - torque).abs() > 1e-12 => {
                    "cost " (format!("{cost:.4}")) ", torque part " (format!("{torque:.4} {}", result.unit))
                }
                (Some(cost), _) => { "cost " (format!("{cost:.4} {}", result.unit)) }
                (None, Some(torque)) => { "torque part " (format!("{torque:.4} {}", result.unit)) }
                (None, None) => { "no price" }
            }
            ", violations " (format!("{:.4}", result.violations)) "."
            @for compared in &result.compared {
                @if let Some(ratio) = compared.torque_ratio {
                    " " (format!("{ratio:.3}")) " of " (compared.gait) "'s there."
                }
            }
        }
        div.scroll { table {
            caption {
                "What the simulation says of " strong { (result.gait) } ": its cost over another gait's, \
                 at the durations of the confirmation. Ours."
            }
            thead { tr { @for head in ["regime", "against", "cheaper at", "lowest ratio", "highest ratio"] {
                th scope="col" { (head) }
            } } }
            tbody { @for verdict in &result.verdicts { tr {
                th scope="row" { (verdict.regime) }
                td { (verdict.against) }
                td { (verdict.cheaper_at) " of " (verdict.of) }
                td { (optional(verdict.best_ratio, |ratio| format!("{ratio:.3}"))) }
                td { (optional(verdict.worst_ratio, |ratio| format!("{ratio:.3}"))) }
            } } }
        } }
    }
}

/// A search of cycles: what each found, in the setting that was asked for.
fn found(name: &str, result: &Frontier) -> Markup {
    let first = |found: &Found, of: fn(&_) -> Option<f64>, decimals: usize| {
        let row = found.confirmed.settings.first();
        optional(row.and_then(of), |value| format!("{value:.decimals$}"))
    };
    html! {
        div.scroll { table {
            caption {
                strong { "Cycles, " (name) "." } " Searched for " (result.objective.name()) ", "
                (result.margin_mm) " mm kept free of the ceiling; ours, simulated in the regime \
                 locomotion. Holds: keeps 80 % of its advance without touching in all other settings \
                 of the confirmation."
            }
            thead { tr { @for head in [
                "cycle", "ceiling", "seed", "evaluations", "advance", "speed", "highest point", "heat",
                "holds",
            ] { th scope="col" { (head) } } } }
            tbody { @for found in &result.found { tr {
                th scope="row" { (found.gait) }
                td { (optional(found.ceiling_mm, |height| format!("{height:.0} mm"))) }
                td { (found.seed) }
                td { (found.evaluations) }
                td { (first(found, |row: &ConfirmedSetting| row.mm_per_cycle, 1)) " mm" }
                td { (first(found, |row| row.mm_per_s, 1)) " mm/s" }
                td { (first(found, |row| row.top_mm, 0)) " mm" }
                td { (first(found, |row| row.heat_per_metre_s, 0)) " s/m" }
                td {
                    @if found.confirmed.holds { "yes" } @else { "no" }
                    @if found.violation > 0.0 { ", breaks rules" }
                }
            } } }
        } }
    }
}

/// Conditions of every run.
pub(super) fn what_was_run(runs: &[Run]) -> Markup {
    html! {
        section {
            h2 { "What was run" }
            // What is within another folder was made under the conditions of that one.
            @for run in runs.iter().filter(|run| run.folder().given == Given::Named) {
                @let folder = run.folder();
                h3 { (folder.name) }
                dl {
                    dt { "command" } dd { "prone " (folder.head.command) ", built from commit " (folder.head.commit) }
                    @if let Some(engine) = &folder.head.engine { dt { "engine" } dd { (engine) } }
                    @match run {
                        Run::Published(_, run) => { (run.facts()) }
                        Run::Crawl(run) => { (facts(&run.info)) }
                        Run::Pull(run) => { (facts(&run.info)) }
                        Run::Search(_) | Run::Drawn(_) => {
                            @for (label, pointer) in SEARCH_FACTS {
                                @if let Some(value) = folder.said(pointer) {
                                    dt { (label) } dd { (value) }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// What a record says of itself; what it does not say is `unknown`.
fn facts(info: &RecordInfo) -> Markup {
    html! {
        @for (label, value) in record_facts(info) {
            dt { (label) } dd { (value) }
        }
    }
}

/// The conditions of a record that are worth reading, with their labels.
fn record_facts(info: &RecordInfo) -> Vec<(&'static str, String)> {
    let unknown = || "unknown".to_owned();
    let word = |word: &Option<String>| word.clone().unwrap_or_else(unknown);
    let figure = |number: Option<f64>| number.map_or_else(unknown, |number| format!("{number:?}"));
    let RecordInfo {
        robot, gait, scene, ..
    } = info;
    let mut facts = vec![
        ("gait", gait.name.clone()),
        ("about it", word(&gait.description)),
        ("its file", word(&gait.file)),
        ("mapping", word(&gait.mapping)),
        ("arms", word(&gait.arm)),
        ("scene", scene.name.clone()),
        ("friction, left", figure(scene.friction_left)),
        ("friction, right", figure(scene.friction_right)),
        ("slope, °", figure(scene.slope_deg)),
    ];
    facts.extend(origin_facts(&info.origin));
    if let Some(options) = info.options.crawl() {
        facts.extend([
            ("steering", word(&options.steering)),
            ("joints off by up to, °", figure(options.joint_offset_deg)),
        ]);
    }
    facts.push(("time scale", figure(info.options.time_scale())));
    let seed = info.options.crawl().and_then(|options| options.seed);
    facts.extend(seed.map(|seed| ("seed of joint errors", seed.to_string())));
    facts.push(("robot", robot.name.clone()));
    let family = [
        ("its family", &robot.family),
        ("its version", &robot.version),
    ];
    let family = family.into_iter();
    facts.extend(family.filter_map(|(label, name)| Some((label, name.clone()?))));
    facts.push(("its files, SHA-256", robot.sha256.clone()));
    facts
}

fn origin_facts(origin: &Origin) -> Vec<(&'static str, String)> {
    let list = |entries: &BTreeMap<String, String>| {
        let entries = entries
            .iter()
            .map(|(name, value)| format!("{name} {value}"));
        entries.collect::<Vec<_>>().join(", ")
    };
    match origin {
        Origin::Simulated(simulated) => vec![
            ("contact regime", simulated.regime.name.clone()),
            ("torque limit", simulated.regime.effort_limit.clone()),
            (
                "time step, s",
                format!("{:?}", simulated.regime.time_step_s),
            ),
            (
                "integrator, solver, cone",
                format!(
                    "{}, {}, {}",
                    simulated.integrator, simulated.solver, simulated.cone
                ),
            ),
        ],
        Origin::Robot(robot) => vec![
            ("recorded on the robot", robot.host.clone()),
            ("its software", list(&robot.versions)),
            ("settings", list(&robot.settings)),
        ],
        Origin::Imported(imported) => vec![("imported from", imported.from.clone())],
    }
}

/// Words and numbers of the `run.json` of a search or a map that are worth reading, with where they
/// are.
const SEARCH_FACTS: [(&str, &str); 8] = [
    ("robot", "/robot/name"),
    ("its family", "/robot/family"),
    ("its version", "/robot/version"),
    ("its files, SHA-256", "/robot/sha256"),
    ("solver", "/solver"),
    ("seed", "/seed"),
    ("budget, evaluations", "/budget"),
    ("map", "/map"),
];

/// A value, or a dash.
fn optional(value: Option<f64>, show: impl Fn(f64) -> String) -> String {
    value.map_or_else(|| "–".to_owned(), show)
}
