//! What `prone view` may be given.

use std::path::PathBuf;

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  prone crawl run --gait low-175 --cycles 3 --record out/low
  prone view out/low --open               out/low.html, in the browser
  prone view out/low --compare out/table --out both.html

The page holds all it needs: it loads nothing, works without a network, and can be sent to others.
Press ? in it for its keys. #t=2.4&view=side behind its address opens it at an instant.")]
pub(crate) struct ViewArgs {
    /// A folder that `prone crawl run --record` wrote
    #[arg(value_name = "RUN")]
    pub(crate) run: PathBuf,
    /// A second run, side by side or as a ghost
    #[arg(long, value_name = "RUN")]
    pub(crate) compare: Option<PathBuf>,
    /// The page [default: RUN.html beside the folder]
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Open it in the browser
    #[arg(long)]
    pub(crate) open: bool,
}
