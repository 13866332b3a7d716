//! The loop around a crawler and a port.

use crate::port::{Command, JointCommand, Pace, PortError, Sense, Senses, Stop};

use super::crawler::Crawler;
use super::error::CrawlerError;
use super::pilot::Pilot;
use super::program::Halt;

/// Looks on while a crawler is driven.
pub trait Watch<D: ?Sized, P> {
    /// Before each tick: whether the crawl is to stop.
    fn before(&mut self, port: &D, crawler: &Crawler<P>, senses: &Senses) -> Option<Halt>;

    /// After each tick, before its command is carried out.
    fn ticked(&mut self, port: &D, crawler: &Crawler<P>, command: &JointCommand);

    /// When the time of a tick has gone by.
    fn waited(&mut self, port: &D, crawler: &Crawler<P>);
}

/// Why a crawl did not come to its end.
#[derive(Debug, thiserror::Error)]
pub enum DriveError {
    /// The crawl itself cannot go on.
    #[error(transparent)]
    Crawler(#[from] CrawlerError),
    /// The crawler counts in other ticks than the port waits for.
    #[error("the crawler counts in ticks of {crawler_s} s, the port in ticks of {port_s} s")]
    Tick {
        /// Of [`Crawler::timing`], s.
        crawler_s: f64,
        /// Of [`Pace::tick`], s.
        port_s: f64,
    },
    /// The port failed.
    #[error("cycle {cycle} ({gait}): {source}")]
    Port {
        /// From 1.
        cycle: usize,
        /// The cycle's name.
        gait: String,
        /// What happened.
        source: PortError,
    },
}

/// Share of a tick by which two are still the same.
const SAME_TICK: f64 = 1e-9;

/// Crawls to the end, one tick of the port after the other.
///
/// On an error the port is stopped, as far as it still can be; the first error is returned. A port of
/// other ticks than the crawler's is an error before anything moves.
pub fn drive<D, P>(
    port: &mut D,
    crawler: &mut Crawler<P>,
    watch: &mut impl Watch<D, P>,
) -> Result<(), DriveError>
where
    D: Sense + Command + Pace + Stop + ?Sized,
    P: Pilot,
{
    let (port_s, crawler_s) = (port.tick(), crawler.timing().tick());
    let driven = if (port_s - crawler_s).abs() <= SAME_TICK * crawler_s {
        follow(port, crawler, watch)
    } else {
        Err(DriveError::Tick { crawler_s, port_s })
    };
    if driven.is_err() {
        // The error that is returned says more than one of stopping could.
        let _ = port.stop();
    }
    driven
}

fn follow<D, P>(
    port: &mut D,
    crawler: &mut Crawler<P>,
    watch: &mut impl Watch<D, P>,
) -> Result<(), DriveError>
where
    D: Sense + Command + Pace + Stop + ?Sized,
    P: Pilot,
{
    loop {
        let senses = port.sense().map_err(|source| at(crawler, source))?;
        if let Some(halt) = watch.before(port, crawler, &senses) {
            crawler.stop(halt);
        }
        let command = crawler.tick(&senses)?;
        watch.ticked(port, crawler, &command);
        port.command(&command)
            .map_err(|source| at(crawler, source))?;
        if crawler.ended().is_some() {
            return Ok(());
        }
        port.wait().map_err(|source| at(crawler, source))?;
        watch.waited(port, crawler);
    }
}

fn at<P: Pilot>(crawler: &Crawler<P>, source: PortError) -> DriveError {
    let (cycle, gait) = crawler.at();
    DriveError::Port {
        cycle,
        gait,
        source,
    }
}
