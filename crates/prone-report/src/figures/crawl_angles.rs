//! Figure 31: joint angles of the left side over a few crawl cycles.

use super::axis::Axis;
use super::panel::{Band, Curve, Panel};
use super::records::{AngleRecord, AngleRow, PublishedRange};
use super::sheet::{KeyEntry, Sheet};
use super::style::{BAND, CURVE_WIDTH, INK, LIGHT, Stroke};
use super::torque::time_axis;
use super::{Figure, FigureError, Wording};

/// One panel for each joint; nothing without rows. `published` is the range that a joint swept on a
/// robot, rad, where one is published.
pub fn figure(
    record: &AngleRecord,
    published: &dyn Fn(&str) -> Option<PublishedRange>,
) -> Result<Option<Figure>, FigureError> {
    let AngleRecord {
        gait,
        joints,
        rows,
        cycles: shown,
        not_simulated,
    } = record;
    let ours = if not_simulated.is_none() {
        ", ours"
    } else {
        ""
    };
    let Some(end) = rows.last().map(|row| row.time_s) else {
        return Ok(None);
    };
    let measured = Stroke::solid(INK, CURVE_WIDTH);
    let commanded = Stroke::solid(LIGHT, CURVE_WIDTH + 1.0);
    let mut obtained = None;
    let panels = joints.iter().enumerate().map(|(joint, name)| {
        let over_time = |angles: fn(&AngleRow) -> &[f64]| {
            let points = rows.iter();
            points.map(|row| (row.time_s, angles(row)[joint])).collect()
        };
        let curves = vec![
            Curve::new(over_time(|row| &row.command_rad), commanded),
            Curve::new(over_time(|row| &row.angle_rad), measured),
        ];
        let range = published(name);
        obtained = obtained.or(range.map(|range| range.obtained));
        let band = range.map(|range| range.angles);
        let points = curves.iter().flat_map(|curve| &curve.points);
        let ends = band.iter().flat_map(|&(low, high)| [low, high]);
        let y = Axis::covering("angle, rad", points.map(|point| point.1).chain(ends));
        let mut panel = Panel::new(name.clone(), time_axis(end), y, curves);
        let band = band.map(|(low, high)| Band { low, high });
        panel.bands.extend(band);
        panel
    });
    let panels: Vec<Panel> = panels.collect();
    let mut key = vec![
        KeyEntry::line(format!("measured{ours}"), measured, None),
        KeyEntry::line(format!("commanded{ours}"), commanded, None),
    ];
    let mut source = not_simulated.as_ref().map_or_else(
        || "Ours: simulation, one value per 20 ms.".to_owned(),
        |from| format!("Source: {from}."),
    );
    if let Some(obtained) = obtained {
        key.push(KeyEntry::band(
            "range on the crawling robot, published".to_owned(),
            BAND,
        ));
        source.push(' ');
        source.push_str(obtained);
    }
    let sheet = Sheet::new(2, 130.0, panels).with_key(key);
    let wording = Wording {
        stem: format!("fig-31-{gait}-angles"),
        number: "31",
        title: format!("{gait}: joint angles of the left side over {shown} cycles"),
        caption: format!(
            "Joint angles, rad, in the robot's own signs, over the first {shown} cycles of a crawl \
             with {gait}. {source}"
        ),
        alt: format!(
            "Line plots, one for each of {} joints of the left leg and arm, of commanded and measured \
             angle over {end:.0} seconds.",
            joints.len()
        ),
    };
    sheet.figure(wording).map(Some)
}
