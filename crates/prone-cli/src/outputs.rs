//! What a command reads and what it writes, held against one another before the work begins: no
//! output replaces an input of the same command, under whatever name or link, and a place that takes
//! no file is found at once.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::anyhow;

use prone_files::gaits::Gaits;
use prone_files::robot_folder::RobotFiles;
use prone_record::output;
use prone_record::real_path::real_path;
use prone_record::single_file;

use crate::Failure;

/// What a command reads and writes.
#[derive(Debug, Default)]
pub(crate) struct Files {
    read: Vec<PathBuf>,
    output: Option<Output>,
}

/// An output, with the option that names it.
#[derive(Debug)]
struct Output {
    option: &'static str,
    path: PathBuf,
    kind: Kind,
}

/// What an output is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A file that is made in one go; a device or a pipe will do.
    Quick,
    /// A file that takes long to make, and is kept.
    Lasting,
    /// A folder that is replaced whole.
    Folder,
}

impl Files {
    /// A command that reads a robot; one that ships is no file.
    pub(crate) fn of_robot(robot: &RobotFiles) -> Self {
        Self {
            read: robot.read.clone(),
            output: None,
        }
    }

    /// It reads a file or a folder, too.
    pub(crate) fn reading(mut self, path: impl Into<PathBuf>) -> Self {
        self.read.push(path.into());
        self
    }

    /// It reads gaits by these names too, as far as they are files.
    pub(crate) fn reading_gaits<'a>(
        mut self,
        gaits: &Gaits,
        names: impl IntoIterator<Item = &'a String>,
    ) -> Self {
        let named = names.into_iter().map(|name| gaits.named(name));
        // One that cannot be read is refused where it is looked for.
        self.read
            .extend(named.filter_map(|named| named.ok()?.read.clone()));
        self
    }

    /// It writes where an option says.
    pub(crate) fn writing(mut self, option: &'static str, path: &Path, kind: Kind) -> Self {
        self.output = Some(Output {
            option,
            path: path.to_owned(),
            kind,
        });
        self
    }

    /// The same of an option that may be left out.
    pub(crate) fn maybe_writing(
        self,
        option: &'static str,
        path: Option<&PathBuf>,
        kind: Kind,
    ) -> Self {
        match path {
            Some(path) => self.writing(option, path, kind),
            None => self,
        }
    }

    /// Where it writes.
    pub(crate) fn output(&self) -> Option<&Path> {
        self.output.as_ref().map(|output| output.path.as_path())
    }

    /// Refuses an output that would replace what is read, or that has no place.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        let Some(Output { option, path, kind }) = &self.output else {
            return Ok(());
        };
        let shown = path.display();
        let read = match kind {
            Kind::Quick | Kind::Lasting => self.read_at(path),
            Kind::Folder => self.read_within(path),
        };
        if let Some(input) = read {
            let input = input.display();
            return Err(Failure::Input(anyhow!(
                "{option} {shown} would overwrite {input}, which was read"
            )));
        }
        match kind {
            Kind::Quick => single_file::check_output(path).map_err(Failure::input),
            Kind::Lasting => single_file::check_place(path).map_err(Failure::input),
            Kind::Folder => output::check(path).map_err(Failure::input),
        }
    }

    /// The same of a command whose results are made anew in a moment: it replaces none of another
    /// command, which may have taken hours.
    pub(crate) fn check_made_by(&self, command: &str) -> Result<(), Failure> {
        self.check()?;
        let folder = self.output.as_ref();
        let folder = folder.filter(|output| output.kind == Kind::Folder);
        let Some(Output { option, path, .. }) = folder else {
            return Ok(());
        };
        match output::command_of(path) {
            Some(other) if other != command => Err(Failure::Input(anyhow!(
                "{option} {} is a result of `prone {other}`, which this command does not replace",
                path.display()
            ))),
            _ => Ok(()),
        }
    }

    /// The input that a file is, under whatever name, or that a link to it would make.
    fn read_at(&self, path: &Path) -> Option<&Path> {
        let read = self.read.iter().map(PathBuf::as_path);
        single_file::same_file(path, &self.read).or_else(|| {
            read.filter(|input| input.is_dir())
                .find(|input| lies_in(path, input))
        })
    }

    /// The first input in a folder, or the folder itself; a folder that is read as a whole has no other in
    /// it either.
    fn read_within(&self, folder: &Path) -> Option<&Path> {
        let mut read = self.read.iter().map(PathBuf::as_path);
        read.find(|input| lies_in(input, folder) || (input.is_dir() && lies_in(folder, input)))
    }
}

/// Whether a path leads into a folder, or to it.
fn lies_in(path: &Path, folder: &Path) -> bool {
    let real = |path: &Path| fs::canonicalize(path).or_else(|_| real_path(path));
    real(folder).is_ok_and(|folder| real(path).is_ok_and(|path| path.starts_with(folder)))
}
