//! What mutants are made of, and the folder that each of them lies in.
//!
//! Robots, gaits and scenes are those that ship. Of a record, a search and a torque map there are
//! short ones in `fuzz/beds`, which `fuzz/beds/renew.sh` makes.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use prone_files::shipped::{self, NAO, NAO_OF_THE_SCENE, NAO_V5};

use crate::format::Format;

/// Where the repository has them.
const BEDS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/beds");

/// Texts of each format, read once.
#[derive(Debug)]
pub struct Seeds {
    /// Where `fuzz/beds` is.
    beds: PathBuf,
}

/// A folder of its own with all that a mutant needs beside it: each format has its place in it.
#[derive(Debug)]
pub struct Bed {
    home: tempfile::TempDir,
}

impl Seeds {
    /// Those of this repository.
    pub fn of_repository() -> Self {
        Self {
            beds: PathBuf::from(BEDS),
        }
    }

    /// The seeds of a format.
    ///
    /// # Errors
    /// [`io::Error`] where one cannot be read.
    pub fn texts(&self, format: Format) -> io::Result<Vec<String>> {
        let robots = [NAO, NAO_V5, NAO_OF_THE_SCENE];
        let embedded =
            |texts: &mut dyn Iterator<Item = &str>| Ok(texts.map(str::to_owned).collect());
        match format {
            // Without the family, which a folder of its own has not.
            Format::RobotToml => Ok(robots.iter().map(|robot| alone(robot.toml)).collect()),
            Format::RobotXml => embedded(&mut robots.iter().map(|robot| robot.mjcf)),
            Format::CompiledRobot => embedded(&mut robots.iter().map(|robot| robot.compiled)),
            Format::Family => embedded(&mut shipped::families().map(|family| family.toml)),
            Format::Scene => embedded(&mut shipped::scene_names().filter_map(shipped::scene_text)),
            Format::Pull | Format::Cycle => {
                let files = shipped::families().flat_map(|family| {
                    let pulls = family.pull_names().filter(|_| format == Format::Pull);
                    let cycles = family.cycle_names().filter(|_| format == Format::Cycle);
                    let names: Vec<&str> = pulls.chain(cycles).collect();
                    names.into_iter().filter_map(|name| family.gait_file(name))
                });
                Ok(files.map(|gait| gait.text.into_owned()).collect())
            }
            _ => Ok(vec![fs::read_to_string(self.beds.join(place(format)))?]),
        }
    }

    /// A new folder with whole files at every place.
    ///
    /// # Errors
    /// [`io::Error`].
    pub fn bed(&self) -> io::Result<Bed> {
        let home = tempfile::Builder::new()
            .prefix("prone-mutants-")
            .tempdir()?;
        let bed = Bed { home };
        for folder in ["record", "search"] {
            for entry in fs::read_dir(self.beds.join(folder))? {
                let entry = entry?;
                bed.write(
                    &Path::new(folder).join(entry.file_name()),
                    &fs::read(entry.path())?,
                )?;
            }
        }
        bed.write(Path::new("map.csv"), &fs::read(self.beds.join("map.csv"))?)?;
        bed.write(Path::new("robot/robot.toml"), alone(NAO.toml).as_bytes())?;
        bed.write(Path::new("robot/robot.xml"), NAO.mjcf.as_bytes())?;
        bed.write(Path::new("family/v4/robot.toml"), NAO.toml.as_bytes())?;
        bed.write(Path::new("family/v4/robot.xml"), NAO.mjcf.as_bytes())?;
        fs::create_dir(bed.path().join("out"))?;
        Ok(bed)
    }
}

impl Bed {
    /// The folder.
    pub fn path(&self) -> &Path {
        self.home.path()
    }

    /// Where a file of a format lies in it.
    pub fn file(&self, format: Format) -> PathBuf {
        self.path().join(place(format))
    }

    /// Puts a mutant at its place.
    ///
    /// # Errors
    /// [`io::Error`].
    pub fn put(&self, format: Format, text: &str) -> io::Result<()> {
        self.write(Path::new(place(format)), text.as_bytes())
    }

    fn write(&self, place: &Path, bytes: &[u8]) -> io::Result<()> {
        let path = self.path().join(place);
        fs::create_dir_all(path.parent().unwrap_or(self.path()))?;
        fs::write(path, bytes)
    }
}

/// A robot's file without its family.
pub fn alone(toml: &str) -> String {
    toml.replacen("family = \"nao\"\n", "", 1)
}

/// Where the file of a format lies in a bed.
const fn place(format: Format) -> &'static str {
    match format {
        Format::RobotXml => "robot/robot.xml",
        Format::RobotToml => "robot/robot.toml",
        Format::Family => "family/family.toml",
        Format::Pull => "pull.toml",
        Format::Cycle => "cycle.toml",
        Format::Scene => "scene.toml",
        Format::CompiledRobot => "record/robot.compiled.json",
        Format::TorqueMap => "map.csv",
        Format::Rows => "record/rows.csv",
        Format::Contacts => "record/contacts.csv",
        Format::Run => "record/run.json",
        Format::Model => "record/model.json",
        Format::Summary => "record/summary.json",
        Format::SearchResult => "search/result.json",
        Format::History => "search/history.csv",
        Format::Checkpoint => "search/search.state.json",
    }
}
