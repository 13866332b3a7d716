//! Which commands read a file of each format, and what a run of them must not leave behind.

use std::fs;
use std::io;
use std::path::Path;

use crate::format::Format;
use crate::program::{self, Ended};
use crate::seeds::Bed;

/// A search that is done in a moment, and goes on from its own state.
const SEARCH: &str = "optimize --objective torque --source statics --duration 1 --seed 1 --budget 40 --confirm-durations 1 --out search --resume";

/// The commands of a format; paths are those of a bed, and what is written goes to `out`.
const fn commands(format: Format) -> &'static [&'static str] {
    match format {
        Format::RobotXml | Format::RobotToml => &[
            "robot check robot",
            "robot check robot",
            "robot compile robot --out out/robot.json",
            "cost optimal --objective heat --source statics --robot robot",
            "crawl run thesis-nominal --cycles 1 --robot robot",
        ],
        Format::Family => &["robot check family"],
        Format::Pull => &[
            "gait show pull.toml",
            "gait show pull.toml --csv out/gait.csv",
            "cost pull.toml --objective heat --source statics",
        ],
        Format::Cycle => &["gait show cycle.toml", "crawl run cycle.toml --cycles 1"],
        Format::Scene => &["crawl run thesis-nominal --cycles 1 --scene scene.toml"],
        Format::TorqueMap => &[
            "torque-map compare map.csv map.csv",
            "torque-map plot map.csv --out out/plots",
            "cost optimal --objective torque --source map.csv",
        ],
        Format::CompiledRobot => &[
            "export record --format urdf --out out/robot.urdf",
            "view record --out out/view.html",
        ],
        Format::Rows | Format::Contacts | Format::Run | Format::Model => &[
            "view record --out out/view.html",
            "export record --format csv --out out/table.csv",
            "export record --format urdf --out out/robot.urdf",
            "report record --out out/report.html",
        ],
        Format::Summary => &["report record --out out/report.html"],
        Format::SearchResult | Format::History => &["report search --out out/report.html"],
        Format::Checkpoint => &[SEARCH],
    }
}

/// Runs the program on the mutant that lies in a bed, by the command that belongs to a number.
///
/// # Errors
/// [`io::Error`] where it cannot be run.
pub fn run(
    program: &Path,
    bed: &Bed,
    format: Format,
    seed: u64,
) -> io::Result<(Ended, Option<String>)> {
    let commands = commands(format);
    // Not by the choices that made the mutant.
    let choice = usize::try_from(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 33).unwrap_or(0);
    let arguments: Vec<String> = commands[choice % commands.len()]
        .split(' ')
        .map(str::to_owned)
        .collect();
    let ended = program::run(program, &arguments, bed.path())?;
    let mut wrong = ended.wrong();
    let out = bed.path().join("out");
    // What is readable of a record that was cut off is shown, which is said, and the code is 2.
    let cut_off = [
        "what stands before",
        "are left",
        "are not there",
        "missing from here",
    ]
    .iter()
    .any(|word| ended.said.contains(word));
    let may_leave = ended.code == Some(0) || cut_off;
    if !may_leave && let Some(left) = fs::read_dir(&out)?.next() {
        let left = left?.file_name();
        wrong = wrong.or_else(|| Some(format!("failed, and left {}", left.display())));
    }
    fs::remove_dir_all(&out)?;
    fs::create_dir(&out)?;
    Ok((
        ended,
        wrong.map(|wrong| format!("{wrong} (prone {})", arguments.join(" "))),
    ))
}

/// The state that such a search of the program itself leaves.
///
/// # Errors
/// [`io::Error`] where the program leaves none.
pub fn state(program: &Path, bed: &Bed) -> io::Result<String> {
    fs::remove_dir_all(bed.path().join("search"))?;
    let words = SEARCH.split(' ').filter(|word| *word != "--resume");
    let arguments: Vec<String> = words.map(str::to_owned).collect();
    let ended = program::run(program, &arguments, bed.path())?;
    fs::read_to_string(bed.file(Format::Checkpoint))
        .map_err(|error| io::Error::new(error.kind(), ended.said))
}
