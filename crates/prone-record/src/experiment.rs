//! What can be run, as data: owned, with the texts of robot, gaits and scene in it instead of their
//! paths, so that a worker on another machine or a client in another language can be handed all of it.
//!
//! Names, units and bounds are those of the command line; what a text holds is only known when an
//! experiment is run.

mod cost;
mod crawl;
mod cycle_rules;
mod limit;
mod passage;
mod search;
mod source;
mod torque_map;

pub use cost::{
    BodyShareOf, ClearanceChoice, CostExperiment, CycleCostExperiment, LimitsChoice,
    PullCostChoice, PullObjective, PullRules, Share, TorqueChoice,
};
pub use crawl::{
    CrawlExperiment, Detail, Ending, PullExperiment, SceneChoice, ServoChoice, SteeringChoice,
};
pub use cycle_rules::{CycleRulesChoice, LeastVerdict, NamedGait};
pub use limit::Limit;
pub use passage::{PassageCycle, PassageExperiment, PassageSearch};
pub use search::{
    CycleSearchExperiment, Ends, GaitForm, PullSearchExperiment, Runs, Under, check_heights,
};
pub use source::{ChangedText, GaitText, RobotText, SceneText, TextError, TextFile};
pub use torque_map::{MapSource, TorqueMapExperiment};

use serde::{Deserialize, Serialize};

/// Something that can be run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "experiment", rename_all = "kebab-case")]
pub enum Experiment {
    /// One closed-chain phase.
    Pull(Box<PullExperiment>),
    /// Whole cycles in a scene.
    Crawl(Box<CrawlExperiment>),
    /// Whether a robot gets under a ceiling.
    Passage(Box<PassageExperiment>),
    /// What a pull costs.
    Cost(Box<CostExperiment>),
    /// What a cycle costs.
    CycleCost(Box<CycleCostExperiment>),
    /// Pulls that cost least: `prone optimize`.
    PullSearch(Box<PullSearchExperiment>),
    /// Cycles that cost least, under one ceiling or none (`prone optimize --source cycle`) or under
    /// several (`prone crawl frontier`).
    CycleSearch(Box<CycleSearchExperiment>),
    /// A torque map.
    TorqueMap(Box<TorqueMapExperiment>),
}

#[cfg(test)]
mod tests {
    use prone_files::robot_folder::RobotFiles;
    use prone_files::shipped;

    use super::*;

    fn robot() -> RobotText {
        RobotText::from_files(&RobotFiles::shipped(&shipped::NAO))
    }

    fn gait() -> GaitText {
        let gait = shipped::gait_file("low-175").unwrap();
        GaitText::new(&gait.file, &gait.text)
    }

    /// What a worker is sent is what it reads, to the last bit.
    #[test]
    fn an_experiment_survives_being_sent() {
        let crawl = CrawlExperiment {
            uphill: Some(gait()),
            scene: SceneChoice {
                plate: Some((178.0, 1.5)),
                friction: Some((0.5, 0.9)),
                slope_deg: Some(0.1 + 0.2),
                ..SceneChoice::default()
            },
            steering: SteeringChoice::Heading { degrees: -30.0 },
            seed: Some(u64::MAX),
            ..CrawlExperiment::new(robot(), gait())
        };
        let experiments = [
            Experiment::Crawl(Box::new(crawl)),
            Experiment::Pull(Box::new(PullExperiment {
                robot: robot(),
                gait: gait(),
                duration_s: 0.1 + 0.2,
            })),
        ];
        for experiment in experiments {
            let text = serde_json::to_string(&experiment).unwrap();
            let back: Experiment = serde_json::from_str(&text).unwrap();
            assert_eq!(back, experiment);
        }
    }

    #[test]
    fn a_text_that_was_changed_on_its_way_is_refused() {
        let mut robot = robot();
        assert!(robot.files().is_ok());
        robot.toml.push(' ');
        let error = robot.files().unwrap_err().to_string();
        assert!(error.contains("robots/nao/v4"), "{error}");
        let mut gait = gait();
        assert!(gait.checked().is_ok());
        gait.text.push(' ');
        let error = gait.checked().unwrap_err().to_string();
        assert!(error.contains("low-175.toml"), "{error}");
    }
}
