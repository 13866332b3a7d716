//! The two experiments of the original under its table, crawled again in simulation.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use prone::crawl::Straight;
use prone::gait::cycle::TimeScale;
use prone::regime::Regime;
use prone::scene::Scene;
use prone_sim::crawl::{self, Crawl, CrawlPlan, Detail, End, OnTouch};
use prone_sim::{LoadedRobot, World};

use crate::published::{TABLE_CRAWLS, TableCrawl};
use crate::run_info::TableInfo;
use crate::torque_study::StudyError;
use prone_record::crawl_summary::CrawlSummary;
use prone_record::record_info::CrawlOptions;
use prone_study::crawl::{GaitSource, summary};
use prone_study::watch::{Progress, Watch};

/// How the published figures came about.
const PUBLISHED_BY: &str = "on the real robot, distance and time as printed";

/// How ours came about.
const OURS_BY: &str = "in simulation, displacement of the trunk's frame; at the gait's own 3 s a \
                       cycle: the 2.3 s of the second experiment would be too fast for a shoulder \
                       on our way back";

/// What is crawled, and where.
#[derive(Debug, Clone, PartialEq)]
pub struct TableStudy {
    /// The cycle.
    pub gait: GaitSource,
    /// The table.
    pub scene: Scene,
    /// The text of its file.
    pub scene_text: String,
}

/// One experiment, ours beside the published one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TableExperiment {
    /// From 1.
    pub experiment: usize,
    /// What was published.
    pub published: TableCrawl,
    /// How that was obtained.
    pub published_obtained: Cow<'static, str>,
    /// What our simulation does.
    pub ours: CrawlSummary,
    /// How that was obtained.
    pub ours_obtained: Cow<'static, str>,
}

/// Both experiments.
pub(crate) struct TableResult {
    pub(crate) world: World,
    pub(crate) experiments: Vec<TableExperiment>,
    /// The shorter one, with rows.
    pub(crate) shortest: Crawl,
    /// The longer one, with rows.
    pub(crate) longest: Crawl,
    pub(crate) engine_steps: usize,
}

/// Simulates both, one after the other.
pub(crate) fn run(
    robot: &LoadedRobot,
    study: &TableStudy,
    watch: &dyn Watch,
) -> Result<TableResult, StudyError> {
    let world = World::in_scene(robot, Regime::LOCOMOTION, &study.scene)?;
    let [short, long] = TABLE_CRAWLS;
    let (first, shortest) = experiment(&world, study, 1, short, watch)?;
    let (second, longest) = experiment(&world, study, 2, long, watch)?;
    Ok(TableResult {
        engine_steps: shortest.engine_steps + longest.engine_steps,
        experiments: vec![first, second],
        shortest,
        longest,
        world,
    })
}

fn experiment(
    world: &World,
    study: &TableStudy,
    number: usize,
    published: TableCrawl,
    watch: &dyn Watch,
) -> Result<(TableExperiment, Crawl), StudyError> {
    let plan = CrawlPlan {
        cycles: vec![study.gait.cycle.clone()],
        scale: TimeScale::ONE,
        end: End::Cycles(published.cycles),
        offsets: None,
        late: None,
        imu_seed: None,
        on_touch: OnTouch::GoOn,
        detail: Detail::Rows,
    };
    let stopped = || watch.stop();
    let crawl = crawl::run_unless(&stopped, world, &plan, Straight::default())?;
    let ours = summary::of(world, &study.gait.cycle, TimeScale::ONE, &crawl, None)?;
    watch.progress(&Progress::Done(1));
    let experiment = TableExperiment {
        experiment: number,
        published,
        published_obtained: PUBLISHED_BY.into(),
        ours,
        ours_obtained: OURS_BY.into(),
    };
    Ok((experiment, crawl))
}

impl TableStudy {
    /// What is crawled and where, for `run.json` and the report.
    pub(crate) fn info(&self) -> TableInfo {
        let regime = Regime::LOCOMOTION;
        TableInfo {
            gait: self.gait.cycle.name.clone(),
            description: self.gait.cycle.description.clone(),
            scene: self.scene.name.clone(),
            regime: regime.name.into(),
            friction: regime.friction,
            impratio: regime.impratio,
        }
    }

    /// Under which conditions an experiment was crawled.
    pub(crate) fn conditions(&self, experiment: &TableExperiment) -> CrawlOptions {
        CrawlOptions {
            most_cycles: Some(experiment.published.cycles),
            time_scale: Some(TimeScale::ONE.value()),
            steering: Some("none".to_owned()),
            turn_command_deg: Some(0.0),
            joint_offset_deg: Some(0.0),
            scene_text: Some(self.scene_text.clone()),
            ..CrawlOptions::default()
        }
    }
}

impl TableExperiment {
    /// With what it touched what, and with which largest force, in words.
    pub fn touched(&self) -> String {
        if self.ours.contacts.is_empty() {
            return "touched nothing".to_owned();
        }
        let touched = self.ours.contacts.iter();
        let parts: Vec<String> = touched
            .map(|contact| {
                let (obstacle, body, peak_n) = (&contact.obstacle, &contact.body, contact.peak_n);
                format!("{obstacle} with {body} (up to {peak_n:.0} N)")
            })
            .collect();
        format!("touched {}", parts.join(", "))
    }
}
