//! What a report takes from a result folder, whatever made it.

mod cycle_search;
pub(super) mod pull_search;
pub(super) mod record;

use std::fs;
use std::path::{Path, PathBuf};

use maud::{Markup, html};
use serde::Deserialize;

use super::ReportError;
use super::folder::{Folder, Given};
use crate::figures::{Figure, GaitNumbers};
use prone_record::figure_entry::FigureEntry;
use prone_record::frontier::Frontier;
use prone_record::program::RobotInfo;
use prone_record::search_plan::SearchPlan;
use pull_search::PullSearch;
use record::Record;

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

/// A result of a publication's own command: what the page says of it beside its figures.
pub trait PublishedRun: Send + Sync {
    /// What was published, as a heading.
    fn title(&self) -> &str;

    /// What stands first on the page.
    fn results(&self) -> Markup;

    /// Tables that follow the figure of a number.
    fn tables_after(&self, number: &str) -> Markup;

    /// What follows the figures.
    fn sections(&self) -> Markup;
}

/// What only results of one kind have.
pub(super) enum Content {
    Published(Box<dyn PublishedRun>),
    Record(Box<Record>),
    Pulls(Box<PullSearch>),
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

    /// Reads a search, with the conditions that its plan states; `gaits` are those of a publication.
    pub(super) fn search(folder: Folder, gaits: &[GaitNumbers]) -> Result<Self, ReportError> {
        let plan: SearchPlan = folder.run()?;
        let (robot, mut run) = match &plan {
            SearchPlan::Pull(plan) => {
                let run = pull_search::read(folder, plan, gaits)?;
                (&plan.pricing.robot, run)
            }
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

    /// Reads slices of a torque map, which are shown as they were drawn.
    pub(super) fn map(folder: Folder) -> Result<Self, ReportError> {
        let info: MapInfo = folder.run()?;
        let recorded = folder.figures()?;
        let mut run = Self::new(folder, Content::Map);
        run.recorded = recorded;
        run.facts = entries(&[("map", info.map)]);
        Ok(run)
    }

    /// What it holds, in a few words.
    pub(super) fn title(&self) -> String {
        match &self.content {
            Content::Published(run) => run.title().to_owned(),
            Content::Record(record) => record.replay.title().to_owned(),
            Content::Pulls(search) => format!("{}, found by a search", search.result.gait),
            Content::Cycles(result) => format!("Search of cycles for {}", result.objective.name()),
            Content::Map => "Torque map".to_owned(),
        }
    }

    /// Whether the user made it and named it: no result of a publication's own command, nor within one.
    pub(super) fn is_own(&self) -> bool {
        self.folder.given == Given::Named && !matches!(self.content, Content::Published(_))
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
