//! Figure 25: the three gait parameters over the phase.

use super::axis::Axis;
use super::panel::{Curve, Panel};
use super::sheet::{KeyEntry, Sheet};
use super::style::gait_stroke;
use super::{Figure, FigureError, GaitNumbers, Wording, selection};
use prone_record::pulls::ChainRecord;

const PARAMETERS: [&str; 3] = ["θ3 (knee)", "θ4 (hip)", "α (upper arm)"];

/// One panel per parameter, all gaits in each.
pub(crate) fn figure(
    gaits: &[GaitNumbers],
    chains: &[ChainRecord],
) -> Result<Option<Figure>, FigureError> {
    let names = chains.iter().filter(|chain| !chain.samples.is_empty());
    let names = names.map(|chain| chain.gait.as_str());
    let gaits = selection::each_once(names, &selection::names(gaits));
    let chains: Vec<&ChainRecord> = gaits
        .iter()
        .filter_map(|gait| chains.iter().find(|chain| chain.gait == *gait))
        .collect();
    if chains.is_empty() {
        return Ok(None);
    }
    let key = chains.iter().enumerate().map(|(index, chain)| {
        KeyEntry::line(format!("{} gait", chain.gait), gait_stroke(index), None)
    });
    let panels = (0..PARAMETERS.len()).map(|parameter| panel(&chains, parameter));
    let sheet = Sheet::new(PARAMETERS.len(), 210.0, panels).with_key(key);
    let wording = Wording {
        stem: "fig-25-gait-parameters".to_owned(),
        number: "25",
        title: format!("Gait parameters over the phase: {}", gaits.join(", ")),
        caption: "The three angles that define the closed chain, in degrees, over the phase s = \
                  t / duration: θ3 at the knee, θ4 at the hip, and α, the absolute angle of the \
                  upper arm. Source: the gaits as planned here; nominal and optimal are the \
                  published ones."
            .to_owned(),
        alt: format!(
            "Three line plots of the angles theta 3, theta 4 and alpha in degrees against the \
             phase from 0 to 1, one line each for: {}.",
            gaits.join(", ")
        ),
    };
    sheet.figure(wording).map(Some)
}

fn panel(chains: &[&ChainRecord], parameter: usize) -> Panel {
    let curves = chains.iter().enumerate().map(|(index, chain)| {
        let samples = chain.samples.iter();
        let points = samples.map(|sample| (sample.s, sample.parameters_deg[parameter]));
        Curve::new(points.collect(), gait_stroke(index))
    });
    let curves: Vec<Curve> = curves.collect();
    let points = curves.iter().flat_map(|curve| &curve.points);
    let x = Axis::exactly("phase s, –", 0.0, 1.0);
    let y = Axis::covering("angle, °", points.map(|point| point.1));
    Panel::new(PARAMETERS[parameter], x, y, curves)
}
