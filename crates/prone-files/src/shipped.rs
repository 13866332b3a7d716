//! What ships inside the program: families of robots with their versions and gaits, and scenes.

use std::path::Path;

use prone::gait::Gait;
use prone::gait::cycle::Cycle;
use prone::scene::Scene;

use crate::defaults::{Defaults, DefaultsTable};
use crate::error::Source;
use crate::family_file::FamilyFile;
use crate::gait_text::GaitText;
use crate::{FileError, cycle_file, gait_file, scene_file};

/// A family of robots, embedded.
#[derive(Debug, PartialEq, Eq)]
pub struct FamilySource {
    /// Its name, also that of its folder.
    pub name: &'static str,
    /// Where it comes from, as shown to a user.
    pub folder: &'static str,
    /// `family.toml`.
    pub toml: &'static str,
    /// Its robots.
    pub versions: &'static [RobotSource],
    /// Names and texts of its gaits that are a pull alone.
    pulls: &'static [(&'static str, &'static str)],
    /// Names and texts of its gaits that are a whole cycle.
    cycles: &'static [(&'static str, &'static str)],
}

/// A robot's two files, embedded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RobotSource {
    /// Which version of its family it is: the name of its folder.
    pub version: &'static str,
    /// Where they come from, as shown to a user.
    pub folder: &'static str,
    /// `robot.toml`.
    pub toml: &'static str,
    /// The MJCF model.
    pub mjcf: &'static str,
    /// The robot compiled from them, see [`crate::compiled_robot`].
    pub compiled: &'static str,
}

/// A version of the NAO.
macro_rules! version_of_nao {
    ($version:literal) => {
        RobotSource {
            version: $version,
            folder: concat!("robots/nao/", $version),
            toml: include_str!(concat!("../../../robots/nao/", $version, "/robot.toml")),
            mjcf: include_str!(concat!("../../../robots/nao/", $version, "/robot.xml")),
            compiled: include_str!(concat!(
                "../../../robots/nao/",
                $version,
                "/robot.compiled.json"
            )),
        }
    };
}

/// The NAO H25 V4.
pub const NAO: RobotSource = version_of_nao!("v4");

/// The NAO H25 V5.
pub const NAO_V5: RobotSource = version_of_nao!("v5");

/// The NAO of the scene in which the published torques were recorded.
pub const NAO_OF_THE_SCENE: RobotSource = version_of_nao!("scene");

/// The families that ship; what the first says goes for robots that say nothing.
static FAMILIES: [FamilySource; 1] = [FamilySource {
    name: "nao",
    folder: "robots/nao",
    toml: include_str!("../../../robots/nao/family.toml"),
    versions: &[NAO, NAO_V5, NAO_OF_THE_SCENE],
    pulls: &NAO_PULLS,
    cycles: &NAO_CYCLES,
}];

/// Name and text of a gait of the NAO.
macro_rules! of_nao {
    ($name:literal) => {
        (
            $name,
            include_str!(concat!("../../../robots/nao/gaits/", $name, ".toml")),
        )
    };
}

/// The published pulls, then the best that was found for each objective.
static NAO_PULLS: [(&str, &str); 8] = [
    of_nao!("nominal"),
    of_nao!("optimal"),
    of_nao!("least-published"),
    of_nao!("least-torque"),
    of_nao!("least-torque-clamped"),
    of_nao!("least-torque-spline"),
    of_nao!("least-weighted-torque"),
    of_nao!("least-peak"),
];

/// The cycles with the published postures, then those that keep low, then those for a robot's motors,
/// those that are fastest under a ceiling on good ground, those of little motor heat and of least torque
/// asked of the shoulders, and chains.
static NAO_CYCLES: [(&str, &str); 21] = [
    of_nao!("thesis-nominal"),
    of_nao!("thesis-optimal"),
    of_nao!("low-200"),
    of_nao!("low-175"),
    of_nao!("low-165"),
    of_nao!("low-150"),
    of_nao!("low-135"),
    of_nao!("low-125"),
    of_nao!("robot"),
    of_nao!("robot-200"),
    of_nao!("far-200"),
    of_nao!("far-183"),
    of_nao!("far-165"),
    of_nao!("least-heat"),
    of_nao!("coolest"),
    of_nao!("efficient"),
    of_nao!("gentle"),
    of_nao!("chain-200"),
    of_nao!("chain-178"),
    of_nao!("chain-168"),
    of_nao!("hip-10"),
];

impl FamilySource {
    /// The file of its gait of this name.
    pub fn gait_file(&self, name: &str) -> Option<GaitText> {
        let mut gaits = self.pulls.iter().chain(self.cycles);
        let (_, text) = gaits.find(|(known, _)| *known == name)?;
        Some(GaitText {
            file: format!("{}/gaits/{name}.toml", self.folder),
            text: (*text).into(),
            read: None,
        })
    }

    /// Names of its gaits that are a pull alone.
    pub fn pull_names(&self) -> impl Iterator<Item = &'static str> + use<> {
        self.pulls.iter().map(|(name, _)| *name)
    }

    /// Names of its gaits that are a whole cycle.
    pub fn cycle_names(&self) -> impl Iterator<Item = &'static str> + use<> {
        self.cycles.iter().map(|(name, _)| *name)
    }

    /// Name of its `family.toml`, as shown to a user.
    pub(crate) fn toml_name(&self) -> String {
        format!("{}/family.toml", self.folder)
    }
}

/// The families that ship.
pub fn families() -> impl Iterator<Item = &'static FamilySource> {
    FAMILIES.iter()
}

/// The family of a robot that ships.
pub(crate) fn family_of(robot: &RobotSource) -> Option<&'static FamilySource> {
    families().find(|family| family.versions.contains(robot))
}

/// The robot where none is named: the default version of the first family.
///
/// # Errors
/// [`FileError`] if the embedded family does not parse or names no version that ships, which a test
/// excludes.
pub fn default_robot() -> Result<&'static RobotSource, FileError> {
    default_version(&FAMILIES[0])
}

/// The version that a family stands for.
fn default_version(family: &'static FamilySource) -> Result<&'static RobotSource, FileError> {
    let (file, text) = (&family.toml_name(), family.toml);
    let default = FamilyFile::parse(file, text)?.default;
    let mut versions = family.versions.iter();
    let found = versions.find(|robot| robot.version == default.get_ref());
    found.ok_or_else(|| {
        let message = format!("no version {} ships", default.get_ref());
        Source { file, text }.error(default.span(), message)
    })
}

/// The shipped robot of a name: `nao` for the default version of a family, `nao/v4` for another one;
/// `None` for any other name.
///
/// # Errors
/// [`FileError`] if the embedded family does not parse, which a test excludes.
pub fn robot(name: &str) -> Option<Result<&'static RobotSource, FileError>> {
    let (family, version) = match name.split_once('/') {
        None => (name, None),
        Some((family, version)) => (family, Some(version)),
    };
    let family = families().find(|known| known.name == family)?;
    let Some(version) = version else {
        return Some(default_version(family));
    };
    let mut versions = family.versions.iter();
    versions.find(|robot| robot.version == version).map(Ok)
}

/// The names that [`robot`] knows: each family's, which stands for its default version, then those of
/// its versions.
pub fn robot_names() -> impl Iterator<Item = String> {
    families().flat_map(|family| {
        let versions = family.versions.iter();
        let versions = versions.map(|robot| format!("{}/{}", family.name, robot.version));
        std::iter::once(family.name.to_owned()).chain(versions)
    })
}

/// The name of the shipped robot, or family, whose folder in the repository ends a path.
pub(crate) fn robot_of_folder(path: &Path) -> Option<String> {
    let versions = families().flat_map(|family| {
        let versions = family.versions.iter();
        versions.map(|robot| (robot.folder, format!("{}/{}", family.name, robot.version)))
    });
    let named = families().map(|family| (family.folder, family.name.to_owned()));
    let mut folders = named.chain(versions);
    let (_, name) = folders.find(|(folder, _)| path.ends_with(folder))?;
    Some(name)
}

/// The gaits of a robot that says some of them; the others are those of the first family.
pub(crate) fn defaults(stated: DefaultsTable) -> Result<Defaults, FileError> {
    let [family, ..] = &FAMILIES;
    let (file, text) = (&family.toml_name(), family.toml);
    let shipped = FamilyFile::parse(file, text)?.defaults;
    stated.over(shipped).whole(Source { file, text })
}

/// The file of a shipped gait, of the first family that has one of this name.
pub fn gait_file(name: &str) -> Option<GaitText> {
    families().find_map(|family| family.gait_file(name))
}

/// The names that [`cycle`] knows.
pub fn cycle_names() -> impl Iterator<Item = &'static str> {
    families().flat_map(FamilySource::cycle_names)
}

/// A shipped cycle by name, `None` for any other name.
///
/// # Errors
/// [`FileError`] if the embedded text does not parse, which a test excludes.
pub fn cycle(name: &str) -> Option<Result<Cycle, FileError>> {
    let gait = gait_file(name).filter(GaitText::is_cycle)?;
    Some(cycle_file::parse(&gait.file, &gait.text))
}

/// The names that [`gait`] knows.
pub fn gait_names() -> impl Iterator<Item = &'static str> {
    families().flat_map(FamilySource::pull_names)
}

/// A shipped gait that is a pull alone by name, `None` for any other name.
///
/// # Errors
/// [`FileError`] if the embedded text does not parse, which a test excludes.
pub fn gait(name: &str) -> Option<Result<Gait, FileError>> {
    let gait = gait_file(name).filter(|gait| !gait.is_cycle())?;
    Some(gait_file::parse(&gait.file, &gait.text))
}

/// Names and texts of the scenes that ship with the program.
const SCENES: [(&str, &str); 6] = [
    ("plate-200", include_str!("../../../scenes/plate-200.toml")),
    ("table", include_str!("../../../scenes/table.toml")),
    ("bend", include_str!("../../../scenes/bend.toml")),
    ("ramp", include_str!("../../../scenes/ramp.toml")),
    ("rough-5", include_str!("../../../scenes/rough-5.toml")),
    ("rough-10", include_str!("../../../scenes/rough-10.toml")),
];

/// The names that [`scene`] knows.
pub fn scene_names() -> impl Iterator<Item = &'static str> {
    SCENES.iter().map(|(name, _)| *name)
}

/// The text of a shipped scene's file.
pub fn scene_text(name: &str) -> Option<&'static str> {
    let (_, text) = SCENES.iter().find(|(known, _)| *known == name)?;
    Some(text)
}

/// A shipped scene by name, `None` for any other name.
///
/// # Errors
/// [`FileError`] if the embedded text does not parse, which a test excludes.
pub fn scene(name: &str) -> Option<Result<Scene, FileError>> {
    let (_, text) = SCENES.iter().find(|(known, _)| *known == name)?;
    Some(scene_file::parse(&format!("scenes/{name}.toml"), text))
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;

    use crate::robot_folder::RobotFiles;

    use super::*;

    #[test]
    fn shipped_scenes_parse_under_their_own_names() {
        for name in scene_names() {
            assert_eq!(scene(name).unwrap().unwrap().name, name);
        }
        assert!(scene("swamp").is_none());
    }

    #[test]
    fn reference_the_table_is_blocked_to_200_mm() {
        let table = scene("table").unwrap().unwrap();
        let edges: Vec<f64> = table.panels.iter().map(|panel| panel.lower_edge).collect();
        assert_eq!(edges, [0.2, 0.2]);
        assert!(table.marker.is_some());
        // From all outside to all through, for a robot of 0.6 m, is what the original crawled.
        let plate = table.plates[0];
        assert!((plate.start + plate.length + 0.6 - 1.6764).abs() < 0.03);
    }

    #[test]
    fn shipped_gaits_parse_under_their_own_names() {
        for name in gait_names() {
            assert_eq!(gait(name).unwrap().unwrap().name, name);
            assert!(cycle(name).is_none());
        }
        for name in cycle_names() {
            assert_eq!(cycle(name).unwrap().unwrap().name, name);
            assert!(gait(name).is_none());
        }
        assert!(gait("gallop").is_none());
        assert!(cycle("gallop").is_none());
    }

    /// Names of the entries of a folder of the repository, without `.toml`, sorted.
    fn entries(folder: &str) -> Vec<String> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../..")
            .join(folder);
        let mut names: Vec<String> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .map(|name| name.trim_end_matches(".toml").to_owned())
            .collect();
        names.sort_unstable();
        names
    }

    fn sorted<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
        let mut names: Vec<&str> = names.collect();
        names.sort_unstable();
        names
    }

    #[test]
    fn all_robots_and_gaits_of_the_repository_ship() {
        assert_eq!(
            entries("robots"),
            sorted(families().map(|family| family.name))
        );
        for family in families() {
            assert_eq!(family.folder, format!("robots/{}", family.name));
            let versions = family.versions.iter().map(|robot| robot.version);
            let inside = versions.chain(["family", "gaits"]);
            assert_eq!(entries(family.folder), sorted(inside));
            let gaits = family.pull_names().chain(family.cycle_names());
            assert_eq!(entries(&format!("{}/gaits", family.folder)), sorted(gaits));
        }
        assert_eq!(entries("scenes"), sorted(scene_names()));
    }

    #[test]
    fn shipped_robots_are_what_their_folders_hold() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        for family in families() {
            for version in family.versions {
                let shipped = RobotFiles::shipped(version);
                let read = RobotFiles::read(&root.join(version.folder)).unwrap();
                assert_eq!(shipped.hash(), read.hash());
                assert_eq!(shipped.defaults().unwrap(), read.defaults().unwrap());
                assert!(shipped.version.is_some());
                assert_eq!(shipped.version, read.version);
                let recorded = |files: &RobotFiles| {
                    let recorded = files.recorded().unwrap();
                    recorded.map(|files| (files.hash(), files.version))
                };
                assert_eq!(recorded(&shipped), recorded(&read));
            }
            let default = robot(family.name).unwrap().unwrap();
            let read = RobotFiles::read(&root.join(family.folder)).unwrap();
            assert_eq!(RobotFiles::shipped(default).hash(), read.hash());
        }
        for name in robot_names() {
            assert!(robot(&name).unwrap().is_ok(), "{name}");
        }
        assert_eq!(robot("nao").unwrap().unwrap(), &NAO);
        assert_eq!(default_robot().unwrap(), &NAO);
        assert!(robot("nao/v0").is_none());
        assert!(robot("pepper").is_none());
    }

    #[test]
    fn the_torques_of_one_version_were_recorded() {
        let of_scene = RobotFiles::shipped(&NAO_OF_THE_SCENE);
        for version in [&NAO, &NAO_V5] {
            let recorded = RobotFiles::shipped(version).recorded().unwrap();
            assert_eq!(recorded, Some(of_scene.clone()));
        }
        assert_eq!(of_scene.recorded().unwrap(), None);
    }

    #[test]
    fn every_shipped_cycle_is_tried_under_a_ceiling() {
        for family in families() {
            let defaults = RobotFiles::shipped(&family.versions[0]).defaults().unwrap();
            let under = defaults.cycle.under;
            assert!(under.iter().map(String::as_str).eq(family.cycle_names()));
        }
    }

    #[test]
    fn reference_published_gaits_start_and_end_where_they_are_printed() {
        for name in ["nominal", "optimal"] {
            let gait = gait(name).unwrap().unwrap();
            let start = gait.parameters(0.0);
            // Table 3 prints five digits; Table 2 prints tenths of a degree of the same angles.
            assert!((start.knee - 0.287_98).abs() < 1e-5, "{name}");
            assert!((start.hip - 0.479_97).abs() < 1e-5, "{name}");
            assert!(
                (start.upper_arm + std::f64::consts::FRAC_PI_6).abs() < 1e-5,
                "{name}"
            );
            // The optimiser's equality tolerance of 1e-3 was used up by the published optimum.
            let end = gait.parameters(1.0);
            assert!(
                (end.upper_arm + std::f64::consts::FRAC_PI_2).abs() < 1.3e-3,
                "{name}"
            );
            assert!((end.knee - 0.287_98).abs() < 1.3e-3, "{name}");
            assert!((end.hip - 0.479_97).abs() < 1.3e-3, "{name}");
        }
    }
}
