//! Reading the records of crawls and pulls.

use serde::Deserialize;

use super::ReportError;
use super::folder::Folder;
use super::publication::Publication;
use crate::figures::{AngleRecord, AngleRow, Figure, crawl_angles};
use crate::view;
use prone_record::crawl_summary::CrawlSummary;
use prone_record::figure_entry::FigureEntry;
use prone_record::recorded::{Command, MODEL_FILE, Part, Recorded};

/// What a pull of a reproduction left behind: it can be replayed.
pub(super) struct PullRun {
    pub(super) folder: Folder,
    pub(super) replay: view::record::Run,
    /// What is missing, one sentence each.
    pub(super) notes: Vec<String>,
}

impl PullRun {
    pub(super) fn read(folder: Folder) -> Result<Self, ReportError> {
        let record = Recorded::read(&folder.path)?;
        Ok(Self {
            notes: notes(&folder, &record),
            replay: view::record::of(&record),
            folder,
        })
    }
}

/// What a crawl left behind.
pub(super) struct CrawlRun {
    pub(super) folder: Folder,
    pub(super) summary: CrawlSummary,
    /// How high the robot stands, mm, where the record says so.
    pub(super) standing_height_mm: Option<f64>,
    pub(super) angles: AngleRecord,
    pub(super) recorded: Vec<FigureEntry>,
    /// For the page's replay.
    pub(super) replay: view::record::Run,
    /// What is missing, one sentence each.
    pub(super) notes: Vec<String>,
}

#[derive(Deserialize)]
struct Model {
    chain: Chain,
}

#[derive(Deserialize)]
struct Chain {
    left: Side,
}

#[derive(Deserialize)]
struct Side {
    ankle: String,
    knee: String,
    hip: String,
    shoulder: String,
    shoulder_roll: String,
    forearm: [String; 2],
}

impl CrawlRun {
    pub(super) fn read(folder: Folder) -> Result<Self, ReportError> {
        let record = Recorded::read(&folder.path)?;
        let side = Model::deserialize(&record.model)
            .map_err(|source| ReportError::Json {
                file: folder.path.join(MODEL_FILE),
                source,
            })?
            .chain
            .left;
        let summary: CrawlSummary = folder.json("summary.json")?;
        // The crawl of a reproduction has its pictures beside those of the pulls.
        let recorded = match record.run.command {
            Command::Crawl => folder.figures()?,
            Command::ReproducePull | Command::ReproduceCrawl => Vec::new(),
        };
        Ok(Self {
            standing_height_mm: folder
                .run
                .pointer("/robot/standing_height_mm")
                .and_then(serde_json::Value::as_f64),
            angles: angles(&summary, &record, side),
            notes: notes(&folder, &record),
            replay: view::record::of(&record),
            recorded,
            summary,
            folder,
        })
    }

    /// Figure 31, drawn from the rows.
    pub(super) fn drawing(
        &self,
        publication: &dyn Publication,
    ) -> Result<Option<Figure>, ReportError> {
        crawl_angles(&self.angles, &|joint| publication.joint_range(joint)).map_err(|source| {
            ReportError::Figure {
                run: self.folder.name.clone(),
                source,
            }
        })
    }
}

fn notes(folder: &Folder, record: &Recorded) -> Vec<String> {
    let missing = record.shortfalls(&[Part::Rows, Part::Contacts]);
    let named = missing.iter().map(|note| format!("{}/{note}", folder.name));
    named.collect()
}

/// The first cycles of the left chain.
fn angles(summary: &CrawlSummary, record: &Recorded, side: Side) -> AngleRecord {
    let [upper, lower] = side.forearm;
    let wanted = [
        side.ankle,
        side.knee,
        side.hip,
        side.shoulder,
        side.shoulder_roll,
        upper,
        lower,
    ];
    let place = |joint: &String| record.joints.iter().position(|known| known == joint);
    let places: Vec<usize> = wanted.iter().filter_map(place).collect();
    let rows = record
        .rows
        .iter()
        .filter(|row| row.cycle <= AngleRecord::CYCLES);
    let pick = |angles: &[f64]| places.iter().map(|&place| angles[place]).collect();
    let rows: Vec<AngleRow> = rows
        .map(|row| AngleRow {
            time_s: row.time_s,
            command_rad: pick(row.command.as_slice()),
            angle_rad: pick(row.angles.as_slice()),
        })
        .collect();
    let last = record.rows.last().map_or(0, |row| row.cycle);
    AngleRecord {
        gait: summary.gait.clone(),
        joints: places
            .iter()
            .map(|&place| record.joints[place].clone())
            .collect(),
        rows,
        cycles: AngleRecord::CYCLES.min(last),
    }
}
