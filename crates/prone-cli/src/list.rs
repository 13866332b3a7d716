//! `prone list`: all that can be named, and what came out where it was crawled.

use std::io::{Result, Write};

use prone::foreign_text;
use prone_study::catalogue::{self, CatalogueError, CycleFigures, Listed, ListedKind, Origin};
use prone_study::run::{RunError, Session};

use crate::args::list::{KindName, ListArgs};
use crate::cells::number;
use crate::printed;
use crate::progress::Progress;
use crate::{Failure, interrupt, program};

/// Most columns of a line.
const COLUMNS: usize = 100;
/// What stands before a name of the robot's own.
const OWN: &str = "*";

pub(crate) fn run(args: &ListArgs) -> std::result::Result<(), Failure> {
    let robot = crate::robot::files(args.robot.name())?;
    let named = args.robot.name().and_then(|name| name.to_str());
    let mut listed = catalogue::list(&robot, named).map_err(Failure::input)?;
    if let Some(kind) = args.kind {
        listed.retain(|it| it.kind == kind.listed());
    }
    if !args.quick {
        let session = Session {
            program: program(),
            threads: args.threads.map(usize::from),
            ..Session::default()
        };
        let progress = Progress::new()?;
        interrupt::work("this simulation", None);
        let measured = catalogue::measure(&mut listed, &robot, &session, &progress);
        progress.finish();
        measured.map_err(|error| match error {
            CatalogueError::Run(RunError::Stopped) => Failure::Stopped,
            CatalogueError::Run(error) => Failure::work(error),
            error => Failure::input(error),
        })?;
    }
    interrupt::ended();
    let mut out = printed::out();
    if args.json {
        let text = prone_record::output::json_text(&listed).map_err(Failure::work)?;
        writeln!(out, "{text}")?;
        return Ok(());
    }
    print(&listed, &mut out)?;
    Ok(())
}

impl KindName {
    const fn listed(self) -> ListedKind {
        match self {
            Self::Gaits => ListedKind::Gait,
            Self::Cycles => ListedKind::Cycle,
            Self::Scenes => ListedKind::Scene,
            Self::Robots => ListedKind::Robot,
        }
    }
}

/// A table of each kind, with a line for each name.
fn print(listed: &[Listed], out: &mut dyn Write) -> Result<()> {
    let name = listed.iter().map(|it| it.name.chars().count());
    let width = name.max().unwrap_or_default();
    let kinds = [
        (ListedKind::Gait, "gaits (a pull alone)"),
        (ListedKind::Cycle, "cycles"),
        (ListedKind::Scene, "scenes"),
        (ListedKind::Robot, "robots"),
    ];
    let mut before = "";
    for (kind, title) in kinds {
        let of_kind: Vec<&Listed> = listed.iter().filter(|it| it.kind == kind).collect();
        if of_kind.is_empty() {
            continue;
        }
        write!(out, "{before}{title}")?;
        before = "\n";
        if of_kind.iter().any(|it| it.figures.is_some()) {
            // A name's column begins after two signs, and the title has taken some of it.
            let left = (width + 2).saturating_sub(title.len());
            write!(
                out,
                "{:left$}{:>9}{:>6}{:>10}{:>7}{:>10}  {:<15}{:>8}{:>7}",
                "",
                "mm high",
                "wide",
                "mm/cycle",
                "mm/s",
                "heat s/m",
                "on a robot",
                "head N",
                "turns"
            )?;
        }
        writeln!(out)?;
        for it in of_kind {
            let line = line(it, width);
            writeln!(out, "{}", shortened(line.trim_end(), COLUMNS))?;
        }
    }
    Ok(())
}

fn line(it: &Listed, width: usize) -> String {
    let mark = match it.origin {
        Origin::Own => OWN,
        Origin::Shipped => "",
    };
    let said = match (&it.figures, &it.refused) {
        (Some(figures), _) => {
            let turns = it.cycle.is_some_and(|cycle| cycle.steers);
            row(figures, if turns { "yes" } else { "no" })
        }
        (None, Some(refused)) => format!("  cannot be used: {refused}"),
        (None, None) => format!("  {}", foreign_text::escaped(&it.description)),
    };
    format!("{mark:>2}{:<width$}{said}", it.name)
}

fn row(figures: &CycleFigures, turns: &str) -> String {
    let CycleFigures {
        height_mm,
        mm_per_cycle,
        mm_per_s,
        heat_per_metre_s,
        heat_per_second: _,
        width_mm,
        verdict,
        head_n,
    } = figures;
    let heat = number(*heat_per_metre_s, 0);
    let verdict = verdict.as_deref().unwrap_or("unknown");
    let wide = number(*width_mm, 0);
    format!(
        "{height_mm:>9.1}{wide:>6}{mm_per_cycle:>10.1}{mm_per_s:>7.1}{heat:>10}  {verdict:<15}{head_n:>8.1}{turns:>7}"
    )
}

/// A line of so many columns at most; of a longer one the end is left out, and that is shown.
fn shortened(line: &str, columns: usize) -> String {
    if line.chars().count() <= columns {
        return line.to_owned();
    }
    let kept: String = line.chars().take(columns - 1).collect();
    format!("{}…", kept.trim_end())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limit_a_line_is_cut_to_its_columns() {
        assert_eq!(shortened("übermäßig", 9), "übermäßig");
        assert_eq!(shortened("übermäßig", 8), "übermäß…");
        assert_eq!(shortened("to a word", 6), "to a…");
    }
}
