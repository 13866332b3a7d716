//! An experiment is all that it takes: it is sent as text, read back, and run without a file.

use std::sync::atomic::{AtomicUsize, Ordering};

use prone_files::robot_folder::RobotFiles;
use prone_files::shipped;
use prone_record::experiment::{
    CrawlExperiment, Detail, Ending, Experiment, GaitText, PassageCycle, PassageExperiment,
    PullExperiment, RobotText, SceneText, SteeringChoice,
};
use prone_study::run::{Outcome, RunError, run};
use prone_study::watch::{Progress, Unwatched, Watch};

fn robot() -> RobotText {
    RobotText::from_files(&RobotFiles::shipped(&shipped::NAO))
}

fn gait(name: &str) -> GaitText {
    let gait = shipped::gait_file(name).unwrap();
    GaitText::new(&gait.file, &gait.text)
}

fn crawl() -> CrawlExperiment {
    CrawlExperiment {
        ending: Ending::Cycles(1),
        ..CrawlExperiment::new(robot(), gait("low-175"))
    }
}

fn sent(experiment: &Experiment) -> Experiment {
    serde_json::from_str(&serde_json::to_string(experiment).unwrap()).unwrap()
}

#[test]
fn a_crawl_that_was_sent_is_the_crawl_that_was_asked_for() {
    let experiment = Experiment::Crawl(Box::new(crawl()));
    let summary = |experiment: &Experiment| match run(experiment, &Unwatched).unwrap() {
        Outcome::Crawl(crawl) => {
            assert!(crawl.artefacts.is_none(), "no rows were asked for");
            crawl.summary
        }
        Outcome::Pull(_) | Outcome::Passage(_) => panic!("a crawl was asked for"),
    };
    let here = summary(&experiment);
    assert_eq!(here.cycles, 1);
    assert!(here.distance_mm > 50.0, "{} mm", here.distance_mm);
    assert_eq!(summary(&sent(&experiment)), here);
}

#[test]
fn a_pull_leaves_the_record_of_a_pull() {
    let experiment = Experiment::Pull(Box::new(PullExperiment {
        robot: robot(),
        gait: gait("nominal"),
        duration_s: 1.0,
    }));
    let Outcome::Pull(pull) = run(&experiment, &Unwatched).unwrap() else {
        panic!("a pull was asked for");
    };
    assert_eq!(pull.record.rows.len(), 20, "one row per control step");
    assert!(pull.artefacts.contains_key("rows.csv"));
    let run = String::from_utf8(pull.artefacts["run.json"].clone()).unwrap();
    assert!(run.contains(r#""command": "pull run""#), "{run}");
}

#[test]
fn a_passage_names_the_cycle_that_fits() {
    let passage = PassageExperiment {
        robot: robot(),
        cycles: ["low-175", "low-165"]
            .map(|name| PassageCycle {
                gait: gait(name),
                origin: "shipped".to_owned(),
            })
            .into(),
        ceiling_mm: 172.0,
        margin_mm: 1.0,
        search: None,
    };
    let experiment = sent(&Experiment::Passage(Box::new(passage.clone())));
    let Outcome::Passage(outcome) = run(&experiment, &Unwatched).unwrap() else {
        panic!("a passage was asked for");
    };
    assert!(outcome.passage.feasible);
    assert_eq!(outcome.cycle.unwrap().pull.name, "low-165");
    for margin_mm in [172.0, f64::NAN] {
        let none = PassageExperiment {
            margin_mm,
            ..passage.clone()
        };
        let error = run(&Experiment::Passage(Box::new(none)), &Unwatched).unwrap_err();
        assert!(matches!(error, RunError::NoRoom { .. }), "{error}");
    }
}

#[test]
fn limit_what_no_crawl_can_have() {
    let refused = |change: fn(&mut CrawlExperiment)| {
        let mut experiment = crawl();
        change(&mut experiment);
        let experiment = Experiment::Crawl(Box::new(experiment));
        run(&experiment, &Unwatched).unwrap_err().to_string()
    };
    for (said, expected) in [
        (
            refused(|it| it.joint_offset_deg = Some(2.0)),
            "calibration errors cannot be drawn without a seed",
        ),
        (
            refused(|it| it.uphill = Some(it.gait.clone())),
            "the noise of the inertial unit cannot be drawn without a seed",
        ),
        (
            refused(|it| {
                it.joint_offset_deg = Some(f64::NAN);
                it.seed = Some(1);
            }),
            "a calibration error of NaN° is outside 0 to 10°",
        ),
        (
            refused(|it| it.ending = Ending::Cycles(0)),
            "a crawl of 0 cycles is outside 1 to 1000 cycles",
        ),
        (
            refused(|it| it.steering = SteeringChoice::Heading { degrees: 181.0 }),
            "a heading of 181° is outside -180 to 180°",
        ),
        (
            refused(|it| {
                it.scene.text = Some(SceneText::new("s.toml", ""));
                it.scene.plate = Some((178.0, 1.0));
            }),
            "scene s.toml and a plate exclude each other",
        ),
    ] {
        assert_eq!(said, expected);
    }
}

/// Says stop after so many looks.
struct After(AtomicUsize);

impl Watch for After {
    fn stop(&self) -> bool {
        self.0.fetch_sub(1, Ordering::Relaxed) == 0
    }

    fn progress(&self, _: &Progress<'_>) {}
}

#[test]
fn an_experiment_is_stopped_and_a_changed_text_refused() {
    let experiment = Experiment::Crawl(Box::new(crawl()));
    let stopped = run(&experiment, &After(AtomicUsize::new(20)));
    assert!(matches!(stopped, Err(RunError::Stopped)));
    let mut changed = crawl();
    changed.gait.text.push('\n');
    let error = run(&Experiment::Crawl(Box::new(changed)), &Unwatched).unwrap_err();
    assert!(error.to_string().contains("SHA-256"), "{error}");
    let mut rows = crawl();
    rows.detail = Detail::Rows;
    rows.time_step_s = Some(0.1);
    let error = run(&Experiment::Crawl(Box::new(rows)), &Unwatched).unwrap_err();
    assert!(error.to_string().contains("0.0001..0.005 s"), "{error}");
}
