//! `prone view`: a recorded run as a page that replays it.

use std::ffi::OsString;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::anyhow;

use prone_record::output;
use prone_record::recorded;
use prone_record::single_file;
use prone_report::view::{self, record};

use crate::args::ViewArgs;
use crate::outputs::{Files, Kind};
use crate::printed;
use crate::{Failure, interrupt, record_folder};

/// What opens a page in the browser of the user's choice.
const OPENER: &str = if cfg!(target_os = "macos") {
    "open"
} else {
    "xdg-open"
};

pub(crate) fn run(args: &ViewArgs) -> Result<(), Failure> {
    let mut runs = Vec::new();
    let folders: Vec<&Path> = [Some(&args.run), args.compare.as_ref()]
        .into_iter()
        .flatten()
        .map(PathBuf::as_path)
        .collect();
    for folder in &folders {
        let run = record::read(folder).map_err(Failure::input)?;
        runs.push(run);
    }
    if let [first, second] = runs.as_mut_slice()
        && first.title() == second.title()
    {
        first.set_apart(&folders[0].display().to_string());
        second.set_apart(&folders[1].display().to_string());
    }
    let out = match &args.out {
        Some(out) => out.clone(),
        None => beside(&args.run)?,
    };
    for folder in &folders {
        record_folder::check_place(&out, folder)?;
    }
    let read = folders.iter().flat_map(|folder| {
        let files = recorded::FILES.map(|file| folder.join(file));
        files.into_iter().chain([folder.join(output::RUN_FILE)])
    });
    let read = read.fold(Files::default(), Files::reading);
    read.writing("--out", &out, Kind::Quick).check()?;
    let page = view::page(&runs.iter().collect::<Vec<_>>()).map_err(Failure::work)?;
    interrupt::publish(|| Ok(single_file::write(&out, page.as_bytes())?))?;
    if args.open {
        open(&out)?;
    }
    writeln!(
        printed::out(),
        "{}: {} rows, {:.2} MB",
        out.display(),
        runs.iter().map(record::Run::rows).sum::<usize>(),
        page.len() as f64 / 1e6
    )?;
    for (folder, run) in folders.iter().zip(&runs) {
        for gap in run.gaps() {
            writeln!(printed::out(), "{}: {gap}", folder.display())?;
        }
    }
    let notes = runs.iter().map(|run| run.shortfalls().to_vec());
    let records: Vec<_> = folders.into_iter().zip(notes).collect();
    record_folder::say_incomplete(&records)
}

/// `RUN.html` beside the result folder, which is replaced whole, so that nothing is put into it; of a
/// record in another result, `RESULT-RUN.html`.
fn beside(folder: &Path) -> Result<PathBuf, Failure> {
    let result = record_folder::result(folder)?;
    let real = fs::canonicalize(folder);
    let real = real.map_err(|error| Failure::Input(anyhow!("{}: {error}", folder.display())))?;
    let (Some(name), Some(run)) = (result.file_name(), real.file_name()) else {
        return Err(Failure::Input(anyhow!("{} has no name", folder.display())));
    };
    if result != real {
        let mut file = name.to_owned();
        file.push("-");
        file.push(run);
        file.push(".html");
        return Ok(result.with_file_name(file));
    }
    let mut file = OsString::from(run);
    file.push(".html");
    // As the user named it, where it has a name in that.
    let named = folder.file_name().map_or(real.as_path(), |_| folder);
    Ok(named.with_file_name(file))
}

fn open(page: &Path) -> Result<(), Failure> {
    let name = page.display();
    let opened = Command::new(OPENER)
        .arg(page)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .map_err(|error| error.to_string())
        .and_then(|status| status.success().then_some(()).ok_or(status.to_string()));
    opened
        .map_err(|error| Failure::Work(anyhow!("{name} is written, but {OPENER} failed: {error}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_stands_beside_its_run() {
        let home = tempfile::tempdir().unwrap();
        let low = home.path().join("v1.2");
        fs::create_dir(&low).unwrap();
        let page = home.path().join("v1.2.html");
        assert_eq!(beside(&low).unwrap(), page);
        assert_eq!(beside(&low.join("")).unwrap(), page);
        let here = beside(Path::new(".")).unwrap();
        assert_eq!(here.extension().unwrap(), "html");
        // In a result that lists it, a page would be a stranger.
        let pull = low.join("pulls/nominal");
        fs::create_dir_all(&pull).unwrap();
        let list = r#"{"program": "prone", "artefacts": ["pulls/nominal/run.json", "run.json"]}"#;
        fs::write(low.join("run.json"), list).unwrap();
        let real = home.path().canonicalize().unwrap();
        assert_eq!(beside(&pull).unwrap(), real.join("v1.2-nominal.html"));
        assert!(record_folder::check_place(&low.join("pulls/a.html"), &pull).is_err());
        assert!(record_folder::check_place(&page, &pull).is_ok());
        // Whoever reads no record keeps out of results too.
        let outside = |file: &Path| record_folder::check_outside("--gait-out", file);
        assert!(outside(&low.join("run.json")).is_err());
        assert!(outside(&low.join("pulls/nominal/gait.toml")).is_err());
        assert!(outside(&home.path().join("gait.toml")).is_ok());
        // Nor is a record written over through a link from outside.
        let link = home.path().join("link.html");
        std::os::unix::fs::symlink(low.join("run.json"), &link).unwrap();
        assert!(record_folder::check_place(&link, &pull).is_err());
    }
}
