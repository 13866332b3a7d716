//! Reading the records of crawls and pulls.

use serde::Deserialize;

use super::ReportError;
use super::folder::Folder;
use super::publication::Publication;
use crate::figures::{AngleRecord, AngleRow, Figure, crawl_angles};
use crate::view;
use prone_record::crawl_summary::CrawlSummary;
use prone_record::figure_entry::{FIGURES_FILE, FigureEntry};
use prone_record::origin::Origin;
use prone_record::record_info::RecordInfo;
use prone_record::recorded::{Command, MODEL_FILE, Recorded};

/// Figures of a crawl, in its record folder.
const SUMMARY_FILE: &str = "summary.json";

/// What a pull of a reproduction left behind: it can be replayed.
pub(super) struct PullRun {
    pub(super) folder: Folder,
    pub(super) info: RecordInfo,
    pub(super) replay: view::record::Run,
    /// What is missing, one sentence each.
    pub(super) notes: Vec<String>,
    /// What was never recorded, one sentence each.
    pub(super) gaps: Vec<String>,
}

impl PullRun {
    pub(super) fn read(folder: Folder) -> Result<Self, ReportError> {
        let record = Recorded::read(&folder.path)?;
        let replay = view::record::of(&record);
        Ok(Self {
            notes: named(&folder, replay.shortfalls()),
            gaps: named(&folder, replay.gaps()),
            replay,
            info: record.run,
            folder,
        })
    }
}

/// What a crawl left behind.
pub(super) struct CrawlRun {
    pub(super) folder: Folder,
    pub(super) info: RecordInfo,
    /// Figures of the crawl; only simulations are sure to have them.
    pub(super) summary: Option<CrawlSummary>,
    pub(super) angles: AngleRecord,
    pub(super) recorded: Vec<FigureEntry>,
    /// For the page's replay.
    pub(super) replay: view::record::Run,
    /// What is missing, one sentence each.
    pub(super) notes: Vec<String>,
    /// What was never recorded, one sentence each.
    pub(super) gaps: Vec<String>,
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

impl Side {
    /// Toe to elbow, then the joints that point the arm.
    fn joints(self) -> Vec<String> {
        let [upper, lower] = self.forearm;
        vec![
            self.ankle,
            self.knee,
            self.hip,
            self.shoulder,
            self.shoulder_roll,
            upper,
            lower,
        ]
    }
}

impl CrawlRun {
    pub(super) fn read(folder: Folder) -> Result<Self, ReportError> {
        let record = Recorded::read(&folder.path)?;
        let simulated = matches!(record.run.origin, Origin::Simulated(_));
        let chain = Model::deserialize(&record.model).map_err(|source| ReportError::Json {
            file: folder.path.join(MODEL_FILE),
            source,
        });
        // Whatever drove the robot may not know its chain, nor have summed anything up.
        let side = match chain {
            Ok(model) => Some(model.chain.left),
            Err(error) if simulated => return Err(error),
            Err(_) => None,
        };
        let has = |file: &str| simulated || folder.path.join(file).exists();
        let summary: Option<CrawlSummary> = has(SUMMARY_FILE)
            .then(|| folder.json(SUMMARY_FILE))
            .transpose()?;
        // The crawl of a reproduction has its pictures beside those of the pulls.
        let recorded = match record.run.head.command {
            Command::Crawl if has(FIGURES_FILE) => folder.figures()?,
            _ => Vec::new(),
        };
        let replay = view::record::of(&record);
        let mut gaps = named(&folder, replay.gaps());
        if summary.is_none() {
            let none = format!("no {SUMMARY_FILE}: there is no report card");
            gaps.extend(named(&folder, &[none]));
        }
        Ok(Self {
            angles: angles(&record, side),
            notes: named(&folder, replay.shortfalls()),
            gaps,
            replay,
            recorded,
            summary,
            info: record.run,
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

/// Sentences with the folder that they are about.
fn named(folder: &Folder, sentences: &[String]) -> Vec<String> {
    let named = sentences.iter();
    let named = named.map(|sentence| format!("{}/{sentence}", folder.name));
    named.collect()
}

/// The first cycles of the left chain: its joints whose angles and commands are known all along.
fn angles(record: &Recorded, side: Option<Side>) -> AngleRecord {
    let wanted: Vec<String> = side.map_or_else(Vec::new, Side::joints);
    let rows = || {
        let rows = record.rows.iter();
        rows.filter(|row| row.cycle <= AngleRecord::CYCLES)
    };
    let known = |place: &usize| {
        rows().all(|row| {
            let pair = [&row.command, &row.angles].map(|angles| angles.as_slice()[*place]);
            pair.iter().all(|angle| !angle.is_nan())
        })
    };
    let place = |joint: &String| record.joints.iter().position(|known| known == joint);
    let places: Vec<usize> = wanted.iter().filter_map(place).filter(known).collect();
    let pick = |angles: &[f64]| places.iter().map(|&place| angles[place]).collect();
    let rows = rows().map(|row| AngleRow {
        time_s: row.time_s,
        command_rad: pick(row.command.as_slice()),
        angle_rad: pick(row.angles.as_slice()),
    });
    let last = record.rows.last().map_or(0, |row| row.cycle);
    AngleRecord {
        gait: record.run.gait.name.clone(),
        joints: places
            .iter()
            .map(|&place| record.joints[place].clone())
            .collect(),
        // A figure without a panel is none.
        rows: if places.is_empty() {
            Vec::new()
        } else {
            rows.collect()
        },
        cycles: AngleRecord::CYCLES.min(last),
    }
}
