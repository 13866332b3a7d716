//! What ships inside the program: one robot, the published gaits, gaits that were found, and scenes.

use prone::gait::Gait;
use prone::gait::cycle::Cycle;
use prone::scene::Scene;

use crate::{FileError, cycle_file, gait_file, scene_file};

/// A robot's two files, embedded.
#[derive(Debug, Clone, Copy)]
pub struct RobotSource {
    /// Where they come from, as shown to a user.
    pub folder: &'static str,
    /// `robot.toml`.
    pub toml: &'static str,
    /// The MJCF model.
    pub mjcf: &'static str,
}

/// The NAO H25 V4.
pub const NAO: RobotSource = RobotSource {
    folder: "robots/nao/v4",
    toml: include_str!("../../../robots/nao/v4/robot.toml"),
    mjcf: include_str!("../../../robots/nao/v4/robot.xml"),
};

/// Names and texts of the gaits that ship with the program: the published ones, then the best that
/// was found for each objective.
const GAITS: [(&str, &str); 8] = [
    (
        "nominal",
        include_str!("../../../robots/nao/gaits/nominal.toml"),
    ),
    (
        "optimal",
        include_str!("../../../robots/nao/gaits/optimal.toml"),
    ),
    (
        "least-published",
        include_str!("../../../robots/nao/gaits/least-published.toml"),
    ),
    (
        "least-torque",
        include_str!("../../../robots/nao/gaits/least-torque.toml"),
    ),
    (
        "least-torque-clamped",
        include_str!("../../../robots/nao/gaits/least-torque-clamped.toml"),
    ),
    (
        "least-torque-spline",
        include_str!("../../../robots/nao/gaits/least-torque-spline.toml"),
    ),
    (
        "least-weighted-torque",
        include_str!("../../../robots/nao/gaits/least-weighted-torque.toml"),
    ),
    (
        "least-peak",
        include_str!("../../../robots/nao/gaits/least-peak.toml"),
    ),
];

/// Names and texts of the cycles that ship with the program: those with the published postures, then
/// those that keep low and can be steered, then those that come farthest under a ceiling,
/// and those of little motor heat and of least torque asked of the shoulders.
const CYCLES: [(&str, &str); 12] = [
    (
        "thesis-nominal",
        include_str!("../../../robots/nao/gaits/thesis-nominal.toml"),
    ),
    (
        "thesis-optimal",
        include_str!("../../../robots/nao/gaits/thesis-optimal.toml"),
    ),
    (
        "low-200",
        include_str!("../../../robots/nao/gaits/low-200.toml"),
    ),
    (
        "low-175",
        include_str!("../../../robots/nao/gaits/low-175.toml"),
    ),
    (
        "low-165",
        include_str!("../../../robots/nao/gaits/low-165.toml"),
    ),
    (
        "hip-10",
        include_str!("../../../robots/nao/gaits/hip-10.toml"),
    ),
    (
        "far-200",
        include_str!("../../../robots/nao/gaits/far-200.toml"),
    ),
    (
        "far-183",
        include_str!("../../../robots/nao/gaits/far-183.toml"),
    ),
    (
        "far-165",
        include_str!("../../../robots/nao/gaits/far-165.toml"),
    ),
    (
        "least-heat",
        include_str!("../../../robots/nao/gaits/least-heat.toml"),
    ),
    (
        "efficient",
        include_str!("../../../robots/nao/gaits/efficient.toml"),
    ),
    (
        "gentle",
        include_str!("../../../robots/nao/gaits/gentle.toml"),
    ),
];

/// The names that [`cycle`] knows.
pub fn cycle_names() -> impl Iterator<Item = &'static str> {
    CYCLES.iter().map(|(name, _)| *name)
}

/// The text of a shipped cycle's file.
pub fn cycle_text(name: &str) -> Option<&'static str> {
    let (_, text) = CYCLES.iter().find(|(known, _)| *known == name)?;
    Some(text)
}

/// A shipped cycle by name, `None` for any other name.
///
/// # Errors
/// [`FileError`] if the embedded text does not parse, which a test excludes.
pub fn cycle(name: &str) -> Option<Result<Cycle, FileError>> {
    cycle_text(name).map(|text| cycle_file::parse(&format!("robots/nao/gaits/{name}.toml"), text))
}

/// The names that [`gait`] knows.
pub fn gait_names() -> impl Iterator<Item = &'static str> {
    GAITS.iter().map(|(name, _)| *name)
}

/// The text of a shipped gait's file.
pub fn gait_text(name: &str) -> Option<&'static str> {
    let (_, text) = GAITS.iter().find(|(known, _)| *known == name)?;
    Some(text)
}

/// A shipped gait by name, `None` for any other name.
///
/// # Errors
/// [`FileError`] if the embedded text does not parse, which a test excludes.
pub fn gait(name: &str) -> Option<Result<Gait, FileError>> {
    gait_text(name).map(|text| gait_file::parse(&format!("robots/nao/gaits/{name}.toml"), text))
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
        }
        assert!(gait("gallop").is_none());
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
