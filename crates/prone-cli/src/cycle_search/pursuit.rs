//! Carrying out a search of cycles: checkpoint, searches one after the other, confirmation, result.

use std::io::Write as _;
use std::ops::ControlFlow;
use std::time::Instant;

use anyhow::anyhow;
use serde_json::json;

use prone::gait::cycle::Cycle;
use prone::regime::Regime;
use prone_record::frontier::SettingKind;
use prone_record::frontier::{Compared, Found, Frontier};
use prone_record::output;
use prone_record::resumption::Snapshot;
use prone_record::search::{Search, SearchEnd};
use prone_study::cycle_search::frontier;

use super::files::{self, pretty};
use super::{Job, Quest};
use crate::checkpoint::{self, suspended, unwritten};
use crate::progress::SearchProgress;
use crate::{Failure, interrupt};

/// Searches, confirms and writes the result.
pub(super) fn pursue(quest: &mut Quest<'_>) -> Result<(), Failure> {
    interrupt::listen()?;
    output::check(quest.out).map_err(Failure::input)?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(quest.threads.map_or(0, usize::from))
        .build()
        .map_err(|error| Failure::Work(anyhow!("cannot start worker threads: {error}")))?;
    complete(quest);
    let (mut checkpoint, earlier) = checkpoint::open(quest.out, &quest.plan, quest.resume)?;
    // Not part of what a checkpoint must agree with: a search may be given more.
    quest.plan["budget"] = json!(quest.budget);
    let mut searches = begin(quest, earlier)?;
    let started = Instant::now();
    pool.install(|| search(quest, &mut searches, &mut checkpoint))?;
    let (frontier, gaits) = pool.install(|| found(quest, &searches))?;
    if interrupt::requested() {
        return Err(suspended(checkpoint.path()));
    }
    let mut artefacts = files::artefacts(quest, &frontier, &gaits, &searches)?;
    let timing = json!({
        "wall_s": started.elapsed().as_secs_f64(),
        "threads": pool.current_num_threads(),
    });
    artefacts.insert("timing.json".into(), pretty(&timing)?);
    interrupt::publish(|| {
        output::publish(quest.out, &artefacts).map_err(Failure::work)?;
        checkpoint.remove().map_err(unwritten)
    })?;
    let mut out = std::io::stdout().lock();
    if quest.json {
        let text = serde_json::to_string_pretty(&frontier).map_err(Failure::work)?;
        writeln!(out, "{text}")?;
        return Ok(());
    }
    print(&frontier, &mut out)?;
    writeln!(out, "\nresult: {}", quest.out.display())?;
    Ok(())
}

/// What every plan says.
fn complete(quest: &mut Quest<'_>) {
    quest.plan["program"] = json!("prone");
    quest.plan["version"] = json!(env!("CARGO_PKG_VERSION"));
    quest.plan["commit"] = json!(env!("PRONE_COMMIT"));
    quest.plan["engine"] = json!(prone_sim::engine_version());
    quest.plan["solver"] = json!("cma-es, about the middle");
    quest.plan["regime"] = json!(Regime::LOCOMOTION.name);
    quest.plan["bases"] = quest.jobs.iter().map(|job| job.base.as_str()).collect();
    quest.plan["robot"] = crate::robot::said(quest.robot);
}

/// New searches, one a job, or those that were interrupted.
fn begin(quest: &Quest<'_>, earlier: Option<Vec<Search>>) -> Result<Vec<Search>, Failure> {
    let Some(mut searches) = earlier else {
        let fresh = |_: &Job<'_>| Search::about_the_middle(quest.seed, quest.runs, quest.budget);
        return Ok(quest.jobs.iter().map(fresh).collect());
    };
    if searches.len() != quest.jobs.len() {
        return Err(Failure::Input(anyhow!(
            "the checkpoint holds {} searches in place of {}; without --resume it is replaced",
            searches.len(),
            quest.jobs.len()
        )));
    }
    for search in &mut searches {
        search.allow(quest.budget).map_err(Failure::input)?;
    }
    Ok(searches)
}

fn search(
    quest: &Quest<'_>,
    searches: &mut Vec<Search>,
    checkpoint: &mut Snapshot<Vec<Search>>,
) -> Result<(), Failure> {
    for (index, job) in quest.jobs.iter().enumerate() {
        let mut search = searches[index].clone();
        let progress = SearchProgress::new(&search)?;
        let mut kept = Ok(());
        let end = job.hunt.proceed(&mut search, |search| {
            progress.show(search);
            searches[index].clone_from(search);
            kept = checkpoint.keep(searches);
            if kept.is_err() || interrupt::requested() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        progress.finish();
        kept.map_err(unwritten)?;
        searches[index] = search;
        checkpoint.write(searches).map_err(unwritten)?;
        if end == SearchEnd::Interrupted {
            return Err(suspended(checkpoint.path()));
        }
    }
    Ok(())
}

/// What each run found, confirmed, and the cycles under their names.
fn found(quest: &Quest<'_>, searches: &[Search]) -> Result<(Frontier, Vec<Cycle>), Failure> {
    let mut frontier = Frontier {
        objective: quest.objective,
        margin_mm: quest.margin_mm,
        found: Vec::new(),
        compared: Vec::new(),
    };
    let mut gaits = Vec::new();
    for (job, search) in quest.jobs.iter().zip(searches) {
        for run in search.runs() {
            let Some(best) = run.best() else {
                continue;
            };
            let (mut cycle, price) = job.hunt.quote(&best.point).map_err(Failure::work)?;
            let stem = match (&quest.name, job.ceiling_mm) {
                (Some(name), _) => name.clone(),
                (None, Some(mm)) => format!("under-{}", mm.to_string().replace('.', "-")),
                (None, None) => "open".to_owned(),
            };
            cycle.pull.name = format!("{stem}-seed-{}", run.seed);
            let steering = match cycle.steering {
                None => Ok(()),
                Some(_) => frontier::check_steering(&quest.steering, &cycle),
            };
            if steering.is_err() {
                cycle.steering = None;
            }
            let under = job
                .ceiling_mm
                .map_or_else(String::new, |mm| format!(" under {mm} mm"));
            cycle.pull.description = format!(
                "searched{under} about {} for {}, seed {}, {} evaluations",
                job.base,
                quest.objective.name(),
                run.seed,
                run.evaluations()
            );
            let ceiling = job.ceiling_mm.map_or(f64::INFINITY, |mm| mm * 1e-3);
            let confirmed = frontier::confirm(&quest.confirmation, &cycle, ceiling);
            let found = frontier::found(
                job.ceiling_mm,
                run.seed,
                run.evaluations(),
                &cycle,
                &price,
                confirmed,
            );
            frontier.found.push(Found {
                unsteered: steering.err().map(|reason| reason.to_string()),
                ..found
            });
            gaits.push(cycle);
        }
    }
    for cycle in &quest.compared {
        let confirmed = frontier::confirm(&quest.confirmation, cycle, f64::INFINITY);
        // What the robot cannot crawl is no comparison.
        if confirmed.settings.iter().any(|row| row.refused.is_none()) {
            frontier.compared.push(Compared {
                gait: cycle.pull.name.clone(),
                confirmed,
            });
        }
    }
    Ok((frontier, gaits))
}

fn print(frontier: &Frontier, out: &mut impl std::io::Write) -> std::io::Result<()> {
    if frontier.found.is_empty() {
        writeln!(
            out,
            "no cycle was found that can be crawled: --budget is too small"
        )?;
    }
    writeln!(
        out,
        "{:>10}{:>6}{:>14}{:>9}{:>10}{:>12}{:>12}{:>11}  holds",
        "ceiling", "seed", "mm per cycle", "mm/s", "top mm", "heat s/m", "stiff s/m", "violation"
    )?;
    let number = |value: Option<f64>, decimals: usize| {
        value.map_or_else(|| "–".to_owned(), |value| format!("{value:.decimals$}"))
    };
    let rows = frontier.found.iter().map(|found| {
        let ceiling = found
            .ceiling_mm
            .map_or_else(|| "–".to_owned(), |mm| format!("{mm} mm"));
        (
            ceiling,
            found.seed.to_string(),
            &found.confirmed,
            Some(found.violation),
        )
    });
    let compared = frontier.compared.iter();
    let others = compared.map(|other| (other.gait.clone(), String::new(), &other.confirmed, None));
    for (name, seed, confirmed, violation) in rows.chain(others) {
        let first = confirmed.settings.first();
        let stiff = confirmed
            .settings
            .iter()
            .find(|row| row.setting == SettingKind::StiffServos);
        writeln!(
            out,
            "{name:>10}{seed:>6}{:>14}{:>9}{:>10}{:>12}{:>12}{:>11}  {}",
            number(first.and_then(|row| row.mm_per_cycle), 1),
            number(first.and_then(|row| row.mm_per_s), 1),
            number(first.and_then(|row| row.top_mm), 1),
            number(first.and_then(|row| row.heat_per_metre_s), 1),
            number(stiff.and_then(|row| row.heat_per_metre_s), 1),
            number(violation, 4),
            if confirmed.holds { "yes" } else { "no" }
        )?;
    }
    Ok(())
}
