//! What a report takes from a result folder, whatever made it.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use maud::{Markup, html};
use serde::Deserialize;

use super::folder::{Folder, Given};
use super::publication::{Publication, PublishedRun};
use super::pull_search::SearchResult;
use super::record_run::Record;
use super::{ReportError, cycle_search, pull_search, record_run};
use crate::figures::Figure;
use prone_record::figure_entry::FigureEntry;
use prone_record::frontier::Frontier;
use prone_record::program::RobotInfo;
use prone_record::search_plan::SearchPlan;

/// What was read of a result folder.
pub struct Run {
    pub(super) folder: Folder,
    pub(super) content: Content,
    /// Figures that are drawn from its tables.
    pub drawings: Vec<Figure>,
    /// Figures that it holds as files.
    pub recorded: Vec<FigureEntry>,
    /// What is missing of its tables, one sentence each.
    pub shortfalls: Vec<String>,
    /// What it never had, one sentence each.
    pub unrecorded: Vec<String>,
    /// Name of its robot, where it says.
    pub robot: Option<String>,
    /// Under which conditions it was made, as entries of a description list.
    pub facts: Markup,
}

/// What only results of one kind have.
pub(super) enum Content {
    Published(Box<dyn PublishedRun>),
    Record(Box<Record>),
    Pulls(Box<SearchResult>),
    Cycles(Frontier),
    Map,
}

impl Run {
    /// A result of a publication's own command, without figures and conditions.
    pub fn published(folder: &Folder, run: Box<dyn PublishedRun>) -> Self {
        Self::new(folder.clone(), Content::Published(run))
    }

    pub(super) fn new(folder: Folder, content: Content) -> Self {
        Self {
            folder,
            content,
            drawings: Vec::new(),
            recorded: Vec::new(),
            shortfalls: Vec::new(),
            unrecorded: Vec::new(),
            robot: None,
            facts: html! {},
        }
    }

    /// Reads a folder and, of a publication's own result, the records within it that are not among
    /// those that the user `named`.
    pub(super) fn read(
        folder: Folder,
        named: &BTreeSet<PathBuf>,
        publication: &dyn Publication,
    ) -> Result<Vec<Self>, ReportError> {
        if let Some(published) = publication.read(&folder) {
            let mut runs = vec![published?];
            for inner in folder.records() {
                let path = folder.path.join(&inner);
                if !named.contains(&real(&path)) {
                    let name = format!("{}/{inner}", folder.name);
                    let inner = Folder::open(&name, &path, Given::Within)?;
                    runs.extend(Self::read(inner, named, publication)?);
                }
            }
            return Ok(runs);
        }
        let run = match folder.head.command.as_str() {
            "crawl run" | "reproduce crawl" | "reproduce pull" => {
                record_run::read(folder, publication)
            }
            "optimize" | "crawl frontier" => search(folder, publication),
            "torque-map plot" => map(folder),
            other => Err(ReportError::OtherCommand {
                found: other.to_owned(),
                folder: folder.path,
            }),
        };
        Ok(vec![run?])
    }

    /// The record that can be replayed, where it is one.
    pub(super) fn record(&self) -> Option<&Record> {
        match &self.content {
            Content::Record(record) => Some(record),
            _ => None,
        }
    }
}

/// A folder without links, as far as it is there.
pub(super) fn real(folder: &Path) -> PathBuf {
    fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned())
}

/// A search, with the conditions that its plan states.
fn search(folder: Folder, publication: &dyn Publication) -> Result<Run, ReportError> {
    let plan: SearchPlan = folder.run()?;
    let (robot, mut run) = match &plan {
        SearchPlan::Pull(plan) => (
            &plan.pricing.robot,
            pull_search::read(folder, plan, publication)?,
        ),
        SearchPlan::Cycle(plan) => (&plan.robot, cycle_search::read(folder, &plan.under)?),
    };
    let head = plan.head();
    let mut facts = robot_facts(robot);
    facts.push(("solver", head.solver.name().to_owned()));
    facts.push(("seed", head.seed.to_string()));
    let budget = head.budget.map(|budget| budget.to_string());
    facts.extend(budget.map(|budget| ("budget, evaluations", budget)));
    run.facts = entries(&facts);
    run.robot = Some(robot.name.clone());
    Ok(run)
}

/// A condition: label and value.
pub(super) type Fact = (&'static str, String);

/// Conditions as entries of a description list.
pub(super) fn entries(facts: &[Fact]) -> Markup {
    html! { @for (label, value) in facts { dt { (label) } dd { (value) } } }
}

/// Which robot it was.
pub(super) fn robot_facts(robot: &RobotInfo) -> Vec<Fact> {
    let facts = [
        ("robot", Some(&robot.name)),
        ("its family", robot.family.as_ref()),
        ("its version", robot.version.as_ref()),
        ("its files, SHA-256", Some(&robot.sha256)),
    ];
    let facts = facts.into_iter();
    facts
        .filter_map(|(label, value)| Some((label, value?.clone())))
        .collect()
}

/// What is needed of the `run.json` of drawn slices of a torque map.
#[derive(Deserialize)]
struct MapInfo {
    map: String,
}

/// Slices of a torque map, which are shown as they were drawn.
fn map(folder: Folder) -> Result<Run, ReportError> {
    let info: MapInfo = folder.run()?;
    let recorded = folder.figures()?;
    let mut run = Run::new(folder, Content::Map);
    run.recorded = recorded;
    run.facts = entries(&[("map", info.map)]);
    Ok(run)
}
