//! What was typed, once it is checked: something that can be run, and how.

use std::path::{Path, PathBuf};

use prone_record::experiment::Experiment;
use prone_record::resumption::{self, Opening};
use prone_thesis::reproduce::ReproduceExperiment;

use crate::outputs::Files;

/// What is run, and how it is shown.
pub(crate) struct Plan {
    pub(crate) work: Work,
    /// What is read, and where the result goes.
    pub(crate) files: Files,
    /// What becomes of unfinished work beside it.
    pub(crate) opening: Opening,
    pub(crate) threads: Option<u16>,
    pub(crate) json: bool,
    /// What a crawl that touches an obstacle is.
    pub(crate) on_contact: OnContact,
}

impl Plan {
    /// Where the result goes.
    pub(crate) fn out(&self) -> Option<&Path> {
        self.files.output()
    }

    /// Where unfinished work is kept, where it is.
    pub(crate) fn kept(&self) -> Option<(resumption::Work, PathBuf)> {
        let work = match &self.work {
            Work::Study(Experiment::PullSearch(_) | Experiment::CycleSearch(_)) => {
                resumption::Work::Search
            }
            Work::Study(Experiment::TorqueMap(_)) => resumption::Work::TorqueMap,
            _ => return None,
        };
        self.out().map(|out| (work, work.beside(out)))
    }
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

impl Work {
    /// What is finished where it is stopped, before it says more of itself.
    pub(crate) const fn step(&self) -> &'static str {
        match self {
            Self::Study(
                Experiment::Cost(_)
                | Experiment::CycleCost(_)
                | Experiment::PullSearch(_)
                | Experiment::CycleSearch(_),
            ) => "this evaluation",
            Self::Study(Experiment::TorqueMap(_)) => "this row",
            Self::Study(Experiment::Pull(_) | Experiment::Crawl(_) | Experiment::Passage(_))
            | Self::Reproduction(_) => "this simulation",
        }
    }
}

/// What a search does with an earlier one.
pub(crate) const fn searching(resume: bool) -> Opening {
    if resume {
        Opening::Resume
    } else {
        Opening::Restart
    }
}
