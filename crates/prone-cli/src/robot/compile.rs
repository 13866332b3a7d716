//! `prone robot compile`: a robot for programs that have no engine, and whether there is one already.

use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use anyhow::anyhow;
use serde_json::json;

use prone_files::compiled_robot::{self, CompiledRobot, CompiledRobotError};
use prone_files::text_file;
use prone_record::single_file;
use prone_sim::LoadedRobot;

use crate::args::RobotCompileArgs;
use crate::outputs::{Files, Kind};
use crate::printed;
use crate::{Failure, interrupt, robot};

pub(crate) fn run(args: &RobotCompileArgs) -> Result<(), Failure> {
    let loaded = robot::load(args.robot.name())?;
    let out = place(args, &loaded)?;
    let engine = prone_sim::engine_version();
    let compiled =
        CompiledRobot::new(loaded.robot(), loaded.files(), engine).map_err(|violation| {
            let folder = &loaded.files().folder;
            Failure::Input(anyhow!("{folder} cannot be compiled: {violation}"))
        })?;
    let text = compiled.text();
    interrupt::publish(|| Ok(single_file::write(&out, text.as_bytes())?))?;
    say(args, &out, &compiled)
}

/// The compiled robot beside the sources of a robot; nothing where there is none, or where there are
/// no files: the one that ships is fresh, and a test sees to that.
pub(crate) fn beside(loaded: &LoadedRobot) -> Option<Result<CompiledRobot, CompiledRobotError>> {
    let files = loaded.files();
    if files.read.is_empty() {
        return None;
    }
    match CompiledRobot::read_beside(files) {
        Err(CompiledRobotError::Read(error)) if error.source.kind() == ErrorKind::NotFound => None,
        read => Some(read),
    }
}

/// Where the file goes, which is none of those that were read, and no file of another kind. What is
/// broken in the place that is the compiled robot's own is written anew.
fn place(args: &RobotCompileArgs, loaded: &LoadedRobot) -> Result<PathBuf, Failure> {
    let files = loaded.files();
    let out = match &args.out {
        Some(out) => out.clone(),
        None if files.read.is_empty() => {
            let robot = &loaded.robot().name;
            return Err(Failure::Input(anyhow!(
                "the {robot} ships with prone and has no folder here: say where the file goes with --out"
            )));
        }
        None => Path::new(&files.folder).join(compiled_robot::FILE_NAME),
    };
    let read = Files::of_robot(files);
    read.writing("--out", &out, Kind::Quick).check()?;
    let own = Path::new(&files.folder).join(compiled_robot::FILE_NAME);
    let is_own = !files.read.is_empty() && single_file::same_file(&out, &[own]).is_some();
    if !is_own && is_of_another_kind(&out)? {
        return Err(Failure::Input(anyhow!(
            "{} is there already and is no compiled robot: it is not overwritten",
            out.display()
        )));
    }
    Ok(out)
}

/// Whether a regular file is there that is no compiled robot, of any version. A device or a pipe has
/// nothing to lose.
fn is_of_another_kind(path: &Path) -> Result<bool, Failure> {
    if !path.is_file() {
        return Ok(false);
    }
    let text = text_file::read(path).map_err(|error| {
        Failure::Input(anyhow!(
            "{} is there already and cannot be read, so that it is not overwritten: {error}",
            path.display()
        ))
    })?;
    Ok(!compiled_robot::is_compiled_robot(&text))
}

fn say(args: &RobotCompileArgs, file: &Path, compiled: &CompiledRobot) -> Result<(), Failure> {
    let mut out = printed::out();
    let (name, hash, engine) = (
        &compiled.robot().name,
        compiled.sources_hash(),
        compiled.engine(),
    );
    if args.json {
        let said = json!({
            "file": file,
            "robot": name,
            "family": compiled.version().map(|it| &it.family),
            "version": compiled.version().map(|it| &it.version),
            "sources_sha256": hash,
            "engine": engine,
        });
        let text = prone_record::output::json_text(&said).map_err(Failure::work)?;
        writeln!(out, "{text}")?;
    } else {
        writeln!(
            out,
            "{name}, compiled by {engine} from sources with the hash {hash}: {}",
            file.display()
        )?;
    }
    Ok(())
}
