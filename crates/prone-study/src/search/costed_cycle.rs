//! What a single cycle costs: its value and what it breaks, by the costs of a search, setting by setting.

use std::sync::Arc;

use prone::gait::cycle::Cycle;
use prone_files::cycle_file;
use prone_record::cycle_cost::{CycleCost, SettingCost};
use prone_record::experiment::CycleCostExperiment;
use prone_record::gait_search::Broken;
use prone_record::measure::{Heats, Measure};
use prone_sim::LoadedRobot;

use super::candidates::Depth;
use super::confirm::cycle_row;
use super::cycle_cost::{CycleAim, CycleCosts};
use super::cycle_jobs::{self, CycleSearchError, Scope};
use super::setting::Setting;
use super::trial::Trial;
use crate::watch::Watch;

/// The cost of a cycle in every setting of a search for an objective, whatever is broken before.
///
/// # Errors
/// [`CycleSearchError`] where a search about it could not begin, or the watch said stop; what cannot be crawled in a setting has
/// a cost with the reason.
pub fn cost(
    experiment: &CycleCostExperiment,
    robot: &LoadedRobot,
    watch: &dyn Watch,
) -> Result<CycleCost, CycleSearchError> {
    let objective = experiment.objective;
    let cycle = experiment.gait.parse(cycle_file::parse)?;
    let base = experiment.from.as_ref();
    let base: Cycle = base.map_or_else(|| Ok(cycle.clone()), |it| it.parse(cycle_file::parse))?;
    let worst_over = experiment.worst_over.as_ref();
    cycle_jobs::check_rules(objective, &experiment.rules, worst_over)?;
    let scope = Scope {
        objective,
        held: None,
        steerable: experiment.steerable,
        ideal: experiment.ideal,
    };
    let settings = cycle_jobs::searched(scope, robot)?;
    let height = experiment
        .rules
        .ceiling_mm
        .map_or(f64::INFINITY, |mm| mm * 1e-3);
    let usual = cycle_jobs::usual_rules(objective, height, &base, robot.robot());
    let aim = CycleAim {
        objective,
        merge: cycle_jobs::merge(worst_over, &settings)?,
        rules: cycle_jobs::asked_rules(&experiment.rules, usual),
    };
    let rules = aim.rules;
    let costs = CycleCosts::new(Arc::clone(&settings), aim, &base)?;
    let cost = costs.cost_unless(&|| watch.stop(), &cycle, Depth::Everything);
    let cost = cost.ok_or(CycleSearchError::Stopped)?;
    let heats = match worst_over {
        None => Heats::PerMetre,
        Some(_) => Heats::OverAnother,
    };
    let measure = Measure::of_cycles(objective, heats);
    let first = cost.trials.first().map_or(f64::NAN, |trial| trial.advance);
    let in_setting = |(setting, trial): (&Setting, &Trial)| {
        let broken = rules.broken_by_trial(&setting.spec, trial, first);
        let broken = broken.into_iter().filter(|(_, amount)| *amount > 0.0);
        let broken = broken.map(|(rule, sum)| Broken {
            rule: rule.into(),
            count: 1,
            sum,
        });
        SettingCost {
            row: cycle_row(setting, trial, trial.advance / first),
            broken: broken.collect(),
        }
    };
    let value = Some(cost.value).filter(|value| value.is_finite());
    Ok(CycleCost {
        gait: cycle.name.clone(),
        objective,
        value: value.map(|value| measure.read(value)),
        unit: measure.unit,
        sentence: value.map(|value| measure.sentence(value)),
        violations: cost.violation,
        broken: cost.broken,
        refused: cost.refusal.as_ref().map(ToString::to_string),
        settings: settings.iter().zip(&cost.trials).map(in_setting).collect(),
    })
}
