//! `prone torque-map`: build, compare, plot.

pub(crate) mod build;
pub(crate) mod compare;
pub(crate) mod plot;

use std::path::Path;

use anyhow::anyhow;

use prone::torque_map::{RecordedMap, parse_recorded};
use prone_files::text_file;

use crate::Failure;

/// The largest map that is read; the largest that is built has 50 MB.
const LARGEST_MAP_BYTES: u64 = 64 << 20;

/// The text of a map's file.
pub(crate) fn text(path: &Path) -> Result<String, Failure> {
    text_file::read_at_most(path, LARGEST_MAP_BYTES)
        .map_err(|error| Failure::Input(anyhow!("cannot read {}: {error}", path.display())))
}

fn read(path: &Path) -> Result<RecordedMap, Failure> {
    parse_recorded(&text(path)?)
        .map_err(|error| Failure::Input(anyhow!("{}: {error}", path.display())))
}
