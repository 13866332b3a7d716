//! Slices of a map as the files of a result folder.

use serde::Serialize;

use prone::torque_map::TorqueMap;

use prone_record::output::{Artefacts, RUN_FILE, json};
use prone_record::program::Program;
use prone_report::figure_list::FigureList;
use prone_report::figures::{self, FigureError, PNG_SCALE};

/// Slices that are drawn where none are asked for.
const SLICES: usize = 4;

/// How far a value may be from its node, degrees: half of the hundredth that drawings print.
const NODE_TOLERANCE_DEG: f64 = 0.005;

/// Where a drawn map came from, for `run.json`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MapFile {
    /// Its name as typed.
    pub name: String,
    /// Its comments, which say what made it.
    pub comments: Vec<String>,
}

/// Why a map is not drawn.
#[derive(Debug, thiserror::Error)]
pub enum PlotError {
    /// There is no slice there.
    #[error(
        "theta3 = {theta3_deg:?}° is no node of the map: they go from {low_deg:.2}° to {high_deg:.2}° by {step_deg:.2}°"
    )]
    Slice {
        /// What was asked for, degrees.
        theta3_deg: f64,
        /// First node, degrees.
        low_deg: f64,
        /// Last node, degrees.
        high_deg: f64,
        /// Distance of neighbours, degrees.
        step_deg: f64,
    },
    /// A drawing cannot be made.
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// `run.json` cannot be written.
    #[error("cannot write {RUN_FILE}: {0}")]
    Json(#[from] serde_json::Error),
}

/// What was drawn: `run.json`.
#[derive(Serialize)]
struct PlotInfo<'a> {
    program: &'static str,
    #[serde(flatten)]
    built: &'a Program,
    command: &'static str,
    map: &'a str,
    map_comments: &'a [String],
    figures: Vec<FigureInfo>,
}

#[derive(Serialize)]
struct FigureInfo {
    file: String,
    title: String,
    caption: String,
}

/// Nodes of θ3 to draw: those asked for, degrees, or four evenly spread ones.
///
/// # Errors
/// [`PlotError::Slice`].
pub fn slices(map: &TorqueMap, wanted_deg: &[f64]) -> Result<Vec<usize>, PlotError> {
    let axis = map.grid().knee;
    let node = |theta3_deg: f64| {
        let near = |node: &usize| {
            (axis.value(*node).to_degrees() - theta3_deg).abs() <= NODE_TOLERANCE_DEG
        };
        (0..axis.len()).find(near).ok_or(PlotError::Slice {
            theta3_deg,
            low_deg: axis.low().to_degrees(),
            high_deg: axis.high().to_degrees(),
            step_deg: axis.step().to_degrees(),
        })
    };
    let mut slices = if wanted_deg.is_empty() {
        let last = axis.len() - 1;
        let gaps = SLICES - 1;
        // The nearest node, in whole numbers.
        (0..SLICES).map(|k| (k * last + gaps / 2) / gaps).collect()
    } else {
        let nodes = wanted_deg.iter().map(|deg| node(*deg));
        nodes.collect::<Result<Vec<_>, _>>()?
    };
    slices.sort_unstable();
    slices.dedup();
    Ok(slices)
}

/// Drawings of some slices, and `run.json`.
pub fn artefacts(
    map: &TorqueMap,
    slices: &[usize],
    file: &MapFile,
    program: &Program,
) -> Result<Artefacts, PlotError> {
    let mut artefacts = Artefacts::new();
    let mut infos = Vec::new();
    let mut list = FigureList::default();
    for figure in figures::torque_map_figures(map, slices)? {
        let png = figure.png(PNG_SCALE)?;
        infos.push(FigureInfo {
            file: format!("{}.svg", figure.stem),
            title: figure.title.clone(),
            caption: figure.caption.clone(),
        });
        list.drawing(&mut artefacts, "", figure, png);
    }
    list.finish(&mut artefacts)?;
    let info = PlotInfo {
        program: "prone",
        built: program,
        command: "torque-map plot",
        map: &file.name,
        map_comments: &file.comments,
        figures: infos,
    };
    artefacts.insert(RUN_FILE.into(), json(&info)?);
    Ok(artefacts)
}

#[cfg(test)]
mod tests {
    use prone::torque_map::{Axis, Grid, JointTorques, Row};

    use super::*;

    fn map() -> TorqueMap {
        let grid = Grid {
            knee: Axis::new(-5.0_f64.to_radians(), 45.0_f64.to_radians(), 21).unwrap(),
            hip: Axis::new(-0.5, 0.5, 3).unwrap(),
            upper_arm: Axis::new(-1.5, -0.5, 2).unwrap(),
        };
        let torques = Row::Torques(JointTorques::from_array([0.1, -0.2, 0.3, 0.0]));
        TorqueMap::new(grid, vec![torques; grid.len()]).unwrap()
    }

    #[test]
    fn slices_are_nodes() {
        assert_eq!(slices(&map(), &[]).unwrap(), [0, 7, 13, 20]);
        assert_eq!(slices(&map(), &[45.0, -5.0, 45.0]).unwrap(), [0, 20]);
        for theta3_deg in [13.0, 47.5, f64::NAN] {
            assert_eq!(
                slices(&map(), &[theta3_deg]).unwrap_err().to_string(),
                format!(
                    "theta3 = {theta3_deg:?}° is no node of the map: they go from -5.00° to 45.00° by 2.50°"
                )
            );
        }
    }

    #[test]
    fn a_result_has_two_files_per_slice_and_says_what_was_drawn() {
        let file = MapFile {
            name: "a.csv".to_owned(),
            comments: vec!["by hand".to_owned()],
        };
        let program = Program {
            version: "0.0.0".into(),
            commit: "test".into(),
        };
        let files = artefacts(&map(), &[0, 2], &file, &program).unwrap();
        let names: Vec<_> = files.keys().map(String::as_str).collect();
        assert_eq!(
            names,
            [
                "figures.json",
                "run.json",
                "torque-map-theta3+00.00deg.png",
                "torque-map-theta3+00.00deg.svg",
                "torque-map-theta3-05.00deg.png",
                "torque-map-theta3-05.00deg.svg",
            ]
        );
        let run: serde_json::Value = serde_json::from_slice(&files[RUN_FILE]).unwrap();
        assert_eq!(run["map"], "a.csv");
        assert_eq!(run["map_comments"][0], "by hand");
        assert_eq!(run["figures"][1]["title"], "Torque map at θ3 = 0°");
        let again = artefacts(&map(), &[0, 2], &file, &program).unwrap();
        assert!(files == again, "the same map gives the same bytes");
    }
}
