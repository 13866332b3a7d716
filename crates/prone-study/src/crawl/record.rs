//! The files of a record folder.

use prone_sim::crawl::Crawl;
use prone_sim::{LoadedRobot, World};

use super::run::{Conditions, CrawlRunInfo, GaitSource};
use super::summary::CrawlSummary;
use super::{frames, model, tables};
use crate::figures::{self, FigureError};
use crate::frames::FramesError;
use crate::output::{Artefacts, RUN_FILE};
use crate::reproduce::{PNG_SCALE, insert_figure, json};
use crate::run_info::Program;

/// Why a record has no files.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// A figure cannot be drawn.
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// The frames cannot be made.
    #[error(transparent)]
    Frames(#[from] FramesError),
    /// A table cannot be written.
    #[error("table: {0}")]
    Csv(#[from] csv::Error),
    /// A JSON file cannot be written.
    #[error("JSON: {0}")]
    Json(#[from] serde_json::Error),
}

/// Everything that was simulated, and under which conditions.
#[derive(Debug, Clone, Copy)]
pub struct Recording<'a> {
    /// The robot.
    pub robot: &'a LoadedRobot,
    /// Where it crawled.
    pub world: &'a World,
    /// With which cycle.
    pub gait: &'a GaitSource,
    /// Under which conditions.
    pub conditions: &'a Conditions,
    /// What was measured, with rows.
    pub crawl: &'a Crawl,
    /// The same in figures.
    pub summary: &'a CrawlSummary,
}

/// Makes every file but `timing.json`; all the same for the same input. Pictures are taken on the
/// current rayon pool.
///
/// # Errors
/// [`RecordError`].
pub fn files(recording: &Recording<'_>, program: &Program) -> Result<Artefacts, RecordError> {
    let Recording {
        robot,
        world,
        gait,
        conditions,
        crawl,
        summary,
    } = *recording;
    let mut artefacts = Artefacts::new();
    let info = CrawlRunInfo::of(robot, world, gait, conditions, program);
    artefacts.insert(RUN_FILE.into(), json(&info)?);
    artefacts.insert("summary.json".into(), json(summary)?);
    artefacts.insert("model.json".into(), json(&model::of(world))?);
    artefacts.insert("cycles.csv".into(), tables::cycles(summary)?);
    artefacts.insert("rows.csv".into(), tables::rows(world.robot(), crawl)?);
    artefacts.insert("contacts.csv".into(), tables::contacts(world, crawl)?);
    artefacts.insert(
        "plate-contacts.csv".into(),
        tables::plate_contacts(summary)?,
    );
    if let Some(frames) = frames::sequence(world, &summary.gait, crawl)? {
        insert_figure(&mut artefacts, frames.figure, frames.png);
    }
    if let Some(figure) = figures::crawl_angles(world.robot(), &summary.gait, crawl)? {
        let png = figure.png(PNG_SCALE)?;
        insert_figure(&mut artefacts, figure, png);
    }
    Ok(artefacts)
}
