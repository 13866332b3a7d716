//! Slices of a torque map at constant θ3: a heat map per joint over θ4 and α.

use prone::torque_map::{Axis as Nodes, Row, TorqueMap};

use super::axis::Axis;
use super::bar::{Bar, HeatScale};
use super::heat::Cells;
use super::panel::Panel;
use super::sheet::{KeyEntry, Sample, Sheet};
use super::torque::TORQUE_LABEL;
use super::{Figure, FigureError, Wording};
use prone_record::pulls::JOINTS;

/// One drawing per slice, all on one colour scale; `slices` are nodes of θ3, and those that the map
/// does not have are left out.
///
/// # Errors
/// If the map holds a number that no axis can show.
pub fn figures(map: &TorqueMap, slices: &[usize]) -> Result<Vec<Figure>, FigureError> {
    let values = map.rows().iter().filter_map(|row| match row {
        Row::Torques(torques) => Some(torques.to_array()),
        Row::Masked { .. } => None,
    });
    let scale = HeatScale::covering(TORQUE_LABEL, values.flatten());
    let slices = slices.iter();
    let known = slices.filter(|slice| **slice < map.grid().knee.len());
    known.map(|slice| figure(map, *slice, &scale)).collect()
}

fn figure(map: &TorqueMap, slice: usize, scale: &HeatScale) -> Result<Figure, FigureError> {
    let grid = map.grid();
    let theta3_deg = grid.knee.value(slice).to_degrees();
    let rows: Vec<Row> = (0..grid.upper_arm.len())
        .flat_map(|arm| (0..grid.hip.len()).map(move |hip| grid.index(slice, hip, arm)))
        .map(|index| map.rows()[index])
        .collect();
    let is_masked = |row: &&Row| matches!(row, Row::Masked { .. });
    let masked = rows.iter().filter(is_masked).count();
    let key = (masked > 0).then(|| KeyEntry {
        label: format!("no torques: {masked} of {} rows are masked", rows.len()),
        sample: Sample::Hatched,
    });
    let panels = (0..JOINTS.len()).map(|joint| panel(map, &rows, joint, scale));
    let sheet = Sheet::new(2, 270.0, panels)
        .with_key(key)
        .with_bar(Bar::Scale(scale.clone()));
    // Of a node that is meant to be a multiple of a step, two decimals are enough.
    let shown = format!("{theta3_deg:.2}").replace("-0.00", "0.00");
    let shown = shown.trim_end_matches('0').trim_end_matches('.');
    let wording = Wording {
        stem: format!("torque-map-theta3{:+06.2}deg", theta3_deg + 0.0),
        number: "",
        title: format!("Torque map at θ3 = {}°", shown.replace('-', "−")),
        caption: format!(
            "Joint torque at rest, N·m, over θ4 (hip) and α (upper arm), degrees, at θ3 (knee) = \
             {shown}°; one panel per joint, right side, the sign of the published recordings. \
             Each cell is a row of the map. Grey, hatched: masked rows."
        ),
        alt: format!(
            "Four heat maps, ankle, knee, hip and shoulder, of static joint torque over theta 4 and \
             alpha at theta 3 of {shown} degrees."
        ),
    };
    sheet.figure(wording)
}

fn panel(map: &TorqueMap, rows: &[Row], joint: usize, scale: &HeatScale) -> Panel {
    let grid = map.grid();
    let values = rows.iter().map(|row| match row {
        Row::Torques(torques) => Some(torques.to_array()[joint]),
        Row::Masked { .. } => None,
    });
    let x = cell_axis("θ4 (hip), °", &grid.hip);
    let y = cell_axis("α (upper arm), °", &grid.upper_arm);
    let mut panel = Panel::new(JOINTS[joint], x, y, Vec::new());
    panel.rules.clear();
    panel.cells = Some(Cells {
        columns: grid.hip.len(),
        values: values.collect(),
        scale: scale.clone(),
    });
    panel
}

/// From the outer edge of the first cell to that of the last, degrees.
fn cell_axis(label: &str, nodes: &Nodes) -> Axis {
    let half = nodes.step() / 2.0;
    let [low, high] = [nodes.low() - half, nodes.high() + half].map(f64::to_degrees);
    Axis::exactly(label, low, high)
}
