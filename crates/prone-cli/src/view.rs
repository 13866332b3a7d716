//! `prone view`: a recorded run as a page that replays it.

use std::ffi::OsString;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::anyhow;

use prone_study::recorded;
use prone_study::view::{self, record};

use crate::args::ViewArgs;
use crate::{Failure, incomplete, table_file};

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
    if out.is_dir() {
        return Err(Failure::Input(anyhow!(
            "--out {} is a folder: name a file in it",
            out.display()
        )));
    }
    check_place(&out, &folders)?;
    let page = view::page(&runs.iter().collect::<Vec<_>>()).map_err(Failure::work)?;
    let name = out.display();
    table_file::write(&out, page.as_bytes())
        .map_err(|error| Failure::Input(anyhow!("cannot write {name}: {error}")))?;
    if args.open {
        open(&out)?;
    }
    writeln!(
        std::io::stdout(),
        "{name}: {} rows, {:.2} MB",
        runs.iter().map(record::Run::rows).sum::<usize>(),
        page.len() as f64 / 1e6
    )?;
    let notes = runs.iter().map(|run| run.notes().to_vec());
    let records: Vec<_> = folders.into_iter().zip(notes).collect();
    incomplete::say(&records)
}

/// `RUN.html`: a result folder is replaced whole, so nothing is put into it.
fn beside(folder: &Path) -> Result<PathBuf, Failure> {
    let named = if folder.file_name().is_some() {
        folder.to_owned()
    } else {
        let real = fs::canonicalize(folder);
        real.map_err(|error| Failure::Input(anyhow!("{}: {error}", folder.display())))?
    };
    let Some(name) = named.file_name() else {
        return Err(Failure::Input(anyhow!("{} has no name", folder.display())));
    };
    let mut file = OsString::from(name);
    file.push(".html");
    Ok(named.with_file_name(file))
}

/// Refuses to write over what was read.
fn check_place(out: &Path, folders: &[&Path]) -> Result<(), Failure> {
    let files = folders
        .iter()
        .flat_map(|folder| recorded::FILES.map(|file| folder.join(file)));
    let inputs: Vec<PathBuf> = files.collect();
    match table_file::same_file(out, &inputs) {
        None => Ok(()),
        Some(input) => Err(Failure::Input(anyhow!(
            "--out {} would overwrite {}, which was read",
            out.display(),
            input.display()
        ))),
    }
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
        for (run, page) in [
            ("out/low", "out/low.html"),
            ("low/", "low.html"),
            ("v1.2", "v1.2.html"),
        ] {
            assert_eq!(beside(Path::new(run)).unwrap(), Path::new(page));
        }
        let here = beside(Path::new(".")).unwrap();
        assert_eq!(here.extension().unwrap(), "html");
    }
}
