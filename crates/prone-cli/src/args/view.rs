//! What `prone view` may be given.

use std::path::PathBuf;

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  prone crawl run low-175 --cycles 3 --record out/low
  prone view out/low --open               out/low.html, in the browser
  prone crawl run thesis-nominal --cycles 3 --record out/nominal
  prone view out/low --compare out/nominal --out both.html
  prone reproduce
  prone view out/reproduce/pulls/nominal-5s --compare out/reproduce/pulls/optimal-5s

The page holds all it needs: it loads nothing, works without a network, and can be sent to others.
Of a record that was cut off it shows what is left; the exit code is then 2.
Press ? in it for its keys. #t=2.4&view=side behind its address opens it at an instant.")]
pub(crate) struct ViewArgs {
    /// A recorded run: a folder that `prone crawl run --record` wrote, or one of pulls/ and crawls/ in
    /// the result of `prone reproduce`
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
