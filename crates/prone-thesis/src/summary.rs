//! The study in figures: `summary.json`.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::agreement::Agreement;
use crate::published::{self, TABLE_CRAWLS};
use crate::robot_numbers::RobotNumbers;
use crate::squeeze::{Squeeze, SqueezeRatio};
use crate::table_crawl::TableExperiment;
use crate::torque_study::TorqueStudy;
use prone_record::contact_story::ContactStory;
use prone_record::program::RobotInfo;
use prone_record::pulls::{ChainRecord, ChainSample, ClampRecord, CostRecord, RunRecord};
use prone_sim::LoadedRobot;

/// Everything that the report's tables show.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Cost of each pull, ours beside the published one.
    pub costs: Vec<CostRow>,
    /// Cost of the optimal gait over the nominal one's, by duration.
    pub ratios: Vec<RatioRow>,
    /// Agreement with the recorded torques.
    pub agreement: Vec<Agreement>,
    /// How far a pull carries the body.
    pub stride: Stride,
    /// The ankle's highest point in the planned chain.
    pub ankle_peak: Vec<AnklePeak>,
    /// Advance and heights of each simulated pull.
    pub runs: Vec<RunRecord>,
    /// Joints stopped at their limits, by gait.
    pub clamps: Vec<ClampRecord>,
    /// Which part carries the body when, at the showcase duration.
    pub contacts: Vec<ContactStory>,
    /// What the mapping changes, at the showcase duration.
    pub mappings: Vec<MappingRow>,
    /// The experiments under the table, where the robot can do them.
    pub table: Vec<TableExperiment>,
    /// Numbers of the robot that the report's sentences have.
    pub robot: Option<RobotNumbers>,
    /// The robot of the study: all but `table` and `beside`.
    #[serde(default)]
    pub study_of: Option<RobotInfo>,
    /// The robot that crawled under the table.
    #[serde(default)]
    pub crawl_of: Option<RobotInfo>,
    /// The same pulls of the version that crawls, where the study is of another one.
    #[serde(default)]
    pub beside: Option<Beside>,
    /// Internal squeeze of each pull in which the chain comes to carry the body, ours and published.
    #[serde(default)]
    pub squeeze: Vec<Squeeze>,
    /// Optimal over nominal with and without it.
    #[serde(default)]
    pub squeeze_ratios: Vec<SqueezeRatio>,
}

/// The pulls of a version of the robot that the published torques are not of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Beside {
    /// Which robot.
    pub robot: RobotInfo,
    /// Its mass, kg.
    pub mass_kg: f64,
    /// Cost of each pull, beside the published one.
    pub costs: Vec<CostRow>,
    /// Cost of the optimal gait over the nominal one's, by duration.
    pub ratios: Vec<RatioRow>,
    /// Agreement with the recorded torques.
    pub agreement: Vec<Agreement>,
}

impl Beside {
    /// Of a robot and its pulls.
    pub fn new(robot: &LoadedRobot, study: &TorqueStudy, agreement: Vec<Agreement>) -> Self {
        Self {
            robot: RobotInfo::of(robot.robot(), robot.files()),
            mass_kg: robot.robot().mass(),
            costs: study.costs.iter().map(cost_row).collect(),
            ratios: ratios(&study.costs),
            agreement,
        }
    }

    /// What its files carry in their names.
    pub fn file_suffix(&self) -> &str {
        self.robot.version.as_deref().unwrap_or("other")
    }
}

/// A cost beside the published one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CostRow {
    /// Name of the gait.
    pub gait: String,
    /// Duration of the phase, s.
    pub duration_s: f64,
    /// Our simulation, N²·m²·s.
    pub cost_n2m2s: f64,
    /// Published, N²·m²·s.
    pub published_n2m2s: Option<f64>,
    /// Ours over theirs, minus one.
    pub relative_difference: Option<f64>,
}

/// The gain of the optimal gait.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RatioRow {
    /// Duration of the phase, s.
    pub duration_s: f64,
    /// Optimal over nominal in our simulation.
    pub ours: f64,
    /// The same from the published costs.
    pub published: Option<f64>,
}

/// How far the body is carried.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Stride {
    /// Advance of the shoulder in the planned chain, mm, by gait.
    pub chain_mm: Vec<(String, f64)>,
    /// Published advance of the real robot per whole crawl cycle in two experiments, mm.
    pub published_robot_mm_per_cycle: [f64; 2],
}

/// The ankle's highest point in a planned chain.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AnklePeak {
    /// Name of the gait.
    pub gait: String,
    /// Height of the joint's centre, mm.
    pub height_mm: f64,
    /// Where in the phase, percent.
    pub at_percent: f64,
    /// The published height, mm, as its text words it; printed for the nominal gait only.
    pub published_mm: Option<Cow<'static, str>>,
}

/// The same gait under both mappings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MappingRow {
    /// Name of the gait.
    pub gait: String,
    /// Duration of the phase, s.
    pub duration_s: f64,
    /// Cost under the gait's own mapping, N²·m²·s.
    pub own_n2m2s: f64,
    /// Cost under the mapping `exact`, N²·m²·s.
    pub exact_n2m2s: f64,
}

/// Gathers the figures of a study.
pub fn of(
    study: &TorqueStudy,
    agreement: Vec<Agreement>,
    contacts: Vec<ContactStory>,
    table: Vec<TableExperiment>,
) -> Summary {
    Summary {
        costs: study.costs.iter().map(cost_row).collect(),
        ratios: ratios(&study.costs),
        agreement,
        stride: Stride {
            chain_mm: study.chains.iter().map(stride).collect(),
            published_robot_mm_per_cycle: TABLE_CRAWLS.map(|crawl| crawl.mm_per_cycle()),
        },
        ankle_peak: study.chains.iter().filter_map(ankle_peak).collect(),
        runs: study.runs.clone(),
        clamps: study.clamps.clone(),
        contacts,
        mappings: mappings(study),
        table,
        robot: None,
        study_of: None,
        crawl_of: None,
        beside: None,
        squeeze: Vec::new(),
        squeeze_ratios: Vec::new(),
    }
}

fn cost_row(cost: &CostRecord) -> CostRow {
    CostRow {
        gait: cost.gait.clone(),
        duration_s: cost.duration_s,
        cost_n2m2s: cost.cost_n2m2s,
        published_n2m2s: cost.published_n2m2s,
        relative_difference: cost
            .published_n2m2s
            .map(|theirs| cost.cost_n2m2s / theirs - 1.0),
    }
}

/// The cost of a gait at a duration.
fn cost<'a>(costs: &'a [CostRecord], gait: &str, duration_s: f64) -> Option<&'a CostRecord> {
    let mut costs = costs.iter();
    costs.find(|cost| cost.gait == gait && (cost.duration_s - duration_s).abs() < 1e-9)
}

fn ratios(costs: &[CostRecord]) -> Vec<RatioRow> {
    let nominal = costs.iter().filter(|cost| cost.gait == published::NOMINAL);
    let ratios = nominal.filter_map(|nominal| {
        let optimal = cost(costs, published::OPTIMAL, nominal.duration_s)?;
        let published = optimal.published_n2m2s.zip(nominal.published_n2m2s);
        Some(RatioRow {
            duration_s: nominal.duration_s,
            ours: optimal.cost_n2m2s / nominal.cost_n2m2s,
            published: published.map(|(optimal, nominal)| optimal / nominal),
        })
    });
    ratios.collect()
}

/// Points of a [`ChainSample`]: toe, ankle, knee, hip, shoulder, elbow.
const ANKLE: usize = 1;
const SHOULDER: usize = 4;

fn stride(chain: &ChainRecord) -> (String, f64) {
    let x = |sample: Option<&ChainSample>| {
        sample.map_or(f64::NAN, |sample| sample.points_mm[SHOULDER].0)
    };
    let advance = x(chain.samples.last()) - x(chain.samples.first());
    (chain.gait.clone(), advance)
}

fn ankle_peak(chain: &ChainRecord) -> Option<AnklePeak> {
    let height = |sample: &&ChainSample| sample.points_mm[ANKLE].1;
    let samples = chain.samples.iter();
    let peak = samples.max_by(|a, b| height(a).total_cmp(&height(b)))?;
    Some(AnklePeak {
        gait: chain.gait.clone(),
        height_mm: height(&peak),
        at_percent: peak.s * 100.0,
        published_mm: (chain.gait == published::NOMINAL).then_some(published::ANKLE_PEAK_MM.into()),
    })
}

fn mappings(study: &TorqueStudy) -> Vec<MappingRow> {
    let rows = study.exact_costs.iter().filter_map(|exact| {
        let own = cost(&study.costs, &exact.gait, exact.duration_s)?;
        Some(MappingRow {
            gait: exact.gait.clone(),
            duration_s: exact.duration_s,
            own_n2m2s: own.cost_n2m2s,
            exact_n2m2s: exact.cost_n2m2s,
        })
    });
    rows.collect()
}
