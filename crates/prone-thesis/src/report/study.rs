//! Reading the result folder of `prone reproduce`.

use maud::{Markup, html};

use super::{parameter_tables, sections};
use crate::prose::Numbers;
use crate::published;
use crate::run_info::RunInfo;
use crate::summary::Summary;
use prone_record::figure_entry::FigureEntry;
use prone_record::pulls::{ChainRecord, CostRecord, JOINTS, PullRecord, PullRow};
use prone_record::tables::{ARM_JOINTS, torque_file_name};
use prone_report::figures::{Figure, FigureError, study_figures};
use prone_report::report::{Cut, Folder, PublishedRun, ReportError, chains};

/// A pull whose last row is nearer to its end than this is whole, percent of the phase.
const END: f64 = 1e-6;

/// What a reproduction left behind.
pub(crate) struct StudyRun {
    pub(crate) info: RunInfo,
    pub(crate) summary: Summary,
    pub(crate) chains: Vec<ChainRecord>,
    pub(crate) pulls: Vec<PullRecord>,
    pub(crate) costs: Vec<CostRecord>,
    pub(crate) recorded: Vec<FigureEntry>,
    pub(crate) cuts: Vec<Cut>,
}

impl StudyRun {
    pub(crate) fn read(folder: &Folder) -> Result<Self, ReportError> {
        let info: RunInfo = folder.run()?;
        let mut cuts = Vec::new();
        let gaits: Vec<&str> = info
            .options
            .gaits
            .iter()
            .map(|gait| gait.name.as_str())
            .collect();
        let chains = chains::read(folder, Some(&gaits), &mut cuts)?;
        let mut pulls = Vec::new();
        for gait in &gaits {
            for &duration_s in &info.options.durations_s {
                pulls.push(pull(folder, gait, duration_s, &mut cuts)?);
            }
        }
        let expected = gaits.len() * info.options.durations_s.len();
        Ok(Self {
            summary: folder.json("summary.json")?,
            recorded: folder.figures()?,
            costs: costs(folder, expected, &mut cuts)?,
            info,
            chains,
            pulls,
            cuts,
        })
    }
}

impl PublishedRun for StudyRun {
    /// Figures 25, 26, 34 and 36 to 45.
    fn drawings(&self) -> Result<Vec<Figure>, FigureError> {
        study_figures(&published::FIGURES, &self.chains, &self.pulls, &self.costs)
    }

    fn recorded(&self) -> &[FigureEntry] {
        &self.recorded
    }

    fn shortfalls(&self) -> Vec<String> {
        self.cuts.iter().map(ToString::to_string).collect()
    }

    fn results(&self) -> Markup {
        sections::results(&self.summary)
    }

    fn tables_after(&self, number: &str) -> Markup {
        html! {
            @if number == "25" {
                @for gait in &self.info.options.gaits {
                    @if gait.name == published::NOMINAL { (parameter_tables::nominal(&gait.curves)) }
                    @if gait.name == published::OPTIMAL { (parameter_tables::optimal(&gait.curves)) }
                }
            }
            @if number == "28" && !self.summary.table.is_empty() {
                (sections::table_crawl(&self.summary, &self.info))
            }
        }
    }

    fn sections(&self) -> Markup {
        let numbers = Numbers::new(&self.info, self.summary.robot.as_ref());
        let family = self.info.robot.family.as_deref();
        html! {
            (sections::costs(&self.summary))
            (sections::agreement(&self.summary))
            (sections::contacts(&self.summary, &numbers))
            (sections::stride(&self.summary, &numbers))
            (sections::clamps(&self.summary, &numbers, family))
            (sections::mappings(&self.summary, &numbers))
            (sections::differences(&numbers, family))
        }
    }

    fn facts(&self) -> Markup {
        sections::study_facts(&self.info)
    }
}

fn pull(
    folder: &Folder,
    gait: &str,
    duration_s: f64,
    cuts: &mut Vec<Cut>,
) -> Result<PullRecord, ReportError> {
    let mut pull = PullRecord {
        gait: gait.to_owned(),
        duration_s,
        rows: Vec::new(),
    };
    let mut table = folder.table(&format!("torques/{}", torque_file_name(&pull)))?;
    let [time, percent] = table.columns(["time_s", "cycle_percent"])?;
    let mut torques = [time; 4];
    for (torque, joint) in torques.iter_mut().zip(JOINTS) {
        *torque = table.column(&format!("{joint}_nm"))?;
    }
    let (mut commands, mut angles) = ([time; 7], [time; 7]);
    for (index, joint) in JOINTS.iter().chain(&ARM_JOINTS).enumerate() {
        commands[index] = table.column(&format!("{joint}_cmd_rad"))?;
        angles[index] = table.column(&format!("{joint}_rad"))?;
    }
    let contacts = table.columns(["toe_n", "elbow_n", "torso_n", "leg_n"])?;
    let [top, head_top] = table.columns(["top_mm", "head_top_mm"])?;
    let mut before = 0.0;
    pull.rows = table.rows(|line| {
        let row = PullRow {
            time_s: line.number(time)?,
            cycle_percent: line.number(percent)?,
            torque_nm: line.numbers(torques)?,
            command_rad: line.numbers(commands)?,
            angle_rad: line.numbers(angles)?,
            contact_n: line.numbers(contacts)?,
            top_mm: line.number(top)?,
            head_top_mm: line.number(head_top)?,
        };
        let forward = row.time_s > before;
        before = row.time_s;
        forward.then_some(row)
    });
    let end = pull.rows.last().map_or(0.0, |row| row.cycle_percent);
    if end < 100.0 - END {
        table.end_early();
    }
    cuts.extend(table.cut());
    Ok(pull)
}

fn costs(
    folder: &Folder,
    expected: usize,
    cuts: &mut Vec<Cut>,
) -> Result<Vec<CostRecord>, ReportError> {
    let mut table = folder.table("costs.csv")?;
    let [gait, duration, cost, published] =
        table.columns(["gait", "duration_s", "cost_n2m2s", "published_n2m2s"])?;
    let costs = table.rows(|line| {
        Some(CostRecord {
            gait: line.text(gait).to_owned(),
            duration_s: line.number(duration)?,
            cost_n2m2s: line.number(cost)?,
            published_n2m2s: line.optional(published).ok()?,
        })
    });
    if costs.len() < expected {
        table.end_early();
    }
    cuts.extend(table.cut());
    Ok(costs)
}
