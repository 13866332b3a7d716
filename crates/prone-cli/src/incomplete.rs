//! What is said of a record of which something is missing, after what could be read is written.

use std::path::Path;

use anyhow::anyhow;

use crate::Failure;

/// Fails with what is missing of some records, if anything is.
pub(crate) fn say(records: &[(impl AsRef<Path>, Vec<String>)]) -> Result<(), Failure> {
    let sentences = records.iter().flat_map(|(folder, shortfalls)| {
        let folder = folder.as_ref().display();
        shortfalls
            .iter()
            .map(move |shortfall| format!("{folder}: {shortfall}"))
    });
    let sentences: Vec<String> = sentences.collect();
    if sentences.is_empty() {
        return Ok(());
    }
    Err(Failure::Input(anyhow!("{}", sentences.join("\n       "))))
}
