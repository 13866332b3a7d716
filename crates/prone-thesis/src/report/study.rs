//! Reading the result folder of `prone reproduce`.

use maud::{Markup, html};

use super::{parameter_tables, sections};
use crate::prose::Numbers;
use crate::published;
use crate::run_info::RunInfo;
use crate::summary::Summary;
use prone_record::pulls::{CostRecord, JOINTS, PullRecord, PullRow};
use prone_record::tables::{ARM_JOINTS, torque_file_name};
use prone_report::figures::study_figures;
use prone_report::report::{Folder, Line, PublishedRun, ReportError, Run, chains};

/// A pull whose last row is nearer to its end than this is whole, percent of the phase.
const END: f64 = 1e-6;

/// What a reproduction says beside its figures.
struct StudyRun {
    info: RunInfo,
    summary: Summary,
}

/// Reads a reproduction; figures 25, 26, 34 and 36 to 45 are drawn from its tables.
pub(crate) fn read(folder: &Folder) -> Result<Run, ReportError> {
    let info: RunInfo = folder.run()?;
    let mut cuts = Vec::new();
    let gaits = info.options.gaits.iter();
    let gaits: Vec<&str> = gaits.map(|gait| gait.name.as_str()).collect();
    let chains = chains::read(folder, Some(&gaits), &mut cuts)?;
    let mut pulls = Vec::new();
    for gait in &gaits {
        for &duration_s in &info.options.durations_s {
            pulls.push(pull(folder, gait, duration_s, &mut cuts)?);
        }
    }
    let costs = costs(folder, pulls.len(), &mut cuts)?;
    let drawings = study_figures(&published::FIGURES, &chains, &pulls, &costs);
    let (robot, facts) = (info.robot.name.clone(), sections::study_facts(&info));
    let summary = folder.json("summary.json")?;
    let mut run = Run::published(folder, Box::new(StudyRun { info, summary }));
    run.drawings = folder.drawn(drawings)?;
    run.recorded = folder.figures()?;
    run.shortfalls = cuts;
    run.robot = Some(robot);
    run.facts = facts;
    Ok(run)
}

impl PublishedRun for StudyRun {
    fn title(&self) -> &'static str {
        "The Projected Profile crawl"
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
            (sections::squeeze(&self.summary))
            (sections::agreement(&self.summary))
            (sections::contacts(&self.summary, &numbers))
            (sections::stride(&self.summary, &numbers))
            (sections::clamps(&self.summary, &numbers, family))
            (sections::mappings(&self.summary, &numbers))
            (sections::differences(&numbers, family))
        }
    }
}

fn pull(
    folder: &Folder,
    gait: &str,
    duration_s: f64,
    cuts: &mut Vec<String>,
) -> Result<PullRecord, ReportError> {
    let mut pull = PullRecord {
        gait: gait.to_owned(),
        duration_s,
        rows: Vec::new(),
    };
    let table = folder.table(&format!("torques/{}", torque_file_name(&pull)))?;
    let [time, percent] = table.columns(["time_s", "cycle_percent"])?;
    let torques = table.columns(JOINTS.map(|joint| format!("{joint}_nm")))?;
    let ([ankle, knee, hip, shoulder], [roll, upper, lower]) = (JOINTS, ARM_JOINTS);
    let joints = [ankle, knee, hip, shoulder, roll, upper, lower];
    let commands = table.columns(joints.map(|joint| format!("{joint}_cmd_rad")))?;
    let angles = table.columns(joints.map(|joint| format!("{joint}_rad")))?;
    let contacts = table.columns(["toe_n", "elbow_n", "torso_n", "leg_n"])?;
    let [top, head_top, squeeze] = table.columns(["top_mm", "head_top_mm", "squeeze_n"])?;
    let mut before = 0.0;
    let read = |line: &Line<'_>| {
        let row = PullRow {
            time_s: line.number(time)?,
            cycle_percent: line.number(percent)?,
            torque_nm: line.numbers(torques)?,
            command_rad: line.numbers(commands)?,
            angle_rad: line.numbers(angles)?,
            contact_n: line.numbers(contacts)?,
            top_mm: line.number(top)?,
            head_top_mm: line.number(head_top)?,
            squeeze_n: line.number(squeeze)?,
        };
        let forward = row.time_s > before;
        before = row.time_s;
        forward.then_some(row)
    };
    pull.rows = table.all_rows(cuts, read, |rows| {
        rows.last()
            .is_some_and(|last| last.cycle_percent >= 100.0 - END)
    });
    Ok(pull)
}

fn costs(
    folder: &Folder,
    expected: usize,
    cuts: &mut Vec<String>,
) -> Result<Vec<CostRecord>, ReportError> {
    let table = folder.table("costs.csv")?;
    let [gait, duration, cost, published] =
        table.columns(["gait", "duration_s", "cost_n2m2s", "published_n2m2s"])?;
    let read = |line: &Line<'_>| {
        Some(CostRecord {
            gait: line.text(gait).to_owned(),
            duration_s: line.number(duration)?,
            cost_n2m2s: line.number(cost)?,
            published_n2m2s: line.optional(published).ok()?,
        })
    };
    Ok(table.all_rows(cuts, read, |costs| costs.len() >= expected))
}
