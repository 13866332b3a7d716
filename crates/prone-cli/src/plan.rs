//! What was typed, once it is checked: something that can be run, and how.

use std::path::PathBuf;

use prone_record::experiment::Experiment;
use prone_record::resumption::Opening;
use prone_thesis::reproduce::ReproduceExperiment;

/// What is run, and how it is shown.
pub(crate) struct Plan {
    pub(crate) work: Work,
    /// Where the result goes.
    pub(crate) out: Option<PathBuf>,
    /// What becomes of unfinished work beside it.
    pub(crate) opening: Opening,
    pub(crate) threads: Option<u16>,
    pub(crate) json: bool,
    /// What a crawl that touches an obstacle is.
    pub(crate) on_contact: OnContact,
}

/// What a crawl is that touches a plate, a leg of one or a panel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum OnContact {
    /// A result like others.
    Report,
    /// A failure of the work; its record is written all the same.
    Fail,
}

/// Something that can be run.
pub(crate) enum Work {
    Study(Experiment),
    Reproduction(Box<ReproduceExperiment>),
}

/// What a search does with an earlier one.
pub(crate) const fn searching(resume: bool) -> Opening {
    if resume {
        Opening::Resume
    } else {
        Opening::Restart
    }
}
