//! Records shown: figures, the report, the replay, and logs that other tools open. Nothing here
//! computes physics, and no physics engine is linked.
//!
//! [`figures`] draws, [`report`] puts result folders together as one page, [`view`] replays, and
//! [`export`] writes other formats. A [`report::Publication`] is what all of it may be held
//! against.

pub mod export;
pub mod figure_list;
pub mod figures;
pub mod markup;
mod page_head;
pub mod report;
pub mod view;
