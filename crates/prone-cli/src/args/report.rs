//! What `prone report` may be given.

use std::path::PathBuf;

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  prone reproduce
  prone crawl run low-175 --record out/low
  prone report out/low out/table --out out/report
  prone report out/low --out low.html     the page alone
  prone report out/low --json | jq .cards
  prone report out/reproduce out/low --chapter
                                          the published study's chapter, filled by these runs

It reads results of reproduce, crawl run --record, crawl frontier, optimize and torque-map plot, and
simulates nothing. The page loads nothing and works without JavaScript, but for the replay, which
shows the first two crawls. Your own runs come first, a reproduction behind them. With --chapter the
page is the published study's chapter: figures in its order, what is published of each, and an empty
place that names the command for each figure that no run has. Where a table breaks off, what stands
before it is shown, the page says so, and the exit code is 2.")]
pub(crate) struct ReportArgs {
    /// Result folders of this version of prone
    #[arg(value_name = "RUN", required = true)]
    pub(crate) runs: Vec<PathBuf>,
    /// Folder for page and figures, or a file that ends in .html for the page alone
    #[arg(long, value_name = "PATH", default_value = "out/report")]
    pub(crate) out: PathBuf,
    /// Arrange the page as the published study's chapter, with empty places for figures that no run has
    #[arg(long)]
    pub(crate) chapter: bool,
    /// Print what the page says as JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Worker threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
}
