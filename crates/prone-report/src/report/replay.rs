//! The replay within a report: the page of `prone view` in a frame that can reach nothing.

use maud::{Markup, html};

use super::folder::Given;
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

/// A record that can be replayed.
struct Record<'a> {
    name: &'a str,
    run: &'a view::record::Run,
}

/// As many records as `room` bytes of the page hold, two at most: of those that the user named or,
/// without any, the pulls within a reproduction, which are one gait beside the other.
pub(super) fn of(runs: &[Run], room: usize) -> Result<Option<Replay>, ReportError> {
    fn record(run: &Run) -> Option<(u8, Record<'_>)> {
        let (folder, replay, within) = match run {
            Run::Crawl(crawl) => (&crawl.folder, &crawl.replay, 2),
            Run::Pull(pull) => (&pull.folder, &pull.replay, 1),
            Run::Published(..) | Run::Search(_) | Run::Drawn(_) => return None,
        };
        let place = match folder.given {
            Given::Named => 0,
            Given::Within => within,
        };
        let name = &folder.name;
        Some((place, Record { name, run: replay }))
    }
    let mut records: Vec<(u8, Record<'_>)> = runs.iter().filter_map(record).collect();
    // Stable: equals keep their order.
    records.sort_by_key(|(place, _)| *place);
    // One that was named is not put beside one that was not.
    let first = records.first().map(|(place, _)| *place);
    let alike = records
        .iter()
        .take_while(|(place, _)| Some(*place) == first)
        .count();
    let records: Vec<Record<'_>> = records.into_iter().map(|(_, record)| record).collect();
    if records.is_empty() {
        return Ok(None);
    }
    let names = |records: &[Record<'_>]| -> Vec<String> {
        records
            .iter()
            .map(|record| record.name.to_owned())
            .collect()
    };
    for count in (0..=SIDE_BY_SIDE.min(alike)).rev() {
        let (shown, left_out) = records.split_at(count);
        let frame = if shown.is_empty() {
            html! {}
        } else {
            frame(shown)?
        };
        if frame.0.len() <= room || count == 0 {
            return Ok(Some(Replay {
                frame,
                shown: names(shown),
                left_out: names(left_out),
            }));
        }
    }
    Ok(None)
}

fn frame(records: &[Record<'_>]) -> Result<Markup, ReportError> {
    let mut replays: Vec<view::record::Run> =
        records.iter().map(|record| record.run.clone()).collect();
    if let [first, second] = replays.as_mut_slice()
        && first.title() == second.title()
    {
        first.set_apart(records[0].name);
        second.set_apart(records[1].name);
    }
    let page = view::page(&replays.iter().collect::<Vec<_>>()).map_err(ReportError::Encode)?;
    let titles: Vec<&str> = replays.iter().map(view::record::Run::title).collect();
    Ok(html! {
        iframe.replay title={ "Replay: " (titles.join(" beside ")) } sandbox="allow-scripts"
            loading="lazy" srcdoc=(page) {}
    })
}
