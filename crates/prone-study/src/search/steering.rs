//! Whether a found cycle can be steered.

use std::cmp::Ordering;

use prone::gait::cycle::Cycle;
use prone_record::frontier::SettingKind;
use prone_sim::crawl::CrawlError;

use super::setting::{Role, Setting};
use super::trial::try_out_unless;

/// Why a cycle cannot be steered.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NotSteered {
    /// Something else turns it more.
    #[error(
        "its largest turn command turns it by {:.2}° a cycle, and uneven ground and joints that are \
         off by {:.2}°",
        turned.to_degrees(), thrown_off.to_degrees()
    )]
    ThrownOff {
        /// By the largest command, rad, positive to the left, as the command is.
        turned: f64,
        /// By what throws it off, rad, to whichever side.
        thrown_off: f64,
    },
    /// More of the command turns it less.
    #[error(
        "half its largest turn command turns it by {:.2}° a cycle, and all of it by {:.2}°",
        half.to_degrees(), whole.to_degrees()
    )]
    Folds {
        /// By half of the largest command, rad, positive to the left, as the command is.
        half: f64,
        /// By the largest command, rad.
        whole: f64,
    },
    /// It cannot be crawled in a setting.
    #[error("{setting}: {source}")]
    Crawl {
        /// Which.
        setting: SettingKind,
        /// Why.
        source: CrawlError,
    },
}

/// Finds out whether a cycle can be steered: its largest command turns it by more than uneven ground
/// and joints that are off do, in the settings of
/// [`super::settings::for_steering_confirmation`]. A cycle that was searched for something else has
/// the steering of the one that it was searched about, which may do nothing in it, or turn it the
/// wrong way.
pub fn check_steering(settings: &[Setting], cycle: &Cycle) -> Result<(), NotSteered> {
    check_steering_unless(&|| false, settings, cycle)
}

/// The same, ended at once where `stopped` says so: with [`CrawlError::Stopped`], or with whatever has
/// come of it by then.
pub fn check_steering_unless(
    stopped: &dyn Fn() -> bool,
    settings: &[Setting],
    cycle: &Cycle,
) -> Result<(), NotSteered> {
    // Not a number steers nothing, and throws a robot off as far as can be.
    let further = |one: f64, other: f64| match one.total_cmp(&other.abs()) {
        Ordering::Less => other.abs(),
        _ => one,
    };
    let (mut turned, mut thrown_off) = (f64::NEG_INFINITY, 0.0_f64);
    for setting in settings {
        let trial =
            try_out_unless(stopped, setting, cycle).map_err(|source| NotSteered::Crawl {
                setting: setting.spec.kind,
                source,
            })?;
        match setting.spec.role {
            Role::Turn(_) => {
                if trial.yaw < turned {
                    return Err(NotSteered::Folds {
                        half: turned,
                        whole: trial.yaw,
                    });
                }
                turned = trial.yaw;
            }
            Role::Value | Role::Keep(_) | Role::Beside => {
                thrown_off = further(thrown_off, trial.yaw);
            }
        }
    }
    if turned > thrown_off {
        return Ok(());
    }
    Err(NotSteered::ThrownOff { turned, thrown_off })
}
