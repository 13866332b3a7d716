//! The replay within a report: the page of `prone view` in a frame that can reach nothing.

use maud::{Markup, html};

use super::{ReportError, Run};
use crate::view;

/// How many runs one replay shows.
const SIDE_BY_SIDE: usize = 2;

/// The replay of a report.
pub(super) struct Replay {
    /// The frame.
    pub(super) frame: Markup,
    /// Folders that are in it, as they were named.
    pub(super) shown: Vec<String>,
    /// Folders of records that are not.
    pub(super) left_out: Vec<String>,
}

/// A record that can be replayed: its folder, as it was named, and its replay.
type Named<'a> = (&'a str, &'a view::record::Run);

impl Replay {
    /// As many records as `room` bytes of the page hold, two at most: of those that the user named or,
    /// without any, the pulls within a reproduction, which are one gait beside the other.
    pub(super) fn from_runs(runs: &[Run], room: usize) -> Result<Option<Self>, ReportError> {
        let records = runs.iter().filter_map(|run| {
            let record = run.record()?;
            let place = record.replay_place(run.folder.given);
            Some((place, (run.folder.name.as_str(), &record.replay)))
        });
        let mut records: Vec<(u8, Named<'_>)> = records.collect();
        // Stable: equals keep their order.
        records.sort_by_key(|(place, _)| *place);
        // One that was named is not put beside one that was not.
        let Some(&(first, _)) = records.first() else {
            return Ok(None);
        };
        let alike = records.partition_point(|(place, _)| *place == first);
        let records: Vec<Named<'_>> = records.into_iter().map(|(_, record)| record).collect();
        let mut count = SIDE_BY_SIDE.min(alike);
        let frame = loop {
            let frame = frame(&records[..count])?;
            if frame.0.len() <= room || count == 0 {
                break frame;
            }
            count -= 1;
        };
        let mut shown: Vec<String> = records.iter().map(|(name, _)| (*name).to_owned()).collect();
        let left_out = shown.split_off(count);
        Ok(Some(Self {
            frame,
            shown,
            left_out,
        }))
    }
}

/// Records side by side; nothing without any.
fn frame(records: &[Named<'_>]) -> Result<Markup, ReportError> {
    if records.is_empty() {
        return Ok(html! {});
    }
    let mut replays: Vec<view::record::Run> =
        records.iter().map(|(_, run)| (*run).clone()).collect();
    if let [first, second] = replays.as_mut_slice()
        && first.title() == second.title()
    {
        first.set_apart(records[0].0);
        second.set_apart(records[1].0);
    }
    let page = view::page(&replays.iter().collect::<Vec<_>>())?;
    let titles: Vec<&str> = replays.iter().map(view::record::Run::title).collect();
    Ok(html! {
        iframe.replay title={ "Replay: " (titles.join(" beside ")) } sandbox="allow-scripts"
            loading="lazy" srcdoc=(page) {}
    })
}
