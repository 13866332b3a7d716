//! A bag of rosbag2: a folder with a log and its description, which appears whole or not at all.
//!
//! Beside them lies the `run.json` of every result folder of prone: by it a later export knows the bag
//! for one that may be replaced. Readers of bags look at what `metadata.yaml` names alone.

use std::path::Path;

use anyhow::anyhow;
use serde::Serialize;

use prone_record::head::Head;
use prone_record::output::{self, Artefacts, RUN_FILE};
use prone_record::program::RobotInfo;
use prone_record::recorded::Recorded;
use prone_report::export::ros_log::RosLog;
use prone_report::export::ros_log::bag::{METADATA_FILE, log_name};

use crate::{Failure, interrupt, program, record_folder};

/// The command that makes bags.
const COMMAND: &str = "export bag";

#[derive(Serialize)]
struct RunFile<'a> {
    #[serde(flatten)]
    head: Head<&'static str>,
    robot: &'a RobotInfo,
    gait: &'a str,
    scene: &'a str,
}

/// Refuses a folder in the record or the result that it is part of, and one in which something else
/// stands than an earlier bag.
pub(super) fn check_place(out: &Path, run: &Path) -> Result<(), Failure> {
    output::check(out).map_err(Failure::input)?;
    if is_occupied(out) && !Head::read(out).is_ok_and(|(head, _)| head.command == COMMAND) {
        return Err(Failure::Input(anyhow!(
            "{} is not an earlier bag, so it is not replaced",
            out.display()
        )));
    }
    record_folder::check_folder_place(out, run)
}

fn is_occupied(out: &Path) -> bool {
    out.read_dir()
        .is_ok_and(|mut entries| entries.next().is_some())
}

/// Puts the bag in place.
pub(super) fn put(out: &Path, record: &Recorded, log: RosLog) -> Result<(), Failure> {
    // What a link is called is not what it leads to: the bag has the name that was asked for.
    let folder = out.file_name().unwrap_or_default().to_string_lossy();
    let log_name = log_name(&folder);
    let run = &record.run;
    let run_file = RunFile {
        head: Head::new(&program(), COMMAND, None),
        robot: &run.robot,
        gait: &run.gait.name,
        scene: &run.scene.name,
    };
    let run_file = output::json(&run_file).map_err(Failure::work)?;
    let artefacts = Artefacts::from([
        (
            METADATA_FILE.to_owned(),
            log.metadata(&log_name).into_bytes(),
        ),
        (log_name, log.bytes),
        (RUN_FILE.to_owned(), run_file),
    ]);
    interrupt::publish(|| output::publish(out, &artefacts).map_err(Failure::work))
}
